//! The stress under the surface, from a case file to its results.

use std::path::Path;

use asperity::io::case::Case;
use asperity::io::engine;
use asperity::io::fields::Attribute;
use asperity::io::results::{Existing, Results, pressure_name};
use asperity::io::summary::{Outcome, Summary};
use asperity::reference::{HertzSphere, SlidingSphere};
use asperity::stress::{Component, Stress};

/// A ball on a plane, about 16 cells in contact along its radius.
const BALL: &str = r#"
lower = { young = "210 GPa", poisson = 0.3, topography = { form = "flat", shape = [48, 48], pitch = "1 um" } }
upper = { young = "70 GPa", poisson = 0.2, topography = { form = "sphere", radius = "1 mm", shape = [48, 48], pitch = "1 um" } }
contact = { load = "0.4 N" }
"#;

/// Rough bodies in motion; the positions 1, 5, 9, … are kept.
const MOVING: &str = r#"
lower = { young = "210 GPa", poisson = 0.3, hardness = "4 GPa", topography = { generate = "low-pass", shape = [32, 32], pitch = "1 um", sq = "35 nm", cutoff = "8 um", seed = 1 } }
upper = { young = "210 GPa", poisson = 0.3, topography = { generate = "low-pass", shape = [32, 32], pitch = "1 um", sq = "35 nm", cutoff = "8 um", seed = 2 } }
contact = { load = "20 mN" }
motion = { passes = 2, stride = 4 }
output = { pressure_every = 4 }
"#;

fn run(case: &str, subsurface: &str, directory: &Path, existing: Existing) -> Summary {
    let text = format!("{case}\n[subsurface]\n{subsurface}");
    let case = Case::parse(&text, Path::new("case.toml"), Path::new("")).unwrap();
    engine::run(&case, directory, existing, &()).unwrap().0
}

#[test]
fn a_ball_yields_below_the_surface_where_hertz_says_in_either_body() {
    let modulus = 1.0 / ((1.0 - 0.09) / 210e9 + (1.0 - 0.04) / 70e9);
    let normal = HertzSphere { radius: 1e-3, modulus, load: 0.4 };
    let a = normal.contact_radius();
    for (body, poisson) in [("lower", 0.3), ("upper", 0.2)] {
        let directory = tempfile::tempdir().unwrap();
        let wanted = format!("to = {a:e}\nlayers = 30\nbody = \"{body}\"");
        let summary = run(BALL, &wanted, directory.path(), Existing::Keep);
        let [record] = &summary.subsurface[..] else { panic!("{:?}", summary.subsurface) };
        let exact = SlidingSphere { normal, friction: 0.0, poisson };
        let at = |z: f64| exact.stress([0.0; 2], z);
        let (depth, most) = (1..1000)
            .map(|k| (1e-3 * f64::from(k) * a, at(1e-3 * f64::from(k) * a).von_mises()))
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap();
        let [x, y, z] = record.position;
        assert!((record.max_von_mises / most - 1.0).abs() < 2e-3, "{body}: {record:?}, {most:e}");
        assert!((record.max_shear / at(depth).max_shear() - 1.0).abs() < 2e-3, "{body}: {record:?}");
        assert!((z - depth).abs() < 0.02 * a, "{body}: {z:e}, {depth:e}");
        // The apex stands where four cells meet.
        assert!((x - 24e-6).abs() < 0.6e-6 && (y - 24e-6).abs() < 0.6e-6, "{record:?}");
        assert_eq!((record.pass, record.step), (None, None));
    }
}

#[test]
fn the_stress_is_one_wherever_it_is_kept_and_bears_the_pressure() {
    let directory = tempfile::tempdir().unwrap();
    let wanted = "to = \"8 um\"\nlayers = 4\nplanes = [\"4 um\", 0]\nsection = \"20.2 um\"\n\
                  columns = [[\"30.7 um\", \"20 um\"], [0, 48e-6]]";
    run(BALL, wanted, directory.path(), Existing::Keep);
    let results = Results::open(directory.path()).unwrap();
    let stress = results.subsurface_fields(None).unwrap();
    assert_eq!(stress.names().unwrap().len(), 2 + 7 + 12);
    let attributes = stress.attributes().unwrap();
    assert_eq!(attributes["section"], 20.5e-6.into());
    assert_eq!(attributes["planes"], vec![4e-6, 0.0].into());
    let Attribute::Numbers(columns) = &attributes["columns"] else { panic!("{attributes:?}") };
    // The rim belongs to the last cell.
    let expected = [30.5e-6, 20.5e-6, 0.5e-6, 47.5e-6];
    assert!(columns.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-18));
    let section = |name: &str| stress.read(&format!("section_{name}")).unwrap();
    let stored = section("xx");
    assert_eq!((stored.axes.as_str(), stored.unit.as_str()), ("x,z", "Pa"));
    assert_eq!((&stored.pitch[..], &stored.origin[..]), (&[1e-6, 2e-6][..], &[0.5e-6, 0.0][..]));

    let column = |k: usize, component: &str| {
        let column = stress.read(&format!("column_{k:02}_{component}")).unwrap();
        assert_eq!((column.axes.as_str(), column.values.len(), column.pitch[0]), ("z", 5, 2e-6));
        column.values
    };
    for component in Component::ALL.map(Component::name) {
        let (section, column) = (section(component).into_field().unwrap(), column(1, component));
        assert_eq!(section.row(30).to_vec(), column.iter().copied().collect::<Vec<_>>(), "{component}");
    }
    let pressure = results.static_fields().unwrap().read("pressure").unwrap().into_field().unwrap();
    let zz = section("zz").into_field().unwrap();
    let peak = pressure.iter().fold(0.0f64, |m, p| m.max(*p));
    for ix in 0..48 {
        assert!((zz[[ix, 0]] + pressure[[ix, 20]]).abs() < 1e-12 * peak);
    }
    let plane = stress.read("von_mises_01").unwrap().into_field().unwrap();
    let surface = stress.read("von_mises_02").unwrap().into_field().unwrap();
    let von_mises = section("von_mises").into_field().unwrap();
    for ix in 0..48 {
        assert_eq!((von_mises[[ix, 2]], von_mises[[ix, 0]]), (plane[[ix, 20]], surface[[ix, 20]]));
        let at = Component::ALL.map(|component| section(component.name()).into_field().unwrap()[[ix, 2]]);
        assert_eq!(Stress::from_components(at).von_mises(), von_mises[[ix, 2]]);
    }
}

