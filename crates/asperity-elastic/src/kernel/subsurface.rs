//! Stress in a half-space under a uniformly loaded rectangle, and under a harmonic traction.
//!
//! z points into the body, stress is positive in tension. On the surface z = 0 act the pressure p ≥ 0, along
//! +z, and the shear tractions q_x and q_y along +x and +y, so that there σzz = −p, σxz = −q_x, σyz = −q_y.
//!
//! All stresses are derivatives of the potentials V = ∬ 1/R, ψ = ∬ ln(R + z) and F = ∬ [z ln(R + z) − R] over
//! the loaded area, with R the distance to its points. Per unit traction, with subscripts for derivatives,
//!
//! ```text
//! 2π σ    under p                                under q_x
//! xx      2ν V_z − z V_xx − (1 − 2ν) ψ_xx        2(1 + ν) V_x + 2ν F_xxx − z ψ_xxx
//! yy      2ν V_z − z V_yy − (1 − 2ν) ψ_yy        2ν V_x + 2ν F_xyy − z ψ_xyy
//! zz      V_z − z V_zz                           −z V_xz
//! yz      −z V_yz                                −z V_xy
//! xz      −z V_xz                                V_z − z V_xx
//! xy      −(1 − 2ν) ψ_xy − z V_xy                V_y + 2ν F_xxy − z ψ_xxy
//! ```
//!
//! The stresses under q_y follow from an exchange of x and y. Love, Phil. Trans. R. Soc. A 228, 377 (1929);
//! Johnson (1985), sections 3.2–3.6.

use std::f64::consts::FRAC_1_PI;

use crate::grid::Field;
use crate::stress::{Component, Stress};
use crate::units::Metre;

/// A traction on the surface of a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Traction {
    /// Shear traction q_x, along +x.
    X,
    /// Shear traction q_y, along +y.
    Y,
    /// Pressure p, into the body.
    Pressure,
}

impl Traction {
    /// All three.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Pressure];

    /// Returns whether the coefficient of `component` is odd in x, and in y. Otherwise it is even.
    pub fn odd(self, component: Component) -> [bool; 2] {
        [
            matches!(component, Component::Xz | Component::Xy) != (self == Self::X),
            matches!(component, Component::Yz | Component::Xy) != (self == Self::Y),
        ]
    }
}

/// Computes the stress at `(x, y)` and `depth` ≥ 0 per unit `traction` on the cell centred at the origin,
/// dimensionless.
///
/// ```text
/// 2π σ = S(x+a, y+b) − S(x−a, y+b) − S(x+a, y−b) + S(x−a, y−b)
/// ```
///
/// `a` and `b` are half the `pitch`, and S are the indefinite integrals of the potentials over x and y. The
/// error is about 1e-16 of the traction, so that at distance r about 2 log₁₀(r/a) digits are lost. At depth 0
/// the result is the limit from inside. On the edges of the cell it is NaN or infinite.
pub fn cell_stress(
    [x, y]: [Metre; 2],
    depth: Metre,
    pitch: [Metre; 2],
    poisson: f64,
    traction: Traction,
) -> Stress {
    let [a, b] = pitch.map(|p| 0.5 * p);
    Stress::from_components(Component::ALL.map(|component| {
        let corner = |x: f64, y: f64| corner(component, traction, x / a, y / a, depth / a, poisson);
        (corner(x + a, y + b) - corner(x - a, y + b)) - (corner(x + a, y - b) - corner(x - a, y - b))
    }))
}

/// Passes the `component` of [`cell_stress`] to `take`, line after line along `axis`: the number of a line,
/// which counts the pitches across it from 0, and its values at the offsets from 0 along it. `lines` and
/// `along` are their numbers.
///
/// The values are equal to those of [`stress_table`]. Only two lines are held.
#[expect(clippy::too_many_arguments, reason = "all of a cell, and of the lines")]
pub fn stress_lines(
    [lines, along]: [usize; 2],
    axis: usize,
    depth: Metre,
    pitch: [Metre; 2],
    poisson: f64,
    component: Component,
    traction: Traction,
    mut take: impl FnMut(usize, &[f64]),
) {
    let (size, depth) = ([1.0, pitch[1] / pitch[0]], depth / pitch[0]);
    let [s, t] = [size[1 - axis], size[axis]];
    // A coefficient is even if its corner function is odd.
    let odd = traction.odd(component).map(|odd| if odd { 1.0 } else { -1.0 });
    let [across, odd_along] = [odd[1 - axis], odd[axis]];
    let mut before = vec![0.0; along];
    let mut values = vec![0.0; along];
    for i in 0..lines {
        let mut last = 0.0;
        for j in 0..along {
            let place = [(i as f64 + 0.5) * s, (j as f64 + 0.5) * t];
            let [x, y] = if axis == 1 { place } else { [place[1], place[0]] };
            let at = corner(component, traction, x, y, depth, poisson);
            let difference = at - if j == 0 { odd_along * at } else { last };
            last = at;
            values[j] = difference - if i == 0 { across * difference } else { before[j] };
            before[j] = difference;
        }
        take(i, &values);
    }
}

