//! Identity of a run: its case, the digests of its surface files, and one digest shared by its files.

use std::path::Path;

use serde_json::{Value, json};

use super::case::{Case, Source};
use super::prepare::{Bodies, Origin};
use crate::io::sha256;
use asperity_base::error::{Error, Result};
use asperity_base::grid::Grid;

/// Names of the bodies in a case.
const BODIES: [&str; 2] = ["lower", "upper"];

/// Returns pointers to the tables of a resolved case that may name a file, surfaces first.
fn files(case: &Value) -> Vec<String> {
    let of_bodies =
        ["topography", "hardness"].into_iter().flat_map(|key| BODIES.map(|body| format!("/{body}/{key}")));
    of_bodies
        .chain(BODIES.iter().flat_map(|body| parts(case, body)).map(|part| format!("{part}/viscoelastic")))
        .collect()
}

/// Returns pointers to the tables of the layers of a body from the surface down, and to that of the body.
fn parts(case: &Value, body: &str) -> Vec<String> {
    let table = |key: &str| case.pointer(&format!("/{body}/{key}"));
    let layers = table("layers").and_then(Value::as_array).map_or(0, Vec::len);
    let coating = table("coating").map(|_| format!("/{body}/coating"));
    coating
        .into_iter()
        .chain((0..layers).map(|n| format!("/{body}/layers/{n}")))
        .chain([format!("/{body}")])
        .collect()
}

/// Returns the content of `case.json`. The case is resolved to SI, a shape or pitch taken from the other body
/// is filled in, and the SHA-256 of each file stands beside its name. `identity` is the digest of everything
/// that determines the numbers.
pub fn resolved(case: &Case, bodies: &Bodies) -> Value {
    let Bodies { lower, upper, master_curves } = bodies;
    let data = [(lower, &master_curves[0]), (upper, &master_curves[1])].map(|(body, curves)| BodyData {
        grid: *body.topography.grid(),
        origin: body.origin.as_ref(),
        hardness_sha256: body.hardness_sha256.as_ref(),
        master_sha256: curves.iter().map(|curve| curve.as_ref().map(|curve| &curve.sha256)).collect(),
    });
    resolved_of(case, data)
}

/// Data of a body that its case does not contain.
pub struct BodyData<'a> {
    /// The grid of the whole surface.
    pub grid: Grid,
    /// The file that it was read from.
    pub origin: Option<&'a Origin>,
    /// The SHA-256 of the file of its hardness.
    pub hardness_sha256: Option<&'a String>,
    /// The SHA-256 of the file of the master curve of each of its layers, from the surface down, and of the body below them.
    pub master_sha256: Vec<Option<&'a String>>,
}

