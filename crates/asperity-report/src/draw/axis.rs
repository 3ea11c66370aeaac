//! Units that suit a range, and ticks at round numbers.

use asperity_base::units::Dimension;
use asperity_study::{dimension_of_column, unit_of_column};

use super::text::{SMALL, width_of};

/// What numbers measure; they are in SI and are shown in a multiple that suits them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// Metres.
    Length,
    /// Square metres.
    Area,
    /// Cubic metres.
    Volume,
    /// Pascals.
    Pressure,
    /// Newtons.
    Force,
    /// Joules.
    Energy,
    /// Newtons per metre.
    Stiffness,
    /// Seconds.
    Time,
    /// Radians per metre.
    Wavenumber,
    /// One over metres, such as the density of heights.
    PerLength,
    /// A pure number.
    Number,
    /// A pure number that is whole, such as a pass.
    Count,
    /// A unit without multiples, such as "m/Pa".
    Of(&'static str),
}

/// What a colour or an axis shows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Quantity {
    /// The name, such as "pressure".
    pub name: String,
    /// Its unit.
    pub unit: Unit,
}

impl Quantity {
    /// A quantity with its name and unit.
    pub fn new(name: impl Into<String>, unit: Unit) -> Self {
        Self { name: name.into(), unit }
    }
}

impl Unit {
    /// The unit of a column of the results.
    pub fn of_column(name: &str) -> Self {
        match (dimension_of_column(name), unit_of_column(name)) {
            (Some(dimension), _) => dimension.into(),
            (None, None | Some("" | "1")) => Self::Number,
            (None, Some(unit)) => Self::Of(unit),
        }
    }

    /// The unit of a field, SI.
    pub fn of_field(unit: &'static str) -> Self {
        match unit {
            "" | "1" => Self::Number,
            "m" => Self::Length,
            "Pa" => Self::Pressure,
            _ => Self::Of(unit),
        }
    }

    /// The multiples, ascending, and the smallest number that is well shown in one.
    fn multiples(self) -> (&'static [(f64, &'static str)], f64) {
        match self {
            Self::Length => {
                (&[(1e-12, "pm"), (1e-9, "nm"), (1e-6, "µm"), (1e-3, "mm"), (1.0, "m"), (1e3, "km")], 1.0)
            }
            Self::Area => (&[(1e-18, "nm²"), (1e-12, "µm²"), (1e-6, "mm²"), (1.0, "m²")], 1e-2),
            Self::Volume => (&[(1e-27, "nm³"), (1e-18, "µm³"), (1e-9, "mm³"), (1.0, "m³")], 1e-4),
            Self::Pressure => (&[(1.0, "Pa"), (1e3, "kPa"), (1e6, "MPa"), (1e9, "GPa")], 1.0),
            Self::Force => (&[(1e-9, "nN"), (1e-6, "µN"), (1e-3, "mN"), (1.0, "N"), (1e3, "kN")], 1.0),
            Self::Energy => (
                &[
                    (1e-15, "fJ"),
                    (1e-12, "pJ"),
                    (1e-9, "nJ"),
                    (1e-6, "µJ"),
                    (1e-3, "mJ"),
                    (1.0, "J"),
                    (1e3, "kJ"),
                ],
                1.0,
            ),
            Self::Stiffness => {
                (&[(1e-3, "mN/m"), (1.0, "N/m"), (1e3, "kN/m"), (1e6, "MN/m"), (1e9, "GN/m")], 1.0)
            }
            Self::Time => (&[(1e-9, "ns"), (1e-6, "µs"), (1e-3, "ms"), (1.0, "s")], 1.0),
            // Heights of nanometres have a density per nanometre.
            Self::PerLength => (&[(1.0, "1/m"), (1e3, "1/mm"), (1e6, "1/µm"), (1e9, "1/nm")], 1e-3),
            Self::Wavenumber => (&[(1.0, "rad/m"), (1e3, "rad/mm"), (1e6, "rad/µm"), (1e9, "rad/nm")], 1.0),
            Self::Number | Self::Count | Self::Of(_) => (&[(1.0, "")], 1.0),
        }
    }

    /// Whether there are multiples of the unit.
    pub fn has_multiples(self) -> bool {
        self.multiples().0.len() > 1
    }

    /// The SI unit itself.
    pub fn base(self) -> &'static str {
        match self {
            Self::Of(unit) => unit,
            _ => {
                self.multiples().0.iter().find(|(factor, _)| *factor == 1.0).map_or("", |(_, symbol)| symbol)
            }
        }
    }

    /// The multiple for numbers up to `magnitude`: its size in SI, its symbol.
    pub fn shown(self, magnitude: f64) -> (f64, String) {
        if !(magnitude > 0.0 && magnitude.is_finite()) {
            return (1.0, self.base().to_owned());
        }
        let (multiples, least) = self.multiples();
        let fits = multiples.iter().rev().find(|(factor, _)| magnitude >= least * factor * (1.0 - 1e-9));
        let (factor, symbol) = *fits.unwrap_or(&multiples[0]);
        let symbol = if let Self::Of(unit) = self { unit } else { symbol };
        if (1e-3..1e5).contains(&(magnitude / factor)) {
            return (factor, symbol.to_owned());
        }
        let exponent = (magnitude / factor).log10().floor() as i32;
        let symbol = format!("{} {symbol}", power_of_ten(exponent));
        (factor * 10f64.powi(exponent), symbol.trim_end().to_owned())
    }
}

