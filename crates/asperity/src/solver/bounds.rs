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
    let sum = |c: f64| pressure.iter().map(|p| (p + c).clamp(0.0, hardness)).sum::<f64>();
    let mut low = -pressure.iter().copied().fold(0.0, f64::max);
    let mut high = wanted / pressure.len() as f64;
    while sum(high) < wanted {
        high *= 2.0;
    }
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if sum(middle) < wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    pressure.mapv_inplace(|p| (p + high).clamp(0.0, hardness));
}
