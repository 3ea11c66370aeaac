//! What plotters draws on: pixels, and text in our own font.
//!
//! The canvas is [`FINE`] times finer than the picture, along x and y; plotters sees the fine pixels, everything
//! else here speaks of the picture's. Reducing it smooths what plotters places on whole pixels.

use std::convert::Infallible;
use std::sync::LazyLock;

use ab_glyph::{Font, FontRef, PxScale, ScaleFont};
use plotters::prelude::DrawingBackend;
use plotters::style::FontTransform;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters_backend::{BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingErrorKind};

/// Fine pixels per pixel of the picture.
pub(super) const FINE: i32 = 2;

/// Size of the numbers at the ticks, px.
pub(super) const SMALL: f64 = 13.0;
/// Size of axis labels and legends, px.
pub(super) const MEDIUM: f64 = 14.0;
/// Size of titles, px.
pub(super) const LARGE: f64 = 15.0;

/// Height of a capital over the size of the font, DejaVu Sans.
pub(super) const CAPITAL: f64 = 0.73;

/// A colour on screen.
pub(super) type Rgb = [u8; 3];
/// Text, axes.
pub(super) const INK: Rgb = [38, 38, 38];
/// The background.
pub(super) const PAPER: Rgb = [255, 255, 255];

static FONT: LazyLock<FontRef<'static>> = LazyLock::new(|| {
    FontRef::try_from_slice(include_bytes!("../../assets/DejaVuSans.ttf"))
        .expect("the embedded font is whole")
});

/// A rectangle in pixels of the picture, y down.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rect {
    pub(super) x: i32,
    pub(super) y: i32,
    pub(super) width: i32,
    pub(super) height: i32,
}

/// A finished picture, row by row from the top.
#[derive(Debug, Clone)]
pub(super) struct Image {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) pixels: Vec<Rgb>,
}

impl Image {
    /// The picture as a PNG file.
    pub(super) fn png(&self) -> std::io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(self.pixels.as_flattened())?;
        writer.finish()?;
        Ok(bytes)
    }

    /// Puts `other` on top, its upper left corner at `(x, y)`.
    pub(super) fn paste(&mut self, other: &Image, x: usize, y: usize) {
        for (j, row) in other.pixels.chunks_exact(other.width).enumerate() {
            let start = (y + j) * self.width + x;
            self.pixels[start..start + other.width].copy_from_slice(row);
        }
    }
}

/// The fine pixels.
pub(super) struct Canvas {
    width: i32,
    height: i32,
    pixels: Vec<Rgb>,
}

impl Canvas {
    /// An empty sheet of `width` × `height` pixels of the picture.
    pub(super) fn new(width: i32, height: i32) -> Self {
        let (width, height) = (width * FINE, height * FINE);
        Self { width, height, pixels: vec![PAPER; (width * height) as usize] }
    }

    /// The picture: the mean of each block of fine pixels.
    pub(super) fn reduced(&self) -> Image {
        let (width, height) = (self.width / FINE, self.height / FINE);
        let mut pixels = Vec::with_capacity((width * height) as usize);
        for y in 0..height {
            for x in 0..width {
                let mut sum = [0u32; 3];
                for (i, j) in (0..FINE).flat_map(|j| (0..FINE).map(move |i| (i, j))) {
                    let fine = self.pixels[((y * FINE + j) * self.width + x * FINE + i) as usize];
                    (0..3).for_each(|c| sum[c] += u32::from(fine[c]));
                }
                let count = (FINE * FINE) as u32;
                pixels.push(sum.map(|s| ((s + count / 2) / count) as u8));
            }
        }
        Image { width: width as usize, height: height as usize, pixels }
    }

    /// Fills a rectangle.
    pub(super) fn fill(&mut self, rect: Rect, colour: Rgb) {
        let within = |start: i32, length: i32, end: i32| {
            (start * FINE).clamp(0, end) as usize..((start + length) * FINE).clamp(0, end) as usize
        };
        let columns = within(rect.x, rect.width, self.width);
        for y in within(rect.y, rect.height, self.height) {
            let row = y * self.width as usize;
            self.pixels[row + columns.start..row + columns.end].fill(colour);
        }
    }

    /// Draws a thin frame around `at`, and clears what is within.
    pub(super) fn frame(&mut self, at: Rect) {
        self.fill(Rect { x: at.x - 1, y: at.y - 1, width: at.width + 2, height: at.height + 2 }, INK);
        self.fill(at, PAPER);
    }

    /// Puts an image with its upper left corner at `(x, y)`.
    pub(super) fn paste(&mut self, image: &Image, x: i32, y: i32) {
        for (i, &colour) in image.pixels.iter().enumerate() {
            let (dx, dy) = ((i % image.width) as i32, (i / image.width) as i32);
            self.fill(Rect { x: x + dx, y: y + dy, width: 1, height: 1 }, colour);
        }
    }

