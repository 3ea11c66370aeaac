//! Interpolation by cubic splines.

use ndarray::{Axis, Zip, s};

use asperity_base::grid::Field;

/// Computes the slopes, per sample, of the cubic spline through the samples of each line along `axis`.
///
/// The equation is dᵢ₋₁ + 4dᵢ + dᵢ₊₁ = 3(zᵢ₊₁ − zᵢ₋₁). The slope at an end is that of the cubic through the
/// last four samples, or of the polynomial through all if there are fewer. The spline is therefore of fourth
/// order up to the boundary. De Boor, A Practical Guide to Splines (1978), ch. IV.
pub(super) fn slopes(field: &Field, axis: Axis) -> Field {
    /// Coefficients of the one-sided derivative at the end, from one to four samples.
    const ENDS: [&[f64]; 4] =
        [&[0.0], &[-1.0, 1.0], &[-1.5, 2.0, -0.5], &[-11.0 / 6.0, 3.0, -1.5, 1.0 / 3.0]];
    // Line by line along x; the other axis is transposed and back.
    if axis == Axis(1) {
        return slopes(&transposed(field), Axis(0)).reversed_axes().as_standard_layout().into_owned();
    }
    let n = field.nrows();
    let end = ENDS[n.min(4) - 1];
    let mut slopes = Field::zeros(field.dim());
    for (k, &weight) in end.iter().enumerate() {
        slopes.row_mut(0).scaled_add(weight, &field.row(k));
    }
    if n > 1 {
        for (k, &weight) in end.iter().enumerate() {
            slopes.row_mut(n - 1).scaled_add(-weight, &field.row(n - 1 - k));
        }
    }
    // The tridiagonal system: forward, then backward.
    let inner = 1..n.max(2) - 1;
    let mut ratio = vec![0.0; n];
    for i in inner.clone() {
        ratio[i] = 1.0 / (4.0 - ratio[i - 1]);
        let (before, mut here) = slopes.multi_slice_mut((s![i - 1, ..], s![i, ..]));
        Zip::from(&mut here)
            .and(&before)
            .and(field.row(i - 1))
            .and(field.row(i + 1))
            .for_each(|d, before, low, high| *d = (3.0 * (high - low) - before) * ratio[i]);
    }
    for i in inner.rev() {
        let (mut here, after) = slopes.multi_slice_mut((s![i, ..], s![i + 1, ..]));
        Zip::from(&mut here).and(&after).for_each(|d, after| *d -= ratio[i] * after);
    }
    slopes
}

fn transposed(field: &Field) -> Field {
    field.t().as_standard_layout().into_owned()
}

/// Weights of the samples below and above, and of the slopes there, at the fraction `t` of the distance
/// between them.
pub(super) fn hermite(t: f64) -> [f64; 4] {
    let u = 1.0 - t;
    [u * u * (1.0 + 2.0 * t), t * t * (1.0 + 2.0 * u), t * u * u, -t * t * u]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_its_own_spline_in_either_direction() {
        for n in [1, 2, 3, 4, 5, 9] {
            let degree = n.min(4) as i32 - 1;
            let height = |x: f64| (0..=degree).map(|k| 0.3 * (x - 2.0).powi(k)).sum::<f64>();
            let slope =
                |x: f64| (1..=degree).map(|k| 0.3 * f64::from(k) * (x - 2.0).powi(k - 1)).sum::<f64>();
            let along_x = Field::from_shape_fn([n, 3], |(i, j)| height(i as f64) + j as f64);
            for (axis, field) in [(Axis(0), along_x.clone()), (Axis(1), transposed(&along_x))] {
                for (at, d) in slopes(&field, axis).indexed_iter() {
                    let i = if axis == Axis(0) { at.0 } else { at.1 };
                    assert!((d - slope(i as f64)).abs() < 1e-12, "{n} samples at {i}");
                }
            }
        }
        let [z0, z1, d0, d1] = hermite(0.3);
        let (cubic, slope) = (|x: f64| x * x * x - x, |x: f64| 3.0 * x * x - 1.0);
        let between = z0 * cubic(1.0) + z1 * cubic(2.0) + d0 * slope(1.0) + d1 * slope(2.0);
        assert!((between - cubic(1.3)).abs() < 1e-14);
    }
}
