//! The path-traced reference behind the viewport: refined by another thread while nothing changes.
//!
//! [`Reference`] is the window's hand on that thread. It never waits: an edit leaves the newest [`Subject`] on the desk
//! and ends what runs, a picture lies there until the window looks. It knows no graphics device.

mod desk;
mod tracing;

use std::sync::Arc;
use std::time::Instant;

use burnish_core::document::Document;
use burnish_core::lighting::{Layers, Prepared};
use burnish_core::material::preset::FormChoice;
use burnish_core::param::Settings;
use burnish_core::picture::Picture;
use burnish_core::reference::Contribution;
use burnish_core::scene::{Camera, Scene};
use eframe::egui;
use glam::{UVec2, Vec2, Vec3};

use desk::{Activity, Desk};

/// Most pixels that are traced: sums and variances take 256 bytes for each.
const MAX_PIXELS: f64 = (1 << 22) as f64;

/// What is traced. Everything that only the display needs, such as exposure, is not in it.
#[derive(Clone, Debug)]
pub struct Subject {
    document: Arc<Document>,
    scene: Arc<Scene>,
    camera: Camera,
    size: UVec2,
    settings: Settings,
    contribution: Contribution,
    by: By,
}

/// Who draws.
#[derive(Clone, Debug)]
enum By {
    /// The path tracer, with metals in this form.
    Paths(FormChoice),
    /// Methods on the processor, with what they prepared.
    Points(Layers, Vec<Arc<Prepared>>),
}

/// A picture of the subject on the desk.
#[derive(Clone, Debug, Default)]
pub struct Look {
    /// Scene-linear radiance.
    pub picture: Arc<Picture>,
    /// Pixels for each texel, across and down; more than 1 in a first, coarse look.
    step: u32,
    size: UVec2,
    /// Samples of each pixel; 0 in a coarse look.
    pub samples: u32,
    /// Relative standard error of the picture, see [`Film::error`](burnish_core::reference::Film::error).
    pub error: Option<f64>,
    /// Seconds of tracing.
    pub secs: f64,
    /// Samples that were not finite and were left out.
    pub rejected: u64,
    /// Share of the light that the clamp took away.
    pub clamped: f64,
    /// It is as fine as it gets.
    pub finished: bool,
}

/// Switch and state of the reference.
pub struct Reference {
    on: bool,
    /// The live picture comes from here too: its method draws on the processor.
    draws_live: bool,
    /// The viewport asked for a picture in this frame.
    asked: bool,
    /// It asked in the last one.
    watched: bool,
    desk: Arc<Desk>,
    started: bool,
    look: Option<Look>,
    fault: Option<String>,
    activity: Activity,
}

impl Subject {
    /// What a viewport of so many pixels shows.
    pub fn new(document: &Arc<Document>, scene: &Arc<Scene>, camera: &Camera, size: UVec2) -> Subject {
        Subject {
            scene: scene.clone(),
            camera: camera.clone(),
            size: limited(size),
            settings: document.lighting.reference_settings(),
            contribution: Contribution::All,
            by: By::Paths(document.lighting.reference_form()),
            document: document.clone(),
        }
    }

    /// The light of one source of it.
    #[must_use]
    pub fn showing(self, contribution: Contribution) -> Subject {
        Subject { contribution, ..self }
    }

    /// The same by the document's methods, on the processor.
    #[must_use]
    pub fn by_points(self, layers: Layers, prepared: Vec<Arc<Prepared>>) -> Subject {
        // Methods on the processor show all light.
        let (settings, contribution) = (self.document.lighting.world_settings(), Contribution::All);
        Subject { settings, contribution, by: By::Points(layers, prepared), ..self }
    }

    /// Both give the same picture: the metals of a document only count with its scene, which is made anew with them.
    fn is_like(&self, other: &Subject) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene)
            && self.camera.world_from_view == other.camera.world_from_view
            && self.camera.projection == other.camera.projection
            && self.size == other.size
            && self.by.is_like(&other.by)
            && self.settings == other.settings
            && self.contribution == other.contribution
    }
}

impl By {
    fn is_like(&self, other: &By) -> bool {
        match (self, other) {
            (By::Paths(form), By::Paths(other)) => form == other,
            (By::Points(layers, prepared), By::Points(other, of_other)) => {
                let same = prepared.iter().zip(of_other).all(|(a, b)| Arc::ptr_eq(a, b));
                layers == other && prepared.len() == of_other.len() && same
            }
            _ => false,
        }
    }
}

/// The size, or one of the same shape with as many pixels as are traced at most.
fn limited(size: UVec2) -> UVec2 {
    let pixels = f64::from(size.x) * f64::from(size.y);
    let share = (MAX_PIXELS / pixels.max(1.0)).sqrt().min(1.0);
    (size.as_dvec2() * share).as_uvec2().max(UVec2::ONE)
}

impl Look {
    /// The part of the texture that the viewport shows, from its top left: blocks at the edge reach beyond it.
    pub fn part(&self) -> Vec2 {
        self.size.as_vec2()
            / (self.step * UVec2::new(self.picture.width, self.picture.height)).max(UVec2::ONE).as_vec2()
    }

    /// Pixels of the picture where it is a whole one; `None` for a first look.
    pub fn whole_size(&self) -> Option<UVec2> {
        (self.samples > 0).then_some(self.size)
    }

    /// Radiance under a point of the view, 0 to 1 from its top left.
    pub fn radiance(&self, at: Vec2) -> Option<Vec3> {
        let inside = (at.cmpge(Vec2::ZERO) & at.cmple(Vec2::ONE)).all();
        let last = self.size.saturating_sub(UVec2::ONE);
        let pixel = (at * self.size.as_vec2()).as_uvec2().min(last) / self.step.max(1);
        let index = pixel.y as usize * self.picture.width as usize + pixel.x as usize;
        self.picture.texels.get(index).filter(|_| inside).map(|texel| texel.truncate())
    }

