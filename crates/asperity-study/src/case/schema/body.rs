//! The keys of a body.

use super::Bounds::{AboveZero, AboveZeroOrInfinite, Between};
use super::Fallback::{Absent, Required};
use super::typed::{
    MATERIAL_NAME, Nested, Optional, Typed, Value, choice, number, optional, other, quantity, section, table,
};
use asperity_base::exists;
use asperity_base::units::Dimension;
use asperity_contact::material::NamedMaterial;

/// Poisson's ratio.
const RATIO: Value<f64> = number(Between { least: 0.0, most: 0.5, open: [false, false] });

/// An electrical resistivity.
const RESISTANCE: Value<f64> = quantity(Dimension::Resistivity, AboveZero).exists(exists::RESISTIVITY);

/// `[lower]` and `[upper]`.
pub(crate) mod both {
    use super::*;
    use crate::case::Hardness;
    use crate::case::schema::values::hardness as read;

    section! { &["lower", "upper"], "";
        MATERIAL: Optional<&'static NamedMaterial> = optional(
            "material",
            MATERIAL_NAME,
            "none",
            "\"steel\"",
            "material by name, see [materials](#materials): its `young`, `poisson` and `hardness`, and the constants of heat and current \
             where the case uses them; keys given beside it replace them",
        );
        YOUNG: Optional<f64> = optional(
            "young",
            quantity(Dimension::Pressure, AboveZeroOrInfinite("a rigid body")).exists(exists::YOUNG),
            "that of `material`; must be given without one",
            "\"210 GPa\"",
            "Young's modulus; for a coated body, the modulus below the coating; at most one uncoated body may be rigid",
        );
        POISSON: Optional<f64> = optional(
            "poisson",
            RATIO,
            "that of `material`; must be given without one",
            "0.3",
            "Poisson's ratio; for a coated body, the ratio below the coating",
        );
        HARDNESS: Typed<Hardness> = super::super::typed::defaulted(
            "hardness",
            other(
                Some(Dimension::Pressure),
                "pressure > 0, or `inf`: an elastic body, or a table: a [map](#a-map-of-the-hardness)",
                |_, entry| read::hardness(entry),
            )
            .exists(exists::HARDNESS),
            "inf",
            "\"4 GPa\"",
            "largest pressure of the body, or a map of it",
        );
        COATING: Nested =
            table("coating", Absent("none"), "elastic surface layer, see [below](#lowercoating-and-uppercoating)");
        TOPOGRAPHY: Nested = table("topography", Required, "its surface");
        PLASTICITY: Nested =
            table("plasticity", Absent("elastic"), "plastic deformation below the surface, see [below](#plasticity)");
        CONDUCTIVITY: Optional<f64> = optional(
            "conductivity",
            quantity(Dimension::Conductivity, AboveZeroOrInfinite("no resistance, only where heat passes a contact"))
                .exists(exists::CONDUCTIVITY),
            "unknown",
            "\"46 W/(m K)\"",
            "thermal conductivity, for the flash temperature and for heat that passes a contact; give it for both bodies",
        );
        RESISTIVITY: Optional<f64> = optional(
            "resistivity",
            RESISTANCE,
            "unknown",
            "\"1.7e-8 ohm m\"",
            "electrical resistivity, for a current that passes a contact; give it for both bodies",
        );
        HEAT_CAPACITY: Optional<f64> = optional(
            "heat_capacity",
            quantity(Dimension::HeatCapacity, AboveZero).exists(exists::HEAT_CAPACITY),
            "unknown",
            "\"460 J/(kg K)\"",
            "heat capacity; required with `conductivity`",
        );
        DENSITY: Optional<f64> = optional(
            "density",
            quantity(Dimension::Density, AboveZero).exists(exists::DENSITY),
            "unknown",
            "\"7850 kg/m3\"",
            "density; required with `conductivity`",
        );
    }
}

/// `[upper]` alone.
pub(crate) mod upper {
    use super::*;
    use crate::case::Mount;

    section! { &["upper"], "";
        MOUNT: Optional<Mount> = optional(
            "mount",
            choice::<Mount>(),
            "`\"turned-over\"`; `\"as-is\"` for an underside",
            "\"as-is\"",
            "`[upper]` only: orientation of its heights",
        );
    }
}
