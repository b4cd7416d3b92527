//! What the live method prepares: made in the background, kept on disk, used on while it is stale.
//!
//! After an edit another thread tells by hash whether the preparation is still that of the scene. One that was quick is
//! made anew by itself; else it stays in use with a badge until someone asks for it.

use std::sync::{Arc, LazyLock, Mutex, PoisonError};
use std::time::{Duration, Instant};

use burnish_core::job::{Handle, Job, Outcome};
use burnish_core::lighting::prepared::{Origin, Store};
use burnish_core::lighting::probe::Raster;
use burnish_core::lighting::{Method, MethodError, MethodId, Prepared, Reads};
use burnish_core::param::Settings;
use burnish_core::reference::{Options, World};
use burnish_core::scene::Scene;
use eframe::egui;

use super::pool;

/// How long a scene rests before what was drafted is made in full.
const REST: Duration = Duration::from_millis(700);
/// Time of a preparation that nobody minds to be made after every edit.
const QUICK: Duration = Duration::from_secs(1);

/// Of every method that needs none: always the same, so that nobody takes it for another.
static NOTHING: LazyLock<Arc<Prepared>> = LazyLock::new(|| Arc::new(Prepared::nothing()));

/// How the preparation stands to the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum State {
    /// The method needs none.
    Needless,
    /// There is none yet, or none could be made.
    Missing,
    /// It is compared with the scene, or made; so much of it is done, 0 to 1.
    Working(f32),
    /// Of this very scene.
    Fresh,
    /// A coarse stand-in of this very scene; the whole is made when nothing changes for a while.
    Draft,
    /// Of the scene before an edit.
    Stale,
    /// Likewise, but what was edited is lit rightly by it, and another is made when nothing changes for a while. So much of the light that
    /// arrives at surfaces is wrong, root mean square, where that is known.
    Aged(Option<f32>),
}

/// What a preparation is for.
#[derive(Clone)]
struct Subject {
    method: &'static dyn Method,
    settings: Settings,
    scene: Arc<Scene>,
    /// Who draws what probes see.
    raster: Option<Arc<dyn Raster>>,
}

/// One that is there.
#[derive(Clone)]
struct Held {
    method: MethodId,
    origin: Origin,
    scene: Arc<Scene>,
    is_draft: bool,
    prepared: Arc<Prepared>,
    took: Duration,
    /// Where it fails, for people.
    warnings: Vec<String>,
}

impl Held {
    /// It stays in use for a scene of another origin.
    fn outlives(&self, method: &dyn Method, other: &Origin) -> bool {
        let outlived = method.outlives().parts();
        let is_outlived = |part: &&str| outlived.iter().any(|(name, does)| *does && name == part);
        let is_same_kind = self.origin.method == other.method && self.origin.other_settings(other).is_empty();
        !self.is_draft && is_same_kind && self.origin.other_parts(other).iter().all(is_outlived)
    }
}

/// What a job is to do.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Wanted {
    /// To tell whether what is held is still right.
    Comparison,
    /// Something for now.
    Draft,
    /// The whole.
    Whole,
}

/// What a job found.
enum Found {
    /// The held one is right; where it fails now, for what is served may have moved.
    Same(Vec<String>),
    /// It is not, and nobody asked for another.
    Other,
    /// It is not, but it stays in use while another is made, see [`Method::outlives`].
    Aged(Option<f32>),
    /// The held draft is that of the subject; likewise.
    SameDraft(Vec<String>),
    Drafted(Held),
    Made(Held),
    Failed(MethodError),
}

/// The preparation of the live method.
pub struct Preparation {
    store: Store,
    /// One that took no longer is made anew after every edit.
    quick: Duration,
    subject: Option<Subject>,
    held: Option<Held>,
    state: Option<State>,
    job: Option<Job<Found>>,
    /// The job is about a subject before the present one.
    outdated: bool,
    /// The job makes the whole of a method that has drafts.
    is_whole: bool,
    /// When a draft becomes the whole.
    full_at: Option<Instant>,
    raster: Option<Arc<dyn Raster>>,
    /// The scene that was prepared last, ready for rays: the next shares with it what stayed.
    world: Arc<Mutex<Option<World>>>,
    fault: Option<String>,
}

impl Subject {
    fn is_like(&self, other: &Subject) -> bool {
        self.method.info().id == other.method.info().id
            && Arc::ptr_eq(&self.scene, &other.scene)
            && self.settings == other.settings
    }

