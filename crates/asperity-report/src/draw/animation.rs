//! A figure that changes, as an endless GIF or APNG, or as an MP4.

use std::collections::HashMap;
use std::io::{self, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;

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

/// Shows `frames` one after the other, each for `delay` hundredths of a second, in the file `path`: a GIF, or by its ending an
/// APNG or MP4. The frames differ in a map of `colours` only, and are of one size.
pub(crate) fn animation(path: &Path, frames: &[Scene], colours: Colours, delay: u16) -> Result<()> {
    let images: Vec<Image> =
        frames.par_iter().map(|frame| pixels(frame, DPI)).collect::<io::Result<_>>().map_err(at(path))?;
    let Some(first) = images.first() else { return Err(invalid(path, "no frame to draw".to_owned())) };
    if images.iter().any(|image| (image.width, image.height) != (first.width, first.height)) {
        return Err(invalid(path, "frames of different sizes".to_owned()));
    }
    let bytes = match path.extension().and_then(|extension| extension.to_str()) {
        Some("apng") => apng(&images, delay),
        Some("mp4") => mp4(&images, delay),
        _ => gif(&images, colours, delay),
    };
    write(path, &bytes.map_err(at(path))?)
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

/// All colours as they are.
fn apng(images: &[Image], delay: u16) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, images[0].width as u32, images[0].height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_animated(images.len() as u32, 0)?;
    encoder.set_frame_delay(delay, 100)?;
    let mut writer = encoder.write_header()?;
    for image in images {
        writer.write_image_data(image.pixels.as_flattened())?;
    }
    writer.finish()?;
    Ok(bytes)
}

/// By the program `ffmpeg`.
fn mp4(images: &[Image], delay: u16) -> io::Result<Vec<u8>> {
    let (size, rate) = (format!("{}x{}", images[0].width, images[0].height), format!("100/{delay}"));
    let input = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-video_size", &size, "-framerate", &rate, "-i", "-"];
    // Players want even numbers of pixels, and halves of colours.
    let output = ["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white", "-pix_fmt", "yuv420p"];
    let to_stdout = ["-movflags", "frag_keyframe+empty_moov", "-f", "mp4", "-"];
    let started = Command::new("ffmpeg")
        .args(["-v", "error"])
        .args(input)
        .args(output)
        .args(to_stdout)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let mut ffmpeg = started.map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => io::Error::new(
            io::ErrorKind::InvalidInput,
            "MP4 is made by ffmpeg, which is not there: `apt-get install ffmpeg`, `brew install ffmpeg`, or take GIF or APNG",
        ),
        _ => error,
    })?;
    let mut stdin = ffmpeg.stdin.take().expect("it was asked for");
    let output = thread::scope(|scope| {
        // It reads while it writes.
        let fed = scope
            .spawn(move || images.iter().try_for_each(|image| stdin.write_all(image.pixels.as_flattened())));
        let output = ffmpeg.wait_with_output();
        let _ = fed.join();
        output
    })?;
    match output.status.success() {
        true => Ok(output.stdout),
        false => Err(io::Error::other(format!("ffmpeg: {}", String::from_utf8_lossy(&output.stderr).trim()))),
    }
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
