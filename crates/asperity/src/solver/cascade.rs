//! The cascade: a first guess of the pressure from coarser and coarser grids.

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::ranks::{Largest, Slab};
use crate::solver::active_set::{self, Answer};
use crate::solver::site::Site;
use crate::solver::watch::InnerWatch;
use crate::solver::{Residual, Settings, attraction};

/// Tolerance of the coarse grids: of std(u), or of the displacement of a cell by itself at the largest upper bound where that
/// is less, for φ never exceeds it.
const COARSE_TOLERANCE: f64 = 1e-2;
/// Convolutions after which a coarse grid is given up.
const MAX_COARSE_CONVOLUTIONS: usize = 100;
/// Grids are not coarsened where none has as many cells as this along both axes.
const MIN_CELLS: usize = 64;

/// The compliance, as a multiple of the self-influence, by which the sets are first predicted from a start that is given:
/// unlike a guess from coarse grids, which is wrong smoothly, the answer at another approach or of another geometry is wrong
/// at single cells, and so are the sets that these predict.
const COMPLIANCE_FACTOR: f64 = 2.0;

/// Solves from the `start` of each contact; where there is none, on a cascade of grids, each with twice the pitch of the
/// one above it, from the coarsest upwards, the pressure of each the first guess of the next. `tolerance` gives the η at
/// which a state is accepted.
pub(super) fn solve(
    sites: &[&dyn Site],
    terms: &Settings,
    start: Option<Vec<Field>>,
    tolerance: &dyn Fn(&Residual) -> f64,
    max_convolutions: usize,
) -> Result<Answer> {
    if start.is_some() {
        return active_set::solve(sites, terms, start, COMPLIANCE_FACTOR, tolerance, max_convolutions);
    }
    let (guess, spent) = first_guess(sites, terms, tolerance)?;
    let mut found = active_set::solve(sites, terms, guess, 1.0, tolerance, max_convolutions)?;
    found.stats.convolutions += spent;
    Ok(found)
}

/// The pressures of the next coarser grids, prolonged, and their cost in convolutions of these grids; none where the grids
/// are small, or the coarse ones cannot bear the load.
fn first_guess(
    sites: &[&dyn Site],
    terms: &Settings,
    tolerance: &dyn Fn(&Residual) -> f64,
) -> Result<(Option<Vec<Field>>, f64)> {
    let large = |site: &&dyn Site| site.slab().whole_grid().shape.iter().all(|n| *n >= MIN_CELLS);
    if !sites.iter().any(large) {
        return Ok((None, 0.0));
    }
    let kept: Vec<Box<dyn Site>> = sites.iter().map(|site| site.coarse()).collect();
    let coarse: Vec<&dyn Site> = kept.iter().map(Box::as_ref).collect();
    let cells =
        |sites: &[&dyn Site]| sites.iter().map(|site| site.slab().whole_grid().cells()).sum::<usize>() as f64;
    let slab = coarse[0].slab();
    let share = cells(&coarse) / cells(sites);
    let within = InnerWatch(terms.watch);
    let mut coarse_terms = Settings { cell_area: coarse[0].grid().cell_area(), watch: &within, ..*terms };
    coarse[0].with_operator(&mut |operator| coarse_terms.self_influence = operator.influence(0, 0));
    let [bearable, attraction] = slab.merged(coarse.iter().fold([0.0; 2], |[bearable, attracted], site| {
        let (bounds, cells) = (site.bounds(), site.grid().cells());
        [bearable + bounds.upper().sum(cells), attracted + attraction(&bounds, cells)]
    }));
    if coarse_terms.pressure_sum().is_some_and(|wanted| bearable <= wanted) {
        return Ok((None, 0.0));
    }
    coarse_terms.attraction = attraction;
    let (guess, spent) = first_guess(&coarse, &coarse_terms, tolerance)?;
    let Largest(most) =
        slab.merged(Largest(coarse.iter().map(|site| site.bounds().upper().max()).fold(0.0, f64::max)));
    let saturation = coarse_terms.self_influence * most;
    let loose =
        |state: &Residual| tolerance(state).max(COARSE_TOLERANCE * (saturation / state.scale).min(1.0));
    match active_set::solve(&coarse, &coarse_terms, guess, 1.0, &loose, MAX_COARSE_CONVOLUTIONS) {
        Ok(found) => {
            let coarse = found.fields.iter().zip(sites);
            let prolonged =
                coarse.map(|((pressure, _), site)| prolong(pressure, slab.rows().start, &site.slab()));
            let spent = share * (spent + found.stats.convolutions);
            Ok((Some(prolonged.collect()), spent))
        }
        // A guess that cannot be had is no guess.
        Err(Error::NotConverged { .. }) => Ok((None, share * (spent + MAX_COARSE_CONVOLUTIONS as f64))),
        Err(other) => Err(other),
    }
}

/// Prolongs a field that begins at the row `first` of the coarse grid: each of its values on the cells of the `fine` slab that
/// it covers.
fn prolong(coarse: &Field, first: usize, fine: &Slab) -> Field {
    let offset = fine.rows().start;
    Field::from_shape_fn(fine.grid().shape, |(i, j)| coarse[[(offset + i) / 2 - first, j / 2]])
}
