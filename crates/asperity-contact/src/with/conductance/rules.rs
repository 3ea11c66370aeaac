//! The rules of a conductance.

use super::{Joint, Kind, composite, conductor};
use crate::with::{Rule, Surroundings};

/// Heat through bodies whose conductivities are known.
const HEAT: &str = r#"conductance = {}"#;
const CONDUCTIVITIES: [&str; 2] =
    [r#"lower.conductivity = "46 W/(m K)""#, r#"upper.conductivity = "46 W/(m K)""#];
const COATED: &str = r#"lower.coating = { thickness = "2 um", young = "300 GPa", poisson = 0.25 }"#;

pub(super) const RULES: &[Rule<Joint>] = &[
    Rule {
        this: "[conductance]",
        with: "a body without `conductivity`",
        message: "[conductance] needs the conductivity of both bodies",
        hint: "for example `conductivity = \"46 W/(m K)\"` in [lower] and in [upper]",
        at: "conductance",
        example: &[HEAT, CONDUCTIVITIES[0]],
        broken: |joint, surroundings| joint.kind == Kind::Thermal && !are_known(joint, surroundings),
    },
    Rule {
        this: "[conductance] with `kind = \"electrical\"`",
        with: "a body without `resistivity`",
        message: "the electrical conductance needs the resistivity of both bodies",
        hint: "for example `resistivity = \"1.7e-8 ohm m\"` in [lower] and in [upper]",
        at: "conductance.kind",
        example: &[r#"conductance = { kind = "electrical" }"#, CONDUCTIVITIES[0], CONDUCTIVITIES[1]],
        broken: |joint, surroundings| joint.kind == Kind::Electrical && !are_known(joint, surroundings),
    },
    Rule {
        this: "[conductance]",
        with: "two bodies that conduct without limit",
        message: "both bodies conduct without limit: nothing resists",
        hint: "give one of them a finite conductivity",
        at: "conductance",
        example: &[HEAT, "lower.conductivity = inf", "upper.conductivity = inf"],
        broken: |joint, surroundings| {
            composite(&surroundings.bodies, joint.kind).is_some_and(|found| found.is_err())
        },
    },
    Rule {
        this: "`gas` in [conductance]",
        with: "`kind = \"electrical\"`",
        message: "a gas conducts heat, but no current",
        hint: "leave 'gas' out",
        at: "conductance.gas",
        example: &[
            r#"lower.resistivity = "1.7e-8 ohm m""#,
            r#"upper.resistivity = "1.7e-8 ohm m""#,
            r#"conductance = { kind = "electrical", gas = "0.026 W/(m K)" }"#,
        ],
        broken: |joint, _| joint.kind == Kind::Electrical,
    },
    Rule {
        this: "`jump` in [conductance]",
        with: "no `gas`",
        message: "'jump' needs a gas",
        hint: "for example `gas = \"0.026 W/(m K)\"`",
        at: "conductance.jump",
        example: &[CONDUCTIVITIES[0], CONDUCTIVITIES[1], r#"conductance = { jump = "0.37 um" }"#],
        broken: |joint, _| joint.gas.is_none(),
    },
    Rule {
        this: "[conductance]",
        with: "a layer without a conductivity of its own",
        message: "[conductance] needs the conductivity of each layer",
        hint: "for example `conductivity = \"20 W/(m K)\"` in [lower.coating] or [[lower.layers]]; `resistivity` with kind = \"electrical\"",
        at: "conductance",
        example: &[COATED, HEAT, CONDUCTIVITIES[0], CONDUCTIVITIES[1]],
        broken: |joint, surroundings| {
            surroundings.bodies.iter().any(|body| conductor(body, joint.kind).is_none())
        },
    },
];

/// Whether the conductivities of both bodies are known.
fn are_known(joint: &Joint, surroundings: &Surroundings) -> bool {
    composite(&surroundings.bodies, joint.kind).is_some()
}
