//! Files that are recognised and not read: what they are, and the export that is read.

/// A kind of file that is not read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Foreign {
    /// Kind of the file, as a clause.
    pub(super) reason: &'static str,
    /// Advice on an export that is read; empty if any format that is read will do.
    pub(super) export: &'static str,
}

impl Foreign {
    pub(super) const fn new(reason: &'static str) -> Self {
        Self { reason, export: "" }
    }

    const fn exported(reason: &'static str, export: &'static str) -> Self {
        Self { reason, export }
    }
}

const GWYDDION: &str = "open it in Gwyddion, and save it as gwy";
const PICTURE: &str = "a picture has colours; export the heights themselves, for example as x3p, sur or text";
#[cfg(any(feature = "zip", feature = "compound"))]
const SHEET: &str = "save the sheet with the heights as CSV";
const MESH: &str =
    "bring its points onto a regular grid, and save them as text with x, y and height in each line";
const UNPACK: &str = "unpack it, and give one of its files";

const KEYENCE: Foreign = Foreign::exported(
    "it is a file of a Keyence profilometer (zag, zon)",
    "export its heights as CSV from the program of the instrument",
);
const OLYMPUS: Foreign = Foreign::exported("it is a file of an Olympus microscope (oir, poir)", GWYDDION);
const WITHOUT_TIFF: Foreign = Foreign::new("it is TIFF, and the feature `tiff` is left out");

/// First bytes of kinds of files. Formats that are read come first: a kind here is an unsupported version, or
/// another one.
const BY_START: &[(&[u8], Foreign)] = &[
    (b"FRTM_GLIDER", Foreign::new("it is an FRT file of another version than 1.00")),
    (b"Binary TrueMap Data File", Foreign::new("it is a TrueMap file of another version than 2.0")),
    (b"CDF", Foreign::new("it is NetCDF of another version than 1 and 2")),
    (b"\x0e\x03\x13\x01", Foreign::new("it is HDF4")),
    (b"\\*Force file list", Foreign::new("it is a force curve of NanoScope")),
    (b"?*File list", Foreign::new("it is a NanoScope file in text")),
    (b"GWYO", Foreign::exported("it is a file of Gwyddion 1", "save it with Gwyddion 2")),
    (b"KPK0", KEYENCE),
    (b"KPK1", KEYENCE),
    (b"OLYMPUSRAWFORMAT", OLYMPUS),
    (
        b"Zeta-Instruments",
        Foreign::exported("it is a file of KLA Zeta (zmg)", "export it as sur, x3p or text"),
    ),
    (b"OmniSurf3D", Foreign::exported("it is a file of OmniSurf3D (os3d)", "save it as sdf")),
    (
        b"ZISRAWFILE",
        Foreign::exported("it is an image of Zeiss (czi)", "export its heights as sur, x3p or text"),
    ),
    (b"\x89PNG", Foreign::exported("it is a picture (PNG)", PICTURE)),
    (b"\xff\xd8\xff", Foreign::exported("it is a picture (JPEG)", PICTURE)),
    (b"GIF8", Foreign::exported("it is a picture (GIF)", PICTURE)),
    (b"BM", Foreign::exported("it is a picture (BMP)", PICTURE)),
    (b"<svg", Foreign::exported("it is a picture (SVG)", PICTURE)),
    (b"%PDF", Foreign::exported("it is a document (PDF)", PICTURE)),
    (b"{\\rtf", Foreign::new("it is a document (RTF)")),
    (b"<!DOCTYPE", Foreign::new("it is a page (HTML)")),
    (b"<html", Foreign::new("it is a page (HTML)")),
    (b"<?xml", Foreign::exported("it is XML", "of an x3p give the whole file, not what is in it")),
    (b"ply\n", Foreign::exported("it is a mesh (PLY)", MESH)),
    (b"ply\r", Foreign::exported("it is a mesh (PLY)", MESH)),
    (b"ISO-10303-21", Foreign::exported("it is a solid model (STEP)", MESH)),
    (b"7z\xbc\xaf", Foreign::exported("it is an archive (7z)", UNPACK)),
    (b"Rar!", Foreign::exported("it is an archive (rar)", UNPACK)),
    (b"\xfd7zXZ", Foreign::exported("it is packed (xz)", UNPACK)),
    (b"BZh", Foreign::exported("it is packed (bzip2)", UNPACK)),
    (b"(\xb5/\xfd", Foreign::exported("it is packed (zstd)", UNPACK)),
    (b"PK\x05\x06", Foreign::new("it is an empty zip archive")),
    (b"PK\x03\x04", Foreign::new("it is a zip archive, and the feature `zip` is left out")),
    (b"\x89HDF\r\n\x1a\n", Foreign::new("it is HDF5, and the feature `hdf5` is left out")),
    (b"II*\0", WITHOUT_TIFF),
    (b"MM\0*", WITHOUT_TIFF),
    (b"II+\0", WITHOUT_TIFF),
    (b"MM\0+", WITHOUT_TIFF),
    (
        b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",
        Foreign::new("it is a compound file, and the feature `compound` is left out"),
    ),
];

