//! Long-term regime of elasto-plastic bodies over many passes: shakedown, cyclic plasticity, ratcheting.

use crate::motion::record::{PassPlasticRecord, Regime};
use crate::units::Metre;

/// Plastic work of a pass relative to the first, below which the bodies have shaken down.
const SHAKEN_DOWN: f64 = 1e-3;
/// Largest relative change of the plastic work from one pass to the next in a steady regime.
const ALIKE: f64 = 0.05;
/// Net strain of a pass relative to the strain accumulated in it, below which the plastic flow is cyclic.
const CYCLIC: f64 = 0.05;

impl Regime {
    /// Determines the regime from the records of the passes.
    pub fn from_passes(passes: &[PassPlasticRecord]) -> Self {
        let work = |pass: &PassPlasticRecord| pass.plastic_work_lower + pass.plastic_work_upper;
        let Some(first) = passes.iter().map(work).find(|work| *work > 0.0) else {
            return Self::Elastic;
        };
        let [.., before, last] = passes else { return Self::Undecided };
        let [then, now] = [work(before), work(last)];
        if now < SHAKEN_DOWN * first && now <= then {
            return Self::ShakesDown;
        }
        if passes.len() < 3 || (now - then).abs() > ALIKE * then {
            return Self::Undecided;
        }
        let net =
            last.plastic_work_lower * last.net_strain_lower + last.plastic_work_upper * last.net_strain_upper;
        if net < CYCLIC * now { Self::Cyclic } else { Self::Ratchets }
    }
}

/// Returns the ratcheting rates in the last of these passes: the growth of the largest plastic strain, and
/// the displacement along x of the surface of the body that moves more.
pub(super) fn rates(passes: &[PassPlasticRecord]) -> Option<(f64, Metre)> {
    let [.., before, last] = passes else { return None };
    let strain = |pass: &PassPlasticRecord| pass.max_plastic_strain_lower.max(pass.max_plastic_strain_upper);
    let [lower, upper] = [last.surface_shift_lower, last.surface_shift_upper];
    Some((strain(last) - strain(before), if lower.abs() >= upper.abs() { lower } else { upper }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Passes with these plastic works and net strains, whose surface moves by −1 µm.
    fn passes(works: &[(f64, f64)]) -> Vec<PassPlasticRecord> {
        let pass = |(plastic_work_lower, net_strain_lower): &(f64, f64)| PassPlasticRecord {
            plastic_work_lower: *plastic_work_lower,
            net_strain_lower: *net_strain_lower,
            surface_shift_lower: -1e-6,
            ..PassPlasticRecord::default()
        };
        works.iter().map(pass).collect()
    }

    #[test]
    fn passes_tell_what_becomes_of_the_bodies() {
        let of = |works: &[(f64, f64)]| Regime::from_passes(&passes(works));
        assert_eq!(of(&[(0.0, 0.0), (0.0, 0.0)]), Regime::Elastic);
        assert_eq!(of(&[(1.0, 1.0)]), Regime::Undecided);
        assert_eq!(of(&[(1.0, 1.0), (0.4, 1.0), (0.16, 1.0)]), Regime::Undecided);
        assert_eq!(of(&[(1.0, 1.0), (0.4, 1.0), (0.0, 0.0)]), Regime::ShakesDown);
        assert_eq!(of(&[(1.0, 1.0), (0.01, 1.0), (9e-4, 1.0)]), Regime::ShakesDown);
        assert_eq!(of(&[(1.0, 1.0), (0.5, 0.5), (0.49, 0.04)]), Regime::Cyclic);
        assert_eq!(of(&[(1.0, 1.0), (0.5, 0.5), (0.49, 0.4)]), Regime::Ratchets);
        assert_eq!(rates(&passes(&[(1.0, 1.0), (0.5, 0.5)])), Some((0.0, -1e-6)));
        // Plastic work that grows from nearly zero is no shakedown.
        assert_eq!(of(&[(1.0, 1.0), (1e-5, 1.0), (5e-4, 1.0)]), Regime::Undecided);
        let words: Vec<String> =
            [Regime::ShakesDown, Regime::Elastic].iter().map(|r| serde_json::to_string(r).unwrap()).collect();
        assert_eq!(words, ["\"shakes-down\"", "\"elastic\""]);
    }
}
