//! A near copy of a convolution that takes a fraction of its time: stencils on three levels, and a transform
//! of 1/64 of the cells.

use std::sync::Arc;

use ndarray::{ArrayView2, Axis};

use crate::grid::{Field, SingleField};
use crate::math::parallel::{self, Pool};
use crate::math::{Cholesky, Convolution, Kernel};

/// Radii of the stencils by level, the finest first; wider ones for cells that are not square.
const RADII: [[usize; LEVELS]; 2] = [[1, 2, 2], [2, 2, 2]];
/// Largest number of levels of stencils.
const LEVELS: usize = 3;
/// Fewest levels of stencils. With fewer, the transform takes too much of the time of the convolution itself.
const MIN_LEVELS: usize = 2;
/// The transform has at least this many values along each axis.
const MIN_TRANSFORM: usize = 16;
/// Largest relative distance |K~ − K|/K of any field, in the energy norm, of a copy that serves.
const MAX_DISTANCE: f64 = 0.1;
/// Number of waves along each axis for which a stencil is designed.
const WAVES: usize = 17;
/// Rounds of least squares, reweighted towards the least maximum of the error.
const ROUNDS: usize = 12;
/// Steps of the power iteration for the error of a wave.
const POWERS: usize = 12;
/// Weight of the mean in the rest of a kernel that leaves the mean free, relative to the other waves.
const MEAN_WEIGHT: f64 = 1e12;
/// Smallest number of rows per thread times their columns.
const SHARE: usize = 1 << 13;
/// Largest radius of a stencil.
const MAX_RADIUS: usize = 2;
/// Room before and after a row in scratch memory.
const ROOM: usize = 4;

/// The near copy K~ of an even convolution kernel K:
///
/// ```text
/// K~ = S + P G P'/4        S a stencil; P interpolates from cells twice as wide, with weights (3 1)/4 along each axis
/// G  = S₁ + P G₁ P'/4      and so on; the last G is a convolution by transforms
/// ```
///
/// A coarse wave stands for four fine ones. G is the best one for each coarse wave, in the energy norm of K,
/// and S the stencil that makes the largest error least. The copy is within a tenth of K in the energy norm,
/// on any cells.
pub(crate) struct NearKernel {
    /// Size of the transforms of the kernel. Fields of this size along an axis are periodic along it.
    shape: [usize; 2],
    stencils: Vec<Stencil>,
    coarsest: Arc<Kernel<f32>>,
}

/// Coefficients `[i][j]` of a stencil at the offsets ±i, ±j.
#[derive(Clone, Copy)]
struct Stencil {
    radius: usize,
    at: [[f32; MAX_RADIUS + 1]; MAX_RADIUS + 1],
}

impl NearKernel {
    /// Designs the copy of a `kernel`. Returns none if no copy is near enough, or if the size of the
    /// transforms cannot be halved often enough.
    pub(crate) fn new(kernel: &Kernel<f64>) -> Option<Self> {
        let shape = kernel.plans.shape;
        let halves =
            |levels: &usize| shape.iter().all(|n| n % (1 << levels) == 0 && n >> levels >= MIN_TRANSFORM);
        let levels = (MIN_LEVELS..=LEVELS).rev().find(halves)?;
        let finest = Rest::new(shape, &kernel.spectrum)?;
        let (stencils, rest) = RADII.iter().find_map(|radii| finest.stencils(&radii[..levels]))?;
        // The kernel stores its spectrum over the largest value.
        let unit = kernel.unit * (shape[0] * shape[1]) as f64;
        let stencils = stencils.iter().map(|stencil| stencil.scaled(unit)).collect();
        let coarsest = Kernel::from_spectrum(rest.shape, rest.symbol * unit);
        Some(Self { shape, stencils, coarsest: Arc::new(coarsest.to_single()) })
    }
}

/// A kernel to be approximated on one level, in Fourier space: values at `[ky, kx]` for `ky ≤ My/2`,
/// `kx ≤ Mx/2`.
struct Rest {
    shape: [usize; 2],
    symbol: Field,
    /// The inverse energy of each wave: the weight of its error.
    weight: Field,
}

