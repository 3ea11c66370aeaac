use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};

use approx::assert_relative_eq;
use arbtest::arbtest;

use super::*;
use crate::Topography;
use asperity_base::grid::Grid;

mod arrays;
mod bombs;
mod containers;
mod csv;
mod files;
mod grids;
mod gwy;
mod headed;
mod instruments;
mod measured_files;
mod missing;
mod points;
mod probes;
mod sdf;
mod text;
mod tiff;

/// Calls [`ReadOptions::scan`].
fn read(path: &Path, channel: Option<&str>, unit: Option<f64>) -> Result<Scan> {
    options(channel, unit).scan(path)
}

/// Calls [`ReadOptions::scan_bytes`].
fn from_bytes(name: &Path, bytes: &[u8], channel: Option<&str>, unit: Option<f64>) -> Result<Scan> {
    options(channel, unit).scan_bytes(name, bytes)
}

fn options(channel: Option<&str>, unit: Option<f64>) -> ReadOptions {
    ReadOptions { channel: channel.map(str::to_owned), unit, ..ReadOptions::default() }
}

fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    super::decode(bytes, &options(channel, None))
}

#[test]
fn what_is_not_read_is_named_with_the_export_that_is_read() {
    let private = |tags: &[(u16, &str)]| {
        let mut file = Cursor::new(Vec::new());
        let mut encoder = ::tiff::encoder::TiffEncoder::new(&mut file).unwrap();
        let mut image = encoder.new_image::<::tiff::encoder::colortype::Gray16>(2, 2).unwrap();
        for (tag, text) in tags {
            image.encoder().write_tag(::tiff::tags::Tag::from_u16_exhaustive(*tag), *text).unwrap();
        }
        image.write_data(&[1, 2, 3, 4]).unwrap();
        file.into_inner()
    };
    let compound = |stream: &str| {
        let mut file = cfb::CompoundFile::create(Cursor::new(Vec::new())).unwrap();
        file.create_stream(stream).unwrap();
        file.into_inner().into_inner()
    };
    let stl = [&[0; 80][..], &2u32.to_le_bytes(), &[0; 100]].concat();
    let mut tar = vec![b'a'; 512];
    tar[257..262].copy_from_slice(b"ustar");
    let iges = [&[b' '; 72][..], b"S      1\n"].concat();
    for (bytes, reason, export) in [
        (private(&[(0x8000, "1.0")]), "JPK (Bruker)", "save it as gwy, or as text"),
        (private(&[(50_432, "1")]), "Park Systems", "save it as gwy"),
        (private(&[(270, "<?xml?><TiffTagDescData/>")]), "Olympus LEXT", "save it as gwy"),
        (
            zipped(&[("f1724dc6-686c-4502-9227-2a594bc8ed33", b"")]),
            "Keyence profilometer (zag, zon)",
            "as CSV",
        ),
        (b"KPK0 and more".to_vec(), "Keyence profilometer (zag, zon)", "as CSV"),
        (b"OLYMPUSRAWFORMAT\0".to_vec(), "Olympus microscope (oir, poir)", "save it as gwy"),
        (zipped(&[("a.oir", b"")]), "Olympus microscope (oir, poir)", "save it as gwy"),
        (zipped(&[("index.xml", b""), ("recipe.txt", b"")]), "Sensofar (plux)", "as plu, sur or x3p"),
        (zipped(&[("xl/workbook.xml", b"")]), "workbook of Excel (xlsx)", "as CSV"),
        (zipped(&[("mimetype", b""), ("content.xml", b"")]), "LibreOffice (ods, odt)", "as CSV"),
        (zipped(&[("word/document.xml", b"")]), "document of Office", "x3p, sdf"),
        (zipped(&[("header.properties", b"")]), "force curves of JPK", "as text"),
        (zipped(&[("3D/3dmodel.model", b"")]), "mesh (3MF)", "regular grid"),
        (zipped(&[("a.txt", b"1 2"), ("b.txt", b"")]), "zip archive of other files", "unpack it"),
        (compound("/Workbook"), "workbook of Excel (xls)", "as CSV"),
        (compound("/Other"), "compound file, but no document of Mountains", "x3p, sdf"),
        (b"\x89PNG\r\n".to_vec(), "it is a picture (PNG)", "export the heights themselves"),
        (b"%PDF-1.7\n1 2 3\n".to_vec(), "document (PDF)", "export the heights themselves"),
        (b"solid a\n facet normal 0 0 1\n".to_vec(), "mesh (STL)", "regular grid"),
        (stl, "mesh (STL)", "regular grid"),
        (b"ply\nformat ascii 1.0\n".to_vec(), "mesh (PLY)", "regular grid"),
        (b"# a\nmtllib a.mtl\no b\nv 1 2 3\nv 1 2 3\n".to_vec(), "mesh (OBJ)", "regular grid"),
        (iges, "solid model (IGES)", "regular grid"),
        (tar, "archive (tar)", "unpack it"),
    ] {
        let error = from_bytes(Path::new("a"), &bytes, None, Some(1e-9)).unwrap_err();
        let (message, hint) = (error.to_string(), error.hint().unwrap());
        assert!(message.starts_with("a is not a topography: it "), "{message}");
        assert!(message.contains(reason) && hint.contains(export), "{message}; {hint}");
    }
}

