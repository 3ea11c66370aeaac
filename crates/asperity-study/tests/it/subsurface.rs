//! Stress under the surface, from a case file to its results.

use std::path::Path;

use asperity_contact::reference::{HertzSphere, SlidingSphere};
use asperity_contact::stress::{Component, Stress};
use asperity_study::io::fields::Attribute;
use asperity_study::{Case, Existing, Results, SubsurfaceRecord, Summary, pressure_name};

use crate::support::{most, parsed, run_to, written};

/// A ball on a plane, about 16 cells in contact along its radius.
const BALL: &str = r#"
lower = { young = "210 GPa", poisson = 0.3, topography = { form = "flat", shape = [48, 48], pitch = "1 um" } }
upper = { young = "70 GPa", poisson = 0.2, topography = { form = "sphere", radius = "1 mm", shape = [48, 48], pitch = "1 um" } }
contact = { load = "0.4 N" }
"#;

/// Rough bodies in motion; positions 1, 5, 9, … are stored.
const MOVING: &str = r#"
lower = { young = "210 GPa", poisson = 0.3, hardness = "4 GPa", topography = { generate = "low-pass", shape = [32, 32], pitch = "1 um", sq = "35 nm", cutoff = "8 um", seed = 1 } }
upper = { young = "210 GPa", poisson = 0.3, topography = { generate = "low-pass", shape = [32, 32], pitch = "1 um", sq = "35 nm", cutoff = "8 um", seed = 2 } }
contact = { load = "20 mN" }
motion = { passes = 2, stride = 4 }
output = { pressure_every = 4 }
"#;

fn run(case: &str, subsurface: &str, directory: &Path, existing: Existing) -> Summary {
    run_to(&parsed(&format!("{case}\n[subsurface]\n{subsurface}")), directory, existing).0
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
        // The apex is where four cells meet.
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
    // The edge belongs to the last cell.
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
    let pressure = written(&results, "pressure");
    let zz = section("zz").into_field().unwrap();
    let peak = most(&pressure);
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
        // The position with the offset 4: its first column is the fifth of the lower body.
        let stress = results.subsurface_fields(Some(pass)).unwrap();
        let zz = stress.read("section_zz").unwrap();
        let Attribute::Number(y) = stress.attributes().unwrap()["section"] else { panic!() };
        assert_eq!(y, first.subsurface[pass - 1].position[1], "the most stressed point");
        let row = (y / 1e-6) as usize;
        assert_eq!((zz.values.shape(), zz.origin[0]), (&[28, 7][..], 4.5e-6));
        let pressure = results.fields_after(pass).unwrap().read(&pressure_name(9)).unwrap();
        assert_eq!(pressure.origin[0], zz.origin[0]);
        let (zz, pressure) = (zz.into_field().unwrap(), pressure.into_field().unwrap());
        let peak = most(&pressure);
        assert!((0..28).any(|ix| pressure[[ix, row]] > 0.1 * peak));
        assert!((0..28).all(|ix| (zz[[ix, 0]] + pressure[[ix, row]]).abs() < 1e-12 * peak));
    }
    let more = MOVING.replace("passes = 2", "passes = 3");
    let all = run(&more, wanted, directory.path(), Existing::Resume);
    assert_eq!((&all.subsurface[..2], all.subsurface[2].pass), (&first.subsurface[..], Some(3)));
    assert_eq!(results.summary().unwrap(), all);

    // By default the position is that of full overlap: the eighth of 7 + 1 + 7.
    run(MOVING, "to = \"6 um\"\nlayers = 6", directory.path(), Existing::Overwrite);
    let flush = results.subsurface_fields(Some(2)).unwrap();
    assert_eq!(flush.attributes().unwrap()["step"], 8.into());
    assert!(results.subsurface_fields(Some(3)).is_err(), "it was replaced");
}

