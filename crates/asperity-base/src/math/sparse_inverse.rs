//! A factorised sparse approximate inverse of an influence matrix on some of the cells of a grid.

/// The factorised sparse approximate inverse GᵀG ≈ C⁻¹ of the influence matrix C on the free cells. Row i of
/// G solves `C_JJ y = e_i`, divided by √y_i, where J are the free cells among the cell and its causal
/// neighbours. Kolotilina and Yeremin, SIAM J. Matrix Anal. Appl. 14, 45 (1993).
///
/// A row depends only on which of the neighbours are free, so there are 64 different rows.
pub struct SparseInverse {
    shape: [usize; 2],
    /// Whether the neighbours of the first cells along each axis are the last ones.
    wraps: [bool; 2],
    /// The row of G for each pattern of free neighbours.
    rows: [[f32; MEMBERS]; 1 << NEIGHBOURS],
}

/// Number of causal neighbours.
const NEIGHBOURS: usize = 6;
/// Number of rows before a cell with neighbours of the cell.
pub const ROWS_ABOVE: usize = 2;
/// Number of entries of a row: the neighbours, and last the cell itself.
const MEMBERS: usize = NEIGHBOURS + 1;
/// The nearest neighbours that come before a cell in memory.
const CAUSAL: [(isize, isize); NEIGHBOURS] = [(-1, -1), (-1, 0), (-1, 1), (0, -1), (-2, 0), (0, -2)];
/// Bit of the pattern of a cell whose row lies on both sides of a border along y.
const ACROSS: u8 = 1 << NEIGHBOURS;

impl SparseInverse {
    /// Grids with fewer cells along an axis do not wrap along it.
    pub const MIN_PERIOD: usize = 8;
    /// One more than the largest distance between two cells whose coefficients it takes, along each axis.
    pub const REACH: [usize; 2] = [3, 4];

    /// Creates the inverse on a grid of `shape` of the positive definite matrix with the coefficients
    /// `influence(i, j)` at the offsets ±i, ±j. The grid is periodic along the axes that it `wraps`.
    pub fn new(shape: [usize; 2], wraps: [bool; 2], influence: impl Fn(usize, usize) -> f64) -> Self {
        let wraps = [0, 1].map(|axis| wraps[axis] && shape[axis] >= Self::MIN_PERIOD);
        // On small grids some neighbours never occur.
        let coefficients: [[f64; Self::REACH[1]]; Self::REACH[0]] = std::array::from_fn(|i| {
            std::array::from_fn(|j| if i < shape[0] && j < shape[1] { influence(i, j) } else { 0.0 })
        });
        let rows = std::array::from_fn(|pattern| {
            let members: Vec<usize> =
                (0..NEIGHBOURS).filter(|k| pattern >> k & 1 == 1).chain([NEIGHBOURS]).collect();
            let offset = |k: usize| if k == NEIGHBOURS { (0, 0) } else { CAUSAL[k] };
            let mut matrix = [[0.0; MEMBERS]; MEMBERS];
            for (a, &k) in members.iter().enumerate() {
                for (b, &l) in members.iter().enumerate() {
                    let (p, q) = (offset(k), offset(l));
                    matrix[a][b] = coefficients[p.0.abs_diff(q.0)][p.1.abs_diff(q.1)];
                }
            }
            let solved = last_column_of_inverse(&mut matrix, members.len());
            let scale = 1.0 / solved[members.len() - 1].sqrt();
            let mut row = [0.0; MEMBERS];
            members.iter().zip(solved).for_each(|(&k, y)| row[k] = (y * scale) as f32);
            row
        });
        Self { shape, wraps, rows }
    }

    /// Returns the row of G for each pattern of free neighbours.
    pub fn rows(&self) -> &[[f32; MEMBERS]; 1 << NEIGHBOURS] {
        &self.rows
    }

    /// Returns whether the rows before the first one are the last ones.
    pub fn wraps_rows(&self) -> bool {
        self.wraps[0]
    }

    /// Returns the row that is `back` rows before a first row `ix` across a periodic border.
    pub fn row_before(&self, ix: usize, back: usize) -> Option<usize> {
        self.wraps[0].then(|| ix + self.shape[0] - back)
    }

