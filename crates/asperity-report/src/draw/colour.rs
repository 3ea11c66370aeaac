//! The colour of a value, and images of fields.

use colorous::{CIVIDIS, RED_BLUE, VIRIDIS};
use ndarray::ArrayView2;
use rayon::prelude::*;

use super::image::{Image, Rgb};
use super::scene::PAPER;

/// Undefined cells, and what lies outside an overlap.
pub(super) const MISSING: Rgb = [218, 218, 218];
const ELASTIC: Rgb = [0, 114, 178];
const PLASTIC: Rgb = [213, 94, 0];

/// How a field is coloured. Cells that are not finite are grey.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Colours {
    /// Cividis, from the lowest to the highest.
    Heights,
    /// Blue over white to red, as far below zero as above.
    Signed,
    /// Viridis, from the lowest to the highest.
    Between,
    /// Viridis, from zero; cells without pressure are white.
    Pressure,
    /// Viridis over the logarithm; cells that are not positive are white.
    Logarithmic,
    /// Viridis, from zero; cells at zero are white, those below are of the colour of what is plastic.
    Gap,
    /// The field is a number of a class: 0 is white.
    Classes(&'static [&'static str]),
}

impl Colours {
    /// Whether a value has a colour whatever its sign.
    pub(super) fn take_any_sign(self) -> bool {
        matches!(self, Self::Heights | Self::Signed | Self::Between)
    }

    /// No contact, elastic, plastic.
    pub const CONTACT: Self = Self::Classes(&["no contact", "elastic", "plastic: p at its cap"]);
    /// No contact, elastic, of bodies that do not yield.
    pub const TOUCH: Self = Self::Classes(&["no contact", "contact"]);
    /// No contact, stick, slip.
    pub const STICK: Self = Self::Classes(&["no contact", "stick", "slip"]);
}

/// The colours of the values between two ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Shading {
    /// Values at the ends, SI.
    pub(super) range: [f64; 2],
    pub(super) colours: Colours,
}

/// Where a value stands in a colour map.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Tone {
    /// Undefined.
    Missing,
    /// Nothing to show, such as no pressure.
    Blank,
    /// Below the least value of the map.
    Below,
    /// Between the ends, 0 to 1.
    At(f64),
}

impl Shading {
    fn tone(&self, value: f64) -> Tone {
        let [low, high] = self.range;
        if !value.is_finite() {
            return Tone::Missing;
        }
        if !self.colours.take_any_sign() && value <= 0.0 {
            return if self.colours == Colours::Gap && value < 0.0 { Tone::Below } else { Tone::Blank };
        }
        Tone::At(match self.colours {
            Colours::Heights | Colours::Signed | Colours::Between | Colours::Pressure | Colours::Gap => {
                (value - low) / (high - low)
            }
            Colours::Logarithmic => (value / low).log10() / (high / low).log10(),
            Colours::Classes(_) => value - 1.0,
        })
    }

    /// The colour of the share `t` of the way from the low to the high end.
    pub(super) fn colour(&self, t: f64) -> Rgb {
        let (gradient, t) = match self.colours {
            Colours::Heights => (CIVIDIS, t),
            // Red stands for what is above zero.
            Colours::Signed => (RED_BLUE, 1.0 - t),
            Colours::Between | Colours::Pressure | Colours::Logarithmic | Colours::Gap => (VIRIDIS, t),
            Colours::Classes(_) => return mix(ELASTIC, PLASTIC, t.clamp(0.0, 1.0)),
        };
        gradient.eval_continuous(t.clamp(0.0, 1.0)).into_array()
    }

    /// The colour of a value alone.
    pub(super) fn of(&self, value: f64) -> Rgb {
        match self.tone(value) {
            Tone::Missing => MISSING,
            Tone::Blank => PAPER,
            Tone::Below => PLASTIC,
            Tone::At(t) => self.colour(t),
        }
    }

    /// The image, `width` × `height` pixels, of `cells` `[right, up]` with values in a `range`: each pixel is
    /// the mean over its area, in colour over the cells that have one.
    pub(super) fn image(&self, cells: ArrayView2<f64>, range: &Range, [width, height]: [usize; 2]) -> Image {
        let columns = shares(cells.nrows(), width);
        let rows = shares(cells.ncols(), height);
        let [low, high] = self.range;
        let linear = |value: f64| Tone::At((value - low) / (high - low));
        // Columns of pixels, whose cells are neighbours in memory. The cases are those of [`Self::tone`],
        // told apart here rather than in each cell.
        let drawn: Vec<Vec<Rgb>> = match self.colours {
            _ if range.has_missing => self.columns(cells, [&columns, &rows], |value| self.tone(value)),
            Colours::Heights | Colours::Signed | Colours::Between => {
                self.columns(cells, [&columns, &rows], linear)
            }
            Colours::Pressure => self.columns(cells, [&columns, &rows], |value| match value {
                value if value <= 0.0 => Tone::Blank,
                value => linear(value),
            }),
            Colours::Gap => self.columns(cells, [&columns, &rows], |value| match value {
                value if value < 0.0 => Tone::Below,
                value if value <= 0.0 => Tone::Blank,
                value => linear(value),
            }),
            Colours::Classes(_) => self.columns(cells, [&columns, &rows], |value| match value {
                value if value <= 0.0 => Tone::Blank,
                value => Tone::At(value - 1.0),
            }),
            Colours::Logarithmic => self.columns(cells, [&columns, &rows], |value| self.tone(value)),
        };
        let mut pixels = Vec::with_capacity(width * height);
        for row in (0..height).rev() {
            pixels.extend(drawn.iter().map(|column| column[row]));
        }
        Image { width, height, pixels, clear: false }
    }

