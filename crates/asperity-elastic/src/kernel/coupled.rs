//! Displacement in all directions under a traction in any direction.

use std::cmp::Ordering;
use std::f64::consts::PI;

use ndarray::Array2;

use crate::grid::Field;
use crate::kernel::cell::{asinh_term, integral, logarithm_term};
use crate::kernel::{Coefficients, CoupledResponse};
use crate::material::Compliances;
use crate::units::Metre;

/// The coefficients of all pairs of cells of a grid.
pub struct CoupledTable {
    /// Returns the coefficients at the offsets `(i Δx, j Δy)`.
    table: Array2<Coefficients>,
}

impl CoupledTable {
    /// Computes the coefficients of a grid of `shape` cells of size `pitch`.
    pub fn new(shape: [usize; 2], pitch: [Metre; 2], response: &dyn CoupledResponse) -> Self {
        let influence = response.coupled_influence(pitch);
        let at = |(i, j)| influence(i as f64 * pitch[0], j as f64 * pitch[1]);
        Self { table: Array2::from_shape_fn(shape, at) }
    }

    /// Returns the displacement of the cell `to` per unit traction on the cell `from`.
    pub fn coefficients(&self, to: [usize; 2], from: [usize; 2]) -> Coefficients {
        let offset = [to[0].abs_diff(from[0]), to[1].abs_diff(from[1])];
        let sign = |axis: usize| match to[axis].cmp(&from[axis]) {
            Ordering::Less => -1.0,
            Ordering::Equal => 0.0,
            Ordering::Greater => 1.0,
        };
        self.table[offset].at_offset([sign(0), sign(1)])
    }
}

/// Computes the dense influence matrix of a grid with all nine coefficients, m/Pa. `[m + i M, n + j M]` is
/// the displacement along i of cell m of M per unit traction along j on cell n. Cells are numbered as in
/// [`super::influence_matrix`]. The matrix is symmetric and positive definite, and takes 72 M² bytes.
pub fn coupled_matrix(shape: [usize; 2], pitch: [Metre; 2], response: &dyn CoupledResponse) -> Field {
    let table = CoupledTable::new(shape, pitch, response);
    let cells = shape[0] * shape[1];
    let place = |cell: usize| [cell / shape[1], cell % shape[1]];
    Field::from_shape_fn([3 * cells, 3 * cells], |(m, n)| {
        table.coefficients(place(m % cells), place(n % cells)).matrix()[m / cells][n / cells]
    })
}

