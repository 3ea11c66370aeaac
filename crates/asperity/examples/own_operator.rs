//! A user-defined operator: a half-space under a thin soft coating.
//!
//! # Problem
//!
//! A steel ball is pressed on a plate with a coating that is thin compared with the contact. Such a coating
//! deforms only where it is pressed, like a bed of springs.
//!
//! # Mathematics
//!
//! ```text
//! u = C p + k p,   k = t (1 + ν)(1 − 2ν)/(E (1 − ν))
//! ```
//!
//! with the operator C of the half-space, and the thickness t, Young's modulus E and Poisson's ratio ν of the
//! coating. For k = 0 it is Hertz' contact. If the coating is much more compliant than the half-space, it is
//! an elastic foundation: p = (δ − r²/2R)/k, thus p₀ = √(W/πRk). The actual pressure is below both.
//!
//! # Program
//!
//! A solver requires of an operator its displacements, its coefficients, those of harmonics, and the same
//! operator on a coarser grid. All methods, the cap on the pressure and prescribed loads then work as for a
//! half-space.
//!
//! `cargo run --release -p asperity --example own_operator`
//!
//! # Result
//!
//! ```text
//!  coating (nm)   p max (MPa)   Hertz   foundation   convolutions
//!             0         590.7   590.7          inf            9.3
//!            10         586.3   590.7       5223.4            9.0
//!           100         550.8   590.7       1651.8            8.1
//!          1000         374.8   590.7        522.3            9.0
//!         10000         154.4   590.7        165.2           20.6
//! ```
#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::f64::consts::PI;

use asperity::operator::{Boundary, FreeFft, Operator};
use asperity::reference::HertzSphere;
use asperity::solver::{Bounds, Control, Params, solve_normal};
use asperity::surface::Form;
use asperity::{Field, Grid};

/// A half-space under a thin coating.
struct Coated {
    half_space: Box<dyn Operator>,
    /// Displacement of the coating per unit pressure, m/Pa.
    compliance: f64,
}

impl Operator for Coated {
    fn grid(&self) -> &Grid {
        self.half_space.grid()
    }

    fn boundary(&self) -> Boundary {
        self.half_space.boundary()
    }

    fn harmonic_displacement(&self, qx: f64, qy: f64) -> f64 {
        self.half_space.harmonic_displacement(qx, qy) + self.compliance
    }

    fn influence(&self, i: usize, j: usize) -> f64 {
        let own = if (i, j) == (0, 0) { self.compliance } else { 0.0 };
        self.half_space.influence(i, j) + own
    }

    fn apply(&mut self, pressure: &Field, displacement: &mut Field) {
        self.half_space.apply(pressure, displacement);
        displacement.scaled_add(self.compliance, pressure);
    }

    fn coarse(&self) -> Box<dyn Operator> {
        Box::new(Self { half_space: self.half_space.coarse(), compliance: self.compliance })
    }
}

fn main() -> asperity::Result<()> {
    let grid = Grid::new([256, 256], [1e-6; 2])?;
    let (radius, load, modulus) = (5e-3, 2.0, 115.4e9);
    let gap = -Form::Sphere { radius }.on(&grid)?.heights();
    let hertz = HertzSphere { radius, modulus, load };
    let (young, poisson) = (1e9, 0.4);

    println!(" coating (nm)   p max (MPa)   Hertz   foundation   convolutions");
    for thickness in [0.0, 10e-9, 100e-9, 1e-6, 10e-6] {
        let compliance = thickness * (1.0 + poisson) * (1.0 - 2.0 * poisson) / (young * (1.0 - poisson));
        let half_space = Box::new(FreeFft::new(grid, modulus));
        let mut coated = Coated { half_space, compliance };
        let params = Params::default();
        let solution = solve_normal(&mut coated, &gap, &Bounds::ELASTIC, Control::Load(load), None, &params)?;
        let largest = solution.pressure.iter().copied().fold(0.0, f64::max);
        let foundation = (load / (PI * radius * compliance)).sqrt();
        println!(
            "{:13.0} {:13.1} {:7.1} {:12.1} {:14.1}",
            thickness * 1e9,
            largest * 1e-6,
            hertz.peak_pressure() * 1e-6,
            foundation * 1e-6,
            solution.stats.convolutions
        );
    }
    Ok(())
}
