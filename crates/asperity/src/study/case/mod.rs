//! Case files: one TOML file says which bodies meet, under what, and how they move.
//!
//! Everything is checked that the file alone can tell; each mistake is shown where it stands. A [`Case`] is in SI
//! and serialises under the keys of the file; it deserialises into the same case.

mod body;
mod contact;
pub(in crate::study) mod cursor;
pub(in crate::study) mod document;
mod friction;
mod hardness;
mod motion;
mod output;
mod parse;
mod plasticity;
mod prescribed;
mod read_back;
pub mod rules;
mod running;
pub mod schema;
mod sliding;
mod source;
mod subsurface;
mod topography;

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use serde::{Serialize, Serializer};

use self::document::Document;
pub use self::friction::{FrictionSpec, InPlane, LoadingPath, StageSpec};
pub use self::hardness::{GivenMap, Hardness, HardnessMap};
pub use self::plasticity::{FlowSpec, HardeningKey, PlasticitySpec};
pub use self::prescribed::Prescribed;
pub use self::running::{FilmSpec, TemperatureSpec, WearKey, WearSpec};
pub use self::schema::values::plasticity::Keep;
pub use self::schema::values::subsurface::Side;
pub use self::sliding::SlidingSpec;
pub use self::source::{Layer, Source, TopographySpec};
pub use self::subsurface::SubsurfaceSpec;
use crate::choice::choice;
use crate::error::{Error, Result};
use crate::io::regular;
use crate::material::{Coating, Material};
use crate::motion::{
    Acceleration, LoadControl, Motion, OffsetY, Path as MotionPath, PlasticUpdate, Strategy,
};
pub use crate::operator::{Boundary, Edge};
use crate::solver::Control;
pub use crate::solver::Method;
use crate::temperature::Thermal;
use crate::units::SquareMetre;

/// A case, resolved to SI.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Case {
    /// The file's name where it gives none.
    pub title: String,
    /// The body underneath.
    pub lower: Body,
    /// The body above.
    #[serde(serialize_with = "with_mount")]
    pub upper: Body,
    /// What presses them together.
    pub contact: Contact,
    /// Friction of the bodies; none if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction: Option<FrictionSpec>,
    /// Stages of the loading of a static contact after the first, which `contact`, and `friction` if there is any, prescribe.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub history: Vec<StageSpec>,
    /// How they move; a static contact if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motion: Option<MotionSpec>,
    /// How a static contact slides in place; not at all if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sliding: Option<SlidingSpec>,
    /// How many passes a computed one may stand for; each is computed if absent.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "with_jumps")]
    pub acceleration: Option<Acceleration>,
    /// Temperatures of the bodies; not known if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub temperature: Option<TemperatureSpec>,
    /// The volumes of bodies that flow; none if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plasticity: Option<PlasticitySpec>,
    /// What is looked at under the surface; nothing if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub subsurface: Option<SubsurfaceSpec>,
    /// What is kept.
    pub output: Output,
    #[serde(skip)]
    document: Document,
}

/// One of the two bodies.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Body {
    /// The body's elastic constants; what it bears, [`Body::hardness`] tells.
    #[serde(flatten, serialize_with = "with_infinities")]
    pub material: Material,
    /// The most pressure that the body's cells bear; infinite where the file gives none.
    pub hardness: Hardness,
    /// How it flows below its surface; elastic if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plasticity: Option<FlowSpec>,
    /// What it conducts and stores of heat; not known if absent.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub thermal: Option<Thermal>,
    /// How it wears; not at all if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wear: Option<WearSpec>,
    /// The tribofilm that grows on it; none if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub film: Option<FilmSpec>,
    /// The body's surface.
    pub topography: TopographySpec,
    /// How the heights face: always [`Mount::AsIs`] for the lower body. `None` where the file is to tell: as they are if
    /// they are an underside, see [`Scan::is_underside`](crate::surface::Scan::is_underside), else turned over.
    #[serde(skip)]
    pub mount: Option<Mount>,
}

/// How the heights of a body become those of the case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mount {
    /// Measured material side up, then turned over about y: mirrored in x, the sign of the heights changed.
    TurnedOver,
    /// The heights are those of the case already.
    AsIs,
}

choice!(Mount: "turned-over" => TurnedOver, "as-is" => AsIs);

/// Load, boundary and solver.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Contact {
    /// The load or approach; the largest of a sweep.
    pub prescribed: Prescribed,
    /// The points of a sweep, all of one kind, each on virgin bodies; empty without a sweep.
    pub sweep: Vec<Prescribed>,
    /// What lies beyond the rim of the grid.
    pub boundary: Boundary,
    /// The solver.
    pub method: Method,
    /// Scale-free complementarity residual at which the solver stops, 0 < η < 1.
    pub tolerance: f64,
}

