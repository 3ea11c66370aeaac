//! What the fuzz targets do: each makes a file of one format of any bytes, reads it, and checks what is read.
//!
//! A file of a corpus need not be one of the format: what the format begins with, and what a mutation would
//! hardly find (archives, compression, lengths), is put around it here.

use std::io::{Cursor, Write};
use std::path::PathBuf;

use asperity_surface::{Error, Field, Grid};
use asperity_surface::{ReadOptions, Scan, Topography};

/// Takes any bytes.
pub type Target = fn(&[u8]);

/// The targets by their names, which are those of the corpora too.
pub const TARGETS: [(&str, Target); 34] = [
    ("al3d", al3d),
    ("asc", asc),
    ("bcr", bcr),
    ("csv", csv),
    ("frt", frt),
    ("gsf", gsf),
    ("gwy", gwy),
    ("gzip", gzip),
    ("hdf5", hdf5),
    ("headed", headed),
    ("ibw", ibw),
    ("mat", mat),
    ("metropro", metropro),
    ("mi", mi),
    ("mnt", mnt),
    ("nanoscope", nanoscope),
    ("netcdf", netcdf),
    ("nid", nid),
    ("nms", nms),
    ("npy", npy),
    ("npz", npz),
    ("opd", opd),
    ("opdx", opdx),
    ("plu", plu),
    ("sdf_binary", sdf_binary),
    ("sdf_text", sdf_text),
    ("sur", sur),
    ("text", text),
    ("tiff", tiff),
    ("tmd", tmd),
    ("utf16", utf16),
    ("vk", vk),
    ("wsxm", wsxm),
    ("x3p", x3p),
];

/// AL3D.
pub fn al3d(data: &[u8]) {
    check(&["al3d"], &beginning_with(&[b"AliconaImaging\0\r\n"], data));
}

/// ASC.
pub fn asc(data: &[u8]) {
    check(&["asc"], &beginning_with(&[b"ncols", b"NCOLS", b"nrows"], data));
}

/// BCR: the header, which ends at a zero and is padded here, in UTF-16 if it says so; then the heights.
pub fn bcr(data: &[u8]) {
    let data = beginning_with(&[b"fileformat = bcr"], data);
    let (header, heights) = split_at_zero(&data);
    let mut header = header.to_vec();
    header.resize(2048, b' ');
    if header.windows(8).any(|word| word == b"_unicode") {
        header = header.iter().flat_map(|byte| [*byte, 0]).collect();
    }
    check(&["bcr"], &[&header, heights].concat());
}

/// CSV.
pub fn csv(data: &[u8]) {
    check(&["csv", "text", "xyz", "xz"], &beginning_with(&[b"x,y", b"X", b"x"], data));
}

/// FRT.
pub fn frt(data: &[u8]) {
    check(&["frt"], &beginning_with(&[b"FRTM_GLIDERV1.00"], data));
}

/// GSF.
pub fn gsf(data: &[u8]) {
    check(&["gsf"], &beginning_with(&[b"Gwyddion Simple Field 1.0\n"], data));
}

/// GWY: a file, or the components of the container.
pub fn gwy(data: &[u8]) {
    if data.starts_with(b"GWYP") {
        return check(&["gwy"], data);
    }
    let size = (data.len() as u32).to_le_bytes();
    check(&["gwy"], &[b"GWYPGwyContainer\0", size.as_slice(), data].concat());
}

/// Gzip: a file, or what it unpacks to.
pub fn gzip(data: &[u8]) {
    if data.starts_with(&[0x1f, 0x8b]) {
        return check(&[], data);
    }
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(data).expect("memory takes all");
    check(&[], &encoder.finish().expect("memory takes all"));
}

/// HDF5: results, files of Zygo, or any other.
pub fn hdf5(data: &[u8]) {
    check(&["hdf5", "results", "datx"], &beginning_with(&[b"\x89HDF\r\n\x1a\n"], data));
}

/// Text with a header of SPIP, Gwyddion, Koala or Zygo.
pub fn headed(data: &[u8]) {
    let magics: [&[u8]; 4] = [b"# File Format = ASCII", b"# Channel:", b"h=", b"Zygo XYZ Data File"];
    let formats = ["spip", "gwyddion text", "koala", "zygo xyz"];
    check(&formats, &beginning_with(&magics, data));
}

