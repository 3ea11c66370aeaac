//! Coarse level of the preconditioner: the stiffness of long waves, on a grid with a sixteenth of the cells
//! along each axis.

use std::f64::consts::{FRAC_PI_3, TAU};
use std::ops::Range;
use std::sync::Arc;

use crate::grid::{Field, SingleField};
use crate::math::sum::sums;
use crate::math::{Convolution, Kernel, fft::angular_frequency, parallel};
use crate::operator::{Edge, Operator};
use crate::ranks::{Halo, Merged, Slab};
use crate::solver::sets::{Set, Sets};

/// Fine cells per coarse cell, along each axis.
const COARSENING: usize = 16;
/// In a row of which no more than one cell in this many is free, each free cell is visited by itself.
const SPARSE: usize = 4;
/// Nodes beyond each end of a free axis. Without them the cyclic stiffness would couple opposite borders.
const MARGIN: usize = 2;
/// Fraction of free cells added in the weight, so that it stays finite in sparsely covered coarse cells; see
/// [`CoarseCorrection`].
const MIN_COVER: f32 = 0.2;

/// The correction P D B D Pᵀ. P interpolates bilinearly from the coarse nodes, B is the stiffness of the
/// coarse harmonics (E*|q|/2 for half-spaces), and D is a weight.
///
/// Let θ be the fraction of free cells in a coarse cell. A pressure that is uniform over the free cells has θ
/// times the mean pressure, and a uniform displacement there has θ times the sum. Division by θ in both
/// directions corrects both: D = 1/(θ + 0.2). It stays finite if few cells are free, for which a uniform
/// pressure is a poor guess anyway.
///
/// The mean of a periodic surface is more compliant than any wave, and matters only under approach control.
/// Consider valleys of width a that cover a fraction φ of the surface. A uniform pressure around them
/// displaces the valleys by about −a p/E*, and the rest by φ times this. For valleys at given distances, a is
/// proportional to φ, so the stiffness of the mean is proportional to 1/φ².
pub(super) struct CoarseCorrection {
    /// Stiffness of the coarse harmonics, divided by the fine cells in a coarse one.
    stiffness: Convolution<f32>,
    /// Stiffness of the mean for valleys as wide as the grid, divided by the fine cells in a coarse one.
    mean_stiffness: f32,
    /// Fraction of cells that are not free.
    open: f32,
    /// Fine cells in a coarse one.
    cells: f32,
    bilinear: Bilinear,
    /// The weight D at each node.
    weight: SingleField,
    /// The restricted residual D Pᵀ A r.
    restricted: SingleField,
    /// The coarse solution D B D Pᵀ A r.
    solved: SingleField,
}

impl CoarseCorrection {
    /// Creates the correction on the rows of a `halo` of the operator's grid.
    pub(super) fn new(operator: &dyn Operator, halo: &Halo) -> Self {
        let slab = operator.slab();
        let grid = slab.whole_grid();
        let inner = grid.shape.map(|n| ((n + COARSENING / 2) / COARSENING).max(1));
        let factor = [0, 1].map(|axis| grid.shape[axis] as f64 / inner[axis] as f64);
        let margin = operator.boundary().wraps().map(|wraps| if wraps { 0 } else { MARGIN });
        let shape = [0, 1].map(|axis| inner[axis] + 2 * margin[axis]);
        let extent = [0, 1].map(|axis| shape[axis] as f64 * factor[axis] * grid.pitch[axis]);
        let cells = factor[0] * factor[1];
        let longest = grid.extent()[0].max(grid.extent()[1]);
        let stiffness = |qx: f64, qy: f64| 1.0 / operator.harmonic_displacement(qx, qy);
        let mean = if operator.boundary().leaves_mean_free() { stiffness(TAU / longest, 0.0) } else { 0.0 };
        let spectrum = Field::from_shape_fn([shape[1] / 2 + 1, shape[0] / 2 + 1], |(l, k)| {
            let qx = angular_frequency(k, shape[0], grid.pitch[0] * factor[0]);
            let qy = angular_frequency(l, shape[1], grid.pitch[1] * factor[1]);
            let wide = match (k, l) {
                (0, 0) => match operator.boundary().0 {
                    [Edge::Periodic, Edge::Periodic] => 0.0,
                    // A uniform pressure on a free square of side L sinks a half-space by 0.95 L p/E* in the
                    // mean,
                    [Edge::Free, Edge::Free] => stiffness(2.0 / (0.95 * (extent[0] * extent[1]).sqrt()), 0.0),
                    // on an endless strip of width L by 3/π L p/E* against the distance L.
                    [Edge::Free, Edge::Periodic] => stiffness(2.0 * FRAC_PI_3 / extent[0], 0.0),
                    [Edge::Periodic, Edge::Free] => stiffness(0.0, 2.0 * FRAC_PI_3 / extent[1]),
                },
                _ => stiffness(qx, qy),
            };
            wide / cells
        });
        let kernel = Kernel::from_spectrum(shape, spectrum);
        Self {
            stiffness: Convolution::new(Arc::new(kernel.to_single()), shape),
            mean_stiffness: (mean / cells) as f32,
            open: 1.0,
            cells: cells as f32,
            bilinear: Bilinear::new(slab, halo, inner, margin),
            weight: SingleField::zeros(shape),
            restricted: SingleField::zeros(shape),
            solved: SingleField::zeros(shape),
        }
    }

