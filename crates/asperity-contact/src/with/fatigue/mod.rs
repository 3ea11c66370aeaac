//! Fatigue below the surface of a body under loads that repeat: contacts that pass over it, or the cycles of
//! one contact.
//!
//! Each point sees a stress in each contact of a load cycle, and the cycle repeats. [`StressHistory`]
//! computes the stress of all contacts depth by depth, and from it Dang Van's f. Nothing fails in the end
//! where f is below the limit b of [`DangVan`]:
//!
//! ```text
//! f = max over the contacts of τ + a σh
//! ```
//!
//! σh is the hydrostatic stress, and τ the largest shear of the deviator less s*, the centre of the smallest
//! ball around all deviators in five dimensions: the residual stress that shakedown leaves in a grain.
//!
//! ```
//! use asperity_contact::fatigue::{DangVan, StressHistory};
//! use asperity_contact::operator::Boundary;
//! use asperity_contact::subsurface::Tractions;
//! use asperity_contact::{Field, Grid};
//!
//! // A ridge of pressure that passes over a period.
//! let grid = Grid::new([32, 2], [1.0, 1.0])?;
//! let pressure = |at: usize| Field::from_shape_fn(grid.shape, |(i, _)| if i == at { 1.0 } else { 0.0 });
//! let pass = StressHistory::new(grid, Boundary::PERIODIC, 0.3, 32, |at| Tractions::frictionless(pressure(at)));
//! let criterion = DangVan::new(1.0, 1.7)?;
//! let found = pass.dang_van(&criterion, &[0.5, 2.0])?;
//! // Each cell sees the same history.
//! assert!(found[0].f.iter().all(|f| (f / found[0].f[[0, 0]] - 1.0).abs() < 1e-9));
//! assert!(found[0].f[[0, 0]] > found[1].f[[0, 0]]);
//! # Ok::<(), asperity_contact::Error>(())
//! ```

mod ball;
mod criterion;
mod critical;
mod damage;
mod history;
mod maps;
mod limited_bodies;
mod memory;
mod record;
mod rules;
mod smooth;
mod observer;
mod table;
mod views;

pub use criterion::DangVan;
pub use critical::{Critical, critical_depth, critical_depths};
pub use damage::{Basquin, advance_damage, risk};
pub use history::{AtDepth, StressHistory};
pub use observer::FatigueObserver;
pub use record::{FatigueRecord, OnBody};
pub use table::{Fatigue, FatigueLimits};

use crate::error::Result;
use crate::motion::{Memory, StepCell};
use crate::with::views::{Answer, Curve, Line, Map};
use crate::with::{Capability, Given, Rule, Surroundings, of_last};

/// Work of the stress of a contact at a depth over that of a convolution.
const EFFORT: f64 = 40.0;

impl Capability for Fatigue {
    const NAME: &'static str = "fatigue";
    const TITLE: &'static str = "Fatigue";
    const MEANING: &'static str = "fatigue below the surfaces of bodies under loads that repeat";
    const VERB: &'static str = "fatigues";
    const OF_LOAD_CYCLES: bool = true;

    type Row = FatigueRecord;
    type Observer = FatigueObserver;

    const RULES: &'static [Rule<Self>] = rules::RULES;
    const CURVES: &'static [Curve<FatigueRecord>] = views::CURVES;
    const MAPS: &'static [Map<FatigueRecord>] = views::MAPS;
    const CONSTANTS: &'static [&'static str] = &[];
    const PREFIXES: &'static [&'static str] = &["fatigue_lower_", "fatigue_upper_"];

    fn every(&self) -> usize {
        self.every
    }

    fn begin(&self, given: &Given<'_>) -> Result<FatigueObserver> {
        FatigueObserver::new(self, given)
    }

    fn cycle_memory(&self, given: &Given<'_>) -> Result<Option<Box<dyn Memory>>> {
        Ok(Some(Box::new(memory::Damage(limited_bodies::LimitedBodies::new(self, given)?))))
    }

    fn remembered(&self) -> usize {
        2 * self.layers
    }

    fn summary(rows: &[FatigueRecord]) -> Vec<FatigueRecord> {
        of_last(rows).cloned().collect()
    }

    fn describe(&self, surroundings: &Surroundings) -> String {
        views::describe(self, surroundings)
    }

    fn answers(&self, rows: &[FatigueRecord]) -> Vec<Answer> {
        views::answers(rows)
    }

    fn cells(&self, rows: &[FatigueRecord]) -> Vec<StepCell> {
        views::cells(rows)
    }

    fn numbers(&self, row: &FatigueRecord) -> Vec<Line> {
        views::numbers(row)
    }

    fn doubts(&self, rows: &[FatigueRecord], surroundings: &Surroundings) -> Vec<String> {
        views::doubts(self, rows, surroundings)
    }

    fn prefix(row: &FatigueRecord, _: &str) -> &'static str {
        Self::PREFIXES[row.body as usize]
    }

    fn effort(&self) -> f64 {
        EFFORT * self.layers as f64
    }

    fn memory(shape: [usize; 2]) -> f64 {
        // The stress of a depth as far as it is kept, and the balls.
        let cells = (shape[0] * shape[1]) as f64;
        256e6_f64.min(48.0 * 128.0 * cells) + 600.0 * cells
    }
}
