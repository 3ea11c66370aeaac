//! The passes of a block in an outer step: prediction of the sets, the step to the bounds, and conjugate
//! gradients.

use std::ops;

use super::{Block, NEAR_FIELD, zip};
use crate::grid::{flat, flat_mut};
use crate::math::sum::sums;
use crate::math::{extremes, indices_where, parallel};
use crate::ranks::Merged;
use crate::solver::bounds::{Interval, with_bounds};
use crate::solver::feasible::{Range, within};
use crate::solver::residual::{Multiplier, ResidualSums};
use crate::solver::sets::Set;
use crate::solver::{SINGLE_PRECISION, Settings};
use crate::units::{Metre, Pascal};

/// Norms after conjugate gradients on a set of free cells, as displacements: sums of squares for one contact,
/// their roots for all contacts together.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::solver::active_set) struct ResidualNorms {
    /// Norm of the residual at the free cells.
    pub(in crate::solver::active_set) residual: f64,
    /// Norm of the violations of the bounds.
    pub(in crate::solver::active_set) violation: f64,
    /// Largest residual at the free cells.
    pub(in crate::solver::active_set) max_residual: f64,
    /// The approach of these norms.
    pub(in crate::solver::active_set) datum: Metre,
}

/// Merges the norms of several contacts.
impl Merged for ResidualNorms {
    fn and(self, other: Self) -> Self {
        Self {
            residual: self.residual + other.residual,
            violation: self.violation + other.violation,
            max_residual: self.max_residual.max(other.max_residual),
            datum: self.datum,
        }
    }

    fn numbers(&self) -> Vec<f64> {
        vec![self.residual, self.violation, self.max_residual, self.datum]
    }

    fn of_numbers(numbers: &[f64]) -> Self {
        let [residual, violation, max_residual, datum] = numbers else {
            unreachable!("as many numbers as are given")
        };
        Self { residual: *residual, violation: *violation, max_residual: *max_residual, datum: *datum }
    }
}

