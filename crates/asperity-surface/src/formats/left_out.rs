//! Formats whose feature is left out: they are recognised, and refused with the name of the feature.

#![allow(unused_macros, dead_code, reason = "each set of features leaves out others")]

use super::{Decoded, Fault};

macro_rules! left_out {
    ($reason:literal) => {
        pub(in crate::formats) fn decode(_: &[u8], _: Option<&str>) -> Decoded {
            Err(Fault::NotATopography($reason))
        }
    };
}

#[cfg(not(feature = "zip"))]
pub(super) fn decode_archive(_: &[u8], _: Option<&str>) -> Decoded {
    Err(Fault::NotATopography("it is a zip archive, and the feature `zip` is left out"))
}

#[cfg(not(feature = "hdf5"))]
pub(super) mod hdf5 {
    use super::{Decoded, Fault};

    pub(in crate::formats) const MAGIC: &[u8] = b"\x89HDF\r\n\x1a\n";
    pub(in crate::formats) const RESULTS: &str = "results";

    left_out!("it is HDF5, and the feature `hdf5` is left out");
}

#[cfg(not(feature = "tiff"))]
pub(super) mod tiff {
    use super::{Decoded, Fault};

    pub(in crate::formats) const MAGICS: [&[u8]; 4] = [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"];

    left_out!("it is TIFF, and the feature `tiff` is left out");
}

#[cfg(not(feature = "compound"))]
pub(super) mod mnt {
    use super::{Decoded, Fault};

    pub(in crate::formats) const MAGIC: &[u8] = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1";

    left_out!("it is a compound file, and the feature `compound` is left out");
}