    /// Returns the pattern of the cell `[ix, iy]`. Bit k is set if neighbour k `is_free`, by its flat index.
    #[inline]
    pub fn pattern(&self, [ix, iy]: [usize; 2], is_free: impl Fn(usize) -> bool) -> u8 {
        let [nx, ny] = self.shape;
        let mut across = 0;
        let mut free = |(di, dj): (isize, isize)| {
            let (mut i, mut j) = (ix.wrapping_add_signed(di), iy.wrapping_add_signed(dj));
            // Neighbours come before the cell, so negative indices have wrapped.
            if i > ix && self.wraps[0] {
                i = i.wrapping_add(nx);
            }
            if j >= ny && self.wraps[1] {
                j = if dj < 0 { j.wrapping_add(ny) } else { j - ny };
                across = ACROSS;
            }
            i < nx && j < ny && is_free(i * ny + j)
        };
        let pattern = (0..NEIGHBOURS).fold(0, |pattern, k| pattern | u8::from(free(CAUSAL[k])) << k);
        pattern | across
    }

    /// Computes the patterns of the cells of a row, for cells that are free or not: `patterns[iy]`, except
    /// for the first two cells and the last one. `own` and `above` are whether the cells of the row and of
    /// the two rows before it are free, the nearer one first; empty without such a row.
    pub fn inner_patterns<T>(own: &[T], above: [&[T]; 2], is_free: impl Fn(&T) -> bool, patterns: &mut [u8]) {
        let inner = 2..own.len().saturating_sub(1);
        let mut add = |row: &[T], shift: isize, bit: u8| {
            if row.is_empty() || inner.is_empty() {
                return;
            }
            let from = &row[inner.start.wrapping_add_signed(shift)..inner.end.wrapping_add_signed(shift)];
            patterns[inner.clone()]
                .iter_mut()
                .zip(from)
                .for_each(|(p, set)| *p |= u8::from(is_free(set)) << bit);
        };
        for (bit, (di, dj)) in CAUSAL.into_iter().enumerate() {
            let row = match di {
                0 => own,
                -1 => above[0],
                _ => above[1],
            };
            add(row, dj, bit as u8);
        }
    }

    /// Adds GᵀG r to `z` for the free `cells` of some rows, each with its pattern. Returns the sum of squares
    /// of G r.
    ///
    /// In addition to these rows, `r` and `z` have the [`ROWS_ABOVE`] rows before them, and cells count from
    /// the first cell of these. Before the first row of a grid they are the last rows if it wraps along x,
    /// otherwise zero. `r` is zero for cells that are not free.
    pub fn add(&self, cells: impl Iterator<Item = (usize, u8)>, r: &[f32], z: &mut [f32]) -> f64 {
        let mut squares = 0.0;
        let ny = self.shape[1];
        let back = CAUSAL.map(|(di, dj)| (-di * ny as isize - dj) as usize);
        for (cell, pattern) in cells {
            let row = &self.rows[usize::from(pattern & !ACROSS)];
            // Missing neighbours have the coefficient 0, so their index does not matter.
            let mut neighbours = back.map(|distance| cell - distance);
            if pattern & ACROSS != 0 {
                let (ix, iy) = (cell / ny, cell % ny);
                neighbours = CAUSAL.map(|(di, dj)| {
                    let j = (iy as isize + dj).rem_euclid(ny as isize);
                    ix.wrapping_add_signed(di) * ny + j as usize
                });
            }
            let mut product = row[NEIGHBOURS] * r[cell];
            neighbours.iter().zip(row).for_each(|(&neighbour, g)| product += g * r[neighbour]);
            z[cell] += row[NEIGHBOURS] * product;
            neighbours.iter().zip(row).for_each(|(&neighbour, g)| z[neighbour] += g * product);
            squares += f64::from(product) * f64::from(product);
        }
        squares
    }
}

/// Computes the last column of the inverse of the leading `n` × `n` block, by Gaussian elimination of a
/// positive definite matrix.
fn last_column_of_inverse(matrix: &mut [[f64; MEMBERS]; MEMBERS], n: usize) -> [f64; MEMBERS] {
    for pivot in 0..n {
        for row in pivot + 1..n {
            let factor = matrix[row][pivot] / matrix[pivot][pivot];
            let (above, below) = matrix.split_at_mut(row);
            below[0][pivot..n].iter_mut().zip(&above[pivot][pivot..n]).for_each(|(b, a)| *b -= factor * a);
        }
    }
    // The right-hand side e_n is untouched by the elimination.
    let mut solution = [0.0; MEMBERS];
    for row in (0..n).rev() {
        let right = if row == n - 1 { 1.0 } else { 0.0 };
        let known: f64 = (row + 1..n).map(|k| matrix[row][k] * solution[k]).sum();
        solution[row] = (right - known) / matrix[row][row];
    }
    solution
}
