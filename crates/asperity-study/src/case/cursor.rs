//! A table and an entry of a case file, each with its place, to report mistakes there.

use std::ops::Range;

use toml::de::{DeTable, DeValue};

use super::document::{Document, join};
use asperity_base::choice::did_you_mean;
use asperity_base::error::{Error, Result};
use asperity_base::units::{self, Dimension, MAX_COUNT, NUMBERS};

/// A table `[path]`.
pub(crate) struct Table<'a> {
    document: &'a Document,
    path: String,
    span: Range<usize>,
    entries: &'a DeTable<'a>,
}

impl<'a> Table<'a> {
    pub(crate) fn root(document: &'a Document, entries: &'a DeTable<'a>) -> Self {
        Self { document, path: String::new(), span: 0..0, entries }
    }

    pub(crate) fn get(&self, key: &str) -> Option<Entry<'a>> {
        let value = self.entries.get(key)?;
        Some(Entry {
            document: self.document,
            path: join(&self.path, key),
            span: value.span(),
            value: value.get_ref(),
        })
    }

    /// Returns all entries, in the order of the file.
    pub(crate) fn entries(&self) -> Vec<(&'a str, Entry<'a>)> {
        let mut entries: Vec<_> = self
            .entries
            .keys()
            .filter_map(|key| Some((&**key.get_ref(), self.get(key.get_ref())?)))
            .collect();
        entries.sort_by_key(|(_, entry)| entry.span.start);
        entries
    }

    /// Returns a required entry; `example` is a value for it.
    pub(crate) fn required(&self, key: &str, example: &str) -> Result<Entry<'a>> {
        let hint = || Some(format!("for example `{key} = {example}`"));
        self.get(key).ok_or_else(|| self.error(format!("missing key '{key}' in {}", self.name()), hint()))
    }

    pub(crate) fn table(&self, key: &str) -> Result<Option<Table<'a>>> {
        self.get(key).map(Entry::table).transpose()
    }

    pub(super) fn required_table(&self, key: &str) -> Result<Table<'a>> {
        self.table(key)?.ok_or_else(|| self.missing_table(key))
    }

    pub(super) fn missing_table(&self, key: &str) -> Error {
        let path = join(&self.path, key);
        self.document.error(&path, self.span.clone(), format!("missing table [{path}]"), None)
    }

    /// Returns an error unless every key is among `known`. `elsewhere` explains a key that belongs to another
    /// table.
    pub(crate) fn known(
        &self,
        known: &[&str],
        elsewhere: impl Fn(&str) -> Option<(String, Option<String>)>,
    ) -> Result<()> {
        let unknown = self.entries.keys().filter(|key| !known.contains(&&**key.get_ref()));
        let Some(key) = unknown.min_by_key(|key| key.span().start) else { return Ok(()) };
        let name = key.get_ref();
        let (message, hint) = elsewhere(name).unwrap_or_else(|| {
            let hint = known_by_symbol(name, known).or_else(|| did_you_mean(name, known.iter().copied()));
            (format!("unknown key '{name}' in {}", self.name()), hint)
        });
        Err(self.document.error(&join(&self.path, name), key.span(), message, hint))
    }

    /// Returns the one of `keys` that is given.
    pub(super) fn exactly_one(&self, keys: &[&'static str], hint: &str) -> Result<&'static str> {
        let mut given: Vec<_> =
            keys.iter().filter_map(|key| self.get(key).map(|entry| (*key, entry))).collect();
        given.sort_by_key(|(_, entry)| entry.span.start);
        match given.as_slice() {
            [(key, _)] => Ok(key),
            [] if keys.len() == 1 => {
                Err(self
                    .error(format!("missing key '{}' in {}", keys[0], self.name()), Some(hint.to_owned())))
            }
            [] => Err(self.error(
                format!("{} names none of {}, expected one", self.name(), list(keys)),
                Some(hint.to_owned()),
            )),
            [(first, _), (second, entry), ..] => Err(entry.error(
                format!("both '{first}' and '{second}' are given, expected one of {}", list(keys)),
                Some(hint.to_owned()),
            )),
        }
    }

    pub(crate) fn error(&self, message: String, hint: Option<String>) -> Error {
        self.document.error(&self.path, self.span.clone(), message, hint)
    }

    pub(super) fn name(&self) -> String {
        if self.path.is_empty() { self.document.noun().to_owned() } else { format!("[{}]", self.path) }
    }

    pub(super) fn path(&self) -> &str {
        &self.path
    }
}

/// A key with its value.
#[derive(Clone)]
pub(crate) struct Entry<'a> {
    document: &'a Document,
    path: String,
    span: Range<usize>,
    value: &'a DeValue<'a>,
}

