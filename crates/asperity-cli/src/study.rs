//! `asperity study`: many variations of one case, by any number of threads and processes.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use asperity::Error;
use asperity::study::parametric::{self, Computed, Folder, Queue, State, Study, Table, Tally, Task};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::report::{Failure, Outcome, note, print};
use crate::signals::Stop;
use crate::{args, machine, place};
use asperity_report::page;
use asperity_report::words::clipped;

/// More cases than these are computed only on request.
const MANY: usize = 5000;

pub(crate) fn study(arguments: &args::Study) -> Outcome {
    let study = place::study(&arguments.study)?;
    let study = match arguments.cases.device {
        Some(device) => study.on(device)?,
        None => study,
    };
    let directory = arguments.out.clone().unwrap_or_else(|| arguments.study.with_extension(""));
    let study = Folder::number(&directory, study)?;
    let task = arguments.task.unwrap_or(Task::ALL);
    if arguments.list {
        return list(&study, &directory, task);
    }
    if arguments.collect {
        let folder = Folder::open(&directory, &study)?;
        let table = collect(&study, &folder)?;
        return if arguments.cases.quiet { Ok(()) } else { tell(&table, &study, &folder) };
    }
    if study.len() > MANY && !arguments.yes {
        let message = format!("the study has {} cases", study.len());
        return Err(Failure::usage(message, Some("`--yes` computes them, `--list` prints them")));
    }
    study.open_devices()?;
    let folder = Folder::enter(&directory, &study).map_err(|error| changed(error.into()))?;
    foresee(&study, &folder)?;
    compute(&Queue::new(&study, &folder, task, arguments.cases.retry)?, arguments.cases.quiet)
        .map_err(changed)?;
    let tally = Tally::from_states(&folder.states(&study)?);
    if tally.left() == 0 && folder.has_grown(&study)? {
        note(
            "the study has grown since this file was written: its tables are left as they are, and its present file makes them",
        );
    } else if tally.left() == 0 {
        let table = collect(&study, &folder)?;
        if !arguments.cases.quiet {
            tell(&table, &study, &folder)?;
        }
    } else {
        // The results are incomplete, which `--quiet` does not hide.
        note(&format!(
            "{} of {} cases are done, {} have failed, {} are running, {} are left; \
             the process that finishes the last case writes the table, and so does --collect",
            tally.done,
            tally.all(),
            tally.failed,
            tally.running,
            tally.open
        ));
    }
    match tally.failed {
        0 => Ok(()),
        failed => Err(Failure::Cases { failed, all: tally.all() }),
    }
}

/// Names the open cases that will fail because their load is beyond the plastic limit.
fn foresee(study: &Study, folder: &Folder) -> Outcome {
    let mut beyond = Vec::new();
    for (case, error) in study.beyond_plastic_limit() {
        if !folder.is_done(case) && folder.failure(case)?.is_none() {
            beyond.push((case, error));
        }
    }
    if let Some((case, error)) = beyond.first() {
        let others = match beyond.len() {
            1 => String::new(),
            2 => ", and 1 more case".to_owned(),
            all => format!(", and {} more cases", all - 1),
        };
        note(&format!("case {case:04} will fail{others}: {error}: {}", study.text(*case)));
    }
    Ok(())
}

/// Returns the hint for a changed file of the study.
fn changed(failure: Failure) -> Failure {
    match failure {
        Failure::Library(error @ Error::SurfaceChanged { .. }) => Failure::usage(
            error.to_string(),
            Some("bring the file back as it was, or begin the study anew: --out names another directory"),
        ),
        other => other,
    }
}

/// Computes the remaining cases, and reports each of them.
pub(crate) fn compute(queue: &Queue, quiet: bool) -> Outcome {
    if queue.is_empty() {
        return Ok(());
    }
    let stop = Stop::at_ctrl_c(true);
    let bar = bar(queue.len(), quiet);
    let failed = AtomicUsize::new(0);
    let ended = |case: usize, computed: &Computed| {
        if let Computed::Failed(message) = computed {
            let failed = failed.fetch_add(1, Ordering::Relaxed) + 1;
            bar.suspend(|| note(&format!("case {case:04}: {}", clipped(message))));
            bar.set_message(format!(", {failed} failed"));
        }
        bar.inc(1);
    };
    let computed = parametric::compute(queue, machine::available(), &|| stop.asked(), &ended);
    bar.finish_and_clear();
    computed.map_err(|error| match error {
        Error::Interrupted => Failure::StudyInterrupted,
        error => error.into(),
    })
}

/// Writes the table and the page of the finished cases of a study, and returns the table.
///
/// # Errors
/// [`Error::NotThisStudy`] if the study has grown beyond this file of it; [`Error::File`].
pub fn collect(study: &Study, folder: &Folder) -> asperity::Result<Table> {
    if folder.has_grown(study)? {
        let what = "has grown: its plan has cases that this study file does not have";
        return Err(Error::NotThisStudy { path: folder.path().to_owned(), what });
    }
    let table = Table::collect(study, folder)?;
    let path = |name: &str| folder.path().join(name);
    table.write_csv(&path("table.csv"))?;
    page::write_study(study, &table, &path("study.html"))?;
    Ok(table)
}

/// Prints the answers of a study, and how many of its cases are done.
fn tell(table: &Table, study: &Study, folder: &Folder) -> Outcome {
    print(&page::answers_of_study(table))?;
    // A case with a sweep has several rows.
    let cases = || table.rows().chunk_by(|one, other| one.case == other.case);
    let failed = cases().filter(|rows| rows[0].failure.is_some()).count();
    note(&format!(
        "{} of {} cases are done, {failed} have failed; table.csv and study.html in {}",
        cases().count() - failed,
        study.len(),
        folder.path().display()
    ));
    Ok(())
}

/// Prints the cases of a task without results, with the reasons.
fn list(study: &Study, directory: &Path, task: Task) -> Outcome {
    let states = if directory.join("study.json").exists() {
        Folder::open(directory, study)?.states(study)?
    } else {
        vec![State::Open; study.len()]
    };
    let listed = || states.iter().enumerate().filter(|(n, _)| task.has(n + 1));
    let mut text = String::new();
    for (n, state) in listed() {
        let case = n + 1;
        let told = match state {
            State::Done => continue,
            State::Failed(message) => format!("failed   {}", clipped(message).replace('\n', " ")),
            State::Running => "running".to_owned(),
            State::Open => format!("open     {}", study.text(case)),
        };
        let _ = writeln!(text, "{case:04}  {told}");
    }
    let tally = Tally::from_states(listed().map(|(_, state)| state));
    note(&format!(
        "{} of {} cases are done, {} have failed, {} are running, {} are open",
        tally.done,
        tally.all(),
        tally.failed,
        tally.running,
        tally.open
    ));
    print(&text)
}

fn bar(cases: usize, quiet: bool) -> ProgressBar {
    let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    let style = ProgressStyle::with_template("{bar:24.cyan/dim} {pos}/{len} cases{msg}, {eta} left");
    ProgressBar::with_draw_target(Some(cases as u64), target).with_style(style.expect("a valid template"))
}
