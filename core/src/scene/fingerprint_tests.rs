use std::sync::Arc;

use glam::{Mat3, Vec2, Vec4};

use super::*;
use crate::material::{Filter, ReflectionModel, TextureRole, Wrap};
use crate::surface::blinn_phong::Variant;
use crate::surface::fresnel::{Fresnel, TABLE_SIZE};
use crate::surface::micro_normal;

fn scene() -> Scene {
    let mesh = Mesh {
        name: "mesh".into(),
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        normals: vec![Vec3::Z; 3],
        tangents: vec![Vec4::X; 3],
        uvs: [vec![Vec2::ZERO; 3], vec![]],
        colors: vec![],
        indices: vec![0, 1, 2],
    };
    let instance =
        Instance { name: "instance".into(), mesh: 0, material: 0, world_from_local: Affine3A::IDENTITY, visible: true };
    let fresnel = Arc::new(Fresnel::Conductor { n: Vec3::ONE, k: Vec3::splat(2.0) });
    let material = Material { reflectance: Reflectance::Preset { id: "Au".into(), fresnel }, ..Material::default() };
    let image = Image { name: "image".into(), width: 1, height: 1, texels: Texels::Unorm8(vec![1, 2, 3, 4]) };
    let light = Light {
        name: "light".into(),
        position: Vec3::ONE,
        direction: Vec3::X,
        intensity: Vec3::ONE,
        range: f32::INFINITY,
        kind: LightKind::Spot { inner_angle: 0.1, outer_angle: 0.2 },
        ..Light::default()
    };
    Scene {
        name: "scene".into(),
        meshes: vec![Arc::new(mesh)],
        instances: vec![instance],
        materials: vec![material],
        images: vec![Arc::new(image)],
        lights: vec![light],
        cameras: vec![],
        environment: Some(Arc::new(Environment::new("sky", 2, 1, vec![Vec3::ONE; 2]))),
        background: Background::default(),
        subject: vec![0],
        probes: vec![],
    }
}

fn texture() -> TextureRef {
    TextureRef { image: 0, sampler: Sampler::default(), uv_set: 0, transform: Mat3::IDENTITY }
}

