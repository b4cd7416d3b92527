//! Probes on the device: their cubes and distances, and which instances they serve.

use std::sync::Arc;

use burnish_core::lighting::probe::{self, Cells, Probe, Probes};
use burnish_core::lighting::{MethodId, Prepared, area_cube, impostor, radiance_map};
use burnish_core::param::Settings;

use crate::device::Gpu;
use crate::error::RenderError;
use crate::layout::types::ProbeData;
use crate::pass::environment::EnvironmentMaps;

/// What lights a picture: a method with what it prepared. One without a pass on the device, or without a preparation that it needs, is
/// `classical`.
#[derive(Clone, Debug, Default)]
pub struct Lighting {
    prepared: Option<Arc<Prepared>>,
    by: By,
}

/// How what was prepared is drawn with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum By {
    #[default]
    Impostor,
    AreaCube,
    RadianceMap,
}

impl Lighting {
    /// A method with its preparation.
    pub fn new(method: MethodId, prepared: Option<Arc<Prepared>>) -> Lighting {
        let known = [(impostor::ID, By::Impostor), (area_cube::ID, By::AreaCube), (radiance_map::ID, By::RadianceMap)];
        let by = known.into_iter().find(|(id, _)| *id == method.0).map(|(_, by)| by);
        let prepared = prepared.filter(|prepared| by.is_some() && !prepared.is_nothing());
        Lighting { prepared, by: by.unwrap_or_default() }
    }

    /// It takes the place of the environment somewhere.
    pub fn is_prepared(&self) -> bool {
        self.prepared.is_some()
    }

    /// What was prepared, where the device draws with it.
    pub fn prepared(&self) -> Option<&Arc<Prepared>> {
        self.prepared.as_ref()
    }

    /// The probes of what was prepared.
    pub(crate) fn probes(&self) -> Option<&Arc<Prepared>> {
        self.prepared.as_ref().filter(|_| self.by != By::RadianceMap)
    }

    /// The radiance map of what was prepared.
    pub(crate) fn map(&self) -> Option<&Arc<Prepared>> {
        self.prepared.as_ref().filter(|_| self.by == By::RadianceMap)
    }

    /// Bits of the probes that serve an instance.
    pub(crate) fn serving(&self, instance: u32) -> u32 {
        let Some(prepared) = self.probes() else { return 0 };
        let probes = Probes::of(prepared);
        let serving = (0..probes.len().min(probe::MOST)).filter(|index| probes.serves(*index, instance));
        serving.map(|index| 1 << index).sum()
    }

    /// The method is `area-cube`.
    pub(crate) fn is_area_cube(&self) -> bool {
        self.by == By::AreaCube
    }

    pub(crate) fn is_like(&self, other: &Lighting) -> bool {
        match (&self.prepared, &other.prepared) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b) && self.by == other.by,
            (a, b) => a.is_none() && b.is_none(),
        }
    }
}

/// How the surroundings of probes are looked up, from the settings of a method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ProbeLook {
    pub effort: impostor::Effort,
    pub show: impostor::Show,
    /// Of the method `area-cube`: texels along an edge, and what is asked of them.
    pub edge: u32,
    pub asked: area_cube::Asked,
    /// Of the method `radiance-map`.
    pub map: radiance_map::Look,
}

impl ProbeLook {
    pub fn new(settings: &Settings) -> ProbeLook {
        ProbeLook {
            effort: impostor::effort(settings),
            show: impostor::show(settings),
            edge: area_cube::edge(settings),
            asked: area_cube::asked(settings),
            map: radiance_map::Look::new(settings),
        }
    }
}

/// The probes of a preparation.
pub(crate) struct GpuProbes {
    pub prepared: Arc<Prepared>,
    /// Middle and half box of each, as the uniform of shaders.
    pub places: wgpu::Buffer,
    pub each: Vec<GpuProbe>,
}

/// One of them.
pub(crate) struct GpuProbe {
    pub maps: EnvironmentMaps,
    /// Those of its second layer.
    pub behind: Option<Behind>,
    /// What is kept of distances, an array layer for each face, those of the second layer of surfaces after the first.
    pub inverse_depths: wgpu::TextureView,
    /// Bounds of them, by levels.
    pub inverse_bounds: wgpu::TextureView,
    pub data: wgpu::Buffer,
    /// The texels of its coarse cubes, never empty.
    pub coarse: wgpu::Buffer,
}

/// The second layer of surfaces.
pub(crate) struct Behind {
    pub maps: EnvironmentMaps,
    /// As of the first; distances are with those of the first.
    pub data: wgpu::Buffer,
}

impl GpuProbes {
    pub fn new(gpu: &Gpu, prepared: &Arc<Prepared>) -> Result<GpuProbes, RenderError> {
        let probes = Probes::of(prepared);
        let mut each = Vec::with_capacity(probes.len());
        for (index, probe) in probes.iter().enumerate().take(probe::MOST) {
            each.push(GpuProbe::new(gpu, index as u32, &probe)?);
        }
        Ok(GpuProbes { prepared: prepared.clone(), places: places(gpu, probes), each })
    }
}

/// Where probes stand, as the uniform of shaders.
pub(crate) fn places(gpu: &Gpu, probes: Probes<'_>) -> wgpu::Buffer {
    let mut places = [[0.0f32; 4]; 2 * probe::MOST];
    for (pair, place) in places.chunks_exact_mut(2).zip(probes.places()) {
        pair[0] = place.middle.extend(0.0).to_array();
        pair[1] = place.half.extend(0.0).to_array();
    }
    gpu.buffer("probe places", bytemuck::cast_slice(&places), wgpu::BufferUsages::UNIFORM)
}

