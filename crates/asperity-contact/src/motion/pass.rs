//! The positions of one pass.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::motion::contact::Contact;
use crate::motion::heat::PassHeat;
use crate::motion::kinematics::Motion;
use crate::motion::law::{self, Heat, Law, PositionData};
use crate::motion::pair::Pair;
use crate::motion::path::Position;
use crate::motion::plastic_volume::ElastoPlasticPass;
use crate::motion::record::{FilmRecord, LostVolume};
use crate::motion::rim::Interior;
use crate::motion::slip::SlipRegime;
use crate::motion::watch::{Progress, Watch};
use crate::operator::Operators;
use crate::solver::{Control, Equilibrium, Params, Solution};
use crate::units::{Kelvin, Newton};

/// A pass at one prescribed load or approach: its contacts and the pair. The laws still have to change the
/// pair, unless they have done so position by position.
pub(super) struct Pass {
    /// The contacts at the positions.
    pub(super) contacts: Vec<Contact>,
    /// The bodies, possibly changed by each position.
    pub(super) pair: Pair,
    /// The depths that the laws that repeat have taken from both bodies, if all laws have changed the bodies
    /// position by position.
    pub(super) taken: Option<Vec<[Field; 2]>>,
    /// Volumes removed from the bodies by each law.
    pub(super) lost: Vec<LostVolume>,
    /// Results for elasto-plastic bodies; `None` for others.
    pub(super) plastic_pass: Option<ElastoPlasticPass>,
    /// Drag of viscoelastic bodies; `None` for others.
    pub(super) drag: Option<Drag>,
    /// Films of lubricated bodies at the positions; empty for others.
    pub(super) films: Vec<FilmRecord>,
}

/// Drag of viscoelastic bodies in a pass.
pub(super) struct Drag {
    /// Drag at each position, NaN where it is unknown.
    pub(super) positions: Vec<Newton>,
    /// Cells from the position before to each position.
    pub(super) cells: Vec<f64>,
    /// Drag while the bodies come apart, after the last position, times the cells of this step; 0 if they
    /// stay in contact, or if they are lifted.
    pub(super) leaving: Newton,
}

impl Pass {
    /// Creates a pass of a `pair` that `laws` have not changed yet.
    pub(super) fn new(contacts: Vec<Contact>, pair: Pair, laws: &[Box<dyn Law>]) -> Self {
        let lost = law::nothing_lost(laws);
        Self { contacts, pair, taken: None, lost, plastic_pass: None, drag: None, films: Vec::new() }
    }

    /// Mean load over the positions.
    pub(super) fn mean_load(&self) -> Newton {
        self.contacts.iter().map(|c| c.load).sum::<f64>() / self.contacts.len() as f64
    }
}

/// The solver of a pass: data shared by all its trials.
pub(super) struct Solver<'a> {
    pub(super) operators: &'a Operators,
    pub(super) positions: &'a [Position],
    pub(super) motion: &'a Motion,
    pub(super) interiors: &'a [Interior; 2],
    pub(super) laws: &'a [Box<dyn Law>],
    /// The flash temperature, with the number of computed passes before this one, if it is requested.
    pub(super) heat: Option<(&'a PassHeat, usize)>,
    /// Temperatures of the bodies.
    pub(super) bulk: [Kelvin; 2],
    /// Whether the gap of each position is kept.
    pub(super) gaps: &'a [bool],
    /// The last contact of the pass before, if viscoelastic bodies go on from it.
    pub(super) last: Option<Contact>,
    pub(super) watch: &'a dyn Watch,
    /// Pass and trial, for progress reports.
    pub(super) progress: Progress,
}

/// Interval of the positions whose dependence on the position before is checked.
const SAMPLED: usize = 8;
/// Largest number of convolutions spent on a rough solution.
const MAX_ROUGH_CONVOLUTIONS: usize = 300;

