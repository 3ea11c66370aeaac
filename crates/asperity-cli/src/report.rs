//! Errors for the user: message, place, hint, and the exit code.

use std::io::{ErrorKind, IsTerminal, Write};
use std::ops::Range;
use std::path::PathBuf;

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};
use asperity::Error;
use asperity::error::{CaseError, LoadLimit};
use asperity::units::{self, Dimension};

use asperity_report::draw;
use asperity_report::words::{MAX_CHARACTERS, MAX_LINES, clipped};

/// Failure of a command.
#[derive(Debug)]
pub(crate) enum Failure {
    /// An error of the library.
    Library(Error),
    /// A figure that could not be drawn.
    Figure(draw::Error),
    /// Failed checks against closed forms.
    Checks { failed: usize, all: usize },
    /// Data that could not be written to stdout.
    Stdout(std::io::Error),
    /// Interrupted figures; the results are complete.
    FiguresInterrupted { directory: PathBuf },
    /// An interrupted study; finished cases stay.
    StudyInterrupted,
    /// Cases of a study that have no results.
    Cases { failed: usize, all: usize },
    /// The command cannot do what was requested.
    Usage { message: String, hint: Option<String> },
}

/// Result of a command, whose data have gone to stdout.
pub(crate) type Outcome<T = ()> = Result<T, Failure>;

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Library(error)
    }
}

impl From<draw::Error> for Failure {
    fn from(error: draw::Error) -> Self {
        Self::Figure(error)
    }
}

impl From<asperity_report::Error> for Failure {
    fn from(error: asperity_report::Error) -> Self {
        match error {
            asperity_report::Error::Results(error) => Self::Library(error),
            asperity_report::Error::Figure(error) => Self::Figure(error),
            asperity_report::Error::Missing { message, hint } => Self::Usage { message, hint },
        }
    }
}

impl Failure {
    /// Creates the failure for a mistake in the use of a command.
    pub(crate) fn usage(message: impl Into<String>, hint: Option<&str>) -> Self {
        Self::Usage { message: message.into(), hint: hint.map(str::to_owned) }
    }
}

/// Writes data to stdout.
pub(crate) fn print(text: &str) -> Outcome {
    let mut stdout = std::io::stdout().lock();
    written(stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()))
}

/// Converts the result of writing to stdout. A closed pipe is not an error.
pub(crate) fn written(result: std::io::Result<()>) -> Outcome {
    match result {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::Stdout(error)),
        _ => Ok(()),
    }
}

/// Writes a note to stderr.
pub(crate) fn note(text: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// The program that reports an error. It determines the options in hints.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Program {
    /// The command `asperity`.
    Command,
    /// A rank of `asperity-mpi`, which resumes nothing.
    Rank(usize),
}

/// Writes an error of the library with its place and its hint to stderr, and returns the exit code: 1 if the
/// computation failed, 2 if the input is bad, 130 if it was interrupted.
pub fn report_error(error: Error, program: Program) -> u8 {
    let failure = Failure::Library(error);
    report(&failure, program);
    exit_code(&failure)
}

/// Writes a warning to stderr, in a paragraph of bounded length.
pub fn report_warning(warning: &str) {
    note(&format!("warning: {}", clipped(warning)));
}

/// Writes data to stdout. A closed pipe is not an error.
///
/// # Errors
/// [`Error::File`].
pub fn print_data(text: &str) -> Result<(), Error> {
    print(text).map_err(|failure| match failure {
        Failure::Stdout(source) => Error::File { path: "standard output".into(), source },
        Failure::Library(error) => error,
        other => unreachable!("printing cannot fail with {other:?}"),
    })
}

/// Writes the error, its place and its hint to stderr.
pub(crate) fn report(failure: &Failure, program: Program) {
    let stderr = std::io::stderr();
    let colours = stderr.is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty());
    let renderer = if colours { Renderer::styled() } else { Renderer::plain() };
    // If stderr is closed, the exit code remains.
    let _ = writeln!(stderr.lock(), "{}", render(failure, program, &renderer));
}

/// Returns 1 if the computation failed, 2 for bad input, 130 after Ctrl-C.
pub(crate) fn exit_code(failure: &Failure) -> u8 {
    match failure {
        Failure::Library(error) => code(error),
        Failure::Figure(error) => code_of_io(&error.source),
        Failure::Checks { .. } | Failure::Cases { .. } | Failure::Stdout(_) => 1,
        Failure::FiguresInterrupted { .. } | Failure::StudyInterrupted => 130,
        Failure::Usage { .. } => 2,
    }
}

