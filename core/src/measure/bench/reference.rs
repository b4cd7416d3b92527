//! The path tracer as one of the methods that are measured.

use std::time::Instant;

use super::truth::world_of;
use super::{BenchError, FrameTimer, Frames, Preparation, Shot};
use crate::param::{ParamValue, Settings};
use crate::picture::Picture;
use crate::reference::{self, Control, Film, Pass, View, World};

/// Of another seed than the truth, whose paths it must not share.
const SEED: u32 = 2;

/// Traces on the current rayon pool. A frame is a picture of as many samples as the settings say.
#[derive(Debug, Default)]
pub struct PathTimer {
    /// Ends the tracing.
    pub control: Control,
}

struct Paths {
    world: World,
    view: View,
    samples: u32,
    preparation: Preparation,
    control: Control,
}

impl FrameTimer for PathTimer {
    fn open(&mut self, shot: &Shot, settings: &Settings) -> Result<Box<dyn Frames>, BenchError> {
        let start = Instant::now();
        let world = world_of(shot, settings);
        let preparation = Preparation { secs: start.elapsed().as_secs_f64(), bytes: Some(world.bytes()) };
        let samples = match settings.get("samples") {
            Some(ParamValue::Integer(n)) => u32::try_from(n).unwrap_or(1).max(1),
            _ => 1,
        };
        let view = View { camera: shot.camera.clone(), size: shot.size, seed: SEED };
        Ok(Box::new(Paths { world, view, samples, preparation, control: self.control.clone() }))
    }
}

impl Paths {
    fn trace(&self) -> Result<Film, BenchError> {
        let mut film = Film::new(self.view.size);
        match reference::trace(&self.world, &self.view, &mut film, self.samples, &self.control) {
            Pass::Whole => Ok(film),
            Pass::Cancelled => Err(BenchError::Cancelled),
        }
    }
}

impl Frames for Paths {
    fn preparation(&self) -> Preparation {
        self.preparation
    }

    fn frame(&mut self) -> Result<f64, BenchError> {
        let start = Instant::now();
        self.trace()?;
        Ok(start.elapsed().as_secs_f64())
    }

    fn picture(&mut self) -> Result<Picture, BenchError> {
        Ok(self.trace()?.picture())
    }
}
