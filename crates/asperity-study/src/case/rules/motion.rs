//! Rules of motions, and of sliding in place.

use super::super::{ControlKind, CounterBody, Prescribed, Source};
use super::Rule;
use super::examples::{AT_ANY_SPEED, CHANGES, JUMPS, MOVES, SLIDES, SWEEP};
use asperity_contact::motion::OffsetY;

pub(super) const RULES: &[Rule] = &[
    Rule {
        this: "`strategy = \"overlap\"`",
        with: "a boundary periodic along x",
        message: "strategy = \"overlap\" needs a boundary that is free along x",
        hint: "use `boundary = \"free\"` or `[\"free\", \"periodic\"]`, or `strategy = \"shift\"` under [motion]",
        at: "contact.boundary",
        example: &[r#"contact = { load = "2 N", boundary = "periodic" }"#, AT_ANY_SPEED],
        broken: |tables| {
            tables.overlap().filter(|_| tables.case.contact.boundary.repeats(0))?;
            tables.at("motion.strategy").or(tables.at("contact.boundary"))
        },
    },
    Rule {
        this: "`speed_lower`, `speed_upper`",
        with: "`strategy = \"overlap\"`",
        message: "'{key}' applies to strategy = \"shift\" only",
        hint: "give `speed` in an overlap, or set `strategy = \"shift\"`",
        at: "motion.speed_upper",
        example: &[r#"motion = { speed_upper = "10 mm/s" }"#],
        broken: |tables| {
            tables.overlap()?;
            tables.first("motion", &["speed_lower", "speed_upper"])
        },
    },
    Rule {
        this: "`speed`",
        with: "`strategy = \"shift\"`",
        message: "'speed' applies to strategy = \"overlap\" only",
        hint: "give `speed_lower` and `speed_upper`",
        at: "motion.speed",
        example: &[r#"motion = { strategy = "shift", speed = "10 mm/s" }"#],
        broken: |tables| {
            tables.shift()?;
            tables.at("motion.speed")
        },
    },
    Rule {
        this: "`offset_y`",
        with: "a boundary free along y",
        message: "'offset_y' needs a boundary that is periodic along y",
        hint: "set `boundary = [\"free\", \"periodic\"]` or `\"periodic\"` in [contact], or leave 'offset_y' out",
        at: "motion.offset_y",
        example: &["motion = { offset_y = 3 }"],
        broken: |tables| {
            tables.motion().filter(|motion| motion.offset_y() != OffsetY::NONE)?;
            tables.at("motion.offset_y").filter(|_| !tables.case.contact.boundary.repeats(1))
        },
    },
    Rule {
        this: "`seed` in [motion]",
        with: "an `offset_y` that is not `\"random\"`",
        message: "'seed' needs offset_y = \"random\"",
        hint: "set `offset_y = \"random\"`, or leave 'seed' out",
        at: "motion.seed",
        example: &["motion = { seed = 7 }"],
        broken: |tables| {
            tables.motion().filter(|motion| !matches!(motion.offset_y(), OffsetY::Random { .. }))?;
            tables.at("motion.seed")
        },
    },
    Rule {
        this: "`control = \"approach\"`",
        with: "a `load` or `mean_pressure`",
        message: "'control' is {value}, expected \"pass-load\" or \"step-load\", as [contact] gives a load",
        hint: "or give `approach` under [contact] instead of the load",
        at: "motion.control",
        example: &[r#"motion = { control = "approach" }"#],
        broken: |tables| {
            tables.motion().filter(|motion| motion.control() == ControlKind::Approach)?;
            let is_load = !matches!(tables.case.contact.prescribed(), Prescribed::Approach(_));
            tables.at("motion.control").filter(|_| is_load)
        },
    },
    Rule {
        this: "`control = \"pass-load\"`, `\"step-load\"`",
        with: "an `approach`",
        message: "'control' is {value}, expected \"approach\", as [contact] gives an approach",
        hint: "or give `load` or `mean_pressure` under [contact] instead of the approach",
        at: "motion.control",
        example: &[r#"contact = { approach = "10 nm" }"#, r#"motion = { control = "pass-load" }"#],
        broken: |tables| {
            tables.motion().filter(|motion| motion.control() != ControlKind::Approach)?;
            let is_load = !matches!(tables.case.contact.prescribed(), Prescribed::Approach(_));
            tables.at("motion.control").filter(|_| !is_load)
        },
    },
    Rule {
        this: "`counter = \"fresh\"`",
        with: "an upper topography that is not generated",
        message: "counter = \"fresh\" needs a generated upper surface",
        hint: "give [upper.topography] a `generate`, or set `counter = \"same\"`",
        at: "motion.counter",
        example: &[r#"motion = { counter = "fresh" }"#],
        broken: |tables| {
            tables.motion().filter(|motion| motion.counter == CounterBody::Fresh)?;
            let is_generated = matches!(tables.case.upper.topography.source, Source::Generate { .. });
            tables.at("motion.counter").filter(|_| !is_generated)
        },
    },
    Rule {
        this: "[sliding]",
        with: "[motion]",
        message: "[sliding] and [motion] are both given, expected one of them",
        hint: "in [sliding] the same cells stay opposite each other; in a [motion] one surface passes over the other",
        at: "sliding",
        example: &[CHANGES, SLIDES, MOVES],
        broken: |tables| tables.at("motion").and(tables.at("sliding")),
    },
    Rule {
        this: "[sliding]",
        with: "[[history]]",
        message: "[sliding] does not take a [[history]]",
        hint: "the load or approach in [contact] holds over the whole distance",
        at: "sliding",
        example: &[CHANGES, SLIDES, r#"history = [{ load = "1 N" }]"#],
        broken: |tables| tables.at("history").and(tables.at("sliding")),
    },
    Rule {
        this: "[sliding]",
        with: "a sweep",
        message: "[sliding] does not take '{key}'",
        hint: "give one `load`, `mean_pressure` or `approach`",
        at: "contact.loads",
        example: &[CHANGES, SWEEP, SLIDES],
        broken: |tables| tables.at("sliding").and(tables.sweep()),
    },
    Rule {
        this: "[sliding]",
        with: "[acceleration]",
        message: "[acceleration] needs [motion]",
        hint: "set `updates` in [sliding], or leave [acceleration] out",
        at: "acceleration",
        example: &[CHANGES, SLIDES, JUMPS],
        broken: |tables| tables.at("sliding").and(tables.at("acceleration")),
    },
    Rule {
        this: "[sliding]",
        with: "bodies without wear or a film",
        message: "[sliding] needs a body with wear or a film",
        hint: "give a body `[lower.wear]` or `[lower.film]`, or leave [sliding] out",
        at: "sliding",
        example: &[SLIDES],
        broken: |tables| tables.at("sliding").filter(|_| !tables.case.runs_in()),
    },
];