    /// Another number for another picture of the same subject.
    pub fn version(&self) -> u64 {
        u64::from(self.samples) << 32 | u64::from(self.step)
    }

    /// How far it is.
    fn text(&self, timed: bool) -> String {
        if self.samples == 0 {
            return format!("first look, 1/{} of the resolution", self.step);
        }
        let samples = if self.samples == 1 { "1 sample".into() } else { format!("{} samples", self.samples) };
        let noise = self.error.map_or(String::new(), |error| format!(", noise {}", percent(error)));
        let secs = if timed { format!(", {}", duration(self.secs)) } else { String::new() };
        format!("{samples}{noise}{secs}")
    }
}

/// Two digits, whatever the size.
pub fn percent(share: f64) -> String {
    match 100.0 * share {
        v if v >= 10.0 => format!("{v:.0} %"),
        v if v >= 1.0 => format!("{v:.1} %"),
        v if v >= 0.1 => format!("{v:.2} %"),
        v => format!("{v:.3} %"),
    }
}

fn duration(secs: f64) -> String {
    match secs {
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

impl Default for Reference {
    fn default() -> Self {
        Reference {
            on: false,
            draws_live: false,
            asked: false,
            watched: false,
            desk: Arc::default(),
            started: false,
            look: None,
            fault: None,
            activity: Activity::Idle,
        }
    }
}

impl Reference {
    /// It is shown instead of the live picture as soon as there is something of it.
    pub fn is_on(&self) -> bool {
        self.on
    }

    /// Shows it, or the live picture. What was traced is kept: while nothing changes it goes on from there.
    pub fn switch(&mut self, on: bool) {
        self.on = on;
    }

    /// Someone uses mouse or keyboard: the processor is theirs for a while.
    pub fn note_input(&self) {
        if self.on || self.draws_live || self.watched {
            self.desk.rest();
        }
    }

    /// Asks for a picture, and takes the newest of this very subject; `ctx` is repainted when there is another.
    pub fn look(&mut self, subject: Subject, ctx: &egui::Context) -> Option<&Look> {
        self.asked = true;
        if !std::mem::replace(&mut self.started, true) {
            self.start(ctx.clone());
        }
        let taken = self.desk.order(subject);
        (self.look, self.fault, self.activity) = (taken.look, taken.fault, taken.activity);
        self.look.as_ref()
    }

    fn start(&self, ctx: egui::Context) {
        let desk = self.desk.clone();
        let work = move || tracing::run(&desk, &|| ctx.request_repaint());
        if let Err(error) = std::thread::Builder::new().name("reference".into()).spawn(work) {
            self.desk.give_up(error.to_string());
        }
    }

    /// Ends a frame of the window: nothing is traced for a viewport that is not seen.
    pub fn end_frame(&mut self) {
        self.watched = std::mem::take(&mut self.asked);
        if !self.watched {
            self.desk.close();
        }
    }

    /// Says whether the live picture comes from here.
    pub fn draw_live(&mut self, draws_live: bool) {
        self.draws_live = draws_live;
    }

    /// The picture that is shown.
    pub fn shown(&self) -> Option<&Look> {
        self.look.as_ref().filter(|_| self.on || self.draws_live)
    }

    /// The newest picture of what was asked for last, whether the reference is on or not.
    pub fn latest(&self) -> Option<&Look> {
        self.look.as_ref()
    }

    /// How far that picture is, in words; `timed` with the seconds that it took.
    pub fn text_of_look(&self, timed: bool) -> String {
        self.look.as_ref().map_or_else(|| "reference begins".into(), |look| format!("reference, {}", look.text(timed)))
    }

    /// Why the last picture that was asked for failed.
    pub fn failure(&self) -> Option<&str> {
        self.fault.as_deref()
    }

    /// Why there is no picture, in words.
    pub fn fault(&self) -> Option<String> {
        let fault = self.fault.as_ref()?;
        match (self.on, self.draws_live) {
            (true, _) => Some(format!(
                "The reference cannot be traced: {fault}. The live picture is shown; an edit tries again."
            )),
            (_, true) => {
                Some(format!("The processor cannot draw: {fault}. Classical light is shown; an edit tries again."))
            }
            _ => None,
        }
    }

    /// Seconds until tracing goes on after input.
    pub fn rests_for(&self) -> Option<f64> {
        self.desk.rest_end().and_then(|end| end.checked_duration_since(Instant::now())).map(|left| left.as_secs_f64())
    }

    /// Its thread has something to do now.
    pub fn is_tracing(&self) -> bool {
        self.desk.is_tracing()
    }

    /// What is shown and how far it is, in words; `timed` with the seconds that it took.
    pub fn text(&self, timed: bool) -> String {
        let paused = if self.rests_for().is_some() { ", paused" } else { "" };
        match (&self.look, &self.fault, self.activity) {
            (_, Some(_), _) => "Live picture: the reference failed".into(),
            (Some(look), None, _) if look.finished => format!("Reference: {}, done", look.text(timed)),
            (Some(look), None, _) => format!("Reference: {}{paused}", look.text(timed)),
            (None, None, Activity::Preparing) => format!("Live picture: preparing the reference{paused}"),
            (None, None, _) => "Live picture until the reference begins".into(),
        }
    }

    /// Makes the next step of its thread fail, to try what happens then.
    pub fn inject_failure(&self) {
        self.desk.inject_failure();
    }
}

impl Drop for Reference {
    fn drop(&mut self) {
        self.desk.quit();
    }
}

#[cfg(test)]
mod tests;
