//! Steady rolling.

use std::f64::consts::PI;

use super::{Case, Check, Expected, PARAMS, relative, relative_rms, smooth, study};
use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::material::{Compliances, Material};
use crate::operator::{Boundary, Operators};
use crate::solver::{Bounds, Control, Creep, Friction, Rolling, RollingSolution, solve_rolling};

/// A driven wheel on a periodic grid one cell wide. The shear is μ times the pressure of the contact minus
/// that of a line of half width c at its leading edge, a distance d = a − c from the middle. Both are curved
/// by their own images like the contact of [`smooth::LINE`], so that ξ = μd/R remains, with the R of the
/// cylinder: the difference of their strains in the stick area. A creepage across the rolling direction gives
/// the same with a compliance of 1/E* + 1/N*.
///
/// Per step, material is strained from cell to cell, against the shear in one of the two: order 1.
pub(super) const CARTER: Case = Case {
    name: "Carter: cylinder, period 32 a, c = 5/8 a",
    source: "Carter (1926); Johnson (1985), section 8.3",
    checks: carter,
};

fn carter() -> Result<Vec<Check>> {
    const FRICTION: f64 = 0.3;
    let contact = smooth::line_of(smooth::LINE_HALF_WIDTH);
    let stick = smooth::line_of(0.625 * smooth::LINE_HALF_WIDTH);
    let d = contact.half_width() - stick.half_width();
    let creepage = FRICTION * d / smooth::RADIUS;
    let poisson = 0.3;
    let body = Material::elastic(2.0 * smooth::MODULUS * (1.0 - poisson * poisson), poisson)?;
    let pair = Compliances::new(&body, &body)?;
    let first = |finest| Expected::Order { order: 0.8..=1.2, finest };
    let checks = [
        ("creepage", first(1e-2)),
        ("shear, rms", first(1e-2)),
        ("stick width", Expected::Counted(1.0)),
        ("force across", first(1e-2)),
        ("dissipation", first(1e-2)),
        ("dissipation across", first(1e-2)),
        ("slip work", first(1e-1)),
    ];
    study("a/Δx", &[4, 8, 16, 32], checks, |n| {
        let (grid, gap) = smooth::line_gap(n)?;
        let mut operator = Operators::new(grid, pair, Boundary::PERIODIC).coupled_on(grid.shape);
        let width = grid.pitch[1];
        let force = FRICTION * (contact.load_per_length - stick.load_per_length) * width;
        let mut roll = |creep| {
            let rolling = Rolling { creep, spin: 0.0 };
            let (friction, load) =
                (Friction::coulomb(FRICTION)?, Control::Load(contact.load_per_length * width));
            solve_rolling(operator.as_mut(), &gap, &Bounds::ELASTIC, &friction, load, rolling, &PARAMS)
        };
        let rolled = roll(Creep::Force([force, 0.0]))?;
        let slip_work = rolled.slip_work();
        let RollingSolution { contact: driven, creepage: found, dissipation, .. } = rolled;
        let energy = force * creepage * grid.pitch[0];
        let creepage_across = creepage * (1.0 + pair.lateral / pair.normal);
        let steered = roll(Creep::Creepage([0.0, creepage_across]))?;
        let energy_across = force * creepage_across * grid.pitch[0];
        let exact = Field::from_shape_fn(grid.shape, |(i, _)| {
            let x = grid.centre(0, i) - 0.5 * grid.extent()[0];
            FRICTION * (contact.pressure(x) - stick.pressure(x - d))
        });
        Ok([
            relative(found[0], creepage),
            relative_rms(&driven.shear[0], &exact),
            relative(driven.stick.sum() * grid.pitch[0], 2.0 * stick.half_width()),
            relative(steered.contact.force()[1], force),
            relative(dissipation, energy),
            relative(steered.dissipation, energy_across),
            relative(slip_work, energy),
        ])
    })
}

/// Infinite friction: without slip, force and moment are linear in creepage and spin, with c = √(ab) and the
/// semi-axes a along the rolling direction and b across it:
///
/// ```text
/// Q_x = c² G C11 ξx      Q_y = c² G (C22 ξy + c C23 φ)      M = c³ G (−C23 ξy + c C33 φ)
/// ```
///
/// Their work per length of rolling is the frictional energy, all of it at the trailing edge. The work of C23
/// cancels:
///
/// ```text
/// ξ·Q + φM = c² G (C11 ξx² + C22 ξy² + c² C33 φ²)
/// ```
///
/// Kalker's table has three digits, and the shear at the trailing edge is infinite: order 1.
pub(super) const KALKER: Case = Case {
    name: "Kalker: creepage and spin without slip, ν = 1/4",
    source: "Kalker (1967); Kalker (1990), table E3",
    checks: kalker,
};

