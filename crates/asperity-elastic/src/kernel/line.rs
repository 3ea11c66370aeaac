//! Displacement under an endless line of cells with a period.

use std::f64::consts::PI;

use crate::grid::Field;
use crate::kernel::cell::{asinh_term, gauss_points, integral, logarithm_term};
use crate::kernel::{Coefficients, normal_displacement};
use crate::material::Compliances;
use crate::math::{gauss_legendre, parallel};
use crate::units::{Metre, Pascal};

/// An endless line of cells along an axis, with period L, for contacts that are periodic along this axis
/// only.
///
/// Its coefficients are those of a cell, summed over the line. With r across the line, t along it, and k =
/// 2πm/L, the displacement under a force is
///
/// ```text
/// Σ 1/√(r² + (t + nL)²) = −(2/L) ln(r/r₀) + (4/L) Σ_{m>0} K₀(kr) cos kt
/// ```
///
/// divided by πE*. The uniform part along the line is a line load in plane strain. Its displacement is unbounded and
/// is set to 0 at the distance r₀, the datum. The same holds in the plane; along the line 1/E* + 1/N* replaces 1/E*.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Axis of the line: 0 is x, 1 is y.
    pub axis: usize,
    /// Period L of the cells, > 0, at least their length along the line.
    pub period: Metre,
    /// Distance r₀ at which the uniform part of the displacement is 0, > 0.
    pub datum: Metre,
}

impl Line {
    /// Returns the normal displacement of the pair at `(x, y)` per unit pressure on each cell of size
    /// `pitch`, m/Pa. One of the cells is centred at the origin. See [`crate::kernel::normal_displacement`].
    ///
    /// The error is below 1e-12 of the displacement of a cell under its own pressure.
    pub fn normal_displacement(&self, x: Metre, y: Metre, pitch: [Metre; 2], modulus: Pascal) -> f64 {
        let [s, t] = self.turned([x, y]);
        self.at_distance(s, pitch).inverse_distance(t) / (PI * modulus)
    }

    /// Returns the offsets along a line along y from a place `y` to the three cells that are nearest to it.
    pub fn nearest(&self, y: Metre) -> [Metre; 3] {
        let folded = y - self.period * (y / self.period).round();
        [-1.0, 0.0, 1.0].map(|n| folded + n * self.period)
    }

    /// Returns the normal displacement at `(x, j Δy)`, j below `columns`, by all cells of a line along y but
    /// the three [nearest](Self::nearest), m/Pa; its mean over the width of a cell along y if `across`. It is
    /// smooth.
    pub fn beyond_nearest(
        &self,
        x: Metre,
        columns: usize,
        pitch: [Metre; 2],
        modulus: Pascal,
        across: bool,
    ) -> Vec<f64> {
        let seen = self.at_distance(x, pitch);
        let points = if across {
            gauss_legendre(if self.period < 6.0 * pitch[1] { 8 } else { 2 })
        } else {
            vec![(0.0, 2.0)]
        };
        let at = |j: usize| {
            let y = j as f64 * pitch[1];
            let nearest = self.nearest(y);
            let rest = |t: f64| {
                let nearest = nearest.iter().map(|y| normal_displacement(x, y + t, pitch, 1.0)).sum::<f64>();
                seen.inverse_distance(y + t) / PI - nearest
            };
            let sum = points.iter().map(|(t, weight)| weight * rest(0.5 * t * pitch[1])).sum::<f64>();
            0.5 * sum / modulus
        };
        (0..columns).map(at).collect()
    }

    /// Returns the displacement of the pair at `(x, y)` per unit traction on each cell of size `pitch`, m/Pa.
    /// One of the cells is centred at the origin. See [`crate::kernel::coupled_displacement`].
    ///
    /// The error is below 1e-12 of the displacement of a cell under its own traction.
    pub fn coupled_displacement(
        &self,
        x: Metre,
        y: Metre,
        pitch: [Metre; 2],
        compliances: &Compliances,
    ) -> Coefficients {
        let [s, t] = self.turned([x, y]);
        self.at_distance(s, pitch).coefficients(t, compliances)
    }

