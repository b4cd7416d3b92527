use std::{collections::HashMap, f32::consts::PI};

use super::*;

/// Closed bodies with their volume in closed form.
fn bodies() -> Vec<(Mesh, f32)> {
    let (size, edge) = (Vec3::new(0.5, 0.3, 0.4), 0.04);
    let inner = size - 2.0 * edge;
    let faces = 2.0 * edge * (inner.x * inner.y + inner.y * inner.z + inner.z * inner.x);
    let rounded =
        inner.element_product() + faces + PI * edge * edge * inner.element_sum() + 4.0 / 3.0 * PI * edge.powi(3);
    // A cylinder with rounded edges: Pappus on the quarter disc that is left of each square corner.
    let (r, h, e) = (0.2_f32, 0.3_f32, 0.05_f32);
    let quarter = PI * e * e / 4.0 * (r - e + 4.0 * e / (3.0 * PI));
    let corner = e * e * (r - 0.5 * e) - quarter;
    let cylinder_volume = PI * r * r * h - 2.0 * TAU * corner;
    let tube = PI * 0.05 * 0.05 * LINE.length();
    vec![
        (sphere(0.2, 96), 4.0 / 3.0 * PI * 0.2_f32.powi(3)),
        (torus(0.3, 0.05, 96, 64), 2.0 * PI * PI * 0.3 * 0.05_f32.powi(2)),
        (cylinder(r, h, e, 96), cylinder_volume),
        (block(size, 0.0, 1), size.element_product()),
        (block(size, edge, 12), rounded),
        (ring_segment(), ring_segment_volume()),
        // Twisting keeps volumes; so does bending, with the length of the curve, where the section's middle is on it.
        (twisted(sphere(0.2, 96), 0.8), 4.0 / 3.0 * PI * 0.2_f32.powi(3)),
        (pierced(Vec3::new(0.5, 0.4, 0.1), Vec2::new(0.05, -0.02), Vec2::new(0.2, 0.1)), 0.1 * (0.2 - 0.02)),
        (bent(transformed(cylinder(0.05, 0.6, 0.0, 96), &Affine3A::from_translation(0.3 * Vec3::Y)), 0.6, &LINE), tube),
    ]
}

/// A straight curve at an angle.
const LINE: Curve = Curve([Vec2::ZERO, Vec2::new(0.1, 0.2), Vec2::new(0.2, 0.4), Vec2::new(0.3, 0.6)]);

const TAU: f32 = std::f32::consts::TAU;
const RIM: f32 = 0.01;
const RING: [f32; 3] = [0.3, 0.05, 2.0];

/// Part of a torus with rounded rims.
fn ring_segment() -> Mesh {
    let [major, minor, angle] = RING;
    let circle = Profile::new().arc(Vec2::new(major, 0.0), minor, 0.0, -TAU, 96).closed();
    sweep("segment", &circle, [0.3, 0.3 + angle], 48, RIM)
}

/// Tube plus two discs with rounded rims: a disc of radius minor - rim, and a quarter disc turned around it.
fn ring_segment_volume() -> f32 {
    let [major, minor, angle] = RING;
    let inner = minor - RIM;
    let rim = TAU * (PI * RIM * RIM / 4.0) * (inner + 4.0 * RIM / (3.0 * PI));
    PI * minor * minor * major * angle + 2.0 * (PI * inner * inner * RIM + rim)
}

/// Everything that a test of patches should cover, open ones too, and transformed ones.
fn shapes() -> Vec<Mesh> {
    let mut all: Vec<Mesh> = bodies().into_iter().map(|(mesh, _)| mesh).collect();
    all.push(plane(0.4, 0.2));
    all.push(disc(0.3, 48, 4));
    let flare = [
        Corner::sharp(0.1, 0.2),
        Corner::round(0.05, 0.1, 0.04),
        Corner::round(0.2, 0.02, 0.03),
        Corner::sharp(0.2, 0.0),
    ];
    all.push(revolve("flare", &Profile::rounded(&flare, 6), 48));
    let skewed = Affine3A::from_scale_rotation_translation(
        Vec3::new(1.0, 2.0, 0.5),
        glam::Quat::from_rotation_z(0.4),
        Vec3::new(0.1, 0.2, 0.3),
    );
    let mirror = Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    all.push(transformed(torus(0.3, 0.05, 48, 24), &skewed));
    all.push(transformed(block(Vec3::new(0.5, 0.3, 0.4), 0.04, 3), &mirror));
    all.push(blob(0.3, 96));
    all.push(bowl(0.1, 64));
    all.push(goblet(0.2, 64));
    all.push(rod(0.02, &Curve([Vec2::ZERO, Vec2::new(0.2, 0.0), Vec2::new(0.3, 0.2), Vec2::new(0.1, 0.3)]), 32));
    all.push(combined("both", [sphere(0.1, 24), transformed(disc(0.2, 24, 2), &(skewed * mirror))]));
    all
}

