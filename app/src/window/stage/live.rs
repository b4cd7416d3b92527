//! A picture drawn on the window's own device and shown without a copy.

use std::sync::Arc;

use burnish_core::color::tone::ToneMap;
use burnish_core::picture::Picture;
use burnish_core::scene::{Picked, Scene};
use burnish_render::{Drawn, Frame, Gpu, GpuError, Passes, Plate, RenderError, Viewport};
use eframe::egui::TextureId;
use eframe::egui_wgpu::RenderState;
use eframe::wgpu;
use glam::{Vec2, Vec3};

use super::{LossLog, Shown, Status, Trial};

/// A viewport on the window's device.
pub struct Live {
    render: RenderState,
    viewport: Viewport,
    /// For pictures that are computed elsewhere.
    plate: Plate,
    /// The view that egui knows, and as what.
    texture: Option<(wgpu::TextureView, TextureId)>,
    status: Status,
    losses: LossLog,
    condition: Condition,
    /// The window was not shown yet.
    first: bool,
    trial: Option<Trial>,
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
            viewport,
            render,
            texture: None,
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
    pub fn draw(&mut self, scene: &Arc<Scene>, frame: &Frame) -> Shown {
        self.attempt(|live| live.try_draw(scene, frame))
    }

    /// Shows a picture that was computed elsewhere.
    pub fn show(&mut self, picture: &Arc<Picture>, tone: ToneMap, exposure_ev: f32) -> Shown {
        let shown = self.attempt(|live| {
            live.fail_for_trial()?;
            live.plate.draw(picture, tone, exposure_ev)?;
            live.present(live.plate.output().cloned());
            Ok(())
        });
        // Whoever computes it tells when there is more.
        Shown { settled: shown.texture.is_some(), ..shown }
    }

    fn attempt(&mut self, work: impl FnOnce(&mut Live) -> Result<(), RenderError>) -> Shown {
        if std::mem::take(&mut self.first) {
            // The window appears at once, its picture when the shaders are compiled.
            return Shown::default();
        }
        match self.condition {
            Condition::Sound => {}
            Condition::Restart => return self.shown(Some("The graphics device was lost.".into()), false),
            Condition::GivenUp => return self.shown(Some(LossLog::GIVEN_UP.into()), false),
        }
        match work(self) {
            Ok(()) => self.shown(None, false),
            Err(RenderError::Gpu(error)) => self.recover(&error),
            Err(error) => self.shown(Some(error.to_string()), false),
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
        self.present(self.viewport.output().cloned());
        Ok(())
    }

    /// Makes egui know the picture.
    fn present(&mut self, view: Option<wgpu::TextureView>) {
        let Some(view) = &view else { return };
        let filter = wgpu::FilterMode::Linear;
        let mut renderer = self.render.renderer.write();
        match &mut self.texture {
            Some((known, _)) if known == view => {}
            Some((known, id)) => {
                renderer.update_egui_texture_from_wgpu_texture(&self.render.device, view, filter, *id);
                *known = view.clone();
            }
            None => {
                let id = renderer.register_native_texture(&self.render.device, view, filter);
                self.texture = Some((view.clone(), id));
            }
        }
    }

    fn shown(&mut self, message: Option<String>, lost: bool) -> Shown {
        self.status.message.clone_from(&message);
        Shown {
            texture: self.texture.as_ref().filter(|_| self.condition == Condition::Sound).map(|(_, id)| *id),
            settled: message.is_some() || self.status.drawn.settled,
            message,
            lost,
        }
    }

    /// After a failure: a new view where the device lives on, else the wish for a new program.
    fn recover(&mut self, error: &GpuError) -> Shown {
        let again = self.losses.note_now();
        if again && is_loss(error) {
            self.condition = Condition::Restart;
        } else if again {
            // An error that no scope caught sticks to the device's first owner; the device itself draws on.
            let gpu = Gpu::from_parts(&self.render.adapter, self.render.device.clone(), self.render.queue.clone());
            self.viewport = Viewport::new(&gpu);
            self.plate = Plate::new(self.viewport.passes());
        } else {
            self.condition = Condition::GivenUp;
        }
        self.status.drawn = Drawn::default();
        // Words of a driver come with line breaks.
        let reason = error.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
        let message = if again { format!("{reason}. The picture is made anew.") } else { LossLog::GIVEN_UP.into() };
        Shown { settled: !again, ..self.shown(Some(message), true) }
    }

    /// The surface under a point of the picture.
    pub fn pick(&mut self, at: Vec2) -> Option<Picked> {
        // An error comes up again, and is told, when the next frame is drawn.
        self.viewport.pick(at).ok().flatten()
    }

    /// Radiance under a point of the picture.
    pub fn radiance(&mut self, at: Vec2) -> Option<Vec3> {
        self.viewport.radiance(at).ok().flatten()
    }

    /// What there is to know about the picture.
    pub fn status(&self) -> &Status {
        &self.status
    }

    /// The compiled passes.
    pub fn passes(&self) -> &Arc<Passes> {
        self.viewport.passes()
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

/// True where the device itself is gone, not only a call to it.
fn is_loss(error: &GpuError) -> bool {
    matches!(error, GpuError::Failed(message) if message.starts_with("device lost") || message.contains("device is lost"))
}
