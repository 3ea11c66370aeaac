//! Profile parameters of ISO 21920-2.

use super::Profile;
use super::elements::{Discrimination, elements};
use crate::parameters::row::family;
use crate::parameters::slope::{REACH, derivative};
use crate::parameters::{Core, HeightParameters, area_excess};

family! {
    /// Profile parameters of ISO 21920-2:2021 over the defined samples, with heights relative to their mean.
    ///
    /// The letter R is that of a roughness profile; a primary profile has Pa, Pq, …, a waviness Wa, Wq, ….
    /// Rp, Rv, Rz are means over sections. A roughness profile has sections of the length λc from its start,
    /// and a shorter remainder is ignored. Any other profile, and one shorter than λc, is one section. An
    /// undefined parameter is NaN.
    ProfileParameters: "profile" {
        /// Arithmetic mean height, ⟨|z|⟩.
        ra: Length as "Ra",
        /// Root mean square height, √⟨z²⟩.
        rq: Length as "Rq",
        /// Skewness, ⟨z³⟩/Rq³; 0 for Gaussian heights.
        rsk: Number as "Rsk",
        /// Kurtosis, ⟨z⁴⟩/Rq⁴; 3 for Gaussian heights.
        rku: Number as "Rku",
        /// Highest peak above the mean line, mean over the sections.
        rp: Length as "Rp",
        /// Deepest pit below the mean line, positive, mean over the sections.
        rv: Length as "Rv",
        /// Maximum height, Rp + Rv.
        rz: Length as "Rz",
        /// Total height, from the lowest to the highest sample of the whole profile.
        rt: Length as "Rt",
        /// Mean height of the profile elements.
        ///
        /// An element is a hill with the dale beside it, between crossings of the mean line. It counts if the
        /// hill is higher than 10 % of Rp, the dale deeper than 10 % of Rv, and each wider than 1 % of a
        /// section.
        rc: Length as "Rc",
        /// Mean spacing of the profile elements.
        rsm: Length as "Rsm",
        /// Peak count, 1/Rsm.
        rpc: PerLength as "Rpc",
        /// Root mean square gradient, √⟨(dz/dx)²⟩.
        ///
        /// The derivative is that of [`HybridParameters`](crate::HybridParameters).
        rdq: Number as "Rdq",
        /// Arithmetic mean gradient, ⟨|dz/dx|⟩.
        rda: Number as "Rda",
        /// Steepest gradient, max |dz/dx|.
        rdt: Number as "Rdt",
        /// Developed length, ∫√(1 + (dz/dx)²) dx.
        rdl: Length as "Rdl",
        /// Developed length ratio, ⟨√(1 + (dz/dx)²) − 1⟩.
        rdr: Share as "Rdr",
        /// Core height.
        ///
        /// By [`BearingCurve::core`](crate::BearingCurve::core), as all below.
        rk: Length as "Rk",
        /// Reduced peak height above the core.
        rpk: Length as "Rpk",
        /// Reduced pit depth below the core.
        rvk: Length as "Rvk",
        /// Material ratio of the peaks, at the upper end of the core.
        rmrk1: Share as "Rmrk1",
        /// Material ratio without the pits, at the lower end of the core.
        rmrk2: Share as "Rmrk2",
        /// Height of the highest peak above the core.
        rpkx: Length as "Rpkx",
        /// Depth of the deepest pit below the core.
        rvkx: Length as "Rvkx",
        /// Area of the peaks above the core, m² per metre.
        rak1: Length as "Rak1",
        /// Area of the pits below the core, m² per metre.
        rak2: Length as "Rak2",
    }
}

impl ProfileParameters {
    /// Returns the mean of each parameter over the profiles for which it is defined.
    pub fn mean(profiles: &[Self]) -> Self {
        Self::from_each(|parameter| {
            let defined = || profiles.iter().map(parameter).filter(|value| !value.is_nan());
            defined().sum::<f64>() / defined().count() as f64
        })
    }
}

