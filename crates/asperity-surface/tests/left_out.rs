//! A format whose feature is left out is recognised, and refused with the name of the feature.
#![cfg(feature = "files")]

use asperity_surface::{Format, ReadOptions};

#[test]
fn what_is_left_out_is_named() {
    let formats: [(&str, bool, &[u8]); 5] = [
        ("zip", cfg!(feature = "zip"), b"PK\x03\x04 an archive"),
        ("hdf5", cfg!(feature = "hdf5"), b"\x89HDF\r\n\x1a\n a file"),
        ("hdf5", cfg!(feature = "hdf5"), b"MATLAB 7.3 MAT-file, a file"),
        ("tiff", cfg!(feature = "tiff"), b"II*\0 a picture"),
        ("compound", cfg!(feature = "compound"), b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1 a file"),
    ];
    for (feature, is_read, bytes) in formats {
        let error = ReadOptions::default().scan_bytes("a file", bytes).unwrap_err().to_string();
        assert_eq!(error.contains(&format!("the feature `{feature}` is left out")), !is_read, "{error}");
    }
    assert_eq!(Format::from_path("a.x3p").is_some(), cfg!(feature = "zip"));
}

#[test]
fn what_needs_nothing_more_is_read() {
    let scan = ReadOptions::default().scan_bytes("a file", b"1 2 3\n4 5 6\n").unwrap();
    assert_eq!((scan.format, scan.heights.dim()), ("text", (3, 2)));
}
