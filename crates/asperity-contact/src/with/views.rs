//! Numbers, curves and maps of a capability, as data that any view can show.

use std::borrow::Cow;

use crate::units::Metre;

/// A number, or a few that belong together, in words.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// The name.
    pub name: Cow<'static, str>,
    /// The value, with its unit.
    pub value: String,
    /// Whether it is a detail, which the page shows and the terminal does not.
    pub is_detail: bool,
}

impl Line {
    /// Creates a line that every view shows.
    pub fn new(name: impl Into<Cow<'static, str>>, value: impl Into<String>) -> Self {
        Self { name: name.into(), value: value.into(), is_detail: false }
    }

    /// Creates a line that only the page shows.
    pub fn detail(name: impl Into<Cow<'static, str>>, value: impl Into<String>) -> Self {
        Self { is_detail: true, ..Self::new(name, value) }
    }
}

/// Curves of one quantity over the mean pressure, over the contacts, or over the passes.
#[derive(Debug)]
pub struct Curve<R: 'static> {
    /// Name of the figure, and of that over the contacts of the last pass beside one over the passes.
    pub names: [&'static str; 2],
    /// The quantity.
    pub title: &'static str,
    /// The column that has its unit.
    pub column: fn(&R) -> &'static str,
    /// The curves, the main one first.
    pub series: &'static [Series<R>],
}

/// A curve of a quantity.
#[derive(Debug)]
pub struct Series<R: 'static> {
    /// Its name beside others.
    pub name: &'static str,
    /// Whether a row belongs to the curve.
    pub has: fn(&R) -> bool,
    /// The value of a row; `None` if it is unknown.
    pub value: fn(&R) -> Option<f64>,
    /// Whether it is dashed, so that it hides no other curve.
    pub is_dashed: bool,
    /// Whether it stands only beside the main curve of single contacts, such as a correlation or a share.
    pub is_beside: bool,
    /// Whether it ends at a pressure, named beside the curve, from which on the value is 0.
    pub may_end: bool,
}

/// A map of a field.
#[derive(Debug)]
pub struct Map<R: 'static> {
    /// Name of the field, and of the figure.
    pub field: &'static str,
    /// Title.
    pub title: &'static str,
    /// The quantity.
    pub quantity: &'static str,
    /// The unit.
    pub unit: fn(&R) -> &'static str,
    /// Its scale.
    pub scale: Scale,
    /// The place that is marked, if a row has one for this field.
    pub mark: fn(&R, field: &str) -> Option<[Metre; 2]>,
    /// Name of the marked place.
    pub marked: &'static str,
}

/// Scale of a map of values of at least 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scale {
    /// From 0; logarithmic if all values are above 0, since those that stand out would hide the others.
    FromZeroOrLogarithmic,
    /// Logarithmic, down to this share of the largest value.
    Logarithmic(f64),
}
