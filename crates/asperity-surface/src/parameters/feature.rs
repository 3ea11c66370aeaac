//! Feature parameters of ISO 25178-2.

use super::row::family;
use crate::{Motif, NEVER, Segmentation, Stop, Topography};
use asperity_base::error::Result;

family! {
    /// Feature parameters of ISO 25178-2:2021, 5.8, from the hills and dales that remain after Wolf pruning.
    ///
    /// Densities, heights and curvatures use all of these, including those at the boundary of the measured
    /// area, whose peak may be a slope that was cut off. Areas and volumes use those [closed](Motif::closed)
    /// at c = 50 % material ratio.
    ///
    /// No filter is applied: level and filter first. All parameters are over the defined samples;
    /// [`Segmentation`] describes the effect of holes. Without hills or dales a density is 0 and any other
    /// parameter NaN. Without a defined sample all are NaN.
    FeatureParameters: "feature" {
        /// Density of peaks: hills by the defined area.
        spd: PerArea as "Spd",
        /// Density of pits: dales by the defined area.
        svd: PerArea as "Svd",
        /// Arithmetic mean peak curvature.
        ///
        /// Not below 0: the mean of −½ (∂²z/∂x² + ∂²z/∂y²) over the peaks with a defined
        /// [`Motif::curvature`].
        spc: PerLength as "Spc",
        /// Arithmetic mean pit curvature.
        ///
        /// The same mean over the pits, so not above 0.
        svc: PerLength as "Svc",
        /// Five-point peak height.
        ///
        /// Mean height of the five highest peaks above the mean of the topography. The standard does not
        /// define it for fewer peaks; here it is the mean of all peaks.
        s5p: Length as "S5p",
        /// Five-point pit depth.
        ///
        /// Positive: mean depth of the five deepest pits below the mean of the topography, or of all pits if
        /// there are fewer.
        s5v: Length as "S5v",
        /// Ten-point height, S5p + S5v.
        s10z: Length as "S10z",
        /// Mean dale area, of the closed dales.
        sda: Area as "Sda",
        /// Mean hill area, of the closed hills.
        sha: Area as "Sha",
        /// Mean dale volume, of the closed dales, each below its saddle.
        ///
        /// [`Motif::volume`].
        sdv: Volume as "Sdv",
        /// Mean hill volume, of the closed hills, each above its saddle.
        ///
        /// [`Motif::volume`].
        shv: Volume as "Shv",
    }
}

impl FeatureParameters {
    /// Computes the parameters of `topography`, pruned at a height of `pruning` · Sz; [`crate::WOLF_PRUNING`]
    /// is usual.
    ///
    /// # Errors
    /// [`asperity_base::Error::OutOfRange`] if `pruning` is not from 0 to 1.
    pub fn new(topography: &Topography, pruning: f64) -> Result<Self> {
        Self::until(topography, pruning, NEVER)
    }

    /// [`new`](Self::new) that can be stopped by `stop`.
    ///
    /// # Errors
    /// The errors of [`new`](Self::new); [`asperity_base::Error::Interrupted`].
    pub fn until(topography: &Topography, pruning: f64, stop: Stop<'_>) -> Result<Self> {
        let (hills, dales) =
            rayon::join(|| topography.hills_until(pruning, stop), || topography.dales_until(pruning, stop));
        let (hills, dales) = (hills?, dales?);
        let area = topography.defined() as f64 * topography.grid().cell_area();
        let datum = topography.mean();
        let s5p = mean(hills.motifs.iter().take(5).map(|hill| hill.height - datum));
        let s5v = mean(dales.motifs.iter().take(5).map(|dale| datum - dale.height));
        Ok(Self {
            spd: hills.motifs.len() as f64 / area,
            svd: dales.motifs.len() as f64 / area,
            spc: mean_curvature(&hills),
            svc: mean_curvature(&dales),
            s5p,
            s5v,
            s10z: s5p + s5v,
            sda: mean(closed(&dales).map(|dale| dale.area)),
            sha: mean(closed(&hills).map(|hill| hill.area)),
            sdv: mean(closed(&dales).map(|dale| dale.volume)),
            shv: mean(closed(&hills).map(|hill| hill.volume)),
        })
    }
}

