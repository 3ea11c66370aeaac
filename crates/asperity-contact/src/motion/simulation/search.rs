//! Search for the approach of a pass.

use super::{Simulation, max_load};
use crate::error::{Error, LoadLimit, Result};
use crate::grid::Field;
use crate::motion::approach::{Limit, MAX_RESIDUAL, Search};
use crate::motion::contact::Contact;
use crate::motion::control::LoadControl;
use crate::motion::pair::Pair;
use crate::motion::pass::{Pass, Solver};
use crate::motion::path::Position;
use crate::motion::slip::SlipRegime;
use crate::motion::warm_start::Guess;
use crate::motion::watch::Watch;
use crate::solver::{Control, Device};
use crate::units::{Metre, Newton};

impl Simulation {
    /// Solves one pass on the present geometry. Returns it with the initial guess of the next search and the
    /// number of approaches tried.
    pub(super) fn solve_pass(&self, pair: &Pair, watch: &dyn Watch) -> Result<(Pass, Option<Guess>, usize)> {
        let positions = &self.positions[..self.distinct];
        let mut earlier: Vec<Vec<Contact>> = self.warm.contacts(pair, positions).into_iter().collect();
        let mut solver = self.solver(watch);
        let on_device = self.params.device != Device::Cpu && self.volumes.is_none();
        if on_device && self.motion.is_one_batch(pair.yields()) {
            let start = earlier.first();
            if let Some(pass) = solver.solve_batch(pair, self.motion.control, &self.params, start)? {
                let slope = self.warm.guess.map_or(1.0 / pair.height_scale(), |guess| guess.slope);
                let searched = matches!(self.motion.control, Control::Load(_));
                let guess = searched.then(|| Guess::new(pass.contacts[0].approach, slope));
                return Ok((pass, guess, 1));
            }
        }
        let load = match (self.motion.control, self.motion.load_control) {
            (Control::Load(load), LoadControl::Pass) => load,
            (control, _) => {
                let pass = match self.solve_in_sequence(&solver, pair, control, &earlier)? {
                    Some(pass) => pass,
                    None => solver.solve(pair, control, &self.params, &earlier)?,
                };
                return Ok((pass, None, 1));
            }
        };
        // Plastic flow takes most of the time of a trial, so rough contacts would save nothing. Rough
        // contacts that depend on where the bodies come from may be in another state, and those of
        // viscoelastic bodies would be remembered.
        let remembers = pair.relaxes() || pair.lubrication().is_some();
        let exact = self.volumes.is_some() || !pair.interface().is_hard() || remembers;
        let roughest = if exact { self.params.tolerance } else { MAX_RESIDUAL };
        let guess = match self.warm.guess(self.motion.load_tolerance) {
            Some(guess) => guess,
            None => {
                let sample = self.together.then(|| solver.sample(pair, load, &self.params)).transpose()?;
                match sample.flatten() {
                    Some((guess, contacts)) => {
                        earlier = vec![contacts];
                        guess
                    }
                    None => self.first_guess(pair, load, watch)?,
                }
            }
        };
        let search = Search {
            load,
            tolerance: self.motion.load_tolerance,
            residual: self.params.tolerance,
            roughest,
            touch: self.bears(pair),
            resolution: resolution(pair),
            limit: self.limit(pair),
        };
        let mut closed = false;
        let found = search.run(guess, |approach, residual| {
            let control = Control::Approach(approach);
            let outcome = match self.solve_in_sequence(&solver, pair, control, &earlier)? {
                Some(pass) => pass,
                None => solver.solve_roughly(pair, control, (residual, &self.params), &earlier)?,
            };
            if solver.progress.trial == 1 {
                // Pressures are extrapolated between the trials on this geometry alone.
                earlier.clear();
            }
            solver.progress.trial += 1;
            closed |= outcome.contacts.iter().any(|contact| self.leaves_mean_free(contact));
            earlier.insert(0, outcome.contacts.clone());
            earlier.truncate(2);
            Ok((outcome.mean_load(), outcome))
        });
        let found = found.map_err(|error| match error {
            // The load jumps where a position comes into full contact at pressures below the hardness.
            Error::LoadNotReached { load, below: most, approach, .. } if most > 0.0 && closed => {
                Error::BeyondPass { load, most, approach, cause: LoadLimit::FullContact }
            }
            other => other,
        })?;
        Ok((found.outcome, Some(found.guess), found.trials))
    }

    /// Solves the positions of a pass one after another, if the bodies remember the ones before.
    fn solve_in_sequence(
        &self,
        solver: &Solver<'_>,
        pair: &Pair,
        control: Control,
        earlier: &[Vec<Contact>],
    ) -> Result<Option<Pass>> {
        match &self.volumes {
            Some(volumes) => solver.solve_elasto_plastic(volumes, pair, control, &self.params).map(Some),
            None if pair.relaxes() => solver.solve_creeping(pair, control, &self.params, earlier).map(Some),
            None => match pair.lubrication() {
                Some(oil) => solver.solve_lubricated(pair, oil, self.boundary, control).map(Some),
                None => Ok(None),
            },
        }
    }

