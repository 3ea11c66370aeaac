//! Contacts that are periodic along one axis only.

use asperity_base::{Field, Grid};
use asperity_contact::kernel::{Line, SharedResponse, response};
use asperity_contact::material::{Coating, Compliances, Material};
use asperity_contact::motion::{LoadControl, Motion, Pair, PlasticUpdate, Simulation, Strategy};
use asperity_contact::operator::{Boundary, Edge, Operator, Operators};
use asperity_contact::solver::{Bounds, Control, Method, Params, Solution, residual, solve_normal};

use crate::support::{Kept, compliances, difference, rough_gap, steel};

const ALONG_Y: Boundary = Boundary([Edge::Free, Edge::Periodic]);
const ALONG_X: Boundary = Boundary([Edge::Periodic, Edge::Free]);
const INF: f64 = f64::INFINITY;

/// E* = 1.
fn alike() -> Compliances {
    compliances([0.0; 2], [2.0; 2])
}

fn solve(
    operator: &mut dyn Operator,
    gap: &Field,
    hardness: f64,
    control: Control,
    method: Method,
) -> Solution {
    let params = Params::new().with_method(method).with_tolerance(1e-9).with_max_convolutions(5000);
    solve_normal(operator, gap, &Bounds::up_to(hardness), control, None, &params)
        .unwrap_or_else(|error| panic!("{error}: {method:?}, {hardness}, {control:?}, {:?}", operator.grid()))
}

#[test]
fn any_contact_is_in_equilibrium_by_the_dense_sum_whatever_the_method() {
    arbtest::arbtest(|u| {
        let shape = [u.int_in_range(1..=24)?, u.int_in_range(1..=24)?];
        let pitch = [1.0, *u.choose(&[0.3, 1.0, 2.5])?];
        let grid = Grid::new(shape, pitch).unwrap();
        let boundary = *u.choose(&[ALONG_X, ALONG_Y])?;
        let [width, height] = grid.extent();
        let has_waves = width.max(height) > 4.0 * pitch[1].max(1.0);
        let gap = if has_waves { rough_gap(&grid, u.int_in_range(0..=999)?) } else { grid.zeros() };
        let hardness = *u.choose(&[INF, 0.1])?;
        let control = if *u.choose(&[true, false])? {
            Control::Load(*u.choose(&[1e-3, 0.01, 0.08])? * grid.area())
        } else {
            // Up to beyond the mean gap: no mean displacement is free here.
            Control::Approach(*u.choose(&[0.3, 1.0, 3.0])? * gap.mean().unwrap().max(0.1))
        };
        let mut operator = Operators::new(grid, alike(), boundary).on(shape);
        let [exact, others @ ..] = [Method::Direct, Method::PolonskyKeer, Method::ActiveSet]
            .map(|method| solve(operator.as_mut(), &gap, hardness, control, method));
        for other in &others {
            assert!(
                difference(&other.pressure, &exact.pressure) < 1e-6,
                "{grid:?}, {boundary:?}, {control:?}"
            );
            assert!((other.approach - exact.approach).abs() < 1e-7 * (1.0 + exact.approach.abs()));
        }
        let displacement = Field::from_shape_fn(shape, |(i, j)| {
            let from = exact.pressure.indexed_iter();
            from.map(|((k, l), p)| p * operator.influence(i.abs_diff(k), j.abs_diff(l))).sum()
        });
        let own = operator.influence(0, 0);
        let (bounds, approach) = (Bounds::up_to(hardness), Some(exact.approach));
        let found = residual(&exact.pressure, &displacement, &gap, &bounds, own, approach);
        assert!(found.eta < 1e-8, "{grid:?}, {boundary:?}, {control:?}: {found:?}");
        Ok(())
    })
    .budget_ms(4000);
}

#[test]
fn turned_by_a_quarter_it_is_the_same_contact() {
    let grid = Grid::new([64, 80], [1.0, 0.7]).unwrap();
    let turned = Grid::new([80, 64], [0.7, 1.0]).unwrap();
    let gap = rough_gap(&grid, 3);
    let turned_gap = gap.t().as_standard_layout().into_owned();
    let load = Control::Load(0.01 * grid.area());
    let mut operator = Operators::new(grid, alike(), ALONG_Y).on(grid.shape);
    let mut other = Operators::new(turned, alike(), ALONG_X).on(turned.shape);
    let one = solve(operator.as_mut(), &gap, INF, load, Method::ActiveSet);
    let two = solve(other.as_mut(), &turned_gap, INF, load, Method::ActiveSet);
    assert!(difference(&two.pressure.t().to_owned(), &one.pressure) < 1e-6);
    assert!((two.approach / one.approach - 1.0).abs() < 1e-8);
}

