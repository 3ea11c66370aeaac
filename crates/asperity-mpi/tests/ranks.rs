//! Contacts on ranks that `mpirun` starts on this machine, held against those of one process.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use asperity_base::Field;
use asperity_mpi::demand_on_ranks;
use asperity_study::{Case, Existing, Outcome, Results, SurfaceInput, run};
use tempfile::TempDir;

/// Two rough bodies of 256 × 256 cells.
fn case(boundary: &str, hardness: &str, shape: [usize; 2], contact: &str) -> String {
    format!(
        r#"
        [lower]
        young = "210 GPa"
        poisson = 0.3
        {hardness}
        [lower.topography]
        generate = "self-affine"
        shape = {shape:?}
        pitch = "1 um"
        hurst = 0.8
        rolloff = "64 um"
        shortest = "8 um"
        sq = "60 nm"
        seed = 1

        [upper]
        young = "210 GPa"
        poisson = 0.3
        [upper.topography]
        generate = "low-pass"
        sq = "40 nm"
        cutoff = "16 um"
        seed = 2

        [contact]
        boundary = "{boundary}"
        {contact}
        "#
    )
}

/// `mpirun` with so many ranks and these arguments of the command, to be started.
fn ranks(count: usize, arguments: &[&str], folder: &Path) -> Command {
    let mut command = Command::new("mpirun");
    command
        .args(["--oversubscribe", "--allow-run-as-root", "-np", &count.to_string()])
        .arg(env!("CARGO_BIN_EXE_asperity-mpi"))
        .args(arguments)
        .current_dir(folder)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

/// What ranks print and how they end.
fn output(count: usize, arguments: &[&str], folder: &Path) -> Output {
    ranks(count, arguments, folder).output().expect("mpirun")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// A folder with this case file in it.
fn folder(case: &str) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("case.toml");
    fs::write(&file, case).unwrap();
    (folder, file)
}

fn field(results: &Results, name: &str) -> Field {
    results.static_fields().unwrap().read(name).unwrap().into_field().unwrap()
}

/// Holds the contact on so many ranks against that of one process: all fields, and all numbers.
fn compare(text_of_case: &str, count: usize) {
    let (folder, file) = folder(text_of_case);
    let found = output(count, &["run", "case.toml", "--out", "ranks", "--collect"], folder.path());
    assert!(found.status.success(), "{}{}", text(&found.stdout), text(&found.stderr));
    let one = folder.path().join("one");
    let case = Case::load(&file).unwrap();
    run(&case, SurfaceInput::default(), &one, Existing::Keep, &()).unwrap();
    let [ranks, one] = [folder.path().join("ranks"), one].map(|path| Results::open(&path).unwrap());
    assert_eq!(ranks.case_json().unwrap(), one.case_json().unwrap());
    let names = one.static_fields().unwrap().names().unwrap();
    assert_eq!(ranks.static_fields().unwrap().names().unwrap(), names);
    for name in names.iter().filter(|name| *name != "gap" && *name != "plastic") {
        let [on_ranks, alone] = [&ranks, &one].map(|results| field(results, name));
        let size = alone.iter().fold(0.0, |m: f64, value| m.max(value.abs()));
        let error = (&on_ranks - &alone).iter().fold(0.0, |m: f64, e| m.max(e.abs()));
        assert!(error <= 1e-10 * size, "{name} on {count} ranks: {error:e} of {size:e}");
    }
    let [ranks, one] = [ranks, one].map(|results| match results.summary().unwrap().outcome {
        Outcome::Static(record) => *record,
        other => panic!("{other:?}"),
    });
    for (name, a, b) in [
        ("load", ranks.load, one.load),
        ("approach", ranks.approach, one.approach),
        ("area", ranks.contact_area, one.contact_area),
        ("apparent area", ranks.apparent_area, one.apparent_area),
        ("pressure", ranks.max_pressure, one.max_pressure),
        ("gap", ranks.mean_gap, one.mean_gap),
        ("energy", ranks.elastic_energy, one.elastic_energy),
        ("capped", ranks.plastic_cells as f64, one.plastic_cells as f64),
        ("volume", ranks.plastic_volume, one.plastic_volume),
    ] {
        assert!((a - b).abs() <= 1e-9 * b.abs(), "{name}: {a:e} and {b:e}");
    }
}

const LOAD: &str = "load = \"2 N\"\ntolerance = 1e-12";
const HARD: &str = "hardness = \"1.5 GPa\"";

#[test]
fn a_free_contact_on_four_ranks_is_that_of_one_process() {
    compare(&case("free", "", [256, 256], LOAD), 4);
    compare(&case("free", HARD, [256, 256], LOAD), 4);
}

#[test]
fn a_periodic_contact_on_four_ranks_is_that_of_one_process() {
    compare(&case("periodic", "", [256, 256], LOAD), 4);
    compare(&case("periodic", HARD, [256, 256], "mean_pressure = \"100 MPa\"\ntolerance = 1e-12"), 4);
}

#[test]
fn ranks_that_do_not_divide_the_rows_are_as_good() {
    compare(&case("free", HARD, [256, 200], LOAD), 3);
    compare(&case("periodic", "", [250, 256], "approach = \"-100 nm\"\ntolerance = 1e-12"), 3);
}

#[test]
fn fields_may_be_collected_later_and_results_replaced() {
    let (folder, _) = folder(&case("free", "", [64, 48], "load = \"50 mN\""));
    let at = |name: &str| folder.path().join("case-results").join(name);
    let found = output(3, &["run", "case.toml"], folder.path());
    assert!(found.status.success(), "{}", text(&found.stderr));
    assert!(text(&found.stdout).contains("ranks             3"), "{}", text(&found.stdout));
    assert!(at("fields/rank-0002.h5").exists() && at("fields/ranks.json").exists());
    assert!(at("summary.json").exists() && !at("fields.h5").exists());
    let kept = output(2, &["run", "case.toml"], folder.path());
    let said = text(&kept.stderr);
    assert_eq!(kept.status.code(), Some(2), "{said}");
    assert!(said.contains("error: case-results already holds results\nhint: --overwrite replaces"), "{said}");
    assert!(!said.contains("--resume"), "nothing is resumed: {said}");
    let replaced = output(2, &["run", "case.toml", "--overwrite"], folder.path());
    assert!(replaced.status.success(), "{}", text(&replaced.stderr));
    assert!(!at("fields/rank-0002.h5").exists());
    let collected = output(1, &["collect", "case-results"], folder.path());
    assert!(collected.status.success(), "{}", text(&collected.stderr));
    assert!(at("fields.h5").exists());
    // Neither the rows of another rank nor a damaged file are taken for those of a rank.
    fs::copy(at("fields/rank-0000.h5"), at("fields/rank-0001.h5")).unwrap();
    let exchanged = output(1, &["collect", "case-results"], folder.path());
    let said = text(&exchanged.stderr);
    assert_eq!(exchanged.status.code(), Some(2), "{said}");
    assert!(said.contains("rank-0001.h5 holds rows 0 to 31") && said.contains("hint: "), "{said}");
    fs::write(at("fields/rank-0001.h5"), b"nothing").unwrap();
    let damaged = output(1, &["collect", "case-results"], folder.path());
    assert_eq!(damaged.status.code(), Some(2));
    assert!(text(&damaged.stderr).contains("rank-0001.h5"), "{}", text(&damaged.stderr));
}

#[test]
fn what_cannot_be_computed_is_refused_at_its_place() {
    let moving = case("free", "", [64, 48], "load = \"50 mN\"") + "[motion]\npasses = 1\nstride = 4\n";
    let few = case("free", "", [3, 48], "load = \"50 mN\"").replace("16 um", "2 um");
    let line = moving.lines().position(|line| line.trim() == "[motion]").unwrap() + 1;
    for (case, expected) in [
        (moving.as_str(), format!("error: 'motion' is not computed on ranks\n  --> case.toml:{line}:")),
        (few.as_str(), "4 ranks are too many for a grid of 3 rows along x".to_owned()),
        ("[lower]\nyoung = 3\n", "case.toml:".to_owned()),
    ] {
        let (folder, _) = folder(case);
        let found = output(4, &["run", "case.toml"], folder.path());
        let stderr = text(&found.stderr);
        assert!(found.status.code() == Some(2) && stderr.contains(&expected), "{expected}: {stderr}");
        assert_eq!(stderr.matches("error: ").count(), 1, "one rank reports: {stderr}");
        assert!(!folder.path().join("case-results").join("case.json").exists());
    }
}

#[test]
fn what_no_machine_holds_is_refused_with_both_numbers() {
    let (folder, _) = folder(&case("free", "", [1 << 16, 1 << 16], LOAD));
    // Some 300 GB, on any machine more than these ranks may have.
    let script =
        "ulimit -v 16000000 && exec mpirun --oversubscribe --allow-run-as-root -np 2 \"$0\" run case.toml";
    let mut command = Command::new("sh");
    command.args(["-c", script, env!("CARGO_BIN_EXE_asperity-mpi")]).current_dir(folder.path());
    let found = command.output().expect("mpirun");
    let said = text(&found.stderr);
    assert_eq!(found.status.code(), Some(1), "{said}");
    let line = said.lines().find(|line| line.starts_with("error: ")).unwrap_or_default();
    assert!(line.contains(" GB of memory are needed, ") && line.ends_with(" are free"), "{said}");
    assert!(said.contains("\nhint: fewer cells take less"), "{said}");
    assert!(!said.contains("panicked") && !said.contains("backtrace"), "{said}");
    assert!(!folder.path().join("case-results").exists());
}

#[test]
fn the_memory_of_a_rank_is_foretold() {
    let text_of_case = case("free", "", [1024, 1024], "load = \"30 N\"").replace("low-pass", "self-affine");
    let text_of_case =
        text_of_case.replace("cutoff = \"16 um\"", "hurst = 0.8\nrolloff = \"64 um\"\nshortest = \"8 um\"");
    let (folder, file) = folder(&text_of_case);
    let case = Case::load(&file).unwrap();
    for count in [1, 2, 4] {
        let found = output(count, &["run", "case.toml", "--overwrite"], folder.path());
        let told = text(&found.stdout);
        assert!(found.status.success(), "{}", text(&found.stderr));
        let used = told.split("each of at most ").nth(1).and_then(|rest| rest.split(' ').next());
        let used: f64 = used.unwrap().parse().unwrap();
        let needed = demand_on_ranks(&case, count).unwrap();
        let needed = needed.steady.max(needed.making) / 1e6;
        assert!(
            (1.0 / 1.5..1.5).contains(&(needed / used)),
            "{count} ranks: {needed:.0} MB told, {used} MB used"
        );
    }
}

#[test]
fn ranks_with_different_results_directories_are_refused() {
    let (folder, _) = folder(&case("free", "", [64, 48], "load = \"50 mN\""));
    let program = env!("CARGO_BIN_EXE_asperity-mpi");
    let mut command = Command::new("mpirun");
    command.args([
        "--oversubscribe",
        "--allow-run-as-root",
        "-np",
        "1",
        program,
        "run",
        "case.toml",
        "--out",
        "one",
    ]);
    command.args([":", "-np", "1", program, "run", "case.toml", "--out", "other"]);
    let found = command.current_dir(folder.path()).output().expect("mpirun");
    let said = text(&found.stderr);
    assert_eq!(found.status.code(), Some(2), "{said}");
    assert!(said.contains("error: rank 1 has another results directory than rank 0"), "{said}");
    let left = |name: &str| folder.path().join(name).join("case.json").exists();
    assert!(!left("one") && !left("other"));
}

#[test]
fn a_rank_that_is_killed_ends_all_with_a_message() {
    // Large enough to be under way for a while.
    let text_of_case = case("free", HARD, [1024, 1024], "load = \"30 N\"\ntolerance = 1e-12");
    let (folder, _) = folder(&text_of_case);
    let mut run = ranks(3, &["run", "case.toml"], folder.path()).spawn().expect("mpirun");
    let began = Instant::now();
    let rank = loop {
        match children(&run).as_slice() {
            [_, rank, _] => break *rank,
            _ if began.elapsed() > Duration::from_secs(60) => panic!("no ranks"),
            _ => thread::sleep(Duration::from_millis(50)),
        }
    };
    thread::sleep(Duration::from_millis(1500));
    assert!(run.try_wait().unwrap().is_none(), "ended before it was killed");
    let killed = Command::new("kill").args(["-9", &rank.to_string()]).status().unwrap();
    assert!(killed.success());
    let killed_at = Instant::now();
    let found = run.wait_with_output().unwrap();
    assert!(killed_at.elapsed() < Duration::from_secs(30), "the others went on");
    assert!(!found.status.success());
    assert!(text(&found.stderr).contains("signal 9"), "{}", text(&found.stderr));
    assert!(!folder.path().join("case-results/summary.json").exists());
}

/// The processes that a process has started and that are this command.
fn children(parent: &Child) -> Vec<u32> {
    let found = Command::new("ps").args(["-o", "pid=,comm=", "--ppid", &parent.id().to_string()]).output();
    let found = text(&found.expect("ps").stdout);
    let processes = found.lines().filter(|line| line.contains("asperity-mpi"));
    processes.filter_map(|line| line.split_whitespace().next()?.parse().ok()).collect()
}
