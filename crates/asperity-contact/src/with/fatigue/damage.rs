//! Damage of load cycles, and its way to the surface of a body that loses height.

use crate::error::{Result, check};
use crate::units::Metre;

/// Damage of a load cycle by Basquin's law, which Miner's rule adds up to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Basquin {
    exponent: f64,
    cycles: f64,
    endurance: bool,
}

impl Basquin {
    /// Creates the law d = (f/b)^m/N₀ of a cycle with the `exponent` m and the `cycles` N₀ at the limit. With
    /// `endurance` there is no damage below the limit.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) unless both are above 0, and the exponent at most 100.
    pub fn new(exponent: f64, cycles: f64, endurance: bool) -> Result<Self> {
        check("exponent", exponent, exponent > 0.0 && exponent <= 100.0, "a number above 0, at most 100")?;
        check("cycles", cycles, cycles > 0.0 && cycles.is_finite(), "a number above 0")?;
        Ok(Self { exponent, cycles, endurance })
    }

    /// Damage of a cycle in which f is this multiple of its limit, at most 1e200.
    pub fn damage(&self, over_limit: f64) -> f64 {
        match over_limit {
            over if over <= 0.0 || self.endurance && over < 1.0 => 0.0,
            over => (over.powf(self.exponent) / self.cycles).min(1e200),
        }
    }
}

/// Advances the damage of a column at ascending `depths` over so many `cycles` in each of which it suffers
/// the damage `each` and loses the depth `removed`. Depths count from the surface as it is: worn material
/// uncovers what lies below. Below the last depth nothing has suffered.
///
/// # Panics
/// If there is not a damage for each depth.
pub fn advance_damage(depths: &[Metre], damage: &mut [f64], each: &[f64], cycles: f64, removed: Metre) {
    assert!(depths.len() == damage.len() && depths.len() == each.len(), "a damage for each depth");
    let worn = cycles * removed;
    let before = damage.to_vec();
    let at = |values: &[f64], depth: Metre| {
        let above = depths.partition_point(|z| *z <= depth);
        match (above.checked_sub(1), depths.get(above)) {
            (None, _) => values[0],
            (Some(k), None) => {
                if depth > depths[k] {
                    0.0
                } else {
                    values[k]
                }
            }
            (Some(k), Some(next)) => {
                let share = (depth - depths[k]) / (next - depths[k]);
                values[k] + share * (values[above] - values[k])
            }
        }
    };
    // A point that is z below the surface in the end was z + w (N − n) below it in cycle n.
    let mean = |depth: Metre| {
        if worn == 0.0 {
            return at(each, depth);
        }
        /// Parts of the way over which the damage is averaged.
        const PARTS: usize = 16;
        let part = |k: usize| at(each, depth + worn * (k as f64 + 0.5) / PARTS as f64);
        (0..PARTS).map(part).sum::<f64>() / PARTS as f64
    };
    let after: Vec<f64> =
        depths.iter().map(|depth| at(&before, depth + worn) + cycles * mean(*depth)).collect();
    damage.copy_from_slice(&after);
}

/// Volume of material at risk per area, by Ioannides and Harris: ∫ (σ − σᵤ)₊^c z^(−h) dz over ascending
/// `depths` > 0, from amplitudes of the stress. Only ratios of it have a meaning.
///
/// # Panics
/// If there is not an amplitude for each depth.
pub fn risk(depths: &[Metre], amplitudes: &[f64], limit: f64) -> f64 {
    /// Exponents of the stress and of the depth, of Lundberg and Palmgren.
    const STRESS: f64 = 31.0 / 3.0;
    const DEPTH: f64 = 7.0 / 3.0;
    assert_eq!(depths.len(), amplitudes.len(), "an amplitude for each depth");
    let at = |k: usize| (amplitudes[k] - limit).max(0.0).powf(STRESS) * depths[k].powf(-DEPTH);
    (1..depths.len()).map(|k| 0.5 * (depths[k] - depths[k - 1]) * (at(k - 1) + at(k))).sum()
}

#[cfg(test)]
mod tests {
    use super::super::critical_depth;
    use super::*;

    #[test]
    fn a_pass_at_the_limit_takes_its_share() {
        let steel = Basquin::new(10.0, 2e6, false).unwrap();
        assert!((steel.damage(1.0) * 2e6 - 1.0).abs() < 1e-12);
        assert!((steel.damage(2.0) / steel.damage(1.0) - 1024.0).abs() < 1e-9);
        assert!(steel.damage(0.5) > 0.0 && steel.damage(-0.1) == 0.0);
        let endures = Basquin::new(10.0, 2e6, true).unwrap();
        assert!(endures.damage(0.999) == 0.0 && endures.damage(1.0) == steel.damage(1.0));
        assert!(Basquin::new(0.0, 1.0, false).is_err() && Basquin::new(1.0, f64::NAN, false).is_err());
        assert!(Basquin::new(101.0, 1.0, false).is_err());
        assert_eq!(Basquin::new(100.0, 1.0, false).unwrap().damage(1e6), 1e200);
    }

    #[test]
    fn steady_wear_uncovers_the_integral_of_the_damage() {
        // ∫ (1 + z) e^(−z/0.3) dz = 0.39; the damage of what comes to the surface times the wear tends to it.
        let damage = |z: f64| (-z / 0.3).exp() * (1.0 + z);
        let errors = [20, 40, 80].map(|layers| {
            let depths: Vec<f64> = (0..layers).map(|k| (k as f64 + 0.5) / layers as f64 * 4.0).collect();
            let each: Vec<f64> = depths.iter().map(|z| damage(*z)).collect();
            let critical = critical_depth(&depths, &each);
            let mut suffered = vec![0.0; layers];
            let (wear, step) = (1e-3, 20.0);
            (0..400).for_each(|_| advance_damage(&depths, &mut suffered, &each, step, wear));
            let surface = 1.5 * suffered[0] - 0.5 * suffered[1];
            [surface * wear / 0.39 - 1.0, critical / 0.39 - 1.0]
        });
        for which in 0..2 {
            let order = (errors[0][which] / errors[2][which]).abs().log2() / 2.0;
            assert!(order > 0.7 && errors[2][which].abs() < 0.06, "{errors:?}");
        }
    }

    #[test]
    fn without_wear_damage_adds_up() {
        let mut damage = [0.5, 0.2, 0.0];
        advance_damage(&[1.0, 2.0, 3.0], &mut damage, &[0.1, 0.01, 0.001], 3.0, 0.0);
        for (found, expected) in damage.iter().zip([0.8, 0.23, 0.003]) {
            assert!((found - expected).abs() < 1e-14_f64, "{found} {expected}");
        }
        // Wear by a layer in a pass uncovers the one below.
        let mut damage = [0.5, 0.2, 0.0];
        advance_damage(&[1.0, 2.0, 3.0], &mut damage, &[0.0; 3], 1.0, 1.0);
        assert_eq!(damage, [0.2, 0.0, 0.0]);
    }
}
