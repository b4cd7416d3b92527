//! The `burnish` program.
fn main() {}
