//! Triangles that glow, drawn by their power.

use std::collections::HashMap;

use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};

use super::texture::{Coordinates, lookup, mean};
use crate::material::AlphaMode;
use crate::scene::Scene;
use crate::trace::rounding;

/// A triangle that glows.
#[derive(Clone, Copy, Debug)]
struct Emitter {
    /// Corners in the world.
    corners: [Vec3; 3],
    /// Indices of the same corners in the mesh.
    indices: [u32; 3],
    /// Unit normal of the side that glows.
    normal: Vec3,
    instance: u32,
    both_sides: bool,
    /// Density per area with which its points are drawn, per square metre.
    density: f32,
}

/// A point of a glowing triangle, seen from somewhere.
#[derive(Clone, Copy, Debug)]
pub(super) struct EmitterSample {
    /// World.
    pub point: Vec3,
    /// How far rounding may have moved it, see [`rounding`].
    pub rounding: Vec3,
    /// Normal of the triangle there, unit.
    pub normal: Vec3,
    /// Toward the eye.
    pub radiance: Vec3,
    /// Per steradian.
    pub pdf: f32,
}

/// All of them, with the shares by which they are drawn.
#[derive(Clone, Debug, Default)]
pub(super) struct Emitters {
    list: Vec<Emitter>,
    /// Share of the power before each, from 0 to 1; one more than there are triangles.
    shares: Vec<f64>,
    /// For each instance that glows, the place in the list of each triangle of its mesh, or [`NONE`].
    places: HashMap<u32, Vec<u32>>,
    /// Power over pi: the sum of area times mean radiance, of both sides where both glow.
    power: f32,
    /// Middle of the power, and how far it spreads about it, in metres.
    center: Vec3,
    spread: f32,
}

/// Marks a triangle that has no place in the list.
const NONE: u32 = u32::MAX;

impl Emitters {
    /// Memory of its lists.
    pub(super) fn bytes(&self) -> usize {
        let places: usize = self.places.values().map(|list| size_of_val(&list[..])).sum();
        size_of_val(&self.list[..]) + size_of_val(&self.shares[..]) + places
    }

    /// Those of the visible instances.
    pub(super) fn new(scene: &Scene) -> Emitters {
        let mut emitters = Emitters { shares: vec![0.0], ..Emitters::default() };
        let mut powers = Vec::new();
        for (index, instance) in scene.instances.iter().enumerate().filter(|(_, i)| i.visible) {
            let m = &scene.materials[instance.material];
            // What lies under a coat or is cut out is left for paths to find by themselves.
            let plain = m.coat <= 0.0 && m.alpha_mode == AlphaMode::Opaque;
            if m.unlit || m.emission.max_element() <= 0.0 || !plain {
                continue;
            }
            let radiance = (m.emission * mean(scene, m.emission_texture)).element_sum() / 3.0;
            // A texture may be black where it was looked at and glow elsewhere.
            let radiance = radiance.max(1e-3 * m.emission.max_element());
            let sides = if m.double_sided { 2.0 } else { 1.0 };
            emitters.add(scene, index, sides * radiance, &mut powers);
        }
        emitters.share_out(&powers);
        emitters
    }

    /// Appends the triangles of an instance of that radiance, sum of both sides where both glow, and their powers.
    fn add(&mut self, scene: &Scene, index: usize, radiance: f32, powers: &mut Vec<f64>) {
        let instance = &scene.instances[index];
        let mesh = &scene.meshes[instance.mesh];
        let both_sides = scene.materials[instance.material].double_sided;
        let side = if instance.world_from_local.matrix3.determinant() < 0.0 { -1.0 } else { 1.0 };
        let mut places = Vec::with_capacity(mesh.indices.len() / 3);
        let (triangles, _) = mesh.indices.as_chunks::<3>();
        for indices in triangles {
            let corners = indices.map(|i| instance.world_from_local.transform_point3(mesh.positions[i as usize]));
            let cross = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            let area = 0.5 * cross.length();
            if !(area > 0.0 && area.is_finite()) {
                places.push(NONE);
                continue;
            }
            places.push(self.list.len() as u32);
            powers.push(f64::from(area * radiance));
            self.list.push(Emitter {
                corners,
                indices: *indices,
                normal: side * cross.normalize(),
                instance: index as u32,
                both_sides,
                density: 1.0 / area,
            });
        }
        self.places.insert(index as u32, places);
    }

