//! What many scenes are made of: settings, materials, placed meshes, rooms and lamps.

use std::sync::Arc;

use glam::{Affine3A, Mat3, Quat, Vec2, Vec3};

use super::{number, shape};
use crate::{
    material::{
        Filter, Material, Reflectance, Sampler, TextureRef,
        preset::{self, FormChoice, Tolerance},
    },
    param::{Affects, ParamKind, ParamSpec, ParamValue, Settings},
    scene::{Environment, Image, Instance, Mesh, Scene},
};

/// Word of the material that is no metal: matt and white.
const WHITE: &str = "white";

/// Every metal by its id, then [`WHITE`].
const MATERIALS: [&str; preset::IDS.len() + 1] = {
    let mut words = [WHITE; preset::IDS.len() + 1];
    let mut i = 0;
    while i < preset::IDS.len() {
        words[i] = preset::IDS[i];
        i += 1;
    }
    words
};

/// The setting `material`, with an id among [`MATERIALS`]; another does not compile.
pub const fn material_param(default: &str) -> ParamSpec {
    let mut place = 0;
    while !equal(MATERIALS[place].as_bytes(), default.as_bytes()) {
        place += 1;
    }
    ParamSpec {
        key: "material",
        label: "Material",
        unit: "",
        kind: ParamKind::Choice { options: &MATERIALS, default: place },
        help: "Metal of the subject, or `white` for a matt white one.",
        affects: Affects::Prepare,
    }
}

const fn equal(a: &[u8], b: &[u8]) -> bool {
    let mut i = 0;
    while i < a.len() && i < b.len() && a[i] == b[i] {
        i += 1;
    }
    i == a.len() && i == b.len()
}

/// The setting `roughness`.
pub const fn roughness_param(default: f64) -> ParamSpec {
    ParamSpec {
        key: "roughness",
        label: "Roughness",
        unit: "",
        kind: ParamKind::Number { min: 0.0, max: 1.0, default },
        help: "Roughness of the subject: 0 is a mirror, 0.2 polished, 0.5 satin.",
        affects: Affects::Prepare,
    }
}

/// A setting that takes one of a list of words.
pub const fn choice_param(
    key: &'static str,
    label: &'static str,
    options: &'static [&'static str],
    help: &'static str,
) -> ParamSpec {
    ParamSpec { key, label, unit: "", kind: ParamKind::Choice { options, default: 0 }, help, affects: Affects::Prepare }
}

/// The material that the settings `material` and `roughness` ask for.
pub fn subject_material(settings: &Settings) -> Material {
    let word = settings.text("material").unwrap_or_default();
    metal("subject", &word, number(settings, "roughness"))
}

/// A metal by the id of its preset, in the cheapest form that is true to it; [`WHITE`] and unknown ids give matt white.
pub fn metal(name: &str, id: &str, roughness: f32) -> Material {
    let Some(preset) = preset::library().iter().find(|preset| preset.id == id) else {
        return Material { roughness: 1.0, specular: 0.0, ..paint(name, Vec3::splat(0.75)) };
    };
    let form = FormChoice::Cheapest(Tolerance::default()).form(preset);
    let fresnel = Arc::new(preset.fresnel(form));
    Material {
        name: name.into(),
        base_color: preset.schlick_f0().as_vec3().clamp(Vec3::ZERO, Vec3::ONE),
        metallic: 1.0,
        roughness,
        reflectance: Reflectance::Preset { id: preset.id.clone(), fresnel },
        ..Material::default()
    }
}

/// A wall paint of a linear albedo.
pub fn paint(name: &str, base_color: Vec3) -> Material {
    Material { name: name.into(), base_color, roughness: 0.75, ..Material::default() }
}

/// Adds a material and gives its index.
pub fn add_material(scene: &mut Scene, material: Material) -> usize {
    scene.materials.push(material);
    scene.materials.len() - 1
}

/// Places a mesh and gives the index of the instance.
pub fn add(scene: &mut Scene, name: &str, mesh: Mesh, material: usize, world_from_local: Affine3A) -> usize {
    scene.instances.push(Instance {
        name: name.into(),
        mesh: scene.meshes.len(),
        material,
        world_from_local,
        visible: true,
    });
    scene.meshes.push(Mesh { name: name.into(), ..mesh }.into());
    scene.instances.len() - 1
}

/// Places a mesh that the picture is about.
pub fn add_subject(scene: &mut Scene, name: &str, mesh: Mesh, material: usize, world_from_local: Affine3A) {
    let index = add(scene, name, mesh, material, world_from_local);
    scene.subject.push(index);
}

