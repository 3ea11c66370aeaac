//! The order in which cells are eliminated: nested dissection of the grid by rows of cells.

use std::ops::Range;

use super::faces::{Network, end_cells};

/// Most cells of a part that is not dissected further.
const LEAF: usize = 12;

/// No number: the cell is not solved for.
const NONE: u32 = u32::MAX;

/// Cells that are eliminated together, as a dense matrix.
pub(super) struct Front {
    /// Numbers of the cells that are eliminated.
    pub(super) pivots: Range<usize>,
    /// Numbers of the cells that these are joined to then, all larger, ascending.
    pub(super) border: Vec<u32>,
    /// Fronts whose remainders enter this one; all come before it.
    pub(super) children: Vec<usize>,
}

/// The order of elimination, and the fronts in which it is done.
pub(super) struct Ordering {
    /// The cell of each number.
    pub(super) cells: Vec<u32>,
    /// Fronts, children before their parents.
    pub(super) fronts: Vec<Front>,
}

impl Ordering {
    /// Orders the cells of the network that are `wanted`.
    ///
    /// A part is cut in two by a row of cells, which is eliminated after both. Near the middle the row with
    /// the fewest wanted cells is taken: where bodies touch, cuts are short. A periodic axis is first cut at
    /// the row with the fewest cells of all.
    pub(super) fn new(network: &Network, wanted: &[bool], periodic: [bool; 2]) -> Self {
        let shape = network.shape;
        let count =
            |axis: usize, index: usize| end_cells(shape, axis, index).filter(|cell| wanted[*cell]).count();
        let origin = [0, 1].map(|axis| {
            let shortest = (0..shape[axis]).min_by_key(|index| count(axis, *index));
            if periodic[axis] { shortest.unwrap_or(0) } else { 0 }
        });
        let mut dissection = Dissection { shape, origin, wanted, cells: Vec::new(), fronts: Vec::new() };
        let part = [0, 1].map(|axis| usize::from(periodic[axis])..shape[axis]);
        let roots = dissection.dissect(part);
        // The rows at the origin of the periodic axes close the rings.
        let [nx, ny] = shape;
        let first = dissection.cells.len();
        if periodic[1] {
            dissection.push(usize::from(periodic[0])..nx, 0..1);
        }
        if periodic[0] {
            dissection.push(0..1, 0..ny);
        }
        dissection.front(first, roots);
        let Dissection { cells, mut fronts, .. } = dissection;
        find_borders(network, &cells, &mut fronts);
        Self { cells, fronts }
    }
}

struct Dissection<'a> {
    shape: [usize; 2],
    /// The row along each axis at which the periodic grid is cut open: indices count from it.
    origin: [usize; 2],
    wanted: &'a [bool],
    cells: Vec<u32>,
    fronts: Vec<Front>,
}

impl Dissection<'_> {
    fn cell(&self, i: usize, j: usize) -> usize {
        let wrapped = |index: usize, axis: usize| {
            let sum = index + self.origin[axis];
            if sum < self.shape[axis] { sum } else { sum - self.shape[axis] }
        };
        wrapped(i, 0) * self.shape[1] + wrapped(j, 1)
    }

    fn wanted_in(&self, x: Range<usize>, y: Range<usize>) -> usize {
        x.map(|i| y.clone().filter(|j| self.wanted[self.cell(i, *j)]).count()).sum()
    }

    /// Numbers the wanted cells of a rectangle.
    fn push(&mut self, x: Range<usize>, y: Range<usize>) {
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

    /// Numbers the cells of a rectangle and returns the fronts that are left to the cells around it.
    fn dissect(&mut self, [x, y]: [Range<usize>; 2]) -> Vec<usize> {
        let count = self.wanted_in(x.clone(), y.clone());
        if count <= LEAF {
            let first = self.cells.len();
            self.push(x, y);
            return self.front(first, Vec::new());
        }
        let along = if x.len() >= y.len() { 0 } else { 1 };
        let sides = [x.clone(), y.clone()];
        let line = |index: usize| {
            let mut line = sides.clone();
            line[along] = index..index + 1;
            line
        };
        let (start, length) = (sides[along].start, sides[along].len());
        let cost = |index: usize| {
            let [x, y] = line(index);
            let off = (2 * (index - start) + 1) as f64 / length as f64 - 1.0;
            (1.0 + self.wanted_in(x, y) as f64) * (1.0 + 2.0 * off * off)
        };
        let near = start + length / 3..start + length - length / 3;
        let cut = near.map(|index| (cost(index), index)).min_by(|a, b| a.0.total_cmp(&b.0));
        let (_, cut) = cut.expect("the middle third has a row");
        let (mut below, mut above) = (sides.clone(), sides.clone());
        below[along].end = cut;
        above[along].start = cut + 1;
        let mut children = self.dissect(below);
        children.append(&mut self.dissect(above));
        let first = self.cells.len();
        let [x, y] = line(cut);
        self.push(x, y);
        self.front(first, children)
    }
}

/// Finds the borders: the later neighbours of the pivots and what the children leave.
fn find_borders(network: &Network, cells: &[u32], fronts: &mut [Front]) {
    let mut number = vec![NONE; network.cells()];
    for (n, cell) in cells.iter().enumerate() {
        number[*cell as usize] = n as u32;
    }
    let mut neighbours: Vec<(u32, u32)> = Vec::new();
    for (axis, faces) in network.faces.iter().enumerate() {
        for (cell, _) in faces.iter().enumerate().filter(|(_, face)| **face > 0.0) {
            let (a, b) = (number[cell], number[network.before(cell, axis).0]);
            if a != NONE && b != NONE && a != b {
                neighbours.push((a.min(b), a.max(b)));
            }
        }
    }
    neighbours.sort_unstable();
    let mut at = 0;
    for index in 0..fronts.len() {
        let pivots = fronts[index].pivots.clone();
        let mut border: Vec<u32> = Vec::new();
        while let Some((_, later)) = neighbours.get(at).filter(|(first, _)| (*first as usize) < pivots.end) {
            border.push(*later);
            at += 1;
        }
        for child in fronts[index].children.clone() {
            border.extend(&fronts[child].border);
        }
        border.retain(|n| *n as usize >= pivots.end);
        border.sort_unstable();
        border.dedup();
        fronts[index].border = border;
    }
}
