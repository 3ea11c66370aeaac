//! Case files: one TOML file describes the bodies, their loading and their motion.
//!
//! Everything that the file alone determines is checked, and each mistake is reported at its place. A
//! [`Case`] is in SI and serialises under the keys of the file, so that a summary contains the computed case.

mod body;
mod contact;
mod course;
pub(crate) mod cursor;
pub(crate) mod document;
mod friction;
mod hardness;
mod json_schema;
mod motion;
mod output;
mod parse;
mod plasticity;
mod prescribed;
mod read_back;
mod root;
pub mod rules;
mod running;
pub mod schema;
mod sliding;
mod source;
mod stage;
mod subsurface;

use std::path::{Path, PathBuf};

use serde::{Serialize, Serializer};

pub(crate) use self::body::Part;
use self::body::WrittenBody;
pub use self::body::{Body, Mount};
pub use self::contact::{Contact, GridMatch};
pub use self::course::Course;
use self::document::Document;
pub use self::friction::{FrictionSpec, InPlane};
pub use self::hardness::{Hardness, HardnessMap};
pub use self::json_schema::json_schema;
pub use self::motion::{ControlKind, CounterBody, MotionSpec, Offset, StrategyKind};
pub use self::output::Output;
pub use self::prescribed::{ContactLoad, Prescribed};
pub use self::sliding::SlidingSpec;
pub use self::source::{Layer, Layout, Source, TopographySpec};
pub use self::stage::StageSpec;
pub use self::subsurface::{Side, SubsurfaceSpec};
use crate::io::text_of;
use asperity_base::error::{Error, Result};
use asperity_base::units::{MetrePerSecond, SquareMetre};
use asperity_contact::material::Compliances;
use asperity_contact::motion::{Acceleration, Motion, Strategy};
pub use asperity_contact::operator::{Boundary, Edge};
use asperity_contact::solver::Sliding;
pub use asperity_contact::solver::{Device, Method};
use asperity_contact::temperature::Temperature;
use asperity_contact::with::plasticity::PlasticRegion;
use asperity_contact::with::viscoelastic::Steady;
use asperity_contact::with::{Capabilities, Interfaces, Surroundings};

/// A case, resolved to SI.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Case {
    /// The title; by default the file name.
    pub title: String,
    /// The lower body.
    #[serde(serialize_with = "with_layers")]
    pub lower: Body,
    /// The upper body.
    #[serde(serialize_with = "with_mount")]
    pub upper: Body,
    /// Load, boundary and solver.
    pub contact: Contact,
    /// The interface of the bodies, by its table: hard walls if none is given.
    #[serde(flatten)]
    pub interface: Interfaces,
    /// Friction of the bodies; `None` if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction: Option<FrictionSpec>,
    /// Later stages of the loading of a static contact. The first is prescribed by `contact` and, if given,
    /// `friction`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub history: Vec<StageSpec>,
    /// Motion of the bodies; `None` for a static contact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motion: Option<MotionSpec>,
    /// Sliding in place of a static contact; `None` if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sliding: Option<SlidingSpec>,
    /// Steady sliding of viscoelastic bodies; `None` if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steady: Option<Steady>,
    /// Extrapolation over passes; by default each pass is computed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub acceleration: Option<Acceleration>,
    /// Temperatures of the bodies; unknown if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub temperature: Option<Temperature>,
    /// The volumes of elasto-plastic bodies; `None` if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plasticity: Option<PlasticRegion>,
    /// Requested output of the stress under the surface; `None` if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub subsurface: Option<SubsurfaceSpec>,
    /// The capabilities that are asked for, each with its table.
    #[serde(flatten)]
    pub with: Capabilities,
    /// Output options.
    pub output: Output,
    /// Whether custom laws may change the bodies between two passes.
    #[serde(skip)]
    has_custom_laws: bool,
    #[serde(skip)]
    document: Document,
}

/// Largest accepted case file.
pub(crate) const MAX_CASE_BYTES: u64 = 4 << 20;

impl Case {
    /// Interval of the increments of a loading whose fields are kept, 0 for none: those of bodies that are no
    /// hard walls to each other, whose way together and apart is the result.
    pub(crate) fn increments_kept_every(&self) -> usize {
        if !self.interface.is_empty() && !self.history.is_empty() { self.output.pressure_every } else { 0 }
    }

    /// Whether a body has layers.
    pub fn is_coated(&self) -> bool {
        [&self.lower, &self.upper].into_iter().any(|body| body.material.is_layered())
    }

    /// Whether a body is viscoelastic.
    pub(crate) fn relaxes(&self) -> bool {
        [&self.lower, &self.upper].into_iter().any(Body::relaxes)
    }

    /// Whether each position of a pass needs the one before: of viscoelastic or lubricated bodies.
    pub(crate) fn follows_itself(&self) -> bool {
        self.relaxes() || self.interface.lubrication.is_some()
    }

    /// Whether a body yields at a hardness.
    pub(crate) fn yields(&self) -> bool {
        [&self.lower, &self.upper].into_iter().any(|body| body.hardness.yields())
    }

    /// Whether the shear of bodies that slide displaces them normally.
    pub(crate) fn shear_displaces_normally(&self) -> bool {
        let compliances = Compliances::new(&self.lower.material, &self.upper.material);
        let couples = compliances.is_ok_and(|compliances| compliances.coupling != 0.0);
        self.friction.as_ref().is_some_and(|friction| {
            Sliding { friction: friction.law, direction: [1.0, 0.0] }.shear_displaces_normally(couples)
        })
    }

