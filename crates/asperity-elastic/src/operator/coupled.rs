//! Displacement in all directions under traction in all directions.

use std::sync::Arc;

use crate::grid::{Field, Grid, SingleField};
use crate::kernel::{Coefficients, CoupledInfluence, CoupledResponse, CoupledTable, SharedResponse};
use crate::math::fft::angular_frequency;
use crate::math::{MixedTensorConvolution, MixedTensorKernel, TensorKernel};
use crate::operator::{DirectSum, Operator};

/// Displacement of a pair of bodies under normal and tangential traction, in the order x, y, z of
/// [`Coefficients`]. In the plane it is the displacement of the lower body minus that of the upper body.
/// Along z it is positive if it opens the gap.
pub trait CoupledOperator: Send {
    /// Returns the grid of the operator.
    fn grid(&self) -> &Grid;

    /// Whether a pressure displaces tangentially and a shear normally.
    fn couples(&self) -> bool;

    /// Returns the displacement of a cell per unit traction on itself, m/Pa.
    fn self_influence(&self) -> Coefficients;

    /// Returns its normal part.
    fn normal(&mut self) -> &mut dyn Operator;

    /// Computes the requested displacements under the given tractions; missing tractions are zero. All fields
    /// have the shape of the grid.
    fn apply(&mut self, traction: [Option<&Field>; 3], displacement: [Option<&mut Field>; 3]);

    /// Computes the tangential displacement under a shear like [`CoupledOperator::apply`], but in single
    /// precision. The error is about 3e-7 of the largest displacement. Operators with their own
    /// implementation take half the time.
    fn apply_shear_single(&mut self, shear: &[SingleField; 2], displacement: &mut [SingleField; 2]) {
        let [x, y] = shear.each_ref().map(|q| q.mapv(f64::from));
        let mut double = [x.clone(), y.clone()];
        let [u, v] = double.each_mut();
        self.apply([Some(&x), Some(&y), None], [Some(u), Some(v), None]);
        for (single, double) in displacement.iter_mut().zip(&double) {
            single.zip_mut_with(double, |single, double| *single = *double as f32);
        }
    }
}

/// Free boundary by direct summation of the nine influence coefficients, the reference of the transforms.
pub struct CoupledSum {
    normal: DirectSum,
    couples: bool,
    table: CoupledTable,
}

impl CoupledSum {
    /// Creates the operator on `grid` for bodies with this `response`, such as the
    /// [`crate::material::Compliances`] of two half-spaces.
    ///
    /// # Panics
    /// If the response is only known in the normal direction.
    pub fn new(grid: Grid, response: impl Into<SharedResponse>) -> Self {
        let response = response.into();
        let coupled = response.coupled().expect("a response to shear");
        let table = CoupledTable::new(grid.shape, grid.pitch, coupled);
        let couples = coupled.couples();
        Self { normal: DirectSum::new(grid, response), couples, table }
    }
}

impl CoupledOperator for CoupledSum {
    fn grid(&self) -> &Grid {
        self.normal.grid()
    }

    fn couples(&self) -> bool {
        self.couples
    }

    fn self_influence(&self) -> Coefficients {
        self.table.coefficients([0, 0], [0, 0])
    }

    fn normal(&mut self) -> &mut dyn Operator {
        &mut self.normal
    }

    fn apply(&mut self, traction: [Option<&Field>; 3], mut displacement: [Option<&mut Field>; 3]) {
        displacement.iter_mut().flatten().for_each(|field| field.fill(0.0));
        let shape = self.grid().shape;
        for from in ndarray::indices(shape) {
            let loads = traction.map(|field| field.map_or(0.0, |field| field[from]));
            if loads == [0.0; 3] {
                continue;
            }
            for to in ndarray::indices(shape) {
                let matrix = self.table.coefficients(to.into(), from.into()).matrix();
                for (field, row) in displacement.iter_mut().zip(matrix) {
                    if let Some(field) = field {
                        field[to] += row[0] * loads[0] + row[1] * loads[1] + row[2] * loads[2];
                    }
                }
            }
        }
    }
}

/// Data shared by all coupled operators of one cyclic grid.
pub(super) struct CoupledKernel {
    kernel: Arc<MixedTensorKernel>,
    self_influence: Coefficients,
}

impl CoupledKernel {
    /// Creates the kernel for grids that fit into the `padded` one, with a free edge at least, from the `influence` of a
    /// cell.
    pub(super) fn free(padded: [usize; 2], pitch: [f64; 2], influence: &CoupledInfluence) -> Arc<Self> {
        let at = |i: usize, j: usize| influence(i as f64 * pitch[0], j as f64 * pitch[1]);
        let kernel = TensorKernel::from_values(padded, |i, j| in_order(at(i, j)));
        Arc::new(Self { kernel: Arc::new(MixedTensorKernel::new(kernel)), self_influence: at(0, 0) })
    }

