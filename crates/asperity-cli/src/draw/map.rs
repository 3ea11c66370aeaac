//! Maps: a field, or a matrix, as an image with its axes and a colour bar.

use std::path::Path;

use asperity::grid::{Field, Grid};
use colorous::{CIVIDIS, VIRIDIS};
use ndarray::{ArrayView2, Axis};
use plotters::prelude::IntoDrawingArea;
use plotters::style::FontTransform;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::axis::{Coordinate, Labels, Quantity, Scale, Unit, bare_axes, chart, extremes, widened};
use super::canvas::{
    CAPITAL, Canvas, INK, Image, LARGE, MEDIUM, PAPER, Pen, Rect, Rgb, SMALL, mix, width_of,
};
use super::{Result, at, invalid, write};

/// Undefined cells, and what lies outside an overlap.
pub(super) const MISSING: Rgb = [218, 218, 218];
const ELASTIC: Rgb = [0, 114, 178];
const PLASTIC: Rgb = [213, 94, 0];

/// A map whose sides differ more than this is stretched.
const MAX_ASPECT: f64 = 4.0;
/// Width of a map alone, or in two, three, four or more columns, px.
const WIDTHS: [f64; 4] = [540.0, 420.0, 330.0, 270.0];
const BAR: i32 = 16;
const GAP: i32 = 8;

/// How a field is coloured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Colours {
    /// Cividis, from the lowest to the highest.
    Heights,
    /// Viridis, from zero; cells without pressure are white.
    Pressure,
    /// The field is a pressure: no contact (p ≤ 0), elastic, or plastic (p at `hardness`, within 10⁻⁶ of it).
    Contact {
        /// Cap on the pressure, Pa; infinite if there is none.
        hardness: f64,
    },
    /// No contact (0), slip (1) or stick (2).
    Stick,
}

/// One map.
#[derive(Debug, Clone)]
pub(crate) struct MapFigure<'a> {
    /// Stands above the map.
    pub(crate) title: String,
    /// Values in SI, of the grid's shape.
    pub(crate) field: &'a Field,
    /// Cells and their size.
    pub(crate) grid: &'a Grid,
    /// What the field holds: label of the colour bar.
    pub(crate) quantity: Quantity,
    /// The colours.
    pub(crate) colours: Colours,
    /// Values at the ends of the colour bar, SI; by default the extremes of the field, zero included for pressure.
    pub(crate) range: Option<[f64; 2]>,
}

/// A matrix of positive numbers, its first row at the top, on a logarithmic scale; zeros and below are white.
#[derive(Debug, Clone)]
pub(crate) struct MatrixFigure<'a> {
    /// Stands above the image.
    pub(crate) title: String,
    /// Entries `[row, column]`.
    pub(crate) matrix: &'a ndarray::Array2<f64>,
    /// What the entries are: label of the colour bar.
    pub(crate) quantity: Quantity,
    /// Labels of the axes: what rows count, what columns count.
    pub(crate) nodes: [String; 2],
}

/// A section along x into the depth z, which runs downwards from the surface.
#[derive(Debug, Clone)]
pub(crate) struct SectionFigure<'a> {
    /// Stands above the section.
    pub(crate) title: String,
    /// Values in SI, `[x, z]`, not below 0.
    pub(crate) field: &'a Field,
    /// Where the section begins and ends along x and z, m.
    pub(crate) ends: [[f64; 2]; 2],
    /// What the field holds: label of the colour bar.
    pub(crate) quantity: Quantity,
    /// A point `[x, z]` that is marked.
    pub(crate) mark: Option<[f64; 2]>,
}

/// A field over a plane of lags or of wavenumbers, with the origin in its middle sample: `n/2` of `n` samples.
#[derive(Debug, Clone)]
pub(crate) struct PlaneFigure<'a> {
    /// Stands above the plane.
    pub(crate) title: String,
    /// Values in SI, `[x, y]`.
    pub(crate) field: &'a Field,
    /// Distance of neighbouring samples along x and y.
    pub(crate) step: [f64; 2],
    /// What the axes are, with their unit.
    pub(crate) names: [&'a str; 2],
    /// Unit of the axes.
    pub(crate) unit: Unit,
    /// What the field holds: label of the colour bar.
    pub(crate) quantity: Quantity,
    /// The least and the largest value shown; logarithmic colours if the least is above 0.
    pub(crate) range: [f64; 2],
}

