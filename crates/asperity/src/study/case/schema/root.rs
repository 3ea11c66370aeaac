//! The keys above all tables.

use super::Fallback::{Absent, Required};
use super::typed::{Nested, Optional, TEXT, optional, section, table, tables};

section! { &[], "";
    TITLE: Optional<String> =
        optional("title", TEXT, "the file's name without its extension", "\"a ball on a plate\"", "a name for reports");
    LOWER: Nested = table("lower", Required, "the body underneath");
    UPPER: Nested = table("upper", Required, "the body above");
    CONTACT: Nested = table("contact", Required, "load or approach, boundary, solver");
    FRICTION: Nested = table("friction", Absent("none"), "friction law and tangential loading");
    HISTORY: Nested = tables("history", Absent("none"), "further stages of the loading of a static contact");
    MOTION: Nested = table("motion", Absent("none: one static contact"), "motion of the bodies");
    SLIDING: Nested = table(
        "sliding",
        Absent("none"),
        "a static contact that slides some distance and wears in place",
    );
    ACCELERATION: Nested = table(
        "acceleration",
        Absent("none: each is computed"),
        "extrapolation over passes of bodies that wear",
    );
    TEMPERATURE: Nested = table("temperature", Absent("not known"), "temperature of the bodies");
    PLASTICITY: Nested = table(
        "plasticity",
        Absent("none"),
        "the volume under the surface in which bodies deform plastically",
    );
    SUBSURFACE: Nested = table("subsurface", Absent("none"), "stress below the surface");
    CONDUCTANCE: Nested = table("conductance", Absent("none"), "thermal or electrical conductance of the contacts");
    FLOW: Nested = table("flow", Absent("none"), "flow of a fluid through the gap");
    OUTPUT: Nested = table("output", Absent("its defaults"), "stored results");
}
