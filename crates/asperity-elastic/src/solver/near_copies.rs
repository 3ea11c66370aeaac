//! Tests that compare contacts solved with near copies of their operators with those solved without.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::{Bounds, Control, Method, NearCopies, Params, Solution, solve_normal, solve_normal_by};
use crate::grid::{Field, Grid};
use crate::operator::{Boundary, Compliant, Edge, Operator, Operators};

const MODULUS: f64 = 90e9;
const PERIODIC: Boundary = Boundary::PERIODIC;
const LINE: Boundary = Boundary([Edge::Periodic, Edge::Free]);

fn near(
    operator: &mut dyn Operator,
    gap: &Field,
    bounds: &Bounds,
    control: Control,
    params: &Params,
) -> Solution {
    solve_normal_by(operator, gap, bounds, control, None, params, (&(), NearCopies::All)).unwrap()
}

/// Rough heights of some 10 nm, with waves down to 8 cells.
fn rough([nx, ny]: [usize; 2], random: &mut ChaCha8Rng) -> Field {
    let waves: Vec<[f64; 3]> = (0..60)
        .map(|_| {
            let most = [nx, ny].map(|n| (n / 8).max(2) as f64);
            [
                random.random_range(0.0..most[0]).floor(),
                random.random_range(0.0..most[1]).floor(),
                random.random_range(0.0..1.0),
            ]
        })
        .collect();
    Field::from_shape_fn([nx, ny], |(i, j)| {
        let [x, y] = [i as f64 / nx as f64, j as f64 / ny as f64];
        let height = |[k, l, phase]: &[f64; 3]| {
            (std::f64::consts::TAU * (k * x + l * y + phase)).cos() / (1.0 + k.hypot(*l)).powf(1.5)
        };
        -40e-9 * waves.iter().map(height).sum::<f64>()
    })
}

#[test]
fn the_contact_is_that_without_near_copies() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let params = Params::new().with_method(Method::ActiveSet).with_tolerance(1e-10);
    for (number, (boundary, shape)) in [
        (PERIODIC, [64, 128]),
        (PERIODIC, [96, 80]),
        (Boundary::FREE, [64, 64]),
        (Boundary::FREE, [61, 75]),
        (LINE, [64, 51]),
        (LINE, [128, 40]),
        (PERIODIC, [128, 64]),
        (Boundary::FREE, [70, 64]),
        (LINE, [64, 64]),
    ]
    .into_iter()
    .enumerate()
    {
        let grid = Grid::new(shape, [1e-6, if number % 2 == 0 { 1e-6 } else { 0.8e-6 }]).unwrap();
        let gap = rough(shape, &mut random);
        let hardness = Field::from_shape_fn(shape, |(i, j)| 1.2e9 + 1e8 * ((3 * i + 5 * j) % 11) as f64);
        let bounds = match number % 4 {
            0 => Bounds::ELASTIC,
            1 => Bounds::up_to(1.5e9),
            2 => Bounds::up_to(hardness).above(-2e7),
            _ => Bounds::ELASTIC.above(-1e7),
        };
        let lowest = gap.iter().copied().fold(f64::INFINITY, f64::min);
        let mean = gap.mean().unwrap();
        for control in [Control::Load(1.5e8 * grid.area()), Control::Approach(lowest + 0.6 * (mean - lowest))]
        {
            let operators = Operators::new(grid, MODULUS, boundary);
            let mut operator = operators.on(shape);
            assert!(operator.has_near_copy(), "{boundary:?}, {shape:?}");
            let one = near(operator.as_mut(), &gap, &bounds, control, &params);
            let other = solve_normal(operator.as_mut(), &gap, &bounds, control, None, &params).unwrap();
            assert!(one.stats.near_applications > 0.0 && other.stats.near_applications == 0.0);
            assert!(one.residual < 1e-10 && other.residual < 1e-10);
            let error = (&one.pressure - &other.pressure).iter().fold(0.0, |m: f64, e| m.max(e.abs()));
            let what = format!("{boundary:?}, {shape:?}, {bounds:?}, {control:?}");
            assert!(error < 1e-7 * other.max_pressure(), "{error:e}: {what}");
            let scale = other.approach.abs().max(1e-9);
            assert!((one.approach - other.approach).abs() < 1e-8 * scale, "{what}");
        }
    }
}

#[test]
fn it_takes_few_convolutions_and_additional_compliance_counts() {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let params = Params::new().with_method(Method::ActiveSet);
    for (boundary, shape) in
        [(PERIODIC, [128, 128]), (Boundary::FREE, [128, 128]), (Boundary::FREE, [101, 128])]
    {
        let grid = Grid::new(shape, [1e-6; 2]).unwrap();
        let gap = rough(shape, &mut random);
        for mean in [5e7, 3e8] {
            let mut operator = Operators::new(grid, MODULUS, boundary).on(shape);
            let control = Control::Load(mean * grid.area());
            let found = near(operator.as_mut(), &gap, &Bounds::ELASTIC, control, &params);
            assert!(found.stats.convolutions <= 8.0, "{boundary:?} {mean}: {:?}", found.stats);
            assert!(found.stats.near_applications >= found.stats.convolutions);
            let mut soft = Compliant::new(operator, 2e-18).unwrap();
            let one = near(&mut soft, &gap, &Bounds::ELASTIC, control, &params);
            let other = solve_normal(&mut soft, &gap, &Bounds::ELASTIC, control, None, &params).unwrap();
            assert!((one.approach - other.approach).abs() < 1e-5 * other.approach.abs());
            assert!(one.stats.convolutions <= 8.0, "compliant, {boundary:?} {mean}: {:?}", one.stats);
        }
    }
}

#[test]
fn the_threads_do_not_change_the_bits() {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let grid = Grid::new([256, 200], [1e-6; 2]).unwrap();
    let gap = rough(grid.shape, &mut random);
    let params = Params::new().with_method(Method::ActiveSet);
    let pressure = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut operator = Operators::new(grid, MODULUS, Boundary::FREE).on(grid.shape);
        let control = Control::Load(2e8 * grid.area());
        pool.install(|| near(operator.as_mut(), &gap, &Bounds::ELASTIC, control, &params).pressure)
    };
    assert_eq!(pressure(1), pressure(3));
}
