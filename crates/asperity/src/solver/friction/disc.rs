//! Vectors in the plane, and the discs in which friction keeps the shear tractions.

/// A vector in the plane of the surface.
pub(super) type Vector = [f64; 2];

pub(super) fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1]]
}

pub(super) fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1]]
}

pub(super) fn times(factor: f64, a: Vector) -> Vector {
    [factor * a[0], factor * a[1]]
}

pub(super) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub(super) fn length(a: Vector) -> f64 {
    a[0].hypot(a[1])
}

/// The vector of the disc of that `radius` nearest to `a`.
pub(super) fn onto_disc(a: Vector, radius: f64) -> Vector {
    let length = length(a);
    if length <= radius { a } else { times(radius / length, a) }
}

/// A symmetric matrix: xx, xy, yy.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Symmetric([f64; 3]);

impl Symmetric {
    /// `factor` times the identity.
    pub(super) fn identity(factor: f64) -> Self {
        Self([factor, 0.0, factor])
    }

    /// `factor` times `a aᵀ`.
    pub(super) fn square(factor: f64, a: Vector) -> Self {
        Self([factor * a[0] * a[0], factor * a[0] * a[1], factor * a[1] * a[1]])
    }

    pub(super) fn and(self, other: Self) -> Self {
        Self(std::array::from_fn(|n| self.0[n] + other.0[n]))
    }

    /// The solution x of `A x = b` of a positive semidefinite A; along a direction that A does not know, x is short.
    pub(super) fn solve(self, b: Vector) -> Vector {
        let least = 1e-12 * (self.0[0] + self.0[2]);
        let [xx, xy, yy] = [self.0[0] + least, self.0[1], self.0[2] + least];
        let determinant = xx * yy - xy * xy;
        if determinant > 0.0 {
            [(yy * b[0] - xy * b[1]) / determinant, (xx * b[1] - xy * b[0]) / determinant]
        } else {
            [0.0; 2]
        }
    }
}

/// The offset e at which Σ P(yᵢ + e) is `wanted`, P the projection [`onto_disc`] of radius gᵢ: it exists where |`wanted`| is
/// less than Σ gᵢ. `cells` are y and g of each, `start` an offset nearby.
///
/// The sum is the gradient of the convex function Σ ½|v|² (in the disc), g|v| − ½g² (outside): Newton's iteration, and
/// where that fails the step of least energy of a paraboloid above it, as Weiszfeld's.
pub(super) fn offset_for_sum<I: Iterator<Item = (Vector, f64)>>(
    cells: impl Fn() -> I,
    wanted: Vector,
    start: Vector,
) -> Vector {
    const MOST: usize = 100;
    const ACCURACY: f64 = 1e-13;
    let at = |offset: Vector| {
        let mut sums = Sums {
            energy: -dot(wanted, offset),
            excess: times(-1.0, wanted),
            slope: Symmetric::default(),
            weight: 0.0,
            size: length(wanted),
            rounding: length(wanted) * length(offset),
        };
        for (y, g) in cells() {
            sums.add(add(y, offset), g);
        }
        sums
    };
    let mut offset = start;
    let mut here = at(offset);
    for _ in 0..MOST {
        if length(here.excess) <= ACCURACY * here.size {
            break;
        }
        let newton = here.slope.solve(times(-1.0, here.excess));
        let descends = |(_, there): &(Vector, Sums), share: f64| {
            let rounding = 4.0 * f64::EPSILON * (here.rounding + there.rounding);
            there.energy <= here.energy + 1e-4 * share * dot(newton, here.excess) + rounding
        };
        let to = |step: Vector| (add(offset, step), at(add(offset, step)));
        // Where nearly all cells slip alike Newton's step is far too long.
        let by_newton = [1.0, 0.1].into_iter().map(|share| (to(times(share, newton)), share));
        let found = by_newton.into_iter().find(|(next, share)| descends(next, *share));
        let (next, there) = match found {
            Some((next, _)) => next,
            None => to(times(-1.0 / here.weight, here.excess)),
        };
        if next == offset {
            break;
        }
        (offset, here) = (next, there);
    }
    offset
}

/// What the cells come to at an offset.
struct Sums {
    energy: f64,
    /// Σ P(y + e) − wanted.
    excess: Vector,
    /// Its derivative.
    slope: Symmetric,
    /// Σ min(1, g/|v|), above that derivative: a step by it never fails.
    weight: f64,
    /// Magnitude of what is added up in the excess, and in the energy.
    size: f64,
    rounding: f64,
}

impl Sums {
    fn add(&mut self, v: Vector, radius: f64) {
        let length = (v[0] * v[0] + v[1] * v[1]).sqrt();
        let (energy, inside, slope) = if length <= radius {
            (0.5 * length * length, v, Symmetric::identity(1.0))
        } else {
            let share = radius / length;
            let across = [-v[1] / length, v[0] / length];
            (radius * (length - 0.5 * radius), times(share, v), Symmetric::square(share, across))
        };
        self.energy += energy;
        self.excess = add(self.excess, inside);
        self.slope = self.slope.and(slope);
        self.weight += if length <= radius { 1.0 } else { radius / length };
        self.size += length.min(radius);
        self.rounding += energy;
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
