//! Rays that leave a surface: they do not meet it again, and pass nothing that they should meet.

use glam::{EulerRot, Quat, Vec3A};

use super::*;
use crate::math::frame::Frame;
use crate::math::sampling::cosine_hemisphere;
use crate::scene::gallery::shape;
use crate::trace::{offset, rounding};

/// A point of a triangle as a renderer computes it from a hit.
struct Point {
    position: Vec3,
    normal: Vec3,
    rounding: Vec3,
}

fn point(scene: &Scene, hit: &Hit) -> Point {
    let instance = &scene.instances[hit.instance as usize];
    let mesh = &scene.meshes[instance.mesh];
    let first = 3 * hit.triangle as usize;
    let local = [0, 1, 2].map(|corner| mesh.positions[mesh.indices[first + corner] as usize]);
    let [a, b, c] = local.map(|p| instance.world_from_local.transform_point3(p));
    let Vec2 { x: v, y: w } = hit.barycentric;
    let normal = (local[1] - local[0]).cross(local[2] - local[0]).normalize();
    let normals = instance.world_from_local.matrix3.inverse().transpose();
    Point {
        position: a * (1.0 - v - w) + b * v + c * w,
        // Of the local corners: far from the origin those in the world have lost their differences.
        normal: Vec3::from(normals * Vec3A::from(normal)).normalize(),
        rounding: rounding(&instance.world_from_local, local),
    }
}

/// Points spread over the triangles of the first instance.
fn hits(scene: &Scene, count: usize, random: &mut Random) -> Vec<Hit> {
    let triangles = scene.meshes[scene.instances[0].mesh].indices.len() as u32 / 3;
    let one = |_| {
        let (u, v) = (random.unit(), random.unit());
        let barycentric = if u + v > 1.0 { Vec2::new(1.0 - u, 1.0 - v) } else { Vec2::new(u, v) };
        let triangle = (random.unit() * triangles as f32) as u32;
        Hit { t: 0.0, instance: 0, triangle: triangle.min(triangles - 1), barycentric }
    };
    (0..count).map(one).collect()
}

/// Scale, rotation and place of instances, with the magnitudes of their meshes.
fn places() -> Vec<(f32, Affine3A)> {
    let turn = Quat::from_euler(EulerRot::XYZ, 0.3, -1.1, 2.0);
    let mut places = Vec::new();
    for size in [1e-3, 0.1, 1.0, 30.0, 1e3, 1e6] {
        places.push((size, Affine3A::IDENTITY));
        places.push((size, Affine3A::from_rotation_translation(turn, Vec3::ZERO)));
        places.push((size, Affine3A::from_translation(Vec3::new(1e4, -3e3, 20.0))));
        let scale = Vec3::new(0.03, 4.0, -1.0);
        places.push((size, Affine3A::from_scale_rotation_translation(scale, turn, Vec3::new(-1e4, 5.0, 7e3))));
        let mut sheared = Affine3A::from_rotation_translation(turn, Vec3::splat(2.0 * size));
        sheared.matrix3.z_axis += 3.0 * sheared.matrix3.x_axis;
        places.push((size, sheared));
    }
    places
}

/// Directions on the side of `normal`, a third of them nearly along the surface.
fn away(normal: Vec3, i: usize, random: &mut Random) -> Vec3 {
    let mut local = cosine_hemisphere(random.point2());
    if i.is_multiple_of(3) {
        local.z *= 1e-3;
    }
    Frame::new(normal).to_world(local.normalize())
}

/// Rays from points of a mesh that meet its own triangle, or one with `next` in the same plane or bent away.
fn returns(mesh: &Mesh, next: impl Fn(Vec3, Vec3) -> bool) -> usize {
    let mut random = Random::new(3);
    let mut count = 0;
    for (size, place) in places() {
        let mut mesh = mesh.clone();
        mesh.positions.iter_mut().for_each(|p| *p *= size);
        let mut scene = scene([mesh]);
        scene.instances[0].world_from_local = place;
        let accel = Accel::new(&scene);
        for (i, hit) in hits(&scene, 20_000, &mut random).iter().enumerate() {
            let Point { position, normal, rounding } = point(&scene, hit);
            let side = if i.is_multiple_of(2) { normal } else { -normal };
            let direction = away(side, i, &mut random);
            let origin = offset(position, rounding, normal, direction);
            let found = accel.closest(&ray(origin, direction), |found| {
                found.triangle == hit.triangle || next(side, point(&scene, found).normal)
            });
            count += usize::from(found.is_some());
        }
    }
    count
}

#[test]
fn rays_that_leave_a_plane_do_not_meet_it() {
    assert_eq!(returns(&shape::disc(1.0, 48, 24), |_, _| true), 0);
    // Two large triangles: what their test rounds is far from the point.
    assert_eq!(returns(&shape::plane(1.0, 0.3), |_, _| true), 0);
}

#[test]
fn rays_that_leave_a_ball_do_not_meet_the_triangle_they_came_from() {
    assert_eq!(returns(&shape::sphere(1.0, 64), |_, _| false), 0);
}

#[test]
fn a_surface_close_by_is_not_passed() {
    // Sheets at a distance of a few steps of the numbers there.
    let mut random = Random::new(5);
    for (size, at) in [(1.0, Vec3::ZERO), (1.0, Vec3::new(3.0, 50.0, -700.0)), (1e-3, Vec3::ZERO), (1e3, Vec3::X)] {
        let far = size + at.abs().max_element();
        let gap = 2e-6 * far;
        let mut scene = scene([shape::plane(size, size), shape::plane(size, size)]);
        scene.instances[0].world_from_local = Affine3A::from_translation(at);
        scene.instances[1].world_from_local = Affine3A::from_translation(at + gap * Vec3::Z);
        let accel = Accel::new(&scene);
        let seen =
            scene.instances[1].world_from_local.translation.z > scene.instances[0].world_from_local.translation.z;
        assert!(seen, "the sheets are apart");
        for hit in hits(&scene, 2_000, &mut random) {
            let Point { position, normal, rounding } = point(&scene, &hit);
            let origin = offset(position, rounding, normal, Vec3::Z);
            let found = accel.closest(&ray(origin, Vec3::Z), any).map(|hit| hit.instance);
            assert_eq!(found, Some(1), "{size} {at}");
        }
    }
}
