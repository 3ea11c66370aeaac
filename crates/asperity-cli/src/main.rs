//! The command `asperity`.

fn main() {}
