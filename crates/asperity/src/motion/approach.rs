//! The search for the approach of a pass at which its mean load is the one prescribed.

use crate::error::{Error, LoadLimit, Result};
use crate::motion::warm_start::Guess;
use crate::units::{Metre, Newton};

/// Largest residual η to which the positions of a trial are solved roughly.
pub(super) const MAX_RESIDUAL: f64 = 0.1;
/// Approaches tried, after which the search is given up.
const MAX_TRIALS: usize = 100;

/// Largest relative error of the load, in residuals η of its positions, that an exhausted bracket may leave: the load is
/// uncertain by a part of η itself.
const MAX_LOAD_ERROR: f64 = 100.0;

/// Width of a bracket, in roundings of its approaches, that holds no more of them to try.
const BRACKET_ROUNDING: f64 = 4.0;
/// Relative error of the load, as a share of the residual η: a load that differs from the one wanted by less does not tell on
/// which side of it it is.
const UNCERTAINTY: f64 = 0.1;
/// Trials to the wanted residual that come as near to the load as that can tell, and not within the tolerance, after which the
/// next of them is taken: on which side of the load they are is not known, and no bracket closes.
const MAX_UNCERTAIN_TRIALS: usize = 8;
/// Trials one after the other that do not halve the least error of the load, after which the bracket is halved instead: the
/// secant is that of a jump.
const MAX_STALLED_TRIALS: usize = 3;
/// Relative error of the load after a secant step, in products of the errors of the two trials before it.
const SECANT_ERROR: f64 = 4.0;

/// A search for the approach of a mean load.
pub(super) struct Search {
    /// The mean load wanted.
    pub(super) load: Newton,
    /// Relative tolerance on the load.
    pub(super) tolerance: f64,
    /// Residual η of the accepted answer.
    pub(super) residual: f64,
    /// Largest residual η to which the positions of a trial are solved.
    pub(super) roughest: f64,
    /// Approach at which the bodies first touch: there is no load below it.
    pub(super) touch: Metre,
    /// Length below which approaches do not differ: the rounding of the heights.
    pub(super) resolution: Metre,
    /// Where the load grows no more, or is not determined.
    pub(super) limit: Limit,
}

/// The largest approach that is tried.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limit {
    /// The approach; infinite where there is no limit.
    pub(super) approach: Metre,
    /// Why the load grows no more beyond this approach.
    pub(super) cause: LoadLimit,
}

/// The accepted trial of a search.
pub(super) struct Found<T> {
    /// The outcome of the trial.
    pub(super) outcome: T,
    /// The approach and the slope there, to begin the next search with.
    pub(super) guess: Guess,
    /// Approaches tried.
    pub(super) trials: usize,
}