#[test]
fn files_that_are_no_files_are_errors() {
    let directory = tempfile::tempdir().unwrap();
    let message = read(directory.path(), None, None).unwrap_err().to_string();
    assert!(message.ends_with(": is a directory, expected a topography file"), "{message}");
    let missing = directory.path().join("no.x3p");
    assert!(matches!(read(&missing, None, None), Err(Error::File { path, .. }) if path == missing));
    if cfg!(unix) {
        let message = read(Path::new("/dev/zero"), None, None).unwrap_err().to_string();
        assert_eq!(message, "/dev/zero: is a device, expected a topography file");
    }
}

fn example() -> (Grid, Field) {
    let grid = Grid::new([5, 3], [1.0 / 3.0 * 1e-6, 2e-6]).unwrap();
    let mut heights = Field::from_shape_fn(grid.shape, |(ix, iy)| (ix as f64 - 2.5 * iy as f64) / 7.0 * 1e-6);
    heights[[4, 1]] = f64::NAN;
    (grid, heights)
}

/// Equal to the last bit, NaN where NaN.
#[track_caller]
fn assert_same(found: &Field, expected: &Field) {
    assert_eq!(found.dim(), expected.dim());
    for (found, expected) in found.iter().zip(expected) {
        assert!(found == expected || (found.is_nan() && expected.is_nan()), "{found:e} is not {expected:e}");
    }
}

#[test]
fn heights_with_x_fastest_are_turned_whatever_their_shape() {
    for shape in [[1, 1], [1, 100], [100, 1], [32, 64], [70, 45]] {
        let turned = x_fastest(shape, |first, part| {
            part.iter_mut().enumerate().for_each(|(index, height)| *height = (first + index) as f64);
        });
        assert_same(&turned, &Field::from_shape_fn(shape, |(ix, iy)| (ix + shape[0] * iy) as f64));
    }
}

// ---- x3p -------------------------------------------------------------------------------------------------

#[test]
fn an_x3p_written_reads_back_to_the_last_bit() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("a");
    let (grid, heights) = example();
    x3p::write(&path, &grid, &heights).unwrap();
    let scan = read(&path, None, None).unwrap();
    assert_eq!((scan.format, scan.channel.as_str(), scan.pitch), ("x3p", "height", Some(grid.pitch)));
    assert_same(&scan.heights, &heights);
    let error = read(&path, Some("phase"), None).unwrap_err();
    assert_eq!(error.to_string(), format!("no height channel `phase` in {}", path.display()));
    assert_eq!(error.hint().unwrap(), "it holds `height`; choose one of them");
}

/// An x3p of 5 × 2 heights; the mask 0x95, 0xfd removes the second, fourth, sixth, seventh and tenth.
fn x3p_with(kind: &str, data: &[u8], mask: Option<&[u8]>, record3: &str) -> Vec<u8> {
    let mask_link = mask.map_or("", |_| "<ValidPointsLink>bindata/valid.bin</ValidPointsLink>");
    let data_link =
        format!("<DataLink><PointDataLink>/bindata/data.bin</PointDataLink>{mask_link}</DataLink>");
    let record3 = if record3.is_empty() { &data_link } else { record3 };
    let main = format!(
        "<p:ISO5436_2 xmlns:p='http://www.opengps.eu/2008/ISO5436_2'><Record1><FeatureType>SUR</FeatureType><Axes>\
         <CX><AxisType>I</AxisType><Increment>0.25</Increment><Offset>1</Offset></CX>\
         <CY><AxisType>I</AxisType><Increment>0.5</Increment><Offset>2</Offset></CY>\
         <CZ><AxisType>A</AxisType><DataType>{kind}</DataType><Increment>0.5</Increment><Offset>100</Offset></CZ>\
         </Axes></Record1><Record3><MatrixDimension><SizeX>5</SizeX><SizeY>2</SizeY><SizeZ>1</SizeZ></MatrixDimension>\
         {record3}</Record3></p:ISO5436_2>"
    );
    zipped(&[
        ("main.xml", main.as_bytes()),
        ("bindata/data.bin", data),
        ("bindata/valid.bin", mask.unwrap_or_default()),
    ])
}

