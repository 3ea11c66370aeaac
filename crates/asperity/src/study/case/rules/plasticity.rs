//! Rules of bodies that deform plastically below their surfaces.

use super::super::CounterBody;
use super::Rule;
use super::examples::{
    AT_ANY_SPEED, COATED, FLOWS, GENERATED, LINE, MOVES, ROLLS, SWEEP, VOLUME, WARM, WEARS,
};

pub(super) const RULES: &[Rule] = &[
    Rule {
        this: "[plasticity]",
        with: "bodies without a plasticity",
        message: "no body flows: neither has a plasticity",
        hint: "give a body `[lower.plasticity]` with its `yield_stress`, or leave [plasticity] out",
        at: "plasticity",
        example: &[VOLUME],
        broken: |tables| tables.at("plasticity").filter(|_| !tables.flows()),
    },
    Rule {
        this: "a body's plasticity",
        with: "no [plasticity]",
        message: "missing table [plasticity]: [{path}] has no volume to flow in",
        hint: "for example `[plasticity]` with `depth = \"20 um\"` and `layers = 16`",
        at: "lower.plasticity",
        example: &[FLOWS],
        broken: |tables| tables.of_body("plasticity", |_| true).filter(|_| tables.case.plasticity.is_none()),
    },
    Rule {
        this: "a body's plasticity",
        with: "`young = inf` of the body",
        message: "a rigid body does not flow",
        hint: "give it a finite 'young', or leave its plasticity out",
        at: "lower.plasticity",
        example: &["lower.young = inf", FLOWS, VOLUME],
        broken: |tables| tables.of_body("plasticity", |body| !body.material.young.is_finite()),
    },
    Rule {
        this: "a body's plasticity",
        with: "its `hardness`",
        message: "a body that flows below its surface has no 'hardness'",
        hint: "leave 'hardness' out, or the plasticity",
        at: "lower.hardness",
        example: &[r#"lower.hardness = "4 GPa""#, FLOWS, VOLUME],
        broken: |tables| {
            tables.of_body("hardness", |body| body.plasticity.is_some() && body.hardness.yields())
        },
    },
    Rule {
        this: "a body's plasticity",
        with: "`hardness` of the other body",
        message: "'hardness' has no meaning beside a body that flows below its surface",
        hint: "give this body a plasticity, or neither of them",
        at: "upper.hardness",
        example: &[FLOWS, r#"upper.hardness = "4 GPa""#, VOLUME],
        broken: |tables| tables.of_body("hardness", |body| body.hardness.yields()).filter(|_| tables.flows()),
    },
    Rule {
        this: "a body's plasticity",
        with: "its coating",
        message: "flow under a coating is not known yet",
        hint: "leave the coating or the plasticity out",
        at: "lower.plasticity",
        example: &[COATED, FLOWS, VOLUME],
        broken: |tables| tables.of_body("plasticity", |body| body.material.coating.is_some()),
    },
    Rule {
        this: "a body's plasticity",
        with: "a coating of the other body",
        message: "flow beside a coating is not known yet",
        hint: "leave the coating or the plasticity out",
        at: "upper.coating",
        example: &[
            FLOWS,
            r#"upper.coating = { thickness = "2 um", young = "300 GPa", poisson = 0.25 }"#,
            VOLUME,
        ],
        broken: |tables| tables.of_body("coating", |_| true).filter(|_| tables.flows()),
    },
    Rule {
        this: "a body's plasticity",
        with: "wear, a film",
        message: "bodies that flow below their surfaces have no {key} yet",
        hint: "leave the plasticity out, and give the bodies a `hardness`",
        at: "lower.wear",
        example: &[FLOWS, WEARS, VOLUME, MOVES],
        broken: |tables| {
            let given = tables.of_body("wear", |_| true).or(tables.of_body("film", |_| true));
            given.filter(|_| tables.flows())
        },
    },
    Rule {
        this: "a body's plasticity",
        with: "[temperature]",
        message: "a flash temperature is that of bodies that stay as they are in a pass",
        hint: "leave [temperature] or the plasticity out",
        at: "temperature",
        example: &[FLOWS, VOLUME, MOVES, WARM],
        broken: |tables| tables.at("temperature").filter(|_| tables.flows()),
    },
    Rule {
        this: "a body's plasticity",
        with: "a sweep",
        message: "bodies that flow keep what has flowed: they have no sweep",
        hint: "give stages in a [[history]]",
        at: "contact.loads",
        example: &[FLOWS, VOLUME, SWEEP],
        broken: |tables| tables.sweep().filter(|_| tables.flows()),
    },
    Rule {
        this: "a body's plasticity",
        with: "a boundary periodic along one axis alone",
        message: "a boundary periodic along one axis alone has no plastic strain yet",
        hint: "use \"free\" or \"periodic\", or give the bodies a `hardness`",
        at: "contact.boundary",
        example: &[FLOWS, VOLUME, LINE],
        broken: |tables| tables.line().filter(|_| tables.flows()),
    },
    Rule {
        this: "a body's plasticity",
        with: "steady rolling",
        message: "the steady state of rolling is that of bodies that do not flow",
        hint: "move the bodies in a [motion], where one rolls over the other at a speed of 0",
        at: "friction",
        example: &[FLOWS, VOLUME, ROLLS],
        broken: |tables| tables.at("friction").filter(|_| tables.flows() && tables.rolls()),
    },
    Rule {
        this: "`keep` in [plasticity]",
        with: "a contact at rest",
        message: "'keep' is that of the passes of a [motion]",
        hint: "leave it out: a contact at rest has one volume, that of its end",
        at: "plasticity.keep",
        example: &[FLOWS, r#"plasticity = { depth = "20 um", layers = 16, keep = "last" }"#],
        broken: |tables| tables.at("plasticity.keep").filter(|_| tables.case.motion.is_none()),
    },
    Rule {
        this: "`increments`, `unload` in [plasticity]",
        with: "[motion]",
        message: "'{key}' is that of a contact at rest",
        hint: "leave it out: in a [motion] the bodies flow position by position, and each pass ends without load",
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
        message: "'increments' is given in [plasticity] and in [friction]",
        hint: "leave it out: those of [friction] count",
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
        message: "bodies that flow below their surfaces do so at every position",
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
        message: "an upper body that is another in each pass does not keep what has flowed",
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
        message: "plastic strain goes round with the surfaces of a shift: their boundary is periodic",
        hint: "set `boundary = \"periodic\"` in [contact]",
        at: "motion.strategy",
        example: &[FLOWS, VOLUME, r#"motion = { strategy = "shift" }"#],
        broken: |tables| {
            tables.shift().filter(|_| tables.flows() && !tables.case.contact.boundary.repeats(0))?;
            tables.at("motion.strategy")
        },
    },
];
