//! One of the contacts that share an approach: a diagonal block of their influence matrix.

use ndarray::Array2;

use crate::grid::{Field, SingleField};
use crate::math::sum::sums;
use crate::solver::Terms;
use crate::solver::bounds::{Range, in_bounds};
use crate::solver::preconditioner::Preconditioner;
use crate::solver::residual::{Cell, Multiplier, Tally};
use crate::solver::sets::{Set, Sets};
use crate::solver::site::Site;
use crate::units::{Metre, Pascal};

/// Radius, in cells, within which the effect of lifted cells is foreseen without a convolution.
const FORESIGHT: usize = 4;
/// Error of a displacement in single precision, of its largest value.
const SINGLE: f64 = 4e-7;

/// Pressure and displacement are kept in double precision. What moves them from step to step, directions and their
/// responses, is computed in single, which is as good as long as the steps are small against what they correct; the
/// error that this leaves in the displacement is kept count of.
pub(super) struct Block<'a> {
    site: &'a dyn Site,
    preconditioner: Preconditioner,
    /// Current pressure, possibly a little outside its bounds.
    pressure: Field,
    /// h + u: the approach at which each cell touches.
    touch: Field,
    /// Bound on the error of the displacement by single precision.
    rounding: Metre,
    /// The last feasible pressure, from which the energy only falls, and h + u under it while that is needed.
    feasible: Field,
    touch_before: Option<Field>,
    sets: Sets,
    /// Scratch: a direction and its response.
    direction: SingleField,
    response: SingleField,
    /// Largest response.
    largest: f64,
    /// What is left of the equations of the free cells, and a step to meet them; zero elsewhere.
    equations: SingleField,
    step: SingleField,
    /// Influence coefficients up to [`FORESIGHT`] cells away: 0, 1 … along x, … −1, 0, 1 … along y.
    near: SingleField,
    /// c₀ where the boundary is periodic, else 0: there a displacement may be less than the rounding of its transforms.
    local: f64,
    convolutions: usize,
}

/// What a set of free cells leaves undone, as displacements: sums of the squares of w at the free cells and of the
/// violations of the bounds, and the largest w; the approach at which they were taken.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct LeftOver {
    pub(super) equations: f64,
    pub(super) bounds: f64,
    pub(super) largest: f64,
    pub(super) datum: Metre,
}

impl LeftOver {
    /// Of both.
    pub(super) fn and(self, other: Self) -> Self {
        Self {
            equations: self.equations + other.equations,
            bounds: self.bounds + other.bounds,
            largest: self.largest.max(other.largest),
            datum: self.datum,
        }
    }
}

