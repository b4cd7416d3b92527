//! The preview of a table: what was read, how it was understood, what it looks like, and what to do with it.

use burnish_core::import::optical::{Finding, Format, ImportReport, Imported, OpticalError, OpticalFault, Unit};
use burnish_core::material::preset::Preset;
use eframe::egui::{self, Key, RichText};

use super::plot::plot_ui;
use super::{Origin, Preview};
use crate::window::panel::{Context, FormSettings, f0, f0_ui, forms_ui, warning_ui};
use crate::window::widget::{choice_ui, name_input};

/// Points of the window's contents.
const WIDTH: f32 = 440.0;
/// Points of the plot.
const PLOT_HEIGHT: f32 = 150.0;
/// Points around the part that scrolls.
const AROUND: f32 = 150.0;
/// Longest text that can be corrected here, bytes; more is corrected in the program that it came from.
const MAX_EDITED: usize = 64 << 10;

/// What became of a preview.
pub enum Answer {
    /// Still open.
    None,
    /// Closed.
    Cancel,
    /// Keep the metal.
    Import,
    /// Keep it and put it on the selected materials.
    ImportAndAssign,
}

impl Preview {
    /// Shows the preview; `waiting` more come after it.
    pub fn ui(&mut self, ctx: &egui::Context, waiting: usize, context: &mut Context<'_>) -> Answer {
        let screen = ctx.content_rect();
        let mut answer = Answer::None;
        // Asked before the frame: Escape is for an open list first, then for a field, then for the window.
        let busy = egui::Popup::is_any_open(ctx) || ctx.egui_wants_keyboard_input();
        let free = !busy && ctx.memory(|memory| memory.top_modal_layer().is_none());
        egui::Window::new("Import optical constants")
            .id(egui::Id::unique("import optical constants"))
            .collapsible(false)
            .resizable(false)
            .pivot(egui::Align2::CENTER_CENTER)
            .default_pos(screen.center())
            .show(ctx, |ui| {
                ui.set_width(WIDTH.min(screen.width() - 40.0));
                let height = (screen.height() - AROUND).max(120.0);
                egui::ScrollArea::vertical().max_height(height).show(ui, |ui| self.contents_ui(ui, context));
                ui.separator();
                answer = self.buttons_ui(ui, waiting);
            });
        if free && ctx.input(|input| input.key_pressed(Key::Escape)) {
            return Answer::Cancel;
        }
        answer
    }

    fn contents_ui(&mut self, ui: &mut egui::Ui, context: &Context<'_>) {
        let from = match &self.origin {
            Origin::File(path) => format!("From {}", path.display()),
            Origin::Text(_) => "From the clipboard".into(),
        };
        ui.add(egui::Label::new(RichText::new(from).weak()).truncate());
        match self.found.clone() {
            None => {
                ui.horizontal(|ui| {
                    ui.spinner();
                    ui.label("Reading and fitting...");
                });
            }
            Some(Ok(found)) => self.found_ui(ui, &found, context),
            Some(Err(error)) => {
                self.unit_ui(ui, None);
                error_ui(ui, &error);
            }
        }
        self.text_ui(ui);
    }

    /// What was read.
    fn found_ui(&mut self, ui: &mut egui::Ui, found: &Imported, context: &Context<'_>) {
        let Imported { preset, report } = found;
        self.names_ui(ui);
        self.unit_ui(ui, Some(report));
        row(ui, "Format", &report.format.to_string());
        let (from, to) = report.range_nm;
        row(ui, "Rows", &format!("{} rows, {} to {} nm", report.rows, short(from), short(to)));
        let kept = format!("{} entries, {} from 380 to 780 nm", report.points, report.visible_points);
        row(ui, "Kept", &kept);
        for Finding { line, text, .. } in &report.warnings {
            warning_ui(ui, &here(&placed(*line, text)));
        }
        for Finding { line, text, .. } in &report.notes {
            let text = format!("\u{2022} {}", here(&placed(*line, text)));
            ui.add(egui::Label::new(RichText::new(text).small()).wrap());
        }
        plot_ui(ui, preset, PLOT_HEIGHT);
        self.looks_ui(ui, preset, context);
    }

    fn looks_ui(&self, ui: &mut egui::Ui, preset: &Preset, context: &Context<'_>) {
        f0_ui(ui, f0(preset));
        if let Some(fits) = preset.stored_fits() {
            let settings = FormSettings::new(&context.session.document().lighting.settings());
            forms_ui(ui, fits, settings);
            let reason = fits.cheapest(settings.tolerance).reason;
            ui.add(egui::Label::new(RichText::new(format!("Why: {reason}")).small().weak()).wrap());
        }
    }

    fn names_ui(&mut self, ui: &mut egui::Ui) {
        let (mut name, mut id) = (self.name.clone(), self.id.clone());
        for (label, text, hover) in [
            ("Name", &mut name, "Name for people"),
            ("Id", &mut id, "How documents and the command line call it: letters, digits, `-`, `_`, inner `.`"),
        ] {
            ui.horizontal(|ui| {
                label_ui(ui, label);
                let width = ui.available_width();
                let field = ui.add(egui::TextEdit::singleline(text).desired_width(width)).on_hover_text(hover);
                name_input(&field, &format!("{label} of the metal"), text);
                self.named |= field.changed();
            });
        }
        (self.name, self.id) = (name, id);
        if let Err(fault) = self.metal() {
            ui.colored_label(ui.visuals().error_fg_color, fault);
        }
    }