/// The four waves that look alike on cells twice as wide.
struct Alike {
    /// Their bins `[ky, kx]`.
    bins: [[usize; 2]; 4],
    /// Their factor under P.
    smoothing: [f64; 4],
}

impl Alike {
    /// Returns the waves of the coarse bin `[ky, kx]` of a grid of `shape`.
    fn new([ky, kx]: [usize; 2], shape: [usize; 2]) -> Self {
        let [mx, my] = shape;
        let pair = |k: usize, m: usize| {
            let (sin, cos) = (std::f64::consts::PI * k as f64 / m as f64).sin_cos();
            [(k, cos.powi(3)), (m / 2 - k, sin.powi(3))]
        };
        let (along_y, along_x) = (pair(ky, my), pair(kx, mx));
        let four = [(0, 0), (0, 1), (1, 0), (1, 1)];
        Self {
            bins: four.map(|(a, b)| [along_y[a].0, along_x[b].0]),
            smoothing: four.map(|(a, b)| along_y[a].1 * along_x[b].1),
        }
    }
}

impl Rest {
    /// Starts from the spectrum of a kernel. Returns none if it is not positive; the mean alone may be free.
    fn new(shape: [usize; 2], spectrum: &Field) -> Option<Self> {
        let mut weight = spectrum.mapv(|value| 1.0 / value);
        if spectrum[[0, 0]] == 0.0 {
            weight[[0, 0]] = MEAN_WEIGHT;
        }
        let positive = weight.iter().all(|weight| *weight > 0.0 && weight.is_finite());
        positive.then(|| Self { shape, symbol: spectrum.clone(), weight })
    }

    /// Designs stencils of these radii. Returns them with the last rest, or none if they are not near enough.
    fn stencils(&self, radii: &[usize]) -> Option<(Vec<Stencil>, Self)> {
        let (mut stencils, mut distance, mut rest) = (Vec::new(), 0.0, None);
        for radius in radii {
            let finer = rest.as_ref().unwrap_or(self);
            let (stencil, error) = finer.stencil(*radius)?;
            distance += error;
            if distance > MAX_DISTANCE || distance.is_nan() {
                return None;
            }
            rest = Some(finer.coarse(&stencil));
            stencils.push(stencil);
        }
        Some((stencils, rest?))
    }

    /// Designs the stencil of this `radius`. Returns it with its largest error.
    fn stencil(&self, radius: usize) -> Option<(Stencil, f64)> {
        let offsets: Vec<[usize; 2]> = (0..=radius).flat_map(|i| (0..=radius).map(move |j| [i, j])).collect();
        let waves = self.sample(&offsets);
        let mut weights = vec![1.0; waves.len()];
        let mut best: Option<(Vec<f64>, f64)> = None;
        for _ in 0..ROUNDS {
            let found = least_squares(&waves, &weights, offsets.len())?;
            let errors: Vec<f64> = waves.iter().map(|wave| wave.distance(&found)).collect();
            let largest = errors.iter().copied().fold(0.0, f64::max);
            if best.as_ref().is_none_or(|(_, least)| largest < *least) {
                best = Some((found, largest));
            }
            weights.iter_mut().zip(&errors).for_each(|(weight, error)| *weight *= error / largest + 1e-2);
            let mean = weights.iter().sum::<f64>() / weights.len() as f64;
            weights.iter_mut().for_each(|weight| *weight /= mean);
        }
        let (found, distance) = best?;
        let mut stencil = Stencil { radius, at: Default::default() };
        offsets.iter().zip(found).for_each(|([i, j], value)| stencil.at[*i][*j] = value as f32);
        Some((stencil, distance))
    }

