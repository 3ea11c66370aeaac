//! Distribution of heights, and the Gaussian process translated to it.

use serde::Serialize;

use super::johnson::Johnson;
use asperity_base::error::Result;
use asperity_base::grid::Field;
use asperity_base::math::fft::symmetric_transform;
use asperity_base::table::{Part as _, Source};
use asperity_derive::Part;

/// Skewness and kurtosis of the heights; those of the Gaussian distribution by default.
///
/// Heights are z = f(g), with a Gaussian process g and the curve f of Johnson's system with these moments: a
/// translation process (Grigoriu, *Applied Non-Gaussian Processes*, 1995). It does not depend on the length
/// of the filter. The alternative of Hu & Tonder translates the noise before the filter. It needs noise of
/// kurtosis 3 + (Sku − 3)(Σh²)²/Σh⁴, which is 1070 for Sku = 4.5 and a cut-off of 32 samples, and no sample
/// of it has that. It is also limited to Sku > 3 + 1.3 Ssk².
///
/// The translation changes the autocorrelation. That of g is chosen so that the result has the prescribed
/// one, as far as such a process exists. Spectra with a sharp edge are only approximated, see
/// [`crate::LowPass`]. The moments are those of the mean over seeds. A single surface deviates by its
/// statistical error, about √(6/n) and √(24/n) for n independent spots, more for heavy tails.
#[derive(Part, Debug, Clone, Copy, PartialEq, Serialize)]
#[part(check = skewed)]
pub struct HeightDistribution {
    /// Skewness of the heights, −6 to 6; together with `sku`, see below.
    ///
    /// Ssk.
    #[key(number = "a number", default = 0.0, written = "0", example = "-1")]
    #[serde(skip_serializing_if = "is_symmetric")]
    pub ssk: f64,
    /// Kurtosis of the heights, 1.1 (Ssk² + 1) to 50, see below.
    ///
    /// Sku. Every distribution has at least Ssk² + 1.
    #[key(number = "a number", default = 3.0, written = "3", example = "4.5")]
    #[serde(skip_serializing_if = "is_mesokurtic")]
    pub sku: f64,
}

/// A skewness needs a kurtosis, which bounds its range.
fn skewed(_: &HeightDistribution, source: &dyn Source) -> Result<()> {
    match (source.value("ssk"), source.value("sku")) {
        (Some(_), None) => Err(source.missing(&HeightDistribution::keys()[1])),
        _ => Ok(()),
    }
}

impl HeightDistribution {
    /// Ssk = 0, Sku = 3.
    pub const GAUSSIAN: Self = Self { ssk: 0.0, sku: 3.0 };

    /// Returns the translation from Gaussian heights; `None` for Gaussian ones.
    pub(super) fn translation(self) -> Result<Option<Translation>> {
        if self == Self::GAUSSIAN { Ok(None) } else { Translation::new(self).map(Some) }
    }
}

impl Default for HeightDistribution {
    fn default() -> Self {
        Self::GAUSSIAN
    }
}

fn is_symmetric(ssk: &f64) -> bool {
    *ssk == HeightDistribution::GAUSSIAN.ssk
}

fn is_mesokurtic(sku: &f64) -> bool {
    *sku == HeightDistribution::GAUSSIAN.sku
}

/// A curve, with the autocorrelation of its underlying Gaussian process.
pub(super) struct Translation {
    curve: Johnson,
    /// The smallest possible autocorrelation of the heights.
    least: f64,
    /// Autocorrelation of the Gaussian process at evenly spaced ones of the heights, from the smallest to 1.
    table: Vec<f64>,
}

