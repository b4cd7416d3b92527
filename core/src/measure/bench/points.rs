//! Methods that draw point by point on the processor, measured.

use std::sync::Arc;
use std::time::Instant;

use super::{BenchError, FrameTimer, Frames, Preparation, Shot};
use crate::lighting::prepared::Asked;
use crate::lighting::{Drawing, Method, Prepared, classical};
use crate::material::preset::FormChoice;
use crate::param::Settings;
use crate::picture::Picture;
use crate::reference::{Control, Film, Options, Pass, View, World};
use crate::scene::Scene;

/// Of another seed than the truth, whose points it must not share.
const SEED: u32 = 3;

/// Draws on the current rayon pool. A frame is one sample of every pixel.
pub struct PointTimer {
    method: &'static dyn Method,
    /// Ends the drawing.
    control: Control,
    /// What was prepared for the scene that is measured.
    prepared: Vec<Made>,
}

/// A preparation, for all settings that look up the same.
struct Made {
    scene: Arc<Scene>,
    form: FormChoice,
    asked: Asked,
    prepared: Arc<Prepared>,
    preparation: Preparation,
}

struct Points {
    method: &'static dyn Method,
    settings: Settings,
    world: World,
    prepared: Arc<Prepared>,
    view: View,
    compared_frames: u32,
    preparation: Preparation,
    control: Control,
}

impl PointTimer {
    /// `None` for methods that do not draw this way.
    pub fn new(method: &'static dyn Method, control: &Control) -> Option<PointTimer> {
        method.points().map(|_| PointTimer { method, control: control.clone(), prepared: Vec::new() })
    }
}

impl FrameTimer for PointTimer {
    fn open(&mut self, shot: &Shot, settings: &Settings) -> Result<Box<dyn Frames>, BenchError> {
        let (form, asked) = (classical::form_choice(settings), Asked::by(self.method, settings));
        let world = World::new(&shot.in_form(form), Options::new(settings));
        self.prepared.retain(|made| Arc::ptr_eq(&made.scene, &shot.scene));
        let is_it = |made: &Made| made.form == form && made.asked == asked;
        let place = match self.prepared.iter().position(is_it) {
            Some(place) => place,
            None => {
                let start = Instant::now();
                let prepared = Arc::new(self.method.prepare(&world, settings, self.control.job())?);
                let preparation = Preparation { secs: start.elapsed().as_secs_f64(), bytes: Some(prepared.bytes()) };
                self.prepared.push(Made { scene: shot.scene.clone(), form, asked, prepared, preparation });
                self.prepared.len() - 1
            }
        };
        let Made { prepared, preparation, .. } = &self.prepared[place];
        let (prepared, preparation) = (prepared.clone(), *preparation);
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
