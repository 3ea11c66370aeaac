//! Rules of friction, rolling, sweeps and histories.

use super::super::{Boundary, Prescribed};
use super::Rule;
use super::examples::{AT_ANY_SPEED, LINE, ROLLS, RUBS, SWEEP};

pub(super) const RULES: &[Rule] = &[
    Rule {
        this: "`cycles` of a stage",
        with: "`sliding` in it",
        message: "cycles go there and back, which 'sliding' does not",
        hint: "give a `force`, a `displacement` or a `load`",
        at: "history.cycles",
        example: &[RUBS, r#"history = [{ sliding = [1, 0], cycles = 10 }]"#],
        broken: |tables| {
            let mut stages = tables.case.history.iter();
            let both = stages.any(|stage| stage.cycles.is_some() && stage.sliding.is_some());
            tables.of_stage(&["cycles"]).or(tables.at("history")).filter(|_| both)
        },
    },
    Rule {
        this: "`period` of a stage",
        with: "no `cycles`",
        message: "'period' needs 'cycles'",
        hint: "for example `cycles = 10000`",
        at: "history.period",
        example: &[RUBS, r#"history = [{ force = "0.1 N", period = "50 ms" }]"#],
        broken: |tables| {
            let alone =
                tables.case.history.iter().any(|stage| stage.period.is_some() && stage.cycles.is_none());
            tables.of_stage(&["period"]).filter(|_| alone)
        },
    },
    Rule {
        this: "`junction_growth`",
        with: "bodies that do not yield",
        message: "'junction_growth' needs a body with a hardness",
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
        message: "'{key}' applies to a static contact only",
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
        message: "an infinite 'coefficient' without 'shear_strength' does not allow sliding",
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
        message: "an infinite 'coefficient' without 'shear_strength' does not allow sliding",
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
        with: "no rolling",
        message: "'spin' needs a rolling contact",
        hint: "give `creepage`, which may be 0, or `rolling_force`",
        at: "friction.spin",
        example: &["friction = { coefficient = 0.3, spin = 20 }"],
        broken: |tables| tables.at("friction.spin").filter(|_| !tables.rolls()),
    },
    Rule {
        this: "`spin`",
        with: "a boundary that is periodic along an axis",
        message: "'spin' needs a free boundary",
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
        message: "[motion] does not take '{key}'",
        hint: "give one `load`, `mean_pressure` or `approach`",
        at: "contact.loads",
        example: &[SWEEP, AT_ANY_SPEED],
        broken: |tables| tables.at("motion").and(tables.sweep()),
    },
    Rule {
        this: "a sweep",
        with: "[[history]]",
        message: "'{key}' and [[history]] are both given, expected one of them",
        hint: "each value of a list presses virgin bodies; the stages of a [[history]] follow each other",
        at: "contact.mean_pressures",
        example: &[r#"contact = { mean_pressures = ["1 MPa", "2 MPa"] }"#, r#"history = [{ load = "1 N" }]"#],
        broken: |tables| tables.at("history").and(tables.sweep()),
    },
    Rule {
        this: "a sweep",
        with: "`creepages`",
        message: "'{key}' and 'creepages' are both given, expected one of them",
        hint: "vary the load at one `creepage`, or the creepage under one `load`",
        at: "contact.loads",
        example: &[SWEEP, "friction = { coefficient = 0.3, creepages = [1e-3, 2e-3] }"],
        broken: |tables| tables.at("friction.creepages").and(tables.sweep()),
    },
    Rule {
        this: "a sweep",
        with: "[friction] without rolling",
        message: "with [friction], '{key}' needs a rolling contact",
        hint: "stick and slip depend on the loading path: give a `creepage`, a `rolling_force`, or stages in a \
               [[history]]",
        at: "contact.loads",
        example: &[SWEEP, r#"friction = { coefficient = 0.3, force = "0.1 N" }"#],
        broken: |tables| tables.at("friction").and(tables.sweep()).filter(|_| !tables.rolls()),
    },
    Rule {
        this: "[[history]]",
        with: "[motion]",
        message: "[[history]] applies to a static contact only",
        hint: "leave [[history]] or [motion] out",
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
        message: "'{key}' needs [friction]",
        hint: "add a [friction] table with its `coefficient`",
        at: "history.force",
        example: &[r#"history = [{ force = "0.1 N" }]"#],
        broken: |tables| tables.of_stage(&IN_PLANE).filter(|_| tables.case.friction.is_none()),
    },
    Rule {
        this: "a `load` or `mean_pressure` of at most 0 in [[history]]",
        with: "no [adhesion]",
        message: "'{key}' is {value}, expected a value above 0: nothing holds the bodies together",
        hint: "a load may pull at bodies with [adhesion]",
        at: "history.load",
        example: &[r#"history = [{ load = "-1 N" }]"#],
        broken: |tables| {
            let pulls = |normal: Prescribed| match normal {
                Prescribed::Load(value) | Prescribed::MeanPressure(value) => value <= 0.0,
                Prescribed::Approach(_) => false,
            };
            tables.case.interface.is_empty().then_some(())?;
            let index = tables.case.history.iter().position(|stage| stage.normal().is_some_and(pulls))?;
            let stage = tables.stages().into_iter().nth(index)?.table().ok()?;
            stage.get("load").or(stage.get("mean_pressure"))
        },
    },
];

/// Keys of the tangential loading of a static contact.
const IN_PLANE: [&str; 6] = ["force", "displacement", "sliding", "creepage", "creepages", "rolling_force"];

/// Why a rolling contact has neither stages nor increments.
const STEADY: &str = "the steady state does not depend on the loading path";
