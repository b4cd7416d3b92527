//! Passes over a film: tiles on the threads of the caller's pool, with pause and cancel.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use glam::UVec2;
use rayon::prelude::*;

use super::film::{Film, Rejected, Tile};
use super::{PathSample, View, World};
use crate::job::Handle;
use crate::picture::Picture;

/// Side of a tile in pixels.
const TILE: u32 = 16;

/// How long a paused thread sleeps before it looks again.
const NAP: Duration = Duration::from_millis(2);

/// What a tracing in the background is told, and tells. Clones share it.
#[derive(Clone, Debug, Default)]
pub struct Control {
    handle: Handle,
    paused: Arc<AtomicBool>,
    /// There may be time left in `rest`.
    resting: Arc<AtomicBool>,
    rest: Arc<Mutex<Option<Instant>>>,
    rays: Arc<AtomicU64>,
    /// Paths of the running pass that are done.
    done: Arc<AtomicU64>,
}

/// How a pass ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub enum Pass {
    /// The film holds its samples.
    Whole,
    /// The film is as it was before.
    Cancelled,
}

impl Control {
    /// Ends when the job of `handle` is cancelled; its progress is that of the running pass.
    pub fn of_job(handle: &Handle) -> Control {
        Control { handle: handle.clone(), ..Control::default() }
    }

    /// The job that it ends with.
    pub fn job(&self) -> &Handle {
        &self.handle
    }

    /// Ends the work as soon as the samples that are being traced are done; there is no way back.
    pub fn cancel(&self) {
        self.handle.cancel();
    }

    /// True once the work is to end.
    pub fn is_cancelled(&self) -> bool {
        self.handle.is_cancelled()
    }

    /// Lets the threads rest, or go on.
    pub fn pause(&self, paused: bool) {
        self.paused.store(paused, Ordering::Relaxed);
    }

    /// Lets the threads rest until a moment, from which they go on by themselves. A later call counts instead.
    pub fn rest_until(&self, end: Instant) {
        let mut rest = self.rest.lock().unwrap_or_else(PoisonError::into_inner);
        *rest = Some(end);
        self.resting.store(true, Ordering::Relaxed);
    }

    /// Fraction of the running pass that is done, 0 to 1.
    pub fn progress(&self) -> f32 {
        self.handle.progress()
    }

    /// Rays that were cast, of all passes.
    pub fn rays(&self) -> u64 {
        self.rays.load(Ordering::Relaxed)
    }

    /// Waits while paused or resting; false when the work is to end.
    fn goes_on(&self) -> bool {
        while (self.paused.load(Ordering::Relaxed) || self.rests()) && !self.is_cancelled() {
            std::thread::sleep(NAP);
        }
        !self.is_cancelled()
    }

    fn rests(&self) -> bool {
        if !self.resting.load(Ordering::Relaxed) {
            return false;
        }
        // Under the lock: a rest that is ordered meanwhile is not lost.
        let rest = self.rest.lock().unwrap_or_else(PoisonError::into_inner);
        let over = rest.is_none_or(|end| Instant::now() >= end);
        self.resting.store(!over, Ordering::Relaxed);
        !over
    }

    fn start(&self) {
        self.done.store(0, Ordering::Relaxed);
        self.handle.set_progress(0.0);
    }

    fn count(&self, paths: u64, rays: u64, of: u64) {
        self.rays.fetch_add(rays, Ordering::Relaxed);
        let done = paths + self.done.fetch_add(paths, Ordering::Relaxed);
        self.handle.set_progress(done as f32 / of.max(1) as f32);
    }
}

/// Adds `samples` paths to every pixel of the film, which has the size of the view, on the current rayon pool.
///
/// The film changes only at the end of a whole pass. Its bytes depend on scene, options, view and the number of samples
/// alone: not on the threads, nor on how many passes made them.
pub fn trace(world: &World, view: &View, film: &mut Film, samples: u32, control: &Control) -> Pass {
    debug_assert_eq!(view.size, film.size());
    trace_with(film, samples, control, |pixel, index| world.sample(view, pixel, index))
}

