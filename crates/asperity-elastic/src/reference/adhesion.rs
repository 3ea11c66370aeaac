//! Bodies that attract each other: spheres, a flat punch and a sinusoidal surface.
//!
//! The work of adhesion w is the energy that separates an area of flat surfaces. Loads W and approaches δ are
//! below 0 where the bodies are pulled. In the theory of Johnson, Kendall and Roberts (JKR) the attraction
//! has no range. That of Derjaguin, Muller and Toporov (DMT) is the limit of a long range, that of Maugis
//! lies between them.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::units::{Joule, JoulePerSquareMetre, Metre, Newton, Pascal};

/// Adhesive contact of two spheres by Johnson, Kendall and Roberts, in terms of the contact radius a:
/// attraction without range.
///
/// ```text
/// W = 4E*a³/3R − √(8πwE*a³),   δ = a²/R − √(2πwa/E*)
/// p = 2E*a/πR √(1 − r²/a²) − √(2wE*/πa) / √(1 − r²/a²)
/// ```
/// Valid for a Tabor parameter above about 5. Johnson, Kendall & Roberts, Proc. R. Soc. A 324, 301 (1971).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JkrSphere {
    /// Relative radius R: 1/R = 1/R₁ + 1/R₂.
    pub radius: Metre,
    /// Composite modulus E*.
    pub modulus: Pascal,
    /// Work of adhesion w ≥ 0; without it the contact is that of Hertz.
    pub work: JoulePerSquareMetre,
}

impl JkrSphere {
    /// Load W at the contact radius `a`.
    pub fn load(&self, a: Metre) -> Newton {
        let cube = a.powi(3);
        4.0 * self.modulus * cube / (3.0 * self.radius) - (8.0 * PI * self.work * self.modulus * cube).sqrt()
    }

    /// Rigid-body approach δ at the contact radius `a`.
    pub fn approach(&self, a: Metre) -> Metre {
        a * a / self.radius - self.withdrawal(a)
    }

    /// Withdrawal √(2πwa/E*) of the punch-like part of the solution.
    fn withdrawal(&self, a: Metre) -> Metre {
        (2.0 * PI * self.work * a / self.modulus).sqrt()
    }

    /// Pressure at distance `r` from the axis: infinite tension at the edge, 0 outside the contact.
    pub fn pressure(&self, a: Metre, r: Metre) -> Pascal {
        if r.abs() >= a {
            return 0.0;
        }
        let root = ((1.0 - r / a) * (1.0 + r / a)).sqrt();
        let hertz = 2.0 * self.modulus * a / (PI * self.radius);
        hertz * root - (2.0 * self.work * self.modulus / (PI * a)).sqrt() / root
    }

    /// Elastic energy stored in both bodies, 8E*a⁵/15R² − (4E*a³/3R) √(2πwa/E*) + 2πwa².
    pub fn elastic_energy(&self, a: Metre) -> Joule {
        let hertz = 8.0 * self.modulus * a.powi(5) / (15.0 * self.radius * self.radius);
        let load = 4.0 * self.modulus * a.powi(3) / (3.0 * self.radius);
        hertz - load * self.withdrawal(a) + 2.0 * PI * self.work * a * a
    }

    /// Pull-off force under a load, −1.5 πwR, for any modulus.
    pub fn pull_off(&self) -> Newton {
        -1.5 * PI * self.work * self.radius
    }

    /// Contact radius at the pull-off force: a³ = 9πwR²/8E*.
    pub fn pull_off_radius(&self) -> Metre {
        (9.0 * self.cube()).cbrt()
    }

    /// Contact radius at which spheres held by their approach let go: a³ = πwR²/8E*. The load is then
    /// −5πwR/6.
    pub fn separation_radius(&self) -> Metre {
        self.cube().cbrt()
    }

    /// πwR²/8E*.
    fn cube(&self) -> f64 {
        PI * self.work * self.radius * self.radius / (8.0 * self.modulus)
    }
}

