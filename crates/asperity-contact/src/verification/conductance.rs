//! Contact conductance.

use std::f64::consts::{PI, TAU};

use ndarray::Array2;

use super::{Case, Expected, relative, study};
use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::math::elliptic::CompleteElliptic;
use crate::operator::{FreeFft, Operator, PeriodicFft};
use crate::solver::{Bounds, Control, Method, Params, solve_normal};
use crate::with::conductance::{
    Bracket, Conductor, Joint, Kind, composite_conductivity, full_resistance, response, solve,
};

const PARAMS: Params = Params::new().with_method(Method::ActiveSet).with_tolerance(1e-9);
/// Clean spots on bodies of conductivity 1.
const CLEAN: Joint = Joint::new(Kind::Thermal);

fn unit(n: usize) -> Result<Grid> {
    Grid::new([n, n], [1.0 / n as f64; 2])
}

fn conductance(operator: &mut dyn Operator, touching: &Array2<bool>, joint: &Joint) -> Result<f64> {
    Ok(solve(operator, touching, None, joint, None, &PARAMS)?.conductance.unwrap_or(f64::INFINITY))
}

/// Cells of a grid on the unit square with centres in an ellipse of half axes a and b around `x`, ½.
fn ellipse(grid: &Grid, x: f64, [a, b]: [f64; 2]) -> Array2<bool> {
    Array2::from_shape_fn(grid.shape, |(i, j)| {
        ((grid.centre(0, i) - x) / a).powi(2) + ((grid.centre(1, j) - 0.5) / b).powi(2) < 1.0
    })
}

/// Radius of a disc with the area of these cells.
fn radius(grid: &Grid, cells: &Array2<bool>) -> f64 {
    (grid.cell_area() * cells.iter().filter(|cell| **cell).count() as f64 / PI).sqrt()
}

/// A square, an ellipse and a disc, whose conductance is their electrostatic capacity: the flux grows as
/// 1/√distance at the rim, which leaves order 1. The disc is compared with that of the same area.
pub(super) const SPOTS: Case = Case {
    name: "conductance of spots: square, disc, ellipse 2 : 1",
    source: "G = 2κₛa, πκₛa/K(e); capacity of a square: Read, J. Comput. Phys. 133, 1 (1997)",
    checks: || {
        let order = |finest: f64| Expected::Order { order: 0.8..=1.25, finest };
        let checks = [("square", order(6e-3)), ("disc", order(5e-3)), ("ellipse", order(1e-2))];
        study("cells a side", &[16, 32, 64], checks, |n| {
            let grid = unit(n)?;
            let mut operator = FreeFft::new(grid, 1.0);
            let square = conductance(&mut operator, &Array2::from_elem(grid.shape, true), &CLEAN)?;
            let round = ellipse(&grid, 0.5, [0.4; 2]);
            let disc = conductance(&mut operator, &round, &CLEAN)?;
            let long = ellipse(&grid, 0.5, [0.48, 0.24]);
            // The ellipse of the same area.
            let a = 2f64.sqrt() * radius(&grid, &long);
            let exact = PI * a / CompleteElliptic::of_complement(0.5).first;
            Ok([
                relative(square, PI * CAPACITY),
                relative(disc, 2.0 * radius(&grid, &round)),
                relative(conductance(&mut operator, &long, &CLEAN)?, exact),
            ])
        })
    },
};

/// Capacity of a square plate over 4πε₀ times its side.
const CAPACITY: f64 = 0.366_789_158_69;

/// Two discs constrict each other as two points do, to the second power of radius over distance and further.
pub(super) const PAIR: Case = Case {
    name: "conductance: two spots",
    source: "Holm (1967): R = 1/4κₛa + 1/2πκₛs",
    checks: || {
        let checks = [("resistance", Expected::Order { order: 1.5..=3.5, finest: 1e-3 })];
        study("distance/radius", &[2, 4, 8], checks, |distance| {
            let grid = unit(128)?;
            let mut operator = FreeFft::new(grid, 1.0);
            let a = 7.5 / 128.0;
            let half = (0.5 * distance as f64 * a * 128.0).ceil().max(8.0) / 128.0;
            let [one, other] = [-half, half].map(|at| ellipse(&grid, 0.5 + at, [a; 2]));
            let single = conductance(&mut operator, &one, &CLEAN)?;
            let both = &one | &other;
            let exact = 0.5 / single + 1.0 / (TAU * 2.0 * half);
            Ok([relative(conductance(&mut operator, &both, &CLEAN)?.recip(), exact)])
        })
    },
};

