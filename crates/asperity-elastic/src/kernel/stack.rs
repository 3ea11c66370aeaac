//! Response of bonded layers to one wave.

use std::ops::{Add, Div, Mul, Neg, Sub};

use asperity_transforms::num_complex::Complex64;

use crate::kernel::Traction;
use crate::material::Material;
use crate::stress::Component;
use crate::units::{Metre, Pascal};

/// Bonded isotropic layers on a half-space or on a rigid base, under the traction of one wave on their surface.
///
/// z points into the body. The in-plane state of a wave e^(iqx) is y = (i u_x, u_z, i σ_xz/Gq, σ_zz/Gq), which is real.
/// With x = qz it follows y' = A y, and (A² − 1)² = 0 makes its solution a closed form:
///
/// ```text
///       ⎡  0   1  1  0 ⎤
/// A  =  ⎢ −f   0  0  g ⎥      e^(Ax) = cosh x + A sinh x + ½(A² − 1) x sinh x + ½(A³ − A)(x cosh x − sinh x)
///       ⎢  h   0  0  f ⎥
///       ⎣  0   0 −1  0 ⎦      f = ν/(1 − ν),  g = (1 − 2ν)/2(1 − ν),  h = 2/(1 − ν)
/// ```
///
/// The compliance of the body under an interface gives that under the next one above: from the solution itself in a thin layer,
/// and in a thick one from its stiffness, whose terms decay as e^(−x). So nothing grows, and nothing cancels at
/// any thickness. Out of the plane the state (u_y, σ_yz) follows from [`potential_compliance`].
///
/// All of it holds for complex moduli M as well: those of layers that relax, under a pressure that oscillates.
///
/// Rokhlin and Wang, J. Acoust. Soc. Am. 112, 822 (2002); Chen, Int. J. Solids Struct. 7, 357 (1971).
#[derive(Debug, Clone, PartialEq)]
pub struct Stack<M = Pascal> {
    /// From the surface down.
    layers: Vec<Layer<M>>,
    base: Elastic<M>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Layer<M = Pascal> {
    thickness: Metre,
    elastic: Elastic<M>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Elastic<M = Pascal> {
    /// Shear modulus; infinite for a rigid body.
    shear: M,
    poisson: f64,
}

/// A modulus: a real number of an elastic material, a complex one of a material that relaxes, at a frequency.
pub trait Modulus:
    Copy
    + From<f64>
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
{
    /// Returns a `number` over this one, 0 over the infinite modulus of a rigid body.
    fn divide(self, number: f64) -> Self;
}

impl Modulus for f64 {
    fn divide(self, number: f64) -> Self {
        number / self
    }
}

impl Modulus for Complex64 {
    fn divide(self, number: f64) -> Self {
        if self.re.is_infinite() { 0.0.into() } else { number / self }
    }
}

/// Displacements of the surface of one body per unit traction of a wave, m/Pa. In the plane of the wave, the shear q_∥
/// along it and the pressure p displace by
///
/// ```text
/// u_∥ = along q_∥ + i coupling p        u_z = −i coupling q_∥ + normal p
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wave {
    /// Along the wave, under a shear along the wave.
    pub along: f64,
    /// Along the crests, under a shear along the crests.
    pub across: f64,
    /// Normal, under a pressure.
    pub normal: f64,
    /// Normal, under a shear along the wave.
    pub coupling: f64,
}

impl<M: Modulus> Stack<M> {
    /// Creates the layers of a material on its body with other Young's moduli: those of the layers from the surface down,
    /// then that of the body below them.
    ///
    /// # Panics
    /// If the number of moduli differs from that of the layers and the body.
    pub fn with_moduli(material: &Material, young: &[M]) -> Self {
        let (base, young) = young.split_last().expect("the modulus of the body");
        assert_eq!(young.len(), material.layers.len(), "moduli of the layers");
        let elastic = |young: M, poisson: f64| Elastic { shear: young * 0.5 / (1.0 + poisson), poisson };
        let layers = material.layers.iter().zip(young).map(|(layer, young)| Layer {
            thickness: layer.thickness,
            elastic: elastic(*young, layer.poisson),
        });
        Self { layers: layers.collect(), base: elastic(*base, material.poisson) }
    }

    /// Computes the normal displacement under the pressure of a wave of wavenumber q > 0, m/Pa.
    pub fn normal(&self, q: f64) -> M {
        self.plane(q)[1][1] / q
    }

    fn plane(&self, q: f64) -> Plane<M> {
        let below = self.base.half_space();
        self.layers.iter().rev().fold(below, |below, layer| layer.under(q, below))
    }
}

impl Stack {
    /// Creates the layers of a material on its body.
    pub fn new(material: &Material) -> Self {
        let layers = material.layers.iter().map(|layer| layer.young);
        Self::with_moduli(material, &layers.chain([material.young]).collect::<Vec<_>>())
    }

    /// Creates the layers of a material on its body, if it has layers.
    pub fn of(material: &Material) -> Option<Self> {
        material.is_layered().then(|| Self::new(material))
    }

    /// Computes the response to a wave of wavenumber q > 0.
    pub fn response(&self, q: f64) -> Wave {
        let plane = self.plane(q);
        let layers = self.layers.iter().rev().map(|layer| (layer.thickness, layer.elastic.shear));
        Wave {
            along: plane[0][0] / q,
            across: potential_compliance(layers, self.base.shear, q),
            normal: plane[1][1] / q,
            coupling: -0.5 * (plane[0][1] + plane[1][0]) / q,
        }
    }

    /// Returns the response to waves that are short compared with the layer at the surface, times q, 1/Pa.
    pub fn short(&self) -> Wave {
        self.layers.first().map_or(self.base, |layer| layer.elastic).half_space_wave()
    }

    /// Returns the response to waves that are long compared with all layers, times q, 1/Pa; zeros for a rigid base.
    pub fn long(&self) -> Wave {
        self.base.half_space_wave()
    }
}

/// Stresses of a wave at a depth per unit traction on the surface, dimensionless, along the wave ∥, along its crests ⊥ and
/// along z. With a factor i are σ_∥z of the pressure, all but σ_∥z of the shear along the wave, and σ_∥⊥.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WaveStress {
    /// ∥∥, ⊥⊥, zz and ∥z under a pressure.
    pressure: [f64; 4],
    /// The same under a shear along the wave.
    along: [f64; 4],
    /// ⊥z and ∥⊥ under a shear along the crests.
    across: [f64; 2],
}

impl WaveStress {
    /// Returns a component per unit traction of a wave in the direction `[cos, sin]`. It has a factor i if
    /// [`Traction::odd`] is true for exactly one of x and y.
    pub fn component(&self, [cos, sin]: [f64; 2], component: Component, traction: Traction) -> f64 {
        let ([along, across], [own, crests, zz, own_z]) = match traction {
            Traction::X => ([cos, -sin], self.along),
            Traction::Y => ([sin, cos], self.along),
            Traction::Pressure => ([1.0, 0.0], self.pressure),
        };
        let [own, crests, zz, own_z] = [own, crests, zz, own_z].map(|stress| along * stress);
        let [crests_z, mixed] = self.across.map(|stress| across * stress);
        match component {
            Component::Xx => cos * cos * own + sin * sin * crests - 2.0 * cos * sin * mixed,
            Component::Yy => sin * sin * own + cos * cos * crests + 2.0 * cos * sin * mixed,
            Component::Zz => zz,
            Component::Yz => sin * own_z + cos * crests_z,
            Component::Xz => cos * own_z - sin * crests_z,
            Component::Xy => cos * sin * (own - crests) + (cos * cos - sin * sin) * mixed,
        }
    }
}

impl Stack {
    /// Returns a half-space of the material at the surface.
    pub fn surface(&self) -> Self {
        Self { layers: Vec::new(), base: self.layers.first().map_or(self.base, |layer| layer.elastic) }
    }