/// Computes the displacement of the pair at `(x, y)` per unit traction on the cell centred at the origin,
/// m/Pa.
///
/// ```text
/// π xx = I(1/r)/E* + I(x²/r³)/N*        π zx = I(x/r²)/G*
/// π yy = I(1/r)/E* + I(y²/r³)/N*        π zy = I(y/r²)/G*
/// π xy = I(xy/r³)/N*                    π zz = I(1/r)/E*
/// ```
///
/// I is the integral over the cell of the solutions of Boussinesq and Cerruti for a point load. The error is
/// below 1e-12 of the largest coefficient at that distance. Love (1929); Johnson (1985), eqs. 3.18, 3.25 and
/// 3.75–3.80; Li and Berger, J. Tribol. 123, 1 (2001).
pub fn coupled_displacement(
    x: Metre,
    y: Metre,
    pitch: [Metre; 2],
    compliances: &Compliances,
) -> Coefficients {
    let half = pitch.map(|p| 0.5 * p);
    let cube = |x: f64, y: f64| (x * x + y * y).powf(1.5);
    let along_x = integral([x, y], half, |x, y| asinh_term(y, x), |x, y| x * x / cube(x, y));
    let along_y = integral([x, y], half, asinh_term, |x, y| y * y / cube(x, y));
    let across = integral([x, y], half, |x, y| -x.hypot(y), |x, y| x * y / cube(x, y));
    let odd_x = integral([x, y], half, logarithm_term, |x, y| x / (x * x + y * y));
    let odd_y = integral([x, y], half, |x, y| logarithm_term(y, x), |x, y| y / (x * x + y * y));
    let [normal, lateral, coupling] =
        [compliances.normal, compliances.lateral, compliances.coupling].map(|c| c / PI);
    let zz = normal * (along_x + along_y);
    Coefficients {
        xx: zz + lateral * along_x,
        xy: lateral * across,
        yy: zz + lateral * along_y,
        zx: coupling * odd_x,
        zy: coupling * odd_y,
        zz,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::normal_displacement;
    use crate::material::Material;
    use crate::math::Cholesky;
    use approx::assert_relative_eq;

    const PITCH: [f64; 2] = [1.0, 0.7];

    fn pair(poisson: [f64; 2], young: [f64; 2]) -> Compliances {
        let [lower, upper] = [0, 1].map(|k| Material::elastic(young[k], poisson[k]).unwrap());
        Compliances::new(&lower, &upper).unwrap()
    }

    #[test]
    fn the_normal_one_is_loves() {
        let pair = pair([0.3, 0.2], [1.0, 3.0]);
        for (x, y) in [(0.0, 0.0), (1.0, 0.0), (-3.0, 4.2), (200.0, -70.0)] {
            let zz = coupled_displacement(x, y, PITCH, &pair).zz;
            let love = normal_displacement(x, y, PITCH, pair.modulus());
            assert_relative_eq!(zz, love, max_relative = 1e-12);
        }
    }

    #[test]
    fn far_away_they_are_those_of_point_loads_to_the_next_term() {
        let pair = pair([0.3, 0.2], [1.0, 3.0]);
        for r in [3.0f64, 10.0, 100.0, 1e4] {
            for angle in [0.0f64, 0.7, 2.0, 3.5, 5.0] {
                let (s, c) = angle.sin_cos();
                let at = coupled_displacement(r * c, r * s, PITCH, &pair);
                let force = PITCH[0] * PITCH[1] / PI;
                let point = [
                    (at.xx, (pair.normal + pair.lateral * c * c) / r),
                    (at.xy, pair.lateral * c * s / r),
                    (at.yy, (pair.normal + pair.lateral * s * s) / r),
                    (at.zx, pair.coupling * c / r),
                    (at.zy, pair.coupling * s / r),
                ];
                for (coefficient, point) in point {
                    let next = force / r * pair.normal / (r * r);
                    assert!((coefficient - force * point).abs() < 0.5 * next + 1e-12 * force / r);
                }
            }
        }
    }

    #[test]
    fn a_table_knows_the_coefficients_at_all_offsets() {
        let pair = pair([0.2, 0.3], [1.0, 3.0]);
        let table = CoupledTable::new([4, 5], PITCH, &pair);
        for (to, from) in [([0, 0], [3, 1]), ([3, 1], [0, 4]), ([1, 4], [1, 0]), ([2, 0], [3, 4])] {
            let offset = |axis: usize| (to[axis] as f64 - from[axis] as f64) * PITCH[axis];
            let direct = coupled_displacement(offset(0), offset(1), PITCH, &pair).matrix();
            let found = table.coefficients(to, from).matrix();
            for (a, b) in found.iter().flatten().zip(direct.iter().flatten()) {
                assert_relative_eq!(*a, *b, epsilon = 1e-15);
            }
        }
    }

    #[test]
    fn parity_makes_the_matrix_of_all_cells_symmetric_and_it_is_positive_definite() {
        let rigid = f64::INFINITY;
        for (poisson, young) in [
            ([0.3, 0.3], [1.0, 1.0]),
            ([0.3, 0.45], [210.0, 3.0]),
            ([0.0, 0.49], [1.0, 1e3]),
            ([0.0, 0.3], [1.0, rigid]),
            ([0.3, 0.0], [rigid, 1.0]),
            ([0.5, 0.5], [1.0, 2.0]),
        ] {
            let pair = pair(poisson, young);
            let dense = coupled_matrix([6, 5], PITCH, &pair);
            assert_eq!(dense, dense.t());
            let least = 0.05 * dense[[0, 0]];
            let shifted = &dense - &(Field::eye(dense.nrows()) * least);
            assert!(Cholesky::new(shifted).is_some(), "{poisson:?}: an eigenvalue is not above {least:e}");
        }
    }
}
