//! Viscoelastic bodies under a history: creep, relaxation, resuming.

use std::fs;

use asperity_study::{Case, Outcome, SurfaceInput};

use crate::resume::goes_on;
use crate::support::{at_rest, parsed, parsed_in, run};

const CASE: &str = r#"
[lower]
young = "1 MPa"
poisson = 0.5
topography = { form = "flat", shape = [32, 32], pitch = "20 um" }
viscoelastic = { moduli = ["9 MPa", "2 MPa"], times = ["0.1 s", "1 s"] }
[upper]
young = "inf"
poisson = 0.3
topography = { form = "sphere", radius = "1 mm" }
[contact]
load = "5 mN"
[[history]]
dwell = "200 s"
increments = 12
[[history]]
approach = "22 um"
duration = "0.1 s"
increments = 2
[[history]]
dwell = "200 s"
increments = 12
"#;

#[test]
fn an_interrupted_history_goes_on_to_the_same_bits_and_has_its_times() {
    let increments = goes_on(&parsed(CASE)).results.increments().unwrap();
    let time = |index: usize| increments[index].creep.unwrap().time;
    assert_eq!(increments.len(), 1 + 12 + 2 + 12);
    assert!(time(0) == 0.0 && (time(12) - 200.0).abs() < 1e-9 && (time(26) - 400.1).abs() < 1e-9);
    assert!(increments[12].approach > 4.0 * increments[0].approach);
    assert!(increments[14].load > increments[26].load && increments[26].load > increments[12].load);
}

/// The drag over the load of the first point.
fn drag_of(points: &Outcome) -> f64 {
    let Outcome::Sweep(points) = points else { panic!("a sweep over speeds") };
    points[0].steady.unwrap().drag_coefficient
}

#[test]
fn a_warm_body_slides_as_a_cold_one_does_slower() {
    let text = |shift: &str, speed: f64| {
        format!(
            r#"
temperature = {{ bulk = "40 °C" }}
contact = {{ mean_pressure = "50 kPa", boundary = "periodic" }}
steady = {{ speed = {speed} }}
[lower]
young = "1 MPa"
poisson = 0.5
topography = {{ form = "flat", shape = [32, 32], pitch = "10 um" }}
viscoelastic = {{ moduli = ["9 MPa"], times = ["0.1 s"], {shift} }}
[upper]
young = "inf"
poisson = 0.3
topography = {{ generate = "self-affine", sdq = 0.1, hurst = 0.8, shortest = "80 um" }}
"#
        )
    };
    let drag = |text: &str| drag_of(&at_rest(&parsed(text)).outcome);
    // Williams, Landel and Ferry: log₁₀ a_T = −8.9 · 20/(102 + 20).
    let factor = 10f64.powf(-8.9 * 20.0 / 122.0);
    let warm = drag(&text("wlf_c1 = 8.9, wlf_c2 = \"102 K\", wlf_at = \"20 °C\"", 1e-3 / factor));
    let shifted =
        text(&format!("shift = {factor}"), 1e-3 / factor).replace("temperature = { bulk = \"40 °C\" }", "");
    let cold = text("shift = 1.0", 1e-3).replace("temperature = { bulk = \"40 °C\" }", "");
    assert!((warm / drag(&shifted) - 1.0).abs() < 1e-9 && (warm / drag(&cold) - 1.0).abs() < 1e-9, "{warm}");
}

/// A sphere on rubber under a load, with what a test adds.
fn case(history: &str, body: &str) -> Case {
    parsed(&format!(
        r#"
contact = {{ load = "1 mN" }}
{history}
[lower]
young = "1 MPa"
poisson = 0.5
topography = {{ form = "flat", shape = [24, 24], pitch = "10 um" }}
viscoelastic = {{ moduli = ["9 MPa"], times = ["10 ms"]{body} }}
[upper]
young = "inf"
poisson = 0.3
topography = {{ form = "sphere", radius = "1 mm" }}
"#
    ))
}

