//! Maps: a field, a section or a matrix as an image with its axes.

use asperity_base::grid::{Field, Grid};
use ndarray::{ArrayView2, Axis};
use rayon::prelude::*;

use super::axis::{Quantity, Scale, Unit, widened};
use super::colour::{Colours, Range, Shading};
use super::frame::{Frame, Side, THIN};
use super::image::Image;
use super::legend::{Key, Legend, arrow, cross};
use super::output::Paper;
use super::scene::{Anchor, FAINT, INK, PAPER, Point, Rect, Scene, Stroke};
use super::text::{LARGE, MEDIUM};

/// A map whose sides differ more than this is stretched.
const MAX_ASPECT: f64 = 4.0;
/// Arrows along the longer side of a map.
const ARROWS: usize = 20;

/// One map. Values come in SI.
#[derive(Debug, Clone)]
pub struct Map<'a> {
    pub(super) title: String,
    /// Cells `[right, up]`.
    pub(super) cells: ArrayView2<'a, f64>,
    values: Range,
    /// Where the axes begin and end, SI.
    pub(super) ends: [[f64; 2]; 2],
    names: [String; 2],
    unit: Unit,
    /// The axis of y runs downwards.
    down: bool,
    pub(super) quantity: Quantity,
    pub(super) shading: Shading,
    /// Whether the range was given.
    pub(super) given: bool,
    /// What grey cells are.
    missing: &'static str,
    /// What white cells are.
    blank: &'static str,
    /// Whether values lie beyond the range, below and above.
    pub(super) clipped: [bool; 2],
    outline: Option<(&'a Field, &'static str)>,
    contours: Option<&'a Field>,
    arrows: Option<([&'a Field; 2], &'static str)>,
    mark: Option<([f64; 2], &'static str)>,
    block: Option<(f64, String)>,
    /// Parts of the upper edge, from and to along x, SI.
    spans: (Vec<[f64; 2]>, &'static str),
    /// Heights of lines across the map, SI.
    depths: (Vec<f64>, &'static str),
}

impl<'a> Map<'a> {
    /// A field over its grid.
    ///
    /// # Panics
    /// If the field is not on the grid.
    pub fn new(
        title: impl Into<String>,
        field: &'a Field,
        grid: &Grid,
        quantity: Quantity,
        colours: Colours,
    ) -> Self {
        assert_eq!(field.shape(), grid.shape, "a field on another grid");
        let ends = grid.extent().map(|length| [0.0, length]);
        Self::of(title, field.view(), ends, ["x", "y"], Unit::Length, quantity, colours)
    }

    /// A section along x into the depth z, which runs downwards from the surface; `ends` say where it begins
    /// and ends.
    pub fn section(
        title: impl Into<String>,
        field: &'a Field,
        ends: [[f64; 2]; 2],
        quantity: Quantity,
        colours: Colours,
    ) -> Self {
        let mut cells = field.view();
        cells.invert_axis(Axis(1));
        let map = Self::of(title, cells, ends, ["x", "depth"], Unit::Length, quantity, colours);
        Self { down: true, ..map }
    }

    /// A matrix, its first row at the top, on a logarithmic scale; `nodes` are what rows and columns count.
    pub fn matrix(
        title: impl Into<String>,
        matrix: &'a ndarray::Array2<f64>,
        nodes: [&str; 2],
        quantity: Quantity,
    ) -> Self {
        let ends = [matrix.ncols(), matrix.nrows()].map(|n| [-0.5, n as f64 - 0.5]);
        let mut cells = matrix.view().reversed_axes();
        cells.invert_axis(Axis(1));
        let names = [nodes[1], nodes[0]];
        let map = Self::of(title, cells, ends, names, Unit::Count, quantity, Colours::Logarithmic);
        Self { down: true, ..map }
    }

    /// A field over a plane of lags or of wavenumbers, with the origin in its middle sample: `n/2` of `n`
    /// samples.
    pub fn plane(
        title: impl Into<String>,
        field: &'a Field,
        step: [f64; 2],
        names: [&str; 2],
        unit: Unit,
        quantity: Quantity,
        colours: Colours,
    ) -> Self {
        let end = |axis: usize| {
            let samples = field.shape()[axis];
            let before = (samples / 2) as f64 + 0.5;
            [-before * step[axis], (samples as f64 - before) * step[axis]]
        };
        Self::of(title, field.view(), [end(0), end(1)], names, unit, quantity, colours)
    }

    fn of(
        title: impl Into<String>,
        cells: ArrayView2<'a, f64>,
        ends: [[f64; 2]; 2],
        names: [&str; 2],
        unit: Unit,
        quantity: Quantity,
        colours: Colours,
    ) -> Self {
        let values = Range::of(cells);
        let [low, high] = if colours.take_any_sign() { values.all } else { values.positive };
        let range = match colours {
            Colours::Heights | Colours::Between | Colours::Logarithmic => [low, high],
            Colours::Signed if low <= high => [-high.max(-low), high.max(-low)],
            _ if high > 0.0 => [0.0, high],
            _ => [0.0, 1.0],
        };
        let range = match colours {
            Colours::Logarithmic if low == high => [low / 2.0, low * 2.0],
            Colours::Logarithmic if low > high => [0.1, 1.0],
            Colours::Logarithmic => range,
            _ => widened(range),
        };
        Self {
            title: title.into(),
            cells,
            values,
            ends,
            names: names.map(str::to_owned),
            unit,
            down: false,
            quantity,
            shading: Shading { range, colours },
            given: false,
            missing: "not defined",
            blank: "none",
            clipped: [false; 2],
            outline: None,
            contours: None,
            arrows: None,
            mark: None,
            block: None,
            spans: (Vec::new(), ""),
            depths: (Vec::new(), ""),
        }
    }

    /// The same map with given values at the ends of the colours, SI. Maps of one sheet with the same share a
    /// bar.
    pub fn range(mut self, range: [f64; 2]) -> Self {
        // Heights that are all the same have no range.
        if self.shading.colours.take_any_sign() && range[0] >= range[1] {
            return self;
        }
        let [low, high] = self.values.all;
        self.shading.range = widened(range);
        self.given = true;
        let slack = 1e-9 * (range[1] - range[0]);
        let of_any_sign = self.shading.colours.take_any_sign();
        self.clipped = [of_any_sign && low < range[0] - slack, high > range[1] + slack];
        self
    }

    /// The same map with words for what its grey cells are.
    pub fn missing(self, missing: &'static str) -> Self {
        Self { missing, ..self }
    }

    /// The same map with words for what its white cells are.
    pub fn blank(self, blank: &'static str) -> Self {
        Self { blank, ..self }
    }

    /// The same map with a line around the cells where `field` is above 0.
    pub fn outlined(self, field: &'a Field, name: &'static str) -> Self {
        Self { outline: Some((field, name)), ..self }
    }

    /// The same map with a line at each number of its colour bar; the field is that of the map.
    pub fn with_contours(self, field: &'a Field) -> Self {
        Self { contours: Some(field), ..self }
    }

    /// The same map with arrows along a vector of each cell, on a thinned grid.
    pub fn with_arrows(self, vector: [&'a Field; 2], name: &'static str) -> Self {
        Self { arrows: Some((vector, name)), ..self }
    }

    /// The same map with a cross at a point, SI.
    pub fn marked(self, at: [f64; 2], name: &'static str) -> Self {
        Self { mark: Some((at, name)), ..self }
    }

    /// The same matrix with a line around its leading block of so many rows and columns.
    pub fn with_block(self, size: usize, name: impl Into<String>) -> Self {
        Self { block: Some((size as f64, name.into())), ..self }
    }

    /// The same section with a thick line along the surface over each of the `spans`, from and to along x,
    /// SI.
    pub fn with_spans(self, spans: Vec<[f64; 2]>, name: &'static str) -> Self {
        Self { spans: (spans, name), ..self }
    }

    /// The same section with a dashed line across it at each of the `depths`, SI.
    pub fn with_depths(self, depths: Vec<f64>, name: &'static str) -> Self {
        Self { depths: (depths, name), ..self }
    }

    /// Width over height of the map as drawn.
    pub(super) fn aspect(&self) -> f64 {
        let [x, y] = self.lengths();
        (x / y).clamp(1.0 / MAX_ASPECT, MAX_ASPECT)
    }

    fn lengths(&self) -> [f64; 2] {
        self.ends.map(|[begin, end]| end - begin)
    }

    fn is_to_scale(&self) -> bool {
        let [x, y] = self.lengths();
        x.max(y) <= x.min(y) * MAX_ASPECT * (1.0 + 1e-9)
    }

    /// Whether one colour is all there is to see, so that a bar tells nothing.
    pub(super) fn is_flat(&self) -> bool {
        let [low, high] = self.values.all;
        self.shading.colours.take_any_sign() && !self.given && low >= high
    }

    /// The scales of its axes for a size in points.
    pub(super) fn scales(&self, size: [f64; 2]) -> [Scale; 2] {
        let lengths = self.ends.map(|[begin, end]| begin.abs().max(end.abs()));
        let most = [size[0] / 34.0, size[1] / 24.0].map(|n| n.clamp(2.0, 10.0) as usize);
        [0, 1].map(|i| Scale::linear(self.ends[i], lengths[0].max(lengths[1]), self.unit, most[i]))
    }

    /// What its colours and signs mean.
    pub(super) fn explain(&self, legend: &mut Legend) {
        for (colour, name) in self.shading.keys(&self.values, self.missing, self.blank) {
            legend.add(Key::Box(colour), name);
        }
        if let Some((_, name)) = self.outline {
            legend.add(Key::Line(OUTLINE, None), name);
        }
        if let Some((_, name)) = self.arrows {
            legend.add(Key::Arrow(INK), name);
        }
        if let Some((_, name)) = self.mark {
            legend.add(Key::Cross, name);
        }
        if !self.spans.0.is_empty() {
            legend.add(Key::Line(SPAN, None), self.spans.1);
        }
        if !self.depths.0.is_empty() {
            legend.add(Key::Line(ACROSS, None), self.depths.1);
        }
        if let Some((_, name)) = &self.block {
            legend.add(Key::Line(BLOCK, None), name.clone());
        }
    }

    /// Draws the map with its axes.
    pub(super) fn draw(&self, scene: &mut Scene, at: Rect, [x, y]: [&Scale; 2], paper: &Paper) {
        let [fits_x, fits_y] = [paper.pixels(at.width), paper.pixels(at.height)];
        scene.image(self.image([fits_x, fits_y]), at);
        let frame = Frame { at, x, y, down: self.down };
        if let Some((field, _)) = self.outline {
            scene.clipped(at, |scene| scene.lines(outline(field, &frame, self.ends), OUTLINE));
        }
        if let Some(field) = self.contours {
            scene.clipped(at, |scene| {
                self.levels(at.height)
                    .for_each(|level| scene.lines(contour(field, level, &frame, self.ends), CONTOUR));
            });
        }
        if let Some((vector, _)) = self.arrows {
            scene.clipped(at, |scene| arrows(scene, vector, &frame, self.ends));
        }
        for [from, to] in &self.spans.0 {
            let surface = [*from, *to].map(|x| frame.place([x, self.ends[1][0]]));
            if let [Some([from, y]), Some([to, _])] = surface {
                scene.line(&[[from, y - 1.5], [to, y - 1.5]], SPAN);
            }
        }
        for depth in &self.depths.0 {
            let line: Vec<_> = self.ends[0].iter().filter_map(|x| frame.place([*x, *depth])).collect();
            scene.line(&line, ACROSS);
        }
        if let Some((size, _)) = &self.block {
            let corners = [[-0.5, -0.5], [size - 0.5, -0.5], [size - 0.5, size - 0.5], [-0.5, size - 0.5]];
            let corners: Vec<_> =
                corners.iter().chain(&corners[..1]).filter_map(|c| frame.place(*c)).collect();
            scene.line(&corners, Stroke::new(PAPER, 2.4));
            scene.line(&corners, BLOCK);
        }
        if let Some(place) = self.mark.and_then(|(point, _)| frame.place(point)) {
            cross(scene, place);
        }
        if !self.shading.colours.take_any_sign() && self.values.positive[1] < 0.0 {
            scene.words("none", at.middle(), MEDIUM, Anchor::Middle, FAINT);
        }
        let stretched = if self.is_to_scale() { "" } else { ", not to scale" };
        frame.edge(scene, &format!("{}{stretched}", x.label(&self.names[0])));
        frame.side(scene, y, &y.label(&self.names[1]), Side::Left);
        scene.text(&self.title, [at.middle()[0], at.y - LARGE / 2.0 - 3.0], LARGE, Anchor::Middle);
        if self.is_flat() && self.values.all[0].is_finite() {
            scene.words("flat", at.middle(), MEDIUM, Anchor::Middle, PAPER);
        }
    }

    /// The numbers at a bar of a height beside the map, SI, without those at its ends.
    fn levels(&self, height: f64) -> impl Iterator<Item = f64> {
        let [low, high] = self.shading.range;
        let scale = bar_scale(self, low.abs().max(high.abs()), height);
        let inside = scale
            .ticks
            .into_iter()
            .map(|(share, _)| share)
            .filter(|share| *share > 1e-9 && *share < 1.0 - 1e-9);
        inside.map(move |share| low + share * (high - low))
    }

    /// A pixel for a cell, where so many fit.
    fn image(&self, fits: [usize; 2]) -> Image {
        let cells = [self.cells.nrows(), self.cells.ncols()];
        self.shading.image(self.cells, &self.values, [0, 1].map(|axis| cells[axis].min(fits[axis])))
    }
}

const OUTLINE: Stroke = Stroke { colour: [230, 60, 40], width: 0.5, dashed: false };
const CONTOUR: Stroke = Stroke { colour: PAPER, width: 0.5, dashed: false };
const SPAN: Stroke = Stroke { colour: [213, 94, 0], width: 2.4, dashed: false };
const ACROSS: Stroke = Stroke { colour: [90, 150, 255], width: 1.2, dashed: true };
const BLOCK: Stroke = Stroke { colour: [213, 94, 0], width: 1.2, dashed: false };

/// Places along an axis, from its beginning in steps of cells.
fn edge(ends: [f64; 2], cells: usize, index: usize) -> f64 {
    ends[0] + (ends[1] - ends[0]) * index as f64 / cells as f64
}

/// The edges between cells above 0 and others, as long as they run straight.
fn outline(field: &Field, frame: &Frame, ends: [[f64; 2]; 2]) -> Vec<Vec<Point>> {
    let shape = [field.nrows(), field.ncols()];
    // Cells along x, which a line below a row runs along, and along y.
    let along_y: Vec<bool> = field.iter().map(|value| *value > 0.0).collect();
    let mut along_x = vec![false; along_y.len()];
    along_x.par_chunks_mut(shape[0]).enumerate().for_each(|(j, row)| {
        row.iter_mut().enumerate().for_each(|(i, inside)| *inside = along_y[i * shape[1] + j]);
    });
    // Along x below each row, then along y left of each column.
    let lines_of = |axis: usize| {
        let cells: &[bool] = if axis == 0 { &along_x } else { &along_y };
        let (along, across) = (shape[axis], shape[1 - axis]);
        let rows = (0..=across).into_par_iter();
        rows.flat_map_iter(move |c| {
            let row =
                |c: Option<usize>| c.filter(|c| *c < across).map(|c| &cells[c * along..(c + 1) * along]);
            let (before, after) = (row(c.checked_sub(1)), row(Some(c)));
            let inside = |row: Option<&[bool]>, a: usize| row.is_some_and(|row| row[a]);
            let mut lines = Vec::new();
            let mut begin = None;
            for a in 0..=along {
                match (begin, a < along && inside(before, a) != inside(after, a)) {
                    (None, true) => begin = Some(a),
                    (Some(first), false) => {
                        let points = [first, a].map(|a| {
                            let index = if axis == 0 { [a, c] } else { [c, a] };
                            [0, 1].map(|axis| edge(ends[axis], shape[axis], index[axis]))
                        });
                        lines.push(points.iter().filter_map(|point| frame.place(*point)).collect());
                        begin = None;
                    }
                    _ => {}
                }
            }
            lines
        })
    };
    [0, 1].into_iter().flat_map(|axis| lines_of(axis).collect::<Vec<_>>()).collect()
}

/// The line at a level of a field whose cells lie between the ends of the axes.
fn contour(field: &Field, level: f64, frame: &Frame, ends: [[f64; 2]; 2]) -> Vec<Vec<Point>> {
    let cells = [field.nrows(), field.ncols()];
    let place = |at: [f64; 2]| {
        let along = |axis: usize| {
            let [begin, end] = ends[axis];
            begin + (end - begin) * (at[axis] + 0.5) / cells[axis] as f64
        };
        frame.place([along(0), along(1)])
    };
    super::contour::line(field, level, place)
}

/// Means of a vector over blocks of cells, as arrows from the blocks' middles on; the longest is as long as a
/// block.
fn arrows(scene: &mut Scene, vector: [&Field; 2], frame: &Frame, ends: [[f64; 2]; 2]) {
    let shape = [vector[0].nrows(), vector[0].ncols()];
    let block = shape[0].max(shape[1]).div_ceil(ARROWS);
    let counts = shape.map(|n| n.div_ceil(block));
    let mut means = Vec::new();
    for (i, j) in (0..counts[0]).flat_map(|i| (0..counts[1]).map(move |j| (i, j))) {
        let cells = || {
            let rows = move |i: usize| (j * block..((j + 1) * block).min(shape[1])).map(move |j| [i, j]);
            (i * block..((i + 1) * block).min(shape[0])).flat_map(rows)
        };
        let sum = |component: usize| {
            cells().map(|cell| vector[component][cell]).filter(|v| v.is_finite()).sum::<f64>()
        };
        let filled = cells().filter(|c| vector[0][*c] != 0.0 || vector[1][*c] != 0.0).count();
        if filled > 0 {
            let middle = [(i, 0), (j, 1)].map(|(index, axis)| {
                let [first, last] = [index * block, ((index + 1) * block).min(shape[axis])];
                0.5 * (edge(ends[axis], shape[axis], first) + edge(ends[axis], shape[axis], last))
            });
            means.push((middle, [0, 1].map(|component| sum(component) / filled as f64)));
        }
    }
    let longest = means.iter().map(|(_, v)| v[0].hypot(v[1])).fold(0.0, f64::max);
    let room = (frame.at.width / counts[0] as f64).min(frame.at.height / counts[1] as f64).min(24.0);
    for (middle, [x, y]) in means {
        let size = x.hypot(y) / longest;
        let Some([px, py]) = frame.place(middle).filter(|_| size > 0.02) else { continue };
        let half = [0.5 * room * x / longest, -0.5 * room * y / longest];
        let ends = [[px - half[0], py - half[1]], [px + half[0], py + half[1]]];
        arrow(scene, ends, Stroke::new(PAPER, 2.0), 0.45 * room);
        arrow(scene, ends, Stroke::new(INK, 0.8), 0.4 * room);
    }
}

/// A colour bar right of a map, with its axis; ends beyond which values lie are pointed.
pub(super) fn bar(scene: &mut Scene, at: Rect, map: &Map, scale: &Scale, clipped: [bool; 2]) {
    const POINT: f64 = 6.0;
    let shading = &map.shading;
    for (pointed, t, [base, tip]) in
        [(clipped[0], 0.0, [at.bottom(), at.bottom() + POINT]), (clipped[1], 1.0, [at.y, at.y - POINT])]
    {
        if pointed {
            let corners = [[at.x, base], [at.x + at.width / 2.0, tip], [at.right(), base]];
            scene.polygon(&corners, shading.colour(t));
            scene.line(&corners, THIN);
        }
    }
    scene.image(shading.bar(), at);
    scene.rect(at, None, Some(THIN));
    let none = Scale::linear([0.0, 1.0], 1.0, Unit::Number, 1);
    let frame = Frame { at, x: &none, y: scale, down: false };
    let label = scale.label(&map.quantity.name);
    let fits = super::text::width_of(&label, MEDIUM) <= at.height + 36.0;
    frame.side(scene, scale, if fits { &label } else { &scale.symbol }, Side::Right);
}

/// The scale of a colour bar.
pub(super) fn bar_scale(map: &Map, magnitude: f64, height: f64) -> Scale {
    let most = (height / 20.0).clamp(2.0, 10.0) as usize;
    match map.shading.colours {
        Colours::Logarithmic => Scale::logarithmic(map.shading.range, map.quantity.unit, most),
        _ => Scale::linear(map.shading.range, magnitude, map.quantity.unit, most),
    }
}