/// A square spot on a free grid and on one that repeats itself: its images, which a uniform flux into the
/// mean plane balances, take 3.9002649/πκₛL of its resistance as it becomes small. Values on 64 and 128 cells
/// are extrapolated.
pub(super) const LATTICE: Case = Case {
    name: "conductance: free less periodic",
    source: "constant of the square lattice: Bonsall and Maradudin (1977)",
    checks: || {
        let checks = [("resistance", Expected::Order { order: 1.8..=2.2, finest: 1e-2 })];
        study("period/side", &[2, 4, 8], checks, |ratio| {
            let difference = |n: usize| -> Result<f64> {
                let grid = unit(n)?;
                let inside = |i: usize| (2 * i + 1).abs_diff(n) * ratio < n;
                let spot = Array2::from_shape_fn(grid.shape, |(i, j)| inside(i) && inside(j));
                let free = conductance(&mut FreeFft::new(grid, 1.0), &spot, &CLEAN)?;
                let periodic = conductance(&mut PeriodicFft::new(grid, 1.0), &spot, &CLEAN)?;
                Ok(free.recip() - periodic.recip())
            };
            let extrapolated = 2.0 * difference(128)? - difference(64)?;
            Ok([relative(extrapolated, LATTICE_CONSTANT / PI)])
        })
    },
};

/// Potential of a square lattice of unit charges in a neutral background, at one of them, without its own,
/// times −1.
const LATTICE_CONSTANT: f64 = 3.900_264_9;

/// Through a thick film on a disc the flux is uniform, and the bodies have the resistance of a uniform flux.
pub(super) const FILM: Case = Case {
    name: "conductance: film on a disc",
    source: "(R − ρ/A) a → 16/3π²κₛ, Carslaw and Jaeger (1959), section 8.2",
    checks: || {
        let checks = [("resistance", Expected::Order { order: 0.7..=1.2, finest: 2e-3 })];
        study("ρκₛ/a", &[1, 4, 16], checks, |film| {
            let grid = unit(96)?;
            let disc = ellipse(&grid, 0.5, [0.45; 2]);
            let a = radius(&grid, &disc);
            let film = film as f64 * a;
            let mut operator = FreeFft::new(grid, 1.0);
            let found = conductance(&mut operator, &disc, &CLEAN.with_film(film))?;
            Ok([relative((found.recip() - film / (PI * a * a)) * a, 16.0 / (3.0 * PI * PI))])
        })
    },
};

/// Gas in a gap without contact: of an even gap, and of one with a wave, between bodies that conduct much
/// better and much worse than it.
pub(super) const GAS: Case = Case {
    name: "conductance: gas in a gap",
    source: "h = κ/(g + M); means of it and of its inverse",
    checks: || {
        let order = || Expected::Order { order: 0.9..=1.1, finest: 1e-3 };
        let checks = [
            ("even gap", Expected::RoundOff(1e-9)),
            ("parallel: bodies conduct better", order()),
            ("in series: gas conducts better", order()),
        ];
        study("ratio of resistances", &[30, 300, 3000], checks, |ratio| {
            let grid = Grid::new([32, 48], [1.0 / 32.0, 1.0 / 48.0])?;
            let open = Array2::from_elem(grid.shape, false);
            let resistance = |i: usize| 1.0 + 0.5 * (TAU * i as f64 / 32.0).sin();
            // A gap of g + M with M = ½.
            let wave = Field::from_shape_fn(grid.shape, |(i, _)| resistance(i) - 0.5);
            let gas_of = |conductivity: f64, gap: &Field| -> Result<f64> {
                let joint = CLEAN.with_gas(conductivity, 0.5);
                let mut operator = PeriodicFft::new(grid, 1.0);
                let found = solve(&mut operator, &open, Some(gap), &joint, None, &PARAMS)?;
                Ok(found.joint_conductance(None).unwrap_or(f64::INFINITY) / conductivity)
            };
            let means = [
                (0..32).map(|i| resistance(i).recip()).sum::<f64>() / 32.0,
                32.0 / (0..32).map(resistance).sum::<f64>(),
            ];
            let ratio = ratio as f64;
            Ok([
                relative(gas_of(ratio, &(grid.zeros() + 0.8))?, 1.0 / 1.3),
                relative(gas_of(ratio.recip(), &wave)?, means[0]),
                relative(gas_of(ratio, &wave)?, means[1]),
            ])
        })
    },
};

