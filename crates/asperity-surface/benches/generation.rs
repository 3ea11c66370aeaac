//! Random topographies: cost of the noise, its transforms, the spectrum and the translation of the heights.

use asperity_base::Grid;
use asperity_surface::{
    Amplitude, Autocorrelation, Band, Decay, Generator, HeightDistribution, LowPass, SelfAffine,
};

const SIDES: [usize; 3] = [256, 1024, 4096];

const HONED: HeightDistribution = HeightDistribution { ssk: -1.0, sku: 4.5 };

fn main() {
    divan::main();
}

#[divan::bench(args = SIDES, sample_count = 5)]
fn low_pass(bencher: divan::Bencher, side: usize) {
    measure(bencher, Generator::LowPass(LowPass::new(1.0, [8.0; 2])), side);
}

#[divan::bench(args = SIDES, sample_count = 5)]
fn low_pass_not_gaussian(bencher: divan::Bencher, side: usize) {
    let method = LowPass { band: Band::Rectangular, heights: HONED, ..LowPass::new(1.0, [8.0; 2]) };
    measure(bencher, Generator::LowPass(method), side);
}

#[divan::bench(args = SIDES, sample_count = 5)]
fn autocorrelation(bencher: divan::Bencher, side: usize) {
    measure(bencher, Generator::Autocorrelation(Autocorrelation::new(1.0, [16.0; 2])), side);
}

#[divan::bench(args = SIDES, sample_count = 5)]
fn autocorrelation_not_gaussian(bencher: divan::Bencher, side: usize) {
    let method =
        Autocorrelation { decay: Decay::Gaussian, heights: HONED, ..Autocorrelation::new(1.0, [16.0; 2]) };
    measure(bencher, Generator::Autocorrelation(method), side);
}

#[divan::bench(args = SIDES, sample_count = 5)]
fn ground(bencher: divan::Bencher, side: usize) {
    let method = Autocorrelation { lay: 0.5, heights: HONED, ..Autocorrelation::new(1.0, [64.0, 8.0]) };
    measure(bencher, Generator::Autocorrelation(method), side);
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
