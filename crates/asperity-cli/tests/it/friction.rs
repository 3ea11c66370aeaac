//! `asperity run` with friction: pushed, rolling, sliding.

use std::collections::BTreeSet;
use std::fs;

use asperity::material::{Material, composite_modulus};
use asperity::reference::cattaneo::tangential_modulus;
use asperity::reference::{CattaneoMindlin, HertzSphere, MindlinDeresiewicz};
use asperity::study::{INCREMENT_COLUMNS, PASS_COLUMNS, STEP_COLUMNS, SWEEP_COLUMNS};
use asperity::study::{Results, pressure_name, traction_name};
use serde_json::json;

use crate::support::{
    BALL, PUSH, field, folder_with, keys, moving, number, pushed, run, set, summary, table_of,
};
use crate::support::{asperity, files, ok, refused};

#[test]
fn a_contact_with_friction_leaves_its_fields_its_increments_and_its_figures() {
    let folder = folder_with("ball.toml", &pushed(PUSH));
    let table = ok(&run(&folder, "ball.toml --out out"));
    assert!(
        table.contains("tangential force  3 mN, ")
            && table.contains("traction coeff.   0.15\n")
            && !table.contains("friction coeff."),
        "{table}"
    );
    let out = folder.path().join("out");
    let names = [
        "contact",
        "gap",
        "loading",
        "material_ratio",
        "pressure",
        "pressure_histogram",
        "profile",
        "relief_upper",
        "shear",
        "slip",
        "solution",
        "spectrum",
        "topographies",
    ];
    let mut expected: BTreeSet<String> = names.map(|name| format!("figures/{name}.png")).into();
    expected.extend(
        [".lock", "case.json", "fields.h5", "increments.csv", "report.html", "results.csv", "summary.json"]
            .map(str::to_owned),
    );
    assert_eq!(files(&out), expected);

    let summary = summary(&out);
    assert_eq!(
        keys(&summary["case"]["friction"]),
        set(["coefficient", "coupling", "increments", "junction_growth", "shear_strength"])
    );
    let record = &summary["static"];
    let rows = table_of(&out.join("increments.csv"), &INCREMENT_COLUMNS);
    assert_eq!(rows.iter().map(|row| row["stage"]).collect::<Vec<_>>(), [1.0, 1.0, 2.0, 2.0, 2.0]);
    let last = rows.last().unwrap();
    for (key, found) in [
        ("load", number(&record["load"])),
        ("tangential_force_x", number(&record["tangential_force"][0])),
        ("tangential_displacement_y", number(&record["tangential_displacement"][1])),
        ("stick_area", number(&record["stick_area"])),
        ("max_shear", number(&record["max_shear"])),
    ] {
        assert_eq!(found, last[key], "{key}");
    }
    assert!((number(&record["force_ratio"]) - 0.15).abs() < 1e-9);
    assert!(record["friction_coefficient"].is_null() && record.get("creepage").is_none());
    let lost: f64 = rows.iter().map(|row| row["dissipation"]).sum();
    assert!(lost > 0.0 && (number(&record["dissipation"]) / lost - 1.0).abs() < 1e-12);

    let fields = Results::open(&out).unwrap().static_fields().unwrap();
    let read = |name, unit| field(&fields, name, unit).into_field().unwrap();
    let [p, x, y] = ["pressure", "traction_x", "traction_y"].map(|name| read(name, "Pa"));
    let [slip_x, slip_y] = ["slip_x", "slip_y"].map(|name| read(name, "m"));
    let (stick, shift) = (read("stick", "1"), read("displacement_x", "m"));
    assert!(
        (1e-12 * x.sum() / 3e-3 - 1.0).abs() < 1e-9
            && (1e-12 * stick.sum() / last["stick_area"] - 1.0).abs() < 1e-12
    );
    let scale = shift.fold(0.0, |a: f64, b| a.max(b.abs()));
    let (mut sticks, mut slips) = (0, 0);
    for (cell, p) in p.indexed_iter() {
        let (q, slip) = (x[cell].hypot(y[cell]), slip_x[cell].hypot(slip_y[cell]));
        assert!(q <= 0.3 * p * (1.0 + 1e-12));
        match (stick[cell], *p) {
            (1.0, _) => sticks += 1,
            (_, 0.0) => assert!(q == 0.0 && slip == 0.0),
            _ => {
                // What slips bears all it can, and the lower body is dragged along.
                assert!(q >= 0.3 * p * (1.0 - 1e-3) && x[cell] > 0.0);
                slips += usize::from(slip > 1e-4 * scale);
            }
        }
    }
    assert!(sticks > 3 && slips > 3, "{sticks} cells stick, {slips} slip");

    fs::write(folder.path().join("ball.toml"), BALL).unwrap();
    ok(&run(&folder, "ball.toml --out out --overwrite"));
    let left = files(&out);
    assert!(!left.contains("increments.csv") && !left.contains("figures/shear.png"), "{left:?}");
}

