//! Every method solves the same problem, and the solution satisfies the conditions of contact.

use asperity_base::{CellValues, Error, Field, Grid};
use asperity_contact::adhesion::Adhesion;
use asperity_contact::conductance::{self, Joint, Kind};
use asperity_contact::flow;
use asperity_contact::operator::{DirectSum, FreeFft, Operator, PeriodicFft};
use asperity_contact::solver::{
    Bounds, Control, Method, Params, Solution, residual, solve_adhesive, solve_normal,
};

use crate::support::{difference, rough_gap};

const INF: f64 = f64::INFINITY;
const METHODS: [Method; 3] = [Method::Direct, Method::PolonskyKeer, Method::ActiveSet];

fn grid(shape: [usize; 2]) -> Grid {
    Grid::new(shape, [1.0, 1.0]).unwrap()
}

fn operator(grid: Grid, periodic: bool) -> Box<dyn Operator> {
    operator_of(grid, 1.0, periodic)
}

fn operator_of(grid: Grid, modulus: f64, periodic: bool) -> Box<dyn Operator> {
    if periodic { Box::new(PeriodicFft::new(grid, modulus)) } else { Box::new(FreeFft::new(grid, modulus)) }
}

/// Solves, and checks the conditions of contact.
fn solve(
    method: Method,
    operator: &mut dyn Operator,
    gap: &Field,
    hardness: f64,
    control: Control,
    tolerance: f64,
) -> Solution {
    let params = Params::new().with_method(method).with_tolerance(tolerance).with_max_convolutions(20_000);
    let solution = solve_normal(operator, gap, &Bounds::up_to(hardness), control, None, &params)
        .unwrap_or_else(|e| panic!("{method:?} on {:?}, {control:?}, H = {hardness}: {e}", gap.dim()));
    assert!(solution.residual < tolerance, "{method:?}: residual {:e}", solution.residual);
    assert!(
        solution.pressure.iter().all(|p| (0.0..=hardness).contains(p)),
        "{method:?}: pressure out of bounds"
    );
    if let Control::Load(load) = control {
        let error = solution.load() / load - 1.0;
        assert!(error.abs() <= 1e-10, "{method:?}: relative error of the load {error:e}");
    }
    if operator.influence(0, 0) == 0.0 {
        return solution; // A single periodic cell does not deform: there is no scale for a residual.
    }
    let mut displacement = operator.grid().zeros();
    operator.apply(&solution.pressure, &mut displacement);
    let (bounds, own) = (Bounds::up_to(hardness), operator.influence(0, 0));
    let approach = Some(solution.approach);
    let again = residual(&solution.pressure, &displacement, gap, &bounds, own, approach);
    assert!(
        again.eta < 1.5 * tolerance + 1e-11,
        "{method:?}: residual of the recomputed displacement {again:?}"
    );
    solution
}

fn active_set(periodic: bool, gap: &Field, hardness: f64, control: Control) -> Solution {
    let mut operator = operator(grid([gap.nrows(), gap.ncols()]), periodic);
    solve(Method::ActiveSet, operator.as_mut(), gap, hardness, control, 1e-8)
}

/// The same values, with the columns one after the other in memory.
fn in_columns(field: &Field) -> Field {
    let turned = field.t().as_standard_layout().into_owned().reversed_axes();
    assert!(turned == *field && !turned.is_standard_layout());
    turned
}