/// Draws a field with its colour bar into the PNG file `path`.
///
/// The map is true to scale unless one side is more than four times the other.
/// A field finer than the image is averaged over each pixel; a pressure, over the cells in contact.
pub(crate) fn map(path: &Path, figure: &MapFigure) -> Result<()> {
    maps(path, std::slice::from_ref(figure), 1)
}

/// Draws several maps, row by row, into the PNG file `path`.
///
/// Maps of one quantity that were all given one range share one colour bar.
pub(crate) fn maps(path: &Path, figures: &[MapFigure], columns: usize) -> Result<()> {
    let pictures: Vec<_> = figures.iter().map(|f| Picture::of(path, f)).collect::<Result<_>>()?;
    let [first, rest @ ..] = figures else { return Err(invalid(path, "no map to draw".to_owned())) };
    let alike = |f: &MapFigure| {
        f.range.is_some()
            && (f.range, f.colours, &f.quantity) == (first.range, first.colours, &first.quantity)
    };
    let shared = !rest.is_empty() && figures.iter().all(alike);
    save(path, &sheet(&pictures, columns.clamp(1, figures.len()), shared).canvas)
}

/// Draws a matrix into the PNG file `path`.
pub(crate) fn matrix(path: &Path, figure: &MatrixFigure) -> Result<()> {
    let [rows, columns] = [figure.matrix.nrows(), figure.matrix.ncols()];
    if rows == 0 || columns == 0 {
        return Err(invalid(path, format!("a matrix of shape {rows} × {columns}")));
    }
    let [low, high] = extremes(figure.matrix.iter().copied().filter(|v| *v > 0.0));
    let range = if low < high {
        [low, high]
    } else if low == high {
        [low / 2.0, low * 2.0]
    } else {
        [0.1, 1.0]
    };
    let ends = [columns, rows].map(|n| [-0.5, n as f64 - 0.5]);
    let mut cells = figure.matrix.t();
    cells.invert_axis(Axis(1));
    let picture = Picture {
        title: &figure.title,
        cells,
        shading: Shading { range, kind: Kind::Logarithmic },
        quantity: &figure.quantity,
        ends,
        names: [&figure.nodes[1], &figure.nodes[0]],
        unit: Unit::Number,
        reversed: true,
        mark: None,
    };
    save(path, &sheet(&[picture], 1, false).canvas)
}

/// Draws a plane into the PNG file `path`, true to scale unless one side is more than four times the other.
pub(crate) fn plane(path: &Path, figure: &PlaneFigure) -> Result<()> {
    let end = |axis: usize, samples: usize| {
        let before = (samples / 2) as f64 + 0.5;
        [-before * figure.step[axis], (samples as f64 - before) * figure.step[axis]]
    };
    let kind = if figure.range[0] > 0.0 { Kind::Logarithmic } else { Kind::Heights };
    let picture = Picture {
        title: &figure.title,
        cells: figure.field.view(),
        shading: Shading { range: widened(figure.range), kind },
        quantity: &figure.quantity,
        ends: [end(0, figure.field.nrows()), end(1, figure.field.ncols())],
        names: figure.names,
        unit: figure.unit,
        reversed: false,
        mark: None,
    };
    save(path, &sheet(&[picture], 1, false).canvas)
}

/// Draws a section into the PNG file `path`, true to scale unless one side is more than four times the other.
pub(crate) fn section(path: &Path, figure: &SectionFigure) -> Result<()> {
    let [_, high] = extremes(figure.field.iter().copied());
    let mut cells = figure.field.view();
    cells.invert_axis(Axis(1));
    let picture = Picture {
        title: &figure.title,
        cells,
        shading: Shading { range: [0.0, if high > 0.0 { high } else { 1.0 }], kind: Kind::Pressure },
        quantity: &figure.quantity,
        ends: figure.ends,
        names: ["x", "depth"],
        unit: Unit::Length,
        reversed: true,
        mark: figure.mark,
    };
    save(path, &sheet(&[picture], 1, false).canvas)
}