impl From<Dimension> for Unit {
    fn from(dimension: Dimension) -> Self {
        match dimension {
            Dimension::Length => Self::Length,
            Dimension::Area => Self::Area,
            Dimension::Volume => Self::Volume,
            Dimension::Pressure => Self::Pressure,
            Dimension::Force => Self::Force,
            Dimension::Stiffness => Self::Stiffness,
            Dimension::Time => Self::Time,
            Dimension::Energy => Self::Energy,
            other => Self::Of(other.si()),
        }
    }
}

/// An axis: the range it shows, in the unit it shows (or the decimal logarithm), and its ticks.
#[derive(Debug, Clone)]
pub(super) struct Scale {
    /// Where ticks stand, from 0 at the low to 1 at the high end, with their labels.
    pub(super) ticks: Vec<(f64, String)>,
    /// Where lines of the mesh without labels stand.
    pub(super) minor: Vec<f64>,
    pub(super) symbol: String,
    low: f64,
    high: f64,
    factor: f64,
    log: bool,
}

impl Scale {
    /// A linear axis over `range` (SI), whose unit suits numbers up to `magnitude`, with about `most` ticks.
    pub(super) fn linear(range: [f64; 2], magnitude: f64, unit: Unit, most: usize) -> Self {
        let (factor, symbol) = unit.shown(magnitude);
        let [low, high] = range.map(|v| v / factor);
        let least = if unit == Unit::Count { 1.0 } else { 0.0 };
        let step = round_step((high - low) / most.max(1) as f64).max(least);
        let decimals = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
        let slack = (high - low) * 1e-9;
        let first = ((low - slack) / step).ceil() as i64;
        let last = ((high + slack) / step).floor() as i64;
        let ticks = (first..=last)
            .map(|i| {
                let label = format!("{:.decimals$}", i as f64 * step);
                ((i as f64 * step - low) / (high - low), label.replace('-', "−"))
            })
            .collect();
        // One tick tells no scale.
        if first == last && most < 8 && least == 0.0 {
            return Self::linear(range, magnitude, unit, most + 1);
        }
        Self { ticks, minor: Vec::new(), symbol, low, high, factor, log: false }
    }

