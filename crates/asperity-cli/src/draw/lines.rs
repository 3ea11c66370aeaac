//! Curves and points over one axis, with a second y axis on the right where there is need.

use std::path::Path;

use plotters::element::{Circle, PathElement, Polygon};
use plotters::prelude::IntoDrawingArea;
use plotters::series::{DashedLineSeries, LineSeries};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontTransform, RGBColor, ShapeStyle};

use super::axis::{
    Area, Chart, Labels, SOUND, Scale, TICK, Unit, axis_style, bare_axes, chart, colour, extremes,
    tick_style, widened,
};
use super::canvas::{Canvas, FINE, MEDIUM, Pen, Rect, Rgb};
use super::map::{CENTRE_BOTTOM, CENTRE_TOP, Key, Legend, heading};
use super::{Result, at, invalid, write};

/// Okabe and Ito's colours, told apart by colour-blind eyes.
const PALETTE: [Rgb; 7] =
    [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [230, 159, 0], [86, 180, 233], [0, 0, 0]];
const SIZE: [i32; 2] = [760, 460];
const KEY: i32 = 30;

/// What an axis shows.
#[derive(Debug, Clone)]
pub(crate) struct Axis {
    /// The label, without its unit.
    pub(crate) label: String,
    /// Numbers come in SI.
    pub(crate) unit: Unit,
    /// Logarithmic: numbers that are not positive are left out.
    pub(crate) log: bool,
    /// First and last number shown, SI; by default all of the data.
    pub(crate) range: Option<[f64; 2]>,
}

impl Axis {
    /// A linear axis that shows all data.
    pub(crate) fn linear(label: impl Into<String>, unit: Unit) -> Self {
        Self { label: label.into(), unit, log: false, range: None }
    }

    /// A logarithmic axis that shows all positive data.
    pub(crate) fn log(label: impl Into<String>, unit: Unit) -> Self {
        Self { log: true, ..Self::linear(label, unit) }
    }
}

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mark {
    /// A line.
    Line,
    /// A broken line, for a limit or a slope to compare with.
    Dashed,
    /// A line with markers.
    LineAndPoints,
}

/// The y axis that a series belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    /// [`LineFigure::y`].
    Left,
    /// [`LineFigure::right`].
    Right,
}

/// Points to be drawn alike. A line is broken where a number is not finite.
#[derive(Debug, Clone)]
pub(crate) struct Series {
    /// Name in the legend.
    pub(crate) name: String,
    /// Pairs `[x, y]` in SI.
    pub(crate) points: Vec<[f64; 2]>,
    /// How it is drawn.
    pub(crate) mark: Mark,
    /// The axis that y is read on.
    pub(crate) side: Side,
}

impl Series {
    /// A series on the left axis.
    pub(crate) fn new(name: impl Into<String>, points: Vec<[f64; 2]>, mark: Mark) -> Self {
        Self { name: name.into(), points, mark, side: Side::Left }
    }

    /// The same series, on the right axis.
    pub(crate) fn on_the_right(self) -> Self {
        Self { side: Side::Right, ..self }
    }
}

/// A figure of curves.
#[derive(Debug, Clone)]
pub(crate) struct LineFigure {
    /// Stands above the figure.
    pub(crate) title: String,
    /// The horizontal axis.
    pub(crate) x: Axis,
    /// The axis on the left.
    pub(crate) y: Axis,
    /// The axis on the right, if there are two.
    pub(crate) right: Option<Axis>,
    /// The curves, drawn in this order.
    pub(crate) series: Vec<Series>,
}

/// Draws curves into the PNG file `path`. A legend above names them if there are several.
pub(crate) fn lines(path: &Path, figure: &LineFigure) -> Result<()> {
    if figure.right.is_none() && figure.series.iter().any(|s| s.side == Side::Right) {
        return Err(invalid(path, "a series on the right, but no axis there".to_owned()));
    }
    let canvas = drawn(figure);
    write(path, &canvas.reduced().png().map_err(at(path))?)
}

