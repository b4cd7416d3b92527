use std::f32::consts::PI;

use glam::{Vec2, Vec3, Vec4};

use super::{Normals, Repairs, complete};
use crate::scene::Mesh;

/// Two triangles that share the edge from the origin to z, folded by `angle` radians out of the plane.
fn folded(angle: f32) -> Mesh {
    let wing = Vec3::new(-angle.cos(), angle.sin(), 0.0);
    Mesh { positions: vec![Vec3::ZERO, Vec3::Z, Vec3::X, wing], indices: vec![0, 1, 2, 1, 0, 3], ..Mesh::default() }
}

/// A unit quad in the xy plane, facing +z, with v down as in a picture; `uvs` for its corners from the bottom left,
/// counter-clockwise.
fn quad(uvs: [[f32; 2]; 4]) -> Mesh {
    Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y],
        normals: vec![Vec3::Z; 4],
        uvs: [uvs.map(Vec2::from).to_vec(), Vec::new()],
        indices: vec![0, 1, 2, 0, 2, 3],
        ..Mesh::default()
    }
}

#[test]
fn flat_normals_take_vertices_apart() {
    let mut mesh = folded(0.5);
    complete(&mut mesh, Normals::Flat, 0);
    assert_eq!(mesh.positions.len(), 6);
    assert_eq!(mesh.normals[0], Vec3::Y);
    assert!(mesh.normals[3].abs_diff_eq(Vec3::new(0.5_f32.sin(), 0.5_f32.cos(), 0.0), 1e-6), "{}", mesh.normals[3]);
}

#[test]
fn an_edge_below_the_crease_angle_is_smooth_and_one_above_is_sharp() {
    let crease = PI / 3.0;
    for (angle, vertices) in [(0.9 * crease, 4), (1.1 * crease, 6)] {
        let mut mesh = folded(angle);
        complete(&mut mesh, Normals::Smooth { crease_angle: crease }, 0);
        assert_eq!(mesh.positions.len(), vertices, "fold of {angle} rad");
    }
    let mut mesh = folded(0.5);
    complete(&mut mesh, Normals::Smooth { crease_angle: crease }, 0);
    let between = Vec3::new(0.25_f32.sin(), 0.25_f32.cos(), 0.0);
    assert!(mesh.normals[0].abs_diff_eq(between, 1e-6), "{} is not {between}", mesh.normals[0]);
}

#[test]
fn smoothing_goes_over_texture_seams() {
    // The shared edge has two vertices at each end, as where a texture wraps around.
    let mut mesh = folded(0.5);
    mesh.positions.extend([Vec3::Z, Vec3::ZERO]);
    mesh.indices = vec![0, 1, 2, 4, 5, 3];
    complete(&mut mesh, Normals::Smooth { crease_angle: 1.0 }, 0);
    assert_eq!(mesh.positions.len(), 6);
    let at_origin: Vec<Vec3> = (0..6).filter(|i| mesh.positions[*i] == Vec3::ZERO).map(|i| mesh.normals[i]).collect();
    assert_eq!(at_origin.len(), 2);
    assert!(at_origin[0].abs_diff_eq(at_origin[1], 1e-6), "{at_origin:?}");
}

#[test]
fn smooth_normals_of_a_fine_sphere_point_outwards() {
    let (rings, sectors) = (24_u32, 48_u32);
    let mut mesh = Mesh::default();
    for r in 0..=rings {
        for s in 0..sectors {
            let (theta, phi) = (PI * r as f32 / rings as f32, 2.0 * PI * s as f32 / sectors as f32);
            // sin(pi) is not quite 0 in f32; the poles shall be points.
            let radius = if r == rings { 0.0 } else { theta.sin() };
            mesh.positions.push(Vec3::new(radius * phi.cos(), theta.cos(), radius * phi.sin()));
        }
    }
    for r in 0..rings {
        for s in 0..sectors {
            let (a, b) = (r * sectors + s, r * sectors + (s + 1) % sectors);
            mesh.indices.extend([a, b, a + sectors, b, b + sectors, a + sectors]);
        }
    }
    let repairs = complete(&mut mesh, Normals::Smooth { crease_angle: PI / 3.0 }, 0);
    // In the rows at the poles every second triangle has no area.
    assert_eq!(repairs.degenerate, 2 * sectors as usize);
    for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
        // The chord's deviation for 7.5 degree steps.
        assert!(p.dot(*n) > 0.998 || *n == Vec3::Y, "{p} has the normal {n}");
    }
}

