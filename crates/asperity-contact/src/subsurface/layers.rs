//! Stress in the layers of a body, and at their faces.

use crate::kernel::Stack;
use crate::math::parallel;
use crate::subsurface::{Extreme, Plane, Subsurface};
use crate::units::{Metre, Pascal};

/// The largest stresses in a layer of a body, or in the body below its layers.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct LayerStress {
    /// Depth of its upper face, the surface or the interface with the layer above.
    pub depth: Metre,
    /// Von Mises' stress in it.
    pub von_mises: Extreme,
    /// Largest principal tension at its upper face, > 0 if it can crack.
    pub tension: Pascal,
    /// Largest principal tension at its lower face; `None` for the body below the layers.
    pub tension_below: Option<Pascal>,
    /// Largest shear traction on its upper face.
    pub shear: Pascal,
    /// Largest tension across its upper face, > 0 if it can come off.
    pub pull: Pascal,
}

impl Subsurface {
    /// Returns the planes at both sides of the interfaces down to a depth.
    pub(super) fn faces(&self, to: Metre) -> Vec<Plane> {
        let tops = self.stack.as_ref().map_or_else(Vec::new, Stack::interfaces);
        let inside = tops.iter().enumerate().skip(1).filter(|(_, top)| **top <= to);
        parallel::tasks(inside.flat_map(|(n, top)| [(n - 1, *top), (n, *top)]), |(n, depth)| {
            self.plane_in(n, depth)
        })
    }

    /// Returns the largest stresses in each layer, and in the body below them, at both faces and at those of the `depths`
    /// that lie in it. Layers that begin below the last depth are left out.
    ///
    /// # Panics
    /// If there are no depths.
    pub fn layers(&self, depths: &[Metre]) -> Vec<LayerStress> {
        let last = depths.last().expect("there are depths");
        let Some(stack) = &self.stack else { return Vec::new() };
        let tops = stack.interfaces();
        let count = tops.iter().take_while(|top| *top <= last).count();
        parallel::tasks(0..count, |n| {
            let bottom = tops.get(n + 1).copied();
            let is_inside =
                |depth: &&Metre| **depth > tops[n] && bottom.is_none_or(|bottom| **depth < bottom);
            let top = self.plane_in(n, tops[n]);
            let mut von_mises = top.maximum().von_mises;
            let mut include = |plane: &Plane| {
                let found = plane.maximum().von_mises;
                if found.value > von_mises.value {
                    von_mises = found;
                }
            };
            depths.iter().filter(is_inside).for_each(|depth| include(&self.plane_in(n, *depth)));
            let lower = bottom.map(|bottom| self.plane_in(n, bottom));
            lower.iter().for_each(include);
            LayerStress {
                depth: tops[n],
                von_mises,
                tension: top.largest(|stress| stress.principal()[0]),
                tension_below: lower.map(|plane| plane.largest(|stress| stress.principal()[0])),
                shear: top.largest(|stress| stress.xz.hypot(stress.yz)),
                pull: top.largest(|stress| stress.zz),
            }
        })
    }
}