#[test]
fn a_sweep_leaves_a_row_and_figures_of_its_points_and_prints_them() {
    let swept = BALL.replace("load = \"20 mN\"", "loads = { from = \"1 mN\", to = \"40 mN\", points = 4 }");
    let folder = folder_with("ball.toml", &format!("{swept}[output]\npressure_every = 3\nparaview = true\n"));
    let checked = ok(&asperity(&folder, "check ball.toml"));
    assert!(
        checked.contains("4 points, load 1 mN to 40 mN") && checked.contains("none: 4 static contacts"),
        "{checked}"
    );
    let printed = ok(&run(&folder, "ball.toml --out out"));
    let lines: Vec<&str> = printed.lines().collect();
    assert_eq!(lines.len(), 6, "{printed}");
    assert!(lines[0].starts_with("point     load   p mean approach"), "{printed}");
    assert!(lines[1].starts_with("            mN") && lines[5].starts_with("    4   40.00 "), "{printed}");
    let out = folder.path().join("out");
    let figures = [
        "contact",
        "contact_area",
        "gap",
        "material_ratio",
        "max_pressure",
        "mean_gap",
        "plastic",
        "pressure",
        "pressure_histogram",
        "profile",
        "relief_upper",
        "spectrum",
        "stiffness",
        "topographies",
    ];
    let mut expected: BTreeSet<String> = figures.map(|name| format!("figures/{name}.png")).into();
    expected.extend(
        [".lock", "case.json", "report.html", "results.csv", "summary.json", "sweep.csv"].map(str::to_owned),
    );
    for name in ["fields", "fields/point-0001", "fields/point-0004"] {
        expected.extend([format!("{name}.h5"), format!("{name}.vti")]);
    }
    assert_eq!(files(&out), expected);

    let rows = table_of(&out.join("sweep.csv"), &SWEEP_COLUMNS);
    let summary = summary(&out);
    for (row, record) in rows.iter().zip(summary["sweep"].as_array().unwrap()) {
        for (key, value) in row {
            assert_eq!(number(&record[key]), *value, "{key}");
        }
    }
    assert_eq!(keys(&summary["case"]["contact"]), set(["boundary", "loads", "method", "tolerance"]));
    assert!(rows[3]["plastic_volume"] > 0.0 && rows[0]["plastic_volume"] == 0.0, "{rows:?}");

    // Rows that are there are printed again, and the last point is solved.
    assert_eq!(ok(&run(&folder, "ball.toml --out out --resume")), printed);
    assert_eq!(files(&out), expected);
    fs::remove_dir_all(out.join("figures")).unwrap();
    ok(&asperity(&folder, "plot out --only stiffness"));
    assert!(out.join("figures/stiffness.png").exists());
    fs::write(folder.path().join("ball.toml"), BALL).unwrap();
    ok(&run(&folder, "ball.toml --out out --overwrite"));
    let left = files(&out);
    assert!(!left.contains("sweep.csv") && !left.contains("fields/point-0001.h5"), "{left:?}");
}

