//! `asperity run` and what it leaves, from its users' side: files, streams, exit codes, a run that is stopped.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use asperity::io::fields::{Fields, StoredField};
use asperity::material::{Material, composite_modulus};
use asperity::motion::PassRecord;
use asperity::reference::cattaneo::tangential_modulus;
use asperity::reference::{CattaneoMindlin, HertzSphere, MindlinDeresiewicz};
use asperity::study::{INCREMENT_COLUMNS, PASS_COLUMNS, STEP_COLUMNS, SWEEP_COLUMNS};
use asperity::study::{Results, pressure_name, traction_name};
use asperity::surface::ReadOptions;
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::support::{
    asperity, change, command, files, limited, ok, program, refused, send, spawn, stderr, wait_for,
};

// ---- what a run leaves -----------------------------------------------------------------------------------

#[test]
fn a_motion_leaves_every_file_promised_and_nothing_else() {
    let folder = folder_with("case.toml", &moving(2, 4));
    let output = run(&folder, "case.toml");
    let table = ok(&output);
    assert_eq!(
        table.lines().count(),
        6,
        "what the columns are, their heads and units, a line per pass: {table}"
    );
    assert!(table.lines().all(|line| line.chars().count() <= 80), "{table}");
    assert!(
        table.starts_with("load, area: means over the pass; apart: distance of the mean planes\n"),
        "{table}"
    );
    assert!(
        table.contains("inside: without the rim, 0.1 of the length at free ends; Sq, plastic too\n"),
        "{table}"
    );
    assert!(table.lines().skip(4).all(|line| line.contains("   20.00  ")), "{table}");
    let said = stderr(&output);
    let (warnings, end) = said.trim_end().rsplit_once('\n').unwrap();
    assert!(
        warnings.lines().all(|line| line.starts_with("warning: ")) && warnings.contains("a comb"),
        "{said}"
    );
    assert_eq!(end, "results, figures and report.html in case-results");

    let figures = [
        "approach.png",
        "contact.png",
        "contact_area.png",
        "load.png",
        "material_ratio.png",
        "max_pressure.png",
        "mean_contact_area.png",
        "mean_pressure.png",
        "parameters.png",
        "plastic.png",
        "pressure.gif",
        "pressure.png",
        "pressure_histogram.png",
        "profile.png",
        "relief_lower.png",
        "relief_upper.png",
        "roughness.png",
        "solution.png",
        "spectrum.png",
        "topographies.png",
    ];
    let mut expected: BTreeSet<String> = figures.map(|name| format!("figures/{name}")).into();
    expected.extend(
        ["initial.h5", "pass-0001.h5", "pass-0002.h5", "state-0002.h5"].map(|name| format!("fields/{name}")),
    );
    expected.extend(
        [".lock", "case.json", "passes.csv", "report.html", "steps.csv", "summary.json"].map(str::to_owned),
    );
    assert_eq!(files(&folder.path().join("case-results")), expected);
}

#[test]
fn a_static_contact_leaves_every_file_promised_and_nothing_else() {
    let folder = folder_with("ball.toml", BALL);
    let output = run(&folder, "ball.toml --out results/of/ball");
    let table = ok(&output);
    assert!(table.starts_with("load              20 mN\nnominal pressure  19.53 MPa\napproach  "), "{table}");
    let figures = [
        "contact",
        "gap",
        "material_ratio",
        "plastic",
        "pressure",
        "pressure_histogram",
        "profile",
        "relief_upper",
        "spectrum",
        "topographies",
    ];
    let mut expected: BTreeSet<String> = figures.map(|name| format!("figures/{name}.png")).into();
    expected.extend([".lock", "case.json", "fields.h5", "report.html", "summary.json"].map(str::to_owned));
    assert_eq!(files(&folder.path().join("results/of/ball")), expected);
}

#[test]
fn the_stress_is_written_and_drawn_where_it_is_wanted_and_replaced_with_the_rest() {
    let wanted = "\n[subsurface]\nto = \"5 um\"\nlayers = 10\n";
    let folder = folder_with("case.toml", &format!("{BALL}{wanted}"));
    let table = ok(&run(&folder, "case.toml --out out"));
    assert!(table.contains("\nlargest von Mises stress "), "{table}");
    let out = folder.path().join("out");
    let (left, summary) = (files(&out), summary(&out));
    assert!(left.contains("subsurface.h5") && left.contains("figures/subsurface.png"), "{left:?}");
    let expected = ["max_von_mises", "position", "max_shear", "max_shear_position"];
    assert_eq!(keys(&summary["subsurface"][0]), set(expected));
    let drawn = fs::read(out.join("figures/subsurface.png")).unwrap();
    fs::remove_dir_all(out.join("figures")).unwrap();
    ok(&asperity(&folder, "plot out"));
    assert!(fs::read(out.join("figures/subsurface.png")).unwrap() == drawn);

    fs::write(
        folder.path().join("case.toml"),
        moving(2, 4).replace("output", "subsurface = { to = 5e-6 }\noutput"),
    )
    .unwrap();
    let table = ok(&run(&folder, "case.toml --out out --overwrite"));
    assert!(table.contains("\npass 2: largest von Mises stress "), "{table}");
    let left = files(&out);
    for name in ["fields/subsurface-0001.h5", "fields/subsurface-0002.h5", "figures/subsurface.png"] {
        assert!(left.contains(name), "{left:?}");
    }
    assert!(!left.contains("subsurface.h5"), "{left:?}");
}

#[test]
fn plot_draws_what_is_asked_for_in_the_format_and_width_of_a_page() {
    let folder = folder_with("ball.toml", BALL);
    ok(&run(&folder, "ball.toml --out out"));
    let figures = folder.path().join("out/figures");
    fs::remove_dir_all(&figures).unwrap();
    let drawn = ok(&asperity(
        &folder,
        "plot out --only gap --only pressure --format pdf --width 85mm --range 0,2GPa",
    ));
    assert_eq!(
        drawn,
        "out/figures/pressure.pdf
out/figures/gap.pdf
"
    );
    assert_eq!(files(&figures), set(["gap.pdf", "pressure.pdf"]));
    let bytes = fs::read(figures.join("gap.pdf")).unwrap();
    // 85 mm are 240.94 pt.
    let page = String::from_utf8_lossy(&bytes);
    assert!(page.contains("/MediaBox [0 0 240.94"), "{}", &page[..400]);
    ok(&asperity(&folder, "plot out --only pressure --format svg"));
    let svg = fs::read_to_string(figures.join("pressure.svg")).unwrap();
    assert!(svg.contains(">pressure (GPa)</text>") && svg.contains("load 20 mN</text>"), "{svg:.600}");

    let error = refused(&asperity(&folder, "plot out --only presure"));
    assert!(
        error.contains("no figure `presure`") && error.contains("hint: there are topographies, "),
        "{error}"
    );
    let error = refused(&asperity(&folder, "plot out --range 0,1GPa"));
    assert!(error.contains("--range without --only"), "{error}");
    for bad in ["--dpi 0", "--width 1um", "--only gap --range 1GPa,0", "--format bmp"] {
        refused(&asperity(&folder, &format!("plot out {bad}")));
    }
}

