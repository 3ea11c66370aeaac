//! What a motion hands out, pass after pass.

use crate::grid::{CellValues, Field};
use crate::motion::Motion;
use crate::motion::contact::Contact;
use crate::motion::flowed::FlowedVolume;
use crate::motion::pair::Pair;
use crate::motion::record::{PassRecord, StepRecord};
use crate::motion::warm_start::WarmStart;
use crate::plasticity::PlasticState;
use crate::solver::Bounds;
use crate::units::Pascal;

/// A finished pass.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct PassReport<'a> {
    /// The pass in numbers.
    pub record: &'a PassRecord,
    /// The positions of the pass in numbers.
    pub steps: &'a [StepRecord],
    /// The contacts of the pass, position by position.
    pub contacts: &'a [Contact],
    /// The bodies after the pass.
    pub pair: &'a Pair,
    /// Most pressure that the cells of the lower and of the upper body bore at the beginning of the pass, Pa. A film that grows or is
    /// removed gives the bodies after the pass another hardness.
    pub hardness: [&'a CellValues; 2],
    /// How they move.
    pub motion: &'a Motion,
    /// The state in which the next pass begins: with it [`crate::motion::Simulation::resumed`] goes on with the same bits.
    pub warm: &'a WarmStart,
    /// What has flowed below the surfaces, once the load is taken off; nothing in bodies that do not flow.
    pub flowed: &'a [FlowedVolume],
    /// What has flowed in these under the load at the position that is [looked at](crate::motion::Simulation::looking_at); nothing where
    /// none is.
    pub looked_at: &'a [PlasticState],
}

impl PassReport<'_> {
    /// The least pressure that two cells bore where they faced each other.
    pub fn min_hardness(&self) -> Pascal {
        self.hardness[0].min().min(self.hardness[1].min())
    }

    /// The bounds of the pressure of a contact of the pass.
    pub fn bounds(&self, contact: &Contact) -> Bounds {
        self.pair.bounds_of(self.hardness, &contact.position, self.motion.friction.as_ref())
    }

    /// Mean pressure over the positions of the pass on each cell of the lower and of the upper body, Pa.
    pub fn mean_pressure(&self) -> [Field; 2] {
        let mut mean = [&self.pair.lower, &self.pair.upper].map(|body| Field::zeros(body.heights.raw_dim()));
        for contact in self.contacts {
            for (mean, seat) in mean.iter_mut().zip(self.pair.seats(&contact.position)) {
                let mean = mean.as_slice_mut().expect("standard layout");
                for &(cell, p) in &contact.pressure {
                    let parts = seat.parts(seat.cell(cell as usize));
                    parts.for_each(|(cell, weight)| mean[cell] += weight * p);
                }
            }
        }
        mean.map(|sum| sum / self.contacts.len() as f64)
    }
}
