//! Rules of what a contact lets through: heat or current, and a fluid.

use super::Rule;
use super::examples::{COATED, LINE};
use asperity_contact::conductance::Kind;
use asperity_contact::flow::Ends;

/// Heat through bodies whose conductivities are known.
const HEAT: &str = r#"conductance = {}"#;
const CONDUCTIVITIES: [&str; 2] =
    [r#"lower.conductivity = "46 W/(m K)""#, r#"upper.conductivity = "46 W/(m K)""#];
const LEAKS: &str = r#"flow = { viscosity = "80 mPa s", ends = "periodic" }"#;

pub(super) const RULES: &[Rule] = &[
    Rule {
        this: "[conductance]",
        with: "a body without `conductivity`",
        message: "[conductance] needs the conductivity of both bodies",
        hint: "for example `conductivity = \"46 W/(m K)\"` in [lower] and in [upper]",
        at: "conductance",
        example: &[HEAT, CONDUCTIVITIES[0]],
        broken: |tables| {
            let case = tables.case;
            let known =
                |kind| [&case.lower, &case.upper].iter().all(|body| body.conductivity_of(kind).is_some());
            let kind = case.conductance?.kind;
            tables.at("conductance").filter(|_| kind == Kind::Thermal && !known(kind))
        },
    },
    Rule {
        this: "[conductance] with `kind = \"electrical\"`",
        with: "a body without `resistivity`",
        message: "the electrical conductance needs the resistivity of both bodies",
        hint: "for example `resistivity = \"1.7e-8 ohm m\"` in [lower] and in [upper]",
        at: "conductance.kind",
        example: &[r#"conductance = { kind = "electrical" }"#, CONDUCTIVITIES[0], CONDUCTIVITIES[1]],
        broken: |tables| {
            let case = tables.case;
            let known =
                |kind| [&case.lower, &case.upper].iter().all(|body| body.conductivity_of(kind).is_some());
            let kind = case.conductance?.kind;
            tables.at("conductance.kind").filter(|_| kind == Kind::Electrical && !known(kind))
        },
    },
    Rule {
        this: "[conductance]",
        with: "two bodies that conduct without limit",
        message: "both bodies conduct without limit: nothing resists",
        hint: "give one of them a finite conductivity",
        at: "conductance",
        example: &[HEAT, "lower.conductivity = inf", "upper.conductivity = inf"],
        broken: |tables| {
            let kind = tables.case.conductance?.kind;
            let composite = tables.case.composite_conductivity(kind)?;
            tables.at("conductance").filter(|_| composite.is_err())
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
        broken: |tables| {
            tables.case.conductance.filter(|spec| spec.kind == Kind::Electrical)?;
            tables.at("conductance.gas")
        },
    },
    Rule {
        this: "`jump` in [conductance]",
        with: "no `gas`",
        message: "'jump' needs a gas",
        hint: "for example `gas = \"0.026 W/(m K)\"`",
        at: "conductance.jump",
        example: &[CONDUCTIVITIES[0], CONDUCTIVITIES[1], r#"conductance = { jump = "0.37 um" }"#],
        broken: |tables| {
            tables.case.conductance.filter(|spec| spec.gas.is_none())?;
            tables.at("conductance.jump")
        },
    },
    Rule {
        this: "[conductance]",
        with: "a coating without a conductivity of its own",
        message: "[conductance] needs the conductivity of each coating",
        hint: "for example `conductivity = \"20 W/(m K)\"` in [lower.coating]; `resistivity` with kind = \"electrical\"",
        at: "conductance",
        example: &[COATED, HEAT, CONDUCTIVITIES[0], CONDUCTIVITIES[1]],
        broken: |tables| {
            let kind = tables.case.conductance?.kind;
            let bodies = [&tables.case.lower, &tables.case.upper];
            let unknown = bodies.iter().any(|body| body.conductor(kind).is_none());
            tables.at("conductance").filter(|_| unknown)
        },
    },
    Rule {
        this: "a gas in [flow]",
        with: "no `outlet`",
        message: "the leakage of a gas needs the pressure of the outlet",
        hint: "for example `outlet = \"1 bar\"`",
        at: "flow.gas",
        example: &[r#"flow = { viscosity = "18 uPa s", gas = true }"#],
        broken: |tables| {
            tables.case.flow.filter(|spec| spec.gas && spec.outlet.is_none())?;
            tables.at("flow.gas")
        },
    },
    Rule {
        this: "`outlet` in [flow]",
        with: "a liquid",
        message: "'outlet' needs `gas = true`",
        hint: "the leakage of a liquid depends on the pressure difference alone",
        at: "flow.outlet",
        example: &[r#"flow = { viscosity = "80 mPa s", outlet = "1 bar" }"#],
        broken: |tables| {
            tables.case.flow.filter(|spec| !spec.gas)?;
            tables.at("flow.outlet")
        },
    },
    Rule {
        this: "`ends = \"periodic\"` in [flow]",
        with: "a boundary that is free along the flow",
        message: "ends = \"periodic\" needs a boundary that is periodic along the flow",
        hint: "leave 'ends' out, or choose another 'along' or another `boundary` in [contact]",
        at: "flow.ends",
        example: &[LINE, LEAKS],
        broken: |tables| {
            let boundary = tables.case.contact.boundary;
            let spec = tables.case.flow.filter(|spec| spec.ends == Some(Ends::Periodic))?;
            let is_free = (0..2).any(|axis| spec.along.axes()[axis] && !boundary.repeats(axis));
            tables.at("flow.ends").filter(|_| is_free)
        },
    },
];
