//! The tables of docs/input.md and docs/input/ equal the declarations in the program: keys, and rules for
//! combinations.
//!
//! `UPDATE_DOCS=1 cargo test -p asperity-study --test it case_file::` rewrites them. Above each table is a
//! comment with its name: `<!-- keys: lower.wear -->`, `<!-- keys: lower.topography with file -->`,
//! `<!-- rules -->`.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use asperity_base::Error;
use asperity_base::beside::Beside;
use asperity_base::units::{Dimension, format, format_number};
use asperity_contact::lubrication::{NamedOil, OILS};
use asperity_contact::material::{MATERIALS, NamedMaterial};
use asperity_study::Case;
use asperity_study::case::rules::Exclusion;
use asperity_study::case::schema::{Exists, Key, Section};

/// Dimensions with units listed in docs/input.md.
const COMMON: [Dimension; 5] =
    [Dimension::Length, Dimension::Pressure, Dimension::Force, Dimension::Speed, Dimension::Angle];

#[test]
fn the_tables_of_the_documents_are_those_of_the_program() {
    let sections = asperity_study::keys().iter().filter(|section| section.kind != "given");
    let mut sections: BTreeMap<String, &Section> = sections.map(|section| (name(section), section)).collect();
    let pages = pages();
    let mut tables_of_rules = 0;
    for (path, page) in &pages {
        let mut lines = page.lines().peekable();
        let mut written = String::new();
        while let Some(line) = lines.next() {
            written += &format!("{line}\n");
            let table = match line.strip_prefix("<!-- ").and_then(|rest| rest.strip_suffix(" -->")) {
                Some("rules") => {
                    tables_of_rules += 1;
                    table_of_rules()
                }
                Some("materials") => table_of_materials(),
                Some("oils") => table_of_oils(),
                Some(mark) => match mark.strip_prefix("keys: ") {
                    Some(names) => {
                        let named = names.split(", ").map(|name| {
                            sections
                                .remove(name)
                                .unwrap_or_else(|| panic!("`{name}` is no section, or has two tables"))
                        });
                        table_of_keys(&named.collect::<Vec<_>>())
                    }
                    None => continue,
                },
                None => continue,
            };
            written += &format!("\n{}", with_links(&table, path, &pages));
            while lines.next_if(|line| line.is_empty() || line.starts_with('|')).is_some() {}
            if lines.peek().is_some() {
                written.push('\n');
            }
        }
        if std::env::var_os("UPDATE_DOCS").is_some() {
            fs::write(documents().join(path), &written).unwrap();
            continue;
        }
        let differs = page.lines().zip(written.lines()).find(|(is, should)| is != should);
        assert!(page == &written, "docs/{path} is not as the program has it: {differs:?}; UPDATE_DOCS=1");
    }
    assert!(sections.is_empty(), "docs/input has no table of {:?}", sections.keys());
    assert_eq!(tables_of_rules, 1, "docs/input says once what does not go together");
}

/// `docs/warnings.md` has what exists of each quantity below `<!-- ranges -->`.
#[test]
fn what_exists_of_each_quantity_is_in_the_documents() {
    let path = documents().join("warnings.md");
    let page = fs::read_to_string(&path).unwrap();
    let (before, rest) = page.split_once("<!-- ranges -->\n").expect("a mark");
    let after = rest.find("\n## ").map_or("", |at| &rest[at..]);
    let mut rows = Vec::new();
    for (section, key) in
        asperity_study::keys().iter().flat_map(|section| section.keys.iter().map(move |key| (section, key)))
    {
        let Exists::Within { least, most, of, .. } = key.exists else { continue };
        let [least, most] = [least, most].map(|value| match key.kind.dimension() {
            Some(dimension) => format(value, dimension),
            None => format_number(value),
        });
        let row = format!("| `{}.{}` | {least} … {most} | {of} |\n", body_left_out(section), key.name);
        if !rows.contains(&row) {
            rows.push(row);
        }
    }
    let table = format!("\n| key | exists | from, to |\n|---|---|---|\n{}", rows.concat());
    let written = format!("{before}<!-- ranges -->\n{table}\n{}{after}", beside());
    if std::env::var_os("UPDATE_DOCS").is_some() {
        fs::write(&path, &written).unwrap();
    } else {
        assert!(page == written, "docs/warnings.md is not as the program has it; UPDATE_DOCS=1");
    }
}

