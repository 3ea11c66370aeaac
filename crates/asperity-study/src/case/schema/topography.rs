//! Keys of topographies: common keys, and keys of each kind of source.

use super::Bounds::{AboveZero, Any};
use super::Fallback::Absent;
use super::Section;
use super::typed::{
    LENGTH, Nested, Optional, SEED, TEXT, Typed, Value, choice, defaulted, number, optional, other, pair,
    quantity, required, section, tables,
};
use super::values::topography as read;
use asperity_base::exists;
use asperity_base::table::Part;
use asperity_base::units::Dimension;
use asperity_surface::{Axis, Fill, Filter, Form, Generator, Interpolation, Level};

const TABLES: &[&str] = &["lower.topography", "upper.topography"];

const ANGLE: Value<f64> = quantity(Dimension::Angle, Any).exists(exists::ANGLE);
const PITCH: Value<[f64; 2]> = pair(&LENGTH.exists(exists::WAVE));
const CELLS: Value<[usize; 2]> = other(None, "`[nx, ny]`, each ≥ 1", |_, entry| read::shape(entry));

/// Every topography.
pub(crate) mod every {
    use super::*;

    section! { TABLES, "";
        PITCH: Optional<[f64; 2]> = optional(
            "pitch",
            super::PITCH.exists(exists::PITCH),
            "`generate` and `form`: pitch of the other body; `file`: pitch of the file",
            "\"0.5 um\"",
            "size of a cell; for a file without a pitch, its pitch; for a file with a pitch, the pitch after resampling, without `resample`",
        );
        WINDOW: Optional<[usize; 4]> = optional(
            "window",
            other(None, "`[x0, y0, nx, ny]`, in samples: first sample from 0, number of samples ≥ 1", |_, entry| {
                read::window(entry)
            }),
            "everything",
            "[0, 0, 96, 128]",
            "part to keep",
        );
        LEVEL: Typed<Level> = defaulted(
            "level",
            other(
                None,
                "`\"none\"`, `\"mean\"`, `\"plane\"`, `\"quadratic\"`, `\"polynomial-3\"` (all terms up to an order, 0 … 16), \
                 `\"sphere\"`, `\"cylinder\"`",
                |_, entry| read::level(entry),
            ),
            "\"none\"",
            "\"plane\"",
            "form to subtract, fitted by least squares",
        );
        MIRROR: Optional<Axis> =
            optional("mirror", choice::<Axis>(), "none", "\"x\"", "direction to reverse");
        ROTATE: Typed<f64> = defaulted(
            "rotate",
            ANGLE,
            "0",
            "\"90 deg\"",
            "angle of rotation, from x towards y; a number without a unit is in radians",
        );
        S_FILTER: Optional<f64> = optional(
            "s_filter",
            LENGTH,
            "none",
            "\"2.5 um\"",
            "S-filter: nesting index below which waves are removed, at least two pitches and below `l_filter`",
        );
        L_FILTER: Optional<f64> = optional(
            "l_filter",
            LENGTH,
            "none",
            "\"0.8 mm\"",
            "L-filter: nesting index above which waves are removed, at least two pitches",
        );
        FILTER: Typed<Filter> =
            defaulted("filter", choice::<Filter>(), "\"gaussian\"", "\"robust\"", "kind of both filters");
        RESAMPLE: Optional<[usize; 2]> =
            optional("resample", CELLS, "as it is", "[256, 256]", "number of cells after resampling to the same extent");
        INTERPOLATE: Typed<Interpolation> = defaulted(
            "interpolate",
            choice::<Interpolation>(),
            "\"linear\"",
            "\"spline\"",
            "interpolation of heights between samples on finer grids; the spline is cubic",
        );
        TAPER: Optional<f64> = optional(
            "taper",
            LENGTH,
            "none",
            "\"10 um\"",
            "width of the rim that tapers to the mean height, at most half of the topography",
        );
        PLUS: Nested =
            tables("plus", Absent("nothing"), "further heights to add, see [below](#plus-roughness-on-a-form-and-other-sums)");
    }
}

/// A measured topography.
pub(crate) mod file {
    use super::*;

    section! { TABLES, "file";
        FILE: Typed<String> = required(
            "file",
            TEXT,
            "\"disc.x3p\"",
            "path relative to the case file: x3p, sdf, gwy, sur, mnt, opd, opdx, MetroPro dat, plu, al3d, frt, tmd, nms, vk4 to \
             vk7, NanoScope spm, ibw, nid, WSxM stp, mi, bcr, gsf, asc, tiff, NetCDF, HDF5 (results too), mat, npy, npz, csv or text, also \
             gzipped; see [formats](formats.md)",
        );
        CHANNEL: Optional<String> = optional(
            "channel",
            TEXT,
            "the first; required for several data sets",
            "\"height\"",
            "height channel; for results `lower`, `upper` or `gap`; for other HDF5 files the path of a data set, `\"/scan/height\"`",
        );
        UNIT: Optional<f64> = optional(
            "unit",
            other(Some(Dimension::Length), "unit, or length > 0", |_, entry| entry.unit(Dimension::Length)).exists(exists::UNIT),
            "metres; required for integers in tiff",
            "\"nm\"",
            "unit of the numbers in a file without units: heights of npy, npz, mat, text, csv, tiff, HDF5, NetCDF and ibw, and all \
             lengths of asc and of tables of points; an error for a file with its own unit",
        );
        LINES: Optional<Axis> = super::super::typed::LINES;
        SKIP: Optional<usize> = super::super::typed::SKIP;
        DESPIKE: Optional<f64> = optional(
            "despike",
            number(AboveZero),
            "nothing",
            "6",
            "turns spikes into missing heights: samples that deviate from their surroundings by more than this number of standard deviations, usually 5 to 10",
        );
        FILL: Typed<Fill> = defaulted(
            "fill",
            choice::<Fill>(),
            "\"none\"",
            "\"harmonic\"",
            "treatment of missing heights: with `\"none\"` they are an error, `\"harmonic\"` is a membrane over each hole",
        );
    }
}

/// Heights in the memory of the caller.
pub(crate) mod given {
    use super::*;

    section! { TABLES, "given";
        GIVEN: Typed<String> = required("given", TEXT, "\"disc\"", "name of heights in the memory of the caller");
        DESPIKE: Optional<f64> = super::file::DESPIKE;
        FILL: Typed<Fill> = super::file::FILL;
    }
}

/// Every random topography.
pub(crate) mod generate {
    use super::*;

    section! { TABLES, "generate";
        SHAPE: Optional<[usize; 2]> =
            optional("shape", CELLS, "the other body's", "[256, 256]", "number of cells along x and y");
        SEED: Typed<u64> = defaulted("seed", super::SEED, "0", "7", "seed of the random numbers");
    }
}

/// Every ideal form.
pub(crate) mod form {
    use super::*;

    section! { TABLES, "form";
        SHAPE: Optional<[usize; 2]> = super::generate::SHAPE;
    }
}

/// Returns the sections of random topographies and of forms: the keys of all of them, then those of each.
pub(super) fn sections_of_kinds() -> Vec<Section> {
    fn with<P: Part>(own: Section) -> Vec<Section> {
        let keys = [P::keys(), own.keys.to_vec()].concat().leak();
        [vec![Section { keys, ..own }], P::sections(TABLES)].concat()
    }
    [with::<Generator>(generate::SECTION), with::<Form>(form::SECTION)].concat()
}