impl GpuProbe {
    fn new(gpu: &Gpu, index: u32, probe: &Probe<'_>) -> Result<GpuProbe, RenderError> {
        let unfit = || RenderError::Preparation("a probe has no maps; prepare it again".into());
        let face = probe.distances.face();
        let cells = Cells::new(face);
        let layers: Vec<Probe<'_>> = [Some(*probe), probe.behind()].into_iter().flatten().collect();
        if face > gpu.device.limits().max_texture_dimension_2d {
            return Err(unfit());
        }
        let has_all = |layer: &Probe<'_>| {
            let (depths, bounds) = (layer.maps.floats("distances").len(), layer.maps.floats("bounds").len());
            depths as u64 == 6 * u64::from(face).pow(2) && bounds == 2 * cells.count()
        };
        if !layers.iter().all(has_all) {
            return Err(unfit());
        }
        let mut uploaded = Vec::new();
        for layer in &layers {
            let maps = EnvironmentMaps::uploaded(gpu, layer.maps).ok_or_else(unfit)?;
            let data = data(index, layer, &maps, layers.len() as u32);
            uploaded.push((maps, gpu.buffer("probe", bytemuck::bytes_of(&data), wgpu::BufferUsages::UNIFORM)));
        }
        let behind = if uploaded.len() > 1 { uploaded.pop().map(|(maps, data)| Behind { maps, data }) } else { None };
        let (maps, data) = uploaded.pop().ok_or_else(unfit)?;
        Ok(GpuProbe {
            inverse_depths: depths(gpu, face, &layers),
            coarse: coarse(gpu, probe),
            inverse_bounds: bounds(gpu, &cells, &layers),
            data,
            maps,
            behind,
        })
    }
}

/// A layer of surfaces of a probe for shaders.
fn data(index: u32, layer: &Probe<'_>, maps: &EnvironmentMaps, layers: u32) -> ProbeData {
    let extent = layer.extent;
    ProbeData {
        middle: layer.middle,
        index,
        low: extent.low,
        near: extent.near,
        high: extent.high,
        far: extent.far,
        radius: extent.radius,
        scale: maps.scale,
        face: layer.distances.face(),
        radiance_mips: maps.radiance.mip_level_count() as f32,
        prefiltered_mips: maps.prefiltered.mip_level_count() as f32,
        source_count: maps.source_count,
        wide_alpha: maps.wide_alpha,
        layers,
    }
}

/// The texels as three vectors each; a black one where the method is another.
fn coarse(gpu: &Gpu, probe: &Probe<'_>) -> wgpu::Buffer {
    let numbers = probe.maps.floats(area_cube::ARRAY);
    let missing = [0.0; area_cube::NUMBERS];
    let numbers = if numbers.is_empty() { &missing[..] } else { numbers };
    gpu.buffer("coarse cubes", bytemuck::cast_slice(numbers), wgpu::BufferUsages::STORAGE)
}

fn depths(gpu: &Gpu, face: u32, layers: &[Probe<'_>]) -> wgpu::TextureView {
    let texture = faces(gpu, "inverse depths", [face, layers.len() as u32], 1, wgpu::TextureFormat::R32Float);
    for (place, layer) in (0..).zip(layers) {
        write(gpu, &texture, [place, 0], layer.maps.floats("distances"));
    }
    faces_view(&texture)
}

/// A mip map for each level of cells from 1 on; one texel that nothing reads where there are none.
fn bounds(gpu: &Gpu, cells: &Cells, layers: &[Probe<'_>]) -> wgpu::TextureView {
    let [width, mips] = [cells.width(1).max(1), cells.top.max(1)];
    let texture = faces(gpu, "inverse bounds", [width, layers.len() as u32], mips, wgpu::TextureFormat::Rg32Float);
    for (place, layer) in (0..).zip(layers) {
        let kept = layer.maps.floats("bounds");
        for level in 1..=cells.top {
            let (first, count) = (2 * cells.index(level, 0, 0, 0), 12 * (cells.width(level) as usize).pow(2));
            write(gpu, &texture, [place, level - 1], &kept[first..first + count]);
        }
    }
    faces_view(&texture)
}

/// Six faces for each layer of surfaces.
fn faces(gpu: &Gpu, label: &str, [width, layers]: [u32; 2], mips: u32, format: wgpu::TextureFormat) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height: width, depth_or_array_layers: 6 * layers },
        mip_level_count: mips,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

/// Writes the faces of a layer of surfaces, of a mip map.
fn write(gpu: &Gpu, texture: &wgpu::Texture, [layer, mip]: [u32; 2], numbers: &[f32]) {
    let width = (texture.width() >> mip).max(1);
    let texel = texture.format().block_copy_size(None).unwrap_or(4);
    gpu.queue.write_texture(
        wgpu::TexelCopyTextureInfo {
            mip_level: mip,
            origin: wgpu::Origin3d { x: 0, y: 0, z: 6 * layer },
            ..texture.as_image_copy()
        },
        bytemuck::cast_slice(numbers),
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(texel * width), rows_per_image: Some(width) },
        wgpu::Extent3d { width, height: width, depth_or_array_layers: 6 },
    );
}

fn faces_view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    })
}
