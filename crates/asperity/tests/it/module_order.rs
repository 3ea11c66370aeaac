//! The order of the modules in `lib.rs` is their order of dependence: no file uses a module declared below
//! its own.

use std::fs;
use std::path::{Path, PathBuf};

use crate::support::crates;

#[test]
fn no_module_uses_one_declared_below_it() {
    for (name, source) in crates().into_iter().filter(|(name, _)| ORDERED.contains(&name.as_str())) {
        let violations = violations(&source);
        assert!(violations.is_empty(), "{name}:\n{}", violations.join("\n"));
    }
}

/// Crates whose `lib.rs` declares the modules in their order. Others are held free of circles.
const ORDERED: [&str; 3] = ["asperity-base", "asperity-elastic", "asperity-contact"];

fn violations(source: &Path) -> Vec<String> {
    let lib = fs::read_to_string(source.join("lib.rs")).unwrap();
    let modules = declared_modules(&lib);
    let reexports = reexports(&lib);
    assert!(modules.len() > 5, "lib.rs declares {modules:?}: is it still read rightly?");

    let mut violations = Vec::new();
    for (rank, module) in modules.iter().enumerate() {
        for file in files_of(source, module) {
            let text = fs::read_to_string(&file).unwrap();
            for (line, name) in uses(&text) {
                let home = reexports.iter().find(|(item, _)| *item == name).map_or(&name, |(_, home)| home);
                if modules.iter().position(|other| other == home).is_some_and(|other| other > rank) {
                    let file = file.strip_prefix(source).unwrap().display();
                    violations
                        .push(format!("src/{file}:{line}: `{module}` uses `{home}`, declared below it"));
                }
            }
        }
    }
    violations
}

/// Returns the names in `mod name;`, in order, for public and private modules.
fn declared_modules(lib: &str) -> Vec<String> {
    lib.lines()
        .filter_map(|line| {
            let line = line.trim();
            line.strip_prefix("pub ").unwrap_or(line).strip_prefix("mod ")?.split(';').next()
        })
        .map(str::to_owned)
        .collect()
}

/// Returns each item of `pub use module::{…};` with its module.
fn reexports(lib: &str) -> Vec<(String, String)> {
    let code: String = lib.lines().map(without_comment).collect::<Vec<_>>().join("\n");
    code.split(';')
        .filter_map(|statement| statement.trim().strip_prefix("pub use ")?.split_once("::"))
        .flat_map(|(module, items)| {
            items
                .split(|c: char| c != '_' && !c.is_alphanumeric())
                .filter(|item| !item.is_empty())
                .map(|item| (item.to_owned(), module.to_owned()))
        })
        .collect()
}

/// Returns `src/module.rs` and every Rust file under `src/module/`.
fn files_of(source: &Path, module: &str) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut folders = vec![source.join(module)];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).into_iter().flatten() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                files.push(path);
            }
        }
    }
    let single = source.join(format!("{module}.rs"));
    if single.exists() {
        files.push(single);
    }
    assert!(!files.is_empty(), "`mod {module};` has no file");
    files.sort();
    files
}

/// Returns every name that follows `crate::` in code, with its line: a for `crate::a::x`, a and b for
/// `crate::{a::x, b}`. Comments, including links in doc comments, do not count.
fn uses(text: &str) -> Vec<(usize, String)> {
    let code: String = text.lines().map(|line| without_comment(line).to_owned() + "\n").collect();
    let line = |offset: usize| 1 + code[..offset].matches('\n').count();
    let mut found = Vec::new();
    for (start, root) in code.match_indices("crate::") {
        if code[..start].ends_with(|c: char| c == '_' || c == '$' || c.is_alphanumeric()) {
            continue;
        }
        let path = start + root.len();
        if code[path..].starts_with('{') {
            let members = group_members(&code[path..]);
            found.extend(members.iter().map(|at| (line(path + at), identifier(&code[path + at..]))));
        } else {
            found.push((line(start), identifier(&code[path..])));
        }
    }
    found
}

/// Returns the starts of the members of a group `{a::x, b::{c, d}}`, without those of inner groups.
fn group_members(group: &str) -> Vec<usize> {
    let (mut depth, mut expected, mut members) = (0, false, Vec::new());
    for (offset, c) in group.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ if depth == 1 && expected && c != ',' && !c.is_whitespace() => members.push(offset),
            _ => {}
        }
        if depth == 0 {
            break;
        }
        expected = depth == 1 && (c == '{' || c == ',' || (expected && c.is_whitespace()));
    }
    members
}

/// Returns the identifier at the start of `text`.
fn identifier(text: &str) -> String {
    text.chars().take_while(|c| *c == '_' || c.is_alphanumeric()).collect()
}

/// Returns the line up to its `//`; one in a string also counts as a comment.
fn without_comment(line: &str) -> &str {
    line.split("//").next().unwrap_or("")
}

#[test]
fn uses_are_found_in_code_and_nowhere_else() {
    let text = "//! [`crate::motion`]\nuse crate::grid::Grid;\nuse crate::{\n    error::{Error, Result},\n    io,\n};\n\
                fn f() { crate::units::read(); } // crate::surface\nuse my_crate::solver;\nuse crate::Field;\n";
    let expected = [(2, "grid"), (4, "error"), (5, "io"), (7, "units"), (9, "Field")];
    assert_eq!(uses(text), expected.map(|(line, name)| (line, name.to_owned())));
}

#[test]
fn modules_and_reexports_are_read_from_lib() {
    let lib = "pub mod units;\n// pub mod no;\nmod error;\npub use error::{Error, Result};\n";
    assert_eq!(declared_modules(lib), ["units", "error"]);
    assert_eq!(reexports(lib), ["Error", "Result"].map(|item| (item.to_owned(), "error".to_owned())));
}
