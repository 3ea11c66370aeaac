//! The law of a joint: what the contact of two rough surfaces is to a program that computes whole machines.
//!
//! At each load it finds the tangential stiffness on the cells that the normal stiffness has, the area of contact
//! corrected for the edges of spots, and what theories of rough surfaces say from the moments of the undeformed gap
//! alone: area by Persson and by Bush, Gibson and Thomas, normal stiffness by Persson's exponential law, pressure at the
//! same mean gap by Greenwood and Williamson.
//!
//! ```text
//! C_EE q = e   on the cells E in contact that do not yield      K_t = ΔA Σ q·e
//! ```
//!
//! with the tangential part of the response C and e along x or y: [`tangential_stiffness`](crate::solver::tangential_stiffness).
//! The surfaces repeat along both axes. Then the mean elastic displacement is 0, and the mean gap is the distance of the
//! mean planes of both surfaces: nothing of the bulk of the bodies is in it, which such a program computes itself.

mod observer;
mod record;
mod roughness;
mod rules;
mod table;
mod views;

pub use observer::JointObserver;
pub use record::JointRecord;
pub use roughness::GapRoughness;
pub use table::JointLaw;

use super::views::{Answer, Curve, Line, Map};
use super::{Capability, Given, Rule, Surroundings};
use crate::error::Result;

/// Work of both tangential stiffnesses over that of a convolution.
const EFFORT: f64 = 90.0;
/// Memory of a solution, numbers of double precision for each cell.
const NUMBERS: f64 = 24.0;

impl Capability for JointLaw {
    const NAME: &'static str = "joint";
    const TITLE: &'static str = "Law of the joint";
    const MEANING: &'static str =
        "law of a joint of rough surfaces: tangential stiffness, and theories beside";
    const VERB: &'static str = "resists";

    type Row = JointRecord;
    type Observer = JointObserver;

    const RULES: &'static [Rule<Self>] = rules::RULES;
    const CURVES: &'static [Curve<JointRecord>] = views::CURVES;
    const MAPS: &'static [Map<JointRecord>] = &[];
    const CONSTANTS: &'static [&'static str] = &[];
    const PREFIXES: &'static [&'static str] = &["joint_"];

    fn every(&self) -> usize {
        self.every
    }

    fn begin(&self, given: &Given<'_>) -> Result<JointObserver> {
        JointObserver::new(given)
    }

    fn summary(rows: &[JointRecord]) -> Vec<JointRecord> {
        rows.last().cloned().into_iter().collect()
    }

    fn describe(&self, surroundings: &Surroundings) -> String {
        format!("tangential stiffness and theories; {}", surroundings.often(self.every))
    }

    fn answers(&self, rows: &[JointRecord]) -> Vec<Answer> {
        views::answers(rows)
    }

    fn numbers(&self, row: &JointRecord) -> Vec<Line> {
        views::numbers(row)
    }

    fn doubts(&self, _: &[JointRecord], _: &Surroundings) -> Vec<String> {
        Vec::new()
    }

    fn prefix(_: &JointRecord, column: &str) -> &'static str {
        if ["mean_pressure", "load", "convolutions", "step"].contains(&column) {
            Self::PREFIXES[0]
        } else {
            ""
        }
    }

    fn effort(&self) -> f64 {
        EFFORT
    }

    fn memory(shape: [usize; 2]) -> f64 {
        8.0 * NUMBERS * (shape[0] * shape[1]) as f64
    }
}
