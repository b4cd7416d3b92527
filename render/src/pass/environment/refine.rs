//! Preparing the cubes of an environment a slice at a time, so that a window stays alive meanwhile.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::thread;
use std::time::{Duration, Instant};

use burnish_core::scene::Environment;

use super::plan::Plan;
use super::steps::Steps;
use super::{EnvironmentMaps, EnvironmentPass};
use crate::device::{Gpu, GpuError};
use crate::error::RenderError;

/// How far a [`Refinement`] has come.
pub enum Progress {
    /// The share that is done, 0 to 1.
    Working(f32),
    /// The cubes, once; what follows is `Working(1.0)`.
    Finished(Box<EnvironmentMaps>),
}

/// How much faster than two cores of a software rasteriser a slow graphics card is.
const HARDWARE_SPEED: f32 = 20.0;
/// Submissions that a budget is spent in.
const PIECES: u32 = 4;

/// The work of [`EnvironmentPass::build`] in slices: what the processor does runs on a thread of its own, what the device
/// does is submitted by [`Refinement::advance`]. Dropping it gives up the rest.
pub struct Refinement {
    stage: Stage,
    /// A slice is under way on the device.
    busy: Arc<AtomicBool>,
}

enum Stage {
    Planning(Receiver<Plan>),
    Building(Box<Steps>),
    Over,
}

impl Refinement {
    /// Starts to prepare the map.
    pub fn new(environment: &Environment) -> Refinement {
        let (send, plan) = channel();
        let environment = environment.clone();
        // Nobody receives when the refinement was dropped meanwhile.
        thread::spawn(move || send.send(Plan::new(&environment)).unwrap_or_default());
        Refinement { stage: Stage::Planning(plan), busy: Arc::default() }
    }

    /// Submits work for about `budget` of the device's time, unless the last slice is still under way. Never waits for
    /// the device; to be called once a frame until it returns the cubes.
    ///
    /// A software rasteriser may do its work inside of this call: it then takes the budget, and at most one piece more.
    pub fn advance(&mut self, gpu: &Gpu, pass: &EnvironmentPass, budget: Duration) -> Result<Progress, RenderError> {
        gpu.check()?;
        let mut steps = match std::mem::replace(&mut self.stage, Stage::Over) {
            Stage::Planning(receiver) => match receiver.try_recv() {
                Ok(plan) => Box::new(Steps::new(gpu, plan)?),
                Err(TryRecvError::Empty) => {
                    self.stage = Stage::Planning(receiver);
                    return Ok(Progress::Working(0.0));
                }
                Err(TryRecvError::Disconnected) => return Ok(Progress::Working(1.0)),
            },
            Stage::Building(steps) => steps,
            Stage::Over => return Ok(Progress::Working(1.0)),
        };
        if !self.is_idle(gpu)? || self.submit(gpu, pass, &mut steps, budget) {
            let fraction = steps.fraction();
            self.stage = Stage::Building(steps);
            return Ok(Progress::Working(fraction));
        }
        Ok(Progress::Finished(Box::new(steps.into_maps())))
    }

    /// True when the device has done what was submitted last.
    fn is_idle(&self, gpu: &Gpu) -> Result<bool, RenderError> {
        if self.busy.load(Ordering::Acquire) {
            gpu.device.poll(wgpu::PollType::Poll).map_err(|e| GpuError::Failed(e.to_string()))?;
        }
        Ok(!self.busy.load(Ordering::Acquire))
    }

    /// Submits what fits the budget. True while there is more.
    fn submit(&self, gpu: &Gpu, pass: &EnvironmentPass, steps: &mut Steps, budget: Duration) -> bool {
        let started = Instant::now();
        let cores = thread::available_parallelism().map_or(1, |n| n.get());
        let speed = if gpu.is_software() { 0.5 * cores as f32 } else { HARDWARE_SPEED };
        let piece = budget / PIECES;
        let mut more = true;
        // Where the device is the processor itself, its true speed shows at once.
        for _ in 0..PIECES {
            more = steps.slice(gpu, pass, piece.as_nanos() as f32 * speed);
            if !more || started.elapsed() + piece > budget {
                break;
            }
        }
        self.busy.store(true, Ordering::Release);
        let busy = self.busy.clone();
        gpu.queue.on_submitted_work_done(move || busy.store(false, Ordering::Release));
        more
    }
}
