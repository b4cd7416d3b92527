//! The user's own presets: metals and saved materials, one file each in the user's data folder.
//!
//! Files are read and written by jobs, one after the other; after each the folder is listed anew.

use std::collections::{BTreeSet, VecDeque};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use burnish_core::document::Assigned;
use burnish_core::job::{Job, Outcome};
use burnish_core::material::preset::{self, Fits, Preset};
use burnish_core::material::saved::{self, SavedMaterial};
use eframe::egui;
use rayon::prelude::*;

use super::request::{Request, Requests};

/// Most files that are read of a folder.
const MAX_FILES: usize = 2000;

/// The user's presets as they are known now.
#[derive(Default)]
pub struct UserPresets {
    folder: Option<PathBuf>,
    listing: Arc<Listing>,
    waiting: VecDeque<Task>,
    running: Option<Job<(Listing, Vec<Event>)>>,
    told: BTreeSet<String>,
    /// Counts the changes of the listing.
    pub revision: u64,
    /// What assigning a preset does with the textures of the material.
    pub textures: Assigned,
}

/// What is in the folder.
#[derive(Clone, Debug, Default)]
pub struct Listing {
    /// Metals, sorted by name.
    pub metals: Vec<(PathBuf, Arc<Preset>)>,
    /// Saved materials, sorted by name.
    pub materials: Vec<(PathBuf, Arc<SavedMaterial>)>,
    /// What could not be read, in words.
    faults: Vec<String>,
}

/// What is to be done with the folder.
#[derive(Clone, Debug)]
enum Task {
    Read,
    Import(PathBuf),
    /// A metal that was looked at before.
    Add {
        metal: Box<Preset>,
        assign: bool,
    },
    Save(Box<SavedMaterial>),
    Rename {
        path: PathBuf,
        name: String,
    },
    Remove(PathBuf),
}

/// What became of it.
#[derive(Clone, Debug, PartialEq)]
enum Event {
    /// A preset came in.
    Imported(Arrival),
    /// One came in under another name, since its own was taken.
    ImportedAs {
        arrival: Arrival,
        notice: String,
    },
    Notice(String),
    Error(String),
}

/// A preset that came in.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrival {
    /// By which it is assigned.
    pub key: String,
    /// It shall be put on the selected materials.
    pub assign: bool,
}

impl UserPresets {
    /// Starts to read a folder, which need not exist; without one nothing is kept.
    pub fn new(folder: Option<PathBuf>) -> UserPresets {
        let waiting = folder.iter().map(|_| Task::Read).collect();
        UserPresets { folder, waiting, ..UserPresets::default() }
    }

    /// What is in the folder.
    pub fn listing(&self) -> &Arc<Listing> {
        &self.listing
    }

    /// Copies a metal or saved material into the folder; it is assigned once it is there.
    pub fn import(&mut self, path: PathBuf) {
        self.waiting.push_back(Task::Import(path));
    }

    /// Keeps a metal that was read and checked.
    pub fn add(&mut self, metal: Preset, assign: bool) {
        self.waiting.push_back(Task::Add { metal: Box::new(metal), assign });
    }

    /// Keeps a material, under a name with a number where its own is taken.
    pub fn save(&mut self, material: SavedMaterial) {
        self.waiting.push_back(Task::Save(Box::new(material)));
    }

    /// Gives what a file holds another name.
    pub fn rename(&mut self, path: &Path, name: &str) {
        self.waiting.push_back(Task::Rename { path: path.into(), name: name.trim().into() });
    }

    /// Removes a file of the folder. Documents that use what it held keep it.
    pub fn remove(&mut self, path: &Path) {
        self.waiting.push_back(Task::Remove(path.into()));
    }

    /// Takes over what jobs did and starts the next; once a frame. Returns the presets that came in.
    pub fn frame(&mut self, ctx: &egui::Context, requests: &mut Requests) -> Vec<Arrival> {
        let mut imported = Vec::new();
        match self.running.as_mut().map(Job::poll) {
            None | Some(Outcome::Running) => {}
            Some(Outcome::Failed) => self.running = None,
            Some(Outcome::Done((listing, events))) => {
                self.running = None;
                self.revision += 1;
                for fault in &listing.faults {
                    if self.told.insert(fault.clone()) {
                        requests.push(Request::Error(fault.clone()));
                    }
                }
                self.listing = Arc::new(listing);
                for event in events {
                    match event {
                        Event::Imported(arrival) => imported.push(arrival),
                        Event::ImportedAs { arrival, notice } => {
                            imported.push(arrival);
                            requests.push(Request::Notice(notice));
                        }
                        Event::Notice(text) => requests.push(Request::Notice(text)),
                        Event::Error(text) => requests.push(Request::Error(text)),
                    }
                }
            }
        }
        if self.running.is_none()
            && let Some(task) = self.waiting.pop_front()
        {
            let Some(folder) = self.folder.clone() else {
                requests.push(Request::Error("There is no folder for presets: the user has no home folder".into()));
                return imported;
            };
            let ctx = ctx.clone();
            let wake = move || ctx.request_repaint();
            let before = self.listing.clone();
            self.running = Some(Job::spawn("Presets", wake, move |_| {
                let event = task.run(&folder);
                (Listing::read(&folder).fitted(&before), event.into_iter().collect())
            }));
        }
        imported
    }
}