/// Returns the numbers of the last array of a `.vti` file.
fn last_array(path: &Path) -> Vec<f32> {
    let bytes = std::fs::read(path).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    let offset: usize = text.rsplit("offset=\"").next().unwrap().split('"').next().unwrap().parse().unwrap();
    let begin = bytes.windows(8).position(|w| w == b"\"raw\">\n_").unwrap() + 8 + offset;
    let length = u64::from_le_bytes(bytes[begin..begin + 8].try_into().unwrap()) as usize;
    let numbers = &bytes[begin + 8..begin + 8 + length];
    numbers.chunks_exact(4).map(|number| f32::from_le_bytes(number.try_into().unwrap())).collect()
}

#[test]
fn paraview_gets_every_field_and_the_stress_as_a_volume() {
    let directory = tempfile::tempdir().unwrap();
    let case = MOVING.replace("pressure_every = 4", "pressure_every = 4, paraview = true");
    // The plane is the third of nine.
    let wanted = "to = \"4 um\"\nlayers = 8\nplanes = [\"1 um\"]";
    let summary = run(&case, wanted, directory.path(), Existing::Keep);
    let results = Results::open(directory.path()).unwrap();
    let file = |name: &str| directory.path().join("fields").join(name);
    for (pass, record) in summary.subsurface.iter().enumerate() {
        let stress = last_array(&file(&format!("subsurface-{:04}.vti", pass + 1)));
        assert_eq!(stress.len(), 32 * 32 * 9);
        let most = f64::from(stress.iter().copied().fold(0.0, f32::max));
        // Between the planes it is a little larger.
        assert!((0.98..1.0 + 1e-6).contains(&(most / record.max_von_mises)), "{most:e}, {record:?}");
        let plane = results.subsurface_fields(Some(pass + 1)).unwrap().read("von_mises_01").unwrap();
        for ((ix, iy), value) in plane.into_field().unwrap().indexed_iter() {
            assert_eq!(stress[(6 * 32 + iy) * 32 + ix], *value as f32);
        }
    }
    let sq = |name: &str| {
        let heights: Vec<f64> = last_array(&file(name)).into_iter().map(f64::from).collect();
        let mean = heights.iter().sum::<f64>() / heights.len() as f64;
        (heights.iter().map(|z| (z - mean).powi(2)).sum::<f64>() / heights.len() as f64).sqrt()
    };
    assert!((sq("initial.vti") / 35e-9 - 1.0).abs() < 1e-6);

    // A missing file is written again, an existing one stays.
    let before = std::fs::read(file("pass-0002.vti")).unwrap();
    std::fs::remove_file(file("pass-0002.vti")).unwrap();
    run(&case, wanted, directory.path(), Existing::Resume);
    assert!(std::fs::read(file("pass-0002.vti")).unwrap() == before);
    run(MOVING, wanted, directory.path(), Existing::Overwrite);
    assert!(!file("pass-0002.vti").exists() && !file("subsurface-0001.vti").exists());
}

/// A contact in a shift may begin in the middle of a body, and goes on at its beginning.
#[test]
fn places_in_a_shift_are_on_the_body() {
    let case = r#"
lower = { young = "210 GPa", poisson = 0.3, topography = { form = "sphere", radius = "1 mm", shape = [24, 24], pitch = "1 um" } }
upper = { young = "210 GPa", poisson = 0.3, topography = { form = "flat" } }
contact = { load = "0.1 N", boundary = "periodic" }
motion = { strategy = "shift", speed_lower = "2 m/s", speed_upper = "1 m/s" }
"#;
    let mut beyond = 0;
    for step in [3, 9, 16, 22] {
        let directory = tempfile::tempdir().unwrap();
        let wanted =
            format!("to = \"6 um\"\nlayers = 6\nstep = {step}\ncolumns = [[\"2.5 um\", \"11.5 um\"]]");
        let summary = run(case, &wanted, directory.path(), Existing::Keep);
        let record = &summary.subsurface[0];
        for [x, y, _] in [record.position, record.max_shear_position] {
            assert!((x - 12e-6).abs() < 1e-6 && (y - 12e-6).abs() < 1e-6, "position {step}: {record:?}");
        }
        let results = Results::open(directory.path()).unwrap();
        let stress = results.subsurface_fields(Some(1)).unwrap();
        let attributes = stress.attributes().unwrap();
        let Attribute::Numbers(columns) = &attributes["columns"] else { panic!("{attributes:?}") };
        let same = |(found, expected): (&f64, f64)| (found - expected).abs() < 1e-18;
        assert!(columns.iter().zip([2.5e-6, 11.5e-6]).all(same), "position {step}: {columns:?}");
        // The section counts on beyond the end of the body, and has the point of the body in it.
        let section = stress.read("section_von_mises").unwrap();
        let last = section.origin[0] + 23.0 * section.pitch[0];
        beyond += usize::from(record.position[0] < section.origin[0] && last > 24e-6);
    }
    assert!(beyond > 0);
}

