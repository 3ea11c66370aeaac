//! A motion of a case, with each pass written to a results directory.

use std::path::Path;

use web_time::Instant;

use crate::case::{Case, CounterBody};
use crate::elasto_plastic;
use crate::estimate::{Estimate, estimate};
use crate::finish::{Computed, conclude, pair, params};
use crate::identity;
use crate::io::lock::Lock;
use crate::limits::Limits;
use crate::observe::{self, Observers};
use crate::prepare::{bodies_until, fresh_heights};
use crate::results::{Existing, StepWriter, Writer};
use crate::review;
use crate::summary::{Outcome, Summary};
use crate::surface_input::SurfaceInput;
use asperity_base::error::{Error, Result};
use asperity_contact::motion::{
    Body, Motion, Output, Pair, PassRecord, PlasticRecord, Simulation, SolvedPass, Watch,
};
use asperity_contact::with::{self, InterfaceNumbers};
use asperity_surface::{NEVER, Stop};

/// A running motion. [`Passes::solve`] and [`Passes::finish`] alternate until no pass is left, and
/// [`Passes::end`] writes the summary. Between the two calls the pass can be read and changed.
pub struct Passes {
    case: Case,
    simulation: Simulation,
    motion: Motion,
    /// Number of finished passes, and of passes of the motion including extrapolated ones.
    done: usize,
    represented: usize,
    writer: Writer,
    output: StepWriter,
    observers: Observers,
    limits: Limits,
    interface: InterfaceNumbers,
    warnings: Vec<String>,
    began: Instant,
}

impl Passes {
    /// Prepares the bodies of `case` with the surfaces `given`, and opens `directory`. A resumed motion
    /// continues after the passes found there.
    ///
    /// # Errors
    /// Every error of a case, its surfaces or the directory; [`Error::Unsupported`] for a static contact.
    pub fn enter(case: &Case, given: SurfaceInput, directory: &Path, existing: Existing) -> Result<Self> {
        Self::enter_until(case, given, directory, existing, NEVER)
    }

    /// [`enter`](Self::enter) that can be stopped by `stop` before the bodies are prepared.
    ///
    /// # Errors
    /// The errors of [`enter`](Self::enter); [`Error::Interrupted`].
    pub fn enter_until(
        case: &Case,
        given: SurfaceInput,
        directory: &Path,
        existing: Existing,
        stop: Stop<'_>,
    ) -> Result<Self> {
        Self::enter_with(case, given, directory, (existing, None), stop)
    }

    /// [`enter_until`](Self::enter_until) with a lock of the directory that may be held already.
    pub(super) fn enter_with(
        case: &Case,
        given: SurfaceInput,
        directory: &Path,
        (existing, lock): (Existing, Option<Lock>),
        stop: Stop<'_>,
    ) -> Result<Self> {
        let began = Instant::now();
        let bodies = bodies_until(case, given, stop)?;
        let estimate = estimate(case, &bodies)?;
        let motion = case
            .motion(estimate.apparent_area)
            .ok_or(Error::Unsupported("a static contact has no passes"))?;
        let resolved = identity::resolved(case, &bodies);
        let look = estimate.subsurface.as_ref().map(|plan| plan.index);
        let simulation = simulation(case, pair(case, bodies)?, motion, None, look)?;
        let writer = Writer::enter_with(directory, &resolved, existing, lock)?;
        writer.begin()?;
        let output = writer.passes(case.output.pressure_every, estimate.subsurface.clone())?;
        let passes = writer.results().passes()?;
        // They compare with the bodies before the first pass.
        let done = Some(passes.len()).filter(|done| *done > 0);
        let observers =
            Observers::new(case, simulation.pair(), simulation.positions(), (Some(&writer), done))?;
        let limits = Limits::new(case, simulation.pair(), &estimate, (Some(&writer), done))?;
        let Estimate { interface, mut warnings, .. } = estimate;
        let represented = passes.iter().map(PassRecord::represents).sum();
        if represented > motion.passes {
            warnings.push(format!(
                "the results hold {represented} finished passes, more than `passes = {}` of the case: all of them stay, and the case in \
                 summary.json has their number",
                motion.passes
            ));
        }
        let simulation = match passes.len() {
            0 => {
                writer.write_initial(simulation.pair(), motion.friction.as_ref())?;
                simulation
            }
            // With no pass left, the present bodies are not needed, except their plastic state.
            _ if represented >= motion.passes && case.plasticity.is_none() => simulation,
            done => {
                let mut pair = simulation.pair().clone();
                let [lower, upper] = writer.results().surfaces_after(done)?;
                (pair.lower.heights, pair.upper.heights) = (lower.into_heights(), upper.into_heights());
                [pair.lower.state, pair.upper.state] = writer.results().states_after(done)?;
                let virgin = &simulation.pair().upper;
                let resumed = self::simulation(case, pair, motion, Some(virgin), look)?;
                let resumed = match case.plasticity {
                    Some(_) => resumed.with_plastic_states(writer.results().plastic_states_after(done)?),
                    None => resumed,
                };
                if represented >= motion.passes {
                    resumed
                } else {
                    resumed.resumed(done, writer.results().warm_start_after(done)?)
                }
            }
        };
        let (case, done) = (case.clone(), passes.len());
        let wanted = observers.wanted(simulation.positions().len());
        let simulation = simulation.keeping_gaps(|index| wanted[index]);
        Ok(Self {
            case,
            simulation,
            motion,
            done,
            represented,
            writer,
            output,
            observers,
            limits,
            interface,
            warnings,
            began,
        })
    }

