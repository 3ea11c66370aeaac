//! Johnson's translation system: curves that give Gaussian numbers a skewness and a kurtosis.

use asperity_base::error::{Result, check};

/// A curve z = f(g): for a Gaussian number g with mean 0 and variance 1, z has mean 0, variance 1 and the
/// prescribed skewness and kurtosis.
///
/// Johnson, Biometrika 36, 149 (1949). In the plane of skewness and kurtosis, the unbounded curves S_U lie
/// above the line of the log-normal curves S_L, and the bounded ones S_B below it,
///
/// z ∝ sinh(x g + c),   z ∝ 1/(1 + exp(c − x g)),   both S_L as c → ∞,
///
/// for a skewness ≥ 0; a negative one changes both signs. x and c follow from the moments, as in Hill, Hill &
/// Holder, Appl. Stat. 25, 180 (1976). Here both curves use moments by quadrature: c is solved for the
/// skewness at each x, and x for the kurtosis.
#[derive(Debug, Clone, Copy)]
pub(super) struct Johnson {
    sign: f64,
    curve: Curve,
    mean: f64,
    deviation: f64,
}

#[derive(Debug, Clone, Copy)]
enum Curve {
    Unbounded { x: f64, c: f64 },
    Bounded { x: f64, c: f64 },
}

impl Johnson {
    /// Finds the curve with the skewness `ssk` and kurtosis `sku`, 1.1 (Ssk² + 1) ≤ Sku ≤ 50.
    ///
    /// Every distribution has a kurtosis of at least Ssk² + 1, with equality for two values only.
    pub(super) fn new(ssk: f64, sku: f64) -> Result<Self> {
        check("ssk", ssk, ssk.abs() <= 6.0, "a skewness from −6 to 6")?;
        let reachable = (1.1 * (ssk * ssk + 1.0)..=50.0).contains(&sku);
        check("sku", sku, reachable, "a kurtosis from 1.1 (Ssk² + 1) to 50")?;
        let average = Average::new();
        let [skewness, omega] = [ssk.abs(), log_normal(ssk.abs())];
        let line = omega.powi(4) + 2.0 * omega.powi(3) + 3.0 * omega.powi(2) - 3.0;
        let of =
            |x: f64, c: f64| if sku > line { Curve::Unbounded { x, c } } else { Curve::Bounded { x, c } };
        let at = |x: f64| {
            // Beyond this c a curve equals the log-normal one to 10⁻⁸ at all practical heights.
            let log_normal = 20.0 + 5.0 * x;
            let c = root([0.0, log_normal], 1e-11, |c| average.moments(|g| of(x, c).height(g))[2] - skewness);
            of(x, c)
        };
        // Along the curves of constant skewness the kurtosis departs from the line with x; ln Sku and ln(Sku
        // − Ssk² − 1) are closer to linear.
        let excess = |x: f64| {
            let curve = at(x);
            let kurtosis = average.moments(|g| curve.height(g))[3];
            (kurtosis - ssk * ssk - 1.0).max(1e-6).ln() - (sku - ssk * ssk - 1.0).ln()
        };
        let least = omega.ln().sqrt().max(1e-3);
        let most = if sku > line { 1.2f64.max(least) } else { 20.0 };
        let curve = at(root([least.ln(), most.ln()], 1e-9, |x| excess(x.exp())).exp());
        let [mean, deviation, ..] = average.moments(|g| curve.height(g));
        Ok(Self { sign: 1f64.copysign(ssk), curve, mean, deviation })
    }

    /// f(g).
    pub(super) fn height(&self, g: f64) -> f64 {
        self.sign * (self.curve.height(self.sign * g) - self.mean) / self.deviation
    }

    /// Returns the contributions c₁, c₂, … to the variance in the expansion of f in Hermite polynomials. The
    /// autocorrelation r of f(g) follows from that of g, ρ, as r = Σ cₖ ρᵏ (Mehler). Their sum is 1; the last
    /// one includes the rest of the series.
    pub(super) fn shares(&self) -> [f64; TERMS] {
        let average = Average::new();
        let mut coefficients = [0.0; TERMS];
        for &[g, weight] in &average.nodes {
            let value = weight * self.height(g);
            // Hermite polynomials with variance 1: √(n+1) h₊ = g h − √n h₋.
            let (mut before, mut polynomial) = (1.0, g);
            for (n, coefficient) in coefficients.iter_mut().enumerate() {
                *coefficient += value * polynomial;
                let n = (n + 1) as f64;
                (before, polynomial) = (polynomial, (g * polynomial - n.sqrt() * before) / (n + 1.0).sqrt());
            }
        }
        let mut shares = coefficients.map(|a| a * a);
        shares[TERMS - 1] += 1.0 - shares.iter().sum::<f64>();
        shares
    }
}