#[test]
#[ignore = "computes a whole example: needs an optimised build"]
fn a_ball_pushed_to_and_fro_is_mindlin_and_deresiewicz() {
    let folder = tempfile::tempdir().unwrap();
    ok(&run(&folder, "--example friction"));
    let out = folder.path().join("friction/results");
    let steel = Material::elastic(210e9, 0.3).unwrap();
    let normal = HertzSphere { radius: 1e-3, modulus: composite_modulus(&steel, &steel).unwrap(), load: 1.0 };
    let tangential_modulus = tangential_modulus(&steel, &steel);
    let pushed =
        |force| CattaneoMindlin { normal, tangential_modulus, friction: 0.3, tangential_load: force };
    let turn = pushed(0.18);
    // Displacements come to some parts in a thousand at 47 cells along the radius, areas to a ring of cells.
    let close = |found: f64, expected: f64, tolerance: f64, what: &str| {
        assert!((found / expected - 1.0).abs() < tolerance, "{what}: {found:e}, expected {expected:e}");
    };
    let rows = table_of(&out.join("increments.csv"), &INCREMENT_COLUMNS);
    let displacement = turn.displacement();
    for row in &rows {
        let force = row["tangential_force_x"];
        let expected = match row["stage"] as usize {
            1 => 0.0,
            2 => pushed(force).displacement(),
            3 => MindlinDeresiewicz { turn, tangential_load: force }.displacement(),
            _ => -MindlinDeresiewicz { turn, tangential_load: -force }.displacement(),
        };
        let error = (row["tangential_displacement_x"] - expected).abs();
        assert!(error < 5e-3 * displacement, "{force:e} N: off by {error:e} of {displacement:e} m");
    }
    let stick = |c: f64| std::f64::consts::PI * c * c;
    let record = &summary(&out)["static"];
    close(number(&record["stick_area"]), stick(turn.stick_radius()), 2e-2, "stick area");
    let most = turn.shear(turn.stick_radius());
    close(number(&record["max_shear"]), most, 2e-2, "largest shear");
    let cycle = rows.iter().filter(|row| row["stage"] > 2.0).map(|row| row["dissipation"]).sum();
    close(cycle, turn.cycle_loss(), 2e-2, "loss of the cycle");
}

#[test]
fn the_force_of_a_creepage_belongs_to_that_creepage() {
    let folder =
        folder_with("ball.toml", &pushed("[friction]\ncoefficient = 0.3\ncreepage = [2e-3, -1e-3]\n"));
    let table = ok(&run(&folder, "ball.toml --out rolled"));
    assert!(table.contains("\ncreepage          0.002, -0.001\n"), "{table}");
    let rolled = folder.path().join("rolled");
    let left = files(&rolled);
    assert!(left.contains("figures/shear.png"), "{left:?}");
    assert!(!left.contains("increments.csv") && !left.contains("figures/loading.png"), "{left:?}");
    let record = &summary(&rolled)["static"];
    assert_eq!(record["creepage"], json!([2e-3, -1e-3]));
    let [x, y] = [0, 1].map(|axis| number(&record["tangential_force"][axis]));
    assert!(x > 0.0 && y < 0.0 && x.hypot(y) < 0.3 * 20e-3, "{x:e}, {y:e}");
    assert!(number(&record["stick_area"]) > 0.0 && number(&record["dissipation"]) > 0.0);

    let driven = pushed(&format!("[friction]\ncoefficient = 0.3\nrolling_force = [{x:e}, {y:e}]\n"));
    fs::write(folder.path().join("ball.toml"), driven).unwrap();
    ok(&run(&folder, "ball.toml --out driven"));
    let driven = &summary(&folder.path().join("driven"))["static"];
    for (axis, creepage) in [2e-3, -1e-3].into_iter().enumerate() {
        let found = number(&driven["creepage"][axis]);
        assert!((found - creepage).abs() < 1e-4 * 2e-3, "{found:e}, expected {creepage:e}");
    }
}

