//! Samples as one law.

use std::path::PathBuf;

use super::quantities::{Found, Kind, QUANTITIES, along};
use super::warnings::{left_out, of_samples};
use crate::parametric::{Folder, Study};
use crate::results::Results;
use asperity_base::error::{Error, Result};
use asperity_base::units::{Metre, Pascal};
use asperity_contact::conductance::{ConductanceRecord, Joint};
use asperity_contact::flow::{FlowRecord, Leakage};
use asperity_contact::joint::{JointLaw, JointRecord};
use asperity_contact::motion::SweepRecord;
use asperity_surface::Axis;

/// Quantiles of the band.
const QUANTILES: [f64; 2] = [0.16, 0.84];

/// Largest relative difference of the mean pressure of samples at one point.
const SAME_PRESSURE: f64 = 1e-6;

/// Ratio of the least computed pressure to that at which its continuation becomes straight.
const TAIL: f64 = 100.0;

/// Points of the continuation, as ratios to the least computed pressure.
const TAIL_POINTS: [f64; 6] = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5];

/// Relative step of a closure that is rounding.
const ROUNDING: f64 = 1e-7;

/// Relative error of a slope between points that passes as rounding, and relative step of the pressure that is too short
/// for a slope.
const SLACK: f64 = 1e-3;

/// A value over the samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// Quantile 0.16.
    pub low: f64,
    /// Median.
    pub median: f64,
    /// Quantile 0.84.
    pub high: f64,
}

/// A quantity over the pressures of the law.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// Its kind.
    pub kind: Kind,
    /// Its band at each pressure; `None` where fewer than half of the samples have it, such as a flow factor beyond the
    /// closing of the gap.
    pub bands: Vec<Option<Band>>,
}

/// The median of the samples, or an edge of their band.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Edge {
    /// The softer edge, which conducts less: the quantile 0.16 of gap, stiffness and conductance.
    Low,
    /// The median.
    Median,
    /// The stiffer edge, which conducts more.
    High,
}

/// The checks of a law.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Checks {
    /// Steps of all samples between neighbouring pressures.
    pub steps: usize,
    /// Steps whose secant stiffness lies between the stiffnesses at both ends.
    pub bracketed: usize,
    /// Largest relative difference of a conductance from that by Barber's identity; `None` where the identity does not hold,
    /// as with a hardness.
    pub barber: Option<f64>,
}

/// The law of a joint.
#[derive(Debug, Clone, PartialEq)]
pub struct Law {
    /// Title of the case.
    pub title: String,
    /// Number of samples.
    pub samples: usize,
    /// Number of cases without results.
    pub missing: usize,
    /// Mean pressures, rising.
    pub pressures: Vec<Pascal>,
    /// The quantities that are known.
    pub quantities: Vec<Quantity>,
    /// Gap g₀ from which the closure is counted.
    pub datum: Metre,
    /// Rms height of the sum of both surfaces over the samples.
    pub rms_height: Band,
    /// Rms slope of the sum of both surfaces.
    pub rms_slope: Band,
    /// Composite modulus E*.
    pub modulus: Pascal,
    /// Rows of the theories at each pressure, of the sample in the middle by its rms height.
    pub theories: Vec<JointRecord>,
    /// Side of a square with the area of the smallest sample.
    pub side: Metre,
    /// Share of the gas in the conductance under the least pressure, the median.
    pub gas_share: f64,
    /// Whether cells yield, so that the law holds for the first loading alone.
    pub yields: bool,
    /// Warnings about its samples, and what it leaves out.
    pub warnings: Vec<String>,
    /// Its checks.
    pub checks: Checks,
}

/// The results of a sample, at rising pressures.
struct Sample {
    folder: PathBuf,
    points: Vec<SweepRecord>,
    joints: Vec<JointRecord>,
    conductances: Vec<ConductanceRecord>,
    flows: Vec<FlowRecord>,
    warnings: Vec<String>,
}

impl Sample {
    fn read(results: &Results) -> Result<Self> {
        let mut points = results.sweep()?;
        points.sort_by(|a, b| a.mean_pressure.total_cmp(&b.mean_pressure));
        Ok(Self {
            folder: results.directory().to_owned(),
            points,
            joints: results.rows::<JointLaw>()?,
            conductances: results.rows::<Joint>()?,
            flows: results.rows::<Leakage>()?,
            warnings: results.summary()?.warnings,
        })
    }

    fn found(&self, index: usize) -> Result<Found<'_>> {
        let point = &self.points[index];
        let joint = self.joints.iter().find(|row| row.step == Some(point.point));
        Ok(Found {
            point,
            joint: joint.ok_or_else(|| self.damaged())?,
            conductance: self.conductances.iter().find(|row| row.step == Some(point.point)),
            flow: [Axis::X, Axis::Y].map(|axis| along(&self.flows, axis, point.point)),
        })
    }

    fn side(&self) -> Metre {
        (self.points[0].load / self.points[0].mean_pressure).sqrt()
    }

    fn damaged(&self) -> Error {
        let message =
            "the sample has no complete joint.csv: remove its folder, and run the same command again";
        Error::File { path: self.folder.clone(), source: std::io::Error::other(message) }
    }
}

