//! The command line as its users meet it: what goes to stdout, to stderr, and the exit code.

use std::fs;

use serde_json::{Value, json};
use tempfile::TempDir;

use crate::support::{asperity, assert_has, assert_refused, change, failed, json, ok, refused, set, stderr};

// ---- usage -----------------------------------------------------------------------------------------------

#[test]
fn every_command_has_help_with_an_exit_code() {
    let folder = folder();
    assert_has(&ok(&asperity(&folder, "--help")), "check … example … surface … Exit code");
    for command in [
        "run",
        "study",
        "joint",
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
        assert_has(&ok(&asperity(&folder, &format!("{command} --help"))), "Usage: asperity");
    }
}

#[test]
fn bad_usage_is_exit_code_2() {
    let folder = folder();
    ok(&asperity(&folder, "surface generate flat --shape 8x8 --pitch 1um --out flat.x3p"));
    ok(&asperity(&folder, "surface convert flat.x3p flat.npy"));
    let generate = "surface generate low-pass --shape 8x8 --out z.npy";
    let self_affine = "surface generate self-affine --shape 8x8 --pitch 1um --out z.npy";
    for arguments in [
        "",
        "nonsense",
        "check",
        "check nowhere.toml",
        "surface info nowhere.x3p",
        &format!("{generate} --pitch 1um --sq 1um"),
        &format!("{generate} --pitch 1ux --sq 1um --cutoff 4um"),
        &format!("{generate} --pitch 1um --sq 1um --cutoff 1um"),
        self_affine,
        &format!("{self_affine} --sq 1um --sdq 0.1"),
        "example nonsense",
        "example --out somewhere",
    ] {
        refused(&asperity(&folder, arguments));
    }
    assert_refused(
        &folder,
        [
            ("surface info flat.npy --pitch=1e-310", "expected a length"),
            ("surface info flat.npy --pitch=1e300", "expected a length"),
            ("surface info flat.npy --pitch=0", "expected a length"),
            ("surface info flat.npy --pitch=-1um", "expected a length"),
            ("surface info flat.npy --s-filter 20um", "--s-filter needs a pitch"),
            (
                "surface info flat.x3p --s-filter 1um",
                "s_filter is 1 µm … a wavelength of at least two pitches",
            ),
            ("surface info flat.x3p --level polynomial-99", "from 0 to 16"),
            ("surface info flat.npy --cutoff 20um", "--pitch 0.5um"),
            ("surface info flat.x3p --cutoff 1um", "cutoff is 1 µm … a length of at least two pitches"),
            ("surface info flat.x3p --lines y", "its format determines the order of the heights"),
            (
                "surface info flat.x3p --channel phase",
                "no height channel `phase` … hint: it holds `height`; choose one with --channel",
            ),
            ("surface convert flat.npy z.jpg", ".npy, .x3p, .sdf, .gwy, .vtk or .png"),
            ("surface convert flat.npy z.x3p", "needs a pitch … hint: give it: --pitch"),
            (
                "surface generate flat --shape 8x8 --pitch 1um --out flat.npy",
                "`flat.npy` exists … hint: --overwrite",
            ),
            ("run case.toml --resume --overwrite", "cannot be used with"),
            ("paper --out q --largest 8", "16..=2048"),
        ],
    );
    ok(&asperity(&folder, "surface generate flat --shape 8x8 --pitch 1um --out flat.npy --overwrite"));
    for name in ["z.npy", "z.jpg", "z.x3p", "q"] {
        assert!(!folder.path().join(name).exists(), "{name}");
    }
}

