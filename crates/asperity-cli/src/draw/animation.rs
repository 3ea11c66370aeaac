//! A field that changes, as an endless GIF.

use std::collections::HashMap;
use std::path::Path;

use asperity::grid::{Field, Grid};

use super::axis::Quantity;
use super::canvas::{Canvas, INK, PAPER, Rgb, mix};
use super::map::{Colours, MISSING, MapFigure, Picture, Shading, heading, sheet_of_width};
use super::{Result, at, invalid, write};

/// What all frames have in common.
#[derive(Debug, Clone)]
pub(crate) struct Animation<'a> {
    /// The common frame, such as the grid of the lower body.
    pub(crate) grid: &'a Grid,
    /// What the fields hold.
    pub(crate) quantity: Quantity,
    /// The colours.
    pub(crate) colours: Colours,
    /// Values at the ends of the colour bar, SI: the same for all frames.
    pub(crate) range: [f64; 2],
    /// Time that a frame is shown, hundredths of a second.
    pub(crate) delay: u16,
}

/// One frame.
#[derive(Debug, Clone)]
pub(crate) struct Frame<'a> {
    /// Stands above the frame, such as "pass 2, position 17 of 96".
    pub(crate) title: String,
    /// The field on the common frame; what is not defined is grey.
    pub(crate) field: &'a Field,
}

/// Width of the map, px.
const WIDTH: f64 = 360.0;
/// Height of the part above the map that holds the title, px.
const STRIP: i32 = 32;
/// Index of the colour that leaves the frame before as it is.
const UNCHANGED: u8 = 255;

/// Draws `frames` one after the other into the GIF file `path`; fields are taken when their turn comes.
pub(crate) fn animation<'f>(
    path: &Path,
    figure: &Animation,
    frames: impl IntoIterator<Item = Frame<'f>>,
) -> Result<()> {
    let shape = figure.grid.shape;
    let background = Field::from_elem(shape, f64::NAN);
    let still = MapFigure {
        // Room for a title of one line.
        title: " ".to_owned(),
        field: &background,
        grid: figure.grid,
        quantity: figure.quantity.clone(),
        colours: figure.colours,
        range: Some(figure.range),
    };
    let picture = Picture::of(path, &still)?;
    let shading = picture.shading;
    let sheet = sheet_of_width(&[picture], 1, false, WIDTH);
    let base = sheet.canvas.reduced();
    let mut colours = Palette::new(&shading);

    let (width, height) = (base.width as u16, base.height as u16);
    let io = |e: gif::EncodingError| at(path)(std::io::Error::other(e));
    let mut encoder = gif::Encoder::new(Vec::new(), width, height, colours.rgb.as_flattened()).map_err(io)?;
    encoder.set_repeat(gif::Repeat::Infinite).map_err(io)?;
    let mut before: Option<Vec<u8>> = None;
    for frame in frames {
        if frame.field.shape() != shape {
            let found = frame.field.shape();
            return Err(invalid(path, format!("a field of shape {found:?} in a frame of shape {shape:?}")));
        }
        let mut image = base.clone();
        let map = shading.image(frame.field.view(), sheet.map.width as usize, sheet.map.height as usize);
        image.paste(&map, sheet.map.x as usize, sheet.map.y as usize);
        let mut strip = Canvas::new(image.width as i32, STRIP);
        heading(&mut strip, &frame.title, sheet.title, image.width as f64);
        image.paste(&strip.reduced(), 0, 0);

        let indices: Vec<u8> = image.pixels.iter().map(|colour| colours.nearest(*colour)).collect();
        encoder.write_frame(&change(&indices, before.as_deref(), width, height, figure.delay)).map_err(io)?;
        before = Some(indices);
    }
    if before.is_none() {
        return Err(invalid(path, "no frame to draw".to_owned()));
    }
    write(path, &encoder.into_inner().map_err(io)?)
}

/// The rectangle that changes, transparent where it does not.
fn change(now: &[u8], before: Option<&[u8]>, width: u16, height: u16, delay: u16) -> gif::Frame<'static> {
    let w = usize::from(width);
    let differs = |i: usize| before.is_none_or(|before| before[i] != now[i]);
    let (mut left, mut right, mut top, mut bottom) = (w, 0, usize::from(height), 0);
    for i in (0..now.len()).filter(|&i| differs(i)) {
        (left, right) = (left.min(i % w), right.max(i % w + 1));
        (top, bottom) = (top.min(i / w), bottom.max(i / w + 1));
    }
    if right == 0 {
        (left, right, top, bottom) = (0, 1, 0, 1);
    }
    let inside = (top..bottom).flat_map(|y| (left..right).map(move |x| y * w + x));
    gif::Frame {
        delay,
        dispose: gif::DisposalMethod::Keep,
        transparent: Some(UNCHANGED),
        left: left as u16,
        top: top as u16,
        width: (right - left) as u16,
        height: (bottom - top) as u16,
        buffer: inside.map(|i| if differs(i) { now[i] } else { UNCHANGED }).collect(),
        ..gif::Frame::default()
    }
}

/// The colours of the file: those of the map, pale ones for pixels half in contact, greys for text.
struct Palette {
    rgb: Vec<Rgb>,
    known: HashMap<Rgb, u8>,
}

impl Palette {
    fn new(shading: &Shading) -> Self {
        let ramp = |n: usize, pale: f64| {
            (0..n).map(move |i| mix(shading.colour(i as f64 / (n - 1) as f64), PAPER, pale))
        };
        let greys = (0..32).map(|i| mix(INK, PAPER, f64::from(i) / 31.0));
        let mut rgb: Vec<_> = ramp(128, 0.0).chain(ramp(48, 0.4)).chain(ramp(40, 0.7)).chain(greys).collect();
        rgb.push(MISSING);
        rgb.resize(256, PAPER);
        Self { rgb, known: HashMap::new() }
    }

    fn nearest(&mut self, colour: Rgb) -> u8 {
        let rgb = &self.rgb;
        *self.known.entry(colour).or_insert_with(|| {
            let distance =
                |a: &Rgb| (0..3).map(|c| (i32::from(a[c]) - i32::from(colour[c])).pow(2)).sum::<i32>();
            let candidates = 0..UNCHANGED;
            candidates.min_by_key(|&i| distance(&rgb[usize::from(i)])).expect("the palette has colours")
        })
    }
}
