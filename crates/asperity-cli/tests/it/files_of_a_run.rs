//! What `asperity run` leaves: files, tables, numbers, figures.

use std::collections::BTreeSet;
use std::fs;

use asperity::io::fields::Fields;
use asperity::study::{PASS_COLUMNS, STEP_COLUMNS};
use asperity::study::{Results, pressure_name};
use serde_json::{Value, json};

use crate::support::{BALL, field, folder_with, keys, moving, number, run, set, summary, table};
use crate::support::{asperity, files, ok, refused, stderr};

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
        [".lock", "case.json", "passes.csv", "report.html", "results.csv", "steps.csv", "summary.json"]
            .map(str::to_owned),
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
    expected.extend(
        [".lock", "case.json", "fields.h5", "report.html", "results.csv", "summary.json"].map(str::to_owned),
    );
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
    let [.., row, answer] = &lines[..] else { panic!("{table}") };
    let worn: f64 = row.last().unwrap().parse().unwrap();
    assert_eq!((answer[0], answer[2]), ("wear", "µm³;"), "{table}");
    let volume = 2.0 * 1e-17 * 50e6 * (16e-6f64).powi(2) * 20_000.0 * 16e-6 / 1e-18;
    assert!((worn / volume - 1.0).abs() < 2e-3, "{worn} µm³, not {volume}");
    assert!(table.lines().all(|line| line.chars().count() <= 80 || line.contains(';')), "{table}");
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
