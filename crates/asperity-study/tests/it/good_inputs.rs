//! Good inputs are read correctly, and written back unchanged.

use std::path::{Path, PathBuf};

use asperity_base::Grid;
use asperity_contact::adhesion::Potential;
use asperity_contact::material::Coating;
use asperity_contact::motion::{LoadControl, PlasticUpdate, Point, SlipRegime, Stage, Strategy};
use asperity_contact::solver::{self, Coupling, Creep, Friction, Loading, Rolling, Tangential};
use asperity_contact::with::adhesion::AdhesionRange;
use asperity_study::case::{
    Boundary, Case, ControlKind, Course, Edge, Hardness, InPlane, Layer, Layout, Method, Mount, Prescribed,
    Side, Source,
};
use asperity_study::{Bodies, SurfaceInput, bodies, demand};
use asperity_surface::{
    Amplitude, Autocorrelation, Axis, Band, Decay, Fill, Filter, Form, Generator, Groove, HeightDistribution,
    Interpolation, Level, LowPass, Preparation, Resample, SelfAffine, Topography,
};

use crate::ball::{ball, completed, good_cases};
use crate::support::{parsed, parsed_in};

#[test]
fn a_coating_is_read_and_written_back_and_nothing_is_written_where_there_is_none() {
    let case = load("coated");
    let [lower, upper] = [&case.lower.material.layers, &case.upper.material.layers];
    assert_eq!(lower.as_slice(), [Coating::new(2e-6, 300e9, 0.25).unwrap()]);
    assert_eq!(upper.as_slice(), [Coating::new(0.5e-6, 3e9, 0.5).unwrap()]);
    assert!(case.is_coated() && case.lower.hardness == Hardness::Uniform(6e9));
    let written = serde_json::to_value(&case).unwrap();
    assert_eq!(written["lower"]["coating"]["thickness"], 2e-6);
    let plain = load("smallest");
    assert!(!plain.is_coated());
    assert!(serde_json::to_value(&plain).unwrap()["lower"].get("coating").is_none());
}

#[test]
fn layers_on_a_rigid_base_are_read_from_the_surface_down_and_written_back() {
    let case = load("layered");
    let lower = &case.lower.material;
    let expected = [[1e-6, 400e9, 0.2], [2e-7, 100e9, 0.3], [5e-6, 3e9, 0.5]];
    assert_eq!(lower.layers, expected.map(|[t, young, poisson]| Coating::new(t, young, poisson).unwrap()));
    assert!(lower.young.is_infinite() && case.is_coated());
    let written = serde_json::to_value(&case).unwrap();
    assert_eq!(written["lower"]["layers"][1]["thickness"], 2e-7);
    assert!(written["lower"].get("coating").is_none() && written["upper"].get("layers").is_none());
    let rigid = parsed(
        "contact = { load = 1.0 }\n\
         lower = { base = \"rigid\", layers = [{ thickness = 1e-6, young = 400e9, poisson = 0.2 }], topography = { form = \"flat\", shape = [64, 64], pitch = 1e-6 } }\n\
         upper = { material = \"steel\", topography = { form = \"sphere\", radius = 1e-3 } }",
    );
    assert!(rigid.lower.material.young.is_infinite());
    assert_eq!(serde_json::to_value(&rigid).unwrap()["lower"]["coating"]["thickness"], 1e-6);
}

#[test]
fn adhesion_and_loads_that_pull_are_read_and_written_back() {
    let case = load("sticking");
    let adhesion = case.interface.adhesion.unwrap();
    assert_eq!((adhesion.work, adhesion.range), (0.05, AdhesionRange::Grid));
    assert_eq!(adhesion.potential, Potential::Dugdale);
    let stages: Vec<_> = case.history.iter().map(|stage| stage.normal().unwrap()).collect();
    assert_eq!(stages, [Prescribed::Load(-1e-9), Prescribed::MeanPressure(0.0), Prescribed::Approach(-1e-8)]);
    let written = serde_json::to_value(&case).unwrap();
    assert_eq!(written["adhesion"]["work"], 0.05);
    assert_eq!(written["adhesion"]["range"], "grid");
    assert!(
        serde_json::to_value(load("smallest")).unwrap().get("adhesion").is_none_or(|value| value.is_null())
    );
}

