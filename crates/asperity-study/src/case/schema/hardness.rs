//! Keys of a hardness map.

use super::typed::{Optional, TEXT, Typed, optional, other, required, section};
use asperity_base::exists;
use asperity_base::units::Dimension;
use asperity_surface::Axis;

/// A map of the hardness.
pub(crate) mod map {
    use super::*;

    section! { &["lower.hardness", "upper.hardness"], "";
        FILE: Typed<String> = required(
            "file",
            TEXT,
            "\"hardness.npy\"",
            "file of numbers (npy, npz, mat, csv, text, tiff or HDF5), relative to the case file",
        );
        CHANNEL: Optional<String> =
            optional("channel", TEXT, "the first", "\"hardness\"", "channel, if the file has several");
        UNIT: Typed<f64> = super::super::typed::defaulted(
            "unit",
            other(Some(Dimension::Pressure), "unit, or pressure > 0", |_, entry| entry.unit(Dimension::Pressure))
                .exists(exists::UNIT),
            "\"Pa\"",
            "\"GPa\"",
            "unit of the numbers in the file",
        );
        LINES: Optional<Axis> = super::super::typed::LINES;
        SKIP: Optional<usize> = super::super::typed::SKIP;
    }
}

/// A hardness map in the memory of the caller.
pub(crate) mod given {
    use super::*;

    section! { &["lower.hardness", "upper.hardness"], "given";
        GIVEN: Typed<String> = required("given", TEXT, "\"map\"", "name of a map in the memory of the caller");
    }
}
