//! Time against error of the scene that is open: what is to be measured, the thread that measures, the records.
//!
//! The list of methods is taken here and nowhere else in the window.

mod job;
mod plan;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use burnish_core::document::Side;
use burnish_core::job::{Job, Outcome};
use burnish_core::lighting;
use burnish_core::lighting::method::{self, Method, MethodId};
use burnish_core::measure::Errors;
use burnish_core::measure::bench::{BenchError, COMPARED_FRAMES, Cache, Record, Region, Shot};
use burnish_core::param::Settings;
use burnish_core::scene::{Camera, Scene, gallery};
use eframe::egui;

use super::session::Session;
use job::{Arrivals, Measured, Order, Words};

pub use plan::{Chosen, Plan};

/// What the chart shows of the errors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ErrorMeasure {
    /// Relative mean squared error.
    #[default]
    RelMse,
    /// Mean of the FLIP map.
    Flip,
    /// Mean of the absolute difference.
    Difference,
    /// Absolute value of the bias.
    Bias,
}

impl ErrorMeasure {
    /// All of them.
    pub const ALL: [ErrorMeasure; 4] =
        [ErrorMeasure::RelMse, ErrorMeasure::Flip, ErrorMeasure::Difference, ErrorMeasure::Bias];

    /// Name for people.
    pub fn title(self) -> &'static str {
        match self {
            ErrorMeasure::RelMse => "relMSE",
            ErrorMeasure::Flip => "FLIP",
            ErrorMeasure::Difference => "difference",
            ErrorMeasure::Bias => "bias",
        }
    }

    /// What it is.
    pub fn help(self) -> &'static str {
        match self {
            ErrorMeasure::RelMse => "Mean of (x - r)² / (r² + 0.01) over pixels and R, G, B.",
            ErrorMeasure::Flip => "Mean of the FLIP map at the exposure of the document, 0 to 1.",
            ErrorMeasure::Difference => "Mean of |x - r| over the mean of r.",
            ErrorMeasure::Bias => "Difference of mean luminance relative to the reference's, without its sign.",
        }
    }

    /// Its value, 0 or more.
    pub fn of(self, errors: &Errors) -> f64 {
        match self {
            ErrorMeasure::RelMse => errors.relmse,
            ErrorMeasure::Flip => errors.flip,
            ErrorMeasure::Difference => errors.difference,
            ErrorMeasure::Bias => errors.bias.abs(),
        }
    }
}

/// What was measured last.
struct Measurement {
    records: Arc<Vec<Record>>,
    /// The scene and the point of view that they are of; absent for records from elsewhere.
    of: Option<(Arc<Scene>, Camera)>,
}

struct Running {
    job: Job<Measured>,
    words: Words,
    arrivals: Arrivals,
    /// What has arrived, by the places of the candidates.
    records: BTreeMap<usize, Record>,
    of: (Arc<Scene>, Camera),
    ends: bool,
}

/// The chart of a window.
pub struct Chart {
    methods: Vec<&'static dyn Method>,
    /// What is to be measured.
    pub plan: Plan,
    /// What is drawn of the errors.
    pub measure: ErrorMeasure,
    /// Where errors are told; the subject where it has pixels.
    pub region: Region,
    /// Folder of what is kept.
    folder: Option<PathBuf>,
    running: Option<Running>,
    shown: Option<Measurement>,
    /// Why the last measurement gave nothing.
    fault: Option<String>,
}

impl Chart {
    /// Keeps results in a folder, or none where there is none.
    pub fn new(folder: Option<PathBuf>) -> Chart {
        let methods = lighting::methods();
        Chart {
            plan: Plan::new(&methods),
            methods,
            measure: ErrorMeasure::default(),
            region: Region::Subject,
            folder,
            running: None,
            shown: None,
            fault: None,
        }
    }

    /// What was measured last.
    pub fn records(&self) -> Arc<Vec<Record>> {
        self.shown.as_ref().map(|shown| shown.records.clone()).unwrap_or_default()
    }

    /// Shows records from elsewhere.
    pub fn set_records(&mut self, records: Vec<Record>) {
        self.shown = Some(Measurement { records: Arc::new(records), of: None });
        self.fault = None;
    }

