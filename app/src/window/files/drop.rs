//! Files that are dropped onto the window, or whose path is pasted, and pasted tables.

use std::path::{Path, PathBuf};

use burnish_core::material::TextureRole;
use eframe::egui::{self, Align2, Event};

use super::dialog::{FileKind, typed_path};
use super::load::name_of;
use crate::window::request::{Request, Requests};
use crate::window::session::Session;
use crate::window::table_import::looks_like_table;

/// A picture that waits for the choice of its slot.
#[derive(Clone, Debug)]
pub struct Pending {
    path: PathBuf,
    material: usize,
}

/// Looks for dropped files and for pasted paths and tables. Pictures are returned: their slot must be asked for.
pub fn take(ctx: &egui::Context, session: &Session, outbox: &mut Requests) -> Vec<Pending> {
    let mut paths: Vec<PathBuf> =
        ctx.input(|input| input.raw.dropped_files.iter().map(|file| file.path().to_path_buf()).collect());
    if !ctx.egui_wants_keyboard_input() {
        let text = ctx.input(|input| {
            let mut texts = input.events.iter().filter_map(|event| match event {
                Event::Paste(text) if text.lines().count() > 1 => Some(text.clone()),
                _ => None,
            });
            texts.find(|text| looks_like_table(text))
        });
        outbox.extend(text.map(Request::ImportText));
        let pasted = ctx.input(|input| {
            let mut texts = input.events.iter().filter_map(|event| match event {
                Event::Paste(text) if text.lines().count() == 1 => Some(typed_path(text)),
                _ => None,
            });
            texts.find(|path| FileKind::of(path).is_some())
        });
        // Asks the disk only when something looks like a path; else a pasted text would raise errors.
        paths.extend(pasted.filter(|path| path.is_absolute() && path.is_file()));
    }
    sort(paths, session.selection.material, outbox)
}

/// What to do with each file: one scene, then its light, then what goes onto it.
fn sort(mut paths: Vec<PathBuf>, material: usize, outbox: &mut Requests) -> Vec<Pending> {
    paths.sort_by_key(|path| FileKind::of(path).map(|kind| kind as u8));
    let (mut pictures, mut has_scene, mut has_map) = (Vec::new(), false, false);
    for path in paths {
        let name = name_of(&path.to_string_lossy());
        let once = |already: &mut bool, outbox: &mut Requests, what: &str, request: Request| {
            if std::mem::replace(already, true) {
                outbox.push(Request::Error(format!("{name} was left out: there can be one {what} at a time")));
            } else {
                outbox.push(request);
            }
        };
        match FileKind::of(&path) {
            Some(FileKind::Scene) => {
                let scene = path.to_string_lossy().into_owned();
                once(&mut has_scene, outbox, "model or document", Request::OpenScene(scene));
            }
            Some(FileKind::Environment) => once(&mut has_map, outbox, "HDRI", Request::LoadEnvironment(path)),
            Some(FileKind::Preset | FileKind::Table) => outbox.push(Request::ImportPreset(path)),
            Some(FileKind::Texture) => pictures.push(Pending { path, material }),
            None => outbox.push(Request::Error(format!(
                "{name} cannot be used; drop a model (.gltf, .glb, .obj), document (.burnish), HDRI (.hdr, .exr), \
                 texture (.png, .jpg), preset (.json) or table of optical constants (.csv, .txt, .yml, .spd)"
            ))),
        }
    }
    pictures
}

/// Says what letting go would do.
pub fn hover_ui(ctx: &egui::Context, session: &Session) {
    let names: Vec<Option<PathBuf>> =
        ctx.input(|input| input.raw.hovered_files.iter().map(|file| file.path.clone()).collect());
    if names.is_empty() {
        return;
    }
    let lines: Vec<String> = names.iter().map(|path| path.as_deref().map_or("Drop to use it".into(), hint)).collect();
    let material = session.material().map(|entry| entry.name.clone()).unwrap_or_default();
    egui::Area::new(egui::Id::unique("drop")).order(egui::Order::Tooltip).fixed_pos(egui::Pos2::ZERO).show(ctx, |ui| {
        let screen = ctx.content_rect();
        ui.painter().rect_filled(screen, 0.0, egui::Color32::from_black_alpha(160));
        let text = lines.join("\n").replace("{material}", &material);
        let font = egui::TextStyle::Heading.resolve(ui.style());
        ui.painter().text(screen.center(), Align2::CENTER_CENTER, text, font, egui::Color32::WHITE);
    });
}

fn hint(path: &Path) -> String {
    let name = name_of(&path.to_string_lossy());
    match FileKind::of(path) {
        Some(FileKind::Scene) => format!("Open {name}"),
        Some(FileKind::Environment) => format!("Light the scene with {name}"),
        Some(FileKind::Texture) => format!("Use {name} as a texture of `{{material}}`"),
        Some(FileKind::Preset) => format!("Import the preset {name}"),
        Some(FileKind::Table) => format!("Import optical constants from {name}"),
        None => format!("{name} cannot be used here"),
    }
}

/// Asks for the slot of a dropped picture; `None` while there is no answer, `Some(None)` for none.
pub fn slot_ui(ctx: &egui::Context, pending: &Pending, session: &Session) -> Option<Option<Request>> {
    let Some(entry) = session.document().materials.get(pending.material) else { return Some(None) };
    let mut answer = None;
    let shown = egui::Modal::new(egui::Id::unique("texture slot")).show(ctx, |ui| {
        ui.set_width(300.0);
        ui.heading("Use as texture");
        ui.label(format!("{} on `{}` as", name_of(&pending.path.to_string_lossy()), entry.name));
        ui.add_space(6.0);
        for role in TextureRole::ALL {
            let name = role.name();
            let title = name[..1].to_uppercase() + &name[1..];
            if ui.add_sized([300.0, 22.0], egui::Button::new(title)).clicked() {
                let Pending { path, material } = pending.clone();
                answer = Some(Some(Request::LoadTexture { material, role, path }));
            }
        }
        ui.add_space(6.0);
        if ui.button("Cancel").clicked() {
            answer = Some(None);
        }
    });
    if shown.should_close() {
        answer = answer.or(Some(None));
    }
    answer
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn several_files_become_one_scene_one_light_and_the_rest() {
        let mut outbox = Requests::new();
        let paths = ["b.hdr", "w.png", "a.glb", "c.hdr", "x.pdf", "p.json"].map(PathBuf::from).to_vec();
        let pictures = sort(paths, 2, &mut outbox);
        assert_eq!(pictures.len(), 1);
        let words: Vec<String> = outbox.iter().map(|request| format!("{request:?}")).collect();
        assert_eq!(words.len(), 5, "{words:?}");
        assert_eq!(words.iter().filter(|word| word.starts_with("Error")).count(), 2, "{words:?}");
        let place = |start: &str| words.iter().position(|word| word.starts_with(start));
        assert!(place("OpenScene") < place("LoadEnvironment"));
    }
}