    /// Poisson's ratio of the body below the layers.
    pub fn poisson(&self) -> f64 {
        self.base.poisson
    }

    /// Returns the depth of the interface above each layer, and above the body below them, from the surface down.
    pub fn interfaces(&self) -> Vec<Metre> {
        let mut depth = 0.0;
        let mut tops = vec![0.0];
        tops.extend(self.layers.iter().map(|layer| {
            depth += layer.thickness;
            depth
        }));
        tops
    }

    /// Whether the body below the layers is rigid.
    pub fn has_rigid_base(&self) -> bool {
        self.base.shear.is_infinite()
    }

    /// Computes the stress of waves of wavenumber q ≥ 0 at a `depth` in a layer; the body below all layers is the last one. At
    /// q = 0 the traction is uniform, and the body cannot widen. A rigid body has no stress.
    ///
    /// From the surface down the displacements at each interface follow from those above it. The tractions are taken from
    /// the compliance of the body below, so that no solution that grows with depth comes in.
    pub fn stress(&self, q: f64, layer: usize, depth: Metre) -> WaveStress {
        let elastic = |n: usize| self.layers.get(n).map_or(self.base, |layer| layer.elastic);
        let own = elastic(layer);
        if own.shear.is_infinite() {
            return WaveStress { pressure: [0.0; 4], along: [0.0; 4], across: [0.0; 2] };
        }
        if q == 0.0 {
            let side = -own.poisson / (1.0 - own.poisson);
            return WaveStress {
                pressure: [side, side, -1.0, 0.0],
                along: [0.0, 0.0, 0.0, -1.0],
                across: [-1.0, 0.0],
            };
        }
        // Compliances under each interface, in the plane and out of it.
        let mut below = vec![(self.base.half_space(), self.base.shear.recip())];
        for layer in self.layers.iter().rev() {
            let (plane, across) = below[below.len() - 1];
            let next = (
                layer.under(q, plane),
                potential_compliance([(layer.thickness, layer.elastic.shear)], across.recip(), q) * q,
            );
            below.push(next);
        }
        below.reverse();
        let mut top = 0.0;
        let mut tractions = IDENTITY;
        let mut displacements = below[0].0.map(|row| row.map(|value| -value));
        let (mut sheared, mut sliding) = (1.0, below[0].1);
        for n in 0..=layer {
            let is_here = n == layer;
            let Elastic { shear, poisson } = elastic(n);
            let thickness = self.layers.get(n).map(|layer| layer.thickness);
            let to = if is_here {
                (depth - top).clamp(0.0, thickness.unwrap_or(Metre::INFINITY))
            } else {
                thickness.expect("a layer")
            };
            let x = q * to;
            let scaled = displacements.map(|row| row.map(|value| shear * value));
            let (moved, loaded) = match thickness {
                None => self::below(x, poisson, scaled, tractions),
                Some(thickness) => {
                    let rest = Layer { thickness: thickness - to, elastic: elastic(n) };
                    let under = rest.under(q, below[n + 1].0).map(|row| row.map(|value| -shear * value));
                    down(x, poisson, scaled, tractions, under)
                }
            };
            displacements = moved.map(|row| row.map(|value| value / shear));
            // u = F cosh w + sinh w and σ = cosh w + F sinh w over their values at the top, with w from the bottom up.
            let relative = thickness.map_or(1.0, |_| shear * below[n + 1].1);
            let whole = q * thickness.unwrap_or(to);
            let [near, far] = [(-x).exp(), (x - 2.0 * whole).exp()];
            let all = (-2.0 * whole).exp();
            let fade = |sign: f64| (relative + 1.0) * near + sign * (relative - 1.0) * far;
            let full = |sign: f64| (relative + 1.0) + sign * (relative - 1.0) * all;
            if thickness.is_some() {
                sliding *= fade(1.0) / full(1.0);
                sheared *= fade(-1.0) / full(-1.0);
            } else {
                sliding *= near;
                sheared *= near;
            }
            if is_here {
                return self.stresses(own, moved, loaded, [sheared, sliding * shear]);
            }
            top += to;
            tractions = product(inverse(below[n + 1].0), displacements).map(|row| row.map(|value| -value));
        }
        unreachable!("a layer of the stack")
    }

