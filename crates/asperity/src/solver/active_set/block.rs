//! One of the contacts that share an approach: a diagonal block of their influence matrix.

use ndarray::Array2;

use crate::grid::{Field, SingleField};
use crate::math::sum::sums;
use crate::solver::Terms;
use crate::solver::bounds::{Interval, with_bounds};
use crate::solver::feasible::{Range, map_within, sum_within, within};
use crate::solver::preconditioner::Preconditioner;
use crate::solver::residual::{Cell, Multiplier, ResidualSums};
use crate::solver::sets::{Set, Sets};
use crate::solver::site::Site;
use crate::units::{Metre, Pascal};

/// Radius, in cells, of the influence by which a residual is predicted without a convolution.
const NEAR_FIELD: usize = 4;
/// Error of a displacement in single precision, as a share of its largest value.
const SINGLE_PRECISION: f64 = 4e-7;

/// One contact in the iteration: pressure, displacement, direction and residual of its cells.
///
/// Pressure and displacement are kept in double precision. Directions and their responses are computed in single, which is
/// as good as long as the steps are small against what they correct; the error that this leaves in the displacement is
/// kept count of.
pub(super) struct Block<'a> {
    site: &'a dyn Site,
    preconditioner: Preconditioner,
    /// The current pressure p, possibly a little outside its bounds.
    pressure: Field,
    /// The approach h + u at which each cell touches.
    touch: Field,
    /// Largest error of the displacement by single precision.
    rounding: Metre,
    /// The last feasible pressure, from which the energy only falls.
    feasible: Field,
    /// The approaches h + u under the last feasible pressure, during a line search from it.
    feasible_touch: Option<Field>,
    /// The predicted set of each cell.
    sets: Sets,
    /// The search direction d.
    direction: SingleField,
    /// The response C·d of the direction; while sets are predicted, the proposed pressures.
    response: SingleField,
    /// Largest |C·d|.
    max_response: f64,
    /// The residual r = δ − h − u of the free cells; zero elsewhere.
    residual: SingleField,
    /// The preconditioned residual z = M r of the free cells; zero elsewhere.
    preconditioned: SingleField,
    /// Influence coefficients up to [`NEAR_FIELD`] cells away: 0, 1 … along x, … −1, 0, 1 … along y.
    near: SingleField,
    /// Self-influence c₀ where the boundary is periodic, else 0: there a displacement may be less than the rounding of its
    /// transforms.
    local: f64,
    /// Convolutions so far.
    convolutions: usize,
}

/// Norms that conjugate gradients on a set of free cells leave, as displacements: of one contact sums of squares, of all
/// together their roots.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ResidualNorms {
    /// Norm of the residual at the free cells.
    pub(super) residual: f64,
    /// Norm of the violations of the bounds.
    pub(super) violation: f64,
    /// Largest residual at the free cells.
    pub(super) max_residual: f64,
    /// The approach at which they were taken.
    pub(super) datum: Metre,
}

impl ResidualNorms {
    /// The norms over the cells of two contacts together.
    pub(super) fn and(self, other: Self) -> Self {
        Self {
            residual: self.residual + other.residual,
            violation: self.violation + other.violation,
            max_residual: self.max_residual.max(other.max_residual),
            datum: self.datum,
        }
    }
}

impl<'a> Block<'a> {
    /// The contact at a site under a pressure that has not been convolved yet.
    pub(super) fn new(site: &'a dyn Site, pressure: Field) -> Self {
        let shape = site.grid().shape;
        let reach = shape.map(|n| NEAR_FIELD.min((n - 1) / 2));
        let mut made = None;
        site.with_operator(&mut |operator| {
            let near = SingleField::from_shape_fn([reach[0] + 1, 2 * reach[1] + 1], |(i, j)| {
                operator.influence(i, j.abs_diff(reach[1])) as f32
            });
            let local =
                if operator.boundary().leaves_mean_free() { operator.influence(0, 0).abs() } else { 0.0 };
            made = Some((Preconditioner::new(operator), near, local));
        });
        let (preconditioner, near, local) = made.expect("a site lends its operator");
        Self {
            site,
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
            near,
            local,
            convolutions: 0,
        }
    }

    /// Whether every pressure is within its bounds.
    pub(super) fn is_within_bounds(&self) -> bool {
        let pressure = flat(&self.pressure);
        with_bounds!(self.site.bounds(), of => {
            pressure.iter().enumerate().all(|(cell, p)| of(cell).clamp(*p) == *p)
        })
    }

