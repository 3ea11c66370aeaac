//! Resampling of a topography to another grid.

use super::{Fill, spline};
use crate::Topography;
use asperity_base::choice::choice;
use asperity_base::error::{Error, Result};
use asperity_base::grid::{Field, Grid};
use asperity_base::units::{Dimension, Metre};
use ndarray::{Axis, Zip};

/// Interpolation between samples to smaller cells.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// Linear interpolation: heights stay within the range of the samples, and short waves are flattened.
    /// Second order in the pitch.
    #[default]
    Linear,
    /// Cubic spline through all samples: smooth, of fourth order, with overshoot at steps.
    Spline,
}

choice!(Interpolation: "linear" => Linear, "spline" => Spline);

impl Topography {
    /// Resamples to `shape` cells on the same extent.
    ///
    /// Each direction is treated separately. To larger cells, a new height is the average over the new cell.
    /// Within a partly covered old cell, the height varies linearly with the slope between its neighbours.
    /// For a whole ratio this is the plain average of the old cells; for any ratio it preserves the mean
    /// height and planes. A wave of length Λ is reduced to sin(πp/Λ)/(πp/Λ) at the new pitch p. Waves shorter
    /// than two new cells are therefore aliased by at most 2/π; [`Topography::s_filter`] removes the rest. To
    /// smaller cells, heights are interpolated between the centres of the old cells, and constant beyond the
    /// outermost ones. A height that uses an undefined sample, or lies beside one, is undefined; a spline
    /// bridges it by the nearest defined one.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if a number of cells is 0.
    pub fn resample_to_shape(&self, shape: [usize; 2], interpolation: Interpolation) -> Result<Self> {
        self.on_grid(grid_of_shape(self.grid(), shape)?, interpolation)
    }

    /// Resamples to cells of size `pitch`, as many as fit into the extent from its corner. The remainder at
    /// the far edges, less than a cell, is cut off. The method is that of [`Topography::resample_to_shape`].
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if a pitch is not positive, or longer than the topography.
    pub fn resample_to_pitch(&self, pitch: [Metre; 2], interpolation: Interpolation) -> Result<Self> {
        self.on_grid(grid_of_pitch(self.grid(), pitch)?, interpolation)
    }

    fn on_grid(&self, grid: Grid, interpolation: Interpolation) -> Result<Self> {
        let along = |field: &Field, axis| match interpolation {
            Interpolation::Linear => resampled(field, axis, self.grid(), &grid),
            Interpolation::Spline => resampled_by_spline(field, axis, self.grid(), &grid),
        };
        let [x, y] = [Axis(0), Axis(1)];
        if interpolation == Interpolation::Linear || self.undefined() == 0 || self.defined() == 0 {
            return Self::new(grid, along(&along(self.heights(), y), x));
        }
        let bridged = self.clone().fill(Fill::Nearest)?;
        let linear = self.on_grid(grid, Interpolation::Linear)?;
        let mut heights = along(&along(bridged.heights(), y), x);
        Zip::from(&mut heights).and(linear.heights()).for_each(|z, linear| {
            if linear.is_nan() {
                *z = f64::NAN;
            }
        });
        Self::new(grid, heights)
    }
}

/// Returns the grid with the extent of `old` and `shape` cells.
pub(super) fn grid_of_shape(old: &Grid, shape: [usize; 2]) -> Result<Grid> {
    if shape.contains(&0) {
        let expected = "at least one cell along x and y".into();
        return Err(Error::OutOfRange { quantity: "resample", dimension: None, value: 0.0, expected });
    }
    let extent = old.extent();
    Grid::new(shape, [extent[0] / shape[0] as f64, extent[1] / shape[1] as f64])
}

/// Returns the grid with as many cells of size `pitch` as fit into the extent of `old`.
pub(super) fn grid_of_pitch(old: &Grid, pitch: [Metre; 2]) -> Result<Grid> {
    let extent = old.extent();
    let mut shape = [0; 2];
    for axis in 0..2 {
        // A whole number of cells must not lose one to round-off.
        shape[axis] = (extent[axis] / pitch[axis] * (1.0 + 1e-9)) as usize;
        if !(pitch[axis] > 0.0 && pitch[axis].is_finite() && shape[axis] > 0) {
            return Err(Error::OutOfRange {
                quantity: "pitch",
                dimension: Some(Dimension::Length),
                value: pitch[axis],
                expected: "a positive length, at most that of the topography".into(),
            });
        }
    }
    Grid::new(shape, pitch)
}

