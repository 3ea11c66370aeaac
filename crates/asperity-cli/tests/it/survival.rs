//! Results that survive: directories that killed and refused runs leave, a second run, damage, full disks,
//! closed streams, and kills at any moment.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;
use tempfile::TempDir;

use crate::support::{asperity, assert_has, assert_refused, change, failed, files, limited, ok, program};
use crate::support::{refused, send, spawn, stderr, wait_for};

// ---- directories -----------------------------------------------------------------------------------------

#[test]
fn what_a_run_leaves_that_was_killed_before_its_case_is_as_good_as_nothing() {
    for flag in ["", " --overwrite", " --resume"] {
        let folder = folder_with(&motion(1, ""));
        let out = folder.path().join("out");
        fs::create_dir_all(out.join("fields")).unwrap();
        for left in [".lock", ".asperity-Zx81Qa", "fields/.asperity-81QaZx"] {
            fs::write(out.join(left), "").unwrap();
        }
        ok(&asperity(&folder, &format!("run case.toml --out out{flag}")));
        assert!(temporary(&out).is_empty(), "{flag}: {:?}", temporary(&out));
        assert!(out.join("summary.json").exists());
    }
}

#[test]
fn temporary_files_are_swept_from_every_folder_that_is_written_to() {
    let folder = folder_with(&motion(1, ""));
    let out = folder.path().join("out");
    let half = |path: &str| {
        let path = folder.path().join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, "half").unwrap();
    };
    ok(&asperity(&folder, "run case.toml --out out"));
    half("out/figures/.asperity-aaaaaa");
    ok(&asperity(&folder, "plot out --overwrite"));
    assert!(temporary(&out).is_empty(), "{:?}", temporary(&out));
    for path in [".asperity-a", "fields/.asperity-b", "figures/.asperity-c"] {
        half(&format!("out/{path}"));
    }
    ok(&asperity(&folder, "run case.toml --out out --resume"));
    assert!(temporary(&out).is_empty(), "{:?}", temporary(&out));

    half("made/.asperity-a");
    ok(&asperity(&folder, &format!("{SURFACE} --out made/a.npy")));
    assert!(temporary(&folder.path().join("made")).is_empty());
    half("drawn/.asperity-a");
    ok(&asperity(&folder, "surface plot made/a.npy --pitch 1um --out drawn --overwrite"));
    assert!(temporary(&folder.path().join("drawn")).is_empty());
    // The file of a process that lives is its own.
    half("made/.asperity-a");
    let held = fs::File::options().write(true).open(folder.path().join("made/.asperity-a")).unwrap();
    held.lock().unwrap();
    ok(&asperity(&folder, &format!("{SURFACE} --out made/b.npy")));
    assert_eq!(temporary(&folder.path().join("made")).len(), 1);
}

#[test]
fn a_second_run_in_one_directory_is_refused_as_long_as_the_first_lives() {
    let folder = folder_with(&motion(100_000, ""));
    let out = folder.path().join("out");
    let mut first = spawn(&folder, "run case.toml --out out");
    wait_for(&mut first, &out.join("passes.csv"));
    for flag in ["", " --overwrite", " --resume"] {
        let told = if flag.is_empty() { "already holds results" } else { "out is in use: another run" };
        assert_refused(&folder, [(&format!("run case.toml --out out{flag}"), told)]);
    }
    // Who only reads is welcome.
    ok(&asperity(&folder, "plot out --overwrite"));
    assert!(first.try_wait().unwrap().is_none(), "the first goes on");
    first.kill().unwrap();
    first.wait().unwrap();
    change(&folder.path().join("case.toml"), "passes = 100000", "passes = 1");
    ok(&asperity(&folder, "run case.toml --out out --resume"));
}

