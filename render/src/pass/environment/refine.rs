//! Preparing the cubes of an environment a slice at a time, so that a window stays alive meanwhile.

use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::Duration;

use burnish_core::scene::Environment;

use super::{EnvironmentMaps, EnvironmentPass};
use crate::device::Gpu;
use crate::error::RenderError;

/// How far a [`Refinement`] has come.
pub enum Progress {
    /// The share that is done, 0 to 1.
    Working(f32),
    /// The cubes, once; what follows is `Working(1.0)`.
    Finished(Box<EnvironmentMaps>),
}

/// The work of [`EnvironmentPass::build`] in slices: what the processor does runs on a thread of its own, what the device
/// does is submitted by [`Refinement::advance`]. Dropping it gives up the rest.
pub struct Refinement {
    plan: Receiver<Environment>,
}

impl Refinement {
    /// Starts to prepare the map.
    pub fn new(environment: &Environment) -> Refinement {
        let (send, plan) = channel();
        let environment = environment.clone();
        std::thread::spawn(move || send.send(environment));
        Refinement { plan }
    }

    /// Submits work for about `budget` of the device's time, unless the last slice is still under way. Never waits for
    /// the device; to be called once a frame until it returns the cubes.
    pub fn advance(&mut self, gpu: &Gpu, pass: &EnvironmentPass, _budget: Duration) -> Result<Progress, RenderError> {
        match self.plan.try_recv() {
            Ok(plan) => Ok(Progress::Finished(Box::new(pass.build(gpu, &plan)?))),
            Err(TryRecvError::Empty) => Ok(Progress::Working(0.0)),
            Err(TryRecvError::Disconnected) => Ok(Progress::Working(1.0)),
        }
    }
}