/// Resamples `field` to the cells of `new` along `axis`.
fn resampled(field: &Field, axis: Axis, old: &Grid, new: &Grid) -> Field {
    let Axis(a) = axis;
    let mut shape = [field.nrows(), field.ncols()];
    shape[a] = new.shape[a];
    let mut result = Field::zeros(shape);
    for (index, mut line) in result.axis_iter_mut(axis).enumerate() {
        for (from, weight) in weights(index, new.pitch[a] / old.pitch[a], old.shape[a]) {
            Zip::from(&mut line).and(field.index_axis(axis, from)).for_each(|z, old| *z += weight * old);
        }
    }
    result
}

/// [`resampled`], but by a spline to smaller cells.
fn resampled_by_spline(field: &Field, axis: Axis, old: &Grid, new: &Grid) -> Field {
    let Axis(a) = axis;
    let ratio = new.pitch[a] / old.pitch[a];
    if ratio > 1.0 - CRUMB {
        return resampled(field, axis, old, new);
    }
    let slopes = spline::slopes(field, axis);
    let mut shape = [field.nrows(), field.ncols()];
    shape[a] = new.shape[a];
    let mut result = Field::zeros(shape);
    for (index, mut line) in result.axis_iter_mut(axis).enumerate() {
        let (below, share) = between(index, ratio, old.shape[a]);
        let above = (below + 1).min(old.shape[a] - 1);
        let terms = [(field, below), (field, above), (&slopes, below), (&slopes, above)];
        for (weight, (from, at)) in spline::hermite(share).into_iter().zip(terms) {
            line.scaled_add(weight, &from.index_axis(axis, at));
        }
    }
    result
}

/// Returns the sample, of `n`, at or below the centre of new cell `index`, and the fraction of the distance
/// to the next one.
fn between(index: usize, ratio: f64, n: usize) -> (usize, f64) {
    let centre = ((index as f64 + 0.5) * ratio - 0.5).clamp(0.0, n as f64 - 1.0);
    let below = (centre as usize).min(n.saturating_sub(2));
    (below, centre - below as f64)
}

/// Fraction of a cell below which it is round-off.
const CRUMB: f64 = 1e-9;

