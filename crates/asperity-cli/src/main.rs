//! The command `asperity`.
#![allow(dead_code, unused_imports)]

mod draw;
mod report;
mod verify;

fn main() {}
