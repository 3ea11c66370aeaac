//! Stress in layers under a uniformly loaded cell.

use crate::kernel::cell::{far_points, gauss_points};
use crate::kernel::remainder::{Remainder, Transform};
use crate::kernel::smooth_line::Strips;
use crate::kernel::{Stack, Traction, WaveStress};
use crate::stress::{Component, Stress};
use crate::units::Metre;

/// The stress of waves at a depth of a body with layers, in the layer at the surface minus that of a half-space of its
/// material. It decays there as e^(−q(2t − z)), in the layers below as e^(−qz).
struct Beyond<'s> {
    stack: &'s Stack,
    layer: usize,
    depth: Metre,
    /// The half-space.
    surface: Option<Stack>,
    /// Depth of the singularities of its transforms.
    scale: Metre,
}

impl<'s> Beyond<'s> {
    fn new(stack: &'s Stack, layer: usize, depth: Metre) -> Self {
        let (surface, scale) = match (layer, stack.interfaces().get(1)) {
            (0, Some(thickness)) => (Some(stack.surface()), 2.0 * thickness - depth),
            _ => (None, depth),
        };
        Self { stack, layer, depth, surface, scale }
    }

    /// Returns some amplitudes of a wave.
    fn wave<const N: usize>(&self, q: f64, amplitudes: impl Fn(&WaveStress) -> [f64; N]) -> [f64; N] {
        let own = amplitudes(&self.stack.stress(q, self.layer, self.depth));
        let Some(surface) = &self.surface else { return own };
        let other = amplitudes(&surface.stress(q, 0, self.depth));
        std::array::from_fn(|n| own[n] - other[n])
    }
}

/// The stress at a depth of a body with layers under a cell with a uniform traction, in the layer at the surface minus that of a
/// half-space of its material, see [`crate::kernel::cell_stress`].
///
/// The stresses of waves depend on their direction φ by cos nφ and sin nφ, n up to 3, and the stress under a point load by their
/// transforms with Jₙ. These are smooth, and Gauss' rule integrates them over a cell, or over its parts where they are larger than
/// the depth of their singularities.
pub struct LayerCells {
    pitch: [Metre; 2],
    surface: Option<f64>,
    /// Depth of the singularities of the transforms.
    scale: Metre,
    table: Remainder<11>,
}

impl LayerCells {
    /// Tabulates the stress of a body at a `depth` in a `layer`, see [`Stack::stress`], at distances up to `reach`.
    pub fn new(stack: &Stack, layer: usize, depth: Metre, pitch: [Metre; 2], reach: Metre) -> Self {
        use Transform::{Hankel, Order};
        let beyond = Beyond::new(stack, layer, depth);
        let transforms = [
            Hankel,
            Hankel,
            Order(2),
            Order(1),
            Order(1),
            Hankel,
            Order(2),
            Order(1),
            Order(1),
            Order(1),
            Order(3),
        ];
        let table = Remainder::new(|q| beyond.wave(q, by_order), transforms, beyond.scale, reach);
        Self { pitch, surface: beyond.surface.as_ref().map(Stack::poisson), scale: beyond.scale, table }
    }

    /// Poisson's ratio of the half-space whose stress is to be added, in the layer at the surface.
    pub fn surface(&self) -> Option<f64> {
        self.surface
    }

    /// Returns the stress at `(x, y)` per unit of each of [`Traction::ALL`] on the cell at the origin, dimensionless.
    pub fn at(&self, [x, y]: [Metre; 2]) -> [Stress; 3] {
        /// Size of a part over the distance to the singularities: the error is below 1e-7 of the traction.
        const PART: f64 = 0.5;
        /// Beyond this number of half-sides four points are as good.
        const FAR: f64 = 40.0;
        let cell = 0.5 * self.pitch[0].hypot(self.pitch[1]);
        let distance = self.scale.hypot((x.hypot(y) - cell).max(0.0));
        let parts = self.pitch.map(|pitch| (pitch / (PART * distance)).ceil().max(1.0) as usize);
        let half = [0, 1].map(|axis| 0.5 * self.pitch[axis] / parts[axis] as f64);
        let mut sums = [Stress::default(); 3];
        let mut add = |point: [Metre; 2], weight: f64| {
            let stresses = self.under_point(point);
            sums = std::array::from_fn(|n| sums[n] + (weight * half[0] * half[1]) * stresses[n]);
        };
        for part in 0..parts[0] * parts[1] {
            let offset = |axis: usize, k: usize| (2 * k + 1) as f64 * half[axis] - 0.5 * self.pitch[axis];
            let centre = [x + offset(0, part / parts[1]), y + offset(1, part % parts[1])];
            if distance > FAR * half[0].max(half[1]) {
                far_points(centre, half).into_iter().for_each(|point| add(point, 1.0));
            } else {
                gauss_points(centre, half).for_each(|(point, weight)| add(point, weight));
            }
        }
        sums
    }

