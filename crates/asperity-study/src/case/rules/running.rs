//! Rules of bodies that wear and grow films.

use super::super::{Body, CounterBody, FilmSpec, OffsetY, WearKey, WearSpec};
use super::Rule;
use super::examples::{AT_ANY_SPEED, GENERATED, GROWS, JUMPS, LINE, MOVES, RUBS, SLIDES, WARM, WEARS};
use asperity_contact::motion::{FilmLaw, FilmStress, PlasticUpdate};

pub(super) const RULES: &[Rule] = &[
    Rule {
        this: "[friction] in a motion",
        with: "equal speeds",
        message: "[friction] needs surfaces with different speeds",
        hint: "give the speeds different values, or leave [friction] out",
        at: "friction",
        example: &[RUBS, r#"motion = { strategy = "shift", speed_lower = 1, speed_upper = 1 }"#],
        broken: |tables| {
            tables.motion().filter(|motion| motion.strategy.direction() == 0.0)?;
            tables.at("friction")
        },
    },
    Rule {
        this: "a film that grows in [sliding]",
        with: "no `speed`",
        message: "missing key 'speed' in [sliding]: films grow with time",
        hint: "for example `speed = \"10 mm/s\"` in [sliding]",
        at: "sliding",
        example: &[GROWS, SLIDES, WARM],
        broken: |tables| {
            tables.film_that_grows()?;
            tables.at("sliding").filter(|_| tables.at("sliding.speed").is_none())
        },
    },
    Rule {
        this: "wear, a film",
        with: "a static contact",
        message: "{key} needs [motion], [sliding], or [friction] with a force or a displacement",
        hint: "add a [motion] with its `speed`, [sliding], or [friction] and stages of a [[history]] in which the bodies slip",
        at: "lower.wear",
        example: &[WEARS],
        broken: |tables| {
            let given = tables.of_body("wear", |_| true).or(tables.of_body("film", |_| true));
            given.filter(|_| !tables.slides() && !tables.frets())
        },
    },
    Rule {
        this: "a film that grows",
        with: "stages without `cycles`",
        message: "a film grows with time, which passes only in the cycles of a stage",
        hint: "give a stage of the [[history]] `cycles` and a `period`",
        at: "lower.film",
        example: &[GROWS, RUBS],
        broken: |tables| {
            let has_time = tables.case.history.iter().any(|stage| stage.cycles.is_some());
            tables.film_that_grows().filter(|_| tables.frets() && !has_time)
        },
    },
    Rule {
        this: "a film that grows in cycles",
        with: "no `period`",
        message: "missing key 'period' in [[history]]: films grow with time",
        hint: "for example `period = \"50 ms\"`, the time of a cycle",
        at: "history",
        example: &[GROWS, RUBS, r#"history = [{ force = "0.1 N", cycles = 10 }]"#],
        broken: |tables| {
            tables.film_that_grows()?;
            let has_none =
                tables.case.history.iter().any(|stage| stage.cycles.is_some() && stage.period.is_none());
            tables.at("history").filter(|_| has_none && tables.frets())
        },
    },
    Rule {
        this: "a film that grows in an overlap",
        with: "no `speed`",
        message: "missing key 'speed' in [motion]: films grow with time",
        hint: "for example `speed = \"0.5 m/s\"` in [motion]",
        at: "motion",
        example: &[GROWS, AT_ANY_SPEED, WARM],
        broken: |tables| {
            tables.film_that_grows()?;
            tables.overlap().filter(|motion| motion.speed.is_none())?;
            tables.at("motion")
        },
    },
    Rule {
        this: "a film that grows in a shift",
        with: "no speeds",
        message: "missing key 'speed_upper' in [motion]: films grow with time",
        hint: "for example `speed_upper = \"0.5 m/s\"` in [motion]",
        at: "motion",
        example: &[GROWS, r#"motion = { strategy = "shift" }"#, WARM],
        broken: |tables| {
            tables.film_that_grows()?;
            tables.shift()?;
            let given = tables.first("motion", &["speed_upper", "speed_lower"]);
            tables.at("motion").filter(|_| given.is_none())
        },
    },
    Rule {
        this: "wear",
        with: "equal speeds",
        message: "wear needs surfaces with different speeds",
        hint: "give the speeds different values, or leave the wear out",
        at: "lower.wear",
        example: &[WEARS, r#"motion = { strategy = "shift", speed_lower = 1, speed_upper = 1 }"#],
        broken: |tables| {
            tables.motion().filter(|motion| motion.strategy.direction() == 0.0)?;
            tables.of_body("wear", |_| true)
        },
    },
    Rule {
        this: "wear, a film",
        with: "`plastic_update = \"step\"`",
        message: "'plastic_update' is {value}, expected \"pass\" with wear or films",
        hint: "",
        at: "motion.plastic_update",
        example: &[WEARS, r#"motion = { speed = "0.5 m/s", plastic_update = "step" }"#],
        broken: |tables| {
            let step = tables.motion().is_some_and(|motion| motion.plastic_update == PlasticUpdate::Step);
            tables.at("motion.plastic_update").filter(|_| step && tables.case.runs_in())
        },
    },
    Rule {
        this: "`energy` in a wear",
        with: "no [friction]",
        message: "'energy' needs [friction]",
        hint: "add a [friction] table with its `coefficient`",
        at: "lower.wear.energy",
        example: &[r#"lower.wear = { energy = "1e-6 mm3/J" }"#, MOVES],
        broken: |tables| {
            let by_energy =
                |body: &Body| matches!(body.wear, Some(WearSpec { coefficient: WearKey::Energy(_), .. }));
            tables.of_body("wear.energy", by_energy).filter(|_| tables.case.friction.is_none())
        },
    },
    Rule {
        this: "`stress = \"shear\"` of a film",
        with: "no [friction]",
        message: "stress = \"shear\" needs [friction]",
        hint: "add a [friction] table with its `coefficient`",
        at: "lower.film.stress",
        example: &[
            r#"lower.film = { law = "arrhenius", max_thickness = "150 nm", rate = "20 nm/s", at_temperature = "100 °C", at_stress = "3 GPa", activation_energy = "0.8 eV", activation_volume = "3.8e-3 nm3", stress = "shear" }"#,
            MOVES,
            WARM,
        ],
        broken: |tables| {
            let by_shear = |body: &Body| {
                matches!(
                    body.film,
                    Some(FilmSpec { law: FilmLaw::Arrhenius { stress: FilmStress::Shear, .. }, .. })
                )
            };
            tables.of_body("film.stress", by_shear).filter(|_| tables.case.friction.is_none())
        },
    },
    Rule {
        this: "a film that grows",
        with: "no [temperature]",
        message: "a film that grows needs [temperature]",
        hint: "add `[temperature]` with `bulk = \"100 °C\"`",
        at: "lower.film",
        example: &[GROWS, MOVES],
        broken: |tables| tables.film_that_grows().filter(|_| tables.case.temperature.is_none()),
    },
    Rule {
        this: "[acceleration]",
        with: "bodies without wear and film",
        message: "[acceleration] needs a body with wear or a film",
        hint: "give a body `[lower.wear]` or `[lower.film]`, or leave [acceleration] out",
        at: "acceleration",
        example: &[MOVES, JUMPS],
        broken: |tables| tables.at("acceleration").filter(|_| !tables.case.runs_in()),
    },
    Rule {
        this: "`max_jump` above 1",
        with: "`counter = \"fresh\"`",
        message: "extrapolation needs passes that repeat: counter = \"fresh\" changes the upper body",
        hint: "set `max_jump = 1`, or `counter = \"same\"`",
        at: "acceleration",
        example: &[WEARS, GENERATED, r#"motion = { speed = "0.5 m/s", counter = "fresh" }"#, JUMPS],
        broken: |tables| {
            tables.motion().filter(|motion| motion.counter == CounterBody::Fresh && tables.jumps())?;
            tables.at("acceleration")
        },
    },
    Rule {
        this: "`max_jump` above 1",
        with: "`offset_y`",
        message: "extrapolation needs passes that repeat: 'offset_y' moves the surfaces in each pass",
        hint: "set `max_jump = 1`, or `offset_y = 0`",
        at: "acceleration",
        example: &[WEARS, LINE, r#"motion = { speed = "0.5 m/s", offset_y = "random" }"#, JUMPS],
        broken: |tables| {
            tables.motion().filter(|motion| motion.offset_y != OffsetY::NONE && tables.jumps())?;
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
            WEARS,
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
