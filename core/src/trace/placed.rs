//! A mesh tree in the world.

use std::sync::Arc;

use glam::{Affine3A, DMat3, DVec3, Vec3};

use super::mesh_tree::MeshTree;
use super::walk::SLACK;
use super::{Hit, Ray};
use crate::scene::{Bounds, Instance, Scene};

/// An instance as rays see it.
#[derive(Clone, Debug)]
pub(super) struct Placed {
    /// Index into `Scene::instances`.
    pub index: u32,
    pub tree: Arc<MeshTree>,
    /// In the world, grown by what rounding may add.
    pub bounds: Bounds,
    /// By how much rounding moves a ray that is brought to the mesh, in distances from its origin.
    pub slack: f32,
    /// Brings rays to the mesh.
    pub inverse: Inverse,
}

/// Brings rays to the mesh.
#[derive(Clone, Copy, Debug)]
pub(super) enum Inverse {
    /// The instance is where its mesh is.
    Identity,
    /// A world position less `translation`, times `linear`, in double precision: what is left is the rounding of the
    /// result, however sheared or far away the instance is.
    Affine { translation: DVec3, linear: DMat3 },
}

impl Inverse {
    /// The ray in local space. Distances along it are kept: its direction is no unit vector there.
    #[inline(always)]
    pub fn local(&self, ray: &Ray) -> Ray {
        match self {
            Inverse::Identity => *ray,
            Inverse::Affine { translation, linear } => Ray {
                origin: (*linear * (ray.origin.as_dvec3() - *translation)).as_vec3(),
                direction: (*linear * ray.direction.as_dvec3()).as_vec3(),
                t_max: ray.t_max,
            },
        }
    }
}

impl Placed {
    /// The visible instances, with the trees of their meshes.
    pub fn all(scene: &Scene, of_mesh: &[Option<Arc<MeshTree>>]) -> Vec<Placed> {
        let instances = scene.instances.iter().enumerate().filter(|(_, i)| i.visible);
        let placed = instances.filter_map(|(index, instance)| {
            let tree = of_mesh.get(instance.mesh)?.as_ref()?;
            Placed::new(index as u32, instance, Arc::clone(tree))
        });
        placed.collect()
    }

    /// `None` where there is nothing to hit.
    fn new(index: u32, instance: &Instance, tree: Arc<MeshTree>) -> Option<Placed> {
        let local = tree.bounds;
        if local.is_empty() {
            return None;
        }
        let inverse = Placed::inverse(&instance.world_from_local)?;
        let Inverse::Affine { translation, linear } = inverse else {
            return Some(Placed { index, tree, bounds: local, slack: SLACK, inverse });
        };
        let matrix = instance.world_from_local.matrix3.as_dmat3();
        // By how much a step in the local space, as long as the rounding of a way, can be longer than that in the world.
        let terms = (matrix.abs() * (linear.abs() * DVec3::ONE)).max_element().max(1.0);
        let slack = SLACK * terms as f32;
        let reach = matrix.abs() * local.min.abs().max(local.max.abs()).as_dvec3();
        let grown = DVec3::splat(f64::from(slack) * reach.max_element());

        let corner = |i: u32| {
            DVec3::from_array(
                [0, 1, 2].map(|axis| f64::from(if i & (1 << axis) == 0 { local.min[axis] } else { local.max[axis] })),
            )
        };
        let mut bounds = Bounds::EMPTY;
        for p in (0..8).map(|i| matrix * corner(i) + translation) {
            bounds = bounds.including((p - grown).as_vec3()).including((p + grown).as_vec3());
        }
        bounds.min = Vec3::from_array(bounds.min.to_array().map(f32::next_down));
        bounds.max = Vec3::from_array(bounds.max.to_array().map(f32::next_up));
        Some(Placed { index, tree, bounds, slack, inverse })
    }

    /// `None` for a transform that has no inverse.
    pub fn inverse(world_from_local: &Affine3A) -> Option<Inverse> {
        if *world_from_local == Affine3A::IDENTITY {
            return Some(Inverse::Identity);
        }
        let linear = world_from_local.matrix3.as_dmat3().inverse();
        // As a ray in single precision will have it.
        let usable = linear.as_mat3().is_finite() && world_from_local.is_finite();
        usable.then(|| Inverse::Affine { translation: world_from_local.translation.as_dvec3(), linear })
    }

    /// As [`MeshTree::walk`], for a ray in the world.
    #[inline(always)]
    pub fn walk(&self, ray: &Ray, limit: &mut f32, meet: impl FnMut(Hit, &mut f32) -> bool) -> bool {
        self.tree.walk(&self.inverse.local(ray), self.index, limit, meet)
    }
}
