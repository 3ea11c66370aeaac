//! Presses two bodies with a given gap together, and prints the solution and its cost as one line of JSON.
//!
//! ```text
//! solve_gap gap.npy mean=0.01 [pitch=1] [modulus=1] [hardness=inf] [boundary=free] [method=active-set]
//!           [work=0.01 range=0.5] [tolerance=1e-6] [repeat=1] [pressure=out.npy]
//! ```
//!
//! `gap.npy` contains the undeformed gap. `load` or `approach` may be given instead of the mean pressure
//! `mean`. With a `work` of adhesion the bodies attract each other exponentially over the `range`, and come
//! from afar. With `repeat` every solve starts afresh, and the median time is printed. `benches/peers/` runs
//! it beside other programs.
#![expect(clippy::print_stdout, reason = "the line of JSON is what it is for")]

use std::collections::HashMap;
use std::error::Error;
use std::time::Instant;

use asperity::adhesion::Adhesion;
use asperity::grid::CellValues;
use asperity::operator::{Boundary, Edge, FreeFft, Operator, PeriodicFft};
use asperity::solver::{Bounds, Control, Method, Params, solve_adhesive, solve_normal};
use asperity::surface::{ReadOptions, Topography};
use asperity::{Choice, Grid};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("solve_gap gap.npy mean=… : see the head of solve_gap.rs")?;
    let options = options(arguments)?;
    let number = |key: &str, default: f64| options.get(key).map_or(Ok(default), |text| text.parse());

    let gap = ReadOptions::default().scan(&path)?.heights;
    let pitch = number("pitch", 1.0)?;
    let grid = Grid::new([gap.nrows(), gap.ncols()], [pitch; 2])?;
    let hardness = number("hardness", f64::INFINITY)?;
    let control = if options.contains_key("approach") {
        Control::Approach(number("approach", f64::NAN)?)
    } else {
        Control::Load(number("load", number("mean", f64::NAN)? * grid.area())?)
    };
    let adhesion = if options.contains_key("work") {
        Some(Adhesion::new(number("work", f64::NAN)?, number("range", f64::NAN)?)?)
    } else {
        None
    };
    let boundary = Boundary([choice(&options, "boundary", Edge::Free)?; 2]);
    let method: Method = choice(&options, "method", Method::ActiveSet)?;
    let params = Params::default().with_method(method).with_tolerance(number("tolerance", 1e-6)?);

    let start = Instant::now();
    let modulus = number("modulus", 1.0)?;
    let mut operator: Box<dyn Operator> = if boundary.leaves_mean_free() {
        Box::new(PeriodicFft::new(grid, modulus))
    } else {
        Box::new(FreeFft::new(grid, modulus))
    };
    let setup = start.elapsed().as_secs_f64();
    let solve = |operator: &mut dyn Operator| {
        let start = Instant::now();
        let solution = match &adhesion {
            Some(adhesion) => {
                let upper = CellValues::Uniform(hardness);
                solve_adhesive(operator, &gap, adhesion, &upper, control, None, &params)
            }
            None => solve_normal(operator, &gap, &Bounds::up_to(hardness), control, None, &params),
        };
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
        "plastic": solution.capped_cells() as f64 / grid.cells() as f64,
        "eta": solution.residual,
        "convolutions": solution.stats.convolutions,
        "iterations": solution.stats.iterations,
        "solve_seconds": seconds[seconds.len() / 2],
        "setup_seconds": setup,
    });
    println!("{report}");
    Ok(())
}

/// Reads the arguments `key=value`.
fn options(arguments: impl Iterator<Item = String>) -> Result<HashMap<String, String>, Box<dyn Error>> {
    const KEYS: [&str; 13] = [
        "mean",
        "load",
        "approach",
        "work",
        "range",
        "pitch",
        "modulus",
        "hardness",
        "boundary",
        "method",
        "tolerance",
        "repeat",
        "pressure",
    ];
    arguments
        .map(|argument| match argument.split_once('=') {
            Some((key, value)) if KEYS.contains(&key) => Ok((key.to_owned(), value.to_owned())),
            _ => Err(format!("`{argument}` is not key=value with a key of {KEYS:?}").into()),
        })
        .collect()
}

/// Returns the choice for a word, or the default if the key is not given.
fn choice<T: Choice>(options: &HashMap<String, String>, key: &str, default: T) -> Result<T, Box<dyn Error>> {
    let Some(word) = options.get(key) else { return Ok(default) };
    T::of_word(word).ok_or_else(|| format!("{key} cannot be `{word}`").into())
}
