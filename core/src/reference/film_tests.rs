use glam::Vec3;

use super::*;

fn sample(radiance: Vec3) -> PathSample {
    PathSample { radiance, clamped: Vec3::ZERO, first: None, rays: 1 }
}

fn film_of(pixels: &[&[Vec3]]) -> Film {
    let added = |samples: &&[Vec3]| {
        let mut pixel = Pixel::default();
        samples.iter().for_each(|s| _ = pixel.add(&sample(*s)));
        pixel
    };
    let samples = pixels[0].len() as u32;
    let first = pixels.iter().flat_map(|p| p.iter()).any(|s| !s.is_finite());
    let first = first.then_some(Rejected { sample: 0, pixel: UVec2::ZERO });
    let size = UVec2::new(pixels.len() as u32, 1);
    Film::from_parts(size, samples, pixels.iter().map(added).collect(), first).unwrap()
}

#[test]
fn mean_and_variance_are_those_of_the_samples_even_far_from_zero() {
    // Deviations of 1e-3 about 1e4: sums of squares would lose them in f32 and half of their digits in f64.
    let values: Vec<f64> = (0..1000).map(|i| 1e4 + f64::from((i * 37 % 101) as f32) * 1e-2).collect();
    let mut pixel = Pixel::default();
    for v in &values {
        assert!(pixel.add(&sample(Vec3::splat(*v as f32))));
    }
    let stored: Vec<f64> = values.iter().map(|v| f64::from(*v as f32)).collect();
    let mean = stored.iter().sum::<f64>() / 1000.0;
    let variance = stored.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 999.0 / 1000.0;
    assert!((pixel.mean.x - mean).abs() < 1e-9, "{} {mean}", pixel.mean.x);
    assert!((pixel.variance().y / variance - 1.0).abs() < 1e-9, "{} {variance}", pixel.variance().y);
}

#[test]
fn a_sample_that_is_not_finite_is_counted_and_changes_nothing_else() {
    let mut pixel = Pixel::default();
    pixel.add(&sample(Vec3::ONE));
    let before = pixel;
    let hit = FirstHit { normal: Vec3::NAN, albedo: Vec3::ONE, instance: 0, material: 0 };
    let bad = [
        sample(Vec3::new(0.0, f32::NAN, 0.0)),
        sample(Vec3::new(0.0, 0.0, f32::INFINITY)),
        PathSample { clamped: Vec3::NEG_INFINITY, ..sample(Vec3::ONE) },
        PathSample { first: Some(hit), ..sample(Vec3::ONE) },
    ];
    for bad in &bad {
        assert!(!pixel.add(bad));
    }
    assert_eq!(pixel, Pixel { rejected: 4, ..before });
}

#[test]
fn surfaces_are_averaged_over_all_samples_and_named_by_the_first() {
    let hit = |instance, normal| {
        let first = Some(FirstHit { normal, albedo: Vec3::splat(0.5), instance, material: 10 * instance });
        PathSample { first, ..sample(Vec3::ONE) }
    };
    let mut pixel = Pixel::default();
    for s in [sample(Vec3::ONE), hit(3, Vec3::X), hit(4, Vec3::Y), sample(Vec3::ONE)] {
        pixel.add(&s);
    }
    assert_eq!((pixel.instance, pixel.material, pixel.coverage()), (3, 30, 0.5));
    assert_eq!(pixel.mean_normal(), DVec3::new(0.25, 0.25, 0.0));
    assert_eq!(pixel.mean_albedo(), DVec3::splat(0.25));
    assert_eq!(Pixel::default().instance, NOTHING);
}

#[test]
fn the_error_is_the_root_of_the_expected_relative_square() {
    // Samples 0 and 2: mean 1, variance of the mean 1. The other pixel has none.
    let film = film_of(&[&[Vec3::ZERO, Vec3::splat(2.0)], &[Vec3::ONE, Vec3::ONE]]);
    assert!((film.error() - (0.5_f64 / 1.01).sqrt()).abs() < 1e-12, "{}", film.error());
    assert_eq!(film_of(&[&[Vec3::ONE]]).error(), f64::INFINITY);
    // A pixel without two finite samples says nothing.
    let broken = film_of(&[&[Vec3::ZERO, Vec3::splat(2.0)], &[Vec3::NAN, Vec3::ONE]]);
    assert!((broken.error() - (1.0_f64 / 1.01).sqrt()).abs() < 1e-12, "{}", broken.error());
    assert_eq!(broken.rejected(), 1);
}

#[test]
fn the_error_foretells_what_independent_pictures_differ_by() {
    // Two halves of 1e4 uniform samples in 64 pixels; the squared difference is twice the variance of each.
    let mut random = crate::math::sampling::Random::new(5);
    let mut half = || {
        let pixel = |_| {
            let mut pixel = Pixel::default();
            (0..1000).for_each(|_| _ = pixel.add(&sample(Vec3::splat(random.point2().x))));
            pixel
        };
        Film::from_parts(UVec2::new(64, 1), 1000, (0..64).map(pixel).collect(), None).unwrap()
    };
    let (a, b) = (half(), half());
    let difference = |(a, b): (&Pixel, &Pixel)| (a.mean.x - b.mean.x).powi(2) / (a.mean.x.powi(2) + 0.01) / 2.0;
    let found = (a.pixels().iter().zip(b.pixels()).map(difference).sum::<f64>() / 64.0).sqrt();
    // 64 squares of a normal number: their mean scatters by 18 %, its root by 9 %.
    assert!((found / a.error() - 1.0).abs() < 0.27, "{found} {}", a.error());
}

#[test]
fn the_clamped_share_is_that_of_the_whole() {
    let mut pixel = Pixel::default();
    pixel.add(&PathSample { clamped: Vec3::new(1.0, 1.0, 0.0), ..sample(Vec3::splat(2.0)) });
    let film = Film::from_parts(UVec2::ONE, 1, vec![pixel], None).unwrap();
    assert_eq!(film.clamped_share(), 0.25);
    assert_eq!(Film::new(UVec2::ONE).clamped_share(), 0.0);
}

#[test]
fn parts_that_do_not_fit_make_no_film() {
    let pixel = Pixel { count: 2, ..Pixel::default() };
    let make = |samples, pixels: Vec<Pixel>, rejected| Film::from_parts(UVec2::ONE, samples, pixels, rejected);
    let rejected = Some(Rejected { sample: 0, pixel: UVec2::ZERO });
    assert!(make(2, vec![pixel], None).is_some());
    assert!(make(3, vec![pixel], None).is_none());
    assert!(make(2, vec![pixel; 2], None).is_none());
    assert!(make(2, vec![pixel], rejected).is_none());
    assert!(make(2, vec![Pixel { hits: 3, ..pixel }], None).is_none());
    assert!(make(2, vec![Pixel { mean: DVec3::NAN, ..pixel }], None).is_none());
    assert!(make(0, vec![Pixel { count: u32::MAX, rejected: 1, ..pixel }], rejected).is_none());
}
