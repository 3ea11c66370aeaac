//! Files of instruments, which are only read: each is built here byte by byte, and measured ones are read as others do.

use super::*;

#[test]
fn an_al3d_is_read_as_others_read_it() {
    assert_as_expected("al3d-1.al3d", "al3d", 1.0);
}

#[test]
fn an_frt_is_read_as_others_read_it() {
    assert_as_expected("frt-2.frt", "frt", 1.0);
}

#[test]
fn a_metropro_dat_is_read_as_others_read_it() {
    assert_as_expected("metropro-1.dat", "metropro", 1.0);
}

#[test]
fn an_opd_is_read_as_others_read_it() {
    assert_as_expected("opd-1.opd", "opd", 1e-3);
}

#[test]
fn a_plu_is_read_as_others_read_it() {
    assert_as_expected("plu-1.plu", "plu", 1e-6);
}

#[test]
fn a_tmd_is_read_as_others_read_it() {
    assert_as_expected("tmd-1.tmd", "tmd", 1e-3);
}
/// A header of zeros with `parts` at their places, and what follows it.
fn file(header: usize, parts: &[(usize, &[u8])], data: &[u8]) -> Vec<u8> {
    let mut file = vec![0; header];
    for (at, part) in parts {
        file[*at..at + part.len()].copy_from_slice(part);
    }
    file.extend(data);
    file
}

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

