//! Curves, points and bars over one axis, with a second y axis on the right where there is need.

use super::axis::{Scale, Unit, extremes, widened};
use super::frame::{BELOW, Frame, Side, beside};
use super::image::Rgb;
use super::legend::{Key, Legend, arrow, marker};
use super::output::{Figure, Paper};
use super::scene::{Anchor, FAINT, Rect, Scene, Stroke};
use super::text::{LARGE, MEDIUM, SMALL};

/// Okabe and Ito's colours, told apart by colour-blind eyes.
const PALETTE: [Rgb; 7] =
    [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [230, 159, 0], [86, 180, 233], [0, 0, 0]];
/// Shaded areas.
const SHADE: Rgb = [222, 235, 246];
/// Width of a chart alone and of a sheet of them, pt.
const WIDTHS: [f64; 2] = [360.0, 482.0];

/// What an axis shows.
#[derive(Debug, Clone)]
pub struct Axis {
    /// The label, without its unit.
    pub label: String,
    /// Numbers come in SI.
    pub unit: Unit,
    /// Logarithmic: numbers that are not positive are left out.
    pub log: bool,
    /// First and last number shown, SI; by default all of the data.
    pub range: Option<[f64; 2]>,
}

impl Axis {
    /// A linear axis that shows all data.
    pub fn linear(label: impl Into<String>, unit: Unit) -> Self {
        Self { label: label.into(), unit, log: false, range: None }
    }

    /// A linear axis in the unit of a column of the results.
    pub fn of(label: impl Into<String>, column: &str) -> Self {
        Self::linear(label, Unit::of_column(column))
    }

    /// A logarithmic axis that shows all positive data.
    pub fn log(label: impl Into<String>, unit: Unit) -> Self {
        Self { log: true, ..Self::linear(label, unit) }
    }
}

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// A line.
    Line,
    /// A broken line, for a limit or a slope to compare with.
    Dashed,
    /// A line with markers.
    LineAndPoints,
    /// A broken line with markers.
    DashedAndPoints,
    /// Markers.
    Points,
    /// A line with arrows in the order of its points.
    Arrows,
    /// Bars from zero, side by side.
    Bars,
}

/// Points to be drawn alike. A line is broken where a number is not finite.
#[derive(Debug, Clone)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// Pairs `[x, y]` in SI.
    pub points: Vec<[f64; 2]>,
    /// How it is drawn.
    pub mark: Mark,
    /// The axis that y is read on.
    side: Side,
}

impl Series {
    /// A series on the left axis.
    pub fn new(name: impl Into<String>, points: Vec<[f64; 2]>, mark: Mark) -> Self {
        Self { name: name.into(), points, mark, side: Side::Left }
    }

    /// Whether it is read on the right axis.
    pub fn is_on_the_right(&self) -> bool {
        self.side == Side::Right
    }

    /// The same series, on the right axis.
    pub fn on_the_right(self) -> Self {
        Self { side: Side::Right, ..self }
    }
}

/// Curves over one axis.
#[derive(Debug, Clone)]
pub struct Chart {
    /// Stands above the chart, where there are several.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The axis on the left.
    pub y: Axis,
    /// The axis on the right, if there are two.
    pub right: Option<Axis>,
    /// The curves, drawn in this order.
    pub series: Vec<Series>,
    /// Words beside points of the left axis.
    pub words: Vec<([f64; 2], String)>,
    /// Areas under the curves with their name, each within a line of points.
    pub shaded: Option<(String, Vec<Vec<[f64; 2]>>)>,
}