#[test]
fn a_motion_leaves_the_stress_of_each_pass_and_goes_on() {
    let directory = tempfile::tempdir().unwrap();
    let wanted = "to = \"6 um\"\nlayers = 6\nstep = 9";
    let first = run(MOVING, wanted, directory.path(), Existing::Keep);
    assert_eq!(
        first.subsurface.iter().map(|r| (r.pass, r.step)).collect::<Vec<_>>(),
        [(Some(1), Some(9)), (Some(2), Some(9))]
    );
    let results = Results::open(directory.path()).unwrap();
    for pass in 1..=2 {
        // The position of the offset 4: its first column is the lower body's fifth.
        let stress = results.subsurface_fields(Some(pass)).unwrap();
        let zz = stress.read("section_zz").unwrap();
        let Attribute::Number(y) = stress.attributes().unwrap()["section"] else { panic!() };
        assert_eq!(y, first.subsurface[pass - 1].position[1], "through the most stressed point");
        let row = (y / 1e-6) as usize;
        assert_eq!((zz.values.shape(), zz.origin[0]), (&[28, 7][..], 4.5e-6));
        let pressure = results.fields_after(pass).unwrap().read(&pressure_name(9)).unwrap();
        assert_eq!(pressure.origin[0], zz.origin[0]);
        let (zz, pressure) = (zz.into_field().unwrap(), pressure.into_field().unwrap());
        let peak = pressure.iter().fold(0.0f64, |m, p| m.max(*p));
        assert!((0..28).any(|ix| pressure[[ix, row]] > 0.1 * peak));
        assert!((0..28).all(|ix| (zz[[ix, 0]] + pressure[[ix, row]]).abs() < 1e-12 * peak));
    }
    let more = MOVING.replace("passes = 2", "passes = 3");
    let all = run(&more, wanted, directory.path(), Existing::Resume);
    assert_eq!((&all.subsurface[..2], all.subsurface[2].pass), (&first.subsurface[..], Some(3)));
    assert_eq!(results.summary().unwrap(), all);

    // Left out, the position is that at which all faces all: the eighth of 7 + 1 + 7.
    run(MOVING, "to = \"6 um\"\nlayers = 6", directory.path(), Existing::Overwrite);
    let flush = results.subsurface_fields(Some(2)).unwrap();
    assert_eq!(flush.attributes().unwrap()["step"], 8.into());
    assert!(results.subsurface_fields(Some(3)).is_err(), "it was replaced");
}

#[test]
fn deep_under_a_periodic_surface_only_the_mean_is_left() {
    let directory = tempfile::tempdir().unwrap();
    let case = BALL.replace("load = \"0.4 N\"", "load = \"0.4 N\", boundary = \"periodic\"");
    let wanted = "to = \"1 mm\"\nlayers = 2\ncolumns = [[0, 0]]";
    let summary = run(&case, wanted, directory.path(), Existing::Keep);
    let Outcome::Static(record) = &summary.outcome else { panic!() };
    let mean = record.load / record.apparent_area;
    let stress = Results::open(directory.path()).unwrap().subsurface_fields(None).unwrap();
    let deepest = |name: &str| stress.read(&format!("column_01_{name}")).unwrap().values[[2]] / mean;
    for (name, expected) in [("zz", -1.0), ("xx", -0.3 / 0.7), ("yy", -0.3 / 0.7), ("xz", 0.0), ("xy", 0.0)] {
        assert!((deepest(name) - expected).abs() < 1e-10, "{name}: {}", deepest(name));
    }
}

#[test]
fn it_does_not_depend_on_the_number_of_threads() {
    let files = [1, 2].map(|threads| {
        let directory = tempfile::tempdir().unwrap();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| run(BALL, "to = \"10 um\"\nplanes = [\"1 um\"]", directory.path(), Existing::Keep));
        std::fs::read(directory.path().join("subsurface.h5")).unwrap()
    });
    assert!(files[0] == files[1]);
}
