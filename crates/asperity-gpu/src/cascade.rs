//! The cascade: a first guess of the pressure from successively coarser grids.

use asperity_base::error::{Error, Result};
use asperity_base::grid::Field;

use crate::fields::{Device, Fields};
use crate::problem::{Accuracy, Control, Cost, Level, Watch};
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
        let inner = Inner(watch);
        let watch: &dyn Watch = if number == 0 { watch } else { &inner };
        let mut iteration = Iteration::new(fields, control, precision, factor, watch)?;
        if number > 0 {
            let loose = |state: &State| tolerance.max(COARSE_TOLERANCE * (saturation / state.scale).min(1.0));
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

/// Stops when another watch does, but reports nothing.
struct Inner<'a>(&'a dyn Watch);

impl Watch for Inner<'_> {
    fn iteration(&self, _: f64, _: f64) {}

    fn stop(&self) -> bool {
        self.0.stop()
    }
}
