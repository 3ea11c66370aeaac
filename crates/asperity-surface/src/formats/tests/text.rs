//! The order of the lines of a matrix, and words and labels around it.

use super::*;

/// A matrix below words, as instruments export it.
pub(super) const WORDS: &str =
    "Height map\nX Pixels,3\nY Pixels,2\nXY calibration,2,um\nUnit,um\n\n1,2,3\n4,,6\n";

/// 3 × 2 heights, of which one is missing.
fn six() -> Field {
    ndarray::array![[1.0, 4.0], [2.0, f64::NAN], [3.0, 6.0]]
}

fn scan(text: &str, options: &ReadOptions) -> Result<Scan> {
    options.scan_bytes("matrix.txt", text.as_bytes())
}

#[test]
fn by_default_a_line_of_text_lies_along_x_and_one_of_an_array_along_y() {
    let text = "1 2 3\n4 - 6\n";
    let npy: Vec<u8> =
        [1.0, 2.0, 3.0, 4.0, f64::NAN, 6.0].iter().flat_map(|z: &f64| z.to_le_bytes()).collect();
    let npy = files::npy("'<f8'", false, "(2, 3)", &npy);
    for (file, default) in [(text.as_bytes(), Axis::X), (&npy, Axis::Y)] {
        for lines in [None, Some(Axis::X), Some(Axis::Y)] {
            let options = ReadOptions { lines, ..ReadOptions::default() };
            let scan = options.scan_bytes("matrix", file).unwrap();
            let along = lines.unwrap_or(default);
            assert_eq!(scan.lines, Some(along));
            assert!(scan.heights.is_standard_layout());
            assert_same(&scan.heights, &if along == Axis::X { six() } else { six().t().to_owned() });
        }
    }
    // A single column is a profile along x, as a single line is.
    for text in ["1 2 3 5", "1\n2\n3\n5\n"] {
        assert_eq!(scan(text, &ReadOptions::default()).unwrap().heights.dim(), (4, 1));
    }
    assert_eq!(scan("1\n2\n", &ReadOptions::default().with_lines(Axis::X)).unwrap().heights.dim(), (1, 2));
}

#[test]
fn formats_that_leave_nothing_open_take_neither_lines_nor_skip() {
    let csv = "x,y,z\n0,0,1\n1,0,2\n0,1,3\n1,1,4\n";
    let error = scan(csv, &ReadOptions::default().with_lines(Axis::X)).unwrap_err().to_string();
    assert_eq!(
        error,
        "matrix.txt: csv: its format determines the order of the heights, expected none to be given"
    );
    let error = ReadOptions::default().with_skip(2).scan_bytes("a.tif", &tiff::sample()).unwrap_err();
    assert_eq!(error.to_string(), "a.tif: tiff: it is no text, expected no lines to be skipped");
}

