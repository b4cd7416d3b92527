//! Closed meshes let no ray out, wherever it is aimed.

use std::collections::HashMap;

use glam::Quat;

use super::*;
use crate::scene::gallery::shape;

/// Twenty triangles, each divided in four so many times, corners on the unit sphere and shared.
fn icosphere(times: usize) -> Mesh {
    let golden = 0.5 + 0.5 * 5.0_f32.sqrt();
    let mut positions = Vec::new();
    for (a, b) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
        positions.extend([Vec3::new(0.0, a, b), Vec3::new(a, b, 0.0), Vec3::new(b, 0.0, a)]);
    }
    let near = |a: Vec3, b: Vec3| (a - b).length() < 2.1;
    let mut indices = Vec::new();
    for a in 0..12 {
        for (b, c) in (a + 1..12).flat_map(|b| (b + 1..12).map(move |c| (b, c))) {
            let [p, q, r] = [a, b, c].map(|i| positions[i]);
            if near(p, q) && near(q, r) && near(r, p) {
                indices.extend([a as u32, b as u32, c as u32]);
            }
        }
    }
    positions.iter_mut().for_each(|p| *p = p.normalize());
    for _ in 0..times {
        let mut middles = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                positions.push((positions[a as usize] + positions[b as usize]).normalize());
                positions.len() as u32 - 1
            })
        };
        let divided = indices.chunks_exact(3).flat_map(|t| {
            let [a, b, c] = [t[0], t[1], t[2]];
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            [a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca]
        });
        indices = divided.collect();
    }
    Mesh { positions, indices, ..Mesh::default() }
}

/// A cube of edge 2 with flat sides of `n` by `n` squares, corners shared along its edges by value.
fn cube(n: usize) -> Mesh {
    let mut mesh = Mesh::default();
    let at = |i: usize| 2.0 * i as f32 / n as f32 - 1.0;
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let first = mesh.positions.len() as u32;
            for (i, j) in (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j))) {
                let mut p = [0.0; 3];
                (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (side, at(i), at(j));
                mesh.positions.push(Vec3::from_array(p));
            }
            let row = n as u32 + 1;
            for square in (0..n as u32).flat_map(|i| (0..n as u32).map(move |j| first + i * row + j)) {
                mesh.indices.extend([square, square + 1, square + row, square + row, square + 1, square + row + 1]);
            }
        }
    }
    mesh
}

/// The mesh with corners that are as good as equal made equal: the seams of textures are closed.
fn welded(mut mesh: Mesh) -> Mesh {
    let mut first = HashMap::new();
    for p in &mut mesh.positions {
        let cell = (*p * 1e5).round().as_ivec3();
        *p = *first.entry(cell).or_insert(*p);
    }
    mesh
}

/// Stretched so much that its triangles become needles.
fn needles(mut mesh: Mesh) -> Mesh {
    mesh.positions.iter_mut().for_each(|p| *p *= Vec3::new(1.0, 1e-3, 1e3));
    mesh
}

fn moved(mesh: &Mesh, scale: f32, by: Vec3) -> Mesh {
    let mut mesh = mesh.clone();
    mesh.positions.iter_mut().for_each(|p| *p = scale * *p + by);
    mesh
}

/// Rays that leave: from points `inside`, in local space, exactly at corners, at points of edges and through them.
fn leaks(mesh: &Mesh, place: Affine3A, inside: &[Vec3], count: usize) -> usize {
    let mut scene = scene([mesh.clone()]);
    scene.instances[0].world_from_local = place;
    let accel = Accel::new(&scene);
    let mut random = Random::new(11);
    let mut leaks = 0;
    for i in 0..count {
        let corner = (random.unit() * (mesh.indices.len() - 1) as f32) as usize;
        let next = if corner % 3 == 2 { corner - 2 } else { corner + 1 };
        let [a, b] = [corner, next].map(|i| place.transform_point3(mesh.positions[mesh.indices[i] as usize]));
        let target = match i % 4 {
            0 => a,
            1 => 0.5 * (a + b),
            _ => a + random.unit() * (b - a),
        };
        let origin = place.transform_point3(inside[i % inside.len()]);
        let direction = if i % 3 == 0 { target - origin } else { (target - origin).normalize() };
        let ray = ray(origin, direction);
        leaks += usize::from(accel.closest(&ray, any).is_none() || !accel.occluded(&ray, any));
    }
    leaks
}

/// Points around the middle, in half the unit cube, and the middle itself.
fn around_the_middle(size: f32) -> Vec<Vec3> {
    let mut random = Random::new(13);
    let mut points: Vec<Vec3> = (0..50).map(|_| 0.25 * size * super::cube(&mut random)).collect();
    points.push(Vec3::ZERO);
    points
}

#[test]
fn balls_and_boxes_are_tight_at_every_magnitude_and_far_from_the_origin() {
    let shapes = [
        ("icosphere", icosphere(4)),
        ("cube", cube(24)),
        ("coarse cube", cube(1)),
        ("ball", welded(shape::sphere(1.0, 64))),
    ];
    for (name, mesh) in &shapes {
        for (scale, by) in [
            (1.0, Vec3::ZERO),
            (1e-3, Vec3::ZERO),
            (1e3, Vec3::ZERO),
            (1e6, Vec3::ZERO),
            (1.0, Vec3::new(100.0, -2.0, 7.0)),
            (1.0, Vec3::new(1e4, 3e3, -1e4)),
            (10.0, Vec3::new(0.0, 1e5, 0.0)),
        ] {
            let inside: Vec<Vec3> = around_the_middle(1.0).iter().map(|p| scale * *p + by).collect();
            let leaks = leaks(&moved(mesh, scale, by), Affine3A::IDENTITY, &inside, 60_000);
            assert_eq!(leaks, 0, "{name} times {scale} at {by}");
        }
    }
}

#[test]
fn turned_mirrored_and_sheared_instances_are_tight() {
    let mesh = icosphere(4);
    let mut random = Random::new(17);
    for i in 0..12 {
        let turn = Quat::from_scaled_axis(3.0 * super::cube(&mut random));
        let scale = if i % 2 == 0 { Vec3::new(1e-1, 3.0, -40.0) } else { Vec3::splat(10.0_f32.powi(i - 6)) };
        let mut place =
            Affine3A::from_scale_rotation_translation(scale, turn, 1e3 * scale.x * super::cube(&mut random));
        if i % 3 == 0 {
            place.matrix3.x_axis += 5.0 * place.matrix3.y_axis;
        }
        let leaks = leaks(&mesh, place, &around_the_middle(1.0), 60_000);
        assert_eq!(leaks, 0, "{place:?}");
    }
}

#[test]
fn shapes_with_rounded_edges_and_needles_are_tight() {
    let ring: Vec<Vec3> = (0..64).map(|i| Vec3::new((0.1 * i as f32).cos(), 0.0, (0.1 * i as f32).sin())).collect();
    let middle = around_the_middle(0.5);
    let stretched: Vec<Vec3> = middle.iter().map(|p| *p * Vec3::new(1.0, 1e-3, 1e3)).collect();
    for (name, mesh, inside) in [
        ("torus", welded(shape::torus(1.0, 0.3, 64, 24)), &ring),
        ("cylinder", welded(shape::cylinder(0.5, 1.0, 0.1, 48)), &middle),
        ("block", welded(shape::block(Vec3::ONE, 0.1, 5)), &middle),
        ("needles", needles(icosphere(4)), &stretched),
        ("flat needles", needles(cube(24)), &stretched),
    ] {
        assert_eq!(leaks(&mesh, Affine3A::IDENTITY, inside, 200_000), 0, "{name}");
    }
}
