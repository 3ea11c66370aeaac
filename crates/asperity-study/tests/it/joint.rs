//! The law of a joint: samples as one law, its checks, and files for other programs.

use std::fs;
use std::path::Path;

use asperity_base::error::{Error, Result};
use asperity_study::joint::{Band, Client, ClientSettings, Edge, Kind, Law, Units, samples};
use asperity_study::parametric::{Folder, Queue, Task, compute};

/// Two rough steel faces under several loads, with these keys besides.
const CASE: &str = r#"
title = "two faces"
[lower]
young = "210 GPa"
poisson = 0.3
conductivity = "46 W/(m K)"
topography = { generate = "self-affine", shape = [32, 32], pitch = "1 um", sq = "50 nm", hurst = 0.8, rolloff = "8 um", shortest = "4 um", seed = 3 }
[upper]
young = "210 GPa"
poisson = 0.3
conductivity = "46 W/(m K)"
topography = { generate = "self-affine", sq = "50 nm", hurst = 0.8, rolloff = "8 um", shortest = "4 um", seed = 4 }
[contact]
mean_pressures = ["10 MPa", "20 MPa", "40 MPa", "80 MPa", "160 MPa"]
boundary = "periodic"
[conductance]
[flow]
viscosity = 0.08
shear = true
[joint]
"#;

fn law(folder: &Path, text: &str) -> Result<Law> {
    let path = folder.join("faces.toml");
    fs::write(&path, text).unwrap();
    let study = samples(&path, &[])?;
    let directory = Folder::enter(&folder.join("faces-joint"), &study)?;
    let queue = Queue::new(&study, &directory, Task::ALL, false)?;
    compute(&queue, 1e10, &|| false, &|_, _| ())?;
    Law::collect(&study, &directory)
}

#[test]
fn samples_of_a_joint_are_one_law_that_rises() {
    let folder = tempfile::TempDir::new().unwrap();
    let law = law(folder.path(), &format!("{CASE}samples = 5\n")).unwrap();
    assert_eq!((law.samples, law.missing, law.pressures.len()), (5, 0, 5));
    assert!(law.rises());
    let values = |kind: Kind, edge: Edge| law.values(kind, edge).unwrap();
    for quantity in &law.quantities {
        for band in quantity.bands.iter().flatten() {
            let Band { low, median, high } = *band;
            assert!(low <= median && median <= high && low > 0.0, "{:?} {band:?}", quantity.kind);
        }
    }
    let [gap, normal, x] =
        [Kind::MeanGap, Kind::Stiffness, Kind::StiffnessX].map(|kind| values(kind, Edge::Median));
    assert!(gap.is_sorted_by(|a, b| a > b) && normal.is_sorted() && x.is_sorted());
    // Mindlin: 2 (1 − ν)/(2 − ν), of rough contacts nearly.
    for (x, normal) in x.iter().zip(&normal) {
        assert!((x / normal / (1.4 / 1.7) - 1.0).abs() < 0.06, "{x:e} {normal:e}");
    }
    // Barber's identity, and secants between the stiffnesses at both ends.
    assert!(law.checks.barber.unwrap() < 1e-3, "{:?}", law.checks);
    assert_eq!((law.checks.steps, law.checks.bracketed), (20, 20));
    // The closure of all edges begins at 0, and the median at a point is g₀ − g.
    let closure = law.closure(Edge::Median);
    assert_eq!(closure[0], [0.0, 0.0]);
    assert_eq!(closure[closure.len() - 1], [law.pressures[4], law.datum - gap[4]]);
    let factors = values(Kind::FlowFactorX, Edge::Median);
    assert!(factors.iter().all(|factor| *factor > 0.0 && *factor < 1.0), "{factors:?}");
    assert!(values(Kind::ShearFlowFactorX, Edge::Median).iter().all(|factor| *factor > 0.0));
    let csv = law.csv();
    assert!(csv.starts_with("mean_pressure (Pa),closure (m),mean_gap (m),mean_gap_low (m)"), "{csv}");
    assert_eq!(csv.lines().count(), 6);
    let told = law.doubts().join("\n");
    assert!(told.contains("roll-off wavelengths") && told.contains("20 samples"), "{told}");
}

