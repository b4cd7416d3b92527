//! Facts about the path tracer: scenes whose light is known, furnaces, samplers.

mod closed;
mod furnace;
mod lamps;
mod lobes;
mod paths;

use std::sync::Arc;

use glam::{Affine3A, DVec3, UVec2, Vec3};

use super::{Control, Film, Options, Pass, View, World, trace};
use crate::material::{Material, Reflectance};
use crate::scene::{Camera, Environment, Instance, Mesh, Scene};
use crate::surface::fresnel::{Fresnel, TABLE_SIZE};

/// A scene of meshes with their materials.
fn scene(parts: impl IntoIterator<Item = (Mesh, Material)>) -> Scene {
    let mut scene = Scene::default();
    for (index, (mesh, material)) in parts.into_iter().enumerate() {
        scene.meshes.push(Arc::new(mesh));
        scene.materials.push(material);
        scene.instances.push(Instance {
            name: format!("part {index}"),
            mesh: index,
            material: index,
            world_from_local: Affine3A::IDENTITY,
            visible: true,
        });
    }
    scene
}

/// Lambert, seen from both sides.
fn matte(albedo: Vec3) -> Material {
    Material { base_color: albedo, specular: 0.0, double_sided: true, ..Material::default() }
}

/// A metal that reflects the same at every angle, seen from both sides.
fn even_metal(reflectance: Vec3, roughness: f32) -> Material {
    let fresnel = Arc::new(Fresnel::Spectral { table: Box::new([reflectance; TABLE_SIZE]) });
    let reflectance = Reflectance::Preset { id: "even".into(), fresnel };
    Material { reflectance, roughness, double_sided: true, ..Material::default() }
}

/// Even light from everywhere.
fn even_sky(radiance: Vec3) -> Option<Arc<Environment>> {
    Some(Arc::new(Environment::new("even", 4, 2, vec![radiance; 8])))
}

fn view(eye: Vec3, target: Vec3, size: u32, seed: u32) -> View {
    View { camera: Camera::look_at("test", eye, target, 1.2), size: UVec2::splat(size), seed }
}

/// Traces a small picture.
fn film(scene: Scene, options: Options, view: &View, samples: u32) -> Film {
    let world = World::new(&Arc::new(scene), options);
    let mut film = Film::new(view.size);
    assert_eq!(trace(&world, view, &mut film, samples, &Control::default()), Pass::Whole);
    film
}

/// Mean radiance of a picture.
fn mean(film: &Film) -> DVec3 {
    film.pixels().iter().map(|pixel| pixel.mean).sum::<DVec3>() / film.pixels().len() as f64
}