fn save(path: &Path, canvas: &Canvas) -> Result<()> {
    write(path, &canvas.reduced().png().map_err(at(path))?)
}

/// What a map and a matrix have in common.
pub(super) struct Picture<'a> {
    title: &'a str,
    /// Cells `[right, up]`.
    cells: ArrayView2<'a, f64>,
    pub(super) shading: Shading,
    quantity: &'a Quantity,
    /// Where the axes begin and end, in their unit.
    ends: [[f64; 2]; 2],
    names: [&'a str; 2],
    unit: Unit,
    /// The y axis is labelled downwards.
    reversed: bool,
    /// A point that is marked, SI.
    mark: Option<[f64; 2]>,
}

impl<'a> Picture<'a> {
    pub(super) fn of(path: &Path, figure: &'a MapFigure) -> Result<Self> {
        let shape = [figure.field.nrows(), figure.field.ncols()];
        if shape != figure.grid.shape || shape.contains(&0) {
            let expected = figure.grid.shape;
            return Err(invalid(path, format!("a field of shape {shape:?} on a grid of shape {expected:?}")));
        }
        let (kind, least) = match figure.colours {
            Colours::Heights => (Kind::Heights, None),
            Colours::Pressure => (Kind::Pressure, Some(0.0)),
            Colours::Contact { hardness } => (Kind::Contact { hardness }, Some(0.0)),
            Colours::Stick => (Kind::Stick, Some(0.0)),
        };
        let range = figure.range.unwrap_or_else(|| {
            let [low, high] = extremes(figure.field.iter().copied());
            // Nothing in contact: any bar will do.
            if least.is_some() && high <= 0.0 { [0.0, 1.0] } else { [least.unwrap_or(low), high] }
        });
        Ok(Self {
            title: &figure.title,
            cells: figure.field.view(),
            shading: Shading { range: widened(range), kind },
            quantity: &figure.quantity,
            ends: figure.grid.extent().map(|length| [0.0, length]),
            names: ["x", "y"],
            unit: Unit::Length,
            reversed: false,
            mark: None,
        })
    }
}

/// The colour of a value.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shading {
    range: [f64; 2],
    kind: Kind,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Heights,
    Pressure,
    Contact { hardness: f64 },
    Stick,
    Logarithmic,
}

/// Where a value stands in a colour map.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Tone {
    /// Undefined.
    Missing,
    /// Nothing to show, such as no pressure.
    Blank,
    /// Between the ends, 0 to 1.
    At(f64),
}

impl Shading {
    fn tone(&self, value: f64) -> Tone {
        let [low, high] = self.range;
        if !value.is_finite() {
            return Tone::Missing;
        }
        if self.kind != Kind::Heights && value <= 0.0 {
            return Tone::Blank;
        }
        Tone::At(match self.kind {
            Kind::Heights | Kind::Pressure => ((value - low) / (high - low)).clamp(0.0, 1.0),
            Kind::Contact { hardness } => f64::from(u8::from(value >= hardness * (1.0 - 1e-6))),
            Kind::Stick => f64::from(u8::from(value > 1.5)),
            Kind::Logarithmic => ((value / low).log10() / (high / low).log10()).clamp(0.0, 1.0),
        })
    }

    pub(super) fn colour(&self, t: f64) -> Rgb {
        let gradient = match self.kind {
            Kind::Heights => CIVIDIS,
            Kind::Pressure | Kind::Logarithmic => VIRIDIS,
            Kind::Contact { .. } => return mix(ELASTIC, PLASTIC, t),
            Kind::Stick => return mix(PLASTIC, ELASTIC, t),
        };
        gradient.eval_continuous(t).into_array()
    }

