//! Westergaard: sinusoidal surfaces, from first touch to full contact.

use std::f64::consts::{PI, SQRT_2};

use crate::units::{Metre, Pascal};

/// Frictionless contact of a one-dimensional sinusoid with a plane, in plane strain.
///
/// h = A (1 − cos 2πx/λ): A is half the height from peak to valley, and a crest lies at x = 0. With ψ = πx/λ,
/// s = p̄/p* = sin²(πa/λ) and the half width a of one contact strip:
///
/// ```text
/// p* = π E* A/λ                        the mean pressure of full contact
/// p  = 2 p* cos ψ √(s − sin²ψ)         s < 1, |x| < a
/// p  = p̄ + p* cos 2ψ                   s ≥ 1
/// ```
/// Westergaard, J. Appl. Mech. 6, 49 (1939); Johnson (1985), eqs. 13.2–13.8.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Westergaard {
    /// Amplitude A.
    pub amplitude: Metre,
    /// Wavelength λ.
    pub wavelength: Metre,
    /// Composite modulus E*.
    pub modulus: Pascal,
    /// Mean pressure p̄ ≥ 0.
    pub mean_pressure: Pascal,
}

impl Westergaard {
    /// Mean pressure p* at which the last gap closes.
    pub fn full_contact_pressure(&self) -> Pascal {
        PI * self.modulus * self.amplitude / self.wavelength
    }

    /// s = p̄/p*, at most 1.
    fn closure(&self) -> f64 {
        (self.mean_pressure / self.full_contact_pressure()).clamp(f64::NEG_INFINITY, 1.0) // preserves NaN
    }

    /// Half width a of each strip of contact; λ/2 in full contact.
    pub fn half_width(&self) -> Metre {
        self.wavelength / PI * self.closure().sqrt().asin()
    }

    /// Fraction of the plane in contact, 2a/λ.
    pub fn contact_fraction(&self) -> f64 {
        2.0 * self.half_width() / self.wavelength
    }

    /// Pressure at `x` from a crest; 0 outside the contact.
    pub fn pressure(&self, x: Metre) -> Pascal {
        let full = self.full_contact_pressure();
        let (sin, cos) = (PI * x / self.wavelength).sin_cos();
        if self.mean_pressure >= full {
            return self.mean_pressure + full * (cos - sin) * (cos + sin);
        }
        let s = self.closure();
        if sin * sin < s { 2.0 * full * cos.abs() * (s - sin * sin).sqrt() } else { 0.0 }
    }

    /// Deformed gap at `x` from a crest; 0 in the contact.
    ///
    /// g = 2A [t √(t² − s) − s acosh(t/√s)], t = |sin ψ|: the integral of g′ = (4πA/λ) cos ψ √(sin²ψ − s).
    pub fn gap(&self, x: Metre) -> Metre {
        let s = self.closure();
        let t = (PI * x / self.wavelength).sin().abs();
        if t * t <= s {
            return 0.0;
        }
        let bend = if s > 0.0 { s * libm::acosh(t / s.sqrt()) } else { 0.0 };
        2.0 * self.amplitude * (t * (t * t - s).sqrt() - bend)
    }

    /// Mean deformed gap A (1 − s + s ln s): from A at first touch to 0 in full contact.
    pub fn mean_gap(&self) -> Metre {
        let s = self.closure();
        let log = if s > 0.0 { s * s.ln() } else { 0.0 };
        self.amplitude * (1.0 - s + log)
    }

    /// Elastic energy per apparent area, ¼ p*A s² (1 − 2 ln s), J/m²: the work ∫ p̄ d(−ḡ); ¼ p*A in full
    /// contact.
    pub fn elastic_energy(&self) -> f64 {
        let s = self.closure();
        let log = if s > 0.0 { s.ln() } else { 0.0 };
        0.25 * self.full_contact_pressure() * self.amplitude * s * s * (1.0 - 2.0 * log)
    }
}

/// Mean pressure p* = √2 π E*A/λ at which the two-dimensional sinusoid h = A (1 − cos 2πx/λ cos 2πy/λ)
/// reaches full contact; the pressure is then p̄ + p* cos 2πx/λ cos 2πy/λ.
///
/// Johnson, Greenwood & Higginson, Int. J. Mech. Sci. 27, 383 (1985).
pub fn full_contact_pressure_2d(amplitude: Metre, wavelength: Metre, modulus: Pascal) -> Pascal {
    SQRT_2 * PI * modulus * amplitude / wavelength
}

