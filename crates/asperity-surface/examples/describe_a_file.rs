//! What a topography file holds: its format, channels, size and roughness.
//!
//! `cargo run --release -p asperity-surface --example describe_a_file [FILE]`
//!
//! # Result
//!
//! Without a file it describes a measured disc:
//!
//! ```text
//! format    x3p
//! channel   height of height
//! heights   128 × 128 at 1 µm × 1 µm, 115 missing
//! Sa        31.66 nm   Arithmetical mean height, ⟨|z|⟩
//! Sq        39.56 nm   Root mean square height, √⟨z²⟩
//! Ssk       -0.158     Skewness, ⟨z³⟩/Sq³; 0 for Gaussian heights
//! Sku       2.901      Kurtosis, ⟨z⁴⟩/Sq⁴; 3 for Gaussian heights
//! Sz        246.8 nm   Maximum height, Sp + Sv
//! Sal       5.083 µm   Autocorrelation length, of the fastest decay to 0.2
//! Sdq       0.01259    Root mean square gradient, √⟨(∂z/∂x)² + (∂z/∂y)²⟩
//! Sdr       0.007919 % Developed interfacial area ratio, ⟨√(1 + (∂z/∂x)² + (∂z/∂y)²) − 1⟩
//! ```
#![expect(clippy::print_stdout, reason = "an example prints its result")]

use asperity_surface::units::{Dimension, format};
use asperity_surface::{Level, Parameters, ReadOptions, Result, Topography};

fn main() -> Result<()> {
    let disc = concat!(env!("CARGO_MANIFEST_DIR"), "/../asperity-cli/examples/measured/disc.x3p");
    let path = std::env::args().nth(1).unwrap_or_else(|| disc.to_owned());

    let scan = ReadOptions::default().scan(&path)?;
    println!("format    {}", scan.format);
    println!("channel   {} of {}", scan.channel, scan.channels.join(", "));
    let surface = Topography::read(&path)?;
    let [nx, ny] = surface.grid().shape;
    let [x, y] = surface.grid().pitch.map(|pitch| format(pitch, Dimension::Length));
    println!("heights   {nx} × {ny} at {x} × {y}, {} missing", surface.undefined());

    for row in Parameters::new(&surface.level(Level::Plane)?).rows() {
        if ["Sa", "Sq", "Sz", "Ssk", "Sku", "Sal", "Sdq", "Sdr"].contains(&row.symbol) {
            println!("{:<9} {:<10} {}", row.symbol, row.unit.format(row.value), row.meaning);
        }
    }
    Ok(())
}
