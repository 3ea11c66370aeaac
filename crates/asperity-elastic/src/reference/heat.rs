//! Temperature of half-spaces with a heated surface.
//!
//! Temperatures are relative to that far away. Fluxes are positive into the body.

use std::f64::consts::{FRAC_2_SQRT_PI, PI};

use crate::units::{Kelvin, Metre, MetrePerSecond, Second, WattPerSquareMetre};

/// A square of uniform flux on a half-space that moves along x, parallel to a side, in the steady state.
///
/// ```text
/// T = (q √D/λ) ∫ [erf((X + l)/s) − erf((X − l)/s)] [erf((y + l)/s) − erf((y − l)/s)]/4√(πt) dt,  X = x − Vt,  s = 2√(Dt)
/// ```
/// by the trapezoidal rule in ln t, accurate to round-off. Carslaw and Jaeger, *Conduction of Heat in
/// Solids*, chapter X.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SquareSource {
    /// Half side l > 0.
    pub half_side: Metre,
    /// Flux q into the body.
    pub flux: WattPerSquareMetre,
    /// Conductivity λ > 0, W/(m K).
    pub conductivity: f64,
    /// Diffusivity D > 0, m²/s.
    pub diffusivity: f64,
    /// Speed V ≥ 0 of the body along x.
    pub speed: MetrePerSecond,
}

impl SquareSource {
    /// Péclet number Vl/2D.
    pub fn peclet(&self) -> f64 {
        0.5 * self.speed * self.half_side / self.diffusivity
    }

    /// Temperature at a point of the surface, relative to the centre of the square.
    pub fn temperature(&self, x: Metre, y: Metre) -> Kelvin {
        let [x, y] = [x, y].map(|at| at / self.half_side);
        let peclet = self.peclet();
        // In units l of length and l²/D of time, s = 2√t, X = x − 2 Pe t: the contribution of d(ln √t).
        let added = |root: f64| {
            let between =
                |at: f64| libm::erf((at + 1.0) / (2.0 * root)) - libm::erf((at - 1.0) / (2.0 * root));
            root * between(x - 2.0 * peclet * root * root) * between(y)
        };
        let step = 0.02;
        let sum: f64 = (-1900..1900).map(|n| added((step * f64::from(n)).exp())).sum();
        self.flux * self.half_side / self.conductivity * 0.25 * FRAC_2_SQRT_PI * step * sum
    }

    /// The largest temperature, on the line y = 0. It is in the middle at rest, and moves backwards with
    /// increasing speed.
    pub fn max_temperature(&self) -> Kelvin {
        let at = |x: f64| self.temperature(x * self.half_side, 0.0);
        // Golden-section search over 0 … l, where there is one maximum.
        let ratio = 0.5 * (5f64.sqrt() - 1.0);
        let (mut lo, mut hi) = (0.0, 1.0);
        let inner = |lo: f64, hi: f64| [hi - ratio * (hi - lo), lo + ratio * (hi - lo)];
        let mut points = inner(lo, hi);
        let mut values = points.map(at);
        while hi - lo > 1e-6 {
            if values[0] > values[1] {
                hi = points[1];
                points = inner(lo, hi);
                values = [at(points[0]), values[0]];
            } else {
                lo = points[0];
                points = inner(lo, hi);
                values = [values[1], at(points[1])];
            }
        }
        values[0].max(values[1]).max(at(0.0))
    }

    /// The largest temperature by the fit of Tian and Kennedy, 2ql/λ√(π(1.011 + Pe)), between 0.7 % above and
    /// 2.6 % below the exact one. J. Tribol. 116, 167 (1994).
    pub fn max_temperature_fit(&self) -> Kelvin {
        2.0 * self.flux * self.half_side / (self.conductivity * (PI * (1.011 + self.peclet())).sqrt())
    }
}

/// An infinite band of uniform flux on a half-space that moves across it, along x, in the steady state.
///
/// ```text
/// T λ/qb = [F(Pe(ξ + 1)) − F(Pe(ξ − 1))]/π Pe,  F(u) = u e^u (K₀(|u|) + sgn(u) K₁(|u|)),  ξ = x/b
/// ```
/// Jaeger, Proc. R. Soc. N.S.W. 76, 203 (1942).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BandSource {
    /// Half width b > 0.
    pub half_width: Metre,
    /// Flux q into the body.
    pub flux: WattPerSquareMetre,
    /// Conductivity λ > 0, W/(m K).
    pub conductivity: f64,
    /// Diffusivity D > 0, m²/s.
    pub diffusivity: f64,
    /// Speed V > 0 of the body along x; there is no steady state at rest.
    pub speed: MetrePerSecond,
}

