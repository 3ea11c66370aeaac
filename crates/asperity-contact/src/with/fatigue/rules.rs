//! The rules of fatigue.

use super::Fatigue;
use crate::with::{BodyConstants, Rule, Surroundings};

const FATIGUE: &str = r#"fatigue = { to = "8 um" }"#;
const LIMITS: &str = r#"lower.fatigue = { torsion = "350 MPa", tension = "600 MPa" }"#;
const MOVES: &str = r#"motion = { speed = "0.5 m/s" }"#;

fn any(surroundings: &Surroundings, is: impl Fn(&BodyConstants) -> bool) -> bool {
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
        this: "`to` in [fatigue]",
        with: "a depth in the layers of a body that has limits",
        message: "'to' does not reach below the layers: the limits are those of the body under them",
        hint: "give a larger `to`; [subsurface] computes the largest stresses of each layer",
        at: "fatigue.to",
        example: &[
            LIMITS,
            r#"fatigue = { to = "2 um" }"#,
            MOVES,
            r#"lower.coating = { thickness = "2 um", young = "300 GPa", poisson = 0.25 }"#,
        ],
        broken: |fatigue, surroundings| {
            let covers =
                |body: &BodyConstants| body.material.is_layered() && body.material.thickness() >= fatigue.to;
            any(surroundings, |body| body.properties.fatigue.is_some() && covers(body))
        },
    },
    Rule {
        this: "[fatigue]",
        with: "a rigid base under layers that has limits",
        message: "a rigid base under layers has no stress that is known, and no fatigue",
        hint: "leave the limits of this body out; [subsurface] computes the largest stresses of each layer",
        at: "fatigue",
        example: &[
            LIMITS,
            FATIGUE,
            MOVES,
            r#"lower.layers = [{ thickness = "2 um", young = "300 GPa", poisson = 0.25 }]"#,
            "lower.young = inf",
        ],
        broken: |_, surroundings| {
            let is_rigid =
                |body: &BodyConstants| body.material.is_layered() && body.material.young.is_infinite();
            any(surroundings, |body| body.properties.fatigue.is_some() && is_rigid(body))
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