#[test]
fn a_case_beyond_the_memory_ends_before_any_work() {
    let folder = folder();
    let body = "{ young = \"210 GPa\", poisson = 0.3, topography = { form = \"flat\", shape = [65536, 65536], \
                pitch = \"1 um\" } }";
    let case = format!("lower = {body}\nupper = {body}\ncontact = {{ load = \"1 N\" }}\n");
    fs::write(folder.path().join("large.toml"), case).unwrap();
    fs::create_dir(folder.path().join("old")).unwrap();
    fs::write(folder.path().join("old/case.json"), "{}").unwrap();
    fs::write(folder.path().join("old/summary.json"), "{}").unwrap();
    for command in ["check large.toml", "run large.toml", "run large.toml --out old --overwrite"] {
        let began = std::time::Instant::now();
        let said = failed(&asperity(&folder, command), 1);
        assert!(said.starts_with("error: about ") && said.contains(" GB of memory are needed, "), "{said}");
        assert!(began.elapsed().as_secs_f64() < 2.0);
    }
    assert!(!folder.path().join("large-results").exists() && folder.path().join("old/summary.json").exists());
}

#[test]
fn the_figures_of_the_paper_replace_none_unasked() {
    let folder = folder();
    fs::create_dir(folder.path().join("p")).unwrap();
    fs::write(folder.path().join("p/cost.csv"), "mine").unwrap();
    assert_refused(&folder, [("paper --out p", "`p/cost.csv` exists … --overwrite")]);
}

// ---- surfaces --------------------------------------------------------------------------------------------

#[test]
fn a_surface_is_prepared_alike_for_a_look_and_for_a_file() {
    let folder = folder();
    let at = |arguments: &str| asperity(&folder, arguments);
    ok(&at("surface generate sphere --radius 2mm --shape 60x40 --pitch 5um --out ball.x3p"));
    let steps = "--window 4,0,50,40 --level sphere --rotate 90deg --resample 20x25";
    let converted = at(&format!("surface convert ball.x3p left.x3p {steps}"));
    ok(&converted);
    assert_has(&stderr(&converted), "convex sphere of radius 2");
    let (looked_at, written) = (info(&folder, &format!("ball.x3p {steps}")), info(&folder, "left.x3p"));
    for key in ["shape", "pitch", "parameters"] {
        assert_eq!(looked_at[key], written[key], "{key}");
    }
    // A paraboloid is not quite a sphere: they differ by r⁴/8R³, 11 nm in the corners, before the fit takes
    // its share.
    assert!(written["max"].as_f64().unwrap() < 5e-9);
}

#[test]
fn a_pitch_is_printed_with_the_digits_that_a_case_needs_to_match_it() {
    let folder = folder();
    let body = |name: &str, topography: &str| {
        format!("{name} = {{ young = 210e9, poisson = 0.3, topography = {{ {topography} }} }}\n")
    };
    let lower = body("lower", "file = \"ball.x3p\"");
    for pitch in ["0.123456789123um", "1.333333333333um,0.4um", "2um"] {
        let made = format!("surface generate sphere --radius 2mm --shape 12x10 --pitch {pitch}");
        ok(&asperity(&folder, &format!("{made} --out ball.x3p --overwrite")));
        let info = ok(&asperity(&folder, "surface info ball.x3p"));
        let row = info.lines().find(|line| line.starts_with("pitch")).unwrap();
        let (x, y) = row.trim_start_matches("pitch").split_once('×').unwrap();
        let typed = format!(", shape = [12, 10], pitch = [\"{}\", \"{}\"]", x.trim(), y.trim());
        // As typed, and left to be taken from the file.
        for made in [typed.as_str(), ""] {
            let upper = body("upper", &format!("form = \"flat\"{made}"));
            let case = format!("{lower}{upper}contact = {{ load = 1e-3 }}\n");
            fs::write(folder.path().join("case.toml"), case).unwrap();
            ok(&asperity(&folder, "check case.toml"));
        }
    }
}

