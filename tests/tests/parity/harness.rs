//! Runs some lines of WGSL over many inputs and compares what they give with a Rust function.

use std::sync::LazyLock;

use burnish_core::leaf::{self, Leaf};
use burnish_render::Gpu;
use burnish_render::readback::read_buffer;
use glam::Vec4;
use wgpu::BufferUsages;

use crate::curves::{self, Curves};

/// What every shader of this binary has: bindings, and the functions that leaves ask of a pass.
const EXTERNS: &str = include_str!("externs.wgsl");

/// Opened once: a software adapter takes its time.
pub static GPU: LazyLock<Gpu> = LazyLock::new(|| Gpu::new().unwrap_or_else(|e| panic!("{e}")));

/// How far the two languages may be apart: the larger of both counts.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    pub relative: f32,
    pub absolute: f32,
}

impl Tolerance {
    /// Some hundred roundings of f32.
    pub const DEFAULT: Tolerance = Tolerance { relative: 1e-4, absolute: 1e-6 };
    /// Whole numbers, and what the same roundings in the same order give.
    pub const EXACT: Tolerance = Tolerance { relative: 0.0, absolute: 0.0 };

    /// `|ours - theirs|` over what is allowed: a fault above 1; infinite where one is not a number.
    fn share(self, gpu: f32, cpu: f32) -> f32 {
        let apart = (gpu - cpu).abs();
        let allowed = self.absolute.max(self.relative * cpu.abs());
        if apart == 0.0 {
            0.0
        } else if apart.is_finite() {
            apart / allowed
        } else {
            f32::INFINITY
        }
    }
}

/// A comparison of one leaf's functions in both languages.
pub struct Case {
    /// Name of the trial, a sentence about the leaf.
    pub name: &'static str,
    /// Leaf whose functions it calls.
    pub leaf: &'static Leaf,
    helpers: &'static str,
    body: &'static str,
    tolerance: Tolerance,
    /// Vectors that an input and an output have.
    strides: (usize, usize),
    inputs: Box<dyn Fn() -> Vec<Vec4> + Send>,
    twin: Twin,
}

/// Outputs of one input.
type Twin = Box<dyn Fn(&[Vec4]) -> Vec<Vec4> + Send>;

impl Case {
    /// `body` is WGSL that reads `x: array<vec4f, I>` and writes `y: array<vec4f, O>`; `twin` says in Rust what it must
    /// write for each of `inputs`.
    pub fn new<const I: usize, const O: usize>(
        name: &'static str,
        leaf: &'static Leaf,
        body: &'static str,
        inputs: fn() -> Vec<[Vec4; I]>,
        twin: fn(&[Vec4; I]) -> [Vec4; O],
    ) -> Case {
        Case {
            name,
            leaf,
            helpers: "",
            body,
            tolerance: Tolerance::DEFAULT,
            strides: (I, O),
            inputs: Box::new(move || inputs().into_iter().flatten().collect()),
            twin: Box::new(move |x| twin(x.try_into().expect("inputs come in strides")).to_vec()),
        }
    }

    /// WGSL functions that the body calls.
    pub fn with(self, helpers: &'static str) -> Case {
        Case { helpers, ..self }
    }

    /// Another tolerance; its cause stands where it is given.
    pub fn within(self, tolerance: Tolerance) -> Case {
        Case { tolerance, ..self }
    }

    /// The whole shader.
    pub fn source(&self) -> String {
        let (leaves, (i, o)) = (leaf::join(&[self.leaf]), self.strides);
        let (helpers, body, curves, area) = (self.helpers, self.body, curves::first(), curves::AREA);
        let area_cube = curves::AREA_CUBE;
        format!(
            "{leaves}\nconst PARITY_CURVES: u32 = {curves}u;\nconst PARITY_AREA: u32 = {area}u;\n\
             const PARITY_AREA_CUBE: u32 = {area_cube}u;\n{EXTERNS}\n{helpers}\n\
             @compute @workgroup_size(64)\n\
             fn parity(@builtin(global_invocation_id) id: vec3u) {{\n\
             if id.x >= arrayLength(&parity_inputs) / {i}u {{ return; }}\n\
             var x: array<vec4f, {i}>;\n\
             for (var j = 0u; j < {i}u; j++) {{ x[j] = parity_inputs[id.x * {i}u + j]; }}\n\
             var y: array<vec4f, {o}>;\n\
             {{\n{body}\n}}\n\
             for (var j = 0u; j < {o}u; j++) {{ parity_outputs[id.x * {o}u + j] = y[j]; }}\n\
             }}\n"
        )
    }

