//! The stress under the surface.

use std::f64::consts::PI;

use super::{Case, Check, Expected, press, relative, study};
use crate::error::Result;
use crate::grid::Grid;
use crate::kernel::{Traction, cell_stress};
use crate::operator::{Boundary, FreeFft};
use crate::reference::{HertzSphere, SlidingSphere};
use crate::solver::Control;
use crate::stress::Stress;
use crate::subsurface::{Subsurface, Tractions};
use crate::surface::Form;

/// A rectangle of n × n cells under uniform tractions: superposition leaves no error. The comparison with n ×
/// n point loads is the midpoint rule, of order 2. It uses their tractions on planes of constant depth, and
/// the sum of their normal stresses, which are the simplest of Boussinesq's and Cerruti's equations.
pub(super) const LOADED_RECTANGLE: Case = Case {
    name: "Love: stress under a loaded rectangle",
    source: "Love (1929); Johnson (1985), eqs. 3.19, 3.76",
    checks: rectangle,
};

fn rectangle() -> Result<Vec<Check>> {
    let (sides, poisson, depth) = ([1.5e-6, 1e-6], 0.3, 0.4e-6);
    let [qx, qy, p] = [0.3e9, -0.2e9, 1e9];
    let checks = [
        ("cells, free FFT", Expected::RoundOff(1e-13)),
        ("point loads", Expected::Order { order: 1.9..=2.1, finest: 2e-3 }),
    ];
    study("cells a side", &[8, 16, 32], checks, |n| {
        let grid = Grid::new([n, n], sides.map(|side| side / n as f64))?;
        let uniform = |value: f64| grid.zeros() + value;
        let tractions = Tractions { pressure: uniform(p), shear: [Some(uniform(qx)), Some(uniform(qy))] };
        let plane = Subsurface::new(grid, Boundary::FREE, poisson, &tractions).plane(depth);
        let [mut by_cells, mut by_points] = [0.0f64; 2];
        for (i, j) in ndarray::indices(grid.shape) {
            let at = [grid.centre(0, i) - 0.5 * sides[0], grid.centre(1, j) - 0.5 * sides[1]];
            let exact = [(qx, Traction::X), (qy, Traction::Y), (p, Traction::Pressure)]
                .map(|(value, traction)| value * cell_stress(at, depth, sides, poisson, traction))
                .into_iter()
                .fold(Stress::default(), std::ops::Add::add);
            by_cells = by_cells.max(apart(plane.stress([i, j]), exact) / p);
            let points = ndarray::indices(grid.shape).into_iter().fold([0.0; 4], |sum, (k, l)| {
                let from = [grid.centre(0, k) - 0.5 * sides[0], grid.centre(1, l) - 0.5 * sides[1]];
                let to = [at[0] - from[0], at[1] - from[1], depth];
                let load = point_load([qx, qy, p].map(|q| q * grid.cell_area()), to, poisson);
                std::array::from_fn(|m| sum[m] + load[m])
            });
            let exact = [exact.xz, exact.yz, exact.zz, exact.xx + exact.yy + exact.zz];
            by_points = (0..4).fold(by_points, |most, m| most.max((points[m] - exact[m]).abs() / p));
        }
        Ok([by_cells, by_points])
    })
}

/// σxz, σyz, σzz and σxx + σyy + σzz at `to` from the force F: −3z(F·R)R/2πR⁵ and −(1 + ν)(F·R)/πR³.
fn point_load(force: [f64; 3], to: [f64; 3], poisson: f64) -> [f64; 4] {
    let along: f64 = (0..3).map(|i| force[i] * to[i]).sum();
    let square: f64 = to.iter().map(|t| t * t).sum();
    let [x, y, z] = to.map(|t| -3.0 * to[2] * along * t / (2.0 * PI * square.powf(2.5)));
    [x, y, z, -(1.0 + poisson) * along / (PI * square.powf(1.5))]
}

fn apart(a: Stress, b: Stress) -> f64 {
    a.components().iter().zip(b.components()).fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}

