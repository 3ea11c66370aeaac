//! Spectral moments, and the asperities predicted from them by the theory of random surfaces.

use std::f64::consts::PI;

use ndarray::Axis;
use serde::Serialize;

use crate::{GreenwoodWilliamson, Spectrum, Topography};
use asperity_base::grid::Grid;
use asperity_base::units::SquareMetre;

/// Spectral moments: the variances of heights, slopes and curvatures, the latter two along x and y,
///
/// m₀ = ⟨z²⟩,  m₂ = ⟨(∂z/∂x)²⟩ = ∫ qx² C d²q/(2π)²,  m₄ = ⟨(∂²z/∂x²)²⟩ = ∫ qx⁴ C d²q/(2π)²
///
/// Longuet-Higgins, Phil. Trans. R. Soc. A 249, 321 (1957); Nayak, J. Lubr. Technol. 93, 398 (1971). m₂ and
/// m₄ depend mainly on the shortest waves. For a self-affine surface they depend on the cut-off, which may be
/// that of the grid.
///
/// With the spectrum ([`Spectrum::moments`]) the derivatives are exact up to the shortest wave resolved by
/// the grid. With differences ([`SpectralMoments::by_differences`]) they are those between neighbouring
/// samples, which reduce short waves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SpectralMoments {
    /// Variance of the heights, m².
    pub m0: SquareMetre,
    /// Variance of the slope along x and along y.
    pub m2: [f64; 2],
    /// Variance of the curvature along x and along y, 1/m².
    pub m4: [f64; 2],
}

impl Spectrum {
    /// Computes the spectral moments as integrals over the spectrum.
    ///
    /// A window smears each wave over its neighbours: Hann's adds (2π/L)² m₀/3 to m₂, with L the length along
    /// the axis.
    pub fn moments(&self) -> SpectralMoments {
        let along = |power: i32| [0, 1].map(|axis| self.sum(|q: [f64; 2]| q[axis].powi(power)));
        SpectralMoments { m0: self.variance(), m2: along(2), m4: along(4) }
    }
}

impl SpectralMoments {
    /// Computes the spectral moments by differences between samples, as for profiles:
    ///
    /// m₂ = ⟨((z₊₁ − z)/Δx)²⟩,  m₄ = ⟨((z₊₁ − 2z + z₋₁)/Δx²)²⟩
    ///
    /// over all places with defined samples, with heights relative to their mean. A wave counts with qⁿ
    /// sincⁿ(qΔx/2) in place of qⁿ: at ten samples per wave m₂ is 3 % and m₄ 6 % too small. A single sample
    /// along a direction has zero slope and curvature there. Without defined neighbours they are NaN. McCool,
    /// J. Tribol. 109, 264 (1987).
    pub fn by_differences(topography: &Topography) -> Self {
        let Grid { shape, pitch } = *topography.grid();
        let mean = topography.mean();
        let heights = topography.heights();
        let along = |order: usize| {
            [0, 1].map(|axis| match shape[axis] {
                1 => 0.0,
                n if n <= order => f64::NAN,
                n => {
                    let samples =
                        |first: usize| heights.slice_axis(Axis(axis), (first..n - order + first).into());
                    let (first, second, last) = (samples(0), samples(1), samples(order));
                    let pairs = first.iter().zip(&last);
                    let square = match order {
                        1 => mean_square(pairs.map(|(a, b)| b - a)),
                        _ => mean_square(pairs.zip(&second).map(|((a, c), b)| a - 2.0 * b + c)),
                    };
                    square / pitch[axis].powi(2 * order as i32)
                }
            })
        };
        Self { m0: mean_square(heights.iter().map(|z| z - mean)), m2: along(1), m4: along(2) }
    }

    /// m₂ of an isotropic surface, as the mean over x and y: half the mean square gradient.
    pub fn mean_m2(&self) -> f64 {
        0.5 * (self.m2[0] + self.m2[1])
    }

    /// m₄ of an isotropic surface, as the mean over x and y, 1/m².
    pub fn mean_m4(&self) -> f64 {
        0.5 * (self.m4[0] + self.m4[1])
    }

    /// Nayak's bandwidth parameter α = m₀m₄/m₂², from the means over x and y: 3/2 for an isotropic surface
    /// with a single wavelength, unbounded for a broad spectrum. Nayak (1971).
    pub fn bandwidth(&self) -> f64 {
        self.m0 * self.mean_m4() / self.mean_m2().powi(2)
    }

    /// Returns the asperities of an isotropic Gaussian surface with these moments (means over x and y):
    ///
    /// η = m₄/(6π√3 m₂),  R = 3√π/(8√m₄),  σs² = (1 − 0.8968/α) m₀,  z̄s = 4 √(m₀/πα)
    ///
    /// Nayak (1971) for η; Bush, Gibson & Keogh, Mech. Res. Commun. 3, 169 (1976) and McCool, J. Tribol. 109,
    /// 264 (1987) for the rest. σs is NaN for α < 0.8968, which no isotropic surface has.
    pub fn greenwood_williamson(&self) -> GreenwoodWilliamson {
        let (m0, m2, m4) = (self.m0, self.mean_m2(), self.mean_m4());
        let bandwidth = self.bandwidth();
        GreenwoodWilliamson {
            density: m4 / (6.0 * PI * 3f64.sqrt() * m2),
            radius: 3.0 * PI.sqrt() / (8.0 * m4.sqrt()),
            height_deviation: ((1.0 - 0.8968 / bandwidth) * m0).sqrt(),
            mean_height: 4.0 * (m0 / (PI * bandwidth)).sqrt(),
        }
    }
}

