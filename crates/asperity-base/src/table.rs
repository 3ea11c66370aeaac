//! Tables of keys, such as those of a case file: each key is declared once, with its name, the accepted
//! values, the default, an example and the meaning.
//!
//! The reader of a table, its messages, documentation, schema and units are derived from the declaration. A
//! struct whose fields are the keys of a table derives [`Table`] with `asperity-derive`.

use std::fmt;

use crate::beside::Beside;
use crate::choice::{Choice, choice};
use crate::error::{Error, Result};
use crate::grid::MAX_CELLS;
use crate::units::{Dimension, Range};

/// Keys that belong to one table, or to each of several tables.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// The dotted names of the tables: `lower.film`, `upper.film`; empty for the keys above all tables.
    pub tables: &'static [&'static str],
    /// The choice that gives the keys a meaning, as in a case file: `form = "sphere"`; empty if they always
    /// have one.
    pub kind: &'static str,
    /// The keys, in the order of the documentation.
    pub keys: &'static [Key],
}

/// A key of the case file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Key {
    /// The name.
    pub name: &'static str,
    /// The accepted values.
    pub kind: Kind,
    /// The default.
    pub default: Fallback,
    /// An example of the value, as in a case file; empty for a table.
    pub example: &'static str,
    /// The meaning, in Markdown.
    pub text: &'static str,
    /// Magnitudes of the quantity that exist; a value outside is accepted with a warning.
    pub exists: Exists,
    /// Quantities of the case that limit plausible values; others are accepted with a warning.
    pub beside: &'static [Beside],
}

/// The accepted values of a key. Its text is, for example, `length > 0`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// A number in SI, or a text with a unit.
    Quantity(Dimension, Bounds),
    /// A number without a unit, with its name in messages.
    Number(&'static str, Bounds),
    /// A whole number, both ends included.
    Count {
        /// The smallest.
        least: u64,
        /// The largest.
        most: u64,
    },
    /// One of these words.
    Choice(&'static [&'static str]),
    /// True or false.
    Flag,
    /// A text.
    Text,
    /// A table.
    Table,
    /// An array of tables.
    Tables,
    /// One value for x and y, or an array of two.
    Pair(&'static Kind),
    /// A component along x, or an array of the components along x and y.
    Vector(&'static Kind),
    /// Values of another form.
    Other {
        /// Dimension of its numbers; none for pure numbers.
        dimension: Option<Dimension>,
        /// The form, in Markdown.
        value: &'static str,
    },
}

/// Spacing of several values between two ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spacing {
    /// Equal ratios.
    Log,
    /// Equal steps.
    Linear,
}

choice!(Spacing: "log" => Log, "linear" => Linear);

/// The form of several values.
pub const SEVERAL: &str = "list of at least one value, or a [table](#a-sweep)";

/// The accepted numbers, in addition to the limits of [`Dimension::range`] and
/// [`NUMBERS`](crate::units::NUMBERS).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bounds {
    /// All finite numbers.
    Any,
    /// Values of at least 0.
    FromZero,
    /// Values of at least 0, and infinity with its meaning.
    FromZeroOrInfinite(&'static str),
    /// Values above 0.
    AboveZero,
    /// Values above 0, and infinity with its meaning.
    AboveZeroOrInfinite(&'static str),
    /// Values between two numbers.
    Between {
        /// The lower end.
        least: f64,
        /// The upper end.
        most: f64,
        /// Whether each end is excluded.
        open: [bool; 2],
    },
    /// Values in a narrower range of magnitudes, and 0 if true.
    Within(Range, bool),
}

/// Default of a key.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fallback {
    /// Nothing: the key must be given.
    Required,
    /// This value, as the case file would write it.
    Value(&'static str),
    /// No value; these words describe the behaviour, in Markdown.
    Absent(&'static str),
}

/// Magnitudes of a quantity that exist.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Exists {
    /// Not declared: only for values that are not physical quantities.
    Undeclared,
    /// Any value that the bounds of the key allow, for this reason.
    Any(&'static str),
    /// Magnitudes from `least` to `most`, SI.
    Within {
        /// The smallest magnitude.
        least: f64,
        /// The largest magnitude.
        most: f64,
        /// The things at both ends: "soft gels to diamond".
        of: &'static str,
        /// Other meanings of the same number: a unit, or a key as `dimensionless = {}`.
        slips: &'static [&'static str],
    },
}

/// A table of keys whose struct is its dictionary.
pub trait Table: Sized {
    /// The dotted names of the tables.
    const TABLES: &'static [&'static str];
    /// The keys of the fields, in their order. Those of a [`Part`] come in addition.
    const KEYS: &'static [Key];

    /// Returns the section of all keys of the table, then those of the keys that only a choice gives a
    /// meaning.
    fn sections() -> Vec<Section>;

    /// Reads the keys of a table.
    ///
    /// # Errors
    /// The error of the source for a missing key or a value that is not accepted, at its place.
    fn read(source: &dyn Source) -> Result<Self>;

    /// Checks each number against the bounds of its key, for values that no file contains.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    fn check(&self) -> Result<()>;
}

