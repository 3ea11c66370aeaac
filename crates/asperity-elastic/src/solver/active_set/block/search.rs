//! Line searches of a block from its last feasible pressure.

use super::convolution::touch_under;
use super::{Block, zip};
use crate::grid::{Field, flat};
use crate::math::parallel;
use crate::ranks::Merged;
use crate::units::Metre;

impl Block<'_> {
    /// Stores the pressure as the last feasible one, with a near copy together with its h + u.
    pub(in crate::solver::active_set) fn keep_feasible(&mut self) {
        zip(self.bands, &mut self.feasible, &self.pressure, |feasible, p| *feasible = *p);
        if self.near {
            let touch = self.feasible_touch.get_or_insert_with(|| Field::zeros(self.feasible.raw_dim()));
            zip(self.bands, touch, &self.touch, |before, touch| *before = *touch);
            self.feasible_rounding = None;
        }
    }

    /// Convolves the last feasible pressure, for a line search from it. With a near copy its h + u is known.
    pub(in crate::solver::active_set) fn convolve_feasible(&mut self) {
        if self.near {
            return;
        }
        let mut touch = Field::zeros(self.feasible.raw_dim());
        touch_under(self.site, &self.feasible, &mut touch);
        self.feasible_touch = Some(touch);
        self.convolutions += 1;
    }

    /// Returns slope and curvature of the energy, at an approach, along the line from the last feasible
    /// pressure to the present one.
    pub(in crate::solver::active_set) fn descent(&self, approach: Metre) -> [f64; 2] {
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
    pub(in crate::solver::active_set) fn step_from_feasible(&mut self, share: f64) {
        let before = self.feasible_touch.as_ref().expect("the feasible pressure is convolved");
        let mix = |to: &mut f64, from: &f64| *to = from + share * (*to - from);
        zip(self.bands, &mut self.pressure, &self.feasible, mix);
        zip(self.bands, &mut self.touch, before, mix);
    }

    /// Ends a line search: its result is the last feasible pressure.
    pub(in crate::solver::active_set) fn end_line_search(&mut self) {
        self.keep_feasible();
        if !self.near {
            self.feasible_touch = None;
        }
    }
}
