//! The text of a preset's file: JSON for people, lists of numbers in lines of ten.

use std::path::Path;

use serde_json::Value;

use super::{MAX_BYTES, Preset, PresetError};
use crate::file::write_atomic;

/// Numbers in a line of a long list.
const IN_LINE: usize = 10;

impl Preset {
    /// The file's text, ending in a line break.
    pub fn to_text(&self) -> Result<String, PresetError> {
        let failed = |e: serde_json::Error| PresetError::Json { path: self.id.clone().into(), reason: e.to_string() };
        let mut text = String::new();
        append(&mut text, &serde_json::to_value(self).map_err(failed)?, 0);
        text.push('\n');
        Ok(text)
    }

    /// Checks the preset and writes its file as a whole or not at all. What could not be read again is not written.
    pub fn write(&self, path: &Path) -> Result<(), PresetError> {
        self.check(&path.display().to_string())?;
        let text = self.to_text()?;
        let bytes = text.len() as u64;
        if bytes > MAX_BYTES {
            return Err(PresetError::TooLarge { path: path.into(), bytes });
        }
        Ok(write_atomic(path, text.as_bytes())?)
    }
}

fn append(text: &mut String, value: &Value, depth: usize) {
    let indent = |text: &mut String, depth: usize| {
        text.push('\n');
        text.push_str(&"  ".repeat(depth));
    };
    match value {
        Value::Object(fields) if !fields.is_empty() => {
            text.push('{');
            for (i, (key, value)) in fields.iter().enumerate() {
                text.push_str(if i == 0 { "" } else { "," });
                indent(text, depth + 1);
                text.push_str(&format!("{}: ", Value::from(key.as_str())));
                append(text, value, depth + 1);
            }
            indent(text, depth);
            text.push('}');
        }
        Value::Array(items) if items.len() > IN_LINE => {
            text.push('[');
            for (i, item) in items.iter().enumerate() {
                match i % IN_LINE {
                    0 => {
                        text.push_str(if i == 0 { "" } else { "," });
                        indent(text, depth + 1);
                    }
                    _ => text.push_str(", "),
                }
                append(text, item, depth + 1);
            }
            indent(text, depth);
            text.push(']');
        }
        Value::Array(items) => {
            text.push('[');
            for (i, item) in items.iter().enumerate() {
                text.push_str(if i == 0 { "" } else { ", " });
                append(text, item, depth + 1);
            }
            text.push(']');
        }
        // A whole number as people write it: 380, not 380.0.
        Value::Number(number) => text.push_str(number.to_string().trim_end_matches(".0")),
        other => text.push_str(&other.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::testing::Folder;
    use crate::material::preset::{Fits, find, library};

    #[test]
    fn a_preset_comes_back_from_its_text_with_its_fits() {
        let folder = Folder::new();
        let path = folder.join("mine.json");
        let iron = find("Fe").unwrap();
        let fitted = Preset { fits: Some(Fits::new(&iron)), ..iron };
        fitted.write(&path).unwrap();
        assert_eq!(Preset::read(&path), Ok(fitted.clone()));
        let text = fitted.to_text().unwrap();
        assert!(text.lines().all(|line| line.chars().count() < 400) && text.lines().count() < 250, "{text}");
    }

    #[test]
    fn the_files_of_the_library_are_as_they_would_be_written() {
        for (name, text) in crate::material::preset::library::FILES {
            let preset = library().iter().find(|p| name == format!("{}.json", p.id)).unwrap();
            assert_eq!(text, preset.to_text().unwrap(), "{name}: burnish fit writes it anew");
        }
    }

    #[test]
    fn a_preset_that_is_none_is_not_written() {
        let folder = Folder::new();
        let path = folder.join("mine.json");
        let bad = Preset { n: Vec::new(), ..find("Fe").unwrap() };
        assert!(bad.write(&path).unwrap_err().to_string().contains("field `n`"));
        assert!(!path.exists());
    }

    #[test]
    fn a_preset_too_large_to_be_read_again_is_not_written() {
        let folder = Folder::new();
        let path = folder.join("mine.json");
        let note = |length: usize| Preset { note: Some("x".repeat(length)), ..find("Fe").unwrap() };
        let rest = note(0).to_text().unwrap().len();
        let fitting = MAX_BYTES as usize - rest;
        let error = note(fitting + 1).write(&path).unwrap_err().to_string();
        for words in ["mine.json: would have 4194305 bytes", "limit of 4194304", "shorten its texts"] {
            assert!(error.contains(words), "`{words}` is missing in: {error}");
        }
        assert!(!path.exists());
        note(fitting).write(&path).unwrap();
        assert!(Preset::read(&path).is_ok());
    }
}
