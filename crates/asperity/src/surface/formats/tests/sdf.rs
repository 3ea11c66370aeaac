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
                    Zscale = 2\r\nCompression = 0\r\nDataType = 5\r\n*\r\n1 BAD\r\n-2 3\r\n\r\n4 5.5\r\n*\r\n<a> \u{b5} </a>*";

#[test]
fn an_sdf_may_hold_any_numbers_of_which_one_stands_for_none() {
    let all = |numbers: [&[u8]; 3]| numbers.concat();
    for (kind, data, expected) in [
        (0, all([&[1], &[255], &[254]]), [2.0, f64::NAN, 508.0]),
        (1, all([&[1, 0], &[255; 2], &[254, 255]]), [2.0, f64::NAN, 131_068.0]),
        (2, all([&[1, 0, 0, 0], &[255; 4], &[0, 1, 0, 0]]), [2.0, f64::NAN, 512.0]),
        (3, all([&1f32.to_le_bytes(), &f32::NAN.to_le_bytes(), &0.5f32.to_le_bytes()]), [2.0, f64::NAN, 1.0]),
        (4, all([&[1], &[0x80], &[0xff]]), [2.0, f64::NAN, -2.0]),
        (5, all([&[1, 0], &[0, 0x80], &[0xff, 0xff]]), [2.0, f64::NAN, -2.0]),
        (6, all([&[1, 0, 0, 0], &i32::MIN.to_le_bytes(), &[255; 4]]), [2.0, f64::NAN, -2.0]),
    ] {
        let scan = decode(&sdf(kind, [3, 1], &data), None).unwrap();
        assert_eq!(scan.pitch, Some([0.5, 0.25]));
        assert_same(&scan.heights, &Field::from_shape_vec([3, 1], expected.to_vec()).unwrap());
        let longer = [&[9; 8], data.as_slice()].concat();
        assert_same(&decode(&sdf(kind, [3, 1], &longer), None).unwrap().heights, &scan.heights);
    }
}

#[test]
fn the_heights_of_an_sdf_in_text_may_break_lines_anywhere() {
    let scan = decode(TEXT.as_bytes(), None).unwrap();
    assert_eq!((scan.format, scan.pitch), ("sdf", Some([0.5, 0.25])));
    assert_same(&scan.heights, &ndarray::array![[2.0, 6.0], [f64::NAN, 8.0], [-4.0, 11.0]]);
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
    assert_eq!(defect(&sdf(9, [3, 1], &[0; 6])), "sdf: DataType is `9`, expected 0 to 7");
    assert_eq!(defect(&sdf(5, [3, 1], &[])[..60]), "sdf: the file holds 60 bytes, expected 62");
}
