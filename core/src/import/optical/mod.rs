//! Import of measured optical constants: n and k over wavelength, from foreign files and pasted text, as a [`Preset`].
//!
//! Read are columns of numbers (CSV and friends, [`Format::Columns`]), the two blocks that refractiveindex.info exports,
//! its database files (YAML), pairs of `.spd` files, and our own presets. What a text is, is told by its content.
//! `docs/optical-constants.md` describes the formats for users.
//!
//! [`parse`] is a pure function of a text; [`read`] opens the file, and for a file of n alone the one of k beside it. A
//! result passes [`Preset::check`], has wavelengths in nm in increasing order, and comes with an [`ImportReport`] that
//! says what was guessed. Nothing is corrected silently: a table that could mean two things is refused with every
//! faulty line (up to ten) and the remedy.
//!
//! Limits: 16 MB a file, 200 000 rows (50 000 from 300 to 1000 nm), 10 000 characters a line but for presets.

mod citation;
mod csv;
mod curve;
mod draft;
mod fields;
mod formula;
mod header;
mod report;
mod scalar;
mod spd;
mod unit;
mod yaml;

use std::borrow::Cow;
use std::path::Path;

pub use report::{Finding, Format, ImportReport, OpticalError, OpticalFault, UnitOrigin};
pub use unit::{HC_EV_NM, Unit, UnknownUnit};

use crate::file::read_bounded;
use crate::import::sniff;
use crate::material::preset::{Preset, Source};
use csv::Columns;
use curve::Curve;
use draft::Draft;
use report::Log;
use spd::{Half, HalfName, Side};

/// Largest file or text, bytes.
const MAX_BYTES: usize = 16 << 20;

/// Rows of numbers in one file.
const MAX_ROWS: usize = 200_000;

/// Characters in a line.
const MAX_LINE_CHARS: usize = 10_000;

/// Characters of comments that become the note of a preset, and of references that become its source.
const MAX_NOTE_CHARS: usize = 2000;

/// What an import may be told.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// Unit of the first column, whatever the file says.
    pub unit: Option<Unit>,
    /// Id of the preset; else it is made from the name of the file.
    pub id: Option<String>,
    /// Name of the preset; else that of the file.
    pub name: Option<String>,
    /// Take k with the other sign, for files of n - ik.
    pub flip_k: bool,
}

/// Optical constants that were read.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// Passed [`Preset::check`]; from 300 to 1000 nm and one entry beyond, as far as the file reaches.
    pub preset: Preset,
    /// What was found, guessed and left out.
    pub report: ImportReport,
}

/// Reads a file. Of a file that holds n or k alone and is named so (`Au.eta.spd`), the other one is read too.
pub fn read(path: &Path, options: &Options) -> Result<Imported, OpticalError> {
    let name = path.file_name().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned());
    let mut log = Log::default();
    let text = load(path, &name, &mut log)?;
    let content = content(&text, &name, &mut log);
    let draft = match content {
        Content::Preset(preset) => return finish_preset(*preset, &name, options, log),
        Content::Draft(draft) => Some(*draft),
        Content::Half(half) => pair(path, half, &mut log)?,
    };
    finish(draft, options, log)
}

/// Reads a text; `name` serves messages and, without its ending, as name and id of the preset.
pub fn parse(text: &str, name: &str, options: &Options) -> Result<Imported, OpticalError> {
    let mut log = Log::default();
    if text.len() > MAX_BYTES {
        log.fault(
            name,
            None,
            format!("has {} bytes, over the limit of {MAX_BYTES}", text.len()),
            "use a smaller table",
        );
        return Err(log.into_error());
    }
    let text = text.trim_start_matches('\u{feff}');
    check_lines(text, name)?;
    let draft = match content(text, name, &mut log) {
        Content::Preset(preset) => return finish_preset(*preset, name, options, log),
        Content::Draft(draft) => Some(*draft),
        Content::Half(half) => {
            incomplete(&half, &mut log);
            None
        }
    };
    finish(draft, options, log)
}

/// What a text holds.
enum Content {
    Preset(Box<Preset>),
    Draft(Box<Draft>),
    /// n or k alone.
    Half(Half),
}

/// The text of a file. Text that is not UTF-8 is taken for Latin-1, in which every byte is a character: old programs
/// write the micro sign in it, and numbers are the same.
fn load(path: &Path, name: &str, log: &mut Log) -> Result<String, OpticalError> {
    let bytes = read_bounded(path, MAX_BYTES as u64)?;
    match decode(&bytes) {
        Ok((text, utf8)) => {
            if !utf8 {
                log.note(name, None, "is not UTF-8 and was read as Latin-1");
            }
            let text = text.trim_start_matches('\u{feff}');
            check_lines(text, name)?;
            Ok(text.to_string())
        }
        Err(found) => {
            let mut log = Log::default();
            log.fault(name, None, format!("is {found}, not a table"), "save it as text (CSV, UTF-8)");
            Err(log.into_error())
        }
    }
}

/// Refuses lines that no table has. JSON may be written in one line.
fn check_lines(text: &str, name: &str) -> Result<(), OpticalError> {
    // A character has a byte at least.
    let too_long = |line: &str| line.len() > MAX_LINE_CHARS && line.chars().nth(MAX_LINE_CHARS).is_some();
    let Some(index) = text.lines().position(too_long).filter(|_| !is_json(text)) else { return Ok(()) };
    let mut log = Log::default();
    let remedy = "is this a table? put each row on a line of its own, and break long texts";
    log.fault(name, index + 1, format!("has more than {MAX_LINE_CHARS} characters"), remedy);
    Err(log.into_error())
}

