//! Vectors in the plane, and the discs to which friction restricts the shear tractions.

/// A vector in the plane of the surface.
pub(super) type Vector = [f64; 2];

/// Returns the sum of two vectors.
pub(super) fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1]]
}

/// Returns the difference a − b.
pub(super) fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1]]
}

/// Multiplies a vector by a factor.
pub(super) fn times(factor: f64, a: Vector) -> Vector {
    [factor * a[0], factor * a[1]]
}

/// Returns the scalar product.
pub(super) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Returns the magnitude of a vector.
pub(super) fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// Returns the vector nearest to `a` in the disc of this `radius`.
pub(super) fn onto_disc(a: Vector, radius: f64) -> Vector {
    let length = length(a);
    if length <= radius { a } else { times(radius / length, a) }
}

/// Returns the factors with which two vectors add up to `b`; none if the vectors are parallel.
pub(super) fn combination([x, y]: [Vector; 2], b: Vector) -> Vector {
    let determinant = x[0] * y[1] - x[1] * y[0];
    if determinant.abs() > REGULARISATION * length(x) * length(y) {
        [(b[0] * y[1] - b[1] * y[0]) / determinant, (x[0] * b[1] - x[1] * b[0]) / determinant]
    } else {
        [0.0; 2]
    }
}

/// A symmetric 2 × 2 matrix by its components xx, xy, yy.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Symmetric([f64; 3]);

impl Symmetric {
    /// `factor` times the identity.
    pub(super) fn identity(factor: f64) -> Self {
        Self([factor, 0.0, factor])
    }

    /// `factor` times the outer product `a aᵀ`.
    pub(super) fn outer_product(factor: f64, a: Vector) -> Self {
        Self([factor * a[0] * a[0], factor * a[0] * a[1], factor * a[1] * a[1]])
    }

    /// The sum of two matrices.
    pub(super) fn and(self, other: Self) -> Self {
        Self(std::array::from_fn(|n| self.0[n] + other.0[n]))
    }

    /// Solves `A x = b` with a positive semidefinite A, regularised by [`REGULARISATION`] of its trace, so
    /// that x is short along a null direction of A.
    pub(super) fn solve(self, b: Vector) -> Vector {
        let least = REGULARISATION * (self.0[0] + self.0[2]);
        let [xx, xy, yy] = [self.0[0] + least, self.0[1], self.0[2] + least];
        let determinant = xx * yy - xy * xy;
        if determinant > 0.0 {
            [(yy * b[0] - xy * b[1]) / determinant, (xx * b[1] - xy * b[0]) / determinant]
        } else {
            [0.0; 2]
        }
    }
}

/// Fraction of the trace that is added to the diagonal of a matrix before it is solved. Smaller relative
/// determinants count as zero.
const REGULARISATION: f64 = 1e-12;
/// Largest number of Newton steps of [`offset_for_sum`].
const MAX_STEPS: usize = 100;
/// Negligible error of the sum, relative to the sum of the magnitudes.
const SUM_ACCURACY: f64 = 1e-13;
/// Number of step lengths tried along Newton's direction. If nearly all cells slip alike, the full step is
/// far too long.
const STEP_LENGTHS: [f64; 2] = [1.0, 0.1];
/// Factor by which a step to the minimum of the majorant is lengthened while this lowers the function.
const LENGTHENING: f64 = 4.0;
/// Armijo's constant: a step must lower the function by this fraction of the linear prediction.
const SUFFICIENT_DECREASE: f64 = 1e-4;
/// Units of rounding in a comparison of two values of the function.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// If the gradient is below this fraction of the sum of its magnitudes, the decrease of the function is below
/// rounding.
const NEAR: f64 = 1e-5;
/// Newton's step is then limited to this multiple of the step to the minimum of the majorant.
const MAX_STEP: f64 = 1e3;

/// Computes the offset e with Σ P(yᵢ + e) = `wanted`, where P is the projection [`onto_disc`] of radius gᵢ.
/// It exists if |`wanted`| is less than Σ gᵢ. `cells` are y and g of each cell, `start` is an offset nearby.
///
/// The sum is the gradient of the convex function [`Objective`]. Newton's iteration with a sufficient
/// decrease finds its minimum. If it fails, a step to the minimum of a quadratic majorant or beyond follows,
/// as in Weiszfeld's iteration.
pub(super) fn offset_for_sum<I: Iterator<Item = (Vector, f64)>>(
    cells: impl Fn() -> I,
    wanted: Vector,
    start: Vector,
) -> Vector {
    let at = |offset: Vector| {
        let mut objective = Objective {
            value: -dot(wanted, offset),
            gradient: times(-1.0, wanted),
            hessian: Symmetric::default(),
            majorant: 0.0,
            gradient_magnitude: length(wanted),
            value_magnitude: length(wanted) * length(offset),
        };
        for (y, g) in cells() {
            objective.add(add(y, offset), g);
        }
        objective
    };
    let mut offset = start;
    let mut here = at(offset);
    for _ in 0..MAX_STEPS {
        if length(here.gradient) <= SUM_ACCURACY * here.gradient_magnitude {
            break;
        }
        let newton = here.hessian.solve(times(-1.0, here.gradient));
        let rounding = |there: &Objective| ROUNDING * (here.value_magnitude + there.value_magnitude);
        let is_near = length(here.gradient) <= NEAR * here.gradient_magnitude
            && length(newton) * here.majorant <= MAX_STEP * length(here.gradient);
        let descends = |(_, there): &(Vector, Objective), step: f64| {
            let least = here.value + SUFFICIENT_DECREASE * step * dot(newton, here.gradient);
            there.value <= least + rounding(there)
                || is_near && length(there.gradient) < length(here.gradient)
        };
        let to = |step: Vector| (add(offset, step), at(add(offset, step)));
        let by_newton = STEP_LENGTHS.into_iter().map(|step| (to(times(step, newton)), step));
        // If the function is nearly a cone, far from all discs, the step of the majorant is only a small part
        // of the way.
        let lengthened = |mut step: Vector| {
            let (mut found, mut next) = (to(step), to(times(LENGTHENING, step)));
            while next.1.value < found.1.value - rounding(&next.1) {
                step = times(LENGTHENING, step);
                (found, next) = (next, to(times(LENGTHENING, step)));
            }
            found
        };
        let found = by_newton.into_iter().find(|(next, step)| descends(next, *step));
        let (next, there) = match found {
            Some((next, _)) => next,
            None => lengthened(times(-1.0 / here.majorant, here.gradient)),
        };
        if next == offset {
            break;
        }
        (offset, here) = (next, there);
    }
    offset
}

