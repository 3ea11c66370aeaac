//! A static contact on a grid that is divided among ranks, processes that have a slab of its rows each.
//!
//! [`run_on_ranks`] computes a case on any [`Ranks`](asperity_base::ranks::Ranks), and [`collect`] gathers
//! its fields. The command `asperity-mpi` calls them on the processes of MPI. Nothing else here knows MPI:
//! without the feature `mpi`, the default, the library needs none, and its tests use threads as ranks.

mod transposition;
mod transform;
mod convolution;
pub mod operator;
mod generate;
pub mod press;
mod prepare;
mod index;
mod run;

pub use run::{DemandOfRank, collect, demand_of_collecting, demand_on_ranks, run_on_ranks};
