//! What went wrong (faults) and what was changed or left out (notices), each with file and element.

use std::fmt;

use super::ResolveError;
use crate::scene;

/// Faults beyond this many are only counted: a broken file repeats itself.
const FAULTS_KEPT: usize = 50;

/// Kinds of notice beyond this many are only counted.
const NOTICES_KEPT: usize = 200;

/// A file was refused; every fault that was found, in the order of the file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}", Lines(.faults, *.omitted))]
pub struct ImportError {
    /// At least one.
    pub faults: Vec<Fault>,
    /// Faults beyond the first fifty.
    pub omitted: usize,
}

/// One reason for which a file was refused. Prints as one line: file, element, cause, remedy.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// Name of the file.
    pub file: String,
    /// Place in the file, such as `mesh 3 'body', primitive 0, accessor 7`.
    pub element: String,
    /// What is wrong.
    pub cause: Cause,
}

/// The kinds of fault.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Cause {
    /// A file could not be had.
    #[error(transparent)]
    Read(#[from] ResolveError),
    /// The content is not of a kind that is read here.
    #[error("the content is {found}, not {expected}")]
    Content {
        /// What the bytes look like.
        found: String,
        /// What would be right.
        expected: &'static str,
    },
    /// The text or the container does not parse.
    #[error("{0}")]
    Syntax(String),
    /// More is asked for than the budget allows.
    #[error("asks for {asked} {what}; the limit is {limit}")]
    Limit {
        /// What is counted.
        what: &'static str,
        /// How many.
        asked: u64,
        /// How many are allowed.
        limit: u64,
    },
    /// The file cannot be shown without an extension that is not read here.
    #[error("requires the extension {0}, which is not supported")]
    Extension(String),
    /// Valid, but of a kind that is not read here.
    #[error("{0}")]
    Unsupported(String),
    /// An index points outside its list.
    #[error("{what} {index} does not exist (there are {count})")]
    Index {
        /// Name of the list's elements.
        what: &'static str,
        /// The index.
        index: u64,
        /// Length of the list.
        count: u64,
    },
    /// Values or relations that contradict the format.
    #[error("{0}")]
    Invalid(String),
}

impl Cause {
    /// What the user can do about it; `None` where the cause says it all.
    pub fn remedy(&self) -> Option<&'static str> {
        match self {
            Cause::Extension(name) => Some(match name.as_str() {
                "KHR_draco_mesh_compression" => "export the model without Draco compression",
                "EXT_meshopt_compression" | "KHR_meshopt_compression" => "export the model without meshopt compression",
                "KHR_texture_basisu" => "export the textures as PNG or JPEG instead of KTX2",
                "EXT_texture_webp" | "EXT_texture_avif" | "MSFT_texture_dds" => "export the textures as PNG or JPEG",
                _ => "export the model without it",
            }),
            Cause::Limit { .. } => Some("reduce the model or raise the import budget"),
            Cause::Read(ResolveError::Outside { .. }) => {
                Some("put the file into the model's folder and refer to it by a relative path")
            }
            Cause::Content { .. } => Some("check that the file was downloaded or exported completely"),
            Cause::Index { .. } | Cause::Invalid(_) => Some("export the model again"),
            Cause::Read(_) | Cause::Syntax(_) | Cause::Unsupported(_) => None,
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}: {}", self.file, self.element, self.cause)?;
        self.cause.remedy().map_or(Ok(()), |remedy| write!(f, "; {remedy}"))
    }
}

/// Faults one a line.
struct Lines<'a>(&'a [Fault], usize);

impl fmt::Display for Lines<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, fault) in self.0.iter().enumerate() {
            write!(f, "{}{fault}", if i == 0 { "" } else { "\n" })?;
        }
        if self.1 > 0 { write!(f, "\nand {} more faults", self.1) } else { Ok(()) }
    }
}

impl ImportError {
    /// An error with a single fault.
    pub(super) fn one(file: &str, element: &str, cause: Cause) -> ImportError {
        ImportError { faults: vec![Fault { file: file.into(), element: element.into(), cause }], omitted: 0 }
    }

    /// The faults of a scene that was read from `file`.
    pub(super) fn from_scene(file: &str, faults: Vec<scene::Fault>) -> ImportError {
        let omitted = faults.len().saturating_sub(FAULTS_KEPT);
        let faults = faults.into_iter().take(FAULTS_KEPT);
        let faults = faults.map(|f| Fault { file: file.into(), element: f.element, cause: Cause::Invalid(f.cause) });
        ImportError { faults: faults.collect(), omitted }
    }
}

/// Something that was left out, repaired or guessed; the picture still comes out.
#[derive(Clone, Debug, PartialEq)]
pub struct Notice {
    /// Name of the file.
    pub file: String,
    /// Place in the file, the first of them when it happened in several.
    pub element: String,
    /// What was done and why.
    pub text: String,
    /// How often.
    pub count: usize,
}

impl fmt::Display for Notice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}: {}", self.file, self.element, self.text)?;
        if self.count > 1 { write!(f, " ({} times)", self.count) } else { Ok(()) }
    }
}

/// Collects the faults and notices of one import.
#[derive(Debug)]
pub(super) struct Report {
    file: String,
    faults: Vec<Fault>,
    omitted: usize,
    notices: Vec<Notice>,
    unlisted: usize,
}

impl Report {
    pub fn new(file: &str) -> Report {
        Report { file: file.into(), faults: Vec::new(), omitted: 0, notices: Vec::new(), unlisted: 0 }
    }

    /// Records a fault.
    pub fn fault(&mut self, element: impl Into<String>, cause: Cause) {
        if self.faults.len() < FAULTS_KEPT {
            self.faults.push(Fault { file: self.file.clone(), element: element.into(), cause });
        } else {
            self.omitted += 1;
        }
    }

    /// The value, or a recorded fault.
    pub fn keep<T>(&mut self, element: impl Into<String>, result: Result<T, Cause>) -> Option<T> {
        result.map_err(|cause| self.fault(element, cause)).ok()
    }

    /// Records a notice; one with the same text is counted instead.
    pub fn notice(&mut self, element: impl Into<String>, text: impl Into<String>) {
        self.notice_many(element, text, 1);
    }

    /// Records a notice about `count` things; nothing when there are none.
    pub fn notice_many(&mut self, element: impl Into<String>, text: impl Into<String>, count: usize) {
        if count == 0 {
            return;
        }
        let text = text.into();
        if let Some(seen) = self.notices.iter_mut().find(|n| n.text == text) {
            seen.count += count;
        } else if self.notices.len() < NOTICES_KEPT {
            self.notices.push(Notice { file: self.file.clone(), element: element.into(), text, count });
        } else {
            self.unlisted += count;
        }
    }

    /// The first few notices in one line, for a fault that they explain.
    pub fn summary(&self) -> String {
        self.notices.iter().take(3).map(|n| n.text.as_str()).collect::<Vec<_>>().join("; ")
    }

    /// What was read with its notices, or all faults.
    pub fn finish<T>(self, value: Option<T>) -> Result<(T, Vec<Notice>), ImportError> {
        let Report { file, faults, omitted, mut notices, unlisted } = self;
        if unlisted > 0 {
            let text = "more notices are not listed".into();
            notices.push(Notice { file: file.clone(), element: "file".into(), text, count: unlisted });
        }
        match value {
            Some(value) if faults.is_empty() => Ok((value, notices)),
            _ if faults.is_empty() => {
                Err(ImportError::one(&file, "file", Cause::Invalid("holds nothing to show".into())))
            }
            _ => Err(ImportError { faults, omitted }),
        }
    }
}