    /// Marks a point by a cross that is seen on any colour.
    pub(super) fn cross(&mut self, at: [f64; 2]) {
        const ARM: f64 = 6.0;
        let [x, y] = at.map(|v| v * f64::from(FINE));
        for (width, colour) in [(4.0, PAPER), (1.6, INK)] {
            for (dx, dy) in [(ARM, ARM), (ARM, -ARM)].map(|(x, y)| (x * f64::from(FINE), y * f64::from(FINE)))
            {
                self.stroke([x - dx, y - dy], [x + dx, y + dy], width * f64::from(FINE), colour, 1.0);
            }
        }
    }

    /// Writes `text` with its `anchor` at `(x, y)`, turned about that point.
    ///
    /// The box that is anchored is as wide as the text and as high as a capital.
    pub(super) fn text(&mut self, text: &str, at: [f64; 2], size: f64, anchor: Pos, turn: FontTransform) {
        let at = at.map(|v| (v * f64::from(FINE)).round() as i32);
        self.write(text, at, size * f64::from(FINE), &anchor, &turn, INK);
    }

    fn write(
        &mut self,
        text: &str,
        at: [i32; 2],
        size: f64,
        anchor: &Pos,
        turn: &FontTransform,
        colour: Rgb,
    ) {
        let width = width_of(text, size);
        let start = match anchor.h_pos {
            HPos::Left => 0.0,
            HPos::Center => -width / 2.0,
            HPos::Right => -width,
        };
        let baseline = match anchor.v_pos {
            VPos::Top => size * CAPITAL,
            VPos::Center => size * CAPITAL / 2.0,
            VPos::Bottom => 0.0,
        };
        for (glyph, x) in glyphs(text, size) {
            let placed = glyph.with_scale_and_position(
                scale(size),
                ab_glyph::point((start + x) as f32, baseline.round() as f32),
            );
            let Some(outline) = FONT.outline_glyph(placed) else { continue };
            let corner = outline.px_bounds().min;
            outline.draw(|i, j, coverage| {
                let (dx, dy) = turn.transform(corner.x as i32 + i as i32, corner.y as i32 + j as i32);
                self.blend(at[0] + dx, at[1] + dy, colour, f64::from(coverage));
            });
        }
    }

    fn blend(&mut self, x: i32, y: i32, colour: Rgb, alpha: f64) {
        if (0..self.width).contains(&x) && (0..self.height).contains(&y) {
            let under = &mut self.pixels[(y * self.width + x) as usize];
            *under = mix(*under, colour, alpha.clamp(0.0, 1.0));
        }
    }

    /// A straight stroke with round ends, `width` fine pixels wide.
    fn stroke(&mut self, from: [f64; 2], to: [f64; 2], width: f64, colour: Rgb, alpha: f64) {
        let along = [to[0] - from[0], to[1] - from[1]];
        let length2 = along[0] * along[0] + along[1] * along[1];
        let reach = width / 2.0 + 1.0;
        let [y0, y1] = [from[1].min(to[1]) - reach, from[1].max(to[1]) + reach];
        let [x0, x1] = [from[0].min(to[0]) - reach, from[0].max(to[0]) + reach];
        for y in (y0.floor() as i32).max(0)..=(y1.ceil() as i32).min(self.height - 1) {
            for x in (x0.floor() as i32).max(0)..=(x1.ceil() as i32).min(self.width - 1) {
                let d = [f64::from(x) - from[0], f64::from(y) - from[1]];
                let t = if length2 > 0.0 { (d[0] * along[0] + d[1] * along[1]) / length2 } else { 0.0 };
                let t = t.clamp(0.0, 1.0);
                let distance = (d[0] - t * along[0]).hypot(d[1] - t * along[1]);
                let coverage = (width / 2.0 + 0.5 - distance).clamp(0.0, 1.0);
                if coverage > 0.0 {
                    self.blend(x, y, colour, alpha * coverage);
                }
            }
        }
    }
}

/// Width of `text` in the units of `size`.
pub(super) fn width_of(text: &str, size: f64) -> f64 {
    let end = glyphs(text, size).last();
    end.map_or(0.0, |(glyph, x)| x + f64::from(FONT.as_scaled(scale(size)).h_advance(glyph)))
}

/// `a` and `b` in the proportions `1 − t` and `t`.
pub(super) fn mix(a: Rgb, b: Rgb, t: f64) -> Rgb {
    std::array::from_fn(|c| (f64::from(a[c]) + t * (f64::from(b[c]) - f64::from(a[c]))).round() as u8)
}

fn scale(size: f64) -> PxScale {
    let em = FONT.units_per_em().expect("DejaVu Sans has an em");
    PxScale::from(size as f32 * FONT.height_unscaled() / em)
}

