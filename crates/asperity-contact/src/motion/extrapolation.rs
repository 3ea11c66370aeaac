//! Extrapolation of a computed pass over several passes.

use std::f64::consts::PI;

use serde::Serialize;

use crate::error::{Result, check, check_in};
use crate::grid::Field;
use crate::motion::contact::Contact;
use crate::motion::law::{self, Law, Sums};
use crate::motion::pair::Pair;
use crate::operator::Boundary;
use crate::units::{Dimension, MAX_COUNT, Metre};
use asperity_base::beside::{Beside, Scale};
use asperity_base::table::Exists;
use asperity_derive::Table;

/// Limits of the extrapolation over passes that are not computed.
///
/// A computed pass is extrapolated over J passes. The sums S of its laws over a pass are assumed to change
/// per pass by dS, as since the computed pass before. Their mean over the extrapolation is S + ½ J dS. The
/// removal is then of second order in J (Adams and Bashforth), and a film grows as under frozen contact. The
/// difference of the heights to those from S alone estimates the error.
#[derive(Table, Debug, Clone, Copy, PartialEq, Serialize)]
#[table("acceleration", default)]
#[non_exhaustive]
pub struct Acceleration {
    /// Largest error estimate of an extrapolation, over the depth to which the largest pressure presses a
    /// single cell.
    #[key(number = "a number", range = AboveZero, default = 0.01, example = "0.01")]
    pub tolerance: f64,
    /// Largest number of passes per extrapolation, the computed pass included; 1 computes all passes.
    #[key(count = 1, default = 10_000, example = "1000")]
    pub max_jump: usize,
    /// Largest wear depth in an extrapolation.
    #[key(
        quantity = Length,
        range = AboveZero,
        default = 5e-9,
        written = "\"5 nm\"",
        example = "\"2 nm\"",
        exists = DEPTH,
        beside = [Beside::most(Scale::Heights, 20.0, "an extrapolation wears the surfaces off")]
    )]
    pub max_wear: Metre,
}

const DEPTH: Exists =
    Exists::Within { least: 5e-11, most: 1e-3, of: "half an atom to grooves", slips: &["nm", "um"] };

impl Acceleration {
    /// Computes every pass.
    pub const NONE: Self = Self { tolerance: 0.01, max_jump: 1, max_wear: f64::INFINITY };

    /// Sets the tolerance.
    #[must_use]
    pub const fn with_tolerance(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    /// Sets the largest number of passes per extrapolation.
    #[must_use]
    pub const fn with_max_jump(self, max_jump: usize) -> Self {
        Self { max_jump, ..self }
    }

    /// Sets the largest wear depth in an extrapolation.
    #[must_use]
    pub const fn with_max_wear(self, max_wear: Metre) -> Self {
        Self { max_wear, ..self }
    }

    /// Largest depth that a cell loses in an extrapolation.
    pub fn max_depth(&self) -> Metre {
        self.max_wear
    }

    pub(super) fn checked(self) -> Result<Self> {
        check("tolerance", self.tolerance, self.tolerance > 0.0, "a number above 0")?;
        check("max_jump", self.max_jump as f64, self.max_jump > 0, "at least one pass")?;
        check_in(Dimension::Length, "max_wear", self.max_wear, self.max_wear > 0.0, "a depth above 0")?;
        Ok(self)
    }
}

/// The last extrapolation, needed to choose the next one.
#[derive(Debug, Clone, PartialEq)]
pub struct LastExtrapolation {
    /// Passes of the extrapolation, ≥ 1.
    pub passes: usize,
    /// Sums over the computed pass of each law that repeats.
    pub sums: Vec<Sums>,
}

/// Removal by custom laws in the last computed pass. They act once a pass and its extrapolation are known, so
/// that their removal bounds the next extrapolation.
#[derive(Debug, Clone, PartialEq)]
pub struct Removed {
    /// Depth that a single pass takes off each cell of the lower and of the upper body.
    pub depth: [Field; 2],
    /// Largest change of this depth from one pass of the motion to the next; 0 after the first removal.
    pub change: Metre,
}

impl Removed {
    /// Creates the removal of a pass, so many `passes` of the motion after the removal `before`.
    pub(super) fn after(depth: [Field; 2], before: Option<&Self>, passes: f64) -> Self {
        let change = before.map_or(0.0, |before| {
            let [now, then] = [&depth, &before.depth].map(std::slice::from_ref);
            law::difference(now, then) / passes
        });
        Self { depth, change }
    }

    /// Estimates the error of the heights if the depth is taken off over so many `passes` as if it did not
    /// change.
    pub(super) fn error(&self, passes: usize) -> Metre {
        if passes > 1 { 0.5 * (passes as f64).powi(2) * self.change } else { 0.0 }
    }

    /// Largest number of passes within an error.
    pub(super) fn within(&self, error: Metre) -> f64 {
        (2.0 * error / self.change).sqrt()
    }

