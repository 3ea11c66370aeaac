//! `asperity report`: a results directory as one HTML page.

use asperity_report::page;

use crate::args::Report;
use crate::place;
use crate::report::{Outcome, note, print};

/// Writes the page of a results directory and prints its path.
pub(crate) fn report(arguments: &Report) -> Outcome {
    let results = place::results(&arguments.directory, "report")?;
    let path = arguments.out.clone().unwrap_or_else(|| page::path_of(&results));
    for missing in page::write(&results, &path)? {
        note(&format!("warning: {missing}; the page does without it"));
    }
    print(&format!("{}\n", path.display()))
}
