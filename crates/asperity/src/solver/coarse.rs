//! From a grid to one of half as many cells along each axis.

use crate::grid::Field;

/// Means of 2 × 2 cells (of what is there, at the end of an odd number).
pub(super) fn coarse_means(fine: &Field) -> Field {
    let (nx, ny) = fine.dim();
    let cells = fine.as_slice().expect("standard layout");
    Field::from_shape_fn([nx.div_ceil(2), ny.div_ceil(2)], |(i, j)| {
        // At the end of an odd number the last row or column stands for both.
        let (rows, columns) = ([2 * i, (2 * i + 1).min(nx - 1)], [2 * j, (2 * j + 1).min(ny - 1)]);
        let sum = |row: usize| cells[row * ny + columns[0]] + cells[row * ny + columns[1]];
        0.25 * (sum(rows[0]) + sum(rows[1]))
    })
}
