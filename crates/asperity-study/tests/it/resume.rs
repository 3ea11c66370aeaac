//! Motions that go on after an interruption, or from the surfaces of a pass.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use asperity_contact::motion::PassRecord;
use asperity_study::io::fields::Fields;
use asperity_study::{Case, Existing, Results, SurfaceInput};
use tempfile::TempDir;

/// Two rough steel surfaces of 32 × 32 cells that yield a little.
fn moving(passes: usize, keys: &str) -> String {
    let body = |name: &str, seed: usize| {
        format!(
            "{name} = {{ young = \"210 GPa\", poisson = 0.3, hardness = \"4 GPa\", topography = {{ \
             generate = \"low-pass\", shape = [32, 32], pitch = \"1 um\", sq = \"35 nm\", cutoff = \"8 um\", \
             seed = {seed} }} }}\n"
        )
    };
    format!(
        "{}{}contact = {{ load = \"20 mN\" }}\n\
         motion = {{ passes = {passes}, stride = 4, {keys} }}\noutput = {{ pressure_every = 4 }}\n",
        body("lower", 1),
        body("upper", 2)
    )
}

const TOLERANCE: &str = "load_tolerance = 1e-6";
const SHIFT: &str = "strategy = \"shift\", speed_lower = 0.0, speed_upper = 1.0";

fn run(folder: &TempDir, case: &str, out: &str, existing: Existing) -> Results {
    let case = Case::parse(case, Path::new("case.toml"), folder.path()).unwrap();
    let out = folder.path().join(out);
    asperity_study::run(&case, SurfaceInput::default(), &out, existing, &()).unwrap();
    Results::open(&out).unwrap()
}

fn on_threads<R: Send>(threads: usize, task: impl FnOnce() -> R + Send) -> R {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(task)
}

/// The passes without their times, and the content of the tables and fields.
fn content(results: &Results) -> (Vec<PassRecord>, BTreeMap<String, Vec<u8>>) {
    let mut passes = results.passes().unwrap();
    passes.iter_mut().for_each(|pass| pass.wall_time_s = 0.0);
    let mut files =
        BTreeMap::from([("steps".to_owned(), fs::read(results.directory().join("steps.csv")).unwrap())]);
    for entry in fs::read_dir(results.directory().join("fields")).unwrap() {
        let path = entry.unwrap().path();
        files.insert(path.file_name().unwrap().to_str().unwrap().to_owned(), fs::read(&path).unwrap());
    }
    (passes, files)
}

#[track_caller]
fn assert_same(found: &Results, expected: &Results, what: &str) {
    let (found_passes, found) = content(found);
    let (passes, expected) = content(expected);
    assert_eq!(found_passes, passes, "{what}");
    assert_eq!(found.keys().collect::<Vec<_>>(), expected.keys().collect::<Vec<_>>(), "{what}");
    for (name, bytes) in expected {
        assert!(found[&name] == bytes, "{what}: {name} differs");
    }
}

#[test]
fn every_motion_goes_on_with_the_same_bits() {
    let shift_with_friction = "friction = { coefficient = 0.3, junction_growth = 9.0 }\n";
    let cases = [
        ("control = \"step-load\"", ""),
        ("plastic_update = \"step\"", ""),
        ("control = \"step-load\", plastic_update = \"step\"", "friction = { coefficient = 0.3 }\n"),
        (SHIFT, shift_with_friction),
    ];
    for (keys, tables) in cases {
        let case =
            |passes| moving(passes, &format!("{keys}, {TOLERANCE}")).replace("20 mN", "10 mN") + tables;
        let folder = tempfile::tempdir().unwrap();
        let whole = run(&folder, &case(3), "whole", Existing::Keep);
        run(&folder, &case(1), "parts", Existing::Keep);
        run(&folder, &case(2), "parts", Existing::Resume);
        let parts = on_threads(1, || run(&folder, &case(3), "parts", Existing::Resume));
        assert_same(&parts, &whole, keys);
    }
}

