//! The arguments of a contact of two files, and of a new case file.

use std::ffi::OsStr;
use std::path::PathBuf;

use asperity::lubrication::{NamedOil, OILS};
use asperity::material;
use asperity::units::{self, Dimension};
use clap::builder::{PossibleValue, TypedValueParser};
use clap::{Arg, Args, Command};

use super::ReadingArguments;
use super::values::{quantity, threads};

/// Compute the contact of two topography files
///
/// Fills missing heights, removes the tilt, brings both surfaces to a common grid, solves the contact and
/// writes its results. DIR/case.toml is the case that was computed: edit it and run it again with
/// `asperity run`.
#[derive(Debug, Args)]
#[command(
    after_help = "Example:\n  asperity contact disc.x3p plate.x3p --load \"0.5 N\" --material steel --open"
)]
pub(crate) struct Contact {
    #[command(flatten)]
    pub(crate) bodies: Bodies,
    #[command(flatten)]
    pub(crate) writing: PairWriting,
    #[command(flatten)]
    pub(crate) reading: ReadingArguments,
}

/// Compute passes of one topography file over another
///
/// Prepares both surfaces as `asperity contact` does. The upper one enters on the left, passes over the lower
/// one and leaves on the right; with --periodic it goes round. A hardness lets the surfaces run in.
#[derive(Debug, Args)]
#[command(
    after_help = "Example:\n  asperity slide disc.x3p plate.x3p --load \"0.5 N\" --material bearing-steel --passes 5 --open"
)]
pub(crate) struct Slide {
    #[command(flatten)]
    pub(crate) bodies: Bodies,
    /// Number of passes
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) passes: u32,
    #[command(flatten)]
    pub(crate) writing: PairWriting,
    #[command(flatten)]
    pub(crate) reading: ReadingArguments,
}

/// Write a case file with comments, from answers to five questions or from options
///
/// Asks for what no option gives: the two surfaces, their materials, the load and the number of passes. An
/// empty answer takes the default.
#[derive(Debug, Args)]
#[command(
    after_help = "Example:\n  asperity init --lower disc.x3p --upper plate.x3p --material steel --load \"0.5 N\" --passes 0"
)]
pub(crate) struct Init {
    /// Case file to write
    #[arg(value_name = "CASE.toml", default_value = "case.toml")]
    pub(crate) case: PathBuf,
    /// Topography file of the lower body
    #[arg(long, value_name = "FILE")]
    pub(crate) lower: Option<String>,
    /// Topography file of the upper body
    #[arg(long, value_name = "FILE")]
    pub(crate) upper: Option<String>,
    /// Material of both bodies, or those of the lower and the upper one; `asperity materials` lists them
    #[arg(long, value_name = "NAME[,NAME]", value_parser = pair_of_materials)]
    pub(crate) material: Option<Both>,
    /// Load, such as 0.5N, or mean pressure, such as 20MPa
    #[arg(long, value_name = "LOAD", value_parser = load)]
    pub(crate) load: Option<Load>,
    /// Number of passes; 0: a contact at rest
    #[arg(long, value_name = "N")]
    pub(crate) passes: Option<u32>,
    /// Replace the case file if it exists
    #[arg(long)]
    pub(crate) overwrite: bool,
}

/// Two bodies under a load.
#[derive(Debug, Args)]
pub(crate) struct Bodies {
    /// Topography file of the lower body
    #[arg(value_name = "LOWER")]
    pub(crate) lower: PathBuf,
    /// Topography file of the upper body, as measured, with its material below
    #[arg(value_name = "UPPER")]
    pub(crate) upper: PathBuf,
    /// Load, such as 0.5N, or mean pressure, such as 20MPa
    #[arg(long, value_name = "LOAD", value_parser = load)]
    pub(crate) load: Load,
    /// Material of both bodies, or those of the lower and the upper one; `asperity materials` lists them
    #[arg(long, value_name = "NAME[,NAME]", value_parser = pair_of_materials)]
    pub(crate) material: Both,
    /// Largest pressure of both bodies, or of the lower and the upper one, such as 4GPa; inf: elastic;
    /// default: that of the material
    #[arg(long, value_name = "PRESSURE[,PRESSURE]", value_parser = pair_of_hardnesses)]
    pub(crate) hardness: Option<Both>,
    /// The surfaces repeat themselves along both axes
    #[arg(long)]
    pub(crate) periodic: bool,
}

/// Where the results go.
#[derive(Debug, Args)]
pub(crate) struct PairWriting {
    /// Results directory; default: the names of both files with `-contact` or `-slide`
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Replace existing results
    #[arg(long)]
    pub(crate) overwrite: bool,
    /// Open the page of results in the browser
    #[arg(long)]
    pub(crate) open: bool,
    /// Number of threads, at most 1024; default: the limit of a scheduler or container, otherwise all cores
    #[arg(long, value_name = "N", value_parser = threads)]
    pub(crate) threads: Option<usize>,
    /// Print only warnings and errors
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// Texts of the lower and of the upper body.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Both(pub(crate) [String; 2]);

/// The prescribed load or mean pressure, as it was written.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Load {
    /// Its key in a case.
    pub(crate) key: &'static str,
    pub(crate) text: String,
}

