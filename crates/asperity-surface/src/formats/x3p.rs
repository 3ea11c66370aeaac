//! x3p: ISO 25178-72 and ISO 5436-2.
//!
//! The file is a zip archive of `main.xml`, the heights in binary (or in the XML), and checksums. Everything
//! is in metres. Heights are stored with x fastest, little-endian; integers count increments of the z axis. A
//! missing height is NaN, or has a 0 in the mask of valid points: one bit for each, the least significant
//! first, or one byte.

use std::fmt::Write as _;
use std::io::{Cursor, Read, Write as _};
use std::path::Path;

use md5::{Digest, Md5};
use roxmltree::{Document, Node, ParsingOptions};
use zip::ZipArchive;
use zip::write::{SimpleFileOptions, ZipWriter};

use super::binary::{Number, Order, Raster};
use super::foreign::{self, Foreign};
use super::{Decoded, Fault, ONLY_CHANNEL, Scan, cells, choose, finite, x_fastest};
use asperity_base::error::{Defect, Error, Result};
use asperity_base::grid::{Field, Grid};
use asperity_base::io::atomic;

/// Writes `heights` on `grid` to `path` as float64, with checksums, atomically. NaN stays NaN (missing).
///
/// # Errors
/// [`Error::File`].
///
/// # Panics
/// If the shape of `heights` differs from that of `grid`.
pub(super) fn write(path: &Path, grid: &Grid, heights: &Field) -> Result<()> {
    assert_eq!(heights.shape(), grid.shape, "heights must be on the grid");
    let archive =
        encode(grid, heights).map_err(|error| Error::File { path: path.to_owned(), source: error.into() })?;
    atomic::replace(path, &archive)
}

fn encode(grid: &Grid, heights: &Field) -> zip::result::ZipResult<Vec<u8>> {
    let data: Vec<u8> = heights.t().iter().flat_map(|height| height.to_le_bytes()).collect();
    let main = main_xml(grid, &checksum(&data));
    let checksums = format!("{} *{MAIN}\n", checksum(main.as_bytes()));

    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default()
        .compression_method(zip::CompressionMethod::Deflated)
        .large_file(data.len() > u32::MAX as usize / 2);
    for (name, content) in [(MAIN, main.as_bytes()), (DATA, &data), (CHECKSUMS, checksums.as_bytes())] {
        archive.start_file(name, options)?;
        archive.write_all(content)?;
    }
    Ok(archive.finish()?.into_inner())
}

const MAIN: &str = "main.xml";
const DATA: &str = "bindata/data.bin";
const CHECKSUMS: &str = "md5checksum.hex";

fn main_xml(grid: &Grid, checksum: &str) -> String {
    let ([nx, ny], [dx, dy]) = (grid.shape, grid.pitch);
    let version = env!("CARGO_PKG_VERSION");
    let axis = |name, kind, increment: f64| {
        format!(
            "      <{name}>\n        <AxisType>{kind}</AxisType>\n        <DataType>D</DataType>\n        \
             <Increment>{increment:e}</Increment>\n        <Offset>0</Offset>\n      </{name}>\n"
        )
    };
    let axes = [axis("CX", "I", dx), axis("CY", "I", dy), axis("CZ", "A", 1.0)].concat();
    // The dates are required but unknown; like other programs we write 1970.
    format!(
        r#"<?xml version="1.0" encoding="UTF-8" standalone="no"?>
<p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:schemaLocation="http://www.opengps.eu/2008/ISO5436_2 http://www.opengps.eu/2008/ISO5436_2/ISO5436_2.xsd">
  <Record1>
    <Revision>ISO5436 - 2000</Revision>
    <FeatureType>SUR</FeatureType>
    <Axes>
{axes}    </Axes>
  </Record1>
  <Record2>
    <Date>1970-01-01T00:00:00</Date>
    <Instrument>
      <Manufacturer>asperity</Manufacturer>
      <Model>not available</Model>
      <Serial>not available</Serial>
      <Version>{version}</Version>
    </Instrument>
    <CalibrationDate>1970-01-01T00:00:00</CalibrationDate>
    <ProbingSystem>
      <Type>Software</Type>
      <Identification>not available</Identification>
    </ProbingSystem>
  </Record2>
  <Record3>
    <MatrixDimension>
      <SizeX>{nx}</SizeX>
      <SizeY>{ny}</SizeY>
      <SizeZ>1</SizeZ>
    </MatrixDimension>
    <DataLink>
      <PointDataLink>{DATA}</PointDataLink>
      <MD5ChecksumPointData>{checksum}</MD5ChecksumPointData>
    </DataLink>
  </Record3>
  <Record4>
    <ChecksumFile>{CHECKSUMS}</ChecksumFile>
  </Record4>
</p:ISO5436_2>
"#
    )
}

