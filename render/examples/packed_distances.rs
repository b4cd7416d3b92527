//! Times of searches by where the distances are kept: in a texture of their own, or in the alpha of the radiance.
//!
//! `cargo run --release -p burnish-render --example packed_distances -- [RESOLUTION] [ROUNDS]`: the mirrored lines of sight
//! of `gallery:room` at 700 x 700 are followed by a secant with two refinements, and light is looked up where they end.

use std::sync::Arc;
use std::time::Instant;

use burnish_core::job::Handle;
use burnish_core::leaf;
use burnish_core::lighting::Method;
use burnish_core::lighting::impostor::{self, Impostor, Solver};
use burnish_core::lighting::probe::{self, Probe, Probes};
use burnish_core::param::Settings;
use burnish_core::reference::{Options, View, World};
use burnish_core::scene::gallery;
use burnish_render::Gpu;
use glam::UVec2;
use half::f16;
use wgpu::{BindingResource, BufferUsages, TextureFormat, TextureViewDimension as Dimension};

type Failure = Box<dyn std::error::Error>;

const SIZE: UVec2 = UVec2::splat(700);
const REFINEMENTS: u32 = 2;
const VARIANTS: [&str; 4] = [
    "own texture r32float, four loads",
    "in the alpha of rgba16float, four loads",
    "own texture r16float, filtered",
    "in the alpha of rgba16float, filtered",
];

const SHADER: &str = "
override variant: u32 = 0u;
struct Given { ends: vec4f, low: vec4f, high: vec4f, solver: u32, refinements: u32, face: u32, count: u32 }
@group(0) @binding(0) var<uniform> given: Given;
@group(0) @binding(1) var<storage, read> rays: array<vec4f>;
@group(0) @binding(2) var<storage, read_write> drawn: array<vec4f>;
@group(0) @binding(3) var linear: sampler;
@group(0) @binding(4) var own: texture_2d_array<f32>;
@group(0) @binding(5) var together: texture_2d_array<f32>;
@group(0) @binding(6) var own_cube: texture_cube<f32>;
@group(0) @binding(7) var together_cube: texture_cube<f32>;

fn probe_place(index: u32) -> ProbePlace { return ProbePlace(vec3f(0.0), vec3f(1.0)); }
fn pyramid_face() -> u32 { return 2u; }
fn pyramid_corners(side: u32, x: u32, y: u32) -> vec4f { return vec4f(0.0); }
fn pyramid_bounds(level: u32, side: u32, x: u32, y: u32) -> vec2f { return vec2f(0.0); }

fn probe_inverse_depth(side: u32, x: u32, y: u32) -> f32 {
    if variant == 0u {
        return textureLoad(own, vec2u(x, y), side, 0).x;
    }
    return textureLoad(together, vec2u(x, y), side, 0).w;
}

fn impostor_distance(direction: vec3f) -> f32 {
    if variant < 2u {
        return probe_distance(given.face, direction);
    }
    let d = vec3f(direction.xy, -direction.z);
    var inverse: f32;
    if variant == 2u {
        inverse = textureSampleLevel(own_cube, linear, d, 0.0).x;
    } else {
        inverse = textureSampleLevel(together_cube, linear, d, 0.0).w;
    }
    return select(0.0, 1.0 / (inverse * max(abs(d.x), max(abs(d.y), abs(d.z)))), inverse > 0.0);
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= given.count {
        return;
    }
    let x = rays[2u * id.x].xyz;
    let r = rays[2u * id.x + 1u].xyz;
    let extent = ImpostorExtent(given.ends.x, given.ends.y, given.ends.z, given.low.xyz, given.high.xyz);
    let found = impostor_solve(extent, x, r, ImpostorEffort(given.solver, given.refinements, 24u, 0.05));
    let seen = impostor_direction(found, x, r);
    drawn[id.x] = textureSampleLevel(together_cube, linear, vec3f(seen.xy, -seen.z), 0.0);
}
";

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let resolution = arguments.first().map_or("256", String::as_str);
    let rounds: usize = arguments.get(1).map_or(Ok(21), |text| text.parse())?;
    let mut settings = Settings::new(impostor::PARAMS);
    for (key, value) in [("resolution", resolution), ("probe-paths", "1")] {
        settings.set(key, value)?;
    }
    let scene = Arc::new(gallery::open("room")?);
    let world = World::new(&scene, Options::new(&settings));
    let prepared = Impostor.prepare(&world, &settings, &Handle::default())?;
    let view = View { camera: scene.cameras[0].clone(), size: SIZE, seed: 0 };
    let probe = Probes::of(&prepared).get(0).ok_or("no probe")?;
    let rays: Vec<[f32; 4]> = impostor::mirror_rays(&world, &prepared, &view)
        .iter()
        .flat_map(|ray| [(ray.position - probe.middle).extend(0.0), ray.direction.extend(0.0)].map(|v| v.to_array()))
        .collect();
    let gpu = Gpu::new()?;
    let mut passes = passes(&gpu, &probe, &rays);
    println!("{}, {} rays, faces of {resolution} texels", gpu.report().name, rays.len() / 2);
    let mut times = VARIANTS.map(|_| Vec::new());
    for round in 0..=rounds {
        for (pass, times) in passes.iter_mut().zip(&mut times) {
            let start = Instant::now();
            pass()?;
            // The first round compiles.
            times.extend((round > 0).then(|| start.elapsed().as_secs_f64() * 1e3));
        }
    }
    let medians = times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    });
    for (name, median) in VARIANTS.iter().zip(medians) {
        println!("{name:<42}{median:8.2} ms {:6.3}", median / medians[0]);
    }
    Ok(())
}

