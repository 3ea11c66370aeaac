//! Feasible pressures: within their bounds, and with a given sum under load control.

use std::convert::Infallible;

use asperity_base::math::active_set::{self, MAX_SCALINGS};

use crate::grid::{CellValues, Field};
use crate::math::extremes;
use crate::math::sum::sums;
use crate::ranks::Merged;
use crate::solver::Settings;
use crate::solver::bounds::{Bounds, Interval, with_bounds};
use crate::units::Pascal;

/// Relative error of the load of a feasible pressure.
const LOAD_ACCURACY: f64 = 1e-11;
/// Relative tolerance of a sum of pressures, above the rounding of millions of terms.
const SUM_ACCURACY: f64 = 1e-13;

/// Pressures with bounds that are summed and changed together.
pub(super) trait Cells {
    /// Returns the sums over the cells of `terms` of each pressure and its bounds.
    fn sum<const N: usize>(&mut self, terms: impl Fn(Pascal, Interval) -> [f64; N] + Sync + Send)
    -> [f64; N];

    /// Replaces each pressure by a function of it and its bounds.
    fn map(&mut self, change: impl Fn(Pascal, Interval) -> Pascal + Sync + Send);

    /// Returns the range of the pressures and of their bounds.
    fn range(&mut self) -> Range;
}

/// The pressures of one contact.
pub(super) struct Bounded<'a> {
    pub(super) pressure: &'a mut Field,
    pub(super) bounds: &'a Bounds,
}

impl Cells for Bounded<'_> {
    fn sum<const N: usize>(
        &mut self,
        terms: impl Fn(Pascal, Interval) -> [f64; N] + Sync + Send,
    ) -> [f64; N] {
        sum_within(self.pressure.as_slice().expect("standard layout"), 0, self.bounds, terms)
    }

    fn map(&mut self, change: impl Fn(Pascal, Interval) -> Pascal + Sync + Send) {
        map_within(self.pressure.as_slice_mut().expect("standard layout"), 0, self.bounds, change);
    }

    fn range(&mut self) -> Range {
        let pressure = self.pressure.as_slice().expect("standard layout");
        Range::new(extremes(pressure), pressure.len(), self.bounds)
    }
}

/// Sums `terms` of each value and the bounds of its cell over some cells, beginning with the flat cell
/// `first` of the grid.
pub(super) fn sum_within<T: Copy, const N: usize>(
    values: &[T],
    first: usize,
    bounds: &Bounds,
    terms: impl Fn(T, Interval) -> [f64; N],
) -> [f64; N] {
    with_bounds!(bounds, of => sums(values, |cell, value| terms(value, of(first + cell))))
}

/// Replaces the pressures of some cells, beginning with the flat cell `first` of the grid, by `change` of
/// each and its bounds.
pub(super) fn map_within(
    pressures: &mut [Pascal],
    first: usize,
    bounds: &Bounds,
    change: impl Fn(Pascal, Interval) -> Pascal,
) {
    with_bounds!(bounds, of => {
        pressures.iter_mut().enumerate().for_each(|(cell, p)| *p = change(*p, of(first + cell)));
    });
}

impl Settings<'_> {
    /// Whether pressures with this sum carry the prescribed load, if there is one.
    pub(super) fn carries_the_load(&self, sum: f64) -> bool {
        self.pressure_sum()
            .is_none_or(|wanted| (sum - wanted).abs() <= LOAD_ACCURACY * self.sum_scale(wanted))
    }

    /// Returns the tolerance of a pressure sum.
    pub(super) fn sum_accuracy(&self, wanted: f64) -> f64 {
        SUM_ACCURACY * self.sum_scale(wanted)
    }

    /// Returns the scale of the tolerance of a pressure sum: the sum itself, and the attraction.
    pub(super) fn sum_scale(&self, wanted: f64) -> f64 {
        wanted.abs() + self.attraction
    }
}

/// Brings pressures into their bounds and, under load control, to the load. It first scales the pressures
/// above the lower bounds of the cells below their upper bounds. If these cells cannot carry the load, it
/// adds the same offset to all cells.
pub(super) fn make_feasible(cells: &mut impl Cells, settings: &Settings) {
    cells.map(|p, bounds| bounds.clamp(p));
    let Some(wanted) = settings.pressure_sum() else { return };
    let accuracy = settings.sum_accuracy(wanted);
    for _ in 0..MAX_SCALINGS {
        let [sum, between] =
            cells.sum(|p, bounds| [p, if p < bounds.upper { p - bounds.lower } else { 0.0 }]);
        if (sum - wanted).abs() <= accuracy {
            return;
        }
        if between <= 0.0 || between <= 0.5 * (sum - wanted) {
            break;
        }
        let factor = 1.0 + (wanted - sum) / between;
        cells.map(|p, bounds| {
            if p < bounds.upper { bounds.clamp(bounds.lower + (p - bounds.lower) * factor) } else { p }
        });
    }
    let range = cells.range();
    let offset =
        offset_for_sum(range, wanted, accuracy, |offset| cells.sum(|p, bounds| within(p + offset, bounds)));
    cells.map(|p, bounds| bounds.clamp(p + offset));
}

/// Returns a pressure clipped to its bounds, and 1 if it lies strictly between them.
pub(super) fn within(pressure: Pascal, bounds: Interval) -> [f64; 2] {
    let p = bounds.clamp(pressure);
    [p, f64::from(u8::from(bounds.is_free(p)))]
}

