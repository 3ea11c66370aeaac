//! Viscoelastic bodies: a rolling cylinder, also on a foundation, a sphere under a step of load, limits of slow and fast sliding.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::math::integrate;
use crate::units::{Metre, Newton, Pascal, PerPascal, Second};

/// A rigid cylinder that slides or rolls without friction over a standard linear solid, in plane strain.
///
/// The composite creep compliance of the solid is `J(t) = J_g + J₁(1 − e^(−t/ρ))`. It takes the place of the
/// 1/E* of elastic bodies. The contact reaches from the distance b behind the lowest point of the cylinder to
/// the distance a ahead of it. With λ = vρ, λ′ = λJ_g/(J_g + J₁), c = (a + b)/2 and x₀ = (a − b)/2:
///
/// ```text
/// x₀ = (λ − λ′) r/(k + r),   k = K₁(c/λ)/K₀(c/λ),   r = I₁(c/λ′)/I₀(c/λ′)
/// c² + 2k c x₀ = 4RP′(J_g + J₁)/π
/// RF′ = (x₀ − λ′)P′ − (x₀ − λ) πc²/4R(J_g + J₁)
/// ```
///
/// Hunter, J. Appl. Mech. 28, 611 (1961).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViscoelasticCylinder {
    /// Radius R of the cylinder.
    pub radius: Metre,
    /// Load P′ per length, N/m.
    pub load_per_length: f64,
    /// Composite glassy compliance J_g.
    pub glassy: PerPascal,
    /// Compliance J₁ that follows in time.
    pub delayed: PerPascal,
    /// Distance λ = vρ in which it follows.
    pub decay: Metre,
}

impl ViscoelasticCylinder {
    fn relaxed(&self) -> PerPascal {
        self.glassy + self.delayed
    }

    /// The decay λ′ of the relaxation.
    fn relaxation(&self) -> Metre {
        self.decay * self.glassy / self.relaxed()
    }

    /// Returns k and x₀ of a contact of half width c.
    fn shift(&self, c: Metre) -> [f64; 2] {
        let [decay, relaxation] = [self.decay, self.relaxation()];
        let (k, r) = (ratio_k(c / decay), ratio_i(c / relaxation));
        [k, (decay - relaxation) * r / (k + r)]
    }

    /// Half width c of the contact.
    pub fn half_width(&self) -> Metre {
        let wanted = 4.0 * self.radius * self.load_per_length * self.relaxed() / PI;
        let excess = |c: Metre| {
            let [k, shift] = self.shift(c);
            c * c + 2.0 * k * c * shift - wanted
        };
        let (mut least, mut most) = (0.0, wanted.sqrt());
        for _ in 0..200 {
            let c = 0.5 * (least + most);
            if excess(c) < 0.0 { least = c } else { most = c }
        }
        0.5 * (least + most)
    }

    /// Distances a and b by which the contact reaches ahead of the lowest point of the cylinder, and behind
    /// it; b may be below 0.
    pub fn reach(&self) -> [Metre; 2] {
        let c = self.half_width();
        let [_, shift] = self.shift(c);
        [c + shift, c - shift]
    }

    /// Drag per length, N/m.
    pub fn drag_per_length(&self) -> f64 {
        let c = self.half_width();
        let [_, shift] = self.shift(c);
        let alpha = 0.5 / (self.radius * self.relaxed());
        let moment = (shift - self.relaxation()) * self.load_per_length
            - 0.5 * PI * alpha * (shift - self.decay) * c * c;
        moment / self.radius
    }

    /// Pressure at `x` ahead of the lowest point of the cylinder; 0 outside the contact.
    pub fn pressure(&self, x: Metre) -> Pascal {
        let c = self.half_width();
        let [_, shift] = self.shift(c);
        let place = (x - shift) / c;
        if place.abs() >= 1.0 {
            return 0.0;
        }
        let alpha = 0.5 / (self.radius * self.relaxed());
        let constant = self.load_per_length / (PI * alpha) - 0.5 * c * c;
        let (lag, relaxation) = (shift - self.decay, self.relaxation());
        let density = |angle: f64| {
            let (sin, cos) = angle.sin_cos();
            let traction = alpha * (c * c * cos * cos - lag * c * sin + constant);
            traction * (c * (place - sin) / relaxation).exp() / relaxation
        };
        // The exponential falls within some λ′ from x on.
        let from = place.asin();
        let ends = [0.5, 2.0, 8.0, 40.0].map(|n| (place + n * relaxation / c).min(1.0).asin());
        let mut sum = 0.0;
        let mut begin = from;
        for end in ends.into_iter().chain([FRAC_PI_2]) {
            if end > begin {
                sum += integrate(begin, end, density);
                begin = end;
            }
        }
        sum
    }
}

