//! Rules of contacts that a device solves.

use asperity_contact::solver::{Device, Method};

use super::examples::{AT_ANY_SPEED, CHANGES, FLOWS, ON_DEVICE, RUBS, SLIDES, VOLUME};
use super::{Case, Entry, Rule, Tables};

/// The hint of what only the processor solves.
pub(super) const ON_PROCESSOR: &str = "leave `device` out of [contact], and the processor solves it";

pub(super) const RULES: &[Rule] = &[
    Rule {
        this: "`method = \"direct\"`, `\"polonsky-keer\"`",
        with: "`device` in [contact]",
        message: "'{key}' is {value}, and a device solves a contact by the active set",
        hint: "leave `method` out, or `device`",
        at: "contact.method",
        example: &[r#"contact = { load = "2 N", device = "host", method = "direct" }"#],
        broken: |tables| {
            let active_set = matches!(tables.case.contact.method, Method::Auto | Method::ActiveSet);
            tables.on_device("contact.method", |_| !active_set)
        },
    },
    Rule {
        this: "[friction] without [motion] or [sliding]",
        with: "`device` in [contact]",
        message: "a device does not solve friction with stick, or rolling",
        hint: ON_PROCESSOR,
        at: "friction",
        example: &[ON_DEVICE, RUBS],
        broken: |tables| tables.on_device("friction", |case| case.motion.is_none() && case.sliding.is_none()),
    },
    Rule {
        this: "[friction] of a [motion] whose shear displaces the bodies normally",
        with: "`device` in [contact]",
        message: "a device does not solve sliding whose shear displaces the bodies normally",
        hint: "set `coupling = \"goodman\"` or `\"none\"` in [friction]",
        at: "friction",
        example: &[
            ON_DEVICE,
            r#"friction = { coefficient = 0.3, coupling = "full" }"#,
            AT_ANY_SPEED,
            "upper.young = inf",
        ],
        broken: |tables| {
            tables.on_device("friction", |case| case.motion.is_some() && case.shear_displaces_normally())
        },
    },
    Rule {
        this: "[plasticity]",
        with: "`device` in [contact]",
        message: "a device does not solve bodies that deform plastically below the surface",
        hint: "give the bodies a `hardness` instead, or leave `device` out of [contact]",
        at: "plasticity",
        example: &[ON_DEVICE, VOLUME, FLOWS],
        broken: |tables| tables.on_device("plasticity", |_| true),
    },
    Rule {
        this: "[sliding]",
        with: "`device` in [contact]",
        message: "a device does not solve sliding in place",
        hint: ON_PROCESSOR,
        at: "sliding",
        example: &[ON_DEVICE, CHANGES, SLIDES],
        broken: |tables| tables.on_device("sliding", |_| true),
    },
];

impl<'a> Tables<'a> {
    /// Returns the entry of a key of a case that a device solves, if it `is` so.
    pub(super) fn on_device(&self, key: &str, is: impl Fn(&Case) -> bool) -> Option<Entry<'a>> {
        self.at(key).filter(|_| self.case.contact.device != Device::Cpu && is(self.case))
    }
}
