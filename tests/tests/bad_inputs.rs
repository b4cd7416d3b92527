//! Files that are broken, hostile or not what they say: refused in words that name file and place, or shown with a
//! notice; never a panic, a hang or unbounded memory.

#[path = "bad_inputs/containers.rs"]
mod containers;
#[path = "bad_inputs/environments.rs"]
mod environments;
#[path = "bad_inputs/files.rs"]
mod files;
#[path = "bad_inputs/geometry.rs"]
mod geometry;
#[path = "bad_inputs/mutation.rs"]
mod mutation;
#[path = "bad_inputs/sources.rs"]
mod sources;
