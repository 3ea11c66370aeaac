//! Steady rolling.

use super::{Case, Check, Expected, PARAMS, relative, relative_rms, smooth, study};
use crate::error::Result;
use crate::grid::Field;
use crate::material::{Compliances, Material};
use crate::operator::{Boundary, Operators};
use crate::solver::{Control, Friction, Rolling, solve_rolling};

/// A driven wheel on a periodic grid one cell wide. The shear is μ times the pressure of the contact less that of a
/// line of half width c at its leading edge, a distance d = a − c from the middle. Both are curved by their own images
/// as the contact of [`smooth::LINE`] is, and ξ = μd/R is left, R that of the cylinder: the difference of their strains
/// where it sticks. Across the rolling all is the same but for a compliance of 1/E* + 1/N*.
///
/// Material is strained from cell to cell in a step, against the shear in one of the two: order 1.
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
    ];
    study("a/Δx", &[4, 8, 16, 32], checks, |n| {
        let (grid, gap) = smooth::line_gap(n)?;
        let mut operator = Operators::new(grid, pair, Boundary::PERIODIC).coupled_on(grid.shape);
        let width = grid.pitch[1];
        let force = FRICTION * (contact.load_per_length - stick.load_per_length) * width;
        let mut roll = |rolling| {
            let (friction, load) =
                (Friction::coulomb(FRICTION)?, Control::Load(contact.load_per_length * width));
            solve_rolling(operator.as_mut(), &gap, f64::INFINITY, &friction, load, rolling, &PARAMS)
        };
        let (driven, found) = roll(Rolling::Force([force, 0.0]))?;
        let across = Rolling::Creepage([0.0, creepage * (1.0 + pair.lateral / pair.normal)]);
        let (steered, _) = roll(across)?;
        let exact = Field::from_shape_fn(grid.shape, |(i, _)| {
            let x = grid.centre(0, i) - 0.5 * grid.extent()[0];
            FRICTION * (contact.pressure(x) - stick.pressure(x - d))
        });
        Ok([
            relative(found[0], creepage),
            relative_rms(&driven.shear[0], &exact),
            relative(driven.stick.sum() * grid.pitch[0], 2.0 * stick.half_width()),
            relative(steered.force(grid.cell_area())[1], force),
        ])
    })
}
