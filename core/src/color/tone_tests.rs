use super::*;

/// 0, and 1e-6 to 1e6 in small steps.
fn greys() -> impl Iterator<Item = f32> {
    std::iter::once(0.0).chain((0..=2400).map(|i| 10f32.powf(-6.0 + i as f32 * 0.005)))
}

fn grey(kind: ToneMap, x: f32) -> f32 {
    tone_display_linear(kind, Vec3::splat(x)).x
}

#[test]
fn ids_are_read_back_and_numbers_are_those_of_the_shader() {
    for (number, tone) in ToneMap::ALL.into_iter().enumerate() {
        assert_eq!(tone.id().parse(), Ok(tone));
        assert_eq!(tone.number() as usize, number);
    }
    let error = "filmic".parse::<ToneMap>().unwrap_err().to_string();
    assert!(error.contains("filmic") && error.contains("neutral"), "{error}");
    for (name, value) in [("NONE", TONE_NONE), ("NEUTRAL", TONE_NEUTRAL), ("AGX", TONE_AGX), ("ACES", TONE_ACES)] {
        assert!(LEAF.source.contains(&format!("const TONE_{name}: u32 = {value}u;")));
    }
}

#[test]
fn every_view_is_finite_and_within_the_screen_for_any_input() {
    let values =
        [f32::NEG_INFINITY, -1e30, -1.0, 0.0, 1e-40, 1e-4, 0.18, 0.8, 1.0, 1e4, f32::MAX, f32::INFINITY, f32::NAN];
    for tone in ToneMap::ALL {
        for r in values {
            for g in values {
                for b in values {
                    let out = tone_map(tone, Vec3::new(r, g, b));
                    assert!(
                        out.is_finite() && out.min_element() >= 0.0 && out.max_element() <= 1.0,
                        "{tone:?} {r} {g} {b}"
                    );
                }
            }
        }
    }
}

#[test]
fn brighter_grey_never_looks_darker() {
    for tone in ToneMap::ALL {
        let mut last = 0.0;
        for x in greys() {
            let y = grey(tone, x);
            // f32 rounding of the curves.
            assert!(y >= last - 1e-6, "{tone:?} at {x}: {y} after {last}");
            last = y;
        }
    }
}

#[test]
fn grey_stays_grey() {
    for tone in ToneMap::ALL {
        // The published ACES matrices have five decimals, so that their rows sum to 1 within 1e-5.
        let tolerance = if tone == ToneMap::Aces { 3e-5 } else { 2e-6 };
        for x in greys() {
            let out = tone_display_linear(tone, Vec3::splat(x));
            assert!(out.max_element() - out.min_element() < tolerance, "{tone:?} at {x}: {out}");
        }
    }
}

#[test]
fn black_is_black_and_strong_light_is_white() {
    for tone in ToneMap::ALL {
        assert!(grey(tone, 0.0) < 1e-6, "{tone:?}");
        assert!(grey(tone, 1e6) > 0.999, "{tone:?}");
    }
}

#[test]
fn none_is_the_srgb_encoding_alone() {
    let x = Vec3::new(0.1, 0.5, 2.0);
    assert_eq!(tone_map(ToneMap::None, x), srgb_from_linear(x));
}

#[test]
fn neutral_takes_off_exactly_0_04_between_0_08_and_0_8() {
    // The specification's own statement of what is kept.
    for x in [Vec3::new(0.08, 0.3, 0.8), Vec3::splat(0.5), Vec3::new(0.79, 0.1, 0.2)] {
        let shown = tone_display_linear(ToneMap::Neutral, x);
        assert!((shown - (x - 0.04)).abs().max_element() < 1e-6, "{x} {shown}");
    }
}

#[test]
fn neutral_shows_the_toe_and_the_shoulder_of_its_equations() {
    // Below 0.08: x - (x - 6.25 x^2) = 6.25 x^2.
    assert!((grey(ToneMap::Neutral, 0.04) - 0.01).abs() < 1e-7);
    // Peak 1.04 - 0.04 = 1: 1 - 0.24^2 / (1 + 0.24 - 0.76) = 0.88.
    assert!((grey(ToneMap::Neutral, 1.04) - 0.88).abs() < 1e-6);
    // A saturated red of peak 4: new peak p, white share g as in the specification.
    let p = 1.0 - 0.0576 / 3.48;
    let g = 1.0 - 1.0 / (0.15 * (4.0 - p) + 1.0);
    let shown = tone_display_linear(ToneMap::Neutral, Vec3::new(4.0, 0.0, 0.0));
    assert!((shown - Vec3::new(p, g * p, g * p)).abs().max_element() < 1e-6, "{shown}");
}

#[test]
fn agx_puts_middle_grey_at_half_of_its_code_values() {
    // Code value 1/2 on a screen of exponent 2.2.
    assert!((grey(ToneMap::AgX, 0.18) - 0.5f32.powf(2.2)).abs() < 1e-5);
    // 6.5 stops above, white; 10 below, black.
    assert!((grey(ToneMap::AgX, 0.18 * 6.5f32.exp2()) - 1.0).abs() < 1e-5);
    assert!(grey(ToneMap::AgX, 0.18 * (-10f32).exp2()) < 1e-5);
}

#[test]
fn the_agx_curve_is_the_one_that_the_published_polynomial_fits() {
    for i in 0..=1000 {
        let x = i as f32 / 1000.0;
        let light = 0.18 * (x * 16.5 - 10.0).exp2();
        // Wrensch 2023, Minimal AgX Implementation, the fit of sixth order. It leaves the curve by at most 0.0058.
        let fit = ((((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x) + 0.1191) * x - 0.002_32;
        assert!((agx_curve(light) - fit).abs() < 0.006, "{x}");
    }
}

#[test]
fn the_agx_outset_undoes_the_inset_and_both_keep_grey() {
    let identity = AGX_OUTSET * AGX_INSET;
    for c in 0..3 {
        assert!((identity.col(c) - Mat3::IDENTITY.col(c)).abs().max_element() < 1e-6);
    }
    assert!((AGX_INSET * Vec3::ONE - Vec3::ONE).abs().max_element() < 2e-7);
    // Within 1.4e-4 of the published matrix (red row).
    assert!((AGX_INSET.row(0) - Vec3::new(0.842_479_06, 0.078_433_6, 0.079_223_745)).abs().max_element() < 1.4e-4);
}

#[test]
fn the_aces_fit_shows_its_known_values() {
    // The rational function by hand: grey enters both matrices unchanged.
    let fit = |v: f32| (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.432951) + 0.238081);
    for x in [0.02, 0.18, 1.0, 4.0] {
        assert!((grey(ToneMap::Aces, x) - fit(x)).abs() < 2e-5, "{x}");
    }
    assert!((grey(ToneMap::Aces, 0.18) - 0.1056).abs() < 1e-4);
}

#[test]
fn one_ev_doubles() {
    assert_eq!((exposure_factor(0.0), exposure_factor(1.0), exposure_factor(-2.0)), (1.0, 2.0, 0.25));
}
