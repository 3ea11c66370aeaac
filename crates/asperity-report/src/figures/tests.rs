//! Figures of computed results: all there, all whole, for whatever a case asks for.

use std::collections::BTreeSet;
use std::path::Path;

use arbtest::arbitrary::{Result as Arbitrary, Unstructured};
use asperity_study as study;
use asperity_study::Case;
use asperity_study::Existing;
use asperity_study::io::fields::FieldFile;

use asperity_base::{Field, Grid};
use asperity_contact::motion::IncrementRecord;
use asperity_study::io::fields::Fields;

use super::loading::direction;
use super::stored::{Cap, StoredArray};
use super::*;

fn under(forces: &[[f64; 2]]) -> Vec<IncrementRecord> {
    let of = |(i, force): (usize, &[f64; 2])| {
        let mut row = IncrementRecord::default();
        (row.increment, row.stage, row.load, row.contact_area) = (i + 1, 1, 1.0, 1.0);
        [row.tangential_force_x, row.tangential_force_y] = *force;
        row
    };
    forces.iter().enumerate().map(of).collect()
}

#[test]
fn rounding_decides_neither_the_axis_nor_the_sign_of_a_loading() {
    let tiny = 1e-14;
    for turned in [0.18 * (1.0 - 1e-12), 0.18, 0.18 * (1.0 + 1e-12)] {
        let to_and_fro = under(&[[0.0, 0.0], [0.18, tiny], [-turned, -tiny], [0.18, 0.0]]);
        assert_eq!(direction(&to_and_fro), [1.0, 0.0]);
        let across = under(&[[tiny, 0.18], [-tiny, -turned]]);
        assert_eq!(direction(&across), [0.0, 1.0]);
        let [x, y] = direction(&under(&[[0.1, -0.1], [-turned / 1.8, turned / 1.8]]));
        assert!((x - 0.5f64.sqrt()).abs() < 1e-12 && (y + 0.5f64.sqrt()).abs() < 1e-12, "{x}, {y}");
    }
    assert_eq!(direction(&under(&[[0.0, 0.0]])), [1.0, 0.0]);
}

#[test]
fn a_cell_at_its_own_cap_is_plastic_whatever_the_hardness() {
    let grid = Grid::new([3, 1], [1e-6; 2]).unwrap();
    let row = |values: [f64; 3]| Field::from_shape_fn([3, 1], |(i, _)| values[i]);
    let folder = tempfile::tempdir().unwrap();
    let classes = |attribute: Option<f64>, field: Option<[f64; 3]>| {
        let path = folder.path().join("fields.h5");
        let mut file = FieldFile::new(&path);
        file.set("hardness", 2e9);
        if let Some(cap) = attribute {
            file.set("cap", cap);
        }
        if let Some(caps) = field {
            file.add_field("cap", "Pa", &grid, [0.0; 2], &row(caps));
        }
        file.add_field("pressure", "Pa", &grid, [0.0; 2], &row([0.0, 1.6e9, 2e9]));
        file.write().unwrap();
        let fields = Fields::open(&path).unwrap();
        let contact = StoredArray::read(&fields, "pressure").unwrap().contact(&Cap::read(&fields).unwrap());
        contact.field.iter().map(|class| *class == 2.0).collect::<Vec<_>>()
    };
    assert_eq!(classes(None, None), [false, false, true]);
    assert_eq!(classes(Some(1.6e9), None), [false, true, true]);
    assert_eq!(classes(None, Some([2e9, 1.6e9, 2e9])), [false, true, true]);
}

