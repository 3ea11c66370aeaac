//! The plastic state of a body that loses material at its surface.

use ndarray::{Array, ArrayView1, Axis, Dimension, RemoveAxis};

use super::body::PlasticState;
use super::{INDEPENDENT, TensorField};
use crate::grid::Field;
use crate::units::Metre;

impl PlasticState {
    /// Returns the state below the new surface of a body that has lost a `depth` of its material, ≥ 0, on the
    /// same layers between `faces`.
    ///
    /// The strain stays with its material, which comes nearer to the surface. Each layer gets the mean strain
    /// of the material that lies in it now. The strain in a layer is linear. Its slope makes no new extremum
    /// (minmod). Below the lowest face the strain is 0. The error of a smooth strain is of second order in the
    /// thickness of the layers, except at its extrema.
    #[must_use]
    pub fn uncovered(&self, faces: &[Metre], depth: &Field) -> Self {
        Self {
            strain: uncovered_tensor(&self.strain, faces, depth),
            accumulated: uncovered(&self.accumulated, faces, depth),
            back_stress: self.back_stress.as_ref().map(|back| uncovered_tensor(back, faces, depth)),
        }
    }
}

/// Moves a deviator up.
fn uncovered_tensor(tensor: &TensorField, faces: &[Metre], depth: &Field) -> TensorField {
    let mut moved = tensor.clone();
    for component in INDEPENDENT {
        let values = tensor.index_axis(Axis(1), component).to_owned();
        moved.index_axis_mut(Axis(1), component).assign(&uncovered(&values, faces, depth));
    }
    let zz = -(&moved.index_axis(Axis(1), 0) + &moved.index_axis(Axis(1), 1));
    let was = tensor.index_axis(Axis(1), 2);
    // Columns that lose nothing keep their bits.
    ndarray::Zip::from(moved.index_axis_mut(Axis(1), 2))
        .and(&was)
        .and(&zz)
        .and_broadcast(depth)
        .for_each(|now, was, zz, depth| *now = if *depth > 0.0 { *zz } else { *was });
    moved
}

/// Moves values up, `[layer, ix, iy]`.
fn uncovered<D: Dimension + RemoveAxis>(
    values: &Array<f64, D>,
    faces: &[Metre],
    depth: &Field,
) -> Array<f64, D> {
    let mut moved = values.clone();
    let columns = values.lanes(Axis(0)).into_iter().zip(moved.lanes_mut(Axis(0)));
    for ((column, mut moved), depth) in columns.zip(depth) {
        if *depth > 0.0 && column.iter().any(|value| *value != 0.0) {
            (0..moved.len()).for_each(|layer| moved[layer] = mean_in(layer, &column, faces, *depth));
        }
    }
    moved
}

/// Mean of the values of a column in what will be a layer once a `depth` of the column has gone.
fn mean_in(layer: usize, column: &ArrayView1<'_, f64>, faces: &[Metre], depth: Metre) -> f64 {
    let [from, to] = [faces[layer] + depth, faces[layer + 1] + depth];
    let mut sum = 0.0;
    for below in layer..column.len() {
        let [top, bottom] = [faces[below].max(from), faces[below + 1].min(to)];
        if bottom > top {
            let centre = 0.5 * (faces[below] + faces[below + 1]);
            let at = 0.5 * (top + bottom) - centre;
            sum += (bottom - top) * (column[below] + slope(below, column, faces) * at);
        }
    }
    sum / (to - from)
}

