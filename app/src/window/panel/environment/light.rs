//! What lights the scene from infinitely far away: a map from a file, a sky or a studio, and how it stands.

use burnish_core::color::rgb::luminance;
use burnish_core::document::{BackgroundEntry, EnvironmentEntry, MadeEntry, SkyEntry, StudioEntry};
use burnish_core::param::{ParamKind, ParamSpec, ParamValue};
use burnish_core::scene::LightKind;
use eframe::egui;

use super::{Context, map, number, row_ui, sky, studio, tone};
use crate::number::short;
use crate::window::commands::Command;
use crate::window::files::typed_path;
use crate::window::panel::row::spec;
use crate::window::request::{Purpose, Request};
use crate::window::session::Session;
use crate::window::widget::{name_input, radio_ui};

const ROTATION: ParamSpec = spec(
    "rotation",
    "Rotation",
    "deg",
    ParamKind::Number { min: -180.0, max: 180.0, default: 0.0 },
    "Turns the environment counter-clockwise about the vertical axis; Shift+right drag in the viewport does it too.",
);

const STRENGTH: ParamSpec = spec(
    "strength",
    "Strength",
    "",
    ParamKind::Number { min: 0.0, max: 1000.0, default: 1.0 },
    "Factor on the radiance of the environment, background included; lamps keep theirs.",
);

const TINT: ParamSpec = spec(
    "tint",
    "Tint",
    "",
    ParamKind::Color { max: 4.0, default: [1.0; 3] },
    "Colour that multiplies the environment: its light, its reflections and the background.",
);

const SUN: ParamSpec = spec(
    "sun-split",
    "Sun as a light",
    "",
    ParamKind::Toggle { default: false },
    "Takes the brightest small region out of the map and makes a light of it: its shadows are sharp, and its strength can be \
     set where the file has cut it off.",
);

pub(super) const SUN_STRENGTH: ParamSpec = spec(
    "sun-strength",
    "Sun strength",
    "",
    ParamKind::Number { min: 0.0, max: 1000.0, default: 1.0 },
    "Factor on the light of the sun alone: many files cut it off.",
);

/// Where the map comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// A file, the scene, or the built-in studio.
    File,
    Sky,
    Studio,
}

/// A map from a file, and what is done with its sun.
#[derive(Clone)]
struct FileEntry {
    source: Option<String>,
    sun_split: bool,
    sun_strength: f64,
}

/// Which map, and how it stands.
#[derive(Default)]
pub struct LightSection {
    path: String,
    map: map::MapView,
    /// The softbox that is edited.
    softbox: usize,
    /// What there was before another kind was chosen.
    file: Option<FileEntry>,
    sky: Option<SkyEntry>,
    studio: Option<StudioEntry>,
}

