//! Operators that are computed when they are needed.

use std::cell::OnceCell;

use crate::grid::{Field, Grid, SingleField};
use crate::math::fft::angular_frequency;
use crate::math::parallel;
use crate::operator::{Boundary, Definition, FreeFamily, Operator, PeriodicFft};

/// An operator whose transforms and coefficients are computed when they are first needed. A contact that a
/// device solves needs none of them.
pub struct Deferred {
    definition: Definition,
    made: OnceCell<Box<dyn Operator>>,
}

impl Deferred {
    /// Creates the operator of this definition.
    pub fn new(definition: Definition) -> Self {
        Self { definition, made: OnceCell::new() }
    }

    fn made(&self) -> &dyn Operator {
        self.made.get_or_init(|| make(&self.definition)).as_ref()
    }

    fn made_mut(&mut self) -> &mut dyn Operator {
        self.made();
        self.made.get_mut().expect("just made").as_mut()
    }

    /// Returns the displacement of a cell per unit pressure on itself, without transforms.
    fn own_influence(&self) -> f64 {
        let Definition { grid, boundary, response, .. } = &self.definition;
        if !boundary.leaves_mean_free() {
            return self.definition.influence().displacement(0.0, 0.0);
        }
        // The mean of the displacements of all harmonics, of which those beyond half of the axis y mirror the
        // others.
        let [nx, ny] = grid.shape;
        let rows = parallel::field([nx / 2 + 1, 1], |k, _| {
            let qx = angular_frequency(k, nx, grid.pitch[0]);
            let both = if k == 0 || 2 * k == nx { 1.0 } else { 2.0 };
            let of = |l: usize| {
                let both = if l == 0 || 2 * l == ny { 1.0 } else { 2.0 };
                both * response.harmonic_displacement(qx, angular_frequency(l, ny, grid.pitch[1]))
            };
            both * (0..=ny / 2).map(of).sum::<f64>()
        });
        rows.sum() / grid.cells() as f64
    }
}

fn make(definition: &Definition) -> Box<dyn Operator> {
    let Definition { grid, boundary, response, datum } = definition.clone();
    if boundary.leaves_mean_free() {
        Box::new(PeriodicFft::new(grid, response))
    } else {
        Box::new(FreeFamily::with_datum(grid.pitch, response, boundary, datum).operator(grid.shape))
    }
}

impl Operator for Deferred {
    fn grid(&self) -> &Grid {
        &self.definition.grid
    }

    fn boundary(&self) -> Boundary {
        self.definition.boundary
    }

    fn harmonic_displacement(&self, qx: f64, qy: f64) -> f64 {
        self.definition.response.harmonic_displacement(qx, qy)
    }

    fn influence(&self, i: usize, j: usize) -> f64 {
        match (self.made.get(), [i, j]) {
            (None, [0, 0]) => self.own_influence(),
            _ => self.made().influence(i, j),
        }
    }

    fn apply(&mut self, pressure: &Field, displacement: &mut Field) {
        self.made_mut().apply(pressure, displacement);
    }

    fn apply_single(&mut self, pressure: &SingleField, displacement: &mut SingleField) {
        self.made_mut().apply_single(pressure, displacement);
    }

    fn has_near_copy(&self) -> bool {
        self.made().has_near_copy()
    }

    fn apply_near(&mut self, pressure: &SingleField, displacement: &mut SingleField) {
        self.made_mut().apply_near(pressure, displacement);
    }

    fn release(&mut self) {
        if let Some(made) = self.made.get_mut() {
            made.release();
        }
    }

    fn definition(&self) -> Option<Definition> {
        Some(self.definition.clone())
    }

    fn coarse(&self) -> Box<dyn Operator> {
        Box::new(Self::new(self.definition.coarse()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::SharedResponse;
    use crate::operator::Edge;

    #[test]
    fn the_influence_of_a_cell_on_itself_is_that_of_the_operator() {
        for shape in [[6, 9], [7, 8], [1, 5]] {
            for edges in [[Edge::Free; 2], [Edge::Periodic; 2], [Edge::Periodic, Edge::Free]] {
                let grid = Grid::new(shape, [0.5, 1.0]).unwrap();
                let boundary = Boundary(edges);
                let response = SharedResponse::from(3.0);
                let definition = Definition { grid, boundary, response, datum: boundary.datum(&grid) };
                let (deferred, made) = (Deferred::new(definition.clone()), make(&definition));
                let [own, expected] = [deferred.influence(0, 0), made.influence(0, 0)];
                assert!(
                    (own / expected - 1.0).abs() < 1e-12,
                    "{shape:?}, {boundary:?}: {own} and {expected}"
                );
                assert!(deferred.made.get().is_none(), "no transform was planned");
            }
        }
    }
}
