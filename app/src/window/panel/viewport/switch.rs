//! The switch between live picture and reference, with what is to be known about the latter.

use eframe::egui::{self, Align, Align2, Button, Layout, Rect, RichText, Role, UiBuilder, Visuals, WidgetInfo, vec2};

use super::{Tool, overlay};
use crate::window::commands::Command;
use crate::window::compare::CompareView;
use crate::window::panel::Context;
use crate::window::request::{Request, Requests};

/// Height of a row of buttons, points.
const HEIGHT: f32 = 24.0;

/// What the numbers about the reference are.
const HELP: &str = "Samples: paths through each pixel so far. Noise: relative standard error of the picture, an upper \
                    estimate. Time: that of tracing. Tracing rests for 0.3 s after every input, and starts anew when \
                    what is shown changes; exposure and tone map do not count.";

/// A button of the switch.
struct Choice {
    label: &'static str,
    on: bool,
    hover: &'static str,
    command: Command,
}

/// Shows it at the top right of the picture.
pub fn ui(ui: &mut egui::Ui, rect: Rect, context: &mut Context<'_>) {
    let view = context.compare.view();
    let sides = view.is_some_and(CompareView::has_sides);
    let traced = context.reference.is_on() && view.is_none();
    let back = match view {
        Some(view) => Command::Compare(view),
        None => Command::Reference,
    };
    let choices = [
        Choice {
            label: "Live",
            on: !traced && view.is_none(),
            hover: "Drawn at once by the lighting method.",
            command: back,
        },
        Choice {
            label: "Reference",
            on: traced,
            hover: "Path-traced: the truth that the method is judged by. It refines while nothing changes.",
            command: Command::Reference,
        },
        Choice {
            label: "A | B",
            on: sides,
            hover: "Two sides of the same view: states of the document, live or path-traced. The Compare panel says which.",
            command: Command::Compare(context.compare.last()),
        },
        Choice {
            label: "Error",
            on: view == Some(CompareView::Error),
            hover: "Where the live picture differs from the path-traced reference, as a heat map.",
            command: Command::Compare(CompareView::Error),
        },
    ];
    let bottom = row_ui(ui, (rect, Align2::RIGHT_TOP), 194.0, &choices, context.requests);
    let below = Rect::from_min_max(egui::pos2(rect.left(), bottom - 4.0), rect.max);
    if sides {
        let of = |view, label, hover| Choice {
            label,
            on: context.compare.view() == Some(view),
            hover,
            command: Command::Compare(view),
        };
        let choices = [
            of(CompareView::Wipe, "Wipe", "A left of a line that is dragged, B right of it."),
            of(CompareView::SideBySide, "Side by side", "Each in its half."),
            of(CompareView::Difference, "Difference", "Where B differs from A, as a heat map."),
        ];
        row_ui(ui, (below, Align2::RIGHT_TOP), 194.0, &choices, context.requests);
    } else if traced || view == Some(CompareView::Error) {
        let timed = context.stage.status().is_none_or(|status| !status.fixed_clock);
        let text = match traced {
            true => context.reference.text(timed),
            false => format!("Against {}", context.reference.text_of_look(timed)),
        };
        overlay::line_ui(ui, below, Align2::RIGHT_TOP, &text, HELP);
    }
}

/// The tools, at the top left of the picture; returns where they end below.
pub fn tools_ui(ui: &mut egui::Ui, rect: Rect, tool: Tool, requests: &mut Requests) -> f32 {
    let choices = Tool::ALL.map(|other| {
        let command = Command::Tool(other);
        Choice { label: other.title(), on: other == tool, hover: other.help(), command }
    });
    // A column: beside the switch there is no room in a narrow window.
    let size = vec2(74.0, choices.len() as f32 * (HEIGHT - 3.0));
    let place = Align2::LEFT_TOP.align_size_within_rect(size, rect.shrink(8.0));
    let layout = Layout::top_down_justified(Align::Center);
    buttons_ui(ui, place, layout, &choices, requests);
    place.bottom()
}

/// A row of buttons in a corner; returns where it ends below.
fn row_ui(ui: &mut egui::Ui, (rect, corner): (Rect, Align2), width: f32, choices: &[Choice], to: &mut Requests) -> f32 {
    let size = vec2(width.min(rect.width() - 16.0), HEIGHT);
    let place = corner.align_size_within_rect(size, rect.shrink(8.0));
    let layout = Layout::left_to_right(Align::Center).with_main_justify(false);
    buttons_ui(ui, place, layout, choices, to);
    place.bottom()
}

/// The buttons of a place over the picture.
fn buttons_ui(ui: &mut egui::Ui, place: Rect, layout: Layout, choices: &[Choice], to: &mut Requests) {
    ui.painter().rect_filled(place, 4.0, overlay::SHADE);
    let mut row = ui.new_child(UiBuilder::new().max_rect(place.shrink(2.0)).layout(layout));
    row.set_clip_rect(place.intersect(ui.clip_rect()));
    // Over a picture, whatever the theme.
    *row.visuals_mut() = Visuals::dark();
    row.spacing_mut().item_spacing = vec2(2.0, 1.0);
    row.spacing_mut().interact_size.y = HEIGHT - 4.0;
    for Choice { label, on, hover, command } in choices {
        let button = Button::selectable(*on, RichText::new(*label).size(12.5));
        let response = row.add(button).on_hover_text(*hover);
        response.widget_info(|| WidgetInfo::selected(Role::RadioButton, true, *on, *label));
        if response.clicked() && !on {
            to.push(Request::Command(*command));
        }
    }
}
