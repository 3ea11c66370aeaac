//! A load sweep of a static contact: each point is an independent contact, and its stiffness is the slope of the curve.

use std::fs;

use asperity_base::Error;
use asperity_contact::motion::Watch;
use asperity_contact::reference::HertzLine;
use asperity_study::Case;
use asperity_study::Outcome;
use asperity_study::{Existing, Results};

use crate::support::StopAfter;

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

/// Carter, Proc. R. Soc. A 112, 151 (1926): Q/μW = 1 − (1 − ξR/μa)², gross slip from ξ = μa/R on.
#[test]
fn through_creepages_a_cylinder_draws_carters_curve() {
    let folder = tempfile::tempdir().unwrap();
    let case = Case::parse(ROLLING, "case.toml".as_ref(), "".as_ref()).unwrap();
    let out = folder.path().join("out");
    let (summary, _) =
        asperity_study::run(&case, asperity_study::SurfaceInput::default(), &out, Existing::Keep, &())
            .unwrap();
    let Outcome::Sweep(points) = &summary.outcome else { panic!() };
    let modulus = 210e9 / (2.0 * (1.0 - 0.09));
    let hertz = HertzLine { radius: 5e-3, modulus, load_per_length: 0.04 / 2e-6 };
    let (a, friction) = (hertz.half_width(), 0.2);
    for (point, creepage) in points.iter().zip([2e-3f64, 4e-4, 0.0, -1e-3]) {
        let share = (creepage.abs() * 5e-3 / (friction * a)).min(1.0);
        let expected = creepage.signum() * friction * (1.0 - (1.0 - share).powi(2));
        let found = point.tangential_force_x / point.load;
        assert!((found - expected).abs() < 0.03 * friction, "{creepage}: {found}, Carter {expected}");
        assert_eq!((point.creepage_x, point.creepage_y), (creepage, 0.0));
        // Equal to a single contact, to the bit.
        let one = ROLLING
            .replace("[2e-3, 4e-4, 0, -1e-3]", &format!("{creepage:e}"))
            .replace("creepages", "creepage");
        let case = Case::parse(&one, "case.toml".as_ref(), "".as_ref()).unwrap();
        let alone = folder.path().join(format!("alone-{}", point.point));
        let Outcome::Static(alone) =
            asperity_study::run(&case, asperity_study::SurfaceInput::default(), &alone, Existing::Keep, &())
                .unwrap()
                .0
                .outcome
        else {
            panic!()
        };
        assert_eq!(point.tangential_force_x, alone.shear.unwrap().tangential_force[0]);
    }
    // Interrupted after any point, it continues to the same bytes.
    for count in 1..4 {
        let broken = folder.path().join(format!("broken-{count}"));
        let stopped = asperity_study::run(
            &case,
            asperity_study::SurfaceInput::default(),
            &broken,
            Existing::Keep,
            &StopAfter::steps(count),
        );
        assert!(matches!(stopped, Err(Error::Interrupted)));
        asperity_study::run(&case, asperity_study::SurfaceInput::default(), &broken, Existing::Resume, &())
            .unwrap();
        for file in ["sweep.csv", "fields.h5"] {
            assert_eq!(
                fs::read(broken.join(file)).unwrap(),
                fs::read(out.join(file)).unwrap(),
                "{count}: {file}"
            );
        }
    }
    let written = fs::read_to_string(out.join("case.json")).unwrap();
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
    let folder = tempfile::tempdir().unwrap();
    let case = Case::parse(STEADY, "case.toml".as_ref(), "".as_ref()).unwrap();
    let run = |out: &std::path::Path, existing, watch: &dyn Watch| {
        asperity_study::run(&case, asperity_study::SurfaceInput::default(), out, existing, watch)
    };
    let whole = folder.path().join("whole");
    let (summary, _) = run(&whole, Existing::Keep, &()).unwrap();
    let Outcome::Sweep(points) = &summary.outcome else { panic!() };
    let drags: Vec<f64> = points.iter().map(|point| point.steady.unwrap().drag_coefficient).collect();
    assert!(
        drags.iter().all(|drag| *drag > 1e-3)
            && points.windows(2).all(|pair| pair[0].contact_area > pair[1].contact_area)
    );
    assert!(points.iter().all(|point| point.stiffness.is_none()));
    for count in 1..4 {
        let broken = folder.path().join(format!("broken-{count}"));
        assert!(matches!(run(&broken, Existing::Keep, &StopAfter::steps(count)), Err(Error::Interrupted)));
        run(&broken, Existing::Resume, &()).unwrap();
        for file in ["sweep.csv", "fields.h5"] {
            assert!(
                fs::read(broken.join(file)).unwrap() == fs::read(whole.join(file)).unwrap(),
                "{count}: {file}"
            );
        }
    }
}

