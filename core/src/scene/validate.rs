//! What every renderer may rely on in a [`Scene`], checked.

use std::f32::consts::FRAC_PI_2;

use glam::{Vec2, Vec3, Vec4};

use super::{Environment, Image, Instance, Light, LightKind, Mesh, Scene, Texels};
use crate::material::{Material, TextureRef};
use crate::surface::micro_normal;

/// A unit vector stored in f32, after interpolation of rounding through an exporter, is this close to length 1.
const UNIT_TOLERANCE: f32 = 1e-3;

/// A broken promise of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Place in the scene, such as `mesh 3 'body'`.
    pub element: String,
    /// What is wrong.
    pub cause: String,
}

impl Scene {
    /// Checks indices, lengths of attribute lists, finiteness and unit vectors. Lists every fault, one per element and
    /// kind.
    pub fn validate(&self) -> Result<(), Vec<Fault>> {
        let mut faults = Faults(Vec::new());
        for (i, mesh) in self.meshes.iter().enumerate() {
            check_mesh(mesh, &mut faults.at(format!("mesh {i} '{}'", mesh.name)));
        }
        for (i, instance) in self.instances.iter().enumerate() {
            check_instance(self, instance, &mut faults.at(format!("instance {i} '{}'", instance.name)));
        }
        for (i, material) in self.materials.iter().enumerate() {
            check_material(self, material, &mut faults.at(format!("material {i} '{}'", material.name)));
        }
        for (i, image) in self.images.iter().enumerate() {
            check_image(image, &mut faults.at(format!("image {i} '{}'", image.name)));
        }
        for (i, light) in self.lights.iter().enumerate() {
            check_light(self, light, &mut faults.at(format!("light {i} '{}'", light.name)));
        }
        for (i, camera) in self.cameras.iter().enumerate() {
            let finite = camera.world_from_view.is_finite();
            faults.at(format!("camera {i} '{}'", camera.name)).unless(finite, "the transform is not finite");
        }
        let subject = self.subject.iter().all(|i| *i < self.instances.len());
        faults.at("subject".into()).unless(subject, "an index is out of range");
        for (i, probe) in self.probes.iter().enumerate() {
            let mut at = faults.at(format!("probe {i} '{}'", probe.name));
            at.unless(probe.position.is_none_or(Vec3::is_finite), "the position is not finite");
            let sound = |extent: Vec3| extent.is_finite() && extent.min_element() > 0.0;
            at.unless(probe.extent.is_none_or(sound), "the extent is not positive");
            at.unless(probe.resolution != Some(0) && probe.paths != Some(0), "it has no texels or paths");
            at.unless(probe.serves.iter().all(|i| *i < self.instances.len()), "an index is out of range");
        }
        if let Some(environment) = &self.environment {
            check_environment(environment, &mut faults.at("environment".into()));
        }
        if let Some(map) = &self.background.map {
            check_environment(map, &mut faults.at("background".into()));
        }
        let ground = self.background.ground.is_none_or(|ground| ground.is_sound());
        faults.at("background".into()).unless(ground, "height or radius of the ground is not positive");
        if faults.0.is_empty() { Ok(()) } else { Err(faults.0) }
    }
}

struct Faults(Vec<Fault>);

impl Faults {
    fn at(&mut self, element: String) -> At<'_> {
        At { faults: &mut self.0, element }
    }
}

/// Where faults are noted for one element.
struct At<'a> {
    faults: &'a mut Vec<Fault>,
    element: String,
}

impl At<'_> {
    fn unless(&mut self, holds: bool, cause: &str) {
        if !holds {
            self.faults.push(Fault { element: self.element.clone(), cause: cause.into() });
        }
    }
}

fn unit(v: Vec3) -> bool {
    // A NaN fails the comparison.
    (v.length() - 1.0).abs() <= UNIT_TOLERANCE
}

