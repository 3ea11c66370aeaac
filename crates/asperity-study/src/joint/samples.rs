//! The study of a case: the same loads on samples of its surfaces.

use std::path::Path;

use toml::Value;

use super::clients::Client;
use crate::case::{Case, Course, Layer, Prescribed, Source, TopographySpec};
use crate::parametric::Study;
use crate::prepare::samples_in_file;
use asperity_base::error::Result;
use asperity_contact::conductance::Joint;
use asperity_contact::joint::JointLaw;
use asperity_contact::operator::Boundary;
use asperity_contact::with::Listed as _;

/// Most samples of a joint.
pub const MAX_SAMPLES: usize = 10_000;

/// Seeds of a sample lie this far from those of the sample before, so that no two samples share a surface.
const STRIDE: u64 = 1_000_003;

/// Makes the study of the samples of a joint from the case file at `path`, for these programs. Its table `[joint]` says how
/// many samples there are; without one, it is a single sample.
///
/// # Errors
/// [`Error::Case`](asperity_base::error::Error::Case) at the key with the mistake: a case without several loads or without
/// surfaces that repeat, samples of surfaces without seeds, patches that do not fit, a gas that a program does not take. The
/// errors of [`Case::load`].
pub fn samples(path: &Path, clients: &[Client]) -> Result<Study> {
    let case = Case::load(path)?;
    let joint = JointLaw::of(&case.with).cloned();
    is_swept(&case)?;
    let refuse =
        |key: &str, message: &str, hint: &str| Err(case.error_at(key, message, Some(hint.to_owned())));
    if joint.as_ref().is_some_and(|joint| joint.every != 1) {
        let message = "the law of a joint needs each of the loads";
        return refuse("joint.every", message, "leave `every` out: `asperity run` alone takes it");
    }
    if clients.contains(&Client::Calculix) && Joint::of(&case.with).is_some_and(|joint| joint.gas.is_some()) {
        let message = "CalculiX exchanges no heat between open faces";
        return refuse("conductance.gas", message, "leave the gas out, or take another program");
    }
    let at = |key: &str| if joint.is_some() { format!("joint.{key}") } else { "contact".to_owned() };
    let bodies = [("lower.topography", &case.lower.topography), ("upper.topography", &case.upper.topography)];
    let measured =
        || bodies.iter().filter(|(_, topography)| matches!(topography.source, Source::File { .. }));
    let mut keys = Vec::new();
    let count = match joint {
        Some(JointLaw { patches: Some(patches), .. }) => {
            for (table, topography) in bodies {
                keys.extend(windows(&case, table, topography, patches)?);
            }
            if keys.is_empty() {
                let message = "patches are cut from measured surfaces: neither body has a file";
                let hint = "`samples = 8` computes generated surfaces from other seeds";
                return refuse("joint.patches", message, hint);
            }
            patches[0] * patches[1]
        }
        Some(JointLaw { ref files, .. }) if !files.is_empty() => {
            let (Some((table, topography)), None) = (measured().next(), measured().nth(1)) else {
                let message =
                    "files are samples of the one measured body: this case has none, or two of them";
                return refuse("joint.files", message, "give `file` in the topography of one of the bodies");
            };
            for file in files {
                let folder = path.parent().unwrap_or(Path::new(""));
                samples_in_file(&folder.join(file), &topography.source)
                    .map_err(|error| case.error_at("joint.files", error.to_string(), error.hint()))?;
            }
            let names = files.iter().map(|file| Value::String(file.to_string_lossy().into_owned()));
            keys.push((format!("{table}.file"), names.collect()));
            files.len()
        }
        Some(JointLaw { samples, .. }) => samples.unwrap_or(1),
        None => 1,
    };
    if count > MAX_SAMPLES {
        let message = format!("{count} samples are more than {MAX_SAMPLES}");
        return Err(case.error_at(&at("patches"), message, None));
    }
    if count > 1 && case.contact.sweep().iter().any(|control| matches!(control, Prescribed::Approach(_))) {
        let message = "samples at the same approaches bear different pressures, and share no law";
        return refuse("contact", message, "give `mean_pressures` or `loads` in place of `approaches`");
    }
    for (table, topography) in bodies {
        keys.extend(seeds(table, topography, count));
    }
    if keys.is_empty() {
        if count > 1 {
            let message = "samples need a generated surface: these have no seed";
            let hint = "cut measured surfaces with `patches = [4, 4]`, or give `files`, in [joint]";
            return refuse(&at("samples"), message, hint);
        }
        // A single sample is the case itself.
        keys.push(("joint.every".to_owned(), vec![Value::Integer(1)]));
    }
    Study::of_cases(path, keys, |table| {
        let joint = table.entry("joint").or_insert_with(|| Value::Table(toml::Table::new()));
        if let Value::Table(joint) = joint {
            ["samples", "patches", "files"].into_iter().for_each(|key| drop(joint.remove(key)));
        }
    })
}

