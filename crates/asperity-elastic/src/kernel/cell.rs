//! Integrals of the point-load solutions over a uniformly loaded rectangle.

use std::sync::LazyLock;

use crate::math::gauss_legendre;

/// Beyond this number of half-sides the closed forms have lost too many digits.
const FAR: f64 = 20.0;

/// Computes ∬ k(x − ξ, y − η) dξ dη over a cell with half-sides `half`, for the solution k of a point load
/// and the closed form F of its second indefinite integral:
///
/// ```text
/// F(x+a, y+b) − F(x−a, y+b) − F(x+a, y−b) + F(x−a, y−b)
/// ```
///
/// At distance r about 2 log₁₀(r/a) digits cancel in the four terms. Beyond r = 20 max(a, b) the integral
/// uses 4 × 4 Gauss points instead. Their error is less than (a/r)⁸/100 of the largest k at r.
pub(super) fn integral(
    at: [f64; 2],
    half: [f64; 2],
    closed: impl Fn(f64, f64) -> f64,
    k: impl Fn(f64, f64) -> f64,
) -> f64 {
    if at[0].hypot(at[1]) > FAR * half[0].max(half[1]) {
        by_quadrature(at, half, k)
    } else {
        by_corners(at, half, closed)
    }
}

/// [`integral`] of several functions that are smooth on the scale of the distance from a point at this `depth`.
///
/// Beyond 3 half-sides 8 × 8 Gauss points have an error of (2r/a)⁻¹⁶, below 1e-12 of k. Beyond 200 half-sides 2 × 2 points have
/// an error of (a/r)⁴/10, below 1e-10 of k, and 1e-12 of k near the cell.
pub(super) fn integrals_below<const N: usize>(
    [x, y]: [f64; 2],
    depth: f64,
    [a, b]: [f64; 2],
    closed: impl Fn(f64, f64) -> [f64; N],
    k: impl Fn(f64, f64) -> [f64; N],
) -> [f64; N] {
    /// Beyond these numbers of half-sides two points along each are enough, or eight.
    const FARTHER: f64 = 200.0;
    const NEARER: f64 = 3.0;
    static EIGHT: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| gauss_legendre(8));
    let mut sums = [0.0; N];
    let mut add = |weight: f64, values: [f64; N]| {
        sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * value);
    };
    let distance = x.hypot(y).hypot(depth) / a.max(b);
    if distance > FARTHER {
        far_points([x, y], [a, b]).into_iter().for_each(|[x, y]| add(a * b, k(x, y)));
    } else if distance > FAR {
        gauss_points([x, y], [a, b]).for_each(|([x, y], weight)| add(weight * a * b, k(x, y)));
    } else if distance > NEARER {
        for (s, along_x) in EIGHT.iter() {
            EIGHT.iter().for_each(|(t, along_y)| add(along_x * along_y * a * b, k(x - a * s, y - b * t)));
        }
    } else {
        let signs = [1.0, -1.0, -1.0, 1.0];
        corners([x, y], [a, b]).into_iter().zip(signs).for_each(|([x, y], sign)| add(sign, closed(x, y)));
    }
    sums
}

/// Returns the corners of a cell, relative to the point `at`.
fn corners([x, y]: [f64; 2], [a, b]: [f64; 2]) -> [[f64; 2]; 4] {
    [[x + a, y + b], [x - a, y + b], [x + a, y - b], [x - a, y - b]]
}

/// Returns the 2 × 2 Gauss points of a cell, relative to the point `at`, each of weight 1. For 1/r the error is (a/r)⁴/10.
pub(super) fn far_points(at: [f64; 2], half: [f64; 2]) -> [[f64; 2]; 4] {
    corners(at, half.map(|half| half / 3f64.sqrt()))
}

/// Computes the means over −b … b of η of [`integral`] at (x, y + 2bj + η), j below `columns`, for the closed
/// form of its third indefinite integral, twice along y.
pub(super) fn means_across(
    [x, y]: [f64; 2],
    columns: usize,
    [a, b]: [f64; 2],
    closed: impl Fn(f64, f64) -> f64,
    k: impl Fn(f64, f64) -> f64,
) -> Vec<f64> {
    let centre = |j: usize| y + 2.0 * b * j as f64;
    let is_near = |y: f64| x.hypot(y) <= FAR * a.max(2.0 * b);
    let along_x = |y: f64| closed(x + a, y) - closed(x - a, y);
    // Neighbours share their edges.
    let mut edges = [None; 3];
    let mean = |j: usize| {
        let y = centre(j);
        if is_near(y) {
            edges = [edges[1], edges[2], None];
            let places = [y - 2.0 * b, y, y + 2.0 * b];
            let [before, here, after] =
                [0, 1, 2].map(|n| *edges[n].get_or_insert_with(|| along_x(places[n])));
            return (before - 2.0 * here + after) / (2.0 * b);
        }
        edges = [None; 3];
        // Two uniform widths together make a triangle.
        let side = |sign: f64| {
            let points = gauss_points([x, y + sign * b], [a, b]);
            points
                .map(|(at, weight)| weight * (1.0 - (at[1] - y).abs() / (2.0 * b)) * k(at[0], at[1]))
                .sum::<f64>()
        };
        (side(1.0) + side(-1.0)) * a * b
    };
    (0..columns).map(mean).collect()
}

