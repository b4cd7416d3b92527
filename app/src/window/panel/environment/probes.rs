//! Probes: where the surroundings of objects are recorded, for the methods that look them up from there.

use burnish_core::document::{PROBE_PATHS, PROBE_RESOLUTIONS, ProbeEntry};
use burnish_core::job::{Handle, Job, Outcome};
use burnish_core::lighting::MethodError;
use burnish_core::lighting::impostor::{self, Placement};
use burnish_core::param::{ParamKind, ParamSpec, ParamValue};
use burnish_core::scene::ProbeSource;
use eframe::egui::{self, RichText, Role, WidgetInfo};
use glam::Vec3;

use super::Context;
use crate::window::panel::row::{number, spec};
use crate::window::pool;
use crate::window::session::Session;
use crate::window::widget::{name_widget, param_ui, typed_ui};

const OWN_PLACE: ParamSpec = spec(
    "own-place",
    "Own position",
    "",
    ParamKind::Toggle { default: false },
    "Stay where it is put; else it follows the middle of what it serves.",
);
const PLACE: ParamSpec = spec(
    "probe-place",
    "Probe position",
    "m",
    ParamKind::Vector { min: [-1e6; 3], max: [1e6; 3], default: [0.0; 3] },
    "From here the surroundings are seen.",
);
const BOUNDED: ParamSpec = spec(
    "bounded",
    "In a box",
    "",
    ParamKind::Toggle { default: false },
    "Serve only points in a box about it; toward its rim the next probe takes over.",
);
const BOX: ParamSpec = spec(
    "probe-box",
    "Half box",
    "m",
    ParamKind::Vector { min: [1e-3; 3], max: [1e6; 3], default: [1.0; 3] },
    "Half the edges of the box.",
);
const OWN_QUALITY: ParamSpec = spec(
    "own-quality",
    "Own quality",
    "",
    ParamKind::Toggle { default: false },
    "Have a resolution and paths of its own; else those of the method count.",
);
const RESOLUTION: ParamSpec = spec(
    "probe-resolution",
    "Probe resolution",
    "texels",
    ParamKind::Integer { min: *PROBE_RESOLUTIONS.start() as i64, max: *PROBE_RESOLUTIONS.end() as i64, default: 128 },
    "Along the edge of a face.",
);
const PATHS: ParamSpec = spec(
    "own-paths",
    "Paths per texel",
    "",
    ParamKind::Integer { min: *PROBE_PATHS.start() as i64, max: *PROBE_PATHS.end() as i64, default: 32 },
    "Paths that are traced for a texel.",
);
const SOURCE: ParamSpec = spec(
    "probe-source",
    "Light",
    "",
    ParamKind::Choice { options: &SOURCES, default: 0 },
    "traced: all light, in seconds. raster: direct light of lamps and environment, in a moment.",
);
const SOURCES: [&str; 2] = [ProbeSource::ALL[0].id(), ProbeSource::ALL[1].id()];

const BOUND: ParamSpec = spec(
    "bound",
    "Largest error",
    "deg",
    ParamKind::Number { min: 0.05, max: 45.0, default: 1.0 },
    "Of 95 % of the rays that leave what is served: as few probes are placed as keep it.",
);

/// The probes of the document, and a search for places.
pub struct ProbesSection {
    bound: f64,
    placing: Option<Placing>,
    /// What the last search found.
    told: String,
}

/// A search for places.
struct Placing {
    serves: Vec<String>,
    job: Job<Result<Placement, MethodError>>,
}

impl Default for ProbesSection {
    fn default() -> Self {
        ProbesSection { bound: number(BOUND.default()), placing: None, told: String::new() }
    }
}

