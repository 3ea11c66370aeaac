//! Merging of results over bands of rows, blocks and ranks.

/// A result for several parts of a grid, merged from those of each part.
pub trait Merged: Sized {
    /// Merges two parts.
    fn and(self, other: Self) -> Self;

    /// Merges all parts in order.
    ///
    /// # Panics
    /// If there is none.
    fn of_parts(parts: impl IntoIterator<Item = Self>) -> Self {
        parts.into_iter().reduce(Self::and).expect("a part")
    }

    /// Returns its numbers; their count is constant.
    fn numbers(&self) -> Vec<f64>;

    /// Creates it from its numbers.
    fn of_numbers(numbers: &[f64]) -> Self;
}

/// Sums of the numbers.
impl<const N: usize> Merged for [f64; N] {
    fn and(self, other: Self) -> Self {
        std::array::from_fn(|n| self[n] + other[n])
    }

    fn numbers(&self) -> Vec<f64> {
        self.to_vec()
    }

    fn of_numbers(numbers: &[f64]) -> Self {
        std::array::from_fn(|n| numbers[n])
    }
}

/// Logical or: whether it is true in any part.
impl Merged for bool {
    fn and(self, other: Self) -> Self {
        self || other
    }

    fn numbers(&self) -> Vec<f64> {
        vec![f64::from(u8::from(*self))]
    }

    fn of_numbers(numbers: &[f64]) -> Self {
        numbers[0] != 0.0
    }
}

/// The largest value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Largest(pub f64);

impl Merged for Largest {
    fn and(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }

    fn numbers(&self) -> Vec<f64> {
        vec![self.0]
    }

    fn of_numbers(numbers: &[f64]) -> Self {
        Self(numbers[0])
    }
}