fn by_corners(at: [f64; 2], half: [f64; 2], closed: impl Fn(f64, f64) -> f64) -> f64 {
    let [one, two, three, four] = corners(at, half).map(|[x, y]| closed(x, y));
    one - two - three + four
}

/// Gauss–Legendre.
fn by_quadrature(at: [f64; 2], half: [f64; 2], k: impl Fn(f64, f64) -> f64) -> f64 {
    let sum: f64 = gauss_points(at, half).map(|([x, y], weight)| weight * k(x, y)).sum();
    sum * half[0] * half[1]
}

/// Iterates over the 4 × 4 Gauss points of a cell, relative to the point `at`, and their weights, whose sum
/// is 4.
pub(super) fn gauss_points([x, y]: [f64; 2], [a, b]: [f64; 2]) -> impl Iterator<Item = ([f64; 2], f64)> {
    /// Nodes and weights of the four-point Gauss rule.
    const NODES: [(f64, f64); 4] = [
        (-0.861_136_311_594_052_6, 0.347_854_845_137_453_86),
        (-0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
        (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
        (0.861_136_311_594_052_6, 0.347_854_845_137_453_86),
    ];
    let along_y = move |s: f64, weight: f64| NODES.map(|(t, other)| ([x - a * s, y - b * t], weight * other));
    NODES.into_iter().flat_map(move |(s, weight)| along_y(s, weight))
}

/// Returns X asinh(Y/|X|), which is 0 for X = 0: the closed form of y²/r³. With X and Y exchanged it is the
/// closed form of x²/r³; the sum of both is that of 1/r.
pub(super) fn asinh_term(x: f64, y: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x * (y / x.abs()).asinh() }
}

/// Returns Y ln ρ + X atan(Y/X), where a term is 0 if its factor is 0: the closed form of x/r². With X and Y
/// exchanged it is the closed form of y/r².
pub(super) fn logarithm_term(x: f64, y: f64) -> f64 {
    let logarithm = if y == 0.0 { 0.0 } else { y * x.hypot(y).ln() };
    let angle = if x == 0.0 { 0.0 } else { x * (y / x).atan() };
    logarithm + angle
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// The functions k of point loads and their closed forms, in the order of the theory: 1/r, x²/r³, y²/r³,
    /// xy/r³, x/r², y/r².
    type Function = fn(f64, f64) -> f64;
    const ALL: [(Function, Function); 6] = [
        (|x, y| asinh_term(x, y) + asinh_term(y, x), |x, y| 1.0 / x.hypot(y)),
        (|x, y| asinh_term(y, x), |x, y| x * x / x.hypot(y).powi(3)),
        (asinh_term, |x, y| y * y / x.hypot(y).powi(3)),
        (|x, y| -x.hypot(y), |x, y| x * y / x.hypot(y).powi(3)),
        (logarithm_term, |x, y| x / (x * x + y * y)),
        (|x, y| logarithm_term(y, x), |x, y| y / (x * x + y * y)),
    ];

    #[test]
    fn both_forms_agree_where_they_meet() {
        for (closed, k) in ALL {
            for half in [[0.5, 0.5], [0.5, 0.35], [0.2, 0.5]] {
                for angle in [0.0f64, 0.3, 0.8, 1.2, 1.57, 2.5, 4.0] {
                    let at = [10.0 * angle.cos(), 10.0 * angle.sin()];
                    let size = 4.0 * half[0] * half[1] / 10.0;
                    assert_relative_eq!(
                        by_corners(at, half, closed),
                        by_quadrature(at, half, k),
                        epsilon = 1e-12 * size
                    );
                }
            }
        }
    }

    #[test]
    fn near_the_cell_the_closed_forms_are_the_integrals() {
        // Away from the cell a quadrature of its 64 parts is exact; the distance is that of the smallest
        // part.
        for (closed, k) in ALL {
            for at in [[0.9, 0.1], [-0.7, 0.8], [0.0, -1.3], [2.3, -1.7], [0.05, 0.7]] {
                let half = [0.5, 0.35];
                let part = half.map(|h| h / 16.0);
                let mut sum = 0.0;
                for i in 0..16 {
                    for j in 0..16 {
                        let centre = |axis: usize, k: usize| (2 * k + 1) as f64 * part[axis] - half[axis];
                        sum += by_quadrature([at[0] - centre(0, i), at[1] - centre(1, j)], part, k);
                    }
                }
                assert_relative_eq!(by_corners(at, half, closed), sum, epsilon = 1e-12);
            }
        }
    }
}