fn check_mesh(mesh: &Mesh, at: &mut At<'_>) {
    let Mesh { name: _, positions, normals, tangents, uvs, colors, indices } = mesh;
    let count = positions.len();
    let optional = |len: usize| len == 0 || len == count;
    at.unless(positions.iter().all(|p| p.is_finite()), "a position is not finite");
    at.unless(normals.len() == count, "there is not one normal per position");
    at.unless(normals.iter().all(|n| unit(*n)), "a normal is not a unit vector");
    at.unless(tangents.len() == count, "there is not one tangent per position");
    let sound = |t: &Vec4| unit(t.truncate()) && t.w.abs() == 1.0;
    at.unless(tangents.iter().all(sound), "a tangent is not a unit vector with a sign");
    at.unless(uvs.iter().all(|uv| optional(uv.len())), "there is not one texture coordinate per position");
    at.unless(uvs.iter().flatten().all(|uv: &Vec2| uv.is_finite()), "a texture coordinate is not finite");
    at.unless(optional(colors.len()), "there is not one colour per position");
    at.unless(colors.iter().all(|c| c.is_finite()), "a colour is not finite");
    at.unless(indices.len().is_multiple_of(3), "the number of indices is not a multiple of 3");
    at.unless(indices.iter().all(|i| (*i as usize) < count), "an index is outside the list of positions");
}

fn check_instance(scene: &Scene, instance: &Instance, at: &mut At<'_>) {
    at.unless(instance.mesh < scene.meshes.len(), "the mesh does not exist");
    at.unless(instance.material < scene.materials.len(), "the material does not exist");
    at.unless(instance.world_from_local.is_finite(), "the transform is not finite");
    at.unless(instance.world_from_local.inverse().is_finite(), "the transform cannot be inverted");
}

fn check_material(scene: &Scene, material: &Material, at: &mut At<'_>) {
    let m = material;
    let sound = |t: &TextureRef| t.image < scene.images.len() && t.uv_set < 2 && t.transform.is_finite();
    at.unless(
        m.textures().iter().flatten().all(sound),
        "a texture names an image or coordinate set that does not exist",
    );
    let unit = [m.opacity, m.metallic, m.roughness, m.occlusion_strength, m.specular, m.coat, m.coat_roughness];
    at.unless(unit.iter().all(|v| (0.0..=1.0).contains(v)), "a factor is outside 0 to 1");
    at.unless((0.0..=1.0).contains(&m.anisotropy), "the anisotropy is outside 0 to 1");
    at.unless((0.0..=1.0).contains(&m.micro_depth), "the depth of the bumps is outside 0 to 1");
    let sizes = micro_normal::SIZE_MIN_MM..=micro_normal::SIZE_MAX_MM;
    at.unless(sizes.contains(&m.micro_size_mm), "the size of the bumps is outside 0.01 mm to 1 m");
    let finite = [m.normal_scale, m.coat_normal_scale, m.ior, m.anisotropy_rotation];
    at.unless(finite.iter().all(|v| v.is_finite()), "a factor is not finite");
    let colors = [m.base_color, m.emission, m.specular_color];
    at.unless(colors.iter().all(|c| c.is_finite() && c.min_element() >= 0.0), "a colour is negative or not finite");
}

fn check_image(image: &Image, at: &mut At<'_>) {
    let numbers = 4 * u64::from(image.width) * u64::from(image.height);
    let stored = match &image.texels {
        Texels::Unorm8(texels) => texels.len(),
        Texels::Unorm16(texels) => texels.len(),
    };
    at.unless(numbers > 0 && stored as u64 == numbers, "the texels do not fill the size");
}

fn check_light(scene: &Scene, light: &Light, at: &mut At<'_>) {
    at.unless(light.position.is_finite(), "the position is not finite");
    let aimless = matches!(light.kind, LightKind::Point | LightKind::Sphere { .. });
    at.unless(aimless || unit(light.direction), "the direction is not a unit vector");
    let intensity = light.intensity;
    at.unless(intensity.is_finite() && intensity.min_element() >= 0.0, "the intensity is negative or not finite");
    at.unless(light.range > 0.0, "the range is not positive");
    match light.kind {
        LightKind::Point => {}
        LightKind::Spot { inner_angle, outer_angle } => {
            let sound = 0.0 <= inner_angle && inner_angle < outer_angle && outer_angle <= FRAC_PI_2;
            at.unless(sound, "the cone angles are not 0 <= inner < outer <= pi/2");
        }
        LightKind::Directional { angular_radius } => {
            at.unless((0.0..=FRAC_PI_2).contains(&angular_radius), "the angular radius is not 0 to pi/2");
        }
        LightKind::Rectangle { across, size } => {
            let square = unit(across) && across.dot(light.direction).abs() <= UNIT_TOLERANCE;
            at.unless(square, "the side across is not a unit vector at right angles to the direction");
            at.unless(size.is_finite() && size.min_element() >= 0.0, "the size is negative or not finite");
        }
        LightKind::Sphere { radius } => {
            at.unless(radius.is_finite() && radius >= 0.0, "the radius is negative or not finite");
        }
    }
    at.unless(light.unlit.is_sorted_by(|a, b| a < b), "the instances that it does not light are not ascending");
    let known = light.unlit.iter().all(|i| *i < scene.instances.len());
    at.unless(known, "an instance that it does not light does not exist");
}

