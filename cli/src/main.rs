//! The `fastbike` binary.
fn main() {}
