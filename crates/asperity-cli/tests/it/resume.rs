//! Runs that go on after an interruption.

use std::fs;
use std::time::{Duration, Instant};

use asperity::study::PASS_COLUMNS;
use asperity::study::Results;

use crate::support::{BALL, assert_same_passes, folder_with, moving, run, summary, table_of};
use crate::support::{asperity, assert_has, assert_refused, change, command, files, ok, refused};
use crate::support::{send, spawn, stderr, wait_for};

#[test]
fn more_passes_are_appended_to_finished_ones() {
    let folder = folder_with("case.toml", &moving(3, 4));
    let path = |name: &str| folder.path().join(name);
    ok(&run(&folder, "case.toml --out whole"));
    change(&path("case.toml"), "passes = 3", "passes = 1");
    ok(&run(&folder, "case.toml --out parts"));
    change(&path("case.toml"), "passes = 1", "passes = 3");
    let output = run(&folder, "case.toml --out parts --resume");
    assert_has(&stderr(&output), "continues after pass 1 of 3\n");
    let table = ok(&output);
    assert_eq!(table.lines().count(), 7, "{table}");
    assert_same_passes(&path("parts"), &path("whole"));
    assert_eq!(summary(&path("parts"))["case"]["motion"]["passes"], 3);
    // Nothing is left to do, and nothing is done.
    let steps = fs::read(path("parts/steps.csv")).unwrap();
    assert_eq!(ok(&run(&folder, "case.toml --out parts --resume")), table);
    assert!(fs::read(path("parts/steps.csv")).unwrap() == steps);
    // Fewer passes than there are.
    change(&path("case.toml"), "passes = 3", "passes = 2");
    let output = run(&folder, "case.toml --out parts --resume");
    assert_eq!(ok(&output), table);
    let more = "the results hold 3 finished passes, more than `passes = 2` of the case";
    assert_has(&stderr(&output), &format!("all 3 passes are finished\n … {more}"));
    for file in ["parts/summary.json", "parts/case.json"] {
        assert_has(&fs::read_to_string(path(file)).unwrap(), "\"passes\": 3,");
    }
}

#[test]
fn the_fields_of_results_are_topographies() {
    let folder = folder_with("case.toml", &moving(1, 8));
    ok(&run(&folder, "case.toml --out moved"));
    // The body's material stays; its surface is that of the results.
    let motion = moving(1, 8);
    let upper = motion.find("upper = {").unwrap();
    let (before, after) = motion[upper..].split_once("topography = {").unwrap();
    let after = after.split_once("} }").unwrap().1;
    let source = "topography = { file = \"moved/fields/pass-0001.h5\", channel = \"upper\" } }";
    fs::write(folder.path().join("next.toml"), format!("{}{before}{source}{after}", &motion[..upper]))
        .unwrap();
    let said = ok(&asperity(&folder, "check next.toml"));
    assert_has(&said, "results `upper`, 32 × 32 samples, an underside, mounted as it is");
    let info = |channel: &str| format!("surface info moved/fields/pass-0001.h5 --channel {channel}");
    let told = ok(&asperity(&folder, &info("lower")));
    assert!(told.starts_with("format    results\nchannel   lower\n"), "{told}");
    assert_has(&told, "channels  lower, upper\n");
    let told = ok(&asperity(&folder, &info("upper")));
    assert_has(&told, "an underside: as [upper] it is mounted as it is");
    let told = "no height channel `pressure` … it holds `lower`, `upper`";
    assert_refused(&folder, [(&info("pressure"), told)]);
}

#[test]
fn a_motion_without_what_its_next_pass_begins_with_is_not_resumed() {
    let folder = folder_with("case.toml", &moving(1, 8));
    ok(&run(&folder, "case.toml --out out"));
    change(&folder.path().join("case.toml"), "20 mN", "21 mN");
    ok(&run(&folder, "case.toml --out other"));
    change(&folder.path().join("case.toml"), "21 mN", "20 mN");
    let name = "fields/state-0001.h5";
    let [path, other] = ["out", "other"].map(|results| folder.path().join(results).join(name));
    let whole = fs::read(&path).unwrap();
    // Nothing is left to do: what is not needed is not missed.
    fs::remove_file(&path).unwrap();
    ok(&run(&folder, "case.toml --out out --resume"));
    change(&folder.path().join("case.toml"), "passes = 1", "passes = 2");
    let refused_for = |defect: &str| {
        let error = refused(&run(&folder, "case.toml --out out --resume"));
        assert!(error.starts_with(&format!("error: out/{name}{defect}")), "{error}");
    };
    refused_for(" is missing\n");
    fs::write(&path, &whole[..whole.len() / 2]).unwrap();
    refused_for(": HDF5 format error: unexpected EOF: ");
    fs::copy(other, &path).unwrap();
    refused_for(" is of another run\n");
    fs::write(&path, whole).unwrap();
    ok(&run(&folder, "case.toml --out out --resume"));
}

