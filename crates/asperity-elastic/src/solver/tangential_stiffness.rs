//! Tangential stiffness of a contact: a flat punch that is glued to the elastic cells and pushed along them.

use ndarray::Array2;

use crate::error::Result;
use crate::grid::Field;
use crate::operator::CoupledOperator;
use crate::solver::uniform::{CellPreconditioner, Gradients};
use crate::solver::{Params, Stats};
use crate::units::NewtonPerMetre;

/// Computes the tangential stiffnesses dQ/du along x and along y of a contact. The `elastic` cells stick, and nothing
/// else bears shear:
///
/// ```text
/// C_EE q' = e   on the elastic cells E,   K = ΔA Σ q'·e,   e the unit vector along x or y
/// ```
///
/// C is the tangential part of the `operator`: the pressures stay, as they do between bodies of one material. Under a
/// periodic boundary u is the displacement of the mean planes. In full contact of a period the stiffness is infinite,
/// and none is returned. The error is about a tenth of the tolerance of `params`.
///
/// Mindlin, J. Appl. Mech. 16, 259 (1949): K = 4 a G/(2 − ν) between two bodies of one material that touch in a circle,
/// 2 (1 − ν)/(2 − ν) of the normal stiffness.
///
/// # Errors
/// [`Error::NotConverged`](crate::Error::NotConverged).
///
/// # Panics
/// If `elastic` has another shape than the operator's grid.
pub fn tangential_stiffness(
    operator: &mut dyn CoupledOperator,
    elastic: &Array2<bool>,
    params: &Params,
) -> Result<(Option<[NewtonPerMetre; 2]>, Stats)> {
    let grid = *operator.grid();
    assert_eq!(elastic.dim(), (grid.shape[0], grid.shape[1]), "shape of the elastic cells");
    let mut stats = Stats::default();
    if operator.normal().leaves_mean_free() && elastic.iter().all(|is_elastic| *is_elastic) {
        return Ok((None, stats));
    }
    let mut preconditioner = CellPreconditioner::alike(operator.normal(), elastic);
    let mut stiffness = [0.0; 2];
    for (axis, stiffness) in stiffness.iter_mut().enumerate() {
        let mut gradients = Gradients::preconditioned_by(&grid, elastic, preconditioner, axis);
        let mut respond = |[x, y]: &[Field; 2], [u, v]: &mut [Field; 2]| {
            operator.apply([Some(x), Some(y), None], [Some(u), Some(v), None]);
        };
        gradients.converge(&mut respond, params)?;
        *stiffness = grid.cell_area() * gradients.sum();
        stats.iterations += gradients.stats.iterations;
        stats.convolutions += gradients.stats.convolutions;
        preconditioner = gradients.preconditioner;
    }
    Ok((Some(stiffness), stats))
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::grid::Grid;
    use crate::material::{Compliances, Material};
    use crate::math::Cholesky;
    use crate::operator::{Boundary, CoupledSum, Operators};
    use crate::solver::normal_stiffness;

    const FINE: Params = Params::new().with_tolerance(1e-10).with_max_convolutions(1000);

    fn compliances(poisson: f64) -> Compliances {
        let body = Material::new(210e9, poisson, f64::INFINITY).unwrap();
        Compliances::new(&body, &body).unwrap()
    }

    #[test]
    fn it_is_that_of_a_dense_factorisation_on_random_cells() {
        let mut random = ChaCha8Rng::seed_from_u64(8);
        for _ in 0..40 {
            let shape = [random.random_range(1..9), random.random_range(1..9)];
            let grid = Grid::new(shape, [1e-6, 1.4e-6]).unwrap();
            let elastic = Array2::from_shape_fn(shape, |_| random.random_bool(0.6));
            let cells: Vec<_> = elastic.indexed_iter().filter(|(_, e)| **e).map(|(cell, _)| cell).collect();
            if cells.is_empty() {
                continue;
            }
            let mut operator = CoupledSum::new(grid, compliances(random.random_range(0.0..0.49)));
            let mut matrix = Array2::zeros([2 * cells.len(); 2]);
            for (j, cell) in cells.iter().enumerate() {
                for axis in 0..2 {
                    let mut unit = [grid.zeros(), grid.zeros()];
                    unit[axis][*cell] = 1.0;
                    let mut response = [grid.zeros(), grid.zeros()];
                    let [u, v] = response.each_mut();
                    operator.apply([Some(&unit[0]), Some(&unit[1]), None], [Some(u), Some(v), None]);
                    for (i, to) in cells.iter().enumerate() {
                        for n in 0..2 {
                            matrix[(2 * i + n, 2 * j + axis)] = response[n][*to];
                        }
                    }
                }
            }
            let dense = Cholesky::new(matrix).unwrap();
            let (found, _) = tangential_stiffness(&mut operator, &elastic, &FINE).unwrap();
            for (axis, found) in found.unwrap().into_iter().enumerate() {
                let right: Vec<f64> =
                    (0..2 * cells.len()).map(|n| f64::from(u8::from(n % 2 == axis))).collect();
                let shear = dense.solve(&right);
                let sum: f64 = shear.iter().skip(axis).step_by(2).sum();
                assert!((found / (grid.cell_area() * sum) - 1.0).abs() < 1e-9, "{shape:?}");
            }
        }
    }

    /// Mindlin: 2 (1 − ν)/(2 − ν) of the normal stiffness, of a circle. The cells of its edge err alike in both.
    #[test]
    fn a_circle_has_the_ratio_of_mindlin() {
        let shape = [64, 64];
        let grid = Grid::new(shape, [1e-6; 2]).unwrap();
        let round = Array2::from_shape_fn(shape, |(i, j)| (i as f64 - 31.5).hypot(j as f64 - 31.5) < 20.0);
        for poisson in [0.0, 0.3, 0.5] {
            let operators = Operators::new(grid, compliances(poisson), Boundary::FREE);
            let mut operator = operators.coupled_on(shape);
            let ([x, y], _) = match tangential_stiffness(&mut *operator, &round, &FINE).unwrap() {
                (Some(stiffness), stats) => (stiffness, stats),
                _ => panic!("a finite stiffness"),
            };
            let normal = normal_stiffness(operator.normal(), &round, &FINE).unwrap().0.unwrap();
            let mindlin = 2.0 * (1.0 - poisson) / (2.0 - poisson);
            assert!((x / normal / mindlin - 1.0).abs() < 2e-3, "{} {mindlin}", x / normal);
            assert!((x / y - 1.0).abs() < 1e-8);
        }
    }

    #[test]
    fn a_period_that_touches_everywhere_has_none() {
        let grid = Grid::new([8, 8], [1e-6; 2]).unwrap();
        let mut operator = Operators::new(grid, compliances(0.3), Boundary::PERIODIC).coupled_on([8, 8]);
        let all = Array2::from_elem([8, 8], true);
        assert_eq!(tangential_stiffness(&mut *operator, &all, &FINE).unwrap().0, None);
    }
}
