//! Displacements of a block: by the operator in double or single precision, or by its near copy.

use super::{Block, zip};
use crate::grid::{Field, SingleField, flat, flat_mut};
use crate::math::{largest, parallel};
use crate::ranks::{Largest, Merged};
use crate::solver::SINGLE_PRECISION;
use crate::solver::site::Site;
use crate::units::{Metre, Pascal};

impl Block<'_> {
    /// Computes h + u from the total pressure in double precision. Direction and response, which are no
    /// longer needed, free memory for the transforms.
    pub(in crate::solver::active_set) fn convolve(&mut self) {
        (self.direction, self.response) = Default::default();
        touch_under(self.site, &self.pressure, &mut self.touch);
        self.site.with_operator(&mut |operator| operator.release());
        let shape = self.touch.raw_dim();
        (self.direction, self.response) = (SingleField::zeros(shape), SingleField::zeros(shape));
        self.convolutions += 1;
        self.rounding = 0.0;
    }

    /// Computes h + u from the total pressure in single precision.
    pub(in crate::solver::active_set) fn convolve_in_single(&mut self) {
        zip(self.bands, &mut self.direction, &self.pressure, |d, p| *d = *p as f32);
        self.convolve_direction();
        let gap = self.site.initial_gap();
        zip(self.bands, &mut self.touch, &gap, |touch, h| *touch = *h);
        self.rounding =
            SINGLE_PRECISION * (self.local * self.largest_pressure() - self.max_response).max(0.0);
        self.add_response();
    }

    /// Computes the response C·d of the direction, with a near copy that of this copy.
    pub(super) fn convolve_direction(&mut self) {
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
        let parts = parallel::map(self.bands.cut(flat(response)), |part| largest(part, |_, u: f32| u.abs()));
        // The rounding of transforms depends on the largest value on the whole grid.
        Largest(self.max_response) =
            self.slab.merged(Largest(f64::from(parts.into_iter().fold(0.0, f32::max))));
    }

    /// Computes h + u with the near copy, from the change of the pressure since the last feasible one.
    pub(in crate::solver::active_set) fn convolve_change(&mut self) {
        self.direct_to_pressure();
        self.convolve_direction();
        self.add_to_feasible();
    }

    /// Computes h + u of a feasible pressure with the operator itself, in single precision if its error is
    /// below `max_rounding`. After the first time only the change of the pressure is convolved.
    pub(in crate::solver::active_set) fn correct(&mut self, max_rounding: Metre) {
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

    /// Convolves the change since the last feasible pressure, whose error bound was `before`, and makes the
    /// present pressure the last feasible one. Returns the new error bound.
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
    pub(in crate::solver::active_set) fn leave_near_copy(&mut self) {
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
    pub(in crate::solver::active_set) fn rounding_in_single(&self) -> Metre {
        let gap = self.site.initial_gap();
        let bands = self.bands.cut(flat(&self.touch)).zip(self.bands.cut(flat(&gap)));
        let parts = parallel::map(bands, |(touch, gap)| {
            largest(&touch[..gap.len()], |cell, touch: f64| (touch - gap[cell]).abs())
        });
        let largest = parts.into_iter().fold(0.0, f64::max);
        SINGLE_PRECISION * largest.max(self.local * self.largest_pressure())
    }

    /// Largest |p|.
    fn largest_pressure(&self) -> Pascal {
        let parts = parallel::map(self.bands.cut(flat(&self.pressure)), |pressure| {
            largest(pressure, |_, p: f64| p.abs())
        });
        self.slab.merged(Largest(parts.into_iter().fold(0.0, f64::max))).0
    }

    /// Returns the work Σ p (δ − h) of the pressure at an approach, and twice its elastic energy, Σ p u, both
    /// per cell area.
    pub(in crate::solver::active_set) fn work(&self, approach: Metre) -> [f64; 2] {
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
    pub(in crate::solver::active_set) fn scale(&mut self, factor: f64) {
        let gap = self.site.initial_gap();
        self.pressure *= factor;
        zip(self.bands, &mut self.touch, &gap, |touch, h| *touch = h + factor * (*touch - h));
    }
}

/// Computes the approaches h + u at which the cells touch under a `pressure`.
pub(super) fn touch_under(site: &dyn Site, pressure: &Field, touch: &mut Field) {
    site.with_operator(&mut |operator| operator.apply(pressure, touch));
    *touch += &*site.initial_gap();
}
