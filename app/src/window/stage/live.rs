//! A picture drawn on the window's own device and shown without a copy.

use std::sync::Arc;

use burnish_core::picture::Picture;
use burnish_core::scene::{Picked, Scene};
use burnish_render::{
    DeviceRaster, Display, Drawn, Frame, Gpu, GpuError, Passes, PendingPicture, Plate, RenderError, Viewport,
};
use eframe::egui::TextureId;
use eframe::egui_wgpu::RenderState;
use eframe::wgpu;
use glam::{Vec2, Vec3};

use super::{LossLog, Screen, Shown, Status, Trial};

/// A viewport on the window's device.
pub struct Live {
    render: RenderState,
    viewport: Viewport,
    /// For pictures that are computed elsewhere.
    plate: Plate,
    /// For what probes see.
    raster: Arc<DeviceRaster>,
    texture: Known,
    /// The other side of a comparison, while there is one.
    second: Option<Second>,
    status: Status,
    losses: LossLog,
    condition: Condition,
    /// The window was not shown yet.
    first: bool,
    trial: Option<Trial>,
}

/// The view that egui knows, and as what.
type Known = Option<(wgpu::TextureView, TextureId)>;

/// A second picture on the same device.
struct Second {
    /// Made when something is drawn on it.
    viewport: Option<Viewport>,
    plate: Plate,
    texture: Known,
    settled: bool,
}

/// Whether there is something to draw with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Condition {
    Sound,
    /// The window's device is gone.
    Restart,
    /// The device failed too often.
    GivenUp,
}

impl Live {
    /// A viewport on the device of a window; `gpu` is that device.
    pub fn new(render: RenderState, gpu: &Gpu, losses: LossLog) -> Live {
        let report = gpu.report();
        let status = Status {
            drawn: Drawn { settled: true, ..Drawn::default() },
            adapter: format!("{} ({})", report.name, report.backend),
            software: gpu.is_software(),
            ..Status::default()
        };
        let viewport = Viewport::new(gpu);
        Live {
            plate: Plate::new(viewport.passes()),
            raster: Arc::new(DeviceRaster::new(viewport.passes())),
            viewport,
            render,
            texture: None,
            second: None,
            status,
            losses,
            condition: Condition::Sound,
            first: true,
            trial: None,
        }
    }

    /// Tells no times, so that the window looks the same each time: for snapshots.
    pub fn with_fixed_clock(mut self) -> Live {
        self.status.fixed_clock = true;
        self
    }

    /// Draws what is due.
    pub fn draw(&mut self, screen: Screen, scene: &Arc<Scene>, frame: &Frame) -> Shown {
        self.attempt(screen, |live| match screen {
            Screen::Main => live.try_draw(scene, frame),
            Screen::Second => live.try_draw_second(scene, frame),
        })
    }

    /// Shows a picture that was computed elsewhere.
    pub fn show(&mut self, screen: Screen, picture: &Arc<Picture>, display: Display) -> Shown {
        let shown = self.attempt(screen, |live| {
            live.fail_for_trial()?;
            match screen {
                Screen::Main => {
                    live.plate.draw(picture, display)?;
                    present(&live.render, &mut live.texture, live.plate.output());
                }
                Screen::Second => {
                    let (render, second) = live.second();
                    second.plate.draw(picture, display)?;
                    present(render, &mut second.texture, second.plate.output());
                }
            }
            Ok(())
        });
        // Whoever computes it tells when there is more.
        Shown { settled: shown.texture.is_some(), ..shown }
    }

    fn second(&mut self) -> (&RenderState, &mut Second) {
        let passes = self.viewport.passes();
        let second = self.second.get_or_insert_with(|| Second {
            viewport: None,
            plate: Plate::new(passes),
            texture: None,
            settled: false,
        });
        (&self.render, second)
    }

    /// Frees what the second screen takes.
    pub fn close_second(&mut self) {
        if let Some((_, id)) = self.second.take().and_then(|second| second.texture) {
            self.render.renderer.write().free_texture(&id);
        }
    }

    fn attempt(&mut self, screen: Screen, work: impl FnOnce(&mut Live) -> Result<(), RenderError>) -> Shown {
        if std::mem::take(&mut self.first) {
            // The window appears at once, its picture when the shaders are compiled.
            return Shown::default();
        }
        match self.condition {
            Condition::Sound => {}
            Condition::Restart => return self.shown(screen, Some("The graphics device was lost.".into()), false),
            Condition::GivenUp => return self.shown(screen, Some(LossLog::GIVEN_UP.into()), false),
        }
        match work(self) {
            Ok(()) => self.shown(screen, None, false),
            Err(RenderError::Gpu(error)) => self.recover(screen, &error),
            Err(error) => self.shown(screen, Some(error.to_string()), false),
        }
    }

    fn fail_for_trial(&mut self) -> Result<(), GpuError> {
        match self.trial.take() {
            Some(Trial::Call) => Err(GpuError::Failed("a call, for trial".into())),
            Some(Trial::Device) => Err(GpuError::Failed("device lost: for trial".into())),
            None => Ok(()),
        }
    }

