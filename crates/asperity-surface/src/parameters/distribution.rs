//! Distributions of heights and of slopes.

use super::slope::gradients;
use crate::Topography;
use asperity_base::choice::choice;
use asperity_base::error::{Error, Result, check};

/// A density over classes of equal width, by counting.
///
/// The classes span the values from the lowest to the highest, which belongs to the last class. The integral
/// is 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Distribution {
    /// The lowest value, at which the first class begins.
    pub lowest: f64,
    /// Width of a class.
    pub width: f64,
    /// Fraction of the values in each class over its width: per metre for heights, a pure number for slopes.
    pub density: Vec<f64>,
}

/// Number of classes of a [`Distribution`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Classes {
    /// A given number of classes.
    Number(usize),
    /// Classes as wide as 2 IQR n^(−1/3), with IQR the interquartile range of the n values: Freedman and
    /// Diaconis, Z. Wahrscheinlichkeitstheorie verw. Gebiete 57, 453 (1981). At most n classes; one if IQR =
    /// 0.
    #[default]
    FreedmanDiaconis,
}

/// A slope of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Slope {
    /// ∂z/∂x.
    X,
    /// ∂z/∂y.
    Y,
    /// √((∂z/∂x)² + (∂z/∂y)²).
    Magnitude,
}

choice!(Slope: "x" => X, "y" => Y, "magnitude" => Magnitude);

impl Distribution {
    /// Creates the distribution of finite `values`.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for no classes; [`Error::Unsupported`] without two different values, for which
    /// no density exists.
    pub fn from_values(mut values: Vec<f64>, classes: Classes) -> Result<Self> {
        values.sort_unstable_by(f64::total_cmp);
        let (lowest, range) = match values[..] {
            [lowest, .., highest] if lowest < highest => (lowest, highest - lowest),
            _ => return Err(Error::Unsupported("a density needs two values that differ")),
        };
        let number = match classes {
            Classes::Number(number) => number,
            Classes::FreedmanDiaconis => freedman_diaconis(&values, range),
        };
        check("number of classes", number as f64, number > 0, "at least 1")?;
        let width = range / number as f64;
        let mut density = vec![0.0; number];
        let share = 1.0 / (values.len() as f64 * width);
        for value in values {
            density[(((value - lowest) / width) as usize).min(number - 1)] += share;
        }
        Ok(Self { lowest, width, density })
    }

    /// Centre of class `index`.
    pub fn centre(&self, index: usize) -> f64 {
        self.lowest + (index as f64 + 0.5) * self.width
    }
}

impl Topography {
    /// Computes the distribution of the defined heights, relative to their mean.
    ///
    /// # Errors
    /// The errors of [`Distribution::from_values`].
    pub fn height_distribution(&self, classes: Classes) -> Result<Distribution> {
        let mean = self.mean();
        let defined = self.heights().iter().filter(|z| !z.is_nan());
        Distribution::from_values(defined.map(|z| z - mean).collect(), classes)
    }

    /// Computes the distribution of a slope over the samples that have one, with the derivative of
    /// [`HybridParameters`](super::HybridParameters).
    ///
    /// # Errors
    /// The errors of [`Distribution::from_values`].
    pub fn slope_distribution(&self, slope: Slope, classes: Classes) -> Result<Distribution> {
        let pick = |[x, y]: [f64; 2]| match slope {
            Slope::X => x,
            Slope::Y => y,
            Slope::Magnitude => x.hypot(y),
        };
        Distribution::from_values(gradients(self, 0..self.grid().shape[0]).map(pick).collect(), classes)
    }
}