/// Fraction π (3p̄/8πp*)^{2/3} of the plane in contact with that two-dimensional sinusoid for p̄ ≪ p*: Hertz
/// on two crests per λ² with the radius λ²/4π²A. Same source.
pub fn light_contact_fraction_2d(mean_pressure: Pascal, full_contact_pressure: Pascal) -> f64 {
    PI * (3.0 / (8.0 * PI) * mean_pressure / full_contact_pressure).cbrt().powi(2)
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::{integrate, integrate_to_edge};
    use super::super::{HertzLine, HertzSphere};
    use super::*;
    use approx::assert_relative_eq;

    /// A sinusoid with p* = 0.05 π at `closure` = p̄/p*.
    fn sinusoid(closure: f64) -> Westergaard {
        let (amplitude, wavelength, modulus) = (0.02, 2.0, 5.0);
        let mean_pressure = closure * PI * modulus * amplitude / wavelength;
        Westergaard { amplitude, wavelength, modulus, mean_pressure }
    }

    #[test]
    fn the_pressure_carries_the_load() {
        for closure in [0.01, 0.3, 0.9, 1.0, 1.7] {
            let wave = sinusoid(closure);
            let load = 2.0 * integrate_to_edge(wave.half_width(), |x| wave.pressure(x));
            assert_relative_eq!(load / wave.wavelength, wave.mean_pressure, max_relative = 1e-10);
        }
    }

    #[test]
    fn the_gap_opens_as_flamants_solution_says() {
        // u′ = −(2/λE*) ∫ p(s) cot(π(x − s)/λ) ds over a period, h′ = (2πA/λ) sin 2ψ.
        let wave = sinusoid(0.3);
        let (a, length) = (wave.half_width(), wave.wavelength);
        let slope = |x: f64| {
            let cot = |s: f64| 1.0 / (PI * (x - s) / length).tan();
            let flamant = integrate_to_edge(a, |s| wave.pressure(s) * (cot(s) + cot(-s)));
            2.0 * PI * wave.amplitude / length * (2.0 * PI * x / length).sin()
                - 2.0 / (length * wave.modulus) * flamant
        };
        let (near, far) = (0.6 * a + 0.2 * length, 0.5 * length);
        assert_relative_eq!(wave.gap(far) - wave.gap(near), integrate(near, far, slope), max_relative = 1e-9);
    }

    #[test]
    fn the_mean_gap_is_the_gaps_mean() {
        for closure in [0.0, 0.01, 0.3, 0.9] {
            let wave = sinusoid(closure);
            let open = 0.5 * wave.wavelength - wave.half_width();
            let volume = 2.0 * integrate(0.0, open, |x| wave.gap(0.5 * wave.wavelength - x));
            assert_relative_eq!(volume / wave.wavelength, wave.mean_gap(), max_relative = 1e-8);
        }
    }

    #[test]
    fn partial_contact_ends_where_full_contact_begins() {
        let (below, full) = (sinusoid(1.0 - 1e-12), sinusoid(1.0));
        for x in [0.0, 0.3, 0.7] {
            assert_relative_eq!(below.pressure(x), full.pressure(x), max_relative = 1e-10);
        }
        assert_relative_eq!(full.half_width(), 1.0, max_relative = 1e-15);
        assert_relative_eq!(full.pressure(1.0), 0.0, epsilon = 1e-16);
        assert_eq!((full.mean_gap(), full.contact_fraction()), (0.0, 1.0));
    }

    #[test]
    fn light_contact_is_a_row_of_hertz_lines() {
        let wave = sinusoid(1e-6);
        let line = HertzLine {
            radius: wave.wavelength.powi(2) / (4.0 * PI * PI * wave.amplitude),
            modulus: wave.modulus,
            load_per_length: wave.mean_pressure * wave.wavelength,
        };
        assert_relative_eq!(wave.half_width(), line.half_width(), max_relative = 1e-6);
        assert_relative_eq!(wave.pressure(0.0), line.peak_pressure(), max_relative = 1e-6);
    }

    #[test]
    fn the_energy_is_the_work_of_the_load() {
        // ∫ p̄ d(−ḡ) from the slope of the mean gap, dḡ/ds = A ln s.
        let work = |closure: f64| {
            let full = sinusoid(1.0).full_contact_pressure();
            integrate(0.0, closure.cbrt(), |t| -full * 0.02 * t.powi(3) * t.powi(3).ln() * 3.0 * t * t)
        };
        for closure in [0.1, 0.5, 1.0] {
            assert_relative_eq!(sinusoid(closure).elastic_energy(), work(closure), max_relative = 1e-9);
        }
        let (low, high) = (sinusoid(0.4), sinusoid(0.4 + 1e-6));
        let step = high.elastic_energy() - low.elastic_energy();
        assert_relative_eq!(
            step / (low.mean_gap() - high.mean_gap()),
            low.mean_pressure,
            max_relative = 1e-5
        );
    }

    #[test]
    fn light_contact_in_two_dimensions_is_hertz_on_every_crest() {
        let (amplitude, wavelength, modulus) = (0.02, 2.0, 5.0);
        let full = full_contact_pressure_2d(amplitude, wavelength, modulus);
        let mean = 1e-3 * full;
        let crest = HertzSphere {
            radius: wavelength * wavelength / (4.0 * PI * PI * amplitude),
            modulus,
            load: 0.5 * mean * wavelength * wavelength,
        };
        let fraction = 2.0 * PI * (crest.contact_radius() / wavelength).powi(2);
        assert_relative_eq!(light_contact_fraction_2d(mean, full), fraction, max_relative = 1e-14);
    }
}