fn zipped(entries: &[(&str, &[u8])]) -> Vec<u8> {
    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (name, content) in entries {
        archive.start_file(*name, zip::write::SimpleFileOptions::default()).unwrap();
        archive.write_all(content).unwrap();
    }
    archive.finish().unwrap().into_inner()
}

#[test]
fn integers_of_an_x3p_count_increments_and_the_mask_takes_heights_away() {
    let numbers: Vec<i16> = (-10..0).collect();
    let int16: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
    let int32: Vec<u8> = numbers.iter().flat_map(|n| i32::from(*n).to_le_bytes()).collect();
    let float32: Vec<u8> = numbers.iter().flat_map(|n| f32::from(*n).to_le_bytes()).collect();
    let float64: Vec<u8> = numbers.iter().flat_map(|n| f64::from(*n).to_le_bytes()).collect();
    let bytes = [1, 0, 1, 0, 1, 0, 0, 1, 1, 0];
    for (kind, data, increment) in
        [("I", &int16, 0.5), ("L", &int32, 0.5), ("F", &float32, 1.0), ("D", &float64, 1.0)]
    {
        for (mask, holes) in [(None, 0), (Some(&[0x95, 0xfd][..]), 5), (Some(&bytes[..]), 5)] {
            let scan = decode(&x3p_with(kind, data, mask, ""), None).unwrap();
            assert_eq!(scan.pitch, Some([0.25, 0.5]));
            let hole = |point: usize| holes > 0 && bytes[point] == 0;
            let expected = Field::from_shape_fn([5, 2], |(ix, iy)| {
                let point = ix + 5 * iy;
                if hole(point) { f64::NAN } else { 100.0 + increment * f64::from(numbers[point]) }
            });
            assert_same(&scan.heights, &expected);
        }
    }
}

#[test]
fn heights_may_stand_in_the_xml_of_an_x3p() {
    let list = "<DataList><Datum>1</Datum><Datum>0.25;0;2</Datum><Datum/><Datum>4</Datum><Datum>5</Datum>\
                <Datum>6</Datum><Datum>7</Datum><Datum>8</Datum><Datum>9</Datum><Datum>1e1</Datum></DataList>";
    let scan = decode(&x3p_with("D", b"", None, list), None).unwrap();
    assert_eq!((scan.heights[[1, 0]], scan.heights[[4, 1]]), (102.0, 110.0));
    assert!(scan.heights[[2, 0]].is_nan());
    let short = list.replace("<Datum/>", "");
    assert_eq!(
        defect(&x3p_with("D", b"", None, &short)),
        "x3p: the number of Datum is `9`, expected SizeX · SizeY · SizeZ"
    );
}

#[test]
fn an_x3p_that_changed_since_it_was_written_is_an_error() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("a.x3p");
    let (grid, heights) = example();
    x3p::write(&path, &grid, &heights).unwrap();
    let mut archive = zip::ZipArchive::new(std::fs::File::open(&path).unwrap()).unwrap();
    let mut entry = |name: &str| {
        let mut content = Vec::new();
        archive.by_name(name).unwrap().read_to_end(&mut content).unwrap();
        content
    };
    let (main, data, checksum) = (entry("main.xml"), entry("bindata/data.bin"), entry("md5checksum.hex"));
    let archive = |main: &[u8], data: &[u8]| {
        zipped(&[("main.xml", main), ("bindata/data.bin", data), ("md5checksum.hex", &checksum)])
    };
    assert!(decode(&archive(&main, &data), None).is_ok());

    let mut changed = data.clone();
    changed[17] ^= 1;
    let message = defect(&archive(&main, &changed));
    assert!(message.starts_with("x3p: the point data has the MD5 checksum "), "{message}");
    let other = String::from_utf8(main.clone()).unwrap().replace("<SizeX>5", "<SizeX>4");
    let message = defect(&archive(other.as_bytes(), &data));
    assert!(message.starts_with("x3p: main.xml has the MD5 checksum "), "{message}");
    let message = defect(&archive(&main, &data[..112]));
    assert!(message.starts_with("x3p: the point data has the MD5 checksum "), "{message}");
}

