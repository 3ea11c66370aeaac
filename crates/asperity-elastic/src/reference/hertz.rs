//! Hertz: a sphere on a plane, or two spheres.

use std::f64::consts::PI;

use crate::units::{Joule, Metre, Newton, Pascal};

/// Frictionless contact of two elastic spheres, or of a sphere and a plane, approximated by paraboloids.
///
/// h = r²/2R,  a = (3WR/4E*)^{1/3},  δ = a²/R,  p = p₀ √(1 − r²/a²),  p₀ = 3W/2πa². Exact for the paraboloid;
/// a sphere differs by O(a²/R²). Hertz (1882); Johnson (1985), eqs. 4.22–4.24.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HertzSphere {
    /// Relative radius R: 1/R = 1/R₁ + 1/R₂.
    pub radius: Metre,
    /// Composite modulus E*.
    pub modulus: Pascal,
    /// Normal load W ≥ 0.
    pub load: Newton,
}

impl HertzSphere {
    /// Creates the contact at approach δ ≥ 0: W = (4/3) E* R^{1/2} δ^{3/2}.
    pub fn from_approach(radius: Metre, modulus: Pascal, approach: Metre) -> Self {
        Self { radius, modulus, load: 4.0 / 3.0 * modulus * (radius * approach).sqrt() * approach }
    }

    /// Contact radius a.
    pub fn contact_radius(&self) -> Metre {
        (0.75 * self.load * self.radius / self.modulus).cbrt()
    }

    /// Rigid-body approach δ.
    pub fn approach(&self) -> Metre {
        self.contact_radius().powi(2) / self.radius
    }

    /// Pressure p₀ at the centre, 2aE*/πR; 0 without load.
    pub fn peak_pressure(&self) -> Pascal {
        2.0 * self.contact_radius() * self.modulus / (PI * self.radius)
    }

    /// Pressure at distance `r` from the axis; 0 outside the contact.
    pub fn pressure(&self, r: Metre) -> Pascal {
        let a = self.contact_radius();
        if r.abs() < a { self.peak_pressure() * ((1.0 - r / a) * (1.0 + r / a)).sqrt() } else { 0.0 }
    }

    /// Surface displacement u at distance `r` from the axis.
    ///
    /// u = δ − r²/2R for r ≤ a,  u = [(2a² − r²) asin(a/r) + a √(r² − a²)]/πR for r > a. Far outside, where
    /// u → W/πE*r, about 2 log₁₀(r/a) digits are lost. Johnson (1985), eq. 3.42.
    pub fn displacement(&self, r: Metre) -> Metre {
        let (a, r) = (self.contact_radius(), r.abs());
        if r <= a {
            return (a * a - 0.5 * r * r) / self.radius;
        }
        let root = ((r - a) * (r + a)).sqrt();
        ((2.0 * a * a - r * r) * a.atan2(root) + a * root) / (PI * self.radius)
    }

    /// Elastic energy stored in both bodies, ⅖ W δ.
    pub fn elastic_energy(&self) -> Joule {
        0.4 * self.load * self.approach()
    }

    /// Stresses σ_r = σ_θ and σ_z, positive in tension, on the axis at `depth` ≥ 0 in a body with Poisson's
    /// ratio `poisson`.
    ///
    /// σ_z = −p₀/(1 + ζ²),  σ_r = −p₀ (1 + ν)(1 − ζ atan 1/ζ) + ½p₀/(1 + ζ²),  ζ = z/a. Johnson (1985), eq.
    /// 3.45.
    pub fn axis_stress(&self, depth: Metre, poisson: f64) -> [Pascal; 2] {
        let zeta = depth / self.contact_radius();
        let decay = 1.0 / (1.0 + zeta * zeta);
        let radial = -(1.0 + poisson) * (1.0 - zeta * (1.0 / zeta).atan()) + 0.5 * decay;
        [self.peak_pressure() * radial, -self.peak_pressure() * decay]
    }
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::{axisymmetric_displacement, axisymmetric_load, integrate};
    use super::*;
    use approx::assert_relative_eq;

    const SPHERE: HertzSphere = HertzSphere { radius: 4.0, modulus: 5.0, load: 7.0 };

    #[test]
    fn a_sphere_of_4_under_7_is_the_textbooks() {
        assert_relative_eq!(SPHERE.approach(), 0.650_787_998_953_148_1, max_relative = 1e-15);
        assert_relative_eq!(SPHERE.contact_radius(), 1.613_428_646_024_543_7, max_relative = 1e-15);
        assert_relative_eq!(SPHERE.peak_pressure(), 1.283_925_721_704_350_3, max_relative = 1e-15);
        assert_relative_eq!(
            HertzSphere::from_approach(4.0, 5.0, SPHERE.approach()).load,
            7.0,
            max_relative = 1e-14
        );
    }

    #[test]
    fn the_pressure_carries_the_load() {
        let load = axisymmetric_load(SPHERE.contact_radius(), |r| SPHERE.pressure(r));
        assert_relative_eq!(load, SPHERE.load, max_relative = 1e-12);
    }

    #[test]
    fn the_displacement_is_the_pressures() {
        let a = SPHERE.contact_radius();
        for r in [1.2 * a, 2.0 * a, 5.0 * a] {
            let u = axisymmetric_displacement(a, SPHERE.modulus, r, |s| SPHERE.pressure(s));
            assert_relative_eq!(SPHERE.displacement(r), u, max_relative = 1e-10);
        }
    }

    #[test]
    fn the_displacement_and_its_slope_are_continuous_at_the_edge() {
        let (a, step) = (SPHERE.contact_radius(), 1e-6);
        let (inside, outside) = (SPHERE.displacement(a - step), SPHERE.displacement(a + step));
        assert_relative_eq!(inside - outside, 2.0 * step * a / SPHERE.radius, max_relative = 1e-2);
    }

    #[test]
    fn the_energy_is_the_work_of_the_load() {
        let load = |approach| HertzSphere::from_approach(SPHERE.radius, SPHERE.modulus, approach).load;
        let work = integrate(0.0, SPHERE.approach(), load);
        assert_relative_eq!(work, SPHERE.elastic_energy(), max_relative = 1e-7);
    }

    #[test]
    fn the_largest_shear_lies_at_half_a_radius() {
        // Johnson (1985), section 3.4: 0.310 p₀ at 0.48 a for ν = 0.3.
        let (a, p0) = (SPHERE.contact_radius(), SPHERE.peak_pressure());
        let shear = |depth: f64| {
            let [radial, axial] = SPHERE.axis_stress(depth, 0.3);
            0.5 * (radial - axial)
        };
        let (depth, largest) = (1..2000)
            .map(|i| (1e-3 * f64::from(i), shear(1e-3 * f64::from(i) * a) / p0))
            .max_by(|x, y| x.1.total_cmp(&y.1))
            .unwrap();
        assert_relative_eq!(depth, 0.481, epsilon = 1e-3);
        assert_relative_eq!(largest, 0.3100, epsilon = 5e-5);
        assert_eq!(SPHERE.axis_stress(0.0, 0.3)[1], -p0);
    }

    #[test]
    fn no_load_is_no_contact() {
        let idle = HertzSphere { load: 0.0, ..SPHERE };
        assert_eq!((idle.approach(), idle.peak_pressure(), idle.pressure(0.0)), (0.0, 0.0, 0.0));
        assert_eq!(idle.displacement(1.0), 0.0);
    }
}