    /// Compares what is held by `known` with the subject; makes another as `wanted`.
    fn work(
        &self,
        known: Option<Held>,
        wanted: Wanted,
        store: &Store,
        world: &Mutex<Option<World>>,
        job: &Handle,
    ) -> Found {
        let Subject { method, settings, scene, raster } = self;
        let origin = Origin::of(*method, settings, scene);
        let key = origin.key();
        let same = |draft: bool| known.as_ref().filter(|known| known.is_draft == draft && known.origin == origin);
        if let Some(known) = same(false) {
            return Found::Same(method.warnings(scene, &known.prepared, settings));
        }
        let start = Instant::now();
        let held = |prepared: Arc<Prepared>, is_draft: bool| {
            let (took, warnings) = (start.elapsed(), method.warnings(scene, &prepared, settings));
            let (origin, scene) = (origin.clone(), scene.clone());
            Held { method: method.info().id, origin, scene, is_draft, prepared, took, warnings }
        };
        if let Some(kept) = store.read(&key) {
            return Found::Made(held(Arc::new(kept), false));
        }
        if let Some(known) = same(true).filter(|_| wanted == Wanted::Draft) {
            return Found::SameDraft(method.warnings(scene, &known.prepared, settings));
        }
        if wanted == Wanted::Comparison {
            return Found::Other;
        }
        let mut last = world.lock().unwrap_or_else(PoisonError::into_inner);
        let options = Options::new(settings);
        let world = last.take().map_or_else(|| World::new(scene, options), |old| old.updated(scene, options));
        let world = world.with_raster(raster.clone());
        *last = Some(world.clone());
        drop(last);
        if let Some(old) = known.as_ref().filter(|known| wanted == Wanted::Draft && known.outlives(*method, &origin)) {
            return Found::Aged(method.age(&world.updated(&old.scene, options), &world, settings));
        }
        if wanted == Wanted::Draft {
            return match method.draft(&world, settings, job) {
                Ok(made) => Found::Drafted(held(Arc::new(made), true)),
                Err(error) => Found::Failed(error),
            };
        }
        match store.prepare(&key, *method, &world, settings, job) {
            Ok(prepared) => Found::Made(held(prepared, false)),
            Err(error) => Found::Failed(error),
        }
    }
}

impl Default for Preparation {
    fn default() -> Self {
        Preparation {
            store: Store::none(),
            quick: QUICK,
            subject: None,
            held: None,
            state: None,
            job: None,
            outdated: false,
            is_whole: false,
            full_at: None,
            raster: None,
            world: Arc::default(),
            fault: None,
        }
    }
}

impl Preparation {
    /// Keeps preparations in a folder.
    pub fn new(store: Store) -> Preparation {
        Preparation { store, ..Preparation::default() }
    }

    /// The same, but it makes one anew after every edit, however long that takes: for pictures without a badge.
    #[must_use]
    pub fn always_anew(self) -> Preparation {
        Preparation { quick: Duration::MAX, ..self }
    }

    /// Lets someone draw what probes see, from the next preparation on.
    pub fn draw_probes_by(&mut self, raster: Option<Arc<dyn Raster>>) {
        self.raster = raster;
    }

    /// Follows the document: call it in every frame. `ctx` is repainted when something comes of it.
    pub fn follow(&mut self, method: &'static dyn Method, settings: Settings, scene: &Arc<Scene>, ctx: &egui::Context) {
        let subject = Subject { method, settings, scene: scene.clone(), raster: self.raster.clone() };
        if self.subject.as_ref().is_none_or(|old| !old.is_like(&subject)) {
            if self.held.as_ref().is_some_and(|held| held.method != method.info().id) {
                (self.held, self.state) = (None, None);
            }
            self.fault = None;
            self.outdated = true;
            self.full_at = None;
            self.subject = Some(subject);
            if std::mem::take(&mut self.is_whole) {
                // The processor is needed for a draft of what there is now.
                self.job = None;
            }
        }
        self.poll();
        if let Some(at) = self.full_at.filter(|_| self.job.is_none() && !self.outdated) {
            let left = at.saturating_duration_since(Instant::now());
            if left.is_zero() {
                self.full_at = None;
                self.start(Wanted::Whole, ctx);
            } else {
                ctx.request_repaint_after(left);
            }
        }
        if self.outdated && self.job.is_none() {
            let quick = self.held.as_ref().is_none_or(|held| held.took <= self.quick);
            let drafts = method.drafts() && self.quick != Duration::MAX;
            let wanted = match (quick, drafts) {
                (_, true) => Wanted::Draft,
                (true, false) => Wanted::Whole,
                (false, false) => Wanted::Comparison,
            };
            self.start(wanted, ctx);
        }
    }