#[test]
fn a_motion_with_friction_bears_its_coefficient_and_less_under_a_film() {
    let rubbing = |friction: &str| format!("{}friction = {{ coefficient = 0.2{friction} }}\n", moving(2, 4));
    let folder = folder_with("case.toml", &rubbing(""));
    let table = ok(&run(&folder, "case.toml --out out"));
    assert!(table.lines().nth(3).unwrap().ends_with(" friction"), "{table}");
    assert!(table.lines().nth(5).unwrap().ends_with("      0.2"), "{table}");
    let out = folder.path().join("out");
    assert!(files(&out).contains("figures/friction.png"));
    for row in table_of(&out.join("steps.csv"), &STEP_COLUMNS) {
        assert!((row["tangential_force"] - 0.2 * row["load"]).abs() <= 1e-14 * row["load"]);
    }
    for pass in table_of(&out.join("passes.csv"), &PASS_COLUMNS) {
        assert!((pass["friction_coefficient"] - 0.2).abs() < 1e-14);
        assert!((pass["mean_tangential_force"] / pass["mean_load"] - 0.2).abs() < 1e-14);
    }
    let fields = Results::open(&out).unwrap().fields_after(2).unwrap();
    for step in [1, 5, 9, 13] {
        let [p, q] = [pressure_name(step), traction_name(step)].map(|name| field(&fields, &name, "Pa"));
        assert_eq!((q.values, q.origin), (p.values.mapv(|p| 0.2 * p), p.origin));
    }
    ok(&run(&folder, "case.toml --out out --resume"));

    fs::write(folder.path().join("case.toml"), rubbing(", shear_strength = \"300 MPa\"")).unwrap();
    let error = refused(&run(&folder, "case.toml --out out --resume"));
    assert!(error.contains("results of another case"), "{error}");
    ok(&run(&folder, "case.toml --out out --overwrite"));
    for pass in table_of(&out.join("passes.csv"), &PASS_COLUMNS) {
        assert!((0.1..0.199).contains(&pass["friction_coefficient"]), "{pass:?}");
    }
    let fields = Results::open(&out).unwrap().fields_after(2).unwrap();
    let most = field(&fields, &traction_name(9), "Pa").values.fold(0.0, |a: f64, q| a.max(*q));
    assert_eq!(most, 300e6);
}

#[test]
fn figures_of_friction_are_the_same_on_any_number_of_threads() {
    let case = moving(2, 4).replacen("210 GPa", "70 GPa", 1) + "friction = { coefficient = 0.3 }\n";
    let folder = folder_with("case.toml", &case);
    ok(&run(&folder, "case.toml --out two --threads 2"));
    ok(&run(&folder, "case.toml --out one --threads 1"));
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    for name in ["steps.csv", "fields/pass-0002.h5", "figures/friction.png"] {
        assert!(bytes(&format!("one/{name}")) == bytes(&format!("two/{name}")), "{name} differs");
    }
}

/// Hamilton: under friction the most stressed point comes up to the surface, behind the middle of what slides.
#[test]
fn sliding_brings_the_most_stressed_point_to_the_surface() {
    let wanted = "[subsurface]\nto = \"3 um\"\nlayers = 30\n";
    let folder = tempfile::tempdir().unwrap();
    let stress = |name: &str, friction: &str| {
        fs::write(folder.path().join("ball.toml"), pushed(&format!("{friction}{wanted}"))).unwrap();
        ok(&run(&folder, &format!("ball.toml --out {name}")));
        let record = summary(&folder.path().join(name))["subsurface"][0].clone();
        let [x, depth] = [0, 2].map(|axis| number(&record["position"][axis]));
        (number(&record["max_von_mises"]), x, depth)
    };
    let (at_rest, _, deep) = stress("rest", "");
    let sliding = |direction| format!("[friction]\ncoefficient = 0.6\nsliding = [{direction}, 0]\n");
    let (right, x_right, depth) = stress("right", &sliding(1));
    let (left, x_left, _) = stress("left", &sliding(-1));
    assert!(deep > 0.5e-6 && depth == 0.0, "depths {deep:e} m and {depth:e} m");
    assert!(
        right > 1.5 * at_rest && (left / right - 1.0).abs() < 1e-6,
        "{at_rest:e}, {left:e}, {right:e} Pa"
    );
    // The corner of the body is 16 µm from its middle.
    assert!((x_right + x_left - 32e-6).abs() < 1e-12 && x_right < 16e-6, "{x_left:e} m and {x_right:e} m");
}

#[test]
fn figures_are_drawn_again_from_what_is_there() {
    let folder = folder_with("case.toml", &moving(1, 4));
    ok(&run(&folder, "case.toml"));
    let figures = folder.path().join("case-results/figures");
    let before = files(&figures);
    let map = fs::read(figures.join("topographies.png")).unwrap();
    fs::remove_dir_all(&figures).unwrap();
    let listed = ok(&asperity(&folder, "plot case-results"));
    assert_eq!(listed.lines().count(), before.len());
    for path in listed.lines() {
        assert!(folder.path().join(path).exists(), "{path}");
    }
    assert_eq!(files(&figures), before);
    assert!(fs::read(figures.join("topographies.png")).unwrap() == map);
    let error = refused(&asperity(&folder, "plot ."));
    assert!(error.contains("holds no results of asperity"), "{error}");
}