impl Block<'_> {
    /// Returns the contribution of this contact to the multiplier of the load.
    pub(in crate::solver::active_set) fn multiplier(&self) -> Multiplier {
        let bounds = self.site.bounds();
        let bands = self.bands.cut(flat(&self.pressure)).zip(self.bands.cut(flat(&self.touch)));
        let parts = parallel::map(bands.enumerate(), |(band, (pressure, touch))| {
            let first = self.bands.first(band);
            let touch = &touch[..pressure.len()];
            with_bounds!(bounds, of => Multiplier::new(pressure, |cell| touch[cell], |cell| of(first + cell)))
        });
        Merged::of_parts(parts)
    }

    /// Returns the sums of this contact for the residual at an approach.
    pub(in crate::solver::active_set) fn residual_sums(
        &self,
        approach: Metre,
        settings: &Settings,
    ) -> ResidualSums {
        let (gap, bounds) = (self.site.initial_gap(), self.site.bounds());
        let self_influence = settings.self_influence;
        let bands = self.bands.cut(flat(&self.pressure)).zip(self.bands.cut(flat(&self.touch)));
        let bands = bands.zip(self.bands.cut(flat(&gap))).enumerate();
        let parts = parallel::map(bands, |(band, ((pressure, touch), gap))| {
            let first = self.bands.first(band);
            with_bounds!(bounds, of => {
                let of = |cell: usize| of(first + cell);
                ResidualSums::from_fields([pressure, touch, gap], of, approach, self_influence)
            })
        });
        Merged::of_parts(parts)
    }

    /// Changes each pressure by the amount that closes its gap on a single cell with this compliance.
    pub(in crate::solver::active_set) fn step_along_gap(&mut self, approach: Metre, compliance: f64) {
        zip(self.bands, &mut self.pressure, &self.touch, |p, touch| *p += (approach - touch) / compliance);
    }

    /// Proposes the pressures p + (δ − h − u)·stiffness after one diagonal Newton step. Returns their range.
    pub(in crate::solver::active_set) fn propose(&mut self, approach: Metre, stiffness: f64) -> Range {
        self.candidates_offset = f64::NEG_INFINITY;
        let bands = self.bands.cut(flat(&self.pressure)).zip(self.bands.cut(flat(&self.touch)));
        let bands = bands.zip(self.bands.cut_mut(flat_mut(&mut self.response)));
        let parts = parallel::map(bands, |((pressure, touch), proposed)| {
            for ((y, p), touch) in proposed.iter_mut().zip(pressure).zip(touch) {
                *y = (p + (approach - touch) * stiffness) as f32;
            }
            extremes(proposed).map(f64::from)
        });
        self.range_of(parts)
    }

    /// Returns the sum of the proposed pressures after an offset and clipping, and the number of cells
    /// strictly between their bounds. The direction, which is not known yet, lists the candidates: proposed
    /// pressures that are above a uniform lower bound after this offset or a smaller one.
    pub(in crate::solver::active_set) fn proposed_sum(&mut self, offset: Pascal) -> [f64; 2] {
        let Some(bounds) = self.site.bounds().uniform() else {
            return self.sum_within(&self.response, |y, bounds| within(f64::from(y) + offset, bounds));
        };
        let (bands, complete) = (self.bands, offset <= self.candidates_offset);
        if !complete {
            self.candidates_offset = offset;
        }
        let least = (bounds.lower - offset) as f32;
        let parts = bands.cut(flat(&self.response)).zip(bands.cut_mut(flat_mut(&mut self.direction)));
        Merged::of_parts(parallel::map(parts.zip(&mut self.candidates), |((proposed, listed), count)| {
            if !complete {
                *count = list_from(least, proposed, listed);
            }
            let [sum, between] = sums(&listed[..*count], |_, y| within(f64::from(y) + offset, bounds));
            [sum + (proposed.len() - *count) as f64 * bounds.lower, between]
        }))
    }

    /// Predicts the sets from the proposed pressures after an offset.
    pub(in crate::solver::active_set) fn predict_sets(
        &mut self,
        approach: Metre,
        stiffness: f64,
        offset: Pascal,
    ) {
        let (pressure, touch) = (flat(&self.pressure), flat(&self.touch));
        let proposed = |cells: ops::Range<usize>| {
            let cells = pressure[cells.clone()].iter().zip(&touch[cells]);
            cells.map(move |(p, touch)| p + (approach - touch) * stiffness + offset)
        };
        self.sets.assign(proposed, &self.site.bounds());
        self.preconditioner.adapt(&self.sets);
    }

    /// Moves the pressures of the cells predicted at a bound to it, and sets the direction by which they
    /// move. Returns the number of these cells, and the sum of the direction.
    pub(in crate::solver::active_set) fn move_to_bounds(&mut self) -> [f64; 2] {
        let (bands, bounds) = (self.bands, self.site.bounds());
        let parts = bands.cut_mut(flat_mut(&mut self.direction)).zip(bands.cut(self.sets.by_cell()));
        let parts = parts.zip(bands.cut_mut(flat_mut(&mut self.pressure))).enumerate();
        Merged::of_parts(parallel::map(parts, |(band, ((direction, sets), pressure))| {
            let first = bands.first(band);
            let mut moving = 0;
            let cells = direction.iter_mut().zip(sets).zip(pressure).enumerate();
            with_bounds!(bounds, of => {
                for (cell, ((d, set), p)) in cells {
                    let Interval { lower, upper } = of(first + cell);
                    let end = match set {
                        Set::Lower => lower,
                        Set::Upper => upper,
                        Set::Free => *p,
                    };
                    let distance = end - *p;
                    moving += usize::from(distance != 0.0);
                    *d = distance as f32;
                    *p = end;
                }
            });
            let [added] = sums(direction, |_, d| [f64::from(d)]);
            [moving as f64, added]
        }))
    }

    /// Predicts the residual of the free cells after the step along the direction, from the near field of its
    /// response. Returns its sum.
    pub(in crate::solver::active_set) fn predict_residual(&mut self, approach: Metre) -> f64 {
        self.convolve_near_field();
        let bands = self.bands;
        let parts = bands.cut(flat(&self.touch)).zip(bands.cut_mut(flat_mut(&mut self.response)));
        let parts = parts.zip(self.sets.in_bands());
        let [sum] = Merged::of_parts(parallel::map(parts, |((touch, predicted), free)| {
            let residual = |cell: usize| approach - touch[cell] - f64::from(predicted[cell]);
            let residuals: Vec<f64> = free.cells().map(residual).collect();
            predicted.fill(0.0);
            free.cells().zip(&residuals).for_each(|(cell, w)| predicted[cell] = *w as f32);
            [residuals.iter().sum()]
        }));
        sum
    }

    /// Computes C·d within [`NEAR_FIELD`] cells of the nonzero cells of d, without a convolution.
    fn convolve_near_field(&mut self) {
        let Self { bands, near_field: near, halo, direction, response, .. } = self;
        let direction = halo.around(flat(direction));
        let ([nx, ny], above) = (halo.shape(), halo.own_rows().start);
        let reach = [near.nrows() - 1, near.ncols() / 2];
        let parts = bands.rows().zip(bands.cut_mut(flat_mut(response)));
        parallel::map(parts, |(rows, response)| {
            response.fill(0.0);
            let rows = above + rows.start..above + rows.end;
            for ix in rows.start.saturating_sub(reach[0])..nx.min(rows.end + reach[0]) {
                let reached = ix.saturating_sub(reach[0]).max(rows.start)..(ix + reach[0] + 1).min(rows.end);
                let from = &direction[ix * ny..][..ny];
                indices_where(from, |d| *d != 0.0).for_each(|iy| {
                    let (first, last) = (iy.saturating_sub(reach[1]), ny.min(iy + reach[1] + 1));
                    for i in reached.clone() {
                        let near = near.row(i.abs_diff(ix)).to_slice().expect("rows are contiguous");
                        let near = &near[first + reach[1] - iy..][..last - first];
                        let row = &mut response[(i - rows.start) * ny..][first..last];
                        add_scaled(row, near, from[iy]);
                    }
                });
            }
        });
    }

    /// Replaces the predicted residual by the preconditioned one, z = M r, without the `mean` of r. Returns
    /// the sums Σ z, Σ r and Σ r z over the free cells.
    pub(in crate::solver::active_set) fn precondition_predicted(&mut self, mean: f64) -> [f64; 3] {
        let parts = self.bands.cut_mut(flat_mut(&mut self.response)).zip(self.sets.in_bands());
        parallel::map(parts, |(r, free)| free.cells().for_each(|cell| r[cell] -= mean as f32));
        self.precondition()
    }

    /// Replaces the residual of the free cells by the preconditioned one, z = M r. Returns the sums Σ z, Σ r
    /// and Σ r z over the free cells.
    pub(in crate::solver::active_set) fn precondition(&mut self) -> [f64; 3] {
        self.preconditioner.replace(&self.sets, flat_mut(&mut self.response))
    }

    /// Sets the direction of the free cells to the damped preconditioned residual without its mean. Returns
    /// the sum of these directions, and the sum of the pressures of the free cells above their lower bounds.
    pub(in crate::solver::active_set) fn direct_free_cells(&mut self, mean: f64, damping: f64) -> [f64; 2] {
        let (damping, mean) = (damping as f32, mean as f32);
        let (bands, bounds) = (self.bands, self.site.bounds());
        let parts = bands.cut(flat(&self.response)).zip(bands.cut(flat(&self.pressure)));
        let parts = parts.zip(bands.cut_mut(flat_mut(&mut self.direction))).zip(self.sets.in_bands());
        Merged::of_parts(parallel::map(parts.enumerate(), |(band, (((z, pressure), direction), free))| {
            let first = bands.first(band);
            let mut sums = [0.0; 2];
            with_bounds!(bounds, of => {
                for cell in free.cells() {
                    let bounds = of(first + cell);
                    let d = damping * (z[cell] - mean);
                    direction[cell] = d;
                    sums = [sums[0] + f64::from(d), sums[1] + bounds.clamp(pressure[cell]) - bounds.lower];
                }
            });
            sums
        }))
    }

    /// Subtracts from the direction of each free cell a uniform part, and a part in proportion to the
    /// pressure above its lower bound, so that the direction preserves the load.
    pub(in crate::solver::active_set) fn balance_direction(&mut self, each: f64, per_pressure: f64) {
        let (bands, bounds) = (self.bands, self.site.bounds());
        let parts = bands.cut(flat(&self.pressure)).zip(bands.cut_mut(flat_mut(&mut self.direction)));
        parallel::map(parts.zip(self.sets.in_bands()).enumerate(), |(band, ((p, direction), free))| {
            let first = bands.first(band);
            with_bounds!(bounds, of => {
                for cell in free.cells() {
                    let borne = of(first + cell).clamp(p[cell]) - of(first + cell).lower;
                    direction[cell] -= (each + per_pressure * borne) as f32;
                }
            });
        });
    }

    /// Moves the pressures of the free cells along the direction. If `convolved`, it also computes the
    /// response.
    pub(in crate::solver::active_set) fn move_free_cells(&mut self, convolved: bool) {
        if convolved {
            self.convolve_direction();
        }
        let bands = self.bands;
        let parts = bands.cut_mut(flat_mut(&mut self.pressure)).zip(bands.cut(flat(&self.direction)));
        parallel::map(parts.zip(self.sets.in_bands()), |((p, d), free)| {
            free.cells().for_each(|cell| p[cell] += f64::from(d[cell]));
        });
    }

    /// Adds the same pressure to all free cells.
    pub(in crate::solver::active_set) fn add_to_free_cells(&mut self, pressure: Pascal) {
        let parts = self.bands.cut_mut(flat_mut(&mut self.pressure)).zip(self.sets.in_bands());
        parallel::map(parts, |(p, free)| free.cells().for_each(|cell| p[cell] += pressure));
    }

    /// Sets the direction to zero. Returns Σ (h + u) of the free cells with a `share` of the response.
    pub(in crate::solver::active_set) fn reset_direction(&mut self, share: f64) -> f64 {
        let bands = self.bands;
        let parts = bands.cut_mut(flat_mut(&mut self.direction)).zip(bands.cut(flat(&self.touch)));
        let parts = parts.zip(bands.cut(flat(&self.response))).zip(self.sets.in_bands());
        let [sum] = Merged::of_parts(parallel::map(parts, |(((direction, touch), response), free)| {
            direction.fill(0.0);
            [free.cells().map(|cell| touch[cell] + share * f64::from(response[cell])).sum()]
        }));
        sum
    }

    /// Updates the direction to the conjugate direction, d = z − mean + β d, and computes C·d. Returns the
    /// curvature dᵀC d of the energy along it, and Σ C·d of the free cells.
    pub(in crate::solver::active_set) fn update_direction(&mut self, mean: f64, beta: f64) -> [f64; 2] {
        let (mean, beta) = (mean as f32, beta as f32);
        let bands = self.bands;
        let parts = bands.cut(flat(&self.response)).zip(bands.cut_mut(flat_mut(&mut self.direction)));
        parallel::map(parts.zip(self.sets.in_bands()), |((z, d), free)| {
            free.cells().for_each(|cell| d[cell] = z[cell] - mean + beta * d[cell]);
        });
        self.convolve_direction();
        let parts = bands.cut(flat(&self.direction)).zip(bands.cut(flat(&self.response)));
        Merged::of_parts(parallel::map(parts.zip(self.sets.in_bands()), |((d, c), free)| {
            let (mut curvature, mut sum) = (0.0, 0.0);
            for cell in free.cells() {
                curvature += f64::from(d[cell]) * f64::from(c[cell]);
                sum += f64::from(c[cell]);
            }
            [curvature, sum]
        }))
    }

    /// Moves pressure and displacement by `step` times the direction. Replaces the response by the residual
    /// of the free cells, whose gap closes at the approach `datum`, and zero for the others. Returns its norm
    /// and the norm of the violations of the bounds.
    pub(in crate::solver::active_set) fn step_along_direction(
        &mut self,
        step: f64,
        datum: Metre,
        settings: &Settings,
    ) -> ResidualNorms {
        let (bands, bounds) = (self.bands, self.site.bounds());
        let parts = bands.cut(self.sets.by_cell()).zip(bands.cut(flat(&self.direction)));
        let parts = parts.zip(bands.cut_mut(flat_mut(&mut self.response)));
        let parts = parts.zip(bands.cut_mut(flat_mut(&mut self.pressure)));
        let parts = parts.zip(bands.cut_mut(flat_mut(&mut self.touch))).enumerate();
        let norms = parallel::map(parts, |(band, ((((sets, d), c), p), touch))| {
            let first = bands.first(band);
            let ((sets, sets_rest), (d, d_rest), (c, c_rest)) =
                (sets.as_chunks(), d.as_chunks(), c.as_chunks_mut());
            let ((p, p_rest), (touch, touch_rest)) = (p.as_chunks_mut(), touch.as_chunks_mut());
            let rest = first + p.len() * LANES;
            let step = Step { step, datum, self_influence: settings.self_influence };
            with_bounds!(bounds, of => {
                let mut lanes = [[0.0; LANES]; 3];
                let chunks = sets.iter().zip(d).zip(c).zip(p).zip(touch).enumerate();
                for (number, ((((sets, d), c), p), touch)) in chunks {
                    let of = |lane: usize| of(first + number * LANES + lane);
                    step.take(*sets, d, c, [p, touch], of, &mut lanes);
                }
                let mut last = [[0.0; 1]; 3];
                let cells = sets_rest.iter().zip(d_rest).zip(c_rest).zip(p_rest).zip(touch_rest);
                for (number, ((((set, d), c), p), touch)) in cells.enumerate() {
                    let [p, touch] = [p, touch].map(std::array::from_mut);
                    let (d, c) = (std::array::from_ref(d), std::array::from_mut(c));
                    step.take([*set], d, c, [p, touch], |_| of(rest + number), &mut last);
                }
                let [residual, violation, _] = [0, 1, 2].map(|n| lanes[n].iter().sum::<f64>() + last[n][0]);
                let max_residual = lanes[2].iter().fold(last[2][0], |most, value| f64::max(most, *value));
                ResidualNorms { residual, violation, max_residual, datum }
            })
        });
        self.rounding += SINGLE_PRECISION * step * self.max_response;
        Merged::of_parts(norms)
    }
}