fn drawn(figure: &LineFigure) -> Canvas {
    let all = |side: Option<Side>, axis: usize| {
        let series = figure.series.iter().filter(move |s| side.is_none_or(|side| s.side == side));
        series.flat_map(move |s| s.points.iter().map(move |p| p[axis]))
    };
    let marked = figure.series.iter().any(|s| s.mark == Mark::LineAndPoints);
    let x = scale(&figure.x, all(None, 0), Way::X { margin: if marked { 0.025 } else { 0.0 } });
    let y = scale(&figure.y, all(Some(Side::Left), 1), Way::Y);
    let second = figure.right.as_ref().map(|axis| scale(axis, all(Some(Side::Right), 1), Way::Y));

    let [width, height] = SIZE;
    let left = (y.width() + MEDIUM + 38.0).ceil() as i32;
    let right = second.as_ref().map_or(26, |s| (s.width() + MEDIUM + 38.0).ceil() as i32);
    let names = figure.series.iter().map(|s| {
        let both = figure.right.is_some() && s.side == Side::Right;
        (Key::Room(KEY), if both { format!("{} (right)", s.name) } else { s.name.clone() }.into())
    });
    let legend =
        Legend::new(names.take(if figure.series.len() > 1 { usize::MAX } else { 0 }), width - left - right);
    let top = if figure.title.is_empty() { 16 } else { 38 } + legend.height();
    let at = Rect { x: left, y: top, width: width - left - right, height: height - top - 58 };

    let mut canvas = Canvas::new(width, height);
    let middle = [f64::from(at.x) + f64::from(at.width) / 2.0, f64::from(at.y) + f64::from(at.height) / 2.0];
    heading(&mut canvas, &figure.title, [middle[0], 22.0], f64::from(width));
    let starts = legend.draw(&mut canvas, f64::from(left), f64::from(top - legend.height()));
    let bottom = f64::from(at.y + at.height) + 34.0;
    canvas.text(&x.label(&figure.x.label), [middle[0], bottom], MEDIUM, CENTRE_TOP, FontTransform::None);
    let y_label = y.label(&figure.y.label);
    let edge = f64::from(at.x) - y.width() - 22.0;
    canvas.text(&y_label, [edge, middle[1]], MEDIUM, CENTRE_BOTTOM, FontTransform::Rotate270);
    if let (Some(scale), Some(axis)) = (&second, &figure.right) {
        let edge = f64::from(at.x + at.width) + scale.width() + 22.0;
        let anchor = Pos { h_pos: HPos::Center, v_pos: VPos::Bottom };
        canvas.text(&scale.label(&axis.label), [edge, middle[1]], MEDIUM, anchor, FontTransform::Rotate90);
    }

    canvas.frame(at);

    let area = Pen(&mut canvas).into_drawing_area();
    let mut on_left = chart(&area, at, [x.coordinate(), y.coordinate()], Labels::Left);
    on_left
        .configure_mesh()
        .axis_style(axis_style())
        .bold_line_style(colour([222, 222, 222]).stroke_width(FINE as u32))
        .light_line_style(colour([240, 240, 240]).stroke_width(FINE as u32))
        .label_style(tick_style())
        .set_all_tick_mark_size(TICK)
        .draw()
        .expect(SOUND);
    let mut on_right = second.as_ref().map(|second| {
        let mut chart = chart(&area, at, [x.bare().coordinate(), second.coordinate()], Labels::Right);
        bare_axes(&mut chart);
        (chart, second)
    });
    for (i, series) in figure.series.iter().enumerate() {
        let look = Look::new(i, series.mark);
        match (series.side, &mut on_right) {
            (Side::Right, Some((chart, second))) => curve(&area, chart, series, [&x, second], look),
            _ => curve(&area, &mut on_left, series, [&x, &y], look),
        }
        if let Some(start) = starts.get(i) {
            sample(&area, start.map(|v| (v * f64::from(FINE)) as i32), look);
        }
    }
    drop((on_left, on_right, area));
    canvas
}

