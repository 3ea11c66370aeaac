//! Cases: what they cost, their runs, their results.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use asperity_base::Choice;
use asperity_base::units::{Dimension, format};
use asperity_contact::motion::{PassRecord, Progress, SweepRecord, UpdateRecord, Watch};
use asperity_report::check::rows;
use asperity_report::draw::Format;
use asperity_report::figures::{self, FigureOptions};
use asperity_report::page;
use asperity_study::{Case, Existing, Results, SurfaceInput, bodies, demand, estimate};
use serde_json::{Value, json};
use web_time::Instant;

use crate::{Failure, Result, files};

/// Memory that a page may take, bytes.
const MEMORY: f64 = 1.5e9;

/// Describes the case of a file before it is run.
pub fn check(case: &str) -> Result<Value> {
    let case = Case::load(Path::new(case))?;
    let demand = demand(&case, &SurfaceInput::default(), 1)?;
    let grids = asperity_study::grids(&case, &SurfaceInput::default())?;
    // The surfaces themselves are prepared only if they fit.
    let coarser = (demand.memory > MEMORY).then(|| {
        let factor = (demand.memory / MEMORY).sqrt().ceil();
        json!({ "pitch": grids[0].pitch.map(|pitch| pitch * factor), "memory": demand.memory / (factor * factor) })
    });
    let mut answer = json!({
        "title": case.title,
        "shapes": grids.map(|grid| grid.shape),
        "pitch": grids[0].pitch,
        "memory": demand.memory,
        "seconds": demand.times().iter().sum::<f64>(),
        "coarser": coarser,
        "one_increment": case.course(1.0).is_one_increment(),
        "rows": [],
        "warnings": [],
    });
    if demand.memory <= MEMORY {
        let bodies = bodies(&case, SurfaceInput::default())?;
        let estimate = estimate(&case, &bodies)?;
        let row = |(name, text): (&str, String)| json!({ "name": name, "text": text });
        answer["rows"] = rows(&case, &bodies, &estimate, &demand).into_iter().map(row).collect();
        answer["warnings"] = estimate.warnings.iter().chain(&estimate.predicted).cloned().collect();
    }
    Ok(answer)
}

/// Runs the case of a file, writes its results into a folder, and returns its summary. `tell` gets each
/// event, and asks to stop by `true`.
pub fn run(case: &str, folder: &str, existing: &str, tell: fn(&Value) -> bool) -> Result<Value> {
    let existing = match existing {
        "keep" => Existing::Keep,
        "overwrite" => Existing::Overwrite,
        "resume" => Existing::Resume,
        other => return Err(Failure::input(format!("`{other}` is not keep, overwrite or resume"))),
    };
    let case = Case::load(Path::new(case))?;
    let (directory, watch) = (Path::new(folder), Listener::new(&case, tell));
    asperity_study::run(&case, SurfaceInput::default(), directory, existing, &watch)?;
    let summary = files::get(&format!("{folder}/summary.json"))?;
    serde_json::from_slice(&summary).map_err(|error| Failure::input(error.to_string()))
}

/// Passes on what happens in a run.
struct Listener {
    tell: fn(&Value) -> bool,
    /// Name of a step of the run.
    step: &'static str,
    /// Number of passes.
    passes: usize,
    stop: AtomicBool,
    /// Time of the last progress.
    told: Mutex<Option<Instant>>,
}

impl Listener {
    fn new(case: &Case, tell: fn(&Value) -> bool) -> Self {
        let step = case.course(1.0).step();
        let passes = case.motion.map_or(1, |motion| motion.passes);
        Self { tell, step, passes, stop: AtomicBool::new(false), told: Mutex::new(None) }
    }

    fn tell(&self, event: &Value) {
        if (self.tell)(event) {
            self.stop.store(true, Ordering::Relaxed);
        }
    }

    fn step(&self, number: usize, of: usize, record: Value) {
        self.tell(&json!({
            "kind": "step", "step": self.step, "number": number, "of": of, "record": record,
        }));
    }

    /// Reports the progress, at most twenty times a second.
    fn progress(&self, part: f64, text: impl FnOnce() -> String) {
        const INTERVAL: Duration = Duration::from_millis(50);
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        if told.is_none_or(|at| at.elapsed() >= INTERVAL) {
            *told = Some(Instant::now());
            self.tell(&json!({ "kind": "progress", "part": part, "text": text() }));
        }
    }
}

impl Watch for Listener {
    fn position(&self, progress: &Progress) {
        let Progress { pass, passes, trial, solved, positions, load, together, .. } = *progress;
        let load = format(load, Dimension::Force);
        if self.step == "pass" {
            let part = solved as f64 / positions as f64;
            self.progress(((pass - 1) as f64 + part) / passes as f64, || match together {
                Some(way) => {
                    format!(
                        "pass {pass}/{passes}, sample of {positions} positions, {:.0} %, load {load}",
                        100.0 * way
                    )
                }
                None => format!(
                    "pass {pass}/{passes}, approach {trial}, position {solved}/{positions}, load {load}"
                ),
            });
            return;
        }
        self.progress(solved as f64 / positions as f64, || {
            format!("{} {solved}/{positions}, load {load}", self.step)
        });
        if self.step == "increment" {
            self.step(solved, positions, Value::Null);
        }
    }

    fn solving(&self, progress: &Progress) {
        let Progress { solved, positions, together, .. } = *progress;
        let way = together.unwrap_or(0.0);
        self.progress((solved as f64 + 0.99 * way) / positions as f64, || match positions {
            1 => format!("contact, {:.0} %", 100.0 * way),
            _ => format!("{} {}/{positions}, {:.0} %", self.step, solved + 1, 100.0 * way),
        });
    }

    fn pass(&self, record: &PassRecord) {
        self.step(record.pass, self.passes, json!(record));
    }

    fn point(&self, record: &SweepRecord) {
        self.step(record.point, 0, json!(record));
    }

    fn update(&self, record: &UpdateRecord) {
        self.step(record.update, 0, json!(record));
    }

    fn warning(&self, warning: &str) {
        self.tell(&json!({ "kind": "warning", "text": warning }));
    }

    fn stop(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

/// Writes the page of the results in a folder.
pub fn report(folder: &str) -> Result {
    page::make(Path::new(folder), None)?;
    Ok(())
}

/// Names of the figures of the results in a folder.
pub fn figures(folder: &str) -> Result<Value> {
    let results = Results::open(Path::new(folder))?;
    let none = FigureOptions { only: vec![String::new()], ..FigureOptions::default() };
    let sheet = figures::gathered(&results, &none, &|| false)?;
    Ok(sheet.names().iter().filter(|name| !name.contains('.')).cloned().collect())
}

/// Draws a figure of the results in a folder, and returns its file.
pub fn figure(folder: &str, name: &str, format: &str) -> Result<Vec<u8>> {
    let results = Results::open(Path::new(folder))?;
    let mut wanted = FigureOptions { only: vec![name.to_owned()], ..FigureOptions::default() };
    let formats = [Format::Png, Format::Svg, Format::Pdf];
    let chosen = formats.into_iter().find(|each| each.word() == format);
    wanted.paper.format =
        chosen.ok_or_else(|| Failure::input(format!("`{format}` is not png, svg or pdf")))?;
    let drawn = figures::draw(&results, &wanted, &|| false)?;
    let path = drawn.first().ok_or_else(|| Failure::input(format!("no figure `{name}` of these results")))?;
    files::get(&path.to_string_lossy())
}
