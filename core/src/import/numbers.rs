//! Checks on numbers that come from a file.

use super::Cause;

/// Refuses a list with NaN or infinite numbers and says where the first is.
pub(super) fn finite<const N: usize>(what: &str, list: &[[f32; N]]) -> Result<(), Cause> {
    let bad = |v: &[f32; N]| v.iter().any(|x| !x.is_finite());
    let Some(first) = list.iter().position(bad) else { return Ok(()) };
    let count = list[first..].iter().filter(|v| bad(v)).count();
    let more = if count > 1 { format!(", and so are {count} in all") } else { String::new() };
    Err(Cause::Invalid(format!("{what} {first} is not finite{more}")))
}

/// The element of a list, or the fault of an index outside.
pub(super) fn pick<'a, T>(list: &'a [T], index: usize, what: &'static str) -> Result<&'a T, Cause> {
    list.get(index).ok_or(Cause::Index { what, index: index as u64, count: list.len() as u64 })
}
