//! Figures as files: PNG, SVG or PDF.

use std::path::Path;

use super::image::{Image, Rgb};
use super::scene::{FAINT, INK, Scene};
use super::text::{SMALL, wrapped};
use super::{Result, at, pdf, raster, svg};
use asperity_base::Choice;
use asperity_base::choice::choice;

/// The kind of a figure's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Pixels.
    Png,
    /// Vectors and text, with the glyphs of the font.
    Svg,
    /// Vectors and text, with the glyphs of the font.
    Pdf,
}

choice!(Format: "png" => Png, "svg" => Svg, "pdf" => Pdf);

impl Format {
    /// The end of a file's name.
    pub fn extension(self) -> &'static str {
        self.word()
    }
}

/// How figures are put onto paper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paper {
    /// The kind of file.
    pub format: Format,
    /// Dots per inch of pixels, > 0.
    pub dpi: f64,
    /// Width of a figure, m; by default one that suits it.
    pub width: Option<f64>,
    /// Values at the ends of the colours or of the axis of y, SI; by default those that suit the figure.
    pub range: Option<[f64; 2]>,
    /// Whether a figure has its caption above it.
    pub titled: bool,
}

impl Default for Paper {
    fn default() -> Self {
        Self { format: Format::Png, dpi: 300.0, width: None, range: None, titled: true }
    }
}

/// Points of a metre.
const POINTS: f64 = 72.0 / 0.0254;

impl Paper {
    /// The width of a figure, pt.
    pub(super) fn width(&self, suits: f64) -> f64 {
        self.width.map_or(suits, |metres| metres * POINTS)
    }

    /// Pixels along a length in points.
    pub(super) fn pixels(&self, length: f64) -> usize {
        (length / 72.0 * self.dpi).round().max(1.0) as usize
    }
}

/// What stands above a figure.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Caption {
    /// What the figure shows.
    pub title: String,
    /// Of what: case, load, pass.
    pub of: String,
}

/// A kind of figure.
pub trait Figure {
    /// Draws the figure without its caption.
    fn scene(&self, paper: &Paper) -> Scene;
}

/// A figure under its caption.
pub(crate) fn captioned(figure: &dyn Figure, caption: &Caption, paper: &Paper) -> Scene {
    let scene = figure.scene(paper);
    let lines = lines(caption, &scene, paper);
    scene.under(&lines)
}

/// Figures, each under its caption, of one size: those with fewer lines of a caption or a legend have room
/// left.
pub(crate) fn captioned_alike<F: Figure>(figures: &[(F, Caption)], paper: &Paper) -> Vec<Scene> {
    let all = figures.iter().map(|(figure, caption)| {
        let scene = figure.scene(paper);
        let lines = lines(caption, &scene, paper);
        (scene, lines)
    });
    let mut all: Vec<(Scene, Vec<Line>)> = all.collect();
    let most = all.iter().map(|(_, lines)| lines.len()).max().unwrap_or_default();
    all.iter_mut().for_each(|(_, lines)| lines.resize(most, (String::new(), SMALL, FAINT)));
    let mut scenes: Vec<Scene> = all.into_iter().map(|(scene, lines)| scene.under(&lines)).collect();
    let size =
        scenes.iter().fold([0.0; 2], |most: [f64; 2], scene| [0, 1].map(|k| most[k].max(scene.size[k])));
    scenes.iter_mut().for_each(|scene| scene.size = size);
    scenes
}

/// A line of text, its size, its colour.
type Line = (String, f64, Rgb);

/// The lines of a caption over a scene.
fn lines(caption: &Caption, scene: &Scene, paper: &Paper) -> Vec<Line> {
    if !paper.titled {
        return Vec::new();
    }
    const TITLE: f64 = 9.5;
    let room = scene.size[0] - 12.0;
    let title = wrapped(&caption.title, TITLE, room).into_iter().map(|line| (line, TITLE, INK));
    let of = wrapped(&caption.of, SMALL, room).into_iter().map(|line| (line, SMALL, FAINT));
    title.chain(of).collect()
}

/// Draws a figure under its caption into the file `path`.
pub fn save(path: &Path, figure: &dyn Figure, caption: &Caption, paper: &Paper) -> Result<()> {
    write(path, &captioned(figure, caption, paper), paper)
}

/// Writes a scene into the file `path`.
pub(crate) fn write(path: &Path, scene: &Scene, paper: &Paper) -> Result<()> {
    let bytes = match paper.format {
        Format::Png => picture(scene, paper.dpi),
        Format::Svg => svg::document(scene),
        Format::Pdf => pdf::document(scene),
    };
    bytes.map_err(at(path)).and_then(|bytes| super::write(path, &bytes))
}

/// The scene as a PNG file.
pub(crate) fn picture(scene: &Scene, dpi: f64) -> std::io::Result<Vec<u8>> {
    Ok(pixels(scene, dpi)?.png(Some(dpi)))
}

/// The scene in pixels.
pub(super) fn pixels(scene: &Scene, dpi: f64) -> std::io::Result<Image> {
    raster::picture(scene, dpi).ok_or_else(|| std::io::Error::other("the picture has too many pixels"))
}