/// Returns the table of the quantities beside which values are judged.
fn beside() -> String {
    let mut rows: Vec<String> = Vec::new();
    for section in asperity_study::keys() {
        for key in section.keys.iter().filter(|key| !key.beside.is_empty()) {
            let [mut below, mut above] = [String::new(), String::new()];
            for Beside { scale, least, most, meaning } in key.beside {
                let [small, large] = scale.words();
                let times = |factor: f64| {
                    if factor == 1.0 { String::new() } else { format!("{} × ", format_number(factor)) }
                };
                if *least > 0.0 {
                    below = format!("{}{small}: {}", times(*least), meaning[0]);
                }
                if most.is_finite() {
                    above = format!("{}{large}: {}", times(*most), meaning[1]);
                }
            }
            let row = format!("| `{}.{}` | {below} | {above} |\n", body_left_out(section), key.name);
            if !rows.contains(&row) {
                rows.push(row);
            }
        }
    }
    format!(
        "These values are judged beside others of the case:\n\n| key | below | above |\n|---|---|---|\n{}",
        rows.concat()
    )
}

/// Returns the first table of a section, without the name of the body: both bodies have the same keys.
fn body_left_out(section: &Section) -> String {
    let table = section.tables.first();
    table.map_or(String::new(), |table| table.replace("lower.", "….").replace("lower", "…"))
}

#[test]
fn every_key_and_every_rule_is_explained_in_one_line() {
    for section in asperity_study::keys() {
        for key in section.keys {
            let text = key.text;
            assert!(!text.is_empty() && !text.ends_with('.'), "{}: {}", name(section), key.name);
            assert!(!text.contains(['|', '\n']) && !text.contains("  "), "{}: {}", name(section), key.name);
        }
    }
    for Exclusion { this, with, message, hint, .. } in asperity_study::rules() {
        let texts = [&this, &with, &message];
        assert!(texts.iter().all(|text| !text.is_empty() && !text.contains(['|', '\n'])), "{message}");
        assert!(!hint.contains(['|', '\n']) && !hint.contains("  "), "{message}");
    }
}

#[test]
fn every_rule_is_broken_by_its_example_and_says_so_at_its_key() {
    let mut wrong = Vec::new();
    for rule in asperity_study::rules() {
        let text = case(rule.example);
        let found = match Case::parse(&text, Path::new("case.toml"), Path::new("")) {
            Err(Error::Case(error)) => error,
            other => {
                wrong.push(format!("{} with {}: {:?}\n{text}", rule.this, rule.with, other.err()));
                continue;
            }
        };
        let key = found.key.rsplit('.').next().unwrap();
        let value = found.text[found.span.clone()].split_whitespace().collect::<Vec<_>>().join(" ");
        let message =
            rule.message.replace("{key}", key).replace("{path}", &found.key).replace("{value}", &value);
        let hint = Some(rule.hint.to_owned()).filter(|hint| !hint.is_empty());
        // A stage is identified by its array.
        let at = found.key.replace(['[', ']'], "");
        if (&found.message, &found.hint, at.as_str()) != (&message, &hint, rule.at) || found.span.is_empty() {
            wrong.push(format!("{} with {}: {}: {}\n{text}", rule.this, rule.with, found.key, found.message));
        }
    }
    assert!(wrong.is_empty(), "{} rules:\n{}", wrong.len(), wrong.join("\n"));
}

/// A ball on a plate, with the keys of an example in place of its own.
fn case(example: &[&str]) -> String {
    const BASE: [(&str, &str); 7] = [
        ("lower.young", "\"210 GPa\""),
        ("lower.poisson", "0.3"),
        ("lower.topography", "{ form = \"flat\", shape = [64, 64], pitch = \"1 um\" }"),
        ("upper.young", "\"210 GPa\""),
        ("upper.poisson", "0.3"),
        ("upper.topography", "{ form = \"sphere\", radius = \"1 mm\" }"),
        ("contact", "{ load = \"2 N\" }"),
    ];
    let given = |key: &str| example.iter().flat_map(|text| text.lines()).any(|line| line.starts_with(key));
    let base = BASE.iter().filter(|(key, _)| !given(key)).map(|(key, value)| format!("{key} = {value}"));
    base.chain(example.iter().map(|&text| text.to_owned())).collect::<Vec<_>>().join("\n")
}

/// Name of a section in comments: its first table, and the choice for which its keys apply.
fn name(section: &Section) -> String {
    let table = section.tables.first().unwrap_or(&"root");
    if section.kind.is_empty() { (*table).to_owned() } else { format!("{table} with {}", section.kind) }
}

/// Returns the table of some sections. If they belong to several choices, these are in the first column.
fn table_of_keys(sections: &[&Section]) -> String {
    let choices = sections.iter().any(|section| section.kind != sections[0].kind);
    let mut text = if choices {
        "| with | key | meaning | value | default |\n|---|---|---|---|---|\n".to_owned()
    } else {
        "| key | meaning | value | default |\n|---|---|---|---|\n".to_owned()
    };
    for section in sections {
        for Key { name, kind, default, example, text: meaning, .. } in section.keys {
            if choices {
                text += &format!("| `{}` ", section.kind);
            }
            let within = if section.tables.is_empty() { "" } else { "…." };
            let name = match kind.to_string().as_str() {
                "table" => format!("[{within}{name}]"),
                "tables" => format!("[[{within}{name}]]"),
                _ => (*name).to_owned(),
            };
            // A value that the units of the table of quantities do not cover has an example.
            let value = match kind.dimension() {
                Some(dimension) if !COMMON.contains(&dimension) => format!("{kind}, as `{example}`"),
                _ => kind.to_string(),
            };
            text += &format!("| `{name}` | {meaning} | {value} | {default} |\n");
        }
    }
    text
}

