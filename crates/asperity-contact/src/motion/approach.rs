//! Search for the approach of a pass with the prescribed mean load.

use crate::error::{Error, LoadLimit, Result};
use crate::motion::warm_start::Guess;
use crate::units::{Metre, Newton};

/// Largest residual η of a rough solution of the positions of a trial.
pub(super) const MAX_RESIDUAL: f64 = 0.03;
/// Number of approaches tried before the search gives up.
const MAX_TRIALS: usize = 100;

/// Largest relative error of the load, in residuals η of its positions, accepted from an exhausted bracket.
/// The load is uncertain by a part of η itself.
const MAX_LOAD_ERROR: f64 = 100.0;

/// Width of an exhausted bracket, in roundings of its approaches: it contains no further approaches to try.
const BRACKET_ROUNDING: f64 = 4.0;
/// Relative uncertainty of the load, as a fraction of the residual η. The sign of a smaller load error is
/// unknown.
const UNCERTAINTY: f64 = 0.1;
/// Number of trials at the required residual whose load error is within the uncertainty but not within the
/// tolerance. After these, the next such trial is accepted: the sign of their error is unknown, and no
/// bracket closes.
const MAX_UNCERTAIN_TRIALS: usize = 8;
/// Number of successive trials that do not halve the least error of the load, after which the bracket is
/// bisected: the secant then crosses a jump.
const MAX_STALLED_TRIALS: usize = 3;
/// Relative change of the load between two trials below which their slope is noise, as a multiple of the larger
/// of their residuals.
const SLOPE_UNCERTAINTY: f64 = 0.02;
/// Residual of a rough trial, as a fraction of the load error of the trial before. The contacts of that trial may
/// already meet a larger residual. They would then be returned unchanged, with a wrong load.
const TRIAL_PROGRESS: f64 = 0.1;
/// Relative error of the slope of a guess.
const GUESS_SLOPE_ERROR: f64 = 0.015;
/// Relative error of the slope between two trials, as a multiple of the load error of the first one.
const SECANT_ERROR: f64 = 4.0;

/// A search for the approach with a given mean load.
pub(super) struct Search {
    /// The required mean load.
    pub(super) load: Newton,
    /// Relative tolerance on the load.
    pub(super) tolerance: f64,
    /// Residual η of the accepted solution.
    pub(super) residual: f64,
    /// Largest residual η to which the positions of a trial are solved.
    pub(super) roughest: f64,
    /// Approach of first touch; the load is 0 below it.
    pub(super) touch: Metre,
    /// Resolution of approaches: the rounding of the heights.
    pub(super) resolution: Metre,
    /// Approach at which the load stops growing or becomes undetermined.
    pub(super) limit: Limit,
}

/// The largest approach that is tried.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limit {
    /// The approach; infinite if there is no limit.
    pub(super) approach: Metre,
    /// The reason for the limit.
    pub(super) cause: LoadLimit,
}

/// The accepted trial of a search.
pub(super) struct AcceptedTrial<T> {
    /// The outcome of the trial.
    pub(super) outcome: T,
    /// The approach and the slope there, as the initial guess of the next search.
    pub(super) guess: Guess,
    /// Approaches tried.
    pub(super) trials: usize,
}

