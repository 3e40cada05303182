//! The `frixel` command.
fn main() {}
