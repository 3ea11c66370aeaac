//! Tests that compare contacts on a grid divided among ranks with those of one process.

use ndarray::s;

use asperity_base::error::Error;
use asperity_base::grid::{CellValues, Field, Grid};
use asperity_base::ranks::Slab;
use asperity_base::ranks::threads::on_ranks;
use asperity_contact::operator::{Boundary, Edge, FreeFamily, Operator, PeriodicFft};
use asperity_contact::solver::{Bounds, Control, Method, Params, Solution, solve_normal};
use asperity_mpi::operator::SlabFft;

const MODULUS: f64 = 110e9;

/// A contact to be solved.
#[derive(Debug, Clone)]
struct Problem {
    grid: Grid,
    boundary: Boundary,
    gap: Field,
    bounds: Bounds,
    control: Control,
    tolerance: f64,
}

impl Problem {
    fn params(&self) -> Params {
        Params::new().with_method(Method::ActiveSet).with_tolerance(self.tolerance)
    }

    /// Solves in one process.
    fn alone(&self) -> Result<Solution, Error> {
        let mut operator: Box<dyn Operator> = if self.boundary == Boundary::PERIODIC {
            Box::new(PeriodicFft::new(self.grid, MODULUS))
        } else {
            Box::new(FreeFamily::new(&self.grid, MODULUS, self.boundary).operator(self.grid.shape))
        };
        solve_normal(operator.as_mut(), &self.gap, &self.bounds, self.control, None, &self.params())
    }

    /// Solves on this number of ranks. Returns the solution of each rank, and the pressure of all.
    fn on(&self, count: usize) -> Vec<Result<(Solution, Field), Error>> {
        on_ranks(count, |ranks| {
            let slab = Slab::new(ranks, self.grid).unwrap();
            let rows = |field: &Field| field.slice(s![slab.rows(), ..]).to_owned();
            let upper = match self.bounds.upper() {
                CellValues::Uniform(upper) => CellValues::Uniform(*upper),
                CellValues::Field(upper) => CellValues::Field(rows(upper)),
            };
            let mut operator = SlabFft::new(slab.clone(), MODULUS, self.boundary);
            let (gap, bounds) = (rows(&self.gap), Bounds::up_to(upper));
            let solution = solve_normal(&mut operator, &gap, &bounds, self.control, None, &self.params())?;
            let pressure = slab.collected(&solution.pressure);
            Ok((solution, pressure))
        })
    }

    /// Compares the contact on several ranks with that of one process, to `accuracy` of the largest pressure
    /// and of the approach.
    fn check(&self, count: usize, one: &Solution, accuracy: f64) {
        let largest = one.max_pressure();
        let on_ranks: Vec<_> = self.on(count).into_iter().map(Result::unwrap).collect();
        for (solution, pressure) in &on_ranks {
            let error = (pressure - &one.pressure).iter().fold(0.0, |m: f64, e| m.max(e.abs()));
            assert!(error <= accuracy * largest, "{count} ranks: {:.1e}, {self:?}", error / largest);
            let apart = (solution.approach - one.approach).abs();
            assert!(apart <= accuracy * one.approach.abs(), "{count} ranks: approach off by {apart:e}");
            assert!(solution.residual < self.tolerance);
            // All ranks have taken the same steps.
            assert_eq!(solution.stats, on_ranks[0].0.stats);
            assert_eq!(solution.approach.to_bits(), on_ranks[0].0.approach.to_bits());
        }
        if let Control::Load(load) = self.control {
            let borne: f64 = on_ranks.iter().map(|(solution, _)| solution.load()).sum();
            assert!((borne / load - 1.0).abs() < 1e-10, "{borne} of {load}");
        }
    }
}

/// Rough heights with waves of many lengths.
fn rough(shape: [usize; 2], seed: u64) -> Field {
    let wave = |k: u64| {
        let mix = (seed * 31 + k).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        [mix % 6, (mix >> 8) % 6, (mix >> 16) % 100].map(|number| number as f64)
    };
    let waves: Vec<[f64; 3]> = (1..=24).map(wave).collect();
    Field::from_shape_fn(shape, |(i, j)| {
        let [x, y] = [(i, shape[0]), (j, shape[1])].map(|(k, n)| k as f64 / n as f64);
        let height = |[k, l, phase]: &[f64; 3]| {
            (std::f64::consts::TAU * (k * x + l * y + phase / 100.0)).cos() / (1.0 + k + l)
        };
        -30e-9 * waves.iter().map(height).sum::<f64>()
    })
}