/// Adhesive contact of two spheres by Derjaguin, Muller and Toporov, in terms of the contact radius a:
/// attraction so long that it does not deform the bodies.
///
/// W = 4E*a³/3R − 2πwR,  δ = a²/R. Valid for a Tabor parameter below about 0.1.
/// Derjaguin, Muller & Toporov, J. Colloid Interface Sci. 53, 314 (1975).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DmtSphere {
    /// Relative radius R: 1/R = 1/R₁ + 1/R₂.
    pub radius: Metre,
    /// Composite modulus E*.
    pub modulus: Pascal,
    /// Work of adhesion w ≥ 0.
    pub work: JoulePerSquareMetre,
}

impl DmtSphere {
    /// Load W at the contact radius `a`.
    pub fn load(&self, a: Metre) -> Newton {
        4.0 * self.modulus * a.powi(3) / (3.0 * self.radius) + self.pull_off()
    }

    /// Rigid-body approach δ at the contact radius `a`.
    pub fn approach(&self, a: Metre) -> Metre {
        a * a / self.radius
    }

    /// Pull-off force −2πwR, at the contact radius 0.
    pub fn pull_off(&self) -> Newton {
        -2.0 * PI * self.work * self.radius
    }
}

/// Adhesive contact of two spheres by Maugis, in terms of the contact radius a: a constant tension σ₀ up to
/// the gap w/σ₀, which ends at the radius c = ma. This is
/// [`Potential::Dugdale`](crate::solver::adhesion::Potential::Dugdale).
///
/// With K = 4E*/3, A = a/(πwR²/K)^⅓, λ = 2σ₀/(πwK²/R)^⅓, μ = √(m² − 1) and t = atan μ:
///
/// ```text
/// 1 = ½λA² [μ + (m² − 2) t] + (4/3) λ²A [μt − m + 1]
/// W = πwR [A³ − λA² (μ + m² t)],   δ = (π²w²R/K²)^⅓ [A² − (4/3) λAμ]
/// ```
/// It becomes JKR for λ → ∞ and DMT for λ → 0. Maugis, J. Colloid Interface Sci. 150, 243 (1992).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MaugisSphere {
    /// Relative radius R: 1/R = 1/R₁ + 1/R₂.
    pub radius: Metre,
    /// Composite modulus E*.
    pub modulus: Pascal,
    /// Work of adhesion w > 0.
    pub work: JoulePerSquareMetre,
    /// Tension σ₀ > 0.
    pub tension: Pascal,
}

impl MaugisSphere {
    /// Creates the contact with the parameter λ > 0.
    pub fn from_lambda(radius: Metre, modulus: Pascal, work: JoulePerSquareMetre, lambda: f64) -> Self {
        let unit = Self { radius, modulus, work, tension: 1.0 };
        Self { tension: lambda / unit.lambda(), ..unit }
    }

    /// Maugis' parameter λ = 2σ₀/(πwK²/R)^⅓; 1.16 times Tabor's for the same tension.
    pub fn lambda(&self) -> f64 {
        2.0 * self.tension / (PI * self.work * self.stiffness().powi(2) / self.radius).cbrt()
    }

    /// K = 4E*/3.
    fn stiffness(&self) -> Pascal {
        4.0 / 3.0 * self.modulus
    }

    /// Unit of the contact radius, (πwR²/K)^⅓.
    fn unit(&self) -> Metre {
        (PI * self.work * self.radius * self.radius / self.stiffness()).cbrt()
    }

    /// Radius c of the zone of attraction over the contact radius `a`.
    pub fn outer_ratio(&self, a: Metre) -> f64 {
        let (a, lambda) = (a / self.unit(), self.lambda());
        let opening = |m: f64| {
            let (mu, t) = angle(m);
            0.5 * lambda * a * a * (mu + (m * m - 2.0) * t)
                + 4.0 / 3.0 * lambda * lambda * a * (mu * t - m + 1.0)
                - 1.0
        };
        let mut above = 2.0;
        while opening(above) < 0.0 && above < f64::MAX {
            above *= 2.0;
        }
        root(1.0, above, opening)
    }