/// Slope of the values in a layer: the smaller one of those to its neighbours, if they have one sign, and 0
/// in the first and in the last layer.
fn slope(layer: usize, column: &ArrayView1<'_, f64>, faces: &[Metre]) -> f64 {
    if layer == 0 || layer + 1 == column.len() {
        return 0.0;
    }
    let to = |next: usize| 2.0 * (column[next + 1] - column[next]) / (faces[next + 2] - faces[next]);
    let [above, below] = [to(layer - 1), to(layer)];
    if above * below <= 0.0 {
        0.0
    } else if above.abs() < below.abs() {
        above
    } else {
        below
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plasticity::{Layers, VolumeField};

    fn state(layers: usize, strain: impl Fn(usize, usize, usize, usize) -> f64) -> PlasticState {
        let strain =
            TensorField::from_shape_fn((layers, 6, 2, 3), |(layer, component, ix, iy)| match component {
                2 => -(strain(layer, 0, ix, iy) + strain(layer, 1, ix, iy)),
                _ => strain(layer, component, ix, iy),
            });
        let accumulated = strain.index_axis(Axis(1), 4).mapv(f64::abs);
        PlasticState { back_stress: Some(&strain * 2.0), accumulated, strain }
    }

    #[test]
    fn strain_comes_up_by_whole_layers_and_is_kept_where_nothing_goes() {
        let faces = [0.0, 1.0, 2.0, 3.0, 4.0];
        let before = state(4, |layer, component, ix, iy| {
            ((7 * layer + 3 * component + 2 * ix + iy) % 11) as f64 - 5.0
        });
        let depth = Field::from_shape_fn([2, 3], |(ix, iy)| if ix == 1 && iy == 2 { 2.0 } else { 0.0 });
        let after = before.uncovered(&faces, &depth);
        for ((layer, component, ix, iy), now) in after.strain.indexed_iter() {
            let expected = match (ix, iy, layer) {
                (1, 2, 0 | 1) => before.strain[[layer + 2, component, ix, iy]],
                (1, 2, _) => 0.0,
                _ => before.strain[[layer, component, ix, iy]],
            };
            assert_eq!(now.abs(), expected.abs(), "{layer} {component} {ix} {iy}");
            assert!((now - expected).abs() < 1e-15);
        }
        assert_eq!(after.back_stress.unwrap(), &after.strain * 2.0);
        assert_eq!(after.accumulated[[1, 1, 2]], before.accumulated[[3, 1, 2]]);
    }

    #[test]
    fn what_goes_is_what_lay_above_and_no_volume_changes() {
        let layers = Layers::new(10.0, 8, 1.2).unwrap();
        let faces = layers.faces();
        let before =
            state(8, |layer, component, ix, iy| ((13 * layer + 5 * component + ix + iy) as f64).sin());
        let after = before.uncovered(faces, &Field::from_elem([2, 3], 0.4 * layers.thickness(0)));
        let sum = |strain: &TensorField, component: usize| {
            (0..8).map(|layer| layers.thickness(layer) * strain[[layer, component, 1, 1]]).sum::<f64>()
        };
        for component in 0..6 {
            let gone = 0.4 * layers.thickness(0) * before.strain[[0, component, 1, 1]];
            let found = sum(&before.strain, component) - sum(&after.strain, component);
            assert!((found - gone).abs() < 1e-12, "{component}: {found} {gone}");
        }
        for layer in 0..8 {
            let trace: f64 = (0..3).map(|c| after.strain[[layer, c, 1, 1]]).sum();
            assert!(trace.abs() < 1e-15);
            assert!(after.accumulated[[layer, 1, 1]] >= 0.0);
        }
    }

    /// A smooth strain worn off in twenty steps, beside itself moved up at once.
    #[test]
    fn many_small_depths_move_a_smooth_strain_with_more_than_first_order() {
        let error = |count: usize| {
            let layers = Layers::new(10.0, count, 1.0).unwrap();
            let profile = |z: f64| (-(z - 5.0).powi(2) / 2.0).exp();
            let values =
                VolumeField::from_shape_fn((count, 1, 1), |(layer, ..)| profile(layers.centre(layer)));
            let depth = Field::from_elem([1, 1], 0.1);
            let moved = (0..20).fold(values, |values, _| uncovered(&values, layers.faces(), &depth));
            let at = |layer: usize| (moved[[layer, 0, 0]] - profile(layers.centre(layer) + 2.0)).abs();
            (0..count).map(|layer| layers.thickness(layer) * at(layer)).sum::<f64>()
        };
        let [coarse, fine, finer] = [25, 50, 100].map(error);
        assert!(coarse / fine > 2.6 && fine / finer > 2.6, "{coarse:e} {fine:e} {finer:e}");
    }
}