impl Band {
    /// The band of some values; `None` without any.
    pub fn from_values(mut values: Vec<f64>) -> Option<Self> {
        values.retain(|value| value.is_finite());
        values.sort_by(f64::total_cmp);
        let last = values.len().checked_sub(1)?;
        let quantile = |share: f64| {
            let place = share * last as f64;
            let below = (place as usize).min(last);
            let above = (below + 1).min(last);
            values[below] + (place - below as f64) * (values[above] - values[below])
        };
        Some(Self { low: quantile(QUANTILES[0]), median: quantile(0.5), high: quantile(QUANTILES[1]) })
    }

    /// Half of its width.
    pub fn half_width(&self) -> f64 {
        0.5 * (self.high - self.low)
    }
}

impl Law {
    /// Brings the finished cases of a study of [`samples`](super::samples()) together.
    ///
    /// # Errors
    /// [`Error::Unsupported`] without two pressures that all samples share; [`Error::File`].
    pub fn collect(study: &Study, folder: &Folder) -> Result<Self> {
        let done = (1..=study.len()).filter(|case| folder.is_done(*case));
        let samples =
            done.map(|case| Sample::read(&Results::open(&folder.case(case))?)).collect::<Result<Vec<_>>>()?;
        let missing = study.len() - samples.len();
        let first = samples.first().ok_or(Error::Unsupported("no sample of the joint is done"))?;
        let pressures: Vec<Pascal> = first.points.iter().map(|point| point.mean_pressure).collect();
        let shares = |sample: &Sample| {
            let pairs = sample.points.iter().zip(&pressures);
            sample.points.len() == pressures.len()
                && pairs.clone().all(|(point, p)| (point.mean_pressure / p - 1.0).abs() <= SAME_PRESSURE)
        };
        if !samples.iter().all(shares) {
            return Err(Error::Unsupported("samples of a joint under different mean pressures"));
        }
        if pressures.len() < 2 || pressures[0] <= 0.0 || !pressures.is_sorted_by(|a, b| a < b) {
            return Err(Error::Unsupported(
                "the law of a joint needs at least two different pressures above 0",
            ));
        }
        let yields = samples.iter().flat_map(|sample| &sample.points).any(yields);
        let warnings: Vec<&[String]> = samples.iter().map(|sample| sample.warnings.as_slice()).collect();
        let found =
            |index: usize| samples.iter().map(|sample| sample.found(index)).collect::<Result<Vec<_>>>();
        let found = (0..pressures.len()).map(found).collect::<Result<Vec<_>>>()?;
        let mut quantities = Vec::new();
        for declared in &QUANTITIES {
            let band = |found: &Vec<Found<'_>>| {
                let values: Vec<f64> = found.iter().filter_map(declared.value).collect();
                if 2 * values.len() > found.len() { Band::from_values(values) } else { None }
            };
            let bands: Vec<Option<Band>> = found.iter().map(band).collect();
            if bands.iter().any(Option::is_some) {
                quantities.push(Quantity { kind: declared.kind, bands });
            }
        }
        let of_surfaces = |value: fn(&JointRecord) -> f64| {
            let values = found[0].iter().map(|found| value(found.joint)).collect();
            Band::from_values(values).expect("finite moments of a surface")
        };
        let (rms_height, rms_slope) = (of_surfaces(|row| row.rms_height), of_surfaces(|row| row.rms_slope));
        let distance = |n: &usize| (found[0][*n].joint.rms_height - rms_height.median).abs();
        let middle = (0..samples.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0);
        let gas_share = |found: &Found<'_>| Some(found.conductance?.gas_share);
        let gas_share = Band::from_values(found[0].iter().filter_map(gas_share).collect());
        let mut law = Self {
            title: study.title().to_owned(),
            samples: samples.len(),
            missing,
            checks: checks(&found),
            theories: found.iter().map(|found| found[middle].joint.clone()).collect(),
            modulus: found[0][0].joint.modulus,
            side: samples.iter().map(Sample::side).fold(f64::INFINITY, f64::min),
            pressures,
            quantities,
            datum: 0.0,
            rms_height,
            rms_slope,
            gas_share: gas_share.map_or(0.0, |band| band.median),
            yields,
            warnings: left_out(&study.case(1)?, yields).into_iter().chain(of_samples(&warnings)).collect(),
        };
        let edges = [Edge::Low, Edge::Median, Edge::High];
        law.datum =
            edges.map(|edge| law.gap_without_pressure(edge)).into_iter().fold(f64::NEG_INFINITY, f64::max);
        Ok(law)
    }

    /// Returns a quantity; `None` if it is unknown.
    pub fn quantity(&self, kind: Kind) -> Option<&Quantity> {
        self.quantities.iter().find(|quantity| quantity.kind == kind)
    }

    /// Returns the values of a quantity at an edge, at each pressure; NaN where it is unknown. `None` of a quantity that the
    /// law does not have.
    pub fn values(&self, kind: Kind, edge: Edge) -> Option<Vec<f64>> {
        let values = |band: &Option<Band>| {
            let Some(Band { low, median, high }) = *band else { return f64::NAN };
            match edge {
                Edge::Low => low,
                Edge::Median => median,
                Edge::High => high,
            }
        };
        Some(self.quantity(kind)?.bands.iter().map(values).collect())
    }

    /// Returns pressure and closure of an edge: from 0 along the continuation to the least computed pressure, and on. The
    /// softer edge has the larger closure.
    pub fn closure(&self, edge: Edge) -> Vec<[f64; 2]> {
        let (least, decay, gap) = self.least(edge);
        let tail = TAIL_POINTS.map(|part| [part * least, self.datum - (gap - decay * part.ln())]);
        let computed = self.pressures.iter().zip(self.closures(edge)).map(|(p, closure)| [*p, closure]);
        [[0.0, 0.0]].into_iter().chain(tail).chain(computed).collect()
    }

    /// Returns the closure of an edge at each computed pressure.
    pub fn closures(&self, edge: Edge) -> Vec<Metre> {
        self.gaps(edge).into_iter().map(|gap| self.datum - gap).collect()
    }

    /// Whether pressures and closures of all edges rise from point to point.
    pub fn rises(&self) -> bool {
        let rises = |edge: Edge| {
            self.closure(edge).windows(2).all(|points| {
                points[0][0] < points[1][0] && points[1][1] - points[0][1] > ROUNDING * points[1][1]
            })
        };
        [Edge::Low, Edge::Median, Edge::High].into_iter().all(rises)
    }

    /// Gaps of an edge: under the same pressure the softer one has the smaller gap.
    pub(super) fn gaps(&self, edge: Edge) -> Vec<f64> {
        self.values(Kind::MeanGap, edge).expect("each sample has a gap")
    }

    /// Least computed pressure, the length over which it falls by e, and the gap there.
    fn least(&self, edge: Edge) -> (Pascal, Metre, Metre) {
        let gap = self.gaps(edge)[0];
        let stiffness = self.values(Kind::Stiffness, Edge::Median).map(|values| values[0]);
        let between = (self.pressures[1] - self.pressures[0]) / (gap - self.gaps(edge)[1]);
        let stiffness = stiffness.filter(|stiffness| *stiffness > 0.0).unwrap_or(between);
        (self.pressures[0], self.pressures[0] / stiffness, gap)
    }

    fn gap_without_pressure(&self, edge: Edge) -> Metre {
        let (_, decay, gap) = self.least(edge);
        gap + decay * (TAIL.ln() + 1.0)
    }
}

