//! Definition of an operator, without its transforms and coefficients.

use crate::grid::Grid;
use crate::kernel::{Influence, Line, SharedResponse};
use crate::operator::Boundary;
use crate::units::Metre;

/// Grid, boundary and bodies of an operator.
#[derive(Debug, Clone)]
pub struct Definition {
    /// The grid.
    pub grid: Grid,
    /// The boundary.
    pub boundary: Boundary,
    /// The displacement of the bodies.
    pub response: SharedResponse,
    /// The distance r₀ at which displacements along a periodic axis are 0, for a boundary with one.
    pub datum: Metre,
}

impl Definition {
    /// Returns the definition on a grid of about half as many cells along each axis.
    pub(crate) fn coarse(&self) -> Self {
        Self { grid: self.boundary.coarse(&self.grid), ..self.clone() }
    }

    /// Returns the displacement around a loaded cell.
    ///
    /// # Panics
    /// If one axis is periodic and the response has no line.
    pub(crate) fn influence(&self) -> Box<dyn Influence> {
        let (response, pitch) = (&self.response, self.grid.pitch);
        match self.boundary.line(&self.grid, self.datum) {
            None => response.influence(pitch),
            Some(line) => {
                let of = |line: &Line| response.line_influence(line, pitch);
                of(&line).expect("a response that knows lines")
            }
        }
    }
}