    /// Makes it anew.
    pub fn again(&mut self, ctx: &egui::Context) {
        self.start(Wanted::Whole, ctx);
    }

    /// Ends what runs; a stale one stays in use.
    pub fn cancel(&mut self) {
        self.job = None;
        (self.full_at, self.is_whole, self.outdated) = (None, false, false);
        self.state = Some(if self.held.is_some() { State::Stale } else { State::Missing });
    }

    fn start(&mut self, wanted: Wanted, ctx: &egui::Context) {
        let Some(subject) = self.subject.clone() else { return };
        self.outdated = false;
        if subject.method.info().reads == Reads::NOTHING {
            (self.job, self.held, self.state) = (None, None, Some(State::Needless));
            return;
        }
        let (known, store, ctx) = (self.held.clone(), self.store.clone(), ctx.clone());
        self.is_whole = wanted == Wanted::Whole && subject.method.drafts();
        let world = self.world.clone();
        let label = format!("Preparing {}", subject.method.info().title);
        let wake = move || ctx.request_repaint();
        self.job = Some(Job::spawn(label, wake, move |job| {
            pool::install(|| subject.work(known, wanted, &store, &world, job))
        }));
    }

    fn poll(&mut self) {
        let found = match self.job.as_mut().map(Job::poll) {
            None | Some(Outcome::Running) => return,
            Some(Outcome::Done(found)) => found,
            Some(Outcome::Failed) => Found::Failed(MethodError::Unfit("it failed for an unknown reason".into())),
        };
        self.job = None;
        self.is_whole = false;
        self.full_at = None;
        if !matches!(found, Found::Failed(_)) {
            self.fault = None;
        }
        self.state = Some(match found {
            Found::Same(warnings) => {
                self.warn(warnings);
                State::Fresh
            }
            Found::Other => State::Stale,
            Found::Aged(age) => {
                self.full_at = Some(Instant::now() + REST);
                State::Aged(age)
            }
            Found::Drafted(held) => {
                self.held = Some(held);
                self.full_at = Some(Instant::now() + REST);
                State::Draft
            }
            Found::SameDraft(warnings) => {
                self.warn(warnings);
                self.full_at = Some(Instant::now() + REST);
                State::Draft
            }
            Found::Made(held) => {
                self.held = Some(held);
                State::Fresh
            }
            Found::Failed(error) => {
                if !self.outdated {
                    self.fault = Some(error.to_string());
                }
                if self.held.is_some() { State::Stale } else { State::Missing }
            }
        });
    }

    fn warn(&mut self, warnings: Vec<String>) {
        if let Some(held) = &mut self.held {
            held.warnings = warnings;
        }
    }

    /// How it stands.
    pub fn state(&self) -> State {
        match &self.job {
            Some(job) if job.progress() == 0.0 && matches!(self.state, Some(State::Aged(_))) => {
                self.state.unwrap_or(State::Missing)
            }
            Some(job) => State::Working(job.progress()),
            None => self.state.unwrap_or(State::Missing),
        }
    }

    /// What there is for a method, perhaps stale; a method that needs none has an empty one.
    pub fn prepared(&self, method: &dyn Method) -> Option<Arc<Prepared>> {
        if method.info().reads == Reads::NOTHING {
            return Some(NOTHING.clone());
        }
        self.held.as_ref().filter(|held| held.method == method.info().id).map(|held| held.prepared.clone())
    }

    /// Memory in bytes and time of what there is.
    pub fn cost(&self) -> Option<(u64, Duration)> {
        self.held.as_ref().map(|held| (held.prepared.bytes(), held.took))
    }

    /// Where what there is fails, for people.
    pub fn warnings(&self) -> &[String] {
        self.held.as_ref().map_or(&[], |held| &held.warnings)
    }

    /// Why there is no other.
    pub fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }

    /// For which method.
    pub fn method(&self) -> Option<&'static dyn Method> {
        self.subject.as_ref().map(|subject| subject.method)
    }

    /// Another thread works on it, or will when the scene has rested.
    pub fn is_busy(&self) -> bool {
        self.job.is_some() || self.full_at.is_some()
    }
}

#[cfg(test)]
#[path = "preparation_tests.rs"]
mod tests;
