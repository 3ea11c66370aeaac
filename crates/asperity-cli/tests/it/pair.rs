//! Two files in one command: `contact`, `slide` and `init`.

use std::fs;

use assert_cmd::Command;
use tempfile::TempDir;

use crate::support::{asperity, assert_has, assert_refused, change, command, failed, json, ok, refused, set};
use crate::support::{stderr, summary};

/// A folder with two surfaces of different pitch and size, and one without a pitch.
fn files() -> TempDir {
    let folder = TempDir::new().unwrap();
    let at = |arguments: &str| ok(&asperity(&folder, arguments));
    let made = "surface generate self-affine --hurst 0.8 --sq 80nm";
    at(&format!("{made} --shape 48x40 --pitch 1um --seed 1 --out disc.x3p"));
    at(&format!("{made} --shape 90x70 --pitch 0.7um --seed 2 --out plate.x3p"));
    at("surface convert plate.x3p plate.npy");
    folder
}

#[test]
fn two_files_become_a_case_and_its_results() {
    let folder = files();
    let at = |arguments: &str| asperity(&folder, arguments);
    let output =
        at("contact disc.x3p plate.x3p --load 20mN --material steel,bearing-steel --hardness 4GPa,inf");
    assert!(ok(&output).contains("contact area"));
    let told = stderr(&output);
    assert_has(&told, "lower: disc.x3p … upper: plate.x3p … tilt removed … brought to 48 × 40 of 1 µm");
    let results = folder.path().join("disc-plate-contact");
    let found = summary(&results);
    assert_eq!(found["case"]["lower"]["young"], 210e9);
    assert_eq!(found["case"]["lower"]["hardness"], 4e9);
    assert_eq!(found["case"]["upper"]["young"], 207.9e9);
    assert!((found["static"]["load"].as_f64().unwrap() - 0.02).abs() < 1e-6);
    // The case beside the results is the same contact, in any folder from which it is called.
    ok(&at("run disc-plate-contact/case.toml --out again"));
    assert_eq!(summary(&folder.path().join("again"))["static"], found["static"]);
    // What is there is kept.
    let error = refused(&at("contact disc.x3p plate.x3p --load 20mN --material steel"));
    assert!(error.contains("already holds results") && !error.contains("--resume"), "{error}");
    change(&results.join("case.toml"), "20mN", "30mN");
    assert_refused(&folder, [("run disc-plate-contact/case.toml", "--overwrite")]);
    ok(&at("run disc-plate-contact/case.toml --overwrite"));
    assert!((summary(&results)["static"]["load"].as_f64().unwrap() - 0.03).abs() < 1e-6);
}

#[test]
fn a_file_passes_over_another_and_goes_round_with_periodic_surfaces() {
    let folder = files();
    let at = |arguments: &str| asperity(&folder, arguments);
    ok(&at("slide disc.x3p plate.npy --pitch 0.7um --load 10MPa --material glass --passes 2 --out over"));
    let passes = summary(&folder.path().join("over"))["passes"].as_array().unwrap().len();
    assert_eq!(passes, 2);
    ok(&at("slide disc.x3p disc.x3p --load 10MPa --material steel --periodic --out round"));
    let found = summary(&folder.path().join("round"));
    assert_eq!(found["case"]["motion"]["strategy"], "shift");
    assert_eq!(found["case"]["contact"]["boundary"], "periodic");
}

#[test]
fn mistakes_name_the_argument_and_leave_nothing() {
    let folder = files();
    let at = |arguments: &str| asperity(&folder, arguments);
    assert_refused(
        &folder,
        [
            ("contact disc.x3p plate.npy --load 1mN --material steel", "--pitch"),
            (
                "contact disc.x3p plate.npy --pitch 10nm --load 1mN --material steel",
                "less than 4 cells of `disc.x3p`",
            ),
            ("contact disc.x3p nothing.x3p --load 1mN --material steel", "nothing.x3p"),
            ("contact disc.x3p plate.x3p --load 1um --material steel", "a force such as 0.5N"),
            ("contact disc.x3p plate.x3p --load 1mN --material stele", "no material `stele`"),
            ("contact disc.x3p plate.x3p --load 1mN", "--material"),
            ("contact disc.x3p plate.x3p --load 1mN --material steel --hardness 4um", "--hardness"),
            ("slide disc.x3p plate.x3p --load 1mN --material steel --passes 0", "--passes"),
        ],
    );
    // A load that cannot be carried is found out after the case is written.
    failed(&at("contact disc.x3p plate.x3p --load 1kN --material bearing-steel --out heavy"), 1);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3);
    // Results that stay keep their case.
    ok(&at("contact disc.x3p plate.x3p --load 1mN --material bearing-steel --out kept"));
    let case = || fs::read_to_string(folder.path().join("kept/case.toml")).unwrap();
    let before = case();
    failed(&at("contact disc.x3p plate.x3p --load 1kN --material bearing-steel --out kept --overwrite"), 1);
    assert_eq!(case(), before);
}