#[test]
fn a_hurst_exponent_of_a_narrow_range_is_called_a_slope() {
    let folder = folder();
    let at = |arguments: &str| ok(&asperity(&folder, arguments));
    at("surface generate self-affine --hurst 0.7 --sq 0.1um --shape 128x128 --pitch 1um --out z.x3p");
    let slope = "a slope of the spectrum, not a law";
    let law = &info(&folder, "z.x3p")["self_affine"];
    assert!(law["decades"].as_f64().unwrap() < 1.0, "{law}");
    assert_has(law["doubt"].as_str().unwrap(), slope);
    assert_has(&at("surface info z.x3p"), &format!("of a decade: {slope}"));
    at("surface plot z.x3p --out figures");
    assert_has(&fs::read_to_string(folder.path().join("figures/curves.json")).unwrap(), slope);
}

#[test]
fn a_surface_is_converted_to_other_formats_and_described() {
    let folder = folder();
    let at = |arguments: &str| asperity(&folder, arguments);
    let make = "surface generate low-pass --shape 64x48 --pitch 0.5um,1um --sq 0.2um --cutoff 8um --seed 7";
    assert!(ok(&at(&format!("{make} --out z.npy"))).is_empty());
    ok(&at("surface convert z.npy z.x3p --pitch 0.5um,1um"));
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    for name in ["again.npy", "z.vtk", "z.png"] {
        ok(&at(&format!("surface convert z.x3p {name}")));
    }
    assert_eq!(bytes("z.npy"), bytes("again.npy"));
    assert!(bytes("z.vtk").starts_with(b"# vtk") && bytes("z.png").starts_with(b"\x89PNG"));

    let found = info(&folder, "z.x3p");
    let keys = "asperities bandwidth channel channels format lines max mean min moments parameters pitch profiles \
                self_affine shape undefined";
    assert_eq!(crate::support::keys(&found), set(keys));
    assert_eq!((&found["format"], &found["shape"]), (&json!("x3p"), &json!([64, 48])));
    assert_eq!((&found["pitch"], &found["undefined"]), (&json!([0.5e-6, 1e-6]), &json!(0)));
    assert!((found["parameters"]["Sq"].as_f64().unwrap() / 0.2e-6 - 1.0).abs() < 1e-9);

    let text = ok(&at("surface info z.x3p"));
    assert_has(&text, "64 × 48 … 500 nm × 1 µm … 32 µm × 48 µm … 200.0      nm … Sdq … Sdr … Smrk1 … Vvv");
}

#[test]
fn conversion_fills_levels_cuts_and_resamples() {
    let folder = folder();
    let at = |arguments: &str| asperity(&folder, arguments);
    let line = "1e-6 2e-6 3e-6 4e-6\n";
    fs::write(folder.path().join("z.txt"), format!("{line}{}{line}{line}", line.replace("1e-6", "nan")))
        .unwrap();
    let bare = info(&folder, "z.txt");
    assert_eq!((&bare["undefined"], &bare["pitch"]), (&json!(1), &Value::Null));
    // Without a pitch there are heights, and no lengths along the surface.
    for (value, given) in [("Sdq", false), ("Sdr", false), ("Sal", false), ("Sq", true), ("Sk", true)] {
        assert_eq!(bare["parameters"][value].is_number(), given, "{value}");
    }
    assert!(bare.get("moments").is_none() && bare["profiles"].is_null());
    ok(&at("surface convert z.txt z.x3p --pitch 1um --fill nearest --level plane --resample 2x2"));
    let after = info(&folder, "z.x3p");
    assert_eq!((&after["shape"], &after["undefined"]), (&json!([2, 2]), &json!(0)));
    assert_eq!(after["pitch"], json!([2e-6, 2e-6]));
    ok(&at("surface convert z.txt part.npy --window 2,0,2,2"));
    assert_eq!(info(&folder, "part.npy")["shape"], json!([2, 2]));
}

