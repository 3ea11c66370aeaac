//! Heights of a body, ready for the page.

use asperity_base::Grid;

use super::quantised::{self, Levels, QuantisedField};
use crate::figures::{HeightRange, StoredArray};

/// Bodies of more cells have no parameters on the page: those of hills and of the autocorrelation would take
/// minutes.
pub(super) const MAX_CELLS: usize = 1 << 18;

/// Heights of a body as they are shown.
pub(super) struct ShownBody {
    heights: Heights,
    pub(super) grid: Grid,
    pub(super) range: [f64; 2],
    pub(super) remark: Option<&'static str>,
    /// Cells along a side of the blocks that are shown.
    pub(super) block: usize,
    pub(super) has_missing: bool,
}

enum Heights {
    Levels(Levels),
    Deflated(QuantisedField),
    /// Under way from one to the other.
    None,
}

impl ShownBody {
    pub(super) fn new(body: &StoredArray, range: Option<HeightRange>) -> Self {
        let (range, remark) = range.unwrap_or(([0.0, 1.0], None));
        Self {
            heights: Heights::Levels(Levels::even(&body.field, body.grid.pitch)),
            grid: body.grid,
            range,
            remark,
            block: quantised::block(&body.field),
            has_missing: body.field.iter().any(|z| !z.is_finite()),
        }
    }

    /// Compresses the heights.
    pub(super) fn deflate(&mut self) {
        self.heights = match std::mem::replace(&mut self.heights, Heights::None) {
            Heights::Levels(levels) => Heights::Deflated(levels.deflated()),
            other => other,
        };
    }

    /// Returns the compressed heights.
    pub(super) fn deflated(mut self) -> QuantisedField {
        self.deflate();
        match self.heights {
            Heights::Deflated(heights) => heights,
            Heights::Levels(_) | Heights::None => unreachable!("they have been deflated"),
        }
    }
}
