//! Images of materials as textures with mips, and their samplers.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use burnish_core::color::rgb::{linear_from_srgb, srgb_from_linear};
use burnish_core::material::{Filter, Sampler, Wrap};
use burnish_core::scene::{Image, Texels};
use glam::Vec3;
use half::f16;

use crate::device::Gpu;

/// Textures already uploaded, by image and encoding.
pub struct TextureCache {
    /// By address; the image beside the view keeps it taken.
    views: HashMap<(usize, bool), (Arc<Image>, Arc<wgpu::TextureView>)>,
    samplers: HashMap<Sampler, wgpu::Sampler>,
    white: Arc<wgpu::TextureView>,
}

impl TextureCache {
    /// Holds nothing but a white texel.
    pub fn new(gpu: &Gpu) -> TextureCache {
        let level = Level { width: 1, height: 1, texels: vec![[1.0; 4]] };
        let white = upload(gpu, "white", level, Encoding::Linear8);
        TextureCache { views: HashMap::new(), samplers: HashMap::new(), white }
    }

    /// Bound where a material has no texture.
    pub fn white(&self) -> Arc<wgpu::TextureView> {
        self.white.clone()
    }

    /// The image as texture; sRGB images are decoded when they are sampled.
    pub fn view(&mut self, gpu: &Gpu, image: &Arc<Image>, srgb: bool) -> Arc<wgpu::TextureView> {
        let (_, view) = self.views.entry((address(image), srgb)).or_insert_with(|| {
            let encoding = match (&image.texels, srgb) {
                (Texels::Unorm8(_), true) => Encoding::Srgb8,
                (Texels::Unorm8(_), false) => Encoding::Linear8,
                (Texels::Unorm16(_), _) => Encoding::Half,
            };
            (image.clone(), upload(gpu, &image.name, first_level(image, srgb), encoding))
        });
        view.clone()
    }

    /// Forgets textures of all other images.
    pub fn retain(&mut self, images: &[Arc<Image>]) {
        let kept: HashSet<_> = images.iter().map(address).collect();
        self.views.retain(|(image, _), _| kept.contains(image));
    }

    /// The sampler with these settings.
    pub fn sampler(&mut self, gpu: &Gpu, sampler: Sampler) -> wgpu::Sampler {
        self.samplers.entry(sampler).or_insert_with(|| create_sampler(gpu, sampler)).clone()
    }
}

fn address(image: &Arc<Image>) -> usize {
    Arc::as_ptr(image).addr()
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

/// The image in linear floats, so that mips average light and not code values.
fn first_level(image: &Image, srgb: bool) -> Level {
    let decode = |rgba: [f32; 4]| {
        let [r, g, b, a] = rgba;
        if srgb { linear_from_srgb(Vec3::new(r, g, b)).extend(a).to_array() } else { rgba }
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

impl Level {
    /// The next level of the chain down to one texel, `None` after that.
    fn next(&self) -> Option<Level> {
        if self.width <= 1 && self.height <= 1 {
            return None;
        }
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let texels = places.map(|(x, y)| box_average(self, x, y, width, height)).collect();
        Some(Level { width, height, texels })
    }
}

/// Mean of the fine texels that a coarse one covers; odd edges spread over three.
fn box_average(fine: &Level, x: u32, y: u32, width: u32, height: u32) -> [f32; 4] {
    let span = |i: u32, n: u32, m: u32| {
        let (i, n, m) = (u64::from(i), u64::from(n), u64::from(m));
        ((i * m / n) as u32, ((i + 1) * m).div_ceil(n).min(m) as u32)
    };
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
            Encoding::Srgb8 => {
                let encode = |[r, g, b, a]: &[f32; 4]| srgb_from_linear(Vec3::new(*r, *g, *b)).extend(*a).to_array();
                level.texels.iter().flat_map(|t| encode(t).map(unorm)).collect()
            }
            Encoding::Half => {
                let halves: Vec<f16> = level.texels.iter().flat_map(|t| t.map(f16::from_f32)).collect();
                bytemuck::cast_slice(&halves).to_vec()
            }
        }
    }
}

/// Uploads the level and all below it, one in memory at a time. An image larger than the device allows starts at the
/// first level that fits.
fn upload(gpu: &Gpu, label: &str, mut level: Level, encoding: Encoding) -> Arc<wgpu::TextureView> {
    let allowed = gpu.device.limits().max_texture_dimension_2d;
    while level.width.max(level.height) > allowed
        && let Some(next) = level.next()
    {
        level = next;
    }
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: level.width, height: level.height, depth_or_array_layers: 1 },
        mip_level_count: level.width.max(level.height).ilog2() + 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: encoding.format(),
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let texel_bytes = if encoding == Encoding::Half { 8 } else { 4 };
    let mut next = Some(level);
    let mut mip_level = 0;
    while let Some(level) = next {
        gpu.queue.write_texture(
            wgpu::TexelCopyTextureInfo { mip_level, ..texture.as_image_copy() },
            &encoding.bytes(&level),
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(level.width * texel_bytes),
                rows_per_image: Some(level.height),
            },
            wgpu::Extent3d { width: level.width, height: level.height, depth_or_array_layers: 1 },
        );
        next = level.next();
        mip_level += 1;
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
        // 0.25 and not 0: at 0 the magnification filter would always be taken.
        lod_max_clamp: if sampler.mip.is_some() { 32.0 } else { 0.25 },
        // Anisotropic filtering is allowed with linear filters only. llvmpipe 22.3 draws blocks and seams with it.
        anisotropy_clamp: if all_linear && !gpu.is_software() { 8 } else { 1 },
        ..Default::default()
    })
}
