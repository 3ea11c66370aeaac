//! What several tests use.

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use asperity_base::Field;
use asperity_contact::motion::{Progress, Watch};
use asperity_study::{Case, Existing, Results, StaticResult, Summary, SurfaceInput, bodies, estimate};

/// Reads a case that has no files.
#[track_caller]
pub(crate) fn parsed(text: &str) -> Case {
    parsed_in(text, Path::new(""))
}

/// Reads a case whose files are in this folder.
#[track_caller]
pub(crate) fn parsed_in(text: &str, folder: &Path) -> Case {
    Case::parse(text, Path::new("case.toml"), folder).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Runs a case into a new directory.
#[track_caller]
pub(crate) fn run(case: &Case, directory: &Path) -> (Summary, Results) {
    run_to(case, directory, Existing::Keep)
}

/// Runs a case into a directory with or without results.
#[track_caller]
pub(crate) fn run_to(case: &Case, directory: &Path, existing: Existing) -> (Summary, Results) {
    let ended = asperity_study::run(case, SurfaceInput::default(), directory, existing, &());
    let (summary, writer) = ended.unwrap_or_else(|error| panic!("{error}"));
    (summary, writer.results().clone())
}

/// Solves a static contact without files.
#[track_caller]
pub(crate) fn at_rest(case: &Case) -> StaticResult {
    asperity_study::static_contact(case, SurfaceInput::default(), &())
        .unwrap_or_else(|error| panic!("{error}"))
}

/// A field of a static contact.
#[track_caller]
pub(crate) fn field<'a>(result: &'a StaticResult, name: &str) -> &'a Field {
    let named = result.fields.fields.iter().find(|field| field.name == name);
    &named.unwrap_or_else(|| panic!("no field {name}")).values
}

/// A field of a static contact that has been written.
#[track_caller]
pub(crate) fn written(results: &Results, name: &str) -> Field {
    results.static_fields().unwrap().read(name).unwrap().into_field().unwrap()
}

pub(crate) fn most(values: &Field) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

/// The warnings about a case before it is computed.
#[track_caller]
pub(crate) fn foreseen(case: &Case) -> Vec<String> {
    let bodies = bodies(case, SurfaceInput::default()).unwrap();
    let estimate = estimate(case, &bodies).unwrap_or_else(|error| panic!("{error}"));
    [estimate.warnings, estimate.predicted].concat()
}

pub(crate) fn on_threads<R: Send>(threads: usize, task: impl FnOnce() -> R + Send) -> R {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(task)
}

/// Counts what is solved: points of a sweep, increments of a loading, updates or positions; stops after some
/// of it.
pub(crate) struct StopAfter {
    most: usize,
    solved: AtomicUsize,
}

impl StopAfter {
    pub(crate) fn steps(most: usize) -> Self {
        Self { most, solved: AtomicUsize::new(0) }
    }

    pub(crate) fn solved(&self) -> usize {
        self.solved.load(Relaxed)
    }
}

impl Watch for StopAfter {
    fn position(&self, _: &Progress) {
        self.solved.fetch_add(1, Relaxed);
    }

    fn stop(&self) -> bool {
        self.solved() >= self.most
    }
}
