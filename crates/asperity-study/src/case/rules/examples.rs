//! Keys shared by several examples, as written above the tables of a case file.

/// A law changes a body: the example of the first law.
pub(super) const CHANGES: &str = r#"lower.wear = { coefficient = "1e-7 mm3/(N m)" }"#;

/// A body deforms plastically.
pub(super) const FLOWS: &str = r#"lower.plasticity = { yield_stress = "1.5 GPa" }"#;

/// The volume of elasto-plastic bodies.
pub(super) const VOLUME: &str = r#"plasticity = { depth = "20 um", layers = 16 }"#;

/// A body is coated.
pub(super) const COATED: &str =
    r#"lower.coating = { thickness = "2 um", young = "300 GPa", poisson = 0.25 }"#;

/// The lower body conducts heat.
pub(super) const CONDUCTS: &str = r#"lower.conductivity = "46 W/(m K)"
lower.heat_capacity = "460 J/(kg K)"
lower.density = "7850 kg/m3""#;

/// The upper body conducts heat.
pub(super) const UPPER_CONDUCTS: &str = r#"upper.conductivity = "46 W/(m K)"
upper.heat_capacity = "460 J/(kg K)"
upper.density = "7850 kg/m3""#;

/// The bodies have a temperature.
pub(super) const WARM: &str = r#"temperature = { bulk = "100 °C" }"#;

/// The bodies slide in place.
pub(super) const SLIDES: &str = r#"sliding = { distance = "1 m" }"#;

/// The upper body passes over the lower one at a speed.
pub(super) const MOVES: &str = r#"motion = { speed = "0.5 m/s" }"#;

/// The upper body passes over the lower one.
pub(super) const AT_ANY_SPEED: &str = "motion = {}";

/// A line contact.
pub(super) const LINE: &str = r#"contact = { load = "2 N", boundary = ["free", "periodic"] }"#;

/// A device solves the contact.
pub(super) const ON_DEVICE: &str = r#"contact = { load = "2 N", device = "host" }"#;

/// Several loads.
pub(super) const SWEEP: &str = r#"contact = { loads = ["1 N", "2 N"] }"#;

/// The upper body is random.
pub(super) const GENERATED: &str =
    r#"upper.topography = { generate = "low-pass", sq = "0.1 um", cutoff = "8 um" }"#;

/// The bodies have friction.
pub(super) const RUBS: &str = "friction = { coefficient = 0.3 }";

/// The bodies roll.
pub(super) const ROLLS: &str = "friction = { coefficient = 0.3, creepage = 0.001 }";

/// The bodies slide steadily.
pub(super) const STEADY: &str = r#"steady = { speed = "1 m/s" }"#;

/// The bodies have an oil between them.
pub(super) const OIL: &str =
    r#"lubrication = { viscosity = "40 mPa s", pressure_viscosity = "20 1/GPa", speed = "0.1 m/s" }"#;

/// Passes are extrapolated.
pub(super) const JUMPS: &str = "acceleration = {}";
