//! Selection of a part of a topography.

use crate::Topography;
use asperity_base::error::{Error, Result};
use asperity_base::grid::{Field, Grid};

impl Topography {
    /// Returns the part of `nx` × `ny` samples that begins at sample `(x0, y0)`, for a window
    /// `[x0, y0, nx, ny]`.
    ///
    /// # Errors
    /// [`Error::WindowOutside`] if the window is empty or extends beyond the samples.
    pub fn window(&self, window: [usize; 4]) -> Result<Self> {
        let grid = within(self.grid(), window)?;
        let [x0, y0, ..] = window;
        let part = Field::from_shape_fn(grid.shape, |(ix, iy)| self.heights()[[x0 + ix, y0 + iy]]);
        Self::new(grid, part)
    }
}

/// Returns the grid of a window within `old`.
pub(super) fn within(old: &Grid, window: [usize; 4]) -> Result<Grid> {
    let [x0, y0, nx, ny] = window;
    let shape = old.shape;
    let fits = |first: usize, n: usize, all: usize| n > 0 && first < all && n <= all - first;
    if !(fits(x0, nx, shape[0]) && fits(y0, ny, shape[1])) {
        return Err(Error::WindowOutside { window, shape });
    }
    Grid::new([nx, ny], old.pitch)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::topography::tests::numbered;

    #[test]
    fn a_window_keeps_the_pitch_and_counts_from_its_corner() {
        let part = numbered().window([1, 2, 3, 1]).unwrap();
        assert_eq!(part.heights(), ndarray::arr2(&[[12.0], [22.0], [32.0]]));
        assert_eq!(part.grid().pitch, [1.0, 2.0]);
    }

    #[test]
    fn a_window_beyond_the_samples_is_refused() {
        for window in [[2, 0, 3, 1], [0, 3, 1, 1], [0, 0, 0, 1], [1, 1, usize::MAX, 1]] {
            assert!(matches!(numbered().window(window), Err(Error::WindowOutside { .. })));
        }
        let message = numbered().window([2, 0, 3, 1]).unwrap_err().to_string();
        assert_eq!(message, "the window [2, 0, 3, 1] ([x0, y0, nx, ny]) is not a part of the 4 × 3 samples");
    }
}
