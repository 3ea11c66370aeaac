//! Contact of bodies that slide steadily over each other.

use crate::error::{Error, Result, check_in};
use crate::grid::{Field, in_rows};
use crate::math::gmres;
use crate::solver::{Bounds, Control, Params, Residual, Solution, Stats, Watch, residual};
use crate::units::{Dimension, Newton};
use crate::viscoelastic::operator::{self, SteadySliding};
use asperity_base::math::active_set::offset_for_sum;

/// Residual below which the predicted sets are nearly right: all cells on the wrong side change sides, or one
/// alone.
const NEAR: f64 = 3e-2;
/// Rounds in which the number of cells on the wrong side need not fall.
const PATIENCE: usize = 4;
/// Rounds without progress after which cells change sides one by one wherever the solution is.
const MAX_STALLED: usize = 12;
/// Residual of a contact on a coarse grid, which is a start on the next one.
const COARSE_TOLERANCE: f64 = 1e-3;
/// Most rounds.
const MAX_ROUNDS: usize = 400;
/// Most products of a round.
const MAX_PRODUCTS: usize = 60;
/// Least and largest reduction of the residual in a round.
const REDUCTION: [f64; 2] = [1e-8, 0.1];

/// A contact that slides steadily.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct SteadyContact {
    /// The contact. Its displacement is that of the moving frame.
    pub solution: Solution,
    /// The force with which the bodies resist the motion, ≥ 0 but for rounding; 0 for elastic bodies.
    pub drag: Newton,
}

/// Solves the contact of bodies over an undeformed gap h that slide steadily: p ≥ 0, g = h + Cp − δ ≥ 0, and
/// p = 0 where g > 0. `start` is a pressure near the solution, such as that at a neighbouring speed.
///
/// Newton's method on predicted sets: the gap of the cells in contact is closed by the generalised method of
/// minimal residuals, preconditioned by the inverse of the harmonics; under a load the multiplier is
/// eliminated. Far from the solution all cells are predicted from pressure and gap. Near it the cells on the
/// wrong side change sides, and once their number has not fallen in some rounds, the last one alone, which
/// ends for every matrix of positive principal minors (Júdice and Pires, Comput. Oper. Res. 21, 587 (1994)).
///
/// # Errors
/// [`Error::OutOfRange`] for a load or an approach that is not finite, [`Error::PeriodicFullContact`],
/// [`Error::NotConverged`], [`Error::Interrupted`].
///
/// # Panics
/// If a field has another shape than the operator's grid.
pub fn solve_steady(
    operator: &mut SteadySliding,
    initial_gap: &Field,
    control: Control,
    start: Option<&Field>,
    params: &Params,
    watch: &dyn Watch,
) -> Result<SteadyContact> {
    let grid = *operator.grid();
    assert_eq!(initial_gap.shape(), grid.shape, "shape of the gap");
    match control {
        Control::Load(load) => {
            let is_valid = load > 0.0 && load.is_finite();
            check_in(Dimension::Force, "load", load, is_valid, "a finite load above 0")?;
        }
        Control::Approach(approach) => {
            let is_valid = approach.is_finite();
            check_in(Dimension::Length, "approach", approach, is_valid, "a finite length")?;
            // No pressure displaces the mean of a periodic surface.
            let mean_gap = initial_gap.mean().unwrap_or(0.0);
            if operator.boundary().leaves_mean_free() && approach >= mean_gap {
                return Err(Error::PeriodicFullContact { approach, mean_gap });
            }
        }
    }
    let before = operator.convolutions();
    let (initial_gap, start) = (&*in_rows(initial_gap), start.map(in_rows));
    let found = contact(&mut operator.response, initial_gap, control, start.as_deref(), params, watch)?;
    let drag = operator.drag(&found.pressure);
    let convolutions = found.convolutions + operator.convolutions() - before;
    let solution = Solution {
        grid,
        initial_gap: initial_gap.clone(),
        bounds: Bounds::ELASTIC,
        pressure: found.pressure,
        displacement: found.displacement,
        approach: found.residual.approach,
        residual: found.residual.eta,
        stats: Stats { iterations: found.iterations, convolutions, ..Stats::default() },
    };
    Ok(SteadyContact { solution, drag })
}

/// A contact on one of the grids.
struct Found {
    pressure: Field,
    displacement: Field,
    residual: Residual,
    iterations: usize,
    /// Convolutions on coarser grids, in those of this one.
    convolutions: f64,
}

