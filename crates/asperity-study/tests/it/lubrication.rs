//! Lubricated bodies of a case: speeds one after another, resuming, oils by name, seals, doubts.

use asperity_contact::motion::{FilmRecord, LubricationRecord, SweepRecord};
use asperity_study::{Outcome, StaticResult};

use crate::resume::goes_on;
use crate::support::{at_rest, parsed, run};

/// A steel ball with waves on a smooth plate, with what a test adds.
fn case(oil: &str) -> String {
    format!(
        r#"
[lower]
material = "steel"
hardness = inf
topography = {{ form = "flat", shape = [48, 40], pitch = "11 um" }}
[upper]
material = "steel"
hardness = inf
topography = {{ form = "sphere", radius = "10 mm", plus = [{{ generate = "low-pass", sq = "60 nm", cutoff = "66 um" }}] }}
[contact]
load = "6 N"
{oil}"#
    )
}

const OIL: &str = r#"[lubrication]
viscosity = "40 mPa s"
pressure_viscosity = "20 1/GPa"
limiting_stress = 0.05
boundary_friction = 0.12
"#;

fn films(contact: &StaticResult) -> Vec<(SweepRecord, LubricationRecord)> {
    let Outcome::Sweep(points) = &contact.outcome else { panic!("a sweep over speeds") };
    points.iter().map(|point| (point.clone(), point.lubrication.unwrap())).collect()
}

#[test]
fn an_interrupted_stribeck_curve_goes_on_to_the_same_bits() {
    let text = case(&format!("{OIL}speeds = [\"1 m/s\", \"0.1 m/s\", \"30 mm/s\", \"1 mm/s\"]\n"));
    let points = goes_on(&parsed(&text)).results.sweep().unwrap();
    assert_eq!(points.len(), 4);
    let films: Vec<FilmRecord> = points.iter().map(|point| point.lubrication.unwrap().film).collect();
    for pair in films.windows(2) {
        assert!(
            pair[1].mean_film < pair[0].mean_film && pair[1].solid_share >= pair[0].solid_share,
            "{pair:?}"
        );
    }
    assert!(films[0].solid_share == 0.0 && films[3].solid_share > 0.5, "{films:?}");
}

/// The pressure that the bodies bear is the load, who touches is where solids press, and the film is the gap.
#[test]
fn the_fields_of_a_film_belong_together() {
    let contact = at_rest(&parsed(&case(&format!("{OIL}speed = \"20 mm/s\"\n"))));
    let [(point, lubrication)] = &films(&contact)[..] else { panic!("one point") };
    let film = lubrication.film;
    let field =
        |name: &str| contact.fields.fields.iter().find(|field| field.name == name).unwrap().values.clone();
    let (oil, solids, pressure) = (field("oil_pressure"), field("solid_pressure"), field("pressure"));
    let (gap, touches, cavity) = (field("gap"), field("contact"), field("cavity"));
    let area = 11e-6 * 11e-6;
    assert!((area * pressure.sum() / 6.0 - 1.0).abs() < 1e-6);
    assert!(
        (area * solids.sum() / 6.0 - film.solid_share).abs() < 1e-6
            && (0.01..0.9).contains(&film.solid_share)
    );
    assert!((touches.sum() * area / point.contact_area - 1.0).abs() < 1e-12);
    for cell in pressure.indexed_iter().map(|(cell, _)| cell) {
        assert_eq!(oil[cell] + solids[cell], pressure[cell]);
        assert_eq!(touches[cell] > 0.0, solids[cell] > 0.0);
        assert!(solids[cell] == 0.0 || (gap[cell] - 2e-9).abs() < 1e-11, "{}", gap[cell]);
        assert!(oil[cell] == 0.0 || cavity[cell] == 0.0);
    }
    let least = gap.iter().copied().fold(f64::INFINITY, f64::min);
    assert!((least / film.min_film - 1.0).abs() < 1e-12, "{least:e} {:e}", film.min_film);
}