#[test]
fn a_path_an_offset_and_a_fresh_counter_body_are_read_and_written_where_given() {
    let case = load("there_and_back");
    let motion = case.motion.unwrap();
    assert_eq!(motion.path, asperity_contact::motion::Path::Reciprocating);
    assert_eq!(motion.offset_y(), asperity_contact::motion::OffsetY::Random { seed: 12 });
    assert_eq!(motion.counter, asperity_study::case::CounterBody::Fresh);
    assert!(!motion.repeats() && load("running_in").motion.unwrap().repeats());
    let written = serde_json::to_value(&case).unwrap();
    let keys = |value: &serde_json::Value| {
        ["path", "offset_y", "seed", "counter"].map(|key| value["motion"][key].clone())
    };
    let expected: [serde_json::Value; 4] =
        ["reciprocating".into(), "random".into(), 12.into(), "fresh".into()];
    assert_eq!(keys(&written), expected);
    let plain = serde_json::to_value(load("running_in")).unwrap();
    assert!(keys(&plain).iter().all(serde_json::Value::is_null));
}

#[test]
fn the_case_of_the_contract_is_read_in_si() {
    let case = load("running_in");
    assert_eq!(case.title, "two ground steel surfaces running in");
    assert_eq!(case.lower.material.young, 210e9);
    assert_eq!(case.lower.hardness, Hardness::Uniform(4e9));
    assert_eq!(case.upper.hardness, Hardness::Uniform(f64::INFINITY));
    assert_eq!((case.lower.mount, case.upper.mount), (Some(Mount::AsIs), Some(Mount::TurnedOver)));
    let lower = &case.lower.topography;
    assert_eq!(
        lower.source,
        Source::File {
            file: inputs("good").join("disc.x3p"),
            channel: None,
            unit: None,
            layout: Layout { lines: None, skip: None },
        }
    );
    let preparation = Preparation {
        fill: Fill::Harmonic,
        level: Level::Plane,
        resample: Some(Resample::Shape([256, 256])),
        ..Preparation::default()
    };
    assert_eq!((lower.preparation, lower.pitch), (preparation, None));
    let upper = &case.upper.topography;
    let generate = Generator::LowPass(LowPass::new(0.2e-6, [8e-6; 2]));
    assert_eq!(upper.source, Source::Generate { generate, shape: Some([256, 256]), seed: 7 });
    assert_eq!(upper.pitch, Some([0.5e-6; 2]));
    assert_eq!(case.contact.prescribed(), Prescribed::Load(2.0));
    let motion = case.motion(1.0).unwrap();
    assert_eq!((motion.control, motion.load_control), (solver::Control::Load(2.0), LoadControl::Pass));
    assert_eq!((motion.strategy, motion.passes, motion.stride), (Strategy::Overlap, 5, 1));
    assert_eq!((case.output.pressure_every, case.output.rim), (8, 0.25));
    assert_eq!(case.files().count(), 1);
}

#[test]
fn every_step_of_a_preparation_is_read_in_si() {
    let case = load("prepared");
    let expected = Preparation {
        window: Some([10, 20, 100, 50]),
        despike: Some(6.0),
        fill: Fill::Harmonic,
        level: Level::Polynomial(4),
        mirror: Some(Axis::Y),
        rotate: std::f64::consts::FRAC_PI_2,
        s_filter: Some(2.5e-6),
        l_filter: Some(0.8e-3),
        filter: Filter::Robust,
        resample: Some(Resample::Shape([128, 64])),
        interpolate: Interpolation::Spline,
        taper: Some(10e-6),
    };
    assert_eq!(case.lower.topography.preparation, expected);
    let of_a_form = Preparation { level: Level::Sphere, s_filter: Some(3e-6), ..Preparation::default() };
    assert_eq!(case.upper.topography.preparation, of_a_form);
}

#[test]
fn what_is_left_out_takes_its_default() {
    let case = load("smallest");
    assert_eq!(case.title, "smallest");
    assert_eq!(case.lower.material.young, f64::INFINITY);
    assert_eq!(case.lower.topography.preparation, Preparation::default());
    let contact = &case.contact;
    assert_eq!(contact.prescribed(), Prescribed::Approach(10e-9));
    assert_eq!((contact.boundary, contact.method, contact.tolerance), (Boundary::FREE, Method::Auto, 1e-6));
    assert!(case.motion.is_none() && case.motion(1.0).is_none());
    assert_eq!((case.output.pressure_every, case.output.rim), (8, 0.1));

    let motion = load("forms").motion.unwrap();
    assert_eq!((motion.passes, motion.stride, motion.load_tolerance), (1, 1, 1e-4));
    assert_eq!((motion.plastic_update, motion.control()), (PlasticUpdate::Pass, ControlKind::Approach));
}

