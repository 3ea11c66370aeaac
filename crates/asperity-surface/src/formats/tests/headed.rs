use super::files::bcr;
use super::*;

/// Reads 3 × 2 heights: 1, 2, 3, and 4, none, 6 in the next line, times `unit`.
#[track_caller]
fn assert_six(bytes: &[u8], format: &str, channel: &str, pitch: [f64; 2], unit: f64) {
    let scan = decode(bytes, None).unwrap_or_else(|fault| panic!("{fault:?}"));
    assert_eq!((scan.format, scan.channel.as_str()), (format, channel));
    for (found, expected) in scan.pitch.unwrap().iter().zip(pitch) {
        assert_relative_eq!(*found, expected, max_relative = 1e-7);
    }
    assert_same(&scan.heights, &(ndarray::array![[1.0, 4.0], [2.0, f64::NAN], [3.0, 6.0]] * unit));
}

const SPIP: &str = "# File Format = ASCII\r\n# Created by SPIP\r\n# x-pixels = 3\r\n# y-pixels = 2\r\n# x-length = 1500\r\n\
                    # y-length = 500\r\n# z-unit = [nm]\r\n# voidpixels =1\r\n# Start of Data:\r\n1 2 3\r\n4 3.4e38 6\r\n";
const GWYDDION: &str =
    "# Channel: Topography\n# Width: 1.5 µm\n# Height: 500 nm\n# Value units: m\n1\t2\t3\n4\tnan\t6\n";
const KOALA: &str =
    "h=2 w=3\npixel size=5e-007 m\ndata unit=rad\nheight conversion factor (-> m)=0.5\n1 2 3\n4 nan 6\n";
const ZYGO: &str = "Zygo XYZ Data File - Format 1\n0 3 0 0 \"now\"\n0 0 3 2 1 255\n10 20 3 2\n\n\n\n\
                    0 0 6.328e-07 0.5 1 0 5e-5 1787677163\n#\n10 20 1\n11 20 2\n12 20 3\n10 21 4\n11 21 No Data\n\
                    12 21 6\n#\n";

pub(super) fn samples() -> Vec<Vec<u8>> {
    let text = [SPIP, GWYDDION, KOALA, ZYGO].map(|text| text.as_bytes().to_vec());
    text.into_iter()
        .chain([bcr("bcrstm", false, [3, 2], &SHORTS), bcr("bcrf_unicode", true, [3, 2], &floats())])
        .collect()
}

#[test]
fn text_with_a_header_has_its_units_and_lengths() {
    assert_six(SPIP.as_bytes(), "spip", "height", [5e-7, 2.5e-7], 1e-9);
    assert_six(GWYDDION.as_bytes(), "gwyddion text", "Topography", [5e-7, 2.5e-7], 1.0);
    assert_six(KOALA.as_bytes(), "koala", "height", [5e-7, 5e-7], 0.5);
    assert_six(ZYGO.as_bytes(), "zygo xyz", "height", [5e-5, 5e-5], 1e-6);
}

#[test]
fn a_text_that_does_not_keep_to_its_header_is_an_error() {
    let with = |text: &str, old: &str, new: &str| defect(text.replacen(old, new, 1).as_bytes());
    assert_eq!(
        with(SPIP, "y-pixels = 2", "y-pixels = 3"),
        "spip: the matrix is `3 × 2`, expected of the size in the header"
    );
    assert_eq!(with(SPIP, "x-length", "z-length"), "spip: no x-length");
    assert_eq!(with(SPIP, "[nm]", "V"), "spip: a unit is `V`, expected one of length");
    assert_eq!(
        with(GWYDDION, "500 nm", "500"),
        "gwyddion text: Height is `500`, expected a length with its unit"
    );
    assert_eq!(with(GWYDDION, "Value units", "Value"), "gwyddion text: no Value units");
    assert_eq!(with(KOALA, "nan", "x"), "koala: line 6: `x` is not a height");
    assert_eq!(with(KOALA, "5e-007 m", "5 px"), "koala: pixel size is `5 px`, expected a length in m");
    assert_eq!(with(ZYGO, "12 21 6", "13 21 6"), "zygo xyz: line 15: `13 21 6` is not a height");
    assert_eq!(with(ZYGO, "10 20 3 2", "10 20 3"), "zygo xyz: no origin and size in line 4");
    assert_eq!(
        with(ZYGO, "10 20 3 2", "10 20 300 200"),
        "zygo xyz: the file holds 171 bytes, expected 360000"
    );
    assert_eq!(with(ZYGO, "5e-5", "x"), "zygo xyz: no camera resolution in line 8");
}

const SHORTS: [u8; 12] = [1, 0, 2, 0, 3, 0, 4, 0, 0xff, 0x7f, 6, 0];

/// Big-endian.
fn floats() -> Vec<u8> {
    [1.0f32, 2.0, 3.0, 4.0, f32::MAX, 6.0].iter().flat_map(|number| number.to_be_bytes()).collect()
}

#[test]
fn a_bcr_has_a_header_in_text_and_heights_in_binary() {
    let pitch = [5e-7, 2.5e-7];
    assert_six(&bcr("bcrstm", false, [3, 2], &SHORTS), "bcr", "height", pitch, 0.5 * 1e-9);
    assert_six(&bcr("bcrstm_unicode", false, [3, 2], &SHORTS), "bcr", "height", pitch, 0.5 * 1e-9);
    assert_six(&bcr("bcrf", true, [3, 2], &floats()), "bcr", "height", pitch, 0.5 * 1e-9);
    let with = |old: &str, new: &str| {
        let text = String::from_utf8(bcr("bcrstm", false, [3, 2], &[0; 12])).unwrap();
        defect(text.replacen(old, new, 1).as_bytes())
    };
    assert_eq!(with("bit2nm = 0.5", "bitonm = 0.5"), "bcr: no bit2nm");
    assert_eq!(with("bcrstm", "bcrxtm"), "bcr: fileformat is `bcrxtm`, expected bcrstm or bcrf");
    assert_eq!(with("xunit = um", "zunit = pA"), "bcr: a unit is `pA`, expected one of length");
    assert_eq!(with("xunit = um\n", "current= 1\n"), "bcr: current is `1`, expected 0: heights");
    assert_eq!(with("ypixels = 2", "ypixels = x"), "bcr: ypixels is `x`, expected at least 1");
    assert_eq!(
        defect(&bcr("bcrf", true, [3, 2], &SHORTS)),
        "bcr: the part of the heights holds 12 bytes, expected 24"
    );
    assert_eq!(defect(b"fileformat = bcrf\n"), "bcr: the file holds 18 bytes, expected 2048");
}