#[test]
fn where_it_begins_along_its_line_makes_no_difference() {
    let grid = Grid::new([70, 65], [1.0, 1.0]).unwrap();
    let gap = rough_gap(&grid, 4);
    let shifted = Field::from_shape_fn(grid.shape, |(i, j)| gap[[i, (j + 17) % 65]]);
    let load = Control::Load(0.01 * grid.area());
    let mut operator = Operators::new(grid, alike(), ALONG_Y).on(grid.shape);
    let one = solve(operator.as_mut(), &gap, INF, load, Method::ActiveSet);
    let two = solve(operator.as_mut(), &shifted, INF, load, Method::ActiveSet);
    let back = Field::from_shape_fn(grid.shape, |(i, j)| two.pressure[[i, (j + 65 - 17) % 65]]);
    assert!(difference(&back, &one.pressure) < 1e-6);
    // From coarse grids, as cheap as the other boundaries.
    assert!(one.stats.convolutions < 45.0, "{:?}", one.stats);
}

#[test]
fn far_from_its_images_a_contact_is_the_free_one() {
    // The contribution of the images is uniform and, to next order, a curvature of third order in size over
    // period.
    let load = 4.0;
    let gap = |grid: &Grid| {
        let [x0, y0] = grid.extent().map(|e| 0.5 * e);
        Field::from_shape_fn(grid.shape, |(i, j)| {
            let (x, y) = (grid.centre(0, i) - x0, grid.centre(1, j) - y0);
            (x * x + y * y) / 20.0
        })
    };
    let free = |grid: Grid| {
        let mut operator = Operators::new(grid, alike(), Boundary::FREE).on(grid.shape);
        solve(operator.as_mut(), &gap(&grid), INF, Control::Load(load), Method::ActiveSet).max_pressure()
    };
    let errors: Vec<f64> = [1, 2, 4]
        .into_iter()
        .map(|periods| {
            let grid = Grid::new([48, 48 * periods], [0.25, 0.25]).unwrap();
            let mut operator = Operators::new(grid, alike(), ALONG_Y).on(grid.shape);
            let line = solve(operator.as_mut(), &gap(&grid), INF, Control::Load(load), Method::ActiveSet);
            (line.max_pressure() / free(grid) - 1.0).abs()
        })
        .collect();
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!(order > 2.5, "{errors:?}: order {order:.2}");
    }
    assert!(errors[2] < 1e-3, "{errors:?}");
}

#[test]
fn a_traction_in_all_directions_displaces_as_the_sum_over_the_line_says() {
    arbtest::arbtest(|u| {
        let shape = [u.int_in_range(1..=14)?, u.int_in_range(1..=14)?];
        let grid = Grid::new(shape, [1.0, *u.choose(&[0.4, 1.0, 2.0])?]).unwrap();
        let (axis, boundary) = *u.choose(&[(0, ALONG_X), (1, ALONG_Y)])?;
        let steel = Material::elastic(2.0, 0.3).unwrap();
        let coated = steel.clone().coated(Coating::new(0.4, 7.0, 0.2).unwrap());
        let half_spaces: SharedResponse = compliances([0.2, 0.4], [1.0, 5.0]).into();
        let pair = if *u.choose(&[true, false])? { half_spaces } else { response(&coated, &steel).unwrap() };
        let seed: usize = u.int_in_range(1..=9)?;
        let traction: [Field; 3] = std::array::from_fn(|n| {
            Field::from_shape_fn(shape, |(i, j)| ((seed * i + 3 * j * j + n * i * j) % 11) as f64 - 4.0)
        });
        let mut operator = Operators::new(grid, pair.clone(), boundary).coupled_on(shape);
        let mut fast: [Field; 3] = std::array::from_fn(|_| grid.zeros());
        operator.apply(traction.each_ref().map(Some), fast.each_mut().map(Some));
        let extent = grid.extent();
        let line = Line { axis, period: extent[axis], datum: extent[1 - axis] };
        let influence = pair.coupled().unwrap().coupled_line_influence(&line, grid.pitch).unwrap();
        let mut slow: [Field; 3] = std::array::from_fn(|_| grid.zeros());
        for (i, j) in ndarray::indices(shape) {
            for (k, l) in ndarray::indices(shape) {
                let offset = |a: usize, b: usize, axis: usize| (a as f64 - b as f64) * grid.pitch[axis];
                let matrix = influence(offset(i, k, 0), offset(j, l, 1));
                for (slow, row) in slow.iter_mut().zip(matrix.matrix()) {
                    slow[[i, j]] += (0..3).map(|n| row[n] * traction[n][[k, l]]).sum::<f64>();
                }
            }
        }
        let largest = slow.iter().flatten().fold(0.0f64, |m, u| m.max(u.abs()));
        for (fast, slow) in fast.iter().flatten().zip(slow.iter().flatten()) {
            assert!((fast - slow).abs() < 1e-11 * largest, "{grid:?}, {boundary:?}: {fast:e} and {slow:e}");
        }
        let work: f64 = traction.iter().zip(&fast).map(|(t, u)| (t * u).sum()).sum();
        assert!(work > 0.0);
        Ok(())
    })
    .budget_ms(3000);
}