/// A motion of any strategy, shape, stride and speeds, in the words of a case file.
fn moving(u: &mut Unstructured) -> Arbitrary<String> {
    let shift = u.arbitrary()?;
    let [columns, rows, other]: [usize; 3] =
        [u.int_in_range(1..=14)?, u.int_in_range(1..=10)?, u.int_in_range(1..=14)?];
    let rough = u.int_in_range(0..=3)? > 0;
    let mut body = |name: &str, columns: usize| -> Arbitrary<String> {
        let hardness = ["", "hardness = 4e9, ", "hardness = 1e12, "][u.choose_index(3)?];
        let seed = u.int_in_range(1..=99)?;
        let shape = format!("shape = [{columns}, {rows}], pitch = 1e-6");
        let topography = if rough && columns.min(rows) > 4 {
            format!("generate = \"low-pass\", {shape}, sq = 20e-9, cutoff = 4e-6, seed = {seed}")
        } else {
            format!("form = \"flat\", {shape}")
        };
        Ok(format!(
            "{name} = {{ young = 210e9, poisson = 0.3, {hardness}topography = {{ {topography} }} }}\n"
        ))
    };
    let lower = body("lower", columns)?;
    let upper = body("upper", if shift { columns } else { other })?;
    let [pressure, control] = match u.int_in_range(0..=3)? {
        0 => ["mean_pressure = 5e6", "step-load"],
        1 => ["approach = -1e-6", "approach"],
        2 => ["approach = 1e-9", "approach"],
        _ => ["mean_pressure = 5e6", "pass-load"],
    };
    let boundary = if shift && u.arbitrary()? { "periodic" } else { "free" };
    let strategy = if shift {
        let speeds = [[0, 1], [1, 0], [1, 1], [2, 1], [3, -1], [-1, 2]][u.choose_index(6)?];
        format!("strategy = \"shift\", speed_lower = {}, speed_upper = {}", speeds[0], speeds[1])
    } else {
        "strategy = \"overlap\"".to_owned()
    };
    let passes = u.int_in_range(1..=3)?;
    let stride = u.int_in_range(1..=16)?;
    let update = ["pass", "step"][u.choose_index(2)?];
    let kept = u.int_in_range(0..=5)?;
    let friction =
        ["", "friction = { coefficient = 0.3 }\n", "friction = { coefficient = 0.3, junction_growth = 9 }\n"]
            [u.choose_index(3)?];
    Ok(format!(
        "{lower}{upper}contact = {{ {pressure}, boundary = \"{boundary}\" }}\n\
         motion = {{ {strategy}, passes = {passes}, stride = {stride}, control = \"{control}\", \
         plastic_update = \"{update}\" }}\noutput = {{ pressure_every = {kept} }}\n{friction}"
    ))
}

#[test]
fn any_motion_has_all_its_figures() {
    // More by hand: ASPERITY_CASES=300.
    let cases = std::env::var("ASPERITY_CASES").map_or(8, |cases| cases.parse::<u64>().unwrap());
    let (mut drawn, mut seed) = (0, 0);
    while drawn < cases {
        seed += 1;
        drawn += u64::from(has_all_its_figures(&case_of(seed)));
    }
    assert!(seed < 2 * cases + 10, "of {seed} cases only {drawn} could be computed");
}

#[test]
fn bodies_that_run_in_are_drawn_over_the_passes_done_and_the_distance() {
    let body = |seed: usize, wear: &str| {
        format!(
            "{{ young = 210e9, poisson = 0.3, topography = {{ generate = \"self-affine\", shape = [16, 16], \
             pitch = 1e-6, sq = 20e-9, hurst = 0.8, shortest = 4e-6, seed = {seed} }}{wear} }}"
        )
    };
    let text = format!(
        "lower = {}\nupper = {}\ncontact = {{ mean_pressure = 50e6, boundary = \"periodic\" }}\n\
             motion = {{ strategy = \"shift\", speed_upper = 0.5, passes = 200, stride = 8 }}\n\
             acceleration = {{ max_jump = 100 }}\noutput = {{ pressure_every = 0 }}\n",
        body(1, ", wear = { coefficient = 1e-17 }"),
        body(2, "")
    );
    let folder = tempfile::tempdir().unwrap();
    let case = Case::parse(&text, Path::new("case.toml"), folder.path()).unwrap();
    let directory = folder.path().join("results");
    study::run(&case, asperity_study::SurfaceInput::default(), &directory, Existing::Keep, &()).unwrap();
    let results = Results::open(&directory).unwrap();
    let passes = results.passes().unwrap();
    assert!(passes.len() < 50, "{} of 200 passes are computed", passes.len());
    let format = crate::draw::Format::Svg;
    let wanted = FigureOptions { paper: Paper { format, ..Paper::default() }, ..FigureOptions::default() };
    let paths = draw(&results, &wanted, &|| false).unwrap();
    let read = |name: &str| {
        let path = paths.iter().find(|path| path.file_stem().is_some_and(|stem| stem == name)).unwrap();
        std::fs::read_to_string(path).unwrap()
    };
    let figure = read("running-in");
    for (words, shown) in [("worn volume", true), ("sliding distance", true), ("film", false), ("°C", false)]
    {
        assert_eq!(figure.contains(words), shown, "{words}");
    }
    assert!(read("roughness").contains("passes 1 to 200"));
    assert!(read("topographies").contains("after pass 200"));
}

