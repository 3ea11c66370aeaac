//! Implausible quantities, which most likely have a wrong unit.

use super::Estimate;
use crate::grid::Grid;
use crate::study::case::{Body, Case, Hardness, Source};
use crate::units::{self, Dimension, Metre, Pascal};

/// Softer than any rubber.
const SOFT: Pascal = 1e6;
/// Cells of this size do not resolve roughness.
const WIDE: Metre = 1e-3;
/// Hardness over E*: glass and the hardest ceramics come near this value, and metals stay below a fifth of it.
const HARD: f64 = 0.1;

/// Warns of implausible quantities in `case` on `grid`.
pub(super) fn implausible(case: &Case, grid: &Grid, estimate: &Estimate, warnings: &mut Vec<String>) {
    if estimate.modulus < SOFT && !case.is_coated() {
        warnings.push(soft(case, estimate));
    }
    if grid.pitch.iter().any(|pitch| *pitch > WIDE) {
        warnings.push(wide(case, grid));
    }
    if estimate.hardness > HARD * estimate.modulus && !case.is_coated() && estimate.hardness.is_finite() {
        warnings.push(hard(case, estimate));
    }
}

fn soft(case: &Case, estimate: &Estimate) -> String {
    let body = softer(case.lower.material.young, case.upper.material.young);
    let young = if body == "lower" { case.lower.material.young } else { case.upper.material.young };
    let written = case.written(&format!("{body}.young"));
    let said = format!(
        "E* is {}, softer than any rubber: `young = {written}` of the {body} body",
        units::format(estimate.modulus, Dimension::Pressure)
    );
    match written.parse::<f64>() {
        Ok(number) if number < 1e4 => {
            format!("{said} is {}: was \"{number} GPa\" meant?", units::format(young, Dimension::Pressure))
        }
        _ => format!("{said}: check its unit"),
    }
}

fn wide(case: &Case, grid: &Grid) -> String {
    let [x, y] = grid.pitch.map(|pitch| units::format(pitch, Dimension::Length));
    let spec = &case.lower.topography;
    let said = format!("cells of {x} × {y} see no roughness");
    let written = case.written("lower.topography.pitch");
    match (spec.pitch, written.parse::<f64>(), &spec.source) {
        (Some(_), Ok(number), _) => {
            format!("{said}: `pitch = {written}` is in metres, was \"{number} um\" meant?")
        }
        (None, _, Source::File { path, .. }) => {
            format!("{said}: check the unit of the lengths in {}", path.display())
        }
        _ => format!("{said}: check the unit of `pitch`"),
    }
}

fn hard(case: &Case, estimate: &Estimate) -> String {
    let bears = |body: &Body| match body.hardness {
        Hardness::Uniform(value) => value,
        Hardness::Map(_) | Hardness::Given(_) => 0.0,
    };
    let body = softer(bears(&case.lower), bears(&case.upper));
    let pressure = |value| units::format(value, Dimension::Pressure);
    format!(
        "`hardness = {}` of the {body} body is above a tenth of E*, {}, and hardly any solid is so hard: check the \
         units of `hardness` and `young`, or leave `hardness` out for an elastic body",
        case.written(&format!("{body}.hardness")),
        pressure(HARD * estimate.modulus)
    )
}

/// Name of the body with the smaller value.
fn softer(lower: f64, upper: f64) -> &'static str {
    if lower <= upper { "lower" } else { "upper" }
}

#[cfg(test)]
mod tests {
    use crate::study::case::Case;
    use crate::study::estimate::estimate;
    use crate::study::prepare::bodies;

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
        estimate(&case, &bodies(&case, crate::study::SurfaceInput::default()).unwrap()).unwrap().warnings
    }

    #[test]
    fn plausible_numbers_need_no_word() {
        assert_eq!(warnings("\"210 GPa\"", "hardness = \"4 GPa\"", "\"0.5 um\""), [""; 0]);
        // Rubber on cells of a millimetre.
        assert_eq!(warnings("\"2 MPa\"", "", "\"1 mm\""), [""; 0]);
    }

    #[test]
    fn a_number_without_its_unit_is_noticed() {
        let said = |found: Vec<String>, words: &[&str]| {
            assert_eq!(found.len(), 1, "{found:?}");
            assert!(words.iter().all(|word| found[0].contains(word)), "{found:?}");
        };
        said(warnings("210", "", "\"0.5 um\""), &["`young = 210`", "is 210 Pa", "\"210 GPa\"", "E* is 230"]);
        said(warnings("\"3 kPa\"", "", "\"0.5 um\""), &["`young = \"3 kPa\"`", "check its unit"]);
        said(warnings("\"210 GPa\"", "", "0.5"), &["cells of 500 mm × 500 mm", "\"0.5 um\" meant"]);
        said(warnings("\"210 GPa\"", "", "[\"1 um\", \"2 mm\"]"), &["1 µm × 2 mm", "`pitch`"]);
        said(
            warnings("\"70 GPa\"", "hardness = \"9 GPa\"", "\"0.5 um\""),
            &["`hardness = \"9 GPa\"` of the lower body", "7.69", "elastic"],
        );
    }
}
