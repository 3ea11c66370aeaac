//! README and tutorials show what the program prints.
//!
//! The commands of their `sh` and `python` blocks are run in their order, in one folder for each document; a
//! `text` block that follows is what the last of them prints. A `toml` block with a name, such as
//! `toml two.toml`, is a file in that folder. With `ASPERITY_DOCUMENTS=write` the `text` blocks are written
//! anew.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::support::program;

/// Numbers may differ by so much of themselves, or by one in their last decimal: loads are met to 10⁻⁴, and
/// machines round differently.
const TOLERANCE: f64 = 0.01;

#[test]
fn readme_shows_what_is_printed() {
    hold(&root().join("README.md"));
}

#[test]
#[ignore = "needs an optimised build, which ASPERITY_BINARY names, and a Python with numpy and h5py, which ASPERITY_PYTHON names"]
fn tutorials_show_what_is_printed() {
    let tutorials = fs::read_dir(root().join("docs/tutorials")).unwrap();
    tutorials.for_each(|entry| hold(&entry.unwrap().path()));
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Compares a document with what its commands print.
fn hold(path: &Path) {
    let text = fs::read_to_string(path).unwrap();
    let (made, shown) = with_outputs(&text);
    assert!(shown > 0, "{} shows nothing that is printed", path.display());
    if std::env::var("ASPERITY_DOCUMENTS").is_ok_and(|value| value == "write") {
        fs::write(path, made).unwrap();
    } else if let Some((shown, printed)) = first_difference(&text, &made) {
        panic!("{} shows\n{shown}\nbut printed is\n{printed}", path.display());
    }
}

/// The document with what its commands print in its `text` blocks, and how many of these there are.
fn with_outputs(text: &str) -> (String, usize) {
    let folder = tempfile::tempdir().unwrap();
    let (mut made, mut shown) = (String::new(), 0);
    let mut printed: Option<String> = None;
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        made += &format!("{line}\n");
        let Some(language) = line.strip_prefix("```") else { continue };
        let block: String =
            lines.by_ref().take_while(|line| *line != "```").map(|line| format!("{line}\n")).collect();
        match (language, printed.take()) {
            ("text", Some(output)) => {
                made += &output;
                shown += 1;
            }
            _ => made += &block,
        }
        match language {
            "sh" => printed = run(&block, folder.path()),
            // The tests of the Python package run what uses it.
            "python" if !block.contains("import asperity") => printed = Some(python(&block, folder.path())),
            _ => {
                if let Some(name) = language.strip_prefix("toml ") {
                    fs::write(folder.path().join(name), &block).unwrap();
                }
            }
        }
        made += "```\n";
    }
    (made, shown)
}

/// What the last of the block's commands prints; nothing where none of them is the program's.
fn run(block: &str, folder: &Path) -> Option<String> {
    let mut printed = None;
    for line in block.lines() {
        let command =
            ["asperity ", "cargo run --release -- "].iter().find_map(|start| line.strip_prefix(start));
        // Commands with a name to fill in are there to be read.
        let Some(command) =
            command.filter(|command| !command.contains("--path") && !command.contains("FILE"))
        else {
            continue;
        };
        let arguments = command.split('#').next().unwrap().split_whitespace();
        let output = Command::new(program()).args(arguments).current_dir(folder).output().unwrap();
        assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
        printed = Some(String::from_utf8(output.stdout).unwrap());
    }
    printed
}

/// What a Python program prints.
fn python(block: &str, folder: &Path) -> String {
    let python =
        std::env::var_os("ASPERITY_PYTHON").expect("ASPERITY_PYTHON names a Python with numpy and h5py");
    let output = Command::new(python).args(["-c", block]).current_dir(folder).output().unwrap();
    assert!(output.status.success(), "{block}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The first lines that differ by more than the last digits of their numbers.
fn first_difference(shown: &str, printed: &str) -> Option<(String, String)> {
    let (mut shown, mut printed) = (shown.lines(), printed.lines());
    loop {
        match (shown.next(), printed.next()) {
            (None, None) => return None,
            (one, other) => {
                let [one, other] = [one, other].map(Option::unwrap_or_default);
                if !alike(one, other) {
                    return Some((one.to_owned(), other.to_owned()));
                }
            }
        }
    }
}

fn alike(one: &str, other: &str) -> bool {
    // These belong to the machine.
    if ["time ", "memory "].iter().any(|start| one.starts_with(start) && other.starts_with(start)) {
        return true;
    }
    let ([words, numbers], [other_words, other_numbers]) = (parts(one), parts(other));
    let near = |(one, other): (&String, &String)| match (one.parse::<f64>(), other.parse::<f64>()) {
        (Ok(a), Ok(b)) => {
            let difference = (a - b).abs();
            difference <= TOLERANCE * a.abs().max(b.abs()) || difference <= 1.01 * last_decimal(one)
        }
        _ => one == other,
    };
    words == other_words
        && numbers.len() == other_numbers.len()
        && numbers.iter().zip(&other_numbers).all(near)
}

/// The worth of one in the last decimal of a number; nothing for a whole number.
fn last_decimal(number: &str) -> f64 {
    number.split_once('.').map_or(0.0, |(_, decimals)| 10f64.powi(-(decimals.len() as i32)))
}

/// The words of a line and its numbers; how far apart they stand does not count.
fn parts(line: &str) -> [Vec<String>; 2] {
    let is_of_number = |c: char| c.is_ascii_digit() || c == '.';
    let mut parts = [Vec::new(), Vec::new()];
    for word in line.split_whitespace() {
        let mut rest = word;
        while !rest.is_empty() {
            let number = rest.starts_with(|c: char| c.is_ascii_digit());
            let end = rest.find(|c| is_of_number(c) != number).unwrap_or(rest.len()).max(1);
            let end = (end..=rest.len()).find(|end| rest.is_char_boundary(*end)).unwrap();
            parts[usize::from(number)].push(rest[..end].trim_end_matches('.').to_owned());
            rest = &rest[end..];
        }
    }
    parts
}

#[test]
fn last_digits_may_differ_and_nothing_else() {
    assert!(alike("   1   30.71   180.0  1e-6", "   1  30.70  180.1 1e-6"));
    assert!(alike("4.5e-5", "4.6e-5"));
    for (one, other) in [
        ("load 30.7 nm", "load 31.7 nm"),
        ("load 3 nm", "load 3 µm"),
        ("4.5e-5", "4.7e-5"),
        ("4.5e-5", "4.5e-6"),
        ("3", "4"),
        ("a 1", "a 1 2"),
        ("", "a"),
    ] {
        assert!(!alike(one, other), "{one}: {other}");
    }
    let document = "x\n```sh\nls\n```\n\n```text\nnot ours\n```\n";
    assert_eq!(with_outputs(document), (document.to_owned(), 0));
}
