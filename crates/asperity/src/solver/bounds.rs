//! The feasible pressures: 0 ≤ p ≤ H, and under load Σ p given.

use crate::grid::Field;
use crate::math::sum::sums;
use crate::solver::Terms;
use crate::units::Pascal;

/// Relative error of the load of a feasible pressure.
const LOAD_ACCURACY: f64 = 1e-11;
/// Relative error of a sum of pressures that is as good as none: above the rounding of millions of terms.
const SUM_ACCURACY: f64 = 1e-13;

/// Pressures that are summed and changed all together.
pub(super) trait Cells {
    /// The sums of what `terms` makes of each pressure.
    fn sum<const N: usize>(&mut self, terms: impl Fn(Pascal) -> [f64; N] + Sync) -> [f64; N];

    /// Changes each pressure.
    fn map(&mut self, change: impl Fn(Pascal) -> Pascal + Sync);

    /// Their range.
    fn range(&mut self) -> Range;
}

impl Cells for Field {
    fn sum<const N: usize>(&mut self, terms: impl Fn(Pascal) -> [f64; N] + Sync) -> [f64; N] {
        sums(self.as_slice().expect("standard layout"), terms)
    }

    fn map(&mut self, change: impl Fn(Pascal) -> Pascal + Sync) {
        self.mapv_inplace(change);
    }

    fn range(&mut self) -> Range {
        Range::of(self.as_slice().expect("standard layout"))
    }
}

impl Terms {
    /// Whether pressures of this sum bear the load, if one is prescribed.
    pub(super) fn bears_the_load(&self, sum: f64) -> bool {
        self.pressure_sum().is_none_or(|wanted| (sum - wanted).abs() <= LOAD_ACCURACY * wanted)
    }
}

/// Brings pressures into their bounds and, under load control, to the load: first by scaling the cells between the
/// bounds, and where these cannot bear it, by a uniform shift.
pub(super) fn make_feasible(cells: &mut impl Cells, terms: &Terms) {
    let hardness = terms.hardness;
    cells.map(|p| p.clamp(0.0, hardness));
    let Some(wanted) = terms.pressure_sum() else { return };
    for _ in 0..60 {
        let [sum, between] = cells.sum(|p| [p, if p < hardness { p } else { 0.0 }]);
        if (sum - wanted).abs() <= SUM_ACCURACY * wanted {
            return;
        }
        if between <= 0.0 || between <= 0.5 * (sum - wanted) {
            break;
        }
        let factor = 1.0 + (wanted - sum) / between;
        cells.map(|p| if p < hardness { (p * factor).clamp(0.0, hardness) } else { p });
    }
    let range = cells.range();
    let shift = shift_for_sum(range, wanted, |shift| cells.sum(|p| in_bounds(p + shift, hardness)));
    cells.map(|p| (p + shift).clamp(0.0, hardness));
}

/// A pressure brought into its bounds, and 1 where it is between them.
pub(super) fn in_bounds(pressure: Pascal, hardness: Pascal) -> [f64; 2] {
    let p = pressure.clamp(0.0, hardness);
    [p, if 0.0 < p && p < hardness { 1.0 } else { 0.0 }]
}

/// The least and the largest of some values, and their number.
#[derive(Debug, Clone, Copy)]
pub(super) struct Range {
    least: f64,
    most: f64,
    count: usize,
}

impl Range {
    pub(super) fn of<T: Copy + Into<f64>>(values: &[T]) -> Self {
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for y in values {
            (least, most) = (least.min((*y).into()), most.max((*y).into()));
        }
        Self { least, most, count: values.len() }
    }

    /// The range of both.
    pub(super) fn and(self, other: Self) -> Self {
        Self {
            least: self.least.min(other.least),
            most: self.most.max(other.most),
            count: self.count + other.count,
        }
    }
}

/// The c at which Σ clip(y + c, 0, H) is `wanted`, for 0 ≤ `wanted` ≤ n H, over values y in the `range`: the Euclidean
/// projection onto the bounds and the sum. `sums` gives that sum, and how many of the values are between the bounds.
///
/// The sum grows piecewise linearly with c: bracketed Newton iteration, exact to round-off in a few passes.
pub(super) fn shift_for_sum(range: Range, wanted: f64, mut sums: impl FnMut(f64) -> [f64; 2]) -> f64 {
    let (mut low, mut high) = (-range.most, wanted / range.count as f64 - range.least);
    let mut shift = high.min(0.0).max(low);
    for _ in 0..200 {
        let [sum, between] = sums(shift);
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
