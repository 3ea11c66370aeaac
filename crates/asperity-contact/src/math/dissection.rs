//! Nested dissection of the cells of a grid: the order in which unknowns are eliminated.

use std::ops::Range;

/// Most cells of a part that is not dissected further.
const LEAF: usize = 12;

/// Unknowns that are eliminated together, as a dense matrix.
pub(crate) struct Front {
    /// Numbers of the unknowns that are eliminated.
    pub(crate) pivots: Range<usize>,
    /// Numbers of the unknowns that these are joined to then, all larger, ascending.
    pub(crate) border: Vec<u32>,
    /// Fronts whose remainders enter this one; all come before it.
    pub(crate) children: Vec<usize>,
}

impl Front {
    /// Returns the row of an unknown in the matrix of the front: pivots first, then the border.
    pub(crate) fn position(&self, number: u32) -> usize {
        if (number as usize) < self.pivots.end {
            return number as usize - self.pivots.start;
        }
        self.pivots.len() + self.border.binary_search(&number).expect("a neighbour is in the border")
    }
}

/// The order of elimination of the cells of a grid.
///
/// A part is cut in two by rows of cells, which are eliminated after both. Near the middle the rows with the
/// fewest wanted cells are taken: where few are wanted, cuts are short. A part that is closed along a periodic axis
/// is cut open there before it is cut in two along this axis, at the row with the fewest cells of the grid.
pub(crate) struct Dissection {
    /// The cell of each number.
    pub(crate) cells: Vec<u32>,
    /// Fronts of cells, children before their parents, without their borders.
    pub(crate) fronts: Vec<Front>,
}

impl Dissection {
    /// Orders the `wanted` cells of a grid, each of which is joined to others at most `reach` cells away along
    /// each axis.
    pub(crate) fn new(shape: [usize; 2], wanted: &[bool], periodic: [bool; 2], reach: [usize; 2]) -> Self {
        let mut cuts = Cuts { shape, origin: [0; 2], reach, wanted, cells: Vec::new(), fronts: Vec::new() };
        let rows = |axis: usize| {
            let line = |index: usize| {
                let mut line = shape.map(|n| 0..n);
                line[axis] = index..index + 1;
                line
            };
            (0..shape[axis]).min_by_key(|index| cuts.wanted_in(line(*index)))
        };
        cuts.origin = [0, 1].map(|axis| if periodic[axis] { rows(axis).unwrap_or(0) } else { 0 });
        cuts.dissect(shape.map(|n| 0..n), periodic);
        Self { cells: cuts.cells, fronts: cuts.fronts }
    }
}

/// Finds the borders of fronts: the later unknowns that are joined to the pivots of a front, which `joined`
/// adds to a list, and what its children leave.
pub(crate) fn find_borders(fronts: &mut [Front], mut joined: impl FnMut(usize, &Front, &mut Vec<u32>)) {
    for index in 0..fronts.len() {
        let (before, front) = fronts.split_at_mut(index);
        let front = &mut front[0];
        let mut border = Vec::new();
        joined(index, front, &mut border);
        border.extend(front.children.iter().flat_map(|child| &before[*child].border));
        border.retain(|n| *n as usize >= front.pivots.end);
        border.sort_unstable();
        border.dedup();
        front.border = border;
    }
}

struct Cuts<'a> {
    shape: [usize; 2],
    /// The row along each axis at which the periodic grid is cut open: indices count from it.
    origin: [usize; 2],
    reach: [usize; 2],
    wanted: &'a [bool],
    cells: Vec<u32>,
    fronts: Vec<Front>,
}

impl Cuts<'_> {
    fn cell(&self, i: usize, j: usize) -> usize {
        let wrapped = |index: usize, axis: usize| {
            let sum = index + self.origin[axis];
            if sum < self.shape[axis] { sum } else { sum - self.shape[axis] }
        };
        wrapped(i, 0) * self.shape[1] + wrapped(j, 1)
    }

    fn wanted_in(&self, [x, y]: [Range<usize>; 2]) -> usize {
        x.map(|i| y.clone().filter(|j| self.wanted[self.cell(i, *j)]).count()).sum()
    }

    /// Numbers the wanted cells of a rectangle.
    fn push(&mut self, [x, y]: [Range<usize>; 2]) {
        for (i, j) in x.flat_map(|i| y.clone().map(move |j| (i, j))) {
            let cell = self.cell(i, j);
            if self.wanted[cell] {
                self.cells.push(cell as u32);
            }
        }
    }

    /// Makes a front of the cells numbered since `first`; without any, its children are left to the next one.
    fn front(&mut self, first: usize, children: Vec<usize>) -> Vec<usize> {
        if first == self.cells.len() {
            return children;
        }
        self.fronts.push(Front { pivots: first..self.cells.len(), border: Vec::new(), children });
        vec![self.fronts.len() - 1]
    }

    /// Numbers the cells of a rectangle, which may be `closed` along an axis, and returns the fronts that are left to the
    /// cells around it.
    fn dissect(&mut self, sides: [Range<usize>; 2], closed: [bool; 2]) -> Vec<usize> {
        let along = usize::from(sides[0].len() * self.reach[1] < sides[1].len() * self.reach[0]);
        let (start, length, thick) = (sides[along].start, sides[along].len(), self.reach[along]);
        if length <= thick || self.wanted_in(sides.clone()) <= LEAF {
            let first = self.cells.len();
            self.push(sides);
            return self.front(first, Vec::new());
        }
        let part = |range: Range<usize>| {
            let mut part = sides.clone();
            part[along] = range;
            part
        };
        if closed[along] {
            let mut open = closed;
            open[along] = false;
            let children = self.dissect(part(start + thick..start + length), open);
            let first = self.cells.len();
            self.push(part(start..start + thick));
            return self.front(first, children);
        }
        let cost = |index: usize| {
            let off = (2 * (index - start) + thick) as f64 / length as f64 - 1.0;
            (1.0 + self.wanted_in(part(index..index + thick)) as f64) * (1.0 + 2.0 * off * off)
        };
        let near = start + (length / 3).min(length - thick)..start + length - (length / 3).max(thick - 1);
        let cut = near.map(|index| (cost(index), index)).min_by(|a, b| a.0.total_cmp(&b.0));
        let (_, cut) = cut.expect("the middle third has a row");
        let mut children = self.dissect(part(start..cut), closed);
        children.append(&mut self.dissect(part(cut + thick..start + length), closed));
        let first = self.cells.len();
        self.push(part(cut..cut + thick));
        self.front(first, children)
    }
}
