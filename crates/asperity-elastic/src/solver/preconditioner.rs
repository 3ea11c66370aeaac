//! Two-level preconditioner: an approximate inverse of the influence matrix on the free cells, without a fine
//! convolution.

use crate::grid::CellValues;
use crate::math::parallel::Pool;
use crate::math::sum::sums;
use crate::math::{Bands, ROWS_ABOVE, SparseInverse, parallel};
use crate::operator::Operator;
use crate::ranks::{Halo, Merged, Slab};
use crate::solver::coarse_correction::CoarseCorrection;
use crate::solver::sets::{Set, Sets};

/// The patterns of a row are computed for all cells if more than one in this many is free.
const DENSE: usize = 16;

/// The local part (I − T) A r of the residual on a band and the rows above it, and its image under S.
#[derive(Default)]
struct Scratch {
    local: Vec<f32>,
    image: Vec<f32>,
}

/// The preconditioner `z = A (I − T) S (I − T)ᵀ A r + A P D B D Pᵀ A r`, symmetric and positive definite on
/// the free cells A.
///
/// If cells differ in the displacement cᵢ by their own pressure, then z = D M D r with the M of their mean c,
/// and D = √(c/cᵢ). This is exact if the cells do not displace each other.
///
/// S is the [`SparseInverse`] on the free cells, for the local part of the residual. B is the stiffness of
/// the long waves, for its smooth part. [`CoarseCorrection`] defines P, D and T.
pub(super) struct Preconditioner {
    slab: Slab,
    /// The rows on either side of the slab that S reaches.
    halo: Halo,
    /// Data on all these rows; none if the grid is not divided among ranks.
    around: Option<SlabWithNeighbours>,
    sparse: SparseInverse,
    coarse: CoarseCorrection,
    /// Pattern of the neighbours of each free cell of each band.
    patterns: Vec<Vec<u8>>,
    /// The residual of the rows above each band, and then the contribution of the band to them.
    above: Vec<Vec<f32>>,
    scratch: Pool<Scratch>,
    /// The scales √(c/cᵢ) of the cells; none if cells do not differ.
    scales: Option<Vec<f32>>,
}

/// Sets and residual of a slab and the rows on either side. With these rows the cells of this rank have the
/// values of a single process.
struct SlabWithNeighbours {
    sets: Sets,
    values: Vec<f32>,
}

impl SlabWithNeighbours {
    fn new(shape: [usize; 2]) -> Self {
        Self { sets: Sets::new(shape), values: vec![0.0; shape[0] * shape[1]] }
    }
}

impl Preconditioner {
    pub(super) fn new(operator: &dyn Operator) -> Self {
        let slab = operator.slab();
        let halo = slab.halo(ROWS_ABOVE);
        let bands = Bands::new(halo.shape());
        let count = bands.rows().len();
        Self {
            around: (!slab.is_whole()).then(|| SlabWithNeighbours::new(halo.shape())),
            // Ranks do not exchange rows across the border of the whole grid.
            sparse: sparse_inverse(operator, halo.shape(), slab.is_whole()),
            coarse: CoarseCorrection::new(operator, &halo),
            slab,
            halo,
            patterns: vec![Vec::new(); count],
            above: vec![vec![0.0; ROWS_ABOVE * bands.columns()]; count],
            scratch: Pool::default(),
            scales: scales(operator),
        }
    }

    /// Adapts to the free cells of `sets`.
    pub(super) fn adapt(&mut self, sets: &Sets) {
        let Self { slab, halo, around, sparse, coarse, patterns, .. } = self;
        let [free] = slab.merged([sets.free_cells() as f64]);
        let sets = match around {
            None => sets,
            Some(SlabWithNeighbours { sets: all, values: is_free }) => {
                let own = is_free[halo.own()].iter_mut().enumerate();
                own.for_each(|(cell, value)| *value = f32::from(u8::from(sets.is_free(cell))));
                halo.fill(is_free);
                all.free_where(|cell| is_free[cell] != 0.0);
                &*all
            }
        };
        coarse.adapt(sets, free);
        let bands = sets.bands();
        let parts = bands.rows().zip(patterns).zip(sets.in_bands());
        parallel::map(parts, |((rows, patterns), free)| {
            patterns.clear();
            patterns.reserve_exact(free.cells().len());
            let columns = bands.columns();
            let mut dense = Vec::new();
            for ix in rows {
                let (cells, first) = sets.row(ix);
                let column = |cell: &u32| *cell as usize - first;
                let pattern = |iy: usize| sparse.pattern([ix, iy], |cell| sets.is_free(cell));
                if DENSE * cells.len() < columns {
                    patterns.extend(cells.iter().map(|cell| pattern(column(cell))));
                    continue;
                }
                // If many cells are free, it is faster to compute the patterns of all.
                let row = |back: usize| match ix.checked_sub(back).or_else(|| sparse.row_before(ix, back)) {
                    Some(row) => &sets.by_cell()[row * columns..][..columns],
                    None => &[],
                };
                dense.clear();
                dense.resize(columns, 0);
                SparseInverse::inner_patterns(row(0), [row(1), row(2)], |set| *set == Set::Free, &mut dense);
                for iy in [0, 1, columns - 1] {
                    if iy < columns {
                        dense[iy] = pattern(iy);
                    }
                }
                patterns.extend(cells.iter().map(|cell| dense[column(cell)]));
            }
        });
    }