    /// Returns the stresses from G q times the displacements and the tractions under unit i σ_xz and σ_zz, and those under a
    /// unit shear along the crests.
    fn stresses(&self, own: Elastic, u: Plane, t: Plane, [sheared, sliding]: [f64; 2]) -> WaveStress {
        let nu = own.poisson;
        let of = |load: usize| {
            let along = nu / (1.0 - nu) * t[1][load] + 2.0 / (1.0 - nu) * u[0][load];
            [along, nu * (along + t[1][load]), t[1][load], t[0][load]].map(|stress| -stress)
        };
        let [mut pressure, along] = [of(1), of(0)];
        pressure[3] = -pressure[3];
        WaveStress { pressure, along, across: [-sheared, sliding] }
    }
}

/// Returns displacements and tractions at the depth x in a layer of G = 1 from those at its surface, and from the compliances
/// `under` that depth.
fn down(x: f64, poisson: f64, u: Plane, t: Plane, under: Plane) -> (Plane, Plane) {
    if x < THICK {
        let [[uu, ut], [tu, tt]] = solution(x, poisson);
        return (plus(product(uu, u), product(ut, t)), plus(product(tu, u), product(tt, t)));
    }
    let [_, across, bottom] = stiffness(x, poisson);
    let forced = product([[-across[0][0], -across[1][0]], [-across[0][1], -across[1][1]]], u);
    let moved = product(inverse(minus(IDENTITY, product(under, bottom))), product(under, forced));
    (moved, plus(forced, product(bottom, moved)))
}

/// Returns displacements and tractions at the depth x in a half-space of G = 1: e^(−x)(1 + (A + 1) x) of those at its surface.
fn below(x: f64, poisson: f64, u: Plane, t: Plane) -> (Plane, Plane) {
    let [f, g, h] = [poisson, 0.5 * (1.0 - 2.0 * poisson), 2.0].map(|value| value / (1.0 - poisson));
    let fade = (-x).exp();
    let step = |value: f64, change: f64| fade * (value + x * change);
    let columns = [0, 1].map(|k| {
        let [a, b, c, d] = [u[0][k], u[1][k], t[0][k], t[1][k]];
        [step(a, a + b + c), step(b, b - f * a + g * d), step(c, c + h * a + f * d), step(d, d - c)]
    });
    let rows = |n: usize| [columns[0][n], columns[1][n]];
    ([rows(0), rows(1)], [rows(2), rows(3)])
}

/// Potential at the surface per unit flux of a wave of wavenumber q > 0 into layers on a half-space: displacement under an
/// out-of-plane shear, temperature under a heat flux. `layers` gives thickness and conductivity from the lowest
/// layer up; `base` is the conductivity below them, which may be infinite.
///
/// ```text
/// û/q̂ = F/(κq),   κ F' = κ (F + tanh qt)/(1 + F tanh qt)        F = 1 on a half-space of conductivity κ
/// ```
pub fn potential_compliance(layers: impl IntoIterator<Item = (Metre, f64)>, base: f64, q: f64) -> f64 {
    let mut below = base.recip();
    for (thickness, conductivity) in layers {
        let (relative, tanh) = (conductivity * below, (q * thickness).tanh());
        below = (relative + tanh) / (1.0 + relative * tanh) / conductivity;
    }
    below / q
}

/// In-plane compliances of a body times q, 1/Pa: −(i u_x, u_z) q under (i σ_xz, σ_zz) on its surface.
type Plane<M = f64> = [[M; 2]; 2];

/// Above this qt a layer is taken by its stiffness.
const THICK: f64 = 1.0;

impl Elastic {
    fn half_space_wave(self) -> Wave {
        let plane = self.half_space();
        Wave { along: plane[0][0], across: self.shear.recip(), normal: plane[1][1], coupling: -plane[0][1] }
    }
}

impl<M: Modulus> Elastic<M> {
    fn half_space(self) -> Plane<M> {
        let [own, coupling] =
            [1.0 - self.poisson, -0.5 * (1.0 - 2.0 * self.poisson)].map(|c| self.shear.divide(c));
        [[own, coupling], [coupling, own]]
    }
}

impl<M: Modulus> Layer<M> {
    /// Returns the compliances of the layer on a body with the compliances `below`.
    fn under(&self, q: f64, below: Plane<M>) -> Plane<M> {
        let Elastic { shear, poisson } = self.elastic;
        let below = below.map(|row| row.map(|value| -shear * value));
        let x = q * self.thickness;
        let above = if x < THICK { under_thin(x, poisson, below) } else { under_thick(x, poisson, below) };
        above.map(|row| row.map(|value| -value / shear))
    }
}

/// Returns the compliances (i u_x, u_z) under (i σ_xz, σ_zz)/Gq of a layer of shear modulus G = 1 and qt = x on a body
/// with the compliances `below`, from the solution e^(Ax).
fn under_thin<M: Modulus>(x: f64, poisson: f64, below: Plane<M>) -> Plane<M> {
    let [[uu, ut], [tu, tt]] = solution(x, poisson);
    let [uu, ut, tu, tt]: [Plane<M>; 4] = [of_moduli(uu), of_moduli(ut), of_moduli(tu), of_moduli(tt)];
    product(inverse(minus(uu, product(below, tu))), minus(product(below, tt), ut))
}

/// Returns the blocks of e^(Ax): displacements u and tractions t at the depth x from those at the surface.
fn solution(x: f64, poisson: f64) -> [[Plane; 2]; 2] {
    let growing = x.exp();
    let (cosh, odd) = (0.5 * (growing + growing.recip()), odd_rest(x));
    let sinh = x * cosh - odd;
    let k = 0.25 / (1.0 - poisson);
    let even = k * x * sinh;
    let [shear, squeeze] = [4.0 * k * poisson * sinh + 2.0 * k * odd, sinh + 2.0 * k * odd];
    [
        [
            [[cosh + 2.0 * even, squeeze], [-shear, cosh - 2.0 * even]],
            [[sinh + k * odd, even], [-even, 2.0 * k * (1.0 - 2.0 * poisson) * sinh - k * odd]],
        ],
        [
            [[4.0 * k * (2.0 * sinh + odd), 4.0 * even], [-4.0 * even, -4.0 * k * odd]],
            [[cosh + 2.0 * even, shear], [-squeeze, cosh - 2.0 * even]],
        ],
    ]
}

/// Returns the compliances as [`under_thin`], from the stiffness K of the layer: t = K₀ u + K₁ u' at the surface
/// and t' = K₂ u + K₃ u' below, with a = 3 − 4ν and D = a² sinh² x − x²,
///
/// ```text
/// K₀ = −⎡(a + 1)(a sinh x cosh x − x)   a(a − 1) sinh² x − 2x²        ⎤/D      K₁ = −K₂ᵀ = (a + 1)⎡a sinh x − x cosh x   −x sinh x             ⎤/D
///       ⎣a(a − 1) sinh² x − 2x²         (a + 1)(a sinh x cosh x + x)  ⎦                           ⎣x sinh x              a sinh x + x cosh x   ⎦
/// ```
/// K₃ is −K₀ with the other sign off the diagonal.
fn under_thick<M: Modulus>(x: f64, poisson: f64, below: Plane<M>) -> Plane<M> {
    let [top, across, bottom] = stiffness(x, poisson);
    let [top, across, bottom]: [Plane<M>; 3] = [of_moduli(top), of_moduli(across), of_moduli(bottom)];
    let minus_transposed = [[-across[0][0], -across[1][0]], [-across[0][1], -across[1][1]]];
    let identity = of_moduli(IDENTITY);
    let along = product(inverse(minus(identity, product(below, bottom))), product(below, minus_transposed));
    inverse(plus(top, product(across, along)))
}

/// Returns K₀, K₁ and K₃, see [`under_thick`], whose numerators and D are multiplied by 4 e^(−2x).
fn stiffness(x: f64, poisson: f64) -> [Plane; 3] {
    let a = 3.0 - 4.0 * poisson;
    let root = (-x).exp();
    let theta = root * root;
    let (less, more) = (1.0 - theta, 1.0 + theta);
    let scale = (a * a * less * less - 4.0 * x * x * theta).recip();
    let off = -(a * (a - 1.0) * less * less - 8.0 * x * x * theta) * scale;
    let own = |sign: f64| -(a + 1.0) * (a * less * more + sign * 4.0 * x * theta) * scale;
    let far = 2.0 * (a + 1.0) * root * scale;
    let (turned, sheared) = (far * x * less, x * more);
    [
        [[own(-1.0), off], [off, own(1.0)]],
        [[far * (a * less - sheared), -turned], [turned, far * (a * less + sheared)]],
        [[-own(-1.0), off], [off, -own(1.0)]],
    ]
}

/// Computes x cosh x − sinh x for x up to [`THICK`], by its series Σ 2n x^(2n + 1)/(2n + 1)!.
fn odd_rest(x: f64) -> f64 {
    let square = x * x;
    // Σ over n from the last term that counts, each over the one before.
    let mut sum = 0.0;
    for n in (1..=8).rev() {
        let n = f64::from(n);
        sum = 1.0 + square / (2.0 * n * (2.0 * n + 3.0)) * sum;
    }
    x * square / 3.0 * sum
}

const IDENTITY: Plane = [[1.0, 0.0], [0.0, 1.0]];

/// Returns a plane of real numbers. Written out it costs nothing where moduli are real, which maps of arrays do.
fn of_moduli<M: Modulus>([[a, b], [c, d]]: Plane) -> Plane<M> {
    [[a.into(), b.into()], [c.into(), d.into()]]
}

fn product<M: Modulus>(a: Plane<M>, b: Plane<M>) -> Plane<M> {
    a.map(|row| [0, 1].map(|j| row[0] * b[0][j] + row[1] * b[1][j]))
}

fn plus<M: Modulus>(a: Plane<M>, b: Plane<M>) -> Plane<M> {
    [0, 1].map(|i| [0, 1].map(|j| a[i][j] + b[i][j]))
}

fn minus<M: Modulus>(a: Plane<M>, b: Plane<M>) -> Plane<M> {
    [0, 1].map(|i| [0, 1].map(|j| a[i][j] - b[i][j]))
}

fn inverse<M: Modulus>([[a, b], [c, d]]: Plane<M>) -> Plane<M> {
    let scale = (a * d - b * c).divide(1.0);
    [[d * scale, -b * scale], [-c * scale, a * scale]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::harmonic_stress;
    use crate::material::Coating;

    const RIGID: f64 = f64::INFINITY;

    fn stack(layers: &[[f64; 3]], [young, poisson]: [f64; 2]) -> Stack {
        let layers = layers.iter().map(|[t, young, poisson]| Coating::new(*t, *young, *poisson).unwrap());
        Stack::new(&Material::elastic(young, poisson).unwrap().layered(layers.collect()))
    }

    fn all(wave: Wave) -> [f64; 4] {
        [wave.along, wave.across, wave.normal, wave.coupling]
    }

    /// Asserts that two responses agree relative to the largest displacement.
    fn assert_alike(found: Wave, expected: Wave, tolerance: f64, of: &dyn std::fmt::Debug) {
        let largest = all(expected).into_iter().fold(0.0, f64::max);
        for (found, expected) in all(found).into_iter().zip(all(expected)) {
            let error = (found - expected).abs();
            assert!(
                error <= tolerance * largest,
                "{of:?}: {found:e} for {expected:e}, {:e}",
                error / largest
            );
        }
    }

    #[test]
    fn layers_alike_are_the_half_space() {
        let (young, poisson) = (7.0, 0.3);
        let shear = 0.5 * young / (1.0 + poisson);
        for layers in [vec![], vec![[1.0, young, poisson]], vec![[0.05, young, poisson]; 20]] {
            for q in [1e-4, 1e-2, 0.7, 1.0, 3.0, 19.9, 20.1, 400.0] {
                let found = stack(&layers, [young, poisson]).response(q);
                let unit = (shear * q).recip();
                let expected = Wave {
                    along: (1.0 - poisson) * unit,
                    across: unit,
                    normal: (1.0 - poisson) * unit,
                    coupling: 0.5 * (1.0 - 2.0 * poisson) * unit,
                };
                assert_alike(found, expected, 1e-14, &(layers.len(), q));
            }
        }
    }

    #[test]
    fn a_layer_cut_in_two_is_the_layer() {
        for (layer, base) in [
            ([0.5, 2.0, 0.3], [1.0, 0.2]),
            ([1.0, 1.0, 0.5], [1e3, 0.1]),
            ([1.0, 1.0, 0.5], [RIGID, 0.0]),
            ([1.0, 1e3, 0.0], [1.0, 0.5]),
        ] {
            let [t, young, poisson] = layer;
            for share in [0.3, 0.999] {
                let two = [[share * t, young, poisson], [(1.0 - share) * t, young, poisson]];
                for q in [1e-4, 1e-2, 0.3, 1.5, 2.5, 10.0, 400.0] {
                    let (whole, cut) = (stack(&[layer], base).response(q), stack(&two, base).response(q));
                    assert_alike(cut, whole, 2e-13, &(layer, base, share, q));
                }
            }
        }
    }

    /// Solves for the potentials of all layers at once: σ_zz = −φ, i σ_xz = φ′ and the displacements of Hooke's law, for
    /// q = 1 and φ = A e^(−z) + B z e^(−z) + C e^(z − t) + D (t − z) e^(z − t) in each layer (t, ν) of these moduli.
    fn by_potentials<M: Modulus>(
        layers: &[[f64; 2]],
        young: &[M],
        [base, poisson]: [f64; 2],
        size: impl Fn(M) -> f64,
    ) -> [[M; 2]; 2] {
        let (is_rigid, zero) = (base == RIGID, M::from(0.0));
        let count = layers.len();
        let unknowns = 4 * count + if is_rigid { 0 } else { 2 };
        // State i u_x, u_z, i σ_xz, σ_zz of each of the four potentials at a depth.
        let states = |[t, poisson]: [f64; 2], young: M, z: f64| -> [[M; 4]; 4] {
            let shear = young / (2.0 * (1.0 + poisson));
            let (down, up) = ((-z).exp(), (z - t).exp());
            let potentials = [
                [down, -down, down, -down],
                [z * down, (1.0 - z) * down, (z - 2.0) * down, (3.0 - z) * down],
                [up; 4],
                [t - z, t - z - 1.0, t - z - 2.0, t - z - 3.0].map(|factor| factor * up),
            ];
            potentials.map(|[f, f1, f2, f3]| {
                [
                    M::from(0.5 * ((1.0 - poisson) * f2 + poisson * f)) / shear,
                    M::from(0.5 * ((1.0 - poisson) * f3 + poisson * f1) - f1) / shear,
                    f1.into(),
                    (-f).into(),
                ]
            })
        };
        let mut rows: Vec<Vec<M>> = Vec::new();
        for component in [2, 3] {
            let mut row = vec![zero; unknowns];
            (0..4).for_each(|k| row[k] = states(layers[0], young[0], 0.0)[k][component]);
            rows.push(row);
        }
        for n in 0..count {
            let bottom = states(layers[n], young[n], layers[n][0]);
            let below = layers.get(n + 1).copied();
            let top = states(below.unwrap_or([0.0, poisson]), young[n + 1], 0.0);
            let next = if below.is_some() { 4 } else { unknowns - 4 * count };
            for component in 0..if next == 0 { 2 } else { 4 } {
                let mut row = vec![zero; unknowns];
                (0..4).for_each(|k| row[4 * n + k] = bottom[k][component]);
                (0..next).for_each(|k| row[4 * (n + 1) + k] = -top[k][component]);
                rows.push(row);
            }
        }
        let mut columns = [0, 1].map(|load| {
            let mut right = vec![zero; unknowns];
            right[load] = 1.0.into();
            right
        });
        // Gauss' elimination with pivots, of equations scaled to their largest coefficient.
        for (n, row) in rows.iter_mut().enumerate() {
            let largest = row.iter().fold(0.0f64, |most, value| most.max(size(*value)));
            row.iter_mut().for_each(|value| *value = *value / largest);
            columns.iter_mut().for_each(|right| right[n] = right[n] / largest);
        }
        for k in 0..unknowns {
            let pivot = (k..unknowns).max_by(|a, b| size(rows[*a][k]).total_cmp(&size(rows[*b][k]))).unwrap();
            rows.swap(k, pivot);
            columns.iter_mut().for_each(|right| right.swap(k, pivot));
            for n in k + 1..unknowns {
                let factor = rows[n][k] / rows[k][k];
                let (above, below) = rows.split_at_mut(n);
                below[0]
                    .iter_mut()
                    .zip(&above[k])
                    .for_each(|(value, above)| *value = *value - factor * *above);
                columns.iter_mut().for_each(|right| right[n] = right[n] - factor * right[k]);
            }
        }
        let top = states(layers[0], young[0], 0.0);
        let sum = |terms: &mut dyn Iterator<Item = M>| terms.fold(zero, |sum, term| sum + term);
        let displacements = columns.map(|mut right| {
            for k in (0..unknowns).rev() {
                let known = sum(&mut (k + 1..unknowns).map(|n| rows[k][n] * right[n]));
                right[k] = (right[k] - known) / rows[k][k];
            }
            [0, 1].map(|component| sum(&mut (0..4).map(|k| top[k][component] * right[k])))
        });
        [0, 1].map(|i| [0, 1].map(|j| displacements[j][i]))
    }

    #[test]
    fn random_stacks_are_those_of_potentials_of_all_layers_at_once() {
        arbtest::arbtest(|u| {
            let mut share =
                || Ok::<f64, arbtest::arbitrary::Error>(u.arbitrary::<u32>()? as f64 / f64::from(u32::MAX));
            let count = 1 + (7.0 * share()?) as usize;
            let (mut layers, mut moduli) = (Vec::new(), Vec::new());
            // Loss angles of up to 90°.
            let mut phases = Vec::new();
            for _ in 0..count {
                layers.push([10f64.powf(2.0 * share()? - 1.0), 0.5 * (1.2 * share()?).min(1.0)]);
                moduli.push(10f64.powf(2.0 * share()? - 1.0));
                phases.push(0.5 * std::f64::consts::PI * share()?);
            }
            let base =
                [if share()? < 0.2 { RIGID } else { 10f64.powf(2.0 * share()? - 1.0) }, 0.5 * share()?];
            moduli.push(base[0]);
            phases.push(if base[0] == RIGID { 0.0 } else { 0.5 * std::f64::consts::PI * share()? });
            let coatings = layers
                .iter()
                .zip(&moduli)
                .map(|([t, poisson], young)| Coating::new(*t, *young, *poisson).unwrap());
            let material = Material::elastic(base[0], base[1]).unwrap().layered(coatings.collect());
            let found = Stack::new(&material).response(1.0);
            let [[along, one], [other, normal]] = by_potentials(&layers, &moduli, base, f64::abs);
            let across = found.across;
            let expected = Wave { along: -along, across, normal: -normal, coupling: one };
            assert_alike(found, expected, 1e-10, &(&layers, &moduli, base));
            assert!(
                (one - other).abs() < 1e-10 * along.abs().max(normal.abs()),
                "reciprocity: {one} and {other}"
            );
            assert!(found.normal > 0.0 && found.along * found.normal > found.coupling.powi(2), "{found:?}");
            let complex: Vec<Complex64> = moduli
                .iter()
                .zip(&phases)
                .map(
                    |(young, phase)| {
                        if *young == RIGID { RIGID.into() } else { Complex64::from_polar(*young, *phase) }
                    },
                )
                .collect();
            let found = Stack::with_moduli(&material, &complex).normal(1.0);
            let expected = -by_potentials(&layers, &complex, base, Complex64::norm)[1][1];
            assert!(
                (found - expected).norm() < 1e-10 * expected.norm(),
                "{layers:?}, {complex:?}: {found} for {expected}"
            );
            // A load that oscillates does work: û has the sign of a loss.
            assert!(found.im < 1e-12 * found.norm(), "{found}");
            Ok(())
        })
        .budget_ms(500);
    }

    #[test]
    fn a_thick_layer_is_a_half_space_and_a_thin_one_none() {
        let base = [1.0, 0.2];
        for layer in [[1.0, 3.0, 0.3], [1.0, 0.2, 0.5]] {
            let [_, young, poisson] = layer;
            assert_alike(
                stack(&[layer], base).response(50.0),
                stack(&[], [young, poisson]).response(50.0),
                1e-14,
                &layer,
            );
            assert_alike(stack(&[layer], base).response(1e-8), stack(&[], base).response(1e-8), 1e-7, &layer);
        }
    }

    #[test]
    fn out_of_the_plane_a_layer_on_a_rigid_base_is_sheared() {
        let found = stack(&[[2.0, 3.0, 0.5]], [RIGID, 0.3]).response(0.7);
        let expected = 1.4f64.tanh() / 0.7;
        assert!((found.across - expected).abs() < 1e-14 * expected, "{}", found.across);
        // A thin layer shears by t/G along the wave, too.
        let thin = stack(&[[1e-4, 3.0, 0.3]], [RIGID, 0.3]).response(1.0);
        assert!((thin.along * 3.0 / 2.6 / 1e-4 - 1.0).abs() < 1e-7);
    }

    #[test]
    fn in_layers_alike_the_stress_is_that_of_the_half_space() {
        let (young, poisson) = (7.0, 0.3);
        for layers in [vec![], vec![[1.0, young, poisson]], vec![[0.05, young, poisson]; 20]] {
            let stack = stack(&layers, [young, poisson]);
            for q in [0.0, 1e-3, 0.7, 3.0, 40.0] {
                for (depth, angle) in [(0.0, 0.3f64), (0.02, 1.2), (0.35, 2.0), (0.97, 4.0), (1.3, 5.5)] {
                    let layer = stack.interfaces().iter().rposition(|top| *top <= depth + 1e-12).unwrap();
                    let wave = stack.stress(q, layer, depth);
                    let direction = [angle.cos(), angle.sin()];
                    for (component, traction) in all_coefficients() {
                        let found = wave.component(
                            if q == 0.0 { [1.0, 0.0] } else { direction },
                            component,
                            traction,
                        );
                        let exact =
                            harmonic_stress(direction.map(|d| q * d), depth, poisson, component, traction);
                        assert!(
                            (found - exact).abs() < 1e-13,
                            "{component:?} under {traction:?}, {} layers, {q}, {depth}: {found:e} for {exact:e}",
                            layers.len()
                        );
                    }
                }
            }
        }
    }

    fn all_coefficients() -> impl Iterator<Item = (Component, Traction)> {
        Component::ALL.into_iter().flat_map(|component| Traction::ALL.map(|traction| (component, traction)))
    }

    /// The stresses are in equilibrium, compatible, meet at the interfaces, and are the tractions on the surface.
    #[test]
    fn stresses_meet_at_interfaces_and_are_in_equilibrium_between_them() {
        let layers = [[0.5, 4.0, 0.25], [1.0, 1.4, 0.5], [0.2, 19.0, 0.1], [6.0, 2.0, 0.4]];
        for base in [[2.6, 0.3], [RIGID, 0.0]] {
            let stack = stack(&layers, base);
            let tops = stack.interfaces();
            for q in [0.05, 0.4, 1.3, 9.0] {
                let surface = stack.stress(q, 0, 0.0);
                let at = |wave: WaveStress, which: usize| {
                    [wave.pressure[which], wave.along[which], wave.across[which % 2]]
                };
                let expected = [at(surface, 2), at(surface, 3)];
                for (found, exact) in [
                    (expected[0][0], -1.0),
                    (expected[0][1], 0.0),
                    (expected[1][0], 0.0),
                    (expected[1][1], -1.0),
                    (surface.across[0], -1.0),
                ] {
                    assert!((found - exact).abs() < 1e-12, "surface: {found} for {exact}");
                }
                for (n, depth) in tops.iter().enumerate().skip(1).take(if base[0] == RIGID { 3 } else { 4 }) {
                    let (above, below) = (stack.stress(q, n - 1, *depth), stack.stress(q, n, *depth));
                    let size = 1e-11
                        * above
                            .pressure
                            .iter()
                            .chain(&above.along)
                            .fold(1e-30f64, |most, s| most.max(s.abs()));
                    for which in [2, 3] {
                        assert!(
                            (above.pressure[which] - below.pressure[which]).abs() < size,
                            "{q}, {n}, {which}: {above:?} and {below:?}"
                        );
                        assert!(
                            (above.along[which] - below.along[which]).abs() < size,
                            "{q}, {n}, {which}: {above:?} and {below:?}"
                        );
                    }
                    assert!(
                        (above.across[0] - below.across[0]).abs() < 1e-12 * above.across[0].abs().max(1e-30),
                        "{above:?} and {below:?}"
                    );
                }
                // (i σ_xz)' = q σ_xx, σ_zz' = −q i σ_xz: central differences in the middle of each.
                for (n, top) in tops.iter().enumerate().take(if base[0] == RIGID { 4 } else { 5 }) {
                    let depth = top + 0.4 * layers.get(n).map_or(1.0, |layer| layer[0]);
                    let step = 1e-3 / q.max(1.0);
                    let [before, here, after] =
                        [-1.0, 0.0, 1.0].map(|sign| stack.stress(q, n, depth + sign * step));
                    let slope = |of: fn(&WaveStress) -> f64| (of(&after) - of(&before)) / (2.0 * step * q);
                    let size =
                        here.pressure.iter().chain(&here.along).fold(0.0f64, |most, s| most.max(s.abs()));
                    let residuals = [
                        // Under the pressure i σ_xz = −(imaginary part), under the shear the factor is −i.
                        slope(|w| w.pressure[3]) + here.pressure[0],
                        slope(|w| w.pressure[2]) - here.pressure[3],
                        slope(|w| w.along[3]) - here.along[0],
                        slope(|w| w.along[2]) + here.along[3],
                        slope(|w| w.across[0]) - here.across[1],
                    ];
                    for residual in residuals {
                        assert!(
                            residual.abs() < 1e-5 * size.max(here.across[0].abs()),
                            "{q}, {n}: {residuals:?} of {size}"
                        );
                    }
                    // The strain along z is that of the displacements: the crests are in plane strain.
                    let nu = layers.get(n).map_or(base[1], |layer| layer[2]);
                    assert!(
                        (here.pressure[1] - nu * (here.pressure[0] + here.pressure[2])).abs() < 1e-14 * size
                    );
                }
            }
        }
    }
}