    /// Returns some coarse waves, evenly spaced, without the mean.
    fn sample(&self, offsets: &[[usize; 2]]) -> Vec<Wave> {
        let some = |m: usize| {
            let last = m / 4;
            let mut bins: Vec<usize> =
                (0..WAVES).map(|k| (k * last + (WAVES - 1) / 2) / (WAVES - 1)).collect();
            bins.dedup();
            bins
        };
        let [mx, my] = self.shape;
        let (along_x, along_y) = (some(mx), some(my));
        let bins = along_y.iter().flat_map(|ky| along_x.iter().map(move |kx| [*ky, *kx]));
        bins.filter(|bin| *bin != [0, 0])
            .map(|bin| {
                let alike = Alike::new(bin, self.shape);
                let weight = alike.bins.map(|bin| self.weight[bin]);
                let mut smooth = [0.0; 4];
                smooth
                    .iter_mut()
                    .zip(weight.iter().zip(alike.smoothing))
                    .for_each(|(v, (w, a))| *v = w * a * a);
                let symbol = alike.bins.map(|bin| self.symbol[bin]);
                let target = [0, 1, 2, 3].map(|n| weight[n] * symbol[n]);
                let basis = offsets.iter().map(|offset| {
                    [0, 1, 2, 3].map(|n| weight[n] * wave_of(*offset, alike.bins[n], self.shape))
                });
                Wave { smooth, target, basis: basis.collect() }
            })
            .collect()
    }

    /// Returns the best rest for each coarse wave after a `stencil`.
    fn coarse(&self, stencil: &Stencil) -> Self {
        let shape = self.shape.map(|m| m / 2);
        let [mx, my] = self.shape;
        let cosines = |m: usize| -> Vec<[f64; MAX_RADIUS + 1]> {
            let wave = |k: usize| {
                std::array::from_fn(|i| {
                    multiplicity(i) * (std::f64::consts::TAU * (k * i) as f64 / m as f64).cos()
                })
            };
            (0..=m / 2).map(wave).collect()
        };
        let (along_x, along_y) = (cosines(mx), cosines(my));
        // The stencil along x for each wave along x: a sum over its rows.
        let rows: Vec<[f64; MAX_RADIUS + 1]> = along_x
            .iter()
            .map(|wave| {
                std::array::from_fn(|j| {
                    (0..=stencil.radius).map(|i| f64::from(stencil.at[i][j]) * wave[i]).sum()
                })
            })
            .collect();
        let stencil_at =
            |[ky, kx]: [usize; 2]| -> f64 { rows[kx].iter().zip(&along_y[ky]).map(|(a, b)| a * b).sum() };
        let mut symbol = Field::zeros([shape[1] / 2 + 1, shape[0] / 2 + 1]);
        let mut weight = symbol.clone();
        let of_pair = |k: usize, m: usize| {
            let (sin, cos) = (std::f64::consts::PI * k as f64 / m as f64).sin_cos();
            [cos.powi(6), sin.powi(6)]
        };
        let along: Vec<[f64; 2]> = (0..=mx / 4).map(|kx| of_pair(kx, mx)).collect();
        for ky in 0..symbol.nrows() {
            let (squares_y, bins_y) = (of_pair(ky, my), [ky, my / 2 - ky]);
            for kx in 0..symbol.ncols() {
                let bins_x = [kx, mx / 2 - kx];
                let (mut above, mut below) = (0.0, 0.0);
                for (square_y, bin_y) in squares_y.iter().zip(bins_y) {
                    for (square_x, bin_x) in along[kx].iter().zip(bins_x) {
                        let bin = [bin_y, bin_x];
                        let (square, w) = (square_y * square_x, self.weight[bin]);
                        above += square * w * w * (self.symbol[bin] - stencil_at(bin));
                        below += square * w;
                    }
                }
                symbol[[ky, kx]] = above / (below * below);
                weight[[ky, kx]] = below;
            }
        }
        Self { shape, symbol, weight }
    }
}

/// Number of offsets ±i.
fn multiplicity(i: usize) -> f64 {
    if i == 0 { 1.0 } else { 2.0 }
}