/// Calls `check` with the corners of every triangle.
fn each_triangle(mesh: &Mesh, mut check: impl FnMut([usize; 3])) {
    assert!(!mesh.indices.is_empty() && mesh.indices.len().is_multiple_of(3), "{}", mesh.name);
    for t in mesh.indices.chunks_exact(3) {
        check([t[0] as usize, t[1] as usize, t[2] as usize]);
    }
}

/// Twice the area times the geometric normal.
fn area_vector(mesh: &Mesh, [a, b, c]: [usize; 3]) -> Vec3 {
    (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a])
}

#[test]
fn every_edge_of_a_closed_mesh_is_used_twice_in_opposite_directions() {
    for (mesh, _) in bodies() {
        // Adding zero makes -0 and 0 the same bits.
        let key = |i: usize| (mesh.positions[i] + Vec3::ZERO).to_array().map(f32::to_bits);
        let mut edges: HashMap<_, i32> = HashMap::new();
        each_triangle(&mesh, |t| {
            for (from, to) in [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (key(t[i]), key(t[j]))) {
                let (edge, step) = if from < to { ((from, to), 1) } else { ((to, from), 1 << 16) };
                *edges.entry(edge).or_default() += step;
            }
        });
        let wrong = edges.values().filter(|&&uses| uses != 1 + (1 << 16)).count();
        assert_eq!(wrong, 0, "{}: {wrong} of {} edges", mesh.name, edges.len());
    }
}

#[test]
fn volumes_are_those_of_the_closed_forms() {
    for (mesh, expected) in bodies() {
        let mut volume = 0.0_f64;
        each_triangle(&mesh, |t| volume += f64::from(area_vector(&mesh, t).dot(mesh.positions[t[0]])) / 6.0);
        let error = volume as f32 / expected - 1.0;
        // Chords are inside the circles: (2 pi / n)^2 / 6 for each direction of curvature, 0.16 % for 64 segments;
        // the tightest rims have 5 segments to a quarter turn and little volume.
        assert!(error.abs() < 0.004, "{}: {volume} against {expected}", mesh.name);
    }
}

#[test]
fn normals_are_unit_and_agree_with_the_winding() {
    for mesh in shapes() {
        each_triangle(&mesh, |t| {
            let geometric = area_vector(&mesh, t).normalize();
            for i in t {
                let normal = mesh.normals[i];
                assert!((normal.length() - 1.0).abs() < 1e-5, "{}: {normal}", mesh.name);
                // The widest turn between a facet and its corners: half of a sixth of a quarter turn and its diagonal,
                // 0.97 in cosine; stretching by 4 : 1 widens it to 0.88.
                let cosine = normal.dot(geometric);
                assert!(cosine > 0.8, "{}: {normal} on a facet of {geometric}, cosine {cosine}", mesh.name);
            }
        });
    }
}

#[test]
fn tangents_are_unit_and_perpendicular_to_the_normals() {
    for mesh in shapes() {
        for (normal, tangent) in mesh.normals.iter().zip(&mesh.tangents) {
            let along = tangent.truncate();
            assert!((along.length() - 1.0).abs() < 1e-5 && tangent.w.abs() == 1.0, "{}: {tangent}", mesh.name);
            assert!(along.dot(*normal).abs() < 1e-5, "{}: {tangent} on {normal}", mesh.name);
        }
    }
}

