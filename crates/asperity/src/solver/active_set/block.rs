//! One of the contacts that share an approach: a diagonal block of their influence matrix.

use std::ops;

use ndarray::Array2;

use crate::grid::{Field, SingleField};
use crate::math::sum::sums;
use crate::math::{Bands, indices_where, parallel};
use crate::ranks::{Halo, Largest, Merged, Slab};
use crate::solver::bounds::{Interval, with_bounds};
use crate::solver::feasible::{Range, extremes, map_within, sum_within, within};
use crate::solver::preconditioner::Preconditioner;
use crate::solver::residual::{Cell, Multiplier, ResidualSums};
use crate::solver::sets::{Set, Sets};
use crate::solver::site::Site;
use crate::solver::{SINGLE_PRECISION, Settings};
use crate::units::{Metre, Pascal};

/// Radius in cells of the influence that predicts a residual without a convolution.
const NEAR_FIELD: usize = 4;

/// One contact in the iteration: pressure, displacement, direction and residual of its cells.
///
/// Pressure and displacement are in double precision. Directions and their responses are in single precision, which
/// is sufficient for steps that are small compared with the values they correct. The error bound of the displacement
/// includes them.
pub(super) struct Block<'a> {
    site: &'a dyn Site,
    /// The bands of rows for parallel work.
    bands: Bands,
    preconditioner: Preconditioner,
    /// The current pressure p, possibly a little outside its bounds.
    pressure: Field,
    /// The approach h + u at which each cell touches.
    touch: Field,
    /// Error bound of the displacement due to single precision.
    rounding: Metre,
    /// The last feasible pressure. The energy of feasible pressures only decreases.
    feasible: Field,
    /// The approaches h + u under the last feasible pressure, during a line search from it, or always with a near copy.
    feasible_touch: Option<Field>,
    /// Whether search directions are convolved with the near copy of the operator.
    near: bool,
    /// Error bound due to single precision of the approaches under the last feasible pressure, if the operator itself
    /// computed them.
    feasible_rounding: Option<Metre>,
    /// The predicted set of each cell.
    sets: Sets,
    /// The search direction d.
    direction: SingleField,
    /// The response C·d of the direction. During the prediction of sets it holds the proposed pressures.
    response: SingleField,
    /// Largest |C·d|.
    max_response: f64,
    /// The residual r = δ − h − u of the free cells; zero elsewhere.
    residual: SingleField,
    /// The preconditioned residual z = M r of the free cells; zero elsewhere.
    preconditioned: SingleField,
    /// Influence coefficients up to [`NEAR_FIELD`] cells away: 0, 1 … along x, … −1, 0, 1 … along y.
    near_field: SingleField,
    /// The neighbouring rows within this radius.
    halo: Halo,
    /// The slab of this rank, if the grid is divided among ranks.
    slab: Slab,
    /// Self-influence c₀ for a periodic boundary, else 0. A periodic displacement may be smaller than the
    /// rounding of its transforms.
    local: f64,
    /// Convolutions so far.
    convolutions: usize,
    /// Applications of the near copy so far.
    near_applications: usize,
}

/// Norms after conjugate gradients on a set of free cells, as displacements: sums of squares for one contact, their
/// roots for all contacts together.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ResidualNorms {
    /// Norm of the residual at the free cells.
    pub(super) residual: f64,
    /// Norm of the violations of the bounds.
    pub(super) violation: f64,
    /// Largest residual at the free cells.
    pub(super) max_residual: f64,
    /// The approach of these norms.
    pub(super) datum: Metre,
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

