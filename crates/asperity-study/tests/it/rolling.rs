//! Elasto-plastic bodies that move over each other.

use asperity_study::Case;

use crate::resume::goes_on;
use crate::support::{parsed, run};

/// The ball in a case, with forward and return strokes at constant approach.
fn case(keep: &str) -> Case {
    parsed(&format!(
        "[lower]\nyoung = \"210 GPa\"\npoisson = 0.3\n[lower.plasticity]\nyield_stress = \"1.5 GPa\"\n\
         kinematic = \"20 GPa\"\nrecovery = 5\n[lower.topography]\nform = \"flat\"\nshape = [24, 12]\npitch = \"5 um\"\n\
         [upper]\nyoung = \"210 GPa\"\npoisson = 0.3\n[upper.plasticity]\nyield_stress = \"2 GPa\"\n\
         [upper.topography]\nform = \"sphere\"\nradius = \"0.5 mm\"\n[contact]\nload = \"6 N\"\nboundary = \"periodic\"\n\
         [plasticity]\ndepth = \"50 um\"\nlayers = 6\ngrowth = 1.2\nkeep = \"{keep}\"\n\
         [motion]\nstrategy = \"shift\"\npasses = 3\nstride = 2\n[friction]\ncoefficient = 0.1\n"
    ))
}

#[test]
fn an_interrupted_motion_goes_on_to_the_same_bits_and_keeps_the_volumes_asked_for() {
    let whole = goes_on(&case("last"));
    let flow = whole.summary.plasticity.unwrap();
    assert!(flow.plastic_work > 0.0 && flow.max_plastic_strain > 1e-4 && flow.stored_energy > 0.0);
    assert!(flow.max_residual_tension > 1e7 && flow.products > 50, "{flow:?}");
    assert_eq!(whole.results.steps().unwrap().len(), 36);
    let file = |pass: usize| whole.results.directory().join(format!("fields/plasticity-{pass:04}.h5"));
    assert_eq!((1..=3).filter(|pass| file(*pass).exists()).collect::<Vec<_>>(), [3]);
    let folder = tempfile::tempdir().unwrap();
    let (_, results) = run(&case("passes"), folder.path());
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
        run(&parsed(&text), tempfile::tempdir().unwrap().path()).0.warnings.join("\n")
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
