//! Rectangles and spheres that shine, by linearly transformed cosines.

mod cosines;
pub mod fit;
mod polygon;

pub use cosines::{Cosines, NODES, NUMBERS, STRIDE, table};
pub use polygon::{CORNERS_MAX, Polygon};