    /// Load W at the contact radius `a`.
    pub fn load(&self, a: Metre) -> Newton {
        let m = self.outer_ratio(a);
        let (mu, t) = angle(m);
        let (a, lambda) = (a / self.unit(), self.lambda());
        PI * self.work * self.radius * (a.powi(3) - lambda * a * a * (mu + m * m * t))
    }

    /// Rigid-body approach δ at the contact radius `a`.
    pub fn approach(&self, a: Metre) -> Metre {
        let (mu, _) = angle(self.outer_ratio(a));
        let unit = self.unit();
        let (a, lambda) = (a / unit, self.lambda());
        unit * unit / self.radius * (a * a - 4.0 / 3.0 * lambda * a * mu)
    }

    /// Contact radius at the pull-off force.
    pub fn pull_off_radius(&self) -> Metre {
        // JKR's radius, 1.145 units, is the largest.
        let radii: Vec<f64> =
            (1..=SAMPLES).map(|n| 1.2 * self.unit() * f64::from(n) / f64::from(SAMPLES)).collect();
        let least =
            |best: usize, n: usize| if self.load(radii[n]) < self.load(radii[best]) { n } else { best };
        let best = (0..radii.len()).fold(0, least);
        let from = if best == 0 { 1e-3 * radii[0] } else { radii[best - 1] };
        minimum(from, radii[(best + 1).min(radii.len() - 1)], |a| self.load(a))
    }

    /// Pull-off force, the least load: from −2πwR for λ → 0 to −1.5πwR for λ → ∞.
    pub fn pull_off(&self) -> Newton {
        self.load(self.pull_off_radius())
    }
}

/// Number of contact radii among which the least load is searched first.
const SAMPLES: i32 = 60;

/// μ = √(m² − 1) and atan μ.
fn angle(m: f64) -> (f64, f64) {
    let mu = ((m - 1.0) * (m + 1.0)).sqrt();
    (mu, mu.atan())
}

/// Root of a function that rises from below 0 to above 0, by bisection to the last digit.
fn root(mut below: f64, mut above: f64, f: impl Fn(f64) -> f64) -> f64 {
    loop {
        let middle = 0.5 * (below + above);
        if !(below < middle && middle < above) {
            return middle;
        }
        if f(middle) < 0.0 { below = middle } else { above = middle }
    }
}

/// Place of the minimum of a function with one minimum, by the golden section.
fn minimum(mut from: f64, mut to: f64, f: impl Fn(f64) -> f64) -> f64 {
    let golden = 0.5 * (5.0f64.sqrt() - 1.0);
    for _ in 0..60 {
        let [left, right] = [to - golden * (to - from), from + golden * (to - from)];
        if f(left) < f(right) { to = right } else { from = left }
    }
    0.5 * (from + to)
}

/// Flat-ended cylinder that adheres to an elastic body, by Kendall: attraction without range.
///
/// The punch lets go all at once as soon as the energy released pays for the surfaces, W²/8πE*a³ = w.
/// Kendall, J. Phys. D 4, 1186 (1971).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KendallPunch {
    /// Radius a of the punch.
    pub radius: Metre,
    /// Composite modulus E*.
    pub modulus: Pascal,
    /// Work of adhesion w ≥ 0.
    pub work: JoulePerSquareMetre,
}

impl KendallPunch {
    /// Pull-off force −√(8πE*wa³).
    pub fn pull_off(&self) -> Newton {
        -(8.0 * PI * self.modulus * self.work * self.radius.powi(3)).sqrt()
    }

    /// Approach at the pull-off force, −√(2πwa/E*).
    pub fn approach(&self) -> Metre {
        0.5 * self.pull_off() / (self.radius * self.modulus)
    }
}

