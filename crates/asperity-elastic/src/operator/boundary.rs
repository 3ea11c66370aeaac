//! Boundary of a contact: its continuation beyond the edges.

use serde::Serialize;

use crate::grid::{Field, Grid};
use crate::kernel::Line;
use crate::math::good_size;
use crate::units::Metre;
use asperity_base::choice::choice;

/// Continuation of the contact beyond its edges along one axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Edge {
    /// An unloaded half-space.
    #[default]
    Free,
    /// Copies of the contact.
    Periodic,
}

choice!(Edge: "free" => Free, "periodic" => Periodic);

/// Continuation of the contact beyond its edges along x and along y.
///
/// With one free and one periodic axis the contact is an endless line of copies. The displacement under a
/// load then has no bound relative to distant points. Its uniform part along the line is −(2/πE*) ln(r/r₀)
/// under a unit force per length. It is 0 at the distance r₀ of the [`super::Operators`], to which the
/// approach refers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(into = "Words")]
pub struct Boundary(pub [Edge; 2]);

impl Boundary {
    /// An unloaded half-space all around.
    pub const FREE: Self = Self([Edge::Free; 2]);
    /// Copies of the contact along both axes.
    pub const PERIODIC: Self = Self([Edge::Periodic; 2]);

    /// Whether the surface is periodic along an axis.
    pub fn repeats(self, axis: usize) -> bool {
        self.0[axis] == Edge::Periodic
    }

    /// Returns, for each axis, whether the surface is periodic.
    pub fn wraps(self) -> [bool; 2] {
        self.0.map(|edge| edge == Edge::Periodic)
    }

    /// Whether the surface is periodic along both axes, so that a uniform pressure moves it without
    /// resistance.
    pub fn leaves_mean_free(self) -> bool {
        self == Self::PERIODIC
    }

    /// Sums the outermost cells of a field at its free sides.
    pub fn outermost(self, field: &Field) -> f64 {
        let shape = [field.nrows(), field.ncols()];
        let is_rim = |axis: usize, i: usize| !self.repeats(axis) && (i == 0 || i + 1 == shape[axis]);
        field.indexed_iter().filter(|((i, j), _)| is_rim(0, *i) || is_rim(1, *j)).map(|(_, p)| p).sum()
    }

    /// Returns the only periodic axis, if there is exactly one.
    pub fn single_period(self) -> Option<usize> {
        match self.0 {
            [Edge::Periodic, Edge::Free] => Some(0),
            [Edge::Free, Edge::Periodic] => Some(1),
            _ => None,
        }
    }

    /// Returns the r₀ of operators on grids up to this one: its length along the free axis.
    pub fn datum(self, largest: &Grid) -> Metre {
        self.single_period().map_or(0.0, |axis| largest.extent()[1 - axis])
    }

    /// Returns the line of the periodic images of a cell of `grid`, for a given r₀.
    pub fn line(self, grid: &Grid, datum: Metre) -> Option<Line> {
        self.single_period().map(|axis| Line { axis, period: grid.extent()[axis], datum })
    }

    /// Returns the size of transforms whose cyclic convolution of fields of `shape` is the convolution with
    /// this boundary.
    pub fn padded(self, shape: [usize; 2]) -> [usize; 2] {
        [0, 1].map(|axis| if self.repeats(axis) { shape[axis] } else { good_size(2 * shape[axis] - 1) })
    }

    /// Returns the grid of about half as many cells along each axis. Along a free axis a coarse cell is two
    /// cells of `grid`, and the last coarse cell extends beyond an odd number of cells. Along a periodic axis
    /// the period is preserved.
    pub fn coarse(self, grid: &Grid) -> Grid {
        let shape = grid.shape.map(|n| n.div_ceil(2));
        let pitch = [0, 1].map(|axis| {
            if self.repeats(axis) { grid.extent()[axis] / shape[axis] as f64 } else { 2.0 * grid.pitch[axis] }
        });
        Grid { shape, pitch }
    }
}

/// A boundary in serialised form: a word for both axes, or one for each.
#[derive(Serialize)]
#[serde(untagged)]
enum Words {
    Both(Edge),
    Each([Edge; 2]),
}

impl From<Boundary> for Words {
    fn from(Boundary(edges): Boundary) -> Self {
        if edges[0] == edges[1] { Self::Both(edges[0]) } else { Self::Each(edges) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MIXED: Boundary = Boundary([Edge::Free, Edge::Periodic]);

    #[test]
    fn one_word_is_both_axes() {
        for (boundary, words) in [
            (Boundary::FREE, "\"free\""),
            (Boundary::PERIODIC, "\"periodic\""),
            (MIXED, "[\"free\",\"periodic\"]"),
        ] {
            assert_eq!(serde_json::to_string(&boundary).unwrap(), words);
        }
    }

    #[test]
    fn only_free_axes_are_padded_and_a_period_stays_on_the_coarse_grid() {
        assert_eq!(MIXED.padded([7, 7]), [good_size(13), 7]);
        let coarse = MIXED.coarse(&Grid::new([7, 7], [1.0, 1.0]).unwrap());
        assert_eq!((coarse.shape, coarse.pitch), ([4, 4], [2.0, 7.0 / 4.0]));
    }
}