#[test]
fn passes_of_viscoelastic_bodies_go_on_with_the_same_bits() {
    let shift = format!("{SHIFT}, control = \"step-load\", stride = 2");
    for (keys, boundary) in [(&*shift, "periodic"), ("speed = 1, pause = \"1 us\", stride = 4", "free")] {
        let case = |passes: usize| {
            format!(
                r#"
lower = {{ young = "1 MPa", poisson = 0.5, viscoelastic = {{ moduli = ["9 MPa"], times = ["10 us"] }}, topography = {{ form = "flat" }} }}
upper = {{ young = "inf", poisson = 0.3, topography = {{ generate = "low-pass", shape = [24, 24], pitch = "1 um", sq = "0.2 um", cutoff = "8 um" }} }}
contact = {{ mean_pressure = "50 kPa", boundary = "{boundary}" }}
motion = {{ passes = {passes}, {keys} }}
"#
            )
        };
        let folder = tempfile::tempdir().unwrap();
        let whole = run(&folder, &case(3), "whole", Existing::Keep);
        run(&folder, &case(1), "parts", Existing::Keep);
        run(&folder, &case(2), "parts", Existing::Resume);
        let parts = on_threads(1, || run(&folder, &case(3), "parts", Existing::Resume));
        assert_same(&parts, &whole, keys);
        let drag = whole.passes().unwrap()[2].drag.unwrap();
        assert!(drag.drag_coefficient > 1e-3, "{keys}: {drag:?}");
    }
}