impl Chart {
    /// A chart with one y axis and without words.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis, series: Vec<Series>) -> Self {
        Self { title: title.into(), x, y, right: None, series, words: Vec::new(), shaded: None }
    }

    /// Whether every number on it is the same but for what a solver's tolerance leaves: a load that is held.
    pub fn is_held(&self) -> bool {
        const HELD: f64 = 1e-5;
        let numbers = || self.series.iter().flat_map(|series| &series.points).map(|[_, y]| *y);
        let [low, high] = extremes(numbers());
        numbers().count() > 2 && low > 0.0 && high - low <= HELD * high
    }

    /// The same chart with an axis on the right.
    pub fn with_right(self, axis: Axis) -> Self {
        Self { right: Some(axis), ..self }
    }
}

/// A sheet of charts with one legend.
#[derive(Debug, Clone)]
pub struct Charts {
    /// The charts, row by row.
    pub charts: Vec<Chart>,
    /// How many stand in a row.
    pub columns: usize,
    /// Height of a chart over its width.
    pub aspect: f64,
}

impl From<Chart> for Charts {
    fn from(chart: Chart) -> Self {
        Self { charts: vec![chart], columns: 1, aspect: 0.6 }
    }
}

impl Figure for Charts {
    fn scene(&self, paper: &Paper) -> Scene {
        let width = paper.width(WIDTHS[usize::from(self.columns > 1)]);
        let columns = self.columns.clamp(1, self.charts.len().max(1));
        let rows = self.charts.len().div_ceil(columns);
        let outer = [width / columns as f64, width / columns as f64 * self.aspect];
        let (names, legend) = self.names();
        let titled = self.charts.iter().any(|chart| !chart.title.is_empty());
        let above = if titled { LARGE + 8.0 } else { 8.0 };
        let room = width - 24.0;
        let top = legend.height(room);
        let mut scene = Scene::new([width, top + rows as f64 * (above + outer[1]) + 4.0]);
        legend.draw(&mut scene, [12.0, 0.0], room);

        let drawn: Vec<Drawn> =
            self.charts.iter().map(|chart| Drawn::new(chart, outer, paper.range)).collect();
        // Charts of one column stand under each other.
        let widest = |column: usize, side: usize| {
            let below = drawn.iter().skip(column).step_by(columns);
            below.map(|chart| chart.margins[side]).fold(0.0, f64::max)
        };
        for (i, chart) in drawn.iter().enumerate() {
            let [left, right] = [0, 1].map(|side| widest(i % columns, side));
            let at = Rect {
                x: (i % columns) as f64 * outer[0] + left,
                y: top + (i / columns) as f64 * (above + outer[1]) + above,
                width: (outer[0] - left - right).max(20.0),
                height: (outer[1] - BELOW - 4.0).max(20.0),
            };
            scene.text(&chart.chart.title, [at.middle()[0], at.y - LARGE / 2.0 - 3.0], LARGE, Anchor::Middle);
            chart.draw(&mut scene, at, &names);
        }
        scene
    }
}

impl Charts {
    /// The names of all series, each once, which says how they look; and their legend, if there is more than
    /// one.
    fn names(&self) -> (Vec<&str>, Legend) {
        let mut names: Vec<&str> = Vec::new();
        let mut legend = Legend::default();
        let both = self.charts.iter().any(|chart| chart.right.is_some());
        for series in self.charts.iter().flat_map(|chart| &chart.series) {
            if !names.contains(&series.name.as_str()) {
                names.push(&series.name);
                if series.name.is_empty() {
                    continue;
                }
                let look = Style::of(series, &names);
                let side = if both && series.side == Side::Right { " (right)" } else { "" };
                legend.add(look.key(), format!("{}{side}", series.name));
            }
        }
        if names.iter().filter(|name| !name.is_empty()).count() < 2 {
            legend = Legend::default();
        }
        for (name, areas) in self.charts.iter().filter_map(|chart| chart.shaded.as_ref()) {
            if !areas.is_empty() {
                legend.add(Key::Box(SHADE), name.clone());
            }
        }
        (names, legend)
    }
}

/// A chart with its scales.
struct Drawn<'a> {
    chart: &'a Chart,
    x: Scale,
    y: Scale,
    right: Option<Scale>,
    /// What the axes on the left and on the right take, pt.
    margins: [f64; 2],
}

