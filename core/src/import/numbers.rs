//! Checks on numbers that come from a file.

use super::Cause;

/// The first index at which a list is not finite, with how many are not.
pub(super) fn infinite<const N: usize>(list: &[[f32; N]]) -> Option<(usize, usize)> {
    let bad = |v: &[f32; N]| v.iter().any(|x| !x.is_finite());
    let first = list.iter().position(bad)?;
    Some((first, list[first..].iter().filter(|v| bad(v)).count()))
}

/// Refuses a list with NaN or infinite numbers and says where the first is.
pub(super) fn finite<const N: usize>(what: &str, list: &[[f32; N]]) -> Result<(), Cause> {
    match infinite(list) {
        None => Ok(()),
        Some((first, 1)) => Err(Cause::Invalid(format!("{what} {first} is not finite"))),
        Some((first, count)) => Err(Cause::Invalid(format!("{what} {first} is not finite, and so are {count} in all"))),
    }
}

/// The element of a list, or the fault of an index outside.
pub(super) fn pick<'a, T>(list: &'a [T], index: usize, what: &'static str) -> Result<&'a T, Cause> {
    list.get(index).ok_or(Cause::Index { what, index: index as u64, count: list.len() as u64 })
}
