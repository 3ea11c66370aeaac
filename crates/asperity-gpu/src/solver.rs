//! The iteration: preconditioned conjugate gradients on predicted active sets.
//!
//! It is the active set of the processor's solver, of operations that a device does well: transforms,
//! operations cell by cell, and sums. The preconditioner is that of the
//! processor's solver, which has no transforms of the whole grid.

use asperity_base::error::{Error, Result, check};
use asperity_base::math::active_set::{
    CG_TOLERANCE, Caution, MAX_CG_STEPS, MAX_SCALINGS, MIN_SEARCH_STEP, TOLERANCE_REDUCTION, offset_for_sum,
    residual_scale,
};
use asperity_base::units::{Metre, Pascal};
use asperity_base::watch::{Watch, check_stop};

use crate::fields::Fields;
use crate::problem::{Control, Precision};

/// The state of an iteration that counts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct State {
    /// The residual η.
    pub(crate) eta: f64,
    /// The approach δ.
    pub(crate) approach: Metre,
    /// The scale of the residual: std(u), but at least 10⁻⁴ of the largest |u| or c₀ p.
    pub(crate) scale: Metre,
}

/// Solves one grid of contacts.
pub(crate) struct Iteration<'a, F> {
    pub(crate) fields: F,
    control: Control,
    watch: &'a dyn Watch,
    /// Relative accuracy of a sum of pressures.
    accuracy: f64,
    /// Whether t is that of the present pressure by one convolution, and the pressure is feasible.
    exact: bool,
    /// Number of free cells.
    free_cells: f64,
    caution: Caution,
    /// Number of consecutive outer steps from pressures that are all at their bounds.
    bound_steps: usize,
    pub(crate) iterations: usize,
    pub(crate) convolutions: usize,
    pub(crate) restarts: usize,
}

impl<'a, F: Fields> Iteration<'a, F> {
    /// Creates the iteration from the pressure of the fields.
    pub(crate) fn new(
        fields: F,
        control: Control,
        precision: Precision,
        compliance_factor: f64,
        watch: &'a dyn Watch,
    ) -> Result<Self> {
        let accuracy = match precision {
            Precision::Double => 1e-13,
            Precision::Single => 1e-8,
        };
        let mut this = Self {
            fields,
            control,
            watch,
            accuracy,
            exact: false,
            free_cells: 0.0,
            caution: Caution::new(compliance_factor),
            bound_steps: 0,
            iterations: 0,
            convolutions: 0,
            restarts: 0,
        };
        this.become_feasible()?;
        this.fields.keep()?;
        Ok(this)
    }

    /// Iterates until η is below the tolerance that `wanted` returns for a state. On a coarse grid the
    /// solution is only a `guess`, and need not be exact.
    pub(crate) fn solve(
        &mut self,
        wanted: &dyn Fn(&State) -> f64,
        max_convolutions: usize,
        guess: bool,
    ) -> Result<State> {
        let mut state = self.state()?;
        if let Control::PressureSum(sum) = self.control {
            // The periodic displacement of a uniform pressure is no scale for later displacements.
            let least = self.fields.self_influence() * sum / self.fields.cells() as f64;
            (state.eta, state.scale) =
                (state.eta * state.scale / state.scale.max(least), state.scale.max(least));
        }
        let mut tightening = 1.0;
        loop {
            let mut tolerance = wanted(&state);
            self.watch.iteration(state.eta, tolerance);
            check_stop(self.watch)?;
            if state.eta < tightening * tolerance || (self.exact && state.eta < tolerance) {
                // The solution is the nearest feasible pressure, and its own residual decides.
                if guess {
                    self.make_feasible()?;
                    return Ok(state);
                }
                if !self.exact {
                    self.become_feasible()?;
                    state = self.state()?;
                    tolerance = wanted(&state);
                }
                if state.eta < tolerance {
                    return Ok(state);
                }
                tightening *= TOLERANCE_REDUCTION;
            }
            // Without a displacement the residual is infinite, which is no error.
            check("residual", state.eta, !state.eta.is_nan(), FINITE)?;
            if self.convolutions >= max_convolutions {
                let (iterations, residual) = (self.iterations, state.eta);
                return Err(Error::NotConverged { iterations, residual, tolerance });
            }
            state = self.outer_step(state, tightening * tolerance)?;
        }
    }

