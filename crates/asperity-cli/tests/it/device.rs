//! Contacts that a device solves: its solver in plain loops, which needs no device, and the errors where
//! there is none.

use std::fs;

use serde_json::Value;

use crate::support::{asperity, assert_has, assert_refused, folder_with, ok, refused, summary};

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

/// The largest relative difference of the numbers of a contact, or of passes. Those of the approach are relative to
/// the roughness, if it is larger: the approach may be near 0 by its datum.
fn difference(found: &Value, expected: &Value) -> f64 {
    let records = |summary: &Value| -> Vec<Value> {
        summary["passes"].as_array().cloned().unwrap_or_else(|| vec![summary["static"].clone()])
    };
    let (found, expected) = (records(found), records(expected));
    assert_eq!(found.len(), expected.len());
    let mut most = 0.0_f64;
    for (found, expected) in found.iter().zip(&expected) {
        for key in ["load", "approach", "contact_area", "max_pressure", "mean_gap", "mean_load"] {
            let (Some(one), Some(other)) = (found[key].as_f64(), expected[key].as_f64()) else { continue };
            let roughness =
                || ["sq_lower", "sq_upper"].iter().filter_map(|sq| expected[*sq].as_f64()).sum::<f64>();
            let scale = other.abs().max(if key == "approach" { roughness() } else { 1e-300 });
            most = most.max((one - other).abs() / scale);
        }
    }
    most
}

#[test]
fn a_contact_on_a_device_is_that_of_the_processor_and_says_so_in_its_case() {
    let folder = folder_with("case.toml", CASE);
    let path = |name: &str| folder.path().join(name);
    ok(&asperity(&folder, "run case.toml --out cpu --quiet"));
    ok(&asperity(&folder, "run case.toml --out host --device host --quiet"));
    let difference = difference(&summary(&path("host")), &summary(&path("cpu")));
    assert!(difference < 1e-5, "{difference:e}");
    let case = |results: &str| fs::read_to_string(path(results).join("case.json")).unwrap();
    assert!(case("host").contains(r#""device": "host""#) && !case("cpu").contains("device"));
    // Results of another device are not continued.
    assert_refused(&folder, [("run case.toml --out host --resume", "device")]);
}

#[test]
fn without_a_gpu_the_error_says_what_was_looked_for_and_found() {
    let folder = folder_with("case.toml", CASE);
    fs::write(folder.path().join("study.toml"), STUDY).unwrap();
    let told = "no device for `cuda`: looked for a GPU of NVIDIA … found … the processor solves the contact";
    for command in ["run case.toml", "check case.toml", "study study.toml"] {
        let output = asperity(&folder, &format!("{command} --device cuda"));
        if !output.status.success() {
            assert_has(&refused(&output), told);
            assert!(!folder.path().join("study").exists(), "nothing is begun");
        }
    }
    assert_refused(&folder, [("run case.toml --device gpu", "cpu, cuda, host")]);
}

#[test]
fn a_device_named_on_the_command_line_breaks_the_rules_of_the_case() {
    let adhesion = "[adhesion]\nwork = \"50 mJ/m2\"\nrange = \"0.5 um\"\n";
    let folder = folder_with("case.toml", &format!("{CASE}{adhesion}"));
    let told = "a device does not solve adhesive contacts … case.toml:12:";
    assert_refused(&folder, [("check case.toml --device host", told)]);
}

#[test]
fn a_study_on_a_device_has_it_in_its_cases() {
    let folder = folder_with("case.toml", CASE);
    fs::write(folder.path().join("study.toml"), STUDY).unwrap();
    ok(&asperity(&folder, "study study.toml --device host --quiet"));
    let case = fs::read_to_string(folder.path().join("study/cases/0002/case.toml")).unwrap();
    assert_has(&case, r#"device = "host""#);
}

#[test]
#[ignore = "examples take long without full optimisation"]
fn on_a_device_the_examples_agree_with_the_processor() {
    for example in ["hertz", "quickstart", "measured", "seal"] {
        let folder = tempfile::tempdir().unwrap();
        let [found, expected] = ["host", "cpu"].map(|device| {
            let run = format!("run --example {example} --out {device} --device {device} --quiet");
            ok(&asperity(&folder, &run));
            summary(&folder.path().join(device).join("results"))
        });
        let difference = difference(&found, &expected);
        // The load of a pass is met to 10⁻⁴.
        assert!(difference < 2e-4, "{example}: {difference:e}");
    }
}
