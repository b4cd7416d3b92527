//! What the bench needs from the program: who draws, and the reference with someone who listens meanwhile. The command
//! line and the window measure with the same.

use std::sync::Arc;

use burnish_core::lighting::{self, MethodId};
use burnish_core::measure::bench::{BenchError, Cache, PathTimer, PointTimer, Rig, Shot, Truth};
use burnish_core::param::Settings;
use burnish_core::reference::{self, Control};
use burnish_render::{Gpu, Passes};

use crate::interrupt;

/// A timer for every method of the program; `control` ends what they draw.
pub fn rig<'a>(gpu: &Gpu, control: &Control) -> Result<Rig<'a>, BenchError> {
    let passes = Arc::new(Passes::new(gpu));
    let mut timers = burnish_render::bench::timers(&passes, control);
    timers.push((MethodId(reference::ID), Box::new(PathTimer { control: control.clone() })));
    for method in lighting::methods() {
        if let Some(timer) = PointTimer::new(method, control) {
            timers.push((method.info().id, Box::new(timer)));
        }
    }
    let calibrate = burnish_render::bench::calibration(&passes)?;
    Ok(Rig { timers, calibrate: Box::new(calibrate), machine: gpu.report().name.clone() })
}

/// Traces what all are judged by, on the threads of a pool or of all; `meanwhile` is called again and again until it is
/// done.
pub fn truth(
    shot: &Shot,
    samples: u32,
    (cache, control): (&Cache, &Control),
    pool: Option<&rayon::ThreadPool>,
    meanwhile: impl FnMut(),
) -> Result<Truth, BenchError> {
    let settings = Settings::new(reference::PARAMS);
    let trace = || Truth::trace(shot, &settings, samples, cache, control);
    interrupt::meanwhile(meanwhile, || match pool {
        Some(pool) => pool.install(trace),
        None => trace(),
    })
}
