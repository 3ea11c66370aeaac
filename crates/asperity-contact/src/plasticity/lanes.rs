//! Four numbers processed in parallel.

use std::ops::{Add, Mul, Neg, Sub};

use asperity_transforms::num_complex::Complex64;

/// Amplitudes of the wave vectors (q_x, q_y) and (−q_x, q_y): real part, imaginary part, real part, imaginary
/// part. Functions of |q| alone act on all four.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Lanes([f64; 4]);

impl Lanes {
    #[inline(always)]
    pub(super) fn new(plus: Complex64, minus: Complex64) -> Self {
        Self([plus.re, plus.im, minus.re, minus.im])
    }

    #[inline(always)]
    pub(super) fn plus(self) -> Complex64 {
        Complex64::new(self.0[0], self.0[1])
    }

    #[inline(always)]
    pub(super) fn minus(self) -> Complex64 {
        Complex64::new(self.0[2], self.0[3])
    }

    /// Multiplies by i.
    #[inline(always)]
    pub(super) fn times_i(self) -> Self {
        let [a, b, c, d] = self.0;
        Self([-b, a, -d, c])
    }

    /// A factor that changes its sign with q_x.
    #[inline(always)]
    pub(super) fn odd(factor: f64) -> Self {
        Self([factor, factor, -factor, -factor])
    }

    /// Mean of both amplitudes, for waves that are the same.
    #[inline(always)]
    pub(super) fn mean(self) -> Complex64 {
        0.5 * (self.plus() + self.minus())
    }
}

impl Add for Lanes {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        Self([a + e, b + f, c + g, d + h])
    }
}

impl Sub for Lanes {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        Self([a - e, b - f, c - g, d - h])
    }
}

impl Neg for Lanes {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        let [a, b, c, d] = self.0;
        Self([-a, -b, -c, -d])
    }
}

impl Mul for Lanes {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        Self([a * e, b * f, c * g, d * h])
    }
}

impl Mul<Lanes> for f64 {
    type Output = Lanes;

    #[inline(always)]
    fn mul(self, lanes: Lanes) -> Lanes {
        let [a, b, c, d] = lanes.0;
        Lanes([self * a, self * b, self * c, self * d])
    }
}