    /// Adapts to the free cells of `sets`, with their number on all ranks.
    pub(super) fn adapt(&mut self, sets: &Sets, free: f64) {
        let (free, all) = (free as f32, self.bilinear.slab.whole_grid().cells() as f32);
        self.open = 1.0 - (free - 1.0) / all;
        self.bilinear.restrict(sets, None, &mut self.weight);
        self.weight.mapv_inplace(|count| 1.0 / (count / self.cells + MIN_COVER));
    }

    /// Restricts the residual `r`, which is zero for cells that are not free, to the nodes and solves there.
    /// Returns Σ r, and the product of r with the coarse solution on the free cells.
    pub(super) fn solve(&mut self, sets: &Sets, r: &[f32]) -> [f64; 2] {
        self.bilinear.restrict(sets, Some(r), &mut self.restricted);
        let sum = self.restricted.iter().copied().map(f64::from).sum();
        self.restricted *= &self.weight;
        self.stiffness.apply(&self.restricted, &mut self.solved);
        self.solved +=
            self.mean_stiffness * self.restricted.sum() / (self.restricted.len() as f32 * self.open.powi(2));
        let terms = self.restricted.iter().zip(&self.solved);
        let product = terms.map(|(r, z)| f64::from(*r) * f64::from(*z)).sum();
        self.solved *= &self.weight;
        [sum, product]
    }

    /// Removes its smooth part from the residual `r` of the free cells of some rows: `(I − T) A r` with the
    /// smoothing T = P D Pᵀ.
    pub(super) fn remove_smooth_part(&self, sets: &Sets, rows: Range<usize>, r: &mut [f32]) {
        self.bilinear.add(sets, rows, &self.restricted, -1.0 / self.cells, r);
    }

    /// Removes the smooth part of `z`, and adds the coarse solution for the last `r`:
    /// `(I − T)ᵀ z + P D B D Pᵀ A r`. Returns Σ z of the free cells.
    pub(super) fn join(&mut self, sets: &Sets, z: &mut [f32]) -> f64 {
        self.bilinear.restrict(sets, Some(z), &mut self.restricted);
        self.restricted *= &self.weight;
        self.solved.scaled_add(-1.0 / self.cells, &self.restricted);
        let bands = sets.bands();
        let [sum] = Merged::of_parts(parallel::map(bands.rows().zip(bands.cut_mut(z)), |(rows, z)| {
            self.bilinear.add(sets, rows, &self.solved, 1.0, z);
            sums(z, |_, z| [f64::from(z)])
        }));
        sum
    }
}

/// Bilinear interpolation from coarse nodes, cyclic, to the free cells of a grid.
struct Bilinear {
    /// For each row of cells, the node before it and the fraction of the distance to the next node, 0 … 1.
    rows: Vec<(usize, f32)>,
    /// For each column of cells, the node before it.
    before: Vec<usize>,
    /// For each column of cells, the fraction of the distance to the next node.
    shares: Vec<f32>,
    /// The columns between two nodes, with the first of these.
    between: Vec<(usize, Range<usize>)>,
    /// Rows of cells between two rows of nodes.
    cells: f64,
    slab: Slab,
    /// The rows of this rank, the only ones that are restricted.
    own: Range<usize>,
    /// The rows of nodes to which the cells of each rank contribute.
    reached: Vec<NodeRows>,
}