#[test]
fn an_x3p_holds_as_many_bytes_as_its_header_says() {
    assert_eq!(defect(&x3p_with("D", &[0; 79], None, "")), "x3p: the point data holds 79 bytes, expected 80");
    assert_eq!(
        defect(&x3p_with("D", &vec![0; 1 << 24], None, "")),
        "x3p: the point data holds 81 bytes, expected 80"
    );
    assert_eq!(
        defect(&x3p_with("D", &[0; 80], Some(&[0; 3]), "")),
        "x3p: the mask of valid points holds 3 bytes, expected 2"
    );
    assert_eq!(
        defect(&x3p_with("Q", &[0; 80], None, "")),
        "x3p: DataType of CZ is `Q`, expected I, L, F or D"
    );
    assert_eq!(defect(&x3p_with("D", &[], None, "<DataLink/>")), "x3p: no PointDataLink in DataLink");
    assert_eq!(defect(b"PK\x03\x04 and nothing else").split(':').next(), Some("x3p"));
    let other = zipped(&[("document.xml", b"<a/>")]);
    assert!(matches!(
        decode(&other, None),
        Err(Fault::NotATopography(Foreign { export: "unpack it, and give one of its files", .. }))
    ));
}

#[test]
fn xml_nested_beyond_measure_is_answered() {
    let deep = "<a>".repeat(200_000);
    let _ = decode(&zipped(&[("main.xml", deep.as_bytes())]), None).unwrap_err();
    let closed = deep + &"</a>".repeat(200_000);
    let _ = decode(&zipped(&[("main.xml", closed.as_bytes())]), None).unwrap_err();
}

/// Returns the defect of a file with this content, with its format.
#[track_caller]
fn defect(bytes: &[u8]) -> String {
    match decode(bytes, None) {
        Err(Fault::Corrupt { format, reason }) => format!("{format}: {reason}"),
        other => panic!("expected a defect, found {other:?}"),
    }
}

// ---- npy -------------------------------------------------------------------------------------------------

#[test]
fn an_npy_written_reads_back_to_the_last_bit() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("z.npy");
    let (_, heights) = example();
    npy::write(&path, &heights).unwrap();
    let scan = read(&path, Some("height"), None).unwrap();
    assert_eq!((scan.format, scan.pitch), ("npy", None));
    assert_same(&scan.heights, &heights);
    // Indexed [ix, iy] in C order for any memory order.
    npy::write(&path, &heights.t().as_standard_layout().into_owned().reversed_axes()).unwrap();
    assert_same(&read(&path, None, None).unwrap().heights, &heights);
    assert!(std::fs::read(&path).unwrap().starts_with(b"\x93NUMPY\x01\0"));
}