    /// Returns the coefficients of all cells `[i, j]` at offsets `(i Δx, j Δy)`, m/Pa.
    pub fn influence_table(&self, shape: [usize; 2], pitch: [Metre; 2], modulus: Pascal) -> Field {
        let ([rows, columns], [across, along]) = (self.turned(shape), self.turned(pitch));
        let mut table = Field::zeros([rows, columns]);
        let values = table.as_slice_mut().expect("standard layout");
        parallel::tasks(values.chunks_exact_mut(columns).enumerate(), |(i, row)| {
            let seen = self.at_distance(i as f64 * across, pitch);
            for (j, value) in row.iter_mut().enumerate() {
                *value = seen.inverse_distance(j as f64 * along) / (PI * modulus);
            }
        });
        if self.axis == 1 { table } else { table.reversed_axes().as_standard_layout().into_owned() }
    }

    /// Reorders values for x and y to values across and along the line, and vice versa.
    pub(super) fn turned<T: Copy>(&self, [x, y]: [T; 2]) -> [T; 2] {
        if self.axis == 1 { [x, y] } else { [y, x] }
    }

    /// Returns the line at the distance `s` across it.
    fn at_distance(&self, s: Metre, pitch: [Metre; 2]) -> LineAtDistance {
        let half @ [a, b] = self.turned(pitch).map(|p| 0.5 * p);
        let near = if s.abs() - a > FAR * self.period {
            None
        } else {
            let farthest = (s.abs() + a).hypot(0.5 * self.period + b) / self.period;
            let cells = (farthest / REACH).max(a.max(b) / self.period / SMOOTH).ceil() as usize;
            Some(NearField::new(cells, farthest / (cells + 1) as f64, self))
        };
        LineAtDistance { line: *self, s, half, near }
    }
}

/// Beyond this number of periods from its edge, a line of cells acts as a uniform line, with a relative error
/// below 2e-17.
const FAR: f64 = 6.0;
/// Cells of the line are summed one by one until all distances are below this fraction of the distance of the
/// first cell in the series, which also limits the size of a cell.
const REACH: f64 = 0.25;
/// Largest size of a cell relative to the distance of the first cell in the series.
const SMOOTH: f64 = 1.0 / 32.0;
/// The series ends where its terms are less than this.
const MIN_TERM: f64 = 1e-17;

/// A line of cells at one distance across it.
struct LineAtDistance {
    line: Line,
    s: f64,
    half: [f64; 2],
    /// Its non-uniform part.
    near: Option<NearField>,
}

impl LineAtDistance {
    /// Computes Σ ∬ 1/r over the cells, at `t` along the line.
    fn inverse_distance(&self, t: f64) -> f64 {
        let Self { line: Line { period, datum, .. }, s, half, .. } = *self;
        let Some(near) = &self.near else {
            let logarithm = |x: f64| -2.0 / period * (x.abs() / datum).ln();
            let closed = |x: f64, y: f64| if x == 0.0 { 0.0 } else { y * x * (logarithm(x) + 2.0 / period) };
            return integral([s, 0.0], half, closed, |x, _| logarithm(x));
        };
        let cells = near.sum(
            self,
            t,
            |x, y| asinh_term(x, y) + asinh_term(y, x),
            |x, y| 1.0 / (x * x + y * y).sqrt(),
        );
        let others =
            gauss_points([s, self.folded(t)], half).map(|(at, weight)| weight * near.harmonics(at).0);
        cells + others.sum::<f64>() * half[0] * half[1]
    }

    /// Computes all nine coefficients.
    fn coefficients(&self, t: f64, compliances: &Compliances) -> Coefficients {
        let Self { line: Line { period, .. }, s, half, .. } = *self;
        let area = 4.0 * half[0] * half[1];
        let inverse = self.inverse_distance(t);
        let cube = |x: f64, y: f64| (x * x + y * y).powf(1.5);
        let [across, mixed, odd_across, odd_along] = match &self.near {
            None => [0.0, 0.0, PI / period * area * s.signum(), 0.0],
            Some(near) => {
                let mut sums = [
                    // Its uniform part is a displacement of the whole body.
                    near.sum(self, t, |x, y| asinh_term(y, x), |x, y| x * x / cube(x, y))
                        - 2.0 / period * area,
                    near.sum(self, t, |x, y| -x.hypot(y), |x, y| x * y / cube(x, y)),
                    near.sum(self, t, logarithm_term, |x, y| x / (x * x + y * y)),
                    near.sum(self, t, |x, y| logarithm_term(y, x), |x, y| y / (x * x + y * y)),
                ];
                for (at, weight) in gauss_points([s, self.folded(t)], half) {
                    let weight = weight * half[0] * half[1];
                    let (_, lateral) = near.harmonics(at);
                    let odd = near.poles(at);
                    sums.iter_mut()
                        .zip(lateral.into_iter().chain(odd))
                        .for_each(|(sum, k)| *sum += weight * k);
                }
                sums
            }
        };
        let [normal, lateral, coupling] =
            [compliances.normal, compliances.lateral, compliances.coupling].map(|c| c / PI);
        let zz = normal * inverse;
        let [xx, yy] = self.line.turned([zz + lateral * across, zz + lateral * (inverse - across)]);
        let [zx, zy] = self.line.turned([coupling * odd_across, coupling * odd_along]);
        Coefficients { xx, xy: lateral * mixed, yy, zx, zy, zz }
    }