    /// Creates the kernel for the periodic `grid`.
    pub(super) fn periodic(grid: &Grid, response: &dyn CoupledResponse) -> Arc<Self> {
        let q = |bin: usize, axis: usize| angular_frequency(bin, grid.shape[axis], grid.pitch[axis]);
        let kernel = Arc::new(MixedTensorKernel::new(TensorKernel::from_transforms(grid.shape, |kx, ky| {
            in_order(response.harmonic_displacements(q(kx, 0), q(ky, 1)))
        })));
        let mut convolution = MixedTensorConvolution::new(Arc::clone(&kernel), grid.shape);
        let mut unit = grid.zeros();
        unit[[0, 0]] = 1.0;
        let mut under = |axis: usize| {
            let mut u: [Field; 3] = std::array::from_fn(|_| grid.zeros());
            let loaded = std::array::from_fn(|n| (n == axis).then_some(&unit));
            convolution.apply(loaded, u.each_mut().map(Some));
            u.map(|u| u[[0, 0]])
        };
        let ([xx, xy, zx], [_, yy, zy], [.., zz]) = (under(0), under(1), under(2));
        Arc::new(Self { kernel, self_influence: Coefficients { xx, xy, yy, zx, zy, zz } })
    }

    /// Creates the operator on `grid` from its `normal` part.
    pub(super) fn operator(&self, grid: Grid, couples: bool, normal: Box<dyn Operator>) -> CoupledFft {
        let convolution = MixedTensorConvolution::new(Arc::clone(&self.kernel), grid.shape);
        CoupledFft { grid, couples, self_influence: self.self_influence, normal, convolution }
    }
}

fn in_order(at: Coefficients) -> [f64; 6] {
    [at.xx, at.xy, at.yy, at.zx, at.zy, at.zz]
}

/// All nine coefficients by real transforms, with the boundary of the normal part. A full traction takes
/// three forward and three inverse transforms; fewer components take fewer transforms.
///
/// With a periodic boundary the mean displacement is free in all directions, and is set to zero.
pub struct CoupledFft {
    grid: Grid,
    couples: bool,
    self_influence: Coefficients,
    normal: Box<dyn Operator>,
    convolution: MixedTensorConvolution,
}

impl CoupledOperator for CoupledFft {
    fn grid(&self) -> &Grid {
        &self.grid
    }

    fn couples(&self) -> bool {
        self.couples
    }

    fn self_influence(&self) -> Coefficients {
        self.self_influence
    }

    fn normal(&mut self) -> &mut dyn Operator {
        self.normal.as_mut()
    }

    fn apply(&mut self, traction: [Option<&Field>; 3], displacement: [Option<&mut Field>; 3]) {
        self.convolution.apply(traction, displacement);
    }

