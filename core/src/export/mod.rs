//! Whole scenes in the formats of other renderers, each with a report of what the format cannot hold.
//!
//! One folder per target. Names of files and elements are made here, never taken from a scene as they are.

pub mod gltf;
pub mod mitsuba;

mod image;
mod ply;

use std::fs;
use std::io;
use std::path::Path;

use serde::Serialize;

use crate::file::{FileError, write_atomic};

/// Longest part of a name of the scene that a file's name keeps.
const MAX_SLUG: usize = 40;

/// What became of a property that a format cannot hold as it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Loss {
    /// Something near it was written.
    Approximated,
    /// It was left out.
    Dropped,
}

impl Loss {
    /// Name for people.
    pub fn word(self) -> &'static str {
        match self {
            Loss::Approximated => "approximated",
            Loss::Dropped => "dropped",
        }
    }
}

/// One property of one element that was not written as it is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Note {
    /// Place in the scene, such as `material 3 'shell'`.
    pub element: String,
    /// What became of it.
    pub loss: Loss,
    /// What it is, what stands for it and how far that is off.
    pub what: String,
}

/// What was written.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// Paths inside the folder, in the order of writing.
    pub files: Vec<String>,
    /// What differs from the scene.
    pub notes: Vec<Note>,
}

impl Report {
    /// Adds a note that is not there yet.
    fn note(&mut self, element: impl Into<String>, loss: Loss, what: impl Into<String>) {
        let note = Note { element: element.into(), loss, what: what.into() };
        if !self.notes.contains(&note) {
            self.notes.push(note);
        }
    }
}

/// The folder that an export goes into.
struct Folder<'a> {
    root: &'a Path,
    report: Report,
}

impl<'a> Folder<'a> {
    /// Makes the folder where it is missing. One that holds a `main` file which does not begin with `mark` belongs to
    /// someone else and is refused; all else in it stays, except for files of the same names.
    fn create(root: &'a Path, main: &str, mark: &str) -> Result<Folder<'a>, FileError> {
        let path = root.join(main);
        if path.exists() {
            let ours = fs::read(&path).is_ok_and(|bytes| bytes.starts_with(mark.as_bytes()));
            if !ours {
                return Err(FileError::new(&path, "was not written by an export", "choose another folder"));
            }
        }
        let folder = Folder { root, report: Report::default() };
        folder.make(root)?;
        Ok(folder)
    }

    fn make(&self, path: &Path) -> Result<(), FileError> {
        let failure = |e: io::Error| FileError::new(path, format!("cannot be made a folder ({e})"), "choose another");
        fs::create_dir_all(path).map_err(failure)
    }

    /// Writes a file; `name` is made of [`slug`]s, folders before a `/`.
    fn write(&mut self, name: &str, bytes: &[u8]) -> Result<(), FileError> {
        let path = self.root.join(name);
        if let Some(parent) = path.parent() {
            self.make(parent)?;
        }
        write_atomic(&path, bytes)?;
        self.report.files.push(name.into());
        Ok(())
    }
}

/// A name for files and identifiers of any format: its number, then what of the scene's name is made of ASCII letters
/// and digits.
fn slug(index: usize, name: &str) -> String {
    let mut slug = index.to_string();
    let mut gap = true;
    for c in name.chars().take(4 * MAX_SLUG) {
        if slug.len() >= MAX_SLUG {
            break;
        }
        if c.is_ascii_alphanumeric() {
            if std::mem::take(&mut gap) {
                slug.push('-');
            }
            slug.push(c.to_ascii_lowercase());
        } else {
            gap = true;
        }
    }
    slug
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::testing::Folder as Scratch;

    #[test]
    fn a_slug_has_letters_digits_and_single_hyphens_only() {
        assert_eq!(slug(3, "Shell (left)"), "3-shell-left");
        assert_eq!(slug(0, ""), "0");
        assert_eq!(slug(0, "../../etc/passwd\u{0}\"><x/>"), "0-etc-passwd-x");
        assert_eq!(slug(1, "\u{e9}\u{1f600}$spp"), "1-spp");
        assert_eq!(slug(1, &"ab".repeat(500)).len(), MAX_SLUG);
    }

    #[test]
    fn a_folder_with_a_foreign_file_is_refused_and_others_stay() {
        let scratch = Scratch::new();
        let root = scratch.join("out");
        Folder::create(&root, "a.xml", "<ours").unwrap().write("sub/x.bin", b"1").unwrap();
        fs::write(root.join("a.xml"), "<ours and more").unwrap();
        fs::write(root.join("mine.txt"), "kept").unwrap();
        let mut folder = Folder::create(&root, "a.xml", "<ours").unwrap();
        folder.write("sub/x.bin", b"2").unwrap();
        assert_eq!(folder.report.files, ["sub/x.bin"]);
        assert_eq!(fs::read(root.join("sub/x.bin")).unwrap(), b"2");
        assert_eq!(fs::read(root.join("mine.txt")).unwrap(), b"kept");
        fs::write(root.join("a.xml"), "<theirs").unwrap();
        let refused = Folder::create(&root, "a.xml", "<ours").err().unwrap().to_string();
        assert!(refused.contains("a.xml") && refused.contains("another folder"), "{refused}");
    }

    #[test]
    fn a_note_is_told_once() {
        let mut report = Report::default();
        report.note("material 0 'a'", Loss::Dropped, "coat");
        report.note("material 0 'a'", Loss::Dropped, "coat");
        report.note("material 1 'a'", Loss::Dropped, "coat");
        assert_eq!(report.notes.len(), 2);
    }
}