impl<'a> Block<'a> {
    /// Creates the contact at a site under a pressure that has not been convolved yet. With `near` its search
    /// directions are convolved with the near copy of the operator.
    pub(super) fn new(site: &'a dyn Site, pressure: Field, near: bool) -> Self {
        let (shape, slab) = (site.grid().shape, site.slab());
        let reach = slab.whole_grid().shape.map(|n| NEAR_FIELD.min((n - 1) / 2));
        let mut made = None;
        site.with_operator(&mut |operator| {
            let near_field = SingleField::from_shape_fn([reach[0] + 1, 2 * reach[1] + 1], |(i, j)| {
                operator.influence(i, j.abs_diff(reach[1])) as f32
            });
            let local =
                if operator.boundary().leaves_mean_free() { operator.influence(0, 0).abs() } else { 0.0 };
            made = Some((Preconditioner::new(operator), near_field, local));
        });
        let (preconditioner, near_field, local) = made.expect("a site lends its operator");
        Self {
            site,
            bands: Bands::of(shape),
            preconditioner,
            pressure,
            touch: Field::zeros(shape),
            rounding: 0.0,
            feasible: Field::zeros(shape),
            feasible_touch: None,
            sets: Sets::new(shape),
            direction: SingleField::zeros(shape),
            response: SingleField::zeros(shape),
            max_response: 0.0,
            residual: SingleField::zeros(shape),
            preconditioned: SingleField::zeros(shape),
            halo: slab.halo(reach[0]),
            slab,
            near_field,
            local,
            near,
            feasible_rounding: None,
            convolutions: 0,
            near_applications: 0,
        }
    }

    /// Whether every pressure is within its bounds.
    pub(super) fn is_within_bounds(&self) -> bool {
        let bounds = self.site.bounds();
        let bands = self.bands.cut(flat(&self.pressure)).enumerate();
        let within = parallel::map(bands, |(band, pressure)| {
            let first = self.bands.first(band);
            with_bounds!(bounds, of => {
                pressure.iter().enumerate().all(|(cell, p)| of(first + cell).clamp(*p) == *p)
            })
        });
        within.into_iter().all(|within| within)
    }

    /// Returns the sums over the cells of `terms` of each pressure and its bounds.
    pub(super) fn sum<const N: usize>(
        &self,
        terms: impl Fn(Pascal, Interval) -> [f64; N] + Sync + Send,
    ) -> [f64; N] {
        self.sum_within(&self.pressure, terms)
    }

    /// Returns the sums over the cells of `terms` of each value and the bounds of its cell.
    fn sum_within<T: Copy + Sync, const N: usize>(
        &self,
        values: &Array2<T>,
        terms: impl Fn(T, Interval) -> [f64; N] + Sync + Send,
    ) -> [f64; N] {
        let bounds = self.site.bounds();
        let parts = parallel::map(self.bands.cut(flat(values)).enumerate(), |(band, values)| {
            sum_within(values, self.bands.first(band), &bounds, &terms)
        });
        Merged::of_parts(parts)
    }

    /// Replaces each pressure by a function of it and its bounds.
    pub(super) fn map(&mut self, change: impl Fn(Pascal, Interval) -> Pascal + Sync + Send) {
        let (bands, bounds) = (self.bands, self.site.bounds());
        parallel::map(bands.cut_mut(flat_mut(&mut self.pressure)).enumerate(), |(band, pressures)| {
            map_within(pressures, bands.first(band), &bounds, &change);
        });
    }

    /// Returns the range of the pressures and of their bounds.
    pub(super) fn range(&self) -> Range {
        self.range_of(&self.pressure)
    }