const LINE: Boundary = Boundary([Edge::Periodic, Edge::Free]);

#[test]
fn on_ranks_it_is_the_contact_of_one_process() {
    let mut number = 0;
    for boundary in [Boundary::FREE, Boundary::PERIODIC, LINE] {
        for (shape, count) in [([48, 40], 4), ([70, 64], 3), ([23, 31], 2), ([5, 40], 4), ([64, 96], 3)] {
            number += 1;
            let grid = Grid::new(shape, [1e-6, 0.8e-6]).unwrap();
            let gap = rough(shape, number);
            let hardness = Field::from_shape_fn(shape, |(i, j)| 2e9 + 1e8 * ((3 * i + 5 * j) % 11) as f64);
            let bounds = match number % 3 {
                0 => Bounds::ELASTIC,
                1 => Bounds::up_to(2.5e9),
                _ => Bounds::up_to(hardness),
            };
            let lowest = gap.iter().copied().fold(f64::INFINITY, f64::min);
            let control = if number % 2 == 0 {
                Control::Load(2e7 * grid.area() * (1 + number % 4) as f64)
            } else {
                Control::Approach(lowest + 15e-9)
            };
            let problem = Problem { grid, boundary, gap, bounds, control, tolerance: 1e-12 };
            problem.check(count, &problem.alone().unwrap(), 1e-10);
        }
    }
}

#[test]
fn coarse_grids_that_are_large_are_divided_too() {
    let shape = [600, 520];
    let grid = Grid::new(shape, [1e-6; 2]).unwrap();
    for (boundary, bounds) in [(Boundary::FREE, Bounds::ELASTIC), (Boundary::PERIODIC, Bounds::up_to(2e9))] {
        let control = Control::Load(4e7 * grid.area());
        let problem = Problem { grid, boundary, gap: rough(shape, 5), bounds, control, tolerance: 1e-10 };
        problem.check(3, &problem.alone().unwrap(), 1e-8);
    }
}

#[test]
fn what_is_wrong_with_the_whole_every_rank_says() {
    let shape = [24, 20];
    let grid = Grid::new(shape, [1e-6; 2]).unwrap();
    let problem = |bounds, control| Problem {
        grid,
        boundary: Boundary::PERIODIC,
        gap: rough(shape, 1),
        bounds,
        control,
        tolerance: 1e-6,
    };
    // The first load is too large for half of the grid, but not for the whole; the second is too large for
    // the whole.
    let limit = 1e9 * grid.area();
    let bearable = problem(Bounds::up_to(1e9), Control::Load(0.7 * limit));
    bearable.check(3, &bearable.alone().unwrap(), 1e-5);
    for error in problem(Bounds::up_to(1e9), Control::Load(1.01 * limit)).on(3) {
        let error = error.unwrap_err();
        assert!(
            matches!(error, Error::BeyondPlasticLimit { limit: found, .. } if (found / limit - 1.0).abs() < 1e-14)
        );
    }
    for error in problem(Bounds::ELASTIC, Control::Approach(1e-6)).on(2) {
        assert!(matches!(error.unwrap_err(), Error::PeriodicFullContact { .. }));
    }
    // The bodies do not touch, and no rank searches for a contact.
    for contact in problem(Bounds::ELASTIC, Control::Approach(-1e-3)).on(3) {
        assert_eq!(contact.unwrap().0.load(), 0.0);
    }
}

#[test]
fn other_methods_are_refused() {
    let shape = [12, 20];
    let grid = Grid::new(shape, [1e-6; 2]).unwrap();
    let errors = on_ranks(2, |ranks| {
        let slab = Slab::new(ranks, grid).unwrap();
        let mut operator = SlabFft::new(slab.clone(), MODULUS, Boundary::FREE);
        let gap = rough(shape, 1).slice(s![slab.rows(), ..]).to_owned();
        let params = Params::new().with_method(Method::Direct);
        solve_normal(&mut operator, &gap, &Bounds::ELASTIC, Control::Load(1e-3), None, &params).unwrap_err()
    });
    assert!(errors.iter().all(|error| error.to_string().contains("only the active set")), "{errors:?}");
}
