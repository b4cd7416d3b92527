//! Places on surfaces, spread by area.

use glam::{Mat3A, Vec2, Vec3};

use crate::scene::{Instance, Mesh, Scene};
use crate::trace::{offset, rounding};

/// A place of which light is kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// World, metres.
    pub position: Vec3,
    /// Interpolated between the corners, on the lit side, unit, world.
    pub normal: Vec3,
    /// Of the triangle, on the same side.
    pub geometric: Vec3,
    /// How far rounding may have moved it.
    rounding: Vec3,
}

impl Place {
    /// Where a ray starts that leaves in a direction.
    pub fn origin(&self, direction: Vec3) -> Vec3 {
        offset(self.position, self.rounding, self.geometric, direction)
    }
}

/// Triangles with their areas.
pub struct Surfaces<'a> {
    scene: &'a Scene,
    /// Instance and triangle.
    list: Vec<(u32, u32)>,
    /// Areas summed up, square metres.
    sums: Vec<f64>,
}

impl<'a> Surfaces<'a> {
    /// Those of visible instances.
    pub fn new(scene: &'a Scene) -> Surfaces<'a> {
        let (mut list, mut sums, mut sum) = (Vec::new(), Vec::new(), 0.0);
        for (i, instance) in scene.instances.iter().enumerate().filter(|(_, instance)| instance.visible) {
            let mesh = &scene.meshes[instance.mesh];
            for triangle in 0..mesh.indices.len() / 3 {
                let [a, b, c] = corners(mesh, triangle).map(|corner| world(instance, mesh.positions[corner]));
                let area = 0.5 * f64::from((b - a).cross(c - a).length());
                if area > 0.0 && area.is_finite() {
                    sum += area;
                    list.push((i as u32, triangle as u32));
                    sums.push(sum);
                }
            }
        }
        Surfaces { scene, list, sums }
    }

    /// Of all, square metres.
    pub fn area(&self) -> f64 {
        self.sums.last().copied().unwrap_or(0.0)
    }

    /// Place number `index` of `count`: each stands for as much area. `None` where there is no surface. Places of surfaces that are seen from both
    /// sides lie on either, in turn.
    pub fn place(&self, index: u32, count: u32) -> Option<Place> {
        // Steps of the plastic number, in integers so that no digit is lost.
        let [r1, r2] = [3_242_174_889u32, 2_447_445_414].map(|step| index.wrapping_mul(step) >> 8);
        let u = Vec2::new(r1 as f32, r2 as f32) / 16_777_216.0;
        let shift = f64::from((index.wrapping_mul(2_654_435_769) >> 8) as f32 / 16_777_216.0);
        let wanted = (f64::from(index) + shift) / f64::from(count.max(1)) * self.area();
        self.at(wanted, u, index % 2 == 1)
    }

    /// A place by numbers in `[0, 1)^3`, even by area; `back` is the side of surfaces that have two.
    pub(super) fn drawn(&self, u: Vec3, back: bool) -> Option<Place> {
        self.at(f64::from(u.z) * self.area(), u.truncate(), back)
    }

    /// Where so many square metres lie before it, at `u` in its triangle.
    fn at(&self, wanted: f64, u: Vec2, back: bool) -> Option<Place> {
        let at = self.sums.partition_point(|sum| *sum <= wanted).min(self.list.len().checked_sub(1)?);
        let (instance, triangle) = self.list[at];
        let instance = &self.scene.instances[instance as usize];
        let mesh = &self.scene.meshes[instance.mesh];
        let ids = corners(mesh, triangle as usize);
        let local = ids.map(|corner| mesh.positions[corner]);
        let [a, b, c] = local.map(|position| world(instance, position));
        let root = u.x.sqrt();
        let weights = Vec3::new(1.0 - root, root * (1.0 - u.y), root * u.y);
        let mirrored = instance.world_from_local.matrix3.determinant() < 0.0;
        let turned = if mirrored { -1.0 } else { 1.0 };
        let geometric = turned * (b - a).cross(c - a).normalize_or_zero();
        let of_local: Mat3A = instance.world_from_local.matrix3.inverse().transpose();
        let mean = (0..3).map(|i| weights[i] * mesh.normals.get(ids[i]).copied().unwrap_or(Vec3::ZERO)).sum::<Vec3>();
        let normal = (of_local * mean).normalize_or(geometric);
        let normal = if normal.dot(geometric) < 0.0 { geometric } else { normal };
        let is_back = back && self.scene.materials[instance.material].double_sided;
        let side = if is_back { -1.0 } else { 1.0 };
        (geometric != Vec3::ZERO).then(|| Place {
            position: weights.x * a + weights.y * b + weights.z * c,
            normal: side * normal,
            geometric: side * geometric,
            rounding: rounding(&instance.world_from_local, local),
        })
    }
}

fn corners(mesh: &Mesh, triangle: usize) -> [usize; 3] {
    [0, 1, 2].map(|i| mesh.indices[3 * triangle + i] as usize)
}

fn world(instance: &Instance, position: Vec3) -> Vec3 {
    instance.world_from_local.transform_point3(position)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::{Options, World};
    use crate::scene::gallery;
    use std::sync::Arc;

    #[test]
    fn every_surface_gets_places_by_its_area_and_they_lie_on_it() {
        for name in ["room", "workbench"] {
            let scene = gallery::open(name).unwrap();
            let surfaces = Surfaces::new(&scene);
            const COUNT: u32 = 4000;
            let places: Vec<Place> = (0..COUNT).map(|i| surfaces.place(i, COUNT).unwrap()).collect();
            // Half of the places are in the half of the triangles with half of the area.
            let half = surfaces.sums.partition_point(|sum| *sum < 0.5 * surfaces.area());
            let (instance, triangle) = surfaces.list[half];
            let first = places.iter().enumerate().filter(|(i, _)| 2 * (*i as u32) < COUNT).count();
            assert!(first == 2000 && (instance as usize) < scene.instances.len() && triangle < u32::MAX);
            let world = World::new(&Arc::new(scene), Options::default());
            let mut beside = 0;
            for place in &places {
                assert!((place.normal.length() - 1.0).abs() < 1e-4 && place.normal.dot(place.geometric) >= 0.0);
                // From a little before it, looking back, the surface is there.
                let back = world.sighted(place.position + 1e-4 * place.geometric, -place.geometric).unwrap();
                beside += usize::from((back.distance - 1e-4).abs() > 1e-5);
            }
            // But where one goes through another.
            assert!(beside < 20, "{name}: {beside} of 4000");
        }
    }

    #[test]
    fn nothing_has_no_places() {
        assert_eq!(Surfaces::new(&Scene::default()).place(0, 10), None);
    }
}