fn contact(
    response: &mut operator::Response,
    gap: &Field,
    control: Control,
    start: Option<&Field>,
    params: &Params,
    watch: &dyn Watch,
) -> Result<Found> {
    let mut rounds = Rounds::new(response, gap, control, start);
    let convolutions = rounds.guess(params, watch)?;
    rounds.solve(params, watch)?;
    let residual = rounds.finish();
    let Rounds { pressure, displacement, done: iterations, .. } = rounds;
    if residual.eta > params.tolerance {
        let (residual, tolerance) = (residual.eta, params.tolerance);
        return Err(Error::NotConverged { iterations, residual, tolerance });
    }
    Ok(Found { pressure, displacement, residual, iterations, convolutions })
}

/// The present pressure and displacement, and the rounds so far.
struct Rounds<'a> {
    operator: &'a mut operator::Response,
    gap: &'a Field,
    control: Control,
    pressure: Field,
    displacement: Field,
    done: usize,
    /// A field for convolutions, and its image.
    scratch: [Field; 2],
}

/// Cells that are predicted to touch, and the rules by which they change.
struct Sets {
    touching: Vec<bool>,
    /// Fewest cells on the wrong side so far, and rounds in which it need not fall.
    fewest: usize,
    left: usize,
}

impl<'a> Rounds<'a> {
    fn new(
        operator: &'a mut operator::Response,
        gap: &'a Field,
        control: Control,
        start: Option<&Field>,
    ) -> Self {
        let zeros = || Field::zeros(gap.raw_dim());
        let scratch = [zeros(), zeros()];
        let (pressure, displacement) = (zeros(), zeros());
        let mut this = Self { operator, gap, control, pressure, displacement, done: 0, scratch };
        match (start, this.sum()) {
            (Some(start), _) => this.pressure.assign(start),
            (None, Some(sum)) => this.pressure.fill(sum / gap.len() as f64),
            (None, None) => {}
        }
        this.rescale();
        this.displace();
        this
    }

    /// Far from the solution, starts from that on a grid of twice the pitch, if it is found. Returns what it cost in
    /// convolutions of this grid.
    fn guess(&mut self, params: &Params, watch: &dyn Watch) -> Result<f64> {
        if self.residual().eta <= NEAR {
            return Ok(0.0);
        }
        let Some(mut coarse) = self.operator.coarse() else { return Ok(0.0) };
        let halved = |field: &Field| {
            let means = field.exact_chunks((2, 2)).into_iter().map(|cells| 0.25 * cells.sum());
            Field::from_shape_vec(coarse.grid.shape, means.collect()).expect("four cells in each")
        };
        let (gap, start) = (halved(self.gap), halved(&self.pressure));
        let params = params.with_tolerance(params.tolerance.max(COARSE_TOLERANCE));
        match contact(&mut coarse, &gap, self.control, Some(&start), &params, watch) {
            Ok(Found { pressure, convolutions, .. }) => {
                let cells = self.pressure.indexed_iter_mut();
                cells.for_each(|((i, j), p)| *p = pressure[(i / 2, j / 2)]);
                self.rescale();
                self.displace();
                Ok(0.25 * (convolutions + coarse.convolutions))
            }
            Err(Error::Interrupted) => Err(Error::Interrupted),
            Err(_) => Ok(0.0),
        }
    }

    /// Returns Σ p under a load.
    fn sum(&self) -> Option<f64> {
        match self.control {
            Control::Load(load) => Some(load / self.operator.grid.cell_area()),
            Control::Approach(_) => None,
        }
    }

    /// Scales the pressure to the load.
    fn rescale(&mut self) {
        let now = self.pressure.sum();
        if let Some(sum) = self.sum().filter(|_| now > 0.0) {
            self.pressure *= sum / now;
        }
    }

    /// Computes the displacement of the present pressure.
    fn displace(&mut self) {
        self.operator.displace(&self.pressure, &mut self.displacement);
    }

    fn residual(&self) -> Residual {
        let approach = match self.control {
            Control::Approach(approach) => Some(approach),
            Control::Load(_) => None,
        };
        let c0 = self.operator.self_influence;
        residual(&self.pressure, &self.displacement, self.gap, &Bounds::ELASTIC, c0, approach)
    }

