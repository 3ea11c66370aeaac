//! Times one free convolution, from dense pressure to dense displacement, for each line of input.
//!
//! ```text
//! free_convolution 512 [5]
//! ```
//!
//! For every line of standard input it prints the median time of a number of convolutions (here 5) in
//! seconds, so that another program can alternate with it. `benches/peers/convolution.py` does so with FFTW.
#![expect(clippy::print_stdout, reason = "the seconds are what it is for")]

use std::error::Error;
use std::io;
use std::time::Instant;

use asperity::operator::{FreeFft, Operator};
use asperity::{Field, Grid};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let side: usize = arguments.next().ok_or("free_convolution side [repeat]")?.parse()?;
    let repeat: usize = arguments.next().map_or(Ok(5), |text| text.parse())?;
    let grid = Grid::new([side, side], [1.0, 1.0])?;
    let mut operator = FreeFft::new(grid, 1.0);
    let pressure = Field::from_shape_fn([side, side], |(i, j)| 1.0 + (i * j % 7) as f64);
    let mut displacement = grid.zeros();
    for line in io::stdin().lines() {
        line?;
        let mut seconds: Vec<f64> = (0..repeat)
            .map(|_| {
                let start = Instant::now();
                operator.apply(&pressure, &mut displacement);
                start.elapsed().as_secs_f64()
            })
            .collect();
        seconds.sort_by(f64::total_cmp);
        println!("{}", seconds[repeat / 2]);
    }
    Ok(())
}
