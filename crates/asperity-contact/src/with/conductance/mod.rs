//! Thermal or electrical conductance of a contact.
//!
//! Heat or current passes from one body into the other where they touch, through a film on the spots, and
//! through gas in the gap. It is steady, and the bodies are half-spaces below their surfaces. The flux q is
//! that from the warmer body into the other, V the drop between their far fields:
//!
//! ```text
//! (C + D) q = V          G = ΔA Σ q/V,   h = G/A,   R = 1/G
//! D = ρ_f                on cells in contact (film)
//! D = (g + M)/κ_g        on open ones with gas; without it they do not conduct
//! ```
//!
//! C is an [`Operator`](crate::operator::Operator) made of the composite conductivity κ_s in place of the
//! composite modulus E*, as a half-space answers to a flux as it does to a pressure: both with the potential
//! 1/r. In contact are all cells that bear a pressure, those at the hardness too.
//!
//! | boundary | V is | G contains |
//! |---|---|---|
//! | free | the drop between far fields | the spreading from the grid into the half-spaces too; see [`full_resistance`] |
//! | periodic | the drop that the joint adds to that between the mean planes | the joint alone: h is the joint conductance of the textbooks |
//! | periodic along one axis | the drop against the distance r₀ of the [`Operators`] | as free, with a line of grids |
//!
//! Radiation and convection are left out. The position of bodies in motion is taken as steady, which it is if
//! it lasts much longer than spot²/D, D the diffusivity.
//!
//! ```
//! use asperity_contact::conductance::{Joint, Kind, composite_conductivity, solve};
//! use asperity_contact::ndarray::Array2;
//! use asperity_contact::Grid;
//! use asperity_contact::{operator::FreeFft, solver::Params};
//!
//! let grid = Grid::new([64, 64], [1e-6; 2])?;
//! let round = Array2::from_shape_fn(grid.shape, |(i, j)| (i as f64 - 31.5).hypot(j as f64 - 31.5) < 20.0);
//! let composite = composite_conductivity(46.0, 46.0)?;
//! let mut operator = FreeFft::new(grid, composite);
//! let joint = Joint::new(Kind::Thermal);
//! let found = solve(&mut operator, &round, None, &joint, None, &Params::default())?;
//! // A round spot has 2κ_s a.
//! assert!((found.conductance.unwrap() / (2.0 * 46.0 * 20e-6) - 1.0).abs() < 0.01);
//! # Ok::<(), asperity_contact::Error>(())
//! ```
//!
//! [`Operators`]: crate::operator::Operators

mod barber;
mod bodies;
mod correlations;
mod doubts;
mod joint;
mod observer;
mod record;
mod rules;
mod spots;
mod table;
mod views;

pub use barber::Bracket;
pub use bodies::{ConductingLayer, Conductor, composite_conductivity, response};
use bodies::{composite, conductor};
pub use correlations::{JointRoughness, MAX_CORRELATED_FRACTION};
pub use doubts::doubts;
pub use joint::{Conductance, Shares, full_resistance, solve};
pub use observer::ConductanceObserver;
pub use record::{ConductanceRecord, Quantities};
pub use spots::ContactSpots;
pub use table::{Joint, Kind};
pub use views::{conducts, resistance, shares};

use super::views::{Answer, Curve, Line, Map};
use super::{Capability, Given, Rule, Surroundings};
use crate::error::Result;
use asperity_base::Choice;

/// Work of a conductance over that of a convolution; with gas half as much again.
const EFFORT: f64 = 13.2;
/// Memory of a solution, numbers of double precision for each cell.
const NUMBERS: f64 = 14.0;

impl Capability for Joint {
    const NAME: &'static str = "conductance";
    const TITLE: &'static str = "Heat or current";
    const MEANING: &'static str = "thermal or electrical conductance of the contacts";
    const VERB: &'static str = "conducts";

    type Row = ConductanceRecord;
    type Observer = ConductanceObserver;

    const RULES: &'static [Rule<Self>] = rules::RULES;
    const CURVES: &'static [Curve<ConductanceRecord>] = views::CURVES;
    const MAPS: &'static [Map<ConductanceRecord>] = views::MAPS;
    const CONSTANTS: &'static [&'static str] = &["conductivity", "resistivity"];
    const PREFIXES: &'static [&'static str] = &["conductance_"];

    fn every(&self) -> usize {
        self.every
    }

    fn begin(&self, given: &Given<'_>) -> Result<ConductanceObserver> {
        ConductanceObserver::new(self, given)
    }

    fn summary(rows: &[ConductanceRecord]) -> Vec<ConductanceRecord> {
        match rows.last() {
            Some(last) if last.pass.is_none() => vec![last.clone()],
            _ => ConductanceRecord::means(rows),
        }
    }

    fn describe(&self, surroundings: &Surroundings) -> String {
        views::describe(self, surroundings)
    }

    fn answers(&self, rows: &[ConductanceRecord]) -> Vec<Answer> {
        views::answers(rows)
    }

    fn numbers(&self, row: &ConductanceRecord) -> Vec<Line> {
        views::numbers(row)
    }

    fn doubts(&self, rows: &[ConductanceRecord], _: &Surroundings) -> Vec<String> {
        doubts::of_rows(rows)
    }

    fn prefix(row: &ConductanceRecord, column: &str) -> &'static str {
        // The names of the quantities say what they are.
        if column.starts_with(row.quantities.kind.word()) { "" } else { Self::PREFIXES[0] }
    }

    fn effort(&self) -> f64 {
        EFFORT
    }

    fn memory([nx, ny]: [usize; 2]) -> f64 {
        8.0 * NUMBERS * (nx * ny) as f64
    }
}
