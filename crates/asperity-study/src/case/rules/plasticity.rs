//! Rules of elasto-plastic bodies.

use super::super::CounterBody;
use super::Rule;
use super::examples::{AT_ANY_SPEED, CHANGES, COATED, FLOWS, GENERATED, LINE, ROLLS, SLIDES, SWEEP, VOLUME};

pub(super) const RULES: &[Rule] = &[
    Rule {
        this: "[plasticity]",
        with: "bodies without a plasticity",
        message: "[plasticity] needs an elasto-plastic body",
        hint: "give a body `[lower.plasticity]` with its `yield_stress`, or leave [plasticity] out",
        at: "plasticity",
        example: &[VOLUME],
        broken: |tables| tables.at("plasticity").filter(|_| !tables.flows()),
    },
    Rule {
        this: "a body's plasticity",
        with: "no [plasticity]",
        message: "missing table [plasticity]: [{path}] needs its `depth` and `layers`",
        hint: "for example `[plasticity]` with `depth = \"20 um\"` and `layers = 16`",
        at: "lower.plasticity",
        example: &[FLOWS],
        broken: |tables| tables.of_body("plasticity", |_| true).filter(|_| tables.case.plasticity.is_none()),
    },
    Rule {
        this: "a body's plasticity",
        with: "`young = inf` of the body",
        message: "a rigid body cannot be elasto-plastic",
        hint: "give it a finite 'young', or leave its plasticity out",
        at: "lower.plasticity",
        example: &["lower.young = inf", FLOWS, VOLUME],
        broken: |tables| tables.of_body("plasticity", |body| !body.material.young.is_finite()),
    },
    Rule {
        this: "a body's plasticity",
        with: "its `hardness`",
        message: "an elasto-plastic body does not take a 'hardness'",
        hint: "leave 'hardness' out, or the plasticity",
        at: "lower.hardness",
        example: &[r#"lower.hardness = "4 GPa""#, FLOWS, VOLUME],
        broken: |tables| {
            tables.of_body("hardness", |body| body.plasticity.is_some() && body.hardness.yields())
        },
    },
    Rule {
        this: "a body's plasticity",
        with: "its coating or layers",
        message: "a body with layers cannot be elasto-plastic yet",
        hint: "leave the layers or the plasticity out",
        at: "lower.plasticity",
        example: &[COATED, FLOWS, VOLUME],
        broken: |tables| tables.of_body("plasticity", |body| body.material.is_layered()),
    },
    Rule {
        this: "a body's plasticity",
        with: "a coating or layers of the other body",
        message: "a body with layers cannot meet an elasto-plastic body yet",
        hint: "leave the layers or the plasticity out",
        at: "upper.coating",
        example: &[
            FLOWS,
            r#"upper.coating = { thickness = "2 um", young = "300 GPa", poisson = 0.25 }"#,
            VOLUME,
        ],
        broken: |tables| {
            let layers = tables.of_body("coating", |_| true).or(tables.of_body("layers", |_| true));
            layers.filter(|_| tables.flows())
        },
    },
    Rule {
        this: "a body's plasticity",
        with: "[sliding]",
        message: "elasto-plastic bodies do not slide in place",
        hint: "leave the plasticity out, and give the bodies a `hardness`, or let them pass over each other in a [motion]",
        at: "sliding",
        example: &[FLOWS, CHANGES, VOLUME, SLIDES],
        broken: |tables| tables.at("sliding").filter(|_| tables.flows()),
    },
    Rule {
        this: "`unload` in [plasticity]",
        with: "a sweep",
        message: "'unload' applies to a single load",
        hint: "leave it out: each point of a sweep ends under its load",
        at: "plasticity.unload",
        example: &[FLOWS, r#"plasticity = { depth = "20 um", layers = 16, unload = true }"#, SWEEP],
        broken: |tables| tables.sweep().and(tables.at("plasticity.unload")),
    },
    Rule {
        this: "a body's plasticity",
        with: "a boundary periodic along one axis only",
        message: "elasto-plastic bodies do not support a boundary that is periodic along one axis only",
        hint: "use \"free\" or \"periodic\", or give the bodies a `hardness`",
        at: "contact.boundary",
        example: &[FLOWS, VOLUME, LINE],
        broken: |tables| tables.line().filter(|_| tables.flows()),
    },
    Rule {
        this: "a body's plasticity",
        with: "steady rolling",
        message: "steady rolling does not support elasto-plastic bodies",
        hint: "use a [motion] in which one body rolls over the other, with both speeds equal or one of them 0",
        at: "friction",
        example: &[FLOWS, VOLUME, ROLLS],
        broken: |tables| tables.at("friction").filter(|_| tables.flows() && tables.rolls()),
    },
    Rule {
        this: "`keep` in [plasticity]",
        with: "a static contact",
        message: "'keep' needs [motion]",
        hint: "leave it out: a static contact stores its final plastic state",
        at: "plasticity.keep",
        example: &[FLOWS, r#"plasticity = { depth = "20 um", layers = 16, keep = "last" }"#],
        broken: |tables| tables.at("plasticity.keep").filter(|_| tables.case.motion.is_none()),
    },
    Rule {
        this: "`increments`, `unload` in [plasticity]",
        with: "[motion]",
        message: "'{key}' applies to a static contact only",
        hint: "leave it out: a [motion] has one increment per position, and each pass ends unloaded",
        at: "plasticity.increments",
        example: &[FLOWS, r#"plasticity = { depth = "20 um", layers = 16, increments = 8 }"#, AT_ANY_SPEED],
        broken: |tables| {
            tables.motion()?;
            tables.first("plasticity", &["increments", "unload"])
        },
    },
    Rule {
        this: "`increments` in [plasticity]",
        with: "`increments` in [friction]",
        message: "'increments' is given in [plasticity] and in [friction], expected in one of them",
        hint: "leave it out: [friction] sets the increments",
        at: "plasticity.increments",
        example: &[
            FLOWS,
            r#"plasticity = { depth = "20 um", layers = 16, increments = 8 }"#,
            "friction = { coefficient = 0.3, increments = 4 }",
        ],
        broken: |tables| tables.at("friction.increments").and(tables.at("plasticity.increments")),
    },
    Rule {
        this: "a body's plasticity",
        with: "`plastic_update = \"pass\"`",
        message: "elasto-plastic bodies need plastic_update = \"step\"",
        hint: "leave it out, or set `plastic_update = \"step\"`",
        at: "motion.plastic_update",
        example: &[FLOWS, VOLUME, r#"motion = { plastic_update = "pass" }"#],
        broken: |tables| {
            tables
                .at("motion.plastic_update")
                .filter(|entry| tables.flows() && entry.text().is_ok_and(|word| word == "pass"))
        },
    },
    Rule {
        this: "plasticity of the upper body",
        with: "`counter = \"fresh\"`",
        message: "a fresh counter-body does not keep its plastic state",
        hint: "leave the plasticity of the upper body out, or 'counter'",
        at: "motion.counter",
        example: &[
            r#"upper.plasticity = { yield_stress = "1.5 GPa" }"#,
            GENERATED,
            VOLUME,
            r#"motion = { counter = "fresh" }"#,
        ],
        broken: |tables| {
            let fresh = tables.motion().is_some_and(|motion| motion.counter == CounterBody::Fresh);
            tables.at("motion.counter").filter(|_| fresh && tables.case.upper.plasticity.is_some())
        },
    },
    Rule {
        this: "a body's plasticity in a shift",
        with: "a boundary that is not periodic",
        message: "an elasto-plastic body in a shift needs a periodic boundary",
        hint: "set `boundary = \"periodic\"` in [contact]",
        at: "motion.strategy",
        example: &[FLOWS, VOLUME, r#"motion = { strategy = "shift" }"#],
        broken: |tables| {
            tables.shift().filter(|_| tables.flows() && !tables.case.contact.boundary.repeats(0))?;
            tables.at("motion.strategy")
        },
    },
];
