//! Stress at a point, and the measures of yield and fracture.

use crate::units::Pascal;

/// A component of the stress tensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Component {
    /// Normal stress along x.
    Xx,
    /// Normal stress along y.
    Yy,
    /// Normal stress along z.
    Zz,
    /// Shear stress in the y–z plane.
    Yz,
    /// Shear stress in the x–z plane.
    Xz,
    /// Shear stress in the x–y plane.
    Xy,
}

impl Component {
    /// All six components, in storage order.
    pub const ALL: [Self; 6] = [Self::Xx, Self::Yy, Self::Zz, Self::Yz, Self::Xz, Self::Xy];

    /// `xx`, `yy`, …
    pub fn name(self) -> &'static str {
        ["xx", "yy", "zz", "yz", "xz", "xy"][self as usize]
    }
}

/// A symmetric stress tensor, positive in tension.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stress {
    /// σ_xx.
    pub xx: Pascal,
    /// σ_yy.
    pub yy: Pascal,
    /// σ_zz.
    pub zz: Pascal,
    /// σ_yz.
    pub yz: Pascal,
    /// σ_xz.
    pub xz: Pascal,
    /// σ_xy.
    pub xy: Pascal,
}

impl Stress {
    /// Creates a stress from its components, in the order of [`Component::ALL`].
    pub fn from_components([xx, yy, zz, yz, xz, xy]: [Pascal; 6]) -> Self {
        Self { xx, yy, zz, yz, xz, xy }
    }

    /// The components, in the order of [`Component::ALL`].
    pub fn components(&self) -> [Pascal; 6] {
        [self.xx, self.yy, self.zz, self.yz, self.xz, self.xy]
    }

    /// Von Mises' equivalent stress, √(½[(σxx − σyy)² + (σyy − σzz)² + (σzz − σxx)²] + 3(σyz² + σxz² +
    /// σxy²)). Yield begins when it reaches the yield stress in tension.
    pub fn von_mises(&self) -> Pascal {
        let square = |v: f64| v * v;
        let normal = square(self.xx - self.yy) + square(self.yy - self.zz) + square(self.zz - self.xx);
        (0.5 * normal + 3.0 * (square(self.yz) + square(self.xz) + square(self.xy))).sqrt()
    }

    /// Returns the deviator in an orthonormal basis of five, (σxx − σyy)/√2, √(3/2) s_zz, √2 σxy, √2 σyz, √2
    /// σxz, and the hydrostatic stress, a third of the trace.
    #[inline]
    pub fn split(&self) -> ([Pascal; 5], Pascal) {
        const ROOT: f64 = std::f64::consts::SQRT_2;
        let Self { xx, yy, zz, yz, xz, xy } = *self;
        let mean = (xx + yy + zz) / 3.0;
        ([(xx - yy) / ROOT, 1.5f64.sqrt() * (zz - mean), ROOT * xy, ROOT * yz, ROOT * xz], mean)
    }

    /// Principal stresses σ₁ ≥ σ₂ ≥ σ₃ by Jacobi rotations, to round-off of the largest.
    pub fn principal(&self) -> [Pascal; 3] {
        /// Sweeps over the three pairs of axes: the rotations converge quadratically.
        const SWEEPS: usize = 6;
        let mut s = [[self.xx, self.xy, self.xz], [self.xy, self.yy, self.yz], [self.xz, self.yz, self.zz]];
        for (i, j, k) in (0..SWEEPS).flat_map(|_| [(0, 1, 2), (0, 2, 1), (1, 2, 0)]) {
            let shear = s[i][j];
            if shear == 0.0 {
                continue;
            }
            let theta = (s[j][j] - s[i][i]) / (2.0 * shear);
            let tangent = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
            let sine = tangent * cosine;
            s[i][i] -= tangent * shear;
            s[j][j] += tangent * shear;
            (s[i][j], s[j][i]) = (0.0, 0.0);
            let (a, b) = (cosine * s[i][k] - sine * s[j][k], sine * s[i][k] + cosine * s[j][k]);
            (s[i][k], s[k][i], s[j][k], s[k][j]) = (a, a, b, b);
        }
        let mut principal = [s[0][0], s[1][1], s[2][2]];
        principal.sort_by(|a, b| b.total_cmp(a));
        principal
    }

