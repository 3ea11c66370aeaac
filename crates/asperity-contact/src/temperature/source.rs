//! Temperature under a uniform flux into a cell.

use std::f64::consts::{FRAC_2_SQRT_PI, PI, TAU};

use libm::erfc;

use crate::math::gauss_legendre;
use crate::temperature::Thermal;
use crate::units::{Metre, MetrePerSecond, Second};

/// Steady temperature at `(x, y)` per unit flux into the cell centred at the origin, K m²/W, for a body that
/// passes the cell at the `speed` V along x, positive or negative.
///
/// ```text
/// T = (1/2πλ) ∬ e^(−(|V|r − Vx)/2D)/r  =  (1/2πλ) ∮ (e^(−w r₀) − e^(−w r₁))/w dθ,   w = (|V| + V cos θ)/2D
/// ```
///
/// where the ray at the angle θ from `(x, y)` enters the cell at r₀ and leaves it at r₁. At V = 0 this is the
/// displacement [`crate::kernel::normal_displacement`] for E* = 2λ. The error is below 1e-12 of the
/// temperature of a stationary square cell under its own flux. Jaeger, Proc. R. Soc. N.S.W. 76, 203 (1942).
pub fn moving_source_temperature(
    x: Metre,
    y: Metre,
    pitch: [Metre; 2],
    thermal: &Thermal,
    speed: MetrePerSecond,
) -> f64 {
    Cell::new(pitch).moving([x, y], thermal, speed)
}

/// A cell with uniform flux around the origin.
pub(super) struct Cell {
    half: [Metre; 2],
    /// Nodes and weights of the Gauss–Legendre rule.
    rule: Vec<(f64, f64)>,
}

impl Cell {
    pub(super) fn new(pitch: [Metre; 2]) -> Self {
        Self { half: pitch.map(|p| 0.5 * p), rule: gauss_legendre(POINTS) }
    }

    /// See [`moving_source_temperature`].
    pub(super) fn moving(&self, at: [Metre; 2], thermal: &Thermal, speed: MetrePerSecond) -> f64 {
        let rate = speed.abs() / thermal.diffusivity();
        let around = self.around(at, 0.0, |angle, [near, far]| {
            let half = 0.5 * angle;
            let w = rate * if speed < 0.0 { half.sin().powi(2) } else { half.cos().powi(2) };
            let decay = w * (far - near);
            let share = if decay == 0.0 { 1.0 } else { -(-decay).exp_m1() / decay };
            (-w * near).exp() * (far - near) * share
        });
        around / (TAU * thermal.conductivity)
    }

    /// Temperature at a point of a body at rest, K m²/W, per unit flux at the end of a step, for a flux that
    /// grows from 0 during the `step`, and for one that decreases to 0.
    ///
    /// ```text
    /// Σ of both:   (1/2πλ) ∮ ℓ [i¹(u₀) − i¹(u₁)] dθ                                         u = r/ℓ,  ℓ = 2√(Dt)
    /// falling:     (1/2πλ) ∮ 2ℓ [i³(u₀) + u₀ i²(u₀) − i³(u₁) − u₁ i²(u₁)] dθ                iⁿ: iⁿerfc
    /// ```
    /// Integrals over a ray of the point source solutions erfc(u)/r and 2 i¹(u)/ℓ. Carslaw and Jaeger,
    /// *Conduction of Heat in Solids*, chapter X and appendix II.
    pub(super) fn ramps(&self, at: [Metre; 2], thermal: &Thermal, step: Second) -> [f64; 2] {
        let length = 2.0 * (thermal.diffusivity() * step).sqrt();
        let [dx, dy] = [0, 1].map(|axis| (at[axis].abs() - self.half[axis]).max(0.0));
        if dx.hypot(dy) > FADED * length {
            return [0.0; 2];
        }
        let of = |primitive: fn(f64) -> f64| {
            let along =
                |_, [near, far]: [f64; 2]| length * (primitive(far / length) - primitive(near / length));
            self.around(at, length, along) / (TAU * thermal.conductivity)
        };
        let (both, falling) = (of(steady_flux), of(falling_flux));
        [both - falling, falling]
    }