#[test]
fn the_summary_of_a_motion_has_the_keys_and_numbers_of_its_tables() {
    let folder = folder_with("case.toml", &moving(2, 4));
    ok(&run(&folder, "case.toml"));
    let directory = folder.path().join("case-results");
    let summary = summary(&directory);
    assert_eq!(keys(&summary), set(["case", "passes", "version", "wall_time_s", "warnings"]));
    assert_eq!(
        keys(&summary["case"]),
        set(["contact", "identity", "lower", "motion", "output", "title", "upper"])
    );
    assert_eq!(summary["case"]["contact"]["load"], json!(0.02), "SI");
    assert_eq!(summary["version"], env!("CARGO_PKG_VERSION"));
    assert!(summary["warnings"].is_array() && summary["wall_time_s"].as_f64().unwrap() > 0.0);
    let passes = summary["passes"].as_array().unwrap();
    let rows = table(&directory.join("passes.csv"), &PASS_COLUMNS);
    assert_eq!((passes.len(), rows.len()), (2, 2));
    for (pass, row) in passes.iter().zip(&rows) {
        assert_eq!(keys(pass), set(PASS_COLUMNS));
        for (column, cell) in PASS_COLUMNS.iter().zip(row) {
            assert_eq!(pass[column].as_f64(), Some(*cell), "{column}");
        }
    }
}

#[test]
fn the_summary_of_a_static_contact_has_the_keys_promised() {
    let folder = folder_with("ball.toml", BALL);
    ok(&run(&folder, "ball.toml"));
    let summary = summary(&folder.path().join("ball-results"));
    assert_eq!(keys(&summary), set(["case", "static", "version", "wall_time_s", "warnings"]));
    let expected = [
        "load",
        "approach",
        "contact_area",
        "apparent_area",
        "max_pressure",
        "mean_gap",
        "elastic_energy",
        "plastic_cells",
        "plastic_volume",
        "iterations",
        "convolutions",
        "residual",
        "converged",
    ];
    assert_eq!(keys(&summary["static"]), set(expected));
    assert_eq!((&summary["static"]["converged"], &summary["case"]["motion"]), (&json!(true), &Value::Null));
    assert!((number(&summary["static"]["load"]) / 0.02 - 1.0).abs() < 1e-10);
    assert!((number(&summary["static"]["apparent_area"]) / 1024e-12 - 1.0).abs() < 1e-12);
}

#[test]
fn steps_csv_has_a_row_per_position_whose_mean_is_that_of_the_pass() {
    let folder = folder_with("case.toml", &moving(2, 4));
    ok(&run(&folder, "case.toml"));
    let directory = folder.path().join("case-results");
    let steps = table(&directory.join("steps.csv"), &STEP_COLUMNS);
    let passes = table(&directory.join("passes.csv"), &PASS_COLUMNS);
    let column = |name: &str| STEP_COLUMNS.iter().position(|column| *column == name).unwrap();
    // Offsets of −28, −24, … 28 of 32 columns.
    assert_eq!(steps.len(), 2 * 15);
    for (k, row) in steps.iter().enumerate() {
        let (pass, step) = (1 + k / 15, 1 + k % 15);
        assert_eq!((row[0], row[1]), (pass as f64, step as f64));
        assert!((row[column("offset")] - (4 * step as i64 - 32) as f64 * 1e-6).abs() < 1e-18);
        assert_eq!(row[column("overlap_columns")], 32.0 - (4.0 * step as f64 - 32.0).abs());
        assert!(row[column("residual")] < 1e-6 && row[column("max_pressure")] <= 4e9);
    }
    for (rows, pass) in steps.chunks(15).zip(&passes) {
        let mean = |name: &str| rows.iter().map(|row| row[column(name)]).sum::<f64>() / 15.0;
        assert!((mean("load") / pass[2] - 1.0).abs() < 1e-12 && (pass[2] / 0.02 - 1.0).abs() <= 1e-4);
        let area = PASS_COLUMNS.iter().position(|column| *column == "mean_contact_area").unwrap();
        assert!((mean("contact_area") / pass[area] - 1.0).abs() < 1e-12);
    }
}

#[test]
fn the_fields_of_a_motion_carry_its_loads_and_its_surfaces() {
    let folder = folder_with("case.toml", &moving(2, 4));
    ok(&run(&folder, "case.toml"));
    let results = Results::open(&folder.path().join("case-results")).unwrap();
    let steps = results.steps().unwrap();
    let initial = results.fields_after(0).unwrap();
    assert_eq!(initial.names().unwrap(), ["lower", "upper"]);
    for (pass, record) in results.passes().unwrap().iter().enumerate() {
        let fields = results.fields_after(pass + 1).unwrap();
        let kept = [1, 5, 9, 13].map(pressure_name);
        let mut names = ["lower", "mean_pressure_lower", "mean_pressure_upper"].map(str::to_owned).to_vec();
        names.extend(kept);
        names.push("upper".to_owned());
        assert_eq!(fields.names().unwrap(), names);
        for (name, sq) in [("lower", record.sq_lower), ("upper", record.sq_upper)] {
            let heights = field(&fields, name, "m").into_field().unwrap();
            assert!((heights.std(0.0) / sq - 1.0).abs() < 1e-12);
        }
        for name in ["mean_pressure_lower", "mean_pressure_upper"] {
            let load = 1e-12 * field(&fields, name, "Pa").values.sum();
            assert!((load / record.mean_load - 1.0).abs() < 1e-12, "{name} carries {load:e} N");
        }
        for step in [1, 5, 9, 13] {
            let row = steps.iter().find(|row| row.pass == pass + 1 && row.step == step).unwrap();
            let pressure = field(&fields, &pressure_name(step), "Pa");
            assert_eq!(pressure.values.shape(), [row.overlap_columns, 32]);
            let load = 1e-12 * pressure.values.sum();
            assert!((load / row.load - 1.0).abs() < 1e-12, "position {step} carries {load:e} N");
            // In the frame of the lower body.
            assert!((pressure.origin[0] - (row.offset.max(0.0) + 0.5e-6)).abs() < 1e-15);
        }
    }
}