fn checksum(bytes: &[u8]) -> String {
    Md5::digest(bytes).iter().fold(String::with_capacity(32), |mut text, byte| {
        let _ = write!(text, "{byte:02X}");
        text
    })
}

/// Largest size of `main.xml`, which may contain the heights, and largest number of its elements and texts.
const MAX_MAIN: u64 = 1 << 26;
const MAX_NODES: u32 = 1 << 23;

/// Largest number of layers, each of which is a channel.
const MAX_LAYERS: usize = 1 << 16;

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    let fault = |defect| Fault::defect("x3p", defect);
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| fault(container("zip", error)))?;
    if archive.index_for_name(MAIN).is_none() {
        let names: Vec<_> = archive.file_names().flatten().collect();
        return Err(Fault::NotATopography(foreign::kind_of_archive(&names)));
    }
    let main = entry(&mut archive, MAIN, MAIN, MAX_MAIN).map_err(fault)?;
    if main.len() as u64 > MAX_MAIN {
        let found = main.len() as u64;
        return Err(fault(Defect::Length { what: MAIN, expected: MAX_MAIN, found }));
    }
    let text = std::str::from_utf8(&main).map_err(|error| fault(container("main.xml", error)))?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    vet_xml(text).map_err(fault)?;
    let options = ParsingOptions { nodes_limit: MAX_NODES, ..ParsingOptions::default() };
    let document =
        Document::parse_with_options(text, options).map_err(|error| fault(container("main.xml", error)))?;
    let root = document.root_element();
    if root.tag_name().name() != "ISO5436_2" {
        let reason = "it is a zip archive, but its main.xml is not that of an x3p";
        return Err(Fault::NotATopography(Foreign::new(reason)));
    }
    verify_main(&mut archive, root, &main).map_err(fault)?;

    let header = Header::read(root).map_err(fault)?;
    let layers = header.sizes[2];
    let channels: Vec<_> = match layers {
        1 => vec![ONLY_CHANNEL.to_owned()],
        _ => (1..=layers).map(|layer| format!("{ONLY_CHANNEL} {layer}")).collect(),
    };
    let layer = choose(&channels, channel)?;
    let heights = header.heights(root, &mut archive, layer).map_err(fault)?;
    Ok(Scan::of_channel("x3p", channels, layer, header.increments, heights))
}

/// Largest number of attributes, and of nested elements: the format has about five of each.
const MAX_ATTRIBUTES: usize = 1 << 10;
const MAX_DEPTH: usize = 1 << 8;

/// Rejects XML that the parser would need long for: its time grows as the square of the number of attributes.
fn vet_xml(text: &str) -> Outcome<()> {
    let too_many =
        |what, found: usize, expected| Defect::Value { what, found: format!("{found} or more"), expected };
    let (mut attributes, mut depth) = (0, 0usize);
    let mut rest = text;
    while let Some(start) = rest.find('<') {
        rest = &rest[start..];
        let special = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>")];
        if let Some((_, end)) = special.into_iter().find(|(start, _)| rest.starts_with(start)) {
            rest = rest.find(end).map_or("", |at| &rest[at + end.len()..]);
            continue;
        }
        let mut quote = None;
        let mut end = rest.len();
        for (at, byte) in rest.bytes().enumerate() {
            match (quote, byte) {
                (Some(open), _) if open == byte => quote = None,
                (Some(_), _) => {}
                (None, b'"' | b'\'') => quote = Some(byte),
                (None, b'=') => attributes += 1,
                (None, b'>') => {
                    end = at;
                    break;
                }
                (None, _) => {}
            }
        }
        let tag = &rest[..end];
        if tag.starts_with("</") {
            depth = depth.saturating_sub(1);
        } else if !tag.ends_with('/') {
            depth += 1;
        }
        if attributes > MAX_ATTRIBUTES {
            return Err(too_many("the number of attributes in main.xml", attributes, "at most 1024"));
        }
        if depth > MAX_DEPTH {
            return Err(too_many("the depth of main.xml", depth, "at most 256"));
        }
        rest = &rest[end..];
    }
    Ok(())
}

pub(super) type Archive<'a> = ZipArchive<Cursor<&'a [u8]>>;
type Outcome<T> = std::result::Result<T, Defect>;

struct Header {
    /// Number of heights along x and y, and of layers.
    sizes: [usize; 3],
    increments: [f64; 2],
    number: Number,
    /// A height is `offset + increment · number`; the increment counts for integers only.
    offset: f64,
    increment: f64,
}

