use super::files::sdf;
use super::*;

#[test]
fn an_sdf_written_reads_back_to_the_last_bit() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("a");
    let (grid, heights) = example();
    super::super::sdf::write(&path, &grid, &heights).unwrap();
    let scan = read(&path, Some("height"), None).unwrap();
    assert_eq!((scan.format, scan.pitch), ("sdf", Some(grid.pitch)));
    assert_same(&scan.heights, &heights);
    assert_eq!(std::fs::metadata(&path).unwrap().len(), 81 + 15 * 8);

    let grid = Grid::new([1, 65_536], [1e-6; 2]).unwrap();
    let heights = Field::from_shape_fn(grid.shape, |(_, iy)| iy as f64 * 1e-9);
    super::super::sdf::write(&path, &grid, &heights).unwrap();
    assert!(std::fs::read(&path).unwrap().starts_with(b"bISO-2.0"));
    assert_same(&read(&path, None, None).unwrap().heights, &heights);
}

pub(super) fn samples() -> [Vec<u8>; 2] {
    [sdf(5, [3, 1], &[1, 0, 0, 0x80, 0xfe, 0xff]), TEXT.as_bytes().to_vec()]
}

const TEXT: &str = "aISO-1.0\r\nManufacID = me\r\nNumPoints = 3 ; of each\r\nNumProfiles = 2\r\nXscale = 0.5\r\nYscale=0.25\r\n\
                    Zscale = 2\r\nCompression = 0\r\nDataType = 5\r\n*\r\n1 BAD\r\n-2 3\r\n\r\n4 5.5\r\n*\r\n<a> \u{b5} </a>\r\n*\r\n";

/// The numbers 1, `marker` and 3 as the type with this code.
fn three(kind: u8, marker: f64) -> Vec<u8> {
    let numbers = [1.0, marker, 3.0];
    let all = |write: &dyn Fn(f64) -> Vec<u8>| numbers.iter().flat_map(|number| write(*number)).collect();
    match kind {
        0 => all(&|n| vec![n as u8]),
        1 => all(&|n| (n as u16).to_le_bytes().to_vec()),
        2 => all(&|n| (n as u32).to_le_bytes().to_vec()),
        3 => all(&|n| (n as f32).to_le_bytes().to_vec()),
        4 => all(&|n| (n as i8).to_le_bytes().to_vec()),
        5 => all(&|n| (n as i16).to_le_bytes().to_vec()),
        6 => all(&|n| (n as i32).to_le_bytes().to_vec()),
        _ => all(&|n| n.to_le_bytes().to_vec()),
    }
}

/// Smallest and largest number of each type.
const LIMITS: [[f64; 2]; 8] = [
    [0.0, 255.0],
    [0.0, 65_535.0],
    [0.0, 4_294_967_295.0],
    [f32::MIN as f64, f32::MAX as f64],
    [-128.0, 127.0],
    [-32_768.0, 32_767.0],
    [-2_147_483_648.0, 2_147_483_647.0],
    [f64::MIN, f64::MAX],
];

/// Reads 1, `marker` and 3, stored as the type with this code in a file of this version, which must not lose
/// 1 and 3.
fn between_1_and_3(version: &[u8; 7], kind: u8, marker: f64) -> f64 {
    let data = three(kind, marker);
    let mut bytes = sdf(kind, [3, 1], &data);
    bytes[1..8].copy_from_slice(version);
    let heights = decode(&bytes, None).unwrap().heights;
    assert_eq!([heights[[0, 0]], heights[[2, 0]]], [2.0, 6.0]);
    heights[[1, 0]]
}

#[test]
fn the_least_number_of_an_iso_sdf_and_the_largest_of_a_bcr_sdf_are_missing() {
    for (kind, [smallest, largest]) in (0..).zip(LIMITS) {
        assert!(between_1_and_3(b"ISO-1.0", kind, smallest).is_nan(), "{kind}");
        assert!(between_1_and_3(b"BCR-1.0", kind, largest).is_nan(), "{kind}");
        if ![3, 7].contains(&kind) {
            assert_eq!(between_1_and_3(b"ISO-1.0", kind, largest), 2.0 * largest);
            assert_eq!(between_1_and_3(b"BCR-1.0", kind, smallest), 2.0 * smallest);
        }
        let marker = if smallest == 0.0 { largest } else { smallest };
        assert!(between_1_and_3(b"NIST-1.", kind, marker).is_nan(), "{kind}");
    }
    for version in [b"ISO-1.0", b"BCR-1.0", b"NIST-1."] {
        assert!([3, 7].into_iter().all(|kind| between_1_and_3(version, kind, f64::NAN).is_nan()));
    }
    assert!(
        between_1_and_3(b"BCR-1.0", 3, 3.4e38).is_nan() && between_1_and_3(b"BCR-1.0", 7, 1.7e308).is_nan()
    );
    // Eight bytes that one manufacturer adds.
    let longer = [&[9; 8], three(5, -32_768.0).as_slice()].concat();
    assert!(decode(&sdf(5, [3, 1], &longer), None).unwrap().heights[[1, 0]].is_nan());
}

