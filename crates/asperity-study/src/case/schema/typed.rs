//! Keys with the types of their values.

use std::ops::Deref;

use super::super::cursor::{Entry, Table};
use super::super::document::Document;
use super::{Bounds, Exists, Fallback, Key, Kind};
use asperity_base::choice::Choice;
use asperity_base::error::{Error, Result};
use asperity_base::exists;
use asperity_base::table::{self, expected};

use asperity_base::units::Dimension;
use asperity_contact::material::{self, MATERIALS, NamedMaterial};
use asperity_surface::Axis;

/// A kind of values, with its reader.
#[derive(Clone, Copy)]
pub(in crate::case) struct Value<T> {
    kind: Kind,
    pub(super) read: fn(&Key, &Entry<'_>) -> Result<T>,
    exists: Exists,
}

impl<T> Value<T> {
    /// Declares what exists of the quantity.
    pub(super) const fn exists(self, exists: Exists) -> Self {
        Self { kind: self.kind, read: self.read, exists }
    }
}

/// A key that has a value in every table, if only the default.
pub(in crate::case) struct Typed<T> {
    pub(super) key: Key,
    read: fn(&Key, &Entry<'_>) -> Result<T>,
}

/// A key that may be missing.
pub(in crate::case) struct Optional<T> {
    pub(super) key: Key,
    read: fn(&Key, &Entry<'_>) -> Result<T>,
}

/// A key whose value is a table or an array of tables.
pub(in crate::case) struct Nested {
    pub(super) key: Key,
}

/// A required key.
pub(super) const fn required<T>(
    name: &'static str,
    value: Value<T>,
    example: &'static str,
    text: &'static str,
) -> Typed<T> {
    Typed {
        key: Key { name, kind: value.kind, default: Fallback::Required, example, text, exists: value.exists },
        read: value.read,
    }
}

/// A key with a default value.
pub(super) const fn defaulted<T>(
    name: &'static str,
    value: Value<T>,
    default: &'static str,
    example: &'static str,
    text: &'static str,
) -> Typed<T> {
    let default = Fallback::Value(default);
    Typed {
        key: Key { name, kind: value.kind, default, example, text, exists: value.exists },
        read: value.read,
    }
}

/// An optional key; `absent` describes the behaviour without it.
pub(super) const fn optional<T>(
    name: &'static str,
    value: Value<T>,
    absent: &'static str,
    example: &'static str,
    text: &'static str,
) -> Optional<T> {
    let default = Fallback::Absent(absent);
    Optional {
        key: Key { name, kind: value.kind, default, example, text, exists: value.exists },
        read: value.read,
    }
}

/// A table within the table.
pub(super) const fn table(name: &'static str, default: Fallback, text: &'static str) -> Nested {
    Nested { key: Key { name, kind: Kind::Table, default, example: "", text, exists: Exists::Undeclared } }
}

/// An array of tables within the table.
pub(super) const fn tables(name: &'static str, default: Fallback, text: &'static str) -> Nested {
    Nested { key: Key { name, kind: Kind::Tables, default, example: "", text, exists: Exists::Undeclared } }
}

/// Declares the keys of a section as constants, and the section that holds them all.
macro_rules! section {
    ($tables:expr, $kind:literal; $($name:ident: $type:ty = $declaration:expr;)+) => {
        $(pub(in crate::case) const $name: $type = $declaration;)+

        pub(in crate::case) const SECTION: $crate::case::schema::Section =
            $crate::case::schema::Section {
                tables: $tables,
                kind: $kind,
                keys: &[$($name.key),+],
            };

        #[cfg(test)]
        #[test]
        fn every_key_reads_its_own_example_and_default() {
            $($name.check();)+
        }
    };
}

pub(super) use section;

// How keys are read.

macro_rules! is_a_key {
    ($($name:ident$(<$type:ident>)?),+) => {$(
        impl$(<$type>)? Deref for $name$(<$type>)? {
            type Target = Key;

            fn deref(&self) -> &Key {
                &self.key
            }
        }

        impl$(<$type>)? $name$(<$type>)? {
            /// Returns the entry of the key, if it is given.
            pub(in crate::case) fn entry<'a>(&self, table: &Table<'a>) -> Option<Entry<'a>> {
                table.get(self.key.name)
            }
        }
    )+};
}

is_a_key!(Typed<T>, Optional<T>, Nested);

macro_rules! has_a_value {
    ($($name:ident),+) => {$(
        impl<T> $name<T> {
            /// Returns the entry of a key that must be given.
            pub(in crate::case) fn demand<'a>(&self, table: &Table<'a>) -> Result<Entry<'a>> {
                self.entry(table).ok_or_else(|| missing(&self.key, table))
            }
        }
    )+};
}

