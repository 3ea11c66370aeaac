//! The contact with friction compared with an independent method on small grids, and with conditions that
//! every solution must satisfy.

use asperity_base::{Error, Field, Grid};
use asperity_contact::kernel::{SharedResponse, response};
use asperity_contact::material::{Coating, Compliances, Material};
use asperity_contact::operator::{Boundary, CoupledOperator, CoupledSum, Operators};
use asperity_contact::solver::{
    Bounds, Control, Coupling, Creep, Friction, FrictionalSolution, Loading, Params, Rolling, Tangential,
    solve_frictional, solve_normal, solve_rolling,
};

use crate::support::cell_by_cell::CellByCell;
use crate::support::{compliances, largest};

const INF: f64 = f64::INFINITY;
const PARAMS: Params = Params::new()
    .with_method(asperity_contact::solver::Method::Auto)
    .with_tolerance(1e-10)
    .with_max_convolutions(10_000);

fn alike() -> Compliances {
    compliances([0.3, 0.3], [2.0, 2.0])
}

fn dissimilar() -> Compliances {
    compliances([0.2, 0.3], [1.0, 30.0])
}

/// A bump with some roughness.
fn gap(shape: [usize; 2]) -> Field {
    let [cx, cy] = shape.map(|n| 0.5 * (n as f64 - 1.0));
    Field::from_shape_fn(shape, |(i, j)| {
        let (x, y) = (i as f64 - cx, j as f64 - cy);
        0.02 * (x * x + y * y) + 0.1 * ((1.9 * x + 0.4).sin() * (2.3 * y).cos())
    })
}

fn solve(
    operator: &mut dyn CoupledOperator,
    gap: &Field,
    hardness: f64,
    friction: &Friction,
    loading: Loading,
    before: Option<&FrictionalSolution>,
) -> FrictionalSolution {
    let bounds = Bounds::up_to(hardness);
    solve_frictional(operator, gap, &bounds, friction, loading, before, &PARAMS).unwrap()
}

fn assert_same(solution: &FrictionalSolution, cell_by_cell: &[[f64; 3]], what: &str) {
    let most = cell_by_cell.iter().map(|t| t[2]).fold(0.0, f64::max);
    let fields = [&solution.shear[0], &solution.shear[1], &solution.normal.pressure];
    for (axis, field) in fields.into_iter().enumerate() {
        for (cell, value) in field.iter().enumerate() {
            let error = (value - cell_by_cell[cell][axis]).abs();
            assert!(
                error < 1e-7 * most,
                "{what}: traction {axis} of cell {cell} off by {error:e} of {most:e}"
            );
        }
    }
}

/// Solves for a load and a force, and again for the resulting approach and displacement.
#[test]
fn forces_and_displacements_are_two_ways_to_say_the_same() {
    let grid = Grid::new([24, 20], [1.0, 1.0]).unwrap();
    let gap = gap(grid.shape).mapv(|h| 0.2 * h);
    for boundary in [Boundary::FREE, Boundary::PERIODIC] {
        let mut operator = Operators::new(grid, dissimilar(), boundary).coupled_on(grid.shape);
        let friction = Friction::coulomb(0.3).unwrap();
        let (mut by_force, mut by_shift): (Option<FrictionalSolution>, Option<FrictionalSolution>) =
            (None, None);
        for (load, force) in [(3.0, [0.0, 0.0]), (3.0, [0.6, 0.0]), (4.0, [0.3, -0.9]), (4.0, [-1.15, 0.0])] {
            let loading = Loading { normal: Control::Load(load), tangential: Tangential::Force(force) };
            let mut to = |loading, before: Option<&FrictionalSolution>| {
                solve(operator.as_mut(), &gap, INF, &friction, loading, before)
            };
            let one = to(loading, by_force.as_ref());
            assert!((one.normal.load() / load - 1.0).abs() < 1e-10);
            let got = one.force();
            assert!((0..2).all(|k| (got[k] - force[k]).abs() < 1e-9 * load), "{got:?} for {force:?}");
            let loading = Loading {
                normal: Control::Approach(one.normal.approach),
                tangential: Tangential::Displacement(one.rigid_displacement),
            };
            let other = to(loading, by_shift.as_ref());
            let most = one.normal.max_pressure();
            for (a, b) in [
                (&one.normal.pressure, &other.normal.pressure),
                (&one.shear[0], &other.shear[0]),
                (&one.shear[1], &other.shear[1]),
            ] {
                let error = largest(&(a - b));
                assert!(error < 1e-6 * most, "{boundary:?}, {force:?}: {error:e} of {most:e}");
            }
            assert!(one.dissipation(by_force.as_ref()) >= 0.0);
            (by_force, by_shift) = (Some(one), Some(other));
        }
    }
}

