//! `asperity run` beyond the limits of the model: what it says, when, and what it leaves.

use std::fs;

use tempfile::TempDir;

use crate::support::{asperity, assert_has, assert_refused, change, failed, folder_with, ok, stderr};

/// A gear flank, 128 × 64 µm, both of whose bodies move under 400 MPa.
fn flank(wear: &str, friction: f64) -> TempDir {
    let body = |name: &str, grid: &str, seed: u64| {
        format!(
            "[{name}]\nyoung = \"210 GPa\"\npoisson = 0.3\nconductivity = \"46 W/(m K)\"\nheat_capacity = \"460 J/(kg K)\"\n\
             density = \"7850 kg/m3\"\n[{name}.topography]\ngenerate = \"low-pass\"\n{grid}sq = \"50 nm\"\ncutoff = \"64 um\"\n\
             seed = {seed}\n"
        )
    };
    let text = format!(
        "{}[lower.wear]\ncoefficient = {wear}\n{}[contact]\nmean_pressure = \"400 MPa\"\nboundary = \"periodic\"\n[motion]\n\
         strategy = \"shift\"\nspeed_lower = \"3 m/s\"\nspeed_upper = \"5 m/s\"\nstride = 4\npasses = 2\n[friction]\n\
         coefficient = {friction}\n[temperature]\nbulk = \"80 °C\"\n",
        body("lower", "shape = [16, 8]\npitch = \"8 um\"\n", 1),
        body("upper", "", 2)
    );
    folder_with("case.toml", &text)
}

#[test]
fn a_run_ends_in_the_pass_that_wears_its_body_away() {
    let folder = flank("1e-4", 0.1);
    let said = failed(&asperity(&folder, "run case.toml --out out"), 1);
    let error = said.lines().find(|line| line.starts_with("error: ")).unwrap();
    assert!(error.starts_with("error: pass 1: the lower body loses "), "{said}");
    assert!(error.ends_with("the longer side of its grid is 128 µm: it is no longer a surface"), "{said}");
    assert_has(&said, "\nhint: check the law of the body:  … `dimensionless`");
    let out = folder.path().join("out");
    assert!(out.join("report.html").exists() && !out.join("summary.json").exists());
    assert_refused(&folder, [("plot out", "out has no finished pass to draw")]);
}

/// The warning stands below the row of its pass, once, and is not repeated at the end.
#[test]
fn a_warning_of_a_pass_is_printed_with_the_pass() {
    let folder = flank("1e-16", 5.0);
    let output = asperity(&folder, "run case.toml --out out");
    ok(&output);
    let said = stderr(&output);
    let melts: Vec<_> = said.lines().filter(|line| line.contains("steel melts at 1800 K")).collect();
    assert!(melts.len() == 1 && melts[0].starts_with("warning: pass 1, position "), "{said}");
    let limits = folder.path().join("out/limits.csv");
    assert_has(&fs::read_to_string(&limits).unwrap(), ",\"temperature\",,");
    // A run that replaces it begins without limits.
    change(&folder.path().join("case.toml"), "coefficient = 5", "coefficient = 0.02");
    ok(&asperity(&folder, "run case.toml --out out --overwrite"));
    assert!(!limits.exists());
}
