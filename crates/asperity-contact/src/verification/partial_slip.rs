//! A sphere on a plane of the same material, pushed tangentially: pressure and shear are uncoupled.

use std::f64::consts::PI;

use ndarray::Array2;

use super::{Case, Check, Expected, hold, relative, relative_rms, smooth, study};
use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::material::{Compliances, Material};
use crate::operator::{Boundary, CoupledOperator, Operators};
use crate::reference::cattaneo::tangential_modulus;
use crate::reference::{CattaneoMindlin, HertzSphere, MindlinDeresiewicz};
use crate::solver::{
    Control, Friction, FrictionalSolution, Loading, Params, Tangential, normal_stiffness,
    tangential_stiffness,
};
use crate::units::Newton;

const MODULUS: f64 = 5.0;
const FRICTION: f64 = 0.3;
/// Direction of the push, off the axes.
const DIRECTION: [f64; 2] = [0.8, 0.6];

/// The sphere on the plane, both with Poisson's ratio `poisson`.
struct PushedSphere {
    contact: CattaneoMindlin,
    grid: Grid,
    gap: Field,
    operator: Box<dyn CoupledOperator>,
}

impl PushedSphere {
    /// Creates a contact with `n` cells along its radius, under the load 7 and a `share` of the friction
    /// limit.
    fn new(poisson: f64, share: f64, n: usize) -> Result<Self> {
        let body = Material::elastic(2.0 * MODULUS * (1.0 - poisson * poisson), poisson)?;
        let normal = HertzSphere { radius: smooth::RADIUS, modulus: MODULUS, load: 7.0 };
        let contact = CattaneoMindlin {
            normal,
            tangential_modulus: tangential_modulus(&body, &body),
            friction: FRICTION,
            tangential_load: share * FRICTION * normal.load,
        };
        let grid = Grid::new([2 * n + 4; 2], [normal.contact_radius() / n as f64; 2])?;
        let pair = Compliances::new(&body, &body)?;
        let operator = Operators::new(grid, pair, Boundary::FREE).coupled_on(grid.shape);
        Ok(Self { contact, grid, gap: smooth::sphere_gap(&grid)?, operator })
    }

    fn under(
        &mut self,
        force: Newton,
        friction: f64,
        before: Option<&FrictionalSolution>,
    ) -> Result<FrictionalSolution> {
        let tangential = Tangential::Force(DIRECTION.map(|n| n * force));
        let loading = Loading { normal: Control::Load(self.contact.normal.load), tangential };
        hold(self.operator.as_mut(), &self.gap, &Friction::coulomb(friction)?, loading, before)
    }

    /// Evaluates `f` at each cell's distance from the axis.
    fn around(&self, f: impl Fn(f64) -> f64) -> Field {
        self.gap.mapv(|h| f((2.0 * smooth::RADIUS * h).sqrt()))
    }
}

/// Shear along the push.
fn along(shear: &[Field; 2]) -> Field {
    DIRECTION[0] * &shear[0] + DIRECTION[1] * &shear[1]
}

fn travel(solution: &FrictionalSolution) -> f64 {
    DIRECTION[0] * solution.rigid_displacement[0] + DIRECTION[1] * solution.rigid_displacement[1]
}

/// With ν = 0 the slip is along the push, and the closed form is exact. With ν = 0.3 the displacement would
/// be 5e-4 smaller, and the shear across the push a twentieth of the largest.
pub(super) const CATTANEO: Case = Case {
    name: "Cattaneo–Mindlin: Q = 0.6 μW",
    source: "Cattaneo (1938); Mindlin (1949); Johnson (1985), eqs. 7.39–7.42",
    checks: || {
        let checks = [
            ("displacement", Expected::Order { order: 1.8..=2.2, finest: 1e-4 }),
            ("shear, rms", Expected::Order { order: 0.8..=1.2, finest: 1e-2 }),
            ("stick area", Expected::Counted(1.5)),
        ];
        study("a/Δx", &[8, 16, 32, 64], checks, |n| {
            let mut pushed = PushedSphere::new(0.0, 0.6, n)?;
            let solution = pushed.under(pushed.contact.tangential_load, FRICTION, None)?;
            let exact = pushed.around(|r| pushed.contact.shear(r));
            let stick = solution.stick.sum() * pushed.grid.cell_area();
            Ok([
                relative(travel(&solution), pushed.contact.displacement()),
                relative_rms(&along(&solution.shear), &exact),
                relative(stick, PI * pushed.contact.stick_radius().powi(2)),
            ])
        })
    },
};

