//! Cameras made from points instead of matrices.

use glam::{Affine3A, Mat3, Vec3};

use super::{Bounds, Camera, Projection};

/// Vertical field of view of [`Camera::frame`]: a long lens, which keeps the shape of small objects.
const FRAME_YFOV: f32 = 35.0 * std::f32::consts::PI / 180.0;
/// Direction from the object to the camera of [`Camera::frame`]: the front of a glTF model is +z; 30 degrees to its
/// side and 18 above, both as tangents.
const FRAME_DIRECTION: Vec3 = Vec3::new(0.577, 0.375, 1.0);
/// Room around the box in [`Camera::frame`].
const FRAME_MARGIN: f32 = 1.06;
/// Near plane as a part of the distance to the target. Depth is reversed floating point, which loses nothing by it.
const NEAR: f32 = 1e-3;

impl Camera {
    /// A perspective camera at `eye` (metres) that sees `target` in its middle and +y upwards; `yfov` is the full
    /// vertical angle in radians. Where `target` is no direction from `eye` it looks along -z; straight up or down,
    /// the top of the picture is +z or -z.
    pub fn look_at(name: &str, eye: Vec3, target: Vec3, yfov: f32) -> Camera {
        let offset = target - eye;
        let distance = if offset.is_finite() { offset.length() } else { 0.0 };
        let forward = offset.try_normalize().unwrap_or(Vec3::NEG_Z);
        let up = if forward.y.abs() < 0.9999 { Vec3::Y } else { Vec3::new(0.0, 0.0, forward.y.signum()) };
        let right = forward.cross(up).normalize();
        let rotation = Mat3::from_cols(right, right.cross(forward), -forward);
        let near = if distance > 0.0 { NEAR * distance } else { NEAR };
        Camera {
            name: name.into(),
            world_from_view: Affine3A::from_mat3_translation(rotation, eye),
            projection: Projection::Perspective { yfov, near },
        }
    }

    /// The camera that shows all of a box, three-quarter from the front and slightly from above, as near as the box
    /// stays inside a picture of `aspect` (width by height). An empty box is framed as one of 1 m.
    pub fn frame(bounds: Bounds, aspect: f32) -> Camera {
        let center = bounds.center();
        let half = if bounds.is_empty() { Vec3::splat(0.5) } else { 0.5 * (bounds.max - bounds.min) };
        let radius = half.length().max(f32::MIN_POSITIVE.sqrt());
        let back = FRAME_DIRECTION.normalize();
        let right = Vec3::Y.cross(back).normalize();
        let up = back.cross(right);

        let tan_y = (0.5 * FRAME_YFOV).tan();
        let tan_x = tan_y * aspect;
        // A corner is inside when |x| <= tan_x * depth and |y| <= tan_y * depth, with depth = distance - its z.
        let distance = (0..8)
            .map(|i| {
                let sign = |bit: i32| if i & bit == 0 { -1.0 } else { 1.0 };
                let corner = half * Vec3::new(sign(1), sign(2), sign(4));
                let (x, y, z) = (corner.dot(right).abs(), corner.dot(up).abs(), corner.dot(back));
                z + (x / tan_x).max(y / tan_y)
            })
            // A thin box seen end on must not reach the camera.
            .fold(1.5 * radius, f32::max);
        Camera::look_at("frame all", center + FRAME_MARGIN * distance * back, center, FRAME_YFOV)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x and y of a point in the picture, -1 to 1 inside, and its depth in metres.
    fn project(camera: &Camera, aspect: f32, point: Vec3) -> Vec3 {
        let view = camera.world_from_view.inverse().transform_point3(point);
        let Projection::Perspective { yfov, .. } = camera.projection else { panic!("not a perspective camera") };
        let tan = (0.5 * yfov).tan();
        Vec3::new(view.x / (-view.z * tan * aspect), view.y / (-view.z * tan), -view.z)
    }

    #[test]
    fn look_at_puts_the_target_in_the_middle_and_up_above_it() {
        let target = Vec3::new(1.0, 2.0, -3.0);
        for eye in [Vec3::new(4.0, 3.0, 5.0), Vec3::new(1.0, 9.0, -3.0), Vec3::new(1.0, -9.0, -3.0), Vec3::ZERO] {
            let camera = Camera::look_at("c", eye, target, 0.7);
            assert!((project(&camera, 1.5, target) - Vec3::new(0.0, 0.0, eye.distance(target))).length() < 1e-5);
            let m = camera.world_from_view.matrix3;
            assert!((m.determinant() - 1.0).abs() < 1e-5, "a rotation from {eye}: {m}");
            if (target - eye).normalize().y.abs() < 0.99 {
                assert!(project(&camera, 1.5, target + 0.1 * Vec3::Y).y > 0.0);
            }
        }
    }

    #[test]
    fn look_at_without_a_direction_is_still_a_rotation() {
        for target in [Vec3::ONE, Vec3::NAN, Vec3::INFINITY] {
            let camera = Camera::look_at("c", Vec3::ONE, target, 0.7);
            assert!((camera.world_from_view.matrix3.determinant() - 1.0).abs() < 1e-5, "{target}");
        }
    }

    #[test]
    fn frame_holds_every_corner_and_wastes_no_room() {
        let boxes = [
            Bounds { min: Vec3::splat(-1.0), max: Vec3::ONE },
            Bounds { min: Vec3::new(1e3, -2.0, 0.0), max: Vec3::new(1.001e3, 5.0, 0.1) },
            Bounds { min: Vec3::new(-4.0, 0.0, -1e-3), max: Vec3::new(4.0, 0.0, 1e-3) },
            Bounds { min: Vec3::new(0.0, 0.0, -30.0), max: Vec3::new(0.1, 0.1, 30.0) },
        ];
        for bounds in boxes {
            for aspect in [0.4, 1.0, 16.0 / 9.0] {
                let camera = Camera::frame(bounds, aspect);
                let mut widest = 0.0_f32;
                for i in 0..8 {
                    let pick = Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32);
                    let p = project(&camera, aspect, bounds.min + pick * (bounds.max - bounds.min));
                    assert!(p.z > 0.0 && p.x.abs() < 1.0 && p.y.abs() < 1.0, "{bounds:?} at {aspect}: {p}");
                    widest = widest.max(p.x.abs()).max(p.y.abs());
                }
                assert!(widest > 0.5, "{bounds:?} at {aspect} fills only {widest}");
            }
        }
    }

    #[test]
    fn nothing_and_a_point_are_framed_too() {
        for bounds in [Bounds::EMPTY, Bounds { min: Vec3::ONE, max: Vec3::ONE }] {
            assert!(Camera::frame(bounds, 1.0).world_from_view.is_finite());
        }
    }
}
