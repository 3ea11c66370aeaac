//! `asperity run`: a case from its surfaces to its figures.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use asperity::io::case::{Case, Course};
use asperity::io::engine;
use asperity::io::results::Existing;
use asperity::io::subsurface::SubsurfaceRecord;
use asperity::io::summary::{Outcome, Summary};
use asperity::motion::{PassRecord, Progress, StaticRecord, SweepRecord, Watch};
use asperity::units::{Dimension, format};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::args::Run;
use crate::machine;
use crate::report::{self, Failure, clipped, note, print};
use crate::signals::Stop;
use crate::{example, figures};

/// Runs the case, prints a table of its outcome, draws its figures.
pub(crate) fn run(arguments: &Run) -> report::Outcome {
    let (file, directory) = match (&arguments.case, &arguments.example) {
        (Some(file), _) => (file.clone(), arguments.out.clone().unwrap_or_else(|| beside(file))),
        (None, Some(name)) => {
            let directory = arguments.out.clone().unwrap_or_else(|| PathBuf::from(name));
            (example::unpack(name, &directory.join("case"))?, directory.join("results"))
        }
        (None, None) => unreachable!("the parser asks for one of them"),
    };
    let case = Case::load(&file)?;
    machine::demand(&case)?;
    let existing = match (arguments.resume, arguments.overwrite) {
        (true, _) => Existing::Resume,
        (_, true) => Existing::Overwrite,
        _ => Existing::Keep,
    };
    // Of a contact in one step nothing is there until it is solved: nobody wants to wait for that at Ctrl-C.
    let stop = Stop::at_ctrl_c(case.motion.is_some() || in_steps(&case));
    let display = Display::new(arguments.quiet, &case, stop.clone());
    let outcome = engine::run(&case, &directory, existing, &display);
    let printed = display.clear();
    // The directory stays this run's until the figures are there.
    let (summary, writer) = outcome?;
    for warning in &summary.warnings {
        note(&format!("warning: {}", clipped(warning)));
    }
    let printed = printed.and_then(|()| print(&table(&summary)));
    figures::draw(writer.results(), &figures::Wanted::default(), &|| stop.asked()).map_err(|failure| {
        match failure {
            Failure::Figure(error) if error.source.kind() == ErrorKind::Interrupted => {
                Failure::FiguresInterrupted { directory: directory.clone() }
            }
            other => other,
        }
    })?;
    note(&format!("results and figures in {}", directory.display()));
    printed
}

/// Whether a static contact is computed in increments or points, which are kept one by one.
fn in_steps(case: &Case) -> bool {
    match case.course(1.0) {
        Some(Course::Stages(stages)) => stages.iter().map(|stage| stage.increments).sum::<usize>() > 1,
        Some(Course::Sweep(points)) => points.len() > 1,
        Some(Course::Rolling(_)) | None => false,
    }
}

/// `surfaces/disc.toml` → `surfaces/disc-results`.
fn beside(file: &Path) -> PathBuf {
    let mut name = file.file_stem().unwrap_or_default().to_owned();
    name.push("-results");
    file.with_file_name(name)
}

/// The progress bar on stderr, and the table of a sweep on stdout, which grows with each point.
struct Display {
    bar: ProgressBar,
    began: Instant,
    passes: bool,
    /// What is solved one after the other.
    step: &'static str,
    /// Whether the points of a sweep roll.
    rolls: bool,
    stop: Stop,
    /// What became of the table so far.
    printed: Mutex<report::Outcome>,
}

