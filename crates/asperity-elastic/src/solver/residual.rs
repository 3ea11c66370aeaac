//! The complementarity residual η, the measure of every solution.

use asperity_base::math::active_set::residual_scale;

use crate::grid::{Field, flat, in_rows};
use crate::math::sum::sums;
use crate::ranks::Merged;
use crate::solver::bounds::{Bounds, Interval, with_bounds};
use crate::solver::{Problem, Settings};
use crate::units::{Metre, Pascal};

/// Distance of a pressure from equilibrium.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Residual {
    /// The residual η = max|φ| / scale.
    pub eta: f64,
    /// The approach δ in φ.
    pub approach: Metre,
    /// The scale: std(u), but at least 10⁻⁴ of the largest |u| or c₀ p, for uniform displacements.
    pub scale: Metre,
}

/// Computes the scale-free complementarity residual η of a `pressure` within its `bounds` and its
/// `displacement` u = C p.
///
/// ```text
/// φ = c₀ (p − clip(p + w/c₀)),   w = δ − h − u,   η = max|φ| / max(std(u), 10⁻⁴ max|u|, 10⁻⁴ c₀ max p)
/// ```
///
/// clip restricts a pressure to the bounds of its cell. c₀ is the displacement of a cell per unit pressure on
/// itself. φ is zero exactly in equilibrium. Without an `approach` (load control) δ is the multiplier of the
/// load: the mean of h + u over the cells between their bounds, weighted by the pressure above the lower
/// bound.
///
/// # Panics
/// If a field has another shape than the others.
pub fn residual(
    pressure: &Field,
    displacement: &Field,
    initial_gap: &Field,
    bounds: &Bounds,
    self_influence: f64,
    approach: Option<Metre>,
) -> Residual {
    with_bounds!(bounds, of => {
        let cells = pressure.iter().zip(displacement).zip(initial_gap).enumerate();
        let cells = cells.map(|(cell, ((p, u), h))| Cell {
            pressure: *p,
            displacement: *u,
            touch: h + u,
            bounds: of(cell),
        });
        let approach = approach.unwrap_or_else(|| {
            let [pressure, displacement, gap] = [pressure, displacement, initial_gap].map(in_rows);
            let [pressure, displacement, gap] = [&pressure, &displacement, &gap].map(|field| flat(field));
            Multiplier::new(pressure, |cell| gap[cell] + displacement[cell], of).approach()
        });
        ResidualSums::new(cells, approach, self_influence).residual(approach, self_influence)
    })
}

/// The state of a cell that determines its residual.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    /// The pressure p.
    pub(super) pressure: Pascal,
    /// The displacement u.
    pub(super) displacement: Metre,
    /// The approach h + u at which the cell touches.
    pub(super) touch: Metre,
    /// The bounds of the pressure.
    pub(super) bounds: Interval,
}

impl Problem<'_> {
    /// Computes the [`residual`] of a pressure and its displacement in this problem.
    pub(super) fn residual(&self, pressure: &Field, displacement: &Field) -> Residual {
        let Settings { self_influence, control, .. } = self.settings;
        residual(pressure, displacement, self.initial_gap, self.bounds, self_influence, control.approach())
    }
}

/// The approach for a pressure under load control, from the approaches h + u at which the cells touch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Multiplier {
    /// Sum of the weights, the pressures above the lower bounds.
    weight: f64,
    /// Weighted sum of the approaches h + u.
    moment: f64,
    /// Largest h + u of the capped cells.
    max_capped: Metre,
}

impl Multiplier {
    /// Computes the sums of the cells with these pressures, with functions for their approaches h + u and
    /// their bounds.
    pub(super) fn new(
        pressure: &[Pascal],
        touch: impl Fn(usize) -> Metre,
        bounds: impl Fn(usize) -> Interval,
    ) -> Self {
        let [weight, moment] = sums(pressure, |cell, p| {
            let bounds = bounds(cell);
            let weight = if bounds.is_free(p) { p - bounds.lower } else { 0.0 };
            [weight, weight * touch(cell)]
        });
        let mut max_capped = f64::NEG_INFINITY;
        // The capped cells count only if no cell has a weight.
        if weight == 0.0 {
            let capped = pressure.iter().enumerate().filter(|(cell, p)| **p > bounds(*cell).lower);
            max_capped = capped.fold(max_capped, |most, (cell, _)| most.max(touch(cell)));
        }
        Self { weight, moment, max_capped }
    }

    /// Returns the multiplier. If all cells are at a bound, any approach between those of the capped and of
    /// the open cells is in equilibrium, and the smallest is returned.
    pub(super) fn approach(&self) -> Metre {
        if self.weight > 0.0 { self.moment / self.weight } else { self.max_capped }
    }
}

/// Merges the multipliers of several sets of cells.
impl Merged for Multiplier {
    fn and(self, other: Self) -> Self {
        Self {
            weight: self.weight + other.weight,
            moment: self.moment + other.moment,
            max_capped: self.max_capped.max(other.max_capped),
        }
    }