#[test]
fn nothing_is_cleared_for_a_run_that_is_refused() {
    let folder = folder_with(&motion(1, ""));
    let out = folder.path().join("out");
    ok(&asperity(&folder, "run case.toml --out out"));
    let before = contents(&out);
    let ball = ball("").replace("load = \"20 mN\"", "approach = \"1 mm\"\nboundary = \"periodic\"");
    let surface = motion(1, "").replacen("generate", "file = \"nowhere.npy\", generate", 1);
    for (case, code) in [
        (motion(1, "").replace("20 mN", "20 kN"), 1),
        (motion(1, "").replace("passes = 1", "passes = 0"), 2),
        (motion(1, "subsurface = { to = \"5 um\", step = 99 }\n"), 2),
        (ball, 1),
        (surface, 2),
    ] {
        fs::write(folder.path().join("case.toml"), &case).unwrap();
        let output = asperity(&folder, "run case.toml --out out --overwrite");
        assert_eq!(output.status.code(), Some(code), "{case}{}", stderr(&output));
        assert!(contents(&out) == before, "{case}");
    }
}

#[test]
fn a_run_is_resumed_only_from_its_own_whole_results() {
    let folder = folder_with(&motion(2, ""));
    let path = |name: &str| folder.path().join(name);
    let surface = |seed: usize| {
        ok(&asperity(&folder, &format!("{SURFACE} --seed {seed} --out a.npy --overwrite")));
    };
    surface(1);
    change(&folder.path().join("case.toml"), GENERATED, "file = \"a.npy\", pitch = \"1 um\"");
    ok(&asperity(&folder, "run case.toml --out out"));
    change(&folder.path().join("case.toml"), "20 mN", "21 mN");
    ok(&asperity(&folder, "run case.toml --out other"));
    change(&folder.path().join("case.toml"), "21 mN", "20 mN");
    let whole = contents(&path("out"));
    let restore = || {
        for (name, bytes) in &whole {
            fs::write(path("out").join(name), bytes).unwrap();
        }
    };
    let resume = || asperity(&folder, "run case.toml --out out --resume");
    let refused_for = |reason: &str| {
        let before = contents(&path("out"));
        assert_has(&refused(&resume()), &format!("{reason} … hint: --overwrite computes all"));
        assert!(contents(&path("out")) == before, "{reason}");
        restore();
    };

    surface(3);
    refused_for("error: a.npy has changed since the results in out were begun");
    surface(1);
    fs::copy(path("other/fields/pass-0002.h5"), path("out/fields/pass-0002.h5")).unwrap();
    refused_for("pass-0002.h5 is of another run");
    fs::copy(path("out/fields/pass-0001.h5"), path("out/fields/pass-0002.h5")).unwrap();
    refused_for("pass-0002.h5 is of another pass");
    for name in ["fields/initial.h5", "fields/pass-0001.h5", "fields/pass-0002.h5", "steps.csv"] {
        fs::remove_file(path("out").join(name)).unwrap();
        refused_for(&format!("error: out/{name} is missing"));
    }
    for name in ["fields/pass-0001.h5", "fields/pass-0002.h5"] {
        let bytes = &whole[name];
        fs::write(path("out").join(name), &bytes[..bytes.len() / 2]).unwrap();
        assert_has(&refused(&resume()), &format!("out/{name}: "));
        restore();
    }
    let rows = String::from_utf8(whole["steps.csv"].clone()).unwrap();
    let shorter: Vec<_> = rows.lines().take(9).collect();
    fs::write(path("out/steps.csv"), shorter.join("\n") + "\n").unwrap();
    refused_for("steps.csv does not have every position of the finished passes");
    let rows = String::from_utf8(whole["passes.csv"].clone()).unwrap();
    let without_first: Vec<_> =
        rows.lines().enumerate().filter(|(n, _)| *n != 1).map(|(_, row)| row).collect();
    fs::write(path("out/passes.csv"), without_first.join("\n") + "\n").unwrap();
    refused_for("passes.csv does not number its passes");
    change(&folder.path().join("case.toml"), "20 mN", "21 mN");
    refused_for("out holds the results of another case: 'contact.load' was 0.02, now it is 0.021");
    change(&folder.path().join("case.toml"), "21 mN", "20 mN");

    // Neither title nor number of passes is another case.
    change(&folder.path().join("case.toml"), "passes = 2", "passes = 3");
    let case = fs::read_to_string(path("case.toml")).unwrap();
    fs::write(path("case.toml"), format!("title = \"named\"\n{case}")).unwrap();
    ok(&resume());
    let now = contents(&path("out"));
    assert!(now["fields/pass-0002.h5"] == whole["fields/pass-0002.h5"]);
    assert!(now.contains_key("fields/pass-0003.h5"));
    let case: Value = serde_json::from_slice(&now["case.json"]).unwrap();
    assert_eq!(case["title"], "named");
    let sum = Command::new("sha256sum").arg(path("a.npy")).output().unwrap();
    let digest = case["lower"]["topography"]["sha256"].as_str().unwrap();
    assert!(String::from_utf8(sum.stdout).unwrap().starts_with(digest));
}

