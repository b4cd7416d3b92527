//! The table of commands: menus, shortcuts, the palette and the shortcut page are made from it.

use burnish_core::document::Side;
use burnish_core::measure::view::DisplayMode;
use eframe::egui::{Key, KeyboardShortcut, Modifiers};

use super::compare::CompareView;
use super::panel::{Pane, Tool};
use super::session::Session;

/// What a user can ask for without an argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Command {
    /// Opens the start page.
    Start,
    /// Opens a model or document.
    Open,
    /// Lights the scene with an HDRI.
    LoadEnvironment,
    /// Saves the document.
    Save,
    /// Saves it under another name.
    SaveAs,
    /// Writes the picture.
    SaveImage,
    /// Writes the environment.
    SaveEnvironment,
    /// Ends the program.
    Quit,
    /// Takes back the last edit.
    Undo,
    /// Does it again.
    Redo,
    /// Copies the material.
    CopyMaterial,
    /// Makes the selected materials like the copied one.
    PasteMaterial,
    /// Adds a material.
    NewMaterial,
    /// Copies the material under a new name.
    DuplicateMaterial,
    /// Removes a material that nothing has.
    RemoveMaterial,
    /// Makes all materials like this one.
    ApplyToAll,
    /// Makes the materials of the selected objects like this one.
    ApplyToSelected,
    /// Names the selected object.
    Rename,
    /// Hides the selected objects.
    Hide,
    /// Hides all others.
    Isolate,
    /// Shows all objects.
    ShowAll,
    /// Frames the selection.
    Frame,
    /// Frames everything.
    FrameAll,
    /// From the front.
    ViewFront,
    /// From the right.
    ViewRight,
    /// From above.
    ViewTop,
    /// Parallel or perspective.
    Orthographic,
    /// Keeps the point of view.
    SaveCamera,
    /// The reference instead of the live picture.
    Reference,
    /// Another way to show the picture, or the picture again.
    Display(DisplayMode),
    /// Two pictures, or one again.
    Compare(CompareView),
    /// Keeps the document as a side of the comparison.
    StoreSide(Side),
    /// Exchanges the sides.
    SwapSides,
    /// Keeps the document under a name.
    TakeSnapshot,
    /// Another tool of the picture.
    Tool(Tool),
    /// What importers said.
    Notices,
    /// Shows a panel or puts it away.
    Panel(Pane),
    /// The palette.
    Palette,
    /// The shortcut page.
    Shortcuts,
    /// Larger.
    ScaleUp,
    /// Smaller.
    ScaleDown,
    /// Natural size.
    ScaleReset,
    /// Light or dark as the system is.
    ThemeSystem,
    /// Light.
    ThemeLight,
    /// Dark.
    ThemeDark,
    /// Panels where they were at first.
    ResetLayout,
}

/// Where a command stands in the menu bar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Menu {
    /// Documents and files.
    File,
    /// History.
    Edit,
    /// Materials.
    Material,
    /// Objects.
    Object,
    /// Snapshots and pairs of pictures.
    Compare,
    /// Camera and window.
    View,
    /// Help.
    Help,
}

impl Menu {
    /// In the order of the bar.
    pub const ALL: [Menu; 7] =
        [Menu::File, Menu::Edit, Menu::Material, Menu::Object, Menu::Compare, Menu::View, Menu::Help];

    /// Title in the bar.
    pub fn title(self) -> &'static str {
        match self {
            Menu::File => "File",
            Menu::Edit => "Edit",
            Menu::Material => "Material",
            Menu::Object => "Object",
            Menu::Compare => "Compare",
            Menu::View => "View",
            Menu::Help => "Help",
        }
    }
}

/// A line of the table.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// What it does.
    pub command: Command,
    /// Where it stands.
    pub menu: Menu,
    /// Title for people.
    pub title: &'static str,
    /// Keys; those without a modifier act only while no text is edited.
    pub shortcut: Option<KeyboardShortcut>,
    /// One sentence.
    pub help: &'static str,
}

const fn key(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::NONE, key))
}

const fn ctrl(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::COMMAND, key))
}

const fn ctrl_shift(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), key))
}

