//! The end of every model: a body that loses more height than it is long is no longer a surface.

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::motion::law::Law;
use crate::motion::pair::Pair;
use crate::motion::record::{LostVolume, PassRecord, UpdateRecord};
use crate::units::Metre;

/// Checks the bodies after a pass.
///
/// # Errors
/// [`Error::WornAway`].
pub(super) fn check_pass(pair: &Pair, pass: &PassRecord) -> Result<()> {
    check(pair, |body| lost(pair, body, &pass.lost))
}

/// Checks the bodies after an update of a contact that slides in place.
///
/// # Errors
/// [`Error::WornAway`].
pub(super) fn check_update(pair: &Pair, update: &UpdateRecord) -> Result<()> {
    check(pair, |body| lost(pair, body, &update.lost))
}

/// Checks the cells of the bodies after `laws` have changed them.
///
/// # Errors
/// [`Error::WornAway`].
pub(super) fn check_cells(pair: &Pair, laws: &[Box<dyn Law>]) -> Result<()> {
    check(pair, |body| laws.iter().map(|law| law.deepest(pair)[body]).fold(0.0, f64::max))
}

/// Checks the bodies after losses of these depths, by law, with their mean over the cells. The mean follows
/// from the load and the distance, however the pressures change.
///
/// # Errors
/// [`Error::WornAway`].
pub(super) fn check_losses(pair: &Pair, depths: &[[Field; 2]]) -> Result<()> {
    check(pair, |body| depths.iter().map(|depth| depth[body].mean().unwrap_or(0.0)).fold(0.0, f64::max))
}

/// Whether a body loses more than the width of a cell on average by losses of these depths, by law.
pub(super) fn is_deep(pair: &Pair, depths: &[[Field; 2]]) -> bool {
    let width = pair.pitch()[0].min(pair.pitch()[1]);
    depths.iter().flatten().any(|depth| depth.mean().is_some_and(|mean| mean > width))
}

/// Returns [`Error::WornAway`] if the depth that a body loses exceeds the longer side of its grid.
fn check(pair: &Pair, depth: impl Fn(usize) -> Metre) -> Result<()> {
    for (body, grid) in [pair.lower_grid(), pair.upper_grid()].iter().enumerate() {
        let [x, y] = grid.extent();
        let (depth, length) = (depth(body), x.max(y));
        if depth > length {
            return Err(Error::WornAway { body: ["lower", "upper"][body], depth, length });
        }
    }
    Ok(())
}

/// Largest mean depth that a body loses to a law, or grows by.
fn lost(pair: &Pair, body: usize, lost: &[LostVolume]) -> Metre {
    let area = [pair.lower_grid(), pair.upper_grid()][body].area();
    lost.iter().map(|lost| lost.whole[body].abs() / area).fold(0.0, f64::max)
}
