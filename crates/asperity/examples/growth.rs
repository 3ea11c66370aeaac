//! Growth of the cost of a static contact with the number of cells. A self-affine surface with waves from a
//! quarter of the side to eight cells is pressed to 5 % of contact, with a free boundary, from a cold start.
//!
//! ```text
//! growth [side …]        128 256 512 1024 2048 4096, unless said otherwise
//! ```
//!
//! Prints a table and the q of the fit t ∝ (N² log N)^q. Peak memory is that of the process (Linux),
//! including gap and operator. No solution is kept while the next is computed.
#![expect(clippy::print_stdout, reason = "the table is what it is for")]

use std::error::Error;
use std::time::Instant;

use asperity::Grid;
use asperity::operator::FreeFft;
use asperity::solver::{Bounds, Control, Method, Params, solve_normal};
use asperity::surface::{Amplitude, SelfAffine};

fn main() -> Result<(), Box<dyn Error>> {
    let mut sides: Vec<usize> =
        std::env::args().skip(1).map(|side| side.parse()).collect::<Result<_, _>>()?;
    if sides.is_empty() {
        sides = (7..=12).map(|power| 1 << power).collect();
    }
    println!(
        "| side | contact | convolutions | seconds (median of 3) | µs per cell | peak memory, bytes per cell |"
    );
    println!("|---|---|---|---|---|---|");
    let mut points = Vec::new();
    for side in sides {
        let seconds = measure(side)?;
        let cells = (side * side) as f64;
        points.push(((cells * cells.ln()).ln(), seconds.ln()));
    }
    println!("\nt ∝ (N² log N)^{:.2}", slope(&points));
    Ok(())
}

/// Prints one row of the table; returns the seconds of a solve.
fn measure(side: usize) -> Result<f64, Box<dyn Error>> {
    let grid = Grid::new([side, side], [1.0, 1.0])?;
    let form = SelfAffine {
        hurst: 0.8,
        rolloff: Some(side as f64 / 4.0),
        shortest: Some(8.0),
        amplitude: Amplitude::Sdq(0.1),
    };
    let gap = form.generate(&grid, 1)?.underside().into_heights();
    let mut operator = FreeFft::new(grid, 1.0);
    // A = 2 W/(E* h'rms).
    let load = Control::Load(0.0025 * grid.area());
    let params = Params::default().with_method(Method::ActiveSet);
    let mut seconds = [0.0; 3];
    let mut last = None;
    for seconds in &mut seconds {
        drop(last.take());
        let start = Instant::now();
        last = Some(solve_normal(&mut operator, &gap, &Bounds::ELASTIC, load, None, &params)?);
        *seconds = start.elapsed().as_secs_f64();
    }
    seconds.sort_by(f64::total_cmp);
    let solution = last.ok_or("no solve")?;
    let cells = grid.cells() as f64;
    println!(
        "| {side} | {:.1} % | {:.1} | {:.3} | {:.3} | {:.0} |",
        100.0 * solution.contact_cells() as f64 / cells,
        solution.stats.convolutions,
        seconds[1],
        1e6 * seconds[1] / cells,
        peak_memory().unwrap_or(f64::NAN) / cells,
    );
    Ok(seconds[1])
}

/// Returns the peak memory of this process so far, bytes.
fn peak_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024.0 * kilobytes)
}

/// Returns the slope of the least-squares line through `points`.
fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), point| (x + point.0 / n, y + point.1 / n));
    let (xy, xx) = points.iter().fold((0.0, 0.0), |(xy, xx), point| {
        (xy + (point.0 - x) * (point.1 - y), xx + (point.0 - x) * (point.0 - x))
    });
    xy / xx
}