    /// Returns the residual at the prescribed approach, or at the multiplier of the load.
    fn state(&mut self) -> Result<State> {
        let approach = match self.control {
            Control::Approach(approach) => approach,
            Control::PressureSum(_) => {
                let [weight, moment, capped] = self.fields.multiplier()?;
                if weight > 0.0 { moment / weight } else { capped }
            }
        };
        let [sum, squares, largest, pressure, displacement] = self.fields.residual(approach)?;
        let cells = self.fields.cells() as f64;
        let deviation = (squares / cells - (sum / cells).powi(2)).max(0.0).sqrt();
        let scale = residual_scale(deviation, displacement.max(self.fields.self_influence() * pressure));
        // NaN stays NaN.
        let eta =
            if largest == 0.0 && sum.is_finite() { 0.0 } else { largest / (scale + 0.0 * (sum + squares)) };
        Ok(State { eta, approach, scale })
    }

    /// Brings the pressures into their bounds and, under a load, to their sum.
    fn make_feasible(&mut self) -> Result<()> {
        let [mut sum, mut below] = self.fields.scale_below(1.0)?;
        let Control::PressureSum(wanted) = self.control else { return Ok(()) };
        for _ in 0..MAX_SCALINGS {
            if (sum - wanted).abs() <= self.accuracy * wanted {
                return Ok(());
            }
            if below <= 0.0 || below <= 0.5 * (sum - wanted) {
                break;
            }
            let before = sum;
            [sum, below] = self.fields.scale_below(1.0 + (wanted - sum) / below)?;
            if sum == before {
                break;
            }
        }
        if (sum - wanted).abs() <= 1e2 * self.accuracy * wanted {
            return Ok(());
        }
        let range = self.fields.propose(0.0, 0.0)?;
        let offset = self.offset(range, wanted)?;
        self.fields.accept(offset)
    }

    /// Moves to the nearest feasible pressure, with one convolution in the precision of the pressure.
    fn become_feasible(&mut self) -> Result<()> {
        self.make_feasible()?;
        self.fields.convolve()?;
        self.convolutions += 1;
        self.exact = true;
        Ok(())
    }

    /// Returns the offset with which the proposed pressures, between the two of `range`, have this sum after
    /// clipping.
    fn offset(&mut self, [min, max]: [Pascal; 2], wanted: Pascal) -> Result<Pascal> {
        let [_, upper] = self.fields.upper();
        let each = if upper.is_finite() { upper.max(wanted / self.fields.cells() as f64) } else { wanted };
        let accuracy = self.accuracy * wanted;
        offset_for_sum([-max, each - min], wanted, accuracy, |offset| self.fields.proposed_sum(offset))
    }

    /// Returns the mean over the free cells of values with this sum under a load, along which the load does
    /// not change; 0 at an approach.
    fn mean(&self, sum: f64) -> f64 {
        match self.control {
            Control::PressureSum(_) => sum / self.free_cells,
            Control::Approach(_) => 0.0,
        }
    }

    /// Performs an outer step: predicts the sets, moves the other cells to their bounds, and solves for the
    /// free cells by conjugate gradients.
    fn outer_step(&mut self, state: State, wanted: f64) -> Result<State> {
        let stiffness = 1.0 / (self.caution.compliance_factor * self.fields.self_influence());
        let range = self.fields.propose(state.approach, stiffness)?;
        let offset = match self.control {
            Control::PressureSum(wanted) => self.offset(range, wanted)?,
            Control::Approach(_) => 0.0,
        };
        let [free, moving, moved, borne] = self.fields.predict_sets(offset)?;
        self.free_cells = free;
        if free == 0.0 {
            self.become_feasible()?;
            self.step_from_bounds(state.approach)?;
            return self.state();
        }
        self.bound_steps = 0;
        self.exact = false;
        if moving > 0.0 {
            // The load does not change: the free cells take the difference in proportion to their pressures.
            let [each, per_pressure] = match self.control {
                Control::Approach(_) => [0.0, 0.0],
                Control::PressureSum(_) if borne > 0.0 => [0.0, moved / borne],
                Control::PressureSum(_) => [moved / free, 0.0],
            };
            self.fields.move_to_bounds(each, per_pressure)?;
            self.convolutions += 1;
        }
        let left = self.conjugate_gradients(state, wanted)?;
        if let Control::PressureSum(wanted) = self.control {
            let sum = self.fields.pressure_sum()?;
            self.fields.add_to_free((wanted - sum) / free)?;
        }
        let searched = self.safeguard(left.residual.hypot(left.violation), state.approach)?;
        if !searched && left.largest > wanted * state.scale {
            // The residual of the free cells alone is too large: that of all cells is not needed.
            return Ok(State { eta: left.largest / state.scale, approach: left.datum, ..state });
        }
        self.state()
    }