impl Display {
    fn new(quiet: bool, case: &Case, stop: Stop) -> Self {
        let bar = ProgressBar::with_draw_target(
            None,
            if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() },
        );
        let style = ProgressStyle::with_template("{bar:32.cyan/dim} {msg}").expect("a valid template");
        bar.set_style(style);
        let passes = case.motion.is_some();
        let step = if case.contact.sweep.is_some() { "point" } else { "increment" };
        let (rolls, printed) = (case.friction.is_some(), Mutex::new(Ok(())));
        Self { bar, began: Instant::now(), passes, step, rolls, stop, printed }
    }

    /// Takes the bar away, and says what became of the table.
    fn clear(self) -> report::Outcome {
        self.bar.finish_and_clear();
        self.printed.into_inner().unwrap_or_else(PoisonError::into_inner)
    }

    /// Time left, by the passes done so far; a first pass is taken to need four approaches, a loading has one.
    fn time_left(&self, progress: &Progress) -> Duration {
        let done = (progress.pass - 1) as f64;
        let in_pass = progress.solved as f64 / progress.positions as f64;
        let trials = if self.passes { 4.0f64.max(progress.trial as f64) } else { 1.0 };
        let part = done + (progress.trial as f64 - 1.0 + in_pass) / trials;
        self.began.elapsed().mul_f64((progress.passes as f64 / part.max(1e-3) - 1.0).max(0.0))
    }
}

impl Watch for Display {
    fn at(&self, progress: &Progress) {
        let Progress { pass, passes, trial, solved, positions, load } = *progress;
        self.bar.set_length((passes * positions) as u64);
        self.bar.set_position(((pass - 1) * positions + solved) as u64);
        let seconds = self.time_left(progress).as_secs();
        let place = match self.passes {
            true => format!("pass {pass}/{passes}, approach {trial}, position {solved}/{positions}"),
            false => format!("{} {solved}/{positions}", self.step),
        };
        let load = format(load, Dimension::Force);
        self.bar.set_message(format!("{place}, load {load}, {}:{:02} left", seconds / 60, seconds % 60));
    }

    fn point(&self, record: &SweepRecord) {
        let mut printed = self.printed.lock().unwrap_or_else(PoisonError::into_inner);
        if printed.is_ok() {
            *printed = self.bar.suspend(|| print(&sweep_row(record, self.rolls)));
        }
    }

    fn stop(&self) -> bool {
        self.stop.asked()
    }
}

fn table(summary: &Summary) -> String {
    let contact = match &summary.outcome {
        Outcome::Static(record) => static_table(record),
        // Each row has been printed as it came.
        Outcome::Sweep(_) => String::new(),
        Outcome::Passes(passes) => passes_table(passes, rim(&summary.case)),
    };
    contact + &summary.subsurface.iter().map(stress_line).collect::<String>()
}

fn stress_line(record: &SubsurfaceRecord) -> String {
    let pass = record.pass.map_or(String::new(), |pass| format!("pass {pass}: "));
    let [x, y, z] = record.position.map(|length| format(length, Dimension::Length));
    format!(
        "{pass}largest von Mises stress {} at x = {x}, y = {y}, depth {z}\n",
        format(record.max_von_mises, Dimension::Pressure)
    )
}

fn static_table(record: &StaticRecord) -> String {
    let share = 100.0 * record.contact_area / record.apparent_area;
    let mut rows = vec![
        ("load", format(record.load, Dimension::Force)),
        ("mean pressure", format(record.load / record.apparent_area, Dimension::Pressure)),
        ("approach", format(record.approach, Dimension::Length)),
        ("contact area", format!("{} ({share:.3} %)", format(record.contact_area, Dimension::Area))),
        ("largest pressure", format(record.max_pressure, Dimension::Pressure)),
        ("mean gap", format(record.mean_gap, Dimension::Length)),
        ("elastic energy", format(record.elastic_energy, Dimension::Energy)),
        ("plastic cells", record.plastic_cells.to_string()),
        ("plastic volume", format(record.plastic_volume, Dimension::Volume)),
        ("residual", format!("{:.1e}", record.residual)),
        ("convolutions", format!("{:.1}", record.convolutions)),
    ];
    if let Some(shear) = &record.shear {
        let both = |[x, y]: [f64; 2], scale: f64, dimension| {
            // What rounding leaves of a component that is not there is not worth reading.
            let shown = |value: f64| if value.abs() < 1e-8 * scale.max(x.hypot(y)) { 0.0 } else { value };
            format!("{}, {}", format(shown(x), dimension), format(shown(y), dimension))
        };
        let stick = 100.0 * shear.stick_area / record.contact_area;
        rows.extend([
            ("tangential force", both(shear.tangential_force, record.load, Dimension::Force)),
            ("displacement", both(shear.tangential_displacement, 0.0, Dimension::Length)),
            ("force ratio", format!("{:.6}", shear.force_ratio)),
            ("stick area", format!("{} ({stick:.3} %)", format(shear.stick_area, Dimension::Area))),
            ("largest shear", format(shear.max_shear, Dimension::Pressure)),
            ("dissipation", format(shear.dissipation, Dimension::Energy)),
        ]);
        if let Some(coefficient) = shear.friction_coefficient {
            rows.push(("friction coeff.", format!("{coefficient:.6}")));
        }
        if let Some([x, y]) = shear.creepage {
            rows.push(("creepage", format!("{x:.6e}, {y:.6e}")));
        }
    }
    rows.iter().map(|(name, value)| format!("{name:<17} {value}\n")).collect()
}