fn yields(point: &SweepRecord) -> bool {
    point.plastic_area > 0.0 || point.plastic.is_some_and(|flow| flow.max_plastic_strain > 0.0)
}

/// Checks each sample by itself.
fn checks(found: &[Vec<Found<'_>>]) -> Checks {
    let mut checks = Checks::default();
    for pair in found.windows(2) {
        for (one, next) in pair[0].iter().zip(&pair[1]) {
            let area = one.point.load / one.point.mean_pressure;
            let (Some(before), Some(after)) = (one.point.stiffness, next.point.stiffness) else { continue };
            if next.point.mean_pressure - one.point.mean_pressure < SLACK * one.point.mean_pressure {
                continue;
            }
            let secant = area * (next.point.mean_pressure - one.point.mean_pressure)
                / (one.point.mean_gap - next.point.mean_gap);
            let (least, most) = (before.min(after), before.max(after));
            checks.steps += 1;
            checks.bracketed +=
                usize::from(secant >= least * (1.0 - SLACK) && secant <= most * (1.0 + SLACK));
        }
    }
    let off = |found: &Found<'_>| {
        let quantities = &found.conductance?.quantities;
        Some((quantities.conductance? / quantities.conductance_of_stiffness? - 1.0).abs())
    };
    checks.barber = found.iter().flatten().filter_map(off).reduce(f64::max);
    checks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_band_has_the_quantiles_of_its_values() {
        let band = Band::from_values(vec![4.0, 1.0, f64::NAN, 3.0, 2.0, 5.0]).unwrap();
        assert!((band.low - 1.64).abs() < 1e-12 && band.median == 3.0);
        assert!((band.high - 4.36).abs() < 1e-12 && (band.half_width() - 1.36).abs() < 1e-12);
        let one = Band::from_values(vec![7.0]).unwrap();
        assert_eq!((one.low, one.median, one.high), (7.0, 7.0, 7.0));
        assert_eq!(Band::from_values(vec![f64::NAN]), None);
    }
}
