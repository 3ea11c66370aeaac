//! Cost of static contacts of rough surfaces: convolutions and processor time, for several sides, boundaries
//! and loads.
//!
//! ```text
//! static_contacts [seeds=3] [repeats=3] [shortest=8] [side …]        256 512, unless said otherwise
//! ```
//!
//! The surfaces have a Hurst exponent of 0.8, a roll-off at a quarter of the side and an rms slope of 0.1.
//! Run it on one thread (`RAYON_NUM_THREADS=1`). The time is that of the thread on the processor (Linux), the
//! least of the repeats, summed over the seeds.
#![expect(clippy::print_stdout, reason = "the table is what it is for")]

use std::error::Error;
use std::time::Instant;

use asperity::Grid;
use asperity::operator::{Boundary, Operators};
use asperity::solver::{Bounds, Control, Method, Params, solve_normal};
use asperity::surface::{Amplitude, SelfAffine};

fn main() -> Result<(), Box<dyn Error>> {
    let (mut seeds, mut repeats, mut shortest, mut sides) = (3, 3, 8.0, Vec::new());
    for argument in std::env::args().skip(1) {
        match argument.split_once('=') {
            Some(("seeds", value)) => seeds = value.parse()?,
            Some(("repeats", value)) => repeats = value.parse()?,
            Some(("shortest", value)) => shortest = value.parse()?,
            _ => sides.push(argument.parse()?),
        }
    }
    if sides.is_empty() {
        sides = vec![256, 512];
    }
    for side in sides {
        for boundary in [Boundary::PERIODIC, Boundary::FREE] {
            for mean in [0.002, 0.01, 0.04] {
                measure(side, boundary, mean, shortest, seeds, repeats)?;
            }
        }
    }
    Ok(())
}

/// Prints the mean cost of the contacts of some surfaces.
fn measure(
    side: usize,
    boundary: Boundary,
    mean: f64,
    shortest: f64,
    seeds: u64,
    repeats: usize,
) -> Result<(), Box<dyn Error>> {
    let grid = Grid::new([side, side], [1.0, 1.0])?;
    let operators = Operators::new(grid, 1.0, boundary);
    let params = Params::default().with_method(Method::ActiveSet);
    let (mut convolutions, mut near, mut iterations, mut seconds, mut area) = (0.0, 0.0, 0, 0.0, 0.0);
    for seed in 0..seeds {
        let form = SelfAffine {
            hurst: 0.8,
            rolloff: Some(side as f64 / 4.0),
            shortest: Some(shortest),
            amplitude: Amplitude::Sdq(0.1),
        };
        let gap = form.generate(&grid, 11 + seed)?.underside().into_heights();
        let mut operator = operators.on(grid.shape);
        let mut least = f64::INFINITY;
        for repeat in 0..repeats {
            let start = processor_time();
            let load = Control::Load(mean * grid.area());
            let found = solve_normal(operator.as_mut(), &gap, &Bounds::ELASTIC, load, None, &params)?;
            least = least.min(processor_time() - start);
            if repeat == 0 {
                convolutions += found.stats.convolutions / seeds as f64;
                near += found.stats.near_applications / seeds as f64;
                iterations += found.stats.iterations;
                area += found.contact_cells() as f64 / grid.cells() as f64 / seeds as f64;
            }
        }
        seconds += least;
    }
    println!(
        "{side} {} {mean} area {:.1} % convolutions {convolutions:.2} near {near:.1} iterations {:.1} ms {:.2}",
        if boundary == Boundary::FREE { "free" } else { "periodic" },
        100.0 * area,
        iterations as f64 / seeds as f64,
        1e3 * seconds / seeds as f64
    );
    Ok(())
}

/// Returns the time of this thread on the processor, or the wall time elsewhere than on Linux, s.
fn processor_time() -> f64 {
    static START: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
    let measured = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = measured.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| START.get_or_init(Instant::now).elapsed().as_secs_f64(), |ns| 1e-9 * ns)
}
