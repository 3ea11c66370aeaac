//! Files of instruments, which are only read. They are built here byte by byte; measured ones are compared
//! with other programs.

use super::files::{al3d, floats, frt, metropro, opd, plu, tmd, words};
use super::*;

/// Reads 3 × 2 heights that are `unit` times 1, 2, 3, and 4, none, 6 in the next line.
#[track_caller]
fn assert_six(bytes: &[u8], format: &str, pitch: [f64; 2], unit: f64) {
    let scan = decode(bytes, None).unwrap_or_else(|fault| panic!("{fault:?}"));
    assert_eq!((scan.format, scan.heights.dim()), (format, (3, 2)));
    for (found, expected) in scan.pitch.unwrap().iter().zip(pitch) {
        assert_relative_eq!(*found, expected, max_relative = 1e-7);
    }
    let expected = ndarray::array![[1.0, 4.0], [2.0, f64::NAN], [3.0, 6.0]] * unit;
    for (found, expected) in scan.heights.iter().zip(&expected) {
        assert_eq!(found.is_nan(), expected.is_nan(), "{}", scan.heights);
        assert!(found.is_nan() || (found / expected - 1.0).abs() < 1e-7, "{}", scan.heights);
    }
}

pub(super) fn samples() -> Vec<Vec<u8>> {
    let two_channels = opd([3, 2], &[("Raw", 4, &opd_floats()), ("OPD", 2, &OPD_SHORTS)]);
    let frt = frt([3, 2], 16, &[(0x7d, &frt_images())]);
    vec![six_of_al3d(), frt, six_of_metropro(), two_channels, six_of_plu(), six_of_tmd()]
}

/// Each line has a fourth number as padding.
fn six_of_al3d() -> Vec<u8> {
    al3d([3, 2], &floats(&[1.0, 2.0, 3.0, 99.0, 4.0, -1.0, 6.0, 99.0]))
}

#[test]
fn rows_of_an_al3d_are_filled_up_to_eight_bytes() {
    assert_six(&six_of_al3d(), "al3d", [5e-7, 2.5e-7], 1.0);
    let with_columns = |columns: &[u8]| {
        let mut other = six_of_al3d();
        let at = other.windows(4).position(|name| name == b"Cols").unwrap() + 20;
        other[at..at + columns.len()].copy_from_slice(columns);
        defect(&other)
    };
    assert_eq!(with_columns(b"x"), "al3d: Cols is `x`, expected a number");
    assert_eq!(with_columns(b"0"), "al3d: the size along x is `0`, expected at least 1");
    assert_eq!(with_columns(b"5"), "al3d: the part of the heights holds 32 bytes, expected 48");
    assert_eq!(defect(&six_of_al3d()[..60]), "al3d: the file holds 60 bytes, expected 67");
}

/// From the last line to the first, as in the format; 1 is a missing height.
const FRT_HEIGHTS: [u8; 12] = [40, 0, 1, 0, 60, 0, 10, 0, 20, 0, 30, 0];

/// A topography, an intensity, a thickness.
fn frt_images() -> Vec<u8> {
    let thickness = words(&[0x0100_0080, 3, 1, 32, 7, 8, 1]);
    [words(&[3, 0, 4, 3, 2, 16]), FRT_HEIGHTS.into(), words(&[2, 1, 1, 16]), vec![0; 2], thickness].concat()
}

#[test]
fn an_frt_has_its_heights_in_a_block_or_among_images() {
    assert_six(&frt([3, 2], 16, &[(0x0b, &FRT_HEIGHTS)]), "frt", [1e-3, 5e-4], 1e-8);
    assert_six(&frt([3, 2], 16, &[(0x7d, &frt_images())]), "frt", [1e-3, 5e-4], 1e-8);
    let both = frt([3, 2], 16, &[(0x0b, &FRT_HEIGHTS), (0x7d, &frt_images())]);
    assert_six(&both, "frt", [1e-3, 5e-4], 1e-8);
    let thickness = decode(&both, Some("thickness")).unwrap();
    assert_eq!(thickness.channels, ["topography", "thickness"]);
    assert_same(&thickness.heights, &(ndarray::array![[7.0], [8.0], [f64::NAN]] * 1e-9));
    assert_eq!(defect(&frt([3, 2], 16, &[])), "frt: no block of heights");
    let short = frt([3, 2], 16, &[(0x0b, &FRT_HEIGHTS[1..])]);
    assert_eq!(defect(&short), "frt: the part of the heights holds 11 bytes, expected 12");
    assert_eq!(defect(&short[..90]), "frt: the file holds 90 bytes, expected 93");
}