    /// The sums over the cells of `terms` of each pressure and its bounds.
    pub(super) fn sum<const N: usize>(&self, terms: impl Fn(Pascal, Interval) -> [f64; N]) -> [f64; N] {
        sum_within(flat(&self.pressure), &self.site.bounds(), terms)
    }

    /// Replaces each pressure by a function of it and its bounds.
    pub(super) fn map(&mut self, change: impl Fn(Pascal, Interval) -> Pascal) {
        map_within(flat_mut(&mut self.pressure), &self.site.bounds(), change);
    }

    /// The range of the pressures and of their bounds.
    pub(super) fn range(&self) -> Range {
        Range::of(flat(&self.pressure), &self.site.bounds())
    }

    /// Pressure and displacement.
    pub(super) fn into_fields(self) -> (Field, Field) {
        let displacement = self.touch - &*self.site.initial_gap();
        (self.pressure, displacement)
    }

    /// Number of free cells.
    pub(super) fn free_cells(&self) -> usize {
        self.sets.free().len()
    }

    /// Convolutions so far.
    pub(super) fn convolutions(&self) -> usize {
        self.convolutions
    }

    /// Largest error of the displacement by single precision.
    pub(super) fn rounding(&self) -> Metre {
        self.rounding
    }

    /// Computes h + u from the whole pressure, in double precision.
    pub(super) fn convolve(&mut self) {
        touch_under(self.site, &self.pressure, &mut self.touch);
        self.convolutions += 1;
        self.rounding = 0.0;
    }

    /// Computes h + u from the whole pressure, in single precision.
    pub(super) fn convolve_in_single(&mut self) {
        self.direction.zip_mut_with(&self.pressure, |d, p| *d = *p as f32);
        self.convolve_direction();
        self.touch.assign(&self.site.initial_gap());
        self.rounding =
            SINGLE_PRECISION * (self.local * self.largest_pressure() - self.max_response).max(0.0);
        self.add_response();
    }

    /// Computes the response C·d of the direction.
    fn convolve_direction(&mut self) {
        let Self { site, direction, response, .. } = self;
        site.with_operator(&mut |operator| operator.apply_single(direction, response));
        self.max_response =
            f64::from(response.iter().fold(0.0f32, |m, u| if u.abs() > m { u.abs() } else { m }));
        self.convolutions += 1;
    }

    /// Adds the response C·d to the displacement.
    fn add_response(&mut self) {
        self.touch.zip_mut_with(&self.response, |touch, r| *touch += f64::from(*r));
        self.rounding += SINGLE_PRECISION * self.max_response;
    }

    /// Largest error of the displacement if it were computed in single precision.
    pub(super) fn rounding_in_single(&self) -> Metre {
        let gap = self.site.initial_gap();
        let largest =
            self.touch.iter().zip(&*gap).fold(0.0, |most, (touch, h)| f64::max(most, (touch - h).abs()));
        SINGLE_PRECISION * largest.max(self.local * self.largest_pressure())
    }

    /// Largest |p|.
    fn largest_pressure(&self) -> Pascal {
        self.pressure.iter().fold(0.0, |most, p| f64::max(most, p.abs()))
    }

    /// The work Σ p (δ − h) of the pressure at an approach, and twice its elastic energy, Σ p u, both over the cell area.
    pub(super) fn work(&self, approach: Metre) -> [f64; 2] {
        let gap = self.site.initial_gap();
        let (mut work, mut twice_energy) = (0.0, 0.0);
        ndarray::Zip::from(&self.pressure).and(&self.touch).and(&*gap).for_each(|p, touch, h| {
            work += p * (approach - h);
            twice_energy += p * (touch - h);
        });
        [work, twice_energy]
    }

    /// Multiplies pressure and displacement by a factor.
    pub(super) fn scale(&mut self, factor: f64) {
        let gap = self.site.initial_gap();
        self.pressure *= factor;
        self.touch.zip_mut_with(&gap, |touch, h| *touch = h + factor * (*touch - h));
    }

