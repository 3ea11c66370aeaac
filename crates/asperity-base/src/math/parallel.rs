//! Parallel work on parts of a task by idle threads.

use std::ops::Range;
use std::slice::{Chunks, ChunksMut};
use std::sync::{Mutex, MutexGuard, PoisonError};

use rayon::FnContext;

use crate::grid::Field;
use crate::ranks::Merged;

/// Performs a `task` on each of some [`Bands`]. Returns the results in their order.
///
/// The result does not depend on the threads if sums over the bands use this order.
#[inline]
pub fn map<T: Send, R: Send>(
    bands: impl ExactSizeIterator<Item = T>,
    task: impl Fn(T) -> R + Sync,
) -> Vec<R> {
    each(bands, BANDS_AT_ONCE, &Pool::default(), || (), |(), band| task(band))
}

/// Merges the results of a function of the rows of each band of a grid of `shape`, in their order.
#[inline]
pub fn merged<M: Merged + Send>(shape: [usize; 2], of_rows: impl Fn(Range<usize>) -> M + Sync) -> M {
    M::of_parts(map(Bands::new(shape).rows(), of_rows))
}

/// Smallest number of bands per thread.
pub const BANDS_AT_ONCE: usize = 2;

/// Performs a `task` on each of some parts. Returns the results in their order. Each thread has its own
/// scratch memory from the `pool`; `new` creates missing memory.
///
/// A thread takes at least `at_once` parts. The present thread performs all parts if they are few, or if its
/// own tasks wait for other threads. Such tasks, for example the other positions of a pass, are larger and
/// have priority.
#[inline]
pub fn each<T: Send, S: Send, R: Send>(
    parts: impl ExactSizeIterator<Item = T>,
    at_once: usize,
    pool: &Pool<S>,
    new: impl Fn() -> S + Sync,
    task: impl Fn(&mut S, T) -> R + Sync,
) -> Vec<R> {
    let has_tasks = rayon_core::current_thread_has_pending_tasks() == Some(true);
    if parts.len() <= at_once || has_tasks || rayon::current_num_threads() == 1 {
        let mut lent = pool.acquire(&new);
        return parts.map(|part| task(lent.scratch(), part)).collect();
    }
    shared(parts.collect(), at_once, &|| pool.acquire(&new), &|lent, part| task(lent.scratch(), part))
}

/// Performs a `task` on each of some parts, each large enough for a thread. Returns the results in their
/// order.
#[inline]
pub fn tasks<T: Send, R: Send>(parts: impl IntoIterator<Item = T>, task: impl Fn(T) -> R + Sync) -> Vec<R> {
    let parts = parts.into_iter();
    if rayon::current_num_threads() == 1 {
        return parts.map(task).collect();
    }
    shared(parts.collect(), 1, &|| (), &|(), part| task(part))
}

/// Performs a `task` on each of the `parts` by all threads. Returns the results in their order.
fn shared<T: Send, S, R: Send>(
    parts: Vec<T>,
    at_once: usize,
    new: &(dyn Fn() -> S + Sync),
    task: &(dyn Fn(&mut S, T) -> R + Sync),
) -> Vec<R> {
    let parts: Vec<Mutex<(Option<T>, Option<R>)>> =
        parts.into_iter().map(|part| Mutex::new((Some(part), None))).collect();
    share(0..parts.len(), at_once, rayon::current_num_threads(), &|some| {
        let mut scratch = new();
        for part in &parts[some] {
            let mut part = part.lock().unwrap_or_else(PoisonError::into_inner);
            let (waiting, done) = &mut *part;
            *done = waiting.take().map(|part| task(&mut scratch, part));
        }
    });
    let done = parts.into_iter().map(|part| part.into_inner().unwrap_or_else(PoisonError::into_inner).1);
    done.map(|done| done.expect("every part is done")).collect()
}

