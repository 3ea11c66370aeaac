//! Normal displacement under a uniformly loaded rectangle.

use std::f64::consts::PI;

use crate::grid::Field;
use crate::kernel::cell::{asinh_term, integral, means_across};
use crate::math::parallel;
use crate::units::{Metre, Pascal};

/// Computes the normal displacement of the pair at `(x, y)` per unit pressure on the cell centred at the
/// origin, m/Pa.
///
/// ```text
/// πE* u = F(x+a, y+b) − F(x−a, y+b) − F(x+a, y−b) + F(x−a, y−b),  F(s,t) = s asinh(t/|s|) + t asinh(s/|t|)
/// ```
///
/// `a` and `b` are half the `pitch`, and `modulus` is the composite modulus E*. Far from the cell, where
/// these terms cancel, a quadrature of 1/r is used. The relative error is below 1e-12 everywhere. Love, Phil.
/// Trans. R. Soc. A 228, 377 (1929); Johnson (1985), eq. 3.25.
pub fn normal_displacement(x: Metre, y: Metre, pitch: [Metre; 2], modulus: Pascal) -> f64 {
    let closed = |x, y| asinh_term(x, y) + asinh_term(y, x);
    integral([x, y], pitch.map(|p| 0.5 * p), closed, |x, y| 1.0 / (x * x + y * y).sqrt()) / (PI * modulus)
}

/// Computes the means of [`normal_displacement`] at `x` over the widths of `columns` cells along y, of which
/// the first is centred at `y`, m/Pa.
///
/// ```text
/// πE*Δy ū = Σ± ±[G(x±a, y+2b) − 2G(x±a, y) + G(x±a, y−2b)],  G(s,t) = t (s asinh(t/|s|) + t asinh(s/|t|)/2) − s √(s² + t²)/2
/// ```
pub fn normal_displacements_across(
    x: Metre,
    y: Metre,
    columns: usize,
    pitch: [Metre; 2],
    modulus: Pascal,
) -> Vec<f64> {
    let closed = |x: f64, y: f64| y * (asinh_term(x, y) + 0.5 * asinh_term(y, x)) - 0.5 * x * x.hypot(y);
    let mut means = means_across([x, y], columns, pitch.map(|p| 0.5 * p), closed, |x, y| 1.0 / x.hypot(y));
    means.iter_mut().for_each(|mean| *mean /= PI * modulus);
    means
}

/// Returns the coefficients of all cells `[i, j]` at offsets `(i Δx, j Δy)`, m/Pa: the first row of the
/// influence matrix.
pub fn influence_table(shape: [usize; 2], pitch: [Metre; 2], modulus: Pascal) -> Field {
    parallel::field(shape, |i, j| {
        normal_displacement(i as f64 * pitch[0], j as f64 * pitch[1], pitch, modulus)
    })
}

/// Computes the dense influence matrix of a grid, m/Pa: `[m, n]` is the displacement of cell m per unit
/// pressure on cell n.
///
/// Cells are numbered column by column, m = ix ny + iy with x the direction of motion. A coefficient depends
/// only on the distance, so that the matrix of an overlap of fewer columns is the leading block of this one.
/// It takes 8 n² bytes for n cells.
pub fn influence_matrix(shape: [usize; 2], pitch: [Metre; 2], modulus: Pascal) -> Field {
    let table = influence_table(shape, pitch, modulus);
    let (cells, width) = (shape[0] * shape[1], shape[1]);
    Field::from_shape_fn([cells, cells], |(m, n)| {
        table[[(m / width).abs_diff(n / width), (m % width).abs_diff(n % width)]]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn the_mean_across_a_cell_is_that_of_the_displacement() {
        for pitch in [[1.0, 1.0], [1.0, 0.4], [0.3, 1.0]] {
            for [i, j] in
                [[0.0, 0.0], [0.5, 0.0], [0.5, 1.0], [-1.5, 2.0], [0.2, 9.0], [30.0, 1.0], [8.0, -40.0]]
            {
                let (x, y) = (i * pitch[0], j * pitch[1]);
                let parts = 20_000;
                let at = |k: usize| y + pitch[1] * ((k as f64 + 0.5) / parts as f64 - 0.5);
                let mean =
                    (0..parts).map(|k| normal_displacement(x, at(k), pitch, 1.0)).sum::<f64>() / parts as f64;
                let found = normal_displacements_across(x, y - 2.0 * pitch[1], 4, pitch, 1.0)[2];
                assert_relative_eq!(found, mean, max_relative = 1e-8);
            }
        }
    }

    #[test]
    fn a_loaded_square_sinks_half_as_much_at_its_corner_as_at_its_centre() {
        let (side, modulus) = (3.0, 7.0);
        let centre = normal_displacement(0.0, 0.0, [side, side], modulus);
        let corner = normal_displacement(1.5, 1.5, [side, side], modulus);
        assert_relative_eq!(
            centre,
            4.0 * side * (1.0 + 2f64.sqrt()).ln() / (PI * modulus),
            max_relative = 1e-14
        );
        assert_relative_eq!(corner, 0.5 * centre, max_relative = 1e-14);
    }

    #[test]
    fn far_away_it_tends_to_the_point_load_with_the_next_term_of_its_series() {
        for r in [1e2, 1e3, 1e4, 1e6] {
            let point = 1.0 / (PI * r);
            let series = 1.0 + (2.0 - 1.0) / (24.0 * r * r);
            assert_relative_eq!(
                normal_displacement(r, 0.0, [1.0, 1.0], 1.0),
                point * series,
                max_relative = 1e-13f64.max(r.powi(-4))
            );
        }
    }

    #[test]
    fn it_solves_the_cell_as_two_halves() {
        let whole = normal_displacement(1.3, -0.4, [1.0, 0.7], 1.0);
        let halves = normal_displacement(1.3 - 0.25, -0.4, [0.5, 0.7], 1.0)
            + normal_displacement(1.3 + 0.25, -0.4, [0.5, 0.7], 1.0);
        assert_relative_eq!(whole, halves, max_relative = 1e-13);
    }

    #[test]
    fn the_self_and_neighbour_values_of_square_cells_are_the_published_ones() {
        let table = influence_table([2, 2], [1.0, 1.0], 1.0);
        assert_relative_eq!(table[[0, 0]], 1.1222, max_relative = 5e-5);
        assert_relative_eq!(table[[1, 0]], 0.3304, max_relative = 2e-4);
        assert_eq!(table[[0, 1]], table[[1, 0]]);
    }

    #[test]
    fn the_matrix_of_an_overlap_is_the_leading_block_of_the_whole() {
        let (pitch, modulus) = ([1.0, 0.7], 3.0);
        let whole = influence_matrix([5, 4], pitch, modulus);
        assert_eq!(whole, whole.t());
        for columns in 1..=5 {
            let part = influence_matrix([columns, 4], pitch, modulus);
            let rows = 4 * columns;
            assert_eq!(part, whole.slice(ndarray::s![..rows, ..rows]));
        }
        let (x, y) = (3.0 * pitch[0], -2.0 * pitch[1]);
        assert_eq!(whole[[3 * 4, 2]], normal_displacement(x, y, pitch, modulus));
    }
}
