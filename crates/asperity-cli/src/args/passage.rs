//! The arguments of `asperity conductance` and `asperity flow`.

use std::path::PathBuf;

use asperity::conductance::Kind;
use asperity::flow::{Along, Ends, Faces, Sides};
use asperity::operator::{Boundary, Edge};
use asperity::units::Dimension;
use clap::Args;

use super::drawing::RangedDrawing;
use super::surface::Input;
use super::values::{boundary, choice, default, quantity};

/// Compute the conductance of a contact from a map of the cells that touch
///
/// Reads a mask, a map of pressure or an image of the contact, in any format of `asperity surface info`. Cells above 0 touch, see --above and
/// --below. Heat or current passes these cells, a film on them, and gas in the gap. The bodies are half-spaces below their surfaces.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  asperity conductance pressure.npy --pitch 1um --conductivity '46 W/(m K)' --boundary periodic
  asperity conductance pressure.npy --pitch 1um --conductivity '46 W/(m K)' --gap gap.npy --gas '0.026 W/(m K)' --jump 0.37um
  asperity conductance contact.tif --pitch 1um --below 100 --kind electrical --conductivity '58 MS/m,38 MS/m' --film '1e-12 ohm m2'"
)]
pub(crate) struct Conductance {
    /// Conductivity of both bodies, or of the lower and the upper one, of which one may be `inf`
    #[arg(long, value_name = "VALUE[,VALUE]")]
    pub(crate) conductivity: String,
    /// Whether heat or current passes
    #[arg(long, default_value = default::<Kind>(), value_parser = choice::<Kind>())]
    pub(crate) kind: Kind,
    /// Surroundings of the map, for both axes or for each
    #[arg(long, value_name = "free|periodic[,free|periodic]", default_value = default::<Edge>(), value_parser = boundary)]
    pub(crate) boundary: Boundary,
    /// Resistance of an area of the film on the spots, such as `1e-8 m2 K/W` or `1e-12 ohm m2`; default: none
    #[arg(long, value_name = "VALUE")]
    pub(crate) film: Option<String>,
    /// Conductivity of a gas in the gap, such as `0.026 W/(m K)`; default: none
    #[arg(long, value_name = "VALUE", requires = "gap", value_parser = positive_conductivity)]
    pub(crate) gas: Option<f64>,
    /// Temperature jump distance of the gas at both surfaces together, such as 0.37um; default: 0
    #[arg(long, value_name = "LENGTH", requires = "gas", value_parser = length)]
    pub(crate) jump: Option<f64>,
    /// Gap between the bodies for the gas: a file, read and prepared as the map of the contact
    #[arg(long, value_name = "FILE", requires = "gas")]
    pub(crate) gap: Option<PathBuf>,
    /// Cells above this number touch, in the units of the file, or in metres
    #[arg(long, value_name = "NUMBER", default_value_t = 0.0, allow_hyphen_values = true, value_parser = number)]
    pub(crate) above: f64,
    /// Cells below this number touch, not those above one
    #[arg(long, value_name = "NUMBER", conflicts_with = "above", allow_hyphen_values = true, value_parser = number)]
    pub(crate) below: Option<f64>,
    #[command(flatten)]
    pub(crate) writing: Writing,
    #[command(flatten)]
    pub(crate) drawing: RangedDrawing,
    #[command(flatten)]
    pub(crate) input: Input,
}

/// Compute the flow of a fluid through a gap from a map of the gap
///
/// Reads the gap as heights, in any format of `asperity surface info`. Cells whose gap is not positive are closed. Prints permeability, leakage
/// and the critical constriction. The pressure of the fluid does not deform the bodies.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  asperity flow gap.npy --pitch 1um --viscosity 80mPas --pressure 1bar
  asperity flow gap.x3p --viscosity 0.018mPas --pressure 4bar --outlet 1bar --ends reservoirs --sides closed --out leak")]