/// Returns the samples, of `n`, used for new cell `index`, and their weights, which sum to 1; `ratio` is the
/// new pitch over the old one.
fn weights(index: usize, ratio: f64, n: usize) -> Vec<(usize, f64)> {
    let mut drawn: Vec<(usize, f64)> = Vec::new();
    let mut draw = |sample: usize, weight: f64| match drawn.iter_mut().find(|(i, _)| *i == sample) {
        Some((_, sum)) => *sum += weight,
        None => drawn.push((sample, weight)),
    };
    if ratio > 1.0 + CRUMB {
        let (start, end) = (index as f64 * ratio, (index as f64 + 1.0) * ratio);
        for i in start as usize..(end.ceil() as usize).min(n) {
            let (from, to) = (start.max(i as f64), end.min(i as f64 + 1.0));
            let (before, after) = (i.saturating_sub(1), (i + 1).min(n - 1));
            // Distance from the centre of the old cell to that of the shared part, over the distance of the
            // samples used for the slope.
            let lever = (0.5 * (from + to) - i as f64 - 0.5) / ((after - before).max(1)) as f64;
            draw(i, to - from);
            draw(after, (to - from) * lever);
            draw(before, (from - to) * lever);
        }
    } else {
        let (below, share) = between(index, ratio, n);
        draw(below, 1.0 - share);
        draw(below + 1, share);
    }
    drawn.retain(|(_, weight)| weight.abs() > CRUMB);
    let sum: f64 = drawn.iter().map(|(_, weight)| weight).sum();
    drawn.iter().map(|&(i, weight)| (i, weight / sum)).collect()
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    fn bumpy(shape: [usize; 2], pitch: [f64; 2]) -> Topography {
        let grid = Grid::new(shape, pitch).unwrap();
        Topography::new(grid, Field::from_shape_fn(shape, |(i, j)| ((7 * i + 3 * j * j) % 11) as f64))
            .unwrap()
    }

    #[test]
    fn coarser_cells_hold_the_average_of_the_finer_ones() {
        let coarse = bumpy([6, 4], [1.0, 0.5]).resample_to_shape([3, 2], Interpolation::Linear).unwrap();
        assert_eq!(coarse.grid().pitch, [2.0, 1.0]);
        let fine = bumpy([6, 4], [1.0, 0.5]).into_heights();
        let average = (fine[[2, 0]] + fine[[2, 1]] + fine[[3, 0]] + fine[[3, 1]]) / 4.0;
        assert_relative_eq!(coarse.heights()[[1, 0]], average, max_relative = 1e-14);
    }

    #[test]
    fn the_mean_is_kept_on_coarsening_and_on_whole_refinement() {
        let topography = bumpy([60, 36], [1e-6, 2e-6]);
        for shape in [[60, 36], [20, 12], [7, 5], [59, 1], [120, 180], [20, 72]] {
            let resampled = topography.resample_to_shape(shape, Interpolation::Linear).unwrap();
            assert_relative_eq!(resampled.mean(), topography.mean(), max_relative = 1e-13);
        }
    }

    #[test]
    fn a_plane_stays_that_plane_away_from_the_rim() {
        let grid = Grid::new([12, 9], [1.0, 2.0]).unwrap();
        let plane = |x: f64, y: f64| 1.0 + 0.3 * x - 0.2 * y;
        let heights = Field::from_shape_fn(grid.shape, |(i, j)| plane(grid.centre(0, i), grid.centre(1, j)));
        let topography = Topography::new(grid, heights).unwrap();
        for shape in [[6, 3], [30, 40], [5, 23]] {
            let resampled = topography.resample_to_shape(shape, Interpolation::Linear).unwrap();
            for ((i, j), z) in resampled.heights().indexed_iter() {
                let (x, y) = (resampled.grid().centre(0, i), resampled.grid().centre(1, j));
                if (0.5..=11.5).contains(&x) && (1.0..=17.0).contains(&y) {
                    assert_relative_eq!(*z, plane(x, y), max_relative = 1e-12, epsilon = 1e-12);
                }
            }
        }
    }

    #[test]
    fn the_same_grid_changes_nothing() {
        let topography = bumpy([7, 10], [0.1e-6, 0.3e-6]);
        let same = topography.resample_to_pitch([0.1e-6, 0.3e-6], Interpolation::Linear).unwrap();
        assert_eq!(same.heights(), topography.heights());
    }

    #[test]
    fn no_height_leaves_the_range_of_the_samples() {
        let fine = bumpy([7, 10], [1.0, 1.0]).resample_to_shape([23, 41], Interpolation::Linear).unwrap();
        assert!(fine.heights().iter().all(|z| (-1e-12..=10.0 + 1e-12).contains(z)));
    }

    #[test]
    fn a_wave_too_short_for_the_new_cells_is_averaged_away() {
        let grid = Grid::new([64, 64], [1.0, 1.0]).unwrap();
        let heights = Field::from_shape_fn(grid.shape, |(i, _)| if i % 2 == 0 { 1.0 } else { -1.0 });
        let coarse = Topography::new(grid, heights)
            .unwrap()
            .resample_to_shape([16, 16], Interpolation::Linear)
            .unwrap();
        assert!(coarse.heights().iter().all(|z| z.abs() < 1e-15));
    }

    #[test]
    fn a_pitch_that_does_not_divide_the_extent_cuts_the_far_edge_off() {
        let topography = bumpy([10, 10], [1.0, 1.0]);
        let resampled = topography.resample_to_pitch([3.0, 0.1], Interpolation::Linear).unwrap();
        assert_eq!((resampled.grid().shape, resampled.grid().pitch), ([3, 100], [3.0, 0.1]));
        for pitch in [[0.0, 1.0], [1.0, f64::NAN], [1.0, 10.1], [-1.0, 1.0], [f64::INFINITY, 1.0]] {
            assert!(matches!(
                topography.resample_to_pitch(pitch, Interpolation::Linear),
                Err(Error::OutOfRange { quantity: "pitch", .. })
            ));
        }
        assert!(topography.resample_to_shape([0, 4], Interpolation::Linear).is_err());
    }

    #[test]
    fn undefined_samples_stay_undefined_where_they_are_drawn_on() {
        let mut topography = bumpy([6, 6], [1.0, 1.0]);
        topography.heights_mut()[[2, 3]] = f64::NAN;
        assert_eq!(topography.resample_to_shape([3, 3], Interpolation::Linear).unwrap().undefined(), 1);
        assert_eq!(topography.resample_to_shape([6, 6], Interpolation::Linear).unwrap().undefined(), 1);
        assert_eq!(topography.resample_to_shape([3, 6], Interpolation::Linear).unwrap().undefined(), 1);
        assert_eq!(topography.resample_to_shape([12, 6], Interpolation::Linear).unwrap().undefined(), 4);
    }

    /// A smooth surface that is not periodic.
    fn smooth(n: usize) -> Topography {
        let grid = Grid::new([n, n + 4], [1.0 / n as f64, 1.0 / n as f64]).unwrap();
        let heights = Field::from_shape_fn(grid.shape, |(i, j)| exact(grid.centre(0, i), grid.centre(1, j)));
        Topography::new(grid, heights).unwrap()
    }

    fn exact(x: f64, y: f64) -> f64 {
        (3.0 * x + 0.4).sin() * (2.0 * y - 0.3).cos()
    }

    #[test]
    fn a_spline_is_of_the_fourth_order_and_a_line_of_the_second() {
        for (interpolation, order) in [(Interpolation::Linear, 2.0), (Interpolation::Spline, 4.0)] {
            let error = |n: usize| {
                let coarse = smooth(n);
                let fine = coarse.resample_to_shape([3 * n, 3 * (n + 4)], interpolation).unwrap();
                let half = 0.5 / n as f64;
                let [right, top] = coarse.grid().extent();
                fine.heights().indexed_iter().fold(0.0, |most: f64, ((i, j), z)| {
                    let (x, y) = (fine.grid().centre(0, i), fine.grid().centre(1, j));
                    let within = x > half && x < right - half && y > half && y < top - half;
                    if within { most.max((z - exact(x, y)).abs()) } else { most }
                })
            };
            let (coarse, fine) = (error(20), error(40));
            let found = (coarse / fine).log2();
            assert!((found - order).abs() < 0.4, "error {coarse:e} → {fine:e} is order {found:.2}");
        }
    }

    #[test]
    fn a_hole_is_as_large_after_a_spline_as_after_a_line_and_bends_it_only_nearby() {
        let mut holed = smooth(40);
        (15..18).for_each(|i| (20..25).for_each(|j| holed.heights_mut()[[i, j]] = f64::NAN));
        let shape = [90, 100];
        let linear = holed.resample_to_shape(shape, Interpolation::Linear).unwrap();
        let by_spline = holed.resample_to_shape(shape, Interpolation::Spline).unwrap();
        let whole = smooth(40).resample_to_shape(shape, Interpolation::Spline).unwrap();
        for (at, z) in by_spline.heights().indexed_iter() {
            assert_eq!(z.is_nan(), linear.heights()[at].is_nan());
            // The influence of a sample on the spline decays by a factor 2 + √3 per sample.
            if at.0 > 75 {
                assert!((z - whole.heights()[at]).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn a_wave_too_short_for_the_new_cells_aliases_by_at_most_its_average_over_a_cell() {
        for long in [7.3, 9.1, 11.3] {
            let grid = Grid::new([960, 2], [1.0, 1.0]).unwrap();
            let wave = |x: f64| (std::f64::consts::TAU * x / long).sin();
            let heights = Field::from_shape_fn(grid.shape, |(i, _)| wave(grid.centre(0, i)));
            let coarse = Topography::new(grid, heights).unwrap();
            let coarse = coarse.resample_to_shape([120, 2], Interpolation::Spline).unwrap();
            let turn = std::f64::consts::PI * 8.0 / long;
            // Eight samples for the integral: the sine of the half sample replaces its arc.
            let average = (turn.sin() / (8.0 * (turn / 8.0).sin())).abs();
            let most = coarse.heights().iter().fold(0.0, |m: f64, z| z.abs().max(m));
            assert!(most < average * (1.0 + 1e-12) && most > 0.9 * average, "{long}: {most} of {average}");
        }
    }
}