    fn under_point(&self, [x, y]: [Metre; 2]) -> [Stress; 3] {
        let r = x.hypot(y);
        let table = self.table.at(r);
        let [c, s] = if r == 0.0 { [1.0, 0.0] } else { [x / r, y / r] };
        let [cos_2, sin_2] = [c * c - s * s, 2.0 * c * s];
        let pressure = Stress {
            xx: table[1] - table[2] * cos_2,
            yy: table[1] + table[2] * cos_2,
            zz: table[0],
            yz: -table[3] * s,
            xz: -table[3] * c,
            xy: -table[2] * sin_2,
        };
        let along_y = exchanged(along_x(&table, [s, c]));
        [along_x(&table, [c, s]), along_y, pressure]
    }
}

/// The stress as that of [`LayerCells`], under an endless strip of cells along an axis.
pub struct LayerStrip {
    strips: Strips<18>,
    half: Metre,
}

impl LayerStrip {
    /// Tabulates the stress of a body at a `depth` in a `layer` at distances across the strip up to `reach`.
    pub fn new(
        stack: &Stack,
        layer: usize,
        depth: Metre,
        pitch: [Metre; 2],
        axis: usize,
        reach: Metre,
    ) -> Self {
        let beyond = Beyond::new(stack, layer, depth);
        let direction = if axis == 1 { [1.0, 0.0] } else { [0.0, 1.0] };
        let odd = |n: usize| Traction::ALL[n / 6].odd(Component::ALL[n % 6]);
        let amplitudes = |wave: &WaveStress| {
            std::array::from_fn(|n| {
                let amplitude = wave.component(direction, Component::ALL[n % 6], Traction::ALL[n / 6]);
                // The wave e^(iqx) with a factor i is −sin qx.
                if odd(n)[1 - axis] { -amplitude } else { amplitude }
            })
        };
        let transforms: [Transform; 18] =
            std::array::from_fn(|n| if odd(n)[1 - axis] { Transform::Sine } else { Transform::Cosine });
        let rest = |q: f64| beyond.wave(q, amplitudes);
        let scales = [beyond.scale; 2];
        let strips = Strips::new(rest, transforms, [0.0; 18], scales, reach);
        Self { strips, half: 0.5 * pitch[1 - axis] }
    }

    /// Returns the stress at a distance across the strip per unit of each of [`Traction::ALL`], dimensionless.
    pub fn at(&self, across: Metre) -> [Stress; 3] {
        let values = self.strips.under_strip(across, self.half);
        std::array::from_fn(|traction| {
            Stress::from_components(std::array::from_fn(|component| values[6 * traction + component]))
        })
    }
}

/// Stress under a shear along x, in the direction `[cos, sin]` from it.
fn along_x(table: &[f64; 11], [c, s]: [f64; 2]) -> Stress {
    let [cos_2, sin_2] = [c * c - s * s, 2.0 * c * s];
    let [cos_3, sin_3] = [c * cos_2 - s * sin_2, s * cos_2 + c * sin_2];
    Stress {
        xx: -table[7] * c + table[10] * cos_3,
        yy: -table[8] * c - table[10] * cos_3,
        zz: -table[4] * c,
        yz: -table[6] * sin_2,
        xz: table[5] - table[6] * cos_2,
        xy: -table[9] * s + table[10] * sin_3,
    }
}

/// Exchanges x and y.
fn exchanged(stress: Stress) -> Stress {
    let Stress { xx, yy, zz, yz, xz, xy } = stress;
    Stress { xx: yy, yy: xx, zz, yz: xz, xz: yz, xy }
}

