//! Speed of building and asking the ray tracing structure.

fn main() {}