/// The key by which a saved material is assigned; ids of metals have no colon.
pub fn key_of(material: &SavedMaterial) -> String {
    format!("material:{}", material.name)
}

/// Gives a metal numbers and errors of its forms where it has none of its table; takes a tenth of a second then. Not
/// for the thread of the window.
pub fn fit(metal: &mut Preset) {
    if metal.stored_fits().is_none() {
        metal.fits = Some(Fits::new(metal));
    }
}

/// The same metal but for what can be made again.
fn alike(a: &Preset, b: &Preset) -> bool {
    let bare = |metal: &Preset| Preset { fits: None, ..metal.clone() };
    bare(a) == bare(b)
}

impl Listing {
    /// With the fits of every metal. Files without them are those that people put into the folder.
    fn fitted(mut self, before: &Listing) -> Listing {
        self.metals.par_iter_mut().for_each(|(path, metal)| {
            let known = before.metals.iter().find(|(other, known)| other == path && alike(known, metal));
            match known {
                Some((_, known)) => *metal = known.clone(),
                None => fit(Arc::make_mut(metal)),
            }
        });
        self.materials.par_iter_mut().for_each(|(_, material)| {
            if material.constants().is_some()
                && let Some(metal) = Arc::make_mut(material).metal.as_mut().and_then(|metal| metal.constants.as_mut())
            {
                fit(metal);
            }
        });
        self
    }

    fn read(folder: &Path) -> Listing {
        let mut listing = Listing::default();
        for path in files(&metals_folder(folder)) {
            match Preset::read(&path).map_err(|e| e.to_string()).and_then(|metal| own_id(&metal, &path).map(|()| metal))
            {
                Ok(metal) => listing.metals.push((path, Arc::new(metal))),
                Err(fault) => listing.faults.push(fault),
            }
        }
        for path in files(&materials_folder(folder)) {
            match SavedMaterial::read(&path) {
                Ok(material) => listing.materials.push((path, Arc::new(material))),
                Err(fault) => listing.faults.push(fault.to_string()),
            }
        }
        listing.metals.sort_by(|a, b| a.1.name.cmp(&b.1.name));
        listing.materials.sort_by(|a, b| a.1.name.cmp(&b.1.name));
        listing
    }
}

fn metals_folder(folder: &Path) -> PathBuf {
    folder.join("metals")
}

fn materials_folder(folder: &Path) -> PathBuf {
    folder.join("materials")
}

/// The `.json` files of a folder, sorted; none where it cannot be listed.
pub(super) fn files(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let mut paths: Vec<PathBuf> = paths.filter(|path| path.extension().is_some_and(|e| e == "json")).collect();
    paths.sort();
    paths.truncate(MAX_FILES);
    paths
}

/// Refuses the id of a metal that comes with the program: documents would not know which is meant.
fn own_id(metal: &Preset, path: &Path) -> Result<(), String> {
    match preset::library().iter().any(|known| known.id == metal.id) {
        true => Err(format!(
            "{}: field `id` is `{}`, the id of a metal that comes with Burnish; give it another id",
            path.display(),
            metal.id
        )),
        false => Ok(()),
    }
}

impl Task {
    fn run(self, folder: &Path) -> Option<Event> {
        let done = match self {
            Task::Read => return None,
            Task::Import(path) => import(&path, folder),
            Task::Add { metal, assign } => import_metal(*metal, assign, folder),
            Task::Save(material) => save(&material, folder).map(|(_, notice)| Event::Notice(notice)),
            Task::Rename { path, name } => rename(&path, &name, folder).map(Event::Notice),
            Task::Remove(path) => remove(&path, folder).map(Event::Notice),
        };
        Some(done.unwrap_or_else(Event::Error))
    }
}

fn import(path: &Path, folder: &Path) -> Result<Event, String> {
    match Preset::read(path) {
        Ok(metal) => {
            own_id(&metal, path)?;
            import_metal(metal, true, folder)
        }
        // A saved material is told from a metal by its fields; the message is that of what it says to be.
        Err(fault) => match SavedMaterial::read(path) {
            Ok(material) => {
                let (kept, notice) = save(&material, folder)?;
                let arrival = Arrival { key: key_of(&kept), assign: true };
                Ok(match kept.name == material.name {
                    true => Event::Imported(arrival),
                    false => Event::ImportedAs { arrival, notice },
                })
            }
            Err(saved::SavedError::Json { .. }) => Err(fault.to_string()),
            Err(saved::SavedError::Field { field, .. }) if field == "format" => Err(fault.to_string()),
            Err(other) => Err(other.to_string()),
        },
    }
}

