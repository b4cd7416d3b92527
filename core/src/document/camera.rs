//! Points of view as people turn them, and the cameras that they are.

use glam::{Affine3A, DVec3, EulerRot, Mat3, Quat, Vec3};
use serde_json::Map;

use super::CameraEntry;
use crate::scene::{Bounds, Camera, Projection};

/// Height of a full-frame sensor, mm: focal lengths are given for it.
const SENSOR_HEIGHT_MM: f64 = 24.0;
/// Near plane as a part of the distance to the target.
const NEAR: f32 = 1e-3;
/// Depth of an orthographic view on both sides of the target, as a part of the distance.
const ORTHOGRAPHIC_DEPTH: f32 = 100.0;
/// Least distance from the target, metres.
const CLOSEST: f64 = 1e-6;

impl Default for CameraEntry {
    fn default() -> Self {
        CameraEntry::from_camera(&Camera::frame(Bounds::EMPTY, 1.0), Bounds::EMPTY)
    }
}

impl CameraEntry {
    /// The entry of a camera; it turns about the point of its line of sight nearest to the middle of `bounds`.
    pub fn from_camera(camera: &Camera, bounds: Bounds) -> CameraEntry {
        let eye = Vec3::from(camera.world_from_view.translation);
        let rotation = Quat::from_mat3a(&camera.world_from_view.matrix3).normalize();
        let forward = rotation * Vec3::NEG_Z;
        let toward = (bounds.center() - eye).dot(forward);
        let radius = bounds.radius().max(1e-3);
        let distance = if toward.is_finite() && toward > 0.1 * radius { toward } else { 2.0 * radius };
        let (yaw, pitch, roll) = rotation.to_euler(EulerRot::YXZ);
        let (yfov_deg, orthographic) = match camera.projection {
            Projection::Perspective { yfov, .. } => (f64::from(yfov).to_degrees(), false),
            Projection::Orthographic { ymag, .. } => {
                (2.0 * f64::from(ymag).atan2(f64::from(distance)).to_degrees(), true)
            }
        };
        CameraEntry {
            name: camera.name.clone(),
            target: (eye + distance * forward).as_dvec3().to_array(),
            distance: f64::from(distance),
            yaw_deg: f64::from(yaw).to_degrees(),
            pitch_deg: -f64::from(pitch).to_degrees(),
            roll_deg: f64::from(roll).to_degrees(),
            yfov_deg: yfov_deg.clamp(1.0, 170.0),
            orthographic,
            other: Map::new(),
        }
    }

    /// The camera. Numbers out of range are brought into it.
    pub fn camera(&self) -> Camera {
        let finite = |v: f64, otherwise: f64| if v.is_finite() { v } else { otherwise };
        let distance = finite(self.distance, 1.0).max(CLOSEST) as f32;
        let angle = |deg: f64| finite(deg, 0.0).to_radians() as f32;
        let pitch = angle(self.pitch_deg.clamp(-90.0, 90.0));
        let rotation = Quat::from_euler(EulerRot::YXZ, angle(self.yaw_deg), -pitch, angle(self.roll_deg));
        let target = Vec3::from_array(self.target.map(|v| finite(v, 0.0) as f32));
        let eye = target + distance * (rotation * Vec3::Z);
        let yfov = angle(finite(self.yfov_deg, 35.0).clamp(1.0, 170.0));
        let projection = if self.orthographic {
            let (near, far) = (-ORTHOGRAPHIC_DEPTH * distance, ORTHOGRAPHIC_DEPTH * distance);
            Projection::Orthographic { ymag: distance * (0.5 * yfov).tan(), near, far }
        } else {
            Projection::Perspective { yfov, near: NEAR * distance }
        };
        let world_from_view = Affine3A::from_mat3_translation(Mat3::from_quat(rotation), eye);
        Camera { name: self.name.clone(), world_from_view, projection }
    }

    /// The same direction from where all of `bounds` is inside a picture of `aspect` (width by height).
    pub fn framing(&self, bounds: Bounds, aspect: f32) -> CameraEntry {
        let half_y = (0.5 * self.yfov_deg.clamp(1.0, 170.0)).to_radians();
        let half_x = (half_y.tan() * f64::from(aspect.max(1e-3))).atan();
        let radius = f64::from(bounds.radius()).max(1e-4);
        let distance = 1.02 * radius / half_y.min(half_x).sin();
        CameraEntry { target: bounds.center().as_dvec3().to_array(), distance, ..self.clone() }
    }

