//! Rules of friction, rolling, sweeps and histories.

use super::super::Boundary;
use super::super::friction::IN_PLANE;
use super::Rule;
use super::examples::{AT_ANY_SPEED, LINE, ROLLS, SWEEP};

pub(super) const RULES: &[Rule] = &[
    Rule {
        this: "`junction_growth`",
        with: "bodies that do not yield",
        message: "'junction_growth' needs bodies that yield",
        hint: "give the softer body a `hardness`",
        at: "friction.junction_growth",
        example: &["friction = { coefficient = 0.3, junction_growth = 9 }"],
        broken: |tables| {
            tables.friction().filter(|friction| friction.law.junction_growth > 0.0 && !tables.yields())?;
            tables.at("friction.junction_growth")
        },
    },
    Rule {
        this: "`force`, `displacement`, `sliding`, `creepage`, `creepages`, `rolling_force`, `spin`, `increments` in [friction]",
        with: "[motion], [sliding]",
        message: "'{key}' belongs to a static contact",
        hint: "in a [motion] the upper body slides over the lower one",
        at: "friction.force",
        example: &[r#"friction = { coefficient = 0.3, force = "0.1 N" }"#, AT_ANY_SPEED],
        broken: |tables| {
            let given =
                tables.first("friction", &IN_PLANE).or(tables.first("friction", &["spin", "increments"]));
            given.filter(|_| tables.slides())
        },
    },
    Rule {
        this: "`coefficient = inf` without a `shear_strength`",
        with: "[motion], [sliding]",
        message: "what sticks under any shear cannot slide",
        hint: "give a finite 'coefficient', or the 'shear_strength' of a film",
        at: "friction.coefficient",
        example: &["friction = { coefficient = inf }", AT_ANY_SPEED],
        broken: |tables| {
            tables.friction().filter(|friction| !friction.slips() && tables.slides())?;
            tables.at("friction.coefficient")
        },
    },
    Rule {
        this: "`coefficient = inf` without a `shear_strength`",
        with: "`sliding` in [friction] or [[history]]",
        message: "what sticks under any shear cannot slide",
        hint: "give a finite 'coefficient', or the 'shear_strength' of a film",
        at: "friction.sliding",
        example: &["friction = { coefficient = inf, sliding = [1, 0] }"],
        broken: |tables| {
            tables.friction().filter(|friction| !friction.slips())?;
            tables.at("friction.sliding").or(tables.of_stage(&["sliding"]))
        },
    },
    Rule {
        this: "`increments` in [friction]",
        with: "rolling",
        message: "'increments' has no meaning in rolling",
        hint: STEADY,
        at: "friction.increments",
        example: &["friction = { coefficient = 0.3, creepage = 0.001, increments = 10 }"],
        broken: |tables| tables.at("friction.increments").filter(|_| tables.rolls()),
    },
    Rule {
        this: "`spin`",
        with: "bodies that do not roll",
        message: "'spin' belongs to a rolling contact",
        hint: "give `creepage`, 0 if there is none, or `rolling_force`",
        at: "friction.spin",
        example: &["friction = { coefficient = 0.3, spin = 20 }"],
        broken: |tables| tables.at("friction.spin").filter(|_| !tables.rolls()),
    },
    Rule {
        this: "`spin`",
        with: "a boundary that is periodic along an axis",
        message: "what spins does not repeat itself: its boundary is free",
        hint: "use `boundary = \"free\"`, or leave 'spin' out",
        at: "friction.spin",
        example: &[LINE, "friction = { coefficient = 0.3, creepage = 0, spin = 20 }"],
        broken: |tables| {
            tables.at("friction.spin").filter(|_| tables.case.contact.boundary != Boundary::FREE)
        },
    },
    Rule {
        this: "a sweep",
        with: "[motion]",
        message: "a [motion] has no '{key}'",
        hint: "it has one `load`, `mean_pressure` or `approach`",
        at: "contact.loads",
        example: &[SWEEP, AT_ANY_SPEED],
        broken: |tables| tables.at("motion").and(tables.sweep()),
    },
    Rule {
        this: "a sweep",
        with: "[[history]]",
        message: "'{key}' and [[history]] are both given, expected one of them",
        hint: "each of its values presses virgin bodies, in a history what is flattened stays flat",
        at: "contact.mean_pressures",
        example: &[r#"contact = { mean_pressures = ["1 MPa", "2 MPa"] }"#, r#"history = [{ load = "1 N" }]"#],
        broken: |tables| tables.at("history").and(tables.sweep()),
    },
    Rule {
        this: "a sweep",
        with: "`creepages`",
        message: "'{key}' and 'creepages' are both given, expected one of them",
        hint: "a sweep goes through loads at one `creepage`, or through creepages under one `load`",
        at: "contact.loads",
        example: &[SWEEP, "friction = { coefficient = 0.3, creepages = [1e-3, 2e-3] }"],
        broken: |tables| tables.at("friction.creepages").and(tables.sweep()),
    },
    Rule {
        this: "a sweep",
        with: "[friction] without rolling",
        message: "with [friction] only what rolls has '{key}'",
        hint: "what sticks and slips depends on how a load came about: give a `creepage`, a `rolling_force`, or stages in a \
               [[history]]",
        at: "contact.loads",
        example: &[SWEEP, r#"friction = { coefficient = 0.3, force = "0.1 N" }"#],
        broken: |tables| tables.at("friction").and(tables.sweep()).filter(|_| !tables.rolls()),
    },
    Rule {
        this: "[[history]]",
        with: "[motion]",
        message: "a [motion] has no [[history]]",
        hint: "a history is that of a static contact",
        at: "history",
        example: &[r#"history = [{ load = "1 N" }]"#, AT_ANY_SPEED],
        broken: |tables| tables.stages().into_iter().next().filter(|_| tables.case.motion.is_some()),
    },
    Rule {
        this: "[[history]]",
        with: "rolling",
        message: "a rolling contact has no [[history]]",
        hint: STEADY,
        at: "history",
        example: &[ROLLS, r#"history = [{ load = "1 N" }]"#],
        broken: |tables| tables.stages().into_iter().next().filter(|_| tables.rolls()),
    },
    Rule {
        this: "`force`, `displacement`, `sliding` in [[history]]",
        with: "no [friction]",
        message: "'{key}' acts on a contact with friction",
        hint: "add a [friction] table with its `coefficient`",
        at: "history.force",
        example: &[r#"history = [{ force = "0.1 N" }]"#],
        broken: |tables| tables.of_stage(&IN_PLANE).filter(|_| tables.case.friction.is_none()),
    },
];

/// Why a rolling contact has neither stages nor increments.
const STEADY: &str = "its steady state does not depend on how it was reached";
