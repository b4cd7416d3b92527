//! Baked incident-radiance maps: light as it arrives at places on surfaces, from a few directions that all places share.
//!
//! Neither BRDF nor cosine is baked in: materials are edited at full speed under light that went everywhere. What an edited surface sends to others is
//! that of the bake. `README.md` has the formulas and figures.

mod average;
mod bake;
mod directions;
mod met;
mod method;
mod near;
mod points;
mod run;
mod shards;

pub use average::average;
pub use bake::{Asked, BLOCK, Baker, Block, GROUPS, assembled, noise};
pub use directions::{Directions, Drawn, FEWEST, Spread};
pub use met::MetSurface;
pub use method::{ID, Look, MOST_MIRRORS, PARAMS, RadianceMap, baked_directions};
pub use near::{AGREEMENT, Filter, Grid, Near, RINGS, SET, weights};
pub use points::{Place, Surfaces};
pub use run::run;
pub use shards::{KIND as SHARD_KIND, Shard, ShardAbout, merge, whole};
