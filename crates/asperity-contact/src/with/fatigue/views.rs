//! Fatigue in words, curves and maps.

use super::{Fatigue, FatigueRecord, OnBody};
use crate::units::{Dimension, format, format_number};
use crate::with::Surroundings;
use crate::with::views::{Answer, Curve, Line, Map, OverPressure, Scale, Series};
use asperity_base::Choice;

/// f over its limit, of both bodies.
pub(super) const CURVES: &[Curve<FatigueRecord>] = &[Curve {
    names: ["over_limit", "over_limit_bodies"],
    title: "largest f over its limit",
    caption: "Dang Van's f at the point that tires most. Below 1 nothing fails in the end.",
    column: |_| "over_limit",
    series: &[
        Series {
            name: "lower body",
            has: |row| row.body == OnBody::Lower,
            value: |row| Some(row.over_limit),
            is_dashed: false,
            is_beside: false,
            over_pressure: OverPressure::Nothing,
        },
        Series {
            name: "upper body",
            has: |row| row.body == OnBody::Upper,
            value: |row| Some(row.over_limit),
            is_dashed: true,
            is_beside: false,
            over_pressure: OverPressure::Nothing,
        },
    ],
}];

const F: &str = "The largest f over the depths, over its limit: where it is below 1, nothing fails in the end. The cross marks the largest.";
const WEAR: &str = "A column pits unless it loses more than this in each pass.";

/// f and the wear that is faster, of both bodies.
pub(super) const MAPS: &[Map<FatigueRecord>] = &[
    over_limit("over_limit_lower", "Dang Van's f over its limit in the lower body"),
    over_limit("over_limit_upper", "Dang Van's f over its limit in the upper body"),
    critical_wear("critical_wear_lower", "wear of a pass that saves the lower body"),
    critical_wear("critical_wear_upper", "wear of a pass that saves the upper body"),
];

const fn over_limit(field: &'static str, title: &'static str) -> Map<FatigueRecord> {
    Map {
        field,
        title,
        caption: F,
        quantity: "f/b",
        unit: |_| "1",
        scale: Scale::FromZeroOrLogarithmic,
        mark: most,
        marked: "largest f",
    }
}

const fn critical_wear(field: &'static str, title: &'static str) -> Map<FatigueRecord> {
    Map {
        field,
        title,
        caption: WEAR,
        quantity: "wear of a pass",
        unit: |_| "m",
        scale: Scale::Logarithmic(1e-4),
        mark: |_, _| None,
        marked: "",
    }
}

/// The place of the largest f, on the map of its body.
fn most(row: &FatigueRecord, field: &str) -> Option<[f64; 2]> {
    field.ends_with(row.body.word()).then_some([row.x, row.y])
}

pub(super) fn describe(fatigue: &Fatigue, surroundings: &Surroundings) -> String {
    let limits = surroundings.bodies.iter().zip(["lower", "upper"]).filter_map(|(body, name)| {
        let limits = body.properties.fatigue.as_ref()?;
        let [torsion, tension] =
            [limits.torsion, limits.tension].map(|limit| format(limit, Dimension::Pressure));
        Some(format!("the {name} body from {torsion} in torsion and {tension} in tension"))
    });
    let often = surroundings.often(fatigue.every);
    let to = format(fatigue.to, Dimension::Length);
    let depths =
        if fatigue.layers == 1 { "one depth".to_owned() } else { format!("{} depths", fatigue.layers) };
    format!("{}; {depths} to {to}, {often}", limits.collect::<Vec<_>>().join(", "))
}

pub(super) fn answers(rows: &[FatigueRecord]) -> Vec<Answer> {
    let last = rows.last().map(|row| row.pass);
    rows.iter().filter(|row| Some(row.pass) == last).map(answer).collect()
}

