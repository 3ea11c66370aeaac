#![doc = include_str!("../README.md")]

mod cascade;
#[cfg(feature = "cuda")]
#[allow(unsafe_code)]
mod cuda;
mod device;
mod fields;
mod host;
mod problem;
mod solver;

pub use device::{Card, Device, memory};
pub use problem::{
    Compliance, Contact, Control, Cost, Harmonics, Level, Precision, Problem, Solution, Watch,
};
