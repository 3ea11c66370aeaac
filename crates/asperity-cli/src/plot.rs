//! `asperity plot`: the figures of a results directory, drawn again.

use crate::args::Plot;
use crate::place;
use crate::report::{Failure, Outcome, print};
use asperity_report::figures::{self, FigureOptions};

/// Draws the figures and prints their paths.
pub(crate) fn plot(arguments: &Plot) -> Outcome {
    let Plot { directory, only, overwrite, drawing } = arguments;
    if drawing.range().is_some() && only.is_empty() {
        let hint = Some("name the figure whose range it is: --only pressure");
        return Err(Failure::usage("--range without --only", hint));
    }
    let results = place::results(directory, "plot")?;
    let mut drawn = Vec::new();
    for paper in drawing.papers() {
        let wanted = FigureOptions { paper, only: only.clone(), keep: !overwrite };
        drawn.extend(figures::draw(&results, &wanted, &|| false)?);
    }
    print(&drawn.iter().map(|path| format!("{}\n", path.display())).collect::<String>())
}