#[test]
fn an_npy_may_hold_any_real_numbers_in_either_order() {
    let data: Vec<u8> = (1..=6u8).collect();
    let c = decode(&files::npy("'|u1'", false, "(2, 3)", &data), None).unwrap().heights;
    assert_eq!(c, ndarray::array![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    let fortran = decode(&files::npy("'|i1'", true, "(2, 3)", &data), None).unwrap().heights;
    assert_eq!(fortran, ndarray::array![[1.0, 3.0, 5.0], [2.0, 4.0, 6.0]]);
    assert!(fortran.is_standard_layout());
    let big: Vec<u8> = [1.5f32, -2.5].iter().flat_map(|h| h.to_be_bytes()).collect();
    assert_eq!(
        decode(&files::npy("'>f4'", false, "(1, 2)", &big), None).unwrap().heights,
        ndarray::array![[1.5, -2.5]]
    );
    let long: Vec<u8> = [-7i64, 1 << 40].iter().flat_map(|h| h.to_le_bytes()).collect();
    let long = decode(&files::npy("'<i8'", false, "(2, 1)", &long), None).unwrap().heights;
    assert_eq!(long, ndarray::array![[-7.0], [1_099_511_627_776.0]]);
}

#[test]
fn an_npy_that_is_no_matrix_of_numbers_is_an_error() {
    for (descr, shape, message) in [
        ("'<f8'", "(3,)", "the array is `1-dimensional`, expected 2-dimensional"),
        ("'<f8'", "(3, 0)", "the array is `3 × 0`, expected not empty"),
        ("'<f8'", "(3, 2)", "the array holds 40 bytes, expected 48"),
        ("'<f8'", "(1, 4)", "the array holds 40 bytes, expected 32"),
        ("'<c8'", "(5, 1)", "the array's type is `'<c8'`, expected real numbers"),
        ("'<f8'", "(1000000000, 1000000000)", "1000000000000000000 heights, at most 268435456 are read"),
        (
            "'<f8'",
            "(99999999999, 99999999999, 3)",
            "29999999999400000000003 heights, at most 268435456 are read",
        ),
    ] {
        assert_eq!(defect(&files::npy(descr, false, shape, &[0; 40])), format!("npy: {message}"));
    }
    assert_eq!(defect(b"\x93NUMPY\x01\0\xff\xff{"), "npy: the header holds 11 bytes, expected 65545");
    let nested = format!("({})", "(".repeat(10_000));
    assert!(defect(&files::npy("'<f8'", false, &nested, &[])).starts_with("npy: the header is "));
}

// ---- sur -------------------------------------------------------------------------------------------------

/// A surface of 3 × 2 heights, in µm, with the last one missing.
fn sur_of(bits: u16, name: &str, objects: u16) -> Vec<u8> {
    let raw = [-5i32, 0, 1, 2, 3, -7].map(|raw| raw.to_le_bytes()[..usize::from(bits / 8)].to_vec());
    files::sur(bits, name, objects, [3, 2], &raw.concat())
}

#[test]
fn a_sur_has_units_an_offset_and_missing_heights() {
    for bits in [16, 32] {
        let scan = decode(&sur_of(bits, "", 1), None).unwrap();
        assert_eq!(
            (scan.format, scan.channel.as_str(), scan.pitch),
            ("sur", "height", Some([0.5e-3, 0.25e-3]))
        );
        let expected = ndarray::array![[-9.5, 4.5], [0.5, 6.5], [2.5, f64::NAN]] * 1e-6;
        for (found, expected) in scan.heights.iter().zip(&expected) {
            assert!(
                found.is_nan() && expected.is_nan() || (found - expected).abs() < 1e-20,
                "{}",
                scan.heights
            );
        }
    }
}

#[test]
fn objects_of_a_sur_are_channels() {
    let mut file = sur_of(16, "Height", 3);
    file.extend(sur_of(32, "Phase", 3));
    file.extend(sur_of(32, "Phase", 3));
    let scan = decode(&file, Some("Phase")).unwrap();
    assert_eq!(
        (scan.channels.as_slice(), scan.channel.as_str()),
        (&["Height", "Phase", "Phase 3"].map(String::from)[..], "Phase")
    );
    let Err(Fault::NoChannel { available }) = decode(&file, Some("height")) else {
        panic!("expected no channel")
    };
    assert_eq!(available, ["Height", "Phase", "Phase 3"]);
}

#[test]
fn a_compressed_sur_is_read_as_a_plain_one() {
    let plain = sur_of(16, "", 1);
    let mut file = files::sur_compressed(&plain);
    assert_same(&decode(&file, None).unwrap().heights, &decode(&plain, None).unwrap().heights);
    file[515..519].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(defect(&file).starts_with("sur: the directory holds "));
}

#[test]
fn a_damaged_sur_is_an_error() {
    let with = |at: usize, bytes: &[u8]| {
        let mut file = sur_of(16, "", 1);
        file[at..at + bytes.len()].copy_from_slice(bytes);
        defect(&file)
    };
    assert_eq!(defect(&sur_of(16, "", 1)[..400]), "sur: the header holds 400 bytes, expected 512");
    assert_eq!(defect(&sur_of(16, "", 1)[..520]), "sur: the heights holds 5 bytes, expected 12");
    assert_eq!(with(98, &[8, 0]), "sur: the number of bits per height is `8`, expected 16 or 32");
    assert_eq!(with(18, &[12, 0]), "sur: the kind of object is `RGB image`, expected a surface or a profile");
    assert_eq!(with(108, &(-3i32).to_le_bytes()), "sur: the size along x is `-3`, expected at least 1");
    assert_eq!(with(111, &[0x7f]), "sur: 4261412870 heights, at most 268435456 are read");
    assert_eq!(with(212, b"V "), "sur: a unit is `V`, expected one of length");
}

// ---- text ------------------------------------------------------------------------------------------------

#[test]
fn a_matrix_is_read_whatever_separates_it() {
    let expected = ndarray::array![[1.5, 4.0], [-2e-6, f64::NAN], [3.0, 6.25]];
    for text in [
        "1.5 -2e-6 3\n4 nan 6.25\n",
        "  1.5\t-2e-6   3 \r\n  4 NaN 6.25",
        "1.5\t-2e-6\t3\n4\t\t6.25\n",
        "1.5\t-2e-6\t3\t\r\n4\t\t6.25\t\r\n",
        "1.5,-2e-6,3\n4,,6.25\n",
        "1.5, -2e-6, 3,\n4, ***, 6.25,\n",
        "1,5;-2e-6;3\n4;-;6,25\n",
        "1.5 ; -2e-6 ; 3\n\n4 ; bad ; 6.25\n\n",
        "# heights in m\n% by hand\n1,5 -2e-6 3,0\n4 -- 6,25\n",
        "\u{feff}1.5 -2e-6 3\n4 N/A 6.25\n",
    ] {
        let scan = decode(text.as_bytes(), None).unwrap_or_else(|fault| panic!("{text:?}: {fault:?}"));
        assert_eq!((scan.format, scan.channel.as_str(), scan.pitch), ("text", "height", None));
        assert_eq!(scan.lines, Some(Axis::X));
        assert_same(&scan.heights, &expected);
    }
    // µ in Latin-1 in a comment.
    assert_same(&decode(b"# in \xb5m\n1\n", None).unwrap().heights, &ndarray::array![[1.0]]);
    assert_same(
        &decode(b"1;2;\n3;4;5\n", None).unwrap().heights,
        &ndarray::array![[1.0, 3.0], [2.0, 4.0], [f64::NAN, 5.0]],
    );
}

#[test]
fn a_gzipped_matrix_is_read_as_a_plain_one() {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    encoder.write_all(b"1 2\n3 4\n").unwrap();
    let packed = encoder.finish().unwrap();
    assert_same(&decode(&packed, None).unwrap().heights, &ndarray::array![[1.0, 3.0], [2.0, 4.0]]);
    assert!(defect(&packed[..packed.len() - 6]).starts_with("gzip: "));
}

#[test]
fn a_table_of_points_is_a_grid_in_any_order() {
    let scan = decode(b"0.333 5 1\n0.000 5 2\n0.667 5 3\n0.667 4 4\n0.333 4 5\n0.000 4 nan\n", None).unwrap();
    assert_eq!(scan.format, "xyz");
    assert_same(&scan.heights, &ndarray::array![[f64::NAN, 2.0], [5.0, 1.0], [4.0, 3.0]]);
    assert_relative_eq!(scan.pitch.unwrap()[0], 0.3335, max_relative = 1e-12);
    assert_eq!(scan.pitch.unwrap()[1], 1.0);
    // A repeated or missing point: a matrix of three columns.
    assert_eq!(decode(b"0 0 1\n0 1 2\n1 0 3\n1 0 4\n", None).unwrap().heights.dim(), (3, 4));
}

#[test]
fn a_text_that_is_no_matrix_is_an_error_with_its_line() {
    assert_eq!(defect(b"# a\n1 2\n3 4\n5 6 7\n"), "text: line 4 has 3 values, the lines before it have 2");
    assert_eq!(defect(b"1 2\n\n3 four\n"), "text: line 3: `four` is not a height");
    assert_eq!(defect(b"1 inf\n"), "text: line 1: `inf` is not a height");
    assert_eq!(defect(b"1,234.5;1\n"), "text: line 1: `1,234.5` is not a height");
    assert_eq!(defect(b"# nothing\n"), "text: no values");
    assert!(matches!(decode(b"", None), Err(Fault::NotATopography(Foreign { reason: "it is empty", .. }))));
}

// ---- vtk -------------------------------------------------------------------------------------------------

#[test]
fn a_vtk_has_its_heights_big_endian_with_x_fastest() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("z.vtk");
    let grid = Grid::new([3, 2], [1e-6, 2e-6]).unwrap();
    let heights = Field::from_shape_fn(grid.shape, |(ix, iy)| ix as f64 + 10.0 * iy as f64);
    Topography::new(grid, heights).unwrap().write(&path).unwrap();
    let file = std::fs::read(&path).unwrap();
    let header = "# vtk DataFile Version 3.0\nasperity, SI units\nBINARY\nDATASET STRUCTURED_POINTS\n\
                  DIMENSIONS 3 2 1\nORIGIN 5e-7 1e-6 0\nSPACING 1e-6 2e-6 1\nPOINT_DATA 6\n\
                  SCALARS height double 1\nLOOKUP_TABLE default\n";
    assert_eq!(std::str::from_utf8(&file[..header.len()]).unwrap(), header);
    let values: Vec<u8> = [0.0f64, 1.0, 2.0, 10.0, 11.0, 12.0].iter().flat_map(|h| h.to_be_bytes()).collect();
    assert_eq!(&file[header.len()..file.len() - 1], values);
}

#[test]
fn a_topography_is_written_and_read_by_the_end_of_its_name() {
    let directory = tempfile::tempdir().unwrap();
    let grid = Grid::new([5, 3], [1e-6, 2e-6]).unwrap();
    let heights = Field::from_shape_fn(grid.shape, |(ix, iy)| 1e-9 * (ix * ix + 7 * iy) as f64);
    let topography = Topography::new(grid, heights).unwrap();
    for name in ["a.npy", "a.x3p", "a.SDF", "a.gwy"] {
        let path = directory.path().join(name);
        topography.write(&path).unwrap();
        let read = if Format::from_path(&path).unwrap().has_pitch() {
            Topography::read(&path)
        } else {
            let without = Topography::read(&path).unwrap_err();
            assert!(without.to_string().ends_with("a.npy (npy) has no pitch"), "{without}");
            ReadOptions::default().with_pitch(grid.pitch).read(&path)
        };
        let read = read.unwrap();
        assert_eq!(read.heights(), topography.heights(), "{name}");
        for (found, expected) in read.grid().pitch.iter().zip(grid.pitch) {
            assert_relative_eq!(*found, expected, max_relative = 1e-15);
        }
    }
    for name in ["a.txt", "a"] {
        let error = topography.write(directory.path().join(name)).unwrap_err();
        assert!(matches!(error, Error::NoFormat { .. }) && error.hint().is_some(), "{error}");
    }
}

// ---- whatever the content --------------------------------------------------------------------------------

fn samples() -> Vec<Vec<u8>> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("a");
    let (grid, heights) = example();
    x3p::write(&path, &grid, &heights).unwrap();
    let x3p = std::fs::read(&path).unwrap();
    npy::write(&path, &heights).unwrap();
    let npy = std::fs::read(&path).unwrap();
    let text = b"# heights\n1,5; 2; ***\n3;4;5\n".to_vec();
    let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    gzip.write_all(&text).unwrap();
    let mut samples = vec![
        x3p,
        x3p_with("I", &[1; 20], Some(&[0x95, 0xfd]), ""),
        npy,
        files::npy("'<f8'", true, "(3, 1)", &[1; 24]),
        sur_of(16, "Height", 2),
        files::sur_compressed(&sur_of(32, "Height", 1)),
        text,
        b"0 0 1\n0 1 2\n1 0 3\n1 1 4\n".to_vec(),
        gzip.finish().unwrap(),
    ];
    samples.extend(sdf::samples());
    samples.extend(instruments::samples());
    samples.extend(probes::samples());
    samples.extend(containers::samples());
    samples.push(gwy::sample());
    samples.extend(headed::samples());
    samples.push(tiff::sample());
    samples.push(csv::SAMPLE.as_bytes().to_vec());
    samples.push(text::WORDS.as_bytes().to_vec());
    samples.extend(made(&["mat", "npz", "gsf", "asc"]));
    samples
}

