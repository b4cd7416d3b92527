//! What is to be measured, as fields, and the button that measures.

use burnish_core::measure::bench::Candidate;
use eframe::egui::{self, DragValue};

use super::Context;
use crate::window::chart::Chosen;
use crate::window::widget::{name_input, name_widget};

/// Most fields for sweeps of a method.
const MOST_SWEEPS: usize = 4;

/// Methods with their sweeps, and the reference.
pub fn ui(ui: &mut egui::Ui, context: &mut Context<'_>) {
    for chosen in &mut context.chart.plan.methods {
        method_ui(ui, chosen);
    }
    ui.horizontal(|ui| {
        let name = ui.label("Paths of the reference");
        let field = DragValue::new(&mut context.chart.plan.samples).range(2..=1 << 24).speed(4.0);
        let hover = "Paths through a pixel of the picture that all are judged by, in two halves. Four times as many halve \
                     its noise, which stands in the chart as a line.";
        ui.add(field).labelled_by(name.id).on_hover_text(hover);
    });
    let hover = "Reads nothing that was kept. Without it only what is not known yet is measured: what is known is shared \
                 with `burnish chart`.";
    ui.checkbox(&mut context.chart.plan.fresh, "Measure anew").on_hover_text(hover);
}

fn method_ui(ui: &mut egui::Ui, chosen: &mut Chosen) {
    let info = chosen.info();
    ui.horizontal(|ui| {
        ui.checkbox(&mut chosen.on, info.id.0).on_hover_text(info.summary);
        let more = ui.add_enabled(chosen.on && chosen.sweeps.len() < MOST_SWEEPS, egui::Button::new("+").small());
        name_widget(&more, &format!("Vary another setting of {}", info.id));
        if more.on_hover_text("Vary another setting; all combinations are measured.").clicked() {
            chosen.sweeps.push(String::new());
        }
    });
    if !chosen.on {
        return;
    }
    let keys: Vec<String> = info.params.iter().map(|spec| format!("{}: {}", spec.key, spec.kind)).collect();
    let hover = format!("A setting and the values that it takes, such as samples=0,16,64.\n{}", keys.join("\n"));
    for index in 0..chosen.sweeps.len() {
        if let Some(text) = chosen.sweeps.get_mut(index) {
            let field = egui::TextEdit::singleline(text).desired_width(f32::INFINITY).hint_text("key=a,b,c");
            let field = ui.push_id((info.id.0, index), |ui| ui.add(field)).inner.on_hover_text(&hover);
            name_input(&field, &format!("Values of {} {}", info.id, index + 1), text);
        }
        if let Some(fault) = chosen.fault(index) {
            ui.colored_label(ui.visuals().error_fg_color, fault);
        }
    }
}

/// The button, and what goes on.
pub fn run_ui(ui: &mut egui::Ui, context: &mut Context<'_>) {
    let candidates = context.chart.plan.candidates();
    ui.horizontal(|ui| {
        if context.chart.is_busy() {
            let button = ui.add_enabled(!context.chart.is_ending(), egui::Button::new("Cancel"));
            if button.on_hover_text("End the measurement; what is finished is kept.").clicked() {
                context.chart.cancel();
            }
            // Nothing here moves: a window that is drawn takes time from what is timed.
            return;
        }
        let hover = "Measure the scene as it is, from this point of view. Leave the window alone meanwhile: what it draws \
                     takes time from what is timed.";
        let button = ui.add_enabled(candidates.is_some(), egui::Button::new("Measure")).on_hover_text(hover);
        if button.on_disabled_hover_text("Choose a method, and mend what is marked.").clicked() {
            context.chart.start(context.session, ui.ctx());
        }
        ui.weak(count(candidates.as_deref()));
    });
    if let Some(words) = context.chart.progress() {
        ui.small(words);
    }
    if let Some(fault) = context.chart.fault() {
        ui.colored_label(ui.visuals().error_fg_color, fault);
    }
}

fn count(candidates: Option<&[Candidate]>) -> String {
    match candidates.map_or(0, <[Candidate]>::len) {
        0 => "nothing to measure".into(),
        1 => "1 measurement".into(),
        many => format!("{many} measurements"),
    }
}
