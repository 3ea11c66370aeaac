//! Rules of one body, and of two.

use super::super::{Body, Case};
use super::Rule;

pub(super) const RULES: &[Rule] = &[
    Rule {
        this: "[lower.fatigue], [upper.fatigue]",
        with: "no [fatigue]",
        message: "the limits of a body need [fatigue]",
        hint: "for example `[fatigue]` with `to = \"8 um\"`",
        at: "lower.fatigue",
        example: &[r#"lower.fatigue = { torsion = "350 MPa", tension = "600 MPa" }"#],
        broken: |tables| {
            let limited = tables.of_body("fatigue", |body| body.properties.fatigue.is_some());
            limited.filter(|_| tables.case.with.fatigue.is_none())
        },
    },
    Rule {
        this: "`risk`",
        with: "a contact that does not move",
        message: "'risk' needs a [motion], whose passes it compares with those of smooth bodies",
        hint: "leave 'risk' out; `fatigue.csv` has the life in cycles without it",
        at: "lower.fatigue.risk",
        example: &[
            r#"lower.fatigue = { torsion = "350 MPa", tension = "600 MPa", risk = true }"#,
            r#"fatigue = { to = "8 um" }"#,
            r#"history = [{ load = "1 N", cycles = 10 }]"#,
        ],
        broken: |tables| {
            let risks = |body: &Body| body.properties.fatigue.is_some_and(|limits| limits.risk);
            tables.of_body("fatigue.risk", risks).filter(|_| tables.motion().is_none())
        },
    },
    Rule {
        this: "`pit_depth`",
        with: "a body with layers",
        message: "'pit_depth' of a body with layers: pits would break through the layers, and contacts keep these whole",
        hint: "leave 'pit_depth' out; `life` in `fatigue.csv` tells when the body below the layers fails",
        at: "lower.fatigue.pit_depth",
        example: &[
            r#"lower.fatigue = { torsion = "350 MPa", tension = "600 MPa", pit_depth = "4 um" }"#,
            r#"fatigue = { to = "8 um" }"#,
            r#"motion = { speed = "0.5 m/s" }"#,
            r#"lower.coating = { thickness = "2 um", young = "300 GPa", poisson = 0.25 }"#,
        ],
        broken: |tables| {
            let pits = |body: &Body| body.properties.fatigue.is_some_and(|limits| limits.pit_depth > 0.0);
            tables.of_body("fatigue.pit_depth", |body| pits(body) && body.material.is_layered())
        },
    },
    Rule {
        this: "`young = inf`",
        with: "`young = inf` of the other body",
        message: "both bodies are rigid",
        hint: "give one of them a finite 'young' or layers",
        at: "upper.young",
        example: &["lower.young = inf", "upper.young = inf"],
        broken: |tables| {
            let Case { lower, upper, .. } = tables.case;
            let rigid =
                asperity_contact::material::composite_modulus(&lower.material, &upper.material).is_err();
            tables.at("upper.young").or(tables.at("upper.base")).filter(|_| rigid)
        },
    },
];