    /// The part of this contact in the multiplier of the load.
    pub(super) fn multiplier(&self) -> Multiplier {
        let cells = flat(&self.pressure).iter().zip(flat(&self.touch)).enumerate();
        with_bounds!(self.site.bounds(), of => {
            Multiplier::of(cells.map(|(cell, (p, touch))| Cell {
                pressure: *p,
                displacement: 0.0,
                touch: *touch,
                bounds: of(cell),
            }))
        })
    }

    /// The sums of this contact for the residual at an approach.
    pub(super) fn residual_sums(&self, approach: Metre, terms: &Terms) -> ResidualSums {
        let gap = self.site.initial_gap();
        let cells = flat(&self.pressure).iter().zip(flat(&self.touch)).zip(flat(&gap)).enumerate();
        with_bounds!(self.site.bounds(), of => {
            let cells = cells.map(|(cell, ((p, touch), h))| Cell {
                pressure: *p,
                displacement: touch - h,
                touch: *touch,
                bounds: of(cell),
            });
            ResidualSums::of(cells, approach, terms.self_influence)
        })
    }

    /// Changes each pressure by as much as closes its gap on a cell of that compliance alone.
    pub(super) fn step_along_gap(&mut self, approach: Metre, compliance: f64) {
        self.pressure.zip_mut_with(&self.touch, |p, touch| *p += (approach - touch) / compliance);
    }

    /// Proposes p + (δ − h − u)·stiffness, where one diagonal Newton step takes each cell. Returns the range of the
    /// proposed pressures.
    pub(super) fn propose(&mut self, approach: Metre, stiffness: f64) -> Range {
        let cells = flat(&self.pressure).iter().zip(flat(&self.touch));
        for (y, (p, touch)) in flat_mut(&mut self.response).iter_mut().zip(cells) {
            *y = (p + (approach - touch) * stiffness) as f32;
        }
        Range::of(flat(&self.response), &self.site.bounds())
    }

    /// What the proposed pressures, offset and brought into their bounds, add up to, and how many are at neither bound.
    pub(super) fn proposed_sum(&self, offset: Pascal) -> [f64; 2] {
        sum_within(flat(&self.response), &self.site.bounds(), |y, bounds| {
            within(f64::from(y) + offset, bounds)
        })
    }

    /// Predicts the sets from the proposed pressures, offset.
    pub(super) fn predict_sets(&mut self, approach: Metre, stiffness: f64, offset: Pascal) {
        let cells = flat(&self.pressure).iter().zip(flat(&self.touch));
        let proposed = cells.map(|(p, touch)| p + (approach - touch) * stiffness + offset);
        self.sets.assign(proposed, &self.site.bounds());
        self.residual.fill(0.0);
        self.preconditioner.adapt(&self.sets);
    }

    /// Sets the direction to what takes the cells predicted at a bound there. Returns whether any is elsewhere.
    pub(super) fn direct_to_bounds(&mut self) -> bool {
        let mut any = false;
        let cells = flat_mut(&mut self.direction).iter_mut().zip(self.sets.of()).zip(flat(&self.pressure));
        with_bounds!(self.site.bounds(), of => {
            for (cell, ((d, set), p)) in cells.enumerate() {
                let distance = match set {
                    Set::Lower => of(cell).lower - p,
                    Set::Upper => of(cell).upper - p,
                    Set::Free => 0.0,
                };
                any |= distance != 0.0;
                *d = distance as f32;
            }
        });
        any
    }

    /// Predicts the residual of the free cells after the step along the direction, by the near field of its response. Returns
    /// its sum.
    pub(super) fn predict_residual(&mut self, approach: Metre) -> f64 {
        self.convolve_near_field();
        let (touch, predicted) = (flat(&self.touch), flat(&self.response));
        let residual = flat_mut(&mut self.residual);
        let mut sum = 0.0;
        for cell in self.sets.free() {
            let w = approach - touch[cell] - f64::from(predicted[cell]);
            sum += w;
            residual[cell] = w as f32;
        }
        sum
    }

    /// Computes C·d within [`NEAR_FIELD`] cells of where d is not zero, without a convolution.
    fn convolve_near_field(&mut self) {
        let [nx, ny] = self.site.grid().shape;
        let reach = [self.near.nrows() - 1, self.near.ncols() / 2];
        self.response.fill(0.0);
        let response = flat_mut(&mut self.response);
        for (cell, &pressure) in flat(&self.direction).iter().enumerate().filter(|(_, d)| **d != 0.0) {
            let (ix, iy) = (cell / ny, cell % ny);
            let (first, last) = (iy.saturating_sub(reach[1]), ny.min(iy + reach[1] + 1));
            for i in ix.saturating_sub(reach[0])..nx.min(ix + reach[0] + 1) {
                let near = self.near.row(i.abs_diff(ix)).to_slice().expect("rows are contiguous");
                let near = &near[first + reach[1] - iy..];
                let row = &mut response[i * ny..][first..last];
                row.iter_mut().zip(near).for_each(|(u, influence)| *u += influence * pressure);
            }
        }
    }