#[test]
fn fields_may_have_any_order_in_memory() {
    let grid = grid([24, 16]);
    let gap = rough_gap(&grid, 5);
    let (caps, params) = (gap.mapv(|h| 0.2 + 0.01 * h), Params::default());
    let control = Control::Load(3.0);
    let bounds = [Bounds::up_to(caps.clone()), Bounds::up_to(in_columns(&caps))];
    let [rows, columns] = [(&gap, &bounds[0]), (&in_columns(&gap), &bounds[1])].map(|(gap, bounds)| {
        let start = in_columns(&gap.mapv(|h| (0.1 - h).max(0.0)));
        let mut operator = operator(grid, false);
        solve_normal(operator.as_mut(), gap, bounds, control, Some(&start), &params).unwrap()
    });
    assert_eq!((rows.pressure, rows.approach), (columns.pressure, columns.approach));

    let attraction = Adhesion::new(0.01, 0.3).unwrap();
    let [rows, columns] = [&gap, &in_columns(&gap)].map(|gap| {
        let mut operator = operator(grid, false);
        let caps = CellValues::Field(in_columns(&caps));
        solve_adhesive(operator.as_mut(), gap, &attraction, &caps, control, None, &params).unwrap()
    });
    assert_eq!(rows.pressure, columns.pressure);

    let settings = flow::Settings::default();
    let [rows, columns] = [&gap, &in_columns(&gap)].map(|gap| {
        flow::solve(gap, &grid, &settings).unwrap().along.map(|along| along.map(|along| along.permeability))
    });
    assert_eq!(rows, columns);

    let touching = gap.mapv(|h| h < 0.05);
    let turned = touching.t().as_standard_layout().into_owned().reversed_axes();
    let joint = Joint::new(Kind::Thermal).with_gas(0.01, 0.0);
    let [rows, columns] = [(&touching, &gap), (&turned, &in_columns(&gap))].map(|(touching, gap)| {
        let mut operator = operator(grid, false);
        conductance::solve(operator.as_mut(), touching, Some(gap), &joint, None, &params).unwrap()
    });
    assert_eq!(rows.conductance, columns.conductance);
}

#[test]
fn all_methods_find_the_same_pressure() {
    let grid = grid([24, 20]);
    for seed in 0..3 {
        let gap = rough_gap(&grid, seed);
        for periodic in [false, true] {
            let mut operator = operator(grid, periodic);
            for hardness in [INF, 0.15, 0.06] {
                let loads = [0.002, 0.01, 0.04].map(|mean| Control::Load(mean * grid.area()));
                let mean_gap = gap.mean().unwrap();
                let approaches = [0.1, 0.4, 0.9].map(|share| Control::Approach(share * mean_gap));
                for control in loads.into_iter().chain(approaches) {
                    let [exact, others @ ..] =
                        METHODS.map(|m| solve(m, operator.as_mut(), &gap, hardness, control, 1e-9));
                    for (other, method) in others.iter().zip(&METHODS[1..]) {
                        let error = difference(&other.pressure, &exact.pressure);
                        assert!(error < 1e-6, "{method:?}, {periodic}, {hardness}, {control:?}: {error:e}");
                    }
                }
            }
        }
    }
}

#[test]
fn the_residual_is_that_of_the_direct_sum() {
    let grid = Grid::new([32, 24], [1.0, 0.7]).unwrap();
    let gap = rough_gap(&grid, 5);
    for hardness in [INF, 0.1] {
        let control = Control::Load(0.02 * grid.area());
        let mut fast = FreeFft::new(grid, 1.0);
        let solution = solve(Method::ActiveSet, &mut fast, &gap, hardness, control, 1e-6);
        let mut sum = DirectSum::new(grid, 1.0);
        let mut displacement = grid.zeros();
        sum.apply(&solution.pressure, &mut displacement);
        let (bounds, own) = (Bounds::up_to(hardness), sum.influence(0, 0));
        let independent = residual(&solution.pressure, &displacement, &gap, &bounds, own, None);
        // Single precision may cause an error of a tenth of the tolerance in the displacement, which counts
        // in the residual.
        let below = solution.residual - independent.eta;
        assert!((0.0..0.2e-6).contains(&below), "{independent:?}, {}", solution.residual);
        assert!((independent.approach / solution.approach - 1.0).abs() < 1e-8);
    }
}