impl BandSource {
    /// Péclet number Vb/2D.
    pub fn peclet(&self) -> f64 {
        0.5 * self.speed * self.half_width / self.diffusivity
    }

    /// Temperature of the surface at `x` relative to the middle of the band.
    pub fn temperature(&self, x: Metre) -> Kelvin {
        let (peclet, at) = (self.peclet(), x / self.half_width);
        let term = |u: f64| {
            if u == 0.0 {
                return 1.0;
            }
            let [zeroth, first] = scaled_bessel(u.abs());
            let scale = if u > 0.0 { 1.0 } else { (2.0 * u).exp() };
            u * scale * (zeroth + u.signum() * first)
        };
        let unit = self.flux * self.half_width / self.conductivity;
        unit * (term(peclet * (at + 1.0)) - term(peclet * (at - 1.0))) / (PI * peclet)
    }
}

/// Uniform flux over a disc on a half-space at rest, starting at time 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeatedDisc {
    /// Radius a > 0.
    pub radius: Metre,
    /// Flux q into the body.
    pub flux: WattPerSquareMetre,
    /// Conductivity λ > 0, W/(m K).
    pub conductivity: f64,
    /// Diffusivity D > 0, m²/s.
    pub diffusivity: f64,
}

impl HeatedDisc {
    /// Temperature of the centre after a `time` ≥ 0: 2q√(Dt)/λ [1/√π − ierfc(a/2√(Dt))], finally qa/λ.
    /// Carslaw and Jaeger, *Conduction of Heat in Solids*, chapter X.
    pub fn centre(&self, time: Second) -> Kelvin {
        let length = 2.0 * (self.diffusivity * time).sqrt();
        let u = self.radius / length;
        let root = 0.5 * FRAC_2_SQRT_PI;
        // 1/√π − ierfc(u).
        let share = u * libm::erfc(u) - root * (-u * u).exp_m1();
        if time == 0.0 { 0.0 } else { self.flux * length / self.conductivity * share }
    }
}

/// A flux distributed like Hertz' pressure, q = (3q̄/2) √(1 − r²/a²), on a half-space at rest, in the steady
/// state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HertzianFlux {
    /// Radius a > 0.
    pub radius: Metre,
    /// Mean flux q̄ into the body.
    pub mean_flux: WattPerSquareMetre,
    /// Conductivity λ > 0, W/(m K).
    pub conductivity: f64,
}

impl HertzianFlux {
    /// Flux at the distance `r` from the centre.
    pub fn flux(&self, r: Metre) -> WattPerSquareMetre {
        1.5 * self.mean_flux * (1.0 - (r / self.radius).powi(2)).max(0.0).sqrt()
    }

    /// Temperature at `r ≤ a`, (3πq̄a/8λ)(1 − r²/2a²): Hertz' displacement for E* = 2λ.
    pub fn temperature(&self, r: Metre) -> Kelvin {
        3.0 * PI * self.mean_flux * self.radius / (8.0 * self.conductivity)
            * (1.0 - 0.5 * (r / self.radius).powi(2))
    }
}

