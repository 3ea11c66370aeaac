//! The table of the limits.

use super::bounds::{Bounds, LARGE_DISPLACEMENT};
use super::findings::{ChangingRow, Finding, Findings};
use crate::case::{Case, Side};
use crate::estimate::STEEP;
use crate::limit::{BrokenLimit, Limit};
use asperity_base::choice::Choice;
use asperity_base::units::{self, Dimension, Metre};
use asperity_contact::each;
use asperity_contact::motion::Pair;
use asperity_contact::with::{BodyLaw, ChangedSurfaces};
use asperity_surface::Topography;

/// A row of the table of limits.
pub(super) struct Row {
    pub(super) limit: Limit,
    /// Returns the result of a step that exceeds the limit most, if one does.
    pub(super) exceeds: fn(&Bounds, &Findings<'_>) -> Option<Finding>,
    /// Returns the sentence about a result beyond the limit, without its place.
    pub(super) says: fn(&Case, &BrokenLimit) -> String,
}

/// Returns all limits.
pub(super) fn limits() -> Vec<Row> {
    let mut limits = vec![Row { limit: Limit::Slope, exceeds: slope, says: says_slope }];
    each!(law L => limits.push(Row { limit: Limit::Law(L::NAME), exceeds: law::<L>, says: says_law::<L> }));
    limits.extend(OF_CONTACTS);
    limits
}

/// Limits of every contact, which come after those of the laws.
const OF_CONTACTS: [Row; 5] = [
    Row { limit: Limit::Pressure, exceeds: pressure, says: says_pressure },
    Row { limit: Limit::Hardness, exceeds: hardness, says: says_hardness },
    Row { limit: Limit::Temperature, exceeds: temperature, says: says_temperature },
    Row { limit: Limit::Displacement, exceeds: displacement, says: says_displacement },
    Row { limit: Limit::Interference, exceeds: interference, says: says_interference },
];

fn slope(bounds: &Bounds, findings: &Findings<'_>) -> Option<Finding> {
    let pair = findings.changed.filter(|_| bounds.slope.is_finite())?;
    let bodies = [(pair.lower_grid(), &pair.lower), (pair.upper_grid(), &pair.upper)];
    let slopes =
        bodies.map(|(grid, body)| Topography::new(grid, body.heights.clone()).map_or(0.0, |body| body.sdq()));
    let slopes = slopes.into_iter().filter(|slope| slope.is_finite());
    findings.as_a_whole(None, slopes.fold(0.0, f64::hypot), bounds.slope)
}

fn law<L: BodyLaw>(bounds: &Bounds, findings: &Findings<'_>) -> Option<Finding> {
    let area = |pair: &Pair| [pair.lower_grid(), pair.upper_grid()].map(|grid| grid.area());
    let surfaces = ChangedSurfaces {
        area: findings.changed.map_or([f64::INFINITY; 2], area),
        sq: findings.sq,
        removal: bounds.removal,
    };
    findings.of_bodies(match findings.row.as_ref()? {
        ChangingRow::Pass(pass) => L::limit_in_pass(pass, &surfaces),
        ChangingRow::Update(update) => L::limit_in_update(update, &surfaces),
    })
}

fn pressure(bounds: &Bounds, findings: &Findings<'_>) -> Option<Finding> {
    findings.largest(bounds.pressure, |contact| contact.max_pressure)
}

fn hardness(bounds: &Bounds, findings: &Findings<'_>) -> Option<Finding> {
    let [capped, all] = findings
        .contacts
        .iter()
        .fold([0, 0], |[capped, all], contact| [capped + contact.cells[0], all + contact.cells[1]]);
    findings.as_a_whole(None, capped as f64 / all.max(1) as f64, bounds.hardness)
}

fn temperature(bounds: &Bounds, findings: &Findings<'_>) -> Option<Finding> {
    let (step, value) = findings.temperature?;
    let bound = bounds.temperature;
    (value > bound).then_some(Finding { step: Some(step), body: None, value, bound })
}

fn displacement(bounds: &Bounds, findings: &Findings<'_>) -> Option<Finding> {
    findings.largest(bounds.displacement, |contact| contact.displacement.unwrap_or(0.0))
}

fn interference(bounds: &Bounds, findings: &Findings<'_>) -> Option<Finding> {
    findings.largest(bounds.interference, |contact| contact.interference)
}

fn says_slope(_: &Case, broken: &BrokenLimit) -> String {
    format!(
        "the worn surfaces are steep for a half-space theory of small slopes: the rms slope of the gap is {:.4}, up to {STEEP} tan and \
         sin agree; check the `coefficient` of the law that does it, or end the run before",
        broken.value
    )
}

fn says_law<L: BodyLaw>(_: &Case, broken: &BrokenLimit) -> String {
    L::beyond_limit(name(broken), broken.value, broken.bound)
}

fn says_pressure(case: &Case, broken: &BrokenLimit) -> String {
    let advice = match (case.plasticity, case.yields()) {
        (Some(_), _) => "check `yield_stress`",
        (None, true) => "check `hardness`",
        (None, false) => "give a `hardness`, or [plasticity]",
    };
    let [value, bound] = [broken.value, broken.bound].map(|value| units::format(value, Dimension::Pressure));
    format!(
        "the largest pressure is {value}, above a tenth of E*, {bound}, where no solid stays elastic: {advice}"
    )
}

fn says_hardness(_: &Case, broken: &BrokenLimit) -> String {
    format!(
        "{:.0} % of the cells are at the hardness: the load is near the plastic limit, and contact is almost complete; a lower load or \
         a greater hardness leaves a gap",
        100.0 * broken.value
    )
}

fn says_temperature(_: &Case, broken: &BrokenLimit) -> String {
    let [value, bound] =
        [broken.value, broken.bound].map(|value| units::format(value, Dimension::Temperature));
    format!(
        "the surfaces reach {value}, and steel melts at {bound}: the model neither softens nor melts; check `coefficient` in \
         [friction], the speed and the thermal constants"
    )
}

fn says_displacement(_: &Case, broken: &BrokenLimit) -> String {
    format!(
        "cells are displaced by up to {}, more than a tenth of the longer side of the bodies, {}: the model assumes small strains; give \
         a lower load or a larger grid",
        length(broken.value),
        length(broken.bound / LARGE_DISPLACEMENT)
    )
}

fn says_interference(_: &Case, broken: &BrokenLimit) -> String {
    format!(
        "summits are flattened by up to {}, more than all heights of the bodies, {}: truncation at the hardness describes summits, \
         not bodies that are pressed into each other; give a lower load",
        length(broken.value),
        length(broken.bound)
    )
}

/// Name of the body that exceeds a limit.
fn name(broken: &BrokenLimit) -> &'static str {
    broken.body.map_or("", Side::word)
}

fn length(value: Metre) -> String {
    units::format(value, Dimension::Length)
}
