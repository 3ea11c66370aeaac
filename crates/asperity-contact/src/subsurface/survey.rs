//! Stress on planes from the surface of a body down.

use super::layers::{Face, InLayer, LayerStress, by_layer, faces};
use super::{Maximum, Plane, Subsurface};
use crate::kernel::Stack;
use crate::math::parallel;
use crate::units::Metre;

/// The stress on planes from the surface of a body down.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Survey<T> {
    /// The largest stresses on the planes, at both sides of interfaces between layers, and near the most stressed point.
    pub maximum: Maximum,
    /// The largest stresses in each layer, and in the body below them; empty without layers.
    pub layers: Vec<LayerStress>,
    /// The kept part of each plane.
    pub planes: Vec<T>,
}

impl Subsurface {
    /// Returns the largest stresses on planes at the `depths`, see [`Self::survey`].
    ///
    /// # Panics
    /// If there are no depths.
    pub fn maximum(&self, depths: &[Metre]) -> Maximum {
        self.survey(depths, |_, _| ()).maximum
    }

    /// Computes the planes at the `depths`, ascending, in parallel, with one plane per thread. Keeps what `look` returns
    /// for each plane and the largest stresses on it.
    ///
    /// The maximum includes both sides of interfaces down to the last depth, and a few more planes near the most stressed
    /// point. Each of these is at the vertex of a parabola in depth through the known von Mises stresses. The
    /// depth is accurate to about a hundredth of the distance between the planes. Each value is that of a cell at
    /// a depth, never interpolated.
    ///
    /// A layer includes both its faces and the planes between them. Layers that begin below the last depth are left out.
    ///
    /// # Panics
    /// If there are no depths.
    pub fn survey<T: Send>(&self, depths: &[Metre], look: impl Fn(Plane, &Maximum) -> T + Sync) -> Survey<T> {
        let last = *depths.last().expect("there are depths");
        let tops = self.stack.as_ref().map_or_else(Vec::new, Stack::interfaces);
        let mut places: Vec<_> = depths.iter().map(|depth| (self.layer_at(*depth), *depth)).collect();
        for face in faces(&tops, last) {
            if !places.contains(&face) {
                places.push(face);
            }
        }
        let found = parallel::tasks(places.iter().enumerate(), |(k, &(layer, depth))| {
            let plane = self.plane_in(layer, depth);
            let most = plane.maximum();
            let face = tops.contains(&depth).then(|| Face::new(&plane));
            let kept = (k < depths.len()).then(|| look(plane, &most));
            (most, InLayer { layer, depth, von_mises: most.von_mises, face }, kept)
        });
        let (mut in_layers, mut planes, mut searched) = (Vec::new(), Vec::new(), Vec::new());
        for (here, in_layer, kept) in found {
            if kept.is_some() || (in_layer.depth > 0.0 && in_layer.depth <= last) {
                searched.push((in_layer.layer, here));
            }
            in_layers.push(in_layer);
            planes.extend(kept);
        }
        in_layers.sort_by(|one, other| one.depth.total_cmp(&other.depth));
        let maximum = self.refined(&mut searched);
        Survey { maximum, layers: by_layer(&tops, last, &in_layers), planes }
    }
}