    /// Shares, densities and the middle of it all.
    fn share_out(&mut self, powers: &[f64]) {
        let total: f64 = powers.iter().sum();
        let (mut sum, mut first, mut second) = (0.0, glam::DVec3::ZERO, 0.0);
        for (emitter, power) in self.list.iter_mut().zip(powers) {
            sum += power;
            self.shares.push(sum / total);
            emitter.density *= (power / total) as f32;
            let middle = (emitter.corners.iter().sum::<Vec3>() / 3.0).as_dvec3();
            first += middle * (power / total);
            second += middle.length_squared() * (power / total);
        }
        self.power = total as f32;
        self.center = first.as_vec3();
        self.spread = (second - first.length_squared()).max(0.0).sqrt() as f32;
    }

    /// True when nothing glows.
    pub(super) fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// About the irradiance at a point, for choosing among kinds of light.
    pub(super) fn weight(&self, position: Vec3) -> f32 {
        let near = 0.25 * self.spread * self.spread;
        self.power / (self.center - position).length_squared().max(near).max(1e-12)
    }

    /// A point that may shine on `position`; `u` in `[0, 1)^3`. `None` where it shows its dark side.
    pub(super) fn sample(&self, scene: &Scene, position: Vec3, u: Vec3) -> Option<EmitterSample> {
        let x = f64::from(u.x);
        let place = self.shares.partition_point(|share| *share <= x).clamp(1, self.list.len().max(1)) - 1;
        let emitter = self.list.get(place)?;
        let weights = barycentric(Vec2::new(u.y, u.z));
        let [a, b, c] = emitter.corners;
        let point = a * weights.x + b * weights.y + c * weights.z;
        let pdf = emitter.pdf(position, point)?;
        let radiance = emitter.radiance(scene, weights);
        let instance = &scene.instances[emitter.instance as usize];
        let positions = &scene.meshes[instance.mesh].positions;
        let rounding = rounding(&instance.world_from_local, emitter.indices.map(|i| positions[i as usize]));
        Some(EmitterSample { point, rounding, normal: emitter.normal, radiance, pdf })
    }

    /// Density per steradian with which [`Emitters::sample`] at `position` draws this point of a triangle; 0 where it never
    /// does.
    pub(super) fn pdf(&self, position: Vec3, instance: u32, triangle: u32, point: Vec3) -> f32 {
        let place = self.places.get(&instance).and_then(|places| places.get(triangle as usize)).copied();
        let emitter = place.and_then(|place| self.list.get(place as usize));
        emitter.and_then(|emitter| emitter.pdf(position, point)).unwrap_or(0.0)
    }
}

impl Emitter {
    fn pdf(&self, position: Vec3, point: Vec3) -> Option<f32> {
        let toward = position - point;
        let squared = toward.length_squared();
        let facing = self.normal.dot(toward) / squared.sqrt();
        let facing = if self.both_sides { facing.abs() } else { facing };
        let pdf = self.density * squared / facing;
        (facing > 0.0 && pdf > 0.0 && pdf.is_finite()).then_some(pdf)
    }

    fn radiance(&self, scene: &Scene, weights: Vec3) -> Vec3 {
        let instance = &scene.instances[self.instance as usize];
        let (material, mesh) = (&scene.materials[instance.material], &scene.meshes[instance.mesh]);
        let corners = self.indices.map(|i| i as usize);
        if material.emission_texture.is_none() {
            return material.emission;
        }
        let at = Coordinates::new(mesh, corners, weights);
        let texel = lookup(scene, material.emission_texture, &at, true).unwrap_or(Vec4::ONE);
        material.emission * texel.xyz()
    }
}

/// Weights of the corners of an even point of a triangle.
fn barycentric(u: Vec2) -> Vec3 {
    // Heitz 2019, A Low-Distortion Map Between Triangle and Square.
    let (mut b, mut c) = (u.x, u.y);
    if c > b {
        b *= 0.5;
        c -= b;
    } else {
        c *= 0.5;
        b -= c;
    }
    Vec3::new(1.0 - b - c, b, c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::sampling::Random;

    #[test]
    fn points_of_a_triangle_are_even() {
        let mut random = Random::new(4);
        let sum: Vec3 = (0..100_000).map(|_| barycentric(random.point2())).sum();
        assert!((sum / 1e5 - Vec3::splat(1.0 / 3.0)).abs().max_element() < 3e-3, "{sum}");
        for _ in 0..1000 {
            let w = barycentric(random.point2());
            assert!(w.min_element() >= -1e-7 && (w.element_sum() - 1.0).abs() < 1e-6);
        }
    }
}
