//! Rules of layers, and of the stress below the surface.

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
        this: "a coating, layers",
        with: "a boundary periodic along one axis only",
        message: "layers do not support a boundary that is periodic along one axis only",
        hint: "use \"free\" or \"periodic\", or leave the layers out",
        at: "contact.boundary",
        example: &[COATED, LINE],
        broken: |tables| tables.line().filter(|_| tables.case.is_coated()),
    },
];
