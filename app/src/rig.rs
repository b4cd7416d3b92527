//! What the bench needs from the program: who draws, and the reference with someone who listens meanwhile. The command
//! line and the window measure with the same.

use std::sync::Arc;
use std::time::Duration;

use burnish_core::lighting::MethodId;
use burnish_core::measure::bench::{BenchError, Cache, PathTimer, Rig, Shot, Truth};
use burnish_core::param::Settings;
use burnish_core::reference::{self, Control};
use burnish_render::{Gpu, Passes};

/// Milliseconds between two looks at a thread that traces.
const LOOK: Duration = Duration::from_millis(20);

/// A timer for every method of the program; `control` ends what they draw.
pub fn rig<'a>(gpu: &Gpu, control: &Control) -> Result<Rig<'a>, BenchError> {
    let passes = Arc::new(Passes::new(gpu));
    let mut timers = burnish_render::bench::timers(&passes, control);
    timers.push((MethodId(reference::ID), Box::new(PathTimer { control: control.clone() })));
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
    mut meanwhile: impl FnMut(),
) -> Result<Truth, BenchError> {
    let settings = Settings::new(reference::PARAMS);
    let trace = || Truth::trace(shot, &settings, samples, cache, control);
    std::thread::scope(|scope| {
        let tracing = scope.spawn(|| match pool {
            Some(pool) => pool.install(trace),
            None => trace(),
        });
        while !tracing.is_finished() {
            meanwhile();
            std::thread::sleep(LOOK);
        }
        tracing.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}