fn check_environment(environment: &Environment, at: &mut At<'_>) {
    let texels = u64::from(environment.width) * u64::from(environment.height);
    at.unless(texels > 0 && environment.texels.len() as u64 == texels, "the texels do not fill the size");
    let sound = environment.texels.iter().all(|t| t.is_finite() && t.min_element() >= 0.0);
    at.unless(sound, "a texel is negative or not finite");
    at.unless(environment.rotation.is_finite() && environment.strength >= 0.0, "rotation or strength is out of range");
    let tint = environment.tint;
    at.unless(tint.is_finite() && tint.min_element() >= 0.0, "the tint is negative or not finite");
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Affine3A;

    fn triangle() -> Scene {
        let mesh = Mesh {
            name: "body".into(),
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            normals: vec![Vec3::Z; 3],
            tangents: vec![Vec4::new(1.0, 0.0, 0.0, 1.0); 3],
            indices: vec![0, 1, 2],
            ..Mesh::default()
        };
        let instance =
            Instance { name: "i".into(), mesh: 0, material: 0, world_from_local: Affine3A::IDENTITY, visible: true };
        Scene {
            meshes: vec![mesh.into()],
            instances: vec![instance],
            materials: vec![Material::default()],
            ..Scene::default()
        }
    }

    #[test]
    fn a_sound_triangle_passes() {
        assert_eq!(triangle().validate(), Ok(()));
    }

    #[test]
    fn lights_without_size_or_power_are_sound_and_crooked_ones_are_not() {
        let with = |edit: fn(&mut Light)| {
            let mut light = Light::default();
            edit(&mut light);
            Scene { lights: vec![light], ..triangle() }.validate().map_err(|faults| faults.len())
        };
        let rectangle = |across, size| LightKind::Rectangle { across, size };
        assert_eq!(with(|l| l.kind = LightKind::Sphere { radius: 0.0 }), Ok(()));
        assert_eq!(with(|l| l.intensity = Vec3::ZERO), Ok(()));
        assert_eq!(with(|l| l.unlit = vec![0]), Ok(()));
        let narrow = rectangle(Vec3::X, Vec2::new(1.0, 0.0));
        assert_eq!(Scene { lights: vec![Light { kind: narrow, ..Light::default() }], ..triangle() }.validate(), Ok(()));
        assert_eq!(with(|l| l.kind = LightKind::Sphere { radius: f32::NAN }), Err(1));
        assert_eq!(with(|l| l.kind = LightKind::Directional { angular_radius: -0.1 }), Err(1));
        assert_eq!(with(|l| l.kind = LightKind::Rectangle { across: Vec3::Z, size: Vec2::ONE }), Err(1));
        assert_eq!(with(|l| l.kind = LightKind::Rectangle { across: Vec3::X, size: Vec2::NEG_ONE }), Err(1));
        assert_eq!(with(|l| l.unlit = vec![1]), Err(1));
        assert_eq!(with(|l| l.unlit = vec![0, 0]), Err(1));
    }

    #[test]
    fn every_fault_is_listed_with_its_element() {
        let mut scene = triangle();
        let mesh = std::sync::Arc::make_mut(&mut scene.meshes[0]);
        mesh.indices[2] = 3;
        mesh.positions[1].x = f32::NAN;
        mesh.normals[0] = Vec3::ZERO;
        mesh.tangents.pop();
        scene.instances[0].material = 9;
        scene.instances[0].world_from_local = Affine3A::from_scale(Vec3::ZERO);
        scene.materials[0].roughness = f32::NAN;
        let faults = scene.validate().unwrap_err();
        assert_eq!(faults.len(), 7, "{faults:?}");
        assert_eq!(faults[0].element, "mesh 0 'body'");
        assert!(faults.iter().any(|f| f.element.starts_with("instance 0") && f.cause.contains("material")));
    }
}
