//! Time against error of the scene that is open: what is measured, the chart, what is known of the picked mark.

mod diagram;
mod plan;
mod plot;

use std::sync::Arc;

use burnish_core::document::Side;
use burnish_core::measure::bench::{Record, Region};
use eframe::egui;

use super::Context;
use crate::number::short;
use crate::window::chart::ErrorMeasure;
use crate::window::commands::Command;
use crate::window::compare::CompareView;
use crate::window::request::Request;
use crate::window::widget::choice_ui;
use diagram::{Diagram, Mark};

/// Points of the chart's height.
const HEIGHT: [f32; 2] = [180.0, 420.0];
/// Regions as they are offered.
const REGIONS: [(Region, &str); 3] = [
    (Region::Subject, "on the subject"),
    (Region::Interior, "on the subject without silhouettes"),
    (Region::Frame, "of the frame"),
];

/// The panel.
#[derive(Default)]
pub struct ChartPanel {
    /// Place of the picked record.
    picked: Option<usize>,
    /// Places of the records that became sides.
    stored: [Option<usize>; 2],
    /// The records that were shown last.
    shown: Arc<Vec<Record>>,
    /// Made once for what is drawn of them.
    diagram: Option<(ErrorMeasure, Region, Arc<Diagram>)>,
}

impl ChartPanel {
    /// Shows the panel.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let records = context.chart.records();
        let arrived = !Arc::ptr_eq(&records, &self.shown) && !records.is_empty() && self.take(&records);
        // The chart needs the room, once there is one.
        let header = egui::CollapsingHeader::new("What is measured").default_open(true).open(arrived.then_some(false));
        header.show_unindented(ui, |ui| plan::ui(ui, context));
        plan::run_ui(ui, context);
        if records.is_empty() {
            if !context.chart.is_busy() {
                ui.weak("Nothing is measured yet.");
            }
            return;
        }
        ui.separator();
        axis_ui(ui, context);
        if context.chart.is_stale(context.session) {
            let words = "Of an earlier scene or point of view";
            ui.colored_label(ui.visuals().warn_fg_color, words).on_hover_text("Measure again to see what changed.");
        }
        self.chart_ui(ui, context, &records);
    }

    /// Takes over records and returns true where they are all others: more of a measurement come to those that are there,
    /// and what was picked of them stays picked.
    fn take(&mut self, records: &Arc<Vec<Record>>) -> bool {
        let place = |old: Option<usize>| {
            let old = self.shown.get(old?)?;
            records.iter().position(|record| record == old)
        };
        let (picked, stored) = (place(self.picked), self.stored.map(place));
        let are_others = !self.shown.iter().any(|record| records.contains(record));
        *self = ChartPanel { picked, stored, shown: records.clone(), diagram: None };
        are_others
    }

    fn chart_ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>, records: &[Record]) {
        let diagram = self.diagram(records, context.chart.measure, context.chart.region);
        let sides: Vec<String> = diagram.marks.iter().map(|mark| self.letters(context, mark.record, records)).collect();
        let picked = diagram.marks.iter().position(|mark| Some(mark.record) == self.picked);
        let hover = |mark: &Mark| format!("{}\n{}", mark.label, details(&records[mark.record]));
        let notes = plot::Notes { picked, sides: &sides, details: &hover };
        let height = (0.85 * ui.available_width()).clamp(HEIGHT[0], HEIGHT[1]);
        let mark = diagram.marks.iter().find(|mark| Some(mark.record) == self.picked);
        if let Some((mark, side)) = pick_ui(ui, mark).and_then(|side| Some((mark?, side))) {
            self.store(context, mark.record, &records[mark.record], side);
        }
        plot::legend(ui, &diagram);
        if let Some((clicked, shift)) = plot::ui(ui, &diagram, height, &notes) {
            self.picked = diagram.marks.get(clicked).map(|mark| mark.record);
            if let Some((place, record)) = self.picked.and_then(|place| Some((place, records.get(place)?)))
                && shift
            {
                self.store(context, place, record, Side::A);
            }
        }
        if let Some(mark) = mark {
            ui.small(details(&records[mark.record]));
        }
    }

    fn diagram(&mut self, records: &[Record], measure: ErrorMeasure, region: Region) -> Arc<Diagram> {
        let known = self.diagram.as_ref().filter(|(of, on, _)| (*of, *on) == (measure, region));
        let diagram = known.map_or_else(|| Arc::new(Diagram::new(records, measure, region)), |known| known.2.clone());
        self.diagram = Some((measure, region, diagram.clone()));
        diagram
    }

    /// Makes a record a side; where both sides are there, they are shown.
    fn store(&mut self, context: &mut Context<'_>, place: usize, record: &Record, side: Side) {
        if context.chart.settings(record).is_none() {
            let words = format!("This program has no method `{}`.", record.method);
            return context.requests.push(Request::Error(words));
        }
        context.chart.store(record, side, context.session);
        self.stored[side as usize] = Some(place);
        let both = Side::ALL.iter().all(|side| context.session.document().snapshot_of(*side).is_some());
        let shown = context.compare.view().is_some_and(CompareView::has_sides);
        if both && !shown {
            context.requests.push(Request::Command(Command::Compare(CompareView::Wipe)));
        } else {
            let more = if both { "" } else { "; store another mark as the other side to compare" };
            context.requests.push(Request::Notice(format!("Stored as {}{more}", side.letter())));
        }
    }

    /// The letters of the sides that a record was made, as long as they are so.
    fn letters(&self, context: &Context<'_>, place: usize, records: &[Record]) -> String {
        let found = records.get(place).and_then(|record| context.chart.settings(record));
        let Some((id, settings)) = found else { return String::new() };
        let is = |side: &Side| {
            self.stored[*side as usize] == Some(place) && context.session.document().is_side_by(*side, id, &settings)
        };
        Side::ALL.into_iter().filter(is).map(Side::letter).collect()
    }
}