impl Search {
    /// Tries approaches by a bracketed secant iteration on ln W(δ).
    ///
    /// `trial(δ, η)` gives the mean load at an approach, from positions solved to the residual η; the first of them to
    /// `residual`. Far from the load a rough answer is enough to find the next approach; only the last trial is solved to
    /// the wanted residual.
    pub(super) fn run<T>(
        &self,
        first: Guess,
        mut residual: f64,
        mut trial: impl FnMut(Metre, f64) -> Result<(Newton, T)>,
    ) -> Result<Found<T>> {
        let Guess { mut approach, mut slope } = first;
        approach = approach.min(self.limit.approach);
        let (mut was_rough, mut rough_misled) = (false, false);
        let mut bracket = Bracket::beyond(self.touch);
        let mut before: Option<(Metre, f64)> = None;
        let (mut excess_before, mut below, mut uncertain) = (1.0, 0.0f64, 0);
        let (mut least_excess, mut stalled) = (f64::INFINITY, 0);
        for trials in 1..=MAX_TRIALS {
            let (load, outcome) = trial(approach, residual)?;
            let excess = load / self.load - 1.0;
            if excess < 0.0 {
                below = below.max(load);
            }
            let at_limit = approach >= self.limit.approach && excess < 0.0;
            let is_rough = residual > self.residual;
            if std::mem::replace(&mut was_rough, is_rough) != is_rough {
                (least_excess, stalled) = (f64::INFINITY, 0);
                if !is_rough && excess.abs() > self.roughest {
                    // The rough answers before it promised that this one meets the load: from here on without them.
                    (rough_misled, before, below) = (true, None, 0.0);
                    (bracket, slope) = (Bracket::beyond(self.touch), first.slope);
                }
            }
            let tells_no_side = excess.abs() <= UNCERTAINTY * residual;
            if !tells_no_side && excess.abs() > self.tolerance {
                let refuted = bracket.narrow(Bound { approach, residual }, excess < 0.0);
                if refuted {
                    // A rougher answer told the wrong side of the load: from here on without them.
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
                // The slope of a jump, on which a bracket closes, leads nowhere.
                let slope = if exhausted { first.slope } else { slope };
                return Ok(Found { outcome, guess: Guess { approach, slope }, trials });
            }
            let logarithm = (load / self.load).ln();
            if let Some((other, value)) = before {
                let change = logarithm - value;
                let secant = change / (approach - other);
                // The slope of a change that no residual tells is noise.
                if secant.is_finite() && secant > 0.0 && change.abs() > UNCERTAINTY * self.residual {
                    slope = secant;
                }
            }
            if logarithm.is_finite() {
                before = Some((approach, logarithm));
            }
            stalled = if excess.abs() < 0.5 * least_excess { 0 } else { stalled + 1 };
            least_excess = least_excess.min(excess.abs());
            let wanted = if rough_misled { self.residual } else { self.residual_for(excess, excess_before) };
            let newton = approach - logarithm / slope;
            (approach, residual) = match bracket.bound_passed(newton) {
                None if stalled < MAX_STALLED_TRIALS || bracket.middle().is_none() => (newton, wanted),
                // A rougher trial than this one may have set the bound on the wrong side of the load.
                Some(bound) if bound.residual > residual => (bound.approach, wanted.min(residual)),
                _ => (bracket.middle().unwrap_or(approach + 1.0 / slope), wanted),
            };
            approach = approach.min(self.limit.approach);
            excess_before = excess;
        }
        Err(Error::LoadNotReached { load: self.load, below, trials: MAX_TRIALS, approach })
    }

    /// The residual that is enough for the trial after two that missed the load by these.
    ///
    /// The mean load is some thousand times more accurate than the residual, and the next trial is expected to miss it
    /// by a few times the product of the last two: where that is within the tolerance, the trial is taken to be the last.
    fn residual_for(&self, excess: f64, before: f64) -> f64 {
        if SECANT_ERROR * (excess * before).abs() <= self.tolerance {
            return self.residual;
        }
        excess.abs().clamp(self.residual, self.roughest.max(self.residual))
    }
}

/// The approaches between which the load is met, as far as trials tell.
struct Bracket {
    touch: Bound,
    low: Bound,
    high: Bound,
}

/// An end of a bracket.
#[derive(Clone, Copy)]
struct Bound {
    approach: Metre,
    /// The residual η of the trial that missed the load there; 0 where none is needed to know.
    residual: f64,
}

impl Bracket {
    const OPEN: Bound = Bound { approach: f64::INFINITY, residual: 0.0 };

    /// All approaches beyond the first touch.
    fn beyond(touch: Metre) -> Self {
        let touch = Bound { approach: touch, residual: 0.0 };
        Self { touch, low: touch, high: Self::OPEN }
    }

    /// Takes a trial as a bound, `below` the load wanted or above it; whether it refutes the bound of a rougher one.
    fn narrow(&mut self, bound: Bound, below: bool) -> bool {
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

    /// The bound at or beyond which an approach lies; the upper one of what is no number.
    fn bound_passed(&self, approach: Metre) -> Option<Bound> {
        if approach <= self.low.approach {
            Some(self.low)
        } else if approach < self.high.approach {
            None
        } else {
            Some(self.high)
        }
    }

    /// The approach half-way between two bounds.
    fn middle(&self) -> Option<Metre> {
        let middle = 0.5 * (self.low.approach + self.high.approach);
        middle.is_finite().then_some(middle)
    }

    /// A bound set by a trial to a residual above this.
    fn bound_rougher_than(&self, residual: f64) -> Option<Bound> {
        [self.low, self.high].into_iter().find(|bound| bound.residual > residual)
    }

    /// Whether it holds no more approaches to try, where these do not differ below the `resolution`.
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
        let found = search(1e-12)
            .run(Guess { approach: 0.3, slope: 2.0 }, MAX_RESIDUAL, |delta, eta| Ok((delta.powf(1.5), eta)))
            .unwrap();
        assert!((found.guess.approach - 2f64.powf(2.0 / 3.0)).abs() < 1e-11);
        assert_eq!(found.outcome, 1e-6, "the last trial is solved to the wanted residual");
        assert!(found.trials <= 10, "{} trials", found.trials);
    }

