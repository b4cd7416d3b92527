use glam::Vec4;

use super::*;

fn flat(value: f32) -> Picture {
    Picture::filled(32, 24, Vec4::new(value, value, value, 1.0))
}

/// A smooth picture with an edge.
fn scene() -> Picture {
    Picture::from_fn(48, 32, |x, y| {
        let edge = if x > 20 { 0.6 } else { 0.1 };
        Vec4::new(edge, 0.02 * y as f32, 0.3, 1.0)
    })
}

fn mean_flip(a: &Picture, b: &Picture) -> f64 {
    flip(a, b, 0.0, PIXELS_PER_DEGREE).unwrap().mean
}

#[test]
fn a_picture_is_no_distance_from_itself() {
    let a = scene();
    assert_eq!(relmse(&a, &a), Ok(0.0));
    assert_eq!(luminance_bias(&a, &a), Ok(0.0));
    let error = flip(&a, &a, 0.0, PIXELS_PER_DEGREE).unwrap();
    assert_eq!((error.mean, error.width, error.height, error.map.len()), (0.0, 48, 32, 48 * 32));
}

#[test]
fn relmse_of_a_known_shift_is_its_formula() {
    // (0.6 - 0.5)^2 / (0.5^2 + 0.01); 0.6 in f32 is off by 2.4e-8.
    let found = relmse(&flat(0.5), &flat(0.6)).unwrap();
    assert!((found - 0.01 / 0.26).abs() < 2e-8, "{found}");
    // Where the reference is black the epsilon alone divides.
    assert!((relmse(&flat(0.0), &flat(0.1)).unwrap() - 1.0).abs() < 1e-6);
    // One channel of one pixel.
    let mut other = flat(0.5);
    other.texels[9].y += 0.26;
    let found = relmse(&flat(0.5), &other).unwrap();
    assert!((found - 0.26 / (3.0 * 32.0 * 24.0)).abs() < 1e-8, "{found}");
}

#[test]
fn bias_is_signed_and_relative_to_the_reference() {
    assert!((luminance_bias(&flat(0.5), &flat(0.55)).unwrap() - 0.1).abs() < 1e-6);
    assert!((luminance_bias(&flat(0.5), &flat(0.25)).unwrap() + 0.5).abs() < 1e-6);
    // Green counts by its share of luminance.
    let mut green = flat(0.5);
    green.texels.iter_mut().for_each(|t| t.y = 1.0);
    assert!((luminance_bias(&flat(0.5), &green).unwrap() - 0.7152).abs() < 1e-5);
    assert_eq!(luminance_bias(&flat(0.0), &flat(0.1)), Err(MeasureError::Black));
}

#[test]
fn flip_between_black_and_white_is_nearly_one_everywhere() {
    let error = flip(&flat(0.0), &flat(1.0), 0.0, PIXELS_PER_DEGREE).unwrap();
    // The published colour pipeline maps the largest difference of all, green to blue, to 1.
    assert!(error.mean > 0.9 && error.mean <= 1.0, "{}", error.mean);
    let color = |r, g, b| Picture::filled(32, 24, Vec4::new(r, g, b, 1.0));
    let largest = mean_flip(&color(0.0, 1.0, 0.0), &color(0.0, 0.0, 1.0));
    assert!((largest - 1.0).abs() < 2e-3 && largest > error.mean, "{largest} {}", error.mean);
    // No features in flat pictures: the map is flat but for rounding of the filters.
    assert!(error.map.iter().all(|e| (f64::from(*e) - error.mean).abs() < 1e-3));
}

#[test]
fn flip_grows_with_the_difference_and_does_not_mind_the_order() {
    let a = scene();
    let shifted =
        |by: f32| Picture { texels: a.texels.iter().map(|t| *t + Vec4::new(by, by, by, 0.0)).collect(), ..a.clone() };
    let (small, large) = (shifted(0.02), shifted(0.2));
    assert!(0.0 < mean_flip(&a, &small) && mean_flip(&a, &small) < mean_flip(&a, &large));
    // f32 sums in another order.
    assert!((mean_flip(&a, &large) - mean_flip(&large, &a)).abs() < 1e-6);
}

#[test]
fn flip_sees_what_the_screen_shows_at_the_exposure() {
    // Both are white on the screen at 0 EV, but not two stops below.
    assert_eq!(mean_flip(&flat(1.5), &flat(3.0)), 0.0);
    assert!(flip(&flat(1.5), &flat(3.0), -2.0, PIXELS_PER_DEGREE).unwrap().mean > 0.05);
}

#[test]
fn fine_noise_is_seen_less_from_afar() {
    let noisy = Picture::from_fn(48, 32, |x, y| {
        let v = if (x + y) % 2 == 0 { 0.4 } else { 0.6 };
        Vec4::new(v, v, v, 1.0)
    });
    let flat = Picture::filled(48, 32, Vec4::new(0.5, 0.5, 0.5, 1.0));
    let at = |ppd: f32| flip(&flat, &noisy, 0.0, ppd).unwrap().mean;
    assert!(at(20.0) > 5.0 * at(67.0), "{} {}", at(20.0), at(67.0));
}

#[test]
fn the_error_map_is_painted_from_black_to_pale_yellow() {
    let error = FlipError { mean: 0.5, width: 3, height: 1, map: vec![0.0, 1.0, f32::NAN] };
    let picture = error.picture();
    assert!(picture.is_whole());
    let srgb = |i: usize| 255.0 * crate::color::rgb::srgb_from_linear(picture.texels[i].truncate());
    // Ends of matplotlib's magma: (0, 0, 3) and (251, 252, 191).
    assert!((srgb(0) - Vec3::new(0.0, 0.0, 3.0)).abs().max_element() < 1.5, "{}", srgb(0));
    assert!((srgb(1) - Vec3::new(251.0, 252.0, 191.0)).abs().max_element() < 1.5, "{}", srgb(1));
    assert_eq!(srgb(2), srgb(0));
}

#[test]
fn pictures_as_small_as_one_pixel_are_compared() {
    let pixel = |v: f32| Picture::filled(1, 1, Vec4::new(v, v, v, 1.0));
    assert_eq!(mean_flip(&pixel(0.3), &pixel(0.3)), 0.0);
    assert!(mean_flip(&pixel(0.0), &pixel(1.0)) > 0.9);
}

#[test]
fn what_cannot_be_compared_is_refused_in_words() {
    let small = Picture::filled(8, 8, Vec4::ONE);
    let error = relmse(&flat(0.5), &small).unwrap_err().to_string();
    assert!(error.contains("32 x 24") && error.contains("8 x 8"), "{error}");
    let mut broken = flat(0.5);
    broken.texels[32 * 3 + 5].x = f32::NAN;
    broken.texels[32 * 4 + 1].z = f32::INFINITY;
    let error = flip(&flat(0.5), &broken, 0.0, PIXELS_PER_DEGREE).unwrap_err().to_string();
    assert!(error.contains("2 pixels of the picture") && error.contains("column 5, row 3"), "{error}");
    assert!(relmse(&broken, &flat(0.5)).unwrap_err().to_string().contains("of the reference"));
    assert!(relmse(&Picture::default(), &Picture::default()).is_err());
    assert!(flip(&small, &small, 0.0, f32::NAN).is_err());
}
