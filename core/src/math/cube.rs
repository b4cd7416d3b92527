//! Directions of environment maps: faces of a cube map, equirectangular coordinates.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

/// Unit direction of a point of a face, `p` in `[-1, 1]^2` with (-1, -1) at the face's top left; faces in the order +x, -x,
/// +y, -y, +z, -z. Cube maps are left-handed: what a face shows is mirrored in z against the world.
pub fn direction(face: u32, p: Vec2) -> Vec3 {
    let d = match face {
        0 => Vec3::new(1.0, -p.y, -p.x),
        1 => Vec3::new(-1.0, -p.y, p.x),
        2 => Vec3::new(p.x, 1.0, p.y),
        3 => Vec3::new(p.x, -1.0, -p.y),
        4 => Vec3::new(p.x, -p.y, 1.0),
        _ => Vec3::new(-p.x, -p.y, -1.0),
    };
    d.normalize()
}

/// The face that shows a direction of any length but 0, and the point of it: the inverse of [`direction`].
pub fn face_point(d: Vec3) -> (u32, Vec2) {
    let a = d.abs();
    if a.x >= a.y && a.x >= a.z {
        return if d.x >= 0.0 { (0, Vec2::new(-d.z, -d.y) / a.x) } else { (1, Vec2::new(d.z, -d.y) / a.x) };
    }
    if a.y >= a.z {
        return if d.y >= 0.0 { (2, Vec2::new(d.x, d.z) / a.y) } else { (3, Vec2::new(d.x, -d.z) / a.y) };
    }
    if d.z >= 0.0 { (4, Vec2::new(d.x, -d.y) / a.z) } else { (5, Vec2::new(-d.x, -d.y) / a.z) }
}

/// A direction of the world in the frame of cube maps, which is left-handed, and back.
pub fn mirrored(d: Vec3) -> Vec3 {
    Vec3::new(d.x, d.y, -d.z)
}

/// Solid angle of a small texel at a point of a face over that of one in the face's middle: `(1 + |p|^2)^(-3/2)`.
pub fn weight(p: Vec2) -> f32 {
    (1.0 + p.length_squared()).powf(-1.5)
}

/// Where an equirectangular map shows a unit direction, in `[0, 1]^2` from the top left: -z in the middle, +y on top.
pub fn equirectangular(d: Vec3) -> Vec2 {
    // Two arctangents: an arccosine would lose half of the digits near the poles.
    Vec2::new(0.5 + d.x.atan2(-d.z) / TAU, Vec2::new(d.x, d.z).length().atan2(d.y) / PI)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middles_of_the_faces_are_the_axes() {
        let axes = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
        for (face, axis) in axes.into_iter().enumerate() {
            assert_eq!(direction(face as u32, Vec2::ZERO), axis);
        }
    }

    #[test]
    fn the_face_of_a_direction_is_the_one_that_shows_it() {
        for face in 0..6 {
            for p in [Vec2::ZERO, Vec2::new(0.9, -0.3), Vec2::new(-0.99, 0.98)] {
                let (found, q) = face_point(2.5 * direction(face, p));
                assert!(found == face && q.abs_diff_eq(p, 1e-6), "{face} {p}: {found} {q}");
            }
        }
    }

    #[test]
    fn neighbouring_faces_meet_at_their_edges() {
        for t in [-0.7, 0.0, 0.4] {
            // The right edge of +z is the left edge of +x, the top edge of +z the bottom edge of +y.
            assert!(direction(4, Vec2::new(1.0, t)).abs_diff_eq(direction(0, Vec2::new(-1.0, t)), 1e-6));
            assert!(direction(4, Vec2::new(t, -1.0)).abs_diff_eq(direction(2, Vec2::new(t, 1.0)), 1e-6));
        }
    }

    #[test]
    fn weights_sum_to_the_sphere() {
        let n = 64;
        let at = |i: u32| (i as f32 + 0.5) / n as f32 * 2.0 - 1.0;
        let face: f32 = (0..n * n).map(|i| weight(Vec2::new(at(i % n), at(i / n)))).sum();
        let sphere = 6.0 * face * 4.0 / (n * n) as f32;
        // The midpoint rule is of second order in the texel's size.
        assert!((sphere - 4.0 * PI).abs() < 1e-3, "{sphere}");
    }
}
