//! Sums over an endless line of cells of displacements that are smooth.

use crate::kernel::Line;
use crate::kernel::remainder::{Remainder, Transform, along_side, chebyshev, chebyshev_angle, clenshaw};
use crate::math::{gauss_legendre, parallel};
use crate::units::Metre;

/// N displacements under a [`Line`] of cells along y with the period L, which are smooth on the scale of the distance from
/// the cell: those of a body with layers minus those of a half-space of the material at its surface.
///
/// The cell and its neighbours are summed directly. The others are a smooth function of the place, which is tabulated. With
/// Fₙ under the n-th cell, of the length l, they are, by the formula of Euler and Maclaurin,
///
/// ```text
/// Σ_{|n|>1} Fₙ = Σ_{1<|n|≤M+2} wₙ Fₙ + (l/L) [under a strip − under a cell of the length 2Y]      Y = (M + ½) L
/// ```
///
/// The bracket is a mean over the length l, and wₙ is 1 but for the last four terms. This holds whatever the scales of F,
/// since F is smooth on the scale of the distance, where it differs from its mean over a period by some 1e-12.
pub(super) struct SmoothLine<const N: usize> {
    period: Metre,
    /// Half-sides of a part of a cell, across the line and along it. It is no wider than a period.
    half: [Metre; 2],
    /// Number of parts of a cell, side by side across the line.
    parts: usize,
    /// Whether each displacement is odd across the line and along it.
    odd: [[bool; 2]; N],
    cell: Box<UnderCell<N>>,
    strip: Box<UnderStrip<N>>,
    /// Chebyshev coefficients of all cells but the three nearest, in t² and in s, for each interval of the distance s. Those of
    /// displacements that are odd along the line are divided by t.
    others: Vec<[[[f64; N]; ACROSS]; ALONG]>,
}

/// Displacements at a place under a cell with these half-sides.
type UnderCell<const N: usize> = dyn Fn([Metre; 2], [Metre; 2]) -> [f64; N] + Send + Sync;
/// Displacements at a distance across an endless strip along y of this half-width.
type UnderStrip<const N: usize> = dyn Fn(Metre, Metre) -> [f64; N] + Send + Sync;

/// Farther than this number of periods from its edges, a line of cells acts as a strip, with a relative error below 1e-16.
const FAR: f64 = 6.0;
/// Numbers of Chebyshev coefficients in s and in t². The nearest singularity, at 3L/2 from the line, gives errors of 4⁻¹⁸ and 34⁻⁸.
const ACROSS: usize = 18;
const ALONG: usize = 8;
/// Length of an interval in s, in periods.
const INTERVAL: f64 = 1.5;
/// M.
const DIRECT: usize = 40;
/// Weights at the end of the sum, which replace F′/24 − 7F‴/5760 at Y.
const END: [f64; 4] = [1.0 + 17.0 / 5760.0, 1.0 - 291.0 / 5760.0, 291.0 / 5760.0, -17.0 / 5760.0];

impl<const N: usize> SmoothLine<N> {
    /// Creates the sum for cells of size `pitch`, given along x and y, in a `line`.
    pub(super) fn new(
        line: &Line,
        pitch: [Metre; 2],
        odd: [[bool; 2]; N],
        cell: impl Fn([Metre; 2], [Metre; 2]) -> [f64; N] + Send + Sync + 'static,
        strip: impl Fn(Metre, Metre) -> [f64; N] + Send + Sync + 'static,
    ) -> Self {
        let [width, length] = line.turned(pitch);
        let parts = (width / line.period).ceil();
        let mut sum = Self {
            period: line.period,
            half: [0.5 * width / parts, 0.5 * length],
            parts: parts as usize,
            odd,
            cell: Box::new(cell),
            strip: Box::new(strip),
            others: Vec::new(),
        };
        let interval = INTERVAL * line.period;
        let count = ((sum.half[0] + FAR * line.period) / interval).ceil() as usize;
        let node = |k: usize| (k / ACROSS) as f64 + 0.5 + 0.5 * chebyshev_angle(k % ACROSS, ACROSS).cos();
        let along = parallel::tasks(0..count * ACROSS, |k| sum.along(node(k) * interval));
        let of_piece = |piece: usize| {
            std::array::from_fn(|order| chebyshev(&std::array::from_fn(|k| along[piece * ACROSS + k][order])))
        };
        sum.others = (0..count).map(of_piece).collect();
        sum
    }

    /// Returns the displacements at the distance s across the line, at t along it.
    pub(super) fn displacement(&self, [s, t]: [Metre; 2]) -> [f64; N] {
        let Self { period, half: [a, b], parts, .. } = *self;
        let whole = parts as f64 * a;
        if self.is_far(s, whole) {
            return (self.strip)(s, whole).map(|value| 2.0 * b / period * value);
        }
        let t = t - period * (t / period).round();
        let mut sums = [0.0; N];
        for part in 0..parts {
            let values = self.of_part([s + (2 * part + 1) as f64 * a - whole, t]);
            sums = std::array::from_fn(|n| sums[n] + values[n]);
        }
        sums
    }

    /// Returns whether a line of this half-width acts as a strip at the distance s.
    fn is_far(&self, s: Metre, half: Metre) -> bool {
        (s.abs() - half).abs() > FAR * self.period
    }

