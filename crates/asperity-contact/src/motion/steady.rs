//! Steady sliding of a pair of bodies, one or both viscoelastic.

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::motion::pair::{Pair, Viscoelastic};
use crate::motion::record::SteadyRecord;
use crate::motion::state::LoadedContact;
use crate::operator::Boundary;
use crate::solver::{Control, Equilibrium, Params, Watch};
use crate::units::{Metre, MetrePerSecond};
use crate::viscoelastic::{Creep, SlidingBodies, SteadySliding, ViscoelasticStack, solve_steady};

/// Largest difference of heights along x of a body that counts as smooth, relative to the range of its
/// heights, or to the pitch.
const SMOOTH: f64 = 1e-9;

/// Drag over load that is the rounding of 0.
const NOTHING: f64 = 1e-13;

/// One of the two bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MovingBody {
    /// The contact stays on the upper body, and moves along +x over the lower one.
    Lower,
    /// The contact stays on the lower body, and moves along −x over the upper one.
    Upper,
}

impl MovingBody {
    /// Returns the body of these heights, lower one first, through which a steady contact moves: one whose
    /// heights do not change along x. If neither changes, it is the one that `creeps`, or the lower one. The
    /// other body stands still in the contact, and has its relaxed modulus.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the heights of both bodies change along x.
    pub fn from_heights(heights: [&Field; 2], pitch: [Metre; 2], creeps: [bool; 2]) -> Result<Self> {
        match heights.map(|heights| is_smooth_along_x(heights, pitch)) {
            [true, true] if creeps == [false, true] => Ok(Self::Upper),
            [true, _] => Ok(Self::Lower),
            [false, true] => Ok(Self::Upper),
            [false, false] => Err(Error::Unsupported(
                "steady sliding needs a body that is smooth along x: its material passes through the contact, whose gap is constant",
            )),
        }
    }
}

impl Pair {
    /// Returns the body through which a steady contact moves, see [`MovingBody::from_heights`].
    ///
    /// # Errors
    /// The errors of [`MovingBody::from_heights`].
    pub fn moving_body(&self) -> Result<MovingBody> {
        let creeps = match self.viscoelastic() {
            None => [false; 2],
            Some(Viscoelastic::HalfSpaces(creeps)) => creeps.each_ref().map(|creep| !creep.terms.is_empty()),
            Some(Viscoelastic::Layered(stacks)) => stacks.each_ref().map(ViscoelasticStack::relaxes),
        };
        MovingBody::from_heights([&self.lower.heights, &self.upper.heights], self.pitch(), creeps)
    }

    /// Returns the operator of the pair that slides steadily at a `speed`, as the contact sees it.
    ///
    /// # Errors
    /// [`Error::Unsupported`] without viscoelastic bodies, and the errors of [`Pair::moving_body`] and of
    /// [`SteadySliding::new`].
    pub fn sliding_steadily(&self, boundary: Boundary, speed: MetrePerSecond) -> Result<SteadySliding> {
        self.check_creep()?;
        let bodies = self
            .viscoelastic()
            .ok_or(Error::Unsupported("steady sliding is computed for viscoelastic bodies"))?;
        let (moving, standing, speed) = match self.moving_body()? {
            MovingBody::Lower => (0, 1, speed),
            MovingBody::Upper => (1, 0, -speed),
        };
        let bodies = match bodies {
            Viscoelastic::HalfSpaces(creeps) => {
                let standing = Creep::elastic(creeps[standing].relaxed());
                SlidingBodies::HalfSpaces(creeps[moving].plus(&standing))
            }
            Viscoelastic::Layered(stacks) => {
                SlidingBodies::Layered { moving: stacks[moving].clone(), standing: stacks[standing].clone() }
            }
        };
        SteadySliding::new(self.lower_grid(), boundary, bodies, speed)
    }
}

fn is_smooth_along_x(heights: &Field, pitch: [Metre; 2]) -> bool {
    let first = heights.row(0);
    let range = heights.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], z| [a.min(*z), b.max(*z)]);
    let allowed = SMOOTH * (range[1] - range[0]).max(SMOOTH * pitch[0]);
    heights.rows().into_iter().all(|row| row.iter().zip(first).all(|(z, first)| (z - first).abs() <= allowed))
}

impl LoadedContact {
    /// Solves the steady contact of a `pair` over the initial `gap`, near the pressure `start`, if one is
    /// known.
    #[expect(clippy::too_many_arguments, reason = "the contact, what is asked of it, and who looks on")]
    pub(super) fn steady(
        pair: &Pair,
        boundary: Boundary,
        gap: &Field,
        control: Control,
        speed: MetrePerSecond,
        start: Option<&Field>,
        params: &Params,
        watch: &dyn Watch,
    ) -> Result<(Self, SteadyRecord)> {
        let mut operator = pair.sliding_steadily(boundary, speed)?;
        let found = solve_steady(&mut operator, gap, control, start, params, watch)?;
        let contact = Self::at_once(pair, Equilibrium::Frictionless(Box::new(found.solution)));
        let load = contact.record.load;
        // Rounding leaves some of a drag that is 0.
        let drag = if found.drag.abs() > NOTHING * load { found.drag } else { 0.0 };
        // Bodies that do not touch have no drag.
        let drag_coefficient = if load > 0.0 { drag / load } else { 0.0 };
        let steady = SteadyRecord { drag, drag_coefficient, drag_power: drag * speed };
        Ok((contact, steady))
    }
}
