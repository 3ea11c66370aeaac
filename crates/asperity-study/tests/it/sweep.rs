//! A load sweep of a static contact: each point is an independent contact, and its stiffness is the slope of
//! the curve.

use std::fs;

use asperity_contact::motion::Watch;
use asperity_study::{Existing, Outcome, SurfaceInput};

use crate::resume::goes_on;
use crate::support::{StopAfter, at_rest, parsed, run};

// ---- from the case to its results ------------------------------------------------------------------------

const CASE: &str = r#"
[lower]
young = "210 GPa"
poisson = 0.3
hardness = "4 GPa"
topography = { form = "flat", shape = [40, 32], pitch = "1 um" }
[upper]
young = "210 GPa"
poisson = 0.3
topography = { generate = "self-affine", shape = [40, 32], pitch = "1 um", sdq = 0.05, hurst = 0.8, shortest = "6 um" }
[contact]
loads = { from = "1 mN", to = "0.3 N", points = 6 }
[output]
pressure_every = 2
"#;

/// A cylinder rolling at several creepages, with few outputs.
const ROLLING: &str = r#"
[lower]
young = "210 GPa"
poisson = 0.3
topography = { form = "flat", shape = [84, 2], pitch = "1 um" }
[upper]
young = "210 GPa"
poisson = 0.3
topography = { form = "cylinder", radius = "5 mm", shape = [84, 2], pitch = "1 um" }
[contact]
load = "40 mN"
boundary = ["free", "periodic"]
tolerance = 1e-4
[friction]
coefficient = 0.2
creepages = [2e-3, 4e-4, 0, -1e-3]
"#;

#[test]
fn a_sweep_through_creepages_goes_on_and_has_the_contacts_of_each_alone() {
    let whole = goes_on(&parsed(ROLLING));
    let Outcome::Sweep(points) = &whole.summary.outcome else { panic!() };
    for (point, creepage) in points.iter().zip([2e-3f64, 4e-4, 0.0, -1e-3]) {
        assert_eq!((point.creepage_x, point.creepage_y), (creepage, 0.0));
        let one = ROLLING
            .replace("[2e-3, 4e-4, 0, -1e-3]", &format!("{creepage:e}"))
            .replace("creepages", "creepage");
        let Outcome::Static(alone) = at_rest(&parsed(&one)).outcome else { panic!() };
        assert_eq!(point.tangential_force_x, alone.shear.unwrap().tangential_force[0]);
    }
    let found = |index: usize| points[index].tangential_force_x / points[index].load;
    assert!((found(0) / 0.2 - 1.0).abs() < 1e-6 && found(1) > 0.02 && found(1) < found(0), "{points:?}");
    let written = fs::read_to_string(whole.results.directory().join("case.json")).unwrap();
    assert!(written.contains("\"creepages\"") && !written.contains("\"creepage\""), "{written}");
}

/// A rough slider over rubber at several speeds.
const STEADY: &str = r#"
[lower]
young = "1 MPa"
poisson = 0.5
topography = { form = "flat", shape = [32, 32], pitch = "10 um" }
viscoelastic = { moduli = ["9 MPa", "90 MPa"], times = ["10 ms", "0.2 ms"] }
[upper]
young = "inf"
poisson = 0.3
topography = { generate = "self-affine", sdq = 0.1, hurst = 0.8, shortest = "80 um" }
[contact]
mean_pressure = "50 kPa"
boundary = "periodic"
[steady]
speeds = { from = "1 mm/s", to = "1 m/s", points = 4 }
"#;

#[test]
fn an_interrupted_curve_over_speed_goes_on_to_the_same_bits() {
    let Outcome::Sweep(points) = goes_on(&parsed(STEADY)).summary.outcome else { panic!() };
    assert!(points.iter().all(|point| point.steady.unwrap().drag_coefficient > 1e-3));
    assert!(points.windows(2).all(|pair| pair[0].contact_area > pair[1].contact_area));
    assert!(points.iter().all(|point| point.stiffness.is_none()));
}

#[test]
fn an_interrupted_sweep_goes_on_to_the_same_bits() {
    let whole = goes_on(&parsed(CASE));
    let Outcome::Sweep(points) = &whole.summary.outcome else { panic!() };
    assert_eq!(points, &whole.results.sweep().unwrap());
    assert!(
        points[5].plastic_area > 0.0 && points.windows(2).all(|pair| pair[0].stiffness < pair[1].stiffness)
    );
    assert_eq!(fs::read_dir(whole.results.directory().join("fields")).unwrap().count(), 3);
}

/// Damaged files, and those of another sweep, are refused.
#[test]
fn a_sweep_goes_on_from_its_own_whole_files_alone() {
    let folder = tempfile::tempdir().unwrap();
    let run = |text: &str, existing, watch: &dyn Watch| {
        asperity_study::run(&parsed(text), SurfaceInput::default(), folder.path(), existing, watch)
            .map(drop)
            .unwrap_err()
            .to_string()
    };
    run(CASE, Existing::Keep, &StopAfter::steps(3));
    let error = run(&CASE.replace("0.3 N", "0.4 N"), Existing::Resume, &());
    assert!(error.contains("'contact.loads."), "{error}");
    fs::remove_file(folder.path().join("fields/point-0003.h5")).unwrap();
    let error = run(CASE, Existing::Resume, &());
    assert!(error.ends_with("point-0003.h5 is missing"), "{error}");
}

#[test]
fn the_fields_of_points_are_those_of_their_contacts() {
    let folder = tempfile::tempdir().unwrap();
    let (_, results) = run(&parsed(CASE), folder.path());
    let field = |point: usize, name: &str| {
        results.point_fields(point).unwrap().read(name).unwrap().into_field().unwrap()
    };
    for record in results.sweep().unwrap().iter().step_by(2) {
        let (p, gap, plastic) =
            (field(record.point, "pressure"), field(record.point, "gap"), field(record.point, "plastic"));
        assert!((p.sum() * 1e-12 / record.load - 1.0).abs() < 1e-9);
        assert!((gap.mean().unwrap() / record.mean_gap - 1.0).abs() < 1e-9);
        assert!((plastic.sum() * 1e-12 - record.plastic_volume).abs() <= 1e-9 * record.plastic_volume);
        let apart = &gap + &plastic;
        let touching =
            p.iter().zip(&apart).filter(|(p, _)| **p > 0.0).map(|(_, g)| g.abs()).fold(0.0, f64::max);
        assert!(touching < 1e-5 * gap.std(0.0), "{touching}");
    }
}
