//! Heights of one body on a grid.

use asperity_base::error::{Error, Result, check_in};
use asperity_base::grid::{Field, Grid};
use asperity_base::units::{Dimension, Metre};

/// Heights of one body on a grid, in metres; an undefined sample is NaN.
#[derive(Debug, Clone)]
pub struct Topography {
    grid: Grid,
    heights: Field,
}

impl Topography {
    /// Creates a topography with these `heights`, each finite, or NaN if undefined.
    ///
    /// # Errors
    /// [`Error::GridMismatch`] if the shapes of heights and grid differ, [`Error::OutOfRange`] if a height is
    /// infinite.
    pub fn new(grid: Grid, heights: Field) -> Result<Self> {
        if heights.shape() != grid.shape {
            return Err(Error::GridMismatch {
                what: "shape of the grid and of the heights",
                left: format!("{:?}", grid.shape),
                right: format!("{:?}", heights.shape()),
            });
        }
        check_heights(heights.iter())?;
        // Copied to row order if the memory order differs.
        let is_in_order = heights.is_standard_layout();
        let heights = if is_in_order { heights } else { heights.as_standard_layout().into_owned() };
        Ok(Self { grid, heights })
    }

    /// The grid of the heights.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Heights, in metres; NaN where undefined.
    pub fn heights(&self) -> &Field {
        &self.heights
    }

    /// Heights to be changed in place: each must stay finite, or NaN if undefined.
    pub fn heights_mut(&mut self) -> &mut Field {
        &mut self.heights
    }

    /// Returns the heights alone.
    pub fn into_heights(self) -> Field {
        self.heights
    }

    /// Adds two topographies on one grid, for example roughness on a form; undefined where either is.
    ///
    /// # Errors
    /// [`Error::GridMismatch`] if their shapes differ, or their pitches by more than 10⁻⁹.
    pub fn plus(mut self, other: &Self) -> Result<Self> {
        let (one, two) = (self.grid, other.grid);
        let same = (0..2).all(|axis| (one.pitch[axis] / two.pitch[axis] - 1.0).abs() <= 1e-9);
        if one.shape != two.shape || !same {
            let name = |grid: Grid| format!("{:?} cells of {:?} m", grid.shape, grid.pitch);
            let what = "grids of the two topographies";
            return Err(Error::GridMismatch { what, left: name(one), right: name(two) });
        }
        self.heights += &other.heights;
        Ok(self)
    }

    /// Number of undefined samples.
    pub fn undefined(&self) -> usize {
        self.heights.iter().filter(|z| z.is_nan()).count()
    }

    /// Number of defined samples.
    pub fn defined(&self) -> usize {
        self.heights.len() - self.undefined()
    }

    /// Mean of the defined heights; NaN if there are none.
    pub fn mean(&self) -> f64 {
        let defined = self.heights.iter().filter(|z| !z.is_nan());
        defined.sum::<f64>() / self.defined() as f64
    }
}

/// Checks that each height is finite, or NaN if undefined.
pub(crate) fn check_heights<'a>(mut heights: impl Iterator<Item = &'a Metre>) -> Result<()> {
    match heights.find(|z| z.is_infinite()) {
        Some(&value) => {
            let expected = "a finite height, or NaN where the sample is undefined";
            check_in(Dimension::Length, "height", value, false, expected)
        }
        None => Ok(()),
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// 4 × 3 samples; the height of `[i, j]` is 10 i + j.
    pub(crate) fn numbered() -> Topography {
        let grid = Grid::new([4, 3], [1.0, 2.0]).unwrap();
        Topography::new(grid, Field::from_shape_fn([4, 3], |(i, j)| (10 * i + j) as f64)).unwrap()
    }

    #[test]
    fn undefined_samples_are_counted_and_do_not_enter_the_mean() {
        let grid = Grid::new([2, 2], [1.0, 1.0]).unwrap();
        let heights = ndarray::arr2(&[[1.0, f64::NAN], [2.0, 6.0]]);
        let topography = Topography::new(grid, heights).unwrap();
        assert_eq!((topography.undefined(), topography.defined()), (1, 3));
        assert_eq!(topography.mean(), 3.0);
    }

    #[test]
    fn heights_add_where_both_are_defined() {
        let topography = |pitch, heights| {
            Topography::new(Grid::new([1, 2], [pitch, 1.0]).unwrap(), ndarray::arr2(&[heights])).unwrap()
        };
        let sum = topography(1.0, [1.0, f64::NAN]).plus(&topography(1.0, [0.5, 2.0])).unwrap();
        assert_eq!((sum.heights()[[0, 0]], sum.undefined()), (1.5, 1));
        let error = topography(1.0, [0.0; 2]).plus(&topography(2.0, [0.0; 2])).unwrap_err().to_string();
        assert!(
            error.starts_with("grids of the two topographies: [1, 2] cells of [1.0, 1.0] m and "),
            "{error}"
        );
    }

    #[test]
    fn heights_may_come_in_any_order_in_memory() {
        let grid = Grid::new([9, 7], [1.0, 1.0]).unwrap();
        let height = |i: usize, j: usize| ((3 * i + 5 * j) % 7) as f64;
        let by_row = Field::from_shape_fn([9, 7], |(i, j)| height(i, j));
        let by_column = Field::from_shape_fn([7, 9], |(j, i)| height(i, j)).reversed_axes();
        let [rows, columns] = [by_row, by_column].map(|heights| Topography::new(grid, heights).unwrap());
        let despiked =
            |topography: Topography| topography.despike(2.0).unwrap().into_heights().mapv(f64::to_bits);
        assert_eq!(despiked(rows), despiked(columns));
    }

    #[test]
    fn heights_must_fit_the_grid_and_be_finite() {
        let grid = Grid::new([2, 3], [1.0, 1.0]).unwrap();
        let transposed = Topography::new(grid, Field::zeros([3, 2])).unwrap_err();
        assert_eq!(transposed.to_string(), "shape of the grid and of the heights: [2, 3] and [3, 2] differ");
        let infinite = Topography::new(grid, Field::from_elem([2, 3], f64::INFINITY)).unwrap_err();
        assert!(infinite.to_string().starts_with("height is inf"));
    }
}
