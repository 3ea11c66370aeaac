use super::super::gwy::write;
use super::*;

fn written(grid: &Grid, heights: &Field) -> Vec<u8> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("a");
    write(&path, grid, heights).unwrap();
    std::fs::read(&path).unwrap()
}

#[test]
fn a_gwy_written_reads_back() {
    let (grid, heights) = example();
    let scan = decode(&written(&grid, &heights), Some("height")).unwrap();
    assert_eq!((scan.format, scan.channels.len()), ("gwy", 1));
    for (found, expected) in scan.pitch.unwrap().iter().zip(grid.pitch) {
        assert_relative_eq!(*found, expected, max_relative = 1e-15);
    }
    assert_same(&scan.heights, &heights);
    let nothing = Field::from_elem(grid.shape, f64::NAN);
    assert_same(&decode(&written(&grid, &nothing), None).unwrap().heights, &nothing);
}

fn object(name: &str, content: &[u8]) -> Vec<u8> {
    [name.as_bytes(), b"\0", &(content.len() as u32).to_le_bytes(), content].concat()
}

/// A field of 2 × 1 values over 4 × 3 of `xy`.
fn field(values: [f64; 2], xy: &str, z: &str) -> Vec<u8> {
    let unit = |unit: &str| object("GwySIUnit", &[b"unitstr\0s", unit.as_bytes(), b"\0"].concat());
    let content = [
        b"xres\0i\x02\0\0\0yres\0i\x01\0\0\0xreal\0d".to_vec(),
        4f64.to_le_bytes().to_vec(),
        [b"yreal\0d", 3f64.to_le_bytes().as_slice()].concat(),
        [b"si_unit_xy\0o", unit(xy).as_slice()].concat(),
        [b"si_unit_z\0o", unit(z).as_slice()].concat(),
        b"data\0D\x02\0\0\0".to_vec(),
        values.map(f64::to_le_bytes).concat(),
    ];
    object("GwyDataField", &content.concat())
}

fn gwy(components: &[(&str, &[u8])]) -> Vec<u8> {
    let content: Vec<_> =
        components.iter().map(|(name, value)| [name.as_bytes(), b"\0", value].concat()).collect();
    [b"GWYP", object("GwyContainer", &content.concat()).as_slice()].concat()
}

fn field_value(values: [f64; 2], xy: &str, z: &str) -> Vec<u8> {
    [b"o", field(values, xy, z).as_slice()].concat()
}

pub(super) fn sample() -> Vec<u8> {
    gwy(&[
        ("/10/data", &field_value([5.0, 6.0], "µm", "nm")),
        ("/2/data", &field_value([1.0, 2.0], "m", "m")),
        ("/2/data/title", b"sTopography\0"),
        ("/2/mask", &field_value([0.0, 1.0], "m", "")),
        ("/3/data", &field_value([3.0, 4.0], "m", "V")),
        ("/4/data", &field_value([7.0, 8.0], "deg", "m")),
        ("/4/data/title", b"sTopography\0"),
    ])
}

#[test]
fn channels_of_a_gwy_are_its_fields_of_lengths() {
    let first = decode(&sample(), None).unwrap();
    assert_eq!(first.channels, ["Topography", "Topography 2", "height"]);
    assert_eq!(first.pitch, Some([2.0, 3.0]));
    assert_same(&first.heights, &ndarray::array![[1.0], [f64::NAN]]);
    let second = decode(&sample(), Some("Topography 2")).unwrap();
    assert_eq!((second.pitch, second.heights), (None, ndarray::array![[7.0], [8.0]]));
    let third = decode(&sample(), Some("height")).unwrap();
    assert_eq!(third.pitch, Some([2e-6, 3e-6]));
    assert_same(&third.heights, &ndarray::array![[5.0 * 1e-9], [6.0 * 1e-9]]);
}

#[test]
fn what_else_a_gwy_holds_is_passed_over() {
    let height = field_value([1.0, 2.0], "m", "m");
    let inner = object("GwyContainer", b"");
    let file = gwy(&[
        ("b", b"b\x01"),
        ("c", b"cx"),
        ("q", b"q\0\0\0\0\0\0\0\0"),
        ("C", b"C\x02\0\0\0ab"),
        ("I", b"I\x01\0\0\0abcd"),
        ("Q", b"Q\x01\0\0\0abcdefgh"),
        ("S", b"S\x02\0\0\0a\0b\0"),
        ("O", &[b"O\x01\0\0\0", inner.as_slice()].concat()),
        ("/0/data", &height),
    ]);
    assert_same(&decode(&file, None).unwrap().heights, &ndarray::array![[1.0], [2.0]]);
}

#[test]
fn a_damaged_gwy_is_an_error() {
    let volts = field_value([1.0, 2.0], "m", "V");
    assert_eq!(defect(&gwy(&[("/0/data", &volts)])), "gwy: no channel of lengths");
    assert_eq!(
        defect(&gwy(&[("a", b"x")])),
        "gwy: the type of a component is `x`, expected one of bciqdsoCIQDSO"
    );
    assert_eq!(
        defect(&gwy(&[("a", b"D\xff\xff\xff\xff")])),
        "gwy: an object holds 7 bytes, expected 34359738367"
    );
    assert_eq!(defect(&sample()[..100]), "gwy: the file holds 96 bytes, expected 949");
    let heights = field_value([1.0, 2.0], "m", "m");
    let mut fewer = heights.clone();
    let at = fewer.windows(5).position(|part| part == b"xres\0").unwrap();
    fewer[at + 6] = 3;
    let message = "gwy: the part of the heights holds 16 bytes, expected 24";
    assert_eq!(defect(&gwy(&[("/0/data", &fewer)])), message);
    fewer[at + 6] = 1;
    let masked = gwy(&[("/0/data", &heights), ("/0/mask", &fewer)]);
    assert_eq!(defect(&masked), "gwy: the mask is `1 × 1`, expected of the size of its channel");
}