/// Computes the `component` under a strip of cells without end along `axis`, at the distances `i Δ` across
/// it, per unit traction.
///
/// Its error is some 1e-10 of the traction: the strip is a cell that is 10¹⁰ times as long as the distances
/// are large, and the stress along a cell misses that of a strip by the ratio of width and length.
pub fn strip_stress(
    count: usize,
    axis: usize,
    depth: Metre,
    pitch: [Metre; 2],
    poisson: f64,
    component: Component,
    traction: Traction,
) -> Vec<f64> {
    const LONG: f64 = 1e10;
    let across = pitch[1 - axis];
    let at = |i: usize| {
        let distance = i as f64 * across;
        let mut long = pitch;
        long[axis] = LONG * distance.max(depth).max(across);
        let place = if axis == 1 { [distance, 0.0] } else { [0.0, distance] };
        let stress = cell_stress(place, depth, long, poisson, traction).components();
        let index = Component::ALL.iter().position(|other| *other == component);
        stress[index.expect("one of all")]
    };
    (0..count).map(at).collect()
}

/// Computes the `component` of [`cell_stress`] at the offsets `(i Δx, j Δy)`.
///
/// Each corner is evaluated once for the four cells that meet there.
pub fn stress_table(
    shape: [usize; 2],
    depth: Metre,
    pitch: [Metre; 2],
    poisson: f64,
    component: Component,
    traction: Traction,
) -> Field {
    let mut table = Field::zeros(shape);
    stress_lines(shape, 1, depth, pitch, poisson, component, traction, |i, values| {
        table.row_mut(i).iter_mut().zip(values).for_each(|(at, value)| *at = *value);
    });
    table
}

/// Computes the `component` at `depth` per unit of the harmonic traction e^{i(k x + l y)}. It has a factor i
/// if [`Traction::odd`] is true for exactly one of x and y.
///
/// The potentials of a harmonic are V = 2π e^{−qz}/q, ψ = −V/q, F = V/q², q = √(k² + l²). For example, σzz =
/// −(1 + qz) e^{−qz} p. At q = 0 the traction is uniform, and the body cannot widen: σzz = −p, σxx = σyy = −ν
/// p/(1 − ν), σxz = −q_x, σyz = −q_y.
pub fn harmonic_stress(
    [k, l]: [f64; 2],
    depth: Metre,
    poisson: f64,
    component: Component,
    traction: Traction,
) -> f64 {
    use Component::{Xx, Xy, Xz, Yy, Yz, Zz};
    let (component, traction, [k, l]) = canonical(component, traction, [k, l]);
    let q = k.hypot(l);
    if q == 0.0 {
        return match (traction, component) {
            (Traction::Pressure, Xx) => -poisson / (1.0 - poisson),
            (Traction::Pressure, Zz) | (Traction::X, Xz) => -1.0,
            _ => 0.0,
        };
    }
    let (k, l, z, nu) = (k / q, l / q, depth * q, poisson);
    let amplitude = match (traction, component) {
        (Traction::Pressure, Xx) => -2.0 * nu + (z - 1.0 + 2.0 * nu) * k * k,
        (Traction::Pressure, Zz) => -1.0 - z,
        (Traction::Pressure, Xz) | (Traction::X, Zz) => k * z,
        (Traction::Pressure, Xy) => (z - 1.0 + 2.0 * nu) * k * l,
        (Traction::X, Xx) => k * (2.0 + 2.0 * nu - (2.0 * nu + z) * k * k),
        (Traction::X, Yy) => k * (2.0 * nu - (2.0 * nu + z) * l * l),
        (Traction::X, Yz) => k * l * z,
        (Traction::X, Xz) => k * k * z - 1.0,
        (Traction::X, Xy) => l * (1.0 - (2.0 * nu + z) * k * k),
        (Traction::Pressure, Yy | Yz) | (Traction::Y, _) => unreachable!("not canonical"),
    };
    amplitude * (-z).exp()
}