fn code(error: &Error) -> u8 {
    match error {
        Error::BeyondPlasticLimit { .. }
        | Error::BeyondFriction { .. }
        | Error::NotConverged { .. }
        | Error::FilmNotConverged { .. }
        | Error::PlasticNotConverged { .. }
        | Error::Memory { .. }
        | Error::DeviceMemory { .. }
        | Error::DeviceFailed { .. }
        | Error::Threads { .. }
        | Error::LoadNotReached { .. }
        | Error::BeyondPass { .. }
        | Error::PeriodicFullContact { .. }
        | Error::PullOff { .. }
        | Error::NotFinite { .. }
        | Error::WornAway { .. } => 1,
        Error::Interrupted => 130,
        Error::File { source, .. } => code_of_io(source),
        _ => error.cause_in_step().map_or(2, code),
    }
}

fn code_of_io(error: &std::io::Error) -> u8 {
    use ErrorKind::{
        InvalidData, InvalidFilename, InvalidInput, IsADirectory, NotADirectory, NotFound, PermissionDenied,
        ReadOnlyFilesystem, UnexpectedEof,
    };
    match error.kind() {
        NotFound | PermissionDenied | ReadOnlyFilesystem | InvalidData | InvalidFilename | InvalidInput
        | IsADirectory | NotADirectory | UnexpectedEof => 2,
        _ => 1,
    }
}

fn render(failure: &Failure, program: Program, renderer: &Renderer) -> String {
    let message = clipped(&message(failure));
    // Most errors occur on all ranks, so only ranks other than the first name themselves.
    let name = match program {
        Program::Command | Program::Rank(0) => "error".to_owned(),
        Program::Rank(rank) => format!("error on rank {rank}"),
    };
    let title = Level::ERROR.with_name(name).primary_title(message.as_str());
    let hint = match failure {
        Failure::Library(error) => hint_on_ranks(error, program).unwrap_or_else(|| hint(error)),
        Failure::FiguresInterrupted { directory } => Some(format!(
            "the results are whole; `asperity plot {} --overwrite` draws the figures",
            directory.display()
        )),
        Failure::StudyInterrupted => Some("the same command goes on".to_owned()),
        Failure::Cases { .. } => Some("`--list` says why, `--retry` computes them again".to_owned()),
        Failure::Figure(_) | Failure::Checks { .. } | Failure::Stdout(_) => None,
        Failure::Usage { hint, .. } => hint.clone(),
    };
    let hint = hint.map(|hint| clipped(&hint));
    let hint = hint.map(|hint| Group::with_title(Level::HELP.with_name("hint").secondary_title(hint)));
    match (failure, hint) {
        // Below a line of the case the renderer continues the margin, which would start nowhere without that
        // line.
        (Failure::Library(Error::Case(case)), hint) => {
            let lines = lines(case);
            let title = title.element(place(case, &lines));
            renderer.render(&[title].into_iter().chain(hint).collect::<Vec<_>>())
        }
        (_, Some(hint)) => {
            format!("{}\n{}", renderer.render(&[Group::with_title(title)]), renderer.render(&[hint]))
        }
        (_, None) => renderer.render(&[Group::with_title(title)]),
    }
}

/// Returns the message.
pub(crate) fn message(failure: &Failure) -> String {
    match failure {
        Failure::Library(Error::Case(case)) => case.message.clone(),
        Failure::Library(other) => other.to_string(),
        Failure::Figure(error) => error.to_string(),
        Failure::Checks { failed, all } => format!("{failed} of {all} checks against closed forms failed"),
        Failure::StudyInterrupted => "interrupted".to_owned(),
        Failure::Cases { failed, all } => format!("{failed} of {all} cases failed"),
        Failure::Stdout(error) => format!("standard output: {error}"),
        Failure::FiguresInterrupted { .. } => "interrupted before all figures were drawn".to_owned(),
        Failure::Usage { message, .. } => message.clone(),
    }
}

/// Returns the lines of the case with the mistake, and their start in its text.
fn lines(case: &CaseError) -> Range<usize> {
    let Range { start, end } = case.span;
    let [start, end] = [start, end.max(start)].map(|at| {
        let mut at = at.min(case.text.len());
        while !case.text.is_char_boundary(at) {
            at -= 1;
        }
        at
    });
    let begin = case.text[..start].rfind('\n').map_or(0, |newline| newline + 1);
    let end = case.text[end..].find('\n').map_or(case.text.len(), |newline| end + newline);
    begin..end
}

/// Returns the faulty lines. If they are too many or too long, or if something is missing from the whole
/// file, returns only the place.
fn place<'a>(case: &'a CaseError, lines: &Range<usize>) -> annotate_snippets::Element<'a> {
    let file = clipped(&case.file.to_string_lossy());
    if case.span == (0..0) {
        return Origin::path(file).into();
    }
    let text = &case.text[lines.clone()];
    if text.lines().count() > MAX_LINES || text.lines().any(|line| line.chars().nth(MAX_CHARACTERS).is_some())
    {
        return Origin::path(file).line(case.line).char_column(case.column).into();
    }
    let span = case.span.start - lines.start..case.span.end.max(case.span.start) - lines.start;
    let annotation = AnnotationKind::Primary.span(span);
    Snippet::source(text).line_start(case.line).path(file).annotation(annotation).into()
}