/// Returns the kind of a file by its content.
pub(super) fn kind(bytes: &[u8]) -> Option<Foreign> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let by_start = BY_START.iter().find(|(start, _)| bytes.starts_with(start)).map(|(_, kind)| *kind);
    by_start.or_else(|| match bytes {
        bytes if is_stl(bytes) => Some(Foreign::exported("it is a mesh (STL)", MESH)),
        bytes if is_obj(bytes) => Some(Foreign::exported("it is a mesh (OBJ)", MESH)),
        bytes if is_iges(bytes) => Some(Foreign::exported("it is a solid model (IGES)", MESH)),
        bytes if is_tar(bytes) => Some(Foreign::exported("it is an archive (tar)", UNPACK)),
        _ => None,
    })
}

/// In text `solid` and facets, else 80 bytes, the number of facets, and 50 bytes for each.
fn is_stl(bytes: &[u8]) -> bool {
    let start = &bytes[..bytes.len().min(1024)];
    if start.starts_with(b"solid") {
        return start.windows(5).any(|word| word == b"facet");
    }
    let count =
        bytes.get(80..84).and_then(|count| count.first_chunk()).map(|count| u32::from_le_bytes(*count));
    count.is_some_and(|count| count > 0 && bytes.len() as u64 == 84 + 50 * u64::from(count))
}

/// Lines of vertices below comments and names.
fn is_obj(bytes: &[u8]) -> bool {
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(4096)]);
    let mut words =
        text.lines().filter(|line| !line.starts_with('#')).filter_map(|line| line.split_whitespace().next());
    words.find(|word| !matches!(*word, "mtllib" | "usemtl" | "o" | "g" | "s")) == Some("v")
}

/// A letter and the number of the line in the columns 73 to 80.
fn is_iges(bytes: &[u8]) -> bool {
    bytes.get(72..80) == Some(b"S      1")
}

fn is_tar(bytes: &[u8]) -> bool {
    bytes.get(257..262) == Some(b"ustar")
}

/// Returns the kind of a zip archive with these files, which is neither x3p nor npz.
#[cfg(feature = "zip")]
pub(super) fn kind_of_archive(names: &[impl AsRef<str>]) -> Foreign {
    let names: Vec<&str> = names.iter().map(AsRef::as_ref).collect();
    let has = |name: &str| names.contains(&name);
    let in_folder = |folder: &str| names.iter().any(|name| name.starts_with(folder));
    if has("index.xml") && (has("recipe.txt") || names.iter().any(|name| name.contains("LAYER_"))) {
        let export = "export it as plu, sur or x3p from SensoSCAN or SensoVIEW";
        return Foreign::exported("it is a file of Sensofar (plux)", export);
    }
    // The inventory.
    if names.iter().any(|name| name.contains("f1724dc6-686c-4502-9227-2a594bc8ed33")) {
        return KEYENCE;
    }
    if has("header.properties") {
        return Foreign::exported("it holds force curves of JPK (Bruker)", "export a map of heights as text");
    }
    if names.iter().any(|name| name.ends_with(".oir")) {
        return OLYMPUS;
    }
    if in_folder("xl/") {
        return Foreign::exported("it is a workbook of Excel (xlsx)", SHEET);
    }
    if in_folder("word/") || in_folder("ppt/") {
        return Foreign::new("it is a document of Office (docx, pptx)");
    }
    if has("mimetype") && has("content.xml") {
        return Foreign::exported("it is a document of LibreOffice (ods, odt)", SHEET);
    }
    if in_folder("3D/") {
        return Foreign::exported("it is a mesh (3MF)", MESH);
    }
    Foreign::exported("it is a zip archive of other files, without the main.xml of an x3p", UNPACK)
}

/// Returns the kind of a compound file with these streams, which is no document of Mountains.
#[cfg(feature = "compound")]
pub(super) fn kind_of_compound(has: impl Fn(&str) -> bool) -> Foreign {
    if has("/Workbook") || has("/Book") {
        return Foreign::exported("it is a workbook of Excel (xls)", SHEET);
    }
    Foreign::new("it is a compound file, but no document of Mountains")
}

/// Returns the maker of a TIFF with private tags, whose pages are no heights without these.
#[cfg(feature = "tiff")]
pub(super) fn maker_of_tiff(has: impl Fn(u16) -> bool, description: &str) -> Option<Foreign> {
    const IMAGE_ID: u16 = 0x800d; // of OPI
    if (0x8000..=0x80a2).any(|tag| tag != IMAGE_ID && has(tag)) {
        let export = "open it in Gwyddion, or in JPK Data Processing, and save it as gwy, or as text";
        return Some(Foreign::exported("it is an image of JPK (Bruker)", export));
    }
    if has(50_432) {
        return Some(Foreign::exported("it is an image of Park Systems", GWYDDION));
    }
    let is_lext = description.contains("TiffTagDescData");
    is_lext.then_some(Foreign::exported("it is an image of an Olympus LEXT microscope", GWYDDION))
}
