//! Keys of each table, and hints for misplaced keys.

use super::super::cursor::Table;
use super::{Exists, Key, Section, keys};
use asperity_base::error::Result;
use asperity_base::table;
use asperity_base::units::Dimension;

/// Keys of a study file that a case file does not have.
const OF_A_STUDY: [&str; 4] = ["base", "axes", "table", "exclude"];

/// The kind of topographies and hardness maps in the memory of a program, which no file contains. Hints and
/// the JSON schema leave it out.
pub(in crate::case) const GIVEN: &str = "given";

/// Returns the dotted name under which a table is declared. A table of an array has the name of the array, a
/// layer that of its topography.
fn declared(path: &str) -> String {
    let parts = path.trim_matches(['[', ']']).split('.');
    let name =
        parts.filter(|part| part.parse::<usize>().is_err() && *part != "plus").collect::<Vec<_>>().join(".");
    if name == "topography" { "lower.topography".to_owned() } else { name }
}

/// Returns the sections of a table.
fn sections(path: &str) -> impl Iterator<Item = &'static Section> {
    let name = declared(path);
    let is_root = name.is_empty();
    keys().iter().filter(move |section| {
        if is_root { section.tables.is_empty() } else { section.tables.contains(&name.as_str()) }
    })
}

/// Returns the declarations of a dotted key of a case, or of the list of which it is an element:
/// `subsurface.planes.0`.
fn declarations(key: &str) -> impl Iterator<Item = &'static Key> {
    let mut of_list = key;
    while let Some((list, index)) = of_list.rsplit_once('.')
        && index.parse::<usize>().is_ok()
    {
        of_list = list;
    }
    let (table, name) = of_list.rsplit_once('.').unwrap_or(("", of_list));
    sections(table).flat_map(|section| section.keys).filter(move |key| key.name == name)
}

/// Returns the dimension of a dotted key of a case, for example force for `contact.load`; none for pure
/// numbers and other values.
pub fn dimension(key: &str) -> Option<Dimension> {
    declarations(key).next().and_then(|key| key.kind.dimension())
}

/// Returns the declaration of a dotted key of a case. Of several, for topographies of different forms, the
/// one that says what exists.
pub(crate) fn declaration(key: &str) -> Option<&'static Key> {
    let is_bounded = |key: &&Key| matches!(key.exists, Exists::Within { .. });
    declarations(key).find(is_bounded).or_else(|| declarations(key).next())
}

/// Whether a key stands above all tables of a case.
pub(crate) fn is_of_root(key: &str) -> bool {
    sections("").any(|section| section.has(key))
}

/// Returns an error if a key of the table is unknown for every choice.
pub(in crate::case) fn known_in(table: &Table<'_>) -> Result<()> {
    let known: Vec<&str> =
        sections(table.path()).flat_map(|section| section.keys).map(|key| key.name).collect();
    table.known(&known, |key| belongs(key, table.path()))
}

/// Returns the message and the hint for an unknown key, with the table to which it belongs.
pub(crate) fn belongs(key: &str, table: &str) -> Option<(String, Option<String>)> {
    let here = if table.is_empty() { "outside a table".to_owned() } else { format!("in [{table}]") };
    let name = declared(table);
    // A key of the same name is rarely meant in a table that stands in place of a value and names one of
    // several kinds.
    if sections(table).all(|section| !section.kind.is_empty()) {
        return None;
    }
    let elsewhere = |section: &&Section| section.has(key) && !section.tables.contains(&name.as_str());
    let hint = match keys().iter().filter(|section| !section.tables.is_empty()).find(elsewhere) {
        // A key of this name in another table is a word, and rarely meant.
        _ if key == "history" => "write stages as separate tables: [[history]]".to_owned(),
        Some(section) => {
            let body = name.split('.').next();
            let of_body = section.tables.iter().find(|owner| owner.split('.').next() == body);
            format!("`{key}` belongs in [{}]", of_body.unwrap_or(&section.tables[0]))
        }
        None if key == "title" => "put `title` above all tables".to_owned(),
        None if is_of_root(key) => format!("write it as a separate table: [{key}]"),
        None if table.is_empty() && OF_A_STUDY.contains(&key) => {
            "this is a study: `asperity study` computes it".to_owned()
        }
        None => return None,
    };
    Some((format!("unknown key '{key}' {here}"), Some(hint)))
}

/// Returns an error if a key of the table belongs to a kind other than this one: `file`, `form = "sphere"`,
/// `law = "arrhenius"`.
pub(in crate::case) fn suits(table: &Table<'_>, kind: &str) -> Result<()> {
    let is_layer = table.path().ends_with("plus]");
    let of_the_whole = |key: &str| {
        let every = sections(table.path()).filter(|section| section.kind.is_empty());
        key == "shape" || every.into_iter().any(|section| section.has(key))
    };
    let known = sections(table.path()).filter(|section| section.suits(kind)).flat_map(|section| section.keys);
    let known = known.map(|key| key.name).filter(|key| !(is_layer && of_the_whole(key)));
    table.known(&known.collect::<Vec<_>>(), |key| {
        if is_layer && of_the_whole(key) {
            let hint = "leave it out here: the addition uses the grid of the prepared topography".to_owned();
            return Some((format!("'{key}' has no meaning in {}", table.name()), Some(hint)));
        }
        let owners = sections(table.path()).filter(|section| section.has(key) && section.kind != GIVEN);
        let owners: Vec<_> = owners.map(|section| format!("`{}`", section.kind)).collect();
        let kind = match kind {
            "file" => "a file",
            GIVEN => "heights in memory",
            kind => kind,
        };
        Some((
            format!("'{key}' has no meaning with {kind}"),
            Some(format!("it belongs to {}", owners.join(", "))),
        ))
    })
}

/// Reads a table of this name, if it is given, as the struct that declares its keys.
pub(in crate::case) fn read<T: table::Table>(root: &Table<'_>, name: &str) -> Result<Option<T>> {
    let Some(table) = root.table(name)? else { return Ok(None) };
    known_in(&table)?;
    T::read(&table).map(Some)
}
