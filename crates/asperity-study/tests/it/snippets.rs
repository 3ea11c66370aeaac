//! Pieces of case files in the documents are valid, and each key has one that shows it.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use asperity_study::Case;
use asperity_study::case::schema::Section;
use toml::{Table, Value};

use crate::ball::{ball, completed};

#[test]
fn every_snippet_of_its_pages_is_valid_in_the_case_of_a_ball() {
    let mut wrong = Vec::new();
    for page in pages() {
        for snippet in snippets(&page) {
            let case = toml::to_string(&completed(snippet, &ball())).unwrap();
            if let Err(error) = Case::parse(&case, &page, Path::new("")) {
                wrong.push(format!("{error}\n{case}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{} snippets:\n{}", wrong.len(), wrong.join("\n"));
}

/// An example, a snippet, or the text on the page of its table, as in `` `stride = 2` ``, gives each key a
/// value.
#[test]
fn every_key_is_shown_with_a_value() {
    let mut shown = BTreeSet::new();
    for folder in ["docs", "crates/asperity-cli/examples"] {
        for path in files(&root().join(folder)) {
            match path.extension().and_then(|extension| extension.to_str()) {
                Some("toml") => gather("", &fs::read_to_string(path).unwrap().parse().unwrap(), &mut shown),
                Some("md") => snippets(&path).iter().for_each(|table| gather("", table, &mut shown)),
                _ => {}
            }
        }
    }
    let mut hidden = Vec::new();
    for page in pages() {
        let text = fs::read_to_string(page).unwrap();
        let in_text = keys_in_text(&text);
        let marks = text.lines().filter_map(|line| line.strip_prefix("<!-- keys: ")?.strip_suffix(" -->"));
        for name in marks.flat_map(|names| names.split(", ")) {
            let (table, kind) = name.split_once(" with ").unwrap_or((name, ""));
            let of_mark = |section: &&Section| {
                section.kind == kind && *section.tables.first().unwrap_or(&"root") == table
            };
            let section = asperity_study::keys().iter().find(of_mark).unwrap();
            for key in section.keys.iter().map(|key| key.name) {
                let in_table = |table: &&str| shown.contains(&format!("{table}.{key}"));
                let at_top = section.tables.is_empty() && shown.contains(key);
                if !in_text.contains(key) && !at_top && !section.tables.iter().any(in_table) {
                    hidden.push(format!("{name}: {key}"));
                }
            }
        }
    }
    assert!(hidden.is_empty(), "no example or snippet has\n{}", hidden.join("\n"));
}

/// The TOML blocks of a page; a line `# or` separates two in one block.
fn snippets(page: &Path) -> Vec<Table> {
    let text = fs::read_to_string(page).unwrap();
    let blocks = text.split("\n```toml").skip(1).map(|rest| rest.split("\n```").next().unwrap());
    let blocks = blocks.flat_map(|block| block.split_once('\n').unwrap().1.split("\n# or\n"));
    blocks.map(|block| block.parse().unwrap_or_else(|e| panic!("{}: {e}\n{block}", page.display()))).collect()
}

/// The keys to which the text of a page outside of blocks gives a value.
fn keys_in_text(page: &str) -> BTreeSet<String> {
    let outside = page.split("\n```").step_by(2).flat_map(str::lines);
    let mut keys = BTreeSet::new();
    for line in outside {
        for code in line.split('`').skip(1).step_by(2) {
            if let Ok(table) = code.parse::<Table>() {
                let mut within = BTreeSet::new();
                gather("", &table, &mut within);
                keys.extend(within.iter().map(|key| key.rsplit('.').next().unwrap().to_owned()));
            }
        }
    }
    keys
}

/// Adds the dotted names of all keys of a table, without the numbers of arrays and the layers of a topography.
fn gather(path: &str, table: &Table, keys: &mut BTreeSet<String>) {
    for (key, value) in table {
        let name = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        let of_both = name.strip_prefix("upper.").map(|rest| format!("lower.{rest}"));
        keys.insert(of_both.unwrap_or_else(|| name.clone()));
        let items = value.as_array().map_or(std::slice::from_ref(value), Vec::as_slice);
        let inner = name.trim_end_matches(".plus");
        items.iter().filter_map(Value::as_table).for_each(|table| gather(inner, table, keys));
    }
}

/// The pages of the case file.
fn pages() -> Vec<PathBuf> {
    [files(&root().join("docs/input")), vec![root().join("docs/input.md")]].concat()
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}