impl Header {
    fn read(root: Node<'_, '_>) -> Outcome<Self> {
        let record = child(root, "Record1").ok_or(Defect::Missing("Record1"))?;
        let axes = child(record, "Axes").ok_or(Defect::Missing("Axes in Record1"))?;
        let [x, y, z] = [("CX", "axis CX"), ("CY", "axis CY"), ("CZ", "axis CZ")]
            .map(|(name, what)| child(axes, name).ok_or(Defect::Missing(what)));
        let (x, y, z) = (x?, y?, z?);
        for axis in [x, y] {
            let kind = text(axis, "AxisType").unwrap_or("I");
            if kind != "I" {
                let expected = "`I` (incremental): heights on a regular grid";
                return Err(Defect::Value { what: "AxisType of CX or CY", found: kind.to_owned(), expected });
            }
        }
        let kind = text(z, "DataType").unwrap_or("D");
        let number = number(kind).ok_or_else(|| Defect::Value {
            what: "DataType of CZ",
            found: kind.to_owned(),
            expected: "I, L, F or D",
        })?;

        let record = child(root, "Record3").ok_or(Defect::Missing("Record3"))?;
        let matrix =
            child(record, "MatrixDimension").ok_or_else(|| match child(record, "ListDimension") {
                Some(_) => Defect::Value {
                    what: "Record3",
                    found: "ListDimension".to_owned(),
                    expected: "MatrixDimension: heights on a regular grid",
                },
                None => Defect::Missing("MatrixDimension in Record3"),
            })?;
        let [x_size, y_size, z_size] = ["SizeX", "SizeY", "SizeZ"].map(|name| size(matrix, name));
        let sizes = [x_size?, y_size?, z_size?];
        cells(&sizes.map(|size| size as u64))?;
        if sizes[2] > MAX_LAYERS {
            let found = sizes[2].to_string();
            return Err(Defect::Value { what: "SizeZ", found, expected: "at most 65536" });
        }
        Ok(Self {
            sizes,
            increments: [decimal(x, "Increment", f64::NAN)?, decimal(y, "Increment", f64::NAN)?],
            number,
            offset: decimal(z, "Offset", 0.0)?,
            increment: if number.is_integer() { decimal(z, "Increment", 1.0)? } else { 1.0 },
        })
    }

    fn heights(&self, root: Node<'_, '_>, archive: &mut Archive<'_>, layer: usize) -> Outcome<Field> {
        let record = child(root, "Record3").ok_or(Defect::Missing("Record3"))?;
        let shape = [self.sizes[0], self.sizes[1]];
        let first = layer * shape[0] * shape[1];
        if let Some(list) = child(record, "DataList") {
            let numbers = self.listed(list)?;
            return Ok(x_fastest(shape, |cell, heights| {
                for (height, number) in heights.iter_mut().zip(&numbers[first + cell..]) {
                    *height = finite(self.offset + self.increment * number);
                }
            }));
        }
        let link = child(record, "DataLink").ok_or(Defect::Missing("DataLink or DataList in Record3"))?;
        let all = self.sizes.iter().product::<usize>();
        let expected = (all * self.number.bytes()) as u64;
        let data =
            linked(archive, link, ("PointDataLink", "MD5ChecksumPointData"), "the point data", expected)?
                .ok_or(Defect::Missing("PointDataLink in DataLink"))?;
        if data.len() as u64 != expected {
            return Err(Defect::Length { what: "the point data", expected, found: data.len() as u64 });
        }
        let links = ("ValidPointsLink", "MD5ChecksumValidPoints");
        let mask = linked(archive, link, links, "the mask of valid points", all as u64)?;
        let bits = all.div_ceil(8);
        if let Some(mask) = mask.as_ref().filter(|mask| mask.len() != bits && mask.len() != all) {
            let (expected, found) = (bits as u64, mask.len() as u64);
            return Err(Defect::Length { what: "the mask of valid points", expected, found });
        }
        let data = &data[first * self.number.bytes()..];
        let raster = Raster::new(shape, self.number, Order::Little, data)?;
        let mut heights = raster.heights(|number| self.offset + self.increment * number);
        if let Some(mask) = mask {
            let is_valid = |point: usize| {
                if mask.len() == bits { mask[point / 8] >> (point % 8) & 1 == 1 } else { mask[point] != 0 }
            };
            for ((ix, iy), height) in heights.indexed_iter_mut() {
                if !is_valid(first + ix + shape[0] * iy) {
                    *height = f64::NAN;
                }
            }
        }
        Ok(heights)
    }

