//! Where the heights of a body come from.

use std::path::PathBuf;

use serde::{Serialize, Serializer};

use super::Number;
use crate::surface::{Form, Generator, Preparation};
use crate::units::Metre;

/// A topography as the case file describes it.
///
/// Its parts act in this order: the source, then the steps of [`Preparation`], where `pitch` may stand for `resample`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TopographySpec {
    /// File, generator or form.
    #[serde(flatten)]
    pub source: Source,
    /// Size of a cell along x and y. It is the pitch of a generated surface, of a form, and of a file that carries
    /// none (npy, text); to a file that carries one it is resampled.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pitch: Option<[Metre; 2]>,
    /// What is done with the heights; `despike` and `fill` belong to files alone.
    #[serde(flatten)]
    pub preparation: Preparation,
}

/// One of the keys `file`, `generate`, `form`.
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
    },
    /// A random topography; its `pitch` is in [`TopographySpec::pitch`].
    Generate {
        /// The method, with its parameters.
        #[serde(flatten)]
        generate: Generator,
        /// Number of cells along x and y.
        shape: [usize; 2],
        /// Same seed, same heights.
        seed: u64,
    },
    /// A smooth body; its `pitch` is in [`TopographySpec::pitch`].
    Form {
        /// The form, with its parameters.
        #[serde(flatten, serialize_with = "with_infinities")]
        form: Form,
        /// Number of cells along x and y.
        shape: [usize; 2],
    },
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