/// Adhesive contact of a one-dimensional sinusoid with a plane by Johnson, in terms of the half width b of a
/// contact strip: attraction without range.
///
/// h = A (1 − cos 2πx/L). With p* = πE*A/L and α = √(2wL/E*)/πA:
///
/// ```text
/// p̄/p* = sin²(πb/L) − α √tan(πb/L)
/// ```
/// The strip grows in jumps where p̄ has an extremum, 4 sin^(3/2) ψ cos^(5/2) ψ = α with ψ = πb/L. For α
/// above 1.065 there is none, and the surfaces jump from touch to full contact. Johnson, Int. J. Solids
/// Struct. 32, 423 (1995).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AdhesiveWave {
    /// Amplitude A, half the height from peak to valley.
    pub amplitude: Metre,
    /// Wavelength L.
    pub wavelength: Metre,
    /// Composite modulus E*.
    pub modulus: Pascal,
    /// Work of adhesion w ≥ 0; without it the contact is that of Westergaard.
    pub work: JoulePerSquareMetre,
}

impl AdhesiveWave {
    /// Creates the wave with the parameter α ≥ 0: w = π²A²α²E*/2L.
    pub fn from_alpha(amplitude: Metre, wavelength: Metre, modulus: Pascal, alpha: f64) -> Self {
        let work = (PI * amplitude * alpha).powi(2) * modulus / (2.0 * wavelength);
        Self { amplitude, wavelength, modulus, work }
    }

    /// Mean pressure p* of full contact without adhesion.
    pub fn full_contact_pressure(&self) -> Pascal {
        PI * self.modulus * self.amplitude / self.wavelength
    }

    /// Johnson's parameter α.
    pub fn alpha(&self) -> f64 {
        (2.0 * self.work * self.wavelength / self.modulus).sqrt() / (PI * self.amplitude)
    }

    /// Mean pressure p̄ at the half width `b` of each strip, 0 … L/2.
    pub fn mean_pressure(&self, b: Metre) -> Pascal {
        let psi = PI * b / self.wavelength;
        self.full_contact_pressure() * (psi.sin().powi(2) - self.alpha() * psi.tan().sqrt())
    }

    /// Half width of the strips at pull-off, the least mean pressure; NaN if α is too large.
    pub fn pull_off_half_width(&self) -> Metre {
        self.turn(0.0)
    }

    /// Half width of the strips from which the surfaces jump into full contact; NaN if α is too large.
    pub fn closing_half_width(&self) -> Metre {
        self.turn(FRAC_PI_2)
    }

    /// Half width at the extremum of p̄ between ψ = `limit` and the ψ of the largest α.
    fn turn(&self, limit: f64) -> Metre {
        let alpha = self.alpha();
        let largest = 0.6f64.sqrt().atan();
        let psi = |share: f64| limit + share * (largest - limit);
        let turning = |psi: f64| 4.0 * psi.sin().powf(1.5) * psi.cos().powf(2.5) - alpha;
        if alpha.is_nan() || turning(largest) < 0.0 {
            return f64::NAN;
        }
        self.wavelength / PI * psi(root(0.0, 1.0, |share| turning(psi(share))))
    }

    /// Least mean pressure, at pull-off; NaN if α is too large.
    pub fn pull_off(&self) -> Pascal {
        self.mean_pressure(self.pull_off_half_width())
    }

