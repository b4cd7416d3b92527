//! A fence around foreign decoders.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::Cause;

/// Runs a decoder of another crate; a panic in it becomes a fault of the file. For example `exr` 1.74.2 overflows on
/// B44 data whose tiles are wider than the picture. The decoder must work on this thread: a panic on a thread of a
/// pool of its own would end the process.
pub(super) fn guarded<T>(decode: impl FnOnce() -> Result<T, Cause>) -> Result<T, Cause> {
    // What the decoder borrows is only read, and what it built is dropped with it.
    catch_unwind(AssertUnwindSafe(decode))
        .unwrap_or_else(|_| Err(Cause::Syntax("the decoder failed on the content".into())))
}
