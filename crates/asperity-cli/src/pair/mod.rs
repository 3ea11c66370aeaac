//! `asperity contact`, `asperity slide` and `asperity init`: from two files to a case, and to its results.

mod draft;
mod init;
mod surface;

use std::path::{Path, PathBuf};

use asperity::study::{Existing, SurfaceInput, grids};
use asperity::{Error, io, units};

use crate::args::{Bodies, Contact, PairWriting, ReadingArguments, Slide};
use crate::report::{Failure, Outcome, note};
use crate::{machine, place, run};
use asperity_report::page;
use draft::{Draft, DraftBody};
pub(crate) use init::init;
use surface::FileSurface;

/// Computes the contact of two files at rest.
pub(crate) fn contact(arguments: &Contact) -> Outcome {
    compute(&arguments.bodies, &arguments.reading, &arguments.writing, None)
}

/// Computes passes of one file over another.
pub(crate) fn slide(arguments: &Slide) -> Outcome {
    compute(&arguments.bodies, &arguments.reading, &arguments.writing, Some(arguments.passes))
}

fn compute(
    asked: &Bodies,
    reading: &ReadingArguments,
    writing: &PairWriting,
    passes: Option<u32>,
) -> Outcome {
    let directory = writing.out.clone().unwrap_or_else(|| directory(asked, passes.is_some()));
    let case = directory.join("case.toml");
    if directory.join("case.json").exists() && !writing.overwrite {
        let there = Error::ResultsExist { path: directory, results: true }.to_string();
        return Err(Failure::usage(there, Some("--overwrite replaces them, --out names another directory")));
    }
    if case.exists() && !writing.overwrite {
        let hint = format!("`asperity run {}` computes it, --overwrite replaces it", place::quoted(&case));
        return Err(Failure::usage(format!("`{}` exists", case.display()), Some(&hint)));
    }
    let surfaces = [("lower", &asked.lower), ("upper", &asked.upper)];
    let surfaces = surfaces.map(|(body, file)| FileSurface::read(body, file, reading));
    let [lower, upper] = surfaces;
    let (lower, upper) = (lower?, upper?);
    lower.meets(&upper)?;
    upper.meets(&lower)?;
    let body = |index: usize, surface: &FileSurface| DraftBody {
        material: asked.material.0[index].clone(),
        hardness: asked.hardness.as_ref().map(|hardness| hardness.0[index].clone()),
        topography: surface.keys(&directory),
    };
    let draft = Draft {
        title: format!("{} on {}", name(&asked.upper), name(&asked.lower)),
        bodies: [body(0, &lower), body(1, &upper)],
        load: asked.load.clone(),
        periodic: asked.periodic,
        is_common: !lower.fits(&upper),
        passes,
    };
    let failed = |source| Error::File { path: directory.clone(), source };
    let is_new = !directory.exists();
    let before = [&case, &directory.join("case.json")].map(|path| std::fs::read(path).ok());
    std::fs::create_dir_all(&directory).map_err(failed)?;
    io::replace(&case, draft.text().as_bytes())?;
    let outcome = prepared(&case, [&lower, &upper], writing.quiet).and_then(|()| {
        let existing = if writing.overwrite { Existing::Overwrite } else { Existing::Keep };
        run::compute(&case, &directory, existing, None, writing.quiet)
    });
    let [case_before, results_before] = before;
    if outcome.is_err() && std::fs::read(directory.join("case.json")).ok() == results_before {
        // Nothing has been computed: the next try begins with other arguments, and the case of results that
        // stay is theirs.
        let _ = match case_before {
            Some(text) => io::replace(&case, &text),
            None => std::fs::remove_file(&case).map_err(failed),
        };
        if is_new {
            let _ = std::fs::remove_file(directory.join(".lock"));
            let _ = std::fs::remove_dir(&directory);
        }
    }
    outcome?;
    if !writing.quiet {
        let case = place::quoted(&case);
        note(&format!("the case is {case}: edit it, then `asperity run {case} --overwrite`"));
    }
    if writing.open { show(&directory.join(page::FILE)) } else { Ok(()) }
}

/// Least time of a run that is printed, s.
const LONG: f64 = 60.0;

/// Prints what was done to the surfaces, a line for each, and how long a long run takes.
fn prepared(path: &Path, surfaces: [&FileSurface; 2], is_quiet: bool) -> Outcome {
    if is_quiet {
        return Ok(());
    }
    let case = place::case(path, "run")?;
    let grids = grids(&case, &SurfaceInput::default())?;
    surfaces.into_iter().zip(&grids).for_each(|(surface, grid)| note(&surface.story(grid)));
    let [solving, drawing] = machine::demand(&case)?.times();
    if solving + drawing > LONG {
        let time = units::format_time(solving + drawing);
        note(&format!(
            "this takes about {time}; after Ctrl-C `asperity run {} --resume` goes on",
            place::quoted(path)
        ));
    }
    Ok(())
}

/// Opens a page in the browser.
fn show(page: &Path) -> Outcome {
    open::that_detached(page).map_err(|error| {
        let hint = format!("open {} in a browser", page.display());
        Failure::usage(format!("no browser could be started: {error}"), Some(&hint))
    })
}

/// Name of a file without its folders and its ending.
fn name(file: &Path) -> String {
    file.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// The default directory of the results.
fn directory(asked: &Bodies, moves: bool) -> PathBuf {
    let what = if moves { "slide" } else { "contact" };
    PathBuf::from(format!("{}-{}-{what}", name(&asked.lower), name(&asked.upper)))
}
