//! Rules of one body, and of two.

use super::super::Case;
use super::Rule;

pub(super) const RULES: &[Rule] = &[Rule {
    this: "`young = inf`",
    with: "`young = inf` of the other body",
    message: "both bodies are rigid",
    hint: "give one of them a finite 'young' or a coating",
    at: "upper.young",
    example: &["lower.young = inf", "upper.young = inf"],
    broken: |tables| {
        let Case { lower, upper, .. } = tables.case;
        let rigid = asperity_contact::material::composite_modulus(&lower.material, &upper.material).is_err();
        tables.at("upper.young").filter(|_| rigid)
    },
}];
