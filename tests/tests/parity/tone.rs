//! Display transforms and the sRGB transfer.

use burnish_core::color::rgb::{linear_from_srgb, srgb_from_linear};
use burnish_core::color::tone::{self, ToneMap, tone_display_linear, tone_map};
use glam::Vec4;

use crate::grid::v4;
use crate::harness::Case;

pub fn cases() -> Vec<Case> {
    let leaf = &tone::LEAF;
    vec![
        Case::new("tone: every display transform", leaf, DISPLAY, colors, |x| {
            let (kind, linear) = (ToneMap::ALL[x[0].w as usize], x[0].truncate());
            [v4(tone_display_linear(kind, linear), 0.0), v4(tone_map(kind, linear), 0.0)]
        }),
        Case::new("tone: the sRGB transfer both ways", leaf, TRANSFER, values, |x| {
            [v4(srgb_from_linear(x[0].truncate()), 0.0), v4(linear_from_srgb(x[0].truncate()), 0.0)]
        }),
    ]
}

const DISPLAY: &str = "
    let kind = u32(x[0].w);
    y[0] = vec4f(tone_display_linear(kind, x[0].xyz), 0.0);
    y[1] = vec4f(tone_map(kind, x[0].xyz), 0.0);
";

/// Below zero, the toes and knees of the curves, middle grey, white, lamps, the sun, above the largest.
#[rustfmt::skip]
const LEVELS: [f32; 25] = [
    -1.0, -1e-6, 0.0, 1e-12, 1e-7, 1e-5, 3e-4, 2e-3, 0.0031308, 0.02, 0.04, 0.08, 0.18,
    0.5, 0.76, 0.8, 0.99, 1.0, 2.5, 16.0, 300.0, 6.5e4, 1e7, 1e9, 1e12,
];

fn colors() -> Vec<[Vec4; 1]> {
    let mut inputs = Vec::new();
    for kind in ToneMap::ALL {
        for r in LEVELS {
            for g in LEVELS {
                inputs.extend(LEVELS.map(|b| [Vec4::new(r, g, b, kind.number() as f32)]));
            }
        }
    }
    inputs
}

const TRANSFER: &str = "
    y[0] = vec4f(srgb_from_linear(x[0].xyz), 0.0);
    y[1] = vec4f(linear_from_srgb(x[0].xyz), 0.0);
";

/// Codes of 8 bits and what lies between and outside of them.
fn values() -> Vec<[Vec4; 1]> {
    (-100..=1124).map(|i| i as f32 / 1020.0).map(|v| [Vec4::new(v, v * v, v * v * v, 0.0)]).collect()
}