#[test]
fn the_fields_of_a_static_contact_are_in_equilibrium() {
    let folder = folder_with("ball.toml", BALL);
    ok(&run(&folder, "ball.toml"));
    let directory = folder.path().join("ball-results");
    let record = &summary(&directory)["static"];
    let fields = Results::open(&directory).unwrap().static_fields().unwrap();
    assert_eq!(fields.names().unwrap(), ["displacement", "gap", "lower", "plastic", "pressure", "upper"]);
    let read = |name, unit| field(&fields, name, unit).into_field().unwrap();
    let (p, u) = (read("pressure", "Pa"), read("displacement", "m"));
    let (gap, plastic) = (read("gap", "m"), read("plastic", "m"));
    let initial = read("upper", "m") - read("lower", "m");
    assert!((1e-12 * p.sum() / number(&record["load"]) - 1.0).abs() < 1e-12);
    assert!((1e-12 * plastic.sum() / number(&record["plastic_volume"]) - 1.0).abs() < 1e-12);
    let scale = u.fold(0.0, |a: f64, b| a.max(*b));
    for (cell, p) in p.indexed_iter() {
        assert!((gap[cell] - (initial[cell] + u[cell] - number(&record["approach"]))).abs() < 1e-12 * scale);
        match *p {
            0.0 => assert!(gap[cell] >= -1e-5 * scale),
            p if p < 1e9 => assert!(gap[cell].abs() <= 1e-5 * scale && plastic[cell] == 0.0),
            p => assert!(p == 1e9 && (plastic[cell] + gap[cell].min(0.0)).abs() < 1e-12 * scale),
        }
    }
}

#[test]
fn without_kept_pressures_there_are_no_maps_of_them() {
    let case = moving(1, 4).replace("pressure_every = 4", "pressure_every = 0");
    let folder = folder_with("case.toml", &case);
    ok(&run(&folder, "case.toml"));
    let fields = Fields::open(&folder.path().join("case-results/fields/pass-0001.h5")).unwrap();
    assert_eq!(fields.names().unwrap(), ["lower", "mean_pressure_lower", "mean_pressure_upper", "upper"]);
    assert!(!folder.path().join("case-results/figures/pressure.png").exists());
}

#[test]
fn the_answer_is_the_same_on_one_thread_and_in_quiet() {
    let folder = folder_with("case.toml", &moving(2, 4));
    let two = run(&folder, "case.toml --out two --threads 2");
    let one = run(&folder, "case.toml --out one --threads 1 --quiet");
    assert!(!ok(&two).is_empty());
    // Warnings are left.
    assert_eq!(ok(&one), "");
    assert!(stderr(&one).lines().all(|line| line.starts_with("warning: ")), "{}", stderr(&one));
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    for name in ["steps.csv", "fields/pass-0002.h5", "figures/pressure.png"] {
        assert!(bytes(&format!("one/{name}")) == bytes(&format!("two/{name}")), "{name} differs");
    }
}

#[test]
fn a_ball_on_a_plane_is_hertz() {
    let folder = tempfile::tempdir().unwrap();
    let output = run(&folder, "--example hertz");
    assert!(ok(&output).contains("largest pressure"));
    assert!(folder.path().join("hertz/case/case.toml").exists());
    let summary = summary(&folder.path().join("hertz/results"));
    let (record, stress) = (&summary["static"], &summary["subsurface"][0]);
    assert!((number(&stress["max_von_mises"]) / 850e6 - 1.0).abs() < 2e-3, "{stress}");
    assert!((number(&stress["position"][2]) / 9.0e-6 - 1.0).abs() < 2e-2, "{stress}");
    for (key, closed_form, tolerance) in
        [("approach", 348.2e-9, 2e-3), ("max_pressure", 1.371e9, 2e-3), ("contact_area", 1094e-12, 2e-2)]
    {
        let error = number(&record[key]) / closed_form - 1.0;
        assert!(error.abs() < tolerance, "{key}: {error:e}");
    }
    refused(&run(&folder, "--example hertz"));
    ok(&run(&folder, "--example hertz --overwrite"));
    refused(&run(&folder, "--example nonsense"));
}

