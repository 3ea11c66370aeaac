//! Functional parameters, from the areal material ratio curve.

use super::bearing::BearingCurve;
use super::row::family;
use super::stratified::Core;
use crate::Topography;

family! {
    /// Functional parameters of ISO 25178-2:2021, 4.5, from the [`BearingCurve`] of the defined samples, at
    /// the default ratios of ISO 25178-3.
    ///
    /// NaN without a defined sample; those of the core also without a core.
    FunctionalParameters: "functional" {
        /// Core height.
        ///
        /// Drop of the equivalent line from the ratio 0 to 1: [`BearingCurve::core`].
        sk: Length as "Sk",
        /// Reduced peak height above the core.
        spk: Length as "Spk",
        /// Reduced pit depth below the core.
        svk: Length as "Svk",
        /// Material ratio of the peaks, at the upper end of the core.
        smrk1: Share as "Smrk1",
        /// Material ratio without the pits, at the lower end of the core.
        smrk2: Share as "Smrk2",
        /// Height of the highest peak above the core.
        spkx: Length as "Spkx",
        /// Depth of the deepest pit below the core.
        svkx: Length as "Svkx",
        /// Material above the core.
        sak1: VolumePerArea as "Sak1",
        /// Void below the core.
        sak2: VolumePerArea as "Sak2",
        /// Height at a material ratio of 10 %, from the mean.
        smc: Length as "Smc",
        /// Peak extreme height, between the material ratios 2.5 % and 50 %.
        ///
        /// Sdc(2.5 %, 50 %); the edition of 2012 has it under this symbol.
        sxp: Length as "Sxp",
        /// Peak material volume, above the material ratio 10 %.
        vmp: VolumePerArea as "Vmp",
        /// Core material volume, between the material ratios 10 % and 80 %.
        ///
        /// Vm(80 %) − Vm(10 %).
        vmc: VolumePerArea as "Vmc",
        /// Core void volume, between the material ratios 10 % and 80 %.
        ///
        /// Vv(10 %) − Vv(80 %).
        vvc: VolumePerArea as "Vvc",
        /// Pit void volume, below the material ratio 80 %.
        vvv: VolumePerArea as "Vvv",
    }
}

/// Material ratios between which the core lies, for volumes.
const PEAKS: f64 = 0.1;
const PITS: f64 = 0.8;

impl FunctionalParameters {
    /// Computes the functional parameters of `topography`.
    pub fn new(topography: &Topography) -> Self {
        topography.bearing_curve().map_or_else(|_| Self::undefined(), |curve| Self::from_curve(&curve))
    }

    /// Computes the functional parameters of a curve.
    pub fn from_curve(curve: &BearingCurve) -> Self {
        let core = curve.core();
        let core = |pick: fn(&Core) -> f64| core.as_ref().map_or(f64::NAN, pick);
        Self {
            sk: core(|core| core.k),
            spk: core(|core| core.pk),
            svk: core(|core| core.vk),
            smrk1: core(|core| core.mrk1),
            smrk2: core(|core| core.mrk2),
            spkx: core(|core| core.pkx),
            svkx: core(|core| core.vkx),
            sak1: core(|core| core.ak1),
            sak2: core(|core| core.ak2),
            smc: curve.height(0.1),
            sxp: curve.height(0.025) - curve.height(0.5),
            vmp: curve.material_volume(PEAKS),
            vmc: curve.material_volume(PITS) - curve.material_volume(PEAKS),
            vvc: curve.void_volume(PEAKS) - curve.void_volume(PITS),
            vvv: curve.void_volume(PITS),
        }
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;
    use crate::Form;
    use asperity_base::grid::Grid;

    #[test]
    fn a_slope_of_uniform_heights_has_the_volumes_of_triangles() {
        // A ramp of height 1: p²/2 lies above the ratio p, (1 − p)²/2 below it.
        let grid = Grid::new([2000, 3], [5e-4, 1.0]).unwrap();
        let mut ramp = Form::Flat.on(&grid).unwrap();
        ramp.heights_mut().indexed_iter_mut().for_each(|((ix, _), z)| *z = grid.centre(0, ix));
        let parameters = FunctionalParameters::new(&ramp);
        // Each height occurs three times: the curve has an error of a third of a step.
        let near = 1.0 / 2000.0;
        assert_relative_eq!(parameters.sk, 1.0, max_relative = 5.0 * near);
        assert_relative_eq!(parameters.smc, 0.4, max_relative = 2.5 * near);
        assert_relative_eq!(parameters.sxp, 0.475, max_relative = 4.0 * near);
        assert_relative_eq!(parameters.vmp, 0.005, max_relative = 20.0 * near);
        assert_relative_eq!(parameters.vmc, 0.32 - 0.005, max_relative = 4.0 * near);
        assert_relative_eq!(parameters.vvc, 0.405 - 0.02, max_relative = 4.0 * near);
        assert_relative_eq!(parameters.vvv, 0.02, max_relative = 20.0 * near);
    }
}