/// A rigid cylinder that slides or rolls without friction over a foundation that relaxes: a thin compressible layer on a rigid
/// body.
///
/// A point of the foundation bears `p = ∫ k(t − t′) ẇ dt′` under its penetration w, `k(t) = k₀ + k₁ e^(−t/τ)`. The contact begins where the
/// surface at rest meets the cylinder, at the distance a ahead of its lowest point, and ends at the distance b behind it, where the
/// pressure falls to 0. With ℓ = vτ
///
/// ```text
/// 2R p(x) = k₀ (a² − x²) + 2k₁ℓ [x + ℓ − (a + ℓ) e^(−(a − x)/ℓ)]
/// ```
///
/// Johnson, Contact Mechanics (1985), section 9.4, after May, Morris and Atack, J. Appl. Phys. 30, 1713 (1959).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CylinderOnFoundation {
    /// Radius R of the cylinder.
    pub radius: Metre,
    /// Distance a that the contact reaches ahead, > 0.
    pub ahead: Metre,
    /// Stiffness k₀ after a long time, Pa/m.
    pub relaxed: f64,
    /// Stiffness k₁ that relaxes, Pa/m.
    pub relaxing: f64,
    /// Distance ℓ = vτ in which it relaxes.
    pub decay: Metre,
}

impl CylinderOnFoundation {
    /// Pressure at `x` ahead of the lowest point, −b … a.
    pub fn pressure(&self, x: Metre) -> Pascal {
        let Self { radius, ahead, relaxed, relaxing, decay } = *self;
        let delayed = x + decay - (ahead + decay) * (-(ahead - x) / decay).exp();
        (relaxed * (ahead * ahead - x * x) + 2.0 * relaxing * decay * delayed) / (2.0 * radius)
    }

    /// Distance b that the contact reaches behind the lowest point, below a.
    pub fn behind(&self) -> Metre {
        let (mut least, mut most) = (0.0, self.ahead);
        for _ in 0..100 {
            let b = 0.5 * (least + most);
            if self.pressure(-b) > 0.0 { least = b } else { most = b }
        }
        0.5 * (least + most)
    }

    /// Load per length, N/m.
    pub fn load_per_length(&self) -> f64 {
        integrate(-self.behind(), self.ahead, |x| self.pressure(x))
    }

    /// Drag per length, N/m.
    pub fn drag_per_length(&self) -> f64 {
        integrate(-self.behind(), self.ahead, |x| self.pressure(x) * x) / self.radius
    }
}

/// Returns I₁(x)/I₀(x), by the continued fraction 1/(2/x + 1/(4/x + …)).
fn ratio_i(x: f64) -> f64 {
    let terms = 40 + x as usize;
    (1..=terms).rev().fold(0.0, |tail, n| 1.0 / (2.0 * n as f64 / x + tail))
}

/// Returns K₁(x)/K₀(x), by the trapezoidal rule on K_n(x) = ∫ e^(−x cosh t) cosh nt dt.
fn ratio_k(x: f64) -> f64 {
    const STEP: f64 = 0.02;
    let last = (2.0 + 1500.0 / x).ln();
    let (mut zeroth, mut first) = (0.5, 0.5);
    for n in 1..=(last / STEP) as usize {
        let t = n as f64 * STEP;
        let weight = (-2.0 * x * (0.5 * t).sinh().powi(2)).exp();
        zeroth += weight;
        first += weight * t.cosh();
    }
    first / zeroth
}

/// A rigid sphere under a load that is applied at once and held, on bodies whose composite compliance has
/// grown to J(t): approach and contact radius.
///
/// δ³ = 9W²J²/16R and a³ = 3WRJ/4. Lee and Radok, J. Appl. Mech. 27, 438 (1960).
pub fn sphere_under_step(radius: Metre, load: Newton, compliance: PerPascal) -> [Metre; 2] {
    let approach = (9.0 * (load * compliance).powi(2) / (16.0 * radius)).cbrt();
    [approach, (0.75 * load * radius * compliance).cbrt()]
}

/// Drag over load of a paraboloid that slides slowly, over its speed: Σ J_kρ_k/(J(∞) R), s/m. `delayed` are
/// pairs of J_k and ρ_k.
pub fn slow_paraboloid(radius: Metre, relaxed: PerPascal, delayed: &[(PerPascal, Second)]) -> f64 {
    delayed.iter().map(|(compliance, time)| compliance * time).sum::<f64>() / (relaxed * radius)
}