/// Returns the files of these corpora, which are of other programs.
fn made(formats: &[&str]) -> Vec<Vec<u8>> {
    let files = |format: &&str| std::fs::read_dir(corpus(format, "")).unwrap();
    formats.iter().flat_map(files).map(|file| std::fs::read(file.unwrap().path()).unwrap()).collect()
}

/// Path of a file in the corpus of a format.
fn corpus(format: &str, name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(format).join(name)
}

#[test]
fn a_damaged_file_is_answered_and_never_a_panic() {
    let samples = samples();
    arbtest(|u| {
        let mut bytes = u.choose(&samples)?.clone();
        for _ in 0..u.int_in_range(1..=8)? {
            let at = u.choose_index(bytes.len())?;
            match u.int_in_range(0..=4)? {
                0 => bytes[at] = u.arbitrary()?,
                1 => bytes[at] ^= 1 << u.int_in_range(0..=7)?,
                2 => bytes.truncate(at.max(1)),
                3 => {
                    let end = (at + u.int_in_range(1..=8)?).min(bytes.len());
                    let byte = *u.choose(&[0x00, 0xff, 0x7f, 0x80, b'9', b'('])?;
                    bytes[at..end].fill(byte);
                }
                _ => {
                    let end = (at + u.int_in_range(1..=64)?).min(bytes.len());
                    let part = bytes[at..end].to_vec();
                    bytes.splice(at..at, part);
                }
            }
        }
        let _ = decode(&bytes, None);
        Ok(())
    })
    .budget_ms(4000);
}