    /// Largest shear stress on any plane, ½(σ₁ − σ₃), used in Tresca's criterion. It lies between ½ and 1/√3
    /// of von Mises' stress.
    pub fn max_shear(&self) -> Pascal {
        let [most, _, least] = self.principal();
        0.5 * (most - least)
    }
}

impl std::ops::Add for Stress {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (a, b) = (self.components(), other.components());
        Self::from_components(std::array::from_fn(|i| a[i] + b[i]))
    }
}

impl std::ops::Mul<Stress> for f64 {
    type Output = Stress;

    fn mul(self, stress: Stress) -> Stress {
        Stress::from_components(stress.components().map(|s| self * s))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const STRESS: Stress = Stress { xx: -3.0, yy: 1.0, zz: 0.5, yz: 0.7, xz: -1.1, xy: 2.0 };

    #[test]
    fn a_pull_a_shear_and_a_pressure_are_the_textbooks() {
        let pull = Stress { xx: 2.0, ..Stress::default() };
        assert_eq!((pull.von_mises(), pull.max_shear(), pull.principal()), (2.0, 1.0, [2.0, 0.0, 0.0]));
        let shear = Stress { yz: -2.0, ..Stress::default() };
        assert_relative_eq!(shear.von_mises(), 2.0 * 3f64.sqrt(), max_relative = 1e-15);
        assert_eq!(shear.principal(), [2.0, 0.0, -2.0]);
        let pressure = Stress { xx: -7.0, yy: -7.0, zz: -7.0, ..Stress::default() };
        assert_eq!((pressure.von_mises(), pressure.max_shear()), (0.0, 0.0));
    }

    #[test]
    fn principal_stresses_have_the_invariants_of_the_tensor() {
        arbtest::arbtest(|u| {
            let mut component =
                || Ok(f64::from(u.int_in_range(-9i32..=9)?) * 10f64.powi(u.int_in_range(-9..=1)?));
            let mut components = [0.0; 6];
            for value in &mut components {
                *value = component()?;
            }
            let s = Stress::from_components(components);
            let [a, b, c] = s.principal();
            let scale = components.iter().fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()));
            let minors = s.xx * s.yy + s.yy * s.zz + s.zz * s.xx - s.yz * s.yz - s.xz * s.xz - s.xy * s.xy;
            let determinant = s.xx * (s.yy * s.zz - s.yz * s.yz) - s.xy * (s.xy * s.zz - s.yz * s.xz)
                + s.xz * (s.xy * s.yz - s.yy * s.xz);
            assert!(a >= b && b >= c);
            assert!((a + b + c - s.xx - s.yy - s.zz).abs() < 1e-14 * scale);
            assert!((a * b + b * c + c * a - minors).abs() < 1e-13 * scale.powi(2));
            assert!((a * b * c - determinant).abs() < 1e-13 * scale.powi(3));
            // Von Mises' stress is invariant under rotation to the principal axes.
            let turned = Stress { xx: a, yy: b, zz: c, ..Stress::default() };
            assert!((turned.von_mises() - s.von_mises()).abs() < 1e-13 * scale);
            Ok(())
        });
    }

    #[test]
    fn tresca_lies_between_half_and_a_root_third_of_von_mises() {
        let ratio = STRESS.max_shear() / STRESS.von_mises();
        assert!(ratio > 0.5 && ratio < 1.0 / 3f64.sqrt(), "{ratio}");
        // The two limits: equal and opposite tensions, and uniaxial tension.
        let shear = Stress { xx: 1.0, yy: -1.0, ..Stress::default() };
        assert_relative_eq!(shear.max_shear() * 3f64.sqrt(), shear.von_mises(), max_relative = 1e-15);
    }

    #[test]
    fn components_keep_their_order() {
        assert_eq!(Stress::from_components(STRESS.components()), STRESS);
        for (component, value) in Component::ALL.iter().zip([-3.0, 1.0, 0.5, 0.7, -1.1, 2.0]) {
            assert_eq!(STRESS.components()[*component as usize], value);
        }
        assert_eq!(Component::ALL.map(Component::name), ["xx", "yy", "zz", "yz", "xz", "xy"]);
        let sum = STRESS + 2.0 * STRESS;
        assert_eq!((sum.xx, sum.xy), (-9.0, 6.0));
    }
}
