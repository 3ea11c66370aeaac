//! A self-affine surface pressed to a few per cent and to half of full contact, from a cold start.

use asperity_elastic::operator::{FreeFft, Operator, PeriodicFft};
use asperity_elastic::solver::{Bounds, Control, Method, Params, solve_normal};
use asperity_elastic::{Field, Grid};

const CASES: [(usize, f64); 6] = [(128, 0.02), (128, 0.2), (256, 0.02), (256, 0.2), (512, 0.02), (512, 0.2)];

fn main() {
    divan::main();
}

#[divan::bench(args = CASES, sample_count = 10)]
fn free((side, pressure): (usize, f64)) {
    solve(&mut FreeFft::new(square(side), 1.0), pressure);
}

#[divan::bench(args = CASES, sample_count = 10)]
fn periodic((side, pressure): (usize, f64)) {
    solve(&mut PeriodicFft::new(square(side), 1.0), pressure);
}

fn square(side: usize) -> Grid {
    Grid::new([side, side], [1.0, 1.0]).expect("a grid")
}

/// Waves of all lengths from the side to eight cells, with the amplitudes of a self-affine surface.
fn rough(side: usize) -> Field {
    let wave = |i: usize, j: usize, k: usize| {
        let (s, c) = (2.4 * k as f64).sin_cos();
        let turns = (1 << (k / 6)) as f64 / side as f64;
        (std::f64::consts::TAU * turns * (c * i as f64 + s * j as f64) + (k * k) as f64).sin()
            / turns.powf(0.8)
    };
    let waves = 6 * (side.ilog2() as usize - 3);
    Field::from_shape_fn([side, side], |(i, j)| 0.1 * (0..waves).map(|k| wave(i, j, k)).sum::<f64>())
}

fn solve(operator: &mut dyn Operator, pressure: f64) {
    let gap = rough(operator.grid().shape[0]);
    let load = Control::Load(pressure * operator.grid().area());
    let params = Params::default().with_method(Method::ActiveSet);
    solve_normal(operator, &gap, &Bounds::ELASTIC, load, None, &params).expect("an equilibrium");
}
