//! What the processor finds out about an environment before the device builds its cubes. Needs no device.

use burnish_core::lighting::classical::{self, CubeSizes, Source, Split};
use burnish_core::math::cube;
use burnish_core::scene::Environment;
use glam::{Vec2, Vec3};

use super::TILE;

/// Everything that the steps on the device need to know.
pub(super) struct Plan {
    pub environment: Environment,
    pub sizes: CubeSizes,
    /// Factor from a texel of a cube to radiance.
    pub scale: f32,
    /// Width from which blocks are points to a lobe.
    pub wide_alpha: f32,
    /// Without the blocks that shading adds one by one.
    pub shading: Dimmed,
    /// Without the texels that prefiltering adds one by one.
    pub prefilter: Dimmed,
}

/// How the map without its brightest blocks differs from the map.
pub(super) struct Dimmed {
    pub sources: Vec<Source>,
    pub patches: Vec<Patch>,
    /// Per level of a cube of radiance: the tiles that see a patch.
    pub tiles: Vec<Vec<u32>>,
}

/// A rectangle of texels of the map that is darker.
pub(super) struct Patch {
    pub x: u32,
    pub y: u32,
    pub width: u32,
    pub height: u32,
    pub texels: Vec<[f32; 4]>,
}

impl Plan {
    /// For the best cubes that the map is worth.
    pub fn new(environment: &Environment) -> Plan {
        Plan::with_sizes(environment, CubeSizes::full(environment.width))
    }

    /// For cubes that are made in a moment from a map as [`super::downsampled`] makes it.
    pub fn coarse(environment: &Environment) -> Plan {
        Plan::with_sizes(environment, CubeSizes::coarse(environment.width))
    }

    fn with_sizes(environment: &Environment, sizes: CubeSizes) -> Plan {
        let block = classical::shading_block(environment.width);
        let dimmed = |block, count| {
            let Split { dimmed, sources } = classical::split(environment, block, count);
            let patches = patches(environment, &dimmed, block);
            let tiles = tiles(environment, &patches, sizes.radiance);
            Dimmed { sources, patches, tiles }
        };
        Plan {
            sizes,
            scale: classical::cube_scale(environment),
            wide_alpha: classical::wide_alpha(environment.width, block),
            shading: dimmed(block, classical::SHADING_SOURCES),
            prefilter: dimmed(1, classical::PREFILTER_SOURCES),
            environment: environment.clone(),
        }
    }
}

/// A row of texels as the device stores them.
pub(super) fn padded(texels: &[Vec3]) -> impl Iterator<Item = [f32; 4]> + '_ {
    texels.iter().map(|c| [c.x, c.y, c.z, 1.0])
}

/// The blocks in which the maps differ.
fn patches(map: &Environment, dimmed: &Environment, block: u32) -> Vec<Patch> {
    let row = |y: u32, x: u32, width: u32| {
        let start = y as usize * map.width as usize + x as usize;
        start..start + width as usize
    };
    let mut patches = Vec::new();
    for y in (0..map.height).step_by(block as usize) {
        let height = block.min(map.height - y);
        let lines = row(y, 0, map.width).start..row(y + height - 1, 0, map.width).end;
        if map.texels[lines.clone()] == dimmed.texels[lines] {
            continue;
        }
        for x in (0..map.width).step_by(block as usize) {
            let width = block.min(map.width - x);
            let rows = || (y..y + height).map(|y| row(y, x, width));
            if rows().any(|row| map.texels[row.clone()] != dimmed.texels[row]) {
                let texels = rows().flat_map(|row| padded(&dimmed.texels[row])).collect();
                patches.push(Patch { x, y, width, height, texels });
            }
        }
    }
    patches
}

/// Unit directions no further than `chord` from `center`.
struct Cone {
    center: Vec3,
    chord: f32,
}

/// Far more than the rounding errors of directions, less than a tenth of a texel.
const MARGIN: f32 = 1e-4;

impl Cone {
    /// Where a bilinear lookup reads the patch.
    fn of_patch(map: &Environment, patch: &Patch) -> Cone {
        let size = Vec2::new(map.width as f32, map.height as f32);
        let corner = Vec2::new(patch.x as f32, patch.y as f32);
        let extent = Vec2::new(patch.width as f32, patch.height as f32);
        let low = (corner - 0.5) / size;
        let high = (corner + extent + 0.5) / size;
        // Rows end at the poles.
        let (low, high) = (Vec2::new(low.x, low.y.max(0.0)), Vec2::new(high.x, high.y.min(1.0)));
        let own_frame = Environment::new("", map.width, map.height, Vec::new());
        // A path over the sphere is no longer than over the plane of its angles.
        let half = 0.5 * (high - low) * Vec2::new(std::f32::consts::TAU, std::f32::consts::PI);
        Cone { center: own_frame.direction_from_uv(0.5 * (low + high)), chord: half.length() + MARGIN }
    }

    /// A square of a face, with corner `low` and that edge.
    fn of_square(face: u32, low: Vec2, edge: f32) -> Cone {
        let direction = |p| cube::direction(face, p) * Vec3::new(1.0, 1.0, -1.0);
        let center = direction(low + 0.5 * edge);
        let corners = [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::ONE].map(|c| direction(low + edge * c).distance(center));
        Cone { center, chord: corners.into_iter().fold(0.0, f32::max) }
    }

    fn touches(&self, other: &Cone) -> bool {
        self.center.distance_squared(other.center) <= (self.chord + other.chord).powi(2)
    }
}

/// Per level of a cube of radiance the tiles with a texel that sees a patch, and those above them.
fn tiles(map: &Environment, patches: &[Patch], face: u32) -> Vec<Vec<u32>> {
    let cones: Vec<Cone> = patches.iter().map(|patch| Cone::of_patch(map, patch)).collect();
    let mut tiles: Vec<Vec<u32>> = vec![Vec::new(); face.ilog2() as usize + 1];
    // The level at which a face is one tile; all above are, too.
    let top = (face / TILE).ilog2() as usize;
    for side in 0..6 {
        for level in &mut tiles[top + 1..] {
            level.push(side);
        }
        descend(&mut tiles, top, side, [0, 0], &cones.iter().collect::<Vec<_>>());
    }
    tiles
}

/// Adds the tile at `at` of a level and those that it covers, where they touch a cone.
fn descend(tiles: &mut [Vec<u32>], level: usize, side: u32, at: [u32; 2], cones: &[&Cone]) {
    let across = 1 << ((tiles.len() - 1 - TILE.ilog2() as usize) - level);
    let edge = 2.0 / across as f32;
    let square = Cone::of_square(side, edge * Vec2::new(at[0] as f32, at[1] as f32) - 1.0, edge);
    let near: Vec<&Cone> = cones.iter().copied().filter(|cone| square.touches(cone)).collect();
    if near.is_empty() {
        return;
    }
    tiles[level].push((side * across + at[1]) * across + at[0]);
    if let Some(finer) = level.checked_sub(1) {
        for [x, y] in [[0, 0], [1, 0], [0, 1], [1, 1]] {
            descend(tiles, finer, side, [2 * at[0] + x, 2 * at[1] + y], &near);
        }
    }
}
