//! The tables of keys in docs/input.md are those that the program declares.
//!
//! `UPDATE_DOCS=1 cargo test -p asperity --test it keys::` writes them anew. Above each stands a comment that names its
//! sections: `<!-- keys: lower.wear -->`, `<!-- keys: lower.topography with file -->`.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use asperity::study;
use asperity::study::case::schema::{Key, Section};

const MARK: &str = "<!-- keys: ";

#[test]
fn the_tables_of_keys_are_those_of_the_program() {
    let mut sections: BTreeMap<String, &Section> =
        study::keys().iter().filter(|section| section.kind != "given").map(|s| (name(s), s)).collect();
    let page = fs::read_to_string(page()).unwrap();
    let mut lines = page.lines().peekable();
    let mut written = String::new();
    while let Some(line) = lines.next() {
        written += line;
        written.push('\n');
        let Some(names) = line.strip_prefix(MARK) else { continue };
        let names = names.strip_suffix(" -->").expect("a comment ends in its line");
        let named = names.split(", ").map(|name| {
            sections.remove(name).unwrap_or_else(|| panic!("`{name}` is no section, or has two tables"))
        });
        written += &format!("\n{}", table(&named.collect::<Vec<_>>()));
        while lines.next_if(|line| line.is_empty() || line.starts_with('|')).is_some() {}
        written.push('\n');
    }
    assert!(sections.is_empty(), "docs/input.md has no table of {:?}", sections.keys());
    if std::env::var_os("UPDATE_DOCS").is_some() {
        fs::write(self::page(), &written).unwrap();
    }
    let differs = page.lines().zip(written.lines()).position(|(is, should)| is != should);
    assert!(
        page == written || std::env::var_os("UPDATE_DOCS").is_some(),
        "docs/input.md differs from the program in line {:?}; write its tables anew with UPDATE_DOCS=1",
        differs.map(|line| line + 1)
    );
}

#[test]
fn every_key_says_what_it_means() {
    for section in study::keys() {
        for key in section.keys {
            assert!(!key.text.is_empty() && !key.text.ends_with('.'), "{}: {}", name(section), key.name);
            assert!(
                !key.text.contains(['|', '\n']) && !key.text.contains("  "),
                "{}: {}",
                name(section),
                key.name
            );
        }
    }
}

/// What a comment calls a section: its first table, and the choice with which its keys have a meaning.
fn name(section: &Section) -> String {
    let table = section.tables.first().unwrap_or(&"root");
    if section.kind.is_empty() { (*table).to_owned() } else { format!("{table} with {}", section.kind) }
}

/// The table of some sections; where they belong to several choices, these stand in the first column.
fn table(sections: &[&Section]) -> String {
    let choices = sections.iter().any(|section| section.kind != sections[0].kind);
    let mut text = match choices {
        true => "| with | key | meaning | value | default |\n|---|---|---|---|---|\n".to_owned(),
        false => "| key | meaning | value | default |\n|---|---|---|---|\n".to_owned(),
    };
    for section in sections {
        for key in section.keys {
            if choices {
                text += &format!("| `{}` ", section.kind);
            }
            text += &row(section, key);
        }
    }
    text
}

fn row(section: &Section, key: &Key) -> String {
    let Key { name, kind, default, text, .. } = key;
    let within = if section.tables.is_empty() { "" } else { "…." };
    let name = match kind.to_string().as_str() {
        "table" => format!("[{within}{name}]"),
        "tables" => format!("[[{within}{name}]]"),
        _ => (*name).to_owned(),
    };
    format!("| `{name}` | {text} | {kind} | {default} |\n")
}

fn page() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/input.md")
}