#[test]
fn known_words_above_a_matrix_give_unit_and_pitch() {
    let [um, nm] = [1e-6, 1e-9];
    for (text, pitch, unit) in [
        (WORDS, Some([2.0 * um; 2]), um),
        ("Pixel size [um]: 0,5\nz unit: nm\n1;2;3\n4;;6\n", Some([0.5 * um; 2]), nm),
        ("dx = 2 um\ndy = 3 um\nHeight (nm)\n1 2 3\n4 - 6\n", Some([2.0 * um, 3.0 * um]), nm),
        (
            "\"Horizontal\",\"3\"\n\"Vertical\",\"2\"\n\"XY Calibration\",\"500\",\"nm\"\n\"Unit\",\"um\"\n\n\"Height\"\n\"1\",\"2\",\"3\"\n\"4\",\"\",\"6\"\n",
            Some([500.0 * nm; 2]),
            um,
        ),
        ("nx,3\nny,2\nz unit,nm\nc1,c2,c3\n1,2,3\n4,,6\n", None, nm),
        ("Scan of a disc,,\nUnit,nm,\n,,\n1,2,3\n4,,6\n", None, nm),
    ] {
        for text in [text.to_owned(), text.replace('\n', "\r\n"), format!("\u{feff}{text}")] {
            let scan = decode(text.as_bytes(), None).unwrap_or_else(|fault| panic!("{text}: {fault:?}"));
            assert_eq!((scan.format, scan.pitch, scan.unit), ("text", pitch, LengthUnit::Known), "{text}");
            assert_same(&scan.heights, &(six() * unit));
        }
    }
    // A first line of missing heights.
    let missing = ndarray::array![[f64::NAN, 1.0], [f64::NAN, 2.0], [f64::NAN, 3.0]];
    for text in [";;\n1;2;3\n", "Unit: m\n;;\n1;2;3\n"] {
        assert_same(&decode(text.as_bytes(), None).unwrap().heights, &missing);
    }
    // The first words are no names of columns.
    let sizes = "X Pixels,3\nY Pixels,2\nUnit,um\n1,2,3\n4,,6\n";
    assert_same(&decode(sizes.as_bytes(), None).unwrap().heights, &(six() * um));
    // Words without a unit, and with one for lengths along the surface alone.
    let bare = scan("Pitch,2\n1,2,3\n4,,6\n", &ReadOptions::default().with_unit(um)).unwrap();
    assert_eq!((bare.pitch, bare.heights[[2, 1]]), (Some([2.0 * um; 2]), 6.0 * um));
    let lateral = scan("Pitch,2,um\n1,2,3\n4,,6\n", &ReadOptions::default().with_unit(nm)).unwrap();
    assert_eq!((lateral.pitch, lateral.heights[[2, 1]]), (Some([2.0 * um; 2]), 6.0 * nm));
    // The size of a matrix whose lines lie along y.
    let turned = decode(b"Columns,2\nRows,3\n1,2,3\n4,,6\n", None).unwrap();
    assert_eq!((turned.heights.dim(), turned.lines), ((2, 3), Some(Axis::Y)));
    assert_eq!(
        defect(WORDS.replace("Pixels,3", "Pixels,4").as_bytes()),
        "text: the matrix is `3 × 2`, expected of the size in the words above it"
    );
    assert_eq!(
        defect(WORDS.replace("Unit,um", "Unit,V").as_bytes()),
        "text: a unit is `V`, expected one of length"
    );
}

#[test]
fn lines_above_a_matrix_that_are_not_plain_are_named_with_the_lines_to_skip() {
    let sizes = "a disc\n3 2\n1 2 3\n4 - 6\n5 6 7\n";
    let error = scan(sizes, &ReadOptions::default()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "matrix.txt: text: line 2: `3 2` is no height; the matrix begins at line 3"
    );
    assert_eq!(error.hint().unwrap(), "skip the 2 lines above the matrix");
    let skipped = scan(sizes, &ReadOptions::default().with_skip(2)).unwrap();
    assert_eq!((skipped.heights.dim(), skipped.heights[[0, 0]]), ((3, 3), 1.0));
    for skip in [6, usize::MAX] {
        let error = scan(sizes, &ReadOptions::default().with_skip(skip)).unwrap_err().to_string();
        assert_eq!(error, "matrix.txt: text: no values");
    }
    for (text, line, token, first) in [
        ("3 2\n1 2 3 4\n4 - 6 7\n", 1, "3 2", 2),
        ("5\n1 2 3 4\n4 - 6 7\n", 1, "5", 2),
        ("a;b;c\n1;2;3\n4;;6\n", 1, "a;b;c", 2),
        ("words\nlabel;5;3\n1;2;3\n4;;6\n", 2, "label;5;3", 3),
        ("0 1 2 3 4 5 6 7\n1 5 2 7 3 9 2 4\n2 5 1 3 8 4 2 6\n", 1, "0 1 2 3 4 5 6 7", 2),
    ] {
        let expected =
            format!("text: line {line}: `{token}` is no height; the matrix begins at line {first}");
        assert_eq!(defect(text.as_bytes()), expected);
    }
    // Words below a matrix, and words without one.
    assert_eq!(defect(b"a disc\n1 2 3\n4 - 6\nthe end\n"), "text: line 4: `the` is not a height");
    assert_eq!(defect(b"a disc\nand no heights\n"), "text: line 1: `a` is not a height");
    assert_eq!(defect(b"1 2 3\n4 5 6 7\n8 9 1\n"), "text: line 2 has 4 values, the lines before it have 3");
}