    /// The unit with how it is known, and the choice of another. A preset of ours has no choice.
    fn unit_ui(&mut self, ui: &mut egui::Ui, report: Option<&ImportReport>) {
        if report.is_some_and(|report| report.format == Format::Preset) {
            return;
        }
        let found = report.filter(|_| self.options.unit.is_none()).map(|report| report.unit);
        let as_found = found.map_or("as the table says".into(), |unit| format!("as the table says ({})", shown(unit)));
        let names: Vec<String> =
            std::iter::once(as_found).chain(Unit::ALL.into_iter().map(|unit| shown(unit).to_string())).collect();
        let place = |unit: Option<Unit>| {
            unit.and_then(|unit| Unit::ALL.iter().position(|known| *known == unit)).map_or(0, |at| at + 1)
        };
        let mut changed = false;
        ui.horizontal(|ui| {
            label_ui(ui, "Unit");
            let hover = "Unit of the first column. Choose another where the table says nothing, or what is wrong";
            if let Some(at) = choice_ui(ui, "Unit", &names, place(self.options.unit), 170.0, None, hover) {
                self.options.unit = at.checked_sub(1).and_then(|at| Unit::ALL.get(at)).copied();
                changed = true;
            }
            let hover = "For tables of n - ik, whose k is negative";
            changed |= ui.checkbox(&mut self.options.flip_k, "Flip sign of k").on_hover_text(hover).changed();
        });
        if let Some(report) = report.filter(|_| self.options.unit.is_none()) {
            row(ui, "", &report.unit_origin.to_string());
        }
        if changed {
            self.read(ui.ctx());
        }
    }

    /// The pasted text, to be corrected.
    fn text_ui(&mut self, ui: &mut egui::Ui) {
        let failed = matches!(self.found, Some(Err(_)));
        let mut again = false;
        if let Origin::Text(text) = &mut self.origin
            && text.len() <= MAX_EDITED
        {
            // Opens by itself when there is something to correct.
            let header = egui::CollapsingHeader::new("Text").id_salt(("text", failed)).default_open(failed);
            header.show_unindented(ui, |ui| {
                egui::ScrollArea::vertical().id_salt("pasted").max_height(140.0).show(ui, |ui| {
                    let field = egui::TextEdit::multiline(text).code_editor().desired_rows(4);
                    let field = ui.add(field.desired_width(f32::INFINITY));
                    name_input(&field, "Pasted text", text);
                    self.edited |= field.changed();
                });
                let button = ui.add_enabled(self.edited, egui::Button::new("Read again"));
                again = button.on_hover_text("Read the corrected text").clicked();
            });
        }
        if again {
            self.read(ui.ctx());
        }
    }

    fn buttons_ui(&self, ui: &mut egui::Ui, waiting: usize) -> Answer {
        let mut answer = Answer::None;
        ui.horizontal(|ui| {
            if waiting > 0 {
                ui.weak(if waiting == 1 { "1 more table waits".into() } else { format!("{waiting} more tables wait") });
            } else if self.job.is_some() && self.found.is_some() {
                ui.weak("Reading...");
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let ready = self.job.is_none() && !self.edited && self.metal().is_ok();
                let mut button = |text: &str, enabled: bool, hover: &str, of: Answer| {
                    if ui.add_enabled(enabled, egui::Button::new(text)).on_hover_text(hover).clicked() {
                        answer = of;
                    }
                };
                let hover = "Add it to your presets and put it on the selected materials";
                button("Import and assign", ready, hover, Answer::ImportAndAssign);
                button("Import", ready, "Add it to your presets", Answer::Import);
                button("Cancel", true, "Import nothing", Answer::Cancel);
            });
        });
        answer
    }
}

/// Why nothing was read: by line, with the remedy.
fn error_ui(ui: &mut egui::Ui, error: &OpticalError) {
    ui.colored_label(ui.visuals().error_fg_color, "Nothing can be imported:");
    for OpticalFault { file, line, reason, remedy } in &error.faults {
        let place = line.map_or(file.clone(), |line| format!("Line {line}"));
        ui.add(egui::Label::new(format!("{place}: {}", here(reason))).wrap());
        ui.indent("remedy", |ui| {
            ui.add(egui::Label::new(RichText::new(format!("Remedy: {}", here(remedy))).weak()).wrap())
        });
    }
    if error.omitted > 0 {
        ui.weak(format!("and {} more faults", error.omitted));
    }
}

/// Messages name the options of the command line; in the window their controls are called otherwise.
fn here(text: &str) -> String {
    text.replace("--unit ", "Unit ").replace("--unit", "Unit").replace("--flip-k", "Flip sign of k")
}

fn placed(line: Option<usize>, text: &str) -> String {
    line.map_or(text.into(), |line| format!("line {line}: {text}"))
}

fn row(ui: &mut egui::Ui, label: &str, text: &str) {
    ui.horizontal_top(|ui| {
        let height = ui.text_style_height(&egui::TextStyle::Body);
        column_ui(ui, label, height);
        ui.add(egui::Label::new(text).wrap());
    });
}

/// Labels stand in a column of their own.
fn label_ui(ui: &mut egui::Ui, label: &str) {
    column_ui(ui, label, ui.spacing().interact_size.y);
}

fn column_ui(ui: &mut egui::Ui, label: &str, height: f32) {
    let size = egui::vec2(56.0, height);
    ui.allocate_ui_with_layout(size, egui::Layout::left_to_right(egui::Align::Center), |ui| {
        ui.set_min_width(size.x);
        ui.weak(label);
    });
}

/// As people write it.
fn shown(unit: Unit) -> &'static str {
    match unit {
        Unit::Nanometre => "nm",
        Unit::Micrometre => "\u{b5}m",
        Unit::Angstrom => "\u{c5}",
        Unit::ElectronVolt => "eV",
    }
}

/// A wavelength without digits that nobody reads.
fn short(nm: f64) -> f64 {
    (10.0 * nm).round() / 10.0
}
