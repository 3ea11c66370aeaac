//! The smallest ball around points in five dimensions.

/// A point: a deviator in an orthonormal basis.
pub(super) type Point = [f64; 5];

/// Most points on the rim of a smallest ball that are needed to hold it.
pub(super) const RIM: usize = 6;

/// Share of the squared radius that is rounding.
const ROUNDING: f64 = 1e-14;
/// Square of a distance from the plane through the other points, over the squared radius, below which a point
/// lies in it.
const FLAT: f64 = 1e-24;

fn dot(a: &Point, b: &Point) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub(super) fn less(a: &Point, b: &Point) -> Point {
    std::array::from_fn(|i| a[i] - b[i])
}

/// Square of a distance.
pub(super) fn squared(a: &Point, b: &Point) -> f64 {
    let d = less(a, b);
    dot(&d, &d)
}

/// The ball with given points on its rim, which are added and removed one at a time (Gärtner, ESA 1999).
struct Rim {
    count: usize,
    origin: Point,
    /// Orthogonal directions to the points, and twice their squares.
    directions: [Point; RIM],
    doubled: [f64; RIM],
    centres: [Point; RIM],
    squares: [f64; RIM],
    /// The ball of the points added last.
    centre: Point,
    square: f64,
}

impl Rim {
    fn new() -> Self {
        let none = [[0.0; 5]; RIM];
        Self {
            count: 0,
            origin: [0.0; 5],
            directions: none,
            doubled: [0.0; RIM],
            centres: none,
            squares: [0.0; RIM],
            centre: [0.0; 5],
            square: -1.0,
        }
    }

    /// Whether a point is outside.
    fn leaves_out(&self, point: &Point) -> bool {
        squared(point, &self.centre) > self.square * (1.0 + ROUNDING)
    }

    /// Adds a point; returns false if it lies in the plane of the others.
    fn add(&mut self, point: &Point) -> bool {
        let n = self.count;
        if n == 0 {
            self.origin = *point;
            (self.centres[0], self.squares[0]) = (*point, 0.0);
        } else {
            let mut direction = less(point, &self.origin);
            for k in 1..n {
                let share = 2.0 * dot(&self.directions[k], &direction) / self.doubled[k];
                direction = std::array::from_fn(|i| direction[i] - share * self.directions[k][i]);
            }
            let doubled = 2.0 * dot(&direction, &direction);
            if doubled <= FLAT * self.square.max(squared(point, &self.origin)) {
                return false;
            }
            let excess = squared(point, &self.centres[n - 1]) - self.squares[n - 1];
            let along = excess / doubled;
            (self.directions[n], self.doubled[n]) = (direction, doubled);
            self.centres[n] = std::array::from_fn(|i| self.centres[n - 1][i] + along * direction[i]);
            self.squares[n] = self.squares[n - 1] + 0.5 * excess * along;
        }
        (self.centre, self.square) = (self.centres[n], self.squares[n]);
        self.count += 1;
        true
    }

    /// Finds the smallest ball around the first `count` of the points with the present rim. Points that turn
    /// out to lie on the rim move to the front.
    fn enclose(&mut self, points: &mut [Point], count: usize) {
        if self.count == RIM {
            return;
        }
        for index in 0..count {
            let point = points[index];
            if self.leaves_out(&point) && self.add(&point) {
                self.enclose(points, index);
                self.count -= 1;
                points[..=index].rotate_right(1);
            }
        }
    }
}