    /// Returns the nearest of the offsets that differ by periods.
    fn folded(&self, t: f64) -> f64 {
        t - self.line.period * (t / self.line.period).round()
    }
}

/// The N nearest cells on either side, and the series of all cells beyond them.
///
/// With m = N + 1 and ρ = r/mL, R_l = ρ^l P_l(t/r) the solid harmonics about the line, ζ = (s + it)/mL:
///
/// ```text
/// Σ_{|n|>N} 1/r_n − (2/L) ln … = (2/L) [γ − H_N − ln(2L/r₀) + Σ_{l=2,4…} Z_{l+1} R_l]
/// Σ_{|n|>N} (s − it)/r_n² = (2/L) Σ_{l=1,3…} (−1)^((l−1)/2) Z_{l+1} ζ^l        Z_p = m^{p−1} Σ_{n≥m} n^{−p}
/// ```
struct NearField {
    cells: usize,
    /// mL.
    radius: f64,
    /// 2/L times the constant part of the series, and Z₂, Z₃ ….
    constant: f64,
    weights: Vec<f64>,
}

impl NearField {
    /// Creates the sum with `cells` cells on either side, for distances up to `ratio` times m periods.
    fn new(cells: usize, ratio: f64, line: &Line) -> Self {
        let Line { period, datum, .. } = *line;
        let first = (cells + 1) as f64;
        let orders = (MIN_TERM.ln() / ratio.ln()).ceil() as i32;
        let harmonic: f64 = (1..=cells).map(|n| 1.0 / n as f64).sum();
        let scale = 2.0 / period;
        Self {
            cells,
            radius: first * period,
            constant: scale * (EULER_GAMMA - harmonic - (2.0 * period / datum).ln()),
            weights: (2..=orders + 1).map(|p| scale * tail_of_zeta(p, first)).collect(),
        }
    }

    /// Sums ∬ k over the nearest cells, one by one.
    fn sum(
        &self,
        seen: &LineAtDistance,
        t: f64,
        closed: impl Fn(f64, f64) -> f64,
        k: impl Fn(f64, f64) -> f64,
    ) -> f64 {
        let (t, cells) = (seen.folded(t), self.cells as i64);
        let at = |n: i64| [seen.s, t + n as f64 * seen.line.period];
        // From the far ones to the near ones, the small ones first.
        let pair =
            |n: i64| integral(at(n), seen.half, &closed, &k) + integral(at(-n), seen.half, &closed, &k);
        (1..=cells).rev().map(pair).sum::<f64>() + integral(at(0), seen.half, &closed, &k)
    }

    /// Computes the sum T = Σ 1/r over all cells except the nearest, and the sums of the displacements in the
    /// plane, [Σ s²/r³, Σ st/r³] = [−s ∂T/∂s, −s ∂T/∂t].
    fn harmonics(&self, at: [f64; 2]) -> (f64, [f64; 2]) {
        let [x, y] = at.map(|c| c / self.radius);
        let square = x * x + y * y;
        let (mut before, mut harmonic) = (1.0, y);
        let (mut sum, mut across, mut mixed) = (self.constant, 0.0, 0.0);
        for l in 2..=self.weights.len() {
            let order = l as f64;
            let next = ((2.0 * order - 1.0) * y * harmonic - (order - 1.0) * square * before) / order;
            (before, harmonic) = (harmonic, next);
            if l % 2 == 0 {
                let weight = self.weights[l - 1];
                sum += weight * harmonic;
                across -= weight * order * (harmonic - y * before);
                mixed -= weight * order * x * before;
            }
        }
        (sum, [across, mixed])
    }

