//! Quantities outside what exists, which most likely have another unit than their author meant.

use toml::Value;

use super::Estimate;
use crate::case::schema::tables::declaration;
use crate::case::schema::{Exists, Key};
use crate::case::{Body, Case, Hardness, Source, TopographySpec};
use asperity_base::grid::Grid;
use asperity_base::units::{self, Dimension, Metre, Pascal, format_number};

/// Cells of this size do not resolve roughness.
const WIDE: Metre = 1e-3;
/// Composite modulus of the softest rubbers. Gels are softer, and rarely meant.
const SOFT: Pascal = 1e6;
/// Hardness over E/(1 − ν²) of a body: glass and the hardest ceramics come near this value, and metals stay
/// below a fifth of it.
const HARD: f64 = 0.1;

/// Warns of implausible quantities in `case` on `grid`.
pub(super) fn implausible(case: &Case, grid: &Grid, estimate: &Estimate, warnings: &mut Vec<String>) {
    warnings.extend(given(case).iter().filter_map(unheard_of));
    if grid.pitch.iter().any(|pitch| *pitch > WIDE) {
        warnings.extend(wide(case, grid));
    }
    if estimate.modulus < SOFT && !case.is_coated() {
        warnings.extend(soft(case, estimate));
    }
    warnings.extend([("lower", &case.lower), ("upper", &case.upper)].into_iter().filter_map(hard));
}

/// A value of a case file.
pub(super) struct GivenValue {
    /// The dotted key.
    pub(super) path: String,
    /// The text of the value.
    pub(super) text: String,
    /// The declaration of the key.
    pub(super) key: &'static Key,
    /// Its numbers, SI, with their texts without a unit.
    pub(super) numbers: Vec<(f64, String)>,
}

/// Returns the values of the keys in a case file.
pub(super) fn given(case: &Case) -> Vec<GivenValue> {
    case.document().values().filter_map(|(path, text)| GivenValue::of(path, text)).collect()
}

impl GivenValue {
    fn of(path: &str, text: String) -> Option<Self> {
        let key = declaration(path)?;
        let written: toml::Table = toml::from_str(&format!("value = {text}")).ok()?;
        let numbers = quantities(&written["value"], key.kind.dimension());
        Some(Self { path: path.to_owned(), text, key, numbers })
    }
}

/// Warns of a value outside what exists.
fn unheard_of(given: &GivenValue) -> Option<String> {
    let GivenValue { path, text, key, numbers } = given;
    let Exists::Within { least, most, of, slips } = key.exists else { return None };
    let dimension = key.kind.dimension();
    let exists = |value: f64| value == 0.0 || value.is_infinite() || (least..=most).contains(&value.abs());
    let (value, number) = numbers.iter().find(|(value, _)| !exists(*value))?;
    let said = dimension.map_or_else(|| format_number(*value), |dimension| units::format(*value, dimension));
    let beyond = if value.abs() > most {
        format!("{} times the most", far(value.abs() / most))
    } else {
        format!("1/{} of the least", far(least / value.abs()))
    };
    let meant = |slip: &&str| match (slip.contains("{}"), dimension) {
        (true, _) => Some(format!("`{}`", slip.replace("{}", number))),
        (false, Some(dimension)) => {
            let other = format!("{number} {slip}");
            units::parse(&other, dimension)
                .ok()
                .filter(|value| exists(*value))
                .map(|_| format!("\"{other}\""))
        }
        (false, None) => None,
    };
    let advice = slips
        .iter()
        .find_map(meant)
        .map_or("check it and its unit".to_owned(), |meant| format!("was {meant} meant?"));
    Some(format!("`{path} = {text}` is {said}, {beyond} that exists, {of}: {advice}"))
}

/// Writes a ratio: with a decimal below 10.
pub(super) fn far(ratio: f64) -> String {
    format_number(if ratio < 10.0 { (10.0 * ratio).round() / 10.0 } else { ratio.round() })
}

/// Numbers in a value, SI, with their texts without a unit. Those of a range are its ends.
fn quantities(value: &Value, dimension: Option<Dimension>) -> Vec<(f64, String)> {
    match value {
        Value::Integer(number) => vec![(*number as f64, number.to_string())],
        Value::Float(number) => vec![(*number, format!("{number:?}"))],
        Value::String(text) => {
            let number = text.trim().split(|c: char| !c.is_ascii_digit() && !"+-.eE_".contains(c)).next();
            let value = dimension.and_then(|dimension| units::parse(text, dimension).ok());
            value.map(|value| (value, number.unwrap_or_default().to_owned())).into_iter().collect()
        }
        Value::Array(items) => items.iter().flat_map(|item| quantities(item, dimension)).collect(),
        Value::Table(table) => {
            let ends = ["from", "to"].into_iter().filter_map(|end| table.get(end));
            ends.flat_map(|end| quantities(end, dimension)).collect()
        }
        Value::Boolean(_) | Value::Datetime(_) => Vec::new(),
    }
}

