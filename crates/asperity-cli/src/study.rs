//! `asperity study`: many cases made of one, by as many threads and processes as there are.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

use asperity::study::many::{Computed, Folder, Queue, State, Study, Table, Task};
use asperity::study::{self, Case, Given};
use asperity::units::format_time;
use asperity::{Error, motion};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::report::{Failure, Outcome, clipped, note, print};
use crate::signals::Stop;
use crate::{args, machine, page, threads};

/// More cases than these are computed only on request.
const MANY: usize = 5000;

pub(crate) fn study(arguments: &args::Study) -> Outcome {
    let study = Study::load(&arguments.study)?;
    let directory = arguments.out.clone().unwrap_or_else(|| arguments.study.with_extension(""));
    let task = arguments.task.unwrap_or(Task::ALL);
    if arguments.list {
        return list(&study, &directory, task);
    }
    if arguments.collect {
        let folder = Folder::open(&directory, &study)?;
        return collect(&study, &folder).map(|table| tell(&table, &study, &folder));
    }
    if study.len() > MANY && !arguments.yes {
        let message = format!("the study has {} cases", study.len());
        return Err(Failure::usage(message, Some("`--yes` computes them, `--list` prints them")));
    }
    let folder = Folder::enter(&directory, &study)?;
    compute(&study, &folder, task, arguments)?;
    let states = folder.states(&study, &machine::worker())?;
    let count = |is: fn(&State) -> bool| states.iter().filter(|state| is(state)).count();
    let failed = count(|state| matches!(state, State::Failed(_)));
    let [open, claimed] =
        [count(|state| *state == State::Open), count(|state| matches!(state, State::Claimed(_)))];
    if open + claimed == 0 {
        let table = collect(&study, &folder)?;
        if !arguments.quiet {
            tell(&table, &study, &folder);
        }
    } else if !arguments.quiet {
        note(&format!(
            "{} of {} cases are done, {failed} have failed, {claimed} are under way elsewhere, {open} are left; \
             who finishes the last makes the tables, as --collect does",
            count(|state| *state == State::Done),
            study.len()
        ));
    }
    match failed {
        0 => Ok(()),
        failed => Err(Failure::Cases { failed, all: study.len() }),
    }
}

/// Computes what is left of a task.
fn compute(study: &Study, folder: &Folder, task: Task, arguments: &args::Study) -> Outcome {
    let queue = Queue::new(study, folder, machine::worker(), task, arguments.retry)?;
    if queue.is_empty() {
        return Ok(());
    }
    let threads = rayon::current_num_threads();
    let at_a_time = threads.min(queue.len());
    let each = threads / at_a_time;
    let shared = Shared {
        stop: Stop::at_ctrl_c(true),
        ended: AtomicBool::new(false),
        failure: Mutex::default(),
        memory: Memory { all: machine::available(), taken: Mutex::default(), given_back: Condvar::new() },
        failed: AtomicUsize::new(0),
        bar: bar(queue.len(), arguments.quiet),
    };
    thread::scope(|scope| {
        for _ in 0..at_a_time {
            scope.spawn(|| {
                let worked = threads::some(each).and_then(|pool| pool.install(|| work(&queue, &shared)));
                if let Err(failure) = worked {
                    shared.ended.store(true, Ordering::Relaxed);
                    locked(&shared.failure).get_or_insert(failure);
                }
            });
        }
    });
    shared.bar.finish_and_clear();
    shared.failure.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(()), Err)
}

/// One case after the other.
fn work(queue: &Queue, shared: &Shared) -> Outcome {
    while !motion::Watch::stop(shared) {
        let Some(turn) = queue.claim()? else { return Ok(()) };
        let case = turn.case();
        let computed = turn.compute(|case| shared.memory.take(case), shared);
        match computed.map_err(|error| {
            if let Error::Interrupted = error { Failure::StudyInterrupted } else { error.into() }
        })? {
            Computed::Done | Computed::Elsewhere => {}
            Computed::Failed(message) => {
                let failed = shared.failed.fetch_add(1, Ordering::Relaxed) + 1;
                shared.bar.suspend(|| note(&format!("case {case:04}: {}", clipped(&message))));
                shared.bar.set_message(format!(", {failed} failed"));
            }
        }
        shared.bar.inc(1);
    }
    if shared.stop.asked() { Err(Failure::StudyInterrupted) } else { Ok(()) }
}

