//! Warnings about values beside the quantities that give them their size: a slip of a factor of 1000 is told,
//! and what people compute is not.

use asperity_study::{SurfaceInput, bodies, estimate};

use crate::support::parsed;

const RUBBER: &str = r#"
lower = { young = "1 MPa", poisson = 0.5, topography = { form = "flat", shape = [24, 24], pitch = "10 um" }, viscoelastic = { moduli = ["9 MPa"], times = ["10 ms"] } }
upper = { young = "inf", poisson = 0.3, topography = { form = "sphere", radius = "1 mm" } }
contact = { load = "200 uN" }
"#;
const STEEL: &str = r#"
lower = { material = "steel", topography = { form = "flat", shape = [64, 64], pitch = "2 um" } }
upper = { material = "steel", topography = { form = "sphere", radius = "2 mm" } }
contact = { load = "1 N" }
"#;
const ROUGH: &str = r#"
lower = { material = "steel", topography = { generate = "low-pass", shape = [64, 64], pitch = "1 um", sq = "0.1 um", cutoff = "16 um" } }
upper = { material = "steel", topography = { form = "flat" } }
"#;
const MOVING: &str = r#"
lower = { young = "210 GPa", poisson = 0.3, KEY, topography = { generate = "low-pass", shape = [32, 32], pitch = "1 um", sq = "0.05 um", cutoff = "8 um" } }
upper = { material = "steel", topography = { generate = "low-pass", sq = "0.05 um", cutoff = "8 um", seed = 2 } }
contact = { mean_pressure = "100 MPa", boundary = "periodic" }
motion = { strategy = "shift", passes = 100 }
"#;

/// Returns the warnings about a case that begins with the words of this module.
fn warnings(text: &str) -> Vec<String> {
    let case = parsed(text);
    let found = estimate(&case, &bodies(&case, SurfaceInput::default()).unwrap()).unwrap().warnings;
    let judged = |warning: &String| ["check", "that exists"].iter().any(|end| warning.contains(end));
    found.into_iter().filter(judged).collect()
}