impl Translation {
    fn new(heights: HeightDistribution) -> Result<Self> {
        /// Number of intervals in the table of correlations.
        const INTERVALS: usize = 4096;
        let curve = Johnson::new(heights.ssk, heights.sku)?;
        let shares = curve.shares();
        let series = |rho: f64| shares.iter().rev().fold(0.0, |sum, share| (sum + share) * rho);
        let slope = |rho: f64| {
            let terms = shares.iter().enumerate().rev();
            terms.fold(0.0, |sum, (n, share)| sum * rho + (n + 1) as f64 * share)
        };
        // Below this, two heights are nearly uncorrelated even for correlated Gaussian numbers.
        let downwards = (0..100).map(|n| -0.01 * f64::from(n));
        let end = downwards.take_while(|rho| slope(*rho) > 0.1).last().unwrap_or(0.0);
        let least = series(end);
        let mut rho = end;
        let table = (0..=INTERVALS).map(|n| {
            let wanted = least + (1.0 - least) * n as f64 / INTERVALS as f64;
            for _ in 0..4 {
                rho = (rho + (wanted - series(rho)) / slope(rho)).clamp(end, 1.0);
            }
            rho
        });
        Ok(Self { curve, least, table: table.collect() })
    }

    /// Returns a height of variance 1 from a Gaussian number.
    pub(super) fn height(&self, g: f64) -> f64 {
        self.curve.height(g)
    }

    /// Returns the spectrum of the Gaussian process, with variance 1, for heights with this `spectrum`. Each
    /// is `[l, k]` on a period of `shape` samples in the layout of [`symmetric_transform`].
    ///
    /// If no process has the required autocorrelation, its spectrum has negative values, which are set to 0.
    pub(super) fn underlying(&self, spectrum: Field, shape @ [nx, ny]: [usize; 2]) -> Field {
        let mut autocorrelation = symmetric_transform(&spectrum, [ny, nx]);
        drop(spectrum);
        let variance = autocorrelation[[0, 0]];
        autocorrelation.mapv_inplace(|value| self.gaussian(value / variance));
        let mut spectrum = symmetric_transform(&autocorrelation, shape);
        spectrum.mapv_inplace(|value| value.max(0.0));
        let edges = spectrum.row(0).sum() + if ny % 2 == 0 { spectrum.row(ny / 2).sum() } else { 0.0 };
        let scale = (nx * ny) as f64 / (2.0 * spectrum.sum() - edges);
        spectrum *= scale;
        spectrum
    }

    /// Returns the autocorrelation of the Gaussian process for `r` of the heights.
    fn gaussian(&self, r: f64) -> f64 {
        let last = self.table.len() - 1;
        let place = ((r - self.least) / (1.0 - self.least)).clamp(0.0, 1.0) * last as f64;
        let n = (place as usize).min(last - 1);
        self.table[n] + (place - n as f64) * (self.table[n + 1] - self.table[n])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_undoes_what_the_translation_does_to_the_autocorrelation() {
        for [ssk, sku] in [[-1.0, 4.5], [2.0, 9.0], [0.0, 5.0], [0.0, 1.8], [-0.3, 2.2]] {
            let translation = Translation::new(HeightDistribution { ssk, sku }).unwrap();
            let shares = translation.curve.shares();
            for r in [translation.least, -0.15, -1e-3, 0.0, 1e-4, 0.3, 0.9, 0.999, 1.0] {
                let rho = translation.gaussian(r);
                let back = shares.iter().rev().fold(0.0, |sum, share| (sum + share) * rho);
                assert!((back - r).abs() < 1e-6 * r.abs().max(0.1), "{ssk}, {sku} at {r}: {back}");
            }
        }
    }

    #[test]
    fn the_process_under_an_exponential_autocorrelation_exists() {
        let shape = [64, 48];
        let half =
            Field::from_shape_fn([33, 48], |(i, j)| (-0.3 * (i as f64).hypot(j.min(48 - j) as f64)).exp());
        let spectrum = symmetric_transform(&half, shape);
        let translation = Translation::new(HeightDistribution { ssk: -1.0, sku: 4.5 }).unwrap();
        let gaussian =
            symmetric_transform(&translation.underlying(spectrum, shape), [48, 64]) / (64.0 * 48.0);
        for ((i, j), r) in half.indexed_iter() {
            assert!((gaussian[[i, j]] - translation.gaussian(*r)).abs() < 1e-4, "[{i}, {j}]");
        }
    }
}
