//! Tables of transforms of what harmonics leave over.

use std::f64::consts::PI;

use crate::math::{gauss_legendre, parallel};
use crate::units::Metre;

/// Transforms of functions R(q), see [`Transform`], tabulated over asinh(r/d).
///
/// Each is multiplied by a power of r² + d², and is then bounded and smooth.
pub(super) struct Remainder<const N: usize> {
    /// The depth d.
    pub(super) depth: Metre,
    transforms: [Transform; N],
    /// Chebyshev coefficients of all of them, for each interval of unit width in asinh(r/d).
    pieces: Vec<[[f64; N]; ORDER]>,
    nodes: Vec<(f64, f64)>,
}

/// A transform of a function R(q).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Transform {
    /// ρ(r) = ∫ R(q) J₀(qr) q dq/2π.
    Hankel,
    /// ∫ R(q) Jₙ(qr) q dq/2π, n > 0.
    Order(i32),
    /// Mean of ρ within r, w(r) = ∫₀^r ρ(s) s ds/r² = ∫ R(q) J₁(qr)/(qr) q dq/2π.
    Mean,
    /// φ(r) = ∫ R(q) J₀(qr) dq/2π.
    Potential,
    /// ∫ R(q) cos qr dq/π: ρ of a line load, at the distance r across it.
    Cosine,
    /// ∫ R(q) sin qr dq/π.
    Sine,
}

impl Transform {
    /// Returns the factor of the tabulated values, for r² + d².
    fn power(self, squared: f64) -> f64 {
        if matches!(self, Self::Potential | Self::Sine) { squared.sqrt() } else { squared }
    }

    /// The integrand over R(q), at x = qr.
    fn weight(self, q: f64, x: f64) -> f64 {
        match self {
            Self::Hankel => q * libm::j0(x),
            Self::Order(1) => q * libm::j1(x),
            Self::Order(order) => q * libm::jn(order, x),
            Self::Mean => q * if x < 1e-4 { 0.5 } else { libm::j1(x) / x },
            Self::Potential => libm::j0(x),
            Self::Cosine => 2.0 * x.cos(),
            Self::Sine => 2.0 * x.sin(),
        }
    }
}

/// Number of Chebyshev coefficients of an interval. The nearest singularity, at a distance of ±iπ/2, gives an
/// error of 6⁻¹⁸.
const ORDER: usize = 18;
/// Number of intervals, up to r = 2e8 d. The longest scale of a layer 1000 times as stiff as the body below is that of its
/// stretching, 1000 times its thickness.
const PIECES: usize = 20;

impl<const N: usize> Remainder<N> {
    /// Tabulates a transform of each of the functions `rest` = R(q) of one scale, for distances up to `reach`.
    pub(super) fn new(
        rest: impl Fn(f64) -> [f64; N] + Sync,
        transforms: [Transform; N],
        depth: Metre,
        reach: Metre,
    ) -> Self {
        let nodes = gauss_legendre(16);
        let count = ((reach / depth).asinh() as usize).saturating_add(1).min(PIECES);
        let pieces = parallel::tasks(0..count, |piece| {
            let values: [[f64; N]; ORDER] = std::array::from_fn(|k| {
                let r = depth * (piece as f64 + 0.5 + 0.5 * chebyshev_angle(k, ORDER).cos()).sinh();
                hankel(&rest, transforms, r, depth, &nodes)
            });
            chebyshev(&values)
        });
        Self { depth, transforms, pieces, nodes }
    }

    /// Returns the transforms at the distance r.
    pub(super) fn at(&self, r: Metre) -> [f64; N] {
        let s = (r / self.depth).asinh();
        let end = self.pieces.len() as f64;
        // Beyond the table ρ decays further, but none of the others.
        let (s, beyond) = if s < end { (s, 1.0) } else { (end, self.depth * end.sinh() / r) };
        let piece = (s as usize).min(self.pieces.len() - 1);
        let values = clenshaw(&self.pieces[piece], 2.0 * (s - piece as f64) - 1.0);
        let squared = r * r + self.depth * self.depth;
        std::array::from_fn(|n| {
            let beyond = if self.transforms[n] == Transform::Hankel { beyond } else { 1.0 };
            values[n] * beyond / self.transforms[n].power(squared)
        })
    }
}

/// ρ and w.
impl Remainder<2> {
    /// Computes ∬ ρ over 0 … x and 0 … y. In polar coordinates it is the integral of r² w over the angle.
    /// Each of the two far sides contributes ∫ c w(√(c² + s²)) ds with its distance c.
    pub(super) fn of_rectangle(&self, x: Metre, y: Metre) -> f64 {
        let side = |c: f64, length: f64| {
            let [sum] = along_side(c, length, self.depth, &self.nodes, |r, _| [self.at(r)[1]]);
            c * sum
        };
        side(x, y) + side(y, x)
    }
}

