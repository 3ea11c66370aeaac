//! Viscoelastic bodies under a history: creep, relaxation, resuming.

use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use asperity_base::Error;
use asperity_contact::motion::{Progress, Watch};
use asperity_study::{Case, Existing, Outcome, Results, SurfaceInput};

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

/// Stops after some increments.
struct StopAfter(usize, AtomicUsize);

impl Watch for StopAfter {
    fn at(&self, progress: &Progress) {
        self.1.store(progress.solved, Relaxed);
    }

    fn stop(&self) -> bool {
        self.1.load(Relaxed) >= self.0
    }
}

fn run(out: &Path, existing: Existing, watch: &dyn Watch) -> Result<Outcome, Error> {
    let case = Case::parse(CASE, "case.toml".as_ref(), "".as_ref()).unwrap();
    asperity_study::run(&case, SurfaceInput::default(), out, existing, watch)
        .map(|(summary, _)| summary.outcome)
}

#[test]
fn rubber_creeps_under_a_load_and_relaxes_at_an_approach() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), Existing::Keep, &()).unwrap();
    let increments = Results::open(folder.path()).unwrap().increments().unwrap();
    let time = |index: usize| increments[index].creep.unwrap().time;
    assert_eq!(increments.len(), 1 + 12 + 2 + 12);
    assert!(time(0) == 0.0 && (time(12) - 200.0).abs() < 1e-9 && (time(26) - 400.1).abs() < 1e-9);
    // Hertz with the glassy modulus at once, and with the relaxed one in the end, as closely as the grid has them.
    let hertz = |modulus: f64| (9.0 * 5e-3f64.powi(2) / (16.0 * 1e-3 * modulus.powi(2))).cbrt();
    for (index, modulus) in [(0, 12e6 / 0.75), (12, 1e6 / 0.75)] {
        let error = increments[index].approach / hertz(modulus) - 1.0;
        assert!(error.abs() < 0.02, "{index}: {error}");
    }
    // In the end it changes by less than the tolerance.
    assert!(increments[..13].windows(2).all(|pair| pair[1].approach > (1.0 - 1e-5) * pair[0].approach));
    assert!(increments[14].load > increments[26].load && increments[26].load > increments[12].load);
}

#[test]
fn an_interrupted_history_goes_on_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let whole = folder.path().join("whole");
    run(&whole, Existing::Keep, &()).unwrap();
    for count in [1, 7, 14, 20] {
        let broken = folder.path().join(format!("broken-{count}"));
        let stopped = run(&broken, Existing::Keep, &StopAfter(count, AtomicUsize::new(0)));
        assert!(matches!(stopped, Err(Error::Interrupted)), "{count}");
        run(&broken, Existing::Resume, &()).unwrap();
        for file in ["increments.csv", "fields.h5"] {
            let [found, expected] = [&broken, &whole].map(|folder| fs::read(folder.join(file)).unwrap());
            assert!(found == expected, "{count}: {file}");
        }
    }
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
    let drag = |text: &str| {
        let case = Case::parse(text, "case.toml".as_ref(), "".as_ref()).unwrap();
        let rest = asperity_study::rest(&case, SurfaceInput::default(), &()).unwrap();
        let Outcome::Sweep(points) = rest.outcome else { panic!() };
        points[0].steady.unwrap().drag_coefficient
    };
    // Williams, Landel and Ferry: log₁₀ a_T = −8.9 · 20/(102 + 20).
    let factor = 10f64.powf(-8.9 * 20.0 / 122.0);
    let warm = drag(&text("wlf_c1 = 8.9, wlf_c2 = \"102 K\", wlf_at = \"20 °C\"", 1e-3 / factor));
    let shifted =
        text(&format!("shift = {factor}"), 1e-3 / factor).replace("temperature = { bulk = \"40 °C\" }", "");
    let cold = text("shift = 1.0", 1e-3).replace("temperature = { bulk = \"40 °C\" }", "");
    assert!((warm / drag(&shifted) - 1.0).abs() < 1e-9 && (warm / drag(&cold) - 1.0).abs() < 1e-9, "{warm}");
}