const fn entry(
    menu: Menu,
    command: Command,
    title: &'static str,
    shortcut: Option<KeyboardShortcut>,
    help: &'static str,
) -> Entry {
    Entry { command, menu, title, shortcut, help }
}

const fn panel(pane: Pane, title: &'static str, help: &'static str) -> Entry {
    entry(Menu::View, Command::Panel(pane), title, None, help)
}

const fn tool(tool: Tool, title: &'static str, shortcut: Key, help: &'static str) -> Entry {
    entry(Menu::Object, Command::Tool(tool), title, key(shortcut), help)
}

const fn compare(view: CompareView, title: &'static str, shortcut: Key, help: &'static str) -> Entry {
    entry(Menu::Compare, Command::Compare(view), title, key(shortcut), help)
}

/// All commands, in the order of the menus.
pub const TABLE: &[Entry] = &[
    entry(Menu::File, Command::Start, "Start page", None, "Recent documents and the default workbench."),
    entry(Menu::File, Command::Open, "Open...", ctrl(Key::O), "Open a model (glTF, OBJ) or a document."),
    entry(Menu::File, Command::LoadEnvironment, "Load HDRI...", ctrl(Key::L), "Light the scene with an HDR picture."),
    entry(Menu::File, Command::Save, "Save", ctrl(Key::S), "Save the document."),
    entry(Menu::File, Command::SaveAs, "Save as...", ctrl_shift(Key::S), "Save the document under another name."),
    entry(Menu::File, Command::SaveImage, "Save image...", ctrl(Key::E), "Write the picture as PNG or EXR, any size."),
    entry(
        Menu::File,
        Command::SaveEnvironment,
        "Save environment...",
        None,
        "Write the environment as HDR or EXR, with strength and tint, not turned, without a sun that is a light.",
    ),
    entry(Menu::File, Command::Quit, "Quit", ctrl(Key::Q), "End the program."),
    entry(Menu::Edit, Command::Undo, "Undo", ctrl(Key::Z), "Take back the last edit."),
    entry(Menu::Edit, Command::Redo, "Redo", ctrl_shift(Key::Z), "Do the last undone edit again."),
    entry(
        Menu::Material,
        Command::NewMaterial,
        "New material",
        ctrl(Key::N),
        "Add a material; the selected objects get it.",
    ),
    entry(
        Menu::Material,
        Command::DuplicateMaterial,
        "Duplicate material",
        ctrl(Key::D),
        "Copy the material under a new name; the selected objects get the copy.",
    ),
    entry(Menu::Material, Command::RemoveMaterial, "Delete material", None, "Delete a material that no object has."),
    entry(Menu::Material, Command::CopyMaterial, "Copy material", ctrl_shift(Key::C), "Remember the material."),
    entry(
        Menu::Material,
        Command::PasteMaterial,
        "Paste material",
        ctrl_shift(Key::V),
        "Make the selected materials like the remembered one.",
    ),
    entry(
        Menu::Material,
        Command::ApplyToSelected,
        "Apply to selected objects",
        None,
        "Give the selected objects this material.",
    ),
    entry(Menu::Material, Command::ApplyToAll, "Apply to all objects", None, "Give every object this material."),
    entry(Menu::Object, Command::Rename, "Rename", key(Key::F2), "Give the selected object another name."),
    entry(Menu::Object, Command::Hide, "Hide", key(Key::H), "Hide the selected objects."),
    entry(Menu::Object, Command::Isolate, "Isolate", key(Key::I), "Hide all other objects."),
    entry(Menu::Object, Command::ShowAll, "Show all", ctrl_shift(Key::H), "Show every object."),
    tool(Tool::Select, "Select tool", Key::Q, "A click selects, a drag moves the camera."),
    tool(Tool::Move, "Move tool", Key::G, "Handles in the picture move what is selected."),
    tool(Tool::Rotate, "Turn tool", Key::T, "Handles in the picture turn what is selected."),
    tool(Tool::Scale, "Scale tool", Key::Y, "Handles in the picture scale what is selected."),
    tool(Tool::Highlight, "Highlight tool", Key::L, "Drags put the highlight of the selected light."),
    tool(Tool::Shadow, "Shadow tool", Key::K, "Drags put the shadow that the selected light throws."),
    tool(Tool::Orbit, "Orbit tool", Key::O, "Drags lead the selected light around the subject."),
    compare(CompareView::Wipe, "Wipe", Key::W, "Side A left of a line that is dragged, side B right of it."),
    compare(CompareView::SideBySide, "Side by side", Key::S, "Side A in the left half, side B in the right one."),
    compare(CompareView::Difference, "Difference", Key::D, "Where side B differs from side A, as a heat map."),
    compare(
        CompareView::Error,
        "Error heat map",
        Key::E,
        "Where the live picture differs from the path-traced reference, as a heat map.",
    ),
    entry(
        Menu::Compare,
        Command::StoreSide(Side::A),
        "Store as A",
        ctrl(Key::Num1),
        "Keep the document as it is now as side A.",
    ),
    entry(
        Menu::Compare,
        Command::StoreSide(Side::B),
        "Store as B",
        ctrl(Key::Num2),
        "Keep the document as it is now as side B.",
    ),
    entry(Menu::Compare, Command::SwapSides, "Swap A and B", key(Key::X), "Exchange the sides."),
    entry(
        Menu::Compare,
        Command::TakeSnapshot,
        "Take snapshot",
        ctrl_shift(Key::N),
        "Keep the document as it is now under a name.",
    ),
    entry(Menu::View, Command::Frame, "Frame selection", key(Key::F), "Bring the selected objects into view."),
    entry(Menu::View, Command::FrameAll, "Frame all", key(Key::Home), "Bring everything into view."),
    entry(Menu::View, Command::ViewFront, "Front view", key(Key::Num1), "Look from the front."),
    entry(Menu::View, Command::ViewRight, "Right view", key(Key::Num3), "Look from the right."),
    entry(Menu::View, Command::ViewTop, "Top view", key(Key::Num7), "Look from above."),
    entry(Menu::View, Command::Orthographic, "Orthographic", key(Key::Num5), "Parallel or perspective."),
    entry(Menu::View, Command::SaveCamera, "Save camera", None, "Keep this point of view."),
    entry(
        Menu::View,
        Command::Reference,
        "Path-traced reference",
        key(Key::R),
        "Show the path-traced reference instead of the live picture; it refines while nothing changes.",
    ),
    entry(
        Menu::View,
        Command::Display(DisplayMode::FalseColor),
        "False colour",
        key(Key::U),
        "Show stops of luminance about middle grey as colours, before the tone map.",
    ),
    entry(
        Menu::View,
        Command::Display(DisplayMode::Clipping),
        "Clipping marks",
        key(Key::J),
        "Mark where channels are at an end of what the screen shows.",
    ),
    panel(Pane::Viewport, "Viewport panel", "Show the picture or put it away."),
    panel(Pane::Scene, "Scene panel", "Show the objects or put them away."),
    panel(Pane::Material, "Material panel", "Show the material's factors or put them away."),
    panel(Pane::Presets, "Presets panel", "Show the metals or put them away."),
    panel(Pane::Lights, "Lights panel", "Show the lights and their presets or put them away."),
    panel(Pane::Environment, "Environment panel", "Show light and view or put them away."),
    panel(Pane::Compare, "Compare panel", "Show snapshots and what differs between A and B or put them away."),
    panel(Pane::Chart, "Chart panel", "Show time against error of lighting methods or put it away."),
    panel(Pane::Reflectance, "Reflectance panel", "Show the plot of reflectance or put it away."),
    panel(Pane::Scope, "Scope panel", "Show histogram, waveform and aids of exposure or put them away."),
    panel(Pane::History, "History panel", "Show the list of steps or put it away."),
    entry(Menu::View, Command::ResetLayout, "Reset layout", None, "Put all panels where they were at first."),
    entry(Menu::View, Command::ScaleUp, "Larger interface", ctrl(Key::Plus), "Enlarge text and widgets."),
    entry(Menu::View, Command::ScaleDown, "Smaller interface", ctrl(Key::Minus), "Shrink text and widgets."),
    entry(Menu::View, Command::ScaleReset, "Natural size", ctrl(Key::Num0), "Text and widgets at their natural size."),
    entry(Menu::View, Command::ThemeSystem, "System theme", None, "Light or dark, as the system is."),
    entry(Menu::View, Command::ThemeLight, "Light theme", None, "A light window."),
    entry(Menu::View, Command::ThemeDark, "Dark theme", None, "A dark, neutral window: best for judging color."),
    entry(Menu::Help, Command::Palette, "Command palette", ctrl(Key::K), "Find any command by its name."),
    entry(Menu::Help, Command::Notices, "Notices", None, "What was left out or repaired in the files that were read."),
    entry(Menu::Help, Command::Shortcuts, "Shortcuts", key(Key::F1), "All shortcuts and gestures."),
];

