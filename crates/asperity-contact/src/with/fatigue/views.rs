//! Fatigue in words, curves and maps.

use super::maps::{logarithmic, map};
use super::{Fatigue, FatigueRecord, OnBody, critical};
use crate::motion::StepCell;
use crate::units::{Dimension, format, format_number};
use crate::with::views::{Answer, Curve, Line, Map, OverPressure, Series, percent};
use crate::with::{Surroundings, of_last};
use asperity_base::Choice;

/// f over its limit, damage, life and pits of both bodies.
pub(super) const CURVES: &[Curve<FatigueRecord>] = &[
    Curve {
        names: ["over_limit", "over_limit_bodies"],
        title: "largest f over its limit",
        caption: "Dang Van's f at the point that fatigues most. Below 1 nothing fails in the end.",
        column: |_| "over_limit",
        series: &[
            of_body("lower body", OnBody::Lower, |row| Some(row.over_limit)),
            of_body("upper body", OnBody::Upper, |row| Some(row.over_limit)),
        ],
    },
    Curve {
        names: ["damage", "damage_bodies"],
        title: "largest damage so far",
        caption: "A point fails at 1. Removal and pits take damaged material away.",
        column: |_| "damage",
        series: &[
            of_body("lower body", OnBody::Lower, |row| Some(row.damage)),
            of_body("upper body", OnBody::Upper, |row| Some(row.damage)),
        ],
    },
    Curve {
        names: ["life", "life_bodies"],
        title: "life",
        caption: "Pass or cycle in which a point first fails if all go on like this one and nothing is removed.",
        column: |_| "life",
        series: &[
            of_body("lower body", OnBody::Lower, |row| row.life),
            of_body("upper body", OnBody::Upper, |row| row.life),
        ],
    },
    Curve {
        names: ["pitted_share", "pitted_share_bodies"],
        title: "share of the surface that has pitted",
        caption: "Share of the columns of cells that have broken out so far.",
        column: |_| "pitted_share",
        series: &[
            of_body("lower body", OnBody::Lower, |row| row.pitted_share),
            of_body("upper body", OnBody::Upper, |row| row.pitted_share),
        ],
    },
];

const fn of_body(
    name: &'static str,
    body: OnBody,
    value: fn(&FatigueRecord) -> Option<f64>,
) -> Series<FatigueRecord> {
    let (has, is_dashed): (fn(&FatigueRecord) -> bool, bool) = match body {
        OnBody::Lower => (|row| row.body == OnBody::Lower, false),
        OnBody::Upper => (|row| row.body == OnBody::Upper, true),
    };
    Series { name, has, value, is_dashed, is_beside: false, over_pressure: OverPressure::Nothing }
}

const F: &str = "The largest f over the depths, over its limit: where it is below 1, nothing fails in the end. The cross marks the largest.";
const SECTION: &str = "f over its limit below the row of cells with the largest f, which the cross marks. z points into the body. Layers, which are not looked at, have 0.";
const DAMAGE: &str = "The largest damage over the depths so far. A point fails at 1.";

/// f, the damage, and the removal that is faster, of both bodies.
pub(super) const MAPS: &[Map<FatigueRecord>] = &[
    over_limit("over_limit_lower", "Dang Van's f over its limit in the lower body"),
    over_limit("over_limit_upper", "Dang Van's f over its limit in the upper body"),
    logarithmic("damage_lower", "largest damage so far in the lower body", DAMAGE, "damage", |_| "1"),
    logarithmic("damage_upper", "largest damage so far in the upper body", DAMAGE, "damage", |_| "1"),
    critical::needed(0),
    critical::needed(1),
    critical::lacking(0),
    critical::lacking(1),
    section("over_limit_section_lower", "section through the largest f of the lower body"),
    section("over_limit_section_upper", "section through the largest f of the upper body"),
];

const fn over_limit(field: &'static str, title: &'static str) -> Map<FatigueRecord> {
    Map { mark: most, ..map(field, title, F, "f/b") }
}

const fn section(field: &'static str, title: &'static str) -> Map<FatigueRecord> {
    Map { is_section: true, mark: deepest, ..map(field, title, SECTION, "f/b") }
}

/// The place of the largest f on a section of its body.
fn deepest(row: &FatigueRecord, field: &str) -> Option<[f64; 2]> {
    field.ends_with(row.body.word()).then_some([row.x, row.depth])
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
        let below = if body.material.is_layered() { ", below its layers," } else { "" };
        Some(format!("the {name} body{below} from {torsion} in torsion and {tension} in tension"))
    });
    let often = match (surroundings.moves, fatigue.every) {
        (false, 1) => "at each increment of a cycle".to_owned(),
        (false, every) => format!("at one of {every} increments of a cycle"),
        (true, every) => surroundings.often(every),
    };
    let to = format(fatigue.to, Dimension::Length);
    let depths =
        if fatigue.layers == 1 { "one depth".to_owned() } else { format!("{} depths", fatigue.layers) };
    format!("{}; {depths} to {to}, {often}", limits.collect::<Vec<_>>().join(", "))
}

/// The load cycle of a row, in a word.
fn word(row: &FatigueRecord) -> &'static str {
    if row.cycle.is_some() { "cycle" } else { "pass" }
}

pub(super) fn answers(rows: &[FatigueRecord]) -> Vec<Answer> {
    of_last(rows).map(answer).collect()
}