#[test]
fn it_never_needs_more_convolutions_than_polonsky_and_keer() {
    let grid = grid([96, 96]);
    let gap = rough_gap(&grid, 1);
    for periodic in [false, true] {
        let mut operator = operator(grid, periodic);
        for (hardness, mean) in
            [INF, 0.15].into_iter().flat_map(|h| [0.0002, 0.002, 0.02, 0.1].map(|m| (h, m)))
        {
            let control = Control::Load(mean * grid.area());
            let [fast, slow] = [Method::ActiveSet, Method::PolonskyKeer].map(|method| {
                solve(method, operator.as_mut(), &gap, hardness, control, 1e-6).stats.convolutions
            });
            assert!(fast <= slow, "{periodic}, H = {hardness}, p = {mean}: {fast} against {slow}");
        }
    }
}

#[test]
fn a_cold_start_costs_few_convolutions() {
    let grid = grid([256, 256]);
    let gap = rough_gap(&grid, 1);
    for periodic in [false, true] {
        let mut operator = operator(grid, periodic);
        for (mean, most) in [(0.0005, 24.0), (0.0025, 26.0), (0.01, 28.0), (0.04, 36.0)] {
            let control = Control::Load(mean * grid.area());
            let stats = solve(Method::ActiveSet, operator.as_mut(), &gap, INF, control, 1e-6).stats;
            assert!(stats.convolutions <= most, "{periodic}, {mean}: {stats:?}");
            let stats = solve(Method::ActiveSet, operator.as_mut(), &gap, 0.2, control, 1e-6).stats;
            assert!(stats.convolutions <= 1.5 * most, "capped, {periodic}, {mean}: {stats:?}");
        }
    }
}

#[test]
fn nearly_full_contact_and_one_per_cent_of_it() {
    for (n, seed, mean, shares) in [(64, 2, 0.2, 0.95..1.0), (128, 3, 3e-4, 0.001..0.02)] {
        let grid = grid([n, n]);
        let gap = rough_gap(&grid, seed);
        for periodic in [false, true] {
            let solution = active_set(periodic, &gap, INF, Control::Load(mean * grid.area()));
            let share = solution.contact_cells() as f64 / grid.cells() as f64;
            assert!(shares.contains(&share) || share == 1.0 && n == 64, "{share}");
        }
    }
}

#[test]
fn long_cells_and_a_strip_of_sixteen_by_512_cells() {
    for (shape, pitch, seed) in [([64, 64], [1.0, 10.0], 4), ([16, 512], [1.0, 1.0], 5)] {
        let grid = Grid::new(shape, pitch).unwrap();
        let gap = rough_gap(&grid, seed);
        for periodic in [false, true] {
            for mean in [0.001, 0.02] {
                let mut operator = operator(grid, periodic);
                let control = Control::Load(mean * grid.area());
                let stats = solve(Method::ActiveSet, operator.as_mut(), &gap, INF, control, 1e-8).stats;
                assert!(stats.convolutions < 80.0, "{shape:?} {periodic} {mean} {stats:?}");
            }
        }
    }
}

#[test]
fn a_single_cell_in_contact() {
    for periodic in [false, true] {
        let mut gap = Field::from_elem([40, 40], 1.0);
        gap[[17, 5]] = 0.0;
        let solution = active_set(periodic, &gap, INF, Control::Load(0.01));
        assert_eq!(solution.contact_cells(), 1);
        assert!((solution.pressure[[17, 5]] - 0.01).abs() < 1e-12);
    }
}

#[test]
fn a_load_just_below_the_plastic_limit() {
    let grid = grid([64, 64]);
    let gap = rough_gap(&grid, 6);
    for periodic in [false, true] {
        for short in [1e-2, 1e-4, 1e-6] {
            let solution =
                active_set(periodic, &gap, 0.05, Control::Load(0.05 * grid.area() * (1.0 - short)));
            let capped = solution.capped_cells() as f64 / grid.cells() as f64;
            assert!(capped > 1.0 - 10.0 * short.max(1e-3), "{periodic} {short}: {capped}");
        }
        let (mut operator, load) = (operator(grid, periodic), Control::Load(0.05 * grid.area()));
        let params = Params::default();
        let beyond = solve_normal(operator.as_mut(), &gap, &Bounds::up_to(0.05), load, None, &params);
        assert!(matches!(beyond, Err(Error::BeyondPlasticLimit { .. })));
    }
}

