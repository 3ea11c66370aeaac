//! The measure by which every answer is judged.

use crate::grid::Field;
use crate::solver::Problem;
use crate::units::{Metre, Pascal};

/// How far a pressure is from equilibrium.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual {
    /// η = max|φ| / std(u).
    pub eta: f64,
    /// The approach δ at which φ was taken.
    pub approach: Metre,
    /// The scale std(u), or c₀ max p where the displacement is uniform.
    pub scale: Metre,
}

/// Scale-free complementarity residual η of a `pressure` and its `displacement` u = C p.
///
/// ```text
/// φ = c₀ (p − clip(p + w/c₀, 0, H)),   w = δ − h − u,   η = max|φ| / std(u)
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
    let approach = approach.unwrap_or_else(|| multiplier(pressure, displacement, initial_gap, hardness));
    let mut largest = 0.0f64;
    let mut max_pressure = 0.0f64;
    let mean = displacement.sum() / displacement.len() as f64;
    let mut squares = 0.0;
    ndarray::Zip::from(pressure).and(displacement).and(initial_gap).for_each(|p, u, h| {
        let w = approach - h - u;
        let phi = self_influence * (p - (p + w / self_influence).clamp(0.0, hardness));
        largest = largest.max(phi.abs());
        max_pressure = max_pressure.max(p.abs());
        squares += (u - mean) * (u - mean);
    });
    let deviation = (squares / displacement.len() as f64).sqrt();
    let local = self_influence * max_pressure;
    let scale = if deviation <= 1e-12 * local { local } else { deviation };
    // What is not a number is no answer, though a maximum would pass over it.
    let eta = if largest == 0.0 && !deviation.is_nan() { 0.0 } else { largest / scale };
    Residual { eta, approach, scale }
}

impl Problem<'_> {
    /// The [`residual`] of this problem.
    pub(super) fn residual(&self, pressure: &Field, displacement: &Field) -> Residual {
        let approach = match self.control {
            super::Control::Approach(approach) => Some(approach),
            super::Control::Load(_) => None,
        };
        residual(pressure, displacement, self.initial_gap, self.hardness, self.self_influence, approach)
    }
}

/// The approach that belongs to a pressure under load control.
fn multiplier(pressure: &Field, displacement: &Field, initial_gap: &Field, hardness: Pascal) -> Metre {
    let (mut weight, mut moment, mut deepest) = (0.0, 0.0, f64::NEG_INFINITY);
    ndarray::Zip::from(pressure).and(displacement).and(initial_gap).for_each(|&p, u, h| {
        if 0.0 < p && p < hardness {
            weight += p;
            moment += p * (h + u);
        } else if p >= hardness {
            deepest = deepest.max(h + u);
        }
    });
    // All cells at a bound: any approach between the capped and the open cells is in equilibrium; the least.
    if weight > 0.0 { moment / weight } else { deepest }
}