    /// Goes on until the residual is below the tolerance, or until no more can be done.
    fn solve(&mut self, params: &Params, watch: &dyn Watch) -> Result<()> {
        let mut sets: Option<Sets> = None;
        let (mut caution, mut best, mut stalled) = (1.0f64, f64::INFINITY, 0);
        while self.done < MAX_ROUNDS {
            if watch.stop() {
                return Err(Error::Interrupted);
            }
            let residual = self.residual();
            watch.iteration(residual.eta, params.tolerance);
            // The last pressure is clipped and has its displacement computed anew, which costs a little.
            if residual.eta < 0.5 * params.tolerance {
                break;
            }
            match &mut sets {
                Some(sets) if residual.eta <= NEAR || stalled > MAX_STALLED => {
                    self.correct(sets, residual.approach);
                }
                _ => {
                    if residual.eta < 0.7 * best {
                        (best, caution, stalled) = (residual.eta, (0.5 * caution).max(1.0), 0);
                    } else if best.is_finite() {
                        (caution, stalled) = (2.0 * caution, stalled + 1);
                    }
                    let touching = self.predict(caution, residual.approach);
                    let (fewest, left) = sets.map_or((usize::MAX, PATIENCE), |sets| (sets.fewest, sets.left));
                    sets = Some(Sets { touching, fewest, left });
                }
            }
            let touching = &sets.as_ref().expect("the sets just made").touching;
            if !touching.contains(&true) {
                break;
            }
            self.close(touching, &residual, params.tolerance, stalled > MAX_STALLED);
            self.done += 1;
        }
        Ok(())
    }

    /// Returns the pressures that close the gap if each cell gives way by itself, with this `compliance`.
    fn closing(&self, compliance: f64, approach: f64) -> impl Iterator<Item = f64> {
        let cells = self.pressure.iter().zip(self.gap).zip(&self.displacement);
        cells.map(move |((p, h), u)| p + (approach - h - u) / compliance)
    }

    /// Predicts which cells touch: those whose pressure stays above 0 when they close the gap, at the
    /// approach at which they bear the load.
    fn predict(&self, caution: f64, approach: f64) -> Vec<bool> {
        let predicted: Vec<f64> = self.closing(caution * self.operator.self_influence, approach).collect();
        let offset = self.sum().map_or(0.0, |sum| {
            let most = predicted.iter().fold(sum, |most, p| most.max(p.abs() + sum));
            let sums = |offset: f64| {
                let above = predicted.iter().map(|p| p + offset).filter(|p| *p > 0.0);
                Ok::<_, Error>(above.fold([0.0, 0.0], |[sum, count], p| [sum + p, count + 1.0]))
            };
            offset_for_sum([-most, most], sum, 1e-14 * sum, sums).unwrap_or(0.0)
        });
        predicted.iter().map(|p| p + offset > 0.0).collect()
    }

    /// Lets cells on the wrong side change sides.
    fn correct(&self, sets: &mut Sets, approach: f64) {
        let touches = self.closing(self.operator.self_influence, approach).map(|p| p > 0.0);
        let wrong = touches.zip(&sets.touching).enumerate().filter(|(_, (now, then))| now != *then);
        let wrong: Vec<usize> = wrong.map(|(cell, _)| cell).collect();
        let Some(last) = wrong.last() else { return };
        let mut changed = &wrong[..];
        if wrong.len() < sets.fewest {
            (sets.fewest, sets.left) = (wrong.len(), PATIENCE);
        } else if sets.left > 0 {
            sets.left -= 1;
        } else {
            changed = std::slice::from_ref(last);
        }
        changed.iter().for_each(|cell| sets.touching[*cell] = !sets.touching[*cell]);
    }

    /// Closes the gap of the cells that touch, under the load, roughly far from the solution unless
    /// `is_exact`.
    fn close(&mut self, touching: &[bool], residual: &Residual, tolerance: f64, is_exact: bool) {
        let cells: Vec<usize> = (0..touching.len()).filter(|cell| touching[*cell]).collect();
        let count = cells.len() as f64;
        self.lift(touching, count);
        let (h, u) = (flat(self.gap), flat(&self.displacement));
        let approach = match self.control {
            Control::Approach(approach) => approach,
            Control::Load(_) => cells.iter().map(|cell| h[*cell] + u[*cell]).sum::<f64>() / count,
        };
        let right: Vec<f64> = cells.iter().map(|cell| approach - h[*cell] - u[*cell]).collect();
        let largest = right.iter().fold(0.0f64, |most, r| most.max(r.abs()));
        if largest == 0.0 {
            return;
        }
        let wanted = if residual.eta > NEAR && !is_exact { 0.1 } else { 1e-2 * residual.eta.min(NEAR) };
        let reduction =
            (wanted.max(0.3 * tolerance) * residual.scale / largest).clamp(REDUCTION[0], REDUCTION[1]);
        let under_load = self.sum().is_some();
        let mut response = OnCells::of(self.operator, &cells, &mut self.scratch, under_load);
        let product = |x: &[f64]| {
            let z = response.precondition(x);
            let mut y = response.displace(&z);
            if under_load {
                let mean = y.iter().sum::<f64>() / count;
                y.iter_mut().for_each(|y| *y -= mean);
            }
            y
        };
        let found = gmres(product, right, reduction, MAX_PRODUCTS);
        let z = response.precondition(&found.solution);
        response.displace(&z);
        self.add();
    }