/// Returns the amplitudes of the stresses of a wave in the order of the transforms: of the pressure zz, the mean and the half
/// difference in the plane, and xz; of the shear along x zz, the two of xz, and those of xx, yy and xy with cos φ
/// or sin φ, and with cos 3φ.
fn by_order(wave: &WaveStress) -> [f64; 11] {
    let at = |direction, component, traction| wave.component(direction, component, traction);
    let (x, y) = ([1.0, 0.0], [0.0, 1.0]);
    let (own, crests) = (at(x, Component::Xx, Traction::Pressure), at(x, Component::Yy, Traction::Pressure));
    let (a, b) = (at(x, Component::Xx, Traction::X), at(x, Component::Yy, Traction::X));
    // The shear along the crests of a wave along y is that along x.
    let mixed = at(y, Component::Xy, Traction::X);
    let (along, across) = (at(x, Component::Xz, Traction::X), at(y, Component::Xz, Traction::X));
    [
        at(x, Component::Zz, Traction::Pressure),
        0.5 * (own + crests),
        0.5 * (own - crests),
        at(x, Component::Xz, Traction::Pressure),
        at(x, Component::Zz, Traction::X),
        0.5 * (along + across),
        0.5 * (along - across),
        0.25 * (3.0 * a + b + 2.0 * mixed),
        0.25 * (a + 3.0 * b - 2.0 * mixed),
        0.25 * (a - b + 2.0 * mixed),
        0.25 * (a - b - 2.0 * mixed),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::cell_stress;
    use crate::material::{Coating, Material};

    fn stack(layers: &[[f64; 3]], [young, poisson]: [f64; 2]) -> Stack {
        let layers = layers.iter().map(|[t, young, poisson]| Coating::new(*t, *young, *poisson).unwrap());
        Stack::new(&Material::elastic(young, poisson).unwrap().layered(layers.collect()))
    }

    /// Returns the stress with that of the half-space.
    fn whole(cells: &LayerCells, at: [f64; 2], depth: f64) -> [Stress; 3] {
        let rest = cells.at(at);
        let Some(poisson) = cells.surface() else { return rest };
        std::array::from_fn(|n| rest[n] + cell_stress(at, depth, cells.pitch, poisson, Traction::ALL[n]))
    }

    const PLACES: [[f64; 2]; 4] = [[0.0, 0.0], [0.6, 0.0], [-1.2, 2.1], [9.0, -4.2]];

    #[test]
    fn in_layers_alike_it_is_that_of_the_half_space() {
        let stack = stack(&[[0.4, 2.0, 0.3], [0.9, 2.0, 0.3]], [2.0, 0.3]);
        for (layer, depth) in [(0, 0.0), (0, 0.4), (1, 0.4), (1, 1.0), (2, 1.3), (2, 5.0)] {
            for pitch in [[0.6, 0.7], [0.05, 0.1], [3.0, 0.7]] {
                let cells = LayerCells::new(&stack, layer, depth, pitch, 60.0);
                for place in PLACES {
                    let found = whole(&cells, place, depth);
                    for (found, traction) in found.iter().zip(Traction::ALL) {
                        let exact = cell_stress(place, depth, pitch, 0.3, traction);
                        for (found, exact) in found.components().iter().zip(exact.components()) {
                            let error = found - exact;
                            assert!(
                                error.abs() < 1e-7,
                                "{layer}, {depth}, {pitch:?}, {place:?}, {traction:?}: {found:e} for {exact:e}"
                            );
                        }
                    }
                }
            }
        }
    }

    /// The tables of two layers differ wholly, and meet in the tractions and in the strains along the interface.
    #[test]
    fn tractions_and_strains_along_an_interface_are_the_same_on_both_sides() {
        let layers = [[0.4, 10.0, 0.2], [0.9, 1.0, 0.45]];
        let base = [3.0, 0.3];
        let stack = stack(&layers, base);
        let pitch = [0.6, 0.7];
        for (n, depth) in [(0, 0.4), (1, 1.3)] {
            let constants = |n: usize| layers.get(n).map_or(base, |[_, young, poisson]| [*young, *poisson]);
            let sides = [n, n + 1].map(|n| (LayerCells::new(&stack, n, depth, pitch, 60.0), constants(n)));
            for place in PLACES {
                let seen = sides.each_ref().map(|(cells, [young, poisson])| {
                    whole(cells, place, depth).map(|stress| {
                        let Stress { xx, yy, zz, yz, xz, xy } = stress;
                        let strain = |own: f64, others: f64| (own - poisson * others) / young;
                        [zz, yz, xz, strain(xx, yy + zz), strain(yy, xx + zz), (1.0 + poisson) / young * xy]
                    })
                });
                for (above, below) in seen[0].iter().flatten().zip(seen[1].iter().flatten()) {
                    assert!(
                        (above - below).abs() < 2e-7,
                        "{n}, {place:?}: {above:e} and {below:e}, {seen:?}"
                    );
                }
            }
        }
    }
}
