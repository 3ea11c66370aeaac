//! One displacement from one pressure: dense as in full contact, and sparse as at a per cent of it.

use asperity_elastic::material::Compliances;
use asperity_elastic::operator::{Boundary, FreeFft, Operator, Operators, PeriodicFft};
use asperity_elastic::{Field, Grid, SingleField};

const SIDES: [usize; 4] = [128, 256, 512, 1024];

fn main() {
    divan::main();
}

#[divan::bench(args = SIDES)]
fn free(bencher: divan::Bencher, side: usize) {
    measure(bencher, &mut FreeFft::new(square(side), 1.0), 1);
}

#[divan::bench(args = SIDES)]
fn periodic(bencher: divan::Bencher, side: usize) {
    measure(bencher, &mut PeriodicFft::new(square(side), 1.0), 1);
}

#[divan::bench(args = SIDES)]
fn free_tenth_of_the_rows(bencher: divan::Bencher, side: usize) {
    measure(bencher, &mut FreeFft::new(square(side), 1.0), 10);
}

#[divan::bench(args = SIDES)]
fn free_single(bencher: divan::Bencher, side: usize) {
    measure_single(bencher, &mut FreeFft::new(square(side), 1.0));
}

#[divan::bench(args = SIDES)]
fn periodic_single(bencher: divan::Bencher, side: usize) {
    measure_single(bencher, &mut PeriodicFft::new(square(side), 1.0));
}

/// Three tractions to three displacements, for two dissimilar bodies.
#[divan::bench(args = SIDES)]
fn free_coupled(bencher: divan::Bencher, side: usize) {
    measure_coupled(bencher, Boundary::FREE, side);
}

#[divan::bench(args = SIDES)]
fn periodic_coupled(bencher: divan::Bencher, side: usize) {
    measure_coupled(bencher, Boundary::PERIODIC, side);
}

fn square(side: usize) -> Grid {
    Grid::new([side, side], [1.0, 1.0]).expect("a grid")
}

fn measure(bencher: divan::Bencher, operator: &mut dyn Operator, every: usize) {
    let shape = operator.grid().shape;
    let pressure =
        Field::from_shape_fn(shape, |(i, j)| if i % every == 0 { (i * j % 7) as f64 } else { 0.0 });
    let mut displacement = operator.grid().zeros();
    bencher.bench_local(|| operator.apply(&pressure, &mut displacement));
}

fn measure_single(bencher: divan::Bencher, operator: &mut dyn Operator) {
    let pressure = SingleField::from_shape_fn(operator.grid().shape, |(i, j)| (i * j % 7) as f32);
    let mut displacement = SingleField::zeros(operator.grid().shape);
    bencher.bench_local(|| operator.apply_single(&pressure, &mut displacement));
}

fn measure_coupled(bencher: divan::Bencher, boundary: Boundary, side: usize) {
    let grid = square(side);
    let shape = grid.shape;
    let compliances = Compliances { normal: 1.0, lateral: 0.4, coupling: 0.2 };
    let mut operator = Operators::new(grid, compliances, boundary).coupled_on(shape);
    let traction: [Field; 3] =
        std::array::from_fn(|n| Field::from_shape_fn(shape, |(i, j)| ((i * j + n) % 7) as f64));
    let mut displacement: [Field; 3] = std::array::from_fn(|_| Field::zeros(shape));
    bencher.bench_local(|| {
        operator.apply(traction.each_ref().map(Some), displacement.each_mut().map(Some));
    });
}
