//! Rules of layers, and of the stress below the surface.

use super::super::Side;
use super::Rule;
use super::examples::{COATED, LINE};

pub(super) const RULES: &[Rule] = &[
    Rule {
        this: "`step` in [subsurface]",
        with: "a static contact",
        message: "'step' needs [motion]",
        hint: "leave it out: a static contact has one position",
        at: "subsurface.step",
        example: &[r#"subsurface = { to = "20 um", step = 3 }"#],
        broken: |tables| tables.at("subsurface.step").filter(|_| tables.case.motion.is_none()),
    },
    Rule {
        this: "[subsurface] of a body with layers",
        with: "a boundary periodic along one axis only",
        message: "the stress in layers is not known under a boundary that is periodic along one axis only",
        hint: "use \"free\" or \"periodic\", or leave [subsurface] out",
        at: "subsurface",
        example: &[COATED, LINE, r#"subsurface = { to = "20 um" }"#],
        broken: |tables| {
            let spec = tables.case.subsurface.as_ref()?;
            let body = match spec.body {
                Side::Lower => &tables.case.lower,
                Side::Upper => &tables.case.upper,
            };
            tables.line().filter(|_| body.material.is_layered())
        },
    },
];
