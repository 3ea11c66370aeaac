//! Source of the heights of a body.

use std::path::PathBuf;

use serde::{Serialize, Serializer};

use super::Number;
use asperity_base::grid::Grid;
use asperity_base::units::Metre;
use asperity_surface::{Axis, Form, Generator, Preparation, ReadOptions, Topography};

/// A topography as described in the case file.
///
/// Its parts act in this order: the source; the steps of [`Preparation`], with `pitch` in place of `resample` if given;
/// `plus`.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct TopographySpec {
    /// File, generator, form, or heights in memory.
    #[serde(flatten)]
    pub source: Source,
    /// Size of a cell along x and y. It is the pitch of a generated surface, of a form (by default that of the other body),
    /// and of a file without a pitch (npy, text). A file with a pitch is resampled to it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pitch: Option<[Metre; 2]>,
    /// Preparation steps of the heights. `despike` and `fill` are for measured heights only.
    #[serde(flatten)]
    pub preparation: Preparation,
    /// Layers added on the final grid.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub plus: Vec<Layer>,
}

/// One of the keys `file`, `given`, `generate`, `form`.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Source {
    /// A measured topography.
    File {
        /// Resolved against the folder of the case file.
        #[serde(rename = "file")]
        path: PathBuf,
        /// Channel of the file; the height channel by default.
        #[serde(skip_serializing_if = "Option::is_none")]
        channel: Option<String>,
        /// Size of the unit in a file without units.
        #[serde(skip_serializing_if = "Option::is_none")]
        unit: Option<Metre>,
        /// Direction of a line of a matrix whose format does not determine it.
        #[serde(skip_serializing_if = "Option::is_none")]
        lines: Option<Axis>,
        /// Number of lines above the numbers of a text.
        #[serde(skip_serializing_if = "Option::is_none")]
        skip: Option<usize>,
    },
    /// Heights supplied in memory by the caller, see [`SurfaceInput`](crate::SurfaceInput).
    Given {
        /// The name under which they are supplied.
        #[serde(rename = "given")]
        name: String,
    },
    /// A random topography; its `pitch` is in [`TopographySpec::pitch`].
    Generate {
        /// The method, with its parameters.
        #[serde(flatten)]
        generate: Generator,
        /// Number of cells along x and y; by default that of the other body.
        #[serde(skip_serializing_if = "Option::is_none")]
        shape: Option<[usize; 2]>,
        /// Random seed: the same seed gives the same heights.
        seed: u64,
    },
    /// A smooth body; its `pitch` is in [`TopographySpec::pitch`].
    Form {
        /// The form, with its parameters.
        #[serde(flatten, serialize_with = "with_infinities")]
        form: Form,
        /// Number of cells along x and y; by default that of the other body.
        #[serde(skip_serializing_if = "Option::is_none")]
        shape: Option<[usize; 2]>,
    },
}

impl Source {
    /// Returns the options for reading the file; those for any other file for another source.
    pub(crate) fn reading(&self) -> ReadOptions {
        let mut options = ReadOptions::default();
        if let Self::File { channel, unit, lines, skip, .. } = self {
            options.channel.clone_from(channel);
            (options.unit, options.lines, options.skip) = (*unit, *lines, skip.unwrap_or_default());
        }
        options
    }
}

impl TopographySpec {
    /// Returns the grid of a generated surface. Missing values are those of the `other` body, as prepared.
    ///
    /// # Errors
    /// [`asperity_base::Error::OutOfRange`].
    ///
    /// # Panics
    /// If the other body does not provide them either.
    pub(crate) fn made_on(&self, other: Option<Grid>) -> asperity_base::error::Result<Grid> {
        let shape =
            self.source.shape().or(other.map(|grid| grid.shape)).expect("one of the bodies has a shape");
        let pitch = self.pitch.or(other.map(|grid| grid.pitch)).expect("one of the bodies has a pitch");
        Grid::new(shape, pitch)
    }

    /// Returns the keys that a generated surface takes from the other body.
    pub(crate) fn lacks(&self) -> impl Iterator<Item = &'static str> {
        let is_made = matches!(self.source, Source::Generate { .. } | Source::Form { .. });
        let keys = [("shape", self.source.shape().is_none()), ("pitch", self.pitch.is_none())];
        keys.into_iter().filter(move |(_, lacks)| is_made && *lacks).map(|(key, _)| key)
    }
}

impl Source {
    /// Number of cells along x and y of a generated surface, if given.
    pub(crate) fn shape(&self) -> Option<[usize; 2]> {
        match self {
            Self::File { .. } | Self::Given { .. } => None,
            Self::Generate { shape, .. } | Self::Form { shape, .. } => *shape,
        }
    }
}

/// Additional heights: a random topography or a form, generated on the grid of the heights below it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Layer {
    /// A random topography.
    Generate {
        /// The method, with its parameters.
        #[serde(flatten)]
        generate: Generator,
        /// Random seed: the same seed gives the same heights.
        seed: u64,
    },
    /// A smooth body.
    Form {
        /// The form, with its parameters.
        #[serde(flatten, serialize_with = "with_infinities")]
        form: Form,
    },
}

impl Layer {
    /// Returns the heights of the layer on `grid`.
    ///
    /// # Errors
    /// [`asperity_base::Error::OutOfRange`] if a parameter is invalid on this grid.
    pub fn on(&self, grid: &Grid) -> asperity_base::error::Result<Topography> {
        match self {
            Self::Generate { generate, seed } => generate.generate(grid, *seed),
            Self::Form { form } => form.on(grid),
        }
    }
}

fn with_infinities<S: Serializer>(form: &Form, serializer: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    #[serde(tag = "form", rename = "sinusoid")]
    struct Keys {
        amplitude: Metre,
        wavelength: [Number; 2],
    }
    match *form {
        Form::Sinusoid { amplitude, wavelength } => {
            Keys { amplitude, wavelength: wavelength.map(Number::from) }.serialize(serializer)
        }
        form => form.serialize(serializer),
    }
}
