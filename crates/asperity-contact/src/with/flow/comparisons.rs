//! Formulas for the flow through a rough gap that need no solution: for comparison, not for use in its place.

use crate::grid::Field;
use crate::units::{CubicMetre, Metre};

/// Permeability of an isotropic effective medium with the gaps of these cells, m³; closed cells count with k
/// = 0.
///
/// Σ (k − K)/(k + K) = 0 with k = g³ over all cells. It is 0 if half of the cells or more are closed. On the
/// mean over rough contacts it is too large, by a factor of 1.1 at 1 % contact that grows to 2 at 29 %, since
/// narrow places of a contact are not distributed at random. Bruggeman, Ann. Phys. 416, 636 (1935).
pub fn effective_medium(gap: &Field) -> CubicMetre {
    let largest = gap.iter().fold(0.0_f64, |most, gap| most.max(*gap));
    let open: Vec<f64> = gap.iter().filter(|gap| **gap > 0.0).map(|gap| (gap / largest).powi(3)).collect();
    let closed = (gap.len() - open.len()) as f64;
    if open.len() <= gap.len() - open.len() {
        return 0.0;
    }
    // In u = ln K the sum falls from a positive to a negative value; Newton's steps, within bounds that close
    // in.
    let least = open.iter().copied().fold(1.0, f64::min).max(f64::MIN_POSITIVE).ln();
    let (mut below, mut above) = (least - (gap.len() as f64).ln() - 1.0, 0.0);
    let mut u = 0.5 * f64::max(below, -20.0);
    for _ in 0..200 {
        let k = f64::exp(u);
        let (mut sum, mut slope) = (-closed, 0.0);
        for other in &open {
            let ratio = (other - k) / (other + k);
            sum += ratio;
            slope -= 0.5 * (1.0 - ratio * ratio);
        }
        if sum > 0.0 {
            below = u
        } else {
            above = u
        }
        let step = u - sum / slope;
        let next = if step > below && step < above { step } else { 0.5 * (below + above) };
        if (next - u).abs() < 1e-15 * (1.0 + u.abs()) {
            break;
        }
        u = next;
    }
    u.exp() * largest.powi(3)
}

/// Flow factor of rigid isotropic Gaussian roughness at the ratio of the mean gap of uncut heights to their
/// rms height.
///
/// φ = 1 − 0.9 exp(−0.56 H), for H > 0.5. Patir and Cheng, J. Lubr. Technol. 100, 12 (1978).
pub fn patir_cheng(ratio: f64) -> f64 {
    1.0 - 0.9 * (-0.56 * ratio).exp()
}

/// Shear flow factor Φ_s of rigid isotropic Gaussian roughness that slides over a smooth surface, at the ratio H of the
/// mean gap of uncut heights to their rms height.
///
/// 1.899 H^0.98 exp(−0.92 H + 0.05 H²) up to H = 5, and 1.126 exp(−0.25 H) beyond. Patir and Cheng, J. Lubr. Technol. 101,
/// 220 (1979).
pub fn patir_cheng_shear(ratio: f64) -> f64 {
    if ratio <= 5.0 {
        1.899 * ratio.powf(0.98) * (-0.92 * ratio + 0.05 * ratio * ratio).exp()
    } else {
        1.126 * (-0.25 * ratio).exp()
    }
}

/// Permeability of a square whose pressure falls at a single constriction as wide as it is long, m³: K = u³
/// with its gap u.
///
/// Persson and Yang, J. Phys.: Condens. Matter 20, 315011 (2008). Near closing it is within about a factor of
/// 2 of the solution.
pub fn single_constriction(critical_gap: Metre) -> CubicMetre {
    critical_gap.powi(3)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_checkerboard_has_the_geometric_mean() {
        let board = Field::from_shape_fn([6, 6], |(i, j)| if (i + j) % 2 == 0 { 1e-6 } else { 4e-6 });
        assert_relative_eq!(effective_medium(&board), (1e-18_f64 * 64e-18).sqrt(), max_relative = 1e-12);
    }

    #[test]
    fn an_even_gap_with_contact_has_one_minus_twice_its_share() {
        // Σ over open cells (1 − K)/(1 + K) = closed cells: K = 1 − 2f.
        let gap = Field::from_shape_fn([10, 10], |(i, j)| if 10 * i + j < 30 { -1.0 } else { 2.0 });
        assert_relative_eq!(effective_medium(&gap), 0.4 * 8.0, max_relative = 1e-12);
        assert_eq!(effective_medium(&gap.mapv(|gap| 0.0 * gap)), 0.0);
        let half = Field::from_shape_fn([10, 10], |(i, _)| (i % 2) as f64);
        assert_eq!(effective_medium(&half), 0.0);
    }

    #[test]
    fn extreme_contrasts_end_in_a_number() {
        for least in [1e-30, 1e-90, 1e-107] {
            let gap = Field::from_shape_fn([8, 8], |(i, j)| if (i + j) % 2 == 0 { 1.0 } else { least });
            assert_relative_eq!(effective_medium(&gap), f64::powf(least, 1.5), max_relative = 1e-9);
        }
    }

    #[test]
    fn flow_factors_of_patir_and_cheng_at_two_ratios() {
        assert_relative_eq!(patir_cheng(1.0), 0.486, max_relative = 1e-3);
        assert_relative_eq!(patir_cheng(6.0), 0.969, max_relative = 1e-3);
        assert_relative_eq!(patir_cheng_shear(2.0), 0.7267, max_relative = 1e-3);
        // Both of their fits meet at H = 5.
        assert_relative_eq!(patir_cheng_shear(5.0), patir_cheng_shear(5.001), max_relative = 0.03);
        assert_relative_eq!(single_constriction(2e-6), 8e-18, max_relative = 1e-15);
    }
}
