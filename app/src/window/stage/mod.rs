//! Where the picture of the viewport comes from.

mod live;
mod losses;

use std::sync::Arc;

use burnish_core::lighting::probe::Raster;
use burnish_core::picture::Picture;
use burnish_core::scene::{Picked, Scene};
use burnish_render::{Display, Drawn, Frame, Passes, PendingPicture};
use eframe::egui::TextureId;
use glam::{UVec2, Vec2, Vec3, Vec4};

pub use live::Live;
pub use losses::LossLog;

/// The source of the picture.
pub enum Stage {
    /// Flat grey: for tests of everything around it.
    Flat,
    /// A scene on the window's device.
    Live(Box<Live>),
}

/// Where a picture goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Screen {
    /// The one that is always there.
    Main,
    /// The other side of a comparison.
    Second,
}

/// A picture on its way from the stage to the CPU.
pub enum Reading {
    /// Of a flat stage.
    Flat(UVec2),
    /// Of the device.
    Pending(Box<PendingPicture>),
}

impl Reading {
    /// The picture, given out once; `None` while it is on its way. Errors are in words.
    pub fn poll(&mut self) -> Result<Option<Picture>, String> {
        match self {
            Reading::Flat(size) => Ok(Some(Picture::filled(size.x, size.y, Vec4::new(0.2, 0.2, 0.2, 1.0)))),
            Reading::Pending(pending) => pending.poll().map_err(|error| error.to_string()),
        }
    }
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
        self.draw_on(Screen::Main, scene, frame)
    }

    /// Draws what is due on a screen.
    pub fn draw_on(&mut self, screen: Screen, scene: &Arc<Scene>, frame: &Frame) -> Shown {
        match self {
            Stage::Flat => Shown { settled: true, ..Shown::default() },
            Stage::Live(live) => live.draw(screen, scene, frame),
        }
    }

    /// Shows a picture that was computed elsewhere instead; it is repainted when there is another.
    pub fn show(&mut self, picture: &Arc<Picture>, display: Display) -> Shown {
        self.show_on(Screen::Main, picture, display)
    }

    /// Shows a picture that was computed elsewhere on a screen.
    pub fn show_on(&mut self, screen: Screen, picture: &Arc<Picture>, display: Display) -> Shown {
        match self {
            Stage::Flat => Shown { settled: true, ..Shown::default() },
            Stage::Live(live) => live.show(screen, picture, display),
        }
    }

    /// Starts to read the live picture of a screen, which has so many pixels; `None` unless it is at rest.
    pub fn read(&self, screen: Screen, size: UVec2) -> Option<Reading> {
        match self {
            Stage::Flat => Some(Reading::Flat(size)),
            Stage::Live(live) => live.read(screen).map(|pending| Reading::Pending(Box::new(pending))),
        }
    }

    /// Frees what the second screen takes.
    pub fn close_second(&mut self) {
        if let Stage::Live(live) = self {
            live.close_second();
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
    pub fn radiance(&mut self, screen: Screen, at: Vec2) -> Option<Vec3> {
        match self {
            Stage::Flat => None,
            Stage::Live(live) => live.radiance(screen, at),
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

    /// Draws what probes see on the window's device.
    pub fn raster(&self) -> Option<Arc<dyn Raster>> {
        match self {
            Stage::Flat => None,
            Stage::Live(live) => Some(live.raster().clone()),
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
