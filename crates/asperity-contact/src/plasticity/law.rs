//! Plastic state of a cell, and its tensors.

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
