use glam::Vec4;

use super::*;
use crate::color::difference::ciede2000;
use crate::color::lab::lab_from_rgb;
use crate::color::rgb::linear_from_srgb;

fn grey(values: &[f32]) -> Picture {
    Picture::from_fn(values.len() as u32, 1, |x, _| {
        Vec4::new(values[x as usize], values[x as usize], values[x as usize], 1.0)
    })
}

#[test]
fn bands_rise_in_lightness_and_neighbours_are_told_apart() {
    let lab = |band: &Band| lab_from_rgb(linear_from_srgb(band.color).as_dvec3());
    for pair in BANDS.windows(2) {
        assert!(pair[0].from_stops < pair[1].from_stops);
        let (a, b) = (lab(&pair[0]), lab(&pair[1]));
        assert!(b.x > a.x + 2.0, "{} is not darker than {}: {} {}", pair[0].label, pair[1].label, a.x, b.x);
        // 1 is just noticeable side by side.
        assert!(ciede2000(a, b) > 4.0, "{} looks like {}: {}", pair[0].label, pair[1].label, ciede2000(a, b));
    }
}

#[test]
fn stops_are_counted_from_middle_grey() {
    let of = |stops: f32| false_color(MIDDLE_GREY * stops.exp2());
    assert_eq!(of(0.0), BANDS[7].color);
    assert_eq!(of(0.49), BANDS[7].color);
    assert_eq!(of(1.5), BANDS[9].color);
    assert_eq!(of(40.0), BANDS[12].color);
    assert_eq!(of(-40.0), BANDS[0].color);
    for dark in [0.0, -1.0, f32::NAN] {
        assert_eq!(false_color(dark), BANDS[0].color);
    }
    assert_eq!(false_color(f32::INFINITY), BANDS[12].color);
}

#[test]
fn marks_are_where_8_bits_end() {
    let mark = |r: f32, g: f32, b: f32| Clipping::of(Vec3::new(r, g, b)).mark();
    assert_eq!(mark(1.0, 1.0, 1.0), Some(OVER_ALL));
    assert_eq!(mark(1.0, 0.5, 0.0), Some(OVER_SOME));
    assert_eq!(mark(0.0, 0.001, 0.0), Some(UNDER_ALL));
    assert_eq!(mark(0.5, 0.5, 0.0), Some(UNDER_SOME));
    assert_eq!(mark(0.5, 0.99, 0.01), None);
    let shares = clipped_shares(&grey(&[0.0, 0.2, 0.5, 4.0]), ToneMap::None, 0.0);
    assert_eq!(shares, ClippedShares { over_some: 0.25, over_all: 0.25, under_some: 0.25, under_all: 0.25 });
    assert_eq!(clipped_shares(&Picture::default(), ToneMap::None, 0.0), ClippedShares::default());
}

#[test]
fn a_histogram_counts_every_pixel_once_in_its_stop() {
    let values = [0.18, 0.18 * 1.999, 0.36, 0.0, -1.0, f32::NAN, 0.18 * 4097.0, f32::INFINITY, 0.09];
    let found = histogram(&grey(&values), 0.0, 1);
    let at = |stops: f32| (0..found.luminance.bins.len()).find(|b| found.stops(*b) == stops).unwrap();
    for counts in [&found.luminance, &found.channels[0], &found.channels[2]] {
        assert_eq!((counts.bins[at(0.0)], counts.bins[at(1.0)], counts.bins[at(-1.0)]), (2, 1, 1));
        assert_eq!((counts.under, counts.over), (3, 2));
        assert_eq!(counts.bins.iter().sum::<u64>() + counts.under + counts.over, found.pixels);
    }
    assert_eq!(found.shares_outside(), (3.0 / 9.0, 2.0 / 9.0));
    // One stop up.
    assert_eq!(histogram(&grey(&[0.18]), 1.0, 4).luminance.bins[13 * 4], 1);
}

#[test]
fn a_waveform_has_the_levels_of_each_column() {
    let ramp = Picture::from_fn(8, 2, |x, y| Vec4::new(x as f32 / 7.0, y as f32, 0.0, 1.0));
    let found = waveform(&ramp, ToneMap::None, 0.0, 4, 16);
    assert_eq!((found.columns, found.levels), (4, 16));
    for column in 0..4 {
        for kind in 0..4 {
            assert_eq!((0..16).map(|level| found.count(kind, column, level)).sum::<u32>(), 4, "{kind} {column}");
        }
    }
    assert_eq!((found.count(1, 0, 0), found.count(1, 3, 15), found.count(2, 2, 15)), (2, 2, 2));
    assert_eq!(found.count(1, 9, 0) + found.count(9, 0, 0), 0);
    assert_eq!(waveform(&ramp, ToneMap::None, 0.0, 99, 1).columns, 8);
}

#[test]
fn modes_have_names_and_show_what_they_say() {
    for mode in DisplayMode::ALL {
        assert_eq!(mode.id().parse(), Ok(mode));
    }
    assert!("x".parse::<DisplayMode>().is_err());
    let bright = grey(&[0.18, 9.0]);
    let shown = displayed(&bright, DisplayMode::Clipping, ToneMap::None, 0.0);
    assert!((shown.texels[0].x - 0.18).abs() < 1e-4);
    assert!((shown.texels[1].truncate() - linear_from_srgb(OVER_ALL)).length() < 1e-6);
}
