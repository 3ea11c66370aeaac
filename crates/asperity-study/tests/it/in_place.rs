//! Contacts that slide in place: implicit updates, and the compliance used to solve them.

use crate::resume::{Whole, goes_on};
use crate::support::{at_rest, parsed};

const CASE: &str = r#"
[lower]
young = "210 GPa"
poisson = 0.3
hardness = "2 GPa"
conductivity = "46 W/(m K)"
heat_capacity = "460 J/(kg K)"
density = "7850 kg/m3"
topography = { form = "flat", shape = [32, 32], pitch = "4 um" }
wear = { coefficient = "1e-4 mm3/(N m)", under_film = "1e-5 mm3/(N m)" }
film = { law = "mechano-chemical", max_thickness = "50 nm", x = 1e-14, c3 = "5 nm", c4 = 0.1, hardness = "1.5 GPa" }
[upper]
young = "210 GPa"
poisson = 0.3
conductivity = "46 W/(m K)"
heat_capacity = "460 J/(kg K)"
density = "7850 kg/m3"
topography = { form = "sphere", radius = "5 mm", shape = [32, 32], pitch = "4 um" }
wear = { energy = "1e-3 mm3/J" }
[contact]
load = "1 N"
[friction]
coefficient = 0.1
coupling = "none"
[sliding]
distance = "50 mm"
speed = "10 mm/s"
updates = 8
[temperature]
bulk = "100 °C"
"#;

#[test]
fn a_case_slides_and_goes_on_after_an_interruption_with_the_same_bits() {
    let case = parsed(CASE);
    let Whole { summary, results, .. } = &goes_on(&case);
    let updates = results.updates().unwrap();
    assert_eq!(updates.len(), 9);
    assert_eq!(summary.sliding.as_ref(), updates.last());
    let last = updates.last().unwrap();
    assert!((last.distance, last.time) == (0.05, 5.0) && last.max_temperature > 373.15);
    assert!(last.lost("wear").iter().all(|volume| *volume > 0.0) && last.lost("film")[0] < 0.0);
    // Proportional to the frictional energy, for any pressures: α μ W s.
    assert!((last.lost("wear")[1] / (1e-12 * 0.1 * 0.05) - 1.0).abs() < 1e-9);
    let names = results.static_fields().unwrap().names().unwrap();
    for name in ["pressure", "gap", "lower", "wear_lower", "wear_upper", "film_lower", "temperature"] {
        assert!(names.iter().any(|known| known == name), "{name} is missing in {names:?}");
    }
    assert!(!results.directory().join("fields").exists());
    assert_eq!(at_rest(&case).updates, updates);
}

/// Bodies that attract each other, and rubber that creeps, go on from what they remember of their last
/// contact.
#[test]
fn bodies_that_remember_their_contact_slide_on_with_the_same_bits() {
    let sticky = format!("{CASE}[adhesion]\nwork = \"1 J/m2\"\nrange = \"40 nm\"\n");
    let rubber = r#"
lower = { young = "inf", poisson = 0.3, topography = { form = "flat", shape = [24, 24], pitch = "10 um" }, wear = { coefficient = 1e-13 } }
upper = { young = "1 MPa", poisson = 0.5, viscoelastic = { moduli = ["9 MPa"], times = ["100 ms"] }, topography = { form = "sphere", radius = "2 mm" } }
contact = { load = "2 mN" }
friction = { coefficient = 0.5, coupling = "none" }
sliding = { distance = "10 mm", speed = "10 mm/s", updates = 8 }
"#;
    for text in [&sticky, rubber] {
        let update = goes_on(&parsed(text)).summary.sliding.unwrap();
        assert!(update.lost("wear")[0] > 0.0 && update.interface.is_some() == text.contains("adhesion"));
    }
}

#[test]
fn a_scar_that_reaches_the_rim_of_the_grid_is_told() {
    let case = |load: &str, k: f64, upper: &str, boundary: &str, course: &str| {
        let steel = "young = \"210 GPa\", poisson = 0.3";
        format!(
            "lower = {{ {steel}, topography = {{ form = \"flat\", shape = [24, 20], pitch = \"8 um\" }} }}\n\
             upper = {{ {steel}, topography = {{ {upper} }}, wear = {{ coefficient = \"{k} mm3/(N m)\" }} }}\n\
             contact = {{ load = \"{load}\", boundary = {boundary} }}\nfriction.coefficient = 0.5\n{course}"
        )
    };
    let ball = "form = \"sphere\", radius = \"2 mm\"";
    let roller = "form = \"cylinder\", radius = \"2 mm\", axis = \"y\"";
    let rough = "generate = \"self-affine\", hurst = 0.8, sq = \"0.1 um\", shortest = \"40 um\"";
    let slide = |distance: &str| format!("sliding = {{ distance = \"{distance}\", updates = 6 }}");
    let fret = "friction.displacement = \"5 um\"\nacceleration = { max_wear = \"1 um\" }\nhistory = [{ displacement = \"-5 um\", cycles = 3 }]";
    for (upper, boundary, course, told) in [
        (ball, "\"free\"", slide("5 m"), ""),
        (ball, "\"free\"", slide("120 m"), "along y"),
        (ball, "[\"free\", \"periodic\"]", slide("200 m"), "along x"),
        (ball, "\"periodic\"", slide("200 m"), ""),
        (roller, "[\"free\", \"periodic\"]", slide("500 m"), "along x"),
        (roller, "[\"free\", \"periodic\"]", slide("5 m"), ""),
        // Rough bodies wear everywhere.
        (rough, "\"free\"", slide("20 m"), ""),
        (ball, "\"free\"", fret.to_owned(), ""),
        (ball, "\"free\"", fret.replace("= 3 }", "= 500 }"), "along y"),
    ] {
        let (load, k) = if course.contains("cycles") { ("20 N", 1e-3) } else { ("1 N", 1e-6) };
        let text = case(load, k, upper, boundary, &course);
        let warnings = at_rest(&parsed(&text)).warnings;
        let found = warnings.iter().find(|warning| warning.contains("the scar reaches the rim"));
        assert_eq!(found.is_some(), !told.is_empty(), "{text}: {warnings:?}");
        assert!(found.is_none_or(|found| found.contains(told)), "{text}: {found:?}");
    }
}
