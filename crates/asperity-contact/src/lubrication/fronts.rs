//! Factors L U of an unsymmetric sparse matrix on the cells of a grid, front by front, in the order of a nested
//! dissection. There is no pivoting.

use std::sync::OnceLock;

use ndarray::linalg::general_mat_mul;
use ndarray::{ArrayView2, ArrayViewMut2, s};

use crate::math::{Dissection, Front, find_borders, parallel};

/// Pivots that are applied to the rest of a front at a time.
const PANEL: usize = 24;

/// Fewest rows of a front whose children are worth a thread each.
const WORTH_A_THREAD: usize = 64;

/// A sparse matrix by rows.
pub(super) struct Matrix {
    pub(super) starts: Vec<usize>,
    pub(super) columns: Vec<u32>,
    pub(super) values: Vec<f64>,
}

impl Matrix {
    pub(super) fn new() -> Self {
        Self { starts: vec![0], columns: Vec::new(), values: Vec::new() }
    }

    pub(super) fn push(&mut self, column: u32, value: f64) {
        if value != 0.0 {
            self.columns.push(column);
            self.values.push(value);
        }
    }

    pub(super) fn end_row(&mut self) {
        self.starts.push(self.columns.len());
    }

    fn row(&self, row: usize) -> impl Iterator<Item = (u32, f64)> {
        let range = self.starts[row]..self.starts[row + 1];
        self.columns[range.clone()].iter().copied().zip(self.values[range].iter().copied())
    }
}

/// The factors of a front in single precision: they serve a preconditioner.
struct Part {
    /// Columns of the pivots: L below the diagonal, and U of the pivots themselves.
    lower: Vec<f32>,
    /// Rows of the pivots in the columns of the border.
    upper: Vec<f32>,
}

/// The factors of a matrix.
pub(super) struct Factor {
    /// The unknown of each place in the order of elimination.
    order: Vec<u32>,
    fronts: Vec<Front>,
    parts: Vec<Part>,
}

/// An entry: the places of its row and of its column, and its value.
type Entry = (u32, u32, f64);

impl Factor {
    /// Factors a matrix on a grid of `shape` that repeats along y or not. `unknowns` lists those of each cell.
    /// A cell is joined to others up to `reach` cells away along each axis.
    pub(super) fn new(
        matrix: &Matrix,
        shape: [usize; 2],
        repeats: bool,
        reach: [usize; 2],
        unknowns: &[[Option<u32>; 2]],
    ) -> Self {
        let (order, mut fronts) = ordered(shape, repeats, reach, unknowns);
        let entries = Entries::new(matrix, &order, &fronts);
        find_borders(&mut fronts, |f, _, border| {
            border.extend(entries.of_front(f).iter().map(|(row, column, _)| *row.max(column)));
        });
        let parts: Vec<OnceLock<Part>> = fronts.iter().map(|_| OnceLock::new()).collect();
        let elimination = Elimination { fronts: &fronts, entries: &entries, parts: &parts };
        let mut is_child = vec![false; fronts.len()];
        fronts.iter().flat_map(|front| &front.children).for_each(|child| is_child[*child] = true);
        for root in (0..fronts.len()).filter(|f| !is_child[*f]) {
            elimination.eliminate(root);
        }
        let parts = parts.into_iter().map(|part| part.into_inner().expect("every front is eliminated"));
        Self { order, parts: parts.collect(), fronts }
    }

    /// Solves for the unknowns, in the place of the right-hand side.
    pub(super) fn solve(&self, right: &mut [f64]) {
        let mut x: Vec<f64> = self.order.iter().map(|unknown| right[*unknown as usize]).collect();
        for (front, part) in self.fronts.iter().zip(&self.parts) {
            let (p, start) = (front.pivots.len(), front.pivots.start);
            for i in 1..p {
                x[start + i] -= dot(&part.lower[i * p..i * p + i], &x[start..]);
            }
            for (row, place) in part.lower[p * p..].chunks_exact(p).zip(&front.border) {
                x[*place as usize] -= dot(row, &x[start..]);
            }
        }
        let mut border = Vec::new();
        for (front, part) in self.fronts.iter().zip(&self.parts).rev() {
            let (p, b, start) = (front.pivots.len(), front.border.len(), front.pivots.start);
            border.clear();
            border.extend(front.border.iter().map(|place| x[*place as usize]));
            for i in (0..p).rev() {
                let known = dot(&part.upper[i * b..(i + 1) * b], &border)
                    + dot(&part.lower[i * p + i + 1..(i + 1) * p], &x[start + i + 1..]);
                x[start + i] = (x[start + i] - known) / f64::from(part.lower[i * p + i]);
            }
        }
        for (unknown, x) in self.order.iter().zip(x) {
            right[*unknown as usize] = x;
        }
    }
}