    /// Computes the preconditioned residual `z = M r`. The function `r` returns the residual of a free cell.
    /// The other cells have z = 0. Returns the sums Σ z, Σ r and Σ r z over the free cells.
    pub(super) fn apply(&mut self, sets: &Sets, r: impl Fn(usize) -> f32 + Sync, z: &mut [f32]) -> [f64; 3] {
        let bands = sets.bands();
        let parts = bands.cut_mut(z).zip(bands.cut(sets.by_cell())).enumerate();
        parallel::map(parts, |(band, (z, sets))| {
            let first = bands.first(band);
            let cells = z.iter_mut().zip(sets).enumerate();
            cells.for_each(|(cell, (z, set))| *z = if *set == Set::Free { r(first + cell) } else { 0.0 });
        });
        self.replace(sets, z)
    }

    /// Replaces the residual r by the preconditioned residual `z = M r`. Both are zero for cells that are not
    /// free. Returns the sums Σ z, Σ r and Σ r z.
    pub(super) fn replace(&mut self, sets: &Sets, values: &mut [f32]) -> [f64; 3] {
        let Some(scales) = self.scales.take() else { return self.apply_alike(sets, values) };
        let sum = |values: &[f32]| sums(values, |_, value| [f64::from(value)]);
        let scale =
            |values: &mut [f32]| values.iter_mut().zip(&scales).for_each(|(value, scale)| *value *= scale);
        let [residual_sum] = sum(values);
        scale(values);
        let [_, _, product] = self.apply_alike(sets, values);
        scale(values);
        self.scales = Some(scales);
        let [preconditioned_sum] = sum(values);
        [preconditioned_sum, residual_sum, product]
    }

    /// [`Self::apply`] for cells that do not differ.
    fn apply_alike(&mut self, sets: &Sets, values: &mut [f32]) -> [f64; 3] {
        let Some(mut around) = self.around.take() else { return self.apply_on_rows(sets, values) };
        let SlabWithNeighbours { sets: all, values: on_all } = &mut around;
        on_all[self.halo.own()].copy_from_slice(values);
        self.halo.fill(on_all);
        self.apply_on_rows(all, on_all);
        let mut sums = [0.0; 3];
        for (r, z) in values.iter_mut().zip(&on_all[self.halo.own()]) {
            let terms = [*z, *r].map(f64::from);
            sums = [sums[0] + terms[0], sums[1] + terms[1], sums[2] + terms[0] * terms[1]];
            *r = *z;
        }
        self.around = Some(around);
        sums
    }

