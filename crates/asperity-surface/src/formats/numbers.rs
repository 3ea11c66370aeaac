//! Lines of numbers in text: their separators, values and missing values.

use ndarray::{Axis, Slice};

use super::MAX_CELLS;
use super::words::excerpt;
use asperity_base::error::Defect;
use asperity_base::grid::Field;

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

/// Reads lines of values, indexed `[line, column]`; `has_labels` if each begins with a word to be left out.
pub(super) fn matrix(part: Part<'_>, has_labels: bool) -> Result<Field, Defect> {
    let mut values = Vec::new();
    let mut columns = 0;
    let mut separator = None;
    let mut rows_that_end_with_nothing = 0;
    for (number, line) in part.lines() {
        let separator = *separator.get_or_insert_with(|| Separator::from_line(line));
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
        let without_last = matrix.slice_axis(Axis(1), Slice::from(..columns - 1));
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
    pub(super) fn from_line(line: &str) -> Self {
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

/// Splits a line of names at semicolons, else at tabs, else at commas, else at white space.
pub(super) fn fields(line: &str) -> impl Iterator<Item = &str> {
    let separators = [Separator::Semicolon, Separator::Tab, Separator::Comma];
    let separator = separators.into_iter().find(|separator| line.contains(separator.character()));
    separator.unwrap_or(Separator::Space).split(line)
}
