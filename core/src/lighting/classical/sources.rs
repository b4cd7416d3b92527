//! Small bright sources of an environment, split off so that filtering by samples cannot miss them.
//!
//! A sun fills a few texels and carries half of the light. Samples of a lobe meet it or miss it; as a list of points it
//! is filtered exactly.

use std::sync::Arc;

use glam::{Vec2, Vec3};

use crate::scene::Environment;

/// Sources that are split off for the prefiltered levels.
pub const PREFILTER_SOURCES: usize = 256;
/// Sources that are split off for shading: fewer, since each is reflected in every pixel of every frame.
pub const SHADING_SOURCES: usize = 128;

/// Light that was taken out of a block of texels, as a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Source {
    /// Unit direction in the map's own frame, rotation and strength left out.
    pub direction: Vec3,
    /// Radiance that was taken, times its solid angle.
    pub power: Vec3,
}

/// An environment in two parts that sum to it.
#[derive(Clone, Debug)]
pub struct Split {
    /// The map with its brightest blocks dimmed to the next one.
    pub dimmed: Environment,
    /// What was taken.
    pub sources: Vec<Source>,
}

/// Splits off the light of the `count` brightest blocks of `block` by `block` texels above that of the next one.
pub fn split(environment: &Environment, block: u32, count: usize) -> Split {
    let block = block.max(1);
    let columns = environment.width.div_ceil(block);
    let blocks: Vec<Block> = (0..environment.height.div_ceil(block))
        .flat_map(|y| (0..columns).map(move |x| (x, y)))
        .map(|(x, y)| Block::new(environment, x * block, y * block, block))
        .collect();
    let mut means: Vec<f32> = blocks.iter().map(|b| b.mean).collect();
    let cap =
        if means.len() > count { *means.select_nth_unstable_by(count, |a, b| b.total_cmp(a)).1 } else { f32::INFINITY };
    let mut dimmed = environment.clone();
    let bright = blocks.iter().filter(|b| b.mean > cap);
    let sources = bright.filter_map(|b| b.take(&mut dimmed, 1.0 - cap / b.mean)).collect();
    Split { dimmed, sources }
}

/// A rectangle of texels.
struct Block {
    columns: std::ops::Range<u32>,
    rows: std::ops::Range<u32>,
    /// Mean of the largest channel.
    mean: f32,
}

impl Block {
    fn new(map: &Environment, x: u32, y: u32, size: u32) -> Block {
        let mut block = Block { columns: x..(x + size).min(map.width), rows: y..(y + size).min(map.height), mean: 0.0 };
        let count = block.columns.len() * block.rows.len();
        let sum: f32 = block.texels(map).map(|(index, ..)| map.texels[index].max_element()).sum();
        block.mean = sum / count as f32;
        block
    }

    /// Index, column and row of each texel.
    fn texels(&self, map: &Environment) -> impl Iterator<Item = (usize, u32, u32)> + use<> {
        let (columns, width) = (self.columns.clone(), map.width);
        self.rows.clone().flat_map(move |y| columns.clone().map(move |x| ((y * width + x) as usize, x, y)))
    }

    /// Takes a share of the light out of the map; `None` where there is none.
    fn take(&self, map: &mut Environment, share: f32) -> Option<Source> {
        let own_frame = Environment::new("", map.width, map.height, Vec::new());
        let (mut power, mut toward) = (Vec3::ZERO, Vec3::ZERO);
        let places: Vec<_> = self.texels(map).map(|place| (place, map.texel_solid_angle(place.2) as f32)).collect();
        // Copies the texels if another map shares them.
        let texels = Arc::make_mut(&mut map.texels);
        for ((index, x, y), solid_angle) in places {
            let taken = share * texels[index];
            texels[index] -= taken;
            let part = taken * solid_angle;
            power += part;
            toward += part.element_sum() * own_frame.texel_direction(x, y, Vec2::splat(0.5));
        }
        Some(Source { direction: toward.try_normalize()?, power })
    }
}