    /// Columns of pixels, upwards, that cover these shares of cells.
    fn columns(
        &self,
        cells: ArrayView2<f64>,
        [columns, rows]: [&[Shares]; 2],
        tone: impl Fn(f64) -> Tone + Sync,
    ) -> Vec<Vec<Rgb>> {
        let pixel = |column: &Shares, row: &Shares| {
            // Blank, missing, below, shown.
            let (mut parts, mut sum) = ([0.0; 4], 0.0);
            for (ix, wx) in column {
                for (iy, wy) in row {
                    let weight = wx * wy;
                    match tone(cells[[*ix, *iy]]) {
                        Tone::Blank => parts[0] += weight,
                        Tone::Missing => parts[1] += weight,
                        Tone::Below => parts[2] += weight,
                        Tone::At(t) => {
                            parts[3] += weight;
                            sum += weight * t;
                        }
                    }
                }
            }
            let shown = if parts[3] > 0.0 { self.colour(sum / parts[3]) } else { PAPER };
            let colours = [PAPER, MISSING, PLASTIC, shown];
            let whole: f64 = parts.iter().sum();
            if let Some(only) = parts.iter().position(|part| *part == whole) {
                return colours[only];
            }
            std::array::from_fn(|c| {
                let sum: f64 = parts.iter().zip(colours).map(|(part, rgb)| part * f64::from(rgb[c])).sum();
                (sum / whole).round() as u8
            })
        };
        columns.par_iter().map(|column| rows.iter().map(|row| pixel(column, row)).collect()).collect()
    }

    /// A strip from the low end at the bottom to the high end at the top.
    pub(super) fn bar(&self) -> Image {
        const STEPS: usize = 256;
        let pixels = (0..STEPS).map(|j| self.colour(1.0 - (j as f64 + 0.5) / STEPS as f64)).collect();
        Image { width: 1, height: STEPS, pixels, clear: false }
    }

    /// Colour and name of what cells show and no bar tells.
    pub(super) fn keys(&self, range: &Range, missing: &str, blank: &str) -> Vec<(Rgb, String)> {
        let mut keys = Vec::new();
        match self.colours {
            Colours::Classes(names) => {
                let colours = [PAPER, ELASTIC, PLASTIC];
                keys.extend(names.iter().zip(colours).map(|(name, colour)| (colour, (*name).to_owned())));
            }
            Colours::Pressure if range.all[0] <= 0.0 => keys.push((PAPER, blank.to_owned())),
            Colours::Gap => {
                keys.push((PAPER, "in contact".to_owned()));
                if range.all[0] < 0.0 {
                    keys.push((PLASTIC, "in contact and flattened: negative by what has yielded".to_owned()));
                }
            }
            _ => {}
        }
        if range.has_missing {
            keys.push((MISSING, missing.to_owned()));
        }
        keys
    }

    /// Whether the colours stand for classes.
    pub(super) fn is_of_classes(&self) -> bool {
        matches!(self.colours, Colours::Classes(_))
    }
}

/// The colours of a gradient, from its low to its high end, as hexadecimal digits.
pub(crate) fn palette(colours: Colours) -> String {
    const STEPS: u16 = 256;
    let shading = Shading { range: [0.0, 1.0], colours };
    let colour = |step| shading.colour(f64::from(step) / f64::from(STEPS - 1));
    (0..STEPS).flat_map(colour).map(|part| format!("{part:02x}")).collect()
}

/// `a` and `b` in the proportions `1 − t` and `t`.
pub(super) fn mix(a: Rgb, b: Rgb, t: f64) -> Rgb {
    std::array::from_fn(|c| (f64::from(a[c]) + t * (f64::from(b[c]) - f64::from(a[c]))).round() as u8)
}

/// Extremes of the values of a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Range {
    /// Least and largest finite value.
    pub(super) all: [f64; 2],
    /// Least and largest finite value above 0.
    pub(super) positive: [f64; 2],
    /// Whether a value is not finite.
    pub(super) has_missing: bool,
}

impl Range {
    pub(super) fn of(cells: ArrayView2<f64>) -> Self {
        const NONE: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];
        let none = || Self { all: NONE, positive: NONE, has_missing: false };
        let both = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        let row = |row: usize| {
            cells.row(row).iter().fold(none(), |mut range, value| {
                if value.is_finite() {
                    range.all = both(range.all, [*value; 2]);
                    if *value > 0.0 {
                        range.positive = both(range.positive, [*value; 2]);
                    }
                } else {
                    range.has_missing = true;
                }
                range
            })
        };
        let rows: Vec<Self> = (0..cells.nrows()).into_par_iter().map(row).collect();
        rows.into_iter().fold(none(), |a, b| Self {
            all: both(a.all, b.all),
            positive: both(a.positive, b.positive),
            has_missing: a.has_missing || b.has_missing,
        })
    }
}

/// Cells that a pixel covers along an axis, and how much of it each fills.
type Shares = Vec<(usize, f64)>;

/// The cells that each of `pixels` covers.
fn shares(cells: usize, pixels: usize) -> Vec<Shares> {
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
