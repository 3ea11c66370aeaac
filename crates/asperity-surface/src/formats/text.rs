//! Text: a matrix of heights, a table of x, y and height, or a profile of x and height, in metres; read only.
//!
//! - In a **matrix** a line of the file lies along x, and the first line at y = 0, as instruments and Gwyddion export it. A
//!   single column is a profile along x. The matrix has no pitch unless the words above it or its labels give one.
//! - A **table** (`xyz`) has three values per line: x, y and height, all in metres. It differs from a matrix by its x and
//!   y, which must form a regular grid of at least 2 × 2 points, in any order, each to a quarter of the pitch. It has a
//!   pitch. Missing points are missing heights.
//! - A **profile** (`xz`) has two values per line: x and height, evenly spaced, three lines at least.
//! - Other narrow tables of many lines look like points on no grid, and are rejected unless the options call them a matrix.
//! - **Words** may stand above the numbers, see [`preamble`](super::preamble), and **labels** above and beside a matrix, see
//!   [`labels`](super::labels).
//! - Values are separated by semicolons, tabs, commas or white space, as in the first line of values. If commas do not
//!   separate, they may be decimal commas. A separator may end every line. Values may be quoted.
//! - Missing heights: nothing between separators, `nan`, `na`, `n/a`, `null`, `bad`, `-`, `--`, or asterisks.
//! - Empty lines, and lines that start with `#` or `%`, are skipped. Lines end with LF or CR LF.

use super::labels::{Unlabelled, refuse_lone_labels};
use super::numbers::{Part, matrix};
use super::points::{Points, Raster, points};
use super::preamble::{Preamble, later_matrix};
use super::{Decoded, Fault, LengthUnit, ReadOptions, Scan, csv, only_channel, usable_pitch, x_fastest};
use crate::Axis;
use asperity_base::error::Defect;
use asperity_base::grid::Field;

pub(super) fn decode(part: Part<'_>, options: &ReadOptions) -> Decoded {
    let fault = |defect| Fault::defect("text", defect);
    let preamble = Preamble::read(part).map_err(fault)?;
    if let Some(names) = &preamble.names {
        return csv::table(names, preamble.numbers, options.channel.as_deref());
    }
    let channels = only_channel(options.channel.as_deref())?;
    let Content { format, pitch, mut heights, lines } =
        content(&preamble, options.lines.is_some()).map_err(fault)?;
    let words = &preamble.words;
    let pitch = words.pitch.or(pitch);
    let unit = match (words.height_unit, words.lateral_unit, pitch) {
        (Some(_), ..) => LengthUnit::Known,
        (None, None, Some(_)) => LengthUnit::MetresThroughout,
        (None, ..) => LengthUnit::Metres,
    };
    let lateral = match unit {
        LengthUnit::MetresThroughout => Some(1.0),
        _ => words.lateral_unit,
    };
    if let Some(factor) = words.height_unit {
        heights.mapv_inplace(|height| height * factor);
    }
    let pitch = pitch.zip(lateral).and_then(|(pitch, factor)| usable_pitch(pitch.map(|p| p * factor)));
    Ok(Scan { format, channel: channels[0].clone(), channels, pitch, heights, unit, lines })
}

struct Content {
    format: &'static str,
    /// In the unit of the numbers.
    pitch: Option<[f64; 2]>,
    heights: Field,
    lines: Option<Axis>,
}

/// Reads the numbers below a preamble. If the options call them a matrix, they are neither points nor a
/// profile.
fn content(preamble: &Preamble<'_>, is_matrix: bool) -> Result<Content, Defect> {
    let numbers = preamble.numbers;
    let lines = match matrix(numbers, preamble.has_labels) {
        Err(defect) if preamble.starts_with_numbers => {
            return Err(later_matrix(numbers).unwrap_or(defect));
        }
        lines => lines?,
    };
    let Unlabelled { matrix, pitch, had_labels } = Unlabelled::from_lines(lines, preamble)?;
    if !is_matrix && !had_labels {
        match points(&matrix)? {
            Some(Points::Map(Raster { pitch, heights })) => {
                return Ok(Content { format: "xyz", pitch: Some(pitch), heights, lines: None });
            }
            Some(Points::Profile(Raster { pitch, heights })) => {
                return Ok(Content { format: "xz", pitch: Some(pitch), heights, lines: None });
            }
            None => refuse_lone_labels(&matrix, preamble)?,
        }
    }
    let (ny, nx) = matrix.dim();
    let along_y = match preamble.words.sizes {
        Some(sizes) if sizes == [nx, ny] => false,
        Some(sizes) if sizes == [ny, nx] => true,
        Some(_) => {
            let found = format!("{nx} × {ny}");
            let expected = "of the size in the words above it";
            return Err(Defect::Value { what: "the matrix", found, expected });
        }
        None => nx == 1,
    };
    let (heights, lines) = if along_y {
        (matrix, Axis::Y)
    } else {
        let numbers = matrix.as_slice().expect("lines are in standard layout");
        let along_x = |first: usize, part: &mut [f64]| part.copy_from_slice(&numbers[first..][..part.len()]);
        (x_fastest([nx, ny], along_x), Axis::X)
    };
    Ok(Content { format: "text", pitch, heights, lines: Some(lines) })
}