#[test]
fn a_picture_that_stands_upright_has_its_tangent_right_and_its_bitangent_up() {
    let mut mesh = quad([[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]]);
    complete(&mut mesh, Normals::Flat, 0);
    assert_eq!(mesh.positions.len(), 4);
    for t in &mesh.tangents {
        assert!(t.abs_diff_eq(Vec4::new(1.0, 0.0, 0.0, 1.0), 1e-6), "{t}");
        assert!((t.w * Vec3::Z.cross(t.truncate())).abs_diff_eq(Vec3::Y, 1e-6));
    }
}

#[test]
fn a_mirrored_picture_has_the_opposite_sign() {
    let mut mesh = quad([[1.0, 1.0], [0.0, 1.0], [0.0, 0.0], [1.0, 0.0]]);
    complete(&mut mesh, Normals::Flat, 0);
    for t in &mesh.tangents {
        assert!(t.abs_diff_eq(Vec4::new(-1.0, 0.0, 0.0, -1.0), 1e-6), "{t}");
    }
}

#[test]
fn triangles_with_opposite_mirroring_share_no_vertex() {
    // The second triangle reads the picture mirrored about the diagonal.
    let mut mesh = quad([[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [1.0, 1.0]]);
    complete(&mut mesh, Normals::Flat, 0);
    assert_eq!(mesh.positions.len(), 6);
    assert_eq!(mesh.tangents[mesh.indices[0] as usize].w, 1.0);
    assert_eq!(mesh.tangents[mesh.indices[3] as usize].w, -1.0);
}

#[test]
fn degenerate_shapes_get_finite_unit_normals_and_tangents() {
    let point = vec![Vec3::ONE; 3];
    let line = vec![Vec3::ZERO, Vec3::X, 2.0 * Vec3::X];
    let needle = vec![Vec3::ZERO, Vec3::X, Vec3::new(0.5, 1e-30, 0.0)];
    for positions in [point, line, needle] {
        for policy in [Normals::Flat, Normals::Smooth { crease_angle: 1.0 }] {
            for uv in [Vec::new(), vec![Vec2::ZERO; 3]] {
                let mut mesh = Mesh {
                    positions: positions.clone(),
                    uvs: [uv, Vec::new()],
                    indices: vec![0, 1, 2],
                    ..Mesh::default()
                };
                let repairs = complete(&mut mesh, policy, 0);
                assert_eq!(repairs.degenerate, 1);
                for (n, t) in mesh.normals.iter().zip(&mesh.tangents) {
                    assert!((n.length() - 1.0).abs() < 1e-5 && (t.truncate().length() - 1.0).abs() < 1e-5);
                    assert!(n.dot(t.truncate()).abs() < 1e-5);
                }
            }
        }
    }
}

#[test]
fn broken_normals_and_tangents_are_repaired_and_counted() {
    let mut mesh = quad([[0.0; 2]; 4]);
    mesh.normals = vec![Vec3::ZERO, 3.0 * Vec3::Z, Vec3::Z, 1e-20 * Vec3::Z];
    mesh.tangents =
        vec![Vec4::ZERO, Vec4::new(0.0, 0.0, 1.0, 1.0), Vec4::new(2.0, 0.0, 1.0, -0.5), Vec4::new(1.0, 0.0, 0.0, 1.0)];
    let repairs = complete(&mut mesh, Normals::Flat, 0);
    assert_eq!(repairs, Repairs { rescaled_normals: 1, zero_normals: 2, lost_tangents: 2, ..Repairs::default() });
    assert!(mesh.normals.iter().all(|n| n.abs_diff_eq(Vec3::Z, 1e-6)), "{:?}", mesh.normals);
    assert!(mesh.tangents[2].abs_diff_eq(Vec4::new(1.0, 0.0, 0.0, -1.0), 1e-6), "{}", mesh.tangents[2]);
}

#[test]
fn a_fan_of_many_triangles_takes_linear_time() {
    // 100 000 triangles around one point: 1e10 pairs if each were compared with each.
    let count = 100_000_u32;
    let mut mesh = Mesh { positions: vec![Vec3::Y], ..Mesh::default() };
    for i in 0..count {
        let phi = 2.0 * PI * i as f32 / count as f32;
        mesh.positions.push(Vec3::new(phi.cos(), 0.0, phi.sin()));
        mesh.indices.extend([0, 1 + (i + 1) % count, 1 + i]);
    }
    mesh.uvs[0] = vec![Vec2::ZERO; mesh.positions.len()];
    let start = std::time::Instant::now();
    let repairs = complete(&mut mesh, Normals::Smooth { crease_angle: 1.0 }, 0);
    assert!(repairs.crowded);
    // About 0.1 s on an idle core.
    assert!(start.elapsed().as_secs() < 10, "{:?}", start.elapsed());
}