/// Returns the symbol of a stencil that is 1 at the offsets ±i, ±j, for the bin `[ky, kx]` of a grid of
/// `shape`.
fn wave_of([i, j]: [usize; 2], [ky, kx]: [usize; 2], shape: [usize; 2]) -> f64 {
    let cosine = |i: usize, k: usize, m: usize| {
        multiplicity(i) * (std::f64::consts::TAU * (k * i) as f64 / m as f64).cos()
    };
    cosine(i, kx, shape[0]) * cosine(j, ky, shape[1])
}

/// The error D (T − S − G a aᵀ) D over the four waves of a coarse one: a diagonal part, linear in the
/// stencil, without the best multiple of v vᵀ.
struct Wave {
    /// The diagonal of v vᵀ.
    smooth: [f64; 4],
    /// The diagonal part of the kernel.
    target: [f64; 4],
    /// The diagonal part of each coefficient of the stencil.
    basis: Vec<[f64; 4]>,
}

impl Wave {
    /// Returns the diagonal part of the error.
    fn diagonal(&self, stencil: &[f64]) -> [f64; 4] {
        let mut left = self.target;
        for (basis, value) in self.basis.iter().zip(stencil) {
            left.iter_mut().zip(basis).for_each(|(left, b)| *left -= value * b);
        }
        left
    }

    /// Returns the best factor of v vᵀ for a diagonal.
    fn factor(&self, diagonal: &[f64; 4]) -> f64 {
        let size: f64 = self.smooth.iter().sum();
        dot(&self.smooth, diagonal) / (size * size)
    }

    /// Returns the spectral norm of the error, by power iteration on its square.
    fn distance(&self, stencil: &[f64]) -> f64 {
        let diagonal = self.diagonal(stencil);
        let factor = self.factor(&diagonal);
        let v = self.smooth.map(f64::sqrt);
        let times = |x: [f64; 4]| {
            let along = factor * dot(&v, &x);
            [0, 1, 2, 3].map(|n| diagonal[n] * x[n] - along * v[n])
        };
        let (mut x, mut norm) = ([0.6, -0.5, 0.4, 0.7], 0.0);
        for _ in 0..POWERS {
            let size = dot(&x, &x).sqrt();
            if size == 0.0 {
                return norm;
            }
            x = times(x.map(|x| x / size));
            norm = dot(&x, &x).sqrt();
        }
        norm
    }
}

fn dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Computes the stencil with the least weighted sum of squares of the errors.
fn least_squares(waves: &[Wave], weights: &[f64], count: usize) -> Option<Vec<f64>> {
    let mut matrix = Field::zeros([count, count]);
    let mut right = vec![0.0; count];
    for (wave, weight) in waves.iter().zip(weights) {
        let size: f64 = wave.smooth.iter().sum();
        let along: Vec<f64> = wave.basis.iter().map(|basis| dot(&wave.smooth, basis) / size).collect();
        let target = dot(&wave.smooth, &wave.target) / size;
        for i in 0..count {
            right[i] += weight * (dot(&wave.basis[i], &wave.target) - along[i] * target);
            for j in 0..count {
                matrix[[i, j]] += weight * (dot(&wave.basis[i], &wave.basis[j]) - along[i] * along[j]);
            }
        }
    }
    let trace: f64 = matrix.diag().sum();
    matrix.diag_mut().iter_mut().for_each(|value| *value += 1e-12 * trace);
    Some(Cholesky::new(matrix)?.solve(&right))
}

impl Stencil {
    fn scaled(&self, unit: f64) -> Self {
        Self { radius: self.radius, at: self.at.map(|row| row.map(|value| (f64::from(value) * unit) as f32)) }
    }
}

/// Position of the cells of a level among those of the next one.
#[derive(Clone, Copy)]
struct Place {
    /// Number of cells along the axis.
    cells: usize,
    /// Index of the cell at the origin. Beyond a free border there is one more cell on each coarse level, to
    /// which P' spreads.
    origin: usize,
    wraps: bool,
}

impl Place {
    /// Returns the cells of the next level.
    fn coarse(self) -> Self {
        let Self { cells, origin, wraps } = self;
        if wraps {
            return Self { cells: cells / 2, origin, wraps };
        }
        // Indices from the origin: −1 to (last + 1)/2.
        Self { cells: (cells - origin) / 2 + 2, origin: 1, wraps }
    }