    /// [`Self::apply_alike`] on the rows of a rank and its neighbouring rows. The values on the neighbouring
    /// rows are not valid.
    fn apply_on_rows(&mut self, sets: &Sets, values: &mut [f32]) -> [f64; 3] {
        let Self { sparse, coarse, patterns, above, scratch, .. } = self;
        let [residual_sum, coarse_product] = coarse.solve(sets, values);
        let bands = sets.bands();
        let before = ROWS_ABOVE * bands.columns();
        let wraps = sparse.wraps_rows();
        // The rows above the first band are the last ones of a periodic grid.
        let all = values.len();
        let end = |band: usize| if band == 0 { all } else { bands.first(band) };
        for (band, above) in above.iter_mut().enumerate().skip(usize::from(!wraps)) {
            above.copy_from_slice(&values[end(band) - before..end(band)]);
        }
        let last_row = all / bands.columns();
        let parts =
            bands.rows().zip(bands.cut_mut(values)).zip(sets.in_bands()).zip(&*patterns).zip(&mut *above);
        let products = parallel::each(
            parts,
            1,
            scratch,
            Scratch::default,
            |scratch, ((((rows, values), free), patterns), above)| {
                let Scratch { local, image } = scratch;
                local.clear();
                local.extend_from_slice(above);
                local.extend_from_slice(values);
                image.clear();
                image.resize(local.len(), 0.0);
                let (over, own) = local.split_at_mut(before);
                if rows.start > 0 || wraps {
                    let end = if rows.start > 0 { rows.start } else { last_row };
                    coarse.remove_smooth_part(sets, end - ROWS_ABOVE..end, over);
                }
                coarse.remove_smooth_part(sets, rows, own);
                let cells = free.cells().map(|cell| before + cell).zip(patterns.iter().copied());
                let product = sparse.add(cells, local, image);
                above.copy_from_slice(&image[..before]);
                values.copy_from_slice(&image[before..]);
                [product]
            },
        );
        for (band, above) in above.iter().enumerate().skip(usize::from(!wraps)) {
            values[end(band) - before..end(band)].iter_mut().zip(above).for_each(|(z, above)| *z += above);
        }
        let [product] = Merged::of_parts(products);
        [coarse.join(sets, values), residual_sum, coarse_product + product]
    }
}

/// Returns √(c/cᵢ), from the mean and the individual displacement of a cell by its own pressure; none if
/// cells do not differ.
fn scales(operator: &dyn Operator) -> Option<Vec<f32>> {
    match operator.self_influence() {
        CellValues::Uniform(_) => None,
        CellValues::Field(own) => {
            let mean = operator.influence(0, 0);
            Some(own.iter().map(|own| (mean / own).sqrt() as f32).collect())
        }
    }
}