/// Stopped after some samples, the others are computed, and the law is the same; one sample has no band.
#[test]
fn a_joint_goes_on_where_it_was_stopped() {
    let folder = tempfile::TempDir::new().unwrap();
    let text = format!("{CASE}samples = 3\n");
    let whole = law(folder.path(), &text).unwrap();
    fs::remove_dir_all(folder.path().join("faces-joint/cases/0002")).unwrap();
    assert_eq!(law(folder.path(), &text).unwrap(), whole);
    fs::remove_file(folder.path().join("faces-joint/cases/0003/summary.json")).unwrap();
    let study = samples(&folder.path().join("faces.toml"), &[]).unwrap();
    let partial =
        Law::collect(&study, &Folder::open(&folder.path().join("faces-joint"), &study).unwrap()).unwrap();
    assert_eq!((partial.samples, partial.missing), (2, 1));
    assert!(partial.doubts()[0].starts_with("1 of 3 samples"));
}

/// Patches of a measured map are cut along both axes, within its window.
#[test]
fn patches_of_a_map_are_samples() {
    let folder = tempfile::TempDir::new().unwrap();
    let heights: Vec<String> = (0..32)
        .map(|i| {
            let height = |j: i32| {
                30.0 * f64::sin(f64::from(7 * i * i + 3 * j)) + 20.0 * f64::cos(f64::from(5 * i - j * j))
            };
            (0..24).map(|j| format!("{:.3}", height(j))).collect::<Vec<_>>().join(",")
        })
        .collect();
    fs::write(folder.path().join("map.csv"), heights.join("\n")).unwrap();
    let text = CASE
        .replace(
            "topography = { generate = \"self-affine\", shape = [32, 32], pitch = \"1 um\", sq = \"50 nm\", hurst = 0.8, rolloff = \"8 um\", shortest = \"4 um\", seed = 3 }",
            "topography = { file = \"map.csv\", unit = \"nm\", pitch = \"1 um\", lines = \"y\", level = \"mean\" }",
        )
        .replace("topography = { generate = \"self-affine\", sq = \"50 nm\", hurst = 0.8, rolloff = \"8 um\", shortest = \"4 um\", seed = 4 }", "topography = { form = \"flat\" }")
        + "patches = [2, 3]\n";
    let path = folder.path().join("faces.toml");
    fs::write(&path, &text).unwrap();
    let study = samples(&path, &[]).unwrap();
    assert_eq!(study.len(), 6);
    let windows: Vec<String> = (1..=6).map(|case| study.text(case)).collect();
    assert!(windows[0].contains("[0, 0, 16, 8]") && windows[5].contains("[16, 16, 16, 8]"), "{windows:?}");
    let wrong = text.replace("[2, 3]", "[40, 3]");
    fs::write(&path, wrong).unwrap();
    let error = samples(&path, &[]).unwrap_err().to_string();
    assert!(error.contains("40 × 3 patches do not fit into 32 × 24 samples"), "{error}");
}

