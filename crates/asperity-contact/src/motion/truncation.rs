//! Truncation of the surfaces at the hardness.

use crate::grid::Field;
use crate::motion::law::{ContactCells, Law};
use crate::motion::pair::Pair;

/// Truncation of the surfaces by perfectly plastic deformation. Each cell of both bodies is lowered by its
/// share of the largest plastic interference during a pass on frozen bodies. The mean over the positions,
/// instead of the largest, would account for only a few per cent of it. Extrapolation over passes does not
/// repeat it.
#[derive(Debug, Clone, Copy, Default)]
pub struct Truncation;

impl Law for Truncation {
    fn name(&self) -> &str {
        "plastic"
    }

    fn add(&self, pair: &Pair, contact_cells: &ContactCells, sums: &mut [Vec<Field>; 2]) {
        if contact_cells.interference.iter().all(|w| *w == 0.0) {
            return;
        }
        let shares = |index: usize| {
            let hardness = [&pair.lower, &pair.upper].map(|body| &body.hardness);
            pair.plastic_shares([0, 1].map(|body| contact_cells.value(body, hardness[body], index)))
        };
        for (body, sums) in sums.iter_mut().enumerate() {
            contact_cells.keep_largest(body, &mut sums[0], |index| match contact_cells.interference[index] {
                0.0 => 0.0,
                w => shares(index)[body] * w,
            });
        }
    }

    fn repeats(&self) -> bool {
        false
    }

    fn advance(&self, _: &mut Pair, [lower, upper]: &[Vec<Field>; 2], _: f64) -> [Field; 2] {
        [lower[0].clone(), upper[0].clone()]
    }
}
