//! The user's own lighting presets: one file each in the user's data folder, read and written by jobs, one after the other.

use std::collections::{BTreeSet, VecDeque};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use burnish_core::document::{self, LightingPreset};
use burnish_core::file::write_atomic;
use burnish_core::job::{Job, Outcome};
use eframe::egui;

use super::request::{Request, Requests};
use super::user_presets::{files, make, new_file};

/// A preset with its file.
pub type Own = (PathBuf, LightingPreset);

/// The presets as they are known now.
#[derive(Default)]
pub struct UserLightings {
    folder: Option<PathBuf>,
    listing: Arc<Vec<Own>>,
    waiting: VecDeque<Task>,
    running: Option<Job<Done>>,
    told: BTreeSet<String>,
}

/// What is to be done.
#[derive(Clone, Debug)]
enum Task {
    Read,
    Keep(Box<LightingPreset>),
    Import(PathBuf),
    Export(Box<LightingPreset>, PathBuf),
    Remove(PathBuf),
}

/// What became of it.
struct Done {
    listing: Vec<Own>,
    /// Files that could not be read, in words.
    faults: Vec<String>,
    /// What to tell; `Err` where it failed.
    told: Option<Result<String, String>>,
    /// A preset that came in, to light the subject by.
    arrived: Option<LightingPreset>,
}

impl UserLightings {
    /// Starts to read a folder, which need not exist; without one nothing is kept.
    pub fn new(folder: Option<PathBuf>) -> UserLightings {
        let waiting = folder.iter().map(|_| Task::Read).collect();
        UserLightings { folder, waiting, ..UserLightings::default() }
    }

    /// Presets can be kept.
    pub fn has_folder(&self) -> bool {
        self.folder.is_some()
    }

    /// What is in the folder, sorted by name.
    pub fn listing(&self) -> &Arc<Vec<Own>> {
        &self.listing
    }

    /// A file is read or written.
    pub fn is_busy(&self) -> bool {
        self.running.is_some() || !self.waiting.is_empty()
    }

    /// Keeps a preset in a file of its own, under a name with a number where its own is taken.
    pub fn keep(&mut self, preset: LightingPreset) {
        self.waiting.push_back(Task::Keep(Box::new(preset)));
    }

    /// Reads a preset to light the subject by, and keeps it.
    pub fn import(&mut self, path: PathBuf) {
        self.waiting.push_back(Task::Import(path));
    }

    /// Writes a preset into a file.
    pub fn export(&mut self, preset: LightingPreset, path: PathBuf) {
        self.waiting.push_back(Task::Export(Box::new(preset), path));
    }

    /// Removes a file of the folder. Documents keep the lights that it held.
    pub fn remove(&mut self, path: &Path) {
        self.waiting.push_back(Task::Remove(path.into()));
    }

    /// Takes over what jobs did and starts the next; once a frame. Returns the preset that came in.
    pub fn frame(&mut self, ctx: &egui::Context, requests: &mut Requests) -> Option<LightingPreset> {
        let mut arrived = None;
        match self.running.as_mut().map(Job::poll) {
            None | Some(Outcome::Running) => {}
            Some(Outcome::Failed) => {
                self.running = None;
                requests.push(Request::Error("a lighting preset could not be read or written; try again".into()));
            }
            Some(Outcome::Done(done)) => {
                self.running = None;
                if *self.listing != done.listing {
                    self.listing = Arc::new(done.listing);
                }
                arrived = done.arrived;
                let faults = done.faults.into_iter().filter(|fault| self.told.insert(fault.clone()));
                requests.extend(faults.map(Request::Error));
                requests.extend(done.told.map(|told| told.map_or_else(Request::Error, Request::Notice)));
            }
        }
        if self.running.is_none()
            && let Some(task) = self.waiting.pop_front()
        {
            let (folder, waker) = (self.folder.clone(), ctx.clone());
            let work = move |_: &_| task.run(folder.as_deref());
            self.running = Some(Job::spawn("Lighting presets", move || waker.request_repaint(), work));
        }
        arrived
    }
}

impl Task {
    fn run(self, folder: Option<&Path>) -> Done {
        let mut arrived = None;
        let told = match self {
            Task::Read => None,
            Task::Keep(preset) => Some(keep(*preset, folder)),
            Task::Export(preset, path) => Some(write(&preset, &path).map(|()| format!("Wrote {}", path.display()))),
            Task::Remove(path) => Some(remove(&path, folder)),
            Task::Import(path) => Some(LightingPreset::read(&path).map_err(|e| e.to_string()).and_then(|preset| {
                arrived = Some(preset.clone());
                // What is there already needs no copy; ids are those of the files.
                let is_it =
                    |known: &LightingPreset| LightingPreset { id: preset.id.clone(), ..known.clone() } == preset;
                let known = read(folder).0.iter().any(|(_, known)| is_it(known));
                match known || folder.is_none() {
                    true => Ok(format!("Lit by `{}`", preset.name)),
                    false => keep(preset, folder),
                }
            })),
        };
        let (listing, faults) = read(folder);
        Done { listing, faults, told, arrived }
    }
}

