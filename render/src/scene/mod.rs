//! The scene in GPU memory: vertices, instances, materials with their textures, and how they are drawn.

mod geometry;
mod material;

use std::sync::Arc;

use burnish_core::material::AlphaMode;
use burnish_core::scene::Scene;
use glam::{Mat3, Mat4, Vec3};

use crate::device::Gpu;
use crate::error::RenderError;
use crate::layout::types::{InstanceData, MaterialData};
use crate::pass::MeshPipelines;
use crate::probes::Lighting;
use crate::tables::Tables;

pub use geometry::{Geometry, VERTEX_ATTRIBUTES, VERTEX_STRIDE};
pub(crate) use material::MaterialGroups;
pub use material::material_layout;

/// One call of the device: a range of indices of one instance.
#[derive(Clone, Debug)]
pub struct Draw {
    /// Index of the instance, also `instance_index`.
    pub instance: u32,
    /// Index of the material.
    pub material: usize,
    /// Range in the index buffer.
    pub indices: std::ops::Range<u32>,
    /// Added to every index.
    pub base_vertex: i32,
    /// Which pipeline variant draws it.
    pub variant: Variant,
    /// Drawn by the forward pass.
    pub blended: bool,
    /// Needs the fragment stage to write depth.
    pub masked: bool,
    /// World centre, for sorting.
    pub center: Vec3,
}

/// Rasteriser state of a draw, and what its shader need not do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Variant {
    /// Drawn from both sides.
    pub double_sided: bool,
    /// The transform turns the winding round.
    pub mirrored: bool,
    /// The material has procedural bumps. A software rasteriser computes both sides of a branch, so that others would
    /// pay for them.
    pub bumpy: bool,
}

impl Variant {
    /// All of them; `index` gives the place in this list.
    pub const ALL: [Variant; 8] = {
        let mut all = [Variant { double_sided: false, mirrored: false, bumpy: false }; 8];
        let mut i = 0;
        while i < all.len() {
            all[i] = Variant { bumpy: i & 4 != 0, double_sided: i & 2 != 0, mirrored: i & 1 != 0 };
            i += 1;
        }
        all
    };

    /// Place in [`Variant::ALL`].
    pub fn index(self) -> usize {
        4 * usize::from(self.bumpy) + 2 * usize::from(self.double_sided) + usize::from(self.mirrored)
    }

    /// Culling and winding.
    pub fn primitive(self) -> wgpu::PrimitiveState {
        wgpu::PrimitiveState {
            front_face: if self.mirrored { wgpu::FrontFace::Cw } else { wgpu::FrontFace::Ccw },
            cull_mode: if self.double_sided { None } else { Some(wgpu::Face::Back) },
            ..Default::default()
        }
    }
}

/// Buffers and bind groups of a scene. Parts that a changed scene leaves as they were are shared with the scene before.
pub struct GpuScene {
    pub(crate) geometry: Arc<Geometry>,
    pub(crate) instances: wgpu::Buffer,
    pub(crate) materials: wgpu::Buffer,
    pub(crate) material_groups: Vec<wgpu::BindGroup>,
    pub(crate) draws: Vec<Draw>,
}

impl GpuScene {
    /// Uploads a valid scene, less what `before` already holds. Fails when a buffer would be larger than the device
    /// allows.
    pub(crate) fn new(
        gpu: &Gpu,
        groups: &mut MaterialGroups,
        scene: &Scene,
        tables: &Tables,
        lighting: &Lighting,
        before: Option<&GpuScene>,
    ) -> Result<GpuScene, RenderError> {
        let instances = instance_list(scene, lighting);
        check_size(gpu, "instances", size_of_val(instances.as_slice()) as u64)?;
        let materials: Vec<MaterialData> = material::material_list(scene, tables);
        check_size(gpu, "materials", size_of_val(materials.as_slice()) as u64)?;
        check_size(gpu, "tables of metals", size_of_val(tables.floats.as_slice()) as u64)?;
        let geometry = match before {
            Some(before) if before.geometry.holds(&scene.meshes) => before.geometry.clone(),
            _ => Arc::new(Geometry::new(gpu, &scene.meshes)?),
        };
        let storage = wgpu::BufferUsages::STORAGE;
        Ok(GpuScene {
            instances: gpu.buffer("instances", bytemuck::cast_slice(&instances), storage),
            materials: gpu.buffer("materials", bytemuck::cast_slice(&materials), storage),
            material_groups: groups.of(gpu, scene),
            draws: draw_list(scene, &geometry),
            geometry,
        })
    }
}

