//! Radial spectrum: the mean over all directions.

use std::f64::consts::TAU;

use rayon::prelude::*;

use super::{SpectralPoint, Spectrum};
use asperity_base::grid::Grid;

/// Grouping of wave numbers for a mean over all directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bins {
    /// Rings of equal width, 2π over the longer side of the topography (for a line, over its length).
    Linear,
    /// Rings of equal ratio, with a given number per decade, at least one.
    Logarithmic {
        /// Rings per decade.
        per_decade: u32,
    },
}

/// Rows of waves whose places are found at a time.
const ROWS: usize = 256;

impl Spectrum {
    /// Computes the mean over all directions, C^iso(q) = (1/2π) ∫ C(q cos φ, q sin φ) dφ, m⁴, up to
    /// [`Spectrum::nyquist`].
    ///
    /// It is the mean of C over the wave vectors in each ring, at the geometric mean of their wave numbers.
    /// Empty rings and q = 0 are omitted. For a single line it is the spectrum along it. Jacobs, Junge &
    /// Pastewka (2017), as for [`Spectrum`].
    pub fn radial(&self, bins: Bins) -> Vec<SpectralPoint> {
        let Grid { shape, .. } = self.grid;
        let several = (0..2).filter(|&axis| shape[axis] > 1);
        let step = TAU / several.map(|axis| self.grid.extent()[axis]).fold(0.0, f64::max);
        // A wave at the limit counts, whatever the round-off.
        let limit = self.nyquist() * (1.0 + 1e-9);
        let ring = |logarithm: f64| match bins {
            Bins::Linear => (logarithm.exp() / step).round(),
            Bins::Logarithmic { per_decade } => {
                ((logarithm - step.ln()) * std::f64::consts::LOG10_E * f64::from(per_decade.max(1))).round()
            }
        };
        let mut rings = vec![[0.0; 3]; 1 + ring(limit.ln()).max(0.0) as usize];
        let along_y: Vec<_> = (0..self.density.ncols()).map(|l| self.wave_vector([0, l])[1]).collect();
        // Ring and logarithm of each wave of a row that counts.
        let row = |k: usize| -> Vec<Option<(usize, f64)>> {
            let qx = self.wave_vector([k, 0])[0];
            let place = |qy: &f64| {
                let q = qx.hypot(*qy);
                let logarithm = q.ln();
                (q != 0.0 && q <= limit).then(|| (ring(logarithm) as usize, logarithm))
            };
            along_y.iter().map(place).collect()
        };
        let rows: Vec<usize> = (0..self.density.nrows()).collect();
        for some in rows.chunks(ROWS) {
            let places: Vec<_> = some.par_iter().map(|k| row(*k)).collect();
            for (k, places) in some.iter().zip(places) {
                for (l, place) in places.into_iter().enumerate() {
                    let Some((ring, logarithm)) = place else { continue };
                    let (signs, sums) = (self.signs(l), &mut rings[ring]);
                    let density = self.density[[*k, l]];
                    *sums = [sums[0] + signs * logarithm, sums[1] + signs * density, sums[2] + signs];
                }
            }
        }
        let point = |[logarithm, density, waves]: &[f64; 3]| SpectralPoint {
            wave_number: (logarithm / waves).exp(),
            density: density / waves,
            waves: *waves as usize,
        };
        rings.iter().filter(|[_, _, waves]| *waves > 0.0).map(point).collect()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use approx::assert_relative_eq;

    use super::super::{Window, tests::noise};
    use super::*;
    use crate::{Amplitude, Axis, SelfAffine};

    #[test]
    fn a_self_affine_surface_follows_its_law_from_the_roll_off_to_the_shortest_wave() {
        let grid = Grid::new([512, 256], [1.0, 1.0]).unwrap();
        let (rolloff, shortest) = (64.0, 4.0);
        let (hurst, amplitude) = (0.7, Amplitude::Sq(1.0));
        let law = SelfAffine { hurst, rolloff: Some(rolloff), shortest: Some(shortest), amplitude };
        let spectrum = Spectrum::new(&law.generate(&grid, 5).unwrap(), Window::None);
        let flat = spectrum.density()[[1, 0]];
        for (bins, width) in
            [(Bins::Logarithmic { per_decade: 20 }, 10f64.ln() / 20.0), (Bins::Linear, TAU / 512.0)]
        {
            for point in spectrum.radial(bins) {
                let (q, corner, end) = (point.wave_number, TAU / rolloff, TAU / shortest);
                let spread = if bins == Bins::Linear { width / q } else { width };
                if (q / corner).ln().abs() < spread || (q / end).ln().abs() < spread {
                    continue;
                }
                let expected =
                    if q > end { 0.0 } else { flat * (q / corner).max(1.0).powf(-2.0 - 2.0 * hurst) };
                // The arithmetic mean of a power p over a ring exceeds its value at the geometric mean by
                // p²σ²/2, σ² ≤ spread²/4 for the logarithm.
                let tolerance = 3.4f64.powi(2) * spread * spread / 8.0;
                assert_relative_eq!(
                    point.density,
                    expected,
                    max_relative = tolerance,
                    epsilon = 1e-12 * flat
                );
            }
        }
    }

    #[test]
    fn every_wave_in_the_circle_counts_once() {
        let spectrum = Spectrum::new(&noise([40, 33], [1.0, 1.0], 1), Window::None);
        let whole: usize = spectrum.radial(Bins::Linear).iter().map(|point| point.waves).sum();
        let logarithmic = spectrum.radial(Bins::Logarithmic { per_decade: 10 });
        assert_eq!(whole, logarithmic.iter().map(|point| point.waves).sum::<usize>());
        let mut inside = 0.0;
        spectrum.for_each_wave(|[qx, qy], _, signs| {
            inside += if (1e-9..PI + 1e-9).contains(&qx.hypot(qy)) { signs } else { 0.0 }
        });
        assert_eq!(whole as f64, inside);
        assert!(logarithmic.windows(2).all(|pair| pair[0].wave_number < pair[1].wave_number));
    }

    #[test]
    fn the_mean_over_the_directions_of_a_line_is_the_spectrum_along_it() {
        let spectrum = Spectrum::new(&noise([64, 1], [0.5, 3.0], 2), Window::None);
        let along = spectrum.along(Axis::X);
        for (radial, along) in spectrum.radial(Bins::Linear).iter().zip(&along[1..]) {
            assert_relative_eq!(radial.wave_number, along.wave_number, max_relative = 1e-12);
            // C is per width of the line, here one cell.
            assert_relative_eq!(radial.density / 3.0, along.density, max_relative = 1e-12);
        }
        assert!(Spectrum::new(&noise([1, 1], [0.5, 3.0], 2), Window::None).radial(Bins::Linear).is_empty());
    }
}
