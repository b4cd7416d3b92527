//! What lies under a point of a picture: a ray from the camera against every triangle.

use glam::{Vec2, Vec3};

use super::{Camera, Instance, Mesh, Projection, Scene};

/// A half line in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts: on the near plane of the camera.
    pub origin: Vec3,
    /// Unit direction.
    pub direction: Vec3,
}

/// A point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picked {
    /// Index into [`Scene::instances`].
    pub instance: usize,
    /// World position in metres.
    pub position: Vec3,
    /// Normal between those of the corners, world, unit, on the side of the ray; normal maps are not looked up.
    pub normal: Vec3,
}

impl Camera {
    /// The ray through a point of the picture, 0 to 1 from its top left; `aspect` is width by height.
    pub fn ray(&self, at: Vec2, aspect: f32) -> Ray {
        let ndc = (2.0 * at - 1.0) * Vec2::new(aspect, -1.0);
        let (origin, direction) = match self.projection {
            Projection::Perspective { yfov, near } => {
                let direction = (ndc * (0.5 * yfov).tan()).extend(-1.0);
                (near * direction, direction)
            }
            Projection::Orthographic { ymag, near, .. } => ((ndc * ymag).extend(-near), Vec3::NEG_Z),
        };
        let world = &self.world_from_view;
        Ray {
            origin: world.transform_point3(origin),
            direction: world.transform_vector3(direction).normalize_or_zero(),
        }
    }
}

impl Scene {
    /// The nearest point that a ray meets on a visible instance, from the sides that are drawn. Opacity is not looked
    /// up: holes of masked materials and clear panes count as surface.
    pub fn pick(&self, ray: Ray) -> Option<Picked> {
        let mut nearest: Option<(Met, usize)> = None;
        for (index, instance) in self.instances.iter().enumerate().filter(|(_, i)| i.visible) {
            let limit = nearest.map_or(f32::INFINITY, |(met, _)| met.t);
            let (Some(mesh), Some(material)) = (self.meshes.get(instance.mesh), self.materials.get(instance.material))
            else {
                continue;
            };
            if let Some(met) = meet(mesh, instance, material.double_sided, ray, limit) {
                nearest = Some((met, index));
            }
        }
        nearest.map(|(met, instance)| {
            let position = ray.origin + met.t * ray.direction;
            Picked { instance, position, normal: self.normal_at(instance, met, ray.direction) }
        })
    }
}

/// Where a ray meets a triangle.
#[derive(Clone, Copy)]
struct Met {
    /// In units of the ray's direction.
    t: f32,
    /// Shares of the second and third corner.
    at: Vec2,
    triangle: usize,
}

impl Scene {
    /// The unit normal of an instance where a ray met it, on the ray's side.
    fn normal_at(&self, instance: usize, met: Met, direction: Vec3) -> Vec3 {
        let of = || {
            let instance = self.instances.get(instance)?;
            let mesh = self.meshes.get(instance.mesh)?;
            let corners = mesh.indices.get(3 * met.triangle..3 * met.triangle + 3)?;
            let normal = |corner: usize| mesh.normals.get(corners[corner] as usize).copied();
            let (a, b, c) = (normal(0)?, normal(1)?, normal(2)?);
            let local = (1.0 - met.at.x - met.at.y) * a + met.at.x * b + met.at.y * c;
            (instance.world_from_local.matrix3.inverse().transpose() * local).try_normalize()
        };
        let normal = of().unwrap_or(-direction);
        if normal.dot(direction) > 0.0 { -normal } else { normal }
    }
}

/// The nearest triangle on the ray before `limit`.
fn meet(mesh: &Mesh, instance: &Instance, double_sided: bool, ray: Ray, limit: f32) -> Option<Met> {
    // An affine map keeps ratios along a line: the distance is the same in both spaces.
    let local_from_world = instance.world_from_local.inverse();
    let origin = local_from_world.transform_point3(ray.origin);
    let direction = local_from_world.transform_vector3(ray.direction);
    let mut nearest: Option<Met> = None;
    let (triangles, _) = mesh.indices.as_chunks::<3>();
    for (triangle, corners) in triangles.iter().enumerate() {
        let [a, b, c] = corners.map(|i| mesh.positions.get(i as usize).copied().unwrap_or(Vec3::NAN));
        let hit = meet_triangle(origin, direction, [a, b, c], double_sided);
        if let Some((t, at)) = hit.filter(|(t, _)| *t < nearest.map_or(limit, |met| met.t)) {
            nearest = Some(Met { t, at, triangle });
        }
    }
    nearest
}

