//! Convolution of three fields with a tensor of kernels by real Fourier transforms.

use std::sync::Arc;

use asperity_transforms::Precision;
use asperity_transforms::num_complex::Complex;
use asperity_transforms::num_traits::Zero;
use ndarray::Array2;

use crate::grid::Field;
use crate::math::convolution::{Parity, Scratch, Strip, Transform, spectrum, strips_at_once};
use crate::math::parallel::{self, Pool};
use asperity_base::math::plans::{Plans, real};

/// Parities along x and y of the components xx, xy, yy, xz, yz and zz of the tensor.
const PARITIES: [[Parity; 2]; 6] = [
    [Parity::Even, Parity::Even],
    [Parity::Odd, Parity::Odd],
    [Parity::Even, Parity::Even],
    [Parity::Odd, Parity::Even],
    [Parity::Even, Parity::Odd],
    [Parity::Even, Parity::Even],
];

/// A cyclic tensor in Fourier space, with the plans of its size:
///
/// ```text
/// xx   xy  −zx     xx, yy, zz   even in x and in y
/// xy   yy  −zy     xy           odd in both
/// zx   zy   zz     zx, zy       odd in x, in y
/// ```
///
/// At an offset of half an even period odd components are zero.
pub(crate) struct TensorKernel<T> {
    plans: Plans<T>,
    /// xx, xy, yy, zx, zy, zz, over the unit. zx and zy are the imaginary parts of imaginary coefficients.
    /// Kernels of both precisions share them.
    spectra: Arc<[Field; 6]>,
    /// A power of two of the size of the largest spectrum. The spectra over this unit are in the range of
    /// single precision.
    unit: f64,
    /// Whether zx or zy are not zero.
    coupled: bool,
}

impl TensorKernel<f64> {
    /// Creates the tensor on a cyclic grid of `shape` with the values `at(i, j)` (xx, xy, yy, zx, zy, zz) at
    /// the offsets i, j, for `i ≤ Mx/2`, `j ≤ My/2`.
    pub(crate) fn from_values(shape: [usize; 2], at: impl Fn(usize, usize) -> [f64; 6] + Sync) -> Self {
        let plans = Plans::new(shape);
        let tables = tables(shape, at);
        let spectra = std::array::from_fn(|n| {
            let spectrum = spectrum(&plans, &tables[n], PARITIES[n]);
            // i² where both axes are odd.
            if PARITIES[n] == [Parity::Odd; 2] { -spectrum } else { spectrum }
        });
        Self::new(plans, spectra)
    }

    /// Creates the tensor on a cyclic grid of `shape` with the transforms `at(kx, ky)` (xx, xy, yy, zx/i,
    /// zy/i, zz) at its bins, for `kx ≤ Mx/2`, `ky ≤ My/2`.
    pub(crate) fn from_transforms(shape: [usize; 2], at: impl Fn(usize, usize) -> [f64; 6] + Sync) -> Self {
        let own_opposite = |k: usize, n: usize| k == 0 || 2 * k == n;
        let mut spectra =
            tables(shape, at).map(|table| table.reversed_axes().as_standard_layout().into_owned());
        for (spectrum, parity) in spectra.iter_mut().zip(PARITIES) {
            for ((ky, kx), value) in spectrum.indexed_iter_mut() {
                let odd =
                    |axis: usize| parity[axis] == Parity::Odd && own_opposite([kx, ky][axis], shape[axis]);
                if odd(0) || odd(1) {
                    *value = 0.0;
                }
            }
        }
        Self::new(Plans::new(shape), spectra)
    }

    fn new(plans: Plans<f64>, mut spectra: [Field; 6]) -> Self {
        let cells = (plans.shape[0] * plans.shape[1]) as f64;
        spectra.iter_mut().for_each(|spectrum| *spectrum /= cells);
        let coupled = spectra[3..5].iter().flatten().any(|s| *s != 0.0);
        let largest = spectra.iter().flatten().fold(0.0f64, |most, s| most.max(s.abs()));
        let unit = if largest > 0.0 { largest.log2().floor().exp2() } else { 1.0 };
        spectra.iter_mut().for_each(|spectrum| *spectrum /= unit);
        Self { plans, spectra: Arc::new(spectra), unit, coupled }
    }

    /// Returns the kernel for transforms in single precision.
    pub(crate) fn to_single(&self) -> TensorKernel<f32> {
        let plans = Plans::new(self.plans.shape);
        TensorKernel { plans, spectra: Arc::clone(&self.spectra), unit: self.unit, coupled: self.coupled }
    }
}

