//! The textures of a material: what is in each slot, and how to change it.

use burnish_core::document::{MaterialEntry, TextureChoice, role_key};
use burnish_core::material::{Material, TextureRole};
use burnish_core::scene::Image;
use eframe::egui::{self, Button};

use super::Context;
use crate::window::files::typed_path;
use crate::window::request::{Purpose, Request};
use crate::window::widget::{choice_ui, name_input, name_ui, name_widget, reset_ui};

/// The slots.
#[derive(Default)]
pub struct Textures {
    /// The slot whose buttons are shown.
    open: Option<TextureRole>,
    path: String,
}

/// A slot of the material that is shown.
struct Slot {
    role: TextureRole,
    /// `Base color texture`.
    label: String,
    /// It is not the model's own.
    changed: bool,
    /// What is in it; `None` for nothing.
    content: Option<String>,
}

impl Textures {
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>, index: usize) {
        let Some(entry) = context.session.document().materials.get(index).cloned() else { return };
        let scene = context.session.scene().clone();
        let Some(material) = scene.materials.get(index) else { return };
        let used = material.textures().iter().flatten().count();
        let title = if used == 0 { "Textures".into() } else { format!("Textures ({used})") };
        egui::CollapsingHeader::new(title).id_salt("textures").default_open(false).show(ui, |ui| {
            for (role, texture) in TextureRole::ALL.into_iter().zip(material.textures()) {
                let image = texture.and_then(|texture| scene.images.get(texture.image));
                let slot = Slot {
                    role,
                    label: label(role),
                    changed: entry.textures.contains_key(&role_key(role)),
                    content: image.map(|image| described(image)),
                };
                ui.push_id(role.name(), |ui| {
                    self.row_ui(ui, context, (index, &entry), &slot);
                    if self.open == Some(role) {
                        self.slot_ui(ui, context, (index, &entry), &slot);
                    }
                });
            }
        });
    }

    fn row_ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>, at: (usize, &MaterialEntry), slot: &Slot) {
        ui.horizontal(|ui| {
            let gap = ui.spacing().item_spacing.x;
            let hover = if slot.role.is_color() { "Colors, sRGB-encoded" } else { "Numbers, not color-managed" };
            let name = capital(slot.role.name());
            let name = name_ui(ui, &name, slot.changed, 0.36 * ui.available_width()).on_hover_text(hover);
            let width = ui.available_width() - 18.0 - gap;
            let text = slot.content.as_deref().unwrap_or("none");
            let button = Button::new(text).truncate().selected(self.open == Some(slot.role));
            let button = ui.add_sized([width, ui.spacing().interact_size.y], button);
            let button = button.labelled_by(name.id).on_hover_text(format!("{text}\nClick to change it"));
            name_widget(&button, &slot.label);
            if button.clicked() {
                self.open = if self.open == Some(slot.role) { None } else { Some(slot.role) };
                self.path.clear();
            }
            if reset_ui(ui, &slot.label, slot.changed) {
                set(context, at, slot, None);
            }
        });
    }

    fn slot_ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>, at: (usize, &MaterialEntry), slot: &Slot) {
        let (material, role) = (at.0, slot.role);
        egui::Frame::group(ui.style()).show(ui, |ui| {
            ui.horizontal_wrapped(|ui| {
                if ui.button("Load...").on_hover_text("Pick a PNG or JPEG file").clicked() {
                    context.requests.push(Request::PickFile(Purpose::Texture { material, role }));
                }
                let filled = slot.content.is_some();
                if ui.add_enabled(filled, Button::new("Clear")).on_hover_text("Nothing in this slot").clicked() {
                    set(context, at, slot, Some(TextureChoice::None));
                }
                let hover = "What the model has in this slot";
                if ui.add_enabled(slot.changed, Button::new("Back to model")).on_hover_text(hover).clicked() {
                    set(context, at, slot, None);
                }
            });
            let field = egui::TextEdit::singleline(&mut self.path).hint_text("or its path, then Enter");
            let field = ui.add(field.desired_width(ui.available_width()));
            name_input(&field, "Path of a texture", &self.path);
            let entered = field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
            if entered && !self.path.trim().is_empty() {
                let path = typed_path(&self.path);
                context.requests.push(Request::LoadTexture { material, role, path });
                self.path.clear();
            }
            image_ui(ui, context, at, slot);
            exchange_ui(ui, context, at, slot);
        });
    }
}

