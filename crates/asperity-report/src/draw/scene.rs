//! What a figure is drawn on: shapes, images and text, in points, y down.

use super::image::{Image, Rgb};

/// Text, axes.
pub(super) const INK: Rgb = [38, 38, 38];
/// Text of less weight.
pub(super) const FAINT: Rgb = [110, 110, 110];
/// The background.
pub(super) const PAPER: Rgb = [255, 255, 255];

/// A place, x to the right and y down.
pub(super) type Point = [f64; 2];

/// A rectangle in points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rect {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Rect {
    pub(super) fn middle(&self) -> Point {
        [self.x + self.width / 2.0, self.y + self.height / 2.0]
    }

    pub(super) fn right(&self) -> f64 {
        self.x + self.width
    }

    pub(super) fn bottom(&self) -> f64 {
        self.y + self.height
    }

    pub(super) fn corners(&self) -> Vec<Point> {
        let Self { x, y, .. } = *self;
        vec![[x, y], [self.right(), y], [self.right(), self.bottom()], [x, self.bottom()]]
    }
}

/// Which point of a text is placed; vertically a text is as high as a capital.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stroke {
    pub(super) colour: Rgb,
    pub(super) width: f64,
    pub(super) dashed: bool,
}

impl Stroke {
    /// Lengths of a dash and of the gap after it, pt.
    pub(super) const DASHES: [f64; 2] = [4.0, 2.5];

    pub(super) fn new(colour: Rgb, width: f64) -> Self {
        Self { colour, width, dashed: false }
    }
}

/// Some text.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Words {
    /// Without control characters.
    pub(super) text: String,
    /// The middle of its capitals stands at this height.
    pub(super) at: Point,
    pub(super) size: f64,
    pub(super) anchor: Anchor,
    pub(super) colour: Rgb,
    /// Whether it runs upwards.
    pub(super) upright: bool,
}

/// One step of a drawing.
#[derive(Debug, Clone)]
pub(super) enum Step {
    /// Broken lines, each closed by a fill.
    Path {
        lines: Vec<Vec<Point>>,
        closed: bool,
        fill: Option<Rgb>,
        stroke: Option<Stroke>,
    },
    Text(Words),
    /// An image whose pixels stay square-edged.
    Image(Image, Rect),
    /// What follows is drawn within a rectangle.
    Clip(Rect),
    /// Ends what [`Self::Clip`] began.
    Unclip,
}

/// A drawing of a size in points.
#[derive(Debug, Clone)]
pub struct Scene {
    pub(super) size: [f64; 2],
    pub(super) steps: Vec<Step>,
}

impl Scene {
    pub(super) fn new(size: [f64; 2]) -> Self {
        Self { size, steps: Vec::new() }
    }

    pub(super) fn rect(&mut self, at: Rect, fill: Option<Rgb>, stroke: Option<Stroke>) {
        self.steps.push(Step::Path { lines: vec![at.corners()], closed: true, fill, stroke });
    }

    pub(super) fn circle(&mut self, [x, y]: Point, radius: f64, fill: Rgb) {
        const CORNERS: usize = 24;
        let corner = |i: usize| {
            let (sin, cos) = (std::f64::consts::TAU * i as f64 / CORNERS as f64).sin_cos();
            [x + radius * cos, y + radius * sin]
        };
        self.polygon(&(0..CORNERS).map(corner).collect::<Vec<_>>(), fill);
    }

    pub(super) fn polygon(&mut self, corners: &[Point], fill: Rgb) {
        self.steps.push(Step::Path {
            lines: vec![corners.to_vec()],
            closed: true,
            fill: Some(fill),
            stroke: None,
        });
    }

    pub(super) fn line(&mut self, points: &[Point], stroke: Stroke) {
        self.lines(vec![points.to_vec()], stroke);
    }

    pub(super) fn lines(&mut self, lines: Vec<Vec<Point>>, stroke: Stroke) {
        let lines: Vec<_> = lines.into_iter().filter(|line| line.len() > 1).collect();
        if !lines.is_empty() {
            self.steps.push(Step::Path { lines, closed: false, fill: None, stroke: Some(stroke) });
        }
    }

    pub(super) fn text(&mut self, text: &str, at: Point, size: f64, anchor: Anchor) {
        self.words(text, at, size, anchor, INK);
    }

    pub(super) fn words(&mut self, text: &str, at: Point, size: f64, anchor: Anchor, colour: Rgb) {
        self.push(Words { text: text.to_owned(), at, size, anchor, colour, upright: false });
    }

    /// Writes a text that runs upwards through `at`.
    pub(super) fn upright(&mut self, text: &str, at: Point, size: f64) {
        let anchor = Anchor::Middle;
        self.push(Words { text: text.to_owned(), at, size, anchor, colour: INK, upright: true });
    }

    fn push(&mut self, words: Words) {
        if !words.text.is_empty() {
            // A control character can be drawn by nobody, and breaks an SVG.
            let text =
                words.text.replace(|c: char| c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}'), " ");
            self.steps.push(Step::Text(Words { text, ..words }));
        }
    }

    pub(super) fn image(&mut self, image: Image, at: Rect) {
        self.steps.push(Step::Image(image, at));
    }

    /// Draws what lies within `at` and nothing beyond.
    pub(super) fn clipped(&mut self, at: Rect, draw: impl FnOnce(&mut Self)) {
        self.steps.push(Step::Clip(at));
        draw(self);
        self.steps.push(Step::Unclip);
    }

    /// The scene under `lines` of text, each with its size and colour.
    pub(super) fn under(mut self, lines: &[(String, f64, Rgb)]) -> Self {
        const LEADING: f64 = 1.35;
        let height: f64 = lines.iter().map(|line| line.1 * LEADING).sum::<f64>() + 4.0;
        self.steps.iter_mut().for_each(|step| step.lower(height));
        self.size[1] += height;
        let mut y = 4.0;
        for (text, size, colour) in lines {
            self.words(text, [6.0, y + size / 2.0], *size, Anchor::Start, *colour);
            y += size * LEADING;
        }
        self
    }
}

impl Step {
    fn lower(&mut self, by: f64) {
        match self {
            Self::Path { lines, .. } => lines.iter_mut().flatten().for_each(|point| point[1] += by),
            Self::Text(words) => words.at[1] += by,
            Self::Image(_, at) | Self::Clip(at) => at.y += by,
            Self::Unclip => {}
        }
    }
}
