//! Where the heights of a body come from.

use std::path::PathBuf;

use serde::{Serialize, Serializer};

use super::Number;
use crate::grid::Grid;
use crate::surface::{Form, Generator, Preparation, Topography};
use crate::units::Metre;

/// A topography as the case file describes it.
///
/// Its parts act in this order: the source; the steps of [`Preparation`], where `pitch` may stand for `resample`; `plus`.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct TopographySpec {
    /// File, generator or form.
    #[serde(flatten)]
    pub source: Source,
    /// Size of a cell along x and y. It is the pitch of a generated surface, of a form (by default the other body's), and of
    /// a file that carries none (npy, text); to a file that carries one it is resampled.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pitch: Option<[Metre; 2]>,
    /// What is done with the heights; `despike` and `fill` belong to what is measured alone.
    #[serde(flatten)]
    pub preparation: Preparation,
    /// What is added on the grid that all this leads to.
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
        /// The channel to take; the height channel if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        channel: Option<String>,
        /// What a 1 stands for in a file without units.
        #[serde(skip_serializing_if = "Option::is_none")]
        unit: Option<Metre>,
    },
    /// Heights that the caller has in memory, see [`Given`](crate::study::Given).
    Given {
        /// The name under which they are given.
        #[serde(rename = "given")]
        name: String,
    },
    /// A random topography; its `pitch` is in [`TopographySpec::pitch`].
    Generate {
        /// The method, with its parameters.
        #[serde(flatten)]
        generate: Generator,
        /// Number of cells along x and y; the other body's if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        shape: Option<[usize; 2]>,
        /// The seed of the random numbers: the same seed gives the same heights.
        seed: u64,
    },
    /// A smooth body; its `pitch` is in [`TopographySpec::pitch`].
    Form {
        /// The form, with its parameters.
        #[serde(flatten, serialize_with = "with_infinities")]
        form: Form,
        /// Number of cells along x and y; the other body's if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        shape: Option<[usize; 2]>,
    },
}

impl TopographySpec {
    /// The grid on which a surface is made: what it lacks is that of the `other` body, as prepared.
    ///
    /// # Errors
    /// [`crate::Error::OutOfRange`].
    ///
    /// # Panics
    /// If the other body does not tell either.
    pub(in crate::study) fn made_on(&self, other: Option<Grid>) -> crate::error::Result<Grid> {
        let shape =
            self.source.shape().or(other.map(|grid| grid.shape)).expect("one of the bodies has a shape");
        let pitch = self.pitch.or(other.map(|grid| grid.pitch)).expect("one of the bodies has a pitch");
        Grid::new(shape, pitch)
    }

    /// The keys that a surface that is made takes from the other body.
    pub(in crate::study) fn lacks(&self) -> impl Iterator<Item = &'static str> {
        let is_made = matches!(self.source, Source::Generate { .. } | Source::Form { .. });
        let keys = [("shape", self.source.shape().is_none()), ("pitch", self.pitch.is_none())];
        keys.into_iter().filter(move |(_, lacks)| is_made && *lacks).map(|(key, _)| key)
    }
}

impl Source {
    /// Number of cells along x and y of what is made, where it is given.
    pub(in crate::study) fn shape(&self) -> Option<[usize; 2]> {
        match self {
            Self::File { .. } | Self::Given { .. } => None,
            Self::Generate { shape, .. } | Self::Form { shape, .. } => *shape,
        }
    }
}

/// Heights that are added: a random topography or a form, made on the grid of what they are added to.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Layer {
    /// A random topography.
    Generate {
        /// The method, with its parameters.
        #[serde(flatten)]
        generate: Generator,
        /// The seed of the random numbers: the same seed gives the same heights.
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
    /// The layer's heights on `grid`.
    ///
    /// # Errors
    /// [`crate::Error::OutOfRange`] if a parameter has no meaning on this grid.
    pub fn on(&self, grid: &Grid) -> crate::error::Result<Topography> {
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