/// Keeps a metal with its fits; one that is there already stays alone, another of its id is never written over.
fn import_metal(mut metal: Preset, assign: bool, folder: &Path) -> Result<Event, String> {
    let known = Listing::read(folder).metals;
    if known.iter().any(|(_, known)| alike(known, &metal)) {
        return Ok(Event::Imported(Arrival { key: metal.id, assign }));
    }
    fit(&mut metal);
    let file = |id: &str| metals_folder(folder).join(format!("{id}.json"));
    let built_in = |id: &str| preset::library().iter().any(|known| known.id == id);
    let taken = |id: &str| built_in(id) || file(id).exists() || known.iter().any(|(_, known)| known.id == id);
    if !taken(&metal.id) {
        write(&file(&metal.id), &metal)?;
        return Ok(Event::Imported(Arrival { key: metal.id, assign }));
    }
    let key = preset::numbered_id(&metal.id, taken);
    let whose = if built_in(&metal.id) { "Burnish has" } else { "You have" };
    let notice = format!("{whose} another metal with the id `{}`; the new one got the id `{key}`", metal.id);
    let metal = Preset { id: key.clone(), ..metal };
    write(&file(&key), &metal)?;
    Ok(Event::ImportedAs { arrival: Arrival { key, assign }, notice })
}

/// Writes a material into a new file, under a name that is free. Returns it as it is kept, and what to tell.
fn save(material: &SavedMaterial, folder: &Path) -> Result<(SavedMaterial, String), String> {
    let known = Listing::read(folder).materials;
    let taken = |name: &str| known.iter().any(|(_, known)| known.name == name);
    let name = &material.name;
    if known.iter().any(|(_, known)| **known == *material) {
        return Ok((material.clone(), format!("`{name}` is among your presets already")));
    }
    // Names have an end, and the number must fit before it.
    let stem: String = name.chars().take(saved::NAME_MAX - 8).collect();
    let mut names = std::iter::once(name.clone()).chain((2u64..).map(|number| format!("{stem} {number}")));
    let free = names.find(|candidate| !taken(candidate)).unwrap_or_default();
    let notice = match free == *name {
        true => format!("Saved `{name}` among your presets"),
        false => format!("You have another preset `{name}`; saved the new one as `{free}`"),
    };
    let kept = SavedMaterial { name: free, ..material.clone() };
    let folder = materials_folder(folder);
    make(&folder)?;
    kept.write(&new_file(&kept.name, &folder)).map_err(|e| e.to_string())?;
    Ok((kept, notice))
}

/// A file for a name that does not exist yet.
pub(super) fn new_file(name: &str, folder: &Path) -> PathBuf {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
    let stem: String = name.chars().map(plain).take(40).collect();
    let names = (1u64..).map(|number| match number {
        1 => format!("{stem}.json"),
        _ => format!("{stem}-{number}.json"),
    });
    names.map(|name| folder.join(name)).find(|path| !path.exists()).unwrap_or_default()
}

fn rename(path: &Path, name: &str, folder: &Path) -> Result<String, String> {
    inside(path, folder)?;
    if name.is_empty() {
        return Err("A preset needs a name of at least one letter".into());
    }
    if path.starts_with(metals_folder(folder)) {
        let metal = Preset { name: name.into(), ..Preset::read(path).map_err(|e| e.to_string())? };
        write(path, &metal)?;
    } else {
        let material = SavedMaterial { name: name.into(), ..SavedMaterial::read(path).map_err(|e| e.to_string())? };
        let taken = Listing::read(folder).materials.iter().any(|(other, known)| known.name == name && other != path);
        if taken {
            return Err(format!("There is a preset `{name}` already; choose another name"));
        }
        material.write(path).map_err(|e| e.to_string())?;
    }
    Ok(format!("Renamed to `{name}`"))
}

fn remove(path: &Path, folder: &Path) -> Result<String, String> {
    inside(path, folder)?;
    fs::remove_file(path).map_err(|e| format!("{}: cannot be removed ({e})", path.display()))?;
    Ok("Removed the preset; documents that use it keep it".into())
}

/// Only files of the folder are touched.
fn inside(path: &Path, folder: &Path) -> Result<(), String> {
    let parent = path.parent();
    match parent == Some(&metals_folder(folder)) || parent == Some(&materials_folder(folder)) {
        true => Ok(()),
        false => Err(format!("{} is not among your presets", path.display())),
    }
}

pub(super) fn make(folder: &Path) -> Result<(), String> {
    fs::create_dir_all(folder).map_err(|e| format!("{}: cannot be made ({e})", folder.display()))
}

fn write(path: &Path, metal: &Preset) -> Result<(), String> {
    path.parent().map_or(Ok(()), make)?;
    metal.write(path).map_err(|e| e.to_string())
}

#[cfg(test)]
#[path = "user_presets_tests.rs"]
mod tests;