    /// A logarithmic axis over `range` (SI, positive), with about `most` ticks.
    pub(super) fn logarithmic(range: [f64; 2], unit: Unit, most: usize) -> Self {
        let (factor, symbol) = match unit {
            Unit::Number | Unit::Count | Unit::Of(_) => (1.0, unit.base().to_owned()),
            // That of the map of the spectrum beside it.
            Unit::Wavenumber => unit.shown(range[1]),
            _ => unit.shown((range[0] * range[1]).sqrt()),
        };
        let [low, high] = range.map(|v| (v / factor).log10());
        let [first, last] = [(low - 1e-9).ceil() as i32, (high + 1e-9).floor() as i32];
        let inside = |v: &f64| (low - 1e-9..=high + 1e-9).contains(v);
        let plain = low >= -2.5 && high <= 4.5;
        let at = |exponent: i32, mantissa: i32| f64::from(exponent) + f64::from(mantissa).log10();
        let label = |exponent: i32, mantissa: i32| match (plain, mantissa) {
            (true, _) => {
                format!("{:.*}", (-exponent).max(0) as usize, f64::from(mantissa) * 10f64.powi(exponent))
            }
            (false, 1) => power_of_ten(exponent),
            (false, _) => format!("{mantissa}×{}", power_of_ten(exponent)),
        };
        let stride = ((last - first + 1) as f64 / (most + 2) as f64).ceil().max(1.0) as i32;
        let decades = (last - first + 1).max(0) as usize;
        let mantissas: &[i32] = match decades {
            0 | 1 if most > 4 && high - low < 0.7 => &[1, 2, 3, 4, 5, 6, 7, 8, 9],
            0..=2 if decades * 3 <= most.max(3) => &[1, 2, 5],
            _ => &[1],
        };
        let share = |position: f64| (position - low) / (high - low);
        let ticks = (first - 1..=last)
            .filter(|e| mantissas.len() > 1 || (e - first) % stride == 0)
            .flat_map(|e| mantissas.iter().map(move |&m| (e, m)))
            .map(|(e, m)| (at(e, m), label(e, m)))
            .filter(|(position, _)| inside(position))
            .map(|(position, label)| (share(position), label))
            .collect();
        let minor = (first - 1..=last).flat_map(|e| (1..10).map(move |m| at(e, m))).filter(inside);
        Self { ticks, minor: minor.map(share).collect(), symbol, low, high, factor, log: true }
    }

    /// Where `value` (SI) lies on the axis, from 0 at its low to 1 at its high end and beyond; `None` if the
    /// axis cannot show it.
    pub(super) fn share(&self, value: f64) -> Option<f64> {
        let position = if self.log { (value / self.factor).log10() } else { value / self.factor };
        Some((position - self.low) / (self.high - self.low)).filter(|share| share.is_finite())
    }

    /// `name (unit)`.
    pub(super) fn label(&self, name: &str) -> String {
        if self.symbol.is_empty() { name.to_owned() } else { format!("{name} ({})", self.symbol) }
    }

    /// Width of the widest tick label, pt.
    pub(super) fn width(&self) -> f64 {
        self.ticks.iter().map(|(_, label)| width_of(label, SMALL)).fold(0.0, f64::max)
    }
}

/// A range to show for numbers from `low` to `high`: never empty, never too narrow to be labelled.
pub(super) fn widened([low, high]: [f64; 2]) -> [f64; 2] {
    if !(low.is_finite() && high.is_finite() && low <= high) {
        return [0.0, 1.0];
    }
    let magnitude = low.abs().max(high.abs());
    let least = match magnitude {
        0.0 => 1.0,
        _ if low == high => magnitude * 0.1,
        _ => magnitude * 1e-4,
    };
    if high - low >= least { [low, high] } else { [(low + high - least) / 2.0, (low + high + least) / 2.0] }
}

/// Smallest and largest of the finite numbers; `[inf, −inf]` if there are none.
pub(super) fn extremes(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let finite = values.into_iter().filter(|v| v.is_finite());
    finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
}

/// 1, 2 or 5 times a power of ten, at least `least`.
fn round_step(least: f64) -> f64 {
    let power = 10f64.powf(least.log10().floor());
    let factor = [1.0, 2.0, 5.0, 10.0].into_iter().find(|f| f * power >= least * (1.0 - 1e-9));
    let exponent = least.log10().floor() as i32;
    // Dividing by a whole power of ten keeps 0.1 from becoming 0.1000…02.
    let factor = factor.unwrap_or(10.0);
    if exponent < 0 { factor / 10f64.powi(-exponent) } else { factor * 10f64.powi(exponent) }
}

fn power_of_ten(exponent: i32) -> String {
    let digits = exponent.to_string();
    let raised = digits.chars().map(|c| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        _ => char::from_u32('⁰' as u32 + (c as u32 - '0' as u32)).expect("a digit"),
    });
    format!("10{}", raised.collect::<String>())
}