    /// Whether the pressure of a contact determines no approach, because all cells touch elastically and
    /// their mean displacement is free.
    fn leaves_mean_free(&self, contact: &Contact) -> bool {
        let cells = self.pair.grid(contact.position.columns).cells();
        self.boundary.leaves_mean_free() && contact.pressure.len() == cells && contact.plastic.is_empty()
    }

    /// Makes a guess from the position with the most columns, at two loads near its share of the pass-mean
    /// load, of dry bodies.
    fn first_guess(&self, pair: &Pair, load: Newton, watch: &dyn Watch) -> Result<Guess> {
        let pair = &pair.clone().with_lubrication(None);
        let fullest = self.positions.iter().max_by_key(|p| p.columns).expect("a pass has positions");
        let share = fullest.columns as f64 / mean_columns(&self.positions);
        let limit = max_load(pair, &self.motion, fullest);
        let params = self.params.with_tolerance(self.params.tolerance.max(1e-3));
        let solve = |load: Newton, start: Option<&Contact>| {
            let start = start.map(|c| c.pressure_field(pair.lower.width()));
            let control = Control::Load(load);
            Contact::solve(
                pair,
                &self.operators,
                *fullest,
                SlipRegime::Frictionless,
                control,
                start.as_ref(),
                None,
                &params,
                watch,
            )
            .map(|(contact, _)| contact)
        };
        let (less, more) = ((load * share).min(0.9 * limit), (1.2 * load * share).min(0.95 * limit));
        let scale = pair.height_scale();
        let solved =
            solve(less, None).and_then(|first| Ok((first.approach, solve(more, Some(&first))?.approach)));
        let (approach, further) = match solved {
            Ok(approaches) => approaches,
            // Without a solution, the guess starts at first touch.
            Err(Error::NotConverged { .. }) => {
                return Ok(Guess::new(self.touch(pair) + scale, 1.0 / scale));
            }
            Err(other) => return Err(other),
        };
        Ok(Guess::between(approach, further, more / less, scale))
    }

    /// Approach at which some position of the pass first touches.
    fn touch(&self, pair: &Pair) -> Metre {
        let lowest = |position| pair.initial_gap(position).iter().copied().fold(f64::INFINITY, f64::min);
        self.positions[..self.distinct].iter().map(lowest).fold(f64::INFINITY, f64::min)
    }

    /// Approach below which a pass carries no load: that of first touch. Oil bears before the solids touch, but not over a
    /// gap as wide as the bodies are long.
    fn bears(&self, pair: &Pair) -> Metre {
        let film = if pair.lubrication().is_some() { pair.lower_grid().extent()[0] } else { 0.0 };
        self.touch(pair) - film
    }

    /// Approach beyond which a pass of the present bodies carries no more load. It is the approach at which
    /// every cell would be at the hardness at every position if none had yielded before. For periodic elastic
    /// bodies it is the mean gap, at which all positions are in full contact. If some cells yield and others
    /// never do, there is no limit.
    fn limit(&self, pair: &Pair) -> Limit {
        // The hardness does not limit the pressure below an oil.
        if pair.lubrication().is_some() {
            return Limit { approach: f64::INFINITY, cause: LoadLimit::Yielded };
        }
        let cap = |hardness| self.motion.friction.map_or(hardness, |friction| friction.sliding_cap(hardness));
        let hardness = cap(pair.max_hardness());
        let largest = |value: fn(&Field) -> f64| {
            let positions = self.positions[..self.distinct].iter();
            positions.map(|p| value(&pair.initial_gap(p))).fold(f64::NEG_INFINITY, f64::max)
        };
        if hardness.is_finite() {
            let highest = largest(|gap| gap.iter().copied().fold(f64::NEG_INFINITY, f64::max));
            let columns = self.positions.iter().map(|p| p.columns).max().unwrap_or(1);
            // Displacement under the hardness on the whole overlap. The shear in sliding adds less than μ
            // times as much.
            let sinks = self.operators.most_under_uniform([columns, pair.lower.width()]);
            let coefficient = self.motion.friction.map_or(0.0, |friction| friction.coefficient);
            let approach = highest + (1.0 + coefficient) * hardness * sinks;
            Limit { approach, cause: LoadLimit::Yielded }
        } else if self.boundary.leaves_mean_free() && !pair.yields() {
            // Closer to the limit the load is less certain than the residual.
            let least = -largest(|gap| -gap.mean().unwrap_or(0.0));
            let rough = largest(|gap| gap.std(0.0));
            Limit { approach: least - self.params.tolerance * rough, cause: LoadLimit::FullContact }
        } else {
            Limit { approach: f64::INFINITY, cause: LoadLimit::FullContact }
        }
    }
}

/// Rounding error of the heights, as a length.
fn resolution(pair: &Pair) -> Metre {
    let highest = |heights: &Field| heights.iter().fold(0.0, |most, z| f64::max(most, z.abs()));
    f64::EPSILON * highest(&pair.lower.heights).max(highest(&pair.upper.heights))
}

fn mean_columns(positions: &[Position]) -> f64 {
    positions.iter().map(|p| p.columns).sum::<usize>() as f64 / positions.len() as f64
}
