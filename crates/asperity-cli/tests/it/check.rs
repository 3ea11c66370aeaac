//! What `asperity check` foretells of a case: counts of work, held against those of runs; the laws that it
//! will follow.

use std::fs;
use std::path::{Path, PathBuf};

use asperity::study::{Case, Demand, SurfaceInput, demand};
use serde_json::Value;

use crate::support::{asperity, assert_has, ok};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).to_owned()
}

fn text_of(example: &str) -> String {
    fs::read_to_string(root().join("examples").join(example).join("case.toml")).unwrap()
}

/// The demand of an example, changed.
fn demand_of(example: &str, edits: &[(&str, &str)], threads: usize) -> Demand {
    let text = edits.iter().fold(text_of(example), |text, (from, to)| {
        assert!(text.contains(from), "{example} has no {from}");
        text.replace(from, to)
    });
    let folder = root().join("examples").join(example);
    let case = Case::parse(&text, &folder.join("case.toml"), &folder).unwrap();
    demand(&case, &SurfaceInput::default(), threads).unwrap()
}

/// The convolutions of an example that was computed as it stands.
fn computed(example: &str) -> f64 {
    let path = root().join("tests/it/digests").join(example).with_extension("json");
    let digest: Value = serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap();
    let names = ["static", "passes"].map(|kind| format!("summary.json {kind} convolutions"));
    let series = names.iter().find_map(|name| digest.get(name)).expect("convolutions");
    series["mean"].as_f64().unwrap() * series["count"].as_f64().unwrap()
}

#[test]
fn the_convolutions_that_check_counts_are_those_of_the_examples() {
    // 100 000 passes would take too long here: 141 of them are computed.
    let running_in = ("running-in", 14_124.5);
    let computed =
        ["quickstart", "hertz", "friction", "measured", "paper", "study"].map(|e| (e, computed(e)));
    // The convolutions of adhesion depend on its strength. The example with 512 × 512 cells takes too long
    // here, the other has 111 increments.
    let sticking = [("contact-challenge", 68.6), ("pull-off", 5662.0)];
    for (example, convolutions) in computed.into_iter().chain([running_in]).chain(sticking) {
        let told = demand_of(example, &[], 2).convolutions;
        let ratio = told / convolutions;
        assert!((1.0 / 1.5..1.5).contains(&ratio), "{example}: {told:.1} told, {convolutions:.1} computed");
    }
    let passes = demand_of("running-in", &[], 2).passes;
    assert!((1.0 / 1.5..1.5).contains(&(passes / 141.0)), "{passes} passes");
}

#[test]
fn the_memory_that_check_tells_is_that_of_the_examples() {
    // Largest resident sets of `asperity run --example` on two threads, MB.
    for (example, measured) in [
        ("quickstart", 94.0),
        ("hertz", 72.0),
        ("friction", 77.0),
        ("measured", 126.0),
        ("running-in", 95.0),
        ("rolling", 106.0),
        ("study", 69.0),
        ("paper", 131.0),
        ("pull-off", 76.0),
        ("contact-challenge", 95.0),
    ] {
        let told = demand_of(example, &[], 2).memory / 1e6;
        let ratio = told / measured;
        assert!((1.0 / 1.5..1.5).contains(&ratio), "{example}: {told:.0} MB told, {measured} MB measured");
    }
}

#[test]
fn twice_the_passes_or_increments_are_twice_the_work() {
    let effort = |example: &str, edits: &[(&str, &str)]| demand_of(example, edits, 1).effort;
    for (example, from, to) in [
        ("quickstart", "passes = 5", "passes = 10"),
        ("friction", "increments = 24", "increments = 48"),
        ("hertz", "layers = 60", "layers = 120"),
    ] {
        let ratio = effort(example, &[(from, to)]) / effort(example, &[]);
        assert!((1.4..2.1).contains(&ratio), "{example}: {ratio}");
    }
}

#[test]
fn films_and_kept_pressures_count() {
    let whole = demand_of("running-in", &[], 1);
    let none_kept = demand_of("running-in", &[("pressure_every = 4", "pressure_every = 0")], 1);
    assert!(none_kept.drawing < whole.drawing, "neither the page nor the animation has pressures then");
    let text = text_of("running-in");
    let tables: Vec<&str> = text.split("\n[").filter(|table| !table.contains(".film]")).collect();
    let text = tables.join("\n[");
    let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with("under_film")).collect();
    let case = Case::parse(&lines.join("\n"), Path::new("case.toml"), Path::new("")).unwrap();
    let bare = demand(&case, &SurfaceInput::default(), 1).unwrap();
    assert!(bare.effort < 0.6 * whole.effort, "films take most: {} of {}", bare.effort, whole.effort);
}

#[test]
fn threads_share_positions_and_figures_but_not_increments() {
    let ratio = |example: &str| {
        let [one, two] = [1, 2].map(|threads| demand_of(example, &[], threads));
        [one.effort / two.effort, one.drawing / two.drawing]
    };
    assert!(ratio("quickstart").iter().all(|ratio| (1.5..2.0).contains(ratio)), "{:?}", ratio("quickstart"));
    assert!(ratio("friction")[0] < 1.3, "{:?}", ratio("friction"));
}

#[test]
fn check_describes_the_laws_that_a_case_follows() {
    let folder = tempfile::tempdir().unwrap();
    ok(&asperity(&folder, "example running-in --out r"));
    let page = ok(&asperity(&folder, "check r/case.toml"));
    for part in [
        "\nwear     of both bodies 2e-8 mm³/(N m) per load and distance, 2e-9 mm³/(N m) under the film\n",
        "\nfilm     of both bodies Arrhenius growth up to 150 nm, pressure up to 2 GPa where it is thickest\n",
        "\nheat     bulk 373.1 K, flash temperature at each position\n",
        " of 100000 computed, each extrapolated over at most 10000 passes or a depth of 5 nm\n",
        " to solve and write, ",
        " for figures and page\n",
    ] {
        assert_has(&page, part);
    }
    ok(&asperity(&folder, "example quickstart --out q"));
    let page = ok(&asperity(&folder, "check q/case.toml"));
    let laws = ["wear ", "film ", "heat ", "passes "];
    assert!(!page.lines().any(|line| laws.iter().any(|law| line.starts_with(law))), "{page}");
}
