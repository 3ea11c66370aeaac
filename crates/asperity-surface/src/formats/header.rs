//! Text headers: lines of a name and a value.

use std::collections::HashMap;

use super::words::{excerpt, unit_of_length};
use asperity_base::error::Defect;
use asperity_base::units::Metre;

/// Lines of a header, by their names in lower case.
pub(super) struct Header<'a>(HashMap<String, &'a str>);

impl<'a> Header<'a> {
    /// Reads the lines of `text` with a name before the first `separator`; a `#` before the name is skipped.
    pub(super) fn new(text: &'a str, separator: char) -> Self {
        let lines = text.lines().filter_map(|line| line.trim_start_matches('#').split_once(separator));
        Self(lines.map(|(name, value)| (name.trim().to_ascii_lowercase(), before_comment(value))).collect())
    }

    /// Returns the value of `name`, in any case, up to a comment after a semicolon.
    pub(super) fn get(&self, name: &str) -> Option<&'a str> {
        self.0.get(&name.to_ascii_lowercase()).copied()
    }

    pub(super) fn number(&self, name: &'static str) -> Result<f64, Defect> {
        let found = self.get(name).ok_or(Defect::Missing(name))?;
        let number = found.parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| Defect::Value { what: name, found: excerpt(found), expected: "a number" })
    }

    /// Returns a number and its unit, such as `10.0 µm`.
    pub(super) fn quantity(&self, name: &'static str) -> Result<(f64, &'a str), Defect> {
        let found = self.get(name).ok_or(Defect::Missing(name))?;
        let quantity =
            found.split_once(' ').and_then(|(number, unit)| Some((number.parse().ok()?, unit.trim())));
        let expected = "a length with its unit";
        quantity.ok_or_else(|| Defect::Value { what: name, found: excerpt(found), expected })
    }

    /// Returns a length with its unit.
    pub(super) fn length(&self, name: &'static str) -> Result<Metre, Defect> {
        let (number, unit) = self.quantity(name)?;
        Ok(number * unit_of_length(unit)?)
    }

    /// Returns a number of heights.
    pub(super) fn size(&self, name: &'static str) -> Result<u32, Defect> {
        let found = self.get(name).ok_or(Defect::Missing(name))?;
        let unusable = || Defect::Value { what: name, found: excerpt(found), expected: "at least 1" };
        found.parse().map_err(|_| unusable())
    }
}

/// Splits `text` into the sections that begin with a line `[name]`.
pub(super) fn sections(text: &str) -> Vec<(&str, &str)> {
    let mut sections = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        start += line.len();
        if let Some(name) = line.trim().strip_prefix('[').and_then(|line| line.strip_suffix(']')) {
            sections.push((name, start - line.len(), start));
        }
    }
    let ends = sections.iter().skip(1).map(|(_, line, _)| *line).chain([text.len()]);
    sections.iter().zip(ends).map(|((name, _, start), end)| (*name, &text[*start..end])).collect()
}

/// Returns a value up to a comment after a semicolon.
pub(super) fn before_comment(value: &str) -> &str {
    value.split(';').next().unwrap_or_default().trim()
}
