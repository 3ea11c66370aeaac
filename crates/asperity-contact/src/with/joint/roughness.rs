//! The roughness of the gap without load, on which theories are based.

use crate::grid::{Field, Grid};
use crate::reference::rough::{GreenwoodWilliamson, SpectralMoments};
use crate::units::Metre;

/// Moments of the gap of two surfaces that repeat along both axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GapRoughness {
    /// Gap of the mean planes at which the surfaces first touch.
    pub first_touch_gap: Metre,
    /// Spectral moments along a profile, the means over all directions.
    pub moments: SpectralMoments,
    /// Shorter of the lags along x and y at which the autocorrelation falls to 0.2; 0 of flat surfaces. Of self-affine
    /// surfaces it is about a third of the roll-off wavelength.
    pub correlation_length: Metre,
}

/// Autocorrelation at the correlation length.
const UNCORRELATED: f64 = 0.2;

impl GapRoughness {
    /// Computes the moments of an undeformed `gap` by differences between neighbouring cells.
    ///
    /// # Panics
    /// If the gap has another shape than the grid.
    pub fn new(grid: &Grid, gap: &Field) -> Self {
        let [nx, ny] = grid.shape;
        assert_eq!(gap.dim(), (nx, ny), "shape of the gap");
        let cells = gap.len() as f64;
        let mean = gap.sum() / cells;
        let least = gap.iter().copied().fold(f64::INFINITY, f64::min);
        let (mut height, mut slope, mut curvature) = (0.0, 0.0, 0.0);
        let [dx, dy] = grid.pitch;
        for ((i, j), here) in gap.indexed_iter() {
            let along_x = [gap[((i + nx - 1) % nx, j)], gap[((i + 1) % nx, j)]];
            let along_y = [gap[(i, (j + ny - 1) % ny)], gap[(i, (j + 1) % ny)]];
            let bend =
                |[before, after]: [f64; 2], pitch: f64| (before - 2.0 * here + after) / (pitch * pitch);
            height += (here - mean) * (here - mean);
            slope += ((along_x[1] - here) / dx).powi(2) + ((along_y[1] - here) / dy).powi(2);
            curvature += (bend(along_x, dx) + bend(along_y, dy)).powi(2);
        }
        // ⟨|∇z|²⟩ = 2 m₂ and ⟨(∇²z)²⟩ = (8/3) m₄ of an isotropic surface.
        let moments = SpectralMoments {
            height: height / cells,
            slope: 0.5 * slope / cells,
            curvature: 0.375 * curvature / cells,
        };
        let correlation_length = correlation_length(grid, gap, mean, moments.height);
        Self { first_touch_gap: mean - least, moments, correlation_length }
    }

    /// Rms height σ.
    pub fn rms_height(&self) -> Metre {
        self.moments.height.sqrt()
    }

    /// Rms slope, of |∇z|.
    pub fn rms_slope(&self) -> f64 {
        (2.0 * self.moments.slope).sqrt()
    }

    /// Nayak's parameter; `None` of flat surfaces.
    pub fn nayak(&self) -> Option<f64> {
        Some(self.moments.nayak()).filter(|nayak| nayak.is_finite())
    }

    /// The peaks in the sense of Greenwood and Williamson.
    pub fn peaks(&self) -> Option<GreenwoodWilliamson> {
        GreenwoodWilliamson::from_moments(&self.moments)
    }
}

fn correlation_length(grid: &Grid, gap: &Field, mean: f64, square: f64) -> Metre {
    let [nx, ny] = grid.shape;
    let falls = |axis: usize| {
        let product = |lag: usize| {
            let other = |i: usize, j: usize| {
                if axis == 0 { gap[((i + lag) % nx, j)] } else { gap[(i, (j + lag) % ny)] }
            };
            gap.indexed_iter().map(|((i, j), here)| (here - mean) * (other(i, j) - mean)).sum::<f64>()
        };
        let enough = UNCORRELATED * square * gap.len() as f64;
        let lags = 1..=grid.shape[axis] / 2;
        lags.into_iter().find(|lag| product(*lag) < enough).map(|lag| lag as f64 * grid.pitch[axis])
    };
    if square > 0.0 { [0, 1].into_iter().filter_map(falls).fold(f64::INFINITY, f64::min) } else { 0.0 }
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
        let found = GapRoughness::new(&grid, &gap);
        let square = amplitude * amplitude;
        assert_relative_eq!(found.first_touch_gap, 2.0 * amplitude, max_relative = 1e-12);
        assert_relative_eq!(found.moments.height, square, max_relative = 1e-12);
        assert_relative_eq!(found.moments.slope, 0.5 * square * q * q, max_relative = 4e-3);
        assert_relative_eq!(found.moments.curvature, 0.375 * square * q.powi(4), max_relative = 8e-3);
        // cos q = ⅕ on one of two waves of equal height: ½ (1 + cos q) = 0.2 at 143°.
        assert!((found.correlation_length / 60e-6 - 0.352).abs() < 0.02, "{}", found.correlation_length);
        let flat = GapRoughness::new(&grid, &grid.zeros());
        assert_eq!((flat.nayak(), flat.peaks()), (None, None));
    }
}