/// Checks that a case has several loads on surfaces that repeat.
fn is_swept(case: &Case) -> Result<()> {
    let refuse =
        |key: &str, message: &str, hint: &str| Err(case.error_at(key, message, Some(hint.to_owned())));
    if case.contact.boundary != Boundary::PERIODIC {
        return refuse(
            "contact.boundary",
            "the law of a joint needs surfaces that repeat along both axes",
            "set `boundary = \"periodic\"`: a free boundary counts the bulk of the bodies, too",
        );
    }
    let loads = match case.course(1.0) {
        Course::Sweep(_) => case.contact.sweep().len(),
        _ => 0,
    };
    if loads < 2 {
        return refuse(
            "contact",
            "the law of a joint needs several loads",
            "give `mean_pressures = [\"2 MPa\", \"20 MPa\", \"200 MPa\"]`, or a range of them",
        );
    }
    Ok(())
}

/// Returns the keys of the seeds of a topography and of what is added to it, each with its value for each sample. The first
/// sample has the seeds of the case.
fn seeds(table: &str, topography: &TopographySpec, count: usize) -> Vec<(String, Vec<Value>)> {
    let own = match topography.source {
        Source::Generate { seed, .. } => Some((format!("{table}.seed"), seed)),
        _ => None,
    };
    let layers = topography.plus.iter().enumerate().filter_map(|(n, layer)| match layer {
        Layer::Generate { seed, .. } => Some((format!("{table}.plus.{n}.seed"), *seed)),
        Layer::Form { .. } => None,
    });
    let values = |seed: u64| {
        let of = |sample: usize| seed.wrapping_add(sample as u64 * STRIDE) & i64::MAX as u64;
        (0..count).map(|sample| Value::Integer(of(sample) as i64)).collect()
    };
    own.into_iter().chain(layers).map(|(key, seed)| (key, values(seed))).collect()
}

/// Returns the window of a measured topography for each patch; none of other topographies.
fn windows(
    case: &Case,
    table: &str,
    topography: &TopographySpec,
    [nx, ny]: [usize; 2],
) -> Result<Option<(String, Vec<Value>)>> {
    let Source::File { file, .. } = &topography.source else { return Ok(None) };
    let key = format!("{table}.window");
    let shape = samples_in_file(file, &topography.source)
        .map_err(|error| case.error_at(&format!("{table}.file"), error.to_string(), error.hint()))?;
    let [x0, y0, width, height] = topography.preparation.window.unwrap_or([0, 0, shape[0], shape[1]]);
    let patch = [width / nx.max(1), height / ny.max(1)];
    if nx == 0 || ny == 0 || patch.contains(&0) {
        let message =
            format!("{nx} × {ny} patches do not fit into {width} × {height} samples of {}", file.display());
        return Err(case.error_at("joint.patches", message, Some("take fewer patches".to_owned())));
    }
    let window = |n: usize| {
        let [i, j] = [n / ny, n % ny];
        let corner = [x0 + i * patch[0], y0 + j * patch[1], patch[0], patch[1]];
        Value::Array(corner.into_iter().map(|number| Value::Integer(number as i64)).collect())
    };
    Ok(Some((key, (0..nx * ny).map(window).collect())))
}