/// The part of the scene that a change belongs to, and the change.
type Change = (&'static str, Box<dyn Fn(&mut Scene)>);

/// Changes of one thing each that light sees.
fn changes() -> Vec<Change> {
    let mut list: Vec<Change> = Vec::new();
    let mut mesh = |f: fn(&mut Mesh)| list.push(("geometry", Box::new(move |s| f(Arc::make_mut(&mut s.meshes[0])))));
    mesh(|m| m.positions[1].x = -1.0);
    mesh(|m| m.normals[0] = Vec3::X);
    mesh(|m| m.tangents[0].w = -1.0);
    mesh(|m| m.uvs[0][0].x = 0.5);
    mesh(|m| m.uvs.swap(0, 1));
    mesh(|m| m.colors = vec![Vec4::ONE; 3]);
    mesh(|m| m.indices = vec![0, 2, 1]);
    let mut instance = |f: fn(&mut Instance)| list.push(("geometry", Box::new(move |s| f(&mut s.instances[0]))));
    instance(|i| i.mesh = 1);
    instance(|i| i.material = 1);
    instance(|i| i.world_from_local.translation.x = 1.0);
    instance(|i| i.visible = false);
    let mut material = |f: fn(&mut Material)| list.push(("materials", Box::new(move |s| f(&mut s.materials[0]))));
    material(|m| m.base_color.y = 0.5);
    material(|m| m.opacity = 0.5);
    material(|m| m.metallic = 0.5);
    material(|m| m.roughness = 0.5);
    material(|m| m.normal_scale = 0.5);
    material(|m| m.occlusion_strength = 0.5);
    material(|m| m.emission.z = 0.5);
    material(|m| m.alpha_mode = AlphaMode::Mask { cutoff: 0.5 });
    material(|m| m.alpha_mode = AlphaMode::Mask { cutoff: 0.25 });
    material(|m| m.alpha_mode = AlphaMode::Blend);
    material(|m| m.double_sided = true);
    material(|m| m.unlit = true);
    material(|m| m.ior = 1.4);
    material(|m| m.specular = 0.5);
    material(|m| m.specular_color.x = 0.5);
    material(|m| m.coat = 0.5);
    material(|m| m.coat_roughness = 0.5);
    material(|m| m.coat_normal_scale = 0.5);
    material(|m| m.anisotropy = 0.5);
    material(|m| m.anisotropy_rotation = 0.5);
    material(|m| m.micro_normal = micro_normal::Kind::Hammered);
    material(|m| m.micro_size_mm = 0.5);
    material(|m| m.micro_depth = 0.5);
    material(|m| m.reflection_model = ReflectionModel::BlinnPhong(Variant::Exact));
    material(|m| m.exponent = 8.0);
    material(|m| m.reflectance = Reflectance::BaseColor);
    let mut curve = |f: fn() -> Fresnel| {
        let change = move |s: &mut Scene| {
            s.materials[0].reflectance = Reflectance::Preset { id: "Au".into(), fresnel: Arc::new(f()) };
        };
        list.push(("materials", Box::new(change)));
    };
    curve(|| Fresnel::Conductor { n: Vec3::ONE, k: Vec3::splat(2.1) });
    curve(|| Fresnel::F82 { f0: Vec3::ONE, b: Vec3::ONE });
    curve(|| Fresnel::F82 { f0: Vec3::ONE, b: Vec3::ZERO });
    curve(|| Fresnel::Schlick { f0: Vec3::ONE });
    curve(|| Fresnel::Rescaled { f0: Vec3::ONE });
    curve(|| Fresnel::Spectral { table: Box::new([Vec3::ONE; TABLE_SIZE]) });
    curve(|| Fresnel::Spectral { table: Box::new([Vec3::splat(0.5); TABLE_SIZE]) });
    let mut light = |f: fn(&mut Light)| list.push(("lights", Box::new(move |s| f(&mut s.lights[0]))));
    light(|l| l.position.x = 0.5);
    light(|l| l.direction.x = 0.5);
    light(|l| l.intensity.x = 0.5);
    light(|l| l.range = 0.5);
    light(|l| l.kind = LightKind::Spot { inner_angle: 0.1, outer_angle: 0.3 });
    light(|l| l.kind = LightKind::Point);
    light(|l| l.kind = LightKind::PARALLEL);
    light(|l| l.kind = LightKind::Directional { angular_radius: 0.1 });
    light(|l| l.kind = LightKind::Sphere { radius: 0.1 });
    light(|l| l.kind = LightKind::Rectangle { across: Vec3::X, size: Vec2::ONE });
    light(|l| l.kind = LightKind::Rectangle { across: Vec3::X, size: Vec2::splat(0.5) });
    light(|l| l.camera = true);
    light(|l| l.reflections = false);
    light(|l| l.shadows = false);
    light(|l| l.unlit = vec![0]);
    let mut sky = |f: fn(&mut Environment)| {
        let change = move |s: &mut Scene| s.environment.iter_mut().for_each(|e| f(Arc::make_mut(e)));
        list.push(("environment", Box::new(change)));
    };
    sky(|e| e.texels = vec![Vec3::ONE, Vec3::ZERO].into());
    sky(|e| std::mem::swap(&mut e.width, &mut e.height));
    sky(|e| e.rotation = 0.5);
    sky(|e| e.strength = 0.5);
    sky(|e| e.tint = Vec3::X);
    list.push(("environment", Box::new(|s| s.environment = None)));
    list.push(("background", Box::new(|s| s.background = Background::of_color(Vec3::ZERO))));
    list.push(("background", Box::new(|s| s.background = Background::of_color(Vec3::X))));
    let mut ground = |f: fn(&mut Ground)| {
        let change = move |s: &mut Scene| {
            let mut ground = Ground { middle: Vec3::ZERO, height: 1.0, radius: 9.0, shadows: false };
            f(&mut ground);
            s.background.ground = Some(ground);
        };
        list.push(("background", Box::new(change)));
    };
    ground(|_| ());
    ground(|g| g.middle.x = 1.0);
    ground(|g| g.height = 2.0);
    ground(|g| g.radius = 8.0);
    ground(|g| g.shadows = true);
    list
}

/// Names of the parts in which two differ.
fn differing(a: &Fingerprint, b: &Fingerprint) -> Vec<&'static str> {
    let pairs = [
        ("geometry", a.geometry == b.geometry),
        ("materials", a.materials == b.materials),
        ("lights", a.lights == b.lights),
        ("environment", a.environment == b.environment),
        ("background", a.background == b.background),
    ];
    pairs.into_iter().filter(|(_, same)| !same).map(|(name, _)| name).collect()
}

#[test]
fn every_change_that_light_sees_shows_in_its_part_and_no_two_are_alike() {
    let before = Fingerprint::new(&scene());
    let mut seen = vec![before.clone()];
    for (place, (part, change)) in changes().into_iter().enumerate() {
        let mut changed = scene();
        change(&mut changed);
        let after = Fingerprint::new(&changed);
        assert_eq!(differing(&before, &after), [part], "change {place}");
        assert!(!seen.contains(&after), "change {place}");
        seen.push(after);
    }
}

