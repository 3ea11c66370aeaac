//! Connected parts of the open cells, and the ways in which they wind around the periods or touch the ends.

use super::faces::{Network, end_cells};

/// A path of the component leads once around x, or more often.
pub(super) const WINDS_X: u8 = 1;
/// A path of the component leads around y.
pub(super) const WINDS_Y: u8 = 2;
/// The component touches the reservoir at the start of the axis.
pub(super) const AT_START: u8 = 4;
/// The component touches the reservoir at the end of the axis.
pub(super) const AT_END: u8 = 8;
const WINDS: [u8; 2] = [WINDS_X, WINDS_Y];

/// A union of sets of cells. Each cell knows its offset from the root of its set in whole periods, so that a
/// face that closes a loop reveals how often the loop winds around each axis.
pub(super) struct Components {
    parent: Vec<u32>,
    /// Periods between a cell and its parent.
    offset: Vec<[i32; 2]>,
    /// Properties of the set, at its root.
    marks: Vec<u8>,
}

impl Components {
    /// Creates a set for each cell.
    pub(super) fn single(cells: usize) -> Self {
        Self { parent: (0..cells as u32).collect(), offset: vec![[0; 2]; cells], marks: vec![0; cells] }
    }

    /// Creates the components of a network.
    pub(super) fn from_network(network: &Network) -> Self {
        let mut components = Self::single(network.cells());
        for (axis, faces) in network.faces.iter().enumerate() {
            for (cell, _) in faces.iter().enumerate().filter(|(_, face)| **face > 0.0) {
                let (before, seam) = network.before(cell, axis);
                components.join(before, cell, axis, seam);
            }
        }
        if let Some(ends) = &network.ends {
            let marks = [(AT_START, 0), (AT_END, network.shape[ends.axis] - 1)];
            for ((mark, index), transmissibility) in marks.into_iter().zip(&ends.transmissibility) {
                for (cell, &end) in end_cells(network.shape, ends.axis, index).zip(transmissibility) {
                    if end > 0.0 {
                        components.mark(cell, mark);
                    }
                }
            }
        }
        components
    }

    /// Joins the set of `before` with that of `cell`, its neighbour towards growing `axis`, beyond a `seam`
    /// or not. Returns the marks of their common set.
    pub(super) fn join(&mut self, before: usize, cell: usize, axis: usize, seam: bool) -> u8 {
        let ((a, to_a), (b, to_b)) = (self.find(before), self.find(cell));
        let mut between = [to_a[0] - to_b[0], to_a[1] - to_b[1]];
        between[axis] += i32::from(seam);
        if a == b {
            for (periods, mark) in between.into_iter().zip(WINDS) {
                if periods != 0 {
                    self.marks[a] |= mark;
                }
            }
            return self.marks[a];
        }
        // The smaller index becomes the root: cells are joined row by row, so that the paths stay short.
        let (root, other, sign) = if a < b { (a, b, 1) } else { (b, a, -1) };
        self.parent[other] = root as u32;
        self.offset[other] = between.map(|periods| sign * periods);
        self.marks[root] |= self.marks[other];
        self.marks[root]
    }

    /// Adds a mark to the set of a cell and returns all of its marks.
    pub(super) fn mark(&mut self, cell: usize, mark: u8) -> u8 {
        let (root, _) = self.find(cell);
        self.marks[root] |= mark;
        self.marks[root]
    }

    /// Returns the marks of the set of a cell.
    pub(super) fn marks(&mut self, cell: usize) -> u8 {
        let (root, _) = self.find(cell);
        self.marks[root]
    }

    /// Returns the root of the set of a cell, and the periods between both. Shortens the path to the root.
    fn find(&mut self, cell: usize) -> (usize, [i32; 2]) {
        let (mut root, mut total) = (cell, [0; 2]);
        while self.parent[root] as usize != root {
            total = sum(total, self.offset[root]);
            root = self.parent[root] as usize;
        }
        let (mut at, mut rest) = (cell, total);
        while self.parent[at] as usize != root && at != root {
            let (next, offset) = (self.parent[at] as usize, self.offset[at]);
            (self.parent[at], self.offset[at]) = (root as u32, rest);
            rest = [rest[0] - offset[0], rest[1] - offset[1]];
            at = next;
        }
        (root, total)
    }
}

fn sum(a: [i32; 2], b: [i32; 2]) -> [i32; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

#[cfg(test)]
mod tests {
    use super::super::faces::{Faces, Topology};
    use super::*;

    fn marks(rows: &[&str], closed: [bool; 2], between: Option<usize>) -> Vec<u8> {
        let shape = [rows.len(), rows[0].len()];
        let gaps: Vec<f64> =
            rows.iter().flat_map(|row| row.bytes().map(|b| f64::from(u8::from(b == b'o')))).collect();
        let network = Network::new(&gaps, [1.0; 2], Faces::Linear, Topology { shape, closed, between });
        let mut components = Components::from_network(&network);
        (0..gaps.len()).map(|cell| components.marks(cell)).collect()
    }

    #[test]
    fn a_staircase_winds_around_both_axes_at_once() {
        let stairs = ["oo..", ".oo.", "..oo", "o..o"];
        assert_eq!(marks(&stairs, [false; 2], None).into_iter().max(), Some(WINDS_X | WINDS_Y));
        assert_eq!(marks(&stairs, [false, true], None), [0; 16]);
    }

    #[test]
    fn two_steps_up_and_two_down_wind_around_x_alone() {
        let there_and_back = ["oo..", ".oo.", "..oo", "..oo", ".oo.", "oo.."];
        let winding = marks(&there_and_back, [false; 2], None);
        assert_eq!((winding[0], winding[2]), (WINDS_X, 0));
    }

    #[test]
    fn a_helix_that_winds_three_times_around_y_winds_around_x() {
        // Each channel along y ends one row further, through the seam.
        let helix = ["oooo", "....", "oooo", "....", "oooo", "...."];
        assert_eq!(marks(&helix, [false; 2], None)[0], WINDS_Y);
        let joined = ["ooooo.", ".....o", "oooooo", "o.....", "oooooo", ".....o"];
        assert!(marks(&joined, [true, false], None).into_iter().all(|mark| mark == WINDS_Y || mark == 0));
    }

    #[test]
    fn ends_are_touched_by_what_reaches_them() {
        let found = marks(&["o.oo", "o..o", "..oo", ".o.o"], [true, true], Some(0));
        assert_eq!(found[0], AT_START);
        assert_eq!(found[3], AT_START | AT_END);
        assert_eq!((found[2], found[13], found[1]), (AT_START | AT_END, AT_END, 0));
    }
}
