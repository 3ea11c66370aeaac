//! Dissimilar bodies: pressure and shear are coupled.

use super::{
    Case, Check, Expected, hold, largest, press, relative, relative_max, relative_rms, rough, smooth, study,
};
use crate::error::Result;
use crate::grid::Grid;
use crate::material::{Compliances, Material};
use crate::operator::{Boundary, Operators};
use crate::reference::spence::{COUPLED, CoupledPunch, stick_ratio};
use crate::reference::{FlatPunch, StickingPunch, StickingSphere};
use crate::solver::{Control, Coupling, Friction, FrictionalSolution, Loading, Tangential};
use crate::units::{Metre, Newton};

const APPROACH: Metre = 1e-3;

/// Identical bodies, for which the coupling vanishes: the pressure is that of [`solve_normal`], cell by cell.
///
/// [`solve_normal`]: crate::solver::solve_normal
pub(super) const IDENTICAL: Case =
    Case { name: "identical bodies: uncoupled", source: "Johnson (1985), section 5.4", checks: identical };

fn identical() -> Result<Vec<Check>> {
    let body = Material::elastic(rough::MODULUS, 0.3)?;
    let pair = Compliances::new(&body, &body)?;
    let exact = Expected::RoundOff(1e-14);
    let checks = ["pressure, free", "shear, free", "pressure, periodic", "shear, periodic"];
    study("cells a side", &[16, 32, 64], checks.map(|name| (name, exact.clone())), |n| {
        let grid = Grid::new([n; 2], [1.0; 2])?;
        let gap = rough::rough_gap(&grid)?;
        let load = 0.05 * pair.modulus() * rough::SLOPE * grid.area();
        let [free, periodic] = [Boundary::FREE, Boundary::PERIODIC].map(|boundary| -> Result<_> {
            let mut operator = Operators::new(grid, pair, boundary).coupled_on(grid.shape);
            let alone = press(operator.normal(), &gap, f64::INFINITY, Control::Load(load))?;
            let pushed = Loading {
                normal: Control::Load(load),
                tangential: Tangential::Force([0.15 * load, -0.05 * load]),
            };
            let [full, none] = [Coupling::Full, Coupling::None].map(|coupling| {
                let friction = Friction { coupling, ..Friction::coulomb(0.3)? };
                hold(operator.as_mut(), &gap, &friction, pushed, None)
            });
            let (full, none) = (full?, none?);
            let shear = [0, 1].map(|axis| relative_max(&full.shear[axis], &none.shear[axis]));
            Ok([relative_max(&full.normal.pressure, &alone.pressure), largest(&shear)])
        });
        let [[free, free_shear], [periodic, periodic_shear]] = [free?, periodic?];
        Ok([free, free_shear, periodic, periodic_shear])
    })
}

/// Slightly dissimilar bodies pressed together: the shear is of order β, its effect on the pressure of order
/// β².
pub(super) const ALMOST_IDENTICAL: Case = Case {
    name: "almost identical bodies: W alone",
    source: "Johnson (1985), section 5.4",
    checks: || {
        let grid = Grid::new([32; 2], [1.0; 2])?;
        let gap = rough::rough_gap(&grid)?;
        let load = 0.05 * rough::SLOPE * grid.area();
        let checks = [
            ("pressure, as β²", Expected::Order { order: 1.8..=2.2, finest: 1e-3 }),
            ("shear, as β", Expected::Order { order: 0.8..=1.2, finest: 1e-1 }),
        ];
        study("1/β", &[10, 20, 40, 80], checks, |inverse| {
            let pair = under_rigid(1.0 / inverse as f64)?;
            let mut operator = Operators::new(grid, pair, Boundary::FREE).coupled_on(grid.shape);
            let alone = press(operator.normal(), &gap, f64::INFINITY, Control::Load(load))?;
            let loading = Loading { normal: Control::Load(load), tangential: Tangential::Force([0.0; 2]) };
            let solution = hold(operator.as_mut(), &gap, &Friction::coulomb(0.3)?, loading, None)?;
            let shear = solution.shear.iter().flatten().map(|q| q * q).sum::<f64>();
            let pressure = alone.pressure.iter().map(|p| p * p).sum::<f64>();
            Ok([relative_rms(&solution.normal.pressure, &alone.pressure), (shear / pressure).sqrt()])
        })
    },
};

/// Like the punch without friction, of order 1.
pub(super) const NO_SLIP: Case = Case {
    name: "punch without slip: β = 0.3",
    source: "Mossakovskii (1954); Spence (1968)",
    checks: || {
        let exact = StickingPunch::from_approach(smooth::PUNCH_RADIUS, 1.0, 0.3, APPROACH);
        study("a/Δx", &[8, 16, 32, 64], [("load", first_order(1e-2))], |n| {
            let (_, load) = punch(n, 0.3, f64::INFINITY, Coupling::Full)?;
            Ok([relative(load, exact.load)])
        })
    },
};

/// Goodman's approximation, which has a closed form. Cells in contact and in stick are counted.
pub(super) const GOODMAN: Case = Case {
    name: "Spence's punch after Goodman: β = 0.3",
    source: "Goodman (1962); Spence (1968, 1975)",
    checks: || {
        let counted = Expected::Counted(1.0);
        let checks = ["c/a, μ = 0.1", "c/a, μ = 0.2", "c/a, μ = 0.4"].map(|name| (name, counted.clone()));
        study("a/Δx", &[8, 16, 32, 64], checks, |n| {
            let error = |friction| -> Result<f64> {
                let (solution, _) = punch(n, 0.3, friction, Coupling::Goodman)?;
                Ok(stick_share(&solution) - stick_ratio(friction, 0.3))
            };
            Ok([error(0.1)?, error(0.2)?, error(0.4)?])
        })
    },
};

