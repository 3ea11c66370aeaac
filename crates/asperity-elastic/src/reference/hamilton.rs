//! Hamilton and Goodman: stress under a sliding sphere.

use asperity_transforms::num_complex::Complex64;

use crate::reference::HertzSphere;
use crate::stress::Stress;
use crate::units::Metre;

/// A Hertzian contact in full slip: pressure p and shear traction q = μp, with z pointing into the body.
///
/// The pressure is that of point loads on an imaginary line, because the transform of a² − s² over −a … a is
/// 4 (sin ka − ka cos ka)/k³. A harmonic function f of the point load therefore becomes
///
/// ```text
/// (πp₀/2a) ∫ (a² − s²) f(x, y, z + is) ds = (2πp₀/a) [Im g(x, y, z + ia) − a Re g_z(x, y, z + ia)],   g_zzz = f
/// ```
///
/// and the potentials of a point load, 1/R, ln(R + z) and z ln(R + z) − R, have elementary g. These are the
/// explicit equations of Hamilton, Proc. Inst. Mech. Eng. 197C, 53 (1983), in complex form. They are exact
/// for identical materials, or if the shear does not change the pressure. At large distances, where the two
/// terms cancel, about 3 log₁₀(r/a) digits are lost. Hamilton & Goodman, J. Appl. Mech. 33, 371 (1966);
/// Johnson (1985), section 7.1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlidingSphere {
    /// The normal contact.
    pub normal: HertzSphere,
    /// q/p, positive if the traction acts along +x.
    pub friction: f64,
    /// Poisson's ratio of the body.
    pub poisson: f64,
}

impl SlidingSphere {
    /// Stress at `(x, y)` relative to the axis and at `depth` ≥ 0.
    pub fn stress(&self, [x, y]: [Metre; 2], depth: Metre) -> Stress {
        let a = self.normal.contact_radius();
        let [x, y, z] = [x, y, depth].map(|length| length / a);
        let potentials = Potentials::at(x * x + y * y, z);
        let unit = potentials.under_pressure(x, y, z, self.poisson)
            + self.friction * potentials.under_shear(x, y, z, self.poisson);
        self.normal.peak_pressure() * unit
    }
}

/// Derivatives of the potentials V, ψ and F of the pressure √(1 − r²) on r < 1, over 2π, by D = (1/r) d/dr:
/// V_x = x DV, V_xx = DV + x² D²V, and so on. Those with a pole at the edge only occur multiplied by z.
struct Potentials {
    v_z: f64,
    d_v: f64,
    d_v_z: f64,
    d2_v: f64,
    d_psi: f64,
    d2_psi: f64,
    d3_psi: f64,
    d2_f: f64,
    d3_f: f64,
}

impl Potentials {
    fn at(r2: f64, z: f64) -> Self {
        let zeta = Complex64::new(z, 1.0);
        let r = (zeta * zeta + r2).sqrt();
        let w = r + zeta;
        let of = |g: Complex64, g_z: Complex64| g.im - g_z.re;
        let v_z = of(zeta * w.ln() - r, w.ln());
        // D and D² of the single, double and triple integrals of ln(R + z) over z.
        let d2_log = [
            -0.5 / (w * w),
            0.25 * (1.0 / w + r2 / (3.0 * w.powi(3))),
            0.125 * (w.ln() - 2.0 * r2 / (3.0 * w * w) - r2 * r2 / (12.0 * w.powi(4))),
        ];
        let d3_log = [-1.0 / (3.0 * w.powi(3)), 1.0 / (12.0 * w * w) + r2 / (24.0 * w.powi(4))];
        let d2_psi = of(d2_log[1], d2_log[0]);
        Self {
            v_z,
            d_v: of(r2 / (4.0 * w * w) - 0.5 * w.ln(), -1.0 / w),
            d_v_z: of(-1.0 / w, 1.0 / (r * w)),
            d2_v: of(d2_log[0], 1.0 / (r * w * w)),
            // ψ_xx + ψ_yy = −V_z.
            d_psi: -0.5 * (v_z + r2 * d2_psi),
            d2_psi,
            d3_psi: of(d3_log[0], 1.0 / (r * w.powi(3))),
            d2_f: of(d2_log[2], d2_log[1]),
            d3_f: of(d3_log[1], d3_log[0]),
        }
    }

