//! Directories that are there already, pages that are made again, disks that are full.

use std::fs;
use std::time::{Duration, Instant};

use crate::support::{BALL, PUSH, folder_with, moving, pushed, run, set};
use crate::support::{asperity, assert_has, assert_refused, failed, files, limited, ok};
use crate::support::{send, spawn, wait_for};

#[test]
fn results_are_replaced_only_on_request_and_strangers_never() {
    let folder = folder_with("case.toml", &moving(2, 8));
    ok(&run(&folder, "case.toml --out out"));
    let told =
        "error: out already holds results … hint: --overwrite replaces them, --resume goes on from them";
    assert_refused(&folder, [("run case.toml --out out", told)]);

    fs::write(folder.path().join("out/notes.txt"), "mine").unwrap();
    fs::write(folder.path().join("case.toml"), BALL).unwrap();
    ok(&run(&folder, "case.toml --out out --overwrite"));
    let left = files(&folder.path().join("out"));
    assert!(left.contains("notes.txt") && left.contains("fields.h5"), "{left:?}");
    assert!(!left.contains("passes.csv") && !left.contains("fields/pass-0001.h5"), "{left:?}");
}

#[test]
fn a_directory_of_something_else_is_left_alone() {
    let folder = folder_with("case.toml", &moving(1, 8));
    for (place, mine) in [("photos", "passes.csv"), ("harvest", "fields/wheat.txt")] {
        let path = folder.path().join(place).join(mine);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, "mine").unwrap();
        let told = "is not empty, and holds no results of asperity … hint: --out names another directory";
        for flag in ["", " --overwrite", " --resume"] {
            let command = format!("run case.toml --out {place}{flag}");
            assert_refused(&folder, [(&command, &format!("{place} {told}"))]);
            // Not even a lock is there.
            assert_eq!(files(&folder.path().join(place)), set(mine));
        }
        assert_eq!(fs::read(path).unwrap(), b"mine");
    }
    fs::create_dir(folder.path().join("empty")).unwrap();
    ok(&run(&folder, "case.toml --out empty"));
}

#[test]
fn results_do_not_lie_within_others_and_leave_no_empty_folder() {
    let folder = folder_with("ball.toml", &pushed(PUSH));
    ok(&run(&folder, "ball.toml --out out"));
    let out = folder.path().join("out");
    assert!(!out.join("fields").exists());
    let before = files(&out);
    for within in ["out/second", "out/fields/deep/er"] {
        let told = format!("{within} lies within the results in  … hint: --out names another directory");
        assert_refused(&folder, [(&format!("run ball.toml --out {within}"), &told)]);
    }
    assert_eq!(files(&out), before);
    assert!(!out.join("second").exists() && !out.join("fields").exists());
}

#[test]
fn a_place_where_nothing_can_be_written_is_named() {
    let folder = folder_with("case.toml", &moving(1, 8));
    fs::write(folder.path().join("file"), "mine").unwrap();
    assert_refused(
        &folder,
        [
            ("run case.toml --out file", "error: file: not a directory"),
            ("run case.toml --out file/inside", "error: file/inside: Not a directory"),
        ],
    );
    assert_eq!(fs::read(folder.path().join("file")).unwrap(), b"mine");
    if cfg!(target_os = "linux") {
        // Nobody, root neither, makes a directory there.
        let told = "error: /proc/asperity: No such file or directory";
        assert_refused(&folder, [("run case.toml --out /proc/asperity", told)]);
    }
}

#[test]
#[cfg(unix)]
fn a_page_is_made_again_from_the_results_alone_and_replaced_whole_or_not_at_all() {
    let folder = folder_with("case.toml", &moving(1, 8));
    ok(&run(&folder, "case.toml --out out"));
    let page = |name: &str| fs::read(folder.path().join(name)).unwrap();
    let written = page("out/report.html");
    fs::remove_file(folder.path().join("case.toml")).unwrap();
    assert_eq!(ok(&asperity(&folder, "report out --out page.html")), "page.html\n");
    assert!(page("page.html") == written, "it shows something else than the results");

    let error = failed(&limited(&folder, "-f 16", "report out"), 1);
    assert_has(&error, "out/report.html: File too large");
    assert!(page("out/report.html") == written, "the page that was there is gone");
    assert_refused(
        &folder,
        [
            ("report nowhere", "no case.json"),
            ("report out --out no/such.html", "its directory does not exist"),
        ],
    );
}

#[test]
#[cfg(unix)]
fn the_page_of_an_interrupted_run_shows_what_is_done() {
    let folder = folder_with("case.toml", &moving(100_000, 4));
    let out = folder.path().join("out");
    let page = out.join("report.html");
    let mut child = spawn(&folder, "run case.toml --out out");
    wait_for(&mut child, &out.join("passes.csv"));
    send("INT", &child);
    assert_eq!(child.wait_with_output().unwrap().status.code(), Some(130));
    let text = fs::read_to_string(&page).unwrap();
    assert_has(&text, "of 100000 passes are there … --resume");

    // What is computed anew has no page of what was there before.
    let mut child = spawn(&folder, "run case.toml --out out --overwrite");
    let began = Instant::now();
    while page.exists() {
        assert!(began.elapsed() < Duration::from_secs(120) && child.try_wait().unwrap().is_none());
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_an_error_that_leaves_no_half_written_file() {
    let folder = folder_with("case.toml", &moving(1, 8));
    let out = folder.path().join("out");
    // The first file that is larger than so many KiB is not there.
    let limited =
        |limit: usize, arguments: &str| failed(&limited(&folder, &format!("-f {limit}"), arguments), 1);
    let error = limited(8, "run case.toml --out out");
    assert_eq!(error, "error: out/fields/initial.h5: File too large (os error 27)\n");
    assert_eq!(files(&out), set(".lock case.json"));

    let error = limited(48, "run case.toml --out out --overwrite");
    assert_eq!(error, "error: out/fields/pass-0001.h5: File too large (os error 27)\n");
    assert_eq!(files(&out), set(".lock case.json fields/initial.h5"));

    // With room again, the run goes on.
    ok(&run(&folder, "case.toml --out out --resume"));
    let map = fs::read(out.join("figures/topographies.png")).unwrap();
    let before = files(&out);
    let error = limited(16, "plot out --overwrite");
    assert_eq!(error, "error: cannot draw `out/figures/topographies.png`: File too large (os error 27)\n");
    assert!(fs::read(out.join("figures/topographies.png")).unwrap() == map, "the older figure is whole");
    assert_eq!(files(&out), before);
}