#[test]
fn text_has_the_unit_the_lines_and_the_words_above_it_that_are_named() {
    let folder = folder();
    let at = |arguments: &str| asperity(&folder, arguments);
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("matrix.txt", "1 2 3 4 7\n5 3 1 2 4\n2 6 1 8 9\n");
    let matrix = "matrix.txt --unit 1um --pitch 1um";
    for (option, lines, shape) in [("", "x", [5, 3]), ("--lines x", "x", [5, 3]), ("--lines y", "y", [3, 5])]
    {
        let info = info(&folder, &format!("{matrix} {option}"));
        assert_eq!((&info["lines"], &info["shape"]), (&json!(lines), &json!(shape)));
    }
    for (unit, max) in [("nm", 9e-9), ("µm", 9e-6), ("0.5um", 4.5e-6)] {
        let info = info(&folder, &format!("matrix.txt --unit {unit}"));
        assert!((info["max"].as_f64().unwrap() / max - 1.0).abs() < 1e-12, "{unit}: {info}");
    }
    let told = "direction of a line of the matrix; --lines y for the other";
    assert_has(&ok(&at(&format!("surface info {matrix}"))), told);
    ok(&at("surface convert matrix.txt z.npy --unit 1um"));
    assert_eq!(info(&folder, "z.npy")["lines"], "y");
    ok(&at("surface convert matrix.txt z.x3p --unit 1um --pitch 1um"));
    assert_eq!(info(&folder, "z.x3p")["lines"], Value::Null);

    write("sizes.txt", "a disc\n4 2\n1 2 3 4\n5 3 1 2\n");
    assert_eq!(info(&folder, "sizes.txt --skip 2")["shape"], json!([4, 2]));
    let profile: String = (0..64).map(|i| format!("{}\t{}\n", 0.5 * f64::from(i), i * i % 7)).collect();
    write("stylus.txt", &profile);
    assert!(info(&folder, "stylus.txt --unit 1um")["profiles"]["x"]["Ra"].as_f64().unwrap() > 1e-6);
    ok(&at("surface plot stylus.txt --unit 1um --out figures"));
    let point = |i: u32| format!("0.{} 0.{} 0.{}\n", i * i * 7 % 97, i * i * 5 % 89, i * 3 % 7);
    write("cloud.txt", &(0..25).map(point).collect::<String>());
    assert_refused(
        &folder,
        [
            (
                "surface info sizes.txt",
                "line 2: `4 2` is no height; the matrix begins at line 3 … \
                 hint: skip the 2 lines above the matrix: `--skip 2`",
            ),
            (
                "surface info cloud.txt --unit 1um",
                "25 lines of 3 numbers look like points x, y and height on no grid … \
                 scipy.interpolate.griddata … `--lines x`",
            ),
        ],
    );
}

#[test]
fn tilt_form_and_flatness_are_told() {
    let folder = folder();
    let heights = |tilt: f64, bend: f64| {
        let z = |i: usize, j: usize| {
            1e-9 * f64::from(((7 * i + 5 * j) % 11) as u8) + tilt * i as f64 + bend * (i * i) as f64
        };
        let line = |j: usize| (0..32).map(|i| format!("{:e} ", z(i, j))).collect::<String>() + "\n";
        fs::write(folder.path().join("z.txt"), (0..32).map(line).collect::<String>()).unwrap();
    };
    let at = |arguments: &str| asperity(&folder, &format!("surface info {arguments} --pitch 1um"));
    heights(0.0, 0.0);
    assert_eq!(stderr(&at("z.txt")), "");
    for (tilt, bend, note) in
        [(-31.0 * 1e-9, 1e-9, "note: tilt and form make 99."), (1e-8, 0.0, "note: tilt makes 99.")]
    {
        heights(tilt, bend);
        let said = stderr(&at("z.txt"));
        assert!(said.starts_with(note) && said.contains("`--level "), "{said}");
    }
    let levelled = at("z.txt --level plane");
    assert_eq!(stderr(&levelled), "");
    let mean = ok(&levelled).lines().find(|line| line.starts_with("mean")).unwrap().to_owned();
    assert_eq!(mean.split_whitespace().nth(1), Some("0"), "{mean}");
    fs::write(folder.path().join("plane.txt"), "1 2 3 4\n2 3 4 5\n3 4 5 6\n4 5 6 7\n").unwrap();
    assert_has(&stderr(&at("plane.txt --unit 1nm --level sphere")), "the surface is flat");
}