fn both(text: &str, good: impl Fn(&str) -> Result<(), String>) -> Result<Both, String> {
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    parts.iter().try_for_each(|part| good(part))?;
    match parts[..] {
        [both] => Ok(Both([both.to_owned(), both.to_owned()])),
        [lower, upper] => Ok(Both([lower.to_owned(), upper.to_owned()])),
        _ => Err("expected one for both bodies, or two with a comma between".to_owned()),
    }
}

pub(crate) fn pair_of_materials(text: &str) -> Result<Both, String> {
    both(text, |name| {
        if material::NAMES.contains(&name) {
            Ok(())
        } else {
            Err(no_material(name, material::NamedMaterial::near(name)))
        }
    })
}

fn no_material(name: &str, near: Option<String>) -> String {
    let near = near.map_or(String::new(), |hint| format!(" ({hint})"));
    format!("no material `{name}`{near}; `asperity materials` lists them")
}

fn pair_of_hardnesses(text: &str) -> Result<Both, String> {
    both(text, |text| match text {
        "inf" => Ok(()),
        _ => match quantity(text, Dimension::Pressure)? {
            value if value > 0.0 => Ok(()),
            _ => Err("expected a pressure above 0 such as 4GPa, or inf".to_owned()),
        },
    })
}

pub(crate) fn load(text: &str) -> Result<Load, String> {
    const EXPECTED: &str = "expected a force such as 0.5N, or a pressure such as 20MPa, above 0";
    let text = text.trim();
    let [force, pressure] = [Dimension::Force, Dimension::Pressure].map(|kind| units::parse(text, kind));
    let (key, value) = match (force, pressure) {
        (Ok(force), _) => ("load", force),
        (_, Ok(pressure)) => ("mean_pressure", pressure),
        (Err(force), Err(pressure)) => {
            let hint = force.hint().or_else(|| pressure.hint());
            return Err(hint.map_or(EXPECTED.to_owned(), |hint| format!("{EXPECTED}; {hint}")));
        }
    };
    if value > 0.0 && value.is_finite() {
        Ok(Load { key, text: text.to_owned() })
    } else {
        Err(EXPECTED.to_owned())
    }
}

/// Print the materials and lubricants that are known by name
///
/// Materials: Young's modulus, Poisson's ratio, hardness where the grade determines it, and the constants of heat
/// and current. Lubricants: viscosity at 40 °C and 100 °C, pressure-viscosity coefficient and density. Each has a
/// source.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  asperity materials steel\n  asperity materials \"ISO VG 46\"")]
pub(crate) struct Materials {
    /// Material or lubricant whose source is printed, too
    #[arg(value_parser = MaterialParser, hide_possible_values = true)]
    pub(crate) name: Option<String>,
    /// Print JSON, in SI
    #[arg(long)]
    pub(crate) json: bool,
}

/// Reads the name of a material or of a lubricant.
#[derive(Debug, Clone)]
struct MaterialParser;

impl TypedValueParser for MaterialParser {
    type Value = String;

    fn parse_ref(&self, command: &Command, arg: Option<&Arg>, value: &OsStr) -> Result<String, clap::Error> {
        let known = |name: &str| {
            if material::NAMES.contains(&name) || NamedOil::from_name(name).is_some() {
                return Ok(name.to_owned());
            }
            Err(no_material(name, NamedOil::near(name).or_else(|| material::NamedMaterial::near(name))))
        };
        known.parse_ref(command, arg, value)
    }

    /// Returns the names that a shell completes: those without a space.
    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        let oils = OILS.iter().map(|oil| oil.name).filter(|name| !name.contains(' '));
        Some(Box::new(material::NAMES.iter().copied().chain(oils).map(PossibleValue::new)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bodies_share_a_word_or_have_their_own() {
        let names = |text| pair_of_materials(text).map(|both| both.0.map(|name| name.clone()));
        assert_eq!(names("steel").unwrap(), ["steel", "steel"]);
        assert_eq!(names("steel, alumina").unwrap(), ["steel", "alumina"]);
        assert!(names("steel,steel,steel").is_err() && names("stele").is_err());
        let told = "no material `Cr` (did you mean `chromium`?); `asperity materials` lists them";
        assert_eq!(names("steel,Cr").unwrap_err(), told);
        assert!(pair_of_hardnesses("4GPa,inf").is_ok() && pair_of_hardnesses("0").is_err());
        assert_eq!(load("0.5 N").unwrap(), Load { key: "load", text: "0.5 N".to_owned() });
        assert_eq!(load("20MPa").unwrap().key, "mean_pressure");
        assert!(load("-1N").is_err() && load("3 um").is_err() && load("inf").is_err());
        assert!(
            load("1kg").unwrap_err().ends_with("; a mass is no force: the weight of 1 kg is `\"9.80665 N\"`")
        );
        assert!(load("30 psi").unwrap_err().ends_with("; 30 psi is `\"206.843 kPa\"`"));
    }
}
