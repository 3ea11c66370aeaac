//! A smooth body on a plane.

use std::f64::consts::PI;

use super::{Case, Check, Expected, PARAMS, largest, press, relative, relative_rms, study};
use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::operator::{Boundary, Edge, FreeFamily, FreeFft, PeriodicFft};
use crate::reference::{FlatPunch, HertzEllipse, HertzLine, HertzSphere};
use crate::solver::{Bounds, Control, Method, solve_normal};
use crate::surface::{Axis, Form};
use crate::units::Metre;

const ELASTIC: f64 = f64::INFINITY;
pub(super) const RADIUS: Metre = 4.0;
pub(super) const MODULUS: f64 = 5.0;
pub(super) const PUNCH_RADIUS: Metre = 1.0;
pub(super) const LINE_HALF_WIDTH: Metre = 0.5;
/// Period of the cylinders, in [`LINE_HALF_WIDTH`].
const PERIOD: usize = 32;

/// The apex is where four cells meet, and the peak pressure is that of an adjacent cell. Of its error, about
/// (Δx/2a)² is due to the distance to the apex. In the energy at a given load the contributions of orders 2
/// and 3 have similar size.
pub(super) const SPHERE: Case =
    Case { name: "Hertz: sphere", source: "Hertz (1882); Johnson (1985), eqs. 4.22–4.24", checks: sphere };

fn sphere() -> Result<Vec<Check>> {
    let hertz = HertzSphere { radius: RADIUS, modulus: MODULUS, load: 7.0 };
    let a = hertz.contact_radius();
    let second = |finest| Expected::Order { order: 1.8..=2.2, finest };
    let checks = [
        ("peak pressure", second(1e-4)),
        ("approach", second(1e-4)),
        ("elastic energy", Expected::Order { order: 1.8..=3.0, finest: 1e-4 }),
        ("pressure, rms", Expected::Order { order: 0.8..=1.2, finest: 1e-2 }),
        ("contact area", Expected::Counted(1.0)),
    ];
    study("a/Δx", &[8, 16, 32, 64], checks, |n| {
        let grid = Grid::new([3 * n; 2], [a / n as f64; 2])?;
        let gap = sphere_gap(&grid)?;
        let solution = press(&mut FreeFft::new(grid, MODULUS), &gap, ELASTIC, Control::Load(hertz.load))?;
        let exact = gap.mapv(|h| hertz.pressure((2.0 * RADIUS * h).sqrt()));
        let area = solution.contact_cells() as f64 * grid.cell_area();
        Ok([
            relative(solution.max_pressure(), hertz.peak_pressure()),
            relative(solution.approach, hertz.approach()),
            relative(solution.elastic_energy(), hertz.elastic_energy()),
            relative_rms(&solution.pressure, &exact),
            relative(area, PI * a * a),
        ])
    })
}

/// Gap under a sphere of [`RADIUS`] in the middle of the grid.
pub(super) fn sphere_gap(grid: &Grid) -> Result<Field> {
    Ok(-Form::Sphere { radius: RADIUS }.on(grid)?.into_heights())
}

/// An ellipsoid with radii of curvature in the ratio 1 to 4, with equal numbers of cells along each semi-axis
/// of the contact.
pub(super) const ELLIPSOID: Case = Case {
    name: "Hertz: ellipsoid, radii 1 : 4",
    source: "Hertz (1882); Johnson (1985), eqs. 4.25–4.32",
    checks: ellipsoid,
};

fn ellipsoid() -> Result<Vec<Check>> {
    let radii = [0.5 * RADIUS, 2.0 * RADIUS];
    let hertz = HertzEllipse::new(radii, MODULUS, 7.0);
    let second = |finest| Expected::Order { order: 1.8..=2.2, finest };
    let checks = [
        ("peak pressure", second(1e-4)),
        ("approach", second(1e-4)),
        ("pressure, rms", Expected::Order { order: 0.8..=1.2, finest: 1e-2 }),
        ("contact area", Expected::Counted(1.0)),
    ];
    study("a/Δx", &[8, 16, 32, 64], checks, |n| {
        let grid = Grid::new([3 * n; 2], hertz.semi_axes.map(|a| a / n as f64))?;
        let gap = -Form::Ellipsoid { radius: radii }.on(&grid)?.into_heights();
        let solution = press(&mut FreeFft::new(grid, MODULUS), &gap, ELASTIC, Control::Load(hertz.load))?;
        let [x0, y0] = grid.extent().map(|length| 0.5 * length);
        let exact = Field::from_shape_fn(grid.shape, |(i, j)| {
            hertz.pressure(grid.centre(0, i) - x0, grid.centre(1, j) - y0)
        });
        let area = solution.contact_cells() as f64 * grid.cell_area();
        Ok([
            relative(solution.max_pressure(), hertz.peak_pressure),
            relative(solution.approach, hertz.approach),
            relative_rms(&solution.pressure, &exact),
            relative(area, hertz.contact_area()),
        ])
    })
}

/// A cylinder on a boundary that is periodic along its axis and free across: a line contact without ends or
/// neighbours. The approach is relative to r₀, the width of the grid. Everything is uniform along the line.
pub(super) const LINE_ALONE: Case = Case {
    name: "Hertz: cylinder, periodic along it alone",
    source: "Johnson (1985), eqs. 4.43–4.45",
    checks: line_alone,
};