/// Elasto-plastic bodies that wear, warm up, break out and meet a body with a hardness; and a hardness at each position beside wear
/// and heat.
#[test]
fn yielding_bodies_that_wear_and_warm_up_go_on_with_the_same_bits() {
    let heat = r#"conductivity = "46 W/(m K)", heat_capacity = "460 J/(kg K)", density = "7850 kg/m3""#;
    let wear = r#"wear = { coefficient = 1e-14 }"#;
    let flows = format!(r#"{heat}, {wear}, plasticity = {{ yield_stress = "1.5 GPa" }}"#);
    let pits = r#", fatigue = { torsion = "80 MPa", tension = "110 MPa", pit_depth = "6 um" }"#;
    let volume = "plasticity = { depth = \"40 um\", layers = 6 }\nfatigue = { to = \"12 um\" }\n";
    let cases = [
        (format!("{flows}{pits}"), heat.to_owned(), "", volume.to_owned()),
        (flows, format!("{heat}, hardness = \"3 GPa\""), "", volume.replace("fatigue", "#")),
        (
            format!("{heat}, {wear}, hardness = \"3 GPa\""),
            heat.to_owned(),
            ", plastic_update = \"step\"",
            String::new(),
        ),
    ];
    for (lower, upper, keys, tables) in cases {
        let case = |passes: usize| {
            format!(
                r#"
lower = {{ young = "210 GPa", poisson = 0.3, {lower}, topography = {{ form = "flat", shape = [24, 12], pitch = "5 um" }} }}
upper = {{ young = "210 GPa", poisson = 0.3, {upper}, topography = {{ form = "sphere", radius = "0.5 mm" }} }}
contact = {{ load = "5 N", boundary = "periodic" }}
friction = {{ coefficient = 0.1 }}
temperature = {{ bulk = "20 °C" }}
motion = {{ strategy = "shift", passes = {passes}, stride = 3, speed_upper = "1 m/s"{keys} }}
{tables}"#
            )
        };
        let folder = tempfile::tempdir().unwrap();
        let whole = run(&folder, &case(3), "whole", Existing::Keep);
        run(&folder, &case(1), "parts", Existing::Keep);
        run(&folder, &case(2), "parts", Existing::Resume);
        let parts = on_threads(1, || run(&folder, &case(3), "parts", Existing::Resume));
        assert_same(&parts, &whole, &lower);
        let running = whole.passes().unwrap()[2].running.unwrap();
        assert!(
            running.max_flash_temperature > 300.0 && running.laws.deepest_wear_lower > 1e-9,
            "{running:?}"
        );
    }
}

#[test]
fn dissimilar_bodies_slide_alike_on_any_number_of_threads_and_after_a_break() {
    let case = |passes| {
        moving(passes, TOLERANCE).replacen("210 GPa", "70 GPa", 1) + "friction = { coefficient = 0.3 }\n"
    };
    let folder = tempfile::tempdir().unwrap();
    let two = on_threads(2, || run(&folder, &case(2), "two", Existing::Keep));
    let one = on_threads(1, || run(&folder, &case(2), "one", Existing::Keep));
    assert_same(&one, &two, "threads");
    run(&folder, &case(1), "parts", Existing::Keep);
    assert_same(&run(&folder, &case(2), "parts", Existing::Resume), &one, "a break");
}

#[test]
fn a_run_from_the_surfaces_of_a_pass_does_what_the_next_pass_did() {
    for keys in [String::new(), format!("{SHIFT}, ")] {
        let motion = moving(3, &format!("{keys}load_tolerance = 1e-9"));
        let folder = tempfile::tempdir().unwrap();
        let whole = run(&folder, &motion, "whole", Existing::Keep);
        // The body's material stays; its surface is that of the results.
        let mut next = motion.replace("passes = 3", "passes = 1");
        for name in ["lower", "upper"] {
            let start = next.find(&format!("{name} = {{")).unwrap();
            let start = start + next[start..].find("topography = {").unwrap();
            let end = start + next[start..].find("} }").unwrap();
            let source =
                format!("topography = {{ file = \"whole/fields/pass-0002.h5\", channel = \"{name}\" ");
            next.replace_range(start..end, &source);
        }
        let next = run(&folder, &next, "next", Existing::Keep);
        let [found, expected] = [&next, &whole].map(|results| results.passes().unwrap().pop().unwrap());
        for (found, expected) in [
            (found.approach, expected.approach),
            (found.mean_load, expected.mean_load),
            (found.mean_contact_area, expected.mean_contact_area),
            (found.max_pressure, expected.max_pressure),
        ] {
            // Both are solved to η < 10⁻⁶, from different guesses.
            assert!((found / expected - 1.0).abs() < 1e-5, "{found} is not {expected}");
        }
        let fields = |results: &Results, pass: usize| {
            Fields::open(&results.directory().join(format!("fields/pass-{pass:04}.h5"))).unwrap()
        };
        let (whole, next) = (fields(&whole, 3), fields(&next, 1));
        for name in ["lower", "upper"] {
            let [found, expected] = [&next, &whole].map(|fields| fields.read(name).unwrap().values);
            for (found, expected) in found.iter().zip(&expected) {
                assert!((found - expected).abs() < 1e-13, "{name}: {found:e} is not {expected:e}");
            }
        }
    }
}

#[test]
fn a_finished_contact_that_is_resumed_has_the_same_bytes() {
    let rubber = "viscoelastic = { moduli = [\"9 MPa\", \"90 MPa\"], times = [\"10 ms\", \"0.2 ms\"] }";
    let wear = "wear = { coefficient = \"1e-6 mm3/(N m)\" }";
    let load = "contact = { load = \"2 mN\" }\n";
    let rubbing = "friction = { coefficient = 0.3 }\n";
    for (lower, keys) in [
        (
            rubber,
            "contact = { mean_pressure = \"50 kPa\", boundary = \"periodic\" }\nsteady = { speeds = { from = \"1 mm/s\", to = \"1 m/s\", points = 4 } }",
        ),
        (
            rubber,
            &format!(
                "{load}[[history]]\nload = \"4 mN\"\nduration = \"5 ms\"\n[[history]]\ndwell = \"20 ms\""
            ),
        ),
        ("", "contact = { loads = { from = \"1 mN\", to = \"100 mN\", points = 3 } }"),
        ("", "contact = { approaches = { from = \"1 nm\", to = \"20 nm\", points = 3 } }"),
        (
            "",
            "contact = { loads = [\"1 mN\", \"5 mN\"] }\nadhesion = { work = \"50 mJ/m2\", range = \"grid\" }",
        ),
        ("", &format!("{load}friction = {{ coefficient = 0.3, creepages = [0.0001, 0.001, 0.01] }}")),
        (wear, &format!("{load}{rubbing}sliding = {{ distance = \"1 m\", updates = 3 }}")),
        (wear, &format!("{load}{rubbing}[[history]]\nforce = \"0.2 mN\"\nincrements = 3\ncycles = 2")),
    ] {
        let case = format!(
            r#"
lower = {{ young = "1 MPa", poisson = 0.5, {lower}{comma}topography = {{ form = "flat", shape = [16, 16], pitch = "10 um" }} }}
upper = {{ young = "1 GPa", poisson = 0.3, topography = {{ form = "sphere", radius = "5 mm" }} }}
{keys}
"#,
            comma = if lower.is_empty() { "" } else { ", " }
        );
        let folder = tempfile::tempdir().unwrap();
        let files = |existing| {
            let results = run(&folder, &case, "out", existing);
            let folders = [results.directory().to_owned(), results.directory().join("fields")];
            let entries = folders.iter().filter_map(|folder| fs::read_dir(folder).ok()).flatten();
            let paths = entries.map(|entry| entry.unwrap().path());
            let is_content = |path: &Path| path.is_file() && !path.ends_with("summary.json");
            let content = |path: std::path::PathBuf| (path.clone(), fs::read(path).unwrap());
            paths.filter(|path| is_content(path)).map(content).collect::<BTreeMap<_, _>>()
        };
        let finished = files(Existing::Keep);
        // An interruption may leave an older state beside the one from which the last step starts.
        let state = |step: usize| folder.path().join(format!("out/fields/state-{step:04}.h5"));
        if state(3).exists() {
            fs::copy(state(3), state(1)).unwrap();
        }
        let resumed = files(Existing::Resume);
        assert!(finished.keys().eq(resumed.keys()) && finished.len() > 2, "{keys}");
        for (path, bytes) in finished {
            assert!(resumed[&path] == bytes, "{keys}: {}", path.display());
        }
    }
}
