//! Relaxation and creep of a linear viscoelastic body as sums of exponentials (Prony series).

use asperity_transforms::num_complex::Complex64;

use crate::error::{Error, Result, check_in};
use crate::units::{Dimension, Pascal, PerPascal, Second};

/// A modulus that relaxes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RelaxationTerm {
    /// The modulus E_k, in tension as Young's modulus, > 0.
    pub modulus: Pascal,
    /// The relaxation time τ_k, > 0.
    pub time: Second,
}

/// Relaxation modulus of a body under tension, `E(t) = E₀ + Σ E_k e^(−t/τ_k)`.
#[derive(Debug, Clone, PartialEq)]
pub struct Relaxation {
    relaxed: Pascal,
    /// By falling time.
    terms: Vec<RelaxationTerm>,
}

/// A compliance that a body reaches in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CreepTerm {
    /// The compliance J_k, > 0.
    pub compliance: PerPascal,
    /// The retardation time ρ_k, > 0.
    pub time: Second,
}

/// Creep compliance `J(t) = J_g + Σ J_k (1 − e^(−t/ρ_k))`, of a body under tension, or of a pair under
/// pressure.
#[derive(Debug, Clone, PartialEq)]
pub struct Creep {
    /// The glassy compliance J_g, with which a body answers at once.
    pub glassy: PerPascal,
    /// The terms, by falling time.
    pub terms: Vec<CreepTerm>,
}

impl Relaxation {
    /// Creates the modulus of a body with this `relaxed` modulus E₀, which it has after a long time.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a modulus or a time that is not finite and > 0; [`Error::Unsupported`] for
    /// two equal times.
    pub fn new(relaxed: Pascal, terms: impl IntoIterator<Item = RelaxationTerm>) -> Result<Self> {
        let mut terms: Vec<RelaxationTerm> = terms.into_iter().collect();
        let is_valid = |value: f64| value > 0.0 && value.is_finite();
        let modulus = |value: f64| {
            check_in(Dimension::Pressure, "modulus", value, is_valid(value), "a finite modulus above 0")
        };
        modulus(relaxed)?;
        for term in &terms {
            modulus(term.modulus)?;
            check_in(Dimension::Time, "time", term.time, is_valid(term.time), "a finite time above 0")?;
        }
        terms.sort_by(|a, b| b.time.total_cmp(&a.time));
        if terms.windows(2).any(|pair| pair[0].time == pair[1].time) {
            Err(Error::Unsupported("two moduli with the same relaxation time"))
        } else {
            Ok(Self { relaxed, terms })
        }
    }

    /// The relaxed modulus E₀.
    pub fn relaxed(&self) -> Pascal {
        self.relaxed
    }

    /// The glassy modulus, with which the body answers at once.
    pub fn glassy(&self) -> Pascal {
        self.relaxed + self.terms.iter().map(|term| term.modulus).sum::<f64>()
    }

    /// The terms, by falling time.
    pub fn terms(&self) -> &[RelaxationTerm] {
        &self.terms
    }

    /// Returns the complex modulus `E′ + iE″` at an angular frequency ω, 1/s; E″ has the sign of ω.
    pub fn complex(&self, frequency: f64) -> Complex64 {
        let term = |term: &RelaxationTerm| {
            let z = frequency * term.time;
            term.modulus * Complex64::new(z * z, z) / (1.0 + z * z)
        };
        self.terms.iter().map(term).sum::<Complex64>() + self.relaxed
    }

    /// Returns the creep compliance of the same body: `J(s) E(s) = 1` for every complex frequency s.
    ///
    /// The −1/ρ_k are the zeros of E(s) = E₀ + Σ E_k sτ_k/(1 + sτ_k): one for each time, with ρ_k between τ_k
    /// and the next larger time.
    pub fn creep(&self) -> Creep {
        let term = |index: usize| {
            let rate = self.zero(index);
            let sum =
                self.terms.iter().map(|each| each.modulus * each.time / rate.one_minus(each.time).powi(2));
            CreepTerm { compliance: 1.0 / (rate.value() * sum.sum::<f64>()), time: 1.0 / rate.value() }
        };
        Creep { glassy: 1.0 / self.glassy(), terms: (0..self.terms.len()).map(term).collect() }
    }

    /// Returns the rate r = 1/ρ at which E(−r) = 0 below the rate 1/τ of the term `index`, and above that of
    /// the term before.
    fn zero(&self, index: usize) -> Rate {
        let upper = self.terms[index].time;
        let lower = index.checked_sub(1).map(|before| self.terms[before].time);
        // E(−r) falls from +∞, or E₀, to −∞. The rate is sought from the end that is nearer, so that its
        // distance has all digits.
        let half = 0.5 * (1.0 / upper - lower.map_or(0.0, |lower| 1.0 / lower));
        let (pole, sign) = if self.at(Rate { pole: lower, distance: half }) < 0.0 {
            (lower, 1.0)
        } else {
            (Some(upper), -1.0)
        };
        let (mut least, mut most) = (f64::MIN_POSITIVE, half);
        loop {
            let distance = (least * most).sqrt();
            if distance <= least || distance >= most {
                return Rate { pole, distance: sign * most };
            }
            if (self.at(Rate { pole, distance: sign * distance }) > 0.0) == (sign > 0.0) {
                least = distance
            } else {
                most = distance
            }
        }
    }

    /// Returns E(−r).
    fn at(&self, rate: Rate) -> f64 {
        let r = rate.value();
        let term = |term: &RelaxationTerm| term.modulus * r * term.time / rate.one_minus(term.time);
        self.relaxed - self.terms.iter().map(term).sum::<f64>()
    }
}

