//! Baked incident-radiance maps: light as it arrives at places on surfaces, from a few directions that all places share.
//!
//! Neither BRDF nor cosine is baked in: materials are edited at full speed under light that went everywhere. What an edited surface sends to others is
//! that of the bake. `README.md` has the formulas and figures.

mod average;
mod bake;
mod density;
mod directions;
mod gather;
mod map;
mod met;
mod method;
mod near;
mod points;
mod rays;
mod run;
mod settings;
mod shards;
mod times;

pub use average::average;
pub use bake::{BLOCK, Block, GROUPS, noise};
pub use directions::{Directions, Drawn, FEWEST, LISTS, Spread};
pub use map::in_floats;
pub use met::MetSurface;
pub use method::{ID, RadianceMap};
pub use near::{AGREEMENT, Filter, Grid, Near, RINGS, SET, weights};
pub use points::{Place, Surfaces};
pub use rays::MOST_MIRRORS;
pub use run::run;
pub use settings::{Look, PARAMS, Part, baked_directions};
pub use shards::{Shard, ShardAbout, merge, whole};
pub use times::{FrameTimes, frame_times};
