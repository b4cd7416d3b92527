//! The finish and the coat of a material: which of those that come with the program, found by its factors.

use burnish_core::material::finish::{self, Kind};
use eframe::egui;

use super::Context;
use crate::window::widget::{choice_ui, name_ui};

/// Shown where no finish has the factors of the material.
const CUSTOM: &str = "custom";

/// Shows both choices.
pub fn finish_ui(ui: &mut egui::Ui, context: &mut Context<'_>, index: usize) {
    // A group of factors is called Coat as well.
    ui.push_id("finish", |ui| {
        for kind in Kind::ALL {
            kind_ui(ui, context, index, kind);
        }
    });
}

fn kind_ui(ui: &mut egui::Ui, context: &mut Context<'_>, index: usize, kind: Kind) {
    let Some(material) = context.session.scene().materials.get(index) else { return };
    let list: Vec<_> = finish::list(kind).collect();
    let current = finish::of(material, kind);
    let mut names: Vec<&str> = list.iter().map(|finish| finish.name.as_str()).collect();
    let place = list.iter().position(|finish| Some(*finish) == current);
    if place.is_none() {
        names.push(CUSTOM);
    }
    let hover = match current {
        Some(finish) => format!("{}\n{}", help(kind), finish.note),
        None => help(kind).into(),
    };
    let mut picked = None;
    ui.horizontal(|ui| {
        let name = name_ui(ui, title(kind), false, 0.36 * ui.available_width()).on_hover_text(&hover);
        let width = ui.available_width();
        picked = choice_ui(ui, title(kind), &names, place.unwrap_or(list.len()), width, Some(&name), &hover);
    });
    let Some(finish) = picked.and_then(|place| list.get(place)) else { return };
    let base = context.session.resolved().base.get(index).cloned().unwrap_or_default();
    let material = context.session.document().materials.get(index).map(|entry| entry.name.clone());
    context.session.seal();
    context.session.edit(title(kind), &material.unwrap_or_default(), |document| {
        document.assign_finish(index, finish, &base);
    });
    context.session.seal();
}

fn title(kind: Kind) -> &'static str {
    match kind {
        Kind::Finish => "Finish",
        Kind::Coat => "Coat",
    }
}

fn help(kind: Kind) -> &'static str {
    match kind {
        Kind::Finish => "How the metal was worked. Sets roughness, anisotropy and bumps.",
        Kind::Coat => "What lies over the metal. Sets coat and coat roughness.",
    }
}