// ---- friction --------------------------------------------------------------------------------------------

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
        [".lock", "case.json", "fields.h5", "increments.csv", "report.html", "summary.json"]
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
    expected.extend([".lock", "case.json", "report.html", "summary.json", "sweep.csv"].map(str::to_owned));
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
fn dissimilar_bodies_slide_alike_on_any_number_of_threads_and_after_a_break() {
    let case = moving(2, 4).replacen("210 GPa", "70 GPa", 1) + "friction = { coefficient = 0.3 }\n";
    let folder = folder_with("case.toml", &case);
    ok(&run(&folder, "case.toml --out two --threads 2"));
    ok(&run(&folder, "case.toml --out one --threads 1"));
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    for name in ["steps.csv", "fields/pass-0002.h5", "figures/friction.png"] {
        assert!(bytes(&format!("one/{name}")) == bytes(&format!("two/{name}")), "{name} differs");
    }
    change(&folder.path().join("case.toml"), "passes = 2", "passes = 1");
    ok(&run(&folder, "case.toml --out parts"));
    change(&folder.path().join("case.toml"), "passes = 1", "passes = 2");
    ok(&run(&folder, "case.toml --out parts --resume"));
    assert_same_passes(&folder.path().join("parts"), &folder.path().join("one"));
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

// ---- directories that are there already ------------------------------------------------------------------

#[test]
fn results_are_replaced_only_on_request_and_strangers_never() {
    let folder = folder_with("case.toml", &moving(2, 8));
    ok(&run(&folder, "case.toml --out out"));
    let error = refused(&run(&folder, "case.toml --out out"));
    assert!(error.starts_with("error: out already holds results"), "{error}");
    assert!(error.contains("hint: --overwrite replaces them, --resume goes on from them"), "{error}");

    fs::write(folder.path().join("out/notes.txt"), "mine").unwrap();
    fs::write(folder.path().join("case.toml"), BALL).unwrap();
    ok(&run(&folder, "case.toml --out out --overwrite"));
    let left = files(&folder.path().join("out"));
    assert!(left.contains("notes.txt") && left.contains("fields.h5"), "{left:?}");
    assert!(!left.contains("passes.csv") && !left.contains("fields/pass-0001.h5"), "{left:?}");
}

#[test]
fn a_directory_of_something_else_is_left_alone() {
    let folder = folder_with("case.toml", &moving(1, 8));
    fs::create_dir(folder.path().join("photos")).unwrap();
    fs::write(folder.path().join("photos/passes.csv"), "mine").unwrap();
    for flag in ["", " --overwrite", " --resume"] {
        let error = refused(&run(&folder, &format!("case.toml --out photos{flag}")));
        assert!(error.contains("photos is not empty, and holds no results of asperity"), "{flag}: {error}");
        assert!(error.contains("hint: --out names another directory"), "{error}");
        assert_eq!(files(&folder.path().join("photos")), ["passes.csv".to_owned()].into());
    }
    assert_eq!(fs::read(folder.path().join("photos/passes.csv")).unwrap(), b"mine");
    fs::create_dir(folder.path().join("empty")).unwrap();
    ok(&run(&folder, "case.toml --out empty"));
}

#[test]
fn results_do_not_lie_within_others_and_leave_no_empty_folder() {
    let folder = folder_with("ball.toml", &pushed(PUSH));
    ok(&run(&folder, "ball.toml --out out"));
    let out = folder.path().join("out");
    assert!(!out.join("fields").exists());
    let before = files(&out);
    for within in ["out/second", "out/fields/deep/er"] {
        let error = refused(&run(&folder, &format!("ball.toml --out {within}")));
        assert!(error.contains(&format!("{within} lies within the results in ")), "{error}");
        assert!(error.contains("hint: --out names another directory"), "{error}");
    }
    assert_eq!(files(&out), before);
    assert!(!out.join("second").exists() && !out.join("fields").exists());
}

#[test]
fn a_place_where_nothing_can_be_written_is_named() {
    let folder = folder_with("case.toml", &moving(1, 8));
    fs::write(folder.path().join("file"), "mine").unwrap();
    let error = refused(&run(&folder, "case.toml --out file"));
    assert!(error.starts_with("error: file: not a directory"), "{error}");
    let error = refused(&run(&folder, "case.toml --out file/inside"));
    assert!(error.starts_with("error: file/inside: Not a directory"), "{error}");
    assert_eq!(fs::read(folder.path().join("file")).unwrap(), b"mine");
    if cfg!(target_os = "linux") {
        // Nobody, root neither, makes a directory there.
        let error = refused(&run(&folder, "case.toml --out /proc/asperity"));
        assert!(error.starts_with("error: /proc/asperity: No such file or directory"), "{error}");
    }
}

#[test]
#[cfg(unix)]
fn a_page_is_made_again_from_the_results_alone_and_replaced_whole_or_not_at_all() {
    let folder = folder_with("case.toml", &moving(1, 8));
    ok(&run(&folder, "case.toml --out out"));
    let page = |name: &str| fs::read(folder.path().join(name)).unwrap();
    let written = page("out/report.html");
    fs::remove_file(folder.path().join("case.toml")).unwrap();
    assert_eq!(ok(&asperity(&folder, "report out --out page.html")), "page.html\n");
    assert!(page("page.html") == written, "it shows something else than the results");

    let output = limited(&folder, "-f 16", "report out");
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stderr(&output).contains("out/report.html: File too large"), "{}", stderr(&output));
    assert!(page("out/report.html") == written, "the page that was there is gone");

    assert!(refused(&asperity(&folder, "report nowhere")).contains("no case.json"));
    assert!(
        refused(&asperity(&folder, "report out --out no/such.html")).contains("its directory does not exist")
    );
}

