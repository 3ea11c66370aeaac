//! What several subjects share: a folder, the command run in it, and what it leaves.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

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

/// Runs the command to its end under a limit of `ulimit`: `-f 8` for files of at most 8 KiB, as on a disk that fills up.
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
    assert_eq!(output.status.code(), Some(2), "{}", stderr(output));
    assert!(output.stdout.is_empty());
    stderr(output)
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
