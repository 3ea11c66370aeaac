//! NumPy `.npy`: a matrix `heights[ix, iy]` in metres, without a pitch.
//!
//! Format: NEP 1, "A Simple File Format for NumPy Arrays".

use std::path::Path;

use super::binary::{Number, Order, Raster};
use super::{Decoded, Fault, Scan, cells, only_channel};
use asperity_base::error::{Defect, Result};
use asperity_base::grid::Field;
use asperity_base::io::atomic;

/// Writes `heights` to `path` as float64 in C order, atomically: `numpy.load` gives `heights[ix, iy]`.
///
/// # Errors
/// [`Error::File`](asperity_base::Error::File).
pub(super) fn write(path: &Path, heights: &Field) -> Result<()> {
    let [nx, ny] = [heights.nrows(), heights.ncols()];
    let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({nx}, {ny}), }}\n");
    // The numbers begin at a multiple of 64 bytes; the padding is before the end of the line.
    let length = (MAGIC.len() + 4 + header.len()).next_multiple_of(64) - MAGIC.len() - 4;
    let header = format!("{:<1$}\n", header.trim_end(), length - 1);
    atomic::write_with(path, |file| {
        file.write_all(MAGIC)?;
        file.write_all(&[1, 0])?;
        file.write_all(&(header.len() as u16).to_le_bytes())?;
        file.write_all(header.as_bytes())?;
        heights.iter().try_for_each(|height| file.write_all(&height.to_le_bytes()))
    })
}

/// Precedes the version, the length of the header and the header.
pub(super) const MAGIC: &[u8] = b"\x93NUMPY";

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    let channels = only_channel(channel)?;
    let heights = array(bytes).map_err(|defect| Fault::defect("npy", defect))?;
    Ok(Scan::of_matrix("npy", channels, 0, heights))
}

/// Reads a matrix.
pub(super) fn array(bytes: &[u8]) -> std::result::Result<Field, Defect> {
    let (text, data) = split(bytes)?;
    let Matrix { shape, number, order, is_x_fastest } = Matrix::of(&text)?;
    let expected = ((shape[0] * shape[1]) as u64).saturating_mul(number.bytes() as u64);
    if data.len() as u64 != expected {
        return Err(Defect::Length { what: "the array", expected, found: data.len() as u64 });
    }
    let raster = Raster::new(shape, number, order, data)?;
    Ok(if is_x_fastest {
        raster.heights(|height| height)
    } else {
        raster.heights_with_y_fastest(|height| height)
    })
}

/// A matrix of real numbers, as described by its header.
pub(super) struct Matrix {
    pub(super) shape: [usize; 2],
    number: Number,
    order: Order,
    is_x_fastest: bool,
}

impl Matrix {
    /// Reads the header at the start of `bytes`, an array that may be truncated.
    #[cfg(feature = "zip")]
    pub(super) fn at_start(bytes: &[u8]) -> std::result::Result<Self, Defect> {
        Self::of(&split(bytes)?.0)
    }

    #[cfg(feature = "zip")]
    /// Number of bytes of the numbers.
    pub(super) fn bytes(&self) -> u64 {
        (self.shape[0] * self.shape[1] * self.number.bytes()) as u64
    }

    fn of(text: &str) -> std::result::Result<Self, Defect> {
        let Some(header) = Header::read(text) else {
            return Err(Defect::Value {
                what: "the header",
                found: text.chars().take(80).collect::<String>().trim_end().to_owned(),
                expected: "that of a 2-dimensional array",
            });
        };
        let all = header.shape.iter().fold(1u128, |product, n| product.saturating_mul((*n).max(1).into()));
        if all > 1 << 60 {
            return Err(Defect::TooLarge { cells: all, limit: super::MAX_CELLS });
        }
        let &[nx, ny] = header.shape.as_slice() else {
            let found = format!("{}-dimensional", header.shape.len());
            return Err(Defect::Value { what: "the array", found, expected: "2-dimensional" });
        };
        let Some((number, order)) = number(header.descr) else {
            let found = format!("'{}'", header.descr);
            return Err(Defect::Value { what: "the array's type", found, expected: "real numbers" });
        };
        if cells(&[nx, ny])? == 0 {
            let found = format!("{nx} × {ny}");
            return Err(Defect::Value { what: "the array", found, expected: "not empty" });
        }
        Ok(Self { shape: [nx as usize, ny as usize], number, order, is_x_fastest: header.fortran_order })
    }
}