#[test]
#[cfg(unix)]
fn the_page_of_an_interrupted_run_shows_what_is_done() {
    let folder = folder_with("case.toml", &moving(100_000, 4));
    let out = folder.path().join("out");
    let page = out.join("report.html");
    let mut child = spawn(&folder, "run case.toml --out out");
    wait_for(&mut child, &out.join("passes.csv"));
    send("INT", &child);
    assert_eq!(child.wait_with_output().unwrap().status.code(), Some(130));
    let text = fs::read_to_string(&page).unwrap();
    assert!(text.contains("of 100000 passes are there") && text.contains("--resume"));

    // What is computed anew has no page of what was there before.
    let mut child = spawn(&folder, "run case.toml --out out --overwrite");
    let began = Instant::now();
    while page.exists() {
        assert!(began.elapsed() < Duration::from_secs(120) && child.try_wait().unwrap().is_none());
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn an_animation_is_an_apng_where_it_is_named() {
    // Its numbers are so long that they break the line over some of the frames.
    let title = format!("title = \"{}\"\n", "contact ".repeat(9));
    let folder = folder_with("case.toml", &format!("{title}{}", moving(1, 8)));
    ok(&run(&folder, "case.toml --out out"));
    let gif = fs::read(folder.path().join("out/figures/pressure.gif")).unwrap();
    assert!(gif.starts_with(b"GIF89a") && !folder.path().join("out/figures/pressure.apng").exists());
    assert_eq!(ok(&asperity(&folder, "plot out --only pressure.apng")), "out/figures/pressure.apng\n");
    let bytes = fs::read(folder.path().join("out/figures/pressure.apng")).unwrap();
    let names = Fields::open(&folder.path().join("out/fields/pass-0001.h5")).unwrap().names().unwrap();
    let kept = names.iter().filter(|name| name.starts_with("pressure_")).count() as u32;

    let number = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
    assert_eq!(&bytes[..8], b"\x89PNG\r\n\x1a\n");
    let (mut at, mut frames, mut sequence, mut last) = (8, 0, 0, Vec::new());
    while at < bytes.len() {
        let (length, content) = (number(at) as usize, at + 8);
        last = bytes[at + 4..content].to_vec();
        match &*last {
            // As many frames as positions, without end.
            b"acTL" => assert_eq!((number(content), number(content + 4)), (kept, 0)),
            b"fcTL" => {
                assert_eq!(number(content), sequence);
                assert_eq!(bytes[content + 20..content + 24], [0, 12, 0, 100], "not 0.12 s");
                (frames, sequence) = (frames + 1, sequence + 1);
            }
            b"fdAT" => {
                assert_eq!(number(content), sequence);
                sequence += 1;
            }
            _ => {}
        }
        at = content + length + 4;
    }
    assert!(kept > 1 && frames == kept && at == bytes.len() && last == b"IEND", "{frames} frames of {kept}");
}

#[test]
#[cfg(unix)]
fn an_animation_is_an_mp4_where_there_is_ffmpeg() {
    use std::os::unix::fs::PermissionsExt;

    let folder = folder_with("case.toml", &moving(1, 8));
    ok(&run(&folder, "case.toml --out out"));
    let drawn = folder.path().join("out/figures/pressure.mp4");
    let plot =
        |path: &str| command(&folder, "plot out --only pressure.mp4").env("PATH", path).output().unwrap();
    assert!(refused(&plot("nowhere")).contains("`apt-get install ffmpeg`") && !drawn.exists());

    let programs = format!("{}:/usr/bin:/bin", folder.path().display());
    let program = folder.path().join("ffmpeg");
    let put = |script: &str| {
        fs::write(&program, script).unwrap();
        fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    };
    put("#!/bin/sh\necho \"$@\" > arguments; wc -c > bytes; printf film\n");
    ok(&plot(&programs));
    assert_eq!(fs::read(&drawn).unwrap(), b"film");
    let arguments = fs::read_to_string(folder.path().join("arguments")).unwrap();
    let after = |name: &str| arguments.split_once(name).unwrap().1.split(' ').next().unwrap().to_owned();
    assert_eq!((after("-framerate ").as_str(), after("-pix_fmt ").as_str()), ("100/12", "rgb24"));
    let size = after("-video_size ");
    let (width, height) = size.split_once('x').unwrap();
    let frame = 3 * width.parse::<usize>().unwrap() * height.parse::<usize>().unwrap();
    let bytes: usize = fs::read_to_string(folder.path().join("bytes")).unwrap().trim().parse().unwrap();
    assert!(bytes > frame && bytes.is_multiple_of(frame), "{bytes} bytes in frames of {frame}");

    assert!(refused(&plot(&programs)).contains("--overwrite replaces the figures that are there"));
    put("#!/bin/sh\ncat > /dev/null; echo no codec >&2; exit 3\n");
    let again = "plot out --only pressure.mp4 --overwrite";
    let output = command(&folder, again).env("PATH", &programs).output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stderr(&output).contains("no codec") && fs::read(&drawn).unwrap() == b"film");
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_an_error_that_leaves_no_half_written_file() {
    let folder = folder_with("case.toml", &moving(1, 8));
    let out = folder.path().join("out");
    // The first file that is larger than so many KiB is not there.
    let limited = |limit: usize, arguments: &str| {
        let output = limited(&folder, &format!("-f {limit}"), arguments);
        assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
        stderr(&output)
    };
    let error = limited(8, "run case.toml --out out");
    assert_eq!(error, "error: out/fields/initial.h5: File too large (os error 27)\n");
    assert_eq!(files(&out), set([".lock", "case.json"]));

    let error = limited(48, "run case.toml --out out --overwrite");
    assert_eq!(error, "error: out/fields/pass-0001.h5: File too large (os error 27)\n");
    assert_eq!(files(&out), set([".lock", "case.json", "fields/initial.h5"]));

    // With room again, the run goes on.
    ok(&run(&folder, "case.toml --out out --resume"));
    let map = fs::read(out.join("figures/topographies.png")).unwrap();
    let before = files(&out);
    let error = limited(16, "plot out --overwrite");
    assert_eq!(error, "error: cannot draw `out/figures/topographies.png`: File too large (os error 27)\n");
    assert!(fs::read(out.join("figures/topographies.png")).unwrap() == map, "the older figure is whole");
    assert_eq!(files(&out), before);
}

// ---- runs that go on -------------------------------------------------------------------------------------

#[test]
fn more_passes_are_appended_to_finished_ones() {
    let folder = folder_with("case.toml", &moving(3, 4));
    ok(&run(&folder, "case.toml --out whole"));
    change(&folder.path().join("case.toml"), "passes = 3", "passes = 1");
    ok(&run(&folder, "case.toml --out parts"));
    change(&folder.path().join("case.toml"), "passes = 1", "passes = 3");
    let table = ok(&run(&folder, "case.toml --out parts --resume"));
    assert_eq!(table.lines().count(), 7, "{table}");
    assert_same_passes(&folder.path().join("parts"), &folder.path().join("whole"));
    assert_eq!(summary(&folder.path().join("parts"))["case"]["motion"]["passes"], 3);
    // Nothing is left to do, and nothing is done.
    let steps = fs::read(folder.path().join("parts/steps.csv")).unwrap();
    assert_eq!(ok(&run(&folder, "case.toml --out parts --resume")), table);
    assert!(fs::read(folder.path().join("parts/steps.csv")).unwrap() == steps);
}

#[test]
fn every_motion_goes_on_with_the_same_bits() {
    let shift = "strategy = \"shift\", speed_lower = 0.0, speed_upper = 1.0";
    let cases = [
        ("control = \"step-load\"", ""),
        ("plastic_update = \"step\"", ""),
        ("control = \"step-load\", plastic_update = \"step\"", "friction = { coefficient = 0.3 }\n"),
        (shift, "friction = { coefficient = 0.3, junction_growth = 9.0 }\n"),
    ];
    for (keys, tables) in cases {
        let case =
            moving(3, 4).replace("20 mN", "10 mN").replace("stride = 4", &format!("stride = 4, {keys}"));
        let folder = folder_with("case.toml", &(case + tables));
        ok(&run(&folder, "case.toml --out whole"));
        change(&folder.path().join("case.toml"), "passes = 3", "passes = 1");
        ok(&run(&folder, "case.toml --out parts"));
        change(&folder.path().join("case.toml"), "passes = 1", "passes = 2");
        ok(&run(&folder, "case.toml --out parts --resume"));
        change(&folder.path().join("case.toml"), "passes = 2", "passes = 3");
        ok(&run(&folder, "case.toml --out parts --resume --threads 1"));
        assert_same_passes(&folder.path().join("parts"), &folder.path().join("whole"));
    }
}

#[test]
fn a_run_from_the_surfaces_of_a_pass_does_what_the_next_pass_did() {
    const TABLE: [&str; 4] = ["approach", "mean_load", "mean_contact_area", "max_pressure"];
    for keys in ["", "strategy = \"shift\", speed_lower = 0.0, speed_upper = 1.0, "] {
        let motion = moving(3, 4).replace("load_tolerance = 1e-6", &format!("{keys}load_tolerance = 1e-9"));
        let folder = folder_with("case.toml", &motion);
        ok(&run(&folder, "case.toml --out whole"));
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
        fs::write(folder.path().join("next.toml"), next).unwrap();
        let said = ok(&asperity(&folder, "check next.toml"));
        assert!(said.contains("results `upper`, 32 × 32 samples, an underside, mounted as it is"), "{said}");
        ok(&run(&folder, "next.toml --out next"));

        let passes = |directory: &str| {
            let passes = summary(&folder.path().join(directory))["passes"].clone();
            passes.as_array().unwrap().last().unwrap().clone()
        };
        let (whole, next) = (passes("whole"), passes("next"));
        for key in TABLE {
            let [found, expected] = [&next, &whole].map(|pass| number(&pass[key]));
            // Both are solved to η < 10⁻⁶, from different guesses.
            assert!((found / expected - 1.0).abs() < 1e-5, "{key}: {found} is not {expected}");
        }
        let fields = |path: &str| Fields::open(&folder.path().join(path)).unwrap();
        let (whole, next) = (fields("whole/fields/pass-0003.h5"), fields("next/fields/pass-0001.h5"));
        for name in ["lower", "upper"] {
            let [found, expected] = [&next, &whole].map(|fields| field(fields, name, "m").values);
            for (found, expected) in found.iter().zip(&expected) {
                assert!((found - expected).abs() < 1e-13, "{name}: {found:e} is not {expected:e}");
            }
        }
    }
}

#[test]
fn the_fields_of_results_are_topographies() {
    let folder = folder_with("case.toml", &moving(1, 8));
    ok(&run(&folder, "case.toml --out moved"));
    fs::write(folder.path().join("case.toml"), BALL).unwrap();
    ok(&run(&folder, "case.toml --out pressed"));
    for (file, channels) in [
        ("moved/fields/initial.h5", "lower, upper"),
        ("moved/fields/pass-0001.h5", "lower, upper"),
        ("pressed/fields.h5", "lower, upper, displacement, gap, plastic"),
    ] {
        let told = ok(&asperity(&folder, &format!("surface info {file} --channel lower")));
        assert!(told.starts_with("format    results\nchannel   lower\n"), "{told}");
        assert!(told.contains(&format!("channels  {channels}\n")), "{told}");
        let told = ok(&asperity(&folder, &format!("surface info {file} --channel upper")));
        assert!(told.contains("an underside: as [upper] it is mounted as it is"), "{told}");
        ok(&asperity(&folder, &format!("surface convert {file} out.npy --channel upper --overwrite")));
        let found = ReadOptions::default().scan(folder.path().join("out.npy")).unwrap();
        let expected = field(&Fields::open(&folder.path().join(file)).unwrap(), "upper", "m");
        assert!(found.heights.iter().eq(expected.values.iter()), "{file}");
    }
    let refused = refused(&asperity(&folder, "surface info pressed/fields.h5 --channel pressure"));
    assert!(refused.contains("no height channel `pressure`"), "{refused}");
    assert!(refused.contains("it holds `lower`, `upper`"), "{refused}");
}

#[test]
fn a_motion_without_what_its_next_pass_begins_with_is_not_resumed() {
    let folder = folder_with("case.toml", &moving(1, 8));
    ok(&run(&folder, "case.toml --out out"));
    change(&folder.path().join("case.toml"), "20 mN", "21 mN");
    ok(&run(&folder, "case.toml --out other"));
    change(&folder.path().join("case.toml"), "21 mN", "20 mN");
    let name = "fields/state-0001.h5";
    let [path, other] = ["out", "other"].map(|results| folder.path().join(results).join(name));
    let whole = fs::read(&path).unwrap();
    // Nothing is left to do: what is not needed is not missed.
    fs::remove_file(&path).unwrap();
    ok(&run(&folder, "case.toml --out out --resume"));
    change(&folder.path().join("case.toml"), "passes = 1", "passes = 2");
    let refused_for = |defect: &str| {
        let error = refused(&run(&folder, "case.toml --out out --resume"));
        assert!(error.starts_with(&format!("error: out/{name}{defect}")), "{error}");
    };
    refused_for(" is missing\n");
    fs::write(&path, &whole[..whole.len() / 2]).unwrap();
    refused_for(": HDF5 format error: unexpected EOF: ");
    fs::copy(other, &path).unwrap();
    refused_for(" is of another run\n");
    fs::write(&path, whole).unwrap();
    ok(&run(&folder, "case.toml --out out --resume"));
}

#[test]
fn the_results_of_another_case_are_not_resumed() {
    let folder = folder_with("case.toml", &moving(1, 8));
    ok(&run(&folder, "case.toml --out out"));
    let before = files(&folder.path().join("out"));
    change(&folder.path().join("case.toml"), "20 mN", "21 mN");
    let error = refused(&run(&folder, "case.toml --out out --resume"));
    assert!(error.starts_with("error: out holds the results of another case"), "{error}");
    assert!(error.contains("hint: "), "{error}");
    assert_eq!(files(&folder.path().join("out")), before);
    let error = refused(&run(&folder, "case.toml --out out --resume --overwrite"));
    assert!(error.contains("cannot be used with"), "{error}");
}

#[test]
fn a_case_is_known_again_from_another_folder_and_by_numbers_of_any_length() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("sub")).unwrap();
    let at = |arguments: &str| asperity(&folder, arguments);
    ok(&at(
        "surface generate low-pass --shape 32x32 --pitch 1um --sq 35nm --cutoff 8um --seed 1 --out sub/a.npy",
    ));
    let case = moving(1, 8)
        .replace(
            "generate = \"low-pass\", shape = [32, 32], pitch = \"1 um\", sq = \"35 nm\", cutoff = \"8 um\", seed = 1",
            "file = \"a.npy\", pitch = \"0.32412785700896 um\"",
        )
        .replace("pitch = \"1 um\"", "pitch = \"0.32412785700896 um\"")
        .replace("cutoff = \"8 um\"", "cutoff = \"3.333333333333331 um\"")
        .replace("\"35 nm\"", "3.080618546467441e-08")
        .replace("20 mN", "2.0173912345678901 mN");
    fs::write(folder.path().join("sub/case.toml"), case).unwrap();
    ok(&at("run sub/case.toml --out out"));
    ok(&at("run sub/case.toml --out out --resume"));
    let inside = Command::new(program())
        .args(["run", "case.toml", "--out", "../out", "--resume"])
        .current_dir(folder.path().join("sub"))
        .output()
        .unwrap();
    ok(&inside);
}