/// Keys that stand together in a table: some of its keys, one of several keys, or a choice with the keys that
/// it gives a meaning.
pub trait Part: Sized {
    /// Whether one of the keys chooses which others have a meaning, so that the part itself refuses those
    /// that have none.
    const CHOOSES: bool;

    /// Returns the keys that have a meaning in any case.
    fn keys() -> Vec<Key>;

    /// Returns the sections of the keys that only a choice gives a meaning, in these tables.
    fn sections(tables: &'static [&'static str]) -> Vec<Section> {
        let _ = tables;
        Vec::new()
    }

    /// Reads the keys.
    ///
    /// # Errors
    /// As [`Table::read`].
    fn read(source: &dyn Source) -> Result<Self>;

    /// As [`Table::check`].
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    fn check(&self) -> Result<()>;
}

/// A place from which the keys of a table are read.
pub trait Source {
    /// Returns the value of a key; `None` if it is not given.
    fn value(&self, key: &str) -> Option<Box<dyn Value + '_>>;

    /// Returns the error for a missing key.
    fn missing(&self, key: &Key) -> Error;

    /// Returns the one of `keys` that is given.
    ///
    /// # Errors
    /// None or several are given.
    fn exactly_one(&self, keys: &[&'static str], hint: &str) -> Result<&'static str>;

    /// Checks that each key has a meaning with a choice, such as `law = "arrhenius"`.
    ///
    /// # Errors
    /// A key has none.
    fn suits(&self, choice: &str) -> Result<()>;
}

/// A value at its place. Each method fails for a value of another kind, or one that the key does not accept.
pub trait Value {
    /// Reads a number, or a quantity in SI, within the bounds of its kind, which a key of [`Kind::Other`]
    /// does not have itself.
    ///
    /// # Errors
    /// As all methods.
    fn real(&self, key: &Key, kind: &Kind) -> Result<f64>;

    /// Reads a count within the limits of its kind, which a key of [`Kind::Other`] does not have itself.
    ///
    /// # Errors
    /// As all methods.
    fn count(&self, key: &Key, kind: &Kind) -> Result<usize>;

    /// Reads a whole number of at least `least`.
    ///
    /// # Errors
    /// As all methods.
    fn whole(&self, least: u64) -> Result<u64>;

    /// Reads true or false.
    ///
    /// # Errors
    /// As all methods.
    fn flag(&self) -> Result<bool>;

    /// Reads one of several words, as its index. `hint` is about another word.
    ///
    /// # Errors
    /// As all methods.
    fn word(&self, words: &[&'static str], hint: &dyn Fn(&str) -> Option<String>) -> Result<usize>;

    /// Reads a text.
    ///
    /// # Errors
    /// As all methods.
    fn text(&self) -> Result<&str>;

    /// Reads the two numbers of a key of [`Kind::Pair`] or [`Kind::Vector`].
    ///
    /// # Errors
    /// As all methods.
    fn pair(&self, key: &Key) -> Result<[f64; 2]>;

    /// Reads the size of a unit, given by its name or as a quantity above 0.
    ///
    /// # Errors
    /// As all methods.
    fn unit(&self, dimension: Dimension) -> Result<f64>;

    /// Whether the value is an array.
    fn is_array(&self) -> bool;

    /// Whether the value is a table.
    fn is_table(&self) -> bool;

    /// Returns the table, which has only known keys.
    ///
    /// # Errors
    /// As all methods.
    fn table(&self) -> Result<Box<dyn Source + '_>>;

    /// Returns the tables of an array of tables, which have only known keys.
    ///
    /// # Errors
    /// As all methods.
    fn tables(&self) -> Result<Vec<Box<dyn Source + '_>>>;

    /// Returns the items of an array; `expected` describes them.
    ///
    /// # Errors
    /// As all methods.
    fn items(&self, expected: &str) -> Result<Vec<Box<dyn Value + '_>>>;

    /// Reads a list of at least one number or vector of a kind, or a table that gives it by `from`, `to` and
    /// `points`, at a `spacing` unless it says otherwise. `example` is one of them. A number is the first of
    /// two.
    ///
    /// # Errors
    /// As all methods.
    fn several(&self, key: &Key, kind: &Kind, spacing: Spacing, example: &str) -> Result<Vec<[f64; 2]>>;

    /// Returns the error for a value that is not accepted, with what was `expected`.
    fn unexpected(&self, expected: &str, hint: Option<&str>) -> Error;

    /// Returns an error at the value.
    fn error(&self, message: &str, hint: Option<&str>) -> Error;
}

/// Reads a key, if it is given.
///
/// # Errors
/// The errors of `read`.
pub fn optional<T>(
    source: &dyn Source,
    key: &Key,
    read: impl FnOnce(&dyn Value) -> Result<T>,
) -> Result<Option<T>> {
    source.value(key.name).map(|value| read(value.as_ref())).transpose()
}

/// Whether a source gives a key of a part.
pub fn gives<P: Part>(source: &dyn Source) -> bool {
    P::keys().iter().any(|key| source.value(key.name).is_some())
}

/// Returns an error if more than one of `keys` is given.
///
/// # Errors
/// Several are given.
pub fn at_most_one(source: &dyn Source, keys: &[&'static str], hint: &str) -> Result<()> {
    if keys.iter().any(|key| source.value(key).is_some()) {
        source.exactly_one(keys, hint).map(|_| ())
    } else {
        Ok(())
    }
}

/// Returns an error at a key that is given, unless its value `holds` beside the others.
///
/// # Errors
/// The error of [`Value::unexpected`].
pub fn require(
    source: &dyn Source,
    key: &str,
    holds: bool,
    expected: &str,
    hint: Option<&str>,
) -> Result<()> {
    match source.value(key).filter(|_| !holds) {
        Some(value) => Err(value.unexpected(expected, hint)),
        None => Ok(()),
    }
}

/// Reads each item of an array; `expected` describes it.
///
/// # Errors
/// As the methods of [`Value`].
pub fn list<T>(value: &dyn Value, expected: &str, read: impl Fn(&dyn Value) -> Result<T>) -> Result<Vec<T>> {
    value.items(expected)?.iter().map(|item| read(item.as_ref())).collect()
}

/// Reads an array of two items; `expected` describes it.
///
/// # Errors
/// As the methods of [`Value`].
pub fn two<T>(value: &dyn Value, expected: &str, read: impl Fn(&dyn Value) -> Result<T>) -> Result<[T; 2]> {
    list(value, expected, read)?.try_into().map_err(|_| value.unexpected(expected, None))
}

/// Reads a choice by its word.
///
/// # Errors
/// As the methods of [`Value`].
pub fn choice<C: Choice>(value: &dyn Value) -> Result<C> {
    value.word(C::NAMES, &C::hint).map(|index| C::WORDS[index].1)
}

/// Reads the size of a unit of the dimension of a key.
///
/// # Errors
/// As the methods of [`Value`].
///
/// # Panics
/// For a key of pure numbers.
pub fn unit(value: &dyn Value, key: &Key) -> Result<f64> {
    value.unit(key.kind.dimension().expect("a unit has a dimension"))
}

/// Reads numbers of cells along x and y, each at least 1.
///
/// # Errors
/// As the methods of [`Value`].
pub fn cells(value: &dyn Value, _: &Key) -> Result<[usize; 2]> {
    const EXPECTED: &str = "two whole numbers of at least 1, such as [256, 256]";
    let whole = |item: &dyn Value| item.whole(0).map(|cells| usize::try_from(cells).unwrap_or(usize::MAX));
    let shape = two(value, EXPECTED, whole)?;
    match shape[0].checked_mul(shape[1]) {
        Some(0) => Err(value.unexpected(EXPECTED, None)),
        Some(cells) if cells <= MAX_CELLS => Ok(shape),
        _ => Err(value.unexpected("a grid of at most 2³² cells", None)),
    }
}

/// Reads each table of an array.
///
/// # Errors
/// As the methods of [`Value`].
pub fn tables<T>(value: &dyn Value, read: impl Fn(&dyn Source) -> Result<T>) -> Result<Vec<T>> {
    value.tables()?.iter().map(|table| read(table.as_ref())).collect()
}

/// Checks a number against the bounds of its key.
///
/// # Errors
/// [`Error::OutOfRange`].
pub fn check(key: &Key, value: f64) -> Result<()> {
    let (kind, dimension, bounds) = match key.kind {
        Kind::Pair(kind) | Kind::Vector(kind) => return check(&Key { kind: *kind, ..*key }, value),
        Kind::Quantity(dimension, bounds) => (key.kind, Some(dimension), bounds),
        Kind::Number(_, bounds) => (key.kind, None, bounds),
        Kind::Count { least, most } => {
            let bounds = Bounds::Between { least: least as f64, most: most as f64, open: [false, false] };
            (key.kind, None, bounds)
        }
        _ => return Ok(()),
    };
    let may_be_infinite = matches!(bounds, Bounds::FromZeroOrInfinite(_) | Bounds::AboveZeroOrInfinite(_));
    if bounds.hold(value) && (value.is_finite() || may_be_infinite) {
        return Ok(());
    }
    Err(Error::OutOfRange { quantity: key.name, value, dimension, expected: expected(&kind, key).into() })
}

/// Returns what an error says that a quantity, a number or a count of this kind is expected to be.
///
/// # Panics
/// For another kind.
pub fn expected(kind: &Kind, key: &Key) -> String {
    match *kind {
        Kind::Count { least, most: u64::MAX } => format!("a whole number of at least {least}"),
        Kind::Count { least, most } => format!("a whole number from {least} to {most}"),
        Kind::Quantity(_, Bounds::Within(range, zero)) | Kind::Number(_, Bounds::Within(range, zero)) => {
            format!("{}a magnitude of {range}", if zero { "0, or " } else { "" })
        }
        Kind::Quantity(dimension, Bounds::Any) => {
            format!("{} such as \"{}\"", dimension.noun(), dimension.example())
        }
        Kind::Quantity(dimension, Bounds::FromZero) => format!("{} of at least 0", dimension.noun()),
        Kind::Quantity(dimension, _) => {
            format!("{} above 0 such as \"{}\"", dimension.noun(), dimension.example())
        }
        Kind::Number(noun, bounds) => match bounds {
            Bounds::FromZero => format!("{noun} of at least 0 such as {}", key.example),
            Bounds::AboveZero => format!("{noun} above 0 such as {}", key.example),
            Bounds::FromZeroOrInfinite(meaning) => {
                format!("{noun} of at least 0 such as {}, or inf: {meaning}", key.example)
            }
            Bounds::Between { least, most, open: [from, to] } => match (from, to) {
                (false, false) => format!("{noun} from {least} to {most}"),
                (false, true) => format!("{noun} from {least}, below {most}"),
                (true, false) => format!("{noun} above {least}, at most {most}"),
                (true, true) => format!("{noun} above {least}, below {most}"),
            },
            Bounds::Any | Bounds::AboveZeroOrInfinite(_) | Bounds::Within(..) => noun.to_owned(),
        },
        _ => unreachable!("a key that is read as a number is declared as one"),
    }
}

/// A combination of entries that is refused, or something that an entry requires.
#[derive(Debug, Clone, Copy)]
pub struct Rule<F> {
    /// The excluded entry, in Markdown.
    pub this: &'static str,
    /// The entry that excludes it, in Markdown.
    pub with: &'static str,
    /// The message of the error. `{key}` stands for the key that it points to, `{path}` for its dotted name,
    /// `{value}` for its value.
    pub message: &'static str,
    /// The hint; empty if the message is enough.
    pub hint: &'static str,
    /// The dotted key that the error of the example points to.
    pub at: &'static str,
    /// Keys that break the rule, as written above the tables of a case file.
    pub example: &'static [&'static str],
    /// Finds whether the rule is broken.
    pub broken: F,
}

impl Section {
    /// Whether it declares a key of this name.
    pub fn has(&self, key: &str) -> bool {
        self.keys.iter().any(|known| known.name == key)
    }

    /// Whether its keys require a choice of `of`, such as `form = "sphere"` for `form`.
    pub fn suits(&self, kind: &str) -> bool {
        self.kind.is_empty()
            || kind.strip_prefix(self.kind).is_some_and(|rest| !rest.starts_with(char::is_alphanumeric))
    }
}

impl Kind {
    /// Dimension of its numbers; none for pure numbers and for other values.
    pub const fn dimension(&self) -> Option<Dimension> {
        match self {
            Self::Quantity(dimension, _) => Some(*dimension),
            Self::Other { dimension, .. } => *dimension,
            Self::Pair(item) | Self::Vector(item) => item.dimension(),
            _ => None,
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Quantity(dimension, bounds) => write!(f, "{}{bounds}", bare_noun(dimension.noun())),
            Self::Number(_, bounds) => write!(f, "number{bounds}"),
            Self::Count { least, most: u64::MAX } => write!(f, "whole number ≥ {least}"),
            Self::Count { least, most } => write!(f, "whole number, {least} … {most}"),
            Self::Choice(words) => {
                f.write_str(&words.iter().map(|word| format!("`\"{word}\"`")).collect::<Vec<_>>().join(", "))
            }
            Self::Flag => f.write_str("`true`, `false`"),
            Self::Text => f.write_str("text"),
            Self::Table => f.write_str("table"),
            Self::Tables => f.write_str("tables"),
            Self::Pair(item) => write!(f, "{item}, or two: `[x, y]`"),
            Self::Vector(item) => write!(f, "{item} along x, or `[x, y]`"),
            Self::Other { value, .. } => f.write_str(value),
        }
    }
}

impl Bounds {
    /// Whether a number lies within the bounds.
    pub fn hold(&self, value: f64) -> bool {
        match *self {
            Self::Any => true,
            Self::FromZero | Self::FromZeroOrInfinite(_) => value >= 0.0,
            Self::AboveZero | Self::AboveZeroOrInfinite(_) => value > 0.0,
            Self::Between { least, most, open: [from, to] } => {
                let above = if from { value > least } else { value >= least };
                above && if to { value < most } else { value <= most }
            }
            Self::Within(range, zero) => range.holds(value) || (zero && value == 0.0),
        }
    }
}

/// Removes the article from a noun.
fn bare_noun(noun: &str) -> &str {
    noun.split_once(' ').map_or(noun, |(_, noun)| noun)
}

/// The text in the tables of the documentation, after a noun: ` > 0`.
impl fmt::Display for Bounds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Any => Ok(()),
            Self::FromZero => f.write_str(" ≥ 0"),
            Self::FromZeroOrInfinite(meaning) => write!(f, " ≥ 0, or `inf`: {meaning}"),
            Self::AboveZero => f.write_str(" > 0"),
            Self::AboveZeroOrInfinite(meaning) => write!(f, " > 0, or `inf`: {meaning}"),
            Self::Between { least, most, open: [false, false] } => write!(f, ", {least} … {most}"),
            Self::Between { least, most, open: [from, to] } => {
                write!(
                    f,
                    " {} {least}, {} {most}",
                    ["≥", ">"][usize::from(from)],
                    ["≤", "<"][usize::from(to)]
                )
            }
            Self::Within(range, zero) => write!(f, ", {}{range}", if zero { "0 or " } else { "" }),
        }
    }
}

/// The text in the tables of the documentation.
impl fmt::Display for Fallback {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Required => f.write_str("required"),
            Self::Value(value) => write!(f, "`{value}`"),
            Self::Absent(text) => f.write_str(text),
        }
    }
}
