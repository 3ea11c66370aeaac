//! A scene in pixels.

use tiny_skia::{FillRule, LineJoin, Mask, Paint, PathBuilder, Pixmap, StrokeDash, Transform};
use ttf_parser::OutlineBuilder;

use super::image::{Image, Rgb};
use super::scene::{PAPER, Rect, Scene, Step, Stroke, Words};
use super::text::{CAPITAL, glyphs, outline, start, units_per_em};

/// The scene at `dpi` dots per inch; `None` where there are too many of them.
pub(super) fn picture(scene: &Scene, dpi: f64) -> Option<Image> {
    let scale = dpi / 72.0;
    let [width, height] = scene.size.map(|length| (length * scale).round().clamp(1.0, 65_535.0) as u32);
    let mut sheet = Sheet { pixmap: Pixmap::new(width, height)?, scale: scale as f32, clip: None };
    sheet.pixmap.fill(colour(PAPER));
    for step in &scene.steps {
        sheet.draw(step);
    }
    // All is opaque.
    let pixels = sheet.pixmap.pixels().iter().map(|p| [p.red(), p.green(), p.blue()]).collect();
    Some(Image { width: width as usize, height: height as usize, pixels, clear: false })
}

struct Sheet {
    pixmap: Pixmap,
    scale: f32,
    clip: Option<Mask>,
}

impl Sheet {
    fn draw(&mut self, step: &Step) {
        let transform = Transform::from_scale(self.scale, self.scale);
        match step {
            Step::Path { lines, closed, fill, stroke } => {
                let Some(path) = path(lines, *closed) else { return };
                if let Some(fill) = fill {
                    let rule = FillRule::Winding;
                    self.pixmap.fill_path(&path, &paint(*fill), rule, transform, self.clip.as_ref());
                }
                if let Some(stroke) = stroke {
                    let paint = paint(stroke.colour);
                    self.pixmap.stroke_path(&path, &paint, &style(stroke), transform, self.clip.as_ref());
                }
            }
            Step::Text(words) => self.write(words),
            Step::Image(image, at) => self.paste(image, *at),
            Step::Clip(at) => {
                let mut mask = Mask::new(self.pixmap.width(), self.pixmap.height());
                if let (Some(mask), Some(path)) = (&mut mask, path(&[at.corners()], true)) {
                    mask.fill_path(&path, FillRule::Winding, true, transform);
                }
                self.clip = mask;
            }
            Step::Unclip => self.clip = None,
        }
    }

    fn write(&mut self, words: &Words) {
        let [x, y] = words.at.map(|v| v as f32);
        let turn = if words.upright { -90.0 } else { 0.0 };
        let placed = Transform::from_scale(self.scale, self.scale).pre_translate(x, y).pre_rotate(turn);
        let mut outlines = Outlines { path: PathBuilder::new(), at: [0.0; 2], scale: 0.0 };
        let mut at = start(words);
        for (glyph, advance) in glyphs(&words.text, words.size) {
            outlines.at = [at as f32, (words.size * CAPITAL / 2.0) as f32];
            outlines.scale = (words.size / units_per_em()) as f32;
            outline(glyph, &mut outlines);
            at += advance;
        }
        if let Some(path) = outlines.path.finish() {
            self.pixmap.fill_path(&path, &paint(words.colour), FillRule::Winding, placed, self.clip.as_ref());
        }
    }

    /// Each pixel has the colour of the image at its middle.
    fn paste(&mut self, image: &Image, at: Rect) {
        let scale = f64::from(self.scale);
        let (width, height) = (self.pixmap.width() as usize, self.pixmap.height() as usize);
        let ends = |from: f64, length: f64, most: usize| {
            let [first, end] = [from, from + length].map(|v| (v * scale).round().max(0.0) as usize);
            first.min(most)..end.min(most)
        };
        let (columns, rows) = (ends(at.x, at.width, width), ends(at.y, at.height, height));
        let source = |place: usize, from: f64, length: f64, cells: usize| {
            let share = ((place as f64 + 0.5) / scale - from) / length;
            ((share * cells as f64).max(0.0) as usize).min(cells - 1)
        };
        let pixels = self.pixmap.pixels_mut();
        for row in rows {
            let from = source(row, at.y, at.height, image.height) * image.width;
            for column in columns.clone() {
                let colour = image.pixels[from + source(column, at.x, at.width, image.width)];
                if !(image.clear && colour == PAPER) {
                    pixels[row * width + column] = opaque(colour);
                }
            }
        }
    }
}

/// Outlines of glyphs, whose y runs upwards, moved and scaled.
struct Outlines {
    path: PathBuilder,
    at: [f32; 2],
    scale: f32,
}

impl Outlines {
    fn place(&self, x: f32, y: f32) -> (f32, f32) {
        (self.at[0] + self.scale * x, self.at[1] - self.scale * y)
    }
}

impl OutlineBuilder for Outlines {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.place(x, y);
        self.path.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.place(x, y);
        self.path.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.place(x1, y1), self.place(x, y));
        self.path.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2), (x, y)) = (self.place(x1, y1), self.place(x2, y2), self.place(x, y));
        self.path.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}

fn path(lines: &[Vec<[f64; 2]>], closed: bool) -> Option<tiny_skia::Path> {
    let mut path = PathBuilder::new();
    for line in lines {
        for (i, [x, y]) in line.iter().enumerate() {
            let (x, y) = (*x as f32, *y as f32);
            if i == 0 { path.move_to(x, y) } else { path.line_to(x, y) }
        }
        if closed {
            path.close();
        }
    }
    path.finish()
}

fn style(stroke: &Stroke) -> tiny_skia::Stroke {
    let dashes = Stroke::DASHES.map(|v| v as f32).to_vec();
    tiny_skia::Stroke {
        width: stroke.width as f32,
        line_join: LineJoin::Round,
        dash: if stroke.dashed { StrokeDash::new(dashes, 0.0) } else { None },
        ..tiny_skia::Stroke::default()
    }
}

fn colour([r, g, b]: Rgb) -> tiny_skia::Color {
    tiny_skia::Color::from_rgba8(r, g, b, 255)
}

fn opaque([r, g, b]: Rgb) -> tiny_skia::PremultipliedColorU8 {
    tiny_skia::ColorU8::from_rgba(r, g, b, 255).premultiply()
}

fn paint(rgb: Rgb) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color(colour(rgb));
    paint
}
