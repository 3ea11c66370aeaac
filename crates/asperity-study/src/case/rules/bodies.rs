//! Rules of one body, and of two.

use super::super::Case;
use super::Rule;
use super::examples::{MOVES, WARM};

pub(super) const RULES: &[Rule] = &[
    Rule {
        this: "`young = inf`",
        with: "`young = inf` of the other body",
        message: "both bodies are rigid",
        hint: "give one of them a finite 'young' or a coating",
        at: "upper.young",
        example: &["lower.young = inf", "upper.young = inf"],
        broken: |tables| {
            let Case { lower, upper, .. } = tables.case;
            let rigid =
                asperity_contact::material::composite_modulus(&lower.material, &upper.material).is_err();
            tables.at("upper.young").filter(|_| rigid)
        },
    },
    Rule {
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
        broken: |tables| tables.of_body("film.hardness", |body| !body.hardness.yields()),
    },
    Rule {
        this: "`under_film`",
        with: "no film on the body",
        message: "'under_film' needs a film on the same body",
        hint: "give the body a film, or leave 'under_film' out",
        at: "lower.wear.under_film",
        example: &[
            r#"lower.wear = { coefficient = "1e-7 mm3/(N m)", under_film = "1e-8 mm3/(N m)" }"#,
            MOVES,
        ],
        broken: |tables| tables.of_body("wear.under_film", |body| body.film.is_none()),
    },
];