/// Drag over load of a sphere that slides fast, times its speed: 0.8 δ_g Σ J_k/(ρ_k J_g), m/s, with δ_g its
/// approach to the glassy body.
pub fn fast_sphere(radius: Metre, load: Newton, glassy: PerPascal, delayed: &[(PerPascal, Second)]) -> f64 {
    let [approach, _] = sphere_under_step(radius, load, glassy);
    0.8 * approach * delayed.iter().map(|(compliance, time)| compliance / time).sum::<f64>() / glassy
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cylinder of R = 1 under P′ = 0.05 on bodies with J(∞) = 1 and ρ = 1.
    fn cylinder(ratio: f64, speed: f64) -> ViscoelasticCylinder {
        ViscoelasticCylinder {
            radius: 1.0,
            load_per_length: 0.05,
            glassy: 1.0 / ratio,
            delayed: 1.0 - 1.0 / ratio,
            decay: speed,
        }
    }

    #[test]
    fn a_cylinder_has_the_drag_and_the_reach_of_an_independent_solution() {
        for (ratio, speed, drag, ahead, behind) in [
            (10.0, 0.1, 0.070854, 0.248200, 0.168202),
            (10.0, 0.3, 0.120978, 0.225339, 0.050868),
            (10.0, 1.0, 0.081190, 0.159354, 0.012870),
            (10.0, 3.0, 0.038052, 0.116219, 0.044961),
            (10.0, 10.0, 0.014885, 0.094042, 0.065706),
            (100.0, 0.3, 0.145851, f64::NAN, f64::NAN),
            (100.0, 1.0, 0.116492, f64::NAN, -0.063033),
        ] {
            let cylinder = cylinder(ratio, speed);
            let [a, b] = cylinder.reach();
            assert!(
                (cylinder.drag_per_length() / 0.05 - drag).abs() < 1e-6,
                "{ratio} {speed}: {}",
                cylinder.drag_per_length() / 0.05
            );
            assert!(ahead.is_nan() || (a - ahead).abs() < 1e-6, "{ratio} {speed}: {a}");
            assert!(behind.is_nan() || (b - behind).abs() < 1e-6, "{ratio} {speed}: {b}");
        }
    }

    #[test]
    fn its_pressure_bears_the_load_and_resists_by_its_moment() {
        for (ratio, speed) in [(10.0, 0.1), (10.0, 1.0), (30.0, 0.4)] {
            let cylinder = cylinder(ratio, speed);
            let [a, b] = cylinder.reach();
            let over = |f: &dyn Fn(f64) -> f64| integrate(-b, a, |x| f(x) * cylinder.pressure(x));
            assert!((over(&|_| 1.0) / 0.05 - 1.0).abs() < 1e-3, "{}", over(&|_| 1.0));
            assert!((over(&|x| x) / cylinder.drag_per_length() - 1.0).abs() < 2e-3);
        }
    }

    #[test]
    fn a_foundation_loses_what_its_damper_dissipates() {
        let foundation =
            CylinderOnFoundation { radius: 2.0, ahead: 0.3, relaxed: 3.0, relaxing: 20.0, decay: 0.2 };
        let b = foundation.behind();
        assert!(foundation.pressure(-b).abs() < 1e-12 && 0.0 < b && b < 0.3);
        // The damper bears s, and yields at the rate s/k₁τ. Behind the contact it relaxes against the spring of k₀, which
        // loses what both still store.
        let (spring, damper) = (
            |x: f64| 3.0 * (0.09 - x * x) / 4.0,
            |x: f64| foundation.pressure(x) - 3.0 * (0.09 - x * x) / 4.0,
        );
        let in_contact = integrate(-b, 0.3, |x| damper(x).powi(2) / (20.0 * 0.2));
        let stored = 0.5 * (spring(-b).powi(2) / 3.0 + damper(-b).powi(2) / 20.0);
        let drag = foundation.drag_per_length();
        assert!(((in_contact + stored) / drag - 1.0).abs() < 1e-9, "{in_contact} {stored} {drag}");
    }

    #[test]
    fn slow_and_fast_it_is_the_cylinder_of_hertz() {
        let half_width = |compliance: f64| (4.0 * 0.05 * compliance / PI).sqrt();
        for (speed, compliance) in [(1e-4, 1.0), (1e4, 0.1)] {
            let [a, b] = cylinder(10.0, speed).reach();
            assert!((a / half_width(compliance) - 1.0).abs() < 1e-3 && (b / a - 1.0).abs() < 2e-3, "{a} {b}");
        }
    }
}
