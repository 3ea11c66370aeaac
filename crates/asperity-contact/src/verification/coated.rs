//! Bodies with layers.

use std::f64::consts::PI;

use super::smooth::{RADIUS, sphere_gap};
use super::{Case, Check, Expected, hold, largest, press, relative, study};
use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::kernel::{LayeredBody, Response};
use crate::material::{Coating, Material};
use crate::operator::{Boundary, Edge, FreeFft, Operator, Operators, PeriodicFft};
use crate::reference::HertzSphere;
use crate::solver::{Control, Coupling, Friction, Loading, Tangential};
use crate::surface::{Axis, Form};
use crate::units::Pascal;

const RIGID: Pascal = Pascal::INFINITY;

fn coated(base: [f64; 2], thickness: f64, layer: [f64; 2]) -> Result<LayeredBody> {
    layered(base, &[[thickness, layer[0], layer[1]]])
}

/// Creates a body with layers of these thicknesses, moduli and Poisson's ratios, from the surface down.
fn layered([young, poisson]: [f64; 2], layers: &[[f64; 3]]) -> Result<LayeredBody> {
    let layers = layers.iter().map(|[thickness, young, poisson]| Coating::new(*thickness, *young, *poisson));
    let layers = layers.collect::<Result<_>>()?;
    Ok(LayeredBody::new(&Material::elastic(young, poisson)?.layered(layers)))
}

/// A short wave depends on the layer, a long one on the substrate. On a rigid substrate the limit is an
/// elastic foundation, or for an incompressible layer the flow between two planes.
pub(super) const HARMONICS: Case = Case {
    name: "Coated half-space: harmonics",
    source: "O'Sullivan and King (1988); Johnson (1985), section 5.8",
    checks: || {
        let first = |finest| Expected::Order { order: 0.9..=1.1, finest };
        let second = |finest| Expected::Order { order: 1.9..=2.1, finest };
        let checks = [
            ("no contrast", Expected::RoundOff(1e-14)),
            ("short waves: layer", Expected::RoundOff(1e-14)),
            ("long waves: body below", first(1e-2)),
            ("long waves: foundation", second(1e-4)),
            ("long waves: lubrication", second(1e-4)),
        ];
        study("1/qt", &[64, 128, 256], checks, |n| {
            let [layer, base] = [[1.0, 0.3], [3.0, 0.2]];
            let half_space =
                |[young, poisson]: [f64; 2], q: f64| 2.0 * (1.0 - poisson * poisson) / (young * q);
            let at =
                |base, thickness, layer| Ok(coated(base, thickness, layer)?.harmonic_displacement(0.0, 1.0));
            let thin = 1.0 / n as f64;
            Ok([
                relative(at(layer, thin, layer)?, half_space(layer, 1.0)),
                relative(at(base, n as f64, layer)?, half_space(layer, 1.0)),
                relative(at(base, thin, layer)?, half_space(base, 1.0)),
                relative(at([RIGID, 0.0], thin, layer)?, thin / foundation(layer[0], layer[1])),
                relative(at([RIGID, 0.0], thin, [1.0, 0.5])?, thin.powi(3)),
            ])
        })
    },
};

/// A smooth pressure without force or moment, which is affected neither by its images nor by the mean. Its
/// waves, which are exact, are compared with the sum of its cells, each with uniform pressure.
pub(super) const FREE_AND_PERIODIC: Case = Case {
    name: "Coated half-space: cells against harmonics",
    source: "the Hankel transform",
    checks: || {
        const BODIES: [(&str, [f64; 2], f64, [f64; 2]); 4] = [
            ("stiff layer", [1.0, 0.3], 1.0, [10.0, 0.2]),
            ("soft layer", [10.0, 0.2], 1.0, [1.0, 0.4]),
            ("thin layer", [3.0, 0.2], 0.01, [1.0, 0.3]),
            ("incompressible on rigid", [RIGID, 0.0], 0.5, [1.0, 0.5]),
        ];
        let checks = BODIES.map(|(name, ..)| (name, Expected::Order { order: 1.75..=2.1, finest: 1e-3 }));
        study("width/Δx", &[8, 16, 32], checks, |n| {
            let grid = Grid::new([12 * n; 2], [1.0 / n as f64; 2])?;
            let pressure = Field::from_shape_fn(grid.shape, |(i, j)| {
                let s = (grid.centre(0, i) - 6.0).powi(2) + (grid.centre(1, j) - 6.0).powi(2);
                (1.0 - 2.0 * s + 0.5 * s * s) * (-s).exp()
            });
            let errors = BODIES.map(|(_, base, thickness, layer)| -> Result<f64> {
                let body = coated(base, thickness, layer)?;
                let (mut free, mut periodic) = (grid.zeros(), grid.zeros());
                FreeFft::new(grid, body.clone()).apply(&pressure, &mut free);
                PeriodicFft::new(grid, body).apply(&pressure, &mut periodic);
                Ok(largest(&(&free - &periodic)) / largest(&periodic))
            });
            let [a, b, c, d] = errors;
            Ok([a?, b?, c?, d?])
        })
    },
};