#[test]
fn a_stage_in_time_has_enough_steps_unless_it_is_given_fewer_which_is_told() {
    let increments = |history: &str| {
        let rest = at_rest(&case(history, ""));
        let told = rest.warnings.iter().any(|warning| warning.contains("in a step"));
        (rest.increments, told)
    };
    let (dwell, told) = increments(r#"history = [{ dwell = "50 ms" }]"#);
    assert!(dwell.len() == 17 && !told);
    let (both, told) = increments(r#"history = [{ load = "2 mN", duration = "5 ms", dwell = "50 ms" }]"#);
    assert!(both.len() == 33 && !told);
    let (sudden, told) = increments(r#"history = [{ load = "2 mN", dwell = "50 ms" }]"#);
    assert!(sudden.len() == 18 && !told);
    let (coarse, told) = increments(r#"history = [{ dwell = "50 ms", increments = 1 }]"#);
    assert!(coarse.len() == 2 && told);
}

#[test]
fn a_cycle_is_a_stage_there_and_one_back_in_half_of_its_period() {
    let loads = |history: &str| {
        let rest = at_rest(&case(history, ""));
        rest.increments
            .iter()
            .map(|row| [row.creep.unwrap().time, row.load, row.approach])
            .collect::<Vec<_>>()
    };
    let cycles = loads(r#"history = [{ load = "2 mN", cycles = 2, period = "20 ms", increments = 8 }]"#);
    let there = r#"{ load = "2 mN", duration = "10 ms", increments = 8 }"#;
    let back = r#"{ load = "1 mN", duration = "10 ms", increments = 8 }"#;
    let stages = loads(&format!("history = [{there}, {back}, {there}, {back}]"));
    assert!(cycles.len() == 33 && stages.len() == 33);
    for (one, other) in cycles.iter().flatten().zip(stages.iter().flatten()) {
        assert!((one - other).abs() <= 1e-7 * other.abs(), "{one} {other}");
    }
    // The second cycle begins deeper than the first one, and loses energy.
    assert!(cycles[16][2] > cycles[0][2]);
    let work: f64 =
        cycles[16..].windows(2).map(|pair| 0.5 * (pair[0][1] + pair[1][1]) * (pair[1][2] - pair[0][2])).sum();
    assert!(work > 0.0, "{work}");
}

#[test]
fn the_shift_of_williams_landel_and_ferry_has_its_temperatures() {
    let body = r#", wlf_c1 = 8.86, wlf_c2 = "101.6 K", wlf_at = "50 °C""#;
    let found = |bulk: &str| {
        let steady = format!("steady = {{ speed = \"10 mm/s\" }}\ntemperature = {{ bulk = \"{bulk}\" }}");
        asperity_study::static_contact(&case(&steady, body), SurfaceInput::default(), &())
            .map(|rest| rest.warnings.iter().any(|warning| warning.contains("Williams, Landel and Ferry")))
    };
    for (bulk, told) in [("50 °C", false), ("20 °C", false), ("-20 °C", true), ("200 °C", true)] {
        assert_eq!(found(bulk).unwrap(), told, "{bulk}");
    }
    // Tᵣ − c₂ is −51.6 °C. Just above it no number holds the times.
    for bulk in ["-51 °C", "-51.6 °C", "-60 °C"] {
        let error = found(bulk).unwrap_err().to_string();
        assert!(error.contains("bulk") && error.contains("Tᵣ − c₂"), "{bulk}: {error}");
    }
}

#[test]
fn passes_become_steady_sliding_and_tell_where_their_steps_are_long() {
    let text = |tables: &str| {
        format!(
            r#"
contact = {{ mean_pressure = "50 kPa", boundary = "periodic" }}
{tables}
[lower]
young = "1 MPa"
poisson = 0.5
topography = {{ form = "flat", shape = [128, 32], pitch = "0.5 um" }}
viscoelastic = {{ moduli = ["9 MPa"], times = ["2 us"] }}
[upper]
young = "inf"
poisson = 0.3
topography = {{ generate = "self-affine", sdq = 0.1, hurst = 0.8, shortest = "16 um" }}
"#
        )
    };
    let steady = drag_of(&at_rest(&parsed(&text("steady = { speed = \"1 m/s\" }"))).outcome);
    let passes = |stride: usize| {
        let folder = tempfile::tempdir().unwrap();
        let keys = format!("passes = 3, strategy = \"shift\", speed_upper = \"1 m/s\", stride = {stride}");
        let (summary, _) = run(&parsed(&text(&format!("motion = {{ {keys} }}"))), folder.path());
        let Outcome::Passes(passes) = &summary.outcome else { panic!() };
        let told = summary.warnings.iter().any(|warning| warning.contains("their widest spot of contact"));
        (passes[2].drag.unwrap().drag_coefficient / steady - 1.0, told)
    };
    let (fine, coarse) = (passes(1), passes(8));
    assert!(fine.0.abs() < 0.05 && !fine.1, "{fine:?}");
    assert!((-0.4..-0.05).contains(&coarse.0) && coarse.1, "{coarse:?}");
}

#[test]
fn a_master_curve_is_doubted_beyond_its_frequencies_and_where_its_fit_is_poor() {
    const FINE: &str = "terms_per_decade = 4";
    let folder = tempfile::tempdir().unwrap();
    // A body with E₀ = 1 MPa, and 9 MPa that relax in 0.1 s.
    let points = (0..=30).map(|n| 10f64.powf(-1.0 + 0.1 * f64::from(n))).map(|frequency| {
        let z = std::f64::consts::TAU * frequency * 0.1;
        let [storage, loss] = [1.0 + 9.0 * z * z / (1.0 + z * z), 9.0 * z / (1.0 + z * z)];
        format!("{frequency}, {storage}, {loss}\n")
    });
    let curve = format!("frequency_Hz, storage_MPa, loss_MPa\n{}", points.collect::<String>());
    fs::write(folder.path().join("master.csv"), curve).unwrap();
    let told = |young: &str, more: &str, speeds: &str| {
        let text = format!(
            r#"
contact = {{ mean_pressure = "50 kPa", boundary = "periodic" }}
steady = {{ speeds = {speeds} }}
[lower]
young = "{young}"
poisson = 0.5
topography = {{ form = "flat", shape = [32, 32], pitch = "10 um" }}
viscoelastic = {{ file = "master.csv", {more} }}
[upper]
young = "inf"
poisson = 0.3
topography = {{ generate = "self-affine", sdq = 0.1, hurst = 0.8, shortest = "80 um" }}
"#
        );
        let mut warnings = at_rest(&parsed_in(&text, folder.path())).warnings;
        warnings.retain(|warning| warning.contains("master curve"));
        warnings.join("; ")
    };
    assert_eq!(told("1 MPa", FINE, r#"["1 mm/s", "10 mm/s"]"#), "");
    assert!(told("1 MPa", FINE, r#"["1 mm/s", "1 m/s"]"#).contains("its master curve ends at 100 Hz"));
    // The same speed of a warm body, whose times are shorter.
    assert_eq!(told("1 MPa", "terms_per_decade = 4, shift = 0.01", r#"["1 m/s"]"#), "");
    // At 0.1 Hz it has relaxed to 1.04 MPa.
    assert_eq!(told("1 MPa", FINE, r#"["1 um/s"]"#), "");
    assert!(told("0.5 MPa", FINE, r#"["1 um/s"]"#).contains("its master curve begins at 0.1 Hz"));
    let poor = told("1 MPa", "terms_per_decade = 1", r#"["1 mm/s"]"#);
    assert!(poor.contains("more `terms_per_decade` help"), "{poor}");
}

#[test]
fn a_master_curve_of_shear_moduli_is_turned_into_that_of_tension_which_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let answer = |names: &str, scale: f64| {
        let rows = (0..=20).map(|n| 10f64.powf(-1.0 + 0.2 * f64::from(n))).map(|frequency| {
            let z = std::f64::consts::TAU * frequency * 0.1;
            let [storage, loss] = [1.0 + 9.0 * z * z / (1.0 + z * z), 9.0 * z / (1.0 + z * z)];
            format!("{frequency}, {}, {}\n", storage / scale, loss / scale)
        });
        fs::write(folder.path().join("curve.txt"), format!("f (Hz), {names}\n{}", rows.collect::<String>()))
            .unwrap();
        let text = r#"
contact = { mean_pressure = "50 kPa", boundary = "periodic" }
steady = { speed = "10 mm/s" }
[lower]
young = "1 MPa"
poisson = 0.4
topography = { form = "flat", shape = [32, 32], pitch = "10 um" }
viscoelastic = { file = "curve.txt" }
[upper]
young = "inf"
poisson = 0.3
topography = { generate = "self-affine", hurst = 0.8, shortest = "80 um", sdq = 0.1 }
"#;
        let rest = at_rest(&parsed_in(text, folder.path()));
        let told =
            rest.warnings.iter().any(|warning| warning.contains("multiplied by E/G = 2 (1 + ν) = 2.8"));
        (drag_of(&rest.outcome), told)
    };
    let (tension, shear) = (answer("E' (MPa), E'' (MPa)", 1.0), answer("G' (MPa), G'' (MPa)", 2.8));
    assert!((shear.0 / tension.0 - 1.0).abs() < 1e-5, "{shear:?} {tension:?}");
    assert!(!tension.1 && shear.1);
}

/// A ball that slides over a lower body with these keys.
fn sliding_ball(lower: &str) -> String {
    format!(
        r#"
contact = {{ load = "20 mN", boundary = "periodic" }}
steady = {{ speed = "20 mm/s" }}
[upper]
young = "inf"
poisson = 0.3
topography = {{ form = "sphere", radius = "1 mm" }}
[lower]
topography = {{ form = "flat", shape = [48, 48], pitch = "20 um" }}
{lower}
"#
    )
}

#[test]
fn layers_that_relax_alike_are_the_body_and_on_steel_they_resist_less() {
    let rubber = "young = \"1 MPa\"\npoisson = 0.45\nviscoelastic = { moduli = [\"9 MPa\", \"90 MPa\"], times = [\"10 ms\", \"0.2 ms\"] }\n";
    let layer = |thickness: &str| format!("[[lower.layers]]\nthickness = \"{thickness}\"\n{rubber}");
    let drag = |lower: &str| drag_of(&at_rest(&parsed(&sliding_ball(lower))).outcome);
    let body = drag(rubber);
    let alike = drag(&format!("{rubber}{}{}", layer("50 um"), layer("0.1 mm")));
    assert!((alike / body - 1.0).abs() < 1e-9, "{alike} and {body}");
    let on_steel = |thickness| drag(&format!("material = \"steel\"\nhardness = inf\n{}", layer(thickness)));
    let [thin, thick] = [on_steel("50 um"), on_steel("5 mm")];
    assert!(0.0 < thin && thin < 0.9 * body && (thick / body - 1.0).abs() < 1e-2, "{thin}, {thick}, {body}");
    // A single layer is a coating.
    let coating = format!("base = \"rigid\"\n[lower.coating]\nthickness = \"50 um\"\n{rubber}");
    assert!((drag(&coating) / thin - 1.0).abs() < 1e-3);
    let single = format!("base = \"rigid\"\n{}", layer("50 um"));
    let [coating, single] =
        [coating, single].map(|lower| serde_json::to_value(parsed(&sliding_ball(&lower))).unwrap());
    assert_eq!(coating["lower"], single["lower"]);
    assert_eq!(coating["lower"]["coating"]["viscoelastic"]["times"], serde_json::json!([1e-2, 2e-4]));
}

#[test]
fn a_layer_has_its_own_master_curve_which_is_named_where_it_lies() {
    let folder = tempfile::tempdir().unwrap();
    let rubber = "young = \"1 MPa\"\npoisson = 0.45\nviscoelastic = { file = \"master.csv\" }\n";
    let case = |lower: &str| parsed_in(&sliding_ball(lower), folder.path());
    let layered = case(&format!(
        "{rubber}[[lower.layers]]\nthickness = \"80 um\"\nyoung = \"1 MPa\"\npoisson = 0.45\n\
         viscoelastic = {{ moduli = [\"9 MPa\"], times = [\"1 ms\"] }}\n[[lower.layers]]\nthickness = \"50 um\"\n{rubber}"
    ));
    let missing = asperity_study::bodies(&layered, SurfaceInput::default()).unwrap_err();
    let asperity_base::Error::Case(missing) = missing else { panic!("{missing}") };
    assert_eq!(missing.key, "lower.layers.1.viscoelastic.file");
    // 1 MPa + 9 MPa z/(1 + z), z = iω · 1 ms, in shear.
    let mut text = "f_Hz, G'_Pa, G''_Pa\n".to_owned();
    for n in 0..=40 {
        let frequency = 10f64.powf(-1.0 + 0.125 * f64::from(n));
        let z = std::f64::consts::TAU * frequency * 1e-3;
        let [storage, loss] = [1e6 + 9e6 * z * z / (1.0 + z * z), 9e6 * z / (1.0 + z * z)];
        text += &format!("{frequency:e}, {:e}, {:e}\n", storage / 2.9, loss / 2.9);
    }
    fs::write(folder.path().join("master.csv"), text).unwrap();
    let found = at_rest(&layered);
    let told = |part: &str| {
        let start = format!("the master curve of the {part} has the shear moduli");
        found.warnings.iter().any(|warning| warning.starts_with(&start))
    };
    assert!(told("lower body") && told("2nd layer of the lower body"), "{:?}", found.warnings);
    assert_eq!(layered.files().count(), 2);
    // The fit to a single time is off by some per cent.
    let [found, body] = [drag_of(&found.outcome), drag_of(&at_rest(&case(rubber)).outcome)];
    assert!((found / body - 1.0).abs() < 0.05 && found != body, "{found} for {body}");
}