#[test]
fn the_boundary_is_one_word_or_one_for_each_axis() {
    assert_eq!(load("rolling").contact.boundary, Boundary::PERIODIC);
    assert_eq!(load("line").contact.boundary, Boundary([Edge::Free, Edge::Periodic]));
}

#[test]
fn a_mean_pressure_becomes_a_load_on_the_apparent_area() {
    let case = load("rolling");
    let motion = case.motion(4e-9).unwrap();
    assert_eq!(
        (motion.control, motion.load_control),
        (solver::Control::Load(10e6 * 4e-9), LoadControl::Step)
    );
    assert_eq!(motion.strategy, Strategy::Shift { speed_lower: -0.01, speed_upper: 0.02 });
    assert_eq!(case.upper.mount, Some(Mount::AsIs));
}

#[test]
fn one_length_serves_both_directions_and_two_serve_each() {
    let case = load("rolling");
    assert_eq!(case.lower.topography.pitch, Some([0.5e-6, 1e-6]));
    let Source::Generate { generate, .. } = case.upper.topography.source else { panic!() };
    let expected = Autocorrelation::new(1e-7, [10e-6, 20e-6]);
    assert_eq!(generate, Generator::Autocorrelation(expected));
    let Source::Generate { generate, .. } = case.lower.topography.source else { panic!() };
    assert_eq!(
        generate,
        Generator::SelfAffine(SelfAffine {
            amplitude: Amplitude::Sdq(0.1),
            hurst: 0.8,
            rolloff: Some(40e-6),
            shortest: Some(2e-6)
        })
    );
    let Source::Generate { generate, .. } = load("grooves").lower.topography.source else { panic!() };
    assert_eq!(generate, Generator::LowPass(LowPass::new(1e-7, [8e-6, 16e-6])));
    let Source::Form { form, .. } = load("grooves").upper.topography.source else { panic!() };
    assert_eq!(form, Form::Sinusoid { amplitude: 1e-7, wavelength: [8e-6, f64::INFINITY] });
    let Source::Form { form, .. } = load("forms").upper.topography.source else { panic!() };
    assert_eq!(form, Form::Cylinder { radius: 5e-3, axis: Axis::X });
    let Source::Form { form, .. } = load("ellipsoid").upper.topography.source else { panic!() };
    assert_eq!(form, Form::Ellipsoid { radius: [1e-3, 2e-3] });
}

#[test]
fn topographies_are_added_in_the_order_of_the_file() {
    let case = load("rough_ball");
    let Source::Generate { generate, seed: 3, .. } = case.lower.topography.source else { panic!() };
    let lay = 30f64.to_radians();
    let heights = HeightDistribution { ssk: -1.0, sku: 4.5 };
    let ground = Autocorrelation { lay, heights, ..Autocorrelation::new(1e-7, [40e-6, 4e-6]) };
    assert_eq!(generate, Generator::Autocorrelation(ground));
    let lay = 90f64.to_radians();
    let form = Form::Grooves { period: 20e-6, depth: 0.2e-6, profile: Groove::Triangular, lay };
    assert_eq!(case.lower.topography.plus, [Layer::Form { form }]);
    let heights = HeightDistribution { ssk: 0.0, sku: 4.0 };
    let rough = LowPass { band: Band::Rectangular, heights, ..LowPass::new(20e-9, [8e-6; 2]) };
    let fine = Autocorrelation { decay: Decay::Gaussian, ..Autocorrelation::new(5e-9, [4e-6; 2]) };
    let expected = [
        Layer::Generate { generate: Generator::LowPass(rough), seed: 1 },
        Layer::Generate { generate: Generator::Autocorrelation(fine), seed: 0 },
    ];
    assert_eq!(case.upper.topography.plus, expected);
    let heights = prepared(&case).upper.topography.into_heights();
    let grid = Grid::new([64, 64], [1e-6; 2]).unwrap();
    let mut sum = Form::Sphere { radius: 1e-3 }.on(&grid).unwrap();
    for layer in expected {
        sum = sum.plus(&layer.on(&grid).unwrap()).unwrap();
    }
    assert_eq!(heights, sum.underside().into_heights());
}

