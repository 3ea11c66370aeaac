//! The area of the contact spots, and the width of the largest one.

use crate::grid::{Grid, Spots};
use crate::units::SquareMetre;

/// Part of a cell by which the area is too large, on the mean, for each side between a cell in contact and another one.
const EXCESS: f64 = (std::f64::consts::PI - 1.0 + std::f64::consts::LN_2) / 24.0;

/// Area of contact, corrected for the cells at the edges of spots, which bear on a part of their area.
///
/// With S the number of sides between cells in contact and others, A = A_cells − (π − 1 + ln 2)/24 · S ΔA; at least 0. Of
/// spots whose radius has less than 20 cells it takes too much. Yastrebov, Anciaux & Molinari, Tribol. Int. 114, 161 (2017).
///
/// `touches` says of flat cells whether they are in contact. Beyond the grid all is alike, or it repeats where it is
/// `periodic` along x or y.
pub fn corrected_area(touches: &[bool], grid: &Grid, periodic: [bool; 2]) -> SquareMetre {
    let [nx, ny] = grid.shape;
    let sides = |cell: usize| {
        let [i, j] = [cell / ny, cell % ny];
        let next = [
            (i + 1 < nx || periodic[0]).then(|| (i + 1) % nx * ny + j),
            (j + 1 < ny || periodic[1]).then(|| i * ny + (j + 1) % ny),
        ];
        next.into_iter().flatten().filter(|next| touches[*next] != touches[cell]).count()
    };
    let sides: usize = (0..touches.len()).map(sides).sum();
    let cells = touches.iter().filter(|touches| **touches).count();
    grid.cell_area() * (cells as f64 - EXCESS * sides as f64).max(0.0)
}

/// Width in cells of the largest contact spot, which is the one with the most cells: its number of columns or
/// rows, whichever is smaller; 0 without contact. A spot that goes all around a periodic axis has no end
/// along it, and its width is the one along the other axis.
///
/// `cells` are the flat cells in contact in ascending order on a grid of `shape`. They are connected over
/// edges and corners and, if the grid is `periodic` along x or y, across its boundary.
pub fn largest_spot(cells: impl Iterator<Item = usize>, shape: [usize; 2], periodic: [bool; 2]) -> usize {
    let spots = Spots::new(cells, shape, periodic);
    let counts = spots.counts();
    let Some(largest) = (0..counts.len()).rev().max_by_key(|&spot| counts[spot]) else { return 0 };
    let members: Vec<[usize; 2]> = spots
        .cells
        .iter()
        .zip(&spots.first)
        .filter(|(_, first)| **first == largest)
        .map(|(cell, _)| *cell)
        .collect();
    let distinct = |axis: usize| {
        let mut places: Vec<usize> = members.iter().map(|cell| cell[axis]).collect();
        places.sort_unstable();
        places.dedup();
        places.len()
    };
    narrower([distinct(0), distinct(1)], shape, periodic)
}

/// Returns the smaller of two widths, without that of an axis along which the spot has no end.
fn narrower(widths: [usize; 2], shape: [usize; 2], periodic: [bool; 2]) -> usize {
    let endless = [0, 1].map(|axis| periodic[axis] && widths[axis] == shape[axis]);
    match endless {
        [true, false] => widths[1],
        [false, true] => widths[0],
        _ => widths[0].min(widths[1]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn a_side_at_the_edge_of_a_spot_takes_part_of_a_cell() {
        let grid = Grid::new([20, 12], [1.0, 1.5]).unwrap();
        let all = vec![true; grid.cells()];
        assert_eq!(corrected_area(&all, &grid, [true; 2]), grid.area());
        let mut one = vec![false; grid.cells()];
        one[0] = true;
        // Four sides of a cell in a corner, beyond which the grid repeats.
        assert!((corrected_area(&one, &grid, [true; 2]) / 1.5 - (1.0 - 4.0 * EXCESS)).abs() < 1e-12);
    }

    #[test]
    fn a_spot_is_as_wide_as_its_shorter_side() {
        let width = 10;
        let block = |x: std::ops::Range<usize>, y: std::ops::Range<usize>| {
            x.flat_map(move |x| y.clone().map(move |y| x * width + y)).collect::<Vec<_>>()
        };
        let spot =
            |cells: Vec<usize>, periodic: bool| largest_spot(cells.into_iter(), [10, width], [periodic; 2]);
        assert_eq!(spot(vec![], false), 0);
        assert_eq!(spot(vec![37], false), 1);
        assert_eq!(spot(block(2..5, 1..9), false), 3);
        // A diagonal is one spot. In the corners of a periodic grid lies one spot of two cells across.
        assert_eq!(spot((0..5).map(|i| i * width + i).collect(), false), 5);
        assert_eq!(spot(vec![0, 9, 90, 99], true), 2);
        assert_eq!(spot(vec![0, 9, 90, 99], false), 1);
        // Along an endless line it has no width.
        let line = || block(0..7, 0..3).into_iter().map(|cell| cell / width * 3 + cell % width);
        assert_eq!(largest_spot(line(), [10, 3], [false, true]), 7);
        assert_eq!(largest_spot(line(), [10, 3], [false, false]), 3);
    }

    /// Compared with a flood fill from cell to cell.
    #[test]
    fn spots_are_those_of_a_flood() {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        for _ in 0..2000 {
            let shape = [random.random_range(1..9), random.random_range(1..9)];
            let share = random.random_range(0.0..1.0);
            let periodic = [random.random_bool(0.5), random.random_bool(0.5)];
            let touches: Vec<bool> = (0..shape[0] * shape[1]).map(|_| random.random_bool(share)).collect();
            let cells = (0..touches.len()).filter(|&cell| touches[cell]);
            let (found, flooded) = (largest_spot(cells, shape, periodic), flood(&touches, shape, periodic));
            assert!(flooded.contains(&found), "{found}, {flooded:?}: {shape:?} {periodic:?} {touches:?}");
        }
    }

    /// Widths of the spots with the most cells.
    fn flood(touches: &[bool], shape: [usize; 2], periodic: [bool; 2]) -> Vec<usize> {
        let mut left = touches.to_vec();
        let mut spots = Vec::new();
        for seed in 0..left.len() {
            let (mut open, mut spot) = (vec![seed], Vec::new());
            while let Some(cell) = open.pop() {
                if !std::mem::take(&mut left[cell]) {
                    continue;
                }
                spot.push([cell / shape[1], cell % shape[1]]);
                for (dx, dy) in [(0, 1), (1, 0), (1, 1), (1, -1), (0, -1), (-1, 0), (-1, -1), (-1, 1)] {
                    let [nx, ny] = shape.map(|n| n as isize);
                    let (x, y) = ((cell / shape[1]) as isize + dx, (cell % shape[1]) as isize + dy);
                    if (periodic[0] || (0..nx).contains(&x)) && (periodic[1] || (0..ny).contains(&y)) {
                        open.push((x.rem_euclid(nx) * ny + y.rem_euclid(ny)) as usize);
                    }
                }
            }
            spots.push(spot);
        }
        let most = spots.iter().map(Vec::len).max().unwrap_or(0);
        let distinct = |spot: &Vec<[usize; 2]>, axis: usize| {
            spot.iter().map(|cell| cell[axis]).collect::<std::collections::BTreeSet<_>>().len()
        };
        spots
            .iter()
            .filter(|s| s.len() == most)
            .map(|s| narrower([distinct(s, 0), distinct(s, 1)], shape, periodic))
            .collect()
    }
}
