//! The command `asperity`.

use std::process::ExitCode;

fn main() -> ExitCode {
    asperity_cli::main(std::env::args_os()).into()
}