/// One of the ten independent coefficients; an exchange of x and y gives all eighteen.
fn canonical(component: Component, traction: Traction, at: [f64; 2]) -> (Component, Traction, [f64; 2]) {
    let exchanged = match component {
        Component::Xx => Component::Yy,
        Component::Yy => Component::Xx,
        Component::Yz => Component::Xz,
        Component::Xz => Component::Yz,
        Component::Zz | Component::Xy => component,
    };
    match (traction, component) {
        (Traction::Y, _) => (exchanged, Traction::X, [at[1], at[0]]),
        (Traction::Pressure, Component::Yy | Component::Yz) => (exchanged, traction, [at[1], at[0]]),
        _ => (component, traction, at),
    }
}

/// Computes S: the formulas above with the potentials integrated over a quadrant whose corner lies at
/// distance (x, y). Terms that depend only on x or only on y are omitted or added, so that each term is even
/// or odd and bounded for z > 0:
///
/// ```text
/// V_x  = asinh(y/√(x² + z²))     V_z  = −atan(xy/zR)             ψ_xx = atan(y/x) − atan(yz/xR)
/// V_xx = −xy/R(x² + z²)          V_xz = −yz/R(x² + z²)           ψ_xy = ln(R + z)
/// F_xyy = −y/(R + z)             F_xxx = −V_x − F_xyy            V_xy = 1/R
/// ```
fn corner(component: Component, traction: Traction, x: f64, y: f64, z: f64, poisson: f64) -> f64 {
    use Component::{Xx, Xy, Xz, Yy, Yz, Zz};
    let (component, traction, [x, y]) = canonical(component, traction, [x, y]);
    let r = (x * x + y * y + z * z).sqrt();
    // V_x, −V_z, −z V_xx, and the common terms of F and ψ.
    let asinh = |y: f64, x: f64| ((y.abs() + r) / (x * x + z * z).sqrt()).ln().copysign(y);
    let solid_angle = || (x * y).atan2(z * r);
    let bent = |x: f64, y: f64| z * x * y / (r * (x * x + z * z));
    let drawn = |y: f64| (2.0 * poisson + z / r) * y / (r + z);
    let sum = match (traction, component) {
        (Traction::Pressure, Xx) => {
            // Both arcs are combined, without their discontinuity at x = 0.
            let square = x * x + y * y;
            let psi_xx = (x * y * square).atan2((x * x * r + y * y * z) * (r + z));
            bent(x, y) - 2.0 * poisson * solid_angle() - (1.0 - 2.0 * poisson) * psi_xx
        }
        (Traction::Pressure, Zz) => -solid_angle() - bent(x, y) - bent(y, x),
        (Traction::Pressure, Xz) | (Traction::X, Zz) => z * z * y / (r * (x * x + z * z)),
        (Traction::Pressure, Xy) => -(1.0 - 2.0 * poisson) * (r + z).ln() - z / r,
        (Traction::X, Xx) => 2.0 * asinh(y, x) + drawn(y) - z * z * y / (r * (x * x + z * z)),
        (Traction::X, Yy) => 2.0 * poisson * asinh(y, x) - drawn(y),
        (Traction::X, Yz) => -z / r,
        (Traction::X, Xz) => bent(x, y) - solid_angle(),
        (Traction::X, Xy) => asinh(x, y) - drawn(x),
        (Traction::Pressure, Yy | Yz) | (Traction::Y, _) => unreachable!("not canonical"),
    };
    0.5 * FRAC_1_PI * sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const CELL: [f64; 2] = [1.0, 0.7];

    fn stress(at: [f64; 3], poisson: f64, traction: Traction) -> [f64; 6] {
        cell_stress([at[0], at[1]], at[2], CELL, poisson, traction).components()
    }

    /// Values of an independent program, which differentiates the same potentials at the corners and checks
    /// them by Hooke's law on its displacements.
    #[test]
    fn it_is_what_an_independent_program_finds() {
        #[rustfmt::skip]
        let found = [
            ([0.3, -0.2, 0.4], Traction::X, [-0.1320216926754368, -0.005480195086209633, -0.1173389963156974,
                0.03559021486746383, -0.1500231249214478, 0.05231928924325133]),
            ([0.3, -0.2, 0.4], Traction::Y, [0.01749581682447403, 0.08409546732591047, 0.1247612865716679,
                -0.1161553717672085, 0.03559021486746383, -0.04468648494426253]),
            ([0.3, -0.2, 0.4], Traction::Pressure, [-0.09233435820242294, -0.06842901663558425, -0.5244349171912119,
                0.1247612865716679, -0.1173389963156974, 0.02688363391460086]),
            ([-2.1, 0.1, 1.3], Traction::X, [0.03003585808168834, -0.003222150212846079, 0.01351858212745739,
                0.001002827281111994, -0.02079925792981374, -0.001469635774894419]),
            ([-2.1, 0.1, 1.3], Traction::Y, [-0.001168349701375465, -0.0001264507775421955, -0.0006635589989555463,
                -0.000262270811392088, 0.001002827281111994, 0.002982817478892336]),
            ([-2.1, 0.1, 1.3], Traction::Pressure, [-0.01603262497897123, -0.001026944494336642,
                -0.008953165768028943, -0.0006635589989555463, 0.01351858212745739, 0.0007351378612119764]),
        ];
        for (at, traction, expected) in found {
            for (computed, expected) in stress(at, 0.3, traction).iter().zip(expected) {
                assert_relative_eq!(*computed, expected, epsilon = 1e-15, max_relative = 1e-13);
            }
        }
    }

    /// Returns the index of σ_ij among the components.
    fn index(i: usize, j: usize) -> usize {
        [[0, 5, 4], [5, 1, 3], [4, 3, 2]][i][j]
    }

    /// Computes a derivative by differences of fourth order.
    fn derivative(f: impl Fn(f64) -> f64, step: f64) -> f64 {
        (8.0 * (f(step) - f(-step)) - (f(2.0 * step) - f(-2.0 * step))) / (12.0 * step)
    }

    #[test]
    fn each_stress_is_in_equilibrium_and_compatible() {
        // With the tractions below and a decay, equilibrium and Beltrami–Michell leave one elastic solution.
        let (poisson, step) = (0.3, 1e-2);
        for at in [[0.3, -0.2, 0.6], [0.0, 0.5, 0.7], [0.9, 0.1, 0.5], [-0.5, -0.35, 0.8], [0.0, 0.0, 1.0]] {
            for traction in Traction::ALL {
                let moved = |axis: usize, by: f64| {
                    let mut at = at;
                    at[axis] += by;
                    at
                };
                for i in 0..3 {
                    let force: f64 = (0..3)
                        .map(|j| derivative(|s| stress(moved(j, s), poisson, traction)[index(i, j)], step))
                        .sum();
                    assert!(force.abs() < 1e-6, "{traction:?} at {at:?}: force {force:e} along {i}");
                    for j in i..3 {
                        let trace = |s: [f64; 6]| s[0] + s[1] + s[2];
                        let second = |f: &dyn Fn([f64; 3]) -> f64, j: usize, k: usize| {
                            derivative(
                                |s| {
                                    derivative(
                                        |t| {
                                            let mut at = moved(j, s);
                                            at[k] += t;
                                            f(at)
                                        },
                                        step,
                                    )
                                },
                                step,
                            )
                        };
                        let own = |at| stress(at, poisson, traction)[index(i, j)];
                        let sum = |at| trace(stress(at, poisson, traction));
                        let laplacian: f64 = (0..3).map(|k| second(&own, k, k)).sum();
                        let left = laplacian + second(&sum, i, j) / (1.0 + poisson);
                        assert!(left.abs() < 1e-4, "{traction:?} at {at:?}: {left:e} in {i}{j}");
                    }
                }
            }
        }
    }

    #[test]
    fn at_the_surface_the_tractions_are_those_applied() {
        for (at, load) in
            [([0.2, -0.3], 1.0), ([0.0, 0.0], 1.0), ([0.7, 0.0], 0.0), ([-0.2, 0.4], 0.0), ([0.0, 3.0], 0.0)]
        {
            for depth in [0.0, 1e-9] {
                for (traction, component) in [
                    (Traction::X, Component::Xz),
                    (Traction::Y, Component::Yz),
                    (Traction::Pressure, Component::Zz),
                ] {
                    let found = stress([at[0], at[1], depth], 0.3, traction);
                    for other in [Component::Zz, Component::Yz, Component::Xz] {
                        let expected = if other == component { -load } else { 0.0 };
                        assert!(
                            (found[other as usize] - expected).abs() < 2e-8,
                            "{traction:?} at {at:?}, {depth}"
                        );
                    }
                }
            }
        }
        // Under a uniform pressure σxx + σyy = −(1 + 2ν) p, by halves at the centre of a square.
        let centre = cell_stress([0.0; 2], 0.0, [1.0; 2], 0.3, Traction::Pressure);
        assert_relative_eq!(centre.xx, -0.8, max_relative = 1e-15);
    }

    #[test]
    fn far_away_it_is_the_point_load() {
        // Boussinesq: σzz = −3Pz³/2πR⁵. Cerruti: σzz = −3Qxz²/2πR⁵. The next term of the series is of order
        // (a/r)².
        let area = CELL[0] * CELL[1];
        for distance in [10.0, 100.0, 1000.0] {
            let [x, y, z] = [0.6, 0.48, 0.64].map(|cosine| cosine * distance);
            let point = -3.0 * area * z * z / (2.0 * std::f64::consts::PI * distance.powi(5));
            let tolerance = 1.0 / (distance * distance) + 1e-15 * distance * distance;
            let pressure = stress([x, y, z], 0.3, Traction::Pressure)[2];
            assert_relative_eq!(pressure, point * z, max_relative = tolerance);
            assert_relative_eq!(stress([x, y, z], 0.3, Traction::X)[2], point * x, max_relative = tolerance);
            assert_relative_eq!(stress([x, y, z], 0.3, Traction::Y)[2], point * y, max_relative = tolerance);
        }
    }

    #[test]
    fn a_table_is_the_stress_at_its_offsets() {
        let pitch = [2e-6, 3e-6];
        for depth in [0.0, 0.4e-6, 5e-6] {
            for component in Component::ALL {
                for traction in Traction::ALL {
                    let table = stress_table([4, 5], depth, pitch, 0.27, component, traction);
                    for ((i, j), value) in table.indexed_iter() {
                        let [x, y] = [i as f64 * pitch[0], j as f64 * pitch[1]];
                        let at = |x, y| {
                            cell_stress([x, y], depth, pitch, 0.27, traction).components()[component as usize]
                        };
                        assert_relative_eq!(*value, at(x, y), epsilon = 3e-15);
                        let [odd_x, odd_y] = traction.odd(component);
                        let sign = |odd| if odd { -1.0 } else { 1.0 };
                        assert_relative_eq!(*value, sign(odd_x) * at(-x, y), epsilon = 3e-15);
                        assert_relative_eq!(*value, sign(odd_y) * at(x, -y), epsilon = 3e-15);
                    }
                }
            }
        }
    }

    #[test]
    fn a_harmonic_is_in_equilibrium_and_compatible_and_bears_its_traction() {
        use asperity_transforms::num_complex::Complex64;
        let (k, l, poisson) = (0.7, -1.1, 0.3);
        for traction in Traction::ALL {
            let stress = |z: f64| {
                Component::ALL.map(|component| {
                    let [odd_x, odd_y] = traction.odd(component);
                    let factor = if odd_x != odd_y { Complex64::I } else { Complex64::ONE };
                    factor * harmonic_stress([k, l], z, poisson, component, traction)
                })
            };
            let applied = Traction::ALL.map(|other| if other == traction { -1.0 } else { 0.0 });
            for (component, load) in [Component::Xz, Component::Yz, Component::Zz].iter().zip(applied) {
                assert_eq!(stress(0.0)[*component as usize], Complex64::from(load));
            }
            // ∂x = ik, ∂y = il, ∂z by differences.
            let (z, step) = (0.8, 1e-2);
            let slope = |f: &dyn Fn(f64) -> Complex64, z: f64| {
                let part = |part: fn(Complex64) -> f64| derivative(|s| part(f(z + s)), step);
                Complex64::new(part(|c| c.re), part(|c| c.im))
            };
            let along = |f: &dyn Fn(f64) -> Complex64, axis: usize, z: f64| match axis {
                0 => Complex64::new(0.0, k) * f(z),
                1 => Complex64::new(0.0, l) * f(z),
                _ => slope(f, z),
            };
            for i in 0..3 {
                let force: Complex64 = (0..3).map(|j| along(&|z| stress(z)[index(i, j)], j, z)).sum();
                assert!(force.norm() < 1e-8, "{traction:?}: force {force} along {i}");
                for j in i..3 {
                    let own = |z: f64| stress(z)[index(i, j)];
                    let sum = |z: f64| stress(z)[..3].iter().sum::<Complex64>();
                    let laplacian: Complex64 = (0..3).map(|m| along(&|z| along(&own, m, z), m, z)).sum();
                    let left = laplacian + along(&|z| along(&sum, j, z), i, z) / (1.0 + poisson);
                    assert!(left.norm() < 1e-7, "{traction:?}: {left} in {i}{j}");
                }
            }
        }
    }
}