impl<'a> Drawn<'a> {
    fn new(chart: &'a Chart, outer: [f64; 2], range: Option<[f64; 2]>) -> Self {
        let all = |side: Option<Side>, axis: usize| {
            let series = chart.series.iter().filter(move |s| side.is_none_or(|side| s.side == side));
            series.flat_map(move |s| s.points.iter().map(move |p| p[axis]))
        };
        let of_points =
            |mark| matches!(mark, Mark::LineAndPoints | Mark::DashedAndPoints | Mark::Points | Mark::Arrows);
        let marked = chart.series.iter().any(|s| of_points(s.mark));
        let most = [(outer[0] - 60.0) / 40.0, (outer[1] - BELOW) / 24.0].map(|n| n.clamp(2.0, 10.0) as usize);
        let x = scale(&chart.x, all(None, 0), if marked { 0.025 } else { 0.0 }, false, most[0]);
        let y = Axis { range: range.or(chart.y.range), ..chart.y.clone() };
        // Words beside the lowest and the highest point have room within the frame.
        let room = if chart.words.is_empty() { 0.06 } else { 0.14 };
        let y = scale(&y, all(Some(Side::Left), 1), room, true, most[1]);
        let right =
            chart.right.as_ref().map(|axis| scale(axis, all(Some(Side::Right), 1), 0.06, true, most[1]));
        let margins = [8.0 + beside(&y), right.as_ref().map_or(12.0, |right| 8.0 + beside(right))];
        Self { chart, x, y, right, margins }
    }

    fn draw(&self, scene: &mut Scene, at: Rect, names: &[&str]) {
        let chart = self.chart;
        let left = Frame { at, x: &self.x, y: &self.y, down: false };
        for area in chart.shaded.iter().flat_map(|(_, areas)| areas) {
            let corners: Vec<_> = area.iter().filter_map(|point| left.place(*point)).collect();
            scene.clipped(at, |scene| scene.polygon(&corners, SHADE));
        }
        left.mesh(scene);
        let mut nothing = true;
        for series in &chart.series {
            let look = Style::of(series, names);
            let y = match (series.side, &self.right) {
                (Side::Right, Some(right)) => right,
                _ => &self.y,
            };
            nothing &= !look.draw(scene, &Frame { at, x: &self.x, y, down: false }, &series.points);
        }
        for (point, words) in &chart.words {
            let Some([x, y]) = left.place(*point).filter(|place| left.holds(*place)) else { continue };
            // Towards the middle, and above or below a curve that rises.
            let within = |y: f64| {
                y.clamp(at.y + 0.5 * SMALL + 2.0, (at.bottom() - 0.5 * SMALL - 2.0).max(at.y + SMALL))
            };
            if x > at.middle()[0] {
                scene.text(words, [x - 5.0, within(y - 7.0)], SMALL, Anchor::End)
            } else {
                scene.text(words, [x + 5.0, within(y + 8.0)], SMALL, Anchor::Start)
            }
        }
        if nothing {
            scene.words("none", at.middle(), MEDIUM, Anchor::Middle, FAINT);
        }
        left.edge(scene, &self.x.label(&chart.x.label));
        left.side(scene, &self.y, &self.y.label(&chart.y.label), Side::Left);
        if let (Some(right), Some(axis)) = (&self.right, &chart.right) {
            let frame = Frame { at, x: &self.x, y: right, down: false };
            frame.side(scene, right, &right.label(&axis.label), Side::Right);
        }
    }
}

/// The scale of an axis; `to_zero` shows the zero if it is near.
fn scale(axis: &Axis, values: impl Iterator<Item = f64>, margin: f64, to_zero: bool, most: usize) -> Scale {
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
        let low = if to_zero && (0.0..0.4 * high).contains(&low) { 0.0 } else { low - margin };
        [low, high + margin]
    });
    let [low, high] = widened(range);
    Scale::linear([low, high], low.abs().max(high.abs()), axis.unit, most)
}

