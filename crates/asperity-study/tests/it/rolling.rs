//! Elasto-plastic bodies that move over each other.

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use asperity_base::Error;
use asperity_contact::motion::{PassRecord, Progress, Watch};
use asperity_study::case::Case;
use asperity_study::{Existing, Results, Summary, SurfaceInput};

/// The ball in a case, with forward and return strokes at constant approach.
fn case(keep: &str) -> Case {
    let text = format!(
        "[lower]\nyoung = \"210 GPa\"\npoisson = 0.3\n[lower.plasticity]\nyield_stress = \"1.5 GPa\"\n\
         kinematic = \"20 GPa\"\nrecovery = 5\n[lower.topography]\nform = \"flat\"\nshape = [24, 12]\npitch = \"5 um\"\n\
         [upper]\nyoung = \"210 GPa\"\npoisson = 0.3\n[upper.plasticity]\nyield_stress = \"2 GPa\"\n\
         [upper.topography]\nform = \"sphere\"\nradius = \"0.5 mm\"\n[contact]\nload = \"6 N\"\nboundary = \"periodic\"\n\
         [plasticity]\ndepth = \"50 um\"\nlayers = 6\ngrowth = 1.2\nkeep = \"{keep}\"\n\
         [motion]\nstrategy = \"shift\"\npasses = 3\nstride = 2\n[friction]\ncoefficient = 0.1\n"
    );
    Case::parse(&text, Path::new("rolling.toml"), Path::new("")).unwrap()
}

/// Stops at a number of positions.
struct StopAt(AtomicUsize, usize);

impl Watch for StopAt {
    fn at(&self, _: &Progress) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }

    fn stop(&self) -> bool {
        self.0.load(Ordering::Relaxed) >= self.1
    }
}

/// Returns the complete content of results, without times.
fn content(out: &Path, passes: usize) -> (String, Vec<Vec<u8>>) {
    let results = Results::open(out).unwrap();
    let timeless: Vec<PassRecord> = results
        .passes()
        .unwrap()
        .into_iter()
        .map(|pass| {
            let mut pass = pass;
            pass.wall_time_s = 0.0;
            pass
        })
        .collect();
    let text = format!("{timeless:?}{:?}", results.steps().unwrap());
    let files = ["pass", "plasticity"].map(|name| out.join(format!("fields/{name}-{passes:04}.h5")));
    (text, files.map(|file| std::fs::read(file).unwrap()).to_vec())
}

#[test]
fn an_interrupted_motion_goes_on_to_the_same_bits_and_keeps_the_volumes_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let whole = folder.path().join("whole");
    let run = |keep: &str, out: &Path, existing, watch: &dyn Watch| -> asperity_base::Result<Summary> {
        asperity_study::run(&case(keep), SurfaceInput::default(), out, existing, watch)
            .map(|(summary, _)| summary)
    };
    let summary = run("last", &whole, Existing::Keep, &()).unwrap();
    let flow = summary.plasticity.unwrap();
    assert!(flow.plastic_work > 0.0 && flow.max_plastic_strain > 1e-4 && flow.stored_energy > 0.0);
    assert!(flow.max_residual_tension > 1e7 && flow.products > 50, "{flow:?}");
    let positions = Results::open(&whole).unwrap().steps().unwrap().len();
    assert_eq!(positions, 36);
    let expected = content(&whole, 3);
    for stop in [5, 30, 85] {
        let out = folder.path().join(format!("stopped-{stop}"));
        let stopped = run("last", &out, Existing::Keep, &StopAt(AtomicUsize::new(0), stop));
        assert!(matches!(stopped, Err(Error::Interrupted)), "{stop}: {:?}", stopped.map(|_| ()));
        let resumed = run("last", &out, Existing::Resume, &()).unwrap();
        assert!(content(&out, 3) == expected, "stopped at {stop}");
        assert_eq!(resumed.plasticity.unwrap(), flow);
        let kept: Vec<_> =
            (1..=3).filter(|pass| out.join(format!("fields/plasticity-{pass:04}.h5")).exists()).collect();
        assert_eq!(kept, [3]);
    }
    // Resumed after completion, it returns the same results.
    assert_eq!(run("last", &whole, Existing::Resume, &()).unwrap().plasticity.unwrap(), flow);
    let all = folder.path().join("all");
    run("passes", &all, Existing::Keep, &()).unwrap();
    let results = Results::open(&all).unwrap();
    let strain = |pass: usize| {
        let fields = results.plastic_fields(Some(pass)).unwrap();
        fields.read("accumulated_lower").unwrap().values.sum()
    };
    assert!(strain(1) > 0.0 && strain(1) < strain(2) && strain(2) < strain(3));
}

/// A motion whose results warn where its model is poor, and do not warn elsewhere.
#[test]
fn what_the_model_bears_badly_is_told() {
    let warnings = |edits: &[(&str, &str)]| {
        let mut text = String::from(
            "[lower]\nyoung = \"210 GPa\"\npoisson = 0.3\nplasticity = { yield_stress = \"1.5 GPa\" }\n[lower.topography]\n\
             form = \"flat\"\nshape = [48, 24]\npitch = \"5 um\"\n[upper]\nyoung = \"210 GPa\"\npoisson = 0.3\n[upper.topography]\n\
             form = \"sphere\"\nradius = \"0.5 mm\"\n[contact]\nload = \"5 N\"\nboundary = \"periodic\"\n[plasticity]\n\
             depth = \"80 um\"\nlayers = 12\ngrowth = 1.1\n[motion]\nstrategy = \"shift\"\ncontrol = \"step-load\"\npasses = 1\n",
        );
        for (is, becomes) in edits {
            assert!(text.contains(is), "{is}");
            text = text.replace(is, becomes);
        }
        let case = Case::parse(&text, Path::new("rolling.toml"), Path::new("")).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        asperity_study::run(&case, SurfaceInput::default(), &out, Existing::Keep, &())
            .unwrap()
            .0
            .warnings
            .join("\n")
    };
    assert_eq!(warnings(&[]), "");
    assert!(warnings(&[("\"80 um\"", "\"20 um\"")]).contains("yields in its deepest layer"));
    assert!(
        warnings(&[("layers = 12", "layers = 4")])
            .contains("more than a quarter of the width of the contact")
    );
    assert!(warnings(&[("passes = 1", "passes = 1\nstride = 4")]).contains("a stride of 4 cells is"));
    assert!(warnings(&[("\"5 N\"", "\"60 N\"")]).contains("the largest plastic strain is"));
    let overlap = [
        ("strategy = \"shift\"\n", ""),
        ("boundary = \"periodic\"", "boundary = \"free\""),
        ("form = \"sphere\"\nradius = \"0.5 mm\"", "form = \"flat\""),
        ("\"5 N\"", "\"1.5 N\""),
        ("[48, 24]", "[12, 10]"),
        ("\"80 um\"", "\"45 um\""),
        ("passes = 1", "passes = 1\nstride = 3"),
    ];
    let told = warnings(&overlap);
    assert!(told.contains("edges plough") && told.contains("yields at the edge of the grid"), "{told}");
}
