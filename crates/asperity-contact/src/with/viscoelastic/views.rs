//! Steady sliding in words, and reasons not to trust it.

use crate::motion::{IncrementRecord, PassRecord, SweepRecord};
use crate::operator::Boundary;
use crate::units::{Dimension, Kelvin, Metre, format, format_number};
use crate::viscoelastic::Creep;
use crate::with::views::{Answer, OfPoints};
use crate::with::viscoelastic::Viscoelasticity;

/// The curve over the points of a sweep.
pub(in crate::with) const OF_POINTS: OfPoints = OfPoints {
    column: "drag_coefficient",
    label: "drag over load",
    may_be_log: false,
    value: |point| point.steady.map(|steady| steady.drag_coefficient),
    beside: &[],
};

/// Returns what the points of a sweep show of steady sliding: the largest drag, and its speed.
pub fn answers(points: &[SweepRecord]) -> Vec<Answer> {
    let steady: Vec<_> = points.iter().filter_map(|point| Some((point, point.steady?))).collect();
    let Some((most_at, most)) =
        steady.iter().max_by(|(_, a), (_, b)| a.drag_coefficient.total_cmp(&b.drag_coefficient))
    else {
        return Vec::new();
    };
    let value = format_number(most.drag_coefficient);
    let speed_of = |point: &SweepRecord| point.speed.unwrap_or_default();
    let speed = speed_of(most_at);
    let at = format(speed, Dimension::Speed);
    let sentence = match steady.as_slice() {
        [(_, only)] => format!(
            "At {at} the bodies resist the motion with {value} of the load, {}, and dissipate {}.",
            format(only.drag, Dimension::Force),
            format(only.drag_power, Dimension::Power)
        ),
        several => {
            let speeds = several.iter().map(|(point, _)| speed_of(point));
            let [least, largest] = [speeds.clone().fold(f64::INFINITY, f64::min), speeds.fold(0.0, f64::max)];
            let is_inside = least < speed && speed < largest;
            let place = if is_inside { "" } else { ", at an end of the speeds" };
            let share = |pick: fn(f64, f64) -> f64, from: f64| {
                let shares = several.iter().map(|(point, _)| 100.0 * point.contact_fraction);
                format_number(shares.fold(from, pick))
            };
            format!(
                "The drag of {} speeds is largest at {at}{place}: {value} of the load. The real area of contact goes from {} % to {} % of \
                 the grid.",
                several.len(),
                share(f64::max, 0.0),
                share(f64::min, f64::INFINITY)
            )
        }
    };
    vec![Answer {
        name: "largest drag over load".into(),
        about: format!("Coefficient of friction of the dissipation, at {at}."),
        sentence,
        value,
    }]
}

/// Returns what passes of viscoelastic bodies show: the drag of the last one; `None` for other bodies.
pub fn in_passes(passes: &[PassRecord]) -> Option<Answer> {
    let drag = passes.last()?.drag.filter(|drag| drag.drag_coefficient.is_finite())?;
    let value = format_number(drag.drag_coefficient);
    let force = format(drag.mean_drag, Dimension::Force);
    let last = if passes.len() > 1 { " in the last pass" } else { "" };
    Some(Answer {
        name: "mean drag over load".into(),
        about: "Coefficient of friction of the dissipation, in the last pass.".into(),
        sentence: format!("The bodies resist the motion with {value} of the load, {force}{last}."),
        value,
    })
}

/// Returns how a contact of viscoelastic bodies has changed in time; `None` for other bodies.
pub fn in_time(increments: &[IncrementRecord]) -> Option<Answer> {
    let (first, last) = (increments.first()?, increments.last()?);
    let time = format(last.creep?.time, Dimension::Time);
    let from_to = |value: fn(&IncrementRecord) -> f64, dimension: Dimension| {
        format!("from {} to {}", format(value(first), dimension), format(value(last), dimension))
    };
    let area = from_to(|increment| increment.contact_area, Dimension::Area);
    let under = if (first.load - last.load).abs() < 1e-6 * first.load.abs() {
        format!("the bodies approach {}", from_to(|increment| increment.approach, Dimension::Length))
    } else {
        format!("the load goes {}", from_to(|increment| increment.load, Dimension::Force))
    };
    Some(Answer {
        name: "area of contact in time".into(),
        value: area.clone(),
        about: format!("After the first load, and {time} later."),
        sentence: format!("In {time} {under}, and the real area of contact goes {area}."),
    })
}

/// Temperatures above that of infinite times at which the shift of Williams, Landel and Ferry usually holds:
/// from the glass transition to 100 K above it, with a margin (Ferry, Viscoelastic Properties of Polymers).
const WLF: [f64; 2] = [40.0, 200.0];

impl Viscoelasticity {
    /// Returns a reason not to trust the shift of a `part`, such as "lower body", at its `temperature`.
    pub fn doubt(&self, part: &str, temperature: Option<Kelvin>) -> Option<String> {
        let above =
            self.above_infinite_times(temperature).filter(|above| !(WLF[0]..=WLF[1]).contains(above))?;
        Some(format!(
            "the {part} at {} is {} above Tᵣ − c₂: the shift of Williams, Landel and Ferry usually holds from 50 K to 150 K above \
             it, which is from the glass transition to 100 K more",
            format(temperature?, Dimension::Temperature),
            format(above, Dimension::TemperatureDifference)
        ))
    }
}