/// A layer thick compared with the contact: Hertz' contact of the layer. The half-space below sinks as a
/// whole in proportion to the contrast of the compliances, and bends by that times (a/t)³.
pub(super) const THICK: Case = Case {
    name: "Coated half-space: Hertz on a thick layer",
    source: "Johnson (1985), section 5.8",
    checks: || {
        let checks = [
            ("approach", Expected::Order { order: 0.9..=1.2, finest: 0.05 }),
            ("peak pressure", Expected::Order { order: 2.5..=3.5, finest: 1e-3 }),
        ];
        study("t/a", &[2, 4, 8], checks, |n| {
            let (layer, base) = ([3.0, 0.3], [9.0, 0.2]);
            let modulus = layer[0] / (1.0 - layer[1] * layer[1]);
            let hertz = HertzSphere { radius: RADIUS, modulus, load: 7.0 };
            let a = hertz.contact_radius();
            let grid = Grid::new([96; 2], [a / 32.0; 2])?;
            let (gap, load) = (sphere_gap(&grid)?, Control::Load(hertz.load));
            // Compared with the same grid without contrast, to exclude the error of the grid.
            let solve = |base| -> Result<[f64; 2]> {
                let body = coated(base, n as f64 * a, layer)?;
                let solution = press(&mut FreeFft::new(grid, body), &gap, Pascal::INFINITY, load)?;
                Ok([solution.approach, solution.max_pressure()])
            };
            let (found, same) = (solve(base)?, solve(layer)?);
            Ok([relative(found[0], same[0]), relative(found[1], same[1])])
        })
    },
};

/// A compressible layer thin compared with the contact, on a rigid body. It is an elastic foundation with the
/// modulus E(1 − ν)/(1 + ν)(1 − 2ν), apart from terms of order (qt)² in the harmonics and an edge as wide as
/// the layer thickness.
pub(super) const FOUNDATION: Case = Case {
    name: "Coated half-space: thin layer on a rigid body",
    source: "Johnson (1985), section 5.8",
    checks: || {
        let (young, poisson) = (1.0, 0.3);
        let checks = [
            ("peak pressure", Expected::Order { order: 1.5..=2.2, finest: 1e-3 }),
            ("approach", Expected::Order { order: 1.4..=2.2, finest: 1e-3 }),
        ];
        thin_layers(checks, &[[1.0, young, poisson]], |thickness| {
            let peak = foundation(young, poisson) / (2.0 * RADIUS * thickness);
            [0.5 * PI * peak, peak, 0.5 / RADIUS]
        })
    },
};

/// Modulus of a foundation of a compressible material that cannot widen, M = E(1 − ν)/(1 + ν)(1 − 2ν).
fn foundation(young: Pascal, poisson: f64) -> Pascal {
    young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson))
}

/// Two layers: shares of the thickness, moduli and Poisson's ratios, from the surface down.
const TWO: [[f64; 3]; 2] = [[0.4, 1.0, 0.3], [0.6, 3.0, 0.2]];

/// Computes the compliance of [`TWO`] layers in series over their thickness, from a modulus of E and ν.
fn in_series(modulus: fn(Pascal, f64) -> Pascal) -> f64 {
    TWO.iter().map(|[share, young, poisson]| share / modulus(*young, *poisson)).sum()
}

/// Two compressible layers thin compared with the contact, on a rigid body: foundations in series, t₁/M₁ + t₂/M₂.
pub(super) const SERIES: Case = Case {
    name: "Layered body: two thin layers on a rigid body",
    source: "Johnson (1985), section 5.8",
    checks: || {
        let compliance = in_series(foundation);
        let checks = [
            ("peak pressure", Expected::Order { order: 1.5..=2.2, finest: 1e-3 }),
            ("approach", Expected::Order { order: 1.4..=2.4, finest: 1e-3 }),
        ];
        thin_layers(checks, &TWO, |thickness| {
            let peak = (2.0 * RADIUS * thickness * compliance).recip();
            [0.5 * PI * peak, peak, 0.5 / RADIUS]
        })
    },
};

/// A sphere that sticks to two layers thin compared with the contact, on a rigid body, and is pushed along them by s:
/// foundations in series in shear, Q = πa² s/(t₁/G₁ + t₂/G₂), apart from an edge as wide as the layers are thick.
pub(super) const SHEARED: Case = Case {
    name: "Layered body: a sphere that sticks to two thin layers",
    source: "Johnson (1985), section 5.8",
    checks: || {
        let [normal, shear] = [in_series(foundation), in_series(|young, nu| young / (2.0 * (1.0 + nu)))];
        let checks = [("force", Expected::Order { order: 0.8..=1.3, finest: 0.1 })];
        study("a/t", &[4, 8, 16], checks, |n| {
            const SHIFT: f64 = 1e-3;
            let thickness = 1.0 / n as f64;
            let grid = Grid::new([10 * n; 2], [0.25 * thickness; 2])?;
            let body = layered([RIGID, 0.0], &of_thickness(&TWO, thickness))?;
            let mut operator = Operators::new(grid, body, Boundary::FREE).coupled_on(grid.shape);
            let loading = Loading {
                normal: Control::Load(0.25 * PI / (RADIUS * thickness * normal)),
                tangential: Tangential::Displacement([SHIFT, 0.0]),
            };
            let friction = Friction::coulomb(f64::INFINITY)?.with_coupling(Coupling::None);
            let found = hold(operator.as_mut(), &sphere_gap(&grid)?, &friction, loading, None)?;
            Ok([relative(found.force()[0], PI * SHIFT / (thickness * shear))])
        })
    },
};

