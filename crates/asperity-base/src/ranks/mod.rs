//! Ranks: processes that share one grid, each with a slab of its rows.
//!
//! The library neither starts them nor implements communication between them. The caller supplies both as
//! [`Ranks`].

mod halo;
mod merged;
mod parts;
mod slab;
pub mod threads;

pub use halo::Halo;
pub use merged::{Largest, Merged};
pub use parts::Parts;
pub use slab::Slab;

/// Processes, numbered from 0, that work on one grid together, from the view of one of them.
///
/// All ranks call the same methods in the same order, and each call returns once its data have arrived. If a
/// rank fails, the caller must end the others, too, because they wait for it.
pub trait Ranks: Send + Sync {
    /// Number of this rank.
    fn rank(&self) -> usize;

    /// Number of ranks, at least 1.
    fn count(&self) -> usize;

    /// Gathers the numbers of all ranks, in rank order, and returns them on every rank. Rank r contributes
    /// `counts[r]` numbers.
    fn gather(&self, numbers: &[f64], counts: &[usize]) -> Vec<f64>;

    /// Sends each rank its part of `sent`, `sent_counts[r]` numbers for rank r, and receives
    /// `received_counts[r]` numbers from it. Both are in rank order.
    fn exchange(&self, sent: &[f64], sent_counts: &[usize], received: &mut [f64], received_counts: &[usize]);

    /// [`Ranks::exchange`] in single precision.
    fn exchange_single(
        &self,
        sent: &[f32],
        sent_counts: &[usize],
        received: &mut [f32],
        received_counts: &[usize],
    );
}

/// A single process.
struct SingleProcess;

impl Ranks for SingleProcess {
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
pub trait Number: Copy + Default {
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
