//! The flow through a gap in words, curves and maps.

use super::{Along, FlowRecord, Leakage};
use crate::surface::Axis;
use crate::units::{Dimension, Metre, format, format_number};
use crate::with::Surroundings;
use crate::with::views::{Curve, Line, Map, Scale, Series};
use asperity_base::Choice;

/// Leakage along both axes.
pub(super) const CURVES: &[Curve<FlowRecord>] = &[Curve {
    names: ["leakage", "leakage_positions"],
    title: "leakage",
    column: |_| "leakage",
    series: &[
        Series {
            name: "along x",
            has: |row| row.along == Axis::X,
            value: |row| Some(row.leakage),
            is_dashed: false,
            is_beside: false,
            may_end: true,
        },
        Series {
            name: "along y",
            has: |row| row.along == Axis::Y,
            value: |row| Some(row.leakage),
            is_dashed: true,
            is_beside: false,
            may_end: true,
        },
    ],
}];

/// Smallest flow with a colour of its own over the largest: dead ends carry next to nothing.
pub const LEAST_FLOW: f64 = 1e-6;
/// Name of the critical constriction on a map.
pub const CONSTRICTION: &str = "critical constriction";
/// Titles of the maps of a flow along x and along y.
pub const TITLES: [&str; 2] = [
    "flow through the gap under a pressure that falls along x",
    "flow through the gap under a pressure that falls along y",
];

/// The flow along each axis, with the critical constriction.
pub(super) const MAPS: &[Map<FlowRecord>] = &[
    Map {
        field: "flow_x",
        title: TITLES[0],
        quantity: "flow per width",
        unit: |_| "m²/s",
        scale: Scale::Logarithmic(LEAST_FLOW),
        mark: constriction,
        marked: CONSTRICTION,
    },
    Map {
        field: "flow_y",
        title: TITLES[1],
        quantity: "flow per width",
        unit: |_| "m²/s",
        scale: Scale::Logarithmic(LEAST_FLOW),
        mark: constriction,
        marked: CONSTRICTION,
    },
];

/// The critical constriction of the flow that a field belongs to.
fn constriction(row: &FlowRecord, field: &str) -> Option<[Metre; 2]> {
    row.constriction().filter(|_| field.ends_with(row.along.word()))
}

pub(super) fn describe(leakage: &Leakage, surroundings: &Surroundings) -> String {
    let (viscosity, pressure) =
        (format(leakage.viscosity, Dimension::Viscosity), format(leakage.pressure, Dimension::Pressure));
    let kind = if leakage.gas { "a gas" } else { "a liquid" };
    let ends = |axis| leakage.ends_along(axis, surroundings.boundary).word();
    let ends = match leakage.along {
        Along::X => ends(0).to_owned(),
        Along::Y => ends(1).to_owned(),
        Along::Both if ends(0) == ends(1) => ends(0).to_owned(),
        Along::Both => format!("{} along x and {} along y", ends(0), ends(1)),
    };
    let often = surroundings.often(leakage.every);
    format!("{kind} of {viscosity} under {pressure}, ends {ends}; {often}")
}

pub(super) fn numbers(row: &FlowRecord) -> Vec<Line> {
    let name = format!("leakage along {}", row.along.word());
    let value = format(row.leakage, Dimension::VolumeFlow);
    let mut lines = leaks(name, value, row.critical_gap, row.constriction(), row.estimate);
    if row.leakage > 0.0 {
        let medium = format_number(row.effective_medium / row.mean_gap.powi(3));
        let factor = format!("{}, an effective medium has {medium}", format_number(row.flow_factor));
        lines.push(Line::detail("flow factor", factor));
    }
    let trapped = format(row.trapped_volume, Dimension::Volume);
    let flowing = format_number((1000.0 * row.flowing_share).round() / 10.0);
    lines.push(Line::detail("trapped", format!("{trapped}; {flowing} % of the cells are part of a path")));
    lines
}

/// Describes a leakage or a permeability, and the critical constriction and its place.
pub fn leaks(
    name: String,
    value: String,
    critical_gap: Metre,
    place: Option<[Metre; 2]>,
    estimate: f64,
) -> Vec<Line> {
    if critical_gap == 0.0 {
        return vec![Line::new(name, "none: no path through the gap")];
    }
    let length = |value| format(value, Dimension::Length);
    let place = place.map_or(String::new(), |[x, y]| format!(" at x = {}, y = {}", length(x), length(y)));
    let within = format_number((1000.0 * estimate).ceil() / 10.0);
    let constriction = format!("gap {}{place}; permeability within {within} %", length(critical_gap));
    vec![Line::new(name, value), Line::new("constriction", constriction)]
}