/// IBW, its checksum put right here.
pub fn ibw(data: &[u8]) {
    let mut file = beginning_with(&[b"\x05\0", b"\0\x05", b"\x02\0", b"\0\x02"], data);
    let big = file[0] == 0;
    let (place, headers) = if file[0].max(file[1]) == 2 { (14, 126) } else { (2, 384) };
    if file.len() >= headers {
        file[place..place + 2].fill(0);
        let words = file[..headers].chunks_exact(2).map(|word| [word[0], word[1]]);
        let words = words.map(|word| if big { u16::from_be_bytes(word) } else { u16::from_le_bytes(word) });
        let rest = words.fold(0u16, u16::wrapping_add).wrapping_neg();
        file[place..place + 2].copy_from_slice(&if big { rest.to_be_bytes() } else { rest.to_le_bytes() });
    }
    check(&["ibw"], &file);
}

/// MAT: a file, or a variable of version 5, which is packed if its first byte is odd.
pub fn mat(data: &[u8]) {
    if data.starts_with(b"MATLAB ") {
        return check(&["mat"], data);
    }
    let size = |content: &[u8]| (content.len() as u32).to_le_bytes();
    let mut element = [&14u32.to_le_bytes()[..], &size(data), data].concat();
    if data.first().is_some_and(|byte| byte % 2 == 1) {
        let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
        encoder.write_all(&element).expect("memory takes all");
        let packed = encoder.finish().expect("memory takes all");
        element = [&15u32.to_le_bytes()[..], &size(&packed), &packed].concat();
    }
    let mut file = b"MATLAB 5.0 MAT-file".to_vec();
    file.resize(124, b' ');
    check(&["mat"], &[&file[..], b"\0\x01IM", &element].concat());
}

/// MetroPro.
pub fn metropro(data: &[u8]) {
    check(&["metropro"], &beginning_with(&[b"\x88\x1b\x03\x6f", b"\x88\x1b\x03"], data));
}

/// MI.
pub fn mi(data: &[u8]) {
    check(&["mi"], &beginning_with(&[b"fileType      "], data));
}

/// MNT: a file, or the document in it.
pub fn mnt(data: &[u8]) {
    if data.starts_with(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1") {
        return check(&["mnt"], data);
    }
    let mut file = cfb::CompoundFile::create(Cursor::new(Vec::new())).expect("memory takes all");
    let mut stream = file.create_stream("/ScopedContents").expect("a new name");
    stream.write_all(data).expect("memory takes all");
    drop(stream);
    file.flush().expect("memory takes all");
    check(&["mnt"], file.into_inner().get_ref());
}

/// NanoScope.
pub fn nanoscope(data: &[u8]) {
    check(&["nanoscope"], &beginning_with(&[b"\\*File list", b"\\*EC File list"], data));
}

/// NetCDF 3.
pub fn netcdf(data: &[u8]) {
    check(&["netcdf"], &beginning_with(&[b"CDF\x01", b"CDF\x02"], data));
}

/// NID.
pub fn nid(data: &[u8]) {
    check(&["nid"], &beginning_with(&[b"[DataSet]"], data));
}

/// NMS.
pub fn nms(data: &[u8]) {
    let mut file = data.to_vec();
    file.resize(file.len().max(38), 0);
    // Nothing else begins with two zeros.
    file[..2].fill(0);
    file[32..38].copy_from_slice(b"OM_MS_");
    check(&["nms"], &file);
}

/// NPY.
pub fn npy(data: &[u8]) {
    check(&["npy"], &beginning_with(&[b"\x93NUMPY"], data));
}

/// NPZ: an archive, or an array in it.
pub fn npz(data: &[u8]) {
    if data.starts_with(b"PK\x03\x04") {
        return check(&["npz", "x3p"], data);
    }
    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    archive.start_file("heights.npy", zip::write::SimpleFileOptions::default()).expect("a new name");
    archive.write_all(&beginning_with(&[b"\x93NUMPY"], data)).expect("memory takes all");
    check(&["npz"], archive.finish().expect("memory takes all").get_ref());
}

