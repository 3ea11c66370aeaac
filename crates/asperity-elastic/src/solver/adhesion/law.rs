//! The attraction between two surfaces across their gap, and the numbers that describe how strong it is.

use std::f64::consts::PI;

use crate::error::{Result, check_in};
use crate::units::{Dimension, JoulePerSquareMetre, Metre, Pascal, PerMetre};
use asperity_base::choice::choice;

/// Form of the attraction as a function of the gap.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Potential {
    /// v = −w e^(−g/ϱ): smooth, and the default.
    #[default]
    Exponential,
    /// v = −w (1 − g/ϱ) up to the range ϱ, and 0 beyond: a constant tension, for comparison with closed
    /// forms.
    Dugdale,
}

choice!(Potential: "exponential" => Exponential, "dugdale" => Dugdale);

/// Where bodies that attract each other come from at each position of a pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum History {
    /// From afar: positions are independent.
    #[default]
    None,
    /// From the position before, with its displacement: the bodies keep what adheres, and jumps lose energy.
    /// Each pass begins from afar.
    Path,
}

choice!(History: "none" => None, "path" => Path);

/// Attraction between two surfaces: the potential energy v(g) of an area at the gap g ≥ 0, with v(0) = −w.
///
/// The tension σ = dv/dg ≥ 0 pulls the surfaces together. It is largest in contact, σ(0) = w/ϱ. Both
/// potentials are concave, so several equilibria may exist under one load. Maugis, J. Colloid Interface Sci.
/// 150, 243 (1992).
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Adhesion {
    /// Work of adhesion w, > 0: the energy that separates an area of flat surfaces.
    pub work: JoulePerSquareMetre,
    /// Range ϱ of the attraction, > 0.
    pub range: Metre,
    /// Form of the attraction.
    pub potential: Potential,
    /// Where the bodies come from at each position of a pass.
    pub history: History,
}

impl Adhesion {
    /// Creates an exponential attraction.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) for a work or a range that is not above 0 and finite.
    pub fn new(work: JoulePerSquareMetre, range: Metre) -> Result<Self> {
        let good = |value: f64| value > 0.0 && value.is_finite();
        let expected = "a finite energy of an area above 0";
        check_in(Dimension::SurfaceEnergy, "work of adhesion", work, good(work), expected)?;
        check_in(Dimension::Length, "range of adhesion", range, good(range), "a finite length above 0")?;
        Ok(Self { work, range, potential: Potential::Exponential, history: History::None })
    }

    /// Sets the form of the attraction.
    #[must_use]
    pub const fn with_potential(self, potential: Potential) -> Self {
        Self { potential, ..self }
    }

    /// Sets where the bodies come from at each position of a pass.
    #[must_use]
    pub const fn with_history(self, history: History) -> Self {
        Self { history, ..self }
    }

    /// Returns the shortest range that a grid resolves, ϱ = √(1.5 π w Δ/E*): the process zone then has 1.5
    /// cells of the `pitch`, the larger one of the grid.
    pub fn grid_range(work: JoulePerSquareMetre, modulus: Pascal, pitch: Metre) -> Metre {
        (RESOLVED_CELLS * PI * work * pitch / modulus).sqrt()
    }

    /// Energy v(g) ≤ 0 of an area at a gap. Interference, a gap below 0, counts as contact.
    #[inline]
    pub fn energy(&self, gap: Metre) -> JoulePerSquareMetre {
        let g = gap.max(0.0) / self.range;
        match self.potential {
            Potential::Exponential => -self.work * libm::exp(-g),
            Potential::Dugdale => -self.work * (1.0 - g).max(0.0),
        }
    }

    /// Tension σ(g) ≥ 0 at a gap.
    #[inline]
    pub fn tension(&self, gap: Metre) -> Pascal {
        let g = gap.max(0.0) / self.range;
        match self.potential {
            Potential::Exponential => self.max_tension() * libm::exp(-g),
            Potential::Dugdale if g < 1.0 => self.max_tension(),
            Potential::Dugdale => 0.0,
        }
    }