#[test]
fn a_topography_is_described_by_its_families_of_parameters() {
    let folder = folder();
    let at = |arguments: &str| asperity(&folder, arguments);
    ok(&at("surface generate self-affine --shape 96x80 --pitch 1um --sq 50nm --rolloff 40um --out z.x3p"));
    let text = ok(&at("surface info z.x3p --cutoff 20um"));
    for title in ["height", "spatial", "hybrid", "functional", "feature"] {
        assert_has(&text, &format!("\n{title} parameters, ISO 25178-2\n"));
    }
    assert_has(&text, "50.00  … Nayak's bandwidth … Hurst exponent … Rsm  … along x | along y");
    let described = info(&folder, "z.x3p --cutoff 20um");
    assert!((described["parameters"]["Sq"].as_f64().unwrap() - 50e-9).abs() < 1e-15);
    assert!(described["moments"]["m2"][1].as_f64().unwrap() > 0.0);
    assert!(described["profiles"]["y"]["Ra"].as_f64().unwrap() < 50e-9);
    // Nothing is said of the autocorrelation where the pitch alone is missing.
    ok(&at("surface convert z.x3p z.npy"));
    assert_eq!(info(&folder, "z.npy")["parameters"]["Sq"], described["parameters"]["Sq"]);
    assert!(!ok(&at("surface info z.npy")).contains("–: "));
    // A plane keeps its correlation over the whole map.
    fs::write(folder.path().join("tilted.txt"), "0 1 2 3\n0 1 2 3\n0 1 2 3\n0 1 2 3\n").unwrap();
    let tilted = ok(&at("surface info tilted.txt --pitch 1um --unit 1nm"));
    let isotropy = tilted.lines().find(|line| line.starts_with("Str ")).unwrap();
    assert_has(isotropy, "(–: in some direction the autocorrelation does not fall");
    // A line has no area.
    fs::write(folder.path().join("line.txt"), "0 1 0 2 0 1 0 3 0 2 0 1 0 2 0 1\n").unwrap();
    let line = info(&folder, "line.txt --pitch 1um --unit 1nm");
    assert!(line["parameters"].is_null() && line.get("moments").is_none(), "{line}");
    let ra = ["x", "y"].map(|axis| line["profiles"][axis]["Ra"].as_f64());
    assert!(ra.iter().flatten().count() == 1 && ra.iter().flatten().all(|ra| *ra > 0.0), "{line}");
}

#[test]
fn a_topography_is_drawn_with_its_curves() {
    let folder = folder();
    let at = |arguments: &str| asperity(&folder, arguments);
    ok(&at("surface generate self-affine --shape 96x80 --pitch 1um --sq 50nm --rolloff 40um --out z.x3p"));
    ok(&at("surface plot z.x3p --out figures"));
    let figures = folder.path().join("figures");
    let names = "heights relief hills bearing height-distribution slope-distribution spectrum spectrum-map \
                 autocorrelation autocorrelation-map";
    for name in set(names) {
        let picture = fs::read(figures.join(format!("{name}.png"))).unwrap();
        assert!(picture.starts_with(b"\x89PNG"), "{name}");
    }
    let curves: Value = serde_json::from_slice(&fs::read(figures.join("curves.json")).unwrap()).unwrap();
    let bearing = curves["bearing"]["ratio_height"].as_array().unwrap();
    assert!(bearing[0][1].as_f64() > bearing[bearing.len() - 1][1].as_f64());
    assert_eq!(curves["autocorrelation"]["x"][0], json!([0.0, 1.0]));
    assert!(curves["spectrum"]["radial"][0]["density"].as_f64().unwrap() > 0.0);
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
    assert_refused(
        &folder,
        [
            ("surface plot z.x3p --out figures", "--overwrite"),
            ("surface plot nothing.txt --pitch 1um --out nothing", "none of the 4 samples"),
        ],
    );
    assert!(!folder.path().join("nothing").exists());
}

