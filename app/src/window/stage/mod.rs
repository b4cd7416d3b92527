//! Where the picture of the viewport comes from.

mod live;
mod losses;

use std::sync::Arc;

use burnish_core::color::tone::ToneMap;
use burnish_core::picture::Picture;
use burnish_core::scene::{Picked, Scene};
use burnish_render::{Drawn, Frame, Passes};
use eframe::egui::TextureId;
use glam::{Vec2, Vec3};

pub use live::Live;
pub use losses::LossLog;

/// The source of the picture.
pub enum Stage {
    /// Flat grey: for tests of everything around it.
    Flat,
    /// A scene on the window's device.
    Live(Box<Live>),
}

/// A failure to try.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trial {
    /// A call fails; the device draws on.
    Call,
    /// The device is gone for good.
    Device,
}

/// What the viewport shows in a frame of the window.
#[derive(Clone, Debug, Default)]
pub struct Shown {
    /// The picture; none on a flat stage and before the first.
    pub texture: Option<TextureId>,
    /// Nothing is left to draw until something changes.
    pub settled: bool,
    /// Why there is no picture, or an old one.
    pub message: Option<String>,
    /// The device was lost just now: edits belong into the recovery file.
    pub lost: bool,
}

/// What there is to know about the picture.
#[derive(Clone, Debug, Default)]
pub struct Status {
    /// The last call.
    pub drawn: Drawn,
    /// Physical pixels of the panel.
    pub size: glam::UVec2,
    /// Milliseconds of the last frame that showed a change.
    pub frame_ms: f64,
    /// Graphics adapter.
    pub adapter: String,
    /// It is a software rasterizer.
    pub software: bool,
    /// Why there is no picture, or an old one, as of the last frame.
    pub message: Option<String>,
    /// Nothing is timed, so that the window looks the same each time: for snapshots.
    pub fixed_clock: bool,
}

impl Stage {
    /// Draws what is due.
    pub fn draw(&mut self, scene: &Arc<Scene>, frame: &Frame) -> Shown {
        match self {
            Stage::Flat => Shown { settled: true, ..Shown::default() },
            Stage::Live(live) => live.draw(scene, frame),
        }
    }

    /// Shows a picture that was computed elsewhere instead; it is repainted when there is another.
    pub fn show(&mut self, picture: &Arc<Picture>, tone: ToneMap, exposure_ev: f32) -> Shown {
        match self {
            Stage::Flat => Shown { settled: true, ..Shown::default() },
            Stage::Live(live) => live.show(picture, tone, exposure_ev),
        }
    }

    /// The surface under a point of the live picture, 0 to 1 from its top left.
    pub fn pick(&mut self, scene: &Scene, frame: &Frame, at: Vec2) -> Option<Picked> {
        match self {
            Stage::Flat => scene.pick(frame.camera.ray(at, frame.size.x as f32 / frame.size.y.max(1) as f32)),
            Stage::Live(live) => live.pick(at),
        }
    }

    /// Scene-linear radiance under a point of the live picture, 0 to 1 from its top left.
    pub fn radiance(&mut self, at: Vec2) -> Option<Vec3> {
        match self {
            Stage::Flat => None,
            Stage::Live(live) => live.radiance(at),
        }
    }

    /// What there is to know about the picture; `None` on a flat stage.
    pub fn status(&self) -> Option<&Status> {
        match self {
            Stage::Flat => None,
            Stage::Live(live) => Some(live.status()),
        }
    }

    /// The compiled passes on the window's device, for other pictures such as thumbnails.
    pub fn passes(&self) -> Option<&Arc<Passes>> {
        match self {
            Stage::Flat => None,
            Stage::Live(live) => Some(live.passes()),
        }
    }

    /// The window's device is gone for good; the program must be started again and told of these losses.
    pub fn wants_restart(&self) -> Option<LossLog> {
        match self {
            Stage::Flat => None,
            Stage::Live(live) => live.wants_restart(),
        }
    }

    /// Makes the next frame fail, to try what happens then.
    pub fn inject(&mut self, trial: Trial) {
        if let Stage::Live(live) = self {
            live.inject(trial);
        }
    }
}
