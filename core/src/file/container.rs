//! The one container for binary files of our own: a JSON header, arrays of numbers, a hash over all of it.
//!
//! `docs/containers.md` has the layout byte by byte. What the header and the arrays mean is up to the kind of file; a
//! reader of one kind refuses every other.

use std::path::Path;

use half::f16;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{FileError, read_bounded, write_atomic};

/// First bytes: not text, and changed by whatever changes line ends.
const MAGIC: [u8; 8] = *b"\x89BRN\r\n\x1a\n";

/// Version of the layout.
const LAYOUT: u32 = 1;

/// Bytes before the JSON: magic, layout, length of the JSON, length of the arrays.
const PREFIX: usize = 24;

/// Bytes of the hash at the end.
const HASH: usize = blake3::OUT_LEN;

/// Arrays start at multiples of this.
const ALIGN: usize = 8;

/// Longest JSON.
const MAX_JSON: usize = 16 << 20;

/// What a file holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    /// Name of the kind in files, such as `reference-checkpoint`.
    pub id: &'static str,
    /// Newest version of the kind that this program knows, and writes.
    pub version: u32,
}

/// A file of numbers with a description.
#[derive(Clone, Debug, PartialEq)]
pub struct Container {
    /// Name of the kind.
    pub kind: String,
    /// Version of the kind.
    pub version: u32,
    /// Description, as the kind defines it.
    pub header: Value,
    arrays: Vec<(String, Array)>,
}

/// Numbers of one type.
#[derive(Clone, Debug, PartialEq)]
pub enum Array {
    /// 64-bit floats.
    F64(Vec<f64>),
    /// 32-bit floats.
    F32(Vec<f32>),
    /// 16-bit floats.
    F16(Vec<f16>),
    /// Whole numbers.
    U32(Vec<u32>),
    /// Bytes.
    U8(Vec<u8>),
}

/// A type of number that arrays hold.
pub trait Element: Sized {
    /// Name of the type in files.
    const TYPE: &'static str;
    /// Wraps numbers.
    fn array(values: Vec<Self>) -> Array;
    /// Unwraps them; `None` when they are of another type.
    fn values(array: Array) -> Option<Vec<Self>>;
}

/// What the JSON of a file says.
#[derive(Serialize, Deserialize)]
struct Index {
    kind: String,
    version: u32,
    header: Value,
    arrays: Vec<ArrayEntry>,
}

#[derive(Serialize, Deserialize)]
struct ArrayEntry {
    name: String,
    #[serde(rename = "type")]
    of: String,
    count: u64,
}

