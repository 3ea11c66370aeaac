//! The command `asperity`.

#[expect(dead_code, reason = "called once there are commands")]
mod report;

fn main() {}
