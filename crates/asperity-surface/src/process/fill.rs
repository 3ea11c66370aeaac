//! Filling of undefined samples.

use super::harmonic::harmonic;
use crate::Topography;
use asperity_base::choice::choice;
use asperity_base::error::{Error, Result};
use asperity_base::grid::{Field, Grid};

/// Method to fill undefined samples. Defined samples are never changed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Fill {
    /// No filling: undefined samples are an error.
    #[default]
    None,
    /// The height of the nearest defined sample, with the distance in metres.
    Nearest,
    /// Laplace's equation ∂²z/∂x² + ∂²z/∂y² = 0 with the defined samples as boundary values: a membrane over
    /// the hole, without extrema inside. The boundary of the grid is free (zero slope across it).
    Harmonic,
}

choice!(Fill: "none" => None, "nearest" => Nearest, "harmonic" => Harmonic);

impl Topography {
    /// Fills every undefined sample.
    ///
    /// # Errors
    /// [`Error::UndefinedSamples`] if there are any and `fill` is [`Fill::None`]; [`Error::NothingDefined`]
    /// if no sample is defined.
    pub fn fill(mut self, fill: Fill) -> Result<Self> {
        let undefined = self.undefined();
        let samples = self.grid().cells();
        if undefined == 0 {
            return Ok(self);
        }
        if undefined == samples && fill != Fill::None {
            return Err(Error::NothingDefined { samples });
        }
        let grid = *self.grid();
        match fill {
            Fill::None => return Err(Error::UndefinedSamples { undefined, samples }),
            Fill::Nearest => nearest(&grid, self.heights_mut()),
            Fill::Harmonic => harmonic(&grid, self.heights_mut()),
        }
        Ok(self)
    }
}

/// Gives each undefined sample the height of the nearest defined one. It uses the exact Euclidean distance
/// transform, first along y, then along x by the lower envelope of the parabolas of squared distance.
///
/// Felzenszwalb & Huttenlocher, Theory of Computing 8, 415 (2012). Linear in the number of samples.
fn nearest(grid: &Grid, z: &mut Field) {
    let [nx, ny] = grid.shape;
    let in_line: Vec<Vec<Option<usize>>> =
        z.outer_iter().map(|line| nearest_in_line(&line.mapv(|z| !z.is_nan()).to_vec())).collect();
    let source = z.clone();
    let ratio = (grid.pitch[1] / grid.pitch[0]).powi(2);
    for iy in 0..ny {
        // Squared distance, in units of the pitch along x, from (ix, iy) to the nearest defined sample of
        // line ix.
        let offset = |ix: usize| in_line[ix][iy].map(|jy| jy.abs_diff(iy).pow(2) as f64 * ratio);
        // The envelope: its lines, and the x from which each is the nearest.
        let mut envelope: Vec<(usize, f64)> = Vec::new();
        for ix in 0..nx {
            let Some(new) = offset(ix) else { continue };
            let mut from = f64::NEG_INFINITY;
            while let Some(&(last, last_from)) = envelope.last() {
                let old = offset(last).expect("only lines with a defined sample enter");
                let (p, q) = (last as f64, ix as f64);
                from = (new - old + q * q - p * p) / (2.0 * (q - p));
                if from > last_from {
                    break;
                }
                envelope.pop();
                from = f64::NEG_INFINITY;
            }
            envelope.push((ix, from));
        }
        let mut part = 0;
        for ix in 0..nx {
            while part + 1 < envelope.len() && envelope[part + 1].1 < ix as f64 {
                part += 1;
            }
            let line = envelope[part].0;
            if let (true, Some(jy)) = (z[[ix, iy]].is_nan(), in_line[line][iy]) {
                z[[ix, iy]] = source[[line, jy]];
            }
        }
    }
}

