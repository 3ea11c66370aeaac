//! How the real area of contact grows with the load.
//!
//! # Problem
//!
//! Two rough steel surfaces are pressed together. They touch at their summits only. How large is the real
//! contact area A, as a fraction of the apparent area A₀, at a mean pressure p̄ = W/A₀?
//!
//! # Mathematics
//!
//! As long as it is small, the area is proportional to the load for any roughness:
//!
//! ```text
//! A/A₀ = κ p̄/(E* h′),   h′ the rms slope of the gap
//! ```
//!
//! with κ from √(8/π) ≈ 1.6 (Persson) to √(2π) ≈ 2.5 (Bush, Gibson & Thomas). Near full contact it grows more
//! slowly. A finite grid overestimates the area by half a cell around each contact spot, so that κ is
//! slightly too large.
//!
//! # Program
//!
//! `cargo run --release -p asperity --example area_and_load`
//!
//! # Result
//!
//! ```text
//!   p̄ (MPa)     A/A₀      κ   convolutions
//!         5   0.0044   2.90           12.5
//!        10   0.0086   2.80           13.7
//!        20   0.0158   2.57           12.4
//!        50   0.0361   2.35           13.1
//!       100   0.0692   2.26           15.7
//!       200   0.1326   2.16           17.7
//!       500   0.3054   1.99           18.7
//!      1000   0.5324   1.74           18.2
//!      2000   0.8305   1.35           17.1
//! ```
//!
//! At small loads a contact spot has few cells, and its edge has the largest effect. From about ten per cent
//! of contact the spots begin to merge.
#![expect(clippy::print_stdout, reason = "an example prints its result")]

use asperity::Grid;
use asperity::material::Material;
use asperity::motion::{Pair, SlipRegime, press};
use asperity::operator::Boundary;
use asperity::solver::{Control, Params};
use asperity::surface::{Amplitude, SelfAffine};

fn main() -> asperity::Result<()> {
    // Self-affine surfaces are periodic, so that the contact has no boundary.
    let grid = Grid::new([256, 256], [0.5e-6; 2])?;
    let roughness = SelfAffine {
        hurst: 0.8,
        rolloff: Some(32e-6),
        shortest: Some(4e-6),
        amplitude: Amplitude::Sdq(0.02),
    };
    let steel = Material::elastic(210e9, 0.3)?;
    let lower = roughness.generate(&grid, 1)?;
    let upper = roughness.generate(&grid, 2)?.underside();
    // For independent surfaces the squares of the slopes add up.
    let slope = lower.sdq().hypot(upper.sdq());
    let pair = Pair::new(lower, upper, [&steel, &steel])?;

    println!("  p̄ (MPa)     A/A₀      κ   convolutions");
    for mean_pressure in [5e6, 10e6, 20e6, 50e6, 100e6, 200e6, 500e6, 1e9, 2e9] {
        let (load, params) = (Control::Load(mean_pressure * grid.area()), Params::default());
        let contact = press(&pair, Boundary::PERIODIC, load, SlipRegime::Frictionless, &params, &())?.record;
        let area = contact.contact_area / contact.apparent_area;
        let kappa = area * pair.modulus() * slope / mean_pressure;
        println!("{:9.0} {area:8.4} {kappa:6.2} {:14.1}", mean_pressure / 1e6, contact.convolutions);
    }
    Ok(())
}
