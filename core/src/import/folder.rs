//! Files of one folder and nothing else.
//!
//! A model is foreign text: a path in it may be meant to read the user's other files, to hang on a pipe or to reach a
//! server. What a path says is judged before the disk is touched; where it really leads is judged before it is opened.

use std::fs::{self, File, FileType};
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

use percent_encoding::percent_decode_str;

use super::resolve::{ResolveError, Resolver, quoted};

/// Resolves relative URIs inside one folder and its subfolders. Symbolic links may point inside, not out.
#[derive(Clone, Debug)]
pub struct FolderResolver {
    /// Canonical.
    root: PathBuf,
}

impl FolderResolver {
    /// For the files of `folder`.
    pub fn new(folder: &Path) -> Result<FolderResolver, ResolveError> {
        let root = fs::canonicalize(folder).map_err(|e| system(&folder.display().to_string(), &e))?;
        Ok(FolderResolver { root })
    }

    /// For the files beside `file`.
    pub fn beside(file: &Path) -> Result<FolderResolver, ResolveError> {
        match file.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => FolderResolver::new(folder),
            _ => FolderResolver::new(Path::new(".")),
        }
    }
}

impl Resolver for FolderResolver {
    fn read(&self, uri: &str, budget: u64) -> Result<Vec<u8>, ResolveError> {
        let mut path = self.root.clone();
        path.extend(components(uri)?);
        let path = fs::canonicalize(&path).map_err(|e| system(uri, &e))?;
        if !path.starts_with(&self.root) {
            return Err(ResolveError::Outside { uri: quoted(uri), how: " through a symbolic link" });
        }
        read_as(&path, uri, budget)
    }
}

/// Reads a file that the user named, wherever it is, if it is a regular one of at most `limit` bytes.
pub(super) fn read_regular(path: &Path, limit: u64) -> Result<Vec<u8>, ResolveError> {
    read_as(path, &path.display().to_string(), limit)
}

/// The path components that a URI means, or why it must not be followed. Does not touch the disk.
fn components(uri: &str) -> Result<Vec<String>, ResolveError> {
    let shown = || quoted(uri);
    // Judged as written and as decoded: `%2e%2e%2f` is `../`, and `http:%2f%2f` is still a scheme.
    let decoded = percent_decode_str(uri).decode_utf8().map_err(|_| ResolveError::Encoding { uri: shown() })?;
    if decoded.chars().any(char::is_control) {
        return Err(ResolveError::Control { uri: shown() });
    }
    if let Some((before, _)) = decoded.split_once(':') {
        let scheme = before.len() > 1 && before.chars().all(|c| c.is_ascii_alphanumeric() || "+-.".contains(c));
        return Err(match scheme {
            true => ResolveError::Scheme { uri: shown(), scheme: before.to_ascii_lowercase() },
            false => ResolveError::Drive { uri: shown() },
        });
    }
    // Exporters on Windows write backslashes; they separate here on every system.
    let slashes = decoded.replace('\\', "/");
    if slashes.starts_with("//") {
        return Err(ResolveError::Host { uri: shown() });
    }
    if slashes.starts_with('/') {
        return Err(ResolveError::Absolute { uri: shown() });
    }
    let mut parts: Vec<String> = Vec::new();
    for part in slashes.split('/') {
        match part {
            "" | "." => {}
            ".." if parts.pop().is_none() => return Err(ResolveError::Outside { uri: shown(), how: " by `..`" }),
            ".." => {}
            _ if reserved(part) => return Err(ResolveError::Reserved { uri: shown(), name: part.into() }),
            _ => parts.push(part.into()),
        }
    }
    if parts.is_empty() { Err(ResolveError::Empty) } else { Ok(parts) }
}

/// True for names that Windows takes for a device in any folder and with any ending.
fn reserved(part: &str) -> bool {
    let stem = part.split('.').next().unwrap_or("").trim_end().to_ascii_uppercase();
    let numbered = |prefix: &str| {
        stem.strip_prefix(prefix).is_some_and(|n| matches!(n.chars().next(), Some('1'..='9' | '¹' | '²' | '³')))
            && stem.chars().count() == 4
    };
    matches!(stem.as_str(), "CON" | "PRN" | "AUX" | "NUL" | "CONIN$" | "CONOUT$") || numbered("COM") || numbered("LPT")
}

/// Reads a whole regular file, checking kind and size before it is opened and size again after.
fn read_as(path: &Path, uri: &str, limit: u64) -> Result<Vec<u8>, ResolveError> {
    // Opening a pipe would wait for its writer, so the kind is asked of the path first and of the open file again.
    let meta = fs::metadata(path).map_err(|e| system(uri, &e))?;
    regular(meta.file_type(), uri)?;
    let file = File::open(path).map_err(|e| system(uri, &e))?;
    let meta = file.metadata().map_err(|e| system(uri, &e))?;
    regular(meta.file_type(), uri)?;
    if meta.len() > limit {
        return Err(ResolveError::TooLarge { uri: quoted(uri), bytes: meta.len(), limit });
    }
    let mut bytes = Vec::new();
    file.take(meta.len() + 1).read_to_end(&mut bytes).map_err(|e| system(uri, &e))?;
    if bytes.len() as u64 != meta.len() {
        return Err(ResolveError::Changed { uri: quoted(uri) });
    }
    Ok(bytes)
}

fn regular(kind: FileType, uri: &str) -> Result<(), ResolveError> {
    if kind.is_file() {
        return Ok(());
    }
    Err(ResolveError::Special { uri: quoted(uri), kind: special(kind) })
}

#[cfg(unix)]
fn special(kind: FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    match kind {
        _ if kind.is_dir() => "a folder",
        _ if kind.is_fifo() => "a named pipe",
        _ if kind.is_socket() => "a socket",
        _ if kind.is_block_device() || kind.is_char_device() => "a device",
        _ => "a special file",
    }
}

#[cfg(not(unix))]
fn special(kind: FileType) -> &'static str {
    if kind.is_dir() { "a folder" } else { "a special file" }
}

fn system(uri: &str, error: &std::io::Error) -> ResolveError {
    match error.kind() {
        ErrorKind::NotFound | ErrorKind::NotADirectory => ResolveError::Missing { uri: quoted(uri) },
        _ => ResolveError::System { uri: quoted(uri), reason: error.to_string() },
    }
}
