//! A picture of the CPU on a screen, against the display transform of the CPU.

use std::sync::Arc;

use burnish_core::color::tone::{ToneMap, exposure_factor, tone_map};
use burnish_core::measure::view::{DisplayMode, displayed};
use burnish_core::picture::Picture;
use burnish_render::readback::read_texture;
use burnish_render::{Display, Gpu, Passes, Plate, RenderError};
use burnish_tests::{Need, trial};
use glam::Vec4;
use libtest_mimic::Trial;

pub fn trials() -> Vec<Trial> {
    vec![trial("a picture of the CPU is shown through the display transform", &[Need::Gpu], shown)]
}

fn picture(width: u32, height: u32, factor: f32) -> Arc<Picture> {
    // From shadow to a sun.
    let texel = |x: u32, y: u32| (factor * Vec4::new(x as f32, y as f32 * y as f32, 1e-3, 0.0).exp2()).with_w(1.0);
    Arc::new(Picture::from_fn(width, height, texel))
}

fn assert_shows(gpu: &Gpu, plate: &Plate, picture: &Picture, (tone, exposure_ev): (ToneMap, f32)) {
    let output = plate.output().expect("a picture").texture();
    assert_eq!((output.width(), output.height()), (picture.width, picture.height));
    let bytes = read_texture(gpu, output, 0, 0).unwrap_or_else(|e| panic!("{e}"));
    let factor = exposure_factor(exposure_ev);
    for (shown, texel) in bytes.as_chunks::<4>().0.iter().zip(&picture.texels) {
        let expected = tone_map(tone, factor * texel.truncate()).to_array().map(|v| v * 255.0);
        for (shown, expected) in shown.iter().zip(expected) {
            // Rounding to a byte.
            assert!((f32::from(*shown) - expected).abs() <= 1.0, "{shown} instead of {expected} at {texel}");
        }
    }
}

fn plain((tone, exposure_ev): (ToneMap, f32)) -> Display {
    Display { tone, exposure_ev, mode: DisplayMode::Picture }
}

fn shown() {
    let gpu = Gpu::new().unwrap_or_else(|e| panic!("{e}"));
    let mut plate = Plate::new(&Arc::new(Passes::new(&gpu)));
    assert!(plate.output().is_none());
    let (first, second, other) = (picture(7, 5, 0.01), picture(7, 5, 0.5), picture(4, 3, 0.5));
    let (neutral, bright) = ((ToneMap::Neutral, 0.0), (ToneMap::AgX, 2.0));
    // Every change by itself: the transform, the picture, its size; and none.
    for (picture, display) in
        [(&first, neutral), (&first, bright), (&second, bright), (&other, bright), (&other, bright), (&first, neutral)]
    {
        plate.draw(picture, plain(display)).unwrap_or_else(|e| panic!("{e}"));
        assert_shows(&gpu, &plate, picture, display);
    }
    for mode in DisplayMode::ALL {
        let display = Display { tone: ToneMap::None, exposure_ev: 1.0, mode };
        plate.draw(&second, display).unwrap_or_else(|e| panic!("{e}"));
        let displayed = displayed(&second, mode, ToneMap::None, 1.0);
        // Light of the screen, as another picture.
        assert_shows(&gpu, &plate, &displayed, (ToneMap::None, 0.0));
    }
    let empty = plate.draw(&Arc::new(Picture::default()), plain(neutral));
    assert!(matches!(empty, Err(RenderError::Size { .. })), "{empty:?}");
    gpu.device.destroy();
    assert!(matches!(plate.draw(&second, plain(neutral)), Err(RenderError::Gpu(_))));
}
