//! Heat partition between two bodies, as a linear system on the cells in contact.

use crate::error::{Error, Result};
use crate::math::{ROWS_ABOVE, SparseInverse};

/// Relative residual of the heat partition, ‖b − A x‖ ≤ TOLERANCE ‖b‖.
pub(super) const TOLERANCE: f64 = 1e-10;
/// Number of iterations after which convergence is no longer expected.
const MOST: usize = 1000;

/// An approximate inverse on the cells in contact, for either method.
pub(super) struct Preconditioner {
    sparse: SparseInverse,
    /// Whether each cell is in contact.
    touching: Vec<bool>,
    /// Pattern of the neighbours of each cell in contact.
    patterns: Vec<u8>,
    /// Number of cells in a row of the grid.
    columns: usize,
    /// Residual and its image on the whole grid, with some zero rows above it; zero outside the contact.
    whole: [Vec<f32>; 2],
}

impl Preconditioner {
    /// Creates it from the coefficients `influence(i, j)` at the offsets ±i, ±j of a positive definite
    /// matrix, on a grid of `shape`.
    pub(super) fn new(shape: [usize; 2], influence: impl Fn(usize, usize) -> f64) -> Self {
        let cells = shape[0] * shape[1];
        // Coefficients are scaled to about 1, because SI values exceed the range of single precision.
        let unit = influence(0, 0);
        let above = ROWS_ABOVE * shape[1];
        Self {
            sparse: SparseInverse::new(shape, [false; 2], |i, j| influence(i, j) / unit),
            touching: vec![false; cells],
            patterns: Vec::new(),
            columns: shape[1],
            whole: [vec![0.0; above + cells], vec![0.0; above + cells]],
        }
    }

    /// Adapts to the flat `cells` in contact.
    fn adapt(&mut self, cells: &[u32]) {
        let Self { sparse, touching, patterns, columns, .. } = self;
        cells.iter().for_each(|cell| touching[*cell as usize] = true);
        patterns.clear();
        let place = |cell: u32| [cell as usize / *columns, cell as usize % *columns];
        patterns.extend(cells.iter().map(|cell| sparse.pattern(place(*cell), |cell| touching[cell])));
        cells.iter().for_each(|cell| touching[*cell as usize] = false);
    }

    /// Computes z = M r on the flat `cells`, up to a factor.
    fn apply(&mut self, cells: &[u32], r: &[f64], z: &mut [f64]) {
        let Self { sparse, patterns, columns, whole: [whole, image], .. } = self;
        let place = |cell: &u32| ROWS_ABOVE * *columns + *cell as usize;
        let scale = r.iter().fold(f64::MIN_POSITIVE, |m, r| m.max(r.abs()));
        cells.iter().zip(r).for_each(|(cell, r)| whole[place(cell)] = (r / scale) as f32);
        sparse.add(cells.iter().map(place).zip(patterns.iter().copied()), whole, image);
        for (cell, z) in cells.iter().map(place).zip(z) {
            *z = f64::from(image[cell]) * scale;
            (whole[cell], image[cell]) = (0.0, 0.0);
        }
    }
}

/// Solves A x = b on the flat `cells` by preconditioned conjugate gradients from x: A symmetric and positive
/// definite. `multiply` writes A of its first argument into its second. Returns the number of iterations.
///
/// # Errors
/// [`Error::NotConverged`].
pub(super) fn conjugate_gradients(
    multiply: &mut dyn FnMut(&[f64], &mut [f64]),
    preconditioner: &mut Preconditioner,
    cells: &[u32],
    right: &[f64],
    x: &mut [f64],
) -> Result<usize> {
    preconditioner.adapt(cells);
    let [mut r, mut z, mut along, mut image] = [(); 4].map(|()| vec![0.0; right.len()]);
    multiply(x, &mut r);
    r.iter_mut().zip(right).for_each(|(r, b)| *r = b - *r);
    let size = norm(right);
    let mut before = 0.0;
    for iteration in 0..MOST {
        if norm(&r) <= TOLERANCE * size {
            return Ok(iteration);
        }
        preconditioner.apply(cells, &r, &mut z);
        let now = dot(&r, &z);
        let share = if before == 0.0 { 0.0 } else { now / before };
        along.iter_mut().zip(&z).for_each(|(p, z)| *p = z + share * *p);
        multiply(&along, &mut image);
        let step = now / dot(&along, &image);
        x.iter_mut().zip(&along).for_each(|(x, p)| *x += step * p);
        r.iter_mut().zip(&image).for_each(|(r, q)| *r -= step * q);
        before = now;
    }
    Err(Error::NotConverged { iterations: MOST, residual: norm(&r) / size, tolerance: TOLERANCE })
}

/// [`conjugate_gradients`] for an A that need not be symmetric: the stabilised biconjugate gradient method,
/// van der Vorst, SIAM J. Sci. Stat. Comput. 13, 631 (1992).
///
/// # Errors
/// [`Error::NotConverged`].
pub(super) fn biconjugate_gradients(
    multiply: &mut dyn FnMut(&[f64], &mut [f64]),
    preconditioner: &mut Preconditioner,
    cells: &[u32],
    right: &[f64],
    x: &mut [f64],
) -> Result<usize> {
    preconditioner.adapt(cells);
    let [mut r, mut p, mut v, mut t, mut y] = [(); 5].map(|()| vec![0.0; right.len()]);
    multiply(x, &mut r);
    r.iter_mut().zip(right).for_each(|(r, b)| *r = b - *r);
    let size = norm(right);
    let (mut shadow, mut rho, mut alpha, mut omega) = (r.clone(), 1.0, 1.0, 1.0);
    for iteration in 0..MOST {
        if norm(&r) <= TOLERANCE * size {
            return Ok(iteration);
        }
        let mut next = dot(&shadow, &r);
        if next.abs() < 1e-12 * norm(&shadow) * norm(&r) {
            // The shadow residual is nearly orthogonal: restart from here.
            shadow.clone_from(&r);
            next = dot(&r, &r);
            p.fill(0.0);
            v.fill(0.0);
        }
        let beta = next / rho * alpha / omega;
        rho = next;
        for ((p, r), v) in p.iter_mut().zip(&r).zip(&v) {
            *p = r + beta * (*p - omega * v);
        }
        preconditioner.apply(cells, &p, &mut y);
        multiply(&y, &mut v);
        alpha = rho / dot(&shadow, &v);
        x.iter_mut().zip(&y).for_each(|(x, y)| *x += alpha * y);
        r.iter_mut().zip(&v).for_each(|(r, v)| *r -= alpha * v);
        preconditioner.apply(cells, &r, &mut y);
        multiply(&y, &mut t);
        let square = dot(&t, &t);
        omega = if square == 0.0 { 1.0 } else { dot(&t, &r) / square };
        x.iter_mut().zip(&y).for_each(|(x, y)| *x += omega * y);
        r.iter_mut().zip(&t).for_each(|(r, t)| *r -= omega * t);
    }
    Err(Error::NotConverged { iterations: MOST, residual: norm(&r) / size, tolerance: TOLERANCE })
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}
