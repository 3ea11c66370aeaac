//! The rules of a lubricant.

use super::Lubricant;
use crate::with::Rule;

/// Bodies with an oil between them.
const OIL: &str =
    r#"lubrication = { viscosity = "40 mPa s", pressure_viscosity = "20 1/GPa", speed = "0.1 m/s" }"#;

pub(super) const RULES: &[Rule<Lubricant>] = &[
    Rule {
        this: "[lubrication]",
        with: "a boundary that is periodic along x",
        message: "[lubrication] needs a boundary that is free along x, where the oil enters and leaves",
        hint: "use `boundary = \"free\"`, or `[\"free\", \"periodic\"]` for a line contact",
        at: "lubrication",
        example: &[r#"contact = { load = "2 N", boundary = "periodic" }"#, OIL],
        broken: |_, surroundings| surroundings.boundary.repeats(0),
    },
    Rule {
        this: "[lubrication]",
        with: "[plasticity]",
        message: "[lubrication] does not apply to bodies that deform plastically below the surface",
        hint: "leave [plasticity] out; a warning says where pressures exceed a `hardness`",
        at: "lubrication",
        example: &[
            OIL,
            r#"plasticity = { depth = "20 um", layers = 16 }"#,
            r#"lower.plasticity = { yield_stress = "1.5 GPa" }"#,
        ],
        broken: |_, surroundings| surroundings.flows,
    },
    Rule {
        this: "[lubrication]",
        with: "`device` in [contact]",
        message: "a device does not solve films of oil",
        hint: "leave `device` out of [contact], and the processor solves them",
        at: "lubrication",
        example: &[r#"contact = { load = "2 N", device = "host" }"#, OIL],
        broken: |_, surroundings| surroundings.on_device,
    },
];
