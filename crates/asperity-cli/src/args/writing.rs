//! Arguments of what is computed from a map: its output, and quantities within their ranges.

use std::path::PathBuf;

use asperity::units::Dimension;
use clap::Args;

use super::values::quantity;

/// Output of numbers, fields and figures.
#[derive(Debug, Args)]
pub(crate) struct Writing {
    /// Print JSON, in SI
    #[arg(long)]
    pub(crate) json: bool,
    /// Folder for the numbers (JSON), the fields (HDF5) and the figures; default: none are written
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Replace the files in it
    #[arg(long, requires = "out")]
    pub(crate) overwrite: bool,
}

/// Parses a quantity above 0 within its range, or 0 where it has a meaning.
pub(crate) fn within(text: &str, dimension: Dimension, or_0: bool) -> Result<f64, String> {
    let range = dimension.range();
    match quantity(text, dimension)? {
        value if range.holds(value) || or_0 && value == 0.0 => Ok(value),
        _ if or_0 => Err(format!("expected 0, or {} of {range}", dimension.noun())),
        _ => Err(format!("expected {} of {range}", dimension.noun())),
    }
}