/// Another image of the model for the slot.
fn image_ui(ui: &mut egui::Ui, context: &mut Context<'_>, at: (usize, &MaterialEntry), slot: &Slot) {
    let document = context.session.document();
    let images = context.session.sources().models.get(&document.scene).map(|model| model.images.clone());
    let images = images.unwrap_or_default();
    if images.is_empty() {
        return;
    }
    let names: Vec<String> = images.iter().map(|image| described(image)).collect();
    let base = context.session.resolved().base.get(at.0);
    let place = match choice(at.1, base, slot.role) {
        TextureChoice::Image(place) => place,
        TextureChoice::None | TextureChoice::File(_) => usize::MAX,
    };
    let hover = "Put another image of the model into this slot";
    ui.horizontal(|ui| {
        let name = ui.label("Image");
        let width = ui.available_width();
        let picked = choice_ui(ui, "Image of the model", &names, place, width, Some(&name), hover);
        if let Some(picked) = picked {
            set(context, at, slot, Some(TextureChoice::Image(picked)));
        }
    });
}

/// What is in the slot for what is in another.
fn exchange_ui(ui: &mut egui::Ui, context: &mut Context<'_>, at: (usize, &MaterialEntry), slot: &Slot) {
    let others: Vec<TextureRole> = TextureRole::ALL.into_iter().filter(|role| *role != slot.role).collect();
    let names: Vec<&str> = others.iter().map(|role| role.name()).collect();
    let hover = "Exchange what is in this slot with what is in another; a color becomes numbers, or numbers a color, where \
                 the slots differ";
    ui.horizontal(|ui| {
        let name = ui.label("Exchange with");
        let width = ui.available_width();
        let picked = choice_ui(ui, "Exchange with", &names, usize::MAX, width, Some(&name), hover);
        let Some(other) = picked.and_then(|place| others.get(place)).copied() else { return };
        let base = context.session.resolved().base.get(at.0).cloned();
        let (here, there) = (choice(at.1, base.as_ref(), slot.role), choice(at.1, base.as_ref(), other));
        context.session.seal();
        context.session.edit("Exchange textures", &at.1.name, |document| {
            document.set_texture(at.0, slot.role, Some(there));
            document.set_texture(at.0, other, Some(here));
        });
        context.session.seal();
    });
}

/// What is in a slot, as a document says it.
fn choice(entry: &MaterialEntry, base: Option<&Material>, role: TextureRole) -> TextureChoice {
    entry.textures.get(&role_key(role)).cloned().unwrap_or_else(|| {
        let texture = base.and_then(|base| base.textures().get(role as usize).copied().flatten());
        texture.map_or(TextureChoice::None, |texture| TextureChoice::Image(texture.image))
    })
}

fn set(context: &mut Context<'_>, (index, entry): (usize, &MaterialEntry), slot: &Slot, choice: Option<TextureChoice>) {
    context.session.seal();
    context.session.edit(&slot.label, &entry.name, |document| document.set_texture(index, slot.role, choice));
    context.session.seal();
}

fn described(image: &Image) -> String {
    let name = if image.name.is_empty() { "unnamed" } else { &image.name };
    format!("{name}, {} x {}", image.width, image.height)
}

fn label(role: TextureRole) -> String {
    format!("{} texture", capital(role.name()))
}

fn capital(name: &str) -> String {
    let mut letters = name.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use burnish_core::material::{Sampler, TextureRef};

    #[test]
    fn a_slot_holds_what_was_chosen_else_what_the_model_has() {
        let texture = TextureRef { image: 3, sampler: Sampler::default(), uv_set: 0, transform: glam::Mat3::IDENTITY };
        let base = Material { normal_texture: Some(texture), ..Material::default() };
        let mut entry = MaterialEntry::default();
        assert_eq!(choice(&entry, Some(&base), TextureRole::Normal), TextureChoice::Image(3));
        assert_eq!(choice(&entry, Some(&base), TextureRole::Coat), TextureChoice::None);
        entry.textures.insert(role_key(TextureRole::Normal), TextureChoice::None);
        assert_eq!(choice(&entry, Some(&base), TextureRole::Normal), TextureChoice::None);
    }

    #[test]
    fn labels_begin_with_a_capital() {
        assert_eq!(label(TextureRole::MetallicRoughness), "Metallic roughness texture");
    }
}
