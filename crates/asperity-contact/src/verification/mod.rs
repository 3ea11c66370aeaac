//! Verification: the whole program compared with closed forms, by the order of convergence.
//!
//! A [`Case`] is one closed form. It is computed on finer and finer grids, and each of its [`Check`]s tests
//! that the error of one quantity decreases as in theory. A lucky per cent passes no check; an order does.
//! With pressures constant in each cell and displacements evaluated at its centre, theory predicts:
//!
//! ```text
//! load, approach, mean gap, energy: quantities from the minimum of the energy
//!     order 2   the displacement at the centre of a cell differs from its mean by Δx² ∇²u/24
//!     order 3   the remainder, the squared pressure error in the energy norm, Δx^(3/2)
//!     order 1   if the pressure ends as 1/√distance, where that error is Δx^(1/2)
//! pressure, rms over the contact
//!     order 1   if it ends as √distance: an error of √Δx in a fraction Δx of the cells
//! contact, counted by cells
//!     order 1   a cell at each edge is inside or outside
//! ```
//!
//! Shear, tangential displacement and stick area behave like pressure, approach and contact area. Increments
//! with a growing contact, and steps of rolling, are of order 1.

mod adhesion;
mod coated;
mod conductance;
mod dissimilar;
mod fatigue;
mod flow;
mod fretting;
mod heat;
mod in_place;
mod lubrication;
mod operators;
mod partial_slip;
mod plasticity;
mod rolling;
mod rough;
mod running_in;
mod shear;
mod sinusoid;
mod smooth;
mod subsurface;
mod viscoelastic;

use std::ops::RangeInclusive;

use crate::error::Result;
use crate::grid::Field;
use crate::operator::{CoupledOperator, Operator};
use crate::solver::{
    Bounds, Control, Friction, FrictionalSolution, Loading, Params, Solution, solve_frictional, solve_normal,
};
use crate::units::Pascal;

/// A closed form, or an identity of the theory, with which the program is compared.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// Name of the computation.
    pub name: &'static str,
    /// Source of the closed form.
    pub source: &'static str,
    /// Computes it on all grids.
    pub checks: fn() -> Result<Vec<Check>>,
}

/// One quantity of a [`Case`] on finer and finer grids.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    /// The compared quantity.
    pub quantity: &'static str,
    /// The refined quantity: cells per length, steps, a ratio.
    pub refinement: &'static str,
    /// Values of the refinement, ascending.
    pub sizes: Vec<usize>,
    /// Relative error at each size.
    pub errors: Vec<f64>,
    /// Expected behaviour of the error.
    pub expected: Expected,
}

/// Expected behaviour of an error.
#[derive(Debug, Clone, PartialEq)]
pub enum Expected {
    /// |error| is at most this at every size.
    RoundOff(f64),
    /// |error| × size is at most this at every size: cells are counted, and one at an edge is inside or outside.
    Counted(f64),
    /// The error decreases as a power of the size.
    Order {
        /// Accepted range of [`Check::order`]: around the theoretical order, with the scatter from staircase
        /// edges.
        order: RangeInclusive<f64>,
        /// The largest |error| at the last size.
        finest: f64,
    },
}

impl Check {
    /// Order k of |error| ∝ size^(−k), by a least-squares fit to the logarithms over all sizes. NaN if an
    /// error is 0 or if there is a single size.
    pub fn order(&self) -> f64 {
        let points = || self.sizes.iter().zip(&self.errors).map(|(n, e)| ((*n as f64).ln(), e.abs().ln()));
        let count = self.sizes.len() as f64;
        let (x, y) = points().fold((0.0, 0.0), |(x, y), (s, t)| (x + s / count, y + t / count));
        let (above, below) =
            points().fold((0.0, 0.0), |(a, b), (s, t)| (a + (s - x) * (t - y), b + (s - x) * (s - x)));
        -above / below
    }

