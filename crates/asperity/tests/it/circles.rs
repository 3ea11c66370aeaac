//! Files have no circular dependencies.
//!
//! A file or folder uses a neighbour if any file in it names an item of any file in the neighbour. Items of
//! the common parent module do not count.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use crate::support::crates;

/// Path of a module below `src`.
type Module = Vec<String>;

#[test]
fn no_files_depend_on_each_other_in_a_circle() {
    let mut all = 0;
    for (name, source) in crates() {
        let files = files(&source);
        all += files.len();
        let circles = circles(&uses(&files));
        assert!(circles.is_empty(), "{name}:\n{}", circles.join("\n"));
    }
    assert!(all > 500, "only {all} files: are they still found?");
}

#[test]
fn circles_are_seen() {
    let file = |path: &str, text: &str| (path.split('/').map(str::to_owned).collect(), text.to_owned());
    let files = BTreeMap::from([
        (Vec::new(), "mod a; mod b;".to_owned()),
        file("a", "pub use one::{Item, Other}; mod one; mod two;"),
        file("a/one", "use super::two::{self, Thing};"),
        file("a/two", "use crate::{b::X, a::{Item as Known}};"),
        file("b", "fn f() { crate::a::g() }"),
    ]);
    assert_eq!(circles(&uses(&files)), ["src: a, b", "src/a: one, two"]);
}

/// Returns the code of each module, without comments and tests.
fn files(source: &Path) -> BTreeMap<Module, String> {
    let mut found = BTreeMap::new();
    let mut folders = vec![source.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let Some(name) = path.strip_prefix(source).unwrap().to_str().unwrap().strip_suffix(".rs") else {
                continue;
            };
            let mut module: Module = name.split('/').map(str::to_owned).collect();
            module.retain(|name| name != "mod" && name != "lib");
            if !module.iter().any(|name| name == "tests") {
                found.insert(module, code(&fs::read_to_string(&path).unwrap()));
            }
        }
    }
    found
}

fn code(text: &str) -> String {
    let text = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
    text.lines().map(|line| line.split("//").next().unwrap().to_owned() + "\n").collect()
}

/// Returns the modules named by each module.
fn uses(files: &BTreeMap<Module, String>) -> BTreeMap<Module, BTreeSet<Module>> {
    // Items that a module re-exports from its submodules, by their names there.
    let mut handed_on = BTreeMap::new();
    for (module, text) in files {
        for statement in text.split(';') {
            let Some((_, path)) =
                statement.split_once("pub use ").or(statement.split_once("pub(crate) use "))
            else {
                continue;
            };
            for mut path in paths(path) {
                path.retain(|name| name != "self");
                let home = [module.as_slice(), &path[..path.len() - 1]].concat();
                if path.len() > 1 && files.contains_key(&[module.as_slice(), &path[..1]].concat()) {
                    handed_on.insert((module.clone(), path[path.len() - 1].clone()), home);
                }
            }
        }
    }
    let home = |from: &Module, path: &[String]| {
        let ups = path.iter().take_while(|name| *name == "super").count();
        let (mut at, rest) = match path[0].as_str() {
            "crate" => (Vec::new(), &path[1..]),
            "self" => (from.clone(), &path[1..]),
            // In a module within `lib.rs` it names the root.
            _ => (from[..from.len().saturating_sub(ups)].to_vec(), &path[ups..]),
        };
        for name in rest {
            let below = [at.as_slice(), std::slice::from_ref(name)].concat();
            match (files.contains_key(&below), handed_on.get(&(at.clone(), name.clone()))) {
                (true, _) => at = below,
                (false, Some(home)) => at = home.clone(),
                (false, None) => break,
            }
        }
        at
    };
    let of = |(module, text): (&Module, &String)| {
        let mut named = BTreeSet::new();
        for root in ["crate::", "super::", "self::"] {
            for (start, _) in text.match_indices(root) {
                let is_root = !text[..start].ends_with(|c: char| c == '_' || c == ':' || c.is_alphanumeric());
                if is_root {
                    named.extend(paths(&text[start..]).iter().map(|path| home(module, path)));
                }
            }
        }
        (module.clone(), named)
    };
    files.iter().map(of).collect()
}

/// Returns the paths at the start of `text`: a::b and a::c::d for `a::{b, c::d} …`.
fn paths(text: &str) -> Vec<Module> {
    let name =
        |text: &str| -> String { text.chars().take_while(|c| *c == '_' || c.is_alphanumeric()).collect() };
    let text = text.trim_start();
    if let Some(group) = text.strip_prefix('{') {
        let (mut depth, mut start, mut members) = (0, 0, Vec::new());
        for (at, c) in group.char_indices() {
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => {
                    members.push(&group[start..at]);
                    break;
                }
                '}' => depth -= 1,
                ',' if depth == 0 => {
                    members.push(&group[start..at]);
                    start = at + 1;
                }
                _ => {}
            }
        }
        return members.into_iter().filter(|member| !member.trim().is_empty()).flat_map(paths).collect();
    }
    let first = name(text);
    match text[first.len()..].trim_start().strip_prefix("::") {
        Some(rest) => paths(rest).into_iter().map(|path| [vec![first.clone()], path].concat()).collect(),
        None => vec![vec![first]],
    }
}

/// Returns the neighbouring files and folders that depend on themselves.
fn circles(uses: &BTreeMap<Module, BTreeSet<Module>>) -> Vec<String> {
    let mut beside: BTreeMap<&[String], BTreeMap<&str, BTreeSet<&str>>> = BTreeMap::new();
    for (from, named) in uses {
        for to in named {
            let common = from.iter().zip(to).take_while(|(one, other)| one == other).count();
            if let (Some(one), Some(other)) = (from.get(common), to.get(common)) {
                beside.entry(&from[..common]).or_default().entry(one).or_default().insert(other);
            }
        }
    }
    let mut found = Vec::new();
    for (folder, uses) in beside {
        let mut told = BTreeSet::new();
        for name in uses.keys().copied() {
            let circle: Vec<&str> = reached(&uses, name)
                .into_iter()
                .filter(|other| reached(&uses, other).contains(name))
                .collect();
            if !circle.is_empty() && told.insert(circle.clone()) {
                found.push(format!(
                    "{}: {}",
                    [&["src".to_owned()], folder].concat().join("/"),
                    circle.join(", ")
                ));
            }
        }
    }
    found
}

/// Returns everything reachable from a file or folder.
fn reached<'a>(uses: &BTreeMap<&'a str, BTreeSet<&'a str>>, from: &str) -> BTreeSet<&'a str> {
    let mut seen = BTreeSet::new();
    let mut left: Vec<&str> = uses.get(from).into_iter().flatten().copied().collect();
    while let Some(at) = left.pop() {
        if seen.insert(at) {
            left.extend(uses.get(at).into_iter().flatten());
        }
    }
    seen
}
