//! Local slopes, for the hybrid parameters and the distribution of slopes.

use std::ops::Range;

use crate::Topography;
use asperity_base::grid::flat;

/// Derivative at a sample from the six around it, with `pair(k)` = z₊ₖ − z₋ₖ:
///
/// dz/dx = (pair(3) − 9 pair(2) + 45 pair(1))/60Δx,
///
/// The local slope of ISO 4287, accurate to the sixth power of Δx/wavelength and too small below about four
/// samples per wave.
pub(crate) fn derivative(pair: impl Fn(usize) -> f64, pitch: f64) -> f64 {
    (pair(3) - 9.0 * pair(2) + 45.0 * pair(1)) / (60.0 * pitch)
}

/// Number of samples on either side for a [`derivative`].
pub(crate) const REACH: usize = 3;

/// Iterates over ∂z/∂x and ∂z/∂y at each sample of some `rows` with three defined neighbours on every side, x
/// slowest.
///
/// The slope along a direction with one sample is 0.
pub(crate) fn gradients(topography: &Topography, rows: Range<usize>) -> impl Iterator<Item = [f64; 2]> {
    let (grid, z) = (*topography.grid(), flat(topography.heights()));
    let [inner_x, inner_y] = grid.shape.map(|n| {
        let border = if n > 1 { REACH } else { 0 };
        border..n.saturating_sub(border)
    });
    let columns = grid.shape[1];
    let along = move |axis: usize, cell: usize| match (grid.shape[axis], axis) {
        (1, _) => 0.0,
        (_, 0) => derivative(|k| z[cell + k * columns] - z[cell - k * columns], grid.pitch[0]),
        _ => derivative(|k| z[cell + k] - z[cell - k], grid.pitch[1]),
    };
    let inner_x = inner_x.start.max(rows.start)..inner_x.end.min(rows.end);
    inner_x
        .flat_map(move |ix| inner_y.clone().map(move |iy| [0, 1].map(|axis| along(axis, ix * columns + iy))))
        .filter(|[x, y]| !(x.is_nan() || y.is_nan()))
}
