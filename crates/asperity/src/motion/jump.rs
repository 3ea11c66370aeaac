//! How many passes a computed one stands for.

use std::f64::consts::PI;

use crate::error::{Result, check, check_in};
use crate::grid::Field;
use crate::motion::contact::Contact;
use crate::motion::law::{Law, Sums};
use crate::motion::pair::Pair;
use crate::operator::Boundary;
use crate::units::{Dimension, MAX_COUNT, Metre};

/// How far passes that are not computed may be taken for granted.
///
/// A computed pass stands for J passes. What its laws sum over a pass is taken to change by as much per pass as it did since the
/// computed one before: with that mean over the jump, S + ½ J dS, wear is of second order in J (Adams and Bashforth) and a film
/// grows as it would under frozen contact. How far the heights are from those of S alone is the estimate of the error.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Acceleration {
    /// Largest error estimate of a jump, over the depth to which the largest pressure of the pass presses a single cell, > 0.
    pub tolerance: f64,
    /// The most passes that one stands for, ≥ 1.
    pub max_jump: usize,
    /// The deepest wear in a jump, > 0.
    pub max_wear: Metre,
}

impl Default for Acceleration {
    fn default() -> Self {
        Self { tolerance: 0.01, max_jump: 10_000, max_wear: 5e-9 }
    }
}

impl Acceleration {
    /// Every pass is computed.
    pub const NONE: Self = Self { tolerance: 0.01, max_jump: 1, max_wear: f64::INFINITY };

    /// The same with a tolerance.
    #[must_use]
    pub const fn with_tolerance(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    /// The same with another longest jump.
    #[must_use]
    pub const fn with_max_jump(self, max_jump: usize) -> Self {
        Self { max_jump, ..self }
    }

    /// The same with another deepest wear in a jump.
    #[must_use]
    pub const fn with_max_wear(self, max_wear: Metre) -> Self {
        Self { max_wear, ..self }
    }

    pub(super) fn checked(self) -> Result<Self> {
        check("tolerance", self.tolerance, self.tolerance > 0.0, "a number above 0")?;
        check("max_jump", self.max_jump as f64, self.max_jump > 0, "at least one pass")?;
        check_in(Dimension::Length, "max_wear", self.max_wear, self.max_wear > 0.0, "a depth above 0")?;
        Ok(self)
    }
}

/// The last jump: what the choice of the next one needs.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Jump {
    /// Passes that the computed one stood for, ≥ 1.
    pub passes: usize,
    /// What each law that repeats has summed over the computed pass.
    pub sums: Vec<Sums>,
}

/// Bounds of a jump that are known before its error is.
pub(super) struct Bounds {
    /// Passes that are left.
    pub(super) left: usize,
    /// Volumes of plastic flow, and of the wear of a pass.
    pub(super) volumes: [f64; 2],
    /// Deepest wear of a pass.
    pub(super) deepest: Metre,
    /// Passes of wear at which a chequered pattern of pressures would not decay.
    pub(super) stable: f64,
}

/// How many passes a computed one stands for.
pub(super) struct Leap {
    /// The passes, ≥ 1.
    pub(super) passes: usize,
    /// What laws sum over a pass in the mean of these passes; none of one pass, whose sums are its own.
    pub(super) mean: Option<Vec<Sums>>,
    /// Estimate of the error of the heights.
    pub(super) error: Metre,
}

impl Leap {
    /// The pass stands for itself.
    pub(super) const ONE: Self = Self { passes: 1, mean: None, error: 0.0 };
}

/// How far the surfaces give way to a pressure of 1 at the shortest waves that cells have, m/Pa.
#[derive(Clone, Copy)]
pub(super) struct Softness {
    /// To the pressure on a single cell.
    pub(super) single: f64,
    /// To a chequered pressure, the least of all.
    pub(super) chequered: f64,
}

impl Softness {
    /// That of a pair with a boundary.
    pub(super) fn of(pair: &Pair, boundary: Boundary) -> Self {
        /// Cells over which the alternating sum is taken; it is faded out towards them.
        const REACH: i32 = 32;
        let pitch = pair.pitch();
        let response = pair.response();
        let influence = response.influence(pitch);
        let fade = |k: i32| (0.5 * PI * f64::from(k) / f64::from(REACH)).cos().powi(2);
        let mut chequered = 0.0;
        for i in -REACH..=REACH {
            for j in -REACH..=REACH {
                let sign = if (i + j) % 2 == 0 { 1.0 } else { -1.0 };
                chequered +=
                    sign * fade(i) * fade(j) * influence.at(f64::from(i) * pitch[0], f64::from(j) * pitch[1]);
            }
        }
        if boundary.repeats(0) || boundary.repeats(1) {
            let shortest = pitch.map(|pitch| PI / pitch);
            chequered = chequered.min(response.harmonic_displacement(shortest[0], shortest[1]));
        }
        Self { single: influence.at(0.0, 0.0), chequered }
    }
}

/// Depth that `laws` take in a pass off the cell which is in contact longest, under a pressure of 1, of both bodies, m/Pa.
pub(super) fn relaxation(
    pair: &Pair,
    contacts: &[Contact],
    laws: &[Box<dyn Law>],
    friction: f64,
    distance: Metre,
) -> f64 {
    let mut count = [&pair.lower, &pair.upper].map(|body| vec![0.0; body.heights.len()]);
    for contact in contacts {
        for (count, seat) in count.iter_mut().zip(pair.seats(&contact.position)) {
            for &(cell, _) in &contact.pressure {
                seat.parts(seat.cell(cell as usize)).for_each(|(cell, weight)| count[cell] += weight);
            }
        }
    }
    let longest = count.map(|count| count.into_iter().fold(0.0, f64::max) * distance);
    let wear = |law: &dyn Law| {
        let per_pressure = law.per_pressure(friction);
        per_pressure[0] * longest[0] + per_pressure[1] * longest[1]
    };
    laws.iter().map(|law| wear(law.as_ref())).sum()
}

impl Acceleration {
    /// The most passes that the computed one may stand for, as far as the error allows it.
    pub(super) fn most(&self, bounds: &Bounds, before: &Jump) -> usize {
        let [plastic, worn] = bounds.volumes;
        let most = if plastic > worn * before.passes as f64 {
            // What flows is not repeated: the surfaces shake down first.
            before.passes / 2
        } else {
            let within = (self.max_wear / bounds.deepest).min(bounds.stable);
            (within.min(MAX_COUNT as f64) as usize).min(2 * before.passes)
        };
        most.min(self.max_jump).min(bounds.left).max(1)
    }
}

/// The mean over `passes` of sums that change by as much per pass as they did since `before`.
pub(super) fn extrapolated(now: &[Sums], before: &Jump, passes: usize) -> Vec<Sums> {
    let factor = 0.5 * passes as f64 / before.passes as f64;
    let mean = |(now, then): (&Field, &Field)| {
        ndarray::Zip::from(now).and(then).map_collect(|now, then| (now + factor * (now - then)).max(0.0))
    };
    let of_body = |now: &Vec<Field>, then: &Vec<Field>| now.iter().zip(then).map(mean).collect();
    now.iter()
        .zip(&before.sums)
        .map(|(now, then)| [0, 1].map(|body| of_body(&now[body], &then[body])))
        .collect()
}
