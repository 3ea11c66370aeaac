//! The oil between two bodies.

use super::film::FilmProblem;
use super::forces::Shear;
use super::oil::Oil;
use crate::grid::Field;
use crate::solver::Control;
use crate::units::{Metre, MetrePerSecond, Pascal};

/// The oil between the bodies of a pair, and how they move through it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lubrication {
    /// The oil, at its temperature.
    pub oil: Oil,
    /// Its shear stress.
    pub shear: Shear,
    /// Difference of the speeds of both surfaces, ≥ 0; `None`: one body is at rest, and the other one has twice the
    /// mean speed.
    pub sliding: Option<MetrePerSecond>,
    /// Film that solids that touch keep between them, > 0.
    pub boundary_film: Metre,
    /// Pressures of the oil at the inlet and at the outlet, above ambient, ≥ 0.
    pub ends: [Pascal; 2],
    /// Friction coefficient of the solids where they touch.
    pub solid_friction: f64,
}

impl Lubrication {
    /// Returns the difference of the speeds of both surfaces at a mean speed.
    pub fn sliding_at(&self, speed: MetrePerSecond) -> MetrePerSecond {
        self.sliding.unwrap_or(2.0 * speed)
    }

    /// Returns the friction coefficient of solids that slide at this speed; 0 if they roll.
    pub fn solid_friction_at(&self, sliding: MetrePerSecond) -> f64 {
        if sliding > 0.0 { self.solid_friction } else { 0.0 }
    }

    pub(crate) fn problem<'a>(&self, gap: &'a Field, control: Control) -> FilmProblem<'a> {
        let Self { oil, boundary_film, ends, .. } = *self;
        FilmProblem { gap, oil, speed: 0.0, boundary_film, control, ends, step: None }
    }
}
