//! Stress in the layers of a body, and at their faces.

use crate::subsurface::{Extreme, Plane};
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
    pub tension: Extreme,
    /// Largest principal tension at its lower face; `None` for the body below the layers.
    pub tension_below: Option<Pascal>,
    /// Largest shear traction on its upper face. At an interface it is that of the layer above, also on a rigid body.
    pub shear: Pascal,
    /// Largest tension across its upper face, > 0 if it can come off.
    pub pull: Pascal,
}

/// The largest stresses on a plane in a layer.
pub(super) struct InLayer {
    pub(super) layer: usize,
    pub(super) depth: Metre,
    pub(super) von_mises: Extreme,
    /// `None` between the faces of the layer.
    pub(super) face: Option<Face>,
}

/// The largest stresses on a face of a layer.
#[derive(Clone, Copy)]
pub(super) struct Face {
    tension: Extreme,
    shear: Pascal,
    pull: Pascal,
}

impl Face {
    pub(super) fn new(plane: &Plane) -> Self {
        Self {
            tension: plane.largest(|stress| stress.principal()[0]),
            shear: plane.largest(|stress| stress.xz.hypot(stress.yz)).value,
            pull: plane.largest(|stress| stress.zz).value,
        }
    }
}

/// Returns the faces of the layers that begin at the depths `tops` down to a depth: the layer and the depth of each.
pub(super) fn faces(tops: &[Metre], to: Metre) -> impl Iterator<Item = (usize, Metre)> {
    let reached = tops.iter().enumerate().take_while(move |(_, top)| **top <= to);
    reached
        .flat_map(|(n, top)| [Some(top), tops.get(n + 1)].into_iter().flatten().map(move |depth| (n, *depth)))
}

/// Returns the largest stresses in each layer down to a depth from those on `planes`, ascending, among which are its faces.
pub(super) fn by_layer(tops: &[Metre], to: Metre, planes: &[InLayer]) -> Vec<LayerStress> {
    let reached = tops.iter().enumerate().take_while(|(_, top)| **top <= to);
    let layers = reached.map(|(n, &depth)| {
        let inside = planes.iter().filter(|plane| plane.layer == n);
        let face = |layer: usize, at: Metre| {
            planes.iter().find(|plane| plane.layer == layer && plane.depth == at)?.face
        };
        let upper = face(n, depth).expect("the upper face of a layer");
        // A rigid body has no stress, but the layer on it has.
        let Face { shear, pull, .. } = face(n.saturating_sub(1), depth).expect("the lower face of a layer");
        LayerStress {
            depth,
            von_mises: inside.map(|plane| plane.von_mises).reduce(Extreme::or).expect("a face"),
            tension: upper.tension,
            tension_below: tops.get(n + 1).and_then(|bottom| face(n, *bottom)).map(|face| face.tension.value),
            shear,
            pull,
        }
    });
    layers.collect()
}
