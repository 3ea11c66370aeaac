//! The preconditioner in plain loops.

use asperity_base::grid::Field;
use asperity_base::math::fft::RealFft2;
use asperity_base::math::{ROWS_ABOVE, SparseInverse};

use super::{Set, harmonic, mirrored};
use crate::nodes::{MIN_COVER, Nodes};
use crate::problem::Level;

/// The preconditioner of all contacts on one grid.
pub(super) struct Preconditioner {
    nodes: Nodes,
    transform: RealFft2,
    /// Stiffness of the waves over the nodes, without that of the mean, over the cells for each node.
    stiffness: Field,
    contacts: Vec<Adapted>,
}

/// The preconditioner of a contact on its free cells.
struct Adapted {
    shape: [usize; 2],
    sparse: SparseInverse,
    /// The weight D.
    weight: Field,
}

impl Preconditioner {
    /// Creates the preconditioner from the displacement `influence(i, j)` of a cell by the pressure of
    /// another.
    pub(super) fn new(level: &Level, shapes: &[[usize; 2]], influence: impl Fn(usize, usize) -> f64) -> Self {
        let nodes = Nodes::new(level);
        let stiffness = |k, l| if [k, l] == [0, 0] { 0.0 } else { 1.0 / harmonic(level, [k, l]) };
        let contact = |shape: &[usize; 2]| Adapted {
            shape: *shape,
            sparse: level.sparse_inverse(*shape, &influence),
            weight: Field::zeros(nodes.shape),
        };
        Self {
            nodes,
            transform: RealFft2::new(nodes.shape),
            stiffness: mirrored(nodes.shape, stiffness) / nodes.cells(),
            contacts: shapes.iter().map(contact).collect(),
        }
    }

    /// Adapts to the free cells, with their number.
    pub(super) fn adapt(&mut self, sets: &[Set], free: f64) {
        let of_mean = self.nodes.stiffness_of_mean(free, sets.len() as f64);
        self.stiffness[[0, 0]] = of_mean / self.nodes.cells();
        let mut rest = sets;
        for contact in &mut self.contacts {
            let (own, others) = rest.split_at(contact.shape[0] * contact.shape[1]);
            let is_free = |cell: usize| if own[cell] == Set::Free { 1.0 } else { 0.0 };
            let cover = restrict(&self.nodes, contact.shape, is_free) / self.nodes.cells();
            contact.weight = cover.mapv(|cover| 1.0 / (cover + MIN_COVER));
            rest = others;
        }
    }

    /// Replaces the residual r of the free cells, 0 at the others, by z = M r.
    pub(super) fn apply(&self, sets: &[Set], values: &mut [f64]) {
        let (mut sets, mut values) = (sets, values);
        for contact in &self.contacts {
            let cells = contact.shape[0] * contact.shape[1];
            let (own, others) = std::mem::take(&mut values).split_at_mut(cells);
            self.apply_to(contact, &sets[..cells], own);
            (sets, values) = (&sets[cells..], others);
        }
    }

    fn apply_to(&self, Adapted { shape, sparse, weight }: &Adapted, sets: &[Set], values: &mut [f64]) {
        let [rows, columns] = *shape;
        let is_free = |cell: usize| sets[cell] == Set::Free;
        let restricted = restrict(&self.nodes, *shape, |cell| values[cell]) * weight;
        let mut waves = self.transform.forward(&restricted);
        waves.zip_mut_with(&self.stiffness, |wave, factor| *wave *= *factor);
        let stiff = self.transform.inverse_leading(&waves, self.nodes.shape);
        // The rows before the first one are the last ones of a periodic grid, and after it those that wrap.
        let above = ROWS_ABOVE * columns;
        let mut local = vec![0.0; above + rows * columns];
        for cell in (0..rows * columns).filter(|cell| is_free(*cell)) {
            let smooth = interpolate(&self.nodes, &restricted, [cell / columns, cell % columns]);
            local[above + cell] = (values[cell] - smooth / self.nodes.cells()) as f32;
        }
        let mut image = vec![0.0; local.len()];
        let last = rows * columns;
        if sparse.wraps_rows() {
            local.copy_within(last..last + above, 0);
        }
        let pattern = |cell: usize| sparse.pattern([cell / columns, cell % columns], is_free);
        let free = (0..rows * columns).filter(|cell| is_free(*cell));
        sparse.add(free.map(|cell| (above + cell, pattern(cell))), &local, &mut image);
        if sparse.wraps_rows() {
            (0..above).for_each(|cell| image[last + cell] += image[cell]);
        }
        let local = &image[above..];
        let again = restrict(&self.nodes, *shape, |cell| f64::from(local[cell]));
        let solved = (stiff - again / self.nodes.cells()) * weight;
        for (cell, value) in values.iter_mut().enumerate() {
            let smooth = || interpolate(&self.nodes, &solved, [cell / columns, cell % columns]);
            *value = if is_free(cell) { f64::from((f64::from(local[cell]) + smooth()) as f32) } else { 0.0 };
        }
    }
}