/// OPD.
pub fn opd(data: &[u8]) {
    check(&["opd"], &beginning_with(&[b"\x01\0Directory"], data));
}

/// OPDx.
pub fn opdx(data: &[u8]) {
    check(&["opdx"], &beginning_with(&[b"VCA DATA\x01\0\0\x55"], data));
}

/// PLU.
pub fn plu(data: &[u8]) {
    check(&["plu"], &beginning_with(&[b"Tue Mar  7 16:35:59 2023\0"], data));
}

/// SDF in binary.
pub fn sdf_binary(data: &[u8]) {
    check(&["sdf"], &beginning_with(&[b"bISO-1.0", b"bISO-2.0", b"bBCR-1.0", b"bNIST-1."], data));
}

/// SDF in text.
pub fn sdf_text(data: &[u8]) {
    check(&["sdf"], &beginning_with(&[b"aISO-1.0", b"aISO-2.0", b"aBCR-1.0", b"aNIST-1."], data));
}

/// SUR.
pub fn sur(data: &[u8]) {
    check(&["sur"], &beginning_with(&[b"DIGITAL SURF", b"DSCOMPRESSED"], data));
}

/// A matrix or a table, or text that begins as another format does.
pub fn text(data: &[u8]) {
    check(&[], data);
}

/// TIFF.
pub fn tiff(data: &[u8]) {
    // Levels are heights once they have a unit.
    let file = beginning_with(&[b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"], data);
    check_in_unit(&["tiff"], &file, Some(1e-9));
}

/// TMD.
pub fn tmd(data: &[u8]) {
    check(&["tmd"], &beginning_with(&[b"Binary TrueMap Data File v2.0\r\n\0"], data));
}

/// Text in UTF-16: a file, or text that is put into it.
pub fn utf16(data: &[u8]) {
    if data.starts_with(b"\xff\xfe") || data.starts_with(b"\xfe\xff") {
        return check(&[], data);
    }
    let text = String::from_utf8_lossy(data);
    let units = std::iter::once(0xfeff).chain(text.encode_utf16());
    check(&[], &units.flat_map(u16::to_le_bytes).collect::<Vec<_>>());
}

/// VK: a file, and the VK4 in an archive.
pub fn vk(data: &[u8]) {
    let file = beginning_with(&[b"VK4_", b"VK3_", b"VK6", b"VK7"], data);
    check(&["vk"], &file);
    if file.starts_with(b"VK4_") {
        let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
        archive.start_file("Vk4File", zip::write::SimpleFileOptions::default()).expect("a new name");
        archive.write_all(&file).expect("memory takes all");
        let archive = archive.finish().expect("memory takes all").into_inner();
        check(&["vk"], &[b"VK7", archive.as_slice()].concat());
    }
}

/// WSxM.
pub fn wsxm(data: &[u8]) {
    check(&["wsxm"], &beginning_with(&[b"WSxM file copyright"], data));
}

/// X3P: an archive, or `main.xml` and, after a zero, the length of the mask, the mask and the heights.
pub fn x3p(data: &[u8]) {
    if data.starts_with(b"PK\x03\x04") {
        return check(&["x3p"], data);
    }
    let (main, rest) = split_at_zero(data);
    let (length, rest) = rest.split_first().unwrap_or((&0, &[]));
    let (mask, heights) = rest.split_at(rest.len().min(usize::from(*length)));
    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (name, content) in [("main.xml", main), ("bindata/data.bin", heights), ("bindata/valid.bin", mask)] {
        archive.start_file(name, zip::write::SimpleFileOptions::default()).expect("a new name");
        archive.write_all(content).expect("memory takes all");
    }
    check(&["x3p"], archive.finish().expect("memory takes all").get_ref());
}

fn beginning_with(magics: &[&[u8]], data: &[u8]) -> Vec<u8> {
    let there = magics.iter().any(|magic| data.starts_with(magic));
    [if there { &[] } else { magics[0] }, data].concat()
}

fn split_at_zero(data: &[u8]) -> (&[u8], &[u8]) {
    let zero = data.iter().position(|byte| *byte == 0).unwrap_or(data.len());
    (&data[..zero], data.get(zero + 1..).unwrap_or_default())
}

/// Reads every channel of `file`, which is of one of `formats` (of any, if that is empty).
fn check(formats: &[&str], file: &[u8]) {
    check_in_unit(formats, file, None);
}

fn check_in_unit(formats: &[&str], file: &[u8], unit: Option<f64>) {
    let is_one = |format: &str| formats.is_empty() || formats.contains(&format);
    let read = |channel: Option<&str>| {
        let mut options = ReadOptions::default();
        (options.channel, options.unit) = (channel.map(str::to_owned), unit);
        options.scan_bytes("file", file)
    };
    match read(None) {
        Ok(scan) => {
            assert!(is_one(scan.format), "taken for {}", scan.format);
            check_scan(&scan);
            assert_eq!(scan.channel, scan.channels[0]);
            for channel in scan.channels.iter().take(4) {
                // Another channel may be damaged.
                if let Ok(scan) = read(Some(channel)) {
                    assert_eq!(scan.channel, *channel);
                    check_scan(&scan);
                }
            }
            check_written(&scan);
        }
        Err(Error::CorruptTopography { format, .. }) => assert!(is_one(format), "taken for {format}"),
        Err(Error::NotATopography { .. }) => {}
        Err(Error::NoChannel { available, .. }) => {
            for channel in available.iter().take(4) {
                if let Ok(scan) = read(Some(channel)) {
                    assert_eq!(scan.channel, *channel);
                    check_scan(&scan);
                }
            }
        }
        Err(other) => panic!("{other}"),
    }
    assert!(!matches!(read(Some("none such")), Err(Error::File { .. })));
}

/// What holds for whatever is read.
fn check_scan(scan: &Scan) {
    assert!(scan.channels.contains(&scan.channel));
    let mut names = scan.channels.clone();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), scan.channels.len(), "{:?} are not distinct", scan.channels);
    assert!((1..=1 << 28).contains(&scan.heights.len()));
    assert!(scan.heights.is_standard_layout());
    assert!(scan.heights.iter().all(|height| height.is_nan() || height.is_finite()));
    assert!(scan.pitch.iter().flatten().all(|pitch| pitch.is_finite() && *pitch > 0.0));
}