    fn apply_shear_single(&mut self, shear: &[SingleField; 2], displacement: &mut [SingleField; 2]) {
        let ([x, y], [u, v]) = (shear, displacement);
        self.convolution.apply_single([Some(x), Some(y), None], [Some(u), Some(v), None]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{Compliances, Material};
    use crate::operator::{Boundary, Operators};
    use std::f64::consts::TAU;

    fn steel_on_rubber() -> Compliances {
        let steel = Material::elastic(210e9, 0.3).unwrap();
        let polymer = Material::elastic(3e9, 0.4).unwrap();
        Compliances::new(&polymer, &steel).unwrap()
    }

    fn displacement(operator: &mut dyn CoupledOperator, traction: &[Field; 3]) -> [Field; 3] {
        let mut u = std::array::from_fn(|_| operator.grid().zeros());
        operator.apply(traction.each_ref().map(Some), u.each_mut().map(Some));
        u
    }

    fn largest(field: &Field) -> f64 {
        field.iter().fold(0.0, |m, v| m.max(v.abs()))
    }

    #[test]
    fn the_free_transform_is_the_direct_sum_to_round_off() {
        let pair = steel_on_rubber();
        for (shape, pitch) in [([12, 12], [1e-6, 1e-6]), ([1, 9], [1.0, 0.5]), ([17, 10], [0.3, 1.0])] {
            let grid = Grid::new(shape, pitch).unwrap();
            let traction: [Field; 3] = std::array::from_fn(|n| {
                Field::from_shape_fn(shape, |(i, j)| ((7 * i + 3 * j * j + n * i * j) % 11) as f64 - 3.0)
            });
            let slow = displacement(&mut CoupledSum::new(grid, pair), &traction);
            let mut operator = Operators::new(grid, pair, Boundary::FREE).coupled_on(shape);
            let fast = displacement(operator.as_mut(), &traction);
            for (fast, slow) in fast.iter().zip(&slow) {
                assert!(largest(&(fast - slow)) < 1e-13 * largest(slow), "{shape:?}");
            }
            let mut normal = grid.zeros();
            operator.normal().apply(&traction[2], &mut normal);
            let mut alone = grid.zeros();
            operator.apply([None, None, Some(&traction[2])], [None, None, Some(&mut alone)]);
            assert!(largest(&(&alone - &normal)) < 1e-14 * largest(&normal));
        }
    }

    #[test]
    fn in_single_precision_shear_displaces_as_in_double() {
        let pair = steel_on_rubber();
        let grid = Grid::new([17, 10], [3e-7, 1e-6]).unwrap();
        let shear: [Field; 2] = std::array::from_fn(|n| {
            Field::from_shape_fn(grid.shape, |(i, j)| {
                1e6 * (((7 * i + 3 * j * j + n * i * j) % 11) as f64 - 3.0)
            })
        });
        let single = shear.each_ref().map(|q| q.mapv(|q| q as f32));
        for boundary in [Boundary::FREE, Boundary::PERIODIC] {
            let mut operator = Operators::new(grid, pair, boundary).coupled_on(grid.shape);
            let [x, y] = shear.each_ref().map(Clone::clone);
            let double = displacement(operator.as_mut(), &[x, y, grid.zeros()]);
            let mut fast = [0, 1].map(|_| SingleField::zeros(grid.shape));
            operator.apply_shear_single(&single, &mut fast);
            for (fast, double) in fast.iter().zip(&double) {
                assert!(largest(&(&fast.mapv(f64::from) - double)) < 4e-7 * largest(double), "{boundary:?}");
            }
        }
    }

    #[test]
    fn a_periodic_wave_of_shear_along_its_crests_and_across_them() {
        let pair = steel_on_rubber();
        let grid = Grid::new([12, 10], [0.5, 0.25]).unwrap();
        let [lx, ly] = grid.extent();
        let phase = |i, j| TAU * (2.0 * grid.centre(0, i) / lx + grid.centre(1, j) / ly);
        let wave = |f: fn(f64) -> f64| Field::from_shape_fn(grid.shape, |(i, j)| f(phase(i, j)));
        let (kx, ky) = (2.0 * TAU / lx, TAU / ly);
        let k = kx.hypot(ky);
        let (c, s) = (kx / k, ky / k);
        let cos = wave(f64::cos);
        let mut operator = Operators::new(grid, pair, Boundary::PERIODIC).coupled_on(grid.shape);
        // Across the crests (along k): plane strain, with the stiffness of a pressure, and with a normal
        // displacement.
        let across = displacement(operator.as_mut(), &[c * &cos, s * &cos, grid.zeros()]);
        let lifted = wave(f64::sin);
        // Along the crests: antiplane, 1/E* + 1/N* = Σ 1/2G.
        let along = displacement(operator.as_mut(), &[-s * &cos, c * &cos, grid.zeros()]);
        let stiff = 2.0 / k * (pair.normal + pair.lateral);
        let soft = 2.0 / k * pair.normal;
        let expected = [
            [c * soft * &cos, s * soft * &cos, 2.0 / k * pair.coupling * &lifted],
            [-s * stiff * &cos, c * stiff * &cos, grid.zeros()],
        ];
        for (found, expected) in across.iter().chain(&along).zip(expected.iter().flatten()) {
            assert!(largest(&(found - expected)) < 1e-13 * stiff);
        }
        let unit = Field::from_shape_fn(grid.shape, |at| if at == (0, 0) { 1.0 } else { 0.0 });
        let under = displacement(operator.as_mut(), &[unit, grid.zeros(), grid.zeros()]);
        assert!((under[0][[0, 0]] / operator.self_influence().xx - 1.0).abs() < 1e-12);
    }

    #[test]
    fn tractions_do_the_same_work_on_each_others_displacements() {
        let pair = steel_on_rubber();
        let shape = [9, 8];
        let traction = |seed: usize| -> [Field; 3] {
            std::array::from_fn(|n| {
                Field::from_shape_fn(shape, |(i, j)| {
                    ((seed * i + 3 * j * j + n * i * j + seed * n) % 13) as f64 - 6.0
                })
            })
        };
        let (one, other) = (traction(5), traction(8));
        let work = |t: &[Field; 3], u: &[Field; 3]| t.iter().zip(u).map(|(t, u)| (t * u).sum()).sum::<f64>();
        for boundary in [Boundary::FREE, Boundary::PERIODIC] {
            let grid = Grid::new(shape, [1.0, 0.8]).unwrap();
            let mut operator = Operators::new(grid, pair, boundary).coupled_on(shape);
            let (under_one, under_other) =
                (displacement(operator.as_mut(), &one), displacement(operator.as_mut(), &other));
            let (a, b) = (work(&other, &under_one), work(&one, &under_other));
            assert!((a - b).abs() < 1e-12 * work(&one, &under_one), "{boundary:?}: {a:e} and {b:e}");
            assert!(work(&one, &under_one) > 0.0);
        }
    }
}