impl Search {
    /// Tries approaches by a bracketed secant iteration on ln W(δ).
    ///
    /// `trial(δ, η)` returns the mean load at an approach, from positions solved to the residual η. Far from
    /// the load a rough solution is enough to find the next approach. A trial that is expected to meet the
    /// load is solved to the required residual.
    pub(super) fn run<T>(
        &self,
        first: Guess,
        mut trial: impl FnMut(Metre, f64) -> Result<(Newton, T)>,
    ) -> Result<AcceptedTrial<T>> {
        let Guess { mut approach, mut slope, .. } = first;
        approach = approach.min(self.limit.approach);
        let mut residual = self.residual_for(first.error, first.error);
        let (mut slope_error, mut first_error) = (GUESS_SLOPE_ERROR, None);
        let (mut was_rough, mut rough_misled) = (false, false);
        let mut bracket = Bracket::beyond(self.touch);
        let mut before: Option<(Metre, f64, f64)> = None;
        let (mut below, mut uncertain) = (0.0f64, 0);
        let (mut least_excess, mut stalled) = (f64::INFINITY, 0);
        for trials in 1..=MAX_TRIALS {
            let (load, outcome) = trial(approach, residual)?;
            let excess = load / self.load - 1.0;
            let error = *first_error.get_or_insert(excess.abs());
            if excess < 0.0 {
                below = below.max(load);
            }
            let at_limit = approach >= self.limit.approach && excess < 0.0;
            let is_rough = residual > self.residual;
            if std::mem::replace(&mut was_rough, is_rough) != is_rough {
                (least_excess, stalled) = (f64::INFINITY, 0);
                if !is_rough && excess.abs() > self.roughest {
                    // The rough solutions before this one were wrong about its load, so no further rough
                    // solutions are used.
                    (rough_misled, before, below) = (true, None, 0.0);
                    (bracket, slope) = (Bracket::beyond(self.touch), first.slope);
                }
            }
            let tells_no_side = excess.abs() <= UNCERTAINTY * residual;
            if !tells_no_side && excess.abs() > self.tolerance {
                let refuted = bracket.narrow(BracketEnd { approach, residual }, excess < 0.0);
                if refuted {
                    // A rougher solution was on the wrong side of the load, so no further rough solutions are
                    // used.
                    (rough_misled, slope, least_excess) = (true, first.slope, f64::INFINITY);
                }
            }
            let exhausted = bracket.is_exhausted(self.resolution);
            uncertain += usize::from(tells_no_side && !is_rough);
            let as_near_as_it_gets = tells_no_side && uncertain > MAX_UNCERTAIN_TRIALS;
            if excess.abs() <= self.tolerance || exhausted || at_limit || as_near_as_it_gets {
                if is_rough {
                    residual = self.residual;
                    continue;
                }
                if at_limit && -excess > self.tolerance {
                    let Limit { approach, cause } = self.limit;
                    return Err(Error::BeyondPass { load: self.load, most: load, approach, cause });
                }
                if excess.abs() > self.tolerance.max(MAX_LOAD_ERROR * self.residual) {
                    if let Some(bound) = bracket.bound_rougher_than(self.residual) {
                        approach = bound.approach;
                        continue;
                    }
                    return Err(Error::LoadNotReached { load: self.load, below, trials, approach });
                }
                // The slope of a jump, on which a bracket closes, is useless.
                let (approach, slope) = if exhausted || at_limit {
                    (approach, first.slope)
                } else {
                    (approach - (load / self.load).ln() / slope, slope)
                };
                let guess = Guess { error, ..Guess::new(approach, slope) };
                return Ok(AcceptedTrial { outcome, guess, trials });
            }
            let logarithm = (load / self.load).ln();
            if let Some((other, value, roughness)) = before {
                let change = logarithm - value;
                let secant = change / (approach - other);
                // The slope of a change within the uncertainty is noise.
                let uncertainty = SLOPE_UNCERTAINTY * f64::max(residual, roughness);
                if secant.is_finite() && secant > 0.0 && change.abs() > uncertainty {
                    (slope, slope_error) = (secant, SECANT_ERROR * value.abs());
                }
            }
            if logarithm.is_finite() {
                before = Some((approach, logarithm, residual));
            }
            stalled = if excess.abs() < 0.5 * least_excess { 0 } else { stalled + 1 };
            least_excess = least_excess.min(excess.abs());
            let rough = self.residual_for(TRIAL_PROGRESS * excess.abs(), slope_error * excess.abs());
            let wanted = if rough_misled { self.residual } else { rough };
            let newton = approach - logarithm / slope;
            (approach, residual) = match bracket.bound_passed(newton) {
                None if stalled < MAX_STALLED_TRIALS || bracket.middle().is_none() => (newton, wanted),
                // A rougher trial than this one may have set the bound on the wrong side of the load.
                Some(bound) if bound.residual > residual => (bound.approach, wanted.min(residual)),
                _ => (bracket.middle().unwrap_or(approach + 1.0 / slope), wanted),
            };
            approach = approach.min(self.limit.approach);
        }
        Err(Error::LoadNotReached { load: self.load, below, trials: MAX_TRIALS, approach })
    }

    /// Returns the residual for a trial: the required one if the `expected` error of its load is within the
    /// tolerance, otherwise a `rough` one within limits.
    ///
    /// The mean load is about a thousand times more accurate than the residual. A trial that is expected to
    /// be within the tolerance is treated as the last.
    fn residual_for(&self, rough: f64, expected: f64) -> f64 {
        if expected <= self.tolerance {
            return self.residual;
        }
        rough.clamp(self.residual, self.roughest.max(self.residual))
    }
}