fn six_of_metropro() -> Vec<u8> {
    metropro([3, 2], &[1, 2, 3, 4, 2_147_483_640, 6].map(i32::to_be_bytes).concat())
}

#[test]
fn heights_of_a_metropro_dat_are_phases() {
    assert_six(&six_of_metropro(), "metropro", [2e-6; 2], 0.5 * 5e-7 / 32_768.0);
    let mut other = six_of_metropro();
    other[219] = 3;
    assert_eq!(defect(&other), "metropro: the resolution is `3`, expected 0, 1 or 2");
    assert_eq!(
        defect(&six_of_metropro()[..860]),
        "metropro: the part of the heights holds 22 bytes, expected 24"
    );
    assert_eq!(defect(&six_of_metropro()[..100]), "metropro: the file holds 100 bytes, expected 164");
}

/// With y fastest, from the last y to the first.
fn opd_floats() -> Vec<u8> {
    floats(&[4.0, 1.0, 1e38, 2.0, 6.0, 3.0])
}

const OPD_SHORTS: [u8; 12] = [40, 0, 10, 0, 0xfe, 0x7f, 20, 0, 60, 0, 30, 0];

#[test]
fn an_opd_counts_wavelengths() {
    let both = opd([3, 2], &[("Raw", 4, &opd_floats()), ("OPD", 2, &OPD_SHORTS), ("Image", 1, &[7; 6])]);
    assert_six(&both, "opd", [2e-6, 1e-6], 5e-7);
    assert_six(&opd([3, 2], &[("OPD", 2, &OPD_SHORTS)]), "opd", [2e-6, 1e-6], 5e-7);
    assert_eq!(decode(&both, Some("OPD")).unwrap().channels, ["Raw", "OPD"]);
    for missing in [1e30, 3.4e38, -1.7e38, f32::INFINITY] {
        let file = opd([3, 2], &[("Raw", 4, &floats(&[4.0, 1.0, missing, 2.0, 6.0, 3.0]))]);
        assert_six(&file, "opd", [2e-6, 1e-6], 5e-7);
    }
    assert_eq!(defect(&opd([3, 2], &[("Image", 1, &[7; 6])])), "opd: no array of heights, such as Raw");
    assert_eq!(
        defect(&opd([3, 2], &[("Raw", 3, &[7; 18])])),
        "opd: the bytes of a height is `3`, expected 2 or 4"
    );
    assert_eq!(defect(&both[..both.len() - 1]), "opd: the file holds 297 bytes, expected 298");
    let short = opd([3, 2], &[("Raw", 4, &opd_floats()[..20])]);
    assert_eq!(defect(&short), "opd: the part of the heights holds 20 bytes, expected 24");
}

fn six_of_plu() -> Vec<u8> {
    plu([3, 2], &[floats(&[1.0, 2.0, 3.0, 4.0, 1_000_001.0, 6.0]), vec![9; 3]].concat())
}

#[test]
fn a_plu_is_known_by_its_date() {
    assert_six(&six_of_plu(), "plu", [5e-7, 2.5e-7], 1e-6);
    let mut other = six_of_plu();
    other[428] = 1;
    assert_eq!(defect(&other), "plu: the kind of measurement is `1`, expected 3, a topography");
    assert_eq!(defect(&six_of_plu()[..520]), "plu: the part of the heights holds 12 bytes, expected 24");
    assert_eq!(defect(&six_of_plu()[..400]), "plu: the file holds 400 bytes, expected 404");
    let mut other = six_of_plu();
    other[13] = b'-';
    assert!(matches!(decode(&other, None), Err(Fault::NotATopography(_))));
}

fn six_of_tmd() -> Vec<u8> {
    tmd([3, 2], &floats(&[1.0, 2.0, 3.0, 4.0, f32::NAN, 6.0]))
}

#[test]
fn a_tmd_is_in_millimetres() {
    assert_six(&six_of_tmd(), "tmd", [5e-4, 2.5e-4], 1e-3);
    assert_eq!(defect(&six_of_tmd()[..80]), "tmd: the part of the heights holds 17 bytes, expected 24");
    assert_eq!(defect(&six_of_tmd()[..36]), "tmd: no zero that ends a text");
}
