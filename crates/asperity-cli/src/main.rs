//! The command `asperity`.

mod args;
mod check;
#[allow(dead_code, unused_imports, reason = "`run`, `plot` and `paper` will draw the other figures")]
mod draw;
mod example;
mod report;
mod surface;

use std::process::ExitCode;

use clap::Parser;

use args::{Arguments, Command};

fn main() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::Check(arguments) => check::check(&arguments),
        Command::Example(arguments) => example::example(&arguments),
        Command::Surface(arguments) => surface::surface(arguments),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            report::report(&failure);
            report::exit_code(&failure).into()
        }
    }
}