/// Warns of wide cells whose size comes from a file; a `pitch` is judged as a key.
fn wide(case: &Case, grid: &Grid) -> Option<String> {
    let file = [&case.lower, &case.upper].into_iter().find_map(|body| match &body.topography {
        TopographySpec { source: Source::File { file, .. }, pitch: None, .. } => Some(file),
        _ => None,
    })?;
    let [x, y] = grid.pitch.map(|pitch| units::format(pitch, Dimension::Length));
    Some(format!("cells of {x} × {y} see no roughness: check the unit of the lengths in {}", file.display()))
}

/// Warns of a pair that is softer than rubber, unless its modulus is told as one that does not exist.
fn soft(case: &Case, estimate: &Estimate) -> Option<String> {
    let [lower, upper] = [&case.lower, &case.upper].map(|body| body.material.young);
    let Exists::Within { least, .. } = declaration("lower.young")?.exists else { return None };
    let body = softer(lower, upper);
    (lower.min(upper) >= least).then(|| {
        format!(
            "E* is {}, softer than any rubber: check the unit of `young = {}` of the {body} body",
            units::format(estimate.modulus, Dimension::Pressure),
            case.written(&format!("{body}.young"))
        )
    })
}

/// Warns of a body that is too hard for its modulus. A coating carries the pressure in place of the body.
fn hard((name, body): (&str, &Body)) -> Option<String> {
    let Hardness::Uniform(hardness) = body.hardness else { return None };
    let bound = HARD * body.material.young / (1.0 - body.material.poisson.powi(2));
    let is_hard = hardness.is_finite() && hardness > bound && !body.material.is_layered();
    let [hardness, bound] = [hardness, bound].map(|value| units::format(value, Dimension::Pressure));
    is_hard.then(|| {
        format!(
            "the hardness of the {name} body, {hardness}, is above a tenth of its E/(1 − ν²), {bound}, and hardly any solid is so hard: \
             check the units of `hardness` and `young`, or leave `hardness` out for an elastic body"
        )
    })
}

/// Name of the body with the smaller value.
fn softer(lower: f64, upper: f64) -> &'static str {
    if lower <= upper { "lower" } else { "upper" }
}

#[cfg(test)]
mod tests {
    use super::GivenValue;
    use crate::case::Case;
    use crate::case::schema::{Bounds, Exists, Kind};
    use crate::estimate::estimate;
    use crate::prepare::bodies;

    fn warnings(young: &str, hardness: &str, pitch: &str) -> Vec<String> {
        let body = |name: &str, material: &str| {
            format!(
                "[{name}]\npoisson = 0.3\n{material}\n[{name}.topography]\nform = \"flat\"\nshape = [4, 4]\n\
                 pitch = {pitch}\n"
            )
        };
        let text = format!(
            "{}{}[contact]\nmean_pressure = 1\nboundary = \"periodic\"\n",
            body("lower", &format!("young = {young}\n{hardness}")),
            body("upper", "young = \"inf\"")
        );
        let case = Case::parse(&text, "case.toml".as_ref(), "".as_ref()).unwrap();
        estimate(&case, &bodies(&case, crate::SurfaceInput::default()).unwrap()).unwrap().warnings
    }

    #[test]
    fn plausible_numbers_need_no_word() {
        assert_eq!(warnings("\"210 GPa\"", "hardness = \"4 GPa\"", "\"0.5 um\""), [""; 0]);
        // Rubber on cells of a millimetre.
        assert_eq!(warnings("\"2 MPa\"", "", "\"1 mm\""), [""; 0]);
    }

    #[test]
    fn a_modulus_below_that_of_rubber_is_told() {
        let found = warnings("\"0.5 MPa\"", "", "\"1 um\"");
        let words = "E* is 549.5 kPa, softer than any rubber: check the unit of `young = \"0.5 MPa\"` of the lower body";
        assert_eq!(found, [words]);
    }