/// Computes ∫ f(√(c² + s²), s) ds over 0 … `length` of functions that are smooth on the scale `depth`, with s = √(c² + d²) sinh v.
pub(super) fn along_side<const N: usize>(
    c: Metre,
    length: Metre,
    depth: Metre,
    nodes: &[(f64, f64)],
    f: impl Fn(Metre, Metre) -> [f64; N],
) -> [f64; N] {
    let scale = c.hypot(depth);
    let end = (length / scale).asinh();
    let panels = end.abs().ceil().max(1.0);
    let half = 0.5 * end / panels;
    let mut sums = [0.0; N];
    for panel in 0..panels as usize {
        for &(node, weight) in nodes {
            let v = half * ((2 * panel + 1) as f64 + node);
            let s = scale * v.sinh();
            let values = f(c.hypot(s), s);
            sums = std::array::from_fn(|n| sums[n] + weight * v.cosh() * values[n]);
        }
    }
    sums.map(|sum| sum * half * scale)
}

/// Computes transforms at `r`, times their powers of r² + d², by Gauss' rule on panels that grow with q up to a few
/// oscillations.
///
/// At large r only the first oscillations contribute. The integrand is then tapered over many oscillations,
/// which changes its transform by less than rounding.
fn hankel<const N: usize>(
    rest: &impl Fn(f64) -> [f64; N],
    transforms: [Transform; N],
    r: Metre,
    depth: Metre,
    nodes: &[(f64, f64)],
) -> [f64; N] {
    /// Lower limit of the integral, in units of 1/r and 1/d. Below it the integrand is that at the limit.
    const FIRST: f64 = 1e-7;
    /// e^(−qd) is less than 1e-19.
    const LAST: f64 = 45.0;
    /// Centre and width of the taper of the integrand in qr.
    const FADE: [f64; 2] = [96.0, 12.0];
    /// Largest change of qr and of qd over a panel.
    const PHASE: f64 = 6.0;
    let longest = PHASE / r.max(depth);
    let end = (LAST / depth).min((FADE[0] + 6.0 * FADE[1]) / r);
    let mut start = FIRST / r.max(depth);
    let mut sums = [0.0; N];
    let mut add = |q: f64, width: f64| {
        let values = rest(q);
        let mut weights = [0.0; N];
        for n in 0..N {
            let known = transforms[..n].iter().position(|other| *other == transforms[n]);
            weights[n] = known.map_or_else(|| transforms[n].weight(q, q * r), |known| weights[known]);
            sums[n] += width * values[n] * weights[n];
        }
    };
    add(0.5 * start, start);
    while start < end {
        let half = 0.5 * start.min(longest).min(end - start);
        for &(node, weight) in nodes {
            let q = start + half * (1.0 + node);
            add(q, weight * half * 0.5 * libm::erfc((q * r - FADE[0]) / FADE[1]));
        }
        start += 2.0 * half;
    }
    let squared = r * r + depth * depth;
    std::array::from_fn(|n| sums[n] * transforms[n].power(squared) / (2.0 * PI))
}

/// Returns the angle of the k-th node of an interval with this number of them.
pub(super) fn chebyshev_angle(k: usize, count: usize) -> f64 {
    PI * (k as f64 + 0.5) / count as f64
}

/// Returns the coefficients of the polynomials with these values at the nodes.
pub(super) fn chebyshev<const N: usize, const K: usize>(values: &[[f64; N]; K]) -> [[f64; N]; K] {
    std::array::from_fn(|order| {
        let scale = if order == 0 { 1.0 } else { 2.0 } / K as f64;
        std::array::from_fn(|n| {
            let sum: f64 = (0..K).map(|k| values[k][n] * (order as f64 * chebyshev_angle(k, K)).cos()).sum();
            sum * scale
        })
    })
}

/// Σ cₙ Tₙ(x) of several polynomials.
pub(super) fn clenshaw<const N: usize, const K: usize>(coefficients: &[[f64; N]; K], x: f64) -> [f64; N] {
    let (mut one, mut two) = ([0.0; N], [0.0; N]);
    for c in coefficients[1..].iter().rev() {
        (one, two) = (std::array::from_fn(|n| c[n] + 2.0 * x * one[n] - two[n]), one);
    }
    std::array::from_fn(|n| coefficients[0][n] + x * one[n] - two[n])
}
