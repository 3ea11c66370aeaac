//! Bounds of the pressure of each cell.

use crate::error::{Result, check_in};
use crate::grid::CellValues;
use crate::ranks::Slab;
use crate::units::{Dimension, Pascal};

/// Bounds of the pressure of each cell: lowerᵢ ≤ pᵢ ≤ upperᵢ, Pa.
///
/// Without a tension between the bodies the lower bound is 0. The upper bound is the hardness, possibly
/// reduced by shear or by a film. It is infinite for elastic bodies.
#[derive(Debug, Clone, PartialEq)]
pub struct Bounds {
    lower: CellValues,
    upper: CellValues,
}

impl Bounds {
    /// Bounds for elastic bodies without tension: 0 ≤ p.
    pub const ELASTIC: Self =
        Self { lower: CellValues::Uniform(0.0), upper: CellValues::Uniform(f64::INFINITY) };

    /// Creates bounds for bodies without tension and with a largest pressure `upper`, a number or a field: 0
    /// ≤ p ≤ upper.
    pub fn up_to(upper: impl Into<CellValues>) -> Self {
        Self { lower: CellValues::Uniform(0.0), upper: upper.into().in_rows() }
    }

    /// Sets the lower bounds: finite, and 0 or below 0 for bodies that attract each other.
    pub fn above(self, lower: impl Into<CellValues>) -> Self {
        Self { lower: lower.into().in_rows(), ..self }
    }

    /// The lower bounds of the pressure.
    pub fn lower(&self) -> &CellValues {
        &self.lower
    }

    /// The upper bounds of the pressure.
    pub fn upper(&self) -> &CellValues {
        &self.upper
    }

    /// Whether a cell at `pressure` is in contact: above its lower bound.
    pub fn touches(&self, cell: usize, pressure: Pascal) -> bool {
        pressure > self.lower.value(cell)
    }

    /// Whether a cell at `pressure` is capped: at its upper bound, and above its lower bound.
    pub fn caps(&self, cell: usize, pressure: Pascal) -> bool {
        pressure >= self.upper.value(cell) && self.touches(cell, pressure)
    }

    /// Returns the bounds of a flat `cell`.
    #[inline]
    pub(super) fn interval(&self, cell: usize) -> Interval {
        Interval { lower: self.lower.value(cell), upper: self.upper.value(cell) }
    }

    /// Returns the bounds of all cells, if they are uniform.
    pub(super) fn uniform(&self) -> Option<Interval> {
        Some(Interval { lower: self.lower.uniform()?, upper: self.upper.uniform()? })
    }

    /// Returns the bounds on a grid of about half as many cells along each axis: means over the fine cells of
    /// each coarse cell.
    pub(crate) fn coarse(&self) -> Self {
        Self { lower: self.lower.coarse(), upper: self.upper.coarse() }
    }

    /// Gathers the bounds of the whole grid from the slabs of all ranks.
    pub(super) fn collected(&self, slab: &Slab) -> Self {
        let collected = |values: &CellValues| match values {
            CellValues::Uniform(value) => CellValues::Uniform(*value),
            CellValues::Field(field) => CellValues::Field(slab.collected(field)),
        };
        Self { lower: collected(&self.lower), upper: collected(&self.upper) }
    }

    /// Returns an error if a bound is out of range.
    pub(super) fn validate(&self, shape: [usize; 2]) -> Result<()> {
        assert!(self.lower.fits(shape) && self.upper.fits(shape), "shape of the bounds");
        let wrong = |value: &f64| !(value.is_finite() && *value <= 0.0);
        let lower = match &self.lower {
            CellValues::Uniform(value) => Some(*value).filter(wrong),
            CellValues::Field(field) => field.iter().copied().find(wrong),
        };
        if let Some(value) = lower {
            check_in(Dimension::Pressure, "lower bound", value, false, "a finite pressure of at most 0")?;
        }
        let cells = match self.uniform() {
            Some(_) => 1,
            None => shape[0] * shape[1],
        };
        for cell in 0..cells {
            let Interval { lower, upper } = self.interval(cell);
            let (what, expected) = match lower {
                0.0 => ("hardness", "a hardness above 0"),
                _ => ("upper bound", "a pressure above the lower bound"),
            };
            check_in(Dimension::Pressure, what, upper, upper > lower, expected)?;
        }
        Ok(())
    }
}

