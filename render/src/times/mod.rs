//! How long the graphics device takes to evaluate reflectance curves.

use std::time::Instant;

use burnish_core::measure::median;
use burnish_core::surface::fresnel::Fresnel;

use crate::device::{Gpu, GpuError};
use crate::shader;

/// Invocations of a pass.
const THREADS: u32 = 1 << 16;
/// Evaluations of an invocation.
const LOOPS: u32 = 128;
/// Rounds over all curves, of which the median counts.
const ROUNDS: usize = 7;
/// No curve: what loop and memory cost.
pub const FORM_NONE: u32 = 99;

/// Seconds that each curve takes for the three channels at one angle, as one of very many.
///
/// Wall clock from submission to completion of a pass, less that of the same pass without a curve; the curves take
/// turns, the median of seven rounds counts. On a software adapter this is what the processor takes.
pub fn evaluation_times(gpu: &Gpu, curves: &[Fresnel]) -> Result<Vec<f64>, GpuError> {
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(shader::TIMES.name),
        source: wgpu::ShaderSource::Wgsl(shader::TIMES.source().into()),
    });
    let sums = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("sums"),
        size: u64::from(THREADS) * 16,
        usage: wgpu::BufferUsages::STORAGE,
        mapped_at_creation: false,
    });
    let baseline = Run::new(gpu, &module, &sums, FORM_NONE, &[0.0; 15]);
    let runs: Vec<Run> = curves
        .iter()
        .map(|curve| {
            let mut numbers = bytemuck::cast_slice(&curve.coefficients()).to_vec();
            if let Fresnel::Spectral { table } = curve {
                numbers.extend(table.iter().flat_map(|c| c.to_array()));
            }
            Run::new(gpu, &module, &sums, curve.form(), &numbers)
        })
        .collect();
    let mut times = vec![Vec::with_capacity(ROUNDS); curves.len()];
    // One more round first: it compiles.
    for round in 0..=ROUNDS {
        let without = baseline.time(gpu)?;
        for (run, times) in runs.iter().zip(&mut times) {
            let with = run.time(gpu)?;
            if round > 0 {
                times.push((with - without).max(0.0) / f64::from(THREADS) / f64::from(LOOPS));
            }
        }
    }
    Ok(times.iter_mut().map(|times| median(times)).collect())
}

/// A pipeline with its bindings.
struct Run {
    pipeline: wgpu::ComputePipeline,
    bindings: wgpu::BindGroup,
}

impl Run {
    fn new(gpu: &Gpu, module: &wgpu::ShaderModule, sums: &wgpu::Buffer, form: u32, numbers: &[f32]) -> Run {
        let constants = [("form", f64::from(form)), ("loops", f64::from(LOOPS))];
        let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("times"),
            layout: None,
            module,
            entry_point: Some("times"),
            compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
            cache: None,
        });
        let numbers = gpu.buffer("numbers", bytemuck::cast_slice(numbers), wgpu::BufferUsages::STORAGE);
        let bindings = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("times"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: numbers.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: sums.as_entire_binding() },
            ],
        });
        Run { pipeline, bindings }
    }

    /// Seconds from submission to completion.
    fn time(&self, gpu: &Gpu) -> Result<f64, GpuError> {
        let start = Instant::now();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &self.bindings, &[]);
            pass.dispatch_workgroups(THREADS / 64, 1, 1);
        }
        gpu.queue.submit([encoder.finish()]);
        gpu.wait()?;
        Ok(start.elapsed().as_secs_f64())
    }
}
