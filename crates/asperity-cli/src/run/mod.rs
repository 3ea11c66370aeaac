//! `asperity run`: runs a case, from its surfaces to its figures.

mod columns;
mod display;
mod record;
mod rows;

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use asperity::Error;
use asperity::solver::Device;
use asperity::study;
use asperity::study::{Existing, Results};

use crate::args::Run;
use crate::machine;
use crate::report::{self, Failure, note, print, report_warning};
use crate::signals::Stop;
use crate::{example, place};
use asperity_report::{figures, page};
use display::Display;
pub use record::text;

/// Runs the case of the arguments.
pub(crate) fn run(arguments: &Run) -> report::Outcome {
    let (file, directory) = match (&arguments.case, &arguments.example) {
        (Some(file), _) => (file.clone(), arguments.out.clone().unwrap_or_else(|| beside(file))),
        (None, Some(name)) => {
            let directory = arguments.out.clone().unwrap_or_else(|| PathBuf::from(name));
            (example::unpack(name, &directory.join("case"))?, directory.join("results"))
        }
        (None, None) => unreachable!("the parser asks for one of them"),
    };
    let existing = match (arguments.resume, arguments.overwrite) {
        (true, _) => Existing::Resume,
        (_, true) => Existing::Overwrite,
        _ => Existing::Keep,
    };
    compute(&file, &directory, existing, arguments.device, arguments.quiet)
}

/// Computes the case of a `file`, prints a table of its outcome, draws its figures.
pub(crate) fn compute(
    file: &Path,
    directory: &Path,
    existing: Existing,
    device: Option<Device>,
    is_quiet: bool,
) -> report::Outcome {
    let case = place::case_on(file, "run", device)?;
    machine::demand(&case)?;
    machine::device(&case)?;
    // A contact in one step has no results until it is solved, so Ctrl-C ends it at once.
    let stop = Stop::at_ctrl_c(case.course(1.0).keeps_steps());
    let display = Display::new(is_quiet, &case, (directory, existing), stop.clone());
    let outcome = study::run(&case, study::SurfaceInput::default(), directory, existing, &display);
    let (printed, warned) = display.end();
    if let Err(error) = &outcome
        && (matches!(error, Error::Interrupted) || error.cause_in_step().is_some())
        && let Ok(results) = Results::open(directory)
    {
        // Finished steps get their page; the message reports why no more follow.
        let _ = page::write(&results, &page::path_of(&results));
    }
    // The lock of the directory is held until the figures are written.
    let (summary, writer) = outcome?;
    for warning in summary.warnings.iter().filter(|warning| !warned.contains(warning)) {
        report_warning(warning);
    }
    let tell = |text: &str| if is_quiet { Ok(()) } else { print(text) };
    let results = writer.results();
    let (found, updates) = (results.observations()?, results.updates()?);
    let printed = printed.and_then(|()| tell(&record::text(&case, &summary, &found, &updates)));
    let (wanted, stopped) = (figures::FigureOptions::default(), || stop.asked());
    let (sheet, seen) = page::gathered(results, &wanted, &stopped);
    let write = || page::write_with(results, seen, &page::path_of(results));
    let (page, drawn) = rayon::join(write, || sheet.and_then(figures::Sheet::finish));
    drawn.map_err(|error| match error {
        asperity_report::Error::Figure(error) if error.source.kind() == ErrorKind::Interrupted => {
            Failure::FiguresInterrupted { directory: directory.to_owned() }
        }
        other => other.into(),
    })?;
    page?;
    if !is_quiet {
        note(&format!("results, figures and report.html in {}", directory.display()));
    }
    printed
}

/// Returns the default results directory: `surfaces/disc.toml` → `surfaces/disc-results`; of the case file
/// within results, these.
fn beside(file: &Path) -> PathBuf {
    let folder = file.parent().unwrap_or(Path::new(""));
    if file.file_name().is_some_and(|name| name == "case.toml") && folder.join("case.json").exists() {
        return folder.to_owned();
    }
    let mut name = file.file_stem().unwrap_or_default().to_owned();
    name.push("-results");
    file.with_file_name(name)
}
