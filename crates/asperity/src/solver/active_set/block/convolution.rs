//! Displacements of a block: by the operator in double or single precision, or by its near copy.

use ndarray::Array2;

use super::{Block, flat, flat_mut, zip};
use crate::grid::{Field, SingleField};
use crate::math::{Bands, parallel};
use crate::ranks::{Largest, Merged};
use crate::solver::SINGLE_PRECISION;
use crate::solver::bounds::with_bounds;
use crate::solver::residual::{Cell, Multiplier};
use crate::units::{Metre, Pascal};

impl Block<'_> {
    /// Computes the displacement from the total pressure in double precision. The fields in single precision, which are
    /// no longer needed, free memory for it and for the transforms.
    pub(in crate::solver::active_set) fn convolve(&mut self) {
        let shape = self.pressure.raw_dim();
        for field in [&mut self.direction, &mut self.response, &mut self.residual] {
            *field = SingleField::default([0, 0]);
        }
        let mut displacement = self.displacement.take().unwrap_or_else(|| Field::zeros(shape));
        self.site.with_operator(&mut |operator| {
            operator.apply(&self.pressure, &mut displacement);
            operator.release();
        });
        self.residual = SingleField::zeros(shape);
        let gap = self.site.initial_gap();
        residual_under(self.bands, &gap, &displacement, self.datum, &mut self.residual);
        self.displacement = Some(displacement);
        self.convolutions += 1;
        self.rounding = 0.0;
    }

    /// Gives up the displacement in double precision for a direction and its response.
    pub(in crate::solver::active_set) fn prepare_steps(&mut self) {
        self.displacement = None;
        let shape = self.pressure.raw_dim();
        for field in [&mut self.direction, &mut self.response] {
            if field.is_empty() {
                *field = SingleField::zeros(shape);
            }
        }
    }

    /// Computes the displacement from the total pressure in single precision.
    pub(in crate::solver::active_set) fn convolve_in_single(&mut self) {
        self.respond_to_pressure();
        self.refer_to(self.datum);
    }

    /// Computes the response of the total pressure in single precision, its displacement.
    pub(in crate::solver::active_set) fn respond_to_pressure(&mut self) {
        self.prepare_steps();
        zip(self.bands, &mut self.direction, &self.pressure, |d, p| *d = *p as f32);
        self.convolve_direction();
        let local = (self.local * self.largest_pressure() - self.max_response).max(0.0);
        self.rounding = SINGLE_PRECISION * (local + self.max_response);
    }

    /// Returns the contribution of this contact to the multiplier of the load, if the response is the displacement.
    pub(in crate::solver::active_set) fn multiplier_of_response(&self) -> Multiplier {
        let (gap, bounds) = (self.site.initial_gap(), self.site.bounds());
        let bands = self.bands.cut(flat(&self.pressure)).zip(self.bands.cut(flat(&self.response)));
        let bands = bands.zip(self.bands.cut(flat(&gap))).enumerate();
        let parts = parallel::map(bands, |(band, ((pressure, response), gap))| {
            let first = self.bands.first(band);
            let cells = pressure.iter().zip(response).zip(gap).enumerate();
            with_bounds!(bounds, of => {
                Multiplier::of(cells.map(|(cell, ((p, u), h))| Cell {
                    pressure: *p,
                    displacement: 0.0,
                    touch: h + f64::from(*u),
                    bounds: of(first + cell),
                }))
            })
        });
        Merged::of_parts(parts)
    }

    /// Computes the residual at an approach, if the response is the displacement.
    pub(in crate::solver::active_set) fn refer_to(&mut self, approach: Metre) {
        let gap = self.site.initial_gap();
        residual_under(self.bands, &gap, &self.response, approach, &mut self.residual);
        self.datum = approach;
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
        let largest = |part: &[f32]| part.iter().fold(0.0f32, |m, u| if u.abs() > m { u.abs() } else { m });
        let parts = parallel::map(self.bands.cut(flat(response)), largest);
        // The rounding of transforms depends on the largest value on the whole grid.
        Largest(self.max_response) =
            self.slab.merged(Largest(f64::from(parts.into_iter().fold(0.0, f32::max))));
    }

    /// Computes the displacement with the near copy, from the change of the pressure since the last feasible one.
    pub(in crate::solver::active_set) fn convolve_change(&mut self) {
        self.direct_to_pressure();
        self.convolve_direction();
        self.add_to_feasible();
    }

    /// Computes the displacement of a feasible pressure with the operator itself, in single precision if its error is below
    /// `max_rounding`. After the first time only the change of the pressure is convolved.
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
        let (base, datum) = self.feasible_residual.as_mut().expect("kept with a near copy");
        let parts = bands.cut_mut(flat_mut(&mut self.residual)).zip(bands.cut_mut(flat_mut(base)));
        let to_datum = (self.datum - *datum) as f32;
        parallel::map(parts.zip(bands.cut(flat(&self.response))), |((residual, base), response)| {
            for ((r, base), response) in residual.iter_mut().zip(base).zip(response) {
                *base += to_datum - response;
                *r = *base;
            }
        });
        *datum = self.datum;
        let local = self.local * f64::from(largest.into_iter().fold(0.0, f32::max));
        self.rounding = before + SINGLE_PRECISION * self.max_response.max(local);
        self.rounding
    }

    /// Ends the use of the near copy.
    pub(in crate::solver::active_set) fn leave_near_copy(&mut self) {
        self.near = false;
        self.feasible_residual = None;
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

    /// Sets the residual to that of the last feasible pressure and the response C·d of the direction.
    fn add_to_feasible(&mut self) {
        let (before, datum) = self.feasible_residual.as_ref().expect("kept with a near copy");
        zip(self.bands, &mut self.residual, before, |r, before| *r = *before);
        self.datum = *datum;
        self.add_response();
    }

    /// Adds the response C·d to the displacement.
    pub(super) fn add_response(&mut self) {
        zip(self.bands, &mut self.residual, &self.response, |r, response| *r -= response);
        self.rounding += SINGLE_PRECISION * self.max_response;
    }

    /// Returns the error bound of a displacement computed in single precision.
    pub(in crate::solver::active_set) fn rounding_in_single(&self) -> Metre {
        let gap = self.site.initial_gap();
        let bands = self.bands.cut(flat(&self.residual)).zip(self.bands.cut(flat(&gap)));
        let parts = parallel::map(bands, |(residual, gap)| {
            let displacements = residual.iter().zip(gap).map(|(r, h)| self.touch(*r) - h);
            displacements.fold(0.0, |most, u| f64::max(most, u.abs()))
        });
        let largest = parts.into_iter().fold(0.0, f64::max);
        SINGLE_PRECISION * largest.max(self.local * self.largest_pressure())
    }

    /// Returns the approach h + u at which a cell with this residual touches.
    #[inline]
    pub(super) fn touch(&self, residual: f32) -> Metre {
        self.datum - f64::from(residual)
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
    pub(in crate::solver::active_set) fn work(&self, approach: Metre) -> [f64; 2] {
        let gap = self.site.initial_gap();
        let bands = self.bands.cut(flat(&self.pressure)).zip(self.bands.cut(flat(&self.residual)));
        Merged::of_parts(parallel::map(
            bands.zip(self.bands.cut(flat(&gap))),
            |((pressure, residual), gap)| {
                let mut sums = [0.0; 2];
                for ((p, r), h) in pressure.iter().zip(residual).zip(gap) {
                    sums = [sums[0] + p * (approach - h), sums[1] + p * (self.touch(*r) - h)];
                }
                sums
            },
        ))
    }

    /// Multiplies pressure and displacement by a factor.
    pub(in crate::solver::active_set) fn scale(&mut self, factor: f64) {
        let (gap, datum) = (self.site.initial_gap(), self.datum);
        self.pressure *= factor;
        zip(self.bands, &mut self.residual, &gap, |r, h| {
            let displacement = datum - f64::from(*r) - h;
            *r = (datum - h - factor * displacement) as f32;
        });
        self.displacement = None;
    }
}

/// Computes the residual δ − h − u at an approach δ.
pub(super) fn residual_under<U: Copy + Into<f64> + Sync>(
    bands: Bands,
    gap: &Field,
    displacement: &Array2<U>,
    approach: Metre,
    residual: &mut SingleField,
) {
    let parts = bands.cut_mut(flat_mut(residual)).zip(bands.cut(flat(gap)));
    parallel::map(parts.zip(bands.cut(flat(displacement))), |((residual, gap), displacement)| {
        for ((r, h), u) in residual.iter_mut().zip(gap).zip(displacement) {
            *r = (approach - h - (*u).into()) as f32;
        }
    });
}
