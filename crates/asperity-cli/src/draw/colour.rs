//! The colour of a value, and images of fields.

use colorous::{CIVIDIS, RED_BLUE, VIRIDIS};
use ndarray::ArrayView2;

use super::image::{Image, Rgb};
use super::scene::PAPER;

/// Undefined cells, and what lies outside an overlap.
pub(super) const MISSING: Rgb = [218, 218, 218];
const ELASTIC: Rgb = [0, 114, 178];
const PLASTIC: Rgb = [213, 94, 0];

/// How a field is coloured. Cells that are not finite are grey.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Colours {
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
    pub(crate) const CONTACT: Self = Self::Classes(&["no contact", "elastic", "plastic: p at its cap"]);
    /// No contact, elastic, of bodies that do not yield.
    pub(crate) const TOUCH: Self = Self::Classes(&["no contact", "contact"]);
    /// No contact, stick, slip.
    pub(crate) const STICK: Self = Self::Classes(&["no contact", "stick", "slip"]);
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

    /// The image, `width` × `height` pixels, of `cells` `[right, up]`: each pixel is the mean over its area, in colour
    /// over the cells that have one.
    pub(super) fn image(&self, cells: ArrayView2<f64>, [width, height]: [usize; 2]) -> Image {
        let columns = shares(cells.nrows(), width);
        let rows = shares(cells.ncols(), height);
        let mut pixels = Vec::with_capacity(width * height);
        for row in rows.iter().rev() {
            for column in &columns {
                // Blank, missing, below, shown.
                let (mut parts, mut tone) = ([0.0; 4], 0.0);
                for (ix, wx) in column {
                    for (iy, wy) in row {
                        let weight = wx * wy;
                        match self.tone(cells[[*ix, *iy]]) {
                            Tone::Blank => parts[0] += weight,
                            Tone::Missing => parts[1] += weight,
                            Tone::Below => parts[2] += weight,
                            Tone::At(t) => {
                                parts[3] += weight;
                                tone += weight * t;
                            }
                        }
                    }
                }
                let shown = if parts[3] > 0.0 { self.colour(tone / parts[3]) } else { PAPER };
                let whole: f64 = parts.iter().sum();
                let colours = [PAPER, MISSING, PLASTIC, shown];
                pixels.push(std::array::from_fn(|c| {
                    let sum: f64 =
                        parts.iter().zip(colours).map(|(part, rgb)| part * f64::from(rgb[c])).sum();
                    (sum / whole).round() as u8
                }));
            }
        }
        Image { width, height, pixels, clear: false }
    }

    /// A strip from the low end at the bottom to the high end at the top.
    pub(super) fn bar(&self) -> Image {
        const STEPS: usize = 256;
        let pixels = (0..STEPS).map(|j| self.colour(1.0 - (j as f64 + 0.5) / STEPS as f64)).collect();
        Image { width: 1, height: STEPS, pixels, clear: false }
    }

    /// Colour and name of what `cells` show and no bar tells.
    pub(super) fn keys(&self, cells: ArrayView2<f64>, missing: &str, blank: &str) -> Vec<(Rgb, String)> {
        let has = |what: &dyn Fn(f64) -> bool| cells.iter().any(|value| what(*value));
        let mut keys = Vec::new();
        match self.colours {
            Colours::Classes(names) => {
                let colours = [PAPER, ELASTIC, PLASTIC];
                keys.extend(names.iter().zip(colours).map(|(name, colour)| (colour, (*name).to_owned())));
            }
            Colours::Pressure if has(&|p| p.is_finite() && p <= 0.0) => keys.push((PAPER, blank.to_owned())),
            Colours::Gap => {
                keys.push((PAPER, "in contact".to_owned()));
                if has(&|gap| gap < 0.0) {
                    keys.push((PLASTIC, "in contact and flattened: negative by what has yielded".to_owned()));
                }
            }
            _ => {}
        }
        if has(&|value| !value.is_finite()) {
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

/// The cells that each of `pixels` covers, and how much of it each cell fills.
fn shares(cells: usize, pixels: usize) -> Vec<Vec<(usize, f64)>> {
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
