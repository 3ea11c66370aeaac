//! Normal displacement under a uniformly loaded rectangle.

use std::f64::consts::PI;

use crate::grid::Field;
use crate::units::{Metre, Pascal};

/// Normal displacement of the pair at `(x, y)` per unit pressure on the cell centred at the origin, m/Pa.
///
/// ```text
/// πE* u = F(x+a, y+b) − F(x−a, y+b) − F(x+a, y−b) + F(x−a, y−b),  F(s,t) = s asinh(t/|s|) + t asinh(s/|t|)
/// ```
///
/// with `a`, `b` half the `pitch` and `modulus` the composite modulus E*. At distance r the four terms cancel to
/// about 2 log₁₀(r/a) digits, so that beyond r = 20 max(a, b) the integral of 1/r over the cell is taken by 4 × 4
/// Gauss points instead, whose error is less than (a/r)⁸/100. Relative error below 1e-12 everywhere.
/// Love, Phil. Trans. R. Soc. A 228, 377 (1929); Johnson (1985), eq. 3.25.
pub fn normal_displacement(x: Metre, y: Metre, pitch: [Metre; 2], modulus: Pascal) -> f64 {
    let [a, b] = [0.5 * pitch[0], 0.5 * pitch[1]];
    let integral = if x.hypot(y) > 20.0 * a.max(b) {
        inverse_distance_far(x, y, a, b)
    } else {
        corner(x + a, y + b) - corner(x - a, y + b) - corner(x + a, y - b) + corner(x - a, y - b)
    };
    integral / (PI * modulus)
}

/// Coefficients of all cells `[i, j]` at offsets `(i Δx, j Δy)`, m/Pa: the first row of the influence matrix.
pub fn influence_table(shape: [usize; 2], pitch: [Metre; 2], modulus: Pascal) -> Field {
    Field::from_shape_fn(shape, |(i, j)| {
        normal_displacement(i as f64 * pitch[0], j as f64 * pitch[1], pitch, modulus)
    })
}

/// The dense influence matrix of a grid, m/Pa: `[m, n]` is the displacement of cell m per unit pressure on cell n.
///
/// Cells are numbered column by column, m = ix ny + iy with x the direction of motion. A coefficient depends on the
/// distance alone, so that the matrix of an overlap of fewer columns is the leading block of this one. It takes 8 n²
/// bytes for n cells.
pub fn influence_matrix(shape: [usize; 2], pitch: [Metre; 2], modulus: Pascal) -> Field {
    let table = influence_table(shape, pitch, modulus);
    let (cells, width) = (shape[0] * shape[1], shape[1]);
    Field::from_shape_fn([cells, cells], |(m, n)| {
        table[[(m / width).abs_diff(n / width), (m % width).abs_diff(n % width)]]
    })
}

/// F(s, t) = s asinh(t/|s|) + t asinh(s/|t|), each term with its limit 0 where its factor is 0.
fn corner(s: f64, t: f64) -> f64 {
    let term = |s: f64, t: f64| if s == 0.0 { 0.0 } else { s * (t / s.abs()).asinh() };
    term(s, t) + term(t, s)
}

/// ∬ 1/r over the cell by Gauss–Legendre quadrature.
fn inverse_distance_far(x: f64, y: f64, a: f64, b: f64) -> f64 {
    const NODES: [(f64, f64); 4] = [
        (-0.861_136_311_594_052_6, 0.347_854_845_137_453_86),
        (-0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
        (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
        (0.861_136_311_594_052_6, 0.347_854_845_137_453_86),
    ];
    let mut sum = 0.0;
    for (s, weight_x) in NODES {
        let dx = x - a * s;
        for (t, weight_y) in NODES {
            let dy = y - b * t;
            sum += weight_x * weight_y / (dx * dx + dy * dy).sqrt();
        }
    }
    sum * a * b
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

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
    fn both_forms_agree_where_they_meet() {
        for (a, b) in [(0.5, 0.5), (0.5, 0.35), (0.2, 0.5)] {
            for angle in [0.0f64, 0.3, 0.8, 1.2, 1.57] {
                let (x, y) = (10.0 * angle.cos(), 10.0 * angle.sin());
                let closed =
                    corner(x + a, y + b) - corner(x - a, y + b) - corner(x + a, y - b) + corner(x - a, y - b);
                assert_relative_eq!(closed, inverse_distance_far(x, y, a, b), max_relative = 1e-12);
            }
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