/// The glyphs of `text` and where each begins.
fn glyphs(text: &str, size: f64) -> impl Iterator<Item = (ab_glyph::GlyphId, f64)> {
    let font = FONT.as_scaled(scale(size));
    let mut x = 0.0;
    let mut before = None;
    text.chars().map(move |c| {
        let glyph = font.glyph_id(c);
        if let Some(before) = before {
            x += f64::from(font.h_advance(before) + font.kern(before, glyph));
        }
        before = Some(glyph);
        (glyph, x)
    })
}

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

/// Lets plotters draw on the canvas.
///
/// Its own text drops the bearings of the glyphs, its strokes leave holes where a path crosses itself, and it
/// fills small polygons too pale.
pub(super) struct Pen<'a>(pub(super) &'a mut Canvas);

impl DrawingBackend for Pen<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        (self.0.width as u32, self.0.height as u32)
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, colour: BackendColor) -> Drawn {
        self.0.blend(x, y, [colour.rgb.0, colour.rgb.1, colour.rgb.2], colour.alpha);
        Ok(())
    }

    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S) -> Drawn {
        self.draw_path([from, to], style)
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Drawn {
        let colour = style.color();
        let rgb = [colour.rgb.0, colour.rgb.1, colour.rgb.2];
        let width = style.stroke_width() as i32;
        let path: Vec<_> = path.into_iter().collect();
        if let [(x0, y0), (x1, y1)] = path[..]
            && (x0 == x1 || y0 == y1)
        {
            // An axis, a tick, a line of the mesh: on whole pixels of the picture.
            let snap = |v: i32| v.div_euclid(FINE) * FINE;
            let (dx, dy) = if x0 == x1 { (width, 0) } else { (0, width) };
            let (x0, x1) = if x0 == x1 { (snap(x0), snap(x0)) } else { (x0.min(x1), x0.max(x1)) };
            let (y0, y1) = if y0 == y1 { (snap(y0), snap(y0)) } else { (y0.min(y1), y0.max(y1)) };
            for y in y0..y1.max(y0 + dy) {
                for x in x0..x1.max(x0 + dx) {
                    self.0.blend(x, y, rgb, colour.alpha);
                }
            }
            return Ok(());
        }
        for pair in path.windows(2) {
            let [from, to] = [pair[0], pair[1]].map(|(x, y)| [f64::from(x), f64::from(y)]);
            self.0.stroke(from, to, f64::from(width), rgb, colour.alpha);
        }
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        centre: BackendCoord,
        radius: u32,
        style: &S,
        _: bool,
    ) -> Drawn {
        let colour = style.color();
        let centre = [f64::from(centre.0), f64::from(centre.1)];
        let rgb = [colour.rgb.0, colour.rgb.1, colour.rgb.2];
        self.0.stroke(centre, centre, 2.0 * f64::from(radius), rgb, colour.alpha);
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        corners: I,
        style: &S,
    ) -> Drawn {
        let colour = style.color();
        let rgb = [colour.rgb.0, colour.rgb.1, colour.rgb.2];
        let corners: Vec<_> = corners.into_iter().collect();
        let edges = || corners.iter().zip(corners.iter().cycle().skip(1));
        let ends = |values: &dyn Fn(&BackendCoord) -> i32| {
            let low = corners.iter().map(values).min().unwrap_or(0);
            low..=corners.iter().map(values).max().unwrap_or(-1)
        };
        for y in ends(&|c| c.1) {
            for x in ends(&|c| c.0) {
                // Crossings of the edges with the ray to the right, between two rows of corners.
                let (px, py) = (f64::from(x), f64::from(y) + 0.25);
                let crossed = edges().filter(|&(a, b)| {
                    let [(ax, ay), (bx, by)] = [a, b].map(|c| (f64::from(c.0), f64::from(c.1)));
                    (ay > py) != (by > py) && px <= ax + (py - ay) / (by - ay) * (bx - ax)
                });
                if crossed.count() % 2 == 1 {
                    self.0.blend(x, y, rgb, colour.alpha);
                }
            }
        }
        Ok(())
    }

    fn draw_text<T: BackendTextStyle>(&mut self, text: &str, style: &T, at: BackendCoord) -> Drawn {
        let (r, g, b) = style.color().rgb;
        self.0.write(text, [at.0, at.1], style.size(), &style.anchor(), &style.transform(), [r, g, b]);
        Ok(())
    }

    fn estimate_text_size<T: BackendTextStyle>(
        &self,
        text: &str,
        style: &T,
    ) -> Result<(u32, u32), DrawingErrorKind<Infallible>> {
        Ok((width_of(text, style.size()).ceil() as u32, (style.size() * CAPITAL).ceil() as u32))
    }
}