/// True for what can only be a preset.
fn is_json(text: &str) -> bool {
    text.trim_start().starts_with('{')
}

/// Bytes as text, and whether they were UTF-8; or what they are.
fn decode(bytes: &[u8]) -> Result<(Cow<'_, str>, bool), &'static str> {
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err("UTF-16 text");
    }
    let found = sniff::describe(bytes);
    if !matches!(found, "text" | "JSON" | "JSON with a byte order mark") {
        return Err(found);
    }
    if bytes.contains(&0) {
        return Err("binary data");
    }
    match std::str::from_utf8(bytes) {
        Ok(text) => Ok((text.into(), true)),
        Err(_) => Ok((bytes.iter().map(|b| char::from(*b)).collect(), false)),
    }
}

/// Tells what a text is and reads it. Faults are in the log.
fn content(text: &str, name: &str, log: &mut Log) -> Content {
    let draft = |draft| Content::Draft(Box::new(draft));
    let stem = Path::new(name).file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    if is_json(text) {
        match serde_json::from_str(text) {
            Ok(preset) => return Content::Preset(Box::new(preset)),
            Err(error) => log.fault(name, None, error.to_string(), "write it as presets/README.md shows"),
        }
        return draft(draft_of(Columns::default(), name, &stem));
    }
    if yaml::is_database_file(text) {
        return draft(yaml::read(text, name, &stem, log));
    }
    let columns = csv::read(text, name, log);
    match Half::fits(&columns) {
        true => Content::Half(Half::new(name, columns)),
        false => draft(draft_of(columns, name, &stem)),
    }
}

/// A table with both quantities, or with none.
fn draft_of(columns: Columns, name: &str, stem: &str) -> Draft {
    let Columns { n, k, unit, rows, comments, exported, .. } = columns;
    let curve = |samples| Curve { file: name.into(), samples };
    let mut draft = Draft {
        format: if exported { Format::Blocks } else { Format::Columns },
        n: curve(n),
        k: curve(k),
        unit,
        other: None,
        rows,
        stem: stem.into(),
        source: Source::default(),
        note: note_of(&comments),
    };
    if exported && !draft.looks_like_nanometres() {
        draft.unit = Some((Unit::Micrometre, UnitOrigin::Definition));
    }
    draft
}

/// Comments as the note of a preset.
fn note_of(comments: &[String]) -> Option<String> {
    let text: String = comments.join(" ").chars().take(MAX_NOTE_CHARS).collect();
    (!text.is_empty()).then_some(text)
}

/// Finds and reads the other file.
fn pair(path: &Path, half: Half, log: &mut Log) -> Result<Option<Draft>, OpticalError> {
    let Some(name) = HalfName::of(&half.file).filter(|_| !log.failed()) else {
        incomplete(&half, log);
        return Ok(None);
    };
    let siblings = name.siblings();
    let Some(sibling) = siblings.iter().find(|sibling| path.with_file_name(sibling).is_file()) else {
        let side = half.side.unwrap_or(name.side).symbol();
        let wanted = siblings.first().map_or("", String::as_str);
        let remedy = format!("put {wanted} into the same folder");
        log.fault(&half.file, None, format!("holds {side} alone, and {wanted} is not beside it"), &remedy);
        return Ok(None);
    };
    let text = load(&path.with_file_name(sibling), sibling, log)?;
    let columns = csv::read(&text, sibling, log);
    if !Half::fits(&columns) {
        if !log.failed() {
            log.fault(sibling, None, "does not have two columns, as its other half has", "give wavelength and value");
        }
        return Ok(None);
    }
    let other = Half::new(sibling, columns);
    // A folder `gold` with `eta.spd` and `k.spd`.
    let folder = path.parent().and_then(Path::file_name).map(|f| f.to_string_lossy().into_owned());
    let stem = if name.stem.is_empty() { folder.unwrap_or_default() } else { name.stem };
    Ok(spd::paired(half, other, &stem, log))
}

/// The fault of a text with n or k alone.
fn incomplete(half: &Half, log: &mut Log) {
    // Rows that could not be read may be why a column is missing.
    if log.failed() {
        return;
    }
    let reason = match half.side {
        Some(Side::N) => "has no column for k",
        Some(Side::K) => "has no column for n",
        None => "has two columns: n or k is missing",
    };
    let remedy = "give the columns `wavelength_nm,n,k`, or two files in one folder, such as Au.eta.spd and Au.k.spd";
    log.fault(&half.file, None, reason, remedy);
}

fn finish(draft: Option<Draft>, options: &Options, mut log: Log) -> Result<Imported, OpticalError> {
    let imported = draft.and_then(|draft| draft.finish(options, &mut log));
    imported.ok_or_else(|| log.into_error())
}

/// A preset as it is, but for the id and the name that were asked for.
fn finish_preset(mut preset: Preset, name: &str, options: &Options, mut log: Log) -> Result<Imported, OpticalError> {
    if options.unit.is_some_and(|unit| unit != Unit::Nanometre) || options.flip_k {
        let remedy = "leave --unit and --flip-k away, or correct the numbers";
        log.fault(name, None, "is a preset, which is in nm and n + ik by definition", remedy);
    }
    preset.id = options.id.clone().unwrap_or(preset.id);
    preset.name = options.name.clone().unwrap_or(preset.name);
    if let Err(error) = preset.check(name) {
        draft::refuse(error, name, &mut log);
    }
    if log.failed() {
        return Err(log.into_error());
    }
    let report = draft::report_of(&preset, name, log);
    Ok(Imported { preset, report })
}

#[cfg(test)]
mod tests;