impl Serialize for Contact {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Keys<'a> {
            #[serde(flatten)]
            prescribed: Option<Prescribed>,
            #[serde(flatten)]
            sweep: BTreeMap<&'a str, Vec<f64>>,
            boundary: Boundary,
            method: Method,
            tolerance: f64,
        }
        let Self { prescribed, ref sweep, boundary, method, tolerance } = *self;
        let values = || sweep.iter().map(|point| point.value()).collect();
        let sweep: BTreeMap<_, _> =
            sweep.first().map(|point| (point.key_of_list(), values())).into_iter().collect();
        let prescribed = sweep.is_empty().then_some(prescribed);
        Keys { prescribed, sweep, boundary, method, tolerance }.serialize(serializer)
    }
}

/// A motion whose load is still that of [`Contact`]; see [`Case::motion`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct MotionSpec {
    /// Overlap or circular shift.
    #[serde(flatten, serialize_with = "with_speeds")]
    pub strategy: Strategy,
    /// ≥ 1.
    pub passes: usize,
    /// Cells per step, ≥ 1.
    pub stride: usize,
    /// What [`Contact::prescribed`] holds: the mean over a pass, or each position.
    pub control: ControlKind,
    /// When plastic deformation is applied.
    pub plastic_update: PlasticUpdate,
    /// Relative, on the pass-mean load, 0 < tolerance < 1.
    pub load_tolerance: f64,
    /// Speed of the upper body over the lower one in an overlap, where it is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
    /// One way, or there and back.
    #[serde(skip_serializing_if = "is_one_way")]
    pub path: MotionPath,
    /// Where along y the passes lie.
    #[serde(flatten, serialize_with = "with_seed")]
    pub offset_y: OffsetY,
    /// What meets the lower body in the passes after the first.
    #[serde(skip_serializing_if = "is_same")]
    pub counter: CounterBody,
}

/// The upper body in the passes after the first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CounterBody {
    /// The same as before.
    Same,
    /// One that is made anew for each, by the same generator from another seed.
    Fresh,
}

choice!(CounterBody: "same" => Same, "fresh" => Fresh);

impl MotionSpec {
    /// Whether all passes are alike: the same bodies meet at the same positions.
    pub fn repeats(&self) -> bool {
        self.counter == CounterBody::Same && self.under(Control::Approach(0.0)).repeats()
    }

    /// The motion under a control.
    fn under(&self, control: Control) -> Motion {
        Motion {
            strategy: self.strategy,
            passes: self.passes,
            stride: self.stride,
            control,
            load_control: self.control.load_control(),
            plastic_update: self.plastic_update,
            load_tolerance: self.load_tolerance,
            friction: None,
            speed: self.speed,
            bulk: None,
            path: self.path,
            offset_y: self.offset_y,
        }
    }
}

/// The control of a motion without its value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ControlKind {
    /// The mean load of a pass.
    PassLoad,
    /// The load at every position.
    StepLoad,
    /// The approach.
    Approach,
}

impl ControlKind {
    /// Where a load holds; of an approach it does not matter.
    fn load_control(self) -> LoadControl {
        match self {
            Self::StepLoad => LoadControl::Step,
            Self::PassLoad | Self::Approach => LoadControl::Pass,
        }
    }
}

choice!(ControlKind: "pass-load" => PassLoad, "step-load" => StepLoad, "approach" => Approach);

/// A [`Strategy`] without its speeds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StrategyKind {
    /// Only what faces is solved.
    Overlap,
    /// The surfaces are shifted circularly.
    Shift,
}

choice!(StrategyKind: "overlap" => Overlap, "shift" => Shift);

impl From<&Strategy> for StrategyKind {
    fn from(strategy: &Strategy) -> Self {
        match strategy {
            Strategy::Overlap => Self::Overlap,
            Strategy::Shift { .. } => Self::Shift,
        }
    }
}

/// What is kept of the results.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Output {
    /// The pressure field of every n-th position; 0: of none.
    pub pressure_every: usize,
    /// The part of a body's length at its free ends that is left out of what is told of its interior, 0 ≤ rim < ½.
    pub rim: f64,
    /// Whether all fields are written for ParaView, too.
    pub paraview: bool,
}

/// The largest case file that is read.
pub(in crate::study) const MAX_CASE_BYTES: u64 = 4 << 20;

impl Case {
    /// Whether a body is coated.
    pub fn is_coated(&self) -> bool {
        [&self.lower, &self.upper].into_iter().any(|body| body.material.coating.is_some())
    }

    /// Reads a case file; the files it names are looked for in its folder.
    ///
    /// # Errors
    /// [`Error::File`] if it cannot be read, [`Error::Case`] if it has a mistake.
    pub fn load(path: &Path) -> Result<Self> {
        let failed = |source| Error::File { path: path.to_owned(), source };
        let text = regular::read(path, "a case file", MAX_CASE_BYTES).map_err(failed)?;
        let text = String::from_utf8(text).map_err(|_| {
            failed(io::Error::new(io::ErrorKind::InvalidData, "stream did not contain valid UTF-8"))
        })?;
        Self::parse(&text, path, path.parent().unwrap_or(Path::new("")))
    }

