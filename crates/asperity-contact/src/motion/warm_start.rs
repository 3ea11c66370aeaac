//! Warm start that a pass leaves to the next, besides the bodies.
//!
//! Removal changes the pressures at a position by about the same amount in each pass. A pass begins with the
//! extrapolated pressures: the change of the last pass, scaled by how well that pass repeated the change
//! before it.

use crate::error::Result;
use crate::motion::contact::Contact;
use crate::motion::extrapolation::{LastExtrapolation, Removed};
use crate::motion::pair::Pair;
use crate::motion::path::Position;
use crate::motion::store::{CourseState, StateReader, StateWriter, restore_if, restore_sums, store_sums};
use crate::solver::Stats;
use crate::units::{Metre, Pascal};

/// State in which the next pass begins. Solutions are exact only within their tolerances and depend on the
/// start. A motion therefore continues with the same bits only from the same start.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct WarmStart {
    /// Initial guess of the search for the approach; `None` if no mean load is prescribed, or if the next
    /// pass has other positions or bodies.
    pub guess: Option<Guess>,
    /// The loaded cells at each solved position of the last pass; empty before the first pass, or if the next
    /// pass has other positions.
    pub positions: Vec<LoadedCells>,
    /// The last extrapolation; `None` before the first pass, or if nothing is removed.
    pub extrapolation: Option<LastExtrapolation>,
    /// Removal by custom laws in the last pass; `None` without it, or if passes are not extrapolated.
    pub removed: Option<Removed>,
    /// Finished passes of the motion.
    pub represented: usize,
}

/// Initial guess of the search for the approach of a pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Guess {
    /// The approach δ.
    pub approach: Metre,
    /// Relative change d ln W/dδ of the mean load with the approach, 1/m. The load of rough bodies grows
    /// about exponentially with the approach.
    pub slope: f64,
    /// Change of the approach since the computed pass before, in m per pass of the motion.
    pub change: Metre,
    /// Fraction of this change that the next pass is expected to repeat, 0 … 1: the fraction of the change
    /// before it that the last pass has repeated.
    pub persistence: f64,
    /// Expected relative error of the mean load at the guess, equal to that of the guess before.
    pub error: f64,
}

impl Guess {
    /// Creates a guess without a pass before it, whose error is unknown.
    pub(super) fn new(approach: Metre, slope: f64) -> Self {
        Self { approach, slope, change: 0.0, persistence: 0.0, error: 1.0 }
    }

    /// Creates a guess from the approaches under two mean loads with the ratio `more`. Over `scale` the load
    /// changes by a factor of about e if the approaches tell no slope.
    pub(super) fn between(approach: Metre, further: Metre, more: f64, scale: Metre) -> Self {
        let slope = more.ln() / (further - approach);
        Self::new(approach, if slope > 0.0 && slope.is_finite() { slope } else { 1.0 / scale })
    }

    /// Adds the change since the guess `before`, which is `passes` passes of the motion earlier.
    fn after(self, before: Option<&Self>, passes: f64) -> Self {
        let Some(before) = before else { return self };
        let change = (self.approach - before.approach) / passes;
        let repeated = change / before.change;
        let persistence = if repeated.is_finite() { repeated.clamp(0.0, 1.0) } else { 0.0 };
        Self { change, persistence, ..self }
    }
}

/// The loaded cells at one position.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadedCells {
    /// The approach δ.
    pub approach: Metre,
    /// Flat cells with p > 0, ascending, and their pressure, Pa.
    pub pressure: Vec<(u32, Pascal)>,
    /// Change of the pressure of each of these cells since the computed pass before, in Pa per pass of the
    /// motion; 0 for cells without pressure before, and for all cells after the first pass.
    pub change: Vec<Pascal>,
    /// Fraction of this change that the next pass is expected to repeat, 0 … 1: the fraction of the change
    /// before it that this pass has repeated.
    pub persistence: f64,
}

impl WarmStart {
    /// Creates the warm start from the contacts of a pass.
    pub(super) fn new(
        guess: Option<Guess>,
        contacts: &[Contact],
        extrapolation: Option<LastExtrapolation>,
        removed: Option<Removed>,
        represented: usize,
        before: &Self,
    ) -> Self {
        let passes = before.extrapolated_passes();
        let loaded_cells = |(number, c): (usize, &Contact)| {
            LoadedCells::new(c.approach, c.pressure.clone(), before.positions.get(number), passes)
        };
        Self {
            guess: guess.map(|guess| guess.after(before.guess.as_ref(), passes)),
            positions: contacts.iter().enumerate().map(loaded_cells).collect(),
            removed: removed.filter(|_| extrapolation.is_some()),
            extrapolation,
            represented,
        }
    }

