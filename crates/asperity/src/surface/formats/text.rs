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

use ndarray::{Axis as Dimension, Slice};

use super::labels::{Unlabelled, refuse_lone_labels};
use super::points::{Points, Raster, points};
use super::preamble::{Preamble, later_matrix};
use super::words::excerpt;
use super::{
    Decoded, Fault, LengthUnit, MAX_CELLS, ReadOptions, Scan, csv, only_channel, usable_pitch, x_fastest,
};
use crate::error::Defect;
use crate::grid::Field;
use crate::surface::Axis;

/// A part of a text, from a line on to the end.
#[derive(Clone, Copy)]
pub(super) struct Part<'a> {
    pub(super) text: &'a str,
    /// Number of lines before.
    pub(super) before: usize,
}

impl<'a> Part<'a> {
    /// Skips lines.
    pub(super) fn after(text: &'a str, lines: usize) -> Self {
        let start = match lines {
            0 => 0,
            _ => text.match_indices('\n').nth(lines - 1).map_or(text.len(), |(end, _)| end + 1),
        };
        Self { text: &text[start..], before: lines }
    }

    /// Skips lines of this part.
    pub(super) fn skip(self, lines: usize) -> Self {
        Self { before: self.before + lines, ..Self::after(self.text, lines) }
    }

    /// The part from a line on, which is counted from 1 in the file.
    pub(super) fn starting_at(self, line: usize) -> Self {
        self.skip(line - 1 - self.before)
    }

    /// The lines with their numbers from 1, without empty lines and comments.
    pub(super) fn lines(self) -> impl Iterator<Item = (usize, &'a str)> {
        let empty = |line: &str| matches!(line.trim_ascii_start().bytes().next(), None | Some(b'#' | b'%'));
        let lines = self.text.split('\n').enumerate();
        lines.filter(move |(_, line)| !empty(line)).map(move |(index, line)| (self.before + index + 1, line))
    }
}

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

/// Reads the numbers below a preamble. If the options call them a matrix, they are neither points nor a profile.
fn content(preamble: &Preamble<'_>, is_matrix: bool) -> Result<Content, Defect> {
    let numbers = preamble.numbers;
    let lines = match matrix(numbers, preamble.has_labels) {
        Err(defect) if preamble.starts_with_numbers => {
            return Err(later_matrix(numbers).unwrap_or(defect));
        }
        lines => lines?,
    };
    let Unlabelled { matrix, pitch, had_labels } = Unlabelled::of(lines, preamble)?;
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
    let (heights, lines) = match along_y {
        true => (matrix, Axis::Y),
        false => {
            let numbers = matrix.as_slice().expect("lines are in standard layout");
            let along_x =
                |first: usize, part: &mut [f64]| part.copy_from_slice(&numbers[first..][..part.len()]);
            (x_fastest([nx, ny], along_x), Axis::X)
        }
    };
    Ok(Content { format: "text", pitch, heights, lines: Some(lines) })
}

/// Reads lines of values, indexed `[line, column]`; `has_labels` if each begins with a word to be left out.
pub(super) fn matrix(part: Part<'_>, has_labels: bool) -> Result<Field, Defect> {
    let mut values = Vec::new();
    let mut columns = 0;
    let mut separator = None;
    let mut rows_that_end_with_nothing = 0;
    for (number, line) in part.lines() {
        let separator = *separator.get_or_insert_with(|| Separator::of(line));
        let before = values.len();
        let mut token = "";
        for next in separator.split(line).skip(usize::from(has_labels)) {
            token = next;
            let value = value(token, separator)
                .ok_or_else(|| Defect::NotANumber { line: number, token: excerpt(token) })?;
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
            return Err(Defect::Ragged { line: number, expected: columns, found });
        }
    }
    if columns == 0 {
        return Err(Defect::Missing("values"));
    }
    let shape = [values.len() / columns, columns];
    let matrix = Field::from_shape_vec(shape, values).expect("all rows have the same length");
    // A separator at the end of every line ends it, and does not mean another missing height.
    if columns > 1 && rows_that_end_with_nothing == shape[0] {
        let without_last = matrix.slice_axis(Dimension(1), Slice::from(..columns - 1));
        return Ok(without_last.as_standard_layout().into_owned());
    }
    Ok(matrix)
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Separator {
    Semicolon,
    Tab,
    Comma,
    Space,
}

impl Separator {
    /// Determines the separator of the values in `line`.
    pub(super) fn of(line: &str) -> Self {
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

    pub(super) fn character(self) -> char {
        match self {
            Self::Semicolon => ';',
            Self::Tab => '\t',
            Self::Comma => ',',
            Self::Space => ' ',
        }
    }

    /// Splits a line into its values, without white space and quotes around them.
    pub(super) fn split(self, line: &str) -> Box<dyn Iterator<Item = &str> + '_> {
        let mut is_quoted = false;
        let outside_quotes = move |character: char, separates: bool| {
            is_quoted ^= character == '"';
            separates && !is_quoted
        };
        match self {
            Self::Space if line.contains('"') => {
                let mut outside_quotes = outside_quotes;
                let parts = line.trim().split(move |c: char| outside_quotes(c, c.is_whitespace()));
                Box::new(parts.filter(|part| !part.is_empty()).map(unquoted))
            }
            Self::Space => Box::new(line.split_whitespace()),
            _ if line.contains('"') => {
                let mut outside_quotes = outside_quotes;
                Box::new(line.split(move |c: char| outside_quotes(c, c == self.character())).map(unquoted))
            }
            _ => Box::new(line.split(self.character()).map(str::trim)),
        }
    }
}

fn unquoted(value: &str) -> &str {
    value.trim().trim_matches('"').trim()
}

/// Returns the number of a value, NaN for a missing one; none for other text.
pub(super) fn value(token: &str, separator: Separator) -> Option<f64> {
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
