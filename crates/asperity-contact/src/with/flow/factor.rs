//! Elimination of the cells of a network, front by front, as L D Lᵀ.
//!
//! Cells are eliminated as nodes of an electrical network are, by star–mesh transformation: node k leaves its
//! neighbours joined by a_ik a_jk/d_k, with d_k the sum of its transmissibilities at that time.
//! Transmissibilities are only added, never subtracted, so that all entries of L and D keep their full
//! relative accuracy at any contrast, and no pivot can become negative (W. K. Grassmann, M. I. Taksar, D. P.
//! Heyman, Oper. Res. 33, 1107 (1985)).

use super::faces::{Network, end_cells};
use super::ordering::Ordering;
use crate::math::Front;

/// Pivots that are applied to the rest of a front at a time.
const PANEL: usize = 32;

/// Rows and columns of a tile of the product that does so.
const TILE: usize = 4;

/// The factors of a network.
pub(super) struct Factor {
    ordering: Ordering,
    /// Rows of L, one for each pivot of each front: its fractions of d that lead to the later cells of the
    /// front, and the one to the reservoirs last.
    rows: Vec<Vec<f64>>,
    /// Sum of the transmissibilities of each cell when it is eliminated.
    pivots: Vec<f64>,
}

/// A front after elimination: transmissibilities between the cells of its border, and to the reservoirs in
/// the last column.
struct Remainder {
    front: usize,
    transmissibility: Vec<f64>,
}

impl Factor {
    /// Eliminates all cells of the ordering.
    pub(super) fn new(network: &Network, ordering: Ordering) -> Self {
        let entries = Entries::new(network, &ordering);
        let mut pivots = vec![0.0; ordering.cells.len()];
        let mut rows = Vec::with_capacity(ordering.fronts.len());
        let mut remainders: Vec<Remainder> = Vec::new();
        let mut panel = Panel::default();
        for (index, front) in ordering.fronts.iter().enumerate() {
            let (p, m) = (front.pivots.len(), front.pivots.len() + front.border.len());
            let (width, b) = (m + 1, m - p);
            let mut upper = vec![0.0; p * width];
            let mut rest = vec![0.0; b * (b + 1)];
            for (row, pivot) in front.pivots.clone().enumerate() {
                for (later, transmissibility) in entries.of(pivot) {
                    let column = if *later == u32::MAX { m } else { front.position(*later) };
                    upper[row * width + column] += transmissibility;
                }
            }
            // Fronts are stored in postorder, so that the remainders of the children are the last ones.
            let own = remainders.len() - front.children.len();
            for remainder in remainders.drain(own..) {
                add(
                    &ordering.fronts[remainder.front],
                    &remainder.transmissibility,
                    front,
                    &mut upper,
                    &mut rest,
                );
            }
            eliminate(&mut upper, &mut rest, p, m, &mut pivots[front.pivots.clone()], &mut panel);
            rows.push(upper);
            remainders.push(Remainder { front: index, transmissibility: rest });
        }
        Self { ordering, rows, pivots }
    }

    /// Solves for the potentials under the currents `right` into each cell, in its place, both indexed by the
    /// cells of the network. The last cell of a component without reservoirs is held at 0.
    pub(super) fn solve(&self, right: &mut [f64]) {
        let cells = &self.ordering.cells;
        let mut x: Vec<f64> = cells.iter().map(|cell| right[*cell as usize]).collect();
        let mut border = Vec::new();
        for (front, rows) in self.ordering.fronts.iter().zip(&self.rows) {
            let (p, width) = (front.pivots.len(), front.pivots.len() + front.border.len() + 1);
            border.clear();
            border.extend(front.border.iter().map(|n| x[*n as usize]));
            let own = &mut x[front.pivots.clone()];
            for (k, row) in rows.chunks_exact(width).enumerate() {
                let (known, later) = own.split_at_mut(k + 1);
                let known = known[k];
                for (x, l) in later.iter_mut().zip(&row[k + 1..p]).chain(border.iter_mut().zip(&row[p..])) {
                    *x += l * known;
                }
            }
            front.border.iter().zip(&border).for_each(|(n, new)| x[*n as usize] = *new);
        }
        for (front, rows) in self.ordering.fronts.iter().zip(&self.rows).rev() {
            let (p, width) = (front.pivots.len(), front.pivots.len() + front.border.len() + 1);
            border.clear();
            border.extend(front.border.iter().map(|n| x[*n as usize]));
            let own = &mut x[front.pivots.clone()];
            for (k, row) in rows.chunks_exact(width).enumerate().rev() {
                let pivot = self.pivots[front.pivots.start + k];
                let mut sum = if pivot > 0.0 { own[k] / pivot } else { 0.0 };
                for (x, l) in own[k + 1..].iter().zip(&row[k + 1..p]).chain(border.iter().zip(&row[p..])) {
                    sum += l * x;
                }
                own[k] = sum;
            }
        }
        for (cell, x) in cells.iter().zip(x) {
            right[*cell as usize] = x;
        }
    }
}