/// Share of the compliance from which on a term matters.
const WEIGHT: f64 = 0.05;
/// Ratio of a modulus to what is softer from which on its relaxation must be resolved, and the length that
/// resolves it, in cells.
const STIFF: f64 = 30.0;
const RESOLVED: f64 = 0.4;
/// Density of rubber, kg/m³, and the share of the speed of its shear waves from which on its inertia matters.
const DENSITY: f64 = 1000.0;
const SLOW: f64 = 0.3;

/// Returns reasons not to trust the sliding of bodies with this `creep` compliance of the body that the
/// contact moves over, at the `speeds`, on a grid with this extent along x. The contact is resolved in steps
/// of this length: cells, or the distance between two positions.
pub fn doubts(creep: &Creep, boundary: Boundary, step: Metre, extent: Metre, speeds: &[f64]) -> Vec<String> {
    if creep.terms.is_empty() {
        return vec![
            "the viscoelastic body is the rough one, which stands still in the contact: it has its relaxed modulus, and nothing drags"
                .to_owned(),
        ];
    }
    let mut doubts = Vec::new();
    let relaxed = creep.relaxed();
    let important =
        || creep.terms.iter().filter(|term| term.compliance > WEIGHT * relaxed).map(|term| term.time);
    let [fastest, slowest] = [important().fold(f64::INFINITY, f64::min), important().fold(0.0, f64::max)];
    let text = |length: Metre| format(length, Dimension::Length);
    let speed = |speed: f64| format(speed, Dimension::Speed);
    let least = speeds.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = speeds.iter().copied().fold(0.0, f64::max);
    if least * slowest < 0.5 * step {
        doubts.push(format!(
            "at {} the body has crept within {}, less than half of the {} that are resolved: its drag is lost; take a finer grid, smaller \
             steps or a larger speed",
            speed(least),
            text(least * slowest),
            text(step)
        ));
    }
    if boundary.repeats(0) && largest * fastest > extent {
        doubts.push(format!(
            "at {} the body remembers {} or more, beyond the period of {}: waves along y stay relaxed however fast the contact moves, so \
             that it does not become that of the glassy body",
            speed(largest),
            text(largest * fastest),
            text(extent)
        ));
    }
    // The shear modulus of an incompressible body is a third of Young's.
    let waves = (1.0 / (3.0 * creep.glassy * DENSITY)).sqrt();
    if largest > SLOW * waves {
        doubts.push(format!(
            "at {} the contact moves at {} times the speed of shear waves in the glassy body, about {} for 1 g/cm³: the model has no inertia",
            speed(largest),
            format_number(largest / waves),
            speed(waves)
        ));
    }
    let mut softer = creep.glassy;
    // From the fastest term on: what is softer than the glassy body by more than this in one time.
    for term in creep.terms.iter().rev() {
        let ratio = (softer + term.compliance) / softer;
        let relaxation = term.time / ratio;
        if ratio > STIFF
            && speeds.iter().any(|speed| speed * relaxation < RESOLVED * step && speed * term.time > step)
        {
            doubts.push(format!(
                "a retardation time of {} softens the body {} times at once: where it relaxes in less than {} of a cell, the leading edge is \
                 not resolved",
                format(term.time, Dimension::Time),
                format_number(ratio),
                format_number(RESOLVED)
            ));
            break;
        }
        softer += term.compliance;
    }
    doubts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viscoelastic::{Relaxation, RelaxationTerm};

    #[test]
    fn steady_sliding_is_doubted_where_the_grid_or_the_model_ends() {
        let creep = |terms: &[(f64, f64)]| {
            let terms = terms.iter().map(|&(modulus, time)| RelaxationTerm { modulus, time });
            Relaxation::new(1e6, terms).unwrap().creep()
        };
        let rubber = creep(&[(9e6, 1e-3), (9e7, 2e-5)]);
        let told =
            |creep: &Creep, boundary, speed: f64| doubts(creep, boundary, 1e-6, 1e-3, &[speed]).join("; ");
        assert_eq!(told(&rubber, Boundary::PERIODIC, 0.01), "");
        assert!(told(&rubber, Boundary::FREE, 1e-5).contains("less than half of the 1 µm that are resolved"));
        assert!(told(&rubber, Boundary::PERIODIC, 10.0).contains("beyond the period of 1 mm"));
        assert_eq!(told(&rubber, Boundary::FREE, 10.0), "");
        // Shear waves pass glass of 100 MPa at √(100 MPa/(3 · 1 g/cm³)), 183 m/s.
        assert!(told(&rubber, Boundary::FREE, 50.0).is_empty());
        assert!(told(&rubber, Boundary::FREE, 60.0).contains("0.3286 times the speed of shear waves"));
        assert!(told(&creep(&[(1e9, 1e-2)]), Boundary::FREE, 1e-5).contains("leading edge"));
        assert!(told(&Creep::elastic(1e-6), Boundary::FREE, 1.0).contains("stands still"));
    }
}