#[test]
fn labels_are_never_heights() {
    let rows = ndarray::array![[5.0, 1.0, 7.0], [2.0, 8.0, 3.0], [4.0, 9.0, 6.0]];
    let expected = rows.t().to_owned();
    let counted = ",0,1,2\n0,5,1,7\n1,2,8,3\n2,4,9,6\n";
    for (text, pitch) in [
        // As pandas writes a frame: numbers of lines and columns.
        (counted, None),
        ("row 1;5;1;7\nrow 2;2;8;3\nrow 3;4;9;6\n", None),
        ("Line 1 5 1 7\nLine 2 2 8 3\nLine 3 4 9 6\n", None),
        ("label;0;1;2\na;5;1;7\nb;2;8;3\nc;4;9;6\n", None),
        ("y/x;0;0,5;1\n0;5;1;7\n2;2;8;3\n4;4;9;6\n", Some([0.5, 2.0])),
        ("\t0\t0.5\t1\n0\t5\t1\t7\n2\t2\t8\t3\n4\t4\t9\t6\n", Some([0.5, 2.0])),
        // The largest y first, the largest x first.
        (",1,0.5,0\n4,6,9,4\n2,3,8,2\n0,7,1,5\n", Some([0.5, 2.0])),
    ] {
        let scan = decode(text.as_bytes(), None).unwrap_or_else(|fault| panic!("{text}: {fault:?}"));
        assert_eq!((scan.format, scan.pitch), ("text", pitch), "{text}");
        assert_same(&scan.heights, &expected);
    }
    let in_unit =
        scan("y/x,0,2,4\n0,5,1,7\n2,2,8,3\n4,4,9,6\n", &ReadOptions::default().with_unit(1e-6)).unwrap();
    assert_eq!((in_unit.pitch, in_unit.heights[[2, 2]]), (Some([2.0 * 1e-6; 2]), 6.0 * 1e-6));
    // Positions along both sides of a matrix without a word.
    let mut sides = String::from("4 0 2 4 6\n");
    for iy in 0..4 {
        sides += &format!("{} {} {} {} {}\n", iy, 3 * iy % 5, 7 * iy % 4, iy * iy % 7, 11 * (iy + 1) % 6);
    }
    let sides = decode(sides.as_bytes(), None).unwrap();
    assert_eq!((sides.heights.dim(), sides.pitch), ((4, 4), Some([2.0, 1.0])));
    // Labels on one side alone may be heights.
    let beside: String = (0..9)
        .map(|iy| {
            let noise: Vec<_> = (1..9).map(|ix| (ix * iy * iy % 7).to_string()).collect();
            format!("{} {}\n", 10 * iy, noise.join(" "))
        })
        .collect();
    assert!(
        defect(beside.as_bytes()).starts_with("text: the first of 9 columns, 0, 10 …, looks like labels")
    );
    assert_eq!(scan(&beside, &ReadOptions::default().with_lines(Axis::X)).unwrap().heights.dim(), (9, 9));
}

#[test]
fn a_matrix_below_words_may_be_in_utf16_or_latin_1() {
    let units = std::iter::once(0xfeff).chain(WORDS.replace("um", "µm").encode_utf16().collect::<Vec<_>>());
    let bytes: Vec<u8> = units.flat_map(u16::to_le_bytes).collect();
    assert_same(&decode(&bytes, None).unwrap().heights, &(six() * 1e-6));
    let latin: Vec<u8> = WORDS.replace("um", "µm").chars().map(|c| c as u8).collect();
    assert_same(&decode(&latin, None).unwrap().heights, &(six() * 1e-6));
}