/// Which error, and where.
fn axis_ui(ui: &mut egui::Ui, context: &mut Context<'_>) {
    ui.horizontal(|ui| {
        let width = ui.available_width() - ui.spacing().item_spacing.x;
        let index = ErrorMeasure::ALL.iter().position(|measure| *measure == context.chart.measure).unwrap_or(0);
        let titles = ErrorMeasure::ALL.map(ErrorMeasure::title);
        let hover = context.chart.measure.help();
        if let Some(picked) = choice_ui(ui, "Error", &titles, index, 0.4 * width, None, hover) {
            context.chart.measure = ErrorMeasure::ALL[picked];
        }
        let index = REGIONS.iter().position(|(region, _)| *region == context.chart.region).unwrap_or(0);
        let hover = "The pixels on which the error is told.";
        if let Some(picked) = choice_ui(ui, "Region", &REGIONS.map(|(_, name)| name), index, 0.6 * width, None, hover) {
            context.chart.region = REGIONS[picked].0;
        }
    });
}

/// The picked mark and the means to look at it, in a place that is always there: the chart does not move. Returns the
/// side that it is to be.
fn pick_ui(ui: &mut egui::Ui, picked: Option<&Mark>) -> Option<Side> {
    match picked {
        Some(mark) => {
            let noise = if mark.hollow { " (noise)" } else { "" };
            let text = egui::RichText::new(format!("{}{noise}", mark.label)).strong();
            ui.add(egui::Label::new(text).truncate());
        }
        None => _ = ui.weak("Click a mark to compare it."),
    }
    let mut chosen = None;
    ui.horizontal(|ui| {
        for side in Side::ALL {
            let letter = side.letter();
            let hover = format!("Show the document by this method and these settings as side {letter}.");
            let button = ui.add_enabled(picked.is_some(), egui::Button::new(format!("As {letter}")));
            if button.on_hover_text(hover).clicked() {
                chosen = Some(side);
            }
        }
    });
    chosen
}

/// Costs and errors in words.
fn details(record: &Record) -> String {
    let memory = record.bytes.map_or_else(|| "unknown".into(), |bytes| format!("{} MB", short(bytes as f64 / 1e6)));
    let mut text = format!(
        "{} ms a frame, {} x calibration, {} frames\nprepared in {} s, memory {memory}\n{} x {} pixels, reference of {} paths{}",
        short(1e3 * record.frame_secs),
        short(record.ratio()),
        record.frames,
        short(record.prepare_secs),
        record.width,
        record.height,
        record.truth_samples,
        record.truth_text()
    );
    for (region, name) in REGIONS {
        let Some((errors, _)) = record.of(region) else { continue };
        let told = ErrorMeasure::ALL.map(|measure| format!("{} {}", measure.title(), short(measure.of(&errors))));
        text += &format!("\n{name}: {}", told.join(", "));
    }
    text + "\n" + &record.settings_text()
}
