//! Spatial parameters of ISO 25178-2.

use std::f64::consts::{PI, TAU};

use super::row::family;
use crate::{Correlation, Spectrum, Topography, Window};
use asperity_base::units::Metre;

/// Level of the autocorrelation for Sal and Str: the default of ISO 25178-3.
const DECAY: f64 = 0.2;

/// Number of directions of the angular spectrum for Std, half a degree apart.
const DIRECTIONS: usize = 360;

family! {
    /// Spatial parameters of ISO 25178-2:2021, 4.3, with heights relative to their mean.
    ///
    /// No filter is applied: level and filter first. An undefined parameter is NaN.
    SpatialParameters: "spatial" {
        /// Autocorrelation length, of the fastest decay to 0.2.
        ///
        /// By [`Correlation`], with lags up to half the topography, and undefined samples left out. NaN if it
        /// does not decay to this level in any direction.
        sal: Length as "Sal",
        /// Texture aspect ratio, the fastest decay over the slowest; 1 if isotropic.
        ///
        /// NaN if the autocorrelation stays above 0.2 up to half the topography in some direction: the lay is
        /// then too long to be measured.
        str: Number as "Str",
        /// Texture direction, of the largest angular spectrum, from the x axis towards the y axis.
        ///
        /// 0 ≤ Std < π, to half a degree, by [`Spectrum::angular`] with Hann's window. It is the direction of
        /// the wave vectors. The lay is at right angles to it, so that 0 means grooves along y. It is
        /// meaningless for an isotropic surface, whose Str is near 1. NaN if all heights are equal, and for a
        /// single line of samples.
        std: Angle as "Std",
        /// Dominant spatial wavelength, of the largest amplitude in the Fourier transform.
        ///
        /// By the spectrum with Hann's window, interpolated between its wave numbers as for a single sinusoid
        /// (Grandke, IEEE Trans. Instrum. Meas. 32, 350, 1983). NaN if all heights are equal.
        ssw: Length as "Ssw",
    }
}

impl SpatialParameters {
    /// Computes the spatial parameters of `topography`.
    pub fn new(topography: &Topography) -> Self {
        let [fastest, slowest] = Correlation::new(topography).decay_lengths(DECAY);
        let spectrum = Spectrum::new(topography, Window::Hann);
        let several = topography.grid().shape.iter().all(|n| *n > 1);
        Self {
            sal: fastest,
            str: fastest / slowest,
            std: if several { direction(&spectrum) } else { f64::NAN },
            ssw: dominant_wavelength(&spectrum),
        }
    }
}

/// Returns the direction of the wave vectors with the highest power, in radians.
fn direction(spectrum: &Spectrum) -> f64 {
    let angular = spectrum.angular(DIRECTIONS);
    let highest =
        (0..DIRECTIONS).filter(|k| angular[*k] > 0.0).max_by(|a, b| angular[*a].total_cmp(&angular[*b]));
    highest.map_or(f64::NAN, |k| k as f64 * PI / DIRECTIONS as f64)
}

/// Returns the wavelength of the highest density of a spectrum with Hann's window.
fn dominant_wavelength(spectrum: &Spectrum) -> Metre {
    let highest = spectrum
        .density()
        .indexed_iter()
        .filter(|(at, density)| *at != (0, 0) && **density > 0.0)
        .max_by(|a, b| a.1.total_cmp(b.1));
    let Some(((k, l), _)) = highest else { return f64::NAN };
    let (at, step) = (spectrum.wave_vector([k, l]), spectrum.wave_vector([1, 1]));
    let q = [0, 1].map(|axis| at[axis] + offset(spectrum, [k, l], axis) * step[axis]);
    TAU / q[0].hypot(q[1])
}

