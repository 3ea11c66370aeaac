//! Keys above all tables.

use super::{Exists, Fallback, Key, Kind};
use Fallback::{Absent, Required};

/// The keys above all tables, without those of interfaces and capabilities.
pub(super) const KEYS: &[Key] = &[
    Key {
        name: "title",
        kind: Kind::Text,
        default: Absent("file name without its extension"),
        example: "\"a ball on a plate\"",
        text: "a name for reports",
        exists: Exists::Undeclared,
    },
    table("lower", Required, "the body underneath"),
    table("upper", Required, "the body above"),
    table("contact", Required, "load or approach, boundary, solver"),
    table("friction", Absent("none"), "friction law and tangential loading"),
    Key {
        kind: Kind::Tables,
        ..table("history", Absent("none"), "further stages of the loading of a static contact")
    },
    table("motion", Absent("none: one static contact"), "motion of the bodies"),
    table("sliding", Absent("none"), "static contact that slides in place while laws change its bodies"),
    table("steady", Absent("none"), "steady sliding of viscoelastic bodies"),
    table(
        "acceleration",
        Absent("none: every pass is computed"),
        "extrapolation over passes of bodies that laws change",
    ),
    table("temperature", Absent("unknown"), "temperature of the bodies"),
    table("plasticity", Absent("none"), "volume below the surface in which bodies deform plastically"),
    table("subsurface", Absent("none"), "stress below the surface"),
    table("output", Absent("its defaults"), "stored results"),
];

/// A table within a table.
pub(super) const fn table(name: &'static str, default: Fallback, text: &'static str) -> Key {
    Key { name, kind: Kind::Table, default, example: "", text, exists: Exists::Undeclared }
}
