//! Where the heights of a body come from.

use std::path::PathBuf;

use serde::Serialize;

use crate::units::Metre;

/// A topography as the case file describes it.
///
/// Its parts act in this order: the source; `window`; `fill`; `level`; `resample`, or `pitch` where that resamples.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TopographySpec {
    /// File, generator or form.
    #[serde(flatten)]
    pub source: Source,
    /// Size of a cell along x and y. It is the pitch of a generated surface, of a form, and of a file that carries
    /// none (npy, text); to a file that carries one it is resampled.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pitch: Option<[Metre; 2]>,
    /// What is subtracted.
    pub level: Level,
    /// Number of cells to resample to.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub resample: Option<[usize; 2]>,
    /// The part to keep, `[x0, y0, nx, ny]` in samples of the source.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub window: Option<[usize; 4]>,
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
        /// What becomes of missing heights.
        fill: Fill,
    },
    /// A random topography; its `pitch` is in [`TopographySpec::pitch`].
    Generate {
        /// The method, with its parameters.
        #[serde(flatten)]
        generate: Generate,
        /// Number of cells along x and y.
        shape: [usize; 2],
        /// Same seed, same heights.
        seed: u64,
    },
    /// A smooth body; its `pitch` is in [`TopographySpec::pitch`].
    Form {
        /// The form, with its parameters.
        #[serde(flatten)]
        form: Form,
        /// Number of cells along x and y.
        shape: [usize; 2],
    },
}

/// What is subtracted from the heights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Level {
    /// Nothing.
    #[default]
    None,
    /// The mean height.
    Mean,
    /// The least-squares plane.
    Plane,
    /// The least-squares polynomial of second order.
    Quadratic,
}

/// What becomes of missing heights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fill {
    /// They are an error.
    #[default]
    None,
    /// They take the nearest height.
    Nearest,
    /// They are interpolated harmonically from the rim of the hole.
    Harmonic,
}

/// A method of making a random topography.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(tag = "generate", rename_all = "kebab-case")]
pub enum Generate {
    /// White noise below a cut-off wavelength.
    LowPass {
        /// Rms height, > 0.
        sq: Metre,
        /// The shortest wavelength, > 0.
        cutoff: Metre,
    },
    /// A prescribed exponential autocorrelation.
    Autocorrelation {
        /// Rms height, > 0.
        sq: Metre,
        /// Correlation length along x and y, > 0.
        correlation_length: [Metre; 2],
    },
    /// A power-law spectrum.
    SelfAffine {
        /// Rms height or rms slope.
        #[serde(flatten)]
        amplitude: Amplitude,
        /// Hurst exponent, 0 < H ≤ 1.
        hurst: f64,
        /// Wavelength above which the spectrum is flat, > 0.
        #[serde(skip_serializing_if = "Option::is_none")]
        rolloff: Option<Metre>,
        /// The shortest wavelength, > 0.
        #[serde(skip_serializing_if = "Option::is_none")]
        shortest: Option<Metre>,
    },
}

/// How rough a self-affine topography is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Amplitude {
    /// Rms height, > 0.
    Sq(Metre),
    /// Rms slope, > 0.
    Sdq(f64),
}

/// A smooth body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(tag = "form", rename_all = "kebab-case")]
pub enum Form {
    /// A sphere.
    Sphere {
        /// Radius, > 0.
        radius: Metre,
    },
    /// A cylinder.
    Cylinder {
        /// Radius, > 0.
        radius: Metre,
        /// The direction of its axis.
        axis: Axis,
    },
    /// A cone.
    Cone {
        /// Between its flank and the plane, in radians, 0 < angle < π/2.
        angle: f64,
    },
    /// A plane.
    Flat,
    /// A sinusoid along x and y.
    Sinusoid {
        /// From mean to crest, > 0.
        amplitude: Metre,
        /// Wavelength along x and y, > 0.
        wavelength: [Metre; 2],
    },
}

/// A direction of the grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Axis {
    /// The direction of motion.
    X,
    /// Across the motion.
    Y,
}
