//! What rays find, held to plain loops and to geometry.

mod agree;
mod closed;
mod edges;
mod flat;
mod leave;

use std::sync::Arc;

use glam::{Affine3A, Vec2, Vec3};

use super::{Accel, Hit, Ray, brute_force};
use crate::material::Material;
use crate::math::sampling::Random;
use crate::scene::{Instance, Mesh, Scene};

/// In the cube from -1 to 1.
fn cube(random: &mut Random) -> Vec3 {
    2.0 * random.point3() - 1.0
}

fn instance(mesh: usize, world_from_local: Affine3A) -> Instance {
    Instance { name: String::new(), mesh, material: 0, world_from_local, visible: true }
}

/// One instance for each mesh, where it is.
fn scene(meshes: impl IntoIterator<Item = Mesh>) -> Scene {
    let meshes: Vec<Arc<Mesh>> = meshes.into_iter().map(Arc::new).collect();
    Scene {
        instances: (0..meshes.len()).map(|i| instance(i, Affine3A::IDENTITY)).collect(),
        meshes,
        materials: vec![Material::default()],
        ..Scene::default()
    }
}

fn any(_: &Hit) -> bool {
    true
}

fn ray(origin: Vec3, direction: Vec3) -> Ray {
    Ray { origin, direction, t_max: f32::INFINITY }
}