/// A flat punch without slip: the closed form holds for any ν. The shear is infinite at the edge, and the
/// edge is a staircase: order 1.
pub(super) const MINDLIN: Case = Case {
    name: "Mindlin: no slip, ν = 0.3",
    source: "Mindlin (1949); Johnson (1985), eqs. 7.36–7.38",
    checks: || {
        let body = Material::elastic(2.0, 0.3)?;
        let first = |finest| Expected::Order { order: 0.8..=1.3, finest };
        let checks = [("force", first(1e-2)), ("shear on the axis", first(1e-2))];
        study("a/Δx", &[8, 16, 32, 64], checks, |n| {
            let (grid, gap) = smooth::flat_end(n)?;
            let mut operator =
                Operators::new(grid, Compliances::new(&body, &body)?, Boundary::FREE).coupled_on(grid.shape);
            let normal = Control::Approach(1e-3);
            let loading = Loading { normal, tangential: Tangential::Displacement(DIRECTION) };
            let solution = hold(operator.as_mut(), &gap, &Friction::coulomb(f64::INFINITY)?, loading, None)?;
            let exact = 2.0 * smooth::PUNCH_RADIUS * tangential_modulus(&body, &body);
            let force: f64 = along(&solution.shear).sum() * grid.cell_area();
            let on_axis = exact / (2.0 * PI * smooth::PUNCH_RADIUS.powi(2));
            Ok([relative(force, exact), relative(along(&solution.shear)[[n, n]], on_axis)])
        })
    },
};

/// The push is removed and applied again, in `a/Δx` increments; neither the states nor the frictional energy
/// depend on them. The work of the force over the closed cycle is summed by chords, which shorten the loop by
/// the square of the increments. For displacement and loss the order 3, from the edges of stick and slip,
/// still dominates.
pub(super) const HYSTERESIS: Case = Case {
    name: "hysteresis: Q = ±0.9 μW",
    source: "Mindlin & Deresiewicz (1953); Johnson (1985), section 7.4",
    checks: hysteresis,
};

fn hysteresis() -> Result<Vec<Check>> {
    let checks = [
        ("displacement, rms", Expected::Order { order: 1.8..=3.1, finest: 1e-4 }),
        ("shear, rms, Q = 0", Expected::Order { order: 0.8..=1.2, finest: 2e-2 }),
        ("loss", Expected::Order { order: 1.8..=3.1, finest: 5e-4 }),
        ("loss against ∮ Q dD", Expected::Order { order: 1.8..=2.2, finest: 1e-2 }),
        ("loss in two increments", Expected::RoundOff(1e-6)),
    ];
    study("a/Δx", &[8, 16, 32], checks, |n| {
        let mut pushed = PushedSphere::new(0.0, 0.9, n)?;
        let turn = pushed.contact;
        let force = |step: usize| turn.tangential_load * (4.0 * step.abs_diff(n / 2) as f64 / n as f64 - 1.0);
        let exact = |step: usize| {
            let way = if step <= n / 2 { 1.0 } else { -1.0 };
            (way, MindlinDeresiewicz { turn, tangential_load: way * force(step) })
        };
        let mut state = pushed.under(turn.tangential_load, FRICTION, None)?;
        let (mut loss, mut work, mut squares, mut shear) = (0.0, 0.0, 0.0, f64::NAN);
        let there = pushed.under(force(n / 2), FRICTION, Some(&state))?;
        let back = pushed.under(force(n), FRICTION, Some(&there))?;
        let at_once = there.dissipation(Some(&state)) + back.dissipation(Some(&there));
        for step in 1..=n {
            let next = pushed.under(force(step), FRICTION, Some(&state))?;
            let (way, exact) = exact(step);
            squares += (travel(&next) - way * exact.displacement()).powi(2);
            loss += next.dissipation(Some(&state));
            work += 0.5 * (force(step) + force(step - 1)) * (travel(&next) - travel(&state));
            if 4 * step == n {
                shear = relative_rms(&along(&next.shear), &pushed.around(|r| exact.shear(r)));
            }
            state = next;
        }
        Ok([
            (squares / n as f64).sqrt() / turn.displacement(),
            shear,
            relative(loss, turn.cycle_loss()),
            relative(loss, work),
            relative(at_once, loss),
        ])
    })
}

/// A disc that sticks, pushed along a surface: the ratio of the tangential to the normal stiffness. The cells of its edge err
/// alike in both.
pub(super) const STICKING_DISC: Case = Case {
    name: "tangential stiffness of a disc, ν = 0.3",
    source: "Mindlin: k_t = 2 (1 − ν)/(2 − ν) k_n, k_n = 2 E* a",
    checks: || {
        let checks = [
            ("ratio to the normal stiffness", Expected::Counted(0.1)),
            ("normal stiffness", Expected::Counted(1.0)),
        ];
        study("cells along the radius", &[8, 16, 32], checks, |n| {
            let body = Material::elastic(2.0 * MODULUS * (1.0 - 0.09), 0.3)?;
            let grid = Grid::new([2 * n + 2; 2], [1.0 / n as f64; 2])?;
            let operators = Operators::new(grid, Compliances::new(&body, &body)?, Boundary::FREE);
            let mut operator = operators.coupled_on(grid.shape);
            let from_middle = |axis: usize, i: usize| grid.centre(axis, i) - 0.5 * grid.extent()[axis];
            let disc =
                Array2::from_shape_fn(grid.shape, |(i, j)| from_middle(0, i).hypot(from_middle(1, j)) < 1.0);
            let params = Params::default().with_tolerance(1e-9);
            let (normal, _) = normal_stiffness(operator.normal(), &disc, &params)?;
            let (tangential, _) = tangential_stiffness(&mut *operator, &disc, &params)?;
            let (normal, [along, _]) = normal.zip(tangential).unwrap_or((f64::NAN, [f64::NAN; 2]));
            Ok([relative(along / normal, 1.4 / 1.7), relative(normal, 2.0 * MODULUS)])
        })
    },
};
