//! The active set converges on a wide range of surfaces, boundaries, caps, loads and starts.

use asperity_base::{Field, Grid};
use asperity_contact::operator::{FreeFft, Operator, PeriodicFft};
use asperity_contact::solver::{Bounds, Control, Method, Params, solve_normal};
use asperity_surface::{Amplitude, SelfAffine};

const SIDE: usize = 64;
const HARDNESSES: [f64; 3] = [f64::INFINITY, 0.2, 0.05];
const MEAN_PRESSURES: [f64; 4] = [0.0005, 0.005, 0.02, 0.06];
const TOLERANCE: f64 = 1e-8;

#[test]
fn it_converges_on_every_fifth_surface() {
    stress((0..40).step_by(5));
}

#[test]
#[ignore = "half a minute: the same on every surface"]
fn it_converges_on_every_surface() {
    stress(0..40);
}

#[test]
fn a_solution_is_returned_unchanged_as_a_start() {
    let grid = Grid::new([SIDE, SIDE], [1.0, 1.0]).unwrap();
    let params = Params::new().with_method(Method::ActiveSet);
    for seed in 0..8 {
        let gap = rough(&grid, seed);
        let operators: [Box<dyn Operator>; 2] =
            [Box::new(FreeFft::new(grid, 1.0)), Box::new(PeriodicFft::new(grid, 1.0))];
        for mut operator in operators {
            for (hardness, mean) in [(f64::INFINITY, 0.005), (f64::INFINITY, 0.06), (0.05, 0.02)] {
                let (bounds, load) = (Bounds::up_to(hardness), Control::Load(mean * grid.area()));
                let mut solve =
                    |start| solve_normal(operator.as_mut(), &gap, &bounds, load, start, &params).unwrap();
                let first = solve(None);
                let again = solve(Some(&first.pressure));
                let case = format!("seed {seed}, {:?}, {hardness}, {mean}", operator.boundary());
                assert!(
                    again.pressure == first.pressure,
                    "{case}: {} then {}",
                    first.residual,
                    again.residual
                );
            }
        }
    }
}

/// The most expensive solution, and its problem.
#[derive(Default)]
struct Worst {
    convolutions: f64,
    case: String,
}

fn stress(seeds: impl Iterator<Item = u64>) {
    let grid = Grid::new([SIDE, SIDE], [1.0, 1.0]).unwrap();
    let (mut cascade, mut uniform) = (Worst::default(), Worst::default());
    for seed in seeds {
        let gap = rough(&grid, seed);
        let operators: [Box<dyn Operator>; 2] =
            [Box::new(FreeFft::new(grid, 1.0)), Box::new(PeriodicFft::new(grid, 1.0))];
        for mut operator in operators {
            for (hardness, mean) in HARDNESSES.iter().flat_map(|h| MEAN_PRESSURES.map(|mean| (*h, mean))) {
                if mean > 0.8 * hardness {
                    continue;
                }
                let flat = Field::from_elem(gap.raw_dim(), mean);
                for (start, worst) in [(None, &mut cascade), (Some(&flat), &mut uniform)] {
                    let boundary = operator.boundary();
                    let case =
                        format!("seed {seed}, {boundary:?}, hardness {hardness}, mean pressure {mean}");
                    let params = Params::new()
                        .with_method(Method::ActiveSet)
                        .with_tolerance(TOLERANCE)
                        .with_max_convolutions(300);
                    let load = Control::Load(mean * grid.area());
                    let solution =
                        solve_normal(operator.as_mut(), &gap, &Bounds::up_to(hardness), load, start, &params);
                    let solution =
                        solution.unwrap_or_else(|e| panic!("{case}, start {}: {e}", start.is_some()));
                    if solution.stats.convolutions > worst.convolutions {
                        *worst = Worst { convolutions: solution.stats.convolutions, case };
                    }
                }
            }
        }
    }
    for (start, worst, most) in [("the cascade", cascade, 27.0), ("uniform", uniform, 40.0)] {
        let Worst { convolutions, case } = worst;
        assert!(convolutions <= most, "from {start} at worst {convolutions} convolutions, {case}");
    }
}

/// A self-affine surface with rms slope 0.1, whose longest and shortest waves depend on the seed.
fn rough(grid: &Grid, seed: u64) -> Field {
    let side = SIDE as f64;
    let rolloff = side / [1.0, 2.0, 4.0][seed as usize % 3];
    let shortest = [8.0, 4.0, 2.0][(seed / 3) as usize % 3];
    let form = SelfAffine {
        hurst: 0.8,
        rolloff: Some(rolloff),
        shortest: Some(shortest),
        amplitude: Amplitude::Sdq(0.1),
    };
    -form.generate(grid, seed).unwrap().into_heights()
}
