use super::*;

pub(super) const SAMPLE: &str =
    "X [um],Y (um),height [nm],other\n0,0,1,10\n2,0,2,20\n0,0.5,3,30\n2,0.5,,40\n";

#[test]
fn columns_of_a_csv_are_channels_with_units() {
    let first = decode(SAMPLE.as_bytes(), None).unwrap();
    assert_eq!((first.format, first.channel.as_str()), ("csv", "height"));
    assert_eq!(first.channels, ["height", "other"]);
    assert_eq!(first.pitch, Some([2.0 * 1e-6, 0.5 * 1e-6]));
    assert_same(&first.heights, &(ndarray::array![[1.0, 3.0], [2.0, f64::NAN]] * 1e-9));
    let other = decode(SAMPLE.as_bytes(), Some("other")).unwrap();
    assert_same(&other.heights, &ndarray::array![[10.0, 30.0], [20.0, 40.0]]);
    let spaces = decode(b"x y z\r\n0 0 1\r\n0 1 2\r\n1 0 3\r\n1 1 4\r\n", None).unwrap();
    assert_eq!((spaces.format, spaces.pitch), ("csv", Some([1.0; 2])));
}

#[test]
fn a_csv_that_is_no_grid_is_an_error() {
    let with = |old: &str, new: &str| defect(SAMPLE.replacen(old, new, 1).as_bytes());
    let message = "csv: 4 lines of 4 numbers look like points x, y and height on no grid, expected a regular grid of at \
                   least 2 × 2 points, most of them there, each once";
    assert_eq!(with("2,0,2,20", "3,0,2,20"), message);
    assert_eq!(with("2,0,2,20", "2,0,two,20"), "csv: line 3: `two` is not a height");
    assert_eq!(with("[nm]", "[V]"), "csv: a unit is `V`, expected one of length");
    assert_eq!(with(",other", ""), "csv: line 2 has 4 values, the lines before it have 3");
    assert_eq!(
        with("X [um]", "a"),
        "text: line 1: `a,Y (um),height [nm],other` is no height; the matrix begins at line 2"
    );
}

#[test]
fn a_unit_serves_where_the_numbers_have_none_and_only_there() {
    let read = |text: &str, unit| from_bytes(Path::new("table.csv"), text.as_bytes(), None, unit);
    let table = |heading: &str| format!("{heading}\n0,0,1\n2,0,2\n0,3,3\n2,3,4\n");
    let bare = read(&table("x,y,z"), Some(1e-6)).unwrap();
    assert_eq!((bare.pitch, bare.heights[[1, 1]], bare.unit), (Some([2e-6, 3e-6]), 4e-6, LengthUnit::Known));
    let lateral = read(&table("x (mm),y (mm),z"), Some(1e-6)).unwrap();
    assert_eq!((lateral.pitch, lateral.heights[[1, 1]]), (Some([2e-3, 3e-3]), 4e-6));
    let own = read(&table("x (mm),y (mm),z (nm)"), Some(1e-6)).unwrap_err().to_string();
    assert_eq!(own, "table.csv: csv: its heights have a unit of their own, expected none to be given");
    // The unit of a matrix applies to its heights alone, that of a table of points to all columns.
    let matrix = read("1 2 3\n4 5 6\n", Some(1e-6)).unwrap();
    assert_eq!((matrix.pitch, matrix.heights[[2, 1]], matrix.format), (None, 6e-6, "text"));
    let points = read("0 0 1\n2 0 2\n0 3 3\n2 3 4\n", Some(1e-3)).unwrap();
    assert_eq!((points.pitch, points.heights[[0, 1]], points.format), (Some([2e-3, 3e-3]), 3e-3, "xyz"));
}
