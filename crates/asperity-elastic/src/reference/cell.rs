//! A uniformly loaded rectangle: the element of the boundary element method.

use std::f64::consts::PI;

use crate::units::{Metre, Pascal};

/// Displacement at a corner of a rectangle with sides `pitch` under uniform `pressure`.
///
/// πE* u = p [Δx asinh(Δy/Δx) + Δy asinh(Δx/Δy)]; 4a ln(1 + √2) p/πE* for a square of side 2a.
/// Love, Phil. Trans. R. Soc. A 228, 377 (1929); Johnson (1985), eq. 3.25.
pub fn corner_displacement(pressure: Pascal, pitch: [Metre; 2], modulus: Pascal) -> Metre {
    let [dx, dy] = pitch;
    pressure / (PI * modulus) * (dx * (dy / dx).asinh() + dy * (dx / dy).asinh())
}

/// Displacement at the centre of that rectangle: twice that at the corner, as four quarters of half the size.
pub fn centre_displacement(pressure: Pascal, pitch: [Metre; 2], modulus: Pascal) -> Metre {
    2.0 * corner_displacement(pressure, pitch, modulus)
}

/// Mean displacement over that rectangle; 0.9464 p L/E* for a square of side L.
///
/// ∬∬ 1/r = 2 Δx Δy [Δx asinh(Δy/Δx) + Δy asinh(Δx/Δy)] − ⅔ [(Δx² + Δy²)^{3/2} − Δx³ − Δy³], over πE* Δx Δy.
/// Johnson (1985), section 3.3, gives 0.946 p (1 − ν²) 2a/E for the square.
pub fn mean_displacement(pressure: Pascal, pitch: [Metre; 2], modulus: Pascal) -> Metre {
    let [dx, dy] = pitch;
    let diagonal = dx.hypot(dy).powi(3) - dx.powi(3) - dy.powi(3);
    2.0 * corner_displacement(pressure, pitch, modulus)
        - 2.0 / 3.0 * pressure * diagonal / (PI * modulus * dx * dy)
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::integrate;
    use super::*;
    use approx::assert_relative_eq;
    use std::f64::consts::SQRT_2;

    #[test]
    fn a_square_sinks_half_as_much_at_its_corner() {
        let (half, pressure, modulus) = (0.5, 3.0, 7.0);
        let pitch = [2.0 * half; 2];
        let centre = 8.0 * half * (1.0 + SQRT_2).ln() * pressure / (PI * modulus);
        assert_relative_eq!(centre_displacement(pressure, pitch, modulus), centre, max_relative = 1e-15);
        assert_relative_eq!(
            corner_displacement(pressure, pitch, modulus),
            0.5 * centre,
            max_relative = 1e-15
        );
    }

    #[test]
    fn a_square_of_side_1_has_the_self_influence_1_1222() {
        assert_relative_eq!(centre_displacement(1.0, [1.0, 1.0], 1.0), 1.1222, epsilon = 5e-5);
        assert_relative_eq!(mean_displacement(1.0, [1.0, 1.0], 1.0), 0.946, epsilon = 5e-4);
    }

    #[test]
    fn the_mean_is_that_of_all_points() {
        // A point divides the rectangle into four that have it as a corner.
        let [dx, dy] = [1.3, 0.4];
        let at = |x: f64, y: f64| -> f64 {
            [x, dx - x].iter().flat_map(|&u| [y, dy - y].map(|v| corner_displacement(2.0, [u, v], 5.0))).sum()
        };
        let mean = integrate(0.0, dx, |x| integrate(0.0, dy, |y| at(x, y))) / (dx * dy);
        assert_relative_eq!(mean_displacement(2.0, [dx, dy], 5.0), mean, max_relative = 1e-6);
    }

    #[test]
    fn the_longer_side_may_lie_along_either_axis() {
        assert_relative_eq!(
            corner_displacement(1.0, [3.0, 0.2], 1.0),
            corner_displacement(1.0, [0.2, 3.0], 1.0),
            max_relative = 1e-15
        );
    }
}
