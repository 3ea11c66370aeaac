//! The command `asperity`.

#[expect(dead_code, unused_imports, reason = "used by the commands to come")]
mod draw;

fn main() {}
