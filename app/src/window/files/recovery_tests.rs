//! What is kept of unsaved documents, and what comes back.

use super::*;

struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Scratch {
        let folder = std::env::temp_dir().join(format!("burnish-recovery-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        Scratch(folder)
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).into_iter().flatten().flatten();
        let mut names: Vec<String> = entries.map(|e| e.file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn snapshot(scene: &str, path: Option<&str>) -> Snapshot {
    let document = Document { scene: scene.into(), ..Document::default() };
    Snapshot { document: Arc::new(document), path: path.map(PathBuf::from) }
}

/// What stays when a program is killed: the file, and a lock that nobody holds.
fn kill(recovery: Recovery) {
    *lock(&recovery.shared.as_ref().expect("it was not finished").file) = None;
}

#[test]
fn what_a_killed_program_leaves_comes_back_with_its_path() {
    let folder = Scratch::new("killed");
    let recovery = Recovery::new(folder.0.clone());
    let kept = snapshot("/models/chair.glb", Some("/documents/chair.burnish"));
    recovery.write_now(&kept).unwrap();
    assert_eq!(scan(&folder.0, false).in_use, 1, "a running program is not disturbed");
    kill(recovery);
    let mut found = scan(&folder.0, false).found;
    assert_eq!(found.len(), 1);
    let found = found.remove(0);
    assert_eq!((found.title.as_str(), found.age().as_str()), ("chair", "a minute ago"));
    assert_eq!(found.snapshot().document, kept.document);
    assert_eq!(found.snapshot().path, kept.path);
    assert_eq!(scan(&folder.0, false).in_use, 1, "offered in one window, not in two");
    found.discard();
    assert!(folder.names().is_empty(), "{:?}", folder.names());
}

#[test]
fn the_thread_writes_what_it_is_handed_and_removes_what_is_saved() {
    let folder = Scratch::new("thread");
    let mut recovery = Recovery::new(folder.0.clone());
    let json = |names: &[String]| names.iter().filter(|name| name.ends_with(".json")).count();
    let wait = |count: usize| {
        while json(&folder.names()) != count {
            std::thread::sleep(Duration::from_millis(5));
        }
    };
    recovery.keep(snapshot("gallery:workbench", None));
    wait(1);
    recovery.forget();
    wait(0);
    recovery.keep(snapshot("gallery:workbench", None));
    wait(1);
    recovery.finish();
    assert!(folder.names().is_empty(), "{:?}", folder.names());
}

#[test]
fn an_adopted_file_goes_only_when_its_document_is_safe() {
    let folder = Scratch::new("adopted");
    let before = Recovery::new(folder.0.clone());
    before.write_now(&snapshot("gallery:workbench", None)).unwrap();
    kill(before);
    let recovery = Recovery::new(folder.0.clone());
    let found = scan(&folder.0, false).found.remove(0);
    let old = found.path.clone();
    recovery.adopt(found);
    assert!(old.exists());
    recovery.keep(snapshot("gallery:workbench", None));
    // What stays is the file of this run and its lock.
    while old.exists() || folder.names().len() != 2 {
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn an_adopted_file_goes_when_its_document_is_saved_or_discarded_at_once() {
    let folder = Scratch::new("settled");
    let leave_one = || {
        let before = Recovery::new(folder.0.clone());
        before.write_now(&snapshot("gallery:workbench", None)).unwrap();
        kill(before);
        scan(&folder.0, false).found.remove(0)
    };
    let mut recovery = Recovery::new(folder.0.clone());
    recovery.adopt(leave_one());
    recovery.keep(snapshot("gallery:workbench", None));
    recovery.forget();
    while !folder.names().is_empty() {
        std::thread::sleep(Duration::from_millis(5));
    }
    recovery.adopt(leave_one());
    recovery.keep(snapshot("gallery:workbench", None));
    recovery.finish();
    assert!(folder.names().is_empty(), "{:?}", folder.names());
}

#[test]
fn a_document_that_could_not_be_written_waits_for_the_next_attempt() {
    let folder = Scratch::new("again");
    // A file stands where the folder should be.
    fs::write(&folder.0, "").unwrap();
    let recovery = Recovery::new(folder.0.clone());
    let kept = snapshot("gallery:workbench", None);
    assert!(recovery.write_now(&kept).is_err());
    fs::remove_file(&folder.0).unwrap();
    while scan(&folder.0, false).in_use == 0 {
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn where_nothing_can_be_kept_it_says_so() {
    assert!(Recovery::default().write_now(&snapshot("gallery:workbench", None)).is_err());
}

#[test]
fn a_damaged_file_is_set_aside() {
    let folder = Scratch::new("damaged");
    fs::create_dir_all(&folder.0).unwrap();
    fs::write(folder.0.join("a.json"), "{\"format\": \"burnish-rec").unwrap();
    let found = scan(&folder.0, false);
    assert_eq!((found.found.len(), found.damaged.len()), (0, 1));
    assert_eq!(folder.names(), ["a.damaged"]);
}

#[test]
fn a_file_that_cannot_be_read_stays_and_is_told_about() {
    let folder = Scratch::new("unreadable");
    fs::create_dir_all(&folder.0).unwrap();
    let path = folder.0.join("a.json");
    File::create(&path).unwrap().set_len(MAX_FILE_BYTES + 1).unwrap();
    let found = scan(&folder.0, false);
    assert_eq!((found.found.len(), found.damaged.len(), found.unreadable.len()), (0, 0, 1));
    assert!(found.unreadable[0].contains("a.json"), "{:?}", found.unreadable);
    assert!(path.exists());
}