/// Returns centre and squared radius of the smallest ball around the `points`, whose order changes.
///
/// # Panics
/// Without points.
pub(super) fn smallest_ball(points: &mut [Point]) -> (Point, f64) {
    assert!(!points.is_empty(), "a ball around points");
    let mut rim = Rim::new();
    rim.enclose(points, points.len());
    (rim.centre, rim.square.max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fatigue::DangVan;
    use crate::stress::Stress;
    use crate::with::fatigue::criterion::max_shear;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// The ball through all of the points: the dense equations of its centre.
    fn through(points: &[Point]) -> Option<(Point, f64)> {
        let from = points[0];
        let edges: Vec<Point> = points[1..].iter().map(|point| less(point, &from)).collect();
        let n = edges.len();
        let mut a: Vec<Vec<f64>> =
            edges.iter().map(|e| edges.iter().map(|f| 2.0 * dot(e, f)).collect()).collect();
        let mut b: Vec<f64> = edges.iter().map(|e| dot(e, e)).collect();
        for k in 0..n {
            let pivot = (k..n).max_by(|i, j| a[*i][k].abs().total_cmp(&a[*j][k].abs()))?;
            a.swap(k, pivot);
            b.swap(k, pivot);
            if a[k][k].abs() < 1e-12 {
                return None;
            }
            for i in k + 1..n {
                let factor = a[i][k] / a[k][k];
                let (above, below) = a.split_at_mut(i);
                below[0][k..].iter_mut().zip(&above[k][k..]).for_each(|(x, y)| *x -= factor * y);
                b[i] -= factor * b[k];
            }
        }
        for k in (0..n).rev() {
            let known: f64 = (k + 1..n).map(|j| a[k][j] * b[j]).sum();
            b[k] = (b[k] - known) / a[k][k];
        }
        let centre =
            std::array::from_fn(|i| from[i] + edges.iter().zip(&b).map(|(e, b)| e[i] * b).sum::<f64>());
        Some((centre, squared(&centre, &from)))
    }

    /// The smallest of the balls through up to six of the points that leave none out.
    fn by_brute_force(points: &[Point]) -> (Point, f64) {
        let mut best: Option<(Point, f64)> = None;
        for chosen in 1u32..1 << points.len() {
            if chosen.count_ones() > 6 {
                continue;
            }
            let some: Vec<Point> =
                (0..points.len()).filter(|k| chosen >> k & 1 == 1).map(|k| points[k]).collect();
            let Some((centre, square)) = through(&some) else { continue };
            let holds = points.iter().all(|point| squared(point, &centre) <= square * (1.0 + 1e-9));
            if holds && best.is_none_or(|(_, least)| square < least) {
                best = Some((centre, square));
            }
        }
        best.unwrap()
    }

    #[test]
    fn three_hundred_random_balls_are_those_of_brute_force() {
        let mut random = ChaCha8Rng::seed_from_u64(2);
        for case in 0..300 {
            let count = random.random_range(1..10);
            // Some lie in planes of fewer dimensions.
            let dimensions = if case % 3 == 0 { random.random_range(1..5) } else { 5 };
            let mut point = || {
                let mut point: Point = std::array::from_fn(|_| random.random_range(-1.0..1.0));
                point[dimensions..].fill(0.0);
                point
            };
            let mut points: Vec<Point> = (0..count).map(|_| point()).collect();
            let (_, expected) = by_brute_force(&points);
            let (centre, found) = smallest_ball(&mut points);
            assert!((found - expected).abs() < 1e-10 * expected.max(1e-3), "case {case}: {found} {expected}");
            assert!(points.iter().all(|point| squared(point, &centre) <= found * (1.0 + 1e-9) + 1e-15));
        }
    }

    #[test]
    fn points_that_coincide_or_lie_on_a_line_have_a_ball() {
        let at = |x: f64| [x, 2.0 * x, 0.0, -x, 0.5];
        assert!(smallest_ball(&mut [at(1.0); 4]).1 == 0.0);
        let (centre, square) = smallest_ball(&mut [0.0, 0.3, 1.0, 0.3, 0.7, 1.0].map(at));
        assert!(squared(&centre, &at(0.5)) < 1e-28 && (square - 1.5).abs() < 1e-12, "{square}");
    }

    #[test]
    fn three_hundred_random_histories_have_the_f_of_brute_force() {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let criterion = DangVan::new(1.0, 3.0 / 1.8).unwrap();
        for case in 0..300 {
            let mean = Stress::from_components(std::array::from_fn(|_| random.random_range(-2.0..2.0)));
            let count = random.random_range(1..11);
            // Some stresses lie in a line, as under a load that goes on and off, and some repeat.
            let load = Stress::from_components(std::array::from_fn(|_| random.random_range(-1.0..1.0)));
            let history: Vec<Stress> = (0..count)
                .map(|at| match case % 4 {
                    0 => mean + random.random_range(-1.0..1.0) * load,
                    1 if at % 2 == 1 => mean,
                    _ => {
                        mean + Stress::from_components(std::array::from_fn(|_| {
                            random.random_range(-1.0..1.0)
                        }))
                    }
                })
                .collect();
            let seen: Vec<(Point, f64)> = history.iter().map(Stress::split).collect();
            let points: Vec<Point> = seen.iter().map(|(deviator, _)| *deviator).collect();
            let (centre, square) = by_brute_force(&points);
            let of = |(deviator, mean): &(Point, f64)| {
                max_shear(&less(deviator, &centre)) + criterion.weight() * mean
            };
            let expected = seen.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
            let [f, radius] = criterion.evaluate(&history);
            assert!((f - expected).abs() < 1e-8, "case {case}: {f} {expected}");
            assert!((radius - square.sqrt()).abs() < 1e-8, "case {case}: {radius} {}", square.sqrt());
        }
    }
}
