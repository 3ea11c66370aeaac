//! A study: many cases made from one.

use std::path::PathBuf;

use asperity::motion::Watch;
use asperity::study::parametric::{
    self, Axis, Computed, Folder, Queue, State, Study, Table, TableColumn, Tally, Task,
};
use asperity::study::unit_of_column;
use asperity_cli::{available_memory, collect_study};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyList;

use crate::work;

#[pyclass(name = "Study", frozen)]
pub(crate) struct CoreStudy {
    study: Study,
    directory: PathBuf,
}

/// Key, unit and values of the axis of the points of sweeps, and the index of each row on it; none for a case
/// that failed.
type Points<'py> = (String, String, Bound<'py, PyList>, Vec<Option<u32>>);

/// The rows of a study: cases, the points of their sweeps, columns with name, unit and values, numbers of
/// warnings, and reasons of failures.
type Collected<'py> = (
    Vec<usize>,
    Option<Points<'py>>,
    Vec<(String, String, Bound<'py, PyArray1<f64>>)>,
    Vec<usize>,
    Vec<Option<String>>,
);

#[pymethods]
impl CoreStudy {
    #[new]
    fn new(py: Python<'_>, file: PathBuf, directory: PathBuf) -> PyResult<Self> {
        let study = work::run(py, 0, None, |_| Folder::number(&directory, Study::load(&file)?))?;
        Ok(Self { study, directory })
    }

    fn title(&self) -> &str {
        self.study.title()
    }

    /// Returns key, unit and values of each axis: numbers in SI, or texts.
    fn axes<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, String, Bound<'py, PyList>)>> {
        let axis = |axis: &Axis| Ok((axis.key().to_owned(), axis.unit().to_owned(), values(py, axis)?));
        self.study.axes().iter().map(axis).collect()
    }

    /// Returns for each case the index of the value of each axis.
    fn indices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        let cases = 1..=self.study.len();
        let indices: Vec<u32> = cases.flat_map(|case| self.study.indices(case)).copied().collect();
        indices.into_pyarray(py).reshape([self.study.len(), self.study.axes().len()])
    }

    /// Returns the state of each case, "done", "failed", "running" in some process, or "open", and the reason
    /// of a failure.
    fn states(&self, py: Python<'_>) -> PyResult<Vec<(&'static str, Option<String>)>> {
        let states =
            work::run(py, 0, None, |_| self.folder()?.map(|folder| self.stand(&folder)).transpose())?;
        let told = |state| match state {
            State::Done => ("done", None),
            State::Failed(message) => ("failed", Some(message)),
            State::Running => ("running", None),
            State::Open => ("open", None),
        };
        Ok(states.map_or_else(
            || vec![("open", None); self.study.len()],
            |states| states.into_iter().map(told).collect(),
        ))
    }

    /// Computes the remaining cases of a task. Once all are over, writes tables and page. Returns the failed
    /// cases.
    fn run(
        &self,
        py: Python<'_>,
        task: [usize; 2],
        retry: bool,
        threads: usize,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Vec<(usize, String)>> {
        let [number, of] = task;
        work::run(py, threads, progress.as_ref(), |looking| {
            self.study.open_devices()?;
            let folder = Folder::enter(&self.directory, &self.study)?;
            let queue = Queue::new(&self.study, &folder, Task { number, of }, retry)?;
            let ended = |_: usize, _: &Computed| looking.over(queue.len());
            parametric::compute(&queue, available_memory(), &|| looking.stop(), &ended)?;
            let states = self.stand(&folder)?;
            // The tables of a study that has grown belong to its present file.
            if Tally::from_states(&states).left() == 0 && !folder.has_grown(&self.study)? {
                collect_study(&self.study, &folder)?;
            }
            let failed =
                |(n, state)| if let State::Failed(message) = state { Some((n + 1, message)) } else { None };
            Ok(states.into_iter().enumerate().filter_map(failed).collect())
        })
    }

    /// Writes tables and page of the present results.
    fn collect<'py>(&self, py: Python<'py>) -> PyResult<Collected<'py>> {
        let table = work::run(py, 0, None, |_| {
            collect_study(&self.study, &Folder::open(&self.directory, &self.study)?)
        })?;
        self.collected(py, &table)
    }

    /// Returns the results of the finished and failed cases; `None` before the study is begun.
    fn table<'py>(&self, py: Python<'py>) -> PyResult<Option<Collected<'py>>> {
        let table = work::run(py, 0, None, |_| {
            self.folder()?.map(|folder| Table::collect(&self.study, &folder)).transpose()
        })?;
        table.map(|table| self.collected(py, &table)).transpose()
    }
}

impl CoreStudy {
    /// The directory; `None` before the study is begun.
    fn folder(&self) -> asperity::Result<Option<Folder>> {
        let is_there = self.directory.exists();
        is_there.then(|| Folder::open(&self.directory, &self.study)).transpose()
    }

    fn stand(&self, folder: &Folder) -> asperity::Result<Vec<State>> {
        folder.states(&self.study)
    }

    fn collected<'py>(&self, py: Python<'py>, table: &Table) -> PyResult<Collected<'py>> {
        let rows = table.rows();
        let of_study = self.study.axes().len();
        let points = |axis: &Axis| {
            let indices = rows.iter().map(|row| row.indices.get(of_study).copied()).collect();
            Ok::<_, PyErr>((axis.key().to_owned(), axis.unit().to_owned(), values(py, axis)?, indices))
        };
        let column = |(n, column): (usize, &TableColumn)| {
            let unit = unit_of_column(&column.name).unwrap_or_default().to_owned();
            let values: Vec<f64> =
                rows.iter().map(|row| row.numbers.get(n).copied().unwrap_or(f64::NAN)).collect();
            (column.name.clone(), unit, values.into_pyarray(py))
        };
        Ok((
            rows.iter().map(|row| row.case).collect(),
            table.axes().get(of_study).map(points).transpose()?,
            table.columns().iter().enumerate().map(column).collect(),
            rows.iter().map(|row| row.warnings).collect(),
            rows.iter().map(|row| row.failure.clone()).collect(),
        ))
    }
}

/// Converts the values of an axis: whole numbers, numbers in SI, or texts.
fn values<'py>(py: Python<'py>, axis: &Axis) -> PyResult<Bound<'py, PyList>> {
    let cells: Vec<String> = (0..axis.len()).map(|index| axis.cell(index)).collect();
    match axis.numbers() {
        None => PyList::new(py, cells),
        Some(numbers) => match cells.iter().map(|cell| cell.parse().ok()).collect::<Option<Vec<i64>>>() {
            Some(whole) => PyList::new(py, whole),
            None => PyList::new(py, numbers),
        },
    }
}