/// How a series looks.
#[derive(Clone, Copy)]
struct Style {
    stroke: Stroke,
    mark: Mark,
    shape: usize,
}

impl Style {
    /// The look of a series, by the place of its name; "a body, undeformed" has the colour of "a body", and
    /// so have "a method, one way" and "a method, another way".
    fn of(series: &Series, names: &[&str]) -> Self {
        let base =
            |name: &str| name.split_once(", ").map_or_else(|| name.to_owned(), |(base, _)| base.to_owned());
        let mut bases: Vec<String> = Vec::new();
        for name in names {
            if !bases.contains(&base(name)) {
                bases.push(base(name));
            }
        }
        let index = bases.iter().position(|other| *other == base(&series.name)).unwrap_or_default();
        let mark = series.mark;
        let dashed = matches!(mark, Mark::Dashed | Mark::DashedAndPoints);
        let stroke = Stroke { dashed, ..Stroke::new(PALETTE[index % PALETTE.len()], 1.2) };
        Self { stroke, mark, shape: index }
    }

    fn key(&self) -> Key {
        match self.mark {
            Mark::Bars => Key::Box(self.stroke.colour),
            Mark::LineAndPoints | Mark::DashedAndPoints => Key::Line(self.stroke, Some(self.shape)),
            Mark::Points => Key::Marker(self.stroke.colour, self.shape),
            _ => Key::Line(self.stroke, None),
        }
    }

    /// Draws the points, and says whether there was one to be seen.
    fn draw(&self, scene: &mut Scene, frame: &Frame, points: &[[f64; 2]]) -> bool {
        let places: Vec<Option<[f64; 2]>> = points.iter().map(|point| frame.place(*point)).collect();
        if self.mark == Mark::Bars {
            self.bars(scene, frame, points);
        } else if self.mark != Mark::Points {
            let runs = places.split(Option::is_none);
            let lines = runs.map(|run| run.iter().flatten().copied().collect()).collect();
            scene.clipped(frame.at, |scene| {
                scene.lines(lines, self.stroke);
                if self.mark == Mark::Arrows {
                    self.arrows(scene, &places);
                }
            });
        }
        let seen = places.iter().flatten().filter(|place| frame.holds(**place));
        if matches!(self.mark, Mark::LineAndPoints | Mark::DashedAndPoints | Mark::Points) {
            seen.clone().for_each(|place| marker(scene, *place, self.shape, self.stroke.colour));
        }
        seen.count() > 0
    }

    fn bars(&self, scene: &mut Scene, frame: &Frame, points: &[[f64; 2]]) {
        let half = match points {
            [first, second, ..] => 0.5 * (second[0] - first[0]),
            _ => return,
        };
        scene.clipped(frame.at, |scene| {
            for [x, y] in points.iter().filter(|point| point[1] > 0.0) {
                let corners = [[x - half, 0.0], [x + half, *y]].map(|corner| frame.place(corner));
                if let [Some([left, bottom]), Some([right, top])] = corners {
                    let at = Rect { x: left, y: top, width: (right - left) * 0.96, height: bottom - top };
                    scene.rect(at, Some(self.stroke.colour), None);
                }
            }
        });
    }

    /// Heads along the line, a certain way apart.
    fn arrows(&self, scene: &mut Scene, places: &[Option<[f64; 2]>]) {
        const APART: f64 = 45.0;
        let mut gone = 0.6 * APART;
        for pair in places.windows(2) {
            if let [Some(from), Some(to)] = pair {
                gone += (to[0] - from[0]).hypot(to[1] - from[1]);
                if gone >= APART {
                    gone = 0.0;
                    arrow(scene, [*from, *to], self.stroke, 6.0);
                }
            }
        }
    }
}
