//! CalculiX: an interaction of surfaces with a table.

use std::fmt::Write as _;

use super::{Sheet, number};
use asperity_base::error::{Error, Result};

/// Lines that CalculiX reads of a table.
const LINES: usize = 200;

/// Parts of the step between two points at which a conductance is given.
const PARTS: usize = 4;

/// Beyond its table CalculiX keeps the pressure constant: a last line lies this many times as high, on the last slope.
const BEYOND: f64 = 10.0;

/// Returns the points with one beyond the end; of too many, every so many-th.
fn points(sheet: &Sheet<'_>) -> Vec<[f64; 2]> {
    let every = sheet.closure.len().div_ceil(LINES - 2);
    let last = sheet.closure.len() - 1;
    let kept = sheet.closure.iter().enumerate().filter(|(n, _)| n % every == 0 || *n == last);
    kept.map(|(_, point)| *point).chain([sheet.extended(BEYOND)]).collect()
}

/// The mechanical joint.
pub(super) fn cold(sheet: &Sheet<'_>) -> String {
    let mut text = sheet.head("**", &[
        "Use it with *CONTACT PAIR, INTERACTION=JOINT, TYPE=NODE TO SURFACE: with SURFACE TO SURFACE a table diverges",
        "Give it before all steps; the finer mesh is the slave surface",
        "The last line goes on to ten times the largest pressure; beyond it the pressure stays constant",
    ]);
    text += "*SURFACE INTERACTION, NAME=JOINT\n";
    behavior(&mut text, &points(sheet));
    friction(&mut text, sheet);
    text
}

/// The joint with its conductance.
pub(super) fn heat(sheet: &Sheet<'_>) -> Result<String> {
    if sheet.law.gas_share > 0.0 {
        return Err(Error::Unsupported(
            "CalculiX exchanges no heat between open faces: leave the gas out of [conductance], or take another program",
        ));
    }
    let mut text = sheet.head("**", &[
        "Use it with *CONTACT PAIR, INTERACTION=JOINT, TYPE=NODE TO SURFACE, in *COUPLED TEMPERATURE-DISPLACEMENT",
        "CalculiX takes forces from the last *SURFACE BEHAVIOR, and the pressure of *GAP CONDUCTANCE from the exponential one;",
        "this is how 2.20 is written, and stands in no manual: the lines of *GAP CONDUCTANCE stand at the pressure of the",
        "exponential law at the closure of the point, so that both are right at the points",
        "The last lines go on to ten times the largest pressure, where the conductance is in proportion to the pressure;",
        "beyond them pressure and conductance stay constant",
    ]);
    let points = points(sheet);
    // p₀ exp(c/u₀): c0 = u₀ ln 100.
    let (first, last) = (points[1], points[points.len() - 2]);
    let decay = (last[1] - first[1]) / (last[0] / first[0]).ln();
    let start = first[0] * (-first[1] / decay).exp();
    let most = start * (points[points.len() - 1][1] / decay).exp();
    if !(start.is_normal() && most.is_finite()) {
        return Err(Error::Unsupported(
            "CalculiX needs an exponential law beside this one, and none has its pressures at its closures: leave out the least loads, \
             under which only a few cells bear, or take another program",
        ));
    }
    text += "*SURFACE INTERACTION, NAME=JOINT\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=EXPONENTIAL\n";
    let _ = writeln!(text, "{}, {}", number(decay * 100f64.ln()), number(start));
    behavior(&mut text, &points);
    friction(&mut text, sheet);
    text += "*GAP CONDUCTANCE\n";
    let conductances = conductances(sheet);
    for pressure in between(&points) {
        let [closure, conductance] = [&points, &conductances].map(|table| interpolated(table, pressure));
        let _ = writeln!(text, "{}, {}", number(conductance), number(start * (closure / decay).exp()));
    }
    Ok(text)
}

/// Pressures of the points above 0 and some between: there the conductance is straight in the pressure, and the line of
/// CalculiX is straight in the exponential law.
fn between(points: &[[f64; 2]]) -> Vec<f64> {
    let parts = (LINES / points.len()).clamp(1, PARTS);
    let pairs = points[1..].windows(2).flat_map(|pair| {
        let [from, to] = [pair[0][0], pair[1][0]];
        (0..parts).map(move |part| from * (to / from).powf(part as f64 / parts as f64))
    });
    pairs.chain([points[points.len() - 1][0]]).collect()
}

/// Pressure and conductance from 0 on, and beyond the end in proportion to the pressure.
fn conductances(sheet: &Sheet<'_>) -> Vec<[f64; 2]> {
    let end = sheet.conductance.last().map(|last| last.map(|value| BEYOND * value));
    sheet.conductance.iter().copied().chain(end).collect()
}

/// Value at a pressure, straight between points.
fn interpolated(points: &[[f64; 2]], pressure: f64) -> f64 {
    let above = points.iter().position(|[p, _]| *p >= pressure).unwrap_or(points.len() - 1).max(1);
    let ([p0, c0], [p1, c1]) = (points[above - 1], points[above]);
    c0 + (pressure - p0) / (p1 - p0) * (c1 - c0)
}

fn behavior(text: &mut String, points: &[[f64; 2]]) {
    *text += "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR\n";
    for [pressure, closure] in points {
        let _ = writeln!(text, "{}, {}", number(*pressure), number(*closure));
    }
}

fn friction(text: &mut String, sheet: &Sheet<'_>) {
    if let (Some(friction), Some([_, stiffness])) = (sheet.settings.friction, sheet.tangential_stiffness()) {
        let _ = writeln!(text, "*FRICTION\n{}, {}", number(friction), number(stiffness));
    }
}
