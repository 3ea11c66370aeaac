//! Complete contacts with friction of dissimilar bodies on 256 × 256 cells, from zero to η < 1e-6.

use asperity_contact::Grid;
use asperity_contact::material::{Compliances, Material};
use asperity_contact::operator::{Boundary, Operators};
use asperity_contact::solver::{Bounds, Control, Friction, Loading, Params, Tangential, solve_frictional};
use asperity_contact::surface::{Amplitude, SelfAffine};

/// Mean pressure over E*: contact on about 5, 20 and 50 % of the area.
const PRESSURES: [f64; 3] = [0.002, 0.01, 0.03];

fn main() {
    divan::main();
}

#[divan::bench(args = PRESSURES)]
fn free(bencher: divan::Bencher, pressure: f64) {
    measure(bencher, Boundary::FREE, pressure);
}

#[divan::bench(args = PRESSURES)]
fn periodic(bencher: divan::Bencher, pressure: f64) {
    measure(bencher, Boundary::PERIODIC, pressure);
}

/// A polymer under steel, μ = 0.3, with half of the tangential force that friction can hold.
fn measure(bencher: divan::Bencher, boundary: Boundary, pressure: f64) {
    let grid = Grid::new([256, 256], [1e-6; 2]).expect("a grid");
    let form =
        SelfAffine { hurst: 0.8, rolloff: Some(64e-6), shortest: Some(8e-6), amplitude: Amplitude::Sdq(0.1) };
    let gap = -form.generate(&grid, 3).expect("a surface").into_heights();
    let polymer = Material::elastic(3e9, 0.35).expect("a material");
    let steel = Material::elastic(210e9, 0.3).expect("a material");
    let pair = Compliances::new(&polymer, &steel).expect("a pair");
    let mut operator = Operators::new(grid, pair, boundary).coupled_on(grid.shape);
    let friction = Friction::coulomb(0.3).expect("a coefficient");
    let load = pressure * pair.modulus() * grid.area();
    let loading = Loading { normal: Control::Load(load), tangential: Tangential::Force([0.15 * load, 0.0]) };
    bencher.bench_local(|| {
        let (elastic, params) = (f64::INFINITY, Params::default());
        solve_frictional(operator.as_mut(), &gap, &Bounds::up_to(elastic), &friction, loading, None, &params)
            .expect("an equilibrium")
    });
}
