//! The trees against a loop over all triangles.

use glam::{Mat3A, Quat};

use super::*;
use crate::scene::gallery::shape;

/// Meshes of several kinds placed in ways that hurt: mirrored, sheared, flattened, far away, inside each other.
pub(super) fn crowd() -> Scene {
    let mut random = Random::new(1);
    let mut scene = scene([shape::sphere(1.0, 24), shape::torus(1.0, 0.3, 20, 8), shape::block(Vec3::ONE, 0.1, 3)]);
    for i in 0..60 {
        let scale = Vec3::new(1.0, 0.2 + random.unit(), if i % 3 == 0 { -0.7 } else { 1e-3 });
        let turn = Quat::from_scaled_axis(4.0 * cube(&mut random));
        let mut place = Affine3A::from_scale_rotation_translation(scale, turn, 5.0 * cube(&mut random));
        if i % 4 == 0 {
            place.matrix3 *= Mat3A::from_cols_array(&[1.0, 0.0, 0.0, 3.0, 1.0, 0.0, 0.0, -2.0, 1.0]);
        }
        scene.instances.push(Instance { visible: i % 7 != 0, ..instance(i % 3, place) });
    }
    scene
}

pub(super) fn rays(count: usize, size: f32) -> Vec<Ray> {
    let mut random = Random::new(7);
    let mut one = |i: usize| {
        let (from, to) = (size * cube(&mut random), size * cube(&mut random));
        let direction = match i % 8 {
            // Along an axis: two components are zero.
            0 => Vec3::AXES[i / 8 % 3],
            1 => -Vec3::AXES[i / 8 % 3],
            _ => (to - from).normalize(),
        };
        Ray { origin: from, direction, t_max: if i.is_multiple_of(5) { size * random.unit() } else { f32::INFINITY } }
    };
    (0..count).map(&mut one).collect()
}

#[test]
fn trees_find_what_a_loop_over_all_triangles_finds() {
    let scene = crowd();
    let accel = Accel::new(&scene);
    let rays = rays(20_000, 6.0);
    let expected = brute_force(&scene, &rays);
    let found: Vec<Option<Hit>> = rays.iter().map(|ray| accel.closest(ray, any)).collect();
    let hits = found.iter().flatten().count();
    assert!(hits > 4_000 && hits < 16_000, "{hits} hits");
    for ((ray, expected), found) in rays.iter().zip(&expected).zip(&found) {
        assert_eq!(expected, found, "{ray:?}");
        assert_eq!(accel.occluded(ray, any), found.is_some(), "{ray:?}");
    }
}