    /// Returns the last contact of the pass; `None` before the first pass.
    pub(super) fn last(&self, pair: &Pair, positions: &[Position]) -> Option<Contact> {
        let (loaded_cells, position) = self.positions.last().zip(positions.last())?;
        let LoadedCells { approach, pressure, .. } = loaded_cells;
        Some(Contact::from_pressure(pair, *position, *approach, pressure.clone(), Stats::default()))
    }

    /// Number of passes over which the last computed one was extrapolated.
    pub(super) fn extrapolated_passes(&self) -> f64 {
        self.extrapolation.as_ref().map_or(1.0, |last| last.passes as f64)
    }

    /// Returns the guess for the next pass, whose load has this relative `tolerance`; `None` before the first
    /// pass. If the load at the last approach is expected to be near enough, the guess is that approach: its
    /// contacts are known.
    pub(super) fn guess(&self, tolerance: f64) -> Option<Guess> {
        let guess = self.guess?;
        let change = guess.persistence * self.extrapolated_passes() * guess.change;
        let predicted = guess.approach + change;
        let near = |last: &Metre| (predicted - last).abs() * guess.slope <= NEAR * tolerance;
        let last = self.positions.first().map(|position| position.approach).filter(near);
        Some(Guess { approach: last.unwrap_or(predicted), ..guess })
    }

    /// Returns the initial contacts of the positions, at no cost so far; `None` before the first pass.
    pub(super) fn contacts(&self, pair: &Pair, positions: &[Position]) -> Option<Vec<Contact>> {
        let contact = |(loaded_cells, position): (&LoadedCells, &Position)| {
            let pressure = loaded_cells.predicted(self.extrapolated_passes());
            Contact::from_pressure(pair, *position, loaded_cells.approach, pressure, Stats::default())
        };
        let begun = !self.positions.is_empty();
        begun.then(|| self.positions.iter().zip(positions).map(contact).collect())
    }
}

/// ```text
/// /              attributes: approach, slope, change, persistence and error of the guess (m, 1/m, m, 1, 1; with a prescribed mean
///                load); represented, the finished passes of the motion; jump, the passes of the last extrapolation
/// /approach      at each position, m
/// /bearing       cells with p > 0 at each position
/// /cell          those cells, position by position: flat index
/// /pressure      their pressure, Pa
/// /change        its change since the computed pass before, Pa per pass of the motion
/// /persistence   at each position, the fraction of this change that is expected again
/// /sum_lower_1_1 first sum of the first repeating law over the last pass, for the lower body; and so on
/// /removed_lower depth that custom laws take off the lower body in a single pass, m; and so on, with its change per pass as an attribute
/// ```
impl CourseState for WarmStart {
    fn store(&self, to: &mut dyn StateWriter) {
        to.count("represented", self.represented);
        if let Some(last) = &self.extrapolation {
            to.count("jump", last.passes);
            store_sums(to, "sum", &last.sums);
        }
        if let Some(Removed { depth: [lower, upper], change }) = &self.removed {
            to.field("removed_lower", "m", lower);
            to.field("removed_upper", "m", upper);
            to.number("removed_change", *change);
        }
        if let Some(Guess { approach, slope, change, persistence, error }) = self.guess {
            to.number("approach", approach);
            to.number("slope", slope);
            to.number("change", change);
            to.number("persistence", persistence);
            to.number("error", error);
        }
        let of_positions =
            |value: fn(&LoadedCells) -> f64| self.positions.iter().map(value).collect::<Vec<_>>();
        let of_cells = |value: fn(&(u32, f64)) -> f64| {
            self.positions.iter().flat_map(|p| &p.pressure).map(value).collect::<Vec<_>>()
        };
        let change = self.positions.iter().flat_map(|p| &p.change).copied().collect::<Vec<_>>();
        to.series("approach", "m", "position", &of_positions(|p| p.approach));
        to.series("bearing", "1", "position", &of_positions(|p| p.pressure.len() as f64));
        to.series("cell", "1", "bearing", &of_cells(|(cell, _)| f64::from(*cell)));
        to.series("pressure", "Pa", "bearing", &of_cells(|(_, p)| *p));
        to.series("change", "Pa", "bearing", &change);
        to.series("persistence", "1", "position", &of_positions(|p| p.persistence));
    }
}

