//! Keys above all tables.

use super::Fallback::{Absent, Required};
use super::typed::{Nested, Optional, TEXT, optional, section, table, tables};

section! { &[], "";
    TITLE: Optional<String> =
        optional("title", TEXT, "file name without its extension", "\"a ball on a plate\"", "a name for reports");
    LOWER: Nested = table("lower", Required, "the body underneath");
    UPPER: Nested = table("upper", Required, "the body above");
    CONTACT: Nested = table("contact", Required, "load or approach, boundary, solver");
    FRICTION: Nested = table("friction", Absent("none"), "friction law and tangential loading");
    HISTORY: Nested = tables("history", Absent("none"), "further stages of the loading of a static contact");
    MOTION: Nested = table("motion", Absent("none: one static contact"), "motion of the bodies");
    SLIDING: Nested = table(
        "sliding",
        Absent("none"),
        "static contact that slides in place while laws change its bodies",
    );
    STEADY: Nested = table("steady", Absent("none"), "steady sliding of viscoelastic bodies");
    ACCELERATION: Nested = table(
        "acceleration",
        Absent("none: every pass is computed"),
        "extrapolation over passes of bodies that laws change",
    );
    TEMPERATURE: Nested = table("temperature", Absent("unknown"), "temperature of the bodies");
    PLASTICITY: Nested = table(
        "plasticity",
        Absent("none"),
        "volume below the surface in which bodies deform plastically",
    );
    SUBSURFACE: Nested = table("subsurface", Absent("none"), "stress below the surface");
    OUTPUT: Nested = table("output", Absent("its defaults"), "stored results");
}
