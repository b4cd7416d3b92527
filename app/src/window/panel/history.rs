//! The steps that undo takes back and redo does again: a click goes there.

use eframe::egui::{self, RichText};

use super::Context;

/// The history list.
#[derive(Default)]
pub struct HistoryPanel {
    /// The step that was current when the list was last shown.
    current: usize,
}

impl HistoryPanel {
    /// Shows the panel.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let history = context.session.history();
        let current = history.past().len();
        let steps: Vec<(&str, &str)> = (history.past().iter())
            .chain(history.future())
            .map(|step| (step.label.as_str(), step.target.as_str()))
            .collect();
        let row_height = ui.spacing().interact_size.y;
        let moved = std::mem::replace(&mut self.current, current) != current;
        let mut chosen = None;
        let mut area = egui::ScrollArea::vertical().auto_shrink(false);
        if moved {
            let stride = row_height + ui.spacing().item_spacing.y;
            area = area.vertical_scroll_offset((current as f32 * stride - 0.5 * ui.available_height()).max(0.0));
        }
        area.show_rows(ui, row_height, steps.len() + 1, |ui, rows| {
            for row in rows {
                let (label, target) = match row.checked_sub(1).and_then(|step| steps.get(step)) {
                    Some(step) => *step,
                    None => ("As opened", ""),
                };
                if row_ui(ui, row, (label, target), current).clicked() {
                    chosen = Some(row);
                }
            }
        });
        if let Some(count) = chosen {
            context.session.go_to(count);
        }
    }
}

/// One state of the document by the step that led to it.
fn row_ui(ui: &mut egui::Ui, row: usize, (label, target): (&str, &str), current: usize) -> egui::Response {
    let text = if row > current { RichText::new(label).weak() } else { RichText::new(label) };
    let button = egui::Button::selectable(row == current, text).truncate();
    let button = button.right_text(RichText::new(target).weak());
    let response = ui.add_sized([ui.available_width(), ui.spacing().interact_size.y], button);
    let name = if target.is_empty() { label.to_string() } else { format!("{label}: {target}") };
    let numbered = format!("Step {row}, {name}");
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, row == current, &numbered));
    let hint = match row.cmp(&current) {
        std::cmp::Ordering::Less => "Click to go back to here.",
        std::cmp::Ordering::Equal => "The document as it is now.",
        std::cmp::Ordering::Greater => "Was undone; click to do it again up to here.",
    };
    response.on_hover_text(format!("{name}\n{hint}"))
}