/// ISO VG 46 has 39.7 mPa s and 20.7 1/GPa at 40 °C.
#[test]
fn an_oil_by_its_name_is_that_of_its_numbers() {
    let named =
        "[temperature]\nbulk = [\"30 °C\", \"50 °C\"]\n[lubrication]\noil = \"ISO VG 46\"\nspeed = 0.5\n";
    let numbers = OIL.replace("40 mPa s", "39.7 mPa s").replace("20 1", "20.7 1") + "speed = 0.5\n";
    let [named, numbers] =
        [named, &numbers].map(|oil| films(&at_rest(&parsed(&case(oil))))[0].1.central_film);
    assert!((named / numbers - 1.0).abs() < 2e-3, "{named} {numbers}");
}

/// The pressure of a fluid at one end lifts a body whose approach is prescribed, as Poiseuille's flow says: between rigid
/// parallel faces it falls evenly.
#[test]
fn a_pressure_from_outside_falls_along_the_gap() {
    let text = r#"
[lower]
young = "210 GPa"
poisson = 0.3
topography = { form = "flat", shape = [40, 8], pitch = "10 um" }
[upper]
young = "inf"
poisson = 0.3
topography = { form = "flat" }
[contact]
approach = "-10 um"
boundary = ["free", "periodic"]
[lubrication]
viscosity = "40 mPa s"
law = "constant"
compressible = false
inlet_pressure = "1 MPa"
speed = 0
"#;
    let contact = at_rest(&parsed(text));
    let pressure = &contact.fields.fields.iter().find(|field| field.name == "oil_pressure").unwrap().values;
    for (ix, row) in pressure.outer_iter().enumerate() {
        let expected = 1e6 * (1.0 - (ix as f64 + 0.5) / 40.0);
        assert!(row.iter().all(|p| (p - expected).abs() < 2e3), "{ix}: {row} {expected}");
    }
}

#[test]
fn films_that_are_not_to_be_trusted_are_told() {
    let told = |oil: &str| at_rest(&parsed(&case(oil))).warnings.join("\n");
    let coarse = told(&format!("{OIL}speed = \"10 mm/s\"\n"));
    assert!(coarse.contains("the grid decides who bears the load: at 10 mm/s the solids bear"), "{coarse}");
    let fast = told(&format!("{OIL}speed = \"20 m/s\"\n"));
    assert!(fast.contains("the inlet is too short at 20 m/s, and the film is starved"), "{fast}");
    let plain = OIL.replace("limiting_stress = 0.05\nboundary_friction = 0.12\n", "");
    let dry = told(&format!("{plain}speed = \"1 mm/s\"\n"));
    assert!(dry.contains("give `boundary_friction` in [lubrication]"), "{dry}");
    let sheared = told(&format!("{plain}speed = \"0.5 m/s\"\n"));
    assert!(sheared.contains("under pressure they shear at a limiting stress"), "{sheared}");
    // Nothing is pressed: no contact has an inlet.
    let apart =
        case(&format!("{OIL}speed = \"0.5 m/s\"\n")).replace("load = \"6 N\"", "approach = \"-1 um\"");
    let apart = at_rest(&parsed(&apart));
    assert!(!apart.warnings.join("\n").contains("inlet"), "{:?}", apart.warnings);
    let barus = told(&format!("{OIL}law = \"barus\"\nspeed = \"0.5 m/s\"\n"));
    assert!(barus.contains("Barus' law of viscosity is far too stiff above some 300 MPa"), "{barus}");
}

/// A disc that passes under a ball at rest, with this topography and these keys.
fn passing(disc: &str, keys: &str) -> String {
    format!(
        r#"
[lower]
material = "steel"
hardness = inf
topography = {{ shape = [40, 32], pitch = "13 um", {disc} }}
{keys}
[upper]
material = "steel"
hardness = inf
topography = {{ form = "sphere", radius = "10 mm" }}
[contact]
load = "6 N"
{OIL}[motion]
strategy = "shift"
speed_upper = 0
control = "step-load"
"#
    )
}

const GROUND: &str = r#"generate = "low-pass", sq = "60 nm", cutoff = "78 um""#;

