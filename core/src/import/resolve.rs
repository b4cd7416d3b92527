//! How an import gets at the files that a model refers to.

use super::budget::Meter;
use super::{Cause, data_uri};

/// Supplies the files beside a model. An importer asks nobody else for bytes.
pub trait Resolver {
    /// Bytes behind a relative URI as written in the model (percent-encoded), at most `budget` of them.
    fn read(&self, uri: &str, budget: u64) -> Result<Vec<u8>, ResolveError>;
}

/// Why a file was not supplied. Each names the URI.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ResolveError {
    /// Nothing is named.
    #[error("the URI is empty")]
    Empty,
    /// `file:`, `http:` and all other schemes except `data:`.
    #[error("{uri} has the scheme `{scheme}`; only relative paths and data: URIs are read")]
    Scheme {
        /// As written.
        uri: String,
        /// Before the colon.
        scheme: String,
    },
    /// A Windows drive or stream.
    #[error("{uri} has a colon, which names a drive or stream; only relative paths are read")]
    Drive {
        /// As written.
        uri: String,
    },
    /// `//host/x` and `\\host\x`.
    #[error("{uri} names a network host; only relative paths are read")]
    Host {
        /// As written.
        uri: String,
    },
    /// From the root of the disk.
    #[error("{uri} is an absolute path; only relative paths are read")]
    Absolute {
        /// As written.
        uri: String,
    },
    /// Leaves the model's folder, by `..` or through a symbolic link.
    #[error("{uri} leads out of the model's folder{how}")]
    Outside {
        /// As written.
        uri: String,
        /// In what way.
        how: &'static str,
    },
    /// The percent-encoding does not give UTF-8.
    #[error("{uri} is not UTF-8 after percent-decoding")]
    Encoding {
        /// As written.
        uri: String,
    },
    /// A zero byte or another control character.
    #[error("{uri} contains a control character")]
    Control {
        /// As written, escaped.
        uri: String,
    },
    /// A device name of Windows, whatever its folder and ending.
    #[error("{uri} contains `{name}`, a device name reserved by Windows")]
    Reserved {
        /// As written.
        uri: String,
        /// The component.
        name: String,
    },
    /// No such file.
    #[error("{uri} does not exist")]
    Missing {
        /// As written.
        uri: String,
    },
    /// A folder, pipe, device or socket.
    #[error("{uri} is {kind}, not a regular file")]
    Special {
        /// As written.
        uri: String,
        /// What it is.
        kind: &'static str,
    },
    /// Larger than allowed.
    #[error("{uri} has {bytes} bytes; {limit} may be read")]
    TooLarge {
        /// As written.
        uri: String,
        /// Its size, as far as known.
        bytes: u64,
        /// What was allowed.
        limit: u64,
    },
    /// Shrunk or grown under our hands.
    #[error("{uri} changed while it was read; try again")]
    Changed {
        /// As written.
        uri: String,
    },
    /// A `data:` URI that does not decode.
    #[error("data URI: {0}")]
    Data(String),
    /// The system refused.
    #[error("{uri} cannot be read: {reason}")]
    System {
        /// As written.
        uri: String,
        /// The system's words.
        reason: String,
    },
}

/// A URI or path as messages show it: in quotes, control characters escaped, not longer than a line.
pub(super) fn quoted(uri: &str) -> String {
    const LONGEST: usize = 80;
    let mut text: String = uri.chars().take(LONGEST).flat_map(char::escape_debug).collect();
    if uri.chars().nth(LONGEST).is_some() {
        text.push_str("...");
    }
    format!("'{text}'")
}

/// Reads what a URI of a model names, be it a file or inline data; counts against the budget. For inline data the
/// media type must be empty or one of `media`.
pub(super) fn fetch(resolver: &dyn Resolver, uri: &str, media: &[&str], meter: &mut Meter) -> Result<Vec<u8>, Cause> {
    let left = meter.bytes_left();
    let bytes = match uri.get(..5) {
        Some(scheme) if scheme.eq_ignore_ascii_case("data:") => data_uri::decode(&uri[5..], media, left)?,
        _ => resolver.read(uri, left)?,
    };
    meter.take_bytes(bytes.len() as u64)?;
    Ok(bytes)
}