/// Mean square of the values that are not NaN.
pub(super) fn mean_square(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values
        .filter(|value| !value.is_nan())
        .fold((0.0, 0usize), |(sum, n), value| (sum + value * value, n + 1));
    sum / count as f64
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use approx::assert_relative_eq;

    use super::*;
    use crate::{Amplitude, Form, LowPass, SelfAffine, Window};
    use asperity_base::grid::Field;

    #[test]
    fn those_of_a_sinusoid_are_half_its_squared_amplitude_times_powers_of_q() {
        let grid = Grid::new([40, 60], [0.5, 1.0]).unwrap();
        let z = Form::Sinusoid { amplitude: 2.0, wavelength: [5.0, f64::INFINITY] }.on(&grid).unwrap();
        let moments = Spectrum::new(&z, Window::None).moments();
        let q = TAU / 5.0;
        assert_relative_eq!(moments.m0, 2.0, max_relative = 1e-12);
        assert_relative_eq!(moments.m2[0], 2.0 * q.powi(2), max_relative = 1e-12);
        assert_relative_eq!(moments.m4[0], 2.0 * q.powi(4), max_relative = 1e-12);
        assert!(moments.m2[1] < 1e-20 && moments.m4[1] < 1e-20);
    }

    #[test]
    fn differences_soften_a_wave_by_the_cardinal_sine() {
        // 41 samples have 40 first differences, 42 have 40 second differences: whole waves of 10 samples.
        let wave = |n: usize| {
            let grid = Grid::new([n, 3], [0.5, 1.0]).unwrap();
            Form::Sinusoid { amplitude: 2.0, wavelength: [5.0, f64::INFINITY] }.on(&grid).unwrap()
        };
        let (q, half) = (TAU / 5.0, TAU / 20.0f64);
        let sinc = half.sin() / half;
        let first = SpectralMoments::by_differences(&wave(41)).m2[0];
        assert_relative_eq!(first, 2.0 * (q * sinc).powi(2), max_relative = 1e-12);
        let second = SpectralMoments::by_differences(&wave(42)).m4[0];
        assert_relative_eq!(second, 2.0 * (q * sinc).powi(4), max_relative = 1e-12);
        assert_relative_eq!(SpectralMoments::by_differences(&wave(40)).m0, 2.0, max_relative = 1e-12);
    }

    #[test]
    fn differences_pass_holes_by() {
        let grid = Grid::new([9, 7], [0.5, 0.25]).unwrap();
        let mut heights = Field::from_shape_fn(grid.shape, |(ix, iy)| {
            let (x, y) = (grid.centre(0, ix), grid.centre(1, iy));
            1.5 * x * x + 4.0 * y
        });
        heights[[4, 3]] = f64::NAN;
        let moments = SpectralMoments::by_differences(&Topography::new(grid, heights).unwrap());
        assert_relative_eq!(moments.m4[0], 9.0, max_relative = 1e-12);
        assert_relative_eq!(moments.m2[1], 16.0, max_relative = 1e-12);
        assert!(moments.m4[1] < 1e-20);
        let pair = Topography::new(Grid::new([2, 1], [1.0; 2]).unwrap(), Field::zeros([2, 1])).unwrap();
        let moments = SpectralMoments::by_differences(&pair);
        assert!(moments.m4[0].is_nan() && moments.m4[1] == 0.0 && moments.m2[0] == 0.0);
    }

    #[test]
    fn the_slope_of_a_self_affine_surface_is_the_one_it_was_made_with() {
        let grid = Grid::new([96, 64], [1.0, 0.5]).unwrap();
        let amplitude = Amplitude::Sdq(0.3);
        let law = SelfAffine { hurst: 0.8, rolloff: None, shortest: None, amplitude };
        let moments = Spectrum::new(&law.generate(&grid, 1).unwrap(), Window::None).moments();
        assert_relative_eq!(2.0 * moments.mean_m2(), 0.09, max_relative = 1e-12);
    }

    #[test]
    fn a_disc_of_waves_has_a_bandwidth_of_two() {
        // C constant up to q_c: ⟨qx²⟩ = q_c²/4 and ⟨qx⁴⟩ = q_c⁴/8. Of the π (L/λ)² waves half are
        // independent, and the relative scatter of each moment is less than twice that of its power. Hann's
        // window leaves 1 in (35/18)² of them.
        let grid = Grid::new([256, 256], [1.0; 2]).unwrap();
        let heights = LowPass::new(1.0, [8.0; 2]).generate(&grid, 3).unwrap();
        let moments = Spectrum::new(&heights, Window::Hann).moments();
        let q = TAU / 8.0;
        let error = 35.0 / 18.0 * (2.0 / (PI * (256.0f64 / 8.0).powi(2))).sqrt();
        let smeared = q.powi(2) / 4.0 + (TAU / 256.0).powi(2) / 3.0;
        assert_relative_eq!(moments.mean_m2() / moments.m0, smeared, max_relative = 4.0 * error);
        assert_relative_eq!(moments.mean_m4() / moments.m0, q.powi(4) / 8.0, max_relative = 4.0 * error);
        assert_relative_eq!(moments.bandwidth(), 2.0, max_relative = 4.0 * error);
    }
}