#[test]
fn a_smooth_disc_that_moves_under_a_ball_has_the_steady_film() {
    let steady = case(&format!("{OIL}speed = \"0.2 m/s\"\n"))
        .replace(", plus = [{ generate = \"low-pass\", sq = \"60 nm\", cutoff = \"66 um\" }]", "")
        .replace("shape = [48, 40], pitch = \"11 um\"", "shape = [40, 32], pitch = \"13 um\"");
    let steady = films(&at_rest(&parsed(&steady)))[0].1.film;
    let folder = tempfile::TempDir::new().unwrap();
    let text = passing("form = \"flat\"", "") + "speed_lower = \"0.4 m/s\"\nstride = 5\n";
    let (_, results) = run(&parsed(&text), folder.path());
    let steps = results.steps().unwrap();
    assert_eq!(steps.len(), 8);
    for step in &steps {
        let film = step.film.unwrap();
        assert!((film.mean_film / steady.mean_film - 1.0).abs() < 1e-5, "{film:?} {steady:?}");
        assert!((film.traction_coefficient / steady.traction_coefficient - 1.0).abs() < 1e-5);
        // The disc at 0.4 m/s drags the ball along +x: the ball holds it back.
        assert!((step.tangential_force + film.traction_coefficient * step.load).abs() < 1e-9);
    }
}

#[test]
fn interrupted_passes_of_a_ground_disc_go_on_to_the_same_bits() {
    let text = passing(GROUND, "") + "speed_lower = \"60 mm/s\"\npasses = 3\nstride = 4\n";
    let passes = goes_on(&parsed(&text)).results.passes().unwrap();
    assert_eq!(passes.len(), 3);
    let film = |pass: usize| passes[pass].film.unwrap();
    // From the second pass on the roughness has filled the contact, and passes are alike.
    assert!((film(2).mean_film / film(1).mean_film - 1.0).abs() < 1e-3, "{passes:?}");
    assert!(film(1).solid_share > 0.0 && film(1).min_film < 0.5 * film(1).mean_film);
}

/// Wear acts where solids touch, and only there.
#[test]
fn only_what_the_solids_bear_wears() {
    let lost = |speed: &str| {
        let folder = tempfile::TempDir::new().unwrap();
        let wear = "wear = { coefficient = \"1e-9 mm3/(N m)\" }\n";
        let text = passing(GROUND, wear) + &format!("speed_lower = \"{speed}\"\nstride = 8\n");
        let (_, results) = run(&parsed(&text), folder.path());
        let pass = results.passes().unwrap().remove(0);
        let steps = results.steps().unwrap();
        let borne: f64 = steps.iter().map(|step| step.load * step.film.unwrap().solid_share).sum();
        (pass.lost("wear")[0], 1e-18 * borne * 8.0 * 13e-6)
    };
    assert_eq!(lost("10 m/s").0, 0.0);
    let (worn, expected) = lost("10 mm/s");
    assert!(worn > 0.0 && (worn / expected - 1.0).abs() < 1e-6, "{worn:e} {expected:e}");
}

/// Passes are compared with the limits of their models, as steady films are.
#[test]
fn passes_beyond_their_models_are_told() {
    let told = |speed: &str, edit: [&str; 2]| {
        let folder = tempfile::TempDir::new().unwrap();
        let text = passing(GROUND, "") + &format!("speed_lower = \"{speed}\"\nstride = 20\n");
        let (summary, _) = run(&parsed(&text.replace(edit[0], edit[1])), folder.path());
        summary.warnings.join("\n")
    };
    let mixed = told("20 mm/s", ["boundary_friction = 0.12\n", ""]);
    assert!(mixed.contains("in pass 1 the solids bear") && mixed.contains("depends on the grid"), "{mixed}");
    assert!(mixed.contains("give `boundary_friction` in [lubrication]"), "{mixed}");
    let fast = told("20 m/s", ["limiting_stress = 0.05\n", "law = \"barus\"\n"]);
    for words in ["the inlet is too short in pass 1", "Barus' law", "shear at a limiting stress"] {
        assert!(fast.contains(words), "{words}: {fast}");
    }
    let soft = told("1 m/s", ["hardness = inf", "hardness = \"0.4 GPa\""]);
    assert!(soft.contains("times the hardness, which does not limit it"), "{soft}");
}