/// Creates the sparse inverse of the operator's influence matrix on `rows` of its grid, `all` of them or
/// those of a rank. Periodic coefficients are relative to the far field.
fn sparse_inverse(operator: &dyn Operator, rows: [usize; 2], all: bool) -> SparseInverse {
    let shape = operator.slab().whole_grid().shape;
    let periodic = operator.boundary().leaves_mean_free();
    let far = if periodic { operator.influence(shape[0] / 2, shape[1] / 2) } else { 0.0 };
    let [wraps_x, wraps_y] = operator.boundary().wraps();
    SparseInverse::new(rows, [wraps_x && all, wraps_y], |i, j| operator.influence(i, j) - far)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Field, Grid};
    use crate::math::Cholesky;
    use crate::operator::{DirectSum, PeriodicFft};

    /// Creates the sets with `free` cells on a grid of `shape`.
    fn sets(shape: [usize; 2], free: impl Fn(usize) -> bool + Sync + Send) -> Sets {
        let mut sets = Sets::new(shape);
        sets.free_where(free);
        sets
    }

    #[test]
    fn it_is_symmetric_and_positive_definite_on_any_free_set() {
        for periodic in [false, true] {
            let grid = Grid::new([13, 18], [1.0, 0.8]).unwrap();
            let operator: Box<dyn Operator> = if periodic {
                Box::new(PeriodicFft::new(grid, 1.0))
            } else {
                Box::new(DirectSum::new(grid, 1.0))
            };
            // A ring of free cells and a few scattered ones.
            let sets = sets(grid.shape, |k| (k * 7 + k / grid.shape[1] * 3) % 11 < 5);
            let mut preconditioner = Preconditioner::new(operator.as_ref());
            preconditioner.adapt(&sets);
            let free: Vec<usize> = (0..grid.cells()).filter(|cell| sets.is_free(*cell)).collect();
            let columns: Vec<Vec<f32>> = free
                .iter()
                .map(|&cell| {
                    let (mut unit, mut z) = (vec![0.0; grid.cells()], vec![0.0; grid.cells()]);
                    unit[cell] = 1.0;
                    preconditioner.apply(&sets, |cell| unit[cell], &mut z);
                    assert!((0..grid.cells()).all(|cell| sets.is_free(cell) || z[cell] == 0.0));
                    free.iter().map(|cell| z[*cell]).collect()
                })
                .collect();
            let n = columns.len();
            let matrix = Field::from_shape_fn([n, n], |(i, j)| f64::from(columns[j][i]));
            let asymmetry = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
            let asymmetry =
                asymmetry.fold(0.0f64, |m, (i, j)| m.max((matrix[[i, j]] - matrix[[j, i]]).abs()));
            assert!(asymmetry < 1e-6, "asymmetry {asymmetry:e}");
            assert!(
                Cholesky::new(matrix - Field::eye(n) * 1e-5).is_some(),
                "an eigenvalue is not above 1e-5"
            );
        }
    }

    #[test]
    fn it_is_symmetric_across_the_bands_of_a_large_grid() {
        let grid = Grid::new([140, 1000], [1.0, 1.0]).unwrap();
        let operator = PeriodicFft::new(grid, 1.0);
        let sets = sets(grid.shape, |cell| (cell * 7 + cell / 1000 * 3) % 11 < 8);
        assert!(sets.in_bands().len() > 2);
        let mut preconditioner = Preconditioner::new(&operator);
        preconditioner.adapt(&sets);
        // Next to the edges of bands and away from them.
        for (a, b) in [(65, 66), (66, 64), (131, 129), (30, 32), (65, 100)] {
            let [a, b] = [a, b].map(|row| (row * 1000 + 500..).find(|cell| sets.is_free(*cell)).unwrap());
            let mut image = |cell: usize| {
                let (mut unit, mut z) = (vec![0.0; grid.cells()], vec![f32::NAN; grid.cells()]);
                unit[cell] = 1.0;
                preconditioner.apply(&sets, |cell| unit[cell], &mut z);
                z
            };
            let (there, back, own) = (image(a)[b], image(b)[a], image(a)[a]);
            assert!((there - back).abs() <= 1e-5 * own, "{a}, {b}: {there} and {back} of {own}");
            assert!(there != 0.0 && own > 0.0);
        }
    }

    /// The image of a unit residual on one cell if all cells are free.
    fn image(operator: &dyn Operator, cell: usize) -> Vec<f32> {
        let grid = *operator.grid();
        let sets = sets(grid.shape, |_| true);
        let (mut unit, mut z) = (vec![0.0; grid.cells()], vec![0.0; grid.cells()]);
        unit[cell] = 1.0;
        let mut preconditioner = Preconditioner::new(operator);
        preconditioner.adapt(&sets);
        preconditioner.apply(&sets, |cell| unit[cell], &mut z);
        z
    }

    #[test]
    fn it_wraps_round_periodic_borders() {
        let grid = Grid::new([48, 64], [1.0, 0.9]).unwrap();
        let operator = PeriodicFft::new(grid, 1.0);
        // Coarse nodes are 16 cells apart.
        let (corner, middle) = (image(&operator, 0), image(&operator, 16 * 64 + 32));
        for (cell, z) in corner.iter().enumerate() {
            let shifted = middle[(cell / 64 + 16) % 48 * 64 + (cell % 64 + 32) % 64];
            assert!((z - shifted).abs() < 1e-5 * corner[0], "{cell}: {z} and {shifted}");
        }
    }

    #[test]
    fn it_does_not_wrap_round_free_borders() {
        let grid = Grid::new([64, 64], [1.0, 1.0]).unwrap();
        let corner = image(&DirectSum::new(grid, 1.0), 0);
        // The other corners are as far as the cells beyond the next nodes.
        let near = corner[8 * 64 + 8].abs();
        for far in [63, 63 * 64, 63 * 64 + 63] {
            assert!(corner[far].abs() < 0.2 * near, "{far}: {} and {near}", corner[far]);
        }
    }

    #[test]
    fn the_sparse_inverse_is_exact_where_the_free_cells_are_isolated_pairs() {
        let grid = Grid::new([1, 2], [1.0, 1.0]).unwrap();
        let operator = DirectSum::new(grid, 1.0);
        let sets = sets(grid.shape, |_| true);
        let sparse = sparse_inverse(&operator, grid.shape, true);
        let (c, d) = (operator.influence(0, 0), operator.influence(0, 1));
        let above = ROWS_ABOVE * grid.shape[1];
        let patterns = [0, 1].map(|iy| sparse.pattern([0, iy], |cell| sets.is_free(cell)));
        let (mut r, mut image) = (vec![0.0; above + 2], vec![0.0; above + 2]);
        r[above] = 1.0;
        sparse.add((above..above + 2).zip(patterns), &r, &mut image);
        let z = &image[above..];
        let determinant = c * c - d * d;
        let error = [f64::from(z[0]) - c / determinant, f64::from(z[1]) + d / determinant];
        assert!(error.iter().all(|e| e.abs() < 1e-6), "{error:?}");
    }
}