#[test]
fn a_case_is_known_again_from_another_folder_and_by_numbers_of_any_length() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("sub")).unwrap();
    let at = |arguments: &str| asperity(&folder, arguments);
    let made = "surface generate low-pass --shape 32x32 --pitch 1um --sq 35nm --cutoff 8um";
    ok(&at(&format!("{made} --seed 1 --out sub/a.npy")));
    let case = moving(1, 8)
        .replace(
            "generate = \"low-pass\", shape = [32, 32], pitch = \"1 um\", sq = \"35 nm\", cutoff = \"8 um\", seed = 1",
            "file = \"a.npy\", pitch = \"0.32412785700896 um\"",
        )
        .replace("pitch = \"1 um\"", "pitch = \"0.32412785700896 um\"")
        .replace("cutoff = \"8 um\"", "cutoff = \"3.333333333333331 um\"")
        .replace("\"35 nm\"", "3.080618546467441e-08")
        .replace("20 mN", "2.0173912345678901 mN");
    fs::write(folder.path().join("sub/case.toml"), case).unwrap();
    ok(&at("run sub/case.toml --out out"));
    ok(&at("run sub/case.toml --out out --resume"));
    let mut inside = command(&folder, "run case.toml --out ../out --resume");
    ok(&inside.current_dir(folder.path().join("sub")).output().unwrap());
}

#[test]
#[cfg(unix)]
fn a_run_that_is_interrupted_goes_on_where_it_was() {
    stopped_and_resumed("INT", Some(130));
}

#[test]
#[cfg(unix)]
fn a_run_that_is_killed_goes_on_where_it_was() {
    stopped_and_resumed("KILL", None);
}

/// A motion without end is stopped by a signal, then resumed for two passes more.
fn stopped_and_resumed(signal: &str, code: Option<i32>) {
    let folder = folder_with("case.toml", &moving(100_000, 4));
    let out = folder.path().join("out");
    let mut child = spawn(&folder, "run case.toml --out out");
    wait_for(&mut child, &out.join("passes.csv"));
    send(signal, &child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), code, "{}", stderr(&output));
    if signal == "INT" {
        // A row for each pass that is there.
        let rows = table_of(&out.join("passes.csv"), &PASS_COLUMNS).len();
        assert_eq!(String::from_utf8_lossy(&output.stdout).lines().count(), 4 + rows);
        let told = stderr(&output);
        assert!(told.ends_with("error: interrupted\nhint: continue with `--resume`\n"), "{told}");
    }
    assert!(!out.join("summary.json").exists() && !out.join("figures").exists());

    let done = Results::open(&out).unwrap().passes().unwrap().len();
    assert!(done >= 1);
    // A moment later: the positions and fields of the next pass were there, its row was not yet.
    let rows = fs::read_to_string(out.join("steps.csv")).unwrap();
    let of_pass = |pass: usize| rows.lines().skip(1).filter(move |row| row.starts_with(&format!("{pass},")));
    let kept: Vec<&str> = rows.lines().take(1).chain((1..=done).flat_map(of_pass)).collect();
    let next: Vec<String> =
        of_pass(done).map(|row| row.replacen(&done.to_string(), &(done + 1).to_string(), 1)).collect();
    fs::write(out.join("steps.csv"), kept.join("\n") + "\n" + &next.join("\n") + "\n").unwrap();
    for name in ["pass", "state"] {
        let [from, to] = [done, done + 1].map(|pass| out.join(format!("fields/{name}-{pass:04}.h5")));
        fs::copy(from, to).unwrap();
    }
    fs::copy(out.join(format!("fields/state-{done:04}.h5")), out.join("fields/state-0000.h5")).unwrap();
    fs::write(out.join("fields/.asperity-half"), "half").unwrap();

    change(&folder.path().join("case.toml"), "passes = 100000", &format!("passes = {}", done + 2));
    ok(&run(&folder, "case.toml --out out --resume"));
    ok(&run(&folder, "case.toml --out whole"));
    assert_same_passes(&out, &folder.path().join("whole"));
    assert_eq!(files(&out), files(&folder.path().join("whole")));
}

#[test]
#[cfg(unix)]
fn a_static_contact_is_interrupted_at_once() {
    let slow = BALL.replace("[32, 32]", "[512, 512]").replace(
        "load = \"20 mN\"",
        "load = \"20 mN\"\nmethod = \"polonsky-keer\"\ntolerance = 1e-15\nboundary = \"free\"",
    );
    let folder = folder_with("ball.toml", &slow);
    let mut child = spawn(&folder, "run ball.toml --out out");
    wait_for(&mut child, &folder.path().join("out/.lock"));
    std::thread::sleep(Duration::from_millis(100));
    let began = Instant::now();
    send("INT", &child);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    assert!(began.elapsed() < Duration::from_secs(2), "{:?}", began.elapsed());
    assert_eq!(stderr(&output), "error: interrupted\n");
}
