//! The cascade: a first guess of the pressure from successively coarser grids.

use asperity_base::error::{Error, Result};
use asperity_base::grid::Field;
use asperity_base::math::active_set::{COMPLIANCE_FACTOR, FIRST_PRESSURE, coarse_tolerance};
use asperity_base::watch::{InnerWatch, Watch};

use crate::fields::{Device, Fields};
use crate::problem::{Accuracy, Control, Cost, Level};
use crate::solver::{Iteration, State};

/// Largest number of convolutions on a coarse grid.
const MAX_COARSE_CONVOLUTIONS: usize = 200;
/// A contact to be solved: the gaps on the device, and the load or the approach.
pub(crate) struct Task<'a, G> {
    /// Gaps and upper bounds on the finest grid.
    pub(crate) gaps: G,
    /// Pressures near the solution, if they are known.
    pub(crate) starts: Option<Vec<&'a Field>>,
    pub(crate) grids: &'a [Level],
    pub(crate) control: Control,
    pub(crate) accuracy: Accuracy,
}

/// Contacts in equilibrium, whose fields are still on the device.
pub(crate) struct Solved<F> {
    pub(crate) fields: F,
    pub(crate) state: State,
    pub(crate) cost: Cost,
}

/// Solves contacts on a device. Without a start the first guess is that of the next coarser grids.
pub(crate) fn solve<D: Device>(
    device: &D,
    task: Task<D::Gaps>,
    watch: &dyn Watch,
) -> Result<Solved<D::Fields>> {
    let Task { gaps, starts, grids, control, accuracy } = task;
    let Accuracy { tolerance, max_convolutions, precision } = accuracy;
    let mut gaps = vec![gaps];
    if starts.is_none() {
        for _ in 1..grids.len() {
            gaps.push(device.coarse(gaps.last().expect("the finest"))?);
        }
    }
    let mut guess: Option<D::Pressure> = None;
    // Convolutions on the coarse grids, and their numbers of cells.
    let mut spent: Vec<[f64; 2]> = Vec::new();
    loop {
        let number = gaps.len() - 1;
        let level = &grids[number];
        let mut fields = device.fields(gaps.pop().expect("a grid"), level)?;
        let control = match control {
            // The load of the cells of a coarse grid is that of the cells they cover.
            Control::PressureSum(sum) => {
                let area = |level: &Level| level.pitch[0] * level.pitch[1];
                Control::PressureSum(sum * area(&grids[0]) / area(level))
            }
            approach => approach,
        };
        match (&starts, guess.take(), control) {
            (Some(starts), ..) => fields.set_pressure(starts)?,
            (_, Some(coarse), _) => device.prolong(&coarse, &mut fields)?,
            (_, None, Control::PressureSum(sum)) => fields.set_uniform(sum / fields.cells() as f64)?,
            (_, None, Control::Approach(approach)) => {
                fields.close_alone(approach, FIRST_PRESSURE / fields.self_influence())?;
            }
        }
        let [bearable, most] = fields.upper();
        if number > 0 && matches!(control, Control::PressureSum(wanted) if bearable <= wanted) {
            continue;
        }
        let (cells, saturation) = (fields.cells() as f64, fields.self_influence() * most);
        let factor = if starts.is_some() { COMPLIANCE_FACTOR } else { 1.0 };
        let inner = InnerWatch(watch);
        let watch: &dyn Watch = if number == 0 { watch } else { &inner };
        let mut iteration = Iteration::new(fields, control, precision, factor, watch)?;
        if number > 0 {
            let loose = |state: &State| coarse_tolerance(tolerance, saturation, state.scale);
            let found = iteration.solve(&loose, MAX_COARSE_CONVOLUTIONS, true);
            spent.push([iteration.convolutions as f64, cells]);
            match found {
                Ok(_) => guess = Some(device.pressure_of(iteration.fields)?),
                // Without a solution on the coarse grid there is no guess.
                Err(Error::NotConverged { .. }) => {}
                Err(other) => return Err(other),
            }
            continue;
        }
        let state = iteration.solve(&|_| tolerance, max_convolutions, false)?;
        let (iterations, restarts) = (iteration.iterations, iteration.restarts);
        let coarse: f64 = spent.iter().map(|[convolutions, fewer]| convolutions * fewer / cells).sum();
        let convolutions = coarse + iteration.convolutions as f64;
        return Ok(Solved {
            fields: iteration.fields,
            state,
            cost: Cost { iterations, convolutions, restarts },
        });
    }
}