/// Consecutive rows of nodes, cyclic.
#[derive(Clone, Copy)]
struct NodeRows {
    first: usize,
    count: usize,
}

impl NodeRows {
    /// Returns the rows of nodes around the rows of cells with positions `along`, with so many `cells`
    /// between two of `all` rows of nodes.
    fn new(along: &[(usize, f32)], cells: f64, all: usize) -> Self {
        // The nodes before the first row to those after the last one; all nodes if these overlap cyclically.
        let count = ((along.len() as f64 / cells).ceil() as usize + 2).min(all);
        Self { first: along[0].0, count }
    }
}

impl Bilinear {
    /// Creates the interpolation between `coarse` nodes on the grid, with a `margin` of further nodes beyond
    /// each end, and the rows of a `halo` of a slab.
    fn new(slab: Slab, halo: &Halo, coarse: [usize; 2], margin: [usize; 2]) -> Self {
        let fine = slab.whole_grid().shape;
        let [rows, columns] = [0, 1].map(|axis| nodes(fine[axis], coarse[axis], margin[axis]));
        let (cells, all) = (fine[0] as f64 / coarse[0] as f64, coarse[0] + 2 * margin[0]);
        let reached = slab.parts().all().map(|own| NodeRows::new(&rows[own], cells, all)).collect();
        let own = halo.own_rows();
        let first = slab.rows().start - own.start;
        let rows = rows[first..first + halo.shape()[0]].to_vec();
        let (before, shares): (Vec<usize>, Vec<f32>) = columns.into_iter().unzip();
        let mut end = 0;
        let between = before.chunk_by(|a, b| a == b).map(|same| {
            end += same.len();
            (same[0], end - same.len()..end)
        });
        let between = between.collect();
        Self { rows, before, shares, between, cells, slab, own, reached }
    }

    /// Adds values interpolated from `nodes`, times a `factor`, to the `values` of the free cells of some
    /// rows.
    fn add(&self, sets: &Sets, rows: Range<usize>, nodes: &SingleField, factor: f32, values: &mut [f32]) {
        let columns = sets.bands().columns();
        // Values at the nodes along a row of cells; the first value is repeated at the end.
        let mut line = vec![0.0; nodes.ncols() + 1];
        for (row, values) in rows.zip(values.chunks_exact_mut(columns)) {
            let (cells, start) = sets.row(row);
            if cells.is_empty() {
                continue;
            }
            let (node, share) = self.rows[row];
            let ends = [nodes.row(node), nodes.row((node + 1) % nodes.nrows())];
            for ((value, a), b) in line.iter_mut().zip(ends[0]).zip(ends[1]) {
                *value = factor * (a + share * (b - a));
            }
            line[nodes.ncols()] = line[0];
            if is_sparse(cells, columns) {
                for column in cells.iter().map(|cell| *cell as usize - start) {
                    let (node, share) = (self.before[column], self.shares[column]);
                    values[column] += line[node] + share * (line[node + 1] - line[node]);
                }
                continue;
            }
            let sets = &sets.by_cell()[row * columns..][..columns];
            for (node, columns) in &self.between {
                let (first, rise) = (line[*node], line[*node + 1] - line[*node]);
                let cells = values[columns.clone()].iter_mut().zip(&sets[columns.clone()]);
                for ((value, set), share) in cells.zip(&self.shares[columns.clone()]) {
                    let added = first + share * rise;
                    *value += if *set == Set::Free { added } else { 0.0 };
                }
            }
        }
    }

    /// Applies the transpose: distributes the `values` to the nodes around their cells. They are zero for
    /// cells that are not free; without values, each free cell has 1.
    fn restrict(&self, sets: &Sets, values: Option<&[f32]>, nodes: &mut SingleField) {
        let shape = [nodes.nrows(), nodes.ncols()];
        let bands: Vec<_> =
            sets.bands().rows().map(|rows| self.own_of(rows)).filter(|rows| !rows.is_empty()).collect();
        let parts = parallel::map(bands.into_iter(), |rows| self.restrict_rows(sets, rows, values, shape));
        nodes.fill(0.0);
        for (first, part) in parts {
            for (number, part) in part.outer_iter().enumerate() {
                let mut to = nodes.row_mut((first + number) % shape[0]);
                to += &part;
            }
        }
        self.merge(nodes);
    }

