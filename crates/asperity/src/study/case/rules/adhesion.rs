//! Rules of adhesion.

use super::super::Prescribed;
use super::Rule;
use super::examples::{AT_ANY_SPEED, FLOWS, RUBS, SLIDES, VOLUME};

/// Bodies that attract each other.
const STICKS: &str = r#"adhesion = { work = "50 mJ/m2", range = "2 nm" }"#;

pub(super) const RULES: &[Rule] = &[
    Rule {
        this: "[adhesion]",
        with: "[motion]",
        message: "[adhesion] applies to a static contact only",
        hint: "leave [adhesion] or [motion] out",
        at: "adhesion",
        example: &[STICKS, AT_ANY_SPEED],
        broken: |tables| tables.at("adhesion").filter(|_| tables.case.motion.is_some()),
    },
    Rule {
        this: "[adhesion]",
        with: "[friction]",
        message: "[adhesion] applies to a contact without friction only",
        hint: "leave [adhesion] or [friction] out",
        at: "adhesion",
        example: &[STICKS, RUBS],
        broken: |tables| tables.at("adhesion").filter(|_| tables.case.friction.is_some()),
    },
    Rule {
        this: "[adhesion]",
        with: "[sliding]",
        message: "[adhesion] does not apply to wear in place",
        hint: "leave [adhesion] or [sliding] out",
        at: "adhesion",
        example: &[STICKS, SLIDES],
        broken: |tables| tables.at("adhesion").filter(|_| tables.case.sliding.is_some()),
    },
    Rule {
        this: "[adhesion]",
        with: "[plasticity]",
        message: "[adhesion] does not apply to bodies that deform plastically below the surface",
        hint: "give the bodies a `hardness` instead",
        at: "adhesion",
        example: &[STICKS, VOLUME, FLOWS],
        broken: |tables| tables.at("adhesion").filter(|_| tables.case.plasticity.is_some()),
    },
    Rule {
        this: "a `load` or `mean_pressure` of at most 0 in [[history]]",
        with: "no [adhesion]",
        message: "'{key}' is {value}, expected a value above 0: nothing holds the bodies together",
        hint: "a load may pull at bodies with [adhesion]",
        at: "history.load",
        example: &[r#"history = [{ load = "-1 N" }]"#],
        broken: |tables| {
            let pulls = |normal: &Prescribed| match *normal {
                Prescribed::Load(value) | Prescribed::MeanPressure(value) => value <= 0.0,
                Prescribed::Approach(_) => false,
            };
            tables.case.adhesion.is_none().then_some(())?;
            let index =
                tables.case.history.iter().position(|stage| stage.normal.as_ref().is_some_and(pulls))?;
            let stage = tables.stages().into_iter().nth(index)?.table().ok()?;
            stage.get("load").or(stage.get("mean_pressure"))
        },
    },
];
