//! The command line as its users meet it: what goes to stdout, to stderr, and the exit code.

use std::fs;
use std::path::Path;
use std::process::Output;

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

use crate::support::{change, ok, refused, stderr};

#[test]
fn every_command_has_help_with_an_exit_code() {
    let help = ok(&run(Path::new("."), "--help"));
    for word in ["check", "example", "surface", "Exit code"] {
        assert!(help.contains(word), "{help}");
    }
    for command in [
        "run",
        "study",
        "check",
        "example",
        "surface",
        "surface generate low-pass",
        "surface info",
        "surface plot",
        "surface convert",
        "conductance",
        "flow",
        "plot",
        "report",
    ] {
        let help = ok(&run(Path::new("."), &format!("{command} --help")));
        assert!(help.contains("Usage: asperity"), "{help}");
    }
}

#[test]
fn a_surface_is_prepared_alike_for_a_look_and_for_a_file() {
    let folder = folder();
    let at = |arguments: &str| run(folder.path(), arguments);
    ok(&at("surface generate sphere --radius 2mm --shape 60x40 --pitch 5um --out ball.x3p"));
    let steps = "--window 4,0,50,40 --level sphere --rotate 90deg --resample 20x25";
    let converted = at(&format!("surface convert ball.x3p left.x3p {steps}"));
    ok(&converted);
    assert!(stderr(&converted).contains("convex sphere of radius 2"), "{}", stderr(&converted));
    let info = |arguments: &str| -> Value {
        serde_json::from_str(&ok(&at(&format!("surface info {arguments} --json")))).unwrap()
    };
    let (looked_at, written) = (info(&format!("ball.x3p {steps}")), info("left.x3p"));
    for key in ["shape", "pitch", "parameters"] {
        assert_eq!(looked_at[key], written[key], "{key}");
    }
    // A paraboloid is not quite a sphere: they differ by r⁴/8R³, 11 nm in the corners, before the fit takes its share.
    assert!(written["max"].as_f64().unwrap() < 5e-9);
    ok(&at("surface convert ball.x3p ball.npy"));
    let error = refused(&at("surface info ball.npy --s-filter 20um"));
    assert!(error.contains("--s-filter needs a pitch"), "{error}");
    let error = refused(&at("surface info ball.x3p --s-filter 2um"));
    assert!(error.contains("s_filter is 2 µm, expected a wavelength of at least two pitches"), "{error}");
    let error = refused(&at("surface info ball.x3p --level polynomial-99"));
    assert!(error.contains("from 0 to 16"), "{error}");
}

#[test]
fn a_pitch_is_printed_with_the_digits_that_a_case_needs_to_match_it() {
    let folder = folder();
    let at = |arguments: &str| run(folder.path(), arguments);
    for pitch in ["0.123456789123um", "1.333333333333um,0.4um", "2um"] {
        let made = format!(
            "surface generate sphere --radius 2mm --shape 12x10 --pitch {pitch} --out ball.x3p --overwrite"
        );
        ok(&at(&made));
        let info = ok(&at("surface info ball.x3p"));
        let row = info.lines().find(|line| line.starts_with("pitch")).unwrap();
        let (x, y) = row.trim_start_matches("pitch").split_once('×').unwrap();
        let case = |made: &str| {
            let body = |name: &str, topography: &str| {
                format!("[{name}]\nyoung = 210e9\npoisson = 0.3\ntopography = {{ {topography} }}\n")
            };
            let form = body("upper", &format!("form = \"flat\"{made}"));
            format!("{}{form}[contact]\nload = 1e-3\n", body("lower", "file = \"ball.x3p\""))
        };
        let typed = format!(", shape = [12, 10], pitch = [\"{}\", \"{}\"]", x.trim(), y.trim());
        // As typed, and left to be taken from the file.
        for made in [typed.as_str(), ""] {
            fs::write(folder.path().join("case.toml"), case(made)).unwrap();
            ok(&at("check case.toml"));
        }
    }
}

#[test]
fn a_case_beyond_the_memory_ends_before_any_work() {
    let folder = folder();
    let body = |name: &str| {
        format!(
            "[{name}]\nyoung = \"210 GPa\"\npoisson = 0.3\n[{name}.topography]\nform = \"flat\"\n\
             shape = [65536, 65536]\npitch = \"1 um\"\n"
        )
    };
    let case = format!("{}{}[contact]\nload = \"1 N\"\n", body("lower"), body("upper"));
    fs::write(folder.path().join("large.toml"), case).unwrap();
    fs::create_dir(folder.path().join("old")).unwrap();
    fs::write(folder.path().join("old/case.json"), "{}").unwrap();
    fs::write(folder.path().join("old/summary.json"), "{}").unwrap();
    for command in ["check large.toml", "run large.toml", "run large.toml --out old --overwrite"] {
        let began = std::time::Instant::now();
        let output = run(folder.path(), command);
        assert_eq!(output.status.code(), Some(1), "{command}: {}", stderr(&output));
        let said = stderr(&output);
        assert!(said.starts_with("error: about ") && said.contains(" GB of memory are needed, "), "{said}");
        assert!(began.elapsed().as_secs_f64() < 2.0);
    }
    assert!(!folder.path().join("large-results").exists() && folder.path().join("old/summary.json").exists());
}