/// The presets of a folder, and the files that are none.
fn read(folder: Option<&Path>) -> (Vec<Own>, Vec<String>) {
    let (mut listing, mut faults) = (Vec::new(), Vec::new());
    for path in folder.map(files).unwrap_or_default() {
        match LightingPreset::read(&path) {
            Ok(preset) => listing.push((path, preset)),
            Err(fault) => faults.push(fault.to_string()),
        }
    }
    listing.sort_by(|a, b| a.1.name.cmp(&b.1.name).then_with(|| a.0.cmp(&b.0)));
    (listing, faults)
}

fn keep(preset: LightingPreset, folder: Option<&Path>) -> Result<String, String> {
    let folder = folder.ok_or("There is no folder for presets: the user has no home folder")?;
    let own = read(Some(folder)).0;
    let taken = |name: &str| {
        let known = own.iter().map(|(_, known)| known).chain(LightingPreset::library());
        known.into_iter().any(|known| known.name == name)
    };
    let free = document::free(&preset.name, taken);
    let path = new_file(&free, folder);
    // The id is that of the file: ids of a folder are told apart as its files are.
    let id = path.file_stem().map_or(preset.id.clone(), |stem| stem.to_string_lossy().into_owned());
    write(&LightingPreset { name: free.clone(), id, ..preset }, &path)?;
    Ok(format!("Kept the lighting preset `{free}`"))
}

fn write(preset: &LightingPreset, path: &Path) -> Result<(), String> {
    preset.check(&preset.name).map_err(|fault| fault.to_string())?;
    path.parent().map_or(Ok(()), make)?;
    write_atomic(path, preset.to_text().as_bytes()).map_err(|error| error.to_string())
}

fn remove(path: &Path, folder: Option<&Path>) -> Result<String, String> {
    if folder.is_none() || path.parent() != folder {
        return Err(format!("{} is not among your presets", path.display()));
    }
    fs::remove_file(path).map_err(|e| format!("{}: cannot be removed ({e})", path.display()))?;
    Ok("Removed the lighting preset; documents keep its lights".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn finished(own: &mut UserLightings) -> (Option<LightingPreset>, Vec<String>) {
        let (ctx, mut requests, mut arrived) = (egui::Context::default(), Requests::new(), None);
        let start = std::time::Instant::now();
        while own.is_busy() {
            assert!(start.elapsed().as_secs() < 60);
            arrived = own.frame(&ctx, &mut requests).or(arrived);
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        let words = |request| match request {
            Request::Notice(text) => text,
            Request::Error(text) => format!("error: {text}"),
            other => format!("{other:?}"),
        };
        (arrived, requests.into_iter().map(words).collect())
    }

    #[test]
    fn presets_are_kept_under_free_names_exported_imported_and_removed() {
        let folder = std::env::temp_dir().join(format!("burnish-lightings-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        let mut own = UserLightings::new(Some(folder.join("own")));
        let rim = LightingPreset::library().iter().find(|preset| preset.id == "rim").unwrap().clone();
        for _ in 0..2 {
            own.keep(LightingPreset { name: "Mine".into(), ..rim.clone() });
        }
        finished(&mut own);
        let names: Vec<&str> = own.listing().iter().map(|(_, preset)| preset.name.as_str()).collect();
        assert_eq!(names, ["Mine", "Mine 2"]);
        let ids: BTreeSet<&str> = own.listing().iter().map(|(_, preset)| preset.id.as_str()).collect();
        assert_eq!(ids.len(), 2);

        let file = folder.join("shared.json");
        own.export(LightingPreset { name: "Shared".into(), ..rim.clone() }, file.clone());
        own.import(file.clone());
        let (arrived, told) = finished(&mut own);
        assert_eq!(arrived.map(|preset| preset.lights), Some(rim.lights.clone()), "{told:?}");
        assert_eq!(own.listing().len(), 3);
        own.import(file.clone());
        finished(&mut own);
        assert_eq!(own.listing().iter().filter(|(_, preset)| preset.name.starts_with("Shared")).count(), 1);

        let mine = own.listing()[0].0.clone();
        own.remove(&mine);
        own.remove(&file);
        let (_, told) = finished(&mut own);
        assert!(!mine.exists() && file.exists(), "only files of the folder are touched: {told:?}");
        fs::write(&file, "{ }").unwrap();
        own.import(file);
        let (arrived, told) = finished(&mut own);
        assert!(arrived.is_none() && told[0].contains("shared.json"), "{told:?}");
        fs::remove_dir_all(&folder).unwrap();
    }
}