    /// Returns the index of a cell, or none beyond a free border.
    fn index(self, at: isize) -> Option<usize> {
        let cells = self.cells as isize;
        if self.wraps {
            return Some(at.rem_euclid(cells) as usize);
        }
        (0..cells).contains(&at).then_some(at as usize)
    }

    /// Distance from the first fine cell to the first of the pair of the coarse cell 0: 2 (0 − o') + o.
    fn shift(self, coarse: Self) -> isize {
        self.origin as isize - 2 * coarse.origin as isize
    }
}

/// The near copy of a convolution on fields of one shape, with its scratch memory.
pub(crate) struct NearConvolution {
    kernel: Arc<NearKernel>,
    places: Vec<[Place; 2]>,
    /// Restricted field and its image on each coarse level.
    levels: Vec<[SingleField; 2]>,
    coarsest: Convolution<f32>,
    scratch: Pool<Vec<f32>>,
}

impl NearConvolution {
    /// Creates the convolution of fields of `shape`.
    pub(crate) fn new(kernel: Arc<NearKernel>, shape: [usize; 2]) -> Self {
        let fine = [0, 1].map(|axis| Place {
            cells: shape[axis],
            origin: 0,
            wraps: shape[axis] == kernel.shape[axis],
        });
        let mut places = vec![fine];
        for level in 0..kernel.stencils.len() {
            places.push(places[level].map(Place::coarse));
        }
        let field = |place: &[Place; 2]| SingleField::zeros([place[0].cells, place[1].cells]);
        let levels: Vec<_> = places[1..].iter().map(|place| [field(place), field(place)]).collect();
        let coarsest =
            Convolution::new(Arc::clone(&kernel.coarsest), places[levels.len()].map(|place| place.cells));
        Self { kernel, places, levels, coarsest, scratch: Pool::default() }
    }

    /// Computes the near `output` of the convolution of `input`.
    pub(crate) fn apply(&mut self, input: &SingleField, output: &mut SingleField) {
        let Self { kernel, places, levels, coarsest, scratch } = self;
        let last = levels.len() - 1;
        for level in 0..=last {
            let (finer, coarser) = levels.split_at_mut(level);
            let from = if level == 0 { input } else { &finer[level - 1][0] };
            restrict(from, &mut coarser[0][0], places[level], places[level + 1], scratch);
        }
        let [restricted, image] = &mut levels[last];
        coarsest.apply(restricted, image);
        for level in (0..=last).rev() {
            let (finer, coarser) = levels.split_at_mut(level);
            let from = &coarser[0][1];
            let place = [places[level], places[level + 1]];
            let stencil = &kernel.stencils[level];
            match finer.last_mut() {
                None => add_levels(stencil, input, from, output, place, scratch),
                Some([field, image]) => add_levels(stencil, field, from, image, place, scratch),
            }
        }
    }
}

/// Returns a row of a field; zeros beyond a free border.
fn row<'a>(field: &ArrayView2<'a, f32>, place: Place, at: isize, zeros: &'a [f32]) -> &'a [f32] {
    let Some(index) = place.index(at) else { return zeros };
    let columns = field.ncols();
    &field.to_slice().expect("standard layout")[index * columns..][..columns]
}

/// Fills the room around a row of `cells` values: with the values across the border, or zeros.
fn fill_room(padded: &mut [f32], cells: usize, wraps: bool) {
    for k in 0..ROOM {
        let (before, after) = (ROOM - 1 - k, ROOM + cells + k);
        if wraps {
            // Fields have at least as many cells as the room.
            padded[before] = padded[before + cells];
            padded[after] = padded[after - cells];
        } else {
            (padded[before], padded[after]) = (0.0, 0.0);
        }
    }
}

