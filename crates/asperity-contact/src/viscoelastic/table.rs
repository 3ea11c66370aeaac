//! Displacement of a body along whose surface a loaded cell moves, where the body is not periodic along the motion.

use crate::grid::Field;
use crate::kernel::Influence;
use crate::math::parallel;
use crate::units::Metre;
use crate::viscoelastic::panels::{Panel, REACH, lagrange_weights};

/// Cells on both sides of the loaded one in which the panels are graded.
const NEAR: isize = 2;
/// Number of halvings of a graded panel.
const HALVINGS: i32 = 20;

/// Computes `Σ J_k (1/λ_k) ∫₀^∞ e^(−ξ/λ_k) f(x + ξ) dξ` of a function f for all cells at the offsets `(i Δx, j Δy)` with
/// −nx < i < nx and 0 ≤ j < ny; the first row is that of i = 1 − nx. The `decays` are pairs of J_k and λ_k > 0.
///
/// Ahead of the grid f is integrated on intervals that double in length. From there a cell adds to the cell before it: its own
/// interval, on which f is a polynomial between Gauss' points, graded to the edges of the loaded cell.
pub(super) fn upstream(
    f: &(dyn Fn(Metre, Metre) -> f64 + Sync),
    [nx, ny]: [usize; 2],
    pitch: [Metre; 2],
    decays: &[[f64; 2]],
) -> Field {
    let dx = pitch[0];
    let row = |x: Metre| (0..ny).map(move |j| f(x, j as f64 * pitch[1]));
    let mut carried = vec![vec![0.0; ny]; decays.len()];
    let farthest = decays.iter().map(|[_, decay]| REACH * decay).fold(0.0, f64::max);
    let far = nx as f64 * dx;
    let (mut begin, mut length) = (0.0, 0.25 * far);
    while begin < farthest {
        add(&mut carried, Panel { begin, end: begin + length }, decays, |t| row(far + t));
        (begin, length) = (begin + length, 2.0 * length);
    }
    let coarse = [Panel { begin: 0.0, end: 0.5 * dx }, Panel { begin: 0.5 * dx, end: dx }];
    let graded = graded(dx);
    let last = nx as isize - 1;
    let rows: Vec<isize> = (-last..=last).collect();
    let weights = |panels: &[Panel]| -> Vec<(Metre, Vec<f64>)> {
        panels.iter().flat_map(|panel| lagrange_weights(*panel, decays)).collect()
    };
    let [coarse, graded] = [weights(&coarse), weights(&graded)];
    let parts = parallel::tasks(rows, |i| {
        let mut part = vec![vec![0.0; ny]; decays.len()];
        for (t, weights) in if i.abs() <= NEAR { &graded } else { &coarse } {
            for (j, value) in row(i as f64 * dx + t).enumerate() {
                part.iter_mut().zip(weights).for_each(|(part, weight)| part[j] += weight * value);
            }
        }
        part
    });
    let mut table = Field::zeros([2 * nx - 1, ny]);
    for (mut into, parts) in table.rows_mut().into_iter().zip(&parts).rev() {
        for (([compliance, decay], carried), part) in decays.iter().zip(&mut carried).zip(parts) {
            let kept = (-dx / decay).exp();
            for ((carried, part), into) in carried.iter_mut().zip(part).zip(into.iter_mut()) {
                *carried = kept * *carried + part;
                *into += compliance * *carried;
            }
        }
    }
    table
}

/// Adds the integral over a panel, `1/λ ∫ e^(−t/λ) f(t) dt`, for each decay.
fn add<R: Iterator<Item = f64>>(
    to: &mut [Vec<f64>],
    panel: Panel,
    decays: &[[f64; 2]],
    row: impl Fn(f64) -> R,
) {
    for (t, weights) in lagrange_weights(panel, decays) {
        for (j, value) in row(t).enumerate() {
            to.iter_mut().zip(&weights).for_each(|(to, weight)| to[j] += weight * value);
        }
    }
}

/// Panels of a cell that are graded to its corners and to its middle, where a table of displacements or slopes has the edges of the
/// loaded cell.
fn graded(dx: Metre) -> Vec<Panel> {
    let quarter: Vec<f64> = (0..=HALVINGS).rev().map(|n| 0.25 * 2f64.powi(-n)).collect();
    let of_half: Vec<f64> = [0.0]
        .into_iter()
        .chain(quarter.iter().copied())
        .chain(quarter.iter().rev().skip(1).map(|t| 0.5 - t))
        .collect();
    let cuts: Vec<f64> =
        of_half.iter().copied().chain(of_half.iter().map(|t| 0.5 + t)).chain([1.0]).collect();
    let panels = cuts.windows(2).filter(|pair| pair[1] > pair[0]);
    panels.map(|pair| Panel { begin: pair[0] * dx, end: pair[1] * dx }).collect()
}

/// Tables of a loaded cell that moves: displacement, and mean slope along x over a cell, at the offsets of [`upstream`].
pub(super) struct MovingCell {
    pub(super) displacement: Field,
    pub(super) slope: Field,
}

impl MovingCell {
    /// Computes the tables of bodies with this elastic `influence` at a unit modulus, the compliance `glassy` and these `decays`.
    pub(super) fn new(
        influence: &dyn Influence,
        shape: [usize; 2],
        pitch: [Metre; 2],
        glassy: f64,
        decays: &[[f64; 2]],
    ) -> Self {
        let [nx, ny] = shape;
        let dx = pitch[0];
        let at = |x: Metre, y: Metre| influence.at(x, y);
        let slope = |x: Metre, y: Metre| (influence.at(x + 0.5 * dx, y) - influence.at(x - 0.5 * dx, y)) / dx;
        // Each value is a sum; the elastic part is that of a decay over no length.
        let table = |f: &(dyn Fn(Metre, Metre) -> f64 + Sync)| {
            let elastic = parallel::field([2 * nx - 1, ny], |i, j| {
                glassy * f((i as f64 - (nx - 1) as f64) * dx, j as f64 * pitch[1])
            });
            if decays.is_empty() { elastic } else { elastic + upstream(f, shape, pitch, decays) }
        };
        Self { displacement: table(&at), slope: table(&slope) }
    }
}
