//! The study of a case: the same loads on samples of its surfaces.

use std::path::Path;

use toml::Value;

use crate::case::{Case, Course, Layer, Source, TopographySpec};
use crate::parametric::Study;
use crate::prepare::samples_in_file;
use asperity_base::error::Result;
use asperity_contact::joint::JointLaw;
use asperity_contact::operator::Boundary;
use asperity_contact::with::Listed as _;

/// Most samples of a joint.
pub const MAX_SAMPLES: usize = 10_000;

/// Seeds of a sample lie this far from those of the sample before, so that no two samples share a surface.
const STRIDE: u64 = 1_000_003;

/// Makes the study of the samples of a joint from the case file at `path`. Its table `[joint]` says how many there are;
/// without one, it is a single sample.
///
/// # Errors
/// [`Error::Case`](asperity_base::error::Error::Case) at the key with the mistake: a case without several loads or without surfaces that repeat, samples of
/// surfaces without seeds, patches that do not fit. The errors of [`Case::load`].
pub fn samples(path: &Path) -> Result<Study> {
    let case = Case::load(path)?;
    let joint = JointLaw::of(&case.with).copied();
    let at = |key: &str| if joint.is_some() { format!("joint.{key}") } else { "contact".to_owned() };
    let refuse =
        |key: &str, message: &str, hint: &str| Err(case.error_at(key, message, Some(hint.to_owned())));
    if case.contact.boundary != Boundary::PERIODIC {
        let message = "the law of a joint needs surfaces that repeat along both axes";
        return refuse(
            "contact.boundary",
            message,
            "set `boundary = \"periodic\"`: a free boundary counts the bulk of the bodies, too",
        );
    }
    let loads = match case.course(1.0) {
        Course::Sweep(_) => case.contact.sweep().len(),
        _ => 0,
    };
    if loads < 2 {
        let message = "the law of a joint needs several loads";
        return refuse(
            "contact",
            message,
            "give `mean_pressures = [\"2 MPa\", \"20 MPa\", \"200 MPa\"]`, or a range of them",
        );
    }
    let (count, patches) = match joint {
        Some(JointLaw { patches: Some([nx, ny]), .. }) => (nx * ny, Some([nx, ny])),
        Some(JointLaw { samples: Some(samples), .. }) => (samples, None),
        _ => (1, None),
    };
    if count > MAX_SAMPLES {
        let message = format!("{count} samples are more than {MAX_SAMPLES}");
        return Err(case.error_at(&at("patches"), message, None));
    }
    let bodies = [("lower", &case.lower.topography), ("upper", &case.upper.topography)];
    let mut keys = Vec::new();
    for (name, topography) in bodies {
        let table = format!("{name}.topography");
        match patches {
            Some(patches) => keys.extend(windows(&case, &table, topography, patches)?),
            None => keys.extend(seeds(&table, topography, count)),
        }
    }
    if keys.is_empty() {
        if count > 1 && patches.is_none() {
            let message = "samples need a generated surface: these have no seed";
            return refuse(
                &at("samples"),
                message,
                "cut measured surfaces with `patches = [4, 4]` in [joint]",
            );
        }
        if patches.is_some() {
            let message = "patches are cut from measured surfaces: neither body has a file";
            return refuse(
                &at("patches"),
                message,
                "`samples = 8` computes generated surfaces from other seeds",
            );
        }
        // A single sample is the case itself.
        keys.push(("joint.every".to_owned(), vec![Value::Integer(1)]));
    }
    Study::of_cases(path, keys, |table| {
        let joint = table.entry("joint").or_insert_with(|| Value::Table(toml::Table::new()));
        if let Value::Table(joint) = joint {
            joint.remove("samples");
            joint.remove("patches");
        }
    })
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