    fn try_draw(&mut self, scene: &Arc<Scene>, frame: &Frame) -> Result<(), RenderError> {
        self.fail_for_trial()?;
        self.viewport.set_scene(scene)?;
        let drawn = self.viewport.draw(frame)?;
        // Pictures at rest are drawn in parts, and a hand that holds still asks for nothing: neither is a measure.
        if frame.moving && drawn.milliseconds > 0.5 || self.status.frame_ms == 0.0 {
            self.status.frame_ms = drawn.milliseconds;
        }
        self.status.size = frame.size;
        self.status.drawn = drawn;
        present(&self.render, &mut self.texture, self.viewport.output());
        Ok(())
    }

    fn try_draw_second(&mut self, scene: &Arc<Scene>, frame: &Frame) -> Result<(), RenderError> {
        self.fail_for_trial()?;
        let passes = self.viewport.passes().clone();
        let (render, second) = self.second();
        let viewport = second.viewport.get_or_insert_with(|| Viewport::with_passes(&passes));
        viewport.set_scene(scene)?;
        second.settled = viewport.draw(frame)?.settled;
        present(render, &mut second.texture, viewport.output());
        Ok(())
    }

    fn shown(&mut self, screen: Screen, message: Option<String>, lost: bool) -> Shown {
        self.status.message.clone_from(&message);
        let (texture, settled) = match (screen, &self.second) {
            (Screen::Main, _) => (self.texture.as_ref(), self.status.drawn.settled),
            (Screen::Second, Some(second)) => (second.texture.as_ref(), second.settled),
            (Screen::Second, None) => (None, false),
        };
        Shown {
            texture: texture.filter(|_| self.condition == Condition::Sound).map(|(_, id)| *id),
            settled: message.is_some() || settled,
            message,
            lost,
        }
    }

    /// After a failure: a new view where the device lives on, else the wish for a new program.
    fn recover(&mut self, screen: Screen, error: &GpuError) -> Shown {
        let again = self.losses.note_now();
        if again && is_loss(error) {
            self.condition = Condition::Restart;
        } else if again {
            // An error that no scope caught sticks to the device's first owner; the device itself draws on.
            let gpu = Gpu::from_parts(&self.render.adapter, self.render.device.clone(), self.render.queue.clone());
            self.viewport = Viewport::new(&gpu);
            self.plate = Plate::new(self.viewport.passes());
            self.raster = Arc::new(DeviceRaster::new(self.viewport.passes()));
            self.close_second();
        } else {
            self.condition = Condition::GivenUp;
        }
        self.status.drawn = Drawn::default();
        // Words of a driver come with line breaks.
        let reason = error.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
        let message = if again { format!("{reason}. The picture is made anew.") } else { LossLog::GIVEN_UP.into() };
        Shown { settled: !again, ..self.shown(screen, Some(message), true) }
    }

    /// The surface under a point of the picture.
    pub fn pick(&mut self, at: Vec2) -> Option<Picked> {
        // An error comes up again, and is told, when the next frame is drawn.
        self.viewport.pick(at).ok().flatten()
    }

    /// Radiance under a point of the picture.
    pub fn radiance(&mut self, screen: Screen, at: Vec2) -> Option<Vec3> {
        let viewport = match screen {
            Screen::Main => &mut self.viewport,
            Screen::Second => self.second.as_mut()?.viewport.as_mut()?,
        };
        viewport.radiance(at).ok().flatten()
    }

    /// Starts to read a picture at rest.
    pub fn read(&self, screen: Screen) -> Option<PendingPicture> {
        match screen {
            Screen::Main => self.viewport.read(),
            Screen::Second => self.second.as_ref()?.viewport.as_ref()?.read(),
        }
    }

    /// What there is to know about the picture.
    pub fn status(&self) -> &Status {
        &self.status
    }

    /// The compiled passes.
    pub fn passes(&self) -> &Arc<Passes> {
        self.viewport.passes()
    }

    /// Draws what probes see, on another thread.
    pub fn raster(&self) -> &Arc<DeviceRaster> {
        &self.raster
    }

    /// Losses to tell the next run of the program about, when there must be one.
    pub fn wants_restart(&self) -> Option<LossLog> {
        (self.condition == Condition::Restart).then(|| self.losses.clone())
    }

    /// Makes the next frame fail.
    pub fn inject(&mut self, trial: Trial) {
        self.trial = Some(trial);
    }
}

/// Makes egui know a picture.
fn present(state: &RenderState, texture: &mut Known, view: Option<&wgpu::TextureView>) {
    let Some(view) = view else { return };
    let filter = wgpu::FilterMode::Linear;
    let mut renderer = state.renderer.write();
    match texture {
        Some((known, _)) if known == view => {}
        Some((known, id)) => {
            renderer.update_egui_texture_from_wgpu_texture(&state.device, view, filter, *id);
            *known = view.clone();
        }
        None => {
            let id = renderer.register_native_texture(&state.device, view, filter);
            *texture = Some((view.clone(), id));
        }
    }
}

/// True where the device itself is gone, not only a call to it.
fn is_loss(error: &GpuError) -> bool {
    matches!(error, GpuError::Failed(message) if message.starts_with("device lost") || message.contains("device is lost"))
}
