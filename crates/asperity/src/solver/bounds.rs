//! The feasible pressures: 0 ≤ p ≤ H, and under load Σ p given.

use crate::grid::Field;
use crate::math::sum::sums;
use crate::solver::Problem;

/// Relative error of the load of a feasible pressure.
const LOAD_ACCURACY: f64 = 1e-11;
/// Relative error of a sum of pressures that is as good as none: above the rounding of millions of terms.
const SUM_ACCURACY: f64 = 1e-13;

impl Problem<'_> {
    /// Whether `pressure` is inside the bounds and, under load control, bears the load.
    pub(super) fn is_feasible(&self, pressure: &Field) -> bool {
        pressure.iter().all(|p| (0.0..=self.hardness).contains(p))
            && self
                .pressure_sum()
                .is_none_or(|wanted| (pressure.sum() - wanted).abs() <= LOAD_ACCURACY * wanted)
    }

    /// Brings `pressure` into the bounds and, under load control, to the load: first by scaling the cells between
    /// the bounds, and where these cannot bear it, by a uniform shift.
    pub(super) fn make_feasible(&self, pressure: &mut Field) {
        let hardness = self.hardness;
        pressure.mapv_inplace(|p| p.clamp(0.0, hardness));
        let Some(wanted) = self.pressure_sum() else { return };
        for _ in 0..60 {
            let cells = pressure.as_slice().expect("standard layout");
            let [sum, between] = sums(cells, |p| [p, if p < hardness { p } else { 0.0 }]);
            if (sum - wanted).abs() <= SUM_ACCURACY * wanted {
                return;
            }
            if between <= 0.0 || between <= 0.5 * (sum - wanted) {
                break;
            }
            let factor = 1.0 + (wanted - sum) / between;
            pressure.mapv_inplace(|p| if p < hardness { (p * factor).clamp(0.0, hardness) } else { p });
        }
        let shift = shift_for_sum(pressure.as_slice().expect("standard layout"), hardness, wanted);
        pressure.mapv_inplace(|p| (p + shift).clamp(0.0, hardness));
    }
}

/// The c at which Σ clip(y + c, 0, H) is `wanted`, for 0 ≤ `wanted` ≤ n H: the Euclidean projection onto the bounds and
/// the sum.
///
/// The sum grows piecewise linearly with c: bracketed Newton iteration, exact to round-off in a few passes.
pub(super) fn shift_for_sum<T: Copy + Into<f64>>(values: &[T], hardness: f64, wanted: f64) -> f64 {
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for y in values {
        (least, most) = (least.min((*y).into()), most.max((*y).into()));
    }
    let (mut low, mut high) = (-most, wanted / values.len() as f64 - least);
    let mut shift = high.min(0.0).max(low);
    for _ in 0..200 {
        let [sum, between] = sums(values, |y| {
            let p = (y.into() + shift).clamp(0.0, hardness);
            [p, if 0.0 < p && p < hardness { 1.0 } else { 0.0 }]
        });
        let excess = sum - wanted;
        if excess.abs() <= SUM_ACCURACY * wanted {
            break;
        }
        if excess < 0.0 {
            low = shift;
        } else {
            high = shift;
        }
        let newton = shift - excess / between;
        let next = if low < newton && newton < high { newton } else { 0.5 * (low + high) };
        if next <= low || next >= high {
            break;
        }
        shift = next;
    }
    shift
}