#[test]
fn random_bytes_are_answered_and_never_a_panic() {
    arbtest(|u| {
        let magics: [&[u8]; 29] = [
            b"",
            b"PK\x03\x04",
            b"\x93NUMPY\x01\0",
            b"DIGITAL SURF",
            b"DSCOMPRESSED",
            b"\x1f\x8b\x08",
            b"0 1;2\n",
            b"bISO-1.0",
            b"II*\0\x08\0\0\0",
            b"GWYPGwyContainer\0\xff\0\0\0",
            b"AliconaImaging\0\r\n",
            b"FRTM_GLIDERV1.00\x01\0",
            b"\x88\x1b\x03\x6f",
            b"\x01\0Directory",
            b"Binary TrueMap Data File v2.0\r\n\0\0",
            b"\\*File list\r\n\\*Ciao image list\r\n",
            b"[DataSet]\nGr0-Ch0=",
            b"WSxM file copyright\nSxM Image file\nImage header size: 9\n",
            b"fileType      Image\n",
            b"VCA DATA\x01\0\0\x55",
            b"VK4_\0\0\0\0\0\0\0\0",
            b"CDF\x01\0\0\0\0\0\0\0\x0a\0\0\0\x02",
            b"\x89HDF\r\n\x1a\n\0\0\0\0",
            b"\xff\xfe",
            b"Gwyddion Simple Field 1.0\nXRes = 1\nYRes = 1\n",
            b"ncols 2\nnrows 2\ncellsize 1\n",
            b"Unit,um\nPitch,1\n1,2\n",
            b"MATLAB 5.0 MAT-file",
            b"x,z\n0,1\n1,2\n",
        ];
        let mut bytes = u.choose(&magics)?.to_vec();
        bytes.extend(u.arbitrary::<Vec<u8>>()?);
        let _ = decode(&bytes, Some("height"));
        Ok(())
    })
    .budget_ms(1000);
}

