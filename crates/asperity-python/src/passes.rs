//! A computation with results in a directory; a motion, pass after pass.

use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard};

use asperity::motion::{SolvedPass, Watch};
use asperity::study::{self, Existing, Passes};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::arrays::{array, field, record};
use crate::contact::{CallArguments, Source, asked};
use crate::work;

fn existing(word: &str) -> Existing {
    match word {
        "resume" => Existing::Resume,
        "overwrite" => Existing::Overwrite,
        _ => Existing::Keep,
    }
}

/// Computes a case and writes its results to a directory.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the case, where its results go, and who looks on")]
pub(crate) fn run<'py>(
    py: Python<'py>,
    source: Source<'py>,
    handed: CallArguments<'py>,
    directory: PathBuf,
    existing: &str,
    threads: usize,
    progress: Option<Bound<'py, PyAny>>,
    warn: Bound<'py, PyAny>,
) -> PyResult<()> {
    let (case, given) = asked(py, &source, &handed, threads, false)?;
    let existing = self::existing(existing);
    work::run_warning(py, threads, progress.as_ref(), Some(&warn), |watch| {
        study::run(&case, given, &directory, existing, watch).map(|_| ())
    })
}

/// A running motion.
#[pyclass(name = "Passes", frozen)]
pub(crate) struct CorePasses {
    state: Mutex<State>,
    threads: usize,
}

/// The passes, until they are ended, and the solved but unfinished pass.
struct State {
    passes: Option<Passes>,
    solved: Option<SolvedPass>,
}

