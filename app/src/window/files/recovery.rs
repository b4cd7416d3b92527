//! What would be lost in a crash: unsaved documents are written into a folder of the program while they are edited.
//!
//! Each running window owns one file `ID.json` with a locked companion `ID.lock`. A file whose lock is free belongs to
//! a program that did not end by itself. A thread writes, the window only hands it documents.

use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use burnish_core::document::{Document, MAX_BYTES};
use burnish_core::file::{read_bounded, write_atomic};
use serde_json::{Map, Value};

/// Value of the field `format`.
const FORMAT: &str = "burnish-recovery";
/// Largest file that is read: a document that is indented once more and names its files by absolute paths.
const MAX_FILE_BYTES: u64 = 2 * MAX_BYTES + (1 << 16);
/// Edits are collected this long: a drag is many of them.
const DELAY: Duration = Duration::from_secs(1);
/// The file is written at most this often.
const PAUSE: Duration = Duration::from_secs(3);
/// After this time a write that failed is tried again.
const RETRY: Duration = Duration::from_secs(10);
/// How long `--recover` waits for the program before to end.
const PATIENCE: Duration = Duration::from_secs(5);

/// Writes the recovery file of this window.
#[derive(Default)]
pub struct Recovery {
    shared: Option<Arc<Shared>>,
}

struct Shared {
    folder: PathBuf,
    slot: Mutex<Slot>,
    changed: Condvar,
    /// Held from taking a document out of the slot until it is written, so that an older one never takes the place of
    /// a newer one. Locked before the slot where both are.
    file: Mutex<Option<Owned>>,
}

#[derive(Default)]
struct Slot {
    /// The newest document that no file holds.
    wanted: Option<Snapshot>,
    /// The file is not needed: everything is saved.
    clean: bool,
    /// Files of a former run that are open now; to be removed once they are written anew or not needed any more.
    adopted: Vec<Found>,
    error: Option<String>,
    end: bool,
}

/// The file of this window. The lock lasts as long as the program, however it ends.
struct Owned {
    path: PathBuf,
    lock_path: PathBuf,
    _lock: File,
}

/// An unsaved document.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// As it is.
    pub document: Arc<Document>,
    /// Where it was saved before.
    pub path: Option<PathBuf>,
}

/// What a program left that did not end by itself.
#[derive(Debug)]
pub struct Found {
    path: PathBuf,
    lock_path: PathBuf,
    _lock: File,
    /// Name of the document for people.
    pub title: String,
    /// When it was written.
    pub time: SystemTime,
    snapshot: Snapshot,
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    // A panic of a writer leaves a whole file and a whole slot.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Recovery {
    /// Keeps the recovery file in a folder, which is created when it is needed.
    pub fn new(folder: PathBuf) -> Recovery {
        let shared =
            Arc::new(Shared { folder, slot: Mutex::default(), changed: Condvar::new(), file: Mutex::default() });
        let writer = shared.clone();
        std::thread::spawn(move || write_until_the_end(&writer));
        Recovery { shared: Some(shared) }
    }

    /// Hands over the newest document; it is on the disk some seconds later.
    pub fn keep(&self, snapshot: Snapshot) {
        self.change(|slot| {
            slot.wanted = Some(snapshot);
            slot.clean = false;
        });
    }

    /// Everything is saved: removes the file.
    pub fn forget(&self) {
        self.change(|slot| {
            slot.wanted = None;
            slot.clean = true;
        });
    }

    /// Removes the file of a former run as soon as its document is in the file of this one, or not needed any more.
    pub fn adopt(&self, found: Found) {
        self.change(|slot| {
            slot.adopted.push(found);
            // Both are about the document before; its own comes next.
            slot.wanted = None;
            slot.clean = false;
        });
    }

    /// What went wrong at the last attempt to write; each failure is told once.
    pub fn take_error(&self) -> Option<String> {
        lock(&self.shared.as_ref()?.slot).error.take()
    }

    /// Writes a document now and waits for it: for when the program is about to end badly.
    pub fn write_now(&self, snapshot: &Snapshot) -> Result<(), String> {
        let Some(shared) = &self.shared else {
            return Err("there is no folder for a recovery file; save the document yourself".into());
        };
        let mut file = lock(&shared.file);
        let mut slot = lock(&shared.slot);
        slot.wanted = None;
        slot.clean = false;
        let adopted = std::mem::take(&mut slot.adopted);
        drop(slot);
        let result = shared.write(&mut file, snapshot);
        shared.written(snapshot, adopted, result.is_ok());
        result
    }

