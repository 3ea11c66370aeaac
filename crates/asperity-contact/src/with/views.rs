//! Numbers, curves and maps of capabilities and of laws of bodies, as data that any view can show.

use std::borrow::Cow;

use crate::motion::{PassRecord, SweepRecord};
use crate::units::{Metre, Pascal, format_number};

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

/// Writes a share in per cent, with one digit behind the point.
pub fn percent(share: f64) -> String {
    format!("{} %", format_number((1000.0 * share).round() / 10.0))
}

/// Curves of one quantity over the mean pressure, over the contacts, or over the passes.
#[derive(Debug)]
pub struct Curve<R: 'static> {
    /// Name of the figure, and of that over the contacts of the last pass beside one over the passes.
    pub names: [&'static str; 2],
    /// The quantity.
    pub title: &'static str,
    /// Sentence about what is seen.
    pub caption: &'static str,
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
    /// Its course over the mean pressure, as its name says.
    pub over_pressure: OverPressure,
}

/// The part of the course of a curve over the mean pressure that its name says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OverPressure {
    /// Nothing.
    Nothing,
    /// The pressure from which on its value is 0, if there is one.
    End,
    /// The exponent of the power of the pressure that fits it best.
    Exponent,
}

/// Returns the rows that show how something depends on the mean pressure: all of them if it only rises or
/// only falls from row to row, else the last one, because a loading history has other states at the same
/// pressure.
pub fn over_pressure<R>(rows: &[R], pressure: impl Fn(&R) -> Pascal) -> &[R] {
    let rises = rows.is_sorted_by(|one, next| pressure(one) <= pressure(next));
    let falls = rows.is_sorted_by(|one, next| pressure(one) >= pressure(next));
    if rises || falls { rows } else { &rows[rows.len() - 1..] }
}

/// Returns the least pressure above which no value is above 0, of points [pressure, value]; `None` if the
/// value at the largest pressure is.
pub fn closing(points: impl Iterator<Item = [f64; 2]> + Clone) -> Option<Pascal> {
    let open =
        points.clone().filter(|[_, value]| *value > 0.0).map(|[pressure, _]| pressure).fold(0.0, f64::max);
    points.map(|[pressure, _]| pressure).filter(|pressure| *pressure > open).reduce(f64::min)
}

/// Returns the exponent of the power of the pressure that fits values best, by least squares of their
/// logarithms; `None` for values at fewer than three pressures, or over less than half a decade. Values that
/// are not above 0 are left out.
pub fn exponent(points: impl Iterator<Item = [f64; 2]>) -> Option<f64> {
    /// Ratio of the largest to the least pressure.
    const LEAST_RANGE: f64 = 3.0;
    let good = points.filter(|[pressure, value]| *pressure > 0.0 && *value > 0.0 && value.is_finite());
    let points: Vec<[f64; 2]> = good.map(|point| point.map(f64::ln)).collect();
    let [least, most] = [f64::min, f64::max].map(|pick| points.iter().map(|p| p[0]).fold(f64::NAN, pick));
    if points.len() < 3 || (most - least).is_nan() || most - least < LEAST_RANGE.ln() {
        return None;
    }
    let count = points.len() as f64;
    let mean = [0, 1].map(|axis| points.iter().map(|point| point[axis]).sum::<f64>() / count);
    let moment = |axis: usize| {
        points.iter().map(|point| (point[0] - mean[0]) * (point[axis] - mean[axis])).sum::<f64>()
    };
    Some(moment(1) / moment(0))
}

/// A map of a field.
#[derive(Debug)]
pub struct Map<R: 'static> {
    /// Name of the field, and of the figure.
    pub field: &'static str,
    /// Title.
    pub title: &'static str,
    /// Sentence about what is seen.
    pub caption: &'static str,
    /// The quantity.
    pub quantity: &'static str,
    /// The unit.
    pub unit: fn(&R) -> &'static str,
    /// Its scale.
    pub scale: Scale,
    /// Whether it is a section along x into the depth.
    pub is_section: bool,
    /// The place that is marked, if a row has one for this field: x and y, or x and the depth on a section.
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

