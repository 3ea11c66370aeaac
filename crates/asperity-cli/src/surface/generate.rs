//! `asperity surface generate`.

use asperity::grid::Grid;
use asperity::units::{self, Dimension};

use super::output::Output;
use crate::args::{Generate, Recipe};
use crate::report::{Outcome, note};

pub(super) fn generate(arguments: Generate) -> Outcome {
    let (recipe, target) = arguments.source.recipe();
    let output = Output::new(&target.out.path, target.out.overwrite)?;
    let grid = Grid::new(target.shape.0, target.pitch.0)?;
    let topography = match recipe {
        Recipe::Random(generator, seed) => generator.generate(&grid, seed)?,
        Recipe::Form(form) => form.on(&grid)?,
    };
    output.write(&topography, Some(grid.pitch))?;
    let [nx, ny] = grid.shape;
    let sq = units::format(topography.sq(), Dimension::Length);
    note(&format!("{}: {nx} × {ny} cells, Sq {sq}", target.out.path.display()));
    Ok(())
}