// ---- streams, threads, limits, signals -------------------------------------------------------------------

#[test]
#[cfg(target_os = "linux")]
fn what_cannot_be_written_to_stdout_is_an_error_and_a_closed_pipe_is_none() {
    let folder = folder_with(&ball(""));
    fs::write(folder.path().join("moving.toml"), motion(1, "")).unwrap();
    ok(&asperity(&folder, &format!("{SURFACE} --out a.npy")));
    ok(&asperity(&folder, "run case.toml --out there"));
    let shell = |script: &str| {
        let script = script.replace("asperity", &program());
        Command::new("bash").args(["-c", &script]).current_dir(&folder).output().unwrap()
    };
    let commands = [
        "--help",
        "--version",
        "run --help",
        "check case.toml",
        "run case.toml --out full",
        "run moving.toml --out moving",
        "plot there --overwrite",
        "example",
        "example hertz",
        "surface info a.npy --pitch 1um",
        "surface info a.npy --pitch 1um --json",
        "verify",
    ];
    for command in commands {
        let said = failed(&shell(&format!("asperity {command} > /dev/full")), 1);
        assert_has(&said, "error: standard output: No space left on device");
    }
    // The results are whole all the same.
    for directory in ["full", "moving"] {
        let out = folder.path().join(directory);
        assert!(out.join("summary.json").exists() && out.join("figures/contact.png").exists(), "{directory}");
    }
    fs::remove_dir_all(folder.path().join("hertz")).unwrap();
    for command in commands {
        let command = command.replace("--out", "--overwrite --out");
        let output = shell(&format!("asperity {command} | true; exit ${{PIPESTATUS[0]}}"));
        assert_eq!(output.status.code(), Some(0), "{command}: {}", stderr(&output));
        assert!(!stderr(&output).contains("error"), "{command}: {}", stderr(&output));
    }
}

#[test]
fn threads_are_as_many_as_there_is_use_for_and_room() {
    let folder = folder_with(&ball(""));
    for count in ["0", "1025"] {
        let told = "expected a whole number from 1 to 1024";
        assert_refused(&folder, [(&format!("run case.toml --out out --threads {count}"), told)]);
    }
    let output = asperity(&folder, "run case.toml --out out --threads 300");
    ok(&output);
    assert!(stderr(&output).starts_with("note: --threads 300 is more than the "), "{}", stderr(&output));
    if cfg!(target_os = "linux") {
        let limited = |threads: usize| {
            // Stacks this large run out before anything else does.
            let limit = "-v 500000; export RUST_MIN_STACK=67108864";
            limited(&folder, limit, &format!("run case.toml --out out --overwrite --threads {threads}"))
        };
        assert_has(&failed(&limited(1000), 1), "error: threads cannot be made: ");
        ok(&limited(1));
    }
}

#[test]
fn ctrl_c_counts_while_figures_are_drawn() {
    let folder = folder_with(
        &motion(2, "").replace("pressure_every = 4", "pressure_every = 1").replace("[16, 16]", "[64, 16]"),
    );
    let out = folder.path().join("out");
    let mut child = spawn(&folder, "run case.toml --out out");
    wait_for(&mut child, &out.join("figures/topographies.png"));
    send("INT", &child);
    let said = failed(&child.wait_with_output().unwrap(), 130);
    let told = "error: interrupted before all figures were drawn\n\
                hint: the results are whole; `asperity plot out --overwrite` draws";
    assert_has(&said, told);
    assert!(out.join("summary.json").exists() && !out.join("figures/approach.png").exists());
    ok(&asperity(&folder, "plot out --overwrite"));
    assert!(out.join("figures/approach.png").exists());
}

