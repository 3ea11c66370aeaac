//! What is merged over bands of rows, blocks and ranks.

/// What several parts of a grid come to, merged of what each does.
pub(crate) trait Merged: Sized {
    /// Two parts together.
    fn and(self, other: Self) -> Self;

    /// All parts together, merged in their order.
    ///
    /// # Panics
    /// If there is none.
    fn of_parts(parts: impl IntoIterator<Item = Self>) -> Self {
        parts.into_iter().reduce(Self::and).expect("a part")
    }

    /// What it consists of, always as many numbers.
    fn numbers(&self) -> Vec<f64>;

    /// What consists of these numbers.
    fn of_numbers(numbers: &[f64]) -> Self;
}

/// Sums.
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

/// Whether it is so in any part.
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
pub(crate) struct Largest(pub(crate) f64);

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
