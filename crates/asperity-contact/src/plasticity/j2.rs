//! J2 plasticity: flow along the deviator of the stress.

use super::hardening::Hardening;
use super::law::{CellState, Tensor, equivalent};
use crate::error::{Error, Result, check, check_in};
use crate::units::{Dimension, Pascal};

/// Flow along the deviator of σ − X once its von Mises equivalent reaches the yield stress, with the back
/// stress X.
///
/// | hardening | law |
/// |---|---|
/// | isotropic | [`Hardening`]: the yield stress grows with the accumulated strain |
/// | Prager | `kinematic` M: X = ⅔ M ε |
/// | Armstrong and Frederick | with `recovery` γ: dX = ⅔ M dε − γ X dp̄, at most M/γ |
///
/// An increment is a step of backward Euler (radial return). It is exact if the direction of flow does not
/// change.
#[derive(Debug, Clone, PartialEq)]
pub struct J2 {
    hardening: Hardening,
    kinematic: Pascal,
    recovery: f64,
}

impl J2 {
    /// Creates a law without back stress, with or without isotropic hardening.
    pub fn new(hardening: Hardening) -> Self {
        Self { hardening, kinematic: 0.0, recovery: 0.0 }
    }

    /// Adds a back stress with the `modulus` M ≥ 0 and a `recovery` γ ≥ 0, which is 0 for Prager's law.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if one of them is negative or not finite, [`Error::Unsupported`] for a recovery
    /// without a modulus.
    pub fn with_back_stress(self, modulus: Pascal, recovery: f64) -> Result<Self> {
        let good = |value: f64| value >= 0.0 && value.is_finite();
        check_in(Dimension::Pressure, "kinematic", modulus, good(modulus), "a finite modulus of at least 0")?;
        check("recovery", recovery, good(recovery), "a finite number of at least 0")?;
        if recovery > 0.0 && modulus == 0.0 {
            return Err(Error::Unsupported("recovery of the back stress needs a kinematic modulus"));
        }
        Ok(Self { kinematic: modulus, recovery, ..self })
    }

    /// Growth of the yield stress.
    pub fn hardening(&self) -> &Hardening {
        &self.hardening
    }

    /// The driving stress ξ of the flow: y − 2μθε₀ − X₀/(1 + γ Δp̄).
    #[inline]
    fn driving(&self, predictor: &Tensor, stiffness: Pascal, state: &CellState, flow: f64) -> Tensor {
        let kept = 1.0 / (1.0 + self.recovery * flow);
        std::array::from_fn(|i| predictor[i] - stiffness * state.strain[i] - kept * state.back[i])
    }

    /// Returns the Δp̄ that solves ξe − (3/2 stiffness + M/(1 + γ Δp̄)) Δp̄ = σY(p̄₀ + Δp̄), which is not
    /// linear with recovery. The difference decreases everywhere by at least 3/2 stiffness, so that Newton's
    /// steps stay within the known bounds.
    fn recovering(&self, predictor: &Tensor, stiffness: Pascal, state: &CellState, excess: Pascal) -> f64 {
        let excess_at = |flow: f64| {
            let driving = equivalent(&self.driving(predictor, stiffness, state, flow));
            let back = self.kinematic * flow / (1.0 + self.recovery * flow);
            driving - 1.5 * stiffness * flow - back - self.hardening.yield_stress(state.accumulated + flow)
        };
        // The flow is largest without the old and new back stress.
        let (mut low, mut high) = (0.0, (excess + equivalent(&state.back)) / (1.5 * stiffness));
        let (mut flow, mut value) = (0.0, excess);
        for _ in 0..100 {
            let kept = 1.0 / (1.0 + self.recovery * flow);
            let slope = 1.5 * stiffness
                + self.kinematic * kept * kept
                + self.hardening.slope(state.accumulated + flow);
            let newton = flow + value / slope;
            let next = if low < newton && newton < high { newton } else { 0.5 * (low + high) };
            if (next - flow).abs() <= f64::EPSILON * next {
                break;
            }
            flow = next;
            value = excess_at(flow);
            *(if value > 0.0 { &mut low } else { &mut high }) = flow;
        }
        flow
    }

