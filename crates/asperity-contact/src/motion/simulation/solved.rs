//! A solved pass.

use crate::grid::{CellValues, Field};
use crate::motion::contact::Contact;
use crate::motion::extrapolation::LastExtrapolation;
use crate::motion::kinematics::Motion;
use crate::motion::law;
use crate::motion::pair::Pair;
use crate::motion::pass::Pass;
use crate::motion::plastic_volume::PlasticVolume;
use crate::motion::record::{FilmRecord, LostVolume, PassDragRecord, PassRecord, RunningRecord, StepRecord};
use crate::motion::report::PassReport;
use crate::motion::rim::Interior;
use crate::motion::warm_start::{Guess, WarmStart};
use crate::solver::InterfacePassRecord;
use crate::units::{Metre, Second};

/// A solved pass that is not yet [finished](super::Simulation::finish).
pub struct SolvedPass {
    pub(super) outcome: Pass,
    /// The hardness of the bodies in the pass, lower one first.
    pub(super) hardness: [CellValues; 2],
    pub(super) steps: Vec<StepRecord>,
    pub(super) guess: Option<Guess>,
    pub(super) trials: usize,
    pub(super) wall_time: Second,
    pub(super) interiors: [Interior; 2],
    pub(super) running: Option<RunningRecord>,
    pub(super) extrapolation: Option<LastExtrapolation>,
    /// Depth that custom laws take off both bodies in a single pass.
    pub(super) removed: Option<[Field; 2]>,
    /// Finished passes of the motion, this one and its extrapolation included.
    pub(super) represented: usize,
    /// Largest change of the load of a position if the bodies come from the position before, relative to the
    /// mean load.
    pub(super) history_difference: f64,
    /// Sliding distance of the pass.
    pub(super) distance: Metre,
}

impl SolvedPass {
    /// The contacts of the pass, position by position.
    pub fn contacts(&self) -> &[Contact] {
        &self.outcome.contacts
    }

    /// The records of the positions.
    pub fn steps(&self) -> &[StepRecord] {
        &self.steps
    }

    /// The plastic state below the surfaces after unloading; empty for other than elasto-plastic bodies.
    pub fn plastic_volumes(&self) -> &[PlasticVolume] {
        self.outcome.plastic_pass.as_ref().map_or(&[], |pass| &pass.volumes)
    }

    /// The bodies after the pass.
    pub fn pair(&self) -> &Pair {
        &self.outcome.pair
    }

    /// Returns the record of the pass in its present state.
    pub fn record(&self) -> PassRecord {
        let record = summarise(&self.outcome, &self.interiors, &self.steps);
        PassRecord {
            outer_iterations: self.trials,
            wall_time_s: self.wall_time,
            running: self.running,
            interface: InterfacePassRecord::from_positions(
                self.steps.iter().filter_map(|step| step.interface.as_ref()),
                self.distance,
                self.history_difference,
            ),
            plastic: self.outcome.plastic_pass.as_ref().map(|pass| pass.record),
            film: FilmRecord::of_pass(&self.outcome.films),
            drag: self.outcome.drag.as_ref().map(|drag| {
                let steps = drag.positions.iter().zip(&self.steps).zip(&drag.cells);
                PassDragRecord::from_positions(
                    steps.map(|((drag, step), cells)| (*drag, step.load, *cells)),
                    drag.leaving,
                )
            }),
            ..record
        }
    }

    /// Removes the `depth` of a single pass from each cell of the lower and of the upper body, m, below 0 if
    /// a cell grows, for each pass that this one represents. The volume is attributed to the law of this
    /// name, in snake case.
    ///
    /// The number of passes is chosen before the depth is known. With
    /// [`Acceleration`](crate::motion::Acceleration) the depth of a pass bounds the extrapolation of the next
    /// one.
    ///
    /// # Panics
    /// If the shape of a depth differs from that of its body.
    pub fn remove(&mut self, law: &str, depth: &[Field; 2]) {
        let Pass { pair, lost, .. } = &mut self.outcome;
        let known = lost.iter().position(|lost| lost.law == law).unwrap_or_else(|| {
            lost.push(LostVolume::nothing(law));
            lost.len() - 1
        });
        let passes = self.running.map_or(1, |running| running.represents) as f64;
        law::remove(pair, &depth.each_ref().map(|depth| depth * passes), &self.interiors, &mut lost[known]);
        self.removed = Some(match self.removed.take() {
            None => depth.clone(),
            Some([lower, upper]) => [lower + &depth[0], upper + &depth[1]],
        });
    }
}

/// A solved pass with the state that it leaves to the next one.
pub(in crate::motion) struct FinishedPass {
    pub(super) record: PassRecord,
    pub(super) outcome: Pass,
    pub(super) hardness: [CellValues; 2],
    pub(super) steps: Vec<StepRecord>,
    pub(super) warm: WarmStart,
}

impl FinishedPass {
    /// Returns the report for the outputs.
    pub(super) fn report<'a>(&'a self, motion: &'a Motion) -> PassReport<'a> {
        let Self { record, outcome, hardness: [lower, upper], steps, warm } = self;
        let plastic_pass = outcome.plastic_pass.as_ref();
        PassReport {
            record,
            steps,
            contacts: &outcome.contacts,
            pair: &outcome.pair,
            hardness: [lower, upper],
            motion,
            warm,
            plastic_volumes: plastic_pass.map_or(&[], |pass| &pass.volumes),
            states_under_load: plastic_pass.map_or(&[], |pass| &pass.states_under_load),
        }
    }
}

/// Creates the record of a pass, a row of `passes.csv`, without the number of approaches tried and the time.
fn summarise(outcome: &Pass, interiors: &[Interior; 2], steps: &[StepRecord]) -> PassRecord {
    let pair = &outcome.pair;
    let mean_columns = steps.iter().map(|s| s.overlap_columns as f64).sum::<f64>() / steps.len() as f64;
    let mean = |value: fn(&StepRecord) -> f64| steps.iter().map(value).sum::<f64>() / steps.len() as f64;
    let most = |value: fn(&StepRecord) -> f64| steps.iter().map(value).fold(f64::NEG_INFINITY, f64::max);
    PassRecord {
        pass: steps[0].pass,
        approach: mean(|s| s.approach),
        mean_load: mean(|s| s.load),
        mean_tangential_force: mean(|s| s.tangential_force),
        friction_coefficient: mean(|s| s.tangential_force.abs()) / mean(|s| s.load),
        min_load: -most(|s| -s.load),
        max_load: most(|s| s.load),
        mean_pressure: mean(|s| s.load) / (mean_columns * pair.grid(1).area()),
        mean_contact_area: mean(|s| s.contact_area),
        mean_contact_area_interior: mean(|s| s.contact_area_interior),
        largest_spot_cells: steps.iter().map(|s| s.largest_spot_cells).max().unwrap_or(0),
        max_pressure: most(|s| s.max_pressure),
        lost: outcome.lost.clone(),
        running: None,
        interface: None,
        plastic: None,
        film: None,
        drag: None,
        sq_lower: pair.lower.heights.std(0.0),
        sq_upper: pair.upper.heights.std(0.0),
        sq_lower_interior: interiors[0].slice(&pair.lower.heights).std(0.0),
        sq_upper_interior: interiors[1].slice(&pair.upper.heights).std(0.0),
        outer_iterations: 1,
        convolutions: steps.iter().map(|s| s.convolutions).sum(),
        wall_time_s: 0.0,
    }
}