fn tables(shape: [usize; 2], at: impl Fn(usize, usize) -> [f64; 6] + Sync) -> [Field; 6] {
    let [rows, columns] = shape.map(|n| n / 2 + 1);
    let values = parallel::tasks(0..rows, |i| (0..columns).map(|j| at(i, j)).collect::<Vec<_>>());
    std::array::from_fn(|n| Field::from_shape_fn([rows, columns], |(i, j)| values[i][j][n]))
}

/// Convolution of three fields of one shape with a [`TensorKernel`]; see [`super::Convolution`] for one
/// field.
///
/// Each given field is transformed once, and each requested field is transformed back once.
pub(crate) struct TensorConvolution<T> {
    kernel: Arc<TensorKernel<T>>,
    transforms: [Transform<T>; 3],
    rows: Pool<Scratch<T>>,
    strips: Pool<[Scratch<T>; 3]>,
}

impl<T: Precision> TensorConvolution<T> {
    /// Creates the convolution of fields of `shape`.
    ///
    /// # Panics
    /// If the kernel is smaller than `shape`.
    pub(crate) fn new(kernel: Arc<TensorKernel<T>>, shape: [usize; 2]) -> Self {
        Self {
            transforms: std::array::from_fn(|_| Transform::new(&kernel.plans, shape)),
            rows: Pool::default(),
            strips: Pool::default(),
            kernel,
        }
    }

    /// Computes the requested fields by convolution of the given fields. Missing fields are zero.
    ///
    /// # Panics
    /// If a field has another shape than the plans.
    pub(crate) fn apply(&mut self, input: [Option<&Array2<T>>; 3], output: [Option<&mut Array2<T>>; 3]) {
        let Self { kernel, transforms, rows, strips: scratch } = self;
        let plans = &kernel.plans;
        let given = input.map(|field| field.is_some());
        let asked = output.each_ref().map(|field| field.is_some());
        // Without coupling, the fields in the plane and the field along z are independent.
        let meet = |flags: [bool; 3]| {
            if kernel.coupled {
                [flags.contains(&true); 3]
            } else {
                [flags[0] || flags[1], flags[0] || flags[1], flags[2]]
            }
        };
        let both = |a: [bool; 3], b: [bool; 3]| std::array::from_fn::<bool, 3, _>(|n| a[n] && b[n]);
        let (forward, back) = (both(given, meet(asked)), both(asked, meet(given)));
        let in_plane = !(forward[2] || back[2]);
        for ((transform, field), forward) in transforms.iter_mut().zip(input).zip(forward) {
            if let (Some(field), true) = (field, forward) {
                transform.rows_forward(plans, field, rows);
            }
        }
        let [x, y, z] = transforms.each_mut().map(Transform::strips);
        let strips = x.zip(y).zip(z).map(|((x, y), z)| [x, y, z]);
        parallel::each(
            strips,
            strips_at_once(plans),
            scratch,
            || self::scratch(plans),
            |scratch, mut strips| {
                for ((strip, scratch), forward) in strips.iter().zip(&mut *scratch).zip(forward) {
                    if forward {
                        strip.forward(plans, scratch);
                    } else {
                        strip.columns(plans, scratch).for_each(|(_, column)| column.fill(Complex::zero()));
                    }
                }
                kernel.multiply(&strips, scratch, in_plane);
                for ((strip, scratch), back) in strips.iter_mut().zip(scratch).zip(back) {
                    if back {
                        strip.back(plans, scratch);
                    }
                }
            },
        );
        for ((transform, field), back) in transforms.iter_mut().zip(output).zip(back) {
            match field {
                Some(field) if back => transform.rows_back(plans, real(kernel.unit), field, rows),
                Some(field) => field.fill(T::zero()),
                None => {}
            }
        }
    }
}

/// Scratch for the transforms of three fields.
fn scratch<T: Precision>(plans: &Plans<T>) -> [Scratch<T>; 3] {
    std::array::from_fn(|_| Scratch::new(plans))
}

impl<T: Precision> TensorKernel<T> {
    /// Multiplies the columns of three strips by the tensor; `in_plane` means that the field along z is zero.
    fn multiply(&self, strips: &[Strip<T>; 3], scratch: &mut [Scratch<T>; 3], in_plane: bool) {
        let half = self.plans.shape[0] / 2 + 1;
        let [x, y, z] = scratch;
        let columns = strips[0].columns(&self.plans, x).zip(strips[1].columns(&self.plans, y));
        for (((ky, x), (_, y)), (_, z)) in columns.zip(strips[2].columns(&self.plans, z)) {
            let spectra = self.spectra.each_ref().map(|spectrum| {
                let columns = spectrum.ncols();
                &spectrum.as_slice().expect("standard layout")[ky * columns..][..columns]
            });
            // The bins of negative kx follow from those of positive kx: components that are odd in x change
            // their sign.
            let opposite = spectra.map(|spectrum| &spectrum[1..]);
            let ((x, x_back), (y, y_back)) = (x.split_at_mut(half), y.split_at_mut(half));
            let (x_back, y_back) = (x_back.iter_mut().rev(), y_back.iter_mut().rev());
            if in_plane {
                multiply_in_plane(x.iter_mut(), y.iter_mut(), spectra, T::one());
                multiply_in_plane(x_back, y_back, opposite, -T::one());
            } else {
                let (z, z_back) = z.split_at_mut(half);
                multiply(x.iter_mut(), y.iter_mut(), z.iter_mut(), spectra, T::one());
                multiply(x_back, y_back, z_back.iter_mut().rev(), opposite, -T::one());
            }
        }
    }
}

