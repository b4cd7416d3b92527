//! The command palette: any command by a part of its name.

use eframe::egui::{self, Align2, Key, Modifiers, RichText};

use super::commands::{Command, Entry, TABLE};

const WIDTH: f32 = 460.0;
const ROWS_HEIGHT: f32 = 340.0;

/// The palette while it is open.
#[derive(Default)]
pub struct Palette {
    query: String,
    /// Place in the list of what was found.
    chosen: usize,
}

/// What became of the palette in a frame.
pub enum Chosen {
    /// It is still open.
    Nothing,
    /// It was left without a choice.
    Closed,
    /// A command was chosen.
    Command(Command),
}

impl Palette {
    /// Shows the palette; `obstacle` says why a command can do nothing now.
    pub fn ui(&mut self, ctx: &egui::Context, obstacle: impl Fn(Command) -> Option<&'static str>) -> Chosen {
        let area = egui::Modal::default_area(egui::Id::unique("palette")).anchor(Align2::CENTER_TOP, [0.0, 60.0]);
        let modal = egui::Modal::new(egui::Id::unique("palette")).area(area);
        let shown = modal.show(ctx, |ui| {
            ui.set_width(WIDTH);
            self.content_ui(ui, &obstacle)
        });
        match shown.inner {
            Some(command) => Chosen::Command(command),
            None if shown.should_close() => Chosen::Closed,
            None => Chosen::Nothing,
        }
    }

    fn content_ui(
        &mut self,
        ui: &mut egui::Ui,
        obstacle: &impl Fn(Command) -> Option<&'static str>,
    ) -> Option<Command> {
        // Before the text field, which would take the arrows.
        let pressed = |key| ui.input_mut(|input| input.consume_key(Modifiers::NONE, key));
        let (up, down, enter) = (pressed(Key::ArrowUp), pressed(Key::ArrowDown), pressed(Key::Enter));
        let field = egui::TextEdit::singleline(&mut self.query).hint_text("Type the name of a command");
        let field = ui.add(field.desired_width(f32::INFINITY));
        field.widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, true, "Find a command"));
        field.request_focus();
        let found = find(&self.query);
        if field.changed() {
            self.chosen = 0;
        }
        let last = found.len().saturating_sub(1);
        if up {
            self.chosen = if self.chosen == 0 { last } else { self.chosen - 1 };
        }
        if down {
            self.chosen = if self.chosen >= last { 0 } else { self.chosen + 1 };
        }
        self.chosen = self.chosen.min(last);
        let enabled = |command: Command| obstacle(command).is_none();
        let mut done = found.get(self.chosen).map(|entry| entry.command).filter(|c| enter && enabled(*c));
        ui.add_space(4.0);
        egui::ScrollArea::vertical().max_height(ROWS_HEIGHT).auto_shrink([false, true]).show(ui, |ui| {
            for (index, entry) in found.iter().enumerate() {
                let row = row_ui(ui, entry, obstacle(entry.command), index == self.chosen);
                if index == self.chosen && (up || down) {
                    row.scroll_to_me(None);
                }
                if row.clicked() {
                    done = Some(entry.command);
                }
            }
        });
        if found.is_empty() {
            ui.weak("No command has such a name.");
        }
        done
    }
}

/// One command: title and keys, or the reason why it can do nothing.
fn row_ui(ui: &mut egui::Ui, entry: &Entry, obstacle: Option<&'static str>, chosen: bool) -> egui::Response {
    let title = format!("{}: {}", entry.menu.title(), entry.title);
    let keys = entry.shortcut.as_ref().map(|keys| ui.ctx().format_shortcut(keys)).unwrap_or_default();
    let right = obstacle.map_or(keys, str::to_string);
    let button = egui::Button::selectable(chosen, title).right_text(RichText::new(right).weak());
    let button = button.min_size(egui::vec2(ui.available_width(), 0.0));
    ui.add_enabled(obstacle.is_none(), button).on_hover_text(entry.help)
}

/// Commands whose names hold the letters of the query, the nearest first.
fn find(query: &str) -> Vec<&'static Entry> {
    let mut found: Vec<(u32, &Entry)> = (TABLE.iter())
        .filter(|entry| entry.command != Command::Palette)
        .filter_map(|entry| {
            let in_title = distance(query, entry.title);
            let with_menu = distance(query, &format!("{} {}", entry.menu.title(), entry.title)).map(|d| d + 1);
            Some((in_title.into_iter().chain(with_menu).min()?, entry))
        })
        .collect();
    // Stable: equally near ones stay in the order of the menus.
    found.sort_by_key(|(distance, _)| *distance);
    found.into_iter().map(|(_, entry)| entry).collect()
}

/// How far a name is from a query, 0 where it begins with it; `None` where letters are missing.
fn distance(query: &str, name: &str) -> Option<u32> {
    let (query, name) = (query.trim().to_lowercase(), name.to_lowercase());
    if let Some(at) = name.find(&query) {
        let begins_word = name.get(..at).and_then(|before| before.chars().last()).is_none_or(|c| !c.is_alphanumeric());
        return Some(if at == 0 {
            0
        } else if begins_word {
            2
        } else {
            10
        });
    }
    // Letters in order with gaps: each gap counts.
    let (mut gaps, mut gap) = (0, false);
    let mut letters = query.chars().filter(|c| !c.is_whitespace()).peekable();
    for c in name.chars() {
        if letters.peek() == Some(&c) {
            letters.next();
            gaps += u32::from(std::mem::take(&mut gap));
        } else {
            gap = true;
        }
    }
    letters.peek().is_none().then_some(20 + gaps)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_beginnings_and_scattered_letters_find_a_command() {
        let first = |query: &str| find(query).first().map(|entry| entry.command);
        assert_eq!(first("undo"), Some(Command::Undo));
        assert_eq!(first("REDO"), Some(Command::Redo));
        assert_eq!(first("paste"), Some(Command::PasteMaterial));
        assert_eq!(first("apply all"), Some(Command::ApplyToAll));
        assert_eq!(first("dupmat"), Some(Command::DuplicateMaterial));
        assert_eq!(first("image"), Some(Command::SaveImage));
        assert_eq!(first("file save"), Some(Command::Save));
        assert_eq!(first("qqq"), None);
        assert_eq!(find("").len(), TABLE.len() - 1);
    }
}
