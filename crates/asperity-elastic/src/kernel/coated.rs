//! An elastic layer bonded to a half-space.

use crate::error::Result;
use crate::kernel::{Influence, Layering, Response, SharedResponse};
use crate::material::{Coating, Compliances, Material};
use crate::units::{Metre, Pascal};

/// Returns the response of bodies of these materials to a traction. Coated bodies respond only to a pressure.
///
/// # Errors
/// [`crate::Error::OutOfRange`] if both bodies are rigid.
pub fn response(lower: &Material, upper: &Material) -> Result<SharedResponse> {
    let compliances = Compliances::new(lower, upper)?;
    let of = |material: &Material| match material.coating {
        Some(coating) => CoatedHalfSpace::new(material, &coating).into(),
        None => SharedResponse::from(material.plane_strain_modulus()),
    };
    match [lower.coating, upper.coating] {
        [None, None] => Ok(compliances.into()),
        _ => Ok([of(lower), of(upper)].into()),
    }
}

/// Sum of the displacements of two bodies, each pressed by a rigid one.
impl Response for [SharedResponse; 2] {
    fn harmonic_displacement(&self, qx: f64, qy: f64) -> f64 {
        self.iter().map(|body| body.harmonic_displacement(qx, qy)).sum()
    }

    fn influence(&self, pitch: [Metre; 2]) -> Box<dyn Influence> {
        let [lower, upper] = self.each_ref().map(|body| body.influence(pitch));
        Box::new(move |x: Metre, y: Metre| lower.displacement(x, y) + upper.displacement(x, y))
    }
}

/// A half-space with a bonded elastic layer, pressed by a rigid body.
///
/// For a layer (G₁, ν₁) of thickness t on a half-space (G₂, ν₂), with x = qt, θ = e^(−2x), a = 3 − 4ν₁, b = 3
/// − 4ν₂ and μ = G₁/G₂,
///
/// ```text
///           1 − ν₁   1 + 4κxθ − λκθ²                          μb − a         μ − 1
/// û(q) p̂ = ─────── ─────────────────────────────── p̂    λ = ────────   κ = ───────
///            G₁ q    1 − (λ + κ + 4κx²) θ + λκθ²              1 + μb         μ + a
/// ```
/// O'Sullivan and King, J. Tribol. 110, 235 (1988).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoatedHalfSpace {
    layering: Layering,
    thickness: Metre,
    /// μ, a and b.
    ratio: f64,
    constants: [f64; 2],
}

impl CoatedHalfSpace {
    /// Creates a `coating` on a half-space of the material `base`, whose own coating is ignored.
    pub fn new(base: &Material, coating: &Coating) -> Self {
        let shear = |young: Pascal, poisson: f64| 0.5 * young / (1.0 + poisson);
        let layer = Material { young: coating.young, poisson: coating.poisson, ..*base };
        let compliance = |material: &Material| material.plane_strain_modulus().recip();
        Self {
            layering: Layering {
                short: compliance(&layer),
                long: compliance(base),
                depth: 2.0 * coating.thickness,
            },
            thickness: coating.thickness,
            ratio: shear(coating.young, coating.poisson) / shear(base.young, base.poisson),
            constants: [coating.poisson, base.poisson].map(|poisson| 3.0 - 4.0 * poisson),
        }
    }

    /// Returns û of the wavenumber q > 0, m/Pa. It is exact to rounding, also for long waves on an
    /// incompressible layer.
    fn harmonic(&self, q: f64) -> f64 {
        let &Self { ratio: mu, constants: [a, b], thickness, .. } = self;
        let x = q * thickness;
        let lambda = (mu * b - a) / (1.0 + mu * b);
        let kappa = (mu - 1.0) / (mu + a);
        let ratio = if x > LONG {
            let theta = (-2.0 * x).exp();
            (1.0 + (4.0 * kappa * x - lambda * kappa * theta) * theta)
                / (1.0 - (lambda + kappa + 4.0 * kappa * x * x - lambda * kappa * theta) * theta)
        } else {
            // Both are divided by θ, without the cancelling terms: 1 − λκ, 1 + λ and (1 − λ)(1 − κ) are
            // products.
            let scale = ((1.0 + mu * b) * (mu + a)).recip();
            let rest = mu * (1.0 + a) * (1.0 + b) * scale;
            let one_plus_lambda = (2.0 * mu * b + (1.0 - a)) / (1.0 + mu * b);
            let one_minus_lambda = (1.0 + a) / (1.0 + mu * b);
            let above = rest * (2.0 * x).exp()
                + 2.0 * lambda * kappa * odd_rest(2.0 * x)
                + 4.0 * x * kappa * one_plus_lambda;
            let below = (1.0 + a).powi(2) * scale
                + rest * (2.0 * x).exp_m1()
                + 4.0 * kappa * (lambda * square_rest(x) - one_minus_lambda * x * x);
            above / below
        };
        2.0 * self.layering.short / q * ratio
    }
}

