//! Options of figures.

use clap::Args;

use super::values::{choice, factor, positive_length, range};
use asperity_report::draw::{Format, Paper};

/// The file type, resolution and width of figures.
#[derive(Debug, Args)]
pub(crate) struct Drawing {
    /// File type, pixels or vectors with selectable text; several with commas: svg,pdf
    #[arg(long, default_value = "png", value_delimiter = ',', value_parser = choice::<Format>())]
    format: Vec<Format>,
    /// Dots per inch
    #[arg(long, value_name = "N", default_value_t = 300.0, value_parser = dpi)]
    dpi: f64,
    /// Width of a figure, such as 85mm; chosen by default. The size of letters does not change
    #[arg(long, value_name = "LENGTH", value_parser = width)]
    width: Option<f64>,
    /// Omit the title and the line below it, for journals that print captions outside figures
    #[arg(long)]
    no_title: bool,
}

/// Options of figures with a range of values.
#[derive(Debug, Args)]
pub(crate) struct RangedDrawing {
    #[command(flatten)]
    drawing: Drawing,
    /// Range of the colours, or of the y axis of curves, such as 0,2GPa
    #[arg(long, value_name = "LOW,HIGH", value_parser = range, allow_hyphen_values = true)]
    range: Option<[f64; 2]>,
}

impl Drawing {
    /// Returns a paper for each file type.
    pub(crate) fn papers(&self) -> Vec<Paper> {
        let paper = |format: &Format| Paper {
            format: *format,
            dpi: self.dpi,
            width: self.width,
            titled: !self.no_title,
            ..Paper::default()
        };
        self.format.iter().map(paper).collect()
    }
}

impl RangedDrawing {
    /// Returns a paper for each file type.
    pub(crate) fn papers(&self) -> Vec<Paper> {
        let range = self.range;
        self.drawing.papers().into_iter().map(|paper| Paper { range, ..paper }).collect()
    }

    /// Returns the given range.
    pub(crate) fn range(&self) -> Option<[f64; 2]> {
        self.range
    }
}

fn dpi(text: &str) -> Result<f64, String> {
    factor(text)
        .ok()
        .filter(|dpi| (20.0..=2400.0).contains(dpi))
        .ok_or_else(|| "expected 20 to 2400".to_owned())
}

fn width(text: &str) -> Result<f64, String> {
    positive_length(text).and_then(|width| match width {
        0.03..=1.0 => Ok(width),
        _ => Err("expected 30mm to 1m".to_owned()),
    })
}