impl Profile {
    /// Computes the ISO 21920 parameters of the profile as it is; for roughness parameters, use
    /// [`Profile::roughness`] first.
    pub fn parameters(&self) -> ProfileParameters {
        let height = HeightParameters::from_samples(&self.heights);
        let Sections { peak, pit, samples } = self.sections();
        let Slopes { square, absolute, steepest, excess } = self.slopes();
        let [spacing, element_height] = self.mean_element(peak, pit, samples);
        let core = self.bearing_curve().ok().and_then(|curve| curve.core());
        let core = |pick: fn(&Core) -> f64| core.as_ref().map_or(f64::NAN, pick);
        ProfileParameters {
            ra: height.sa,
            rq: height.sq,
            rsk: height.ssk,
            rku: height.sku,
            rp: peak,
            rv: pit,
            rz: peak + pit,
            rt: height.sz,
            rc: element_height,
            rsm: spacing,
            rpc: 1.0 / spacing,
            rdq: square.sqrt(),
            rda: absolute,
            rdt: steepest,
            rdl: self.length() * (1.0 + excess),
            rdr: excess,
            rk: core(|core| core.k),
            rpk: core(|core| core.pk),
            rvk: core(|core| core.vk),
            rmrk1: core(|core| core.mrk1),
            rmrk2: core(|core| core.mrk2),
            rpkx: core(|core| core.pkx),
            rvkx: core(|core| core.vkx),
            rak1: core(|core| core.ak1),
            rak2: core(|core| core.ak2),
        }
    }

    /// Returns the mean over the sections of the highest peak and of the deepest pit.
    fn sections(&self) -> Sections {
        let n = self.heights.len();
        let samples = self.section.map_or(n as f64, |length| length / self.pitch).min(n as f64);
        let begin = |section: usize| (section as f64 * samples).round() as usize;
        // Number of whole sections, within round-off.
        let whole = (n as f64 / samples + 1e-9) as usize;
        let mean = self.mean();
        let extreme = |pick: fn(f64, f64) -> f64| {
            let each = (0..whole).map(|section| &self.heights[begin(section)..begin(section + 1).min(n)]);
            let defined: Vec<f64> =
                each.map(|part| part.iter().copied().fold(f64::NAN, pick)).filter(|z| !z.is_nan()).collect();
            defined.iter().sum::<f64>() / defined.len() as f64 - mean
        };
        Sections { peak: extreme(f64::max), pit: -extreme(f64::min), samples }
    }

    fn slopes(&self) -> Slopes {
        let z = &self.heights;
        let inner = REACH..z.len().saturating_sub(REACH);
        let slopes = inner.map(|i| derivative(|k| z[i + k] - z[i - k], self.pitch));
        let slopes: Vec<f64> = slopes.filter(|slope| !slope.is_nan()).collect();
        let mean =
            |value: fn(f64) -> f64| slopes.iter().copied().map(value).sum::<f64>() / slopes.len() as f64;
        Slopes {
            square: mean(|slope| slope * slope),
            absolute: mean(f64::abs),
            steepest: slopes.iter().fold(f64::NAN, |steepest, slope| slope.abs().max(steepest)),
            excess: mean(|slope| area_excess(slope * slope)),
        }
    }

    /// Returns the mean spacing and height of the elements, with `samples` in a section of mean `peak` and
    /// `pit`.
    fn mean_element(&self, peak: f64, pit: f64, samples: f64) -> [f64; 2] {
        let mean = self.mean();
        let from_mean: Vec<f64> = self.heights.iter().map(|z| z - mean).collect();
        let discrimination = Discrimination { hill: 0.1 * peak, dale: 0.1 * pit, width: 0.01 * samples };
        let found = elements(&from_mean, &discrimination);
        let count = found.len() as f64;
        let spacing = found.iter().map(|element| element.spacing).sum::<f64>() / count;
        [self.pitch * spacing, found.iter().map(|element| element.height).sum::<f64>() / count]
    }