impl From<Pascal> for Bounds {
    /// Creates the bounds for bodies with this hardness, see [`Bounds::up_to`].
    fn from(hardness: Pascal) -> Self {
        Self::up_to(hardness)
    }
}

/// The interval of the pressure of one cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Interval {
    pub(super) lower: Pascal,
    pub(super) upper: Pascal,
}

impl Interval {
    /// Returns the nearest pressure within the bounds.
    #[inline]
    pub(super) fn clamp(self, pressure: Pascal) -> Pascal {
        pressure.clamp(self.lower, self.upper)
    }

    /// Whether a pressure lies strictly between the bounds.
    #[inline]
    pub(super) fn is_free(self, pressure: Pascal) -> bool {
        (self.lower < pressure) & (pressure < self.upper)
    }
}

/// Evaluates an expression with `$of`, the [`Interval`] of a cell. The code is generated twice, for uniform
/// bounds and for fields, so that uniform bounds cost no more than two numbers.
macro_rules! with_bounds {
    ($bounds:expr, $of:ident => $do:expr) => {{
        let bounds = &$bounds;
        match bounds.uniform() {
            Some(interval) => {
                let $of = move |_: usize| interval;
                $do
            }
            None => {
                let $of = |cell: usize| bounds.interval(cell);
                $do
            }
        }
    }};
}
pub(super) use with_bounds;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Field;

    #[test]
    fn a_cell_touches_above_its_lower_bound_and_is_capped_at_its_upper_one() {
        let upper = Field::from_shape_fn([1, 3], |(_, j)| [1.0, 2.0, 3.0][j]);
        let bounds = Bounds::up_to(upper).above(-1.0);
        assert!(!bounds.touches(0, -1.0) && bounds.touches(0, -0.5) && bounds.touches(2, 0.0));
        assert!(bounds.caps(0, 1.0) && !bounds.caps(1, 1.0) && bounds.caps(1, 2.0));
        assert_eq!(bounds.interval(2), Interval { lower: -1.0, upper: 3.0 });
        assert_eq!(bounds.uniform(), None);
    }

    #[test]
    fn bounds_without_meaning_are_refused() {
        let field = |third: f64| Field::from_shape_fn([1, 3], |(_, j)| if j == 2 { third } else { 1.0 });
        assert!(Bounds::up_to(field(1.0)).validate([1, 3]).is_ok());
        for bounds in [
            Bounds::up_to(0.0),
            Bounds::up_to(f64::NAN),
            Bounds::up_to(field(0.0)),
            Bounds::up_to(field(f64::NAN)),
            Bounds::up_to(field(-2.0)).above(-1.0),
            Bounds::ELASTIC.above(0.5),
            Bounds::ELASTIC.above(f64::NEG_INFINITY),
            Bounds::ELASTIC.above(field(f64::NAN)),
        ] {
            assert!(bounds.validate([1, 3]).is_err(), "{bounds:?}");
        }
    }

    #[test]
    fn a_coarse_cell_bears_the_mean_of_those_that_it_stands_for() {
        let upper = Field::from_shape_fn([2, 3], |(i, j)| (3 * i + j) as f64);
        let coarse = Bounds::up_to(upper).coarse();
        assert_eq!(coarse.upper, CellValues::Field(ndarray::array![[2.0, 3.5]]));
        assert_eq!(Bounds::ELASTIC.coarse(), Bounds::ELASTIC);
    }
}