/// The convex function Σ φ(yᵢ + e) − `wanted`·e of an offset e, with φ(v) = ½|v|² in the disc and g|v| − ½g²
/// outside, whose gradient is Σ P(yᵢ + e) − `wanted`.
struct Objective {
    /// Value of the function.
    value: f64,
    /// Its gradient Σ P(y + e) − wanted.
    gradient: Vector,
    /// Its Hessian.
    hessian: Symmetric,
    /// Curvature Σ min(1, g/|v|) of a quadratic majorant, whose step never fails.
    majorant: f64,
    /// Sum of the magnitudes that the gradient adds up.
    gradient_magnitude: f64,
    /// Sum of the magnitudes that the value adds up.
    value_magnitude: f64,
}

impl Objective {
    /// Adds the contribution of a cell with v = y + e and this radius.
    fn add(&mut self, v: Vector, radius: f64) {
        let length = (v[0] * v[0] + v[1] * v[1]).sqrt();
        let (value, projected, hessian) = if length <= radius {
            (0.5 * length * length, v, Symmetric::identity(1.0))
        } else {
            let share = radius / length;
            let across = [-v[1] / length, v[0] / length];
            (radius * (length - 0.5 * radius), times(share, v), Symmetric::outer_product(share, across))
        };
        self.value += value;
        self.gradient = add(self.gradient, projected);
        self.hessian = self.hessian.and(hessian);
        self.majorant += if length <= radius { 1.0 } else { radius / length };
        self.gradient_magnitude += length.min(radius);
        self.value_magnitude += value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_vector_of_a_disc_is_itself_or_on_the_rim() {
        assert_eq!(onto_disc([0.3, -0.4], 0.5), [0.3, -0.4]);
        assert!(length(minus(onto_disc([3.0, -4.0], 0.5), [0.3, -0.4])) < 1e-15);
        assert_eq!(onto_disc([3.0, -4.0], 0.0), [0.0, 0.0]);
    }

    #[test]
    fn two_vectors_make_a_third_unless_they_are_parallel() {
        assert_eq!(combination([[2.0, 0.0], [1.0, 4.0]], [5.0, 8.0]), [1.5, 2.0]);
        assert_eq!(combination([[2.0, 1.0], [4.0, 2.0]], [5.0, 8.0]), [0.0, 0.0]);
    }

    #[test]
    fn an_offset_is_found_from_afar() {
        for cells in [vec![([300.0, -70.0], 0.9)], vec![([4e4, 3e3], 1.0), ([4e4, 3.001e3], 0.1)]] {
            let most: f64 = cells.iter().map(|(_, g)| g).sum();
            for share in [0.1, 0.99, 0.99999] {
                let wanted = times(share * most, [0.6, 0.8]);
                for start in [[0.0; 2], [-5e5, 1e5]] {
                    let offset = offset_for_sum(|| cells.iter().copied(), wanted, start);
                    let sum =
                        cells.iter().fold([0.0; 2], |sum, (y, g)| add(sum, onto_disc(add(*y, offset), *g)));
                    assert!(length(minus(sum, wanted)) < 1e-9 * most, "{share} from {start:?}: {sum:?}");
                }
            }
        }
    }

    #[test]
    fn an_offset_makes_the_sum_whatever_share_of_the_discs_it_fills() {
        let cells: Vec<(Vector, f64)> = (0..40)
            .map(|k| {
                let k = f64::from(k);
                ([(1.7 * k).sin(), 0.6 * (2.3 * k).cos()], (0.9 * k).sin().powi(2))
            })
            .collect();
        let most: f64 = cells.iter().map(|(_, g)| g).sum();
        for share in [0.0, 0.3, 0.9, 0.9999] {
            for angle in [0.0f64, 1.0, 4.0] {
                let wanted = times(share * most, [angle.cos(), angle.sin()]);
                let offset = offset_for_sum(|| cells.iter().copied(), wanted, [0.0; 2]);
                let sum = cells.iter().fold([0.0; 2], |sum, (y, g)| add(sum, onto_disc(add(*y, offset), *g)));
                assert!(length(minus(sum, wanted)) < 1e-9 * most, "{share}, {angle}: {sum:?}");
            }
        }
    }
}
