//! The base case of a study, into which the values of each case are inserted under their keys.

use std::path::{Component, Path, PathBuf};

use toml::Value;

use super::axis::Axis;
use super::named_file::NamedFile;
use crate::case::Device;
use crate::case::document::{Document, join};
use crate::io::{fs, sha256};
use asperity_base::choice::Choice;
use asperity_base::error::{CaseError, Error, Result};

/// The base case.
#[derive(Debug)]
pub(super) struct Base {
    /// Its keys, with files relative to the working directory of the program.
    table: toml::Table,
    /// Its text, with the places of its keys.
    pub(super) document: Document,
    /// Prefix of its keys in the document: `base` if it is part of the study file.
    prefix: &'static str,
    /// Folder of the files named on the axes.
    folder: PathBuf,
}

impl Base {
    /// Creates a base from the folders of its files and of those named on the axes.
    pub(super) fn new(
        mut table: toml::Table,
        [of_base, of_axes]: [&Path; 2],
        document: Document,
        prefix: &'static str,
    ) -> Self {
        each_file(&mut table, &|path| of_base.join(path));
        Self { table, document, prefix, folder: of_axes.to_owned() }
    }

    /// Sets what solves the contacts.
    pub(super) fn on(&mut self, device: Device) -> Result<()> {
        let value = Value::String(device.word().to_owned());
        set(&mut self.table, "contact.device", value)
            .map_err(|message| self.document.error_at("contact", message, None))
    }

    /// Returns the digest of the part shared by all cases, independent of the working directory.
    pub(super) fn digest(&self) -> String {
        let mut table = self.table.clone();
        table.remove("title");
        each_file(&mut table, &|path| path.file_name().map(PathBuf::from).unwrap_or_default());
        sha256(table.to_string().as_bytes())
    }

    /// Returns the text of a case with these values. `folder` is its future place; without one, files are
    /// relative to the working directory.
    ///
    /// # Errors
    /// The number of a value that cannot be inserted, and the reason.
    pub(super) fn with<'v>(
        &self,
        title: &str,
        values: impl Iterator<Item = (&'v Axis, &'v Value)>,
        folder: Option<&Path>,
    ) -> std::result::Result<String, (usize, String)> {
        let mut table = self.table.clone();
        table.insert("title".to_owned(), Value::String(title.to_owned()));
        for (n, (axis, value)) in values.enumerate() {
            let mut value = value.clone();
            let last = axis.key().rsplit('.').next().unwrap_or_default();
            each_file_of(last, &mut value, &|path| self.folder.join(path));
            set(&mut table, axis.key(), value).map_err(|message| (n, message))?;
        }
        if let Some(folder) = folder {
            each_file(&mut table, &|path| relative(folder, path));
        }
        Ok(table.to_string())
    }

    /// Locates an error of a case in this base.
    pub(super) fn error(&self, error: &CaseError) -> Error {
        let key = match (self.prefix, error.key.as_str()) {
            ("", key) => key.to_owned(),
            (prefix, "") => prefix.to_owned(),
            (prefix, key) => join(prefix, key),
        };
        self.document.error_at(&key, error.message.clone(), error.hint.clone())
    }

    /// Returns the files named in the base.
    pub(super) fn files(&self) -> Vec<NamedFile> {
        let mut files = Vec::new();
        for (key, value) in &self.table {
            find_files(key, value, &mut |key, path| {
                files.push(NamedFile { key, value: None, path: PathBuf::from(path) });
            });
        }
        files
    }

    /// Returns the files named by a value of an axis.
    pub(super) fn files_of(&self, axis: &Axis, value: &Value) -> Vec<NamedFile> {
        let mut files = Vec::new();
        find_files(axis.key(), value, &mut |key, path| {
            files.push(NamedFile { key, value: Some(path.to_owned()), path: self.folder.join(path) });
        });
        files
    }

    /// Whether the base has this dotted key.
    pub(super) fn has(&self, key: &str) -> bool {
        let mut parts = key.split('.');
        let first = parts.next().and_then(|key| self.table.get(key));
        parts.fold(first, |value, key| inner(value?, key)).is_some()
    }
}

fn inner<'v>(value: &'v Value, key: &str) -> Option<&'v Value> {
    match value {
        Value::Table(table) => table.get(key),
        Value::Array(items) => items.get(key.parse::<usize>().ok()?),
        _ => None,
    }
}

/// Inserts a value under a dotted key, through tables, which are created if missing, and lists:
/// `history.0.load`, `subsurface.planes.0`.
fn set(table: &mut toml::Table, key: &str, value: Value) -> std::result::Result<(), String> {
    let (first, rest) = key.split_once('.').map_or((key, None), |(first, rest)| (first, Some(rest)));
    let Some(rest) = rest else {
        table.insert(first.to_owned(), value);
        return Ok(());
    };
    set_within(table.entry(first).or_insert_with(|| Value::Table(toml::Table::new())), first, rest, value)
}

