//! A computation on separate threads, while the caller handles signals and progress.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use asperity::Result;
use asperity::motion::{Progress, Watch};
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use asperity_cli::MAX_THREADS;

use crate::errors;

/// Interval at which the caller handles signals and reports progress.
const TICK: Duration = Duration::from_millis(50);

/// Runs `work` on `threads` (0: one per core) and returns its result. Meanwhile the caller, detached from the
/// interpreter, wakes up regularly, handles signals and calls `progress`. An exception of either stops the
/// work, and is raised once it has ended.
pub(crate) fn run<T: Send>(
    py: Python<'_>,
    threads: usize,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Observer) -> Result<T> + Send,
) -> PyResult<T> {
    run_warning(py, threads, progress, None, work)
}

/// [`run`] that calls `warn` with each warning about a result as soon as it is known, also if the work then
/// fails.
pub(crate) fn run_warning<T: Send>(
    py: Python<'_>,
    threads: usize,
    progress: Option<&Bound<'_, PyAny>>,
    warn: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Observer) -> Result<T> + Send,
) -> PyResult<T> {
    let tell = |looking: &Observer| looking.warn(warn).and_then(|()| looking.tell(progress));
    let pool = pool(threads)?;
    let looking = Observer::default();
    let mut outcome = None;
    let mut raised = None;
    pool.in_place_scope(|scope| {
        scope.spawn(|_| {
            outcome = Some(catch_unwind(AssertUnwindSafe(|| work(&looking))));
            looking.end();
        });
        while !py.detach(|| looking.wait(TICK)) {
            if raised.is_none()
                && let Err(exception) = py.check_signals().and_then(|()| tell(&looking))
            {
                looking.stop.store(true, Ordering::Relaxed);
                raised = Some(exception);
            }
        }
    });
    match (raised, outcome.expect("the work has ended")) {
        (Some(exception), _) => Err(exception),
        (None, Ok(Ok(result))) => {
            // Work shorter than a tick is also reported, because it may be one of many.
            tell(&looking)?;
            Ok(result)
        }
        (None, Ok(Err(error))) => {
            looking.warn(warn)?;
            Err(errors::exception(py, &error))
        }
        (None, Err(panic)) => Err(errors::internal(py, &text(panic.as_ref()))),
    }
}

/// Message of a panic.
fn text(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default()
}

/// Pass, passes, trial, positions solved, positions, load, and the progress if all positions are solved
/// together.
type Told = (usize, usize, usize, usize, usize, f64, Option<f64>);

/// Observer of the work.
#[derive(Default)]
pub(crate) struct Observer {
    stop: AtomicBool,
    now: Mutex<Option<Told>>,
    /// Warnings that the caller does not know yet.
    warnings: Mutex<Vec<String>>,
    over: AtomicUsize,
    ended: Mutex<bool>,
    ends: Condvar,
}

impl Observer {
    /// Counts a finished case of `cases`, which are reported as the positions of one pass.
    pub(crate) fn over(&self, cases: usize) {
        let over = self.over.fetch_add(1, Ordering::Relaxed) + 1;
        let mut now = held(&self.now);
        if now.is_none_or(|(_, _, _, known, ..)| known < over) {
            *now = Some((1, 1, 1, over, cases, f64::NAN, None));
        }
    }

    fn end(&self) {
        *held(&self.ended) = true;
        self.ends.notify_all();
    }

    /// Waits at most `time` for the end; returns whether it has come.
    fn wait(&self, time: Duration) -> bool {
        let waiting = self.ends.wait_timeout_while(held(&self.ended), time, |ended| !*ended);
        *waiting.unwrap_or_else(PoisonError::into_inner).0
    }

    fn tell(&self, progress: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let now = held(&self.now).take();
        let (Some(progress), Some(now)) = (progress, now) else { return Ok(()) };
        progress.call1(now).map(|_| ())
    }

    fn warn(&self, warn: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let warnings = std::mem::take(&mut *held(&self.warnings));
        let Some(warn) = warn else { return Ok(()) };
        warnings.into_iter().try_for_each(|warning| warn.call1((warning,)).map(|_| ()))
    }
}

impl Watch for Observer {
    fn position(&self, progress: &Progress) {
        let Progress { pass, passes, trial, solved, positions, load, together, .. } = *progress;
        *held(&self.now) = Some((pass, passes, trial, solved, positions, load, together));
    }

    fn solving(&self, progress: &Progress) {
        self.position(progress);
    }

    fn warning(&self, warning: &str) {
        held(&self.warnings).push(warning.to_owned());
    }

    fn stop(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

fn held<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Threads used last by this process: process id, number and pool.
static LAST: Mutex<Option<(u32, usize, Arc<ThreadPool>)>> = Mutex::new(None);

/// Returns a pool of `threads` threads of this process. Threads of a process do not exist in its forked
/// child, where waiting for them would block forever.
fn pool(threads: usize) -> PyResult<Arc<ThreadPool>> {
    if threads > MAX_THREADS {
        let message = format!("'threads' is {threads}, expected a whole number from 1 to {MAX_THREADS}");
        return Err(pyo3::exceptions::PyValueError::new_err(message));
    }
    let process = std::process::id();
    // In a child the lock may have been held at the fork.
    let mut last = LAST.try_lock().ok();
    if let Some(Some((owner, size, pool))) = last.as_deref()
        && (*owner, *size) == (process, threads)
    {
        return Ok(pool.clone());
    }
    let built = ThreadPoolBuilder::new().num_threads(threads).build();
    let failed =
        |error| pyo3::exceptions::PyRuntimeError::new_err(format!("threads cannot be made: {error}"));
    let pool = Arc::new(built.map_err(failed)?);
    if let Some(last) = last.as_deref_mut() {
        let before = last.replace((process, threads, pool.clone()));
        if let Some((owner, _, pool)) = before
            && owner != process
        {
            // Dropping it would wait for its threads.
            std::mem::forget(pool);
        }
    }
    Ok(pool)
}
