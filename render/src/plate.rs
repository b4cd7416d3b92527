//! A finished picture on a screen: radiance that something else computed, through the display transform.

use std::sync::Arc;

use burnish_core::picture::Picture;
use glam::UVec2;

use crate::device::Gpu;
use crate::error::RenderError;
use crate::pass::display::{self, Display, Shown};
use crate::pass::target;
use crate::passes::Passes;
use crate::renderer::check_size;

/// A picture of the CPU on a screen.
pub struct Plate {
    passes: Arc<Passes>,
    size: UVec2,
    /// Scene-linear radiance, and what the screen shows of it.
    textures: Option<(wgpu::Texture, wgpu::TextureView)>,
    /// What the textures hold.
    shown: Option<(Arc<Picture>, Display)>,
}

impl Plate {
    /// An empty plate on the device of the passes.
    pub fn new(passes: &Arc<Passes>) -> Plate {
        Plate { passes: passes.clone(), size: UVec2::ZERO, textures: None, shown: None }
    }

    /// Shows a picture; only what differs from the last call is done anew.
    pub fn draw(&mut self, picture: &Arc<Picture>, display: Display) -> Result<(), RenderError> {
        let passes = self.passes.clone();
        let gpu = &passes.gpu;
        gpu.check()?;
        let size = UVec2::new(picture.width, picture.height);
        check_size(gpu, size)?;
        debug_assert!(picture.is_whole());
        let known = self.shown.as_ref();
        let loaded = known.is_some_and(|(old, ..)| Arc::ptr_eq(old, picture));
        if loaded && known.is_some_and(|(_, last)| *last == display) {
            return Ok(());
        }
        if size != self.size {
            (self.textures, self.size) = (None, size);
        }
        let (radiance, output) = self.textures.get_or_insert_with(|| textures(gpu, size));
        if !loaded && picture.is_whole() {
            upload(gpu, radiance, picture);
        }
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let shown = Shown { sum: &radiance.create_view(&Default::default()), frames: 1, before: None };
        passes.display.encode(gpu, &mut encoder, shown, output, display);
        gpu.queue.submit([encoder.finish()]);
        self.shown = Some((picture.clone(), display));
        Ok(gpu.check()?)
    }

    /// As [`Viewport::output`](crate::Viewport::output): sRGB-encoded bytes; another texture when the size changes.
    pub fn output(&self) -> Option<&wgpu::TextureView> {
        self.textures.as_ref().map(|(_, output)| output)
    }
}

fn textures(gpu: &Gpu, size: UVec2) -> (wgpu::Texture, wgpu::TextureView) {
    let radiance = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("plate radiance"),
        size: wgpu::Extent3d { width: size.x, height: size.y, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    (radiance, target(gpu, "plate", size, display::FORMAT).create_view(&Default::default()))
}

fn upload(gpu: &Gpu, texture: &wgpu::Texture, picture: &Picture) {
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(picture.width * 16),
        rows_per_image: Some(picture.height),
    };
    let bytes = bytemuck::cast_slice(&picture.texels);
    gpu.queue.write_texture(texture.as_image_copy(), bytes, layout, texture.size());
}