    /// Reads a case from its text. `file` is the name for its errors, `folder` where the files it names lie.
    ///
    /// # Errors
    /// [`Error::Case`] if it has a mistake.
    pub fn parse(text: &str, file: &Path, folder: &Path) -> Result<Self> {
        parse::case(text, file, folder)
    }

    /// An error that the case shows only once it is put to work, at the place of a dotted `key`
    /// (`upper.topography.file`), or of the table that would hold it.
    pub fn error_at(&self, key: &str, message: impl Into<String>, hint: Option<String>) -> Error {
        self.document.error_at(key, message, hint)
    }

    /// The text of the case, with its places.
    pub(in crate::study) fn document(&self) -> &Document {
        &self.document
    }

    /// What the file says at a dotted `key`, as it is written there.
    pub(in crate::study) fn written(&self, key: &str) -> String {
        self.document.written(self.document.place(key))
    }

    /// The motion with its load. A mean pressure acts on `apparent_area`, that of all cells when all faces all.
    pub fn motion(&self, apparent_area: SquareMetre) -> Option<Motion> {
        Some(Motion {
            friction: self.friction.as_ref().map(|friction| friction.law),
            bulk: self.temperature.map(|temperature| temperature.bulk),
            ..self.motion?.under(self.contact.prescribed.control(apparent_area))
        })
    }

    /// The files that the case names.
    pub fn files(&self) -> impl Iterator<Item = &PathBuf> {
        [&self.lower, &self.upper].into_iter().flat_map(|body| {
            let surface = match &body.topography.source {
                Source::File { path, .. } => Some(path),
                _ => None,
            };
            let map = match &body.hardness {
                Hardness::Map(map) => Some(&map.path),
                Hardness::Uniform(_) | Hardness::Given(_) => None,
            };
            surface.into_iter().chain(map)
        })
    }
}

/// The topography of a table `[topography]` that stands alone, and the document that it stands in.
pub(in crate::study) fn topography_alone(text: &str, folder: &Path) -> Result<(TopographySpec, Document)> {
    parse::topography_alone(text, folder)
}

/// A number of the case as it is written out: JSON has no infinities, the case file has `inf`.
#[derive(Serialize)]
#[serde(untagged)]
enum Number {
    Finite(f64),
    Infinite(&'static str),
}

impl From<f64> for Number {
    fn from(value: f64) -> Self {
        if value.is_finite() { Self::Finite(value) } else { Self::Infinite("inf") }
    }
}

fn with_infinities<S: Serializer>(
    material: &Material,
    serializer: S,
) -> std::result::Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Keys {
        young: Number,
        poisson: f64,
        #[serde(skip_serializing_if = "Option::is_none")]
        coating: Option<Coating>,
    }
    let Material { young, poisson, coating, .. } = *material;
    Keys { young: young.into(), poisson, coating }.serialize(serializer)
}

fn with_jumps<S: Serializer>(
    acceleration: &Option<Acceleration>,
    serializer: S,
) -> std::result::Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Keys {
        tolerance: f64,
        max_jump: usize,
        max_wear: f64,
    }
    let keys = acceleration.map(|Acceleration { tolerance, max_jump, max_wear, .. }| Keys {
        tolerance,
        max_jump,
        max_wear,
    });
    keys.serialize(serializer)
}

fn with_mount<S: Serializer>(upper: &Body, serializer: S) -> std::result::Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Keys<'a> {
        #[serde(flatten)]
        body: &'a Body,
        mount: Option<Mount>,
    }
    Keys { body: upper, mount: upper.mount }.serialize(serializer)
}

// What is as it is by default is left out: cases of before these keys stay known by their digests.

fn is_one_way(path: &MotionPath) -> bool {
    *path == MotionPath::OneWay
}

fn is_same(counter: &CounterBody) -> bool {
    *counter == CounterBody::Same
}

fn with_seed<S: Serializer>(offset: &OffsetY, serializer: S) -> std::result::Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    #[serde(untagged)]
    enum Keys {
        None {},
        Cells { offset_y: usize },
        Random { offset_y: &'static str, seed: u64 },
    }
    let keys = match *offset {
        OffsetY::NONE => Keys::None {},
        OffsetY::Cells(offset_y) => Keys::Cells { offset_y },
        OffsetY::Random { seed } => Keys::Random { offset_y: RANDOM, seed },
    };
    keys.serialize(serializer)
}

/// The word for passes that lie anywhere along y.
const RANDOM: &str = "random";

fn with_speeds<S: Serializer>(strategy: &Strategy, serializer: S) -> std::result::Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Keys {
        strategy: StrategyKind,
        #[serde(skip_serializing_if = "Option::is_none")]
        speed_lower: Option<f64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        speed_upper: Option<f64>,
    }
    let [speed_lower, speed_upper] = match *strategy {
        Strategy::Overlap => [None; 2],
        Strategy::Shift { speed_lower, speed_upper } => [Some(speed_lower), Some(speed_upper)],
    };
    Keys { strategy: strategy.into(), speed_lower, speed_upper }.serialize(serializer)
}
