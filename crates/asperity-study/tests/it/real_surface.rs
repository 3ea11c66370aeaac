//! A measured surface, as written by an instrument, against a generated one: from the file to the last pass.
//!
//! The file is `x3p-2.x3p` in the folder that `ASPERITY_TOPOGRAPHIES` names.

use std::path::PathBuf;

use asperity_study::Outcome;

use crate::support::{parsed, run};

#[test]
#[ignore = "reads measured files, which are not part of the repository"]
fn a_measured_surface_runs_in_against_a_generated_one() {
    let folder = std::env::var_os("ASPERITY_TOPOGRAPHIES")
        .expect("ASPERITY_TOPOGRAPHIES names the folder of measured files");
    let file = PathBuf::from(folder).join("x3p-2.x3p");
    // The 230 × 230 samples of the file cover 83.0 µm × 204.5 µm.
    let body = "young = \"210 GPa\"\npoisson = 0.3\nhardness = \"4 GPa\"\n";
    let text = format!(
        "[lower]\n{body}[lower.topography]\nfile = {file:?}\nlevel = \"plane\"\nresample = [64, 64]\n\
         [upper]\n{body}[upper.topography]\ngenerate = \"self-affine\"\nshape = [64, 64]\n\
         pitch = [\"1.29651142803584 um\", \"3.1949745904 um\"]\nsq = \"30 nm\"\nhurst = 0.8\n\
         rolloff = \"40 um\"\nshortest = \"12 um\"\nseed = 3\n\
         [contact]\nload = \"1 N\"\n[motion]\npasses = 2\nstride = 4\n"
    );
    let folder = tempfile::tempdir().unwrap();
    let (summary, results) = run(&parsed(&text), folder.path());
    let Outcome::Passes(passes) = summary.outcome else { panic!("{:?}", summary.outcome) };
    assert_eq!(passes.len(), 2);
    for pass in &passes {
        assert!((pass.mean_load - 1.0).abs() <= 1e-4, "{pass:?}");
        assert!(pass.max_pressure == 4e9 && pass.lost("plastic")[0] > 0.0, "{pass:?}");
    }
    assert!(passes[1].lost("plastic")[0] < passes[0].lost("plastic")[0], "it runs in");
    let steps = results.steps().unwrap();
    assert_eq!(steps.len(), 2 * 31);
    for step in &steps {
        assert!(step.residual < 1e-6, "{step:?}");
    }
}
