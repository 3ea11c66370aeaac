//! The rules of an attraction.

use super::Attraction;
use crate::adhesion::History;
use crate::with::Rule;

/// Bodies that attract each other.
const STICKS: &str = r#"adhesion = { work = "50 mJ/m2", range = "2 nm" }"#;
/// Bodies that come from the position before.
const FOLLOWS: &str = r#"adhesion = { work = "50 mJ/m2", range = "2 nm", history = "path" }"#;
const MOVES: &str = "motion = {}";
const RUBS: &str = "friction = { coefficient = 0.3 }";

pub(super) const RULES: &[Rule<Attraction>] = &[
    Rule {
        this: "[adhesion]",
        with: "dissimilar bodies with friction of `coupling = \"full\"`; `junction_growth` without [motion]",
        message: "[adhesion] needs a friction that does not change the pressures",
        hint: "set `coupling = \"goodman\"` or `\"none\"` in [friction], and leave 'junction_growth' out",
        at: "adhesion",
        example: &[STICKS, r#"lower.young = "70 GPa""#, RUBS],
        broken: |_, surroundings| surroundings.shear_changes_pressures,
    },
    Rule {
        this: "`history` in [adhesion]",
        with: "no [motion]",
        message: "'history' of [adhesion] needs a [motion]",
        hint: "the increments of a [[history]] follow each other",
        at: "adhesion.history",
        example: &[FOLLOWS],
        broken: |_, surroundings| !surroundings.moves,
    },
    Rule {
        this: "`history = \"path\"` in [adhesion]",
        with: "`strategy = \"overlap\"`",
        message: "history = \"path\" needs a motion by a shift",
        hint: "set `strategy = \"shift\"` in [motion]: an overlap grows and shrinks from position to position",
        at: "adhesion.history",
        example: &[FOLLOWS, MOVES],
        broken: |attraction, surroundings| {
            attraction.history == History::Path && surroundings.moves && !surroundings.is_shift
        },
    },
    Rule {
        this: "[subsurface]",
        with: "[adhesion] and [motion]",
        message: "[subsurface] with [adhesion] applies to a static contact only",
        hint: "leave [subsurface] or [adhesion] out",
        at: "subsurface",
        example: &[STICKS, MOVES, "subsurface = { to = \"5 um\" }"],
        broken: |_, surroundings| surroundings.moves,
    },
    Rule {
        this: "[adhesion]",
        with: "[plasticity]",
        message: "[adhesion] does not apply to bodies that deform plastically below the surface",
        hint: "give the bodies a `hardness` instead",
        at: "adhesion",
        example: &[
            STICKS,
            r#"plasticity = { depth = "20 um", layers = 16 }"#,
            r#"lower.plasticity = { yield_stress = "1.5 GPa" }"#,
        ],
        broken: |_, surroundings| surroundings.flows,
    },
    Rule {
        this: "[adhesion]",
        with: "`device` in [contact]",
        message: "a device does not solve adhesive contacts",
        hint: "leave `device` out of [contact], and the processor solves it",
        at: "adhesion",
        example: &[r#"contact = { load = "2 N", device = "host" }"#, STICKS],
        broken: |_, surroundings| surroundings.on_device,
    },
];
