//! Threads for long work beside the window.

/// Builds a pool of all cores but one, which is left for the window.
pub fn builder() -> rayon::ThreadPoolBuilder {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    rayon::ThreadPoolBuilder::new().num_threads(cores.saturating_sub(1).max(1))
}

/// Works on such a pool; on all threads that there are where no more can be started.
pub fn install<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    match builder().build() {
        Ok(pool) => pool.install(work),
        Err(_) => work(),
    }
}
