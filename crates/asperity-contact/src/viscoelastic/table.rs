//! Displacement of a body along whose surface a loaded cell moves, where the body is not periodic along the
//! motion.

use crate::grid::Field;
use crate::math::parallel;
use crate::units::Metre;
use crate::viscoelastic::panels::{Panel, REACH, lagrange_weights};

/// Cells on both sides of the loaded one in which the panels are graded.
const NEAR: isize = 2;
/// Number of halvings of a graded panel.
const HALVINGS: i32 = 20;

/// A function of x for a row of cells along y.
type Row<'a> = dyn Fn(Metre) -> Option<Vec<f64>> + Sync + 'a;

/// Computes `Σ J_k (1/λ_k) ∫₀^∞ e^(−ξ/λ_k) f(x + ξ) dξ` of a function f, given for a row of cells along y,
/// for all cells at the offsets `(i Δx, j Δy)` with −nx < i < nx and 0 ≤ j < ny; the first row is that of i =
/// 1 − nx. The `decays` are pairs of J_k and λ_k > 0. f is the sum of two functions, of which the first is
/// not smooth at the edges of the loaded cell.
///
/// Ahead of the grid f is integrated on intervals that double in length. From there a cell adds to the cell
/// before it: its own interval, on which f is a polynomial between Gauss' points, graded to the edges of the
/// loaded cell.
fn upstream([near, far]: [&Row<'_>; 2], [nx, ny]: [usize; 2], dx: Metre, decays: &[[f64; 2]]) -> Field {
    let both = |x: Metre| [near(x), far(x)].into_iter().flatten();
    let mut carried = vec![vec![0.0; ny]; decays.len()];
    let farthest = decays.iter().map(|[_, decay]| REACH * decay).fold(0.0, f64::max);
    let ahead = nx as f64 * dx;
    let (mut begin, mut length) = (0.0, 0.25 * ahead);
    while begin < farthest {
        let panel = Panel { begin, end: begin + length };
        add(&mut carried, &lagrange_weights(panel, decays), |t| both(ahead + t));
        (begin, length) = (begin + length, 2.0 * length);
    }
    let last = nx as isize - 1;
    let rows: Vec<isize> = (-last..=last).collect();
    let weights = |panels: &[Panel]| -> Vec<(Metre, Vec<f64>)> {
        panels.iter().flat_map(|panel| lagrange_weights(*panel, decays)).collect()
    };
    let [smooth, graded] = [weights(&[Panel { begin: 0.0, end: dx }]), weights(&graded(dx))];
    let parts = parallel::tasks(rows, |i| {
        let mut part = vec![vec![0.0; ny]; decays.len()];
        let x = i as f64 * dx;
        add(&mut part, if i.abs() <= NEAR { &graded } else { &smooth }, |t| near(x + t).into_iter());
        add(&mut part, &smooth, |t| far(x + t).into_iter());
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

/// Adds the integrals of functions by the `weights` at each place, one for each decay.
fn add<R: Iterator<Item = Vec<f64>>>(
    to: &mut [Vec<f64>],
    weights: &[(Metre, Vec<f64>)],
    rows: impl Fn(f64) -> R,
) {
    for (t, weights) in weights {
        for row in rows(*t) {
            for (j, value) in row.into_iter().enumerate() {
                to.iter_mut().zip(weights).for_each(|(to, weight)| to[j] += weight * value);
            }
        }
    }
}

/// Panels of a cell that are graded to its corners and to its middle, where a table of displacements or
/// slopes has the edges of the loaded cell.
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

/// Tables of a loaded cell that moves: displacement, and mean slope along x over a cell, at the offsets of
/// [`upstream`].
pub(super) struct MovingCell {
    pub(super) displacement: Field,
    pub(super) slope: Field,
}

impl MovingCell {
    /// Computes the tables of bodies with the `elastic` displacement at a unit modulus, the compliance
    /// `glassy` and these `decays`.
    pub(super) fn new(
        elastic: &ElasticCell<'_>,
        [nx, ny]: [usize; 2],
        dx: Metre,
        glassy: f64,
        decays: &[[f64; 2]],
    ) -> Self {
        let slope = |displacement: &ElasticRow<'_>, x: Metre| {
            let [ahead, behind] = [0.5, -0.5].map(|cells| displacement(x + cells * dx, true));
            Some(ahead?.iter().zip(&behind?).map(|(ahead, behind)| (ahead - behind) / dx).collect())
        };
        // Each value is a sum; the elastic part is that of a decay over no length.
        let table = |[near, far]: [&Row<'_>; 2]| {
            let mut table = Field::zeros([2 * nx - 1, ny]);
            let values = table.as_slice_mut().expect("standard layout");
            parallel::tasks(values.chunks_exact_mut(ny).enumerate(), |(i, row)| {
                let x = (i as f64 - (nx - 1) as f64) * dx;
                for part in [near(x), far(x)].into_iter().flatten() {
                    row.iter_mut().zip(part).for_each(|(value, part)| *value += glassy * part);
                }
            });
            if decays.is_empty() { table } else { table + upstream([near, far], [nx, ny], dx, decays) }
        };
        let ElasticCell { near, far } = elastic;
        Self {
            displacement: table([&|x| near(x, false), &|x| far(x, false)]),
            slope: table([&|x| slope(near, x), &|x| slope(far, x)]),
        }
    }
}

/// Elastic displacement of a row of cells along y at x, or its mean across each cell there; `None` if it is 0
/// everywhere.
type ElasticRow<'a> = dyn Fn(Metre, bool) -> Option<Vec<f64>> + Sync + 'a;

/// Elastic displacement by a loaded cell in two parts.
pub(super) struct ElasticCell<'a> {
    /// The part that is not smooth at its edges.
    pub(super) near: &'a ElasticRow<'a>,
    /// The rest.
    pub(super) far: &'a ElasticRow<'a>,
}
