//! A self-affine surface as an x3p file, and how near its statistics come to those asked for.
//!
//! `cargo run --release -p asperity-surface --example make_a_surface`
//!
//! # Result
//!
//! ```text
//! Sq        200 nm, asked for 200 nm
//! Hurst     0.80, asked for 0.8
//! written   and read again, bit by bit
//! ```
#![expect(clippy::print_stdout, reason = "an example prints its result")]

use asperity_surface::units::{Dimension, format};
use asperity_surface::{
    Amplitude, Bins, Grid, Parameters, Result, SelfAffine, SelfAffinity, Spectrum, Topography, Window,
};

fn main() -> Result<()> {
    let grid = Grid::new([512, 512], [0.5e-6; 2])?;
    let law = SelfAffine {
        hurst: 0.8,
        rolloff: Some(64e-6),
        shortest: Some(4e-6),
        amplitude: Amplitude::Sq(0.2e-6),
    };
    let surface = law.generate(&grid, 1)?;

    let found = Parameters::new(&surface);
    let spectrum = Spectrum::new(&surface, Window::None).radial(Bins::Logarithmic { per_decade: 10 });
    let hurst = SelfAffinity::of_longest_range(&spectrum)?.hurst;
    println!("Sq        {}, asked for 200 nm", format(found.height.sq, Dimension::Length));
    println!("Hurst     {hurst:.2}, asked for 0.8");

    let path = std::env::temp_dir().join("surface.x3p");
    surface.write(&path)?;
    let again = Topography::read(&path)?;
    println!(
        "written   {}",
        if again.heights() == surface.heights() {
            "and read again, bit by bit"
        } else {
            "with other heights"
        }
    );
    Ok(())
}
