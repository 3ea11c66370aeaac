//! Tests across the modules of the crate, as one program with a module for each subject.

mod bounds;
mod random_rolling;
mod steady_rolling;
