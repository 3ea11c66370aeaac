//! The law of a joint.

use std::path::PathBuf;

use asperity::Choice;
use asperity::motion::Watch;
use asperity::study::joint::{Client, ClientSettings, Edge, Units, samples};
use asperity::study::parametric::{self, Computed, Folder, Queue, Task};
use asperity_cli::{available_memory, joint_in_words, write_joint};
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;

use crate::work;

/// Name, unit, and median, lower and upper edge of a quantity at each pressure, NaN where it is unknown.
type Quantity<'py> = (&'static str, &'static str, [Bound<'py, PyArray1<f64>>; 3]);

/// Sentence, warnings, coefficients as JSON, number of samples, datum; pressures; pressure and closure of the median; the
/// quantities.
type Found<'py> = (
    (String, Vec<String>, String, usize, f64),
    Bound<'py, PyArray1<f64>>,
    [Bound<'py, PyArray1<f64>>; 2],
    Vec<Quantity<'py>>,
);

/// Computes the samples of a joint that are left, and writes its table, page, figures and the files for these programs.
#[pyfunction]
pub(crate) fn joint<'py>(
    py: Python<'py>,
    case: PathBuf,
    directory: PathBuf,
    clients: Vec<String>,
    settings: (String, Option<f64>),
    retry: bool,
    threads: usize,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Found<'py>> {
    let clients: Vec<Client> = clients.iter().map(|client| known(client)).collect();
    let settings = ClientSettings { units: known::<Units>(&settings.0), friction: settings.1 };
    let (law, doubts) = work::run(py, threads, progress.as_ref(), |looking| {
        let study = samples(&case, &clients)?;
        study.open_devices()?;
        let folder = Folder::enter(&directory, &study)?;
        let queue = Queue::new(&study, &folder, Task::ALL, retry)?;
        let ended = |_: usize, _: &Computed| looking.over(queue.len());
        parametric::compute(&queue, available_memory(), &|| looking.stop(), &ended)?;
        write_joint(&study, &folder, &clients, &settings)
    })?;
    let array = |values: Vec<f64>| values.into_pyarray(py);
    let edges = [Edge::Median, Edge::Low, Edge::High];
    let quantities = law.quantities.iter().map(|quantity| {
        let values = edges.map(|edge| array(law.values(quantity.kind, edge).unwrap_or_default()));
        (quantity.kind.name(), quantity.kind.unit(), values)
    });
    let coefficients = serde_json::to_string(&law.coefficients()).expect("numbers can be written");
    let closure = law.closure(Edge::Median);
    let part = |n: usize| array(closure.iter().map(|point| point[n]).collect());
    Ok((
        (joint_in_words(&law), doubts, coefficients, law.samples, law.datum),
        array(law.pressures.clone()),
        [part(0), part(1)],
        quantities.collect(),
    ))
}

/// The choice of this word, which the Python package has checked.
fn known<C: Choice>(word: &str) -> C {
    C::of_word(word).expect("a word that was checked")
}
