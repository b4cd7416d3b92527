//! Which material is shown, and what can be done with it as a whole.

use burnish_core::material::preset;
use burnish_core::material::saved::{SavedMaterial, SavedMetal};
use eframe::egui::{self, Button};

use super::Context;
use crate::window::commands::Command;
use crate::window::request::Request;
use crate::window::widget::{choice_ui, name_input, name_widget};

/// The head of the inspector.
#[derive(Default)]
pub struct Header {
    /// The new name that is being typed.
    name: Option<String>,
    /// The preset that is being made.
    preset: Option<Draft>,
}

/// Name and tags of a preset before it is saved.
#[derive(Default)]
struct Draft {
    name: String,
    tags: String,
}

impl Header {
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>, index: usize) {
        self.pick_ui(ui, context, index);
        self.buttons_ui(ui, context, index);
        self.draft_ui(ui, context, index);
    }

    /// The list of materials, or the field for a new name.
    fn pick_ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>, index: usize) {
        let names: Vec<String> = context.session.document().materials.iter().map(|entry| entry.name.clone()).collect();
        ui.horizontal(|ui| {
            let width = (ui.available_width() - 66.0).max(60.0);
            if let Some(name) = &mut self.name {
                let field = ui.add(egui::TextEdit::singleline(name).desired_width(width));
                name_input(&field, "Material name", name);
                if field.lost_focus() {
                    let entered = ui.input(|input| input.key_pressed(egui::Key::Enter));
                    let name = self.name.take().filter(|_| entered);
                    rename(context, index, name.as_deref().unwrap_or_default().trim());
                } else if !field.has_focus() {
                    field.request_focus();
                }
                return;
            }
            let hover = "The material that is shown; click an object to see its material";
            if let Some(picked) = choice_ui(ui, "Material", &names, index, width, None, hover) {
                context.session.selection.material = picked;
            }
            let button = ui.button("Rename").on_hover_text("Give the material another name");
            name_widget(&button, "Rename material");
            if button.clicked() {
                self.name = names.get(index).cloned();
            }
        });
    }

    fn buttons_ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>, index: usize) {
        ui.spacing_mut().item_spacing.x = 4.0;
        ui.horizontal_wrapped(|ui| {
            command_ui(ui, context, Command::NewMaterial, "New", "Add a material");
            command_ui(ui, context, Command::DuplicateMaterial, "Duplicate", "Copy the material under a new name");
            command_ui(ui, context, Command::RemoveMaterial, "Delete", "Delete a material that no object has");
            command_ui(ui, context, Command::CopyMaterial, "Copy", "Remember the material");
            command_ui(ui, context, Command::PasteMaterial, "Paste", "Make it like the remembered one");
            command_ui(ui, context, Command::ApplyToSelected, "Apply to selected", "Give it to the selected objects");
            command_ui(ui, context, Command::ApplyToAll, "Apply to all", "Give it to every object");
            let button = Button::new("Save as preset...").small();
            if ui.add(button).on_hover_text("Keep factors and metal for other documents, without textures").clicked() {
                let draft = Draft { name: name_of(context, index), tags: String::new() };
                self.preset = if self.preset.is_some() { None } else { Some(draft) };
            }
        });
    }

    fn draft_ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>, index: usize) {
        let Some(draft) = &mut self.preset else { return };
        let mut done = false;
        egui::Frame::group(ui.style()).show(ui, |ui| {
            let width = ui.available_width();
            let field = ui.add(egui::TextEdit::singleline(&mut draft.name).hint_text("Name").desired_width(width));
            name_input(&field, "Name of the preset", &draft.name);
            let hint = "Tags, with commas between";
            let field = ui.add(egui::TextEdit::singleline(&mut draft.tags).hint_text(hint).desired_width(width));
            name_input(&field, "Tags of the preset", &draft.tags);
            ui.horizontal(|ui| {
                let named = !draft.name.trim().is_empty();
                if ui.add_enabled(named, Button::new("Save preset")).clicked() {
                    if let Some(saved) = saved(context, index, draft) {
                        context.own.save(saved);
                    }
                    done = true;
                }
                done |= ui.button("Cancel").clicked();
            });
        });
        if done {
            self.preset = None;
        }
    }
}

fn command_ui(ui: &mut egui::Ui, context: &mut Context<'_>, command: Command, text: &str, hover: &str) {
    let obstacle = command.obstacle(context.session);
    let button = ui.add_enabled(obstacle.is_none(), Button::new(text).small()).on_hover_text(hover);
    let button = button.on_disabled_hover_text(obstacle.unwrap_or_default());
    if matches!(
        command,
        Command::NewMaterial
            | Command::DuplicateMaterial
            | Command::RemoveMaterial
            | Command::CopyMaterial
            | Command::PasteMaterial
    ) {
        name_widget(&button, &format!("{text} material"));
    }
    if button.clicked() {
        context.requests.push(Request::Command(command));
    }
}

fn name_of(context: &Context<'_>, index: usize) -> String {
    context.session.document().materials.get(index).map(|entry| entry.name.clone()).unwrap_or_default()
}

fn rename(context: &mut Context<'_>, index: usize, name: &str) {
    let old = name_of(context, index);
    context.session.seal();
    context.session.edit("Rename material", &old, |document| document.rename_material(index, name));
    context.session.seal();
}

/// The material as a preset that stands alone.
fn saved(context: &Context<'_>, index: usize, draft: &Draft) -> Option<SavedMaterial> {
    let material = context.session.scene().materials.get(index)?;
    let document = context.session.document();
    let used = document.materials.get(index)?.preset.as_ref();
    let metal = used.map(|used| {
        let own = document.presets.iter().find(|metal| metal.id == used.id);
        let own = own.filter(|metal| !preset::library().iter().any(|known| *known == ***metal));
        let constants = own.map(|metal| Box::new(metal.as_ref().clone()));
        SavedMetal { id: used.id.clone(), fresnel: used.fresnel.clone(), constants }
    });
    let tags = draft.tags.split(',').map(str::trim).filter(|tag| !tag.is_empty()).map(Into::into).collect();
    Some(SavedMaterial::new(&draft.name, tags, material, metal))
}