    /// Whether the errors are as expected; false if one is NaN.
    pub fn passed(&self) -> bool {
        let all_within = |bound: &dyn Fn(usize) -> f64| {
            self.sizes.iter().zip(&self.errors).all(|(n, error)| error.abs() <= bound(*n))
        };
        match &self.expected {
            Expected::RoundOff(tolerance) => all_within(&|_| *tolerance),
            Expected::Counted(cells) => all_within(&|n| cells / n as f64),
            Expected::Order { order, finest } => {
                let last = self.errors.last().is_some_and(|error| error.abs() <= *finest);
                last && order.contains(&self.order())
            }
        }
    }
}

/// All cases: operators first, then solutions without friction, with adhesion, of viscoelastic bodies and
/// with friction, frictional heating, flow through a gap, films of an oil, plastic flow and wear.
pub const CASES: &[Case] = &[
    operators::LOADED_RECTANGLE,
    operators::FREE_TRANSFORM,
    operators::PERIODIC_TRANSFORM,
    operators::LOADED_STRIP,
    smooth::SPHERE,
    smooth::ELLIPSOID,
    smooth::LINE,
    smooth::LINE_ALONE,
    smooth::PUNCH,
    sinusoid::QUARTER,
    sinusoid::HALF,
    sinusoid::THREE_QUARTERS,
    sinusoid::FULL,
    coated::HARMONICS,
    coated::FREE_AND_PERIODIC,
    coated::THICK,
    coated::FOUNDATION,
    coated::SERIES,
    coated::SHEARED,
    coated::LINE,
    coated::INCOMPRESSIBLE,
    rough::PLASTIC_LIMIT,
    rough::WORK,
    rough::METHODS,
    adhesion::JKR_LIMIT,
    adhesion::MAUGIS_LONG,
    adhesion::MAUGIS_SHORT,
    adhesion::WAVE,
    adhesion::ENERGY,
    adhesion::NO_WORK,
    viscoelastic::WAVE,
    viscoelastic::CYLINDER,
    viscoelastic::LAYER,
    viscoelastic::PASS,
    viscoelastic::FAST,
    viscoelastic::CREEP,
    shear::COEFFICIENTS,
    shear::FREE_TRANSFORM,
    shear::PERIODIC_TRANSFORM,
    partial_slip::CATTANEO,
    partial_slip::MINDLIN,
    partial_slip::HYSTERESIS,
    partial_slip::STICKING_DISC,
    dissimilar::IDENTICAL,
    dissimilar::ALMOST_IDENTICAL,
    dissimilar::NO_SLIP,
    dissimilar::GOODMAN,
    dissimilar::SPENCE,
    dissimilar::SPHERE,
    rolling::CARTER,
    rolling::KALKER,
    subsurface::LOADED_RECTANGLE,
    subsurface::SPHERE,
    subsurface::SLIDING_SPHERE,
    fatigue::LINE,
    heat::SQUARE,
    heat::WAVE,
    heat::DISC,
    heat::HERTZIAN,
    heat::TRANSIENT,
    heat::DIVISION,
    conductance::SPOTS,
    conductance::PAIR,
    conductance::LATTICE,
    conductance::FILM,
    conductance::GAS,
    conductance::COATED,
    conductance::BARBER,
    flow::PLATES,
    flow::CORRUGATION,
    flow::SLIDING,
    flow::SMALL,
    flow::DISCS,
    flow::RIM,
    flow::CHECKERBOARD,
    flow::CONSERVATION,
    lubrication::PAD,
    lubrication::RUPTURE,
    lubrication::SQUEEZE,
    lubrication::BALL,
    lubrication::SLOW,
    plasticity::ENERGY,
    plasticity::ONSET,
    plasticity::SPHERE,
    plasticity::STEPS,
    plasticity::FULLY_PLASTIC,
    plasticity::LINE,
    plasticity::RESIDUAL,
    plasticity::KINEMATIC,
    plasticity::POINT,
    running_in::GROOVES,
    running_in::FILM_GROWTH,
    in_place::GROOVES,
    in_place::GROOVES_UNDER_FILM,
    in_place::FLAT,
    in_place::BALL,
    fretting::CYCLE,
    fretting::JUMPS,
];

