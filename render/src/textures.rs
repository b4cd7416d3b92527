//! Images of materials as textures with mips, and their samplers.

use std::collections::HashMap;
use std::sync::Arc;

use burnish_core::material::{Filter, Sampler, Wrap};
use burnish_core::scene::{Image, Texels};
use half::f16;

use crate::device::Gpu;

/// Textures already uploaded, by image and encoding.
pub struct TextureCache {
    views: HashMap<(usize, bool), Arc<wgpu::TextureView>>,
    samplers: HashMap<Sampler, wgpu::Sampler>,
    white: Arc<wgpu::TextureView>,
}

impl TextureCache {
    /// Holds nothing but a white texel.
    pub fn new(gpu: &Gpu) -> TextureCache {
        let level = Level { width: 1, height: 1, texels: vec![[1.0; 4]] };
        let white = upload(gpu, "white", &[level], Encoding::Linear8);
        TextureCache { views: HashMap::new(), samplers: HashMap::new(), white }
    }

    /// Bound where a material has no texture.
    pub fn white(&self) -> Arc<wgpu::TextureView> {
        self.white.clone()
    }

    /// The image as texture; sRGB images are decoded when they are sampled.
    pub fn view(&mut self, gpu: &Gpu, index: usize, image: &Image, srgb: bool) -> Arc<wgpu::TextureView> {
        self.views
            .entry((index, srgb))
            .or_insert_with(|| {
                let encoding = match (&image.texels, srgb) {
                    (Texels::Unorm8(_), true) => Encoding::Srgb8,
                    (Texels::Unorm8(_), false) => Encoding::Linear8,
                    (Texels::Unorm16(_), _) => Encoding::Half,
                };
                let allowed = gpu.device.limits().max_texture_dimension_2d;
                let mut levels = mips(first_level(image, srgb));
                // An image larger than the device allows starts at the first level that fits.
                levels.retain(|level| level.width.max(level.height) <= allowed);
                upload(gpu, &image.name, &levels, encoding)
            })
            .clone()
    }

    /// The sampler with these settings.
    pub fn sampler(&mut self, gpu: &Gpu, sampler: Sampler) -> wgpu::Sampler {
        self.samplers.entry(sampler).or_insert_with(|| create_sampler(gpu, sampler)).clone()
    }
}

/// How texels are stored.
#[derive(Clone, Copy, PartialEq)]
enum Encoding {
    Srgb8,
    Linear8,
    Half,
}

/// A mip level in linear floats.
struct Level {
    width: u32,
    height: u32,
    texels: Vec<[f32; 4]>,
}

fn linear_from_srgb(x: f32) -> f32 {
    if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}

