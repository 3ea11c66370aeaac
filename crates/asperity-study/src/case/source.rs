//! Source of the heights of a body.

use std::path::{Path, PathBuf};

use serde::Serialize;

use asperity_base::exists;
use asperity_base::grid::Grid;
use asperity_base::table::{self, Part as _, cells, require, unit};
use asperity_base::units::Metre;
use asperity_derive::{Part, Table};
use asperity_surface::{Axis, Form, Generator, Preparation, ReadOptions, Topography};

/// A topography as described in the case file.
///
/// Its parts act in this order: the source; the steps of [`Preparation`], with `pitch` in place of `resample`
/// if given; `plus`.
#[derive(Table, Debug, Clone, PartialEq, Serialize)]
#[table("lower.topography", "upper.topography")]
#[non_exhaustive]
pub struct TopographySpec {
    /// File, generator, form, or heights in memory.
    #[key(part)]
    #[serde(flatten)]
    pub source: Source,
    /// Size of a cell; for a file without a pitch, its pitch; for a file with a pitch, the pitch after
    /// resampling, without `resample`.
    #[key(
        quantity = Length,
        range = AboveZero,
        pair,
        absent = "`generate` and `form`: pitch of the other body; `file`: pitch of the file",
        example = "\"0.5 um\"",
        exists = exists::PITCH
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pitch: Option<[Metre; 2]>,
    /// Preparation steps of the heights. `despike` and `fill` are for measured heights only.
    #[key(part)]
    #[serde(flatten)]
    pub preparation: Preparation,
    /// Further heights to add, see [below](#plus-roughness-on-a-form-and-other-sums).
    ///
    /// On the final grid.
    #[key(tables = Layer::read, default = Vec::new(), absent = "nothing")]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub plus: Vec<Layer>,
}

/// One of the keys `file`, `given`, `generate`, `form`.
#[derive(Part, Debug, Clone, PartialEq, Serialize)]
#[part(hint = "for example `file = \"disc.x3p\"`, `generate = \"low-pass\"` or `form = \"sphere\"`", check = is_named)]
#[serde(untagged)]
pub enum Source {
    /// A measured topography.
    File {
        /// Path relative to the case file: x3p, sdf, gwy, sur, mnt, opd, opdx, MetroPro dat, plu, al3d, frt,
        /// tmd, nms, vk4 to vk7, NanoScope spm, ibw, nid, WSxM stp, mi, bcr, gsf, asc, tiff, NetCDF, HDF5
        /// (results too), mat, npy, npz, csv or text, also gzipped; see [formats](formats.md).
        #[key(text, example = "\"disc.x3p\"")]
        file: PathBuf,
        /// Height channel; for results `lower`, `upper` or `gap`; for other HDF5 files the path of a data
        /// set, `"/scan/height"`.
        #[key(text, absent = "the first; required for several data sets", example = "\"height\"")]
        #[serde(skip_serializing_if = "Option::is_none")]
        channel: Option<String>,
        /// Unit of the numbers in a file without units: heights of npy, npz, mat, text, csv, tiff, HDF5,
        /// NetCDF and ibw, and all lengths of asc and of tables of points; an error for a file with its own
        /// unit.
        #[key(
            special = unit,
            form = "unit, or length > 0",
            dimension = Length,
            absent = "metres; required for integers in tiff",
            example = "\"nm\"",
            exists = exists::UNIT
        )]
        #[serde(skip_serializing_if = "Option::is_none")]
        unit: Option<Metre>,
        /// Place of the numbers in a text or an array.
        #[key(part)]
        #[serde(flatten)]
        layout: Layout,
    },
    /// Heights supplied in memory by the caller, see [`SurfaceInput`](crate::SurfaceInput).
    Given {
        /// Name of heights in the memory of the caller.
        #[key(text, example = "\"disc\"")]
        given: String,
    },
    /// A random topography; its `pitch` is in [`TopographySpec::pitch`].
    Generate {
        /// The method, with its parameters.
        #[key(part)]
        #[serde(flatten)]
        generate: Generator,
        /// Number of cells along x and y.
        #[key(special = cells, form = "`[nx, ny]`, each ≥ 1", absent = "the other body's", example = "[256, 256]")]
        #[serde(skip_serializing_if = "Option::is_none")]
        shape: Option<[usize; 2]>,
        /// Seed of the random numbers.
        ///
        /// The same seed gives the same heights.
        #[key(whole = 0, default = 0, example = "7")]
        seed: u64,
    },
    /// A smooth body; its `pitch` is in [`TopographySpec::pitch`].
    Form {
        /// The form, with its parameters.
        #[key(part)]
        #[serde(flatten)]
        form: Form,
        /// Number of cells along x and y.
        #[key(special = cells, form = "`[nx, ny]`, each ≥ 1", absent = "the other body's", example = "[256, 256]")]
        #[serde(skip_serializing_if = "Option::is_none")]
        shape: Option<[usize; 2]>,
    },
}

/// Place of the numbers in a file that does not determine it.
#[derive(Part, Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Layout {
    /// Direction of a line of a matrix; a text that looks like points is a matrix if this is given; an error
    /// for a format that determines it, see [formats](formats.md).
    #[key(
        choice,
        absent = "`\"x\"` for text, `\"y\"` for npy, npz, mat and HDF5, which are indexed `[ix, iy]`",
        example = "\"y\""
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lines: Option<Axis>,
    /// Number of lines above the numbers of a text.
    #[key(count = 0, absent = "0", example = "6")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub skip: Option<usize>,
}

impl Layout {
    /// Returns the options for reading a channel of a file.
    pub(super) fn reading(self, channel: Option<&String>) -> ReadOptions {
        let mut options = ReadOptions::default();
        options.channel = channel.cloned();
        (options.lines, options.skip) = (self.lines, self.skip.unwrap_or_default());
        options
    }
}

/// Returns an error at a `file` without a name.
pub(super) fn named(file: &Path, source: &dyn table::Source) -> asperity_base::error::Result<()> {
    require(source, "file", file != Path::new(""), "the name of a file", None)
}

fn is_named(read: &Source, source: &dyn table::Source) -> asperity_base::error::Result<()> {
    match read {
        Source::File { file, .. } => named(file, source),
        _ => Ok(()),
    }
}

impl Source {
    /// Returns the options for reading the file; those for any other file for another source.
    pub fn reading(&self) -> ReadOptions {
        match self {
            Self::File { channel, unit, layout, .. } => {
                let mut options = layout.reading(channel.as_ref());
                options.unit = *unit;
                options
            }
            _ => ReadOptions::default(),
        }
    }
}

impl TopographySpec {
    /// Returns the topography with the file relative to a `folder`.
    pub(super) fn in_folder(mut self, folder: &Path) -> Self {
        if let Source::File { file, .. } = &mut self.source {
            *file = folder.join(&*file);
        }
        self
    }

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
#[derive(Part, Debug, Clone, Copy, PartialEq, Serialize)]
#[part(hint = "for example `generate = \"low-pass\"` or `form = \"sphere\"`")]
#[serde(untagged)]
pub enum Layer {
    /// A random topography.
    Generate {
        /// The method, with its parameters.
        #[key(part)]
        #[serde(flatten)]
        generate: Generator,
        /// Seed of the random numbers.
        ///
        /// The same seed gives the same heights.
        #[key(whole = 0, default = 0, example = "7")]
        seed: u64,
    },
    /// A smooth body.
    Form {
        /// The form, with its parameters.
        #[key(part)]
        #[serde(flatten)]
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