    /// Returns the part of the rows that belongs to this rank.
    fn own_of(&self, rows: Range<usize>) -> Range<usize> {
        rows.start.max(self.own.start)..rows.end.min(self.own.end)
    }

    /// Sums the contributions of all ranks to the `nodes`.
    fn merge(&self, nodes: &mut SingleField) {
        if self.slab.is_whole() {
            return;
        }
        let (all, columns) = nodes.dim();
        let rows = |NodeRows { first, count }: NodeRows| (first..first + count).map(move |row| row % all);
        let ranks = self.slab.ranks();
        let own = rows(self.reached[ranks.rank()]).flat_map(|row| nodes.row(row).to_vec());
        let own: Vec<f64> = own.map(f64::from).collect();
        let counts: Vec<usize> = self.reached.iter().map(|reached| reached.count * columns).collect();
        let gathered = ranks.gather(&own, &counts);
        nodes.fill(0.0);
        let to = self.reached.iter().flat_map(|reached| rows(*reached));
        for (row, part) in to.zip(gathered.chunks_exact(columns)) {
            nodes.row_mut(row).iter_mut().zip(part).for_each(|(node, value)| *node += *value as f32);
        }
    }

    /// [`Self::restrict`] for some rows. Returns the first row of nodes to which they contribute, and the
    /// contributions to it and to the rows after it.
    fn restrict_rows(
        &self,
        sets: &Sets,
        rows: Range<usize>,
        values: Option<&[f32]>,
        shape: [usize; 2],
    ) -> (usize, SingleField) {
        let [all, columns] = shape;
        let NodeRows { first, count } = NodeRows::new(&self.rows[rows.clone()], self.cells, all);
        let mut part = SingleField::zeros([count, columns]);
        let fine = sets.bands().columns();
        // The values of each column between two rows of nodes: their parts for either row.
        let mut lines = [vec![0.0; fine], vec![0.0; fine]];
        let (mut line, mut ones) = (vec![0.0; columns + 1], Vec::new());
        let end = rows.end;
        for row in rows {
            let (cells, start) = sets.row(row);
            let (node, share) = self.rows[row];
            let [before, after] = &mut lines;
            let own = row * fine..(row + 1) * fine;
            let values = match values {
                Some(values) => &values[own],
                None => {
                    ones.clear();
                    ones.extend(sets.by_cell()[own].iter().map(|set| f32::from(u8::from(*set == Set::Free))));
                    &ones
                }
            };
            if is_sparse(cells, fine) {
                for column in cells.iter().map(|cell| *cell as usize - start) {
                    before[column] += (1.0 - share) * values[column];
                    after[column] += share * values[column];
                }
            } else {
                for ((before, after), value) in before.iter_mut().zip(after).zip(values) {
                    *before += (1.0 - share) * value;
                    *after += share * value;
                }
            }
            if row + 1 < end && self.rows[row + 1].0 == node {
                continue;
            }
            let node = (node + all - first) % all;
            for (node, values) in [node, (node + 1) % all].into_iter().zip(&mut lines) {
                line.fill(0.0);
                for (node, columns) in &self.between {
                    let shares = &self.shares[columns.clone()];
                    let [sum, second] =
                        sums(&values[columns.clone()], |cell, value| [value, shares[cell] * value]);
                    line[*node] += sum - second;
                    line[*node + 1] += second;
                }
                line[0] += line[columns];
                part.row_mut(node).iter_mut().zip(&line).for_each(|(n, v)| *n += v);
                values.fill(0.0);
            }
        }
        (first, part)
    }
}

/// Whether few of the cells of a row are free, so that each is visited by itself.
fn is_sparse(free: &[u32], columns: usize) -> bool {
    SPARSE * free.len() < columns
}

/// Returns, for each of `fine` cells, the (cyclic) node before it, and the weight of the next node. There are
/// `coarse` nodes on the cells, and a `margin` of further ones beyond each end.
fn nodes(fine: usize, coarse: usize, margin: usize) -> Vec<(usize, f32)> {
    let factor = fine as f64 / coarse as f64;
    let all = (coarse + 2 * margin) as isize;
    (0..fine)
        .map(|i| {
            let position = (i as f64 + 0.5) / factor - 0.5 + margin as f64;
            let node = position.floor();
            ((node as isize).rem_euclid(all) as usize, (position - node) as f32)
        })
        .collect()
}
