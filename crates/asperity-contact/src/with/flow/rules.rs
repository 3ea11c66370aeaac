//! The rules of a flow.

use super::{Ends, Leakage};
use crate::operator::Boundary;
use crate::with::Rule;

pub(super) const RULES: &[Rule<Leakage>] = &[
    Rule {
        this: "a gas in [flow]",
        with: "no `outlet`",
        message: "the leakage of a gas needs the pressure of the outlet",
        hint: "for example `outlet = \"1 bar\"`",
        at: "flow.gas",
        example: &[r#"flow = { viscosity = "18 uPa s", gas = true }"#],
        broken: |leakage, _| leakage.gas && leakage.outlet.is_none(),
    },
    Rule {
        this: "`outlet` in [flow]",
        with: "a liquid",
        message: "'outlet' needs `gas = true`",
        hint: "the leakage of a liquid depends on the pressure difference alone",
        at: "flow.outlet",
        example: &[r#"flow = { viscosity = "80 mPa s", outlet = "1 bar" }"#],
        broken: |leakage, _| !leakage.gas,
    },
    Rule {
        this: "`ends = \"periodic\"` in [flow]",
        with: "a boundary that is free along the flow",
        message: "ends = \"periodic\" needs a boundary that is periodic along the flow",
        hint: "leave 'ends' out, or choose another 'along' or another `boundary` in [contact]",
        at: "flow.ends",
        example: &[
            r#"contact = { load = "2 N", boundary = ["free", "periodic"] }"#,
            r#"flow = { viscosity = "80 mPa s", ends = "periodic" }"#,
        ],
        broken: |leakage, surroundings| {
            let is_free = |axis: usize| leakage.along.axes()[axis] && !surroundings.boundary.repeats(axis);
            leakage.ends == Some(Ends::Periodic) && (0..2).any(is_free)
        },
    },
    Rule {
        this: "`shear` in [flow]",
        with: "a boundary that is free along an axis, [motion]",
        message: "'shear' needs surfaces at rest that repeat along both axes",
        hint: "set `boundary = \"periodic\"` in [contact], and leave [motion] out: the factors are those of surfaces that slide",
        at: "flow.shear",
        example: &[r#"flow = { viscosity = "80 mPa s", shear = true }"#],
        broken: |leakage, surroundings| {
            leakage.shear && (surroundings.boundary != Boundary::PERIODIC || surroundings.moves)
        },
    },
];
