//! Rules of temperatures.

use super::super::CounterBody;
use super::Rule;
use super::examples::{
    AT_ANY_SPEED, CHANGES, CONDUCTS, GENERATED, LINE, MOVES, RUBS, SLIDES, UPPER_CONDUCTS, WARM,
};
use asperity_contact::with::uses;

pub(super) const RULES: &[Rule] = &[
    Rule {
        this: "thermal constants of [lower]",
        with: "no thermal constants of [upper]",
        message: "[lower] has thermal constants, but [upper] has none",
        hint: "give [upper] thermal constants too: both bodies conduct heat",
        at: "lower.conductivity",
        example: &[CONDUCTS, MOVES, WARM],
        broken: |tables| {
            let alone = tables.case.lower.thermal.is_some() && tables.case.upper.thermal.is_none();
            tables.at("lower.conductivity").filter(|_| alone)
        },
    },
    Rule {
        this: "thermal constants of [upper]",
        with: "no thermal constants of [lower]",
        message: "[upper] has thermal constants, but [lower] has none",
        hint: "give [lower] thermal constants too: both bodies conduct heat",
        at: "upper.conductivity",
        example: &[UPPER_CONDUCTS, MOVES, WARM],
        broken: |tables| {
            let alone = tables.case.upper.thermal.is_some() && tables.case.lower.thermal.is_none();
            tables.at("upper.conductivity").filter(|_| alone)
        },
    },
    Rule {
        this: "thermal constants",
        with: "no [temperature]",
        message: "thermal constants need [temperature]",
        hint: "add `[temperature]` with `bulk = \"100 °C\"`",
        at: "lower.conductivity",
        example: &[CONDUCTS, UPPER_CONDUCTS],
        broken: |tables| {
            let uses = uses("conductivity", |name| tables.at(name).is_some());
            let is_needed = tables.case.lower.thermal.is_some() && !uses;
            tables.at("lower.conductivity").filter(|_| is_needed && tables.case.temperature.is_none())
        },
    },
    Rule {
        this: "[temperature]",
        with: "a static contact",
        message: "[temperature] needs [motion], [sliding], bodies with wear or a film that slip, viscoelastic ones with `wlf_c1`, or an `oil`",
        hint: "",
        at: "temperature",
        example: &[WARM],
        broken: |tables| {
            let changes = tables.slides() || tables.frets() && tables.case.runs_in();
            let depends = tables.shifted().or(tables.at("lubrication.oil"));
            tables.at("temperature").filter(|_| !changes && depends.is_none())
        },
    },
    Rule {
        this: "a flash temperature",
        with: "stages without `cycles` and their `period`",
        message: "a flash temperature of stages is that of their cycles, whose time must be known",
        hint: "give a stage of the [[history]] `cycles` and a `period`, set `every = 0`, or leave the thermal constants out",
        at: "temperature.every",
        example: &[
            CHANGES,
            RUBS,
            r#"history = [{ force = "0.1 N", cycles = 10 }]"#,
            r#"temperature = { bulk = "100 °C", every = 1 }"#,
        ],
        broken: |tables| {
            let stages = &tables.case.history;
            let cycles = || stages.iter().filter(|stage| stage.cycles.is_some());
            let timed = cycles().next().is_some() && cycles().all(|stage| stage.period.is_some());
            tables.flash().filter(|_| !tables.slides() && !timed)
        },
    },
    Rule {
        this: "`every` above 1",
        with: "[sliding], [[history]]",
        message: "'every' is {value}, expected 1 (a flash temperature at each update or cycle) or 0 (none)",
        hint: "",
        at: "temperature.every",
        example: &[CHANGES, SLIDES, r#"temperature = { bulk = "100 °C", every = 3 }"#],
        broken: |tables| tables.seldom().filter(|_| tables.motion().is_none()),
    },
    Rule {
        this: "`every` above 1",
        with: "`counter = \"fresh\"`",
        message: "'every' is {value}, expected 1 or 0 with counter = \"fresh\"",
        hint: "",
        at: "temperature.every",
        example: &[
            GENERATED,
            r#"motion = { speed = "0.5 m/s", counter = "fresh" }"#,
            r#"temperature = { bulk = "100 °C", every = 2 }"#,
        ],
        broken: |tables| {
            tables.motion().filter(|motion| motion.counter == CounterBody::Fresh)?;
            tables.seldom()
        },
    },
    Rule {
        this: "a flash temperature",
        with: "no thermal constants",
        message: "a flash temperature needs thermal constants",
        hint: "give both bodies `conductivity`, `heat_capacity` and `density`, or set `every = 0`",
        at: "temperature.every",
        example: &[RUBS, MOVES, r#"temperature = { bulk = "100 °C", every = 1 }"#],
        broken: |tables| tables.flash().filter(|_| tables.case.lower.thermal.is_none()),
    },
    Rule {
        this: "a flash temperature",
        with: "no [friction]",
        message: "a flash temperature needs [friction]",
        hint: "add a [friction] table, or set `every = 0`",
        at: "temperature",
        example: &[CONDUCTS, UPPER_CONDUCTS, MOVES, WARM],
        broken: |tables| tables.flash().filter(|_| tables.case.friction.is_none()),
    },
    Rule {
        this: "a flash temperature in [sliding], [[history]]",
        with: "a boundary periodic along one axis alone",
        message: "a flash temperature at rest needs a boundary that is free or periodic along both axes",
        hint: "use \"free\" or \"periodic\", or set `every = 0`",
        at: "contact.boundary",
        example: &[
            CONDUCTS,
            CHANGES,
            UPPER_CONDUCTS,
            RUBS,
            r#"sliding = { distance = "1 m", speed = "1 m/s" }"#,
            WARM,
            LINE,
        ],
        broken: |tables| tables.flash().filter(|_| tables.motion().is_none()).and(tables.line()),
    },
    Rule {
        this: "a flash temperature in [sliding]",
        with: "no `speed`",
        message: "a flash temperature needs a speed",
        hint: "for example `speed = \"10 mm/s\"` in [sliding]",
        at: "temperature",
        example: &[CONDUCTS, CHANGES, UPPER_CONDUCTS, RUBS, SLIDES, WARM],
        broken: |tables| {
            tables.flash().filter(|_| tables.case.sliding.is_some_and(|sliding| sliding.speed.is_none()))
        },
    },
    Rule {
        this: "a flash temperature in an overlap",
        with: "no `speed`",
        message: "a flash temperature needs a speed",
        hint: "for example `speed = \"0.5 m/s\"` in [motion]",
        at: "temperature",
        example: &[CONDUCTS, UPPER_CONDUCTS, RUBS, AT_ANY_SPEED, WARM],
        broken: |tables| {
            tables.flash().filter(|_| tables.overlap().is_some_and(|motion| motion.speed.is_none()))
        },
    },
    Rule {
        this: "a flash temperature in a shift",
        with: "a boundary that is free along x",
        message: "a flash temperature in a shift needs a boundary that is periodic along x",
        hint: "set `boundary = \"periodic\"` in [contact], or `every = 0`",
        at: "temperature",
        example: &[
            CONDUCTS,
            UPPER_CONDUCTS,
            RUBS,
            r#"motion = { strategy = "shift", speed_upper = "0.5 m/s" }"#,
            WARM,
        ],
        broken: |tables| {
            tables.shift().filter(|_| !tables.case.contact.boundary.repeats(0))?;
            tables.flash()
        },
    },
];
