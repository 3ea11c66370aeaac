//! Keys of topographies: common keys, and keys of each kind of source.

use super::super::exists;
use super::Bounds::{AboveZero, AboveZeroOrInfinite, Any, Between};
use super::Fallback::Absent;
use super::typed::{
    LENGTH, Nested, Optional, SEED, TEXT, Typed, Value, choice, defaulted, number, optional, other, pair,
    quantity, required, section, tables,
};
use super::values::topography as read;
use asperity_base::units::Dimension;
use asperity_surface::{Axis, Band, Decay, Fill, Filter, Groove, Interpolation, Level};

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
        GENERATE: Typed<read::Method> =
            required("generate", choice::<read::Method>(), "\"low-pass\"", "method");
        SHAPE: Optional<[usize; 2]> =
            optional("shape", CELLS, "the other body's", "[256, 256]", "number of cells along x and y");
        SEED: Typed<u64> = defaulted("seed", super::SEED, "0", "7", "seed of the random numbers");
    }
}

const SQ: Typed<f64> = required("sq", LENGTH.exists(exists::ROUGHNESS), "\"0.2 um\"", "rms height, exact");
const SSK: Typed<f64> = defaulted(
    "ssk",
    number(Any),
    "0",
    "-1",
    "skewness of the heights, −6 to 6; together with `sku`, see below",
);
const SKU: Typed<f64> =
    defaulted("sku", number(Any), "3", "4.5", "kurtosis of the heights, 1.1 (Ssk² + 1) to 50, see below");
const LAY: Typed<f64> = defaulted(
    "lay",
    ANGLE,
    "0",
    "\"90 deg\"",
    "angle of the grooves, or of the first correlation length, from x towards y",
);

/// `generate = "low-pass"`.
pub(crate) mod low_pass {
    use super::*;

    section! { TABLES, "generate = \"low-pass\"";
        SQ: Typed<f64> = super::SQ;
        CUTOFF: Typed<[f64; 2]> = required(
            "cutoff",
            PITCH,
            "\"8 um\"",
            "shortest wavelength, from two pitches to the length of the surface",
        );
        BAND: Typed<Band> = defaulted(
            "band",
            choice::<Band>(),
            "\"elliptic\"",
            "\"rectangular\"",
            "shape of the pass band; `\"elliptic\"` is circular for one cut-off",
        );
        SSK: Typed<f64> = super::SSK;
        SKU: Typed<f64> = super::SKU;
    }
}

/// `generate = "autocorrelation"`.
pub(crate) mod autocorrelation {
    use super::*;

    section! { TABLES, "generate = \"autocorrelation\"";
        SQ: Typed<f64> = super::SQ;
        CORRELATION_LENGTH: Typed<[f64; 2]> = required(
            "correlation_length",
            PITCH,
            "\"8 um\"",
            "length over which the autocorrelation decays to 10 %, one value or two (along and across the lay), from one pitch to the length of the surface",
        );
        DECAY: Typed<Decay> = defaulted(
            "decay",
            choice::<Decay>(),
            "\"exponential\"",
            "\"gaussian\"",
            "decay of the autocorrelation: `\"exponential\"`, rough down to the smallest scale, or `\"gaussian\"`, smooth",
        );
        LAY: Typed<f64> = super::LAY;
        SSK: Typed<f64> = super::SSK;
        SKU: Typed<f64> = super::SKU;
    }
}

/// `generate = "self-affine"`.
pub(crate) mod self_affine {
    use super::*;