#[test]
fn what_is_made_takes_the_shape_and_pitch_it_lacks_from_the_other_body_as_prepared() {
    let made = prepared(&load("as_the_other"));
    let grid = Grid::new([48, 32], [1e-6, 0.7e-6]).unwrap();
    assert_eq!([&made.lower, &made.upper].map(|body| *body.topography.grid()), [grid; 2]);
    let low_pass = LowPass::new(20e-9, [8e-6; 2]);
    assert_eq!(made.lower.topography.heights(), low_pass.generate(&grid, 0).unwrap().heights());

    // A measured surface whose pitch has more digits than its text shows, averaged, cut and turned over, on
    // either side.
    let folder = tempfile::tempdir().unwrap();
    let heights = LowPass::new(50e-9, [9e-6; 2]);
    let measured = Grid::new([60, 44], [0.123456789123e-6, 0.3e-6]).unwrap();
    let heights = heights.generate(&Grid::new([60, 44], [1e-6; 2]).unwrap(), 3).unwrap().into_heights();
    let measured = Topography::new(measured, heights).unwrap();
    measured.write(folder.path().join("disc.x3p")).unwrap();
    let file = "topography = { file = \"disc.x3p\", window = [4, 2, 56, 40], resample = [28, 40] }";
    for [lower, upper] in [[file, "MADE"], ["MADE", file]] {
        let body = |name: &str, topography: &str| {
            format!("[{name}]\nyoung = \"210 GPa\"\npoisson = 0.3\n{topography}\n")
        };
        let case = |made: &str| {
            let text = format!("{}{}[contact]\nload = 1\n", body("lower", lower), body("upper", upper));
            let text =
                text.replace("MADE", &format!("topography = {{ form = \"sphere\", radius = 1e-3{made} }}"));
            parsed_in(&text, folder.path())
        };
        let short = case("");
        let long = case(", shape = [28, 40], pitch = [0.246913578246e-6, 0.3e-6]");
        let [found, expected] = [&short, &long].map(prepared);
        for (a, b) in [(&found.lower, &expected.lower), (&found.upper, &expected.upper)] {
            let pitches = [a, b].map(|body| body.topography.grid().pitch);
            assert!((0..2).all(|axis| (pitches[0][axis] / pitches[1][axis] - 1.0).abs() < 1e-12));
            assert_eq!(a.topography.grid().shape, [28, 40]);
            let difference = a.topography.heights() - b.topography.heights();
            assert!(difference.iter().all(|e| e.abs() < 1e-12 * 1e-6));
        }
        // The resolved case contains the taken value, and gives the same result.
        let resolved = asperity_study::resolved(&short, &found);
        let name = if lower == file { "upper" } else { "lower" };
        let made = &resolved[name]["topography"];
        assert_eq!(made["shape"], serde_json::json!([28, 40]));
        assert_eq!(made["pitch"], serde_json::json!(found.lower.topography.grid().pitch));
        let again = case(&format!(", shape = {}, pitch = {}", made["shape"], made["pitch"]));
        assert_eq!(asperity_study::resolved(&again, &prepared(&again))["identity"], resolved["identity"]);
        let [less, more] =
            [&short, &long].map(|case| demand(case, &SurfaceInput::default(), 1).unwrap().memory);
        assert_eq!(less, more);
    }
}

#[test]
fn what_has_no_meaning_on_the_grid_is_shown_at_its_place() {
    let text = std::fs::read_to_string(inputs("good").join("rough_ball.toml")).unwrap();
    for (good, bad, line, message) in [
        ("sku = 4.5", "sku = 2", 14, "'sku' is 2, expected a kurtosis from 1.1 (Ssk² + 1) to 50"),
        (
            "period = \"20 um\"",
            "period = \"1 um\"",
            18,
            "'period' is 1 µm, expected a length of at least two pitches",
        ),
        (
            "\"4 um\", decay",
            "\"90 um\", decay",
            33,
            "'correlation_length' is 90 µm, expected a length from one pitch",
        ),
    ] {
        let text = text.replace(good, bad);
        let refused = bodies(&parsed(&text), SurfaceInput::default()).err();
        let Some(asperity_base::Error::Case(error)) = refused else { panic!("{bad}") };
        assert!(error.message.starts_with(message), "{error:?}");
        assert_eq!(error.line, line, "{error}");
    }
}

