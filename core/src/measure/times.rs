//! How long the processor takes to evaluate reflectance curves.

use std::hint::black_box;
use std::time::Instant;

use crate::surface::fresnel::Fresnel;

/// Angles of a batch: with its results it fits into the first cache.
const BATCH: usize = 1024;
/// Batches that are timed together.
const BATCHES: usize = 16;

/// Seconds that each curve takes for the three channels at one angle in batches of 1024, on one thread.
///
/// The curves take turns, so that a busy machine slows all alike; the median of the rounds counts, at least one. A round
/// of a curve takes a few tenths of a millisecond.
pub fn evaluation_times(curves: &[Fresnel], rounds: usize) -> Vec<f64> {
    let cosines: Vec<f32> = (0..BATCH).map(|i| (i as f32 + 0.5) / BATCH as f32).collect();
    let mut out = [(); 3].map(|()| vec![0.0; BATCH]);
    let mut times = vec![Vec::new(); curves.len()];
    for _ in 0..rounds.max(1) {
        for (curve, times) in curves.iter().zip(&mut times) {
            let start = Instant::now();
            for _ in 0..BATCHES {
                black_box(curve).eval_batch(black_box(&cosines), out.each_mut().map(Vec::as_mut_slice));
                black_box(&mut out);
            }
            times.push(start.elapsed().as_secs_f64() / (BATCH * BATCHES) as f64);
        }
    }
    times.iter_mut().map(|times| median(times)).collect()
}

/// The middle value, of an even number the upper one; not a number where there is none.
pub fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
