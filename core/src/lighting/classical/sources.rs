//! Small bright sources of an environment, split off so that filtering by samples cannot miss them.
//!
//! A sun fills a few texels and carries half of the light. Samples of a lobe meet it or miss it; as a list of points it
//! is filtered exactly.

use glam::{Vec2, Vec3};

use crate::scene::Environment;

/// Sources that are split off at most: they are summed for every texel of the prefiltered levels.
pub const SOURCES_MAX: usize = 256;

/// A texel's light above the cap, as a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Source {
    /// Unit direction in the map's own frame, rotation and strength left out.
    pub direction: Vec3,
    /// Radiance above the cap times solid angle, in W/m^2 for W/(m^2 sr).
    pub power: Vec3,
}

/// An environment in two parts that sum to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Split {
    /// Channels of the map are to be clamped to this.
    pub cap: f32,
    /// What the clamp takes.
    pub sources: Vec<Source>,
}

/// Splits off the light of the brightest texels above that of the next one.
pub fn split(environment: &Environment) -> Split {
    let brightness = |c: &Vec3| c.max_element();
    let mut values: Vec<f32> = environment.texels.iter().map(brightness).collect();
    let cap = if values.len() > SOURCES_MAX {
        *values.select_nth_unstable_by(SOURCES_MAX, |a, b| b.total_cmp(a)).1
    } else {
        f32::INFINITY
    };
    let own_frame = Environment::new("", environment.width, environment.height, Vec::new());
    let width = environment.width as usize;
    let mut sources = Vec::new();
    for (index, texel) in environment.texels.iter().enumerate() {
        if brightness(texel) > cap {
            let (x, y) = ((index % width) as u32, (index / width) as u32);
            let above = (*texel - Vec3::splat(cap)).max(Vec3::ZERO);
            sources.push(Source {
                direction: own_frame.texel_direction(x, y, Vec2::splat(0.5)),
                power: above * environment.texel_solid_angle(y) as f32,
            });
        }
    }
    Split { cap, sources }
}
