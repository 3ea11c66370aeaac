//! A pass of two rough steel bodies, with 64 × 64 cells at 127 positions and with 256 × 256 cells at 128: its
//! contacts, and their flash temperatures.

use asperity_contact::Grid;
use asperity_contact::material::Material;
use asperity_contact::motion::{Contact, Motion, Pair, Simulation, Strategy};
use asperity_contact::operator::Boundary;
use asperity_contact::solver::{Control, Friction, Params};
use asperity_contact::surface::{Amplitude, SelfAffine};
use asperity_contact::temperature::{FlashTemperature, Thermal};

/// Cells per side, and stride.
const PASSES: [(usize, usize); 2] = [(64, 1), (256, 4)];
const PITCH: f64 = 1e-6;
const FRICTION: f64 = 0.1;
const SPEED: f64 = 0.5;

fn main() {
    divan::main();
}

#[divan::bench(args = PASSES, sample_count = 5)]
fn contacts(bencher: divan::Bencher, (side, stride): (usize, usize)) {
    let simulation = simulation(side, stride);
    bencher.bench_local(|| simulation.solve(&()).expect("a pass"));
}

#[divan::bench(args = PASSES, sample_count = 5)]
fn temperature(bencher: divan::Bencher, (side, stride): (usize, usize)) {
    let pass = simulation(side, stride).solve(&()).expect("a pass");
    let heated: Vec<_> = pass.contacts().iter().map(|contact| heated(contact, side)).collect();
    let steel = Thermal::new(46.0, 460.0, 7850.0).expect("steel");
    let step = stride as f64 * PITCH / SPEED;
    let grid = Grid::new([side; 2], [PITCH; 2]).expect("a grid");
    let mut flash =
        FlashTemperature::new([&grid; 2], [steel; 2], Boundary::FREE, heated.len(), step, [373.0; 2])
            .expect("two bodies");
    bencher.bench_local(|| {
        flash.begin();
        for (lower, upper, flux) in &heated {
            flash.step([lower, upper], flux).expect("a temperature");
        }
    });
}

/// Returns the cells of both bodies and the frictional heat flux into each.
fn heated(contact: &Contact, width: usize) -> (Vec<u32>, Vec<u32>, Vec<f64>) {
    let moved =
        |first: usize| contact.pressure.iter().map(|(cell, _)| cell + (first * width) as u32).collect();
    let flux = contact.pressure.iter().map(|(_, p)| FRICTION * p * SPEED).collect();
    (moved(contact.position.lower), moved(contact.position.upper), flux)
}

/// Steel with a hardness of 4 GPa and a roughness of 0.1 µm with waves down to eight cells, under a mean
/// pressure of 100 MPa.
fn simulation(side: usize, stride: usize) -> Simulation {
    let grid = Grid::new([side; 2], [PITCH; 2]).expect("a grid");
    let rough = SelfAffine {
        hurst: 0.8,
        rolloff: Some(32.0 * PITCH),
        shortest: Some(8.0 * PITCH),
        amplitude: Amplitude::Sq(0.1e-6),
    };
    let [lower, upper] = [1, 2].map(|seed| rough.generate(&grid, seed).expect("a surface"));
    let steel = Material::new(210e9, 0.3, 4e9).expect("steel");
    let pair = Pair::new(lower, upper.underside(), [&steel, &steel]).expect("a pair");
    let motion = Motion::new(Strategy::Overlap, Control::Load(0.5 * 1e8 * grid.area()))
        .with_stride(stride)
        .with_friction(Friction::coulomb(FRICTION).expect("a coefficient"));
    Simulation::new(pair, Boundary::FREE, motion, Params::default()).expect("a motion")
}
