//! Bodies with bonded elastic layers.

use std::f64::consts::PI;

use crate::error::Result;
use crate::grid::Field;
use crate::kernel::cell::integrals_below;
use crate::kernel::remainder::{Remainder, Transform, along_side};
use crate::kernel::smooth_line::{SmoothLine, Strips};
use crate::kernel::{
    Coefficients, CoupledInfluence, CoupledResponse, HalfSpaces, Influence, Layering, Line, Response,
    SharedResponse, Stack, Wave, coupled_displacement,
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
        Box::new(Both(self.each_ref().map(|body| body.influence(pitch))))
    }

    fn line_influence(&self, line: &Line, pitch: [Metre; 2]) -> Option<Box<dyn Influence>> {
        let [lower, upper] = self.each_ref().map(|body| body.line_influence(line, pitch));
        Some(Box::new(Both([lower?, upper?])))
    }
}

/// Sum of the displacements of two bodies.
struct Both([Box<dyn Influence>; 2]);

impl Influence for Both {
    fn displacement(&self, x: Metre, y: Metre) -> f64 {
        self.0.iter().map(|body| body.displacement(x, y)).sum()
    }

    fn table(&self, shape: [usize; 2], pitch: [Metre; 2]) -> Field {
        let Self([lower, upper]) = self;
        lower.table(shape, pitch) + upper.table(shape, pitch)
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

    fn line_influence(&self, line: &Line, pitch: [Metre; 2]) -> Option<Box<dyn Influence>> {
        self.bodies.line_influence(line, pitch)
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

    fn coupled_line_influence(&self, line: &Line, pitch: [Metre; 2]) -> Option<Box<CoupledInfluence>> {
        let [lower, upper] = self.each().map(|body| body.coupled_line_influence(line, pitch));
        let (lower, upper) = (lower?, upper?);
        Some(Box::new(move |x, y| lower(x, y).against(upper(x, y))))
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

    fn layering(&self) -> Option<Layering> {
        let [short, long] = [self.surface.normal, 0.5 * self.stack.long().normal];
        self.depth.map(|depth| Layering { short, long, depth })
    }
}

impl Response for LayeredBody {
    fn harmonic_displacement(&self, qx: f64, qy: f64) -> f64 {
        let q = qx.hypot(qy);
        if q == 0.0 { 0.0 } else { self.stack.normal(q) }
    }

    fn influence(&self, pitch: [Metre; 2]) -> Box<dyn Influence> {
        match self.layering() {
            None => HalfSpaces::from(self.surface).influence(pitch),
            Some(layering) => layering.influence(|q| self.stack.normal(q), pitch),
        }
    }

    fn line_influence(&self, line: &Line, pitch: [Metre; 2]) -> Option<Box<dyn Influence>> {
        match self.layering() {
            None => HalfSpaces::from(self.surface).line_influence(line, pitch),
            Some(layering) => Some(layering.line_influence(|q| self.stack.normal(q), line, pitch)),
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
        let (below, half) = (BelowSurface::new(&self.stack, depth), pitch.map(|p| 0.5 * p));
        Box::new(move |x, y| {
            let half_space = coupled_displacement(x, y, pitch, &surface);
            let [xx, xy, yy, zx, zy] = below.coefficients([x, y], half);
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

    fn coupled_line_influence(&self, line: &Line, pitch: [Metre; 2]) -> Option<Box<CoupledInfluence>> {
        let Some(layering) = self.layering() else {
            return self.surface.coupled_line_influence(line, pitch);
        };
        let (surface, line) = (self.surface, *line);
        let normal = layering.below_line(|q| self.stack.normal(q), &line, pitch);
        let below = BelowSurface::new(&self.stack, layering.depth).on_line(&self.stack, &line, pitch);
        Some(Box::new(move |x, y| {
            let half_space = line.coupled_displacement(x, y, pitch, &surface);
            let at = line.turned([x, y]);
            let [across, xy, along, z_across, z_along] = below.displacement(at);
            let ([xx, yy], [zx, zy]) = (line.turned([across, along]), line.turned([z_across, z_along]));
            let [zz] = normal.displacement(at);
            Coefficients {
                xx: half_space.xx + xx,
                xy: half_space.xy + xy,
                yy: half_space.yy + yy,
                zx: half_space.zx + zx,
                zy: half_space.zy + zy,
                zz: half_space.zz + zz,
            }
        }))
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
    /// ρ and w of along, those of across, φ and γ.
    table: Remainder<6>,
    /// Amplitudes of the potentials at the depth d: along, across and coupling.
    images: [f64; 3],
    nodes: Vec<(f64, f64)>,
}

impl BelowSurface {
    fn new(stack: &Stack, depth: Metre) -> Self {
        use Transform::{Hankel, Mean, Order, Potential};
        let rest = |q: f64| {
            let [along, across, coupling] = Self::rest(stack, depth, q);
            [along, along, across, across, coupling, coupling]
        };
        let transforms = [Hankel, Mean, Hankel, Mean, Potential, Order(1)];
        let [short, long] = [stack.short(), stack.long()].map(in_plane);
        Self {
            depth,
            table: Remainder::new(rest, transforms, depth, Metre::INFINITY),
            images: [0, 1, 2].map(|n| (long[n] - short[n]) / (2.0 * PI)),
            nodes: gauss_legendre(16),
        }
    }

    /// Returns the remainders of along, across and coupling.
    fn rest(stack: &Stack, depth: Metre, q: f64) -> [f64; 3] {
        let [waves, short, long] = [stack.response(q), stack.short(), stack.long()].map(in_plane);
        let image = (-q * depth).exp();
        [0, 1, 2].map(|n| waves[n] - (short[n] + (long[n] - short[n]) * image) / q)
    }

    /// Returns the sum over the cells of a `line`, whose x is across the line.
    fn on_line(self, stack: &Stack, line: &Line, pitch: [Metre; 2]) -> SmoothLine<5> {
        use Transform::{Cosine, Sine};
        let depth = self.depth;
        let rest = |q: f64| Self::rest(stack, depth, q);
        let transforms = [Cosine, Cosine, Sine];
        let strips = Strips::new(rest, transforms, self.images, [depth, line.datum], Metre::INFINITY);
        let strips = if stack.long().normal > 0.0 { strips.relative_to_datum() } else { strips };
        let odd = [[false; 2], [true; 2], [false; 2], [true, false], [false, true]];
        SmoothLine::new(
            line,
            pitch,
            odd,
            move |at, half| self.coefficients(at, half),
            move |x, half| {
                let [along, across, coupling] = strips.under_strip(x, half);
                [along, 0.0, across, coupling, 0.0]
            },
        )
    }

    /// Returns xx, xy, yy, zx and zy under a cell with these half-sides.
    fn coefficients(&self, at: [Metre; 2], half: [Metre; 2]) -> [f64; 5] {
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
        integrals_below(at, self.depth, half, closed, |x, y| self.point([x, y]))
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

/// Responses along, across and coupling.
fn in_plane(wave: Wave) -> [f64; 3] {
    [wave.along, wave.across, wave.coupling]
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use approx::assert_relative_eq;

    use super::*;
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

    /// Computes the coefficients xx, xy, yy, zx, zy and zz under a line along y of cells minus those of a half-space of the
    /// material at the surface, by a sum over all waves along the line and all wavenumbers across it.
    fn beyond_the_layer_on_line(body: &LayeredBody, at: [f64; 2], pitch: [f64; 2], line: &Line) -> [f64; 6] {
        let depth = body.depth.unwrap();
        let sinc = |x: f64| if x == 0.0 { 1.0 } else { x.sin() / x };
        let [short, long] = [body.stack.short(), body.stack.long()];
        let reach = at[0].abs() + 0.5 * pitch[0];
        let nodes = gauss_legendre(10);
        let mut sums = [0.0; 6];
        let waves = (45.0 / depth * line.period / TAU) as usize;
        for m in 0..=waves {
            let k = TAU * m as f64 / line.period;
            let cell = sinc(0.5 * k * pitch[1]) * if m == 0 { 1.0 } else { 2.0 };
            let [even, odd] = [cell * (k * at[1]).cos(), cell * (k * at[1]).sin()];
            let mut start = 1e-13 / reach.max(0.5 * depth).max(line.datum);
            while start < 45.0 / depth {
                let half = 0.5 * start.max(0.05 * k).min(3.0 / reach).min(3.0 / depth);
                for (node, weight) in &nodes {
                    let across = start + half * (1.0 + node);
                    let q = across.hypot(k);
                    let [cos, sin] = [across / q, k / q];
                    let wave = body.stack.response(q);
                    let [along, crests, coupling, normal] = [
                        wave.along - short.along / q,
                        wave.across - short.across / q,
                        wave.coupling - short.coupling / q,
                        wave.normal - short.normal / q,
                    ];
                    let share = weight * half * sinc(0.5 * across * pitch[0]);
                    let (s, c) = (across * at[0]).sin_cos();
                    // The potential of a base at the datum.
                    let datum = if m == 0 { weight * half * (-q * line.datum).exp() / q } else { 0.0 };
                    let values = [
                        (along * cos * cos + crests * sin * sin) * even * share * c
                            - (long.along - short.along) * datum,
                        -(along - crests) * cos * sin * odd * share * s,
                        (along * sin * sin + crests * cos * cos) * even * share * c
                            - (long.across - short.across) * datum,
                        coupling * cos * even * share * s,
                        coupling * sin * odd * share * c,
                        normal * even * share * c - (long.normal - short.normal) * datum,
                    ];
                    sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
                }
                start += 2.0 * half;
            }
        }
        sums.map(|sum| sum * pitch[0] * pitch[1] / (PI * line.period))
    }

    /// Returns the uniform part of [`beyond_the_layer_on_line`] at the datum, if the base is elastic.
    fn at_the_datum(body: &LayeredBody, pitch: [f64; 2], line: &Line) -> [f64; 6] {
        if body.stack.long().normal == 0.0 {
            return [0.0; 6];
        }
        // A strip as narrow as a line.
        let narrow = [1e-5 * line.datum, 1e-3 * body.depth.unwrap()];
        let strip = Line { period: narrow[1], ..*line };
        let [xx, _, yy, .., zz] = beyond_the_layer_on_line(body, [line.datum, 0.0], narrow, &strip);
        [xx, 0.0, yy, 0.0, 0.0, zz].map(|value| value / narrow[0] * pitch[0] * pitch[1] / line.period)
    }

    /// Returns the coefficients in the order xx, xy, yy, zx, zy and zz.
    fn six(Coefficients { xx, xy, yy, zx, zy, zz }: Coefficients) -> [f64; 6] {
        [xx, xy, yy, zx, zy, zz]
    }

    /// Returns the largest displacement of a cell in a line, with or without the body below the layer.
    fn own_on_line(influence: &CoupledInfluence, half_space: Coefficients) -> f64 {
        let own = six(influence(0.0, 0.0)).into_iter().chain(six(half_space));
        own.fold(0.0, |most, value| most.max(value.abs()))
    }

    #[test]
    fn a_line_of_its_cells_is_the_sum_of_its_waves_whatever_the_thickness() {
        let bodies = [
            coated([1.0, 0.2], 2.0, [3.0, 0.3]),
            coated([1.0, 0.5], 0.7, [1e3, 0.2]),
            layered([1.0, 0.3], &[[0.3, 5.0, 0.2], [0.05, 0.4, 0.45], [2.0, 2.0, 0.5]]),
            layered([RIGID, 0.0], &[[1.0, 2.0, 0.3], [10.0, 0.5, 0.5]]),
        ];
        for body in bodies {
            let thickness = 0.5 * body.depth.unwrap();
            // Period and pitch in thicknesses: thin and thick, one cell per period and many, wide cells.
            for (period, pitch) in
                [(8.0, [1.0, 1.0]), (0.01, [0.002, 0.001]), (1.0, [9.0, 1.0]), (20.0, [0.5, 0.1])]
            {
                let line = Line { axis: 1, period: period * thickness, datum: 37.0 * thickness };
                let pitch = pitch.map(|p| p * thickness);
                let influence = body.coupled_line_influence(&line, pitch).unwrap();
                let normal = body.line_influence(&line, pitch).unwrap();
                let half_space = |x, y| line.coupled_displacement(x, y, pitch, &body.surface);
                let scale = own_on_line(&influence, half_space(0.0, 0.0));
                let datum = at_the_datum(&body, pitch, &line);
                // The slow sum takes the longer, the larger the distance over the thickness.
                let places = [[0.0, 0.0], [0.3, 0.4], [1.0, -0.2], [5.0, 0.5], [-10.6, 0.1]];
                for [x, y] in &places[..if period > 1.0 { 3 } else { 5 }] {
                    let at = [x * line.period, y * line.period];
                    let (found, surface) = (six(influence(at[0], at[1])), six(half_space(at[0], at[1])));
                    assert!((found[5] - normal.displacement(at[0], at[1])).abs() < 1e-14 * scale);
                    let slow = beyond_the_layer_on_line(&body, at, pitch, &line);
                    for n in 0..6 {
                        let error = (found[n] - surface[n] - slow[n] + datum[n]) / scale;
                        assert!(
                            error.abs() < 1e-10,
                            "{body:?}, {period}, {pitch:?}, {at:?}, {n}: {:e} for {:e}, {error:e} of {scale:e}",
                            found[n] - surface[n],
                            slow[n]
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
        let line = Line { axis: 0, period: 0.9, datum: 7.0 };
        let of = |bodies: &dyn CoupledResponse| {
            [bodies.coupled_influence(pitch), bodies.coupled_line_influence(&line, pitch).unwrap()]
        };
        let own = coupled_displacement(0.0, 0.0, pitch, &compliances).xx;
        for (influence, half_space) in of(&body).iter().zip(of(&compliances)) {
            for [x, y] in [[0.0, 0.0], [0.3, -0.5], [-6.0, 0.5], [40.0, 90.0]] {
                for (found, expected) in six(influence(x, y)).into_iter().zip(six(half_space(x, y))) {
                    assert!((found - expected).abs() < 1e-12 * own, "{x}, {y}: {found:e} and {expected:e}");
                }
            }
        }
    }

    /// Long lines, of which the layers are thin compared with the cells, with the period, or with neither.
    #[test]
    fn a_line_of_its_cells_is_the_sum_over_them() {
        let pitch = [1.0, 0.7];
        for (body, period) in [
            (coated([1.0, 0.5], 1e-3, [1e3, 0.2]), 70.0),
            (coated([RIGID, 0.0], 1e-3, [1.0, 0.4]), 0.7),
            (layered([1.0, 0.3], &[[0.02, 5.0, 0.2], [0.3, 0.1, 0.45]]), 2.8),
            (coated([5.0, 0.3], 4.0, [1.0, 0.1]), 300.0),
        ] {
            let line = Line { axis: 1, period, datum: 50.0 };
            let (cell, influence) =
                (body.coupled_influence(pitch), body.coupled_line_influence(&line, pitch).unwrap());
            let half_space = line.coupled_displacement(0.0, 0.0, pitch, &body.surface);
            let scale = own_on_line(&influence, half_space);
            let datum = at_the_datum(&body, pitch, &line);
            let long = in_plane(body.stack.long()).map(|c| 0.5 * c * pitch[0] * pitch[1] / PI);
            for at in [[0.0, 0.0], [1.0, 0.35], [1.2, -0.3 * period]] {
                let mut sum = [0.0; 6];
                let mut done = 0;
                let sums = [100, 301, 904, 2713].map(|reach: i64| {
                    for n in (done + i64::from(done > 0)..=reach).flat_map(|n| [n, -n]) {
                        let share = if n == 0 { 0.5 } else { 1.0 };
                        let at = six(cell(at[0], at[1] + n as f64 * period));
                        sum.iter_mut().zip(at).for_each(|(sum, value)| *sum += share * value);
                    }
                    done = reach;
                    // The part of the base beyond, and the uniform part in the plane.
                    let rest = -2.0 / period * ((2 * reach + 1) as f64 * period / line.datum).ln();
                    let uniform = 2.0 / period * (long[1] - long[0]);
                    let normal = body.stack.long().normal * 0.5 * pitch[0] * pitch[1] / PI;
                    let rests =
                        [long[0] * rest - uniform, 0.0, long[1] * rest + uniform, 0.0, 0.0, normal * rest];
                    std::array::from_fn::<f64, 6, _>(|n| sum[n] + rests[n])
                });
                for (n, found) in six(influence(at[0], at[1])).into_iter().enumerate() {
                    // The remainders decay as h⁻¹, h⁻², h⁻³.
                    let better =
                        |power: i32, [near, far]: [f64; 2]| far + (far - near) / (3f64.powi(power) - 1.0);
                    let [a, b, c, d] = sums.map(|sum| sum[n]);
                    let [a, b, c] = [[a, b], [b, c], [c, d]].map(|pair| better(1, pair));
                    let [a, b] = [[a, b], [b, c]].map(|pair| better(2, pair));
                    let slow = better(3, [a, b]) - datum[n];
                    assert!(
                        (found - slow).abs() < 1e-10 * scale,
                        "{body:?}, {at:?}, {n}: {found:e} and {slow:e}, {:e} of {scale:e}",
                        found - slow
                    );
                }
            }
        }
    }

    #[test]
    fn in_plane_strain_layers_on_a_rigid_body_are_springs_and_do_not_displace_afar() {
        let layers = [[0.3, 2.0, 0.3], [0.7, 5.0, 0.1]];
        let body = layered([RIGID, 0.0], &layers);
        // One wide cell per period.
        let pitch = [50.0, 0.4];
        let line = Line { axis: 1, period: pitch[1], datum: 12.0 };
        let influence = body.coupled_line_influence(&line, pitch).unwrap();
        let in_series = |modulus: fn(f64, f64) -> f64| {
            layers
                .iter()
                .map(|[thickness, young, poisson]| thickness / modulus(*young, *poisson))
                .sum::<f64>()
        };
        let foundation = in_series(|young, nu| young * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)));
        let shear = in_series(|young, nu| 0.5 * young / (1.0 + nu));
        let [near, far] = [0.0, 60.0].map(|x| influence(x, 0.1));
        for (value, exact) in [(near.zz, foundation), (near.xx, shear), (near.yy, shear)] {
            assert_relative_eq!(value, exact, max_relative = 1e-11);
        }
        for value in six(far).into_iter().chain([near.xy, near.zx, near.zy]) {
            assert!(value.abs() < 1e-11 * foundation, "{value:e} of {foundation:e}");
        }
    }

    #[test]
    fn the_matrix_of_all_cells_of_layers_is_positive_definite() {
        let soft = Material::elastic(1.0, 0.3).unwrap().coated(Coating::new(0.5, 20.0, 0.2).unwrap());
        let rubber = Material::elastic(RIGID, 0.0).unwrap().coated(Coating::new(1.5, 1.0, 0.5).unwrap());
        let rigid = Material::elastic(RIGID, 0.0).unwrap();
        // Waves as long as the grid do not feel the base, which gives way more than the layer.
        let thick = Material::elastic(1.0, 0.3).unwrap().coated(Coating::new(50.0, 1e3, 0.2).unwrap());
        let pitch = [1.0, 0.7];
        let shape @ [rows, columns] = [6, 5];
        for (lower, upper) in
            [(&soft, &rigid), (&rubber, &rigid), (&soft, &rubber), (&soft, &soft), (&thick, &rigid)]
        {
            let pair = response(lower, upper).unwrap();
            let coupled = pair.coupled().unwrap();
            assert_eq!(coupled.couples(), lower != upper);
            let dense = coupled_matrix(shape, pitch, coupled);
            assert_eq!(dense, dense.t());
            let line = Line { axis: 1, period: columns as f64 * pitch[1], datum: rows as f64 * pitch[0] };
            let influence = coupled.coupled_line_influence(&line, pitch).unwrap();
            let cells = rows * columns;
            let on_line = Field::from_shape_fn([3 * cells, 3 * cells], |(m, n)| {
                let place = |k: usize| [(k % cells / columns) as f64, (k % columns) as f64];
                let [x, y] = [0, 1].map(|axis| (place(m)[axis] - place(n)[axis]) * pitch[axis]);
                influence(x, y).matrix()[m / cells][n / cells]
            });
            for dense in [dense, on_line] {
                let most = (&dense - &dense.t()).fold(0.0f64, |most, error| most.max(error.abs()));
                assert!(most < 1e-11 * dense[[0, 0]], "{most:e} of {:e}", dense[[0, 0]]);
                let least = 1e-3 * dense[[0, 0]];
                let shifted = &dense - &(Field::eye(dense.nrows()) * least);
                assert!(Cholesky::new(shifted).is_some(), "an eigenvalue is not above {least:e}");
            }
        }
    }
}