    /// Performs conjugate gradients on the free cells until the violation of the bounds exceeds the residual.
    fn conjugate_gradients(&mut self, state: State, wanted: f64) -> Result<Left> {
        self.fields.adapt(self.free_cells)?;
        let sum = self.fields.reset_direction()?;
        let mut datum = match self.control {
            Control::Approach(approach) => approach,
            Control::PressureSum(_) => self.mean(sum),
        };
        let mut left = self.advance(0.0, datum)?;
        let mut product_before = f64::INFINITY;
        for _ in 0..MAX_CG_STEPS {
            if self.watch.stop() {
                break;
            }
            let [sum, drift, product] = self.fields.precondition(datum)?;
            let mean = self.mean(sum);
            let product = product - mean * drift;
            let beta = product / product_before;
            product_before = product;
            let [curvature, sum] = self.fields.respond(mean, beta)?;
            self.convolutions += 1;
            if !(curvature > 0.0 && product > 0.0) {
                break;
            }
            let step = product / curvature;
            datum += step * self.mean(sum);
            left = self.advance(step, datum)?;
            self.iterations += 1;
            if left.residual <= self.caution.cg_exit * left.violation
                || left.largest < CG_TOLERANCE * wanted * state.scale
            {
                break;
            }
        }
        Ok(left)
    }

    fn advance(&mut self, step: f64, datum: Metre) -> Result<Left> {
        let [residual, violation, largest] = self.fields.advance(step, datum)?;
        Ok(Left { residual: residual.sqrt(), violation: violation.sqrt(), largest, datum })
    }

    /// Safeguards the iteration against cycles of the predicted sets. After some outer steps without progress
    /// it returns to a feasible pressure, from which an exact line search lowers the energy. Returns whether
    /// it did so.
    fn safeguard(&mut self, norm: f64, approach: Metre) -> Result<bool> {
        if !self.caution.demands_a_search(norm) {
            return Ok(false);
        }
        self.become_feasible()?;
        if self.search(approach)? <= MIN_SEARCH_STEP {
            // If this makes no progress, it searches along the gap of the last feasible pressure, which is
            // now the present one.
            let datum = self.state()?.approach;
            self.step_along_gap(datum)?;
            self.search(approach)?;
        }
        self.caution.after_search();
        self.restarts += 1;
        Ok(true)
    }

    /// Handles pressures that are all at their bounds without equilibrium. One step along the gap frees some
    /// cells. If it only moves cells to the other bound, a line search limits the step.
    fn step_from_bounds(&mut self, approach: Metre) -> Result<()> {
        self.bound_steps += 1;
        if self.bound_steps == 1 {
            return self.step_along_gap(approach);
        }
        self.fields.keep()?;
        self.step_along_gap(approach)?;
        self.search(approach)?;
        Ok(())
    }

    /// Performs one step along the gap of each cell, to a feasible pressure.
    fn step_along_gap(&mut self, approach: Metre) -> Result<()> {
        self.fields.step_along_gap(approach, 2.0 * self.fields.self_influence())?;
        self.become_feasible()
    }

    /// Moves to the pressure with the least energy between the last feasible pressure and the present one,
    /// and keeps it as the last feasible one. Returns the fraction of the way.
    fn search(&mut self, approach: Metre) -> Result<f64> {
        self.fields.convolve_kept()?;
        self.convolutions += 1;
        let datum = match self.control {
            Control::PressureSum(_) => 0.0,
            Control::Approach(_) => approach,
        };
        let [slope, curvature] = self.fields.descent(datum)?;
        // Without curvature, as of a uniform periodic pressure, the energy falls all the way.
        let share = if slope > 0.0 { (slope / curvature.max(0.0)).min(1.0) } else { 0.0 };
        self.fields.step_from_kept(share)?;
        self.fields.keep()?;
        Ok(share)
    }
}

/// Residual and violations after conjugate gradients on a set of free cells, as displacements.
struct Left {
    /// Norm of the residual at the free cells.
    residual: f64,
    /// Norm of the violations of the bounds.
    violation: f64,
    /// Largest residual at the free cells.
    largest: f64,
    /// The approach of these.
    datum: Metre,
}

/// The expectation of each result.
pub(crate) const FINITE: &str = "a number in double precision: check the units of moduli, heights and load";