#[test]
fn five_answers_make_a_case() {
    let folder = files();
    let init = |arguments: &str, answers: &str| {
        let mut command = Command::from_std(command(&folder, &format!("init {arguments}")));
        command.write_stdin(answers.to_owned()).output().unwrap()
    };
    let at = |arguments: &str| asperity(&folder, arguments);
    ok(&init("", "disc.x3p\nplate.x3p\nsteel\n20 mN\n3\n"));
    assert_has(&ok(&at("check case.toml")), "plate on disc … 3 passes");
    // Empty answers are those in brackets, and a wrong one is asked again.
    ok(&init("other.toml", "\n\nstele\n\n\n\n"));
    assert_has(&ok(&at("check other.toml")), "256 × 256 cells");
    ok(&init("all.toml --lower disc.x3p --upper disc.x3p --material glass --load 5MPa --passes 0", ""));
    ok(&at("check all.toml"));
    // Each comment that is a table becomes part of a valid case, and none has the marks of Markdown.
    let mut tables = std::collections::BTreeSet::new();
    for name in ["case.toml", "other.toml", "all.toml"] {
        let text = fs::read_to_string(folder.path().join(name)).unwrap();
        assert!(!text.contains('`') && !text.contains("]("), "{text}");
        for comment in text.lines().filter(|line| line.starts_with("# ") && line.contains(" = {")) {
            fs::write(folder.path().join("one.toml"), text.replacen(comment, &comment[2..], 1)).unwrap();
            ok(&at("check one.toml"));
            tables.insert(comment.split_whitespace().nth(1).unwrap().to_owned());
        }
    }
    assert_eq!(tables, set("conductance film flow friction output wear"));
    assert!(refused(&init("", "")).contains("`case.toml` exists"));
    assert!(refused(&init("new.toml --lower disc.x3p", "")).contains("give --upper"));
}

#[test]
fn materials_completions_and_the_manual_are_printed() {
    let folder = TempDir::new().unwrap();
    let at = |arguments: &str| asperity(&folder, arguments);
    let all = json(&at("materials --json"));
    let (oils, solids): (Vec<_>, Vec<_>) =
        all.as_array().unwrap().iter().partition(|one| one.get("viscosity").is_some());
    assert!(solids.len() >= 20 && solids.iter().all(|solid| solid["young"].as_f64().is_some()), "{all}");
    assert!(oils.len() >= 10 && oils.iter().all(|oil| oil["viscosity"][1].as_f64().is_some()), "{all}");
    assert_has(&ok(&at("materials")), "bearing-steel");
    assert_has(&ok(&at("materials")), "ISO VG 46");
    assert_has(&ok(&at("materials steel")), "EN 1993-1-1");
    let oil = ok(&command(&folder, "materials").arg("ISO VG 46").output().unwrap());
    assert_has(&oil, "ISO 3448");
    assert_has(&refused(&at("materials vg46")), "did you mean `ISO VG 46`?");
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        assert_has(&ok(&at(&format!("completions {shell}"))), "asperity");
    }
    let manual = ok(&at("man"));
    assert!(manual.starts_with(".ie") && manual.contains("asperity\\-slide"), "{manual}");
}

#[test]
fn many_missing_heights_are_a_warning_of_the_result() {
    let folder = TempDir::new().unwrap();
    let write = |name: &str, missing: usize| {
        let height = |n: usize| if n < missing { "-9999".to_owned() } else { format!("{}e-9", n % 7) };
        let lines = (0..8).map(|line| (0..8).map(|n| height(8 * line + n)).collect::<Vec<_>>().join(" "));
        let text = format!("ncols 8\nnrows 8\ncellsize 1e-6\n{}\n", lines.collect::<Vec<_>>().join("\n"));
        fs::write(folder.path().join(name), text).unwrap();
    };
    write("flat.asc", 0);
    for (missing, share) in [(12, None), (13, Some("20.31 %")), (63, Some("98.44 %"))] {
        write("few.asc", missing);
        let pressed = "contact few.asc flat.asc --load 1mN --material steel --out out --overwrite --quiet";
        ok(&asperity(&folder, pressed));
        let warnings = summary(&folder.path().join("out"))["warnings"].to_string();
        let told = warnings.contains("of the heights of the lower surface are missing");
        assert_eq!(told, share.is_some(), "{warnings}");
        assert!(share.is_none_or(|share| warnings.contains(share)), "{warnings}");
    }
}
