//! What `asperity run` prints, the files that it leaves, and its figures.

use std::fs;

use asperity::io::fields::Fields;
use asperity::study::Results;

use crate::support::{BALL, folder_with, moving, promised, run, set, summary};
use crate::support::{asperity, assert_has, assert_refused, files, ok, refused, stderr};

#[test]
fn a_motion_leaves_every_file_promised_and_nothing_else() {
    let folder = folder_with("case.toml", &moving(2, 4));
    let output = run(&folder, "case.toml");
    let table = ok(&output);
    // What the columns are, their heads and units, a line per pass.
    assert_eq!(table.lines().count(), 6, "{table}");
    assert!(table.lines().all(|line| line.chars().count() <= 80), "{table}");
    assert!(
        table.starts_with("load, area: means over the pass; apart: distance of the mean planes\n"),
        "{table}"
    );
    assert_has(&table, "inside: without the rim, 0.1 of the length at free ends; Sq, plastic too\n");
    assert!(table.lines().skip(4).all(|line| line.contains("   20.00  ")), "{table}");
    let said = stderr(&output);
    let (warnings, end) = said.trim_end().rsplit_once('\n').unwrap();
    assert!(warnings.lines().all(|line| line.starts_with("warning: ")), "{said}");
    assert_has(warnings, "a comb");
    assert_eq!(end, "results, figures and report.html in case-results");

    let results = folder.path().join("case-results");
    let expected = promised(
        "passes.csv steps.csv figures/pressure.gif
         fields/initial.h5 fields/pass-0001.h5 fields/pass-0002.h5 fields/state-0002.h5",
        "approach contact contact_area load material_ratio max_pressure mean_contact_area mean_pressure
         parameters plastic pressure pressure_histogram profile relief_lower relief_upper roughness solution
         spectrum topographies",
    );
    assert_eq!(files(&results), expected);
    assert_eq!(summary(&results)["version"], env!("CARGO_PKG_VERSION"));
}

#[test]
fn a_static_contact_leaves_every_file_promised_and_nothing_else() {
    let folder = folder_with("ball.toml", BALL);
    let table = ok(&run(&folder, "ball.toml --out results/of/ball"));
    assert!(table.starts_with("load              20 mN\nnominal pressure  19.53 MPa\napproach  "), "{table}");
    let results = folder.path().join("results/of/ball");
    let expected = promised(
        "fields.h5",
        "contact gap material_ratio plastic pressure pressure_histogram profile relief_upper spectrum
         topographies",
    );
    assert_eq!(files(&results), expected);
    assert_eq!(summary(&results)["static"]["converged"], true);
}

#[test]
fn the_stress_is_drawn_where_it_is_wanted_and_replaced_with_the_rest() {
    let folder = folder_with("case.toml", &format!("{BALL}\n[subsurface]\nto = \"5 um\"\nlayers = 10\n"));
    assert_has(&ok(&run(&folder, "case.toml --out out")), "\nlargest von Mises stress ");
    let out = folder.path().join("out");
    assert!(files(&out).is_superset(&set("subsurface.h5 figures/subsurface.png")));

    let case = moving(2, 4).replace("output", "subsurface = { to = 5e-6 }\noutput");
    fs::write(folder.path().join("case.toml"), case).unwrap();
    let table = ok(&run(&folder, "case.toml --out out --overwrite"));
    assert_has(&table, "\npass 2: largest von Mises stress ");
    let left = files(&out);
    let of_passes = set("fields/subsurface-0001.h5 fields/subsurface-0002.h5 figures/subsurface.png");
    assert!(left.is_superset(&of_passes) && !left.contains("subsurface.h5"), "{left:?}");
}

#[test]
fn figures_are_drawn_again_from_what_is_there() {
    let case = format!("{}subsurface = {{ to = 5e-6 }}\n", moving(1, 4));
    let folder = folder_with("case.toml", &case);
    ok(&run(&folder, "case.toml"));
    let figures = folder.path().join("case-results/figures");
    let before = files(&figures);
    let bytes = || ["topographies.png", "subsurface.png"].map(|name| fs::read(figures.join(name)).unwrap());
    let drawn = bytes();
    fs::remove_dir_all(&figures).unwrap();
    let listed = ok(&asperity(&folder, "plot case-results"));
    assert_eq!(listed.lines().count(), before.len());
    assert!(listed.lines().all(|path| folder.path().join(path).exists()), "{listed}");
    assert_eq!(files(&figures), before);
    assert!(bytes() == drawn);
    assert_refused(&folder, [("plot .", "holds no results of asperity")]);
}

#[test]
fn plot_draws_what_is_asked_for_in_the_format_and_width_of_a_page() {
    let folder = folder_with("ball.toml", BALL);
    ok(&run(&folder, "ball.toml --out out"));
    let figures = folder.path().join("out/figures");
    fs::remove_dir_all(&figures).unwrap();
    let wanted = "--only gap --only pressure --format pdf --width 85mm --range 0,2GPa";
    let drawn = ok(&asperity(&folder, &format!("plot out {wanted}")));
    assert_eq!(drawn, "out/figures/pressure.pdf\nout/figures/gap.pdf\n");
    assert_eq!(files(&figures), set("gap.pdf pressure.pdf"));
    // 85 mm are 240.94 pt.
    let bytes = fs::read(figures.join("gap.pdf")).unwrap();
    assert_has(&String::from_utf8_lossy(&bytes), "/MediaBox [0 0 240.94");
    ok(&asperity(&folder, "plot out --only pressure --format svg"));
    let svg = fs::read_to_string(figures.join("pressure.svg")).unwrap();
    assert_has(&svg, ">pressure (GPa)</text> … load 20 mN</text>");
    assert_refused(
        &folder,
        [
            ("plot out --only presure", "no figure `presure` … hint: there are topographies, "),
            ("plot out --range 0,1GPa", "--range without --only"),
            ("plot out --dpi 0", "--dpi"),
            ("plot out --width 1um", "--width"),
            ("plot out --only gap --range 1GPa,0", "--range"),
            ("plot out --format bmp", "--format"),
        ],
    );
}

