//! Operators with any boundary on a grid that is divided among ranks.

use std::sync::Arc;

use asperity_base::grid::{Field, Grid, SingleField};
use asperity_base::math::fft::angular_frequency;
use asperity_contact::kernel::{Influence, SharedResponse};

use crate::convolution::SlabConvolution;
use asperity_base::ranks::Slab;
use asperity_base::units::Metre;
use asperity_contact::operator::{Boundary, FreeFamily, Operator, PeriodicFft};

/// A pair loaded on a grid with a slab on each rank. Its results have the bits of [`super::FreeFft`] or
/// [`PeriodicFft`].
///
/// All ranks create it and apply it together. Each rank passes the pressure on its rows and gets their
/// displacement.
pub struct SlabFft {
    slab: Slab,
    /// The grid of the rows of this rank.
    grid: Grid,
    response: SharedResponse,
    boundary: Boundary,
    datum: Metre,
    coefficients: Coefficients,
    convolution: SlabConvolution,
}

/// Displacements of a cell per unit pressure on another.
enum Coefficients {
    /// Displacements by single cells, or by lines of cells.
    Cells(Arc<dyn Influence>),
    /// Displacements by cells that are periodic along both axes, up to [`NEAR`] cells away, and at the
    /// largest distance.
    Periodic(Field, f64),
}

/// Largest distance in cells of coefficients that the solver uses.
const NEAR: usize = 5;

impl SlabFft {
    /// Creates the operator of a `slab` for bodies with this `response`, such as the composite modulus E* of
    /// two half-spaces.
    ///
    /// # Panics
    /// If the boundary is periodic along one axis and the response has no line.
    pub fn new(slab: Slab, response: impl Into<SharedResponse>, boundary: Boundary) -> Self {
        let datum = boundary.datum(&slab.whole_grid());
        Self::with_datum(slab, response.into(), boundary, datum)
    }

    fn with_datum(slab: Slab, response: SharedResponse, boundary: Boundary, datum: Metre) -> Self {
        let (whole, grid) = (slab.whole_grid(), slab.grid());
        let (coefficients, convolution) = if boundary == Boundary::PERIODIC {
            let numbers = |axis: usize, bin| angular_frequency(bin, whole.shape[axis], whole.pitch[axis]);
            let transform = |k, l| response.harmonic_displacement(numbers(0, k), numbers(1, l));
            let mut convolution = SlabConvolution::from_transform(&slab, whole.shape, transform);
            (periodic_coefficients(&slab, &mut convolution), convolution)
        } else {
            let influence: Arc<dyn Influence> = match boundary.line(&whole, datum) {
                None => response.influence(whole.pitch).into(),
                Some(line) => {
                    let influence = response.line_influence(&line, whole.pitch);
                    influence.expect("a response that knows lines").into()
                }
            };
            let padded = boundary.padded(whole.shape);
            let at = |i, j| influence.displacement(i as f64 * whole.pitch[0], j as f64 * whole.pitch[1]);
            let convolution = SlabConvolution::from_values(&slab, padded, at);
            (Coefficients::Cells(influence), convolution)
        };
        Self { slab, grid, response, boundary, datum, coefficients, convolution }
    }

    /// Computes the displacement of a periodic cell by the sum over all its harmonics.
    fn sum_of_harmonics(&self, i: usize, j: usize) -> f64 {
        let Grid { shape: [nx, ny], pitch } = self.slab.whole_grid();
        let harmonics = (0..nx).flat_map(|k| (0..ny).map(move |l| (k, l)));
        let sum: f64 = harmonics
            .map(|(k, l)| {
                let [qx, qy] = [angular_frequency(k, nx, pitch[0]), angular_frequency(l, ny, pitch[1])];
                let phase = qx * i as f64 * pitch[0] + qy * j as f64 * pitch[1];
                self.response.harmonic_displacement(qx, qy) * phase.cos()
            })
            .sum();
        sum / (nx * ny) as f64
    }
}

/// Computes the displacements near a loaded cell, and at the largest distance from it.
fn periodic_coefficients(slab: &Slab, convolution: &mut SlabConvolution) -> Coefficients {
    let [nx, ny] = slab.whole_grid().shape;
    let (mut unit, mut displacement) = (slab.grid().zeros(), slab.grid().zeros());
    if slab.rows().start == 0 {
        unit[[0, 0]] = 1.0;
    }
    convolution.apply(&unit, &mut displacement);
    let own = |i: usize, j: usize| {
        if slab.rows().contains(&i) { displacement[[i - slab.rows().start, j]] } else { 0.0 }
    };
    let mut near = Field::zeros([NEAR.min(nx / 2 + 1), NEAR.min(ny / 2 + 1)]);
    for (i, mut row) in near.outer_iter_mut().enumerate() {
        let part: [f64; NEAR] = std::array::from_fn(|j| if j < row.len() { own(i, j) } else { 0.0 });
        row.iter_mut().zip(slab.merged(part)).for_each(|(value, all)| *value = all);
    }
    let [far] = slab.merged([own(nx / 2, ny / 2)]);
    Coefficients::Periodic(near, far)
}

impl Operator for SlabFft {
    fn grid(&self) -> &Grid {
        &self.grid
    }

