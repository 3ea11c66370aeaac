//! Flow of a cell: its plastic strain as a function of stress and history.

use crate::units::Pascal;

/// A symmetric tensor, components in the order of [`crate::stress::Component::ALL`].
pub type Tensor = [f64; 6];

/// Plastic state of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CellState {
    /// Plastic strain, traceless, tensor strain.
    pub strain: Tensor,
    /// Accumulated plastic strain p̄ = ∫ √(⅔ dε:dε).
    pub accumulated: f64,
    /// Back stress X, traceless, Pa.
    pub back: Tensor,
}

/// A flow law: maps a stress predictor and the state of a cell to its new state.
pub trait PlasticLaw: std::fmt::Debug + Send + Sync {
    /// Returns the state after an increment from `state`, if the cell flows.
    ///
    /// The `predictor` is y = dev σ + `stiffness` ε, Pa, with the unknown plastic strain ε. It does not
    /// change in the increment if the stress relaxes by the stiffness times the strain. With 2μ it is the
    /// stress of the total strain.
    fn flow(&self, predictor: &Tensor, stiffness: Pascal, state: &CellState) -> Option<CellState>;

    /// Yield stress in tension of virgin material, Pa.
    fn yield_stress(&self) -> Pascal;

    /// Whether the law has a back stress.
    fn is_kinematic(&self) -> bool;
}

/// a : b.
#[inline]
pub(super) fn contract(a: &Tensor, b: &Tensor) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2.0 * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5])
}

/// √(3/2 a:a) for a deviator.
#[inline]
pub(super) fn equivalent(a: &Tensor) -> f64 {
    (1.5 * contract(a, a)).sqrt()
}