/// Returns the product of coefficients with as many values.
#[inline]
fn dot(coefficients: &[f32], values: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let chunks = coefficients.chunks_exact(4);
    let rest = chunks.remainder();
    let tail = coefficients.len() - rest.len();
    for (a, b) in chunks.zip(values.chunks_exact(4)) {
        sums.iter_mut().zip(a).zip(b).for_each(|((sum, a), b)| *sum += f64::from(*a) * b);
    }
    let rest: f64 = rest.iter().zip(&values[tail..]).map(|(a, b)| f64::from(*a) * b).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

/// Orders the unknowns of the cells of a grid.
fn ordered(
    shape: [usize; 2],
    repeats: bool,
    reach: [usize; 2],
    unknowns: &[[Option<u32>; 2]],
) -> (Vec<u32>, Vec<Front>) {
    let wanted: Vec<bool> = unknowns.iter().map(|of_cell| of_cell.iter().any(Option::is_some)).collect();
    let Dissection { cells, mut fronts } = Dissection::new(shape, &wanted, [false, repeats], reach);
    let mut order = Vec::with_capacity(2 * cells.len());
    for front in &mut fronts {
        let first = order.len();
        for cell in &cells[front.pivots.clone()] {
            order.extend(unknowns[*cell as usize].iter().flatten());
        }
        front.pivots = first..order.len();
    }
    (order, fronts)
}

/// The entries of a matrix by the front that eliminates the first of their row and column.
struct Entries {
    /// Begin of the entries of each front, and the end of the last one.
    starts: Vec<usize>,
    entries: Vec<Entry>,
}

impl Entries {
    fn new(matrix: &Matrix, order: &[u32], fronts: &[Front]) -> Self {
        let mut place = vec![0; order.len()];
        for (k, unknown) in order.iter().enumerate() {
            place[*unknown as usize] = k as u32;
        }
        let mut front_of = vec![0; order.len()];
        for (f, front) in fronts.iter().enumerate() {
            front_of[front.pivots.clone()].fill(f);
        }
        let placed = |row: usize| {
            let (own, place) = (place[row], &place);
            matrix.row(row).map(move |(column, value)| (own, place[column as usize], value))
        };
        let of = |(row, column, _): Entry| front_of[row.min(column) as usize];
        let mut starts = vec![0; fronts.len() + 1];
        (0..order.len()).flat_map(placed).for_each(|entry| starts[of(entry) + 1] += 1);
        for f in 0..fronts.len() {
            starts[f + 1] += starts[f];
        }
        let mut next = starts.clone();
        let mut entries = vec![(0, 0, 0.0); starts[fronts.len()]];
        for entry in (0..order.len()).flat_map(placed) {
            let next = &mut next[of(entry)];
            entries[*next] = entry;
            *next += 1;
        }
        Self { starts, entries }
    }

    fn of_front(&self, f: usize) -> &[Entry] {
        &self.entries[self.starts[f]..self.starts[f + 1]]
    }
}

struct Elimination<'a> {
    fronts: &'a [Front],
    entries: &'a Entries,
    parts: &'a [OnceLock<Part>],
}

impl Elimination<'_> {
    /// Eliminates a front and all below it. Returns what is left of it in its border.
    fn eliminate(&self, f: usize) -> Vec<f64> {
        let front = &self.fronts[f];
        let (p, b) = (front.pivots.len(), front.border.len());
        let children = &front.children;
        let below: Vec<Vec<f64>> = if p + b >= WORTH_A_THREAD {
            parallel::tasks(children.clone(), |child| self.eliminate(child))
        } else {
            children.iter().map(|child| self.eliminate(*child)).collect()
        };
        let m = p + b;
        let mut a = vec![0.0; m * m];
        for (row, column, value) in self.entries.of_front(f) {
            a[front.position(*row) * m + front.position(*column)] += value;
        }
        for (child, rest) in children.iter().zip(below) {
            let to: Vec<usize> =
                self.fronts[*child].border.iter().map(|place| front.position(*place)).collect();
            for (row, values) in to.iter().zip(rest.chunks_exact(to.len().max(1))) {
                to.iter().zip(values).for_each(|(column, value)| a[row * m + column] += value);
            }
        }
        eliminate_pivots(&mut a, p, m);
        let (mut lower, mut upper) = (Vec::with_capacity(m * p), Vec::with_capacity(p * b));
        let mut rest = Vec::with_capacity(b * b);
        for (i, row) in a.chunks_exact(m.max(1)).enumerate() {
            lower.extend(row[..p].iter().map(|x| *x as f32));
            if i < p {
                upper.extend(row[p..].iter().map(|x| *x as f32));
            } else {
                rest.extend_from_slice(&row[p..]);
            }
        }
        assert!(self.parts[f].set(Part { lower, upper }).is_ok(), "a front is eliminated once");
        rest
    }
}

/// Eliminates the first `p` of `m` rows and columns.
fn eliminate_pivots(a: &mut [f64], p: usize, m: usize) {
    for first in (0..p).step_by(PANEL) {
        let last = p.min(first + PANEL);
        for k in first..last {
            let (above, below) = a.split_at_mut((k + 1) * m);
            let pivot = &above[k * m..];
            for row in below.chunks_exact_mut(m).filter(|row| row[k] != 0.0) {
                row[k] /= pivot[k];
                let factor = row[k];
                row[k + 1..last].iter_mut().zip(&pivot[k + 1..last]).for_each(|(x, u)| *x -= factor * u);
            }
        }
        for k in first + 1..last {
            let (above, below) = a.split_at_mut(k * m);
            for i in first..k {
                let factor = below[i];
                let row = &above[i * m + last..(i + 1) * m];
                below[last..m].iter_mut().zip(row).for_each(|(x, u)| *x -= factor * u);
            }
        }
        if last == m {
            continue;
        }
        let (above, below) = a.split_at_mut(last * m);
        let view = |rows: &[f64], from: usize, to: usize| -> Vec<f64> {
            rows.chunks_exact(m).flat_map(|row| &row[from..to]).copied().collect()
        };
        let (left, right) = (view(below, first, last), view(&above[first * m..], last, m));
        let (rows, depth) = (m - last, last - first);
        let left = ArrayView2::from_shape((rows, depth), &left).expect("as many");
        let right = ArrayView2::from_shape((depth, rows), &right).expect("as many");
        let mut rest = ArrayViewMut2::from_shape((rows, m), below).expect("as many");
        general_mat_mul(-1.0, &left, &right, 1.0, &mut rest.slice_mut(s![.., last..]));
    }
}
