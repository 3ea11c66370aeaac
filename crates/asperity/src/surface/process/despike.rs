//! Removal of spikes.

use std::ops::Range;

use rayon::prelude::*;

use super::median::median;
use crate::error::{Result, check};
use crate::grid::Field;
use crate::surface::Topography;

/// Samples to each side of the one judged: 5 × 5 in all.
const REACH: usize = 2;

impl Topography {
    /// With the spikes undefined: the samples that deviate from the median of the 5 × 5 samples around by more than
    /// `factor` standard deviations, both those of the samples around and those of all such deviations; 5 to 10 is usual.
    ///
    /// The standard deviations are robust ones, 1.4826 times the median of the absolute deviations, which spikes do not
    /// widen: around a sample Hampel's identifier (Davies & Gather, J. Am. Stat. Assoc. 88, 782 (1993)), which spares
    /// a rough part of a smooth surface. Of the whole topography it is 1.2533 times their mean where the median is 0
    /// because more than half of the samples do not deviate (Iglewicz & Hoaglin, How to Detect and Handle Outliers,
    /// 1993). Only defined samples count. Towards a rim the neighbourhood of the median shrinks so that it stays
    /// symmetric: no plane has spikes.
    ///
    /// # Errors
    /// [`crate::Error::OutOfRange`] unless the factor is above 0.
    pub fn despike(mut self, factor: f64) -> Result<Self> {
        check("despike", factor, factor > 0.0 && factor.is_finite(), "a number above 0 such as 6")?;
        let deviations = deviations(self.heights());
        let mut sizes: Vec<f64> = deviations.iter().filter(|d| !d.is_nan()).map(|d| d.abs()).collect();
        if sizes.is_empty() {
            return Ok(self);
        }
        let sigma = match SIGMA * median(&mut sizes) {
            0.0 => 1.2533 * sizes.iter().sum::<f64>() / sizes.len() as f64,
            sigma => sigma,
        };
        let z = self.heights();
        let is_spike = |((ix, iy), deviation): &((usize, usize), &f64)| {
            deviation.abs() > factor * sigma && {
                let clipped = |i: usize, n: usize| i.saturating_sub(REACH)..(i + REACH + 1).min(n);
                let mut around = Vec::new();
                defined(z, clipped(*ix, z.nrows()), clipped(*iy, z.ncols()), &mut around);
                let middle = median(&mut around);
                around.iter_mut().for_each(|z| *z = (*z - middle).abs());
                deviation.abs() > factor * SIGMA * median(&mut around)
            }
        };
        let spikes: Vec<_> = deviations.indexed_iter().filter(is_spike).map(|(at, _)| at).collect();
        spikes.into_iter().for_each(|at| self.heights_mut()[at] = f64::NAN);
        Ok(self)
    }
}

/// Standard deviation of Gaussian heights over the median of their absolute deviations.
const SIGMA: f64 = 1.4826;

/// Height of each sample above the median of its neighbourhood, which shrinks towards a rim so that it stays symmetric.
fn deviations(z: &Field) -> Field {
    let mut deviations = z.clone();
    let rows = deviations.as_slice_mut().expect("fields are in standard layout").par_chunks_mut(z.ncols());
    let symmetric = |i: usize, n: usize| {
        let reach = REACH.min(i).min(n - 1 - i);
        i - reach..i + reach + 1
    };
    rows.enumerate().for_each(|(ix, row)| {
        let mut around = Vec::with_capacity((2 * REACH + 1).pow(2));
        for (iy, deviation) in row.iter_mut().enumerate().filter(|(_, z)| !z.is_nan()) {
            defined(z, symmetric(ix, z.nrows()), symmetric(iy, z.ncols()), &mut around);
            *deviation -= median(&mut around);
        }
    });
    deviations
}

/// The defined heights of a part.
fn defined(z: &Field, xs: Range<usize>, ys: Range<usize>, heights: &mut Vec<f64>) {
    heights.clear();
    for ix in xs {
        heights.extend(ys.clone().map(|iy| z[[ix, iy]]).filter(|z| !z.is_nan()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;

    fn with_heights(height: impl Fn(usize, usize) -> f64) -> Topography {
        let grid = Grid::new([60, 50], [1.0, 1.0]).unwrap();
        Topography::new(grid, Field::from_shape_fn(grid.shape, |(i, j)| height(i, j))).unwrap()
    }

    /// Tilted, with waves of amplitude 1.
    fn rough(i: usize, j: usize) -> f64 {
        0.4 * i as f64 - 0.1 * j as f64 + (0.9 * i as f64).sin() * (1.1 * j as f64).cos()
    }

    fn undefined(topography: &Topography) -> Vec<(usize, usize)> {
        topography.heights().indexed_iter().filter(|(_, z)| z.is_nan()).map(|(at, _)| at).collect()
    }

    #[test]
    fn spikes_become_undefined_and_nothing_else_does() {
        let spikes = [(0, 17), (12, 49), (30, 20), (30, 21), (31, 20), (45, 8)];
        let height = |i, j| rough(i, j) + if spikes.contains(&(i, j)) { 15.0 } else { 0.0 };
        let cleared = with_heights(height).despike(6.0).unwrap();
        assert_eq!(undefined(&cleared), spikes);
        let pits = with_heights(|i, j| -height(i, j)).despike(6.0).unwrap();
        assert_eq!(undefined(&pits), spikes);
        assert_eq!(with_heights(rough).despike(6.0).unwrap().undefined(), 0);
    }

    #[test]
    fn a_spike_on_a_flat_is_found_although_the_median_deviation_is_nought() {
        let flat = with_heights(|i, j| if (i, j) == (7, 9) { 1e-9 } else { 0.0 });
        assert_eq!(undefined(&flat.despike(10.0).unwrap()), [(7, 9)]);
        // Steps of the last digit are no spikes.
        let quantised = with_heights(|i, j| if (7 * i + 3 * j * j) % 10 == 0 { 1.0 } else { 0.0 });
        assert_eq!(quantised.despike(10.0).unwrap().undefined(), 0);
    }

    #[test]
    fn a_plane_has_no_spikes_and_holes_stay() {
        let mut plane = with_heights(|i, j| 2.0 * i as f64 - 3.0 * j as f64);
        assert_eq!(plane.clone().despike(1e-6).unwrap().undefined(), 0);
        plane.heights_mut().column_mut(4).fill(f64::NAN);
        plane.heights_mut()[[30, 30]] = 1e3;
        assert_eq!(plane.despike(10.0).unwrap().undefined(), 61);
        assert!(with_heights(rough).despike(0.0).is_err());
    }

    #[test]
    fn a_rough_part_of_a_smooth_surface_is_no_spike() {
        let wave = |i: usize, j: usize| (1.7 * i as f64).sin() + (2.3 * j as f64).cos();
        let streak = |i: usize| 1.0 + 99.0 * (-((i as f64 - 25.0) / 8.0).powi(2)).exp();
        let streaked = with_heights(|i, j| streak(i) * wave(i, j));
        let mut with_spike = streaked.clone();
        with_spike.heights_mut()[[25, 25]] += 4e4;
        assert_eq!(undefined(&with_spike.despike(8.0).unwrap()), [(25, 25)]);
        assert_eq!(streaked.despike(8.0).unwrap().undefined(), 0);
    }
}
