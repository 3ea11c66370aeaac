//! Text: a matrix of heights in metres, or a table of x, y and height; read only.
//!
//! - A **matrix** has a line for each ix and a value for each iy: `heights[ix, iy]`, as written by `numpy.savetxt`. It has
//!   no pitch. (Transpose a file whose lines run along x.)
//! - A **table** (`xyz`) has three values per line: x, y and height, all in metres. It differs from a matrix by its x and
//!   y, which must form a regular grid of at least 2 × 2 points, in any order, each to a quarter of the pitch. It has a
//!   pitch. Missing points are missing heights.
//! - A line scan (x and height, or x, y and height along a line) and points on no grid are rejected if they can be
//!   distinguished from a matrix: by uniformly spaced or ordered positions beside heights that are not.
//! - Values are separated by semicolons, tabs, commas or white space, as in the first line of values. If commas do not
//!   separate, they may be decimal commas. A separator may end every line.
//! - Missing heights: nothing between separators, `nan`, `na`, `n/a`, `null`, `bad`, `-`, `--`, or asterisks.
//! - Empty lines, and lines that start with `#` or `%`, are skipped. Lines end with LF or CR LF.

use ndarray::{Axis, Slice};

use super::points::{Raster, raster, refuse_points};
use super::words::excerpt;
use super::{Decoded, Fault, LengthUnit, MAX_CELLS, Scan, only_channel};
use crate::error::Defect;
use crate::grid::Field;

pub(super) fn decode(bytes: &[u8], channel: Option<&str>) -> Decoded {
    let channels = only_channel(channel)?;
    let fault = |defect| Fault::defect("text", defect);
    let heights = matrix(bytes, 0).map_err(fault)?;
    let points = if heights.ncols() == 3 { raster(&heights, 2) } else { None };
    let (format, pitch, heights, unit) = match points {
        Some(Raster { pitch, heights }) => ("xyz", Some(pitch), heights, LengthUnit::MetresThroughout),
        None => {
            refuse_points(&heights).map_err(fault)?;
            ("text", None, heights, LengthUnit::Metres)
        }
    };
    Ok(Scan { format, channel: channels[0].clone(), channels, pitch, heights, unit })
}

/// Reads the lines of values in `bytes`, which follow `lines_before` others in the file.
pub(super) fn matrix(bytes: &[u8], lines_before: usize) -> Result<Field, Defect> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut values = Vec::new();
    let mut columns = 0;
    let mut separator = None;
    let mut rows_that_end_with_nothing = 0;
    for (index, line) in bytes.split(|byte| *byte == b'\n').enumerate() {
        if matches!(line.trim_ascii_start().first(), None | Some(b'#' | b'%')) {
            continue;
        }
        let line_number = lines_before + index + 1;
        let Ok(text) = std::str::from_utf8(line) else {
            return Err(Defect::NotANumber {
                line: line_number,
                token: excerpt(&String::from_utf8_lossy(line)),
            });
        };
        let separator = *separator.get_or_insert_with(|| Separator::of(text));
        let before = values.len();
        let mut token = "";
        for next in separator.split(text) {
            token = next.trim();
            let value = value(token, separator)
                .ok_or_else(|| Defect::NotANumber { line: line_number, token: excerpt(token) })?;
            values.push(value);
        }
        rows_that_end_with_nothing += usize::from(token.is_empty());
        if values.len() > MAX_CELLS {
            return Err(Defect::TooLarge { cells: values.len() as u128, limit: MAX_CELLS });
        }
        let found = values.len() - before;
        if columns == 0 {
            columns = found;
        } else if found != columns {
            return Err(Defect::Ragged { line: line_number, expected: columns, found });
        }
    }
    if columns == 0 {
        return Err(Defect::Missing("values"));
    }
    let shape = [values.len() / columns, columns];
    let matrix = Field::from_shape_vec(shape, values).expect("all rows have the same length");
    // A separator at the end of every line ends it, and does not mean another missing height.
    if columns > 1 && rows_that_end_with_nothing == shape[0] {
        let without_last = matrix.slice_axis(Axis(1), Slice::from(..columns - 1));
        return Ok(without_last.as_standard_layout().into_owned());
    }
    Ok(matrix)
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Separator {
    Semicolon,
    Tab,
    Comma,
    Space,
}

impl Separator {
    /// Determines the separator of the values in `line`.
    fn of(line: &str) -> Self {
        let one_each = |part: &str| part.split_whitespace().count() <= 1;
        if line.contains(';') {
            return Self::Semicolon;
        }
        if line.contains('\t') && line.split('\t').all(one_each) {
            return Self::Tab;
        }
        if !line.contains(',') {
            return Self::Space;
        }
        // `1,5 2,5` has decimal commas, `1, 2` and `1,2` do not.
        let decimal = |token: &str| token.trim_matches(',') == token && token.matches(',').count() <= 1;
        let tokens: Vec<_> = line.split_whitespace().collect();
        if tokens.len() > 1 && !line.contains('.') && tokens.iter().all(|token| decimal(token)) {
            return Self::Space;
        }
        Self::Comma
    }

    fn character(self) -> char {
        match self {
            Self::Semicolon => ';',
            Self::Tab => '\t',
            Self::Comma => ',',
            Self::Space => ' ',
        }
    }

    fn split(self, line: &str) -> Box<dyn Iterator<Item = &str> + '_> {
        match self {
            Self::Space => Box::new(line.split_whitespace()),
            _ => Box::new(line.split(self.character())),
        }
    }
}

fn value(token: &str, separator: Separator) -> Option<f64> {
    let number = match token.split_once(',') {
        Some((whole, fraction)) if separator != Separator::Comma && !token.contains('.') => {
            format!("{whole}.{fraction}").parse()
        }
        _ => token.parse(),
    };
    match number {
        Ok(number) if f64::is_finite(number) || f64::is_nan(number) => Some(number),
        _ => is_missing(token).then_some(f64::NAN),
    }
}

fn is_missing(token: &str) -> bool {
    const WORDS: [&str; 7] = ["", "na", "n/a", "null", "bad", "-", "--"];
    token.bytes().all(|byte| byte == b'*') || WORDS.iter().any(|word| token.eq_ignore_ascii_case(word))
}