    /// Returns the displacements by the parts of a line, at t up to half a period from one of them.
    fn of_part(&self, [s, t]: [Metre; 2]) -> [f64; N] {
        let Self { period, half: half @ [a, b], .. } = *self;
        if self.is_far(s, a) {
            return (self.strip)(s, a).map(|value| 2.0 * b / period * value);
        }
        let nearest = [-1.0, 0.0, 1.0].map(|n| (self.cell)([s, t + n * period], half));
        let place = s.abs() / (INTERVAL * period);
        let piece = (place as usize).min(self.others.len() - 1);
        let at = 2.0 * (place - piece as f64) - 1.0;
        let ratio = 2.0 * t / period;
        let others = clenshaw(
            &self.others[piece].each_ref().map(|coefficients| clenshaw(coefficients, at)),
            2.0 * ratio * ratio - 1.0,
        );
        std::array::from_fn(|n| {
            let [across, along] = self.odd[n];
            let sign = match across {
                true if s == 0.0 => 0.0,
                true => s.signum(),
                false => 1.0,
            };
            let along = if along { ratio } else { 1.0 };
            nearest.iter().map(|values| values[n]).sum::<f64>() + sign * along * others[n]
        })
    }

    /// Returns the Chebyshev coefficients in t² of all cells but the three nearest.
    fn along(&self, s: Metre) -> [[f64; N]; ALONG] {
        let end = (DIRECT as f64 + 0.5) * self.period;
        let strip = (self.strip)(s, self.half[0]);
        let nodes = gauss_legendre(3);
        let values = std::array::from_fn(|k| {
            let ratio = (0.5 * chebyshev_angle(k, ALONG)).cos();
            let t = 0.5 * ratio * self.period;
            let mut sums = [0.0; N];
            let mut add = |weight: f64, values: [f64; N]| {
                sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * value);
            };
            for n in (2..=DIRECT + 2).rev() {
                let weight = (n + 1).checked_sub(DIRECT).map_or(1.0, |last| END[last]);
                for image in [n as f64, -(n as f64)] {
                    add(weight, (self.cell)([s, t + image * self.period], self.half));
                }
            }
            for (node, weight) in &nodes {
                let share = weight * self.half[1] / self.period;
                add(share, strip);
                add(-share, (self.cell)([s, t + node * self.half[1]], [self.half[0], end]));
            }
            std::array::from_fn(|n| if self.odd[n][1] { sums[n] / ratio } else { sums[n] })
        });
        chebyshev(&values)
    }
}

/// Displacements or stresses under endless strips, the sums of waves of one direction. Their harmonics are potentials at a depth d
/// and remainders.
///
/// A line load has ∫ R(q) cos qx dq/π, or sin qx of odd ones, and the potentials −2 ln(√(x² + d²)/r₀), or 2 atan(x/d).
pub(super) struct Strips<const N: usize> {
    table: Remainder<N>,
    transforms: [Transform; N],
    images: [f64; N],
    datum: Metre,
    /// Uniform displacements that are taken off.
    offset: [f64; N],
    nodes: Vec<(f64, f64)>,
}

impl<const N: usize> Strips<N> {
    /// Creates them from the remainders R(q), each with [`Transform::Cosine`] or [`Transform::Sine`], and from the amplitudes of the
    /// `images`, the potentials at the `depth`, for distances up to `reach`.
    pub(super) fn new(
        rest: impl Fn(f64) -> [f64; N] + Sync,
        transforms: [Transform; N],
        images: [f64; N],
        [depth, datum]: [Metre; 2],
        reach: Metre,
    ) -> Self {
        let table = Remainder::new(rest, transforms, depth, reach);
        Self { table, transforms, images, datum, offset: [0.0; N], nodes: gauss_legendre(16) }
    }

    /// Makes the even ones 0 at the datum r₀.
    pub(super) fn relative_to_datum(mut self) -> Self {
        let there = self.under_line(self.datum);
        self.offset = std::array::from_fn(|n| match self.transforms[n] {
            Transform::Sine => 0.0,
            _ => there[n],
        });
        self
    }

    /// Returns the values at the distance `x` from the centre of a strip of this half-width.
    pub(super) fn under_strip(&self, x: Metre, half: Metre) -> [f64; N] {
        let depth = self.table.depth;
        if x.hypot(depth) > 2.0 * half {
            let mut sums = [0.0; N];
            for (node, weight) in &self.nodes {
                let values = self.under_line(x + half * node);
                sums = std::array::from_fn(|n| sums[n] + weight * half * values[n]);
            }
            return sums;
        }
        let [right, left] = [x + half, x - half]
            .map(|end| along_side(0.0, end, depth, &self.nodes, |_, s| self.under_line(s)));
        std::array::from_fn(|n| right[n] - left[n])
    }

    /// Returns the values at the distance `x` from a line load.
    fn under_line(&self, x: Metre) -> [f64; N] {
        let depth = self.table.depth;
        let table = self.table.at(x.abs());
        let (even, odd) = (-2.0 * (x.hypot(depth) / self.datum).ln(), 2.0 * (x.abs() / depth).atan());
        std::array::from_fn(|n| match self.transforms[n] {
            Transform::Sine => x.signum() * (table[n] + self.images[n] * odd),
            _ => table[n] + self.images[n] * even - self.offset[n],
        })
    }
}