#[test]
#[cfg(unix)]
fn a_run_that_is_interrupted_goes_on_where_it_was() {
    stopped_and_resumed("INT", Some(130));
}

#[test]
#[cfg(unix)]
fn a_run_that_is_killed_goes_on_where_it_was() {
    stopped_and_resumed("KILL", None);
}

/// A motion without end is stopped by a signal, then resumed for two passes more.
fn stopped_and_resumed(signal: &str, code: Option<i32>) {
    let folder = folder_with("case.toml", &moving(100_000, 4));
    let out = folder.path().join("out");
    let mut child = spawn(&folder, "run case.toml --out out");
    wait_for(&mut child, &out.join("passes.csv"));
    send(signal, &child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), code, "{}", stderr(&output));
    if signal == "INT" {
        // A row for each pass that is there.
        let rows = table_of(&out.join("passes.csv"), &PASS_COLUMNS).len();
        assert_eq!(String::from_utf8_lossy(&output.stdout).lines().count(), 4 + rows);
        let told = stderr(&output);
        assert!(told.ends_with("error: interrupted\nhint: continue with `--resume`\n"), "{told}");
    }
    assert!(!out.join("summary.json").exists() && !out.join("figures").exists());

    let done = Results::open(&out).unwrap().passes().unwrap().len();
    assert!(done >= 1);
    // A moment later: the positions and fields of the next pass were there, its row was not yet.
    let rows = fs::read_to_string(out.join("steps.csv")).unwrap();
    let of_pass = |pass: usize| rows.lines().skip(1).filter(move |row| row.starts_with(&format!("{pass},")));
    let kept: Vec<&str> = rows.lines().take(1).chain((1..=done).flat_map(of_pass)).collect();
    let next: Vec<String> =
        of_pass(done).map(|row| row.replacen(&done.to_string(), &(done + 1).to_string(), 1)).collect();
    fs::write(out.join("steps.csv"), kept.join("\n") + "\n" + &next.join("\n") + "\n").unwrap();
    for name in ["pass", "state"] {
        let [from, to] = [done, done + 1].map(|pass| out.join(format!("fields/{name}-{pass:04}.h5")));
        fs::copy(from, to).unwrap();
    }
    fs::copy(out.join(format!("fields/state-{done:04}.h5")), out.join("fields/state-0000.h5")).unwrap();
    fs::write(out.join("fields/.asperity-half"), "half").unwrap();

    change(&folder.path().join("case.toml"), "passes = 100000", &format!("passes = {}", done + 2));
    ok(&run(&folder, "case.toml --out out --resume"));
    ok(&run(&folder, "case.toml --out whole"));
    assert_same_passes(&out, &folder.path().join("whole"));
    assert_eq!(files(&out), files(&folder.path().join("whole")));
}

