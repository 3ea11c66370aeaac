//! TIFF: images with one number per pixel; read only.
//!
//! Format: "TIFF, Revision 6.0" and BigTIFF, plain or compressed by LZW or deflate. Lines run along x.
//! Floating-point numbers are heights in metres. Integers are levels, whose height is not in the file. There
//! is no pitch, because resolutions are those of a print. Each page is a channel. A missing height is NaN, or
//! the number that the tag of GDAL (42113) gives. Images of JPK, of Park Systems and of an Olympus LEXT are
//! refused: their pages are no heights without their private tags.

use std::io::Cursor;

use tiff::ColorType;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

use super::binary::shape;
use super::foreign::{Foreign, maker_of_tiff};
use super::{Decoded, Fault, LengthUnit, ONLY_CHANNEL, Scan, choose, finite, x_fastest};
use asperity_base::error::Defect;
use asperity_base::grid::Field;

/// Possible first bytes of the file: either byte order, with offsets of 32 or 64 bits.
pub(super) const MAGICS: [&[u8]; 4] = [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"];

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    let fault = |defect| Fault::defect("tiff", defect);
    let mut file = open(bytes).map_err(fault)?;
    let mut pages = 1;
    loop {
        if let Some(maker) = maker(&mut file) {
            return Err(Fault::NotATopography(maker));
        }
        if !file.more_images() {
            break;
        }
        file.next_image().map_err(container).map_err(fault)?;
        pages += 1;
    }
    let channels: Vec<_> = match pages {
        1 => vec![ONLY_CHANNEL.to_owned()],
        _ => (1..=pages).map(|page| format!("{ONLY_CHANNEL} {page}")).collect(),
    };
    let page = choose(&channels, channel)?;
    let (heights, unit) = heights(bytes, page).map_err(fault)?;
    let channel = channels[page].clone();
    Ok(Scan { format: "tiff", channel, channels, pitch: None, heights, unit, lines: None })
}

/// Returns the maker of an instrument whose heights, or their scale, are in private tags of a page.
fn maker(file: &mut File<'_>) -> Option<Foreign> {
    let tags: Vec<u16> = file.tag_iter().flatten().map(|(tag, _)| tag.to_u16()).collect();
    let description = file.get_tag_ascii_string(Tag::ImageDescription).unwrap_or_default();
    maker_of_tiff(|tag| tags.contains(&tag), &description)
}

type File<'a> = Decoder<Cursor<&'a [u8]>>;

fn open(bytes: &[u8]) -> Result<File<'_>, Defect> {
    vet_first_directory(bytes)?;
    // A code of LZW, 12 bits, expands to at most 4094 bytes; deflate expands less.
    let most = bytes.len().saturating_mul(4096);
    let mut limits = Limits::default();
    limits.decoding_buffer_size = most;
    limits.intermediate_buffer_size = most;
    Ok(Decoder::new(Cursor::new(bytes)).map_err(container)?.with_limits(limits))
}

/// Rejects entries of the first directory with more values than the file contains: the decoder reads them
/// before a limit can be set.
fn vet_first_directory(bytes: &[u8]) -> Result<(), Defect> {
    let little = bytes.starts_with(b"I");
    let number = |at: u64, size: u64| -> Option<u64> {
        let at = usize::try_from(at).ok()?;
        let digits = bytes.get(at..at.checked_add(size as usize)?)?;
        let append = |number: u64, digit: &u8| number << 8 | u64::from(*digit);
        Some(if little { digits.iter().rev().fold(0, append) } else { digits.iter().fold(0, append) })
    };
    let is_big = number(2, 2) == Some(43);
    // Number of bytes of an offset or count, of the number of entries, and of an entry.
    let (wide, entries, entry) = if is_big { (8, 8, 20) } else { (4, 2, 12) };
    let Some(directory) = number(wide, wide) else { return Ok(()) };
    let Some(count) = number(directory, entries) else { return Ok(()) };
    for index in 0..count {
        let at = directory.saturating_add(entries).saturating_add(index.saturating_mul(entry));
        // The decoder itself detects values beyond the end of the file.
        let (Some(kind), Some(values)) = (number(at + 2, 2), number(at + 4, wide)) else { return Ok(()) };
        let size = match kind {
            3 | 8 => 2,
            4 | 9 | 11 | 13 => 4,
            5 | 10 | 12 | 16 | 17 | 18 => 8,
            _ => 1,
        };
        let (expected, found) = (values.saturating_mul(size), bytes.len() as u64);
        if expected > found {
            return Err(Defect::Length { what: "the file", expected, found });
        }
    }
    Ok(())
}

fn heights(bytes: &[u8], page: usize) -> Result<(Field, LengthUnit), Defect> {
    let mut file = open(bytes)?;
    for _ in 0..page {
        file.next_image().map_err(container)?;
    }
    let (nx, ny) = file.dimensions().map_err(container)?;
    let shape = shape([nx, ny])?;
    // Levels of less than a byte are not supported.
    let bits = match file.colortype().map_err(container)? {
        ColorType::Gray(bits @ (8 | 16 | 32 | 64)) => bits,
        colour => return Err(unlike_heights(format!("{colour:?}"))),
    };
    let missing = file.get_tag_ascii_string(Tag::GdalNodata).ok();
    let missing = missing.and_then(|text| text.trim_matches(['\0', ' ']).parse().ok()).unwrap_or(f64::NAN);
    match file.read_image().map_err(container)? {
        DecodingResult::F32(pixels) => Ok((turned(shape, &pixels, missing)?, LengthUnit::Metres)),
        DecodingResult::F64(pixels) => Ok((turned(shape, &pixels, missing)?, LengthUnit::Metres)),
        DecodingResult::U8(pixels) => Ok((turned(shape, &pixels, missing)?, LengthUnit::Levels)),
        DecodingResult::U16(pixels) => Ok((turned(shape, &pixels, missing)?, LengthUnit::Levels)),
        DecodingResult::U32(pixels) => Ok((turned(shape, &pixels, missing)?, LengthUnit::Levels)),
        DecodingResult::I8(pixels) => Ok((turned(shape, &pixels, missing)?, LengthUnit::Levels)),
        DecodingResult::I16(pixels) => Ok((turned(shape, &pixels, missing)?, LengthUnit::Levels)),
        DecodingResult::I32(pixels) => Ok((turned(shape, &pixels, missing)?, LengthUnit::Levels)),
        _ => Err(unlike_heights(format!("numbers of {bits} bits"))),
    }
}

fn turned<T: Copy + Into<f64>>(shape: [usize; 2], pixels: &[T], missing: f64) -> Result<Field, Defect> {
    if pixels.len() != shape[0] * shape[1] {
        return Err(Defect::Missing("height for each pixel"));
    }
    Ok(x_fastest(shape, |first, heights| {
        for (height, pixel) in heights.iter_mut().zip(&pixels[first..]) {
            let pixel = (*pixel).into();
            *height = if pixel == missing { f64::NAN } else { finite(pixel) };
        }
    }))
}

fn unlike_heights(found: String) -> Defect {
    let expected = "one number per pixel, floating point of 32 or 64 bits or an integer of 8, 16 or 32";
    Defect::Value { what: "the kind of pixels", found, expected }
}

fn container(error: tiff::TiffError) -> Defect {
    Defect::Container(error.to_string())
}
