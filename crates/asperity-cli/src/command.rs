//! The commands of `asperity`.

use clap::error::Error;
use clap::{CommandFactory, Parser, Subcommand};

use crate::args::{
    Check, Completions, Contact, Example, Init, Joint, Materials, Paper, Plot, Report, Run, Slide, Study,
    Surface,
};
use crate::from_map::FromMap;
use crate::report::{Failure, Outcome, print, written};

/// Contact of two rough surfaces that press together and move
///
/// A case file describes the two bodies, the load and the motion.
#[derive(Debug, Parser)]
#[command(name = "asperity", version, subcommand_required = true, arg_required_else_help = true)]
#[command(after_help = BEGIN, after_long_help = [BEGIN, EXIT_CODES].concat())]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

const BEGIN: &str = "\
To begin:
  asperity run --example quickstart
  asperity contact DISC.x3p PLATE.x3p --load \"0.5 N\" --material steel --open
  asperity init";

const EXIT_CODES: &str = "

Data go to stdout, all else to stderr.

Exit code:
  0    done; also where the reader of stdout has closed it
  1    the computation failed: not converged, load unreachable, nothing can be written
  2    bad input or usage
  130  interrupted";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Contact(Contact),
    Slide(Slide),
    Init(Init),
    Run(Run),
    Study(Study),
    Joint(Joint),
    Check(Check),
    Example(Example),
    #[command(subcommand)]
    Surface(Surface),
    #[command(flatten)]
    FromMap(FromMap),
    Plot(Plot),
    Report(Report),
    /// Compare the solvers with closed forms
    ///
    /// Prints the errors of each case on successively finer grids, and the order of convergence. The exit
    /// code is 1 if a case fails.
    Verify,
    Materials(Materials),
    Paper(Paper),
    Completions(Completions),
    /// Print the manual page, for `man`
    #[command(after_help = "Example:\n  asperity man > ~/.local/share/man/man1/asperity.1")]
    Man,
}

/// Prints the completions of a shell.
pub(crate) fn completions(arguments: &Completions) -> Outcome {
    let mut text = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "asperity", &mut text);
    print(&String::from_utf8_lossy(&text))
}

/// Prints the manual page, with a section for each command.
pub(crate) fn man() -> Outcome {
    let mut command = Arguments::command();
    command.build();
    let mut text = Vec::new();
    let mut render = |command: clap::Command| clap_mangen::Man::new(command).render(&mut text);
    let rendered =
        render(command.clone()).and_then(|()| command.get_subcommands().cloned().try_for_each(&mut render));
    rendered.map_err(Failure::Stdout)?;
    print(&String::from_utf8_lossy(&text))
}

/// Prints the requested help, or the error in the arguments.
pub(crate) fn unparsed(error: &Error) -> Outcome {
    if !error.use_stderr() {
        return written(error.print());
    }
    let text = error.render().to_string();
    if text.chars().nth(MAX_CHARACTERS).is_none() {
        error.exit()
    }
    Err(Failure::usage(text.trim_start_matches("error: "), None))
}

/// Longest message about wrong arguments that is shown in full, in characters.
const MAX_CHARACTERS: usize = 2000;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_commands_are_well_formed() {
        Arguments::command().debug_assert();
    }
}