#[test]
fn the_xml_of_an_x3p_may_say_anything() {
    let words = [
        "0",
        "-1",
        "5",
        "18446744073709551615",
        "1e999",
        "NaN",
        "I",
        "A",
        "L",
        "bindata/data.bin",
        "../main.xml",
        "main.xml",
        "",
        "<SizeX>2</SizeX>",
        "&amp;",
        "]]>",
    ];
    arbtest(|u| {
        let main = "<p:ISO5436_2 xmlns:p='x'><Record1><Axes><CX><AxisType>I</AxisType><Increment>@</Increment></CX>\
                    <CY><AxisType>I</AxisType><Increment>@</Increment></CY><CZ><DataType>@</DataType><Increment>@</Increment>\
                    <Offset>@</Offset></CZ></Axes></Record1><Record3><MatrixDimension><SizeX>@</SizeX><SizeY>@</SizeY>\
                    <SizeZ>@</SizeZ></MatrixDimension><DataLink><PointDataLink>@</PointDataLink><ValidPointsLink>@\
                    </ValidPointsLink></DataLink></Record3></p:ISO5436_2>";
        let good = ["0.5", "0.5", "I", "1", "0", "2", "2", "1", "bindata/data.bin", ""];
        let mut text = String::new();
        for (index, part) in main.split('@').enumerate() {
            text += part;
            if let Some(good) = good.get(index) {
                text += if u.ratio(2, 3)? { good } else { u.choose(&words)? };
            }
        }
        let _ = decode(&zipped(&[("main.xml", text.as_bytes()), ("bindata/data.bin", &[1; 8])]), None);
        Ok(())
    })
    .budget_ms(2000);
}