/// A rate r, by its distance from the rate of a pole, or from 0.
#[derive(Clone, Copy)]
struct Rate {
    pole: Option<Second>,
    distance: f64,
}

impl Rate {
    fn value(self) -> f64 {
        self.pole.map_or(0.0, |pole| 1.0 / pole) + self.distance
    }

    /// Returns 1 − rτ, also next to the pole τ with all digits.
    fn one_minus(self, time: Second) -> f64 {
        (1.0 - self.pole.map_or(0.0, |pole| time / pole)) - self.distance * time
    }
}

impl Creep {
    /// Creates the compliance of a body that does not creep.
    pub fn elastic(compliance: PerPascal) -> Self {
        Self { glassy: compliance, terms: Vec::new() }
    }

    /// The compliance after a long time.
    pub fn relaxed(&self) -> PerPascal {
        self.glassy + self.terms.iter().map(|term| term.compliance).sum::<f64>()
    }

    /// Returns the compliance `time` after the load, ≥ 0.
    pub fn compliance(&self, time: Second) -> PerPascal {
        let term = |term: &CreepTerm| -term.compliance * (-time / term.time).exp_m1();
        self.glassy + self.terms.iter().map(term).sum::<f64>()
    }

    /// Returns the complex compliance at an angular frequency ω, 1/s.
    pub fn complex(&self, frequency: f64) -> Complex64 {
        let term = |term: &CreepTerm| {
            let z = frequency * term.time;
            term.compliance * Complex64::new(1.0, -z) / (1.0 + z * z)
        };
        self.terms.iter().map(term).sum::<Complex64>() + self.glassy
    }

    /// Returns the compliance times a `factor`, > 0.
    #[must_use]
    pub fn times(&self, factor: f64) -> Self {
        let term = |term: &CreepTerm| CreepTerm { compliance: factor * term.compliance, ..*term };
        Self { glassy: factor * self.glassy, terms: self.terms.iter().map(term).collect() }
    }

    /// Returns the compliance of two bodies that give way together.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        let mut terms = [&self.terms[..], &other.terms].concat();
        terms.sort_by(|a, b| b.time.total_cmp(&a.time));
        Self { glassy: self.glassy + other.glassy, terms }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt as _, SeedableRng as _};

    fn relaxation(relaxed: f64, terms: &[(f64, f64)]) -> Relaxation {
        let terms = terms.iter().map(|&(modulus, time)| RelaxationTerm { modulus, time });
        Relaxation::new(relaxed, terms).unwrap()
    }

    /// Largest relative difference of J(ω) E(ω) from 1 over the decades of the times and two beyond them.
    fn inverse(relaxation: &Relaxation) -> f64 {
        let creep = relaxation.creep();
        let rates = relaxation.terms.iter().map(|term| -term.time.log10());
        let (least, most) =
            rates.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), rate| (a.min(rate), b.max(rate)));
        let frequencies =
            (0..=200).map(|n| 10f64.powf(least - 2.0 + (most - least + 4.0) * f64::from(n) / 200.0));
        frequencies.map(|w| (creep.complex(w) * relaxation.complex(w) - 1.0).norm()).fold(0.0, f64::max)
    }

    #[test]
    fn creep_and_relaxation_are_inverse_over_eight_decades() {
        let decades: Vec<_> = (0..9).map(|n| (10f64.powi(9 - n), 10f64.powi(-n))).collect();
        assert!(inverse(&relaxation(1.0, &[(2.0, 1.0), (5.0, 0.1), (30.0, 3e-3)])) < 1e-14);
        assert!(inverse(&relaxation(3e6, &decades)) < 1e-12);
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        for _ in 0..300 {
            let terms: Vec<_> = (0..random.random_range(1..14))
                .map(|_| {
                    (10f64.powf(random.random_range(-3.0..9.0)), 10f64.powf(random.random_range(-8.0..0.0)))
                })
                .collect();
            let body = relaxation(10f64.powf(random.random_range(0.0..7.0)), &terms);
            assert!(inverse(&body) < 1e-12, "{:e} {body:?}", inverse(&body));
            let creep = body.creep();
            for (creep, relaxation) in creep.terms.iter().zip(&body.terms) {
                assert!(creep.compliance > 0.0 && creep.time >= relaxation.time);
            }
            assert!((creep.relaxed() * body.relaxed() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_single_time_is_retarded_by_the_ratio_of_the_moduli() {
        let creep = relaxation(1.0, &[(9.0, 0.1)]).creep();
        assert!((creep.terms[0].time - 1.0).abs() < 1e-15 && (creep.terms[0].compliance - 0.9).abs() < 1e-15);
        assert!(
            (creep.compliance(0.0) - 0.1).abs() < 1e-16
                && (creep.compliance(1.0) - (1.0 - 0.9 * (-1f64).exp())).abs() < 1e-15
        );
        let pair = creep.plus(&Creep::elastic(0.5)).times(2.0);
        assert!((pair.glassy - 1.2).abs() < 1e-15 && (pair.relaxed() - 3.0).abs() < 1e-15);
    }

    #[test]
    fn nonsense_is_refused() {
        for (relaxed, terms) in [
            (0.0, vec![(1.0, 1.0)]),
            (f64::INFINITY, vec![(1.0, 1.0)]),
            (1.0, vec![(-1.0, 1.0)]),
            (1.0, vec![(1.0, 0.0)]),
            (1.0, vec![(1.0, 1.0), (2.0, 1.0)]),
        ] {
            let terms = terms.into_iter().map(|(modulus, time)| RelaxationTerm { modulus, time });
            assert!(Relaxation::new(relaxed, terms).is_err());
        }
    }
}
