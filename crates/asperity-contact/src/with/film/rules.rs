//! Requirements of films.

use super::{Film, FilmLaw, FilmStress};
use crate::with::{Circumstances, LawRule, Slip, Timeless};

const GROWS: &str =
    r#"lower.film = { law = "mechano-chemical", max_thickness = "150 nm", x = 1e-16, c3 = 0, c4 = 0 }"#;
const WARM: &str = r#"temperature = { bulk = "100 °C" }"#;
const MOVES: &str = r#"motion = { speed = "0.5 m/s" }"#;
const RUBS: &str = "friction = { coefficient = 0.3 }";

pub(super) const RULES: &[LawRule<Film>] = &[
    LawRule {
        this: "a film",
        with: "[lower.viscoelastic], [upper.viscoelastic]",
        message: "viscoelastic bodies do not support '{key}'",
        hint: "leave the film out",
        at: "lower.film",
        example: &[r#"lower.viscoelastic = { moduli = ["1 GPa"], times = ["1 s"] }"#, GROWS, MOVES],
        broken: |_, case| case.relaxes,
    },
    LawRule {
        this: "a film",
        with: "a static contact",
        message: "film needs [motion], [sliding], or [friction] with a force or a displacement",
        hint: "add a [motion] with its `speed`, [sliding], or [friction] and stages of a [[history]] in which the bodies slip",
        at: "lower.film",
        example: &[GROWS],
        broken: |_, case| case.slip == Slip::None,
    },
    LawRule {
        this: "a film that grows in [sliding]",
        with: "no `speed`",
        message: "missing key 'speed' in [sliding]: films grow with time",
        hint: "for example `speed = \"10 mm/s\"` in [sliding]",
        at: "sliding",
        example: &[GROWS, r#"sliding = { distance = "1 m" }"#, WARM],
        broken: |film, case| lacks(film, case, Timeless::InPlace),
    },
    LawRule {
        this: "a film that grows",
        with: "stages without `cycles`",
        message: "a film grows with time, which passes only in the cycles of a stage",
        hint: "give a stage of the [[history]] `cycles` and a `period`",
        at: "lower.film",
        example: &[GROWS, RUBS],
        broken: |film, case| lacks(film, case, Timeless::Cycles),
    },
    LawRule {
        this: "a film that grows in cycles",
        with: "no `period`",
        message: "missing key 'period' in [[history]]: films grow with time",
        hint: "for example `period = \"50 ms\"`, the time of a cycle",
        at: "history",
        example: &[GROWS, RUBS, r#"history = [{ force = "0.1 N", cycles = 10 }]"#],
        broken: |film, case| lacks(film, case, Timeless::Period),
    },
    LawRule {
        this: "a film that grows in an overlap",
        with: "no `speed`",
        message: "missing key 'speed' in [motion]: films grow with time",
        hint: "for example `speed = \"0.5 m/s\"` in [motion]",
        at: "motion",
        example: &[GROWS, "motion = {}", WARM],
        broken: |film, case| lacks(film, case, Timeless::Overlap),
    },
    LawRule {
        this: "a film that grows in a shift",
        with: "no speeds",
        message: "missing key 'speed_upper' in [motion]: films grow with time",
        hint: "for example `speed_upper = \"0.5 m/s\"` in [motion]",
        at: "motion",
        example: &[GROWS, r#"motion = { strategy = "shift" }"#, WARM],
        broken: |film, case| lacks(film, case, Timeless::Shift),
    },
    LawRule {
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
        broken: |film, case| {
            let by_shear = matches!(film.law, FilmLaw::Arrhenius { stress: FilmStress::Shear, .. });
            by_shear && !case.has_friction
        },
    },
    LawRule {
        this: "a film that grows",
        with: "no [temperature]",
        message: "a film that grows needs [temperature]",
        hint: "add `[temperature]` with `bulk = \"100 °C\"`",
        at: "lower.film",
        example: &[GROWS, MOVES],
        broken: |film, case| film.law.takes_time() && !case.has_temperature,
    },
    LawRule {
        this: "`hardness` of a film",
        with: "no `hardness` of its body",
        message: "the film has a 'hardness', but its body has none",
        hint: "give the body a 'hardness', or leave out the hardness of the film",
        at: "lower.film.hardness",
        example: &[
            r#"lower.film = { law = "mechano-chemical", max_thickness = "150 nm", x = 1e-16, c3 = 0, c4 = 0, hardness = "2 GPa" }"#,
            MOVES,
            WARM,
        ],
        broken: |film, case| film.hardness.is_some() && !case.yields,
    },
];

/// Whether a film changes with a time that is not known, for this reason.
fn lacks(film: &Film, case: &Circumstances<'_>, reason: Timeless) -> bool {
    film.law.takes_time() && case.timeless == Some(reason)
}