/// [`trace`] with any function of pixel and number of the path.
pub fn trace_with(
    film: &mut Film,
    samples: u32,
    control: &Control,
    sample: impl Fn(UVec2, u32) -> PathSample + Sync,
) -> Pass {
    let size = film.size();
    let paths = u64::from(size.x) * u64::from(size.y) * u64::from(samples);
    control.start();
    let seen = &*film;
    let trace_one = |tile: UVec2| {
        let traced = trace_tile(seen, tile * TILE, samples, control, &sample)?;
        let Traced { tile, rays } = traced;
        control.count(tile.pixels.len() as u64 * u64::from(samples), rays, paths);
        Some(tile)
    };
    let tiles: Option<Vec<Tile>> = grid(size, TILE).into_par_iter().with_max_len(1).map(trace_one).collect();
    match tiles {
        Some(tiles) => {
            film.advance(samples, tiles);
            Pass::Whole
        }
        None => Pass::Cancelled,
    }
}

/// A first look: the first path of the middle pixel of every block of `step` x `step` pixels, one texel each, the last
/// column and row of blocks cut by the edge of the view. `None` when cancelled.
pub fn preview(world: &World, view: &View, step: u32, control: &Control) -> Option<Picture> {
    preview_with(view.size, step, control, |pixel, index| world.sample(view, pixel, index))
}

/// [`preview`] with any function of pixel and number of the path.
pub fn preview_with(
    size: UVec2,
    step: u32,
    control: &Control,
    sample: impl Fn(UVec2, u32) -> PathSample + Sync,
) -> Option<Picture> {
    let step = step.max(1);
    let blocks = UVec2::new(size.x.div_ceil(step), size.y.div_ceil(step));
    let texel = |block: UVec2| {
        let pixel = (block * step + step / 2).min(size.saturating_sub(UVec2::ONE));
        let PathSample { radiance, rays, .. } = control.goes_on().then(|| sample(pixel, 0))?;
        control.rays.fetch_add(u64::from(rays), Ordering::Relaxed);
        let radiance = if radiance.is_finite() { radiance } else { glam::Vec3::ZERO };
        Some(radiance.extend(1.0))
    };
    let texels = grid(blocks, 1).into_par_iter().with_min_len(64).map(texel).collect::<Option<Vec<_>>>()?;
    Some(Picture { width: blocks.x, height: blocks.y, texels })
}

/// Places of all cells of `cell` x `cell` that cover `size`, row by row.
fn grid(size: UVec2, cell: u32) -> Vec<UVec2> {
    let (columns, rows) = (size.x.div_ceil(cell), size.y.div_ceil(cell));
    (0..rows).flat_map(|y| (0..columns).map(move |x| UVec2::new(x, y))).collect()
}

struct Traced {
    tile: Tile,
    rays: u64,
}

/// The pixels of one tile with their next samples; `None` when cancelled.
fn trace_tile(
    film: &Film,
    corner: UVec2,
    samples: u32,
    control: &Control,
    sample: &(impl Fn(UVec2, u32) -> PathSample + Sync),
) -> Option<Traced> {
    let size = film.size();
    let end = (corner + TILE).min(size);
    let (mut pixels, mut rays, mut first_rejected) = (Vec::new(), 0, None::<Rejected>);
    for y in corner.y..end.y {
        for x in corner.x..end.x {
            let at = UVec2::new(x, y);
            let mut pixel = film.pixels()[(y * size.x + x) as usize];
            for index in film.samples()..film.samples() + samples {
                if !control.goes_on() {
                    return None;
                }
                let path = sample(at, index);
                rays += u64::from(path.rays);
                if !pixel.add(&path) && first_rejected.is_none_or(|first| index < first.sample) {
                    first_rejected = Some(Rejected { sample: index, pixel: at });
                }
            }
            pixels.push(pixel);
        }
    }
    Some(Traced { tile: Tile { corner, width: end.x - corner.x, pixels, first_rejected }, rays })
}

#[cfg(test)]
#[path = "passes_tests.rs"]
mod tests;
