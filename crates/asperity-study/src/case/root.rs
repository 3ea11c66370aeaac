//! The keys above all tables.

use super::body::BodyKeys;
use super::{Contact, FrictionSpec, MotionSpec, Output, SlidingSpec, StageSpec, SubsurfaceSpec};
use asperity_contact::motion::Acceleration;
use asperity_contact::temperature::Temperature;
use asperity_contact::with::plasticity::PlasticRegion;
use asperity_contact::with::viscoelastic::Steady;
use asperity_derive::Table;

/// A case as it is written, without the tables of interfaces and capabilities. What a table means for another
/// is still open.
#[derive(Table, Debug, Clone, PartialEq)]
#[table()]
pub(super) struct Root {
    /// Name for reports.
    #[key(text, absent = "file name without its extension", example = "\"a ball on a plate\"")]
    pub(super) title: Option<String>,
    /// The body underneath.
    #[key(table)]
    pub(super) lower: BodyKeys,
    /// The body above.
    #[key(table)]
    pub(super) upper: BodyKeys,
    /// Load or approach, boundary, solver.
    #[key(table)]
    pub(super) contact: Contact,
    /// Friction law and tangential loading.
    #[key(table, absent = "none")]
    pub(super) friction: Option<FrictionSpec>,
    /// Further stages of the loading of a static contact.
    #[key(tables = StageSpec::read, default = Vec::new(), absent = "none")]
    pub(super) history: Vec<StageSpec>,
    /// Motion of the bodies.
    #[key(table, absent = "none: one static contact")]
    pub(super) motion: Option<MotionSpec>,
    /// Static contact that slides in place while laws change its bodies.
    #[key(table, absent = "none")]
    pub(super) sliding: Option<SlidingSpec>,
    /// Steady sliding of viscoelastic bodies.
    #[key(table, absent = "none")]
    pub(super) steady: Option<Steady>,
    /// Extrapolation over passes of bodies that laws change.
    #[key(table, absent = "none: every pass is computed")]
    pub(super) acceleration: Option<Acceleration>,
    /// Temperature of the bodies.
    #[key(table, absent = "unknown")]
    pub(super) temperature: Option<Temperature>,
    /// Volume below the surface in which bodies deform plastically.
    #[key(table, absent = "none")]
    pub(super) plasticity: Option<PlasticRegion>,
    /// Stress below the surface.
    #[key(table, absent = "none")]
    pub(super) subsurface: Option<SubsurfaceSpec>,
    /// Stored results.
    #[key(table, default = Output::default(), absent = "its defaults")]
    pub(super) output: Output,
}
