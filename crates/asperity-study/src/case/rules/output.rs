//! Rules of coatings, and of the stress below the surface.

use super::Rule;
use super::examples::{AT_ANY_SPEED, COATED, LINE};
use asperity_contact::solver::Coupling;

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
        this: "a coating",
        with: "[friction] of a static contact",
        message: "coated bodies do not support shear yet",
        hint: "leave [friction] or the coating out",
        at: "friction",
        example: &[COATED, r#"friction = { coefficient = 0.3, force = "0.1 N" }"#],
        broken: |tables| tables.at("friction").filter(|_| tables.case.is_coated() && !tables.slides()),
    },
    Rule {
        this: "a coating",
        with: "[friction] with a `coupling` other than `\"none\"`",
        message: "coated bodies do not support shear yet",
        hint: "set `coupling = \"none\"`, or leave the coating out",
        at: "friction.coupling",
        example: &[COATED, r#"friction = { coefficient = 0.3, coupling = "full" }"#, AT_ANY_SPEED],
        broken: |tables| {
            tables
                .friction()
                .filter(|friction| tables.case.is_coated() && friction.law.coupling != Coupling::None)?;
            tables.at("friction.coupling").or(tables.at("friction"))
        },
    },
    Rule {
        this: "a coating",
        with: "a boundary periodic along one axis only",
        message: "a coating does not support a boundary that is periodic along one axis only",
        hint: "use \"free\" or \"periodic\", or leave the coating out",
        at: "contact.boundary",
        example: &[COATED, LINE],
        broken: |tables| tables.line().filter(|_| tables.case.is_coated()),
    },
    Rule {
        this: "a coating",
        with: "[subsurface]",
        message: "[subsurface] does not support coatings yet",
        hint: "leave [subsurface] or the coating out",
        at: "subsurface",
        example: &[COATED, r#"subsurface = { to = "20 um" }"#],
        broken: |tables| tables.at("subsurface").filter(|_| tables.case.is_coated()),
    },
];
