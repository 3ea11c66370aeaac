//! Relative positions of the bodies in a motion: between columns, on forward and return strokes, with offsets along y.

use asperity_contact::film::FILM;
use asperity_study::{Case, Existing, Results, SurfaceInput};
use asperity_surface::Topography;

const CASE: &str = r#"
[lower]
young = "210 GPa"
poisson = 0.3
hardness = "4 GPa"
wear = { coefficient = "2e-6 mm3/(N m)" }
film = { law = "arrhenius", max_thickness = "20 nm", rate = "1 mm/s", at_temperature = "100 °C", at_stress = "1 GPa", activation_energy = "0.8 eV", activation_volume = "3.8e-3 nm3", hardness = "3 GPa" }
topography = { generate = "self-affine", shape = [14, 12], pitch = "1 um", sq = "20 nm", hurst = 0.8, seed = 1 }
[upper]
young = "210 GPa"
poisson = 0.3
wear = { coefficient = "1e-6 mm3/(N m)" }
film = { law = "arrhenius", max_thickness = "20 nm", rate = "1 mm/s", at_temperature = "100 °C", at_stress = "1 GPa", activation_energy = "0.8 eV", activation_volume = "3.8e-3 nm3" }
topography = { generate = "self-affine", shape = [14, 12], pitch = "1 um", sq = "20 nm", hurst = 0.8, seed = 2 }
[contact]
load = "0.04 N"
boundary = "periodic"
[temperature]
bulk = "100 °C"
"#;

/// A resumed run restores the whole state of a motion, bit by bit.
#[test]
fn a_resumed_motion_comes_to_the_same_bits_whatever_its_kinematics() {
    let line = CASE.replace("boundary = \"periodic\"", "boundary = [\"free\", \"periodic\"]");
    let shift = "strategy = \"shift\"\nspeed_lower = 0.3\nspeed_upper = 1\n";
    for (case, motion) in [
        (CASE, format!("{shift}stride = 2\n")),
        (CASE, format!("{shift}path = \"reciprocating\"\nstride = 3\n")),
        (CASE, format!("{shift}offset_y = \"random\"\nseed = 4\ncounter = \"fresh\"\nstride = 4\n")),
        (&line, "speed = 1\nstride = 4\noffset_y = 5\n".to_owned()),
        (&line, "speed = 1\nstride = 4\ncounter = \"fresh\"\npath = \"reciprocating\"\n".to_owned()),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let run = |out: &str, passes: usize, existing: Existing| {
            let text = format!("{case}[motion]\npasses = {passes}\n{motion}[output]\nparaview = true\n");
            let case = Case::parse(&text, "case.toml".as_ref(), "".as_ref()).unwrap();
            let out = folder.path().join(out);
            asperity_study::run(&case, SurfaceInput::default(), &out, existing, &())
                .unwrap_or_else(|error| panic!("{error}: {motion}"));
            Results::open(&out).unwrap()
        };
        let whole = run("whole", 5, Existing::Keep);
        run("resumed", 2, Existing::Keep);
        let resumed = run("resumed", 5, Existing::Resume);
        let steps = |results: &Results| format!("{:?}", results.steps().unwrap());
        assert_eq!(steps(&whole), steps(&resumed), "{motion}");
        for pass in 1..=5 {
            let heights =
                |results: &Results| results.surfaces_after(pass).unwrap().map(Topography::into_heights);
            assert_eq!(heights(&whole), heights(&resumed), "{motion}");
            let [lower, upper] = whole.states_after(pass).unwrap();
            assert_eq!([&lower, &upper], resumed.states_after(pass).unwrap().each_ref(), "{motion}");
            assert!(lower[FILM].values.iter().any(|film| *film > 0.0), "{motion}");
        }
        let volume = |pass: usize| whole.states_after(pass).unwrap()[1]["wear"].values.sum();
        let fresh = motion.contains("fresh");
        // The wear of a body replaced in each pass does not accumulate.
        assert_eq!(volume(5) > 3.0 * volume(1), !fresh, "{motion}");
        let [first, last] = [1, 5].map(|pass| whole.surfaces_after(pass).unwrap()[1].heights().clone());
        let furthest = (first - last).fold(0.0f64, |most, off| most.max(off.abs()));
        assert_eq!(furthest > 40e-9, fresh, "{motion}");
    }
}