/// A line for a point of a sweep, the first under the names of its columns.
fn sweep_row(point: &SweepRecord, rolls: bool) -> String {
    let columns = [
        ("load", format(point.load, Dimension::Force)),
        ("mean pressure", format(point.mean_pressure, Dimension::Pressure)),
        ("approach", format(point.approach, Dimension::Length)),
        ("mean gap", format(point.mean_gap, Dimension::Length)),
        ("area", format!("{:.3} %", 100.0 * point.contact_fraction)),
        ("max pressure", format(point.max_pressure, Dimension::Pressure)),
        ("plastic volume", format(point.plastic_volume, Dimension::Volume)),
        ("stiffness", point.stiffness.map_or("–".to_owned(), |k| format(k, Dimension::Stiffness))),
    ];
    let of_rolling = [
        ("creepage", format!("{:.4e}", point.creepage_x)),
        ("force along x", format(point.tangential_force_x, Dimension::Force)),
    ];
    let columns = || columns.iter().chain(of_rolling.iter().filter(|_| rolls));
    let heads = columns().map(|(head, _)| format!("{head:>15}")).collect::<String>();
    let cells = columns().map(|(_, cell)| format!("{cell:>15}")).collect::<String>();
    let row = format!("{:>5}{cells}\n", point.point);
    if point.point == 1 { format!("point{heads}\n{row}") } else { row }
}

/// The part of the bodies' length that is their rim at free ends; 0 where they have none.
fn rim(case: &serde_json::Value) -> f64 {
    let is_free = case["contact"]["boundary"] == "free";
    case["output"]["rim"].as_f64().filter(|_| is_free).unwrap_or(0.0)
}

/// A line for each pass; what has a rim is told without it.
fn passes_table(passes: &[PassRecord], rim: f64) -> String {
    const HEADS: [&str; 9] = [
        "pass",
        "approach",
        "mean load",
        "mean pressure",
        "max pressure",
        "mean area",
        "plastic volume",
        "Sq lower",
        "Sq upper",
    ];
    let slides = passes.iter().any(|pass| pass.mean_tangential_force != 0.0);
    let friction = |text: String| if slides { format!("{text:>17}\n") } else { "\n".to_owned() };
    let mut text = String::new();
    if rim > 0.0 {
        let over = format!("interior: farther than {rim} of the length from free ends");
        text = format!("{over:>135}\n");
    }
    text.push_str(&HEADS.map(|head| format!("{head:>15}")).concat());
    text.push_str(&friction("friction coeff.".to_owned()));
    for pass in passes {
        let plastic = pass.plastic_volume_lower_interior + pass.plastic_volume_upper_interior;
        let cells = [
            pass.pass.to_string(),
            format(pass.approach, Dimension::Length),
            format(pass.mean_load, Dimension::Force),
            format(pass.mean_pressure, Dimension::Pressure),
            format(pass.max_pressure, Dimension::Pressure),
            format(pass.mean_contact_area_interior, Dimension::Area),
            format(plastic, Dimension::Volume),
            format(pass.sq_lower_interior, Dimension::Length),
            format(pass.sq_upper_interior, Dimension::Length),
        ];
        text.push_str(&cells.map(|cell| format!("{cell:>15}")).concat());
        text.push_str(&friction(format!("{:.6}", pass.friction_coefficient)));
    }
    text
}
