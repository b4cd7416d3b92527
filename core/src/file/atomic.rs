//! Whole files: bounded reads, atomic writes.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use super::FileError;

/// Tells apart the temporary files of one process.
static COUNTER: AtomicU32 = AtomicU32::new(0);

/// Reads a regular file of at most `max_bytes`. Pipes, devices and folders are refused: they may have no end.
pub fn read_bounded(path: &Path, max_bytes: u64) -> Result<Vec<u8>, FileError> {
    let unreadable = |e: io::Error| {
        let remedy = match e.kind() {
            io::ErrorKind::NotFound => "check the name and the folder",
            io::ErrorKind::PermissionDenied => "allow reading it, or copy it to where you may read",
            _ => "check that the disk can be read",
        };
        FileError::new(path, format!("cannot be read ({e})"), remedy)
    };
    // Asked before opening, for opening a pipe waits for a writer.
    let about = fs::metadata(path).map_err(unreadable)?;
    if !about.is_file() {
        return Err(FileError::new(path, "is not a regular file", "name a file, not a folder, pipe or device"));
    }
    let too_large = |bytes: u64| {
        let reason = format!("has {bytes} bytes or more, over the limit of {max_bytes}");
        FileError::new(path, reason, "use a smaller file")
    };
    if about.len() > max_bytes {
        return Err(too_large(about.len()));
    }
    let mut bytes = Vec::with_capacity(about.len() as usize);
    // One byte beyond the limit shows that the file grew while it was read.
    let file = File::open(path).map_err(unreadable)?;
    file.take(max_bytes.saturating_add(1)).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > max_bytes {
        return Err(too_large(bytes.len() as u64));
    }
    Ok(bytes)
}

/// Writes a file so that `path` holds the old bytes or all of the new ones, even if the power fails: a temporary file
/// in the same folder, synced, renamed over `path`, folder synced. A link is followed, not replaced.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    let unwritable = |e: io::Error| {
        let remedy = match e.kind() {
            io::ErrorKind::NotFound => "create the folder first",
            io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => "free some space or choose another disk",
            io::ErrorKind::InvalidFilename => "choose another name",
            _ => "choose a folder that you may write to",
        };
        FileError::new(path, format!("cannot be written ({e})"), remedy)
    };
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.into());
    if fs::metadata(&target).is_ok_and(|about| !about.is_file()) {
        return Err(FileError::new(path, "is not a regular file", "choose another name"));
    }
    let (folder, temporary) =
        beside(&target).ok_or_else(|| FileError::new(path, "has no file name", "end the path with a file name"))?;
    let written = write_synced(&temporary, bytes).and_then(|()| fs::rename(&temporary, &target));
    if let Err(e) = written {
        // The first error is what the user must know; a temporary file that cannot be removed changes nothing.
        let _ = fs::remove_file(&temporary);
        return Err(unwritable(e));
    }
    sync_folder(&folder).map_err(unwritable)
}

/// Folder of `target` and the name of a new hidden file in it; `None` when `target` ends in no name.
fn beside(target: &Path) -> Option<(PathBuf, PathBuf)> {
    // The name itself is left out: with it, the temporary one could be too long.
    target.file_name()?;
    let folder = match target.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_path_buf(),
        _ => PathBuf::from("."),
    };
    let number = COUNTER.fetch_add(1, Ordering::Relaxed);
    let temporary = folder.join(format!(".burnish-{}-{number}.tmp", std::process::id()));
    Some((folder, temporary))
}

fn write_synced(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = OpenOptions::new().write(true).create_new(true).open(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}

/// Makes the rename last. Only Unix can open a folder to do so.
fn sync_folder(folder: &Path) -> io::Result<()> {
    if cfg!(unix) { File::open(folder)?.sync_all() } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::testing::Folder;

    #[test]
    fn a_file_is_written_and_replaced_and_nothing_else_stays() {
        let folder = Folder::new();
        let path = folder.join("a.txt");
        write_atomic(&path, b"old").unwrap();
        write_atomic(&path, b"new").unwrap();
        assert_eq!(read_bounded(&path, 3).unwrap(), b"new");
        assert_eq!(folder.names(), ["a.txt"]);
    }

    #[test]
    fn a_failed_write_leaves_no_temporary_file_and_says_what_to_do() {
        let folder = Folder::new();
        let missing = write_atomic(&folder.join("none/a.txt"), b"x").unwrap_err().to_string();
        assert!(missing.contains("a.txt") && missing.contains("create the folder"), "{missing}");
        // A name that the file system refuses fails at the rename, after the temporary file was written.
        let long = write_atomic(&folder.join("x".repeat(300)), b"x").unwrap_err().to_string();
        assert!(long.contains("cannot be written"), "{long}");
        assert!(write_atomic(&folder.join("."), b"x").unwrap_err().to_string().contains("not a regular file"));
        assert!(folder.names().is_empty(), "{:?}", folder.names());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_followed_and_a_device_is_left_alone() {
        let folder = Folder::new();
        write_atomic(&folder.join("a.txt"), b"old").unwrap();
        std::os::unix::fs::symlink(folder.join("a.txt"), folder.join("link")).unwrap();
        write_atomic(&folder.join("link"), b"new").unwrap();
        assert_eq!(fs::read(folder.join("a.txt")).unwrap(), b"new");
        assert!(fs::symlink_metadata(folder.join("link")).unwrap().is_symlink());
        assert!(write_atomic(Path::new("/dev/null"), b"x").is_err());
    }

    #[test]
    fn reading_is_bounded_and_wants_a_regular_file() {
        let folder = Folder::new();
        let path = folder.join("a.txt");
        write_atomic(&path, b"four").unwrap();
        assert_eq!(read_bounded(&path, 4).unwrap(), b"four");
        let large = read_bounded(&path, 3).unwrap_err().to_string();
        assert!(large.contains("limit of 3"), "{large}");
        assert!(read_bounded(&folder.join("."), 9).unwrap_err().to_string().contains("not a regular file"));
        assert!(read_bounded(&folder.join("b"), 9).unwrap_err().to_string().contains("check the name"));
        if cfg!(unix) {
            assert!(read_bounded(Path::new("/dev/zero"), 9).is_err());
        }
    }
}