    /// Takes the pressure off the cells that do not touch; those that touch bear it.
    fn lift(&mut self, touching: &[bool], count: f64) {
        let sum = self.sum();
        let Self { pressure, scratch: [change, _], .. } = self;
        let mut lifted = 0.0;
        let changes = change.iter_mut().zip(pressure.iter()).zip(touching);
        changes.for_each(|((change, p), touches)| {
            *change = if *touches { 0.0 } else { -p };
            lifted += *change;
        });
        if let Some(sum) = sum {
            let each = (sum - pressure.sum() - lifted) / count;
            change
                .iter_mut()
                .zip(touching)
                .filter(|(_, touches)| **touches)
                .for_each(|(change, _)| *change = each);
        }
        let most = pressure.iter().fold(0.0f64, |most, p| most.max(p.abs()));
        if change.iter().any(|change| change.abs() > 1e-14 * most) {
            let Self { operator, scratch: [change, image], .. } = self;
            operator.displace(change, image);
            self.add();
        }
    }

    /// Adds the pressure and the displacement of the scratch fields.
    fn add(&mut self) {
        self.pressure += &self.scratch[0];
        self.displacement += &self.scratch[1];
    }

    /// Clips the pressure to its bound, and returns the residual of its displacement, computed anew.
    fn finish(&mut self) -> Residual {
        self.pressure.mapv_inplace(|p| p.max(0.0));
        self.rescale();
        self.displace();
        self.residual()
    }
}

/// Response of the bodies to pressures on some cells alone.
struct OnCells<'a> {
    operator: &'a mut operator::Response,
    cells: &'a [usize],
    /// The last field that was convolved, and its image.
    fields: &'a mut [Field; 2],
    /// Under a load the preconditioned unit displacement, and its sum.
    one: Option<(Vec<f64>, f64)>,
}

impl<'a> OnCells<'a> {
    fn of(
        operator: &'a mut operator::Response,
        cells: &'a [usize],
        fields: &'a mut [Field; 2],
        under_load: bool,
    ) -> Self {
        let mut this = Self { operator, cells, fields, one: None };
        this.one = under_load.then(|| {
            let one = this.precondition(&vec![1.0; cells.len()]);
            let sum = one.iter().sum();
            (one, sum)
        });
        this
    }

    /// Returns the displacement under a pressure.
    fn displace(&mut self, pressure: &[f64]) -> Vec<f64> {
        self.image(pressure, operator::Response::displace)
    }

    /// Returns an approximate pressure under a displacement; one that bears nothing in sum, where the load is
    /// given.
    fn precondition(&mut self, displacement: &[f64]) -> Vec<f64> {
        let mut pressure = self.image(displacement, operator::Response::precondition);
        if let Some((one, sum)) = &self.one {
            let share = pressure.iter().sum::<f64>() / sum;
            pressure.iter_mut().zip(one).for_each(|(p, one)| *p -= share * one);
        }
        pressure
    }

    fn image(
        &mut self,
        values: &[f64],
        convolve: fn(&mut operator::Response, &Field, &mut Field),
    ) -> Vec<f64> {
        let Self { operator, cells, fields: [field, image], .. } = self;
        field.fill(0.0);
        let all = field.as_slice_mut().expect("standard layout");
        cells.iter().zip(values).for_each(|(cell, value)| all[*cell] = *value);
        convolve(operator, field, image);
        let all = flat(image);
        cells.iter().map(|cell| all[*cell]).collect()
    }
}

fn flat(field: &Field) -> &[f64] {
    field.as_slice().expect("standard layout")
}