    #[test]
    fn a_number_without_its_unit_is_noticed() {
        let said = |found: Vec<String>, words: &str| assert_eq!(found, [words]);
        said(
            warnings("210", "", "\"0.5 um\""),
            "`lower.young = 210` is 210 Pa, 1/48 of the least that exists, soft gels to diamond: was \"210 GPa\" meant?",
        );
        said(
            warnings("\"3 kPa\"", "", "\"0.5 um\""),
            "`lower.young = \"3 kPa\"` is 3 kPa, 1/3.3 of the least that exists, soft gels to diamond: was \"3 GPa\" meant?",
        );
        said(
            warnings("\"210 GPa\"", "", "0.5")[..1].to_vec(),
            "`lower.topography.pitch = 0.5` is 500 mm, 500 times the most that exists, atoms to cells that see no roughness: \
             was \"0.5 um\" meant?",
        );
        let found = warnings("\"210 GPa\"", "", "[\"1 um\", \"2 mm\"]");
        assert!(found.len() == 2 && found[0].contains("is 2 mm, 2 times the most that exists"), "{found:?}");
        let found = warnings("\"70 GPa\"", "hardness = \"9 GPa\"", "\"0.5 um\"");
        let words = ["the hardness of the lower body, 9 GPa,", "7.692 GPa", "elastic"];
        assert!(found.len() == 1 && words.iter().all(|word| found[0].contains(word)), "{found:?}");
    }

    /// The slip of the trade: a dimensionless number where 1/Pa is meant.
    #[test]
    fn wear_friction_adhesion_and_thermal_constants_are_compared_with_what_exists() {
        let said =
            |path: &str, text: &str| super::unheard_of(&GivenValue::of(path, text.to_owned()).unwrap());
        for (path, text, words) in [
            (
                "lower.wear.coefficient",
                "1e-4",
                "1e6 times the most that exists, well lubricated bearings to dry metals that seize: was `dimensionless = 0.0001` meant?",
            ),
            ("lower.wear.coefficient", "1e-8", "100 times"),
            ("friction.coefficient", "5", "is 5, 1.7 times the most that exists"),
            ("adhesion.work", "50", "was \"50 mJ/m2\" meant?"),
            ("adhesion.work", "\"50 J/m2\"", "was \"50 mJ/m2\" meant?"),
            ("flow.viscosity", "\"80 Pa s\"", "was \"80 mPa s\" meant?"),
            ("upper.conductivity", "0.046", "was \"0.046 W/(mm K)\" meant?"),
            ("lower.topography.lay", "90", "was \"90 deg\" meant?"),
            ("lower.fatigue.cycles", "1e10", "2 times the most that exists"),
            ("flow.outlet", "\"1000 bar\"", "3.3 times the most that exists, vacuum pumps to gas cylinders"),
            ("steady.speeds", "{ from = \"1 mm/s\", to = \"10 km/s\" }", "3.3 times the most that exists"),
            ("upper.density", "7.85", "was \"7.85 g/cm3\" meant?"),
            ("upper.heat_capacity", "0.46", "was \"0.46 J/(g K)\" meant?"),
        ] {
            let found = said(path, text).unwrap_or_default();
            assert!(found.starts_with(&format!("`{path} = {text}` is")) && found.contains(words), "{found}");
        }
        for (path, text) in [
            ("friction.coefficient", "0.3"),
            ("friction.coefficient", "\"inf\""),
            ("lower.hardness", "\"inf\""),
            ("adhesion.range", "\"grid\""),
            ("temperature.bulk", "[\"100 °C\", 400]"),
        ] {
            assert_eq!(said(path, text), None);
        }
    }

    #[test]
    fn every_physical_key_says_what_exists() {
        let is_bounded = |kind: &Kind| matches!(kind, Kind::Quantity(_, Bounds::Within(..)));
        let silent =
            crate::keys().iter().flat_map(|section| section.keys.iter().map(move |key| (section, key)));
        let silent: Vec<_> = silent
            .filter(|(_, key)| key.kind.dimension().is_some() && !is_bounded(&key.kind))
            .filter(|(_, key)| key.exists == Exists::Undeclared)
            .map(|(section, key)| format!("{:?} {}", section.tables, key.name))
            .collect();
        assert_eq!(silent, [""; 0]);
        for key in crate::keys().iter().flat_map(|section| section.keys) {
            if let Exists::Within { least, most, .. } = key.exists {
                assert!(least < most);
                if !key.example.is_empty() {
                    let value: toml::Table = toml::from_str(&format!("value = {}", key.example)).unwrap();
                    let numbers = super::quantities(&value["value"], key.kind.dimension());
                    let (path, text) = (key.name.to_owned(), key.example.to_owned());
                    assert_eq!(super::unheard_of(&GivenValue { path, text, key, numbers }), None);
                }
            }
        }
    }
}
