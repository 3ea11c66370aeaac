//! A figure that changes, as an endless GIF.

use std::collections::HashMap;
use std::io;
use std::path::Path;

use rayon::prelude::*;

use super::colour::{Colours, MISSING, Shading, mix};
use super::image::{Image, Rgb};
use super::output::pixels;
use super::scene::{INK, PAPER, Scene};
use super::{Result, at, invalid, write};

/// Dots per inch: a sheet of 110 mm has about 480 pixels.
const DPI: f64 = 110.0;
/// Index of the colour that leaves the frame before as it is.
const UNCHANGED: u8 = 255;

/// Shows `frames` one after the other, each for `delay` hundredths of a second, in the GIF `path`. The frames
/// differ in a map of `colours` only, and are of one size.
pub(crate) fn animation(path: &Path, frames: &[Scene], colours: Colours, delay: u16) -> Result<()> {
    let images: Vec<Image> =
        frames.par_iter().map(|frame| pixels(frame, DPI)).collect::<io::Result<_>>().map_err(at(path))?;
    let Some(first) = images.first() else { return Err(invalid(path, "no frame to draw".to_owned())) };
    if images.iter().any(|image| (image.width, image.height) != (first.width, first.height)) {
        return Err(invalid(path, "frames of different sizes".to_owned()));
    }
    write(path, &gif(&images, colours, delay).map_err(at(path))?)
}

fn gif(images: &[Image], colours: Colours, delay: u16) -> io::Result<Vec<u8>> {
    // The palette needs no values, only colours.
    let mut palette = Palette::new(&Shading { range: [0.0, 1.0], colours });
    let (width, height) = (images[0].width as u16, images[0].height as u16);
    let failed = io::Error::other::<gif::EncodingError>;
    let encoder = gif::Encoder::new(Vec::new(), width, height, palette.rgb.as_flattened());
    let mut encoder = encoder.map_err(failed)?;
    encoder.set_repeat(gif::Repeat::Infinite).map_err(failed)?;
    let mut before: Option<Vec<u8>> = None;
    for image in images {
        let indices: Vec<u8> = image.pixels.iter().map(|colour| palette.nearest(*colour)).collect();
        encoder.write_frame(&change(&indices, before.as_deref(), width, height, delay)).map_err(failed)?;
        before = Some(indices);
    }
    encoder.into_inner().map_err(failed)
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
