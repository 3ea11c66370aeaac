//! The rules of fatigue.

use super::Fatigue;
use crate::with::{Rule, Surroundings};

const FATIGUE: &str = r#"fatigue = { to = "8 um" }"#;
const LIMITS: &str = r#"lower.fatigue = { torsion = "350 MPa", tension = "600 MPa" }"#;
const MOVES: &str = r#"motion = { speed = "0.5 m/s" }"#;

fn any(surroundings: &Surroundings, is: fn(&crate::with::BodyConstants) -> bool) -> bool {
    surroundings.bodies.iter().any(is)
}

pub(super) const RULES: &[Rule<Fatigue>] = &[
    Rule {
        this: "[fatigue]",
        with: "a contact that neither moves nor has `cycles`",
        message: "fatigue needs loads that repeat: a contact that is loaded once has no cycle",
        hint: "add a [motion], or give a stage of the [[history]] its `cycles`; [subsurface] has the stress of a single contact",
        at: "fatigue",
        example: &[LIMITS, FATIGUE],
        broken: |_, surroundings| !surroundings.moves && !surroundings.has_cycles,
    },
    Rule {
        this: "[fatigue]",
        with: "no limits of a body",
        message: "fatigue needs the limits of a body",
        hint: "for example `fatigue = { torsion = \"350 MPa\", tension = \"600 MPa\" }` in [lower]",
        at: "fatigue",
        example: &[MOVES, FATIGUE],
        broken: |_, surroundings| !any(surroundings, |body| body.properties.fatigue.is_some()),
    },
    Rule {
        this: "[fatigue]",
        with: "a body with layers that has limits",
        message: "the limits of fatigue are those of one material, and a body with layers has several",
        hint: "leave the limits of the body with layers out; [subsurface] computes its largest stresses, layer by layer",
        at: "fatigue",
        example: &[
            LIMITS,
            FATIGUE,
            MOVES,
            r#"lower.coating = { thickness = "2 um", young = "300 GPa", poisson = 0.25 }"#,
        ],
        broken: |_, surroundings| {
            any(surroundings, |body| body.properties.fatigue.is_some() && body.material.is_layered())
        },
    },
    Rule {
        this: "[fatigue]",
        with: "`strategy = \"shift\"` under a boundary that is free along x",
        message: "fatigue in a shift needs a boundary that is periodic along x",
        hint: "set `boundary = \"periodic\"` in [contact], or `strategy = \"overlap\"`",
        at: "fatigue",
        example: &[LIMITS, FATIGUE, r#"motion = { strategy = "shift" }"#],
        broken: |_, surroundings| surroundings.is_shift && !surroundings.boundary.repeats(0),
    },
];