/// With the effect of the shear on the pressure the stick area is smaller than Goodman's, here by 0.09 and
/// 0.1.
pub(super) const SPENCE: Case = Case {
    name: "Spence's punch: β = 0.5",
    source: "Spence (1975); numbers of an axisymmetric program",
    checks: || {
        let (counted, first) = (Expected::Counted(1.0), first_order(1e-2));
        let checks = [
            ("c/a, μ = 0.2", counted.clone()),
            ("load, μ = 0.2", first.clone()),
            ("c/a, μ = 0.4", counted),
            ("load, μ = 0.4", first),
        ];
        study("a/Δx", &[8, 16, 32, 64], checks, |n| {
            let errors = |friction| -> Result<[f64; 2]> {
                let exact = coupled(0.5, friction);
                let (solution, load) = punch(n, 0.5, friction, Coupling::Full)?;
                let frictionless = FlatPunch::from_approach(smooth::PUNCH_RADIUS, 1.0, APPROACH).load;
                Ok([
                    stick_share(&solution) - exact.stick_ratio,
                    relative(load / frictionless, exact.stiffening),
                ])
            };
            let ([little, load], [much, higher]) = (errors(0.2)?, errors(0.4)?);
            Ok([little, load, much, higher])
        })
    },
};

/// A growing self-similar contact: the stick ratio is that of the punch. In increments of the radius by two
/// cells, new cells slip before they touch: order 1 in the increments.
pub(super) const SPHERE: Case = Case {
    name: "Spence's sphere, in increments: β = 0.3",
    source: "Spence (1968, 1975); Mossakovskii (1963)",
    checks: || {
        let checks = [
            ("c/a, μ = 0.2", first_order(5e-2)),
            ("c/a, μ = 0.4", first_order(5e-2)),
            ("load, no slip", first_order(1e-2)),
        ];
        study("a/Δx", &[8, 16, 32], checks, |n| {
            let ratio = |friction| -> Result<f64> {
                let (solution, _) = indent(n, 0.3, friction)?;
                Ok(relative(stick_share(&solution), coupled(0.3, friction).stick_ratio))
            };
            let (sticking, load) = indent(n, 0.3, f64::INFINITY)?;
            let approach = sticking.normal.approach;
            let exact = StickingSphere::from_approach(smooth::RADIUS, 1.0, 0.3, approach);
            Ok([ratio(0.2)?, ratio(0.4)?, relative(load, exact.load)])
        })
    },
};

fn first_order(finest: f64) -> Expected {
    Expected::Order { order: 0.8..=1.3, finest }
}

fn coupled(dundurs: f64, friction: f64) -> CoupledPunch {
    let of = |punch: &&CoupledPunch| (punch.dundurs, punch.friction) == (dundurs, friction);
    *COUPLED.iter().find(of).expect("a row of the table")
}

/// A body with E* = 1 under a rigid one, 0 < β ≤ ½.
fn under_rigid(dundurs: f64) -> Result<Compliances> {
    let poisson = (0.5 - dundurs) / (1.0 - dundurs);
    let rigid = Material::elastic(f64::INFINITY, 0.3)?;
    Compliances::new(&Material::elastic(1.0 - poisson * poisson, poisson)?, &rigid)
}

/// A flat punch and its load. Its whole history is one increment, because slip is proportional to the load.
fn punch(
    n: usize,
    dundurs: f64,
    coefficient: f64,
    coupling: Coupling,
) -> Result<(FrictionalSolution, Newton)> {
    let (grid, gap) = smooth::flat_end(n)?;
    let mut operator = Operators::new(grid, under_rigid(dundurs)?, Boundary::FREE).coupled_on(grid.shape);
    let friction = Friction { coupling, ..Friction::coulomb(coefficient)? };
    let solution = hold(operator.as_mut(), &gap, &friction, down(APPROACH), None)?;
    let load = solution.normal.load();
    Ok((solution, load))
}

/// A sphere and its load, pressed to a contact radius of 1 (without friction), `n` cells long.
fn indent(n: usize, dundurs: f64, coefficient: f64) -> Result<(FrictionalSolution, Newton)> {
    let grid = Grid::new([2 * n + 4; 2], [1.0 / n as f64; 2])?;
    let gap = smooth::sphere_gap(&grid)?;
    let mut operator = Operators::new(grid, under_rigid(dundurs)?, Boundary::FREE).coupled_on(grid.shape);
    let friction = Friction::coulomb(coefficient)?;
    let mut to = |radius: usize, before: Option<&FrictionalSolution>| {
        let approach = (radius as f64 / n as f64).powi(2) / smooth::RADIUS;
        hold(operator.as_mut(), &gap, &friction, down(approach), before)
    };
    let mut solution = to(2, None)?;
    for radius in (4..=n).step_by(2) {
        solution = to(radius, Some(&solution))?;
    }
    let load = solution.normal.load();
    Ok((solution, load))
}

fn down(approach: Metre) -> Loading {
    Loading { normal: Control::Approach(approach), tangential: Tangential::Force([0.0; 2]) }
}

/// Radius of the stick area over that of the contact.
fn stick_share(solution: &FrictionalSolution) -> f64 {
    (solution.stick.sum() / solution.normal.contact_cells() as f64).sqrt()
}