impl Solver<'_> {
    /// Solves all positions roughly, to a residual above that of the `params`. If a rough solution fails, it
    /// falls back to the residual of the `params`, because a rough solution must not cause an error.
    pub(super) fn solve_roughly(
        &self,
        pair: &Pair,
        control: Control,
        (residual, params): (f64, &Params),
        earlier: &[Vec<Contact>],
    ) -> Result<Pass> {
        if residual > params.tolerance {
            let max_convolutions = MAX_ROUGH_CONVOLUTIONS.min(params.max_convolutions);
            let rough = params.with_tolerance(residual).with_max_convolutions(max_convolutions);
            match self.solve(pair, control, &rough, earlier) {
                Err(Error::AtPosition { source, .. }) if matches!(*source, Error::NotConverged { .. }) => {}
                other => return other,
            }
        }
        self.solve(pair, control, params, earlier)
    }

    /// Returns the position of this index, with the slip of the bodies there.
    pub(super) fn position(&self, index: usize) -> (Position, SlipRegime) {
        let position = self.positions[index];
        (position, self.motion.slip(position.stroke))
    }

    /// Returns the contact of a `solution` at the position of this index.
    pub(super) fn contact(&self, index: usize, solution: &Solution) -> Contact {
        let (position, regime) = self.position(index);
        Contact::new(position, regime.sliding(), solution).with_gap(solution, self.gaps[index])
    }

    /// Wraps an error as one at the position of this index, unless it is an interruption.
    pub(super) fn at_position(&self, index: usize, error: Error) -> Error {
        let source = match error {
            Error::Interrupted => return error,
            Error::AtIncrement { source, .. } => source,
            other => Box::new(other),
        };
        let (pass, positions) = (self.progress.pass, self.positions.len());
        Error::AtPosition { pass, position: index + 1, positions, source }
    }

    /// Returns the largest difference between the loads of a pass and those of bodies that come from the
    /// position before, over the mean of |W|. It solves every eighth position again, and the one before it.
    ///
    /// # Errors
    /// The errors of the contacts.
    pub(super) fn history_difference(&self, pass: &Pass, params: &Params) -> Result<f64> {
        let loads = pass.contacts[..self.positions.len()].iter().map(|contact| contact.load.abs());
        let mean = loads.sum::<f64>() / self.positions.len() as f64;
        let is_sampled = |index: &usize| {
            let columns = |index: usize| self.positions[index].columns;
            *index > 0 && index.is_multiple_of(SAMPLED) && columns(*index) == columns(index - 1)
        };
        let sampled: Vec<usize> = (0..self.positions.len()).filter(is_sampled).collect();
        let difference = |index: usize| {
            let pair = &pass.pair;
            let solve = |index: usize, last: Option<&Equilibrium>| {
                let (position, regime) = self.position(index);
                let control = Control::Approach(pass.contacts[index].approach);
                Contact::solve(
                    pair,
                    self.operators,
                    position,
                    regime,
                    control,
                    None,
                    last,
                    params,
                    self.watch,
                )
                .map_err(|error| self.at_position(index, error))
            };
            let (_, before) = solve(index - 1, None)?;
            let (contact, _) = solve(index, Some(&before))?;
            Ok((contact.load - pass.contacts[index].load).abs())
        };
        let differences: Vec<Newton> = sampled.into_par_iter().map(difference).collect::<Result<_>>()?;
        let largest = differences.into_iter().fold(0.0, f64::max);
        Ok(if mean > 0.0 { largest / mean } else { 0.0 })
    }

    /// Solves all positions, starting from the contacts of up to two earlier trials at the same positions,
    /// latest first.
    pub(super) fn solve(
        &self,
        pair: &Pair,
        control: Control,
        params: &Params,
        earlier: &[Vec<Contact>],
    ) -> Result<Pass> {
        let solved = AtomicUsize::new(0);
        let solve = |pair: &Pair, index: usize, last: Option<&Equilibrium>| {
            if self.watch.stop() {
                return Err(Error::Interrupted);
            }
            let (position, regime) = self.position(index);
            let start = first_guess(earlier, index, control, pair.lower.width());
            let contact = Contact::solve(
                pair,
                self.operators,
                position,
                regime,
                control,
                start.as_ref(),
                last,
                params,
                self.watch,
            );
            let (contact, solution) = contact.map_err(|error| self.at_position(index, error))?;
            let mut contact = contact.with_gap(solution.normal(), self.gaps[index]);
            if let Some(latest) = earlier.first() {
                contact.stats.convolutions += latest[index].stats.convolutions;
            }
            let solved = solved.fetch_add(1, Ordering::Relaxed) + 1;
            self.watch.position(&Progress { solved, load: contact.load, ..self.progress });
            Ok((contact, solution))
        };
        let mut after = pair.clone();
        if !self.motion.is_frozen(pair.yields()) {
            let position_data = PositionData::new(self.motion, pair, self.bulk);
            let mut lost = law::nothing_lost(self.laws);
            let mut contacts = Vec::with_capacity(self.positions.len());
            let once = law::once(self.laws);
            let mut taken = law::untouched(&self.laws[once..], pair);
            let mut heat = self.heat.map(|(heat, done)| heat.of_pass(done, pair, position_data.bulk));
            let mut last = None;
            for index in 0..self.positions.len() {
                let (mut contact, solution) = solve(&after, index, last.as_ref())?;
                last = pair.interface().follows_path().then_some(solution);
                let heat = heat.as_deref_mut().map(|heat| heat as &mut Heat);
                let at = std::slice::from_ref(&contact);
                let (sums, mut warm) = law::sums(self.laws, &after, at, &position_data, heat)?;
                contact.temperature = warm.pop();
                let depths = law::advance(self.laws, &mut after, &sums, 1.0, self.interiors, &mut lost);
                for (taken, depth) in taken.iter_mut().flatten().zip(depths[once..].iter().flatten()) {
                    *taken += depth;
                }
                contacts.push(contact);
            }
            return Ok(Pass { lost, taken: Some(taken), ..Pass::new(contacts, after, self.laws) });
        }
        let positions = 0..self.positions.len();
        let contacts: Vec<Contact> = if pair.interface().follows_path() {
            let mut last = None;
            let in_sequence = positions.map(|index| {
                let (contact, solution) = solve(pair, index, last.as_ref())?;
                last = Some(solution);
                Ok(contact)
            });
            in_sequence.collect::<Result<_>>()?
        } else {
            let alone =
                positions.into_par_iter().map(|index| solve(pair, index, None).map(|(contact, _)| contact));
            alone.collect::<Result<_>>()?
        };
        Ok(Pass::new(contacts, after, self.laws))
    }
}

/// Smallest extrapolation of a guess, in steps between the two earlier approaches.
const MIN_EXTRAPOLATION: f64 = -0.5;
/// Largest extrapolation of a guess, in steps between the two earlier approaches.
const MAX_EXTRAPOLATION: f64 = 1.0;

/// Extrapolates the pressure at a position over the approach from those of earlier trials.
pub(super) fn first_guess(
    earlier: &[Vec<Contact>],
    index: usize,
    control: Control,
    width: usize,
) -> Option<Field> {
    let latest = &earlier.first()?[index];
    if latest.pressure.is_empty() {
        return None;
    }
    let mut guess = latest.pressure_field(width);
    if let (Some(before), Control::Approach(approach)) = (earlier.get(1), control) {
        let before = &before[index];
        let step = (approach - latest.approach) / (latest.approach - before.approach);
        if step.is_finite() && !before.pressure.is_empty() {
            let step = step.clamp(MIN_EXTRAPOLATION, MAX_EXTRAPOLATION);
            let change = &guess - &before.pressure_field(width);
            guess.scaled_add(step, &change);
            guess.mapv_inplace(|p| p.max(0.0));
        }
    }
    Some(guess)
}