// ---- check -----------------------------------------------------------------------------------------------

#[test]
fn every_example_is_accepted_by_check_with_no_warning_but_that_of_a_long_stride() {
    let folder = folder();
    let list = ok(&asperity(&folder, "example"));
    let names: Vec<_> = list.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(
        names.join(" "),
        "quickstart hertz friction fretting stribeck viscoelastic coating micropitting measured running-in rolling pull-off \
         contact-challenge seal joint study paper"
    );
    for name in names {
        ok(&asperity(&folder, &format!("example {name}")));
        let output = asperity(&folder, &format!("check {name}/case.toml"));
        let modulus = match name {
            "pull-off" => "E* 531.8 MPa",
            "contact-challenge" => "E* 25 MPa",
            "seal" => "E* 19.11 GPa",
            "viscoelastic" => "E* 2.667 MPa relaxed",
            "coating" => "E* 114.2 GPa without the layers",
            _ => "E* 115.4 GPa",
        };
        assert_has(&ok(&output), modulus);
        let warning = match name {
            // The bodies move by sixteen cells at a time.
            "running-in" => "warning: with `stride = 16`",
            // The rms slope is that of the problem, without the shortest waves.
            "contact-challenge" => "warning: the surfaces are steep",
            _ => "",
        };
        let said = stderr(&output);
        assert!(said.starts_with(warning) && said.is_empty() == warning.is_empty(), "{name}: {said}");
        assert_refused(&folder, [(&format!("example {name}"), "exists")]);
    }
}

#[test]
fn the_oil_between_bodies_at_rest_and_in_motion_is_described() {
    let folder = folder();
    let case = |of: &str| {
        format!(
            "lower = {{ material = \"steel\", topography = {{ form = \"flat\", shape = [32, 32], pitch = \"15 um\" }} }}\n\
             upper = {{ material = \"steel\", topography = {{ form = \"sphere\", radius = \"10 mm\" }} }}\n\
             contact = {{ load = \"5 N\" }}\ntemperature = {{ bulk = \"70 °C\" }}\n{of}"
        )
    };
    for (of, course) in [
        ("lubrication = { oil = \"ISO VG 46\", speed = \"1 m/s\" }\n", "motion   a steady film at 1 m/s"),
        (
            "lubrication = { oil = \"ISO VG 46\" }\n\
             motion = { strategy = \"shift\", speed_lower = \"1 m/s\", speed_upper = 0, control = \"step-load\" }\n",
            "motion   shift, 1 pass of 32 positions",
        ),
    ] {
        fs::write(folder.path().join("oil.toml"), case(of)).unwrap();
        let page = ok(&asperity(&folder, "check oil.toml"));
        assert_has(&page, &format!("{course} … oil      ISO VG 46, viscosity 12.34 mPa s"));
    }
}

#[test]
fn check_counts_the_positions_weighs_the_load_and_warns_of_steep_surfaces() {
    let folder = folder();
    ok(&asperity(&folder, "example paper --out p"));
    let case = folder.path().join("p/case.toml");
    let page = ok(&asperity(&folder, "check p/case.toml"));
    assert_has(
        &page,
        "100 × 100 cells of 1 µm × 1 µm … 3 passes of 199 positions … 1.0 % of the plastic limit",
    );
    change(&case, "cutoff = \"12 um\"", "cutoff = \"3 um\"");
    change(&case, "sq = \"55 nm\"", "sq = \"1 um\"");
    let output = asperity(&folder, "check p/case.toml");
    ok(&output);
    let warnings = "warning: the mesh is coarse for the lower … steep … most of the contact will be plastic";
    assert_has(&stderr(&output), warnings);
}