    /// Returns the state after an increment from `state`, if the cell flows.
    ///
    /// The `predictor` is y = dev σ + `stiffness` ε, Pa, with the unknown plastic strain ε. It does not
    /// change in the increment if the stress relaxes by the stiffness times the strain. With 2μ it is the
    /// stress of the total strain.
    pub fn flow(&self, predictor: &Tensor, stiffness: Pascal, state: &CellState) -> Option<CellState> {
        let trial = self.driving(predictor, stiffness, state, 0.0);
        let excess = equivalent(&trial) - self.hardening.yield_stress(state.accumulated);
        if excess <= 0.0 {
            return None;
        }
        let flow = if self.recovery == 0.0 {
            self.hardening.flow(state.accumulated, excess, 1.5 * stiffness + self.kinematic)
        } else {
            self.recovering(predictor, stiffness, state, excess)
        };
        let driving = self.driving(predictor, stiffness, state, flow);
        let along = 1.5 * flow / equivalent(&driving);
        let kept = 1.0 / (1.0 + self.recovery * flow);
        Some(CellState {
            strain: std::array::from_fn(|i| state.strain[i] + along * driving[i]),
            accumulated: state.accumulated + flow,
            back: std::array::from_fn(|i| {
                kept * (state.back[i] + 2.0 / 3.0 * self.kinematic * along * driving[i])
            }),
        })
    }

    /// Yield stress in tension of virgin material, Pa.
    pub fn yield_stress(&self) -> Pascal {
        self.hardening.initial()
    }