/// Number of terms in the expansion.
const TERMS: usize = 48;

impl Curve {
    fn height(self, g: f64) -> f64 {
        match self {
            // Divided by exp(c), which would only cost digits.
            Self::Unbounded { x, c } => {
                let power = (x * g).exp();
                power - (-2.0 * c).exp() / power
            }
            Self::Bounded { x, c } => 1.0 / ((-c).exp() + (-x * g).exp()),
        }
    }
}

/// Returns ω of the log-normal curve with this skewness ≥ 0: (ω − 1)(ω + 2)² = Ssk², for which Sku = ω⁴ + 2ω³ + 3ω² − 3.
fn log_normal(skewness: f64) -> f64 {
    root([1.0, 6.0], 1e-12, |omega| (omega - 1.0) * (omega + 2.0).powi(2) - skewness * skewness)
}

/// Averages over a Gaussian number.
struct Average {
    /// Abscissas and weights.
    nodes: Vec<[f64; 2]>,
}

impl Average {
    /// Creates the trapezoidal rule, which converges faster than any power for functions that are smooth on
    /// the scale of the step.
    fn new() -> Self {
        /// Step of the rule, in standard deviations.
        const STEP: f64 = 1.0 / 16.0;
        // Fourth powers of exp(x g), x ≤ 1.3, have most of their weight near g = 4 x.
        const REACH: i32 = (14.0 / STEP) as i32;
        let scale = STEP / std::f64::consts::TAU.sqrt();
        let node = |n: i32| {
            let g = STEP * f64::from(n);
            [g, scale * (-0.5 * g * g).exp()]
        };
        Self { nodes: (-REACH..=REACH).map(node).collect() }
    }

    /// Returns the mean, standard deviation, skewness and kurtosis of f(g).
    fn moments(&self, f: impl Fn(f64) -> f64) -> [f64; 4] {
        let mean: f64 = self.nodes.iter().map(|&[g, weight]| weight * f(g)).sum();
        let mut central = [0.0; 3];
        for &[g, weight] in &self.nodes {
            let z = f(g) - mean;
            let square = weight * z * z;
            central[0] += square;
            central[1] += square * z;
            central[2] += square * z * z;
        }
        let [second, third, fourth] = central;
        [mean, second.sqrt(), third / second.powf(1.5), fourth / (second * second)]
    }
}

