//! The warm start that a pass leaves to the next besides the bodies.

use crate::motion::contact::Contact;
use crate::motion::jump::Jump;
use crate::motion::pair::Pair;
use crate::motion::path::Position;
use crate::solver::Stats;
use crate::units::{Metre, Pascal};

/// The state in which the next pass begins. The iterations of a pass end within their tolerances, and where in them
/// depends on where they begin: a motion goes on with the same bits only from the same start.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct WarmStart {
    /// The guess with which the search for the approach begins; none where no mean load is prescribed, nor where the next pass has
    /// other positions or bodies.
    pub guess: Option<Guess>,
    /// The bearing cells at each position that was solved of the last pass; nothing before the first, nor where the next pass has
    /// others.
    pub positions: Vec<Bearing>,
    /// The last jump; none before the first pass, nor where nothing wears.
    pub jump: Option<Jump>,
    /// Passes of the motion that are done.
    pub represented: usize,
}

/// A guess with which the search for the approach of a pass begins.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Guess {
    /// The approach δ.
    pub approach: Metre,
    /// Relative change d ln W/dδ of the mean load with it, 1/m; the load of rough bodies grows about exponentially with the
    /// approach.
    pub slope: f64,
}

/// The bearing cells at one position.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Bearing {
    /// The approach δ.
    pub approach: Metre,
    /// Flat cells with p > 0, ascending, and their pressure, Pa.
    pub pressure: Vec<(u32, Pascal)>,
}

impl WarmStart {
    /// The warm start that the contacts of a pass leave.
    pub(super) fn new(
        guess: Option<Guess>,
        contacts: &[Contact],
        jump: Option<Jump>,
        represented: usize,
    ) -> Self {
        let bearing = |c: &Contact| Bearing { approach: c.approach, pressure: c.pressure.clone() };
        Self { guess, positions: contacts.iter().map(bearing).collect(), jump, represented }
    }

    /// The contacts from which the positions begin, which have cost nothing yet; none before the first pass.
    pub(super) fn contacts(&self, pair: &Pair, positions: &[Position]) -> Option<Vec<Contact>> {
        let contact = |(bearing, position): (&Bearing, &Position)| {
            let pressure = bearing.pressure.clone();
            Contact::from_pressure(pair, *position, bearing.approach, pressure, Stats::default())
        };
        let begun = !self.positions.is_empty();
        begun.then(|| self.positions.iter().zip(positions).map(contact).collect())
    }
}