    /// Subtracts a mean from the residual of the free cells.
    pub(super) fn subtract_mean(&mut self, mean: f64) {
        let residual = flat_mut(&mut self.residual);
        self.sets.free().for_each(|cell| residual[cell] -= mean as f32);
    }

    /// Computes the preconditioned residual z = M r. Returns Σ z, Σ r and Σ r z.
    pub(super) fn precondition(&mut self) -> [f64; 3] {
        let (r, z) = (flat(&self.residual), flat_mut(&mut self.preconditioned));
        self.preconditioner.apply(&self.sets, r, z);
        let mut sums = [0.0; 3];
        for cell in self.sets.free() {
            let (r, z) = (f64::from(r[cell]), f64::from(z[cell]));
            sums = [sums[0] + z, sums[1] + r, sums[2] + r * z];
        }
        sums
    }

    /// Sets the direction of the free cells to the preconditioned residual without its mean, damped. Returns what the whole
    /// direction adds to Σ p, and what the free cells bear above their lower bounds.
    pub(super) fn direct_free_cells(&mut self, mean: f64, damping: f64) -> [f64; 2] {
        let (z, direction) = (flat(&self.preconditioned), flat_mut(&mut self.direction));
        let (damping, mean) = (damping as f32, mean as f32);
        self.sets.free().for_each(|cell| direction[cell] = damping * (z[cell] - mean));
        let p = flat(&self.pressure);
        let borne = with_bounds!(self.site.bounds(), of => {
            self.sets.free().map(|cell| of(cell).clamp(p[cell]) - of(cell).lower).sum()
        });
        let [added] = sums(direction, |_, d| [f64::from(d)]);
        [added, borne]
    }

    /// Subtracts from the direction of each free cell a uniform part, and one in proportion to the pressure above its lower
    /// bound: the direction then leaves the load as it is.
    pub(super) fn balance_direction(&mut self, each: f64, per_pressure: f64) {
        let (p, direction) = (flat(&self.pressure), flat_mut(&mut self.direction));
        with_bounds!(self.site.bounds(), of => {
            for cell in self.sets.free() {
                let borne = of(cell).clamp(p[cell]) - of(cell).lower;
                direction[cell] -= (each + per_pressure * borne) as f32;
            }
        });
    }

    /// Moves along the direction to the bounds; updates the displacement, too, by a convolution, if `convolved`.
    pub(super) fn step_to_bounds(&mut self, convolved: bool) {
        if convolved {
            self.convolve_direction();
            self.add_response();
        }
        let cells = flat_mut(&mut self.pressure).iter_mut().zip(flat(&self.direction)).zip(self.sets.of());
        with_bounds!(self.site.bounds(), of => {
            for (cell, ((p, d), set)) in cells.enumerate() {
                // Exactly at the bounds, whatever the rounding of the sum.
                *p = match set {
                    Set::Lower => of(cell).lower,
                    Set::Upper => of(cell).upper,
                    Set::Free => *p + f64::from(*d),
                };
            }
        });
    }

    /// Adds the same pressure to all free cells.
    pub(super) fn add_to_free_cells(&mut self, pressure: Pascal) {
        let p = flat_mut(&mut self.pressure);
        self.sets.free().for_each(|cell| p[cell] += pressure);
    }

    /// Sets the direction to zero. Returns Σ (h + u) of the free cells.
    pub(super) fn reset_direction(&mut self) -> f64 {
        self.direction.fill(0.0);
        let touch = flat(&self.touch);
        self.sets.free().map(|cell| touch[cell]).sum()
    }