has_a_value!(Typed, Optional);

impl<T> Typed<T> {
    /// Returns the value in `table`, or the default.
    pub(in crate::case) fn of(&self, table: &Table<'_>) -> Result<T> {
        match (table.get(self.key.name), self.key.default) {
            (Some(entry), _) => (self.read)(&self.key, &entry),
            (None, Fallback::Value(default)) => Ok(self.value_of(default)),
            (None, _) => Err(missing(&self.key, table)),
        }
    }

    /// Returns the value of a `text` in a declaration.
    fn value_of(&self, text: &str) -> T {
        read_text(&self.key, self.read, text).expect("a value in a declaration is one of the key")
    }
}

impl Optional<f64> {
    /// Returns the value in `table`, or that of a named material; one of them must be given.
    pub(in crate::case) fn of_material(&self, table: &Table<'_>, named: Option<f64>) -> Result<f64> {
        let hint =
            format!("for example `{} = {}`, or `material = \"steel\"`", self.key.name, self.key.example);
        let missing =
            || table.error(format!("missing key '{}' in {}", self.key.name, table.name()), Some(hint));
        self.of(table)?.or(named).ok_or_else(missing)
    }
}

impl<T> Optional<T> {
    /// Returns the value in `table`, if it is given.
    pub(in crate::case) fn of(&self, table: &Table<'_>) -> Result<Option<T>> {
        table.get(self.key.name).map(|entry| (self.read)(&self.key, &entry)).transpose()
    }

    /// Returns the value of a required key in `table`.
    pub(in crate::case) fn required(&self, table: &Table<'_>) -> Result<T> {
        (self.read)(&self.key, &self.demand(table)?)
    }
}

impl Nested {
    /// Returns the table, if it is given.
    pub(in crate::case) fn of<'a>(&self, table: &Table<'a>) -> Result<Option<Table<'a>>> {
        table.table(self.key.name)
    }

    /// Returns a required table.
    pub(in crate::case) fn demand<'a>(&self, table: &Table<'a>) -> Result<Table<'a>> {
        table.required_table(self.key.name)
    }
}

#[cfg(test)]
impl<T> Typed<T> {
    pub(super) fn check(&self) {
        self.value_of(self.key.example);
        if let Fallback::Value(default) = self.key.default {
            self.value_of(default);
        }
    }
}

#[cfg(test)]
impl<T> Optional<T> {
    pub(super) fn check(&self) {
        let example = read_text(&self.key, self.read, self.key.example);
        example.unwrap_or_else(|error| panic!("{}: {error}", self.key.name));
    }
}

#[cfg(test)]
impl Nested {
    pub(super) fn check(&self) {
        assert!(self.key.example.is_empty(), "{} is a table, which has no value", self.key.name);
    }
}

pub(super) fn missing(key: &Key, table: &Table<'_>) -> Error {
    let hint = format!("for example `{} = {}`", key.name, key.example);
    table.error(format!("missing key '{}' in {}", key.name, table.name()), Some(hint))
}

/// Reads a value of the key from text, as in a case file.
fn read_text<T>(key: &Key, read: fn(&Key, &Entry<'_>) -> Result<T>, text: &str) -> Result<T> {
    let text = format!("{} = {text}", key.name);
    let mut document = Document::default();
    let entries = document.parse(&text)?;
    let table = Table::root(&document, entries.get_ref());
    read(key, &table.get(key.name).expect("it has just been written"))
}

// The kinds of values.

/// A quantity.
pub(super) const fn quantity(dimension: Dimension, bounds: Bounds) -> Value<f64> {
    Value {
        kind: Kind::Quantity(dimension, bounds),
        read: |key, entry| real(&key.kind, key, entry),
        exists: Exists::Undeclared,
    }
}

/// A number without a unit.
pub(super) const fn number(bounds: Bounds) -> Value<f64> {
    number_named("a number", bounds)
}

/// A number without a unit, with its own name in messages.
pub(super) const fn number_named(noun: &'static str, bounds: Bounds) -> Value<f64> {
    Value {
        kind: Kind::Number(noun, bounds),
        read: |key, entry| real(&key.kind, key, entry),
        exists: Exists::Undeclared,
    }
}

/// A count within the limits of its key.
pub(super) const COUNT: Value<usize> = Value {
    kind: Kind::Count { least: 0, most: u64::MAX },
    read: |key, entry| count(&key.kind, key, entry),
    exists: Exists::Undeclared,
};

/// The seed of random numbers.
pub(super) const SEED: Value<u64> = Value {
    kind: Kind::Count { least: 0, most: u64::MAX },
    read: |_, entry| entry.whole(0),
    exists: Exists::Undeclared,
};

/// One of the words of an option.
pub(super) const fn choice<T: Choice>() -> Value<T> {
    Value { kind: Kind::Choice(T::NAMES), read: |_, entry| entry.choice(), exists: Exists::Undeclared }
}

/// The name of a material.
pub(super) const MATERIAL_NAME: Value<&'static NamedMaterial> = Value {
    kind: Kind::Choice(material::NAMES),
    read: |_, entry| {
        let names = material::NAMES.iter().copied().zip(MATERIALS).collect::<Vec<_>>();
        entry.word(&names)
    },
    exists: Exists::Undeclared,
};

