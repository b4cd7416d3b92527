//! What an import of optical constants says: faults that refuse a file, and what was noticed in one that was read.

use std::fmt;

use serde::Serialize;

use super::Unit;
use crate::file::FileError;

/// Faults beyond this many are only counted.
const FAULTS_KEPT: usize = 10;

/// Findings beyond this many are dropped; a file that has more is odd in one and the same way.
const FINDINGS_KEPT: usize = 50;

/// One reason for which a file was refused. Prints as one line: file, line, reason, remedy.
#[derive(Clone, Debug, PartialEq)]
pub struct OpticalFault {
    /// Name of the file or text.
    pub file: String,
    /// From 1; `None` for the file as a whole.
    pub line: Option<usize>,
    /// What is wrong.
    pub reason: String,
    /// What to do about it.
    pub remedy: String,
}

/// A file was refused, with up to ten of its faults.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}", Lines(.faults, *.omitted))]
pub struct OpticalError {
    /// At least one.
    pub faults: Vec<OpticalFault>,
    /// Faults beyond the first ten.
    pub omitted: usize,
}

/// Something noticed in a file that was read.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Name of the file or text.
    pub file: String,
    /// From 1; `None` for the file as a whole.
    pub line: Option<usize>,
    /// What was noticed or done.
    pub text: String,
}

/// What was found in the file, and what was done with it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ImportReport {
    /// How the file is laid out.
    pub format: Format,
    /// Unit of its first column.
    pub unit: Unit,
    /// How the unit is known.
    pub unit_origin: UnitOrigin,
    /// Name of the file beside the named one that held the other quantity, of a pair.
    pub other: Option<String>,
    /// Rows of numbers that were read.
    pub rows: usize,
    /// Shortest and longest wavelength at which both n and k are known, nm, before trimming.
    pub range_nm: (f64, f64),
    /// Entries of the preset.
    pub points: usize,
    /// Entries of the preset from 380 to 780 nm.
    pub visible_points: usize,
    /// What speaks against trusting the result.
    pub warnings: Vec<Finding>,
    /// What was done, such as reversing or trimming.
    pub notes: Vec<Finding>,
}

/// How a file is laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Format {
    /// Rows of wavelength, n and k.
    Columns,
    /// A block of `wl,n`, then one of `wl,k`: what refractiveindex.info exports.
    Blocks,
    /// A database file of refractiveindex.info.
    RefractiveIndexInfo,
    /// Two files of two columns each.
    Pair,
    /// Our own JSON.
    Preset,
}

/// How the unit of the first column is known.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum UnitOrigin {
    /// The caller said so.
    Asked,
    /// The header of a column names it.
    Header {
        /// From 1.
        line: usize,
        /// Text of the header of that column.
        text: String,
    },
    /// The format knows one unit only.
    Definition,
    /// From the values, for this reason.
    Guessed(String),
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Format::Columns => "columns",
            Format::Blocks => "a block of n and a block of k",
            Format::RefractiveIndexInfo => "refractiveindex.info database file",
            Format::Pair => "a file of n and a file of k",
            Format::Preset => "Burnish metal preset",
        })
    }
}

impl fmt::Display for UnitOrigin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            UnitOrigin::Asked => f.write_str("as asked for"),
            UnitOrigin::Header { line, text } => write!(f, "by the header `{text}` in line {line}"),
            UnitOrigin::Definition => f.write_str("by definition of the format"),
            UnitOrigin::Guessed(reason) => write!(f, "guessed: {reason}"),
        }
    }
}

/// File and, where there is one, line.
struct Place<'a>(&'a str, Option<usize>);

impl fmt::Display for Place<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.1 {
            Some(line) => write!(f, "{}: line {line}", self.0),
            None => f.write_str(self.0),
        }
    }
}

impl fmt::Display for OpticalFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let OpticalFault { file, line, reason, remedy } = self;
        write!(f, "{}: {reason}; {remedy}", Place(file, *line))
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", Place(&self.file, self.line), self.text)
    }
}

/// Faults one a line.
struct Lines<'a>(&'a [OpticalFault], usize);

impl fmt::Display for Lines<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, fault) in self.0.iter().enumerate() {
            write!(f, "{}{fault}", if i == 0 { "" } else { "\n" })?;
        }
        if self.1 > 0 { write!(f, "\nand {} more faults", self.1) } else { Ok(()) }
    }
}

impl From<FileError> for OpticalError {
    fn from(FileError { path, reason, remedy }: FileError) -> OpticalError {
        let fault = OpticalFault { file: path.display().to_string(), line: None, reason, remedy };
        OpticalError { faults: vec![fault], omitted: 0 }
    }
}

/// Collects what one import has to say.
#[derive(Debug, Default)]
pub(super) struct Log {
    faults: Vec<OpticalFault>,
    omitted: usize,
    pub warnings: Vec<Finding>,
    pub notes: Vec<Finding>,
}

impl Log {
    /// Records a fault.
    pub fn fault(&mut self, file: &str, line: impl Into<Option<usize>>, reason: impl Into<String>, remedy: &str) {
        if self.faults.len() >= FAULTS_KEPT {
            self.omitted += 1;
            return;
        }
        let (line, reason) = (line.into(), reason.into());
        self.faults.push(OpticalFault { file: file.into(), line, reason, remedy: remedy.into() });
    }

    /// Records a warning.
    pub fn warn(&mut self, file: &str, line: impl Into<Option<usize>>, text: impl Into<String>) {
        if self.warnings.len() < FINDINGS_KEPT {
            self.warnings.push(Finding { file: file.into(), line: line.into(), text: text.into() });
        }
    }

    /// Records a note.
    pub fn note(&mut self, file: &str, line: impl Into<Option<usize>>, text: impl Into<String>) {
        if self.notes.len() < FINDINGS_KEPT {
            self.notes.push(Finding { file: file.into(), line: line.into(), text: text.into() });
        }
    }

    /// True when there is a fault.
    pub fn failed(&self) -> bool {
        !self.faults.is_empty()
    }

    /// The faults, in the order of the lines; there must be one.
    pub fn into_error(self) -> OpticalError {
        let Log { mut faults, omitted, .. } = self;
        faults.sort_by(|a, b| (&a.file, a.line).cmp(&(&b.file, b.line)));
        OpticalError { faults, omitted }
    }
}