    /// Mean pressure at which the surfaces jump into full contact; NaN if α is too large.
    pub fn closing_pressure(&self) -> Pascal {
        self.mean_pressure(self.closing_half_width())
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_1_PI;

    use approx::assert_relative_eq;

    use super::super::quadrature::{integrate, integrate_to_edge};
    use super::super::{FlatPunch, HertzSphere, Westergaard};
    use super::*;

    /// Loads are in πwR, lengths in the units of Maugis.
    const JKR: JkrSphere = JkrSphere { radius: 1.0, modulus: 0.75, work: FRAC_1_PI };

    fn maugis(lambda: f64) -> MaugisSphere {
        MaugisSphere::from_lambda(1.0, 0.75, FRAC_1_PI, lambda)
    }

    #[test]
    fn a_sphere_lets_go_at_its_least_load_or_at_its_least_approach() {
        let (loose, held) = (JKR.pull_off_radius(), JKR.separation_radius());
        assert_relative_eq!(JKR.load(loose), -1.5, max_relative = 1e-14);
        assert_relative_eq!(JKR.pull_off(), -1.5, max_relative = 1e-15);
        assert_relative_eq!(held, 0.550_321_2, max_relative = 1e-7);
        assert_relative_eq!(JKR.load(held), -5.0 / 6.0, max_relative = 1e-14);
        assert_relative_eq!(JKR.approach(held), -0.908_560_3, max_relative = 1e-7);
        for step in [-1e-3, 1e-3] {
            assert!(JKR.load(loose + step) > JKR.load(loose));
            assert!(JKR.approach(held + step) > JKR.approach(held));
        }
    }

    #[test]
    fn the_pressure_of_jkr_carries_the_load_and_its_energy_is_the_work_done() {
        for a in [0.6, 1.0, 1.8] {
            let load = integrate_to_edge(a, |r| 2.0 * PI * r * JKR.pressure(a, r));
            assert_relative_eq!(load, JKR.load(a), max_relative = 1e-9);
        }
        // dU = W dδ with U = elastic energy − πwa².
        let energy = |a: f64| JKR.elastic_energy(a) - PI * JKR.work * a * a;
        let slope = |a: f64| (JKR.approach(a + 1e-5) - JKR.approach(a - 1e-5)) / 2e-5;
        let work = integrate(0.7, 2.0, |a| JKR.load(a) * slope(a));
        assert_relative_eq!(energy(2.0) - energy(0.7), work, max_relative = 1e-8);
    }

    #[test]
    fn without_work_of_adhesion_the_spheres_are_those_of_hertz() {
        let a = 0.3;
        let jkr = JkrSphere { work: 0.0, ..JKR };
        let dmt = DmtSphere { radius: 1.0, modulus: 0.75, work: 0.0 };
        let hertz = HertzSphere { radius: 1.0, modulus: 0.75, load: jkr.load(a) };
        assert_relative_eq!(hertz.contact_radius(), a, max_relative = 1e-14);
        assert_relative_eq!(hertz.elastic_energy(), jkr.elastic_energy(a), max_relative = 1e-14);
        assert_relative_eq!(hertz.pressure(0.1), jkr.pressure(a, 0.1), max_relative = 1e-14);
        assert_eq!((jkr.load(a), jkr.approach(a)), (dmt.load(a), dmt.approach(a)));
    }

    /// Independent numbers: a program in Python with another method of solution.
    #[test]
    fn maugis_pull_off_lies_between_dmt_and_jkr() {
        let expected = [
            (0.05, -1.981_444_33, 0.102_859),
            (0.1, -1.950_594_89, 0.199_193),
            (0.3, -1.815_555_83, 0.496_629),
            (0.5, -1.718_245_27, 0.678_878),
            (1.0, -1.600_734_91, 0.903_769),
            (2.0, -1.534_603_24, 1.051_377),
            (3.0, -1.516_763_90, 1.097_405),
            (5.0, -1.506_349_97, 1.126_244),
        ];
        for (lambda, load, radius) in expected {
            assert_relative_eq!(maugis(lambda).lambda(), lambda, max_relative = 1e-14);
            assert_relative_eq!(maugis(lambda).pull_off(), load, max_relative = 1e-8);
            assert_relative_eq!(maugis(lambda).pull_off_radius(), radius, max_relative = 2e-5);
        }
        let dmt = DmtSphere { radius: 1.0, modulus: 0.75, work: FRAC_1_PI };
        assert_relative_eq!(maugis(1e-3).pull_off(), dmt.pull_off(), max_relative = 1e-3);
        assert_relative_eq!(maugis(100.0).pull_off(), JKR.pull_off(), max_relative = 1e-4);
    }

    #[test]
    fn maugis_becomes_jkr_and_dmt() {
        let dmt = DmtSphere { radius: 1.0, modulus: 0.75, work: FRAC_1_PI };
        for a in [0.9, 1.5] {
            let (short, long) = (maugis(300.0), maugis(1e-3));
            assert_relative_eq!(short.load(a), JKR.load(a), epsilon = 1e-3);
            assert_relative_eq!(short.approach(a), JKR.approach(a), epsilon = 1e-3);
            assert!(short.outer_ratio(a) - 1.0 < 1e-3);
            assert_relative_eq!(long.load(a), dmt.load(a), epsilon = 2e-2);
            assert_relative_eq!(long.approach(a), dmt.approach(a), epsilon = 5e-2);
        }
    }

    #[test]
    fn a_punch_lets_go_at_the_load_of_a_flat_sphere() {
        let punch = KendallPunch { radius: 0.7, modulus: 0.75, work: FRAC_1_PI };
        let sphere = JkrSphere { radius: 1e9, ..JKR };
        assert_relative_eq!(punch.pull_off(), sphere.load(0.7), max_relative = 1e-8);
        assert_relative_eq!(punch.approach(), sphere.approach(0.7), max_relative = 1e-8);
        // A smaller punch under the same load stores more energy, as much as the surfaces cost.
        let elastic = FlatPunch { radius: 0.7, modulus: 0.75, load: punch.pull_off() };
        let rate = |a: f64| FlatPunch { radius: a, ..elastic }.elastic_energy();
        let released = (rate(0.7 - 1e-6) - rate(0.7 + 1e-6)) / 2e-6;
        assert_relative_eq!(released, 2.0 * PI * 0.7 * FRAC_1_PI, max_relative = 1e-8);
    }

    #[test]
    fn a_wave_has_the_turns_of_johnson() {
        let expected = [
            (0.2, [0.044_032, -0.055_610_71], [0.399_315, 0.553_651_75]),
            (0.3, [0.058_577, -0.095_944_03], [0.379_023, 0.387_727_76]),
            (0.5, [0.085_616, -0.191_894_68], [0.344_637, 0.093_899_13]),
            (0.57, [0.095_062, -0.229_692_64], [0.333_317, -0.000_162_18]),
        ];
        for (alpha, [open, pull_off], [close, closing]) in expected {
            let wave = AdhesiveWave::from_alpha(0.01, 2.0, 5.0, alpha);
            let full = wave.full_contact_pressure();
            assert_relative_eq!(wave.alpha(), alpha, max_relative = 1e-14);
            assert_relative_eq!(wave.pull_off_half_width() / 2.0, open, epsilon = 5e-5);
            assert_relative_eq!(wave.pull_off() / full, pull_off, max_relative = 1e-6);
            assert_relative_eq!(wave.closing_half_width() / 2.0, close, epsilon = 5e-5);
            assert_relative_eq!(wave.closing_pressure() / full, closing, epsilon = 1e-6);
        }
        assert!(AdhesiveWave::from_alpha(0.01, 2.0, 5.0, 1.07).pull_off().is_nan());
    }

    #[test]
    fn a_wave_is_westergaards_without_adhesion_and_a_line_of_jkr_for_small_strips() {
        let wave = AdhesiveWave::from_alpha(0.01, 2.0, 5.0, 0.0);
        let mean_pressure = wave.mean_pressure(0.3);
        let elastic = Westergaard { amplitude: 0.01, wavelength: 2.0, modulus: 5.0, mean_pressure };
        assert_relative_eq!(elastic.half_width(), 0.3, max_relative = 1e-13);
        // A cylinder of JKR: W' = πE*b²/4R − √(2πE*wb). Barquins, J. Adhes. 26, 1 (1988).
        let wave = AdhesiveWave::from_alpha(0.01, 2.0, 5.0, 1e-4);
        let radius = 4.0 / (4.0 * PI * PI * 0.01);
        let b = 2e-3;
        let line = PI * 5.0 * b * b / (4.0 * radius) - (2.0 * PI * 5.0 * wave.work * b).sqrt();
        assert_relative_eq!(wave.mean_pressure(b) * 2.0, line, max_relative = 1e-4);
    }
}