/// Adds an image and gives a reference that repeats it every `metres` of texture set 1, beginning at `offset`.
pub fn in_metres(scene: &mut Scene, image: Image, metres: Vec2, offset: Vec2) -> TextureRef {
    scene.images.push(Arc::new(image));
    TextureRef {
        image: scene.images.len() - 1,
        sampler: Sampler { mip: Some(Filter::Linear), ..Sampler::default() },
        uv_set: 1,
        transform: Mat3::from_scale(metres.recip()) * Mat3::from_translation(-offset),
    }
}

/// A closed room: six slabs that reach into each other, so that no light gets through and no two faces coincide.
#[derive(Clone, Copy, Debug)]
pub struct Room {
    /// Of the hollow.
    pub middle: Vec3,
    /// Half the hollow; metres.
    pub half: Vec3,
    /// Of the slabs.
    pub thickness: f32,
}

/// The slabs of a [`Room`]: name and outward direction. Those of one axis reach equally far, those of different axes
/// differently far, [`Room::overlap`], into the neighbours.
pub const SLABS: [(&str, Vec3); 6] = [
    ("wall-left", Vec3::NEG_X),
    ("wall-right", Vec3::X),
    ("floor", Vec3::NEG_Y),
    ("ceiling", Vec3::Y),
    ("wall-back", Vec3::NEG_Z),
    ("wall-front", Vec3::Z),
];

impl Room {
    /// Metres by which a slab reaches beyond the hollow on all sides: where texture set 1 has the hollow's edge.
    pub fn overlap(&self, outward: Vec3) -> Vec2 {
        Vec2::splat(self.thickness * outward.abs().dot(Vec3::new(0.4, 0.6, 0.5)))
    }

    /// Adds the slabs with their materials, in the order of [`SLABS`].
    pub fn add(&self, scene: &mut Scene, materials: [usize; 6]) {
        for ((name, outward), material) in SLABS.into_iter().zip(materials) {
            let axis = outward.abs();
            let along = 2.0 * (self.half + self.overlap(outward).x);
            let size = along * (Vec3::ONE - axis) + self.thickness * axis;
            let middle = self.middle + outward * (self.half.dot(axis) + 0.5 * self.thickness);
            add(scene, name, shape::block(size, 0.0, 1), material, Affine3A::from_translation(middle));
        }
    }
}

/// A lamp: a glowing pane on a dark flat box. `position` is the middle of the pane, `facing` where it shines.
pub fn add_panel(scene: &mut Scene, name: &str, position: Vec3, facing: Vec3, size: Vec2, radiance: Vec3) {
    let placed = Affine3A::from_rotation_translation(Quat::from_rotation_arc(Vec3::Z, facing), position);
    let glow = Material {
        name: name.into(),
        base_color: Vec3::splat(0.02),
        emission: radiance,
        roughness: 0.5,
        ..Material::default()
    };
    let glow = add_material(scene, glow);
    add(scene, name, shape::plane(size.x, size.y), glow, placed);
    let housing = add_material(scene, paint(&format!("{name}-housing"), Vec3::splat(0.3)));
    // The pane lies 3 mm before its box, which is 12 mm wider all around.
    let depth = 0.02;
    let body = shape::block((size + 0.024).extend(depth), 0.004, 2);
    let behind = Affine3A::from_translation(Vec3::new(0.0, 0.0, -0.003 - 0.5 * depth));
    add(scene, &format!("{name}-housing"), body, housing, placed * behind);
}

/// A ball that glows on all sides.
pub fn add_glowing_ball(scene: &mut Scene, name: &str, position: Vec3, radius: f32, radiance: Vec3) {
    let glow = Material { name: name.into(), base_color: Vec3::splat(0.02), emission: radiance, ..Material::default() };
    let glow = add_material(scene, glow);
    add(scene, name, shape::sphere(radius, 20), glow, Affine3A::from_translation(position));
}

/// What stands for the light of a closed room where a method knows of far light only: no ray inside reaches it. From
/// `below` to `above`, each the mean radiance that comes from there.
pub fn ambient(below: Vec3, above: Vec3) -> Option<Arc<Environment>> {
    let (width, height) = (16, 8);
    let texels = (0..width * height).map(|i| above.lerp(below, (i / width) as f32 / (height - 1) as f32)).collect();
    Some(Arc::new(Environment::new("ambient", width, height, texels)))
}

/// Value of a declared vector.
pub fn vector(settings: &Settings, key: &str) -> Vec3 {
    match settings.get(key) {
        Some(ParamValue::Vector(value)) => Vec3::from_array(value.map(|v| v as f32)),
        other => {
            debug_assert!(false, "`{key}` is declared as a vector, not {other:?}");
            Vec3::ZERO
        }
    }
}