/// Splits the header from the data.
fn split(bytes: &[u8]) -> std::result::Result<(String, &[u8]), Defect> {
    let little = |bytes: &[u8]| bytes.iter().rev().fold(0, |number, byte| number << 8 | u64::from(*byte));
    let (start, length) = match bytes.get(MAGIC.len()) {
        Some(1) => (10, bytes.get(8..10).map(little)),
        _ => (12, bytes.get(8..12).map(little)),
    };
    let expected = length.map_or(start, |length| start + length);
    match bytes.split_at_checked(usize::try_from(expected).unwrap_or(usize::MAX)) {
        Some((header, data)) if length.is_some() => {
            Ok((String::from_utf8_lossy(&header[start as usize..]).into_owned(), data))
        }
        _ => Err(Defect::Length { what: "the header", expected, found: bytes.len() as u64 }),
    }
}

/// Header of an array with elements of one kind.
struct Header<'a> {
    /// The kind, `<f8`.
    descr: &'a str,
    fortran_order: bool,
    shape: Vec<u64>,
}

impl<'a> Header<'a> {
    /// Reads `{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), }`, with its keys in any order.
    fn read(text: &'a str) -> Option<Self> {
        let (mut descr, mut fortran_order, mut shape) = (None, None, None);
        let mut rest = Literal(text);
        rest.take("{")?;
        while rest.take("}").is_none() {
            let key = rest.text()?;
            rest.take(":")?;
            match key {
                "descr" => descr = Some(rest.text()?),
                "fortran_order" => fortran_order = Some(rest.truth()?),
                "shape" => shape = Some(rest.numbers()?),
                _ => return None,
            }
            if rest.take(",").is_none() {
                rest.take("}")?;
                break;
            }
        }
        rest.0.trim().is_empty().then_some(())?;
        Some(Self { descr: descr?, fortran_order: fortran_order?, shape: shape? })
    }
}

/// The rest of a Python literal.
struct Literal<'a>(&'a str);

impl<'a> Literal<'a> {
    fn take(&mut self, token: &str) -> Option<()> {
        self.0 = self.0.trim_start().strip_prefix(token)?;
        Some(())
    }

    fn text(&mut self) -> Option<&'a str> {
        let quote = if self.take("'").is_some() { '\'' } else { self.take("\"").map(|()| '"')? };
        let (text, rest) = self.0.split_once(quote)?;
        self.0 = rest;
        (!text.contains('\\')).then_some(text)
    }

    fn truth(&mut self) -> Option<bool> {
        if self.take("True").is_some() { Some(true) } else { self.take("False").map(|()| false) }
    }

    fn numbers(&mut self) -> Option<Vec<u64>> {
        let mut numbers = Vec::new();
        self.take("(")?;
        while self.take(")").is_none() {
            let text = self.0.trim_start();
            let end = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
            numbers.push(text[..end].parse().ok()?);
            self.0 = &text[end..];
            if self.take(",").is_none() {
                self.take(")")?;
                break;
            }
        }
        Some(numbers)
    }
}

/// Returns the storage format of a kind, if its numbers are real.
fn number(descr: &str) -> Option<(Number, Order)> {
    let kind = descr.trim_start_matches(['<', '>', '=', '|']);
    let order = if descr.starts_with('>') { Order::Big } else { Order::Little };
    let number = match kind {
        "f8" => Number::Float64,
        "f4" => Number::Float32,
        "i1" => Number::Int8,
        "i2" => Number::Int16,
        "i4" => Number::Int32,
        "i8" => Number::Int64,
        "u1" => Number::Uint8,
        "u2" => Number::Uint16,
        "u4" => Number::Uint32,
        "u8" => Number::Uint64,
        _ => return None,
    };
    Some((number, order))
}