/// a/b and C11, C22, C23, C33 at ν = 1/4.
const COEFFICIENTS: [(f64, [f64; 4]); 3] =
    [(1.0, [4.12, 3.67, 1.47, 1.19]), (0.5, [3.62, 3.01, 0.929, 1.93]), (2.0, [5.10, 4.90, 2.62, 0.819])];

fn kalker() -> Result<Vec<Check>> {
    let (ratio, [c11, c22, c23, c33]) = COEFFICIENTS[0];
    let first = |finest| Expected::Order { order: 0.7..=1.3, finest };
    let checks = [
        ("C11", first(1e-2)),
        ("C22", first(1e-2)),
        ("C23", first(3e-2)),
        ("C33", first(5e-2)),
        ("C32 = −C23", first(3e-2)),
        ("dissipation", first(2e-2)),
    ];
    study("a/Δx", &[4, 8, 16], checks, |n| {
        let found = creep_coefficients(ratio, 0.25, n)?;
        let exact = [c11, c22, c23, c33, c23, energy([c11, c22, c33])];
        Ok(std::array::from_fn(|k| relative(found[k], exact[k])))
    })
}

/// Creepage along x and y, and spin times c, for the energy.
const CREEPS: [f64; 3] = [1.0, 0.5, 0.7];

/// Energy per length over c²G with [`CREEPS`], from C11, C22 and C33.
fn energy(coefficients: [f64; 3]) -> f64 {
    coefficients.iter().zip(CREEPS).map(|(c, creep)| c * creep * creep).sum()
}

/// C11, C22, C23, C33, −C32 and [`energy`] of an ellipse with semi-axes a/b = `ratio`, `n` cells along each.
fn creep_coefficients(ratio: f64, poisson: f64, n: usize) -> Result<[f64; 6]> {
    let semi_axes = [ratio.sqrt(), 1.0 / ratio.sqrt()];
    let body = Material::elastic(2.0 * (1.0 + poisson), poisson)?;
    // One column ahead of the contact, where the bodies are not strained yet.
    let grid = Grid::new([2 * n + 2, 2 * n], semi_axes.map(|a| a / n as f64))?;
    let inside = |i: usize, j: usize| {
        let [x, y] = [i as f64 + 0.5 - n as f64 - 1.0, j as f64 + 0.5 - n as f64];
        x * x + y * y <= (n * n) as f64
    };
    let gap = Field::from_shape_fn(grid.shape, |(i, j)| if inside(i, j) { 0.0 } else { 10.0 });
    let mut operator =
        Operators::new(grid, Compliances::new(&body, &body)?, Boundary::FREE).coupled_on(grid.shape);
    let friction = Friction::coulomb(f64::INFINITY)?;
    let params = PARAMS.with_tolerance(1e-6);
    let mut roll = |creepage, spin| -> Result<RollingSolution> {
        let rolling = Rolling { creep: Creep::Creepage(creepage), spin };
        let control = Control::Approach(1.0);
        solve_rolling(operator.as_mut(), &gap, &Bounds::ELASTIC, &friction, control, rolling, &params)
    };
    let [c11, _] = roll([1.0, 0.0], 0.0)?.contact.force();
    let across = roll([0.0, 1.0], 0.0)?.contact;
    let spun = roll([0.0, 0.0], 1.0)?.contact;
    // Relative to an ellipse with the area of the cells.
    let cells = gap.iter().filter(|h| **h == 0.0).count() as f64;
    let c = (cells * grid.cell_area() / PI).sqrt();
    let [xi_x, xi_y, turned] = CREEPS;
    let dissipation = roll([xi_x, xi_y], turned / c)?.dissipation / grid.pitch[0];
    Ok([
        c11 / c.powi(2),
        across.force()[1] / c.powi(2),
        spun.force()[1] / c.powi(3),
        spun.moment() / c.powi(4),
        -across.moment() / c.powi(3),
        dissipation / c.powi(2),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The error of first order in the cells is subtracted. The remainder is the scatter of the edge, and the
    /// third digit of the table.
    #[test]
    fn other_ellipses_have_kalkers_coefficients_too() {
        #[rustfmt::skip]
        let table = [
            (COEFFICIENTS[1], 0.25),
            (COEFFICIENTS[2], 0.25),
            ((1.0, [3.40, 3.40, 1.33, 1.21]), 0.0),
            ((1.0, [5.20, 3.98, 1.63, 1.16]), 0.5),
        ];
        for ((ratio, [c11, c22, c23, c33]), poisson) in table {
            let [coarse, fine] = [6, 12].map(|n| creep_coefficients(ratio, poisson, n).unwrap());
            for (k, exact) in [c11, c22, c23, c33, c23, energy([c11, c22, c33])].into_iter().enumerate() {
                let found = 2.0 * fine[k] - coarse[k];
                assert!(
                    (found / exact - 1.0).abs() < 0.02,
                    "a/b = {ratio}, ν = {poisson}: {k}: {found}, {exact}"
                );
            }
        }
    }
}