#[test]
fn the_softer_the_bodies_the_fewer_convolutions() {
    let grid = grid([64, 64]);
    for seed in 0..4 {
        let gap = rough_gap(&grid, seed);
        for periodic in [false, true] {
            for (hardness, most) in [(0.02, 30.0), (0.005, 24.0), (0.001, 16.0), (0.0001, 12.0)] {
                for share in [0.02, 0.2, 0.8] {
                    let load =
                        active_set(periodic, &gap, hardness, Control::Load(share * hardness * grid.area()));
                    let approach = active_set(periodic, &gap, hardness, Control::Approach(load.approach));
                    let most = if share < 0.1 { 1.5 * most } else { most };
                    for stats in [load.stats, approach.stats] {
                        assert!(stats.convolutions <= most, "{periodic}, H = {hardness}, {share}: {stats:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_flat_punch_with_sharp_edges() {
    let side = 96;
    let middle = (side as f64 - 1.0) / 2.0;
    let gap = Field::from_shape_fn([side, side], |(i, j)| {
        if (i as f64 - middle).hypot(j as f64 - middle) <= 24.0 { 0.0 } else { 50.0 }
    });
    for (hardness, most) in [(INF, 60.0), (0.05, 60.0)] {
        let stats = active_set(false, &gap, hardness, Control::Load(40.0)).stats;
        assert!(stats.convolutions <= most, "{stats:?}");
    }
    let elastic = active_set(false, &gap, INF, Control::Load(40.0));
    // A punch of radius a carries 2 a E* δ.
    let load = 2.0 * 24.0 * elastic.approach;
    assert!((load / 40.0 - 1.0).abs() < 0.03, "{load}");
}

#[test]
fn a_rough_sphere() {
    let grid = grid([128, 128]);
    let roughness = rough_gap(&grid, 7);
    let gap = Field::from_shape_fn([128, 128], |(i, j)| {
        let (x, y) = (i as f64 - 63.5, j as f64 - 63.5);
        (x * x + y * y) / 800.0 + roughness[[i, j]]
    });
    for hardness in [INF, 0.1] {
        for load in [0.5, 20.0, 300.0] {
            let stats = active_set(false, &gap, hardness, Control::Load(load)).stats;
            assert!(stats.convolutions <= 60.0, "H = {hardness}, W = {load}: {stats:?}");
        }
    }
}

#[test]
fn an_approach_that_nearly_closes_a_periodic_gap() {
    let grid = grid([64, 64]);
    let gap = rough_gap(&grid, 8);
    let mean_gap = gap.mean().unwrap();
    for share in [0.9, 0.99, 0.999, 0.9999] {
        let solution = active_set(true, &gap, INF, Control::Approach(share * mean_gap));
        assert!(solution.stats.convolutions < 40.0, "{share}: {:?}", solution.stats);
    }
    let (mut operator, approach) = (operator(grid, true), Control::Approach(mean_gap));
    let params = Params::default();
    let closed = solve_normal(operator.as_mut(), &gap, &Bounds::ELASTIC, approach, None, &params);
    assert!(matches!(closed, Err(Error::PeriodicFullContact { .. })));
}

#[test]
fn grids_of_a_few_cells() {
    for shape in [[1, 1], [1, 7], [2, 2], [5, 3]] {
        let grid = grid(shape);
        let gap = Field::from_shape_fn(shape, |(i, j)| 0.01 * ((3 * i + 5 * j) % 7) as f64);
        for periodic in [false, true] {
            let mut operator = operator(grid, periodic);
            for hardness in [INF, 0.1] {
                for method in METHODS {
                    for mean in [1e-4, 0.01, 0.09] {
                        let control = Control::Load(mean * grid.area());
                        solve(method, operator.as_mut(), &gap, hardness, control, 1e-8);
                    }
                    if !periodic {
                        solve(method, operator.as_mut(), &gap, hardness, Control::Approach(0.05), 1e-8);
                    }
                }
            }
        }
    }
}

#[test]
fn bodies_that_do_not_reach_each_other_do_not_press() {
    let gap = Field::from_elem([9, 9], 1.0);
    for method in METHODS {
        for approach in [-2.0, 1.0] {
            let mut operator = operator(grid([9, 9]), false);
            let solution = solve(method, operator.as_mut(), &gap, INF, Control::Approach(approach), 1e-6);
            assert_eq!((solution.contact_cells(), solution.stats.convolutions), (0, 0.0));
        }
    }
}

#[test]
fn a_uniform_contact_converges_by_every_method() {
    for n in [5, 20, 150] {
        let grid = Grid::new([n, n], [1e-6, 1e-6]).unwrap();
        let load = Control::Load(1e8 * grid.area());
        let wave =
            Field::from_shape_fn([n, n], |(i, j)| 1e-15 * ((0.7 * i as f64).sin() + (1.1 * j as f64).cos()));
        let gaps = [Field::zeros([n, n]), Field::from_elem([n, n], 2.3), wave];
        for periodic in [false, true] {
            let mut operator = operator_of(grid, 115e9, periodic);
            for (which, gap) in gaps.iter().enumerate() {
                for method in METHODS.into_iter().filter(|method| n <= 20 || *method != Method::Direct) {
                    let params = Params::default().with_method(method);
                    let what = format!("{n} {periodic} {which} {method:?}");
                    let solution =
                        solve_normal(operator.as_mut(), gap, &Bounds::ELASTIC, load, None, &params)
                            .unwrap_or_else(|error| panic!("{what}: {error}"));
                    assert!(solution.stats.convolutions < 200.0, "{what}: {:?}", solution.stats);
                    let mean = solution.pressure.mean().unwrap();
                    assert!((mean / 1e8 - 1.0).abs() < 1e-10);
                    if periodic {
                        assert!(solution.pressure.iter().all(|p| (p / 1e8 - 1.0).abs() < 1e-5), "{what}");
                    } else {
                        // The punch: the pressure is largest at its corners and smallest in its middle.
                        assert_eq!(solution.contact_cells(), n * n, "{what}");
                        assert!(
                            solution.pressure[[0, 0]] > 2.0 * solution.pressure[[n / 2, n / 2]],
                            "{what}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn heights_far_from_zero_and_light_loads_are_the_same_contact() {
    // In units of a micrometre, with nanometre heights at a distance of 3 m, under ever smaller loads that
    // press one cell down.
    for shape in [[12, 16], [40, 32]] {
        let grid = Grid::new(shape, [1e-6, 1e-6]).unwrap();
        // Heights with few digits, which an offset of 3 m leaves unchanged.
        let near = rough_gap(&grid, 3).mapv(|h| (h * 1e-2 * 2f64.powi(40)).round() * 2f64.powi(-50));
        let far = near.mapv(|h| h + 3.0);
        for periodic in [false, true] {
            let mut operator = operator_of(grid, 115e9, periodic);
            for method in METHODS {
                for load in [1e-12, 1e-9, 1e-6, 1e-4] {
                    let params = Params::default().with_method(method);
                    let [a, b] = [&near, &far].map(|gap| {
                        let load_at = Control::Load(load);
                        let found =
                            solve_normal(operator.as_mut(), gap, &Bounds::ELASTIC, load_at, None, &params);
                        found.unwrap_or_else(|error| {
                            panic!("{shape:?} {periodic} {method:?} {load:e}: {error}")
                        })
                    });
                    let error = difference(&a.pressure, &b.pressure);
                    assert!(error < 1e-4, "{shape:?} {periodic} {method:?} {load:e}: {error:e}");
                    assert!((b.approach - 3.0 - a.approach).abs() < 1e-15 + 1e-3 * a.approach.abs());
                }
            }
        }
    }
}

#[test]
fn the_answer_does_not_depend_on_the_units() {
    // Lengths scaled by 1000^k, and loads with the modulus by any factor: the same numbers.
    let reference = grid([24, 24]);
    let gap = rough_gap(&reference, 8);
    for method in METHODS {
        for periodic in [false, true] {
            let mut operator = operator(reference, periodic);
            let control = Control::Load(0.01 * reference.area());
            let expected = solve(method, operator.as_mut(), &gap, INF, control, 1e-8);
            for (length, modulus) in [(1e-9, 1e12), (1e-9, 1e3), (1e-6, 1e11), (1e-1, 1e14), (1e-1, 1e-10)] {
                let scaled = Grid::new([24, 24], [length, length]).unwrap();
                let mut operator = operator_of(scaled, modulus, periodic);
                let control = Control::Load(0.01 * modulus * scaled.area());
                let found = solve(method, operator.as_mut(), &(&gap * length), INF, control, 1e-8);
                let error = difference(&(&found.pressure / modulus), &expected.pressure);
                assert!(error < 1e-6, "{method:?} {periodic} {length:e} {modulus:e}: {error:e}");
            }
        }
    }
}

#[test]
fn numbers_near_the_ends_of_their_range_are_errors_or_answers_but_never_nan() {
    let shape = [12, 12];
    for n in [12, 40] {
        let shape = shape.map(|_| n);
        for (length, modulus) in
            [(1.0, 1.0), (1e-6, 1e11), (1e-6, 1e-300), (1e-6, 1e300), (1e-15, 1e11), (1e6, 1.0)]
        {
            let grid = Grid::new(shape, [length, length]).unwrap();
            let gap = rough_gap(&self::grid(shape), 2) * length;
            let controls = [1e308, 1e200, 1e20]
                .map(Control::Approach)
                .into_iter()
                .chain([1e-308, 1e-200, 1e-30, 1e30, 1e200, 1e308].map(Control::Load));
            for control in controls {
                for (hardness, method) in
                    [(INF, Method::Auto), (1e9, Method::Auto), (INF, Method::PolonskyKeer)]
                {
                    let params = Params::default().with_method(method).with_max_convolutions(200);
                    let mut operator = FreeFft::new(grid, modulus);
                    if let Ok(solution) =
                        solve_normal(&mut operator, &gap, &Bounds::up_to(hardness), control, None, &params)
                    {
                        let finite =
                            solution.pressure.iter().chain(&solution.displacement).all(|x| x.is_finite());
                        let energy = solution.elastic_energy();
                        assert!(
                            finite
                                && solution.approach.is_finite()
                                && energy.is_finite()
                                && solution.residual < 1e-6,
                            "{n} {length:e} {modulus:e} {hardness:e} {control:?} {method:?}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn a_periodic_contact_with_a_hardness_closes_by_every_method() {
    let grid = grid([16, 16]);
    let gap = rough_gap(&grid, 4);
    let mean_gap = gap.mean().unwrap();
    let mut operator = operator(grid, true);
    for hardness in [0.03, 0.3] {
        for share in [0.98, 1.01, 1.5, 4.0] {
            let control = Control::Approach(share * mean_gap);
            let [exact, others @ ..] =
                METHODS.map(|method| solve(method, operator.as_mut(), &gap, hardness, control, 1e-8));
            for other in others {
                let error = difference(&other.pressure, &exact.pressure);
                assert!(error < 1e-4, "{hardness} {share}: {error:e}");
            }
        }
    }
}