/// Performs a `task` on ranges that cover the `whole`, each of at least `at_once` numbers.
///
/// The range is halved until there are `wanted` ranges. A range taken by another thread is halved further, so
/// that idle threads help the others. This function is not generic, so that rayon is compiled only once.
fn share(whole: Range<usize>, at_once: usize, wanted: usize, task: &(dyn Fn(Range<usize>) + Sync)) {
    if wanted == 0 || whole.len() < 2 * at_once.max(1) {
        return task(whole);
    }
    let middle = whole.start + whole.len() / 2;
    let half = |half: Range<usize>, context: FnContext| {
        let taken = if context.migrated() { rayon::current_num_threads() } else { 0 };
        share(half, at_once, taken.max(wanted / 2), task);
    };
    rayon::join_context(
        |context| half(whole.start..middle, context),
        |context| half(middle..whole.end, context),
    );
}

/// Scratch memory for the largest number of simultaneous threads. It is created once and reused.
pub struct Pool<S>(Mutex<Vec<S>>);

/// Scratch memory that returns to its pool when dropped.
struct PoolGuard<'a, S> {
    pool: &'a Pool<S>,
    scratch: Option<S>,
}

impl<S> Pool<S> {
    fn acquire(&self, new: impl Fn() -> S) -> PoolGuard<'_, S> {
        let kept = self.kept().pop();
        PoolGuard { pool: self, scratch: Some(kept.unwrap_or_else(new)) }
    }

    fn kept(&self) -> MutexGuard<'_, Vec<S>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<S> Default for Pool<S> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<S> PoolGuard<'_, S> {
    fn scratch(&mut self) -> &mut S {
        self.scratch.as_mut().expect("not given back yet")
    }
}

impl<S> Drop for PoolGuard<'_, S> {
    fn drop(&mut self) {
        self.pool.kept().extend(self.scratch.take());
    }
}

/// Creates the field of a `shape` with this `value` at each `(i, j)`, row by row in parallel.
pub fn field(shape: [usize; 2], value: impl Fn(usize, usize) -> f64 + Sync) -> Field {
    let mut field = Field::zeros(shape);
    let at_once = FIELD_SHARE.div_ceil(shape[1]);
    each(
        field.outer_iter_mut().enumerate(),
        at_once,
        &Pool::default(),
        || (),
        |(), (i, mut row)| {
            row.iter_mut().enumerate().for_each(|(j, to)| *to = value(i, j));
        },
    );
    field
}

/// Smallest number of values of a field per thread.
const FIELD_SHARE: usize = 1 << 12;

/// Bands of consecutive rows for parallel work on a grid. They depend only on its shape, and so do sums by
/// band.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bands {
    /// Rows of a band; the last may have fewer.
    rows: usize,
    /// Cells in a row.
    columns: usize,
    /// Rows of the grid.
    all: usize,
}

/// Smallest number of cells in a band; smaller grids are one band.
const MIN_CELLS: usize = 1 << 14;
/// Smallest number of rows in a band, more than the reach of operations between neighbouring bands.
const MIN_ROWS: usize = 32;

impl Bands {
    /// Creates the bands of a grid of `shape`.
    #[inline]
    pub fn new(shape: [usize; 2]) -> Self {
        let [all, columns] = shape;
        Self { rows: MIN_CELLS.div_ceil(columns).max(MIN_ROWS), columns, all }
    }

    /// Cells in a row.
    #[inline]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Returns the band of a row, and the number of the row in the band.
    #[inline]
    pub fn place(&self, row: usize) -> [usize; 2] {
        [row / self.rows, row % self.rows]
    }

    /// Iterates over the rows of each band.
    #[inline]
    pub fn rows(&self) -> impl ExactSizeIterator<Item = Range<usize>> + use<> {
        let Self { rows, all, .. } = *self;
        (0..all.div_ceil(rows)).map(move |band| band * rows..(band * rows + rows).min(all))
    }

    /// Splits the values of all cells by band.
    #[inline]
    pub fn cut<'a, T>(&self, values: &'a [T]) -> Chunks<'a, T> {
        values.chunks(self.rows * self.columns)
    }

    /// Splits the mutable values of all cells by band.
    #[inline]
    pub fn cut_mut<'a, T>(&self, values: &'a mut [T]) -> ChunksMut<'a, T> {
        values.chunks_mut(self.rows * self.columns)
    }

    /// Returns the first cell of a band.
    #[inline]
    pub fn first(&self, band: usize) -> usize {
        band * self.rows * self.columns
    }
}