#[test]
fn tangents_follow_u_and_bitangents_go_against_v_in_both_texture_sets() {
    for mesh in shapes() {
        for uvs in &mesh.uvs {
            each_triangle(&mesh, |t| {
                let [a, b, c] = t;
                let (e1, e2) = (mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
                let (d1, d2) = (uvs[b] - uvs[a], uvs[c] - uvs[a]);
                let area = d1.perp_dot(d2);
                assert!(area != 0.0, "{}: a triangle without texture area", mesh.name);
                let along_u = (e1 * d2.y - e2 * d1.y) / area;
                let along_v = (e2 * d1.x - e1 * d2.x) / area;
                let tangent = t.map(|i| mesh.tangents[i].truncate()).iter().sum::<Vec3>().normalize();
                let cosine = along_u.normalize().dot(tangent);
                // Facets shear against the smooth surface, most where the rings of a disc close to a point.
                assert!(cosine > 0.9, "{}: {along_u} along {tangent}, cosine {cosine}", mesh.name);
                for i in t {
                    let bitangent = mesh.tangents[i].w * mesh.normals[i].cross(mesh.tangents[i].truncate());
                    assert!(bitangent.dot(along_v) < 0.0, "{}: {bitangent} against {along_v}", mesh.name);
                }
            });
        }
    }
}

#[test]
fn tangents_are_those_that_mikktspace_makes_of_the_same_texture_coordinates() {
    struct Corners<'a> {
        mesh: &'a Mesh,
        worst: f32,
        signs: bool,
    }
    impl Corners<'_> {
        fn index(&self, face: usize, vertex: usize) -> usize {
            self.mesh.indices[3 * face + vertex] as usize
        }
    }
    impl bevy_mikktspace::Geometry for Corners<'_> {
        fn num_faces(&self) -> usize {
            self.mesh.indices.len() / 3
        }
        fn num_vertices_of_face(&self, _: usize) -> usize {
            3
        }
        fn position(&self, face: usize, vertex: usize) -> [f32; 3] {
            self.mesh.positions[self.index(face, vertex)].into()
        }
        fn normal(&self, face: usize, vertex: usize) -> [f32; 3] {
            self.mesh.normals[self.index(face, vertex)].into()
        }
        fn tex_coord(&self, face: usize, vertex: usize) -> [f32; 2] {
            let uv = self.mesh.uvs[0][self.index(face, vertex)];
            [uv.x, 1.0 - uv.y]
        }
        fn set_tangent(&mut self, tangent: Option<bevy_mikktspace::TangentSpace>, face: usize, vertex: usize) {
            let Some(tangent) = tangent else { return };
            let own = self.mesh.tangents[self.index(face, vertex)];
            let theirs = Vec4::from(tangent.tangent_encoded());
            self.worst = self.worst.min(own.truncate().dot(theirs.truncate()));
            self.signs &= own.w == theirs.w;
        }
    }
    for mesh in shapes() {
        let mut corners = Corners { mesh: &mesh, worst: 1.0, signs: true };
        let _ = bevy_mikktspace::generate_tangents(&mut corners);
        assert!(corners.signs, "{}: signs differ", mesh.name);
        // Theirs is the mean over facets, ours of the smooth surface: they part where a facet turns far (poles).
        assert!(corners.worst > 0.9, "{}: cosine {}", mesh.name, corners.worst);
    }
}

#[test]
fn the_tangent_at_a_pole_is_that_of_the_middle_of_its_triangle() {
    let ball = sphere(1.0, 16);
    let mut poles = 0;
    each_triangle(&ball, |t| {
        for (pole, from, to) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)].map(|(i, j, k)| (t[i], t[j], t[k])) {
            if ball.positions[pole].y.abs() == 1.0 {
                let edge = (ball.positions[to] - ball.positions[from]).normalize();
                let cosine = ball.tangents[pole].truncate().dot(edge) * ball.positions[pole].y;
                assert!(cosine > 0.9999, "{edge} at {}", ball.positions[pole]);
                poles += 1;
            }
        }
    });
    assert_eq!(poles, 32);
}

#[test]
fn combined_meshes_keep_colours_beside_parts_without_any() {
    let red = Vec4::new(1.0, 0.0, 0.0, 1.0);
    let mesh = combined("both", [plane(1.0, 1.0), colored(plane(1.0, 1.0), red), plane(1.0, 1.0)]);
    assert_eq!(mesh.colors[..4], [Vec4::ONE; 4]);
    assert_eq!(mesh.colors[4..8], [red; 4]);
    assert_eq!(mesh.colors[8..], [Vec4::ONE; 4]);
    assert_eq!(mesh.positions.len(), mesh.colors.len());
}
