//! Methods that draw point by point on the processor, measured.

use std::time::Instant;

use super::{BenchError, FrameTimer, Frames, Preparation, Shot};
use crate::lighting::{Drawing, Method, Prepared, classical};
use crate::param::Settings;
use crate::picture::Picture;
use crate::reference::{Control, Film, Options, Pass, View, World};

/// Of another seed than the truth, whose points it must not share.
const SEED: u32 = 3;

/// Draws on the current rayon pool. A frame is one sample of every pixel.
pub struct PointTimer {
    method: &'static dyn Method,
    /// Ends the drawing.
    control: Control,
}

struct Points {
    method: &'static dyn Method,
    settings: Settings,
    world: World,
    prepared: Prepared,
    view: View,
    compared_frames: u32,
    preparation: Preparation,
    control: Control,
}

impl PointTimer {
    /// `None` for methods that do not draw this way.
    pub fn new(method: &'static dyn Method, control: &Control) -> Option<PointTimer> {
        method.points().map(|_| PointTimer { method, control: control.clone() })
    }
}

impl FrameTimer for PointTimer {
    fn open(&mut self, shot: &Shot, settings: &Settings) -> Result<Box<dyn Frames>, BenchError> {
        let world = World::new(&shot.in_form(classical::form_choice(settings)), Options::new(settings));
        let start = Instant::now();
        let prepared = self.method.prepare(&world, settings, self.control.job())?;
        let preparation = Preparation { secs: start.elapsed().as_secs_f64(), bytes: Some(prepared.bytes()) };
        let view = View { camera: shot.camera.clone(), size: shot.size, seed: SEED };
        let control = self.control.clone();
        let settings = settings.clone();
        let (method, compared_frames) = (self.method, shot.compared_frames);
        Ok(Box::new(Points { method, settings, world, prepared, view, compared_frames, preparation, control }))
    }
}

impl Points {
    fn draw(&self, samples: u32) -> Result<Film, BenchError> {
        let drawing = Drawing::new(self.method, &self.world, &self.prepared, &self.settings);
        let drawing = drawing.ok_or_else(|| BenchError::NoTimer(self.method.info().id))?;
        let mut film = Film::new(self.view.size);
        match drawing.draw(&self.view, &mut film, samples, &self.control) {
            Pass::Whole => Ok(film),
            Pass::Cancelled => Err(BenchError::Cancelled),
        }
    }
}

impl Frames for Points {
    fn preparation(&self) -> Preparation {
        self.preparation
    }

    fn frame(&mut self) -> Result<f64, BenchError> {
        let start = Instant::now();
        self.draw(1)?;
        Ok(start.elapsed().as_secs_f64())
    }

    fn picture(&mut self) -> Result<Picture, BenchError> {
        Ok(self.draw(self.compared_frames)?.picture())
    }
}