    /// Panics with the worst few where the languages differ.
    pub fn run(&self) {
        let inputs = (self.inputs)();
        let (i, o) = self.strides;
        assert!(!inputs.is_empty(), "no inputs");
        let gpu = evaluate(&self.source(), &inputs, inputs.len() / i, o);
        let cpu: Vec<Vec4> = inputs.chunks(i).flat_map(|x| (self.twin)(x)).collect();
        assert_eq!(gpu.len(), cpu.len());
        let mut faults: Vec<(f32, usize, usize)> = Vec::new();
        for (index, (gpu, cpu)) in gpu.iter().zip(&cpu).enumerate() {
            for c in 0..4 {
                let share = self.tolerance.share(gpu[c], cpu[c]);
                if share > 1.0 {
                    faults.push((share, index, c));
                }
            }
        }
        faults.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut report = String::new();
        for (share, index, c) in faults.iter().take(5) {
            let (gpu, cpu, x) = (gpu[*index][*c], cpu[*index][*c], &inputs[index / o * i..][..i]);
            let (y, ratio) = (index % o, gpu / cpu);
            report += &format!(
                "y[{y}].{}: WGSL {gpu:e}, Rust {cpu:e}, ratio {ratio}, {share} times the tolerance, for x =\n  {x:?}\n",
                ["x", "y", "z", "w"][*c],
            );
        }
        let numbers = 4 * cpu.len();
        assert!(
            faults.is_empty(),
            "{} of {numbers} numbers differ by more than {:?}\n{report}",
            faults.len(),
            self.tolerance
        );
    }
}

/// Runs a shader in so many threads, each of which writes `outputs` vectors.
fn evaluate(source: &str, inputs: &[Vec4], threads: usize, outputs: usize) -> Vec<Vec4> {
    let device = &GPU.device;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("parity"),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let layout = layout(device);
    let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        bind_group_layouts: &[Some(&layout)],
        ..Default::default()
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("parity"),
        layout: Some(&pipeline_layout),
        module: &module,
        entry_point: Some("parity"),
        compilation_options: Default::default(),
        cache: None,
    });
    let outputs = buffer((threads * outputs * size_of::<Vec4>()) as u64, BufferUsages::COPY_SRC);
    let buffers = [filled(bytemuck::cast_slice(inputs)), outputs, filled(bytemuck::cast_slice(&Curves::get().floats))];
    let entries: Vec<_> = buffers
        .iter()
        .enumerate()
        .map(|(i, b)| wgpu::BindGroupEntry { binding: i as u32, resource: b.as_entire_binding() })
        .collect();
    let bindings =
        device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries });
    let mut encoder = device.create_command_encoder(&Default::default());
    {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &bindings, &[]);
        pass.dispatch_workgroups((threads as u32).div_ceil(64), 1, 1);
    }
    GPU.queue.submit([encoder.finish()]);
    let bytes = read_buffer(&GPU, &buffers[1]).unwrap_or_else(|e| panic!("{e}"));
    bytemuck::cast_slice::<u8, f32>(&bytes).chunks_exact(4).map(Vec4::from_slice).collect()
}

/// Inputs, outputs, table.
fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |(binding, read_only)| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("parity"),
        entries: &[(0, true), (1, false), (2, true)].map(entry),
    })
}

fn buffer(size: u64, usage: BufferUsages) -> wgpu::Buffer {
    let usage = usage | BufferUsages::STORAGE;
    GPU.device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
}

fn filled(bytes: &[u8]) -> wgpu::Buffer {
    let buffer = buffer(bytes.len() as u64, BufferUsages::COPY_DST);
    GPU.queue.write_buffer(&buffer, 0, bytes);
    buffer
}

/// The measure itself: without this a fault of it would make every case pass.
pub fn differences_are_faults() {
    let default = Tolerance::DEFAULT;
    assert!(default.share(1.0, 1.0) == 0.0 && Tolerance::EXACT.share(0.0, -0.0) == 0.0);
    assert!(default.share(1.00005, 1.0) < 1.0 && default.share(0.9e-6, 0.0) < 1.0);
    assert!(default.share(1.0002, 1.0) > 1.0 && default.share(2e-6, 0.0) > 1.0);
    assert!(Tolerance::EXACT.share(1.0 + f32::EPSILON, 1.0) > 1.0);
    for (gpu, cpu) in [(f32::NAN, 1.0), (1.0, f32::NAN), (f32::NAN, f32::NAN), (f32::INFINITY, 1.0)] {
        assert!(default.share(gpu, cpu) > 1.0, "{gpu} against {cpu}");
    }
}
