//! Keys of a case file, each declared once.
//!
//! A declaration holds the name, the accepted values, the default, an example and the meaning. The reader of case files,
//! its messages, the units of study axes and the tables of `docs/input` are derived from it.

pub(crate) mod adhesion;
pub(crate) mod body;
mod exists;
pub(crate) mod loading;
pub(crate) mod hardness;
pub(crate) mod list;
pub(crate) mod moving;
pub(crate) mod passage;
pub(crate) mod results;
pub(crate) mod plasticity;
pub(crate) mod root;
pub(crate) mod tables;
pub(crate) mod topography;
pub(crate) mod typed;
pub(crate) mod values;
pub(crate) mod running_in;

use std::fmt;

pub use exists::Exists;

use asperity_base::units::{Dimension, Range};

/// Keys that belong to one table, or to each of several tables.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// The dotted names of the tables: `lower.wear`, `upper.wear`; empty for the keys above all tables.
    pub tables: &'static [&'static str],
    /// The choice that gives the keys a meaning, as in a case file: `form = "sphere"`; empty if they always have one.
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

/// The accepted numbers, in addition to the limits of [`Dimension::range`] and [`NUMBERS`](asperity_base::units::NUMBERS).
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

/// Returns all keys of a case file, section by section, in the order in which a misplaced key is searched.
///
/// ```
/// let keys = asperity_study::keys();
/// let motion = keys.iter().find(|section| section.tables == ["motion"]).unwrap();
/// let stride = motion.keys.iter().find(|key| key.name == "stride").unwrap();
/// assert_eq!(stride.kind.to_string(), "whole number ≥ 1");
/// assert_eq!(stride.default.to_string(), "`1`");
/// ```
pub fn keys() -> &'static [Section] {
    &[
        root::SECTION,
        body::both::SECTION,
        body::upper::SECTION,
        body::coating::SECTION,
        loading::contact::SECTION,
        adhesion::SECTION,
        moving::motion::SECTION,
        loading::friction::SECTION,
        results::subsurface::SECTION,
        passage::conductance::SECTION,
        passage::flow::SECTION,
        results::output::SECTION,
        running_in::acceleration::SECTION,
        moving::sliding::SECTION,
        running_in::temperature::SECTION,
        running_in::wear::SECTION,
        running_in::film::SECTION,
        running_in::arrhenius::SECTION,
        running_in::mechano_chemical::SECTION,
        running_in::solid_lubricant::SECTION,
        plasticity::body::SECTION,
        plasticity::volume::SECTION,
        topography::every::SECTION,
        topography::file::SECTION,
        topography::given::SECTION,
        topography::generate::SECTION,
        topography::low_pass::SECTION,
        topography::autocorrelation::SECTION,
        topography::self_affine::SECTION,
        topography::form::SECTION,
        topography::sphere::SECTION,
        topography::ellipsoid::SECTION,
        topography::cylinder::SECTION,
        topography::cone::SECTION,
        topography::flat::SECTION,
        topography::sinusoid::SECTION,
        topography::grooves::SECTION,
        loading::history::SECTION,
        list::SECTION,
        hardness::map::SECTION,
        hardness::given::SECTION,
    ]
}

impl Kind {
    /// Dimension of its numbers; none for pure numbers and for other values.
    pub fn dimension(&self) -> Option<Dimension> {
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
