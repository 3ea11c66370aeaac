//! The narrowest place of the widest path through a gap.

use super::components::{AT_END, AT_START, Components};
use super::faces::{Topology, before};

/// Returns the cell that completes a path when open cells are added in the order of falling gap, for each of
/// the `wanted` sets of marks that a path has; `None` if there is no such path. Of cells with the same gap
/// the first in memory comes first.
///
/// The gap of this cell is the largest that all cells of a path reach: the critical constriction.
pub(super) fn constrictions<const N: usize>(
    gaps: &[f64],
    topology: Topology,
    wanted: [u8; N],
) -> [Option<usize>; N] {
    let Topology { shape, closed, between } = topology;
    // Positive numbers have the order of their digits. Sorting with them takes half the time of sorting cells by their gaps.
    let open = gaps.iter().enumerate().filter(|(_, gap)| **gap > 0.0);
    let mut order: Vec<(u64, u32)> = open.map(|(cell, gap)| (!gap.to_bits(), cell as u32)).collect();
    order.sort_unstable();
    let mut components = Components::single(gaps.len());
    let mut added = vec![false; gaps.len()];
    let mut found = [None; N];
    for cell in order.into_iter().map(|(_, cell)| cell as usize) {
        added[cell] = true;
        let mut marks = 0;
        for (axis, closed) in closed.into_iter().enumerate() {
            for (first, second, seam) in pairs(shape, cell, axis) {
                if added[first] && added[second] && !(seam && closed) {
                    marks |= components.join(first, second, axis, seam);
                }
            }
        }
        if let Some(axis) = between {
            let index = if axis == 0 { cell / shape[1] } else { cell % shape[1] };
            if index == 0 {
                marks |= components.mark(cell, AT_START);
            }
            if index + 1 == shape[axis] {
                marks |= components.mark(cell, AT_END);
            }
        }
        for (found, wanted) in found.iter_mut().zip(wanted) {
            if found.is_none() && marks & wanted == wanted {
                *found = Some(cell);
            }
        }
        if found.iter().all(Option::is_some) {
            break;
        }
    }
    found
}

/// Returns the number of open cells in a row through a `cell`, across the gradient along `axis`. The row goes
/// on beyond the grid if it `wraps`.
pub(super) fn width(gaps: &[f64], [nx, ny]: [usize; 2], cell: usize, axis: usize, wraps: bool) -> usize {
    let (count, from, step) = if axis == 0 { (ny, cell % ny, 1) } else { (nx, cell / ny, ny) };
    let is_open = |k: usize| gaps[cell - from * step + k * step] > 0.0;
    let after = (1..count).take_while(|k| (wraps || from + k < count) && is_open((from + k) % count)).count();
    if after + 1 == count {
        return count;
    }
    let before =
        (1..count).take_while(|k| (wraps || *k <= from) && is_open((from + count - k) % count)).count();
    1 + before + after
}

/// Returns a cell with its two neighbours along `axis`: the earlier cell, the later one, and whether a period
/// lies between them.
fn pairs(shape: [usize; 2], cell: usize, axis: usize) -> [(usize, usize, bool); 2] {
    let (previous, seam) = before(shape, cell, axis);
    let [nx, ny] = shape;
    let next = match axis {
        0 if cell + ny < nx * ny => (cell + ny, false),
        0 => (cell + ny - nx * ny, true),
        _ if !(cell + 1).is_multiple_of(ny) => (cell + 1, false),
        _ => (cell + 1 - ny, true),
    };
    [(previous, cell, seam), (cell, next.0, next.1)]
}

#[cfg(test)]
mod tests {
    use super::super::components::{WINDS_X, WINDS_Y};
    use super::*;

    #[test]
    fn a_constriction_is_as_wide_as_its_row_of_open_cells() {
        #[rustfmt::skip]
        let gaps = [
            1.0, 0.0, 1.0, 1.0,
            0.0, 0.0, 1.0, 0.0,
            1.0, 1.0, 1.0, 1.0,
        ];
        let width = |cell, axis, wraps| width(&gaps, [3, 4], cell, axis, wraps);
        assert_eq!([width(0, 0, false), width(0, 0, true), width(3, 0, true)], [1, 3, 3]);
        assert_eq!([width(3, 0, false), width(6, 0, true), width(9, 0, false)], [2, 1, 4]);
        assert_eq!(
            [width(0, 1, false), width(0, 1, true), width(6, 1, false), width(9, 1, true)],
            [1, 2, 3, 1]
        );
    }

    const OPEN: Topology = Topology { shape: [4, 3], closed: [false; 2], between: None };

    #[test]
    fn the_widest_path_is_as_narrow_as_its_narrowest_cell() {
        // Along x the middle column is open down to 0.4; along y the third row, down to 0.2.
        let gaps = [
            0.0, 0.9, 0.0, //
            0.0, 0.4, 0.0, //
            0.2, 0.8, 0.7, //
            0.1, 0.5, 0.0,
        ];
        assert_eq!(constrictions(&gaps, OPEN, [WINDS_X, WINDS_Y]), [Some(4), Some(6)]);
        let ends = Topology { closed: [true, false], between: Some(0), ..OPEN };
        assert_eq!(constrictions(&gaps, ends, [AT_START | AT_END]), [Some(4)]);
        let across = Topology { closed: [false, true], between: Some(1), ..OPEN };
        assert_eq!(constrictions(&gaps, across, [AT_START | AT_END]), [Some(6)]);
    }

    #[test]
    fn a_closed_row_leaves_no_path() {
        let gaps = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0];
        let [x, y] = constrictions(&gaps, OPEN, [WINDS_X, WINDS_Y]);
        assert_eq!((x, y), (None, Some(2)));
    }

    #[test]
    fn equal_gaps_wind_with_the_first_cell_that_can() {
        assert_eq!(constrictions(&[1.0; 12], OPEN, [WINDS_X, WINDS_Y]), [Some(9), Some(2)]);
        assert_eq!(
            constrictions(&[1.0], Topology { shape: [1, 1], ..OPEN }, [WINDS_X, WINDS_Y]),
            [Some(0); 2]
        );
    }
}
