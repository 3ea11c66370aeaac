//! Bodies with bonded elastic layers.

use crate::error::Result;
use crate::kernel::{Influence, Layering, Response, SharedResponse, Stack};
use crate::material::{Compliances, Material};
use crate::units::Metre;

/// Returns the response of bodies of these materials to a traction. Bodies with layers respond only to a pressure.
///
/// # Errors
/// [`crate::Error::OutOfRange`] if both bodies are rigid.
pub fn response(lower: &Material, upper: &Material) -> Result<SharedResponse> {
    let compliances = Compliances::new(lower, upper)?;
    if !lower.is_layered() && !upper.is_layered() {
        return Ok(compliances.into());
    }
    let of = |material: &Material| match material.is_layered() {
        true => LayeredBody::new(material).into(),
        false => SharedResponse::from(material.plane_strain_modulus()),
    };
    Ok([of(lower), of(upper)].into())
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

/// A half-space or a rigid body with bonded elastic layers, pressed by a rigid body.
#[derive(Debug, Clone, PartialEq)]
pub struct LayeredBody {
    stack: Stack,
    layering: Layering,
}

impl LayeredBody {
    /// Creates the body of a `material` with its layers.
    ///
    /// # Panics
    /// If it has none.
    pub fn new(material: &Material) -> Self {
        let surface = material.layers.first().expect("a layer");
        let stack = Stack::new(material);
        // 1/E* is half of û q of a half-space.
        let layering = Layering {
            short: 0.5 * stack.short().normal,
            long: 0.5 * stack.long().normal,
            depth: 2.0 * surface.thickness,
        };
        Self { stack, layering }
    }
}

impl Response for LayeredBody {
    fn harmonic_displacement(&self, qx: f64, qy: f64) -> f64 {
        let q = qx.hypot(qy);
        if q == 0.0 { 0.0 } else { self.stack.response(q).normal }
    }

    fn influence(&self, pitch: [Metre; 2]) -> Box<dyn Influence> {
        self.layering.influence(|q| self.stack.response(q).normal, pitch)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use approx::assert_relative_eq;

    use super::*;
    use crate::kernel::normal_displacement;
    use crate::material::Coating;
    use crate::math::gauss_legendre;

    const RIGID: f64 = f64::INFINITY;

    fn coated([young, poisson]: [f64; 2], thickness: f64, layer: [f64; 2]) -> LayeredBody {
        let base = Material::elastic(young, poisson).unwrap();
        LayeredBody::new(&base.coated(Coating::new(thickness, layer[0], layer[1]).unwrap()))
    }

    impl LayeredBody {
        fn harmonic(&self, q: f64) -> f64 {
            self.harmonic_displacement(q, 0.0)
        }
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
    fn beyond_the_layer(body: &LayeredBody, at: [f64; 2], pitch: [f64; 2]) -> f64 {
        let short = body.layering.short;
        let end = 45.0 / body.layering.depth;
        let reach = (at[0] + 0.5 * pitch[0]).hypot(at[1] + 0.5 * pitch[1]);
        let sinc = |x: f64| if x == 0.0 { 1.0 } else { x.sin() / x };
        let nodes = gauss_legendre(10);
        let mut sum = 0.0;
        let mut start = 1e-13 / reach.max(0.5 * body.layering.depth);
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
