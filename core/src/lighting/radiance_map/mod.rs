//! Baked incident-radiance maps: light as it arrives at places on surfaces, from a few directions that all places share.
//!
//! Neither BRDF nor cosine is baked in: materials are edited at full speed under light that went everywhere. What an edited surface sends to others is
//! that of the bake. `README.md` has the formulas and figures.

use crate::leaf::Leaf;
use crate::lighting::classical;

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

/// The WGSL twin. The pass supplies what the head of the file lists.
pub static WGSL: Leaf = Leaf {
    name: "radiance_map",
    source: include_str!("radiance_map.wgsl"),
    needs: &[&classical::WGSL],
    externs: "fn radiance_map_position(place: u32) -> vec3f { return vec3f(f32(place)); }
fn radiance_map_normal(place: u32) -> vec3f { return vec3f(0.0, 0.0, 1.0); }
fn radiance_map_start(cell: u32) -> u32 { return cell; }
fn radiance_map_neighbour(index: u32) -> u32 { return index; }
fn radiance_map_cell(index: u32) -> vec4u { return vec4u(index); }
fn radiance_map_corner(index: u32) -> vec4f { return vec4f(f32(index)); }
fn radiance_map_light(place: u32, k: u32) -> vec3f { return vec3f(f32(place + k)); }",
};
