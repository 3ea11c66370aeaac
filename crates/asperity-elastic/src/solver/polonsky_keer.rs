//! The constrained conjugate gradient method of Polonsky and Keer, with an upper bound of the pressure.

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::operator::Operator;
use crate::solver::feasible::{Bounded, make_feasible};
use crate::solver::{Answer, Control, Params, Problem, Stats, finite};
use asperity_base::watch::check_stop;

/// Relative distance from its upper bound below which a pressure differs from it only by rounding.
const ROUNDING: f64 = 1e-12;
/// Number of convolutions without a new smallest residual after which steps are damped. The published steps,
/// clipped at two bounds, may oscillate forever.
const MAX_STAGNATION: f64 = 100.0;
/// The damping factor of these steps.
const DAMPING: f64 = 0.5;
/// Fraction of the interference of a cell that its first pressure closes under approach control, as if the
/// cell were alone.
const FIRST_PRESSURE: f64 = 0.3;

/// Solves by the method of Polonsky and Keer (1999), with two operator calls per iteration. Cells at their
/// upper bound leave the conjugate directions in the same way as cells at their lower bound.
pub(super) fn solve(
    operator: &mut dyn Operator,
    problem: &Problem,
    start: Option<&Field>,
    params: &Params,
) -> Result<Answer> {
    let Problem { initial_gap, bounds, settings, .. } = *problem;
    let feasible = |pressure: &mut Field| make_feasible(&mut Bounded { pressure, bounds }, &settings);
    let mut pressure = match (start, settings.pressure_sum(), settings.control) {
        (Some(start), ..) => start.clone(),
        (None, Some(sum), _) => Field::from_elem(initial_gap.raw_dim(), sum / initial_gap.len() as f64),
        (None, None, Control::Approach(delta)) => {
            initial_gap.mapv(|h| (delta - h) / settings.self_influence * FIRST_PRESSURE)
        }
        (None, None, Control::Load(_)) => unreachable!("a load has a pressure sum"),
    };
    feasible(&mut pressure);
    let mut displacement = Field::zeros(pressure.raw_dim());
    let mut direction = Field::zeros(pressure.raw_dim());
    let mut response = Field::zeros(pressure.raw_dim());
    let mut stats = Stats::default();
    let mut squared_before = f64::INFINITY;
    let (mut damping, mut least, mut least_at) = (1.0, f64::INFINITY, 0.0);
    loop {
        operator.apply(&pressure, &mut displacement);
        stats.convolutions += 1.0;
        let state = problem.residual(&pressure, &displacement);
        settings.watch.iteration(state.eta, params.tolerance);
        check_stop(settings.watch)?;
        if state.eta < params.tolerance {
            // A cell that differs from its upper bound only by rounding is at the bound.
            for (cell, p) in pressure.iter_mut().enumerate() {
                let upper = bounds.interval(cell).upper;
                *p = if upper - *p < ROUNDING * upper { upper } else { *p };
            }
            return Ok(Answer {
                pressure,
                displacement,
                approach: state.approach,
                residual: state.eta,
                stats,
            });
        }
        finite("residual", state.eta.min(f64::MAX))?;
        if stats.convolutions as usize >= params.max_convolutions {
            return Err(Error::NotConverged {
                iterations: stats.iterations,
                residual: state.eta,
                tolerance: params.tolerance,
            });
        }
        if state.eta < least {
            (least, least_at) = (state.eta, stats.convolutions);
        } else if stats.convolutions - least_at > MAX_STAGNATION {
            (damping, least_at) = (DAMPING * damping, stats.convolutions);
        }
        let is_free: Vec<bool> =
            pressure.iter().enumerate().map(|(cell, p)| bounds.interval(cell).is_free(*p)).collect();
        if !is_free.contains(&true) {
            // All cells are at bounds, but not in equilibrium: one damped diagonal step along the gap frees
            // some.
            ndarray::Zip::from(&mut pressure).and(&displacement).and(initial_gap).for_each(|p, u, h| {
                *p += 0.5 * damping * (state.approach - h - u) / settings.self_influence;
            });
            feasible(&mut pressure);
            continue;
        }
        let mut gap = initial_gap + &displacement;
        let datum = match settings.control {
            Control::Approach(approach) => approach,
            Control::Load(_) => mean_where(&gap, &is_free),
        };
        gap -= datum;
        let squared: f64 = gap.iter().zip(&is_free).filter(|(_, free)| **free).map(|(g, _)| g * g).sum();
        let beta = squared / squared_before;
        squared_before = squared;
        for ((t, g), free) in direction.iter_mut().zip(&gap).zip(&is_free) {
            *t = if *free { g + beta * *t } else { 0.0 };
        }
        operator.apply(&direction, &mut response);
        stats.convolutions += 1.0;
        if let Control::Load(_) = settings.control {
            response -= mean_where(&response, &is_free);
        }
        let slope: f64 = gap.iter().zip(&direction).map(|(g, t)| g * t).sum();
        let curvature: f64 = response.iter().zip(&direction).map(|(r, t)| r * t).sum();
        // A single free cell under load cannot move, but the cells at the bounds can.
        let step = damping * if curvature > 0.0 { slope / curvature } else { 1.0 / settings.self_influence };
        let mut reentered = false;
        for (cell, ((p, t), g)) in pressure.iter_mut().zip(&direction).zip(&gap).enumerate() {
            let bounds = bounds.interval(cell);
            *p = bounds.clamp(*p - step * t);
            if (*p == bounds.lower && *g < 0.0) || (*p == bounds.upper && *g > 0.0) {
                *p -= step * g;
                reentered = true;
            }
        }
        feasible(&mut pressure);
        if reentered {
            squared_before = f64::INFINITY;
        }
        stats.iterations += 1;
    }
}

/// Returns the mean of `values` over the free cells.
fn mean_where(values: &Field, is_free: &[bool]) -> f64 {
    let (mut sum, mut count) = (0.0, 0usize);
    for (v, free) in values.iter().zip(is_free) {
        if *free {
            sum += v;
            count += 1;
        }
    }
    sum / count as f64
}