#[test]
#[cfg(unix)]
fn a_static_contact_is_interrupted_at_once() {
    let slow = BALL.replace("[32, 32]", "[512, 512]").replace(
        "load = \"20 mN\"",
        "load = \"20 mN\"\nmethod = \"polonsky-keer\"\ntolerance = 1e-15\nboundary = \"free\"",
    );
    let folder = folder_with("ball.toml", &slow);
    let mut child = spawn(&folder, "run ball.toml --out out");
    wait_for(&mut child, &folder.path().join("out/.lock"));
    std::thread::sleep(Duration::from_millis(100));
    let began = Instant::now();
    send("INT", &child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    assert!(began.elapsed() < Duration::from_secs(2), "{:?}", began.elapsed());
    assert_eq!(stderr(&output), "error: interrupted\n");
}

// ---- bad input -------------------------------------------------------------------------------------------

/// Each case of `data/` begins with the exit code, the error and the hint that it must produce.
#[test]
fn every_bad_input_has_its_own_message() {
    let folder = tempfile::tempdir().unwrap();
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    for entry in fs::read_dir(data).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, folder.path().join(path.file_name().unwrap())).unwrap();
    }
    let before = files(folder.path());
    let cases: Vec<_> = before.iter().filter(|name| name.ends_with(".toml")).collect();
    assert!(cases.len() >= 14, "{cases:?}");
    for name in cases {
        let text = fs::read_to_string(folder.path().join(name)).unwrap();
        let promised: Vec<&str> = text.lines().map_while(|line| line.strip_prefix("# ")).collect();
        let code: i32 = promised[0].strip_prefix("exit code ").unwrap().parse().unwrap();
        let output = run(&folder, &format!("{name} --out out"));
        let messages: Vec<String> = stderr(&output)
            .lines()
            .filter(|line| line.starts_with("error: ") || line.starts_with("hint: "))
            .map(str::to_owned)
            .collect();
        let kept =
            promised[1..].iter().zip(&messages).all(|(promised, message)| as_promised(promised, message));
        let all = messages.len() == promised.len() - 1;
        assert!(kept && all && output.status.code() == Some(code), "{name}: {promised:#?}\n{messages:#?}");
        assert!(output.stdout.is_empty(), "{name}");
        // What is wrong before anything is computed leaves no directory behind.
        let out = folder.path().join("out");
        assert!(code == 1 || !out.exists(), "{name}");
        let _ = fs::remove_dir_all(out);
    }
    assert_eq!(files(folder.path()), before);
}

#[test]
fn bad_usage_of_run_is_exit_code_2() {
    let folder = folder_with("case.toml", &moving(1, 8));
    for arguments in
        ["", "nowhere.toml", "case.toml --threads 0", "case.toml --threads many", "case.toml --example hertz"]
    {
        refused(&run(&folder, arguments));
    }
    assert_eq!(files(folder.path()), ["case.toml".to_owned()].into());
}

// ---- helpers ---------------------------------------------------------------------------------------------

/// Two rough steel surfaces of 32 × 32 cells that yield a little.
fn moving(passes: usize, stride: usize) -> String {
    let body = |name: &str, seed: usize| {
        format!(
            "{name} = {{ young = \"210 GPa\", poisson = 0.3, hardness = \"4 GPa\", topography = {{ \
             generate = \"low-pass\", shape = [32, 32], pitch = \"1 um\", sq = \"35 nm\", cutoff = \"8 um\", \
             seed = {seed} }} }}\n"
        )
    };
    format!(
        "{}{}contact = {{ load = \"20 mN\" }}\n\
         motion = {{ passes = {passes}, stride = {stride}, load_tolerance = 1e-6 }}\n\
         output = {{ pressure_every = 4 }}\n",
        body("lower", 1),
        body("upper", 2)
    )
}

/// A ball that sinks into a softer plane.
const BALL: &str = r#"
[lower]
young = "210 GPa"
poisson = 0.3
hardness = "1 GPa"
topography = { form = "flat", shape = [32, 32], pitch = "1 um" }
[upper]
young = "210 GPa"
poisson = 0.3
topography = { form = "sphere", radius = "0.1 mm", shape = [32, 32], pitch = "1 um" }
[contact]
load = "20 mN"
"#;

/// The ball, elastic, with what follows [contact].
fn pushed(tables: &str) -> String {
    format!("{}{tables}", BALL.replace("hardness = \"1 GPa\"\n", ""))
}

/// Half of what friction holds, in three steps.
const PUSH: &str =
    "[friction]\ncoefficient = 0.3\nincrements = 2\n[[history]]\nforce = \"3 mN\"\nincrements = 3\n";