/// Creates the `checks` of quantities whose relative errors `errors_at` computes at each of the `sizes`.
fn study<const N: usize>(
    refinement: &'static str,
    sizes: &[usize],
    checks: [(&'static str, Expected); N],
    mut errors_at: impl FnMut(usize) -> Result<[f64; N]>,
) -> Result<Vec<Check>> {
    let errors = sizes.iter().map(|&n| errors_at(n)).collect::<Result<Vec<_>>>()?;
    let check = |(i, (quantity, expected))| Check {
        quantity,
        refinement,
        sizes: sizes.to_vec(),
        errors: errors.iter().map(|at_size: &[f64; N]| at_size[i]).collect(),
        expected,
    };
    Ok(checks.into_iter().enumerate().map(check).collect())
}

fn relative(computed: f64, exact: f64) -> f64 {
    computed / exact - 1.0
}

/// Root mean square difference over the root mean square of the exact field.
fn relative_rms(computed: &Field, exact: &Field) -> f64 {
    let square = |field: &Field| field.iter().map(|v| v * v).sum::<f64>();
    (square(&(computed - exact)) / square(exact)).sqrt()
}

/// Largest difference over the largest exact value.
fn relative_max(computed: &Field, exact: &Field) -> f64 {
    largest(&(computed - exact)) / largest(exact)
}

/// Largest magnitude; NaN if there is one, which `f64::max` would ignore.
fn largest<'a>(values: impl IntoIterator<Item = &'a f64>) -> f64 {
    values.into_iter().fold(0.0, |m: f64, v| if v.abs() > m || v.is_nan() { v.abs() } else { m })
}

/// A tolerance far below the error of any grid here.
const PARAMS: Params = Params::new().with_tolerance(1e-9);

fn press(operator: &mut dyn Operator, gap: &Field, hardness: Pascal, control: Control) -> Result<Solution> {
    solve_normal(operator, gap, &Bounds::up_to(hardness), control, None, &PARAMS)
}

fn hold(
    operator: &mut dyn CoupledOperator,
    gap: &Field,
    friction: &Friction,
    loading: Loading,
    before: Option<&FrictionalSolution>,
) -> Result<FrictionalSolution> {
    solve_frictional(operator, gap, &Bounds::ELASTIC, friction, loading, before, &PARAMS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn check(errors: [f64; 3], expected: Expected) -> Check {
        let sizes = vec![10, 20, 40];
        Check { quantity: "load", refinement: "cells", sizes, errors: errors.to_vec(), expected }
    }

    #[test]
    fn an_error_that_falls_to_a_quarter_when_the_cells_are_halved_is_of_order_2() {
        let expected = Expected::Order { order: 1.9..=2.1, finest: 1e-3 };
        let check = |errors| check(errors, expected.clone());
        assert_relative_eq!(check([-1.6e-2, -4e-3, -1e-3]).order(), 2.0, max_relative = 1e-14);
        assert!(check([-1.6e-2, -4e-3, -1e-3]).passed());
        assert!(!check([-3.2e-2, -8e-3, -2e-3]).passed(), "of order 2, but too large");
        assert!(!check([4e-3, 2e-3, 1e-3]).passed(), "small, but of order 1");
    }

    #[test]
    fn a_count_may_be_wrong_by_so_many_cells_and_round_off_by_the_same_everywhere() {
        assert!(check([0.1, 0.0, -0.02], Expected::Counted(1.0)).passed());
        assert!(!check([0.1, 0.0, 0.03], Expected::Counted(1.0)).passed());
        assert!(check([1e-16, 0.0, -1e-14], Expected::RoundOff(1e-14)).passed());
        assert!(!check([1e-13, 0.0, 0.0], Expected::RoundOff(1e-14)).passed());
    }

    #[test]
    fn what_is_not_a_number_passes_nothing() {
        let order = Expected::Order { order: 0.0..=9.0, finest: 1.0 };
        for expected in [order, Expected::Counted(1e9), Expected::RoundOff(1e9)] {
            assert!(!check([0.1, f64::NAN, 0.01], expected).passed());
        }
        let field = ndarray::arr2(&[[1.0, f64::NAN, 2.0]]);
        assert!(relative_max(&field, &ndarray::arr2(&[[1.0, 1.0, 2.0]])).is_nan());
    }
}