    /// Number of finished passes.
    pub fn computed(&self) -> usize {
        self.done
    }

    /// Returns the records of the finished passes.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn done(&self) -> Result<Vec<PassRecord>> {
        self.writer.results().passes()
    }

    /// The motion with its present bodies.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// Solves the next pass; returns `None` after the last.
    ///
    /// # Errors
    /// The errors of [`Simulation::solve`].
    pub fn solve(&self, watch: &dyn Watch) -> Result<Option<SolvedPass>> {
        if self.represented < self.motion.passes { self.simulation.solve(watch).map(Some) } else { Ok(None) }
    }

    /// Finishes a pass: writes it, and uses its bodies for the next one.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn finish(&mut self, pass: SolvedPass, watch: &dyn Watch) -> Result<()> {
        // The rows of the observers and the limits are written before that of the pass, which marks it as
        // done.
        let outputs: &mut [&mut dyn Output] = &mut [&mut self.observers, &mut self.limits, &mut self.output];
        self.simulation.finish(pass, watch, outputs)?;
        self.done += 1;
        self.represented = self.simulation.represented();
        Ok(())
    }

    /// Writes the summary of the finished passes.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn end(mut self) -> Result<(Summary, Writer)> {
        let pair = self.simulation.pair();
        let shapes = [pair.lower_grid(), pair.upper_grid()].map(|grid| grid.shape);
        let passes = self.done()?;
        self.warnings.extend(self.limits.all());
        self.warnings.extend(review::motion(&self.case, shapes, &passes));
        self.warnings.extend(with::doubts_after_passes(&self.case.interface, &passes));
        let left = self.simulation.plastic_volumes();
        let plasticity = (!left.is_empty()).then(|| -> Result<PlasticRecord> {
            let steps = self.writer.results().steps()?;
            let pitch = pair.pitch()[0];
            self.warnings.extend(review::rolled(&self.case, pitch, &steps, &passes, &left));
            Ok(PlasticRecord::of_passes(&left, &steps, &passes))
        });
        let subsurface = self.output.subsurface(passes.len())?;
        let (found, _) = self.observers.finish()?;
        self.warnings.extend(observe::doubts(&self.case, &found));
        let outcome = Computed {
            interface: self.interface,
            found: observe::summary(&found),
            outcome: Outcome::Passes(passes),
            subsurface,
            sliding: None,
            plasticity: plasticity.transpose()?,
            closed_form: None,
        };
        let summary = conclude(&self.case, &self.writer, self.began, outcome, self.warnings)?;
        Ok((summary, self.writer))
    }
}

/// Creates the motion of a case. `virgin` is its upper body for passes that need a new one; by default that
/// of the pair. Stress under the surface is requested at the position `look`.
fn simulation(
    case: &Case,
    pair: Pair,
    motion: Motion,
    virgin: Option<&Body>,
    look: Option<usize>,
) -> Result<Simulation> {
    let simulation = Simulation::new(pair, case.contact.boundary, motion, params(case))?;
    let changes = case.changes(simulation.pair(), params(case))?;
    let simulation = simulation.with_rim(case.output.rim)?.with_changes(changes)?;
    let simulation = match &case.plasticity {
        None => simulation,
        Some(spec) => {
            let bodies = elasto_plastic::bodies(case, spec, simulation.pair())?;
            let yielding = simulation.with_plastic(bodies, spec.params())?;
            match look {
                None => yielding,
                Some(position) => yielding.with_state_under_load(position),
            }
        }
    };
    if case.motion.is_none_or(|motion| motion.counter == CounterBody::Same) {
        return Ok(simulation);
    }
    let virgin = virgin.unwrap_or(&simulation.pair().upper).clone();
    let (case, lower) = (case.clone(), simulation.pair().lower_grid());
    simulation.with_counter(move |pass| {
        let mut fresh = virgin.clone();
        fresh.heights = fresh_heights(&case, lower, pass)?;
        Ok(fresh)
    })
}