/// Inserts a value under a dotted key within the value of the key `name`.
fn set_within(within: &mut Value, name: &str, key: &str, value: Value) -> std::result::Result<(), String> {
    let items = match within {
        Value::Table(inner) => return set(inner, key, value),
        Value::Array(items) => items,
        _ => return Err(format!("'{name}' in the base is no table and no list, so that nothing lies in it")),
    };
    let (index, rest) = key.split_once('.').map_or((key, None), |(index, rest)| (index, Some(rest)));
    let (count, last) = (items.len(), items.len().saturating_sub(1));
    let item = index.parse::<usize>().ok().and_then(|index| items.get_mut(index));
    match (item, rest) {
        (Some(item), Some(rest)) => set_within(item, &format!("{name}.{index}"), rest, value),
        (Some(item), None) if item.is_table() == value.is_table() => {
            *item = value;
            Ok(())
        }
        (Some(_), None) => {
            Err(format!("'{name}.{index}' in the base is a table, expected a key of it: '{name}.{index}.…'"))
        }
        (None, _) => {
            Err(format!("'{name}' in the base is a list of {count}, expected '{name}.0' to '{name}.{last}'"))
        }
    }
}

/// Finds each path of a file in the value of a dotted key, with the key that names it.
fn find_files(key: &str, value: &Value, found: &mut dyn FnMut(String, &str)) {
    match value {
        Value::String(path) if key.rsplit('.').next() == Some("file") => found(key.to_owned(), path),
        Value::Table(inner) => {
            inner.iter().for_each(|(name, value)| find_files(&join(key, name), value, found))
        }
        Value::Array(items) => {
            items
                .iter()
                .enumerate()
                .for_each(|(n, item)| find_files(&join(key, &n.to_string()), item, found));
        }
        _ => {}
    }
}

/// Changes each path of a file named in a case.
fn each_file(table: &mut toml::Table, change: &dyn Fn(&Path) -> PathBuf) {
    table.iter_mut().for_each(|(key, value)| each_file_of(key, value, change));
}

/// Changes each path of a file in the value of a key.
fn each_file_of(key: &str, value: &mut Value, change: &dyn Fn(&Path) -> PathBuf) {
    match value {
        Value::String(path) if key == "file" => {
            *path = change(Path::new(path.as_str())).to_string_lossy().into_owned();
        }
        Value::Table(inner) => each_file(inner, change),
        Value::Array(items) => {
            items.iter_mut().filter_map(Value::as_table_mut).for_each(|inner| each_file(inner, change));
        }
        _ => {}
    }
}

/// Returns the path of `file` relative to the existing `folder`; absolute if there is no relative path.
fn relative(folder: &Path, file: &Path) -> PathBuf {
    let absolute = |path: &Path| fs::absolute(path).unwrap_or_else(|_| path.to_owned());
    let real = |path: &Path| fs::canonicalize(path).unwrap_or_else(|_| absolute(path));
    let from = real(folder);
    // The file name is kept, even if it is a link.
    let file = absolute(file);
    let to = match (file.parent(), file.file_name()) {
        (Some(parent), Some(name)) => real(parent).join(name),
        _ => file,
    };
    let common = from.components().zip(to.components()).take_while(|(a, b)| a == b).count();
    if common == 0 {
        return to;
    }
    let up = from.components().skip(common).map(|_| Component::ParentDir);
    up.chain(to.components().skip(common)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_find_their_place_and_files_are_seen_from_the_case() {
        let text = "[lower]\ntopography = { file = \"a.npy\" }\nmoduli = [1, 1]\ncurve = [[0, 1], [1, 1]]\n[[history]]\nload = 1\n";
        let base = Base::new(
            toml::from_str(text).unwrap(),
            ["there", "here"].map(Path::new),
            Document::default(),
            "",
        );
        let mut table = base.table.clone();
        set(&mut table, "history.0.load", Value::Integer(2)).unwrap();
        set(&mut table, "friction.coefficient", Value::Float(0.1)).unwrap();
        assert_eq!(table["history"][0]["load"].as_integer(), Some(2));
        assert_eq!(table["friction"]["coefficient"].as_float(), Some(0.1));
        set(&mut table, "lower.moduli.1", Value::Integer(2)).unwrap();
        set(&mut table, "lower.curve.1.0", Value::Integer(2)).unwrap();
        assert_eq!(table["lower"]["moduli"].to_string(), "[1, 2]");
        assert_eq!(table["lower"]["curve"].to_string(), "[[0, 1], [2, 1]]");
        let refused = |table: &mut toml::Table, key| set(table, key, Value::Integer(2)).unwrap_err();
        assert_eq!(
            refused(&mut table, "history.1.load"),
            "'history' in the base is a list of 1, expected 'history.0' to 'history.0'"
        );
        assert_eq!(
            refused(&mut table, "history.0"),
            "'history.0' in the base is a table, expected a key of it: 'history.0.…'"
        );
        assert_eq!(
            refused(&mut table, "lower.moduli.first"),
            "'moduli' in the base is a list of 2, expected 'moduli.0' to 'moduli.1'"
        );
        assert_eq!(
            refused(&mut table, "lower.moduli.0.x"),
            "'moduli.0' in the base is no table and no list, so that nothing lies in it"
        );
        assert!(set(&mut table, "lower.topography.file.name", Value::Integer(2)).is_err());
        assert!(base.has("lower.topography.file") && base.has("history.0") && !base.has("history.1"));

        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir_all(folder.path().join("study/cases/0001")).unwrap();
        let from = folder.path().join("study/cases/0001");
        let file = folder.path().join("data/a.npy");
        std::fs::create_dir(folder.path().join("data")).unwrap();
        std::fs::write(&file, "").unwrap();
        let seen = relative(&from, &file);
        assert_eq!(seen, Path::new("../../../data/a.npy"));
        assert_eq!(from.join(seen).canonicalize().unwrap(), file.canonicalize().unwrap());
    }
}
