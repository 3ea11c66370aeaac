//! Barber's relation between conductance and stiffness, as a bracket in a load sweep.

use crate::units::{Metre, Newton, Pascal};

/// A conductance lies between two slopes of load over approach: Barber's relation
///
/// ```text
/// G = K κ_s/E*,   K = dW/dδ        (W_i − W_{i−1})/(δ_i − δ_{i−1}) ≤ K_i ≤ (W_{i+1} − W_i)/(δ_{i+1} − δ_i)
/// ```
///
/// in elastic contact of half-spaces without film and gas. W(δ) is convex, as each more load brings more
/// cells into contact, so that each secant is a bound. Bodies that yield or are coated are not bound by it.
///
/// Barber, Proc. R. Soc. Lond. A 459, 53 (2003).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bracket {
    /// Lower bound of G, W/K or S; 0 at the least load.
    pub lower: f64,
    /// Upper bound of G, W/K or S; infinite at the largest load.
    pub upper: f64,
}

impl Bracket {
    /// Returns the bracket of each point of a sweep, given in any order by its load and approach, for the
    /// `composite` conductivity κ_s, W/(m K) or S/m, and `modulus` E*.
    pub fn of_sweep(points: &[(Newton, Metre)], composite: f64, modulus: Pascal) -> Vec<Self> {
        let mut order: Vec<usize> = (0..points.len()).collect();
        order.sort_by(|one, other| points[*one].1.total_cmp(&points[*other].1));
        let mut brackets = vec![Self { lower: 0.0, upper: f64::INFINITY }; points.len()];
        for pair in order.windows(2) {
            let [(load, approach), (next_load, next)] = [points[pair[0]], points[pair[1]]];
            let slope = composite / modulus * (next_load - load) / (next - approach);
            // Points alike have no slope.
            if slope.is_finite() {
                brackets[pair[0]].upper = slope;
                brackets[pair[1]].lower = slope;
            }
        }
        brackets
    }

    /// Whether a conductance lies between both bounds, or no further off than a share `tolerance` of it.
    pub fn holds(&self, conductance: f64, tolerance: f64) -> bool {
        let slack = tolerance * conductance;
        self.lower - slack <= conductance && conductance <= self.upper + slack
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sweep_in_any_order_has_a_secant_on_either_side() {
        let points = [(4.0, 2.0), (1.0, 1.0), (9.0, 3.0), (9.0, 3.0)];
        let brackets = Bracket::of_sweep(&points, 2.0, 4.0);
        assert_eq!(brackets[1], Bracket { lower: 0.0, upper: 1.5 });
        assert_eq!(brackets[0], Bracket { lower: 1.5, upper: 2.5 });
        assert_eq!([brackets[2].lower, brackets[3].upper], [2.5, f64::INFINITY]);
        assert!(
            brackets[0].holds(2.0, 0.0) && !brackets[0].holds(2.6, 0.01) && brackets[0].holds(2.51, 0.01)
        );
        assert!(!brackets[0].holds(f64::NAN, 0.1));
    }
}