/// Returns the distance of a sinusoid's wave number from that of the highest entry along `axis`, in steps, −½
/// to ½.
///
/// With Hann's window its amplitude at the larger neighbour is (1 + δ)/(2 − δ) of the highest.
fn offset(spectrum: &Spectrum, highest: [usize; 2], axis: usize) -> f64 {
    let at = |step: isize| {
        let mut wave = highest.map(|index| index as isize);
        wave[axis] += step;
        spectrum.density_at(wave)
    };
    let (before, after) = (at(-1), at(1));
    let ratio = (before.max(after) / at(0)).sqrt();
    let distance = ((2.0 * ratio - 1.0) / (1.0 + ratio)).clamp(0.0, 0.5);
    if before > after { -distance } else { distance }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;
    use crate::{Autocorrelation, Form};
    use asperity_base::grid::{Field, Grid};

    fn wave(shape: [usize; 2], pitch: [f64; 2], q: [f64; 2]) -> Topography {
        let grid = Grid::new(shape, pitch).unwrap();
        let heights = Field::from_shape_fn(shape, |(ix, iy)| {
            2.0 + (q[0] * grid.centre(0, ix) + q[1] * grid.centre(1, iy) + 0.3).cos()
        });
        Topography::new(grid, heights).unwrap()
    }

    #[test]
    fn an_exponential_surface_decays_as_it_was_made() {
        // R = 10^(−√((x/βx)² + (y/βy)²)): Sal = βx log 5 if βx is the shorter, Str = βx/βy.
        let (beta, shape) = ([8.0, 16.0], [512, 512]);
        let method = Autocorrelation::new(1.0, beta);
        let grid = Grid::new(shape, [1.0; 2]).unwrap();
        let seeds = 4;
        let (mut sal, mut aspect) = (0.0, 0.0);
        for seed in 0..seeds {
            let parameters = SpatialParameters::new(&method.generate(&grid, seed).unwrap());
            sal += parameters.sal / seeds as f64;
            aspect += parameters.str / seeds as f64;
        }
        // R scatters by 1/√spots, and by its mean, which is set to 0. Its slope at 0.2 is 0.2 ln 5 per decay
        // length.
        let spots = 512.0 * 512.0 / (TAU * beta[0] * beta[1] / 4.605f64.powi(2));
        let error = (4.0 / (seeds as f64 * spots).sqrt() + 2.0 / spots) / (0.2 * 5f64.ln());
        assert_relative_eq!(sal, 8.0 * 5f64.log10(), max_relative = error);
        assert_relative_eq!(aspect, 0.5, max_relative = 2f64.sqrt() * error);
    }

    #[test]
    fn holes_change_them_by_their_scatter_only() {
        let method = Autocorrelation::new(1.0, [16.0, 16.0]);
        let whole = method.generate(&Grid::new([256, 256], [1.0; 2]).unwrap(), 3).unwrap();
        let mut holed = whole.clone();
        let heights = holed.heights_mut().iter_mut().enumerate();
        heights
            .filter(|(n, _)| (n.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40).is_multiple_of(5))
            .for_each(|(_, z)| *z = f64::NAN);
        let (whole, holed) = (SpatialParameters::new(&whole), SpatialParameters::new(&holed));
        // R differs by the scatter of the missing pairs, √(2 · 0.36/0.64/n), over its slope.
        let error = 4.0 * (2.0 * 0.36 / 0.64 / 65536.0f64).sqrt() / (0.2 * 5f64.ln());
        assert_relative_eq!(holed.sal, whole.sal, max_relative = error);
        assert_relative_eq!(holed.str, whole.str, max_relative = 2.0 * error);
    }

    #[test]
    fn a_turned_and_scaled_wave_keeps_its_wavelength_and_shows_its_direction() {
        for degrees in [0.0f64, 20.0, 75.0, 90.0, 133.0, 170.0] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let wavelength = 7.3;
            let q = TAU / wavelength;
            let found = SpatialParameters::new(&wave([200, 150], [0.5, 1.0], [q * cos, q * sin]));
            let distance = (found.std.to_degrees() - degrees + 90.0).rem_euclid(180.0) - 90.0;
            // Half a step of the directions, and half a step 2π/L of the wave number over q.
            let step = 0.5 * (TAU / 100.0 / q).to_degrees();
            assert!(distance.abs() <= 0.25 + step, "{}°, not {degrees}°", found.std.to_degrees());
            // Grandke's formula neglects the wave −q: (qL/2π)⁻² of a step, here and 1/14 of a wave number.
            assert_relative_eq!(found.ssw, wavelength, max_relative = (wavelength / 100.0f64).powi(2));
        }
    }

    #[test]
    fn grooves_longer_than_the_map_have_no_aspect_ratio() {
        let found = SpatialParameters::new(&wave([200, 150], [0.5, 1.0], [TAU / 10.0, 0.0]));
        // R = cos(2πx/λ)/2 reaches 0.2 of R(0) at λ arccos(0.2)/2π. The error of its estimate is the fraction
        // of a wave at the ends, λ/πL.
        assert_relative_eq!(found.sal, 10.0 * 0.2f64.acos() / TAU, max_relative = 10.0 / (TAU / 2.0 * 100.0));
        assert!(found.str.is_nan());
        assert_eq!(found.std, 0.0);
    }

    #[test]
    fn what_has_no_meaning_is_not_a_number() {
        let grid = Grid::new([16, 16], [1.0; 2]).unwrap();
        let level = Topography::new(grid, Field::from_elem([16, 16], 0.1)).unwrap();
        let nothing = Topography::new(grid, Field::from_elem([16, 16], f64::NAN)).unwrap();
        for topography in [Form::Flat.on(&grid).unwrap(), level, nothing] {
            let SpatialParameters { sal, str, std, ssw } = SpatialParameters::new(&topography);
            assert!([sal, str, std, ssw].iter().all(|value| value.is_nan()), "{sal} {str} {std} {ssw}");
        }
        let line = SpatialParameters::new(&wave([200, 1], [0.5, 1.0], [TAU / 10.0, 0.0]));
        assert!(line.sal > 0.0 && line.str.is_nan() && line.std.is_nan());
        assert_relative_eq!(line.ssw, 10.0, max_relative = 0.01);
    }

    #[test]
    fn json_carries_the_names_of_the_standard() {
        let json =
            serde_json::to_value(SpatialParameters::new(&wave([32, 32], [1.0; 2], [0.5, 0.7]))).unwrap();
        assert!(["Sal", "Str", "Std", "Ssw"].iter().all(|name| json.get(name).is_some()), "{json}");
    }
}