#[test]
fn check_tells_what_friction_will_take() {
    let folder = folder();
    ok(&asperity(&folder, "example friction --out f"));
    let check = |from: &str, to: &str| {
        change(&folder.path().join("f/case.toml"), from, to);
        asperity(&folder, "check f/case.toml")
    };
    let alike = check("steel ball pushed", "ball pushed");
    let law = "friction coefficient 0.3, coupling full, Dundurs' β 0.000; 61 increments in 4 stages";
    assert_has(&ok(&alike), law);
    assert_eq!(stderr(&alike), "");

    // A softer plane: the two shear against each other while they are pressed together.
    let steel = "young = \"210 GPa\"\npoisson = 0.3\n[lower";
    let unlike = check(steel, &steel.replace("210", "70"));
    assert_has(&ok(&unlike), "Dundurs' β 0.143");
    assert_has(&stderr(&unlike), "warning: dissimilar bodies (Dundurs' β is 0.14) … give `increments`");
    let gradual = check("coupling = \"full\"", "increments = 10\ncoupling = \"full\"");
    assert_has(&ok(&gradual), "70 increments in 4 stages");
    assert_eq!(stderr(&gradual), "");
    let half = check("coupling = \"full\"", "shear_strength = \"0.4 GPa\"\ncoupling = \"goodman\"");
    assert_has(&ok(&half), "shear up to 400 MPa, coupling goodman");
    assert_has(&stderr(&half), "warning: the bodies are dissimilar … is exact");

    let stuck = check("coefficient = 0.3", "coefficient = inf");
    assert_has(&ok(&stuck), "coefficient inf, shear up to");
    check("shear_strength = \"0.4 GPa\"\n", "");
    let unloaded = check("force = [\"-0.18 N\", 0]", "load = \"0.5 N\"");
    ok(&unloaded);
    assert_has(&stderr(&unloaded), "warning: under an infinite coefficient unloading may have no answer");
}

// ---- mistakes at their lines -----------------------------------------------------------------------------

#[test]
fn a_mistake_is_shown_at_its_line_with_a_hint() {
    let folder = folder();
    ok(&asperity(&folder, "example quickstart --out q"));
    change(&folder.path().join("q/case.toml"), "hardness = \"2.8 GPa\"", "hardness = \"2.8 GPb\"");
    let error = refused(&asperity(&folder, "check q/case.toml"));
    assert!(error.starts_with("error: unknown unit 'GPb' in 'hardness'"), "{error}");
    assert_has(&error, "q/case.toml:15:12 … hint: did you mean `GPa`?");
}

#[test]
fn surfaces_that_do_not_fit_are_told_how_to() {
    let folder = folder();
    let path = folder.path().join("m/case.toml");
    let refused_for = |parts: &str| assert_refused(&folder, [("check m/case.toml", parts)]);
    ok(&asperity(&folder, "example measured --out m"));
    change(&path, "shape = [64, 128]", "shape = [64, 100]");
    refused_for(
        "numbers of cells along y: lower 96 × 128, upper 64 × 100 … \
         `window = [0, 0, 96, 100]` in [lower.topography]",
    );
    change(&path, "window = [0, 0, 96, 128]", "window = [0, 0, 96, 100]");
    ok(&asperity(&folder, "check m/case.toml"));

    // Two files over one extent: as many cells as the other has.
    ok(&asperity(&folder, "surface convert m/disc.x3p m/half.x3p --fill nearest --resample 64x64"));
    let upper = "[upper.topography]\nfile = \"half.x3p\"\n";
    fs::write(&path, format!("{BODIES}fill = \"nearest\"\n{upper}[contact]\nload = 1\n[motion]\n")).unwrap();
    refused_for("`resample = [64, 64]` in [lower.topography]");
    change(&path, "fill = \"nearest\"\n", "fill = \"nearest\"\nresample = [64, 64]\n");
    ok(&asperity(&folder, "check m/case.toml"));

    // A static contact needs one length too.
    ok(&asperity(&folder, "example hertz --out h"));
    let flat = "form = \"flat\"\nshape = [128, 128]";
    change(&folder.path().join("h/case.toml"), flat, &flat.replacen("128", "130", 1));
    let told = "along x: lower 130 × 128, upper 128 × 128 … `shape = [128, 128]` in [lower.topography]";
    assert_refused(&folder, [("check h/case.toml", told)]);
}

