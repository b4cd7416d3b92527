//! Rows of the panels: settings of the document, under titles.

use burnish_core::document::Document;
use burnish_core::param::{Affects, ParamKind, ParamSpec, ParamValue};
use eframe::egui;

use crate::window::session::Session;
use crate::window::widget::param_ui;

/// Rows under a title that can be folded.
pub fn section(ui: &mut egui::Ui, title: &str, contents: impl FnOnce(&mut egui::Ui)) {
    egui::CollapsingHeader::new(title).default_open(true).show_unindented(ui, contents);
    ui.add_space(4.0);
}

/// A setting of the document that only the next frame reads.
pub const fn spec(
    key: &'static str,
    label: &'static str,
    unit: &'static str,
    kind: ParamKind,
    help: &'static str,
) -> ParamSpec {
    ParamSpec { key, label, unit, kind, help, affects: Affects::Frame }
}

/// A row for a value of the document: `set` writes a new one as the step `label`.
pub fn row_ui(
    ui: &mut egui::Ui,
    session: &mut Session,
    (spec, label): (&ParamSpec, &str),
    value: ParamValue,
    set: impl FnOnce(&mut Document, ParamValue),
) {
    let edit = param_ui(ui, spec, value, spec.default());
    if let Some(new) = edit.value(spec) {
        session.edit(label, "", |document| set(document, new));
    }
    // A run of camera moves is one step, whatever moves it.
    if edit.ended && label != burnish_core::document::VIEW_LABEL {
        session.seal();
    }
}

/// The number of a value that is one.
pub fn number(value: ParamValue) -> f64 {
    match value {
        ParamValue::Number(number) => number,
        ParamValue::Integer(number) => number as f64,
        _ => 0.0,
    }
}
