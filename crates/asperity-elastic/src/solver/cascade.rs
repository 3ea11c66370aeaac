//! The cascade: an initial guess of the pressure from successively coarser grids.

use asperity_base::math::active_set::{COMPLIANCE_FACTOR, coarse_tolerance};

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::math::parallel;
use crate::ranks::{Largest, Slab};
use crate::solver::active_set::{self, Answer, Stage};
use crate::solver::site::Site;
use crate::solver::{Residual, Settings, Stats, attraction};
use asperity_base::watch::InnerWatch;

/// Largest number of convolutions on a coarse grid.
const MAX_COARSE_CONVOLUTIONS: usize = 100;
/// Grids with fewer cells along each axis are not coarsened.
pub(super) const MIN_CELLS: usize = 64;

/// Solves from the `start` of each contact. Without a start it solves on a cascade of grids, from the
/// coarsest to the finest. Each grid has twice the pitch of the next, and its pressure is the initial guess
/// of the next. `tolerance` is the η at which a state is accepted.
pub(super) fn solve(
    sites: &[&dyn Site],
    settings: &Settings,
    start: Option<Vec<Field>>,
    tolerance: &dyn Fn(&Residual) -> f64,
    max_convolutions: usize,
) -> Result<Answer> {
    if start.is_some() {
        return active_set::solve(
            sites,
            settings,
            start,
            COMPLIANCE_FACTOR,
            tolerance,
            max_convolutions,
            Stage::Warm,
        );
    }
    let (guess, spent) = first_guess(sites, settings, tolerance)?;
    let mut found = active_set::solve(sites, settings, guess, 1.0, tolerance, max_convolutions, Stage::Cold)?;
    found.stats.convolutions += spent.convolutions;
    found.stats.near_applications += spent.near_applications;
    Ok(found)
}

/// Returns the prolonged pressures of the next coarser grids, and their cost in convolutions of these grids.
/// Returns none for small grids, or if the coarse grids cannot carry the load.
fn first_guess(
    sites: &[&dyn Site],
    settings: &Settings,
    tolerance: &dyn Fn(&Residual) -> f64,
) -> Result<(Option<Vec<Field>>, Stats)> {
    let large = |site: &&dyn Site| site.slab().whole_grid().shape.iter().all(|n| *n >= MIN_CELLS);
    if !sites.iter().any(large) {
        return Ok((None, Stats::default()));
    }
    let kept: Vec<Box<dyn Site>> = sites.iter().map(|site| site.coarse()).collect();
    let coarse: Vec<&dyn Site> = kept.iter().map(Box::as_ref).collect();
    let cells =
        |sites: &[&dyn Site]| sites.iter().map(|site| site.slab().whole_grid().cells()).sum::<usize>() as f64;
    let slab = coarse[0].slab();
    let share = cells(&coarse) / cells(sites);
    let shared = |spent: Stats| Stats {
        convolutions: share * spent.convolutions,
        near_applications: share * spent.near_applications,
        ..spent
    };
    let within = InnerWatch(settings.watch);
    let mut coarse_settings =
        Settings { cell_area: coarse[0].grid().cell_area(), watch: &within, ..*settings };
    coarse[0].with_operator(&mut |operator| coarse_settings.self_influence = operator.influence(0, 0));
    let [bearable, attraction] = slab.merged(coarse.iter().fold([0.0; 2], |[bearable, attracted], site| {
        let (bounds, cells) = (site.bounds(), site.grid().cells());
        [bearable + bounds.upper().sum(cells), attracted + attraction(&bounds, cells)]
    }));
    if coarse_settings.pressure_sum().is_some_and(|wanted| bearable <= wanted) {
        return Ok((None, Stats::default()));
    }
    coarse_settings.attraction = attraction;
    let (guess, spent) = first_guess(&coarse, &coarse_settings, tolerance)?;
    let Largest(most) =
        slab.merged(Largest(coarse.iter().map(|site| site.bounds().upper().max()).fold(0.0, f64::max)));
    let saturation = coarse_settings.self_influence * most;
    let loose = |state: &Residual| coarse_tolerance(tolerance(state), saturation, state.scale);
    match active_set::solve(
        &coarse,
        &coarse_settings,
        guess,
        1.0,
        &loose,
        MAX_COARSE_CONVOLUTIONS,
        Stage::Guess,
    ) {
        Ok(found) => {
            let coarse = found.fields.iter().zip(sites);
            let prolonged =
                coarse.map(|((pressure, _), site)| prolong(pressure, slab.rows().start, &site.slab()));
            Ok((Some(prolonged.collect()), shared(spent.and(&found.stats))))
        }
        // Without a solution on the coarse grids there is no guess.
        Err(Error::NotConverged { .. }) => {
            let most = Stats { convolutions: MAX_COARSE_CONVOLUTIONS as f64, ..Stats::default() };
            Ok((None, shared(spent.and(&most))))
        }
        Err(other) => Err(other),
    }
}

/// Prolongs a field that begins at the row `first` of the coarse grid: copies each value to the cells of the
/// `fine` slab that it covers.
fn prolong(coarse: &Field, first: usize, fine: &Slab) -> Field {
    let offset = fine.rows().start;
    parallel::field(fine.grid().shape, |i, j| coarse[[(offset + i) / 2 - first, j / 2]])
}
