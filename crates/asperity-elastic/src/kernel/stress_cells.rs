//! Stress in layers under a uniformly loaded cell.

use crate::kernel::cell::{far_points, gauss_points};
use crate::kernel::remainder::{Remainder, Transform};
use crate::kernel::{Stack, Traction, WaveStress, cell_stress};
use crate::stress::{Component, Stress};
use crate::units::Metre;

/// The stress at a depth of a body with layers, under a cell with a uniform traction.
///
/// The stresses of waves depend on their direction φ by cos nφ and sin nφ, n up to 3, and the stress under a point load by their
/// transforms with Jₙ. In the layer at the surface these are what the stress of a half-space of the same material, a closed form,
/// leaves over. It decays as e^(−q(2t − z)), in the layers below as e^(−qz). So it is smooth, and Gauss' rule
/// integrates it over a cell, or over its parts where they are larger than that depth.
pub struct LayerCells {
    pitch: [Metre; 2],
    depth: Metre,
    /// Poisson's ratio of the layer at the surface, for points in it.
    surface: Option<f64>,
    /// Depth of the singularities of the transforms.
    scale: Metre,
    table: Remainder<11>,
}

impl LayerCells {
    /// Tabulates the stress of a body at a `depth` in a `layer`, see [`Stack::stress`], at distances up to `reach`.
    pub fn new(stack: &Stack, layer: usize, depth: Metre, pitch: [Metre; 2], reach: Metre) -> Self {
        use Transform::{Hankel, Order};
        let half_space = stack.surface();
        let (thickness, surface) = match (layer, stack.interfaces().get(1)) {
            (0, Some(thickness)) => (*thickness, Some(half_space.poisson())),
            _ => (0.0, None),
        };
        let scale = if surface.is_some() { 2.0 * thickness - depth } else { depth };
        let rest = |q: f64| {
            let own = by_order(&stack.stress(q, layer, depth));
            match surface {
                None => own,
                Some(_) => {
                    let other = by_order(&half_space.stress(q, 0, depth));
                    std::array::from_fn(|n| own[n] - other[n])
                }
            }
        };
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
        Self { pitch, depth, surface, scale, table: Remainder::new(rest, transforms, scale, reach) }
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
        let Some(poisson) = self.surface else { return sums };
        let closed =
            Traction::ALL.map(|traction| cell_stress([x, y], self.depth, self.pitch, poisson, traction));
        std::array::from_fn(|n| sums[n] + closed[n])
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
    use crate::material::{Coating, Material};

    fn stack(layers: &[[f64; 3]], [young, poisson]: [f64; 2]) -> Stack {
        let layers = layers.iter().map(|[t, young, poisson]| Coating::new(*t, *young, *poisson).unwrap());
        Stack::new(&Material::elastic(young, poisson).unwrap().layered(layers.collect()))
    }

    const PLACES: [[f64; 2]; 4] = [[0.0, 0.0], [0.6, 0.0], [-1.2, 2.1], [9.0, -4.2]];

    #[test]
    fn in_layers_alike_it_is_that_of_the_half_space() {
        let stack = stack(&[[0.4, 2.0, 0.3], [0.9, 2.0, 0.3]], [2.0, 0.3]);
        for (layer, depth) in [(0, 0.0), (0, 0.4), (1, 0.4), (1, 1.0), (2, 1.3), (2, 5.0)] {
            for pitch in [[0.6, 0.7], [0.05, 0.1], [3.0, 0.7]] {
                let cells = LayerCells::new(&stack, layer, depth, pitch, 60.0);
                for place in PLACES {
                    let found = cells.at(place);
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
                    cells.at(place).map(|stress| {
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
