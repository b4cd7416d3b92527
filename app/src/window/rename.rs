//! A name of a list that is typed anew in its place.

use eframe::egui;

use super::widget::name_input;

/// What is being renamed, one at a time.
pub struct Renaming<K> {
    of: K,
    name: String,
    /// The field was not shown yet: it gets the keyboard once.
    fresh: bool,
}

/// What became of the name of a row.
#[derive(Debug, PartialEq)]
pub enum Typed {
    /// It is not the one that is typed.
    Elsewhere,
    /// The field stands in its place.
    Typing,
    /// The field was left with this name.
    Done(String),
}

impl<K> Renaming<K> {
    /// Begins with the name as it is.
    pub fn new(of: K, name: &str) -> Renaming<K> {
        Renaming { of, name: name.into(), fresh: true }
    }
}

/// The field in the place of the row `of`, where that is renamed. Escape drops what was typed.
pub fn rename_ui<K: PartialEq<Q>, Q: ?Sized>(
    ui: &mut egui::Ui,
    renamed: &mut Option<Renaming<K>>,
    of: &Q,
    label: &str,
) -> Typed {
    let Some(renaming) = renamed.as_mut().filter(|renaming| renaming.of == *of) else { return Typed::Elsewhere };
    let field = ui.add(egui::TextEdit::singleline(&mut renaming.name).desired_width(f32::INFINITY));
    name_input(&field, label, &renaming.name);
    if std::mem::take(&mut renaming.fresh) {
        field.request_focus();
    } else if ui.input(|input| input.key_pressed(egui::Key::Escape)) {
        *renamed = None;
    } else if field.lost_focus() || !field.has_focus() {
        return Typed::Done(renaming.name.trim().into());
    }
    Typed::Typing
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    type State = (Option<Renaming<usize>>, Vec<Typed>);

    /// Two rows of which the second is renamed.
    fn rows() -> Harness<'static, State> {
        let show = |ui: &mut egui::Ui, (renamed, typed): &mut State| {
            for row in 0..2 {
                typed.push(rename_ui(ui, renamed, &row, "Name of the row"));
                if matches!(typed.last(), Some(Typed::Done(_))) {
                    *renamed = None;
                }
            }
        };
        let mut rows = Harness::new_ui_state(show, (Some(Renaming::new(1, "old")), Vec::new()));
        rows.run();
        rows
    }

    fn names<'a>(rows: &'a Harness<'_, State>) -> Vec<&'a str> {
        let typed = rows.state().1.iter();
        typed.filter_map(|typed| if let Typed::Done(name) = typed { Some(name.as_str()) } else { None }).collect()
    }

    #[test]
    fn enter_gives_the_name_once_without_spaces_around() {
        let mut rows = rows();
        assert_eq!(rows.state().1[..2], [Typed::Elsewhere, Typed::Typing]);
        rows.get_by_label("Name of the row").type_text(" new ");
        rows.run();
        rows.key_press(egui::Key::Enter);
        rows.run();
        let names = names(&rows);
        assert!(names.len() == 1 && names[0].contains("new") && names[0].trim() == names[0], "{names:?}");
    }

    #[test]
    fn escape_drops_what_was_typed() {
        let mut rows = rows();
        rows.get_by_label("Name of the row").type_text("new");
        rows.key_press(egui::Key::Escape);
        rows.run();
        assert!(rows.state().0.is_none() && names(&rows).is_empty());
        assert!(rows.query_by_label("Name of the row").is_none());
    }
}
