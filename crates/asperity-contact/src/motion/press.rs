//! A static contact that is solved at once, and the record of a static contact.

use crate::error::Result;
use crate::grid::Field;
use crate::motion::contact::facing;
use crate::motion::pair::Pair;
use crate::motion::record::{ShearRecord, StaticRecord};
use crate::motion::slip::SlipRegime;
use crate::motion::state::LoadedContact;
use crate::motion::watch::{StaticWatch, Watch};
use crate::operator::Boundary;
use crate::solver::{
    ContactProblem, Control, Equilibrium, InterfaceRecord, Loading, Params, RollingSolution,
};
use crate::units::Joule;

/// Presses a pair of bodies together at full overlap, at once, in a slip `regime`. Bodies that stick in part
/// begin without shear.
///
/// # Errors
/// The errors of [`crate::solver::solve_normal`], those of [`crate::solver::solve_rolling`] for bodies that
/// roll, and [`crate::Error::Interrupted`].
///
/// # Panics
/// If the bodies have different shapes.
pub fn press(
    pair: &Pair,
    boundary: Boundary,
    control: Control,
    regime: SlipRegime,
    params: &Params,
    watch: &dyn Watch,
) -> Result<LoadedContact> {
    let (operators, gap) = facing(pair, boundary)?;
    let mut solver = regime.solver(pair, &operators, pair.lower_grid().shape, params.device)?;
    let watch = StaticWatch::new(watch, 0, 1, control);
    let bounds = pair.bounds(&pair.at_rest());
    let problem = ContactProblem::new(&gap, &bounds, Loading::pressing(control), params, &watch);
    Ok(LoadedContact::at_once(pair, solver.solve(&problem)?))
}

impl LoadedContact {
    /// Creates the contact of a `pair` that comes from afar and is solved at once.
    pub(super) fn at_once(pair: &Pair, solution: Equilibrium) -> Self {
        let plastic = solution.normal().plastic_interference();
        let [dissipation, _] = solution.dissipation(None);
        let record = match shear_record(&solution, dissipation) {
            None => StaticRecord::new(solution.normal()),
            shear => StaticRecord { shear, ..static_record(&solution, &plastic) },
        };
        let interface = InterfaceRecord::new(pair.interface(), solution.normal(), None);
        Self {
            record: StaticRecord { interface, ..record },
            increments: Vec::new(),
            slip: solution.slip().cloned(),
            solution,
            plastic,
            dissipation_error: 0.0,
            changed: None,
            plastic_result: None,
            film: None,
        }
    }
}

/// Returns the record of a contact with its plastic interference so far, without its shear.
pub(super) fn static_record(contact: &Equilibrium, plastic: &Field) -> StaticRecord {
    StaticRecord {
        elastic_energy: contact.elastic_energy(),
        // In the order of the sum of a contact at once.
        plastic_volume: contact.normal().grid.cell_area() * plastic.iter().sum::<f64>(),
        ..StaticRecord::new(contact.normal())
    }
}

/// Returns the record of the shear of a contact with this dissipated energy; `None` if no cell may stick.
pub(super) fn shear_record(contact: &Equilibrium, dissipation: Joule) -> Option<ShearRecord> {
    let (solution, rolled) = (contact.frictional()?, contact.rolling());
    let force = solution.force();
    let load = solution.normal.load();
    let force_ratio = if load > 0.0 { force[0].hypot(force[1]) / load } else { 0.0 };
    let sticks = solution.stick.sum();
    Some(ShearRecord {
        tangential_force: force,
        force_ratio,
        friction_coefficient: (load > 0.0 && sticks == 0.0).then_some(force_ratio),
        tangential_displacement: solution.rigid_displacement,
        stick_area: solution.normal.grid.cell_area() * sticks,
        max_shear: solution.max_shear(),
        dissipation,
        slip_work: rolled.map(RollingSolution::slip_work),
        creepage: rolled.map(|rolled| rolled.creepage),
        spin: rolled.map(|rolled| rolled.spin),
        moment: rolled.map(|_| solution.moment()),
    })
}
