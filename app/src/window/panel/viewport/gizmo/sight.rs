//! The camera and the place of its picture in the window: from the world to points and back.

use burnish_core::scene::{Camera, Projection, Ray};
use eframe::egui::{Pos2, Rect, Vec2, vec2};
use glam::Vec3;

/// A camera whose picture fills a rectangle of the window.
#[derive(Clone, Debug)]
pub struct Sight {
    /// From where.
    pub camera: Camera,
    /// Where in the window, in points.
    pub rect: Rect,
}

impl Sight {
    /// Where a world position is seen; `None` behind the camera.
    pub fn project(&self, world: Vec3) -> Option<Pos2> {
        let view = self.camera.world_from_view.inverse().transform_point3(world);
        let place = self.rect.center() + vec2(view.x, -view.y) / self.metres_at(view.z)?;
        place.is_finite().then_some(place)
    }

    /// Where on the edge of a part of the picture something lies that is not in the picture, and the unit direction toward
    /// it; `None` for what is in the picture.
    pub fn beyond(&self, world: Vec3, inner: Rect) -> Option<(Pos2, Vec2)> {
        if self.project(world).is_some_and(|place| self.rect.contains(place)) {
            return None;
        }
        let view = self.camera.world_from_view.inverse().transform_point3(world);
        let toward = vec2(view.x, -view.y);
        // Straight behind the camera any way is as far: below, where one would look for it last.
        let toward = if toward.length() > 1e-6 { toward.normalized() } else { vec2(0.0, 1.0) };
        let half = (0.5 * inner.size()).max(Vec2::ZERO);
        let reach = (half.x / toward.x.abs().max(1e-6)).min(half.y / toward.y.abs().max(1e-6));
        Some((inner.center() + reach * toward, toward))
    }

    /// Metres that a point of the window covers at a world position; `None` behind the camera.
    pub fn metres_per_point(&self, world: Vec3) -> Option<f32> {
        self.metres_at(self.camera.world_from_view.inverse().transform_point3(world).z)
    }

    fn metres_at(&self, view_z: f32) -> Option<f32> {
        let half_height = match self.camera.projection {
            Projection::Perspective { yfov, near } if -view_z > near => -view_z * (0.5 * yfov).tan(),
            Projection::Perspective { .. } => return None,
            Projection::Orthographic { ymag, .. } => ymag,
        };
        Some(2.0 * half_height / self.rect.height().max(1.0))
    }

    /// The half line through a point of the window.
    pub fn ray(&self, at: Pos2) -> Ray {
        let size = self.rect.size().max(Vec2::splat(1.0));
        let at = (at - self.rect.min) / size;
        self.camera.ray(glam::Vec2::new(at.x, at.y), size.x / size.y)
    }

    /// Unit direction from a world position to the eye.
    pub fn toward_eye(&self, world: Vec3) -> Vec3 {
        let placed = &self.camera.world_from_view;
        let eye = Vec3::from(placed.translation);
        let back = Vec3::from(placed.matrix3.z_axis);
        match self.camera.projection {
            Projection::Perspective { .. } => (eye - world).normalize_or(back),
            Projection::Orthographic { .. } => back,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use burnish_core::scene::Camera;
    use eframe::egui::pos2;

    #[test]
    fn rays_lead_back_to_what_is_seen() {
        let perspective = Camera::look_at("c", Vec3::new(2.0, 3.0, 6.0), Vec3::new(0.0, 0.5, 0.0), 0.6);
        let parallel =
            Camera { projection: Projection::Orthographic { ymag: 2.0, near: 0.1, far: 50.0 }, ..perspective.clone() };
        for camera in [perspective, parallel] {
            let sight = Sight { camera, rect: Rect::from_min_max(pos2(100.0, 40.0), pos2(740.0, 400.0)) };
            for world in [Vec3::ZERO, Vec3::new(0.4, 1.0, -0.7), Vec3::new(-1.0, 0.2, 1.0)] {
                let ray = sight.ray(sight.project(world).unwrap());
                let off = (world - ray.origin).cross(ray.direction).length();
                assert!(off < 1e-4, "{off}");
                // A step of one point across the picture.
                let right = Vec3::from(sight.camera.world_from_view.matrix3.x_axis);
                let step = sight.metres_per_point(world).unwrap();
                let moved = sight.project(world + right * step).unwrap() - sight.project(world).unwrap();
                assert!((moved.length() - 1.0).abs() < 1e-2, "{moved:?}");
            }
            let inner = sight.rect.shrink(10.0);
            for (view, toward) in
                [(Vec3::new(-90.0, 0.0, -2.0), vec2(-1.0, 0.0)), (Vec3::new(0.0, 5.0, 900.0), vec2(0.0, -1.0))]
            {
                let world = sight.camera.world_from_view.transform_point3(view);
                if let Some((place, found)) = sight.beyond(world, inner) {
                    assert!((found - toward).length() < 1e-3, "{found:?} {toward:?}");
                    assert!(inner.expand(0.1).contains(place), "{place:?}");
                } else {
                    panic!("{view} is not in the picture");
                }
            }
            assert!(sight.beyond(Vec3::new(0.0, 0.5, 0.0), inner).is_none());
            let behind = sight.camera.world_from_view.transform_point3(Vec3::new(0.0, 0.0, 5.0));
            let is_parallel = matches!(sight.camera.projection, Projection::Orthographic { .. });
            assert_eq!(sight.project(behind).is_some(), is_parallel);
        }
    }
}