/// The approaches between which the load is met, according to the trials.
struct Bracket {
    touch: BracketEnd,
    low: BracketEnd,
    high: BracketEnd,
}

/// An end of a bracket.
#[derive(Clone, Copy)]
struct BracketEnd {
    approach: Metre,
    /// The residual η of the trial that set the bound; 0 if it needed none.
    residual: f64,
}

impl Bracket {
    const OPEN: BracketEnd = BracketEnd { approach: f64::INFINITY, residual: 0.0 };

    /// Creates the bracket of all approaches beyond first touch.
    fn beyond(touch: Metre) -> Self {
        let touch = BracketEnd { approach: touch, residual: 0.0 };
        Self { touch, low: touch, high: Self::OPEN }
    }

    /// Uses a trial as a bound, `below` the required load or above it. Returns whether the trial refutes a
    /// bound that a rougher trial has set.
    fn narrow(&mut self, bound: BracketEnd, below: bool) -> bool {
        let refuted;
        if below {
            refuted = bound.approach >= self.high.approach;
            *self = Self { low: bound, high: if refuted { Self::OPEN } else { self.high }, ..*self };
        } else {
            refuted = bound.approach <= self.low.approach;
            *self = Self { low: if refuted { self.touch } else { self.low }, high: bound, ..*self };
        }
        refuted
    }

    /// Returns the bound at or beyond which an approach lies; the upper one for NaN.
    fn bound_passed(&self, approach: Metre) -> Option<BracketEnd> {
        if approach <= self.low.approach {
            Some(self.low)
        } else if approach < self.high.approach {
            None
        } else {
            Some(self.high)
        }
    }

    /// Returns the approach half-way between two bounds.
    fn middle(&self) -> Option<Metre> {
        let middle = 0.5 * (self.low.approach + self.high.approach);
        middle.is_finite().then_some(middle)
    }

    /// Returns a bound set by a trial at a residual above this.
    fn bound_rougher_than(&self, residual: f64) -> Option<BracketEnd> {
        [self.low, self.high].into_iter().find(|bound| bound.residual > residual)
    }

