//! The JSON schema of a case file, by which editors complete and check its keys.

use serde_json::{Map, Value, json};

use super::schema::tables::GIVEN;
use super::schema::{Bounds, Fallback, Key, Kind, Section, keys};

/// The table that a topography may contain, a topography again.
const LAYERS: &str = "plus";

/// The tables of the bodies, whose elastic constants a material may give.
const BODIES: [&str; 2] = ["lower", "upper"];

/// Returns the JSON schema (draft 7) of a case file. It has each key with its meaning, accepted values,
/// default and example. Combinations of keys are left to [`Case::parse`](super::Case::parse).
///
/// ```
/// let schema = asperity_study::json_schema();
/// assert_eq!(schema["properties"]["contact"]["properties"]["method"]["default"], "auto");
/// ```
pub fn json_schema() -> Value {
    let mut schema = table("");
    schema["$schema"] = "http://json-schema.org/draft-07/schema#".into();
    schema["title"] = "asperity case".into();
    schema
}

/// Returns the sections of a table, given by its dotted name.
fn sections(table: &str) -> impl Iterator<Item = &'static Section> {
    keys().iter().filter(move |section| match table {
        "" => section.tables.is_empty(),
        _ => section.tables.contains(&table) && section.kind != GIVEN,
    })
}

/// Returns the schema of a table.
fn table(path: &str) -> Value {
    let mut properties = Map::new();
    let mut required = Vec::new();
    let has_one_kind = sections(path).count() == 1;
    for section in sections(path) {
        for key in section.keys {
            let value = property(path, key);
            match properties.get_mut(key.name) {
                None => {
                    properties.insert(key.name.to_owned(), value);
                }
                // The same name with another choice.
                Some(known) => add_alternative(known, value),
            }
            if (section.kind.is_empty() || has_one_kind) && key.default == Fallback::Required {
                required.push(key.name);
            }
        }
    }
    let mut schema = json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false });
    if BODIES.contains(&path) {
        schema["anyOf"] = json!([
            { "required": ["material"] },
            { "required": ["young", "poisson"] },
            { "required": ["base"], "properties": { "base": { "const": "rigid" } } }
        ]);
    }
    schema
}

/// Adds another schema for the values of a key, unless it is known.
fn add_alternative(known: &mut Value, other: Value) {
    if *known == other {
        return;
    }
    match known.get_mut("anyOf").filter(|alternatives| alternatives[0].get("description").is_some()) {
        Some(alternatives) => {
            let alternatives = alternatives.as_array_mut().expect("a list");
            if !alternatives.contains(&other) {
                alternatives.push(other);
            }
        }
        None => *known = json!({ "anyOf": [known.take(), other] }),
    }
}

/// Returns the schema of a key of a table, with its documentation.
fn property(path: &str, key: &Key) -> Value {
    let name = if path.is_empty() { key.name.to_owned() } else { format!("{path}.{}", key.name) };
    let mut schema = values(&key.kind, &name);
    // A table in place of a value, such as a range in place of a list.
    let is_table = matches!(key.kind, Kind::Table | Kind::Tables);
    if !is_table && sections(&name).next().is_some() {
        schema = json!({ "anyOf": [schema, table(&name)] });
    }
    let mut description = key.text.to_owned();
    if !matches!(key.kind, Kind::Table | Kind::Tables | Kind::Flag | Kind::Text | Kind::Choice(_)) {
        description += &format!(" ({})", key.kind);
    }
    match key.default {
        Fallback::Required => {}
        Fallback::Value(text) => {
            if let Some(value) = of_text(text) {
                schema["default"] = value;
            }
        }
        Fallback::Absent(text) => description += &format!("; without it: {text}"),
    }
    schema["description"] = description.into();
    if let Some(example) = of_text(key.example) {
        schema["examples"] = json!([example]);
    }
    schema
}

/// Returns the schema of the values of a kind, of the key with this dotted name.
fn values(kind: &Kind, name: &str) -> Value {
    match kind {
        Kind::Quantity(_, bounds) => json!({ "anyOf": [number(bounds), { "type": "string" }] }),
        // Infinity may be a text.
        Kind::Number(_, bounds @ (Bounds::FromZeroOrInfinite(_) | Bounds::AboveZeroOrInfinite(_))) => {
            json!({ "anyOf": [number(bounds), { "const": "inf" }] })
        }
        Kind::Number(_, bounds) => number(bounds),
        Kind::Count { least, most: u64::MAX } => json!({ "type": "integer", "minimum": least }),
        Kind::Count { least, most } => json!({ "type": "integer", "minimum": least, "maximum": most }),
        Kind::Choice(words) => json!({ "enum": words }),
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Text => json!({ "type": "string" }),
        Kind::Table => table(name),
        Kind::Tables => json!({ "type": "array", "items": of_item(name) }),
        Kind::Pair(item) | Kind::Vector(item) => {
            let item = values(item, name);
            json!({ "anyOf": [item, { "type": "array", "items": item, "minItems": 2, "maxItems": 2 }] })
        }
        Kind::Other { .. } => json!({ "type": ["number", "string", "boolean", "array"] }),
    }
}

/// Returns the schema of a table of an array.
fn of_item(name: &str) -> Value {
    match name.strip_suffix(&format!(".{LAYERS}")) {
        // A layer is a topography without layers.
        Some(topography) => {
            let mut layer = json!({ "type": "object", "properties": {}, "additionalProperties": false });
            let keys = sections(topography).flat_map(|section| section.keys);
            for key in keys.filter(|key| key.name != LAYERS) {
                let value = property(topography, key);
                match layer["properties"].get_mut(key.name) {
                    None => layer["properties"][key.name] = value,
                    Some(known) => add_alternative(known, value),
                }
            }
            layer
        }
        None => table(name),
    }
}

/// Returns the schema of numbers within bounds.
fn number(bounds: &Bounds) -> Value {
    match *bounds {
        Bounds::Any | Bounds::Within(..) => json!({ "type": "number" }),
        Bounds::FromZero | Bounds::FromZeroOrInfinite(_) => json!({ "type": "number", "minimum": 0 }),
        Bounds::AboveZero | Bounds::AboveZeroOrInfinite(_) => {
            json!({ "type": "number", "exclusiveMinimum": 0 })
        }
        Bounds::Between { least, most, open: [from, to] } => json!({
            "type": "number",
            if from { "exclusiveMinimum" } else { "minimum" }: least,
            if to { "exclusiveMaximum" } else { "maximum" }: most,
        }),
    }
}

/// Returns the value of a text in a declaration; `None` for infinity, which JSON does not have, and for an
/// empty text.
fn of_text(text: &str) -> Option<Value> {
    let mut table: toml::Table = format!("value = {text}").parse().ok()?;
    let value = table.remove("value")?;
    let is_finite = value.as_float().is_none_or(f64::is_finite);
    is_finite.then(|| serde_json::to_value(value).ok()).flatten()
}
