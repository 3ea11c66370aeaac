//! The warm start that a pass leaves to the next besides the bodies.
//!
//! Wear changes the pressures of a position by about as much in one pass as in the one before. A pass begins with the pressures
//! to which the change of the last one leads, as far as that one has repeated the change before it.

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
    /// The change of the pressure of each of these cells since the computed pass before, in Pa per pass of the motion; 0 where it
    /// bore nothing then, and everywhere after the first.
    pub change: Vec<Pascal>,
    /// Share of this change that the next pass is expected to repeat, 0 … 1: as much as this one has repeated of the one before.
    pub persistence: f64,
}

impl WarmStart {
    /// The warm start that the contacts of a pass leave.
    pub(super) fn new(
        guess: Option<Guess>,
        contacts: &[Contact],
        jump: Option<Jump>,
        represented: usize,
        before: &Self,
    ) -> Self {
        let passes = before.jump_passes();
        let bearing = |(number, c): (usize, &Contact)| {
            Bearing::new(c.approach, c.pressure.clone(), before.positions.get(number), passes)
        };
        Self { guess, positions: contacts.iter().enumerate().map(bearing).collect(), jump, represented }
    }

    /// Passes of the motion that the last computed one stands for.
    fn jump_passes(&self) -> f64 {
        self.jump.as_ref().map_or(1.0, |jump| jump.passes as f64)
    }

    /// The contacts from which the positions begin, which have cost nothing yet; none before the first pass.
    pub(super) fn contacts(&self, pair: &Pair, positions: &[Position]) -> Option<Vec<Contact>> {
        let contact = |(bearing, position): (&Bearing, &Position)| {
            let pressure = bearing.foreseen(self.jump_passes());
            Contact::from_pressure(pair, *position, bearing.approach, pressure, Stats::default())
        };
        let begun = !self.positions.is_empty();
        begun.then(|| self.positions.iter().zip(positions).map(contact).collect())
    }
}

/// The pressure of a cell is foreseen to be no less than this share of the last one,
const LEAST: f64 = 0.01;
/// and no more than so many times as high.
const MOST: f64 = 2.0;

impl Bearing {
    /// The bearing cells and their pressure, so many passes of the motion after those `before`.
    fn new(approach: Metre, pressure: Vec<(u32, Pascal)>, before: Option<&Self>, passes: f64) -> Self {
        let Some(before) = before else {
            return Self { approach, change: vec![0.0; pressure.len()], pressure, persistence: 0.0 };
        };
        let (mut repeated, mut whole) = (0.0, 0.0);
        let change = pressure.iter().map(|(cell, p)| {
            let Ok(index) = before.pressure.binary_search_by_key(cell, |(cell, _)| *cell) else { return 0.0 };
            let (change, earlier) = ((p - before.pressure[index].1) / passes, before.change[index]);
            repeated += change * earlier;
            whole += earlier * earlier;
            change
        });
        let change = change.collect();
        let persistence = if whole > 0.0 { (repeated / whole).clamp(0.0, 1.0) } else { 0.0 };
        Self { approach, pressure, change, persistence }
    }

    /// The pressures that are foreseen so many passes of the motion later.
    fn foreseen(&self, passes: f64) -> Vec<(u32, Pascal)> {
        let cells = self.pressure.iter().zip(&self.change);
        let share = self.persistence * passes;
        cells.map(|((cell, p), change)| (*cell, (p + share * change).clamp(LEAST * p, MOST * p))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is foreseen after passes with these pressures, each so many passes of the motion after the one before; the last
    /// number is those to come.
    fn foreseen(states: &[(&[(u32, f64)], f64)], to_come: f64) -> Vec<(u32, f64)> {
        let mut last = None;
        for (pressure, passes) in states {
            last = Some(Bearing::new(0.0, pressure.to_vec(), last.as_ref(), *passes));
        }
        last.unwrap().foreseen(to_come)
    }

    #[test]
    fn pressures_that_change_steadily_are_foreseen() {
        let states: [(&[_], _); 3] = [
            (&[(1, 10.0), (4, 20.0)], 1.0),
            (&[(1, 11.0), (4, 18.0)], 1.0),
            (&[(1, 13.0), (4, 14.0), (7, 3.0)], 2.0),
        ];
        assert_eq!(foreseen(&states[..1], 1.0), states[0].0);
        assert_eq!(foreseen(&states[..2], 1.0), states[1].0);
        assert_eq!(foreseen(&states, 3.0), [(1, 16.0), (4, 8.0), (7, 3.0)]);
        // Never to tension, and never far.
        assert_eq!(foreseen(&states, 30.0), [(1, 26.0), (4, 0.14), (7, 3.0)]);
    }

    #[test]
    fn a_change_that_fades_is_foreseen_to_fade_and_one_that_turns_not_at_all() {
        let after = |pressures: [f64; 3]| {
            let states = pressures.map(|p| [(2, p)]);
            foreseen(&[(&states[0], 1.0), (&states[1], 1.0), (&states[2], 1.0)], 1.0)
        };
        assert_eq!(after([8.0, 12.0, 14.0]), [(2, 15.0)]);
        assert_eq!(after([8.0, 12.0, 10.0]), [(2, 10.0)]);
    }
}