    /// Whether no approaches are left to try within the `resolution`.
    fn is_exhausted(&self, resolution: Metre) -> bool {
        let [low, high] = [self.low.approach, self.high.approach];
        let rounding = resolution.max(f64::EPSILON * low.abs().max(high.abs()));
        high.is_finite() && high - low <= BRACKET_ROUNDING * rounding
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn search(tolerance: f64) -> Search {
        limited(tolerance, f64::INFINITY)
    }

    fn limited(tolerance: f64, approach: f64) -> Search {
        let limit = Limit { approach, cause: LoadLimit::Yielded };
        Search {
            load: 2.0,
            tolerance,
            residual: 1e-6,
            roughest: MAX_RESIDUAL,
            touch: 0.0,
            resolution: 0.0,
            limit,
        }
    }

    #[test]
    fn it_finds_the_load_of_a_hertzian_curve_in_a_few_trials() {
        let found = search(1e-12).run(Guess::new(0.3, 2.0), |delta, eta| Ok((delta.powf(1.5), eta))).unwrap();
        assert!((found.guess.approach - 2f64.powf(2.0 / 3.0)).abs() < 1e-11);
        assert_eq!(found.outcome, 1e-6, "the last trial is solved to the wanted residual");
        assert!(found.trials <= 10, "{} trials", found.trials);
    }

    #[test]
    fn it_finds_its_way_from_no_contact_and_over_a_kink() {
        let curve = |delta: f64| (delta - 1.0).max(0.0) + 20.0 * (delta - 2.5).max(0.0);
        let found = search(1e-9).run(Guess::new(0.1, 3.0), |delta, _| Ok((curve(delta), ()))).unwrap();
        assert!((curve(found.guess.approach) - 2.0).abs() < 1e-8);
    }

    #[test]
    fn a_load_that_the_curve_jumps_over_is_not_reached() {
        let curve = |delta: f64| if delta < 1.0 { 1.0 + 0.1 * delta } else { 3.0 + delta };
        let found = search(1e-4).run(Guess::new(0.5, 2.0), |delta, _| Ok((curve(delta), ())));
        match found.map(|found| found.guess) {
            Err(Error::LoadNotReached { load, approach, .. }) => {
                assert_eq!(load, 2.0);
                assert!((approach - 1.0).abs() < 1e-12, "{approach}");
            }
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_load_beyond_the_most_there_is_names_it() {
        let curve = |delta: f64| 1.5 * (1.0 - (-delta).exp());
        let first = Guess::new(0.5, 2.0);
        let found = limited(1e-4, 8.0).run(first, |delta, _| Ok((curve(delta), ())));
        match found.map(|found| found.guess) {
            Err(Error::BeyondPass { load, most, approach, cause: LoadLimit::Yielded }) => {
                assert_eq!((load, most, approach), (2.0, curve(8.0), 8.0));
            }
            other => panic!("{other:?}"),
        }
        // A load just below the limit is found.
        let found = Search { load: 1.499, ..limited(1e-6, 8.0) };
        let found = found.run(first, |delta, _| Ok((curve(delta), ()))).unwrap();
        assert!((curve(found.guess.approach) / 1.499 - 1.0).abs() < 1e-6);
    }

    #[test]
    fn a_guess_that_is_much_too_steep_is_corrected_by_the_first_trials() {
        let first = Guess { error: 0.0, ..Guess::new(2f64.powf(2.0 / 3.0) * (1.0 + 1e-4), 10.0) };
        let found = search(1e-9).run(first, |delta, _| Ok((delta.powf(1.5), ()))).unwrap();
        assert!(found.trials <= 5, "{} trials", found.trials);
    }

    #[test]
    fn rough_answers_on_the_wrong_side_do_not_mislead() {
        // The rough load is twice too large below 1.2, and half the true load above.
        let rough = |delta: f64| if delta < 1.2 { 2.0 * delta } else { 0.5 * delta };
        let trial = |delta: f64, eta: f64| Ok((if eta > 1e-6 { rough(delta) } else { delta }, ()));
        let found = search(1e-6).run(Guess::new(1.1, 2.0), trial).unwrap();
        assert!((found.guess.approach - 2.0).abs() < 1e-5, "{:?}", found.guess);
    }

    #[test]
    fn a_rough_answer_on_the_wrong_side_of_the_load_closes_no_bracket() {
        // A rough trial before the limit reaches 1 % less than the true load, and is below the required load,
        // which is met at 2.
        let trial = |delta: f64, eta: f64| {
            let short = if eta > 1e-6 && delta > 2.0 { 0.01 } else { 0.0 };
            Ok((delta * (1.0 - short), ()))
        };
        let found = search(1e-4).run(Guess::new(2.016, 0.5), trial).unwrap();
        assert!((found.guess.approach - 2.0).abs() < 3e-4, "{:?}", found.guess);
        assert!(found.trials < 10, "{} trials", found.trials);
    }

    #[test]
    fn a_bracket_that_closes_on_a_jump_hands_on_no_slope_of_it() {
        // The load jumps at 2 to the required load, within the error accepted from an exhausted bracket.
        let curve = |delta: f64| if delta < 2.0 { 0.9 * delta } else { delta + 1e-4 };
        let first = Guess::new(1.9, 0.5);
        let found = search(1e-9).run(first, |delta, _| Ok((curve(delta), ()))).unwrap();
        assert_eq!(found.guess.slope, first.slope, "{:?}", found.guess);
    }

    #[test]
    fn a_load_known_too_roughly_for_the_tolerance_is_met_as_nearly_as_it_is_known() {
        // The load has an error of a part of the residual that varies from approach to approach.
        let uncertain = |delta: f64| 5e-5 * (1e15 * delta).sin();
        let trial = |delta: f64, _| Ok((delta.powf(1.5) * (1.0 + uncertain(delta)), ()));
        let first = Guess::new(0.3, 2.0);
        let found = Search { residual: 1e-3, ..search(1e-9) }.run(first, trial).unwrap();
        assert!((found.guess.approach.powf(1.5) / 2.0 - 1.0).abs() < 2e-4, "{:?}", found.guess);
        assert!(found.trials < 30, "{} trials", found.trials);
    }

    #[test]
    fn a_load_that_is_never_there_is_given_up() {
        let found = search(1e-4).run(Guess::new(0.5, 2.0), |_, _| Ok((1.0, ())));
        let error = found.map(|found| found.guess).unwrap_err();
        assert!(matches!(error, Error::LoadNotReached { trials: MAX_TRIALS, .. }), "{error:?}");
    }
}
