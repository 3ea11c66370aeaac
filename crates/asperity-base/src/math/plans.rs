//! Plans of the transforms of one grid.

use std::sync::Arc;

use asperity_transforms::num_complex::Complex;
use asperity_transforms::num_traits::Zero;
use asperity_transforms::{ComplexToReal, Fft, Precision, RealToComplex};
use ndarray::{ArrayView1, ArrayViewMut1};

use super::fft::SHARE;

/// The plans of a cyclic grid, for transforms in the precision of `T`.
pub struct Plans<T> {
    /// Cells along x and y.
    pub shape: [usize; 2],
    /// From a row of real numbers to its half spectrum.
    pub along_y: Arc<dyn RealToComplex<T>>,
    /// The inverse of [`along_y`](Self::along_y), times its length.
    pub back_y: Arc<dyn ComplexToReal<T>>,
    /// The transform of a column.
    pub along_x: Arc<dyn Fft<T>>,
    /// The inverse of [`along_x`](Self::along_x), times its length.
    pub back_x: Arc<dyn Fft<T>>,
}

impl<T: Precision> Plans<T> {
    /// Creates the plans of a grid of `shape`.
    #[inline]
    pub fn new(shape: [usize; 2]) -> Self {
        let [mx, my] = shape;
        Self {
            shape,
            along_y: T::plan_real_forward(my),
            back_y: T::plan_real_inverse(my),
            along_x: T::plan_forward(mx),
            back_x: T::plan_inverse(mx),
        }
    }

    /// Number of frequencies along y.
    #[inline]
    pub fn half(&self) -> usize {
        self.shape[1] / 2 + 1
    }

    /// Smallest number of rows per thread.
    #[inline]
    pub fn rows_at_once(&self) -> usize {
        SHARE.div_ceil(self.shape[1])
    }

    /// Creates scratch memory for any of the plans.
    #[inline]
    pub fn scratch(&self) -> Vec<Complex<T>> {
        let lengths = [
            self.along_y.get_scratch_len(),
            self.back_y.get_scratch_len(),
            self.along_x.get_inplace_scratch_len(),
            self.back_x.get_inplace_scratch_len(),
        ];
        vec![Complex::zero(); lengths.into_iter().max().unwrap_or(0)]
    }

    /// Transforms a zero-padded row into `half`; `row` and `scratch` are scratch memory.
    #[inline]
    pub fn row_forward(
        &self,
        values: ArrayView1<'_, T>,
        half: &mut [Complex<T>],
        row: &mut [T],
        scratch: &mut [Complex<T>],
    ) {
        if values.fold(true, |zero, p| zero & p.is_zero()) {
            half.fill(Complex::zero());
            return;
        }
        let (front, rest) = row.split_at_mut(values.len());
        ArrayViewMut1::from(front).assign(&values);
        rest.fill(T::zero());
        self.along_y.process_with_scratch(row, half, scratch).expect("lengths of the plan");
    }

    /// Transforms `half` back into the first values of its row, multiplied by `unit`; `row` and `scratch` are
    /// scratch memory.
    pub fn row_back(
        &self,
        half: &mut [Complex<T>],
        unit: T,
        mut values: ArrayViewMut1<'_, T>,
        row: &mut [T],
        scratch: &mut [Complex<T>],
    ) {
        let my = self.shape[1];
        // A real field has real spectra at zero and, for even lengths, at the Nyquist frequency.
        half[0].im = T::zero();
        if my.is_multiple_of(2) {
            half[my / 2].im = T::zero();
        }
        self.back_y.process_with_scratch(half, row, scratch).expect("lengths of the plan");
        let front = ArrayView1::from(&row[..values.len()]);
        values.zip_mut_with(&front, |u, r| *u = *r * unit);
    }
}

/// Returns the number in the precision of `T`.
#[inline]
pub fn real<T: Precision>(value: f64) -> T {
    T::from_f64(value).expect("a real number")
}