#[test]
fn layers_like_their_body_stick_slip_and_roll_as_the_body() {
    let grid = Grid::new([24, 20], [1.0, 1.0]).unwrap();
    let gap = gap(grid.shape).mapv(|h| 0.2 * h);
    let friction = Friction::coulomb(0.3).unwrap();
    let (soft, stiff) = (Material::elastic(1.0, 0.2).unwrap(), Material::elastic(30.0, 0.3).unwrap());
    let layers = soft.clone().layered(vec![Coating::new(0.8, 1.0, 0.2).unwrap(); 3]);
    for boundary in [Boundary::FREE, Boundary::PERIODIC] {
        let loading = Loading { normal: Control::Load(4.0), tangential: Tangential::Force([0.3, -0.9]) };
        let of = |lower: &Material| {
            let pair = response(lower, &stiff).unwrap();
            let mut operator = Operators::new(grid, pair, boundary).coupled_on(grid.shape);
            solve(operator.as_mut(), &gap, INF, &friction, loading, None)
        };
        let (plain, layered) = (of(&soft), of(&layers));
        let most = plain.normal.max_pressure();
        let fields =
            |of: &FrictionalSolution| [of.normal.pressure.clone(), of.shear[0].clone(), of.shear[1].clone()];
        for (one, other) in fields(&plain).iter().zip(&fields(&layered)) {
            let error = largest(&(one - other));
            assert!(error < 1e-8 * most, "{boundary:?}: {error:e} of {most:e}");
        }
        let rolled = |lower: &Material| {
            let pair = response(lower, &stiff).unwrap();
            let mut operator = Operators::new(grid, pair, boundary).coupled_on(grid.shape);
            let rolling = Rolling { creep: Creep::Creepage([2e-3, 0.0]), spin: 0.0 };
            let load = Control::Load(4.0);
            solve_rolling(operator.as_mut(), &gap, &Bounds::ELASTIC, &friction, load, rolling, &PARAMS)
                .unwrap()
        };
        let forces = [&soft, &layers].map(|lower| rolled(lower).contact.force());
        assert!(forces[0][0].abs() > 0.01 && (forces[0][0] / forces[1][0] - 1.0).abs() < 1e-7, "{forces:?}");
    }
}

#[test]
fn identical_bodies_press_as_without_friction() {
    let grid = Grid::new([40, 40], [1.0, 1.0]).unwrap();
    let gap = gap(grid.shape).mapv(|h| 0.1 * h);
    let mut operator = Operators::new(grid, alike(), Boundary::FREE).coupled_on(grid.shape);
    let alone =
        solve_normal(operator.normal(), &gap, &Bounds::up_to(0.05), Control::Load(5.0), None, &PARAMS)
            .unwrap();
    for tangential in
        [Tangential::Force([0.9, 0.2]), Tangential::Sliding([0.6, 0.8]), Tangential::Displacement([0.3, 0.0])]
    {
        let loading = Loading { normal: Control::Load(5.0), tangential };
        let friction = Friction::coulomb(0.4).unwrap();
        let solution = solve(operator.as_mut(), &gap, 0.05, &friction, loading, None);
        assert_eq!(solution.normal.pressure, alone.pressure);
        assert_eq!(solution.normal.approach, alone.approach);
    }
}

