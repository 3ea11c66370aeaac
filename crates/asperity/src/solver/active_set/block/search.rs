//! Line searches of a block from its last feasible pressure.

use super::convolution::residual_under;
use super::{Block, flat, zip};
use crate::grid::{Field, SingleField};
use crate::math::parallel;
use crate::ranks::Merged;
use crate::units::Metre;

impl Block<'_> {
    /// Stores the pressure as the last feasible one, with a near copy together with its residual.
    pub(in crate::solver::active_set) fn keep_feasible(&mut self) {
        zip(self.bands, &mut self.feasible, &self.pressure, |feasible, p| *feasible = *p);
        if self.near {
            let shape = self.residual.raw_dim();
            let (kept, datum) =
                self.feasible_residual.get_or_insert_with(|| (SingleField::zeros(shape), 0.0));
            zip(self.bands, kept, &self.residual, |kept, r| *kept = *r);
            *datum = self.datum;
            self.feasible_rounding = None;
        }
    }

    /// Convolves the last feasible pressure, for a line search from it. With a near copy its residual is known.
    pub(in crate::solver::active_set) fn convolve_feasible(&mut self) {
        if self.near {
            return;
        }
        let shape = self.feasible.raw_dim();
        let (mut displacement, mut residual) = (Field::zeros(shape), SingleField::zeros(shape));
        self.site.with_operator(&mut |operator| operator.apply(&self.feasible, &mut displacement));
        residual_under(self.bands, &self.site.initial_gap(), &displacement, self.datum, &mut residual);
        self.feasible_residual = Some((residual, self.datum));
        self.convolutions += 1;
    }

    /// Returns slope and curvature of the energy, at an approach, along the line from the last feasible pressure
    /// to the present one.
    pub(in crate::solver::active_set) fn descent(&self, approach: Metre) -> [f64; 2] {
        let (before, datum) = self.feasible_residual.as_ref().expect("the feasible pressure is convolved");
        let (to_approach, between) = (approach - datum, self.datum - datum);
        let bands = self.bands.cut(flat(&self.feasible)).zip(self.bands.cut(flat(before)));
        let bands = bands.zip(self.bands.cut(flat(&self.pressure))).zip(self.bands.cut(flat(&self.residual)));
        Merged::of_parts(parallel::map(bands, |(((feasible, before), pressure), residual)| {
            let (mut slope, mut curvature) = (0.0, 0.0);
            for (((p, before), target), r) in feasible.iter().zip(before).zip(pressure).zip(residual) {
                let [before, r] = [*before, *r].map(f64::from);
                slope += (to_approach + before) * (target - p);
                curvature += (target - p) * (between + before - r);
            }
            [slope, curvature]
        }))
    }

    /// Moves to the fraction `share` of the line from the last feasible pressure to the present one.
    pub(in crate::solver::active_set) fn step_from_feasible(&mut self, share: f64) {
        let (before, datum) = self.feasible_residual.as_ref().expect("the feasible pressure is convolved");
        let between = self.datum - datum;
        zip(self.bands, &mut self.pressure, &self.feasible, |to, from| *to = from + share * (*to - from));
        zip(self.bands, &mut self.residual, before, |to, from| {
            let from = f64::from(*from) + between;
            *to = (from + share * (f64::from(*to) - from)) as f32;
        });
        self.displacement = None;
    }

    /// Ends a line search: its result is the last feasible pressure.
    pub(in crate::solver::active_set) fn end_line_search(&mut self) {
        self.keep_feasible();
        if !self.near {
            self.feasible_residual = None;
        }
    }
}