/// Multiplies the bins of the three fields by the tensor, whose components that are odd in x have this
/// `sign`.
fn multiply<'a, T: Precision>(
    x: impl Iterator<Item = &'a mut Complex<T>>,
    y: impl Iterator<Item = &'a mut Complex<T>>,
    z: impl Iterator<Item = &'a mut Complex<T>>,
    [xx, xy, yy, zx, zy, zz]: [&[f64]; 6],
    sign: T,
) {
    let fields = x.zip(y).zip(z);
    let tensor = xx.iter().zip(xy).zip(yy).zip(zx).zip(zy).zip(zz);
    for (((x, y), z), (((((xx, xy), yy), zx), zy), zz)) in fields.zip(tensor) {
        let (a, b, c) = (*x, *y, times_i(*z));
        let (xx, yy, zz) = (real(*xx), real(*yy), real(*zz));
        let (xy, zx, zy) = (sign * real(*xy), sign * real(*zx), real(*zy));
        *z = times_i(a.scale(zx) + b.scale(zy)) + z.scale(zz);
        *x = a.scale(xx) + b.scale(xy) - c.scale(zx);
        *y = a.scale(xy) + b.scale(yy) - c.scale(zy);
    }
}

/// [`multiply`] without a field along z.
fn multiply_in_plane<'a, T: Precision>(
    x: impl Iterator<Item = &'a mut Complex<T>>,
    y: impl Iterator<Item = &'a mut Complex<T>>,
    [xx, xy, yy, ..]: [&[f64]; 6],
    sign: T,
) {
    for ((x, y), ((xx, xy), yy)) in x.zip(y).zip(xx.iter().zip(xy).zip(yy)) {
        let (a, b) = (*x, *y);
        let (xx, xy, yy) = (real(*xx), sign * real(*xy), real(*yy));
        *x = a.scale(xx) + b.scale(xy);
        *y = a.scale(xy) + b.scale(yy);
    }
}