#[test]
fn what_slides_bears_all_it_can_in_the_direction_of_sliding() {
    let grid = Grid::new([40, 30], [1.0, 1.0]).unwrap();
    let gap = gap(grid.shape).mapv(|h| 0.1 * h);
    let mut operator = Operators::new(grid, dissimilar(), Boundary::FREE).coupled_on(grid.shape);
    let friction = Friction::coulomb(0.5).unwrap().with_shear_strength(0.02);
    let loading = Loading { normal: Control::Load(5.0), tangential: Tangential::Sliding([1.0, 0.0]) };
    let mut under =
        |friction: &Friction, loading| solve(operator.as_mut(), &gap, INF, friction, loading, None);
    let sliding = under(&friction, loading);
    for (p, q) in sliding.normal.pressure.iter().zip(&sliding.shear[0]) {
        assert_eq!(*q, (0.5 * p).min(0.02));
    }
    assert_eq!(sliding.stick.sum(), 0.0);
    // It is the limit for a large displacement.
    let pushed = Loading { tangential: Tangential::Displacement([1e4, 0.0]), ..loading };
    let pushed = under(&friction, pushed);
    let error = (&pushed.normal.pressure - &sliding.normal.pressure).mapv(f64::abs);
    assert!(error.iter().all(|e| *e < 1e-5 * sliding.normal.max_pressure()));
    // Ahead of the shear the softer lower body sinks, and behind it it rises towards the upper one.
    let alone = under(&friction.with_coefficient(0.0), loading);
    let moment = |p: &Field| p.indexed_iter().map(|((i, _), p)| i as f64 * p).sum::<f64>() / p.sum();
    assert!(moment(&sliding.normal.pressure) < moment(&alone.normal.pressure) - 0.05);
}

#[test]
fn plastic_cells_bear_pressure_and_shear_on_the_ellipse_and_the_contact_grows() {
    let grid = Grid::new([40, 30], [1.0, 1.0]).unwrap();
    let gap = gap(grid.shape).mapv(|h| 0.2 * h);
    let (hardness, load) = (0.04, 6.0);
    for pair in [alike(), dissimilar()] {
        let mut operator = Operators::new(grid, pair, Boundary::FREE).coupled_on(grid.shape);
        let friction = Friction::coulomb(0.4).unwrap().with_junction_growth(9.0);
        let mut under = |tangential, before: Option<&FrictionalSolution>| {
            let loading = Loading { normal: Control::Load(load), tangential };
            solve(operator.as_mut(), &gap, hardness, &friction, loading, before)
        };
        let mut area = Vec::new();
        let mut before: Option<FrictionalSolution> = None;
        for share in [0.0, 0.3, 0.6, 0.9, 0.99] {
            let pushed = under(Tangential::Force([share * 0.4 * load, 0.0]), before.as_ref());
            assert!((pushed.normal.load() / load - 1.0).abs() < 1e-9);
            let mut plastic = 0;
            for (cell, p) in pushed.normal.pressure.iter().enumerate() {
                let q = [0, 1].map(|axis| pushed.shear[axis].as_slice().unwrap()[cell]);
                let combined = (p * p + 9.0 * (q[0] * q[0] + q[1] * q[1])).sqrt();
                assert!(combined <= hardness * (1.0 + 1e-7), "{combined}");
                plastic += usize::from(combined >= hardness * (1.0 - 1e-7));
            }
            assert_eq!(plastic, pushed.normal.capped_cells());
            assert!(plastic > 0);
            area.push(pushed.normal.contact_cells());
            before = Some(pushed);
        }
        assert!(area.windows(2).all(|pair| pair[1] as f64 > 0.98 * pair[0] as f64), "{area:?}");
        assert!(area[4] as f64 > 1.05 * area[0] as f64, "{area:?}");
        // Finally everything slips, with a load of H/√(1 + αμ²).
        let sliding = under(Tangential::Sliding([1.0, 0.0]), None);
        let cap = hardness / (1.0 + 9.0 * 0.16f64).sqrt();
        assert!((sliding.normal.max_pressure() / cap - 1.0).abs() < 1e-12);
        assert!(area[4] <= sliding.normal.contact_cells());
        assert!(sliding.normal.contact_cells() as f64 - (area[4] as f64) < 0.1 * area[4] as f64);
    }
}

