//! The command `asperity`.

#[cfg_attr(not(test), expect(dead_code, reason = "used by the commands to come"))]
#[expect(unused_imports, reason = "used by the commands to come")]
mod draw;

fn main() {}
