//! The command `asperity`, for programs that bundle it.

mod args;
mod check;
mod command;
mod example;
mod from_map;
mod joint;
mod machine;
mod maps;
mod materials;
mod page;
mod pair;
mod paper;
mod place;
mod plot;
mod report;
mod run;
mod signals;
mod study;
mod surface;
mod threads;
mod verify;

use std::ffi::OsString;

use clap::Parser;

pub use asperity_report::page::joint_in_words;
pub use asperity_report::page::make as write_report;
use command::{Arguments, Command};
pub use joint::write_joint;
pub use machine::{available as available_memory, name as machine_name, on_machine as memory_of_machine};
pub use report::{Program, print_data, report_error, report_warning};
pub use run::text as text_of_results;
pub use signals::survive_size_limit;
pub use study::collect as collect_study;
pub use threads::MAX_THREADS;
pub use verify::{
    expected as verification_expects, text as verification_text, verdict as verification_verdict,
};

/// Runs the command with these `arguments`, the first of which is its name. Returns its exit code: 0 for
/// success, 1 if the computation failed, 2 for bad input, 130 after Ctrl-C.
///
/// It is the main function of a process. It prints, handles Ctrl-C, configures the threads of the process,
/// and ends the process after `--help` or an invalid argument.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    signals::survive_size_limit();
    match command(arguments) {
        Ok(()) => 0,
        Err(failure) => {
            report::report(&failure, report::Program::Command);
            report::exit_code(&failure)
        }
    }
}

fn command(arguments: impl IntoIterator<Item = OsString>) -> report::Outcome {
    let command = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments.command,
        Err(error) => return command::unparsed(&error),
    };
    threads::start(match &command {
        Command::Run(arguments) => arguments.threads,
        Command::Study(arguments) => arguments.cases.threads,
        Command::Joint(arguments) => arguments.cases.threads,
        Command::Contact(arguments) => arguments.writing.threads,
        Command::Slide(arguments) => arguments.writing.threads,
        _ => None,
    })?;
    match command {
        Command::Contact(arguments) => pair::contact(&arguments),
        Command::Slide(arguments) => pair::slide(&arguments),
        Command::Init(arguments) => pair::init(&arguments),
        Command::Materials(arguments) => materials::materials(&arguments),
        Command::Completions(arguments) => command::completions(&arguments),
        Command::Man => command::man(),
        Command::Run(arguments) => run::run(&arguments),
        Command::Study(arguments) => study::study(&arguments),
        Command::Joint(arguments) => joint::joint(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::Example(arguments) => example::example(&arguments),
        Command::Surface(arguments) => surface::surface(arguments),
        Command::FromMap(arguments) => arguments.run(),
        Command::Plot(arguments) => plot::plot(&arguments),
        Command::Report(arguments) => page::report(&arguments),
        Command::Verify => verify::verify(),
        Command::Paper(arguments) => paper::paper(&arguments),
    }
}
