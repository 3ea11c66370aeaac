//! Contacts that a device solves: its solver in plain loops, which needs no device, and the errors where there is none.

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use crate::support::{asperity, ok, refused};

const CASE: &str = r#"
[lower]
young = "210 GPa"
poisson = 0.3
topography = { generate = "self-affine", hurst = 0.8, sdq = 0.1, shortest = "4 um", shape = [32, 32], pitch = "1 um", seed = 1 }
[upper]
young = "210 GPa"
poisson = 0.3
topography = { form = "flat" }
[contact]
load = "0.1 N"
"#;

const STUDY: &str = "base = \"case.toml\"\n[axes]\n\"contact.load\" = [\"0.1 N\", \"0.2 N\"]\n";

fn with(text: &str) -> TempDir {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("case.toml"), text).unwrap();
    folder
}

fn summary(folder: &TempDir, results: &str) -> Value {
    serde_json::from_str(&fs::read_to_string(folder.path().join(results).join("summary.json")).unwrap())
        .unwrap()
}

/// The largest relative difference of the numbers of a contact or a pass, under these keys.
fn difference(found: &Value, expected: &Value) -> f64 {
    const KEYS: [&str; 6] = ["load", "approach", "contact_area", "max_pressure", "mean_gap", "mean_load"];
    match (found, expected) {
        (Value::Object(found), Value::Object(expected)) => expected.iter().fold(0.0, |most, (key, value)| {
            let inner = match (found[key].as_f64(), value.as_f64()) {
                (Some(one), Some(other)) if KEYS.contains(&key.as_str()) => {
                    (one - other).abs() / other.abs().max(1e-300)
                }
                _ => difference(&found[key], value),
            };
            f64::max(most, inner)
        }),
        (Value::Array(found), Value::Array(expected)) => {
            assert_eq!(found.len(), expected.len());
            found
                .iter()
                .zip(expected)
                .fold(0.0, |most, (found, expected)| most.max(difference(found, expected)))
        }
        _ => 0.0,
    }
}

#[test]
fn a_contact_on_a_device_is_that_of_the_processor_and_says_so_in_its_case() {
    let folder = with(CASE);
    ok(&asperity(&folder, "run case.toml --out cpu --quiet"));
    ok(&asperity(&folder, "run case.toml --out host --device host --quiet"));
    let difference = difference(&summary(&folder, "host"), &summary(&folder, "cpu"));
    assert!(difference < 1e-5, "{difference:e}");
    let case = |results: &str| fs::read_to_string(folder.path().join(results).join("case.json")).unwrap();
    assert!(case("host").contains(r#""device": "host""#) && !case("cpu").contains("device"));
    // Results of another device are not continued.
    let resumed = refused(&asperity(&folder, "run case.toml --out host --resume"));
    assert!(resumed.contains("device"), "{resumed}");
}

#[test]
fn without_a_gpu_the_error_says_what_was_looked_for_and_found() {
    let folder = with(CASE);
    fs::write(folder.path().join("study.toml"), STUDY).unwrap();
    for command in
        ["run case.toml --device cuda", "check case.toml --device cuda", "study study.toml --device cuda"]
    {
        let output = asperity(&folder, command);
        if !output.status.success() {
            let error = refused(&output);
            assert!(error.contains("no device for `cuda`: looked for a GPU of NVIDIA"), "{error}");
            assert!(error.contains("found") && error.contains("the processor solves the contact"), "{error}");
            assert!(!folder.path().join("study").exists(), "nothing is begun");
        }
    }
    assert!(refused(&asperity(&folder, "run case.toml --device gpu")).contains("cpu, cuda, host"));
}

#[test]
fn a_device_named_on_the_command_line_breaks_the_rules_of_the_case() {
    let folder = with(&format!("{CASE}[adhesion]\nwork = \"50 mJ/m2\"\nrange = \"0.5 um\"\n"));
    let error = refused(&asperity(&folder, "check case.toml --device host"));
    assert!(error.contains("a device does not solve adhesive contacts"), "{error}");
    assert!(error.contains("case.toml:12:"), "{error}");
}

#[test]
fn a_study_on_a_device_has_it_in_its_cases() {
    let folder = with(CASE);
    fs::write(folder.path().join("study.toml"), STUDY).unwrap();
    ok(&asperity(&folder, "study study.toml --device host --quiet"));
    let case = fs::read_to_string(folder.path().join("study/cases/0002/case.toml")).unwrap();
    assert!(case.contains(r#"device = "host""#), "{case}");
}

#[test]
#[ignore = "examples take long without full optimisation"]
fn on_a_device_the_examples_agree_with_the_processor() {
    for example in ["hertz", "quickstart", "measured", "seal"] {
        let folder = TempDir::new().unwrap();
        for device in ["cpu", "host"] {
            ok(&asperity(
                &folder,
                &format!("run --example {example} --out {device} --device {device} --quiet"),
            ));
        }
        let [found, expected] = ["host/results", "cpu/results"].map(|results| summary(&folder, results));
        let difference = difference(&found, &expected);
        // The load of a pass is met to 10⁻⁴.
        assert!(difference < 2e-4, "{example}: {difference:e}");
    }
}