    /// Computes Σ s/r² and Σ t/r² over all cells except the nearest.
    fn poles(&self, at: [f64; 2]) -> [f64; 2] {
        let [x, y] = at.map(|c| c / self.radius);
        // −ζ².
        let (re, im) = (y * y - x * x, -2.0 * x * y);
        let (mut power, mut sum) = ([x, y], [0.0; 2]);
        for weight in self.weights.iter().step_by(2) {
            sum = [sum[0] + weight * power[0], sum[1] - weight * power[1]];
            power = [power[0] * re - power[1] * im, power[0] * im + power[1] * re];
        }
        sum
    }
}

/// Euler's constant γ.
const EULER_GAMMA: f64 = 0.577_215_664_901_532_9;

/// Computes m^{p−1} Σ_{n≥m} n^{−p}, p ≥ 2: term by term up to n = 24, then by the Euler–Maclaurin formula.
fn tail_of_zeta(p: i32, m: f64) -> f64 {
    /// First n of the Euler–Maclaurin formula.
    const ASYMPTOTIC: f64 = 24.0;
    /// B_{2k}/(2k)!.
    const BERNOULLI: [f64; 4] = [1.0 / 12.0, -1.0 / 720.0, 1.0 / 30_240.0, -1.0 / 1_209_600.0];
    let (mut n, mut sum) = (m, 0.0);
    while n < ASYMPTOTIC {
        sum += (m / n).powi(p);
        n += 1.0;
    }
    let exponent = f64::from(p);
    let mut rest = n / (exponent - 1.0) + 0.5;
    let mut factor = exponent / n;
    for (k, coefficient) in BERNOULLI.into_iter().enumerate() {
        rest += coefficient * factor;
        let next = exponent + (2 * k + 1) as f64;
        factor *= next * (next + 1.0) / (n * n);
    }
    (sum + (m / n).powi(p) * rest) / m
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::{coupled_displacement, normal_displacements_across};
    use crate::material::Material;

    fn pair() -> Compliances {
        let [lower, upper] = [(1.0, 0.3), (3.0, 0.2)].map(|(e, nu)| Material::elastic(e, nu).unwrap());
        Compliances::new(&lower, &upper).unwrap()
    }

    /// Cells, periods and offsets of all kinds: fine and coarse, long and narrow, one cell a period, near and
    /// far.
    fn samples() -> Vec<([f64; 2], f64, [f64; 2])> {
        let mut samples = Vec::new();
        for (pitch, period) in [
            ([1.0, 1.0], 8.0),
            ([1.0, 1.0], 1.0),
            ([1.0, 0.7], 14.0),
            ([0.1, 1.0], 3.0),
            ([4.0, 0.5], 1.0),
            ([6.0, 0.5], 0.5),
            ([1.0, 1.0], 300.0),
        ] {
            for s in [0.0, 1.0, 3.0, 0.4 * period, -1.1 * period, 5.0 * period, 6.5 * period] {
                for t in [0.0, 0.5, 0.25 * period, 0.5 * period, -0.8 * period, 3.3 * period] {
                    samples.push((pitch, period, [s, t]));
                }
            }
        }
        samples
    }

    #[test]
    fn the_mean_across_a_cell_is_that_of_the_displacement() {
        for (pitch, period, [s, _]) in samples().into_iter().step_by(6) {
            let columns = (period / pitch[1]).round() as usize;
            if (columns as f64 * pitch[1] - period).abs() > 1e-9 || columns > 60 {
                continue;
            }
            let line = Line { axis: 1, period, datum: 1.3 };
            let rest = line.beyond_nearest(s, columns, pitch, 1.0, true);
            let nearest = |j: usize| {
                line.nearest(j as f64 * pitch[1]).map(|y| normal_displacements_across(s, y, 1, pitch, 1.0)[0])
            };
            let found: Vec<_> = (0..columns).map(|j| rest[j] + nearest(j).iter().sum::<f64>()).collect();
            let own = line.normal_displacement(0.0, 0.0, pitch, 1.0).abs();
            for (j, found) in found.iter().enumerate() {
                let points = gauss_legendre(40);
                let at = |t: f64| line.normal_displacement(s, (j as f64 + 0.5 * t) * pitch[1], pitch, 1.0);
                let mean = points.iter().map(|(t, weight)| 0.5 * weight * at(*t)).sum::<f64>();
                assert!((found - mean).abs() < 1e-6 * own, "{pitch:?} {period} {s} {j}: {found} {mean}");
            }
        }
    }

    /// Sums the coefficients of a cell over |n| ≤ M.
    fn brute(pitch: [f64; 2], period: f64, [s, t]: [f64; 2], reach: i64) -> [[f64; 3]; 3] {
        let pair = pair();
        let mut sum = [[0.0; 3]; 3];
        for n in (1..=reach).rev().flat_map(|n| [n, -n]).chain([0]) {
            let t = t - period * (t / period).round() + n as f64 * period;
            let at = coupled_displacement(s, t, pitch, &pair).matrix();
            sum.iter_mut().flatten().zip(at.iter().flatten()).for_each(|(sum, k)| *sum += k);
        }
        sum
    }

    /// Computes the remainder to the logarithm of r/r₀ beyond M ≫ 1, without the uniform part of the lateral
    /// coefficient.
    fn rest(pitch: [f64; 2], period: f64, datum: f64, reach: i64) -> [[f64; 3]; 3] {
        let pair = pair();
        let area = pitch[0] * pitch[1] / PI;
        let h = (reach as f64 + 0.5) * period;
        let inverse = -2.0 / period * (2.0 * h / datum).ln() * area;
        let lateral = -2.0 / period * area;
        let mut rest = [[0.0; 3]; 3];
        rest[2][2] = pair.normal * inverse;
        rest[0][0] = rest[2][2] + pair.lateral * lateral;
        rest[1][1] = rest[2][2] + pair.lateral * (inverse - lateral);
        rest
    }

    #[test]
    fn the_sum_over_the_line_is_that_of_its_cells() {
        let datum = 50.0;
        for (pitch, period, at) in samples() {
            let line = Line { axis: 1, period, datum };
            let exact = line.coupled_displacement(at[0], at[1], pitch, &pair()).matrix();
            let own = line.coupled_displacement(0.0, 0.0, pitch, &pair()).matrix();
            // M + ½ is h, 3h and 9h.
            let sums = [300, 901, 2704].map(|reach| {
                let (mut sum, rest) = (brute(pitch, period, at, reach), rest(pitch, period, datum, reach));
                sum.iter_mut().flatten().zip(rest.iter().flatten()).for_each(|(sum, rest)| *sum += rest);
                sum
            });
            let farthest = (at[0].abs() + 0.5 * pitch[0]) / period + 1.0;
            let tolerance = 1e-12 + 100.0 * (farthest / 2704.0).powi(5);
            for i in 0..3 {
                for j in 0..3 {
                    // The remainders of the sums of 1/r and similar terms decay as h⁻², h⁻⁴;
                    // those of x/r² and y/r² as h⁻¹, h⁻³.
                    let power = if (i == 2) != (j == 2) { 1 } else { 2 };
                    let better =
                        |power: i32, [near, far]: [f64; 2]| far + (far - near) / (3f64.powi(power) - 1.0);
                    let [a, b, c] = sums.map(|sum| sum[i][j]);
                    let sum = better(power + 2, [better(power, [a, b]), better(power, [b, c])]);
                    let error = (exact[i][j] - sum).abs() / own[i][i].abs().max(own[2][2].abs());
                    assert!(error < tolerance, "{pitch:?}, {period} at {at:?}: {i}{j} is off by {error:e}");
                }
            }
        }
    }

    #[test]
    fn along_x_it_is_the_same_turned() {
        let pair = pair();
        let [y, x] = [1, 0].map(|axis| Line { axis, period: 6.0, datum: 9.0 });
        let one = y.coupled_displacement(0.7, -1.3, [0.4, 1.0], &pair);
        let other = x.coupled_displacement(-1.3, 0.7, [1.0, 0.4], &pair);
        let turned = Coefficients { xx: one.yy, xy: one.xy, yy: one.xx, zx: one.zy, zy: one.zx, zz: one.zz };
        assert_eq!(other, turned);
        let table = x.influence_table([5, 4], [1.0, 0.4], pair.modulus());
        assert_eq!(table[[3, 2]], x.normal_displacement(3.0, 0.8, [1.0, 0.4], pair.modulus()));
    }
}
