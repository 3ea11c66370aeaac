//! Cases that are a ball on a plane but for some keys.

use std::fs;
use std::path::{Path, PathBuf};

use toml::{Table, Value};

/// The ball, and what the cases have in place of its keys.
const BALL: &str = include_str!("../inputs/good/ball.toml");

/// Returns a ball on a plane.
pub(crate) fn ball() -> Table {
    BALL.parse::<Table>().unwrap().remove("ball").unwrap().try_into().unwrap()
}

/// Returns the good cases, each with its path: the files of `tests/inputs/good`, and in place of `ball.toml`
/// its cases.
pub(crate) fn good_cases() -> Vec<(PathBuf, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good");
    let mut cases = Vec::new();
    for (name, keys) in BALL.parse::<Table>().unwrap().into_iter().filter(|(name, _)| name != "ball") {
        let case = completed(keys.try_into().unwrap(), &ball());
        cases.push((folder.join(name).with_extension("toml"), toml::to_string(&case).unwrap()));
    }
    let files = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
    let files = files.filter(|path| !path.ends_with("ball.toml"));
    cases.extend(files.map(|path| (path.clone(), fs::read_to_string(path).unwrap())));
    cases.sort();
    cases
}

/// Adds what the keys of a case lack of a whole `case`. A topography and a load stay as they are.
pub(crate) fn completed(mut keys: Table, case: &Table) -> Table {
    const LOADS: [&str; 5] = ["mean_pressure", "approach", "loads", "mean_pressures", "approaches"];
    for (key, value) in case {
        let all = match (keys.remove(key), value) {
            (Some(Value::Table(part)), Value::Table(all)) if key != "topography" => {
                completed(part, all).into()
            }
            (Some(part), _) => part,
            (None, _) if key == "load" && LOADS.iter().any(|load| keys.contains_key(*load)) => continue,
            (None, value) => value.clone(),
        };
        keys.insert(key.clone(), all);
    }
    keys
}
