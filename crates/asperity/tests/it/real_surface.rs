//! A measured surface, as written by an instrument, against a generated one: from the file to the last pass.
//!
//! The file is `x3p-2.x3p` in the folder `ASPERITY_TOPOGRAPHIES`, by default `shared/topographies` beside the workspace.
//! Without it the test is skipped, but not in CI.

use std::path::{Path, PathBuf};

use asperity::study;
use asperity::study::Case;
use asperity::study::Outcome;
use asperity::study::{Existing, Results};

#[test]
fn a_measured_surface_runs_in_against_a_generated_one() {
    let Some(file) = measured("x3p-2.x3p") else { return };
    // The 230 × 230 samples of the file cover 83.0 µm × 204.5 µm.
    let body = "young = \"210 GPa\"\npoisson = 0.3\nhardness = \"4 GPa\"\n";
    let text = format!(
        "[lower]\n{body}[lower.topography]\nfile = {file:?}\nlevel = \"plane\"\nresample = [64, 64]\n\
         [upper]\n{body}[upper.topography]\ngenerate = \"self-affine\"\nshape = [64, 64]\n\
         pitch = [\"1.29651142803584 um\", \"3.1949745904 um\"]\nsq = \"30 nm\"\nhurst = 0.8\n\
         rolloff = \"40 um\"\nshortest = \"12 um\"\nseed = 3\n\
         [contact]\nload = \"1 N\"\n[motion]\npasses = 2\nstride = 4\n"
    );
    let case = Case::parse(&text, Path::new("real.toml"), Path::new("")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let summary =
        study::run(&case, asperity::study::SurfaceInput::default(), folder.path(), Existing::Keep, &())
            .unwrap()
            .0;

    let Outcome::Passes(passes) = summary.outcome else { panic!("{:?}", summary.outcome) };
    assert_eq!(passes.len(), 2);
    for pass in &passes {
        assert!((pass.mean_load - 1.0).abs() <= 1e-4, "{pass:?}");
        assert!(pass.max_pressure == 4e9 && pass.lost("plastic")[0] > 0.0, "{pass:?}");
    }
    assert!(passes[1].lost("plastic")[0] < passes[0].lost("plastic")[0], "it runs in");
    let steps = Results::open(folder.path()).unwrap().steps().unwrap();
    assert_eq!(steps.len(), 2 * 31);
    for step in &steps {
        assert!(step.residual < 1e-6, "{step:?}");
    }
}

fn measured(name: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("ASPERITY_TOPOGRAPHIES").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/topographies"),
        PathBuf::from,
    );
    let file = folder.join(name);
    let found = file.exists();
    assert!(found || std::env::var_os("CI").is_none(), "{} is missing", file.display());
    found.then_some(file)
}
