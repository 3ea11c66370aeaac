//! Rules of lubricated bodies.

use std::iter::once;

use super::super::{Body, Case, CounterBody, Layer, Source};
use super::Rule;
use super::examples::{AT_ANY_SPEED, GENERATED, OIL, RUBS, SLIDES, SWEEP};
use asperity_contact::motion::Strategy;
use asperity_surface::{Axis, Form};

/// Tables that a film of oil excludes.
const OTHERS: [&str; 4] = ["sliding", "history", "steady", "adhesion"];

/// Bodies that pass over each other by a shift.
const SHIFTS: &str = r#"motion = { strategy = "shift", speed_lower = 1, speed_upper = 0 }"#;

/// Keys of a steady film.
const STEADY: [&str; 3] = ["speed", "speeds", "sliding"];

/// An oil between bodies that pass over each other.
const BETWEEN: &str = r#"lubrication = { viscosity = "40 mPa s", pressure_viscosity = "20 1/GPa" }"#;

pub(super) const RULES: &[Rule] = &[
    Rule {
        this: "[lubrication]",
        with: "[friction]",
        message: "[lubrication] does not take [friction]",
        hint: "give the friction coefficient of solids that touch as `boundary_friction` in [lubrication]",
        at: "friction",
        example: &[OIL, RUBS],
        broken: |tables| tables.at("lubrication").and(tables.at("friction")),
    },
    Rule {
        this: "[lubrication]",
        with: "[sliding], [[history]], [steady], [adhesion], and what is computed from dry contacts",
        message: "[lubrication] does not support [{key}]",
        hint: "a film is steady, with a `speed` in [lubrication], or follows a [motion]",
        at: "sliding",
        example: &[OIL, SLIDES],
        broken: |tables| {
            tables.at("lubrication")?;
            OTHERS.iter().find_map(|table| tables.at(table)).or_else(|| tables.of_single_contacts())
        },
    },
    Rule {
        this: "[lubrication]",
        with: "no `speed`, no `speeds`, and no [motion]",
        message: "a film needs a speed",
        hint: "give `speed` or `speeds` in [lubrication], or a [motion]",
        at: "lubrication",
        example: &[BETWEEN],
        broken: |tables| {
            let steady = tables.first("lubrication", &STEADY[..2]);
            tables.at("lubrication").filter(|_| steady.is_none() && tables.motion().is_none())
        },
    },
    Rule {
        this: "`speed`, `speeds`, `sliding` in [lubrication]",
        with: "[motion]",
        message: "'{key}' of [lubrication] has no meaning with [motion]",
        hint: "the speeds are `speed_lower` and `speed_upper` in [motion]",
        at: "lubrication.speed",
        example: &[OIL, SHIFTS],
        broken: |tables| tables.motion().and(tables.first("lubrication", &STEADY)),
    },
    Rule {
        this: "[motion] of lubricated bodies",
        with: "no speed, or speeds that cancel",
        message: "lubricated bodies that pass over each other need a speed that entrains the oil",
        hint: "give `speed = \"0.2 m/s\"`, or of a shift `speed_lower` and `speed_upper`, whose mean is not 0",
        at: "motion",
        example: &[BETWEEN, AT_ANY_SPEED],
        broken: |tables| {
            tables.at("lubrication")?;
            let motion = tables.motion()?;
            let entrains = match motion.strategy() {
                Strategy::Overlap => motion.speed.is_some(),
                Strategy::Shift { speed_lower, speed_upper } => {
                    let given = tables.first("motion", &["speed_lower", "speed_upper"]).is_some();
                    given && speed_lower + speed_upper != 0.0
                }
            };
            tables.at("motion").filter(|_| !entrains)
        },
    },
    Rule {
        this: "[motion] of lubricated bodies by a shift",
        with: "a form, curved along x, that moves",
        message: "the form of a lubricated body stands still in a shift: it does not pass through the grid",
        hint: "set its speed to 0 and move the other body; smooth bodies that roll have a steady film, with `sliding` in [lubrication]",
        at: "motion.speed_upper",
        example: &[
            BETWEEN,
            r#"upper.topography = { form = "sphere", radius = "1 mm" }"#,
            r#"motion = { strategy = "shift", speed_upper = 1 }"#,
        ],
        broken: |tables| {
            tables.at("lubrication")?;
            let Strategy::Shift { speed_lower, speed_upper } = tables.motion()?.strategy() else {
                return None;
            };
            let moves = |body: &Body, speed: f64| speed != 0.0 && is_curved(body);
            let Case { lower, upper, .. } = tables.case;
            match [moves(lower, speed_lower), moves(upper, speed_upper)] {
                [_, true] => tables.at("motion.speed_upper").or(tables.at("motion")),
                [true, _] => tables.at("motion.speed_lower"),
                _ => None,
            }
        },
    },
    Rule {
        this: "[motion] of lubricated bodies",
        with: "`counter = \"fresh\"`, a flash temperature",
        message: "passes of lubricated bodies do not support '{key}'",
        hint: "",
        at: "motion.counter",
        example: &[BETWEEN, r#"motion = { speed = "0.2 m/s", counter = "fresh" }"#, GENERATED],
        broken: |tables| {
            tables.at("lubrication").and(tables.motion())?;
            let fresh = tables.motion().is_some_and(|motion| motion.counter == CounterBody::Fresh);
            let counter = tables.at("motion.counter").filter(|_| fresh);
            tables.flash().or(counter)
        },
    },
    Rule {
        this: "[lubrication]",
        with: "[lower.viscoelastic], [upper.viscoelastic]",
        message: "[lubrication] does not support viscoelastic bodies",
        hint: "",
        at: "lower.viscoelastic",
        example: &[OIL, r#"lower.viscoelastic = { moduli = ["1 GPa"], times = ["1 s"] }"#],
        broken: |tables| tables.at("lubrication").and(tables.viscoelastic()),
    },
    Rule {
        this: "[lubrication]",
        with: "a sweep",
        message: "[lubrication] does not take '{key}'",
        hint: "give one `load`, `mean_pressure` or `approach`; the films follow each other by `speeds`",
        at: "contact.loads",
        example: &[OIL, SWEEP],
        broken: |tables| tables.at("lubrication").and(tables.sweep()),
    },
    Rule {
        this: "[lubrication]",
        with: "two rough bodies and no [motion]",
        message: "a steady film needs a smooth body, which moves: between two rough ones no film is steady",
        hint: "give one of them a `form` such as \"flat\" or \"sphere\", or a [motion]",
        at: "upper.topography",
        example: &[
            OIL,
            GENERATED,
            r#"lower.topography = { generate = "low-pass", shape = [32, 32], pitch = "1 um", sq = "0.1 um", cutoff = "8 um" }"#,
        ],
        broken: |tables| {
            tables.at("lubrication")?;
            let both = is_rough(&tables.case.lower) && is_rough(&tables.case.upper);
            tables.at("upper.topography").filter(|_| both && tables.motion().is_none())
        },
    },
    Rule {
        this: "`oil` in [lubrication]",
        with: "no [temperature]",
        message: "an oil by its name needs the temperature of the bodies",
        hint: "add `[temperature]` with `bulk = \"40 °C\"`",
        at: "lubrication.oil",
        example: &[r#"lubrication = { oil = "ISO VG 46", speed = "0.1 m/s" }"#],
        broken: |tables| tables.at("lubrication.oil").filter(|_| tables.case.temperature.is_none()),
    },
    Rule {
        this: "`sliding` in [lubrication]",
        with: "a rough body",
        message: "'sliding' needs two smooth bodies: a rough one is at rest in a steady film",
        hint: "leave `sliding` out: the smooth body has twice the mean `speed`",
        at: "lubrication.sliding",
        example: &[
            GENERATED,
            r#"lubrication = { viscosity = "40 mPa s", pressure_viscosity = "20 1/GPa", speed = "0.1 m/s", sliding = "0.02 m/s" }"#,
        ],
        broken: |tables| {
            let rough = is_rough(&tables.case.lower) || is_rough(&tables.case.upper);
            tables.at("lubrication.sliding").filter(|_| rough)
        },
    },
];

/// Returns the forms of which the surface of a body consists, and `None` for each part of it that is no form.
fn forms(body: &Body) -> impl Iterator<Item = Option<&Form>> {
    let first = match &body.topography.source {
        Source::Form { form, .. } => Some(form),
        _ => None,
    };
    let others = body.topography.plus.iter().map(|layer| match layer {
        Layer::Form { form } => Some(form),
        Layer::Generate { .. } => None,
    });
    once(first).chain(others)
}

/// Whether a form has many crests.
fn has_waves(form: &Form) -> bool {
    matches!(form, Form::Sinusoid { .. } | Form::Grooves { .. })
}

/// Whether the surface of a body is curved as a whole along x, by a form.
fn is_curved(body: &Body) -> bool {
    let is_straight = |form: &Form| matches!(form, Form::Flat | Form::Cylinder { axis: Axis::X, .. });
    forms(body).flatten().any(|form| !is_straight(form) && !has_waves(form))
}

/// Whether a film changes where the body moves on: unless its form may turn with it.
fn is_rough(body: &Body) -> bool {
    forms(body).any(|form| form.is_none_or(has_waves))
}