#[test]
fn the_first_profile_of_a_bcr_sdf_has_the_largest_y() {
    let mut bytes = sdf(0, [2, 3], &[1, 2, 3, 4, 5, 6]);
    bytes[1..8].copy_from_slice(b"BCR-1.0");
    let bcr = decode(&bytes, None).unwrap().heights;
    assert_same(&bcr, &ndarray::array![[10.0, 6.0, 2.0], [12.0, 8.0, 4.0]]);
    bytes[1..8].copy_from_slice(b"ISO-1.0");
    assert_same(&decode(&bytes, None).unwrap().heights, &ndarray::array![[2.0, 6.0, 10.0], [4.0, 8.0, 12.0]]);
    let text = TEXT
        .replace("aISO", "aBCR")
        .replace("DataType = 5", "DataType = INT16 ; a word")
        .replace("-2", "32767");
    let scan = decode(text.as_bytes(), None).unwrap();
    assert_same(&scan.heights, &ndarray::array![[6.0, 2.0], [8.0, f64::NAN], [11.0, f64::NAN]]);
}

#[test]
fn the_heights_of_an_sdf_in_text_may_break_lines_anywhere() {
    let scan = decode(TEXT.as_bytes(), None).unwrap();
    assert_eq!((scan.format, scan.pitch), ("sdf", Some([0.5, 0.25])));
    assert_same(&scan.heights, &ndarray::array![[2.0, 6.0], [f64::NAN, 8.0], [-4.0, 11.0]]);
}

#[test]
fn an_sdf_in_text_may_have_comments_words_and_any_ends_of_lines() {
    let bcr = TEXT
        .replace("aISO-1.0", "ABCR-1.0")
        .replace("= 5", "= INTEGER ; *")
        .replace("Compression = 0", "Compression = NULL");
    for text in [
        bcr.clone(),
        bcr.replace("\r\n", "\r"),
        bcr.replace("\r\n", "\n").replace("1 BAD", "1 bad ; the first"),
    ] {
        let scan = decode(text.as_bytes(), None).unwrap();
        assert_same(&scan.heights, &ndarray::array![[6.0, 2.0], [8.0, f64::NAN], [11.0, -4.0]]);
    }
    let iso = TEXT.replace("DataType = 5", "DataType = binary32").replace("BAD", "-3.402823E+38");
    assert!(decode(iso.as_bytes(), None).unwrap().heights[[1, 0]].is_nan());
}

#[test]
fn a_damaged_sdf_is_an_error() {
    let with = |old: &str, new: &str| defect(TEXT.replace(old, new).as_bytes());
    assert_eq!(with("5.5", "5.5m"), "sdf: line 14: `5.5m` is not a height");
    assert_eq!(with("5.5", ""), "sdf: the number of heights is `5`, expected NumPoints · NumProfiles");
    assert_eq!(with("NumPoints = 3", "NumPoints = -3"), "sdf: NumPoints is `-3`, expected at least 1");
    assert_eq!(with("Yscale", "Wscale"), "sdf: no Yscale");
    assert_eq!(with("Zscale = 2", "Zscale = 0"), "sdf: Zscale is `0`, expected a length in metres");
    assert_eq!(with("Compression = 0", "Compression = 1"), "sdf: Compression is `1`, expected 0, none");
    assert_eq!(with("*", ""), "sdf: no asterisk that ends the header");
    assert_eq!(defect(&sdf(5, [3, 1], &[0; 5])), "sdf: the part of the heights holds 5 bytes, expected 6");
    assert_eq!(
        defect(&sdf(9, [3, 1], &[0; 6])),
        "sdf: DataType is `9`, expected 0 to 7, or the name of a type"
    );
    assert_eq!(defect(&sdf(5, [3, 1], &[])[..60]), "sdf: the file holds 60 bytes, expected 62");
}
