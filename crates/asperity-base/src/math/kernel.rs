//! Even kernels of cyclic convolutions, in Fourier space.

use std::sync::Arc;

use asperity_transforms::Precision;
use asperity_transforms::num_complex::Complex;

use super::plans::{Plans, real};
use crate::grid::Field;

/// A cyclic kernel that is even along both axes, in Fourier space, with the plans of its size, for transforms
/// in the precision of `T`.
pub struct Kernel<T> {
    /// The plans of its size.
    pub plans: Plans<T>,
    /// The real and even spectrum over its largest value: `[ky, kx]` for `ky ≤ My/2`, or for the ky of one
    /// rank, and `kx ≤ Mx/2`. Kernels of both precisions share it.
    pub spectrum: Arc<Field>,
    /// The largest of the spectrum, divided by Mx My.
    pub unit: f64,
}

impl Kernel<f64> {
    /// Creates the kernel with the transform `spectrum[[ky, kx]]` at the bins `(kx, ky)` of the `plans`, for
    /// `ky ≤ My/2`, `kx ≤ Mx/2`.
    pub fn new(plans: Plans<f64>, spectrum: Field) -> Self {
        let largest = largest(&spectrum);
        Self::scaled(plans, spectrum, largest)
    }

    /// Creates the kernel of [`Kernel::new`] on a cyclic grid of `shape`.
    ///
    /// # Panics
    /// If the spectrum has another shape.
    pub fn from_spectrum(shape: [usize; 2], spectrum: Field) -> Self {
        assert_eq!(spectrum.dim(), (shape[1] / 2 + 1, shape[0] / 2 + 1), "shape of the spectrum");
        Self::new(Plans::new(shape), spectrum)
    }

    /// Creates the kernel with this `spectrum`, or part of a spectrum, and its `largest` magnitude.
    pub fn scaled(plans: Plans<f64>, mut spectrum: Field, largest: f64) -> Self {
        if largest > 0.0 {
            spectrum /= largest;
        }
        let unit = largest / (plans.shape[0] * plans.shape[1]) as f64;
        Self { plans, spectrum: Arc::new(spectrum), unit }
    }

    /// Returns the kernel for transforms in single precision.
    pub fn to_single(&self) -> Kernel<f32> {
        Kernel { plans: Plans::new(self.plans.shape), spectrum: Arc::clone(&self.spectrum), unit: self.unit }
    }
}

/// Returns the largest magnitude in a spectrum.
pub fn largest(spectrum: &Field) -> f64 {
    spectrum.iter().fold(0.0, |largest, s| s.abs().max(largest))
}

/// Multiplies the transform of a column by the transform of an even kernel, whose first half is `spectrum`.
#[inline]
pub fn multiply<T: Precision>(column: &mut [Complex<T>], spectrum: &[f64]) {
    let (front, back) = column.split_at_mut(column.len() / 2 + 1);
    front.iter_mut().zip(spectrum).for_each(|(v, k)| *v = v.scale(real(*k)));
    back.iter_mut().rev().zip(&spectrum[1..]).for_each(|(v, k)| *v = v.scale(real(*k)));
}