/// Puts the values from `least` on first in a list, in their order. Returns their number.
fn list_from(least: f32, values: &[f32], list: &mut [f32]) -> usize {
    const TOGETHER: usize = 16;
    let mut count = 0;
    for some in values.chunks(TOGETHER) {
        if some.iter().fold(false, |any, value| any | (*value >= least)) {
            for value in some {
                list[count] = *value;
                count += usize::from(*value >= least);
            }
        }
    }
    count
}

/// Number of cells whose norms are summed separately, so that none waits for another.
const LANES: usize = 4;

/// A step along the direction.
struct Step {
    step: f64,
    datum: Metre,
    self_influence: f64,
}

impl Step {
    /// Moves the pressures and the approaches h + u of some cells along the direction `d` and its response
    /// `c`, which becomes their residual. Adds their residuals and violations to the sums of squares of each
    /// lane, and to its largest residual. The direction is zero except at the free cells.
    #[inline]
    fn take<const N: usize>(
        &self,
        sets: [Set; N],
        d: &[f32; N],
        c: &mut [f32; N],
        [p, touch]: [&mut [f64; N]; 2],
        bounds: impl Fn(usize) -> Interval,
        [residuals, violations, largest]: &mut [[f64; N]; 3],
    ) {
        if sets == [Set::Lower; N] {
            let mut overlap = false;
            for lane in 0..N {
                touch[lane] += self.step * f64::from(c[lane]);
                overlap |= touch[lane] < self.datum;
                c[lane] = 0.0;
            }
            if overlap {
                for lane in 0..N {
                    let violation = (self.datum - touch[lane]).max(0.0);
                    violations[lane] += violation * violation;
                }
            }
            return;
        }
        for lane in 0..N {
            touch[lane] += self.step * f64::from(c[lane]);
            p[lane] += self.step * f64::from(d[lane]);
            let w = self.datum - touch[lane];
            let outside = self.self_influence * (p[lane] - bounds(lane).clamp(p[lane]));
            let [residual, violation] = match sets[lane] {
                Set::Free => [w, outside],
                Set::Lower => [0.0, w.max(0.0)],
                Set::Upper => [0.0, w.min(0.0)],
            };
            c[lane] = residual as f32;
            residuals[lane] += residual * residual;
            violations[lane] += violation * violation;
            largest[lane] = if residual.abs() > largest[lane] { residual.abs() } else { largest[lane] };
        }
    }
}

/// Adds the displacements by a `pressure` with these `influence` coefficients on consecutive cells of a row.
fn add_scaled(row: &mut [f32], influence: &[f32], pressure: f32) {
    const WIDTH: usize = 2 * NEAR_FIELD + 1;
    let add = |row: &mut [f32], influence: &[f32]| {
        row.iter_mut().zip(influence).for_each(|(u, influence)| *u += influence * pressure);
    };
    // Away from the edges their number is constant, and the loop is unrolled.
    match (<&mut [f32; WIDTH]>::try_from(&mut *row), <&[f32; WIDTH]>::try_from(influence)) {
        (Ok(row), Ok(influence)) => add(row, influence),
        _ => add(row, influence),
    }
}