#[test]
fn what_is_no_file_is_named_as_what_it_is_and_waited_for_by_nobody() {
    let folder = folder_with(&motion(1, ""));
    let path = |name: &str| folder.path().join(name);
    assert!(Command::new("mkfifo").args([path("pipe"), path("a.npy")]).status().unwrap().success());
    fs::create_dir(path("folder.toml")).unwrap();
    fs::write(path("large.toml"), "# much ado\n".repeat(500_000)).unwrap();
    for command in ["run", "check"] {
        for (name, told) in [
            ("pipe", "error: pipe: is a pipe (FIFO), expected a case file"),
            ("/dev/zero", "error: /dev/zero: is a device, expected a case file"),
            ("folder.toml", "error: `folder.toml` is a folder, expected a case file"),
            ("large.toml", "error: large.toml: holds 5500000 bytes, a case file has 4194304 at most"),
        ] {
            let error = refused(&asperity(&folder, &format!("{command} {name}")));
            assert!(error.starts_with(told), "{error}");
        }
    }
    change(&folder.path().join("case.toml"), GENERATED, "file = \"a.npy\", pitch = \"1 um\"");
    let error = refused(&asperity(&folder, "check case.toml"));
    assert!(error.starts_with("error: a.npy: is a pipe (FIFO), expected a topography file"), "{error}");
    let error = refused(&asperity(&folder, "surface info a.npy"));
    assert!(error.starts_with("error: a.npy: is a pipe (FIFO), expected a topography file"), "{error}");
}

#[test]
fn an_error_is_some_lines_whatever_the_input() {
    let folder = folder_with("");
    let many = "k".repeat(1_000_000);
    let cases = [
        format!("{many} = 1\n"),
        format!("[lower]\n{many} = 1\n"),
        format!("[lower]\nyoung = \"{many}\"\n"),
        format!("[lower]\nyoung = {many}\n"),
        format!("title = \"{many}\"\n"),
        format!("{}\n", "[".repeat(1_000_000)),
        format!("a = {}\n", "[".repeat(1_000_000)),
        format!("a{}= 1\n", ".a".repeat(500_000)),
        format!("[lower]\nyoung = [{}]\n", "1,\n".repeat(300_000)),
        format!("[lower]\nyoung = '''{}'''\n", "x\n".repeat(300_000)),
        motion(1, "").replacen("generate", &format!("file = \"{many}\", generate"), 1),
        motion(1, "")
            .replacen(&motion(1, "")[..1], &format!("title = \"{many}\"\n{}", &motion(1, "")[..1]), 1)
            .replace("20 mN", "20 kN"),
    ];
    for case in cases {
        fs::write(folder.path().join("case.toml"), &case).unwrap();
        let began = Instant::now();
        let output = asperity(&folder, "check case.toml");
        let (head, text) = (&case[..60.min(case.len())], stderr(&output));
        assert!(matches!(output.status.code(), Some(1 | 2)), "{head}: {:?} {:.2000}", output.status, text);
        assert!(text.lines().count() < 20 && text.len() < 4000, "{head}: {} bytes: {text:.2000}", text.len());
        assert!(began.elapsed() < Duration::from_secs(60), "{head}: {:?}", began.elapsed());
    }
    let long = "p".repeat(4000);
    for arguments in [
        format!("check {long}"),
        format!("run --threads {long}"),
        format!("plot {long}"),
        format!("surface info {long}"),
        long.clone(),
    ] {
        let text = refused(&asperity(&folder, &arguments));
        assert!(text.lines().count() < 20 && text.len() < 4000, "{} bytes: {text}", text.len());
    }
}

// ---- kills -----------------------------------------------------------------------------------------------

