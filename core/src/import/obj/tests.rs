use glam::{Vec2, Vec3};

use crate::import::{
    ImportError, ImportOptions, Imported, NormalsWhenAbsent, ResolveError, Resolver, scene_from_bytes,
};

/// Files in memory.
pub(crate) struct Files(pub Vec<(&'static str, Vec<u8>)>);

impl Resolver for Files {
    fn read(&self, uri: &str, _budget: u64) -> Result<Vec<u8>, ResolveError> {
        let file = self.0.iter().find(|(name, _)| *name == uri);
        file.map(|(_, bytes)| bytes.clone()).ok_or(ResolveError::Missing { uri: uri.into() })
    }
}

fn read_with(text: &str, files: Vec<(&'static str, Vec<u8>)>, options: ImportOptions) -> Result<Imported, ImportError> {
    scene_from_bytes(text.as_bytes(), "part.obj", &Files(files), &options)
}

fn read(text: &str) -> Imported {
    read_with(text, Vec::new(), ImportOptions::default()).unwrap()
}

fn refusal(text: &str) -> String {
    read_with(text, Vec::new(), ImportOptions::default()).unwrap_err().to_string()
}

const QUAD: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn polygons_become_triangles_and_v_is_turned_over() {
    let imported = read(&format!("{QUAD}vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n"));
    let mesh = &imported.scene.meshes[0];
    assert_eq!(mesh.indices, [0, 1, 2, 0, 2, 3]);
    assert_eq!(mesh.uvs[0][3], Vec2::new(0.0, 0.0));
    assert!(mesh.normals.iter().all(|n| n.abs_diff_eq(Vec3::Z, 1e-6)));
    assert!(mesh.tangents.iter().all(|t| t.truncate().abs_diff_eq(Vec3::X, 1e-6) && t.w == 1.0), "{:?}", mesh.tangents);
    assert_eq!(imported.scene.name, "part");
}

#[test]
fn negative_indices_tabs_joined_lines_and_comments_are_read() {
    let text = "v 0 0 0 # one\r\nv\t1 0 \\\r\n 0\r\nv 1 1 0\r\ng\tcaf\u{e9}\r\nf -3//\t-2 -1\r\n";
    let imported = read(text);
    assert_eq!(imported.scene.instances[0].name, "caf\u{e9}");
    assert_eq!(imported.scene.triangle_count(), 1);
}

#[test]
fn a_box_without_normals_has_sharp_edges_unless_smoothing_is_asked_for() {
    let corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
    let faces = "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 4 1 5 8\n";
    let text = format!("{corners}{faces}");
    let vertices = |normals| {
        let options = ImportOptions { normals, ..ImportOptions::default() };
        read_with(&text, Vec::new(), options).unwrap().scene.meshes[0].positions.len()
    };
    assert_eq!(vertices(NormalsWhenAbsent::FormatDefault), 24);
    assert_eq!(vertices(NormalsWhenAbsent::Flat), 36);
    assert_eq!(vertices(NormalsWhenAbsent::Smooth { crease_angle: 1.6 }), 8);
}

#[test]
fn faults_name_their_lines_and_are_listed_together() {
    let text =
        refusal("v 0 0 0\nv nan inf 0\nv 1e39 0 0\nv 1,5 0 0\nf 0 1 1\nf 1 1\nf 1 -9 1\nf 1 2 99999999999999999999\n");
    for words in [
        "part.obj: line 2 'v nan inf 0': 'nan' is not a finite",
        "line 3 'v 1e39 0 0': '1e39' is not a finite 32-bit number",
        "line 4 'v 1,5 0 0': '1,5' is not a number",
        "line 5 'f 0 1 1': index 0: indices count from 1",
        "line 6 'f 1 1': a face needs three corners",
        "line 7 'f 1 -9 1': vertex -9 counts back past the first",
        "line 8",
    ] {
        assert!(text.contains(words), "{text}\nlacks {words}");
    }
    assert!(refusal(&format!("{QUAD}f 1 2 999\n")).contains("line 5: vertex 999 does not exist (there are 4)"));
    assert!(refusal(QUAD).contains("has no faces"));
}

#[test]
fn faces_before_their_vertices_and_faces_of_many_corners_are_read() {
    assert_eq!(read(&format!("f 1 2 3\n{QUAD}")).scene.triangle_count(), 1);
    let mut text = String::new();
    let mut face = String::from("f");
    for i in 0..20_000 {
        let phi = i as f32 * std::f32::consts::TAU / 20_000.0;
        text.push_str(&format!("v {} {} 0\n", phi.cos(), phi.sin()));
        face.push_str(&format!(" {}", i + 1));
    }
    assert_eq!(read(&format!("{text}{face}\n")).scene.triangle_count(), 19_998);
}

#[test]
fn normals_of_some_corners_only_are_made_anew_for_all() {
    let imported = read(&format!("{QUAD}vn 1 0 0\nf 1//1 2 3\n"));
    assert!(imported.scene.meshes[0].normals.iter().all(|n| n.abs_diff_eq(Vec3::Z, 1e-6)));
    assert!(imported.notices[0].to_string().contains("made anew"), "{:?}", imported.notices);
}

#[test]
fn vertex_colours_are_made_linear_and_dropped_when_incomplete() {
    let imported = read("v 0 0 0 0.5 0 1\nv 1 0 0 0.5 0 1\nv 1 1 0 0.5 0 1\nf 1 2 3\n");
    // sRGB 0.5 is 0.21404 linear (IEC 61966-2-1).
    assert!(imported.scene.meshes[0].colors[0].truncate().abs_diff_eq(Vec3::new(0.21404, 0.0, 1.0), 1e-5));
    let imported = read("v 0 0 0 0.5 0 1\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
    assert!(imported.scene.meshes[0].colors.is_empty());
    assert!(imported.notices.iter().any(|n| n.text.contains("vertex colours are left out")));
}

#[test]
fn materials_follow_the_table() {
    let mtl = "newmtl red\nKd 1 0 0\nNs 198\nKs 0.5 0.25 0\nd 0.5\nnewmtl steel\nPr 0.3\nPm 1\nPc 0.5\nKe 2 2 2\n\
               Ni 1.6\nnewmtl broken\nKd 1 0\nNs nan\nKs 0.5\nmap_Kd gone.png\n";
    let text = format!("mtllib all.mtl\n{QUAD}usemtl red\nf 1 2 3\nusemtl steel\nf 1 3 4\nusemtl unknown\nf 1 2 4\n");
    let imported = read_with(&text, vec![("all.mtl", mtl.into())], ImportOptions::default()).unwrap();
    let materials = &imported.scene.materials;
    let [red, steel, broken, default] = &materials[..] else { panic!("{} materials", materials.len()) };
    assert_eq!((red.base_color, red.opacity, red.metallic), (Vec3::X, 0.5, 0.0));
    // alpha = sqrt(2 / 200) = 0.1
    assert!((red.roughness * red.roughness - 0.1).abs() < 1e-6);
    assert_eq!(red.exponent, 198.0);
    assert_eq!((red.specular, red.specular_color), (0.5, Vec3::new(1.0, 0.5, 0.0)));
    assert_eq!((steel.roughness, steel.metallic, steel.coat, steel.ior), (0.3, 1.0, 0.5, 1.6));
    assert_eq!(steel.emission, Vec3::splat(2.0));
    assert_eq!((broken.base_color, broken.specular), (Vec3::ONE, 0.5));
    assert_eq!(default.name, "default");
    assert!(materials.iter().all(|m| m.double_sided));
    assert_eq!(imported.scene.instances.iter().map(|i| i.material).collect::<Vec<_>>(), [0, 1, 3]);
    for words in ["line 13 'Kd 1 0' was left out", "'gone.png' is left out: gone.png does not exist"] {
        assert!(imported.notices.iter().any(|n| n.to_string().contains(words)), "{:?}\nlack {words}", imported.notices);
    }
}

#[test]
fn a_missing_library_is_a_notice_and_its_path_is_not_decoded_twice() {
    let text = format!("mtllib ..%2fsecret.mtl\n{QUAD}f 1 2 3\n");
    // OBJ paths are plain, so the percent sign reaches the resolver as a literal one.
    let imported = read_with(&text, vec![("..%252fsecret.mtl", "newmtl a\n".into())], ImportOptions::default());
    assert!(imported.unwrap().notices.is_empty());
    let imported = read(&text);
    assert!(imported.notices[0].to_string().contains("mtllib '..%2fsecret.mtl': the materials are left out"));
}

#[test]
fn roughness_and_metallic_pictures_are_packed_into_one() {
    let png = |value: u8| {
        let mut bytes = std::io::Cursor::new(Vec::new());
        image::GrayImage::from_pixel(2, 2, image::Luma([value])).write_to(&mut bytes, image::ImageFormat::Png).unwrap();
        bytes.into_inner()
    };
    let mtl = "newmtl m\nmap_Pr -bm 0.5 r.png\nmap_Pm -clamp on my metal.png\n";
    let text = format!("mtllib m.mtl\n{QUAD}usemtl m\nf 1 2 3\n");
    let files = vec![("m.mtl", mtl.into()), ("r.png", png(64)), ("my metal.png", png(200))];
    let imported = read_with(&text, files, ImportOptions::default()).unwrap();
    let material = &imported.scene.materials[0];
    assert_eq!((material.roughness, material.metallic), (1.0, 1.0));
    let image = &imported.scene.images[material.metallic_roughness_texture.unwrap().image];
    assert!(matches!(&image.texels, crate::scene::Texels::Unorm8(t) if t[..4] == [255, 64, 200, 255]));
}