    /// Why the last measurement gave nothing, in words.
    pub fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }

    /// What the thread does, in words; `None` while there is none.
    pub fn progress(&self) -> Option<String> {
        let running = self.running.as_ref()?;
        Some(if running.ends { "ending".into() } else { running.words.get() })
    }

    /// A thread measures, or was told to end and has not heard it yet.
    pub fn is_busy(&self) -> bool {
        self.running.is_some()
    }

    /// A thread was told to end.
    pub fn is_ending(&self) -> bool {
        self.running.as_ref().is_some_and(|running| running.ends)
    }

    /// What is shown was measured of another scene or from elsewhere.
    pub fn is_stale(&self, session: &Session) -> bool {
        let of = self.shown.as_ref().and_then(|shown| shown.of.as_ref());
        of.is_some_and(|(scene, camera)| {
            let now = session.document().view.camera.camera();
            !Arc::ptr_eq(scene, session.scene())
                || (now.world_from_view, &now.projection) != (camera.world_from_view, &camera.projection)
        })
    }

    /// Starts to measure the document as it is now, unless a thread is at work or the plan is wrong.
    pub fn start(&mut self, session: &Session, ctx: &egui::Context) {
        let Some(candidates) = self.plan.candidates().filter(|_| self.running.is_none()) else { return };
        let shot = shot(session, self.plan.size);
        let of = (session.scene().clone(), shot.camera.clone());
        let cache = self.folder.as_deref().map_or_else(Cache::none, Cache::within);
        let cache = if self.plan.fresh { cache.fresh() } else { cache };
        self.fault = None;
        let (job, words, arrivals) = job::start(Order { shot, candidates, samples: self.plan.samples, cache }, ctx);
        self.running = Some(Running { job, words, arrivals, records: BTreeMap::new(), of, ends: false });
    }

    /// Ends the measurement: at once for the window, for its thread between two frames.
    pub fn cancel(&mut self) {
        if let Some(running) = &mut self.running {
            running.job.cancel();
            running.ends = true;
        }
    }

    /// Takes over what the thread has done; once a frame.
    pub fn frame(&mut self) {
        self.take_arrivals();
        let Some(running) = &mut self.running else { return };
        let done = match running.job.poll() {
            Outcome::Running => return,
            Outcome::Done(done) => done,
            Outcome::Failed => Err(BenchError::Method("measuring failed".into())),
        };
        let Some(Running { of, ends, .. }) = self.running.take() else { return };
        match done {
            _ if ends => {}
            // Most often all have arrived before.
            Ok(records) if *self.records() == records => {}
            Ok(records) => self.shown = Some(Measurement { records: Arc::new(records), of: Some(of) }),
            Err(error) => self.fault = Some(error.to_string()),
        }
    }

    /// Shows what is measured so far, unless it was told to end; the first record takes the place of what was shown.
    fn take_arrivals(&mut self) {
        let Some(running) = self.running.as_mut().filter(|running| !running.ends) else { return };
        let before = running.records.len();
        running.records.extend(running.arrivals.try_iter());
        if running.records.len() > before {
            let records = Arc::new(running.records.values().cloned().collect());
            self.shown = Some(Measurement { records, of: Some(running.of.clone()) });
        }
    }

    /// The method and the settings of a record; `None` where this program has no such method. What it does not know of the
    /// settings keeps its default.
    pub fn settings(&self, record: &Record) -> Option<(MethodId, Settings)> {
        let info = method::find(&self.methods, &record.method).ok()?.info();
        let mut settings = Settings::new(info.params);
        for (key, text) in &record.settings {
            let _ = settings.set(key, text);
        }
        Some((info.id, settings))
    }

    /// Keeps the document by the method and settings of a record as a side, as one step.
    pub fn store(&self, record: &Record, side: Side, session: &mut Session) {
        let Some((id, settings)) = self.settings(record) else { return };
        session.seal();
        let label = format!("Chart point as {}", side.letter());
        session.edit(&label, "", |document| document.store_side_by(side, id, &settings));
        session.seal();
    }
}

/// The document as it is now, from the window's point of view.
fn shot(session: &Session, size: glam::UVec2) -> Shot {
    let document = session.document();
    let mut scene = session.scene().clone();
    if scene.environment.is_none() {
        Arc::make_mut(&mut scene).environment = Some(Arc::new(gallery::studio()));
    }
    let name = session.path.as_ref().map_or_else(|| document.scene.clone(), |path| path.to_string_lossy().into_owned());
    let metals = document.presets.iter().map(|metal| (metal.id.clone(), Clone::clone(&**metal))).collect();
    let (camera, exposure_ev) = (document.view.camera.camera(), document.view.exposure_ev as f32);
    Shot { name, scene, camera, size, exposure_ev, compared_frames: COMPARED_FRAMES, metals }
}

#[cfg(test)]
mod tests {
    use super::*;
    use burnish_core::document;
    use burnish_core::param::ParamValue;

    #[test]
    fn a_record_becomes_a_side_in_one_step() {
        let mut session = Session::new(document::open("gallery:workbench").unwrap(), None);
        let chart = Chart::new(None);
        let mut record = crate::report::bench::tests::record("ring", "classical", 16, 3.0, 0.01);
        chart.store(&record, Side::B, &mut session);
        let shown = session.document().of_side(Side::B);
        assert_eq!(shown.lighting.settings().get("samples"), Some(ParamValue::Integer(16)));
        let (id, settings) = chart.settings(&record).unwrap();
        assert!(session.document().is_side_by(Side::B, id, &settings));
        assert_eq!(session.undo().as_deref(), Some("Chart point as B"));
        record.method = "radiosity".into();
        chart.store(&record, Side::B, &mut session);
        assert!(session.document().snapshots.is_empty(), "nobody could show it");
    }

    #[test]
    fn what_was_measured_is_stale_when_scene_or_point_of_view_change() {
        let mut session = Session::new(document::open("gallery:workbench").unwrap(), None);
        let mut chart = Chart::new(None);
        let of = (session.scene().clone(), session.document().view.camera.camera());
        chart.shown = Some(Measurement { records: Arc::default(), of: Some(of) });
        assert!(!chart.is_stale(&session));
        session.edit("Store as A", "", |document| document.store_side(Side::A));
        assert!(!chart.is_stale(&session), "a snapshot changes nothing");
        session.edit("View", "", |document| document.view.camera.orbit(10.0, 0.0));
        assert!(chart.is_stale(&session));
        session.undo();
        assert!(!chart.is_stale(&session));
        session.edit("Roughness", "", |document| document.set_value(0, "roughness", ParamValue::Number(0.9)).unwrap());
        assert!(chart.is_stale(&session));
    }
}