impl Entry {
    /// A line stands above it in its menu.
    pub fn begins_group(&self) -> bool {
        matches!(
            self.command,
            Command::Open
                | Command::Save
                | Command::SaveImage
                | Command::Quit
                | Command::CopyMaterial
                | Command::ApplyToSelected
                | Command::Hide
                | Command::Tool(Tool::Select)
                | Command::ViewFront
                | Command::SaveCamera
                | Command::Reference
                | Command::StoreSide(Side::A)
                | Command::Panel(Pane::Viewport)
                | Command::ScaleUp
                | Command::ThemeSystem
        )
    }
}

impl Command {
    /// Its line in the table.
    pub fn entry(self) -> Option<&'static Entry> {
        TABLE.iter().find(|entry| entry.command == self)
    }

    /// True where the command can do something now.
    pub fn is_enabled(self, session: &Session) -> bool {
        self.obstacle(session).is_none()
    }

    /// Why the command can do nothing now, in words.
    pub fn obstacle(self, session: &Session) -> Option<&'static str> {
        let unless = |possible: bool, reason| (!possible).then_some(reason);
        match self {
            Command::Undo => unless(!session.history().past().is_empty(), "Nothing was edited."),
            Command::Redo => unless(session.history().future().next().is_some(), "Nothing was undone."),
            Command::PasteMaterial => unless(session.clipboard.is_some(), "Copy a material first."),
            Command::CopyMaterial | Command::DuplicateMaterial | Command::ApplyToAll => {
                unless(session.material().is_some(), "There is no material.")
            }
            Command::RemoveMaterial => {
                let removable = session.document().can_remove_material(session.selection.material);
                unless(removable, "An object has it, or it comes with the model.")
            }
            Command::Hide | Command::Isolate | Command::ApplyToSelected | Command::Rename => {
                unless(!session.selection.objects.is_empty(), "Select an object first.")
            }
            Command::ShowAll => {
                let hidden = session.document().objects.iter().any(|object| object.hidden);
                unless(hidden, "No object is hidden.")
            }
            _ => None,
        }
    }

    /// Also makes sense on the start page, where no document is seen.
    pub fn suits_start_page(self) -> bool {
        matches!(
            self,
            Command::Start
                | Command::Open
                | Command::Quit
                | Command::ScaleUp
                | Command::ScaleDown
                | Command::ScaleReset
                | Command::ThemeSystem
                | Command::ThemeLight
                | Command::ThemeDark
                | Command::ResetLayout
                | Command::Palette
                | Command::Notices
                | Command::Shortcuts
        )
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn no_title_and_no_key_stands_for_two_commands() {
        let titles: BTreeSet<&str> = TABLE.iter().map(|entry| entry.title).collect();
        assert_eq!(titles.len(), TABLE.len());
        let keys: Vec<_> = TABLE.iter().filter_map(|entry| entry.shortcut).collect();
        for (index, key) in keys.iter().enumerate() {
            assert!(!keys[..index].contains(key), "{key:?}");
        }
        assert!(TABLE.iter().all(|entry| entry.help.ends_with('.') && Menu::ALL.contains(&entry.menu)));
    }

    #[test]
    fn every_panel_can_be_shown_and_put_away() {
        assert!(Pane::ALL.iter().all(|pane| Command::Panel(*pane).entry().is_some()));
    }
}