    section! { TABLES, "generate = \"self-affine\"";
        SQ: Optional<f64> =
            optional("sq", LENGTH.exists(exists::ROUGHNESS), "exactly one of `sq` and `sdq`", "\"0.2 um\"", "rms height, exact");
        SDQ: Optional<f64> = optional(
            "sdq",
            number(AboveZero).exists(exists::SLOPE),
            "exactly one of `sq` and `sdq`",
            "0.1",
            "rms slope, exact (as the sum of waves)",
        );
        HURST: Typed<f64> = required(
            "hurst",
            number(Between { least: 0.0, most: 1.0, open: [true, false] }),
            "0.8",
            "Hurst exponent H",
        );
        ROLLOFF: Optional<f64> = optional(
            "rolloff",
            LENGTH,
            "none: the law holds up to the longest wave",
            "\"32 um\"",
            "wavelength above which the spectrum is flat, above `shortest`",
        );
        SHORTEST: Optional<f64> = optional(
            "shortest",
            LENGTH,
            "twice the larger pitch",
            "\"8 um\"",
            "shortest wavelength, at least twice the larger pitch",
        );
    }
}

/// Every ideal form.
pub(crate) mod form {
    use super::*;

    section! { TABLES, "form";
        FORM: Typed<read::Shape> = required("form", choice::<read::Shape>(), "\"sphere\"", "the form");
        SHAPE: Optional<[usize; 2]> = super::generate::SHAPE;
    }
}

const RADIUS: Typed<f64> = required("radius", LENGTH.exists(exists::RADIUS), "\"1 mm\"", "radius R");

/// `form = "sphere"`.
pub(crate) mod sphere {
    use super::*;

    section! { TABLES, "form = \"sphere\"";
        RADIUS: Typed<f64> = super::RADIUS;
    }
}

/// `form = "ellipsoid"`.
pub(crate) mod ellipsoid {
    use super::*;

    section! { TABLES, "form = \"ellipsoid\"";
        RADIUS: Typed<[f64; 2]> = required(
            "radius",
            other(Some(Dimension::Length), "`[Rx, Ry]`, two lengths > 0", |_, entry| read::radii(entry)).exists(exists::RADIUS),
            "[\"1 mm\", \"2 mm\"]",
            "principal radii of curvature; an ellipsoid with semi-axes a, b and c, c normal to the plane, has a²/c and b²/c",
        );
    }
}

/// `form = "cylinder"`.
pub(crate) mod cylinder {
    use super::*;

    section! { TABLES, "form = \"cylinder\"";
        RADIUS: Typed<f64> = super::RADIUS;
        AXIS: Typed<Axis> = defaulted("axis", choice::<Axis>(), "\"y\"", "\"x\"", "direction of the crest");
    }
}

/// `form = "cone"`.
pub(crate) mod cone {
    use super::*;

    section! { TABLES, "form = \"cone\"";
        ANGLE: Typed<f64> = required(
            "angle",
            quantity(Dimension::Angle, AboveZero).exists(exists::ANGLE),
            "\"5 deg\"",
            "slope angle α from the plane, below 90°; a number without a unit is in radians",
        );
    }
}

/// `form = "flat"`.
pub(crate) mod flat {
    pub(in crate::case) const SECTION: super::super::Section =
        super::super::Section { tables: super::TABLES, kind: "form = \"flat\"", keys: &[] };
}

/// `form = "sinusoid"`.
pub(crate) mod sinusoid {
    use super::*;

    const WAVE: Value<f64> =
        quantity(Dimension::Length, AboveZeroOrInfinite("no variation in that direction"))
            .exists(exists::WAVE);

    section! { TABLES, "form = \"sinusoid\"";
        AMPLITUDE: Typed<f64> = required("amplitude", LENGTH, "\"0.1 um\"", "amplitude A");
        WAVELENGTH: Typed<[f64; 2]> =
            required("wavelength", pair(&WAVE), "\"64 um\"", "wavelength λ, at least two pitches");
    }
}

/// `form = "grooves"`.
pub(crate) mod grooves {
    use super::*;

    section! { TABLES, "form = \"grooves\"";
        PERIOD: Typed<f64> =
            required("period", LENGTH, "\"0.1 mm\"", "distance from ridge to ridge, at least two pitches");
        DEPTH: Typed<f64> = required("depth", LENGTH, "\"1 um\"", "depth d");
        PROFILE: Typed<Groove> =
            defaulted("profile", choice::<Groove>(), "\"parabolic\"", "\"triangular\"", "shape of a groove");
        LAY: Typed<f64> = super::LAY;
    }
}