/// Transmissibilities of the network, of each cell to those with larger numbers.
struct Entries {
    starts: Vec<usize>,
    later: Vec<(u32, f64)>,
}

impl Entries {
    fn new(network: &Network, ordering: &Ordering) -> Self {
        const NONE: u32 = u32::MAX;
        let mut number = vec![NONE; network.cells()];
        for (n, cell) in ordering.cells.iter().enumerate() {
            number[*cell as usize] = n as u32;
        }
        let mut all: Vec<(u32, u32, f64)> = Vec::with_capacity(2 * ordering.cells.len());
        for (axis, faces) in network.faces.iter().enumerate() {
            for (cell, &face) in faces.iter().enumerate().filter(|(_, face)| **face > 0.0) {
                let (a, b) = (number[cell], number[network.before(cell, axis).0]);
                if a != NONE && b != NONE && a != b {
                    all.push((a.min(b), a.max(b), face));
                }
            }
        }
        if let Some(ends) = &network.ends {
            for (index, transmissibility) in
                [0, network.shape[ends.axis] - 1].into_iter().zip(&ends.transmissibility)
            {
                for (cell, &end) in end_cells(network.shape, ends.axis, index).zip(transmissibility) {
                    if end > 0.0 && number[cell] != NONE {
                        all.push((number[cell], NONE, end));
                    }
                }
            }
        }
        all.sort_by_key(|(first, ..)| *first);
        let mut starts = vec![0; ordering.cells.len() + 1];
        for (first, ..) in &all {
            starts[*first as usize + 1] += 1;
        }
        for n in 1..starts.len() {
            starts[n] += starts[n - 1];
        }
        Self { starts, later: all.into_iter().map(|(_, later, value)| (later, value)).collect() }
    }

    fn of(&self, pivot: usize) -> &[(u32, f64)] {
        &self.later[self.starts[pivot]..self.starts[pivot + 1]]
    }
}

/// Adds the remainder of a child to its parent.
fn add(child: &Front, remainder: &[f64], parent: &Front, upper: &mut [f64], rest: &mut [f64]) {
    let (p, m) = (parent.pivots.len(), parent.pivots.len() + parent.border.len());
    let b = child.border.len();
    let mut positions = Vec::with_capacity(b + 1);
    let mut at = 0;
    for number in &child.border {
        positions.push(if (*number as usize) < parent.pivots.end {
            *number as usize - parent.pivots.start
        } else {
            while parent.border[at] < *number {
                at += 1;
            }
            p + at
        });
    }
    positions.push(m);
    for (i, row) in remainder.chunks_exact(b + 1).enumerate() {
        let to = positions[i];
        let target = if to < p { &mut upper[to * (m + 1)..] } else { &mut rest[(to - p) * (m - p + 1)..] };
        let shift = if to < p { 0 } else { p };
        for (value, position) in row[i + 1..].iter().zip(&positions[i + 1..]) {
            target[position - shift] += value;
        }
    }
}

/// Panels of pivots in tiles.
#[derive(Default)]
struct Panel {
    fractions: Vec<[f64; TILE]>,
    weighted: Vec<[f64; TILE]>,
}