/// Finds the zero of a monotone `f` between `a` < `b`, to `epsilon`. Without a change of sign, returns the
/// end where it is closer to 0.
///
/// The method interpolates, truncates and projects. It converges faster than linearly, with at most one
/// evaluation more than bisection. Oliveira & Takahashi, ACM Trans. Math. Softw. 47, 5 (2021), with κ₁ =
/// 0.2/(b − a), κ₂ = 1, n₀ = 1.
fn root([mut a, mut b]: [f64; 2], epsilon: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (mut at_a, mut at_b) = (f(a), f(b));
    if at_a * at_b >= 0.0 {
        return if at_a.abs() < at_b.abs() { a } else { b };
    }
    let truncation = 0.2 / (b - a);
    let mut radius = epsilon * 2f64.powi(((b - a) / epsilon).log2().ceil() as i32);
    while b - a > 2.0 * epsilon {
        let middle = 0.5 * (a + b);
        let secant = (a * at_b - b * at_a) / (at_b - at_a);
        let towards = 1f64.copysign(middle - secant);
        let step = (truncation * (b - a) * (b - a)).min((middle - secant).abs());
        let allowed = radius - 0.5 * (b - a);
        let trial = middle - towards * (middle - secant - towards * step).abs().min(allowed);
        let at_trial = f(trial);
        if at_trial == 0.0 {
            return trial;
        }
        *(if at_trial * at_a > 0.0 { &mut a } else { &mut b }) = trial;
        *(if at_trial * at_a > 0.0 { &mut at_a } else { &mut at_b }) = at_trial;
        radius *= 0.5;
    }
    0.5 * (a + b)
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    /// Unbounded, bounded, one-sided, nearly two-valued, and on the log-normal line (ω = 1.2).
    const SHAPES: [[f64; 2]; 14] = [
        [0.0, 3.5],
        [0.0, 50.0],
        [-0.5, 3.5],
        [-1.0, 4.5],
        [1.0, 4.0],
        [-2.0, 10.0],
        [3.0, 30.0],
        [0.0, 1.8],
        [0.0, 1.1],
        [0.3, 2.2],
        [2.0, 5.6],
        [6.0, 41.0],
        [-6.0, 50.0],
        [1.431_083_506_3, 6.8496],
    ];

    #[test]
    fn a_curve_has_the_moments_asked_for() {
        // Compared with a rule with a third of the step and a longer reach.
        let fine = (-4800..=4800).map(|n| f64::from(n) / 300.0);
        for [ssk, sku] in SHAPES {
            let curve = Johnson::new(ssk, sku).unwrap();
            let moment = |p: i32| {
                let terms = fine.clone().map(|g| curve.height(g).powi(p) * (-0.5 * g * g).exp());
                terms.sum::<f64>() / 300.0 / std::f64::consts::TAU.sqrt()
            };
            assert!(moment(1).abs() < 1e-9, "{ssk}, {sku}: mean {:e}", moment(1));
            assert_relative_eq!(moment(2), 1.0, max_relative = 1e-8);
            assert_relative_eq!(moment(3), ssk, epsilon = 1e-7, max_relative = 1e-7);
            assert_relative_eq!(moment(4), sku, max_relative = 1e-7);
        }
    }

    #[test]
    fn curves_rise() {
        for [ssk, sku] in SHAPES {
            let curve = Johnson::new(ssk, sku).unwrap();
            let heights: Vec<f64> = (-60..=60).map(|n| curve.height(0.1 * f64::from(n))).collect();
            assert!(heights.windows(2).all(|pair| pair[0] <= pair[1]), "{ssk}, {sku}");
        }
    }

    #[test]
    fn the_gaussian_and_the_log_normal_curve_are_their_limits() {
        let gaussian = Johnson::new(0.0, 3.0).unwrap();
        let log_normal = Johnson::new(SHAPES[13][0], SHAPES[13][1]).unwrap();
        let omega = 1.2f64;
        for g in [-3.0, -1.0, 0.0, 0.5, 2.0, 4.0] {
            assert!(
                (gaussian.height(g) - g).abs() < 1e-4 * (1.0 + g * g * g.abs()),
                "{}",
                gaussian.height(g)
            );
            let power = (omega.ln().sqrt() * g).exp();
            let expected = (power - omega.sqrt()) / (omega * (omega - 1.0)).sqrt();
            assert!((log_normal.height(g) - expected).abs() < 1e-5 * (1.0 + expected.abs()), "{g}");
        }
    }

    #[test]
    fn shares_give_the_autocorrelation_of_two_translated_numbers() {
        for [ssk, sku] in [[-1.0, 4.5], [2.0, 9.0], [0.0, 5.0], [0.0, 1.8]] {
            let curve = Johnson::new(ssk, sku).unwrap();
            let shares = curve.shares();
            assert!(shares.iter().all(|share| *share > -1e-12));
            for rho in [-0.9f64, -0.2, 0.3, 0.8] {
                let nodes = Average::new().nodes;
                let mut expected = 0.0;
                for [a, weight] in nodes.iter().step_by(2).map(|[g, w]| [*g, 2.0 * w]) {
                    for [b, other] in nodes.iter().step_by(2).map(|[g, w]| [*g, 2.0 * w]) {
                        let second = rho * a + (1.0 - rho * rho).sqrt() * b;
                        expected += weight * other * curve.height(a) * curve.height(second);
                    }
                }
                let series: f64 = shares.iter().rev().fold(0.0, |sum, share| (sum + share) * rho);
                assert!((series - expected).abs() < 1e-5, "{ssk}, {sku} at {rho}: {series}, not {expected}");
            }
        }
    }

    #[test]
    fn moments_that_no_heights_have_are_refused() {
        for ([ssk, sku], message) in [
            ([1.0, 2.0], "sku is 2,"),
            ([0.0, 51.0], "sku is 51"),
            ([0.0, f64::NAN], "sku is NaN"),
            ([f64::NAN, 3.0], "ssk is NaN"),
            ([-6.1, 3.0], "ssk is -6.1"),
        ] {
            let error = Johnson::new(ssk, sku).unwrap_err().to_string();
            assert!(error.starts_with(message), "{error}");
        }
    }
}
