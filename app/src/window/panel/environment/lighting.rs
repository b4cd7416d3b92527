//! The lighting method: which, what it covers, its preparation, its settings.

use burnish_core::document::SHARED_SETTINGS;
use burnish_core::lighting::{self, Cover, Method};
use burnish_core::param::Settings;
use burnish_core::reference;
use eframe::egui::{self, RichText};

use super::super::Context;
use super::{overrides, row_ui};
use crate::window::preparation::{Preparation, State};
use crate::window::session::Session;
use crate::window::widget::{choice_ui, columns, name_ui};

/// The method panel, the same for all methods.
pub fn ui(ui: &mut egui::Ui, context: &mut Context<'_>) {
    let method = context.session.document().lighting.live_method();
    method_ui(ui, context.session, method);
    coverage_ui(ui, method);
    preparations_ui(ui, context);
    settings_ui(ui, context.session);
    overrides::ui(ui, context.session);
}

/// The choice of a method; the reference is not among them, it is shown beside every method.
fn method_ui(ui: &mut egui::Ui, session: &mut Session, method: &'static dyn Method) {
    let methods: Vec<_> = lighting::methods().into_iter().filter(|m| m.info().id.0 != reference::ID).collect();
    let titles: Vec<&str> = methods.iter().map(|method| method.info().title).collect();
    let chosen = methods.iter().position(|other| other.info().id == method.info().id).unwrap_or(0);
    ui.horizontal(|ui| {
        let [names, controls] = columns(ui);
        let name = name_ui(ui, "Method", chosen != 0, names);
        let picked = choice_ui(ui, "Method", &titles, chosen, controls, Some(&name), method.info().summary);
        if let Some(picked) = picked.and_then(|picked| methods.get(picked)) {
            session.edit("Lighting method", "", |document| document.lighting.choose(picked.info().id.0));
        }
    });
    ui.label(RichText::new(method.info().summary).small().weak());
}

/// What the method does of each term of the light, and what fills in the rest.
fn coverage_ui(ui: &mut egui::Ui, method: &dyn Method) {
    let coverage = method.info().coverage;
    egui::CollapsingHeader::new("Coverage").default_open(false).show(ui, |ui| {
        egui::Grid::new("coverage").num_columns(2).striped(true).show(ui, |ui| {
            for (term, cover, filled_by) in coverage.terms() {
                ui.label(RichText::new(term).small());
                let text = RichText::new(cover.words(filled_by)).small();
                ui.label(if cover == Cover::None { text.weak() } else { text });
                ui.end_row();
            }
        });
    });
}

/// How the preparations stand, and buttons to make them anew.
fn preparations_ui(ui: &mut egui::Ui, context: &mut Context<'_>) {
    for (place, preparation) in context.preparations.iter_mut().enumerate() {
        ui.push_id(place, |ui| preparation_ui(ui, preparation, place > 0));
    }
}

/// A preparation, with the name of the method where it is that of some objects.
fn preparation_ui(ui: &mut egui::Ui, preparation: &mut Preparation, is_named: bool) {
    let state = preparation.state();
    let (badge, hover) = match state {
        State::Needless => return,
        State::Missing => ("not prepared".into(), "Classical light is shown until the method is prepared."),
        State::Working(share) => {
            (format!("preparing {:.0} %", 100.0 * share), "What there was before stays in use meanwhile.")
        }
        State::Fresh => ("prepared".into(), "What the method looks up was made of this very scene."),
        State::Draft => {
            ("draft".into(), "Coarse, of this very scene; the whole is made when nothing changes for a moment.")
        }
        State::Aged(age) => {
            let size = age.map_or_else(String::new, |age| format!(", light off by {:.1} %", 100.0 * age));
            (
                format!("stale{size}"),
                "What was edited is lit rightly; what it sends to others is old until the whole is made anew, when nothing \
                 changes for a moment.",
            )
        }
        State::Stale => {
            ("stale".into(), "The scene or a setting changed since; what was prepared before stays in use.")
        }
    };
    ui.horizontal(|ui| {
        let color = match state {
            State::Stale | State::Aged(_) | State::Missing => ui.visuals().warn_fg_color,
            _ => ui.visuals().weak_text_color(),
        };
        if let Some(method) = preparation.method().filter(|_| is_named) {
            let hover = "The method of objects that are lit otherwise.";
            ui.label(RichText::new(method.info().title).small()).on_hover_text(hover);
        }
        ui.label(RichText::new(badge).small().color(color)).on_hover_text(hover);
        if let Some((bytes, took)) = preparation.cost() {
            let text = format!("{:.1} MB, {:.1} s", bytes as f64 / 1e6, took.as_secs_f64());
            ui.label(RichText::new(text).small().weak())
                .on_hover_text("Memory, and the time that it took to make or read.");
        }
        match state {
            State::Working(_) if ui.small_button("Cancel").clicked() => preparation.cancel(),
            State::Stale | State::Missing if ui.small_button("Prepare again").clicked() => {
                preparation.again(ui.ctx());
            }
            _ => {}
        }
    });
    for warning in preparation.warnings() {
        ui.label(RichText::new(warning).small().color(ui.visuals().warn_fg_color));
    }
    if let Some(fault) = preparation.fault() {
        ui.label(RichText::new(fault).small().color(ui.visuals().error_fg_color));
    }
}

/// A row for every setting that the method declares.
fn settings_ui(ui: &mut egui::Ui, session: &mut Session) {
    let settings: Settings = session.document().lighting.settings();
    for (spec, value) in settings.iter() {
        row_ui(ui, session, (spec, spec.label), value, |document, value| {
            // The widget gives values in range only.
            let _ = document.set_lighting(spec.key, value);
        });
    }
}

/// A row for every setting of the path tracer that is its own.
pub fn reference_ui(ui: &mut egui::Ui, session: &mut Session) {
    let hover =
        "Path tracing with next-event estimation. Masking and multiple scattering are those of the method above.";
    ui.label(reference::ID).on_hover_text(hover);
    let settings: Settings = session.document().lighting.reference_settings();
    // The method has settings of the same names.
    ui.push_id(reference::ID, |ui| {
        for (spec, value) in settings.iter().filter(|(spec, _)| !SHARED_SETTINGS.contains(&spec.key)) {
            row_ui(
                ui,
                session,
                (spec, &format!("Reference {}", spec.label.to_lowercase())),
                value,
                |document, value| {
                    // The widget gives values in range only.
                    let _ = document.set_reference(spec.key, value);
                },
            );
        }
    });
}
