//! Text of a case file and the places of its keys.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use asperity_base::error::{CaseError, Error};

/// The text and the places that an error needs to show its own place.
#[derive(Debug, Clone, Default)]
pub(crate) struct Document {
    /// Name of the kind of file: "the case".
    noun: &'static str,
    file: PathBuf,
    text: String,
    /// Places of values and of headers of tables, by dotted key.
    spans: BTreeMap<String, Range<usize>>,
}

impl Document {
    pub(super) fn new(file: PathBuf, text: &str) -> Self {
        Self::named("the case", file, text)
    }

    /// Creates the document of a file called `noun` in messages.
    pub(crate) fn named(noun: &'static str, file: PathBuf, text: &str) -> Self {
        Self { noun, file, text: text.to_owned(), spans: BTreeMap::new() }
    }

    pub(super) fn text(&self) -> &str {
        &self.text
    }

    pub(super) fn noun(&self) -> &'static str {
        self.noun
    }

    /// Parses the text, and stores the place of each key.
    pub(crate) fn parse<'i>(&mut self, text: &'i str) -> Result<Spanned<DeTable<'i>>, Error> {
        let root = DeTable::parse(text).map_err(|error| {
            let quotes = error.message().contains("must be quoted");
            let hint = quotes.then(|| "a quantity with a unit is a string: `\"210 GPa\"`".to_owned());
            self.error("", error.span().unwrap_or_default(), error.message(), hint)
        })?;
        self.note(root.get_ref(), "");
        Ok(root)
    }

    fn note(&mut self, table: &DeTable<'_>, path: &str) {
        for (key, value) in table {
            let path = join(path, key.get_ref());
            self.spans.insert(path.clone(), value.span());
            match value.get_ref() {
                DeValue::Table(table) => self.note(table, &path),
                DeValue::Array(items) => self.note_items(items, &path),
                _ => {}
            }
        }
    }

    /// Stores the tables of an array of tables: `path.0`, `path.1`, …
    fn note_items(&mut self, items: &DeArray<'_>, path: &str) {
        for (n, item) in items.iter().enumerate() {
            if let DeValue::Table(table) = item.get_ref() {
                let path = join(path, &n.to_string());
                self.spans.insert(path.clone(), item.span());
                self.note(table, &path);
            }
        }
    }

    /// Returns the dotted keys of the file with the texts of their values.
    pub(crate) fn values(&self) -> impl Iterator<Item = (&str, String)> {
        self.spans.iter().map(|(key, span)| (key.as_str(), self.written(span.clone())))
    }

    /// Whether the file has a key or a table of this dotted name.
    pub(super) fn has(&self, key: &str) -> bool {
        self.spans.contains_key(key)
    }

    pub(super) fn written(&self, span: Range<usize>) -> String {
        let text = self.text.get(span).unwrap_or_default();
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    }

    /// Returns the place of a key or, if the file does not contain it, of the table that would.
    pub(super) fn place(&self, key: &str) -> Range<usize> {
        let mut key = key;
        loop {
            if let Some(span) = self.spans.get(key) {
                return span.clone();
            }
            match key.rsplit_once('.') {
                Some((table, _)) => key = table,
                None => return 0..0,
            }
        }
    }

    /// Creates an error at a dotted key, or at the table that would contain it.
    pub(crate) fn error_at(&self, key: &str, message: impl Into<String>, hint: Option<String>) -> Error {
        self.error(key, self.place(key), message, hint)
    }

    pub(crate) fn error(
        &self,
        key: &str,
        span: Range<usize>,
        message: impl Into<String>,
        hint: Option<String>,
    ) -> Error {
        let mut start = span.start.min(self.text.len());
        while !self.text.is_char_boundary(start) {
            start -= 1;
        }
        let before = &self.text[..start];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        Error::Case(Box::new(CaseError {
            file: self.file.clone(),
            text: self.text.clone(),
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
            span,
            key: key.to_owned(),
            message: message.into(),
            hint,
        }))
    }
}

pub(crate) fn join(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") }
}