/// Every kind of computation, small.
pub(crate) fn computations() -> [(&'static str, String); 10] {
    let runs_in = "conductivity = 46, heat_capacity = 460, density = 7850, wear = { coefficient = 1e-17, under_film = 1e-18 }, \
                   film = { law = \"arrhenius\", max_thickness = 1e-8, rate = 1e-5, at_temperature = 400, at_stress = 3e9, \
                   activation_energy = 1e-19, activation_volume = 4e-30, removal = 1e-9 }, topography";
    let shift = "strategy = \"shift\", speed_lower = 0.0, speed_upper = 1.0, control = \"pass-load\", ";
    [
        (
            "overlap",
            motion(3, "subsurface = { to = \"5 um\", layers = 5 }\n")
                .replace("pressure_every = 4", "pressure_every = 4, paraview = true"),
        ),
        ("shift", motion(2, "").replace("motion = { ", &format!("motion = {{ {shift}"))),
        (
            "step",
            motion(2, "")
                .replace("motion = { ", "motion = { plastic_update = \"step\", control = \"step-load\", "),
        ),
        ("sliding", motion(2, "friction = { coefficient = 0.2 }\n")),
        (
            "running-in",
            motion(60, "friction = { coefficient = 0.1 }\nacceleration = {}\ntemperature = { bulk = 400, every = 2 }\n")
                .replace("topography", runs_in)
                .replace("stride = 2", "stride = 4, speed = 1.0"),
        ),
        ("ball", ball("[subsurface]\nto = \"5 um\"\nlayers = 5\n[output]\nparaview = true\n")),
        ("rolling", ball("[friction]\ncoefficient = 0.3\ncreepage = [2e-3, 0.0]\n")),
        (
            "sweep",
            ball("[output]\npressure_every = 2\n")
                .replace("load = ", "loads = [\"5 mN\", \"40 mN\", \"9 mN\", ")
                .replace("\"20 mN\"\n", "\"20 mN\"]\n"),
        ),
        (
            "sticking",
            ball(
                "[adhesion]\nwork = \"1 J/m2\"\nrange = \"8 nm\"\n[[history]]\nload = \"-0.2 mN\"\nincrements = 4\n\
                 [[history]]\napproach = \"-40 nm\"\nincrements = 6\n[[history]]\napproach = \"20 nm\"\nincrements = 4\n",
            ),
        ),
        (
            "loading",
            ball(
                "[friction]\ncoefficient = 0.3\nincrements = 2\n[[history]]\nforce = \"3 mN\"\nincrements = 3\n\
                 [[history]]\nforce = \"-2 mN\"\nincrements = 4\n",
            ),
        ),
    ]
}

/// How often each computation is killed: `ASPERITY_KILLS`, by default what a routine test bears.
fn kills() -> usize {
    std::env::var("ASPERITY_KILLS").ok().map_or(2, |kills| kills.parse().unwrap())
}

#[test]
#[ignore = "a minute of an unoptimised build; ASPERITY_BINARY names an optimised one"]
fn a_run_that_is_killed_at_any_moment_is_resumed_to_the_same_bits() {
    let mut random = 1u64;
    let mut number = move || {
        // Knuth's, MMIX.
        random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (random >> 33) as f64 / (1u64 << 31) as f64
    };
    for (name, case) in computations() {
        let folder = folder_with(&case);
        let began = Instant::now();
        ok(&asperity(&folder, "run case.toml --out whole --quiet"));
        let time = began.elapsed();
        let whole = bits(&folder.path().join("whole"));
        for kill in 0..kills() {
            let out = folder.path().join("out");
            let mut killed = 0;
            for flag in ["", " --resume", " --resume"] {
                let mut child = spawn(&folder, &format!("run case.toml --out out --quiet{flag}"));
                std::thread::sleep(time.mul_f64(number()));
                killed += usize::from(child.try_wait().unwrap().is_none());
                child.kill().unwrap();
                child.wait().unwrap();
            }
            ok(&asperity(&folder, "run case.toml --out out --quiet --resume"));
            assert_same(&bits(&out), &whole, &format!("{name}, {killed} kills of round {kill}"));
            fs::remove_dir_all(out).unwrap();
        }
    }
}

/// `strace` ends a process at a call: a run into a new directory, and one that replaces the results of
/// another case. Every call that changes a file with `ASPERITY_KILLS`, some of them otherwise.
#[test]
#[cfg(target_os = "linux")]
#[ignore = "needs strace"]
fn a_run_that_is_killed_at_a_call_that_changes_a_file_is_resumed_to_the_same_bits() {
    let stride = if kills() > 2 { 1 } else { 61 };
    let other = folder_with(&motion(1, ""));
    ok(&asperity(&other, "run case.toml --out out --quiet"));
    let other = contents(&other.path().join("out"));
    let mut killed = 0;
    for (name, case) in computations() {
        let folder = folder_with(&case);
        let out = folder.path().join("out");
        ok(&asperity(&folder, "run case.toml --out whole --quiet --threads 1"));
        let whole = bits(&folder.path().join("whole"));
        for flag in ["", " --overwrite"] {
            let begin = || {
                let _ = fs::remove_dir_all(&out);
                if !flag.is_empty() {
                    write_all(&out, &other);
                }
            };
            let arguments = format!("run case.toml --out out --quiet --threads 1{flag}");
            begin();
            let calls = calls(&folder, &arguments);
            assert!(calls.len() > 40, "{name}: {calls:?}");
            assert_same(&bits(&out), &whole, name);
            // Elsewhere for each computation.
            for (call, count) in calls.iter().skip(killed % 7).step_by(stride) {
                begin();
                let inject = format!("inject={call}:signal=KILL:when={count}");
                assert!(!traced(&folder, &["-e", &inject], &arguments), "{name}: {inject}");
                killed += 1;
                let output = asperity(&folder, "run case.toml --out out --quiet --resume --threads 1");
                if !flag.is_empty() && output.status.code() == Some(2) {
                    // Nothing is lost yet of the other case's results.
                    assert_has(&stderr(&output), "holds the results of another case");
                    ok(&asperity(&folder, "run case.toml --out out --quiet --overwrite --threads 1"));
                } else {
                    ok(&output);
                }
                assert_same(&bits(&out), &whole, &format!("{name}{flag}, {call} {count}"));
            }
        }
    }
    assert!(killed >= 14, "killed at {killed} calls alone");
}

/// The calls of a run that change files: the name of each, and the how many-th of its name it is.
#[cfg(target_os = "linux")]
fn calls(folder: &TempDir, arguments: &str) -> Vec<(String, usize)> {
    let log = folder.path().join("calls");
    assert!(traced(folder, &["-o", log.to_str().unwrap()], arguments));
    let mut counts = BTreeMap::new();
    let text = fs::read_to_string(log).unwrap();
    let name = |line: &str| Some(line.split_once(' ')?.1.trim_start().split_once('(')?.0.to_owned());
    text.lines()
        .filter_map(name)
        .map(|name| {
            let count = counts.entry(name.clone()).or_insert(0);
            *count += 1;
            (name, *count)
        })
        .collect()
}

/// Whether the run, under `strace` with these options, ended well.
#[cfg(target_os = "linux")]
fn traced(folder: &TempDir, options: &[&str], arguments: &str) -> bool {
    const CALLS: &str = "trace=?rename,?renameat,?renameat2,fsync,fdatasync,write,?unlink,unlinkat,?mkdir,mkdirat,flock,\
                         ftruncate,?link,linkat,?rmdir";
    Command::new("strace")
        .args(["-f", "-qq", "-e", CALLS])
        .args(options)
        .arg(program())
        .args(arguments.split_whitespace())
        .current_dir(folder)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .unwrap()
        .success()
}

#[test]
#[ignore = "a minute of an unoptimised build; ASPERITY_BINARY names an optimised one"]
fn a_run_that_met_a_full_disk_is_resumed_to_the_same_bits() {
    for (name, case) in computations() {
        let folder = folder_with(&case);
        ok(&asperity(&folder, "run case.toml --out whole"));
        let whole = bits(&folder.path().join("whole"));
        let largest =
            whole.iter().filter(|(name, _)| !name.starts_with("figures")).map(|(_, b)| b.len()).max();
        let largest = largest.unwrap().div_ceil(1024);
        for limit in [1, 2, largest / 2, largest - 1] {
            let output = limited(&folder, &format!("-f {limit}"), "run case.toml --out out --quiet");
            assert_has(&failed(&output, 1), "File too large");
            assert!(temporary(&folder.path().join("out")).is_empty());
            ok(&asperity(&folder, "run case.toml --out out --resume"));
            assert_same(&bits(&folder.path().join("out")), &whole, &format!("{name}, {limit} KiB"));
            fs::remove_dir_all(folder.path().join("out")).unwrap();
        }
    }
}

/// The files of a results directory without the times in them.
fn bits(directory: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = contents(directory);
    // It has the times, too.
    assert!(files.remove("report.html").is_some(), "no page");
    if let Some(table) = files.get_mut("passes.csv") {
        let text = String::from_utf8(table.clone()).unwrap();
        assert!(text.lines().next().unwrap().ends_with(",wall_time_s"));
        let rows: Vec<_> = text.lines().map(|row| row.rsplit_once(',').unwrap().0).collect();
        *table = rows.join("\n").into_bytes();
    }
    let summary = files.get_mut("summary.json").expect("a summary");
    let mut value: Value = serde_json::from_slice(summary).unwrap();
    value["wall_time_s"] = Value::Null;
    for pass in value.get_mut("passes").and_then(Value::as_array_mut).into_iter().flatten() {
        pass["wall_time_s"] = Value::Null;
    }
    *summary = serde_json::to_vec(&value).unwrap();
    files
}

#[track_caller]
fn assert_same(found: &BTreeMap<String, Vec<u8>>, expected: &BTreeMap<String, Vec<u8>>, when: &str) {
    assert!(found.keys().eq(expected.keys()), "{when}: {:?}, expected {:?}", found.keys(), expected.keys());
    let differ: Vec<_> =
        found.iter().filter(|(name, bytes)| expected[*name] != **bytes).map(|(n, _)| n).collect();
    assert!(differ.is_empty(), "{when}: {differ:?} differ");
}

// ---- helpers ---------------------------------------------------------------------------------------------

/// The command for the surface that is generated below.
const SURFACE: &str = "surface generate low-pass --shape 16x16 --pitch 1um --sq 35nm --cutoff 8um";

const GENERATED: &str = "generate = \"low-pass\", shape = [16, 16], pitch = \"1 um\", sq = \"35 nm\", \
                         cutoff = \"8 um\", seed = 1";

/// Two rough steel surfaces of 16 × 16 cells that yield a little, with what follows.
pub(crate) fn motion(passes: usize, tables: &str) -> String {
    let body = |name: &str, seed: usize| {
        let topography = GENERATED.replace("seed = 1", &format!("seed = {seed}"));
        let steel = "young = \"210 GPa\", poisson = 0.3, hardness = \"4 GPa\"";
        format!("{name} = {{ {steel}, topography = {{ {topography} }} }}\n")
    };
    format!(
        "{}{}contact = {{ load = \"20 mN\" }}\nmotion = {{ passes = {passes}, stride = 2 }}\n\
         output = {{ pressure_every = 4 }}\n{tables}",
        body("lower", 1),
        body("upper", 2)
    )
}

/// A ball on a plane, with what follows [contact].
pub(crate) fn ball(tables: &str) -> String {
    let steel = "young = \"210 GPa\"\npoisson = 0.3\ntopography = {";
    format!(
        "[lower]\n{steel} form = \"flat\", shape = [32, 32], pitch = \"1 um\" }}\n\
         [upper]\n{steel} form = \"sphere\", radius = \"0.1 mm\", shape = [32, 32], pitch = \"1 um\" }}\n\
         [contact]\nload = \"20 mN\"\n{tables}"
    )
}

pub(crate) fn folder_with(case: &str) -> TempDir {
    crate::support::folder_with("case.toml", case)
}

/// Every file beneath, by its path relative to `folder`.
pub(crate) fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let read = |name: String| {
        let bytes = fs::read(folder.join(&name)).unwrap();
        (name, bytes)
    };
    files(folder).into_iter().map(read).collect()
}

/// Makes `folder` of such files.
fn write_all(folder: &Path, files: &BTreeMap<String, Vec<u8>>) {
    for (name, bytes) in files {
        fs::create_dir_all(folder.join(name).parent().unwrap()).unwrap();
        fs::write(folder.join(name), bytes).unwrap();
    }
}

fn temporary(folder: &Path) -> Vec<String> {
    files(folder).into_iter().filter(|name| name.contains(".asperity-")).collect()
}
