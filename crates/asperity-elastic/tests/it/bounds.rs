//! Bounds of the pressure, cell by cell: every method compared with an independent cell-by-cell iteration.

use asperity_base::{Error, Field, Grid};
use asperity_elastic::operator::{Boundary, DirectSum, Edge, FreeFamily, Operator, PeriodicFft};
use asperity_elastic::solver::{Bounds, Control, Method, Params, Solution, solve_normal};
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A contact with bounds for each cell.
struct Problem {
    operator: Box<dyn Operator>,
    gap: Field,
    lower: Field,
    upper: Field,
}

impl Problem {
    fn random(rng: &mut impl Rng, kind: usize, shape: [usize; 2], attracts: bool) -> Self {
        let grid = Grid::new(shape, [1.0, rng.random_range(0.6..1.7)]).unwrap();
        let operator: Box<dyn Operator> = match kind {
            0 => Box::new(DirectSum::new(grid, 1.3)),
            1 => {
                let line = Boundary([Edge::Free, Edge::Periodic]);
                Box::new(FreeFamily::new(&grid, 1.3, line).operator(shape))
            }
            _ => Box::new(PeriodicFft::new(grid, 1.3)),
        };
        let field = |rng: &mut dyn FnMut() -> f64| Field::from_shape_simple_fn(shape, rng);
        let gap = field(&mut || rng.random_range(0.0..1.0));
        let lower = field(&mut || if attracts { rng.random_range(-0.15..0.0) } else { 0.0 });
        let upper = field(&mut || if rng.random_bool(0.2) { 5.0 } else { rng.random_range(0.05..0.5) });
        Self { operator, gap, lower, upper }
    }

    fn bounds(&self) -> Bounds {
        Bounds::up_to(self.upper.clone()).above(self.lower.clone())
    }

    fn solve(&mut self, control: Control, method: Method, tolerance: f64) -> asperity_base::Result<Solution> {
        let params = Params::default().with_method(method).with_tolerance(tolerance);
        let bounds = self.bounds();
        solve_normal(self.operator.as_mut(), &self.gap, &bounds, control, None, &params)
    }

    /// Returns the pressure at an approach, by projected Gauss–Seidel sweeps to round-off.
    fn cell_by_cell(&self, approach: f64) -> Field {
        let shape = self.operator.grid().shape;
        let cells = shape[0] * shape[1];
        let place = |k: usize| [k / shape[1], k % shape[1]];
        let influence = |k: usize, l: usize| {
            let ([i, j], [m, n]) = (place(k), place(l));
            self.operator.influence(i.abs_diff(m), j.abs_diff(n))
        };
        let mut p = vec![0.0; cells];
        for _ in 0..100_000 {
            let mut change = 0.0f64;
            for k in 0..cells {
                let u: f64 = (0..cells).map(|l| influence(k, l) * p[l]).sum();
                let w = approach - self.gap[place(k)] - u;
                let next = (p[k] + w / influence(k, k)).clamp(self.lower[place(k)], self.upper[place(k)]);
                change = change.max((next - p[k]).abs());
                p[k] = next;
            }
            if change < 1e-15 {
                break;
            }
        }
        Field::from_shape_vec(shape, p).unwrap()
    }
}

const METHODS: [Method; 3] = [Method::Direct, Method::ActiveSet, Method::PolonskyKeer];

fn largest_difference(a: &Field, b: &Field) -> f64 {
    (a - b).iter().fold(0.0, |most: f64, d| most.max(d.abs()))
}

#[test]
fn every_method_keeps_each_cell_in_its_bounds_and_agrees_with_gauss_seidel() {
    let mut rng = ChaCha8Rng::seed_from_u64(21);
    let (mut capped, mut attracted) = (0, 0);
    for n in 0..60 {
        let shape = [rng.random_range(2..8), rng.random_range(2..8)];
        let mut problem = Problem::random(&mut rng, n % 3, shape, n % 2 == 1);
        let approach = rng.random_range(0.1..0.9);
        let expected = problem.cell_by_cell(approach);
        let (bounds, area) = (problem.bounds(), problem.operator.grid().cell_area());
        for method in METHODS {
            let found = problem.solve(Control::Approach(approach), method, 1e-9).unwrap();
            let off = largest_difference(&found.pressure, &expected);
            assert!(off < 1e-7, "{n}, {method:?}: pressures differ by {off:e}");
            for (cell, p) in found.pressure.iter().enumerate() {
                assert!(
                    bounds.lower().value(cell) <= *p && *p <= bounds.upper().value(cell),
                    "{n}, {method:?}"
                );
            }
            // Its load gives the same solution.
            let load = Control::Load(found.load());
            let back = problem.solve(load, method, 1e-9).unwrap();
            assert!((back.load() - found.load()).abs() <= 1e-9 * area * expected.mapv(f64::abs).sum());
            let off = largest_difference(&back.pressure, &expected);
            assert!(off < 1e-5, "{n}, {method:?}: under the load they differ by {off:e}");
            if method == Method::Direct {
                capped += found.capped_cells();
                attracted += found.pressure.iter().filter(|p| **p < 0.0).count();
            }
        }
    }
    assert!(capped > 200 && attracted > 200, "{capped} capped, {attracted} attracted");
}

