//! `python/asperity/keys.py`: the types of the tables that Python's arguments take, made from the
//! declarations of their keys.

mod errors;
mod numbers;

use std::fmt::Write as _;
use std::path::Path;

use asperity_contact::each;
use asperity_contact::with::{BodyLaw, BodyProperty, Capability};
use asperity_study::case::schema::{Fallback, Key, Kind};
use asperity_study::keys;

/// Columns of a line of Python.
const WIDTH: usize = 120;

const HEAD: &str = r#""""Types of the tables that arguments take, such as ``friction={"coefficient": 0.3}``.

Each type has the keys of a table of a case file. A type checker finds unknown keys with them. At run time a plain dictionary is
enough. A quantity is a number in SI or a text with a unit.

This file is made from the declarations of the keys of case files: ``UPDATE=1 cargo test -p asperity-study``.
"""

# Annotations are not postponed here: types and texts are read when the package is imported.

from collections.abc import Sequence
from typing import Annotated, Literal, TypedDict

from ._units import Pair, Quantity

Boundary = Literal["free", "periodic"]
"""Boundary of the grid."""
"#;

/// A class: its name, its tables, those of their keys that it has (all if none is named), and what its
/// documentation says.
type Class = (&'static str, &'static [&'static str], &'static [&'static str], &'static str);

const CLASSES: &[Class] = &[
    (
        "Friction",
        &["friction"],
        &[],
        "Keys of ``friction``.\n\nAt most one of `force`, `displacement`, `sliding`, `creepage`, `creepages` and `rolling_force` is \
         given, and only for a static contact.",
    ),
    (
        "Stage",
        &["history"],
        &[],
        "Keys of a stage of ``history``. Quantities that a stage does not name do not change.",
    ),
    (
        "Plasticity",
        &["plasticity"],
        &[],
        "Keys of ``plasticity``, for bodies with an :class:`asperity.Plasticity`.",
    ),
    ("Subsurface", &["subsurface"], &[], "Keys of ``subsurface``: the stress below the surface of one body."),
    ("Adhesion", &["adhesion"], &[], "Keys of ``adhesion``: the attraction between the bodies."),
    (
        "Acceleration",
        &["acceleration"],
        &[],
        "Keys of ``acceleration``: the extrapolation over several passes.",
    ),
    ("Temperature", &["temperature"], &[], "Keys of ``temperature``."),
    (
        "Viscoelastic",
        &["lower.viscoelastic"],
        &[],
        "Keys of ``viscoelastic`` of a body or a layer: its relaxation. Either `moduli` and `times`, or `file` is given.",
    ),
    (
        "FatigueLimits",
        &["lower.fatigue"],
        &[],
        "Keys of ``fatigue`` of a body: its limits under alternating loads.",
    ),
    (
        "Steady",
        &["steady"],
        &[],
        "Keys of ``steady``: steady sliding of viscoelastic bodies. `speed` or `speeds` is given.",
    ),
    (
        "Lubrication",
        &["lubrication"],
        &[],
        "Keys of ``lubrication``: an oil between the bodies, in a steady film. `oil` or `viscosity` is given, and `speed` or \
         `speeds`.",
    ),
    (
        "Thermal",
        &["lower"],
        &["conductivity", "heat_capacity", "density", "resistivity"],
        "Keys of ``thermal`` of a body: what it conducts.\n\nA flash temperature needs the first three.",
    ),
];

/// Keywords of a function in Python: the name of their class, its base, what its documentation says, and
/// where they come from.
type Keywords = (&'static str, &'static str, &'static str, &'static [Source]);

/// A table, and those of its keys that are keywords.
type Source = (&'static str, Which);

#[derive(Clone, Copy)]
enum Which {
    All,
    Only(&'static [&'static str]),
    But(&'static [&'static str]),
}

const SWEEPS: &[&str] = &["loads", "mean_pressures", "approaches"];

const KEYWORDS: &[Keywords] = &[
    (
        "Common",
        "Capabilities",
        "Keywords of every contact.",
        &[("contact", Which::But(SWEEPS)), ("", Which::Only(&["friction", "adhesion"]))],
    ),
    (
        "Rest",
        "TypedDict",
        "Keywords of a static contact.",
        &[
            ("contact", Which::Only(SWEEPS)),
            (
                "",
                Which::Only(&[
                    "history",
                    "steady",
                    "lubrication",
                    "acceleration",
                    "temperature",
                    "plasticity",
                    "subsurface",
                ]),
            ),
            ("output", Which::Only(&["pressure_every"])),
        ],
    ),
    (
        "Sliding",
        "TypedDict",
        "Keywords of sliding in place.",
        &[("sliding", Which::All), ("", Which::Only(&["temperature"]))],
    ),
    (
        "Motion",
        "TypedDict",
        "Keywords of a motion.",
        &[
            ("motion", Which::All),
            ("", Which::Only(&["lubrication", "acceleration", "temperature", "plasticity", "subsurface"])),
            ("output", Which::Only(&["pressure_every", "rim"])),
        ],
    ),
    (
        "Output",
        "TypedDict",
        "Keywords of the results.",
        &[("output", Which::Only(&["paraview"])), ("", Which::Only(&["title"]))],
    ),
];

#[test]
fn the_types_of_python_are_those_of_the_keys() {
    agrees("keys.py", |_| file());
}

/// Compares a file of the package with what is made of it, or writes it anew.
fn agrees(name: &str, make: impl FnOnce(&str) -> String) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../python/asperity").join(name);
    let stands = std::fs::read_to_string(&path).unwrap();
    let made = make(&stands);
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&path, &made).unwrap();
        return;
    }
    if let Some((stands, made)) = stands.lines().zip(made.lines()).find(|(stands, made)| stands != made) {
        panic!("{name} has\n{stands}\nthe declarations have\n{made}\nUPDATE=1 writes it anew");
    }
    assert_eq!(stands.len(), made.len(), "{name}: UPDATE=1 writes it anew");
}

fn file() -> String {
    let mut classes = CLASSES.to_vec();
    let mut capabilities = String::new();
    each!(capability C => {
        let name: &'static str = capitalised(C::NAME).leak();
        let tables: &'static [&'static str] = vec![C::NAME].leak();
        let about: &'static str = format!("Keys of ``{}``: {}.", C::NAME, C::MEANING).leak();
        classes.push((name, tables, &[], about));
        let keys: Vec<String> = of_class(&(name, tables, &[], about)).iter().map(|(key, _)| format!("`{}`", key.name)).collect();
        let text = format!("{}: {}.", capitalised(C::MEANING), keys.join(", "));
        let _ = writeln!(capabilities, "    {}: Annotated[{name} | None, \"\",\n        {}]", C::NAME, quoted(&text));
    });
    let mut of_body = String::new();
    each!(law L => {
        let name: &'static str = capitalised(L::NAME).leak();
        let tables: &'static [&'static str] = vec![format!("lower.{}", L::NAME).leak() as &str].leak();
        let about: &'static str = format!("Keys of ``{}`` of a body: {}.", L::NAME, without_place(L::MEANING)).leak();
        classes.push((name, tables, &[], about));
        of_body += &keyword_of_body(&classes, L::NAME, L::MEANING);
    });
    each!(property P => of_body += &keyword_of_body(&classes, P::NAME, P::MEANING));
    let mut names: Vec<&str> = classes.iter().map(|(name, ..)| *name).collect();
    names.sort_unstable();
    let names: Vec<String> = names.iter().map(|name| format!("    \"{name}\",\n")).collect();
    let mut file = format!("{HEAD}\n__all__ = [\n{}]\n", names.concat());
    for each in &classes {
        file += &class(each);
    }
    let _ = write!(
        file,
        "\n\nclass Capabilities(TypedDict, total=False):\n    \"\"\"Keywords of the capabilities.\"\"\"\n\n{capabilities}"
    );
    let _ = write!(
        file,
        "\n\nclass OfBody(TypedDict, total=False):\n    \"\"\"Keywords of a body: what contacts do to it, and how it responds.\"\"\"\n\n{of_body}"
    );
    for each in KEYWORDS {
        file += &keywords(each);
    }
    file + "\n\ndef __dir__() -> list[str]:\n    return __all__\n"
}

/// A keyword of a body: one of its tables, with the class that has its keys.
fn keyword_of_body(classes: &[Class], name: &str, meaning: &str) -> String {
    let table = format!("lower.{name}");
    let class = classes.iter().find(|(_, tables, ..)| tables.contains(&table.as_str())).expect("a class");
    let keys: Vec<String> = of_class(class).iter().map(|(key, _)| format!("`{}`", key.name)).collect();
    let text = format!("{}: {}.", capitalised(without_place(meaning)), keys.join(", "));
    format!("    {name}: Annotated[{} | None, \"\",\n        {}]\n", class.0, quoted(&text))
}

/// A meaning without the place of the documents where there is more about it.
fn without_place(meaning: &str) -> &str {
    meaning.split(", see [").next().unwrap_or(meaning)
}

/// A class with keywords, each with its type, its table and its meaning. Those that a call must have are in a
/// base class.
fn keywords((name, base, about, sources): &Keywords) -> String {
    let (mut fields, mut required) = (String::new(), String::new());
    for (table, which) in *sources {
        for section in keys().iter().filter(|section| is_of(section.tables, table)) {
            for key in section.keys.iter().filter(|key| which.has(key.name)) {
                let (kind, text) = match key.kind {
                    Kind::Table | Kind::Tables => (table_type(key), meaning_of_table(key)),
                    _ => (python_type(name, key), meaning(key, section.kind)),
                };
                let is_required = key.default == Fallback::Required;
                let (to, none) = if is_required { (&mut required, "") } else { (&mut fields, " | None") };
                let text = wrapped(&text, 0);
                let text: Vec<String> = text.lines().map(str::to_owned).collect();
                let last = text.len() - 1;
                let lines = text.iter().enumerate().map(|(index, line)| {
                    format!(
                        "        {}",
                        quoted(&if index < last { format!("{line} ") } else { line.clone() })
                    )
                });
                let lines: Vec<String> = lines.collect();
                let _ = writeln!(
                    to,
                    "    {}: Annotated[{kind}{none}, \"{table}\",\n{}]",
                    key.name,
                    lines.join("\n")
                );
            }
        }
    }
    let mut text = String::new();
    let mut base = (*base).to_owned();
    if !required.is_empty() {
        base = format!("_Required{name}");
        let _ = write!(text, "\n\nclass {base}(TypedDict):\n{required}");
    }
    let _ = write!(text, "\n\nclass {name}({base}, total=False):\n    \"\"\"{about}\"\"\"\n\n{fields}");
    text
}

/// Whether a section is that of a table; the empty name is that of the keys above all tables.
fn is_of(tables: &[&str], table: &str) -> bool {
    if table.is_empty() { tables.is_empty() } else { tables.contains(&table) }
}

impl Which {
    fn has(self, key: &str) -> bool {
        match self {
            Self::All => true,
            Self::Only(keys) => keys.contains(&key),
            Self::But(keys) => !keys.contains(&key),
        }
    }
}

/// The type of a keyword that is a table.
fn table_type(key: &Key) -> String {
    match key.name {
        "friction" => "float | Friction".to_owned(),
        "history" => "Sequence[Stage]".to_owned(),
        name => capitalised(name),
    }
}

/// The meaning of a table, with its keys.
fn meaning_of_table(key: &Key) -> String {
    let class =
        CLASSES.iter().find(|(_, tables, ..)| tables.contains(&key.name)).expect("a class for each table");
    let names: Vec<String> = of_class(class).iter().map(|(key, _)| format!("`{}`", key.name)).collect();
    let number = if key.name == "friction" { "; a number is its coefficient" } else { "" };
    format!("{}: {}{number}.", capitalised(&plain(key.text)), names.join(", "))
}

/// The keys of a class, each with the choice that gives it a meaning.
fn of_class((_, tables, only, _): &Class) -> Vec<(&'static Key, &'static str)> {
    let mut found: Vec<(&Key, &str)> = Vec::new();
    for section in keys().iter().filter(|section| section.tables.iter().any(|table| tables.contains(table))) {
        for key in section.keys {
            let is_asked = only.is_empty() || only.contains(&key.name);
            if is_asked && found.iter().all(|(known, _)| known.name != key.name) {
                found.push((key, section.kind));
            }
        }
    }
    found
}

fn class(class: &Class) -> String {
    let (name, .., about) = class;
    let mut keys = of_class(class);
    let is_required = |(key, kind): &&(&Key, &str)| key.default == Fallback::Required && kind.is_empty();
    keys.sort_by_key(|each| !is_required(&each));
    let required: Vec<_> = keys.iter().filter(is_required).collect();
    let base = if required.is_empty() { "TypedDict".to_owned() } else { format!("_Required{name}") };
    let field = |(key, _): &(&Key, &str)| format!("    {}: {}\n", key.name, python_type(name, key));
    let mut text = String::new();
    if !required.is_empty() {
        let fields: String = required.iter().map(|each| field(each)).collect();
        let _ = write!(text, "\n\nclass {base}(TypedDict):\n{fields}");
    }
    let _ = write!(
        text,
        "\n\nclass {name}({base}, total=False):\n    \"\"\"{}\n\n",
        wrapped(about, 4).trim_start()
    );
    text += "    Attributes\n    ----------\n";
    for (key, kind) in &keys {
        let _ = writeln!(text, "    {} : {}", key.name, in_words(&python_type(name, key)));
        text += &wrapped(&meaning(key, kind), 8);
        text.push('\n');
    }
    text += "    \"\"\"\n\n";
    for each in keys.iter().filter(|each| !is_required(each)) {
        text += &field(each);
    }
    text
}

/// An attribute of a class with its type and its meaning.
fn annotated(name: &str, kind: &str, text: &str) -> String {
    let line = format!("    {name}: Annotated[{kind}, {}]\n", quoted(text));
    if line.chars().count() <= WIDTH {
        return line;
    }
    let text = wrapped(text, 0).replace('\n', " \n");
    let lines: Vec<String> = text.lines().map(|line| format!("        {}", quoted(line))).collect();
    format!("    {name}: Annotated[{kind},\n{}]\n", lines.join("\n"))
}

/// The type of the values of a key.
fn python_type(class: &str, key: &Key) -> String {
    match (class, key.name) {
        ("Friction", "creepages") => return "Sequence[float | Sequence[float]]".to_owned(),
        ("Friction" | "Stage", "sliding") => return "Sequence[float]".to_owned(),
        ("Subsurface", "planes") => return "Sequence[Quantity]".to_owned(),
        ("Subsurface", "columns") => return "Sequence[Sequence[Quantity]]".to_owned(),
        ("Viscoelastic", "moduli" | "times") | ("Steady", "speeds") => {
            return "Sequence[Quantity]".to_owned();
        }
        ("Viscoelastic", "file") => return "str".to_owned(),
        ("Fatigue", "passes") | ("Joint", "patches") => return "Sequence[int]".to_owned(),
        ("Joint", "files") => return "Sequence[str]".to_owned(),
        ("Temperature", "bulk") => return "Pair".to_owned(),
        ("Rest", "loads" | "mean_pressures" | "approaches") => return "Sequence[Quantity]".to_owned(),
        ("Common", "boundary") => return "Boundary | Sequence[Boundary]".to_owned(),
        ("Motion", "offset_y") => return "int | Literal[\"random\"]".to_owned(),
        _ => {}
    }
    let of_number = |kind: &Kind| if matches!(kind, Kind::Number(..)) { "float" } else { "Quantity" };
    match key.kind {
        Kind::Quantity(..) | Kind::Other { .. } => "Quantity".to_owned(),
        Kind::Number(..) => "float".to_owned(),
        Kind::Count { .. } => "int".to_owned(),
        Kind::Flag => "bool".to_owned(),
        Kind::Text => "str".to_owned(),
        Kind::Choice(words) => {
            format!(
                "Literal[{}]",
                words.iter().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(", ")
            )
        }
        Kind::Pair(item) | Kind::Vector(item) => match of_number(item) {
            "float" => "float | Sequence[float]".to_owned(),
            _ => "Pair".to_owned(),
        },
        Kind::Table | Kind::Tables => panic!("{class}: '{}' is a table", key.name),
    }
}

/// A type in a docstring.
fn in_words(of: &str) -> String {
    match of {
        "Quantity" => "float or str".to_owned(),
        "Pair" => "float, str or pair of them".to_owned(),
        "float | Sequence[float]" => "float or pair of float".to_owned(),
        "Sequence[float]" => "pair of float".to_owned(),
        "Sequence[Quantity]" => "sequence of float or str".to_owned(),
        "Sequence[Sequence[Quantity]]" => "sequence of pairs of float or str".to_owned(),
        of if of.starts_with("Sequence") => "sequence".to_owned(),
        of => match of.strip_prefix("Literal[") {
            Some(words) => format!("{{{}}}", words.trim_end_matches(']')),
            None => of.to_owned(),
        },
    }
}

/// The meaning of a key, what it accepts, and what holds without it.
fn meaning(key: &Key, kind: &str) -> String {
    let mut text = String::new();
    if !kind.is_empty() {
        let _ = write!(text, "With `{kind}`: ");
    }
    text += &plain(key.text);
    if !matches!(key.kind, Kind::Choice(_) | Kind::Flag | Kind::Text) {
        let _ = write!(text, "; {}", plain(&key.kind.to_string()));
    }
    text = capitalised(&text) + ".";
    match key.default {
        Fallback::Required if kind.is_empty() => text += " Required.",
        Fallback::Required => {}
        Fallback::Value(value) => {
            let _ = write!(text, " By default `{value}`.");
        }
        Fallback::Absent(words) => {
            let _ = write!(text, " Without it: {}.", plain(words));
        }
    }
    text
}

/// A text without the links of Markdown.
fn plain(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some((before, link)) = rest.split_once('[') {
        plain += before;
        match link.split_once("](").and_then(|(name, target)| Some((name, target.split_once(')')?.1))) {
            Some((name, after)) if !name.contains(']') => {
                plain += name;
                rest = after;
            }
            _ => {
                plain.push('[');
                rest = link;
            }
        }
    }
    plain + rest
}

fn capitalised(text: &str) -> String {
    let mut characters = text.chars();
    // A symbol of physics keeps its letter.
    let first = characters.next().map(|first| first.to_ascii_uppercase().to_string());
    first.unwrap_or_default() + characters.as_str()
}

/// A text as a literal of Python.
fn quoted(text: &str) -> String {
    format!("{text:?}")
}

/// Paragraphs in lines of the width of Python, indented.
fn wrapped(text: &str, indent: usize) -> String {
    let paragraph = |paragraph: &str| {
        let (mut lines, mut line) = (Vec::new(), " ".repeat(indent));
        for word in paragraph.split(' ') {
            let is_first = line.trim().is_empty();
            if !is_first && line.chars().count() + 1 + word.chars().count() > WIDTH {
                lines.push(std::mem::replace(&mut line, " ".repeat(indent)));
            } else if !is_first {
                line.push(' ');
            }
            line += word;
        }
        lines.push(line);
        lines.join("\n")
    };
    text.split("\n\n").map(paragraph).collect::<Vec<_>>().join("\n\n")
}