    /// Reads the numbers of a list in the XML: for each point its coordinates, of which z is the last, or
    /// nothing.
    fn listed(&self, list: Node<'_, '_>) -> Outcome<Vec<f64>> {
        let mut numbers = Vec::new();
        for point in list.children().filter(|node| node.tag_name().name() == "Datum") {
            let text = point.text().unwrap_or_default().trim();
            let height = text.rsplit(';').next().unwrap_or_default().trim();
            numbers.push(match (height, height.parse::<f64>()) {
                ("", _) => f64::NAN,
                (_, Ok(number)) if number.is_finite() => number,
                (_, Ok(_)) => f64::NAN,
                (_, Err(_)) => {
                    let found = text.chars().take(40).collect();
                    return Err(Defect::Value {
                        what: "a Datum",
                        found,
                        expected: "numbers separated by `;`",
                    });
                }
            });
        }
        let all = self.sizes.iter().product::<usize>();
        if numbers.len() != all {
            let found = numbers.len().to_string();
            return Err(Defect::Value {
                what: "the number of Datum",
                found,
                expected: "SizeX · SizeY · SizeZ",
            });
        }
        Ok(numbers)
    }
}

fn number(kind: &str) -> Option<Number> {
    Some(match kind {
        "I" => Number::Int16,
        "L" => Number::Int32,
        "F" => Number::Float32,
        "D" => Number::Float64,
        _ => return None,
    })
}

/// Compares `main.xml` with its checksum, if there is one.
fn verify_main(archive: &mut Archive<'_>, root: Node<'_, '_>, main: &[u8]) -> Outcome<()> {
    let name = child(root, "Record4").and_then(|record| text(record, "ChecksumFile")).unwrap_or(CHECKSUMS);
    if archive.index_for_name(plain_name(name)).is_none() {
        return Ok(());
    }
    let lines = entry(archive, plain_name(name), "the checksum of main.xml", 1 << 16)?;
    let lines = String::from_utf8_lossy(&lines);
    // Some programs name another file there, whose checksum is in main.xml, too.
    let is_of_main = |line: &&str| {
        line.split_whitespace().nth(1).is_none_or(|name| plain_name(name.trim_start_matches('*')) == MAIN)
    };
    let line = lines.lines().find(is_of_main).unwrap_or_default();
    verify(MAIN, line.split_whitespace().next().unwrap_or_default(), main)
}

/// Returns the verified entry named by `link`, at most one byte longer than `most`.
fn linked(
    archive: &mut Archive<'_>,
    link: Node<'_, '_>,
    (name, md5): (&str, &str),
    what: &'static str,
    most: u64,
) -> Outcome<Option<Vec<u8>>> {
    let Some(name) = text(link, name).filter(|name| !name.is_empty()) else {
        return Ok(None);
    };
    let data = entry(archive, plain_name(name), what, most)?;
    if data.len() as u64 <= most {
        verify(what, text(link, md5).unwrap_or_default(), &data)?;
    }
    Ok(Some(data))
}

fn verify(what: &'static str, expected: &str, content: &[u8]) -> Outcome<()> {
    let found = checksum(content);
    if expected.is_empty() || expected.eq_ignore_ascii_case(&found) {
        return Ok(());
    }
    Err(Defect::Checksum { what, expected: expected.chars().take(32).collect(), found })
}

/// Returns the first bytes of an entry, at most `most` + 1.
pub(super) fn entry(
    archive: &mut Archive<'_>,
    name: &str,
    what: &'static str,
    most: u64,
) -> Outcome<Vec<u8>> {
    if archive.index_for_name(name).is_none() {
        return Err(Defect::Missing(what));
    }
    let entry = archive.by_name(name).map_err(|error| container(what, error))?;
    let mut content = Vec::new();
    entry.take(most.saturating_add(1)).read_to_end(&mut content).map_err(|error| container(what, error))?;
    Ok(content)
}

/// Names in an archive have forward slashes and start at its root.
fn plain_name(name: &str) -> &str {
    name.strip_prefix("./").unwrap_or(name).trim_start_matches('/')
}

fn container(what: &str, error: impl std::fmt::Display) -> Defect {
    Defect::Container(format!("{what}: {error}"))
}

fn child<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|child| child.tag_name().name() == name)
}

fn text<'a>(node: Node<'a, '_>, name: &str) -> Option<&'a str> {
    child(node, name).map(|child| child.text().unwrap_or_default().trim())
}

fn decimal(axis: Node<'_, '_>, name: &'static str, default: f64) -> Outcome<f64> {
    match text(axis, name) {
        None | Some("") => Ok(default),
        Some(found) => found
            .parse()
            .ok()
            .filter(|number: &f64| number.is_finite())
            .ok_or_else(|| Defect::Value { what: name, found: found.to_owned(), expected: "a number" }),
    }
}

fn size(matrix: Node<'_, '_>, name: &'static str) -> Outcome<usize> {
    let found = text(matrix, name).ok_or(Defect::Missing(name))?;
    found.parse().ok().filter(|size| *size > 0).ok_or_else(|| Defect::Value {
        what: name,
        found: found.to_owned(),
        expected: "at least 1",
    })
}
