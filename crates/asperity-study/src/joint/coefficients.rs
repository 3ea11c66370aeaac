//! Constants of other laws that fit the law of a joint best, each with the range in which it was fitted.

use serde::Serialize;

use super::law::{Edge, Law};
use super::quantities::Kind;
use asperity_base::units::{Metre, Pascal};
use asperity_contact::flow::patir_cheng;
use asperity_contact::reference::rough::peaks_beyond;

/// Constants for programs that have a law of their own.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Coefficients {
    /// Title of the case.
    pub title: String,
    /// Version of asperity.
    pub version: &'static str,
    /// Number of samples.
    pub samples: usize,
    /// Units of the constants.
    pub units: &'static str,
    /// p = p₀ exp(−g/u₀); none of a law that does not fall with the gap.
    pub exponential: Option<Exponential>,
    /// p = K E* F₅⸝₂((g − δ)/σ_s), with δ = 0: the datum is the mean plane of the sum of both surfaces.
    pub greenwood_tripp: Option<GreenwoodTripp>,
    /// φ = 1 − C exp(−r g/σ), along x and along y, with the mean gap g of the flow; none without a flow.
    pub flow: [Option<PatirCheng>; 2],
    /// Gap g₀ from which the closure is counted, m.
    pub datum: Metre,
    /// Rms height σ of the sum of both surfaces, m.
    pub rms_height: Metre,
    /// Composite modulus E*, Pa.
    pub modulus: Pascal,
}

/// An exponential law of the mean gap.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Exponential {
    /// Pressure at a gap of 0 that the law continues to, Pa.
    pub pressure: Pascal,
    /// Length over which the pressure falls by e, m.
    pub decay: Metre,
    /// Range of the pressures, Pa.
    pub pressure_range: [Pascal; 2],
    /// Rms of ln p about the law.
    pub rms: f64,
}

/// The law of Greenwood and Tripp. Its fit is not unique: another datum fits as well with other constants, so that none of
/// them has a meaning by itself.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct GreenwoodTripp {
    /// K.
    pub factor: f64,
    /// σ_s, m.
    pub deviation: Metre,
    /// Range of g/σ.
    pub gap_over_rms_range: [f64; 2],
    /// Rms of ln p about the law.
    pub rms: f64,
}

/// A pressure flow factor in the form of Patir and Cheng.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PatirCheng {
    /// C; 0.90 in their own fit to isotropic roughness.
    pub factor: f64,
    /// r; 0.56 in their own.
    pub rate: f64,
    /// Range of g/σ.
    pub gap_over_rms_range: [f64; 2],
    /// Rms of φ about the law.
    pub rms: f64,
    /// Largest ratio of φ to that of their own fit.
    pub over_theirs: f64,
}

/// Widths that are tried for σ_s, over σ.
const WIDTHS: [f64; 2] = [0.1, 10.0];

impl Law {
    /// Fits the median of the law.
    pub fn coefficients(&self) -> Coefficients {
        let gaps = self.gaps(Edge::Median);
        let points: Vec<[f64; 2]> = gaps.iter().zip(&self.pressures).map(|(gap, p)| [*gap, p.ln()]).collect();
        let sigma = self.rms_height.median;
        let [slope, start, rms] = line(&points);
        let pressure_range = [self.pressures[0], self.pressures[self.pressures.len() - 1]];
        let flow = [Kind::FlowFactorX, Kind::FlowFactorY].map(|kind| {
            let values = self.values(kind, Edge::Median)?;
            let gaps = self.values(Kind::FlowGap, Edge::Median)?;
            patir_cheng_of(&gaps.iter().map(|gap| gap / sigma).zip(values).collect::<Vec<_>>())
        });
        let exponential = Exponential { pressure: start.exp(), decay: -slope.recip(), pressure_range, rms };
        Coefficients {
            title: self.title.clone(),
            version: env!("CARGO_PKG_VERSION"),
            samples: self.samples,
            units: "SI: m, Pa",
            exponential: Some(exponential).filter(|fit| fit.decay > 0.0 && fit.pressure.is_finite()),
            greenwood_tripp: greenwood_tripp_of(&points, self.modulus, sigma),
            flow,
            datum: self.datum,
            rms_height: sigma,
            modulus: self.modulus,
        }
    }
}

/// Least squares: slope, value at 0, and rms about the line.
fn line(points: &[[f64; 2]]) -> [f64; 3] {
    let count = points.len() as f64;
    let mean = [0, 1].map(|n| points.iter().map(|point| point[n]).sum::<f64>() / count);
    let moment = |n: usize| points.iter().map(|p| (p[0] - mean[0]) * (p[n] - mean[n])).sum::<f64>();
    let slope = moment(1) / moment(0);
    let start = mean[1] - slope * mean[0];
    let square = points.iter().map(|[x, y]| (y - start - slope * x).powi(2)).sum::<f64>() / count;
    [slope, start, square.sqrt()]
}

