//! What a screen shows of a picture in every mode.

use burnish_core::color::tone::ToneMap;
use burnish_core::measure::view::{self, BANDS, Clipping, DisplayMode, MIDDLE_GREY, false_color, view_display};
use glam::{Vec3, Vec4};

use crate::grid::v4;
use crate::harness::Case;

pub fn cases() -> Vec<Case> {
    let leaf = &view::LEAF;
    vec![
        Case::new("view: every mode with every display transform", leaf, MODES, colors, |x| {
            let (mode, tone) = (DisplayMode::ALL[x[1].x as usize], ToneMap::ALL[x[0].w as usize]);
            [v4(view_display(mode, tone, x[0].truncate()), 0.0)]
        }),
        Case::new("view: bands of luminance and marks of clipping", leaf, BANDS_AND_MARKS, levels, |x| {
            let shown = x[0].truncate();
            [v4(false_color(x[0].w), 0.0), v4(Clipping::of(shown).mark().unwrap_or(shown), 0.0)]
        }),
    ]
}

const MODES: &str = "
    y[0] = vec4f(view_display(u32(x[1].x), u32(x[0].w), x[0].xyz), 0.0);
";

const BANDS_AND_MARKS: &str = "
    y[0] = vec4f(false_color(x[0].w), 0.0);
    y[1] = vec4f(clipping_mark(x[0].xyz), 0.0);
";

/// Dark, middle and bright, none on the edge of a band or of the range of 8 bits, where rounding decides.
const LEVELS: [f32; 8] = [-0.5, 0.0, 3e-3, 0.07, 0.19, 0.6, 3.1, 700.0];

fn colors() -> Vec<[Vec4; 2]> {
    let mut inputs = Vec::new();
    for mode in DisplayMode::ALL {
        for tone in ToneMap::ALL {
            for (r, g) in LEVELS.iter().flat_map(|r| LEVELS.map(|g| (*r, g))) {
                let of = |b| [Vec4::new(r, g, b, tone.number() as f32), Vec4::splat(mode.number() as f32)];
                inputs.extend(LEVELS.map(of));
            }
        }
    }
    inputs.retain(|x| !is_on_an_edge(x[0]));
    inputs
}

fn is_on_an_edge(x: Vec4) -> bool {
    let tone = ToneMap::ALL[x.w as usize];
    let shown = view_display(DisplayMode::Picture, tone, x.truncate());
    let near = |v: f32, at: f32| (v - at).abs() < 1e-4 * at;
    let clipped = shown.to_array().iter().any(|v| near(*v, view::CLIP_OVER) || near(*v, view::CLIP_UNDER));
    let luminance = burnish_core::color::rgb::luminance(x.truncate());
    clipped || BANDS[1..].iter().any(|band| near(luminance, MIDDLE_GREY * band.from_stops.exp2()))
}

fn levels() -> Vec<[Vec4; 1]> {
    let encoded = [0.0, 0.001, 0.003, 0.5, 0.99, 0.999, 1.0];
    let mut inputs = Vec::new();
    for stops in -80..80 {
        let exposed = MIDDLE_GREY * (0.1 * stops as f32 + 0.03).exp2();
        for (r, g) in encoded.iter().flat_map(|r| encoded.map(|g| (*r, g))) {
            inputs.push([Vec3::new(r, g, encoded[(stops + 80) as usize % 7]).extend(exposed)]);
        }
    }
    inputs.extend([0.0, -1.0, 1e9].map(|exposed| [Vec3::splat(0.5).extend(exposed)]));
    inputs
}