#[test]
fn on_larger_grids_the_active_set_and_its_cascade_agree_with_the_direct_method() {
    let mut rng = ChaCha8Rng::seed_from_u64(22);
    for n in 0..6 {
        let mut problem = Problem::random(&mut rng, [0, 2][n % 2], [64, 66], n >= 4);
        // Waves of the hardness and of the gap, longer than a cell.
        let wave = |(i, j): (usize, usize)| (0.21 * i as f64).sin() * (0.17 * j as f64 + n as f64).cos();
        problem.gap = Field::from_shape_fn([64, 66], |at| 3.0 * wave(at) + problem.gap[at]);
        problem.upper = Field::from_shape_fn([64, 66], |(i, j)| 0.3 + 0.2 * wave((j, i)));
        let control = Control::Load(200.0);
        let [fast, slow] =
            [Method::ActiveSet, Method::Direct].map(|method| problem.solve(control, method, 1e-9).unwrap());
        assert!(fast.capped_cells() > 20 && fast.capped_cells() == slow.capped_cells());
        let off = largest_difference(&fast.pressure, &slow.pressure);
        assert!(off < 1e-6, "{n}: {off:e}");
        assert!(fast.stats.convolutions < 120.0, "{:?}", fast.stats);
    }
}

/// A uniform field equals its value.
#[test]
fn uniform_bounds_as_fields_come_to_the_same() {
    let mut rng = ChaCha8Rng::seed_from_u64(23);
    let mut problem = Problem::random(&mut rng, 2, [70, 64], false);
    problem.upper.fill(0.4);
    let field = problem.solve(Control::Load(300.0), Method::ActiveSet, 1e-6).unwrap();
    let params = Params::default().with_method(Method::ActiveSet);
    let operator = problem.operator.as_mut();
    let uniform =
        solve_normal(operator, &problem.gap, &Bounds::up_to(0.4), Control::Load(300.0), None, &params)
            .unwrap();
    assert_eq!(field.stats, uniform.stats);
    assert_eq!(field.pressure, uniform.pressure);
}

/// Two flat bodies that attract each other with a stress σ₀ at any distance stay together until the pull is
/// σ₀ on all cells.
#[test]
fn bodies_that_attract_each_other_bear_a_pull() {
    let grid = Grid::new([12, 12], [1.0, 1.0]).unwrap();
    let gap =
        Field::from_shape_fn([12, 12], |(i, j)| 0.01 * ((i as f64 - 5.5).powi(2) + (j as f64 - 5.5).powi(2)));
    let bounds = Bounds::ELASTIC.above(-0.02);
    for method in METHODS {
        let mut operator = DirectSum::new(grid, 1.0);
        let params = Params::default().with_method(method).with_tolerance(1e-8);
        let mut last = f64::NEG_INFINITY;
        for share in [-0.99, -0.5, 0.0, 0.5] {
            let load = Control::Load(share * 0.02 * 144.0);
            let held = solve_normal(&mut operator, &gap, &bounds, load, None, &params).unwrap();
            assert!((held.load() - share * 0.02 * 144.0).abs() < 1e-9, "{method:?}: {}", held.load());
            assert!(held.contact_cells() > 0 && held.approach > last, "{method:?}, {share}");
            last = held.approach;
        }
        let torn = Control::Load(-0.02 * 144.0);
        let torn = solve_normal(&mut operator, &gap, &bounds, torn, None, &params);
        assert!(matches!(torn, Err(Error::OutOfRange { .. })), "{torn:?}");
    }
}

#[test]
fn more_load_than_all_bounds_bear_together_is_refused() {
    let mut rng = ChaCha8Rng::seed_from_u64(24);
    let mut problem = Problem::random(&mut rng, 0, [6, 5], false);
    let limit = problem.operator.grid().cell_area() * problem.upper.sum();
    for method in METHODS {
        let most = problem.solve(Control::Load(0.999 * limit), method, 1e-8).unwrap();
        assert!(most.capped_cells() >= 28, "{method:?}: {}", most.capped_cells());
        match problem.solve(Control::Load(1.001 * limit), method, 1e-8) {
            Err(Error::BeyondPlasticLimit { limit: found, .. }) => {
                assert!((found / limit - 1.0).abs() < 1e-12)
            }
            other => panic!("{other:?}"),
        }
    }
}
