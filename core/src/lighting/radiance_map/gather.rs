//! Light along a ray, from a map that was baked before: where the ray ends a surface reflects what that knows.

use glam::{UVec2, Vec3};

use super::map::Map;
use super::rays::MOST_MIRRORS;
use crate::reference::{Apart, Eye, World};

/// Width of the lobe below which a surface sends the ray on: cells are wider than what it reflects.
const BELOW: f32 = 0.06;

/// As [`World::along_apart`].
pub(super) fn along(world: &World, map: &Map<'_>, origin: Vec3, direction: Vec3, pixel: UVec2, index: u32) -> Apart {
    let mut apart = Apart { by_source: [Vec3::ZERO; 3], escaped: false, from_behind: false, rays: 0 };
    let eye = Eye::along(world, origin, direction, pixel, index);
    found(map, eye, direction, Vec3::ONE, 0, &mut apart);
    apart
}

/// Adds what is found at the end of a ray, times `weight`.
fn found(map: &Map<'_>, mut eye: Eye<'_>, direction: Vec3, weight: Vec3, mirrors: u32, apart: &mut Apart) {
    apart.rays += 1;
    let [of_surface, of_lamps] = [eye.random(), eye.random()];
    let Some(point) = eye.point() else {
        apart.escaped = mirrors == 0;
        apart.by_source[0] += weight * eye.sky(direction);
        return;
    };
    if point.is_behind() {
        apart.from_behind = mirrors == 0;
        return;
    }
    apart.by_source[2] += weight * point.emission();
    let (lamps, cast) = point.lamps(of_lamps);
    apart.by_source[1] += weight * lamps;
    apart.rays += cast;
    let [x, y, z, w] = of_surface;
    let Some(drawn) = point.reflecting().drawn(Vec3::new(x, y, z)) else { return };
    let weight = weight * drawn.weight;
    let surface = point.surface();
    let is_smooth = (surface.alpha.x * surface.alpha.y).sqrt() < BELOW || !drawn.pdf.is_finite();
    if is_smooth && mirrors < MOST_MIRRORS {
        found(map, point.toward(drawn.direction, w.to_bits()), drawn.direction, weight, mirrors + 1, apart);
        return;
    }
    for (sum, known) in apart.by_source.iter_mut().zip(map.apart(point.position(), point.normal(), drawn.direction)) {
        *sum += weight * known;
    }
}
