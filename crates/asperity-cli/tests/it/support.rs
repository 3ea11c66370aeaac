//! What several subjects share: a folder, the command run in it, and what it leaves.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use asperity::io::fields::{Fields, StoredField};
use asperity::motion::PassRecord;
use asperity::study::Results;
use serde_json::Value;
use tempfile::TempDir;

/// The program: `ASPERITY_BINARY` names another build of it, such as an optimised one.
pub(crate) fn program() -> String {
    std::env::var("ASPERITY_BINARY").unwrap_or_else(|_| env!("CARGO_BIN_EXE_asperity").to_owned())
}

/// The command in `folder`; `arguments` are split at spaces.
pub(crate) fn command(folder: &TempDir, arguments: &str) -> Command {
    let mut command = Command::new(program());
    command.current_dir(folder).args(arguments.split_whitespace());
    command
}

/// Runs the command to its end.
pub(crate) fn asperity(folder: &TempDir, arguments: &str) -> Output {
    command(folder, arguments).output().unwrap()
}

/// Runs the command to its end under a limit of `ulimit`: `-f 8` for files of at most 8 KiB, as on a disk
/// that fills up.
pub(crate) fn limited(folder: &TempDir, limit: &str, arguments: &str) -> Output {
    let script = format!("ulimit {limit}; exec '{}' {arguments}", program());
    Command::new("bash").args(["-c", &script]).current_dir(folder).output().unwrap()
}