impl Topography {
    /// Computes the feature parameters of ISO 25178-2, pruned at a height of `pruning` · Sz;
    /// [`crate::WOLF_PRUNING`] is usual.
    ///
    /// # Errors
    /// [`asperity_base::Error::OutOfRange`] if `pruning` is not from 0 to 1.
    pub fn feature_parameters(&self, pruning: f64) -> Result<FeatureParameters> {
        FeatureParameters::new(self, pruning)
    }
}

fn closed(segmentation: &Segmentation) -> impl Iterator<Item = &Motif> {
    segmentation.motifs.iter().filter(|motif| motif.closed)
}

fn mean_curvature(segmentation: &Segmentation) -> f64 {
    mean(segmentation.motifs.iter().map(|motif| motif.curvature).filter(|curvature| !curvature.is_nan()))
}

/// Arithmetic mean; NaN without values.
fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0usize), |(sum, count), value| (sum + value, count + 1));
    sum / count as f64
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use approx::assert_relative_eq;

    use super::*;
    use crate::WOLF_PRUNING;
    use asperity_base::grid::{Field, Grid};
    use asperity_base::units::Metre;

    fn topography(shape: [usize; 2], pitch: [Metre; 2], height: impl Fn(usize, usize) -> f64) -> Topography {
        let heights = Field::from_shape_fn(shape, |(ix, iy)| height(ix, iy));
        Topography::new(Grid::new(shape, pitch).unwrap(), heights).unwrap()
    }

    #[test]
    fn an_egg_box_has_its_textbook_parameters() {
        // ½ (cos kx + cos ky), 5 × 5 waves of n samples, with a peak in the middle of each and pits where
        // four waves meet.
        let n = 45;
        let order = (n as f64).powi(-2);
        let cosine = |i: usize| (TAU * (i as f64 - 22.0) / n as f64).cos();
        let pitch = [0.5, 0.25];
        let egg_box = topography([5 * n, 5 * n], pitch, |ix, iy| 0.5 * (cosine(ix) + cosine(iy)));
        let parameters = egg_box.feature_parameters(WOLF_PRUNING).unwrap();
        let wavelength = pitch.map(|pitch| pitch * n as f64);
        let square = wavelength[0] * wavelength[1];
        assert_relative_eq!(parameters.spd, 1.0 / square, max_relative = 1e-14);
        assert_relative_eq!(parameters.svd, 36.0 / (25.0 * square), max_relative = 1e-14);
        assert_relative_eq!(parameters.s5p, 1.0, max_relative = 1e-14);
        assert_relative_eq!(parameters.s5v, (PI / n as f64).cos(), max_relative = 1e-14);
        assert_eq!(parameters.s10z, parameters.s5p + parameters.s5v);
        // Second differences: relative error (2π/n)²/12. At the samples beside a pit the curvature is
        // cos(π/n) times that of the pit.
        let curvature: f64 = wavelength.map(|wavelength| 0.25 * (TAU / wavelength).powi(2)).iter().sum();
        assert_relative_eq!(parameters.spc, curvature, max_relative = PI * PI / 3.0 * order);
        assert_relative_eq!(
            parameters.svc,
            -curvature,
            max_relative = (PI * PI / 3.0 + PI * PI / 2.0) * order
        );
        // The line of samples on each course line of the dales belongs to one of both sides.
        assert_relative_eq!(parameters.sha, square, max_relative = 1e-13);
        assert_relative_eq!(parameters.sda, square, max_relative = 2.0 / n as f64 + order);
        // The saddle found is s = ½ (1 − cos π/n) too high, over λ²/2: a fraction π⁴/16n² of the volume
        // 2λ²/π². The sum over the samples, in place of the integral up to the kink along |x| + |y| = λ/2,
        // has an error of at most π²/4n².
        let (volume, error) = (2.0 * square / (PI * PI), (PI.powi(4) / 16.0 + PI * PI / 4.0) * order);
        assert_relative_eq!(parameters.shv, volume, max_relative = error);
        assert_relative_eq!(parameters.sdv, volume, max_relative = error);
    }

    #[test]
    fn a_paraboloid_is_one_hill_of_its_curvature() {
        let height =
            |ix: usize, iy: usize| -(ix as f64 - 20.0).powi(2) / 8.0 - (iy as f64 - 20.0).powi(2) / 2.0;
        let parameters = topography([41, 41], [1.0, 2.0], height).feature_parameters(WOLF_PRUNING).unwrap();
        assert_relative_eq!(parameters.spd, 1.0 / 3362.0, max_relative = 1e-14);
        // 1/R is 1/4 along both directions; its four pits are in the corners, where the curvature is
        // undefined.
        assert_relative_eq!(parameters.spc, 0.25, max_relative = 1e-12);
        assert_relative_eq!(parameters.svd, 4.0 / 3362.0, max_relative = 1e-14);
        assert!(parameters.svc.is_nan());
    }

    #[test]
    fn five_peaks_count_or_those_there_are() {
        let spikes = |count: usize| {
            topography([20, 3], [1.0, 1.0], move |ix, iy| {
                if iy == 1 && ix % 2 == 1 && ix / 2 < count { (ix / 2 + 1) as f64 } else { 0.0 }
            })
        };
        let s5p = |topography: Topography| {
            let mean = topography.mean();
            topography.feature_parameters(WOLF_PRUNING).unwrap().s5p + mean
        };
        assert_relative_eq!(s5p(spikes(7)), (7 + 6 + 5 + 4 + 3) as f64 / 5.0);
        assert_relative_eq!(s5p(spikes(2)), 1.5);
    }

    #[test]
    fn what_lies_at_the_rim_counts_as_peak_but_not_for_mean_area() {
        let wave = topography([40, 1], [0.5, 1.0], |ix, _| (TAU * ix as f64 / 16.0).cos());
        let parameters = wave.feature_parameters(WOLF_PRUNING).unwrap();
        // Peaks at samples 0, 16, 32, and pits at 8, 24; the last pit, at 40, is cut off.
        assert_relative_eq!(parameters.spd, 3.0 / 20.0);
        assert_relative_eq!(parameters.svd, 3.0 / 20.0);
        assert_relative_eq!(parameters.sha, 0.5 * 16.0, max_relative = 1.0 / 16.0);
    }

    #[test]
    fn a_plane_has_neither_peaks_nor_pits() {
        let parameters = topography([8, 8], [1.0, 1.0], |_, _| 3.0).feature_parameters(0.0).unwrap();
        assert_eq!((parameters.spd, parameters.svd), (0.0, 0.0));
        assert!(parameters.s10z.is_nan() && parameters.spc.is_nan() && parameters.sha.is_nan());
        let nothing = topography([8, 8], [1.0, 1.0], |_, _| f64::NAN).feature_parameters(0.0).unwrap();
        assert!(nothing.spd.is_nan() && nothing.s5v.is_nan());
    }

    #[test]
    fn json_carries_the_names_of_the_standard() {
        let wave = topography([32, 32], [1.0, 1.0], |ix, iy| (ix as f64).cos() + (iy as f64).cos());
        let json = serde_json::to_value(wave.feature_parameters(WOLF_PRUNING).unwrap()).unwrap();
        let names = ["Spd", "Svd", "Spc", "Svc", "S5p", "S5v", "S10z", "Sda", "Sha", "Sdv", "Shv"];
        assert!(names.iter().all(|name| json[name].is_number()), "{json}");
    }
}