fn answer(row: &FatigueRecord) -> Answer {
    let body = row.body.word();
    let value = format_number(row.over_limit);
    let depth = format(row.depth, Dimension::Length);
    let sentence = if row.over_limit < 1.0 && row.damage == 0.0 {
        format!("In the {body} body the largest f/b is {value}, {depth} deep: no fatigue within the limit.")
    } else if row.damage > 0.0 {
        let wear = format(row.critical_wear, Dimension::Length);
        let passes = format_number((1.0 / row.damage).max(1.0).round());
        let within = if row.over_limit < 1.0 { ", within the limit" } else { "" };
        format!(
            "In the {body} body the largest f/b is {value}, {depth} deep{within}: it pits from pass {passes} on where wear is below {wear} a \
             pass."
        )
    } else {
        format!("In the {body} body the largest f/b is {value}, {depth} deep.")
    };
    Answer {
        name: format!("f/b of the {body} body").into(),
        about: format!(
            "Dang Van's f over its limit, {depth} below the surface; nothing fails in the end below 1."
        ),
        sentence,
        value,
    }
}

pub(super) fn numbers(row: &FatigueRecord) -> Vec<Line> {
    let body = row.body.word();
    let length = |value| format(value, Dimension::Length);
    let place = format!("{} deep at x = {}, y = {}", length(row.depth), length(row.x), length(row.y));
    vec![
        Line::new(format!("f/b of the {body} body"), format!("{}, {place}", format_number(row.over_limit))),
        Line::new(format!("damage of a pass, {body}"), format_number(row.damage)),
        Line::new(
            format!("wear that saves it, {body}"),
            format!(
                "{} a pass; {} % of the area needs a tenth of it or more",
                length(row.critical_wear),
                format_number((1000.0 * row.critical_share).round() / 10.0)
            ),
        ),
        Line::detail(format!("amplitude of σxz, {body}"), format(row.shear_amplitude, Dimension::Pressure)),
    ]
}

/// Width of a free edge in cells.
const EDGE: usize = 2;
/// Largest f/b of many cycles.
const FEW_CYCLES: f64 = 2.0;
/// Largest ratio of a depth to the one above it that needs no warning.
const APART: f64 = 2.5;
/// Distance between two positions over the width of a spot that needs no warning.
const STRIDE: f64 = 0.25;

/// Returns reasons in the rows not to trust them.
pub(super) fn doubts(fatigue: &Fatigue, rows: &[FatigueRecord], surroundings: &Surroundings) -> Vec<String> {
    let mut doubts = Vec::new();
    if !surroundings.repeats {
        doubts.push(
            "the bodies meet at other places in each pass, and f is that of a single pass: in a shift set one speed to 0, so that a pass has all \
             encounters"
                .to_owned(),
        );
    }
    let most = |value: fn(&FatigueRecord) -> f64| rows.iter().map(value).fold(0.0, f64::max);
    let over = most(|row| row.over_limit);
    if over > FEW_CYCLES {
        doubts.push(format!(
            "f reaches {} times its limit, where a material fails in few cycles and flows: the criterion is for many cycles",
            format_number(over)
        ));
    }
    if rows.iter().any(|row| row.depth >= 0.999 * fatigue.to) {
        doubts.push(format!(
            "the largest f is at the largest depth, {}: look deeper by a larger `to`",
            format(fatigue.to, Dimension::Length)
        ));
    }
    // Depths are geometric, and the first of them is no deeper than any other.
    let apart = most(|row| row.depth.recip()) * fatigue.to;
    let apart = apart.powf(1.0 / (fatigue.layers.max(2) - 1) as f64);
    if apart > APART {
        doubts.push(format!(
            "each depth is more than {} times the one above it, and the largest f may lie between two: give a smaller `to` or more `layers`",
            format_number(apart)
        ));
    }
    if rows.is_empty() {
        doubts.push("no pass that was computed is among those whose fatigue is asked for".to_owned());
    }
    if rows.iter().any(|row| row.edge_cells.is_some_and(|cells| cells < EDGE)) {
        doubts.push(
            "the largest f is at a free edge of the grid, where the surfaces end and edges plough: `taper` the ends, add a sphere or a cylinder, or \
             let surfaces without ends pass under a periodic boundary"
                .to_owned(),
        );
    }
    let stride = most(|row| row.stride);
    if stride > STRIDE {
        doubts.push(format!(
            "the bodies move by {} of the widest spot of contact between two positions whose stress is computed: points see less than the \
             largest stress",
            format_number(stride)
        ));
    }
    doubts
}