#[test]
fn a_step_that_this_surface_does_not_bear_is_named_at_its_line() {
    let folder = folder();
    ok(&asperity(&folder, "example measured --out m"));
    let check = |steps: &str, flat: &str| {
        let case = format!("{BODIES}{steps}\n{flat}");
        fs::write(folder.path().join("m/case.toml"), case).unwrap();
        asperity(&folder, "check m/case.toml")
    };
    let fill = "fill = \"nearest\"\n";
    for (steps, parts) in [
        (
            format!("{fill}s_filter = \"1.5 um\""),
            "'s_filter' is 1.5 µm, expected a wavelength of at least two pitches … m/case.toml:10:12",
        ),
        (format!("{fill}taper = \"65 um\""), "'taper' is 65 µm, expected a length above 0, at most half"),
        ("despike = 1".to_owned(), "removed as spikes … m/case.toml:8:8"),
        (format!("{fill}window = [0, 0, 90, 90]\nrotate = \"-10 deg\""), "`shape = [128, "),
    ] {
        assert_has(&refused(&check(&steps, FLAT)), parts);
    }
    let larger = FLAT.replace("128, 128", "200, 200").replace("\"1 um\"", "\"1 um\"\nrotate = 0.1");
    assert_has(&refused(&check(fill, &larger)), "a smaller `window` in [upper.topography]");
    let steps = format!("{fill}level = \"sphere\"\nrotate = \"90 deg\"\nl_filter = \"30 um\"");
    assert_has(&ok(&check(&steps, FLAT)), "115 filled; a sphere of radius");
}

#[test]
fn a_file_that_cannot_be_used_is_named_at_its_line() {
    let folder = folder();
    ok(&asperity(&folder, "example measured --out m"));
    ok(&asperity(&folder, "surface convert m/disc.x3p m/disc.npy --fill nearest"));
    let case = format!("{BODIES}{FLAT}");
    for (file, parts) in [
        (
            "disc.x3p\"\nchannel = \"phase\"",
            "no height channel `phase` … m/case.toml:9:11 … hint: it holds `height`; choose one with `channel`",
        ),
        ("disc.x3p\"\nwindow = [100, 0, 100, 100]", "is not a part of the 128 × 128 samples"),
        ("disc.npy\"", "(npy) has no pitch … hint: add the distance"),
        // It is no topography.
        ("case.toml\"", "error: m/case.toml: … m/case.toml:8:8"),
    ] {
        fs::write(folder.path().join("m/case.toml"), case.replace("disc.x3p\"", file)).unwrap();
        assert_refused(&folder, [("check m/case.toml", parts)]);
    }
}

/// A file below; ends in its topography.
const BODIES: &str = "lower.young = 210e9\nlower.poisson = 0.3\nupper.young = 210e9\nupper.poisson = 0.3\n\
                      \n\n[lower.topography]\nfile = \"disc.x3p\"\n";

/// A plane above it, under a load.
const FLAT: &str =
    "[upper.topography]\nform = \"flat\"\nshape = [128, 128]\npitch = \"1 um\"\n[contact]\nload = 1\n";

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// What `asperity surface info` finds.
#[track_caller]
fn info(folder: &TempDir, arguments: &str) -> Value {
    json(&asperity(folder, &format!("surface info {arguments} --json")))
}