#[test]
fn what_is_wanted_of_the_stress_is_read_in_si() {
    let wanted = load("looked_into").subsurface.unwrap();
    assert_eq!((wanted.body, wanted.to, wanted.layers), (Side::Upper, 20e-6, 80));
    assert_eq!((wanted.planes, wanted.section, wanted.step), (vec![0.5e-6, 0.0], Some(10e-6), Some(8)));
    assert_eq!(wanted.columns, [[5e-6, 10e-6], [0.0, 20e-6]]);
    assert_eq!(load("smallest").subsurface, None);
}

#[test]
fn what_a_stage_does_not_name_stays() {
    let case = load("pushed");
    let friction = case.friction.as_ref().unwrap();
    let coupling = Coupling::Goodman;
    let law = Friction::coulomb(0.3)
        .unwrap()
        .with_shear_strength(20e6)
        .with_coupling(coupling)
        .with_junction_growth(9.0);
    assert_eq!((friction.law, &friction.prescribed), (law, &None));
    let stage = |load, tangential, increments| {
        Stage::new(Loading { normal: solver::Control::Load(load), tangential }, increments)
    };
    let expected = [
        stage(2.0, Tangential::Force([0.0, 0.0]), 4),
        stage(2.0, Tangential::Force([0.1, -20e-3]), 12),
        stage(1.0, Tangential::Displacement([0.1e-6, 0.0]), 1),
        stage(1.0, Tangential::Sliding([0.6, 0.8]), 1),
    ];
    let course = case.course(1.0);
    assert_eq!(course, Course::Stages(expected.to_vec()));
}

#[test]
fn what_rolls_has_a_creepage_or_a_force() {
    let rolling = |name| load(name).course(1.0);
    let course = |creep, spin| Course::Rolling(Rolling { creep, spin });
    assert_eq!(rolling("rolled"), course(Creep::Creepage([1e-3, -5e-4]), -20.0));
    assert_eq!(rolling("driven"), course(Creep::Force([0.2, 0.0]), 0.0));
}

#[test]
fn a_sweep_has_its_points_in_the_order_given_and_the_largest_is_prescribed() {
    let case = load("swept");
    let load_of = |point: &Prescribed| match *point {
        Prescribed::Load(load) => load,
        _ => panic!("{point:?}"),
    };
    let loads: Vec<f64> = case.contact.sweep().iter().map(load_of).collect();
    assert_eq!((loads[0], loads[8], loads.len()), (0.1, 10.0, 9));
    assert!(loads.windows(2).all(|pair| (pair[1] / pair[0] / 10f64.powf(0.25) - 1.0).abs() < 1e-12));
    assert_eq!(case.contact.prescribed(), Prescribed::Load(10.0));

    let case = load("swept_pressures");
    assert_eq!(case.contact.sweep(), [10e6, 1e6, 2e6].map(Prescribed::MeanPressure));
    let Course::Sweep(points) = case.course(1e-6) else { panic!() };
    let controls: Vec<_> = points.iter().map(|point| point.control).collect();
    assert_eq!(controls, [10e6, 1e6, 2e6].map(|pressure| solver::Control::Load(pressure * 1e-6)));
    assert_eq!(case.contact.prescribed(), Prescribed::MeanPressure(10e6));

    let approaches = load("swept_approaches").contact.sweep();
    let expected = [-10e-9, 0.0, 10e-9, 20e-9, 30e-9, 40e-9];
    let near = |point: &Prescribed, expected: f64| matches!(point, Prescribed::Approach(a) if (a - expected).abs() < 1e-22);
    assert!(
        approaches.len() == 6 && approaches.iter().zip(expected).all(|(a, b)| near(a, b)),
        "{approaches:?}"
    );

    let Course::Sweep(points) = load("swept_rolling").course(1.0) else { panic!() };
    let rolling = Rolling { creep: Creep::Creepage([1e-3, 0.0]), spin: 0.0 };
    let regime = SlipRegime::Rolling(load("swept_rolling").friction.unwrap().law, rolling);
    let point = |load| Point { control: solver::Control::Load(load), regime, speed: None };
    assert_eq!(points, [point(2.0), point(4.0)]);
}