    /// Whether the law has a back stress.
    pub fn is_kinematic(&self) -> bool {
        self.kinematic > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// 2μ.
    const STIFFNESS: f64 = 160e9;
    const YIELD: f64 = 1.5e9;
    /// Deviators of a unit tension and of a unit shear.
    const TENSION: Tensor = [2.0 / 3.0, -1.0 / 3.0, -1.0 / 3.0, 0.0, 0.0, 0.0];
    const SHEAR: Tensor = [0.0, 0.0, 0.0, 0.0, 0.0, 1.0];

    fn times(factor: f64, tensor: &Tensor) -> Tensor {
        tensor.map(|t| factor * t)
    }

    fn plus(a: &Tensor, b: &Tensor) -> Tensor {
        std::array::from_fn(|i| a[i] + b[i])
    }

    /// Applies a deviatoric total strain to a cell; returns its state and the deviator of its stress.
    fn stretch(law: &J2, strain: &Tensor, state: &CellState) -> (CellState, Tensor) {
        let predictor = times(STIFFNESS, strain);
        let state = law.flow(&predictor, STIFFNESS, state).unwrap_or(*state);
        (state, plus(&predictor, &times(-STIFFNESS, &state.strain)))
    }

    /// Returns the total strain dev σ/2μ + ε of a cell strained plastically to p along `way`, whose
    /// equivalent is 1 as a stress.
    fn strain_for(way: &Tensor, stress: f64, plastic: f64) -> Tensor {
        times(stress / STIFFNESS + 1.5 * plastic, way)
    }

    fn laws() -> Vec<(J2, f64, f64)> {
        let linear = |h| J2::new(Hardening::linear(YIELD, h).unwrap());
        vec![
            (linear(0.0), 0.0, 0.0),
            (linear(10e9), 10e9, 0.0),
            (linear(0.0).with_back_stress(20e9, 0.0).unwrap(), 0.0, 20e9),
            (linear(10e9).with_back_stress(20e9, 0.0).unwrap(), 10e9, 20e9),
        ]
    }

    #[test]
    fn tension_and_shear_harden_by_both_moduli() {
        for (law, isotropic, kinematic) in laws() {
            for way in [TENSION, times(1.0 / 3f64.sqrt(), &SHEAR)] {
                for plastic in [1e-6, 1e-3, 0.05] {
                    let stress = YIELD + (isotropic + kinematic) * plastic;
                    let (state, found) =
                        stretch(&law, &strain_for(&way, stress, plastic), &CellState::default());
                    assert_relative_eq!(state.accumulated, plastic, max_relative = 1e-9);
                    assert_relative_eq!(equivalent(&found), stress, max_relative = 1e-12);
                    for i in 0..6 {
                        assert_relative_eq!(found[i], stress * way[i], epsilon = 1e-12 * stress);
                        assert_relative_eq!(
                            state.strain[i],
                            1.5 * plastic * way[i],
                            epsilon = 1e-12 * stress / STIFFNESS
                        );
                        assert_relative_eq!(
                            state.back[i],
                            kinematic * plastic * way[i],
                            epsilon = 1e-12 * stress
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn below_the_yield_stress_nothing_flows() {
        for (law, ..) in laws() {
            for (share, flows) in [(1.0 - 1e-12, false), (1.0 + 1e-12, true)] {
                let predictor = times(share * YIELD, &TENSION);
                assert_eq!(law.flow(&predictor, STIFFNESS, &CellState::default()).is_some(), flows);
            }
        }
    }

    #[test]
    fn a_measured_curve_is_followed() {
        let curve = [(0.0, YIELD), (0.01, 1.7e9), (0.03, 1.8e9)];
        let law = J2::new(Hardening::curve(&curve).unwrap());
        for (plastic, stress) in [(0.005, 1.6e9), (0.01, 1.7e9), (0.02, 1.75e9), (0.5, 1.8e9)] {
            // In one step from zero.
            let (state, found) = stretch(&law, &strain_for(&TENSION, stress, plastic), &CellState::default());
            assert_relative_eq!(state.accumulated, plastic, max_relative = 1e-12);
            assert_relative_eq!(equivalent(&found), stress, max_relative = 1e-12);
        }
    }

    #[test]
    fn a_cycle_of_plastic_strain_closes_as_its_hardening_has_it() {
        // Alternating plastic strains ±a: branch n ends at σY + (2n − 1) a H ± M a.
        let a = 0.004;
        for (law, isotropic, kinematic) in laws() {
            let mut state = CellState::default();
            for branch in 1..=6 {
                let sign = if branch % 2 == 1 { 1.0 } else { -1.0 };
                let size = YIELD + isotropic * (2.0 * f64::from(branch) - 1.0) * a + kinematic * a;
                let strain = strain_for(&TENSION, sign * size, sign * a);
                let (next, stress) = stretch(&law, &strain, &state);
                state = next;
                for i in 0..6 {
                    assert_relative_eq!(stress[i], sign * size * TENSION[i], epsilon = 1e-12 * size);
                    assert_relative_eq!(
                        state.strain[i],
                        sign * 1.5 * a * TENSION[i],
                        epsilon = 1e-12 * size / STIFFNESS
                    );
                }
                assert_relative_eq!(
                    state.accumulated,
                    (2.0 * f64::from(branch) - 1.0) * a,
                    max_relative = 1e-11
                );
            }
        }
    }

    #[test]
    fn a_recovering_back_stress_grows_towards_its_limit() {
        let (modulus, recovery) = (20e9, 50.0);
        let law =
            |h| J2::new(Hardening::linear(YIELD, h).unwrap()).with_back_stress(modulus, recovery).unwrap();
        // One step of backward Euler: X = M p/(1 + γp).
        for (hardening, plastic) in [(0.0, 0.01), (10e9, 0.002), (0.0, 3.0)] {
            let law = law(hardening);
            let back = modulus * plastic / (1.0 + recovery * plastic);
            let stress = YIELD + hardening * plastic + back;
            let (state, found) = stretch(&law, &strain_for(&TENSION, stress, plastic), &CellState::default());
            assert_relative_eq!(state.accumulated, plastic, max_relative = 1e-11);
            assert_relative_eq!(equivalent(&found), stress, max_relative = 1e-12);
            assert_relative_eq!(equivalent(&state.back), back, max_relative = 1e-11);
        }
        // Many steps: X = M/γ (1 − e^−γp), and back again, −M/γ + (M/γ + X) e^−γ(p − p₁), both to first
        // order.
        let errors = [50, 100, 200].map(|steps| {
            let law = law(0.0);
            let mut state = CellState::default();
            let go = |strain: f64, from: f64, state: &mut CellState| {
                for step in 1..=steps {
                    let e = from + (strain - from) * f64::from(step) / f64::from(steps);
                    *state = stretch(&law, &times(1.5 * e, &TENSION), state).0;
                }
            };
            go(0.04, 0.0, &mut state);
            let limit = modulus / recovery;
            let forth = limit * (1.0 - (-recovery * state.accumulated).exp());
            let first = equivalent(&state.back) / forth - 1.0;
            let (x, p) = (equivalent(&state.back), state.accumulated);
            go(-0.04, 0.04, &mut state);
            let exact = -limit + (limit + x) * (-recovery * (state.accumulated - p)).exp();
            // Along tension: 3/2 of the axial component.
            [first, 1.5 * state.back[0] / exact - 1.0]
        });
        for kind in 0..2 {
            for pair in errors.windows(2) {
                let ratio = pair[0][kind] / pair[1][kind];
                assert!((1.8..2.2).contains(&ratio), "{errors:?}");
            }
        }
    }

    #[test]
    fn a_small_increment_has_the_tangent_of_the_flow_rule() {
        // dσ = 2μ (dε − 3/2 m m:dε 2μ/(2μ·3/2 + H + M)·…): along m the fraction (H + M)/(3μ + H + M) of the
        // stress remains, across m all of it.
        for (law, isotropic, kinematic) in laws() {
            let size = YIELD + (isotropic + kinematic) * 0.01;
            let start = strain_for(&TENSION, size, 0.01);
            let (state, before) = stretch(&law, &start, &CellState::default());
            let along = times(1e-4, &TENSION);
            let (_, after) = stretch(&law, &plus(&start, &along), &state);
            let kept = (isotropic + kinematic) / (1.5 * STIFFNESS + isotropic + kinematic);
            for i in 0..6 {
                assert_relative_eq!(
                    after[i] - before[i],
                    kept * STIFFNESS * along[i],
                    epsilon = 1e-12 * size
                );
            }
            // Across m the stress rotates: second differences decrease with the step.
            let errors = [1e-4, 1e-5].map(|step| {
                let (_, after) = stretch(&law, &plus(&start, &times(step, &SHEAR)), &state);
                (after[5] / (STIFFNESS * step) - 1.0).abs()
            });
            assert!(errors[1] < 0.11 * errors[0], "{errors:?}");
        }
    }

    #[test]
    fn a_softer_predictor_gives_the_same_answer() {
        // y = dev σ + θ 2μ ε leads to the same state, with its stress.
        for (law, ..) in laws() {
            let strain = strain_for(&TENSION, 1.9e9, 0.02);
            let (state, stress) = stretch(&law, &strain, &CellState::default());
            let softer = 0.65 * STIFFNESS;
            let predictor = plus(&stress, &times(softer, &state.strain));
            let found = law.flow(&predictor, softer, &CellState::default()).unwrap();
            assert_relative_eq!(found.accumulated, state.accumulated, max_relative = 1e-12);
        }
    }

    #[test]
    fn constants_without_meaning_are_refused() {
        let law = || J2::new(Hardening::perfect(1.0).unwrap());
        assert!(law().with_back_stress(-1.0, 0.0).is_err());
        assert!(law().with_back_stress(1.0, -1.0).is_err());
        assert!(law().with_back_stress(0.0, 1.0).is_err());
        assert!(law().with_back_stress(1.0, f64::NAN).is_err());
    }
}
