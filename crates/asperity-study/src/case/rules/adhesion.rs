//! Rules of adhesion.

use super::super::Prescribed;
use super::Rule;
use super::examples::{AT_ANY_SPEED, FLOWS, RUBS, SLIDES, VOLUME, WEARS};
use asperity_contact::motion::AdhesionHistory;
use asperity_contact::solver::Coupling;

/// Bodies that attract each other.
const STICKS: &str = r#"adhesion = { work = "50 mJ/m2", range = "2 nm" }"#;

pub(super) const RULES: &[Rule] = &[
    Rule {
        this: "[adhesion]",
        with: "[friction] without [motion]",
        message: "[adhesion] applies to a static contact without friction only",
        hint: "leave [adhesion] or [friction] out",
        at: "adhesion",
        example: &[STICKS, RUBS],
        broken: |tables| {
            tables.friction().filter(|_| tables.case.motion.is_none())?;
            tables.at("adhesion")
        },
    },
    Rule {
        this: "[adhesion]",
        with: "[friction] of a [motion], with `coupling = \"full\"`",
        message: "[adhesion] needs a friction that does not displace the bodies normally",
        hint: "set `coupling = \"goodman\"` or `\"none\"` in [friction]",
        at: "adhesion",
        example: &[STICKS, RUBS, AT_ANY_SPEED],
        broken: |tables| {
            tables.friction().filter(|friction| friction.law.coupling == Coupling::Full)?;
            tables.at("adhesion")
        },
    },
    Rule {
        this: "`history` in [adhesion]",
        with: "no [motion]",
        message: "'history' of [adhesion] needs a [motion]",
        hint: "the increments of a [[history]] follow each other",
        at: "adhesion.history",
        example: &[r#"adhesion = { work = "50 mJ/m2", range = "2 nm", history = "path" }"#],
        broken: |tables| tables.at("adhesion.history").filter(|_| tables.case.motion.is_none()),
    },
    Rule {
        this: "`history = \"path\"` in [adhesion]",
        with: "`strategy = \"overlap\"`",
        message: "history = \"path\" needs a motion by a shift",
        hint: "set `strategy = \"shift\"` in [motion]: an overlap grows and shrinks from position to position",
        at: "adhesion.history",
        example: &[r#"adhesion = { work = "50 mJ/m2", range = "2 nm", history = "path" }"#, AT_ANY_SPEED],
        broken: |tables| {
            tables.case.adhesion.filter(|adhesion| adhesion.history == AdhesionHistory::Path)?;
            tables.overlap()?;
            tables.at("adhesion.history")
        },
    },
    Rule {
        this: "[subsurface]",
        with: "[adhesion] and [motion]",
        message: "[subsurface] with [adhesion] applies to a static contact only",
        hint: "leave [subsurface] or [adhesion] out",
        at: "subsurface",
        example: &[STICKS, AT_ANY_SPEED, "subsurface = { to = \"5 um\" }"],
        broken: |tables| {
            tables.case.adhesion.and(tables.motion())?;
            tables.at("subsurface")
        },
    },
    Rule {
        this: "[adhesion]",
        with: "[sliding]",
        message: "[adhesion] does not apply to wear in place",
        hint: "leave [adhesion] or [sliding] out",
        at: "adhesion",
        example: &[STICKS, WEARS, SLIDES],
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
