//! Tangential stiffness of a contact: a flat punch that is glued to the elastic cells and pushed along them.

use ndarray::{Array2, Zip};

use crate::error::{Error, Result};
use crate::grid::{Field, SingleField};
use crate::operator::CoupledOperator;
use crate::solver::uniform::CellPreconditioner;
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
/// [`Error::NotConverged`].
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
        let (sum, of_axis) = push(operator, &mut preconditioner, elastic, axis, params)?;
        *stiffness = grid.cell_area() * sum;
        stats.iterations += of_axis.iterations;
        stats.convolutions += of_axis.convolutions;
    }
    Ok((Some(stiffness), stats))
}

/// Convolutions of an application of the tangential operator: two tractions, two displacements.
const CONVOLUTIONS: f64 = 2.0;
/// Part of the tolerance to which the sum converges, and the number of last steps that may not change it by more.
const ACCURACY: f64 = 0.1;
const LAST_STEPS: usize = 2;

/// Solves for the shear that displaces the cells by 1 along an axis, by preconditioned conjugate gradients. Returns its sum
/// along this axis.
fn push(
    operator: &mut dyn CoupledOperator,
    preconditioner: &mut CellPreconditioner,
    elastic: &Array2<bool>,
    axis: usize,
    params: &Params,
) -> Result<(f64, Stats)> {
    let grid = *operator.grid();
    let zeros = || [grid.zeros(), grid.zeros()];
    let mask = elastic.mapv(|is_elastic| f64::from(u8::from(is_elastic)));
    let (mut shear, mut direction, mut response) = (zeros(), zeros(), zeros());
    let mut residual = zeros();
    residual[axis].assign(&mask);
    let mut single = SingleField::zeros(grid.shape);
    let mut preconditioned = [SingleField::zeros(grid.shape), SingleField::zeros(grid.shape)];
    let dot = |a: &[Field; 2], b: &[Field; 2]| (&a[0] * &b[0]).sum() + (&a[1] * &b[1]).sum();
    let (mut before, mut added) = (f64::INFINITY, [f64::INFINITY; LAST_STEPS]);
    let mut stats = Stats::default();
    while residual.iter().flatten().any(|r| *r != 0.0)
        && added.iter().sum::<f64>() > ACCURACY * params.tolerance * shear[axis].sum()
    {
        if stats.iterations >= params.max_convolutions {
            let residual = added.iter().sum::<f64>() / shear[axis].sum();
            let Stats { iterations, .. } = stats;
            return Err(Error::NotConverged { iterations, residual, tolerance: ACCURACY * params.tolerance });
        }
        let mut product = 0.0;
        for (r, z) in residual.iter().zip(&mut preconditioned) {
            preconditioner.apply(r, &mut single, z);
            product += Zip::from(r).and(&*z).fold(0.0, |sum, r, z| sum + r * f64::from(*z));
        }
        let beta = product / before;
        before = product;
        for (d, z) in direction.iter_mut().zip(&preconditioned) {
            d.zip_mut_with(z, |d, z| *d = f64::from(*z) + beta * *d);
        }
        let [u, v] = response.each_mut();
        operator.apply([Some(&direction[0]), Some(&direction[1]), None], [Some(u), Some(v), None]);
        let step = product / dot(&direction, &response);
        for (shear, direction) in shear.iter_mut().zip(&direction) {
            shear.scaled_add(step, direction);
        }
        for (residual, response) in residual.iter_mut().zip(&response) {
            Zip::from(residual).and(response).and(&mask).for_each(|r, u, inside| *r -= step * *u * *inside);
        }
        stats.iterations += 1;
        stats.convolutions += CONVOLUTIONS;
        added.rotate_left(1);
        added[LAST_STEPS - 1] = step * product;
    }
    // 2 Σ q·e − qᵀ C q: an error of the second order in the residual.
    Ok((shear[axis].sum() + dot(&shear, &residual), stats))
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
