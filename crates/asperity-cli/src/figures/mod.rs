//! The figures of a results directory, drawn from what it holds and from nothing else.

mod flow;
mod friction;
mod loading;
mod motion;
mod pressure;
mod profile;
mod rest;
mod running;
mod sheet;
mod sliding;
mod stored;
mod subsurface;
mod sweep;
#[cfg(test)]
mod tests;

use std::path::PathBuf;

use asperity::study::Results;

use crate::draw::Paper;
use crate::report::Outcome;

pub(crate) use stored::in_frame_of;

/// Which figures are drawn, and how.
#[derive(Debug, Clone, Default)]
pub(crate) struct Wanted {
    /// Paper and kind of file.
    pub(crate) paper: Paper,
    /// Names of the figures; all if there is none.
    pub(crate) only: Vec<String>,
}

/// Draws the figures of `results` into its folder `figures` and returns their paths; an error of the kind `Interrupted`
/// once `stop` says so.
pub(crate) fn draw(
    results: &Results,
    wanted: &Wanted,
    stop: &(dyn Fn() -> bool + Sync),
) -> Outcome<Vec<PathBuf>> {
    let mut sheet = sheet::Sheet::new(results, wanted, stop)?;
    let passes = results.passes()?;
    let of = match passes.is_empty() {
        true => rest::draw(results, &mut sheet)?,
        false => motion::draw(results, &passes, &mut sheet)?,
    };
    let updates = results.updates()?;
    if !updates.is_empty() {
        sliding::draw(&updates, &results.static_fields()?, &of, &mut sheet)?;
    }
    let points = results.sweep()?;
    if !points.is_empty() {
        sweep::draw(&points, &results.case()?, &mut sheet)?;
    }
    if results.case()?.get("subsurface").is_some() {
        let fields = results.subsurface_fields(passes.last().map(|pass| pass.pass))?;
        subsurface::draw(&fields, &of, &mut sheet)?;
    }
    sheet.finish()
}