    /// Computes ∮ f(θ, [r₀, r₁]) dθ over the rays from a point that meet the cell. The Gauss–Legendre rule is
    /// applied to halved intervals until halving changes nothing beyond the round-off of lengths, one of
    /// which may be given.
    fn around(&self, at: [Metre; 2], length: Metre, f: impl Fn(f64, [f64; 2]) -> f64) -> f64 {
        let ([x, y], [a, b]) = (at, self.half);
        let inside = x.abs() <= a && y.abs() <= b;
        let centre = if inside { 0.0 } else { (-y).atan2(-x) };
        let wrapped = |angle: f64| (angle + PI).rem_euclid(TAU) - PI;
        let corners =
            [[-a, -b], [-a, b], [a, -b], [a, b]].map(|[cx, cy]| wrapped((cy - y).atan2(cx - x) - centre));
        let (lo, hi) = if inside {
            (-PI, PI)
        } else {
            corners.iter().fold((PI, -PI), |(lo, hi), c| (lo.min(*c), hi.max(*c)))
        };
        // w has its extrema along the ray on which a moving body was heated, and along the opposite one.
        let mut ends = vec![lo, hi, wrapped(-centre), wrapped(PI - centre)];
        ends.extend(corners);
        ends.retain(|angle| (lo..=hi).contains(angle));
        ends.sort_by(f64::total_cmp);
        let along = |relative: f64| {
            let angle = relative + centre;
            let (sin, cos) = angle.sin_cos();
            let mut ray = [0.0, f64::INFINITY];
            for (position, half, direction) in [(x, a, cos), (y, b, sin)] {
                if direction != 0.0 {
                    let (one, other) = ((-half - position) / direction, (half - position) / direction);
                    ray = [ray[0].max(one.min(other)), ray[1].min(one.max(other))];
                }
            }
            if ray[1] > ray[0] { f(angle, ray) } else { 0.0 }
        };
        let tolerance = TOLERANCE * (a + b + 0.1 * x.hypot(y) + 0.1 * length);
        ends.windows(2).map(|ends| self.refined(&along, [ends[0], ends[1]], tolerance)).sum()
    }

    /// Computes ∫ f over an interval, halving it if the sum of the halves differs from the whole.
    fn refined(&self, f: &impl Fn(f64) -> f64, [lo, hi]: [f64; 2], tolerance: f64) -> f64 {
        let mut open = vec![([lo, hi], self.gauss(f, [lo, hi]), DEEPEST)];
        let mut sum = 0.0;
        while let Some(([lo, hi], whole, depth)) = open.pop() {
            let middle = 0.5 * (lo + hi);
            let halves = [[lo, middle], [middle, hi]].map(|part| (part, self.gauss(f, part)));
            let refined = halves[0].1 + halves[1].1;
            if depth == 0 || (whole - refined).abs() <= tolerance {
                sum += refined;
            } else {
                open.extend(halves.map(|(part, value)| (part, value, depth - 1)));
            }
        }
        sum
    }

    fn gauss(&self, f: &impl Fn(f64) -> f64, [lo, hi]: [f64; 2]) -> f64 {
        let (middle, half) = (0.5 * (lo + hi), 0.5 * (hi - lo));
        half * self.rule.iter().map(|(x, w)| w * f(middle + half * x)).sum::<f64>()
    }
}

/// Number of points of the rule on an interval.
const POINTS: usize = 10;
/// Smallest change of the integral for which an interval is halved, relative to the half sides of the cell,
/// or to a tenth of lengths.
const TOLERANCE: f64 = 1e-14;
/// Largest number of halvings.
const DEEPEST: usize = 30;
/// Distance in ℓ from a cell that its heat does not reach within a step: erfc(6) = 2e-17.
const FADED: f64 = 6.0;

/// iⁿerfc(u) for n = 1, 2 and 3.
fn repeated(u: f64) -> [f64; 3] {
    let zeroth = erfc(u);
    let first = 0.5 * FRAC_2_SQRT_PI * (-u * u).exp() - u * zeroth;
    let second = 0.25 * zeroth - 0.5 * u * first;
    [first, second, (first - 2.0 * u * second) / 6.0]
}

/// ∫₀ᵘ erfc.
fn steady_flux(u: f64) -> f64 {
    u * erfc(u) - 0.5 * FRAC_2_SQRT_PI * (-u * u).exp_m1()
}