    /// Whether shear lowers the pressures of cells that yield.
    fn grows_junctions(&self) -> bool {
        self.yields() && self.friction.as_ref().is_some_and(|friction| friction.law.junction_growth > 0.0)
    }

    /// Returns what surrounds a contact of the case.
    pub fn surroundings(&self) -> Surroundings {
        Surroundings {
            bodies: [&self.lower, &self.upper].map(Body::constants),
            boundary: self.contact.boundary,
            moves: self.motion.is_some(),
            is_shift: self.motion.is_some_and(|motion| motion.strategy() != Strategy::Overlap),
            repeats: self.motion.is_some_and(|motion| motion.repeats()),
            has_cycles: self.history.iter().any(|stage| stage.cycles.is_some()),
            dragging_speed: self.dragging_speed(),
            has_friction: self.friction.is_some(),
            shear_changes_pressures: self.shear_displaces_normally()
                || (self.motion.is_none() && self.grows_junctions()),
            flows: self.plasticity.is_some(),
            on_device: self.contact.device != Device::Cpu,
        }
    }

    /// Returns the sum of the speeds at which the two bodies move past the contact.
    fn dragging_speed(&self) -> Option<MetrePerSecond> {
        let Some(motion) = self.motion else { return self.sliding.and_then(|sliding| sliding.speed) };
        match motion.strategy() {
            Strategy::Overlap => motion.speed,
            Strategy::Shift { speed_lower, speed_upper } => Some(speed_lower.abs() + speed_upper.abs()),
        }
    }

    /// Reads a case file. Paths of files are relative to its folder.
    ///
    /// # Errors
    /// [`Error::File`] if it cannot be read, [`Error::Case`] if it has a mistake.
    pub fn load(path: &Path) -> Result<Self> {
        let text = text_of(path, "a case file", MAX_CASE_BYTES)?;
        Self::parse(&text, path, path.parent().unwrap_or(Path::new("")))
    }

    /// Reads a case from its text. `file` is its name in errors; paths of files are relative to `folder`.
    ///
    /// # Errors
    /// [`Error::Case`] if it has a mistake.
    pub fn parse(text: &str, file: &Path, folder: &Path) -> Result<Self> {
        parse::case(text, file, folder, false)
    }

    /// [`parse`](Self::parse) for a motion whose passes custom laws may change, by
    /// [`SolvedPass::remove`](asperity_contact::motion::SolvedPass::remove).
    ///
    /// # Errors
    /// The errors of [`parse`](Self::parse).
    pub fn parse_with_custom_laws(text: &str, file: &Path, folder: &Path) -> Result<Self> {
        parse::case(text, file, folder, true)
    }

    /// Returns the case as it is solved by another device.
    ///
    /// # Errors
    /// [`Error::Case`] if this device does not solve it.
    pub fn on(mut self, device: Device) -> Result<Self> {
        self.contact.device = device;
        parse::check_again(&self)?;
        Ok(self)
    }

    /// Creates an error that appears only when the case is used, at the place of a dotted `key`
    /// (`upper.topography.file`), or of the table that would contain it.
    pub fn error_at(&self, key: &str, message: impl Into<String>, hint: Option<String>) -> Error {
        self.document.error_at(key, message, hint)
    }

    /// Text of the case, with its places.
    pub(crate) fn document(&self) -> &Document {
        &self.document
    }

    /// Returns the text of the file at a dotted `key`.
    pub(crate) fn written(&self, key: &str) -> String {
        self.document.written(self.document.place(key))
    }

    /// Returns the motion with its load. A mean pressure acts on `apparent_area`, the area of all cells at
    /// full overlap.
    pub fn motion(&self, apparent_area: SquareMetre) -> Option<Motion> {
        Some(Motion {
            friction: self.friction.as_ref().map(|friction| friction.law),
            ..self.motion?.under(self.contact.prescribed().control(apparent_area))
        })
    }

    /// Returns the dotted key of the table of a part of the body `name`: of one of its layers, or of the body itself.
    pub(crate) fn table_of(&self, name: &str, layer: Option<usize>) -> String {
        match layer {
            None => name.to_owned(),
            Some(_) if self.document.has(&format!("{name}.coating")) => format!("{name}.coating"),
            Some(n) => format!("{name}.layers.{n}"),
        }
    }

    /// Iterates over the files named in the case.
    pub fn files(&self) -> impl Iterator<Item = &PathBuf> {
        [&self.lower, &self.upper].into_iter().flat_map(|body| {
            let surface = match &body.topography.source {
                Source::File { file, .. } => Some(file),
                _ => None,
            };
            let map = match &body.hardness {
                Hardness::Map(HardnessMap::File { file, .. }) => Some(file),
                Hardness::Map(HardnessMap::Given { .. }) | Hardness::Uniform(_) => None,
            };
            let curves = body.parts().filter_map(|part| part.viscoelastic?.file.as_ref());
            surface.into_iter().chain(map).chain(curves)
        })
    }
}

/// Reads the topography of a separate table `[topography]`; also returns its document.
pub(crate) fn topography_alone(text: &str, folder: &Path) -> Result<(TopographySpec, Document)> {
    parse::topography_alone(text, folder)
}

fn with_layers<S: Serializer>(body: &Body, serializer: S) -> std::result::Result<S::Ok, S::Error> {
    WrittenBody::new(body).serialize(serializer)
}

fn with_mount<S: Serializer>(upper: &Body, serializer: S) -> std::result::Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Keys<'a> {
        #[serde(flatten)]
        body: WrittenBody<'a>,
        mount: Option<Mount>,
    }
    Keys { body: WrittenBody::new(upper), mount: upper.mount }.serialize(serializer)
}