    fn slab(&self) -> Slab {
        self.slab.clone()
    }

    fn boundary(&self) -> Boundary {
        self.boundary
    }

    fn harmonic_displacement(&self, qx: f64, qy: f64) -> f64 {
        self.response.harmonic_displacement(qx, qy)
    }

    fn influence(&self, i: usize, j: usize) -> f64 {
        let Grid { shape: [nx, ny], pitch } = self.slab.whole_grid();
        match &self.coefficients {
            Coefficients::Cells(influence) => {
                influence.displacement(i as f64 * pitch[0], j as f64 * pitch[1])
            }
            Coefficients::Periodic(near, far) => {
                let at = [i.min(nx - i), j.min(ny - j)];
                match near.get(at) {
                    Some(value) => *value,
                    None if at == [nx / 2, ny / 2] => *far,
                    None => self.sum_of_harmonics(i, j),
                }
            }
        }
    }

    fn apply(&mut self, pressure: &Field, displacement: &mut Field) {
        self.convolution.apply(pressure, displacement);
    }

    fn apply_single(&mut self, pressure: &SingleField, displacement: &mut SingleField) {
        self.convolution.apply_single(pressure, displacement);
    }

    fn release(&mut self) {
        self.convolution.release();
    }

    fn coarse(&self) -> Box<dyn Operator> {
        let Self { slab, response, boundary, datum, .. } = self;
        let slab = slab.coarse(boundary.coarse(&slab.whole_grid()));
        let grid = slab.whole_grid();
        if !slab.is_whole() {
            Box::new(Self::with_datum(slab, response.clone(), *boundary, *datum))
        } else if *boundary == Boundary::PERIODIC {
            Box::new(PeriodicFft::new(grid, response.clone()))
        } else {
            Box::new(
                FreeFamily::with_datum(grid.pitch, response.clone(), *boundary, *datum).operator(grid.shape),
            )
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_base::ranks::threads::on_ranks;
    use asperity_contact::operator::Edge;
    use ndarray::s;

    /// Result of one process for a grid.
    fn alone(grid: Grid, boundary: Boundary) -> Box<dyn Operator> {
        if boundary == Boundary::PERIODIC {
            Box::new(PeriodicFft::new(grid, 115e9))
        } else {
            Box::new(FreeFamily::new(&grid, 115e9, boundary).operator(grid.shape))
        }
    }

    const BOUNDARIES: [Boundary; 4] = [
        Boundary::FREE,
        Boundary::PERIODIC,
        Boundary([Edge::Free, Edge::Periodic]),
        Boundary([Edge::Periodic, Edge::Free]),
    ];

    #[test]
    fn on_any_number_of_ranks_it_has_the_bits_of_one_process() {
        for boundary in BOUNDARIES {
            for (shape, pitch) in [([12, 9], [1.0, 1.0]), ([33, 18], [1e-6, 2e-6]), ([4, 40], [1.0, 0.3])] {
                let grid = Grid::new(shape, pitch).unwrap();
                let pressure = Field::from_shape_fn(shape, |(i, j)| {
                    if (i / 2) % 3 == 1 { 0.0 } else { ((7 * i + 3 * j * j) % 11) as f64 }
                });
                let single = pressure.mapv(|p| p as f32);
                let (mut double_of_one, mut single_of_one) = (grid.zeros(), SingleField::zeros(shape));
                let mut one = alone(grid, boundary);
                one.apply(&pressure, &mut double_of_one);
                one.apply_single(&single, &mut single_of_one);
                for count in 1..=4 {
                    on_ranks(count, |ranks| {
                        let slab = Slab::new(ranks, grid).unwrap();
                        let rows = s![slab.rows(), ..];
                        let own = slab.grid();
                        let mut operator = SlabFft::new(slab.clone(), 115e9, boundary);
                        let (mut double, mut narrow) = (own.zeros(), SingleField::zeros(own.shape));
                        operator.apply(&pressure.slice(rows).to_owned(), &mut double);
                        operator.apply_single(&single.slice(rows).to_owned(), &mut narrow);
                        assert_eq!(double, double_of_one.slice(rows), "{boundary:?}, {count} ranks");
                        assert_eq!(narrow, single_of_one.slice(rows), "{boundary:?}, {count} ranks");
                    });
                }
            }
        }
    }

    #[test]
    fn its_coefficients_are_those_of_one_process() {
        for boundary in BOUNDARIES {
            let grid = Grid::new([12, 15], [1.0, 0.5]).unwrap();
            on_ranks(3, |ranks| {
                let one = alone(grid, boundary);
                let operator = SlabFft::new(Slab::new(ranks, grid).unwrap(), 115e9, boundary);
                let largest = one.influence(0, 0);
                for (i, j) in [(0, 0), (1, 0), (4, 4), (6, 7), (11, 14), (5, 2), (3, 6)] {
                    let error = operator.influence(i, j) - one.influence(i, j);
                    assert!(error.abs() < 1e-14 * largest, "{boundary:?} at {i}, {j}: {error:e}");
                }
                assert_eq!(operator.coarse().grid(), one.coarse().grid(), "small: whole on each rank");
            });
        }
    }
}