#[test]
fn bodies_apart_bear_nothing_and_touch_later() {
    let grid = Grid::new([12, 12], [1.0, 1.0]).unwrap();
    let gap = gap(grid.shape);
    let mut operator = Operators::new(grid, dissimilar(), Boundary::FREE).coupled_on(grid.shape);
    let friction = Friction::coulomb(0.3).unwrap();
    let lowest = gap.iter().copied().fold(f64::INFINITY, f64::min);
    let mut to = |approach, tangential, before: Option<&FrictionalSolution>| {
        let loading = Loading { normal: Control::Approach(approach), tangential };
        solve(operator.as_mut(), &gap, INF, &friction, loading, before)
    };
    for tangential in [Tangential::Force([0.0; 2]), Tangential::Displacement([0.1, 0.0])] {
        let apart = to(lowest - 0.01, tangential, None);
        assert_eq!((apart.normal.contact_cells(), apart.force(), apart.normal.residual), (0, [0.0; 2], 0.0));
        let touching = to(lowest + 0.1, tangential, Some(&apart));
        assert!(touching.normal.contact_cells() > 0 && touching.stick.sum() > 0.0);
    }
}

/// New cells carry more shear than pressure, and shear lifts the cells at the edge that have just come into
/// contact.
#[test]
fn much_friction_between_very_dissimilar_bodies_has_an_answer() {
    let (cells, steps) = (16, 16);
    let grid = Grid::new([2 * cells + 8; 2], [1.0; 2]).unwrap();
    let middle = 0.5 * (grid.shape[0] - 1) as f64;
    let gap =
        Field::from_shape_fn(grid.shape, |(i, j)| (i as f64 - middle).powi(2) + (j as f64 - middle).powi(2));
    let pair = compliances([0.0, 0.3], [1.0, f64::INFINITY]);
    let mut operator = Operators::new(grid, pair, Boundary::FREE).coupled_on(grid.shape);
    let friction = Friction::coulomb(100.0).unwrap();
    let mut state: Option<FrictionalSolution> = None;
    for step in 1..=steps {
        let radius = (cells * step) as f64 / steps as f64;
        let loading = Loading::pressing(Control::Approach(2.0 * radius * radius));
        let (before, params) = (state.as_ref(), PARAMS.with_tolerance(1e-9));
        let bounds = Bounds::ELASTIC;
        let next =
            solve_frictional(operator.as_mut(), &gap, &bounds, &friction, loading, before, &params).unwrap();
        state = Some(next);
    }
    let state = state.unwrap();
    assert_eq!(state.stick.sum(), state.normal.contact_cells() as f64);
}

#[test]
fn more_force_than_friction_holds_is_an_error_with_the_limit() {
    let grid = Grid::new([12, 12], [1.0, 1.0]).unwrap();
    let gap = gap(grid.shape);
    let mut operator = Operators::new(grid, alike(), Boundary::FREE).coupled_on(grid.shape);
    let mut solve = |force: [f64; 2], coefficient| {
        let loading = Loading { normal: Control::Load(2.0), tangential: Tangential::Force(force) };
        let friction = Friction::coulomb(0.0).unwrap().with_coefficient(coefficient);
        solve_frictional(operator.as_mut(), &gap, &Bounds::ELASTIC, &friction, loading, None, &PARAMS)
    };
    match solve([0.3, 0.4], 0.25) {
        Err(Error::BeyondFriction { force, limit }) => {
            assert!((force - 0.5).abs() < 1e-12 && (limit - 0.5).abs() < 1e-9);
        }
        other => panic!("{:?}", other.map(|s| s.rigid_displacement)),
    }
    let nearly = solve([0.299, 0.398], 0.25).unwrap();
    assert!(nearly.stick.sum() < 0.2 * nearly.normal.contact_cells() as f64);
    assert!(matches!(solve([0.0; 2], -0.1), Err(Error::OutOfRange { quantity: "coefficient", .. })));
    assert!(matches!(
        solve([f64::NAN, 0.0], 0.1),
        Err(Error::OutOfRange { quantity: "tangential force", .. })
    ));
}

