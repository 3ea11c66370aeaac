//! The command `asperity`.

mod args;
mod check;
mod draw;
mod example;
mod figures;
mod machine;
mod paper;
mod plot;
mod report;
mod run;
mod signals;
mod surface;
mod threads;
mod verify;

use std::process::ExitCode;

use clap::Parser;

use args::{Arguments, Command};

fn main() -> ExitCode {
    signals::survive_size_limit();
    match command() {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            report::report(&failure);
            report::exit_code(&failure).into()
        }
    }
}

fn command() -> report::Outcome {
    let command = match Arguments::try_parse() {
        Ok(arguments) => arguments.command,
        Err(error) => return args::unparsed(&error),
    };
    threads::start(match &command {
        Command::Run(arguments) => arguments.threads.map(usize::from),
        _ => None,
    })?;
    match command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::Example(arguments) => example::example(&arguments),
        Command::Surface(arguments) => surface::surface(arguments),
        Command::Plot(arguments) => plot::plot(&arguments),
        Command::Verify => verify::verify(),
        Command::Paper(arguments) => paper::paper(&arguments),
    }
}
