//! Magnitudes of each physical quantity that exist. A value outside most likely has another unit than its
//! author meant.
//!
//! The ranges have a factor of two or more beyond the extremes of data books: Kaye & Laby, Tables of Physical
//! and Chemical Constants; CRC Handbook of Chemistry and Physics; Ashby, Materials Selection in Mechanical
//! Design. Further sources are named beside the range.

use crate::table::Exists::{self, Any, Within};

const fn within(least: f64, most: f64, of: &'static str, slips: &'static [&'static str]) -> Exists {
    Within { least, most, of, slips }
}

/// Young's moduli.
pub const YOUNG: Exists = within(1e4, 1.3e12, "soft gels to diamond", &["GPa", "MPa"]);
/// Hardnesses.
pub const HARDNESS: Exists = within(1e6, 1.5e11, "wax to diamond", &["GPa", "MPa"]);
/// Thermal conductivities.
pub const CONDUCTIVITY: Exists = within(0.08, 4e3, "polymers to diamond", &["W/(mm K)"]);
/// Electrical resistivities.
pub const RESISTIVITY: Exists = within(5e-9, 1e19, "cooled copper to polymers", &["uohm cm"]);
/// Heat capacities.
pub const HEAT_CAPACITY: Exists = within(90.0, 6e3, "heavy metals to water", &["J/(g K)"]);
/// Densities.
pub const DENSITY: Exists = within(100.0, 2.5e4, "foam to osmium", &["g/cm3"]);
/// Thicknesses of layers.
pub const LAYER: Exists = within(2e-10, 1e-1, "a layer of atoms to claddings", &["um", "nm"]);
/// Volumes lost per load and distance: Archard's k = K/H.
///
/// Holm, Electric Contacts; Rabinowicz (1995): K from 10⁻⁹ (lubricated) to 10⁻² (metals
/// that seize).
pub const VOLUME_PER_WORK: Exists = within(
    1e-22,
    1e-10,
    "well lubricated bearings to dry metals that seize",
    &["dimensionless = {}", "mm3/(N m)"],
);
/// Coefficients of friction.
///
/// Bowden & Tabor, The Friction and Lubrication of Solids: above 3 clean metals in vacuum seize, and nothing
/// slides.
pub const FRICTION: Exists = within(1e-5, 3.0, "graphite without friction to rubber", &[]);
/// Shear strengths of interfaces.
pub const SHEAR_STRENGTH: Exists = within(1e2, 2e10, "liquid films to hard metals", &["MPa"]);
/// Speeds.
pub const SPEED: Exists = within(1e-13, 3e3, "creep of geological faults to projectiles", &["mm/s", "um/s"]);
/// Temperatures.
pub const TEMPERATURE: Exists = within(1.0, 4000.0, "liquid helium to melting tungsten", &["°C"]);
/// Sizes of cells.
pub const PITCH: Exists = within(1e-11, 1e-3, "atoms to cells that see no roughness", &["um", "nm"]);
/// Rms heights.
pub const ROUGHNESS: Exists = within(1e-12, 1e-2, "atomic planes to gravel roads", &["nm", "um"]);
/// Rms slopes.
pub const SLOPE: Exists = within(1e-6, 10.0, "polished silicon to brushes", &[]);
/// Radii of curvature.
pub const RADIUS: Exists =
    within(1e-10, 1e4, "tips of probes to the wheels of the largest machines", &["mm", "um"]);
/// Wavelengths.
pub const WAVE: Exists = within(1e-11, 1e2, "atoms to waviness of roads", &["um", "mm"]);

/// Angles.
pub const ANGLE: Exists = within(1e-6, 6.3, "parts of a second of arc to a full turn", &["deg"]);

/// Loads.
pub const LOAD: Exists = Any("a load has any size; the pressures of the result are judged");
/// Lengths.
pub const LENGTH: Exists = Any("a length beside the size of the surface, which is judged by its pitch");
/// Units of numbers in files.
pub const UNIT: Exists = Any("a unit, not a quantity");