/// What is written and read again is what was read.
fn check_written(scan: &Scan) {
    let (nx, ny) = scan.heights.dim();
    let grid = Grid::new([nx, ny], scan.pitch.unwrap_or([1e-6; 2])).expect("a grid");
    let topography = Topography::new(grid, scan.heights.clone()).expect("heights");
    let again = |format: &str| {
        let path = temporary(format);
        topography.write(&path).expect("a file");
        let again = ReadOptions::default().scan(&path).expect("a topography");
        let _ = std::fs::remove_file(path);
        assert_eq!((again.format, again.channels.as_slice()), (format, &["height".to_owned()][..]));
        assert!(same(&again.heights, &scan.heights), "{format}: {} became {}", scan.heights, again.heights);
        again.pitch
    };
    assert_eq!(again("npy"), None);
    assert_eq!(again("sdf"), Some(grid.pitch));
    assert_eq!(again("x3p"), Some(grid.pitch));
    let pitch = again("gwy");
    // The format has the lengths of the sides instead: rounded, and beyond the range of numbers for pitches
    // near its end.
    if grid.pitch.iter().all(|pitch| (1e-300..1e+290).contains(pitch)) {
        for (found, expected) in pitch.expect("a pitch").iter().zip(grid.pitch) {
            assert!(
                (found / expected - 1.0).abs() < 4.0 * f64::EPSILON,
                "gwy: {expected:e} became {found:e}"
            );
        }
    }
}

fn same(left: &Field, right: &Field) -> bool {
    let same = |(left, right): (&f64, &f64)| left == right || left.is_nan() && right.is_nan();
    left.dim() == right.dim() && left.iter().zip(right).all(same)
}

fn temporary(format: &str) -> PathBuf {
    std::env::temp_dir().join(format!(
        "asperity-fuzz-{}-{:?}.{format}",
        std::process::id(),
        std::thread::current().id()
    ))
}
