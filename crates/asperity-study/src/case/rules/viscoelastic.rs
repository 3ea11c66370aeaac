//! Rules of viscoelastic bodies, their steady sliding and their passes.

use super::super::{Case, StageSpec};
use super::Rule;
use super::device::ON_PROCESSOR;
use super::examples::{AT_ANY_SPEED, CHANGES, COATED, JUMPS, MOVES, ON_DEVICE, RUBS, SLIDES, STEADY};

/// The lower body relaxes.
const RELAXES: &str = r#"lower.viscoelastic = { moduli = ["1 GPa"], times = ["1 s"] }"#;

/// Keys of the time of a stage that only viscoelastic bodies have.
const TIMES: [&str; 2] = ["duration", "dwell"];
/// Tables that a steady contact excludes.
const OTHERS: [&str; 8] =
    ["motion", "sliding", "history", "friction", "adhesion", "plasticity", "acceleration", "subsurface"];

pub(super) const RULES: &[Rule] = &[
    Rule {
        this: "[lower.viscoelastic], [upper.viscoelastic]",
        with: "no [steady], no [motion], no [sliding], and no `duration`, `dwell` or `period` in a [[history]]",
        message: "a viscoelastic body needs [steady], [motion], [sliding] or a time: a static contact has the relaxed modulus `young`",
        hint: "give the `speed` or the `speeds` in [steady], passes in [motion], or a [[history]] with a `dwell`",
        at: "lower.viscoelastic",
        example: &[RELAXES],
        broken: |tables| {
            let timed = tables.of_stage(&TIMES).or(tables.of_stage(&["period"]));
            let moves = tables.case.steady.is_some() || tables.slides();
            tables.viscoelastic().filter(|_| !moves && timed.is_none())
        },
    },
    Rule {
        this: "`duration`, `dwell` of a stage",
        with: "elastic bodies",
        message: "'{key}' needs a viscoelastic body: elastic bodies do not change in time",
        hint: "give `moduli` and `times` in [lower.viscoelastic]",
        at: "history.dwell",
        example: &[r#"history = [{ dwell = "1 s" }]"#],
        broken: |tables| tables.of_stage(&TIMES).filter(|_| tables.viscoelastic().is_none()),
    },
    Rule {
        this: "`duration`, `dwell` of a stage",
        with: "`cycles`",
        message: "'{key}' has no meaning with 'cycles', whose time is their `period`",
        hint: "give the `period`",
        at: "history.duration",
        example: &[RELAXES, r#"history = [{ load = "1 N", cycles = 10, duration = "1 s" }]"#],
        broken: |tables| {
            let both = |stage: &StageSpec| {
                stage.cycles.is_some() && (stage.duration.is_some() || stage.dwell.is_some())
            };
            tables.of_stage(&TIMES).filter(|_| tables.case.history.iter().any(both))
        },
    },
    Rule {
        this: "`cycles` of viscoelastic bodies",
        with: "no `period`",
        message: "the cycles of viscoelastic bodies need a time",
        hint: "give the `period`",
        at: "history.cycles",
        example: &[RELAXES, r#"history = [{ dwell = "1 s" }, { load = "1 N", cycles = 10 }]"#],
        broken: |tables| {
            let timeless = |stage: &StageSpec| stage.cycles.is_some() && stage.period.is_none();
            tables
                .viscoelastic()
                .and(tables.of_stage(&["cycles"]))
                .filter(|_| tables.case.history.iter().any(timeless))
        },
    },
    Rule {
        this: "[[history]] of viscoelastic bodies",
        with: "[motion], [sliding], [friction], [adhesion], [plasticity]",
        message: "viscoelastic bodies in time do not support [{key}]",
        hint: "they are loaded without friction, and do not move",
        at: "friction",
        example: &[RELAXES, r#"history = [{ dwell = "1 s" }]"#, RUBS],
        broken: |tables| {
            tables.viscoelastic().and(tables.at("history"))?;
            ["motion", "sliding", "friction", "adhesion", "plasticity"]
                .iter()
                .find_map(|table| tables.at(table))
        },
    },
    Rule {
        this: "`max_jump` above 1",
        with: "`cycles` of viscoelastic bodies",
        message: "the cycles of viscoelastic bodies in time are not extrapolated",
        hint: "set `max_jump = 1`, or leave [acceleration] out",
        at: "acceleration",
        example: &[
            RELAXES,
            r#"lower.fatigue = { torsion = "35 MPa", tension = "60 MPa" }"#,
            r#"fatigue = { to = "8 um" }"#,
            r#"history = [{ load = "1 N", cycles = 10, period = "1 s" }]"#,
            JUMPS,
        ],
        broken: |tables| {
            tables.viscoelastic().and(tables.at("history"))?;
            tables.at("acceleration").filter(|_| tables.jumps())
        },
    },
    Rule {
        this: "[steady]",
        with: "elastic bodies",
        message: "[steady] needs a viscoelastic body: elastic bodies have the same contact at every speed",
        hint: "give `moduli` and `times` in [lower.viscoelastic]",
        at: "steady",
        example: &[STEADY],
        broken: |tables| tables.at("steady").filter(|_| tables.viscoelastic().is_none()),
    },
    Rule {
        this: "[steady]",
        with: "[motion], [sliding], [[history]], [friction], [adhesion], [plasticity], [acceleration], [subsurface]",
        message: "[steady] does not support [{key}]",
        hint: "steady sliding is the contact alone, and the drag of its dissipation",
        at: "motion",
        example: &[RELAXES, STEADY, AT_ANY_SPEED],
        broken: |tables| {
            tables.case.steady.as_ref()?;
            OTHERS.iter().find_map(|table| tables.at(table))
        },
    },
    Rule {
        this: "[lower.viscoelastic], [upper.viscoelastic]",
        with: "a hardness or `plasticity` of either body",
        message: "viscoelastic bodies do not support '{key}'",
        hint: "the contact is that of elastic and viscoelastic bodies; beside a `material` with a hardness give `hardness = inf`",
        at: "lower.hardness",
        example: &[RELAXES, STEADY, r#"lower.hardness = "3 GPa""#],
        broken: |tables| {
            tables.viscoelastic()?;
            ["lower", "upper"].iter().find_map(|body| {
                let of = if *body == "lower" { &tables.case.lower } else { &tables.case.upper };
                let hardness =
                    || ["hardness", "material"].iter().find_map(|key| tables.at(&format!("{body}.{key}")));
                let yields = of.hardness.yields().then(hardness).flatten();
                yields.or_else(|| tables.at(&format!("{body}.plasticity")))
            })
        },
    },
    Rule {
        this: "[lower.viscoelastic], [upper.viscoelastic]",
        with: "`young = inf` or `base = \"rigid\"` of this body",
        message: "a rigid body does not relax",
        hint: "give the relaxed modulus `young`, or `viscoelastic` in the table of a layer",
        at: "lower.viscoelastic",
        example: &[STEADY, RELAXES, r#"lower.young = inf"#],
        broken: |tables| {
            tables.of_body("viscoelastic", |body| {
                body.properties.viscoelastic.is_some() && body.material.young.is_infinite()
            })
        },
    },
    Rule {
        this: "layers of viscoelastic bodies, or viscoelastic layers",
        with: "[motion], [sliding], [[history]]",
        message: "viscoelastic bodies with layers slide steadily, and do not support [{key}]: each wave on layers has its own retardation times",
        hint: "give the `speed` or the `speeds` in [steady], or leave the layers out",
        at: "motion",
        example: &[RELAXES, COATED, AT_ANY_SPEED],
        broken: |tables| {
            tables.viscoelastic().filter(|_| tables.case.is_coated())?;
            ["motion", "sliding", "history"].iter().find_map(|table| tables.at(table))
        },
    },
    Rule {
        this: "[steady] of bodies with layers",
        with: "a boundary that is not `\"periodic\"`",
        message: "steady sliding of bodies with layers needs a boundary that is periodic along both axes",
        hint: "set `boundary = \"periodic\"` in [contact]: layers are solved wave by wave, each at its own frequency",
        at: "contact",
        example: &[RELAXES, COATED, STEADY],
        broken: |tables| {
            tables.case.steady.as_ref().filter(|_| tables.case.is_coated())?;
            let is_periodic = tables.case.contact.boundary.leaves_mean_free();
            tables.at("contact.boundary").or(tables.at("contact")).filter(|_| !is_periodic)
        },
    },
    Rule {
        this: "[steady]",
        with: "`loads`, `mean_pressures`, `approaches` in [contact]",
        message: "[steady] goes from speed to speed under one load, not '{key}'",
        hint: "give one `load`, or a study over it",
        at: "contact.loads",
        example: &[RELAXES, STEADY, r#"contact = { loads = ["1 N", "2 N"] }"#],
        broken: |tables| {
            tables.case.steady.as_ref()?;
            tables.first("contact", &["loads", "mean_pressures", "approaches"])
        },
    },
    Rule {
        this: "[steady]",
        with: "`boundary = [\"periodic\", \"free\"]`",
        message: "steady sliding is not computed on a grid that is periodic along x alone",
        hint: "`\"free\"`, `\"periodic\"` or `[\"free\", \"periodic\"]`",
        at: "contact.boundary",
        example: &[RELAXES, STEADY, r#"contact = { load = "1 N", boundary = ["periodic", "free"] }"#],
        broken: |tables| {
            tables.case.steady.as_ref()?;
            let boundary = tables.case.contact.boundary;
            tables.at("contact.boundary").filter(|_| boundary.repeats(0) && !boundary.repeats(1))
        },
    },
    Rule {
        this: "[steady]",
        with: "`method = \"direct\"`, `\"polonsky-keer\"`, a `device`",
        message: "steady sliding has a solver of its own, and no other '{key}'",
        hint: "leave it out",
        at: "contact.method",
        example: &[RELAXES, STEADY, r#"contact = { load = "1 N", method = "direct" }"#],
        broken: |tables| {
            tables.case.steady.as_ref()?;
            let is_own = matches!(tables.case.contact.method, super::super::Method::Auto);
            let is_here = tables.case.contact.device == super::super::Device::Cpu;
            let method = tables.at("contact.method").filter(|_| !is_own);
            method
                .or_else(|| tables.at("contact.device").filter(|_| !is_here))
                .or_else(|| tables.at("steady").filter(|_| !is_here))
        },
    },
    Rule {
        this: "`wlf_c1`, `wlf_c2`, `wlf_at`",
        with: "no [temperature]",
        message: "the shift of Williams, Landel and Ferry needs the temperature of the body",
        hint: "give `bulk` in [temperature]",
        at: "lower.viscoelastic.wlf_c1",
        example: &[
            STEADY,
            r#"lower.viscoelastic = { moduli = ["1 GPa"], times = ["1 s"], wlf_c1 = 8.9, wlf_c2 = "102 K", wlf_at = "20 °C" }"#,
        ],
        broken: |tables| tables.shifted().filter(|_| tables.case.temperature.is_none()),
    },
    Rule {
        this: "[motion] of viscoelastic bodies",
        with: "no `speed`; in a shift no `speed_lower` and no `speed_upper`",
        message: "passes of viscoelastic bodies need a speed",
        hint: "for example `speed = \"10 mm/s\"` in an overlap, `speed_upper = \"10 mm/s\"` in a shift",
        at: "motion",
        example: &[RELAXES, AT_ANY_SPEED],
        broken: |tables| {
            let given = tables.first("motion", &["speed", "speed_lower", "speed_upper"]);
            tables.viscoelastic().and(tables.at("motion")).filter(|_| given.is_none())
        },
    },
    Rule {
        this: "[lower.viscoelastic]",
        with: "[sliding]",
        message: "the contact moves over the lower body of [sliding]: a viscoelastic body must be the upper one",
        hint: "exchange the bodies, or let them pass over each other in a [motion]",
        at: "lower.viscoelastic",
        example: &[RELAXES, CHANGES, SLIDES],
        broken: |tables| {
            tables.at("sliding")?;
            tables.viscoelastic().filter(|_| tables.case.lower.properties.viscoelastic.is_some())
        },
    },
    Rule {
        this: "[sliding] of viscoelastic bodies",
        with: "no `speed`",
        message: "viscoelastic bodies that slide in place need a speed",
        hint: "for example `speed = \"10 mm/s\"` in [sliding]",
        at: "sliding",
        example: &[r#"upper.viscoelastic = { moduli = ["1 GPa"], times = ["1 s"] }"#, CHANGES, SLIDES],
        broken: |tables| {
            tables.viscoelastic()?;
            tables
                .at("sliding")
                .filter(|_| tables.case.sliding.is_some_and(|sliding| sliding.speed.is_none()))
        },
    },
    Rule {
        this: "[sliding] of viscoelastic bodies",
        with: "[adhesion], [plasticity], a friction that displaces the bodies normally",
        message: "viscoelastic bodies that slide in place do not support '{key}'",
        hint: "a friction may have `coupling = \"none\"`",
        at: "adhesion",
        example: &[
            r#"upper.viscoelastic = { moduli = ["1 GPa"], times = ["1 s"] }"#,
            CHANGES,
            r#"sliding = { distance = "1 m", speed = "1 m/s" }"#,
            r#"adhesion = { work = "0.05 J/m2", range = "1 nm" }"#,
        ],
        broken: |tables| {
            tables.viscoelastic().and(tables.at("sliding"))?;
            let pushes = tables.case.shear_displaces_normally();
            let first = ["adhesion", "plasticity"].iter().find_map(|table| tables.at(table));
            first.or_else(|| tables.at("friction").filter(|_| pushes))
        },
    },
    Rule {
        this: "`strategy = \"shift\"` of viscoelastic bodies",
        with: "a boundary free along x",
        message: "viscoelastic bodies in a shift need a boundary that is periodic along x",
        hint: "set `boundary = \"periodic\"` in [contact], or `strategy = \"overlap\"`",
        at: "motion.strategy",
        example: &[RELAXES, r#"motion = { strategy = "shift", speed_upper = 1 }"#],
        broken: |tables| {
            tables.viscoelastic().and(tables.shift())?;
            tables.at("motion.strategy").filter(|_| !tables.case.contact.boundary.repeats(0))
        },
    },
    Rule {
        this: "[motion] of viscoelastic bodies",
        with: "[adhesion], [plasticity], thermal constants, a friction that displaces the bodies normally",
        message: "passes of viscoelastic bodies do not support '{key}'",
        hint: "a friction may have `coupling = \"none\"`",
        at: "adhesion",
        example: &[
            RELAXES,
            r#"contact = { load = "2 N", boundary = "periodic" }"#,
            MOVES,
            r#"adhesion = { work = "0.05 J/m2", range = "1 nm" }"#,
        ],
        broken: |tables| {
            tables.viscoelastic().and(tables.motion())?;
            let pushes = tables.case.shear_displaces_normally();
            let first = ["adhesion", "plasticity"].iter().find_map(|table| tables.at(table));
            first.or_else(|| tables.flash()).or_else(|| tables.at("friction").filter(|_| pushes))
        },
    },
    Rule {
        this: "[motion] of viscoelastic bodies",
        with: "`device` in [contact]",
        message: "a device does not solve passes of viscoelastic bodies",
        hint: ON_PROCESSOR,
        at: "motion",
        example: &[ON_DEVICE, RELAXES, MOVES],
        broken: |tables| tables.on_device("motion", Case::relaxes),
    },
    Rule {
        this: "`pause` in [motion]",
        with: "elastic bodies",
        message: "'pause' needs a viscoelastic body: elastic bodies do not change while they are apart",
        hint: "give `moduli` and `times` in [lower.viscoelastic]",
        at: "motion.pause",
        example: &[r#"motion = { speed = "0.5 m/s", pause = "1 s" }"#],
        broken: |tables| tables.at("motion.pause").filter(|_| tables.viscoelastic().is_none()),
    },
];
