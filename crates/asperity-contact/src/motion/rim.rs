//! The interior of a body: the cells not disturbed by its free ends.

use std::ops::Range;

use ndarray::{ArrayView2, s};

use crate::grid::Field;
use crate::motion::kinematics::Strategy;
use crate::operator::Boundary;

/// Cells of a body farther than the rim from its free ends.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Interior {
    ranges: [Range<usize>; 2],
    width: usize,
}

impl Interior {
    /// Creates the interiors of the lower and of the upper body with these `shapes`. The rim is the fraction
    /// `rim` of their length, 0 to ½. The interior holds the cells whose centres are farther than `rim` ×
    /// length from each free end, and at least the one or two cells in the middle.
    ///
    /// Ends along x are free in an overlap. A shift joins the ends, but those of a stationary body are free
    /// under a boundary that is free along x. Ends along y are free under a boundary that is free along y.
    pub fn of_bodies(shapes: [[usize; 2]; 2], boundary: Boundary, strategy: Strategy, rim: f64) -> [Self; 2] {
        let ends = match strategy {
            Strategy::Overlap => [true; 2],
            Strategy::Shift { speed_lower, speed_upper } => {
                [speed_lower, speed_upper].map(|speed| !boundary.repeats(0) && speed == 0.0)
            }
        };
        [0, 1].map(|body| {
            let range = |axis: usize, free: bool| {
                let cells = shapes[body][axis];
                let outside = if free { (rim * cells as f64 + 0.5).floor() as usize } else { 0 };
                let outside = outside.min((cells - 1) / 2);
                outside..cells - outside
            };
            Self { ranges: [range(0, ends[body]), range(1, !boundary.repeats(1))], width: shapes[body][1] }
        })
    }

    /// Whether a flat cell of the body lies in the interior.
    pub fn holds(&self, cell: usize) -> bool {
        self.ranges[0].contains(&(cell / self.width)) && self.ranges[1].contains(&(cell % self.width))
    }

    /// Returns the interior part of a field on the body.
    pub fn slice<'a>(&self, field: &'a Field) -> ArrayView2<'a, f64> {
        let [columns, across] = &self.ranges;
        field.slice(s![columns.clone(), across.clone()])
    }

    /// Number of cells of the interior.
    pub fn cells(&self) -> usize {
        self.ranges[0].len() * self.ranges[1].len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::operator::Edge;

    const ROLL: Strategy = Strategy::Shift { speed_lower: 1.0, speed_upper: 1.0 };
    const SLIDE: Strategy = Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 };

    fn ranges(shape: [usize; 2], boundary: Boundary, strategy: Strategy, rim: f64) -> [[Range<usize>; 2]; 2] {
        Interior::of_bodies([shape; 2], boundary, strategy, rim).map(|interior| interior.ranges)
    }

    #[test]
    fn only_free_ends_have_a_rim() {
        let (whole, within) = (0..20, 2..18);
        let both = [within.clone(), within.clone()];
        let ends = [within.clone(), whole.clone()];
        let sides = [whole.clone(), within];
        let none = [whole.clone(), whole];
        let shape = [20, 20];
        assert_eq!(ranges(shape, Boundary::FREE, Strategy::Overlap, 0.1), [both.clone(), both.clone()]);
        assert_eq!(ranges(shape, Boundary::FREE, ROLL, 0.1), [sides.clone(), sides.clone()]);
        assert_eq!(ranges(shape, Boundary::FREE, SLIDE, 0.1), [both, sides]);
        assert_eq!(ranges(shape, Boundary::PERIODIC, SLIDE, 0.1), [none.clone(), none]);
        let line = Boundary([Edge::Free, Edge::Periodic]);
        assert_eq!(ranges(shape, line, Strategy::Overlap, 0.1), [ends.clone(), ends.clone()]);
        assert_eq!(ranges(shape, line, SLIDE, 0.1)[0], ends);
    }

    #[test]
    fn the_centres_of_interior_cells_are_farther_from_the_ends_than_the_rim() {
        for cells in 1..40 {
            for rim in [0.0, 0.01, 0.1, 0.25, 0.3, 0.4999] {
                let [[columns, _], _] = ranges([cells, 3], Boundary::FREE, Strategy::Overlap, rim);
                let far = |i: usize| (i as f64 + 0.5).min((cells - i) as f64 - 0.5) > rim * cells as f64;
                let expected: Vec<usize> = (0..cells).filter(|&i| far(i)).collect();
                let middle: Vec<usize> = ((cells - 1) / 2..=cells / 2).collect();
                let expected = if expected.is_empty() { middle } else { expected };
                assert_eq!(columns.collect::<Vec<_>>(), expected, "{cells} cells, rim {rim}");
            }
        }
        assert_eq!(Interior::of_bodies([[5, 3]; 2], Boundary::FREE, Strategy::Overlap, 0.0)[0].cells(), 15);
    }
}