/// A short ball that passes over a long plate under an oil, with these keys.
fn over(keys: &str, motion: &str) -> String {
    format!(
        r#"
[lower]
material = "steel"
hardness = inf
topography = {{ form = "flat", shape = [104, 24], pitch = "16 um" }}
[upper]
material = "steel"
hardness = inf
topography = {{ form = "sphere", radius = "10 mm", shape = [32, 24] }}
[contact]
{keys}
[motion]
speed = "0.4 m/s"
stride = 4
{motion}"#
    )
}

/// In an overlap the oil enters ahead of the upper body. Once all of it lies over the lower body, it has the steady film, and
/// on the way back, too.
#[test]
fn a_ball_that_passes_over_a_plate_has_the_steady_film_in_the_middle() {
    let steady = case(&format!("{OIL}speed = \"0.2 m/s\"\n"))
        .replace(", plus = [{ generate = \"low-pass\", sq = \"60 nm\", cutoff = \"66 um\" }]", "")
        .replace("shape = [48, 40], pitch = \"11 um\"", "shape = [32, 24], pitch = \"16 um\"")
        .replace("load = \"6 N\"", "approach = \"0.9 um\"");
    let steady = films(&at_rest(&parsed(&steady)))[0].1.film;
    let folder = tempfile::TempDir::new().unwrap();
    let text = over(&format!("approach = \"0.9 um\"\n{OIL}"), "path = \"reciprocating\"\n");
    let (_, results) = run(&parsed(&text), folder.path());
    let steps = results.steps().unwrap();
    // Each stroke ends with a body that has passed through a whole film.
    let at = |step: &&asperity_contact::motion::StepRecord, offset: f64| {
        (step.offset / 16e-6 - offset).abs() < 1e-6
    };
    let forth = steps.iter().find(|step| at(step, 68.0)).unwrap();
    let back = steps.iter().rfind(|step| at(step, 4.0)).unwrap();
    let middle = [forth, back];
    for step in middle {
        let film = step.film.unwrap();
        assert!((film.mean_film / steady.mean_film - 1.0).abs() < 1e-3, "{film:?} {steady:?}");
        assert!((film.traction_coefficient / steady.traction_coefficient - 1.0).abs() < 1e-3);
    }
    // The lower body is dragged along, forth and back.
    assert!(middle[0].tangential_force > 0.0);
    assert!(
        (middle[0].tangential_force + middle[1].tangential_force).abs() < 1e-3 * middle[0].tangential_force
    );
}

/// The film is the same if the ball stands still and the plate passes over it.
#[test]
fn a_plate_that_passes_over_a_ball_has_the_films_of_the_ball_that_passes_over_the_plate() {
    const BALL: &str =
        "topography = { form = \"sphere\", radius = \"10 mm\", shape = [16, 12], pitch = \"32 um\" }";
    let films = |lower: &str, upper: &str| {
        let folder = tempfile::TempDir::new().unwrap();
        let text = format!(
            "lower = {{ material = \"steel\", {lower} }}\nupper = {{ material = \"steel\", {upper} }}\n\
             contact = {{ load = \"4 N\" }}\nmotion = {{ speed = \"0.4 m/s\", control = \"step-load\" }}\n{OIL}"
        );
        let (_, results) = run(&parsed(&text), folder.path());
        results.steps().unwrap().into_iter().map(|step| step.film.unwrap()).collect::<Vec<_>>()
    };
    for columns in [24, 16] {
        let plate = format!("topography = {{ form = \"flat\", shape = [{columns}, 12], pitch = \"32 um\" }}");
        let (ball_moves, plate_moves) = (films(&plate, BALL), films(BALL, &plate));
        let middle = ball_moves.len() / 2;
        assert!(ball_moves[middle].mean_film > 1e-8, "{:?}", ball_moves[middle]);
        let (one, other) = (ball_moves[middle].mean_film, plate_moves[middle].mean_film);
        assert!((one / other - 1.0).abs() < 1e-6, "{columns}: {one:e} {other:e}");
    }
}