/// e^u K₀(u) and e^u K₁(u) for u > 0: ∫ e^(−u(cosh t − 1)) (1, cosh t) dt by the trapezoidal rule, accurate
/// to round-off.
fn scaled_bessel(u: f64) -> [f64; 2] {
    let step = 0.2 / (1.0 + 0.1 * u).sqrt();
    let last = ((1.0 + 50.0 / u).acosh() / step).ceil() as usize;
    let mut sums = [0.5; 2];
    for n in 1..=last {
        let cosh = (step * n as f64).cosh();
        let value = (-u * (cosh - 1.0)).exp();
        sums = [sums[0] + value, sums[1] + value * cosh];
    }
    sums.map(|sum| step * sum)
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::integrate;
    use super::*;
    use approx::assert_relative_eq;

    /// λ = D = q = 1.
    fn square(peclet: f64) -> SquareSource {
        let (half_side, flux) = (1.0, 1.0);
        SquareSource { half_side, flux, conductivity: 1.0, diffusivity: 1.0, speed: 2.0 * peclet }
    }

    #[test]
    fn the_square_is_as_hot_as_published_and_near_to_the_fit() {
        let centre = 4.0 * (1.0 + 2f64.sqrt()).ln() / PI;
        assert_relative_eq!(square(0.0).max_temperature(), centre, max_relative = 1e-13);
        for (peclet, expected) in
            [(0.0, 1.12220), (1.0, 0.79678), (5.0, 0.47269), (10.0, 0.34717), (100.0, 0.11244)]
        {
            let hottest = square(peclet).max_temperature();
            assert!((hottest - expected).abs() < 6e-6, "{peclet}: {hottest}");
            let fit = square(peclet).max_temperature_fit() / hottest - 1.0;
            assert!((-0.027..0.007).contains(&fit), "{peclet}: {fit}");
        }
    }

    #[test]
    fn the_band_is_the_integral_over_its_lines() {
        let band = |peclet: f64| BandSource {
            half_width: 1.0,
            flux: 1.0,
            conductivity: 1.0,
            diffusivity: 1.0,
            speed: 2.0 * peclet,
        };
        for (peclet, x) in [(1.0, 0.3), (3.0, -0.5), (0.2, 0.9)] {
            // With s = x ± v³, because of the logarithm at x.
            let line = |u: f64| u.exp() * (-u.abs()).exp() * scaled_bessel(u.abs())[0];
            let part = |side: f64, length: f64| {
                integrate(0.0, length.cbrt(), |v| 3.0 * v * v * line(-side * peclet * v.powi(3)))
            };
            let sum = (part(1.0, 1.0 - x) + part(-1.0, 1.0 + x)) / PI;
            assert_relative_eq!(band(peclet).temperature(x), sum, max_relative = 1e-8);
        }
        for (peclet, expected) in [(1.0, 0.99185), (10.0, 0.34850)] {
            let largest =
                (0..2000).map(|k| band(peclet).temperature(f64::from(k) / 2000.0)).fold(0.0, f64::max);
            assert!((largest - expected).abs() < 6e-6, "{peclet}: {largest}");
        }
    }

    #[test]
    fn a_disc_is_a_plane_at_first_and_settles_at_the_end() {
        let disc = HeatedDisc { radius: 1.0, flux: 1.0, conductivity: 1.0, diffusivity: 1.0 };
        assert_eq!(disc.centre(0.0), 0.0);
        assert_relative_eq!(disc.centre(1e-3), 2.0 * (1e-3 / PI).sqrt(), max_relative = 1e-12);
        assert_relative_eq!(disc.centre(1e8), 1.0, max_relative = 1e-4);
        let past = |t: f64| integrate(0.0, t.sqrt(), |s| FRAC_2_SQRT_PI * (1.0 - (-0.25 / (s * s)).exp()));
        assert_relative_eq!(disc.centre(0.7), past(0.7), max_relative = 1e-12);
    }

    #[test]
    fn bessel_functions_are_those_of_the_tables() {
        // Abramowitz & Stegun (1964), tables 9.8.
        for (u, zeroth, first) in [
            (0.1, 2.427_069_024_702_017, 9.853_844_780_870_606),
            (1.0, 0.421_024_438_240_708_3, 0.601_907_230_197_234_6),
            (5.0, 3.691_098_334_042_594e-3, 4.044_613_445_452_164e-3),
        ] {
            let scaled = scaled_bessel(u);
            assert_relative_eq!(scaled[0] * (-u).exp(), zeroth, max_relative = 1e-13);
            assert_relative_eq!(scaled[1] * (-u).exp(), first, max_relative = 1e-13);
        }
    }

    #[test]
    fn hertzian_flux_has_its_mean_and_warms_as_hertz_presses() {
        let heat = HertzianFlux { radius: 2.0, mean_flux: 3.0, conductivity: 5.0 };
        let total = integrate(0.0, 2.0, |r| 2.0 * PI * r * heat.flux(r));
        assert_relative_eq!(total / (4.0 * PI), 3.0, max_relative = 1e-4);
        let hertz = super::super::HertzSphere { radius: 1.0, modulus: 10.0, load: 12.0 * PI };
        let scaled =
            HertzianFlux { radius: hertz.contact_radius(), mean_flux: hertz.peak_pressure() / 1.5, ..heat };
        assert_relative_eq!(scaled.temperature(0.0), hertz.approach(), max_relative = 1e-13);
    }
}
