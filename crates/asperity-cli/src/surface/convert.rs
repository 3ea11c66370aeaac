//! `asperity surface convert`.

use asperity::surface::Fill;

use super::output::Output;
use super::read;
use crate::args::Convert;
use crate::report::{Outcome, note};

pub(super) fn convert(arguments: &Convert) -> Outcome {
    let output = Output::new(&arguments.output, arguments.overwrite)?;
    let source = read(&arguments.input, &arguments.reading)?;
    let mut topography = source.topography;
    if let Some(window) = arguments.window {
        topography = topography.window(window.0)?;
    }
    if arguments.fill != Fill::None {
        topography = topography.fill(arguments.fill)?;
    }
    topography = topography.level(arguments.level);
    if let Some(shape) = arguments.resample {
        topography = topography.resample_to_shape(shape.0)?;
    }
    output.write(&topography, source.pitch.map(|_| topography.grid().pitch))?;
    let ([nx, ny], undefined) = (topography.grid().shape, topography.undefined());
    note(&format!("{}: {nx} × {ny} cells, {undefined} undefined", arguments.output.display()));
    Ok(())
}
