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
mod surface;
mod verify;

use std::process::ExitCode;

use clap::Parser;

use args::{Arguments, Command};

fn main() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::Example(arguments) => example::example(&arguments),
        Command::Surface(arguments) => surface::surface(arguments),
        Command::Plot(arguments) => plot::plot(&arguments),
        Command::Verify => verify::verify(),
        Command::Paper(arguments) => paper::paper(&arguments),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            report::report(&failure);
            report::exit_code(&failure).into()
        }
    }
}
