//! Rules of bodies that contacts change.

use super::super::CounterBody;
use super::Rule;
use super::examples::{CHANGES, FLOWS, GENERATED, JUMPS, LINE, MOVES, RUBS, VOLUME};
use asperity_contact::motion::{OffsetY, PlasticUpdate};

pub(super) const RULES: &[Rule] = &[
    Rule {
        this: "[friction] in a motion",
        with: "equal speeds",
        message: "[friction] needs surfaces with different speeds",
        hint: "give the speeds different values, or leave [friction] out",
        at: "friction",
        example: &[RUBS, r#"motion = { strategy = "shift", speed_lower = 1, speed_upper = 1 }"#],
        broken: |tables| {
            tables.motion().filter(|motion| motion.strategy().direction() == 0.0)?;
            tables.at("friction")
        },
    },
    Rule {
        this: "[acceleration]",
        with: "bodies that passes do not change",
        message: "[acceleration] needs a body that passes change",
        hint: "give a body `[lower.wear]` or `[lower.film]`, or leave [acceleration] out",
        at: "acceleration",
        example: &[MOVES, JUMPS],
        broken: |tables| tables.at("acceleration").filter(|_| !tables.case.is_changed_by_cycles()),
    },
    Rule {
        this: "`max_jump` above 1",
        with: "`counter = \"fresh\"`",
        message: "extrapolation needs passes that repeat: counter = \"fresh\" changes the upper body",
        hint: "set `max_jump = 1`, or `counter = \"same\"`",
        at: "acceleration",
        example: &[CHANGES, GENERATED, r#"motion = { speed = "0.5 m/s", counter = "fresh" }"#, JUMPS],
        broken: |tables| {
            tables.motion().filter(|motion| motion.counter == CounterBody::Fresh && tables.jumps())?;
            tables.at("acceleration")
        },
    },
    Rule {
        this: "`max_jump` above 1",
        with: "a body's plasticity",
        message: "extrapolation needs bodies that do not remember each position: plastic strain follows the path",
        hint: "set `max_jump = 1`, or give the bodies a `hardness`",
        at: "acceleration",
        example: &[CHANGES, FLOWS, VOLUME, MOVES, JUMPS],
        broken: |tables| tables.at("acceleration").filter(|_| tables.flows() && tables.jumps()),
    },
    Rule {
        this: "`max_jump` above 1",
        with: "`plastic_update = \"step\"`",
        message: "extrapolation needs plastic deformation that is applied after each pass",
        hint: "set `max_jump = 1`, or `plastic_update = \"pass\"`",
        at: "acceleration",
        example: &[
            CHANGES,
            r#"lower.hardness = "4 GPa""#,
            r#"motion = { speed = "0.5 m/s", plastic_update = "step" }"#,
            JUMPS,
        ],
        broken: |tables| {
            let step = tables.motion().is_some_and(|motion| motion.plastic_update == PlasticUpdate::Step);
            tables.at("acceleration").filter(|_| step && tables.jumps() && tables.yields())
        },
    },
    Rule {
        this: "`max_jump` above 1",
        with: "`offset_y`",
        message: "extrapolation needs passes that repeat: 'offset_y' moves the surfaces in each pass",
        hint: "set `max_jump = 1`, or `offset_y = 0`",
        at: "acceleration",
        example: &[CHANGES, LINE, r#"motion = { speed = "0.5 m/s", offset_y = "random" }"#, JUMPS],
        broken: |tables| {
            tables.motion().filter(|motion| motion.offset_y() != OffsetY::NONE && tables.jumps())?;
            tables.at("acceleration")
        },
    },
    Rule {
        this: "`max_jump` above 1",
        with: "a one-way shift with a ratio of speeds other than 0 or 1",
        message: "extrapolation needs passes that repeat: at these speeds the bodies meet at other places in each pass",
        hint: "set `max_jump = 1`, one speed to 0, both speeds equal, or `path = \"reciprocating\"`; docs/models.md compares these",
        at: "acceleration",
        example: &[
            CHANGES,
            r#"contact = { load = "2 N", boundary = "periodic" }"#,
            r#"motion = { strategy = "shift", speed_lower = 0.3, speed_upper = 1 }"#,
            JUMPS,
        ],
        broken: |tables| {
            tables.motion().filter(|motion| !motion.repeats() && tables.jumps())?;
            tables.at("acceleration")
        },
    },
];
