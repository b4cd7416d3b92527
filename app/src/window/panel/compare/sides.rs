//! What each side shows: a state of the document, and by which method.

use burnish_core::document::Side;
use burnish_core::lighting::classical;
use burnish_core::reference;
use eframe::egui;

use super::Context;
use crate::window::commands::Command;
use crate::window::request::Request;
use crate::window::widget::choice_ui;

/// Titles of the methods of a side, live first.
const METHODS: [&str; 2] = ["live", "reference"];
/// The entry that is no snapshot.
const NOW: &str = "document as it is now";

/// Shows both.
pub fn ui(ui: &mut egui::Ui, context: &mut Context<'_>) {
    ui.horizontal_wrapped(|ui| {
        for command in [Command::StoreSide(Side::A), Command::StoreSide(Side::B), Command::SwapSides] {
            let Some(entry) = command.entry() else { continue };
            if ui.button(entry.title).on_hover_text(entry.help).clicked() {
                context.requests.push(Request::Command(command));
            }
        }
    });
    for side in Side::ALL {
        side_ui(ui, context, side);
    }
}

fn side_ui(ui: &mut egui::Ui, context: &mut Context<'_>, side: Side) {
    let document = context.session.document().clone();
    let entry = document.compare.side(side).clone();
    let letter = side.letter();
    let names: Vec<&str> =
        std::iter::once(NOW).chain(document.snapshots.iter().map(|snapshot| snapshot.name.as_str())).collect();
    let shown = document.snapshot_of(side).map_or(NOW, |snapshot| snapshot.name.as_str());
    let index = names.iter().position(|name| *name == shown).unwrap_or(0);
    ui.push_id(letter, |ui| {
        ui.horizontal(|ui| {
            ui.strong(letter);
            let width = ui.available_width() - ui.spacing().item_spacing.x;
            let hover = "The state of the document that this side shows.";
            let picked = choice_ui(ui, &format!("State of {letter}"), &names, index, 0.58 * width, None, hover);
            if let Some(picked) = picked {
                let name = names.get(picked).filter(|_| picked > 0).map(|name| name.to_string());
                context.session.seal();
                context.session.edit("Choose side", letter, |document| {
                    document.compare.side_mut(side).snapshot = name;
                });
            }
            let method = usize::from(entry.is_reference());
            let hover = "live: the lighting method of the state. reference: path-traced.";
            let picked = choice_ui(ui, &format!("Method of {letter}"), &METHODS, method, 0.42 * width, None, hover);
            if let Some(picked) = picked {
                context.session.seal();
                context.session.edit("Method of side", letter, |document| {
                    let id = if picked == 1 { reference::ID } else { classical::ID };
                    document.compare.side_mut(side).method = id.into();
                });
            }
        });
    });
}
