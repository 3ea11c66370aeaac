//! Requirements of wear.

use super::{WearCoefficient, WearRate};
use crate::with::{LawRule, Slip};

const WEARS: &str = r#"lower.wear = { coefficient = "1e-7 mm3/(N m)" }"#;

pub(super) const RULES: &[LawRule<WearCoefficient>] = &[
    LawRule {
        this: "wear in stages",
        with: "[lower.viscoelastic], [upper.viscoelastic]",
        message: "viscoelastic bodies in time do not support '{key}'",
        hint: "leave the wear out, or let the bodies pass over each other in a [motion], or slide in place in [sliding]",
        at: "lower.wear",
        example: &[
            r#"lower.viscoelastic = { moduli = ["1 GPa"], times = ["1 s"] }"#,
            WEARS,
            r#"history = [{ load = "1 N", duration = "1 s" }]"#,
        ],
        broken: |_, case| {
            case.relaxes && !matches!(case.slip, Slip::InPasses | Slip::Rolling | Slip::InPlace)
        },
    },
    LawRule {
        this: "wear",
        with: "a static contact",
        message: "wear needs [motion], [sliding], or [friction] with a force or a displacement",
        hint: "add a [motion] with its `speed`, [sliding], or [friction] and stages of a [[history]] in which the bodies slip",
        at: "lower.wear",
        example: &[WEARS],
        broken: |_, case| case.slip == Slip::None,
    },
    LawRule {
        this: "wear",
        with: "equal speeds",
        message: "wear needs surfaces with different speeds",
        hint: "give the speeds different values, or leave the wear out",
        at: "lower.wear",
        example: &[WEARS, r#"motion = { strategy = "shift", speed_lower = 1, speed_upper = 1 }"#],
        broken: |_, case| case.slip == Slip::Rolling,
    },
    LawRule {
        this: "`energy` in a wear",
        with: "no [friction]",
        message: "'energy' needs [friction]",
        hint: "add a [friction] table with its `coefficient`",
        at: "lower.wear.energy",
        example: &[r#"lower.wear = { energy = "1e-6 mm3/J" }"#, r#"motion = { speed = "0.5 m/s" }"#],
        broken: |wear, case| matches!(wear.rate, WearRate::Energy(_)) && !case.has_friction,
    },
    LawRule {
        this: "`under_film` in a wear",
        with: "no film on the body",
        message: "'under_film' needs a film on the same body",
        hint: "give the body a film, or leave 'under_film' out",
        at: "lower.wear.under_film",
        example: &[
            r#"lower.wear = { coefficient = "1e-7 mm3/(N m)", under_film = "1e-8 mm3/(N m)" }"#,
            r#"motion = { speed = "0.5 m/s" }"#,
        ],
        broken: |wear, case| wear.under_film.is_some() && case.laws.film.is_none(),
    },
];