#[test]
fn a_case_that_is_no_joint_is_refused_at_its_key() {
    let folder = tempfile::TempDir::new().unwrap();
    let refused = |edit: [&str; 2], says: &str, hint: &str| {
        let path = folder.path().join("faces.toml");
        fs::write(&path, CASE.replace("shear = true\n", "").replace(edit[0], edit[1])).unwrap();
        let error = samples(&path, &[]).map(|study| study.len()).unwrap_err();
        let Error::Case(error) = error else { panic!("{error}") };
        let told = format!("{} {}", error.message, error.hint.unwrap_or_default());
        assert!(told.contains(says) && told.contains(hint), "{told}");
    };
    refused(["boundary = \"periodic\"", "boundary = \"free\""], "repeat along both axes", "counts the bulk");
    let one = "mean_pressures = [\"10 MPa\", \"20 MPa\", \"40 MPa\", \"80 MPa\", \"160 MPa\"]";
    refused([one, "mean_pressure = \"10 MPa\""], "needs several loads", "mean_pressures");
    refused(["[joint]\n", "[joint]\npatches = [2, 2]\n"], "neither body has a file", "samples = 8");
    refused(["[joint]\n", "[joint]\nsamples = 2\npatches = [2, 2]\n"], "samples are seeds", "give one");
    refused(["[joint]\n", "[joint]\nevery = 0\n"], "each of the loads", "leave `every` out");
    refused(["[joint]\n", "[joint]\nfiles = [\"a.npy\"]\n"], "one measured body", "give `file`");
    let apart = CASE.replace(one, "approaches = [\"10 nm\", \"20 nm\"]").replace("shear = true\n", "");
    let path = folder.path().join("faces.toml");
    fs::write(&path, apart + "samples = 2\n").unwrap();
    assert!(
        samples(&path, &[]).map(|study| study.len()).unwrap_err().to_string().contains("different pressures")
    );
    let smooth = CASE.replace(
        "generate = \"self-affine\"",
        "form = \"sinusoid\", amplitude = \"20 nm\", wavelength = \"8 um\"",
    );
    let smooth = smooth
        .replace(", sq = \"50 nm\", hurst = 0.8, rolloff = \"8 um\", shortest = \"4 um\", seed = 3", "");
    let smooth = smooth
        .replace(", sq = \"50 nm\", hurst = 0.8, rolloff = \"8 um\", shortest = \"4 um\", seed = 4", "");
    let path = folder.path().join("faces.toml");
    fs::write(&path, smooth.clone() + "samples = 2\n").unwrap();
    assert!(
        samples(&path, &[]).map(|study| study.len()).unwrap_err().to_string().contains("these have no seed")
    );
    // Without samples it is one, also of surfaces without a seed.
    fs::write(&path, smooth).unwrap();
    assert_eq!(samples(&path, &[]).unwrap().len(), 1);
}

#[test]
fn files_for_programs_keep_their_limits() {
    let folder = tempfile::TempDir::new().unwrap();
    let law = law(folder.path(), &format!("{CASE}samples = 3\n")).unwrap();
    let files = |client: Client, settings: ClientSettings| client.files(&law, &settings).unwrap();
    let settings = ClientSettings { units: Units::Millimetre, friction: Some(0.2) };
    let calculix = files(Client::Calculix, settings);
    let names: Vec<&str> = calculix.iter().map(|file| file.name.as_str()).collect();
    assert_eq!(names[..3], ["joint-calculix.inp", "joint-calculix-low.inp", "joint-calculix-high.inp"]);
    assert_eq!(names[3], "joint-calculix-heat.inp");
    let rows = |text: &str, card: &str| -> Vec<[f64; 2]> {
        let after = text.split(card).nth(1).unwrap();
        let rows = after.lines().skip(1).take_while(|line| !line.starts_with('*'));
        rows.map(|row| {
            let (a, b) = row.split_once(", ").unwrap();
            assert!(a.len() <= 20 && b.len() <= 20, "{row}");
            [a, b].map(|number| number.parse().unwrap())
        })
        .collect()
    };
    for file in &calculix {
        let table = rows(&file.text, "PRESSURE-OVERCLOSURE=TABULAR");
        assert!(table.len() <= 200 && table[0] == [0.0, 0.0]);
        assert!(table.is_sorted_by(|a, b| a[0] < b[0] && a[1] < b[1]), "{}", file.name);
        let [.., last, beyond] = table[..] else { panic!("two points") };
        assert!((beyond[0] / last[0] - 10.0).abs() < 1e-6, "ten times the largest pressure");
        assert!((last[0] - 160.0).abs() < 1e-6 && last[1] < 1.0, "MPa and mm");
        let head: Vec<&str> = file.text.lines().take_while(|line| line.starts_with("**")).collect();
        assert!(head.len() > 6 && head.iter().all(|line| line.is_ascii()), "{head:?}");
        let heat = file.name.contains("heat");
        assert_eq!(file.text.contains("*GAP CONDUCTANCE"), heat);
        assert_eq!(file.text.contains("EXPONENTIAL"), heat);
        let [coefficient, slope] = rows(&file.text, "*FRICTION")[0];
        assert!(coefficient == 0.2 && slope > 1e4, "{slope}");
    }
    // The same law in SI.
    let si = files(Client::Calculix, ClientSettings { units: Units::Metre, friction: None });
    let [mm, si] = [&calculix[0], &si[0]].map(|file| rows(&file.text, "PRESSURE-OVERCLOSURE=TABULAR"));
    for (mm, si) in mm.iter().zip(&si).skip(1) {
        assert!((mm[0] * 1e6 / si[0] - 1.0).abs() < 1e-8 && (mm[1] * 1e-3 / si[1] - 1.0).abs() < 1e-8);
    }
    for client in
        [Client::Abaqus, Client::Ansys, Client::Comsol, Client::Moose, Client::Opensees, Client::Csv]
    {
        let files = files(client, settings);
        assert!(files.iter().all(|file| file.text.lines().count() > 5), "{client:?}");
    }
    let coefficients = law.coefficients();
    assert!(coefficients.exponential.unwrap().decay > 0.1 * law.rms_height.median, "{coefficients:?}");
    assert!(coefficients.greenwood_tripp.unwrap().rms < 0.5 && coefficients.flow[0].unwrap().rms < 0.05);
}