/// A soft ball that sticks to a plane, comes near, and is drawn off.
const STICKING: &str = "\
lower = { young = 1e9, poisson = 0.4, topography = { form = \"flat\", shape = [24, 24], pitch = 1e-9 } }
upper = { young = \"inf\", poisson = 0.3, topography = { form = \"sphere\", radius = 40e-9, shape = [24, 24], pitch = 1e-9 } }
adhesion = { work = 0.08, range = 0.6e-9 }
contact = { approach = -4e-9 }
history = [{ approach = 0.5e-9, increments = 5 }, { approach = APART, increments = 6 }]
";

#[test]
fn bodies_that_attract_each_other_have_their_own_figures() {
    let stored = |apart: &str| {
        let folder = tempfile::tempdir().unwrap();
        let text = STICKING.replace("APART", apart);
        let case = Case::parse(&text, Path::new("case.toml"), folder.path()).unwrap();
        let directory = folder.path().join("results");
        study::run(&case, asperity_study::SurfaceInput::default(), &directory, Existing::Keep, &()).unwrap();
        (Results::open(&directory).unwrap(), folder)
    };
    let (results, _folder) = stored("0.1e-9");
    let format = crate::draw::Format::Svg;
    let wanted = FigureOptions { paper: Paper { format, ..Paper::default() }, ..FigureOptions::default() };
    let paths = draw(&results, &wanted, &|| false).unwrap();
    let read = |name: &str| {
        let path = paths.iter().find(|path| path.file_stem().is_some_and(|stem| stem == name));
        std::fs::read_to_string(path.unwrap_or_else(|| panic!("no {name}"))).unwrap()
    };
    let curve = read("force_distance");
    for words in ["distance −δ (nm)", "load (nN)", "approach", "retreat", "hysteresis"] {
        assert!(curve.contains(words), "no {words}");
    }
    assert!(read("pressure").contains("pressure, tension below 0"));
    assert!(!paths.iter().any(|path| path.ends_with("loading.svg")));

    // Cells in contact are counted, of which some are under tension, and none of the open ones.
    let fields = results.static_fields().unwrap();
    let pressure = StoredArray::read(&fields, "pressure").unwrap();
    let touching = StoredArray::touching(&fields, &pressure).unwrap();
    let count = |field: &Field| field.iter().filter(|value| **value > 0.0).count();
    let contact = pressure.contact_on(&touching, &Cap::read(&fields).unwrap());
    let last = results.increments().unwrap().pop().unwrap();
    assert_eq!((last.contact_area / 1e-18).round() as usize, count(&contact.field));
    assert!(count(&contact.field) > count(&pressure.field), "no cell in contact is under tension");
    let gap = StoredArray::read(&fields, "gap").unwrap();
    let open = static_contact::open_gap(gap, &Field::zeros(touching.raw_dim()), &touching);
    assert_eq!(count(&open.field), touching.len() - count(&touching));
    let section = profile_at_rest(&fields, &results.case().unwrap()).unwrap().unwrap();
    let points = |chart: usize| &section.charts[chart].series[0].points;
    assert!(points(2).iter().any(|[_, p]| *p < 0.0) && points(1).iter().any(|[_, gap]| *gap == 0.0));

    // Drawn apart for good, nothing touches, and the pull-off is marked.
    let (results, _folder) = stored("-5e-9");
    let paths = draw(&results, &wanted, &|| false).unwrap();
    let path = paths.iter().find(|path| path.ends_with("force_distance.svg")).unwrap();
    assert!(std::fs::read_to_string(path).unwrap().contains("pull-off −"));
    assert!(paths.iter().all(|path| !path.ends_with("profile.svg")));
}

#[test]
fn curves_below_the_surface_are_figures_of_their_own() {
    let body = |keys: &str, form: &str| {
        format!(
            "{{ young = 210e9, poisson = 0.3, {keys}topography = {{ {form}, shape = [16, 16], pitch = 4e-6 }} }}"
        )
    };
    let ball = body("", "form = \"sphere\", radius = 1e-3");
    let flowing = format!(
        "lower = {}\nupper = {ball}\ncontact = {{ load = 5 }}\nplasticity = {{ depth = 30e-6, layers = 6, increments = 3 }}\n",
        body("plasticity = { yield_stress = 1e9 }, ", "form = \"flat\"")
    );
    let elastic = format!(
        "lower = {}\nupper = {ball}\ncontact = {{ load = 5 }}\n\
         subsurface = {{ to = 40e-6, layers = 8, columns = [[32e-6, 32e-6], [0, 0]] }}\n",
        body("", "form = \"flat\"")
    );
    for (text, name, words) in [
        (&flowing, "plastic_flow", ["plastic work so far (nJ)", "largest plastic strain (%)"]),
        (&elastic, "stress_columns", ["column 2", "σ zz"]),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let case = Case::parse(text, Path::new("case.toml"), folder.path()).unwrap();
        let directory = folder.path().join("results");
        study::run(&case, asperity_study::SurfaceInput::default(), &directory, Existing::Keep, &()).unwrap();
        let format = crate::draw::Format::Svg;
        let wanted = FigureOptions {
            paper: Paper { format, ..Paper::default() },
            only: vec![name.to_owned()],
            keep: false,
        };
        let paths = draw(&Results::open(&directory).unwrap(), &wanted, &|| false).unwrap();
        let figure = std::fs::read_to_string(&paths[0]).unwrap();
        for words in words {
            assert!(figure.contains(words), "no {words} in {name}");
        }
    }
}

fn case_of(seed: u64) -> String {
    // SplitMix64.
    let bytes: Vec<u8> = (1..=32)
        .flat_map(|i| {
            let mut z = (seed << 32).wrapping_add(i).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            (z ^ (z >> 31)).to_le_bytes()
        })
        .collect();
    moving(&mut Unstructured::new(&bytes)).unwrap()
}

/// Whether the case can be computed; then all its figures are there and whole.
fn has_all_its_figures(text: &str) -> bool {
    let folder = tempfile::tempdir().unwrap();
    let Ok(case) = Case::parse(text, Path::new("case.toml"), folder.path()) else { return false };
    let directory = folder.path().join("results");
    if study::run(&case, asperity_study::SurfaceInput::default(), &directory, Existing::Keep, &()).is_err() {
        return false;
    }
    let paths = draw(&Results::open(&directory).unwrap(), &FigureOptions::default(), &|| false)
        .unwrap_or_else(|e| panic!("{e:?} of\n{text}"));
    let names: BTreeSet<_> = paths.iter().map(|path| path.file_name().unwrap().to_str().unwrap()).collect();
    for name in ["topographies", "mean_pressure", "load", "contact_area", "roughness", "approach"] {
        assert!(names.contains(format!("{name}.png").as_str()), "no {name} of\n{text}");
    }
    let kept = !text.contains("pressure_every = 0");
    for name in ["pressure.png", "contact.png", "pressure.gif"] {
        assert_eq!(names.contains(name), kept, "{name} of\n{text}");
    }
    for path in &paths {
        assert!(is_whole(path), "{} of\n{text}", path.display());
    }
    true
}

/// Whether a picture can be decoded to its last pixel.
fn is_whole(path: &Path) -> bool {
    let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
    if path.extension().is_some_and(|extension| extension == "gif") {
        let mut decoder = gif::Decoder::new(file).unwrap();
        let mut frames = 0;
        while decoder.read_next_frame().unwrap().is_some() {
            frames += 1;
        }
        return frames > 0;
    }
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).is_ok()
}

