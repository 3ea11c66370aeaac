//! Output during a run: rows of a table on stdout, progress on stderr.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use asperity::motion::{PassRecord, Progress, StepCell, SweepRecord, Watch};
use asperity::study::case::Course;
use asperity::study::{Case, Existing, Results};
use asperity::units::{Dimension, format};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::rows::Rows;
use crate::report::{self, note, print, report_warning};
use crate::signals::Stop;
use asperity_report::page::LivePage;

/// Progress bar, and table that grows with each pass or point.
pub(super) struct Display {
    bar: ProgressBar,
    quiet: bool,
    /// Name of a step of the run.
    step: &'static str,
    stop: Stop,
    table: Mutex<Table>,
    /// Directory of the results.
    directory: PathBuf,
    page: Mutex<LivePage>,
    /// Warnings printed so far.
    warned: Mutex<Vec<String>>,
    /// Where a resumed run continues, until that is printed.
    continues: Mutex<Option<String>>,
}

struct Table {
    rows: Rows,
    /// Result of writing the table so far.
    printed: report::Outcome,
    began: Instant,
    /// Number of passes, points or increments finished in this run, and the end of the last one.
    finished: Option<(usize, Instant)>,
}

impl Display {
    pub(super) fn new(
        quiet: bool,
        case: &Case,
        (directory, existing): (&Path, Existing),
        stop: Stop,
    ) -> Self {
        let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let style = ProgressStyle::with_template("{bar:24.cyan/dim} {msg}").expect("a valid template");
        let bar = ProgressBar::with_draw_target(None, target).with_style(style);
        let step = case.course(1.0).step();
        let earlier = (existing == Existing::Resume).then(|| Results::open(directory).ok()).flatten();
        let rows = Rows::new(case);
        let rows = match &earlier {
            Some(results) => rows.continued(case, results),
            None => rows,
        };
        let table = Table { rows, printed: Ok(()), began: Instant::now(), finished: None };
        let (directory, page) = (directory.to_owned(), Mutex::new(LivePage::begin()));
        let warned = Mutex::default();
        let continues = earlier.filter(|_| !quiet).and_then(|results| continued(case, &results));
        let continues = Mutex::new(continues);
        Self { bar, quiet, step, stop, table: Mutex::new(table), directory, page, warned, continues }
    }

    /// Removes the bar, and returns the result of writing the table, and the warnings printed.
    pub(super) fn end(self) -> (report::Outcome, Vec<String>) {
        self.bar.finish_and_clear();
        let printed = self.table.into_inner().unwrap_or_else(PoisonError::into_inner).printed;
        (printed, self.warned.into_inner().unwrap_or_else(PoisonError::into_inner))
    }

    fn table(&self) -> MutexGuard<'_, Table> {
        self.table.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn add(&self, row: impl FnOnce(&mut Rows) -> String) {
        let mut table = self.table();
        let row = row(&mut table.rows);
        if table.printed.is_ok() && !self.quiet {
            table.printed = self.bar.suspend(|| print(&row));
        }
    }

    /// Estimates the remaining time of `steps`, of which `done` are finished, from the steps of this run;
    /// none before the first.
    fn time_left(&self, done: usize, steps: usize) -> Option<Duration> {
        let table = self.table();
        let (finished, last) = table.finished?;
        let each = last.duration_since(table.began).div_f64(finished as f64);
        Some(each.mul_f64(steps.saturating_sub(done) as f64).saturating_sub(last.elapsed()))
    }

    /// Sets the bar to a part of a total.
    fn show(&self, [part, whole]: [f64; 2]) {
        const FINE: f64 = 1000.0;
        self.bar.set_length((whole * FINE) as u64);
        self.bar.set_position((part * FINE) as u64);
    }

    /// Writes the page of the present results from time to time.
    fn refresh_page(&self) {
        let mut page = self.page.lock().unwrap_or_else(PoisonError::into_inner);
        page.refresh(|| Results::open(&self.directory));
    }