    fn mean(&self) -> f64 {
        let defined = || self.heights.iter().filter(|z| !z.is_nan());
        defined().sum::<f64>() / defined().count() as f64
    }
}

struct Sections {
    peak: f64,
    pit: f64,
    /// Number of samples in one section.
    samples: f64,
}

/// Means over the samples that have a slope.
struct Slopes {
    square: f64,
    absolute: f64,
    steepest: f64,
    excess: f64,
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use approx::{assert_abs_diff_eq, assert_relative_eq};

    use super::*;
    use crate::{Axis, Topography};
    use asperity_base::grid::{Field, Grid};

    fn profile(n: usize, height: impl Fn(f64) -> f64) -> Profile {
        Profile::new(0.01, (0..n).map(|i| height(0.01 * (i as f64 + 0.5))).collect()).unwrap()
    }

    #[test]
    fn a_sinusoid_has_its_textbook_parameters() {
        // Eight waves of 100 samples.
        let parameters = profile(800, |x| 0.5 * (TAU * x).sin()).parameters();
        let step = PI / 100.0;
        assert_relative_eq!(parameters.ra, 1.0 / PI, max_relative = step * step);
        assert_relative_eq!(parameters.rq, 0.5 / 2f64.sqrt(), max_relative = 1e-12);
        assert_relative_eq!(parameters.rz, 1.0, max_relative = step * step);
        assert_eq!(parameters.rz, parameters.rt);
        assert_relative_eq!(parameters.rc, 1.0, max_relative = step * step);
        assert_relative_eq!(parameters.rsm, 1.0, max_relative = 1e-12);
        assert_relative_eq!(parameters.rpc, 1.0, max_relative = 1e-12);
        // The slopes are those of all samples except three at each end, where they are steepest.
        assert_relative_eq!(parameters.rdt, PI, max_relative = step * step);
        assert_relative_eq!(parameters.rdq, PI / 2f64.sqrt(), max_relative = 6.0 / 800.0);
        assert_relative_eq!(parameters.rda, 2.0, max_relative = 6.0 / 800.0);
        assert_relative_eq!(parameters.rdl, 8.0 * (1.0 + parameters.rdr), max_relative = 1e-14);
    }

    #[test]
    fn a_triangle_has_uniform_heights_and_one_slope() {
        let parameters = profile(4000, |x| 2.0 * ((0.2 * x).rem_euclid(1.0) - 0.5).abs() - 0.5).parameters();
        // Eight waves, each of length 5 and with 500 samples.
        let near = 1.0 / 500.0;
        assert_relative_eq!(parameters.ra, 0.25, max_relative = near);
        assert_relative_eq!(parameters.rq, 0.5 / 3f64.sqrt(), max_relative = near);
        assert_relative_eq!(parameters.rsm, 5.0, max_relative = 1e-9);
        assert_relative_eq!(parameters.rc, 1.0, max_relative = 2.0 * near);
        assert_relative_eq!(parameters.rk, 1.0, max_relative = 2.0 * near);
        assert_abs_diff_eq!(parameters.rpk, 0.0, epsilon = 2.0 * near);
        // Slope 0.4 except for the six samples around each of two corners per wave.
        assert_relative_eq!(parameters.rda, 0.4, max_relative = 12.0 * near);
        assert_relative_eq!(parameters.rdq, 0.4, max_relative = 12.0 * near);
        assert_relative_eq!(parameters.rdr, 1.16f64.sqrt() - 1.0, max_relative = 24.0 * near);
        // The derivative overshoots by less than a quarter at a corner, because of its weights 45, −9, 1.
        assert!(parameters.rdt < 0.4 * 1.25);
    }

