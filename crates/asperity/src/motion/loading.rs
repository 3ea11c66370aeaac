//! The history of a static contact with friction: what it bears depends on how it came there.

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::motion::pair::Pair;
use crate::motion::record::{IncrementRecord, ShearRecord, StaticRecord};
use crate::motion::watch::{Progress, Watch};
use crate::operator::{Boundary, CoupledOperator, Operators};
use crate::solver::{
    Control, Friction, FrictionalSolution, Loading, Params, Rolling, Tangential, solve_frictional,
    solve_rolling,
};
use crate::units::SquareMetre;

/// One stage of a loading: what is prescribed at its end, and in how many equal steps it is reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stage {
    /// At the end of the stage.
    pub loading: Loading,
    /// Steps, ≥ 1.
    pub increments: usize,
}

/// A contact with friction, and how it came about.
#[derive(Debug, Clone)]
pub struct FrictionalContact {
    /// Its end in numbers.
    pub record: StaticRecord,
    /// Each increment; none of a rolling contact.
    pub increments: Vec<IncrementRecord>,
    /// Its end.
    pub solution: FrictionalSolution,
    /// Slip of all increments together along x and y, m; in rolling, while the contact moves on by a cell.
    pub slip: [Field; 2],
}

/// Loads a pair whose bodies face each other with all their columns, from where they do not touch, stage after stage.
///
/// Between the ends of its stages a load, an approach, a force or a displacement grows in equal steps; from 0 at first, an
/// approach from the first touch, and where a stage prescribes another quantity than the one before, from what it is then.
///
/// # Errors
/// Those of [`solve_frictional`]; [`Error::Unsupported`] without stages; [`Error::Interrupted`].
///
/// # Panics
/// If the bodies have different shapes.
pub fn load_in_stages(
    pair: &Pair,
    boundary: Boundary,
    friction: &Friction,
    stages: &[Stage],
    params: &Params,
    watch: &dyn Watch,
) -> Result<FrictionalContact> {
    let (mut operator, gap) = facing(pair, boundary);
    let area = pair.cell_area();
    let mut state: Option<FrictionalSolution> = None;
    let mut slip = [Field::zeros(gap.raw_dim()), Field::zeros(gap.raw_dim())];
    let mut increments = Vec::new();
    let positions = stages.iter().map(|stage| stage.increments).sum();
    for (index, stage) in stages.iter().enumerate() {
        let from = Origin::of(state.as_ref(), &gap, area);
        for step in 1..=stage.increments {
            if watch.stop() {
                return Err(Error::Interrupted);
            }
            let loading = from.towards(stage.loading, step as f64 / stage.increments as f64);
            let next = solve_frictional(
                operator.as_mut(),
                &gap,
                pair.hardness(),
                friction,
                loading,
                state.as_ref(),
                params,
            )?;
            slip.iter_mut().zip(&next.slip).for_each(|(sum, slip)| *sum += slip);
            let dissipation = next.dissipation(state.as_ref(), area);
            increments.push(record(&next, increments.len() + 1, index + 1, dissipation, area));
            let (solved, load) = (increments.len(), next.normal.load(area));
            watch.at(&Progress { pass: 1, passes: 1, trial: 1, solved, positions, load });
            state = Some(next);
        }
    }
    let solution = state.ok_or(Error::Unsupported("a loading has at least one increment"))?;
    let dissipation = increments.iter().map(|increment| increment.dissipation).sum();
    let mut record = normal_record(pair, &gap, &solution);
    record.iterations = increments.iter().map(|increment| increment.iterations).sum();
    record.convolutions = increments.iter().map(|increment| increment.convolutions).sum();
    record.shear = Some(shear_record(&solution, dissipation, None, area));
    Ok(FrictionalContact { record, increments, solution, slip })
}

/// The steady state of a pair that rolls along x, see [`solve_rolling`].
///
/// # Errors
/// Those of [`solve_rolling`].
///
/// # Panics
/// If the bodies have different shapes.
pub fn roll(
    pair: &Pair,
    boundary: Boundary,
    friction: &Friction,
    control: Control,
    rolling: Rolling,
    params: &Params,
) -> Result<FrictionalContact> {
    let (mut operator, gap) = facing(pair, boundary);
    let area = pair.cell_area();
    let (solution, creepage) =
        solve_rolling(operator.as_mut(), &gap, pair.hardness(), friction, control, rolling, params)?;
    let mut record = normal_record(pair, &gap, &solution);
    let work = |axis: usize| (&solution.shear[axis] * &solution.slip[axis]).sum();
    record.shear = Some(shear_record(&solution, area * (work(0) + work(1)), Some(creepage), area));
    let slip = solution.slip.clone();
    Ok(FrictionalContact { record, increments: Vec::new(), solution, slip })
}

