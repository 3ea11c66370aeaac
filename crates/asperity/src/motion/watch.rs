//! Who looks on while a motion is computed.

use std::sync::OnceLock;

use crate::error::Result;
use crate::grid::Field;
use crate::motion::contact::Contact;
use crate::motion::pair::Pair;
use crate::motion::record::{PassRecord, StepRecord, SweepRecord};
use crate::motion::warm_start::{Guess, WarmStart};
use crate::solver::{self, Control, Sliding};
use crate::units::Newton;

/// How far a motion has come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// The pass under way, from 1.
    pub pass: usize,
    /// Passes in all.
    pub passes: usize,
    /// The approach being tried in this pass, from 1.
    pub trial: usize,
    /// Positions solved in this trial.
    pub solved: usize,
    /// Positions of a pass.
    pub positions: usize,
    /// Load at the position solved last.
    pub load: Newton,
    /// Where all positions are solved together, or a contact at rest is being solved: the part of the way, 0 to 1, in the
    /// logarithm of the residual.
    pub together: Option<f64>,
}

/// Looks on, from the threads that solve.
pub trait Watch: Sync {
    /// A position has been solved.
    fn at(&self, progress: &Progress);

    /// A contact at rest is being solved: [`Progress::together`] says how far it has come.
    fn solving(&self, _: &Progress) {}

    /// A pass has been finished: each in its turn, those too from which an interrupted motion goes on.
    fn pass(&self, _: &PassRecord) {}

    /// A point of a sweep has been solved: each in its turn, those too from which an interrupted sweep goes on.
    fn point(&self, _: &SweepRecord) {}

    /// Whether to stop: what is computed then ends with [`crate::Error::Interrupted`] at the next convolution.
    fn stop(&self) -> bool;
}

/// Nobody looks on.
impl Watch for () {
    fn at(&self, _: &Progress) {}

    fn stop(&self) -> bool {
        false
    }
}

/// Looks on at a contact that is one of many: it stops when the whole does.
pub(super) struct OneOfMany<'a>(pub(super) &'a dyn Watch);

impl solver::Watch for OneOfMany<'_> {
    fn iteration(&self, _: f64, _: f64) {}

    fn stop(&self) -> bool {
        self.0.stop()
    }
}

/// Looks on at a contact at rest, after so many increments or points of all.
pub(super) struct AtRest<'a> {
    watch: &'a dyn Watch,
    progress: Progress,
    /// The residual at the beginning.
    first: OnceLock<f64>,
}

impl<'a> AtRest<'a> {
    pub(super) fn new(watch: &'a dyn Watch, solved: usize, positions: usize, control: Control) -> Self {
        let load = match control {
            Control::Load(load) => load,
            Control::Approach(_) => 0.0,
        };
        let progress = Progress { pass: 1, passes: 1, trial: 1, solved, positions, load, together: None };
        Self { watch, progress, first: OnceLock::new() }
    }
}

impl solver::Watch for AtRest<'_> {
    fn iteration(&self, residual: f64, tolerance: f64) {
        let first = self.first.get_or_init(|| residual);
        let way = (first / residual).ln() / (first / tolerance).ln();
        let way = if way.is_finite() { way.clamp(0.0, 1.0) } else { 0.0 };
        self.watch.solving(&Progress { together: Some(way), ..self.progress });
    }

    fn stop(&self) -> bool {
        self.watch.stop()
    }
}

/// A finished pass.
pub struct PassReport<'a> {
    /// The pass in numbers.
    pub record: &'a PassRecord,
    /// The positions of the pass in numbers.
    pub steps: &'a [StepRecord],
    /// The contacts of the pass, position by position.
    pub contacts: &'a [Contact],
    /// The bodies after the pass.
    pub pair: &'a Pair,
    /// How they slid, if there is friction.
    pub sliding: Option<Sliding>,
    /// The guess with which the search of the next pass begins, if a mean load is prescribed.
    pub guess: Option<Guess>,
}

impl PassReport<'_> {
    /// The state in which the next pass begins: with it [`crate::motion::Simulation::resumed`] goes on with the same
    /// bits.
    pub fn warm_start(&self) -> WarmStart {
        WarmStart::new(self.guess, self.contacts)
    }

    /// Mean pressure over the positions of the pass on each cell of the lower and of the upper body, Pa.
    pub fn mean_pressure(&self) -> [Field; 2] {
        let mut mean = [&self.pair.lower, &self.pair.upper].map(|body| Field::zeros(body.heights.raw_dim()));
        for contact in self.contacts {
            for &(cell, p) in &contact.pressure {
                let bodies = self.pair.cells_of_bodies(&contact.position, cell as usize);
                for (mean, cell) in mean.iter_mut().zip(bodies) {
                    mean.as_slice_mut().expect("standard layout")[cell] += p;
                }
            }
        }
        mean.map(|sum| sum / self.contacts.len() as f64)
    }
}

/// Takes what a motion yields. An output that cannot be written ends the motion.
pub trait Output {
    /// Takes a finished pass.
    ///
    /// # Errors
    /// What kept it from being written.
    fn pass(&mut self, report: &PassReport) -> Result<()>;
}
