//! The messages of the library suit every front end: only `study`, which reads case files, and the rules of
//! capabilities, which are rules of case files, mention their keys. Nothing mentions the arguments of a
//! command.

use std::fs;
use std::path::{Path, PathBuf};

use crate::support::crates;

/// Words known only to a front end.
const ARGUMENTS: [&str; 11] = [
    "--channel",
    "--unit",
    "--pitch",
    "--lines",
    "--skip",
    "--fill",
    "--level",
    "--out",
    "--resume",
    "--overwrite",
    "--threads",
];
/// Crates that know no command.
const LIBRARIES: [&str; 6] = [
    "asperity",
    "asperity-base",
    "asperity-surface",
    "asperity-elastic",
    "asperity-contact",
    "asperity-study",
];
const TABLES: [&str; 7] =
    ["[contact]", "[friction]", "[motion]", "[subsurface]", "[output]", "[[history]]", ".topography]"];
const KEYS: [&str; 22] = [
    "method",
    "tolerance",
    "boundary",
    "fill",
    "level",
    "window",
    "resample",
    "shape",
    "pitch",
    "hardness",
    "coupling",
    "increments",
    "control",
    "strategy",
    "passes",
    "stride",
    "plastic_update",
    "pressure_every",
    "load_tolerance",
    "channel",
    "lines",
    "skip",
];

#[test]
fn no_message_of_the_library_speaks_of_keys_or_arguments() {
    let mut found = Vec::new();
    let mut literals_seen = 0;
    let libraries = crates().into_iter().filter(|(name, _)| LIBRARIES.contains(&name.as_str()));
    for (name, file) in
        libraries.flat_map(|(name, source)| files(&source).into_iter().map(move |file| (name.clone(), file)))
    {
        let text = fs::read_to_string(&file).unwrap();
        for literal in literals(before_tests(&text)) {
            literals_seen += 1;
            let within = |folder: &str| file.components().any(|part| part.as_os_str() == folder);
            let reads_cases = name == "asperity-study" && !within("io")
                || name == "asperity-contact" && within("with") && file.ends_with("rules.rs");
            let of_a_case = !reads_cases && speaks_of_a_case(&literal);
            if of_a_case || ARGUMENTS.iter().any(|argument| literal.contains(argument)) {
                found.push(format!("{}: {literal}", file.display()));
            }
        }
    }
    assert!(literals_seen > 1000, "only {literals_seen} literals: are they still read rightly?");
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

/// A literal that continues in the next line without a backslash contains the leading blanks of that line.
#[test]
fn no_message_has_two_blanks_in_a_row() {
    let mut found = Vec::new();
    let mut lines_seen = 0;
    for (_, source) in crates() {
        for file in files(&source) {
            // Headers of files have columns.
            if file.components().any(|part| part.as_os_str() == "formats") {
                continue;
            }
            let text = fs::read_to_string(&file).unwrap();
            for literal in literals(before_tests(&text)) {
                let lines = joined(&literal);
                lines_seen += lines.len();
                let wrong = lines.iter().filter(|line| has_gap(line));
                found.extend(wrong.map(|line| format!("{}: {line}", file.display())));
            }
        }
    }
    assert!(lines_seen > 1000, "only {lines_seen} lines: are they still read rightly?");
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

/// Returns the lines of a literal as printed.
fn joined(literal: &str) -> Vec<String> {
    let mut parts = literal.split("\\\n");
    let first = parts.next().unwrap_or_default().to_owned();
    let text = parts.fold(first, |text, part| text + part.trim_start());
    text.replace("\\n", "\n").lines().map(|line| line.trim().to_owned()).collect()
}

/// Whether a line of prose contains two consecutive blanks. Columns of a table may: a word or two, or a
/// number, before the next one.
fn has_gap(line: &str) -> bool {
    let Some(at) = line.find("  ") else { return false };
    let (before, after) = (&line[..at], line[at..].trim_start());
    let of_table = before.ends_with(|c: char| c.is_ascii_digit() || c == '}');
    let begins_a_word = after.starts_with(char::is_alphanumeric);
    before.split_whitespace().count() > 2 || (begins_a_word && !of_table)
}

#[test]
fn a_gap_in_prose_is_told_from_a_column() {
    for line in ["some 4 %      at a tenth", "a load  below", "give it one  {unit}", "it has {n}  cells"] {
        assert!(has_gap(line), "{line}");
    }
    for line in
        ["load          {}", "0    done", "{sizes}   order", "one blank only", "contact area  {:.4} %"]
    {
        assert!(!has_gap(line), "{line}");
    }
    let broken = "some 4 % \\\n             at a tenth\\n  in a table";
    assert_eq!(joined(broken), ["some 4 % at a tenth", "in a table"]);
    assert_eq!(joined("some 4 %\n             at a tenth").len(), 2);
}

fn speaks_of_a_case(literal: &str) -> bool {
    let assigned = |key: &&str| {
        literal
            .match_indices(&format!("{key} = "))
            .any(|(at, _)| !literal[..at].ends_with(|c: char| c == '_' || c.is_alphanumeric()))
            || literal.contains(&format!("`{key}`"))
    };
    TABLES.iter().any(|table| literal.contains(table)) || KEYS.iter().any(assigned)
}

/// Returns every Rust file under `folder`, except those with tests alone.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.file_stem().is_some_and(|stem| stem == "tests") {
            continue;
        }
        if path.is_dir() {
            files.extend(self::files(&path));
        } else {
            files.push(path);
        }
    }
    files
}

fn before_tests(text: &str) -> &str {
    text.split("#[cfg(test)]").next().unwrap_or_default()
}

/// Returns the string literals of code, without those in comments.
fn literals(code: &str) -> Vec<String> {
    let code: String = code
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .map(|line| line.to_owned() + "\n")
        .collect();
    let mut literals = Vec::new();
    let (mut literal, mut before): (Option<String>, char) = (None, ' ');
    let mut chars = code.chars();
    while let Some(c) = chars.next() {
        match (&mut literal, c) {
            // A quotation mark as a character.
            (None, '"') if before == '\'' => {}
            (None, '"') => literal = Some(String::new()),
            (None, _) => {}
            (Some(text), '\\') => {
                text.push(c);
                text.extend(chars.next());
            }
            (Some(_), '"') => literals.extend(literal.take()),
            (Some(text), c) => text.push(c),
        }
        before = c;
    }
    literals
}

#[test]
fn what_is_for_a_front_end_alone_is_found() {
    let code = "//! \"`method`\"\nlet c = '\"'; say(\"set fill = \\\"nearest\\\"\");\n// \"no\"\nsay(\"a\");";
    assert_eq!(literals(code), ["set fill = \\\"nearest\\\"", "a"]);
    assert!(speaks_of_a_case("set fill = \\\"nearest\\\""));
    assert!(speaks_of_a_case("give `increments`") && speaks_of_a_case("in [motion]"));
    assert!(!speaks_of_a_case("refill = x") && !speaks_of_a_case("the method of Polonsky and Keer"));
}