fn facing(pair: &Pair, boundary: Boundary) -> (Box<dyn CoupledOperator>, Field) {
    assert_eq!(pair.lower.dim(), pair.upper.dim(), "shapes of the bodies");
    let operators = Operators::new(pair.pitch(), *pair.compliances(), boundary);
    (operators.coupled_on(pair.lower_grid().shape), &pair.upper - &pair.lower)
}

/// Where a stage begins, in each quantity that it may prescribe.
struct Origin {
    load: f64,
    approach: f64,
    force: [f64; 2],
    shift: [f64; 2],
}

impl Origin {
    fn of(state: Option<&FrictionalSolution>, gap: &Field, area: SquareMetre) -> Self {
        match state {
            Some(state) => Self {
                load: state.normal.load(area),
                approach: state.normal.approach,
                force: state.force(area),
                shift: state.shift,
            },
            None => Self {
                load: 0.0,
                approach: gap.iter().copied().fold(f64::INFINITY, f64::min),
                force: [0.0; 2],
                shift: [0.0; 2],
            },
        }
    }

    /// So far on the way to the end of the stage, which is met exactly.
    fn towards(&self, end: Loading, share: f64) -> Loading {
        let between = |from: f64, to: f64| if share == 1.0 { to } else { from + share * (to - from) };
        let both = |from: [f64; 2], to: [f64; 2]| [between(from[0], to[0]), between(from[1], to[1])];
        Loading {
            normal: match end.normal {
                Control::Load(load) => Control::Load(between(self.load, load)),
                Control::Approach(approach) => Control::Approach(between(self.approach, approach)),
            },
            tangential: match end.tangential {
                Tangential::Force(force) => Tangential::Force(both(self.force, force)),
                Tangential::Displacement(shift) => Tangential::Displacement(both(self.shift, shift)),
                sliding @ Tangential::Sliding(_) => sliding,
            },
        }
    }
}

fn record(
    solution: &FrictionalSolution,
    increment: usize,
    stage: usize,
    dissipation: f64,
    area: SquareMetre,
) -> IncrementRecord {
    let force = solution.force(area);
    let normal = &solution.normal;
    IncrementRecord {
        increment,
        stage,
        load: normal.load(area),
        approach: normal.approach,
        tangential_force_x: force[0],
        tangential_force_y: force[1],
        tangential_displacement_x: solution.shift[0],
        tangential_displacement_y: solution.shift[1],
        contact_area: area * normal.contact_cells() as f64,
        stick_area: area * solution.stick.sum(),
        max_pressure: normal.max_pressure(),
        max_shear: solution.max_shear(),
        elastic_energy: solution.elastic_energy(area),
        dissipation,
        iterations: normal.stats.iterations,
        convolutions: normal.stats.convolutions,
        residual: normal.residual,
    }
}

/// What a contact without friction has in numbers too.
fn normal_record(pair: &Pair, gap: &Field, solution: &FrictionalSolution) -> StaticRecord {
    let area = pair.cell_area();
    StaticRecord {
        elastic_energy: solution.elastic_energy(area),
        plastic_cells: solution.plastic_cells(),
        plastic_volume: area * solution.plastic_interference(gap).sum(),
        ..StaticRecord::new(pair, &solution.normal)
    }
}

fn shear_record(
    solution: &FrictionalSolution,
    dissipation: f64,
    creepage: Option<[f64; 2]>,
    area: SquareMetre,
) -> ShearRecord {
    let force = solution.force(area);
    ShearRecord {
        tangential_force: force,
        friction_coefficient: force[0].hypot(force[1]) / solution.normal.load(area),
        tangential_displacement: solution.shift,
        stick_area: area * solution.stick.sum(),
        max_shear: solution.max_shear(),
        dissipation,
        creepage,
    }
}