/// Returns for each sample of a line the index of the nearest defined one; the earlier of two.
fn nearest_in_line(defined: &[bool]) -> Vec<Option<usize>> {
    let mut before = None;
    let mut nearest: Vec<Option<usize>> = defined
        .iter()
        .enumerate()
        .map(|(i, &d)| {
            before = if d { Some(i) } else { before };
            before
        })
        .collect();
    let mut after: Option<usize> = None;
    for i in (0..defined.len()).rev() {
        after = if defined[i] { Some(i) } else { after };
        if after.is_some_and(|a| nearest[i].is_none_or(|b| a - i < i - b)) {
            nearest[i] = after;
        }
    }
    nearest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::HeightParameters;

    fn with_holes(
        shape: [usize; 2],
        pitch: [f64; 2],
        height: impl Fn(f64, f64) -> f64,
        hole: impl Fn(usize, usize) -> bool,
    ) -> (Topography, Field) {
        let grid = Grid::new(shape, pitch).unwrap();
        let whole = Field::from_shape_fn(shape, |(i, j)| height(grid.centre(0, i), grid.centre(1, j)));
        let mut holed = whole.clone();
        holed.indexed_iter_mut().filter(|((i, j), _)| hole(*i, *j)).for_each(|(_, z)| *z = f64::NAN);
        (Topography::new(grid, holed).unwrap(), whole)
    }

    fn disc(i: usize, j: usize) -> bool {
        (i as f64 - 30.0).powi(2) + (j as f64 - 25.0).powi(2) < 400.0
    }

    fn largest_difference(a: &Field, b: &Field) -> f64 {
        a.iter().zip(b).fold(0.0, |m, (a, b)| (a - b).abs().max(m))
    }

    #[test]
    fn a_membrane_over_a_hole_continues_every_discretely_harmonic_surface() {
        // x, y, xy and x² − y² satisfy the five-point equation exactly, for any pitches.
        for pitch in [[1.0, 1.0], [0.5, 2.0]] {
            let height = |x: f64, y: f64| 3.0 + 0.2 * x - 0.1 * y + 0.01 * x * y + 0.02 * (x * x - y * y);
            let (holed, whole) = with_holes([60, 50], pitch, height, disc);
            let filled = holed.fill(Fill::Harmonic).unwrap();
            let error = largest_difference(filled.heights(), &whole);
            assert!(error < 1e-11 * whole.iter().fold(0.0, |m: f64, z| z.abs().max(m)), "{error:e}");
        }
    }

    #[test]
    fn a_membrane_has_no_peaks_of_its_own() {
        let (holed, _) = with_holes(
            [40, 40],
            [1.0, 1.0],
            |x, y| (3.1 * x + 1.7 * y * y).sin(),
            |i, j| (i * 7 + j * j) % 3 > 0,
        );
        let range = HeightParameters::new(&holed);
        let mean = holed.mean();
        let filled = holed.fill(Fill::Harmonic).unwrap();
        assert!(
            filled.heights().iter().all(|z| (-range.sv - 1e-12..=range.sp + 1e-12).contains(&(z - mean)))
        );
    }

    #[test]
    fn one_defined_sample_spans_a_flat_membrane() {
        let (holed, _) = with_holes([130, 70], [1.0, 1.0], |_, _| 2.5, |i, j| (i, j) != (3, 60));
        let filled = holed.fill(Fill::Harmonic).unwrap();
        assert!(filled.heights().iter().all(|z| (z - 2.5).abs() < 1e-12));
    }

    #[test]
    fn the_nearest_sample_is_found_as_by_trying_all() {
        for (shape, pitch) in
            [([17, 23], [1.0, 1.0]), ([23, 17], [1.0, 2.3]), ([1, 30], [1.0, 1.0]), ([30, 1], [1.0, 1.0])]
        {
            let (holed, _) =
                with_holes(shape, pitch, |x, y| x + 1000.0 * y, |i, j| (i * 5 + j * 3 + i * j) % 11 != 0);
            let filled = holed.clone().fill(Fill::Nearest).unwrap();
            let distance = |(i, j): (usize, usize), (k, l): (usize, usize)| {
                (i.abs_diff(k) as f64 * pitch[0]).hypot(j.abs_diff(l) as f64 * pitch[1])
            };
            for (at, z) in filled.heights().indexed_iter() {
                let known = || holed.heights().indexed_iter().filter(|(_, z)| !z.is_nan());
                let least = known().map(|(k, _)| distance(at, k)).fold(f64::INFINITY, f64::min);
                let taken = known().find(|(_, known)| *known == z).expect("a height that was there").0;
                assert!(distance(at, taken) < least + 1e-12, "{at:?} took {taken:?}");
            }
        }
    }

    #[test]
    fn missing_samples_are_an_error_that_says_what_to_do() {
        let (holed, _) = with_holes([10, 10], [1.0, 1.0], |x, _| x, |i, _| i == 4);
        let message = holed.clone().fill(Fill::None).unwrap_err().to_string();
        assert_eq!(message, "10 of 100 samples are undefined");
        let (nothing, _) = with_holes([3, 3], [1.0, 1.0], |x, _| x, |_, _| true);
        assert!(matches!(nothing.fill(Fill::Nearest), Err(Error::NothingDefined { samples: 9 })));
        let (whole, heights) = with_holes([3, 3], [1.0, 1.0], |x, _| x, |_, _| false);
        assert_eq!(whole.fill(Fill::None).unwrap().heights(), heights);
    }
}
