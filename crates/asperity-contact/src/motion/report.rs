//! Reports of load cycles: of each pass of a motion, and of each computed cycle of a loading.

use crate::grid::{CellValues, Field};
use crate::motion::contact::Contact;
use crate::motion::kinematics::Motion;
use crate::motion::pair::Pair;
use crate::motion::plastic_volume::PlasticVolume;
use crate::motion::record::{PassRecord, StepRecord};
use crate::motion::warm_start::WarmStart;
use crate::motion::watch::Watch;
use crate::plasticity::PlasticState;
use crate::solver::Bounds;
use crate::units::Pascal;

/// A finished pass.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct PassReport<'a> {
    /// The record of the pass.
    pub record: &'a PassRecord,
    /// The records of the positions.
    pub steps: &'a [StepRecord],
    /// The contacts of the pass, position by position.
    pub contacts: &'a [Contact],
    /// The bodies after the pass.
    pub pair: &'a Pair,
    /// Largest pressure that the cells of the lower and of the upper body could carry at the beginning of the
    /// pass, Pa. Growth or removal of a film changes the hardness of the bodies after the pass.
    pub hardness: [&'a CellValues; 2],
    /// The parameters of the motion.
    pub motion: &'a Motion,
    /// The state in which the next pass begins. [`crate::motion::Simulation::resumed`] continues from it with
    /// the same bits.
    pub warm: &'a WarmStart,
    /// The plastic state below the surfaces after unloading; empty for other than elasto-plastic bodies.
    pub plastic_volumes: &'a [PlasticVolume],
    /// The plastic state under the load at the [selected
    /// position](crate::motion::Simulation::with_state_under_load); empty if none is selected.
    pub states_under_load: &'a [PlasticState],
}

/// A finished load cycle: a pass of a motion, or a computed cycle of a loading at rest.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct CycleReport<'a> {
    /// Number of the computed pass, or of the computed cycle of its stage, from 1.
    pub number: usize,
    /// Passes of the motion, or cycles of all stages, that are finished, with those that were not computed.
    pub done: usize,
    /// Number of its last position in the pass, or of its last increment.
    pub step: usize,
    /// The stage of a loading, from 1; `None` for a pass.
    pub stage: Option<usize>,
    /// Mean load of its contacts over their mean overlap.
    pub mean_pressure: Pascal,
    /// The bodies after it.
    pub pair: &'a Pair,
    /// The pass; `None` for a cycle of a loading.
    pub pass: Option<PassReport<'a>>,
    pub(super) watch: &'a dyn Watch,
}

impl CycleReport<'_> {
    /// Whether the course is to stop. A long computation about the cycle then ends with
    /// [`Error::Interrupted`](crate::Error::Interrupted).
    pub fn stop(&self) -> bool {
        self.watch.stop()
    }
}

impl<'a> PassReport<'a> {
    /// Returns the pass as a load cycle.
    pub(super) fn cycle(self) -> CycleReport<'a> {
        CycleReport {
            number: self.record.pass,
            done: self.warm.represented,
            step: self.contacts.len(),
            stage: None,
            mean_pressure: self.record.mean_pressure,
            pair: self.pair,
            pass: Some(self),
            watch: &(),
        }
    }
}

impl PassReport<'_> {
    /// Smallest pressure that two opposing cells could carry.
    pub fn min_hardness(&self) -> Pascal {
        self.hardness[0].min().min(self.hardness[1].min())
    }

    /// Returns the pressure bounds of a contact of the pass.
    pub fn bounds(&self, contact: &Contact) -> Bounds {
        let regime = self.motion.slip(contact.position.stroke);
        regime.sheared(self.pair.bounds_of(self.hardness, &contact.position))
    }

    /// Computes the mean pressure over the positions of the pass on each cell of the lower and of the upper
    /// body, Pa; tension of bodies that attract each other counts as below 0.
    pub fn mean_pressure(&self) -> [Field; 2] {
        let mut mean = [&self.pair.lower, &self.pair.upper].map(|body| Field::zeros(body.heights.raw_dim()));
        for contact in self.contacts {
            for (mean, placement) in mean.iter_mut().zip(self.pair.placements(&contact.position)) {
                let mean = mean.as_slice_mut().expect("standard layout");
                for &(cell, p) in contact.pressure.iter().chain(&contact.tension) {
                    let parts = placement.parts(placement.cell(cell as usize));
                    parts.for_each(|(cell, weight)| mean[cell] += weight * p);
                }
            }
        }
        mean.map(|sum| sum / self.contacts.len() as f64)
    }
}
