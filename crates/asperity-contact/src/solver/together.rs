//! Several contacts under one approach, which carry a load together.

use crate::error::Result;
use crate::grid::Field;
use crate::solver::active_set::NearCopies;
use crate::solver::bounds::Bounds;
use crate::solver::site::Site;
use crate::solver::{Control, Residual, Settings, Stats, Watch, attraction, cascade};
use crate::units::{Metre, Newton, Pascal};

/// Contacts in equilibrium under one approach.
pub(crate) struct JointSolution {
    /// The common approach δ.
    pub(crate) approach: Metre,
    /// The flat cells in contact and their pressure, for each contact.
    pub(crate) pressures: Vec<Vec<(u32, Pascal)>>,
    /// The mean cost of a contact.
    pub(crate) stats: Stats,
}

/// Solves contacts of one pitch and modulus whose loads add up to `load`. The approach δ is the multiplier of that
/// sum. This is one box-constrained problem with a block-diagonal influence matrix. `start` is a pressure near the
/// solution for each contact, if known, and `tolerance` the η at which a state is accepted.
///
/// It takes fewer than 60 bytes of memory per cell of each contact, in addition to its site. The residual refers to
/// all cells together.
///
/// # Errors
/// [`crate::Error::NotConverged`], [`crate::Error::Interrupted`].
pub(crate) fn solve_together(
    sites: &[&dyn Site],
    load: Newton,
    start: Option<Vec<Field>>,
    tolerance: &dyn Fn(&Residual) -> f64,
    max_convolutions: usize,
    watch: &dyn Watch,
) -> Result<JointSolution> {
    let mut settings = Settings {
        control: Control::Load(load),
        self_influence: 0.0,
        cell_area: sites[0].grid().cell_area(),
        attraction: sites.iter().map(|site| attraction(&site.bounds(), site.grid().cells())).sum(),
        watch,
        near_copies: NearCopies::Large,
    };
    sites[0].with_operator(&mut |operator| settings.self_influence = super::self_influence(operator));
    let found = cascade::solve(sites, &settings, start, tolerance, max_convolutions)?;
    let contacts = found.fields.into_iter().zip(sites);
    let pressures = contacts.map(|((pressure, _), site)| bearing(&pressure, &site.bounds())).collect();
    Ok(JointSolution { approach: found.residual.approach, pressures, stats: found.stats })
}

/// Returns the flat cells in contact, and their pressure.
fn bearing(pressure: &Field, bounds: &Bounds) -> Vec<(u32, Pascal)> {
    let cells = pressure.iter().enumerate().filter(|(cell, p)| bounds.touches(*cell, **p));
    cells.map(|(cell, p)| (cell as u32, *p)).collect()
}
