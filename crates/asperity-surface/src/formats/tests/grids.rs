//! Grids whose first line is that of the largest y.

use super::*;

/// The heights of the files in the corpora: 5 × 3, one of them missing, the first line at the largest y.
fn heights() -> Field {
    let lines = ndarray::array![
        [-0.718, 1.186, 0.895, -0.544, -0.547],
        [1.108, 0.094, f64::NAN, -1.358, -1.307],
        [-1.232, 0.267, -0.007, 0.502, -1.327],
    ];
    lines.t().to_owned()
}

#[test]
fn a_gsf_by_gsffile_has_its_first_line_at_the_largest_y() {
    // Written by gsffile 0.5.5.
    let scan = read(&corpus("gsf", "field"), None, None).unwrap();
    assert_eq!((scan.format, scan.channel.as_str(), scan.unit), ("gsf", "disc", LengthUnit::Known));
    assert_eq!(scan.pitch, Some([1e-5 / 5.0, 9e-6 / 3.0]));
    let expected = heights().mapv(|z| f64::from(z as f32 * 1e-6));
    for (found, expected) in scan.heights.iter().zip(&expected) {
        assert!(
            found.is_nan() && expected.is_nan() || (found - expected).abs() < 1e-12,
            "{found} {expected}"
        );
    }
    let bare = read(&corpus("gsf", "bare"), None, Some(1e-9)).unwrap();
    assert_eq!((bare.pitch, bare.heights.dim()), (None, (4, 2)));
    assert_eq!((bare.heights[[0, 0]], bare.heights[[3, 0]]), (5.0 * 1e-9, -8.0 * 1e-9));
}

#[test]
fn a_gsf_without_units_takes_one_for_all_lengths() {
    let with = |header: &str| {
        let mut file = format!("Gwyddion Simple Field 1.0\nXRes = 2\nYRes = 1\n{header}").into_bytes();
        file.resize((file.len() + 1).next_multiple_of(4), 0);
        file.extend([1.0f32, 2.0].iter().flat_map(|z| z.to_le_bytes()));
        file
    };
    let scan = from_bytes(Path::new("a.gsf"), &with("XReal = 4\nYReal = 3\n"), None, Some(1e-6)).unwrap();
    assert_eq!((scan.pitch, scan.heights[[1, 0]]), (Some([2.0 * 1e-6, 3.0 * 1e-6]), 2.0 * 1e-6));
    assert_eq!(defect(&with("ZUnits = V\n")), "gsf: a unit is `V`, expected one of length");
    assert_eq!(defect(&with("XReal = 4\n")), "gsf: no YReal");
    assert_eq!(defect(&with("")[..52]), "gsf: the part of the heights holds 4 bytes, expected 8");
    let huge = String::from_utf8(with("")[..44].to_vec()).unwrap().replace("XRes = 2", "XRes = 4000000000");
    assert_eq!(
        defect(&[huge.as_bytes(), b"\0"].concat()),
        "gsf: 4000000000 heights, at most 268435456 are read"
    );
}

#[test]
fn an_asc_by_gdal_has_its_first_line_at_the_largest_y() {
    // Written by GDAL 3.10.3.
    for (name, pitch) in [("square", [0.5, 0.5]), ("oblong", [0.5, 0.25])] {
        let scan = read(&corpus("asc", name), None, None).unwrap();
        assert_eq!((scan.format, scan.pitch, scan.unit), ("asc", Some(pitch), LengthUnit::MetresThroughout));
        assert_same(&scan.heights, &heights());
    }
    let in_unit = read(&corpus("asc", "square"), None, Some(1e-6)).unwrap();
    assert_eq!((in_unit.pitch, in_unit.heights[[0, 0]]), (Some([0.5e-6; 2]), -0.718 * 1e-6));
}

#[test]
fn the_header_of_an_asc_may_be_in_any_case_and_order() {
    let expected = ndarray::array![[3.0, 1.0], [f64::NAN, 2.0]];
    for file in [
        "NCOLS 2\nNROWS 2\nXLLCENTER 0\nYLLCENTER 0\nCELLSIZE 2\n1 2\n3 -9999\n",
        "nrows 2\r\nncols 2\r\ncellsize 2\r\nnodata_value -1e38\r\n1 2\r\n3 -1e38\r\n",
        "ncols 2\nnrows 2\nNODATA_value nan\ndx 2\ndy 2\n1\n2\n3 nan",
        "ncols 2\nnrows 2\ncellsize 2,0\n1,0 2\n3 -9999,0\n",
    ] {
        let scan = decode(file.as_bytes(), None).unwrap_or_else(|fault| panic!("{file}: {fault:?}"));
        assert_eq!(scan.pitch, Some([2.0; 2]));
        assert_same(&scan.heights, &expected);
    }
    let with = |old: &str, new: &str| {
        defect("ncols 2\nnrows 2\ncellsize 2\n1 2\n3 4\n".replacen(old, new, 1).as_bytes())
    };
    assert_eq!(with("nrows 2\n", ""), "asc: no nrows");
    assert_eq!(with("cellsize 2\n", ""), "asc: no cellsize");
    assert_eq!(with("ncols 2", "ncols -2"), "asc: ncols is `-2`, expected a whole number above 0");
    assert_eq!(with("ncols 2", "ncols two"), "asc: ncols is `two`, expected a number");
    assert_eq!(with("ncols 2", "ncols 9000"), "asc: the part of the heights holds 8 bytes, expected 35999");
    assert_eq!(with("3 4", "3"), "asc: the part of the heights holds 6 bytes, expected 7");
    assert_eq!(with("3 4", "3 4 5"), "asc: the number of heights is `5`, expected ncols · nrows");
    assert_eq!(with("3 4", "3 four"), "asc: line 5: `four` is not a height");
}