#[test]
fn a_pass_has_the_mean_area_of_its_positions_and_the_roughness_of_its_fields() {
    let folder = folder_with("case.toml", &moving(2, 4));
    ok(&run(&folder, "case.toml"));
    let results = Results::open(&folder.path().join("case-results")).unwrap();
    let steps = results.steps().unwrap();
    // Offsets of −28, −24, … 28 of 32 columns.
    assert_eq!(steps.len(), 2 * 15);
    for (rows, pass) in steps.chunks(15).zip(&results.passes().unwrap()) {
        let area = rows.iter().map(|row| row.contact_area).sum::<f64>() / 15.0;
        assert!((area / pass.mean_contact_area - 1.0).abs() < 1e-12);
        let fields = results.fields_after(pass.pass).unwrap();
        for (name, sq) in [("lower", pass.sq_lower), ("upper", pass.sq_upper)] {
            let heights = fields.read(name).unwrap().into_field().unwrap();
            assert!((heights.std(0.0) / sq - 1.0).abs() < 1e-12);
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
    let case = moving(2, 4).replacen("210 GPa", "70 GPa", 1) + "friction = { coefficient = 0.3 }\n";
    let folder = folder_with("case.toml", &case);
    let two = run(&folder, "case.toml --out two --threads 2");
    let one = run(&folder, "case.toml --out one --threads 1 --quiet");
    assert!(!ok(&two).is_empty());
    // Warnings are left.
    assert_eq!(ok(&one), "");
    assert!(stderr(&one).lines().all(|line| line.starts_with("warning: ")), "{}", stderr(&one));
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    for name in ["steps.csv", "fields/pass-0002.h5", "figures/pressure.png", "figures/friction.png"] {
        assert!(bytes(&format!("one/{name}")) == bytes(&format!("two/{name}")), "{name} differs");
    }
}

#[test]
fn an_example_runs_in_a_folder_of_its_own_and_is_replaced_on_request() {
    let folder = tempfile::tempdir().unwrap();
    assert_has(&ok(&run(&folder, "--example hertz")), "largest pressure");
    assert!(folder.path().join("hertz/case/case.toml").exists());
    assert!(folder.path().join("hertz/results/summary.json").exists());
    refused(&run(&folder, "--example hertz"));
    ok(&run(&folder, "--example hertz --overwrite"));
    refused(&run(&folder, "--example nonsense"));
}

#[test]
fn the_table_of_bodies_that_run_in_counts_the_passes_of_the_motion() {
    let body = "{ young = 210e9, poisson = 0.3, wear = { coefficient = 1e-17 }, topography = { generate = \
                \"self-affine\", shape = [16, 16], pitch = 1e-6, sq = 20e-9, hurst = 0.8, shortest = 4e-6, \
                seed = 1 } }";
    let case = format!(
        "lower = {body}\nupper = {body}\ncontact = {{ mean_pressure = 50e6, boundary = \"periodic\" }}\n\
         motion = {{ strategy = \"shift\", speed_upper = 0.5, passes = 20000, stride = 8 }}\n\
         acceleration = {{}}\noutput = {{ pressure_every = 0 }}\n"
    );
    let folder = folder_with("case.toml", &case);
    let table = ok(&run(&folder, "case.toml --out results"));
    let lines: Vec<Vec<&str>> = table.lines().map(|line| line.split_whitespace().collect()).collect();
    let heads = lines.iter().find(|words| words.first() == Some(&"pass")).unwrap();
    assert_eq!(heads[2..].join(" "), "load p max area Sq lower Sq upper wear", "{table}");
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

/// A position at which nothing touches is one of the others: its temperature is that of no cell, and all is
/// drawn.
#[test]
fn a_heated_motion_with_positions_apart_is_drawn() {
    let heat = "conductivity = 46, heat_capacity = 460, density = 7850, hardness";
    let case = moving(1, 1)
        .replace("hardness", heat)
        .replace("[32, 32]", "[24, 8]")
        .replace("\"35 nm\", cutoff = \"8 um\"", "\"100 nm\", cutoff = \"6 um\"")
        .replace("stride = 1", "stride = 1, speed = 1")
        .replace("pressure_every = 4", "pressure_every = 1");
    let tables = "friction = { coefficient = 0.1 }\ntemperature = { bulk = \"100 °C\" }\n";
    let folder = folder_with("case.toml", &(case + tables));
    ok(&run(&folder, "case.toml --out results --quiet"));
    let results = folder.path().join("results");
    let steps = Results::open(&results).unwrap().steps().unwrap();
    assert!(steps.iter().any(|step| step.load == 0.0), "all positions touch");
    assert!(files(&results).is_superset(&set("figures/temperature.png figures/pressure.png report.html")));
}
