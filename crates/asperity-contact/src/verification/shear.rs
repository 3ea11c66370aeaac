//! Tractions to displacements, each in all directions: exact except for round-off.

use std::f64::consts::{PI, TAU};

use super::{Case, Check, Expected, largest, study};
use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::kernel::coupled_displacement;
use crate::material::{Compliances, Material};
use crate::math::integrate;
use crate::operator::{Boundary, CoupledOperator, CoupledSum, Operators};
use crate::units::Metre;

const PITCH: [Metre; 2] = [1e-6, 0.7e-6];

/// Polymer on steel: no coefficient is small.
fn dissimilar() -> Result<Compliances> {
    Compliances::new(&Material::elastic(3e9, 0.35)?, &Material::elastic(210e9, 0.3)?)
}

/// The displacement under a point load is f(θ)/r. In polar coordinates around the evaluated place, ∬ f(θ)/r r
/// dr dθ is ∫ f(θ) ℓ(θ) dθ, with the length ℓ of the ray in the loaded cell. Nothing is singular, not even on
/// the cell itself.
pub(super) const COEFFICIENTS: Case = Case {
    name: "nine coefficients: quadrature",
    source: "Boussinesq, Cerruti: Johnson (1985), sections 3.2 and 3.6",
    checks: coefficients,
};

fn coefficients() -> Result<Vec<Check>> {
    const DIRECTIONS: [[f64; 2]; 6] =
        [[1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [0.37, -0.61]];
    let pair = dissimilar()?;
    let [normal, lateral, coupling] = [pair.normal, pair.lateral, pair.coupling].map(|c| c / PI);
    let checks = ["xx", "xy, yx", "yy", "zx, xz", "zy, yz", "zz"];
    study(
        "cells away",
        &[0, 1, 2, 9, 30, 300],
        checks.map(|name| (name, Expected::RoundOff(1e-12))),
        |away| {
            let errors = DIRECTIONS.map(|direction| {
                let [x, y] = [0, 1].map(|axis| away as f64 * direction[axis] * PITCH[axis]);
                let spread = |f: fn(f64, f64) -> f64| over_rays([x, y], f);
                let zz = normal * spread(|_, _| 1.0);
                let exact = [
                    [
                        zz + lateral * spread(|c, _| c * c),
                        lateral * spread(|c, s| c * s),
                        -coupling * spread(|c, _| c),
                    ],
                    [
                        lateral * spread(|c, s| c * s),
                        zz + lateral * spread(|_, s| s * s),
                        -coupling * spread(|_, s| s),
                    ],
                    [coupling * spread(|c, _| c), coupling * spread(|_, s| s), zz],
                ];
                let found = coupled_displacement(x, y, PITCH, &pair).matrix();
                let error = |i: usize, j: usize| {
                    let [one, other] = [[i, j], [j, i]].map(|[i, j]| (found[i][j] - exact[i][j]) / zz);
                    largest(&[one, other])
                };
                [error(0, 0), error(0, 1), error(1, 1), error(2, 0), error(2, 1), error(2, 2)]
            });
            Ok(std::array::from_fn(|n| largest(&errors.map(|error| error[n]))))
        },
    )
}

/// ∫ f(cos θ, sin θ) ℓ(θ) dθ around the point `at`, over the cell at the origin; θ is the direction from
/// source to point.
fn over_rays(at: [Metre; 2], f: fn(f64, f64) -> f64) -> f64 {
    let half = PITCH.map(|pitch| 0.5 * pitch);
    let length = |direction: [f64; 2]| {
        let ends = [0, 1].map(|axis| {
            let [one, other] = [-half[axis], half[axis]].map(|side| (at[axis] - side) / direction[axis]);
            [one.min(other), one.max(other)]
        });
        (ends[0][1].min(ends[1][1]) - ends[0][0].max(ends[1][0]).max(0.0)).max(0.0)
    };
    // ℓ is smooth between the directions of the corners, relative to that of the centre.
    let centre = at[1].atan2(at[0]);
    let corners = [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]];
    let mut angles = corners.map(|[x, y]| {
        let angle = (at[1] - y * half[1]).atan2(at[0] - x * half[0]) - centre;
        angle - TAU * (angle / TAU).round()
    });
    angles.sort_by(f64::total_cmp);
    let [first, .., last] = angles;
    let arcs = angles.windows(2).map(|arc| [arc[0], arc[1]]).chain([[last, first + TAU]]);
    arcs.map(|[from, to]| {
        integrate(from, to, |angle| {
            let (sin, cos) = (centre + angle).sin_cos();
            f(cos, sin) * length([cos, sin])
        })
    })
    .sum()
}

