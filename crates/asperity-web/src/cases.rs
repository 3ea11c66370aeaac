//! Cases to start from, and cases as tables.

#[path = "../../asperity-cli/src/example/kits.rs"]
mod kits;

use asperity_contact::material::MATERIALS;
use serde_json::{Map, Value, json};

use crate::{Failure, Result, files};
use kits::{ExampleFiles, KITS};

/// Lists the examples.
pub fn examples() -> Value {
    let example = |ExampleFiles { name, about, files }: &ExampleFiles| {
        let files: Vec<&str> = files.iter().map(|(file, _)| *file).collect();
        json!({ "name": name, "about": about, "files": files })
    };
    KITS.iter().map(example).collect()
}

/// Writes the files of an example into the folder of its name. Returns the name of its case file.
pub fn example(name: &str) -> Result<String> {
    let kit = KITS.iter().find(|kit| kit.name == name);
    let kit = kit.ok_or_else(|| Failure::input(format!("no example `{name}`")))?;
    for (file, content) in kit.files {
        files::put(&format!("{name}/{file}"), content)?;
    }
    Ok(format!("{name}/case.toml"))
}

/// Lists the materials that are known by name.
pub fn materials() -> Value {
    json!(MATERIALS)
}

/// Text of an infinite number.
const INFINITE: &str = "inf";

/// Reads a text of TOML as tables.
pub fn read_case(text: &str) -> Result<Value> {
    let table: toml::Table = toml::from_str(text).map_err(|error| Failure::of_toml(text, &error))?;
    Ok(json_of(toml::Value::Table(table)))
}

fn json_of(value: toml::Value) -> Value {
    match value {
        toml::Value::Float(number) if number == f64::INFINITY => INFINITE.into(),
        toml::Value::Float(number) => number.into(),
        toml::Value::Integer(number) => number.into(),
        toml::Value::Boolean(flag) => flag.into(),
        toml::Value::String(text) => text.into(),
        toml::Value::Datetime(date) => date.to_string().into(),
        toml::Value::Array(items) => items.into_iter().map(json_of).collect(),
        toml::Value::Table(table) => {
            table.into_iter().map(|(key, value)| (key, json_of(value))).collect::<Map<_, _>>().into()
        }
    }
}

/// Writes tables as a text of TOML.
pub fn write_case(tables: &str) -> Result<String> {
    let tables = serde_json::from_str(tables).map_err(|error| Failure::input(error.to_string()))?;
    let tables = toml_of(tables).unwrap_or(toml::Value::Boolean(false));
    toml::to_string(&tables).map_err(|error| Failure::input(error.to_string()))
}

/// Converts a value; nothing becomes of `null`, which TOML does not have.
fn toml_of(value: Value) -> Option<toml::Value> {
    Some(match value {
        Value::Null => return None,
        Value::String(text) if text == INFINITE => toml::Value::Float(f64::INFINITY),
        Value::String(text) => text.into(),
        Value::Bool(flag) => flag.into(),
        Value::Number(number) => match number.as_i64() {
            Some(number) => number.into(),
            None => number.as_f64()?.into(),
        },
        Value::Array(items) => items.into_iter().filter_map(toml_of).collect::<Vec<_>>().into(),
        Value::Object(table) => {
            let entries = table.into_iter().filter_map(|(key, value)| Some((key, toml_of(value)?)));
            toml::Value::Table(entries.collect())
        }
    })
}

/// Lines that compute the case file of this name elsewhere, on a command line and in Python.
pub fn commands(case: &str) -> Value {
    let file = case.rsplit('/').next().unwrap_or(case);
    let text = toml::Value::from(file).to_string();
    json!({
        "shell": format!("asperity run {text}"),
        "python": format!("import asperity\n\nresults = asperity.run({text}, \"results\")\nprint(results.summary)"),
    })
}
