//! Errors as the user sees them: what is wrong, where, and what to do about it; and the exit code.

use std::io::{IsTerminal, Write};

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};
use asperity::Error;
use asperity::error::{CaseError, LoadLimit};
use asperity::units::{self, Dimension};

use crate::draw;

/// Why a command gives up.
#[derive(Debug)]
pub(crate) enum Failure {
    /// What the library found.
    Library(Error),
    /// A figure that could not be drawn.
    Figure(draw::Error),
    /// Closed forms that were missed.
    Checks { failed: usize, all: usize },
    /// The command cannot do what it is asked for.
    Usage { message: String, hint: Option<String> },
}

/// What a command answers; its data have gone to stdout.
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

impl Failure {
    /// A mistake in the use of a command.
    pub(crate) fn usage(message: impl Into<String>, hint: Option<&str>) -> Self {
        Self::Usage { message: message.into(), hint: hint.map(str::to_owned) }
    }
}

/// Writes data to stdout. Where it is closed nobody wants them any more.
pub(crate) fn print(text: &str) {
    let mut stdout = std::io::stdout().lock();
    let _ = stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush());
}

/// Writes a line about what is done to stderr.
pub(crate) fn note(text: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// Writes the error, its place and its hint to stderr.
pub(crate) fn report(failure: &Failure) {
    let stderr = std::io::stderr();
    let colours = stderr.is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty());
    let renderer = if colours { Renderer::styled() } else { Renderer::plain() };
    // Where stderr is closed nobody reads: the exit code remains.
    let _ = writeln!(stderr.lock(), "{}", render(failure, &renderer));
}

/// 1 where the computation failed, 2 where the input is bad, 130 after Ctrl-C.
pub(crate) fn exit_code(failure: &Failure) -> u8 {
    match failure {
        Failure::Library(error) => code(error),
        Failure::Figure(error) => code_of_io(&error.source),
        Failure::Checks { .. } => 1,
        Failure::Usage { .. } => 2,
    }
}

fn code(error: &Error) -> u8 {
    match error {
        Error::BeyondPlasticLimit { .. }
        | Error::BeyondFriction { .. }
        | Error::NotConverged { .. }
        | Error::Memory { .. }
        | Error::LoadNotReached { .. }
        | Error::BeyondPass { .. }
        | Error::PeriodicFullContact { .. } => 1,
        Error::AtPosition { source, .. } => code(source),
        Error::Interrupted => 130,
        Error::File { source, .. } => code_of_io(source),
        _ => 2,
    }
}

fn code_of_io(error: &std::io::Error) -> u8 {
    use std::io::ErrorKind::{
        InvalidData, IsADirectory, NotADirectory, NotFound, PermissionDenied, ReadOnlyFilesystem,
    };
    match error.kind() {
        NotFound | PermissionDenied | ReadOnlyFilesystem | InvalidData | IsADirectory | NotADirectory => 2,
        _ => 1,
    }
}

fn render(failure: &Failure, renderer: &Renderer) -> String {
    let title = match failure {
        Failure::Library(Error::Case(case)) => {
            Level::ERROR.primary_title(case.message.as_str()).element(place(case))
        }
        Failure::Library(other) => Group::with_title(Level::ERROR.primary_title(other.to_string())),
        Failure::Figure(error) => Group::with_title(Level::ERROR.primary_title(error.to_string())),
        Failure::Checks { failed, all } => Group::with_title(
            Level::ERROR.primary_title(format!("{failed} of {all} checks against closed forms failed")),
        ),
        Failure::Usage { message, .. } => Group::with_title(Level::ERROR.primary_title(message.as_str())),
    };
    let hint = match failure {
        Failure::Library(error) => hint(error),
        Failure::Figure(_) | Failure::Checks { .. } => None,
        Failure::Usage { hint, .. } => hint.clone(),
    };
    let hint = hint.map(|hint| Group::with_title(Level::HELP.with_name("hint").secondary_title(hint)));
    match (failure, hint) {
        // Beneath a line of the case the renderer draws the margin on; alone it would lead from nothing.
        (Failure::Library(Error::Case(_)), hint) => {
            renderer.render(&[title].into_iter().chain(hint).collect::<Vec<_>>())
        }
        (_, Some(hint)) => format!("{}\n{}", renderer.render(&[title]), renderer.render(&[hint])),
        (_, None) => renderer.render(&[title]),
    }
}

/// The faulty line, or the file alone where something is missing from it as a whole.
fn place(case: &CaseError) -> annotate_snippets::Element<'_> {
    let file = case.file.to_string_lossy();
    if case.span == (0..0) {
        return Origin::path(file).into();
    }
    let annotation = AnnotationKind::Primary.span(case.span.clone());
    Snippet::source(case.text.as_str()).path(file).annotation(annotation).into()
}

fn hint(error: &Error) -> Option<String> {
    use std::io::ErrorKind;
    match error {
        Error::Case(case) => case.hint.clone(),
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
        Error::NotConverged { .. } => {
            Some("raise `tolerance` in [contact], or try another `method` there".to_owned())
        }
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
        Error::AtPosition { source, .. } => hint(source),
        Error::ResultsExist { results: true, .. } => Some(
            "--overwrite replaces them, --resume goes on from them, --out names another directory".to_owned(),
        ),
        Error::ResultsExist { results: false, .. } => Some("--out names another directory".to_owned()),
        Error::OtherCase { .. } => Some("without --resume, --out names another directory".to_owned()),
        Error::NoWarmStart { .. } => Some("--overwrite computes all passes afresh".to_owned()),
        Error::Interrupted => Some("continue with `--resume`".to_owned()),
        Error::File { path, source } => match source.kind() {
            ErrorKind::NotFound if path.extension().is_some_and(|extension| extension == "toml") => {
                Some("`asperity example` lists cases to start from".to_owned())
            }
            ErrorKind::InvalidData => Some("a case file is text in UTF-8".to_owned())
                .filter(|_| path.extension().is_some_and(|extension| extension == "toml")),
            _ => None,
        },
        other => other.hint(),
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use asperity::io::case::Case;

    use super::*;

    fn rendered(text: &str) -> String {
        let error = Case::parse(text, Path::new("case.toml"), Path::new("")).unwrap_err();
        render(&error.into(), &Renderer::plain())
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
    fn other_errors_have_their_hint_and_code() {
        let error = Error::BeyondPlasticLimit { load: 2.0, limit: 0.0123 };
        let error = Failure::from(error);
        let text = render(&error, &Renderer::plain());
        assert!(text.starts_with("error: load 2.000000e0 N exceeds the plastic limit"), "{text}");
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