/// Contacts of a pass as flat arrays: position, cell of the lower and of the upper body; pressure, plastic
/// interference, fractional displacement from the cells of the lower and of the upper body, shear,
/// temperature.
type Contacts<'py> = ([Bound<'py, PyArray1<i64>>; 3], [Bound<'py, PyArray1<f64>>; 6]);

#[pymethods]
impl CorePasses {
    #[new]
    fn new<'py>(
        py: Python<'py>,
        source: Source<'py>,
        handed: CallArguments<'py>,
        directory: PathBuf,
        existing: &str,
        threads: usize,
        has_custom_laws: bool,
    ) -> PyResult<Self> {
        let (case, given) = asked(py, &source, &handed, threads, has_custom_laws)?;
        let existing = self::existing(existing);
        let passes = work::run(py, threads, None, |looking| {
            Passes::enter_until(&case, given, &directory, existing, &|| looking.stop())
        })?;
        Ok(Self { state: Mutex::new(State { passes: Some(passes), solved: None }), threads })
    }

    /// Solves the next pass; false if there is none. Discards a pass that is already solved.
    fn solve(&self, py: Python<'_>, progress: Option<Bound<'_, PyAny>>) -> PyResult<bool> {
        let mut state = self.state()?;
        let State { passes, solved } = &mut *state;
        let Some(passes) = passes else { return Ok(false) };
        *solved = work::run(py, self.threads, progress.as_ref(), |watch| passes.solve(watch))?;
        Ok(solved.is_some())
    }

    /// Finishes the solved pass: writes it, and uses its bodies for the next one.
    fn finish(&self, py: Python<'_>, warn: Bound<'_, PyAny>) -> PyResult<()> {
        let mut state = self.state()?;
        let State { passes, solved } = &mut *state;
        match (passes, solved.take()) {
            (Some(passes), Some(solved)) => {
                work::run_warning(py, self.threads, None, Some(&warn), |watch| passes.finish(solved, watch))
            }
            _ => Ok(()),
        }
    }

    /// Writes the summary and ends the motion.
    fn end(&self, py: Python<'_>) -> PyResult<()> {
        let Some(passes) = self.state()?.passes.take() else { return Ok(()) };
        work::run(py, self.threads, None, |_| passes.end().map(|_| ()))
    }

    /// Number of finished passes.
    fn done(&self) -> PyResult<usize> {
        Ok(self.state()?.passes.as_ref().map_or(0, |passes| passes.computed()))
    }

    /// Returns the record of the solved pass in its present state.
    fn record<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        record(py, &solved(&mut *self.state()?, None)?.record())
    }

    /// Returns the records of the positions of the solved pass.
    fn steps<'py>(&self, py: Python<'py>, number: usize) -> PyResult<Bound<'py, PyAny>> {
        record(py, &solved(&mut *self.state()?, Some(number))?.steps())
    }

    /// Returns the contacts of the solved pass.
    fn contacts<'py>(&self, py: Python<'py>, number: usize) -> PyResult<Contacts<'py>> {
        let mut state = self.state()?;
        let friction = state.passes.as_ref().and_then(|passes| passes.simulation().motion().friction);
        let pass = solved(&mut state, Some(number))?;
        let count = pass.contacts().iter().map(|contact| contact.pressure.len()).sum();
        let [mut position, mut lower, mut upper] = [(); 3].map(|()| Vec::with_capacity(count));
        let [mut pressure, mut plastic, mut beyond_lower, mut beyond_upper, mut shear, mut temperature] =
            [(); 6].map(|()| Vec::with_capacity(count));
        for (index, contact) in pass.contacts().iter().enumerate() {
            for &(cell, p) in &contact.pressure {
                let [a, b] = pass.pair().cells_of_bodies(&contact.position, cell as usize);
                position.push(index as i64);
                lower.push(a as i64);
                upper.push(b as i64);
                pressure.push(p);
                beyond_lower.push(contact.position.fraction[0]);
                beyond_upper.push(contact.position.fraction[1]);
                let magnitude = friction.map_or(0.0, |friction| friction.shear_limit(p));
                shear.push(magnitude.copysign(contact.tangential_force));
            }
            plastic.extend(contact.interference());
            match &contact.temperature {
                None => temperature.resize(pressure.len(), f64::NAN),
                Some(of_cells) => temperature.extend(of_cells),
            }
        }
        let reals = [pressure, plastic, beyond_lower, beyond_upper, shear, temperature];
        Ok((
            [position, lower, upper].map(|whole| whole.into_pyarray(py)),
            reals.map(|real| real.into_pyarray(py)),
        ))
    }

    /// Returns the present heights of the lower and of the upper body.
    fn heights<'py>(&self, py: Python<'py>) -> PyResult<[Bound<'py, PyArray2<f64>>; 2]> {
        let state = self.state()?;
        let pair = match (&state.solved, &state.passes) {
            (Some(solved), _) => solved.pair(),
            (None, Some(passes)) => passes.simulation().pair(),
            (None, None) => return Err(ended()),
        };
        Ok([&pair.lower, &pair.upper].map(|body| array(py, body.heights.clone())))
    }

    /// Returns the size of a cell, the sliding distance and the time for which a position stands, and the
    /// numbers of cells of the lower and of the upper body.
    fn grid(&self) -> PyResult<([f64; 2], f64, f64, [(usize, usize); 2])> {
        let state = self.state()?;
        let simulation = state.passes.as_ref().ok_or_else(ended)?.simulation();
        let pair = simulation.pair();
        let pitch = pair.pitch();
        let motion = simulation.motion();
        let cells = motion.cells_of_position(pair.lower.columns());
        let (distance, time) = (motion.sliding_distance_of(cells, pitch[0]), motion.time_of(cells, pitch[0]));
        Ok((pitch, distance, time, [&pair.lower, &pair.upper].map(|body| body.heights.dim())))
    }

    /// Removes the depths of a single pass from the bodies of the solved one, for each pass that it
    /// represents.
    fn remove(
        &self,
        number: usize,
        law: &str,
        lower: PyReadonlyArray2<'_, f64>,
        upper: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<()> {
        solved(&mut *self.state()?, Some(number))?.remove(law, &[field(&lower), field(&upper)]);
        Ok(())
    }
}

impl CorePasses {
    /// Locks the state for one thread.
    fn state(&self) -> PyResult<MutexGuard<'_, State>> {
        let busy = || PyRuntimeError::new_err("another thread is at work on this simulation");
        self.state.try_lock().map_err(|_| busy())
    }
}

/// Returns the solved pass; an error if `number`, from 1, is given and differs.
fn solved(state: &mut State, number: Option<usize>) -> PyResult<&mut SolvedPass> {
    let is_asked_for =
        |solved: &&mut SolvedPass| number.is_none_or(|number| solved.steps()[0].pass == number);
    state.solved.as_mut().filter(is_asked_for).ok_or_else(ended)
}

fn ended() -> PyErr {
    PyRuntimeError::new_err("this pass is finished: the next one is under way, or there is none")
}
