//! Normal stiffness of a contact: a flat punch on the elastic cells.

use ndarray::Array2;

use crate::error::Result;
use crate::grid::Field;
use crate::operator::Operator;
use crate::solver::uniform::{CellPreconditioner, Gradients};
use crate::solver::{Params, Stats};
use crate::units::NewtonPerMetre;

/// Computes the normal stiffness K = dW/dδ of a contact. The `elastic` cells close their gap, and the
/// pressures of all others are constant:
///
/// ```text
/// C_EE p' = 1   on the elastic cells E,   K = ΔA Σ p'
/// ```
///
/// The elastic cells are those with 0 < p < H. The pressure of a cell at the hardness or of an open cell
/// cannot change. Under a periodic boundary δ is the approach of the mean planes of the surfaces, because the
/// mean displacement is 0. In full elastic contact of a period the stiffness is infinite, and none is
/// returned. Under a boundary that is periodic along one axis, δ is relative to the datum of the line. The
/// error of K is about a tenth of the tolerance of `params`.
///
/// Sneddon, Int. J. Eng. Sci. 3, 47 (1965): K = 2 E* a for any axisymmetric contact of radius a.
///
/// # Errors
/// [`Error::NotConverged`](crate::Error::NotConverged).
///
/// # Panics
/// If `elastic` has another shape than the operator's grid.
pub fn normal_stiffness(
    operator: &mut dyn Operator,
    elastic: &Array2<bool>,
    params: &Params,
) -> Result<(Option<NewtonPerMetre>, Stats)> {
    let grid = *operator.grid();
    assert_eq!(elastic.dim(), (grid.shape[0], grid.shape[1]), "shape of the elastic cells");
    if operator.leaves_mean_free() && elastic.iter().all(|is_elastic| *is_elastic) {
        return Ok((None, Stats::default()));
    }
    let preconditioner = CellPreconditioner::alike(operator, elastic);
    let mut gradients = Gradients::preconditioned_by(&grid, elastic, preconditioner, 0);
    gradients.converge(&mut |[q]: &[Field; 1], [u]: &mut [Field; 1]| operator.apply(q, u), params)?;
    Ok((Some(grid.cell_area() * gradients.sum()), gradients.stats))
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::grid::Grid;
    use crate::math::Cholesky;
    use crate::operator::{Boundary, DirectSum, Edge, FreeFamily, PeriodicFft};

    const FINE: Params = Params::new().with_tolerance(1e-10).with_max_convolutions(1000);

    /// Computes ΔA 1ᵀ C_EE⁻¹ 1 by a dense factorisation.
    fn dense(operator: &dyn Operator, elastic: &Array2<bool>) -> f64 {
        let cells: Vec<_> = elastic.indexed_iter().filter(|(_, e)| **e).map(|(cell, _)| cell).collect();
        let influence = |i: usize, j: usize| {
            let ((a, b), (c, d)) = (cells[i], cells[j]);
            operator.influence(a.abs_diff(c), b.abs_diff(d))
        };
        let matrix = Array2::from_shape_fn([cells.len(); 2], |(i, j)| influence(i, j));
        let rates = Cholesky::new(matrix).unwrap().solve(&vec![1.0; cells.len()]);
        operator.grid().cell_area() * rates.iter().sum::<f64>()
    }

    #[test]
    fn it_is_that_of_a_dense_factorisation_on_random_cells() {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        for n in 0..200 {
            let shape = [random.random_range(1..22), random.random_range(1..22)];
            let grid = Grid::new(shape, [1.0, random.random_range(0.5..2.0)]).unwrap();
            let (share, patch) = (random.random_range(0.0..1.0), random.random_range(1..5));
            let patches = Array2::from_shape_fn([22, 22], |_| random.random_bool(share));
            let mut elastic = Array2::from_shape_fn(shape, |(i, j)| patches[[i / patch, j / patch]]);
            let line = Boundary([Edge::Free, Edge::Periodic]);
            let mut operator: Box<dyn Operator> = match n % 3 {
                0 => Box::new(DirectSum::new(grid, 1.7)),
                1 => Box::new(FreeFamily::new(&grid, 1.7, line).operator(shape)),
                _ => Box::new(PeriodicFft::new(grid, 1.7)),
            };
            if operator.boundary().leaves_mean_free() {
                elastic[[0, 0]] = false;
            }
            let (found, _) = normal_stiffness(operator.as_mut(), &elastic, &FINE).unwrap();
            let (found, expected) = (found.unwrap(), dense(operator.as_ref(), &elastic));
            assert!((found - expected).abs() <= 1e-9 * expected.abs(), "{n}: {shape:?} {found} {expected}");
        }
    }

    /// Returns 2 E* a; the edge of the disc of cells is known to half a cell.
    #[test]
    fn a_disc_has_that_of_a_round_punch() {
        let grid = Grid::new([96, 96], [1.0, 1.0]).unwrap();
        let radius = 40.0;
        let elastic =
            Array2::from_shape_fn(grid.shape, |(i, j)| (i as f64 - 47.5).hypot(j as f64 - 47.5) < radius);
        let mut operator = crate::operator::FreeFft::new(grid, 3.0);
        let (found, stats) = normal_stiffness(&mut operator, &elastic, &Params::default()).unwrap();
        let ratio = found.unwrap() / (2.0 * 3.0 * radius);
        assert!((ratio - 1.0).abs() < 0.25 / radius, "{ratio}");
        assert!(stats.iterations <= 12, "{stats:?}");
    }

    #[test]
    fn a_whole_elastic_period_has_no_compliance_and_no_elastic_cell_no_stiffness() {
        let grid = Grid::new([8, 9], [1.0, 1.0]).unwrap();
        let all = Array2::from_elem(grid.shape, true);
        let mut periodic = PeriodicFft::new(grid, 1.0);
        assert_eq!(normal_stiffness(&mut periodic, &all, &FINE).unwrap().0, None);
        let none = !all.clone();
        assert_eq!(normal_stiffness(&mut periodic, &none, &FINE).unwrap().0, Some(0.0));
        let mut free = DirectSum::new(grid, 1.0);
        assert!(normal_stiffness(&mut free, &all, &FINE).unwrap().0.unwrap() > 0.0);
    }
}
