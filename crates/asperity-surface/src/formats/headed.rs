//! Text with a header, as exported by programs: lines of heights along x; read only.
//!
//! | begins with | from | lengths along x and y | heights |
//! |---|---|---|---|
//! | `# File Format = ASCII` | SPIP | `x-length`, `y-length` in nm | in `z-unit` |
//! | `# Channel:` | Gwyddion | `Width`, `Height` with unit | in `Value units` |
//! | `h=` | Koala | `pixel size` in m | times `height conversion factor (-> m)` |
//! | `Zygo XYZ Data File` | MetroPro, Mx | camera resolution in m, line 8 | x, y, height in µm or `No Data` |
//!
//! Beyond ±10³⁸ a height is missing. Other rules for text are described in [`text`](super::text).

use super::binary::shape;
use super::header::Header;
use super::numbers::{Part, matrix};
use super::words::{excerpt, unit_of_length};
use super::{Decoded, Fault, ONLY_CHANNEL, Scan, choose, finite};
use asperity_base::error::Defect;
use asperity_base::grid::Field;

type Read = fn(&str) -> Result<Heights, Defect>;

/// First bytes, name and reader of each kind.
const KINDS: [(&str, &str, Read); 4] = [
    ("# File Format = ASCII", "spip", spip),
    ("# Channel:", "gwyddion text", gwyddion),
    ("h=", "koala", koala),
    ("Zygo XYZ Data File", "zygo xyz", zygo),
];

struct Heights {
    channel: String,
    pitch: [f64; 2],
    heights: Field,
}

/// Decodes the heights, if the content begins like one of these kinds.
pub(super) fn decode(text: &str, channel: Option<&str>) -> Option<Decoded> {
    let (_, format, read) = KINDS.iter().find(|(magic, ..)| text.starts_with(magic))?;
    let scan = |read: Heights| {
        let channels = vec![read.channel];
        let chosen = choose(&channels, channel)?;
        Ok(Scan::of_channel(format, channels, chosen, read.pitch, read.heights))
    };
    Some(read(text).map_err(|defect| Fault::defect(format, defect)).and_then(scan))
}

fn spip(text: &str) -> Result<Heights, Defect> {
    let header = Header::new(head(text), '=');
    let lines = Lines::read(text, 0, Some([header.size("x-pixels")?, header.size("y-pixels")?]))?;
    let nanometres = [header.number("x-length")?, header.number("y-length")?];
    let unit = header.get("z-unit").unwrap_or("nm").trim_matches(['[', ']']);
    Ok(lines.over(ONLY_CHANNEL, nanometres.map(|length| length * 1e-9), unit_of_length(unit)?))
}

fn gwyddion(text: &str) -> Result<Heights, Defect> {
    let header = Header::new(head(text), ':');
    let unit = header.get("Value units").ok_or(Defect::Missing("Value units"))?;
    let lengths = [header.length("Width")?, header.length("Height")?];
    let channel = header.get("Channel").unwrap_or(ONLY_CHANNEL);
    Ok(Lines::read(text, 0, None)?.over(channel, lengths, unit_of_length(unit)?))
}

fn koala(text: &str) -> Result<Heights, Defect> {
    const LINES: usize = 4;
    let heights = Part::after(text, LINES).text;
    let head = text[..text.len() - heights.len()].replace(" w=", "\nw=");
    let header = Header::new(&head, '=');
    let [nx, ny] = [header.size("w")?, header.size("h")?];
    let pixel = header.get("pixel size").ok_or(Defect::Missing("pixel size"))?;
    let pixel: f64 = pixel.trim_end_matches('m').trim().parse().map_err(|_| Defect::Value {
        what: "pixel size",
        found: excerpt(pixel),
        expected: "a length in m",
    })?;
    let unit = header.number("height conversion factor (-> m)")?;
    let lengths = [pixel * f64::from(nx), pixel * f64::from(ny)];
    Ok(Lines::read(heights, LINES, Some([nx, ny]))?.over(ONLY_CHANNEL, lengths, unit))
}

/// Reads columns, rows and heights, each on its line, between two lines of `#`.
fn zygo(text: &str) -> Result<Heights, Defect> {
    let mut lines = text.lines().enumerate();
    let header: Vec<&str> =
        lines.by_ref().map(|(_, line)| line.trim()).take_while(|line| *line != "#").collect();
    let numbers = |line: usize| -> Vec<f64> {
        let words = header.get(line).unwrap_or(&"").split_whitespace();
        words.map_while(|word| word.parse().ok()).collect()
    };
    let [x0, y0, nx, ny] = numbers(3)[..] else { return Err(Defect::Missing("origin and size in line 4")) };
    let &[_, _, _, _, _, _, pitch, ..] = &numbers(7)[..] else {
        return Err(Defect::Missing("camera resolution in line 8"));
    };
    let shape = shape([nx as u32, ny as u32])?;
    // A line has at least six characters.
    let (expected, found) = (6 * (shape[0] * shape[1]) as u64, text.len() as u64);
    if found < expected {
        return Err(Defect::Length { what: "the file", expected, found });
    }
    let mut heights = Field::from_elem(shape, f64::NAN);
    for (index, line) in lines.take_while(|(_, line)| line.trim() != "#") {
        let mut words = line.split_whitespace();
        let mut place = |start: f64, count: usize| {
            let index = words.next()?.parse::<f64>().ok()? - start;
            (0.0 <= index && index < count as f64).then_some(index as usize)
        };
        let at = place(x0, shape[0]).zip(place(y0, shape[1]));
        let height = match words.next() {
            Some("No") => Some(f64::NAN),
            word => word.and_then(|word| word.parse::<f64>().ok()),
        };
        let (Some(at), Some(height)) = (at, height) else {
            return Err(Defect::NotANumber { line: index + 1, token: excerpt(line) });
        };
        heights[at] = finite(height * 1e-6);
    }
    Ok(Heights { channel: ONLY_CHANNEL.to_owned(), pitch: [pitch; 2], heights })
}

/// Returns the leading comment lines.
fn head(text: &str) -> &str {
    let mut end = 0;
    for line in text.split_inclusive('\n').take_while(|line| line.starts_with('#')) {
        end += line.len();
    }
    &text[..end]
}

/// Numbers in lines along x, indexed [iy, ix].
struct Lines(Field);

impl Lines {
    /// Reads the lines of `text`, which follow `before` others in the file; `sizes` are those along x and y.
    fn read(text: &str, before: usize, sizes: Option<[u32; 2]>) -> Result<Self, Defect> {
        let lines = matrix(Part { text, before }, false)?;
        let (ny, nx) = lines.dim();
        if sizes.is_some_and(|sizes| sizes.map(|size| size as usize) != [nx, ny]) {
            let found = format!("{nx} × {ny}");
            return Err(Defect::Value { what: "the matrix", found, expected: "of the size in the header" });
        }
        Ok(Self(lines))
    }

    fn over(self, channel: &str, lengths: [f64; 2], unit: f64) -> Heights {
        let height = |number: f64| if number.abs() < 1e38 { finite(number * unit) } else { f64::NAN };
        let heights = self.0.t().map(|number| height(*number)).as_standard_layout().into_owned();
        let pitch = [lengths[0] / heights.nrows() as f64, lengths[1] / heights.ncols() as f64];
        Heights { channel: channel.to_owned(), pitch, heights }
    }
}
