//! The parts that rows have in common: places, names that can be read out, the reset arrow.

use eframe::egui::{self, Align, Layout, Response, Sense, WidgetInfo, vec2};

use crate::window::icon::{Icon, icon_button};

/// Part of a row that the name takes.
const NAME_SHARE: f32 = 0.36;
/// Points of the reset arrow.
pub(super) const RESET_WIDTH: f32 = 18.0;

/// Widths of names and of controls in rows like those of [`param_ui`].
pub fn columns(ui: &egui::Ui) -> [f32; 2] {
    let gap = ui.spacing().item_spacing.x;
    // A panel that was squeezed to nothing has less than none.
    let both = (ui.available_width() - RESET_WIDTH - gap).max(0.0);
    [both * NAME_SHARE, (both - both * NAME_SHARE - gap).max(40.0)]
}

/// Name of a row with a dot in front of what was changed. Its text names the control.
pub fn name_ui(ui: &mut egui::Ui, name: &str, changed: bool, width: f32) -> Response {
    let height = ui.spacing().interact_size.y;
    let inner = ui.allocate_ui_with_layout(vec2(width, height), Layout::left_to_right(Align::Center), |ui| {
        ui.set_min_width(width);
        ui.spacing_mut().item_spacing.x = 4.0;
        let (dot, _) = ui.allocate_exact_size(vec2(6.0, height), Sense::hover());
        if changed {
            ui.painter().circle_filled(dot.center(), 2.5, ui.visuals().hyperlink_color);
        }
        let text = if changed { egui::RichText::new(name).strong() } else { name.into() };
        ui.add(egui::Label::new(text).truncate().selectable(false))
    });
    // The rectangle of the whole place, the identity of the text.
    Response { rect: inner.response.rect, ..inner.inner }
}

/// The arrow that takes a change back; it keeps its place where there is none.
pub fn reset_ui(ui: &mut egui::Ui, label: &str, changed: bool) -> bool {
    let size = vec2(RESET_WIDTH, ui.spacing().interact_size.y);
    if !changed {
        ui.allocate_exact_size(size, Sense::hover());
        return false;
    }
    icon_button(ui, Icon::Reset, size, &format!("Reset {label}")).clicked()
}

/// Gives a button whose text is short a name that can be read out.
pub fn name_widget(response: &Response, name: &str) {
    response.widget_info(|| WidgetInfo::labeled(egui::accesskit::Role::Button, response.enabled(), name));
}

/// A field for a text; what is typed counts, and is returned, when the field is left.
pub fn typed_ui(ui: &mut egui::Ui, label: &str, text: &str, width: f32) -> Option<String> {
    let id = ui.scope_id().with(label);
    let mut typed = ui.data(|data| data.get_temp::<String>(id)).unwrap_or_else(|| text.into());
    let field = ui.add(egui::TextEdit::singleline(&mut typed).desired_width(width));
    name_input(&field, label, &typed);
    if field.has_focus() {
        ui.data_mut(|data| data.insert_temp(id, typed.clone()));
    } else {
        ui.data_mut(|data| data.remove::<String>(id));
    }
    (field.lost_focus() && typed != text).then(|| typed.trim().into())
}

/// Gives a text field a name that can be read out.
pub fn name_input(response: &Response, name: &str, text: &str) {
    response.widget_info(|| {
        let mut info = WidgetInfo::text_edit(response.enabled(), text, text, "");
        info.label = Some(name.into());
        info
    });
}
