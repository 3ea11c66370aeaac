//! `asperity plot`: the figures of a results directory, drawn again.

use asperity::io::results::Results;

use crate::args::Plot;
use crate::figures;
use crate::report::{Outcome, print};

/// Draws the figures and prints their paths.
pub(crate) fn plot(arguments: &Plot) -> Outcome {
    let drawn = figures::draw(&Results::open(&arguments.directory)?, &|| false)?;
    print(&drawn.iter().map(|path| format!("{}\n", path.display())).collect::<String>())
}