    /// Updates the direction to the conjugate one, d = z − mean + β d, and computes C·d. Returns the curvature dᵀC d of the
    /// energy along it, and Σ C·d of the free cells.
    pub(super) fn update_direction(&mut self, mean: f64, beta: f64) -> [f64; 2] {
        let (z, d) = (flat(&self.preconditioned), flat_mut(&mut self.direction));
        let (mean, beta) = (mean as f32, beta as f32);
        self.sets.free().for_each(|cell| d[cell] = z[cell] - mean + beta * d[cell]);
        self.convolve_direction();
        let (d, c) = (flat(&self.direction), flat(&self.response));
        let (mut curvature, mut sum) = (0.0, 0.0);
        for cell in self.sets.free() {
            curvature += f64::from(d[cell]) * f64::from(c[cell]);
            sum += f64::from(c[cell]);
        }
        [curvature, sum]
    }

    /// Moves by `step` times the direction, in the pressure and its displacement, and computes the residual of the free
    /// cells, whose gap is to close at `datum`. Returns its norm and that of the violations of the bounds.
    pub(super) fn step_along_direction(&mut self, step: f64, datum: Metre, terms: &Terms) -> ResidualNorms {
        let c0 = terms.self_influence;
        let mut norms = ResidualNorms { datum, ..ResidualNorms::default() };
        let cells = self.sets.of().iter().zip(flat(&self.direction)).zip(flat(&self.response));
        let cells = cells.zip(flat_mut(&mut self.pressure)).zip(flat_mut(&mut self.touch));
        let cells = cells.zip(flat_mut(&mut self.residual)).enumerate();
        with_bounds!(self.site.bounds(), of => {
            for (cell, (((((set, d), c), p), touch), r)) in cells {
                *touch += step * f64::from(*c);
                let w = datum - *touch;
                let violation = match set {
                    Set::Lower => w.max(0.0),
                    Set::Upper => w.min(0.0),
                    Set::Free => {
                        *p += step * f64::from(*d);
                        *r = w as f32;
                        norms.residual += w * w;
                        norms.max_residual = norms.max_residual.max(w.abs());
                        c0 * (*p - of(cell).clamp(*p))
                    }
                };
                norms.violation += violation * violation;
            }
        });
        self.rounding += SINGLE_PRECISION * step * self.max_response;
        norms
    }

    /// Keeps the pressure as the last feasible one.
    pub(super) fn keep_feasible(&mut self) {
        self.feasible.assign(&self.pressure);
    }

    /// Convolves the last feasible pressure, for a line search from it.
    pub(super) fn convolve_feasible(&mut self) {
        let mut touch = Field::zeros(self.feasible.raw_dim());
        touch_under(self.site, &self.feasible, &mut touch);
        self.feasible_touch = Some(touch);
        self.convolutions += 1;
    }

    /// Slope and curvature of the energy, at an approach, along the line from the last feasible pressure to this one.
    pub(super) fn descent(&self, approach: Metre) -> [f64; 2] {
        let before = self.feasible_touch.as_ref().expect("the feasible pressure is convolved");
        let (mut slope, mut curvature) = (0.0, 0.0);
        let cells = flat(&self.feasible).iter().zip(flat(before)).zip(flat(&self.pressure));
        for (((p, before), target), touch) in cells.zip(flat(&self.touch)) {
            slope += (approach - before) * (target - p);
            curvature += (target - p) * (touch - before);
        }
        [slope, curvature]
    }

    /// Goes to the `share` of the line from the last feasible pressure to this one.
    pub(super) fn step_from_feasible(&mut self, share: f64) {
        let before = self.feasible_touch.as_ref().expect("the feasible pressure is convolved");
        let mix = |to: &mut f64, from: &f64| *to = from + share * (*to - from);
        self.pressure.zip_mut_with(&self.feasible, mix);
        self.touch.zip_mut_with(before, mix);
    }

    /// Ends a line search: its result is the last feasible pressure.
    pub(super) fn end_line_search(&mut self) {
        self.keep_feasible();
        self.feasible_touch = None;
    }
}

/// Computes the approaches h + u at which the cells touch under a `pressure`.
fn touch_under(site: &dyn Site, pressure: &Field, touch: &mut Field) {
    site.with_operator(&mut |operator| operator.apply(pressure, touch));
    *touch += &*site.initial_gap();
}

/// The values of a field by flat index.
fn flat<T>(field: &Array2<T>) -> &[T] {
    field.as_slice().expect("standard layout")
}

/// The values of a field by flat index, to be changed.
fn flat_mut<T>(field: &mut Array2<T>) -> &mut [T] {
    field.as_slice_mut().expect("standard layout")
}
