//! `asperity surface generate`.

use asperity::grid::Grid;
use asperity::units::{self, Dimension};

use super::output::Output;
use super::read;
use crate::args::{Generate, ReadingArguments};
use crate::machine;
use crate::report::{Outcome, note};

/// Memory of a generation in fields of its size: the spectrum, and margins for nonperiodic surfaces.
const FIELDS: f64 = 4.0;

pub(super) fn generate(arguments: Generate) -> Outcome {
    let (layer, target) = arguments.source.layer();
    let output = Output::new(&target.out, target.overwrite)?;
    let grid = Grid::new(target.shape, target.pitch)?;
    machine::holds(FIELDS * 8.0 * grid.cells() as f64)?;
    let mut topography = layer.on(&grid)?;
    for file in &target.plus {
        let reading = ReadingArguments { pitch: Some(target.pitch), ..ReadingArguments::default() };
        topography = topography.plus(&read(file, &reading)?.topography)?;
    }
    output.write(&topography, Some(grid.pitch))?;
    let [nx, ny] = grid.shape;
    let sq = units::format(topography.sq(), Dimension::Length);
    note(&format!("{}: {nx} × {ny} cells, Sq {sq}", target.out.display()));
    Ok(())
}
