//! Results that were damaged, or changed by hand, since they were written.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use crate::support::{asperity, assert_has, assert_refused, change, files, ok, program, refused, stderr};
use crate::survival::{ball, computations, folder_with, motion};

/// Every kind of results, small, with the files of each.
fn kinds() -> Vec<(&'static str, String)> {
    let known = computations();
    let of = |name: &str| known.iter().find(|(known, _)| *known == name).unwrap().1.clone();
    let worn = ball("[friction]\ncoefficient = 0.1\n[sliding]\ndistance = \"10 mm\"\nupdates = 3\n")
        .replace("[contact]", "wear = { coefficient = 1e-13 }\n[contact]");
    let flowing = ball("[plasticity]\ndepth = \"4 um\"\nlayers = 3\nincrements = 2\n")
        .replace("[upper]", "plasticity = { yield_stress = \"0.5 GPa\" }\n[upper]")
        .replace("[32, 32]", "[8, 8]")
        .replace("\"0.1 mm\"", "\"20 um\"");
    let small = |case: String| case.replace("[32, 32]", "[12, 12]");
    vec![
        ("rest", small(ball("[subsurface]\nto = \"5 um\"\nlayers = 3\n"))),
        ("stages", small(of("loading"))),
        ("rolling", small(of("rolling"))),
        ("sweep", small(of("sweep"))),
        ("in place", small(worn)),
        (
            "passes",
            motion(2, "subsurface = { to = \"5 um\", layers = 3 }\n").replace("stride = 2", "stride = 8"),
        ),
        ("plastic", flowing),
    ]
}

/// Files that the page does without: what a run goes on from, pressures of single points, stresses of passes
/// before the last, the table that repeats the others.
fn is_spare(name: &str) -> bool {
    name.contains("state")
        || name.contains("point-")
        || name.contains("subsurface-0001")
        || name == "results.csv"
}

/// The page and the figures of damaged results are made of the rest, with a word about the file, or refused
/// with its name.
#[test]
fn whatever_is_damaged_of_results_is_named_and_nothing_panics() {
    for (kind, case) in kinds() {
        let folder = folder_with(&case);
        ok(&asperity(&folder, "run case.toml --out out --quiet"));
        let out = folder.path().join("out");
        let of_figures =
            |name: &String| name.starts_with("figures") || name == "report.html" || name == ".lock";
        let written: Vec<String> = files(&out).into_iter().filter(|name| !of_figures(name)).collect();
        assert!(written.len() >= 3, "{kind}: {written:?}");
        for name in written {
            let path = out.join(&name);
            let whole = fs::read(&path).unwrap();
            let damages: [(&str, Option<&[u8]>); 4] = [
                ("removed", None),
                ("emptied", Some(b"")),
                ("cut off", Some(&whole[..whole.len() / 2])),
                ("another's", Some(b"3\n")),
            ];
            for (how, content) in damages {
                match content {
                    None => fs::remove_file(&path).unwrap(),
                    Some(content) => fs::write(&path, content).unwrap(),
                }
                for command in ["report out", "plot out --dpi 20 --overwrite"] {
                    let output = asperity(&folder, command);
                    let (code, told) = (output.status.code(), stderr(&output));
                    let at = format!("{command} of {kind}, {name} {how}: {code:?}, {told}");
                    assert!(matches!(code, Some(0 | 2)) && !told.contains("panicked"), "{at}");
                    let is_named =
                        told.contains(&name) || name == "case.json" && told.contains("no case.json");
                    // Without a summary a run is taken to be under way.
                    let may_be_silent = is_spare(&name) || name == "summary.json";
                    let page_is_whole = command.starts_with("plot") && output.status.success();
                    assert!(is_named || may_be_silent || page_is_whole, "{at}");
                }
            }
            fs::write(&path, whole).unwrap();
        }
        let output = asperity(&folder, "report out");
        assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""), "{kind}");
    }
}

