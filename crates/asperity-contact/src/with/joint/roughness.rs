//! The roughness of the gap without load, on which theories are based.

use std::f64::consts::FRAC_PI_2;

use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::reference::rough::greenwood_williamson_pressure;
use crate::surface::{Correlation, GreenwoodWilliamson, SpectralMoments, Topography};
use crate::units::{Metre, Pascal};

/// Moments of the gap of two surfaces that repeat along both axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GapRoughness {
    /// Gap of the mean planes at which the surfaces first touch.
    pub first_touch_gap: Metre,
    /// Spectral moments; m₄ is the mean over all directions, from the Laplacian.
    pub moments: SpectralMoments,
    /// Shorter of the lags along x and y at which the autocorrelation falls below 0.2: infinite where it does not fall so
    /// far, 0 of flat surfaces. Of self-affine surfaces it is about a third of the roll-off wavelength.
    pub correlation_length: Metre,
}

/// Autocorrelation at the correlation length.
const UNCORRELATED: f64 = 0.2;

impl GapRoughness {
    /// Computes the moments of an undeformed `gap` by differences between neighbouring cells.
    ///
    /// # Errors
    /// The errors of [`Topography::new`].
    pub fn new(grid: &Grid, gap: &Field) -> Result<Self> {
        let topography = Topography::new(*grid, gap.clone())?;
        let ([nx, ny], [dx, dy]) = (grid.shape, grid.pitch);
        let (mut slope, mut curvature) = ([0.0; 2], 0.0);
        for ((i, j), here) in gap.indexed_iter() {
            let along_x = [gap[((i + nx - 1) % nx, j)], gap[((i + 1) % nx, j)]];
            let along_y = [gap[(i, (j + ny - 1) % ny)], gap[(i, (j + 1) % ny)]];
            let bend =
                |[before, after]: [f64; 2], pitch: f64| (before - 2.0 * here + after) / (pitch * pitch);
            slope[0] += ((along_x[1] - here) / dx).powi(2);
            slope[1] += ((along_y[1] - here) / dy).powi(2);
            curvature += (bend(along_x, dx) + bend(along_y, dy)).powi(2);
        }
        let cells = gap.len() as f64;
        // ⟨(∇²z)²⟩ = (8/3) m₄ of an isotropic surface.
        let m4 = 0.375 * curvature / cells;
        let correlation = Correlation::periodic(&topography);
        let m0 = correlation.variance();
        let falls =
            |angle: f64| Some(correlation.decay_length(angle, UNCORRELATED)).filter(|lag| lag.is_finite());
        let lengths = [0.0, FRAC_PI_2].into_iter().filter_map(falls);
        Ok(Self {
            first_touch_gap: topography.mean() - gap.iter().copied().fold(f64::INFINITY, f64::min),
            moments: SpectralMoments { m0, m2: slope.map(|square| square / cells), m4: [m4; 2] },
            correlation_length: if m0 > 0.0 { lengths.fold(f64::INFINITY, f64::min) } else { 0.0 },
        })
    }

    /// Rms height σ.
    pub fn rms_height(&self) -> Metre {
        self.moments.m0.sqrt()
    }

    /// Rms slope, of |∇z|.
    pub fn rms_slope(&self) -> f64 {
        (2.0 * self.moments.mean_m2()).sqrt()
    }

    /// Nayak's parameter; `None` of flat surfaces.
    pub fn nayak(&self) -> Option<f64> {
        Some(self.moments.bandwidth()).filter(|nayak| nayak.is_finite())
    }

    /// The peaks in the sense of Greenwood and Williamson; `None` of flat surfaces, and of a spectrum that has no peaks in
    /// this sense, α ≤ 0.8968.
    pub fn peaks(&self) -> Option<GreenwoodWilliamson> {
        let peaks = self.moments.greenwood_williamson();
        let GreenwoodWilliamson { density, radius, height_deviation, .. } = peaks;
        let are_known =
            [density, radius, height_deviation].iter().all(|value| *value > 0.0 && value.is_finite());
        are_known.then_some(peaks)
    }

    /// Mean pressure by Greenwood and Williamson at a mean `gap` of the surfaces; `None` without [`Self::peaks`].
    pub fn pressure(&self, modulus: Pascal, gap: Metre) -> Option<Pascal> {
        let GreenwoodWilliamson { density, radius, height_deviation, mean_height } = self.peaks()?;
        Some(greenwood_williamson_pressure(density, radius, height_deviation, modulus, gap - mean_height))
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use approx::assert_relative_eq;

    use super::*;

    /// A wave along each axis: m₀ = A²/2, and each profile sees half of both slopes and 3/8 of both curvatures.
    #[test]
    fn two_waves_have_their_moments() {
        let grid = Grid::new([240, 160], [1e-6, 1.5e-6]).unwrap();
        let (amplitude, q) = (2e-8, TAU / 60e-6);
        let gap = Field::from_shape_fn(grid.shape, |(i, j)| {
            5e-7 - amplitude * ((q * i as f64 * 1e-6).cos() + (q * j as f64 * 1.5e-6).cos())
        });
        let found = GapRoughness::new(&grid, &gap).unwrap();
        let square = amplitude * amplitude;
        assert_relative_eq!(found.first_touch_gap, 2.0 * amplitude, max_relative = 1e-12);
        assert_relative_eq!(found.moments.m0, square, max_relative = 1e-12);
        assert_relative_eq!(found.moments.mean_m2(), 0.5 * square * q * q, max_relative = 4e-3);
        assert_relative_eq!(found.moments.mean_m4(), 0.375 * square * q.powi(4), max_relative = 8e-3);
        // cos q = ⅕ on one of two waves of equal height: ½ (1 + cos q) = 0.2 at 143°.
        assert!((found.correlation_length / 60e-6 - 0.352).abs() < 0.02, "{}", found.correlation_length);
        let flat = GapRoughness::new(&grid, &grid.zeros()).unwrap();
        assert_eq!((flat.nayak(), flat.peaks()), (None, None));
    }

    #[test]
    fn greenwood_and_williamson_have_peaks_above_the_mean_plane() {
        let moments = SpectralMoments { m0: 1e-14, m2: [4.5e-4; 2], m4: [5e7; 2] };
        let rough = GapRoughness { first_touch_gap: 4e-7, moments, correlation_length: 0.0 };
        assert_relative_eq!(rough.nayak().unwrap(), 2.469_135_8, max_relative = 1e-6);
        let [one, next] = [2.0, 2.1].map(|gap| rough.pressure(115e9, gap * 1e-7).unwrap());
        assert!(one > 1e5 && one < 1e8 && next < one, "{one:e} {next:e}");
        // Twice the modulus bears twice as much.
        assert_relative_eq!(rough.pressure(230e9, 2e-7).unwrap(), 2.0 * one, max_relative = 1e-12);
        let none = GapRoughness { moments: SpectralMoments { m4: [1e6; 2], ..moments }, ..rough };
        assert_eq!(none.pressure(115e9, 2e-7), None);
    }
}
