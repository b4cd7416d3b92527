//! Files that are broken, hostile or not what they say: refused in words that name file and place, or shown with a
//! notice; never a panic, a hang or unbounded memory.

mod containers;
mod environments;
mod files;
mod geometry;
mod mutation;
mod sources;