/// Range of some pressures, their number, and the range of their bounds.
#[derive(Debug, Clone, Copy)]
pub(super) struct Range {
    /// Least pressure.
    min: f64,
    /// Largest pressure.
    max: f64,
    /// Number of pressures.
    count: usize,
    /// Least lower bound.
    min_lower: Pascal,
    /// A pressure that reaches any possible sum if every cell has it: the largest finite upper bound if the
    /// upper bounds differ.
    max_upper: Option<Pascal>,
}

impl Range {
    /// Creates the range of `count` pressures between the given `extremes`.
    pub(super) fn new([min, max]: [Pascal; 2], count: usize, bounds: &Bounds) -> Self {
        let max_upper = match bounds.upper() {
            CellValues::Uniform(_) => None,
            CellValues::Field(upper) => {
                Some(upper.iter().copied().filter(|upper| upper.is_finite()).fold(0.0, f64::max))
            }
        };
        Self { min, max, count, min_lower: bounds.lower().min(), max_upper }
    }

    /// Returns an offset with every value at its lower bound, and an offset with a sum of at least `wanted`.
    fn bracket(&self, wanted: f64) -> [f64; 2] {
        let each = match self.max_upper {
            None => wanted / self.count as f64,
            // A single cell without a bound then carries the whole load, including the attraction of the
            // others.
            Some(upper) => {
                let attraction = self.min_lower.min(0.0).abs() * self.count as f64;
                upper.max(wanted.abs() + attraction)
            }
        };
        [self.min_lower - self.max, each - self.min]
    }
}

/// Returns the common range of several sets of cells.
impl Merged for Range {
    fn and(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
            count: self.count + other.count,
            min_lower: self.min_lower.min(other.min_lower),
            max_upper: match (self.max_upper, other.max_upper) {
                (Some(one), Some(other)) => Some(f64::max(one, other)),
                (one, other) => one.or(other),
            },
        }
    }

    fn numbers(&self) -> Vec<f64> {
        // No upper bound is NaN.
        let max_upper = self.max_upper.unwrap_or(f64::NAN);
        vec![self.min, self.max, self.count as f64, self.min_lower, max_upper]
    }

    fn of_numbers(numbers: &[f64]) -> Self {
        let [min, max, count, min_lower, max_upper] = numbers else {
            unreachable!("as many numbers as are given")
        };
        let max_upper = Some(*max_upper).filter(|upper| !upper.is_nan());
        Self { min: *min, max: *max, count: *count as usize, min_lower: *min_lower, max_upper }
    }
}

/// [`active_set::offset_for_sum`] for values y in the `range` and sums that cannot fail.
pub(super) fn offset_for_sum(
    range: Range,
    wanted: f64,
    accuracy: f64,
    mut sums: impl FnMut(f64) -> [f64; 2],
) -> f64 {
    let sums = |offset| Ok::<_, Infallible>(sums(offset));
    let Ok(offset) = active_set::offset_for_sum(range.bracket(wanted), wanted, accuracy, sums);
    offset
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::Control;
    use crate::solver::active_set::NearCopies;

    fn settings(sum: f64, attraction: f64) -> Settings<'static> {
        Settings {
            control: Control::Load(sum),
            self_influence: 1.0,
            cell_area: 1.0,
            attraction,
            watch: &(),
            near_copies: NearCopies::Large,
        }
    }

    #[test]
    fn the_feasible_pressure_is_within_its_bounds_and_bears_the_load() {
        arbtest::arbtest(|u| {
            if u.is_empty() {
                return Ok(());
            }
            let n = u.int_in_range(1..=40)?;
            let mut number = |from: f64, to: f64| -> arbtest::arbitrary::Result<f64> {
                Ok(from + (to - from) * f64::from(u.int_in_range(0..=1000u32)?) / 1000.0)
            };
            let (uniform, infinite) = (number(0.0, 1.0)? < 0.3, number(0.0, 1.0)? < 0.2);
            let attracts = number(0.0, 1.0)? < 0.5;
            let mut lower = Field::zeros([1, n]);
            let mut upper = Field::zeros([1, n]);
            let mut pressure = Field::zeros([1, n]);
            for cell in 0..n {
                lower[[0, cell]] = if attracts { number(-2.0, 0.0)? } else { 0.0 };
                upper[[0, cell]] =
                    if infinite && number(0.0, 1.0)? < 0.5 { f64::INFINITY } else { number(0.1, 5.0)? };
                pressure[[0, cell]] = number(-3.0, 8.0)?;
            }
            let bounds = if uniform {
                let [first, last] = [&lower, &upper].map(|field| field[[0, 0]]);
                lower.fill(first);
                upper.fill(last);
                Bounds::up_to(last).above(first)
            } else {
                Bounds::up_to(upper.clone()).above(lower.clone())
            };
            let most = if upper.sum().is_finite() { upper.sum() } else { 20.0 };
            let wanted = lower.sum() + number(0.01, 0.99)? * (most - lower.sum());
            let settings = settings(wanted, -lower.sum());
            make_feasible(&mut Bounded { pressure: &mut pressure, bounds: &bounds }, &settings);
            let inside = pressure.iter().zip(&lower).zip(&upper).all(|((p, l), u)| l <= p && p <= u);
            assert!(inside, "{pressure} not in {bounds:?}");
            assert!(
                settings.carries_the_load(pressure.sum()),
                "{wanted}, not {}: {bounds:?}",
                pressure.sum()
            );
            Ok(())
        });
    }
}