/// A row that somebody has changed is no row of this run: nothing goes on from it.
#[test]
fn rows_that_were_changed_by_hand_are_refused() {
    let folder = folder_with(&motion(2, ""));
    let path = |name: &str| folder.path().join(name);
    ok(&asperity(&folder, "run case.toml --out out --quiet"));
    let more = || change(&path("case.toml"), "passes = 2", "passes = 3");
    let resume = || asperity(&folder, "run case.toml --out out --resume --quiet");
    let altered = |file: &str, column: &str| {
        let text = fs::read_to_string(path("out").join(file)).unwrap();
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        let at = lines[0].split(',').position(|name| name == column).unwrap();
        let mut cells: Vec<String> = lines[1].split(',').map(str::to_owned).collect();
        cells[at] = format!("{:e}", cells[at].parse::<f64>().unwrap() * 1.001);
        lines[1] = cells.join(",");
        fs::write(path("out").join(file), lines.join("\n") + "\n").unwrap();
        text
    };
    // With its summary, and without, as after an interruption.
    for with_summary in [true, false] {
        if !with_summary {
            fs::remove_file(path("out/summary.json")).unwrap();
            more();
        }
        for (file, column) in [("passes.csv", "approach"), ("steps.csv", "load")] {
            let whole = altered(file, column);
            let changed = "out/passes.csv has been changed since it was written";
            assert_has(&refused(&resume()), &format!("{changed} … hint: --overwrite computes all"));
            fs::write(path("out").join(file), whole).unwrap();
        }
    }
    ok(&resume());
}

/// As of a motion, for what is kept point by point.
#[test]
fn points_that_were_changed_by_hand_are_refused() {
    let sweep = computations().into_iter().find(|(name, _)| *name == "sweep").unwrap().1;
    let folder = folder_with(&sweep.replace("[32, 32]", "[12, 12]"));
    ok(&asperity(&folder, "run case.toml --out out --quiet"));
    let table = folder.path().join("out/sweep.csv");
    let text = fs::read_to_string(&table).unwrap();
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    lines[2] = format!("{},0.125", lines[2].rsplit_once(',').unwrap().0);
    fs::write(&table, lines.join("\n") + "\n").unwrap();
    let changed = "out/sweep.csv has been changed since it was written";
    assert_refused(&folder, [("run case.toml --out out --resume --quiet", changed)]);
    fs::write(&table, text).unwrap();
    ok(&asperity(&folder, "run case.toml --out out --resume --quiet"));
    assert!(!folder.path().join("out/fields/state-0002.h5").exists());
}

/// A pipe has no end, and a device none either: neither is read, wherever it stands in a results directory or
/// in a study.
#[test]
fn what_is_no_file_is_not_read_wherever_it_lies() {
    let folder = folder_with(&motion(1, ""));
    let path = |name: &str| folder.path().join(name);
    ok(&asperity(&folder, "run case.toml --out out --quiet"));
    let study = "base = \"case.toml\"\n[axes]\n\"contact.load\" = [\"10 mN\", \"20 mN\"]\n";
    fs::write(path("load.toml"), study).unwrap();
    ok(&asperity(&folder, "study load.toml --quiet"));
    let of_page = "case.json summary.json passes.csv steps.csv fields/initial.h5 fields/pass-0001.h5";
    for (arguments, directory, files) in [
        ("report out", "out", of_page),
        ("run case.toml --out out --resume", "out", ".lock case.json passes.csv"),
        ("study load.toml", "load", "study.json plan.csv"),
    ] {
        for file in files.split_whitespace().map(|name| path(directory).join(name)) {
            let whole = fs::read(&file).unwrap();
            for what in ["a pipe (FIFO)", "a device"] {
                fs::remove_file(&file).unwrap();
                put(what, &file);
                let told = stderr(&bounded(folder.path(), arguments));
                let name = file.file_name().unwrap().to_str().unwrap();
                assert!(told.contains(name) && told.contains(what), "{arguments}, {name}: {told}");
            }
            fs::remove_file(&file).unwrap();
            fs::write(&file, whole).unwrap();
        }
    }
}

/// Puts a pipe, or a link to a device without end, at `path`.
fn put(what: &str, path: &Path) {
    if what == "a device" {
        std::os::unix::fs::symlink("/dev/zero", path).unwrap();
    } else {
        assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
    }
}

/// Runs the command with 2 GB of memory, so that what reads without end comes to one.
fn bounded(folder: &Path, arguments: &str) -> Output {
    let program = program();
    let script = format!("ulimit -v 2000000; exec timeout 120 '{program}' {arguments}");
    Command::new("bash").args(["-c", &script]).current_dir(folder).output().unwrap()
}
