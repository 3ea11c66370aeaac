//! How plastic deformation changes the geometry.

use crate::grid::Field;
use crate::motion::contact::Contact;
use crate::motion::pair::Pair;
use crate::motion::rim::Interior;
use crate::units::CubicMetre;

/// Volumes that the lower and the upper body lost.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct LostVolume {
    /// All of it.
    pub(super) whole: [CubicMetre; 2],
    /// What their interiors lost.
    pub(super) interior: [CubicMetre; 2],
}

impl LostVolume {
    pub(super) fn add(&mut self, other: &Self) {
        for body in 0..2 {
            self.whole[body] += other.whole[body];
            self.interior[body] += other.interior[body];
        }
    }
}

/// Lowers both bodies by their shares of the plastic interference at one position: `z₁ −= share w`,
/// `z₂ += (1 − share) w`. What they lose together is ΔA Σ w.
pub(super) fn deform_at(pair: &mut Pair, interiors: &[Interior; 2], contact: &Contact) -> LostVolume {
    let share = [pair.plastic_share(), 1.0 - pair.plastic_share()];
    let width = pair.lower.ncols();
    let mut inside = [0.0; 2];
    for &(cell, w) in &contact.plastic {
        let bodies = pair.cells_of_bodies(&contact.position, cell as usize);
        let [lower, upper] = bodies;
        pair.lower[[lower / width, lower % width]] -= share[0] * w;
        pair.upper[[upper / width, upper % width]] += share[1] * w;
        for body in 0..2 {
            if interiors[body].holds(bodies[body]) {
                inside[body] += w;
            }
        }
    }
    LostVolume {
        whole: share.map(|s| s * contact.plastic_volume(pair)),
        interior: [0, 1].map(|body| share[body] * (pair.cell_area() * inside[body])),
    }
}

/// Lowers each cell of both bodies by its share of the largest plastic interference that it saw in a pass of frozen
/// geometry. (The mean over the positions instead of the largest would take up only a few per cent of it.)
pub(super) fn deform_after(pair: &mut Pair, interiors: &[Interior; 2], contacts: &[Contact]) -> LostVolume {
    let mut deepest = [Field::zeros(pair.lower.raw_dim()), Field::zeros(pair.upper.raw_dim())];
    for contact in contacts {
        for &(cell, w) in &contact.plastic {
            let bodies = pair.cells_of_bodies(&contact.position, cell as usize);
            for (deepest, cell) in deepest.iter_mut().zip(bodies) {
                let deepest = &mut deepest.as_slice_mut().expect("standard layout")[cell];
                *deepest = deepest.max(w);
            }
        }
    }
    let share = [pair.plastic_share(), 1.0 - pair.plastic_share()];
    pair.lower.scaled_add(-share[0], &deepest[0]);
    pair.upper.scaled_add(share[1], &deepest[1]);
    LostVolume {
        whole: [0, 1].map(|body| share[body] * pair.cell_area() * deepest[body].sum()),
        interior: [0, 1]
            .map(|body| share[body] * pair.cell_area() * interiors[body].of(&deepest[body]).sum()),
    }
}