fn times_i<T: Precision>(value: Complex<T>) -> Complex<T> {
    Complex::new(-value.im, value.re)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tensor with the correct parities on offsets of a few cells, on a cyclic grid of `shape`.
    fn value(shape: [usize; 2], offset: [isize; 2]) -> [f64; 6] {
        let [i, j] = [0, 1].map(|axis| {
            let n = shape[axis] as isize;
            let wrapped = (offset[axis] + n / 2).rem_euclid(n) - n / 2;
            (wrapped as f64, 2 * wrapped.abs() == n)
        });
        let decay = 1.0 / (1.0 + i.0 * i.0 + 0.5 * j.0 * j.0);
        let (x, y) = (if i.1 { 0.0 } else { i.0 }, if j.1 { 0.0 } else { j.0 });
        [1.0 + i.0 * i.0, 0.7 * x * y, 2.0 + j.0 * j.0, 0.9 * x, -1.3 * y, 1.5].map(|v| v * decay)
    }

    fn fields(shape: [usize; 2]) -> [Field; 3] {
        std::array::from_fn(|n| {
            Field::from_shape_fn(shape, |(i, j)| ((5 * i + 3 * j * j + 7 * n * i * j) % 11) as f64 - 4.0)
        })
    }

    fn slowly(shape: [usize; 2], input: &[Field; 3]) -> [Field; 3] {
        let [nx, ny] = input[0].dim().into();
        std::array::from_fn(|row| {
            Field::from_shape_fn([nx, ny], |(i, j)| {
                let mut sum = 0.0;
                for ((k, l), _) in input[0].indexed_iter() {
                    let offset = [i as isize - k as isize, j as isize - l as isize];
                    let [xx, xy, yy, zx, zy, zz] = value(shape, offset);
                    let matrix = [[xx, xy, -zx], [xy, yy, -zy], [zx, zy, zz]];
                    sum += (0..3).map(|n| matrix[row][n] * input[n][[k, l]]).sum::<f64>();
                }
                sum
            })
        })
    }

    fn kernel(shape: [usize; 2]) -> Arc<TensorKernel<f64>> {
        Arc::new(TensorKernel::from_values(shape, |i, j| value(shape, [i as isize, j as isize])))
    }

    fn assert_close(fast: &Field, slow: &Field) {
        let error = fast.iter().zip(slow).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
        assert!(error < 1e-11, "{error:e}");
    }

    #[test]
    fn it_is_the_sum_for_even_and_odd_sizes_whole_and_padded() {
        for (shape, cells) in
            [([1, 1], [1, 1]), ([6, 4], [6, 4]), ([5, 7], [5, 7]), ([9, 8], [5, 4]), ([1, 6], [1, 3])]
        {
            let input = fields(cells);
            let slow = slowly(shape, &input);
            let mut fast = std::array::from_fn(|_| Field::zeros(cells));
            let mut convolution = TensorConvolution::new(kernel(shape), cells);
            convolution.apply(input.each_ref().map(Some), fast.each_mut().map(Some));
            fast.iter().zip(&slow).for_each(|(fast, slow)| assert_close(fast, slow));
        }
    }

    #[test]
    fn in_single_precision_it_is_the_same_but_for_rounding_whatever_the_unit() {
        let (shape, cells) = ([9, 8], [5, 4]);
        let input = fields(cells);
        for unit in [1.0, 1e-30, 1e30] {
            let kernel = TensorKernel::from_values(shape, |i, j| {
                value(shape, [i as isize, j as isize]).map(|v| unit * v)
            });
            for whole in [true, false] {
                let along_z = if whole { input[2].clone() } else { Field::zeros(cells) };
                let slow = slowly(shape, &[input[0].clone(), input[1].clone(), along_z]);
                let mut fast = std::array::from_fn(|_| Array2::<f32>::zeros(cells));
                let mut convolution = TensorConvolution::new(Arc::new(kernel.to_single()), cells);
                let single = input.each_ref().map(|field| field.mapv(|v| v as f32));
                let [x, y, z] = fast.each_mut().map(Some);
                let given = [Some(&single[0]), Some(&single[1]), whole.then_some(&single[2])];
                convolution.apply(given, [x, y, z.filter(|_| whole)]);
                for (fast, slow) in fast.iter().zip(&slow).take(if whole { 3 } else { 2 }) {
                    let largest = slow.iter().fold(0.0f64, |m, v| m.max(v.abs()));
                    let off = |(a, b): (&f32, &f64)| (f64::from(*a) / unit - b).abs();
                    let error = fast.iter().zip(slow).map(off).fold(0.0f64, f64::max);
                    assert!(error < 1e-6 * largest, "{unit:e}: {error:e}");
                }
            }
        }
    }

    #[test]
    fn what_is_not_given_is_zero_and_what_is_not_asked_for_is_left_alone() {
        let (shape, cells) = ([8, 9], [4, 5]);
        let input = fields(cells);
        let zero = Field::zeros(cells);
        for coupled in [true, false] {
            let kernel = TensorKernel::from_values(shape, |i, j| {
                let mut at = value(shape, [i as isize, j as isize]);
                if !coupled {
                    at[3..5].fill(0.0);
                }
                at
            });
            let mut convolution = TensorConvolution::new(Arc::new(kernel), cells);
            for given in 0..8 {
                let given = [0, 1, 2].map(|n| given >> n & 1 == 1);
                let padded = std::array::from_fn(|n| if given[n] { &input[n] } else { &zero });
                let mut whole = std::array::from_fn(|_| Field::zeros(cells));
                convolution.apply(padded.map(Some), whole.each_mut().map(Some));
                for asked in 0..8 {
                    let mut part: [Field; 3] = std::array::from_fn(|_| Field::from_elem(cells, 9.0));
                    let mut n = 0;
                    let output = part.each_mut().map(|field| {
                        n += 1;
                        (asked >> (n - 1) & 1 == 1).then_some(field)
                    });
                    convolution.apply(std::array::from_fn(|n| given[n].then_some(&input[n])), output);
                    for n in 0..3 {
                        match asked >> n & 1 {
                            1 => assert_close(&part[n], &whole[n]),
                            _ => assert!(part[n].iter().all(|v| *v == 9.0)),
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn values_and_their_transforms_make_the_same_tensor() {
        for shape in [[6, 4], [5, 7]] {
            let from_values = kernel(shape);
            let cells = (shape[0] * shape[1]) as f64;
            let again = TensorKernel::from_transforms(shape, |kx, ky| {
                from_values.spectra.each_ref().map(|spectrum| spectrum[[ky, kx]] * from_values.unit * cells)
            });
            for (a, b) in again.spectra.iter().zip(&*from_values.spectra) {
                assert_close(a, b);
            }
        }
    }
}