/// A cylinder on two layers thin compared with the contact, on a rigid body, in line contact: foundations in series, apart
/// from an edge as wide as the layers are thick. It is pressed, P' = 2a³/3R(t₁/M₁ + t₂/M₂), then held and pushed along its
/// axis by s, Q' = 2as/(t₁/G₁ + t₂/G₂).
pub(super) const LINE: Case = Case {
    name: "Layered body: cylinder on two thin layers, periodic along it alone",
    source: "Johnson (1985), section 5.8",
    checks: || {
        const SHIFT: f64 = 1e-3;
        let [normal, shear] = [in_series(foundation), in_series(|young, nu| young / (2.0 * (1.0 + nu)))];
        let checks = [
            ("peak pressure", Expected::Order { order: 1.5..=2.4, finest: 1e-3 }),
            ("approach", Expected::Order { order: 1.4..=2.4, finest: 1e-3 }),
            ("pressure along the line", Expected::RoundOff(1e-9)),
            ("force along the axis", Expected::Order { order: 0.8..=1.3, finest: 0.05 }),
        ];
        study("a/t", &[4, 8, 16], checks, |n| {
            let thickness = 1.0 / n as f64;
            let grid = Grid::new([10 * n, 2], [0.25 * thickness; 2])?;
            let gap = -Form::Cylinder { radius: RADIUS, axis: Axis::Y }.on(&grid)?.into_heights();
            let body = layered([RIGID, 0.0], &of_thickness(&TWO, thickness))?;
            let operators = Operators::new(grid, body, Boundary([Edge::Free, Edge::Periodic]));
            let length = grid.extent()[1];
            let load = Control::Load(length * 2.0 / (3.0 * RADIUS * thickness * normal));
            let solution = press(operators.on(grid.shape).as_mut(), &gap, Pascal::INFINITY, load)?;
            let peak = (2.0 * RADIUS * thickness * normal).recip();
            let along = solution.pressure.outer_iter().map(|row| row[1] - row[0]);
            let loading = Loading { normal: load, tangential: Tangential::Displacement([0.0, SHIFT]) };
            let friction = Friction::coulomb(f64::INFINITY)?.with_coupling(Coupling::None);
            let held = hold(operators.coupled_on(grid.shape).as_mut(), &gap, &friction, loading, None)?;
            Ok([
                relative(solution.max_pressure(), peak),
                relative(solution.approach, 0.5 / RADIUS),
                along.fold(0.0, |most: f64, error| most.max(error.abs())) / peak,
                relative(held.force()[1], length * 2.0 * SHIFT / (thickness * shear)),
            ])
        })
    },
};

/// An incompressible thin layer: it flows as between two planes, p = 3G(a² − r²)²/32Rt³.
pub(super) const INCOMPRESSIBLE: Case = Case {
    name: "Coated half-space: thin incompressible layer on a rigid body",
    source: "Johnson (1985), section 5.8",
    checks: || {
        let young: f64 = 1.0;
        let checks = [
            ("peak pressure", Expected::Order { order: 1.5..=2.2, finest: 0.05 }),
            ("approach", Expected::Order { order: 1.4..=2.2, finest: 0.05 }),
        ];
        thin_layers(checks, &[[1.0, young, 0.5]], |thickness| {
            let peak = young / (32.0 * RADIUS * thickness.powi(3));
            [PI / 3.0 * peak, peak, 0.25 / RADIUS]
        })
    },
};

/// Returns layers of a total thickness, of which each has its share.
fn of_thickness(layers: &[[f64; 3]], thickness: f64) -> Vec<[f64; 3]> {
    layers.iter().map(|[share, young, poisson]| [share * thickness, *young, *poisson]).collect()
}

/// A sphere on layers with the total thickness t = a/n on a rigid body, each with its share of it. The load is that at
/// which the contact radius is a = 1 for t → 0. `limit` returns load, peak pressure and approach in this limit.
fn thin_layers(
    checks: [(&'static str, Expected); 2],
    layers: &[[f64; 3]],
    limit: impl Fn(f64) -> [f64; 3],
) -> Result<Vec<Check>> {
    study("a/t", &[4, 8, 16], checks, |n| {
        let thickness = 1.0 / n as f64;
        let grid = Grid::new([10 * n; 2], [0.25 * thickness; 2])?;
        let [load, peak, approach] = limit(thickness);
        let mut operator = FreeFft::new(grid, layered([RIGID, 0.0], &of_thickness(layers, thickness))?);
        let solution = press(&mut operator, &sphere_gap(&grid)?, Pascal::INFINITY, Control::Load(load))?;
        Ok([relative(solution.max_pressure(), peak), relative(solution.approach, approach)])
    })
}