/// [`resolved`] for bodies given only by these data.
pub fn resolved_of(case: &Case, bodies: [BodyData<'_>; 2]) -> Value {
    let mut resolved = serde_json::to_value(case).expect("a case can be written as JSON");
    let specs = [&case.lower.topography, &case.upper.topography];
    let grids = [&bodies[0], &bodies[1]].map(|body| body.grid);
    for (n, body) in bodies.iter().enumerate() {
        let (name, spec, other) = (BODIES[n], specs[n], grids[1 - n]);
        let topography =
            resolved.pointer_mut(&format!("/{name}/topography")).expect("a body has a topography");
        for lacking in spec.lacks() {
            topography[lacking] = if lacking == "shape" { json!(other.shape) } else { json!(other.pitch) };
        }
        let digest = body.origin.map(|origin| origin.sha256.clone());
        if let (Source::File { .. } | Source::Given { .. }, Some(digest)) = (&spec.source, digest) {
            topography["sha256"] = digest.into();
        }
        if let (Some(digest), Some(map)) =
            (body.hardness_sha256, resolved.pointer_mut(&format!("/{name}/hardness")))
        {
            map["sha256"] = digest.clone().into();
        }
        for (part, digest) in parts(&resolved, name).iter().zip(&body.master_sha256) {
            if let (Some(digest), Some(table)) =
                (digest, resolved.pointer_mut(&format!("{part}/viscoelastic")))
            {
                table["sha256"] = (*digest).clone().into();
            }
        }
    }
    resolved["identity"] = identity_of(&resolved).into();
    resolved
}

/// Returns the digest in all files of a run. Runs with equal results have the same digest, so that their
/// files are interchangeable.
pub fn identity_of(case: &Value) -> String {
    sha256(&serde_json::to_vec(&deciding(case)).expect("a JSON value can be written"))
}

/// Returns an error unless the results in `directory`, whose case is `before`, are also those of the case
/// `now`.
pub(super) fn compare(directory: &Path, before: &Value, now: &Value) -> Result<()> {
    for key in files(now) {
        let digest = |case: &Value| case.pointer(&key)?.get("sha256").cloned();
        let file = |case: &Value| {
            let table = case.pointer(&key)?;
            table.get("file").or(table.get("given")).cloned()
        };
        if let (Some(_), Some(path)) = (file(before), file(now))
            && digest(before) != digest(now)
        {
            let file = path.as_str().unwrap_or_default().into();
            return Err(Error::SurfaceChanged { path: directory.to_owned(), file });
        }
    }
    match difference("", &deciding(before), &deciding(now)) {
        None => Ok(()),
        Some((key, [before, now])) => Err(Error::OtherCase { path: directory.to_owned(), key, before, now }),
    }
}

/// The case without the digests and the identity, which results add to it.
pub(super) fn without_digests(resolved: &Value) -> Value {
    let mut case = resolved.clone();
    if let Some(keys) = case.as_object_mut() {
        keys.remove("identity");
    }
    for key in files(resolved) {
        if let Some(table) = case.pointer_mut(&key).and_then(Value::as_object_mut) {
            table.remove("sha256");
        }
    }
    case
}

/// Returns the case without the keys that do not affect a finished pass: title, number of passes, folder of
/// the files.
fn deciding(case: &Value) -> Value {
    let mut case = case.clone();
    if let Some(keys) = case.as_object_mut() {
        keys.remove("title");
        keys.remove("identity");
    }
    if let Some(motion) = case.pointer_mut("/motion").and_then(Value::as_object_mut) {
        motion.remove("passes");
    }
    for key in files(&case) {
        // Its folder depends on the working directory of the program.
        if let Some(file) = case.pointer_mut(&key).and_then(|topography| topography.get_mut("file")) {
            let name = Path::new(file.as_str().unwrap_or_default()).file_name();
            *file = name.map_or(Value::Null, |name| name.to_string_lossy().into());
        }
    }
    case
}

/// Returns the first key at which two cases differ, dotted, and both values.
fn difference(path: &str, before: &Value, now: &Value) -> Option<(String, [String; 2])> {
    if before == now {
        return None;
    }
    let join = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
    match (before, now) {
        (Value::Object(old), Value::Object(new)) => old.keys().chain(new.keys()).find_map(|key| {
            let [old, new] = [old, new].map(|keys| keys.get(key).unwrap_or(&Value::Null));
            difference(&join(key), old, new)
        }),
        (Value::Array(old), Value::Array(new)) if old.len() == new.len() => old
            .iter()
            .zip(new)
            .enumerate()
            .find_map(|(n, (old, new))| difference(&join(&n.to_string()), old, new)),
        _ => {
            let shown =
                |value: &Value| if value.is_null() { "not given".to_owned() } else { value.to_string() };
            Some((path.to_owned(), [shown(before), shown(now)]))
        }
    }
}

#[cfg(test)]
#[path = "../tests/it/ball.rs"]
mod ball;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_difference_is_named_and_what_decides_nothing_is_none() {
        let before = json!({"title": "a", "identity": "x", "contact": {"load": 0.02}, "motion": {"passes": 3, "stride": 1},
            "lower": {"topography": {"file": "there/a.npy", "sha256": "00"}},
            "upper": {"layers": [{}, {"viscoelastic": {"file": "there/m.csv", "sha256": "07"}}]}, "history": [{"load": 1.0}]});
        let with = |pointer: &str, value: Value| {
            let mut now = before.clone();
            *now.pointer_mut(pointer).unwrap() = value;
            compare(Path::new("out"), &before, &now).map_err(|error| error.to_string())
        };
        for (pointer, value) in [
            ("/title", json!("b")),
            ("/identity", json!("y")),
            ("/motion/passes", json!(9)),
            ("/lower/topography/file", json!("here/a.npy")),
            ("/upper/layers/1/viscoelastic/file", json!("here/m.csv")),
        ] {
            assert_eq!(with(pointer, value), Ok(()), "{pointer}");
        }
        for (pointer, value, told) in [
            ("/contact/load", json!(0.03), "'contact.load' was 0.02, now it is 0.03"),
            ("/contact/load", Value::Null, "'contact.load' was 0.02, now it is not given"),
            ("/history/0/load", json!(2.0), "'history.0.load' was 1.0, now it is 2.0"),
            (
                "/lower/topography/file",
                json!("b.npy"),
                "'lower.topography.file' was \"a.npy\", now it is \"b.npy\"",
            ),
            (
                "/lower/topography/sha256",
                json!("01"),
                "there/a.npy has changed since the results in out were begun",
            ),
            (
                "/upper/layers/1/viscoelastic/sha256",
                json!("08"),
                "there/m.csv has changed since the results in out were begun",
            ),
        ] {
            let error = with(pointer, value).unwrap_err();
            assert!(error.ends_with(told), "{pointer}: {error}");
        }
    }

    #[test]
    fn the_identity_of_a_case_stays_what_it_was() {
        // Frozen: a change makes it impossible to resume earlier results.
        let identities: Vec<_> = super::ball::good_cases()
            .iter()
            .map(|(path, text)| {
                let case = Case::parse(text, path, Path::new("")).unwrap();
                let name = path.file_stem().unwrap().to_string_lossy().into_owned();
                (name, identity_of(&serde_json::to_value(case).unwrap())[..8].to_owned())
            })
            .collect();
        let frozen = [
            ("as_the_other", "3a9cbdd3"),
            ("coated", "c0bedc7a"),
            ("driven", "deeb49fa"),
            ("ellipsoid", "f5ac373b"),
            ("flowing", "44c871dd"),
            ("forms", "45aafccc"),
            ("grooves", "21dc62a2"),
            ("layered", "d6ba2f67"),
            ("line", "8fb19859"),
            ("looked_into", "af5e8b80"),
            ("matrix_of_text", "e065768a"),
            ("measured", "eb457a9e"),
            ("ploughed", "a7abdeb1"),
            ("prepared", "fc13f0ca"),
            ("pushed", "137f2c48"),
            ("relaxing", "6813bea8"),
            ("rolled", "4de6a6f8"),
            ("rolling", "6a4293d4"),
            ("rough_ball", "80c24a7a"),
            ("rubbing", "c3ea33d8"),
            ("running_in", "58e862ee"),
            ("smallest", "0bab5fb9"),
            ("sticking", "8a4a2c46"),
            ("stuck", "9945b5f2"),
            ("swept", "0eb13fb9"),
            ("swept_approaches", "36a3c377"),
            ("swept_creepages", "ccb05528"),
            ("swept_pressures", "776fc760"),
            ("swept_rolling", "50369784"),
            ("there_and_back", "1c9f39ac"),
            ("wearing", "9fbaeaa5"),
        ];
        assert_eq!(identities, frozen.map(|(name, identity)| (name.to_owned(), identity.to_owned())));
    }
}