    fn numbers(&self) -> Vec<f64> {
        vec![self.weight, self.moment, self.max_capped]
    }

    fn of_numbers(numbers: &[f64]) -> Self {
        Self { weight: numbers[0], moment: numbers[1], max_capped: numbers[2] }
    }
}

/// Sums and maxima over some cells that determine their residual. The sums of several contacts can be merged.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ResidualSums {
    /// Largest |φ|.
    largest: Metre,
    /// Largest |p|.
    max_pressure: Pascal,
    /// Largest |u|.
    max_displacement: Metre,
    /// Number of cells.
    cells: f64,
    /// Mean displacement.
    mean: Metre,
    /// Sum of the squares of the deviations from the mean displacement.
    squares: f64,
}

impl ResidualSums {
    /// Computes the sums of some cells at an approach.
    pub(super) fn new(cells: impl Iterator<Item = Cell>, approach: Metre, self_influence: f64) -> Self {
        let mut cells = cells.peekable();
        let datum = cells.peek().map_or(0.0, |cell| cell.displacement);
        let mut lanes = Lanes::new(datum, approach, self_influence);
        cells.for_each(|cell| lanes.add([cell]));
        lanes.sums()
    }

    /// [`Self::new`] for the cells with these pressures, approaches h + u and gaps h, with a function for
    /// their bounds. It is faster.
    pub(super) fn from_fields(
        [pressure, touch, gap]: [&[f64]; 3],
        bounds: impl Fn(usize) -> Interval,
        approach: Metre,
        self_influence: f64,
    ) -> Self {
        let cell = |cell: usize, p: f64, touch: f64, h: f64| Cell {
            pressure: p,
            displacement: touch - h,
            touch,
            bounds: bounds(cell),
        };
        let datum = touch.first().zip(gap.first()).map_or(0.0, |(touch, h)| touch - h);
        let ((p, p_rest), (t, t_rest), (h, h_rest)) = (chunks(pressure), chunks(touch), chunks(gap));
        let mut lanes = Lanes::<LANES>::new(datum, approach, self_influence);
        for (number, ((p, t), h)) in p.iter().zip(t).zip(h).enumerate() {
            lanes.add(std::array::from_fn(|lane| cell(number * LANES + lane, p[lane], t[lane], h[lane])));
        }
        let mut last = Lanes::new(datum, approach, self_influence);
        let first = p.len() * LANES;
        for (number, ((p, t), h)) in p_rest.iter().zip(t_rest).zip(h_rest).enumerate() {
            last.add([cell(first + number, *p, *t, *h)]);
        }
        match (p.is_empty(), p_rest.is_empty()) {
            (_, true) => lanes.sums(),
            (true, _) => last.sums(),
            _ => lanes.sums().and(last.sums()),
        }
    }

    /// Returns the residual of the cells at the approach of the sums.
    pub(super) fn residual(&self, approach: Metre, self_influence: f64) -> Residual {
        let deviation = (self.squares.max(0.0) / self.cells).sqrt();
        let local = self_influence * self.max_pressure;
        let scale = residual_scale(deviation, local.max(self.max_displacement));
        // A NaN is no solution, although a maximum would ignore it.
        let eta = if self.largest == 0.0 && !self.squares.is_nan() { 0.0 } else { self.largest / scale };
        Residual { eta, approach, scale }
    }
}

/// Number of cells whose sums are separate, so that none waits for another.
const LANES: usize = 4;

/// Splits values into groups of [`LANES`], and the rest.
fn chunks(values: &[f64]) -> (&[[f64; LANES]], &[f64]) {
    values.as_chunks()
}

/// Sums and maxima over every Nth cell, each beginning with another cell.
struct Lanes<const N: usize> {
    /// Deviations from one of the displacements, not from zero, avoid cancellation.
    datum: Metre,
    approach: Metre,
    self_influence: f64,
    stiffness: f64,
    largest: [f64; N],
    max_pressure: [f64; N],
    max_displacement: [f64; N],
    sum: [f64; N],
    squares: [f64; N],
    cells: usize,
}

impl<const N: usize> Lanes<N> {
    fn new(datum: Metre, approach: Metre, self_influence: f64) -> Self {
        let zeros = [0.0; N];
        Self {
            datum,
            approach,
            self_influence,
            stiffness: 1.0 / self_influence,
            largest: zeros,
            max_pressure: zeros,
            max_displacement: zeros,
            sum: zeros,
            squares: zeros,
            cells: 0,
        }
    }

    /// Adds one cell to each lane.
    #[inline(always)]
    fn add(&mut self, cells: [Cell; N]) {
        let largest = |of: &mut f64, value: f64| *of = if value > *of { value } else { *of };
        for (lane, Cell { pressure: p, displacement: u, touch, bounds }) in cells.into_iter().enumerate() {
            let w = self.approach - touch;
            let phi = self.self_influence * (p - bounds.clamp(p + w * self.stiffness));
            largest(&mut self.largest[lane], phi.abs());
            largest(&mut self.max_pressure[lane], p.abs());
            largest(&mut self.max_displacement[lane], u.abs());
            let deviation = u - self.datum;
            self.sum[lane] += deviation;
            self.squares[lane] += deviation * deviation;
        }
        self.cells += N;
    }