/// Computes c = P' p/4: weights (1 3 3 1)/8 along each axis.
fn restrict(
    fine: &SingleField,
    coarse: &mut SingleField,
    places: [Place; 2],
    coarse_places: [Place; 2],
    scratch: &Pool<Vec<f32>>,
) {
    let (columns, all) = (fine.ncols(), fine.view());
    let shift = [0, 1].map(|axis| places[axis].shift(coarse_places[axis]));
    let zeros = vec![0.0; columns];
    let at_once = SHARE.div_ceil(2 * columns);
    parallel::each(
        coarse.axis_iter_mut(Axis(0)).enumerate(),
        at_once,
        scratch,
        Vec::new,
        |sums, (i, mut to)| {
            sums.resize(columns + 2 * ROOM, 0.0);
            let first = 2 * i as isize + shift[0];
            let [a, b, c, d] = [-1, 0, 1, 2].map(|k| row(&all, places[0], first + k, &zeros));
            let inner = &mut sums[ROOM..][..columns];
            for ((((sum, a), b), c), d) in inner.iter_mut().zip(a).zip(b).zip(c).zip(d) {
                *sum = (a + d) + 3.0 * (b + c);
            }
            fill_room(sums, columns, places[1].wraps);
            // Cell 2 J − 1 of the first coarse cell is at least −3 in the field.
            let start = (ROOM as isize + shift[1] - 1) as usize;
            let to = to.as_slice_mut().expect("rows are contiguous");
            let pairs = sums[start..].chunks_exact(2).zip(sums[start + 2..].chunks_exact(2));
            for (to, (near, far)) in to.iter_mut().zip(pairs) {
                *to = ((near[0] + far[1]) + 3.0 * (near[1] + far[0])) * (1.0 / 64.0);
            }
        },
    );
}

