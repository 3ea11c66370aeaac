//! The passes of a block in an outer step: prediction of the sets, the step to the bounds, and conjugate gradients.

use std::ops;

use super::{Block, NEAR_FIELD, flat, flat_mut, zip};
use crate::math::{indices_where, parallel};
use crate::ranks::Merged;
use crate::solver::bounds::with_bounds;
use crate::solver::feasible::{Range, extremes, within};
use crate::solver::residual::{Cell, Multiplier, ResidualSums};
use crate::solver::sets::Set;
use crate::solver::{SINGLE_PRECISION, Settings};
use crate::units::{Metre, Pascal};

/// Norms after conjugate gradients on a set of free cells, as displacements: sums of squares for one contact, their
/// roots for all contacts together.
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
        let bands = self.bands.cut(flat(&self.pressure)).zip(self.bands.cut(flat(&self.residual)));
        let parts = parallel::map(bands.enumerate(), |(band, (pressure, residual))| {
            let first = self.bands.first(band);
            let cells = pressure.iter().zip(residual).enumerate();
            with_bounds!(bounds, of => {
                Multiplier::of(cells.map(|(cell, (p, r))| Cell {
                    pressure: *p,
                    displacement: 0.0,
                    touch: self.touch(*r),
                    bounds: of(first + cell),
                }))
            })
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
        let bands = self.bands.cut(flat(&self.pressure)).zip(self.bands.cut(flat(&self.residual)));
        let bands = bands.zip(self.bands.cut(flat(&gap))).enumerate();
        let parts = parallel::map(bands, |(band, ((pressure, residual), gap))| {
            let first = self.bands.first(band);
            with_bounds!(bounds, of => {
                let of = |cell: usize| of(first + cell);
                ResidualSums::of_fields([pressure, gap], (residual, self.datum), of, approach, self_influence)
            })
        });
        Merged::of_parts(parts)
    }

    /// Changes each pressure by the amount that closes its gap on a single cell with this compliance.
    pub(in crate::solver::active_set) fn step_along_gap(&mut self, approach: Metre, compliance: f64) {
        let to_approach = approach - self.datum;
        zip(self.bands, &mut self.pressure, &self.residual, |p, r| {
            *p += (to_approach + f64::from(*r)) / compliance;
        });
    }

    /// Proposes the pressures p + (δ − h − u)·stiffness after one diagonal Newton step. Returns their range.
    pub(in crate::solver::active_set) fn propose(&mut self, approach: Metre, stiffness: f64) -> Range {
        let to_approach = approach - self.datum;
        let bands = self.bands.cut(flat(&self.pressure)).zip(self.bands.cut(flat(&self.residual)));
        let bands = bands.zip(self.bands.cut_mut(flat_mut(&mut self.response)));
        let parts = parallel::map(bands, |((pressure, residual), proposed)| {
            for ((y, p), r) in proposed.iter_mut().zip(pressure).zip(residual) {
                *y = (p + (to_approach + f64::from(*r)) * stiffness) as f32;
            }
            extremes(proposed)
        });
        self.range_of(parts)
    }

    /// Returns the sum of the proposed pressures after an offset and clipping, and the number of cells strictly
    /// between their bounds.
    pub(in crate::solver::active_set) fn proposed_sum(&self, offset: Pascal) -> [f64; 2] {
        self.sum_within(&self.response, |y, bounds| within(f64::from(y) + offset, bounds))
    }

    /// Predicts the sets from the proposed pressures after an offset.
    pub(in crate::solver::active_set) fn predict_sets(
        &mut self,
        approach: Metre,
        stiffness: f64,
        offset: Pascal,
    ) {
        let (pressure, residual) = (flat(&self.pressure), flat(&self.residual));
        let to_approach = approach - self.datum;
        let proposed = |cells: ops::Range<usize>| {
            let cells = pressure[cells.clone()].iter().zip(&residual[cells]);
            cells.map(|(p, r)| p + (to_approach + f64::from(*r)) * stiffness + offset)
        };
        self.sets.assign(proposed, &self.site.bounds());
        self.preconditioner.adapt(&self.sets);
    }

    /// Sets the direction that brings the cells predicted at a bound to it. Returns whether any cell has to move.
    pub(in crate::solver::active_set) fn direct_to_bounds(&mut self) -> bool {
        let bounds = self.site.bounds();
        let bands = self.bands;
        let parts = bands.cut_mut(flat_mut(&mut self.direction)).zip(bands.cut(self.sets.of()));
        let parts = parts.zip(bands.cut(flat(&self.pressure))).enumerate();
        let elsewhere = parallel::map(parts, |(band, ((direction, sets), pressure))| {
            let first = bands.first(band);
            let mut any = false;
            let cells = direction.iter_mut().zip(sets).zip(pressure).enumerate();
            with_bounds!(bounds, of => {
                for (cell, ((d, set), p)) in cells {
                    let distance = match set {
                        Set::Lower => of(first + cell).lower - p,
                        Set::Upper => of(first + cell).upper - p,
                        Set::Free => 0.0,
                    };
                    any |= distance != 0.0;
                    *d = distance as f32;
                }
            });
            any
        });
        elsewhere.into_iter().any(|any| any)
    }

    /// Predicts the residual of the free cells after the step along the direction, from the near field of its
    /// response. Returns its sum.
    pub(in crate::solver::active_set) fn predict_residual(&mut self, approach: Metre) -> f64 {
        self.convolve_near_field();
        let (bands, to_approach) = (self.bands, approach - self.datum);
        let parts = bands.cut(flat(&self.residual)).zip(bands.cut_mut(flat_mut(&mut self.response)));
        let parts = parts.zip(self.sets.in_bands());
        let [sum] = Merged::of_parts(parallel::map(parts, |((residual, predicted), free)| {
            let mut sum = 0.0;
            for cell in free.cells() {
                let w = to_approach + f64::from(residual[cell]) - f64::from(predicted[cell]);
                sum += w;
                predicted[cell] = w as f32;
            }
            [sum]
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

    /// Computes the preconditioned predicted residual z = M r, without its `mean`, in place of the direction. Returns
    /// Σ z, Σ r and Σ r z.
    pub(in crate::solver::active_set) fn precondition_predicted(&mut self, mean: f64) -> [f64; 3] {
        let parts = self.bands.cut_mut(flat_mut(&mut self.response)).zip(self.sets.in_bands());
        parallel::map(parts, |(predicted, free)| {
            free.cells().for_each(|cell| predicted[cell] -= mean as f32);
        });
        self.preconditioner.apply(&self.sets, flat(&self.response), flat_mut(&mut self.direction))
    }

    /// Computes the preconditioned residual z = M r of the free cells, in place of the response. Returns Σ z, Σ r and
    /// Σ r z.
    pub(in crate::solver::active_set) fn precondition(&mut self) -> [f64; 3] {
        self.preconditioner.apply(&self.sets, flat(&self.residual), flat_mut(&mut self.response))
    }

    /// Sets the direction of the free cells to the damped preconditioned residual without its mean, and that of the other
    /// cells to their distance from the bound. Returns the sum of the direction, and the sum of the pressures of the free
    /// cells above their lower bounds.
    pub(in crate::solver::active_set) fn direct_all_cells(&mut self, mean: f64, damping: f64) -> [f64; 2] {
        let (damping, mean) = (damping as f32, mean as f32);
        let (bands, bounds) = (self.bands, self.site.bounds());
        let parts = bands.cut(self.sets.of()).zip(bands.cut(flat(&self.pressure)));
        let parts = parts.zip(bands.cut_mut(flat_mut(&mut self.direction)));
        Merged::of_parts(parallel::map(parts.enumerate(), |(band, ((sets, pressure), direction))| {
            let first = bands.first(band);
            with_bounds!(bounds, of => {
                let cells = sets.iter().zip(pressure).zip(direction).enumerate();
                let mut sums = [0.0; 2];
                for (cell, ((set, p), d)) in cells {
                    let bounds = of(first + cell);
                    *d = match set {
                        Set::Lower => (bounds.lower - p) as f32,
                        Set::Upper => (bounds.upper - p) as f32,
                        Set::Free => {
                            sums[1] += bounds.clamp(*p) - bounds.lower;
                            damping * (*d - mean)
                        }
                    };
                    sums[0] += f64::from(*d);
                }
                sums
            })
        }))
    }

    /// Subtracts from the direction of each free cell a uniform part, and a part in proportion to the pressure
    /// above its lower bound, so that the direction preserves the load.
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

    /// Moves along the direction to the bounds. If `convolved`, it also updates the displacement by a convolution.
    pub(in crate::solver::active_set) fn step_to_bounds(&mut self, convolved: bool) {
        if convolved {
            self.convolve_direction();
            self.add_response();
        }
        let (bands, bounds) = (self.bands, self.site.bounds());
        let parts = bands.cut_mut(flat_mut(&mut self.pressure)).zip(bands.cut(flat(&self.direction)));
        let parts = parts.zip(bands.cut(self.sets.of())).enumerate();
        parallel::map(parts, |(band, ((pressure, direction), sets))| {
            let first = bands.first(band);
            let cells = pressure.iter_mut().zip(direction).zip(sets).enumerate();
            with_bounds!(bounds, of => {
                for (cell, ((p, d), set)) in cells {
                    // The pressures are exactly at the bounds, without the rounding of the sum.
                    *p = match set {
                        Set::Lower => of(first + cell).lower,
                        Set::Upper => of(first + cell).upper,
                        Set::Free => *p + f64::from(*d),
                    };
                }
            });
        });
    }

    /// Adds the same pressure to all free cells.
    pub(in crate::solver::active_set) fn add_to_free_cells(&mut self, pressure: Pascal) {
        let parts = self.bands.cut_mut(flat_mut(&mut self.pressure)).zip(self.sets.in_bands());
        parallel::map(parts, |(p, free)| free.cells().for_each(|cell| p[cell] += pressure));
    }

    /// Sets the direction to zero. Returns Σ (h + u) of the free cells.
    pub(in crate::solver::active_set) fn reset_direction(&mut self) -> f64 {
        let bands = self.bands;
        let parts = bands.cut_mut(flat_mut(&mut self.direction)).zip(bands.cut(flat(&self.residual)));
        let [sum] = Merged::of_parts(parallel::map(
            parts.zip(self.sets.in_bands()),
            |((direction, residual), free)| {
                direction.fill(0.0);
                [free.cells().map(|cell| f64::from(residual[cell])).sum()]
            },
        ));
        self.free_cells() as f64 * self.datum - sum
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

    /// Moves pressure and displacement by `step` times the direction. Computes the residual at the approach `datum`.
    /// Returns its norm at the free cells and the norm of the violations of the bounds.
    pub(in crate::solver::active_set) fn step_along_direction(
        &mut self,
        step: f64,
        datum: Metre,
        settings: &Settings,
    ) -> ResidualNorms {
        let (bands, bounds, self_influence) = (self.bands, self.site.bounds(), settings.self_influence);
        let parts = bands.cut(self.sets.of()).zip(bands.cut(flat(&self.response)));
        let parts = parts.zip(bands.cut_mut(flat_mut(&mut self.residual)));
        let parts = parts.zip(bands.cut(flat(&self.direction)));
        let parts = parts.zip(bands.cut_mut(flat_mut(&mut self.pressure))).zip(self.sets.in_bands());
        let change = Step { step, datum: datum - self.datum };
        let norms = parallel::map(parts.enumerate(), |(band, (((((sets, c), r), d), p), free))| {
            let [residual, violation, max_residual] = change.take(sets, c, r);
            let first = bands.first(band);
            let outside = with_bounds!(bounds, of => {
                let mut outside = 0.0;
                for cell in free.cells() {
                    p[cell] += step * f64::from(d[cell]);
                    let beyond = self_influence * (p[cell] - of(first + cell).clamp(p[cell]));
                    outside += beyond * beyond;
                }
                outside
            });
            ResidualNorms { residual, violation: violation + outside, max_residual, datum }
        });
        self.datum = datum;
        self.rounding += SINGLE_PRECISION * step * self.max_response;
        Merged::of_parts(norms)
    }
}

/// Number of cells whose norms are summed separately, so that none waits for another.
const LANES: usize = 4;

/// A step along the direction.
struct Step {
    step: f64,
    /// Change of the approach of the residual.
    datum: Metre,
}

impl Step {
    /// Changes the residuals `r` of some cells by the step, whose direction has the response `c`. Returns the sums of the
    /// squares of residual and violation, and the largest residual.
    fn take(&self, sets: &[Set], c: &[f32], r: &mut [f32]) -> [f64; 3] {
        let ((sets, sets_rest), (c, c_rest), (r, r_rest)) =
            (sets.as_chunks(), c.as_chunks(), r.as_chunks_mut());
        let mut lanes = [[0.0; LANES]; 3];
        for ((sets, c), r) in sets.iter().zip(c).zip(r) {
            self.add(*sets, c, r, &mut lanes);
        }
        let mut last = [[0.0; 1]; 3];
        for ((set, c), r) in sets_rest.iter().zip(c_rest).zip(r_rest) {
            self.add([*set], std::array::from_ref(c), std::array::from_mut(r), &mut last);
        }
        let [residual, violation, _] = [0, 1, 2].map(|n| lanes[n].iter().sum::<f64>() + last[n][0]);
        [residual, violation, lanes[2].iter().fold(last[2][0], |most, value| f64::max(most, *value))]
    }

    /// Changes the residual of each lane, and adds it to the sums of the lane.
    #[inline]
    fn add<const N: usize>(
        &self,
        sets: [Set; N],
        c: &[f32; N],
        r: &mut [f32; N],
        [residuals, violations, largest]: &mut [[f64; N]; 3],
    ) {
        for lane in 0..N {
            let w = f64::from(r[lane]) - self.step * f64::from(c[lane]) + self.datum;
            r[lane] = w as f32;
            let [residual, violation] = match sets[lane] {
                Set::Free => [w, 0.0],
                Set::Lower => [0.0, w.max(0.0)],
                Set::Upper => [0.0, w.min(0.0)],
            };
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
