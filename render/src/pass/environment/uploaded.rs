//! Cubes that the processor made.

use burnish_core::lighting::Prepared;
use burnish_core::lighting::classical::{PreparedMaps, Source};
use burnish_core::lighting::cube_map::CubeMap;
use glam::Vec3;
use half::f16;

use super::EnvironmentMaps;
use super::resources::{cube, face_of, source_buffer};
use crate::device::Gpu;

impl EnvironmentMaps {
    /// The cubes of a preparation, see [`PreparedMaps::unturned`]; `None` where it has none.
    pub fn uploaded(gpu: &Gpu, prepared: &Prepared) -> Option<EnvironmentMaps> {
        let maps = PreparedMaps::unturned(prepared)?;
        let scale = maps.scale();
        let sources: Vec<Source> = maps.stored_sources().collect();
        let [radiance, dimmed, prefiltered, irradiance] = maps.cubes();
        let upload = |label, map: &CubeMap<'_>| upload(gpu, label, map);
        Some(EnvironmentMaps {
            radiance: upload("radiance", radiance),
            prefiltered: upload("prefiltered", prefiltered),
            dimmed: upload("dimmed", dimmed),
            irradiance: upload("irradiance", irradiance),
            // They are stored over the scale already.
            sources: source_buffer(gpu, &sources, 1.0),
            source_count: sources.len() as u32,
            wide_alpha: burnish_core::lighting::classical::Maps::wide_alpha(&maps),
            scale,
        })
    }
}

fn upload(gpu: &Gpu, label: &str, map: &CubeMap<'_>) -> wgpu::Texture {
    let texture = cube(gpu, label, map.edge(0), map.levels());
    for level in 0..map.levels() {
        let edge = map.edge(level);
        for face in 0..6 {
            let places = (0..edge * edge).map(|i| map.texel(level, face, i % edge, i / edge));
            let texels: Vec<[f16; 4]> = places.map(|Vec3 { x, y, z }| [x, y, z, 1.0].map(f16::from_f32)).collect();
            gpu.queue.write_texture(
                face_of(&(texture.clone(), level), face),
                bytemuck::cast_slice(&texels),
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(8 * edge), rows_per_image: Some(edge) },
                wgpu::Extent3d { width: edge, height: edge, depth_or_array_layers: 1 },
            );
        }
    }
    texture
}