/// A ball pushed along a body with a hard layer over a soft one.
fn pushed_over_layers(boundary: &str, layers: &str) -> Case {
    let text = format!(
        "contact = {{ load = 0.2, boundary = \"{boundary}\", tolerance = 1e-8 }}\n\
         friction = {{ coefficient = 0.3, force = 0.02 }}\n\
         subsurface = {{ to = 8e-6, layers = 8, columns = [[20e-6, 20e-6]] }}\n\
         upper = {{ young = \"210 GPa\", poisson = 0.3, topography = {{ form = \"sphere\", radius = 1e-3 }} }}\n\
         [lower]\nyoung = \"100 GPa\"\npoisson = 0.25\n\
         topography = {{ form = \"flat\", shape = [40, 40], pitch = 1e-6 }}\n{layers}"
    );
    parsed(&text)
}

#[test]
fn stress_in_layers_is_that_of_the_body_if_they_are_alike_and_their_faces_are_in_the_summary() {
    const ALIKE: &str = "[[lower.layers]]\nthickness = 1.5e-6\nyoung = \"100 GPa\"\npoisson = 0.25\n\
                         [[lower.layers]]\nthickness = 2e-6\nyoung = \"100 GPa\"\npoisson = 0.25\n";
    for boundary in ["free", "periodic"] {
        let folder = tempfile::TempDir::new().unwrap();
        let [(plain, one), (layered, other)] = [("plain", ""), ("alike", ALIKE)].map(|(name, layers)| {
            run_to(&pushed_over_layers(boundary, layers), &folder.path().join(name), Existing::Keep)
        });
        let (plain, found) = (&plain.subsurface[0], &layered.subsurface[0]);
        let size = plain.max_von_mises;
        // The faces of the layers are planes besides.
        assert!(found.max_von_mises > size * (1.0 - 1e-5), "{boundary}: {found:?} and {plain:?}");
        assert!(plain.max_surface_tension.is_none() && found.max_surface_tension.unwrap() > 0.0);
        assert!(
            found.max_interface_shear.unwrap() > 0.1 * size && found.max_interface_tension.unwrap() >= 0.0
        );
        for component in ["xx", "zz", "xz", "yy"] {
            let column = |results: &Results| {
                let name = format!("column_01_{component}");
                results.subsurface_fields(None).unwrap().read(&name).unwrap().values
            };
            for (one, other) in column(&one).iter().zip(&column(&other)) {
                assert!((one - other).abs() < 1e-5 * size, "{boundary}, {component}: {one:e} and {other:e}");
            }
        }
        assert_eq!(SubsurfaceRecord::read(&folder.path().join("alike/subsurface.h5")).unwrap(), *found);
    }
}

#[test]
fn a_stiff_layer_on_a_soft_one_bends_and_bears_the_largest_stress_at_its_lower_face() {
    const STIFF: &str = "[[lower.layers]]\nthickness = 1.5e-6\nyoung = \"500 GPa\"\npoisson = 0.2\n\
                         [[lower.layers]]\nthickness = 4e-6\nyoung = \"20 GPa\"\npoisson = 0.35\n";
    let folder = tempfile::TempDir::new().unwrap();
    let (summary, _) = run_to(&pushed_over_layers("free", STIFF), folder.path(), Existing::Keep);
    let found = &summary.subsurface[0];
    assert_eq!(found.position[2], 1.5e-6, "{found:?}");
    assert!(found.max_surface_tension.unwrap() > 1e8, "{found:?}");
}