#[test]
fn surfaces_that_roll_have_no_friction_of_their_solids() {
    let of = |sliding: &str| {
        let text = case(&format!("{OIL}speed = \"1 mm/s\"\n{sliding}"))
            .replace(", plus = [{ generate = \"low-pass\", sq = \"60 nm\", cutoff = \"66 um\" }]", "");
        films(&at_rest(&parsed(&text)))[0].1.film
    };
    let (rolling, sliding) = (of("sliding = 0\n"), of(""));
    assert!(rolling.solid_share > 0.5 && rolling.traction_coefficient == 0.0, "{rolling:?}");
    assert!(sliding.traction_coefficient > 0.06, "{sliding:?}");
}

#[test]
fn interrupted_passes_in_an_overlap_bear_their_mean_load_and_go_on_to_the_same_bits() {
    let text = over(
        &format!("load = \"2 N\"\n{OIL}"),
        "passes = 2\n[lower.wear]\ncoefficient = \"1e-7 mm3/(N m)\"\n",
    )
    .replace("shape = [104, 24], pitch = \"16 um\"", "shape = [36, 12], pitch = \"32 um\"")
    .replace("shape = [32, 24]", "shape = [16, 12]")
    .replace("form = \"flat\"", &GROUND.replace("78 um", "160 um"))
    .replace("0.4 m/s", "4 mm/s");
    let passes = goes_on(&parsed(&text)).results.passes().unwrap();
    for pass in &passes {
        assert!((pass.mean_load / 2.0 - 1.0).abs() < 1e-4, "{pass:?}");
    }
    assert!(passes[1].lost("wear")[0] > 0.0 && passes[1].film.unwrap().solid_share > 0.0, "{passes:?}");
}

/// Oil that moves towards −x has the film of oil that moves towards +x under the mirrored bodies.
#[test]
fn a_disc_that_turns_back_drags_the_oil_the_other_way() {
    let films = |mirror: &str, speed: &str| {
        let folder = tempfile::TempDir::new().unwrap();
        let text =
            passing(&format!("{GROUND}{mirror}"), "") + &format!("speed_lower = \"{speed}\"\nstride = 8\n");
        let (_, results) = run(&parsed(&text), folder.path());
        results.steps().unwrap()
    };
    let (forth, back) = (films("", "0.1 m/s"), films(", mirror = \"x\"", "-0.1 m/s"));
    for (forth, back) in forth.iter().zip(&back) {
        let (film, turned) = (forth.film.unwrap(), back.film.unwrap());
        assert!((film.mean_film / turned.mean_film - 1.0).abs() < 1e-6, "{film:?} {turned:?}");
        assert!((forth.tangential_force + back.tangential_force).abs() < 1e-5 * back.tangential_force);
    }
}

/// The stress below is that of oil and solids: of slow bodies that of dry ones with the friction of the solids.
#[test]
fn the_stress_below_a_slow_film_is_that_of_a_dry_contact() {
    let stress = |between: &str, speed: &str| {
        let folder = tempfile::TempDir::new().unwrap();
        let text =
            over(&format!("approach = \"0.5 um\"\n{between}"), "[subsurface]\nto = \"120 um\"\nlayers = 6\n")
                .replace("0.4 m/s", speed)
                .replace("stride = 4", "stride = 17");
        let (summary, _) = run(&parsed(&text), folder.path());
        summary.subsurface.last().unwrap().max_von_mises
    };
    let dry = stress("[friction]\ncoefficient = 0.12\n", "0.4 m/s");
    let slow = stress(OIL, "2 um/s");
    assert!((slow / dry - 1.0).abs() < 0.02, "{slow:e} {dry:e}");
    let fast = stress(OIL, "2 m/s");
    assert!((fast / dry - 1.0).abs() > 0.03, "{fast:e} {dry:e}");
}
