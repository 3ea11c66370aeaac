//! Units that suit a range, and ticks at round numbers.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::{Cartesian2d, ChartBuilder, ChartContext, DrawingArea, IntoFont, TextStyle};
use plotters::style::{Color, RGBColor, ShapeStyle};

use super::canvas::{FINE, INK, Pen, Rect, SMALL, width_of};

/// What numbers measure; they are in SI and are shown in a multiple that suits them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unit {
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
    /// Seconds.
    Time,
    /// Radians per metre.
    Wavenumber,
    /// A pure number.
    Number,
    /// A unit without multiples, such as "m/Pa".
    Of(&'static str),
}

/// What a colour or an axis shows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Quantity {
    /// The name, such as "pressure".
    pub(crate) name: String,
    /// Its unit.
    pub(crate) unit: Unit,
}

impl Quantity {
    /// A quantity with its name and unit.
    pub(crate) fn new(name: impl Into<String>, unit: Unit) -> Self {
        Self { name: name.into(), unit }
    }
}

impl Unit {
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
            Self::Time => (&[(1e-9, "ns"), (1e-6, "µs"), (1e-3, "ms"), (1.0, "s")], 1.0),
            Self::Wavenumber => (&[(1.0, "rad/m"), (1e3, "rad/mm"), (1e6, "rad/µm"), (1e9, "rad/nm")], 1.0),
            Self::Number => (&[(1.0, "")], 1.0),
            Self::Of(_) => (&[(1.0, "")], 1.0),
        }
    }

    /// The SI unit itself.
    fn base(self) -> &'static str {
        match self {
            Self::Of(unit) => unit,
            _ => {
                self.multiples().0.iter().find(|(factor, _)| *factor == 1.0).map_or("", |(_, symbol)| symbol)
            }
        }
    }

    /// The multiple for numbers up to `magnitude`: its size in SI, its symbol.
    pub(super) fn shown(self, magnitude: f64) -> (f64, String) {
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

/// An axis: the range it shows, in the unit it shows (or the decimal logarithm), and its ticks.
#[derive(Debug, Clone)]
pub(super) struct Scale {
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) ticks: Vec<(f64, String)>,
    pub(super) minor: Vec<f64>,
    pub(super) symbol: String,
    factor: f64,
    log: bool,
}

impl Scale {
    /// A linear axis over `range` (SI), whose unit suits numbers up to `magnitude`, with about `most` ticks.
    pub(super) fn linear(range: [f64; 2], magnitude: f64, unit: Unit, most: usize) -> Self {
        let (factor, symbol) = unit.shown(magnitude);
        let [low, high] = range.map(|v| v / factor);
        let step = round_step((high - low) / most.max(1) as f64);
        let decimals = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
        let slack = (high - low) * 1e-9;
        let first = ((low - slack) / step).ceil() as i64;
        let last = ((high + slack) / step).floor() as i64;
        let ticks = (first..=last)
            .map(|i| {
                let label = format!("{:.decimals$}", i as f64 * step);
                (i as f64 * step, label.replace('-', "−"))
            })
            .collect();
        // One tick tells no scale.
        if first == last && most < 8 {
            return Self::linear(range, magnitude, unit, most + 1);
        }
        Self { low, high, ticks, minor: Vec::new(), symbol, factor, log: false }
    }

    /// A logarithmic axis over `range` (SI, positive), with about `most` ticks.
    pub(super) fn logarithmic(range: [f64; 2], unit: Unit, most: usize) -> Self {
        let [low, high] = range.map(f64::log10);
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
        let ticks = (first - 1..=last)
            .filter(|e| mantissas.len() > 1 || (e - first) % stride == 0)
            .flat_map(|e| mantissas.iter().map(move |&m| (e, m)))
            .map(|(e, m)| (at(e, m), label(e, m)))
            .filter(|(position, _)| inside(position))
            .collect();
        let minor = (first - 1..=last).flat_map(|e| (1..10).map(move |m| at(e, m))).filter(inside).collect();
        Self { low, high, ticks, minor, symbol: unit.base().to_owned(), factor: 1.0, log: true }
    }

    /// Where `value` (SI) lies on the axis; `None` if the axis cannot show it.
    pub(super) fn position(&self, value: f64) -> Option<f64> {
        let position = if self.log { value.log10() } else { value / self.factor };
        position.is_finite().then_some(position)
    }