impl<'a> Entry<'a> {
    pub(crate) fn error(&self, message: String, hint: Option<String>) -> Error {
        self.document.error(&self.path, self.span.clone(), message, hint)
    }

    /// Error `'passes' is 0, expected …`, with the value as written in the file.
    pub(crate) fn unexpected(&self, expected: &str, hint: Option<String>) -> Error {
        self.error(format!("'{}' is {}, expected {expected}", self.key(), self.written()), hint)
    }

    /// The value as written in the file.
    pub(super) fn written(&self) -> String {
        match self.value {
            DeValue::Table(_) => "a table".to_owned(),
            _ => self.document.written(self.span.clone()),
        }
    }

    /// Dotted name of the key.
    pub(super) fn path(&self) -> &str {
        &self.path
    }

    /// Place of the value.
    pub(crate) fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// Returns the value as it is, of any type.
    ///
    /// # Errors
    /// If it is a whole number beyond ±2⁶³.
    pub(crate) fn literal(&self) -> Result<toml::Value> {
        literal(self.value).ok_or_else(|| self.unexpected("whole numbers within ±2⁶³", None))
    }

    fn wrong_type(&self, expected: &str) -> Error {
        let found = match self.value {
            DeValue::String(_) => "a string",
            DeValue::Integer(_) | DeValue::Float(_) => "a number",
            DeValue::Boolean(_) => "a boolean",
            DeValue::Datetime(_) => "a date",
            DeValue::Array(_) => "an array",
            DeValue::Table(_) => "a table",
        };
        self.error(format!("'{}' is {found}, expected {expected}", self.key()), None)
    }

    pub(crate) fn key(&self) -> &str {
        self.path.rsplit('.').next().unwrap_or_default()
    }