    /// Returns the range of some values and of the bounds of the pressure.
    fn range_of<T: Copy + Into<f64> + Sync>(&self, values: &Array2<T>) -> Range {
        let bounds = self.site.bounds();
        let parts = parallel::map(self.bands.cut(flat(values)), |values| extremes(values));
        let [min, max] = parts.into_iter().reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]).expect("a band");
        Range::new([min, max], values.len(), &bounds)
    }

    /// Returns pressure and displacement.
    pub(super) fn into_fields(self) -> (Field, Field) {
        let displacement = self.touch - &*self.site.initial_gap();
        (self.pressure, displacement)
    }

    /// Number of free cells.
    pub(super) fn free_cells(&self) -> usize {
        self.sets.free_cells()
    }

    /// Convolutions so far.
    pub(super) fn convolutions(&self) -> usize {
        self.convolutions
    }

    /// Applications of the near copy so far.
    pub(super) fn near_applications(&self) -> usize {
        self.near_applications
    }

    /// Error bound of the displacement due to single precision.
    pub(super) fn rounding(&self) -> Metre {
        self.rounding
    }

    /// Computes h + u from the total pressure in double precision. The fields in single precision, which are no
    /// longer needed, free memory for the transforms.
    pub(super) fn convolve(&mut self) {
        let shape = self.touch.raw_dim();
        self.in_single().into_iter().for_each(|field| *field = SingleField::default([0, 0]));
        touch_under(self.site, &self.pressure, &mut self.touch);
        self.site.with_operator(&mut |operator| operator.release());
        self.in_single().into_iter().for_each(|field| *field = SingleField::zeros(shape));
        self.convolutions += 1;
        self.rounding = 0.0;
    }

    /// Allocates the fields of an outer step.
    fn in_single(&mut self) -> [&mut SingleField; 4] {
        let Self { direction, response, residual, preconditioned, .. } = self;
        [direction, response, residual, preconditioned]
    }

    /// Computes h + u from the total pressure in single precision.
    pub(super) fn convolve_in_single(&mut self) {
        zip(self.bands, &mut self.direction, &self.pressure, |d, p| *d = *p as f32);
        self.convolve_direction();
        let gap = self.site.initial_gap();
        zip(self.bands, &mut self.touch, &gap, |touch, h| *touch = *h);
        self.rounding =
            SINGLE_PRECISION * (self.local * self.largest_pressure() - self.max_response).max(0.0);
        self.add_response();
    }

    /// Computes the response C·d of the direction, with a near copy that of this copy.
    fn convolve_direction(&mut self) {
        let Self { site, direction, response, .. } = self;
        if self.near {
            site.with_operator(&mut |operator| operator.apply_near(direction, response));
            self.near_applications += 1;
            // The operator itself corrects the rounding, too.
            self.max_response = 0.0;
            return;
        } else {
            site.with_operator(&mut |operator| operator.apply_single(direction, response));
            self.convolutions += 1;
        }
        let largest = |part: &[f32]| part.iter().fold(0.0f32, |m, u| if u.abs() > m { u.abs() } else { m });
        let parts = parallel::map(self.bands.cut(flat(response)), largest);
        // The rounding of transforms depends on the largest value on the whole grid.
        Largest(self.max_response) =
            self.slab.merged(Largest(f64::from(parts.into_iter().fold(0.0, f32::max))));
    }

    /// Computes h + u with the near copy, from the change of the pressure since the last feasible one.
    pub(super) fn convolve_change(&mut self) {
        self.direct_to_pressure();
        self.convolve_direction();
        self.add_to_feasible();
    }

    /// Computes h + u of a feasible pressure with the operator itself, in single precision if its error is below
    /// `max_rounding`. After the first time only the change of the pressure is convolved.
    pub(super) fn correct(&mut self, max_rounding: Metre) {
        self.near = false;
        let before = self.feasible_rounding;
        if !before.is_some_and(|before| self.correct_change(before) < max_rounding) {
            if self.rounding_in_single() < max_rounding {
                self.convolve_in_single();
            } else {
                self.convolve();
            }
            self.near = true;
            self.keep_feasible();
        }
        self.near = true;
        self.feasible_rounding = Some(self.rounding);
    }

    /// Convolves the change since the last feasible pressure, whose error bound was `before`, and makes the present
    /// pressure the last feasible one. Returns the new error bound.
    fn correct_change(&mut self, before: Metre) -> Metre {
        let bands = self.bands;
        let parts = bands.cut(flat(&self.pressure)).zip(bands.cut_mut(flat_mut(&mut self.feasible)));
        let parts = parts.zip(bands.cut_mut(flat_mut(&mut self.direction)));
        let largest = parallel::map(parts, |((pressure, feasible), d)| {
            let mut largest = 0.0f32;
            for ((d, p), feasible) in d.iter_mut().zip(pressure).zip(feasible) {
                *d = (p - *feasible) as f32;
                *feasible = *p;
                largest = if d.abs() > largest { d.abs() } else { largest };
            }
            largest
        });
        self.convolve_direction();
        let base = self.feasible_touch.as_mut().expect("kept with a near copy");
        let parts = bands.cut_mut(flat_mut(&mut self.touch)).zip(bands.cut_mut(flat_mut(base)));
        parallel::map(parts.zip(bands.cut(flat(&self.response))), |((touch, base), response)| {
            for ((touch, base), response) in touch.iter_mut().zip(base).zip(response) {
                *base += f64::from(*response);
                *touch = *base;
            }
        });
        let local = self.local * f64::from(largest.into_iter().fold(0.0, f32::max));
        self.rounding = before + SINGLE_PRECISION * self.max_response.max(local);
        self.rounding
    }

    /// Ends the use of the near copy.
    pub(super) fn leave_near_copy(&mut self) {
        self.near = false;
        self.feasible_touch = None;
    }

    /// Sets the direction from the last feasible pressure to the present one.
    fn direct_to_pressure(&mut self) {
        let bands = self.bands;
        let parts = bands.cut(flat(&self.pressure)).zip(bands.cut(flat(&self.feasible)));
        parallel::map(
            parts.zip(bands.cut_mut(flat_mut(&mut self.direction))),
            |((pressure, feasible), d)| {
                let cells = d.iter_mut().zip(pressure).zip(feasible);
                cells.for_each(|((d, p), feasible)| *d = (p - feasible) as f32);
            },
        );
    }

    /// Sets h + u to that of the last feasible pressure and the response C·d of the direction.
    fn add_to_feasible(&mut self) {
        let before = self.feasible_touch.as_ref().expect("kept with a near copy");
        zip(self.bands, &mut self.touch, before, |touch, before| *touch = *before);
        self.add_response();
    }

    /// Adds the response C·d to the displacement.
    fn add_response(&mut self) {
        zip(self.bands, &mut self.touch, &self.response, |touch, r| *touch += f64::from(*r));
        self.rounding += SINGLE_PRECISION * self.max_response;
    }

    /// Returns the error bound of a displacement computed in single precision.
    pub(super) fn rounding_in_single(&self) -> Metre {
        let gap = self.site.initial_gap();
        let bands = self.bands.cut(flat(&self.touch)).zip(self.bands.cut(flat(&gap)));
        let parts = parallel::map(bands, |(touch, gap)| {
            touch.iter().zip(gap).fold(0.0, |most, (touch, h)| f64::max(most, (touch - h).abs()))
        });
        let largest = parts.into_iter().fold(0.0, f64::max);
        SINGLE_PRECISION * largest.max(self.local * self.largest_pressure())
    }

    /// Largest |p|.
    fn largest_pressure(&self) -> Pascal {
        let parts = parallel::map(self.bands.cut(flat(&self.pressure)), |pressure| {
            pressure.iter().fold(0.0, |most, p| f64::max(most, p.abs()))
        });
        self.slab.merged(Largest(parts.into_iter().fold(0.0, f64::max))).0
    }

    /// Returns the work Σ p (δ − h) of the pressure at an approach, and twice its elastic energy, Σ p u, both per
    /// cell area.
    pub(super) fn work(&self, approach: Metre) -> [f64; 2] {
        let gap = self.site.initial_gap();
        let bands = self.bands.cut(flat(&self.pressure)).zip(self.bands.cut(flat(&self.touch)));
        Merged::of_parts(parallel::map(bands.zip(self.bands.cut(flat(&gap))), |((pressure, touch), gap)| {
            let mut sums = [0.0; 2];
            for ((p, touch), h) in pressure.iter().zip(touch).zip(gap) {
                sums = [sums[0] + p * (approach - h), sums[1] + p * (touch - h)];
            }
            sums
        }))
    }

    /// Multiplies pressure and displacement by a factor.
    pub(super) fn scale(&mut self, factor: f64) {
        let gap = self.site.initial_gap();
        self.pressure *= factor;
        zip(self.bands, &mut self.touch, &gap, |touch, h| *touch = h + factor * (*touch - h));
    }

    /// Returns the contribution of this contact to the multiplier of the load.
    pub(super) fn multiplier(&self) -> Multiplier {
        let bounds = self.site.bounds();
        let bands = self.bands.cut(flat(&self.pressure)).zip(self.bands.cut(flat(&self.touch)));
        let parts = parallel::map(bands.enumerate(), |(band, (pressure, touch))| {
            let first = self.bands.first(band);
            let cells = pressure.iter().zip(touch).enumerate();
            with_bounds!(bounds, of => {
                Multiplier::of(cells.map(|(cell, (p, touch))| Cell {
                    pressure: *p,
                    displacement: 0.0,
                    touch: *touch,
                    bounds: of(first + cell),
                }))
            })
        });
        Merged::of_parts(parts)
    }

    /// Returns the sums of this contact for the residual at an approach.
    pub(super) fn residual_sums(&self, approach: Metre, settings: &Settings) -> ResidualSums {
        let (gap, bounds) = (self.site.initial_gap(), self.site.bounds());
        let self_influence = settings.self_influence;
        let bands = self.bands.cut(flat(&self.pressure)).zip(self.bands.cut(flat(&self.touch)));
        let bands = bands.zip(self.bands.cut(flat(&gap))).enumerate();
        let parts = parallel::map(bands, |(band, ((pressure, touch), gap))| {
            let first = self.bands.first(band);
            with_bounds!(bounds, of => {
                let of = |cell: usize| of(first + cell);
                ResidualSums::of_fields([pressure, touch, gap], of, approach, self_influence)
            })
        });
        Merged::of_parts(parts)
    }

    /// Changes each pressure by the amount that closes its gap on a single cell with this compliance.
    pub(super) fn step_along_gap(&mut self, approach: Metre, compliance: f64) {
        zip(self.bands, &mut self.pressure, &self.touch, |p, touch| *p += (approach - touch) / compliance);
    }

    /// Proposes the pressures p + (δ − h − u)·stiffness after one diagonal Newton step. Returns their range.
    pub(super) fn propose(&mut self, approach: Metre, stiffness: f64) -> Range {
        let bands = self.bands.cut(flat(&self.pressure)).zip(self.bands.cut(flat(&self.touch)));
        let bands = bands.zip(self.bands.cut_mut(flat_mut(&mut self.response)));
        parallel::map(bands, |((pressure, touch), proposed)| {
            for ((y, p), touch) in proposed.iter_mut().zip(pressure).zip(touch) {
                *y = (p + (approach - touch) * stiffness) as f32;
            }
        });
        self.range_of(&self.response)
    }

    /// Returns the sum of the proposed pressures after an offset and clipping, and the number of cells strictly
    /// between their bounds.
    pub(super) fn proposed_sum(&self, offset: Pascal) -> [f64; 2] {
        self.sum_within(&self.response, |y, bounds| within(f64::from(y) + offset, bounds))
    }

    /// Predicts the sets from the proposed pressures after an offset.
    pub(super) fn predict_sets(&mut self, approach: Metre, stiffness: f64, offset: Pascal) {
        let (pressure, touch) = (flat(&self.pressure), flat(&self.touch));
        let proposed = |cells: ops::Range<usize>| {
            let cells = pressure[cells.clone()].iter().zip(&touch[cells]);
            cells.map(|(p, touch)| p + (approach - touch) * stiffness + offset)
        };
        self.sets.assign(proposed, &self.site.bounds());
        self.residual.fill(0.0);
        self.preconditioner.adapt(&self.sets);
    }

    /// Sets the direction that brings the cells predicted at a bound to it. Returns whether any cell has to move.
    pub(super) fn direct_to_bounds(&mut self) -> bool {
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
    pub(super) fn predict_residual(&mut self, approach: Metre) -> f64 {
        self.convolve_near_field();
        let bands = self.bands;
        let parts = bands.cut(flat(&self.touch)).zip(bands.cut(flat(&self.response)));
        let parts = parts.zip(bands.cut_mut(flat_mut(&mut self.residual))).zip(self.sets.in_bands());
        let [sum] = Merged::of_parts(parallel::map(parts, |(((touch, predicted), residual), free)| {
            let mut sum = 0.0;
            for cell in free.cells() {
                let w = approach - touch[cell] - f64::from(predicted[cell]);
                sum += w;
                residual[cell] = w as f32;
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

    /// Subtracts a mean from the residual of the free cells.
    pub(super) fn subtract_mean(&mut self, mean: f64) {
        let parts = self.bands.cut_mut(flat_mut(&mut self.residual)).zip(self.sets.in_bands());
        parallel::map(parts, |(residual, free)| free.cells().for_each(|cell| residual[cell] -= mean as f32));
    }

    /// Computes the preconditioned residual z = M r. Returns Σ z, Σ r and Σ r z.
    pub(super) fn precondition(&mut self) -> [f64; 3] {
        let (r, z) = (flat(&self.residual), flat_mut(&mut self.preconditioned));
        self.preconditioner.apply(&self.sets, r, z)
    }

    /// Sets the direction of the free cells to the damped preconditioned residual without its mean. Returns the
    /// sum of the direction, and the sum of the pressures of the free cells above their lower bounds.
    pub(super) fn direct_free_cells(&mut self, mean: f64, damping: f64) -> [f64; 2] {
        let (damping, mean) = (damping as f32, mean as f32);
        let (bands, bounds) = (self.bands, self.site.bounds());
        let parts = bands.cut(flat(&self.preconditioned)).zip(bands.cut(flat(&self.pressure)));
        let parts = parts.zip(bands.cut_mut(flat_mut(&mut self.direction))).zip(self.sets.in_bands());
        Merged::of_parts(parallel::map(parts.enumerate(), |(band, (((z, p), direction), free))| {
            let first = bands.first(band);
            free.cells().for_each(|cell| direction[cell] = damping * (z[cell] - mean));
            let borne = with_bounds!(bounds, of => {
                let borne = |cell| of(first + cell).clamp(p[cell]) - of(first + cell).lower;
                free.cells().map(borne).sum()
            });
            let [added] = sums(direction, |_, d| [f64::from(d)]);
            [added, borne]
        }))
    }

    /// Subtracts from the direction of each free cell a uniform part, and a part in proportion to the pressure
    /// above its lower bound, so that the direction preserves the load.
    pub(super) fn balance_direction(&mut self, each: f64, per_pressure: f64) {
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
    pub(super) fn step_to_bounds(&mut self, convolved: bool) {
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
    pub(super) fn add_to_free_cells(&mut self, pressure: Pascal) {
        let parts = self.bands.cut_mut(flat_mut(&mut self.pressure)).zip(self.sets.in_bands());
        parallel::map(parts, |(p, free)| free.cells().for_each(|cell| p[cell] += pressure));
    }

    /// Sets the direction to zero. Returns Σ (h + u) of the free cells.
    pub(super) fn reset_direction(&mut self) -> f64 {
        let bands = self.bands;
        let parts = bands.cut_mut(flat_mut(&mut self.direction)).zip(bands.cut(flat(&self.touch)));
        let [sum] =
            Merged::of_parts(parallel::map(parts.zip(self.sets.in_bands()), |((direction, touch), free)| {
                direction.fill(0.0);
                [free.cells().map(|cell| touch[cell]).sum()]
            }));
        sum
    }

    /// Updates the direction to the conjugate direction, d = z − mean + β d, and computes C·d. Returns the
    /// curvature dᵀC d of the energy along it, and Σ C·d of the free cells.
    pub(super) fn update_direction(&mut self, mean: f64, beta: f64) -> [f64; 2] {
        let (mean, beta) = (mean as f32, beta as f32);
        let bands = self.bands;
        let parts = bands.cut(flat(&self.preconditioned)).zip(bands.cut_mut(flat_mut(&mut self.direction)));
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

    /// Moves pressure and displacement by `step` times the direction. Computes the residual of the free cells,
    /// whose gap closes at the approach `datum`. Returns its norm and the norm of the violations of the bounds.
    pub(super) fn step_along_direction(
        &mut self,
        step: f64,
        datum: Metre,
        settings: &Settings,
    ) -> ResidualNorms {
        let (bands, bounds) = (self.bands, self.site.bounds());
        let parts = bands.cut(self.sets.of()).zip(bands.cut(flat(&self.direction)));
        let parts = parts.zip(bands.cut(flat(&self.response)));
        let parts = parts.zip(bands.cut_mut(flat_mut(&mut self.pressure)));
        let parts = parts.zip(bands.cut_mut(flat_mut(&mut self.touch)));
        let parts = parts.zip(bands.cut_mut(flat_mut(&mut self.residual))).enumerate();
        let norms = parallel::map(parts, |(band, (((((sets, d), c), p), touch), r))| {
            let first = bands.first(band);
            let ((sets, sets_rest), (d, d_rest), (c, c_rest)) =
                (sets.as_chunks(), d.as_chunks(), c.as_chunks());
            let ((p, p_rest), (touch, touch_rest)) = (p.as_chunks_mut(), touch.as_chunks_mut());
            let (r, r_rest) = r.as_chunks_mut();
            let rest = first + p.len() * LANES;
            let step = Step { step, datum, self_influence: settings.self_influence };
            with_bounds!(bounds, of => {
                let mut lanes = [[0.0; LANES]; 3];
                let chunks = sets.iter().zip(d).zip(c).zip(p).zip(touch).zip(r).enumerate();
                for (number, (((((sets, d), c), p), touch), r)) in chunks {
                    let of = |lane: usize| of(first + number * LANES + lane);
                    step.take(*sets, [d, c], [p, touch], r, of, &mut lanes);
                }
                let mut last = [[0.0; 1]; 3];
                let cells = sets_rest.iter().zip(d_rest).zip(c_rest).zip(p_rest).zip(touch_rest).zip(r_rest);
                for (number, (((((set, d), c), p), touch), r)) in cells.enumerate() {
                    let [p, touch] = [p, touch].map(std::array::from_mut);
                    let [d, c] = [d, c].map(std::array::from_ref);
                    step.take([*set], [d, c], [p, touch], std::array::from_mut(r), |_| of(rest + number), &mut last);
                }
                let [residual, violation, _] = [0, 1, 2].map(|n| lanes[n].iter().sum::<f64>() + last[n][0]);
                let max_residual = lanes[2].iter().fold(last[2][0], |most, value| f64::max(most, *value));
                ResidualNorms { residual, violation, max_residual, datum }
            })
        });
        self.rounding += SINGLE_PRECISION * step * self.max_response;
        Merged::of_parts(norms)
    }

    /// Stores the pressure as the last feasible one, with a near copy together with its h + u.
    pub(super) fn keep_feasible(&mut self) {
        zip(self.bands, &mut self.feasible, &self.pressure, |feasible, p| *feasible = *p);
        if self.near {
            let touch = self.feasible_touch.get_or_insert_with(|| Field::zeros(self.feasible.raw_dim()));
            zip(self.bands, touch, &self.touch, |before, touch| *before = *touch);
            self.feasible_rounding = None;
        }
    }

    /// Convolves the last feasible pressure, for a line search from it. With a near copy its h + u is known.
    pub(super) fn convolve_feasible(&mut self) {
        if self.near {
            return;
        }
        let mut touch = Field::zeros(self.feasible.raw_dim());
        touch_under(self.site, &self.feasible, &mut touch);
        self.feasible_touch = Some(touch);
        self.convolutions += 1;
    }

    /// Returns slope and curvature of the energy, at an approach, along the line from the last feasible pressure
    /// to the present one.
    pub(super) fn descent(&self, approach: Metre) -> [f64; 2] {
        let before = self.feasible_touch.as_ref().expect("the feasible pressure is convolved");
        let bands = self.bands.cut(flat(&self.feasible)).zip(self.bands.cut(flat(before)));
        let bands = bands.zip(self.bands.cut(flat(&self.pressure))).zip(self.bands.cut(flat(&self.touch)));
        Merged::of_parts(parallel::map(bands, |(((feasible, before), pressure), touch)| {
            let (mut slope, mut curvature) = (0.0, 0.0);
            for (((p, before), target), touch) in feasible.iter().zip(before).zip(pressure).zip(touch) {
                slope += (approach - before) * (target - p);
                curvature += (target - p) * (touch - before);
            }
            [slope, curvature]
        }))
    }

    /// Moves to the fraction `share` of the line from the last feasible pressure to the present one.
    pub(super) fn step_from_feasible(&mut self, share: f64) {
        let before = self.feasible_touch.as_ref().expect("the feasible pressure is convolved");
        let mix = |to: &mut f64, from: &f64| *to = from + share * (*to - from);
        zip(self.bands, &mut self.pressure, &self.feasible, mix);
        zip(self.bands, &mut self.touch, before, mix);
    }

    /// Ends a line search: its result is the last feasible pressure.
    pub(super) fn end_line_search(&mut self) {
        self.keep_feasible();
        if !self.near {
            self.feasible_touch = None;
        }
    }
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
    /// Moves the pressures and approaches h + u of some cells, which the direction `d` and its response `c` change, and
    /// computes their residuals. Adds to the sums of the squares of residual and violation and to the largest residual
    /// of each lane. The direction is zero except at free cells.
    #[inline]
    fn take<const N: usize>(
        &self,
        sets: [Set; N],
        [d, c]: [&[f32; N]; 2],
        [p, touch]: [&mut [f64; N]; 2],
        r: &mut [f32; N],
        bounds: impl Fn(usize) -> Interval,
        [residuals, violations, largest]: &mut [[f64; N]; 3],
    ) {
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
            r[lane] = residual as f32;
            residuals[lane] += residual * residual;
            violations[lane] += violation * violation;
            largest[lane] = if residual.abs() > largest[lane] { residual.abs() } else { largest[lane] };
        }
    }
}

/// Computes the approaches h + u at which the cells touch under a `pressure`.
fn touch_under(site: &dyn Site, pressure: &Field, touch: &mut Field) {
    site.with_operator(&mut |operator| operator.apply(pressure, touch));
    *touch += &*site.initial_gap();
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

/// Changes each value of a field by the value of another field.
fn zip<A: Send, B: Sync>(
    bands: Bands,
    field: &mut Array2<A>,
    other: &Array2<B>,
    change: impl Fn(&mut A, &B) + Sync + Send,
) {
    parallel::map(bands.cut_mut(flat_mut(field)).zip(bands.cut(flat(other))), |(field, other)| {
        field.iter_mut().zip(other).for_each(|(value, other)| change(value, other));
    });
}

/// Returns the values of a field by flat index.
fn flat<T>(field: &Array2<T>) -> &[T] {
    field.as_slice().expect("standard layout")
}

/// Returns the mutable values of a field by flat index.
fn flat_mut<T>(field: &mut Array2<T>) -> &mut [T] {
    field.as_slice_mut().expect("standard layout")
}
