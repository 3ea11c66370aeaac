//! The closed form beside the computed contact of smooth forms.

use asperity_study::{ClosedFormRecord, Theory};

use crate::support::{at_rest, parsed};

/// The closed form beside a contact of two steel bodies under these tables.
fn beside(lower: &str, upper: &str, contact: &str, more: &str) -> Option<ClosedFormRecord> {
    let body = |name: &str, form: &str, hardness: &str| {
        format!("[{name}]\nyoung = \"210 GPa\"\npoisson = 0.3\n{hardness}\ntopography = {{ {form} }}\n")
    };
    let grid = "shape = [64, 48], pitch = [\"6 um\", \"8 um\"]";
    let lower = body("lower", &format!("{lower}, {grid}"), more);
    let text = format!("{lower}{}[contact]\n{contact}\n", body("upper", upper, ""));
    at_rest(&parsed(&text)).closed_form
}

const FLAT: &str = "form = \"flat\"";
const SPHERE: &str = "form = \"sphere\", radius = \"20 mm\"";

fn is_near(record: &ClosedFormRecord, theory: Theory, tolerance: f64) {
    assert_eq!(record.theory, theory);
    let deviations =
        [Some(record.contact_area_deviation), record.max_pressure_deviation, record.approach_deviation];
    // A grid rounds the area of contact to whole cells.
    for (deviation, tolerance) in deviations.into_iter().zip([0.08, tolerance, tolerance]) {
        assert!(deviation.is_none_or(|deviation| deviation.abs() < tolerance), "{record:?}");
    }
}

#[test]
fn contacts_of_forms_are_near_their_closed_forms() {
    let load = "load = \"20 N\"";
    for (lower, upper) in [
        (FLAT, SPHERE),
        (SPHERE, FLAT),
        (SPHERE, SPHERE),
        (SPHERE, "form = \"cylinder\", radius = \"40 mm\", axis = \"x\""),
        ("form = \"cylinder\", radius = \"20 mm\"", "form = \"cylinder\", radius = \"15 mm\", axis = \"x\""),
        (FLAT, "form = \"ellipsoid\", radius = [\"20 mm\", \"12 mm\"]"),
    ] {
        is_near(&beside(lower, upper, load, "").unwrap(), Theory::HertzPoint, 0.01);
    }
    // By the approach, too: the closed form has the load that was found.
    is_near(&beside(FLAT, SPHERE, "approach = \"0.4 um\"", "").unwrap(), Theory::HertzPoint, 0.01);
    let line = "load = \"30 N\"\nboundary = [\"free\", \"periodic\"]";
    let roller = beside(FLAT, "form = \"cylinder\", radius = \"20 mm\"", line, "").unwrap();
    is_near(&roller, Theory::HertzLine, 0.01);
    assert_eq!((roller.theory_approach, roller.theory_half_widths[1]), (None, 0.5 * 48.0 * 8e-6));
    let cone = beside(FLAT, "form = \"cone\", angle = \"1 deg\"", "load = \"20 N\"", "").unwrap();
    is_near(&cone, Theory::SneddonCone, 0.02);
    assert_eq!((cone.theory_max_pressure, cone.max_pressure_deviation), (None, None));
}

#[test]
fn no_closed_form_stands_beside_what_it_does_not_describe() {
    let load = "load = \"20 N\"";
    let has_one =
        |lower: &str, upper: &str, contact: &str, more: &str| beside(lower, upper, contact, more).is_some();
    assert!(has_one(FLAT, SPHERE, load, "hardness = \"6 GPa\""));
    for (lower, upper, contact, more) in [
        // Cells yield, or the body is layered.
        (FLAT, SPHERE, load, "hardness = \"0.5 GPa\""),
        (FLAT, SPHERE, load, "coating = { thickness = \"2 um\", young = \"300 GPa\", poisson = 0.25 }"),
        // The bodies repeat, or a roller ends.
        (FLAT, SPHERE, "load = \"20 N\"\nboundary = \"periodic\"", ""),
        (FLAT, "form = \"cylinder\", radius = \"20 mm\"", load, ""),
        (FLAT, FLAT, "mean_pressure = \"1 MPa\"\nboundary = \"periodic\"", ""),
        (FLAT, "form = \"sinusoid\", amplitude = \"0.1 um\", wavelength = \"96 um\"", load, ""),
        (SPHERE, "form = \"cone\", angle = \"1 deg\"", load, ""),
        // What is added to a form changes it.
        (
            FLAT,
            "form = \"sphere\", radius = \"20 mm\", plus = [{ form = \"cone\", angle = \"0.1 deg\" }]",
            load,
            "",
        ),
        // Nothing touches.
        (FLAT, SPHERE, "approach = \"-1 um\"", ""),
    ] {
        assert!(!has_one(lower, upper, contact, more), "{upper} {contact} {more}");
    }
}