/// Moeller and Trumbore 1997, Fast, minimum storage ray-triangle intersection. In local space the front stays the
/// counter-clockwise side, also of a mirrored instance.
fn meet_triangle(origin: Vec3, direction: Vec3, [a, b, c]: [Vec3; 3], double_sided: bool) -> Option<(f32, Vec2)> {
    let (ab, ac) = (b - a, c - a);
    let p = direction.cross(ac);
    let determinant = ab.dot(p);
    // Positive from the front. A NaN or a ray in the plane meets nothing.
    if !(determinant > 0.0 || (double_sided && determinant < 0.0)) {
        return None;
    }
    let from_a = origin - a;
    let u = from_a.dot(p) / determinant;
    let q = from_a.cross(ab);
    let v = direction.dot(q) / determinant;
    let t = ac.dot(q) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0).then_some((t, Vec2::new(u, v)))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::Affine3A;

    use super::*;
    use crate::material::Material;
    use crate::scene::gallery::shape;

    /// Balls of radius 0.5 along -z; `stretched` scales the first.
    fn balls(stretched: Vec3) -> Scene {
        let place = |z: f32, scale: Vec3| Instance {
            name: "ball".into(),
            mesh: 0,
            material: 0,
            world_from_local: Affine3A::from_translation(Vec3::new(0.0, 0.0, z)) * Affine3A::from_scale(scale),
            visible: true,
        };
        Scene {
            meshes: vec![Arc::new(shape::sphere(0.5, 96))],
            materials: vec![Material::default()],
            instances: vec![place(0.0, stretched), place(-3.0, Vec3::ONE)],
            ..Scene::default()
        }
    }

    fn camera() -> Camera {
        Camera::look_at("test", Vec3::new(0.0, 0.0, 4.0), Vec3::ZERO, 0.6)
    }

    #[test]
    fn the_nearest_visible_surface_is_picked() {
        let mut scene = balls(Vec3::ONE);
        let ray = camera().ray(Vec2::splat(0.5), 1.5);
        let picked = scene.pick(ray).expect("a ball is in the middle");
        assert_eq!(picked.instance, 0);
        assert!((picked.position - Vec3::new(0.0, 0.0, 0.5)).length() < 2e-3, "{picked:?}");
        let beside = scene.pick(camera().ray(Vec2::new(0.55, 0.4), 1.0)).expect("it is still on the ball");
        assert!(beside.normal.angle_between(beside.position) < 2e-3, "{beside:?}");
        scene.instances[0].visible = false;
        let picked = scene.pick(ray).expect("another is behind");
        assert_eq!(picked.instance, 1);
        assert!((picked.position - Vec3::new(0.0, 0.0, -2.5)).length() < 2e-3, "{picked:?}");
        assert_eq!(scene.pick(camera().ray(Vec2::ZERO, 1.5)), None);
    }

    #[test]
    fn stretched_and_mirrored_instances_are_met_where_they_are() {
        for scale in [Vec3::new(1.0, 1.0, 3.0), Vec3::new(-1.0, 1.0, 3.0)] {
            let picked = balls(scale).pick(camera().ray(Vec2::splat(0.5), 1.0)).expect("a ball is in the middle");
            assert!((picked.position.z - 1.5).abs() < 1e-2, "{picked:?}");
        }
    }

    #[test]
    fn backs_are_seen_of_two_sided_materials_only() {
        let mut scene = balls(Vec3::ONE);
        let inside = Ray { origin: Vec3::ZERO, direction: Vec3::Z };
        assert_eq!(scene.pick(inside), None);
        scene.materials[0].double_sided = true;
        assert_eq!(scene.pick(inside).map(|p| p.instance), Some(0));
    }

    #[test]
    fn rays_go_through_the_point_of_the_picture() {
        let perspective = camera();
        let orthographic =
            Camera { projection: Projection::Orthographic { ymag: 1.0, near: 0.1, far: 9.0 }, ..camera() };
        // The upper right quarter: x to the right, y up.
        let at = Vec2::new(0.75, 0.25);
        let ray = perspective.ray(at, 2.0);
        let slope = 0.3_f32.tan();
        assert!((ray.direction / -ray.direction.z - Vec3::new(slope, 0.5 * slope, -1.0)).length() < 1e-5, "{ray:?}");
        let ray = orthographic.ray(at, 2.0);
        assert!((ray.origin - Vec3::new(1.0, 0.5, 3.9)).length() < 1e-5 && ray.direction == Vec3::NEG_Z, "{ray:?}");
    }
}
