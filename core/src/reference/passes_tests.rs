use glam::Vec3;

use super::*;
use crate::reference::FirstHit;

/// A path of any function: bright, dark, here and there without a surface.
fn path(pixel: UVec2, index: u32) -> PathSample {
    let mixed =
        (pixel.x.wrapping_mul(0x9E37_79B9) ^ pixel.y.wrapping_mul(0x85EB_CA6B) ^ index.wrapping_mul(0xC2B2_AE35))
            .wrapping_mul(0x27D4_EB2F);
    let u = mixed as f32 / u32::MAX as f32;
    let hit = FirstHit {
        normal: Vec3::new(u, 1.0 - u, 0.0),
        albedo: Vec3::splat(u),
        instance: mixed % 7,
        material: mixed % 3,
    };
    PathSample { radiance: Vec3::new(u, u * u, 3.0), clamped: Vec3::ZERO, first: (u > 0.3).then_some(hit), rays: 2 }
}

fn traced(size: UVec2, passes: &[u32], threads: usize) -> Film {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let mut film = Film::new(size);
    for samples in passes {
        let pass = pool.install(|| trace_with(&mut film, *samples, &Control::default(), path));
        assert_eq!(pass, Pass::Whole);
    }
    film
}

#[test]
fn threads_and_the_length_of_passes_do_not_change_a_film() {
    // Neither side is a multiple of the tile's.
    let size = UVec2::new(37, 21);
    let film = traced(size, &[12], 1);
    assert_eq!(film.samples(), 12);
    assert!(film.pixels().iter().all(|pixel| pixel.count == 12));
    for (passes, threads) in [(&[12_u32][..], 2), (&[12], 7), (&[1, 1, 2, 8], 3), (&[5, 7], 1)] {
        assert!(traced(size, passes, threads) == film, "{passes:?} on {threads}");
    }
    // Each pixel holds its own samples.
    let mut one = super::super::Pixel::default();
    (0..12).for_each(|index| _ = one.add(&path(UVec2::new(36, 20), index)));
    assert_eq!(film.pixels().last(), Some(&one));
}

#[test]
fn a_cancelled_pass_leaves_the_film_as_it_was() {
    let mut film = traced(UVec2::splat(40), &[3], 2);
    let before = film.clone();
    let control = Control::default();
    let stopping = |pixel: UVec2, index| {
        if pixel == UVec2::new(20, 20) {
            control.cancel();
        }
        path(pixel, index)
    };
    assert_eq!(trace_with(&mut film, 5, &control, stopping), Pass::Cancelled);
    assert!(film == before);
    assert_eq!(trace_with(&mut film, 5, &control, path), Pass::Cancelled, "there is no way back");
    assert_eq!(trace_with(&mut film, 5, &Control::default(), path), Pass::Whole);
    assert!(film == traced(UVec2::splat(40), &[8], 1));
}

#[test]
fn progress_and_rays_are_counted() {
    let control = Control::default();
    let mut film = Film::new(UVec2::new(33, 17));
    assert_eq!(trace_with(&mut film, 3, &control, path), Pass::Whole);
    assert_eq!((control.progress(), control.rays()), (1.0, 2 * 3 * 33 * 17));
    assert_eq!(trace_with(&mut film, 1, &control, path), Pass::Whole);
    assert_eq!(control.rays(), 2 * 4 * 33 * 17);
}

#[test]
fn a_paused_pass_waits_and_goes_on_and_a_cancel_ends_the_wait() {
    let (control, traced) = (Control::default(), AtomicU64::new(0));
    let counting = |pixel: UVec2, index| {
        // The first path pauses all that follow.
        control.pause(traced.fetch_add(1, Ordering::SeqCst) == 0);
        path(pixel, index)
    };
    std::thread::scope(|scope| {
        let pass = scope.spawn(|| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
            pool.install(|| trace_with(&mut Film::new(UVec2::splat(4)), 1, &control, counting))
        });
        while traced.load(Ordering::SeqCst) == 0 {
            std::thread::yield_now();
        }
        // As long as ten naps, in which an unpaused pass would be over.
        std::thread::sleep(10 * NAP);
        assert_eq!(traced.load(Ordering::SeqCst), 1);
        control.pause(false);
        assert_eq!(pass.join().unwrap(), Pass::Whole);
        assert_eq!(traced.load(Ordering::SeqCst), 16);

        control.pause(true);
        let waiting = scope.spawn(|| trace_with(&mut Film::new(UVec2::splat(4)), 1, &control, path));
        control.cancel();
        assert_eq!(waiting.join().unwrap(), Pass::Cancelled);
    });
}

#[test]
fn a_resting_pass_goes_on_by_itself_and_the_last_order_counts() {
    let control = Control::default();
    let (start, rest) = (Instant::now(), 20 * NAP);
    control.rest_until(start + Duration::from_secs(600));
    control.rest_until(start + rest);
    assert_eq!(trace_with(&mut Film::new(UVec2::splat(4)), 1, &control, path), Pass::Whole);
    assert!(start.elapsed() >= rest, "{:?}", start.elapsed());
    control.rest_until(Instant::now() + Duration::from_secs(600));
    std::thread::scope(|scope| {
        let resting = scope.spawn(|| trace_with(&mut Film::new(UVec2::splat(4)), 1, &control, path));
        control.cancel();
        assert_eq!(resting.join().unwrap(), Pass::Cancelled);
    });
}

#[test]
fn the_first_sample_that_is_not_finite_is_named_whatever_thread_found_it() {
    let bad = [(UVec2::new(30, 30), 1), (UVec2::new(31, 2), 1), (UVec2::new(3, 3), 2)];
    let broken = |pixel: UVec2, index| {
        let mut sample = path(pixel, index);
        if bad.contains(&(pixel, index)) {
            sample.radiance.y = f32::NAN;
        }
        sample
    };
    for passes in [&[4_u32][..], &[2, 2], &[1, 1, 1, 1]] {
        let mut film = Film::new(UVec2::splat(32));
        for samples in passes {
            assert_eq!(trace_with(&mut film, *samples, &Control::default(), broken), Pass::Whole);
        }
        assert_eq!(film.rejected(), 3);
        assert_eq!(film.first_rejected(), Some(Rejected { sample: 1, pixel: UVec2::new(31, 2) }));
        assert!(film.picture().texels.iter().all(|t| t.is_finite()));
    }
}