/// Computes S p + P u from the field p of a level and the image u of the next one.
fn add_levels(
    stencil: &Stencil,
    field: &SingleField,
    coarse: &SingleField,
    image: &mut SingleField,
    [places, coarse_places]: [[Place; 2]; 2],
    scratch: &Pool<Vec<f32>>,
) {
    let (columns, coarse_columns) = (field.ncols(), coarse.ncols());
    let (field, coarse) = (field.view(), coarse.view());
    let shift = [0, 1].map(|axis| places[axis].shift(coarse_places[axis]));
    let (zeros, coarse_zeros) = (vec![0.0; columns], vec![0.0; coarse_columns]);
    let at_once = SHARE.div_ceil(columns);
    let padded = columns + 2 * ROOM;
    parallel::each(
        image.axis_iter_mut(Axis(0)).enumerate(),
        at_once,
        scratch,
        Vec::new,
        |scratch, (i, mut to)| {
            scratch.resize(
                (MAX_RADIUS + 1) * padded + coarse_columns + 2 * ROOM + 2 * coarse_columns + 2 * ROOM,
                0.0,
            );
            let (sums, rest) = scratch.split_at_mut((MAX_RADIUS + 1) * padded);
            let (mixed, wide) = rest.split_at_mut(coarse_columns + 2 * ROOM);
            let to = to.as_slice_mut().expect("rows are contiguous");
            // Interpolation along x, from the row of the cell and the one that it is nearer to.
            let from = i as isize - shift[0];
            let near = from.div_euclid(2);
            let far = if from.rem_euclid(2) == 0 { near - 1 } else { near + 1 };
            let [near, far] = [near, far].map(|at| row(&coarse, coarse_places[0], at, &coarse_zeros));
            for ((mixed, near), far) in mixed[ROOM..].iter_mut().zip(near).zip(far) {
                *mixed = (3.0 * near + far) * (1.0 / 16.0);
            }
            fill_room(mixed, coarse_columns, coarse_places[1].wraps);
            let before = &mixed[ROOM - 1..][..coarse_columns];
            let after = &mixed[ROOM + 1..][..coarse_columns];
            let pairs = wide.chunks_exact_mut(2).zip(before).zip(&mixed[ROOM..]).zip(after);
            for (((pair, before), here), after) in pairs {
                let here = 3.0 * here;
                (pair[0], pair[1]) = (here + before, here + after);
            }
            let wide = &wide[-shift[1] as usize..][..columns];
            // The stencil: sums of the rows for each distance along y.
            let at = i as isize;
            let line = |k: isize| row(&field, places[0], at + k, &zeros);
            let s = &stencil.at;
            if stencil.radius == 1 {
                let [near, here, far] = [-1, 0, 1].map(line);
                let (own, beside) = sums.split_at_mut(padded);
                let own = &mut own[ROOM..][..columns];
                let targets = own.iter_mut().zip(&mut beside[ROOM..][..columns]);
                for ((((own, beside), a), b), c) in targets.zip(near).zip(here).zip(far) {
                    let both = a + c;
                    *own = s[0][0] * b + s[1][0] * both;
                    *beside = s[0][1] * b + s[1][1] * both;
                }
                fill_room(beside, columns, places[1].wraps);
                let [left, right] = [ROOM - 1, ROOM + 1].map(|start| &beside[start..][..columns]);
                for ((((to, own), left), right), wide) in
                    to.iter_mut().zip(&*own).zip(left).zip(right).zip(wide)
                {
                    *to = own + (left + right) + wide;
                }
            } else {
                let [a, b, c, d, e] = [-2, -1, 0, 1, 2].map(line);
                let (own, beside) = sums.split_at_mut(padded);
                let (next, third) = beside.split_at_mut(padded);
                let own = &mut own[ROOM..][..columns];
                let inner = next[ROOM..][..columns].iter_mut().zip(&mut third[ROOM..][..columns]);
                let targets = own.iter_mut().zip(inner);
                for (((((own, (next, third)), a), b), c), (d, e)) in
                    targets.zip(a).zip(b).zip(c).zip(d.iter().zip(e))
                {
                    let (two, four) = (b + d, a + e);
                    *own = s[0][0] * c + (s[1][0] * two + s[2][0] * four);
                    *next = s[0][1] * c + (s[1][1] * two + s[2][1] * four);
                    *third = s[0][2] * c + (s[1][2] * two + s[2][2] * four);
                }
                fill_room(next, columns, places[1].wraps);
                fill_room(third, columns, places[1].wraps);
                let [left, right] = [ROOM - 1, ROOM + 1].map(|start| &next[start..][..columns]);
                let [first, last] = [ROOM - 2, ROOM + 2].map(|start| &third[start..][..columns]);
                let beside = left.iter().zip(right).zip(first).zip(last);
                for (((to, own), (((left, right), first), last)), wide) in
                    to.iter_mut().zip(&*own).zip(beside).zip(wide)
                {
                    *to = own + (left + right) + (first + last) + wide;
                }
            }
        },
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::kernel_of_values;

    /// A kernel with the spectrum 1/|q| on a grid of these pitches.
    fn periodic(shape: [usize; 2], pitch: [f64; 2]) -> Kernel<f64> {
        let [mx, my] = shape;
        let spectrum = Field::from_shape_fn([my / 2 + 1, mx / 2 + 1], |(l, k)| {
            let q = (k as f64 / (mx as f64 * pitch[0])).hypot(l as f64 / (my as f64 * pitch[1]));
            if q == 0.0 { 0.0 } else { 1.0 / q }
        });
        Kernel::from_spectrum(shape, spectrum)
    }

    /// The kernel 1/r with a finite value at 0, padded for fields of half its size.
    fn free(shape: [usize; 2]) -> Kernel<f64> {
        let table = Field::from_shape_fn(shape.map(|m| m / 2 + 1), |(i, j)| {
            let r = (i as f64).hypot(j as f64);
            if r == 0.0 { 3.525 } else { 1.0 / r }
        });
        kernel_of_values(shape, &table)
    }

    /// Returns |K~ x − K x| in the norm of K⁻¹ over that of x in the norm of K, at most the distance of the
    /// copy.
    fn distance(kernel: Kernel<f64>, shape: [usize; 2], x: &SingleField) -> f64 {
        let near = NearKernel::new(&kernel).expect("a near copy");
        let (mut copy, mut exact) = (SingleField::zeros(shape), Field::zeros(shape));
        NearConvolution::new(Arc::new(near), shape).apply(x, &mut copy);
        Convolution::new(Arc::new(kernel), shape).apply(&x.mapv(f64::from), &mut exact);
        // By Cauchy and Schwarz x·(K~ − K) x is at most the distance times x·K x.
        let work = |u: &Field| x.iter().zip(u).map(|(x, u)| f64::from(*x) * u).sum::<f64>();
        let difference = copy.mapv(f64::from) - &exact;
        work(&difference).abs() / work(&exact)
    }

    fn fields(shape: [usize; 2]) -> Vec<SingleField> {
        let wave = |k: usize, l: usize| {
            SingleField::from_shape_fn(shape, |(i, j)| {
                let [x, y] = [(i * k, shape[0]), (j * l, shape[1])].map(|(a, n)| a as f32 / n as f32);
                (std::f32::consts::TAU * (x + y)).cos()
            })
        };
        let patches =
            SingleField::from_shape_fn(shape, |(i, j)| if (i / 5 + j / 7) % 3 == 0 { 1.0 } else { 0.0 });
        let mean = patches.sum() / patches.len() as f32;
        let random =
            SingleField::from_shape_fn(shape, |(i, j)| ((i * 7919 + j * 104_729) % 101) as f32 - 50.0);
        let random_mean = random.sum() / random.len() as f32;
        let mut corner = SingleField::zeros(shape);
        (corner[[0, 0]], corner[[shape[0] - 1, shape[1] - 1]]) = (1.0, -1.0);
        let waves = [(1, 0), (0, 1), (3, 5), (20, 7), (shape[0] / 2, 0), (9, shape[1] / 2)];
        let waves = waves.into_iter().map(|(k, l)| wave(k, l));
        waves.chain([patches - mean, random - random_mean, corner]).collect()
    }

    #[test]
    fn it_is_within_a_tenth_of_the_kernel_in_the_energy_norm() {
        for shape in [[128, 128], [64, 128], [192, 64], [320, 128]] {
            for x in fields(shape) {
                let found = distance(periodic(shape, [1.0, 1.0]), shape, &x);
                assert!(found < 0.1, "periodic {shape:?}: {found}");
            }
        }
        for (shape, torus) in [([64, 64], [128, 128]), ([61, 90], [128, 192]), ([33, 64], [128, 128])] {
            for x in fields(shape) {
                let found = distance(free(torus), shape, &x);
                assert!(found < 0.1, "free {shape:?}: {found}");
            }
        }
    }

    #[test]
    fn it_leaves_the_mean_free_as_the_kernel_does() {
        let shape = [128, 64];
        let near = NearKernel::new(&periodic(shape, [1.0, 1.0])).unwrap();
        let mut image = SingleField::zeros(shape);
        let mut copy = NearConvolution::new(Arc::new(near), shape);
        copy.apply(&SingleField::ones(shape), &mut image);
        let uniform = image.iter().fold(0.0f32, |most, u| most.max(u.abs()));
        let mut unit = SingleField::zeros(shape);
        unit[[0, 0]] = 1.0;
        copy.apply(&unit, &mut image);
        assert!(uniform < 1e-4 * image[[0, 0]] * (shape[0] * shape[1]) as f32, "{uniform}");
    }

    #[test]
    fn sizes_that_cannot_be_halved_and_stretched_cells_have_none() {
        assert!(NearKernel::new(&periodic([125, 128], [1.0, 1.0])).is_none());
        assert!(NearKernel::new(&periodic([32, 32], [1.0, 1.0])).is_none());
        assert!(NearKernel::new(&periodic([128, 128], [1.0, 20.0])).is_none());
    }

    #[test]
    fn its_bits_do_not_depend_on_the_threads() {
        let shape = [512, 384];
        let x = &fields(shape)[6];
        let image = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let near = NearKernel::new(&periodic(shape, [1.0, 1.0])).unwrap();
            let mut image = SingleField::zeros(shape);
            pool.install(|| NearConvolution::new(Arc::new(near), shape).apply(x, &mut image));
            image.mapv(f32::to_bits)
        };
        assert_eq!(image(1), image(3));
    }
}