#[test]
fn a_hurst_exponent_of_a_narrow_range_is_called_a_slope() {
    let folder = folder();
    let at = |arguments: &str| ok(&run(folder.path(), arguments));
    at(
        "surface generate self-affine --hurst 0.7 --sq 0.1um --shape 128x128 --pitch 1um --seed 1 --out z.x3p",
    );
    let told: Value = serde_json::from_str(&at("surface info z.x3p --json")).unwrap();
    let law = &told["self_affine"];
    assert!(law["decades"].as_f64().unwrap() < 1.0, "{law}");
    assert!(law["doubt"].as_str().unwrap().contains("a slope of the spectrum, not a law"), "{law}");
    assert!(at("surface info z.x3p").contains("of a decade: a slope of the spectrum, not a law"));
    at("surface plot z.x3p --out figures");
    let curves = fs::read_to_string(folder.path().join("figures/curves.json")).unwrap();
    assert!(curves.contains("a slope of the spectrum, not a law"));
}

#[test]
fn lengths_beyond_all_measure_are_bad_usage() {
    let folder = folder();
    ok(&run(folder.path(), "surface generate flat --shape 8x8 --pitch 1um --out z.npy"));
    for length in ["1e-310", "1e300", "0", "-1um"] {
        let error = refused(&run(folder.path(), &format!("surface info z.npy --pitch={length}")));
        assert!(error.contains("expected a length"), "{error}");
    }
}

#[test]
fn bad_usage_is_exit_code_2() {
    let folder = folder();
    for arguments in [
        "",
        "nonsense",
        "check",
        "check nowhere.toml",
        "surface info nowhere.x3p",
        "surface generate low-pass --shape 8x8 --pitch 1um --sq 1um --out z.npy",
        "surface generate low-pass --shape 8x8 --pitch 1ux --sq 1um --cutoff 4um --out z.npy",
        "surface generate low-pass --shape 8x8 --pitch 1um --sq 1um --cutoff 1um --out z.npy",
        "surface generate self-affine --shape 8x8 --pitch 1um --out z.npy",
        "surface generate self-affine --shape 8x8 --pitch 1um --sq 1um --sdq 0.1 --out z.npy",
        "example nonsense",
        "example --out somewhere",
    ] {
        let output = run(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments}: {}", stderr(&output));
        assert!(output.stdout.is_empty(), "{arguments}");
    }
    assert!(!folder.path().join("z.npy").exists());
}