    /// The same, within the axis's ends.
    pub(super) fn inside(&self, value: f64) -> Option<f64> {
        let slack = 1e-9 * (self.high - self.low);
        self.position(value).filter(|p| (self.low - slack..=self.high + slack).contains(p))
    }

    /// The axis without ticks.
    pub(super) fn bare(&self) -> Self {
        Self { ticks: Vec::new(), minor: Vec::new(), ..self.clone() }
    }

    /// `name (unit)`.
    pub(super) fn label(&self, name: &str) -> String {
        if self.symbol.is_empty() { name.to_owned() } else { format!("{name} ({})", self.symbol) }
    }

    /// Width of the widest tick label, px.
    pub(super) fn width(&self) -> f64 {
        self.ticks.iter().map(|(_, label)| width_of(label, SMALL)).fold(0.0, f64::max)
    }

    pub(super) fn coordinate(&self) -> Coordinate {
        Coordinate { scale: self.clone(), line: RangedCoordf64::from(self.low..self.high) }
    }

    /// The axis with its low end at the top.
    pub(super) fn reversed(&self) -> Coordinate {
        Coordinate { scale: self.clone(), line: RangedCoordf64::from(self.high..self.low) }
    }
}

/// The axis as plotters sees it: our ticks are its key points, the minor ones its light points.
pub(super) struct Coordinate {
    scale: Scale,
    line: RangedCoordf64,
}

impl Ranged for Coordinate {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        self.line.map(value, limit)
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() {
            self.scale.minor.clone()
        } else {
            self.scale.ticks.iter().map(|tick| tick.0).collect()
        }
    }

    fn range(&self) -> Range<f64> {
        self.line.range()
    }
}

impl ValueFormatter<f64> for Coordinate {
    fn format(position: &f64) -> String {
        position.to_string()
    }

    fn format_ext(&self, position: &f64) -> String {
        let tick = self.scale.ticks.iter().find(|tick| tick.0 == *position);
        tick.map_or(String::new(), |tick| tick.1.clone())
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

pub(super) type Area<'a> = DrawingArea<Pen<'a>, Shift>;
pub(super) type Chart<'a> = ChartContext<'a, Pen<'a>, Cartesian2d<Coordinate, Coordinate>>;

/// Draws the axes with ticks and labels, and no mesh.
pub(super) fn bare_axes(chart: &mut Chart<'_>) {
    chart
        .configure_mesh()
        .disable_mesh()
        .axis_style(axis_style())
        .label_style(tick_style())
        .set_all_tick_mark_size(TICK)
        .draw()
        .expect(SOUND);
}

/// A chart whose plotting rectangle is `at`; the label areas reach to the edges of the sheet where there are labels.
pub(super) fn chart<'a>(area: &Area<'a>, at: Rect, [x, y]: [Coordinate; 2], labels: Labels) -> Chart<'a> {
    let (width, height) = area.dim_in_pixel();
    let right = width as i32 - (at.x + at.width) * FINE;
    let bottom = height as i32 - (at.y + at.height) * FINE;
    let mut builder = ChartBuilder::on(area);
    builder.margin_top(at.y * FINE).x_label_area_size(bottom);
    match labels {
        Labels::Left => builder.y_label_area_size(at.x * FINE).margin_right(right),
        Labels::Right => builder.margin_left(at.x * FINE).right_y_label_area_size(right),
    };
    builder.build_cartesian_2d(x, y).expect(SOUND)
}

/// The side on which y is labelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Labels {
    Left,
    Right,
}

/// Why drawing cannot fail.
pub(super) const SOUND: &str = "the canvas accepts everything";

/// Length of a tick, fine px.
pub(super) const TICK: i32 = 4 * FINE;

pub(super) fn tick_style() -> TextStyle<'static> {
    ("sans-serif", SMALL * f64::from(FINE)).into_font().color(&colour(INK))
}

pub(super) fn axis_style() -> ShapeStyle {
    colour(INK).stroke_width(FINE as u32)
}

pub(super) fn colour([r, g, b]: super::canvas::Rgb) -> RGBColor {
    RGBColor(r, g, b)
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