/// A field that a law keeps of each body.
#[derive(Debug, Clone, Copy)]
pub struct Kept {
    /// Name of the state of a body.
    pub state: &'static str,
    /// Names of the field of the lower and of the upper body in files.
    pub names: [&'static str; 2],
    /// Whether the field raises the heights (1), lowers them (−1), or is not a part of them (0).
    pub raises: f64,
    /// Its map; none of a field that only the law needs.
    pub map: Option<KeptMap>,
}

/// The map of a field that a law keeps.
#[derive(Debug, Clone, Copy)]
pub struct KeptMap {
    /// Title of the figure: "tribofilm".
    pub title: &'static str,
    /// Title for an upper body that is fresh in each pass.
    pub of_fresh: &'static str,
    /// Title before the name of the body: "Thickness of the film on".
    pub of_body: &'static str,
    /// The quantity, a length.
    pub quantity: &'static str,
}

/// A quantity of both bodies in the rows of a table.
#[derive(Debug)]
pub struct OfBodies<R: 'static> {
    /// The name.
    pub name: &'static str,
    /// The column of the lower body.
    pub column: &'static str,
    /// The values of the lower and of the upper body.
    pub values: fn(&R) -> [f64; 2],
    /// Whether the values of the rows add up.
    pub adds_up: bool,
}

/// A column in the table of passes on the terminal.
#[derive(Debug, Clone, Copy)]
pub struct PassCell {
    /// Its head.
    pub head: &'static str,
    /// The column of the passes that has its unit.
    pub column: &'static str,
    /// The smallest value that may be the first, by which the unit is chosen.
    pub least: f64,
    /// The value.
    pub value: fn(&PassRecord) -> f64,
    /// Whether the values of the passes add up.
    pub adds_up: bool,
    /// Whether the value is that of the interior of the bodies.
    pub is_inside: bool,
    /// Its explanation above the table.
    pub about: &'static str,
}

/// A number in a row of the terminal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RowCell {
    /// The head of its column.
    pub head: &'static str,
    /// The column of the results that has its unit.
    pub column: &'static str,
    /// The value.
    pub value: f64,
    /// Whether the page shows it among the first numbers.
    pub is_answer: bool,
}

/// A curve over the points of a sweep.
#[derive(Debug, Clone, Copy)]
pub struct OfPoints {
    /// The column, which is the name of the figure.
    pub column: &'static str,
    /// The quantity.
    pub label: &'static str,
    /// Whether its axis is logarithmic beside a logarithmic one.
    pub may_be_log: bool,
    /// The value of a point; `None` if it has none.
    pub value: fn(&SweepRecord) -> Option<f64>,
    /// The curves with their names, if there are several; that of the value is one of them.
    pub beside: &'static [BesidePoints],
}

/// One of several curves over the points of a sweep.
#[derive(Debug, Clone, Copy)]
pub struct BesidePoints {
    /// Its name.
    pub name: &'static str,
    /// The value of a point; `None` if it has none.
    pub value: fn(&SweepRecord) -> Option<f64>,
    /// Whether it is dashed, as a formula.
    pub is_dashed: bool,
}

/// A number that answers a question of the user.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The name.
    pub name: Cow<'static, str>,
    /// The value, with its unit.
    pub value: String,
    /// Explanation of the value.
    pub about: String,
    /// The answer as a sentence.
    pub sentence: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_history_is_told_by_its_last_state() {
        let shown = |pressures: &[f64]| over_pressure(pressures, |pressure| *pressure).len();
        assert_eq!([shown(&[1.0, 2.0, 2.0, 3.0]), shown(&[3.0, 1.0]), shown(&[])], [4, 2, 0]);
        assert_eq!(over_pressure(&[1.0, 3.0, 2.0], |pressure| *pressure), [2.0]);
    }

    #[test]
    fn a_power_of_the_pressure_is_found_from_points_that_say_enough() {
        let power = |points: &[f64]| exponent(points.iter().map(|p| [*p, 3.0 * p.powf(0.95)]));
        assert!((power(&[1.0, 2.0, 5.0, 10.0]).unwrap() - 0.95).abs() < 1e-12);
        assert_eq!(power(&[1.0, 10.0]), None);
        assert_eq!(power(&[1.0, 1.5, 2.0]), None);
        let closed = [[1.0, 1.0], [3.0, 9.0], [9.0, 81.0], [20.0, 0.0]];
        assert!((exponent(closed.into_iter()).unwrap() - 2.0).abs() < 1e-12);
    }
}