    /// The image, `width` × `height` pixels, of `cells` `[right, up]`: each pixel is the mean over its area.
    pub(super) fn image(&self, cells: ArrayView2<f64>, width: usize, height: usize) -> Image {
        let columns = shares(cells.nrows(), width);
        let rows = shares(cells.ncols(), height);
        let mut pixels = Vec::with_capacity(width * height);
        for row in rows.iter().rev() {
            for column in &columns {
                let (mut blank, mut missing, mut shown, mut tone) = (0.0, 0.0, 0.0, 0.0);
                for &(ix, wx) in column {
                    for &(iy, wy) in row {
                        match self.tone(cells[[ix, iy]]) {
                            Tone::Blank => blank += wx * wy,
                            Tone::Missing => missing += wx * wy,
                            Tone::At(t) => {
                                shown += wx * wy;
                                tone += wx * wy * t;
                            }
                        }
                    }
                }
                let empty = mix(PAPER, MISSING, missing / (blank + missing).max(f64::MIN_POSITIVE));
                let full = if shown > 0.0 { self.colour(tone / shown) } else { PAPER };
                pixels.push(mix(empty, full, shown / (shown + blank + missing)));
            }
        }
        Image { width, height, pixels }
    }

    fn bar(&self, width: usize, height: usize) -> Image {
        let row = |j: usize| self.colour(1.0 - (j as f64 + 0.5) / height as f64);
        Image {
            width,
            height,
            pixels: (0..height).flat_map(|j| std::iter::repeat_n(row(j), width)).collect(),
        }
    }

    /// Colour and name of each class, if the colours are classes.
    fn classes(&self) -> Vec<(Rgb, &'static str)> {
        match self.kind {
            Kind::Contact { hardness } if hardness.is_finite() => {
                vec![(PAPER, "no contact"), (ELASTIC, "elastic"), (PLASTIC, "plastic, p = H")]
            }
            Kind::Contact { .. } => vec![(PAPER, "no contact"), (ELASTIC, "contact")],
            Kind::Stick => vec![(PAPER, "no contact"), (ELASTIC, "stick"), (PLASTIC, "slip")],
            _ => Vec::new(),
        }
    }
}

/// The cells that each of `pixels` covers, and how much of it each cell fills.
fn shares(cells: usize, pixels: usize) -> Vec<Vec<(usize, f64)>> {
    let of = |pixel: usize| {
        // In units of 1/pixels of a cell, so that edges that should meet do.
        let (start, end) = (pixel * cells, (pixel + 1) * cells);
        let part = move |cell: usize| {
            let inside = end.min((cell + 1) * pixels) - start.max(cell * pixels);
            (cell, inside as f64 / cells as f64)
        };
        (start / pixels..end.div_ceil(pixels)).map(part).collect()
    };
    (0..pixels).map(of).collect()
}

/// A drawn sheet, and where the first map lies on it.
pub(super) struct Sheet {
    pub(super) canvas: Canvas,
    pub(super) map: Rect,
    /// Where the first title is centred.
    pub(super) title: [f64; 2],
}

/// The parts of one map, measured.
struct Panel<'a> {
    picture: &'a Picture<'a>,
    size: [i32; 2],
    x: Scale,
    y: Scale,
    bar: Option<Scale>,
    legend: Legend<'a>,
    stretched: bool,
    /// Space around the map: left, top, right, bottom.
    margin: [i32; 4],
}

impl<'a> Panel<'a> {
    fn new(picture: &'a Picture<'a>, width: f64, with_bar: bool) -> Self {
        let length = [0, 1].map(|axis| picture.ends[axis][1] - picture.ends[axis][0]);
        let size = map_size(length, [picture.cells.nrows(), picture.cells.ncols()], width);
        let magnitude = length[0].max(length[1]);
        let most = [size[0] / 62, size[1] / 36].map(|n| n.max(2) as usize);
        let [x, y] = [0, 1].map(|i| Scale::linear(picture.ends[i], magnitude, picture.unit, most[i]));
        let classes = picture.shading.classes();
        let bar = (with_bar && classes.is_empty()).then(|| bar_scale(picture, size[1]));
        let legend = Legend::new(classes.into_iter().map(|(c, name)| (Key::Box(c), name.into())), size[0]);

        let left = 3.0 * f64::from(GAP) + MEDIUM + y.width() + f64::from(GAP);
        let right = bar.as_ref().map_or(2.5 * f64::from(GAP), |bar| f64::from(2 * GAP) + bar_width(bar));
        let title = width_of(picture.title, LARGE).min(700.0) + 2.0 * f64::from(GAP);
        let lacking = (title - left - right - f64::from(size[0])).max(0.0) / 2.0;
        let top = if picture.title.is_empty() { GAP } else { 40 } + legend.height();
        let margin = [(left + lacking).ceil() as i32, top, (right + lacking).ceil() as i32, 54];
        let stretched = !is_to_scale(length);
        Self { picture, size, x, y, bar, legend, stretched, margin }
    }

