//! Factors L U of an unsymmetric sparse matrix on the cells of a grid, front by front, in the order of a nested
//! dissection. There is no pivoting.

use std::ops::Range;
use std::sync::OnceLock;

use ndarray::linalg::general_mat_mul;
use ndarray::{ArrayView2, ArrayViewMut2, s};

use crate::math::parallel;

/// Most unknowns that are not dissected further.
const LEAF: usize = 32;

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

/// Unknowns that are eliminated together, as a dense matrix.
struct Front {
    /// Places in the order of elimination.
    pivots: Range<usize>,
    /// Places of the unknowns that these are joined to then, all later, ascending.
    border: Vec<u32>,
    /// Fronts whose remainders enter this one; all come before it.
    children: Vec<usize>,
    /// Entries of the matrix whose row or column is a pivot, and whose other one is not an earlier pivot.
    entries: Range<usize>,
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
        let (order, mut fronts) = Dissection::of_grid(shape, repeats, reach, unknowns);
        let entries = sorted_entries(matrix, &order, &mut fronts);
        find_borders(&entries, &mut fronts);
        let parts: Vec<OnceLock<Part>> = fronts.iter().map(|_| OnceLock::new()).collect();
        if !fronts.is_empty() {
            Elimination { fronts: &fronts, entries: &entries, parts: &parts }.eliminate(fronts.len() - 1);
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

/// Cuts the grid in two by rows of cells, as thick as the matrix reaches, again and again. A row is eliminated
/// after both of its sides.
struct Dissection<'a> {
    across: usize,
    reach: [usize; 2],
    unknowns: &'a [[Option<u32>; 2]],
    order: Vec<u32>,
    fronts: Vec<Front>,
}

impl<'a> Dissection<'a> {
    fn of_grid(
        [nx, ny]: [usize; 2],
        repeats: bool,
        reach: [usize; 2],
        unknowns: &'a [[Option<u32>; 2]],
    ) -> (Vec<u32>, Vec<Front>) {
        let mut this = Self { across: ny, reach, unknowns, order: Vec::new(), fronts: Vec::new() };
        // The first rows along a repeating axis close the ring, and come last.
        let closing = if repeats { reach[1].min(ny) } else { 0 };
        let children = this.dissect([0..nx, closing..ny]);
        let first = this.order.len();
        this.push([0..nx, 0..closing]);
        let roots = this.front(first, children);
        if roots.len() > 1 {
            // One root for parts that nothing joins.
            let end = this.order.len();
            this.fronts.push(Front { pivots: end..end, border: Vec::new(), children: roots, entries: 0..0 });
        }
        (this.order, this.fronts)
    }

    fn push(&mut self, [x, y]: [Range<usize>; 2]) {
        for i in x {
            let cells = i * self.across + y.start..i * self.across + y.end;
            self.order.extend(self.unknowns[cells].iter().flatten().flatten());
        }
    }

    /// Makes a front of the unknowns pushed since `first`. Without any, its children are left to the next one.
    fn front(&mut self, first: usize, children: Vec<usize>) -> Vec<usize> {
        if first == self.order.len() {
            return children;
        }
        self.fronts.push(Front {
            pivots: first..self.order.len(),
            border: Vec::new(),
            children,
            entries: 0..0,
        });
        vec![self.fronts.len() - 1]
    }

    fn dissect(&mut self, sides: [Range<usize>; 2]) -> Vec<usize> {
        let along = usize::from(sides[0].len() * self.reach[1] < sides[1].len() * self.reach[0]);
        let thick = self.reach[along];
        let first = self.order.len();
        if sides[0].len() * sides[1].len() <= LEAF || sides[along].len() < 2 * thick + 1 {
            self.push(sides);
            return self.front(first, Vec::new());
        }
        let cut = sides[along].start + (sides[along].len() - thick) / 2;
        let part = |range: Range<usize>| {
            let mut part = sides.clone();
            part[along] = range;
            part
        };
        let mut children = self.dissect(part(sides[along].start..cut));
        children.append(&mut self.dissect(part(cut + thick..sides[along].end)));
        let first = self.order.len();
        self.push(part(cut..cut + thick));
        self.front(first, children)
    }
}

/// Returns the entries of the matrix by the front that eliminates the first of their row and column.
fn sorted_entries(matrix: &Matrix, order: &[u32], fronts: &mut [Front]) -> Vec<Entry> {
    let mut place = vec![0; order.len()];
    for (k, unknown) in order.iter().enumerate() {
        place[*unknown as usize] = k as u32;
    }
    let mut front_of = vec![0; order.len()];
    for (f, front) in fronts.iter().enumerate() {
        front_of[front.pivots.clone()].fill(f);
    }
    let placed = |row: usize| {
        let row_place = place[row];
        let place = &place;
        matrix.row(row).map(move |(column, value)| (row_place, place[column as usize], value))
    };
    let of = |(row, column, _): Entry| front_of[row.min(column) as usize];
    let mut ends = vec![0; fronts.len()];
    (0..order.len()).flat_map(placed).for_each(|entry| ends[of(entry)] += 1);
    let mut start = 0;
    for (front, end) in fronts.iter_mut().zip(&mut ends) {
        let count = std::mem::replace(end, start);
        front.entries = start..start + count;
        start += count;
    }
    let mut entries = vec![(0, 0, 0.0); start];
    for entry in (0..order.len()).flat_map(placed) {
        let next = &mut ends[of(entry)];
        entries[*next] = entry;
        *next += 1;
    }
    entries
}

fn find_borders(entries: &[Entry], fronts: &mut [Front]) {
    for f in 0..fronts.len() {
        let own = entries[fronts[f].entries.clone()].iter().map(|(row, column, _)| *row.max(column));
        let mut border: Vec<u32> = own.collect();
        border.extend(fronts[f].children.iter().flat_map(|child| &fronts[*child].border));
        border.retain(|place| *place as usize >= fronts[f].pivots.end);
        border.sort_unstable();
        border.dedup();
        fronts[f].border = border;
    }
}

struct Elimination<'a> {
    fronts: &'a [Front],
    entries: &'a [Entry],
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
        for (row, column, value) in &self.entries[front.entries.clone()] {
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

impl Front {
    /// Returns the row of a place in the matrix of the front.
    fn position(&self, place: u32) -> usize {
        if (place as usize) < self.pivots.end {
            return place as usize - self.pivots.start;
        }
        self.pivots.len() + self.border.binary_search(&place).expect("it is in the border")
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