fn srgb_from_linear(x: f32) -> f32 {
    if x <= 0.0031308 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

/// The image in linear floats, so that mips average light and not code values.
fn first_level(image: &Image, srgb: bool) -> Level {
    let decode = |rgba: [f32; 4]| {
        let [r, g, b, a] = rgba;
        if srgb { [linear_from_srgb(r), linear_from_srgb(g), linear_from_srgb(b), a] } else { rgba }
    };
    let texels = match &image.texels {
        Texels::Unorm8(bytes) => {
            let (chunks, _) = bytes.as_chunks::<4>();
            chunks.iter().map(|c| decode(c.map(|v| f32::from(v) / 255.0))).collect()
        }
        Texels::Unorm16(words) => {
            let (chunks, _) = words.as_chunks::<4>();
            chunks.iter().map(|c| decode(c.map(|v| f32::from(v) / 65535.0))).collect()
        }
    };
    Level { width: image.width, height: image.height, texels }
}

/// The chain down to one texel, each level the box average of the one before.
fn mips(first: Level) -> Vec<Level> {
    let mut levels = vec![first];
    while let Some(fine) = levels.last()
        && (fine.width > 1 || fine.height > 1)
    {
        let (width, height) = ((fine.width / 2).max(1), (fine.height / 2).max(1));
        let mut texels = Vec::with_capacity((width * height) as usize);
        for y in 0..height {
            for x in 0..width {
                texels.push(box_average(fine, x, y, width, height));
            }
        }
        levels.push(Level { width, height, texels });
    }
    levels
}

/// Mean of the fine texels that a coarse one covers; odd edges spread over three.
fn box_average(fine: &Level, x: u32, y: u32, width: u32, height: u32) -> [f32; 4] {
    let span = |i: u32, n: u32, m: u32| (i * m / n, ((i + 1) * m).div_ceil(n).min(m));
    let (x0, x1) = span(x, width, fine.width);
    let (y0, y1) = span(y, height, fine.height);
    let mut sum = [0.0; 4];
    for v in y0..y1 {
        for u in x0..x1 {
            let texel = fine.texels[(v * fine.width + u) as usize];
            sum = std::array::from_fn(|c| sum[c] + texel[c]);
        }
    }
    let count = ((x1 - x0) * (y1 - y0)) as f32;
    sum.map(|s| s / count)
}

impl Encoding {
    fn format(self) -> wgpu::TextureFormat {
        match self {
            Encoding::Srgb8 => wgpu::TextureFormat::Rgba8UnormSrgb,
            Encoding::Linear8 => wgpu::TextureFormat::Rgba8Unorm,
            Encoding::Half => wgpu::TextureFormat::Rgba16Float,
        }
    }

    fn bytes(self, level: &Level) -> Vec<u8> {
        let unorm = |x: f32| (x.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
        match self {
            Encoding::Linear8 => level.texels.iter().flat_map(|t| t.map(unorm)).collect(),
            Encoding::Srgb8 => level
                .texels
                .iter()
                .flat_map(|[r, g, b, a]| {
                    [*r, *g, *b].map(|x| unorm(srgb_from_linear(x))).into_iter().chain([unorm(*a)])
                })
                .collect(),
            Encoding::Half => {
                let halves: Vec<f16> = level.texels.iter().flat_map(|t| t.map(f16::from_f32)).collect();
                bytemuck::cast_slice(&halves).to_vec()
            }
        }
    }
}

fn upload(gpu: &Gpu, label: &str, levels: &[Level], encoding: Encoding) -> Arc<wgpu::TextureView> {
    let (width, height) = levels.first().map_or((1, 1), |l| (l.width, l.height));
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: levels.len().max(1) as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: encoding.format(),
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (index, level) in levels.iter().enumerate() {
        let texel_bytes = if encoding == Encoding::Half { 8 } else { 4 };
        gpu.queue.write_texture(
            wgpu::TexelCopyTextureInfo { mip_level: index as u32, ..texture.as_image_copy() },
            &encoding.bytes(level),
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(level.width * texel_bytes),
                rows_per_image: Some(level.height),
            },
            wgpu::Extent3d { width: level.width, height: level.height, depth_or_array_layers: 1 },
        );
    }
    Arc::new(texture.create_view(&Default::default()))
}

fn create_sampler(gpu: &Gpu, sampler: Sampler) -> wgpu::Sampler {
    let wrap = |w| match w {
        Wrap::Repeat => wgpu::AddressMode::Repeat,
        Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
        Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
    };
    let filter = |f| match f {
        Filter::Nearest => wgpu::FilterMode::Nearest,
        Filter::Linear => wgpu::FilterMode::Linear,
    };
    let all_linear =
        sampler.magnify == Filter::Linear && sampler.minify == Filter::Linear && sampler.mip == Some(Filter::Linear);
    gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("material"),
        address_mode_u: wrap(sampler.wrap_u),
        address_mode_v: wrap(sampler.wrap_v),
        mag_filter: filter(sampler.magnify),
        min_filter: filter(sampler.minify),
        mipmap_filter: match sampler.mip {
            Some(Filter::Linear) => wgpu::MipmapFilterMode::Linear,
            _ => wgpu::MipmapFilterMode::Nearest,
        },
        lod_max_clamp: if sampler.mip.is_some() { 32.0 } else { 0.0 },
        // Anisotropic filtering is allowed with linear filters only. llvmpipe 22.3 draws blocks and seams with it.
        anisotropy_clamp: if all_linear && !gpu.is_software() { 8 } else { 1 },
        ..Default::default()
    })
}