/// The pressure is that of the solver, uniform in each cell. Under the surface its steps are smoothed: order
/// 2.
pub(super) const SPHERE: Case = Case {
    name: "Hertz: stress under a sphere",
    source: "Hamilton & Goodman (1966); Johnson (1985), section 3.4",
    checks: || sliding(0.0, second(1e-3)),
};

/// The most stressed point below a sphere in full slip, q = p/4, which has moved upwards and in the direction
/// of the traction. It is searched at the centres of cells only. If it lies between them, its depth is that
/// of its neighbour, with an error proportional to Δx.
pub(super) const SLIDING_SPHERE: Case = Case {
    name: "Hamilton: stress under a sliding sphere, friction 0.25",
    source: "Hamilton & Goodman (1966); Hamilton (1983)",
    checks: || sliding(0.25, Expected::Counted(0.1)),
};

/// Order 2.
fn second(finest: f64) -> Expected {
    Expected::Order { order: 1.6..=2.6, finest }
}

fn sliding(friction: f64, its_depth: Expected) -> Result<Vec<Check>> {
    const RADIUS: f64 = 4.0;
    const MODULUS: f64 = 5.0;
    let hertz = HertzSphere { radius: RADIUS, modulus: MODULUS, load: 7.0 };
    let contact = SlidingSphere { normal: hertz, friction, poisson: 0.3 };
    let (a, p0) = (hertz.contact_radius(), hertz.peak_pressure());
    let [most, depth] = most_stressed(&contact);
    let checks = [
        ("stress at depth a/2, rms", second(1e-3)),
        ("stress at depth a/8, rms", second(1e-2)),
        ("largest von Mises stress", second(1e-3)),
        ("its depth", its_depth),
    ];
    study("a/Δx", &[6, 12, 24, 48], checks, |n| {
        let grid = Grid::new([3 * n; 2], [a / n as f64; 2])?;
        let gap = -Form::Sphere { radius: RADIUS }.on(&grid)?.into_heights();
        let solution =
            press(&mut FreeFft::new(grid, MODULUS), &gap, f64::INFINITY, Control::Load(hertz.load))?;
        let pressure = solution.pressure;
        let shear = (friction > 0.0).then(|| friction * &pressure);
        let body = Subsurface::new(grid, Boundary::FREE, 0.3, &Tractions { pressure, shear: [shear, None] });
        let rms = |depth: f64| {
            let plane = body.plane(depth);
            let [mut error, mut scale] = [0.0; 2];
            for (i, j) in ndarray::indices(grid.shape) {
                let [x, y] = [grid.centre(0, i) - 1.5 * a, grid.centre(1, j) - 1.5 * a];
                let exact = contact.stress([x, y], depth).components();
                for (found, exact) in plane.stress([i, j]).components().iter().zip(exact) {
                    error += (found - exact).powi(2);
                    scale += exact * exact;
                }
            }
            (error / scale).sqrt()
        };
        let depths: Vec<f64> = (1..=12).map(|k| 0.08 * a * f64::from(k)).collect();
        let found = body.maximum(&depths).von_mises;
        Ok([rms(0.5 * a), rms(0.125 * a), relative(found.value, most * p0), relative(found.depth, depth * a)])
    })
}

/// The largest von Mises stress under `contact`, over p₀, and its depth over a, by a search that halves its
/// steps.
fn most_stressed(contact: &SlidingSphere) -> [f64; 2] {
    let (a, p0) = (contact.normal.contact_radius(), contact.normal.peak_pressure());
    let at = |[x, z]: [f64; 2]| contact.stress([x * a, 0.0], z * a).von_mises() / p0;
    let (mut place, mut step) = ([0.0, 0.5], 0.1);
    while step > 1e-9 {
        let [x, z] = place;
        let around = [[x + step, z], [x - step, z], [x, z + step], [x, z - step]];
        match around.into_iter().find(|next| at(*next) > at(place)) {
            Some(better) => place = better,
            None => step *= 0.5,
        }
    }
    [at(place), place[1]]
}
