//! The keys above all tables.

use super::Fallback::{Absent, Required};
use super::typed::{Nested, Optional, TEXT, optional, section, table, tables};

section! { &[], "";
    TITLE: Optional<String> =
        optional("title", TEXT, "the file's name without its extension", "\"a ball on a plate\"", "a name for reports");
    LOWER: Nested = table("lower", Required, "the body underneath");
    UPPER: Nested = table("upper", Required, "the body above");
    CONTACT: Nested = table("contact", Required, "what presses the bodies together");
    FRICTION: Nested = table("friction", Absent("none"), "their friction, and what acts in the plane");
    HISTORY: Nested = tables("history", Absent("none"), "further stages of the loading of a static contact");
    MOTION: Nested = table("motion", Absent("none: one static contact"), "how the bodies move");
    SLIDING: Nested = table(
        "sliding",
        Absent("none"),
        "a static contact that slides some distance and wears in place",
    );
    ACCELERATION: Nested = table(
        "acceleration",
        Absent("none: each is computed"),
        "how many passes of bodies that wear a computed pass may stand for",
    );
    TEMPERATURE: Nested = table("temperature", Absent("not known"), "how warm the bodies are");
    PLASTICITY: Nested = table(
        "plasticity",
        Absent("none"),
        "the volume under the surface in which bodies deform plastically",
    );
    SUBSURFACE: Nested = table("subsurface", Absent("none"), "the stress under the surface that is wanted");
    OUTPUT: Nested = table("output", Absent("its defaults"), "what is kept");
}