    /// The program ends well: nothing stays. Waits for a file that is just being written.
    pub fn finish(&mut self) {
        if let Some(shared) = self.shared.take() {
            // Under the lock of the file the writer sees the end before it would make a new one.
            let mut file = lock(&shared.file);
            shared.end();
            remove_owned(&mut file);
            let adopted = std::mem::take(&mut lock(&shared.slot).adopted);
            adopted.into_iter().for_each(Found::discard);
        }
    }

    fn change(&self, change: impl FnOnce(&mut Slot)) {
        if let Some(shared) = &self.shared {
            change(&mut lock(&shared.slot));
            shared.changed.notify_all();
        }
    }
}

impl Drop for Recovery {
    fn drop(&mut self) {
        if let Some(shared) = &self.shared {
            shared.end();
        }
    }
}

fn write_until_the_end(shared: &Shared) {
    let mut earliest = Instant::now();
    let mut told: Option<String> = None;
    loop {
        let idle = |slot: &mut Slot| !slot.end && slot.wanted.is_none() && !slot.clean;
        let slot = shared.changed.wait_while(lock(&shared.slot), idle).unwrap_or_else(PoisonError::into_inner);
        let rest = earliest.saturating_duration_since(Instant::now());
        let pause = if slot.clean { Duration::ZERO } else { rest.max(DELAY) };
        let going_on = |slot: &mut Slot| !slot.end && !slot.clean;
        let waited = shared.changed.wait_timeout_while(slot, pause, going_on);
        drop(waited.unwrap_or_else(PoisonError::into_inner));

        let mut file = lock(&shared.file);
        let mut slot = lock(&shared.slot);
        if slot.end {
            return;
        }
        let (wanted, clean) = (slot.wanted.take(), std::mem::take(&mut slot.clean));
        if clean {
            let adopted = std::mem::take(&mut slot.adopted);
            drop(slot);
            remove_owned(&mut file);
            adopted.into_iter().for_each(Found::discard);
            continue;
        }
        let Some(snapshot) = wanted else { continue };
        let adopted = std::mem::take(&mut slot.adopted);
        drop(slot);
        let result = shared.write(&mut file, &snapshot);
        earliest = Instant::now() + if result.is_ok() { PAUSE } else { RETRY };
        shared.written(&snapshot, adopted, result.is_ok());
        // The same failure of each further attempt is no news.
        let fault = result.err();
        if fault.is_some() && fault != told {
            lock(&shared.slot).error.clone_from(&fault);
        }
        told = fault;
    }
}

impl Shared {
    fn end(&self) {
        lock(&self.slot).end = true;
        self.changed.notify_all();
    }

    fn write(&self, file: &mut Option<Owned>, snapshot: &Snapshot) -> Result<(), String> {
        let owned = match file.take() {
            Some(owned) => owned,
            None => Owned::new(&self.folder)?,
        };
        let path = &file.insert(owned).path;
        write_atomic(path, text(snapshot, SystemTime::now()).as_bytes()).map_err(|e| {
            format!("the recovery file cannot be written: {e}; save the document yourself until that is mended")
        })
    }

    /// After an attempt to write: what was `adopted` is safe now, or both wait for the next attempt.
    fn written(&self, snapshot: &Snapshot, adopted: Vec<Found>, well: bool) {
        if well {
            return adopted.into_iter().for_each(Found::discard);
        }
        let mut slot = lock(&self.slot);
        slot.adopted.extend(adopted);
        if slot.wanted.is_none() && !slot.clean {
            slot.wanted = Some(snapshot.clone());
        }
        drop(slot);
        self.changed.notify_all();
    }
}

fn remove_owned(file: &mut Option<Owned>) {
    if let Some(Owned { path, lock_path, .. }) = file.take() {
        remove(&path, &lock_path);
    }
}

impl Owned {
    fn new(folder: &Path) -> Result<Owned, String> {
        let fault = |e: std::io::Error| {
            let folder = folder.display();
            format!(
                "no recovery file can be kept in {folder} ({e}); make that folder writable, and save often until then"
            )
        };
        fs::create_dir_all(folder).map_err(fault)?;
        let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let id = format!("{:x}-{:x}", since.as_millis(), std::process::id());
        let (path, lock_path) = (folder.join(format!("{id}.json")), folder.join(format!("{id}.lock")));
        let lock = File::create(&lock_path).map_err(fault)?;
        lock.try_lock().map_err(|e| fault(e.into()))?;
        Ok(Owned { path, lock_path, _lock: lock })
    }
}

/// The document first: a lock without a document is nothing, a document without a lock would be offered again.
fn remove(path: &Path, lock_path: &Path) {
    for file in [path, lock_path] {
        // One that is gone already is as wanted; one that cannot be removed is offered again, which harms nothing.
        let _ = fs::remove_file(file);
    }
}

