//! The bench: what methods cost against how wrong they are, on one scene from one view.
//!
//! [`Truth::trace`] makes the picture that all are judged by, with its own noise; [`measure`] runs the [`Candidate`]s in
//! turns and gives a [`Record`] of each; [`pareto`] finds those that nothing else beats. Who draws is told from outside:
//! a [`Rig`] holds a [`FrameTimer`] for each method, so that this module knows no graphics device and a test can bring
//! a method of its own. A [`Cache`] keeps truths and records.

mod cache;
mod pareto;
mod points;
mod record;
mod reference;
mod run;
mod truth;

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::UVec2;

use super::MeasureError;
use crate::document::Curves;
use crate::file::FileError;
use crate::lighting::method::{MethodError, MethodId};
use crate::material::Reflectance;
use crate::material::preset::{self, FormChoice, Preset};
use crate::param::Settings;
use crate::picture::Picture;
use crate::scene::{Camera, Scene};

pub use cache::Cache;
pub use pareto::pareto;
pub use points::PointTimer;
pub use record::{COLUMNS, Record, Region, csv};
pub use reference::PathTimer;
pub use run::{Candidate, Listener, News, measure};
pub use truth::Truth;

/// Jittered frames whose mean is compared when nothing else is said: with it both sides average over the area of a pixel.
pub const COMPARED_FRAMES: u32 = 16;

/// What is looked at.
#[derive(Clone, Debug)]
pub struct Shot {
    /// Name in tables.
    pub name: String,
    /// Valid and with an environment; its subject is what [`Region::Subject`] is about.
    pub scene: Arc<Scene>,
    /// From where.
    pub camera: Camera,
    /// Pixels.
    pub size: UVec2,
    /// Exposure at which FLIP looks at the pictures.
    pub exposure_ev: f32,
    /// Jittered frames whose mean is compared; the fewer, the more the edges of highlights differ by chance.
    pub compared_frames: u32,
    /// Metals that the library of presets does not hold, by id.
    pub metals: BTreeMap<String, Preset>,
}

impl Shot {
    /// The scene with its metals in one form.
    pub fn in_form(&self, choice: FormChoice) -> Arc<Scene> {
        Curves::default().in_form(&self.scene, choice, |id| self.metal(id))
    }

    /// A metal of the shot or of the library.
    pub fn metal(&self, id: &str) -> Option<Preset> {
        self.metals.get(id).cloned().or_else(|| preset::find(id).ok())
    }

    /// The ids of metals that neither knows: they keep the form that they have.
    pub fn unknown_metals(&self) -> Vec<&str> {
        let ids = self.scene.materials.iter().filter_map(|material| match &material.reflectance {
            Reflectance::Preset { id, .. } => Some(id.as_str()),
            Reflectance::BaseColor => None,
        });
        ids.filter(|id| self.metal(id).is_none()).collect()
    }
}

/// What was done before the first frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Preparation {
    /// Wall clock.
    pub secs: f64,
    /// Memory that it keeps, where that is known.
    pub bytes: Option<u64>,
}

/// A method with settings, ready to draw a shot.
pub trait Frames {
    /// What it took to get ready.
    fn preparation(&self) -> Preparation;
    /// Draws one frame; returns its seconds.
    fn frame(&mut self) -> Result<f64, BenchError>;
    /// The picture to compare: the mean of [`Shot::compared_frames`] jittered frames, or of as many paths as the settings say.
    fn picture(&mut self) -> Result<Picture, BenchError>;
}

/// Draws and times the frames of one method.
pub trait FrameTimer {
    /// Gets ready; what is made once for all scenes, such as compiled shaders, is made before the clock starts.
    fn open(&mut self, shot: &Shot, settings: &Settings) -> Result<Box<dyn Frames>, BenchError>;
}

/// Who draws, and a pass that tells how fast the machine is just now.
pub struct Tools<'a> {
    /// A timer for each method that can be measured.
    pub timers: Vec<(MethodId, Box<dyn FrameTimer + 'a>)>,
    /// Seconds of a fixed piece of the same kind of work.
    pub calibrate: Box<dyn FnMut() -> Result<f64, BenchError> + 'a>,
}

/// Makes [`Tools`].
type Open<'a> = Box<dyn FnMut() -> Result<Tools<'a>, BenchError> + 'a>;

/// The tools of a machine, which are not made before something must be drawn: what the cache holds needs none.
pub struct Rig<'a> {
    /// What the times depend on besides: the name of the device.
    machine: String,
    open: Open<'a>,
    tools: Option<Tools<'a>>,
}

impl<'a> Rig<'a> {
    /// Of the machine of this name; `open` is called once the tools are needed.
    pub fn new(machine: impl Into<String>, open: impl FnMut() -> Result<Tools<'a>, BenchError> + 'a) -> Rig<'a> {
        Rig { machine: machine.into(), open: Box::new(open), tools: None }
    }

    /// Whether the tools were made.
    pub fn is_open(&self) -> bool {
        self.tools.is_some()
    }

    /// The tools, made where they are not there yet.
    fn tools(&mut self) -> Result<&mut Tools<'a>, BenchError> {
        let tools = match self.tools.take() {
            Some(tools) => tools,
            None => (self.open)()?,
        };
        Ok(self.tools.insert(tools))
    }
}

/// Why something could not be measured.
#[derive(Debug, thiserror::Error)]
pub enum BenchError {
    /// Pictures that cannot be compared.
    #[error(transparent)]
    Measure(#[from] MeasureError),
    /// The method or its device failed.
    #[error("{0}")]
    Method(String),
    /// No timer for a method.
    #[error("nothing draws method {0} here")]
    NoTimer(MethodId),
    /// The cache.
    #[error(transparent)]
    File(#[from] FileError),
    /// The user ended it.
    #[error("cancelled")]
    Cancelled,
}

impl From<MethodError> for BenchError {
    fn from(error: MethodError) -> BenchError {
        match error {
            MethodError::Cancelled => BenchError::Cancelled,
            MethodError::Unfit(reason) => BenchError::Method(reason),
        }
    }
}