    /// Decrease of the tension with the gap, −dσ/dg ≥ 0; 0 for [`Potential::Dugdale`], whose tension jumps.
    #[inline]
    pub fn softening(&self, gap: Metre) -> f64 {
        match self.potential {
            Potential::Exponential => self.tension(gap) / self.range,
            Potential::Dugdale => 0.0,
        }
    }

    /// Largest tension σ(0) = w/ϱ, in contact.
    pub fn max_tension(&self) -> Pascal {
        self.work / self.range
    }

    /// Length ℓ of the process zone, in which the tension falls at the edge of a contact: E*ϱ²/πw, and
    /// πE*ϱ²/4w for [`Potential::Dugdale`].
    pub fn process_zone(&self, modulus: Pascal) -> Metre {
        let length = modulus * self.range * self.range / self.work;
        match self.potential {
            Potential::Exponential => length / PI,
            Potential::Dugdale => length * PI / 4.0,
        }
    }

    /// Tabor's parameter (w²/E*²ϱ³κ)^⅓ of summits with the curvature κ: below 0.1 the attraction is long, as
    /// in the theory of Derjaguin, Muller and Toporov; above 5 it is short, as in that of Johnson, Kendall
    /// and Roberts.
    pub fn tabor(&self, modulus: Pascal, curvature: PerMetre) -> f64 {
        let ratio = self.work / modulus;
        (ratio * ratio / (self.range.powi(3) * curvature)).cbrt()
    }

    /// Parameter of Pastewka and Robbins for a surface of rms slope h′ and rms curvature h″:
    /// (E*h′ϱ/2w)(h′²/h″ϱ)^⅔. The surface sticks, and has contact without load, below 1. Proc. Natl. Acad.
    /// Sci. 111, 3298 (2014).
    pub fn pastewka_robbins(&self, modulus: Pascal, slope: f64, curvature: PerMetre) -> f64 {
        let length = slope * slope / (curvature * self.range);
        0.5 * modulus * slope * self.range / self.work * length.powf(2.0 / 3.0)
    }
}

/// Length of the process zone in cells from which on the lattice causes no hysteresis, and moves the pull-off
/// force by 1 % at most.
pub const RESOLVED_CELLS: f64 = 1.5;

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn the_tension_is_the_slope_of_the_energy_and_does_the_work_of_adhesion() {
        for potential in [Potential::Exponential, Potential::Dugdale] {
            let adhesion = Adhesion::new(0.05, 2e-9).unwrap().with_potential(potential);
            assert_eq!(adhesion.energy(0.0), -0.05);
            assert_eq!(adhesion.tension(-1e-9), adhesion.max_tension());
            let step = 1e-12;
            for gap in [3e-10, 1.1e-9, 1.9e-9, 3e-9] {
                let slope = (adhesion.energy(gap + step) - adhesion.energy(gap - step)) / (2.0 * step);
                assert_relative_eq!(slope, adhesion.tension(gap), max_relative = 1e-6, epsilon = 1.0);
                let softening = (adhesion.tension(gap - step) - adhesion.tension(gap + step)) / (2.0 * step);
                assert_relative_eq!(softening, adhesion.softening(gap), max_relative = 1e-6);
            }
            let cells = 200_000;
            let width = 1e-7 / f64::from(cells);
            let work: f64 = (0..cells).map(|n| width * adhesion.tension((f64::from(n) + 0.5) * width)).sum();
            assert_relative_eq!(work, 0.05, max_relative = 1e-5);
        }
    }

    #[test]
    fn the_range_of_a_grid_has_a_process_zone_of_one_and_a_half_cells() {
        let range = Adhesion::grid_range(0.05, 25e6, 1e-8);
        let zone = Adhesion::new(0.05, range).unwrap().process_zone(25e6);
        assert_relative_eq!(zone, 1.5e-8, max_relative = 1e-14);
    }

    #[test]
    fn nonsense_is_refused() {
        for (work, range) in [(0.0, 1e-9), (-1.0, 1e-9), (f64::NAN, 1e-9), (0.05, 0.0), (0.05, f64::INFINITY)]
        {
            assert!(Adhesion::new(work, range).is_err(), "{work} {range}");
        }
    }
}
