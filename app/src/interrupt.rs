//! Ctrl-C and a polite kill: long work ends in order instead of at once.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

use crate::failure::Exit;

static ARMED: AtomicBool = AtomicBool::new(false);

/// Allows commands to catch signals. Only the program itself does so: in process they belong to the caller.
pub fn arm() {
    ARMED.store(true, Ordering::Relaxed);
}

/// A flag that the first signal raises, from now on; the second ends the program at once. Never raised unless
/// [`arm`] was called.
pub(crate) fn watch() -> io::Result<Arc<AtomicBool>> {
    let raised = Arc::new(AtomicBool::new(false));
    if ARMED.load(Ordering::Relaxed) {
        for signal in [SIGINT, SIGTERM] {
            // In this order: the first signal finds the flag down.
            flag::register_conditional_shutdown(signal, Exit::Cancelled as i32, raised.clone())?;
            flag::register(signal, raised.clone())?;
        }
    }
    Ok(raised)
}

/// Time between two looks.
const LOOK: Duration = Duration::from_millis(20);

/// Does `work` on another thread and calls `look` again and again until it is done.
pub(crate) fn meanwhile<T: Send>(mut look: impl FnMut(), work: impl FnOnce() -> T + Send) -> T {
    std::thread::scope(|scope| {
        let work = scope.spawn(work);
        while !work.is_finished() {
            look();
            std::thread::sleep(LOOK);
        }
        work.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}