fn answer(row: &FatigueRecord) -> Answer {
    let body = row.body.word();
    let value = format_number(row.over_limit);
    let depth = format(row.depth, Dimension::Length);
    let within = if row.over_limit < 1.0 && row.life.is_some() { ", within the limit" } else { "" };
    let found = format!("In the {body} body the largest f/b is {value}, {depth} deep{within}");
    let sentence = match (row.pitted_share.filter(|share| *share > 0.0), row.life) {
        (Some(pitted), _) => format!("{found}: {} of its surface has pitted.", percent(pitted)),
        (None, Some(life)) => format!("{found}: {}", row.critical.outlook(life, word(row))),
        (None, None) => format!("{found}: no fatigue within the limit."),
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

pub(super) fn cells(rows: &[FatigueRecord]) -> Vec<StepCell> {
    let most = |value: fn(&FatigueRecord) -> Option<f64>| rows.iter().filter_map(value).reduce(f64::max);
    let cell = |head, column, value| StepCell { head, column: Some(column), value };
    vec![
        cell("f/b", "over_limit", most(|row| Some(row.over_limit))),
        cell("damage", "damage", most(|row| Some(row.damage))),
        StepCell { head: "pitted", column: None, value: most(|row| row.pitted_share) },
    ]
}

pub(super) fn numbers(row: &FatigueRecord) -> Vec<Line> {
    let body = row.body.word();
    let length = |value| format(value, Dimension::Length);
    let place = format!("{} deep at x = {}, y = {}", length(row.depth), length(row.x), length(row.y));
    let mut lines = vec![
        Line::new(format!("f/b of the {body} body"), format!("{}, {place}", format_number(row.over_limit))),
        Line::new(
            format!("damage, {body}"),
            format!(
                "{} so far, {} of this {}",
                format_number(row.damage),
                format_number(row.damage_of_pass),
                word(row)
            ),
        ),
        Line::new(
            format!("life, {body}"),
            row.life.map_or_else(
                || "no point fails within the limit".to_owned(),
                |life| {
                    let (word, number) = (word(row), format_number(life.max(1.0).round()));
                    format!(
                        "a point fails in {word} {number}, if all go on like this one and nothing is removed"
                    )
                },
            ),
        ),
    ];
    lines.extend(row.critical.line(body, word(row)));
    lines.extend(
        row.pitted_share
            .map(|share| Line::new(format!("pits, {body}"), format!("{} of the area", percent(share)))),
    );
    lines
        .extend(row.life_ratio.map(|ratio| {
            Line::new(format!("life over that of smooth bodies, {body}"), format_number(ratio))
        }));
    lines
}

/// Width of a free edge in cells.
const EDGE: usize = 2;
/// Largest f/b of many cycles.
const FEW_CYCLES: f64 = 2.0;
/// Largest ratio of a depth to the one above it that needs no warning.
const APART: f64 = 2.5;
/// Distance between two positions over the width of a spot that needs no warning.
const STRIDE: f64 = 0.25;

/// Plastic work of the last pass, over the largest of a pass, that bodies which have shaken down may have
/// left.
const STILL: f64 = 1e-3;

/// Returns reasons in the rows not to trust them.
pub(super) fn doubts(fatigue: &Fatigue, rows: &[FatigueRecord], surroundings: &Surroundings) -> Vec<String> {
    let mut doubts = Vec::new();
    if surroundings.moves && !surroundings.repeats {
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
    let work = most(|row| row.plastic_work.unwrap_or(0.0));
    let yields = |row: &FatigueRecord| row.plastic_work.is_some_and(|left| left > STILL * work);
    if of_last(rows).any(yields) {
        doubts.push(
            "the bodies still yield in the last pass: f is that of shakedown, with the residual stress as it is; compute more passes"
                .to_owned(),
        );
    }
    let limits = surroundings.bodies.iter().zip([OnBody::Lower, OnBody::Upper]);
    let limits = limits.filter_map(|(body, name)| Some((name, body.properties.fatigue.as_ref()?)));
    for (name, _) in limits.clone().filter(|(_, limits)| limits.pit_depth > fatigue.to) {
        doubts.push(format!(
            "pits of the {} body may be deeper than the largest depth, {}, below which the damage is not known: check the unit, or look deeper by a \
             larger `to`",
            name.word(),
            format(fatigue.to, Dimension::Length)
        ));
    }
    for (name, _) in limits.clone().filter(|(_, limits)| limits.pit_depth > 0.0) {
        if rows.iter().any(|row| row.body == name && row.pitted_share.is_none()) {
            doubts.push(format!(
                "nothing breaks out of the {} body: its pits are less deep than the first depth, half a cell; take deeper ones or smaller cells",
                name.word()
            ));
        }
    }
    if limits.clone().any(|(_, limits)| limits.risk) && !rows.iter().any(|row| row.life_ratio.is_some()) {
        doubts.push(
            "`risk` compares lives with those of the bodies without roughness under the same load, but these are flat, nothing is at risk, or \
             an approach is prescribed: it needs curved bodies under a load"
                .to_owned(),
        );
    }
    let of = if surroundings.moves { "pass" } else { "cycle" };
    if let Some(first) = fatigue.passes.iter().min().filter(|first| **first > 1 && !rows.is_empty()) {
        doubts.push(format!(
            "no {of} before {of} {first} is looked at, and none of them counts as damage: look at the first {of}, too"
        ));
    }
    if rows.is_empty() {
        doubts.push(format!("no {of} that was computed is among those whose fatigue is asked for"));
    }
    if rows.iter().any(|row| row.edge_cells.is_some_and(|cells| cells < EDGE)) {
        doubts.push(
            "the largest f is at a free edge of the grid, where the surfaces end and edges plough: `taper` the ends, add a sphere or a cylinder, or \
             let surfaces without ends pass under a periodic boundary"
                .to_owned(),
        );
    }
    let stride = most(|row| row.stride.unwrap_or(0.0));
    if stride > STRIDE {
        doubts.push(format!(
            "the bodies move by {} of the widest spot of contact between two positions whose stress is computed: points see less than the \
             largest stress",
            format_number(stride)
        ));
    }
    doubts
}
