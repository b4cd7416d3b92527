//! Placing cameras.

use glam::{Affine3A, Mat3, Vec3};

use super::{Camera, Projection};

impl Camera {
    /// A perspective camera at `eye` that looks at `target` with +y up, `yfov` radians high, near plane at 1 cm.
    ///
    /// Looking straight up or down, the top of the picture is towards -z. When `eye` is `target` it looks along -z.
    pub fn look_at(name: &str, eye: Vec3, target: Vec3, yfov: f32) -> Camera {
        let back = (eye - target).try_normalize().unwrap_or(Vec3::Z);
        let right = Vec3::Y.cross(back).try_normalize().unwrap_or(Vec3::X);
        let rotation = Mat3::from_cols(right, back.cross(right), back);
        Camera {
            name: name.into(),
            world_from_view: Affine3A::from_mat3_translation(rotation, eye),
            projection: Projection::Perspective { yfov, near: 0.01 },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_camera_looks_along_its_own_negative_z_at_the_target_with_y_up() {
        let (eye, target) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(-0.5, 0.2, 0.1));
        let camera = Camera::look_at("main", eye, target, 0.7);
        let ahead = camera.world_from_view.transform_vector3(Vec3::NEG_Z);
        assert!(ahead.distance((target - eye).normalize()) < 1e-6);
        assert!(camera.world_from_view.transform_vector3(Vec3::X).y.abs() < 1e-6);
        assert!(camera.world_from_view.transform_vector3(Vec3::Y).y > 0.0);
        assert!((camera.world_from_view.matrix3.determinant() - 1.0).abs() < 1e-5);
    }

    #[test]
    fn looking_straight_down_or_at_itself_still_gives_a_rotation() {
        for (eye, target) in [(Vec3::Y, Vec3::ZERO), (Vec3::NEG_Y, Vec3::ZERO), (Vec3::ONE, Vec3::ONE)] {
            let camera = Camera::look_at("main", eye, target, 0.7);
            assert!((camera.world_from_view.matrix3.determinant() - 1.0).abs() < 1e-5, "{eye} to {target}");
        }
    }
}
