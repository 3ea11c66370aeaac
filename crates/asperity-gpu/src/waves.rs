//! The waves of a rough surface: random numbers from a counter, so that each wave is known alone, on any
//! grid.

use std::f64::consts::{PI, TAU};

use crate::problem::Rough;

/// Spectrum and seed of a surface, in the order of the structure `Waves` of the kernels.
#[derive(Clone, Copy)]
#[repr(C)]
pub(crate) struct Waves {
    /// Wavenumber of the first wave along x and y.
    pub(crate) first: f64,
    /// Wavenumber of the longest wave of the power law.
    pub(crate) longest: f64,
    /// Wavenumber of the shortest wave.
    pub(crate) shortest: f64,
    /// Exponent of the amplitude over the wavenumber.
    pub(crate) power: f64,
    /// Seed.
    pub(crate) seed: u64,
}

impl Waves {
    pub(crate) fn from_rough(rough: &Rough) -> Self {
        Self {
            first: TAU / (rough.side as f64 * rough.pitch),
            longest: TAU / rough.longest,
            // A wave of exactly the shortest length is one of them.
            shortest: TAU / rough.shortest * (1.0 + 1e-12),
            power: -1.0 - rough.hurst,
            seed: rough.seed,
        }
    }

    /// Returns the amplitude of the wave with `k` periods along x and `l` ≥ 0 along y, without the factor of
    /// the slope: real and imaginary part. One of a pair of waves with opposite signs is drawn.
    pub(crate) fn amplitude(&self, k: i64, l: i64) -> [f64; 2] {
        let q = self.first * ((k * k + l * l) as f64).sqrt();
        if q == 0.0 || q > self.shortest {
            return [0.0; 2];
        }
        let sign = if l == 0 && k < 0 { -1 } else { 1 };
        let at = mixed(mixed(self.seed) ^ ((((sign * k + (1 << 31)) as u64) << 32) | l as u64));
        let (u, v) =
            (((at >> 11) as f64 + 0.5) / (1u64 << 53) as f64, (mixed(at) >> 11) as f64 / (1u64 << 53) as f64);
        let size = (-2.0 * u.ln()).sqrt() * q.max(self.longest).powf(self.power);
        [size * (2.0 * PI * v).cos(), sign as f64 * size * (2.0 * PI * v).sin()]
    }
}

/// Returns a number from the bits of another, by the finaliser of splitmix64.
fn mixed(x: u64) -> u64 {
    let x = x.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ (x >> 31)
}
