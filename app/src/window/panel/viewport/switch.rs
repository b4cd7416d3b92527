//! The switch between live picture and reference, with what is to be known about the latter.

use eframe::egui::{self, Align, Align2, Button, Layout, Rect, RichText, Role, UiBuilder, Visuals, WidgetInfo, vec2};

use super::overlay;
use crate::window::commands::Command;
use crate::window::panel::Context;
use crate::window::request::Request;

/// Points of the two buttons.
const SIZE: egui::Vec2 = vec2(108.0, 24.0);

/// What the numbers about the reference are.
const HELP: &str = "Samples: paths through each pixel so far. Noise: relative standard error of the picture, an upper \
                    estimate. Time: that of tracing. Tracing rests for 0.3 s after every input, and starts anew when \
                    what is shown changes; exposure and tone map do not count.";

/// Shows it at the top right of the picture.
pub fn ui(ui: &mut egui::Ui, rect: Rect, context: &mut Context<'_>) {
    let on = context.reference.is_on();
    let place = Align2::RIGHT_TOP.align_size_within_rect(SIZE, rect.shrink(8.0));
    ui.painter().rect_filled(place, 4.0, overlay::SHADE);
    let layout = Layout::left_to_right(Align::Center);
    let mut row = ui.new_child(UiBuilder::new().max_rect(place.shrink(2.0)).layout(layout));
    // Over a picture, whatever the theme.
    *row.visuals_mut() = Visuals::dark();
    row.spacing_mut().item_spacing.x = 2.0;
    for (label, chosen, hover) in [
        ("Live", !on, "Drawn at once by the lighting method."),
        ("Reference", on, "Path-traced: the truth that the method is judged by. It refines while nothing changes."),
    ] {
        let button = Button::selectable(chosen, RichText::new(label).size(12.5));
        let response = row.add(button).on_hover_text(hover);
        response.widget_info(|| WidgetInfo::selected(Role::RadioButton, true, chosen, label));
        if response.clicked() && !chosen {
            context.requests.push(Request::Command(Command::Reference));
        }
    }
    if on {
        let timed = context.stage.status().is_none_or(|status| !status.fixed_clock);
        let below = Rect::from_min_max(egui::pos2(rect.left(), place.bottom() - 4.0), rect.max);
        overlay::line_ui(ui, below, Align2::RIGHT_TOP, &context.reference.text(timed), HELP);
    }
}