type Pass<'a> = Box<dyn FnMut() -> Result<(), Failure> + 'a>;

/// One for each variant.
fn passes<'a>(gpu: &'a Gpu, probe: &Probe<'_>, rays: &[[f32; 4]]) -> Vec<Pass<'a>> {
    let (face, extent, count) = (probe.distances.face(), probe.extent, rays.len() as u32 / 2);
    let inverse = probe.maps.floats("distances");
    let halves: Vec<f16> = inverse.iter().map(|kept| f16::from_f32(*kept)).collect();
    // Any light will do.
    let together: Vec<[f16; 4]> = halves.iter().map(|kept| [f16::from_f32(0.5), f16::ONE, *kept, *kept]).collect();
    let own = layers(gpu, face, TextureFormat::R32Float, bytemuck::cast_slice(inverse));
    let own_halves = layers(gpu, face, TextureFormat::R16Float, bytemuck::cast_slice(&halves));
    let together = layers(gpu, face, TextureFormat::Rgba16Float, bytemuck::cast_slice(&together));
    let mut given = [0u32; 16];
    let ends = [extent.near, extent.far, extent.radius, 0.0];
    let corners = [extent.low.extend(0.0).to_array(), extent.high.extend(0.0).to_array()];
    for (word, number) in given.iter_mut().zip(ends.into_iter().chain(corners.into_iter().flatten())) {
        *word = number.to_bits();
    }
    given[12..].copy_from_slice(&[Solver::Secant as u32, REFINEMENTS, face, count]);
    let given = gpu.buffer("given", bytemuck::cast_slice(&given), BufferUsages::UNIFORM);
    let rays = gpu.buffer("rays", bytemuck::cast_slice(rays), BufferUsages::STORAGE);
    let drawn = gpu.buffer("drawn", &vec![0; 16 * count as usize], BufferUsages::STORAGE);
    let linear = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..Default::default()
    });
    let view = |texture: &wgpu::Texture, dimension| {
        texture.create_view(&wgpu::TextureViewDescriptor { dimension: Some(dimension), ..Default::default() })
    };
    let views = [
        view(&own, Dimension::D2Array),
        view(&together, Dimension::D2Array),
        view(&own_halves, Dimension::Cube),
        view(&together, Dimension::Cube),
    ];
    let source = leaf::join(&[&probe::WGSL, &impostor::WGSL]) + SHADER;
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("packed distances"),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let layout = layout(&gpu.device);
    let buffers = [&given, &rays, &drawn].map(|buffer| buffer.as_entire_binding());
    let resources = buffers
        .into_iter()
        .chain([BindingResource::Sampler(&linear)])
        .chain(views.iter().map(BindingResource::TextureView));
    let entries: Vec<_> =
        (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("packed distances"),
        layout: &layout,
        entries: &entries,
    });
    let pipelines = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("packed distances"),
        bind_group_layouts: &[Some(&layout)],
        ..Default::default()
    });
    let pass = |variant: usize| -> Pass<'a> {
        let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(VARIANTS[variant]),
            layout: Some(&pipelines),
            module: &module,
            entry_point: Some("main"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &[("variant", variant as f64)],
                ..Default::default()
            },
            cache: None,
        });
        let group = group.clone();
        Box::new(move || {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups(count.div_ceil(64), 1, 1);
            drop(pass);
            gpu.queue.submit([encoder.finish()]);
            Ok(gpu.wait()?)
        })
    };
    (0..VARIANTS.len()).map(pass).collect()
}

fn layers(gpu: &Gpu, face: u32, format: TextureFormat, texels: &[u8]) -> wgpu::Texture {
    let size = wgpu::Extent3d { width: face, height: face, depth_or_array_layers: 6 };
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("distances"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let bytes_per_row = Some(texels.len() as u32 / (6 * face));
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row, rows_per_image: Some(face) };
    gpu.queue.write_texture(texture.as_image_copy(), texels, layout, size);
    texture
}

fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    let texture = |filterable, view_dimension| wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable },
        view_dimension,
        multisampled: false,
    };
    let types = [
        buffer(wgpu::BufferBindingType::Uniform),
        buffer(wgpu::BufferBindingType::Storage { read_only: true }),
        buffer(wgpu::BufferBindingType::Storage { read_only: false }),
        wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
        texture(false, Dimension::D2Array),
        texture(false, Dimension::D2Array),
        texture(true, Dimension::Cube),
        texture(true, Dimension::Cube),
    ];
    let entry = |(binding, ty)| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty,
        count: None,
    };
    let entries: Vec<_> = (0..).zip(types).map(entry).collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("packed distances"),
        entries: &entries,
    })
}
