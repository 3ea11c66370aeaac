//! The measure by which every answer is judged.

use crate::grid::Field;
use crate::solver::{Problem, Terms};
use crate::units::{Metre, Pascal};

/// How far a pressure is from equilibrium.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual {
    /// η = max|φ| / scale.
    pub eta: f64,
    /// The approach δ at which φ was taken.
    pub approach: Metre,
    /// The scale: std(u), but no less than 10⁻⁴ of the largest |u| or c₀ p, where the displacement is uniform.
    pub scale: Metre,
}

/// Scale-free complementarity residual η of a `pressure` and its `displacement` u = C p.
///
/// ```text
/// φ = c₀ (p − clip(p + w/c₀, 0, H)),   w = δ − h − u,   η = max|φ| / max(std(u), 10⁻⁴ max|u|, 10⁻⁴ c₀ max p)
/// ```
///
/// c₀ is the displacement of a cell per unit pressure on itself. φ is zero exactly in equilibrium. Without an
/// `approach` (load control) δ is the multiplier of the load: the mean of h + u over the cells with 0 < p < H,
/// weighted by the pressure.
pub fn residual(
    pressure: &Field,
    displacement: &Field,
    initial_gap: &Field,
    hardness: Pascal,
    self_influence: f64,
    approach: Option<Metre>,
) -> Residual {
    let caps = || std::iter::repeat(hardness);
    residual_under(caps, pressure, displacement, initial_gap, self_influence, approach)
}

/// The [`residual`] where each cell has its own cap.
pub(super) fn residual_under<I: Iterator<Item = Pascal>>(
    caps: impl Fn() -> I,
    pressure: &Field,
    displacement: &Field,
    initial_gap: &Field,
    self_influence: f64,
    approach: Option<Metre>,
) -> Residual {
    let cells = || {
        let cells = pressure.iter().zip(displacement).zip(initial_gap).zip(caps());
        cells.map(|(((p, u), h), cap)| Cell { pressure: *p, displacement: *u, touch: h + u, cap })
    };
    let approach = approach.unwrap_or_else(|| Multiplier::of(cells()).approach());
    Tally::of(cells(), approach, self_influence).residual(approach, self_influence)
}

/// What a residual is a share of, for displacements of this deviation, of which the largest, and the largest that a cell makes
/// by itself, are of that size.
pub(super) fn scale(deviation: Metre, size: Metre) -> Metre {
    if deviation < UNIFORM * size { UNIFORM * size } else { deviation }
}

/// Displacements that deviate by less than this share of their size are uniform: under flat bodies, and in full contact. What
/// they deviate by may then be round-off, 10⁻¹⁵ of their size in double precision and 10⁻⁷ in single.
const UNIFORM: f64 = 1e-4;

/// What the residual asks of a cell.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    pub(super) pressure: Pascal,
    pub(super) displacement: Metre,
    /// h + u: the approach at which it touches.
    pub(super) touch: Metre,
    /// The most pressure that it bears.
    pub(super) cap: Pascal,
}

impl Problem<'_> {
    /// The [`residual`] of a pressure and its displacement in this problem.
    pub(super) fn residual(&self, pressure: &Field, displacement: &Field) -> Residual {
        let Terms { hardness, self_influence, control, .. } = self.terms;
        residual(pressure, displacement, self.initial_gap, hardness, self_influence, control.approach())
    }
}

/// The approach that belongs to a pressure under load control, from the approaches h + u at which the cells touch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Multiplier {
    weight: f64,
    moment: f64,
    deepest: Metre,
}

impl Multiplier {
    pub(super) fn of(cells: impl Iterator<Item = Cell>) -> Self {
        let mut this = Self { weight: 0.0, moment: 0.0, deepest: f64::NEG_INFINITY };
        for Cell { pressure: p, touch, cap, .. } in cells {
            if 0.0 < p && p < cap {
                this.weight += p;
                this.moment += p * touch;
            } else if p >= cap {
                this.deepest = this.deepest.max(touch);
            }
        }
        this
    }

    /// Of the cells of both.
    pub(super) fn and(self, other: Self) -> Self {
        Self {
            weight: self.weight + other.weight,
            moment: self.moment + other.moment,
            deepest: self.deepest.max(other.deepest),
        }
    }

    /// All cells at a bound: any approach between the capped and the open cells is in equilibrium; the least.
    pub(super) fn approach(&self) -> Metre {
        if self.weight > 0.0 { self.moment / self.weight } else { self.deepest }
    }
}

/// What φ and the displacement of some cells come to.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Tally {
    /// Largest |φ|.
    largest: Metre,
    max_pressure: Pascal,
    max_displacement: Metre,
    cells: f64,
    /// Mean displacement, and the sum of the squares of its deviations.
    mean: Metre,
    squares: f64,
}

impl Tally {
    /// At an approach.
    pub(super) fn of(cells: impl Iterator<Item = Cell>, approach: Metre, self_influence: f64) -> Self {
        let mut this = Self::default();
        // Deviations from some displacement rather than from zero: nothing cancels.
        let (mut datum, mut sum, mut squares) = (None, 0.0, 0.0);
        for Cell { pressure: p, displacement: u, touch, cap } in cells {
            let w = approach - touch;
            let phi = self_influence * (p - (p + w / self_influence).clamp(0.0, cap));
            this.largest = this.largest.max(phi.abs());
            this.max_pressure = this.max_pressure.max(p.abs());
            this.max_displacement = this.max_displacement.max(u.abs());
            this.cells += 1.0;
            let deviation = u - *datum.get_or_insert(u);
            sum += deviation;
            squares += deviation * deviation;
        }
        let mean = sum / this.cells;
        Self { mean: datum.unwrap_or(0.0) + mean, squares: squares - sum * mean, ..this }
    }

    /// Of the cells of both.
    pub(super) fn and(self, other: Self) -> Self {
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

    /// Their residual at that approach.
    pub(super) fn residual(&self, approach: Metre, self_influence: f64) -> Residual {
        let deviation = (self.squares.max(0.0) / self.cells).sqrt();
        let local = self_influence * self.max_pressure;
        let scale = scale(deviation, local.max(self.max_displacement));
        // What is not a number is no answer, though a maximum would pass over it.
        let eta = if self.largest == 0.0 && !self.squares.is_nan() { 0.0 } else { self.largest / scale };
        Residual { eta, approach, scale }
    }
}
