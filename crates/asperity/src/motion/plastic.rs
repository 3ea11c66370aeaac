//! Levelling by plastic flow.

use crate::grid::Field;
use crate::motion::law::{Law, Touching};
use crate::motion::pair::Pair;

/// Levelling by perfectly plastic flow: each cell of both bodies is lowered by its share of the largest plastic interference
/// that it saw on frozen bodies. (The mean over the positions of a pass instead of the largest would take up only a few per
/// cent of it.) Flow is not repeated: passes that one stands for add nothing to it.
#[derive(Debug, Clone, Copy, Default)]
pub struct PlasticFlow;

impl Law for PlasticFlow {
    fn name(&self) -> &str {
        "plastic"
    }

    fn add(&self, pair: &Pair, touching: &Touching, sums: &mut [Vec<Field>; 2]) {
        let [lower, upper] = sums;
        let [lower, upper] = [lower, upper].map(|sums| sums[0].as_slice_mut().expect("standard layout"));
        let cells = touching.cells[0].iter().zip(touching.cells[1]).zip(touching.interference);
        for ((&one, &other), &w) in cells.filter(|(_, w)| **w > 0.0) {
            let [one, other] = [one as usize, other as usize];
            let shares = pair.plastic_shares([one, other]);
            lower[one] = lower[one].max(shares[0] * w);
            upper[other] = upper[other].max(shares[1] * w);
        }
    }

    fn repeats(&self) -> bool {
        false
    }

    fn advance(&self, _: &mut Pair, [lower, upper]: &[Vec<Field>; 2], _: f64) -> [Field; 2] {
        [lower[0].clone(), upper[0].clone()]
    }
}