    fn outer(&self) -> [i32; 2] {
        let [left, top, right, bottom] = self.margin;
        [left + self.size[0] + right, top + self.size[1] + bottom]
    }

    /// Where a point, in SI, lies on the map at `at`.
    fn place(&self, at: Rect, point: [f64; 2]) -> [f64; 2] {
        let share = |axis: usize| {
            let [low, high] = self.picture.ends[axis];
            (point[axis] - low) / (high - low)
        };
        let down = if self.picture.reversed { share(1) } else { 1.0 - share(1) };
        [f64::from(at.x) + share(0) * f64::from(at.width), f64::from(at.y) + down * f64::from(at.height)]
    }

    /// Draws the panel with its upper left corner at `(x, y)`; says where the map and the title are.
    fn draw(&self, canvas: &mut Canvas, x: i32, y: i32) -> (Rect, [f64; 2]) {
        let [width, height] = self.size;
        let at = Rect { x: x + self.margin[0], y: y + self.margin[1], width, height };
        let shading = &self.picture.shading;
        canvas.frame(at);
        let image = shading.image(self.picture.cells.view(), width as usize, height as usize);
        canvas.paste(&image, at.x, at.y);

        let up = if self.picture.reversed { self.y.reversed() } else { self.y.coordinate() };
        axes(canvas, at, [self.x.coordinate(), up], Labels::Left);
        if let Some(mark) = self.picture.mark {
            canvas.cross(self.place(at, mark));
        }
        let [middle_x, middle_y] = middle(at);
        let bottom = f64::from(at.y + height);
        let edge = f64::from(at.x - GAP * 3) - self.y.width();
        let [name_x, name_y] = self.picture.names;
        let mut x_label = self.x.label(name_x);
        if self.stretched {
            x_label.push_str(", not to scale");
        }
        canvas.text(&x_label, [middle_x, bottom + 32.0], MEDIUM, CENTRE_TOP, FontTransform::None);
        canvas.text(&self.y.label(name_y), [edge, middle_y], MEDIUM, CENTRE_BOTTOM, FontTransform::Rotate270);

        let centre = f64::from(x) + f64::from(self.outer()[0]) / 2.0;
        let title = [centre.clamp(middle_x - 60.0, middle_x + 60.0), f64::from(y + 22)];
        heading(canvas, self.picture.title, title, f64::from(self.outer()[0]));
        self.legend.draw(canvas, f64::from(at.x), f64::from(at.y - self.legend.height()));
        if let Some(bar) = &self.bar {
            let beside = Rect { x: at.x + width + 2 * GAP, width: BAR, ..at };
            draw_bar(canvas, beside, bar, self.picture);
        }
        (at, title)
    }
}

pub(super) const CENTRE_TOP: Pos = Pos { h_pos: HPos::Center, v_pos: VPos::Top };
pub(super) const CENTRE_BOTTOM: Pos = Pos { h_pos: HPos::Center, v_pos: VPos::Bottom };

/// Lays the panels out in rows and draws them.
pub(super) fn sheet<'a>(pictures: &'a [Picture<'a>], columns: usize, shared: bool) -> Sheet {
    sheet_of_width(pictures, columns, shared, WIDTHS[columns.min(4) - 1])
}

