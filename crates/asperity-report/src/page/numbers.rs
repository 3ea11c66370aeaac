//! All numbers of a contact at rest.

use serde_json::{Map, Value};

use super::html::{escaped, number};
use super::table::text_of;

/// The numbers of a record, the most asked for first, with the texts of the record that is `shown`.
pub(super) fn of_record(
    key: &str,
    record: &Map<String, Value>,
    shown: &Map<String, Value>,
) -> Vec<(String, String)> {
    const FIRST: [&str; 6] =
        ["load", "approach", "contact_area", "apparent_area", "max_pressure", "mean_gap"];
    let rest = record.keys().map(String::as_str).filter(|name| !FIRST.contains(name));
    let mut names: Vec<&str> =
        FIRST.into_iter().filter(|name| record.contains_key(*name)).chain(rest).collect();
    names.sort_by_key(|name| unloaded(name, record).is_some());
    let load = record.get("load").and_then(Value::as_f64).unwrap_or(0.0);
    let row = |name: &str| {
        let component = |value: &Value, path: &str, scale: f64| match value.as_f64() {
            // What rounding leaves of a component that is not there is not worth reading.
            Some(small) if small.abs() < 1e-8 * scale => number(path, value, &text_of(name, 0.0)),
            Some(size) => number(path, value, &text_of(name, size)),
            None => "–".to_owned(),
        };
        let path = format!("{key}.{name}");
        let text = match &record[name] {
            Value::Array(both) => {
                let sizes = both.iter().filter_map(Value::as_f64);
                let scale =
                    sizes.map(f64::abs).fold(if name.contains("force") { load } else { 0.0 }, f64::max);
                let each = both.iter().enumerate();
                each.map(|(n, value)| component(value, &format!("{path}.{n}"), scale))
                    .collect::<Vec<_>>()
                    .join(", ")
            }
            Value::String(word) => escaped(word),
            value => match shown[name].as_f64() {
                Some(size) => number(&path, value, &text_of(name, size)),
                None => "–".to_owned(),
            },
        };
        let label =
            unloaded(name, record).map_or(name.to_owned(), |under_load| format!("unloaded: {under_load}"));
        (label.replace('_', " "), text)
    };
    names.into_iter().map(row).collect()
}

/// The name under the load of what a record has twice, where `name` is that without it.
fn unloaded<'a>(name: &'a str, record: &Map<String, Value>) -> Option<&'a str> {
    name.strip_prefix("residual_").filter(|under_load| record.contains_key(*under_load))
}
