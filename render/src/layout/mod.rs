//! Memory layouts shared by Rust and WGSL.

pub mod types;