/// Reason and remedy.
type Fault = (String, &'static str);

const ANOTHER: &str = "name a file that Burnish wrote, or make it anew";
const DAMAGED: &str = "copy it again from where it came, or make it anew";
const NEWER: &str = "update Burnish, or make it anew";

impl Container {
    /// A container without arrays.
    pub fn new(kind: Kind, header: Value) -> Container {
        Container { kind: kind.id.into(), version: kind.version, header, arrays: Vec::new() }
    }

    /// The same with one array more; names must differ.
    pub fn with<T: Element>(mut self, name: &str, values: Vec<T>) -> Container {
        debug_assert!(self.arrays.iter().all(|(known, _)| known != name), "{name} twice");
        self.arrays.push((name.into(), T::array(values)));
        self
    }

    /// A container of these arrays.
    pub fn of_arrays(kind: Kind, header: Value, arrays: Vec<(String, Array)>) -> Container {
        Container { arrays, ..Container::new(kind, header) }
    }

    /// All arrays with their names.
    pub fn into_arrays(self) -> Vec<(String, Array)> {
        self.arrays
    }

    /// Takes `count` numbers out; the error says what is there instead, as a reason about the file.
    pub fn take<T: Element>(&mut self, name: &str, count: usize) -> Result<Vec<T>, String> {
        let place = self.arrays.iter().position(|(known, _)| known == name);
        let place = place.ok_or_else(|| format!("lacks the numbers `{name}`"))?;
        let (_, array) = self.arrays.swap_remove(place);
        let (of, found) = (array.type_name(), array.count());
        let values = T::values(array).filter(|values| values.len() == count);
        values.ok_or_else(|| format!("has {found} of {of} as `{name}`, not {count} of {}", T::TYPE))
    }

    /// Writes the file, whole or not at all.
    pub fn write(&self, path: &Path) -> Result<(), FileError> {
        let bytes = self.encode().map_err(|reason| FileError::new(path, reason, "store less in it"))?;
        write_atomic(path, &bytes)
    }

    /// Reads a file of at most `max_bytes` that holds a known version of `kind`; any damage is found.
    pub fn read(path: &Path, kind: Kind, max_bytes: u64) -> Result<Container, FileError> {
        let bytes = read_bounded(path, max_bytes)?;
        Container::decode(&bytes, kind).map_err(|(reason, remedy)| FileError::new(path, reason, remedy))
    }

    fn encode(&self) -> Result<Vec<u8>, String> {
        let Container { kind, version, header, arrays } = self;
        let entry = |(name, array): &(String, Array)| ArrayEntry {
            name: name.clone(),
            of: array.type_name().into(),
            count: array.count() as u64,
        };
        let arrays_index = arrays.iter().map(entry).collect();
        let index = Index { kind: kind.clone(), version: *version, header: header.clone(), arrays: arrays_index };
        let mut json = serde_json::to_vec(&index).map_err(|e| format!("cannot be described ({e})"))?;
        // Spaces after the JSON are part of it.
        json.resize(json.len().next_multiple_of(ALIGN), b' ');
        if json.len() > MAX_JSON {
            return Err(format!("has a description of {} bytes, over the limit of {MAX_JSON}", json.len()));
        }
        let data: usize = arrays.iter().map(|(_, array)| array.bytes().next_multiple_of(ALIGN)).sum();
        let mut bytes = Vec::with_capacity(PREFIX + json.len() + data + HASH);
        bytes.extend(MAGIC);
        bytes.extend(LAYOUT.to_le_bytes());
        bytes.extend((json.len() as u32).to_le_bytes());
        bytes.extend((data as u64).to_le_bytes());
        bytes.extend(json);
        for (_, array) in arrays {
            array.append(&mut bytes);
            bytes.resize(bytes.len().next_multiple_of(ALIGN), 0);
        }
        let hash = blake3::hash(&bytes);
        bytes.extend(hash.as_bytes());
        Ok(bytes)
    }

    fn decode(bytes: &[u8], kind: Kind) -> Result<Container, Fault> {
        let (json, data) = parts(bytes)?;
        let damaged = |reason: String| (reason, DAMAGED);
        let index: Index = serde_json::from_slice(json)
            .map_err(|e| damaged(format!("has a description that makes no sense ({e})")))?;
        if index.kind != kind.id {
            return Err((format!("is a file of the kind `{}`, not `{}`", index.kind, kind.id), ANOTHER));
        }
        if index.version > kind.version {
            let (found, known) = (index.version, kind.version);
            return Err((format!("is version {found} of `{}`, and this program knows {known}", kind.id), NEWER));
        }
        let arrays = read_arrays(&index.arrays, data).map_err(damaged)?;
        Ok(Container { kind: index.kind, version: index.version, header: index.header, arrays })
    }
}

/// JSON and arrays of a file whose lengths and hash are right.
fn parts(bytes: &[u8]) -> Result<(&[u8], &[u8]), Fault> {
    let Some((prefix, rest)) = bytes.split_at_checked(PREFIX).filter(|_| bytes.starts_with(&MAGIC)) else {
        return Err(("is no file of numbers by Burnish, or a cut one".into(), ANOTHER));
    };
    let word = |at: usize| u32::from_le_bytes([prefix[at], prefix[at + 1], prefix[at + 2], prefix[at + 3]]);
    if word(8) != LAYOUT {
        return Err((format!("has the layout {}, and this program knows {LAYOUT}", word(8)), NEWER));
    }
    let (json, data) = (u64::from(word(12)), u64::from(word(16)) | u64::from(word(20)) << 32);
    let expected = json.checked_add(data).and_then(|n| n.checked_add((PREFIX + HASH) as u64));
    if expected != Some(bytes.len() as u64) || json > MAX_JSON as u64 {
        return Err((format!("has {} bytes, which are not those that it announces", bytes.len()), DAMAGED));
    }
    // Both fit: their sum is the length of what is in memory.
    let (content, hash) = bytes.split_at(bytes.len() - HASH);
    if blake3::hash(content).as_bytes() != hash {
        return Err(("is damaged: its hash is not that of its content".into(), DAMAGED));
    }
    Ok(rest[..rest.len() - HASH].split_at(json as usize))
}

/// The announced arrays, which must fill the data.
fn read_arrays(entries: &[ArrayEntry], mut data: &[u8]) -> Result<Vec<(String, Array)>, String> {
    let mut arrays: Vec<(String, Array)> = Vec::new();
    for ArrayEntry { name, of, count } in entries {
        if arrays.iter().any(|(known, _)| known == name) {
            return Err(format!("has two arrays `{name}`"));
        }
        let size = Array::size_of(of).ok_or_else(|| format!("has numbers of the unknown type `{of}`"))?;
        let bytes = count.checked_mul(size as u64).and_then(|bytes| usize::try_from(bytes).ok());
        let padded = bytes.and_then(|bytes| bytes.checked_next_multiple_of(ALIGN));
        // Memory is taken for what is there, not for what is announced.
        let (Some(bytes), Some((padded, rest))) = (bytes, padded.and_then(|padded| data.split_at_checked(padded)))
        else {
            return Err(format!("announces {count} numbers `{name}` and holds fewer"));
        };
        arrays.push((name.clone(), Array::from_bytes(of, &padded[..bytes])));
        data = rest;
    }
    if data.is_empty() { Ok(arrays) } else { Err(format!("holds {} bytes that it does not announce", data.len())) }
}

/// The types of numbers, declared once.
macro_rules! elements {
    ($($variant:ident $type:ty, $name:literal;)*) => {
        impl Array {
            fn type_name(&self) -> &'static str {
                match self { $(Array::$variant(_) => $name,)* }
            }

            fn count(&self) -> usize {
                match self { $(Array::$variant(values) => values.len(),)* }
            }

            /// Bytes of its numbers.
            pub fn bytes(&self) -> usize {
                match self { $(Array::$variant(values) => size_of_val(values.as_slice()),)* }
            }

            fn size_of(name: &str) -> Option<usize> {
                match name { $($name => Some(size_of::<$type>()),)* _ => None }
            }

            /// Little-endian.
            fn append(&self, bytes: &mut Vec<u8>) {
                match self {
                    $(Array::$variant(values) => values.iter().for_each(|v| bytes.extend_from_slice(&v.to_le_bytes())),)*
                }
            }

            /// Of a type that [`Array::size_of`] knows; none of any other.
            fn from_bytes(name: &str, bytes: &[u8]) -> Array {
                match name {
                    $($name => {
                        let (values, _) = bytes.as_chunks::<{ size_of::<$type>() }>();
                        Array::$variant(values.iter().map(|v| <$type>::from_le_bytes(*v)).collect())
                    })*
                    _ => Array::U8(Vec::new()),
                }
            }
        }

        $(impl Element for $type {
            const TYPE: &'static str = $name;

            fn array(values: Vec<$type>) -> Array {
                Array::$variant(values)
            }

            fn values(array: Array) -> Option<Vec<$type>> {
                match array {
                    Array::$variant(values) => Some(values),
                    _ => None,
                }
            }
        })*
    };
}

elements! {
    F64 f64, "f64";
    F32 f32, "f32";
    F16 f16, "f16";
    U32 u32, "u32";
    U8 u8, "u8";
}

#[cfg(test)]
#[path = "container_tests.rs"]
mod tests;