/// The elastic slip γ of Abaqus gives the tangential stiffness μ p/γ, of which that in the middle of the range is right.
#[test]
fn abaqus_slips_as_the_joint_does() {
    let folder = tempfile::TempDir::new().unwrap();
    let even = CASE.replace("\"10 MPa\", ", "");
    let law = law(folder.path(), &format!("{even}samples = 2\n")).unwrap();
    assert_eq!(law.pressures.len(), 4);
    let settings = ClientSettings { units: Units::Metre, friction: Some(0.2) };
    let text = &Client::Abaqus.files(&law, &settings).unwrap()[0].text;
    let slip: f64 = text.split("ELASTIC SLIP=").nth(1).unwrap().lines().next().unwrap().parse().unwrap();
    let stiffness = law.values(Kind::StiffnessX, Edge::Median).unwrap()[2];
    assert!((0.2 * law.pressures[2] / slip / stiffness - 1.0).abs() < 1e-8, "{slip:e} {stiffness:e}");
}

/// CalculiX exchanges no heat between open faces.
#[test]
fn a_gas_is_refused_where_a_program_has_none() {
    let folder = tempfile::TempDir::new().unwrap();
    let gas = CASE.replace("[conductance]", "[conductance]\ngas = \"0.026 W/(m K)\"");
    let law = law(folder.path(), &format!("{gas}samples = 2\n")).unwrap();
    assert_eq!(law.checks.barber, None);
    let error = Client::Calculix.files(&law, &ClientSettings::default()).unwrap_err();
    assert!(matches!(error, Error::Unsupported(reason) if reason.contains("open faces")), "{error}");
    let path = folder.path().join("faces.toml");
    let error = samples(&path, &[Client::Csv, Client::Calculix]).map(|study| study.len()).unwrap_err();
    assert!(matches!(&error, Error::Case(error) if error.message.contains("open faces")), "{error}");
    // Open faces conduct, too.
    let abaqus = &Client::Abaqus.files(&law, &ClientSettings::default()).unwrap()[0].text;
    let first = abaqus.split("*GAP CONDUCTANCE, PRESSURE\n").nth(1).unwrap().lines().next().unwrap();
    let (conductance, pressure) = first.split_once(", ").unwrap();
    assert_eq!(pressure.parse::<f64>().unwrap(), 0.0);
    let h = law.values(Kind::ThermalConductance, Edge::Median).unwrap()[0] * 1e-3;
    assert!(
        (conductance.parse::<f64>().unwrap() / (law.gas_share * h) - 1.0).abs() < 1e-8
            && law.gas_share > 0.01
    );
}