fn table_of_materials() -> String {
    let row = |material: &NamedMaterial| {
        let or_none = |value: Option<String>| value.unwrap_or_else(|| "–".to_owned());
        let quantity = |value: Option<f64>, dimension| or_none(value.map(|value| format(value, dimension)));
        let NamedMaterial { name, about, source, .. } = material;
        let [young, hardness] =
            [Some(material.young), material.hardness].map(|value| quantity(value, Dimension::Pressure));
        let conductivity = quantity(material.conductivity, Dimension::Conductivity);
        let heat_capacity = quantity(material.heat_capacity, Dimension::HeatCapacity);
        let density = quantity(material.density, Dimension::Density);
        let resistivity = quantity(material.resistivity, Dimension::Resistivity);
        let poisson = format_number(material.poisson);
        format!(
            "| `{name}` | {about} | {young} | {poisson} | {hardness} | {conductivity} | {heat_capacity} | {density} | \
             {resistivity} | {source} |\n"
        )
    };
    let heads = "| name | grade | young | poisson | hardness | conductivity | heat_capacity | density | resistivity | source |";
    let rows: String = MATERIALS.iter().map(row).collect();
    format!("{heads}\n|---|---|---|---|---|---|---|---|---|---|\n{rows}")
}

fn table_of_oils() -> String {
    let row = |oil: &NamedOil| {
        let NamedOil { name, about, source, .. } = oil;
        let [warm, hot] = oil.viscosity.map(|viscosity| format(viscosity, Dimension::Viscosity));
        let coefficient = format_number(1e9 * oil.pressure_viscosity);
        let density = format(oil.density, Dimension::Density);
        format!("| `{name}` | {about} | {warm} | {hot} | {coefficient} | {density} | {source} |\n")
    };
    let heads = "| name | grade | viscosity at 40 °C | at 100 °C | pressure–viscosity coefficient at 40 °C, 1/GPa | density at 15 °C | source |";
    let rows: String = OILS.iter().map(row).collect();
    format!("{heads}\n|---|---|---|---|---|---|---|\n{rows}")
}

fn table_of_rules() -> String {
    let row = |rule: &Exclusion| format!("| {} | {} | {} |\n", rule.this, rule.with, rule.hint);
    let rows: String = asperity_study::rules().iter().map(row).collect();
    format!("| this | does not go with | instead |\n|---|---|---|\n{rows}")
}

/// The links of a table, which are written as if all documents were one page in one folder, as the page needs
/// them.
fn with_links(table: &str, page: &str, pages: &BTreeMap<String, String>) -> String {
    let up = "../".repeat(page.matches('/').count());
    let mut text = String::new();
    for part in table.split_inclusive("](") {
        let Some(link) = text.ends_with("](").then(|| part.split(')').next().unwrap()) else {
            text += part;
            continue;
        };
        match link.strip_prefix('#') {
            _ if link.contains("://") => text += part,
            None => text += &format!("{up}{part}"),
            Some(anchor) => {
                let holds = |page: &str| page.lines().any(|line| self::anchor(line) == anchor);
                let home = pages.iter().find(|(_, text)| holds(text));
                let (home, _) = home.unwrap_or_else(|| panic!("no heading for {link}"));
                let link = if home == page { String::new() } else { format!("{up}{home}") };
                text += &format!("{link}{part}");
            }
        }
    }
    text
}

/// The anchor of a heading; nothing of other lines.
fn anchor(line: &str) -> String {
    let Some((_, title)) = line.split_once("# ").filter(|(level, _)| level.chars().all(|c| c == '#')) else {
        return String::new();
    };
    let kept = |c: &char| c.is_alphanumeric() || [' ', '-', '_'].contains(c);
    title.to_lowercase().chars().filter(kept).collect::<String>().replace(' ', "-")
}

/// The pages of the case file, by their paths within the documents.
fn pages() -> BTreeMap<String, String> {
    let names = fs::read_dir(documents().join("input")).unwrap();
    let names = names.map(|entry| format!("input/{}", entry.unwrap().file_name().into_string().unwrap()));
    let read = |name: String| (name.clone(), fs::read_to_string(documents().join(name)).unwrap());
    names.chain(["input.md".to_owned()]).map(read).collect()
}

fn documents() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs")
}
