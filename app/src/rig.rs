//! What the bench needs from the program: who draws, and the reference with someone who listens meanwhile. The command
//! line and the window measure with the same.

use std::sync::Arc;

use burnish_core::lighting::{self, MethodId};
use burnish_core::measure::bench::{BenchError, Cache, FrameTimer, PathTimer, PointTimer, Rig, Shot, Tools, Truth};
use burnish_core::param::Settings;
use burnish_core::reference::{self, Control};
use burnish_render::device::{ACCEPTED, choose};
use burnish_render::{Gpu, GpuError, Passes};
use eframe::wgpu;

use crate::interrupt;

/// A timer for every method of the program; `control` ends what they draw. The adapter is only looked for: it is opened
/// when something must be drawn on it, and never where all is known. With `processor` that draws what it can, and the adapter the rest.
pub fn rig(control: &Control, processor: bool) -> Result<Rig<'static>, BenchError> {
    let control = control.clone();
    let adapter = adapter_name().map_err(words)?;
    let machine = if processor { format!("{adapter}, but the processor where it can") } else { adapter };
    Ok(Rig::new(machine, move || tools(&control, processor)))
}

/// Opens the adapter and compiles what measures time on it.
fn tools(control: &Control, processor: bool) -> Result<Tools<'static>, BenchError> {
    let passes = Arc::new(Passes::new(&Gpu::new().map_err(words)?));
    let of_device = burnish_render::bench::timers(&passes, control);
    let mut of_processor: Vec<(MethodId, Box<dyn FrameTimer>)> = Vec::new();
    for method in lighting::methods() {
        if let Some(timer) = PointTimer::new(method, control) {
            of_processor.push((method.info().id, Box::new(timer)));
        }
    }
    // The first of a method draws it.
    let [mut timers, others] = if processor { [of_processor, of_device] } else { [of_device, of_processor] };
    timers.extend(others);
    timers.push((MethodId(reference::ID), Box::new(PathTimer { control: control.clone() })));
    let calibrate = burnish_render::bench::calibration(&passes)?;
    Ok(Tools { timers, calibrate: Box::new(calibrate) })
}

/// The name of the adapter that would be opened.
fn adapter_name() -> Result<String, GpuError> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = ACCEPTED;
    let adapters = pollster::block_on(wgpu::Instance::new(descriptor).enumerate_adapters(wgpu::Backends::all()));
    Ok(choose(&adapters, |_| true)?.get_info().name)
}

fn words(error: GpuError) -> BenchError {
    BenchError::Method(error.to_string())
}

/// Traces what all are judged by with settings of the reference, on the threads of a pool or of all; `meanwhile` is called again and again until it is
/// done.
pub fn truth(
    shot: &Shot,
    settings: &Settings,
    samples: u32,
    (cache, control): (&Cache, &Control),
    pool: Option<&rayon::ThreadPool>,
    meanwhile: impl FnMut(),
) -> Result<Truth, BenchError> {
    let trace = || Truth::trace(shot, settings, samples, cache, control);
    interrupt::meanwhile(meanwhile, || match pool {
        Some(pool) => pool.install(trace),
        None => trace(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_adapter_that_is_looked_for_is_the_one_that_is_opened() {
        // Machines without one run this too.
        let Ok(name) = adapter_name() else { return };
        let control = Control::default();
        let rig = rig(&control, false).unwrap();
        assert!(!rig.is_open(), "it is only looked for");
        assert_eq!(Gpu::new().unwrap().report().name, name);
    }
}