/// What the threads have in common.
struct Shared {
    stop: Stop,
    /// Whether one of them cannot go on.
    ended: AtomicBool,
    failure: Mutex<Option<Failure>>,
    memory: Memory,
    failed: AtomicUsize,
    bar: ProgressBar,
}

impl motion::Watch for Shared {
    fn at(&self, _: &motion::Progress) {}

    fn stop(&self) -> bool {
        self.stop.asked() || self.ended.load(Ordering::Relaxed)
    }
}

/// The memory of the machine, of which cases that are computed at the same time take their parts.
struct Memory {
    all: f64,
    taken: Mutex<f64>,
    given_back: Condvar,
}

/// The part of a case.
struct Part<'m> {
    memory: &'m Memory,
    bytes: f64,
}

impl Memory {
    /// What the case takes, once it is free; an error if it never will be.
    fn take(&self, case: &Case) -> asperity::Result<Part<'_>> {
        let demand = study::demand(case, &Given::default(), rayon::current_num_threads())?;
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

/// Makes the tables of what is there.
fn collect(study: &Study, folder: &Folder) -> Outcome<Table> {
    let table = Table::collect(study, folder)?;
    let path = |name: &str| folder.path().join(name);
    table.write_csv(&path("table.csv"))?;
    table.write_hdf5(&path("table.h5"))?;
    page::write_study(study, &table, &path("study.html"))?;
    Ok(table)
}

fn tell(table: &Table, study: &Study, folder: &Folder) {
    let failed = table.rows().iter().filter(|row| row.failure.is_some()).count();
    note(&format!(
        "{} of {} cases are done, {failed} have failed; table.csv, table.h5 and study.html in {}",
        table.rows().len() - failed,
        study.len(),
        folder.path().display()
    ));
}

/// Prints the cases of a task that have no results, and why not.
fn list(study: &Study, directory: &Path, task: Task) -> Outcome {
    let states = match directory.join("study.json").exists() {
        true => Folder::open(directory, study)?.states(study, &machine::worker())?,
        false => vec![State::Open; study.len()],
    };
    let mut text = String::new();
    let mut counts = [0; 4];
    for (n, state) in states.iter().enumerate().filter(|(n, _)| task.has(n + 1)) {
        let case = n + 1;
        let (kind, told) = match state {
            State::Done => (0, None),
            State::Failed(message) => (1, Some(format!("failed   {}", clipped(message).replace('\n', " ")))),
            State::Claimed(holder) => {
                let process = holder.worker.as_ref().map_or("", |worker| &worker.process);
                let age = format_time(holder.age.as_secs_f64());
                let gone = if holder.is_stale { ", gone" } else { "" };
                (2, Some(format!("claimed  {process}, {age} ago{gone}")))
            }
            State::Open => (3, Some(format!("open     {}", study.text(case)))),
        };
        counts[kind] += 1;
        if let Some(told) = told {
            let _ = writeln!(text, "{case:04}  {told}");
        }
    }
    let [done, failed, claimed, open] = counts;
    note(&format!(
        "{done} of {} cases are done, {failed} have failed, {claimed} are claimed, {open} are open",
        counts.iter().sum::<usize>()
    ));
    print(&text)
}

fn bar(cases: usize, quiet: bool) -> ProgressBar {
    let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    let style = ProgressStyle::with_template("{bar:24.cyan/dim} {pos}/{len} cases{msg}, {eta} left");
    ProgressBar::with_draw_target(Some(cases as u64), target).with_style(style.expect("a valid template"))
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
