//! `asperity surface convert`.

use super::output::Output;
use super::read_prepared;
use crate::args::Convert;
use crate::report::{Outcome, note};

pub(super) fn convert(arguments: &Convert) -> Outcome {
    let output = Output::new(&arguments.output, arguments.overwrite)?;
    let prepared = read_prepared(&arguments.input)?;
    let topography = prepared.topography;
    output.write(&topography, prepared.pitch)?;
    let ([nx, ny], undefined) = (topography.grid().shape, topography.undefined());
    note(&format!("{}: {nx} × {ny} cells, {undefined} undefined", arguments.output.display()));
    Ok(())
}
