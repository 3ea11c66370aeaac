//! Rules of the stress below the surface.

use super::Rule;

pub(super) const RULES: &[Rule] = &[Rule {
    this: "`step` in [subsurface]",
    with: "a static contact",
    message: "'step' needs [motion]",
    hint: "leave it out: a static contact has one position",
    at: "subsurface.step",
    example: &[r#"subsurface = { to = "20 um", step = 3 }"#],
    broken: |tables| tables.at("subsurface.step").filter(|_| tables.case.motion.is_none()),
}];