pub(crate) struct Flow {
    /// Viscosity of the fluid, such as 80mPas; required for the leakage
    #[arg(long, value_name = "VALUE", requires = "pressure", value_parser = viscosity)]
    pub(crate) viscosity: Option<f64>,
    /// Pressure difference over the length of the gap, such as 1bar; required for the leakage
    #[arg(long, value_name = "PRESSURE", requires = "viscosity", value_parser = drop)]
    pub(crate) pressure: Option<f64>,
    /// Absolute pressure of an ideal gas at the outlet, such as 1bar; default: the fluid is a liquid
    #[arg(long, value_name = "PRESSURE", requires = "viscosity", value_parser = pressure)]
    pub(crate) outlet: Option<f64>,
    /// Direction of the pressure gradient
    #[arg(long, default_value = default::<Along>(), value_parser = choice::<Along>())]
    pub(crate) along: Along,
    /// Ends of the gap along the gradient: it repeats itself, or the fluid has a given pressure at each end
    #[arg(long, default_value = default::<Ends>(), value_parser = choice::<Ends>())]
    pub(crate) ends: Ends,
    /// Sides of the gap: it repeats itself, or has walls
    #[arg(long, default_value = default::<Sides>(), value_parser = choice::<Sides>())]
    pub(crate) sides: Sides,
    /// Conductance between two cells: for a gap linear between their centres, or the harmonic mean
    #[arg(long, default_value = default::<Faces>(), value_parser = choice::<Faces>())]
    pub(crate) faces: Faces,
    #[command(flatten)]
    pub(crate) writing: Writing,
    #[command(flatten)]
    pub(crate) drawing: RangedDrawing,
    #[command(flatten)]
    pub(crate) input: Input,
}

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

impl Conductance {
    /// Returns the conductivities of both bodies, lower first, which may be infinite.
    ///
    /// # Errors
    /// The reason, with the name of the option.
    pub(crate) fn conductivities(&self) -> Result<[f64; 2], String> {
        let dimension = self.kind.conductivity();
        let positive = |text: &str| match text.trim() {
            "inf" => Ok(f64::INFINITY),
            text => within(text, dimension, false),
        };
        let parts = self.conductivity.split(',').map(positive).collect::<Result<Vec<_>, _>>();
        let both = match parts.as_deref() {
            Ok([both]) => Ok([*both; 2]),
            Ok([lower, upper]) => Ok([*lower, *upper]),
            Ok(_) => Err("expected one value, or two with a comma between".to_owned()),
            Err(error) => Err(error.clone()),
        };
        let both = both.and_then(|both| match both.iter().any(|value| value.is_finite()) {
            true => Ok(both),
            false => Err("expected a finite conductivity of one body at least".to_owned()),
        });
        both.map_err(|error| format!("invalid value '{}' for --conductivity: {error}", self.conductivity))
    }

    /// Returns the resistance of an area of the film; 0 without one.
    ///
    /// # Errors
    /// The reason, with the name of the option.
    pub(crate) fn film(&self) -> Result<f64, String> {
        let Some(text) = &self.film else { return Ok(0.0) };
        let film = within(text, self.kind.insulance(), true);
        film.map_err(|error| format!("invalid value '{text}' for --film: {error}"))
    }
}

/// Parses a quantity above 0 within its range, or 0 where it has a meaning.
fn within(text: &str, dimension: Dimension, or_0: bool) -> Result<f64, String> {
    let range = dimension.range();
    match quantity(text, dimension)? {
        value if range.holds(value) || or_0 && value == 0.0 => Ok(value),
        _ if or_0 => Err(format!("expected 0, or {} of {range}", dimension.noun())),
        _ => Err(format!("expected {} of {range}", dimension.noun())),
    }
}

fn positive_conductivity(text: &str) -> Result<f64, String> {
    within(text, Dimension::Conductivity, false)
}

fn viscosity(text: &str) -> Result<f64, String> {
    within(text, Dimension::Viscosity, false)
}

fn pressure(text: &str) -> Result<f64, String> {
    within(text, Dimension::Pressure, false)
}

fn drop(text: &str) -> Result<f64, String> {
    within(text, Dimension::Pressure, true)
}

fn length(text: &str) -> Result<f64, String> {
    within(text, Dimension::Length, true)
}

fn number(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| "expected a number".to_owned())
}