/// 2 ∫₀ᵘ v ierfc(v) dv.
fn falling_flux(u: f64) -> f64 {
    if u < 1e-3 {
        return u * u * (0.5 * FRAC_2_SQRT_PI - 2.0 / 3.0 * u);
    }
    let [_, second, third] = repeated(u);
    2.0 * (FRAC_2_SQRT_PI / 12.0 - third - u * second)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::normal_displacement;
    use approx::assert_relative_eq;

    /// λ = 1, D = ½: V = Pe for cells with half side 1.
    fn unit() -> Thermal {
        Thermal::new(1.0, 2.0, 1.0).unwrap()
    }

    #[test]
    fn at_rest_it_is_the_elastic_displacement() {
        let pitch = [1.0, 0.7];
        let own = moving_source_temperature(0.0, 0.0, pitch, &unit(), 0.0);
        for at in [[0.0, 0.0], [1.0, 0.0], [0.5, 0.35], [0.0, 0.7], [3.0, -2.1], [-17.0, 4.2], [63.0, 0.0]] {
            let elastic = normal_displacement(at[0], at[1], pitch, 2.0);
            let found = moving_source_temperature(at[0], at[1], pitch, &unit(), 0.0);
            assert!((found - elastic).abs() < 1e-13 * own, "{at:?}: {found} and {elastic}");
        }
    }

    #[test]
    fn a_moving_cell_is_the_integral_over_its_past() {
        // T = ∫ (1/ρc√(πDt)) ¼ [erf] [erf] dt in t = e^{2v}.
        for speed in [0.3, 1.0, -4.0, 30.0] {
            for at in [[0.0, 0.0], [1.0, 1.0], [3.0, 0.5], [-2.0, 0.0], [6.0, 0.0], [-2.0, 3.0]] {
                let integrand = |v: f64| {
                    let root = v.exp();
                    let (t, s) = (root * root, 2.0 * (0.5f64).sqrt() * root);
                    let between = |x: f64| libm::erf((x + 1.0) / s) - libm::erf((x - 1.0) / s);
                    root / (2.0 * (PI * 0.5).sqrt()) * 0.5 * between(at[0] - speed * t) * between(at[1])
                };
                let step = 2e-3;
                let past: f64 = (-17_500..5_000).map(|n| step * integrand(step * f64::from(n))).sum();
                let found = moving_source_temperature(at[0], at[1], [2.0, 2.0], &unit(), speed);
                // The largest half side is 1, and the temperature of the cell at rest under its own flux
                // 1.122.
                assert!((found - past).abs() < 2e-12, "{speed}, {at:?}: {found} and {past}");
            }
        }
    }

    #[test]
    fn a_body_is_passed_alike_from_both_sides() {
        for at in [[0.3, 0.1], [2.0, -1.0], [-3.0, 0.2]] {
            let found = moving_source_temperature(at[0], at[1], [1.0, 1.0], &unit(), 3.0);
            let turned = moving_source_temperature(-at[0], at[1], [1.0, 1.0], &unit(), -3.0);
            assert_relative_eq!(found, turned, max_relative = 1e-13);
        }
    }

    #[test]
    fn ramps_are_integrals_over_the_step() {
        let (thermal, step) = (unit(), 0.7);
        let cell = Cell::new([1.0, 0.6]);
        for at in [[0.0, 0.0], [1.0, 0.0], [-1.0, 1.2], [3.0, 0.6]] {
            let [rising, falling] = cell.ramps(at, &thermal, step);
            let mut sums = [0.0; 2];
            let n = 20_000;
            for k in 0..n {
                // Age = step · s², which removes the root from the integrand.
                let s = (f64::from(k) + 0.5) / f64::from(n);
                let age = step * s * s;
                let width = 2.0 * (0.5 * age).sqrt();
                let between =
                    |x: f64, half: f64| libm::erf((x + half) / width) - libm::erf((x - half) / width);
                let response =
                    0.25 * between(at[0], 0.5) * between(at[1], 0.3) / (2.0 * (0.5 * PI * age).sqrt());
                let weight = 2.0 * step * s / f64::from(n) * response;
                sums[0] += weight * (1.0 - s * s);
                sums[1] += weight * s * s;
            }
            assert!((rising - sums[0]).abs() < 1e-8 && (falling - sums[1]).abs() < 1e-8, "{at:?}");
        }
        // A cell much larger than ℓ is heated like a half-space, 2√(t/π)/β, with two thirds from a growing
        // flux.
        let wide = Cell::new([100.0; 2]).ramps([0.0; 2], &thermal, step);
        let plane = 2.0 * (step / PI).sqrt() / thermal.effusivity();
        assert_relative_eq!(wide[0], plane / 1.5, max_relative = 1e-13);
        assert_relative_eq!(wide[1], plane / 3.0, max_relative = 1e-13);
    }
}