impl LightSection {
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let kind = self.kind_ui(ui, context.session);
        source_ui(ui, context.session);
        self.map.ui(ui, context.session, &mut self.softbox);
        let made = context.session.document().environment.made.clone();
        match (kind, made) {
            (Kind::Sky, Some(MadeEntry::Sky(entry))) => sky::ui(ui, context.session, &entry),
            (Kind::Studio, Some(MadeEntry::Studio(entry))) => {
                studio::ui(ui, context.session, &entry, &mut self.softbox);
            }
            _ => self.file_ui(ui, context),
        }
        let environment = &context.session.document().environment;
        let (rotation, strength, tint) = (environment.rotation_deg, environment.strength, environment.tint);
        let rotate = (&ROTATION, "Rotate environment");
        row_ui(ui, context.session, rotate, ParamValue::Number(rotation), |document, value| {
            document.environment.rotation_deg = number(value);
        });
        let strengthen = (&STRENGTH, "Environment strength");
        row_ui(ui, context.session, strengthen, ParamValue::Number(strength), |document, value| {
            document.environment.strength = number(value);
        });
        row_ui(ui, context.session, (&TINT, "Environment tint"), ParamValue::Color(tint), |document, value| {
            if let ParamValue::Color(tint) = value {
                document.environment.tint = tint;
            }
        });
        let hover = "Write the map as .hdr or .exr, with strength and tint, not turned, without a sun that is a light.";
        if ui.button("Save environment...").on_hover_text(hover).clicked() {
            context.requests.push(Request::Command(Command::SaveEnvironment));
        }
    }

    /// The choice of the kind.
    fn kind_ui(&mut self, ui: &mut egui::Ui, session: &mut Session) -> Kind {
        let kind = kind(session);
        ui.horizontal_wrapped(|ui| {
            for (other, title, hover) in [
                (Kind::File, "HDRI", "A map from a file, else that of the scene, else the built-in studio."),
                (Kind::Sky, "Sky", "A sky by day by a few numbers, in true nit: the exposure is set for it."),
                (Kind::Studio, "Studio", "Softboxes before a backdrop."),
            ] {
                if radio_ui(ui, kind == other, title, hover) {
                    self.choose(session, other);
                }
            }
        });
        kind
    }

    /// Goes over to another kind as one step.
    fn choose(&mut self, session: &mut Session, kind: Kind) {
        let before = self::kind(session);
        let EnvironmentEntry { source, made, sun_split, sun_strength, .. } = session.document().environment.clone();
        match made {
            Some(MadeEntry::Sky(sky)) if before == Kind::Sky => self.sky = Some(sky),
            Some(MadeEntry::Studio(studio)) if before == Kind::Studio => self.studio = Some(studio),
            _ => self.file = Some(FileEntry { source, sun_split, sun_strength }),
        }
        let none = FileEntry { source: None, sun_split: false, sun_strength: 1.0 };
        let file = self.file.clone().filter(|_| kind == Kind::File).unwrap_or(none);
        let made = match kind {
            Kind::File => None,
            Kind::Sky => Some(MadeEntry::Sky(self.sky.clone().unwrap_or_default())),
            Kind::Studio => Some(MadeEntry::Studio(self.studio.clone().unwrap_or_default())),
        };
        let label = "Kind of environment";
        session.seal();
        session.edit(label, "", |document| {
            let environment = &mut document.environment;
            environment.made = made;
            (environment.source, environment.sun_split) = (file.source, file.sun_split);
            environment.sun_strength = file.sun_strength;
        });
        // Skies are some 10 000 times as bright as what stands in other maps.
        if kind == Kind::Sky || before == Kind::Sky {
            tone::expose(session, label, "");
        }
        session.seal();
    }

    /// Loading a file, and the sun in it.
    fn file_ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        ui.horizontal(|ui| {
            if ui.button("Load HDRI...").on_hover_text("Pick an .hdr or .exr file to light the scene with.").clicked() {
                context.requests.push(Request::PickFile(Purpose::Environment));
            }
            let changed = context.session.document().environment.source.is_some();
            let clear = ui.add_enabled(changed, egui::Button::new("Clear HDRI"));
            let hover = "Go back to the environment of the model, or the built-in studio where it has none.";
            if clear.on_hover_text(hover).clicked() {
                context.session.edit("Clear HDRI", "", |document| document.environment.source = None);
            }
        });
        self.path_ui(ui, context);
        let split = context.session.document().environment.sun_split;
        row_ui(ui, context.session, (&SUN, "Sun as a light"), ParamValue::Toggle(split), |document, value| {
            document.environment.sun_split = value == ParamValue::Toggle(true);
        });
        if split {
            strength_ui(ui, context.session);
            let text = sun_text(context.session);
            ui.add(egui::Label::new(egui::RichText::new(text).small().weak()).wrap());
        }
    }

    /// The way around dialogs, which some systems do not have.
    fn path_ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        ui.horizontal(|ui| {
            let width = (ui.available_width() - 50.0).max(40.0);
            let field =
                egui::TextEdit::singleline(&mut self.path).hint_text("path of an .hdr or .exr").desired_width(width);
            let field = ui.add(field).on_hover_text("Path of an HDRI; Enter loads it.");
            name_input(&field, "HDRI path", &self.path);
            let entered = field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
            let named = !self.path.trim().is_empty();
            let button = ui.add_enabled(named, egui::Button::new("Load")).on_hover_text("Load the HDRI at this path.");
            if named && (button.clicked() || entered) {
                context.requests.push(Request::LoadEnvironment(typed_path(&self.path)));
            }
        });
    }
}

/// What lights the scene.
fn source_ui(ui: &mut egui::Ui, session: &Session) {
    let Some(map) = &session.scene().environment else {
        ui.weak("No environment");
        return;
    };
    let document = session.document();
    let from = match &document.environment.source {
        Some(path) => path.clone(),
        None if document.environment.made.is_some() => "It is made by the numbers below.".into(),
        None if session.sources().models.get(&document.scene).is_some_and(|model| model.environment.is_some()) => {
            "It comes with the scene.".into()
        }
        None => "The built-in studio, since neither document nor scene has an environment.".into(),
    };
    let name = if map.name.is_empty() { "unnamed" } else { &map.name };
    ui.add(egui::Label::new(egui::RichText::new(name).strong()).truncate()).on_hover_text(from);
    let background = match &document.environment {
        EnvironmentEntry { background: BackgroundEntry::Color(_), .. } => "a colour is the background",
        environment if environment.background_blur_deg > 0.0 => "blurred the background",
        _ => "also the background",
    };
    let hover = "Equirectangular map of radiance.";
    ui.weak(format!("{} x {} pixels, {background}", map.width, map.height)).on_hover_text(hover);
}

/// The row of the sun's own strength.
pub(super) fn strength_ui(ui: &mut egui::Ui, session: &mut Session) {
    let strength = ParamValue::Number(session.document().environment.sun_strength);
    row_ui(ui, session, (&SUN_STRENGTH, "Sun strength"), strength, |document, value| {
        document.environment.sun_strength = number(value);
    });
}

/// Where the map of the document comes from.
fn kind(session: &Session) -> Kind {
    let environment = &session.document().environment;
    match (&environment.source, &environment.made) {
        (None, Some(MadeEntry::Sky(_))) => Kind::Sky,
        (None, Some(MadeEntry::Studio(_))) => Kind::Studio,
        _ => Kind::File,
    }
}

/// The sun that was taken out of the map, or why there is none.
fn sun_text(session: &Session) -> String {
    // After all lights of the document.
    let sun = session.scene().lights.iter().rev().find(|light| light.name.starts_with("Sun of "));
    match sun.map(|sun| (sun, sun.kind)) {
        Some((sun, LightKind::Directional { angular_radius })) => format!(
            "{}: {} lx on a surface that faces it, {:.2} degrees wide",
            sun.name,
            short(f64::from(luminance(sun.intensity))),
            2.0 * angular_radius.to_degrees()
        ),
        _ => {
            let why = session.resolved().notices.iter().find(|notice| notice.contains("no sun"));
            why.cloned().unwrap_or_else(|| "No sun was taken out.".into())
        }
    }
}