    /// Sum of the depths over the cells that lose height.
    pub(super) fn sum(&self) -> Metre {
        self.depth.iter().flatten().map(|depth| depth.max(0.0)).sum()
    }
}

/// Bounds on an extrapolation that are known before its error.
pub(super) struct Bounds {
    /// Remaining passes.
    pub(super) left: usize,
    /// Volumes of plastic flow and of removal in a pass.
    pub(super) volumes: [f64; 2],
    /// Largest depth removed in a pass.
    pub(super) deepest: Metre,
    /// Number of passes of removal at which a checkerboard mode of the pressures would no longer decay.
    pub(super) stable: f64,
}

/// The extrapolation of a computed pass.
pub(super) struct Extrapolation {
    /// Passes of the extrapolation, ≥ 1.
    pub(super) passes: usize,
    /// Mean over these passes of the sums of the laws; `None` for a single pass, which uses its own sums.
    pub(super) mean: Option<Vec<Sums>>,
    /// Estimate of the error of the heights.
    pub(super) error: Metre,
}

impl Extrapolation {
    /// No extrapolation: a single pass.
    pub(super) const ONE: Self = Self { passes: 1, mean: None, error: 0.0 };
}

/// Compliance of the surfaces at the shortest waves on the grid, m/Pa.
#[derive(Clone, Copy)]
pub(super) struct GridCompliance {
    /// Under a pressure on a single cell.
    pub(super) single: f64,
    /// Under a checkerboard pressure; the smallest of all.
    pub(super) checkerboard: f64,
}

impl GridCompliance {
    /// Computes the compliance of a pair with a boundary.
    pub(super) fn new(pair: &Pair, boundary: Boundary) -> Self {
        /// Reach of the alternating sum in cells; it is tapered towards them.
        const REACH: i32 = 32;
        let pitch = pair.pitch();
        let response = pair.response();
        let influence = response.influence(pitch);
        let fade = |k: i32| (0.5 * PI * f64::from(k) / f64::from(REACH)).cos().powi(2);
        let mut checkerboard = 0.0;
        for i in -REACH..=REACH {
            for j in -REACH..=REACH {
                let sign = if (i + j) % 2 == 0 { 1.0 } else { -1.0 };
                checkerboard += sign
                    * fade(i)
                    * fade(j)
                    * influence.displacement(f64::from(i) * pitch[0], f64::from(j) * pitch[1]);
            }
        }
        if boundary.repeats(0) || boundary.repeats(1) {
            let shortest = pitch.map(|pitch| PI / pitch);
            checkerboard = checkerboard.min(response.harmonic_displacement(shortest[0], shortest[1]));
        }
        // At once viscoelastic bodies answer as glass.
        let glassy = pair.creep_together().map_or(1.0, |creep| creep.glassy / creep.relaxed());
        Self { single: glassy * influence.displacement(0.0, 0.0), checkerboard: glassy * checkerboard }
    }
}

/// Largest depth worn off a cell of both bodies in a pass per unit pressure, m/Pa: that of the cell longest
/// in contact.
pub(super) fn relaxation(
    pair: &Pair,
    contacts: &[Contact],
    laws: &[Box<dyn Law>],
    friction: f64,
    distance: Metre,
) -> f64 {
    let mut count = [&pair.lower, &pair.upper].map(|body| vec![0.0; body.heights.len()]);
    for contact in contacts {
        for (count, placement) in count.iter_mut().zip(pair.placements(&contact.position)) {
            for &(cell, _) in &contact.pressure {
                placement
                    .parts(placement.cell(cell as usize))
                    .for_each(|(cell, weight)| count[cell] += weight);
            }
        }
    }
    let longest = count.map(|count| count.into_iter().fold(0.0, f64::max) * distance);
    let removal = |law: &dyn Law| {
        let per_pressure = law.per_pressure(friction);
        per_pressure[0] * longest[0] + per_pressure[1] * longest[1]
    };
    laws.iter().map(|law| removal(law.as_ref())).sum()
}

impl Acceleration {
    /// Returns the largest number of passes of the next extrapolation, before its error is known.
    pub(super) fn most(&self, bounds: &Bounds, before: &LastExtrapolation) -> usize {
        let [plastic, worn] = bounds.volumes;
        let most = if plastic > worn * before.passes as f64 {
            // Plastic flow does not repeat: the surfaces shake down first.
            before.passes / 2
        } else {
            let within = (self.max_wear / bounds.deepest).min(bounds.stable);
            (within.min(MAX_COUNT as f64) as usize).min(2 * before.passes)
        };
        most.min(self.max_jump).min(bounds.left).max(1)
    }
}

/// Returns the mean over `passes` of sums whose change per pass since `before` continues.
pub(super) fn extrapolated(now: &[Sums], before: &LastExtrapolation, passes: usize) -> Vec<Sums> {
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