    #[test]
    fn it_finds_its_way_from_no_contact_and_over_a_kink() {
        let curve = |delta: f64| (delta - 1.0).max(0.0) + 20.0 * (delta - 2.5).max(0.0);
        let found = search(1e-9)
            .run(Guess { approach: 0.1, slope: 3.0 }, MAX_RESIDUAL, |delta, _| Ok((curve(delta), ())))
            .unwrap();
        assert!((curve(found.guess.approach) - 2.0).abs() < 1e-8);
    }

    #[test]
    fn a_load_that_the_curve_jumps_over_is_not_reached() {
        let curve = |delta: f64| if delta < 1.0 { 1.0 + 0.1 * delta } else { 3.0 + delta };
        let found = search(1e-4)
            .run(Guess { approach: 0.5, slope: 2.0 }, MAX_RESIDUAL, |delta, _| Ok((curve(delta), ())));
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
        let first = Guess { approach: 0.5, slope: 2.0 };
        let found = limited(1e-4, 8.0).run(first, MAX_RESIDUAL, |delta, _| Ok((curve(delta), ())));
        match found.map(|found| found.guess) {
            Err(Error::BeyondPass { load, most, approach, cause: LoadLimit::Yielded }) => {
                assert_eq!((load, most, approach), (2.0, curve(8.0), 8.0));
            }
            other => panic!("{other:?}"),
        }
        // What is just below it is found.
        let found = Search { load: 1.499, ..limited(1e-6, 8.0) };
        let found = found.run(first, MAX_RESIDUAL, |delta, _| Ok((curve(delta), ()))).unwrap();
        assert!((curve(found.guess.approach) / 1.499 - 1.0).abs() < 1e-6);
    }

    #[test]
    fn rough_answers_on_the_wrong_side_do_not_mislead() {
        // The rough load is twice too large below 1.2, half of it above.
        let rough = |delta: f64| if delta < 1.2 { 2.0 * delta } else { 0.5 * delta };
        let trial = |delta: f64, eta: f64| Ok((if eta > 1e-6 { rough(delta) } else { delta }, ()));
        let found = search(1e-6).run(Guess { approach: 1.1, slope: 2.0 }, MAX_RESIDUAL, trial).unwrap();
        assert!((found.guess.approach - 2.0).abs() < 1e-5, "{:?}", found.guess);
    }

    #[test]
    fn a_rough_answer_on_the_wrong_side_of_the_load_closes_no_bracket() {
        // A rough trial before it bears 1 % less than there is, and stands below the load: it is at 2.
        let trial = |delta: f64, eta: f64| {
            let short = if eta > 1e-6 && delta > 2.0 { 0.01 } else { 0.0 };
            Ok((delta * (1.0 - short), ()))
        };
        let found = search(1e-4).run(Guess { approach: 2.016, slope: 0.5 }, 1e-2, trial).unwrap();
        assert!((found.guess.approach - 2.0).abs() < 3e-4, "{:?}", found.guess);
        assert!(found.trials < 10, "{} trials", found.trials);
    }

    #[test]
    fn a_bracket_that_closes_on_a_jump_hands_on_no_slope_of_it() {
        // It jumps at 2 to the load wanted, within what is accepted of an exhausted bracket.
        let curve = |delta: f64| if delta < 2.0 { 0.9 * delta } else { delta + 1e-4 };
        let first = Guess { approach: 1.9, slope: 0.5 };
        let found = search(1e-9).run(first, 1e-6, |delta, _| Ok((curve(delta), ()))).unwrap();
        assert_eq!(found.guess.slope, first.slope, "{:?}", found.guess);
    }

    #[test]
    fn a_load_that_is_known_too_roughly_for_the_tolerance_is_met_as_nearly_as_it_is_known() {
        // The load is uncertain by some part of the residual, otherwise at each approach.
        let uncertain = |delta: f64| 5e-5 * (1e15 * delta).sin();
        let trial = |delta: f64, _| Ok((delta.powf(1.5) * (1.0 + uncertain(delta)), ()));
        let first = Guess { approach: 0.3, slope: 2.0 };
        let found = Search { residual: 1e-3, ..search(1e-9) }.run(first, MAX_RESIDUAL, trial).unwrap();
        assert!((found.guess.approach.powf(1.5) / 2.0 - 1.0).abs() < 2e-4, "{:?}", found.guess);
        assert!(found.trials < 30, "{} trials", found.trials);
    }

    #[test]
    fn a_load_that_is_never_there_is_given_up() {
        let found = search(1e-4).run(Guess { approach: 0.5, slope: 2.0 }, MAX_RESIDUAL, |_, _| Ok((1.0, ())));
        let error = found.map(|found| found.guess).unwrap_err();
        assert!(matches!(error, Error::LoadNotReached { trials: MAX_TRIALS, .. }), "{error:?}");
    }
}