#[test]
fn creepages_are_points_of_a_sweep_under_one_load() {
    let case = load("swept_creepages");
    assert!(case.course(1.0).is_sweep() && !load("swept_rolling").friction.unwrap().sweeps());
    let Course::Sweep(points) = case.course(1.0) else { panic!() };
    assert!(points.iter().all(|point| point.control == solver::Control::Load(2.0)));
    let creepages = |points: &[Point]| -> Vec<[f64; 2]> {
        let creepage = |point: &Point| match point.regime.rolling().unwrap().creep {
            Creep::Creepage(creepage) => creepage,
            Creep::Force(_) => panic!(),
        };
        points.iter().map(creepage).collect()
    };
    assert!(points.iter().all(|point| point.regime.rolling().unwrap().spin == 3.0));
    let by_ratio = creepages(&points);
    for (k, [x, y]) in by_ratio.into_iter().enumerate() {
        assert!((x / 10f64.powf(-4.0 + 0.5 * k as f64) - 1.0).abs() < 1e-12 && y == 0.0, "{k}: {x}, {y}");
    }
    let through = |value: &str| {
        let text = format!("[friction]\ncoefficient = 0.3\ncreepages = {value}");
        let text = toml::to_string(&completed(text.parse().unwrap(), &ball())).unwrap();
        let Course::Sweep(points) = parsed(&text).course(1.0) else { panic!() };
        creepages(&points)
    };
    assert_eq!(through("[1e-3, [0, -2e-3], [1e-3, 1e-3]]"), [[1e-3, 0.0], [0.0, -2e-3], [1e-3, 1e-3]]);
    assert_eq!(
        through("{ from = [-2e-3, 1e-3], to = [2e-3, 1e-3], points = 3 }"),
        [[-2e-3, 1e-3], [0.0, 1e-3], [2e-3, 1e-3]]
    );
}

#[test]
fn friction_without_more_is_coulombs_and_a_motion_has_it_too() {
    let friction = |name| load(name).friction.unwrap().law;
    assert_eq!(friction("stuck"), Friction::coulomb(f64::INFINITY).unwrap());
    assert_eq!(load("stuck").friction.unwrap().prescribed, None::<InPlane>);
    let rubbing = load("rubbing").motion(1.0).unwrap();
    assert_eq!(rubbing.friction, Some(Friction::coulomb(0.12).unwrap()));
    assert_eq!(load("forms").motion(1.0).unwrap().friction, None);
}

#[test]
fn a_file_is_looked_for_in_the_folder_of_the_case() {
    let case = load("measured");
    let files: Vec<_> = case.files().cloned().collect();
    assert_eq!(files, [inputs("good").join("data/plate.npy"), PathBuf::from("/measured/ball.sur")]);
}

#[test]
fn a_later_error_still_finds_its_place() {
    let case = load("running_in");
    let line = |key| case.error_at(key, "no such file", None).to_string();
    assert!(line("lower.topography.file").ends_with("running_in.toml:8: no such file"));
    assert!(line("upper.hardness").ends_with("running_in.toml:13: no such file"));
}

#[test]
fn a_case_deserialises_into_what_it_was_serialised_from() {
    for (path, text) in good_cases() {
        let first = Case::parse(&text, &path, path.parent().unwrap()).unwrap();
        let json = serde_json::to_value(&first).unwrap();
        let again: Case = serde_json::from_value(json.clone())
            .unwrap_or_else(|e| panic!("{}: {e}\n{json:#}", path.display()));
        assert_eq!(serde_json::to_value(&again).unwrap(), json);
        assert_eq!(again.lower, first.lower);
        assert_eq!((again.contact, again.motion), (first.contact, first.motion));
    }
}

fn load(name: &str) -> Case {
    let (path, text) = good_cases().into_iter().find(|(path, _)| path.file_stem().unwrap() == name).unwrap();
    Case::parse(&text, &path, path.parent().unwrap()).unwrap()
}

fn prepared(case: &Case) -> Bodies {
    bodies(case, SurfaceInput::default()).unwrap()
}

fn inputs(kind: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs").join(kind)
}