#[test]
fn textures_and_images_count() {
    let before = Fingerprint::new(&scene()).materials;
    let mut seen = vec![before];
    let mut check = |change: &dyn Fn(&mut Scene)| {
        let mut changed = scene();
        change(&mut changed);
        let after = Fingerprint::new(&changed).materials;
        assert!(!seen.contains(&after));
        seen.push(after);
    };
    for role in TextureRole::ALL {
        check(&|s| *s.materials[0].texture_mut(role) = Some(texture()));
    }
    let slot = |s: &mut Scene, changed: TextureRef| s.materials[0].normal_texture = Some(changed);
    check(&|s| slot(s, TextureRef { image: 1, ..texture() }));
    check(&|s| slot(s, TextureRef { uv_set: 1, ..texture() }));
    check(&|s| slot(s, TextureRef { transform: 2.0 * Mat3::IDENTITY, ..texture() }));
    let sampler = Sampler::default();
    for sampler in [
        Sampler { wrap_u: Wrap::Clamp, ..sampler },
        Sampler { wrap_v: Wrap::Clamp, ..sampler },
        Sampler { magnify: Filter::Nearest, ..sampler },
        Sampler { minify: Filter::Nearest, ..sampler },
        Sampler { mip: Some(Filter::Nearest), ..sampler },
        Sampler { mip: Some(Filter::Linear), ..sampler },
    ] {
        check(&|s| slot(s, TextureRef { sampler, ..texture() }));
    }
    let texels = |s: &mut Scene, texels| Arc::make_mut(&mut s.images[0]).texels = texels;
    check(&|s| texels(s, Texels::Unorm8(vec![1, 2, 3, 5])));
    check(&|s| texels(s, Texels::Unorm16(vec![1, 2, 3, 4])));
    check(&|s| s.images.clear());
}

#[test]
fn names_and_cameras_do_not_count_and_copies_are_equal() {
    let mut renamed = scene();
    renamed.name = "x".into();
    Arc::make_mut(&mut renamed.meshes[0]).name = "x".into();
    renamed.instances[0].name = "x".into();
    renamed.materials[0].name = "x".into();
    Arc::make_mut(&mut renamed.images[0]).name = "x".into();
    renamed.lights[0].name = "x".into();
    renamed.environment = Some(Arc::new(Environment::new("x", 2, 1, vec![Vec3::ONE; 2])));
    renamed.cameras = vec![Camera::look_at("x", Vec3::ONE, Vec3::ZERO, 0.5)];
    assert_eq!(Fingerprint::new(&renamed), Fingerprint::new(&scene()));
}

#[test]
fn the_map_counts_without_its_turn_and_scale() {
    let mut turned = scene();
    let map = Arc::make_mut(turned.environment.as_mut().unwrap());
    (map.rotation, map.strength) = (map.rotation + 1.0, 2.0 * map.strength);
    assert_eq!(sky(&turned), sky(&scene()));
    assert_ne!(environment(&turned), environment(&scene()));
    Arc::make_mut(turned.environment.as_mut().unwrap()).texels = vec![Vec3::splat(7.0); 2].into();
    assert_ne!(sky(&turned), sky(&scene()));
}

#[test]
fn cameras_differ_by_place_and_projection() {
    let base = Camera::look_at("a", Vec3::ONE, Vec3::ZERO, 0.5);
    let with = |projection| Camera { projection, ..base.clone() };
    let hashes = [
        camera(&base),
        camera(&Camera::look_at("a", Vec3::X, Vec3::ZERO, 0.5)),
        camera(&Camera::look_at("a", Vec3::ONE, Vec3::ZERO, 0.6)),
        camera(&with(Projection::Orthographic { ymag: 0.5, near: 0.1, far: 1.0 })),
        camera(&with(Projection::Orthographic { ymag: 0.5, near: 0.1, far: 2.0 })),
    ];
    for (i, a) in hashes.iter().enumerate() {
        assert!(hashes[..i].iter().all(|b| a != b), "{i}");
    }
    assert_eq!(hashes[0], camera(&Camera { name: "b".into(), ..base.clone() }));
}

#[test]
fn the_hash_is_the_same_on_every_machine() {
    // Of one light, byte by byte as documented: count, three vectors, range, kind, two angles, switches, none unlit.
    let mut bytes = 1_u64.to_le_bytes().to_vec();
    for v in [1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0, f32::INFINITY] {
        bytes.extend(v.to_le_bytes());
    }
    bytes.extend(1_u32.to_le_bytes());
    bytes.extend([0.1_f32, 0.2].map(f32::to_le_bytes).concat());
    bytes.extend([0_u32, 1, 1].map(u32::to_le_bytes).concat());
    bytes.extend(0_u64.to_le_bytes());
    assert_eq!(Fingerprint::new(&scene()).lights.to_string(), blake3::hash(&bytes).to_hex().to_string());
}
