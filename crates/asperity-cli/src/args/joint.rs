//! Arguments of `asperity joint`.

use std::path::PathBuf;

use asperity::study::joint::{Client, Units};
use clap::Args;

use super::study::Cases;
use super::values::choice;

/// Compute the law of a joint of rough surfaces for other programs
///
/// The case has several loads under a periodic boundary. Its table [joint] says how many samples of the surfaces are
/// computed: other seeds of generated ones, or patches of measured ones. DIR/joint.csv has the median and the band at each
/// load, DIR/joint.html shows it, DIR/figures has the figures, and --for writes files for other programs. If it is stopped
/// or killed, run the same command again.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  asperity example joint\n  asperity joint joint/case.toml --for calculix --for coefficients\n  asperity joint joint.toml --for abaqus \
--friction 0.2 --out plates"
)]
pub(crate) struct Joint {
    /// Case file
    #[arg(value_name = "CASE.toml")]
    pub(crate) case: PathBuf,
    /// Program for which files are written: csv, calculix, abaqus, ansys, comsol, moose, opensees or coefficients;
    /// may be repeated
    #[arg(long = "for", value_name = "PROGRAM", value_parser = choice::<Client>())]
    pub(crate) clients: Vec<Client>,
    /// Directory; default: case file name with `-joint`
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Units of the files: mm (mm, N, MPa) or si
    #[arg(long, value_name = "UNITS", default_value = "mm", value_parser = choice::<Units>())]
    pub(crate) units: Units,
    /// Friction coefficient of surfaces that may slip, for programs that take one
    #[arg(long, value_name = "MU", allow_hyphen_values = true, value_parser = coefficient)]
    pub(crate) friction: Option<f64>,
    #[command(flatten)]
    pub(crate) cases: Cases,
}

fn coefficient(text: &str) -> Result<f64, String> {
    let wrong = || "expected a number above 0, such as 0.2".to_owned();
    let value: f64 = text.parse().map_err(|_| wrong())?;
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err(wrong()) }
}