impl Response for CoatedHalfSpace {
    fn harmonic_displacement(&self, qx: f64, qy: f64) -> f64 {
        let q = qx.hypot(qy);
        if q == 0.0 { 0.0 } else { self.harmonic(q) }
    }

    fn influence(&self, pitch: [Metre; 2]) -> Box<dyn Influence> {
        self.layering.influence(|q| self.harmonic(q), pitch)
    }
}

/// Above this qt nothing cancels, and e^(4qt) would soon overflow.
const LONG: f64 = 2.0;

/// sinh x − x.
fn odd_rest(x: f64) -> f64 {
    if x < 1.0 { series(x * x * x / 6.0, x * x, 4.0) } else { x.sinh() - x }
}

/// sinh² x − x².
fn square_rest(x: f64) -> f64 {
    if x < 1.0 { 0.5 * series(16.0 * x.powi(4) / 24.0, 4.0 * x * x, 5.0) } else { x.sinh().powi(2) - x * x }
}

/// Sums a series from its first term. Each term is the previous one times `square`/n(n + 1), n = `from`,
/// `from` + 2, ….
fn series(first: f64, square: f64, from: f64) -> f64 {
    let (mut term, mut sum, mut n) = (first, first, from);
    while term > f64::EPSILON * sum {
        term *= square / (n * (n + 1.0));
        sum += term;
        n += 2.0;
    }
    sum
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use approx::assert_relative_eq;

    use super::*;
    use crate::kernel::normal_displacement;
    use crate::math::gauss_legendre;

    const RIGID: f64 = f64::INFINITY;

    fn coated([young, poisson]: [f64; 2], thickness: f64, layer: [f64; 2]) -> CoatedHalfSpace {
        let base = Material::elastic(young, poisson).unwrap();
        CoatedHalfSpace::new(&base, &Coating::new(thickness, layer[0], layer[1]).unwrap())
    }

    /// Bodies of all kinds: `[E, ν]` of the half-space, thickness, `[E, ν]` of the layer.
    const BODIES: [([f64; 2], f64, [f64; 2]); 8] = [
        ([1.0, 0.2], 2.0, [3.0, 0.3]),
        ([RIGID, 0.3], 1.0, [1.0, 0.3]),
        ([RIGID, 0.3], 1.0, [1.0, 0.5]),
        ([1.0, 0.5], 0.7, [1e3, 0.2]),
        ([1e3, 0.1], 0.7, [1.0, 0.49]),
        ([1.0, 0.3], 1.0, [1.0, 0.0]),
        ([1.0, 0.5], 1.0, [2.0, 0.5]),
        ([5.0, 0.0], 3.0, [4.0, 0.45]),
    ];

    #[test]
    fn harmonics_are_those_of_the_formula_in_sixty_digits() {
        for (q, thickness, layer, base, exact) in [
            (0.5, 2.0, [7.8, 0.3], [2.4, 0.2], 0.893_757_918_614_764_7),
            (1e-3, 2.0, [1.0, 0.5], [RIGID, 0.3], 7.999_942_400_420_568e-6),
            (1e-5, 1.0, [3.0, 0.4], [RIGID, 0.0], 0.155_555_555_565_925_93),
            (0.1, 1.0, [1e3, 0.3], [1.0, 0.25], 14.036_250_122_261_462),
            (1e-4, 1.0, [1e3, 0.1], [1.0, 0.5], 15_000.000_958_084_13),
            (0.3, 1.0, [1.0, 0.49], [1e3, 0.1], 0.133_356_395_128_696_92),
            (25.0, 1.0, [3.0, 0.2], [1.0, 0.3], 0.0256),
            (0.999, 1.0, [1.0, 0.5], [2.0, 0.5], 0.964_118_701_543_266_5),
            (1.0001, 1.0, [1.0, 0.5], [2.0, 0.5], 0.963_459_758_511_193),
        ] {
            let body = coated(base, thickness, layer);
            assert_relative_eq!(body.harmonic_displacement(0.6 * q, -0.8 * q), exact, max_relative = 2e-14);
        }
    }

    #[test]
    fn without_contrast_it_is_the_half_space_and_its_limits_are_half_spaces() {
        let same = coated([2.0, 0.3], 0.4, [2.0, 0.3]);
        for q in [1e-6, 1e-2, 1.0, 30.0] {
            assert_relative_eq!(same.harmonic(q), 2.0 * 0.91 / (2.0 * q), max_relative = 1e-14);
        }
        for (base, _, layer) in BODIES {
            let compliance = |[young, poisson]: [f64; 2]| (1.0 - poisson * poisson) / young;
            let thick = coated(base, 1e3, layer);
            assert_relative_eq!(thick.harmonic(1.0), 2.0 * compliance(layer), max_relative = 1e-14);
            // The next term is that of a foundation; the bending of a stiff layer is x³ times the contrast.
            let thin = coated(base, 1e-9, layer);
            assert_relative_eq!(
                thin.harmonic(1.0),
                2.0 * compliance(base),
                epsilon = 3e-6 * compliance(base) + 2e-9
            );
        }
    }

    #[test]
    fn a_thin_layer_on_a_rigid_base_is_a_foundation_unless_it_cannot_be_compressed() {
        let thickness = 1e-4;
        let at = |poisson: f64| coated([RIGID, 0.0], thickness, [1.0, poisson]).harmonic(1.0);
        let nu = 0.3;
        let foundation = thickness * (1.0 + nu) * (1.0 - 2.0 * nu) / (1.0 - nu);
        assert_relative_eq!(at(nu), foundation, max_relative = 1e-7);
        // Lubrication: w = p q² t³/3G.
        assert_relative_eq!(at(0.5), thickness.powi(3), max_relative = 1e-7);
    }

    #[test]
    fn every_harmonic_gives_way_whatever_the_layer() {
        arbtest::arbtest(|u| {
            let mut share =
                || Ok::<f64, arbtest::arbitrary::Error>(u.arbitrary::<u32>()? as f64 / f64::from(u32::MAX));
            let contrast = 10f64.powf(8.0 * share()? - 4.0);
            let base = [if share()? < 0.1 { RIGID } else { contrast }, 0.5 * (1.2 * share()?).min(1.0)];
            let body = coated(base, 1.0, [1.0, 0.5 * (1.2 * share()?).min(1.0)]);
            let mut before = f64::INFINITY;
            for k in -60..=20 {
                let q = 10f64.powf(0.1 * f64::from(k));
                let value = body.harmonic(q);
                assert!(0.0 < value && value.is_finite(), "{body:?} at {q}: {value}");
                before = before.min(value);
            }
            Ok(())
        })
        .budget_ms(300);
    }

    /// Computes the displacement minus that of a half-space of the layer material, by a sum over all
    /// directions and wavenumbers of the remaining harmonics. It is slow, and independent of the closed forms
    /// and tables.
    fn beyond_the_layer(body: &CoatedHalfSpace, at: [f64; 2], pitch: [f64; 2]) -> f64 {
        let short = body.layering.short;
        let end = 45.0 / body.layering.depth;
        let reach = (at[0] + 0.5 * pitch[0]).hypot(at[1] + 0.5 * pitch[1]);
        let sinc = |x: f64| if x == 0.0 { 1.0 } else { x.sin() / x };
        let nodes = gauss_legendre(10);
        let mut sum = 0.0;
        let mut start = 1e-13 / reach.max(body.thickness);
        while start < end {
            let half = 0.5 * start.min(3.0 / reach).min(3.0 / body.layering.depth);
            for (node, weight) in &nodes {
                let q = start + half * (1.0 + node);
                let directions = 40 + (1.5 * q * reach) as usize;
                let mean: f64 = (0..directions)
                    .map(|k| {
                        let (sin, cos) = (0.5 * PI * (k as f64 + 0.5) / directions as f64).sin_cos();
                        let wave = [q * cos, q * sin];
                        (0..2)
                            .map(|i| sinc(0.5 * wave[i] * pitch[i]) * (wave[i] * at[i]).cos())
                            .product::<f64>()
                    })
                    .sum();
                let left = body.harmonic(q) - 2.0 * short / q;
                sum += weight * half * q * left * mean / directions as f64;
            }
            start += 2.0 * half;
        }
        sum * pitch[0] * pitch[1] / TAU
    }

    #[test]
    fn its_cells_are_the_sum_of_its_harmonics_whatever_the_thickness() {
        for (base, thickness, layer) in BODIES {
            for pitch in [[1.0, 1.0], [0.05, 0.03], [12.0, 5.0], [0.3, 4.0]].map(|p| p.map(|p| p * thickness))
            {
                let body = coated(base, thickness, layer);
                let influence = body.influence(pitch);
                let love = |x, y| body.layering.short * normal_displacement(x, y, pitch, 1.0);
                let own = influence.displacement(0.0, 0.0);
                assert!(own > 0.0, "{body:?}, {pitch:?}");
                for cells in [[0.0, 0.0], [1.0, 0.0], [2.0, 3.0], [9.0, 5.0]] {
                    let [x, y] = [0, 1].map(|axis| cells[axis] * pitch[axis]);
                    let slow = beyond_the_layer(&body, [x, y], pitch);
                    let fast = influence.displacement(x, y) - love(x, y);
                    let scale = own.max(love(0.0, 0.0));
                    assert!(
                        (slow - fast).abs() < 1e-10 * scale,
                        "{body:?}, {pitch:?}, {cells:?}: {fast:e}, {slow:e}, {:e} of {scale:e}",
                        slow - fast
                    );
                }
            }
        }
    }
}