pub(super) fn sheet_of_width<'a>(
    pictures: &'a [Picture<'a>],
    columns: usize,
    shared: bool,
    width: f64,
) -> Sheet {
    let panels: Vec<_> = pictures.iter().map(|p| Panel::new(p, width, !shared)).collect();
    let rows = panels.len().div_ceil(columns);
    let mut widths = vec![0; columns];
    let mut heights = vec![0; rows];
    let mut margins = vec![[0; 2]; columns];
    for (i, panel) in panels.iter().enumerate() {
        let [width, height] = panel.outer();
        widths[i % columns] = width.max(widths[i % columns]);
        heights[i / columns] = height.max(heights[i / columns]);
        margins[i % columns][0] = panel.margin[0].max(margins[i % columns][0]);
    }
    // Maps of one column stand under each other.
    for (i, panel) in panels.iter().enumerate() {
        let indent = margins[i % columns][0] - panel.margin[0];
        widths[i % columns] = widths[i % columns].max(panel.outer()[0] + indent);
    }
    let total = [widths.iter().sum::<i32>(), heights.iter().sum::<i32>()];
    let classes = pictures[0].shading.classes();
    let shared = shared && classes.is_empty();
    let spread = [panels[0].margin[1], total[1] - panels[0].margin[1] - panels[0].margin[3]];
    let bar = shared.then(|| bar_scale(&pictures[0], spread[1].min(400)));
    let extra = bar.as_ref().map_or(0, |bar| bar_width(bar).ceil() as i32 + GAP / 2);

    let mut canvas = Canvas::new(total[0] + extra, total[1]);
    let mut first = None;
    for (i, panel) in panels.iter().enumerate() {
        let x = widths[..i % columns].iter().sum::<i32>() + margins[i % columns][0] - panel.margin[0];
        let y = heights[..i / columns].iter().sum();
        let placed = panel.draw(&mut canvas, x, y);
        first.get_or_insert(placed);
    }
    if let Some(bar) = &bar {
        let height = spread[1].min(400);
        let y = spread[0] + (spread[1] - height) / 2;
        draw_bar(&mut canvas, Rect { x: total[0], y, width: BAR, height }, bar, &pictures[0]);
    }
    let (map, title) = first.expect("there is a panel");
    Sheet { canvas, map, title }
}

fn is_to_scale([x, y]: [f64; 2]) -> bool {
    x.max(y) <= x.min(y) * MAX_ASPECT * (1.0 + 1e-9)
}

/// Pixels of a map: whole pixels per cell, or whole cells per pixel, where that hardly changes its size.
fn map_size(length: [f64; 2], cells: [usize; 2], target: f64) -> [i32; 2] {
    let aspect = length[0] / length[1];
    if !is_to_scale(length) {
        let narrow = target / MAX_ASPECT;
        return if aspect > 1.0 { [target, narrow] } else { [narrow, target] }.map(|v| v.round() as i32);
    }
    let width = target.min(1.1 * target * aspect);
    let scale = width / cells[0] as f64;
    let whole = if scale >= 1.0 { scale.round() } else { 1.0 / (1.0 / scale).round() };
    let snapped = whole * cells[0] as f64;
    let width = if (0.75..1.3).contains(&(snapped / width)) { snapped } else { width };
    [width, width / aspect].map(|v| v.round() as i32)
}

fn middle(at: Rect) -> [f64; 2] {
    [f64::from(at.x) + f64::from(at.width) / 2.0, f64::from(at.y) + f64::from(at.height) / 2.0]
}

/// A title, smaller if it is too long.
pub(super) fn heading(canvas: &mut Canvas, title: &str, at: [f64; 2], room: f64) {
    let room = room.min(2.0 * at[0]) - f64::from(GAP);
    let size = LARGE * (room / width_of(title, LARGE)).min(1.0);
    canvas.text(title, at, size, Pos { h_pos: HPos::Center, v_pos: VPos::Center }, FontTransform::None);
}

fn axes(canvas: &mut Canvas, at: Rect, coordinates: [Coordinate; 2], side: Labels) {
    let area = Pen(canvas).into_drawing_area();
    bare_axes(&mut chart(&area, at, coordinates, side));
}

