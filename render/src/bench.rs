//! Times for the bench: methods on the device, and a pass that tells how fast that is just now.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;
use std::time::Instant;

use burnish_core::lighting::classical::{self, FrameSettings};
use burnish_core::lighting::prepared::Asked;
use burnish_core::lighting::{self, Method, MethodId};
use burnish_core::material::preset::FormChoice;
use burnish_core::measure::bench::{BenchError, FrameTimer, Frames, Preparation, Shot};
use burnish_core::param::Settings;
use burnish_core::picture::Picture;
use burnish_core::reference::{Control, Options, World};
use burnish_core::scene::{Environment, Scene, gallery};
use burnish_core::surface::ggx::Masking;
use glam::{UVec2, Vec3};

use crate::{DeviceRaster, Gpu, Lighting, Passes, RenderError, Renderer, View};

/// Pixels of the calibration pass.
const CALIBRATION_SIZE: UVec2 = UVec2::new(320, 180);

/// A timer for each method that is drawn on the device; `control` ends a picture between two of its frames.
pub fn timers(passes: &Arc<Passes>, control: &Control) -> Vec<(MethodId, Box<dyn FrameTimer>)> {
    let timer = |method: &'static dyn Method| -> (MethodId, Box<dyn FrameTimer>) {
        let (passes, control) = (passes.clone(), control.clone());
        (method.info().id, Box::new(DeviceTimer { method, passes, warm: false, control, opened: Vec::new() }))
    };
    lighting::METHODS.iter().filter(|method| crate::draws(method.info().id)).map(|method| timer(*method)).collect()
}

/// Draws the default scene by lookups: a piece of work that stays the same while methods and scenes change. Returns its
/// seconds.
pub fn calibration(passes: &Arc<Passes>) -> Result<impl FnMut() -> Result<f64, BenchError> + use<>, BenchError> {
    let mut scene = gallery::open("workbench").map_err(|e| BenchError::Method(e.to_string()))?;
    // A small sky: only its lookups are of interest.
    scene.environment = Some(Arc::new(Environment::new("grey", 8, 4, vec![Vec3::splat(0.5); 32])));
    let mut settings = Settings::new(classical::PARAMS);
    settings.set("samples", "0").map_err(|e| BenchError::Method(e.to_string()))?;
    let camera = scene.cameras.first().cloned().ok_or_else(|| BenchError::Method("no camera".into()))?;
    let view = View { size: CALIBRATION_SIZE, camera, settings, jitter_frames: 1 };
    let mut renderer = Renderer::with_passes(passes, &Arc::new(scene)).map_err(words)?;
    renderer.time_frame(&view).map_err(words)?;
    Ok(move || renderer.time_frame(&view).map_err(words))
}

struct DeviceTimer {
    method: &'static dyn Method,
    passes: Arc<Passes>,
    /// The shaders are compiled.
    warm: bool,
    control: Control,
    /// What was made for the scene that is measured.
    opened: Vec<Opened>,
}

/// A scene on the device, for all settings that look up the same.
struct Opened {
    scene: Arc<Scene>,
    form: FormChoice,
    masking: Masking,
    asked: Asked,
    renderer: Rc<RefCell<Renderer>>,
    preparation: Preparation,
}

struct DeviceFrames {
    renderer: Rc<RefCell<Renderer>>,
    view: View,
    compared_frames: u32,
    preparation: Preparation,
    control: Control,
}

impl FrameTimer for DeviceTimer {
    fn open(&mut self, shot: &Shot, settings: &Settings) -> Result<Box<dyn Frames>, BenchError> {
        let (form, masking) = (classical::form_choice(settings), FrameSettings::new(settings).masking);
        let asked = Asked::by(self.method, settings);
        self.opened.retain(|opened| Arc::ptr_eq(&opened.scene, &shot.scene));
        let view = View { size: shot.size, camera: shot.camera.clone(), settings: settings.clone(), jitter_frames: 1 };
        let frames = |opened: &Opened| DeviceFrames {
            renderer: opened.renderer.clone(),
            view: view.clone(),
            compared_frames: shot.compared_frames,
            preparation: opened.preparation,
            control: self.control.clone(),
        };
        let is_it = |opened: &&Opened| opened.form == form && opened.masking == masking && opened.asked == asked;
        if let Some(opened) = self.opened.iter().find(is_it) {
            return Ok(Box::new(frames(opened)));
        }
        let scene = shot.in_form(form);
        if !std::mem::replace(&mut self.warm, true) {
            Renderer::with_passes(&self.passes, &scene).and_then(|mut r| r.time_frame(&view)).map_err(words)?;
        }
        let before = allocated(&self.passes.gpu);
        let start = Instant::now();
        let mut renderer = Renderer::with_passes(&self.passes, &scene).map_err(words)?;
        let lighting = self.prepare(&scene, settings)?;
        renderer.light_by(&lighting).map_err(words)?;
        self.passes.gpu.wait().map_err(|e| BenchError::Method(e.to_string()))?;
        let secs = start.elapsed().as_secs_f64();
        let bytes = before.zip(allocated(&self.passes.gpu)).map(|(before, after)| after.saturating_sub(before));
        let (renderer, preparation) = (Rc::new(RefCell::new(renderer)), Preparation { secs, bytes });
        let opened = Opened { scene: shot.scene.clone(), form, masking, asked, renderer, preparation };
        let drawn = frames(&opened);
        if lighting.is_prepared() {
            // Its own shaders.
            drawn.renderer.borrow_mut().time_frame(&view).map_err(words)?;
        }
        self.opened.push(opened);
        Ok(Box::new(drawn))
    }
}

impl DeviceTimer {
    /// What the processor makes for the method, where the device does not do it by itself.
    fn prepare(&self, scene: &Arc<Scene>, settings: &Settings) -> Result<Lighting, BenchError> {
        let id = self.method.info().id;
        if id.0 == classical::ID {
            return Ok(Lighting::default());
        }
        let raster = Arc::new(DeviceRaster::new(&self.passes));
        let world = World::new(scene, Options::new(settings)).with_raster(Some(raster));
        let prepared = self.method.prepare(&world, settings, self.control.job())?;
        Ok(Lighting::new(id, Some(Arc::new(prepared))))
    }
}

impl Frames for DeviceFrames {
    fn preparation(&self) -> Preparation {
        self.preparation
    }

    fn frame(&mut self) -> Result<f64, BenchError> {
        self.renderer.borrow_mut().time_frame(&self.view).map_err(words)
    }

    fn picture(&mut self) -> Result<Picture, BenchError> {
        let view = View { jitter_frames: self.compared_frames, ..self.view.clone() };
        let picture =
            self.renderer.borrow_mut().render_while(&view, |_| !self.control.is_cancelled()).map_err(words)?;
        picture.ok_or(BenchError::Cancelled)
    }
}

/// Bytes that the device has given out, where its allocator tells.
fn allocated(gpu: &Gpu) -> Option<u64> {
    gpu.device.generate_allocator_report().map(|report| report.total_allocated_bytes)
}

fn words(error: RenderError) -> BenchError {
    BenchError::Method(error.to_string())
}
