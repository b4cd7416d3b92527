//! Commands that edit the document: materials and objects.

use std::collections::BTreeMap;
use std::sync::Arc;

use burnish_core::document::{Document, MaterialEntry, TextureChoice, role_key};
use burnish_core::material::params::{self, PARAMS};
use burnish_core::material::{Material, TextureRef, TextureRole};
use serde_json::{Map, Value};

use super::commands::Command;
use super::request::{Request, Requests};
use super::session::Session;

/// Does a command about materials or objects; says by a request what is not seen.
pub fn command(command: Command, session: &mut Session, requests: &mut Requests) {
    // A command is one step of the history, whatever is done right before and after it.
    session.seal();
    match command {
        Command::CopyMaterial => copy(session, requests),
        Command::PasteMaterial => paste(session),
        Command::NewMaterial => add(session, "New material", |document| Some(document.add_material("Material"))),
        Command::DuplicateMaterial => {
            let index = session.selection.material;
            add(session, "Duplicate material", |document| document.duplicate_material(index));
        }
        Command::RemoveMaterial => remove(session),
        Command::ApplyToSelected => {
            let objects = session.selection.objects.clone();
            apply(session, "Apply to selected objects", &objects);
        }
        Command::ApplyToAll => {
            let objects = session.resolved().object_keys.clone();
            apply(session, "Apply to all objects", &objects);
        }
        Command::Hide => hide(session),
        Command::Isolate => isolate(session),
        Command::ShowAll => session.edit("Show all", "", Document::show_all),
        _ => {}
    }
    session.seal();
}

fn copy(session: &mut Session, requests: &mut Requests) {
    session.clipboard = whole(session).map(Arc::new);
    if let Some(copied) = &session.clipboard {
        requests.push(Request::Notice(format!("Copied material `{}`", copied.name)));
    }
}

/// The shown material with every factor and texture stated: it looks the same on a material of another source.
fn whole(session: &Session) -> Option<MaterialEntry> {
    let index = session.selection.material;
    let mut entry = MaterialEntry::clone(session.material()?);
    let material = session.scene().materials.get(index)?;
    let base = session.resolved().base.get(index)?;
    for (key, json) in factors(material) {
        entry.values.entry(key).or_insert(json);
    }
    for (role, choice) in textures(base) {
        entry.textures.entry(role).or_insert(choice);
    }
    Some(entry)
}

/// Values of all factors as documents store them.
fn factors(material: &Material) -> impl Iterator<Item = (String, Value)> {
    PARAMS.iter().filter_map(|spec| Some((spec.key.to_string(), spec.json(params::get(material, spec.key)?))))
}

/// What stands in all texture slots of a material of the model.
fn textures(material: &Material) -> impl Iterator<Item = (String, TextureChoice)> {
    let choice = |slot: Option<TextureRef>| slot.map_or(TextureChoice::None, |slot| TextureChoice::Image(slot.image));
    TextureRole::ALL.into_iter().zip(material.textures()).map(move |(role, slot)| (role_key(role), choice(slot)))
}

fn paste(session: &mut Session) {
    let Some(copied) = session.clipboard.clone() else { return };
    let targets = session.selected_materials();
    let target = match targets.as_slice() {
        [one] => session.document().materials.get(*one).map(|entry| entry.name.clone()).unwrap_or_default(),
        many => format!("{} materials", many.len()),
    };
    let pasted: Vec<(usize, MaterialEntry)> = (targets.into_iter())
        .map(|index| {
            let mut pasted = MaterialEntry::clone(&copied);
            // What the source of the target says already is no change of it.
            if let Some(base) = session.resolved().base.get(index) {
                let (factors, textures): (Map<_, _>, BTreeMap<_, _>) =
                    (factors(base).collect(), textures(base).collect());
                pasted.values.retain(|key, json| factors.get(key) != Some(json));
                pasted.textures.retain(|role, choice| textures.get(role) != Some(choice));
            }
            (index, pasted)
        })
        .collect();
    session.edit("Paste material", &target, |document| {
        for (index, pasted) in &pasted {
            document.paste_material(*index, pasted);
        }
    });
}

/// Adds a material, gives it to the selected objects and shows it.
fn add(session: &mut Session, label: &str, make: impl FnOnce(&mut Document) -> Option<usize>) {
    let objects = session.selection.objects.clone();
    let mut made = None;
    session.edit(label, "", |document| {
        made = make(document);
        if let Some(name) = made.and_then(|index| Some(document.materials.get(index)?.name.clone())) {
            document.assign_material(&objects, &name);
        }
    });
    session.selection.material = made.unwrap_or(session.selection.material);
}

fn remove(session: &mut Session) {
    let index = session.selection.material;
    let Some(name) = session.material().map(|entry| entry.name.clone()) else { return };
    session.edit("Delete material", &name, |document| _ = document.remove_material(index));
}

fn apply(session: &mut Session, label: &str, objects: &[String]) {
    let Some(name) = session.material().map(|entry| entry.name.clone()) else { return };
    session.edit(label, &name, |document| document.assign_material(objects, &name));
}

/// Selected objects are hidden; where all of them are already, they are shown again.
fn hide(session: &mut Session) {
    let selected = session.selection.objects.clone();
    let is_hidden = |key: &String| session.document().objects.iter().any(|o| o.key == *key && o.hidden);
    let hidden = !selected.iter().all(is_hidden);
    session.edit(if hidden { "Hide" } else { "Show" }, &names(&selected), |document| {
        for key in &selected {
            document.edit_object(key, |object| object.hidden = hidden);
        }
    });
}

fn isolate(session: &mut Session) {
    let (all, kept) = (session.resolved().object_keys.clone(), session.selection.objects.clone());
    session.edit("Isolate", &names(&kept), |document| document.isolate(&all, &kept));
}

/// Objects in a label.
pub fn names(objects: &[String]) -> String {
    match objects {
        [one] => one.clone(),
        many => format!("{} objects", many.len()),
    }
}
