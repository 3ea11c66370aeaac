//! Time and memory of the operators of an elasto-plastic body: the residual stress of plastic strain in all
//! cells, and a product of an increment under a fixed pressure, with the displacement of the surface and the
//! flow of the cells.
//!
//! ```text
//! plastic_product [periodic|free|both] [SIDExLAYERS …]        both 64x16 256x32, unless said otherwise
//! ```
//!
//! Prints a table. Times are means of the processor time of this thread (Linux; elsewhere of the time). They
//! are those of the work if `RAYON_NUM_THREADS` is 1. The first memory is that of the process at its peak
//! (Linux) with the operator, a strain and its stress; the second one has the body. A row counts the memory
//! of the rows before it, if that was larger.
#![expect(clippy::print_stdout, reason = "the table is what it is for")]

use std::error::Error;
use std::sync::OnceLock;
use std::time::Instant;

use asperity::material::Material;
use asperity::operator::Boundary;
use asperity::plasticity::{
    Action, Hardening, J2, Layers, Loading, PlasticBody, PlasticParams, SurfaceDisplacement, TensorField,
    Volume, advance,
};
use asperity::subsurface::Tractions;
use asperity::{Field, Grid};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let boundaries = match arguments.next().as_deref() {
        Some("periodic") => vec![Boundary::PERIODIC],
        Some("free") => vec![Boundary::FREE],
        Some("both") | None => vec![Boundary::PERIODIC, Boundary::FREE],
        _ => return Err(USAGE.into()),
    };
    let mut sizes: Vec<String> = arguments.collect();
    if sizes.is_empty() {
        sizes = ["64x16", "256x32"].map(String::from).to_vec();
    }
    println!(
        "| cells × layers | boundary | residual stress, ms | peak, MB | product of an increment, ms | peak, MB |"
    );
    println!("|---|---|---|---|---|---|");
    for size in sizes {
        let (side, layers) = size.split_once('x').ok_or(USAGE)?;
        for boundary in &boundaries {
            measure(side.parse()?, layers.parse()?, *boundary)?;
        }
    }
    Ok(())
}

const USAGE: &str = "plastic_product [periodic|free|both] [SIDExLAYERS …]";

/// Prints one row of the table.
fn measure(side: usize, layers: usize, boundary: Boundary) -> Result<(), Box<dyn Error>> {
    let grid = Grid::new([side, side], [1.0; 2])?;
    let depth = 0.4 * side as f64;
    let material = Material::elastic(1000.0, 0.3)?;
    let volume = || Volume::new(grid, Layers::new(depth, layers, 1.03)?, boundary, &material);
    let repeat = 2 + 6_000_000 / (side * side * layers);

    let mut operator = volume()?;
    let strain = TensorField::from_shape_fn(operator.zeros().raw_dim(), |(layer, component, i, j)| {
        let cell = layer + 3 * i + 7 * j;
        [(cell % 11) as f64, -((cell % 5) as f64), ((cell % 5) as f64) - (cell % 11) as f64, 2.0, 1.0, 0.5]
            [component]
    });
    operator.residual(&strain);
    // The clock of a thread may advance in steps of 4 ms.
    let start = now();
    for _ in 0..repeat {
        let stress = operator.residual(&strain);
        assert!(stress[[0, 0, 0, 0]].is_finite());
    }
    let residual = 1e3 * (now() - start) / repeat as f64;
    let first_peak = peak_memory().unwrap_or(f64::NAN);
    drop(strain);
    drop(operator);

    let law = J2::new(Hardening::linear(1.0, 20.0)?);
    let mut body = PlasticBody::new(volume()?, law);
    let mut pressure = Hertz { radius: 0.25 * side as f64, peak: 2.5, grid };
    let (mut seconds, mut products) = (0.0, 0);
    for peak in [2.5, 2.8, 3.0] {
        pressure.peak = peak;
        let start = now();
        let increment = advance(&mut [&mut body], &mut pressure, None, &PlasticParams::new())?;
        // The first one also makes the operators of the tractions.
        if peak > 2.5 {
            seconds += now() - start;
            products += increment.products;
        }
    }
    println!(
        "| {side}² × {layers} | {} | {residual:.1} | {first_peak:.0} | {:.1} | {:.0} |",
        if boundary == Boundary::FREE { "free" } else { "periodic" },
        1e3 * seconds / products as f64,
        peak_memory().unwrap_or(f64::NAN),
    );
    Ok(())
}

/// A pressure that does not depend on the displacement of the surface.
struct Hertz {
    radius: f64,
    peak: f64,
    grid: Grid,
}

impl Loading for Hertz {
    fn act(&mut self, _: &[SurfaceDisplacement]) -> asperity::Result<Vec<Action>> {
        let middle = 0.5 * self.grid.shape[0] as f64;
        let pressure = Field::from_shape_fn(self.grid.shape, |(i, j)| {
            let [x, y] = [i, j].map(|i| (i as f64 + 0.5 - middle) / self.radius);
            self.peak * (1.0 - x * x - y * y).max(0.0).sqrt()
        });
        Ok(vec![Action::Tractions(Tractions::frictionless(pressure))])
    }
}

/// Returns the processor time of this thread so far, or the time since the first call, s.
fn now() -> f64 {
    static START: OnceLock<Instant> = OnceLock::new();
    let start = START.get_or_init(Instant::now);
    let nanoseconds = std::fs::read_to_string("/proc/thread-self/schedstat")
        .ok()
        .and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| start.elapsed().as_secs_f64(), |nanoseconds| 1e-9 * nanoseconds)
}

/// Returns the peak memory of this process so far, MB.
fn peak_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes / 1e3)
}