    /// Prints where a resumed run continues, once.
    fn begin(&self) {
        let mut continues = self.continues.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(text) = continues.take() {
            self.bar.suspend(|| note(&text));
        }
    }

    /// Counts a finished step.
    fn finish(&self) {
        let mut table = self.table();
        let finished = table.finished.map_or(0, |(finished, _)| finished);
        table.finished = Some((finished + 1, Instant::now()));
    }
}

/// Describes the finished steps in the results from which a run continues; `None` if there are none.
fn continued(case: &Case, results: &Results) -> Option<String> {
    let course = case.course(1.0);
    let done = match &course {
        Course::Passes(_) => results.passes().ok()?.iter().map(PassRecord::represents).sum(),
        Course::InPlace(_) => results.updates().ok()?.last()?.update,
        Course::Sweep(_) => results.sweep().ok()?.len(),
        Course::Stages(_) | Course::Rolling(_) => results.increments().ok()?.len(),
    };
    (done > 0).then(|| match case.motion {
        Some(motion) if done >= motion.passes => format!("all {done} passes are finished"),
        Some(motion) => format!("continues after pass {done} of {}", motion.passes),
        None => format!("continues after {} {done}", course.step()),
    })
}

impl Watch for Display {
    fn position(&self, progress: &Progress) {
        self.begin();
        let Progress { pass, passes, trial, solved, positions, load, together, .. } = *progress;
        let (place, part, steps) = if self.step == "pass" {
            let place = match together {
                Some(way) => format!("sample of the positions, {:.0} %", 100.0 * way),
                None => format!("approach {trial}, position {solved}/{positions}"),
            };
            let part = solved as f64 / positions as f64;
            // The bar shows the passes. Within a pass it starts again with each approach.
            (format!("pass {pass}/{passes}, {place}"), (pass - 1) as f64 + 0.99 * part, (pass - 1, passes))
        } else {
            self.finish();
            self.refresh_page();
            (format!("{} {solved}/{positions}", self.step), solved as f64, (solved, positions))
        };
        self.show([part, steps.1 as f64]);
        let left = self.time_left(steps.0, steps.1).map(|left| left.as_secs());
        let left =
            left.map_or(String::new(), |seconds| format!(", {}:{:02} left", seconds / 60, seconds % 60));
        self.bar.set_message(format!("{place}, load {}{left}", format(load, Dimension::Force)));
    }

    fn solving(&self, progress: &Progress) {
        self.begin();
        let Progress { solved, positions, load, together, .. } = *progress;
        let way = together.unwrap_or(0.0);
        let place = match positions {
            1 => "contact".to_owned(),
            _ => format!("{} {}/{positions}", self.step, solved + 1),
        };
        self.show([solved as f64 + 0.99 * way, positions as f64]);
        let load =
            if load != 0.0 { format!(", load {}", format(load, Dimension::Force)) } else { String::new() };
        self.bar.set_message(format!("{place}, {:.0} %{load}", 100.0 * way));
    }

    fn cells(&self, cells: &[StepCell]) {
        self.table().rows.set_step_cells(cells);
    }

    fn pass(&self, record: &PassRecord) {
        self.begin();
        // The rows of an earlier run arrive before the first solution.
        if self.bar.length().is_some() {
            self.finish();
        }
        self.add(|rows| rows.pass(record));
        self.refresh_page();
    }

    fn point(&self, record: &SweepRecord) {
        self.begin();
        self.add(|rows| rows.point(record));
        self.refresh_page();
    }

    fn warning(&self, warning: &str) {
        let mut warned = self.warned.lock().unwrap_or_else(PoisonError::into_inner);
        self.bar.suspend(|| report_warning(warning));
        warned.push(warning.to_owned());
    }

    fn stop(&self) -> bool {
        self.stop.asked()
    }
}
