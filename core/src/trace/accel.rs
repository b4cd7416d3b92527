//! The triangles of a scene, ready for rays.

use std::sync::Arc;

use glam::{Affine3A, Vec2, Vec3};

use super::{Hit, Ray};
use crate::scene::{Mesh, Scene};

/// The visible instances of a scene.
#[derive(Clone, Debug, Default)]
pub struct Accel {
    instances: Vec<(u32, Affine3A, Arc<Mesh>)>,
}

impl Accel {
    /// All visible instances.
    pub fn new(scene: &Scene) -> Accel {
        let visible = scene.instances.iter().enumerate().filter(|(_, i)| i.visible);
        Accel {
            instances: visible
                .map(|(index, i)| (index as u32, i.world_from_local, scene.meshes[i.mesh].clone()))
                .collect(),
        }
    }

    /// The same for another scene; what is unchanged is shared.
    pub fn updated(&self, scene: &Scene) -> Accel {
        Accel::new(scene)
    }

    /// The nearest hit that `accept` takes.
    pub fn closest(&self, ray: &Ray, accept: impl Fn(&Hit) -> bool) -> Option<Hit> {
        let mut best: Option<Hit> = None;
        for (instance, world_from_local, mesh) in &self.instances {
            for triangle in 0..mesh.indices.len() as u32 / 3 {
                let corners = [0, 1, 2].map(|c| {
                    world_from_local.transform_point3(mesh.positions[mesh.indices[3 * triangle as usize + c] as usize])
                });
                let limit = best.map_or(ray.t_max, |hit| hit.t);
                if let Some((t, barycentric)) = meet(ray, corners).filter(|(t, _)| *t >= 0.0 && *t < limit) {
                    let hit = Hit { t, instance: *instance, triangle, barycentric };
                    if accept(&hit) {
                        best = Some(hit);
                    }
                }
            }
        }
        best
    }

    /// True when some hit is accepted.
    pub fn occluded(&self, ray: &Ray, accept: impl Fn(&Hit) -> bool) -> bool {
        self.closest(ray, accept).is_some()
    }
}

fn meet(ray: &Ray, [a, b, c]: [Vec3; 3]) -> Option<(f32, Vec2)> {
    let (ab, ac) = (b - a, c - a);
    let p = ray.direction.cross(ac);
    let determinant = ab.dot(p);
    let from_a = ray.origin - a;
    let q = from_a.cross(ab);
    let (u, v, t) = (from_a.dot(p) / determinant, ray.direction.dot(q) / determinant, ac.dot(q) / determinant);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then_some((t, Vec2::new(u, v)))
}
