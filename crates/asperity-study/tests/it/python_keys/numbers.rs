//! The numbers of a contact in `python/asperity/_contact.py`, made from the columns of its record.

use asperity_contact::motion::{Column, Presence, StaticRecord};

use super::{agrees, annotated};

const BEGIN: &str = "    # Made from the columns of the results: UPDATE=1 cargo test -p asperity-study\n";
const END: &str = "    # The end of what is made.\n";

/// Columns that hold a count.
const COUNTS: &[&str] = &["plastic_cells", "iterations", "jumps", "cycles", "products"];

#[test]
fn the_numbers_of_a_contact_in_python_are_those_of_its_record() {
    agrees("_contact.py", |stands| {
        let (before, rest) = stands.split_once(BEGIN).expect("the begin of the numbers");
        let (_, after) = rest.split_once(END).expect("their end");
        format!("{before}{BEGIN}{}{END}{after}", numbers())
    });
}

fn numbers() -> String {
    StaticRecord::COLUMNS.iter().map(number).collect()
}

fn number(column: &Column) -> String {
    let kind = match column.name {
        name if COUNTS.contains(&name) => "int",
        _ if !column.components.is_empty() => "list[float]",
        _ if column.unit.is_empty() => "str",
        _ => "float",
    };
    let none = if column.presence == Presence::Unknown { " | None" } else { "" };
    annotated(column.name, &format!("{kind}{none}"), &with_unit(column.text, column.unit))
}

/// A meaning with its unit: behind the first part of the sentence.
fn with_unit(text: &str, unit: &str) -> String {
    if unit.is_empty() || unit == "1" {
        return text.to_owned();
    }
    let ends = |mark: &&str| text.find(*mark).filter(|at| !text[..*at].ends_with(' '));
    let end = [": ", "; ", ". "].iter().filter_map(ends).min().unwrap_or(text.len() - 1);
    format!("{}, {unit}{}", &text[..end], &text[end..])
}