    pub(crate) fn table(self) -> Result<Table<'a>> {
        match self.value {
            DeValue::Table(entries) => {
                // The path of an item of an array of tables has brackets.
                let path = self.path.replace(['[', ']'], "");
                Ok(Table { document: self.document, path, span: self.span, entries })
            }
            _ => Err(self.wrong_type(&format!("a table [{}]", self.path))),
        }
    }

    /// Returns the tables of an array of tables.
    pub(crate) fn tables(&self) -> Result<Vec<Table<'a>>> {
        let expected = format!("tables [[{}]]", self.path);
        let DeValue::Array(items) = self.value else { return Err(self.wrong_type(&expected)) };
        let table = |item: &'a toml::Spanned<DeValue<'a>>| match item.get_ref() {
            DeValue::Table(entries) => Ok(Table {
                document: self.document,
                path: format!("[{}]", self.path),
                span: item.span(),
                entries,
            }),
            _ => Err(self.wrong_type(&expected)),
        };
        items.iter().map(table).collect()
    }

    pub(crate) fn is_array(&self) -> bool {
        matches!(self.value, DeValue::Array(_))
    }

    pub(crate) fn is_table(&self) -> bool {
        matches!(self.value, DeValue::Table(_))
    }

    pub(crate) fn text(&self) -> Result<&'a str> {
        self.value.as_str().ok_or_else(|| self.wrong_type("a string"))
    }

    /// Returns the number of a TOML number, infinities included.
    fn plain(&self) -> Option<Result<f64>> {
        let not_finite = || self.unexpected("a finite number", None);
        match self.value {
            DeValue::Integer(digits) => {
                Some(i64::from_str_radix(digits.as_str(), digits.radix()).map(|i| i as f64).map_err(|_| {
                    self.unexpected("a number within ±2⁶³", Some("write it as a float".to_owned()))
                }))
            }
            DeValue::Float(digits) => Some(match digits.as_str().parse::<f64>() {
                Ok(value) if value.is_finite() || digits.as_str().ends_with("inf") => Ok(value),
                _ => Err(not_finite()),
            }),
            _ => None,
        }
    }

    /// Returns a number without a unit.
    pub(crate) fn number(&self, good: impl Fn(f64) -> bool, expected: &str) -> Result<f64> {
        self.number_or_infinite(|value| value.is_finite() && good(value), expected)
    }

    /// Returns a number with a magnitude within `range`, for a constant whose unit has no name; 0 only if
    /// `zero`.
    pub(super) fn number_within(&self, range: units::Range, zero: bool) -> Result<f64> {
        let expected = format!("{}a magnitude of {range}", if zero { "0, or " } else { "" });
        let value = self.plain().unwrap_or_else(|| Err(self.wrong_type(&expected)))?;
        let value = if zero { range.without_dust(value) } else { value };
        let good = range.holds(value) || (zero && value == 0.0);
        if good { Ok(value) } else { Err(self.unexpected(&expected, None)) }
    }

    /// Returns a number without a unit, or infinity. A number below the smallest magnitude is 0 if 0 is good.
    pub(super) fn number_or_infinite(&self, good: impl Fn(f64) -> bool, expected: &str) -> Result<f64> {
        let value = match self.value.as_str() {
            Some("inf") => f64::INFINITY,
            _ => self.plain().unwrap_or_else(|| Err(self.wrong_type(expected)))?,
        };
        let value = if good(0.0) { NUMBERS.without_dust(value) } else { value };
        match value {
            value if !good(value) => Err(self.unexpected(expected, None)),
            value if value.is_infinite() || NUMBERS.holds_signed(value) => Ok(value),
            _ => Err(self.beyond(NUMBERS)),
        }
    }

    /// Returns a quantity, SI, from a number or a string with a unit. Infinities are left to the caller.
    fn any_quantity(&self, dimension: Dimension) -> Result<f64> {
        if let Some(number) = self.plain() {
            return number;
        }
        let Some(text) = self.value.as_str() else {
            return Err(self.wrong_type(&format!(
                "{} such as \"{}\"",
                dimension.noun(),
                dimension.example()
            )));
        };
        units::parse(text, dimension).map_err(|error| self.error(error.for_key(self.key()), error.hint()))
    }

    /// Returns a finite quantity, 0 for one below the smallest magnitude.
    pub(crate) fn quantity(&self, dimension: Dimension) -> Result<f64> {
        let value = dimension.range().without_dust(self.any_quantity(dimension)?);
        if !value.is_finite() {
            return Err(self.unexpected(&expectation(dimension, ""), None));
        }
        if dimension.range().holds_signed(value) { Ok(value) } else { Err(self.beyond(dimension.range())) }
    }

    /// Returns a finite quantity above 0.
    pub(crate) fn positive(&self, dimension: Dimension) -> Result<f64> {
        let value = self.any_quantity(dimension)?;
        if !(value.is_finite() && value > 0.0) {
            return Err(self.unexpected(&expectation(dimension, " above 0"), None));
        }
        if dimension.range().holds(value) { Ok(value) } else { Err(self.beyond(dimension.range())) }
    }

    /// Returns a finite quantity with a magnitude within `range`; 0 only if `zero`. The hint contains the
    /// `example`.
    pub(super) fn within(
        &self,
        dimension: Dimension,
        range: units::Range,
        zero: bool,
        example: &str,
    ) -> Result<f64> {
        let value =
            if zero { range.without_dust(self.quantity(dimension)?) } else { self.positive(dimension)? };
        if range.holds(value) || (zero && value == 0.0) {
            return Ok(value);
        }
        let without_unit = matches!(self.value, DeValue::Integer(_) | DeValue::Float(_));
        let (key, unit) = (self.key(), range.unit);
        let hint = without_unit.then(|| {
            format!("a number without a unit is in {unit}; with one it is for example `{key} = {example}`")
        });
        let expected = format!("{}a magnitude of {range}", if zero { "0, or " } else { "" });
        Err(self.unexpected(&expected, hint))
    }

    /// Returns the size of a unit, given by its name or as a quantity above 0.
    pub(super) fn unit(&self, dimension: Dimension) -> Result<f64> {
        match self.value.as_str() {
            Some(word) if word.starts_with(char::is_alphabetic) => units::parse_unit(word, dimension)
                .map_err(|error| self.error(error.for_key(self.key()), error.hint())),
            _ => self.positive(dimension),
        }
    }

    /// Returns a quantity above 0, or infinity, which means `infinite`.
    pub(super) fn positive_or_infinite(&self, dimension: Dimension, infinite: &str) -> Result<f64> {
        let value = match self.value.as_str() {
            Some("inf") => f64::INFINITY,
            _ => self.any_quantity(dimension)?,
        };
        match value {
            f64::INFINITY => Ok(value),
            value if dimension.range().holds(value) => Ok(value),
            value if value > 0.0 => Err(self.beyond(dimension.range())),
            _ => {
                let hint = format!("`inf` is {infinite}");
                Err(self.unexpected(&expectation(dimension, " above 0"), Some(hint)))
            }
        }
    }

    /// Error for a magnitude outside the accepted range.
    fn beyond(&self, range: units::Range) -> Error {
        self.unexpected(&format!("a magnitude of {range}"), None)
    }

    /// Returns a whole number of at least `least`.
    pub(crate) fn whole(&self, least: u64) -> Result<u64> {
        let expected = format!("a whole number of at least {least}");
        match self.value {
            DeValue::Integer(digits) => u64::from_str_radix(digits.as_str(), digits.radix())
                .ok()
                .filter(|value| *value >= least)
                .ok_or_else(|| self.unexpected(&expected, None)),
            DeValue::Float(_) => Err(self.unexpected(&expected, None)),
            _ => Err(self.wrong_type(&expected)),
        }
    }

    /// [`whole`](Self::whole) as a `usize`.
    pub(crate) fn count(&self, least: usize) -> Result<usize> {
        match usize::try_from(self.whole(least as u64)?) {
            Ok(count) if count <= MAX_COUNT => Ok(count),
            _ => Err(self.unexpected("a whole number of at most 10⁹", None)),
        }
    }

    pub(super) fn flag(&self) -> Result<bool> {
        match self.value {
            DeValue::Boolean(flag) => Ok(*flag),
            _ => Err(self.wrong_type("true or false")),
        }
    }

    /// Returns an array of exactly `N` entries; `expected` describes them.
    pub(super) fn array<T, const N: usize>(
        &self,
        expected: &str,
        read: impl Fn(&Entry<'a>) -> Result<T>,
    ) -> Result<[T; N]> {
        self.list(expected, read)?.try_into().map_err(|_| self.unexpected(expected, None))
    }

    /// Returns an array of any number of entries; `expected` describes them.
    pub(super) fn list<T>(&self, expected: &str, read: impl Fn(&Entry<'a>) -> Result<T>) -> Result<Vec<T>> {
        self.items(expected)?.iter().map(read).collect()
    }

    /// Returns the entries of an array; `expected` describes them.
    pub(crate) fn items(&self, expected: &str) -> Result<Vec<Entry<'a>>> {
        let DeValue::Array(items) = self.value else { return Err(self.wrong_type(expected)) };
        let entry = |item: &'a toml::Spanned<DeValue<'a>>| Entry {
            document: self.document,
            path: self.path.clone(),
            span: item.span(),
            value: item.get_ref(),
        };
        Ok(items.iter().map(entry).collect())
    }

    /// Returns one value for both x and y, or an array of the two.
    pub(super) fn pair<T: Copy>(
        &self,
        expected: &str,
        read: impl Fn(&Entry<'a>) -> Result<T>,
    ) -> Result<[T; 2]> {
        match self.value {
            DeValue::Array(_) => self.array(expected, read),
            _ => read(self).map(|both| [both; 2]),
        }
    }

    /// Returns a component along x, or an array of two along x and y.
    pub(super) fn vector(&self, expected: &str, read: impl Fn(&Self) -> Result<f64>) -> Result<[f64; 2]> {
        if self.is_array() { self.array(expected, read) } else { read(self).map(|x| [x, 0.0]) }
    }

    /// Returns the index of one of several words. `hint` is about another word.
    pub(super) fn word(&self, words: &[&str], hint: impl Fn(&str) -> Option<String>) -> Result<usize> {
        let quoted = words.iter().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(", ");
        let expected = format!("one of {quoted}");
        let Some(text) = self.value.as_str() else { return Err(self.wrong_type(&expected)) };
        let index = words.iter().position(|word| *word == text);
        index.ok_or_else(|| self.unexpected(&expected, hint(text)))
    }
}

/// Returns a value without its places; `None` for a whole number that is too large.
fn literal(value: &DeValue<'_>) -> Option<toml::Value> {
    Some(match value {
        DeValue::String(text) => toml::Value::String(text.to_string()),
        DeValue::Integer(digits) => {
            toml::Value::Integer(i64::from_str_radix(digits.as_str(), digits.radix()).ok()?)
        }
        DeValue::Float(digits) => toml::Value::Float(digits.as_str().parse().ok()?),
        DeValue::Boolean(flag) => toml::Value::Boolean(*flag),
        DeValue::Datetime(date) => toml::Value::Datetime(*date),
        DeValue::Array(items) => {
            toml::Value::Array(items.iter().map(|item| literal(item.get_ref())).collect::<Option<_>>()?)
        }
        DeValue::Table(entries) => {
            let entry = |(key, value): (&toml::Spanned<_>, &toml::Spanned<DeValue<'_>>)| {
                let key: &std::borrow::Cow<'_, str> = key.get_ref();
                Some((key.to_string(), literal(value.get_ref())?))
            };
            toml::Value::Table(entries.iter().map(entry).collect::<Option<_>>()?)
        }
    })
}

/// Returns the key for a quantity that textbooks write as `symbol`, if the table knows it.
fn known_by_symbol(symbol: &str, known: &[&str]) -> Option<String> {
    const KEYS: [(&[&str], &str); 12] = [
        (&["E", "Y", "youngs_modulus", "modulus"], "young"),
        (&["nu", "ν"], "poisson"),
        (&["H", "HV", "HB"], "hardness"),
        (&["mu", "µ", "μ", "cof"], "coefficient"),
        (&["tau", "τ", "tau_max"], "shear_strength"),
        (&["R", "r"], "radius"),
        (&["W", "P", "F", "Fn", "F_n"], "load"),
        (&["p", "p_mean", "pm"], "mean_pressure"),
        (&["delta", "δ"], "approach"),
        (&["dx", "Δx"], "pitch"),
        (&["Sq", "Rq", "rms", "sigma", "σ"], "sq"),
        (&["lambda", "λ"], "wavelength"),
    ];
    if ["G", "shear_modulus"].contains(&symbol) && known.contains(&"young") {
        return Some("give `young` = 2 G (1 + poisson) for a shear modulus G".to_owned());
    }
    let named = |(symbols, key): &&(&[&str], &str)| symbols.contains(&symbol) && known.contains(key);
    KEYS.iter().find(named).map(|(_, key)| format!("did you mean `{key}`?"))
}

fn expectation(dimension: Dimension, range: &str) -> String {
    format!("{}{range} such as \"{}\"", dimension.noun(), dimension.example())
}

fn list(keys: &[&str]) -> String {
    keys.iter().map(|key| format!("'{key}'")).collect::<Vec<_>>().join(", ")
}