/// Every visible instance.
fn draw_list(scene: &Scene, geometry: &Geometry) -> Vec<Draw> {
    let visible = scene.instances.iter().enumerate().filter(|(_, instance)| instance.visible);
    let draws = visible.map(|(index, instance)| {
        let material = &scene.materials[instance.material];
        let range = &geometry.ranges[instance.mesh];
        let mirrored = instance.world_from_local.matrix3.determinant() < 0.0;
        Draw {
            instance: index as u32,
            material: instance.material,
            indices: range.indices.clone(),
            base_vertex: range.base_vertex,
            variant: Variant { double_sided: material.double_sided, mirrored, bumpy: material::is_bumpy(material) },
            blended: material.alpha_mode == AlphaMode::Blend,
            masked: matches!(material.alpha_mode, AlphaMode::Mask { .. }),
            center: instance.world_from_local.transform_point3(range.center),
        }
    });
    draws.collect()
}

/// Every instance, the hidden ones too: draws name them by their index. Never empty.
fn instance_list(scene: &Scene, lighting: &Lighting) -> Vec<InstanceData> {
    let data = |(index, i): (usize, &burnish_core::scene::Instance)| InstanceData {
        probes: lighting.serving(index as u32),
        ..instance_data(i.world_from_local.into(), i.material)
    };
    let mut instances: Vec<_> = scene.instances.iter().enumerate().map(data).collect();
    if instances.is_empty() {
        instances.push(instance_data(Mat4::IDENTITY, 0));
    }
    instances
}

/// Fails where a storage buffer of so many bytes cannot be bound.
pub(crate) fn check_size(gpu: &Gpu, what: &str, bytes: u64) -> Result<(), RenderError> {
    let limits = gpu.device.limits();
    let allowed = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size);
    if bytes > allowed {
        return Err(RenderError::TooLarge { what: what.into(), bytes, allowed });
    }
    Ok(())
}

/// Transform of an instance with its inverse transpose for normals.
fn instance_data(world_from_local: Mat4, material: usize) -> InstanceData {
    let linear = Mat3::from_mat4(world_from_local);
    // Cofactors times the sign of the determinant: the inverse transpose up to a positive factor, without dividing.
    let (x, y, z) = (linear.x_axis, linear.y_axis, linear.z_axis);
    let sign = if linear.determinant() < 0.0 { -1.0 } else { 1.0 };
    InstanceData {
        world_from_local,
        normal0: (sign * y.cross(z)).extend(sign),
        normal1: (sign * z.cross(x)).extend(0.0),
        normal2: (sign * x.cross(y)).extend(0.0),
        material: material as u32,
        probes: 0,
        pad1: 0,
        pad2: 0,
    }
}

impl GpuScene {
    /// Binds group 0 and the vertex and index buffers.
    pub(crate) fn bind(&self, pass: &mut wgpu::RenderPass, scene_group: &wgpu::BindGroup) {
        pass.set_bind_group(0, scene_group, &[]);
        pass.set_vertex_buffer(0, self.geometry.vertices.slice(..));
        pass.set_index_buffer(self.geometry.indices.slice(..), wgpu::IndexFormat::Uint32);
    }

    /// Draws one instance with its textures at group 1.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass, draw: &Draw) {
        pass.set_bind_group(1, &self.material_groups[draw.material], &[]);
        pass.draw_indexed(draw.indices.clone(), draw.base_vertex, draw.instance..draw.instance + 1);
    }

    /// Draws every instance that is wanted, variant by variant.
    pub(crate) fn draw_all(
        &self,
        pass: &mut wgpu::RenderPass,
        pipelines: &MeshPipelines,
        wanted: impl Fn(&Draw) -> bool,
    ) {
        for variant in Variant::ALL {
            let mut draws = self.draws.iter().filter(|draw| draw.variant == variant && wanted(draw)).peekable();
            if draws.peek().is_some() {
                pass.set_pipeline(pipelines.get(variant));
            }
            for draw in draws {
                self.draw(pass, draw);
            }
        }
    }

    /// Group 0 with the given view.
    pub(crate) fn group(
        &self,
        device: &wgpu::Device,
        layout: &wgpu::BindGroupLayout,
        view: &wgpu::Buffer,
    ) -> wgpu::BindGroup {
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("scene"),
            layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: view.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: self.instances.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 2, resource: self.materials.as_entire_binding() },
            ],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_variant_stands_at_its_index() {
        for (place, variant) in Variant::ALL.into_iter().enumerate() {
            assert_eq!(variant.index(), place);
        }
    }
}
