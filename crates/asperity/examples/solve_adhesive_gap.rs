//! Presses two bodies that attract each other together, and prints the solution and its cost as one line of JSON.
//!
//! ```text
//! solve_adhesive_gap gap.npy work=0.01 range=0.5 approach=3 [pitch=1] [modulus=1] [boundary=periodic]
//!                    [tolerance=1e-6] [repeat=1] [pressure=out.npy]
//! ```
//!
//! `gap.npy` contains the undeformed gap. The bodies come from afar. With `repeat` every solve starts afresh, and the median
//! time is printed. `benches/peers/` runs it beside other programs.
#![expect(clippy::print_stdout, reason = "the line of JSON is what it is for")]

use std::collections::HashMap;
use std::error::Error;
use std::time::Instant;

use asperity::adhesion::Adhesion;
use asperity::grid::CellValues;
use asperity::operator::{Boundary, Edge, FreeFft, Operator, PeriodicFft};
use asperity::solver::{Control, Params, solve_adhesive};
use asperity::surface::{ReadOptions, Topography};
use asperity::{Choice, Grid};

const KEYS: [&str; 9] =
    ["work", "range", "approach", "pitch", "modulus", "boundary", "tolerance", "repeat", "pressure"];

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("solve_adhesive_gap gap.npy work=… : see the head of the example")?;
    let options = options(arguments)?;
    let number = |key: &str, default: f64| options.get(key).map_or(Ok(default), |text| text.parse());

    let gap = ReadOptions::default().scan(&path)?.heights;
    let pitch = number("pitch", 1.0)?;
    let grid = Grid::new([gap.nrows(), gap.ncols()], [pitch; 2])?;
    let adhesion = Adhesion::new(number("work", f64::NAN)?, number("range", f64::NAN)?)?;
    let control = Control::Approach(number("approach", f64::NAN)?);
    let edge = options.get("boundary").map_or(Some(Edge::Periodic), |word| Edge::of_word(word));
    let boundary = Boundary([edge.ok_or("boundary is periodic or free")?; 2]);
    let params = Params::default().with_tolerance(number("tolerance", 1e-6)?);

    let modulus = number("modulus", 1.0)?;
    let mut operator: Box<dyn Operator> = if boundary.leaves_mean_free() {
        Box::new(PeriodicFft::new(grid, modulus))
    } else {
        Box::new(FreeFft::new(grid, modulus))
    };
    let upper = CellValues::from(f64::INFINITY);
    let solve = |operator: &mut dyn Operator| {
        let start = Instant::now();
        let solution = solve_adhesive(operator, &gap, &adhesion, &upper, control, None, &params);
        solution.map(|solution| (solution, start.elapsed().as_secs_f64()))
    };
    let (solution, first) = solve(operator.as_mut())?;
    let mut seconds = vec![first];
    for _ in 1..number("repeat", 1.0)? as usize {
        seconds.push(solve(operator.as_mut())?.1);
    }
    seconds.sort_by(f64::total_cmp);

    if let Some(out) = options.get("pressure") {
        Topography::new(grid, solution.pressure.clone())?.write(out)?;
    }
    let report = serde_json::json!({
        "load": solution.load(),
        "approach": solution.approach,
        "area": solution.contact_cells() as f64 / grid.cells() as f64,
        "eta": solution.residual,
        "convolutions": solution.stats.convolutions,
        "iterations": solution.stats.iterations,
        "solve_seconds": seconds[seconds.len() / 2],
    });
    println!("{report}");
    Ok(())
}

/// Reads the arguments `key=value`.
fn options(arguments: impl Iterator<Item = String>) -> Result<HashMap<String, String>, Box<dyn Error>> {
    arguments
        .map(|argument| match argument.split_once('=') {
            Some((key, value)) if KEYS.contains(&key) => Ok((key.to_owned(), value.to_owned())),
            _ => Err(format!("`{argument}` is not key=value with a key of {KEYS:?}").into()),
        })
        .collect()
}