/// Tractions on all axes, scattered like the sizes of the displacements between them.
fn patchy(shape: [usize; 2]) -> [Field; 3] {
    std::array::from_fn(|axis| {
        Field::from_shape_fn(shape, |(i, j)| {
            1e8 * (((7 + axis) * i + 3 * j * j + axis * i * j) % 11) as f64 - 3e8
        })
    })
}

fn displacement(operator: &mut dyn CoupledOperator, traction: &[Field; 3]) -> [Field; 3] {
    let mut displacement = std::array::from_fn(|_| operator.grid().zeros());
    operator.apply(traction.each_ref().map(Some), displacement.each_mut().map(Some));
    displacement
}

/// Largest difference on each axis over the largest exact displacement on any axis.
fn differences(computed: &[Field; 3], exact: &[Field; 3]) -> [f64; 3] {
    let scale = largest(exact.iter().flatten());
    std::array::from_fn(|axis| largest(&(&computed[axis] - &exact[axis])) / scale)
}

const AXES: [(&str, Expected); 3] = [
    ("displacement along x", Expected::RoundOff(1e-13)),
    ("displacement along y", Expected::RoundOff(1e-13)),
    ("displacement along z", Expected::RoundOff(1e-13)),
];

/// Zero padding, for nine coefficients as for one.
pub(super) const FREE_TRANSFORM: Case = Case {
    name: "coupled free FFT: the direct sum",
    source: "convolution theorem",
    checks: || {
        let pair = dissimilar()?;
        study("cells a side", &[5, 16, 31, 48], AXES, |n| {
            let grid = Grid::new([n, 2 * n / 3], PITCH)?;
            let operators = Operators::new(grid, pair, Boundary::FREE);
            let traction = patchy(grid.shape);
            let exact = displacement(&mut CoupledSum::new(grid, pair), &traction);
            Ok(differences(&displacement(operators.coupled_on(grid.shape).as_mut(), &traction), &exact))
        })
    },
};

/// A wave of shear across its crests and one along them, which the grid represents without error.
///
/// ```text
/// q = k̂ cos k·x       u = (2/k) (1/E*) k̂ cos k·x,   u_z = (2/k) (1/G*) sin k·x      plane strain
/// q = t̂ cos k·x       u = (2/k) (1/E* + 1/N*) t̂ cos k·x,   u_z = 0                  antiplane
/// p = cos k·x         u = −(2/k) (1/G*) k̂ sin k·x,   u_z = (2/k) (1/E*) cos k·x
/// ```
pub(super) const PERIODIC_TRANSFORM: Case = Case {
    name: "coupled periodic FFT: oblique sinusoids",
    source: "Johnson (1985), ch. 3 and eq. 13.6",
    checks: oblique_sinusoids,
};

fn oblique_sinusoids() -> Result<Vec<Check>> {
    let pair = dissimilar()?;
    let checks = ["shear across crests", "shear along crests", "pressure"];
    study("cells a side", &[8, 15, 32, 64], checks.map(|name| (name, Expected::RoundOff(1e-14))), |n| {
        let grid = Grid::new([n, n + 1], PITCH)?;
        let [kx, ky] = [3.0 * TAU / grid.extent()[0], -2.0 * TAU / grid.extent()[1]];
        let k = kx.hypot(ky);
        let [c, s] = [kx / k, ky / k];
        let wave = |f: fn(f64) -> f64| {
            Field::from_shape_fn(grid.shape, |(i, j)| f(kx * grid.centre(0, i) + ky * grid.centre(1, j)))
        };
        let (cos, sin, none) = (wave(f64::cos), wave(f64::sin), grid.zeros());
        let [normal, lateral, coupling] = [pair.normal, pair.lateral, pair.coupling].map(|v| 2.0 * v / k);
        let along = normal + lateral;
        let waves = [
            ([c * &cos, s * &cos, none.clone()], [c * normal * &cos, s * normal * &cos, coupling * &sin]),
            ([-s * &cos, c * &cos, none.clone()], [-s * along * &cos, c * along * &cos, none.clone()]),
            ([none.clone(), none, cos.clone()], [-c * coupling * &sin, -s * coupling * &sin, normal * &cos]),
        ];
        let mut operator = Operators::new(grid, pair, Boundary::PERIODIC).coupled_on(grid.shape);
        Ok(waves.map(|(traction, exact)| {
            largest(&differences(&displacement(operator.as_mut(), &traction), &exact))
        }))
    })
}
