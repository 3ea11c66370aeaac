//! A cuboid of plastic strain in an infinite body.

use std::f64::consts::PI;

use crate::stress::Stress;
use crate::units::{Metre, Pascal};

/// Stress of a uniform plastic strain in a cuboid, in an infinite elastic body.
///
/// The total strain follows from the fourth derivatives of ∫ R over the cuboid, which are sums over its
/// corners. Chiu, J. Appl. Mech. 44, 587 (1977).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inclusion {
    /// Lengths of the sides along x, y and z.
    pub sides: [Metre; 3],
    /// Plastic strain in the cuboid, `[row][column]`, symmetric; tensor strain.
    pub strain: [[f64; 3]; 3],
    /// Young's modulus.
    pub young: Pascal,
    /// Poisson's ratio, below ½.
    pub poisson: f64,
}

impl Inclusion {
    /// Stress at a place relative to the middle of the cuboid; not on its faces nor in line with its edges.
    pub fn stress(&self, at: [Metre; 3]) -> Stress {
        let nu = self.poisson;
        let mu = 0.5 * self.young / (1.0 + nu);
        let lambda = 2.0 * mu * nu / (1.0 - 2.0 * nu);
        let trace = |t: &[[f64; 3]; 3]| t[0][0] + t[1][1] + t[2][2];
        let unit = |i: usize, k: usize| if i == k { 1.0 } else { 0.0 };
        let hooke = |e: &[[f64; 3]; 3]| {
            std::array::from_fn(|i| {
                std::array::from_fn(|k| lambda * trace(e) * unit(i, k) + 2.0 * mu * e[i][k])
            })
        };
        let tau: [[f64; 3]; 3] = hooke(&self.strain);
        let d = |i: usize, j: usize, k: usize, l: usize| self.corners(at, [i, j, k, l]);
        let laplacian = |i: usize, k: usize| (0..3).map(|j| d(i, k, j, j)).sum::<f64>();
        let share = 0.5 / (1.0 - nu);
        let strain: [[f64; 3]; 3] = std::array::from_fn(|i| {
            std::array::from_fn(|k| {
                let along = |l: usize| {
                    let share: f64 = (0..3).map(|j| share * d(i, k, j, l) * tau[j][l]).sum();
                    0.5 * (laplacian(k, l) * tau[i][l] + laplacian(i, l) * tau[k][l]) - share
                };
                let sum: f64 = (0..3).map(along).sum();
                -sum / (8.0 * PI * mu)
            })
        });
        let inside = (0..3).all(|axis| 2.0 * at[axis].abs() < self.sides[axis]);
        let total: [[f64; 3]; 3] = hooke(&strain);
        let stress = |i: usize, k: usize| total[i][k] - if inside { tau[i][k] } else { 0.0 };
        Stress {
            xx: stress(0, 0),
            yy: stress(1, 1),
            zz: stress(2, 2),
            yz: stress(1, 2),
            xz: stress(0, 2),
            xy: stress(0, 1),
        }
    }

    /// ∂⁴ ∫ R dV along four axes, as a sum over corners.
    fn corners(&self, at: [Metre; 3], axes: [usize; 4]) -> f64 {
        (0..8)
            .map(|corner| {
                let sign = |axis: usize| if corner >> axis & 1 == 0 { 1.0 } else { -1.0 };
                let from = [0, 1, 2].map(|axis| at[axis] + 0.5 * sign(axis) * self.sides[axis]);
                sign(0) * sign(1) * sign(2) * corner_function(from, axes)
            })
            .sum()
    }
}

/// The function D whose difference over the corners is ∂⁴ ∫ R dV.
fn corner_function(at: [f64; 3], axes: [usize; 4]) -> f64 {
    let r = at.iter().map(|x| x * x).sum::<f64>().sqrt();
    let mut order: Vec<(usize, f64)> =
        (0..3).map(|axis| (axes.iter().filter(|a| **a == axis).count(), at[axis])).collect();
    order.sort_by_key(|(count, _)| std::cmp::Reverse(*count));
    let [(first, x), (second, y), (_, z)] = [order[0], order[1], order[2]];
    match (first, second) {
        (4, _) => {
            let product = x * y * z / r;
            -2.0 * (y * z / (x * r)).atan() + product * (1.0 / (x * x + y * y) + 1.0 / (x * x + z * z))
        }
        (3, _) => (z / x.hypot(y)).asinh() - x * x * z / ((x * x + y * y) * r),
        (2, 2) => -x * y * z / ((x * x + y * y) * r),
        _ => x / r,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const CUBOID: Inclusion = Inclusion {
        sides: [1.0, 0.8, 0.6],
        strain: [[0.3, 0.1, -0.2], [0.1, -0.5, 0.25], [-0.2, 0.25, 0.2]],
        young: 1.0,
        poisson: 0.3,
    };

    #[test]
    fn a_cube_that_swells_is_pressed_and_leaves_no_pressure_outside() {
        let strain = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let cube = Inclusion { sides: [1.0; 3], strain, ..CUBOID };
        let mean = |at| cube.stress(at).components()[..3].iter().sum::<f64>() / 3.0;
        assert_relative_eq!(mean([0.1, 0.2, 0.05]), -2.0 / (3.0 * 0.7), max_relative = 1e-13);
        assert!(mean([1.3, 0.2, 0.05]).abs() < 1e-14);
    }

    #[test]
    fn it_is_in_equilibrium_inside_and_out() {
        let step = 1e-4;
        for at in [[0.9, 0.3, 0.2], [0.1, 0.11, 0.12], [1.5, -1.0, 0.7]] {
            let along = |axis: usize| {
                let moved = |by: f64| {
                    let mut at = at;
                    at[axis] += by;
                    CUBOID.stress(at).components()
                };
                let (one, other) = (moved(step), moved(-step));
                std::array::from_fn::<f64, 6, _>(|c| (one[c] - other[c]) / (2.0 * step))
            };
            let [x, y, z] = [along(0), along(1), along(2)];
            for force in [x[0] + y[5] + z[4], x[5] + y[1] + z[3], x[4] + y[3] + z[2]] {
                assert!(force.abs() < 1e-6, "{force:e} at {at:?}");
            }
        }
    }

    #[test]
    fn traction_goes_through_its_faces() {
        let at = |x: f64| CUBOID.stress([x, 0.1, 0.12]);
        let (inside, outside) = (at(0.5 - 1e-9), at(0.5 + 1e-9));
        for (a, b) in [(inside.xx, outside.xx), (inside.xy, outside.xy), (inside.xz, outside.xz)] {
            assert_relative_eq!(a, b, epsilon = 1e-7);
        }
        assert!((inside.yy - outside.yy).abs() > 0.1);
    }
}