    /// Returns the sums of all lanes.
    fn sums(self) -> ResidualSums {
        let most = |values: [f64; N]| values.into_iter().fold(0.0, f64::max);
        let (sum, squares) = (self.sum.iter().sum::<f64>(), self.squares.iter().sum::<f64>());
        let cells = self.cells as f64;
        let mean = sum / cells;
        ResidualSums {
            largest: most(self.largest),
            max_pressure: most(self.max_pressure),
            max_displacement: most(self.max_displacement),
            cells,
            mean: self.datum + mean,
            squares: squares - sum * mean,
        }
    }
}

/// Merges the sums of several sets of cells. Variances merge by the distance of their means (Chan, Golub and
/// LeVeque 1979).
impl Merged for ResidualSums {
    fn and(self, other: Self) -> Self {
        let cells = self.cells + other.cells;
        let apart = other.mean - self.mean;
        Self {
            largest: self.largest.max(other.largest),
            max_pressure: self.max_pressure.max(other.max_pressure),
            max_displacement: self.max_displacement.max(other.max_displacement),
            cells,
            mean: self.mean + apart * other.cells / cells,
            squares: self.squares + other.squares + apart * apart * self.cells * other.cells / cells,
        }
    }

    fn numbers(&self) -> Vec<f64> {
        vec![self.largest, self.max_pressure, self.max_displacement, self.cells, self.mean, self.squares]
    }

    fn of_numbers(numbers: &[f64]) -> Self {
        let [largest, max_pressure, max_displacement, cells, mean, squares] = numbers else {
            unreachable!("as many numbers as are given")
        };
        Self {
            largest: *largest,
            max_pressure: *max_pressure,
            max_displacement: *max_displacement,
            cells: *cells,
            mean: *mean,
            squares: *squares,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cells whose displacements are far from zero compared with their differences.
    fn cells(count: usize) -> Vec<Cell> {
        let displacement = |k: usize| 7.0 + 1e-3 * ((k * k) % 17) as f64;
        let cell = |k: usize| Cell {
            pressure: (k % 3) as f64,
            displacement: displacement(k),
            touch: displacement(k) + 0.1 * (k % 5) as f64,
            bounds: Interval { lower: 0.0, upper: 1.5 + (k % 2) as f64 },
        };
        (0..count).map(cell).collect()
    }

    #[test]
    fn sums_of_parts_merge_into_those_of_the_whole() {
        let all = cells(101);
        let (approach, c0) = (7.2, 0.3);
        let sums = |part: &[Cell]| ResidualSums::new(part.iter().copied(), approach, c0);
        let multiplier = |part: &[Cell]| {
            let pressure: Vec<Pascal> = part.iter().map(|cell| cell.pressure).collect();
            Multiplier::new(&pressure, |cell| part[cell].touch, |cell| part[cell].bounds)
        };
        let whole = sums(&all);
        let mean = all.iter().map(|cell| cell.displacement).sum::<f64>() / 101.0;
        let squares: f64 = all.iter().map(|cell| (cell.displacement - mean).powi(2)).sum();
        assert!((whole.mean - mean).abs() < 1e-14 * mean);
        assert!((whole.squares / squares - 1.0).abs() < 1e-9);
        for split in [1, 7, 50, 100] {
            let merged = sums(&all[..split]).and(sums(&all[split..]));
            assert!((merged.squares / squares - 1.0).abs() < 1e-9, "{split}: {merged:?}");
            let [one, other] = [merged, whole].map(|sums| sums.residual(approach, c0));
            assert!((one.eta / other.eta - 1.0).abs() < 1e-9 && (one.scale / other.scale - 1.0).abs() < 1e-9);
            let merged = multiplier(&all[..split]).and(multiplier(&all[split..])).approach();
            assert!((merged / multiplier(&all).approach() - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn the_residual_is_zero_in_equilibrium_at_either_bound_and_between() {
        let bounds = Interval { lower: -1.0, upper: 2.0 };
        let cell = |pressure, touch| Cell { pressure, displacement: touch, touch, bounds };
        let eta = |cells: &[Cell]| ResidualSums::new(cells.iter().copied(), 5.0, 0.5).residual(5.0, 0.5).eta;
        assert_eq!(eta(&[cell(-1.0, 5.5), cell(0.3, 5.0), cell(2.0, 4.0)]), 0.0);
        for wrong in [cell(-1.0, 4.9), cell(0.3, 5.1), cell(2.0, 5.1)] {
            assert!(eta(&[wrong, cell(0.3, 5.0), cell(2.0, 4.0)]) > 0.05, "{}", wrong.touch);
        }
    }
}