impl WarmStart {
    /// Restores the start of a pass.
    ///
    /// # Errors
    /// The errors of the reader.
    pub fn restore(from: &dyn StateReader) -> Result<Self> {
        let [approach, bearing, persistence] =
            [from.series("approach")?, from.series("bearing")?, from.series("persistence")?];
        let [cell, pressure, change] =
            [from.series("cell")?, from.series("pressure")?, from.series("change")?];
        let mut cells = cell.into_iter().map(|cell| cell as u32).zip(pressure);
        let mut changes = change.into_iter();
        let positions = approach.into_iter().zip(bearing).zip(persistence);
        let positions = positions.map(|((approach, count), persistence)| LoadedCells {
            approach,
            pressure: cells.by_ref().take(count as usize).collect(),
            change: changes.by_ref().take(count as usize).collect(),
            persistence,
        });
        let guess = || {
            Ok(Guess {
                approach: from.number("approach")?,
                slope: from.number("slope")?,
                change: from.number("change")?,
                persistence: from.number("persistence")?,
                error: from.number("error")?,
            })
        };
        let extrapolation = || {
            let passes = from.number("jump")? as usize;
            Ok(LastExtrapolation { passes, sums: restore_sums(from, "sum")? })
        };
        let removed = || {
            let depth = [from.field("removed_lower")?, from.field("removed_upper")?];
            Ok(Removed { depth, change: from.number("removed_change")? })
        };
        Ok(Self {
            positions: positions.collect(),
            guess: restore_if(from, "slope", guess)?,
            extrapolation: restore_if(from, "jump", extrapolation)?,
            removed: restore_if(from, "removed_change", removed)?,
            represented: from.number("represented")? as usize,
        })
    }
}

/// Largest load error expected at the last approach at which the next pass begins there, as a fraction of the
/// tolerance.
const NEAR: f64 = 0.5;

/// Least extrapolated pressure of a cell, as a fraction of the last one.
const LEAST: f64 = 0.01;
/// Largest extrapolated pressure of a cell, as a multiple of the last one.
const MOST: f64 = 2.0;

impl LoadedCells {
    /// Creates the record of the loaded cells, `passes` passes of the motion after those `before`.
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

    /// Returns the extrapolated pressures `passes` passes of the motion later.
    fn predicted(&self, passes: f64) -> Vec<(u32, Pascal)> {
        let cells = self.pressure.iter().zip(&self.change);
        let share = self.persistence * passes;
        cells.map(|((cell, p), change)| (*cell, (p + share * change).clamp(LEAST * p, MOST * p))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Extrapolates after passes with these pressures, each this many passes of the motion after the one
    /// before; the last number is that of the passes to come.
    fn predicted(states: &[(&[(u32, f64)], f64)], to_come: f64) -> Vec<(u32, f64)> {
        let mut last = None;
        for (pressure, passes) in states {
            last = Some(LoadedCells::new(0.0, pressure.to_vec(), last.as_ref(), *passes));
        }
        last.unwrap().predicted(to_come)
    }

    #[test]
    fn pressures_that_change_steadily_are_foreseen() {
        let states: [(&[_], _); 3] = [
            (&[(1, 10.0), (4, 20.0)], 1.0),
            (&[(1, 11.0), (4, 18.0)], 1.0),
            (&[(1, 13.0), (4, 14.0), (7, 3.0)], 2.0),
        ];
        assert_eq!(predicted(&states[..1], 1.0), states[0].0);
        assert_eq!(predicted(&states[..2], 1.0), states[1].0);
        assert_eq!(predicted(&states, 3.0), [(1, 16.0), (4, 8.0), (7, 3.0)]);
        // Never to tension, and never far.
        assert_eq!(predicted(&states, 30.0), [(1, 26.0), (4, 0.14), (7, 3.0)]);
    }

    #[test]
    fn a_change_that_fades_is_foreseen_to_fade_and_one_that_turns_not_at_all() {
        let after = |pressures: [f64; 3]| {
            let states = pressures.map(|p| [(2, p)]);
            predicted(&[(&states[0], 1.0), (&states[1], 1.0), (&states[2], 1.0)], 1.0)
        };
        assert_eq!(after([8.0, 12.0, 14.0]), [(2, 15.0)]);
        assert_eq!(after([8.0, 12.0, 10.0]), [(2, 10.0)]);
    }
}