fn line_alone() -> Result<Vec<Check>> {
    let a = LINE_HALF_WIDTH;
    let load_per_length = PI * MODULUS * a * a / (4.0 * RADIUS);
    let hertz = HertzLine { radius: RADIUS, modulus: MODULUS, load_per_length };
    let second = |finest| Expected::Order { order: 1.8..=2.2, finest };
    let checks = [
        ("peak pressure", second(1e-4)),
        ("approach", second(1e-4)),
        ("pressure, rms", Expected::Order { order: 0.8..=1.2, finest: 1e-2 }),
        ("contact width", Expected::Counted(1.0)),
        ("pressure along the line", Expected::RoundOff(1e-12)),
    ];
    study("a/Δx", &[16, 32, 64, 128], checks, |n| {
        let grid = Grid::new([3 * n, 3], [a / n as f64; 2])?;
        let gap = -Form::Cylinder { radius: RADIUS, axis: Axis::Y }.on(&grid)?.into_heights();
        let load = Control::Load(load_per_length * grid.extent()[1]);
        let boundary = Boundary([Edge::Free, Edge::Periodic]);
        let mut operator = FreeFamily::new(&grid, MODULUS, boundary).operator(grid.shape);
        let params = PARAMS.with_method(Method::Direct);
        let solution = solve_normal(&mut operator, &gap, &Bounds::ELASTIC, load, None, &params)?;
        let exact = gap.mapv(|h| hertz.pressure((2.0 * RADIUS * h).sqrt()));
        let width = solution.contact_cells() as f64 * grid.cell_area() / grid.extent()[1];
        let along = solution.pressure.outer_iter().flat_map(|row| row.mapv(|p| p - row[0]));
        Ok([
            relative(solution.max_pressure(), hertz.peak_pressure()),
            relative(solution.approach, hertz.approach(grid.extent()[0])),
            relative_rms(&solution.pressure, &exact),
            relative(width, 2.0 * a),
            largest(&along.collect::<Vec<_>>()) / hertz.peak_pressure(),
        ])
    })
}

/// A cylinder on a periodic grid one cell wide, with the influence of its neighbours.
///
/// The other lines of contact, a period L away, act like a curvature: (π/L) cot(πt/L) = 1/t − π²t/3L² − …,
/// where the second term is linear in x for any pressure. The contact is Hertz's with R′ = R (1 − π²a²/6L²),
/// apart from terms of (a/L)⁴ = 1e-6.
pub(super) const LINE: Case =
    Case { name: "Hertz: cylinder, period 32 a", source: "Johnson (1985), eqs. 4.43–4.45", checks: line };

fn line() -> Result<Vec<Check>> {
    let hertz = line_of(LINE_HALF_WIDTH);
    let checks = [
        ("peak pressure", Expected::Order { order: 1.8..=2.2, finest: 1e-4 }),
        ("pressure, rms", Expected::Order { order: 0.8..=1.2, finest: 1e-2 }),
        ("contact width", Expected::Counted(1.0)),
    ];
    study("a/Δx", &[16, 32, 64, 128], checks, |n| {
        let (grid, gap) = line_gap(n)?;
        let load = Control::Load(hertz.load_per_length * grid.pitch[1]);
        let solution = press(&mut PeriodicFft::new(grid, MODULUS), &gap, ELASTIC, load)?;
        let exact = gap.mapv(|h| hertz.pressure((2.0 * RADIUS * h).sqrt()));
        let width = solution.contact_cells() as f64 * grid.pitch[0];
        Ok([
            relative(solution.max_pressure(), hertz.peak_pressure()),
            relative_rms(&solution.pressure, &exact),
            relative(width, 2.0 * LINE_HALF_WIDTH),
        ])
    })
}

/// The contact of that cylinder with the half width `a`, curved by its images.
pub(super) fn line_of(a: Metre) -> HertzLine {
    let radius = RADIUS * (1.0 - (PI * a / (PERIOD as f64 * LINE_HALF_WIDTH)).powi(2) / 6.0);
    HertzLine { radius, modulus: MODULUS, load_per_length: PI * MODULUS * a * a / (4.0 * radius) }
}

/// Grid and gap of a line contact, `n` cells along [`LINE_HALF_WIDTH`].
pub(super) fn line_gap(n: usize) -> Result<(Grid, Field)> {
    let grid = Grid::new([PERIOD * n, 1], [LINE_HALF_WIDTH / n as f64; 2])?;
    Ok((grid, -Form::Cylinder { radius: RADIUS, axis: Axis::Y }.on(&grid)?.into_heights()))
}

/// The pressure is infinite at the edge, and the edge is a staircase: order 1.
pub(super) const PUNCH: Case =
    Case { name: "flat punch", source: "Boussinesq (1885); Johnson (1985), eqs. 3.34–3.37", checks: punch };

fn punch() -> Result<Vec<Check>> {
    let punch = FlatPunch::from_approach(PUNCH_RADIUS, MODULUS, 1e-3);
    let first = |finest| Expected::Order { order: 0.8..=1.3, finest };
    let checks = [("load", first(1e-2)), ("pressure on the axis", first(1e-2))];
    study("a/Δx", &[8, 16, 32, 64], checks, |n| {
        let (grid, gap) = flat_end(n)?;
        let solution =
            press(&mut FreeFft::new(grid, MODULUS), &gap, ELASTIC, Control::Approach(punch.approach()))?;
        Ok([relative(solution.load(), punch.load), relative(solution.pressure[[n, n]], punch.pressure(0.0))])
    })
}

/// Grid and gap of a flat punch of [`PUNCH_RADIUS`], with `n` cells along it and one in its middle.
pub(super) fn flat_end(n: usize) -> Result<(Grid, Field)> {
    let grid = Grid::new([2 * n + 1; 2], [PUNCH_RADIUS / n as f64; 2])?;
    let inside = |i: usize, j: usize| {
        let [x, y] = [i, j].map(|k| k as f64 - n as f64);
        x * x + y * y <= (n * n) as f64
    };
    let gap = Field::from_shape_fn(grid.shape, |(i, j)| if inside(i, j) { 0.0 } else { 1.0 });
    Ok((grid, gap))
}
