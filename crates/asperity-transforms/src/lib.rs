//! Plans of Fourier transforms for numbers in single and double precision.
//!
//! The planners of `rustfft` and `realfft` are generic, so every crate that calls them compiles all their
//! transforms again. This crate compiles them once for `f32` and once for `f64`. The library `asperity` uses
//! trait objects and compiles none of them.

use std::sync::Arc;

pub use realfft::{ComplexToReal, RealToComplex};
pub use rustfft::{Fft, num_complex, num_traits};

/// A type of real numbers for which transforms can be planned.
///
/// All transforms are unnormalised.
pub trait Precision: rustfft::FftNum {
    /// Plans the transform of `length` complex numbers, ẑ\[k\] = Σ z\[j\] exp(−2πi jk/length).
    fn plan_forward(length: usize) -> Arc<dyn Fft<Self>>;

    /// Plans the inverse of [`Precision::plan_forward`], times `length`.
    fn plan_inverse(length: usize) -> Arc<dyn Fft<Self>>;

    /// Plans the transform of `length` real numbers to the complex ones for k = 0 … length/2.
    fn plan_real_forward(length: usize) -> Arc<dyn RealToComplex<Self>>;

    /// Plans the inverse of [`Precision::plan_real_forward`], times `length`.
    fn plan_real_inverse(length: usize) -> Arc<dyn ComplexToReal<Self>>;
}

macro_rules! precision {
    ($($number:ty),*) => {$(
        impl Precision for $number {
            #[inline(never)]
            fn plan_forward(length: usize) -> Arc<dyn Fft<Self>> {
                rustfft::FftPlanner::new().plan_fft_forward(length)
            }

            #[inline(never)]
            fn plan_inverse(length: usize) -> Arc<dyn Fft<Self>> {
                rustfft::FftPlanner::new().plan_fft_inverse(length)
            }

            #[inline(never)]
            fn plan_real_forward(length: usize) -> Arc<dyn RealToComplex<Self>> {
                realfft::RealFftPlanner::new().plan_fft_forward(length)
            }

            #[inline(never)]
            fn plan_real_inverse(length: usize) -> Arc<dyn ComplexToReal<Self>> {
                realfft::RealFftPlanner::new().plan_fft_inverse(length)
            }
        }
    )*};
}

precision!(f32, f64);
