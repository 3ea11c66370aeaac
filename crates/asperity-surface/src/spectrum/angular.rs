//! Angular spectrum: the power by direction.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::Spectrum;
use asperity_base::units::SquareMetre;

impl Spectrum {
    /// Angular spectrum: variance per radian as a function of the direction of the wave vector, m²,
    ///
    /// f(θ) = 2 ∫ C(q cos θ, q sin θ) q dq/(2π)²,  0 < q ≤ [`Spectrum::nyquist`]
    ///
    /// (the 2 for q and −q), at `directions` directions, at least one, θ = kπ/`directions` from the x axis
    /// towards the y axis, each as the mean over its sector. The sum times π/`directions` is the variance of
    /// the waves in the circle. The lay is at right angles to the wave vector. This is the angular spectrum
    /// of ISO 25178-2, apart from the factor.
    ///
    /// Short wave vectors of a grid lie in few directions. Each represents its cell in the plane of wave
    /// vectors, and its power is distributed over the directions of the cell, so that white noise is nearly
    /// isotropic.
    pub fn angular(&self, directions: usize) -> Vec<SquareMetre> {
        let directions = directions.max(1);
        let sector = PI / directions as f64;
        let [lx, ly] = self.grid.extent();
        let cell = TAU / (lx * ly).sqrt();
        let limit = self.nyquist() * (1.0 + 1e-9);
        let mut power = vec![0.0; directions];
        self.for_each_wave(|[qx, qy], density, signs| {
            let q = qx.hypot(qy);
            if q == 0.0 || q > limit {
                return;
            }
            let (angle, half_width) = (qy.atan2(qx), (cell / q).min(FRAC_PI_2));
            let first = ((angle - half_width) / sector).round() as isize;
            let last = ((angle + half_width) / sector).round() as isize;
            let below = |edge: f64| tent_below((edge - angle) / half_width);
            for k in first..=last {
                let share = below((k as f64 + 0.5) * sector) - below((k as f64 - 0.5) * sector);
                power[k.rem_euclid(directions as isize) as usize] += signs * density * share;
            }
        });
        let scale = 1.0 / (self.grid.area() * sector);
        power.iter().map(|power| power * scale).collect()
    }
}

/// Part of the area below `s` of a triangle function over −1 … 1 with area 1.
fn tent_below(s: f64) -> f64 {
    let s = s.clamp(-1.0, 1.0);
    if s < 0.0 { 0.5 * (1.0 + s).powi(2) } else { 1.0 - 0.5 * (1.0 - s).powi(2) }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::super::{Window, tests::noise};
    use super::*;
    use crate::Topography;
    use asperity_base::grid::{Field, Grid};

    #[test]
    fn a_plane_wave_has_the_direction_of_its_wave_vector() {
        let grid = Grid::new([128, 96], [0.5, 1.0]).unwrap();
        let [lx, ly] = grid.extent();
        for (k, l) in [(8, 0), (0, 8), (9, 7), (-9, 7), (-20, 3)] {
            let q = [TAU * f64::from(k) / lx, TAU * f64::from(l) / ly];
            let heights = Field::from_shape_fn(grid.shape, |(ix, iy)| {
                (q[0] * grid.centre(0, ix) + q[1] * grid.centre(1, iy)).cos()
            });
            let spectrum = Spectrum::new(&Topography::new(grid, heights).unwrap(), Window::None);
            let angular = spectrum.angular(180);
            let highest = (0..180).max_by(|&a, &b| angular[a].total_cmp(&angular[b])).unwrap();
            let direction = q[1].atan2(q[0]).to_degrees().rem_euclid(180.0);
            let distance = (highest as f64 - direction + 90.0).rem_euclid(180.0) - 90.0;
            assert!(distance.abs() <= 0.5, "({k}, {l}): {highest}°, not {direction}°");
            assert_relative_eq!(angular.iter().sum::<f64>() * PI / 180.0, 0.5, max_relative = 1e-12);
        }
    }

    #[test]
    fn white_noise_has_no_direction() {
        let spectrum = Spectrum::new(&noise([256, 256], [1.0; 2], 1), Window::None);
        let angular = spectrum.angular(36);
        // The circle contains π/4 of the waves. A sector averages 256² π/4/72 of the pairs ±q, each with a
        // relative scatter of 1; the waves across its edges reduce it slightly.
        let expected = 0.25;
        let error = (72.0 / (256.0 * 256.0 * PI / 4.0f64)).sqrt();
        for (k, power) in angular.iter().enumerate() {
            assert_relative_eq!(*power, expected, max_relative = 4.0 * error);
            assert!(power.is_finite(), "{k}");
        }
    }
}