/// Draws the points that lie within the axes.
fn curve(area: &Area, chart: &mut Chart, series: &Series, [x, y]: [&Scale; 2], look: Look) {
    let points: Vec<_> = series.points.iter().map(|p| Some((x.inside(p[0])?, y.inside(p[1])?))).collect();
    for run in points.split(Option::is_none) {
        let run = run.iter().flatten().copied();
        if look.mark == Mark::Dashed {
            let dash = 7 * FINE as u32;
            chart.draw_series(DashedLineSeries::new(run, dash, dash * 2 / 3, look.stroke())).expect(SOUND);
        } else if look.has_line() {
            chart.draw_series(LineSeries::new(run, look.stroke())).expect(SOUND);
        }
    }
    if look.has_points() {
        for point in points.iter().flatten() {
            marker(area, chart.backend_coord(point), look);
        }
    }
}

fn marker(area: &Area, at: (i32, i32), look: Look) {
    let style = look.colour.filled();
    let about = |corners: &[(i32, i32)]| corners.iter().map(|c| (at.0 + c.0, at.1 + c.1)).collect::<Vec<_>>();
    match look.shape {
        0 => area.draw(&Circle::new(at, 8, style)),
        1 => area.draw(&Polygon::new(about(&[(-7, -7), (7, -7), (7, 7), (-7, 7)]), style)),
        _ => area.draw(&Polygon::new(about(&[(0, -9), (9, 7), (-9, 7)]), style)),
    }
    .expect(SOUND);
}

/// The series' key in the legend.
fn sample(area: &Area, [x, y]: [i32; 2], look: Look) {
    let length = KEY * FINE;
    let dashes = match look.mark {
        Mark::Dashed => vec![(x, x + length * 2 / 5), (x + length * 3 / 5, x + length)],
        _ => vec![(x, x + length)],
    };
    for (from, to) in dashes {
        area.draw(&PathElement::new(vec![(from, y), (to, y)], look.stroke())).expect(SOUND);
    }
    if look.has_points() {
        marker(area, (x + length / 2, y), look);
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Way {
    /// With a margin at both ends, relative to the range.
    X {
        margin: f64,
    },
    Y,
}

fn scale(axis: &Axis, values: impl Iterator<Item = f64>, way: Way) -> Scale {
    let (most, margin) = match way {
        Way::X { margin } => (10, margin),
        Way::Y => (7, 0.06),
    };
    if axis.log {
        let [low, high] = axis.range.unwrap_or_else(|| extremes(values.filter(|v| *v > 0.0)));
        let [low, high] = if 0.0 < low && low <= high && high.is_finite() { [low, high] } else { [0.1, 1.0] };
        let pad = match axis.range {
            Some(_) if low < high => 1.0,
            _ if low == high => 2.0,
            _ => (high / low).powf(0.04).max(1.1),
        };
        return Scale::logarithmic([low / pad, high * pad], axis.unit, most);
    }
    let range = axis.range.unwrap_or_else(|| {
        let [low, high] = widened(extremes(values));
        let margin = margin * (high - low);
        // Show the zero if it is near.
        let low = if way == Way::Y && (0.0..0.4 * high).contains(&low) { 0.0 } else { low - margin };
        [low, high + margin]
    });
    let [low, high] = widened(range);
    Scale::linear([low, high], low.abs().max(high.abs()), axis.unit, most)
}

#[derive(Clone, Copy)]
struct Look {
    colour: RGBColor,
    mark: Mark,
    shape: usize,
}

impl Look {
    fn new(index: usize, mark: Mark) -> Self {
        Self { colour: colour(PALETTE[index % PALETTE.len()]), mark, shape: index % 3 }
    }

    fn stroke(&self) -> ShapeStyle {
        self.colour.stroke_width(2 * FINE as u32)
    }

    fn has_line(&self) -> bool {
        matches!(self.mark, Mark::Line | Mark::LineAndPoints)
    }

    fn has_points(&self) -> bool {
        self.mark == Mark::LineAndPoints
    }
}