fn bar_scale(picture: &Picture, height: i32) -> Scale {
    let Shading { range, kind } = picture.shading;
    let most = (height / 40).max(2) as usize;
    match kind {
        Kind::Logarithmic => Scale::logarithmic(range, picture.quantity.unit, most),
        _ => Scale::linear(range, range[0].abs().max(range[1].abs()), picture.quantity.unit, most),
    }
}

/// Width of a colour bar with its labels, px.
fn bar_width(bar: &Scale) -> f64 {
    f64::from(BAR + 2 * GAP) + bar.width() + MEDIUM + 2.0 * f64::from(GAP)
}

fn draw_bar(canvas: &mut Canvas, at: Rect, bar: &Scale, picture: &Picture) {
    canvas.frame(at);
    canvas.paste(&picture.shading.bar(at.width as usize, at.height as usize), at.x, at.y);
    axes(canvas, at, [bar.bare().coordinate(), bar.coordinate()], Labels::Right);
    let label = bar.label(&picture.quantity.name);
    let fits = width_of(&label, MEDIUM) <= f64::from(at.height + 40);
    let label = if fits { &label } else { &bar.symbol };
    let x = f64::from(at.x + BAR + 3 * GAP) + bar.width();
    canvas.text(
        label,
        [x + MEDIUM * CAPITAL, middle(at)[1]],
        MEDIUM,
        CENTRE_BOTTOM,
        FontTransform::Rotate270,
    );
}

/// What stands before a name in a legend.
#[derive(Debug, Clone, Copy)]
pub(super) enum Key {
    /// A box of one colour.
    Box(Rgb),
    /// Space that the caller fills.
    Room(i32),
}

/// Names with their keys, in rows of limited width.
pub(super) struct Legend<'a> {
    entries: Vec<(Key, std::borrow::Cow<'a, str>)>,
    /// Upper left corner of each entry.
    places: Vec<[f64; 2]>,
    rows: i32,
}

impl<'a> Legend<'a> {
    const ROW: i32 = 22;

    pub(super) fn new(entries: impl Iterator<Item = (Key, std::borrow::Cow<'a, str>)>, width: i32) -> Self {
        let entries: Vec<_> = entries.collect();
        let mut places = Vec::new();
        let (mut x, mut row) = (0.0, 0);
        for (key, name) in &entries {
            let length = key_width(key) + width_of(name, SMALL);
            if x > 0.0 && x + length > f64::from(width) {
                (x, row) = (0.0, row + 1);
            }
            places.push([x, f64::from(row * Self::ROW)]);
            x += length + 20.0;
        }
        let rows = if entries.is_empty() { 0 } else { row + 1 };
        Self { entries, places, rows }
    }

    pub(super) fn height(&self) -> i32 {
        if self.rows == 0 { 0 } else { self.rows * Self::ROW + 2 }
    }

    /// Draws the names and boxes; gives the middle of the left edge of each key.
    pub(super) fn draw(&self, canvas: &mut Canvas, x: f64, y: f64) -> Vec<[f64; 2]> {
        let half = f64::from(Self::ROW) / 2.0 - 2.0;
        let starts: Vec<_> = self.places.iter().map(|p| [x + p[0], y + p[1] + half]).collect();
        for ((key, name), &[x, y]) in self.entries.iter().zip(&starts) {
            if let Key::Box(colour) = *key {
                let edge = Rect { x: x.round() as i32, y: y.round() as i32 - 6, width: 13, height: 13 };
                canvas.fill(edge, INK);
                let inner = Rect { x: edge.x + 1, y: edge.y + 1, width: 11, height: 11 };
                canvas.fill(inner, colour);
            }
            let anchor = Pos { h_pos: HPos::Left, v_pos: VPos::Center };
            canvas.text(name, [x + key_width(key), y], SMALL, anchor, FontTransform::None);
        }
        starts
    }
}

fn key_width(key: &Key) -> f64 {
    match key {
        Key::Box(_) => 19.0,
        Key::Room(width) => f64::from(*width) + 6.0,
    }
}
