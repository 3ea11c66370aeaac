//! Reasons not to trust a law.

use super::law::{Band, Edge, Law};
use super::quantities::Kind;
use super::samples::MAX_SAMPLES;
use asperity_base::units::{Dimension, format, format_number_digits};

/// Roll-off wavelength over the correlation length of self-affine surfaces: 2.9 to 3.6 for Hurst exponents of 0.5 to 1, and
/// down to 2.7 where the shortest wavelength is a quarter of it.
const ROLLOFF: f64 = 3.1;

/// Roll-off wavelengths along a sample from which on it is a law.
const ENOUGH: f64 = 8.0;

/// Relative error of the roll-off wavelength that is estimated from the correlation length.
const ROLLOFF_UNCERTAINTY: f64 = 0.15;

/// Ratio of an rms height to the median beyond which samples are of different surfaces.
const UNLIKE: f64 = 2.0;

/// Length over which the pressure falls by e, over σ, below which single cells bear. By Persson's theory it is 0.4.
const FEW_CELLS: f64 = 0.04;

/// Contact fraction of a full contact, but for rounding.
const FULL: f64 = 1.0 - 1e-9;

impl Law {
    /// Returns reasons not to trust the law: warnings about its samples, what it leaves out, and what is wrong with it as a
    /// law.
    pub fn doubts(&self) -> Vec<String> {
        let own = [
            self.missing_samples(),
            self.single_sample(),
            self.short_samples(),
            self.unlike_samples(),
            self.few_cells(),
            self.full_contact().or_else(|| self.falls()),
            self.far_apart(),
        ];
        own.into_iter().flatten().chain(self.warnings.iter().cloned()).collect()
    }

    fn missing_samples(&self) -> Option<String> {
        let all = self.missing + self.samples;
        (self.missing > 0).then(|| format!("{} of {all} samples have failed or are not done", self.missing))
    }

    fn single_sample(&self) -> Option<String> {
        (self.samples == 1 && self.missing == 0).then(|| {
            "the law is that of one sample, and its scatter is unknown: give `samples = 8` or `patches = [4, 4]` in [joint]".to_owned()
        })
    }

    fn short_samples(&self) -> Option<String> {
        let lengths = self.theories.first().and_then(|row| row.correlation_length);
        let rolloff = ROLLOFF * lengths.unwrap_or(f64::INFINITY);
        if rolloff <= 0.0 || self.side >= (1.0 - ROLLOFF_UNCERTAINTY) * ENOUGH * rolloff {
            return None;
        }
        let about = if rolloff.is_finite() {
            let waves = format_number_digits(self.side / rolloff, 2);
            format!("about {waves} roll-off wavelengths of {}", format(rolloff, Dimension::Length))
        } else {
            "less than a wave of its roughness".to_owned()
        };
        let more = match 4 * self.samples {
            more if more <= MAX_SAMPLES => {
                format!(", or {more} samples of this length to halve the uncertainty of their median")
            }
            _ => String::new(),
        };
        Some(format!(
            "a sample is only {about} long: it is a curve of its own, and no law; take samples of at least {ENOUGH}{more}"
        ))
    }

    fn unlike_samples(&self) -> Option<String> {
        let Band { low, median, high } = self.rms_height;
        (low < median / UNLIKE || high > UNLIKE * median).then(|| {
            let [low, high] = [low, high].map(|height| format(height, Dimension::Length));
            format!(
                "the rms heights of the samples go from {low} to {high} (quantiles 0.16 and 0.84): they are of different surfaces, and their median is \
                 the law of none"
            )
        })
    }

    fn few_cells(&self) -> Option<String> {
        let stiffness = self.values(Kind::Stiffness, Edge::Median)?;
        let few = |(p, stiffness): (&f64, &f64)| p / stiffness < FEW_CELLS * self.rms_height.median;
        let count = self.pressures.iter().zip(&stiffness).take_while(|pair| few(*pair)).count();
        let last = self.pressures[count.checked_sub(1)?];
        Some(format!(
            "up to {} only a few cells of a sample bear, and the law is theirs: leave these loads out, or take larger samples",
            format(last, Dimension::Pressure)
        ))
    }

    fn full_contact(&self) -> Option<String> {
        let area = self.values(Kind::ContactFraction, Edge::Median)?;
        let first = area.iter().position(|fraction| *fraction >= FULL)?;
        Some(format!(
            "from {} on the surfaces touch everywhere, and their gap no longer falls: leave these loads out",
            format(self.pressures[first], Dimension::Pressure)
        ))
    }

    fn falls(&self) -> Option<String> {
        (!self.rises()).then(|| {
            "the pressure does not rise with the closure everywhere, and no program takes such a law: compute more samples, or fewer loads"
                .to_owned()
        })
    }

    fn far_apart(&self) -> Option<String> {
        let outside = self.checks.steps - self.checks.bracketed;
        (outside > 0).then(|| {
            format!(
                "in {outside} of {} steps between loads the secant stiffness lies outside those at both ends: the loads are too far apart or \
                 the samples too coarse",
                self.checks.steps
            )
        })
    }
}
