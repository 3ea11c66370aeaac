//! Bodies with bonded elastic layers.

use std::f64::consts::PI;

use crate::error::Result;
use crate::kernel::cell::integrals_below;
use crate::kernel::layering::{Remainder, Transform, along_side};
use crate::kernel::{
    Coefficients, CoupledInfluence, CoupledResponse, Influence, Layering, Response, SharedResponse, Stack,
    Wave, coupled_displacement, normal_displacement,
};
use crate::material::{Compliances, Material};
use crate::math::gauss_legendre;
use crate::units::Metre;

/// Returns the response of bodies of these materials to a traction.
///
/// # Errors
/// [`crate::Error::OutOfRange`] if both bodies are rigid.
pub fn response(lower: &Material, upper: &Material) -> Result<SharedResponse> {
    let compliances = Compliances::new(lower, upper)?;
    if !lower.is_layered() && !upper.is_layered() {
        return Ok(compliances.into());
    }
    let bodies = [lower, upper].map(LayeredBody::new);
    let couples = bodies[0] != bodies[1];
    Ok(LayeredPair { bodies: bodies.map(SharedResponse::from), couples }.into())
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

/// Two bodies, of which one has layers, under traction in all directions.
#[derive(Debug)]
struct LayeredPair {
    bodies: [SharedResponse; 2],
    couples: bool,
}

impl LayeredPair {
    fn each(&self) -> [&dyn CoupledResponse; 2] {
        self.bodies.each_ref().map(|body| body.coupled().expect("a body that responds to shear"))
    }
}

impl Response for LayeredPair {
    fn harmonic_displacement(&self, qx: f64, qy: f64) -> f64 {
        self.bodies.harmonic_displacement(qx, qy)
    }

    fn influence(&self, pitch: [Metre; 2]) -> Box<dyn Influence> {
        self.bodies.influence(pitch)
    }

    fn coupled(&self) -> Option<&dyn CoupledResponse> {
        Some(self)
    }
}

impl CoupledResponse for LayeredPair {
    fn couples(&self) -> bool {
        self.couples
    }

    fn harmonic_displacements(&self, qx: f64, qy: f64) -> Coefficients {
        let [lower, upper] = self.each().map(|body| body.harmonic_displacements(qx, qy));
        lower.against(upper)
    }

    fn coupled_influence(&self, pitch: [Metre; 2]) -> Box<CoupledInfluence> {
        let [lower, upper] = self.each().map(|body| body.coupled_influence(pitch));
        Box::new(move |x, y| lower(x, y).against(upper(x, y)))
    }
}

/// A half-space or a rigid body, with bonded elastic layers or without, under the traction of a rigid body above it.
#[derive(Debug, Clone, PartialEq)]
pub struct LayeredBody {
    stack: Stack,
    /// Compliances of a half-space of the material at the surface.
    surface: Compliances,
    /// Twice the thickness of the layer at the surface, if there is one.
    depth: Option<Metre>,
}

impl LayeredBody {
    /// Creates the body of a `material` with its layers.
    pub fn new(material: &Material) -> Self {
        let stack = Stack::new(material);
        let short = stack.short();
        // 1/E* is half of û q of a half-space.
        let surface = Compliances {
            normal: 0.5 * short.normal,
            lateral: 0.5 * (short.across - short.along),
            coupling: 0.5 * short.coupling,
        };
        Self { stack, surface, depth: material.layers.first().map(|layer| 2.0 * layer.thickness) }
    }
}

impl Response for LayeredBody {
    fn harmonic_displacement(&self, qx: f64, qy: f64) -> f64 {
        let q = qx.hypot(qy);
        if q == 0.0 { 0.0 } else { self.stack.normal(q) }
    }

    fn influence(&self, pitch: [Metre; 2]) -> Box<dyn Influence> {
        let short = self.surface.normal;
        match self.depth {
            None => Box::new(move |x, y| short * normal_displacement(x, y, pitch, 1.0)),
            Some(depth) => Layering { short, long: 0.5 * self.stack.long().normal, depth }
                .influence(|q| self.stack.normal(q), pitch),
        }
    }

    fn coupled(&self) -> Option<&dyn CoupledResponse> {
        Some(self)
    }
}

impl CoupledResponse for LayeredBody {
    fn couples(&self) -> bool {
        true
    }

    fn harmonic_displacements(&self, qx: f64, qy: f64) -> Coefficients {
        let q = qx.hypot(qy);
        if q == 0.0 {
            return Coefficients { xx: 0.0, xy: 0.0, yy: 0.0, zx: 0.0, zy: 0.0, zz: 0.0 };
        }
        let [cos, sin] = [qx / q, qy / q];
        let wave = self.stack.response(q);
        Coefficients {
            xx: wave.along * cos * cos + wave.across * sin * sin,
            xy: (wave.along - wave.across) * cos * sin,
            yy: wave.along * sin * sin + wave.across * cos * cos,
            zx: -wave.coupling * cos,
            zy: -wave.coupling * sin,
            zz: wave.normal,
        }
    }

    fn coupled_influence(&self, pitch: [Metre; 2]) -> Box<CoupledInfluence> {
        let Some(depth) = self.depth else { return self.surface.coupled_influence(pitch) };
        let (surface, normal) = (self.surface, self.influence(pitch));
        let below = BelowSurface::new(&self.stack, depth, pitch);
        Box::new(move |x, y| {
            let half_space = coupled_displacement(x, y, pitch, &surface);
            let [xx, xy, yy, zx, zy] = below.coefficients(x, y);
            Coefficients {
                xx: half_space.xx + xx,
                xy: half_space.xy + xy,
                yy: half_space.yy + yy,
                zx: half_space.zx + zx,
                zy: half_space.zy + zy,
                zz: normal.displacement(x, y),
            }
        })
    }
}

/// Displacements under the shear on a cell, and along the surface under the pressure on it, minus those of a half-space of
/// the material at the surface.
///
/// As in [`Layering`], the waves û = along, across and coupling are that half-space, the potential at the depth d, and a
/// remainder. With ρ and w of along and across, and φ and γ of coupling (see [`Transform`]) the displacements under a
/// point load are
///
/// ```text
/// xx = [w + (ρ − 2w) x²/r²]_along + [w + (ρ − 2w) y²/r²]_across      xy = [(ρ − 2w)_along − (ρ − 2w)_across] xy/r²
/// zx = γ x/r = −∂φ/∂x
/// ```
/// They are derivatives of xw, yw and φ, so that those of a cell are integrals along its sides.
struct BelowSurface {
    depth: Metre,
    half: [Metre; 2],
    /// ρ and w of along, those of across, φ and γ.
    table: Remainder<6>,
    /// Amplitudes of the potentials at the depth d: along, across and coupling.
    images: [f64; 3],
    nodes: Vec<(f64, f64)>,
}

impl BelowSurface {
    fn new(stack: &Stack, depth: Metre, pitch: [Metre; 2]) -> Self {
        use Transform::{Hankel, Mean, Order, Potential};
        let parts = |wave: Wave| [wave.along, wave.across, wave.coupling];
        let [short, long] = [stack.short(), stack.long()].map(parts);
        let rest = |q: f64| {
            let (waves, image) = (parts(stack.response(q)), (-q * depth).exp());
            let [along, across, coupling] =
                [0, 1, 2].map(|n| waves[n] - (short[n] + (long[n] - short[n]) * image) / q);
            [along, along, across, across, coupling, coupling]
        };
        let transforms = [Hankel, Mean, Hankel, Mean, Potential, Order(1)];
        Self {
            depth,
            half: pitch.map(|p| 0.5 * p),
            table: Remainder::new(rest, transforms, depth, Metre::INFINITY),
            images: [0, 1, 2].map(|n| (long[n] - short[n]) / (2.0 * PI)),
            nodes: gauss_legendre(16),
        }
    }

    /// Returns xx, xy, yy, zx and zy.
    fn coefficients(&self, x: Metre, y: Metre) -> [f64; 5] {
        let closed = |x: f64, y: f64| {
            let along_y = along_side(x, y, self.depth, &self.nodes, |r, _| {
                let [_, along, _, across, potential, _] = self.at(r);
                [along, across, potential]
            });
            let along_x = along_side(y, x, self.depth, &self.nodes, |r, s| {
                let [_, along, _, across, potential, _] = self.at(r);
                [along, across, potential, s * (along - across)]
            });
            [
                x * along_y[0] + y * along_x[1],
                along_x[3],
                y * along_x[0] + x * along_y[1],
                -along_y[2],
                -along_x[2],
            ]
        };
        integrals_below([x, y], self.depth, self.half, closed, |x, y| self.point([x, y]))
    }

    /// Returns the coefficients under a point load.
    fn point(&self, [x, y]: [Metre; 2]) -> [f64; 5] {
        let r = x.hypot(y);
        let [c, s] = if r == 0.0 { [0.0; 2] } else { [x / r, y / r] };
        let [density, w, density_across, w_across, _, slope] = self.at(r);
        let [turned, turned_across] = [density - 2.0 * w, density_across - 2.0 * w_across];
        [
            w + turned * c * c + w_across + turned_across * s * s,
            (turned - turned_across) * c * s,
            w + turned * s * s + w_across + turned_across * c * c,
            slope * c,
            slope * s,
        ]
    }

    /// Returns ρ and w of along, those of across, φ and γ, with the potentials at the depth d.
    fn at(&self, r: Metre) -> [f64; 6] {
        let [along, across, coupling] = self.images;
        let table = self.table.at(r);
        let far = r.hypot(self.depth);
        let images = [
            along / far,
            along / (far + self.depth),
            across / far,
            across / (far + self.depth),
            -coupling * (0.5 * (1.0 + far / self.depth)).ln(),
            coupling * r / (far * (far + self.depth)),
        ];
        std::array::from_fn(|n| table[n] + images[n])
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use approx::assert_relative_eq;

    use super::*;
    use crate::grid::Field;
    use crate::kernel::coupled_matrix;
    use crate::material::Coating;
    use crate::math::Cholesky;

    const RIGID: f64 = f64::INFINITY;

    fn coated(base: [f64; 2], thickness: f64, layer: [f64; 2]) -> LayeredBody {
        layered(base, &[[thickness, layer[0], layer[1]]])
    }

    fn layered([young, poisson]: [f64; 2], layers: &[[f64; 3]]) -> LayeredBody {
        let layers = layers.iter().map(|[t, young, poisson]| Coating::new(*t, *young, *poisson).unwrap());
        LayeredBody::new(&Material::elastic(young, poisson).unwrap().layered(layers.collect()))
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

    /// Computes the coefficients xx, xy, yy, zx, zy and zz minus those of a half-space of the material at the surface, by a
    /// sum over all directions and wavenumbers of the remaining harmonics. It is slow, and independent of the closed
    /// forms and tables.
    fn beyond_the_layer(body: &LayeredBody, at: [f64; 2], pitch: [f64; 2]) -> [f64; 6] {
        let depth = body.depth.unwrap();
        let end = 45.0 / depth;
        let reach = (at[0] + 0.5 * pitch[0]).hypot(at[1] + 0.5 * pitch[1]);
        let sinc = |x: f64| if x == 0.0 { 1.0 } else { x.sin() / x };
        let nodes = gauss_legendre(10);
        let mut sums = [0.0; 6];
        let mut start = 1e-13 / reach.max(0.5 * depth);
        while start < end {
            let half = 0.5 * start.min(3.0 / reach).min(3.0 / depth);
            for (node, weight) in &nodes {
                let q = start + half * (1.0 + node);
                let wave = body.stack.response(q);
                let surface = body.stack.short();
                let [along, across, coupling, normal] = [
                    wave.along - surface.along / q,
                    wave.across - surface.across / q,
                    wave.coupling - surface.coupling / q,
                    wave.normal - surface.normal / q,
                ];
                let directions = 40 + (1.5 * q * reach) as usize;
                let scale = weight * half * q / directions as f64;
                for k in 0..directions {
                    let (sin, cos) = (0.5 * PI * (k as f64 + 0.5) / directions as f64).sin_cos();
                    let phase = [q * cos * at[0], q * sin * at[1]];
                    let cell = sinc(0.5 * q * cos * pitch[0]) * sinc(0.5 * q * sin * pitch[1]);
                    let even = cell * phase[0].cos() * phase[1].cos();
                    let values = [
                        (along * cos * cos + across * sin * sin) * even,
                        -(along - across) * cos * sin * cell * phase[0].sin() * phase[1].sin(),
                        (along * sin * sin + across * cos * cos) * even,
                        coupling * cos * cell * phase[0].sin() * phase[1].cos(),
                        coupling * sin * cell * phase[0].cos() * phase[1].sin(),
                        normal * even,
                    ];
                    sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += scale * value);
                }
            }
            start += 2.0 * half;
        }
        sums.map(|sum| sum * pitch[0] * pitch[1] / TAU)
    }

    #[test]
    fn its_cells_are_the_sum_of_its_harmonics_whatever_the_thickness() {
        let stacks: [([f64; 2], &[[f64; 3]]); 3] = [
            ([1.0, 0.3], &[[0.3, 5.0, 0.2], [0.05, 0.4, 0.45], [2.0, 2.0, 0.5]]),
            ([RIGID, 0.0], &[[1.0, 2.0, 0.3], [1.5, 0.5, 0.5]]),
            ([4.0, 0.1], &[[0.2, 1.0, 0.3], [0.2, 2.0, 0.3], [0.2, 3.0, 0.2], [9.0, 0.7, 0.4]]),
        ];
        let bodies = BODIES.map(|(base, thickness, layer)| coated(base, thickness, layer));
        let bodies = bodies.into_iter().chain(stacks.map(|(base, layers)| layered(base, layers)));
        for body in bodies {
            let thickness = 0.5 * body.depth.unwrap();
            for pitch in [[1.0, 1.0], [0.05, 0.03], [12.0, 5.0], [0.3, 4.0]].map(|p| p.map(|p| p * thickness))
            {
                let (influence, normal) = (body.coupled_influence(pitch), body.influence(pitch));
                let half_space = |x, y| coupled_displacement(x, y, pitch, &body.surface);
                let own = normal.displacement(0.0, 0.0);
                assert!(own > 0.0, "{body:?}, {pitch:?}");
                // The slow sum takes the longer, the larger the cells.
                let all = [[0.0, 0.0], [1.0, 0.0], [2.0, 3.0], [9.0, 5.0]];
                for cells in &all[..if pitch[0] > 2.0 * thickness { 2 } else { 4 }] {
                    let [x, y] = [0, 1].map(|axis| cells[axis] * pitch[axis]);
                    let slow = beyond_the_layer(&body, [x, y], pitch);
                    let (at, surface) = (influence(x, y), half_space(x, y));
                    let fast = [
                        at.xx - surface.xx,
                        at.xy - surface.xy,
                        at.yy - surface.yy,
                        at.zx - surface.zx,
                        at.zy - surface.zy,
                        normal.displacement(x, y) - surface.zz,
                    ];
                    assert_eq!(at.zz, normal.displacement(x, y));
                    let scale = own.max(half_space(0.0, 0.0).xx);
                    for (n, (slow, fast)) in slow.into_iter().zip(fast).enumerate() {
                        assert!(
                            (slow - fast).abs() < 1e-10 * scale,
                            "{body:?}, {pitch:?}, {cells:?}, {n}: {fast:e}, {slow:e}, {:e} of {scale:e}",
                            slow - fast
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn layers_alike_are_the_half_space_in_every_coefficient() {
        let base = Material::elastic(2.0, 0.3).unwrap();
        let compliances = Compliances::new(&base, &Material::elastic(RIGID, 0.3).unwrap()).unwrap();
        let body = layered([2.0, 0.3], &[[0.1, 2.0, 0.3]; 20]);
        let pitch = [0.3, 0.5];
        let influence = body.coupled_influence(pitch);
        let own = coupled_displacement(0.0, 0.0, pitch, &compliances).xx;
        for [x, y] in [[0.0, 0.0], [0.3, -0.5], [-6.0, 0.5], [40.0, 90.0]] {
            let (found, expected) = (influence(x, y), coupled_displacement(x, y, pitch, &compliances));
            for (found, expected) in found.matrix().iter().flatten().zip(expected.matrix().iter().flatten()) {
                assert!((found - expected).abs() < 1e-12 * own, "{x}, {y}: {found:e} and {expected:e}");
            }
        }
    }

    #[test]
    fn the_matrix_of_all_cells_of_layers_is_positive_definite() {
        let soft = Material::elastic(1.0, 0.3).unwrap().coated(Coating::new(0.5, 20.0, 0.2).unwrap());
        let rubber = Material::elastic(RIGID, 0.0).unwrap().coated(Coating::new(1.5, 1.0, 0.5).unwrap());
        let rigid = Material::elastic(RIGID, 0.0).unwrap();
        for (lower, upper) in [(&soft, &rigid), (&rubber, &rigid), (&soft, &rubber), (&soft, &soft)] {
            let pair = response(lower, upper).unwrap();
            let coupled = pair.coupled().unwrap();
            assert_eq!(coupled.couples(), lower != upper);
            let dense = coupled_matrix([6, 5], [1.0, 0.7], coupled);
            assert_eq!(dense, dense.t());
            let least = 1e-3 * dense[[0, 0]];
            let shifted = &dense - &(Field::eye(dense.nrows()) * least);
            assert!(Cholesky::new(shifted).is_some(), "an eigenvalue is not above {least:e}");
        }
    }
}
