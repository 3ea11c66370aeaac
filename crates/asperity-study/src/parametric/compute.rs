//! Computation of the remaining cases of a study: as many at a time as there are threads, and as fit in
//! memory together.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

use rayon::{ThreadPool, ThreadPoolBuilder};

use super::queue::{Computed, Queue};
use crate::case::Case;
use crate::estimate::demand;
use crate::surface_input::SurfaceInput;
use asperity_base::error::{Error, Result};
use asperity_contact::motion::{Progress, Watch};

/// Computes the cases of a queue, as many at a time as the pool of the caller has threads. If fewer cases are
/// left, each gets several threads.
///
/// Cases that do not fit together in `memory`, bytes, wait for each other. `ended` is called for each case,
/// from 1, once it is over. `stop` is called repeatedly; if it returns true, the running cases are given up
/// and open again.
///
/// # Errors
/// [`Error::Interrupted`] if `stop` returned true, [`Error::SurfaceChanged`] if a file of the study has
/// changed since its plan was made, [`Error::Threads`], [`Error::File`] if the study cannot be written to.
pub fn compute(
    queue: &Queue<'_>,
    memory: f64,
    stop: &(dyn Fn() -> bool + Sync),
    ended: &(dyn Fn(usize, &Computed) + Sync),
) -> Result<()> {
    let threads = rayon::current_num_threads();
    let at_a_time = threads.min(queue.len());
    let pools = (0..at_a_time).map(|_| pool(threads / at_a_time)).collect::<Result<Vec<_>>>()?;
    let crew = WorkerData {
        stop,
        ended,
        memory: Memory { all: memory, taken: Mutex::default(), given_back: Condvar::new() },
        is_broken: AtomicBool::new(false),
        error: Mutex::default(),
    };
    thread::scope(|scope| {
        for pool in &pools {
            scope.spawn(|| {
                if let Err(error) = pool.install(|| work(queue, &crew)) {
                    crew.is_broken.store(true, Ordering::Relaxed);
                    locked(&crew.error).get_or_insert(error);
                }
            });
        }
    });
    crew.error.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(()), Err)
}

/// Computes one case after the other.
fn work(queue: &Queue<'_>, crew: &WorkerData<'_>) -> Result<()> {
    while !crew.stop() {
        let Some(turn) = queue.take()? else { return Ok(()) };
        let case = turn.case();
        let computed = turn.compute(|case| crew.memory.take(case), crew)?;
        (crew.ended)(case, &computed);
    }
    if (crew.stop)() { Err(Error::Interrupted) } else { Ok(()) }
}

/// Creates a pool of `threads` threads.
fn pool(threads: usize) -> Result<ThreadPool> {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|error| Error::Threads { reason: error.to_string() })
}

/// Data shared by all workers.
struct WorkerData<'c> {
    stop: &'c (dyn Fn() -> bool + Sync),
    ended: &'c (dyn Fn(usize, &Computed) + Sync),
    memory: Memory,
    /// Whether a worker has failed.
    is_broken: AtomicBool,
    error: Mutex<Option<Error>>,
}

impl Watch for WorkerData<'_> {
    fn position(&self, _: &Progress) {}

    fn stop(&self) -> bool {
        self.is_broken.load(Ordering::Relaxed) || (self.stop)()
    }
}

/// Memory divided among the cases computed at the same time, bytes.
struct Memory {
    all: f64,
    taken: Mutex<f64>,
    given_back: Condvar,
}

/// Memory reserved for a case.
struct Part<'m> {
    memory: &'m Memory,
    bytes: f64,
}

impl Memory {
    /// Reserves the memory of a case, once it is free; an error if it never will be.
    fn take(&self, case: &Case) -> Result<Part<'_>> {
        let demand = demand(case, &SurfaceInput::default(), rayon::current_num_threads())?;
        demand.fits(self.all)?;
        let mut taken = locked(&self.taken);
        while *taken > 0.0 && *taken + demand.memory > self.all {
            taken = self.given_back.wait(taken).unwrap_or_else(PoisonError::into_inner);
        }
        *taken += demand.memory;
        Ok(Part { memory: self, bytes: demand.memory })
    }
}

impl Drop for Part<'_> {
    fn drop(&mut self) {
        *locked(&self.memory.taken) -= self.bytes;
        self.memory.given_back.notify_all();
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