#[test]
fn an_increment_is_what_a_cell_by_cell_iteration_finds() {
    let grid = Grid::new([9, 8], [1.0, 0.8]).unwrap();
    let gap = gap(grid.shape);
    let rigid = Material::elastic(INF, 0.0).unwrap();
    let layers = [[1.0, 4.0, 0.2], [0.7, 0.5, 0.45]]
        .map(|[t, young, poisson]| Coating::new(t, young, poisson).unwrap());
    let layered = Material::elastic(2.0, 0.3).unwrap().layered(layers.to_vec());
    for (pair, name) in [
        (alike().into(), "alike"),
        (dissimilar().into(), "dissimilar"),
        (response(&layered, &rigid).unwrap(), "layered"),
    ] {
        let pair: SharedResponse = pair;
        for coupling in [Coupling::Full, Coupling::Goodman, Coupling::None] {
            for (coefficient, shear_strength, hardness) in [
                (0.3, f64::INFINITY, f64::INFINITY),
                (0.8, 0.02, f64::INFINITY),
                (0.2, f64::INFINITY, 0.08),
                (f64::INFINITY, f64::INFINITY, f64::INFINITY),
            ] {
                let friction = Friction::coulomb(coefficient)
                    .unwrap()
                    .with_shear_strength(shear_strength)
                    .with_coupling(coupling);
                let mut operator = CoupledSum::new(grid, pair.clone());
                let reference = CellByCell::new(&mut operator, coupling);
                let what = format!("{name}, {friction:?}, H = {hardness}");
                let mut before: Option<FrictionalSolution> = None;
                let mut slip_before = vec![[0.0; 2]; grid.cells()];
                // Down, sideways, further down and back.
                for (approach, shift) in
                    [(0.4, [0.0, 0.0]), (0.4, [0.05, 0.02]), (0.6, [0.06, 0.08]), (0.5, [0.0, -0.04])]
                {
                    if coefficient.is_infinite() && approach == 0.5 {
                        continue; // A contact that carries any shear and then opens has no solution.
                    }
                    let loading = Loading {
                        normal: Control::Approach(approach),
                        tangential: Tangential::Displacement(shift),
                    };
                    let solution = solve(&mut operator, &gap, hardness, &friction, loading, before.as_ref());
                    let expected = reference.solve(&gap, hardness, &friction, approach, shift, &slip_before);
                    assert_same(&solution, &expected, &what);
                    for (cell, slip) in slip_before.iter_mut().enumerate() {
                        let u = reference.displacement(&expected, cell);
                        *slip = [shift[0] - u[0], shift[1] - u[1]];
                    }
                    before = Some(solution);
                }
            }
        }
    }
}

#[test]
fn what_single_precision_leaves_is_corrected_down_to_any_tolerance() {
    let grid = Grid::new([48, 40], [1.0; 2]).unwrap();
    let gap = 0.1 * gap(grid.shape);
    for pair in [alike(), dissimilar()] {
        for boundary in [Boundary::FREE, Boundary::PERIODIC] {
            let mut operator = Operators::new(grid, pair, boundary).coupled_on(grid.shape);
            let influence = operator.self_influence();
            let compliance = 0.5 * (influence.xx + influence.yy);
            let load = 0.01 * pair.modulus() * grid.area();
            let friction = Friction::coulomb(0.4).unwrap();
            let tangential = Tangential::Force([0.2 * load, -0.1 * load]);
            let loading = Loading { normal: Control::Load(load), tangential };
            let mut solve = |tolerance| {
                let params = PARAMS.with_tolerance(tolerance);
                let (operator, bounds) = (operator.as_mut(), Bounds::ELASTIC);
                solve_frictional(operator, &gap, &bounds, &friction, loading, None, &params).unwrap()
            };
            let exact = solve(1e-11);
            for tolerance in [1e-4, 1e-6, 1e-8, 1e-11] {
                let solution = solve(tolerance);
                let [shear, slip] = [&solution.shear, &solution.slip].map(|[x, y]| x.iter().zip(y));
                let cells = shear.zip(slip).zip(&solution.shear_limit);
                let phi = cells.map(|(((qx, qy), (sx, sy)), limit)| {
                    let [x, y] = [qx + sx / compliance, qy + sy / compliance];
                    let inside = (limit / x.hypot(y)).min(1.0);
                    if *limit > 0.0 { compliance * (qx - inside * x).hypot(qy - inside * y) } else { 0.0 }
                });
                let share = (solution.shear_limit.sum() / solution.normal.pressure.sum()).min(1.0);
                let residual = phi.fold(0.0, f64::max) / (share * solution.normal.displacement.std(0.0));
                assert!(residual < tolerance, "{boundary:?}: {residual:e} of {tolerance:e}");
                for axis in 0..2 {
                    let apart = largest(&(&solution.shear[axis] - &exact.shear[axis])) / exact.max_shear();
                    assert!(apart < 1e3 * tolerance, "{boundary:?}, {tolerance:e}: {apart:e}");
                }
            }
        }
    }
}