#[test]
fn a_body_that_passes_over_another_has_no_rims_at_its_sides() {
    // Uniform along y: so is the contact at every position, and its last rows equal those in the middle.
    let heights = |amplitude: f64| {
        Field::from_shape_fn([40, 24], |(i, _)| {
            amplitude * ((0.7 * i as f64).sin() + (0.31 * i as f64).cos())
        })
    };
    let topography = |heights: Field| {
        asperity_surface::Topography::new(Grid::new([40, 24], [1e-6; 2]).unwrap(), heights).unwrap()
    };
    let pair = Pair::new(topography(heights(2e-8)), topography(-heights(1e-8)), [&steel(INF); 2]).unwrap();
    let motion = Motion::new(Strategy::Overlap, Control::Load(0.02))
        .with_passes(1)
        .with_stride(6)
        .with_load_control(LoadControl::Pass)
        .with_plastic_update(PlasticUpdate::Pass)
        .with_load_tolerance(1e-6)
        .with_friction(None);
    let params = Params::default().with_tolerance(1e-8);
    let kept = Kept::run(Simulation::new(pair.clone(), ALONG_Y, motion, params).unwrap());
    let contacts = &kept.contacts[0];
    assert!(contacts.len() > 10);
    let load = kept.force(0) / contacts.len() as f64;
    assert!((load / 0.02 - 1.0).abs() < 1e-6, "{load}");
    for contact in contacts.iter().filter(|contact| contact.load > 0.0) {
        let field = contact.pressure_field(24);
        let most = contact.max_pressure();
        for row in field.outer_iter() {
            assert!(row.iter().all(|p| (p - row[0]).abs() < 1e-6 * most), "{row}");
        }
    }
    let refused = Simulation::new(pair, ALONG_X, motion, params).err().unwrap();
    assert!(refused.to_string().contains("free along x"), "{refused}");
}

/// The displacements of a pressure without force decay along the free axis. Uniform cells in place of waves miss by
/// (qΔx)²/24.
#[test]
fn on_layers_it_is_a_periodic_contact_whose_free_axis_is_long() {
    let layers = [(0.2, 30.0, 0.2), (1.0, 2.0, 0.45)].map(|(t, e, nu)| Coating::new(t, e, nu).unwrap());
    let [lower, rigid] = [1.0, INF].map(|young| Material::elastic(young, 0.3).unwrap());
    for body in [lower.clone().layered(layers.to_vec()), rigid.clone().layered(layers.to_vec())] {
        let pair = if body.young == INF { response(&body, &lower) } else { response(&body, &rigid) }.unwrap();
        let errors = [8, 16, 32].map(|n| {
            let grid = Grid::new([16 * n, n], [2.0 / n as f64; 2]).unwrap();
            let pressure = Field::from_shape_fn(grid.shape, |(i, j)| {
                let s = (grid.centre(0, i) - 16.0).powi(2);
                let along = (std::f64::consts::PI * grid.centre(1, j)).cos();
                (3.0 - 6.0 * s + s * s) * (-0.5 * s).exp() + (-s).exp() * along
            });
            let [line, periodic] = [ALONG_Y, Boundary::PERIODIC].map(|boundary| {
                let mut displacement = grid.zeros();
                let operators = Operators::new(grid, pair.clone(), boundary);
                operators.on(grid.shape).apply(&pressure, &mut displacement);
                displacement
            });
            difference(&line, &periodic)
        });
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            assert!((1.8..2.2).contains(&order), "{errors:?}: order {order:.2}");
        }
    }
}