/// Under tiny loads single cells bear, and the law is theirs: it is told, and no file has numbers that are none.
#[test]
fn loads_that_single_cells_bear_are_no_law() {
    let folder = tempfile::TempDir::new().unwrap();
    let tiny = CASE
        .replace(
            "[\"10 MPa\", \"20 MPa\", \"40 MPa\", \"80 MPa\", \"160 MPa\"]",
            "[\"1 Pa\", \"10 Pa\", \"80 MPa\"]",
        )
        .replace("[flow]\nviscosity = 0.08\nshear = true\n", "");
    let law = law(folder.path(), &format!("{tiny}samples = 2\n")).unwrap();
    let told = law.doubts().join("\n");
    assert!(told.contains("up to 10 Pa only a few cells"), "{told}");
    // What a run tells of a sample is told of the law.
    assert!(told.contains("2 of 2 samples: "), "{told}");
    for client in [Client::Calculix, Client::Abaqus, Client::Coefficients] {
        if let Ok(files) = client.files(&law, &ClientSettings::default()) {
            for file in files {
                let wrong = ["NaN", "inf,", "inf\n", "null,\n    \"decay"];
                assert!(wrong.iter().all(|wrong| !file.text.contains(wrong)), "{}", file.text);
            }
        }
    }
}

/// In full contact the gap no longer falls, and no program takes the law.
#[test]
fn surfaces_that_touch_everywhere_are_told() {
    let folder = tempfile::TempDir::new().unwrap();
    let full = CASE
        .replace("\"160 MPa\"", "\"20 GPa\", \"40 GPa\"")
        .replace("[flow]\nviscosity = 0.08\nshear = true\n", "");
    let law = law(folder.path(), &format!("{full}samples = 2\n")).unwrap();
    let told = law.doubts().join("\n");
    assert!(told.contains("from 20 GPa on the surfaces touch everywhere"), "{told}");
    assert!(Client::Moose.files(&law, &ClientSettings::default()).is_err());
}

/// Measured files take the place of that of the one measured body; what is generated beside has a seed of its own.
#[test]
fn files_are_samples() {
    let folder = tempfile::TempDir::new().unwrap();
    for (name, phase) in [("one.csv", 0.0), ("two.csv", 1.0)] {
        let line = |i: i32| {
            let height = |j: i32| 30.0 * f64::sin(f64::from(7 * i * i + 3 * j) + phase);
            (0..32).map(|j| format!("{:.3}", height(j))).collect::<Vec<_>>().join(",")
        };
        fs::write(folder.path().join(name), (0..32).map(line).collect::<Vec<_>>().join("\n")).unwrap();
    }
    let text = CASE.replace(
        "topography = { generate = \"self-affine\", shape = [32, 32], pitch = \"1 um\", sq = \"50 nm\", hurst = 0.8, rolloff = \"8 um\", shortest = \"4 um\", seed = 3 }",
        "topography = { file = \"one.csv\", unit = \"nm\", pitch = \"1 um\", lines = \"y\", level = \"mean\" }",
    ) + "files = [\"one.csv\", \"two.csv\"]\n";
    let path = folder.path().join("faces.toml");
    fs::write(&path, &text).unwrap();
    let study = samples(&path, &[]).unwrap();
    let told: Vec<String> = (1..=2).map(|case| study.text(case)).collect();
    assert!(told[0].contains("one.csv") && told[0].contains("upper.topography.seed = 4"), "{told:?}");
    assert!(told[1].contains("two.csv") && told[1].contains("upper.topography.seed = 1000007"), "{told:?}");
    let law = law(folder.path(), &text).unwrap();
    assert_eq!((law.samples, law.missing), (2, 0));
    assert!(!law.doubts().join("\n").contains("different surfaces"));
    // A file that is not there is told before anything is computed, and one of another surface with the law.
    fs::write(&path, text.replace("\"two.csv\"", "\"three.csv\"")).unwrap();
    let error = samples(&path, &[]).map(|study| study.len()).unwrap_err();
    assert!(matches!(&error, Error::Case(error) if error.key == "joint.files"), "{error}");
    let smooth = vec![["0.1"; 32].join(","); 31].join("\n") + "\n" + &["0"; 32].join(",");
    fs::write(folder.path().join("three.csv"), smooth).unwrap();
    fs::remove_dir_all(folder.path().join("faces-joint")).unwrap();
    let law = self::law(
        folder.path(),
        &text.replace("\"two.csv\"", "\"three.csv\"").replace("sq = \"50 nm\"", "sq = \"1 nm\""),
    )
    .unwrap();
    assert!(law.doubts().join("\n").contains("different surfaces"), "{:?}", law.rms_height);
}