impl<'a> Block<'a> {
    /// The contact at a site under a pressure that has not been convolved yet.
    pub(super) fn new(site: &'a dyn Site, pressure: Field) -> Self {
        let shape = site.grid().shape;
        let reach = shape.map(|n| FORESIGHT.min((n - 1) / 2));
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
            touch_before: None,
            sets: Sets::new(shape),
            direction: SingleField::zeros(shape),
            response: SingleField::zeros(shape),
            largest: 0.0,
            equations: SingleField::zeros(shape),
            step: SingleField::zeros(shape),
            near,
            local,
            convolutions: 0,
        }
    }

    pub(super) fn pressure(&self) -> &Field {
        &self.pressure
    }

    pub(super) fn pressure_mut(&mut self) -> &mut [Pascal] {
        flat_mut(&mut self.pressure)
    }

    pub(super) fn into_fields(self) -> (Field, Field) {
        let displacement = self.touch - &*self.site.initial_gap();
        (self.pressure, displacement)
    }

    pub(super) fn free_cells(&self) -> usize {
        self.sets.free().len()
    }

    pub(super) fn convolutions(&self) -> usize {
        self.convolutions
    }

    pub(super) fn rounding(&self) -> Metre {
        self.rounding
    }

    /// The displacement of the whole pressure.
    pub(super) fn respond(&mut self) {
        touch_under(self.site, &self.pressure, &mut self.touch);
        self.convolutions += 1;
        self.rounding = 0.0;
    }

    /// The displacement of the whole pressure, in single precision.
    pub(super) fn respond_in_single(&mut self) {
        self.direction.zip_mut_with(&self.pressure, |d, p| *d = *p as f32);
        self.respond_to_direction();
        self.touch.assign(&self.site.initial_gap());
        self.rounding = SINGLE * (self.local * self.largest_pressure() - self.largest).max(0.0);
        self.take_response();
    }

    fn respond_to_direction(&mut self) {
        let Self { site, direction, response, .. } = self;
        site.with_operator(&mut |operator| operator.apply_single(direction, response));
        self.largest = f64::from(response.iter().fold(0.0f32, |m, u| if u.abs() > m { u.abs() } else { m }));
        self.convolutions += 1;
    }

    fn take_response(&mut self) {
        self.touch.zip_mut_with(&self.response, |touch, r| *touch += f64::from(*r));
        self.rounding += SINGLE * self.largest;
    }

    /// Bound on the error of the displacement if it were computed in single precision.
    pub(super) fn rounding_in_single(&self) -> Metre {
        let gap = self.site.initial_gap();
        let largest =
            self.touch.iter().zip(&*gap).fold(0.0, |most, (touch, h)| f64::max(most, (touch - h).abs()));
        SINGLE * largest.max(self.local * self.largest_pressure())
    }

    fn largest_pressure(&self) -> Pascal {
        self.pressure.iter().fold(0.0, |most, p| f64::max(most, p.abs()))
    }

    /// Work and twice the elastic energy of the pressure at an approach.
    pub(super) fn work(&self, approach: Metre) -> [f64; 2] {
        let gap = self.site.initial_gap();
        let (mut work, mut twice_energy) = (0.0, 0.0);
        ndarray::Zip::from(&self.pressure).and(&self.touch).and(&*gap).for_each(|p, touch, h| {
            work += p * (approach - h);
            twice_energy += p * (touch - h);
        });
        [work, twice_energy]
    }

    /// Multiplies pressure and displacement.
    pub(super) fn scale(&mut self, factor: f64) {
        let gap = self.site.initial_gap();
        self.pressure *= factor;
        self.touch.zip_mut_with(&gap, |touch, h| *touch = h + factor * (*touch - h));
    }

    /// The approach that this contact asks for under load control.
    pub(super) fn multiplier(&self, hardness: Pascal) -> Multiplier {
        let cells = self.pressure.iter().zip(&self.touch);
        Multiplier::of(cells.map(|(p, touch)| Cell {
            pressure: *p,
            displacement: 0.0,
            touch: *touch,
            cap: hardness,
        }))
    }

    /// How far this contact is from equilibrium.
    pub(super) fn tally(&self, approach: Metre, terms: &Terms) -> Tally {
        let gap = self.site.initial_gap();
        let cells = self.pressure.iter().zip(&self.touch).zip(&*gap);
        let cells = cells.map(|((p, touch), h)| Cell {
            pressure: *p,
            displacement: touch - h,
            touch: *touch,
            cap: terms.hardness,
        });
        Tally::of(cells, approach, terms.self_influence)
    }

    /// One step along the gap.
    pub(super) fn step_along_gap(&mut self, approach: Metre, compliance: f64) {
        self.pressure.zip_mut_with(&self.touch, |p, touch| *p += (approach - touch) / compliance);
    }

    /// Proposes p + (δ − h − u)·stiffness, where one diagonal Newton step takes each cell. Returns the range of it.
    pub(super) fn propose(&mut self, approach: Metre, stiffness: f64) -> Range {
        let cells = flat(&self.pressure).iter().zip(flat(&self.touch));
        for (y, (p, touch)) in flat_mut(&mut self.response).iter_mut().zip(cells) {
            *y = (p + (approach - touch) * stiffness) as f32;
        }
        Range::of(flat(&self.response))
    }

    /// What the proposed pressure, shifted and in its bounds, adds up to, and how much of it is between them.
    pub(super) fn proposed_sum(&self, shift: Pascal, hardness: Pascal) -> [f64; 2] {
        sums(flat(&self.response), |y| in_bounds(f64::from(y) + shift, hardness))
    }

    /// Predicts the sets from that step, shifted.
    pub(super) fn predict(&mut self, approach: Metre, stiffness: f64, shift: Pascal, hardness: Pascal) {
        let cells = flat(&self.pressure).iter().zip(flat(&self.touch));
        self.sets.assign(cells.map(|(p, touch)| p + (approach - touch) * stiffness + shift), hardness);
        self.equations.fill(0.0);
        self.preconditioner.adapt(&self.sets);
    }

    /// Sets the direction to what takes the cells at a bound there; whether there is anything to move.
    pub(super) fn direct_to_bounds(&mut self, hardness: Pascal) -> bool {
        let mut any = false;
        let cells = flat_mut(&mut self.direction).iter_mut().zip(self.sets.of()).zip(flat(&self.pressure));
        for ((d, set), p) in cells {
            let distance = match set {
                Set::Zero => -p,
                Set::Hardness => hardness - p,
                Set::Free => 0.0,
            };
            any |= distance != 0.0;
            *d = distance as f32;
        }
        any
    }

    /// Sets the equations to what they will be when the direction has been taken, by what it does nearby. Returns their
    /// sum.
    pub(super) fn foresee(&mut self, approach: Metre) -> f64 {
        self.respond_nearby();
        let (touch, foreseen) = (flat(&self.touch), flat(&self.response));
        let equations = flat_mut(&mut self.equations);
        let mut sum = 0.0;
        for cell in self.sets.free() {
            let w = approach - touch[cell] - f64::from(foreseen[cell]);
            sum += w;
            equations[cell] = w as f32;
        }
        sum
    }

    /// Response to the direction within [`FORESIGHT`] cells of where it is not zero, without a convolution.
    fn respond_nearby(&mut self) {
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

    /// Takes a mean out of the equations.
    pub(super) fn centre(&mut self, mean: f64) {
        let equations = flat_mut(&mut self.equations);
        self.sets.free().for_each(|cell| equations[cell] -= mean as f32);
    }

    /// `step = M equations`. Returns the sums of the steps, of the equations, and of the products of both.
    pub(super) fn precondition(&mut self) -> [f64; 3] {
        let (r, z) = (flat(&self.equations), flat_mut(&mut self.step));
        self.preconditioner.apply(&self.sets, r, z);
        let mut sums = [0.0; 3];
        for cell in self.sets.free() {
            let (r, z) = (f64::from(r[cell]), f64::from(z[cell]));
            sums = [sums[0] + z, sums[1] + r, sums[2] + r * z];
        }
        sums
    }

    /// Adds the step, without its mean and damped, to the direction. Returns what the direction adds to Σ p, and the Σ p
    /// of the free cells.
    pub(super) fn direct(&mut self, mean: f64, damping: f64, hardness: Pascal) -> [f64; 2] {
        let (step, direction) = (flat(&self.step), flat_mut(&mut self.direction));
        let (damping, mean) = (damping as f32, mean as f32);
        self.sets.free().for_each(|cell| direction[cell] = damping * (step[cell] - mean));
        let p = flat(&self.pressure);
        let bearing = self.sets.free().map(|cell| p[cell].clamp(0.0, hardness)).sum();
        let [added] = sums(direction, |d| [f64::from(d)]);
        [added, bearing]
    }

    /// The free cells take up a change of the load: so much each, and so much in proportion to their pressure.
    pub(super) fn take_up(&mut self, each: f64, per_pressure: f64, hardness: Pascal) {
        let (p, direction) = (flat(&self.pressure), flat_mut(&mut self.direction));
        for cell in self.sets.free() {
            direction[cell] -= (each + per_pressure * p[cell].clamp(0.0, hardness)) as f32;
        }
    }

    /// Takes the direction, which ends at the bounds.
    pub(super) fn lift(&mut self, hardness: Pascal) {
        for ((p, d), set) in
            flat_mut(&mut self.pressure).iter_mut().zip(flat(&self.direction)).zip(self.sets.of())
        {
            // Exactly at the bounds, whatever the rounding of the sum.
            *p = match set {
                Set::Zero => 0.0,
                Set::Hardness => hardness,
                Set::Free => *p + f64::from(*d),
            };
        }
    }

    /// Adds the response to the direction to the displacement.
    pub(super) fn follow(&mut self) {
        self.respond_to_direction();
        self.take_response();
    }

    /// Adds a pressure to the free cells.
    pub(super) fn raise(&mut self, pressure: Pascal) {
        let p = flat_mut(&mut self.pressure);
        self.sets.free().for_each(|cell| p[cell] += pressure);
    }

    /// No direction. Returns Σ (h + u) of the free cells.
    pub(super) fn halt(&mut self) -> f64 {
        self.direction.fill(0.0);
        let touch = flat(&self.touch);
        self.sets.free().map(|cell| touch[cell]).sum()
    }

    /// `direction = step − mean + conjugate · direction`, and its response. Returns the curvature of the energy along it,
    /// and the sum of the response of the free cells.
    pub(super) fn conjugate(&mut self, mean: f64, conjugate: f64) -> [f64; 2] {
        let (z, d) = (flat(&self.step), flat_mut(&mut self.direction));
        let (mean, conjugate) = (mean as f32, conjugate as f32);
        self.sets.free().for_each(|cell| d[cell] = z[cell] - mean + conjugate * d[cell]);
        self.respond_to_direction();
        let (d, c) = (flat(&self.direction), flat(&self.response));
        let (mut curvature, mut sum) = (0.0, 0.0);
        for cell in self.sets.free() {
            curvature += f64::from(d[cell]) * f64::from(c[cell]);
            sum += f64::from(c[cell]);
        }
        [curvature, sum]
    }

    /// Moves by `step` times the direction, in the pressure and its displacement, and takes stock: the equations at
    /// the free cells, where the gap is to close at `datum`, and how far the bounds are violated.
    pub(super) fn advance(&mut self, step: f64, datum: Metre, terms: &Terms) -> LeftOver {
        let Terms { hardness, self_influence: c0, .. } = *terms;
        let mut left = LeftOver { datum, ..LeftOver::default() };
        let cells = self.sets.of().iter().zip(flat(&self.direction)).zip(flat(&self.response));
        let cells = cells.zip(flat_mut(&mut self.pressure)).zip(flat_mut(&mut self.touch));
        for (((((set, d), c), p), touch), r) in cells.zip(flat_mut(&mut self.equations)) {
            *touch += step * f64::from(*c);
            let w = datum - *touch;
            let violation = match set {
                Set::Zero => w.max(0.0),
                Set::Hardness => w.min(0.0),
                Set::Free => {
                    *p += step * f64::from(*d);
                    *r = w as f32;
                    left.equations += w * w;
                    left.largest = left.largest.max(w.abs());
                    c0 * (*p - p.clamp(0.0, hardness))
                }
            };
            left.bounds += violation * violation;
        }
        self.rounding += SINGLE * step * self.largest;
        left
    }

    /// Keeps the pressure, which is feasible.
    pub(super) fn keep(&mut self) {
        self.feasible.assign(&self.pressure);
    }

    /// The displacement of the pressure that was kept.
    pub(super) fn recall(&mut self) {
        let mut touch = Field::zeros(self.feasible.raw_dim());
        touch_under(self.site, &self.feasible, &mut touch);
        self.touch_before = Some(touch);
        self.convolutions += 1;
    }

    /// Slope and curvature of the energy, at an approach, on the way from the pressure that was recalled to this one.
    pub(super) fn descent(&self, approach: Metre) -> [f64; 2] {
        let before = self.touch_before.as_ref().expect("recalled");
        let (mut slope, mut curvature) = (0.0, 0.0);
        let cells = flat(&self.feasible).iter().zip(flat(before)).zip(flat(&self.pressure));
        for (((p, before), target), touch) in cells.zip(flat(&self.touch)) {
            slope += (approach - before) * (target - p);
            curvature += (target - p) * (touch - before);
        }
        [slope, curvature]
    }

    /// Goes so far on the way from the pressure that was recalled to this one.
    pub(super) fn go_back(&mut self, share: f64) {
        let before = self.touch_before.as_ref().expect("recalled");
        let mix = |to: &mut f64, from: &f64| *to = from + share * (*to - from);
        self.pressure.zip_mut_with(&self.feasible, mix);
        self.touch.zip_mut_with(before, mix);
    }

    /// Forgets what was recalled.
    pub(super) fn forget(&mut self) {
        self.touch_before = None;
    }
}

/// Writes h + u under `pressure` into `touch`.
fn touch_under(site: &dyn Site, pressure: &Field, touch: &mut Field) {
    site.with_operator(&mut |operator| operator.apply(pressure, touch));
    *touch += &*site.initial_gap();
}

fn flat<T>(field: &Array2<T>) -> &[T] {
    field.as_slice().expect("standard layout")
}

fn flat_mut<T>(field: &mut Array2<T>) -> &mut [T] {
    field.as_slice_mut().expect("standard layout")
}