/// Starts the command.
pub(crate) fn spawn(folder: &TempDir, arguments: &str) -> Child {
    command(folder, arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Waits until a running process has written `file`.
#[track_caller]
pub(crate) fn wait_for(child: &mut Child, file: &Path) {
    let began = Instant::now();
    while !file.exists() {
        assert!(child.try_wait().unwrap().is_none(), "it ended before it wrote {}", file.display());
        if began.elapsed() > Duration::from_secs(120) {
            child.kill().unwrap();
            panic!("{} is not there after two minutes", file.display());
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}

#[track_caller]
pub(crate) fn send(signal: &str, child: &Child) {
    let sent = Command::new("kill").args([format!("-{signal}"), child.id().to_string()]).status().unwrap();
    assert!(sent.success());
}

pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// What is on stdout after success.
#[track_caller]
pub(crate) fn ok(output: &Output) -> String {
    assert!(output.status.success(), "{:?}: {}", output.status, stderr(output));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// What is on stderr after exit code 2, with nothing on stdout.
#[track_caller]
pub(crate) fn refused(output: &Output) -> String {
    assert!(output.stdout.is_empty());
    failed(output, 2)
}

/// What is on stderr after this exit code.
#[track_caller]
pub(crate) fn failed(output: &Output, code: i32) -> String {
    assert_eq!(output.status.code(), Some(code), "{}", stderr(output));
    stderr(output)
}

/// Asserts that a text has each of the parts that " … " separates.
#[track_caller]
pub(crate) fn assert_has(text: &str, parts: &str) {
    for part in parts.split(" … ") {
        assert!(text.contains(part), "no {part:?} in {text}");
    }
}

/// Asserts that each command is refused with a message that has the parts beside it.
#[track_caller]
pub(crate) fn assert_refused<const N: usize>(folder: &TempDir, cases: [(&str, &str); N]) {
    for (arguments, parts) in cases {
        let output = asperity(folder, arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments}: {}", stderr(&output));
        assert_has(&refused(&output), parts);
    }
}

/// The JSON on stdout after success.
#[track_caller]
pub(crate) fn json(output: &Output) -> Value {
    serde_json::from_str(&ok(output)).unwrap()
}

/// Changes a text in `file`, in which it must be.
#[track_caller]
pub(crate) fn change(file: &Path, from: &str, to: &str) {
    let text = fs::read_to_string(file).unwrap();
    assert!(text.contains(from), "{from}");
    fs::write(file, text.replace(from, to)).unwrap();
}

/// Paths of all files beneath, relative to `folder`.
pub(crate) fn files(folder: &Path) -> BTreeSet<String> {
    fn visit(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() { visit(&path, found) } else { found.push(path) }
        }
    }
    let mut found = Vec::new();
    visit(folder, &mut found);
    found.iter().map(|path| path.strip_prefix(folder).unwrap().to_str().unwrap().to_owned()).collect()
}

/// Two rough steel surfaces of 32 × 32 cells that yield a little.
pub(crate) fn moving(passes: usize, stride: usize) -> String {
    let body = |name: &str, seed: usize| {
        format!(
            "{name} = {{ young = \"210 GPa\", poisson = 0.3, hardness = \"4 GPa\", topography = {{ \
             generate = \"low-pass\", shape = [32, 32], pitch = \"1 um\", sq = \"35 nm\", cutoff = \"8 um\", \
             seed = {seed} }} }}\n"
        )
    };
    format!(
        "{}{}contact = {{ load = \"20 mN\" }}\n\
         motion = {{ passes = {passes}, stride = {stride}, load_tolerance = 1e-6 }}\n\
         output = {{ pressure_every = 4 }}\n",
        body("lower", 1),
        body("upper", 2)
    )
}

/// A ball that sinks into a softer plane.
pub(crate) const BALL: &str = r#"
[lower]
young = "210 GPa"
poisson = 0.3
hardness = "1 GPa"
topography = { form = "flat", shape = [32, 32], pitch = "1 um" }
[upper]
young = "210 GPa"
poisson = 0.3
topography = { form = "sphere", radius = "0.1 mm", shape = [32, 32], pitch = "1 um" }
[contact]
load = "20 mN"
"#;

/// The ball, elastic, with what follows [contact].
pub(crate) fn pushed(tables: &str) -> String {
    format!("{}{tables}", BALL.replace("hardness = \"1 GPa\"\n", ""))
}

/// Half of what friction holds, in three steps.
pub(crate) const PUSH: &str =
    "[friction]\ncoefficient = 0.3\nincrements = 2\n[[history]]\nforce = \"3 mN\"\nincrements = 3\n";

pub(crate) fn folder_with(name: &str, text: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join(name), text).unwrap();
    folder
}

/// `asperity run`; `arguments` are split at spaces.
pub(crate) fn run(folder: &TempDir, arguments: &str) -> Output {
    asperity(folder, &format!("run {arguments}"))
}

/// Whether a message is the one promised, in which … stands for a number that is nothing but rounding.
pub(crate) fn as_promised(promised: &str, message: &str) -> bool {
    match promised.split_once('…') {
        Some((before, after)) => message.starts_with(before) && message.ends_with(after),
        None => message == promised,
    }
}

pub(crate) fn summary(directory: &Path) -> Value {
    serde_json::from_slice(&fs::read(directory.join("summary.json")).unwrap()).unwrap()
}

pub(crate) fn keys(value: &Value) -> BTreeSet<String> {
    value.as_object().unwrap().keys().cloned().collect()
}

/// Names that blanks separate.
pub(crate) fn set(names: &str) -> BTreeSet<String> {
    names.split_whitespace().map(str::to_owned).collect()
}

/// Files of results: these, those that each run leaves, and pictures by their names alone.
pub(crate) fn promised(names: &str, pictures: &str) -> BTreeSet<String> {
    let of_each = set(".lock case.json report.html results.csv summary.json");
    let pictures = set(pictures).into_iter().map(|name| format!("figures/{name}.png"));
    set(names).into_iter().chain(of_each).chain(pictures).collect()
}

pub(crate) fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// The numbers of a table that has these columns.
pub(crate) fn table(path: &Path, columns: &[&str]) -> Vec<Vec<f64>> {
    let text = fs::read_to_string(path).unwrap();
    let (head, rows) = text.split_once('\n').unwrap();
    assert_eq!(head, columns.join(","));
    rows.lines().map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect()).collect()
}

/// The rows of a table that has these columns, each by its column.
pub(crate) fn table_of(path: &Path, columns: &'static [&'static str]) -> Vec<BTreeMap<&'static str, f64>> {
    let rows = table(path, columns).into_iter();
    rows.map(|row| columns.iter().copied().zip(row).collect()).collect()
}

/// A field of cells of 1 µm, with its unit and axes as promised.
#[track_caller]
pub(crate) fn field(fields: &Fields, name: &str, unit: &str) -> StoredField {
    let field = fields.read(name).unwrap();
    assert_eq!((field.unit.as_str(), field.axes.as_str()), (unit, "x,y"), "{name}");
    assert_eq!(field.pitch, [1e-6, 1e-6], "{name}");
    field
}

/// Two runs of one case that took different ways to their passes.
#[track_caller]
pub(crate) fn assert_same_passes(found: &Path, expected: &Path) {
    // All but the time of a pass is the same to the last bit.
    let untimed = |directory: &Path| -> Vec<PassRecord> {
        let mut passes = Results::open(directory).unwrap().passes().unwrap();
        passes.iter_mut().for_each(|pass| pass.wall_time_s = 0.0);
        passes
    };
    assert_eq!(untimed(found), untimed(expected));
    let bytes = |path: &Path| fs::read(path).unwrap();
    assert!(bytes(&found.join("steps.csv")) == bytes(&expected.join("steps.csv")), "steps.csv differs");
    let fields = files(&expected.join("fields"));
    assert_eq!(files(&found.join("fields")), fields);
    for name in fields {
        let [found, expected] =
            [found, expected].map(|directory| bytes(&directory.join("fields").join(&name)));
        assert!(found == expected, "fields/{name} differs");
    }
}