    #[test]
    fn the_cutoff_parts_roughness_from_waviness() {
        let (short, long) = (|x: f64| 0.1 * (TAU * x / 0.2).sin(), |x: f64| 3.0 * (TAU * x / 10.0).sin());
        let both = profile(3000, |x| short(x) + long(x));
        let (rough, wavy) = (both.roughness(1.0).unwrap(), both.waviness(1.0).unwrap());
        for (i, z) in both.heights().iter().enumerate() {
            assert_abs_diff_eq!(rough.heights()[i] + wavy.heights()[i], *z, epsilon = 1e-15);
        }
        let (rough, wavy) = (rough.parameters(), wavy.parameters());
        // The fraction 1 − 2^(−(1/10)²) = 0.7 % of the long wave stays in the roughness, more only at the
        // ends.
        let rest = 3.0 * (1.0 - 2f64.powf(-0.01));
        assert_relative_eq!(rough.rq, (0.005 + 0.5 * rest * rest).sqrt(), max_relative = 0.01);
        assert_relative_eq!(rough.rsm, 0.2, max_relative = 0.01);
        assert_abs_diff_eq!(rough.rz, 0.2, epsilon = 2.0 * rest);
        assert_relative_eq!(wavy.rq, 3.0 / 2f64.sqrt(), max_relative = 0.01);
        assert_relative_eq!(wavy.rsm, 10.0, max_relative = 1e-3);
        let clean = both.primary(0.02).unwrap().parameters();
        assert_relative_eq!(clean.rt, both.parameters().rt, max_relative = 0.01);
    }

    #[test]
    fn sections_share_their_peaks_and_the_rest_has_none() {
        // Five sections of 100 samples and a remainder, with a spike in the second section and a pit in the
        // remainder.
        let mut spiked = profile(560, |_| 0.0);
        spiked.heights[150] = 1.0;
        spiked.heights[530] = -2.0;
        spiked.section = Some(1.0);
        let parameters = spiked.parameters();
        let mean = -1.0 / 560.0;
        assert_relative_eq!(parameters.rp, 0.2 - mean, max_relative = 1e-12);
        assert_relative_eq!(parameters.rv, mean, max_relative = 1e-9);
        assert_relative_eq!(parameters.rz, 0.2, max_relative = 1e-12);
        assert_relative_eq!(parameters.rt, 3.0, max_relative = 1e-12);
        // Shorter than a section: one section.
        spiked.section = Some(10.0);
        assert_relative_eq!(spiked.parameters().rz, 3.0, max_relative = 1e-12);
    }

    #[test]
    fn parameters_of_lines_are_averaged_where_they_have_a_meaning() {
        let grid = Grid::new([200, 3], [0.01, 1.0]).unwrap();
        let heights = Field::from_shape_fn(grid.shape, |(ix, iy)| match iy {
            2 => f64::NAN,
            _ => (1 + iy) as f64 * (TAU * grid.centre(0, ix) / 0.5).sin(),
        });
        let waves = Topography::new(grid, heights).unwrap();
        let primary: Vec<_> = waves.profiles(Axis::X).map(|profile| profile.parameters()).collect();
        let mean = ProfileParameters::mean(&primary);
        assert_relative_eq!(mean.rq, 1.5 / 2f64.sqrt(), max_relative = 1e-12);
        assert_relative_eq!(mean.rsm, 0.5, max_relative = 1e-12);
        let rough = waves.profile_parameters(Axis::X, 5.0).unwrap();
        assert_relative_eq!(rough.rsm, 0.5, max_relative = 0.05);
        assert!(waves.profile_parameters(Axis::Y, 1.0).is_err());
        assert!(ProfileParameters::mean(&[]).ra.is_nan());
    }

    #[test]
    fn what_has_no_meaning_is_not_a_number() {
        let nothing = profile(20, |_| f64::NAN).parameters();
        assert!(nothing.rows().iter().all(|row| row.value.is_nan()), "{nothing:?}");
        let flat = profile(20, |_| 0.5).parameters();
        assert_eq!((flat.ra, flat.rz, flat.rt, flat.rk, flat.rdr), (0.0, 0.0, 0.0, 0.0, 0.0));
        assert!(flat.rsk.is_nan() && flat.rsm.is_nan() && flat.rpc.is_nan());
        assert_eq!(profile(1, |_| 0.5).parameters().rt, 0.0);
    }
}
