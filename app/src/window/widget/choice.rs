//! A list that drops down.

use eframe::egui::{self, Response, WidgetInfo};

/// Points of a list that drops down; more is scrolled.
const LIST_HEIGHT: f32 = 360.0;

/// One of a row of choices; true where it is chosen now.
pub fn radio_ui(ui: &mut egui::Ui, on: bool, title: &str, hover: &str) -> bool {
    let button = ui.selectable_label(on, title).on_hover_text(hover);
    button.widget_info(|| WidgetInfo::selected(egui::accesskit::Role::RadioButton, true, on, title));
    button.clicked() && !on
}

/// A list to choose from. Returns the index when another was picked. `name` is the text beside it; without one the list
/// is called `label`.
pub fn choice_ui<T: AsRef<str>>(
    ui: &mut egui::Ui,
    label: &str,
    options: &[T],
    index: usize,
    width: f32,
    name: Option<&Response>,
    hover: &str,
) -> Option<usize> {
    let mut picked = None;
    let shown = options.get(index).map_or("choose...", AsRef::as_ref);
    let mut list_ui = |ui: &mut egui::Ui| {
        // A long word is cut at the end of the list's place, not at the end of the panel.
        ui.set_max_width(width);
        let list = egui::ComboBox::from_id_salt(label).width(width).height(LIST_HEIGHT).selected_text(shown).truncate();
        list.show_ui(ui, |ui| {
            for (place, option) in options.iter().enumerate() {
                if ui.selectable_label(place == index, option.as_ref()).clicked() && place != index {
                    picked = Some(place);
                }
            }
        })
    };
    let list = ui.scope(|ui| list_ui(ui)).inner;
    match name {
        Some(name) => _ = list.response.labelled_by(name.id).on_hover_text(hover),
        None => {
            list.response.widget_info(|| {
                let mut info = WidgetInfo::labeled(egui::accesskit::Role::ComboBox, true, label);
                info.current_text_value = Some(shown.into());
                info
            });
            list.response.on_hover_text(hover);
        }
    }
    picked
}