/// Returns the hint of `asperity-mpi` if that of the command does not apply: it cannot resume, and has one
/// thread.
fn hint_on_ranks(error: &Error, program: Program) -> Option<Option<String>> {
    let Program::Rank(_) = program else { return None };
    Some(match error {
        Error::Memory { .. } => Some(
            "fewer cells take less: `shape` or `resample`; ranks on more machines have more memory together"
                .to_owned(),
        ),
        Error::ResultsExist { results: true, .. } => {
            Some("--overwrite replaces them, --out names another directory".to_owned())
        }
        Error::NotResumable { .. } | Error::OtherRows { .. } => error
            .hint()
            .or_else(|| Some("bring back the file of this run, or compute the contact anew".to_owned())),
        Error::Interrupted => None,
        _ => return None,
    })
}

fn hint(error: &Error) -> Option<String> {
    match error {
        Error::Case(case) => case.hint.clone(),
        // Mistakes in a case are [`Error::Case`]; these files are named by arguments.
        Error::NoChannel { .. } => error.hint().map(|hint| hint.replace("one of them", "one with --channel")),
        Error::CorruptTopography { reason, .. } => error.hint().map(|hint| match reason.option() {
            Some((option, value)) => format!("{hint}: `--{option} {value}`"),
            None => hint,
        }),
        Error::UndefinedSamples { .. } => {
            Some("`--fill nearest` or `--fill harmonic`, a membrane over each hole, fills them".to_owned())
        }
        Error::Memory { .. } => Some(
            "fewer cells take less: `shape` or `resample`; so do fewer threads, and `pressure_every = 0` in [output]"
                .to_owned(),
        ),
        Error::NoDevice { found, .. } => {
            let advice = if found.contains("without the feature") {
                "install the command with `--features cuda`"
            } else {
                "`LD_LIBRARY_PATH` may name the folder of the libraries"
            };
            Some(format!("{advice}; without `device` the processor solves the contact"))
        }
        Error::DeviceMemory { .. } => {
            Some("fewer cells take less: `shape` or `resample`; or leave `device` out".to_owned())
        }
        Error::GridMismatch { .. } => {
            Some("`resample` or `pitch` in a [….topography] brings a body onto another grid".to_owned())
        }
        Error::BeyondPlasticLimit { limit, .. } => Some(format!(
            "give a load below {}, a greater hardness or larger surfaces",
            units::format(*limit, Dimension::Force)
        )),
        Error::BeyondFriction { limit, .. } => Some(format!(
            "give a force below {}, a displacement, or `sliding = [1, 0]` for bodies that slide",
            units::format(*limit, Dimension::Force)
        )),
        Error::PullOff { least, .. } => Some(if *least < 0.0 {
            let least = units::format(*least, Dimension::Force);
            format!("give a load above {least}, or an `approach`, at which the bodies part")
        } else {
            "press the bodies together first, or give an `approach`".to_owned()
        }),
        Error::NotConverged { .. } => {
            Some("raise `tolerance` in [contact], or try another `method` there".to_owned())
        }
        Error::FilmNotConverged { .. } => Some(
            "thin films between rough bodies are the hardest: smooth the shortest waves with an `s_filter`, or give a higher speed or a lower load".to_owned(),
        ),
        Error::PeriodicFullContact { mean_gap, .. } => Some(format!(
            "give an approach below {}, or a load, which also holds in full contact",
            units::format(*mean_gap, Dimension::Length)
        )),
        Error::BeyondPass { most, cause, .. } => Some(format!(
            "give a load below {}, or {}",
            units::format(*most, Dimension::Force),
            match cause {
                LoadLimit::Yielded => "`plastic_update = \"pass\"` in [motion]",
                LoadLimit::FullContact => "`control = \"step-load\"` in [motion], the load at every position",
            }
        )),
        Error::WornAway { .. } => Some(
            "check the law of the body: a `coefficient` is a volume over load and distance, as \"1e-7 mm3/(N m)\", and Archard's number is \
             `dimensionless`; or slide a shorter distance"
                .to_owned(),
        ),
        Error::PlasticNotConverged { .. } => {
            Some("raise `increments` in [plasticity], so that each of them flows less".to_owned())
        }
        Error::ResultsExist { results: true, .. } => Some(
            "--overwrite replaces them, --resume goes on from them, --out names another directory".to_owned(),
        ),
        Error::ResultsExist { results: false, .. }
        | Error::WithinResults { .. }
        | Error::NotThisStudy { .. }
        | Error::InUse { .. } => Some("--out names another directory".to_owned()),
        Error::OtherCase { .. } | Error::SurfaceChanged { .. } | Error::NotResumable { .. } => {
            Some("--overwrite computes all of it anew, --out names another directory".to_owned())
        }
        Error::Threads { .. } => {
            Some("one needs none: `--threads 1`, or RAYON_NUM_THREADS=1 in the environment".to_owned())
        }
        Error::Interrupted => Some("continue with `--resume`".to_owned()),
        Error::File { path, source } => match source.kind() {
            ErrorKind::NotFound if path.extension().is_some_and(|extension| extension == "toml") => {
                Some("`asperity example` lists cases to start from".to_owned())
            }
            ErrorKind::InvalidData => Some("a case file is text in UTF-8".to_owned())
                .filter(|_| path.extension().is_some_and(|extension| extension == "toml")),
            _ => None,
        },
        other => other.cause_in_step().map_or_else(|| other.hint(), hint),
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use asperity::study::Case;

    use super::*;

    fn rendered(text: &str) -> String {
        let error = Case::parse(text, Path::new("case.toml"), Path::new("")).unwrap_err();
        render(&error.into(), Program::Command, &Renderer::plain())
    }

    #[test]
    fn a_mistake_is_shown_where_it_stands() {
        let text = "[lower]\nyoung = \"210 GPa\"\npoisson = 0.3\nhardness = \"2.4 GPb\"\n\n[upper]\n";
        let expected = r#"
error: unknown unit 'GPb' in 'hardness', expected a pressure such as "2.4 GPa"
 --> case.toml:4:12
  |
4 | hardness = "2.4 GPb"
  |            ^^^^^^^^^
  |
hint: did you mean `GPa`?"#;
        assert_eq!(rendered(text), expected.trim_start());
    }

    #[test]
    fn what_is_missing_altogether_names_the_file() {
        assert_eq!(rendered("title = \"x\"\n"), "error: missing table [lower]\n--> case.toml");
    }

    #[test]
    fn a_text_that_ends_too_early_is_shown_to_its_end() {
        assert!(rendered("young = \"210").contains("case.toml:1:13"), "{}", rendered("young = \"210"));
        assert!(rendered("[lower]\nyoung = ").contains("case.toml:2:"), "{}", rendered("[lower]\nyoung = "));
    }

    #[test]
    fn a_message_is_some_lines_whatever_the_input() {
        let key = "k".repeat(1_000_000);
        let long = format!("[lower]\n{key} = 1\n");
        let text = rendered(&long);
        assert!(text.lines().count() < 8 && text.len() < 2000, "{text}");
        assert!(text.starts_with("error: unknown key 'kkk") && text.contains("case.toml:2:1"), "{text}");
        let wide = format!("[lower]\n{}young = 1 GPa\n", "# é\n".repeat(3));
        assert!(rendered(&wide).contains("case.toml:5:9"), "{}", rendered(&wide));
        let deep = format!("[lower]\nyoung = [{}]\n", "1,\n".repeat(5000));
        assert!(rendered(&deep).lines().count() < 8, "{}", rendered(&deep));
        let path = PathBuf::from(format!("/{}/case.toml", "ü".repeat(4000)));
        let text = render(&Error::NoResults { path }.into(), Program::Command, &Renderer::plain());
        assert!(text.len() < 2000 && text.ends_with("(there is no case.json)"), "{text}");
        assert_eq!(clipped("a\u{1b}[2Jb\nc"), "a\\u{1b}[2Jb\nc");
        assert_eq!(clipped(""), "");
        for length in [199, 200, 201, 400, 600, 601] {
            assert!(clipped(&"é".repeat(length)).chars().count() <= 600);
        }
        assert!(clipped(&"a\n".repeat(100)).lines().count() == 1);
    }

    #[test]
    fn other_errors_have_their_hint_and_code() {
        let error = Error::BeyondPlasticLimit { load: 2.0, limit: 0.0123 };
        let error = Failure::from(error);
        let text = render(&error, Program::Command, &Renderer::plain());
        assert!(text.starts_with("error: load 2 N exceeds the plastic limit"), "{text}");
        assert!(
            text.ends_with("\nhint: give a load below 12.3 mN, a greater hardness or larger surfaces"),
            "{text}"
        );
        assert_eq!(exit_code(&error), 1);
        assert_eq!(exit_code(&Error::Interrupted.into()), 130);
        let missing = Case::load(Path::new("nowhere/case.toml")).unwrap_err();
        assert_eq!(exit_code(&missing.into()), 2);
    }
}
