//! Elasto-plastic bodies, from the case to the results.

use asperity_contact::motion::{Regime, StaticRecord};
use asperity_study::{Case, Outcome, Results, SurfaceInput};
use ndarray::Array3;

use crate::support::{at_rest, parsed, run, written};

/// A ball of 1 mm on a flat body that yields at 1.5 GPa, or does not. Yield begins at 5.5 N, at a depth of
/// half the contact radius, 33 µm.
fn case(load: &str, plasticity: &str, rest: &str) -> Case {
    parsed(&format!(
        "[lower]\nyoung = \"210 GPa\"\npoisson = 0.3\n{plasticity}[lower.topography]\nform = \"flat\"\nshape = [24, 24]\n\
         pitch = \"6 um\"\n[upper]\nyoung = \"210 GPa\"\npoisson = 0.3\n[upper.topography]\nform = \"sphere\"\nradius = \"1 mm\"\n\
         [contact]\nload = \"{load}\"\n{rest}"
    ))
}

const FLOWS: &str = "[lower.plasticity]\nyield_stress = \"1.5 GPa\"\nhardening = \"5 GPa\"\n";
const VOLUME: &str = "[plasticity]\ndepth = \"72 um\"\nlayers = 10\nincrements = 4\n";

fn record(outcome: &Outcome) -> &StaticRecord {
    match outcome {
        Outcome::Static(record) => record,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_ball_that_yields_leaves_a_dent_and_residual_stress() {
    let folder = tempfile::tempdir().unwrap();
    let (summary, results) = run(&case("20 N", FLOWS, VOLUME), folder.path());
    let record = record(&summary.outcome);
    let flow = record.plastic.as_ref().unwrap();
    let left = flow.residual.as_ref().unwrap();
    assert_eq!(flow.regime, Regime::Yields);
    // Below the middle of the contact, at about half its radius.
    let [x, y, z] = flow.max_plastic_strain_position;
    assert!(
        (x - 72e-6).abs() < 5e-6 && (y - 72e-6).abs() < 5e-6 && (8e-6..40e-6).contains(&z),
        "{x} {y} {z}"
    );
    assert!(flow.plastic_work > flow.stored_energy && flow.stored_energy > 0.0, "{flow:?}");
    // Unloading is elastic: the plastic strain stays.
    assert!((left.residual_max_plastic_strain / flow.max_plastic_strain - 1.0).abs() < 0.05);
    assert!(left.residual_displaced_volume > 0.0 && left.residual_max_residual_tension > 1e8, "{left:?}");
    let increments = results.increments().unwrap();
    assert_eq!(increments.len(), 8);
    let loads: Vec<f64> = increments.iter().map(|increment| increment.load).collect();
    for (found, expected) in loads.iter().zip([5.0, 10.0, 15.0, 20.0, 15.0, 10.0, 5.0, 0.0]) {
        assert!((found - expected).abs() < 1e-6, "{loads:?}");
    }
    let work: f64 =
        increments.iter().filter_map(|increment| increment.plastic).map(|flow| flow.plastic_work).sum();
    assert!((work / left.residual_plastic_work - 1.0).abs() < 1e-12, "{work:e} {left:?}");

    let volumes = results.plastic_fields(None).unwrap();
    let read =
        |name: &str| -> Array3<f64> { volumes.read(name).unwrap().values.into_dimensionality().unwrap() };
    let strain = ["xx", "yy", "zz"].map(|component| read(&format!("strain_{component}_lower")));
    let trace = &strain[0] + &strain[1] + &strain[2];
    assert!(trace.iter().all(|trace| trace.abs() < 1e-12), "flow keeps the volume");
    let accumulated = read("accumulated_lower");
    assert_eq!(accumulated.shape(), [24, 24, 10]);
    let largest = accumulated.iter().fold(0.0, |most: f64, strain| most.max(*strain));
    assert_eq!(largest, flow.max_plastic_strain);
    // The dent is deepest in the middle, and the surfaces include it.
    let dent = volumes.read("displacement_lower").unwrap().into_field().unwrap();
    let deepest = dent.indexed_iter().max_by(|a, b| a.1.total_cmp(b.1)).unwrap().0;
    assert!((10..14).contains(&deepest.0) && (10..14).contains(&deepest.1), "{deepest:?}");
    assert!((written(&results, "lower") + &dent).iter().all(|z| z.abs() < 1e-15));
    // The gap is that of the deformed bodies: closed where they touch.
    let [gap, pressure] = ["gap", "pressure"].map(|name| written(&results, name));
    let open =
        gap.iter().zip(&pressure).filter(|(_, p)| **p > 0.0).fold(0.0, |most: f64, (g, _)| most.max(g.abs()));
    assert!(open < 1e-5 * record.approach, "{open:e}");
}

/// A stage continues from the end of the one before, in load or approach, in its own equal steps, or by
/// default in those of the volume.
#[test]
fn a_contact_that_slides_goes_on_sliding_while_its_load_is_taken_off() {
    let slides = format!("[friction]\ncoefficient = 0.2\nsliding = [3, 4]\n{VOLUME}");
    let slid = at_rest(&case("20 N", FLOWS, &slides));
    let loads: Vec<f64> = slid.increments.iter().map(|increment| increment.load).collect();
    assert_eq!((loads.len(), loads[loads.len() - 1]), (8, 0.0));
    for increment in &slid.increments {
        let force = [increment.tangential_force_x, increment.tangential_force_y];
        for (force, part) in force.into_iter().zip([0.12, 0.16]) {
            assert!((force - part * increment.load).abs() <= 1e-9, "{increment:?}");
        }
    }
    assert!(record(&slid.outcome).plastic.as_ref().unwrap().residual.is_some());
}

#[test]
fn stages_go_in_their_own_steps() {
    let stages = "[[history]]\nload = \"8 N\"\nincrements = 2\n[[history]]\napproach = \"1.2 um\"\n";
    let staged = at_rest(&case("16 N", FLOWS, &format!("{VOLUME}unload = false\n{stages}")));
    let increments = &staged.increments;
    let stages: Vec<usize> = increments.iter().map(|increment| increment.stage).collect();
    assert_eq!(stages, [1, 1, 1, 1, 2, 2, 3, 3, 3, 3]);
    for (increment, load) in increments.iter().zip([4.0, 8.0, 12.0, 16.0, 12.0, 8.0]) {
        assert!((increment.load - load).abs() < 1e-6, "{increment:?}");
    }
    let from = increments[5].approach;
    for (increment, part) in increments[6..].iter().zip([0.25, 0.5, 0.75, 1.0]) {
        let expected = from + part * (1.2e-6 - from);
        assert!((increment.approach / expected - 1.0).abs() < 1e-9, "{increment:?} {expected:e}");
    }
}

#[test]
fn a_depth_that_is_none_and_flow_that_leaves_the_volume_are_told() {
    let depth = |depth: &str| VOLUME.replace("72 um", depth);
    for (shallow, told) in
        [("5 um", "'depth' is 5 µm, expected from a cell, 6 µm"), ("1 mm", "'depth' is 1 mm")]
    {
        let error = asperity_study::static_contact(
            &case("20 N", FLOWS, &depth(shallow)),
            SurfaceInput::default(),
            &(),
        )
        .unwrap_err();
        assert!(error.to_string().contains(told), "{error}");
    }
    let [thin, whole] = [depth("18 um"), VOLUME.to_owned()]
        .map(|volume| at_rest(&case("20 N", FLOWS, &volume)).warnings.join("\n"));
    assert!(thin.contains("yields in its deepest layer"), "{thin}");
    assert!(!whole.contains("deepest layer") && whole.contains("more than 15 %"), "{whole}");
}

/// Below a ball that has yielded, the stress is the elastic plus the residual stress; it continues below the
/// volume.
#[test]
fn the_stress_below_bodies_that_flow_is_whole() {
    let folder = tempfile::tempdir().unwrap();
    let depths = "[subsurface]\nto = \"100.8 um\"\nlayers = 28\nsection = \"75 um\"\ncolumns = [[\"75 um\", \"75 um\"]]\n";
    let volume = VOLUME.replace("unload", "") + "unload = false\n";
    let results_of = |plasticity: &str, name: &str, rest: &str| {
        run(&case("20 N", plasticity, rest), &folder.path().join(name)).1
    };
    let flows = results_of(FLOWS, "flows", &format!("{volume}{depths}"));
    let elastic = results_of("", "elastic", depths);
    let read = |results: &Results, name: &str| {
        results.subsurface_fields(None).unwrap().read(name).unwrap().into_field().unwrap()
    };
    // Plastic flow has reduced the peak.
    let most = |results: &Results| read(results, "section_von_mises").iter().fold(0.0f64, |m, s| m.max(*s));
    assert!(most(&flows) < 0.8 * most(&elastic), "{:e} {:e}", most(&flows), most(&elastic));
    assert!(most(&flows) < 1.15 * (1.5e9 + 5e9 * 0.05), "{:e}", most(&flows));
    // In the middle of the first layer, at a depth of 3.6 µm, it equals the residual stress of the volume.
    let residual = flows.plastic_fields(None).unwrap().read("residual_stress_xx_lower").unwrap().values;
    let residual = residual.into_dimensionality::<ndarray::Ix3>().unwrap();
    let section = read(&flows, "section_residual_xx");
    let largest = residual.iter().fold(0.0f64, |m, s| m.max(s.abs()));
    for layer in 0..10 {
        for ix in 0..24 {
            let (a, b) = (section[[ix, 2 * layer + 1]], residual[[ix, 12, layer]]);
            assert!((a - b).abs() < 1e-9 * largest, "{layer} {ix}: {a:e} {b:e}");
        }
    }
    // Below the volume it decays.
    let deep = section.column(28).iter().fold(0.0f64, |m, s| m.max(s.abs()));
    let last = section.column(19).iter().fold(0.0f64, |m, s| m.max(s.abs()));
    assert!(deep > 0.0 && deep < 0.8 * last, "{deep:e} {last:e}");
    let column = flows.subsurface_fields(None).unwrap().read("column_01_residual_xx").unwrap().values;
    assert_eq!(column[[1]], section[[12, 1]]);
    assert!(elastic.subsurface_fields(None).unwrap().read("section_residual_xx").is_err());
}
