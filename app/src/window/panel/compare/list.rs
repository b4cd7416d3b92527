//! What differs between the sides, a line each, with both values and the means to copy one over the other.

use std::sync::Arc;

use burnish_core::document::{Difference, Document, Side, differences};
use eframe::egui::{self, Align, Layout, Sense, UiBuilder, vec2};

use super::Context;
use crate::window::compare::SideScene;
use crate::window::session::Session;
use crate::window::widget::name_widget;

/// Points of a button that copies.
const ARROW: f32 = 22.0;

/// The list, made anew when a side changes.
#[derive(Default)]
pub struct DifferenceList {
    lines: Vec<Difference>,
    of: Option<[Arc<Document>; 2]>,
}

impl DifferenceList {
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let sides = Side::ALL.map(|side| context.compare.sides.get(context.session, side));
        self.update(&sides);
        if self.lines.is_empty() {
            let same = Side::ALL.map(|side| context.session.document().compare.side(side).snapshot.clone());
            ui.weak(if same == [None, None] { "Both sides show the document as it is now" } else { "No differences" });
            return;
        }
        let mut copied = None;
        let mut group = "";
        // Asked once: a row that is a fraction of a point too wide would widen the next.
        let whole = ui.available_width();
        for (index, line) in self.lines.iter().enumerate() {
            if group != line.group {
                group = &line.group;
                ui.add_space(2.0);
                ui.strong(group);
            }
            ui.push_id(index, |ui| copied = line_ui(ui, line, whole).map(|to| (line.clone(), to)).or(copied.take()));
        }
        if let Some((line, to)) = copied {
            copy(context.session, &line, to, &sides);
        }
    }

    fn update(&mut self, sides: &[SideScene; 2]) {
        let known = self.of.as_ref().is_some_and(|of| of.iter().zip(sides).all(|(a, b)| Arc::ptr_eq(a, &b.document)));
        if known {
            return;
        }
        let [a, b] = sides;
        self.lines = differences([&a.document, &b.document], [&a.scene.materials, &b.scene.materials]);
        self.of = Some([a.document.clone(), b.document.clone()]);
    }
}

/// Lets the side `to` take over what the other has in a line.
fn copy(session: &mut Session, line: &Difference, to: Side, sides: &[SideScene; 2]) {
    let from = sides[to.other() as usize].document.clone();
    let label = format!("Copy {} to {}", line.label, to.letter());
    session.seal();
    session.edit(&label, &line.group, |document| document.copy_to_side(to, &line.place, &from));
    session.seal();
}

/// Name, value of A, buttons, value of B. Returns the side that takes over the value of the other.
fn line_ui(ui: &mut egui::Ui, line: &Difference, whole: f32) -> Option<Side> {
    let Difference { label, values, group, .. } = line;
    let mut to = None;
    ui.horizontal(|ui| {
        let gap = ui.spacing().item_spacing.x;
        let width = (whole - 2.0 * ARROW - 4.0 * gap).max(60.0);
        let hover = format!("{group}, {label}\nA: {}\nB: {}", values[0], values[1]);
        text_ui(ui, (0.36 * width).floor(), label, &hover, Align::Min);
        text_ui(ui, (0.32 * width).floor(), &values[0], &hover, Align::Max);
        for (side, sign) in [(Side::B, "⏵"), (Side::A, "⏴")] {
            let height = ui.spacing().interact_size.y;
            let name = format!("Copy {label} to {}", side.letter());
            let button = ui.add_sized(vec2(ARROW, height), egui::Button::new(sign)).on_hover_text(&name);
            name_widget(&button, &name);
            if button.clicked() {
                to = Some(side);
            }
        }
        text_ui(ui, (0.32 * width).floor(), &values[1], &hover, Align::Min);
    });
    to
}

/// A text in a place of its own, cut where it is too long.
fn text_ui(ui: &mut egui::Ui, width: f32, text: &str, hover: &str, align: Align) {
    let size = vec2(width, ui.spacing().interact_size.y);
    let layout =
        if align == Align::Max { Layout::right_to_left(Align::Center) } else { Layout::left_to_right(Align::Center) };
    let place = ui.allocate_exact_size(size, Sense::hover()).0;
    let mut cell = ui.new_child(UiBuilder::new().max_rect(place).layout(layout));
    cell.add(egui::Label::new(text).truncate()).on_hover_text(hover);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::window::compare::Sides;
    use burnish_core::document;
    use burnish_core::param::ParamValue;

    #[test]
    fn a_line_is_copied_to_either_side_as_a_step() {
        let mut session = Session::new(document::open("gallery:workbench").unwrap(), None);
        let (mut sides, mut list) = (Sides::default(), DifferenceList::default());
        session.edit("Store as A", "", |document| document.store_side(Side::A));
        session.edit("Roughness", "", |document| document.set_value(0, "roughness", ParamValue::Number(0.9)).unwrap());
        let now = |session: &Session, sides: &mut Sides| Side::ALL.map(|side| sides.get(session, side));
        let scenes = now(&session, &mut sides);
        list.update(&scenes);
        assert_eq!(list.lines.len(), 1);
        let line = list.lines[0].clone();
        copy(&mut session, &line, Side::A, &scenes);
        list.update(&now(&session, &mut sides));
        assert!(list.lines.is_empty(), "the snapshot has it now");
        assert_eq!(session.undo().as_deref(), Some("Copy Roughness to A"));
        copy(&mut session, &line, Side::B, &scenes);
        list.update(&now(&session, &mut sides));
        assert!(list.lines.is_empty());
        assert_ne!(session.scene().materials[0].roughness, 0.9, "side B is the document");
        assert_eq!(session.undo().as_deref(), Some("Copy Roughness to B"));
        assert_eq!(session.scene().materials[0].roughness, 0.9);
    }
}