    fn under_pressure(&self, x: f64, y: f64, z: f64, nu: f64) -> Stress {
        let times_z = |value: f64| if z == 0.0 { 0.0 } else { z * value };
        let [v_xx, v_yy] = [x, y].map(|x| times_z(self.d_v + x * x * self.d2_v));
        let in_plane = |x: f64, zv_xx: f64| {
            2.0 * nu * self.v_z - zv_xx - (1.0 - 2.0 * nu) * (self.d_psi + x * x * self.d2_psi)
        };
        Stress {
            xx: in_plane(x, v_xx),
            yy: in_plane(y, v_yy),
            zz: self.v_z + v_xx + v_yy,
            yz: -times_z(y * self.d_v_z),
            xz: -times_z(x * self.d_v_z),
            xy: -(1.0 - 2.0 * nu) * x * y * self.d2_psi - times_z(x * y * self.d2_v),
        }
    }

    fn under_shear(&self, x: f64, y: f64, z: f64, nu: f64) -> Stress {
        let times_z = |value: f64| if z == 0.0 { 0.0 } else { z * value };
        let (v_x, v_y) = (x * self.d_v, y * self.d_v);
        let f_xxx = 3.0 * x * self.d2_f + x.powi(3) * self.d3_f;
        let f_xyy = x * (self.d2_f + y * y * self.d3_f);
        let f_xxy = y * (self.d2_f + x * x * self.d3_f);
        Stress {
            xx: 2.0 * (1.0 + nu) * v_x + 2.0 * nu * f_xxx
                - times_z(3.0 * x * self.d2_psi + x.powi(3) * self.d3_psi),
            yy: 2.0 * nu * (v_x + f_xyy) - times_z(x * (self.d2_psi + y * y * self.d3_psi)),
            zz: -times_z(x * self.d_v_z),
            yz: -times_z(x * y * self.d2_v),
            xz: self.v_z - times_z(self.d_v + x * x * self.d2_v),
            xy: v_y + 2.0 * nu * f_xxy - times_z(y * (self.d2_psi + x * x * self.d3_psi)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use std::f64::consts::PI;

    /// a = p₀ = 1.
    fn sliding(friction: f64) -> SlidingSphere {
        let normal = HertzSphere { radius: 1.0, modulus: PI / 2.0, load: 2.0 * PI / 3.0 };
        SlidingSphere { normal, friction, poisson: 0.3 }
    }

    /// Quadrature of Boussinesq's and Cerruti's stresses of point loads by an independent program.
    #[test]
    fn it_is_the_sum_of_its_point_loads() {
        #[rustfmt::skip]
        let found = [
            ([0.3, -0.2, 0.4], [-0.2266463982424, -0.2246830613852, -0.7847226072798,
                0.05979903611957, -0.08969855417935, 0.002356004228584],
                [-0.1939982281007, -0.03232800153681, -0.08969855417935,
                0.006835392572463, -0.323593738276, 0.05421387884283]),
            ([1.2, 0.5, 0.25], [-0.08672099862418, -0.06352272966756, -0.02295479679121,
                -0.02079472336828, -0.04990733608387, -0.01169660619662],
                [-0.4161405078556, -0.05614211038234, -0.04990733608387,
                -0.04521099695857, -0.1332790662644, -0.1194133685527]),
            ([-0.7, 0.6, 1.5], [-0.01895496710114, -0.01388941893387, -0.1884726198163,
                -0.05596380404474, 0.06529110471886, 0.01636561715581],
                [0.02043618366298, 0.0007751904198448, 0.06529110471886,
                0.01938710563853, -0.03644696347943, -0.01367774142536]),
            ([0.0, 0.0, 0.5], [-0.1803533334338, -0.1803533334338, -0.8, 0.0, 0.0, 0.0],
                [0.0, 0.0, 0.0, 0.0, -0.2696384616544, 0.0]),
        ];
        for ([x, y, z], pressure, shear) in found {
            let still = sliding(0.0).stress([x, y], z).components();
            let slid = sliding(1.0).stress([x, y], z).components();
            for i in 0..6 {
                assert_relative_eq!(still[i], pressure[i], epsilon = 2e-12);
                assert_relative_eq!(slid[i] - still[i], shear[i], epsilon = 2e-12);
            }
        }
    }

    #[test]
    fn without_friction_the_axis_is_hertzs() {
        let contact = sliding(0.0);
        for depth in [0.0, 1e-3, 0.5, 1.0, 5.0] {
            let [radial, axial] = contact.normal.axis_stress(depth, 0.3);
            let found = contact.stress([0.0; 2], depth);
            assert_relative_eq!(found.xx, radial, epsilon = 1e-14);
            assert_relative_eq!(found.yy, radial, epsilon = 1e-14);
            assert_relative_eq!(found.zz, axial, epsilon = 1e-14);
        }
    }

    #[test]
    fn yield_begins_at_half_a_radius() {
        // Johnson (1985), section 3.4: 0.62 p₀ and 0.31 p₀ at 0.48 a.
        let contact = sliding(0.0);
        let at = |depth: f64| contact.stress([0.0; 2], depth);
        let (depth, most) = (1..1000)
            .map(|i| (1e-3 * f64::from(i), at(1e-3 * f64::from(i)).von_mises()))
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap();
        assert_relative_eq!(depth, 0.481, epsilon = 1e-3);
        assert_relative_eq!(most, 0.6200, epsilon = 5e-5);
        assert_relative_eq!(at(depth).max_shear(), 0.3100, epsilon = 5e-5);
    }

    #[test]
    fn the_surface_is_drawn_behind_the_contact() {
        // Johnson (1985), sections 3.4 and 7.1: σxx = −πq₀(4 + ν)x/8a by the shear, (1 − 2ν)p₀/3 at the rim
        // by the pressure.
        let (friction, nu) = (0.25, 0.3);
        let (still, slid) = (sliding(0.0), sliding(friction));
        for x in [-0.99, -0.3, 0.0, 0.4, 0.9] {
            let drawn = slid.stress([x, 0.0], 0.0).xx - still.stress([x, 0.0], 0.0).xx;
            assert_relative_eq!(drawn, -friction * PI * (4.0 + nu) * x / 8.0, epsilon = 1e-14);
        }
        let rim = slid.stress([-1.0, 0.0], 0.0);
        let expected = (1.0 - 2.0 * nu) / 3.0 + PI * (4.0 + nu) / 8.0 * friction;
        assert_relative_eq!(rim.xx, expected, max_relative = 1e-14);
        assert_relative_eq!(slid.stress([-1.0, 0.0], 1e-9).xx, expected, max_relative = 1e-3);
    }

    #[test]
    fn at_the_surface_the_tractions_are_those_applied() {
        let contact = sliding(0.4);
        for (x, y) in [(0.0, 0.0), (0.3, -0.6), (0.9, 0.4), (1.1, 0.0), (-2.0, 3.0)] {
            let stress = contact.stress([x, y], 0.0);
            let pressure = contact.normal.pressure(x.hypot(y));
            assert_relative_eq!(stress.zz, -pressure, epsilon = 1e-15);
            assert_relative_eq!(stress.xz, -0.4 * pressure, epsilon = 1e-15);
            assert_eq!(stress.yz, 0.0);
        }
    }
}