fn text(snapshot: &Snapshot, time: SystemTime) -> String {
    let secs = time.duration_since(UNIX_EPOCH).unwrap_or_default().as_secs();
    let path = snapshot.path.as_ref().map_or(Value::Null, |path| Value::String(path.to_string_lossy().into_owned()));
    // Seen from no folder, paths stay absolute.
    let document = serde_json::from_str(&snapshot.document.to_text(Path::new(""))).unwrap_or(Value::Null);
    let fields = [("format", FORMAT.into()), ("version", 1.into()), ("path", path), ("time_secs", secs.into())];
    let mut fields: Map<String, Value> = fields.into_iter().map(|(key, value)| (key.into(), value)).collect();
    fields.insert("document".into(), document);
    format!("{:#}\n", Value::Object(fields))
}

fn parse(bytes: &[u8], file: &Path) -> Option<(Snapshot, SystemTime)> {
    let json: Value = serde_json::from_slice(bytes).ok()?;
    if json["format"] != FORMAT {
        return None;
    }
    let document = Document::from_json(json["document"].clone(), file).ok()?;
    let time = UNIX_EPOCH + Duration::from_secs(json["time_secs"].as_u64()?.min(u64::from(u32::MAX)));
    let path = json["path"].as_str().map(PathBuf::from);
    Some((Snapshot { document: Arc::new(document), path }, time))
}

/// What is in the folder.
#[derive(Debug, Default)]
pub struct Scan {
    /// Documents of programs that ended badly, the newest first.
    pub found: Vec<Found>,
    /// Files that are none of ours or damaged; they were renamed.
    pub damaged: Vec<PathBuf>,
    /// Why files could not be read; they stay as they are.
    pub unreadable: Vec<String>,
    /// Files of programs that still run.
    pub in_use: usize,
}

/// Looks for documents that were not saved. With `patient` it waits some seconds for a program that is just ending.
pub fn scan(folder: &Path, patient: bool) -> Scan {
    let start = Instant::now();
    loop {
        let scan = scan_once(folder);
        let worth_waiting = patient && scan.found.is_empty() && scan.in_use > 0;
        if !worth_waiting || start.elapsed() > PATIENCE {
            return scan;
        }
        std::thread::sleep(Duration::from_millis(100));
    }
}

fn scan_once(folder: &Path) -> Scan {
    let mut scan = Scan::default();
    // No folder is as good as an empty one.
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for path in entries.map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|e| e == "json")) {
        let lock_path = path.with_extension("lock");
        let Ok(lock) = File::options().create(true).truncate(false).write(true).open(&lock_path) else { continue };
        match lock.try_lock() {
            Err(TryLockError::WouldBlock) => scan.in_use += 1,
            // A disk without locks: better offered twice than never.
            Ok(()) | Err(TryLockError::Error(_)) => match read_bounded(&path, MAX_FILE_BYTES) {
                Ok(bytes) => match parse(&bytes, &path) {
                    Some((snapshot, time)) => {
                        let title = snapshot.title();
                        scan.found.push(Found { path, lock_path, _lock: lock, title, time, snapshot });
                    }
                    None => {
                        let aside = path.with_extension("damaged");
                        if fs::rename(&path, &aside).is_ok() {
                            remove(&path, &lock_path);
                            scan.damaged.push(aside);
                        }
                    }
                },
                // Removed by its owner in between.
                Err(_) if matches!(path.try_exists(), Ok(false)) => remove(&path, &lock_path),
                Err(error) => scan.unreadable.push(error.to_string()),
            },
        }
    }
    scan.found.sort_by(|a, b| b.time.cmp(&a.time).then_with(|| b.path.cmp(&a.path)));
    scan
}

impl Snapshot {
    fn title(&self) -> String {
        let scene = &self.document.scene;
        let shown = self.path.as_deref().or(Some(Path::new(scene)).filter(|_| !scene.starts_with("gallery:")));
        let stem = shown.and_then(Path::file_stem).map(|stem| stem.to_string_lossy().into_owned());
        stem.unwrap_or_else(|| scene.trim_start_matches("gallery:").into())
    }
}

impl Found {
    /// The unsaved document.
    pub fn snapshot(&self) -> &Snapshot {
        &self.snapshot
    }

    /// Removes it for good.
    pub fn discard(self) {
        remove(&self.path, &self.lock_path);
    }

    /// How long ago it was written, for people.
    pub fn age(&self) -> String {
        let secs = SystemTime::now().duration_since(self.time).unwrap_or_default().as_secs();
        let (count, unit) = match secs {
            0..90 => return "a minute ago".into(),
            90..5400 => ((secs + 30) / 60, "minutes"),
            5400..129_600 => ((secs + 1800) / 3600, "hours"),
            _ => ((secs + 43_200) / 86_400, "days"),
        };
        format!("{count} {unit} ago")
    }
}

#[cfg(test)]
#[path = "recovery_tests.rs"]
mod tests;
