//! A user-defined surface: a steel ball on a plate with dimples.
//!
//! # Problem
//!
//! Bearing surfaces have dimples to hold oil. How much do their edges increase the largest pressure, and how
//! much contact area do they remove?
//!
//! # Program
//!
//! Heights are an array `[ix, iy]` in metres on a grid, positive upwards. They may come from any function,
//! file or measurement. The upper body is given like the lower one, and turned over by `underside`.
//!
//! `cargo run --release -p asperity --example own_surface`
//!
//! # Result
//!
//! ```text
//!  dimples (µm)   p max (GPa)   area (µm²)
//!          0.00          0.99         2286
//!          0.02          1.25         2205
//!          0.05          1.58         2073
//!          0.10          1.94         2002
//!          0.30          2.16         1974
//! ```
#![expect(clippy::print_stdout, reason = "an example prints its result")]

use asperity::material::Material;
use asperity::motion::{Pair, SlipRegime, press};
use asperity::operator::Boundary;
use asperity::solver::{Control, Params};
use asperity::surface::{Form, Topography};
use asperity::{Field, Grid};

fn main() -> asperity::Result<()> {
    let grid = Grid::new([256, 256], [0.5e-6; 2])?;
    let steel = Material::elastic(210e9, 0.3)?;
    let ball = Form::Sphere { radius: 2e-3 }.on(&grid)?.underside();

    println!(" dimples (µm)   p max (GPa)   area (µm²)");
    for depth in [0.0, 0.02e-6, 0.05e-6, 0.1e-6, 0.3e-6] {
        let plate = Topography::new(grid, dimples(&grid, depth))?;
        let pair = Pair::new(plate, ball.clone(), [&steel, &steel])?;
        let (load, params) = (Control::Load(1.5), Params::default());
        let contact = press(&pair, Boundary::FREE, load, SlipRegime::Frictionless, &params, &())?.record;
        let [depth, pressure, area] = [depth * 1e6, contact.max_pressure * 1e-9, contact.contact_area * 1e12];
        println!("{depth:13.2} {pressure:13.2} {area:12.0}");
    }
    Ok(())
}

/// Round dimples with a diameter of 6 µm, 12 µm apart, with `depth` in the middle and smooth edges. The
/// pressure at a sharp edge would increase with each finer grid.
fn dimples(grid: &Grid, depth: f64) -> Field {
    const APART: f64 = 12e-6;
    const RADIUS: f64 = 3e-6;
    Field::from_shape_fn(grid.shape, |(i, j)| {
        // Relative to the middle of the nearest dimple; the middle of the grid lies between four of them.
        let from_middle = |index: usize, axis: usize| {
            let place = (index as f64 + 0.5 - 0.5 * grid.shape[axis] as f64) * grid.pitch[axis];
            place.rem_euclid(APART) - 0.5 * APART
        };
        let distance = from_middle(i, 0).hypot(from_middle(j, 1));
        -depth * (1.0 - (distance / RADIUS).powi(2)).max(0.0).powi(2)
    })
}
