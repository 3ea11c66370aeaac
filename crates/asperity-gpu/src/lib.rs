#![doc = include_str!("../README.md")]

mod card;
mod cascade;
#[cfg(feature = "cuda")]
#[allow(unsafe_code)]
mod cuda;
mod device;
mod fields;
mod host;
mod nodes;
mod problem;
mod solver;
mod waves;

pub use card::Card;
pub use device::{Device, memory};
pub use problem::{
    Accuracy, Compliance, Contact, Control, Cost, Harmonics, Level, Precision, Problem, Rough, Solution,
    Statistics,
};
