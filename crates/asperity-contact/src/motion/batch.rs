//! All positions of a pass of one geometry as one batch on a device.

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::math::parallel;
use crate::motion::contact::Contact;
use crate::motion::pair::Pair;
use crate::motion::pass::{Pass, Solver};
use crate::motion::watch::OneOfMany;
use crate::solver::{Bounds, Control, Params, Solution, Stats, solve_batch};

/// Number of batches, each to a tenth of the residual before, until the load is met by positions that are
/// accurate alone.
const MAX_BATCHES: usize = 3;

impl Solver<'_> {
    /// Solves all positions as one batch, at an approach, or at the one at which they bear a mean load.
    /// Returns none if this pass takes the search for an approach: its loads are at a limit, or it exceeds
    /// the memory of the device.
    ///
    /// # Errors
    /// The errors of the contacts, and those of devices.
    pub(super) fn solve_batch(
        &self,
        pair: &Pair,
        control: Control,
        params: &Params,
        earlier: Option<&Vec<Contact>>,
    ) -> Result<Option<Pass>> {
        let count = self.positions.len() as f64;
        let contacts: Vec<(Field, Bounds)> = parallel::tasks(self.positions, |position| {
            (pair.initial_gap(position), self.motion.bounds(pair, position))
        });
        let bearable: f64 = contacts.iter().map(|(gap, bounds)| bounds.upper().sum(gap.len())).sum();
        let total = match control {
            Control::Load(load) if load * count >= pair.cell_area() * bearable => return Ok(None),
            Control::Load(load) => Control::Load(load * count),
            approach => approach,
        };
        let width = pair.lower.width();
        let mut start: Option<Vec<Field>> =
            earlier.map(|contacts| contacts.iter().map(|contact| contact.pressure_field(width)).collect());
        let largest =
            self.positions.iter().map(|position| position.columns).max().expect("a pass has positions");
        let definition = self.operators.definition([largest, width]);
        let watch = OneOfMany(self.watch);
        let (mut batch, mut spent) = (*params, Stats::default());
        for _ in 0..MAX_BATCHES {
            let solved = solve_batch(&definition, contacts.clone(), total, start.as_deref(), &batch, &watch);
            let mut solutions = match solved {
                Ok(solutions) => solutions,
                Err(Error::DeviceMemory { .. } | Error::NotConverged { .. }) => return Ok(None),
                Err(other) => return Err(other),
            };
            // Each position takes part in all transforms of the batch.
            spent = spent.and(&solutions[0].stats);
            solutions.iter_mut().for_each(|solution| solution.stats = spent);
            if solutions.iter().all(|solution| solution.residual < params.tolerance) {
                return Ok(Some(self.pass(pair, &solutions)));
            }
            // The residual of all positions together is a mean: that of a lightly loaded one may be larger.
            batch.tolerance *= 0.1;
            start = Some(solutions.into_iter().map(|solution| solution.pressure).collect());
        }
        Ok(None)
    }

    fn pass(&self, pair: &Pair, solutions: &[Solution]) -> Pass {
        let contact = |(index, solution): (usize, &Solution)| self.contact(index, solution);
        Pass::new(parallel::tasks(solutions.iter().enumerate(), contact), pair.clone(), self.laws)
    }
}