/// Applies Pᵀ: distributes the values of cells to the nodes around them.
fn restrict(nodes: &Nodes, [rows, columns]: [usize; 2], of: impl Fn(usize) -> f64) -> Field {
    let mut sums = Field::zeros(nodes.shape);
    for (i, j) in ndarray::indices([rows, columns]) {
        let ((a, b, s), (c, d, t)) = (nodes.around(0, i), nodes.around(1, j));
        let value = of(i * columns + j);
        sums[[a, c]] += (1.0 - s) * (1.0 - t) * value;
        sums[[a, d]] += (1.0 - s) * t * value;
        sums[[b, c]] += s * (1.0 - t) * value;
        sums[[b, d]] += s * t * value;
    }
    sums
}

/// Applies P: interpolates between the values of the nodes around a cell.
fn interpolate(nodes: &Nodes, values: &Field, [i, j]: [usize; 2]) -> f64 {
    let ((a, b, s), (c, d, t)) = (nodes.around(0, i), nodes.around(1, j));
    let along = |node: usize| (1.0 - t) * values[[node, c]] + t * values[[node, d]];
    (1.0 - s) * along(a) + s * along(b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::{Compliance, Harmonics};

    /// Values between −1 and 1 that look random.
    fn values(count: usize, seed: usize) -> Vec<f64> {
        (0..count).map(|cell| ((cell * 7919 + seed * 104_729) as f64).sin()).collect()
    }

    #[test]
    fn it_is_symmetric_and_positive_definite_on_the_free_cells() {
        let influence = |i: usize, j: usize| if i + j == 0 { 3.5 } else { 1.0 / (i as f64).hypot(j as f64) };
        // Periodic and free axes, grids that nodes do not divide, and two contacts of different shapes.
        for (padded, shapes) in [
            ([40, 27], vec![[40, 27]]),
            ([40, 54], vec![[40, 21], [40, 27]]),
            ([90, 64], vec![[45, 32], [2, 11], [44, 1]]),
            ([5, 4], vec![[5, 4]]),
        ] {
            let level = Level {
                padded,
                pitch: [1.0; 2],
                compliance: Compliance::Influence(Field::zeros([1, 1])),
                harmonics: Harmonics::HalfSpaces(1.0),
            };
            let cells: usize = shapes.iter().map(|[rows, columns]| rows * columns).sum();
            let sets: Vec<Set> = (0..cells)
                .map(|cell| if (cell * 7 + cell / 5 * 3) % 11 < 7 { Set::Free } else { Set::Lower })
                .collect();
            let mut preconditioner = Preconditioner::new(&level, &shapes, influence);
            preconditioner.adapt(&sets, 0.6 * cells as f64);
            let image = |seed: usize| {
                let mut r = values(cells, seed);
                r.iter_mut().zip(&sets).for_each(|(r, set)| *r *= f64::from(u8::from(*set == Set::Free)));
                let mut z = r.clone();
                preconditioner.apply(&sets, &mut z);
                assert!(z.iter().zip(&sets).all(|(z, set)| *set == Set::Free || *z == 0.0));
                [r, z]
            };
            let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            for seed in 0..5 {
                let ([r, z], [s, y]) = (image(seed), image(seed + 9));
                let [own, other] = [product(&r, &z), product(&s, &y)];
                assert!(own > 0.0 && other > 0.0, "{padded:?}");
                let asymmetry = (product(&r, &y) - product(&s, &z)).abs();
                assert!(asymmetry < 1e-5 * own.hypot(other), "{padded:?}: {asymmetry:e} of {own}");
            }
        }
    }
}