/// Eliminates the first `p` of `m` cells. `upper` has their rows, `rest` those of the others from column `p`
/// on; only what is right of the diagonal counts. The last column of both leads to the reservoirs. Rows of
/// `upper` become fractions of their sum.
fn eliminate(upper: &mut [f64], rest: &mut [f64], p: usize, m: usize, pivots: &mut [f64], panel: &mut Panel) {
    let width = m + 1;
    for first in (0..p).step_by(PANEL) {
        let last = p.min(first + PANEL);
        for k in first..last {
            let (before, row) = upper[..(k + 1) * width].split_at_mut(k * width);
            let row = &mut row[k + 1..];
            for i in first..k {
                let other = &before[i * width + k..][..width - k];
                let factor = other[0] * pivots[i];
                if factor > 0.0 {
                    row.iter_mut().zip(&other[1..]).for_each(|(x, l)| *x += factor * l);
                }
            }
            let pivot = sum(row);
            pivots[k] = pivot;
            if pivot > 0.0 {
                row.iter_mut().for_each(|x| *x /= pivot);
            }
        }
        let columns = width - last;
        if columns < 2 {
            continue;
        }
        panel.pack(&upper[first * width..last * width], width, last, &pivots[first..last]);
        let depth = last - first;
        // Rows of the later pivots, then those of the border.
        let own = p - last;
        for tile in 0..(columns - 1).div_ceil(TILE) {
            for column in tile..columns.div_ceil(TILE) {
                let product = product(
                    &panel.weighted[tile * depth..(tile + 1) * depth],
                    &panel.fractions[column * depth..(column + 1) * depth],
                );
                for (r, products) in product.iter().enumerate() {
                    let i = tile * TILE + r;
                    let target = if i < own {
                        &mut upper[(last + i) * width + last..(last + i + 1) * width]
                    } else if i < columns - 1 {
                        &mut rest[(i - own) * (m - p + 1)..(i - own + 1) * (m - p + 1)]
                    } else {
                        break;
                    };
                    let from = column * TILE - if i < own { 0 } else { own.min(column * TILE) };
                    // A tile of columns may begin among the pivots and end in the border.
                    let skip = if i < own { 0 } else { own.saturating_sub(column * TILE) };
                    let count = TILE.min(columns - column * TILE);
                    for (x, product) in target[from..].iter_mut().zip(&products[skip.min(count)..count]) {
                        *x += product;
                    }
                }
            }
        }
    }
}

impl Panel {
    /// Packs the columns from `first` on of these rows.
    fn pack(&mut self, rows: &[f64], width: usize, first: usize, pivots: &[f64]) {
        let tiles = (width - first).div_ceil(TILE);
        self.fractions.clear();
        self.fractions.resize(tiles * pivots.len(), [0.0; TILE]);
        for (k, row) in rows.chunks_exact(width).enumerate() {
            for (tile, values) in row[first..].chunks(TILE).enumerate() {
                self.fractions[tile * pivots.len() + k][..values.len()].copy_from_slice(values);
            }
        }
        self.weighted.clear();
        self.weighted.extend(
            self.fractions.iter().enumerate().map(|(at, tile)| tile.map(|x| x * pivots[at % pivots.len()])),
        );
    }
}

/// Products of two tiles, summed over the pivots of a panel.
#[inline]
fn product(a: &[[f64; TILE]], b: &[[f64; TILE]]) -> [[f64; TILE]; TILE] {
    let mut sums = [[0.0; TILE]; TILE];
    for (a, b) in a.iter().zip(b) {
        for (sums, a) in sums.iter_mut().zip(a) {
            for (sum, b) in sums.iter_mut().zip(b) {
                *sum += a * b;
            }
        }
    }
    sums
}

/// Sum in four strands.
fn sum(values: &[f64]) -> f64 {
    let mut strands = [0.0; 4];
    let chunks = values.chunks_exact(4);
    let rest: f64 = chunks.remainder().iter().sum();
    for chunk in chunks {
        strands.iter_mut().zip(chunk).for_each(|(sum, x)| *sum += x);
    }
    (strands[0] + strands[1]) + (strands[2] + strands[3]) + rest
}
