//! NumPy `.npy`: a matrix `heights[ix, iy]` in metres, without a pitch.
//!
//! Format: NEP 1, "A Simple File Format for NumPy Arrays".

use std::path::Path;

use npyz::{DType, Endianness, NpyHeader, TypeChar, WriterBuilder};

use super::binary::{Number, Order, Raster};
use super::{Decoded, Fault, LengthUnit, Scan, cells, only_channel};
use crate::error::{Defect, Result};
use crate::grid::Field;
use crate::io::atomic;

/// Writes `heights` to `path` as float64 in C order, atomically: `numpy.load` gives `heights[ix, iy]`.
///
/// # Errors
/// [`Error::File`](crate::Error::File).
pub(super) fn write(path: &Path, heights: &Field) -> Result<()> {
    let shape = [heights.nrows() as u64, heights.ncols() as u64];
    atomic::write_with(path, |file| {
        let mut array = npyz::WriteOptions::new().default_dtype().shape(&shape).writer(file).begin_nd()?;
        array.extend(heights.iter().copied())?;
        array.finish()
    })
}

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    let channels = only_channel(channel)?;
    let heights = array(bytes).map_err(|defect| Fault::defect("npy", defect))?;
    Ok(Scan {
        format: "npy",
        channel: channels[0].clone(),
        channels,
        pitch: None,
        heights,
        unit: LengthUnit::Metres,
    })
}

fn array(bytes: &[u8]) -> std::result::Result<Field, Defect> {
    vet_header(bytes)?;
    let mut data = bytes;
    let header = NpyHeader::from_reader(&mut data).map_err(container)?;
    let &[nx, ny] = header.shape() else {
        let found = format!("{}-dimensional", header.shape().len());
        return Err(Defect::Value { what: "the array", found, expected: "2-dimensional" });
    };
    let found = header.dtype().descr();
    let unreadable = Defect::Value { what: "the array's type", found, expected: "real numbers" };
    let DType::Plain(number) = header.dtype() else { return Err(unreadable) };
    let cells = cells(&[nx, ny])?;
    if cells == 0 {
        return Err(Defect::Value {
            what: "the array",
            found: format!("{nx} × {ny}"),
            expected: "not empty",
        });
    }
    let expected = (cells as u64).saturating_mul(number.size_field());
    if data.len() as u64 != expected {
        return Err(Defect::Length { what: "the array", expected, found: data.len() as u64 });
    }
    let order = if number.endianness() == Endianness::Big { Order::Big } else { Order::Little };
    let number = match (number.type_char(), number.size_field()) {
        (TypeChar::Float, 8) => Number::Float64,
        (TypeChar::Float, 4) => Number::Float32,
        (TypeChar::Int, 1) => Number::Int8,
        (TypeChar::Int, 2) => Number::Int16,
        (TypeChar::Int, 4) => Number::Int32,
        (TypeChar::Int, 8) => Number::Int64,
        (TypeChar::Uint, 1) => Number::Uint8,
        (TypeChar::Uint, 2) => Number::Uint16,
        (TypeChar::Uint, 4) => Number::Uint32,
        (TypeChar::Uint, 8) => Number::Uint64,
        _ => return Err(unreadable),
    };
    let raster = Raster::new([nx as usize, ny as usize], number, order, data)?;
    Ok(match header.order() {
        npyz::Order::C => raster.heights_with_y_fastest(|height| height),
        npyz::Order::Fortran => raster.heights(|height| height),
    })
}

fn container(error: std::io::Error) -> Defect {
    Defect::Container(error.to_string())
}

/// Refuses headers on which the decoder would overflow: those nested too deeply, or too large in their product.
fn vet_header(bytes: &[u8]) -> std::result::Result<(), Defect> {
    let little = |range: std::ops::Range<usize>| {
        let bytes = bytes.get(range)?;
        Some(bytes.iter().rev().fold(0u64, |number, byte| number << 8 | u64::from(*byte)))
    };
    let (start, length): (usize, _) = match bytes.get(6) {
        Some(1) => (10, little(8..10)),
        _ => (12, little(8..12)),
    };
    let header =
        length.and_then(|length| bytes.get(start..start.checked_add(usize::try_from(length).ok()?)?));
    let Some(header) = header else {
        let expected = length.map_or(start as u64, |length| length.saturating_add(start as u64));
        return Err(Defect::Length { what: "the header", expected, found: bytes.len() as u64 });
    };
    let unusual = Defect::Value {
        what: "the header",
        found: String::from_utf8_lossy(&header[..header.len().min(80)]).trim_end().to_owned(),
        expected: "that of a 2-dimensional array",
    };
    let (mut depth, mut quote, mut number, mut product) = (0i32, None, None::<u128>, 1u128);
    for &byte in header {
        if let Some(open) = quote {
            if byte == b'\\' {
                return Err(unusual);
            }
            quote = (byte != open).then_some(open);
            continue;
        }
        if byte.is_ascii_digit() {
            number = Some(number.unwrap_or(0).saturating_mul(10).saturating_add(u128::from(byte - b'0')));
            continue;
        }
        product = product.saturating_mul(number.take().unwrap_or(1).max(1));
        match byte {
            b'\'' | b'"' => quote = Some(byte),
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => depth -= 1,
            b',' | b':' | b' ' | b'\n' => {}
            // Of True and False.
            _ if b"TrueFals".contains(&byte) => {}
            _ => return Err(unusual),
        }
        if !(0..=4).contains(&depth) {
            return Err(unusual);
        }
    }
    if product > 1 << 60 {
        return Err(Defect::TooLarge { cells: product, limit: super::MAX_CELLS });
    }
    Ok(())
}
