//! The feasible pressures: 0 ≤ p ≤ H, and under load Σ p given.

use crate::grid::Field;
use crate::solver::Problem;

/// Relative error of the load of a feasible pressure.
const LOAD_ACCURACY: f64 = 1e-11;

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
            let (mut sum, mut between) = (0.0, 0.0);
            for &p in pressure.iter() {
                sum += p;
                if 0.0 < p && p < hardness {
                    between += p;
                }
            }
            if (sum - wanted).abs() <= 4.0 * f64::EPSILON * wanted {
                return;
            }
            if between <= 0.0 || between <= 0.5 * (sum - wanted) {
                break;
            }
            let factor = 1.0 + (wanted - sum) / between;
            pressure.mapv_inplace(|p| if p < hardness { (p * factor).clamp(0.0, hardness) } else { p });
        }
        if (pressure.sum() - wanted).abs() > 1e-13 * wanted {
            shift_to_sum(pressure, hardness, wanted);
        }
    }
}

/// Euclidean projection: clip(p + c, 0, H) with the c at which the sum is `wanted`.
fn shift_to_sum(pressure: &mut Field, hardness: f64, wanted: f64) {
    let shift = shift_for_sum(pressure.iter().copied(), hardness, wanted);
    pressure.mapv_inplace(|p| (p + shift).clamp(0.0, hardness));
}

/// The c at which Σ clip(y + c, 0, H) is `wanted`, for 0 ≤ `wanted` ≤ n H.
///
/// The sum grows piecewise linearly with c: bracketed Newton iteration, exact to round-off in a few passes.
pub(super) fn shift_for_sum(values: impl Iterator<Item = f64> + Clone, hardness: f64, wanted: f64) -> f64 {
    let (mut least, mut most, mut count) = (f64::INFINITY, f64::NEG_INFINITY, 0);
    for y in values.clone() {
        (least, most, count) = (least.min(y), most.max(y), count + 1);
    }
    let (mut low, mut high) = (-most, wanted / count as f64 - least);
    let mut shift = high.min(0.0).max(low);
    for _ in 0..200 {
        let (mut sum, mut between) = (0.0, 0usize);
        for y in values.clone() {
            let p = (y + shift).clamp(0.0, hardness);
            sum += p;
            between += usize::from(0.0 < p && p < hardness);
        }
        let excess = sum - wanted;
        if excess.abs() <= 4.0 * f64::EPSILON * wanted {
            break;
        }
        if excess < 0.0 {
            low = shift;
        } else {
            high = shift;
        }
        let newton = shift - excess / between as f64;
        let next = if low < newton && newton < high { newton } else { 0.5 * (low + high) };
        if next <= low || next >= high {
            break;
        }
        shift = next;
    }
    shift
}