#[test]
fn a_slip_of_a_thousand_is_told_beside_the_quantity_that_gives_a_value_its_size() {
    let stage = |keys: &str| format!("{RUBBER}[[history]]\n{keys}\n");
    let with = |case: &str, tables: &str| format!("{case}{tables}\n");
    let body = |keys: &str, tables: &str| MOVING.replace("KEY", keys) + tables;
    let friction = "friction = { coefficient = 0.3, {} }";
    let mut wrong = Vec::new();
    for (case, values, words) in [
        (stage("dwell = \"{}\""), ["0.1 s", "100 s", "100 us"], ["everything has relaxed long before", "1/100 of the shortest relaxation time, 10 ms"]),
        (stage("load = \"300 uN\"\nduration = \"{}\""), ["10 ms", "", "1 us"], ["", "nothing relaxes meanwhile"]),
        (stage("load = \"300 uN\"\nperiod = \"{}\"\ncycles = 2"), ["50 ms", "50 s", "50 us"], ["relaxed throughout", "nothing relaxes in a cycle"]),
        (stage("dwell = \"50 ms\"").replace("9 MPa", "{}"), ["9 MPa", "9 GPa", "9 kPa"], ["is 9 GPa, 9000 times Young's modulus of the body, 1 MPa", "their relaxation changes nothing"]),
        (stage("dwell = \"50 ms\"").replace("200 uN", "{}"), ["200 uN", "200 mN", ""], ["the theory holds up to 0.1", ""]),
        (with(STEEL, &friction.replace("{}", "force = \"{}\"")), ["0.1 N", "", "100 uN"], ["", "1/3000 of the largest friction force, 300 mN: the whole contact sticks"]),
        (with(STEEL, &friction.replace("{}", "displacement = \"{}\"")), ["0.1 um", "100 um", ""], ["0.8 times the longer side of the grid, 128 µm", ""]),
        (with(STEEL, "adhesion = { work = \"50 mJ/m2\", range = \"{}\" }"), ["0.1 um", "100 um", ""], ["the attraction ends at the rim", ""]),
        (with(STEEL, "subsurface = { to = \"{}\" }"), ["20 um", "20 mm", "20 nm"], ["does not reach so deep", "1/100 of a cell, 2 µm"]),
        (STEEL.replace("\"steel\", topography = { form = \"sphere\"", "\"steel\", coating = { thickness = \"{}\", young = \"100 GPa\", poisson = 0.3 }, topography = { form = \"sphere\""), ["3 um", "3 mm", ""], ["contacts do not feel the body under it", ""]),
        (with(ROUGH, "contact = { mean_pressure = \"{}\", boundary = \"periodic\" }"), ["200 MPa", "200 GPa", "200 kPa"], ["the contact is complete", "hardly a cell is in contact"]),
        (with(ROUGH, "contact = { mean_pressures = { from = \"{}\", to = \"300 GPa\", points = 3 } }"), ["200 MPa", "200 GPa", ""], ["the contact is complete", ""]),
        (with(ROUGH, "contact = { mean_pressure = \"200 MPa\", boundary = \"periodic\" }\nflow = { viscosity = \"1 mPa s\", pressure = \"{}\" }"), ["10 bar", "10000 bar", ""], ["the fluid lifts the bodies", ""]),
        (body("hardness = \"7 GPa\", wear = { coefficient = \"{}\" }", ""), ["1e-5 mm3/(N m)", "1e-2 mm3/(N m)", "1e-10 mm3/(N m)"], ["the wear of the lower body over a distance of 3.2 mm is 3.2 µm deep", "at most 2.24 pm deep, which is nothing"]),
        (body("wear = { coefficient = \"1e-8 mm3/(N m)\" }", "acceleration = { max_wear = \"{}\" }"), ["10 nm", "10 um", "10 pm"], ["wears the surfaces off", "1/5 of the least that exists"]),
        (body("fatigue = { torsion = \"500 MPa\", tension = \"{}\" }", "fatigue = { to = \"8 um\" }"), ["800 MPa", "", "0.8 MPa"], ["", "no material bears more torsion than tension"]),
        (body("fatigue = { torsion = \"500 MPa\", tension = \"800 MPa\", pit_depth = \"{}\" }", "fatigue = { to = \"8 um\" }"), ["5 um", "5 mm", "5 nm"], ["does not reach so deep", "nothing lies between it and the surface"]),
    ] {
        for (value, words) in values.iter().zip([Some(""), Some(words[0]), Some(words[1])]) {
            let (text, words) = (case.replace("{}", value), words.unwrap());
            let found = if value.is_empty() { Vec::new() } else { warnings(&text) };
            let is_right = match words { "" => found.is_empty(), words => found.iter().any(|warning| warning.contains(words)) };
            if !is_right {
                wrong.push(format!("{value}: {words}: {found:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
#[test]
fn what_people_compute_needs_no_word() {
    let pair = |lower: &str, upper: &str, rest: &str| {
        format!("lower = {{ {lower} }}\nupper = {{ {upper} }}\n{rest}\n")
    };
    let rough = |seed: u32, rest: &str| {
        format!("topography = {{ generate = \"self-affine\", hurst = 0.8, seed = {seed}, {rest} }}")
    };
    let flat =
        |pitch: &str| format!("topography = {{ form = \"flat\", shape = [64, 64], pitch = \"{pitch}\" }}");
    let ball = |radius: &str| format!("topography = {{ form = \"sphere\", radius = \"{radius}\" }}");
    let gold = |seed, shape: &str| {
        format!(
            "material = \"gold\", hardness = \"1.2 GPa\", {}",
            rough(seed, &format!("{shape}sq = \"2 nm\", rolloff = \"120 nm\", shortest = \"24 nm\""))
        )
    };
    for text in [
        // A switch, a wheel on its rail, a tip, a bead on rubber, a ball in oil.
        pair(
            &gold(1, "shape = [64, 64], pitch = \"4 nm\", "),
            &gold(2, ""),
            "contact = { mean_pressure = \"20 MPa\", boundary = \"periodic\" }\nconductance = { kind = \"electrical\", drop = \"0.1 V\" }",
        ),
        pair(
            &format!(
                "young = \"206 GPa\", poisson = 0.28, hardness = \"3 GPa\", wear = {{ coefficient = \"1e-5 mm3/(N m)\" }}, {}",
                flat("0.4 mm")
            ),
            &format!("young = \"206 GPa\", poisson = 0.28, hardness = \"3 GPa\", {}", ball("460 mm")),
            "contact = { load = \"80 kN\" }\nfriction = { coefficient = 0.3 }\nsliding = { distance = \"100 m\", speed = \"10 mm/s\" }",
        ),
        pair(
            &format!("young = \"400 GPa\", poisson = 0.25, {}", flat("0.5 nm")),
            &format!("material = \"diamond\", {}", ball("200 nm")),
            "contact = { load = \"0.5 uN\" }",
        ),
        pair(
            &format!("young = \"2 MPa\", poisson = 0.5, {}", flat("10 um")),
            &format!("material = \"glass\", {}", ball("1 mm")),
            "contact = { load = \"20 uN\" }",
        ),
        pair(
            &format!("material = \"steel\", {}", flat("2 um")),
            &format!("material = \"silicon-nitride\", {}", ball("6 mm")),
            "contact = { load = \"10 N\" }",
        ),
        // Glass is no harder than glass beside steel, nor beside rubber.
        pair(
            &format!("material = \"steel\", {}", flat("2 um")),
            &format!("material = \"glass\", {}", ball("1 mm")),
            "contact = { load = \"1 mN\" }",
        ),
    ] {
        assert_eq!(warnings(&text), [""; 0], "{text}");
    }
}
