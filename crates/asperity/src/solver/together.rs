//! Several contacts under one approach, which bear a load together.

use crate::error::Result;
use crate::grid::Field;
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
    /// The cost of each contact, in the mean.
    pub(crate) stats: Stats,
}

/// Solves contacts of one pitch and modulus whose loads add up to `load`, δ being the multiplier of that sum: one
/// box-constrained problem, of a block-diagonal influence matrix. `start` gives a pressure near the answer for each, if
/// one is known; `tolerance` the η at which a state is accepted.
///
/// Memory: fewer than 60 bytes for each cell of each contact, besides its site. The residual is that of
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
    let mut terms = Settings {
        control: Control::Load(load),
        self_influence: 0.0,
        cell_area: sites[0].grid().cell_area(),
        attraction: sites.iter().map(|site| attraction(&site.bounds(), site.grid().cells())).sum(),
        watch,
    };
    sites[0].with_operator(&mut |operator| terms.self_influence = super::self_influence(operator));
    let found = cascade::solve(sites, &terms, start, tolerance, max_convolutions)?;
    let contacts = found.fields.into_iter().zip(sites);
    let pressures = contacts.map(|((pressure, _), site)| bearing(&pressure, &site.bounds())).collect();
    Ok(JointSolution { approach: found.residual.approach, pressures, stats: found.stats })
}

/// The flat cells in contact, and their pressure.
fn bearing(pressure: &Field, bounds: &Bounds) -> Vec<(u32, Pascal)> {
    let cells = pressure.iter().enumerate().filter(|(cell, p)| bounds.touches(*cell, **p));
    cells.map(|(cell, p)| (cell as u32, *p)).collect()
}
