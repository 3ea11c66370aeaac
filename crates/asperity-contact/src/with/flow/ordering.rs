//! The order in which the cells of a network are eliminated.

use super::faces::Network;
use crate::math::{self, Dissection, Front};

/// No number: the cell is not solved for.
const NONE: u32 = u32::MAX;

/// The order of elimination, and the fronts in which it is done.
pub(super) struct Ordering {
    /// The cell of each number.
    pub(super) cells: Vec<u32>,
    /// Fronts, children before their parents.
    pub(super) fronts: Vec<Front>,
}

impl Ordering {
    /// Orders the cells of the network that are `wanted`.
    pub(super) fn new(network: &Network, wanted: &[bool], periodic: [bool; 2]) -> Self {
        let Dissection { cells, mut fronts } = Dissection::new(network.shape, wanted, periodic, [1; 2]);
        find_borders(network, &cells, &mut fronts);
        Self { cells, fronts }
    }
}

/// Finds the borders of the fronts.
fn find_borders(network: &Network, cells: &[u32], fronts: &mut [Front]) {
    let mut number = vec![NONE; network.cells()];
    for (n, cell) in cells.iter().enumerate() {
        number[*cell as usize] = n as u32;
    }
    let mut neighbours: Vec<(u32, u32)> = Vec::new();
    for (axis, faces) in network.faces.iter().enumerate() {
        for (cell, _) in faces.iter().enumerate().filter(|(_, face)| **face > 0.0) {
            let (a, b) = (number[cell], number[network.before(cell, axis).0]);
            if a != NONE && b != NONE && a != b {
                neighbours.push((a.min(b), a.max(b)));
            }
        }
    }
    neighbours.sort_unstable();
    let mut at = 0;
    math::find_borders(fronts, |_, front, border| {
        let is_own = |(first, _): &&(u32, u32)| (*first as usize) < front.pivots.end;
        while let Some((_, later)) = neighbours.get(at).filter(is_own) {
            border.push(*later);
            at += 1;
        }
    });
}