/// A text.
pub(super) const TEXT: Value<String> =
    Value { kind: Kind::Text, read: |_, entry| entry.text().map(str::to_owned), exists: Exists::Undeclared };

/// One quantity or number for both axes, or two.
pub(super) const fn pair(item: &'static Value<f64>) -> Value<[f64; 2]> {
    let read = |key: &Key, entry: &Entry<'_>| table::Value::pair(entry, key);
    Value { kind: Kind::Pair(&item.kind), read, exists: item.exists }
}

/// Values of a special form, which the documentation describes as `value`.
pub(super) const fn other<T>(
    dimension: Option<Dimension>,
    value: &'static str,
    read: fn(&Key, &Entry<'_>) -> Result<T>,
) -> Value<T> {
    Value { kind: Kind::Other { dimension, value }, read, exists: Exists::Undeclared }
}

/// Reads a count of a `kind`.
pub(super) fn count(kind: &Kind, key: &Key, entry: &Entry<'_>) -> Result<usize> {
    let Kind::Count { least, most } = *kind else { unreachable!("a count is declared as one") };
    let count = entry.count(least as usize)?;
    match count as u64 <= most {
        true => Ok(count),
        false => Err(entry.unexpected(&expected(kind, key), None)),
    }
}

/// Reads a quantity or a number of a `kind`.
pub(in crate::case) fn real(kind: &Kind, key: &Key, entry: &Entry<'_>) -> Result<f64> {
    match *kind {
        Kind::Quantity(dimension, bounds) => match bounds {
            Bounds::AboveZero => entry.positive(dimension),
            Bounds::AboveZeroOrInfinite(meaning) => entry.positive_or_infinite(dimension, meaning),
            Bounds::Within(range, zero) => entry.within(dimension, range, zero, key.example),
            bounds => {
                let value = entry.quantity(dimension)?;
                match bounds.hold(value) {
                    true => Ok(value),
                    false => Err(entry.unexpected(&expected(kind, key), None)),
                }
            }
        },
        Kind::Number(_, Bounds::Within(range, zero)) => entry.number_within(range, zero),
        Kind::Number(_, bounds @ Bounds::FromZeroOrInfinite(_)) => {
            entry.number_or_infinite(|value| bounds.hold(value), &expected(kind, key))
        }
        Kind::Number(_, bounds) => entry.number(|value| bounds.hold(value), &expected(kind, key)),
        _ => unreachable!("a key that is read as a number is declared as one"),
    }
}

// Values shared by several keys.

/// A length above 0.
pub(super) const LENGTH: Value<f64> = quantity(Dimension::Length, Bounds::AboveZero).exists(exists::LENGTH);

// Keys shared by several tables.

/// Direction of a line of a matrix in a file.
pub(super) const LINES: Optional<Axis> = optional(
    "lines",
    choice::<Axis>(),
    "`\"x\"` for text, `\"y\"` for npy, npz, mat and HDF5, which are indexed `[ix, iy]`",
    "\"y\"",
    "direction of a line of a matrix; a text that looks like points is a matrix if this is given; an error for a format that \
     determines it, see [formats](formats.md)",
);
/// Number of lines above the numbers of a text file.
pub(super) const SKIP: Optional<usize> =
    optional("skip", COUNT, "0", "6", "number of lines above the numbers of a text");