/// Fits K and σ_s to points of gap and ln p. For each σ_s the best K is the mean of ln p − ln F.
fn greenwood_tripp_of(points: &[[f64; 2]], modulus: Pascal, sigma: Metre) -> Option<GreenwoodTripp> {
    let fit = |deviation: f64| {
        let logs: Vec<f64> = points
            .iter()
            .map(|[gap, log]| log - modulus.ln() - peaks_beyond(gap / deviation, 2.5).ln())
            .collect();
        let mean = logs.iter().sum::<f64>() / logs.len() as f64;
        let square = logs.iter().map(|log| (log - mean).powi(2)).sum::<f64>() / logs.len() as f64;
        (mean.exp(), square.sqrt())
    };
    // The rms has one minimum over ln σ_s: golden sections.
    let [mut low, mut high] = WIDTHS.map(|width| (width * sigma).ln());
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let rms = |log: f64| Some(fit(log.exp()).1).filter(|rms| rms.is_finite()).unwrap_or(f64::INFINITY);
    for _ in 0..60 {
        let [left, right] = [high - golden * (high - low), low + golden * (high - low)];
        if rms(left) < rms(right) { high = right } else { low = left }
    }
    let deviation = (0.5 * (low + high)).exp();
    let (factor, rms) = fit(deviation);
    let ends = [points.last()?[0], points.first()?[0]];
    (rms.is_finite() && factor.is_finite()).then_some(GreenwoodTripp {
        factor,
        deviation,
        gap_over_rms_range: ends.map(|gap| gap / sigma),
        rms,
    })
}

/// Fits C and r to points of g/σ and φ between 0 and 1; `None` with fewer than two.
fn patir_cheng_of(points: &[(f64, f64)]) -> Option<PatirCheng> {
    let good: Vec<(f64, f64)> =
        points.iter().copied().filter(|(_, factor)| *factor > 0.0 && *factor < 1.0).collect();
    if good.len() < 2 {
        return None;
    }
    let [slope, start, _] =
        line(&good.iter().map(|(ratio, factor)| [*ratio, (1.0 - factor).ln()]).collect::<Vec<_>>());
    let fitted = |ratio: f64| 1.0 - (start + slope * ratio).exp();
    let square = good.iter().map(|(ratio, factor)| (factor - fitted(*ratio)).powi(2)).sum::<f64>();
    let ratios = good.iter().map(|(ratio, _)| *ratio);
    let over =
        good.iter().filter(|(ratio, _)| *ratio > 0.5).map(|(ratio, factor)| factor / patir_cheng(*ratio));
    Some(PatirCheng {
        factor: start.exp(),
        rate: -slope,
        gap_over_rms_range: [ratios.clone().fold(f64::INFINITY, f64::min), ratios.fold(0.0, f64::max)],
        rms: (square / good.len() as f64).sqrt(),
        over_theirs: over.fold(0.0, f64::max),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn laws_are_found_again_from_their_own_points() {
        let exact = |gap: f64| 3e-3 * 115e9 * peaks_beyond(gap / 80e-9, 2.5);
        let points: Vec<[f64; 2]> =
            (0..8).map(|n| 50e-9 + 25e-9 * f64::from(n)).map(|gap| [gap, exact(gap).ln()]).collect();
        let found = greenwood_tripp_of(&points, 115e9, 100e-9).unwrap();
        assert!(
            (found.factor / 3e-3 - 1.0).abs() < 1e-5 && (found.deviation / 80e-9 - 1.0).abs() < 1e-5,
            "{found:?}"
        );
        assert!(found.rms < 1e-5);
        let flow: Vec<(f64, f64)> = [0.8, 1.5, 2.5].map(|ratio| (ratio, patir_cheng(ratio))).to_vec();
        let found = patir_cheng_of(&flow).unwrap();
        assert!((found.factor - 0.9).abs() < 1e-9 && (found.rate - 0.56).abs() < 1e-9);
        assert!((found.over_theirs - 1.0).abs() < 1e-12);
        assert_eq!(patir_cheng_of(&[(1.0, 0.0), (2.0, 0.5)]), None);
        let [slope, start, rms] = line(&[[0.0, 1.0], [1.0, 3.0], [2.0, 5.0]]);
        assert!((slope - 2.0).abs() < 1e-12 && (start - 1.0).abs() < 1e-12 && rms < 1e-12);
    }
}