/// A smooth contact on a fine grid, up to its edges.
#[test]
fn a_large_contact_takes_no_more_steps_than_a_small_one() {
    let mut cost = Vec::new();
    for n in [64, 192] {
        let pitch = 1.0 / n as f64;
        let grid = Grid::new([n, n], [pitch; 2]).unwrap();
        let gap = Field::from_shape_fn(grid.shape, |(i, j)| {
            let [x, y] = [grid.centre(0, i) - 0.5, grid.centre(1, j) - 0.5];
            0.5 * (x * x + y * y)
        });
        let pair = dissimilar();
        let mut operator = Operators::new(grid, pair, Boundary::FREE).coupled_on(grid.shape);
        let loading = Loading::pressing(Control::Load(0.6 * pair.modulus()));
        let (friction, params) = (Friction::coulomb(0.3).unwrap(), Params::default());
        let solution =
            solve_frictional(operator.as_mut(), &gap, &Bounds::ELASTIC, &friction, loading, None, &params)
                .unwrap();
        assert!(solution.normal.contact_cells() > 9 * n * n / 10);
        cost.push(solution.normal.stats.convolutions);
    }
    assert!(cost.iter().all(|convolutions| *convolutions < 180.0), "{cost:?}");
}

/// A pushed ball is unloaded at a constant displacement: its outer cells slip, then leave. What forces and
/// approach give, less what the bodies keep, is dissipated.
#[test]
fn cells_that_leave_the_contact_dissipate_what_the_bodies_do_not_keep() {
    let grid = Grid::new([24, 24], [1.0; 2]).unwrap();
    let gap = Field::from_shape_fn(grid.shape, |(i, j)| {
        let [x, y] = [0, 1].map(|axis| grid.centre(axis, [i, j][axis]) - 12.0);
        (x * x + y * y) / 200.0
    });
    let friction = Friction::coulomb(0.5).unwrap();
    let params = Params::default().with_tolerance(1e-9);
    let mut operator = Operators::new(grid, alike(), Boundary::FREE).coupled_on(grid.shape);
    let mut solve = |load: f64, push: f64, before: Option<&FrictionalSolution>| {
        let loading =
            Loading { normal: Control::Load(load), tangential: Tangential::Displacement([push, 0.0]) };
        solve_frictional(operator.as_mut(), &gap, &Bounds::ELASTIC, &friction, loading, before, &params)
            .unwrap()
    };
    let pressed = solve(4.0, 0.0, None);
    let push = 0.6 * pressed.normal.approach * 0.5;
    let pushed = solve(4.0, push, Some(&pressed));
    let mut unload = |steps: usize| {
        let (mut last, mut lost, mut touching, mut error) = (pushed.clone(), 0.0, 0.0, 0.0);
        for step in 1..=steps {
            let now = solve(4.0 - 3.9 * step as f64 / steps as f64, push, Some(&last));
            lost += now.dissipation(Some(&last));
            error += now.dissipation_error(&last);
            for (cell, limit) in now.shear_limit.indexed_iter().filter(|(_, limit)| **limit > 0.0) {
                let slip = now.slip[0][cell].hypot(now.slip[1][cell]);
                touching +=
                    if now.stick[cell] == 0.0 { 0.5 * (limit + last.shear_limit[cell]) * slip } else { 0.0 };
            }
            last = now;
        }
        [lost, touching, error, pushed.elastic_energy() - last.elastic_energy()]
    };
    let [_, _, _, kept] = unload(2);
    let fine = unload(64);
    // The same energy by the forces: the work of unloading is that of the trapezoidal rule with the second
    // order.
    assert!((fine[0] - 0.076).abs() < 2e-4 && kept > fine[0], "{fine:?} {kept}");
    let errors = [4, 8, 16].map(|steps| {
        let [lost, touching, error, _] = unload(steps);
        assert!((lost - fine[0]).abs() < error, "{steps}: {lost} {error}");
        assert!(
            touching < lost - 2.0 * (lost - fine[0]),
            "{steps}: without the cells that leave {touching} of {lost}"
        );
        lost / fine[0] - 1.0
    });
    assert!(errors.windows(2).all(|pair| pair[0] / pair[1] > 3.0), "second order: {errors:?}");
}