impl ProbesSection {
    /// Shows the list, the chosen probe, and what places some by itself.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        list_ui(ui, context);
        let edit = param_ui(ui, &BOUND, ParamValue::Number(self.bound), BOUND.default());
        if let Some(bound) = edit.value(&BOUND) {
            self.bound = number(bound);
        }
        self.poll(context);
        ui.horizontal_wrapped(|ui| match &self.placing {
            Some(placing) => {
                ui.label(RichText::new(format!("placing {:.0} %", 100.0 * placing.job.progress())).small());
                if ui.small_button("Cancel placing").clicked() {
                    self.placing = None;
                }
            }
            None => {
                let hover = "For the selected objects, for the subject where none is: finds places and replaces the probes that serve \
                             the same.";
                if ui.button("Place automatically").on_hover_text(hover).clicked() {
                    self.start(context.session, ui.ctx());
                }
            }
        });
        if !self.told.is_empty() {
            ui.label(RichText::new(&self.told).small().weak());
        }
    }

    fn start(&mut self, session: &Session, ctx: &egui::Context) {
        let (scene, keys) = (session.scene().clone(), &session.resolved().object_keys);
        let serves = session.selection.objects.clone();
        let of_keys = || serves.iter().filter_map(|key| keys.iter().position(|known| known == key)).collect();
        let served = if serves.is_empty() { scene.served() } else { of_keys() };
        let (effort, bound, ctx) = (impostor::effort(&session.document().lighting.settings()), self.bound, ctx.clone());
        self.told.clear();
        let work = move |job: &Handle| pool::install(|| impostor::place(&scene, &served, bound as f32, &effort, job));
        let job = Job::spawn("Placing probes", move || ctx.request_repaint(), work);
        self.placing = Some(Placing { serves, job });
    }

    fn poll(&mut self, context: &mut Context<'_>) {
        let Some(placing) = &mut self.placing else { return };
        let found = match placing.job.poll() {
            Outcome::Running => return,
            Outcome::Done(found) => found,
            Outcome::Failed => Err(MethodError::Unfit("it failed for an unknown reason".into())),
        };
        let Some(Placing { serves, .. }) = self.placing.take() else { return };
        match found {
            Ok(Placement { places, p95 }) => {
                self.told = format!("{} placed: 95 % of the rays are right to {p95:.2} deg", places.len());
                let mut first = String::new();
                context.session.edit("Place probes", "", |document| {
                    first = document.place_probes(&serves, &places);
                });
                context.aids.probes.chosen = first;
                context.aids.probes.places = true;
            }
            Err(error) => self.told = error.to_string(),
        }
    }
}

fn list_ui(ui: &mut egui::Ui, context: &mut Context<'_>) {
    let probes = context.session.document().probes.clone();
    buttons_ui(ui, context, &probes);
    if probes.is_empty() {
        ui.label(RichText::new("One probe, in the middle of the subject").small().weak())
            .on_hover_text("Add one to say where it stands, what it serves and how it is recorded.");
    }
    for probe in &probes {
        let chosen = probe.name == context.aids.probes.chosen;
        let response = ui.selectable_label(chosen, &probe.name).on_hover_text(served(probe));
        response.widget_info(|| WidgetInfo::selected(Role::ListItem, true, chosen, format!("Probe {}", probe.name)));
        if response.clicked() {
            context.aids.probes.chosen.clone_from(&probe.name);
        }
    }
    if let Some(probe) = probes.iter().find(|probe| probe.name == context.aids.probes.chosen) {
        ui.push_id(&probe.name, |ui| probe_ui(ui, context, probe));
    }
    ui.horizontal_wrapped(|ui| {
        let marks = &mut context.aids.probes;
        ui.checkbox(&mut marks.places, "Show probes").on_hover_text("Where they stand, and the box of the chosen one.");
        ui.checkbox(&mut marks.distances, "Show distances")
            .on_hover_text("The surfaces that the chosen one sees, as points where it takes them to be.");
    });
}

fn buttons_ui(ui: &mut egui::Ui, context: &mut Context<'_>, probes: &[ProbeEntry]) {
    let chosen = context.aids.probes.chosen.clone();
    let is_chosen = probes.iter().any(|probe| probe.name == chosen);
    ui.horizontal_wrapped(|ui| {
        let selected = context.session.selection.objects.clone();
        let hover = "A probe for the selected objects, for the subject where none is.";
        if ui.button("Add probe").on_hover_text(hover).clicked() {
            let mut name = String::new();
            context.session.edit("Add probe", "", |document| name = document.add_probe(selected));
            context.aids.probes.chosen = name;
            context.aids.probes.places = true;
        }
        let button = |ui: &mut egui::Ui, text: &str, hover: &str| {
            let button = ui.add_enabled(is_chosen, egui::Button::new(text));
            name_widget(&button, &format!("{text} probe"));
            button.on_hover_text(hover).on_disabled_hover_text("Choose a probe first.").clicked()
        };
        if button(ui, "Duplicate", "A copy in the same place.") {
            let mut copy = None;
            context.session.edit("Duplicate probe", "", |document| copy = document.duplicate_probe(&chosen));
            context.aids.probes.chosen = copy.unwrap_or_default();
        }
        if button(ui, "Delete", "Remove the chosen probe.") {
            context.session.edit("Delete probe", "", |document| document.remove_probe(&chosen));
        }
    });
}

/// What it serves, in words.
fn served(probe: &ProbeEntry) -> String {
    match probe.serves.as_slice() {
        [] => "Serves the subject".into(),
        [one] => format!("Serves {one}"),
        [first, rest @ ..] => format!("Serves {first} and {} more", rest.len()),
    }
}

