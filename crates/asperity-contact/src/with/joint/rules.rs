//! The rules of the law of a joint.

use super::JointLaw;
use crate::operator::Boundary;
use crate::with::Rule;

const JOINT: &str = "joint = {}";
const PERIODIC: &str = r#"contact = { load = "2 N", boundary = "periodic" }"#;

pub(super) const RULES: &[Rule<JointLaw>] = &[
    Rule {
        this: "[joint]",
        with: "a boundary that is free along an axis",
        message: "the law of a joint needs surfaces that repeat along both axes",
        hint: "set `boundary = \"periodic\"` in [contact]: a free boundary counts the bulk of the bodies, too",
        at: "joint",
        example: &[JOINT],
        broken: |_, surroundings| surroundings.boundary != Boundary::PERIODIC,
    },
    Rule {
        this: "[joint]",
        with: "[motion]",
        message: "the law of a joint is that of surfaces at rest under a load",
        hint: "leave [motion] out; `loads` or `mean_pressures` in [contact] give the loads",
        at: "joint",
        example: &[PERIODIC, JOINT, r#"motion = { strategy = "shift" }"#],
        broken: |_, surroundings| surroundings.moves,
    },
    Rule {
        this: "[joint]",
        with: "[friction]",
        message: "the law of a joint has no [friction]",
        hint: "the tangential stiffness is that of surfaces that stick",
        at: "joint",
        example: &[PERIODIC, JOINT, "friction = { coefficient = 0.3 }"],
        broken: |_, surroundings| surroundings.has_friction,
    },
    Rule {
        this: "`samples` in [joint]",
        with: "`patches` or `files`, or both of these",
        message: "samples are seeds of generated surfaces, or patches of measured ones, or files",
        hint: "give one of `samples`, `patches` and `files`",
        at: "joint",
        example: &[PERIODIC, "joint = { samples = 4, patches = [2, 2] }"],
        broken: |joint, _| {
            let given = [joint.samples.is_some(), joint.patches.is_some(), !joint.files.is_empty()];
            given.into_iter().filter(|is_given| *is_given).count() > 1
        },
    },
];