fn words(numbers: &[u32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

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
    let two_channels = opd(&[("Raw", 4, &opd_floats()), ("OPD", 2, &OPD_SHORTS)]);
    let frt = frt(&[(0x7d, &frt_images())]);
    vec![al3d("3", "-1"), frt, metropro(), two_channels, plu(3), tmd()]
}

fn al3d(columns: &str, invalid: &str) -> Vec<u8> {
    let tags = [
        ("Version", "1"),
        ("TagCount", "6"),
        ("Cols", columns),
        ("Rows", "2"),
        ("DepthImageOffset", "500"),
        ("InvalidPixelValue", invalid),
        ("PixelSizeXMeter", "5e-7"),
        ("PixelSizeYMeter", "2.5e-7"),
    ];
    let mut header = b"AliconaImaging\0\r\n".to_vec();
    for (name, value) in tags {
        let tag: [(usize, &[u8]); 3] = [(0, name.as_bytes()), (20, value.as_bytes()), (50, b"\r\n")];
        header.extend(file(52, &tag, &[]));
    }
    file(500, &[(0, &header)], &floats(&[1.0, 2.0, 3.0, 99.0, 4.0, -1.0, 6.0, 99.0]))
}

#[test]
fn rows_of_an_al3d_are_filled_up_to_eight_bytes() {
    assert_six(&al3d("3", "-1"), "al3d", [5e-7, 2.5e-7], 1.0);
    assert_eq!(defect(&al3d("x", "-1")), "al3d: Cols is `x`, expected a number");
    assert_eq!(defect(&al3d("0", "-1")), "al3d: the size along x is `0`, expected at least 1");
    assert_eq!(defect(&al3d("5", "-1")), "al3d: the part of the heights holds 32 bytes, expected 48");
    assert_eq!(defect(&al3d("4", "-1")[..60]), "al3d: the file holds 60 bytes, expected 67");
}

fn frt(blocks: &[(u16, &[u8])]) -> Vec<u8> {
    let lengths: Vec<u8> = [3e-3f64, 1e-3].iter().flat_map(|length| length.to_le_bytes()).collect();
    let unit = [&[5, 0, 0, 0], &1e-9f64.to_le_bytes()[..]].concat();
    let sizes = words(&[3, 2, 16]);
    let common: [(u16, &[u8]); 3] = [(0x66, &sizes), (0x67, &lengths), (0x6c, &unit)];
    let mut file = b"FRTM_GLIDERV1.00".to_vec();
    file.extend((common.len() as u16 + blocks.len() as u16).to_le_bytes());
    for (kind, content) in common.iter().chain(blocks) {
        file.extend(kind.to_le_bytes());
        file.extend((content.len() as u32).to_le_bytes());
        file.extend(*content);
    }
    file
}

/// From the last line to the first, as the format has it; 1 stands for none.
const FRT_HEIGHTS: [u8; 12] = [40, 0, 1, 0, 60, 0, 10, 0, 20, 0, 30, 0];

/// A topography, an intensity, a thickness.
fn frt_images() -> Vec<u8> {
    let thickness = words(&[0x0100_0080, 3, 1, 32, 7, 8, 1]);
    [words(&[3, 0, 4, 3, 2, 16]), FRT_HEIGHTS.into(), words(&[2, 1, 1, 16]), vec![0; 2], thickness].concat()
}

#[test]
fn an_frt_has_its_heights_in_a_block_or_among_images() {
    assert_six(&frt(&[(0x0b, &FRT_HEIGHTS)]), "frt", [1e-3, 5e-4], 1e-8);
    assert_six(&frt(&[(0x7d, &frt_images())]), "frt", [1e-3, 5e-4], 1e-8);
    let both = frt(&[(0x0b, &FRT_HEIGHTS), (0x7d, &frt_images())]);
    assert_six(&both, "frt", [1e-3, 5e-4], 1e-8);
    let thickness = decode(&both, Some("thickness")).unwrap();
    assert_eq!(thickness.channels, ["topography", "thickness"]);
    assert_same(&thickness.heights, &(ndarray::array![[7.0], [8.0], [f64::NAN]] * 1e-9));
    assert_eq!(defect(&frt(&[])), "frt: no block of heights");
    let short = frt(&[(0x0b, &FRT_HEIGHTS[1..])]);
    assert_eq!(defect(&short), "frt: the part of the heights holds 11 bytes, expected 12");
    assert_eq!(defect(&short[..90]), "frt: the file holds 90 bytes, expected 93");
}

fn metropro() -> Vec<u8> {
    let header: [(usize, &[u8]); 11] = [
        (0, b"\x88\x1b\x03\x6f"),
        (6, &834u32.to_be_bytes()),
        (60, &4u32.to_be_bytes()),
        (68, &3u16.to_be_bytes()),
        (70, &2u16.to_be_bytes()),
        (164, &0.5f32.to_be_bytes()),
        (168, &5e-7f32.to_be_bytes()),
        (176, &1f32.to_be_bytes()),
        (184, &2e-6f32.to_be_bytes()),
        (218, &1u16.to_be_bytes()),
        (830, b"last"),
    ];
    let phases = [1, 2, 3, 4, 2_147_483_640, 6].map(i32::to_be_bytes).concat();
    file(834, &header, &[vec![9; 4], phases].concat())
}

#[test]
fn heights_of_a_metropro_dat_are_phases() {
    assert_six(&metropro(), "metropro", [2e-6; 2], 0.5 * 5e-7 / 32_768.0);
    let mut other = metropro();
    other[219] = 3;
    assert_eq!(defect(&other), "metropro: the resolution is `3`, expected 0, 1 or 2");
    assert_eq!(defect(&metropro()[..860]), "metropro: the part of the heights holds 22 bytes, expected 24");
    assert_eq!(defect(&metropro()[..100]), "metropro: the file holds 100 bytes, expected 164");
}

/// An OPD of arrays of 3 × 2, whose elements have the number of bytes given.
fn opd(arrays: &[(&str, u16, &[u8])]) -> Vec<u8> {
    let (wavelength, pixel, aspect) = (floats(&[500.0]), floats(&[2e-3]), floats(&[0.5]));
    let mut blocks: Vec<(&str, u16, Vec<u8>)> = vec![
        ("Wavelength", 7, wavelength),
        ("Pixel_size", 7, pixel),
        ("Aspect", 7, aspect),
        ("Mult", 6, vec![10, 0]),
        ("Title", 5, b"a test".to_vec()),
    ];
    for (name, size, data) in arrays {
        let sizes = [3, 2, *size].map(u16::to_le_bytes).concat();
        blocks.push((name, 3, [sizes.as_slice(), data].concat()));
    }
    blocks.insert(0, ("Directory", 1, vec![0; 24 * (blocks.len() + 1)]));
    let mut content = vec![1, 0];
    for (name, kind, data) in &blocks {
        let size = (data.len() as u32).to_le_bytes();
        let entry: [(usize, &[u8]); 4] =
            [(0, name.as_bytes()), (16, &kind.to_le_bytes()), (18, &size), (22, &[8, 0])];
        content.extend(file(24, &entry, &[]));
    }
    content.extend(blocks[1..].iter().flat_map(|(_, _, data)| data.clone()));
    content
}

/// With y fastest, from the last y to the first.
fn opd_floats() -> Vec<u8> {
    floats(&[4.0, 1.0, 1e38, 2.0, 6.0, 3.0])
}

const OPD_SHORTS: [u8; 12] = [40, 0, 10, 0, 0xfe, 0x7f, 20, 0, 60, 0, 30, 0];

#[test]
fn an_opd_counts_wavelengths() {
    let both = opd(&[("Raw", 4, &opd_floats()), ("OPD", 2, &OPD_SHORTS), ("Image", 1, &[7; 6])]);
    assert_six(&both, "opd", [2e-6, 1e-6], 5e-7);
    assert_six(&opd(&[("OPD", 2, &OPD_SHORTS)]), "opd", [2e-6, 1e-6], 5e-7);
    assert_eq!(decode(&both, Some("OPD")).unwrap().channels, ["Raw", "OPD"]);
    assert_eq!(defect(&opd(&[("Image", 1, &[7; 6])])), "opd: no array of heights, such as Raw");
    assert_eq!(defect(&opd(&[("Raw", 3, &[7; 18])])), "opd: the bytes of a height is `3`, expected 2 or 4");
    assert_eq!(defect(&both[..both.len() - 1]), "opd: the file holds 297 bytes, expected 298");
    let short = opd(&[("Raw", 4, &opd_floats()[..20])]);
    assert_eq!(defect(&short), "opd: the part of the heights holds 20 bytes, expected 24");
}

fn plu(kind: u32) -> Vec<u8> {
    let header: [(usize, &[u8]); 4] = [
        (0, b"Tue Mar  7 16:35:59 2023"),
        (132, b"a test"),
        (404, &floats(&[0.5, 0.25])),
        (428, &kind.to_le_bytes()),
    ];
    let heights = floats(&[1.0, 2.0, 3.0, 4.0, 1_000_001.0, 6.0]);
    file(500, &header, &[words(&[2, 3]), heights, vec![9; 3]].concat())
}

#[test]
fn a_plu_is_known_by_its_date() {
    assert_six(&plu(3), "plu", [5e-7, 2.5e-7], 1e-6);
    assert_eq!(defect(&plu(1)), "plu: the kind of measurement is `1`, expected 3, a topography");
    assert_eq!(defect(&plu(3)[..520]), "plu: the part of the heights holds 12 bytes, expected 24");
    assert_eq!(defect(&plu(3)[..400]), "plu: the file holds 400 bytes, expected 404");
    let mut other = plu(3);
    other[13] = b'-';
    assert!(matches!(decode(&other, None), Err(Fault::NotATopography(_))));
}

fn tmd() -> Vec<u8> {
    let mut file = b"Binary TrueMap Data File v2.0\r\n\0a test\0".to_vec();
    file.extend(words(&[3, 2]));
    file.extend(floats(&[1.5, 0.5, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0, f32::NAN, 6.0]));
    file
}

#[test]
fn a_tmd_is_in_millimetres() {
    assert_six(&tmd(), "tmd", [5e-4, 2.5e-4], 1e-3);
    assert_eq!(defect(&tmd()[..80]), "tmd: the part of the heights holds 17 bytes, expected 24");
    assert_eq!(defect(&tmd()[..36]), "tmd: no zero that ends a text");
}