/// A disc on a layer that is thin or thick against it has the conductance of the half-space below or of the
/// layer.
pub(super) const COATED: Case = Case {
    name: "conductance: disc on a coated body",
    source: "κₛ of the layer and of the body below it",
    checks: || {
        let order = |finest: f64| Expected::Order { order: 0.7..=1.3, finest };
        let checks = [("thick layer", order(2e-3)), ("thin layer", order(1.5e-2))];
        study("ratio to the radius", &[8, 32, 128], checks, |ratio| {
            let grid = unit(32)?;
            let disc = ellipse(&grid, 0.5, [0.4; 2]);
            let (body, layer, other) = (4.0, 1.5, Conductor::new(2.0)?);
            let of = |thickness: f64, alike: f64| -> Result<f64> {
                let coated = Conductor::new(body)?.coated(thickness, layer)?;
                let found = conductance(&mut FreeFft::new(grid, response(&coated, &other)?), &disc, &CLEAN)?;
                let composite = composite_conductivity(alike, other.conductivity)?;
                Ok(relative(found, conductance(&mut FreeFft::new(grid, composite), &disc, &CLEAN)?))
            };
            Ok([of(0.4 * ratio as f64, layer)?, of(0.4 / ratio as f64, body)?])
        })
    },
};

/// A wavy surface under loads around one: the secants of load over approach enclose its conductance, and
/// their mean comes to it. The resistance of a full contact is that of the grid.
pub(super) const BARBER: Case = Case {
    name: "conductance: Barber's relation",
    source: "Barber (2003): G = κₛ/E* dW/dδ",
    checks: || {
        let checks = [
            ("mean of both secants, 6 % of contact", Expected::Counted(0.5)),
            ("mean of both secants, 25 % of contact", Expected::Counted(0.5)),
            ("full contact, free", Expected::RoundOff(1e-8)),
        ];
        study("load/change of load", &[50, 100], checks, |inverse| {
            let (grid, modulus, composite) = (unit(64)?, 1.0, 3.0);
            let gap = Field::from_shape_fn(grid.shape, |(i, j)| {
                let [x, y] = [i, j].map(|index| TAU * index as f64 / 64.0);
                0.01 * ((x + y).cos()
                    + (2.0 * x - y).sin()
                    + 0.4 * (3.0 * y).cos()
                    + 0.3 * (5.0 * x + 4.0 * y).sin())
            });
            let error = |load: f64| -> Result<f64> {
                let mut operator = PeriodicFft::new(grid, modulus);
                let mut points = Vec::new();
                let mut touching = Array2::from_elem(grid.shape, false);
                for step in [-1.0, 0.0, 1.0] {
                    let control = Control::Load(load * (1.0 + step / inverse as f64));
                    let found = solve_normal(&mut operator, &gap, &Bounds::ELASTIC, control, None, &PARAMS)?;
                    points.push((found.load(), found.approach));
                    if step == 0.0 {
                        touching = found.pressure.mapv(|pressure| pressure > 0.0);
                    }
                }
                let bracket = Bracket::of_sweep(&points, composite, modulus)[1];
                let found = conductance(&mut PeriodicFft::new(grid, composite), &touching, &CLEAN)?;
                let mean = 0.5 * (bracket.lower + bracket.upper);
                // Outside its bracket it is no conductance.
                Ok(if bracket.holds(found, 1e-6) { relative(found, mean) } else { f64::NAN })
            };
            let mut free = FreeFft::new(grid, 1.0);
            let all = conductance(&mut free, &Array2::from_elem(grid.shape, true), &CLEAN)?;
            let full = full_resistance(&mut free, &PARAMS)?.unwrap_or(f64::NAN);
            Ok([error(0.005)?, error(0.03)?, relative(all * full, 1.0)])
        })
    },
};
