//! Taper towards the boundary.

use std::f64::consts::PI;

use crate::Topography;
use asperity_base::error::{Result, check_in};
use asperity_base::units::{Dimension, Metre};

impl Topography {
    /// Tapers the topography to its mean height over `width` along each side, so that it can be repeated, or
    /// ends without a step. The result is z̄ + w(x) w(y) (z − z̄), with w = sin²(πd/2·width) at the distance
    /// d < width from the outermost sample and 1 beyond (Tukey's window; Harris, Proc. IEEE 66, 51 (1978),
    /// eq. 38). The mean is over the defined samples. A direction with a single sample is not tapered.
    ///
    /// # Errors
    /// [`asperity_base::Error::OutOfRange`] unless the width is above 0 and at most half of the topography.
    pub fn taper(mut self, width: Metre) -> Result<Self> {
        let grid = *self.grid();
        let good = |axis: usize| grid.shape[axis] == 1 || width <= 0.5 * grid.extent()[axis];
        let expected = "a length above 0, at most half of the topography";
        check_in(
            Dimension::Length,
            "taper",
            width,
            width > 0.0 && width.is_finite() && (0..2).all(good),
            expected,
        )?;
        let weight = |axis: usize, index: usize| {
            let last = grid.shape[axis] - 1;
            let distance = index.min(last - index) as f64 * grid.pitch[axis];
            if last == 0 || distance >= width { 1.0 } else { (0.5 * PI * distance / width).sin().powi(2) }
        };
        let [along_x, along_y] =
            [0, 1].map(|axis| (0..grid.shape[axis]).map(|i| weight(axis, i)).collect::<Vec<_>>());
        let mean = self.mean();
        for ((ix, iy), z) in self.heights_mut().indexed_iter_mut() {
            let weight = along_x[ix] * along_y[iy];
            if weight < 1.0 {
                *z = mean + weight * (*z - mean);
            }
        }
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_base::grid::{Field, Grid};

    fn bumpy(shape: [usize; 2]) -> Topography {
        let grid = Grid::new(shape, [1.0, 2.0]).unwrap();
        let heights = Field::from_shape_fn(shape, |(i, j)| 3.0 + ((7 * i + 3 * j * j) % 11) as f64);
        Topography::new(grid, heights).unwrap()
    }

    #[test]
    fn the_rim_lies_at_the_mean_and_the_middle_where_it_was() {
        let (before, after) = (bumpy([40, 30]), bumpy([40, 30]).taper(8.0).unwrap());
        for ((i, j), z) in after.heights().indexed_iter() {
            let inside = |n: usize, index: usize, pitch: f64| index.min(n - 1 - index) as f64 * pitch >= 8.0;
            if [0, 39].contains(&i) || [0, 29].contains(&j) {
                assert_eq!(*z, before.mean());
            } else if inside(40, i, 1.0) && inside(30, j, 2.0) {
                assert_eq!(*z, before.heights()[[i, j]]);
            }
        }
        // In the middle of the taper half of the height remains.
        let half = before.mean() + 0.5 * (before.heights()[[4, 15]] - before.mean());
        assert!((after.heights()[[4, 15]] - half).abs() < 1e-14);
    }

    #[test]
    fn a_profile_is_tapered_at_its_ends_and_a_taper_that_meets_itself_is_refused() {
        let profile = bumpy([40, 1]).taper(8.0).unwrap();
        assert_eq!(profile.heights()[[0, 0]], bumpy([40, 1]).mean());
        assert_eq!(profile.heights()[[20, 0]], bumpy([40, 1]).heights()[[20, 0]]);
        for width in [0.0, 20.1, f64::NAN] {
            assert!(bumpy([40, 30]).taper(width).is_err());
        }
    }
}