fn folder_with(name: &str, text: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join(name), text).unwrap();
    folder
}

#[test]
fn the_table_of_bodies_that_run_in_counts_the_passes_of_the_motion() {
    let folder = tempfile::tempdir().unwrap();
    let body = "young = 210e9\npoisson = 0.3\n[NAME.topography]\ngenerate = \"self-affine\"\nshape = [16, 16]\n\
                pitch = 1e-6\nsq = 20e-9\nhurst = 0.8\nshortest = 4e-6\nseed = 1\n[NAME.wear]\n\
                coefficient = 1e-17\n";
    let bodies = ["lower", "upper"].map(|name| format!("[{name}]\n{}", body.replace("NAME", name))).concat();
    let case = format!(
        "{bodies}[contact]\nmean_pressure = 50e6\nboundary = \"periodic\"\n[motion]\nstrategy = \"shift\"\n\
         speed_upper = 0.5\npasses = 20000\nstride = 8\n[acceleration]\n[output]\npressure_every = 0\n"
    );
    fs::write(folder.path().join("case.toml"), case).unwrap();
    let table = ok(&run(&folder, "case.toml --out results"));
    let lines: Vec<Vec<&str>> = table.lines().map(|line| line.split_whitespace().collect()).collect();
    let heads = lines.iter().find(|words| words.first() == Some(&"pass")).unwrap();
    assert_eq!(heads[2..], ["load", "p", "max", "area", "Sq", "lower", "Sq", "upper", "wear"], "{table}");
    let rows: Vec<f64> = lines.iter().filter_map(|words| words.first()?.parse().ok()).collect();
    assert!(rows.starts_with(&[1.0, 3.0]) && rows.ends_with(&[20_000.0]), "{table}");
    // k W s of both bodies, whatever stood for what.
    let worn: f64 = lines.last().unwrap().last().unwrap().parse().unwrap();
    let volume = 2.0 * 1e-17 * 50e6 * (16e-6f64).powi(2) * 20_000.0 * 16e-6 / 1e-18;
    assert!((worn / volume - 1.0).abs() < 2e-3, "{worn} µm³, not {volume}");
    assert!(table.lines().all(|line| line.chars().count() <= 80 || line.contains(';')), "{table}");
}

/// `asperity run`; `arguments` are split at spaces.
fn run(folder: &TempDir, arguments: &str) -> Output {
    asperity(folder, &format!("run {arguments}"))
}

/// Whether a message is the one promised, in which … stands for a number that is nothing but rounding.
fn as_promised(promised: &str, message: &str) -> bool {
    match promised.split_once('…') {
        Some((before, after)) => message.starts_with(before) && message.ends_with(after),
        None => message == promised,
    }
}

fn summary(directory: &Path) -> Value {
    serde_json::from_slice(&fs::read(directory.join("summary.json")).unwrap()).unwrap()
}

fn keys(value: &Value) -> BTreeSet<String> {
    value.as_object().unwrap().keys().cloned().collect()
}

fn set<const N: usize>(names: [&str; N]) -> BTreeSet<String> {
    names.map(str::to_owned).into()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// The numbers of a table that has these columns.
fn table(path: &Path, columns: &[&str]) -> Vec<Vec<f64>> {
    let text = fs::read_to_string(path).unwrap();
    let (head, rows) = text.split_once('\n').unwrap();
    assert_eq!(head, columns.join(","));
    rows.lines().map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect()).collect()
}

/// The rows of a table that has these columns, each by its column.
fn table_of(path: &Path, columns: &'static [&'static str]) -> Vec<BTreeMap<&'static str, f64>> {
    let rows = table(path, columns).into_iter();
    rows.map(|row| columns.iter().copied().zip(row).collect()).collect()
}

/// A field of cells of 1 µm, with its unit and axes as promised.
#[track_caller]
fn field(fields: &Fields, name: &str, unit: &str) -> StoredField {
    let field = fields.read(name).unwrap();
    assert_eq!((field.unit.as_str(), field.axes.as_str()), (unit, "x,y"), "{name}");
    assert_eq!(field.pitch, [1e-6, 1e-6], "{name}");
    field
}

/// Two runs of one case that took different ways to their passes.
#[track_caller]
fn assert_same_passes(found: &Path, expected: &Path) {
    // All but the time of a pass is the same to the last bit.
    let untimed = |directory: &Path| -> Vec<PassRecord> {
        let mut passes = Results::open(directory).unwrap().passes().unwrap();
        passes.iter_mut().for_each(|pass| pass.wall_time_s = 0.0);
        passes
    };
    assert_eq!(untimed(found), untimed(expected));
    let bytes = |path: &Path| fs::read(path).unwrap();
    assert!(bytes(&found.join("steps.csv")) == bytes(&expected.join("steps.csv")), "steps.csv differs");
    let fields = files(&expected.join("fields"));
    assert_eq!(files(&found.join("fields")), fields);
    for name in fields {
        let [found, expected] =
            [found, expected].map(|directory| bytes(&directory.join("fields").join(&name)));
        assert!(found == expected, "fields/{name} differs");
    }
}

/// A position at which nothing touches is one of the others: its temperature is that of no cell, and all is drawn.
#[test]
fn a_heated_motion_with_positions_apart_is_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let body = |name: &str, seed: usize| {
        format!(
            "[{name}]\nyoung = \"210 GPa\"\npoisson = 0.3\nconductivity = 46\nheat_capacity = 460\ndensity = 7850\n\
             topography = {{ generate = \"low-pass\", shape = [24, 8], pitch = \"1 um\", sq = \"100 nm\", cutoff = \"6 um\", seed = {seed} }}\n"
        )
    };
    let text = format!(
        "{}{}[contact]\nload = \"20 mN\"\n[friction]\ncoefficient = 0.1\n[motion]\nspeed = 1\n\
         [temperature]\nbulk = \"100 °C\"\n[output]\npressure_every = 1\n",
        body("lower", 1),
        body("upper", 2)
    );
    std::fs::write(folder.path().join("case.toml"), text).unwrap();
    ok(&asperity(&folder, "run case.toml --out results --quiet"));
    let results = folder.path().join("results");
    let steps = std::fs::read_to_string(results.join("steps.csv")).unwrap();
    let loads = steps.lines().skip(1).map(|row| row.split(',').nth(5).unwrap().parse::<f64>().unwrap());
    assert!(loads.into_iter().any(|load| load == 0.0), "all positions touch: {steps}");
    for file in ["figures/temperature.png", "figures/pressure.png", "report.html"] {
        assert!(results.join(file).is_file(), "{file}");
    }
}
