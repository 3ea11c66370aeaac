//! The cascade: a first guess of the pressure from successively coarser grids.

use asperity_base::error::{Error, Result};

use crate::fields::{Device, Fields};
use crate::problem::{Contact, Control, Cost, Problem, Solution, Watch};
use crate::solver::{Iteration, State};

/// Tolerance of the coarse grids, relative to std(u). If smaller, the scale is the displacement of a cell by its own pressure
/// at the largest upper bound, which φ never exceeds.
const COARSE_TOLERANCE: f64 = 1e-2;
/// Largest number of convolutions on a coarse grid.
const MAX_COARSE_CONVOLUTIONS: usize = 200;
/// Compliance for the first prediction of the sets from a given start, as a multiple of the self-influence.
const COMPLIANCE_FACTOR: f64 = 2.0;
/// Fraction of the interference of a cell that its first pressure closes at an approach, as if the cell were alone.
const FIRST_PRESSURE: f64 = 0.3;

/// Solves contacts on a device. Without a start the first guess is that of the next coarser grids.
pub(crate) fn solve<D: Device>(device: &D, problem: &Problem, watch: &dyn Watch) -> Result<Solution> {
    let Problem { contacts, grids, control, tolerance, max_convolutions, precision } = *problem;
    let starts: Option<Vec<_>> = contacts.iter().map(|contact: &Contact| contact.start).collect();
    let mut gaps = vec![device.gaps(contacts, precision)?];
    if starts.is_none() {
        for _ in 1..grids.len() {
            gaps.push(device.coarse(gaps.last().expect("the finest"))?);
        }
    }
    let mut guess: Option<D::Pressure> = None;
    let mut spent = 0.0;
    let finest: usize = contacts.iter().map(|contact| contact.gap.len()).sum();
    loop {
        let number = gaps.len() - 1;
        let level = &grids[number];
        let mut fields = device.fields(gaps.pop().expect("a grid"), level)?;
        let control = match control {
            // The load of the cells of a coarse grid is that of the cells they cover.
            Control::PressureSum(sum) => {
                let area = |level: &crate::Level| level.pitch[0] * level.pitch[1];
                Control::PressureSum(sum * area(&grids[0]) / area(level))
            }
            approach => approach,
        };
        let warm = number == 0 && starts.is_some();
        match (&starts, guess.take(), control) {
            (Some(starts), ..) if warm => fields.set_pressure(starts)?,
            (_, Some(coarse), _) => device.prolong(&coarse, &mut fields)?,
            (_, None, Control::PressureSum(sum)) => fields.set_uniform(sum / fields.cells() as f64)?,
            (_, None, Control::Approach(approach)) => {
                fields.close_alone(approach, FIRST_PRESSURE / fields.self_influence())?;
            }
        }
        let [bearable, most] = fields.upper();
        let saturation = fields.self_influence() * most;
        if number > 0 && matches!(control, Control::PressureSum(wanted) if bearable <= wanted) {
            continue;
        }
        let share = fields.cells() as f64 / finest as f64;
        let factor = if warm { COMPLIANCE_FACTOR } else { 1.0 };
        let inner = Inner(watch);
        let watch: &dyn Watch = if number == 0 { watch } else { &inner };
        let mut iteration = Iteration::new(fields, control, precision, factor, watch)?;
        if number > 0 {
            let loose = |state: &State| tolerance.max(COARSE_TOLERANCE * (saturation / state.scale).min(1.0));
            let found = iteration.solve(&loose, MAX_COARSE_CONVOLUTIONS, true);
            spent += share * iteration.convolutions as f64;
            match found {
                Ok(_) => guess = Some(device.into_pressure(iteration.fields)),
                // Without a solution on the coarse grid there is no guess.
                Err(Error::NotConverged { .. }) => {}
                Err(other) => return Err(other),
            }
            continue;
        }
        let state = iteration.solve(&|_| tolerance, max_convolutions, false)?;
        let (iterations, restarts) = (iteration.iterations, iteration.restarts);
        let convolutions = spent + iteration.convolutions as f64;
        return Ok(Solution {
            fields: iteration.fields.results()?,
            approach: state.approach,
            residual: state.eta,
            self_influence: iteration.fields.self_influence(),
            cost: Cost { iterations, convolutions, restarts },
        });
    }
}

/// Stops when another watch does, but reports nothing.
struct Inner<'a>(&'a dyn Watch);

impl Watch for Inner<'_> {
    fn iteration(&self, _: f64, _: f64) {}

    fn stop(&self) -> bool {
        self.0.stop()
    }
}
