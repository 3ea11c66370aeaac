//! Random topographies: 256² to 4096² cells of a method each, with what its margin and its spectrum cost.

use asperity::Grid;
use asperity::surface::{Amplitude, Autocorrelation, Generator, LowPass, SelfAffine};

const SIDES: [usize; 3] = [256, 1024, 4096];

fn main() {
    divan::main();
}

#[divan::bench(args = SIDES, sample_count = 5)]
fn low_pass(bencher: divan::Bencher, side: usize) {
    measure(bencher, Generator::LowPass(LowPass { sq: 1.0, cutoff: [8.0; 2] }), side);
}

#[divan::bench(args = SIDES, sample_count = 5)]
fn autocorrelation(bencher: divan::Bencher, side: usize) {
    measure(
        bencher,
        Generator::Autocorrelation(Autocorrelation { sq: 1.0, correlation_length: [16.0; 2] }),
        side,
    );
}

#[divan::bench(args = SIDES, sample_count = 5)]
fn self_affine(bencher: divan::Bencher, side: usize) {
    let amplitude = Amplitude::Sq(1.0);
    let method = SelfAffine { hurst: 0.8, rolloff: Some(128.0), shortest: None, amplitude };
    measure(bencher, Generator::SelfAffine(method), side);
}

fn measure(bencher: divan::Bencher, generator: Generator, side: usize) {
    let grid = Grid::new([side, side], [1.0, 1.0]).expect("a grid");
    bencher.bench_local(|| generator.generate(&grid, 1).expect("a topography"));
}
