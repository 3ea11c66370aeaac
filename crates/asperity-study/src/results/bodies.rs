//! Bodies in field files: heights, state of laws, plastic state below the surfaces.

use super::{BODIES, depths_attribute, state_name, states_attribute, tensor_name};
use crate::io::fields::FieldFile;
use asperity_base::grid::{CellValues, Grid};
use asperity_base::units::Pascal;
use asperity_contact::motion::{Pair, PlasticVolume, State};
use asperity_contact::plasticity::TensorField;
use asperity_contact::solver::Friction;
use asperity_contact::stress::Component;

/// Adds the plastic state below the surfaces, and the part `left` after unloading.
pub(super) fn add_volumes(file: &mut FieldFile, volumes: &[PlasticVolume], left: &[PlasticVolume]) {
    for PlasticVolume { body, grid, faces, state, displacement, .. } in volumes {
        let body = BODIES[*body];
        file.set(&depths_attribute(body), faces.clone());
        add_tensor(file, "strain", "1", body, grid, &state.strain);
        let accumulated = layers_last(state.accumulated.view());
        file.add_layers(&state_name("accumulated", body), "1", grid, &accumulated);
        if let Some(back) = &state.back_stress {
            add_tensor(file, "back_stress", "Pa", body, grid, back);
        }
        file.add_field(&state_name("displacement", body), "m", grid, [0.0, 0.0], displacement);
    }
    for PlasticVolume { body, grid, residual_stress, displacement, .. } in left {
        let body = BODIES[*body];
        add_tensor(file, "residual_stress", "Pa", body, grid, residual_stress);
        file.add_field(&state_name("residual_displacement", body), "m", grid, [0.0, 0.0], displacement);
    }
}

/// Adds a tensor in the layers of a body, one array per component.
fn add_tensor(file: &mut FieldFile, name: &str, unit: &str, body: &str, grid: &Grid, tensor: &TensorField) {
    for component in Component::ALL {
        let layers = tensor.index_axis(ndarray::Axis(1), component as usize);
        let name = tensor_name(name, component, body);
        file.add_layers(&name, unit, grid, &layers_last(layers));
    }
}

/// Converts `[layer, ix, iy]` to `[ix, iy, layer]`.
fn layers_last(values: ndarray::ArrayView3<f64>) -> ndarray::Array3<f64> {
    values.permuted_axes([1, 2, 0]).as_standard_layout().into_owned()
}

/// Sets the hardness, and the cap on the pressure that remains with the shear of sliding bodies.
pub(super) fn set_caps(file: &mut FieldFile, hardness: Pascal, friction: Option<&Friction>) {
    file.set("hardness", hardness);
    file.set("cap", friction.map_or(hardness, |friction| friction.sliding_cap(hardness)));
}

/// Adds the bodies: heights, and the state of laws, whose names are in an attribute.
pub(crate) fn add_bodies(file: &mut FieldFile, pair: &Pair) {
    let grids = [pair.lower_grid(), pair.upper_grid()];
    for ((name, body), grid) in BODIES.into_iter().zip([&pair.lower, &pair.upper]).zip(grids) {
        file.add_field(name, "m", &grid, [0.0, 0.0], &body.heights);
        if let CellValues::Field(hardness) = &body.hardness {
            file.add_field(&state_name("hardness", name), "Pa", &grid, [0.0, 0.0], hardness);
        }
        for (state, State { unit, values }) in &body.state {
            file.add_field(&state_name(state, name), unit, &grid, [0.0, 0.0], values);
        }
        if !body.state.is_empty() {
            let names: Vec<&str> = body.state.keys().map(String::as_str).collect();
            file.set(&states_attribute(name), names.join(",").as_str());
        }
    }
}