/// Theories of random surfaces stand beside a sweep of rough elastic bodies that repeat, and beside no other.
#[test]
fn theories_stand_beside_a_sweep_of_rough_bodies() {
    let folder = tempfile::tempdir().unwrap();
    let theories = |boundary: &str, hardness: &str| {
        let text = format!(
            r#"
lower = {{ young = "210 GPa", poisson = 0.3, hardness = {hardness}, topography = {{ generate = "self-affine", shape = [32, 32], pitch = "1 um", sq = "50 nm", hurst = 0.8, rolloff = "8 um", shortest = "4 um" }} }}
upper = {{ young = "210 GPa", poisson = 0.3, topography = {{ form = "flat" }} }}
contact = {{ mean_pressures = ["10 MPa", "100 MPa"], boundary = "{boundary}" }}
"#
        );
        let case = Case::parse(&text, Path::new("case.toml"), folder.path()).unwrap();
        let out = folder.path().join(format!("{boundary}-{hardness}"));
        study::run(&case, asperity_study::SurfaceInput::default(), &out, Existing::Keep, &()).unwrap();
        let results = Results::open(&out).unwrap();
        let points = results.sweep().unwrap();
        let theories = Theories::of(&results, &case, &points);
        let curves = of_sweep(&points, &case, theories.as_ref());
        let area = curves.into_iter().find(|curves| curves.name == "contact_area").unwrap();
        area.charts.charts[0]
            .series
            .iter()
            .map(|series| (series.name.clone(), series.points.clone()))
            .collect::<Vec<_>>()
    };
    let curves = theories("periodic", "inf");
    let names: Vec<&str> = curves.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["computed", "Persson", "Bush, Gibson, Thomas"]);
    // The area grows in proportion to the load, as the theories say, and the ratio of both is 2/π.
    let ratio = curves[1].1[1][1] / curves[2].1[1][1];
    assert!((ratio - 2.0 / std::f64::consts::PI).abs() < 0.02, "{ratio}");
    assert_eq!(theories("free", "inf").len(), 1);
    assert_eq!(theories("periodic", "\"1 GPa\"").len(), 1);
}
