//! What a probe sees of a scene, and what all of its probes see of it.

use std::sync::Arc;

use glam::Affine3A;

use super::Sites;
use crate::material::Material;
use crate::scene::{Background, Light, Mesh, Probe, Scene};

/// The scene without what a probe serves, as surfaces see it: lamps light it but are not seen, as their light is added at
/// each point; behind everything is the environment, whatever the eye sees there.
pub fn surroundings(scene: &Scene, served: &[u32]) -> Scene {
    let mut around = scene.clone();
    served.iter().for_each(|i| around.instances[*i as usize].visible = false);
    around.background = Background::default();
    around.lights = around.lights.into_iter().map(|light| Light { camera: false, ..light }).collect();
    around
}

/// The scene less all that no probe sees: objects that all of them leave out with the materials of these alone, names of lights,
/// cameras. Where two scenes agree in it, so do their probes.
pub(in crate::lighting) fn read(scene: &Scene, sites: &Sites) -> Scene {
    let unseen = |i: usize| sites.list.iter().all(|site| site.served.binary_search(&(i as u32)).is_ok());
    let mut seen = surroundings(scene, &[]);
    let nothing = Arc::new(Mesh::default());
    let mut used = vec![false; seen.materials.len()];
    for (i, instance) in seen.instances.iter_mut().enumerate() {
        if !unseen(i) && instance.visible {
            used[instance.material] = true;
            continue;
        }
        (instance.visible, instance.world_from_local, instance.mesh) = (false, Affine3A::IDENTITY, seen.meshes.len());
        instance.material = 0;
    }
    seen.meshes.push(nothing.clone());
    for (i, mesh) in seen.meshes.iter_mut().enumerate() {
        if !seen.instances.iter().any(|instance| instance.mesh == i) {
            *mesh = nothing.clone();
        }
    }
    let unused = seen.materials.iter_mut().zip(used).filter(|(_, used)| !used);
    unused.for_each(|(material, _)| *material = Material::default());
    let probe = |site: &super::Site| Probe {
        name: String::new(),
        position: Some(site.middle),
        extent: Some(site.half),
        resolution: Some(site.face),
        source: site.source,
        paths: Some(site.paths),
        serves: site.served.iter().map(|i| *i as usize).collect(),
    };
    seen.probes = sites.list.iter().map(probe).collect();
    seen
}