/// Number of classes for `values` in ascending order that span `range`.
fn freedman_diaconis(values: &[f64], range: f64) -> usize {
    let n = values.len();
    let middle_half = values[3 * (n - 1) / 4] - values[(n - 1) / 4];
    let width = 2.0 * middle_half / (n as f64).cbrt();
    if width > 0.0 { ((range / width).ceil() as usize).clamp(1, n) } else { 1 }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use approx::assert_relative_eq;

    use super::*;
    use crate::Form;
    use asperity_base::grid::{Field, Grid};

    #[test]
    fn heights_of_a_sinusoid_follow_the_arcsine_law() {
        let grid = Grid::new([4000, 1], [1e-3, 1.0]).unwrap();
        let wave = Form::Sinusoid { amplitude: 1.0, wavelength: [4.0, f64::INFINITY] }.on(&grid).unwrap();
        let found = wave.height_distribution(Classes::Number(16)).unwrap();
        for (i, density) in found.density.iter().enumerate() {
            let half = 0.5 * found.width;
            let ratio = |z: f64| z.clamp(-1.0, 1.0).asin() / PI;
            let exact = (ratio(found.centre(i) + half) - ratio(found.centre(i) - half)) / found.width;
            // A class with the fraction p has p n samples, with an error of one at each of its ends, on each
            // of both flanks.
            assert!((density - exact).abs() <= 4.0 / 4000.0 / found.width, "{i}: {density} {exact}");
        }
    }

    #[test]
    fn a_density_integrates_to_one_whatever_the_classes() {
        let grid = Grid::new([40, 30], [0.1, 0.2]).unwrap();
        let mut heights = Field::from_shape_fn(grid.shape, |(i, j)| ((7 * i * i + 3 * i * j) % 23) as f64);
        heights[[4, 5]] = f64::NAN;
        let rough = Topography::new(grid, heights).unwrap();
        for classes in [Classes::Number(1), Classes::Number(77), Classes::FreedmanDiaconis] {
            for found in [
                rough.height_distribution(classes).unwrap(),
                rough.slope_distribution(Slope::X, classes).unwrap(),
                rough.slope_distribution(Slope::Magnitude, classes).unwrap(),
            ] {
                assert_relative_eq!(
                    found.density.iter().sum::<f64>() * found.width,
                    1.0,
                    max_relative = 1e-12
                );
            }
        }
    }

    #[test]
    fn the_rule_of_freedman_and_diaconis_widens_with_the_cube_root() {
        // Uniform values: the interquartile range is ½, the width n^(−1/3).
        let classes = |n: usize| {
            let values = (0..n).map(|i| i as f64 / (n - 1) as f64).collect();
            Distribution::from_values(values, Classes::FreedmanDiaconis).unwrap().density.len()
        };
        assert_eq!((classes(1001), classes(8001)), (11, 21));
    }

    #[test]
    fn slopes_of_crossed_waves_lie_along_their_own_axes() {
        let grid = Grid::new([64, 96], [0.125, 0.25]).unwrap();
        let heights = Field::from_shape_fn(grid.shape, |(i, j)| {
            (TAU * grid.centre(0, i) / 4.0).sin() + 3.0 * (TAU * grid.centre(1, j) / 12.0).sin()
        });
        let waves = Topography::new(grid, heights).unwrap();
        let span = |slope| {
            let found = waves.slope_distribution(slope, Classes::Number(10)).unwrap();
            [found.lowest, found.lowest + 10.0 * found.width]
        };
        // Largest slopes 2π/4 and 3·2π/12; samples half a pitch from the node reach cos(π/32) of them.
        let steepest = TAU / 4.0;
        for [low, high] in [span(Slope::X), span(Slope::Y)] {
            for slope in [-low, high] {
                assert!((1.0 - (PI / 32.0).powi(2) / 2.0..1.0).contains(&(slope / steepest)), "{slope}");
            }
        }
        assert!(span(Slope::Magnitude)[1] < steepest * 2f64.sqrt());
    }

    #[test]
    fn what_has_no_density_is_refused() {
        let flat = Form::Flat.on(&Grid::new([9, 9], [1.0; 2]).unwrap()).unwrap();
        assert!(matches!(flat.height_distribution(Classes::default()), Err(Error::Unsupported(_))));
        assert!(matches!(Distribution::from_values(vec![], Classes::default()), Err(Error::Unsupported(_))));
        let none = Distribution::from_values(vec![0.0, 1.0], Classes::Number(0)).unwrap_err();
        assert!(none.to_string().starts_with("number of classes is 0"));
    }
}