    /// Focal length for a full-frame sensor (24 mm high), mm.
    pub fn focal_length_mm(&self) -> f64 {
        0.5 * SENSOR_HEIGHT_MM / (0.5 * self.yfov_deg.clamp(1.0, 170.0)).to_radians().tan()
    }

    /// Takes a focal length; the camera stays where it is.
    pub fn set_focal_length_mm(&mut self, focal_length_mm: f64) {
        let yfov = 2.0 * (0.5 * SENSOR_HEIGHT_MM / focal_length_mm.max(1e-3)).atan();
        self.yfov_deg = yfov.to_degrees().clamp(1.0, 170.0);
    }

    /// Turns about the target, degrees.
    pub fn orbit(&mut self, yaw_deg: f64, pitch_deg: f64) {
        self.yaw_deg = (self.yaw_deg + yaw_deg + 180.0).rem_euclid(360.0) - 180.0;
        self.pitch_deg = (self.pitch_deg + pitch_deg).clamp(-90.0, 90.0);
    }

    /// Moves sideways by parts of the picture's height: positive moves the picture right and up.
    pub fn pan(&mut self, right: f64, up: f64) {
        let camera = self.camera();
        let height = 2.0 * self.distance * (0.5 * self.yfov_deg.clamp(1.0, 170.0)).to_radians().tan();
        let m = camera.world_from_view.matrix3;
        let (x, y) = (Vec3::from(m.x_axis).as_dvec3(), Vec3::from(m.y_axis).as_dvec3());
        let target = DVec3::from(self.target) - height * (right * x + up * y);
        self.target = target.to_array();
    }

    /// Multiplies the distance from the target.
    pub fn zoom(&mut self, factor: f64) {
        self.distance = (self.distance * factor).clamp(CLOSEST, 1e12);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: Affine3A, b: Affine3A) -> bool {
        (a.translation - b.translation).length() < 1e-4
            && (a.matrix3 - b.matrix3).to_cols_array().iter().all(|v| v.abs() < 1e-5)
    }

    #[test]
    fn a_camera_goes_through_its_entry_unchanged() {
        let bounds = Bounds { min: Vec3::splat(-1.0), max: Vec3::ONE };
        for eye in [Vec3::new(3.0, 2.0, 5.0), Vec3::new(-4.0, -2.0, 0.1), Vec3::new(0.0, 0.2, -6.0)] {
            let camera = Camera::look_at("c", eye, Vec3::new(0.1, 0.2, 0.0), 0.7);
            let again = CameraEntry::from_camera(&camera, bounds).camera();
            assert!(near(camera.world_from_view, again.world_from_view), "{eye}");
            let (Projection::Perspective { yfov: a, .. }, Projection::Perspective { yfov: b, .. }) =
                (camera.projection, again.projection)
            else {
                panic!("not perspective")
            };
            assert!((a - b).abs() < 1e-6);
        }
    }

    #[test]
    fn yaw_turns_to_the_right_of_the_model_and_pitch_lifts() {
        let mut entry =
            CameraEntry { yaw_deg: 0.0, pitch_deg: 0.0, target: [0.0; 3], distance: 2.0, ..Default::default() };
        assert!(Vec3::from(entry.camera().world_from_view.translation).distance(Vec3::new(0.0, 0.0, 2.0)) < 1e-5);
        entry.orbit(90.0, 0.0);
        assert!(Vec3::from(entry.camera().world_from_view.translation).distance(Vec3::new(2.0, 0.0, 0.0)) < 1e-5);
        entry.orbit(0.0, 200.0);
        assert!(Vec3::from(entry.camera().world_from_view.translation).distance(Vec3::new(0.0, 2.0, 0.0)) < 1e-5);
    }

    #[test]
    fn a_focal_length_is_that_of_a_full_frame() {
        let mut entry = CameraEntry::default();
        entry.set_focal_length_mm(50.0);
        assert!((entry.yfov_deg - 26.991).abs() < 1e-3);
        assert!((entry.focal_length_mm() - 50.0).abs() < 1e-9);
    }

    #[test]
    fn numbers_from_nowhere_still_make_a_rotation() {
        let entry = CameraEntry { distance: f64::NAN, yaw_deg: f64::INFINITY, pitch_deg: 1e9, ..Default::default() };
        assert!(entry.camera().world_from_view.is_finite());
    }
}
