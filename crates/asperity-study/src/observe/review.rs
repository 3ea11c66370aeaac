//! Warnings about what observers have found.

use crate::case::Case;
use crate::observed::{ConductanceRecord, GapFlowRecord};
use asperity_base::units::{self, Dimension, MetrePerSecond, format_number};
use asperity_contact::conductance::{self, Bracket};
use asperity_contact::flow::{self, Ends};
use asperity_contact::motion::{Strategy, SweepRecord};
use asperity_surface::Axis;

/// Largest pressure of the fluid without a warning, over the mean pressure of the contact.
const FLUID_PRESSURE: f64 = 0.1;
/// Largest flow that the moving bodies drag along without a warning, over that of the pressure difference.
const DRAGGED: f64 = 0.1;
/// Relative deviation from Barber's bracket without a warning: the load of a sweep is met to about this.
const BRACKET: f64 = 1e-3;

/// Returns the warnings about the conductance and the flow of a case.
pub(crate) fn warnings(
    case: &Case,
    conductance: &[ConductanceRecord],
    flow: &[GapFlowRecord],
) -> Vec<String> {
    of_conductance(conductance).into_iter().chain(of_flow(case, flow)).collect()
}

fn of_conductance(rows: &[ConductanceRecord]) -> Vec<String> {
    let touching = || rows.iter().filter(|row| row.spots > 0.0);
    let fewest = touching().map(|row| row.median_spot_cells).fold(f64::INFINITY, f64::min);
    let film = touching().map(|row| row.film_share).fold(0.0, f64::max);
    conductance::doubts(fewest, film)
}

fn of_flow(case: &Case, rows: &[GapFlowRecord]) -> Vec<String> {
    let Some(spec) = &case.flow else { return Vec::new() };
    let mut warnings = Vec::new();
    let pressure = |value| units::format(value, Dimension::Pressure);
    let least = rows.iter().map(|row| row.mean_pressure).filter(|p| *p > 0.0).fold(f64::INFINITY, f64::min);
    if spec.pressure > FLUID_PRESSURE * least {
        warnings.push(format!(
            "the pressure difference of the fluid is {}, the mean pressure of the contact {}: the fluid would lift the bodies, which is \
             left out",
            pressure(spec.pressure),
            pressure(least),
        ));
    }
    let open = || rows.iter().filter(|row| row.critical_cells > 0 && row.contact_area > 0.0);
    let estimate = rows.iter().map(|row| row.estimate).fold(0.0, f64::max);
    warnings.extend(flow::doubts(open().map(|row| row.critical_cells).min(), estimate));
    let at_rim = |row: &GapFlowRecord| {
        let (axis, boundary) = (usize::from(row.along == Axis::Y), case.contact.boundary);
        spec.ends_along(axis, boundary) == Ends::Reservoirs && !boundary.repeats(axis)
    };
    if rows.iter().any(at_rim) {
        warnings.push(
            "the reservoirs are at free edges of the grid, where the surfaces end: the gap near them is not that of the middle of larger \
             bodies"
                .to_owned(),
        );
    }
    warnings.extend(of_sliding(case, rows));
    warnings
}

/// Returns a warning if the bodies drag along more fluid than a small part of the leakage.
fn of_sliding(case: &Case, rows: &[GapFlowRecord]) -> Option<String> {
    let spec = case.flow.as_ref()?;
    let speed = dragging_speed(case)?;
    // 6 η U L/(ḡ² ΔP)
    let dragged = |row: &GapFlowRecord| {
        6.0 * spec.viscosity * speed * row.length / (row.mean_gap * row.mean_gap * spec.pressure)
    };
    let along_x = rows.iter().filter(|row| row.along == Axis::X && row.mean_gap > 0.0);
    let dragged = along_x.map(dragged).fold(0.0, f64::max);
    (dragged > DRAGGED).then(|| {
        let times = if dragged.is_finite() { format_number(dragged) } else { "many".to_owned() };
        format!(
            "the moving bodies drag along {times} times the fluid that the pressure difference drives: dragged and squeezed fluid is left \
             out"
        )
    })
}

/// Returns the sum of the speeds at which the two bodies move past the contact: each drags along the fluid at its surface.
fn dragging_speed(case: &Case) -> Option<MetrePerSecond> {
    let Some(motion) = case.motion else { return case.sliding.and_then(|sliding| sliding.speed) };
    match motion.strategy {
        Strategy::Overlap => motion.speed,
        Strategy::Shift { speed_lower, speed_upper } => Some(speed_lower.abs() + speed_upper.abs()),
    }
}

/// Returns a warning if the conductance of a point of an elastic sweep lies outside Barber's bracket.
pub(crate) fn barber(case: &Case, points: &[SweepRecord], rows: &[ConductanceRecord]) -> Option<String> {
    // With friction a point may repeat a load with another creepage.
    let spec = case.conductance.filter(|spec| spec.film.is_none() && spec.gas.is_none())?;
    let is_elastic = points.iter().all(|point| point.plastic_area == 0.0);
    let is_coated = [&case.lower, &case.upper].iter().any(|body| body.material.coating.is_some());
    let composite = case.composite_conductivity(spec.kind)?.ok()?;
    let modulus = asperity_contact::material::Compliances::new(&case.lower.material, &case.upper.material)
        .ok()?
        .modulus();
    if case.friction.is_some() || !is_elastic || is_coated || rows.len() != points.len() {
        return None;
    }
    let loads: Vec<_> = points.iter().map(|point| (point.load, point.approach)).collect();
    let brackets = Bracket::of_sweep(&loads, composite, modulus);
    let outside = |(row, bracket): &(&ConductanceRecord, &Bracket)| {
        row.conductance().is_some_and(|conductance| !bracket.holds(conductance, BRACKET))
    };
    let (row, _) = rows.iter().zip(&brackets).find(outside)?;
    Some(format!(
        "the conductance of point {} lies outside Barber's bracket from load and approach: the grid or the tolerance is too coarse",
        row.step.unwrap_or_default()
    ))
}
