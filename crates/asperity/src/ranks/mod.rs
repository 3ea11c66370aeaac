//! Ranks: processes that hold one grid together, each a slab of its rows.
//!
//! The library knows no way to start them and none to talk between them: who has one gives it as [`Ranks`].

mod halo;
mod merged;
mod parts;
mod slab;
#[cfg(test)]
pub(crate) mod threads;

pub(crate) use halo::Halo;
pub(crate) use merged::{Largest, Merged};
pub(crate) use parts::Parts;
pub use slab::Slab;

/// Processes, numbered from 0, that work on one grid together, as one of them sees them.
///
/// All of them call the same methods in the same order, and each call returns once it has what it waits for. A rank that fails
/// must end the others, too: they would wait for it.
pub trait Ranks: Send + Sync {
    /// The number of this rank.
    fn rank(&self) -> usize;

    /// The number of all ranks, at least 1.
    fn count(&self) -> usize;

    /// The numbers that each rank gives, one after another in the order of the ranks, given to all. Rank r gives `counts[r]`.
    fn gather(&self, numbers: &[f64], counts: &[usize]) -> Vec<f64>;

    /// Gives each rank its part of `sent`, `sent_counts[r]` numbers for rank r, and takes as many from it as
    /// `received_counts[r]` says; both lie one after another in the order of the ranks.
    fn exchange(&self, sent: &[f64], sent_counts: &[usize], received: &mut [f64], received_counts: &[usize]);

    /// As [`Ranks::exchange`], in single precision.
    fn exchange_single(
        &self,
        sent: &[f32],
        sent_counts: &[usize],
        received: &mut [f32],
        received_counts: &[usize],
    );
}

/// A process that works alone.
struct Alone;

impl Ranks for Alone {
    fn rank(&self) -> usize {
        0
    }

    fn count(&self) -> usize {
        1
    }

    fn gather(&self, numbers: &[f64], _: &[usize]) -> Vec<f64> {
        numbers.to_vec()
    }

    fn exchange(&self, sent: &[f64], _: &[usize], received: &mut [f64], _: &[usize]) {
        received.copy_from_slice(sent);
    }

    fn exchange_single(&self, sent: &[f32], _: &[usize], received: &mut [f32], _: &[usize]) {
        received.copy_from_slice(sent);
    }
}

/// A number that ranks exchange.
pub(crate) trait Number: Copy + Default {
    /// [`Ranks::exchange`] for numbers of this precision.
    fn exchange(
        ranks: &dyn Ranks,
        sent: &[Self],
        sent_counts: &[usize],
        received: &mut [Self],
        received_counts: &[usize],
    );
}

impl Number for f64 {
    fn exchange(ranks: &dyn Ranks, sent: &[f64], out: &[usize], received: &mut [f64], back: &[usize]) {
        ranks.exchange(sent, out, received, back);
    }
}

impl Number for f32 {
    fn exchange(ranks: &dyn Ranks, sent: &[f32], out: &[usize], received: &mut [f32], back: &[usize]) {
        ranks.exchange_single(sent, out, received, back);
    }
}
