//! Several contacts under one approach, which carry a load together.

use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::math::parallel;
use crate::operator::Definition;
use crate::solver::active_set::NearCopies;
use crate::solver::bounds::Bounds;
use crate::solver::site::Site;
use crate::solver::{
    Control, Params, Residual, Settings, Solution, Stats, Watch, attraction, cascade, device, residual,
};
use crate::units::{Metre, Newton, Pascal};

/// Contacts in equilibrium under one approach.
pub struct JointSolution {
    /// The common approach δ.
    pub approach: Metre,
    /// The flat cells in contact and their pressure, for each contact.
    pub pressures: Vec<Vec<(u32, Pascal)>>,
    /// The mean cost of a contact.
    pub stats: Stats,
}

/// Solves contacts of one pitch and modulus whose loads add up to `load`. The approach δ is the multiplier of
/// that sum. This is one box-constrained problem with a block-diagonal influence matrix. `start` is a
/// pressure near the solution for each contact, if known, and `tolerance` the η at which a state is accepted.
///
/// It takes fewer than 60 bytes of memory per cell of each contact, in addition to its site. The residual
/// refers to all cells together.
///
/// # Errors
/// [`crate::Error::NotConverged`], [`crate::Error::Interrupted`].
///
/// # Panics
/// If there are no sites.
pub fn solve_together(
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

/// Solves contacts under one approach, as one batch on the device of the `params`; under load control their
/// loads add up to it. Each has the bounds and, if known, a pressure near the solution. The `definition` is
/// that of the operator of the largest. The residual of a contact is its own.
///
/// # Errors
/// [`crate::Error::NotConverged`], [`crate::Error::Interrupted`], and those of devices.
///
/// # Panics
/// If the device is the processor.
pub fn solve_batch(
    definition: &Definition,
    contacts: Vec<(Field, Bounds)>,
    control: Control,
    start: Option<&[Field]>,
    params: &Params,
    watch: &dyn Watch,
) -> Result<Vec<Solution>> {
    let device = params.device.open()?.expect("a device beside the processor");
    let grid = definition.grid;
    let starts = (0..contacts.len()).map(|number| start.map(|start| &start[number]));
    let of_device: Vec<asperity_gpu::Contact> = contacts
        .iter()
        .zip(starts)
        .map(|((gap, bounds), start)| device::contact(gap, bounds, start))
        .collect::<Result<_>>()?;
    let found = device::together(&device, definition, &of_device, control, params, watch)?;
    let stats = device::stats(&found);
    let asperity_gpu::Solution { fields, approach, self_influence, .. } = found;
    let solution = |((initial_gap, bounds), [pressure, displacement]): ((Field, Bounds), [Field; 2])| {
        let at = Some(approach);
        let residual = residual(&pressure, &displacement, &initial_gap, &bounds, self_influence, at).eta;
        let grid = Grid { shape: initial_gap.dim().into(), ..grid };
        Solution { grid, initial_gap, bounds, pressure, displacement, approach, residual, stats }
    };
    Ok(parallel::tasks(contacts.into_iter().zip(fields), solution))
}

/// Returns the flat cells in contact, and their pressure.
fn bearing(pressure: &Field, bounds: &Bounds) -> Vec<(u32, Pascal)> {
    let cells = pressure.iter().enumerate().filter(|(cell, p)| bounds.touches(*cell, **p));
    cells.map(|(cell, p)| (cell as u32, *p)).collect()
}