#[test]
fn a_surface_survives_every_format_that_holds_it() {
    let folder = folder();
    let at = |arguments: &str| run(folder.path(), arguments);
    let make = "surface generate low-pass --shape 64x48 --pitch 0.5um,1um --sq 0.2um --cutoff 8um --seed 7";
    assert!(ok(&at(&format!("{make} --out z.npy"))).is_empty());
    ok(&at("surface convert z.npy z.x3p --pitch 0.5um,1um"));
    ok(&at("surface convert z.x3p z.sdf"));
    ok(&at("surface convert z.sdf z.gwy"));
    ok(&at("surface convert z.gwy again.npy"));
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert_eq!(bytes("z.npy"), bytes("again.npy"));
    ok(&at("surface convert z.x3p z.vtk"));
    ok(&at("surface convert z.x3p z.png"));
    assert!(bytes("z.vtk").starts_with(b"# vtk") && bytes("z.png").starts_with(b"\x89PNG"));

    let info: Value = serde_json::from_str(&ok(&at("surface info z.x3p --json"))).unwrap();
    let keys: Vec<_> = info.as_object().unwrap().keys().map(String::as_str).collect();
    let expected = [
        "asperities",
        "bandwidth",
        "channel",
        "channels",
        "format",
        "lines",
        "max",
        "mean",
        "min",
        "moments",
        "parameters",
        "pitch",
        "profiles",
        "self_affine",
        "shape",
        "undefined",
    ];
    assert_eq!(keys, expected);
    assert_eq!((&info["format"], &info["shape"]), (&"x3p".into(), &serde_json::json!([64, 48])));
    assert_eq!((&info["pitch"], &info["undefined"]), (&serde_json::json!([0.5e-6, 1e-6]), &0.into()));
    assert!((info["parameters"]["Sq"].as_f64().unwrap() / 0.2e-6 - 1.0).abs() < 1e-9);

    let text = ok(&at("surface info z.x3p"));
    for part in ["64 × 48", "500 nm × 1 µm", "32 µm × 48 µm", "200.0      nm", "Sdq", "Sdr", "Smrk1", "Vvv"]
    {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn conversion_prepares_in_its_order() {
    let folder = folder();
    let at = |arguments: &str| run(folder.path(), arguments);
    let file = folder.path().join("z.txt");
    fs::write(file, "1e-6 2e-6 3e-6 4e-6\nnan 2e-6 3e-6 4e-6\n1e-6 2e-6 3e-6 4e-6\n1e-6 2e-6 3e-6 4e-6\n")
        .unwrap();
    let info = |name: &str| -> Value {
        serde_json::from_str(&ok(&at(&format!("surface info {name} --json")))).unwrap()
    };
    assert_eq!(info("z.txt")["undefined"], 1);
    let bare = info("z.txt");
    for (value, given) in [("Sdq", false), ("Sdr", false), ("Sq", true), ("Sk", true)] {
        assert_eq!(bare["parameters"][value].is_number(), given, "{value}");
    }
    assert_eq!(bare["pitch"], Value::Null);
    ok(&at("surface convert z.txt z.x3p --pitch 1um --fill nearest --level plane --resample 2x2"));
    let after = info("z.x3p");
    assert_eq!((&after["shape"], &after["undefined"]), (&serde_json::json!([2, 2]), &0.into()));
    assert_eq!(after["pitch"], serde_json::json!([2e-6, 2e-6]));
    ok(&at("surface convert z.txt part.npy --window 2,0,2,2"));
    assert_eq!(info("part.npy")["shape"], serde_json::json!([2, 2]));
    let error = refused(&at("surface convert z.txt part.x3p --window 2,0,2,2"));
    assert!(error.contains("needs a pitch") && error.contains("hint: give it: --pitch"), "{error}");
}

#[test]
fn text_is_read_as_instruments_export_it() {
    let folder = folder();
    let at = |arguments: &str| run(folder.path(), arguments);
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let json = |arguments: &str| -> Value { serde_json::from_str(&ok(&at(arguments))).unwrap() };
    write("matrix.txt", "1 2 3 4 7\n5 3 1 2 4\n2 6 1 8 9\n");
    let matrix = "surface info matrix.txt --unit 1um --pitch 1um";
    for (option, lines, shape) in [("", "x", [5, 3]), ("--lines x", "x", [5, 3]), ("--lines y", "y", [3, 5])]
    {
        let info = json(&format!("{matrix} --json {option}"));
        assert_eq!((&info["lines"], &info["shape"]), (&lines.into(), &serde_json::json!(shape)));
    }
    for (unit, max) in [("nm", 9e-9), ("µm", 9e-6), ("0.5um", 4.5e-6)] {
        let info = json(&format!("surface info matrix.txt --unit {unit} --json"));
        assert!((info["max"].as_f64().unwrap() / max - 1.0).abs() < 1e-12, "{unit}: {info}");
    }
    let text = ok(&at(matrix));
    assert!(text.contains("direction of a line of the matrix; --lines y for the other"), "{text}");
    ok(&at("surface convert matrix.txt z.npy --unit 1um"));
    assert_eq!(json("surface info z.npy --json")["lines"], "y");
    ok(&at("surface convert matrix.txt z.x3p --unit 1um --pitch 1um"));
    assert_eq!(json("surface info z.x3p --json")["lines"], Value::Null);
    let error = refused(&at("surface info z.x3p --lines y"));
    assert!(error.contains("its format determines the order of the heights"), "{error}");

    write("words.csv", "Height map\nXY calibration,2,um\nUnit,um\n\n1,2,3,4\n5,3,1,2\n");
    let words = json("surface info words.csv --json");
    assert_eq!(
        (&words["shape"], &words["pitch"]),
        (&serde_json::json!([4, 2]), &serde_json::json!([2e-6, 2e-6]))
    );
    write("sizes.txt", "a disc\n4 2\n1 2 3 4\n5 3 1 2\n");
    let error = refused(&at("surface info sizes.txt"));
    assert!(error.contains("line 2: `4 2` is no height; the matrix begins at line 3"), "{error}");
    assert!(error.contains("hint: skip the 2 lines above the matrix: `--skip 2`"), "{error}");
    assert_eq!(json("surface info sizes.txt --skip 2 --json")["shape"], serde_json::json!([4, 2]));

    let profile: String = (0..64).map(|i| format!("{}\t{}\n", 0.5 * f64::from(i), i * i % 7)).collect();
    write("stylus.txt", &profile);
    let stylus = json("surface info stylus.txt --unit 1um --json");
    assert_eq!((&stylus["format"], &stylus["shape"]), (&"xz".into(), &serde_json::json!([64, 1])));
    assert_eq!(stylus["pitch"], serde_json::json!([0.5e-6, 0.5e-6]));
    assert!(stylus["profiles"]["x"]["Ra"].as_f64().unwrap() > 1e-6);
    ok(&at("surface plot stylus.txt --unit 1um --out figures"));
    let cloud: String =
        (0..25).map(|i| format!("0.{} 0.{} 0.{}\n", i * i * 7 % 97, i * i * 5 % 89, i * 3 % 7)).collect();
    write("cloud.txt", &cloud);
    let error = refused(&at("surface info cloud.txt --unit 1um"));
    assert!(error.contains("25 lines of 3 numbers look like points x, y and height on no grid"), "{error}");
    assert!(error.contains("scipy.interpolate.griddata") && error.contains("`--lines x`"), "{error}");
}

#[test]
fn tilt_form_and_flatness_are_told() {
    let folder = folder();
    let at = |arguments: &str| run(folder.path(), arguments);
    let heights = |tilt: f64, bend: f64| -> String {
        let z = |i: usize, j: usize| {
            1e-9 * f64::from(((7 * i + 5 * j) % 11) as u8) + tilt * i as f64 + bend * (i * i) as f64
        };
        (0..32).map(|j| (0..32).map(|i| format!("{:e} ", z(i, j))).collect::<String>() + "\n").collect()
    };
    for (tilt, bend, note) in [
        (0.0, 0.0, ""),
        (1e-8, 0.0, "note: tilt makes 99."),
        (-31.0 * 1e-9, 1e-9, "note: tilt and form make 99."),
    ] {
        std::fs::write(folder.path().join("z.txt"), heights(tilt, bend)).unwrap();
        let info = at("surface info z.txt --pitch 1um");
        assert!(
            stderr(&info).starts_with(note) && stderr(&info).is_empty() == note.is_empty(),
            "{}",
            stderr(&info)
        );
        assert!(note.is_empty() || stderr(&info).contains("`--level "), "{}", stderr(&info));
    }
    std::fs::write(folder.path().join("z.txt"), heights(1e-8, 0.0)).unwrap();
    let info = at("surface info z.txt --pitch 1um --level plane");
    assert_eq!(stderr(&info), "");
    let mean = ok(&info).lines().find(|line| line.starts_with("mean")).unwrap().to_owned();
    assert_eq!(mean.split_whitespace().nth(1), Some("0"), "{mean}");
    std::fs::write(folder.path().join("plane.txt"), "1 2 3 4\n2 3 4 5\n3 4 5 6\n4 5 6 7\n").unwrap();
    let flat = at("surface info plane.txt --pitch 1um --unit 1nm --level sphere");
    assert!(stderr(&flat).contains("the surface is flat"), "{}", stderr(&flat));
}

#[test]
fn a_topography_is_described_by_its_families_of_parameters() {
    let folder = folder();
    let at = |arguments: &str| run(folder.path(), arguments);
    ok(&at("surface generate self-affine --shape 96x80 --pitch 1um --sq 50nm --rolloff 40um --out z.x3p"));
    let text = ok(&at("surface info z.x3p --cutoff 20um"));
    for title in ["height", "spatial", "hybrid", "functional", "feature"] {
        assert!(text.contains(&format!("\n{title} parameters, ISO 25178-2\n")), "{text}");
    }
    for row in ["50.00 ", "Nayak's bandwidth", "Hurst exponent", "Rsm ", "along x | along y"] {
        assert!(text.contains(row), "{row}: {text}");
    }
    let json = |arguments: &str| -> Value { serde_json::from_str(&ok(&at(arguments))).unwrap() };
    let described = json("surface info z.x3p --json --cutoff 20um");
    assert!((described["parameters"]["Sq"].as_f64().unwrap() - 50e-9).abs() < 1e-15);
    assert!(described["moments"]["m2"][1].as_f64().unwrap() > 0.0);
    assert!(described["profiles"]["y"]["Ra"].as_f64().unwrap() < 50e-9);
    // Without a pitch there are heights, and no lengths along the surface.
    ok(&at("surface convert z.x3p z.npy"));
    let bare = json("surface info z.npy --json");
    assert_eq!(bare["parameters"]["Sq"], described["parameters"]["Sq"]);
    assert!(bare["parameters"]["Sdq"].is_null() && bare["parameters"]["Sal"].is_null());
    assert!(bare.get("moments").is_none() && bare["profiles"].is_null());
    // Nothing is said of the autocorrelation where the pitch alone is missing.
    assert!(!ok(&at("surface info z.npy")).contains("–: "));
    // A plane keeps its correlation over the whole map.
    fs::write(folder.path().join("tilted.txt"), "0 1 2 3\n0 1 2 3\n0 1 2 3\n0 1 2 3\n").unwrap();
    let tilted = ok(&at("surface info tilted.txt --pitch 1um --unit 1nm"));
    let isotropy = tilted.lines().find(|line| line.starts_with("Str ")).unwrap();
    assert!(isotropy.contains("(–: in some direction the autocorrelation does not fall"), "{isotropy}");
    // A line has no area.
    fs::write(folder.path().join("line.txt"), "0 1 0 2 0 1 0 3 0 2 0 1 0 2 0 1\n").unwrap();
    let line = json("surface info line.txt --pitch 1um --unit 1nm --json");
    assert!(line["parameters"].is_null() && line.get("moments").is_none(), "{line}");
    let ra = ["x", "y"].map(|axis| line["profiles"][axis]["Ra"].as_f64());
    assert!(ra.iter().flatten().count() == 1 && ra.iter().flatten().all(|ra| *ra > 0.0), "{line}");
    let error = refused(&at("surface info z.npy --cutoff 20um"));
    assert!(error.contains("--pitch 0.5um"), "{error}");
    let error = refused(&at("surface info z.x3p --cutoff 1um"));
    assert!(error.contains("cutoff is 1 µm, expected a length of at least two pitches"), "{error}");
}

#[test]
fn a_topography_is_drawn_with_its_curves() {
    let folder = folder();
    let at = |arguments: &str| run(folder.path(), arguments);
    ok(&at("surface generate self-affine --shape 96x80 --pitch 1um --sq 50nm --rolloff 40um --out z.x3p"));
    ok(&at("surface plot z.x3p --out figures"));
    let figures = folder.path().join("figures");
    for name in [
        "heights",
        "relief",
        "hills",
        "bearing",
        "height-distribution",
        "slope-distribution",
        "spectrum",
        "spectrum-map",
        "autocorrelation",
        "autocorrelation-map",
    ] {
        let picture = fs::read(figures.join(format!("{name}.png"))).unwrap();
        assert!(picture.starts_with(b"\x89PNG"), "{name}");
    }
    let curves: Value = serde_json::from_slice(&fs::read(figures.join("curves.json")).unwrap()).unwrap();
    let bearing = curves["bearing"]["ratio_height"].as_array().unwrap();
    assert!(bearing[0][1].as_f64() > bearing[bearing.len() - 1][1].as_f64());
    assert_eq!(curves["autocorrelation"]["x"][0], serde_json::json!([0.0, 1.0]));
    assert!(curves["spectrum"]["radial"][0]["density"].as_f64().unwrap() > 0.0);
    assert!(refused(&at("surface plot z.x3p --out figures")).contains("--overwrite"));
    // Without a name the folder has that of the file.
    ok(&at("surface plot z.x3p --dpi 30"));
    assert!(folder.path().join("z-figures/curves.json").is_file());
    // A plane has no roughness to draw, and is drawn all the same.
    ok(&at("surface generate flat --shape 16x16 --pitch 1um --out flat.x3p"));
    ok(&at("surface plot flat.x3p --out figures --overwrite"));
    // Nor has a surface so high that its square is no number a spectrum.
    fs::write(folder.path().join("high.txt"), "1e300 2e300 0\n0 1e300 3e300\n4e300 0 1e300\n").unwrap();
    ok(&at("surface plot high.txt --pitch 1um --out high"));
    fs::write(folder.path().join("nothing.txt"), "nan nan\nnan nan\n").unwrap();
    assert!(
        refused(&at("surface plot nothing.txt --pitch 1um --out nothing")).contains("none of the 4 samples")
    );
    assert!(!folder.path().join("nothing").exists());
}

#[test]
fn an_existing_file_is_replaced_only_on_request() {
    let folder = folder();
    let make = "surface generate flat --shape 8x8 --pitch 1um --out z.npy";
    ok(&run(folder.path(), make));
    let error = refused(&run(folder.path(), make));
    assert!(error.contains("`z.npy` exists") && error.contains("hint: --overwrite"), "{error}");
    ok(&run(folder.path(), &format!("{make} --overwrite")));
    let error = refused(&run(folder.path(), "surface convert z.npy z.jpg"));
    assert!(error.contains(".npy, .x3p, .sdf, .gwy, .vtk or .png"), "{error}");
}

#[test]
fn a_channel_that_is_not_there_names_those_that_are() {
    let folder = folder();
    ok(&run(folder.path(), "surface generate flat --shape 8x8 --pitch 1um --out z.x3p"));
    let error = refused(&run(folder.path(), "surface info z.x3p --channel phase"));
    assert!(error.contains("no height channel `phase`"), "{error}");
    assert!(error.contains("hint: it holds `height`; choose one with --channel"), "{error}");
}

#[test]
fn every_example_is_accepted_by_check_with_no_warning_but_that_of_a_long_stride() {
    let folder = folder();
    let list = ok(&run(folder.path(), "example"));
    let names: Vec<_> = list.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(
        names,
        [
            "quickstart",
            "hertz",
            "friction",
            "fretting",
            "viscoelastic",
            "micropitting",
            "measured",
            "running-in",
            "rolling",
            "pull-off",
            "contact-challenge",
            "seal",
            "study",
            "paper"
        ]
    );
    for name in names {
        ok(&run(folder.path(), &format!("example {name}")));
        let output = run(folder.path(), &format!("check {name}/case.toml"));
        let page = ok(&output);
        let modulus = match name {
            "pull-off" => "E* 531.8 MPa",
            "contact-challenge" => "E* 25 MPa",
            "seal" => "E* 19.11 GPa",
            "viscoelastic" => "E* 2.667 MPa relaxed",
            _ => "E* 115.4 GPa",
        };
        assert!(page.contains(modulus), "{page}");
        // That it moves by sixteen cells at a time is said.
        match name {
            "running-in" => assert!(stderr(&output).starts_with("warning: with `stride = 16`"), "{name}"),
            // Its rms slope is that of the problem, without the shortest waves.
            "contact-challenge" => {
                assert!(stderr(&output).starts_with("warning: the surfaces are steep"), "{name}")
            }
            _ => assert_eq!(stderr(&output), "", "{name}"),
        }
        let error = refused(&run(folder.path(), &format!("example {name}")));
        assert!(error.contains("exists"), "{error}");
    }
}

#[test]
fn the_figures_of_the_paper_replace_none_unasked() {
    let folder = folder();
    std::fs::create_dir(folder.path().join("p")).unwrap();
    std::fs::write(folder.path().join("p/cost.csv"), "mine").unwrap();
    let error = refused(&run(folder.path(), "paper --out p"));
    assert!(error.contains("`p/cost.csv` exists") && error.contains("--overwrite"), "{error}");
    assert!(refused(&run(folder.path(), "paper --out q --largest 8")).contains("16..=2048"));
    assert!(!folder.path().join("q").exists());
}

#[test]
fn check_counts_the_positions_and_weighs_the_load() {
    let folder = folder();
    ok(&run(folder.path(), "example paper --out p"));
    let page = ok(&run(folder.path(), "check p/case.toml"));
    for part in ["100 × 100 cells of 1 µm × 1 µm", "3 passes of 199 positions", "1.0 % of the plastic limit"]
    {
        assert!(page.contains(part), "{part}: {page}");
    }
    change(&folder.path().join("p/case.toml"), "load = \"0.2 N\"", "load = \"21 N\"");
    let output = run(folder.path(), "check p/case.toml");
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("exceeds the plastic limit"), "{}", stderr(&output));
    assert!(stderr(&output).contains("hint: give a load below 20.1 N"), "{}", stderr(&output));
}

#[test]
fn check_warns_of_a_coarse_mesh_of_steep_and_of_soft_surfaces() {
    let folder = folder();
    ok(&run(folder.path(), "example paper --out p"));
    change(&folder.path().join("p/case.toml"), "cutoff = \"12 um\"", "cutoff = \"3 um\"");
    change(&folder.path().join("p/case.toml"), "sq = \"55 nm\"", "sq = \"1 um\"");
    let output = run(folder.path(), "check p/case.toml");
    ok(&output);
    for part in ["warning: the mesh is coarse for the lower", "steep", "most of the contact will be plastic"]
    {
        assert!(stderr(&output).contains(part), "{part}: {}", stderr(&output));
    }
}

#[test]
fn check_tells_what_friction_will_take_and_what_it_cannot_hold() {
    let folder = folder();
    ok(&run(folder.path(), "example friction --out f"));
    let check = |from: &str, to: &str| {
        change(&folder.path().join("f/case.toml"), from, to);
        run(folder.path(), "check f/case.toml")
    };
    let said = |output: &Output, parts: &[&str]| {
        let page = ok(output) + &stderr(output);
        parts.iter().for_each(|part| assert!(page.contains(part), "{part}: {page}"));
    };
    let alike = check("steel ball pushed", "ball pushed");
    said(&alike, &["friction coefficient 0.3, coupling full, Dundurs' β 0.000; 61 increments in 4 stages"]);
    assert_eq!(stderr(&alike), "");

    // A softer plane: the two shear against each other while they are pressed together.
    let unlike =
        check("young = \"210 GPa\"\npoisson = 0.3\n[lower", "young = \"70 GPa\"\npoisson = 0.3\n[lower");
    said(
        &unlike,
        &["Dundurs' β 0.143", "warning: dissimilar bodies (Dundurs' β is 0.14)", "give `increments`"],
    );
    let gradual = check("coupling = \"full\"", "increments = 10\ncoupling = \"full\"");
    said(&gradual, &["70 increments in 4 stages"]);
    assert_eq!(stderr(&gradual), "");
    let half = check("coupling = \"full\"", "shear_strength = \"0.4 GPa\"\ncoupling = \"goodman\"");
    said(&half, &["shear up to 400 MPa, coupling goodman", "warning: the bodies are dissimilar", "is exact"]);

    let beyond = check("force = [\"-0.18 N\", 0]", "force = [\"-0.18 N\", \"0.25 N\"]");
    assert_eq!(beyond.status.code(), Some(1));
    assert!(
        stderr(&beyond).starts_with("error: tangential force 308.1 mN is not below"),
        "{}",
        stderr(&beyond)
    );
    assert!(
        stderr(&beyond).contains("hint: give a force below 300 mN, a displacement"),
        "{}",
        stderr(&beyond)
    );
    let stuck = check("coefficient = 0.3", "coefficient = inf");
    said(&stuck, &["coefficient inf, shear up to"]);
    check("shear_strength = \"0.4 GPa\"\n", "");
    let unloaded = check("force = [\"-0.18 N\", \"0.25 N\"]", "load = \"0.5 N\"");
    said(&unloaded, &["warning: under an infinite coefficient unloading may have no answer"]);
}

#[test]
fn a_mistake_is_shown_at_its_line_with_a_hint() {
    let folder = folder();
    ok(&run(folder.path(), "example quickstart --out q"));
    change(&folder.path().join("q/case.toml"), "hardness = \"2.8 GPa\"", "hardness = \"2.8 GPb\"");
    let error = refused(&run(folder.path(), "check q/case.toml"));
    assert!(error.starts_with("error: unknown unit 'GPb' in 'hardness'"), "{error}");
    assert!(error.contains("q/case.toml:15:12") && error.contains("hint: did you mean `GPa`?"), "{error}");
}

#[test]
fn surfaces_that_do_not_fit_are_told_how_to() {
    let folder = folder();
    let at = |arguments: &str| run(folder.path(), arguments);
    ok(&at("example measured --out m"));
    change(&folder.path().join("m/case.toml"), "pitch = \"1 um\"", "pitch = \"0.5 um\"");
    let error = refused(&at("check m/case.toml"));
    assert!(error.contains("different pitches: lower 1 µm × 1 µm, upper 500 nm × 500 nm"), "{error}");
    assert!(error.contains("`pitch = \"1 um\"` in [upper.topography]"), "{error}");
    assert!(error.contains("m/case.toml:27"), "{error}");

    change(&folder.path().join("m/case.toml"), "pitch = \"0.5 um\"", "pitch = \"1 um\"");
    change(&folder.path().join("m/case.toml"), "shape = [64, 128]", "shape = [64, 100]");
    let error = refused(&at("check m/case.toml"));
    assert!(error.contains("numbers of cells along y: lower 96 × 128, upper 64 × 100"), "{error}");
    assert!(error.contains("`window = [0, 0, 96, 100]` in [lower.topography]"), "{error}");
    change(&folder.path().join("m/case.toml"), "window = [0, 0, 96, 128]", "window = [0, 0, 96, 100]");
    ok(&at("check m/case.toml"));

    // Two files over one extent: as many cells as the other has.
    ok(&at("surface convert m/disc.x3p m/half.x3p --fill nearest --resample 64x64"));
    let upper = "[upper.topography]\nfile = \"half.x3p\"\n";
    let case = format!("{BODIES}fill = \"nearest\"\n{upper}[contact]\nload = 1\n[motion]\n");
    fs::write(folder.path().join("m/two.toml"), &case).unwrap();
    let error = refused(&at("check m/two.toml"));
    assert!(error.contains("`resample = [64, 64]` in [lower.topography]"), "{error}");
    let case = case.replace("fill = \"nearest\"\n", "fill = \"nearest\"\nresample = [64, 64]\n");
    fs::write(folder.path().join("m/two.toml"), &case).unwrap();
    ok(&at("check m/two.toml"));
}

#[test]
fn a_static_contact_needs_one_length_too() {
    let folder = folder();
    ok(&run(folder.path(), "example hertz --out h"));
    change(
        &folder.path().join("h/case.toml"),
        "form = \"flat\"\nshape = [128, 128]",
        "form = \"flat\"\nshape = [130, 128]",
    );
    let error = refused(&run(folder.path(), "check h/case.toml"));
    assert!(error.contains("along x: lower 130 × 128, upper 128 × 128"), "{error}");
    assert!(error.contains("`shape = [128, 128]` in [lower.topography]"), "{error}");
}

#[test]
fn a_step_that_this_surface_does_not_bear_is_named_at_its_line() {
    let folder = folder();
    ok(&run(folder.path(), "example measured --out m"));
    let flat =
        "[upper.topography]\nform = \"flat\"\nshape = [128, 128]\npitch = \"1 um\"\n[contact]\nload = 1\n";
    let check = |steps: &str| {
        fs::write(folder.path().join("m/case.toml"), format!("{BODIES}{steps}\n{flat}")).unwrap();
        run(folder.path(), "check m/case.toml")
    };
    let fill = "fill = \"nearest\"";
    let error = refused(&check(&format!("{fill}\ns_filter = \"1.5 um\"")));
    assert!(error.contains("'s_filter' is 1.5 µm, expected a wavelength of at least two pitches"), "{error}");
    assert!(error.contains("m/case.toml:10:12"), "{error}");
    let error = refused(&check(&format!("{fill}\ntaper = \"65 um\"")));
    assert!(error.contains("'taper' is 65 µm, expected a length above 0, at most half"), "{error}");
    let error = refused(&check("despike = 1"));
    assert!(error.contains("removed as spikes") && error.contains("m/case.toml:8:8"), "{error}");
    let error = refused(&check(&format!("{fill}\nwindow = [0, 0, 90, 90]\nrotate = \"-10 deg\"")));
    assert!(error.contains("`shape = [128, "), "{error}");
    fs::write(
        folder.path().join("m/case.toml"),
        format!(
            "{BODIES}{fill}\n{}",
            flat.replace("128, 128", "200, 200").replace("\"1 um\"", "\"1 um\"\nrotate = 0.1")
        ),
    )
    .unwrap();
    let error = refused(&run(folder.path(), "check m/case.toml"));
    assert!(error.contains("a smaller `window` in [upper.topography]"), "{error}");
    let told = ok(&check(&format!("{fill}\nlevel = \"sphere\"\nrotate = \"90 deg\"\nl_filter = \"30 um\"")));
    assert!(told.contains("115 filled; a sphere of radius"), "{told}");
}

#[test]
fn a_file_that_cannot_be_used_is_named_at_its_line() {
    let folder = folder();
    ok(&run(folder.path(), "example measured --out m"));
    let check = |case: &str| {
        fs::write(folder.path().join("m/case.toml"), case).unwrap();
        refused(&run(folder.path(), "check m/case.toml"))
    };
    let flat =
        "[upper.topography]\nform = \"flat\"\nshape = [128, 128]\npitch = \"1 um\"\n[contact]\nload = 1\n";
    let case = format!("{BODIES}{flat}");

    let error = check(&case);
    assert!(error.contains("115 of 16384 heights of m/disc.x3p are missing"), "{error}");
    assert!(
        error.contains("m/case.toml:8:8") && error.contains("hint: set `fill = \"harmonic\"`"),
        "{error}"
    );

    let error = check(&case.replace("disc.x3p", "disk.x3p"));
    assert!(error.contains("m/disk.x3p: ") && error.contains("case file's folder"), "{error}");

    let error = check(&case.replace("disc.x3p\"", "disc.x3p\"\nchannel = \"phase\""));
    assert!(error.contains("no height channel `phase`") && error.contains("m/case.toml:9:11"), "{error}");
    assert!(error.contains("hint: it holds `height`; choose one with `channel`"), "{error}");

    let error = check(&case.replace("disc.x3p\"", "disc.x3p\"\nwindow = [100, 0, 100, 100]"));
    assert!(error.contains("is not a part of the 128 × 128 samples"), "{error}");

    ok(&run(folder.path(), "surface convert m/disc.x3p m/disc.npy --fill nearest"));
    let error = check(&case.replace("disc.x3p", "disc.npy"));
    assert!(error.contains("(npy) has no pitch") && error.contains("hint: add the distance"), "{error}");

    let path = folder.path().join("m/disc.x3p");
    let mut bytes = fs::read(&path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle..middle + 64].fill(0);
    fs::write(&path, bytes).unwrap();
    let error = check(&case);
    assert!(error.starts_with("error: m/disc.x3p: x3p: "), "{error}");
    assert!(error.contains("m/case.toml:8:8"), "{error}");
}

/// A file below; ends in its topography.
const BODIES: &str = "lower.young = 210e9\nlower.poisson = 0.3\nupper.young = 210e9\nupper.poisson = 0.3\n\
                      \n\n[lower.topography]\nfile = \"disc.x3p\"\n";

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// `arguments` are split at spaces.
fn run(folder: &Path, arguments: &str) -> Output {
    let mut command = Command::cargo_bin("asperity").unwrap();
    command.current_dir(folder).args(arguments.split_whitespace()).output().unwrap()
}
