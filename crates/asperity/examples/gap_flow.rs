//! Solves for the flow through a gap, and prints the permeability and its cost as one line of JSON.
//!
//! ```text
//! gap_flow gap.npy [ends=reservoirs] [along=x]
//! gap_flow make gap.npy side=512 load=0.05 [seed=1]
//! ```
//!
//! `make` writes the gap of a self-affine surface on a plane under a `load`, the mean pressure over E* h'rms, on a square of
//! 1 m. Faces are harmonic. Processor time and peak memory are those of the process (Linux), the memory with the gap.
//! `benches/peers/gap_flow.py` runs it beside reynoldsflow.
#![expect(clippy::print_stdout, reason = "the line of JSON is what it is for")]

use std::collections::HashMap;
use std::error::Error;

use asperity::flow::{Along, Ends, Faces, Settings, solve};
use asperity::operator::PeriodicFft;
use asperity::solver::{Bounds, Control, Method, Params, solve_normal};
use asperity::surface::{Amplitude, ReadOptions, SelfAffine, Topography};
use asperity::{Choice, Grid};

const SLOPE: f64 = 1e-3;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let options: HashMap<&str, &str> =
        arguments.iter().filter_map(|argument| argument.split_once('=')).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["make", path, ..] => make(path, &options),
        [path, ..] => flow(path, &options),
        [] => Err("gap_flow gap.npy: see the head of gap_flow.rs".into()),
    }
}

fn make(path: &str, options: &HashMap<&str, &str>) -> Result<(), Box<dyn Error>> {
    let number = |key: &str| options.get(key).ok_or(format!("{key}=… is missing"));
    let side: usize = number("side")?.parse()?;
    let load: f64 = number("load")?.parse()?;
    let seed = options.get("seed").map_or(Ok(1), |seed| seed.parse())?;
    let grid = Grid::new([side; 2], [1.0 / side as f64; 2])?;
    let amplitude = Amplitude::Sdq(SLOPE);
    let form = SelfAffine { hurst: 0.8, rolloff: Some(0.25), shortest: Some(1.0 / 16.0), amplitude };
    let initial = form.generate(&grid, seed)?.underside().into_heights();
    let params = Params::default().with_method(Method::ActiveSet);
    let mut operator = PeriodicFft::new(grid, 1.0);
    let load = Control::Load(load * SLOPE * grid.area());
    let solution = solve_normal(&mut operator, &initial, &Bounds::ELASTIC, load, None, &params)?;
    let mut gap = solution.gap();
    gap.zip_mut_with(&solution.pressure, |gap, pressure| *gap = if *pressure > 0.0 { 0.0 } else { *gap });
    Topography::new(grid, gap)?.write(path)?;
    let contact = solution.contact_cells() as f64 / grid.cells() as f64;
    println!("{}", serde_json::json!({ "contact": contact }));
    Ok(())
}

fn flow(path: &str, options: &HashMap<&str, &str>) -> Result<(), Box<dyn Error>> {
    let gap = ReadOptions::default().scan(path)?.heights;
    let grid = Grid::new([gap.nrows(), gap.ncols()], [1.0 / gap.nrows() as f64; 2])?;
    let ends = Ends::of_word(options.get("ends").unwrap_or(&"reservoirs")).ok_or("no such ends")?;
    let along = Along::of_word(options.get("along").unwrap_or(&"x")).ok_or("no such direction")?;
    let settings = Settings { ends, along, faces: Faces::Harmonic, ..Settings::default() };
    let start = processor_seconds()?;
    let flow = solve(&gap, &grid, &settings)?;
    let seconds = processor_seconds()? - start;
    let permeability: Vec<f64> = flow.along.iter().flatten().map(|along| along.permeability).collect();
    let residual =
        flow.along.iter().flatten().map(|along| along.residual.max(along.dissipation)).fold(0.0, f64::max);
    let report = serde_json::json!({
        "permeability": permeability,
        "residual": residual,
        "seconds": seconds,
        "peak_bytes": peak_memory()?,
    });
    println!("{report}");
    Ok(())
}

/// Returns the processor time of the first thread so far.
fn processor_seconds() -> Result<f64, Box<dyn Error>> {
    let times = std::fs::read_to_string("/proc/self/schedstat")?;
    let nanoseconds: f64 = times.split_whitespace().next().ok_or("no time")?.parse()?;
    Ok(1e-9 * nanoseconds)
}

/// Returns the peak memory of this process so far, bytes.
fn peak_memory() -> Result<f64, Box<dyn Error>> {
    let status = std::fs::read_to_string("/proc/self/status")?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).ok_or("no peak memory")?;
    let kilobytes: f64 = line.trim().trim_end_matches("kB").trim().parse()?;
    Ok(1024.0 * kilobytes)
}