fn probe_ui(ui: &mut egui::Ui, context: &mut Context<'_>, probe: &ProbeEntry) {
    let name = probe.name.as_str();
    let (resolution, paths) = (probe.resolution, probe.paths);
    if let Some(typed) = typed_ui(ui, "Probe name", name, ui.available_width()) {
        let mut renamed = String::new();
        context.session.edit("Rename probe", "", |document| renamed = document.rename_probe(name, &typed));
        context.aids.probes.chosen = renamed;
        return;
    }
    let session = &mut *context.session;
    let vector = |v: Vec3| v.to_array().map(f64::from);
    row(ui, session, name, &OWN_PLACE, ParamValue::Toggle(probe.position.is_some()), {
        let middle = middle(session, name);
        move |probe, value| probe.position = (value == ParamValue::Toggle(true)).then(|| vector(middle))
    });
    if let Some(place) = probe.place() {
        row(ui, session, name, &PLACE, ParamValue::Vector(vector(place)), |probe, value| {
            probe.position = as_vector(value);
        });
    }
    row(ui, session, name, &BOUNDED, ParamValue::Toggle(probe.extent.is_some()), |probe, value| {
        probe.extent = (value == ParamValue::Toggle(true)).then_some([1.0; 3]);
    });
    if let Some(half) = probe.half() {
        row(ui, session, name, &BOX, ParamValue::Vector(vector(half)), |probe, value| probe.extent = as_vector(value));
    }
    let source = ProbeSource::ALL.iter().position(|source| *source == probe.source()).unwrap_or(0);
    row(ui, session, name, &SOURCE, ParamValue::Choice(source), |probe, value| {
        if let ParamValue::Choice(index) = value {
            probe.set_source(ProbeSource::ALL.get(index).copied().unwrap_or_default());
        }
    });
    let own = resolution.is_some() || paths.is_some();
    row(ui, session, name, &OWN_QUALITY, ParamValue::Toggle(own), |probe, value| {
        let on = value == ParamValue::Toggle(true);
        (probe.resolution, probe.paths) = if on { (Some(128), Some(32)) } else { (None, None) };
    });
    if own {
        let whole = |value: ParamValue| match value {
            ParamValue::Integer(number) => u32::try_from(number).ok(),
            _ => None,
        };
        let (texels, paths) = (resolution.unwrap_or(128), paths.unwrap_or(32));
        row(ui, session, name, &RESOLUTION, ParamValue::Integer(texels.into()), |probe, value| {
            probe.resolution = whole(value);
        });
        row(ui, session, name, &PATHS, ParamValue::Integer(paths.into()), |probe, value| probe.paths = whole(value));
    }
    serves_ui(ui, session, probe);
}

fn serves_ui(ui: &mut egui::Ui, session: &mut Session, probe: &ProbeEntry) {
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new(served(probe)).small());
        let selected = session.selection.objects.clone();
        let button = ui.add_enabled(!selected.is_empty(), egui::Button::new("Serve selected").small());
        let button = button.on_hover_text("It serves the selected objects, and does not see them.");
        if button.on_disabled_hover_text("Select objects first.").clicked() {
            set(session, "Objects of probe", &probe.name, |probe| probe.serves = selected);
        }
        if !probe.serves.is_empty() && ui.small_button("Serve the subject").clicked() {
            set(session, "Objects of probe", &probe.name, |probe| probe.serves.clear());
        }
    });
}

/// Where a probe stands now.
fn middle(session: &Session, name: &str) -> Vec3 {
    let site = session.probe_sites().iter().find(|site| site.name == name);
    site.map_or(session.subject_bounds().center(), |site| site.middle)
}

fn as_vector(value: ParamValue) -> Option<[f64; 3]> {
    match value {
        ParamValue::Vector(vector) => Some(vector),
        _ => None,
    }
}

fn set(session: &mut Session, label: &str, name: &str, change: impl FnOnce(&mut ProbeEntry)) {
    session.edit(label, name, |document| {
        if let Some(probe) = document.probe_mut(name) {
            change(probe);
        }
    });
}

/// A row for a value of a probe.
fn row(
    ui: &mut egui::Ui,
    session: &mut Session,
    name: &str,
    spec: &ParamSpec,
    value: ParamValue,
    change: impl FnOnce(&mut ProbeEntry, ParamValue),
) {
    let edit = param_ui(ui, spec, value, spec.default());
    if let Some(new) = edit.value(spec) {
        set(session, &format!("{} of probe", spec.label), name, |probe| change(probe, new));
    }
    if edit.ended {
        session.seal();
    }
}
