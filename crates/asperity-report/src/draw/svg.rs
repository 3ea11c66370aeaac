//! A scene as SVG: text as text, with the glyphs that it needs.

use std::collections::BTreeSet;
use std::fmt::{Display, Formatter, Result, Write};

use base64::prelude::{BASE64_STANDARD, Engine};

use super::image::Rgb;
use super::scene::{Anchor, PAPER, Rect, Scene, Step, Stroke, Words};
use super::text::{CAPITAL, FAMILY, subset};

pub(super) fn document(scene: &Scene) -> std::io::Result<Vec<u8>> {
    let characters: BTreeSet<char> = scene
        .steps
        .iter()
        .filter_map(|step| if let Step::Text(words) = step { Some(words.text.chars()) } else { None })
        .flatten()
        .collect();
    let font = BASE64_STANDARD.encode(subset(&characters)?);
    let [width, height] = scene.size.map(N);
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" \
         width=\"{width}pt\" height=\"{height}pt\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"'{FAMILY}', sans-serif\">\n\
         <style>@font-face {{ font-family: '{FAMILY}'; src: url('data:font/ttf;base64,{font}') format('truetype'); \
         }}</style>\n<rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n",
        Hex(PAPER)
    );
    let mut clips = 0;
    for step in &scene.steps {
        if let Step::Clip(_) = step {
            clips += 1;
        }
        writeln!(text, "{}", Element(step, clips)).expect("a string takes everything");
    }
    text.push_str("</svg>\n");
    Ok(text.into_bytes())
}

/// A step, with the number of clips so far.
struct Element<'a>(&'a Step, usize);

impl Display for Element<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self.0 {
            Step::Path { lines, closed, fill, stroke } => {
                write!(f, "<path d=\"")?;
                for line in lines {
                    for (i, [x, y]) in line.iter().enumerate() {
                        write!(f, "{}{} {}", if i == 0 { 'M' } else { 'L' }, N(*x), N(*y))?;
                    }
                    if *closed {
                        write!(f, "Z")?;
                    }
                }
                write!(f, "\"{}/>", Style { fill: *fill, stroke: *stroke })
            }
            Step::Text(words) => write_words(f, words),
            Step::Image(image, Rect { x, y, width, height }) => write!(
                f,
                "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" \
                 style=\"image-rendering:pixelated\" xlink:href=\"data:image/png;base64,{}\"/>",
                N(*x),
                N(*y),
                N(*width),
                N(*height),
                BASE64_STANDARD.encode(image.png(None))
            ),
            Step::Clip(Rect { x, y, width, height }) => {
                let (x, y, width, height) = (N(*x), N(*y), N(*width), N(*height));
                let id = self.1;
                write!(
                    f,
                    "<clipPath id=\"clip{id}\"><rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"/>\
                     </clipPath><g clip-path=\"url(#clip{id})\">"
                )
            }
            Step::Unclip => write!(f, "</g>"),
        }
    }
}

fn write_words(f: &mut Formatter<'_>, words: &Words) -> Result {
    let [x, y] = words.at;
    let anchor = match words.anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
        Anchor::End => "end",
    };
    let baseline = N(y + words.size * CAPITAL / 2.0);
    let (colour, size) = (Hex(words.colour), N(words.size));
    write!(
        f,
        "<text x=\"{}\" y=\"{baseline}\" font-size=\"{size}\" text-anchor=\"{anchor}\" fill=\"{colour}\"",
        N(x)
    )?;
    if words.upright {
        write!(f, " transform=\"rotate(-90 {} {})\"", N(x), N(y))?;
    }
    write!(f, ">{}</text>", EscapedText(&words.text))
}

/// A number to a hundredth of a point.
#[derive(Clone, Copy)]
struct N(f64);

impl Display for N {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        // A zero has no sign.
        write!(f, "{}", (self.0 * 100.0).round() / 100.0 + 0.0)
    }
}

struct Hex(Rgb);

impl Display for Hex {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let [r, g, b] = self.0;
        write!(f, "#{r:02x}{g:02x}{b:02x}")
    }
}

struct Style {
    fill: Option<Rgb>,
    stroke: Option<Stroke>,
}

impl Display for Style {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self.fill {
            Some(fill) => write!(f, " fill=\"{}\"", Hex(fill))?,
            None => write!(f, " fill=\"none\"")?,
        }
        let Some(Stroke { colour, width, dashed }) = self.stroke else { return Ok(()) };
        write!(f, " stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"", Hex(colour), N(width))?;
        let [dash, gap] = Stroke::DASHES;
        if dashed { write!(f, " stroke-dasharray=\"{dash} {gap}\"") } else { Ok(()) }
    }
}

/// Text as XML holds it.
struct EscapedText<'a>(&'a str);

impl Display for EscapedText<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        self.0.chars().try_for_each(|c| match c {
            '&' => f.write_str("&amp;"),
            '<' => f.write_str("&lt;"),
            '>' => f.write_str("&gt;"),
            c => f.write_char(c),
        })
    }
}
