//! Residual stress of plastic strain at any depth.

use super::{Layers, MAX_LAYERS, TensorField, Volume};
use crate::error::Result;
use crate::grid::{Grid, Placement};
use crate::material::Material;
use crate::operator::Boundary;
use crate::stress::Component;
use crate::subsurface::LayeredStress;
use crate::units::Metre;

/// Computes the residual stress of a plastic `strain`, `[layer, component, ix, iy]`, in the `layers` of a
/// body on a `grid`. It is evaluated from the surface down to a depth `to`, which may lie below the layers,
/// under a contact placed on the body. Cost: one operator application with as many layers.
///
/// # Errors
/// The errors of [`Volume::new`].
///
/// # Panics
/// If the shape of the strain differs.
#[expect(clippy::too_many_arguments, reason = "a body, what has flowed in it, and where it is looked at")]
pub fn residual_below(
    grid: Grid,
    layers: &Layers,
    boundary: Boundary,
    material: &Material,
    strain: &TensorField,
    placement: &Placement,
    columns: usize,
    to: Metre,
) -> Result<LayeredStress> {
    let mut faces = layers.faces().to_vec();
    let mut thickness = layers.thickness(layers.count() - 1);
    // Below the plastic layers the stress varies over the depth.
    while faces[faces.len() - 1] < to && faces.len() <= MAX_LAYERS {
        faces.push(faces[faces.len() - 1] + thickness);
        thickness *= 1.1;
    }
    let all = Layers::between(&faces)?;
    let centres = (0..all.count()).map(|layer| all.centre(layer)).collect();
    let mut volume = Volume::new(grid, all, boundary, material)?;
    let mut deep = volume.zeros();
    deep.slice_mut(ndarray::s![..layers.count(), .., .., ..]).assign(strain);
    let stress = volume.residual(&deep);
    let under = |layer: usize, component: Component| {
        let field = stress.slice(ndarray::s![layer, component as usize, .., ..]).to_owned();
        placement.under(&field, columns)
    };
    let planes =
        (0..stress.shape()[0]).map(|layer| Component::ALL.map(|component| under(layer, component))).collect();
    Ok(LayeredStress::new(centres, planes))
}