#[test]
fn an_interrupted_sweep_goes_on_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let case = Case::parse(CASE, "case.toml".as_ref(), "".as_ref()).unwrap();
    let whole = folder.path().join("whole");
    let (summary, _) =
        asperity_study::run(&case, asperity_study::SurfaceInput::default(), &whole, Existing::Keep, &())
            .unwrap();
    let Outcome::Sweep(points) = &summary.outcome else { panic!() };
    assert_eq!(points, &Results::open(&whole).unwrap().sweep().unwrap());
    assert!(
        points[5].plastic_area > 0.0 && points.windows(2).all(|pair| pair[0].stiffness < pair[1].stiffness)
    );
    for count in 1..6 {
        let broken = folder.path().join(format!("broken-{count}"));
        let stopped = asperity_study::run(
            &case,
            asperity_study::SurfaceInput::default(),
            &broken,
            Existing::Keep,
            &StopAfter::steps(count),
        );
        assert!(matches!(stopped, Err(Error::Interrupted)));
        assert_eq!(Results::open(&broken).unwrap().sweep().unwrap(), points[..count]);
        asperity_study::run(&case, asperity_study::SurfaceInput::default(), &broken, Existing::Resume, &())
            .unwrap();
        let files = [
            "sweep.csv",
            "fields.h5",
            "fields/point-0001.h5",
            "fields/point-0003.h5",
            "fields/point-0005.h5",
        ];
        for file in files {
            assert!(
                fs::read(broken.join(file)).unwrap() == fs::read(whole.join(file)).unwrap(),
                "{count}: {file}"
            );
        }
        assert_eq!(fs::read_dir(broken.join("fields")).unwrap().count(), 3);
    }
    // Damaged files, and those of another sweep, are refused.
    let broken = folder.path().join("broken-3");
    fs::remove_file(broken.join("fields/point-0003.h5")).unwrap();
    let error =
        asperity_study::run(&case, asperity_study::SurfaceInput::default(), &broken, Existing::Resume, &())
            .err()
            .unwrap()
            .to_string();
    assert!(error.ends_with("point-0003.h5 is missing"), "{error}");
    let other = Case::parse(&CASE.replace("0.3 N", "0.4 N"), "case.toml".as_ref(), "".as_ref()).unwrap();
    let error =
        asperity_study::run(&other, asperity_study::SurfaceInput::default(), &whole, Existing::Resume, &())
            .err()
            .unwrap()
            .to_string();
    assert!(error.contains("'contact.loads."), "{error}");
}

#[test]
fn the_fields_of_points_are_those_of_their_contacts() {
    let folder = tempfile::tempdir().unwrap();
    let case = Case::parse(CASE, "case.toml".as_ref(), "".as_ref()).unwrap();
    let out = folder.path().join("out");
    asperity_study::run(&case, asperity_study::SurfaceInput::default(), &out, Existing::Keep, &()).unwrap();
    let results = Results::open(&out).unwrap();
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
